'use strict'

const assert = require('node:assert')
const {
  createFaults,
  createNxLine,
  createRandom,
  createVirtualClock,
  faultKinds,
  parseFaults
} = require('../../lib/sim')

const hex = text => Buffer.from(text.replace(/\s/g, ''), 'hex')
const shown = buffer => buffer.toString('hex').toUpperCase().replace(/../g, '$& ').trim()

// vectors of the protocol page: M0 = 1234h, M1 = ABCDh
const QUERY = hex('01 E2 23 03 C0 00 02 58 3C')
const ANSWER = 'E2 01 A3 04 34 12 CD AB 8D 13'
const END = (9 * 10000) / 9600 + 3 // ms until the answer begins: the query at 9600 bit/s, turnaround 3 ms

/** One query to a station with one ordered fault; what comes back, and when the first byte does. */
async function suffer(kind, argument, settings = {}) {
  const clock = createVirtualClock()
  const line = createNxLine({ clock, baudRate: 9600, turnaround: 3, quiet: true, chunk: 1, ...settings })
  const [plc] = line.plcs
  plc.set('M0', 0x1234)
  plc.set('M1', 0xabcd)
  if (kind) line.faults.once(kind, { argument })
  const heard = []
  const end = line.wire.connect({ data: bytes => heard.push({ at: clock.now(), bytes }), closed() {} })
  end.write(QUERY)
  await clock.drain()
  const answer = () => shown(Buffer.concat(heard.map(({ bytes }) => bytes)))
  const first = heard.length > 0 ? heard[0].at - 10000 / 9600 - END : NaN
  return { ...line, clock, plc, heard, end, answer, first }
}

describe('faults of the simulator', () => {
  it('none: the answer of the manual', async () => {
    const { answer, first } = await suffer(null, undefined)
    assert.strictEqual(answer(), ANSWER)
    assert.ok(Math.abs(first) < 1e-6)
  })

  it('lost: not heard, not carried out', async () => {
    const { answer, plc } = await suffer('lost')
    assert.deepStrictEqual([answer(), plc.counts.executed], ['', 0])
  })

  it('silent: carried out, no answer', async () => {
    const { answer, plc } = await suffer('silent')
    assert.deepStrictEqual([answer(), plc.counts.executed], ['', 1])
  })

  it('late: by exactly n ms, with the values of then', async () => {
    const { answer, first } = await suffer('late', 350)
    assert.strictEqual(answer(), ANSWER)
    assert.ok(Math.abs(first - 350) < 1e-6, String(first))
  })

  it('error: the number, nothing carried out', async () => {
    const { answer, plc } = await suffer('error', 2)
    assert.strictEqual(answer(), 'E2 01 83 01 02 AC 53')
    assert.strictEqual(plc.counts.executed, 0)
  })

  it('crc: exactly n bits differ', async () => {
    const { answer } = await suffer('crc', 2)
    const [got, right] = [hex(answer()), hex(ANSWER)]
    assert.strictEqual(got.length, right.length)
    const bits = [...got].reduce((sum, byte, n) => sum + ((byte ^ right[n]).toString(2).match(/1/g) ?? []).length, 0)
    assert.strictEqual(bits, 2)
  })

  it('truncated: the last n bytes are missing', async () => {
    assert.strictEqual((await suffer('truncated', 3)).answer(), ANSWER.slice(0, -9))
    for (let seed = 0; seed < 20; seed++) {
      const answer = (await suffer('truncated', undefined, { seed })).answer()
      assert.ok(answer.length > 0 && answer.length < ANSWER.length && ANSWER.startsWith(answer))
    }
  })

  it('duplicated: twice, carried out once', async () => {
    const { answer, plc } = await suffer('duplicated', 0)
    assert.deepStrictEqual([answer(), plc.counts.executed], [`${ANSWER} ${ANSWER}`, 1])
  })

  it("foreign: another station's good frame with other data, then the right one", async () => {
    const { answer } = await suffer('foreign')
    const [foreign, right] = [answer().slice(0, ANSWER.length), answer().slice(ANSWER.length + 1)]
    assert.strictEqual(right, ANSWER)
    assert.match(foreign, /^E2 0[2-8] A3 04 /)
    assert.ok(!foreign.includes('34 12 CD AB'))
    // a frame with its own CRC appended has the CRC 0
    const rest = [...hex(foreign)].reduce((value, byte) => {
      let next = value ^ byte
      for (let bit = 0; bit < 8; bit++) next = next & 1 ? (next >> 1) ^ 0xa001 : next >> 1
      return next
    }, 0xffff)
    assert.strictEqual(rest, 0)
  })

  it('before, after: n bytes of noise around the answer', async () => {
    const before = (await suffer('before', 4)).answer()
    assert.ok(before.endsWith(ANSWER) && before.length === ANSWER.length + 12, before)
    const after = (await suffer('after', 4)).answer()
    assert.ok(after.startsWith(ANSWER) && after.length === ANSWER.length + 12, after)
  })

  it('echo: the query comes back first', async () => {
    assert.strictEqual((await suffer('echo')).answer(), `${shown(QUERY)} ${ANSWER}`)
  })

  it('merged: the answer before this one follows it', async () => {
    const { clock, plc, faults, heard, end, answer } = await suffer(null)
    heard.length = 0
    plc.set('M0', 0)
    faults.once('merged')
    end.write(QUERY)
    await clock.drain()
    assert.ok(answer().endsWith(ANSWER) && answer().startsWith('E2 01 A3 04 00 00 CD AB'), answer())
  })

  it('off: dark for n ms', async () => {
    const { clock, plc, heard, end, answer } = await suffer('off', 500)
    assert.strictEqual(answer(), '')
    assert.ok(clock.now() > 500)
    end.write(QUERY)
    await clock.drain()
    assert.deepStrictEqual([answer(), heard.length, plc.counts.executed], [ANSWER, 10, 1])
  })

  it('every kind has a test here', () => {
    const tested = 'lost silent off error late crc truncated duplicated foreign before after echo merged'
    assert.deepStrictEqual(
      faultKinds().map(({ kind }) => kind),
      tested.split(' ')
    )
  })
})

