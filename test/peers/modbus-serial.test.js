'use strict'

/**
 * Side by side: our regulator device and modbus-serial alone with the same scripted station, in virtual time. The peer's wrong values are
 * counted, and must be there, or the comparison would prove nothing; ours are 0, and the right ones must have come.
 */

const assert = require('node:assert/strict')
const { createChinoRegulator, createPool } = require('../../lib')
const { createVirtualClock } = require('../../lib/sim')
const { runPeer } = require('./modbus-serial-peer.js')
const { BAUD, createStation } = require('./station.js')

const UNIT = 17
const TIMEOUT = 200
const LATE = 300

const reads = (count, first = 0) =>
  Array.from({ length: count }, (_, n) => ({ read: 'hr', base: first + 11 * n, count: 1 }))

/** The same for both: `tasks` in order, or all `together`; `script` is the station's. */
async function runOurs(clock, wire, { tasks, protocol, together, line }) {
  const pool = createPool({ clock, random: () => 0.5 })
  const settings = { transport: 'simulated', path: 'peers', wire, baudRate: BAUD, ...line }
  const lease = pool.open(settings, { id: 'ours', name: 'ours' })
  const own = { station: UNIT, protocol, timeout: TIMEOUT, access: 'write', clock, random: () => 0 }
  const functions = { coilFunction: 'auto', holdingFunction: 'auto' }
  const device = createChinoRegulator({ lease, ...own, ...functions })
  const outcome = async ({ read, write, base, count, value, values }) => {
    const table = read ?? write
    const many = count ?? values?.length ?? 1
    const item = many > 1 ? `${table}${base}..${table}${base + many - 1}` : `${table}${base}`
    if (read) {
      const [result] = await device.read([item])
      if (result.quality !== 'good') return { error: result }
      return { value: many > 1 ? result.value : [result.value] }
    }
    const done = await device.write([{ item, value: values ?? value }], { fixed: true })
    return done.outcome === 'confirmed' ? { value: true } : { error: done }
  }
  const all = async () => {
    if (together) return Promise.all(tasks.map(outcome))
    const outcomes = []
    for (const task of tasks) outcomes.push(await outcome(task))
    return outcomes
  }
  const outcomes = await clock.run(all())
  device.close()
  await clock.run(lease.release())
  return { outcomes, crashes: [] }
}

/** A read is right if it is what the station holds; a write is right if what was confirmed is what the station holds. */
function isRight(station, { read, write, base, count, value, values }, got) {
  const is = (table, many) => Array.from({ length: many }, (_, n) => station.held(table, base + n))
  if (read) return JSON.stringify(got) === JSON.stringify(is(read, count))
  const wanted = values ?? [value]
  return JSON.stringify(wanted) === JSON.stringify(is(write, wanted.length))
}

async function tally(run, { script, ...scene }) {
  const clock = createVirtualClock()
  const station = createStation(clock, { protocol: scene.protocol, ...script() })
  const { outcomes, crashes } = await run(clock, station, { timeout: TIMEOUT, unit: UNIT, ...scene })
  const seen = { right: 0, wrong: 0, errors: 0, crashes: crashes.length, requests: station.requests }
  outcomes.forEach((outcome, n) => {
    if (outcome.error) seen.errors++
    else if (isRight(station, scene.tasks[n], outcome.value)) seen.right++
    else seen.wrong++
  })
  return seen
}

const ours = scene => tally(runOurs, scene)
const peer = scene => tally(runPeer, scene)

const atOnce = ({ run, close }) => ({ bytes: close(run()) })
/** This one answer comes late. */
const lateAt = nth => job => ({ ...atOnce(job), delay: job.n === nth ? LATE : 0 })
/** A write is not carried out, and its answer has other bytes. */
const changing = bytes => job => {
  if (job.fn <= 4) return atOnce(job)
  const changed = job.body.slice(0, 6)
  for (const [at, value] of bytes) changed[at] = value
  return { bytes: job.close(changed) }
}

