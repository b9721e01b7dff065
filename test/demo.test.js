'use strict'

/** `npm start` as a program: its ends. That it flows is a step of `.ci/run`. */

const assert = require('node:assert/strict')
const { spawn } = require('node:child_process')
const { once } = require('node:events')
const fs = require('node:fs')
const net = require('node:net')
const os = require('node:os')
const path = require('node:path')

const START = path.join(__dirname, '../examples/demo/start.js')

describe('demo flow', () => {
  const flow = require('../examples/demo/flow.json')

  it('writers say how many outputs they have, texts bring their units', () => {
    for (const node of flow.filter(({ type }) =>
      /^(nx-write|chino-regulator|melsec-c24|incon-link|plc-monitor)$/.test(type)
    ))
      assert.equal(node.outputs, node.wires.length, node.name)
    // the dashboard ignores any other format
    for (const node of flow.filter(({ type }) => type === 'ui-text'))
      assert.equal(node.format, '{{msg.payload}}', node.name)
  })

  it('has no text that the editor takes for a list of properties', () => {
    const folder = path.join(__dirname, '../examples')
    const files = fs.readdirSync(folder).filter(name => name.endsWith('.json'))
    const flows = files.map(name => JSON.parse(fs.readFileSync(path.join(folder, name), 'utf8')))
    // Node-RED's markdown: ": name (type) : text"
    const list = /:[^:\n]+\([^:\n]+\).*?:/
    const wrong = [flow, ...flows].flat().filter(({ info }) => list.test(info ?? ''))
    assert.deepEqual(
      wrong.map(({ info }) => list.exec(info)?.[0]),
      []
    )
  })
})

describe('demo broker', () => {
  const { startBroker } = require('../examples/demo/broker')
  const { freePort } = require('../examples/demo/ports')

  it('ends, also where somebody has connected and said nothing yet', async () => {
    const port = await freePort(0)
    const broker = await startBroker(port)
    const silent = net.connect(port, '127.0.0.1')
    await once(silent, 'connect')
    const gone = once(silent, 'close')
    await broker.close()
    await gone
  })
})

describe('demo', function () {
  this.timeout(30000)
  let folder
  const running = new Set()
  beforeEach(() => (folder = fs.mkdtempSync(path.join(os.tmpdir(), 'demo-test-'))))
  afterEach(async () => {
    for (const { child, ended } of running) {
      child.kill('SIGINT')
      await ended
    }
    fs.rmSync(folder, { recursive: true, force: true })
  })

  const start = args => {
    // its own folder for what is temporary, so that what it leaves behind is seen
    const child = spawn(process.execPath, [START, ...args], { env: { ...process.env, TMPDIR: folder } })
    const demo = { child, out: '', err: '', ended: once(child, 'exit') }
    child.stdout.on('data', text => (demo.out += text))
    child.stderr.on('data', text => (demo.err += text))
    running.add(demo)
    demo.ended.then(() => running.delete(demo))
    return demo
  }
  const shown = async (demo, text) => {
    const over = demo.ended.then(() => Promise.reject(new Error(`it ended: ${demo.err}`)))
    while (!demo.out.includes(text)) await Promise.race([once(demo.child.stdout, 'data'), over])
    over.catch(() => {})
  }
  const counts = ({ out }) => JSON.parse(out.trim().split('\n').at(-1))

  it('Ctrl-C ends all of it and leaves nothing behind', async () => {
    const demo = start([])
    await shown(demo, 'Ctrl-C ends it')
    demo.child.kill('SIGINT')
    assert.deepEqual([...(await demo.ended)], [0, null], demo.err)
    assert.deepEqual(Object.keys(counts(demo)), [
      'published',
      'topics',
      'writesConfirmed',
      'answered',
      'errors',
      'devices'
    ])
    assert.deepEqual(fs.readdirSync(folder), [])
  })

  it('code 1 if a device delivered nothing: the line of the PLCs listens for 3 s before it asks', async () => {
    const demo = start(['--seconds', '1'])
    const [code] = await demo.ended
    const { devices } = counts(demo)
    for (const name of ['furnace', 'tank', 'zone1', 'zone2']) assert.equal(devices[name], undefined)
    assert.equal(code, 1)
    assert.deepEqual(fs.readdirSync(folder), [])
  })

  it('takes free ports if the usual ones are busy', async () => {
    const one = start([])
    await shown(one, 'Ctrl-C ends it')
    const two = start([])
    await shown(two, 'Ctrl-C ends it')
    const ports = ({ out }) => [...out.matchAll(/:\/\/127\.0\.0\.1:(\d+)/g)].map(([, port]) => port)
    assert.equal(ports(one).length, 3)
    assert.deepEqual(
      ports(one).filter(port => ports(two).includes(port)),
      []
    )
    for (const { child } of [one, two]) child.kill('SIGINT')
    assert.deepEqual([(await one.ended)[0], (await two.ended)[0]], [0, 0], one.err + two.err)
  })

  it('ends with code 0 only if all six devices delivered', async () => {
    // a set value of each kind comes through within some seconds
    const demo = start(['--seconds', '8'])
    const [code] = await demo.ended
    const { devices, errors } = counts(demo)
    assert.deepEqual(Object.keys(devices).toSorted(), ['furnace', 'machine', 'press', 'tank', 'zone1', 'zone2'])
    for (const name of Object.keys(devices)) assert.ok(devices[name].published > 0, name)
    assert.ok(devices.furnace.writesConfirmed > 0 && devices.zone1.writesConfirmed > 0, JSON.stringify(devices))
    // nobody confirms what is sent to these: they show it themselves
    assert.ok(devices.press.answered > 0 && devices.machine.answered > 0, JSON.stringify(devices))
    assert.deepEqual([devices.press.writesConfirmed, devices.machine.writesConfirmed], [0, 0])
    assert.deepEqual([code, errors], [0, 0], demo.out + demo.err)
    assert.equal(demo.err, '', 'no warning of the runtime')
  })

  it('a wrong number of seconds is refused', async () => {
    const demo = start(['--seconds', 'ten'])
    assert.equal((await demo.ended)[0], 1)
    assert.match(demo.err, /--seconds takes a number of seconds/)
  })
})
