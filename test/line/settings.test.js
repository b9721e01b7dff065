'use strict'

const assert = require('node:assert/strict')
const { difference, lineName } = require('../../lib/line/settings')
const { lineSettings, wireKey, bitsPerCharacter, gapTime, characterTime, slackTime } = require('../../lib/line')

const refused = (raw, setting, text) => {
  it(`${setting} ${JSON.stringify(raw)}`, () => {
    assert.throws(
      () => lineSettings({ path: '/dev/a', ...raw }),
      error => error.code === 'BAD_SETTING' && error.details.setting === setting && text.test(error.message)
    )
  })
}

describe('line: settings', () => {
  it('have the defaults of the contract', () => {
    const settings = lineSettings({ path: '/dev/ttyUSB0', wire: 'only of a simulated line' })
    assert.deepEqual(settings, {
      transport: 'serial',
      name: '',
      path: '/dev/ttyUSB0',
      host: '',
      port: 0,
      baudRate: 19200,
      dataBits: 8,
      parity: 'none',
      stopBits: 1,
      flowControl: 'none',
      dtr: 'unchanged',
      rts: 'unchanged',
      openDelay: 0,
      gap: 0,
      echo: 'auto',
      slack: 0,
      latenessBound: 0,
      openGrace: 2000,
      connectTimeout: 5000,
      keepAlive: 10000,
      writeTimeout: 1000,
      jamTime: 1000,
      queueLimit: 1000,
      writesBeforePoll: 4
    })
    assert.ok(Object.isFrozen(settings))
  })

  it('take numbers as text, as flows save them', () => {
    const settings = lineSettings({
      path: ' /dev/a ',
      baudRate: '9600',
      dataBits: '7',
      stopBits: '2',
      gap: '',
      port: null
    })
    const { path, baudRate, dataBits, stopBits, gap, port } = settings
    assert.deepEqual([path, baudRate, dataBits, stopBits, gap, port], ['/dev/a', 9600, 7, 2, 0, 0])
  })

  it('what is empty is the default; the least, the most and all that is known is allowed', () => {
    const empty = lineSettings({ path: '/dev/a', name: '', baudRate: '', parity: '', queueLimit: null })
    assert.deepEqual([empty.name, empty.baudRate, empty.parity, empty.queueLimit], ['', 19200, 'none', 1000])
    const values = {
      baudRate: [1, 10000000],
      parity: ['even', 'odd', 'none'],
      flowControl: ['none', 'rtscts', 'xonxoff'],
      dtr: ['unchanged', 'on', 'off'],
      rts: ['unchanged', 'on', 'off']
    }
    for (const [name, list] of Object.entries(values)) {
      for (const value of list) assert.equal(lineSettings({ path: '/dev/a', [name]: ` ${value} ` })[name], value)
    }
  })

  it('name the line by its name or its wire, and the first setting in which two of one wire differ', () => {
    const one = lineSettings({ path: '/dev/a', baudRate: 9600 })
    assert.deepEqual([lineName(one), lineName(lineSettings({ path: '/dev/a', name: 'mill' }))], ['/dev/a', 'mill'])
    assert.equal(difference(one, lineSettings({ path: '/dev/a', baudRate: 9600, name: 'mill' })), '')
    assert.equal(difference(one, lineSettings({ path: '/dev/a' })), 'baudRate 9600 and 19200')
    const on = wire => lineSettings({ transport: 'simulated', wire })
    assert.equal(difference(on({ connect() {} }), on({ connect() {} })), 'two different wires')
  })

  it('leave out what they do not know', () => {
    const settings = lineSettings(JSON.parse('{"path":"/dev/a","__proto__":{"x":1},"evil":2}'))
    assert.equal('evil' in settings || 'x' in settings, false)
  })

  it('key a wire by path or host:port', () => {
    assert.equal(wireKey(lineSettings({ path: '/dev/a' })), '/dev/a')
    assert.equal(wireKey(lineSettings({ transport: 'tcp', host: 'Moxa.Local', port: '4001' })), 'moxa.local:4001')
  })

  describe('refuse with the name of the setting', () => {
    refused({ path: '' }, 'path', /empty: a serial line needs the path/)
    refused({ path: 7 }, 'path', /text is needed/)
    refused({ path: '../port' }, 'path', /does not lead upwards/)
    refused({ path: '/dev/../etc/passwd' }, 'path', /does not lead upwards/)
    refused({ path: 'dev\\..' }, 'path', /does not lead upwards/)
    refused({ path: 'a\0b' }, 'path', /with a zero byte: it cannot be a name/)
    refused({ transport: 'udp' }, 'transport', /known are serial, tcp, simulated/)
    refused({ baudRate: 0 }, 'baudRate', /allowed is 1 to/)
    refused({ baudRate: 'fast' }, 'baudRate', /fast: a number is needed/)
    refused({ baudRate: 9600.5 }, 'baudRate', /whole number/)
    for (const name of ['port', 'queueLimit', 'writesBeforePoll']) refused({ [name]: 1.5 }, name, /whole number/)
    refused({ baudRate: Infinity }, 'baudRate', /a number is needed/)
    refused({ baudRate: {} }, 'baudRate', /a number is needed/)
    refused({ dataBits: 6 }, 'dataBits', /known are 8, 7/)
    refused({ parity: 'mark' }, 'parity', /known are none, even, odd/)
    refused({ stopBits: 3 }, 'stopBits', /known are 1, 2/)
    refused({ echo: true }, 'echo', /known are auto, on, off/)
    refused({ gap: -1 }, 'gap', /allowed is 0 to/)
    refused({ transport: 'tcp', port: 502 }, 'host', /host of the serial server/)
    refused({ transport: 'tcp', host: 'a' }, 'port', /1 to 65535/)
    refused({ transport: 'tcp', host: 'a', port: 65536 }, 'port', /65535/)
    refused({ transport: 'simulated' }, 'wire', /needs a wire/)
  })

  it('that are none at all are refused', () => {
    for (const raw of [null, 'x', 7]) {
      const refusal = { code: 'BAD_SETTING', message: /the line.*: an object of settings is needed/ }
      assert.throws(() => lineSettings(raw), refusal)
    }
  })
})

describe('line: times', () => {
  const times = raw => lineSettings({ path: '/dev/a', ...raw })
  const near = (got, wanted) => assert.ok(Math.abs(got - wanted) < 1e-9, `${got}, wanted ${wanted}`)

  it('count start, data, parity and stop bits', () => {
    assert.equal(bitsPerCharacter(times({})), 10)
    assert.equal(bitsPerCharacter(times({ parity: 'even' })), 11)
    assert.equal(bitsPerCharacter(times({ dataBits: 7, parity: 'odd', stopBits: 2 })), 11)
    near(characterTime(times({ baudRate: 9600 })), 10 / 9.6)
  })

  it('have an automatic gap of 3.5 characters, 1.75 ms above 19200 bit/s', () => {
    near(gapTime(times({ baudRate: 9600 })), 35 / 9.6)
    near(gapTime(times({ baudRate: 19200 })), 35 / 19.2)
    near(gapTime(times({ baudRate: 38400 })), 1.75)
    near(gapTime(times({ gap: 10 })), 10)
  })

  it('have the slack of the transport', () => {
    assert.equal(slackTime(times({})), 50)
    assert.equal(slackTime(times({ transport: 'tcp', host: 'a', port: 1 })), 250)
    assert.equal(slackTime(times({ slack: 7 })), 7)
  })
})
