'use strict'

const FACTOR = 4
const ROUNDS = 5
const ATTEMPTS = 3
/** A growth with the square is never below this. */
const DOUBTFUL = 7

const fastest = run => {
  let best = Infinity
  for (let round = 0; round < ROUNDS; round++) {
    const start = process.hrtime.bigint()
    run()
    best = Math.min(best, Number(process.hrtime.bigint() - start))
  }
  return best
}

/**
 * How much longer it takes for four times as much, in the same run and so on any machine: about 4 if the work grows with its input, 16 if it grows
 * with the square.
 * @param {(size: number) => void} run @param {number} size
 * @returns {number}
 */
const growth = (run, size) => {
  run(size)
  let least = Infinity
  // other programs on the machine can only make it look worse: then once more
  for (let attempt = 0; attempt < ATTEMPTS && least > DOUBTFUL; attempt++)
    least = Math.min(least, fastest(() => run(size * FACTOR)) / fastest(() => run(size)))
  return least
}

module.exports = { growth }
