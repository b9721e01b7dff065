'use strict'
const { cycleCost } = require('./model')
const { together } = require('./together')

/**
 * What polling costs before it begins, from the plans and the line's own figures. Pure.
 *
 * @typedef {import('./reads').ReadRequest} ReadRequest
 * @typedef {object} Wire
 * @property {number} character ms
 * @property {number} gap ms of silence before each frame of ours
 * @property {number} silences frames of ours in one request
 *
 * @typedef {{ interval: number, points: any[] }} Group what is polled at one interval, ms
 * @typedef {{ intervals: number[], every: number, ms: number, busy: number, requests: number }} Cycle of these intervals together; `every` so many
 *   ms on average it comes; `ms` it takes, of which bytes and answers are `busy`
 * @typedef {{ percent: number, busyPercent: number, cycles: Cycle[] }} Load of the line's time: with the silences that requests must keep, and without
 */

const MOST_TICKS = 1000
const MOST_INTERVALS = 50 // more are taken as if they never met

/** Intervals that meet: the shortest one and its multiples. @param {number[]} intervals ascending */
const families = intervals => {
  const all = []
  for (const interval of intervals) {
    const own = all.find(([first]) => interval % first === 0)
    if (own && intervals.length <= MOST_INTERVALS) own.push(interval)
    else all.push([interval])
  }
  return all
}

const commonMultiple = (a, b) => {
  let [x, y] = [a, b]
  while (y > 0) [x, y] = [y, x % y]
  return (a / x) * b
}

/** Which intervals of a family are due together, and how often: `[{ intervals, every }]`. */
const moments = family => {
  const [first] = family
  const ticks = Math.min(MOST_TICKS, family.map(each => Math.round(each / first)).reduce(commonMultiple, 1))
  const sets = new Map()
  for (let tick = 0; tick < ticks; tick++) {
    const due = family.filter(interval => tick % Math.round(interval / first) === 0)
    const key = due.join()
    const set = sets.get(key) ?? { intervals: due, times: 0 }
    set.times++
    sets.set(key, set)
  }
  return [...sets.values()].map(({ intervals, times }) => ({ intervals, every: (first * ticks) / times }))
}

const sum = (list, of) => list.reduce((total, each) => total + of(each), 0)

/** What requests take each cycle; `again`: they are all that the station is asked for, so that it may repeat. @param {ReadRequest[]} requests */
const timesOf = (requests, { character, gap, silences }, again) => {
  if (requests.length === 0) return { ms: 0, busy: 0 }
  const isRepeated = again && requests.some(request => request.again < request.cost)
  const bytes = isRepeated ? cycleCost(/** @type {any} */ (requests)) : sum(requests, ({ cost }) => cost)
  const ms = bytes * character
  // the short form is one frame of ours
  const frames = requests.length * silences - (isRepeated ? silences - 1 : 0)
  return { ms, busy: Math.max(0, ms - frames * gap) }
}

/**
 * What a station's polling takes of the line's time.
 * @param {Group[]} groups one for each interval
 * @param {Wire & { requestsOf: (points: any[]) => ReadRequest[] }} wire
 * @returns {Load}
 */
const loadOf = (groups, { requestsOf, ...wire }) => {
  const byInterval = new Map(groups.map(group => [group.interval, group]))
  const plan = parts => requestsOf(parts.length === 1 ? parts[0].points : parts.flatMap(({ points }) => points))
  const msOf = parts => timesOf(plan(parts), wire, false).ms
  const due = families([...byInterval.keys()].sort((a, b) => a - b)).flatMap(moments)
  const asked = due.flatMap(({ intervals, every }) =>
    together(
      intervals.map(interval => byInterval.get(interval)),
      msOf
    ).map(parts => ({ parts, every }))
  )
  const cycles = asked.map(({ parts, every }) => {
    const requests = plan(parts)
    const intervals = parts.map(({ interval }) => interval)
    return { intervals, every, requests: requests.length, ...timesOf(requests, wire, asked.length === 1) }
  })
  const percent = of => 100 * sum(cycles, cycle => of(cycle) / cycle.every)
  return { percent: percent(({ ms }) => ms), busyPercent: percent(({ busy }) => busy), cycles }
}

module.exports = { loadOf }
