'use strict'

/**
 * A quiet mocha reporter: failures in full, slow tests by name, and as the last line `N passed, N failed`
 * (`, N skipped` if any), which machines read. Works in mocha's parallel mode too.
 */

const { reporters, Runner } = require('mocha')
const { EVENT_TEST_PASS, EVENT_TEST_FAIL, EVENT_TEST_PENDING, EVENT_RUN_END } = Runner.constants

const SLOW_MS = 2000

const title = test => test.titlePath().join(' > ')

module.exports = class Closing extends reporters.Base {
  constructor(runner, options) {
    super(runner, options)
    const count = { passed: 0, failed: 0, skipped: 0 }
    const slow = []
    const started = Date.now()

    runner.on(EVENT_TEST_PASS, test => {
      count.passed++
      if (test.duration > SLOW_MS) slow.push(test)
    })
    runner.on(EVENT_TEST_FAIL, (test, error) => {
      count.failed++
      console.log(`FAILED  ${title(test)}\n        ${String(error?.message).split('\n')[0]}`)
    })
    runner.on(EVENT_TEST_PENDING, test => {
      count.skipped++
      console.log(`skipped ${title(test)}`)
    })
    runner.once(EVENT_RUN_END, () => {
      if (this.failures.length) reporters.Base.list(this.failures)
      slow.sort((a, b) => b.duration - a.duration)
      for (const test of slow.slice(0, 5)) console.log(`slow    ${test.duration} ms  ${title(test)}`)
      const skipped = count.skipped ? `, ${count.skipped} skipped` : ''
      console.log(`\n${((Date.now() - started) / 1000).toFixed(1)} s`)
      console.log(`${count.passed} passed, ${count.failed} failed${skipped}`)
    })
  }
}
