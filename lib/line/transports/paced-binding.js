'use strict'

const fs = require('node:fs')

const isAgain = error => error.code === 'EAGAIN' || error.code === 'EWOULDBLOCK' || error.code === 'EINTR'

const canceled = () => Object.assign(new Error('Port is not open'), { canceled: true })
const hungUp = () => Object.assign(new Error('the port has hung up'), { disconnect: true })

/**
 * In the call itself: the descriptor does not block, and a trip through the thread pool costs several times as much.
 * @returns {number} bytes; -1: there is nothing yet
 */
const readNow = (fd, { buffer, offset, length }) => {
  try {
    return fs.readSync(fd, buffer, offset, length, null)
  } catch (error) {
    if (isAgain(error)) return -1
    throw error
  }
}

/** @returns {number} how many bytes the system took at once */
const writeNow = (fd, bytes) => {
  try {
    return fs.writeSync(fd, bytes, 0, bytes.length, null)
  } catch {
    // full, or gone: the wrapped write waits, or says what it is
    return 0
  }
}

/** Its own `stop` tells all who listen of an error, with its stack, each time; nobody listens. */
const stopPolling = poller => (typeof poller.poller?.stop === 'function' ? poller.poller : poller).stop()

/** Whether the descriptor can be read, or has hung up; false: nobody wants to know any more. @returns {Promise<boolean>} */
const readable = (poller, pace) =>
  new Promise((resolve, reject) => {
    const told = error => {
      pace.watch(null)
      if (error) reject(error)
      else resolve(true)
    }
    poller.once('readable', told)
    pace.watch(() => {
      // it would end the wait of a write that is under way, too
      if (poller.listenerCount('writable') > 0) return
      pace.watch(null)
      poller.off('readable', told)
      stopPolling(poller)
      resolve(false)
    })
  })

/**
 * A binding of serialport whose ports read by wire time: not at every byte, but when the awaited ones can be there. And a
 * read of zero bytes is a hang-up; the wrapped binding would ask again for ever (bindings-cpp #162).
 * Where there is no descriptor (Windows, mock) the wrapped read is used.
 *
 * @param {any} binding of serialport
 * @param {import('./pace').Pace} pace
 */
function pacedBinding(binding, pace) {
  return {
    list: () => binding.list(),
    open: async options => {
      const port = await binding.open(options)
      const plainRead = port.read.bind(port)
      const close = port.close.bind(port)
      const isPlain = () => typeof port.fd !== 'number' || !port.poller
      port.read = async (buffer, offset, length) => {
        if (!isPlain()) return { buffer, bytesRead: await read(port, { buffer, offset, length }, pace) }
        await pace.sleep()
        if (!port.isOpen) throw canceled()
        return plainRead(buffer, offset, length)
      }
      port.writeNow = bytes => (isPlain() ? 0 : writeNow(port.fd, bytes))
      port.close = () => {
        pace.stop()
        return close()
      }
      return port
    }
  }
}

/** The system tells when there is something; but after a sleep there should be, so it is not even asked. */
async function read(port, target, pace) {
  for (;;) {
    const sleep = pace.sleep()
    const isTime = sleep ? await sleep.then(() => true) : await readable(port.poller, pace)
    // also where the wait was given up: a closed port has nobody left to ask
    if (!port.isOpen) throw canceled()
    if (!isTime) continue
    const bytesRead = readNow(port.fd, target)
    if (bytesRead === 0) throw hungUp()
    if (bytesRead > 0) return bytesRead
  }
}

module.exports = { pacedBinding }
