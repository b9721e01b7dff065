'use strict'

/**
 * Long runs of hostile input, for endurance.js:
 *   npm run endurance -- garbage [10] [name]   so many seconds of garbage at full rate against each protocol and framing (or those whose name
 *                                              contains this), over TCP and a pseudo-terminal; memory +< 10 MB, lag of the event loop p99 < 20 ms
 *   npm run endurance -- random [1000000]      so many random inputs for everything that reads bytes or text from outside
 */

const path = require('node:path')

const support = path.join(__dirname, '..', 'test', 'support')
const print = text => process.stdout.write(`${text}\n`)

const MOST_LAG = 20 // ms
const MOST_GROWN = 10 // MB

const whole = (text, what) => {
  const number = Number(text)
  if (!Number.isInteger(number) || number < 1) throw new Error(`the number of ${what} must be a whole one, 1 or more`)
  return number
}

/** MB in use, after a collection. */
const heap = () => {
  require('node:v8').setFlagsFromString('--expose-gc')
  require('node:vm').runInNewContext('gc')()
  return Math.round(process.memoryUsage().heapUsed / 1e6)
}

const HOSTILE_RUNS = {
  /** @param {string} [count] @param {string} [name] */
  async garbage(count = '10', name = '') {
    const seconds = whole(count, 'seconds')
    const { TARGETS, flood } = require(path.join(support, 'garbage.js'))
    const failed = []
    for (const [target, { worst }] of Object.entries(TARGETS).filter(([each]) => each.includes(name))) {
      for (const transport of ['tcp', 'pty']) {
        for (const pattern of ['noise', ...worst]) {
          const run = await flood({ target, transport, pattern, seconds })
          const line = `${target}, ${transport}, ${pattern}: ${JSON.stringify(run)}`
          print(line)
          if (run.lag >= MOST_LAG || run.grown >= MOST_GROWN) failed.push(line)
        }
      }
    }
    if (failed.length) throw new Error(`too slow or too large:\n${failed.join('\n')}`)
    print(`lag p99 below ${MOST_LAG} ms and memory below +${MOST_GROWN} MB in each`)
  },

  /** @param {string} [count] @param {string} [seed] */
  async random(count = '1000000', seed = '1') {
    const options = { inputs: whole(count, 'inputs'), seed: whole(seed, 'seeds') }
    const runs = {
      protocols: () => require(path.join(support, 'protocol-random.js')).protocolRandom(options),
      texts: () => require(path.join(support, 'text-random.js')).textRandom(options),
      c24: () => require(path.join(support, 'melsec-random.js')).melsecRandom(options),
      incon: () => require(path.join(support, 'incon-random.js')).inconRandom(options)
    }
    for (const [name, run] of Object.entries(runs)) {
      const start = performance.now()
      const done = run()
      const seconds = Math.round((performance.now() - start) / 1000)
      print(`${name}: ${JSON.stringify(done)}; ${seconds} s, heap ${heap()} MB`)
    }
    print('no exception, no hang, and nothing was taken that is not sound')
  }
}

module.exports = { HOSTILE_RUNS }
