'use strict'
const { PlcError } = require('../error')
const { latencyTimer, lineSettings, realClock } = require('../line')
const { causeOf, hasSpoken } = require('./diagnosis/causes')
const { evidenceOf } = require('./diagnosis/evidence')
const { fillSheet } = require('./diagnosis/sheet')
const { ask, checkProtocol, chooseItem, describe, timeoutOf } = require('./diagnosis/station')
const { framingOf, isShared, tryModes, trySpeeds } = require('./diagnosis/trials')
const { sharedPool } = require('./open')

/** ms that all trials together may take. */
const TRIAL_TIME = 20000
const OWNER = { id: 'diagnosis', name: 'communication diagnostics' }
/** After these something may still come, or another setting may help. */
const SILENT = new Set(['NO_BYTES', 'SERVER_SILENT', 'ECHO_ONLY', 'GARBAGE'])
/** That the device refuses an address which the user did not choose proves the connection. */
const PROOFS = new Set([
  'PLC_OUT_OF_RANGE',
  'MODBUS_ILLEGAL_FUNCTION',
  'MODBUS_ILLEGAL_ADDRESS',
  'MODBUS_ILLEGAL_VALUE'
])
/** The read ended in the conversation, not in the station or the line: the value came. */
const ANSWERED = new Set(['NOT_A_VALUE'])

/**
 * Communication diagnostics, as the panel's manual (3.3) asks for: opens the line, reads once, and says row by row what was measured, what is
 * only configured and what must be looked at by hand; where it fails, the likely cause.
 *
 * All is well: one read. Else it takes the timeout, the bound of lateness (a late answer is listened for), and what is tried, at most
 * `trialTime`. Nothing is ever written. A line that others use is shared with them.
 *
 * @param {Options} options all of `lineSettings` (path, or host and port) and of the device (`createNxPlc`, `createChinoRegulator`), and these
 * @returns {Promise<Diagnosis>}
 * @throws {import('../error').PlcError} (rejects) only for settings that cannot be used: BAD_SETTING, BAD_STATION, BAD_MASTER_ID, BAD_AREA,
 *   BAD_ADDRESS and its like, WIRE_CONFLICT, BROADCAST_REFUSED (station 0 of MODBUS cannot be read)
 */
async function diagnose(options) {
  const test = prepare(options)
  try {
    return await examine(test)
  } finally {
    if (test.owned) await test.lease.release()
  }
}

function prepare(options) {
  const { clock = realClock, lease, pool = sharedPool() } = options
  // the name is the device's; the line is called by its path
  const given = { ...options, name: '', clock, protocol: checkProtocol(options.protocol) }
  const transport = given.transport ?? (given.host ? 'tcp' : 'serial')
  const wire = lease ? { ...given } : lineSettings({ ...given, transport })
  checkDataBits(given.protocol, wire.dataBits)
  return {
    given,
    clock,
    wire,
    pool,
    owned: !lease,
    lease: lease ?? pool.open(wire, OWNER),
    timeout: timeoutOf(given.protocol, given.timeout),
    tried: [],
    path: wire.host ? `${wire.host}:${wire.port}` : wire.path
  }
}

/** A byte of an RTU frame has all eight bits. */
const checkDataBits = (protocol, dataBits) => {
  if (protocol !== 'rtu' || Number(dataBits) !== 7) return
  const reason = 'RTU needs 8 data bits on the line; ASCII works with 7'
  throw new PlcError('BAD_SETTING', { setting: 'dataBits', value: dataBits, reason })
}

async function examine(test) {
  const { given, lease, clock, wire, owned } = test
  const { item, tags, chosen } = chooseItem(lease, given)
  Object.assign(test, { choice: { item, tags }, ...describe(lease, given, { item, tags }) })
  test.shared = !owned || isShared(test.pool, wire, 1)
  const latency = wire.transport === 'serial' ? latencyTimer(wire.path, given.files) : null
  const late = lateness(lease, test.station)
  const since = clock.wall()
  const result = await ask(lease, given, test.choice)
  const evidenceNow = () => evidenceOf(lease.line.trace(), { station: test.station, since, expected: given.protocol })
  // later on the last query to the station may be one of somebody else who polls it
  const { sent, sentAt, ms } = evidenceNow()
  if (result.code === 'TIMEOUT') await late.listen(clock, lease.line.memory(test.station).bound)
  late.stop()
  const evidence = { ...evidenceNow(), sent, sentAt, ms }
  const waited = evidence.sentAt > 0 ? Math.max(0, Math.round(clock.wall() - evidence.sentAt)) : 0
  const seen = { result, late: late.event, waited, evidence }
  const ok = result.ok || (!chosen && PROOFS.has(result.code))
  const found = ok ? { cause: null } : await findCause(test, seen)
  return report(test, { ...seen, ...found, ok, latency: await latency })
}

/** Hears whether the station answers after its time. */
function lateness(lease, station) {
  const heard = { event: /** @type {any} */ (null), wake: () => {} }
  const note = event => {
    if (event.event !== 'late' || event.station !== station) return
    heard.event = event
    heard.wake()
  }
  lease.on('event', note)
  return {
    get event() {
      return heard.event
    },
    listen: (clock, ms) =>
      new Promise(resolve => {
        if (heard.event) return resolve(undefined)
        const timer = clock.setTimer(() => resolve(undefined), ms)
        heard.wake = () => {
          clock.clearTimer(timer)
          resolve(undefined)
        }
      }),
    stop: () => void lease.off('event', note)
  }
}

