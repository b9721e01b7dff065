'use strict'

/**
 * What was measured -> a row of the bench, with its verdict. Pure.
 *
 * @typedef {object} Measured
 * @property {string} name what was measured
 * @property {number} value ours
 * @property {string} unit of the value
 * @property {string} against the peer or the limit, measured or known in the same run
 * @property {number} ratio of the value to that of the peer or the limit
 * @property {['<=' | '>=', number]} goal of the ratio
 *
 * @typedef {{ name: string, value: number, unit: string, against: string, ratio: number, goal: string, holds: boolean }} Row
 */

const SIGNS = {
  '<=': (ratio, bound) => ratio <= bound,
  '>=': (ratio, bound) => ratio >= bound
}

/** So many digits as a measurement is worth; the verdict is about what is shown. */
const rounded = number => Number(number.toPrecision(4))

/**
 * @param {Measured} measured
 * @returns {Row} whatever is no number misses its goal
 */
const judge = ({ name, value, unit, against, ratio, goal: [sign, bound] }) => {
  const shown = rounded(ratio)
  return {
    name,
    value: rounded(value),
    unit,
    against,
    ratio: shown,
    goal: `${sign} ${bound}`,
    holds: SIGNS[sign](shown, bound)
  }
}

/** A row for people. @param {Row} row */
const lineOf = ({ name, value, unit, against, ratio, goal, holds }) =>
  `${holds ? 'ok  ' : 'MISS'} ${name}: ${value} ${unit}, ${ratio} x ${against} (goal ${goal})`

module.exports = { judge, lineOf }
