'use strict'

/** A C24 that reads slowly, behind a real serial port (a pty), with DC1/DC3: by us, and by the driver's XON/XOFF. */

const assert = require('node:assert/strict')
const fs = require('node:fs')
const os = require('node:os')
const path = require('node:path')
const { createC24Port, createPool } = require('../../lib')
const { createMelsecC24, createRealClock, createWire, serveOnPty } = require('../../lib/sim')
const { until } = require('../support/node-red.js')

const BAUD = 230400
const BYTES = 100000
const MESSAGES = 200
const OS_AREA = 8448
/**
 * Bytes between the port and the wire, at most. A UART's driver takes no more than a little; the kernel takes all for a pty at once, and where the
 * processors are busy it may lie there for half a second: the C24's stop would come too late for it, as on no serial port.
 */
const AHEAD = 1000

/** Numbered messages, 500 bytes with their end: 100 kB in all. */
const messages = Array.from({ length: MESSAGES }, (_, n) => `${n};`.padEnd(BYTES / MESSAGES - 2, 'abcdefghij'))

/** @param {{ port: any, heard: () => number }} options heard: bytes that have come over the wire */
const sendAll = async ({ port, heard }) => {
  const outcomes = []
  let given = 0
  for (const text of messages) {
    await until(() => given - heard() < AHEAD, { what: 'bytes to leave', every: 1 })
    outcomes.push(port.send(text))
    given += BYTES / MESSAGES
  }
  return Promise.all(outcomes)
}

describe('system: a C24 on a serial port', function () {
  this.timeout(60000)
  let folder
  beforeEach(() => (folder = fs.mkdtempSync(path.join(os.tmpdir(), 'c24-'))))
  afterEach(() => fs.rmSync(folder, { recursive: true, force: true }))

  const run = async ({ flow, line = {}, port: own = {} }) => {
    const clock = createRealClock()
    const link = path.join(folder, 'port')
    const taken = []
    const c24 = createMelsecC24({
      ...{ clock, baudRate: BAUD, flow, byteRate: 18000, history: 0 },
      // a pty has no UART: what a program writes while the stop is on its way is more than 64 bytes at this speed
      ...{ stopFree: 2048, goFree: 3000 },
      speaks: { every: 50, value: n => `STATE ${n}` },
      onMessage: message => taken.push(message.bytes.toString('latin1'))
    })
    const wire = createWire({ clock, baudRate: BAUD, duplex: 'full' })
    wire.add(c24)
    const server = serveOnPty({ wire, link })
    const pool = createPool()
    const lease = pool.open({ transport: 'serial', path: link, baudRate: BAUD, ...line }, { id: 'a', name: 'c24' })
    const port = createC24Port({ lease, room: 2048, stallLimit: 20000, ...own })
    const heard = []
    // the last one may be on its way when the port is closed
    port.listen(({ value, reason }) => reason !== 'closed' && heard.push(value))
    try {
      const outcomes = await sendAll({ port, heard: () => c24.counts.bytesIn })
      await until(() => c24.counts.bytesTaken + c24.counts.discarded >= BYTES - 2 * MESSAGES, { what: 'the rest' })
      return { outcomes, taken, heard, counts: c24.counts, stats: lease.line.stats(), sioError: c24.sioError() }
    } finally {
      c24.close()
      port.close()
      await lease.release()
      server.close()
    }
  }

  const check = ({ outcomes, taken, heard, counts, sioError }) => {
    assert.deepEqual(new Set(outcomes.map(({ outcome }) => outcome)), new Set(['sent']))
    assert.equal(counts.bytesIn >= BYTES, true)
    const wrong = taken.findIndex((text, n) => text !== messages[n])
    assert.deepEqual([taken.length, wrong], [MESSAGES, -1], JSON.stringify(counts))
    assert.deepEqual([counts.discarded, sioError], [0, false])
    assert.ok(
      counts.stops > 0 && counts.mostHeld > OS_AREA - 2048 && counts.mostHeld <= OS_AREA,
      JSON.stringify(counts)
    )
    heard.forEach((value, n) => assert.equal(value, `STATE ${n}`))
    assert.ok(heard.length > 20)
  }

  it(`DC1/DC3 by the line: nothing is lost of ${BYTES} bytes`, async () => {
    const result = await run({ flow: 'dc', port: { flow: 'dc' } })
    check(result)
    assert.ok(result.stats.stops > 0)
  })

  it('DC1/DC3 by the driver of the port', async () => {
    check(await run({ flow: 'dc', line: { flowControl: 'xonxoff' }, port: { flow: 'driver' } }))
  })
})
