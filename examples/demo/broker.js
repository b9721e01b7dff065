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
  const sockets = new Set()
  const server = net.createServer(socket => {
    sockets.add(socket)
    socket.once('close', () => sockets.delete(socket))
    broker.handle(socket)
  })
  await new Promise((resolve, reject) => {
    server.once('error', reject)
    server.listen(port, HOST, () => resolve(undefined))
  })
  const close = async () => {
    await new Promise(resolve => broker.close(() => resolve(undefined)))
    // who has only connected is no client of the broker yet
    for (const socket of sockets) socket.destroy()
    await new Promise(resolve => server.close(resolve))
  }
  return { url: `mqtt://${HOST}:${port}`, close }
}

module.exports = { startBroker }
