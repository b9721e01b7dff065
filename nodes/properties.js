'use strict'

/**
 * Every property of every node, in one table: the node reads its configuration through it, the dialog's validators are made of it (scripts/editor), a test
 * compares it with the defaults of the .html files, and docs/nodes.md lists it. Pure: it imports nothing, so that the browser can have it too.
 */

/** @typedef {{ kind: string, fallback: any, least?: number, most?: number, known?: string[], whole?: boolean, except?: [number, number], needed?: boolean, says?: string, isStation?: boolean, blank?: boolean }} Row */

const text = (fallback = '', more = {}) => ({ kind: 'text', fallback, ...more })
const number = (fallback, least, most, more = {}) => ({ kind: 'number', fallback, least, most, whole: true, ...more })
const choice = (fallback, ...known) => ({ kind: 'choice', fallback, known })
const flag = (fallback = false) => ({ kind: 'flag', fallback })
const list = () => ({ kind: 'list', fallback: [] })
/** Bytes as hexadecimal text; an empty one is none, not the default. */
const bytes = (fallback, most) => ({ kind: 'bytes', fallback, most, blank: true, says: `0 to ${most} bytes in hex` })
const node = () => ({ kind: 'node', fallback: '', needed: true })

/** When a silent station is demoted, and how often it is probed then. */
const HEALTH = {
  demoteAfter: number(3, 0, 100),
  probeFirst: number(5000, 100, 3600000),
  probeMost: number(60000, 100, 3600000)
}

/** What a node that reads has beside its device. */
const READING = {
  itemsType: choice('list', 'list', 'msg'),
  items: list(),
  interval: number(1000, 0, 86400000, { except: [1, 9], says: '0, or 10 to 86400000' }),
  format: choice('object', 'object', 'message', 'envelope', 'list'),
  badValues: choice('omit', 'omit', 'null'),
  ranges: choice('array', 'array', 'values'),
  booleans: choice('boolean', 'boolean', 'number'),
  report: choice('all', 'all', 'changed', 'allOnChange'),
  maxSilence: number(0, 0, 86400000)
}

/** What a node that writes has beside its device. */
const WRITING = {
  target: text(),
  verify: flag(),
  onFailure: choice('error', 'error', 'output'),
  acceptRetained: flag(),
  coalesce: flag(),
  topic: choice('item', 'item', 'keep', 'fixed'),
  topicText: text()
}

/** What a node that sends and receives messages has beside its framing. */
const SENDING = {
  access: choice('read', 'read', 'write'),
  onFailure: choice('error', 'error', 'output'),
  acceptRetained: flag()
}

