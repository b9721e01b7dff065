'use strict'

const fs = require('node:fs')
const path = require('node:path')

const FOLDER = '/sys/bus/usb-serial/devices'

/**
 * The latency timer of an FTDI adapter: how long its chip keeps the last bytes of an answer back, 16 ms from the factory. Linux tells it,
 * for adapters of this kind only.
 *
 * @param {string} name of the port, a device or a stable name that leads to one
 * @param {{ realpath: (path: string) => Promise<string>, readFile: (path: string, encoding: any) => Promise<any> }} [files]
 *   default: the files of this machine
 * @returns {Promise<{ device: string, file: string, value: number } | null>} value in ms; null: it has none, or nobody tells. Never rejects
 */
async function latencyTimer(name, files = fs.promises) {
  try {
    const device = await files.realpath(name)
    const file = path.posix.join(FOLDER, path.posix.basename(device), 'latency_timer')
    const text = String(await files.readFile(file, 'utf8')).trim()
    return /^\d{1,3}$/.test(text) ? { device, file, value: Number(text) } : null
  } catch {
    return null
  }
}

module.exports = { latencyTimer }
