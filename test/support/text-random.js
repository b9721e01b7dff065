'use strict'

/**
 * Random texts and values for all that reads what users and messages bring: addresses, types, items, tag tables, CSV, payloads, lists of IDs, settings. What
 * is not refused with a code has to be sound.
 */

const assert = require('node:assert/strict')
const lib = require('../../lib')
const { readSettings: c24Settings } = require('../../lib/device/c24-settings')
const { readSettings: chinoSettings } = require('../../lib/device/chino-settings')
const { readSettings: inconSettings } = require('../../lib/device/incon-settings')
const { readSettings: nxSettings } = require('../../lib/device/settings')
const { decodeValue, encodeValue } = require('../../lib/tag/value')
const { toolsOf } = require('./protocol-random')

const PIECES = [
  ...['M', 'K', 'W', 'R', 'S', 'L', 'TC', 'hr', 'ir', 'co', 'di', '@', '@bit:', '0x', '1FFF', '4', '400108', '000001'],
  ...[
    '0',
    '1',
    '7',
    '127',
    '65535',
    '99999999999',
    '-1',
    '.',
    '..',
    ':',
    '[',
    ']',
    '8',
    '12',
    ' ',
    '\t',
    '\r\n',
    ',',
    ';',
    '"'
  ],
  ...[
    'bool',
    'uint16',
    'int32',
    'float32',
    'string',
    'bcd16',
    'name',
    'address',
    'scale',
    'min',
    'maxStep',
    'writable',
    'true'
  ],
  ...[
    '__proto__',
    'constructor',
    'toString',
    'prototype',
    '${A}',
    'NaN',
    'Infinity',
    '1e308',
    '1,5',
    '\ufeff',
    '\0',
    '온도',
    '\ud800'
  ]
]

const SCALARS = [
  0,
  1,
  -1,
  0.5,
  65535,
  65536,
  1e308,
  NaN,
  Infinity,
  -0,
  true,
  false,
  null,
  undefined,
  '',
  'on',
  '0x1F',
  '1e3',
  'x',
  5n
]

const textOf = tools =>
  tools.below(4) === 0
    ? tools.bytes(tools.below(20)).toString(tools.pick(['latin1', 'utf8', 'utf16le']))
    : tools.list(tools.below(8), () => tools.pick(PIECES)).join('')

const valueOf = (tools, depth = 0) => {
  const kind = tools.below(depth > 2 ? 2 : 5)
  if (kind < 1) return tools.pick(SCALARS)
  if (kind < 2) return textOf(tools)
  if (kind < 3) return tools.list(tools.below(4), () => valueOf(tools, depth + 1))
  // JSON makes __proto__ an own property
  const object = JSON.parse(`{${tools.below(3) ? '' : '"__proto__":{"payload":1}'}}`)
  for (let n = tools.below(4); n > 0; n--) {
    const value = valueOf(tools, depth + 1)
    Object.defineProperty(object, textOf(tools), { value, enumerable: true, configurable: true, writable: true })
  }
  return object
}

const FIELDS = [
  'name',
  'label',
  'address',
  'type',
  'wordOrder',
  'byteOrder',
  'scale',
  'offset',
  'deadband',
  'writable',
  'min',
  'max',
  'maxStep'
]
const rowOf = tools =>
  Object.fromEntries(
    tools
      .list(tools.below(10), () => tools.pick(FIELDS))
      .concat('name', 'address')
      .map(field => [field, tools.below(3) ? textOf(tools) : valueOf(tools, 2)])
      .concat(
        tools.bit()
          ? [
              ['name', `t${tools.below(9)}`],
              ['address', tools.pick(['M0', 'K1:float32', '400001', 'hr5:int32'])]
            ]
          : []
      )
  )

const TAGS = [
  { name: 'temp', address: 'K10:int16', scale: 0.1, min: -10, max: 100 },
  { name: 'run', address: 'M5' }
]
const NX = lib.nxNotation({ tags: TAGS })
const MODBUS = lib.modbusNotation({ tags: [{ name: 'temp', address: '400005', scale: 0.1 }] })
const ITEMS = [
  ...['M0', 'K0', 'K0..K3', 'W10:float32', 'W20:string[8]', 'temp', 'M0..M15', 'K4:int32'].map(text =>
    lib.parseItem(text, NX)
  ),
  ...['400001', '000001', '400010:uint32', '401001.05', '400001..400004'].map(text => lib.parseItem(text, MODBUS))
]

/** Nearly an address: what only sounds like one is refused too early to find anything. */
const addressOf = tools => {
  const area = tools.pick(['M', 'K', 'W', 'R', 'L', 'S', 'TC', '@', '4', '0', '3', '1', 'hr', 'ir', 'co', 'di'])
  const number = tools.pick(['0', '1', '15', '127', '00108', '00016', '65535', '65536', '99999'])
  const bit = tools.below(4) ? '' : `.${tools.below(20)}`
  const range = tools.below(4) ? '' : `..${tools.bit() ? area : ''}${tools.below(200)}`
  const type = tools.below(3) ? '' : `:${tools.pick(['int16', 'float32', 'string[8]', 'bool', 'bcd32', 'string[999]'])}`
  const text = area + number + bit + range + type
  const at = tools.below(text.length)
  return tools.below(4) ? text : text.slice(0, at) + tools.pick(PIECES) + text.slice(at)
}

const isItem = item => {
  assert.ok(item.count >= 1 && item.count <= 65536, item.text)
  assert.match(item.name, /^[A-Za-z_]\w*$/, item.text)
  assert.ok(Number.isInteger(item.address) && item.address >= 0)
}

