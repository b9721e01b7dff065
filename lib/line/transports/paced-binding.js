'use strict'

const fs = require('node:fs')

/** The read wakes this much (ms) before the bytes can be there: timers are late, never early. */
const EARLY = 1

const isAgain = error => error.code === 'EAGAIN' || error.code === 'EWOULDBLOCK' || error.code === 'EINTR'

const canceled = () => Object.assign(new Error('Port is not open'), { canceled: true })
const hungUp = () => Object.assign(new Error('the port has hung up'), { disconnect: true })

const readOnce = (fd, { buffer, offset, length }) =>
  new Promise((resolve, reject) => {
    fs.read(fd, buffer, offset, length, null, (error, bytesRead) => (error ? reject(error) : resolve(bytesRead)))
  })

/** Resolves when the descriptor can be read, or has hung up. */
const readable = poller =>
  new Promise((resolve, reject) => poller.once('readable', error => (error ? reject(error) : resolve(undefined))))

/** When the next bytes can be there at the earliest; who sleeps until then can be woken. */
function createPace(clock) {
  let at = -Infinity
  let wake = null
  return {
    hint: when => {
      at = when
    },
    sleep: () => {
      const wait = at - EARLY - clock.now()
      if (!(wait > 0)) return Promise.resolve()
      return new Promise(resolve => {
        const timer = clock.setTimer(() => wake(), wait)
        wake = () => {
          wake = null
          clock.clearTimer(timer)
          resolve(undefined)
        }
      })
    },
    stop: () => {
      at = -Infinity
      wake?.()
    }
  }
}

/**
 * A binding of serialport whose ports read by wire time: not at every byte, but when the awaited ones can be there. And a
 * read of zero bytes is a hang-up; the wrapped binding would ask again for ever (bindings-cpp #162).
 * Where there is no descriptor (Windows, mock) the wrapped read is used.
 *
 * @param {any} binding of serialport
 * @param {ReturnType<typeof createPace>} pace
 */
function pacedBinding(binding, pace) {
  return {
    list: () => binding.list(),
    open: async options => {
      const port = await binding.open(options)
      const plainRead = port.read.bind(port)
      const close = port.close.bind(port)
      port.read = async (buffer, offset, length) => {
        await pace.sleep()
        if (!port.isOpen) throw canceled()
        if (typeof port.fd !== 'number' || !port.poller) return plainRead(buffer, offset, length)
        return { buffer, bytesRead: await read(port, { buffer, offset, length }) }
      }
      port.close = () => {
        pace.stop()
        return close()
      }
      return port
    }
  }
}

async function read(port, target) {
  for (;;) {
    if (!port.isOpen) throw canceled()
    try {
      const bytesRead = await readOnce(port.fd, target)
      if (bytesRead === 0) throw hungUp()
      return bytesRead
    } catch (error) {
      if (!port.isOpen) throw canceled()
      if (!isAgain(error)) throw error
    }
    await readable(port.poller)
  }
}

module.exports = { createPace, pacedBinding }
