'use strict'

/**
 * Long runs with faults on real ports and in real time, for scripts/endurance.js:
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
