'use strict'

const assert = require('node:assert/strict')
const { createMasterWatch } = require('../../lib/device/master-watch')
const { bench } = require('./support')

describe('NX PLC: a station that answers to one master ID only', () => {
  let b
  afterEach(async () => {
    await b.close()
    assert.equal(b.clock.pending(), 0, 'a timer is left')
  })
  const start = (station, plc = {}) => {
    const events = []
    b = bench({ sim: { stations: [{ station: 1, ...station }] }, plc: { attempts: 1, ...plc } })
    b.lease.on('event', event => events.push(event))
    const read = async () => (await b.run(b.device.read(['M0'])))[0].code ?? 'good'
    return { events, read }
  }

  it('is noticed and reported once with the remedy', async () => {
    const { events, read } = start({ onlyMaster: 0xe4 })
    const codes = []
    for (let i = 0; i < 10; i++) codes.push(await read())
    // E2 and E3 unheard, E4 answered, then in turn: the next of the row, and E4 again
    const turn = ['TIMEOUT', 'good']
    assert.deepEqual(codes, ['TIMEOUT', 'TIMEOUT', 'good', ...turn, ...turn, ...turn, 'TIMEOUT'])
    const found = events.filter(({ event }) => event === 'fixedMasterId')
    assert.equal(found.length, 1)
    assert.deepEqual([found[0].station, found[0].id], [1, 0xe4])
    assert.match(found[0].remedy, /to 0xE4 \(228\) alone/)
    assert.ok(Number.isFinite(found[0].since))
  })

  it('its last ID is not tried again while an answer to it may still come', async () => {
    const { events, read } = start({}, { demoteAfter: 0 })
    const masters = () =>
      b.lease.line.trace().flatMap(({ dir, bytes }) => (dir === 'out' ? [parseInt(bytes.slice(2, 4), 16)] : []))
    assert.equal(await read(), 'good')
    b.wire.setOff(1, true)
    for (let i = 0; i < 4; i++) await read()
    // E2 answered; E3 silent, E2 tried and silent, then on without it
    assert.deepEqual(masters(), [0xe2, 0xe3, 0xe2, 0xe4, 0xe5])
    assert.deepEqual(events, [])
  })

  it('is not suspected because it was switched off for a while', async () => {
    const { events, read } = start({}, { demoteAfter: 0 })
    const codes = [await read()]
    for (let outage = 0; outage < 3; outage++) {
      b.wire.setOff(1, true)
      for (let i = 0; i <= outage; i++) codes.push(await read())
      b.wire.setOff(1, false)
      for (let i = 0; i < 3; i++) codes.push(await read())
    }
    assert.ok(codes.includes('TIMEOUT'))
    assert.deepEqual(codes.slice(-3), ['good', 'good', 'good'])
    assert.deepEqual(events, [])
  })

  it('one ID that was set is not advised again, however lossy the line', async () => {
    const { events, read } = start({}, { masterIds: 'E4' })
    for (let i = 0; i < 8; i++) {
      assert.equal(await read(), 'good')
      b.faults.once('silent')
      assert.equal(await read(), 'TIMEOUT')
    }
    assert.deepEqual(events, [])
  })
})

describe('the series of proofs', () => {
  const E2 = 0xe2
  const E3 = 0xe3
  const watched = () => {
    const found = []
    const watch = createMasterWatch({ memory: {}, found: id => found.push(id) })
    const row = (id, code) => watch.note({ id, trial: false, code })
    /** Silence to the row, then an answer to the ID of the last answer, if that is tried. */
    const proof = () => {
      row(E3, 'TIMEOUT')
      const id = watch.trial()
      if (id !== undefined) watch.note({ id, trial: true })
    }
    return { found, watch, row, proof }
  }

  it('needs three', () => {
    const { found, row, proof } = watched()
    row(E2)
    proof()
    proof()
    assert.deepEqual(found, [])
    proof()
    assert.deepEqual(found, [E2])
    proof()
    assert.deepEqual(found, [E2], 'told once')
  })

  it('begins anew when another ID is answered', () => {
    const { found, row, proof } = watched()
    row(E2)
    proof()
    proof()
    row(E3)
    proof()
    assert.deepEqual(found, [])
  })

  it('goes on when the same ID is answered in its turn', () => {
    const { found, row, proof } = watched()
    row(E2)
    proof()
    proof()
    row(E2)
    proof()
    assert.deepEqual(found, [E2])
  })

  for (const code of ['TIMEOUT', 'CRC_ERROR']) {
    it(`ends when the trial fails with ${code}: the ID rests until it is answered in its turn`, () => {
      const { found, watch, row, proof } = watched()
      row(E2)
      proof()
      proof()
      row(E3, 'TIMEOUT')
      watch.note({ id: watch.trial(), trial: true, code })
      row(E3, 'TIMEOUT')
      assert.equal(watch.trial(), undefined)
      row(E2)
      proof()
      assert.deepEqual(found, [])
    })
  }

  it('nothing is tried before the first answer, nor after one', () => {
    const { watch, row } = watched()
    row(E3, 'TIMEOUT')
    assert.equal(watch.trial(), undefined)
    row(E2)
    assert.equal(watch.trial(), undefined)
  })
})
