'use strict'

/** Groups of items that are polled while users ask and write: what they deliver is judged like any read, and in the end each must deliver again. */

const { judge, drawItem } = require('./workload')

const INTERVALS = [50, 100, 200, 500, 1000] // ms
/** A cycle's start is computed back from its length: no value is missed by rounding. */
const ROUNDING = 1e-6

/**
 * One or two groups a station.
 * @param {any} system of run.js
 * @returns {Group[]}
 */
const drawGroups = system =>
  system.rows.flatMap((_, index) =>
    Array.from({ length: system.random.integer(1, 2) }, () => ({
      index,
      items: drawItems(system, index),
      interval: system.random.pick(INTERVALS),
      goodAt: -Infinity
    }))
  )

function drawItems(system, index) {
  const items = Array.from({ length: system.random.integer(1, 5) }, () => drawItem(system, index))
  return [...new Map(items.map(item => [item.text, item])).values()]
}

/** Polls all groups by the devices that there are now; closing a device ends its polls. */
function startPolls(system) {
  for (const group of system.groups) {
    const { index, items, interval } = group
    const names = items.map(({ text }) => text)
    system.devices[index].subscribe({ items: names, interval }, (results, cycle) => {
      deliver(system, group, { results, ...cycle })
    })
  }
}

function deliver(system, group, { results, failure, ms }) {
  const { report, clock } = system
  const { index, items } = group
  report.cycles++
  if (results.length !== items.length) {
    const name = `poll: ${failure?.code}`
    report.rejected[name] = (report.rejected[name] ?? 0) + 1
    return
  }
  const to = clock.now()
  results.forEach((result, n) => judge(system, { index, item: items[n], result, from: to - ms - ROUNDING, to }))
  if (results.every(({ quality }) => quality === 'good')) group.goodAt = to
}

/** @typedef {{ index: number, items: any[], interval: number, goodAt: number }} Group `goodAt`: when a whole cycle was good last, ms of the clock */

module.exports = { drawGroups, startPolls }
