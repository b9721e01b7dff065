'use strict'

const { PlcError } = require('../error')

/**
 * What all simulated stations have in common, whatever their protocol.
 *
 * @template Frame
 * @param {{ station: number, memory: any, counts: any, writes: Map<string, number>, turnaround: () => number }} own
 * @param {object} protocol
 * @param {(bytes: Buffer, times: { start: number, end: number }) => (Frame & { bytes: Buffer })[]} protocol.receiver whole frames
 * @param {(frame: Frame) => boolean} protocol.isForMe
 * @param {(frame: Frame, refuse?: number) => Buffer | null} protocol.answer computed when the station gets to it
 * @param {(bytes: Buffer, context: { random: import('./random').Random, taken: number[] }) => Buffer} protocol.disguise
 * @returns {Station}
 */
function createStation({ station, memory, counts, writes, turnaround }, { receiver, isForMe, answer, disguise }) {
  return {
    station,
    memory,
    get: memory.get,
    set: memory.set,
    heldBetween: memory.heldBetween,
    counts,
    writes,
    receive: (bytes, times) =>
      receiver(bytes, times)
        .filter(isForMe)
        .map(frame => ({
          request: frame.bytes,
          turnaround: turnaround(),
          answer: refuse => answer(frame, refuse)
        })),
    disguise
  }
}

/**
 * @param {unknown} station
 * @param {{ least: number, most: number, what: string }} range
 * @throws {PlcError} BAD_STATION
 */
function checkStation(station, { least, most, what }) {
  if (Number.isInteger(station) && Number(station) >= least && Number(station) <= most) return
  throw new PlcError('BAD_STATION', { station, reason: `${what} has a number from ${least} to ${most}` })
}

/**
 * How long a station takes before it answers.
 * @param {{ turnaround?: number | [number, number], random?: import('./random').Random }} settings ms, or [least, most]
 * @returns {() => number}
 */
function turnaroundOf({ turnaround = 2, random }) {
  const [least, most] = Array.isArray(turnaround) ? turnaround : [turnaround, turnaround]
  return () => (random && most > least ? least + random.next() * (most - least) : least)
}

const emptyCounts = () => ({ queries: 0, executed: 0, errors: 0, badCrc: 0, foreign: 0, strayBytes: 0 })

/** Counts a write that was carried out. */
const noteWrite = (writes, key) => void writes.set(key, (writes.get(key) ?? 0) + 1)

/**
 * @typedef {object} Station
 * @property {number} station
 * @property {any} memory
 * @property {(text: string, type?: string) => number | boolean} get `get('W10', 'float32')`
 * @property {(text: string, value: number | boolean, type?: string) => void} set
 * @property {(word: number, from: number, to: number) => number[]} heldBetween see words.js
 * @property {ReturnType<typeof emptyCounts>} counts
 * @property {Map<string, number>} writes how often each address was written
 * @property {(bytes: Buffer, times: { start: number, end: number }) => Job[]} receive bytes heard on the wire between two times
 * @property {(bytes: Buffer, context: { random: import('./random').Random, taken: number[] }) => Buffer} disguise the same answer as another
 *   station would send it: right in form, other data; taken: the numbers on this wire
 * @typedef {{ request: Buffer, turnaround: number, answer: (refuse?: number) => Buffer | null }} Job `answer` carries the query out, or refuses it with
 *   an error number; null: silence
 */

module.exports = { createStation, checkStation, turnaroundOf, emptyCounts, noteWrite }
