'use strict'

const fs = require('node:fs')
const path = require('node:path')

/** COM3, \\.\COM12 */
const WINDOWS_PORT = /^(\\\\[.?]\\)?[\w-]+$/

const KINDS = [
  ['isFile', 'a file'],
  ['isDirectory', 'a directory'],
  ['isFIFO', 'a pipe'],
  ['isSocket', 'a socket'],
  ['isBlockDevice', 'a block device']
]

/** What the Linux kernel counts a device among: `tty`, `mem`, …; '' if it does not say (the terminals of programs are in no class). */
const classOf = device => {
  const major = (device >> 8) & 0xfff
  const minor = (device & 0xff) | ((device >> 12) & 0xfff00)
  try {
    return path.basename(fs.readlinkSync(`/sys/dev/char/${major}:${minor}/subsystem`))
  } catch {
    return ''
  }
}

/**
 * Why nothing of this name may be opened as a serial port: opening alone can do harm (a pipe, a watchdog), and what is sent would be written into a file.
 * @param {string} name as the user wrote it
 * @param {string} [platform]
 * @returns {string} '' if it may be one, or if nothing is there
 */
const notAPort = (name, platform = process.platform) => {
  if (platform === 'win32') return WINDOWS_PORT.test(name) ? '' : 'it is not the name of a serial port'
  let stat
  try {
    stat = fs.statSync(name)
  } catch {
    return ''
  }
  const kind = KINDS.find(([is]) => stat[is]())
  if (kind) return `it is ${kind[1]}, not a serial port`
  const group = classOf(stat.rdev)
  return group === '' || group === 'tty' ? '' : `it is a device of the kind ${group}, not a serial port`
}

module.exports = { notAPort }
