'use strict'
const assert = require('node:assert/strict')
const fs = require('node:fs')
const os = require('node:os')
const path = require('node:path')
const { createNxLine, serveOnPty } = require('../../lib/sim')
const { helper, load, plcNode, reader, until, writer } = require('./bench')

/** The whole way once, over a virtual serial port with real frames. */
;(process.platform === 'win32' ? describe.skip : describe)('nodes on a serial port', () => {
  let folder
  let port
  let line
  before(() => helper.startServer())
  after(() => helper.stopServer())
  beforeEach(() => {
    folder = fs.mkdtempSync(path.join(os.tmpdir(), 'serial-'))
    line = createNxLine({ stations: [1], quiet: true, baudRate: 38400 })
    line.plcs[0].set('M0', 7)
    port = serveOnPty({ wire: line.wire, link: path.join(folder, 'port') })
  })
  afterEach(async () => {
    await helper.unload()
    port.close()
    fs.rmSync(folder, { recursive: true, force: true })
  })

  const serial = () => ({
    id: 'line',
    type: 'plc-line',
    transport: 'serial',
    path: path.join(folder, 'port'),
    baudRate: '38400'
  })

  it('reads, writes, and comes back by itself after the adapter was unplugged', async function () {
    this.timeout(20000)
    const { out, caught } = await load([
      serial(),
      plcNode({ access: 'write' }),
      reader({ items: ['M0'], interval: '50' }),
      writer({ target: 'K0' })
    ])
    await until(() => out.some(({ payload }) => payload.M0 === 7), 'a value')
    helper.getNode('write').receive({ payload: 99 })
    await until(() => out.some(({ write }) => write?.outcome === 'confirmed'), 'the confirmation')
    assert.equal(line.plcs[0].get('K0'), 99)

    port.unplug()
    await until(() => caught.length > 0, 'an error')
    assert.match(caught[0].error.code, /^(PORT_GONE|PORT_NOT_FOUND|LINE_DOWN|PORT_ERROR|TIMEOUT)$/)
    line.plcs[0].set('M0', 8)
    port.replug()
    await until(() => out.some(({ payload }) => payload.M0 === 8), 'the value after plugging it in', 8000)
  })

  it('a port that is not there: PORT_NOT_FOUND with its path', async () => {
    const { caught } = await load([
      { ...serial(), path: path.join(folder, 'nothing') },
      plcNode(),
      reader({ items: ['M0'], interval: '50' })
    ])
    await until(() => caught.length > 0, 'an error')
    assert.equal(caught[0].error.code, 'PORT_NOT_FOUND')
    assert.match(caught[0].error.message, /nothing/)
  })
})
