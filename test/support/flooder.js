'use strict'

/**
 * A process that floods whoever connects, as fast as the other side takes the bytes: `flooder.js tcp|pty HEX|noise`. Tells its parent where.
 */

const net = require('node:net')
const os = require('node:os')
const { createPty, createRandom } = require('../../lib/sim')

const CHUNK = 65536
const [kind, pattern] = process.argv.slice(2)

// who is flooded is measured, not who floods
os.setPriority(10)

const random = createRandom(7)
const noise = () => Buffer.from(Array.from({ length: CHUNK }, () => random.integer(0, 255)))
const unit = pattern === 'noise' ? noise() : Buffer.from(pattern, 'hex')
const chunk = Buffer.alloc(Math.max(1, Math.floor(CHUNK / unit.length)) * unit.length, unit)

/** @param {import('node:stream').Writable} stream */
const flood = stream => {
  const more = () => {
    if (!stream.destroyed) stream.write(chunk, error => (error ? undefined : setImmediate(more)))
  }
  stream.on('error', () => {})
  more()
}

const tcp = () => {
  const server = net.createServer(socket => {
    socket.resume()
    flood(socket)
  })
  server.listen(0, '127.0.0.1', () => process.send?.({ port: /** @type {net.AddressInfo} */ (server.address()).port }))
}

const serial = () => {
  const pty = createPty()
  process.send?.({ path: pty.path() })
  // who opens it says so, else the terminal would be full of what nobody awaited
  process.on('message', () => {
    const stream = pty.stream()
    if (stream) flood(/** @type {any} */ (stream))
  })
}

process.on('disconnect', () => process.exit())
if (kind === 'tcp') tcp()
else serial()
