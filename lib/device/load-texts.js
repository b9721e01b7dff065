'use strict'

/** What is said of polls that ask for too much. Pure. */

const MOST = 90 // percent of a line's time: writes and repeats need some, too
const WANTED = 80
const SPARE = 1.25 // times what a cycle takes

const DIGITS = 2

/** A number that people set: two digits, rounded up. @param {number} ms */
const nice = ms => {
  const unit = 10 ** Math.max(1, Math.floor(Math.log10(ms)) + 1 - DIGITS)
  return Math.ceil(ms / unit - 1e-9) * unit
}

/** An interval that would fit. */
const fitting = ({ interval, ms, linePercent }) =>
  nice(Math.max(SPARE * ms, linePercent > MOST ? (interval * linePercent) / WANTED : 0))

const round = value => Math.round(value)

/**
 * @param {{ station: number, missed: number, interval: number, took: number, ms: number, requests: number, linePercent: number }} facts `took`: ms that
 *   the last cycle took; `ms`: it would take by itself; `linePercent`: all polls of the line take of its time
 * @returns {any} the event; null: the polls fit, something else held up this cycle
 */
const overrunEvent = facts => {
  const { station, missed, interval, took, ms, requests, linePercent } = facts
  const cause = `station ${station}: ${missed} cycles in a minute were left out. It is polled every ${interval} ms; a cycle needs ${round(ms)} ms of the line (${requests} requests), the last one took ${round(took)} ms, and all polls of the line want ${round(linePercent)} % of its time`
  const fits = fitting(facts)
  const isTooMuch = linePercent > MOST || ms > interval
  if (!isTooMuch && took <= interval) return null
  const remedy = isTooMuch
    ? `Poll every ${fits} ms or less often, or fewer items, or raise the speed of the line.`
    : 'The polls would fit: timeouts, repeats or other requests take the time. Look at the statistics of the line.'
  const figures = { interval, ms: round(ms), took: round(took), missed, percent: linePercent }
  return { event: 'overrun', station, ...figures, fits: isTooMuch ? fits : null, cause, remedy }
}

/**
 * What a node says at deploy that asks for more than the line can do, or null.
 * @param {{ ms: number, percent: number, interval: number, linePercent: number }} facts of the subscription that asks for most
 * @returns {string | null}
 */
const overloadText = ({ ms, percent, interval, linePercent }) => {
  if (linePercent <= MOST) return null
  const fits = fitting({ interval, ms, linePercent })
  return `The polls of this line want ${round(linePercent)} % of its time. This node asks for most: ${round(ms)} ms every ${interval} ms, ${round(percent)} %. Poll every ${fits} ms or less often, or fewer items.`
}

module.exports = { overloadText, overrunEvent }
