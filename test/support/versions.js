'use strict'

/** What simulated stations hold in tests on real ports: ten words that change together, so that a value can be judged by itself and by its time. */

const BLOCK = 10

/** Ten words that belong together and to one station: no two versions, and no two stations, share them. */
const wordsOf = (station, version) =>
  Array.from({ length: BLOCK }, (_, n) => (n === 0 ? version : version * (n + 3) + station * 257 + n) & 0xffff)

/** When a station began to hold a version. @param {{ most?: number }} [options] most: so many changes are remembered */
function createHistory({ most = Infinity } = {}) {
  const changes = []
  return {
    changes,
    at(time, value) {
      changes.push({ time, value })
      if (changes.length > 2 * most) changes.splice(0, changes.length - most)
    },
    /** What was held at any moment between two times. */
    between: (from, to) =>
      changes
        .filter(({ time }, n) => time <= to && (changes[n + 1]?.time ?? Infinity) >= from)
        .map(({ value }) => value)
  }
}

/**
 * Changes what stations hold, all at once, and remembers when.
 * @param {{ memory: any, number: number, first: string }[]} rows first: name of the first word without its number, `M` of M0..M9
 * @param {{ every: number, most?: number }} options every: ms between two changes
 */
function startVersions(rows, { every, most }) {
  const histories = rows.map(() => createHistory({ most }))
  let version = 0
  const change = () => {
    version = (version + 1) & 0xffff
    rows.forEach(({ memory, number, first }, n) => {
      wordsOf(number, version).forEach((word, at) => memory.set(`${first}${at}`, word))
      histories[n].at(performance.now(), version)
    })
  }
  change()
  const timer = setInterval(change, every)
  return {
    histories,
    /** Whether a station can have held these words at some moment between two times. */
    isHeld(n, words, from, to) {
      const [version_] = words
      return (
        histories[n].between(from, to).includes(version_) && String(words) === String(wordsOf(rows[n].number, version_))
      )
    },
    stop: () => clearInterval(timer)
  }
}

module.exports = { BLOCK, startVersions, wordsOf }
