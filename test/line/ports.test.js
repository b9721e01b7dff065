'use strict'

const assert = require('node:assert/strict')
const { listPorts } = require('../../lib/line')

/** A file system of the test: by-id names with their devices, and what is in /dev. */
const files = ({ links = {}, dev = [] } = {}) => ({
  readdir: async folder => {
    const names = folder === '/dev' ? dev : Object.keys(links)
    if (folder !== '/dev' && names.length === 0) throw Object.assign(new Error('ENOENT'), { code: 'ENOENT' })
    return names
  },
  realpath: async name => {
    const device = links[name.replace('/dev/serial/by-id/', '')]
    if (!device) throw new Error('ENOENT')
    return device
  }
})
const withoutUdev = () => Promise.reject(new Error('spawn udevadm ENOENT'))

const FTDI = 'usb-FTDI_USB-RS485_Cable_FT1ABCDE-if00-port0'
const MOXA = 'usb-Moxa_Technologies_UPort_1150-if00-port0'

describe('line: the list of ports', () => {
  it('names adapters, with the stable path', async () => {
    const list = async () => [
      { path: '/dev/ttyUSB1', manufacturer: 'Moxa', pnpId: MOXA },
      { path: '/dev/ttyUSB0', manufacturer: 'FTDI', pnpId: FTDI }
    ]
    const links = { [FTDI]: '/dev/ttyUSB0', [MOXA]: '/dev/ttyUSB1' }
    assert.deepEqual(await listPorts({ list, files: files({ links }) }), [
      { path: `/dev/serial/by-id/${FTDI}`, device: '/dev/ttyUSB0', label: 'FTDI USB-RS485 Cable (ttyUSB0)' },
      { path: `/dev/serial/by-id/${MOXA}`, device: '/dev/ttyUSB1', label: 'Moxa Technologies UPort 1150 (ttyUSB1)' }
    ])
  })

  it('finds by-id names and devices where udevadm is missing', async () => {
    const found = await listPorts({
      list: withoutUdev,
      files: files({
        links: { [FTDI]: '/dev/ttyUSB0' },
        dev: ['ttyUSB0', 'ttyUSB1', 'ttyUSB10', 'ttyACM0', 'ttyAMA0', 'tty1', 'null', 'xttyUSB2', 'ttyUSB3.lock']
      })
    })
    assert.deepEqual(
      found.map(({ label }) => label),
      ['FTDI USB-RS485 Cable (ttyUSB0)', 'ttyACM0', 'ttyAMA0', 'ttyUSB1', 'ttyUSB10']
    )
    assert.equal(found[3].path, '/dev/ttyUSB1')
  })

  it('names an adapter without a stable path by what it calls itself', async () => {
    const list = async () => [{ path: '/dev/ttyUSB0', pnpId: MOXA, manufacturer: 'Moxa' }]
    assert.deepEqual(await listPorts({ list, files: files() }), [
      { path: '/dev/ttyUSB0', device: '/dev/ttyUSB0', label: 'Moxa Technologies UPort 1150 (ttyUSB0)' }
    ])
  })

  it('reads the name of an adapter out of its stable name', async () => {
    const names = {
      'usb-1a86_USB_Single_Serial_54D2042265-if00': '1a86 USB Single Serial',
      'usb-Quad_Adapter-if02-port10': 'Quad Adapter',
      'usb-Dual-if1-Adapter-if00-port0': 'Dual-if1-Adapter',
      'Adapter_usb-C_Cable': 'Adapter usb-C Cable',
      'usb-ABCDEF12-if00': 'ABCDEF12',
      'usb-Adapter_V2-RS485X-if00': 'Adapter V2-RS485X',
      'usb-Adapter_RS485X-2-if00': 'Adapter RS485X-2'
    }
    for (const [id, name] of Object.entries(names)) {
      const [{ label }] = await listPorts({ list: withoutUdev, files: files({ links: { [id]: '/dev/ttyUSB0' } }) })
      assert.equal(label, `${name} (ttyUSB0)`)
    }
  })

  it('of two stable names the first is taken, whatever their order on the disk', async () => {
    const links = { [MOXA]: '/dev/ttyUSB0', [FTDI]: '/dev/ttyUSB0' }
    const found = await listPorts({ list: async () => [{ path: '/dev/ttyUSB0' }], files: files({ links }) })
    assert.deepEqual(found, [
      { path: `/dev/serial/by-id/${FTDI}`, device: '/dev/ttyUSB0', label: 'FTDI USB-RS485 Cable (ttyUSB0)' }
    ])
  })

  it('device files are looked at only where nobody tells of ports', async () => {
    const found = await listPorts({ list: async () => [{ path: '/dev/ttyUSB0' }], files: files({ dev: ['ttyUSB1'] }) })
    assert.deepEqual(
      found.map(({ device }) => device),
      ['/dev/ttyUSB0']
    )
  })

  it('has also what only a stable name leads to, and not what it leads nowhere', async () => {
    const links = { [FTDI]: '/dev/ttyUSB7', [MOXA]: null }
    const list = async () => [{ path: '/dev/ttyUSB0' }]
    assert.deepEqual(await listPorts({ list, files: files({ links }) }), [
      { path: `/dev/serial/by-id/${FTDI}`, device: '/dev/ttyUSB7', label: 'FTDI USB-RS485 Cable (ttyUSB7)' },
      { path: '/dev/ttyUSB0', device: '/dev/ttyUSB0', label: 'ttyUSB0' }
    ])
  })

  it('a port of the board that something is known of is a real one', async () => {
    for (const known of [{ manufacturer: 'A' }, { pnpId: 'A' }, { vendorId: '1234' }]) {
      const list = async () => [{ path: '/dev/ttyS0' }, { path: '/dev/ttyS4', ...known }]
      const found = await listPorts({ list, files: files() })
      assert.deepEqual(
        found.map(({ device }) => device),
        ['/dev/ttyS4']
      )
    }
  })

  it('hides the empty ports of the board if there are others', async () => {
    const list = async () => [{ path: '/dev/ttyS0' }, { path: '/dev/ttyS31' }, { path: '/dev/ttyUSB0' }]
    const paths = async l => (await listPorts({ list: l, files: files() })).map(({ path }) => path)
    assert.deepEqual(await paths(list), ['/dev/ttyUSB0'])
    assert.deepEqual(await paths(async () => [{ path: '/dev/ttyS10' }, { path: '/dev/ttyS9' }]), [
      '/dev/ttyS9',
      '/dev/ttyS10'
    ])
  })

  it('knows Windows names', async () => {
    const list = async () => [{ path: '\\\\.\\COM10' }, { path: 'COM3', manufacturer: 'FTDI' }]
    assert.deepEqual(
      (await listPorts({ list, files: files() })).map(({ path, label }) => `${path} ${label}`),
      ['\\\\.\\COM10 COM10', 'COM3 FTDI (COM3)']
    )
  })

  it('is empty, not an error, where there is nothing', async () => {
    assert.deepEqual(await listPorts({ list: withoutUdev, files: files() }), [])
  })

  it('works on this machine', async () => {
    assert.ok(Array.isArray(await listPorts()))
  })
})
