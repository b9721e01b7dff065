'use strict'
const { functionOf } = require('./functions')

const SIZE = 0x10000

/**
 * A read of bits in a whole multiple of the panel's "read bit unit": the start stays, the count grows. Where the last numbers or the limit leave no
 * room for that, it stays as it is.
 * @param {any} query of a function that reads
 * @param {{ unit: number, most?: number }} options `most`: bits in one read, default what the function allows
 * @returns {any} the query, or one with a larger count
 */
function roundUp(query, { unit, most = Infinity }) {
  const row = functionOf(query.fn)
  if (row.unit !== 'bits' || !(unit > 1)) return query
  const count = Math.ceil(query.count / unit) * unit
  return count <= Math.min(row.most, most) && query.base + count <= SIZE ? { ...query, count } : query
}

module.exports = { roundUp }
