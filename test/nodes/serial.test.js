'use strict'
const assert = require('node:assert/strict')
const fs = require('node:fs')
const os = require('node:os')
const path = require('node:path')
const { createMelsecC24, createNxLine, createRealClock, createWire, serveOnPty } = require('../../lib/sim')
const { ON_TAB, helper, load, plcNode, reader, until, writer } = require('./bench')

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

  it('a C24: messages both ways; an unplugged adapter costs one outcome each, and all comes back by itself', async function () {
    this.timeout(20000)
    const link = path.join(folder, 'c24')
    const clock = createRealClock()
    const speaks = { every: 20, value: n => `STATE ${n}` }
    const module = createMelsecC24({ clock, baudRate: 38400, timer0: 161, speaks })
    const wire = createWire({ clock, baudRate: 38400, duplex: 'full' })
    wire.add(module)
    const c24 = serveOnPty({ wire, link })
    const node = {
      id: 'c24',
      type: 'melsec-c24',
      ...ON_TAB,
      line: 'line',
      access: 'write',
      onFailure: 'output',
      timer0: '50'
    }
    const probes = [
      { ...serial(), path: link },
      { ...node, wires: [['out'], ['written'], ['failed']] }
    ]
    const { out, written, failed } = await load(probes)
    const send = n => helper.getNode('c24').receive({ payload: `N${n};` })
    const settled = () => written.length + failed.length
    try {
      await until(() => out.length > 2, 'messages')
      for (let n = 0; n < 20; n++) send(n)
      await until(() => written.length > 2, 'the first outcomes')
      c24.unplug()
      await until(() => settled() === 20, 'all outcomes')
      const seen = out.length
      c24.replug()
      await until(() => out.length > seen + 2, 'messages after plugging it in', 8000)
      send(20)
      await until(() => settled() === 21 && module.messages.at(-1)?.bytes.toString() === 'N20;', 'the last message')
      const got = module.messages.map(({ bytes }) => bytes.toString())
      const whole = got.filter(text => text.endsWith(';'))
      assert.equal(new Set(whole).size, whole.length, 'none twice')
      // a pty takes more than a wire has carried when it is unplugged: what is `sent` may be lost there, but never what is glued
      for (const text of got) assert.match(text, /^N\d*;?$/)
      for (const { payload } of failed.filter(({ write }) => write.outcome === 'failed'))
        assert.ok(!got.includes(payload))
      // the first one after an opening may be a tail, and says so
      for (const { payload, complete, afterOpen } of out) {
        if (complete && !afterOpen) assert.match(payload, /^STATE \d+$/)
      }
    } finally {
      module.close()
      c24.close()
    }
  })
})