/** From what was seen; where that says nothing, from what another try says. */
async function findCause(test, { result, late, waited, evidence }) {
  const { given, wire, timeout, choice, path, goesOut, station } = test
  const { code, text } = result
  const facts = {
    ...{ code, text, station, timeout, path, waited, late, evidence },
    protocol: given.protocol,
    steps: Number(given.steps ?? 2),
    addressMode: given.addressMode ?? '1-base',
    item: choice.item,
    wire: goesOut,
    framing: framingOf(wire),
    transport: wire.transport
  }
  const cause = causeOf(facts)
  if (!SILENT.has(cause.code)) return { cause }
  return (await trials(test, facts)) ?? { cause }
}

async function trials(test, facts) {
  const { given, clock, pool, wire, owned } = test
  const end = clock.now() + (given.trialTime ?? TRIAL_TIME)
  Object.assign(test, { facts, isOver: () => clock.now() >= end })
  const found = await tryModes(test, facts.evidence.sent)
  if (found) return { cause: found, spoken: true }
  if (!given.tryOtherSpeeds || wire.transport === 'tcp' || !owned) return null
  await test.lease.release()
  const other = await trySpeeds(test, { isUsed: () => isShared(pool, wire, 0) })
  return other && { cause: other.cause, framing: other.wire }
}

/** Why other speeds were not tried, though asked for; '' where they were. */
const notTried = ({ given, wire, shared, owned }) => {
  if (!given.tryOtherSpeeds) return ''
  if (wire.transport === 'tcp') return 'the speed is a setting of the serial server: it cannot be changed from here'
  return shared || !owned ? 'others use the line: other speeds cannot be tried' : ''
}

function report(test, seen) {
  const { result, waited, late, evidence, ok, cause, framing, spoken } = seen
  const { wire, choice, goesOut, shared, tried, station } = test
  const reached = ok || hasSpoken(result.code) || ANSWERED.has(result.code)
  // too late, or to another question, is an answer, too
  const answered = reached || late !== null || spoken === true
  // the speed on the wire is the serial server's
  const own = answered && wire.transport !== 'tcp' ? wire : undefined
  const found = framing ?? own
  const value = result.ok ? result.value : null
  return {
    ok,
    cause,
    seen: {
      ...{ station, item: choice.item, goesOut, value, ms: evidence.ms, waited, code: result.code, text: result.text },
      ...{ reached, shared, tried, notTried: notTried(test) },
      sent: evidence.sent.toString('hex'),
      received: evidence.received.toString('hex'),
      echo: evidence.echo || test.lease.line.echo === 'present',
      stations: [...new Set(evidence.frames.map(frame => frame.station))],
      lateness: late && Math.round(late.lateness),
      framing: found ? framingOf(found) : null
    },
    rows: fillSheet(sheetFacts(test, { ...seen, answered, found }))
  }
}

function sheetFacts(test, { ok, answered, found, result, evidence, cause, framing, latency }) {
  const { given, wire, path, station, timeout, choice, goesOut, lease } = test
  const other = evidence.frames.find(frame => !frame.query && frame.station !== station)
  return {
    ...{ wire, path, station, timeout, goesOut, ok, answered, found, cause, latency },
    protocol: given.protocol,
    steps: Number(given.steps ?? 2),
    item: choice.item,
    value: result.ok ? result.value : undefined,
    echo: lease.line.echo,
    opened: evidence.sent.length > 0,
    heard: answered || framing ? station : other?.station
  }
}

/**
 * @typedef {object} OwnOptions
 * @property {'nx'|'rtu'|'ascii'} protocol
 * @property {number|string} station
 * @property {string} [item] what to read; default the first tag that can be used, else M0, or for MODBUS hr0, whose refusal (exceptions 01 to 03)
 *   is an answer, too
 * @property {number} [timeout] ms, default 3000 (NX), 1000 (MODBUS)
 * @property {any} [lease] of an open line, that stays its owner's; the settings of the line then only fill the sheet
 * @property {any} [pool] where the line is opened, default the one of `openNxPlc`
 * @property {boolean} [tryOtherModes] ask a silent station by the other mode (RTU, ASCII; 2-step, 4-step) and from all master IDs, too
 * @property {boolean} [tryOtherSpeeds] ask a silent station at 1200 to 115200 bit/s and with the other parities, if nobody else uses the line
 * @property {number} [trialTime] ms that all this may take, default 20000
 * @property {any} [trialPool] where the other speeds are tried, default a new pool
 * @property {any} [files] `realpath`, `readFile`: where the latency timer of an FTDI adapter is read
 * @property {any} [clock]
 * @property {() => number} [random] 0 to 1
 *
 * @typedef {OwnOptions & Record<string, any>} Options
 *
 * @typedef {object} Diagnosis
 * @property {boolean} ok the station answers with these settings
 * @property {import('./diagnosis/causes').Cause | null} cause the likely one; null if ok
 * @property {Record<string, any>} seen facts: `station` `item` `goesOut` `value` `ms` (from query to answer) `waited` (ms since the query) `code` `text`
 *   (of the read's error) `reached` (the station itself has spoken, if only to refuse) `sent` `received` (hex, without our echo) `echo` `stations` (numbers heard among stray bytes) `lateness` (ms, or null)
 *   `framing` (with which it answers, or null) `shared` `tried` (`[{ what, answered, code }]`) `notTried` (why not, or '')
 * @property {import('./diagnosis/sheet').Row[]} rows
 */

module.exports = { diagnose }
