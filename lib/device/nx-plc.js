'use strict'
const { Device } = require('./device')
const { Health } = require('./health')
const { readSettings } = require('./settings')
const { Talk } = require('./talk')

/**
 * One OE MAX NX PLC on a line. Made by {@link createNxPlc}. Its `stats` are `{ requests, answers, nonStandardAcks, repeats, seenStation,
 * overruns, subscriptions }`.
 */
class NxPlc extends Device {
  /** @param {Record<string, any>} options of {@link createNxPlc} */
  constructor({ lease, clock, random = Math.random, ...given }) {
    const settings = readSettings(given, lease.line.times?.character ?? 0.52, lease.line.times?.gap)
    const health = new Health({ lease, clock, settings, random })
    const talk = new Talk({ lease, clock, health, settings, random })
    super({ settings, line: lease.line, talk, health, clock, random })
  }
}

/**
 * One OE MAX NX PLC on a line.
 *
 * @param {object} options
 * @param {any} options.lease of the line, from `pool.open`
 * @param {number|string} options.station 0..191, or 255 for the only PLC of a line
 * @param {string} [options.name]
 * @param {2|4|'2'|'4'} [options.steps] default 2
 * @param {number} [options.timeout] ms to the first byte of the answer, default 3000
 * @param {number} [options.attempts] of a read, default 3; a write has one
 * @param {number} [options.gap] ms of silence before each frame; 0 or missing: 10, as the manual's program waits
 * @param {any} [options.masterIds] default $E2..$E9, see `masterIdList`
 * @param {number[]} [options.stations] numbers of the line's other stations, which no master ID may have
 * @param {boolean} [options.soleMaster] the line has no other master: polls may be repeated by an RR alone
 * @param {any[]} [options.areas] rows that replace or add areas, see `areaMap`
 * @param {any[]} [options.tags] see `readTags`
 * @param {'low'|'high'} [options.wordOrder] of 32-bit values, default low word first
 * @param {'low'|'high'} [options.byteOrder] of strings, default low byte first
 * @param {'read'|'write'} [options.access] default read
 * @param {string|string[]} [options.writableRanges] `K0..K63, M10`: what a message may write to beside writable tags
 * @param {Record<string, number>} [options.limits] per frame, see `limitsOf`
 * @param {number} [options.writeInterval] ms between two writes of the same words or bits at least, default none
 * @param {number} [options.demoteAfter] silences in a row after which the station is only probed, default 3; 0: never
 * @param {number} [options.probeFirst] ms until the first probe, default 5000; each further one after twice as long
 * @param {number} [options.probeMost] ms between two probes at most, default 60000
 * @param {number} [options.deadline] ms that a request may wait for its turn, default no limit
 * @param {any} [options.clock]
 * @param {() => number} [options.random] 0 to 1
 * @returns {NxPlc}
 * @throws {PlcError} BAD_STATION, BAD_MASTER_ID, BAD_SETTING, BAD_AREA, BAD_TAG, BAD_ADDRESS and its like
 */
const createNxPlc = options => new NxPlc(options)

module.exports = { NxPlc, createNxPlc }
