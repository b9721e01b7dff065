'use strict'

const assert = require('node:assert/strict')
const { createBench, failure } = require('./support/bench')
const { toyFraming } = require('./support/framing')
const toy = require('./support/toy')

const hear = () => undefined

describe('line: a lease', () => {
  it('that was released says so, whatever it is asked for', async () => {
    const { lease, run } = createBench()
    assert.equal(lease.released, false)
    await run(lease.release())
    assert.equal(lease.released, true)
    const closed = ({ code, details }) => [code, details]
    const expected = ['LINE_CLOSED', { line: 'the line', sent: false }]
    assert.deepEqual(closed(await failure(lease.run(() => toy.ask(1), { station: 1 }))), expected)
    assert.throws(
      () => lease.listen(toyFraming(), hear),
      error => {
        assert.deepEqual(closed(error), expected)
        return true
      }
    )
    const sent = await failure(lease.send(Buffer.from('abc')))
    assert.deepEqual(closed(sent), ['LINE_CLOSED', { line: 'the line', sent: 0, of: 3 }])
  })

  it('needs a framing, someone who takes messages, bytes, and a time for an answer', async () => {
    const { lease } = createBench()
    const { create } = toyFraming()
    for (const framing of /** @type {any[]} */ ([undefined, null, {}, { key: 'a' }, { key: 7, create }, { create }])) {
      assert.throws(() => lease.listen(framing, hear), { name: 'TypeError', message: 'a framing is needed' })
    }
    const noListener = /** @type {any} */ ({ onMessage: hear })
    const message = 'a function that takes the messages is needed'
    assert.throws(() => lease.listen(toyFraming(), noListener), { name: 'TypeError', message })
    for (const [sent, options, text] of /** @type {any[]} */ ([
      ['text', {}, 'bytes to send are needed'],
      [Buffer.alloc(0), {}, 'bytes to send are needed'],
      [Buffer.from('a'), { match: () => true }, 'an answer needs a timeout']
    ])) {
      const { name, message: why } = await failure(lease.send(sent, options))
      assert.deepEqual([name, why], ['TypeError', text])
    }
  })

  it('hears of the line until it is released, or does not want to hear any more', async () => {
    const { lease, open, run, wire, clock } = createBench()
    const stays = open({}, 'stays')
    await clock.advance(1)
    const heard = []
    const both = (...what) => heard.push(`both ${what[0].event ?? what[0]}`)
    const other = ({ event }) => heard.push(`other ${event}`)
    lease.on('state', both).on('event', both).on('event', other)
    lease.off('event', both).off('event', hear)
    stays.line.report({ event: 'one', station: null })
    wire.unplug()
    assert.deepEqual(heard.splice(0).sort(), ['both waiting', 'other lineDown', 'other one'])
    await run(lease.release())
    stays.line.report({ event: 'two', station: null })
    await clock.advance(1000)
    assert.deepEqual(heard, [])
    lease.on('event', other)
    stays.line.report({ event: 'three', station: null })
    assert.deepEqual(heard, [])
    await run(stays.release())
  })

  it('one that does not want to hear any more takes nothing from another one that hears with the same function', async () => {
    const { lease, open, run } = createBench()
    const stays = open({}, 'stays')
    const heard = []
    const hears = ({ event }) => heard.push(event)
    stays.on('event', hears)
    lease.off('event', hears)
    lease.on('event', hears).off('event', hears).off('event', hears)
    stays.line.report({ event: 'one', station: null })
    assert.deepEqual(heard, ['one'])
    await run(lease.release())
    stays.line.report({ event: 'two', station: null })
    assert.deepEqual(heard, ['one', 'two'])
    await run(stays.release())
  })

  it('shows the line: its times, and the flow control of its driver', async () => {
    const { lease } = createBench({ settings: { baudRate: 9600, flowControl: 'rtscts', gap: 9 } })
    const { line } = lease
    assert.deepEqual([line.flowControl, line.times.gap, line.times.slack], ['rtscts', 9, 50])
    assert.ok(Math.abs(line.times.character - 10 / 9.6) < 1e-9)
  })

  it('a port that never opened was not lost; one that was says for how long', async () => {
    const { lease, wire, clock, run } = createBench()
    const events = []
    lease.on('event', event => events.push(event))
    wire.refuse = new Error('not there')
    await clock.advance(5000)
    assert.equal(lease.line.stats().reconnects, 0)
    wire.refuse = null
    await clock.advance(40000)
    assert.equal(lease.line.state, 'open')
    events.length = 0
    wire.unplug()
    await clock.advance(5000)
    const [down, up] = events
    assert.deepEqual([down.event, up.event, lease.line.stats().reconnects], ['lineDown', 'lineUp', 1])
    assert.deepEqual([up.cause, up.remedy], [`it was down for ${up.downFor} ms`, ''])
    await run(lease.release())
  })
})
