'use strict'

/**
 * Faults on real (virtual) serial ports and TCP, in real time and short. The long forms: `npm run endurance -- replugs | redeploys | dead | halfopen | hour`.
 * Most of it is waiting: so they run side by side, and each test waits for its own.
 */

const assert = require('node:assert/strict')
const { execFile } = require('node:child_process')
const fs = require('node:fs')
const os = require('node:os')
const path = require('node:path')
const { SerialPort } = require('serialport')
const { createPool } = require('../../lib')
const { createNxLine, createPty, serveOnPty } = require('../../lib/sim')
const { deadStation } = require('../support/dead-station.js')
const { RATES } = require('../support/fault-hour.js')
const { halfOpen } = require('../support/half-open.js')
const { mixedLine } = require('../support/mixed-line.js')
const { placed, startNodeRed, until } = require('../support/node-red.js')
const { createStage, killedMaster, stoppedMaster, stoppedStation } = require('../support/processes.js')
const { redeploys } = require('../support/redeploys.js')
const { root } = require('../support/source.js')

/** Back after a fault within this and the bound of lateness, ms. */
const BACK = 2000
const BOUND = 1000
/** A run of scripts/endurance.js: what its last line says. */
const endurance = (...args) =>
  new Promise((resolve, reject) => {
    execFile(process.execPath, [path.join(root, 'scripts', 'endurance.js'), ...args], (error, out, err) => {
      if (error) return reject(new Error(`${out}\n${err}`))
      resolve(JSON.parse(out.trim().split('\n').at(-1) ?? ''))
    })
  })

/** Of a busy machine, ms. */
const LAG = 300
/** A second process needs a moment to start, on a busy machine a long one. */
const START = 3000

const RUNS = {
  // in a process of its own: its descriptors are counted
  replugs: () => endurance('replugs', '8'),
  halfOpen: () => halfOpen({ rounds: 1 }),
  dead: () => deadStation({ seconds: 9, more: { probeFirst: 2000 } }),
  stoppedMaster: () => stoppedMaster({ rounds: 8 }),
  killedMaster: () => killedMaster({ rounds: 5 }),
  stoppedNx: () => stoppedStation({ rounds: 4 }),
  stoppedChino: () => stoppedStation({ rounds: 4, device: 'chino' }),
  mixed: () => mixedLine({ seconds: 25, rates: RATES.map(each => ({ ...each, rate: 4 * each.rate })) }),
  redeploys: () => redeploys({ rounds: 20, calm: true, baudRate: 9600 })
}

