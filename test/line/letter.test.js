'use strict'

const assert = require('node:assert/strict')
const { PlcError } = require('../../lib/error')
const { Aftermath } = require('../../lib/line/aftermath')
const { Letter } = require('../../lib/line/letter')
const { OwnEcho } = require('../../lib/line/own-echo')
const { failure } = require('./support/bench')
const { createLateClock } = require('./support/late-clock')

const letterOf = (length, options = {}) => new Letter({}, { bytes: Buffer.alloc(length), options, now: 5 })
const NO_TORN = { wait: 0, first: null, apart: false }

describe('line: a letter', () => {
  it('has left byte by byte, by the time of the wire; the last one when the port has taken it', () => {
    const letter = letterOf(200)
    assert.deepEqual([letter.waits, letter.handedOver, letter.sent(0, 1), letter.isTorn(0, 1)], [true, false, 0, false])
    letter.begin(100, null)
    letter.out = 50
    letter.piece = { at: 100, from: 0, end: 125, taken: false }
    const gone = now => [letter.sent(now, 0.5), letter.isTorn(now, 0.5)]
    for (const [now, sent] of [
      [100, 1],
      [100.9, 1],
      [110, 20],
      [125, 49],
      [999, 49]
    ]) {
      assert.deepEqual(gone(now), [sent, true], `at ${now}`)
    }
    letter.piece.taken = true
    assert.deepEqual([gone(124.9), gone(125), letter.given, letter.handedOver], [[49, true], [50, true], 50, false])
    letter.out = 200
    letter.piece = { at: 125, from: 50, end: 200, taken: false }
    assert.deepEqual([gone(999), letter.handedOver], [[199, true], true])
    letter.piece.taken = true
    assert.deepEqual(
      [gone(130), gone(200)],
      [
        [60, true],
        [200, false]
      ]
    )
  })

  it('is whole at the computed end, whatever the division of times says', () => {
    const character = 10000 / 9600
    const letter = letterOf(57)
    letter.begin(4.7, null)
    letter.out = 57
    letter.piece = { at: 4.7, from: 0, end: 4.7 + 57 * character, taken: true }
    assert.ok(Math.floor((letter.piece.end - 4.7) / character) < 57)
    assert.deepEqual(
      [letter.sent(letter.piece.end, character), letter.isTorn(letter.piece.end, character)],
      [57, false]
    )
  })

  it('what goes before it does not count; nobody may wait for it any more', async () => {
    const letter = letterOf(10, { match: () => true })
    letter.begin(0, Buffer.from('\r\n'))
    letter.out = 2
    letter.piece = { at: 0, from: 0, end: 2, taken: true }
    assert.deepEqual([letter.given, letter.sent(2, 1), letter.wire.length], [0, 0, 12])
    letter.out = 12
    letter.piece = { at: 2, from: 2, end: 12, taken: true }
    assert.deepEqual([letter.given, letter.sent(5, 1)], [10, 3])
    letter.abandoned()
    assert.deepEqual([letter.lease, letter.match], [null, null])
    letter.reject(new PlcError('LINE_CLOSED', { line: 'mill' }), 3)
    const { code, details } = await failure(letter.promise)
    assert.deepEqual([code, details.line, details.sent, details.of], ['LINE_CLOSED', 'mill', 3, 10])
    const other = letterOf(1)
    const mistake = new TypeError('mistake')
    other.reject(mistake, 0)
    assert.equal(await failure(other.promise), mistake)
  })
})

describe('line: what letters leave behind', () => {
  const create = (memories = new Map()) => {
    const clock = createLateClock()
    return { clock, memories, aftermath: new Aftermath(clock, memories) }
  }

  it('an answer that may still come, for a second at least, and once', () => {
    const { clock, aftermath } = create()
    const expect = match => aftermath.expect({ match, timeout: 200, piece: { end: 50 } })
    aftermath.expect({ match: null, timeout: 200, piece: { end: 50 } })
    aftermath.expect({ match: () => true, timeout: 200, piece: null })
    assert.equal(aftermath.isLate('ACK'), false)
    expect(message => message === 'ACK')
    assert.equal(aftermath.until(NO_TORN), 1050)
    assert.deepEqual(
      ['NAK', 'ACK', 'ACK'].map(message => aftermath.isLate(message)),
      [false, true, false]
    )
    expect(() => true)
    clock.wake(1050.1)
    assert.equal(aftermath.isLate('ACK'), false)
    clock.wake(1050)
    assert.equal(aftermath.isLate('ACK'), true)
    expect(() => JSON.parse('no JSON'))
    assert.equal(aftermath.isLate('ACK'), false)
  })

  it('a torn message: what ends it goes out once, again after the connection was lost, and in the next process of the wire', () => {
    const torn = { wait: 30, first: Buffer.from('\r'), apart: true }
    const { clock, memories, aftermath } = create()
    clock.wake(100)
    assert.deepEqual([aftermath.first(torn), aftermath.until(torn)], [null, 0])
    aftermath.tear()
    assert.deepEqual([aftermath.first(torn), aftermath.until(torn)], [torn.first, 130])
    aftermath.end()
    assert.equal(aftermath.first(torn), null)
    assert.equal(create(memories).aftermath.first(torn), torn.first)
    aftermath.lost()
    assert.equal(aftermath.first(torn), torn.first)
    aftermath.end()
    aftermath.over()
    assert.deepEqual([aftermath.first(torn), aftermath.until(torn)], [null, 0])
    aftermath.tear()
    assert.equal(aftermath.first(torn), torn.first)
    aftermath.pause(200)
    aftermath.pause(150)
    assert.equal(aftermath.until(torn), 200)
  })
})

describe('line: what an adapter hears of us', () => {
  const create = echo => {
    const clock = createLateClock()
    return { clock, own: new OwnEcho({ clock, times: { slack: 10 }, settings: { echo } }) }
  }
  const look = (own, text) => own.look(Buffer.from(text))

  it('is taken out in order, over several messages and however it is split, until the slack is over', () => {
    const { clock, own } = create('on')
    own.sent(Buffer.from('ab'), 2)
    own.sent(Buffer.from('cd'), 4)
    assert.deepEqual([look(own, 'a'), look(own, 'bcdx'), look(own, 'a')], [1, 3, 0])
    for (const [at, seen] of [
      [14, 2],
      [14.1, 0]
    ]) {
      own.sent(Buffer.from('ab'), 4)
      clock.wake(at)
      assert.equal(look(own, 'ab'), seen)
    }
  })

  it('damaged: nothing more is taken out; with another setting nothing is', () => {
    const { own } = create('on')
    own.sent(Buffer.from('abcd'), 4)
    assert.deepEqual([look(own, 'axcd'), look(own, 'bcd')], [1, 0])
    for (const echo of ['auto', 'off']) {
      const other = create(echo).own
      other.sent(Buffer.from('ab'), 2)
      assert.equal(look(other, 'ab'), 0)
    }
  })
})
