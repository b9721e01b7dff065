'use strict'

/** Stands between a master and a serial server, and can be what networks and serial servers are on a bad day. */

const net = require('node:net')

/**
 * @param {number} target port of the serial server on the loopback
 * @returns {Promise<TcpProxy>}
 */
async function createTcpProxy(target) {
  const pairs = new Set()
  const counts = { accepted: 0, swallowed: 0 }
  let deaf = false
  let port = 0

  const pair = near => {
    counts.accepted++
    const far = net.connect({ port: target, host: '127.0.0.1', noDelay: true })
    const both = { near, far, dead: deaf }
    pairs.add(both)
    const pass = (from, to) => {
      from.on('data', bytes => {
        if (both.dead) counts.swallowed += bytes.length
        else to.write(bytes)
      })
      from.on('error', () => {})
      from.on('close', () => {
        // what does not forward tells neither side that the other one went
        if (!both.dead) to.destroy()
        if (near.destroyed) far.destroy()
        if (near.destroyed && far.destroyed) pairs.delete(both)
      })
    }
    pass(near, far)
    pass(far, near)
  }
  const server = net.createServer({ noDelay: true }, pair)
  const listen = () =>
    new Promise((resolve, reject) => {
      server.once('error', reject)
      server.listen({ port, host: '127.0.0.1' }, () => {
        server.off('error', reject)
        resolve(undefined)
      })
    })
  const drop = () => {
    for (const { near, far } of pairs) {
      near.destroy()
      far.destroy()
    }
  }
  const stop = () =>
    new Promise(resolve => {
      if (!server.listening) return resolve(undefined)
      server.close(() => resolve(undefined))
      drop()
    })
  await listen()
  port = /** @type {import('node:net').AddressInfo} */ (server.address()).port
  return {
    port,
    counts,
    halfOpen: () => pairs.forEach(each => (each.dead = true)),
    deaf: on => {
      deaf = on
      if (on) for (const each of pairs) each.dead = true
    },
    drop,
    stop,
    start: listen
  }
}

/**
 * @typedef {object} TcpProxy
 * @property {number} port
 * @property {{ accepted: number, swallowed: number }} counts swallowed: bytes
 * @property {() => void} halfOpen the connections of now forward nothing any more, for ever, and stay open; new ones work
 * @property {(on: boolean) => void} deaf the same, and new ones are accepted but do not work either, until it is switched off
 * @property {() => void} drop breaks all connections and goes on listening
 * @property {() => Promise<void>} stop as a serial server that is switched off: nothing listens
 * @property {() => Promise<void>} start listens again on the same port
 */

module.exports = { createTcpProxy }
