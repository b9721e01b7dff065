'use strict'
const { PlcError, diagnose, listPorts } = require('../lib/index.js')
const { deviceSettings, kindOf, readDevice } = require('./device-settings')
const { PROPERTIES } = require('./properties')
const { readSettings } = require('./settings')
const { sharedPool } = require('./pool')
const { poolSettings } = require('./line-settings')
const { simulatedWire } = require('./simulated')

/**
 * The Test button: one read with the values that stand in the dialog. What a client may make the server touch is bounded: its ids are looked up among
 * the live nodes, and a line that is not deployed as it stands may only open a port that is deployed elsewhere or in the list of ports.
 */

const OWNER = { id: 'test', name: 'Test' }
const VARIABLE = /^\$\{[^}]+\}$/

const liveNode = (RED, type, id) => {
  const node = typeof id === 'string' ? RED.nodes.getNode(id) : null
  return node && node.type === type && node.settings ? node : null
}

/** Own properties that the node type has; a variable is what the deployed node made of it. */
const taken = (type, given, live) => {
  const source = given !== null && typeof given === 'object' ? given : {}
  const pick = name => {
    const value = Object.hasOwn(source, name) ? source[name] : undefined
    return typeof value === 'string' && VARIABLE.test(value.trim()) && live ? live.settings[name] : value
  }
  return Object.fromEntries(Object.keys(PROPERTIES[type]).map(name => [name, pick(name)]))
}

const checkPath = async (RED, path) => {
  let deployed = false
  RED.nodes.eachNode(({ type, id }) => {
    if (type === 'plc-line' && liveNode(RED, type, id)?.settings.path === path) deployed = true
  })
  if (deployed) return
  const ports = await listPorts()
  if (ports.some(port => port.path === path || port.device === path)) return
  throw new PlcError('BAD_SETTING', {
    setting: 'path',
    value: path,
    reason: 'a port that is not in the list of ports can be tested once it is deployed',
    deployFirst: true
  })
}

const sameLine = (live, settings) => Object.keys(settings).every(name => live.settings[name] === settings[name])

/** Where the station is asked: over a lease of the deployed line, or on a line with the settings of the dialog. */
const lineFor = async (RED, { line, device }) => {
  const live = liveNode(RED, 'plc-line', line?.id)
  const where = poolSettings(readSettings('plc-line', taken('plc-line', line, live)))
  const isLive =
    live && (where.transport === 'simulated' ? live.simulated : sameLine(live, { ...where, name: live.settings.name }))
  if (isLive) {
    const undo = live.simulated ? live.plcs.visit(device) : undefined
    return { where, undo, lease: live.lease(OWNER) }
  }
  if (where.transport === 'serial') await checkPath(RED, where.path)
  if (where.transport !== 'simulated') return { where, pool: sharedPool() }
  const simulated = simulatedWire(where)
  simulated.add(device)
  return { where: { ...where, path: 'test', wire: simulated.wire }, pool: sharedPool() }
}

const problem = error => ({ code: error.code, message: error.message, details: error.details })

const answerOf = ({ ok, cause, seen, rows }, { where, device }) => {
  const { station, ms, item, value, reached, code, text } = seen
  if (ok) return { ok, station, ms, item, value, cause, rows }
  const { path, host, port } = where
  const details = { station, timeout: device.timeout, address: item, path: path || `${host}:${port}` }
  return { ok, reached, error: { code, message: text, details }, cause, rows }
}

const test = async (RED, type, body) => {
  const given = body.plc ?? body.device
  const device = readDevice(type, taken(type, given, liveNode(RED, type, given?.id)))
  const { where, undo, lease, pool } = await lineFor(RED, { line: body.line, device })
  try {
    const diagnosis = await diagnose({
      ...deviceSettings(device, { name: OWNER.name, stations: [], gap: where.gap }),
      ...where,
      protocol: kindOf(device).protocol === 'nx' ? 'nx' : device.protocol,
      tryOtherSpeeds: body.tryOtherSpeeds === true,
      tryOtherModes: body.tryOtherModes === true,
      ...(lease ? { lease } : { pool })
    })
    return answerOf(diagnosis, { where, device })
  } finally {
    undo?.()
    await lease?.release()
  }
}

/**
 * POST nx-config/test and chino-config/test with `{ plc, line }`, the properties of both as in the dialog; `tryOtherSpeeds`, `tryOtherModes`: true
 * as for `diagnose`. Answers `{ ok, station, ms, item, value }` or `{ ok: false, reached, error: { code, message, details } }`, both with `cause`
 * and `rows` (docs/diagnosis.md); 400 with an error if the settings cannot be used.
 * @param {any} RED
 * @param {string} [type] of the config node
 */
const testHandler =
  (RED, type = 'nx-config') =>
  (request, response) => {
    const body = request.body !== null && typeof request.body === 'object' ? request.body : {}
    test(RED, type, body).then(
      answer => response.json(answer),
      error => response.status(error instanceof PlcError ? 400 : 500).json({ ok: false, error: problem(error) })
    )
  }

module.exports = { testHandler }
