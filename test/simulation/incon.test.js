'use strict'

const assert = require('node:assert')
const { createRandom } = require('../../lib/sim')
const { inconBench } = require('../device/incon-bench')
const { PATIENT, inconMessages } = require('./incon-messages')

/**
 * 10,000 lines each way on a line on which one byte of a hundred is damaged or lost. Each line says which one it is, so that a text that nobody
 * sent, a doubled one, or two in one are found.
 */

const LINES = 10000
const PART = 250
const WEAR = { damaged: 0.005, lost: 0.005 }

const textOf = (way, n) => `${way} ${n} [${(n * 7919) % 9973}]`
const numberIn = (way, text) => {
  const n = Number(/ (\d+) /.exec(text)?.[1])
  return text === textOf(way, n) ? n : null
}

/** What became of the lines of one way. */
const judge = (way, texts) => {
  const numbers = texts.map(text => numberIn(way, text))
  const good = numbers.filter(n => n !== null)
  return {
    good: good.length,
    wrong: texts.filter((_, at) => numbers[at] === null),
    doubled: good.length - new Set(good).size,
    disordered: good.filter((n, at) => at > 0 && n < good[at - 1]).length,
    glued: texts.filter(text => text.split('[').length > 2).length
  }
}

async function exchange(options) {
  const bench = inconBench({
    wire: { wear: WEAR, collisions: false, chunk: 8 },
    ...options,
    link: { scan: 10, ...options.link },
    line: { queueLimit: PART },
    sim: { scan: 10, keep: LINES * 2, ...options.sim }
  })
  const outcomes = []
  for (let from = 0; from < LINES; from += PART) {
    const part = Array.from({ length: PART }, (_, n) => bench.device.send(textOf('to', from + n)))
    for (let n = 0; n < PART; n++) bench.controller.say(textOf('of', from + n))
    outcomes.push(...(await bench.run(Promise.all(part))))
    await bench.clock.drain()
  }
  const { got, device, controller } = bench
  const result = {
    got: [...got],
    stats: device.stats,
    counts: { ...controller.counts },
    messages: [...controller.messages]
  }
  await bench.close()
  assert.ok(outcomes.every(({ outcome }) => outcome === 'sent'))
  return result
}

/**
 * How many lines stay whole, within five standard deviations: no byte of theirs is hit, nor of the line feeds before and behind them; a CR may be
 * lost, but not damaged.
 * @param {number} whole @param {string} way @param {number} more bytes beside the text
 */
const expectWhole = (whole, way, more) => {
  const shares = Array.from(
    { length: LINES },
    (_, n) => (1 - WEAR.damaged - WEAR.lost) ** (textOf(way, n).length + more + 2)
  )
  const expected = shares.reduce((sum, share) => sum + share, 0)
  const spread = 5 * Math.sqrt(shares.reduce((sum, share) => sum + share * (1 - share), 0))
  assert.ok(Math.abs(whole - expected) < spread, `${whole} of ${LINES}, expected ${Math.round(expected)} ± ${spread}`)
}

const xorOf = letters => [...letters].reduce((sum, letter) => sum ^ letter.charCodeAt(0), 0)
const DIGITS = '0123456789ABCDEF'

/** What the theory of the check says: so many of these lines pass it with another text. Our own XOR, our own damage. */
const wrongByTheory = way => {
  const random = createRandom(99)
  const rounds = 5
  let wrong = 0
  for (let n = 0; n < LINES * rounds; n++) {
    const body = `#${String(n % 100).padStart(2, '0')} ${textOf(way, n % LINES)}`
    const check = xorOf(body)
    const line = `${body}*${DIGITS[check >> 4]}${DIGITS[check & 15]}`
    const worn = [...line].map(letter => wear(letter, random)).join('')
    if (worn === line) continue
    const [, text, digits] = /^(.*)\*([\dA-Fa-f]{2})$/s.exec(worn) ?? []
    if (text !== undefined && text !== body && xorOf(text) === parseInt(digits, 16)) wrong++
  }
  return wrong / rounds
}

const wear = (letter, random) => {
  const share = random.next()
  if (share < WEAR.lost) return ''
  return share < WEAR.lost + WEAR.damaged ? String.fromCharCode(letter.charCodeAt(0) ^ random.integer(1, 255)) : letter
}

