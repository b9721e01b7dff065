'use strict'

/**
 * Acknowledged lines both ways between an INCON link and a simulated controller, on a line that damages and loses bytes and on which both may send at once;
 * either side may be switched off and on. Every line says which one it is, so that what was lost, doubled, wrong or out of order can be counted.
 */

const { createInconLink, createPool } = require('../../lib')
const { createInconController, createRandom, createVirtualClock, createWire } = require('../../lib/sim')

const WEAR = { damaged: 0.005, lost: 0.005 }
const PART = 250

const textOf = (way, n) => `${way} ${n} [${(n * 7919) % 9973}]`

/** What came, compared with what was sent. `silently`: the sender was told that it is there, and it is not. */
const verdict = (way, { got, outcomes }) => {
  const seen = new Map()
  const result = { came: got.length, lost: 0, silently: 0, doubled: 0, wrong: 0, disorder: 0 }
  let last = -1
  for (const text of got) {
    const n = Number(/ (\d+) /.exec(text)?.[1])
    if (text !== textOf(way, n)) result.wrong++
    else {
      if (n < last) result.disorder++
      last = n
      seen.set(n, (seen.get(n) ?? 0) + 1)
    }
  }
  result.doubled = [...seen.values()].filter(times => times > 1).length
  outcomes.forEach(({ outcome }, n) => {
    if (seen.has(n)) return
    result.lost++
    if (outcome === 'confirmed') result.silently++
  })
  return result
}

const tally = outcomes =>
  outcomes.reduce((all, { outcome }) => ({ ...all, [outcome]: (all[outcome] ?? 0) + 1 }), /** @type {any} */ ({}))

/** Our side, which can be started anew: a new pool knows nothing of before. */
const createOurs = ({ clock, wire, link, random }) => {
  const ours = {
    got: /** @type {string[]} */ ([]),
    damaged: 0,
    device: /** @type {any} */ (null),
    close: async () => {}
  }
  const open = () => {
    const pool = createPool({ clock, random: () => random.next() })
    const settings = { transport: 'simulated', path: 'sim', wire, baudRate: 9600, echo: 'off', queueLimit: PART }
    const lease = pool.open(settings, { id: 'a', name: 'bench' })
    const device = createInconLink({
      ...{ lease, clock, random: () => random.next(), checked: true, acknowledge: true },
      ...link
    })
    device.listen(({ value }) => ours.got.push(value))
    ours.device = device
    ours.close = () => {
      device.close()
      return lease.release()
    }
  }
  open()
  return Object.assign(ours, {
    restart() {
      ours.close()
      open()
    }
  })
}

/**
 * @param {{ count: number, seed?: number, wear?: any, link?: Record<string, any>, sim?: Record<string, any>, restarts?: number, wire?: any }} options
 *   count: lines each way; restarts: ms from one start of either side to the next, at random (0: none)
 */
const inconMessages = async ({ count, seed = 1, wear = WEAR, link = {}, sim = {}, wire: own = {}, restarts = 0 }) => {
  const clock = createVirtualClock()
  const random = createRandom(seed)
  const wire = createWire({ clock, baudRate: 9600, chunk: 8, random: random.fork(), ...own })
  const controller = createInconController({
    ...{ clock, scan: 10, keep: Infinity, acknowledge: true, random: random.fork() },
    ...sim
  })
  wire.add(controller)
  const ours = createOurs({ clock, wire, link: { scan: 10, ...link }, random: random.fork() })
  // both begin on a line without damage: what a start may cost is another matter
  await clock.advance(1000)
  wire.setWear(wear)
  const dice = random.fork()
  let timer = null
  const switchOff = () => {
    if (dice.chance(0.5)) controller.restart()
    else ours.restart()
    timer = clock.setTimer(switchOff, dice.integer(1, 2 * restarts))
  }
  if (restarts > 0) timer = clock.setTimer(switchOff, restarts)
  // a controller that is switched off forgets what it has to say: so it says one thing after the other then
  let said = 0
  const sayOne = () => {
    controller.say(textOf('of', said++))
    if (said < count) clock.setTimer(sayOne, 500)
  }
  if (restarts > 0) sayOne()
  const outcomes = []
  for (let from = 0; from < count; from += PART) {
    const size = Math.min(PART, count - from)
    for (let n = 0; n < size && restarts === 0; n++) controller.say(textOf('of', from + n))
    const sent = Array.from({ length: size }, async (_, n) => {
      // a start ends all that waits; here it is given to the new one instead
      for (;;) {
        const outcome = await ours.device.send(textOf('to', from + n))
        if (outcome.outcome !== 'failed') return outcome
        await new Promise(resolve => clock.setTimer(() => resolve(undefined), 10 + n))
      }
    })
    outcomes.push(...(await clock.run(Promise.all(sent))))
  }
  clock.clearTimer(timer)
  await clock.drain()
  const messages = controller.messages.filter(({ valid }) => valid).map(({ text }) => text)
  const ends = new Map(controller.outcomes.map(each => [Number(/ (\d+) /.exec(each.text)?.[1]), each]))
  const theirs = Array.from({ length: count }, (_, n) => ends.get(n) ?? { outcome: 'dropped' })
  const result = {
    outcomes: tally(outcomes),
    theirs: tally(theirs),
    toThem: verdict('to', { got: messages, outcomes }),
    toUs: verdict('of', { got: ours.got, outcomes: theirs }),
    stats: ours.device.stats,
    counts: { ...controller.counts },
    collisions: wire.counts.collisions,
    hours: clock.now() / 3.6e6
  }
  controller.close()
  await clock.run(ours.close())
  await clock.drain()
  return { ...result, pending: clock.pending() }
}

const xorOf = letters => [...letters].reduce((sum, letter) => sum ^ letter.charCodeAt(0), 0)
const DIGITS = '0123456789ABCDEF'

/** Repeated until it passes: how many of `count` lines pass with another text. Our own XOR, our own damage. */
const wrongByTheory = (way, count, rounds = 1) => {
  const random = createRandom(99)
  const wear = letter => {
    const share = random.next()
    if (share < WEAR.lost) return ''
    return share < WEAR.lost + WEAR.damaged
      ? String.fromCharCode(letter.charCodeAt(0) ^ random.integer(1, 255))
      : letter
  }
  const passes = (body, line) => {
    const worn = [...line].map(wear).join('')
    if (worn === line) return 'right'
    const [, text, digits] = /^(.*)\*([\dA-Fa-f]{2})$/s.exec(worn) ?? []
    if (text === undefined || xorOf(text) !== parseInt(digits, 16)) return ''
    // another number is not due
    return text.startsWith(body.slice(0, 4)) ? 'wrong' : ''
  }
  let wrong = 0
  for (let n = 0; n < count * rounds; n++) {
    const body = `#${String((n % 99) + 1).padStart(2, '0')} ${textOf(way, n % count)}`
    const check = xorOf(body)
    let end = ''
    while (!end) end = passes(body, `${body}*${DIGITS[check >> 4]}${DIGITS[check & 15]}`)
    if (end === 'wrong') wrong++
  }
  return wrong / rounds
}

/** So many attempts that none of 10,000 lines is given up. */
const PATIENT = { link: { attempts: 40 }, sim: { attempts: 40 } }

module.exports = { PATIENT, WEAR, inconMessages, wrongByTheory }
