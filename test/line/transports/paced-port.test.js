'use strict'

const assert = require('node:assert/strict')
const { SerialPort } = require('serialport')
const { OpenPort } = require('../../../lib/line/transports/open-port')
const { Pace } = require('../../../lib/line/transports/pace')
const { pacedBinding } = require('../../../lib/line/transports/paced-binding')
const { createVirtualClock } = require('../../../lib/sim')
const { createPty } = require('../../../lib/sim/pty')

const supported = ['linux', 'darwin'].includes(process.platform)
/** More than the buffers of a port and of who reads it take. */
const MUCH = 200000
const TURNS = 100
const DC1 = 0x11
const DC3 = 0x13

const turn = () => new Promise(resolve => setImmediate(resolve))
const until = async condition => {
  while (!condition()) await turn()
}

;(supported ? describe : describe.skip)('port that is read by wire time', () => {
  let pty, clock, pace, port, open, got
  beforeEach(async () => {
    pty = createPty({})
    clock = createVirtualClock()
    pace = new Pace(clock)
    const options = { path: pty.path(), baudRate: 115200, xon: true, xoff: true }
    port = await pacedBinding(SerialPort.binding, pace).open(options)
    open = new OpenPort(port, error => assert.fail(error))
    got = ''
    open.read(bytes => (got += bytes))
  })
  afterEach(async () => {
    await new Promise(resolve => open.close(resolve))
    pty.close()
  })

  // the poller of bindings-cpp never forgets what it was once asked for: with bytes that nobody reads yet it told of them and of room to write in turn,
  // on and on, and took a whole core
  it('does not ask on and on for what is not read yet, once a write had to wait', async () => {
    let drained = 0
    pty.onData(bytes => (drained += bytes.length))
    pty.stream().pause()
    const written = new Promise(resolve => open.write(Buffer.alloc(MUCH, 'A'), resolve))
    await until(() => port.poller.listenerCount('writable') > 0)
    pty.stream().resume()
    assert.equal(await written, undefined)
    await until(() => drained === MUCH)
    // somebody waits for bytes already, and reads what comes first; behind it nothing for a second
    pace.hint(clock.now() + 1000)
    pty.write(Buffer.from('B'))
    await until(() => got === 'B')
    let told = 0
    port.poller.on('readable', () => told++)
    pty.write(Buffer.from('CD'))
    for (let n = 0; n < TURNS; n++) await turn()
    assert.ok(told <= 4, `told ${told} times in ${TURNS} turns`)
    assert.equal(got, 'B')
    await clock.advance(1000)
    await until(() => got === 'BCD')
  })

  // the system was asked either for bytes or for room, for what was wanted last: whom the other side had stopped heard nothing of it
  it('hears the other side that has stopped it, and goes on when it may', async () => {
    let given = 0
    let taken = 0
    let drained = 0
    pty.onData(bytes => (drained += bytes.length))
    const stopped = () => port.poller.listenerCount('writable') > 0
    pty.write(Buffer.of(DC3))
    await until(() => {
      if (given === taken && !stopped())
        open.write(Buffer.from('A'), error => (error ? assert.fail(error) : taken++), given++)
      return stopped()
    })
    for (const heard of ['B', 'BC']) {
      pty.write(Buffer.from(heard.at(-1)))
      await until(() => got === heard)
    }
    assert.equal(stopped(), true)
    pty.write(Buffer.of(DC1))
    await until(() => taken === given && drained === given)
  })
})
