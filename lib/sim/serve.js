'use strict'

const net = require('node:net')
const { PlcError } = require('../error')
const { createPty } = require('./pty')

// what a program that does not read leaves behind: a serial port would have lost it long ago
const MOST_UNREAD = 4096

/**
 * Offers a wire as a virtual serial port (Linux, macOS). The wire paces the bytes; the port's own speed setting does nothing.
 * @param {{ wire: import('./wire').Wire, link?: string }} options link: symbolic link with a stable name
 * @returns {{ path: () => string, unplug: () => void, replug: () => void, close: () => void }} close: any number of times
 * @throws {PlcError} NO_PTY, PORT_BUSY, PORT_ERROR
 */
function serveOnPty({ wire, link }) {
  const pty = createPty({ link })
  let end = null
  const join = plugged => {
    end?.close()
    end = plugged ? wire.connect({ data: bytes => forward(pty, bytes), closed: () => pty.unplug() }) : null
  }
  pty.onPlugged(join)
  pty.onData(bytes => end?.write(bytes))
  join(true)
  return { path: pty.path, unplug: pty.unplug, replug: pty.replug, close: pty.close }
}

function forward(pty, bytes) {
  const stream = pty.stream()
  if (stream && stream.writableLength < MOST_UNREAD) pty.write(bytes)
}

/**
 * Offers a wire as a serial server: raw bytes over TCP, any number of connections, each of them a master on the line.
 * @param {{ wire: import('./wire').Wire, port?: number, host?: string }} options port 0 = a free one; host: loopback by default
 * @returns {Promise<{ port: number, host: string, connections: () => number, drop: () => void, close: () => Promise<void> }>} drop: ends all
 *   connections and goes on listening
 * @throws {PlcError} PORT_BUSY, PORT_DENIED, PORT_ERROR
 */
async function serveOnTcp({ wire, port = 0, host = '127.0.0.1' }) {
  const sockets = new Set()
  const server = net.createServer({ noDelay: true }, socket => {
    sockets.add(socket)
    const end = wire.connect({
      data: bytes => void (socket.writableLength < MOST_UNREAD && socket.write(bytes)),
      closed: () => socket.destroy()
    })
    socket.on('data', bytes => end.write(bytes))
    socket.on('error', () => {})
    socket.on('close', () => {
      sockets.delete(socket)
      end.close()
    })
  })
  await listen(server, port, host)
  const drop = () => sockets.forEach(socket => socket.destroy())
  const close = () =>
    new Promise(resolve => {
      server.close(() => resolve(undefined))
      drop()
    })
  const address = /** @type {import('node:net').AddressInfo} */ (server.address())
  return { port: address.port, host, connections: () => sockets.size, drop, close }
}

const listen = (server, port, host) =>
  new Promise((resolve, reject) => {
    const path = `${host}:${port}`
    const codes = { EADDRINUSE: 'PORT_BUSY', EACCES: 'PORT_DENIED' }
    server.once('error', cause =>
      reject(new PlcError(codes[cause.code] ?? 'PORT_ERROR', { path, reason: cause.message, cause }))
    )
    server.listen({ port, host }, () => resolve(undefined))
  })

module.exports = { serveOnPty, serveOnTcp }
