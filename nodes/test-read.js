'use strict'
const { PlcError, listPorts } = require('../lib/index.js')
const { createDevice, deviceSettings } = require('./device-settings')
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
const FIRST = ['M0', 'R0', '@0x0000']

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

/** A lease of the deployed line, or of one with the settings of the dialog. */
const leaseFor = async (RED, { line, plc }) => {
  const live = liveNode(RED, 'plc-line', line?.id)
  const settings = poolSettings(readSettings('plc-line', taken('plc-line', line, live)))
  if (
    live &&
    (settings.transport === 'simulated' ? live.simulated : sameLine(live, { ...settings, name: live.settings.name }))
  ) {
    const undo = live.simulated ? live.plcs.visit(plc) : undefined
    return { lease: live.lease(OWNER), where: settings, undo }
  }
  if (settings.transport === 'serial') await checkPath(RED, settings.path)
  if (settings.transport !== 'simulated') return { lease: sharedPool().open(settings, OWNER), where: settings }
  const simulated = simulatedWire(settings)
  simulated.add(plc)
  return { lease: sharedPool().open({ ...settings, path: 'test', wire: simulated.wire }, OWNER), where: settings }
}

const itemToRead = (device, tags) => {
  const works = text => {
    try {
      return Boolean(device.item(text))
    } catch {
      return false
    }
  }
  return [...tags.map(tag => tag?.name), ...FIRST].find(text => typeof text === 'string' && works(text))
}

const problem = error => ({ code: error.code, message: error.message, details: error.details })

/** ms from the last frame out to the last one in: without the silence that the line keeps after it was opened. */
const tookOf = (line, station) => {
  const last = dir => line.trace().findLast(frame => frame.dir === dir && frame.station === station)?.t ?? 0
  return Math.max(0, Math.round(last('in') - last('out')))
}

const readOnce = async ({ lease, where }, settings) => {
  const own = { ...settings, attempts: 1, access: 'read' }
  const { device } = createDevice(lease, deviceSettings(own, { name: OWNER.name, stations: [], gap: where.gap }))
  try {
    const item = itemToRead(device, settings.tags)
    const [result] = await device.read([item])
    const { station } = settings
    if (result.quality !== 'bad')
      return { ok: true, station, ms: tookOf(lease.line, station), item, value: result.value }
    const { code, text } = result
    const { path, host, port } = where
    const details = {
      station: settings.station,
      timeout: settings.timeout,
      address: item,
      path: path || `${host}:${port}`
    }
    return { ok: false, reached: code.startsWith('PLC_'), error: { code, message: text, details } }
  } finally {
    device.close()
  }
}

const test = async (RED, body) => {
  const plc = readSettings('nx-config', taken('nx-config', body.plc, liveNode(RED, 'nx-config', body.plc?.id)))
  const { lease, where, undo } = await leaseFor(RED, { line: body.line, plc })
  try {
    return await readOnce({ lease, where }, plc)
  } finally {
    undo?.()
    await lease.release()
  }
}

/**
 * POST nx-config/test with `{ plc, line }`, the properties of both as in the dialog. Answers `{ ok, station, ms, item, value }` or
 * `{ ok: false, reached, error: { code, message } }`; 400 with an error if the settings cannot be used.
 */
const testHandler = RED => (request, response) => {
  const body = request.body !== null && typeof request.body === 'object' ? request.body : {}
  test(RED, body).then(
    answer => response.json(answer),
    error => response.status(error instanceof PlcError ? 400 : 500).json({ ok: false, error: problem(error) })
  )
}

module.exports = { testHandler }
