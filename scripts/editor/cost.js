'use strict'
const { predict } = require('../../lib/device/predict')
const { device, isItem, isModbus, reads, showsList, value } = require('./form')
const { attempt } = require('./model')
const { say } = require('./widgets')
const { t } = require('./texts')

/** What a node that reads will take of its line's time, while its dialog is open. */

const MOST = 90 // percent
const LIMITS = ['readWords', 'readBits']

/** A setting that is a variable, or was left empty, has its default here. */
const plain = settings =>
  Object.fromEntries(
    Object.entries(settings).filter(
      ([, given]) => given !== '' && !(typeof given === 'string' && given.startsWith('${'))
    )
  )

const settingsOf = ({ station, ...given }) => {
  const known = plain(given)
  const limits = Object.fromEntries(LIMITS.filter(limit => known[limit]).map(limit => [limit, Number(known[limit])]))
  // the number of the station costs nothing
  return {
    ...known,
    station: Number(station) || 1,
    access: 'read',
    writableRanges: '',
    ...(isModbus() ? {} : { limits })
  }
}

/** @param {string[]} items @returns {{ percent: number, ms: number, requests: number } | null} null: that cannot be told */
const costOf = items => {
  const interval = Number(value('interval'))
  const good = items.filter(isItem)
  if (!(interval >= 10) || good.length === 0) return null
  const settings = device()
  const line = plain(RED.nodes.node(settings.line) || {})
  const subscriptions = [{ items: good, interval }]
  const stations = [{ device: isModbus() ? 'chino' : 'nx', settings: settingsOf(settings), subscriptions }]
  return attempt(
    () => predict({ line: /** @type {any} */ (line), stations: /** @type {any} */ (stations) }).asksMost,
    null
  )
}

const round = number => (number < 10 ? Math.round(number * 10) / 10 : Math.round(number))

/** @param {string[]} items of the list */
const showCost = items => {
  const block = $('#nxline-read-cost')
  const cost = showsList() ? costOf(items) : null
  if (!cost) return block.empty()
  const { percent, ms, requests } = cost
  const figures = { ms: round(percent * 10), percent: round(percent), cycle: round(ms), requests }
  const more = percent > MOST ? ` ${t('editor.readCostMore')}` : ''
  return say(block, t('editor.readCost', figures) + more, percent > MOST)
}

/** With a report of changes alone, the longest silence counts. */
const showSilence = () => $('.nxline-silence').toggle(reads() && value('report') !== 'all')

module.exports = { showCost, showSilence }
