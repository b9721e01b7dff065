'use strict'

/** The programs of README and docs/chino.md are run as they stand there, against simulated devices behind a real (virtual) serial port. */

const assert = require('node:assert/strict')
const fs = require('node:fs')
const os = require('node:os')
const path = require('node:path')
const { createLine, createNxLine, serveOnPty, serveOnTcp } = require('../lib/sim')
const { filesBelow, read } = require('./support/source.js')

const snippet = (page = 'README.md') =>
  /test\/readme\.test\.js as it stands here -->\n```js\n([\s\S]*?)```/.exec(read(page))[1]

/** Runs it with `require`, `console` and, instead of the adapter's path, the simulator's. */
async function run(text, wrong) {
  const printed = []
  const door = name => {
    assert.equal(name, '@nxline/node-red-serial-plc')
    return require('..')
  }
  const AsyncFunction = (async () => {}).constructor
  await AsyncFunction('require', 'console', text.replace(...wrong))(door, { log: (...words) => printed.push(words) })
  return printed
}

describe('README', () => {
  it('its library example is ten lines at most', () => {
    assert.ok(snippet().trim().split('\n').length <= 10)
  })

  it('its library example writes and reads a PLC', async () => {
    const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'readme-test-'))
    const { wire, plcs } = createNxLine({ stations: [1], baudRate: 38400, quiet: true })
    const port = serveOnPty({ wire, link: path.join(folder, 'line') })
    try {
      plcs[0].set('M2', 77)
      plcs[0].set('M10', 1.5, 'float32')
      const printed = await run(snippet(), ['/dev/ttyUSB0', port.path()])
      assert.deepEqual(printed, [['confirmed'], ['K0', 215], ['K127_12', true], ['M0_M3', [0, 0, 77, 0]], ['M10', 1.5]])
      assert.equal(plcs[0].get('K0'), 215)
      assert.equal(plcs[0].get('K127.12'), true)
    } finally {
      port.close()
      fs.rmSync(folder, { recursive: true })
    }
  })

  it('its library example works behind a serial server too', async () => {
    const { wire, plcs } = createNxLine({ stations: [1], baudRate: 38400, quiet: true })
    const server = await serveOnTcp({ wire })
    try {
      const printed = await run(snippet(), ["path: '/dev/ttyUSB0'", `host: '127.0.0.1', port: ${server.port}`])
      assert.deepEqual(printed[0], ['confirmed'])
      assert.equal(plcs[0].get('K0'), 215)
    } finally {
      await server.close()
    }
  })

  it('docs/chino.md: its program writes and reads a regulator', async () => {
    const { wire, stations } = createLine({
      stations: [{ device: 'chino', station: 11 }],
      baudRate: 19200,
      quiet: true
    })
    const server = await serveOnTcp({ wire })
    try {
      stations[0].set('300007', 100000, 'uint32')
      stations[0].set('400003', 7)
      const place = ["path: '/dev/ttyUSB0'", `host: '127.0.0.1', port: ${server.port}`]
      const printed = await run(snippet('docs/chino.md'), place)
      const seen = [
        ['hr0', 400],
        ['_001001', true],
        ['_400001_400003', [400, 0, 7]],
        ['_300007', 100000]
      ]
      assert.deepEqual(printed, [['confirmed'], ...seen])
      assert.deepEqual([stations[0].get('400001'), stations[0].get('001001')], [400, true])
    } finally {
      await server.close()
    }
  })

  it('its commands are scripts, its links lead somewhere', () => {
    const { scripts } = require('../package.json')
    for (const [, name] of read('README.md').matchAll(/npm (?:run )?(start|test|simulate)\b/g))
      assert.ok(scripts[name], name)
    const pages = ['README.md', 'CONTRIBUTING.md', 'SECURITY.md', ...filesBelow('docs', name => name.endsWith('.md'))]
    for (const page of pages) {
      for (const [, link] of read(page).matchAll(/\]\((?!https?:|#)([^)#\s]+)/g)) {
        const target = path.posix.join(path.posix.dirname(page), link)
        assert.ok(fs.existsSync(path.join(__dirname, '..', target)), `${page}: ${link}`)
      }
    }
  })
})
