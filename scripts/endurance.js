'use strict'

/**
 * Long runs that are not part of every test run.
 *   npm run endurance -- redeploys [1000]    so many redeploys and reconnects in a real Node-RED; nothing may be left behind
 */

const path = require('node:path')

const support = path.join(__dirname, '..', 'test', 'support')
const print = text => process.stdout.write(`${text}\n`)

const RUNS = {
  /** @param {string} [count] */
  async redeploys(count = '1000') {
    const rounds = Number(count)
    if (!Number.isInteger(rounds) || rounds < 1)
      throw new Error('the number of redeploys must be a whole one, 1 or more')
    const { before, after, ...done } = await require(path.join(support, 'redeploys.js')).redeploys({
      rounds,
      tell: print
    })
    print(JSON.stringify(done))
    print(`before: ${JSON.stringify(before.resources)}, ${before.descriptors.length} descriptors`)
    print(`after:  ${JSON.stringify(after.resources)}, ${after.descriptors.length} descriptors`)
    print('nothing was left behind')
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
