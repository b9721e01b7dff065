'use strict'

const assert = require('node:assert/strict')
const { createChinoRegulator, createNxPlc, createPool } = require('../../lib')
const { createLine, createVirtualClock } = require('../../lib/sim')
const { createRandom } = require('../../lib/sim/random')

/**
 * Devices of one kind, the real line and simulated stations in virtual time.
 * @param {{ stations?: number[], device?: Record<string, any>, line?: Record<string, any>, kind?: 'nx'|'rtu'|'ascii', seed?: number, sim?: any }} [options]
 */
const bench = ({ stations = [1], device = {}, line = {}, kind = 'nx', seed = 1, sim = {} } = {}) => {
  const clock = createVirtualClock()
  const isNx = kind === 'nx'
  const rows = { device: isNx ? 'nx' : 'chino', protocol: isNx ? undefined : kind, stations, quiet: true, ...sim }
  const simulated = createLine({ clock, baudRate: 38400, seed, ...rows })
  const random = createRandom(seed).next
  const pool = createPool({ clock, random: () => 0.5 })
  const settings = { transport: 'simulated', path: 'sim', wire: simulated.wire, baudRate: 38400, echo: 'off', ...line }
  const open = () => pool.open(settings, { id: 'a', name: 'bench' })
  const create = isNx ? createNxPlc : createChinoRegulator
  const protocol = isNx ? {} : { protocol: kind }
  const make = (lease, own = {}) =>
    create({ lease, clock, random, timeout: 200, attempts: 1, access: 'write', ...protocol, ...device, ...own })
  const lease = open()
  const events = []
  lease.on('event', event => events.push({ at: clock.now(), ...event }))
  const devices = stations.map(station => make(lease, { station }))
  const sent = () => lease.line.stats().queries
  return {
    ...simulated,
    ...{ clock, pool, lease, open, make, devices, events, sent, item: isNx ? 'M0' : '400001', device: devices[0] },
    read: (at = 0, item = isNx ? 'M0' : '400001') =>
      clock.run(devices[at].read([item])).then(([{ code }]) => code ?? 'good'),
    heard: name => events.filter(({ event }) => event === name),
    stats: station => lease.line.stats().stations[station],
    close: async () => {
      devices.forEach(each => each.close())
      await clock.run(lease.release())
      await clock.advance(10000)
      assert.equal(clock.pending(), 0, 'a timer is left')
    }
  }
}

const code = expected => error => error.code === expected

