'use strict'

/** Our regulator device against MODBUS stations made by others. What they hold is set and looked at past our code. */

const assert = require('node:assert/strict')
const { createPool, openChinoRegulator } = require('../../lib')
const { createRandom } = require('../../lib/sim')
const { until } = require('../support/node-red.js')
const { SLAVES } = require('./slaves.js')

const SEED = Number(process.env.SERIAL_PLC_SEED ?? Math.floor(Math.random() * 0x7fffffff))
const STATIONS = [11, 12, 13]
const ABSENT = 77
const CALLS = 200
const TABLES = { co: 1, di: 2, hr: 3, ir: 4 }
const isBits = table => table === 'co' || table === 'di'

// what the exceptions of the MODBUS specification mean here
const EXCEPTIONS = [
  { code: 1, is: 'MODBUS_ILLEGAL_FUNCTION' },
  { code: 2, is: 'MODBUS_ILLEGAL_ADDRESS' },
  { code: 3, is: 'MODBUS_ILLEGAL_VALUE' },
  { code: 4, is: 'MODBUS_DEVICE_FAILURE', unknown: true },
  { code: 5, is: 'MODBUS_ACKNOWLEDGE', again: true, unknown: true },
  { code: 6, is: 'MODBUS_BUSY', again: true },
  { code: 7, is: 'MODBUS_NEGATIVE_ACKNOWLEDGE' },
  { code: 8, is: 'MODBUS_MEMORY_PARITY' },
  { code: 10, is: 'MODBUS_GATEWAY_PATH' },
  { code: 11, is: 'MODBUS_GATEWAY_TARGET', unknown: true }
]

const good = results => {
  for (const { item, quality, code, text } of results) assert.equal(quality, 'good', `${item}: ${code} ${text}`)
  return results.map(({ value }) => value)
}
const confirmed = outcome => assert.equal(outcome.outcome, 'confirmed', JSON.stringify(outcome))

