'use strict'

/**
 * When each word and bit of a station was last written, by whatever name: for the least time between two writes of the same. No timers.
 *
 * @typedef {{ at: number, by: symbol }} Mark `at`: ms of the clock; `by`: the write, so that it does not wait for itself
 * @typedef {{ words: Map<number, Mark>, bits: Map<number, Mark> }} Written by absolute address
 * @typedef {{ kind: 'bit'|'word', address: number, count: number, text: string }} Point
 */

const WORD = 16
/** Marks kept before those are dropped that bind no more. */
const MOST_MARKS = 20000
const NEVER = -Infinity

/** The marks that stand on one word or bit: a word overlaps its sixteen bits. */
const marksOn = ({ words, bits }, kind, place) => {
  if (kind === 'bit') return [words.get(place >> 4), bits.get(place)]
  const within = bits.size === 0 ? [] : Array.from({ length: WORD }, (_, bit) => bits.get(place * WORD + bit))
  return [words.get(place), ...within]
}

const placesOf = ({ address, count }) => Array.from({ length: count }, (_, at) => address + at)

class Intervals {
  #written
  #interval
  #clock

  /** @param {{ written: Written, interval: number, clock: { now: () => number } }} options written: kept over redeploys; interval: ms, 0: none */
  constructor({ written, interval, clock }) {
    this.#written = written
    this.#interval = interval
    this.#clock = clock
  }

  /**
   * How long these points must not be written yet.
   * @param {Point[]} points
   * @param {symbol} [by] the write that asks; its own marks do not count
   * @returns {{ ms: number, text: string }} ms: 0: now; text: of the point that must wait longest
   */
  wait(points, by) {
    let longest = { ms: 0, text: '' }
    if (this.#interval === 0) return longest
    for (const point of points) {
      const ms = this.#leftAt(point, by)
      if (ms > longest.ms) longest = { ms, text: point.text }
    }
    return longest
  }

  #leftAt(point, by) {
    let most = 0
    for (const place of placesOf(point)) {
      for (const mark of marksOn(this.#written, point.kind, place)) {
        if (mark && (mark.by !== by || by === undefined)) most = Math.max(most, this.#left(mark))
      }
    }
    return most
  }

  #left({ at }) {
    return at + this.#interval - this.#clock.now()
  }

  /**
   * These points are written now.
   * @param {Point[]} points
   * @param {symbol} by
   * @returns {Mark}
   */
  mark(points, by) {
    const mark = { at: this.#clock.now(), by }
    if (this.#interval === 0) return mark
    const { words, bits } = this.#written
    if (words.size + bits.size > MOST_MARKS) this.#forget()
    for (const point of points) {
      const marks = point.kind === 'word' ? words : bits
      for (const place of placesOf(point)) marks.set(place, mark)
    }
    return mark
  }

  #forget() {
    for (const marks of Object.values(this.#written)) {
      for (const [place, mark] of marks) if (this.#left(mark) <= 0) marks.delete(place)
    }
  }

  /** It goes out now. @param {Mark} mark */
  again(mark) {
    mark.at = this.#clock.now()
  }

  /** It never went out. @param {Mark} mark */
  drop(mark) {
    mark.at = NEVER
  }
}

/** @param {Record<string, any>} memory of the station @returns {Written} */
const writtenOf = memory => (memory.written ??= { words: new Map(), bits: new Map() })

module.exports = { Intervals, writtenOf }