describe('beside modbus-serial', () => {
  for (const protocol of ['rtu', 'ascii']) {
    it(`${protocol}: one answer late, then 20 reads of other addresses`, async () => {
      const scene = { protocol, tasks: reads(21), script: () => ({ answer: lateAt(1) }) }
      const theirs = await peer(scene)
      assert.ok(theirs.wrong >= 19, JSON.stringify(theirs))
      const own = await ours(scene)
      assert.deepEqual([own.wrong, own.right], [0, 21], JSON.stringify(own))
    })

    it(`${protocol}: three calls at once`, async () => {
      const scene = { protocol, tasks: reads(3), together: true, script: () => ({}) }
      const theirs = await peer(scene)
      assert.ok(theirs.wrong >= 1, JSON.stringify(theirs))
      const own = await ours(scene)
      assert.deepEqual([own.wrong, own.right], [0, 3], JSON.stringify(own))
    })
  }

  it('without a fault both are right', async () => {
    for (const protocol of ['rtu', 'ascii']) {
      const writes = [
        { write: 'co', base: 5, value: true },
        { write: 'hr', base: 6, value: 77 },
        { write: 'hr', base: 7, values: [1, 2] }
      ]
      const tasks = [...reads(10), ...writes, { read: 'co', base: 1000, count: 20 }]
      for (const run of [ours, peer]) {
        const { right, wrong } = await run({ protocol, tasks, script: () => ({}) })
        assert.deepEqual([right, wrong], [14, 0])
      }
    }
  })

  describe('an adapter that hears itself', () => {
    const writes = [
      { write: 'co', base: 5, value: !coilAtFirst(5) },
      { write: 'hr', base: 6, value: 77 }
    ]
    const coils = { read: 'co', base: 1000, count: 20 }

    for (const [what, answer] of [
      ['no regulator on the line', () => null],
      ['a regulator that refuses', ({ fn, close }) => ({ bytes: close([UNIT, fn | 0x80, 3]) })]
    ]) {
      it(`${what}: no write is confirmed by its own echo`, async () => {
        const scene = { protocol: 'rtu', tasks: writes, script: () => ({ echo: true, answer }) }
        const theirs = await peer(scene)
        assert.equal(theirs.wrong, 2, JSON.stringify(theirs))
        for (const echo of ['auto', 'on']) {
          const own = await ours({ ...scene, line: { echo } })
          assert.deepEqual([own.wrong, own.right], [0, 0], JSON.stringify(own))
        }
      })
    }

    it('20 coils from 1000 on: a request that looks like its answer', async () => {
      const scene = { protocol: 'rtu', tasks: [coils, coils], script: () => ({ echo: true }) }
      const theirs = await peer(scene)
      assert.ok(theirs.wrong >= 1, JSON.stringify(theirs))
      for (const echo of ['auto', 'on']) {
        const own = await ours({ ...scene, line: { echo } })
        assert.deepEqual([own.wrong, own.right], [0, 2], JSON.stringify(own))
      }
    })

    it('with a regulator: reads and writes are right', async () => {
      for (const echo of ['auto', 'on']) {
        const own = await ours({
          protocol: 'rtu',
          tasks: [...reads(5), ...writes, coils],
          line: { echo },
          script: () => ({ echo: true })
        })
        assert.deepEqual([own.wrong, own.right], [0, 8], JSON.stringify(own))
      }
    })
  })

  describe('a write whose answer echoes something else', () => {
    const scenes = [
      ['06, another value', { write: 'hr', base: 6, value: 77 }, [[5, 70]]],
      ['06, another address', { write: 'hr', base: 6, value: 77 }, [[3, 9]]],
      ['05, the other state', { write: 'co', base: 5, value: !coilAtFirst(5) }, [[4, coilAtFirst(5) ? 0xff : 0]]],
      ['10, another quantity', { write: 'hr', base: 6, values: [1, 2, 3] }, [[5, 2]]],
      ['10, another address', { write: 'hr', base: 6, values: [1, 2, 3] }, [[3, 7]]]
    ]
    for (const protocol of ['rtu', 'ascii'])
      for (const [what, task, bytes] of scenes) {
        it(`${protocol}: ${what}`, async () => {
          const scene = { protocol, tasks: [task], script: () => ({ answer: changing(bytes) }) }
          const theirs = await peer(scene)
          assert.deepEqual([theirs.wrong, theirs.right], [1, 0], JSON.stringify(theirs))
          const own = await ours(scene)
          assert.deepEqual([own.wrong, own.right, own.errors], [0, 0, 1], JSON.stringify(own))
        })
      }
  })

  it('ascii: `:\\r\\n` before the answer ends the peer’s program; ours reads on', async () => {
    const answer = job => ({ bytes: Buffer.concat([Buffer.from(':\r\n'), atOnce(job).bytes]) })
    const scene = { protocol: 'ascii', tasks: reads(5), script: () => ({ answer }) }
    const theirs = await peer(scene)
    assert.deepEqual([theirs.crashes, theirs.right], [1, 0], JSON.stringify(theirs))
    const own = await ours(scene)
    assert.deepEqual([own.wrong, own.right], [0, 5], JSON.stringify(own))
  })
})

/** What the station holds in a coil before any write. */
function coilAtFirst(at) {
  return createStation(createVirtualClock(), { protocol: 'rtu' }).held('co', at)
}