/** @type {Record<string, Record<string, Row>>} */
const PROPERTIES = {
  'plc-line': {
    name: text(),
    transport: choice('serial', 'serial', 'tcp', 'simulated'),
    path: text('', { needed: true }),
    baudRate: number(19200, 50, 4000000),
    dataBits: choice('8', '8', '7'),
    parity: choice('none', 'none', 'even', 'odd'),
    stopBits: choice('1', '1', '2'),
    host: text('', { needed: true }),
    port: number(4001, 1, 65535),
    gap: number(0, 0, 10000, { whole: false }),
    echo: choice('auto', 'auto', 'on', 'off'),
    flowControl: choice('none', 'none', 'rtscts', 'xonxoff'),
    dtr: choice('unchanged', 'unchanged', 'on', 'off'),
    rts: choice('unchanged', 'unchanged', 'on', 'off'),
    openDelay: number(0, 0, 60000),
    slack: number(0, 0, 60000),
    latenessBound: number(0, 0, 3600000),
    queueLimit: number(1000, 1, 100000),
    writesBeforePoll: number(4, 1, 1000)
  },
  'nx-config': {
    name: text(),
    line: node(),
    station: number('', 0, 255, { except: [192, 254], says: '0 to 191, or 255', needed: true, isStation: true }),
    steps: choice('2', '2', '4'),
    timeout: number(3000, 10, 600000),
    attempts: number(3, 1, 20),
    ...HEALTH,
    masterIds: text('E2..E9'),
    soleMaster: flag(),
    access: choice('read', 'read', 'write'),
    writableRanges: text(),
    writeInterval: number(0, 0, 3600000),
    readWords: number(128, 1, 128),
    writeWords: number(64, 1, 127),
    readBits: number(255, 1, 255),
    writeBits: number(254, 1, 254),
    areas: list(),
    tags: list()
  },
  'chino-config': {
    name: text(),
    line: node(),
    station: number('', 0, 247, { needed: true, isStation: true }),
    protocol: choice('rtu', 'rtu', 'ascii'),
    timeout: number(1000, 10, 600000),
    sendWait: number(0, 0, 10000),
    attempts: number(3, 1, 20),
    ...HEALTH,
    probe08: flag(),
    addressMode: choice('1-base', '1-base', '0-base'),
    coilRead: number(2000, 1, 2000),
    coilUnit: number(1, 1, 2000),
    coilFunction: choice('0F', '0F', '05', 'auto'),
    coilWrite: number(1968, 1, 1968),
    discreteRead: number(2000, 1, 2000),
    discreteUnit: number(1, 1, 2000),
    inputRead: number(125, 1, 125),
    holdingRead: number(125, 1, 125),
    holdingFunction: choice('10', '10', '06', 'auto'),
    holdingWrite: number(123, 1, 123),
    wordOrder: choice('low', 'low', 'high'),
    broadcast: flag(),
    turnaround: number(100, 0, 10000),
    access: choice('read', 'read', 'write'),
    writableRanges: text(),
    writeInterval: number(0, 0, 3600000),
    tags: list()
  },
  'nx-read': { name: text(), plc: node(), ...READING },
  'nx-write': { name: text(), plc: node(), ...WRITING },
  'chino-regulator': {
    name: text(),
    regulator: node(),
    mode: choice('read', 'read', 'write', 'both'),
    ...READING,
    ...WRITING
  },
  'melsec-c24': {
    name: text(),
    line: node(),
    bidirectional: flag(),
    framing: choice('end', 'end', 'count', 'gap'),
    end: bytes('0D 0A', 2),
    count: number(0, 0, 16384),
    gap: number(0, 0, 60000),
    format: choice('text', 'text', 'bytes', 'words'),
    encoding: choice('latin1', 'latin1', 'utf8', 'ascii', 'euc-kr', 'shift_jis'),
    unit: choice('word', 'word', 'byte'),
    ...SENDING,
    padEven: flag(),
    quiet: number(0, 0, 60000),
    timer0: number(0, 0, 600000),
    tornEnd: flag(),
    flow: choice('none', 'none', 'dc', 'driver'),
    transparent: bytes('', 11),
    room: number(64, 1, 4095),
    stallLimit: number(30000, 100, 3600000),
    asciiBinary: flag(),
    first: bytes('', 80),
    last: bytes('', 80),
    most: number(16384, 1, 65536),
    sumCheck: flag(true),
    ackTimeout: number(1000, 10, 600000),
    attempts: number(3, 1, 20),
    repeatUnanswered: flag(),
    priority: choice('both', 'both', 'c24', 'us'),
    repeats: choice('mark', 'mark', 'drop'),
    repeatAfter: number(0, 0, 3600000),
    repeatWithin: number(10000, 0, 3600000)
  },
  'incon-link': {
    name: text(),
    line: node(),
    encoding: choice('ascii', 'ascii', 'latin1', 'utf8'),
    checked: flag(),
    acknowledge: flag(),
    ackTimeout: number(1000, 10, 600000),
    attempts: number(5, 1, 100),
    most: number(256, 2, 4096),
    silence: number(200, 0, 60000),
    ...SENDING,
    scan: number(100, 0, 10000),
    quiet: number(50, 0, 60000),
    before: number(5, 0, 60000)
  },
  'plc-monitor': {
    name: text(),
    line: node(),
    events: choice('all', 'all', 'faults', 'audit', 'none'),
    interval: number(10000, 0, 86400000, { except: [1, 99], says: '0, or 100 to 86400000' }),
    trace: flag()
  }
}

const VARIABLE = /^\$\{([^}]+)\}$/

