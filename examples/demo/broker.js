'use strict'

const net = require('node:net')
const { Aedes } = require('aedes')
const { HOST } = require('./ports')

/**
 * An MQTT broker in this process.
 * @param {number} port TCP port on the loopback
 * @returns {Promise<{ url: string, close(): Promise<void> }>}
 */
async function startBroker(port) {
  const broker = await Aedes.createBroker()
  const server = net.createServer(broker.handle)
  await new Promise((resolve, reject) => {
    server.once('error', reject)
    server.listen(port, HOST, () => resolve(undefined))
  })
  const close = async () => {
    await new Promise(resolve => broker.close(() => resolve(undefined)))
    await new Promise(resolve => server.close(resolve))
  }
  return { url: `mqtt://${HOST}:${port}`, close }
}

module.exports = { startBroker }
