'use strict'

/**
 * What those who poll on a line expect to take of its time. They say it themselves: the line knows no protocol.
 *
 * @typedef {{ percent: number, busyPercent: number, asked: { name: string, percent: number, owner: any }[] }} Load of one who polls
 */

const round = value => Math.round(10 * value) / 10

/**
 * All of them together.
 * @param {Set<() => Load>} loads
 * @returns {{ percent: number, busyPercent: number, most: { name: string, percent: number, owner: any } | null }} percent of the line's time, with the
 *   silences before frames and without; most: who asks for most, by itself
 */
const totalLoad = loads => {
  let percent = 0
  let busyPercent = 0
  let most = null
  for (const load of loads) {
    const own = load()
    percent += own.percent
    busyPercent += own.busyPercent
    for (const each of own.asked) if (!most || each.percent > most.percent) most = each
  }
  return { percent: round(percent), busyPercent: round(busyPercent), most }
}

module.exports = { totalLoad }