const readNumber = (row, given) => {
  const value = typeof given === 'number' ? given : Number(String(given).trim())
  if (!Number.isFinite(value)) return { problem: 'number' }
  if (row.whole && !Number.isInteger(value)) return { problem: 'whole' }
  if (value < row.least || value > row.most) return { problem: 'range' }
  if (row.except && value >= row.except[0] && value <= row.except[1]) return { problem: 'except' }
  return { value }
}

const readFlag = given => {
  if (given === true || given === 'true') return { value: true }
  return given === false || given === 'false' ? { value: false } : { problem: 'flag' }
}

const readChoice = (row, given) =>
  row.known.includes(String(given)) ? { value: String(given) } : { problem: 'choice' }

const HEX = /^(?:[0-9a-f]{2})*$/i

const readBytes = (row, given) => {
  const digits = String(given).replace(/\s/g, '')
  const known = HEX.test(digits) && digits.length <= row.most * 2
  return known ? { value: (digits.match(/../g) ?? []).join(' ').toUpperCase() } : { problem: 'bytes' }
}

const READERS = {
  bytes: readBytes,
  number: readNumber,
  choice: readChoice,
  flag: (_row, given) => readFlag(given),
  list: (_row, given) => (Array.isArray(given) ? { value: given } : { problem: 'list' }),
  node: (_row, given) => ({ value: String(given) }),
  text: (_row, given) => ({ value: String(given).trim() })
}

/**
 * Reads one property as it was saved: missing or empty means its default, numbers and flags may be texts, `${NAME}` is a variable that was not filled in.
 * @param {Row} row
 * @param {any} given
 * @returns {{ value?: any, problem?: string, variable?: string }} `problem`: missing, number, whole, range, except, flag, choice, list or bytes
 */
const readProperty = (row, given) => {
  const empty = typeof given === 'string' && given.trim() === '' && !row.blank
  const missing = given === undefined || given === null || empty
  if (missing)
    return row.needed && row.fallback === '' ? { problem: 'missing', value: row.fallback } : { value: row.fallback }
  const variable = typeof given === 'string' ? VARIABLE.exec(given.trim()) : null
  if (variable) return { variable: variable[1] }
  return READERS[row.kind](row, given)
}

/**
 * What a property may be, for the text of an error.
 * @param {Row} row
 */
const allowed = row => {
  if (row.says) return row.says
  if (row.kind === 'number') return `${row.least} to ${row.most}`
  return row.known ? row.known.join(', ') : row.kind
}

// which transport a property of a line counts for
const TRANSPORTS = { path: 'serial', host: 'tcp', port: 'tcp' }

const unused = (mode, name) => (mode === 'read' && name in WRITING) || (mode === 'write' && name in READING)

const UNIDIRECTIONAL = ['framing', 'end', 'count', 'first', 'last', 'timer0', 'tornEnd']
const BIDIRECTIONAL = [
  ...['sumCheck', 'ackTimeout', 'attempts', 'repeatUnanswered', 'priority'],
  ...['repeats', 'repeatAfter', 'repeatWithin']
]
const FRAMINGS = { end: 'end', count: 'count' }

const isOn = value => value === true || value === 'true'

const unusedByC24 = (name, { framing = 'end', bidirectional = false }) => {
  if (isOn(bidirectional)) return UNIDIRECTIONAL.includes(name)
  return BIDIRECTIONAL.includes(name) || (Boolean(FRAMINGS[name]) && FRAMINGS[name] !== framing)
}

const ACKNOWLEDGED = ['ackTimeout', 'attempts']

/**
 * Whether a property counts at all with the others as they are.
 * @param {string} type @param {string} name @param {Record<string, any>} config
 */
const applies = (type, name, config) => {
  if (type === 'melsec-c24') return !unusedByC24(name, config)
  if (type === 'incon-link') return !ACKNOWLEDGED.includes(name) || isOn(config.acknowledge)
  if (type === 'plc-line') return !TRANSPORTS[name] || TRANSPORTS[name] === (config.transport || 'serial')
  return type !== 'chino-regulator' || !unused(config.mode || 'read', name)
}

module.exports = { PROPERTIES, readProperty, allowed, applies }
