'use strict'

/** Short runs of `npm run soak`. */

const assert = require('node:assert/strict')
const { spawnSync } = require('node:child_process')
const path = require('node:path')
const { freshSeed } = require('../../lib/sim')
const { drawRun, isKept, soak } = require('./soak')

const script = path.join(__dirname, '..', '..', 'scripts', 'soak.js')
const evidence = total => JSON.stringify({ ...total.result, failures: total.failures }, null, 1).slice(0, 4000)

describe('soak: safety and liveness, polls among the users', function () {
  this.timeout(60000)
  const fresh = freshSeed()
  const runs = [
    ['nx', 'liveness', 1],
    ['nx', 'safety', fresh],
    ['rtu', 'liveness', 2],
    ['rtu', 'safety', fresh],
    ['ascii', 'safety', 3],
    ['ascii', 'liveness', fresh]
  ]
  for (const [protocol, mode, seed] of runs) {
    it(`${protocol}, ${mode}, ${seed === fresh ? 'a fresh seed' : 'seed'} ${seed}`, async () => {
      const total = await soak(/** @type {any} */ ({ exchanges: 200, size: 120, seed, protocol, mode }))
      assert.ok(isKept(total), evidence(total))
      assert.ok(total.detail.cycles > 10 && total.detail.good > 50, JSON.stringify(total))
    })
  }

  it('a seed gives the same run again, and one segment of it alone', async () => {
    const options = { exchanges: 100, size: 50, seed: 7, protocol: 'rtu', mode: 'safety' }
    const whole = await soak(options)
    assert.deepEqual(await soak(options), whole)
    const parts = []
    for (let segment = 0; segment < whole.detail.segments; segment++) parts.push(await soak({ ...options, segment }))
    const sum = parts.reduce((all, { result }) => all + result.exchanges, 0)
    assert.equal(sum, whole.result.exchanges)
  })

  it('has teeth: without silence after a timeout late answers are taken, and it says which run to repeat', async () => {
    const faults = [{ kind: 'late', rate: 0.2, argument: 175 }]
    const device = { timeout: 150, attempts: 1, demoteAfter: 0 }
    const spoilt = {
      faults,
      device,
      wire: { latenessBound: 1 },
      collisions: false,
      uniform: true,
      polls: false,
      unplugs: 0
    }
    const draw = (seed, options) => ({ ...drawRun(seed, options), ...spoilt, recovery: false })
    const total = await soak({ exchanges: 300, size: 150, seed: 3, protocol: 'rtu', draw })
    assert.ok(total.result.wrong > 0 && !isKept(total), evidence(total))
    const [{ segment }] = total.failures
    const again = await soak({ exchanges: 300, size: 150, seed: 3, protocol: 'rtu', draw, segment })
    assert.deepEqual(again.failures[0], total.failures[0])
  })

  it('from the shell: the last line is JSON; a wrong command line ends with 2', () => {
    const run = args => spawnSync(process.execPath, [script, ...args.split(' ')], { encoding: 'utf8' })
    const { status, stdout } = run('--exchanges 50 --seed 5 --protocol ascii')
    const last = JSON.parse(stdout.trim().split('\n').at(-1) ?? '')
    const { exchanges, lateSeen, ...rest } = last
    assert.ok(exchanges >= 50 && lateSeen >= 0)
    const none = { wrong: 0, unsettled: 0, doubledWrites: 0, recoveredWithinBound: true, seed: 5 }
    assert.deepEqual([status, rest], [0, none])
    assert.equal(run('--protocol profibus').status, 2)
  })
})
