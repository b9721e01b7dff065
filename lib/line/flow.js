'use strict'

const { PlcError } = require('../error')

const DC1 = 0x11
const DC3 = 0x13

const bad = (setting, value, reason) => new PlcError('BAD_SETTING', { setting, value, reason })

const number = (setting, value, { least = 0, most = 3600000 } = {}) => {
  if (typeof value === 'number' && value >= least && value <= most) return value
  throw bad(setting, value, `allowed is ${least} to ${most}`)
}

const byte = value => {
  if (value !== null) number('transparent', value, { least: 0, most: 255 })
  if (value === DC1 || value === DC3) throw bad('transparent', value, 'DC1 and DC3 are what it has to make transparent')
  return value
}

/**
 * How a listening line is used, complete and checked.
 * @param {Record<string, any>} [given] options of `lease.listen`
 * @returns {{ flow: 'none'|'dc', transparent: number|null, room: number, latency: number, stallLimit: number,
 *   torn: { wait: number, first: Buffer|null, apart: boolean } }} times in ms, room in bytes
 * @throws {PlcError} BAD_SETTING
 */
const flowOptions = ({ flow = 'none', transparent = null, torn = {}, ...given } = {}) => {
  if (flow !== 'none' && flow !== 'dc') throw bad('flow', flow, 'known are none, dc')
  return {
    flow,
    transparent: byte(transparent),
    room: number('room', given.room ?? 64, { least: 1, most: 1000000 }),
    latency: number('latency', given.latency ?? 16),
    stallLimit: number('stallLimit', given.stallLimit ?? 30000, { least: 1 }),
    torn: {
      wait: number('torn.wait', torn.wait ?? 0),
      first: torn.first?.length > 0 ? Buffer.from(torn.first) : null,
      apart: torn.apart === true
    }
  }
}

/** The first option in which two of them differ; '' if there is none. */
const flowDifference = (one, other) => {
  const shown = ({ torn, ...rest }) => ({
    ...rest,
    'torn.wait': torn.wait,
    'torn.first': torn.first?.toString('hex') ?? '',
    'torn.apart': torn.apart
  })
  const [mine, theirs] = [shown(one), shown(other)]
  const key = Object.keys(mine).find(name => mine[name] !== theirs[name])
  return key === undefined ? '' : `${key} ${mine[key]} and ${theirs[key]}`
}

/** Characters until the stop has come: the one that the other side is sending, and DC3 itself. */
const STOP = 2

/**
 * Bytes that may be on their way at once: the stop comes when `room` bytes are free, and the adapter brings it late.
 * @throws {PlcError} BAD_SETTING naming room and speed
 */
const pieceSize = ({ flow, transparent, room, latency }, { flowControl, baudRate }) => {
  if (flow !== 'dc' || flowControl !== 'none') return Infinity
  const most = Math.floor(room - STOP - (baudRate / 10000) * latency)
  // a transparent code and what follows it are never parted
  const least = transparent === null ? 1 : 2
  if (most >= least) return most
  const reason = `at ${baudRate} bit/s ${latency} ms pass before a stop is seen: use the driver's flow control, a lower speed or more room`
  throw bad('room', room, reason)
}

/**
 * Flow control by DC1 and DC3, without the driver's help: whether the other side lets us send, and what is theirs in the bytes received.
 * It may be sent at the start, and after each opening: the other side says nothing then.
 */
class Flow {
  #options
  #clock
  #most
  #escaped = false
  /** since when the other side does not take anything, ms; Infinity: it does */
  stoppedAt = Infinity

  /** @param {any} options of {@link flowOptions} @param {{ clock: any, settings: any }} line @throws {PlcError} BAD_SETTING */
  constructor(options, { clock, settings }) {
    this.#options = options
    this.#clock = clock
    this.#most = pieceSize(options, settings)
  }

  get stopped() {
    return this.stoppedAt !== Infinity
  }

  /** Whether DC1 and DC3 mean something here. */
  get on() {
    return this.#options.flow === 'dc'
  }

  get options() {
    return this.#options
  }

  reset() {
    this.stoppedAt = Infinity
    this.#escaped = false
  }

  /**
   * Takes DC1 and DC3 out of what was received.
   * @param {Buffer} bytes @returns {{ bytes: Buffer, stops: number }} what is left, and how often the other side said stop
   */
  take(bytes) {
    if (!this.on) return { bytes, stops: 0 }
    const kept = Buffer.alloc(bytes.length)
    let length = 0
    let stops = 0
    for (const one of bytes) {
      const literal = this.#escaped
      this.#escaped = !literal && one === this.#options.transparent
      if (literal || (one !== DC1 && one !== DC3)) {
        kept[length++] = one
        continue
      }
      if (one === DC3) stops++
      this.#set(one === DC3)
    }
    return { bytes: kept.subarray(0, length), stops }
  }

  #set(stop) {
    if (!stop) this.stoppedAt = Infinity
    else if (!this.stopped) this.stoppedAt = this.#clock.now()
  }

  /** Where the piece that begins at `from` ends. @param {Buffer} bytes @param {number} from */
  pieceEnd(bytes, from) {
    const { transparent } = this.#options
    const limit = Math.min(bytes.length, from + this.#most)
    if (transparent === null || limit === bytes.length) return limit
    let at = from
    while (at < limit) {
      const next = at + (bytes[at] === transparent ? 2 : 1)
      if (next > limit) break
      at = next
    }
    return at
  }
}

module.exports = { DC1, DC3, Flow, flowDifference, flowOptions }
