'use strict'

/**
 * Node-RED and a plant with faults of all kinds, in real time: nothing may be wrong, everything comes back by itself, and the memory does not grow.
 * Run by `npm run endurance -- hour`, and shortly by test/system.
 */

const { createRandom } = require('../../lib/sim')
const { LISTENERS, NAMES, flowOf, startPlant } = require('./fault-plant.js')
const { startNodeRed, until } = require('./node-red.js')
const { slopeOf } = require('./slope.js')

/** Of every hundred answers eight suffer something. */
const RATES = [
  ['late', 0.01],
  ['crc', 0.01],
  ['truncated', 0.01],
  ['duplicated', 0.01],
  ['foreign', 0.01],
  ['before', 0.005],
  ['after', 0.005],
  ['silent', 0.005],
  ['lost', 0.005],
  ['merged', 0.005],
  ['error', 0.005]
].map(([kind, rate]) => ({ kind, rate }))

/** A value may be so old (ms) when it is judged here: a stopped process, its web socket. */
const OLD = 8000
const WARM = 10 // minutes
/** Code that V8 compiles and optimises for hours would look like a leak of 5 MB an hour: so it compiles each function once, and for good. */
const FLAGS = ['--no-opt', '--no-sparkplug', '--no-flush-bytecode', '--no-lazy-feedback-allocation']
const HEAP = 1e6 // bytes an hour that are not called a slope

const wait = ms => new Promise(resolve => setTimeout(resolve, ms))

/** What happens to the plant: each ends by itself. `ms`: how long it lasts, [least, most]. */
const EVENTS = {
  unplug: {
    ms: [100, 12000],
    run: async ({ plant, ms }) => {
      for (const pty of [plant.pty, plant.listening.pty]) pty.unplug()
      await wait(ms)
      for (const pty of [plant.pty, plant.listening.pty]) pty.replug()
    }
  },
  drop: {
    ms: [0, 0],
    run: async ({ plant }) => {
      plant.proxy.drop()
      plant.listening.tcp.drop()
    }
  },
  halfOpen: { ms: [0, 0], run: async ({ plant }) => plant.proxy.halfOpen() },
  deaf: {
    ms: [1000, 10000],
    run: async ({ plant, ms }) => {
      plant.proxy.deaf(true)
      await wait(ms)
      plant.proxy.deaf(false)
    }
  },
  restart: {
    ms: [100, 8000],
    run: async ({ plant, ms }) => {
      await plant.proxy.stop()
      await wait(ms)
      await plant.proxy.start()
    }
  },
  dead: {
    ms: [2000, 40000],
    run: async ({ plant, ms }) => {
      const { wire } = plant.lines.serial
      wire.setOff(11, true)
      await wait(ms)
      wire.setOff(11, false)
    }
  },
  noise: {
    ms: [200, 3000],
    run: async ({ plant, random, ms }) => {
      const end = performance.now() + ms
      while (performance.now() < end) {
        for (const { wire } of Object.values(plant.lines)) wire.noise(random.bytes(random.integer(1, 60)))
        await wait(random.integer(5, 100))
      }
    }
  },
  stopped: {
    ms: [50, 4000],
    run: async ({ red, ms }) => {
      red.child.kill('SIGSTOP')
      await wait(ms)
      red.child.kill('SIGCONT')
    }
  },
  deploy: {
    ms: [0, 0],
    run: async ({ red, plant, random }) => {
      const type = random.pick(['full', 'nodes', 'flows', 'reload'])
      await red.deploy(flowOf(plant.settings, { turn: random.integer(0, 7) }), type)
    }
  }
}

/** What the debug nodes show: every value is judged, and when each of them last said something is remembered. */
function createJudge(red, plant) {
  const seen = Object.fromEntries([...NAMES, ...LISTENERS].map(name => [name, { count: 0, at: performance.now() }]))
  const wrong = []
  const told = {}
  const longest = Object.fromEntries(Object.keys(seen).map(name => [name, 0]))
  const look = () => {
    for (const { id, value } of red.debug.splice(0)) {
      // warnings of the other nodes stand in the sidebar as well
      const name = id?.startsWith('debug-') ? id.slice(6) : ''
      if (name === 'events') told[value.event] = (told[value.event] ?? 0) + 1
      const entry = seen[name]
      if (!entry) continue
      const now = performance.now()
      longest[name] = Math.max(longest[name], Math.round((now - entry.at) / 1000))
      Object.assign(entry, { count: entry.count + 1, at: now })
      const words = NAMES.includes(name) ? Object.values(value)[0] : null
      if (words && !plant.isHeld(name, words, OLD)) wrong.push({ name, words, at: new Date().toISOString() })
    }
  }
  const timer = setInterval(look, 100)
  return {
    wrong,
    seen,
    told,
    counts: () => Object.fromEntries(Object.entries(seen).map(([name, { count }]) => [name, count])),
    /** The longest time (s) that each of them was silent. */
    longest,
    stop: () => clearInterval(timer)
  }
}

