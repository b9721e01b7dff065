'use strict'
const assert = require('node:assert/strict')
const { createLine, serveOnTcp } = require('../../lib/sim')
const { testHandler } = require('../../nodes/test-read')

/** The Test of the dialogs, without a browser and without Node-RED: what is asked, and what it answers. */

/** Nothing is deployed. */
const RED = { nodes: { getNode: () => null, eachNode: () => {} } }

/** @param {string} type @param {any} body @returns {Promise<{ status: number, json: any }>} */
const post = (type, body) =>
  new Promise(resolve => {
    let status = 200
    const response = {
      status: code => ((status = code), response),
      json: answer => resolve({ status, json: JSON.parse(JSON.stringify(answer)) })
    }
    testHandler(RED, type)({ body }, response)
  })

describe('Test of a regulator', () => {
  /** @type {any} */
  let server
  before(async () => {
    const stations = [
      { device: 'chino', station: 11, values: [{ at: '400005', as: 'uint16', value: 77 }], heating: false },
      { device: 'chino', station: 12, tables: { hr: ['400101..400110'] }, heating: false }
    ]
    const { wire } = createLine({ stations, quiet: true, baudRate: 115200 })
    server = await serveOnTcp({ wire })
  })
  after(() => server.close())

  const line = more => ({
    transport: 'tcp',
    host: '127.0.0.1',
    port: server.port,
    baudRate: 115200,
    latenessBound: 1,
    ...more
  })
  const regulator = more => ({ line: 'line', station: '11', timeout: '150', ...more })
  const test = (more, own) => post('chino-config', { plc: regulator(more), line: line(own) })

  it('one read of hr0, and the sheet', async () => {
    const { status, json } = await test()
    const { ms, rows, ...answer } = json
    assert.deepEqual([status, answer], [200, { ok: true, station: 11, item: 'hr0', value: 0, cause: null }])
    assert.ok(ms >= 0 && ms < 150, ms)
    assert.deepEqual(
      rows.filter(({ id }) => ['driver', 'protocol', 'port'].includes(id)).map(({ value, result }) => [value, result]),
      [
        [`127.0.0.1:${server.port}`, 'ok'],
        ['CHINO thyristor regulator (MODBUS)', 'ok'],
        ['MODBUS RTU', 'ok']
      ]
    )
  })

  it('the first tag of the table that can be used, with its scale', async () => {
    const tags = [
      { name: 'bad', address: 'M0' },
      { name: 'output', address: '400005', scale: 0.1, unit: '%' }
    ]
    const { json } = await test({ tags })
    assert.deepEqual([json.ok, json.item, json.value], [true, 'output', 7.7])
  })

  it('a regulator that has other registers is connected all the same', async () => {
    const { json } = await test({ station: '12' })
    assert.deepEqual([json.ok, json.item, json.value], [true, 'hr0', null])
    assert.equal(json.rows.find(({ id }) => id === 'addressRange').result, 'open')
  })

  it('reached, but without the address of the tag', async () => {
    const { json } = await test({ station: '12', tags: [{ name: 'u', address: '400001' }] })
    assert.deepEqual([json.ok, json.reached, json.error.code], [false, true, 'MODBUS_ILLEGAL_ADDRESS'])
    assert.equal(json.cause.code, 'WRONG_ADDRESS')
    assert.equal(json.error.details.address, 'u')
  })

  it('a station that is not there: the likely cause', async () => {
    const { json } = await test({ station: '13' })
    assert.deepEqual([json.ok, json.reached, json.error.code], [false, false, 'TIMEOUT'])
    assert.equal(json.cause.code, 'SERVER_SILENT')
    assert.match(json.cause.remedy, /\.$/)
    assert.deepEqual(json.error.details, {
      station: 13,
      timeout: 150,
      address: 'hr0',
      path: `127.0.0.1:${server.port}`
    })
  })

  it('the other mode, on request', async () => {
    const body = { plc: regulator({ protocol: 'ascii' }), line: line() }
    assert.equal((await post('chino-config', body)).json.cause.code, 'SERVER_SILENT')
    const { json } = await post('chino-config', { ...body, tryOtherModes: true })
    assert.equal(json.cause.code, 'OTHER_MODE')
  })

  it('simulated: RTU and ASCII', async () => {
    for (const protocol of ['rtu', 'ascii']) {
      const body = { plc: regulator({ protocol }), line: { transport: 'simulated' } }
      assert.equal((await post('chino-config', body)).json.ok, true, protocol)
    }
  })

  for (const [what, more, own] of [
    ['RTU on 7 data bits', {}, { dataBits: '7' }],
    ['a station that no regulator has', { station: '248' }, {}],
    ['a broadcast', { station: '0', broadcast: true }, {}],
    ['an unknown protocol', { protocol: 'tcp' }, {}],
    ['a port that is not in the list', {}, { transport: 'serial', path: '/dev/tty-nowhere' }]
  ]) {
    it(`${what}: 400 and an error in JSON`, async () => {
      const { status, json } = await test(more, own)
      assert.deepEqual([status, json.ok], [400, false])
      assert.match(json.error.code, /^[A-Z_]+$/)
    })
  }
})

describe('Test of an NX PLC', () => {
  /** @type {any} */
  let server
  before(async () => {
    const { wire } = createLine({ stations: [{ station: 1, steps: 4 }], quiet: true, baudRate: 115200 })
    server = await serveOnTcp({ wire })
  })
  after(() => server.close())

  const test = more =>
    post('nx-config', {
      plc: { line: 'line', station: '1', timeout: '150', ...more },
      line: { transport: 'tcp', host: '127.0.0.1', port: server.port, baudRate: 115200, latenessBound: 1, gap: 0.5 }
    })

  it('with the right number of steps, and a gap with a fraction', async () => {
    const { json } = await test({ steps: '4' })
    assert.deepEqual([json.ok, json.item, json.value, json.cause], [true, 'M0', 0, null])
  })

  it('with the other one: reached, and what to set', async () => {
    const { json } = await test({ steps: '2' })
    assert.deepEqual([json.ok, json.reached, json.cause.code], [false, true, 'WRONG_STEPS'])
    assert.match(json.cause.remedy, /to 4/)
  })
})
