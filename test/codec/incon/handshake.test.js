'use strict'

const assert = require('node:assert')
const {
  createHandshake,
  createM68Example,
  createNcReceiver,
  createNcSender,
  createReceiveExample,
  createSendProgram
} = require('../../../lib/codec/incon/handshake')

// 2.14.3: serialLinkSend->buffer = 'T' 'e' 's' 't' '\r' '\n', length 6
const TEST = Buffer.from([0x54, 0x65, 0x73, 0x74, 0x0d, 0x0a])

describe('INCON SerialLinkSend', () => {
  it('the example program M68: buffer, length 6, then finish, then length 0; finish stays', () => {
    const link = createHandshake()
    const nc = createNcSender(link)
    const plc = createM68Example(link)
    const mCode = { flag: true, data: 68, finish: 0 }
    assert.strictEqual(nc.look(), null)
    plc.scan(mCode)
    assert.deepStrictEqual([link.length, link.finish, mCode.finish], [6, 0, 0])
    assert.deepStrictEqual(nc.look(), TEST)
    assert.strictEqual(nc.look(), null)
    plc.scan(mCode)
    assert.deepStrictEqual([link.length, mCode.finish, nc.sending], [6, 0, true])
    nc.sent()
    assert.strictEqual(link.finish, 1)
    plc.scan(mCode)
    assert.deepStrictEqual([link.length, link.finish, mCode.finish], [0, 1, 1])
    assert.strictEqual(nc.look(), null)
  })

  it('a length that stays is sent once, and again after it was zero', () => {
    const link = createHandshake()
    const nc = createNcSender(link)
    link.buffer.write('A')
    link.length = 1
    assert.strictEqual(`${nc.look()}`, 'A')
    nc.sent()
    assert.deepStrictEqual([nc.look(), link.length, link.finish], [null, 1, 1])
    link.length = 0
    assert.strictEqual(nc.look(), null)
    link.length = 1
    assert.strictEqual(`${nc.look()}`, 'A')
  })

  it('a text that was handed over is not exchanged while it is sent', () => {
    const link = createHandshake()
    const plc = createSendProgram(link)
    plc.scan(Buffer.from('ABC'))
    plc.scan(Buffer.from('DE'))
    assert.deepStrictEqual([link.length, `${link.buffer.subarray(0, 3)}`], [3, 'ABC'])
  })

  it('a length beyond the buffer: as many bytes as it has', () => {
    const link = createHandshake()
    assert.strictEqual(link.buffer.length, 256)
    createSendProgram(link).scan(Buffer.alloc(300, 0x41))
    assert.strictEqual(link.length, 256)
    link.length = 1000
    assert.strictEqual(createNcSender(link).look()?.length, 256)
  })

  it('of the two programs only the one of the manual leaves finish, unless told otherwise', () => {
    const mCode = { flag: true, data: 68, finish: 0 }
    for (const [make, finish] of /** @type {[any, number][]} */ ([
      [link => createM68Example(link), 1],
      [link => createM68Example(link, { clears: 'finish' }), 0],
      [link => createSendProgram(link), 0],
      [link => createSendProgram(link, { clears: 'length' }), 1]
    ])) {
      const link = createHandshake()
      const plc = make(link)
      const scan = () => plc.scan(make.toString().includes('M68') ? mCode : TEST)
      scan()
      link.finish = 1
      scan()
      assert.deepStrictEqual([link.length, link.finish], [0, finish], make.toString())
    }
  })

  it('other M codes send nothing', () => {
    const link = createHandshake()
    const plc = createM68Example(link)
    plc.scan({ flag: true, data: 67, finish: 0 })
    plc.scan({ flag: false, data: 68, finish: 0 })
    assert.strictEqual(link.length, 0)
  })

  /** Scans until the program takes the text for sent; the NC looks after each scan. */
  const scansUntilDone = (plc, nc, text) => {
    for (let scans = 1; scans < 10; scans++) {
      const done = plc.scan(text)
      const begun = nc.look()
      if (done) return { scans, stillSending: nc.sending }
      // a line takes three scans
      if (begun) nc.left = 3
      else if (nc.sending && --nc.left === 0) nc.sent()
    }
    return null
  }

  it('a stale finish tells of the second text at once that it was sent; cleared, it does not', () => {
    for (const [clears, stillSending] of /** @type {[any, boolean][]} */ ([
      ['length', true],
      ['finish', false]
    ])) {
      const link = createHandshake()
      const nc = /** @type {any} */ (createNcSender(link))
      const plc = createSendProgram(link, { clears })
      assert.strictEqual(scansUntilDone(plc, nc, TEST)?.stillSending, false, clears)
      assert.strictEqual(scansUntilDone(plc, nc, TEST)?.stillSending, stillSending, clears)
    }
  })

  it('a program without anything to send leaves the structure alone', () => {
    const link = createHandshake()
    link.finish = 1
    assert.strictEqual(createSendProgram(link).scan(null), false)
    assert.deepStrictEqual([link.length, link.finish], [0, 1])
  })

  it('after a stale finish the next text never reaches the line', () => {
    const link = createHandshake()
    const nc = createNcSender(link)
    const plc = createSendProgram(link, { clears: 'length' })
    link.finish = 1
    plc.scan(Buffer.from('A'))
    assert.strictEqual(`${nc.look()}`, 'A')
    assert.strictEqual(plc.scan(Buffer.from('A')), true)
    nc.look()
    plc.scan(Buffer.from('B'))
    assert.strictEqual(nc.look(), null)
    assert.strictEqual(plc.scan(Buffer.from('B')), true)
    nc.sent()
    assert.strictEqual(nc.look(), null)
  })
})

