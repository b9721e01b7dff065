'use strict'
const { PlcError } = require('../error')
const { lineTimes } = require('../line/timing')
const { loadOf } = require('../plan')
const { parseItem } = require('../tag/item')
const { readSettings: readChino } = require('./chino-settings')
const { pointsOf } = require('./points')
const { readSettings: readNx } = require('./settings')

/** What polling will cost, without a line, a device or a clock. The editor bundles this file. */

const READERS = { nx: readNx, chino: readChino }

/** @typedef {{ name: string, station: number|string, interval: number, ms: number, percent: number, requests: number }} Asked a subscription by itself */

const timesOf = ({ baudRate = 19200, dataBits = 8, parity = 'none', stopBits = 1, gap = 0 }) => {
  const numbers = {
    baudRate: Number(baudRate),
    dataBits: Number(dataBits),
    stopBits: Number(stopBits),
    gap: Number(gap)
  }
  return lineTimes({ ...numbers, parity, slack: 0, transport: 'serial' })
}

/** Groups by interval, those of equal ones together. */
const groupsOf = asked => {
  const groups = new Map()
  for (const { interval, points } of asked) groups.set(interval, [...(groups.get(interval) ?? []), ...points])
  return [...groups].map(([interval, points]) => ({ interval, points }))
}

const stationLoad = ({ device = 'nx', settings: given, subscriptions }, times) => {
  const read = READERS[device]
  if (!read) throw new PlcError('BAD_SETTING', { setting: 'device', value: device, reason: 'known are nx, chino' })
  const { plan, notation, station } = read(given, times.character, times.gap)
  const wire = { requestsOf: points => plan.reads(points), ...times, gap: plan.gap, silences: plan.silences }
  const asked = subscriptions.map(({ items, interval, name = '' }) => {
    const points = pointsOf(items.map(text => parseItem(text, notation)))
    const alone = loadOf([{ interval, points }], wire)
    const [{ ms, requests }] = alone.cycles
    return { name, station, interval, points, ms, requests, percent: alone.percent }
  })
  return { station, ...loadOf(groupsOf(asked), wire), asked: asked.map(({ points: _points, ...row }) => row) }
}

/**
 * What a set of subscriptions will cost: ms per cycle, percent of the line, which one asks for most.
 * @param {object} polling
 * @param {{ baudRate?: number, dataBits?: number, parity?: string, stopBits?: number, gap?: number }} polling.line
 * @param {{ device?: 'nx'|'chino', settings: Record<string, any>, subscriptions: { items: string[], interval: number, name?: string }[] }[]} polling.stations
 *   `settings` as of `createNxPlc` or `createChinoRegulator`
 * @returns {{ percent: number, busyPercent: number, asksMost: Asked | null, stations: (import('../plan/prediction').Load & { station: number,
 *   asked: Asked[] })[] }} `percent` of the line's time, above 100: more than it can do; `busyPercent` the same without the silences that
 *   requests must keep, as plc-monitor measures it; `asked`: each subscription, as if it were alone
 * @throws {PlcError} those of the settings and of the items; FRAME_TOO_LONG
 */
const predict = ({ line, stations }) => {
  const times = timesOf(line)
  const loads = stations.map(station => stationLoad(station, times))
  const sum = key => loads.reduce((total, load) => total + load[key], 0)
  const asked = loads.flatMap(load => load.asked)
  const asksMost = asked.reduce((most, each) => (most && most.percent >= each.percent ? most : each), asked[0] ?? null)
  return { percent: sum('percent'), busyPercent: sum('busyPercent'), asksMost, stations: loads }
}

module.exports = { predict }
