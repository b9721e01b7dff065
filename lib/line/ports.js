'use strict'

const fs = require('node:fs')
const path = require('node:path')

const BY_ID = '/dev/serial/by-id'
const DEVICES = /^tty(?:USB|ACM|AMA|S|XRUSB|MFD|O|WCH)\d+$/

/** What an adapter calls itself in a by-id name: usb-FTDI_USB-RS485_Cable_FT1ABCDE-if00-port0. */
const fromId = id => {
  const text = id.replace(/^usb-/, '').replace(/-if\d+(?:-port\d+)?$/, '')
  const words = text.split('_')
  // the last word of a name of several is a serial number if it looks like one
  if (words.length > 1 && /^[0-9A-Z]{6,}$/.test(words[words.length - 1])) words.pop()
  return words.join(' ')
}

const quiet = async fn => {
  try {
    return await fn()
  } catch {
    return []
  }
}

/** by-id names and where they lead: `[{ id, device }]`. */
const byId = files =>
  quiet(async () => {
    const names = await files.readdir(BY_ID)
    const links = names.sort().map(async id => {
      const device = await files.realpath(path.posix.join(BY_ID, id)).catch(() => null)
      return { id, device }
    })
    return (await Promise.all(links)).filter(({ device }) => device)
  })

/** Device files, where nobody can tell which are there: a container without udevadm. */
const devices = files =>
  quiet(async () => {
    const names = await files.readdir('/dev')
    return names.filter(name => DEVICES.test(name)).map(name => ({ path: `/dev/${name}` }))
  })

/** Ports of the board without a device behind them: 32 lines of ttyS hide the one that matters. */
const isReal = port => !/\/ttyS\d+$/.test(port.path) || port.manufacturer || port.pnpId || port.vendorId

const describe = (port, link) => {
  const device = path.posix.basename(port.path.replace(/\\/g, '/'))
  const name = link ? fromId(link.id) : port.pnpId ? fromId(port.pnpId) : (port.manufacturer ?? '')
  return {
    path: link ? path.posix.join(BY_ID, link.id) : port.path,
    device: port.path,
    label: name ? `${name} (${device})` : device
  }
}

const compare = (a, b) => a.label.localeCompare(b.label, 'en', { numeric: true })

/**
 * The serial ports of this machine, for a list to choose from: stable names first, then by label. Never rejects.
 *
 * @param {{ list?: () => Promise<any[]>, files?: any }} [options] list: of serialport; files: node:fs/promises
 * @returns {Promise<{ path: string, device: string, label: string }[]>} path: what to configure; label such as
 *   "FTDI USB-RS485 Cable (ttyUSB0)"
 */
async function listPorts({ list = () => require('serialport').SerialPort.list(), files = fs.promises } = {}) {
  const links = await byId(files)
  // rejects where udevadm is missing
  const told = await quiet(list)
  const found = new Map()
  for (const port of [...told, ...(told.length === 0 ? await devices(files) : [])]) found.set(port.path, port)
  for (const { device } of links) found.set(device, { path: device })
  const rows = [...found.values()].map(port => {
    const link = links.find(({ device }) => device === port.path)
    return { ...describe(port, link), stable: Boolean(link), real: link || isReal(port) }
  })
  const real = rows.filter(row => row.real)
  const shown = real.length > 0 ? real : rows
  shown.sort((a, b) => Number(b.stable) - Number(a.stable) || compare(a, b))
  return shown.map(({ path: name, device, label }) => ({ path: name, device, label }))
}

module.exports = { listPorts }
