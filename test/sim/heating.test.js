'use strict'

const assert = require('node:assert')
const { createChinoRegulator } = require('../../lib/sim')
const { bytes, framed, shown } = require('./support')

/** A regulator with its heater, and the time in seconds. */
function bench(settings = {}) {
  const time = { now: 0 }
  const station = createChinoRegulator({ station: 1, clock: { now: () => time.now }, ...settings })
  const { get, set } = station
  return { station, get, set, wait: seconds => (time.now += 1000 * seconds), time }
}

const near = (value, expected, share = 0.02) =>
  assert.ok(Math.abs(value - expected) <= Math.abs(expected * share), `${value}, not ${expected}`)

describe('heating model of the simulated regulator', () => {
  it('starts switched on, with a set value', () => {
    const { get } = bench()
    assert.deepStrictEqual([get('001001'), get('400001'), get('400002'), get('400003')], [true, 350, 1000, 0])
    assert.deepStrictEqual([get('300001'), get('300006', 'int16'), get('300007', 'uint32')], [350, 200, 0])
  })

  it('output = manual × gradient + elevation, within 0 and 100 %', () => {
    const { get, set } = bench()
    for (const [manual, gradient, elevation, output] of [
      [1000, 1000, 0, 1000],
      [500, 500, 0, 250],
      [500, 500, -100, 150],
      [100, 1000, -200, 0],
      [900, 1000, 300, 1000]
    ]) {
      set('400001', manual)
      set('400002', gradient)
      set('400003', elevation, 'int16')
      assert.strictEqual(get('300001'), output)
    }
    set('001001', false)
    assert.deepStrictEqual([get('300001'), get('300002'), get('300003'), get('300004')], [0, 0, 0, 0])
  })

  it('voltage, current, power and resistance belong together', () => {
    const { get, set, wait } = bench()
    set('400001', 500)
    wait(30)
    const [volt, ampere, watt, ohm] = ['300002', '300003', '300004', '300005'].map(at => Number(get(at)))
    near(volt / 10, 400 * Math.sqrt(0.5))
    near(ampere / 10, volt / 10 / (ohm / 100))
    near(watt, ((volt / 10) * ampere) / 10)
    assert.ok(ohm > 800 && ohm < 1200)
  })

  it('temperature follows the power with a lag of a minute, and falls again', () => {
    const { get, set, wait } = bench()
    const celsius = () => Number(get('300006', 'int16')) / 10
    set('400001', 200)
    wait(600)
    const warm = celsius()
    near(warm, 20 + 0.06 * Number(get('300004')), 0.05)
    set('001001', false)
    wait(60)
    near(celsius() - 20, (warm - 20) / Math.E)
    wait(600)
    near(celsius(), 20)
  })

  it('counts energy: 32 bits, low word first', () => {
    const { get, set, wait } = bench()
    set('400001', 1000)
    wait(3600 * 10)
    const energy = Number(get('300007', 'uint32'))
    near(energy, 10 * Number(get('300004')), 0.05)
    assert.strictEqual(energy, Number(get('300008')) * 65536 + Number(get('300007')))
    assert.ok(energy > 65536)
  })

  it('does not depend on how often somebody looks', () => {
    const [often, seldom] = [bench(), bench()]
    for (let n = 0; n < 600; n++) {
      often.wait(0.5)
      often.get('300006')
    }
    seldom.wait(300)
    near(Number(often.get('300006')), Number(seldom.get('300006')), 0.01)
    near(Number(often.get('300007', 'uint32')), Number(seldom.get('300007', 'uint32')), 0.01)
  })

  it('alarms: heater break, over-temperature', () => {
    const { station, get, set, wait } = bench()
    const alarms = () => [get('101001'), get('101002')]
    assert.deepStrictEqual(alarms(), [false, false])
    set('400001', 1000)
    wait(600)
    assert.deepStrictEqual(alarms(), [false, true])
    station.breakHeater()
    wait(1)
    assert.deepStrictEqual([get('300003'), get('300004'), get('300005')], [0, 0, 65535])
    assert.deepStrictEqual(alarms(), [true, true])
    station.breakHeater(false)
    wait(1)
    assert.deepStrictEqual(alarms(), [false, true])
  })

  it('is written by its master: 0 to 1000, else exception 03', () => {
    const { station, get, wait, time } = bench()
    const ask = body => {
      wait(1)
      const jobs = station.receive(framed(...bytes(body)), { start: time.now, end: time.now })
      return jobs.map(job => shown(job.answer()))
    }
    assert.deepStrictEqual(ask('01 06 00 00 03 E8'), [shown(framed(...bytes('01 06 00 00 03 E8')))])
    assert.strictEqual(get('300001'), 1000)
    assert.deepStrictEqual(ask('01 06 00 00 03 E9'), [shown(framed(...bytes('01 86 03')))])
    assert.deepStrictEqual(ask('01 05 03 E8 00 00'), [shown(framed(...bytes('01 05 03 E8 00 00')))])
    assert.strictEqual(get('300001'), 0)
    assert.deepStrictEqual(ask('01 02 03 E8 00 02'), [shown(framed(...bytes('01 02 01 00')))])
  })

  it('is left out where live values of one’s own are given, or none are wanted', () => {
    assert.strictEqual(bench({ heating: false }).get('001001'), false)
    const { get } = bench({ behaviour: [{ at: '300001', kind: () => 7 }] })
    assert.deepStrictEqual([get('300001'), get('001001')], [7, false])
  })
})
