'use strict'

const SIO_ERROR = 1 << 1

/** The bytes as words, low byte first; an odd one gets 00 above it. */
function wordsOf(bytes) {
  const words = []
  for (let n = 0; n < bytes.length; n += 2) words.push(bytes[n] | ((bytes[n + 1] ?? 0) << 8))
  return words
}

const countOf = (length, unit) => (unit === 'word' ? Math.ceil(length / 2) : length)

/**
 * Buffer memory of the module, as far as free messages use it: a count and words in the receive and in the sending area, the
 * error information and the last results.
 * @param {any} settings of c24-settings.js
 */
function createC24Memory({ at, unit }) {
  /** @type {Map<number, number>} */
  const words = new Map()
  const get = address => words.get(address) ?? 0
  const image = (address, bytes) => {
    words.set(address, countOf(bytes.length, unit))
    wordsOf(bytes).forEach((word, n) => words.set(address + 1 + n, word))
  }
  return {
    get,
    words: (address, count) => Array.from({ length: count }, (_, n) => get(address + n)),
    /** What the sequence program sees. With user frames the last byte of an odd number is not counted in word units. */
    received(bytes, frames = false) {
      image(at.receive, bytes)
      const odd = frames && unit === 'word' && bytes.length % 2 === 1
      if (odd) words.set(at.receive, get(at.receive) - 1)
      return { bytes: odd ? bytes.subarray(0, -1) : bytes, count: get(at.receive) }
    },
    sending: bytes => image(at.send, bytes),
    result: (which, code) => void words.set(at[`${which}Result`], code),
    sioError: () => (get(at.error) & SIO_ERROR) !== 0,
    setSioError: on => void words.set(at.error, on ? get(at.error) | SIO_ERROR : get(at.error) & ~SIO_ERROR),
    clear: () => words.clear()
  }
}

module.exports = { createC24Memory, wordsOf }
