'use strict'

const fs = require('node:fs')
const os = require('node:os')
const path = require('node:path')
const { serveOnPty, serveOnTcp } = require('../../lib/sim')

/**
 * Offers a simulated wire as a virtual serial port, or behind TCP where there is none.
 * @param {{ wire: import('../../lib/sim/wire').Wire, name: string, baudRate: number }} options name: of the link to the port
 * @returns {Promise<Offer>}
 */
async function offer(options) {
  try {
    return onPty(options)
  } catch (error) {
    if (error.code !== 'NO_PTY') throw error
    return onTcp(options)
  }
}

function onPty({ wire, name, baudRate }) {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'nx-demo-'))
  const remove = () => fs.rmSync(folder, { recursive: true, force: true })
  try {
    const port = serveOnPty({ wire, link: path.join(folder, name) })
    const close = async () => {
      port.close()
      remove()
    }
    return { address: port.path(), settings: { transport: 'serial', path: port.path(), baudRate }, close }
  } catch (error) {
    remove()
    throw error
  }
}

async function onTcp({ wire, baudRate }) {
  const { host, port, close } = await serveOnTcp({ wire })
  return { address: `tcp://${host}:${port}`, settings: { transport: 'tcp', host, port, baudRate }, close }
}

/**
 * @typedef {object} Offer
 * @property {string} address to show
 * @property {object} settings properties of `plc-line`
 * @property {() => Promise<void>} close
 */

module.exports = { offer }