describe('system: faults on real ports', function () {
  this.timeout(120000)
  /** @type {Record<string, Promise<any>>} */
  const runs = {}
  const start = names => {
    for (const name of names) {
      runs[name] ??= RUNS[name]()
      // told by its own test
      runs[name].catch(() => {})
    }
  }
  const ended = name => {
    start([name])
    return runs[name]
  }
  before(() => start(['replugs', 'halfOpen', 'dead', 'killedMaster', 'mixed']))
  after(() => Promise.allSettled(Object.values(runs)))

  it('8 of 8 replugs at any moment: values of both stations within 2 s and the bound, no descriptor left, no busy core', async () => {
    const { rounds, late, slowest, limit, wrong, busiest, values, codes } = await ended('replugs')
    assert.deepEqual([rounds, late, wrong], [8, 0, 0], `slowest ${slowest} ms of ${limit}`)
    assert.ok(values >= 2 * rounds)
    assert.ok(busiest < 0.9, `${busiest} of a core while it is unplugged`)
    for (const code of codes) assert.match(code, /^(PORT_GONE|PORT_NOT_FOUND|TIMEOUT|INCOMPLETE|STATION_DEMOTED)$/)
  })

  it('a connection that is half-open, that hangs, that is dropped, whose server is restarted', async () => {
    for (const [way, { noticed, back, limit, wrong }] of Object.entries(await ended('halfOpen'))) {
      assert.equal(wrong, 0, way)
      assert.ok(noticed <= limit, `${way}: a new connection after ${noticed} ms of ${limit}`)
      assert.ok(back <= BACK + BOUND, `${way}: values ${back} ms after it works again`)
    }
  })

  it('one dead station of ten costs the others three timeouts, then half a second a probe at most, and it comes back by itself', async () => {
    const { longest, probes, wrong, events, back, demoted } = await ended('dead')
    assert.equal(wrong, 0)
    assert.deepEqual(events, ['stationDemoted 10', 'stationBack 10'])
    // that this is at most 5 % of an hour: `npm run endurance -- dead`, and in virtual time test/device/health.test.js
    assert.ok(probes >= 1 && longest < 500 + LAG, `${probes} probes, the longest ${longest} ms`)
    // three timeouts, and a bound of lateness between them
    assert.ok(demoted < 3 * 500 + 2 * BOUND + BACK, `demoted after ${demoted} ms`)
    assert.ok(back < 10000, `back after ${back} ms`)
  })

  it('Node-RED or any other master is killed in the middle of an exchange: the next one has the port and right values', async () => {
    const { slowest, wrong, states, unconfirmed } = await ended('killedMaster')
    assert.equal(wrong, 0)
    assert.deepEqual(unconfirmed, [])
    assert.ok(slowest < BACK + BOUND + START, `${slowest} ms`)
    assert.deepEqual(new Set(states.map(({ state }) => state)), new Set(['open']), 'never busy, never refused')
  })

  it('a master that is stopped in the middle of an exchange and goes on: no wrong value', async () => {
    start(['redeploys', 'stoppedMaster', 'stoppedNx', 'stoppedChino'])
    const { slowest, wrong, unconfirmed, values } = await ended('stoppedMaster')
    assert.equal(wrong, 0)
    assert.ok(values >= 16)
    for (const { outcome } of unconfirmed) assert.equal(outcome, 'unknown')
    assert.ok(slowest < BACK + BOUND, `${slowest} ms`)
  })

  for (const run of ['stoppedNx', 'stoppedChino']) {
    it(`a station that is stopped in the middle of an exchange and goes on later (${run}): no wrong value`, async () => {
      const { values, wrong, slowest, bound } = await ended(run)
      assert.equal(wrong, 0)
      assert.ok(values > 4)
      assert.ok(slowest < BACK + bound + BOUND, `${slowest} ms, bound ${bound}`)
    })
  }

  it('noise, damage, lateness, strangers and losses on a line of four stations: no value is wrong, whatever the fault', async () => {
    const { wrong, values, writes, faults } = await ended('mixed')
    assert.deepEqual(wrong, [])
    assert.ok(values > 50 && writes > 5, `${values} values, ${writes} writes`)
    assert.ok(Object.keys(faults).length >= 7, JSON.stringify(faults))
  })

  it('20 deploys in the middle of traffic at 9600 bit/s: each below 2 s, no torn frame, no port in use, nothing left', async () => {
    const { rounds, torn, slowest, queries } = await ended('redeploys')
    assert.deepEqual([rounds, torn], [20, 0], `slowest ${slowest} ms`)
    assert.ok(queries >= rounds, `${queries} queries`)
  })
})

