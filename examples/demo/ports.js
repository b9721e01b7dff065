'use strict'

const net = require('node:net')

const HOST = '127.0.0.1'

const tryPort = port =>
  new Promise(resolve => {
    const server = net.createServer()
    server.once('error', () => resolve(0))
    server.listen(port, HOST, () => {
      const { port: got } = /** @type {import('node:net').AddressInfo} */ (server.address())
      server.close(() => resolve(got))
    })
  })

/**
 * The usual port if it is free, else any free one.
 * @param {number} usual 0: any
 * @returns {Promise<number>}
 */
const freePort = async usual => (await tryPort(usual)) || tryPort(0)

module.exports = { freePort, HOST }
