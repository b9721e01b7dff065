'use strict'

const fs = require('node:fs')
const tty = require('node:tty')
const { PlcError } = require('../error')

/** @lydell/node-pty is a development dependency (prebuilt, Linux and macOS): asked for only where a pty is wanted. */
function loadBinding() {
  try {
    // @ts-ignore has no types for this door
    return require('@lydell/node-pty/requireBinary').requireBinary('pty.node')
  } catch (cause) {
    const reason = process.platform === 'win32' ? 'Windows has none' : 'the package @lydell/node-pty is not installed'
    throw new PlcError('NO_PTY', { reason, cause })
  }
}

/**
 * A virtual serial port: a real device file for the program under test, a stream for the simulator.
 *
 * The terminals of node-pty have `kill()` and `destroy()`, which signal every process of the machine; here only the bare
 * pair of descriptors is opened and closed.
 *
 * @param {{ link?: string }} [options] link: a symbolic link that keeps its name when the port is unplugged and replugged
 * @returns {Pty}
 * @throws {PlcError} NO_PTY, PORT_BUSY (something else than an own, dead link stands there), PORT_ERROR
 */
function createPty({ link } = {}) {
  const binding = loadBinding()
  /** @type {((bytes: Buffer) => void)[]} */
  const onData = []
  /** @type {((plugged: boolean) => void)[]} */
  const onPlugged = []
  /** @type {{ stream: import('node:tty').ReadStream, raw: import('node:tty').ReadStream, slave: number, device: string } | null} */
  let port = null

  function plug() {
    if (port) return
    if (link) freeLink(link)
    port = openPort(binding, bytes => onData.forEach(listener => listener(bytes)))
    if (link) makeLink(link, port.device, unplug)
    onPlugged.forEach(listener => listener(true))
  }
  function unplug() {
    if (!port) return
    const { stream, raw, slave, device } = port
    port = null
    raw.destroy()
    fs.closeSync(slave)
    stream.destroy()
    if (link) removeLink(link, device)
    onPlugged.forEach(listener => listener(false))
  }
  plug()
  return {
    path: () => link || (port ? port.device : ''),
    device: () => (port ? port.device : ''),
    stream: () => port && port.stream,
    plugged: () => port !== null,
    write: bytes => void (port && port.stream.write(bytes)),
    onData: listener => void onData.push(listener),
    onPlugged: listener => void onPlugged.push(listener),
    unplug,
    replug: plug,
    close: unplug
  }
}

function openPort(binding, onData) {
  const pair = binding.open(80, 24)
  const stream = new tty.ReadStream(pair.master)
  // raw before the first open: else the terminal's own echo answers the first bytes. It is never read, and lives as long as the port: newer versions
  // of Node.js give a terminal back as they found it when a stream on it is destroyed
  const raw = new tty.ReadStream(pair.slave)
  raw.setRawMode(true)
  stream.on('data', onData)
  // EIO when the other side goes: the unplugged port is only read no more
  stream.on('error', () => {})
  return { stream, raw, slave: pair.slave, device: pair.pty }
}

function freeLink(link) {
  const stat = fs.lstatSync(link, { throwIfNoEntry: false })
  if (!stat) return
  if (!stat.isSymbolicLink() || fs.existsSync(link)) throw new PlcError('PORT_BUSY', { path: link })
  fs.unlinkSync(link)
}

function makeLink(link, device, undo) {
  try {
    fs.symlinkSync(device, link)
  } catch (cause) {
    undo()
    throw new PlcError('PORT_ERROR', { path: link, reason: cause instanceof Error ? cause.message : cause, cause })
  }
}

/** Only our own link: after an unplug another simulator may have taken the name. */
function removeLink(link, device) {
  try {
    if (fs.readlinkSync(link) === device) fs.unlinkSync(link)
  } catch {
    // removed by somebody else
  }
}

/**
 * @typedef {object} Pty
 * @property {() => string} path what a program opens: the link, else the device
 * @property {() => string} device the device file, '' while unplugged
 * @property {() => import('node:tty').ReadStream | null} stream the simulator's end
 * @property {() => boolean} plugged
 * @property {(bytes: Buffer) => void} write dropped while unplugged
 * @property {(listener: (bytes: Buffer) => void) => void} onData survives replugging
 * @property {(listener: (plugged: boolean) => void) => void} onPlugged
 * @property {() => void} unplug as if the adapter was pulled; the link goes too
 * @property {() => void} replug a new device under the same link
 * @property {() => void} close like unplug, for good; any number of times
 */

module.exports = { createPty }
