'use strict'

/** What incon-talk.js is made of: a line on its way, and turns on the wire. */

/** A line until it is acknowledged. Ends once. */
class Flight {
  /** @type {any} how it ended: `{ kind: 'ack'|'restarted'|'echo'|'closed'|'unsent', error? }` */
  end = null
  /** how often it went out, in whole or in part */
  frames = 0
  /** of the last time */
  bytes = 0
  /** that it was given to the line once */
  begun = false
  /** how often we have heard it ourselves */
  heard = 0
  /** @type {null | (() => void)} */
  #wake = null

  /** @param {{ number: number, line: Buffer, text: Buffer, port: any }} parts line: without line end; text: what a splitter makes of it */
  constructor({ number, line, text, port }) {
    this.number = number
    this.line = line
    this.text = text
    this.port = port
  }

  finish(end) {
    this.end ??= end
    this.#wake?.()
  }

  /** @param {number} bytes that went out */
  went(bytes) {
    this.frames++
    this.bytes = bytes
  }

  /** Whether this message is the line itself. */
  isHeard({ kind, number, bytes }) {
    const same = this.begun && !this.end && kind !== 'ack' && number === this.number && bytes.equals(this.text)
    if (same) this.heard++
    return same
  }

  /** Until it has ended, so long at most. @param {any} clock @param {number} ms @returns {Promise<void>} */
  rest(clock, ms) {
    if (this.end) return Promise.resolve()
    return new Promise(resolve => {
      const done = () => {
        clock.clearTimer(timer)
        this.#wake = null
        resolve()
      }
      const timer = clock.setTimer(done, ms)
      this.#wake = done
    })
  }
}

/** One after the other; those who come `first` before all others. */
class Turns {
  #busy = false
  /** @type {(() => void)[]} */
  #first = []
  /** @type {(() => void)[]} */
  #rest = []

  /** @param {{ first?: boolean }} [options] @returns {Promise<() => void>} gives the turn on; works once */
  take({ first = false } = {}) {
    return new Promise(resolve => {
      const begin = () => {
        let held = true
        resolve(() => {
          if (held) this.#next()
          held = false
        })
      }
      if (this.#busy) return void (first ? this.#first : this.#rest).push(begin)
      this.#busy = true
      begin()
    })
  }

  #next() {
    const begin = this.#first.shift() ?? this.#rest.shift()
    if (begin) begin()
    else this.#busy = false
  }
}

module.exports = { Flight, Turns }
