'use strict'

const assert = require('node:assert/strict')
const fs = require('node:fs')
const os = require('node:os')
const path = require('node:path')
const { notAPort } = require('../../../lib/line/transports/device-file')

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

  it('nor a device of another kind', function () {
    if (process.platform !== 'linux') this.skip()
    assert.equal(notAPort('/dev/null'), 'it is a device of the kind mem, not a serial port')
    assert.equal(notAPort('/dev/tty'), '')
  })
})
