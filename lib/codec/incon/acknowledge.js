'use strict'
const { START, missingBetween, nextNumber, unseal, xor } = require('./check')

/**
 * Checked lines that are acknowledged, an option of ours (the controller's PLC program must speak it, too). Each side answers a whole line `#NN text*HH`
 * with `!NN*HH`, HH the XOR of `!NN`, and repeats its own until that comes. Numbers 01 to 99 are those of lines. `#00 text` is no line: it says that its
 * sender has just started and knows of nothing before; the text (ours is random) only tells one start from another.
 *
 * What makes a repetition safe over a start: who has started takes no line until its `#00` is acknowledged, and who acknowledges it never repeats again
 * what he sent before. So what comes after the acknowledgement of a start was not sent to a former life.
 *
 * @typedef {{ number: number, text: Buffer }} Line
 * @typedef {{ last: { number: number, text: Buffer | null } | null, doubtful: Line | null }} Reception what is known of the lines that came;
 *   last: the one accepted last, null after our own start: any number may come
 */

const BANG = 0x21
const STAR = 0x2a
const ACK_LENGTH = 6 // !NN*HH
const END = '\r\n'

const twoDigits = number => String(number).padStart(2, '0')
const hex = byte => byte.toString(16).toUpperCase().padStart(2, '0')

/** @param {number} number 0..99 @returns {Buffer} with CR LF; `!07*26` for 7 */
const encodeAck = number => {
  const body = `!${twoDigits(number)}`
  return Buffer.from(`${body}*${hex(xor(Buffer.from(body)))}${END}`)
}

/** @param {Buffer} line without line end @returns {number|null} the number that it acknowledges, null: it is no acknowledgement */
const ackOf = line => {
  if (line.length !== ACK_LENGTH || line[0] !== BANG || line[3] !== STAR) return null
  const [, number, check] = /^!(\d\d)\*([\da-f]{2})$/i.exec(line.toString('latin1')) ?? []
  if (number === undefined || xor(line.subarray(0, 3)) !== parseInt(check, 16)) return null
  return Number(number)
}

/**
 * What a line is where lines are acknowledged.
 * @param {Buffer} line without line end
 * @returns {{ kind: 'ack'|'start', number: number } | { kind: 'line', number: number, text: Buffer } | { kind: 'damaged', reason: 'noCheck'|'check'|'number' }}
 *   number: the check is right, but it has none
 */
const readAcknowledged = line => {
  const acknowledged = ackOf(line)
  if (acknowledged !== null) return { kind: 'ack', number: acknowledged }
  const opened = unseal(line)
  if ('reason' in opened) return { kind: 'damaged', reason: opened.reason }
  const { number, text } = opened
  if (number === null) return { kind: 'damaged', reason: 'number' }
  return number === START ? { kind: 'start', number } : { kind: 'line', number, text }
}

/** @returns {Reception} of one that has just started */
const createReception = () => ({ last: null, doubtful: null })

/** The other side has started: its numbers begin anew. @param {Reception} reception */
const startOver = reception => {
  reception.last = { number: START, text: null }
  reception.doubtful = null
}

/** @param {{ number: number, text: Buffer | null } | null} one @param {Line} other */
const isSame = (one, { number, text }) =>
  one !== null && one.text !== null && one.number === number && one.text.equals(text)

/**
 * Whether a line is a new one. A number that is not due is only believed when the line comes once more, or the one behind it: two damaged bytes may make
 * one number of another, and whoever sends repeats what is not acknowledged.
 * @param {Reception} reception @param {Line} line
 * @returns {{ verdict: 'new'|'repeated'|'doubtful', lost: number }} lost: lines that the other side has given up before this one; new: it
 *   counts when it was given to `accept`
 */
const judge = (reception, line) => {
  const { last, doubtful } = reception
  if (isSame(last, line)) return { verdict: 'repeated', lost: 0 }
  const due = last === null || line.number === nextNumber(last.number)
  const confirmed = isSame(doubtful, line) || (doubtful !== null && line.number === nextNumber(doubtful.number))
  if (due || confirmed) return { verdict: 'new', lost: missingBetween(last?.number ?? null, line.number) }
  reception.doubtful = { number: line.number, text: Buffer.from(line.text) }
  return { verdict: 'doubtful', lost: 0 }
}

/** A line was taken: it is acknowledged, and its repetitions are known. @param {Reception} reception @param {Line} line */
const accept = (reception, { number, text }) => {
  reception.last = { number, text: Buffer.from(text) }
  reception.doubtful = null
}

module.exports = { accept, ackOf, createReception, encodeAck, judge, readAcknowledged, startOver }
