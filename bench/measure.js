'use strict'

/** Of lists of measurements. Pure. */

const sorted = list => [...list].sort((a, b) => a - b)

/** @param {number[]} list not empty @returns {number} */
const median = list => sorted(list)[list.length >> 1]

/** The value that a share of them does not exceed. @param {number[]} list not empty @param {number} share 0 to 1 @returns {number} */
const percentile = (list, share) => sorted(list)[Math.max(0, Math.ceil(list.length * share) - 1)]

module.exports = { median, percentile }