/** One fault after the other, at random, until it is stopped. */
function startEvents({ red, plant, random, rest }) {
  const counts = Object.fromEntries(Object.keys(EVENTS).map(name => [name, 0]))
  let stopped = false
  const pause = async ms => {
    const end = performance.now() + ms
    while (!stopped && performance.now() < end) await wait(100)
  }
  const done = (async () => {
    while (!stopped) {
      await pause(random.integer(...rest))
      if (stopped) return
      const name = random.pick(Object.keys(EVENTS))
      const { ms, run } = EVENTS[name]
      await run({ red, plant, random, ms: random.integer(ms[0], ms[1]) })
      counts[name]++
    }
  })()
  // a failure is told at the end, not as a rejection that nobody waits for
  done.catch(() => {})
  return {
    counts,
    stop: () => {
      stopped = true
      return done
    }
  }
}

const sampleOf = async (red, minute) => {
  const { resources, descriptors, listeners, heap, external, rss } = await red.count()
  const handles = Object.values(resources).reduce((sum, number) => sum + number, 0)
  return { minute, heap, external, rss, descriptors: descriptors.length, handles, listeners }
}

/**
 * Growth per hour, in bytes, of what a garbage collection leaves; the first minutes do not count.
 * @param {{ minute: number, heap: number, external: number, rss: number }[]} samples
 */
function growthOf(samples) {
  const last = samples.at(-1)?.minute ?? 0
  const late = samples.filter(({ minute }) => minute >= Math.min(WARM, last / 3))
  const slope = read => {
    const found = slopeOf(late.map(each => [each.minute / 60, read(each)]))
    return { perHour: Math.round(found.slope), error: Math.round(found.error) }
  }
  const memory = slope(({ heap, external }) => heap + external)
  const grows = memory.perHour > HEAP && memory.perHour > 2 * memory.error
  return { samples: late.length, memory, rss: slope(({ rss }) => rss), descriptors: descriptorsOf(late), grows }
}

const descriptorsOf = samples => {
  const counts = samples.map(({ descriptors }) => descriptors)
  return { least: Math.min(...counts), most: Math.max(...counts) }
}

/** All devices have spoken since now. */
const allSpeak = judge => {
  const from = performance.now()
  return until(() => Object.values(judge.seen).every(({ at }) => at > from), {
    what: () => `all devices: ${JSON.stringify(judge.seen)}`,
    patience: 30000
  })
}

/**
 * @param {{ minutes: number, seed?: number, every?: number, rest?: [number, number], tell?: (line: string) => void }} options every: ms between two
 *   samples; rest: ms between two faults
 * @returns {Promise<any>} minutes, counts of values and faults, wrong values, longest silence (s), recovered (ms after the last fault), growth
 */
async function faultHour({ minutes, seed = 1, every = 60000, rest = [3000, 15000], tell = _line => {} }) {
  const random = createRandom(seed)
  const plant = await startPlant({ rates: RATES, seed })
  const red = await startNodeRed({ probe: true, flags: FLAGS, flow: flowOf(plant.settings) }).catch(async error => {
    await plant.close()
    throw error
  })
  const judge = createJudge(red, plant)
  try {
    await allSpeak(judge)
    const start = performance.now()
    const events = startEvents({ red, plant, random, rest })
    const samples = []
    const sample = async () => {
      samples.push(await sampleOf(red, (performance.now() - start) / 60000))
      tell(
        JSON.stringify({ ...samples.at(-1), wrong: judge.wrong.length, longest: judge.longest, events: events.counts })
      )
    }
    await sample()
    while (performance.now() - start < minutes * 60000) {
      await wait(every)
      await sample()
    }
    await events.stop()
    const ended = performance.now()
    await allSpeak(judge)
    const recovered = Math.round(performance.now() - ended)
    const ownFaults = Object.values(plant.lines).map(({ faults }) => faults.counts)
    return {
      ...{
        minutes,
        seed,
        values: judge.counts(),
        events: events.counts,
        told: judge.told,
        answers: ownFaults,
        wrong: judge.wrong
      },
      ...{ longest: judge.longest, recovered, growth: growthOf(samples), ended: await red.stop() }
    }
  } finally {
    judge.stop()
    if (red.child.exitCode === null) await red.stop()
    await plant.close()
  }
}

module.exports = { RATES, faultHour, growthOf }