for (const { name, protocol, start } of SLAVES) {
  describe(`MODBUS against ${name}`, function () {
    this.timeout(60000)
    const random = createRandom(SEED)
    const opened = []
    let slave, pool
    /** A device of ours; the first one keeps the line open. */
    const open = (own = {}) => {
      const settings = { protocol, timeout: 1000, access: 'write', station: STATIONS[0], addressMode: '1-base' }
      opened.push(openChinoRegulator({ ...slave.line, pool, ...settings, ...own }))
      return opened.at(-1)
    }
    const some = (table, count) =>
      Array.from({ length: count }, () => (isBits(table) ? random.chance(0.5) : random.integer(0, 65535)))
    const fill = async (table, base, count, station = STATIONS[0]) => {
      const values = some(table, count)
      await slave.set(station, table, base, values)
      return values
    }

    before(async () => {
      slave = await start({ stations: STATIONS })
      pool = createPool()
      open()
    })
    after(async () => {
      await Promise.all(opened.map(device => device.close()))
      await slave?.stop()
    })
    beforeEach(() => slave.log())

    it(`reads every table, in every notation (seed ${SEED})`, async () => {
      const held = [
        await fill('co', 19, 37),
        await fill('di', 196, 22),
        await fill('ir', 8, 1),
        await fill('hr', 107, 3)
      ]
      const is = [held[0], held[1], held[2][0], held[3]]
      const explicit = ['co19..co55', 'di196..di217', 'ir8', 'hr107..hr109']
      const panel = ['000020..000056', '100197..100218', '300009', '400108..400110']
      const five = ['00020..00056', '10197..10218', '30009', '40108..40110']
      for (const items of [explicit, panel, five]) assert.deepEqual(good(await open().read(items)), is)
      const zero = ['000019..000055', '100196..100217', '300008', '400107..400109']
      assert.deepEqual(good(await open({ addressMode: '0-base' }).read(zero)), is)
      const asked = (await slave.log()).slice(0, 4).toSorted((a, b) => a[1] - b[1])
      assert.deepEqual(asked, [
        [11, 1, 19, 37],
        [11, 2, 196, 22],
        [11, 3, 107, 3],
        [11, 4, 8, 1]
      ])
    })

    it('writes with 05, 0F, 06 and 10', async () => {
      const single = open({ coilFunction: '05', holdingFunction: '06' })
      const several = open({ coilFunction: '0F', holdingFunction: '10' })
      confirmed(await single.write({ co300: true, hr300: 0xabcd }))
      confirmed(await several.write({ co310: true, hr310: 0x1234 }))
      confirmed(await several.write({ 'co320..co322': [true, false, true], 'hr320..hr322': [1, 2, 3] }))
      confirmed(await single.write({ 'hr330..hr332': [4, 5, 6] }))
      const was = (await slave.log()).filter(([, fn]) => fn > 4).toSorted((a, b) => a[1] - b[1] || a[2] - b[2])
      assert.deepEqual(was, [
        [11, 5, 300, 1],
        [11, 6, 300, 1],
        [11, 6, 330, 1],
        [11, 6, 331, 1],
        [11, 6, 332, 1],
        [11, 15, 310, 1],
        [11, 15, 320, 3],
        [11, 16, 310, 1],
        [11, 16, 320, 3]
      ])
      assert.deepEqual(await slave.get(11, 'co', 300, 1), [true])
      assert.deepEqual(await slave.get(11, 'co', 310, 1), [true])
      assert.deepEqual(await slave.get(11, 'co', 320, 3), [true, false, true])
      assert.deepEqual(await slave.get(11, 'hr', 300, 1), [0xabcd])
      assert.deepEqual(await slave.get(11, 'hr', 310, 1), [0x1234])
      assert.deepEqual(await slave.get(11, 'hr', 320, 3), [1, 2, 3])
      assert.deepEqual(await slave.get(11, 'hr', 330, 3), [4, 5, 6])
    })

    it('one bit of a register is changed, the others stay', async () => {
      await slave.set(11, 'hr', 340, [0b1010_0000_0000_0101])
      confirmed(await open().write({ 'hr340.05': true, 'hr340.15': false }))
      assert.deepEqual(await slave.get(11, 'hr', 340, 1), [0b0010_0000_0010_0101])
      assert.deepEqual(good(await open().read(['hr340.05', 'hr340.15', 'hr340.00'])), [true, false, true])
    })

    it('the most that fits: 2000 bits and 125 registers read, 1968 and 123 written, each in one frame', async () => {
      const at = { co: 63536, di: 63536, ir: 65411, hr: 65411 }
      const device = open()
      for (const [table, fn] of Object.entries(TABLES)) {
        const count = isBits(table) ? 2000 : 125
        const held = await fill(table, at[table], count)
        await slave.log()
        const [value] = good(await device.read([`${table}${at[table]}..${table}65535`]))
        assert.deepEqual(value, held)
        assert.deepEqual(await slave.log(), [[11, fn, at[table], count]])
      }
      for (const [table, fn, count] of [
        ['co', 15, 1968],
        ['hr', 16, 123]
      ]) {
        // prettier-ignore
        const values = some(table, count)
        confirmed(await device.write({ [`${table}1000..${table}${999 + count}`]: values }))
        assert.deepEqual(await slave.get(11, table, 1000, count), values)
        assert.deepEqual(await slave.log(), [[11, fn, 1000, count]])
      }
    })

    it('one more than fits goes in two frames', async () => {
      const held = await fill('hr', 2000, 126)
      assert.deepEqual(good(await open().read(['hr2000..hr2125'])), [held])
      assert.equal((await slave.log()).length, 2)
      const values = some('hr', 124)
      confirmed(await open().write({ 'hr2200..hr2323': values }))
      assert.deepEqual(await slave.get(11, 'hr', 2200, 124), values)
    })

    for (const { code, is, again, unknown } of EXCEPTIONS) {
      it(`exception ${code.toString(16).padStart(2, '0')} of a read and of a write`, async () => {
        const device = open()
        await slave.set(11, 'hr', 700, [5])
        await slave.refuse({ station: 11, base: 700, code, times: again ? 3 : 1 })
        const [result] = await device.read(['hr700'])
        assert.deepEqual([result.quality, result.code], ['bad', is])
        // it was asked as often as that, not more and not less
        assert.deepEqual(good(await device.read(['hr700'])), [5])

        await slave.refuse({ station: 11, base: 700, code })
        const outcome = await device.write({ hr700: 6 })
        const wanted = unknown ? ['unknown', 'WRITE_UNKNOWN'] : ['refused', is]
        assert.deepEqual([outcome.outcome, outcome.code], wanted, JSON.stringify(outcome))
        assert.deepEqual(await slave.get(11, 'hr', 700, 1), [5])
      })
    }

    it('busy once: asked again', async () => {
      await slave.set(11, 'ir', 710, [17])
      await slave.refuse({ station: 11, base: 710, code: 6 })
      assert.deepEqual(good(await open().read(['ir710'])), [17])
    })

    it('32-bit values in both orders', async () => {
      const bytes = Buffer.alloc(12)
      bytes.writeFloatBE(-123.4375, 0)
      bytes.writeUInt32BE(0x89abcdef, 4)
      bytes.writeInt32BE(-2, 8)
      const words = Array.from({ length: 6 }, (_, n) => bytes.readUInt16BE(2 * n))
      const swapped = [1, 0, 3, 2, 5, 4].map(n => words[n])
      const orders = [
        ['high', words],
        ['low', swapped]
      ]
      for (const [wordOrder, is] of orders) {
        const device = open({ wordOrder })
        for (const table of ['hr', 'ir']) {
          await slave.set(11, table, 800, is)
          const items = [`${table}800:float32`, `${table}802:uint32`, `${table}804:int32`]
          assert.deepEqual(good(await device.read(items)), [-123.4375, 0x89abcdef, -2])
        }
        confirmed(await device.write({ 'hr810:float32': -123.4375, 'hr812:uint32': 0x89abcdef, 'hr814:int32': -2 }))
        assert.deepEqual(await slave.get(11, 'hr', 810, 6), is)
      }
    })

    it('words made of coils', async () => {
      // 8001h: the lowest coil is bit 0
      await slave.set(11, 'co', 901, [true, ...new Array(14).fill(false), true])
      assert.deepEqual(good(await open().read(['co901:uint16'])), [0x8001])
      confirmed(await open().write({ 'co931:uint16': 0x4003 }))
      const is = [true, true, ...new Array(12).fill(false), true, false]
      assert.deepEqual(await slave.get(11, 'co', 931, 16), is)
    })

    it('an absent station times out; the others go on meanwhile', async () => {
      const absent = open({ station: ABSENT, timeout: 300, attempts: 2 })
      const device = open()
      const held = await fill('hr', 400, 4)
      const asked = absent.read(['hr400'])
      const rounds = []
      let over = false
      asked.finally(() => (over = true))
      while (!over) rounds.push(good(await device.read(['hr400..hr403']))[0])
      const [result] = await asked
      assert.deepEqual([result.quality, result.code], ['bad', 'TIMEOUT'])
      assert.ok(rounds.length > 5, `${rounds.length} rounds`)
      for (const value of rounds) assert.deepEqual(value, held)
      const outcome = await absent.write({ hr400: 1 })
      assert.deepEqual([outcome.outcome, outcome.code], ['unknown', 'WRITE_UNKNOWN'])
    })

    if (name.startsWith('pymodbus')) {
      it('a station that pymodbus says it does not have', async () => {
        await slave.absent(false)
        const [result] = await open({ station: ABSENT }).read(['hr400'])
        assert.deepEqual([result.quality, result.code], ['bad', 'MODBUS_DEVICE_FAILURE'])
        await slave.absent(true)
      })
    }

    it('a broadcast reaches all stations; none confirms it', async () => {
      const all = open({ station: 0, broadcast: true })
      const own = open()
      const before = own.line.stats().timeouts
      const outcome = await all.write({ 'hr500..hr502': [7, 8, 9], co500: true })
      assert.deepEqual([outcome.outcome, outcome.code], ['unknown', 'BROADCAST_UNCONFIRMED'])
      assert.equal(own.line.stats().timeouts, before)
      for (const station of STATIONS) {
        const holds = async () => (await slave.get(station, 'hr', 500, 3)).join() === '7,8,9'
        await until(holds, { what: () => `the broadcast at ${station}`, patience: 2000 })
        assert.deepEqual(await slave.get(station, 'co', 500, 1), [true])
        const device = open({ station })
        assert.deepEqual(good(await device.read(['hr500..hr502', 'co500'])), [[7, 8, 9], true])
      }
      await assert.rejects(all.read(['hr500']), { code: 'BROADCAST_REFUSED' })
    })

    it(`${CALLS} calls at once from two devices of each station: every value is what the station holds`, async () => {
      const held = new Map()
      for (const station of STATIONS)
        for (const table of Object.keys(TABLES)) held.set(`${station} ${table}`, await fill(table, 3000, 200, station))
      const devices = STATIONS.flatMap(station => [open({ station }), open({ station })])
      const { timeouts: wereLost, ...counts } = devices[0].line.stats()
      const before = {
        timeouts: wereLost,
        crcErrors: counts.crcErrors,
        incomplete: counts.incomplete,
        late: counts.late
      }
      const written = []
      const reading = device => {
        const table = random.pick(Object.keys(TABLES))
        const at = random.integer(0, 150)
        const count = random.integer(1, 50)
        const range = `${table}${3000 + at}..${table}${3000 + at + count - 1}`
        return device.read([count > 1 ? range : `${table}${3000 + at}`]).then(results => {
          const is = held.get(`${device.device.station} ${table}`).slice(at, at + count)
          assert.deepEqual(good(results), [count > 1 ? is : is[0]])
        })
      }
      const writing = (device, n) => {
        const table = random.pick(['co', 'hr'])
        const values = some(table, 4)
        const base = 4000 + n * 4
        written.push({ station: device.device.station, table, base, values })
        return device.write({ [`${table}${base}..${table}${base + 3}`]: values }).then(confirmed)
      }
      const calls = Array.from({ length: CALLS }, (_, n) => {
        const device = random.pick(devices)
        return random.chance(0.3) ? writing(device, n) : reading(device)
      })
      await Promise.all(calls)
      assert.ok(written.length > 20)
      for (const { station, table, base, values } of written)
        assert.deepEqual(await slave.get(station, table, base, 4), values, `${station} ${table}${base}`)
      const { timeouts, crcErrors, incomplete, late } = devices[0].line.stats()
      assert.deepEqual({ timeouts, crcErrors, incomplete, late }, before)
    })
  })
}
