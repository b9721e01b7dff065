'use strict'
const { createPool, wireKey } = require('../../line')
const { cause, hasSpoken } = require('./causes')
const { ask } = require('./station')

/** What is tried when the station is silent as configured: one more harmless read each, with one thing changed. */

/** A station that is there answers sooner, ms. */
const TRIAL = 500
const SPEEDS = [9600, 19200, 38400, 115200, 57600, 4800, 2400, 1200]
const FRAMES = { 8: ['none', 'even', 'odd'], 7: ['even', 'odd', 'none'] }
const LETTERS = { none: 'N', even: 'E', odd: 'O' }
/** Answers of another kind say that the line lives, but not that this trial was right. */
const answered = ({ ok, code }) => ok || hasSpoken(code)

/** `19200 8N1` */
const framingOf = ({ baudRate, dataBits, parity, stopBits }) =>
  `${baudRate} ${dataBits}${LETTERS[parity] ?? '?'}${stopBits}`

/** One trial; what it was is kept. @returns {Promise<boolean>} whether the station answered */
async function attempt(test, what, { lease = test.lease, ...changes }) {
  const { given, choice, timeout, tried } = test
  const result = await ask(lease, given, { ...choice, timeout: Math.min(timeout, TRIAL), ...changes })
  const found = answered(result)
  tried.push({ what, answered: found, code: result.code })
  return found
}

const hex = id => `0x${id.toString(16).toUpperCase()} (${id})`

/** A PLC may be set to answer one master only. @param {any} test @param {number} used ID of the query that was not answered */
async function tryMasterIds(test, used) {
  const ids = test.masterIds.filter(id => id !== used)
  for (const id of test.given.tryOtherModes ? ids : ids.slice(0, 1)) {
    if (test.isOver()) return null
    if (!(await attempt(test, `master ID ${hex(id)}`, { masterIds: [id] }))) continue
    // silent to the one and not to the other, twice: a lossy line is not taken for it
    const again = await attempt(test, `master ID ${hex(used)}`, { masterIds: [used] })
    return again
      ? cause('UNSTEADY', test.facts)
      : cause('FIXED_MASTER_ID', { ...test.facts, found: hex(id), used: hex(used) })
  }
  return null
}

/** The other number of steps. @param {any} test */
async function trySteps(test) {
  const steps = Number(test.facts.steps) === 4 ? 2 : 4
  const found = await attempt(test, `${steps}-step method`, { steps })
  return found ? cause('WRONG_STEPS', { ...test.facts, found: steps }) : null
}

/** RTU for ASCII and the other way round. @param {any} test */
async function tryMode(test) {
  const protocol = test.given.protocol === 'rtu' ? 'ascii' : 'rtu'
  if (protocol === 'rtu' && test.wire.dataBits === 7) return null
  const found = await attempt(test, `MODBUS ${protocol.toUpperCase()}`, { protocol })
  const names = { mode: test.given.protocol.toUpperCase(), found: protocol.toUpperCase() }
  return found ? cause('OTHER_MODE', { ...test.facts, ...names }) : null
}

/**
 * At the same settings of the line, so also where others use it.
 * @param {any} test
 * @param {Buffer} sent the query that was not answered
 * @returns {Promise<import('./causes').Cause | null>}
 */
async function tryModes(test, sent) {
  const { protocol, tryOtherModes } = test.given
  if (protocol !== 'nx') return tryOtherModes ? tryMode(test) : null
  const ids = test.masterIds.length > 1 ? await tryMasterIds(test, sent[1]) : null
  return ids ?? (tryOtherModes && !test.isOver() ? trySteps(test) : null)
}

/** Every other framing: first the other speeds, then the other parities, then both. */
function framings({ baudRate, dataBits, parity, stopBits, ...wire }, protocol) {
  const sizes = protocol === 'ascii' ? [dataBits, dataBits === 7 ? 8 : 7] : [8]
  const forms = sizes.flatMap(bits => FRAMES[bits].map(each => ({ dataBits: bits, parity: each })))
  const isOwn = form => form.dataBits === dataBits && form.parity === parity
  const own = forms.filter(isOwn)
  const others = forms.filter(form => !isOwn(form))
  const speeds = SPEEDS.filter(speed => speed !== baudRate)
  const at = (speed, form) => ({ ...wire, stopBits, baudRate: speed, ...form })
  return [
    ...own.flatMap(form => speeds.map(speed => at(speed, form))),
    ...others.map(form => at(baudRate, form)),
    ...others.flatMap(form => speeds.map(speed => at(speed, form)))
  ]
}

/**
 * At other speeds and parities. The line was given back before. A pool of its own opens the port: who is deployed meanwhile finds it busy and
 * tries again, instead of being refused for other settings.
 * @param {any} test
 * @param {{ isUsed: () => boolean }} options whether somebody else has opened the line since
 * @returns {Promise<{ cause: import('./causes').Cause, wire: any } | null>}
 */
async function trySpeeds(test, { isUsed }) {
  const pool = test.given.trialPool ?? createPool({ clock: test.clock })
  for (const wire of framings(test.wire, test.given.protocol)) {
    if (test.isOver() || isUsed()) return null
    // nobody else is answered here, and each trial is another line: nothing old is waited for
    const lease = pool.open({ ...wire, latenessBound: 1 }, { id: 'diagnosis', name: 'communication diagnostics' })
    const found = await attempt(test, framingOf(wire), { lease }).finally(() => lease.release())
    const facts = { ...test.facts, found: framingOf(wire) }
    if (found) return { cause: cause('OTHER_SPEED', facts), wire }
  }
  return null
}

/** Whether others than this lease use the wire. @param {any} pool @param {any} wire @param {number} own leases of ours */
const isShared = (pool, wire, own) => pool.lines().some(({ key, leases }) => key === wireKey(wire) && leases > own)

module.exports = { framingOf, isShared, tryModes, trySpeeds }
