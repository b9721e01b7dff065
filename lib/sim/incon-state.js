'use strict'

const { START } = require('../codec/incon/check')
const {
  createHandshake,
  createM68Example,
  createNcReceiver,
  createNcSender,
  createReceiveExample,
  createSendProgram
} = require('../codec/incon/handshake')
const { PlcError } = require('../error')
const { createRandom } = require('./random')
const { checkStation } = require('./station')

/** What a simulated controller (incon-controller.js) is made of: its settings, checked, and all that it holds. */

const NUMBERS = { least: 1, most: 247, what: 'a simulated controller' }

function prepare(settings) {
  const { clock, station = 1, scan = 10, restart = 'always', clears = 'finish', ...rest } = settings
  checkStation(station, NUMBERS)
  number('scan', scan, { least: 1, most: 1000 })
  oneOf('restart', restart, ['always', 'once'])
  oneOf('clears', clears, ['finish', 'length'])
  const { receiveClears = true } = rest
  return {
    phase: 0,
    answer: 'none',
    events: [],
    every: 0,
    checked: false,
    acknowledge: false,
    ackTimeout: 1000,
    listens: 0,
    attempts: 5,
    random: createRandom(1),
    keep: 1000,
    onMessage: null,
    ...rest,
    clock,
    station: Number(station),
    scan,
    ...structures({ restart, clears, receiveClears }),
    ...emptyState()
  }
}

/** Both structures, with the NC's side and the PLC's programs. */
function structures({ restart, clears, receiveClears }) {
  const send = createHandshake()
  const recv = createHandshake()
  return {
    send,
    recv,
    ncSender: createNcSender(send),
    ncReceiver: createNcReceiver(recv, { restart }),
    receiveProgram: createReceiveExample(recv, { clears: receiveClears }),
    sendProgram: createSendProgram(send, { clears }),
    m68: createM68Example(send, { clears })
  }
}

const emptyState = () => ({
  mCode: { flag: false, data: 0, finish: 0 },
  /** @type {Buffer[]} what the sending program has to send */
  queue: [],
  busy: false,
  /** @type {any[]} */
  messages: [],
  /** @type {any[]} */
  sent: [],
  /** @type {any[]} */
  reported: [],
  /** @type {any[]} */
  outcomes: [],
  /** @type {any} that acknowledges */
  program: null,
  seenLength: 0,
  number: START,
  lastNumber: /** @type {number|null} */ (null),
  transmit: /** @type {any} */ (null),
  timer: null,
  eventTimer: null,
  dueTimer: /** @type {any} */ (null),
  counts: emptyCounts()
})

const emptyCounts = () => ({
  messages: 0,
  bytesIn: 0,
  bytesLost: 0,
  damaged: 0,
  missing: 0,
  overwritten: 0,
  lines: 0,
  reported: 0,
  mCodes: 0,
  confirmed: 0,
  unknown: 0,
  repeats: 0,
  repeated: 0,
  acks: 0
})

function number(setting, value, { least, most }) {
  if (typeof value === 'number' && value >= least && value <= most) return
  throw new PlcError('BAD_SETTING', { setting, value, reason: `allowed is ${least} to ${most}` })
}

function oneOf(setting, value, known) {
  if (known.includes(value)) return
  throw new PlcError('BAD_SETTING', { setting, value, reason: `it must be ${known.join(' or ')}` })
}

module.exports = { prepare }
