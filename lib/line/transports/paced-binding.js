'use strict'

const fs = require('node:fs')

/** Of the poller: tell when there is something to read, or room to write. */
const READABLE = 1
const WRITABLE = 2

const isAgain = error => error.code === 'EAGAIN' || error.code === 'EWOULDBLOCK' || error.code === 'EINTR'

const canceled = () => Object.assign(new Error('Port is not open'), { canceled: true })
const hungUp = () => Object.assign(new Error('the port has hung up'), { disconnect: true })

const nobody = () => {}

/** @returns {number} how many bytes the system took at once */
const writeNow = (fd, bytes) => {
  try {
    return fs.writeSync(fd, bytes, 0, bytes.length, null)
  } catch {
    // full, or gone: the wrapped write waits, or says what it is
    return 0
  }
}

/** Its own `stop` tells all who listen of an error, with its stack, each time; nobody needs it. */
const stopPolling = poller => (typeof poller.poller?.stop === 'function' ? poller.poller : poller).stop()

/**
 * Reads a descriptor by wire time. The system tells when there is something; but after a sleep there should be, so it is not even asked. Without
 * promises: what a line does most costs least so.
 */
class DescriptorReader {
  #port
  #pace
  #buffer = /** @type {any} */ (null)
  #offset = 0
  #length = 0
  /** @type {(error: any, bytesRead: number) => void} */
  #done = nobody
  /** the descriptor is asked */
  #polls = false

  /** @param {any} port @param {import('./pace').Pace} pace */
  constructor(port, pace) {
    this.#port = port
    this.#pace = pace
    port.poller.on('readable', this.#told)
    this.#askBoth(port.poller)
  }

  /** What is asked of the system replaces what was asked before: who waits to write would be forgotten for who waits to read, and the other way round. */
  #askBoth(poller) {
    const ask = poller.poll
    poller.poll = events => {
      const read = this.#polls ? READABLE : 0
      const write = this.#isWriting ? WRITABLE : 0
      ask.call(poller, events | read | write)
    }
  }

  /** The port was closed. Its poller may live as long as the process (bindings-cpp): it must not know who reads. */
  end() {
    this.#port.poller.off('readable', this.#told)
    delete this.#port.poller.poll
    if (this.#polls) this.#told(canceled())
    this.#buffer = null
    this.#done = nobody
  }

  /** One read at a time. */
  read(buffer, offset, length, done) {
    this.#buffer = buffer
    this.#offset = offset
    this.#length = length
    this.#done = done
    this.#wait()
  }

  #wait() {
    if (this.#pace.sleep(this.#look)) return
    try {
      this.#port.poller.poll(READABLE)
    } catch (error) {
      return this.#done(error, 0)
    }
    this.#polls = true
    this.#pace.watch(this.#giveUp)
  }

  #told = error => {
    // once somebody has waited to write, the poller asks by itself for what nobody wants to know now, on and on
    if (!this.#polls) {
      if (!error && !this.#isWriting) stopPolling(this.#port.poller)
      return
    }
    this.#polls = false
    this.#pace.watch(null)
    try {
      if (error) this.#done(error, 0)
      else this.#look()
    } catch (thrown) {
      // thrown from here it would end the process without a word
      queueMicrotask(() => {
        throw thrown
      })
    }
  }

  /** Then the poller is not stopped: the wait of the write would end, too. */
  get #isWriting() {
    return this.#port.poller.listenerCount('writable') > 0
  }

  #giveUp = () => {
    if (this.#isWriting) return
    this.#polls = false
    stopPolling(this.#port.poller)
    this.#pace.watch(null)
    this.#wait()
  }

  #look = () => {
    // a closed port has nobody left to ask
    if (!this.#port.isOpen) return this.#done(canceled(), 0)
    let bytesRead
    try {
      // in the call itself: the descriptor does not block, and a trip through the thread pool costs several times as much
      bytesRead = fs.readSync(this.#port.fd, this.#buffer, this.#offset, this.#length, null)
    } catch (error) {
      return isAgain(error) ? this.#wait() : this.#done(error, 0)
    }
    if (bytesRead === 0) this.#done(hungUp(), 0)
    else this.#done(null, bytesRead)
  }
}

/** Where there is no descriptor (Windows, mock): the wrapped read, when it is time. */
const plainReader = (port, pace) => {
  const plainRead = port.read.bind(port)
  return (buffer, offset, length, done) => {
    const now = () => {
      if (!port.isOpen) return done(canceled(), 0)
      plainRead(buffer, offset, length).then(
        ({ bytesRead }) => done(null, bytesRead),
        error => done(error, 0)
      )
    }
    if (!pace.sleep(now)) now()
  }
}

/**
 * A binding of serialport whose ports read by wire time: not at every byte, but when the awaited ones can be there. And a
 * read of zero bytes is a hang-up; the wrapped binding would ask again for ever (bindings-cpp #162).
 * Its ports have besides: `readInto(buffer, offset, length, done)`, one at a time, where done gets an error or null, and how many bytes it is; and
 * `writeNow(bytes)`, which returns how many bytes the system took at once.
 *
 * @param {any} binding of serialport
 * @param {import('./pace').Pace} pace
 */
function pacedBinding(binding, pace) {
  return {
    list: () => binding.list(),
    open: async options => {
      const port = await binding.open(options)
      const close = port.close.bind(port)
      const isPlain = typeof port.fd !== 'number' || !port.poller
      const reader = isPlain ? null : new DescriptorReader(port, pace)
      port.readInto = reader ? reader.read.bind(reader) : plainReader(port, pace)
      port.writeNow = bytes => (isPlain ? 0 : writeNow(port.fd, bytes))
      port.close = () => {
        const closed = close()
        // who sleeps finds it closed
        pace.stop()
        reader?.end()
        return closed
      }
      return port
    }
  }
}

module.exports = { pacedBinding }
