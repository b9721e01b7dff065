'use strict'

const assert = require('node:assert')
const { spawn, spawnSync } = require('node:child_process')
const fs = require('node:fs')
const net = require('node:net')
const os = require('node:os')
const path = require('node:path')
const { read } = require('../../scripts/simulate')

const SCRIPT = path.join(__dirname, '../../scripts/simulate.js')
const CLIENT = path.join(__dirname, 'independent_client.py')
const MODBUS_CLIENT = path.join(__dirname, 'independent_modbus_client.py')
const hasPython = spawnSync('python3', ['--version']).status === 0

/** Starts the simulator and waits for its line; `stop` ends it as Ctrl-C does. */
function simulate(...args) {
  const child = spawn(process.execPath, [SCRIPT, ...args], { stdio: ['ignore', 'pipe', 'pipe'] })
  let text = ''
  const ended = new Promise(resolve => child.on('close', code => resolve({ code, text })))
  child.stderr.on('data', data => (text += data))
  const line = new Promise((resolve, reject) => {
    child.stdout.on('data', data => {
      text += data
      if (text.includes('\n')) resolve(text)
    })
    child.on('close', code => reject(new Error(`ended with ${code}: ${text}`)))
  })
  const stop = signal => {
    child.kill(signal)
    return ended
  }
  return { line, stop, ended }
}

/** What comes back over TCP, until it is so long. */
const talk = (port, ask, length) =>
  new Promise((resolve, reject) => {
    let text = ''
    const socket = net.connect(port, '127.0.0.1', () => socket.write(ask, 'latin1'))
    socket.on('error', reject)
    socket.on('data', data => {
      text += data.toString('latin1')
      if (text.length >= length) socket.end(() => resolve(text))
    })
  })

const runPython = (...args) =>
  new Promise(resolve => {
    const child = spawn('python3', args)
    let text = ''
    for (const stream of [child.stdout, child.stderr]) stream.on('data', data => (text += data))
    child.on('close', code => resolve({ code, text }))
  })

const assertFoundCorrect = ({ code, text }, checks) => {
  assert.strictEqual(code, 0, text)
  assert.match(text, new RegExp(`ok ${checks}\\s*$`))
}

