'use strict'

const assert = require('node:assert')
const { runFlow } = require('./c24-flow')

const OS_AREA = 8448
const BYTES = 100000

describe('C24: a program that reads slowly', function () {
  this.timeout(20000)

  const arrives = run => {
    const { sent, outcomes, lost, wrong, counts, sioError, said, spoken } = run
    assert.deepStrictEqual(
      { lost, wrong, outcomes, sioError },
      { lost: 0, wrong: 0, outcomes: { sent }, sioError: false }
    )
    assert.deepStrictEqual([counts.discarded, counts.taken], [0, sent])
    assert.ok(
      counts.stops > 50 && counts.mostHeld >= OS_AREA - 64 && counts.mostHeld <= OS_AREA,
      JSON.stringify(counts)
    )
    // and the C24 was heard meanwhile
    assert.deepStrictEqual(said, { first: 'STATE 0', last: `STATE ${spoken - 1}`, count: spoken })
    assert.ok(spoken > 100)
  }

  it(`DC1/DC3: nothing is lost of ${BYTES} bytes`, async () => {
    const run = await runFlow({ flow: 'dc', bytes: BYTES })
    arrives(run)
    assert.strictEqual(run.stats.stops, run.counts.stops)
    // as fast as the program reads, but for what fills the OS area
    assert.ok(run.seconds < (BYTES - OS_AREA + 2000) / 1000, String(run.seconds))
  })
  it('the same behind an adapter that keeps what comes for 16 ms: the limit of 64 bytes is just enough', async () => {
    const run = await runFlow({ flow: 'dc', bytes: BYTES, latency: 16 })
    arrives(run)
    assert.ok(run.counts.mostHeld > OS_AREA - 16, String(run.counts.mostHeld))
  })
  it('a port that believes in more room than there is loses some, and the run sees it', async () => {
    const { lost, counts, sioError } = await runFlow({ flow: 'dc', bytes: BYTES, latency: 16, room: 200 })
    assert.ok(lost > 0 && counts.discarded > 0 && sioError)
  })
  it(`DTR on our CTS: nothing is lost of ${BYTES} bytes`, async () =>
    arrives(await runFlow({ flow: 'dtr', bytes: BYTES })))
  it('without flow control some is lost: the module says so, nobody says `confirmed`', async () => {
    const { sent, outcomes, lost, counts, sioError, stats } = await runFlow({ flow: 'none', bytes: BYTES })
    assert.deepStrictEqual(outcomes, { sent })
    assert.strictEqual(sioError, true)
    assert.ok(lost > sent / 4, `${lost} of ${sent}`)
    // what left our port, and what the program has, are the two counters to compare
    assert.strictEqual(stats.bytesOut, counts.bytesIn)
    assert.ok(
      counts.discarded > BYTES / 4 && counts.bytesTaken + counts.discarded + 2 * counts.taken >= BYTES - OS_AREA
    )
  })
})
