'use strict'

/**
 * Long runs that are not part of every test run.
 *   npm run endurance -- redeploys [1000]    so many redeploys and reconnects in a real Node-RED; nothing may be left behind
 *   npm run endurance -- mixed [600]         so many seconds of an NX PLC and three regulators on one paced line; no value may be wrong
 *   npm run endurance -- c24 [10]            so many MB to a simulated C24 that reads slowly, in virtual time; nothing may be lost
 *   npm run endurance -- c24messages [10000] so many messages each way on a line that damages bytes; what was lost, doubled, wrong
 *   npm run endurance -- c24random [1000000] so many random inputs for everything that reads bytes of a C24 port
 *   npm run endurance -- inconrandom [1000000] the same for lines of an INCON controller
 *   npm run endurance -- inconmessages [10000] so many acknowledged lines each way on a line that damages bytes; then with starts in between
 *   npm run endurance -- lines [600]         so many seconds of 32 saturated lines in one process; its processor, event loop and memory
 *   npm run endurance -- frames [10000000]   so many damaged answers of each protocol, by class; what is claimed must not be taken once
 *   npm run endurance -- coverage [lib/codec] which branches no test takes, and why; a folder below its limit is a failure
 *   npm run endurance -- mutation [lib/codec] changes the code at each place; fewer than 85 % of them noticed by the tests is a failure.
 *                                             A folder or a pattern of files below lib/codec or lib/line; Stryker is installed for it.
 *                                             With `again` behind it only what was not noticed the last time, and what has changed since
 * and those with faults on real ports: endurance-faults.js; with hostile input: endurance-hostile.js
 */

const path = require('node:path')
const { FAULT_RUNS } = require('./endurance-faults.js')
const { HOSTILE_RUNS } = require('./endurance-hostile.js')

const support = path.join(__dirname, '..', 'test', 'support')
const print = text => process.stdout.write(`${text}\n`)

const whole = (text, what) => {
  const number = Number(text)
  if (!Number.isInteger(number) || number < 1) throw new Error(`the number of ${what} must be a whole one, 1 or more`)
  return number
}