describe('health of a station', () => {
  let b
  const start = options => (b = bench(options))
  afterEach(async () => {
    await b?.close()
    b = undefined
  })
  /** Until it is demoted, however its reads go. */
  const demote = async (at = 0, times = 3) => {
    b.wire.setOff(b.stations[at].station, true)
    for (let n = 0; n < times; n++) assert.equal(await b.read(at), 'TIMEOUT')
  }

  it('is online, suspect after a silence, demoted after three, and says so', async () => {
    start()
    assert.equal(await b.read(), 'good')
    assert.deepEqual(b.device.health, { state: 'online', since: null, probe: null })
    b.wire.setOff(1, true)
    const since = b.clock.wall()
    assert.equal(await b.read(), 'TIMEOUT')
    assert.equal(b.device.health.state, 'suspect')
    assert.equal(await b.read(), 'TIMEOUT')
    assert.deepEqual(b.events, [])
    assert.equal(await b.read(), 'TIMEOUT')
    assert.equal(b.stats(1).health, 'demoted')
    assert.equal(b.stats(1).since, b.clock.wall())
    const [event] = b.heard('stationDemoted')
    assert.deepEqual([event.station, event.code, event.timeouts], [1, 'TIMEOUT', 3])
    assert.ok(event.nextProbe >= 4500 && event.nextProbe <= 5500, `${event.nextProbe}`)
    assert.match(event.cause, /Station 1 was silent 3 times/)

    const queries = b.sent()
    const now = b.clock.now()
    const [result] = await b.clock.run(b.device.read(['K5']))
    assert.equal(result.code, 'STATION_DEMOTED')
    assert.match(result.text, /station 1 was not asked: it has been silent for 3 s, and is probed in [56] s/)
    assert.deepEqual([b.sent(), b.clock.now()], [queries, now], 'nothing was sent, nothing waited')
    const error = await b.clock.run(b.device.read(['K5'])).then(([each]) => each)
    assert.equal(error.quality, 'bad')
    assert.ok(b.device.health.probe > since + 5000)
  })

  it('probes at 5 s, then after twice as long until 60 s, ± 10 %, with one short read each', async () => {
    start({ device: { timeout: 3000 } })
    await b.read()
    await demote()
    const from = b.clock.now()
    await b.clock.advance(400000)
    const probes = b.lease.line.trace().filter(({ dir, note }) => dir === 'out' && note === 'probe')
    const wall = b.clock.wall() - b.clock.now()
    const times = probes.map(({ t }) => t - wall - from)
    const gaps = times.map((time, at) => time - (times[at - 1] ?? 0))
    const expected = [5000, 10000, 20000, 40000, 60000, 60000, 60000, 60000, 60000]
    gaps.forEach((gap, at) => {
      // 0.5 s for the probe itself
      assert.ok(gap >= expected[at] * 0.9 && gap <= expected[at] * 1.1 + 600, `${at}: ${gap}`)
    })
    assert.ok(gaps.length >= 8)
    assert.ok(new Set(gaps.slice(-3).map(Math.round)).size > 1, 'with jitter')
    // 01 is to station 1, 23 to 05 03 a word of M at 00C0
    for (const { bytes } of probes) assert.match(bytes, /^01..2303c00001/i)
  })

  it('a probe waits 500 ms while nothing is known, then 1.5 times the 99th percentile', async () => {
    start({ device: { timeout: 3000 }, sim: { turnaround: 120 } })
    await demote()
    await b.clock.advance(5600)
    const busy = () => b.lease.line.stats().busy
    const first = busy()
    await b.clock.advance(12000)
    assert.ok(Math.abs(busy() - first - 500) < 10, `${busy() - first}`)
    b.wire.setOff(1, false)
    await b.clock.advance(30000)
    assert.equal(b.device.health.state, 'online')
    for (let n = 0; n < 20; n++) assert.equal(await b.read(), 'good')
    const { latency } = b.stats(1)
    assert.ok(latency.p99 > 119 && latency.p99 < 135, `${latency.p99}`)
    await demote()
    const before = busy()
    await b.clock.advance(6000)
    const used = busy() - before
    assert.ok(Math.abs(used - latency.p99 * 1.5) < 10, `${used}`)
  })

  it('an answer to a probe brings it back; subscriptions ask at once', async () => {
    start()
    const seen = []
    b.device.subscribe({ items: ['M0'], interval: 600000 }, ([{ code: bad = 'good' }]) =>
      seen.push([b.clock.now(), bad])
    )
    b.wire.setOff(1, true)
    await b.clock.advance(100)
    await demote(0, 2)
    b.device.subscribe({ items: ['M1'], interval: 600000 }, ([{ code: bad = 'good' }]) =>
      seen.push([b.clock.now(), bad])
    )
    await b.clock.advance(1000)
    assert.deepEqual(
      seen.map(([, bad]) => bad),
      ['TIMEOUT', 'STATION_DEMOTED']
    )
    b.wire.setOff(1, false)
    await b.clock.advance(6000)
    const [back] = b.heard('stationBack')
    assert.ok(back.downFor > 5000 && back.downFor < 8000, `${back.downFor}`)
    assert.deepEqual(
      seen.map(([, bad]) => bad),
      ['TIMEOUT', 'STATION_DEMOTED', 'good', 'good']
    )
    assert.ok(seen[3][0] - back.at < 50, `${seen[3][0] - back.at}`)
    assert.equal(b.stats(1).health, 'online')
  })

  it('a refusal brings it back, too', async () => {
    start()
    await demote()
    b.wire.setOff(1, false)
    b.faults.once('error', { argument: 2 })
    await b.clock.advance(5700)
    assert.equal(b.heard('stationBack').length, 1)
    assert.equal(b.stats(1).answers, 1)
  })

  it('so does a late answer to a probe: the station is slower than the probe waits, not than its timeout', async () => {
    start({ device: { timeout: 3000 } })
    await demote()
    b.wire.setOff(1, false)
    b.faults.once('late', { argument: 1500 })
    await b.clock.advance(8000)
    assert.equal(b.heard('stationBack').length, 1)
    assert.deepEqual(b.heard('late'), [], 'it came within its timeout')
    assert.equal(b.lease.line.memory(1).lateness, 0)
  })

  it('a probe leaves its station alone as long as a whole request does', async () => {
    start({ device: { timeout: 3000 } })
    await demote()
    await b.clock.advance(5600)
    const { until } = b.lease.line.memory(1)
    const probe = b.lease.line.trace().findLast(({ dir }) => dir === 'out')
    const sentAt = probe.t - (b.clock.wall() - b.clock.now())
    assert.ok(until - sentAt >= 6000 && until - sentAt < 6010, `${until - sentAt}`)
  })

  it('only silence counts: damaged, torn and refusing answers prove it alive', async () => {
    start()
    assert.equal(await b.read(), 'good')
    for (const kind of ['crc', 'truncated', 'error']) {
      for (let n = 0; n < 5; n++) {
        b.faults.once(kind, kind === 'truncated' ? { argument: 3 } : {})
        assert.notEqual(await b.read(), 'good')
      }
      assert.deepEqual(b.events, [], kind)
    }
    for (let n = 0; n < 6; n++) {
      b.faults.once(n % 3 === 2 ? 'error' : 'silent')
      assert.notEqual(await b.read(), 'STATION_DEMOTED')
    }
    assert.deepEqual(b.events, [])
  })

  it('an answer that always comes too late is no silence', async () => {
    start()
    assert.equal(await b.read(), 'good')
    for (let n = 0; n < 6; n++) {
      b.faults.once('late', { argument: 400 })
      assert.equal(await b.read(), 'TIMEOUT')
      await b.clock.advance(3000)
    }
    assert.deepEqual(b.heard('stationDemoted'), [])
  })

  it('a request that the station never answers does not take it from the others', async () => {
    start({ device: { attempts: 3 } })
    const [plc] = b.stations
    const hear = plc.receive
    // 21: read bits, which it does not answer at all
    plc.receive = (bytes, times) => hear(bytes, times).filter(({ request }) => request[2] !== 0x21)
    assert.equal(await b.read(0, 'K5'), 'good')
    for (let n = 0; n < 3; n++) {
      assert.equal(await b.read(0, 'M0.1'), 'TIMEOUT')
      assert.equal(await b.read(0, 'K5'), 'good')
    }
    // two of them in a row are the station's silence
    assert.equal(await b.read(0, 'M0.1'), 'TIMEOUT')
    assert.equal(await b.read(0, 'M3.1'), 'TIMEOUT')
    assert.equal(b.heard('stationDemoted').length, 1)
    // the probe asks for what it has answered before
    await b.clock.advance(6000)
    assert.equal(b.heard('stationBack').length, 1)
  })

  it('where nothing was ever answered, probes ask by turns for what else is wanted', async () => {
    start({ device: { attempts: 3 } })
    const [plc] = b.stations
    const hear = plc.receive
    plc.receive = (bytes, times) => hear(bytes, times).filter(({ request }) => request[2] !== 0x21)
    assert.equal(await b.read(0, 'M0.1'), 'TIMEOUT')
    assert.equal(await b.read(0, 'K5'), 'STATION_DEMOTED')
    await b.clock.advance(6000)
    assert.equal(await b.read(0, 'K5'), 'good')
  })

  it('a conversation is not repeated any further, and what waits ends at once', async () => {
    start({ device: { attempts: 20 } })
    b.wire.setOff(1, true)
    const others = ['M1', 'M2', 'K1'].map(item => b.device.read([item]))
    const [first, ...rest] = await b.clock.run(Promise.all([b.device.read(['M0']), ...others]))
    const codes = [first, ...rest].map(([result]) => result.code)
    assert.equal(b.sent(), 3)
    assert.deepEqual(codes.sort(), ['STATION_DEMOTED', 'STATION_DEMOTED', 'STATION_DEMOTED', 'TIMEOUT'])
  })

  it('demoteAfter 0 never demotes', async () => {
    start({ device: { demoteAfter: 0 } })
    b.wire.setOff(1, true)
    for (let n = 0; n < 10; n++) assert.equal(await b.read(), 'TIMEOUT')
    assert.deepEqual(b.events, [])
    assert.equal(b.stats(1).health, 'suspect')
  })

  it('a device that is never refused asks a demoted station, and its answer counts for all', async () => {
    start()
    await demote()
    const test = b.make(b.lease, { station: 1, demoteAfter: 0 })
    assert.equal((await b.clock.run(test.read(['M0'])))[0].code, 'TIMEOUT')
    assert.equal(await b.read(), 'STATION_DEMOTED')
    b.wire.setOff(1, false)
    assert.equal((await b.clock.run(test.read(['M0'])))[0].quality, 'good')
    assert.equal(await b.read(), 'good')
    test.close()
  })

  it('refuses settings that make no sense', () => {
    start()
    const bad = own =>
      assert.throws(() => b.make(b.lease, { station: 2, ...own }), code('BAD_SETTING'), JSON.stringify(own))
    ;[
      { demoteAfter: -1 },
      { demoteAfter: 101 },
      { demoteAfter: 1.5 },
      { probeFirst: 99 },
      { probeMost: 3600001 }
    ].forEach(bad)
    bad({ probeFirst: 5000, probeMost: 4999 })
    b.make(b.lease, { station: 2, probeFirst: 90000 }).close()
  })

  describe('writes', () => {
    it('on a demoted station fail at once, nothing is sent', async () => {
      start()
      await demote()
      const queries = b.sent()
      const outcome = await b.clock.run(b.device.write([{ item: 'K0', value: 5 }], { fixed: true }))
      assert.deepEqual([outcome.outcome, outcome.code, outcome.attempts], ['failed', 'STATION_DEMOTED', 0])
      assert.equal(b.sent(), queries)
    })

    it('that wait while it is demoted fail, too, and were never sent', async () => {
      start()
      const written = []
      b.stations[0].on?.('write', each => written.push(each))
      b.wire.setOff(1, true)
      const reads = [1, 2, 3].map(n => b.device.read([`M${n}`]))
      const writes = ['K0', 'K1', 'K2', 'K3', 'K4'].map(item => b.device.write([{ item, value: 5 }], { fixed: true }))
      const outcomes = await b.clock.run(Promise.all(writes))
      await b.clock.run(Promise.all(reads))
      assert.deepEqual(
        outcomes.map(each => each.code),
        ['WRITE_UNKNOWN', 'WRITE_UNKNOWN', 'WRITE_UNKNOWN', 'STATION_DEMOTED', 'STATION_DEMOTED']
      )
      assert.deepEqual(
        outcomes.map(each => each.outcome),
        ['unknown', 'unknown', 'unknown', 'failed', 'failed']
      )
      assert.equal(b.sent(), 3)
    })

    it('that demoted it are probed as reads: nothing is ever written by a probe', async () => {
      for (const kind of ['nx', 'rtu']) {
        start({ kind })
        const item = kind === 'nx' ? 'K3' : '400003'
        b.wire.setOff(1, true)
        for (let n = 0; n < 3; n++) {
          const { code: was } = await b.clock.run(b.device.write([{ item, value: 5 }], { fixed: true }))
          // the echo is off, so nothing is read before
          assert.equal(was, 'WRITE_UNKNOWN')
        }
        await b.clock.advance(5600)
        const probe = b.lease.line.trace().findLast(({ dir }) => dir === 'out')
        assert.equal(probe.note, 'probe')
        assert.match(probe.bytes, kind === 'nx' ? /^01..2303......../i : /^01030002000125ca/i)
        b.wire.setOff(1, false)
        await b.clock.advance(15000)
        assert.equal(b.device.health.state, 'online')
        if (kind === 'nx') await b.close()
      }
    })
  })

  describe('comes back', () => {
    it('when the adapter is plugged in again: the first good value within 2 s and the bound', async () => {
      start()
      const seen = []
      b.device.subscribe({ items: ['M0'], interval: 500 }, ([{ code: bad = 'good' }]) =>
        seen.push([b.clock.now(), bad])
      )
      await b.clock.advance(2000)
      b.wire.setOff(1, true)
      await b.clock.advance(60000)
      assert.equal(seen.at(-1)[1], 'STATION_DEMOTED')
      b.wire.unplug()
      await b.clock.advance(300)
      assert.equal(seen.at(-1)[1], 'PORT_GONE')
      b.wire.setOff(1, false)
      b.wire.plug()
      const plugged = b.clock.now()
      await b.clock.advance(5000)
      const good = seen.find(([at, bad]) => at > plugged && bad === 'good')
      assert.ok(good[0] - plugged <= 2000 + 1000, `${good[0] - plugged} ms`)
      assert.equal(b.heard('stationBack').length, 1)
    })

    it('a port that was opened again gives it one more request, not three, and is no news', async () => {
      start()
      await demote()
      b.wire.unplug()
      b.wire.plug()
      await b.clock.advance(3000)
      assert.equal(b.stats(1).health, 'suspect')
      const queries = b.sent()
      assert.equal(await b.read(), 'TIMEOUT')
      assert.equal(await b.read(), 'STATION_DEMOTED')
      assert.equal(b.sent(), queries + 1)
      assert.equal(b.heard('stationDemoted').length, 1)
    })

    it('over a redeploy it stays known, and the first request goes out at once', async () => {
      start()
      await demote()
      const next = b.open()
      b.device.close()
      await b.clock.run(b.lease.release())
      const device = b.make(next, { station: 1 })
      const events = []
      next.on('event', event => events.push(event.event))
      const before = next.line.stats().queries
      const [first] = await b.clock.run(device.read(['M5']))
      assert.deepEqual([first.code, next.line.stats().queries], ['TIMEOUT', before + 1])
      assert.equal((await b.clock.run(device.read(['M5'])))[0].code, 'STATION_DEMOTED')
      b.wire.setOff(1, false)
      await b.clock.advance(6000)
      assert.deepEqual(events, ['stationBack'])
      device.close()
      await b.clock.run(next.release())
    })

    it('a write after a redeploy is tried once', async () => {
      start()
      await demote()
      b.device.close()
      b.wire.setOff(1, false)
      const device = b.make(b.lease, { station: 1 })
      const outcome = await b.clock.run(device.write([{ item: 'K0', value: 5 }], { fixed: true }))
      assert.equal(outcome.outcome, 'confirmed')
      device.close()
    })

    it('all of them soon after the first one, when the bus was broken', async () => {
      const stations = [1, 2, 3, 4, 5]
      start({ stations })
      for (let at = 0; at < 5; at++) await demote(at)
      await b.clock.advance(300000)
      stations.forEach(station => b.wire.setOff(station, false))
      await b.clock.advance(70000)
      const back = b.heard('stationBack').map(({ at }) => at)
      assert.equal(back.length, 5)
      assert.ok(back[4] - back[0] < 1500, `${back[4] - back[0]}`)
    })

    it('but one that comes back alone does not have the others asked', async () => {
      start({ stations: [1, 2, 3] })
      await demote(1)
      await demote(2)
      b.devices[0].subscribe({ items: ['M0'], interval: 1000 }, () => {})
      await b.clock.advance(100000)
      b.wire.setOff(2, false)
      const queries = b.stats(3).queries
      await b.clock.advance(70000)
      assert.equal(b.heard('stationBack').length, 1)
      assert.ok(b.stats(3).queries - queries <= 2)
    })
  })

  it('another device of the station hears of it, and goes on probing when the first is gone', async () => {
    start()
    const second = b.make(b.lease, { station: 1 })
    await demote()
    b.device.close()
    assert.equal((await b.clock.run(second.read(['M0'])))[0].code, 'STATION_DEMOTED')
    b.wire.setOff(1, false)
    await b.clock.advance(6000)
    assert.equal((await b.clock.run(second.read(['M0'])))[0].quality, 'good')
    assert.equal(b.heard('stationBack').length, 1)
    second.close()
  })

  it('who is told may ask at once, from inside the event', async () => {
    start({ stations: [1, 2] })
    const answers = []
    b.lease.on('event', ({ event }) => {
      if (event === 'stationDemoted' || event === 'stationBack') {
        answers.push(b.devices[1].read(['M0']), b.devices[0].read(['M1']))
      }
    })
    await demote()
    b.wire.setOff(1, false)
    await b.clock.advance(8000)
    const codes = (await b.clock.run(Promise.all(answers))).map(([{ code: bad = 'good' }]) => bad)
    assert.deepEqual(codes, ['good', 'STATION_DEMOTED', 'good', 'good'])
  })

  it('slow: told once an hour, with a timeout that would do', async () => {
    start({ sim: { turnaround: 170 } })
    for (let n = 0; n < 240; n++) await b.read()
    const [event, ...more] = b.heard('slow')
    assert.deepEqual(more, [])
    assert.deepEqual([event.station, event.timeout], [1, 200])
    assert.ok(event.p99 >= 170 && event.p99 < 190)
    assert.match(event.remedy, /Raise the timeout to 300 ms/)
    assert.deepEqual([event.advice, b.stats(1).advice, b.device.advice], [300, 300, 300])
    await b.clock.advance(3600000)
    for (let n = 0; n < 60; n++) await b.read()
    assert.equal(b.heard('slow').length, 2)
    // a deploy that follows the advice ends it
    b.device.close()
    const device = b.make(b.lease, { station: 1, timeout: 300 })
    assert.deepEqual([b.stats(1).advice, device.advice], [null, null])
    device.close()
  })

  it('slow: not for a long answer that begins in time', async () => {
    start({ sim: { turnaround: 20 }, device: { timeout: 60 } })
    for (let n = 0; n < 110; n++) await b.clock.run(b.device.read(['K0..K127']))
    assert.ok(b.stats(1).latency.mean > 60)
    assert.deepEqual(b.heard('slow'), [])
  })
})