describe('INCON SerialLinkRecv', () => {
  const setUp = (options = {}) => {
    const link = createHandshake()
    return { link, nc: createNcReceiver(link, options), plc: createReceiveExample(link, options) }
  }

  it('the receiving example: a line feed as the last byte is a message; finish; length 0; finish cleared', () => {
    const { link, nc, plc } = setUp()
    nc.put(Buffer.from('Te'))
    assert.strictEqual(plc.scan(), null)
    nc.put(Buffer.from('st\r\n'))
    assert.deepStrictEqual(plc.scan(), { bytes: TEST, shown: 'Test\r\n', full: false })
    assert.deepStrictEqual([link.length, link.finish], [6, 1])
    nc.look()
    assert.deepStrictEqual([link.length, link.finish], [0, 1])
    assert.strictEqual(plc.scan(), null)
    assert.deepStrictEqual([link.length, link.finish, nc.lost], [0, 0, 0])
  })

  it('without an option, what comes before finish is cleared is not kept', () => {
    const link = createHandshake()
    const nc = createNcReceiver(link)
    nc.put(Buffer.from('A'))
    link.finish = 1
    nc.put(Buffer.from('B'))
    nc.look()
    assert.deepStrictEqual([link.length, nc.lost], [0, 1])
    link.finish = 0
    nc.put(Buffer.from('C'))
    assert.deepStrictEqual([link.length, nc.lost], [1, 1])
  })

  it('a full buffer is shown whole, though the NUL comes a byte too far; one that begins with a NUL shows nothing', () => {
    const full = setUp()
    full.nc.put(Buffer.alloc(256, 0x78))
    assert.strictEqual(full.plc.scan()?.shown, 'x'.repeat(256))
    const empty = setUp()
    empty.nc.put(Buffer.from('\0\n'))
    assert.strictEqual(empty.plc.scan()?.shown, '')
    const zeros = setUp()
    zeros.nc.put(Buffer.alloc(256))
    zeros.plc.scan()
    assert.strictEqual(zeros.plc.overwritten, 0)
  })

  it('two lines that are there at one scan are one message; a line and a half none yet', () => {
    const { nc, plc } = setUp()
    nc.put(Buffer.from('A\r\nB'))
    assert.strictEqual(plc.scan(), null)
    nc.put(Buffer.from('\r\n'))
    assert.strictEqual(`${plc.scan()?.bytes}`, 'A\r\nB\r\n')
  })

  it('a full buffer is a message; what comes beyond it is lost; strCopy writes past its array', () => {
    const { link, nc, plc } = setUp()
    nc.put(Buffer.alloc(300, 0x78))
    assert.deepStrictEqual([link.length, nc.lost], [256, 44])
    const message = plc.scan()
    assert.deepStrictEqual([message?.full, message?.bytes.length, plc.overwritten], [true, 256, 1])
  })

  it('255 bytes do not overwrite anything', () => {
    const { nc, plc } = setUp()
    nc.put(Buffer.concat([Buffer.alloc(253, 0x78), Buffer.from('\r\n')]))
    assert.strictEqual(plc.scan()?.bytes.length, 255)
    assert.strictEqual(plc.overwritten, 0)
  })

  it('strCopy stops at a NUL, and shows one letter of a longer message before', () => {
    const { nc, plc } = setUp()
    const take = text => {
      nc.put(Buffer.from(text))
      const message = plc.scan()
      nc.look()
      plc.scan()
      return message?.shown
    }
    assert.strictEqual(take('ABCDEF\r\n'), 'ABCDEF\r\n')
    assert.strictEqual(take('XY\r\n'), 'XY\r\nE')
    assert.strictEqual(take('P\0Q\r\n'), 'P')
  })

  it('what comes before the PLC has cleared finish: lost, or kept', () => {
    for (const [restart, length, lost] of /** @type {[any, number, number][]} */ ([
      ['always', 0, 2],
      ['once', 2, 0]
    ])) {
      const { link, nc, plc } = setUp({ restart })
      nc.put(Buffer.from('A\n'))
      plc.scan()
      nc.look()
      nc.put(Buffer.from('B\n'))
      assert.deepStrictEqual([link.length, nc.lost], [length, lost], restart)
    }
  })

  it('a finish that is never cleared: nothing is received any more, or messages run together', () => {
    const shown = { always: [], once: [] }
    for (const restart of /** @type {any[]} */ (Object.keys(shown))) {
      const { nc, plc } = setUp({ restart, clears: false })
      for (const text of ['A\n', 'B\n', 'C\n']) {
        nc.put(Buffer.from(text))
        const message = plc.scan()
        if (message) shown[restart].push(`${message.bytes}`)
        nc.look()
        plc.scan()
      }
    }
    assert.deepStrictEqual(shown, { always: ['A\n'], once: ['A\n', 'B\n', 'B\nC\n'] })
  })
})