describe('drawing faults', () => {
  it('keeps to the rates, one fault at most', () => {
    const faults = createFaults({ random: createRandom(4), rates: parseFaults('late:0.1:5,crc:0.2,silent:0.5') })
    const drawn = Array.from({ length: 20000 }, () => faults.draw(1)?.kind ?? 'none')
    const share = kind => drawn.filter(each => each === kind).length / drawn.length
    const expected = { late: 0.1, crc: 0.2, silent: 0.5, none: 0.2 }
    for (const [kind, rate] of Object.entries(expected)) assert.ok(Math.abs(share(kind) - rate) < 0.01, kind)
    assert.strictEqual(faults.counts.late, drawn.filter(each => each === 'late').length)
  })

  it('ordered ones come first, at their station, after the unharmed ones, as often as ordered', () => {
    const faults = createFaults()
    faults.once('late', { argument: 9, station: 2, skip: 1, times: 2 })
    assert.strictEqual(faults.draw(1), null)
    const drawn = Array.from({ length: 4 }, () => faults.draw(2))
    const late = { kind: 'late', argument: 9 }
    assert.deepStrictEqual(drawn, [null, late, late, null])
  })

  it('are switched off', () => {
    const faults = createFaults({ rates: [{ kind: 'silent', rate: 1 }] })
    faults.set('silent', 0)
    assert.strictEqual(faults.draw(1), null)
    faults.set('crc', 1)
    faults.clear()
    assert.strictEqual(faults.draw(1), null)
  })

  it('reads kinds, rates and numbers', () => {
    assert.deepStrictEqual(parseFaults(''), [])
    assert.deepStrictEqual(parseFaults(' late:0.02 , error:0.1:2 '), [
      { kind: 'late', rate: 0.02, argument: undefined },
      { kind: 'error', rate: 0.1, argument: 2 }
    ])
  })

  const wrong = [
    ['late', /rate must be/],
    ['late:x', /rate must be/],
    ['late:1.5', /rate must be/],
    ['late:-1', /rate must be/],
    ['tired:0.1', /known faults are lost/],
    ['toString:0.1', /known faults are lost/],
    ['late:0.6,crc:0.6', /more than 1/],
    ['error:0.1:6', /from 1 to 5/],
    ['error:0.1:2.5', /from 1 to 5/],
    ['silent:0.1:3', /rate alone/],
    ['late:0.1:2:3', /kind:rate/]
  ]
  for (const [text, reason] of wrong) {
    it(`refuses ${text}`, () => {
      assert.throws(
        () => parseFaults(String(text)),
        error => error.code === 'BAD_SETTING' && RegExp(reason).test(error.message)
      )
    })
  }

  it('refuses rates that add up to more than 1 when they are set', () => {
    const faults = createFaults({ rates: [{ kind: 'late', rate: 0.7 }] })
    assert.throws(() => faults.set('crc', 0.4), { code: 'BAD_SETTING' })
    faults.set('late', 0.5)
    faults.set('crc', 0.5)
  })
})
