'use strict'

/**
 * One step on the wire, from the gap before it to its end; see exchange.js. One literal: made of parts (`...`) it would cost a hundred times as much,
 * and its shape would change later on.
 * @param {any} step of a conversation
 * @param {{ station: any, turnaround: number | null, sent: () => void, noted: () => void, done: (error: any, answer: Buffer, facts: any) => void }} options
 * @param {number} now ms of the clock
 */
const jobOf = (step, { station, turnaround, sent, noted, done }, now) => ({
  step,
  station,
  turnaround,
  sent,
  noted,
  done,
  /** when it began, ms */
  from: now,
  /** `gap`, `awaiting` */
  phase: 'gap',
  writing: false,
  written: false,
  /** why it could not be written */
  fault: null,
  sentAt: 0,
  /** when it ends if nothing more comes, ms */
  due: 0,
  /** the timer was late: the bytes have had time to come in */
  graced: false,
  /** bytes that are needed at least, and whether they are known to be the answer's */
  need: 0,
  ours: false,
  /** bytes that have come, in so many reads; when the first of the answer were read, and how many these were */
  bytes: 0,
  reads: 0,
  first: null
})

module.exports = { jobOf }