describe('one dead station of ten costs at most 5 % of the line', () => {
  const stations = Array.from({ length: 10 }, (_, at) => at + 1)
  const HOUR = 3600000
  for (const [name, kind, device] of [
    ['NX', 'nx', { timeout: 3000, attempts: 3 }],
    ['NX, 4-step', 'nx', { timeout: 3000, attempts: 3, steps: 4 }],
    ['RTU', 'rtu', { timeout: 1000, attempts: 3 }],
    ['ASCII', 'ascii', { timeout: 1000, attempts: 3 }]
  ]) {
    it(name, async () => {
      const sim = { stations: stations.map(station => ({ station, ...(device.steps ? { steps: 4 } : {}) })) }
      const b = bench({ stations, kind, device, sim })
      b.wire.setOff(7, true)
      const good = stations.map(() => 0)
      // the dead one is wanted more often than the others
      b.devices.forEach((each, at) => {
        const group = { items: [b.item], interval: at === 6 ? 5000 : 300000 }
        each.subscribe(group, ([{ quality }]) => void (good[at] += quality === 'good' ? 1 : 0))
      })
      await b.clock.advance(HOUR)
      const { busy } = b.lease.line.stats()
      const { timeouts } = b.stats(7)
      await b.close()
      // the living ones' own time is in it, too
      assert.ok(busy <= 0.05 * HOUR, `${((100 * busy) / HOUR).toFixed(2)} %`)
      assert.ok(timeouts > 50, 'it is probed all the time')
      stations.forEach((_, at) => assert.ok(at === 6 ? good[at] === 0 : good[at] >= 12, `${good}`))
    })
  }
})