describe('system: ports that cannot be opened at first', function () {
  this.timeout(60000)
  let folder, link, line, port
  beforeEach(() => {
    folder = fs.mkdtempSync(path.join(os.tmpdir(), 'faults-'))
    link = path.join(folder, 'line')
    line = createNxLine({ stations: [1], baudRate: 38400, quiet: true })
    line.plcs[0].set('M0', 7)
    port = serveOnPty({ wire: line.wire, link })
  })
  afterEach(() => {
    port.close()
    fs.rmSync(folder, { recursive: true, force: true })
  })

  const flow = () => [
    { id: 'tab', type: 'tab', label: 'tab' },
    { id: 'line', type: 'plc-line', name: 'Line', transport: 'serial', path: link, baudRate: 38400 },
    { id: 'plc', type: 'nx-config', name: 'Oven', line: 'line', station: 1, timeout: 500 },
    { id: 'read', type: 'nx-read', z: 'tab', plc: 'plc', items: ['M0'], interval: 100, wires: [['values']] },
    { id: 'catch', type: 'catch', z: 'tab', scope: null, wires: [['errors']] },
    ...['values', 'errors'].map(id => ({
      ...{ id, type: 'debug', z: 'tab', active: true, tosidebar: true, targetType: 'msg', wires: [] },
      complete: id === 'values' ? 'payload' : 'error'
    }))
  ]

  it('busy: the error names the port and the likely cause, once; it works when the other program ends', async () => {
    const other = new SerialPort({ path: link, baudRate: 9600, autoOpen: false })
    await new Promise((resolve, reject) => other.open(error => (error ? reject(error) : resolve(undefined))))
    const red = await startNodeRed({ flow: [] })
    try {
      await red.deploy(placed(flow()))
      const error = await red.next('errors')
      assert.equal(error.code, 'PORT_BUSY')
      assert.match(error.message, new RegExp(`${link} is in use by another program.*ModemManager`))
      await until(() => red.status.get('read')?.fill === 'red', { what: 'the status' })
      assert.equal(red.debug.length, 1, 'told once')
      await new Promise(resolve => other.close(resolve))
      const from = performance.now()
      assert.deepEqual(await red.next('values'), { M0: 7 })
      // the back-off is 5 s at most
      assert.ok(performance.now() - from < 5000 + BACK + BOUND)
      await until(() => red.status.get('read')?.fill === 'green', { what: 'the status' })
    } finally {
      if (other.isOpen) await new Promise(resolve => other.close(resolve))
      await red.stop()
    }
  })

  it('flow control that is never released: an error with a code, no hang, and it goes on when it is released', async () => {
    const stop = Buffer.from([0x13])
    const pty = createPty({ link: path.join(folder, 'stopped') })
    const settings = { path: pty.path(), baudRate: 9600, flowControl: 'xonxoff', writeTimeout: 300, echo: 'off' }
    const lease = createPool().open(settings, { id: 'a', name: 'a' })
    const asking = function* () {
      return yield { send: Buffer.alloc(40, 1), match: bytes => ({ take: bytes.length }), timeout: 500 }
    }
    const ask = () => lease.run(asking, { station: 1, latenessBound: 1 })
    let stopped = true
    pty.onData(() => void pty.write(Buffer.from('A')))
    try {
      await until(() => lease.line.state === 'open', { what: 'the port' })
      lease.on('state', state => void (state === 'open' && stopped && pty.write(stop)))
      pty.write(stop)
      await new Promise(resolve => setTimeout(resolve, 50))
      const from = performance.now()
      const error = await ask().catch(each => each)
      assert.equal(error.code, 'WRITE_STALLED')
      assert.ok(performance.now() - from < 2000)
      stopped = false
      pty.write(Buffer.from([0x11]))
      await until(() => ask().then(String, () => null), { what: 'an answer', every: 50 })
    } finally {
      const from = performance.now()
      await lease.release()
      assert.ok(performance.now() - from < 2000)
      pty.close()
    }
  })

  it('forbidden: the error names the port and the group; it works within a second of the right', async () => {
    const stage = createStage()
    const device = fs.realpathSync(stage.link)
    // root may open everything: the program becomes nobody
    const user = process.getuid?.() === 0 ? 65534 : undefined
    fs.chmodSync(device, 0)
    if (user) fs.chmodSync(stage.folder, 0o755)
    try {
      stage.start({ user })
      const { code, text, remedy } = await until(() => stage.seen.states.find(({ state }) => state === 'waiting'), {
        what: 'the refusal'
      })
      assert.equal(code, 'PORT_DENIED')
      assert.match(text, new RegExp(`${stage.link} may not be opened by this user`))
      assert.match(`${text} ${remedy}`, /dialout/)
      fs.chmodSync(device, 0o666)
      const from = performance.now()
      await stage.good(from)
      assert.ok(performance.now() - from < BACK + BOUND, `${performance.now() - from} ms`)
      assert.deepEqual(stage.seen.wrong, [])
    } finally {
      await stage.close()
    }
  })
})
