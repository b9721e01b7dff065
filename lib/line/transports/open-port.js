'use strict'

/** Bytes that are read into one buffer, piece behind piece; what a flood brings stays with the system. */
const SIZE = 8192
/** With less room than this, more than the longest frame, another one is begun. */
const LEAST = 1024
/** Signals that are set together with DTR and RTS. */
const OTHERS = Object.freeze({ brk: false, cts: false })

const hungUp = () => new Error('the port has hung up')

/**
 * A port that a binding of serialport has opened: read on and on, written one after the other, closed once. The binding itself has one read and one
 * write; the streams of serialport between would only take processor time.
 */
class OpenPort {
  #port
  #lost
  /** @type {any} */
  #data = null
  #buffer = Buffer.allocUnsafeSlow(SIZE)
  #used = 0
  #reading = false
  #held = false
  #closing = false
  /** @type {Promise<any> | null} the write that is under way, and those behind it */
  #writing = null

  /**
   * @param {any} port of a binding made by {@link import('./paced-binding').pacedBinding}
   * @param {(error: any) => void} lost it failed by itself, and is closed by now; told once
   */
  constructor(port, lost) {
    this.#port = port
    this.#lost = lost
  }

  get isOpen() {
    return this.#port.isOpen && !this.#closing
  }

  get closing() {
    return this.#closing
  }

  /** @param {{ dtr: boolean, rts: boolean }} signals @param {(error?: any) => void} done */
  set(signals, done) {
    this.#port.set({ ...OTHERS, ...signals }).then(() => done(), done)
  }

  /** Reads from now on. @param {(bytes: Buffer) => void} data gets bytes that nothing is written over */
  read(data) {
    this.#data = data
    this.#next()
  }

  /** @param {boolean} held what comes stays with the system; a read that is under way still ends */
  hold(held) {
    this.#held = held
    this.#next()
  }

  #next() {
    if (this.#reading || this.#held || !this.#data || !this.isOpen) return
    this.#reading = true
    if (SIZE - this.#used < LEAST) {
      this.#buffer = Buffer.allocUnsafeSlow(SIZE)
      this.#used = 0
    }
    this.#port.readInto(this.#buffer, this.#used, SIZE - this.#used, this.#came)
  }

  #came = (error, bytesRead) => {
    this.#reading = false
    if (error) return this.#failed(error)
    if (bytesRead === 0) return this.#break(hungUp())
    if (!this.isOpen) return
    const from = this.#used
    this.#used += bytesRead
    this.#data(this.#buffer.subarray(from, this.#used))
    this.#next()
  }

  #failed(error) {
    if (!error.canceled) return this.#break(error)
    this.#next()
  }

  /** @param {Buffer} bytes @param {(error?: any) => void} done in the call itself, if the system took them all at once */
  write(bytes, done) {
    const taken = this.#writing ? 0 : this.#port.writeNow(bytes)
    if (taken === bytes.length) return done()
    const rest = bytes.subarray(taken)
    const own = (this.#writing ?? Promise.resolve()).then(() => this.#port.write(rest))
    this.#writing = own
    const ended = error => {
      if (this.#writing === own) this.#writing = null
      if (error && !error.canceled) this.#break(error)
      done(error)
    }
    own.then(() => ended(), ended)
  }

  #break(error) {
    if (this.isOpen) this.close(() => this.#lost(error))
  }

  /** @param {() => void} done the port is free */
  close(done) {
    this.#closing = true
    const closed = () => {
      this.#closing = false
      done()
    }
    this.#port.close().then(closed, closed)
  }
}

module.exports = { OpenPort }