const RUNS = {
  ...FAULT_RUNS,
  ...HOSTILE_RUNS,

  /** @param {string} [count] */
  async redeploys(count = '1000') {
    const rounds = whole(count, 'redeploys')
    const { redeploys } = require(path.join(support, 'redeploys.js'))
    const { before, after, ...done } = await redeploys({ rounds, tell: print })
    print(JSON.stringify(done))
    print(`before: ${JSON.stringify(before.resources)}, ${before.descriptors.length} descriptors`)
    print(`after:  ${JSON.stringify(after.resources)}, ${after.descriptors.length} descriptors`)
    // slow lines: each deploy falls into an exchange, and no connection is dropped that could tear a frame
    const calm = { rounds: Math.min(rounds, 200), calm: true, baudRate: 9600 }
    const { slowest, torn, queries } = await redeploys(calm)
    print(`${calm.rounds} in the middle of exchanges: ${JSON.stringify({ slowest, torn, queries })}`)
    print('nothing was left behind')
  },

  /** @param {string} [count] */
  async mixed(count = '600') {
    const seconds = whole(count, 'seconds')
    const run = await require(path.join(support, 'mixed-line.js')).mixedLine({ seconds })
    const { wrong, failures, polls, stats, ...done } = run
    print(JSON.stringify(done))
    for (const poll of polls) print(JSON.stringify(poll))
    print(JSON.stringify(stats))
    for (const each of [...wrong, ...failures].slice(0, 20)) print(JSON.stringify(each))
    if (wrong.length || failures.length) throw new Error(`${wrong.length} wrong values, ${failures.length} failures`)
    print('no value was wrong, nothing failed')
  },

  /** @param {string} [megabytes] */
  async c24(megabytes = '10') {
    const bytes = whole(megabytes, 'megabytes') * 1e6
    const { runFlow } = require(path.join(__dirname, '..', 'test', 'simulation', 'c24-flow.js'))
    for (const flow of ['dc', 'dtr']) {
      const { lost, wrong, counts, ...run } = await runFlow({ flow, bytes, latency: 16 })
      const { sent, seconds } = run
      print(`${flow}: ${JSON.stringify({ sent, bytes: run.bytes, seconds, lost, wrong, counts })}`)
      if (lost || wrong || counts.discarded) throw new Error(`${flow}: ${lost} messages were lost`)
    }
    print('nothing was lost')
  },

  /** @param {string} [messages] */
  async c24messages(messages = '10000') {
    const count = whole(messages, 'messages')
    const { APART, CONFIRMED, WEAR, c24Messages, freeTheory } = require(
      path.join(__dirname, '..', 'test', 'simulation', 'c24-messages.js')
    )
    for (const [name, options] of Object.entries({ bidirectional: CONFIRMED, free: APART })) {
      const { outcomes, toModule, toUs } = await c24Messages({ count, wear: WEAR, ...options })
      print(`${name}: ${JSON.stringify({ outcomes, toModule, toUs })}`)
      for (const { doubled, glued } of [toModule, toUs]) {
        if (doubled || glued) throw new Error(`${name}: ${doubled} doubled, ${glued} glued together`)
      }
    }
    print(`free, by theory: ${JSON.stringify(freeTheory(count))}`)
  },

  /** @param {string} [inputs] */
  async c24random(inputs = '1000000') {
    const { melsecRandom } = require(path.join(support, 'melsec-random.js'))
    print(JSON.stringify(melsecRandom({ inputs: whole(inputs, 'inputs') })))
    print(`no exception, heap ${Math.round(process.memoryUsage().heapUsed / 1e6)} MB`)
  },

  /** @param {string} [lines] */
  async inconmessages(lines = '10000') {
    const count = whole(lines, 'lines')
    const { PATIENT, inconMessages, wrongByTheory } = require(
      path.join(__dirname, '..', 'test', 'simulation', 'incon-messages.js')
    )
    const runs = { patient: PATIENT, default: {}, starts: { restarts: 60000 } }
    for (const [name, options] of Object.entries(runs)) {
      const { outcomes, theirs, toThem, toUs } = await inconMessages({ count, ...options })
      print(`${name}: ${JSON.stringify({ outcomes, theirs, toThem, toUs })}`)
      for (const { doubled, silently, wrong } of [toThem, toUs]) {
        if (doubled || silently > wrong) throw new Error(`${name}: ${doubled} doubled, ${silently} lost silently`)
      }
    }
    print(`wrong by theory: to them ${wrongByTheory('to', count, 5)}, to us ${wrongByTheory('of', count, 5)}`)
  },

  /** @param {string} [inputs] */
  async inconrandom(inputs = '1000000') {
    const { inconRandom } = require(path.join(support, 'incon-random.js'))
    print(JSON.stringify(inconRandom({ inputs: whole(inputs, 'inputs') })))
    print(`no exception, heap ${Math.round(process.memoryUsage().heapUsed / 1e6)} MB`)
  },

  /** @param {string} [count] */
  async lines(count = '600') {
    const { manyLines } = require(path.join(__dirname, '..', 'bench', 'many-lines.js'))
    const done = await manyLines({ seconds: whole(count, 'seconds') })
    print(JSON.stringify(done))
    if (done.growth > 1) throw new Error(`the memory has grown by ${done.growth} MB`)
    print('the memory did not grow')
  },

  /** @param {string} [count] */
  async frames(count = '10000000') {
    const frames = whole(count, 'frames')
    const { damaged, unexplained } = require(path.join(support, 'damage.js'))
    const surprises = []
    for (const protocol of ['nx', 'rtu', 'ascii']) {
      const rows = damaged({ protocol, frames })
      for (const { name, expected, ...row } of rows) {
        const theory = expected === 0 ? '0 claimed' : `${expected.toFixed(1)} by theory`
        print(
          `${protocol}, ${name}: ${row.frames} frames, ${row.wrong} wrong, ${theory}, ${row.right} answers found all the same`
        )
      }
      surprises.push(...unexplained(rows).map(({ name }) => `${protocol}, ${name}`))
    }
    if (surprises.length > 0) throw new Error(`not as claimed or by theory: ${surprises.join('; ')}`)
    print('nothing that is claimed was taken, all else as by theory')
  },

  /** @param {string} [folder] */
  async coverage(folder) {
    const { failures } = await require(path.join(support, 'coverage.js')).coverage({ only: folder, tell: print })
    if (failures.length > 0) throw new Error(failures.join('\n'))
  },

  /** @param {string} [files] @param {string} [again] */
  async mutation(files, again) {
    const { failures } = await require(path.join(__dirname, '..', 'test', 'mutation', 'run.js')).mutation({
      files,
      again: again === 'again',
      tell: print
    })
    if (failures.length > 0) throw new Error(failures.join('\n'))
  }
}

async function main() {
  const [name = 'redeploys', ...args] = process.argv.slice(2)
  if (!Object.hasOwn(RUNS, name)) throw new Error(`known runs: ${Object.keys(RUNS).join(', ')}`)
  await RUNS[name](...args)
}

main().catch(error => {
  process.stderr.write(`${error.stack}\n`)
  process.exitCode = 1
})