/** What is written to a value reads back so, where it was taken. */
const writeAndRead = tools => {
  const item = tools.pick(ITEMS)
  for (const raw of encodeValue(item, valueOf(tools))) {
    for (const word of raw)
      assert.ok(typeof word === 'boolean' || (Number.isInteger(word) && word >= 0 && word <= 0xffff))
    decodeValue(item, raw)
  }
}

const decodeAny = tools => {
  const item = tools.pick(ITEMS)
  const raw = item.kind === 'bit' ? [tools.bit()] : tools.list(item.type.words, tools.word)
  const answer = decodeValue(item, raw)
  assert.ok('value' in answer || answer.code === 'NOT_A_VALUE')
}

const isPrintable = text => assert.doesNotMatch(text, /[\p{Cc}\u2028\u2029\u202a-\u202e\u2066-\u2069]/u)

const csv = tools => {
  const rows = lib.tagsFromCsv(
    tools.bit() ? textOf(tools) : `name,address\n${textOf(tools)},${textOf(tools)}\n${textOf(tools)}`
  )
  lib.csvWarnings(rows, MODBUS)
  lib.csvWarnings(rows, NX)
  // what is written out is read back, cell by cell; lines of nothing but white space are none
  const full = rows.filter(row => Object.values(row).some(cell => cell.trim() !== ''))
  const again = lib.tagsFromCsv(lib.tagsToCsv(full))
  for (const [n, row] of full.entries())
    for (const [field, cell] of Object.entries(row)) assert.equal(again[n][field], cell)
}

const entries = tools => {
  const found = lib.entriesOf(
    { payload: valueOf(tools), topic: valueOf(tools, 2) },
    tools.bit() ? {} : { target: textOf(tools) }
  )
  assert.ok(found.length > 0)
  for (const { item, value } of found) {
    assert.equal(typeof item, 'string')
    for (const one of [value].flat()) assert.ok(['string', 'number', 'boolean'].includes(typeof one))
  }
}

const LINE_SETTINGS = [
  'transport',
  'path',
  'host',
  'port',
  'baudRate',
  'parity',
  'dataBits',
  'gap',
  'echo',
  'wire',
  'name'
]
const DEVICE_SETTINGS = [
  ...[
    'name',
    'station',
    'steps',
    'timeout',
    'attempts',
    'masterIds',
    'areas',
    'tags',
    'access',
    'writableRanges',
    'limits'
  ],
  ...[
    'protocol',
    'addressMode',
    'coilFunction',
    'end',
    'first',
    'last',
    'framing',
    'flow',
    'transparent',
    'encoding',
    'format'
  ],
  ...['quiet', 'silence', 'wordOrder', 'demoteAfter', 'writeInterval', 'bidirectional', 'checked']
]
/** One or two settings that are anything. */
const settingsOf = (tools, names) =>
  Object.fromEntries(tools.list(1 + tools.below(2), () => [tools.pick(names), valueOf(tools, tools.below(3))]))

/** Each may refuse with a code; nothing else. */
const READERS = {
  'NX items': tools => isItem(lib.parseItem(tools.bit() ? addressOf(tools) : textOf(tools), NX)),
  'MODBUS items': tools => isItem(lib.parseItem(tools.bit() ? addressOf(tools) : valueOf(tools), MODBUS)),
  types: tools => void lib.parseType(tools.bit() ? textOf(tools) : valueOf(tools)),
  'tag tables, NX': tools =>
    void lib.nxNotation({ tags: tools.below(4) ? tools.list(3, () => rowOf(tools)) : valueOf(tools) }),
  'tag tables, MODBUS': tools => void lib.modbusNotation({ tags: tools.list(3, () => rowOf(tools)) }),
  'area tables': tools =>
    void lib.areaMap(
      tools.bit()
        ? valueOf(tools)
        : tools.list(2, () => ({ area: textOf(tools), base: valueOf(tools, 2), words: valueOf(tools, 2) }))
    ),
  CSV: csv,
  payloads: entries,
  'lists of items': tools => void lib.itemsOf(valueOf(tools)),
  'values to write': writeAndRead,
  'values that were read': decodeAny,
  'lists of IDs': tools => void lib.masterIdsOf(tools.bit() ? textOf(tools) : valueOf(tools)),
  'settings of devices': tools => {
    const given = settingsOf(tools, DEVICE_SETTINGS)
    tools.pick([
      () => nxSettings({ station: 1, ...given }, 0.5),
      () => chinoSettings({ station: 1, ...given }),
      () => inconSettings(given),
      () => c24Settings(given, { flowControl: 'none', times: {} })
    ])()
  },
  'settings of lines': tools =>
    void lib.lineSettings({ path: 'COM3', host: 'h', port: 1, ...settingsOf(tools, LINE_SETTINGS) })
}

/**
 * @param {{ inputs: number, seed?: number }} options
 * @returns {{ inputs: number, taken: Record<string, number>, codes: Record<string, number> }} taken: what was not refused, by reader
 */
const textRandom = ({ inputs, seed = 1 }) => {
  const tools = toolsOf(seed)
  const names = Object.keys(READERS)
  const taken = Object.fromEntries(names.map(name => [name, 0]))
  /** @type {Record<string, number>} */
  const codes = {}
  for (let n = 0; n < inputs; n++) {
    const name = names[n % names.length]
    try {
      READERS[name](tools)
      taken[name]++
    } catch (error) {
      if (!(error instanceof lib.PlcError)) throw error
      codes[error.code] = (codes[error.code] ?? 0) + 1
      isPrintable(error.message)
    }
  }
  assert.equal(/** @type {any} */ ({}).payload, undefined)
  return { inputs, taken, codes }
}

module.exports = { textRandom }
