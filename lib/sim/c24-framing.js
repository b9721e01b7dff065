'use strict'

// A byte that came behind the transparent code: data, whatever its value
const LITERAL = 0x100
const plain = value => value & 0xff

const [ENQ, ACK, NAK] = [0x05, 0x06, 0x15]
const CODES = { sum: 0x7f24, length: 0x7f25, timeout: 0x7f40, full: 0x7f6a }

/**
 * Non-procedure protocol: where a message ends. Receive complete code or last user frame, receive data count, or `cut` (timer 0),
 * whichever is first. With a first user frame, what comes before it is skipped.
 *
 * @param {any} settings of c24-settings.js
 * @param {{ skipped: number }} counts
 * @returns {{ feed: (value: number) => Taken | null, cut: () => Taken | null, reset: () => void, held: () => number }} value: a byte, or
 *   LITERAL + a byte
 */
function createFreeFraming({ first, last, end, storeEnd, mostBytes }, counts) {
  const frames = first.length + last.length > 0
  const close = frames ? last : end
  const taken = new Uint16Array(mostBytes + first.length)
  let length = 0
  let open = first.length === 0

  const reset = () => {
    length = 0
    open = first.length === 0
  }
  const endsWith = pattern => {
    if (pattern.length === 0 || length < pattern.length) return false
    for (let n = 0; n < pattern.length; n++) if (taken[length - pattern.length + n] !== pattern[n]) return false
    return true
  }
  const whole = (by, without) => {
    const bytes = Buffer.from(Array.from(taken.subarray(0, length - without), plain))
    reset()
    return { by, bytes, frames }
  }
  const seek = () => {
    if (endsWith(first)) {
      counts.skipped += length - first.length
      length = 0
      open = true
    } else if (length >= taken.length) {
      counts.skipped += length - first.length
      taken.copyWithin(0, length - first.length, length)
      length = first.length
    }
    return null
  }
  const feed = value => {
    taken[length++] = value
    if (!open) return seek()
    if (endsWith(close)) return whole(frames ? 'frame' : 'code', storeEnd ? 0 : close.length)
    return length >= mostBytes ? whole('count', 0) : null
  }
  return { feed, cut: () => (open && length > 0 ? whole('timer', 0) : null), reset, held: () => length }
}

/**
 * Bidirectional protocol: `ENQ, length (2, low first), data, sum (2, low first)` and the answers to our own messages.
 *
 * @param {any} settings of c24-settings.js
 * @param {{ skipped: number }} counts
 * @returns {{ feed: (value: number) => any, cut: () => any, reset: () => void, held: () => number, starts: (value: number) => boolean }} what comes
 *   out: a message `{ by: 'length', bytes }`, `{ refuse: code }`, or an answer `{ answer: 'ack' }`, `{ answer: 'nak', code }`
 */
function createBidirectionalFraming({ unit, sumCheck, mostBytes }, counts) {
  /** @type {number[]} */
  let taken = []
  const reset = () => void (taken = [])
  const finish = result => {
    reset()
    return result
  }
  const begin = value => {
    if (value === ACK) return { answer: 'ack' }
    if (value === ENQ || value === NAK) taken = [value]
    else counts.skipped++
    return null
  }
  const message = () => {
    if (taken.length < 3) return null
    const size = (taken[1] | (taken[2] << 8)) * (unit === 'word' ? 2 : 1)
    if (size > mostBytes) return finish({ refuse: CODES.length })
    if (taken.length < 3 + size + (sumCheck ? 2 : 0)) return null
    const sum = taken.slice(1, 3 + size).reduce((total, byte) => total + byte, 0) & 0xffff
    const data = Buffer.from(taken.slice(3, 3 + size))
    const [low, high] = sumCheck ? taken.slice(3 + size) : [sum & 255, sum >> 8]
    return finish(low + high * 256 === sum ? { by: 'length', bytes: data } : { refuse: CODES.sum })
  }
  const feed = value => {
    if (taken.length === 0) return begin(value)
    taken.push(plain(value))
    if (taken[0] === ENQ) return message()
    return taken.length === 3 ? finish({ answer: 'nak', code: taken[1] | (taken[2] << 8) }) : null
  }
  const cut = () => {
    if (taken.length === 0) return null
    return finish(taken[0] === ENQ ? { refuse: CODES.timeout } : null)
  }
  return { feed, cut, reset, held: () => taken.length, starts: value => taken.length === 0 && value === ENQ }
}

/** What the module sends in the bidirectional protocol; an odd byte is padded in words. */
function bidirectionalMessage(bytes, { unit, sumCheck }) {
  const data = unit === 'word' && bytes.length % 2 ? Buffer.concat([bytes, Buffer.of(0)]) : bytes
  const size = unit === 'word' ? data.length / 2 : data.length
  const body = Buffer.concat([Buffer.of(size & 255, size >> 8), data])
  const sum = body.reduce((total, byte) => total + byte, 0) & 0xffff
  return Buffer.concat([Buffer.of(ENQ), body, ...(sumCheck ? [Buffer.of(sum & 255, sum >> 8)] : [])])
}

const acknowledgement = code => (code ? Buffer.of(NAK, code & 255, code >> 8) : Buffer.of(ACK))

/**
 * @typedef {{ by: 'code'|'frame'|'count'|'timer'|'length', bytes: Buffer, frames?: boolean }} Taken
 */

module.exports = {
  createFreeFraming,
  createBidirectionalFraming,
  bidirectionalMessage,
  acknowledgement,
  plain,
  LITERAL,
  CODES
}
