'use strict'

/**
 * What a 2-wire adapter hears of us, on a listening line. It cannot be found out there (the other side may repeat our words on purpose), so it is
 * taken out only where the line's setting says that the adapter hears itself.
 */
class OwnEcho {
  #clock
  #slack
  #on
  #awaited = []

  /** @param {{ clock: any, times: { slack: number }, settings: { echo: string } }} line */
  constructor({ clock, times, settings }) {
    this.#clock = clock
    this.#slack = times.slack
    this.#on = settings.echo === 'on'
  }

  reset() {
    this.#awaited = []
  }

  /** @param {Buffer} bytes that go out now @param {number} end when the last of them has left, ms */
  sent(bytes, end) {
    if (this.#on) this.#awaited.push({ bytes: Buffer.from(bytes), until: end + this.#slack })
  }

  /** How many of these bytes, from the first on, are our own. @param {Buffer} bytes */
  look(bytes) {
    const now = this.#clock.now()
    while (this.#awaited[0]?.until < now) this.#awaited.shift()
    let own = 0
    while (own < bytes.length && this.#awaited.length > 0) {
      const [first] = this.#awaited
      if (first.bytes[0] !== bytes[own]) {
        // damaged, or never heard: what comes now cannot be told apart
        this.reset()
        break
      }
      own++
      first.bytes = first.bytes.subarray(1)
      if (first.bytes.length === 0) this.#awaited.shift()
    }
    return own
  }
}

module.exports = { OwnEcho }
