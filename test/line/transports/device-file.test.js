'use strict'

const assert = require('node:assert/strict')
const fs = require('node:fs')
const os = require('node:os')
const path = require('node:path')
const { notAPort } = require('../../../lib/line/transports/device-file')

const no = () => false
/** What the system says about a name. */
const said = extra => ({
  rdev: 0,
  isFile: no,
  isDirectory: no,
  isFIFO: no,
  isSocket: no,
  isBlockDevice: no,
  ...extra
})

describe('line: what may be opened as a serial port', () => {
  it('on Windows a name, not a path', () => {
    for (const name of ['COM1', 'COM12', '\\\\.\\COM12', '\\\\?\\COM3', 'CNCA0', 'com-a'])
      assert.equal(notAPort(name, 'win32'), '', name)
    for (const name of ['C:\\file', 'a\\COM3', '..\\COM3', 'COM3.txt', '', 'COM 3', '\\\\server\\COM3'])
      assert.equal(notAPort(name, 'win32'), 'it is not the name of a serial port', name)
  })

  it('elsewhere no file, no directory, no socket; what is not there may come', () => {
    const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'port-'))
    const file = path.join(folder, 'file')
    fs.writeFileSync(file, '')
    const link = path.join(folder, 'link')
    fs.symlinkSync(file, link)
    try {
      assert.equal(notAPort(folder, 'linux'), 'it is a directory, not a serial port')
      for (const name of [file, link]) assert.equal(notAPort(name, 'linux'), 'it is a file, not a serial port')
      assert.equal(notAPort(path.join(folder, 'none'), 'linux'), '')
    } finally {
      fs.rmSync(folder, { recursive: true })
    }
  })

  it('nor a pipe, a socket, or a disk', () => {
    const { statSync } = fs
    const kinds = {
      isFIFO: 'it is a pipe, not a serial port',
      isSocket: 'it is a socket, not a serial port',
      isBlockDevice: 'it is a block device, not a serial port'
    }
    try {
      for (const [kind, reason] of Object.entries(kinds)) {
        fs.statSync = /** @type {any} */ (() => said({ [kind]: () => true }))
        assert.equal(notAPort('/dev/a', 'linux'), reason)
      }
    } finally {
      Object.assign(fs, { statSync })
    }
  })

  it('what the kernel counts a device among is found by its number', () => {
    const { statSync, readlinkSync } = fs
    const asked = []
    try {
      fs.readlinkSync = /** @type {any} */ (
        name => {
          asked.push(name)
          if (name.includes('/4:')) return '../../../class/tty'
          throw Object.assign(new Error('ENOENT'), { code: 'ENOENT' })
        }
      )
      // makedev of glibc: major 4, minor 64 (ttyS0); 136, 300 (a terminal of a program); 511, 0x12345
      for (const rdev of [0x440, 0x10882c, 0x1231ff45]) {
        fs.statSync = /** @type {any} */ (() => said({ rdev }))
        assert.equal(notAPort('/dev/a', 'linux'), '')
      }
    } finally {
      Object.assign(fs, { statSync, readlinkSync })
    }
    assert.deepEqual(
      asked,
      ['4:64', '136:300', `511:${0x12345}`].map(number => `/sys/dev/char/${number}/subsystem`)
    )
  })

  it('nor a device of another kind', function () {
    if (process.platform !== 'linux') this.skip()
    assert.equal(notAPort('/dev/null'), 'it is a device of the kind mem, not a serial port')
    assert.equal(notAPort('/dev/tty'), '')
  })
})
