'use strict'

/**
 * How long (ms) it is believed that nothing is heard: a cable that lost its station may begin to couple, a serial server may get another
 * adapter, and neither closes the port.
 */
const BELIEVED = 500

/**
 * A 2-wire adapter may hear what it sends itself. Whether it does is found out from the first answered step; until
 * then, and where it does, one copy of our own bytes proves nothing (MODBUS answers a write with a copy of it).
 */
class Echo {
  #mode
  #now
  /** @type {'unknown'|'present'|'absent'} */
  #state = 'unknown'
  #provenAt = -Infinity
  /** @type {any} */
  #sent = null
  #heard = false
  #clean = true

  /** @param {'auto'|'on'|'off'} mode @param {() => number} now ms of the clock */
  constructor(mode, now) {
    this.#mode = mode
    this.#now = now
    this.reset()
  }

  /** The port was opened: another adapter may be behind it. */
  reset() {
    this.#state = { on: 'present', off: 'absent' }[this.#mode] ?? 'unknown'
  }

  /** What may be relied on: that nothing is heard was proven a moment ago, or is the user's word. */
  get state() {
    const old = this.#mode === 'auto' && this.#state === 'absent' && this.#now() - this.#provenAt > BELIEVED
    return old ? 'unknown' : this.#state
  }

  /** @param {Buffer} bytes about to be sent */
  sent(bytes) {
    this.#sent = bytes
    this.#heard = false
    this.#clean = true
  }

  /**
   * Other bytes came first: they may have been our echo, damaged. What was thought to hear nothing may have missed its echo once.
   * @param {Buffer} bytes
   */
  disturbed(bytes) {
    this.#clean = false
    if (this.#mode === 'auto' && this.#state === 'absent' && bytes.includes(this.#sent)) this.#state = 'unknown'
  }

  get #awaited() {
    return this.#state !== 'absent' && !this.#heard
  }

  /** Bytes that our own echo will put before the answer. */
  get expected() {
    return this.#state === 'present' && !this.#heard ? this.#sent.length : 0
  }

  /**
   * @param {Buffer} bytes received since sending
   * @returns {number} n > 0: the first n are our echo; 0: they are not; -1: too few to tell
   */
  look(bytes) {
    if (!this.#awaited) return 0
    const most = Math.min(bytes.length, this.#sent.length)
    if (this.#sent.compare(bytes, 0, most, 0, most) !== 0) return 0
    if (most < this.#sent.length) return -1
    this.#heard = true
    return most
  }

  /** Whether these bytes begin with our own echo, still awaited: noise may have come before it. */
  begins(bytes) {
    return this.#awaited && bytes.subarray(0, this.#sent.length).equals(this.#sent)
  }

  /**
   * The step was answered: now it is known; a single stray copy of our bytes must not be believed for ever.
   * @param {Buffer} answer one that equals our own bytes proves nothing
   */
  answered(answer) {
    if (this.#mode !== 'auto') return
    // where nothing is heard, nothing was awaited
    if (this.#heard) this.#state = 'present'
    else if (this.#clean) this.#state = this.#state === 'present' ? 'unknown' : 'absent'
    if (this.#clean && !answer.equals(this.#sent)) this.#provenAt = this.#now()
  }
}

module.exports = { Echo }
