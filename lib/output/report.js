'use strict'
const { expandRanges } = require('./messages')

/**
 * Report by exception. Pure but for what it remembers: the values that were reported last.
 *
 * @typedef {import('./messages').Result} Result
 */

/** Engineering units; `2%` is of the value that was reported last. */
const widthOf = (deadband, before) =>
  typeof deadband === 'string' ? (Number(deadband.replace('%', '')) / 100) * Math.abs(before) : deadband

/** A value has left its deadband around the one that was reported last. */
const moved = (now, before, deadband) => {
  if (Array.isArray(now) && Array.isArray(before)) {
    return now.length !== before.length || now.some((value, index) => moved(value, before[index], deadband))
  }
  if (deadband === 0 || typeof now !== 'number' || typeof before !== 'number') return now !== before
  return Math.abs(now - before) > widthOf(deadband, before)
}

/**
 * @param {object} [options]
 * @param {'all'|'changed'|'allOnChange'} [options.report] `all`: everything each time; `changed`: only what changed since it
 *   was last reported; `allOnChange`: everything, if something changed
 * @param {'array'|'values'} [options.ranges] `values`: each value of a range is judged alone
 * @param {number} [options.maxSilence] ms after which a value is reported again also where it has not changed; 0 (default): never
 * @returns {((results: Result[], now?: number) => Result[]) & { reset: () => void }} what is to be reported now, may be empty; a change of
 *   quality or code is a change, too. `now`: ms of a monotonic clock, for `maxSilence`. `reset`: the next time everything counts as changed
 */
const createReport = ({ report = 'all', ranges = 'array', maxSilence = 0 } = {}) => {
  const last = new Map()
  let before = -Infinity
  // what comes next may come too late: the nearest of the two
  const isSilent = (at, now, step) => maxSilence > 0 && now + Math.min(step, maxSilence) / 2 - at >= maxSilence
  const isNew = ({ name, value, quality, code, deadband = 0 }) => {
    const known = last.get(name)
    return !known || known.quality !== quality || known.code !== code || moved(value, known.value, deadband)
  }
  const remember = (results, at) => {
    for (const { name, value, quality, code } of results) last.set(name, { value, quality, code, at })
    return results
  }
  const judge = (results, now = 0) => {
    const wanted = ranges === 'values' ? expandRanges(results) : results
    if (report === 'all') return wanted
    const step = now - before
    before = now
    const due = wanted.filter(result => isNew(result) || isSilent(last.get(result.name).at, now, step))
    if (report === 'changed') return remember(due, now)
    return due.length > 0 ? remember(wanted, now) : []
  }
  return Object.assign(judge, { reset: () => last.clear() })
}

module.exports = { createReport }
