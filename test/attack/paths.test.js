'use strict'

const assert = require('node:assert/strict')
const { execFileSync } = require('node:child_process')
const fs = require('node:fs')
const net = require('node:net')
const path = require('node:path')
const { createPool, lineSettings } = require('../../lib')
const { serialOver } = require('../../lib/line/transports/serial')
const { notAPort } = require('../../lib/line/transports/device-file')
const { failure } = require('../line/support/bench')
const { fastClock, openFiles, tempFolder } = require('../line/support/real')
const toy = require('../line/support/toy')

const posix = process.platform !== 'win32'

/** What stands where a serial port should; each is made in a folder of its own and answers with its path. */
const THINGS = {
  'a file': folder => {
    const file = path.join(folder, 'file')
    fs.writeFileSync(file, 'as it was')
    return file
  },
  'a link to a file': folder => {
    const link = path.join(folder, 'port')
    fs.symlinkSync(THINGS['a file'](folder), link)
    return link
  },
  'a directory': folder => folder,
  'a pipe': folder => {
    const pipe = path.join(folder, 'pipe')
    execFileSync('mkfifo', [pipe])
    return pipe
  },
  '/etc/passwd': () => '/etc/passwd',
  ...(process.platform === 'linux' ? { '/dev/null': () => '/dev/null', '/dev/zero': () => '/dev/zero' } : {})
}

;(posix ? describe : describe.skip)('attack: a path that is no serial port', () => {
  let folder
  beforeEach(() => (folder = tempFolder()))
  afterEach(() => fs.rmSync(folder, { recursive: true }))

  for (const [name, make] of Object.entries(THINGS)) {
    it(`${name}: BAD_SETTING, neither opened nor written`, async () => {
      const file = make(folder)
      let opened = 0
      const binding = { list: async () => [], open: async () => assert.fail(`opened ${++opened} times`) }
      const clock = fastClock(20)
      const pool = createPool({ clock, random: () => 0.5, transports: { serial: serialOver({ binding }) } })
      const lease = pool.open({ path: file }, { id: 'a', name: 'a' })
      const error = await failure(lease.run(() => toy.ask(1), { station: 1 }))
      assert.deepEqual([error.code, error.details.setting, error.details.value], ['BAD_SETTING', 'path', file])
      assert.match(error.message, /not a serial port/)
      assert.equal(lease.line.state, 'waiting')
      // it is looked at again, but never opened
      await new Promise(resolve => setTimeout(resolve, 40))
      await lease.release()
      assert.deepEqual([opened, pool.lines().length, clock.pending()], [0, 0, 0])
    })
  }

  it('a socket: neither', async () => {
    const file = path.join(folder, 'socket')
    let connected = 0
    const server = net.createServer(() => connected++)
    await new Promise(resolve => server.listen(file, () => resolve(undefined)))
    assert.match(notAPort(file), /a socket/)
    await new Promise(resolve => server.close(resolve))
    assert.equal(connected, 0)
  })

  it('the real binding does not get it either: the file is as it was, no descriptor is left', async () => {
    const file = THINGS['a file'](folder)
    const before = openFiles()
    const lease = createPool({ clock: fastClock() }).open({ path: file }, { id: 'a', name: 'a' })
    assert.equal((await failure(lease.run(() => toy.ask(1), { station: 1 }))).code, 'BAD_SETTING')
    await lease.release()
    assert.deepEqual([fs.readFileSync(file, 'utf8'), openFiles()], ['as it was', before])
  })

  it('what is not there yet may become one', () => {
    assert.equal(notAPort(path.join(folder, 'absent')), '')
  })
})

describe('attack: names of ports', () => {
  for (const name of ['../etc/passwd', '/dev/../etc/passwd', '/dev/serial/..', '..', 'C:\\..\\x', '..\\COM3']) {
    it(`${name} leads upwards: BAD_SETTING`, () => {
      assert.throws(() => lineSettings({ path: name }), { code: 'BAD_SETTING' })
    })
  }

  it('names with two dots inside are names', () => {
    assert.equal(lineSettings({ path: '/dev/serial/by-id/usb-A..B-port0' }).path, '/dev/serial/by-id/usb-A..B-port0')
  })

  it('Windows: only names of ports', () => {
    const judged = name => notAPort(name, 'win32') === ''
    assert.deepEqual(['COM3', '\\\\.\\COM12', 'CNCA0'].map(judged), [true, true, true])
    const others = ['C:\\pagefile.sys', '\\\\server\\pipe\\x', '\\\\.\\pipe\\x', '\\\\.\\C:', 'sub\\COM3', 'a/b']
    assert.deepEqual(others.map(judged), [false, false, false, false, false, false])
  })
})