describe('npm run simulate', function () {
  this.timeout(30000)
  let folder
  before(() => (folder = fs.mkdtempSync(path.join(os.tmpdir(), 'simulate-'))))
  after(() => fs.rmSync(folder, { recursive: true, force: true }))
  const nx = ['nx', '--stations', '1', '--baud', '38400', '--quiet', '--protect', 'F0..F15', '--seed', '7']

  it('on a virtual serial port: an independent client finds it correct', async function () {
    if (!hasPython) return skip(this, 'python3 is not installed')
    if (process.platform === 'win32') return skip(this, 'there is no pty')
    const link = path.join(folder, 'plc')
    const { line, stop } = simulate(...nx, '--pty', link)
    try {
      assert.strictEqual(await line, `nx stations 1 on pty ${link}, 38400 bit/s, faults none, seed 7\n`)
      assertFoundCorrect(await runPython(CLIENT, link), 25)
    } finally {
      assert.strictEqual((await stop('SIGINT')).code, 0)
    }
    assert.strictEqual(fs.lstatSync(link, { throwIfNoEntry: false }), undefined)
  })

  it('over TCP, on a free port that it prints: the same client', async function () {
    if (!hasPython) return skip(this, 'python3 is not installed')
    const { line, stop } = simulate(...nx, '--tcp', '0')
    try {
      const found = /^nx stations 1 on tcp (127\.0\.0\.1:\d+), /.exec(await line)
      assert.ok(found)
      assertFoundCorrect(await runPython(CLIENT, found[1]), 25)
    } finally {
      assert.strictEqual((await stop('SIGTERM')).code, 0)
    }
  })

  const chino = [
    'chino',
    '--stations',
    '11,12',
    '--baud',
    '115200',
    '--quiet',
    '--protect',
    'hr500..hr509,co5',
    '--seed',
    '7'
  ]
  for (const protocol of ['rtu', 'ascii']) {
    it(`regulators, ${protocol} over TCP: a client of its own finds them correct`, async function () {
      if (!hasPython) return skip(this, 'python3 is not installed')
      const { line, stop } = simulate(...chino, '--tcp', '0', '--protocol', protocol)
      try {
        const found = new RegExp(`^chino stations 11,12 \\(${protocol}\\) on tcp (127\\.0\\.0\\.1:\\d+), `).exec(
          await line
        )
        assert.ok(found)
        assertFoundCorrect(await runPython(MODBUS_CLIENT, found[1], protocol, '115200'), 33)
      } finally {
        assert.strictEqual((await stop('SIGTERM')).code, 0)
      }
    })
  }

  it('both on one line: each client finds its own correct', async function () {
    if (!hasPython) return skip(this, 'python3 is not installed')
    const mixed = ['mixed', '--stations', 'nx:1,chino:11,chino:12', '--protect', 'F0..F15,hr500..hr509,co5']
    const { line, stop } = simulate(...mixed, '--baud', '38400', '--quiet', '--seed', '7', '--tcp', '0')
    try {
      const found = /^mixed stations nx:1,chino:11,chino:12 \(rtu\) on tcp (127\.0\.0\.1:\d+), /.exec(await line)
      assert.ok(found)
      // one after the other: two masters at once spoil each other's bytes
      assertFoundCorrect(await runPython(CLIENT, found[1]), 25)
      assertFoundCorrect(await runPython(MODBUS_CLIENT, found[1], 'rtu', '38400'), 33)
    } finally {
      assert.strictEqual((await stop('SIGTERM')).code, 0)
    }
  })

  const wrong = [
    [[], 'the device is missing: it must be nx, chino, mixed, c24 or incon'],
    [['modbus', '--tcp', '0'], 'the device is modbus: it must be nx, chino, mixed, c24 or incon'],
    [['nx'], '--pty, --tcp is missing: give one of them'],
    [['nx', '--tcp', '0', '--pty', 'x'], '--pty, --tcp is both'],
    [['nx', '--tcp', '70000'], '--tcp is 70000: it must be a whole number from 0 to 65535'],
    [['nx', '--tcp', '0', '--stations', '1,192'], '--stations is 192: it must be a whole number from 0 to 191'],
    [['nx', '--tcp', '0', '--stations', '3,3'], '--stations is 3,3: a number stands there twice'],
    [['chino', '--tcp', '0', '--stations', '0'], '--stations is 0: it must be a whole number from 1 to 247'],
    [['chino', '--tcp', '0', '--stations', 'nx:1'], '--stations is nx:1: it must be a whole number from 1 to 247'],
    [['mixed', '--tcp', '0', '--stations', 'nx:1,chino:1'], 'a number stands there twice'],
    [['mixed', '--tcp', '0', '--stations', '1,11'], '--stations is 1: it must be nx:NUMBER or chino:NUMBER'],
    [['mixed', '--tcp', '0', '--stations', 'nx:200'], '--stations is 200: it must be a whole number from 0 to 191'],
    [['chino', '--tcp', '0', '--protocol', 'tcp'], '--protocol is tcp: it must be rtu or ascii'],
    [['nx', '--tcp', '0', '--protocol', 'rtu'], '--protocol is rtu: nx has no such option'],
    [['nx', '--tcp', '0', '--fault', 'error:0.1:6'], 'from 1 to 5'],
    [['chino', '--tcp', '0', '--fault', 'error:0.1:256'], 'from 1 to 255'],
    [['mixed', '--tcp', '0', '--fault', 'error:0.1:6'], 'from 1 to 5'],
    [['nx', '--tcp', '0', '--fault', 'tired:0.1'], 'fault is tired:0.1: known faults are lost, silent,'],
    [['nx', '--tcp', '0', '--fault', 'late'], 'fault is late: the rate must be a number'],
    [['c24', '--tcp', '0', '--flow', 'dtr'], '--flow is dtr: it must be none or dc'],
    [['c24', '--tcp', '0', '--stations', '1'], '--stations is 1: c24 has no such option'],
    [['c24', '--tcp', '0', '--rate', 'x'], '--rate is x: it must be a whole number from 0 to 1000000'],
    [['c24', '--tcp', '0', '--scan', '5'], '--scan is 5: c24 has no such option'],
    [['incon', '--tcp', '0', '--scan', '0'], '--scan is 0: it must be a whole number from 1 to 1000'],
    [['incon', '--tcp', '0', '--fault', 'error:0.1:6'], 'from 1 to 5'],
    [['nx', '--tcp', '0', '--wear', 'lost:2'], '--wear is lost:2: it must be damaged:RATE, lost:RATE'],
    [['nx', '--tcp', '0', '--show'], '--show is true: nx has no such option'],
    [['nx', '--tcp', '0', '--frobnicate'], "Unknown option '--frobnicate'"]
  ]
  for (const [args, text] of wrong) {
    it(`${args.join(' ') || 'nothing'}: ${text}`, () => {
      assert.throws(
        () => read(Array.from(args)),
        error => error.code === 'BAD_SETTING' && error.message.includes(String(text))
      )
    })
  }

  it('ends with code 2 and says why, without a stack', async () => {
    const { line, ended } = simulate('nx', '--tcp', '0', '--protect', 'X1')
    await assert.rejects(line)
    const { code, text } = await ended
    assert.strictEqual(code, 2)
    assert.match(text, /^"X1" names the area X, .*\nTry --help\.\n$/)
  })

  it('the rates of wear', () => {
    assert.deepStrictEqual(read(['nx', '--tcp', '0', '--wear', 'damaged:0.01,lost:.5']).wear, {
      damaged: 0.01,
      lost: 0.5
    })
    assert.strictEqual(read(['nx', '--tcp', '0']).wear, null)
  })

  // what goes out is in the test alone: the example of the bidirectional protocol's page, and a line
  const talks = [
    {
      device: 'c24',
      args: ['--answer', 'echo', '--end', '0D', '--show'],
      ask: 'ABC\r',
      answer: 'ABC\r',
      shown: /^c24 \(non-procedure, flow none\) on tcp .*\ntaken: "ABC"\n$/
    },
    {
      device: 'c24',
      args: ['--protocol', 'bidirectional', '--show'],
      ask: '\x05\x05\x00ABCDEFG123\x77\x02',
      answer: '\x06',
      shown: /^c24 \(bidirectional, flow none\) on tcp .*\ntaken: "ABCDEFG123"\n$/
    },
    {
      device: 'incon',
      args: ['--answer', 'echo', '--scan', '5', '--show'],
      ask: 'O1234\r\n',
      answer: 'O1234\r\n',
      shown: /^incon \(scan 5 ms\) on tcp .*\ntaken: "O1234\\r\\n"\n$/
    }
  ]
  for (const { device, args, ask, answer, shown } of talks) {
    it(`${device} ${args.join(' ')}`, async () => {
      const { line, stop } = simulate(device, '--tcp', '0', '--baud', '115200', '--quiet', ...args)
      let heard
      try {
        const [, port] = /** @type {any} */ (/:(\d+), 115200/.exec(await line))
        heard = await talk(Number(port), ask, answer.length)
      } finally {
        assert.match((await stop('SIGTERM')).text, shown)
      }
      assert.strictEqual(heard, answer)
    })
  }

  it('each station of a mixed line gets the ranges of its own notation', () => {
    const { stations } = read([
      'mixed',
      '--tcp',
      '0',
      '--stations',
      'chino:2,nx:1',
      '--protect',
      '400010..400019,K0,HR5'
    ])
    assert.deepStrictEqual(stations, [
      { device: 'chino', station: 2, protect: ['400010..400019', 'HR5'] },
      { device: 'nx', station: 1, protect: ['K0'] }
    ])
  })

  it('--help names every option and fault', async () => {
    const { line, ended } = simulate('--help')
    await line
    const { code, text } = await ended
    assert.strictEqual(code, 0)
    for (const word of [
      '--pty LINK',
      '--tcp PORT',
      '--seed N',
      '--protocol NAME',
      'late ',
      'merged ',
      'chino ',
      'mixed ',
      'c24 ',
      'incon ',
      '--timer0 N',
      '--scan MS'
    ])
      assert.ok(text.includes(word), word)
  })
})

function skip(test, reason) {
  test.test.title += ` (${reason})`
  test.skip()
}
