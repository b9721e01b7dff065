'use strict'
const { asciiLength, COLON, CR, LF, fromAscii } = require('./ascii')
const { EXCEPTION } = require('./functions')

/**
 * The answer among the characters of MODBUS ASCII. A colon stands nowhere but at a beginning, so whatever came before the last one is over.
 * @typedef {import('./match').Verdict} Verdict
 */

const SHORTEST = asciiLength(5)

/**
 * @param {import('./answer').Expected} expected
 * @param {{ station: number, fn: number, sent?: Uint8Array }} options
 * @returns {(characters: Uint8Array) => Verdict}
 */
function asciiAnswerTo({ length, header }, { station, fn, sent }) {
  const answer = { header: beginning(header), length: asciiLength(length) }
  const exception = { header: beginning(Buffer.of(station, fn | EXCEPTION)), length: SHORTEST }
  return characters => judge(characters, { frames: [answer, exception], sent })
}

const beginning = bytes => Buffer.from(`:${Buffer.from(bytes).toString('hex').toUpperCase()}`, 'latin1')

/** How many characters from `at` on equal those of `pattern`. */
function begins(characters, at, pattern) {
  let i = 0
  while (i < pattern.length && at + i < characters.length && characters[at + i] === pattern[i]) i++
  return i
}

/** @returns {Verdict} */
function judge(characters, known) {
  if (characters.length === 0) return { need: SHORTEST }
  const start = characters.indexOf(COLON)
  if (start !== 0) return { skip: start < 0 ? characters.length : start }
  const next = characters.indexOf(COLON, 1)
  const limit = next < 0 ? characters.length : next
  const end = endOf(characters, limit)
  if (end > 0) return judgeWhole(characters, { end, more: next > 0 }, known)
  return next > 0 ? { skip: next } : judgePart(characters, known)
}

/** The place behind the first CR LF before `limit`; 0: there is none. */
function endOf(characters, limit) {
  for (let at = 1; at + 1 < limit; at++) if (characters[at] === CR && characters[at + 1] === LF) return at + 2
  return 0
}

/** A frame with its end. @returns {Verdict} */
function judgeWhole(characters, { end, more }, { frames, sent }) {
  const frame = characters.subarray(0, end)
  const own = frames.find(({ header }) => begins(frame, 0, header) === header.length)
  if (!own) return { skip: end }
  const whole = fromAscii(frame) !== null
  if (whole && end === own.length) return { take: end }
  // right checksum, wrong length: somebody else's
  if (whole || more || isEcho(frame, sent, own)) return { skip: end }
  return { bad: 'LRC', length: end }
}

/** The last frame, as far as it has come. @returns {Verdict} */
function judgePart(characters, { frames, sent }) {
  const { length } = characters
  for (const own of frames) {
    const equal = begins(characters, 0, own.header)
    if (equal === own.header.length) {
      if (length < own.length) return { need: own.length, ours: true }
      if (!isEcho(characters, sent, own)) return { bad: 'LRC', length }
      return length < sent.length ? { need: sent.length } : { skip: length }
    }
    if (equal === length) return { need: Math.max(SHORTEST, length + 1) }
  }
  return { skip: length }
}

/** Our own frame, heard by the adapter, with up to a quarter of it damaged: it may begin as an answer does. 05 and 06 are their own answers. */
function isEcho(characters, sent, own) {
  if (!sent || sent.length === own.length) return false
  const length = Math.min(characters.length, sent.length)
  let differences = 0
  for (let i = 0; i < length; i++) if (characters[i] !== sent[i]) differences++
  return differences <= length >> 2
}

module.exports = { asciiAnswerTo }
