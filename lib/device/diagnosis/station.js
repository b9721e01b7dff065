'use strict'
const { PlcError } = require('../../error')
const { createChinoRegulator } = require('../chino-regulator')
const { createNxPlc } = require('../nx-plc')

/** The station that is asked, and what it is asked for. */

const MAKERS = { nx: createNxPlc, rtu: createChinoRegulator, ascii: createChinoRegulator }

/** Addresses that nearly every device has; for MODBUS its refusal is an answer, too. */
const FIRST = { nx: ['M0', 'R0', '@0x0000'], rtu: ['hr0'], ascii: ['hr0'] }
/** So many rows of a tag table are tried for one that can be used. */
const MOST_TAGS = 50

const DEFAULT_TIMEOUT = { nx: 3000, rtu: 1000, ascii: 1000 }

/**
 * @param {unknown} protocol
 * @returns {'nx'|'rtu'|'ascii'}
 * @throws {PlcError} BAD_SETTING
 */
const checkProtocol = protocol => {
  if (protocol === 'nx' || protocol === 'rtu' || protocol === 'ascii') return protocol
  throw new PlcError('BAD_SETTING', { setting: 'protocol', value: protocol, reason: 'known are nx, rtu, ascii' })
}

/** @param {'nx'|'rtu'|'ascii'} protocol @param {unknown} timeout @returns {number} ms */
const timeoutOf = (protocol, timeout) => Number(timeout) || DEFAULT_TIMEOUT[protocol]

/** The line keeps its own gap to the fraction; here it only takes the place of the protocol's. */
const wholeGap = gap => (Number(gap) > 0 ? Math.max(1, Math.floor(Number(gap))) : 0)

/**
 * A device that asks once.
 * @param {any} lease
 * @param {Record<string, any>} given options of `diagnose`
 * @param {Record<string, any>} [changes]
 * @returns {any} to be closed
 * @throws {PlcError} what is wrong with the settings
 */
const makeDevice = (lease, given, changes = {}) => {
  const protocol = changes.protocol ?? given.protocol
  // a broken row of the tag table must not spoil a test of the connection; who is demoted is asked all the same
  const own = { demoteAfter: 0, attempts: 1, access: 'read', tags: [], gap: wholeGap(given.gap) }
  return MAKERS[protocol]({ ...given, ...own, ...changes, protocol, lease })
}

const works = (device, text) => {
  try {
    return Boolean(device.item(text))
  } catch {
    return false
  }
}

/** The tag as the device can read it, or undefined. */
const usable = (lease, given, row) => {
  if (typeof row?.name !== 'string') return undefined
  try {
    const device = makeDevice(lease, given, { tags: [row] })
    const isUsable = works(device, row.name)
    device.close()
    return isUsable ? row : undefined
  } catch {
    return undefined
  }
}

/**
 * What is read: the given item, else the first tag that can be used, else what nearly every device has.
 * @param {any} lease
 * @param {Record<string, any>} given
 * @returns {{ item: string, tags: any[], chosen: boolean }} chosen: by the user, so a refusal is a failure
 * @throws {PlcError} what is wrong with the settings, BAD_ADDRESS and its like for a given item
 */
function chooseItem(lease, given) {
  const table = Array.isArray(given.tags) ? given.tags : []
  if (given.item !== undefined && given.item !== null && given.item !== '') {
    const tags = table.filter(row => row?.name === given.item)
    const device = makeDevice(lease, given, { tags })
    try {
      device.item(given.item)
    } finally {
      device.close()
    }
    return { item: given.item, tags, chosen: true }
  }
  const row = table.slice(0, MOST_TAGS).find(each => usable(lease, given, each))
  if (row) return { item: row.name, tags: [row], chosen: true }
  const device = makeDevice(lease, given)
  const item = FIRST[given.protocol].find(text => works(device, text))
  device.close()
  return { item: item ?? FIRST[given.protocol][0], tags: [], chosen: false }
}

/**
 * One harmless read.
 * @param {any} lease
 * @param {Record<string, any>} given
 * @param {Record<string, any>} changes tags and item, and what a trial does otherwise
 * @returns {Promise<{ ok: boolean, value?: any, code: string, text: string }>} never rejects but for settings
 */
async function ask(lease, given, { item, ...changes }) {
  const device = makeDevice(lease, given, changes)
  try {
    const [result] = await device.read([item])
    const { quality, value, code = '', text = '' } = result
    return quality === 'bad' ? { ok: false, code, text } : { ok: true, value, code, text }
  } finally {
    device.close()
  }
}

/**
 * Who is asked, and what goes out, in words.
 * @param {any} lease @param {Record<string, any>} given @param {Record<string, any>} choice item and its tag
 * @returns {{ station: number, masterIds: readonly number[], goesOut: string }}
 */
function describe(lease, given, { item, ...changes }) {
  const device = makeDevice(lease, given, changes)
  try {
    const { station, masterIds = [] } = device.member
    return { station, masterIds, goesOut: device.describe(item).goesOut }
  } finally {
    device.close()
  }
}

module.exports = { ask, checkProtocol, chooseItem, describe, timeoutOf }
