'use strict'

/**
 * A conversation that tells when each of its frames goes out.
 * @template T
 * @param {Generator<any, T, Buffer>} dialog
 * @param {() => void} [sent] called at the first byte of each
 * @returns {Generator<any, T, Buffer>}
 */
function* announced(dialog, sent) {
  if (!sent) return yield* dialog
  let next = dialog.next()
  try {
    while (!next.done) {
      let answer
      try {
        answer = yield { ...next.value, sent }
      } catch (error) {
        next = dialog.throw(error)
        continue
      }
      next = dialog.next(answer)
    }
    return next.value
  } finally {
    dialog.return(/** @type {any} */ (undefined))
  }
}

module.exports = { announced }