describe('INCON: 10,000 lines each way with 1 % of the bytes damaged or lost', function () {
  this.timeout(30000)

  it('plain lines: nothing doubled or out of order; only a lost line end glues two, and that shows', async () => {
    const { got, stats, messages } = await exchange({})
    const whole = got.filter(({ complete }) => complete).map(({ value }) => value)
    const received = judge('of', whole)
    const taken = judge(
      'to',
      messages.map(({ text }) => text)
    )
    for (const [way, { doubled, disordered, good }] of Object.entries({ of: received, to: taken })) {
      assert.deepStrictEqual([doubled, disordered], [0, 0], way)
      expectWhole(good, way, 0)
    }
    // both CR and LF must be hit to glue two lines here, with one the CR is left: 1 in 10,000
    assert.ok(received.glued <= 6, `${received.glued} glued`)
    // the controller's own program knows no CR: a hit LF glues; there it shows by the CR, or by what became of it
    assert.ok(taken.glued > 50 && taken.glued < 150, `${taken.glued} glued for the PLC`)
    assert.ok(stats.incomplete > 50 && stats.damaged > 100, JSON.stringify(stats))
  })

  it('checked lines: none doubled, each missing one is counted, wrong ones at the rate of the check', async () => {
    const { got, stats, counts, messages } = await exchange({ sim: { checked: true }, link: { checked: true } })
    const whole = got.filter(({ complete }) => complete)
    const valid = messages.filter(message => message.valid)
    const received = judge(
      'of',
      whole.map(({ value }) => value)
    )
    const taken = judge(
      'to',
      valid.map(({ text }) => text)
    )
    for (const [way, { doubled, disordered, good }] of Object.entries({ of: received, to: taken })) {
      assert.deepStrictEqual([doubled, disordered], [0, 0], way)
      expectWhole(good, way, 7)
    }
    for (const [way, { wrong }] of Object.entries({ of: received, to: taken })) {
      const expected = wrongByTheory(way)
      assert.ok(
        wrong.length <= expected + 5 * Math.sqrt(expected),
        `${way}: ${wrong.length} wrong, expected ${expected}`
      )
    }
    // what did not come is counted, without exception
    assert.deepStrictEqual([whole.length + stats.lost, valid.length + counts.missing], [LINES, LINES])
    assert.ok(stats.damaged > 1900 && got.every(({ complete, value }) => complete === (value !== null)))
  })
})

describe('INCON: acknowledged lines while one byte of a hundred is damaged or lost, and both send when they like', function () {
  this.timeout(30000)

  // endurance run "inconmessages": 10,000 each way
  it('0 lost, 0 doubled, none out of order', async () => {
    const count = 500
    const { outcomes, theirs, toThem, toUs, stats, counts, pending } = await inconMessages({
      count,
      seed: 1,
      ...PATIENT
    })
    assert.deepStrictEqual([outcomes, theirs, pending], [{ confirmed: count }, { confirmed: count }, 0])
    // of 500 lines 0.05 come wrong by theory; with this seed none does
    const all = { came: count, lost: 0, silently: 0, doubled: 0, wrong: 0, disorder: 0 }
    assert.deepStrictEqual([toThem, toUs], [all, all])
    // the line was as bad as it should be: repetitions because a line, and because an acknowledgement was hit
    for (const each of [stats, counts])
      assert.ok(each.repeats > count / 5 && each.repeated > count / 25, JSON.stringify(each))
  })

  it('with the default of attempts: what is given up is told, and nothing is doubled', async () => {
    const { outcomes, theirs, toThem, toUs } = await inconMessages({
      ...{ count: 200, seed: 2, wear: { damaged: 0.015, lost: 0.015 } }
    })
    assert.ok(outcomes.unknown > 3 && theirs.unknown > 3, JSON.stringify([outcomes, theirs]))
    for (const { doubled, silently, wrong } of [toThem, toUs])
      assert.deepStrictEqual([doubled, silently <= wrong, wrong <= 2], [0, true, true])
  })

  it('switched off and on, either of them, every few seconds: nothing is doubled or lost silently', async () => {
    for (const seed of [1, 2]) {
      const { outcomes, theirs, toThem, toUs, pending } = await inconMessages({ count: 80, seed, restarts: 4000 })
      assert.ok(
        outcomes.unknown > 2 && outcomes.confirmed > 50 && theirs.confirmed > 30,
        JSON.stringify([outcomes, theirs])
      )
      for (const { doubled, silently, wrong } of [toThem, toUs])
        assert.deepStrictEqual([doubled, silently, wrong], [0, 0, 0], `seed ${seed}`)
      assert.strictEqual(pending, 0)
    }
  })
})
