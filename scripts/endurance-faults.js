'use strict'

/**
 * Long runs with faults on real ports and in real time, for scripts/endurance.js:
 *   replugs [100]  so many replugs at any moment of the traffic of two stations; values within 2 s and the bound, no descriptor left
 *   dead [10]      so many minutes of ten stations of which one is dead, NX and MODBUS; what it costs the others
 *   halfopen [10]  so often each way in which a TCP connection can go; a new one within 2 × timeout × attempts
 *   hour [60]      so many minutes of Node-RED and a plant with faults of all kinds; nothing wrong, all comes back, no slope of memory
 *   slope FILE     the slope of memory from what `hour` has printed into a file, also while it runs
 */

const fs = require('node:fs')
const path = require('node:path')

const support = name => require(path.join(__dirname, '..', 'test', 'support', name))
const print = text => process.stdout.write(`${text}\n`)

const whole = (text, what) => {
  const number = Number(text)
  if (!Number.isInteger(number) || number < 1) throw new Error(`the number of ${what} must be a whole one, 1 or more`)
  return number
}

/** The lines of a log that are samples of `hour`. */
const samplesOf = text =>
  text
    .split('\n')
    .filter(line => line.startsWith('{"minute":'))
    .map(line => JSON.parse(line))

const FAULT_RUNS = {
  /** @param {string} [count] @param {string} [seed] */
  async replugs(count = '100', seed = '1') {
    const rounds = whole(count, 'replugs')
    // one is longer than the shorter back-offs together
    const outage = rounds > 20 ? [10, 3000] : [10, 500]
    const done = await support('replugs.js').replugs({
      ...{ rounds, outage, outages: [4300], seed: whole(seed, 'the seed') },
      tell: print
    })
    print(JSON.stringify(done))
    if (done.late > 0 || done.wrong > 0) throw new Error(`${done.late} came back too late, ${done.wrong} wrong values`)
  },

  /** @param {string} [minutes] */
  async dead(minutes = '10') {
    const seconds = 60 * whole(minutes, 'minutes')
    for (const device of ['nx', 'chino']) {
      for (const answersFirst of [true, false]) {
        const done = await support('dead-station.js').deadStation({ seconds, device, answersFirst, tell: print })
        print(`${device}, ${answersFirst ? 'dies' : 'was never there'}: ${JSON.stringify(done)}`)
        const { cost, wrong } = done
        if (cost > 0.05 || wrong > 0) throw new Error(`${cost} of the line's time, ${wrong} wrong values`)
      }
    }
  },

  /** @param {string} [count] */
  async halfopen(count = '10') {
    const { halfOpen, slowOf } = support('half-open.js')
    const slow = slowOf(await halfOpen({ rounds: whole(count, 'rounds'), tell: print }), 1000)
    if (slow.length > 0) throw new Error(slow.join('\n'))
  },

  /** @param {string} [minutes] @param {string} [seed] */
  async hour(minutes = '60', seed = '1') {
    const run = await support('fault-hour.js').faultHour({
      minutes: whole(minutes, 'minutes'),
      seed: whole(seed, 'the seed'),
      tell: print
    })
    const { wrong, growth, ended, ...done } = run
    print(JSON.stringify(done))
    print(JSON.stringify(growth))
    for (const each of wrong.slice(0, 20)) print(JSON.stringify(each))
    if (wrong.length > 0) throw new Error(`${wrong.length} wrong values`)
    if (growth.grows) throw new Error('the memory grows')
    if (ended !== 'ended') throw new Error(`Node-RED was ${ended}`)
    print('no value was wrong, everything came back, the memory does not grow')
  },

  /** @param {string} [file] */
  async slope(file) {
    if (!file) throw new Error('slope needs the file that hour has printed into')
    print(JSON.stringify(support('fault-hour.js').growthOf(samplesOf(fs.readFileSync(file, 'utf8'))), null, 1))
  }
}

module.exports = { FAULT_RUNS }
