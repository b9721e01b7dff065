'use strict'

/**
 * Messages both ways between a C24 port and the simulated module, on a line that damages and loses bytes. Every message carries its own number, so that
 * what was lost, doubled, wrong or glued together can be counted.
 */

const { createC24Port, createPool } = require('../../lib')
const { createPeerLine, createVirtualClock } = require('../../lib/sim')

/** A number and what follows from it: eight characters, an even count, none of them a control code. */
const messageOf = (side, n) => {
  const digits = String(n).padStart(5, '0')
  const sum = [...digits].reduce((all, digit, at) => all + Number(digit) * (at + 3), 0)
  return `${side}${digits}${String(sum % 100).padStart(2, '0')}`
}

/** What came, compared with what was sent. */
const verdict = (side, { count, got }) => {
  const seen = new Map()
  let wrong = 0
  let glued = 0
  let disorder = 0
  let last = -1
  for (const text of got) {
    // one damaged character leaves eight of them; two messages in one have more than any
    if (text.length > messageOf(side, 0).length + 4) glued++
    const n = Number(text.slice(1, 6))
    if (text !== messageOf(side, n) || n >= count) {
      wrong++
      continue
    }
    if (n < last) disorder++
    last = n
    seen.set(n, (seen.get(n) ?? 0) + 1)
  }
  const doubled = [...seen.values()].filter(times => times > 1).length
  return { came: got.length, lost: count - seen.size, doubled, wrong, glued, disorder }
}

/** The module's sequence program drops a message that is the same as the one before: it came twice. */
const program = () => {
  const taken = []
  return { taken, take: text => void (text === taken.at(-1) || taken.push(text)) }
}

/**
 * @param {{ count: number, seed?: number, wear?: { damaged?: number, lost?: number }, port?: Record<string, any>, peer?: Record<string, any>,
 *   pause?: number }} options count: messages each way; pause: ms between two of a side
 */
const c24Messages = async ({ count, seed = 1, wear, port = {}, peer = {}, pause = 0 }) => {
  const clock = createVirtualClock()
  const baudRate = 38400
  const theirs = program()
  let next = 0
  const speak = () => {
    if (next < count) clock.setTimer(() => device.send(messageOf('C', next++)), pause)
  }
  const settings = {
    history: 10,
    onMessage: ({ bytes }) => theirs.take(bytes.toString('latin1')),
    onSent: speak,
    ...peer
  }
  const made = createPeerLine({ device: 'c24', settings, baudRate, seed, clock, quiet: true, wear })
  const { device } = made
  const pool = createPool({ clock, random: () => 0.5 })
  const line = { transport: 'simulated', path: 'c24', wire: made.wire, baudRate }
  const lease = pool.open(line, { id: 'a', name: 'a' })
  const ours = createC24Port({ lease, clock, ...port })
  const got = []
  const damaged = []
  ours.listen(({ text, complete }) => (complete ? got : damaged).push(text))
  await clock.advance(2000)

  const outcomes = /** @type {Record<string, number>} */ ({})
  const sendAll = async () => {
    for (let n = 0; n < count; n++) {
      const { outcome } = await ours.send(messageOf('P', n))
      outcomes[outcome] = (outcomes[outcome] ?? 0) + 1
      if (pause > 0) await new Promise(resolve => clock.setTimer(() => resolve(undefined), pause))
    }
  }
  speak()
  await clock.run(sendAll())
  for (let round = 0; round < 10000 && (next < count || round < 20); round++) await clock.advance(1000)
  const result = {
    ms: clock.now(),
    outcomes,
    toModule: verdict('P', { count, got: theirs.taken }),
    toUs: { ...verdict('C', { count, got }), damaged: damaged.length },
    stats: ours.stats,
    line: lease.line.stats(),
    counts: device.counts
  }
  ours.close()
  await clock.run(lease.release())
  await clock.drain()
  return result
}

/** The bidirectional protocol with programs that repeat, and that know a repetition. */
const CONFIRMED = {
  port: {
    bidirectional: true,
    ackTimeout: 400,
    attempts: 20,
    repeatUnanswered: true,
    priority: 'both',
    repeats: 'drop'
  },
  peer: { protocol: 'bidirectional', ackTimeout: 1500, retries: 50, timer0: 160 }
}

/**
 * Free messages, kept apart by silence: what stops is given up by both sides before the next one. timer0 of the module: byte times of 12 bits (12.5 ms).
 */
const APART = { port: { gap: 20 }, peer: { timer0: 40 }, pause: 60 }

/** The same without any silence: a damaged end code glues two messages together, and nobody can tell. */
const CLOSE = {}

const WEAR = { damaged: 0.005, lost: 0.005 }

/**
 * Free messages that are kept apart, eight characters and the end code, by theory: `hit` anywhere, which leaves another text (the module's program takes
 * what its timer 0 ends); of these `seen` because the end code is hit, `unseen` because only the text is.
 * @param {number} count
 */
const freeTheory = count => {
  const whole = bytes => (1 - WEAR.damaged - WEAR.lost) ** bytes
  const end = 1 - whole(2)
  return { hit: count * (1 - whole(10)), seen: count * end, unseen: count * (1 - end) * (1 - whole(8)) }
}

module.exports = { APART, CLOSE, CONFIRMED, WEAR, c24Messages, freeTheory }
