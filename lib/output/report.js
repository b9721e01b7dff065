'use strict'
const { expandRanges } = require('./messages')

/**
 * Report by exception. Pure but for what it remembers: the values that were reported last.
 *
 * @typedef {import('./messages').Result} Result
 */

/** A value has left its deadband around the one that was reported last. */
const moved = (now, before, deadband) => {
  if (Array.isArray(now) && Array.isArray(before)) {
    return now.length !== before.length || now.some((value, index) => moved(value, before[index], deadband))
  }
  if (deadband > 0 && typeof now === 'number' && typeof before === 'number') return Math.abs(now - before) > deadband
  return now !== before
}

/**
 * @param {object} [options]
 * @param {'all'|'changed'|'allOnChange'} [options.report] `all`: everything each time; `changed`: only what changed since it
 *   was last reported; `allOnChange`: everything, if something changed
 * @param {'array'|'values'} [options.ranges] `values`: each value of a range is judged alone
 * @returns {((results: Result[]) => Result[]) & { reset: () => void }} what is to be reported now, may be empty; a change of
 *   quality or code is a change, too. `reset`: the next time everything counts as changed
 */
const createReport = ({ report = 'all', ranges = 'array' } = {}) => {
  const last = new Map()
  const isNew = ({ name, value, quality, code, deadband = 0 }) => {
    const before = last.get(name)
    return !before || before.quality !== quality || before.code !== code || moved(value, before.value, deadband)
  }
  const remember = results => {
    for (const { name, value, quality, code } of results) last.set(name, { value, quality, code })
    return results
  }
  const judge = results => {
    const wanted = ranges === 'values' ? expandRanges(results) : results
    if (report === 'all') return wanted
    const changed = wanted.filter(isNew)
    if (report === 'changed') return remember(changed)
    return changed.length > 0 ? remember(wanted) : []
  }
  return Object.assign(judge, { reset: () => last.clear() })
}

module.exports = { createReport }
