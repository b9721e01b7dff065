'use strict'
const { readSettings } = require('./chino-settings')
const { Device } = require('./device')
const { Health } = require('./health')
const { ModbusTalk } = require('./modbus-talk')

/**
 * One CHINO regulator, or any other MODBUS slave, on a line. Made by {@link createChinoRegulator}. Its `stats` are `{ requests, answers,
 * exceptions, broadcasts, overruns, subscriptions }`.
 */
class ChinoRegulator extends Device {
  /** @param {Record<string, any>} options of {@link createChinoRegulator} */
  constructor({ lease, clock, random, ...given }) {
    const settings = readSettings(given, lease.line.times?.character, lease.line.times?.gap)
    const health = new Health({ lease, clock, settings, random })
    const talk = new ModbusTalk({ lease, health, settings, random })
    super({ settings, line: lease.line, talk, health, clock, random })
  }
}

/**
 * One CHINO regulator on a line.
 *
 * @param {object} options
 * @param {any} options.lease of the line, from `pool.open`
 * @param {number|string} options.station 1..247, or 0 for a broadcast, which needs `broadcast`
 * @param {string} [options.name]
 * @param {'rtu'|'ascii'} [options.protocol] default RTU, which needs 8 data bits
 * @param {'1-base'|'0-base'} [options.addressMode] 1-base (default): the number on the wire is the address - 1
 * @param {number} [options.timeout] ms to the first byte of the answer, default 1000
 * @param {number} [options.sendWait] ms of silence before each frame, default 0; RTU keeps at least 3.5 characters (1.75 ms above 19200 bit/s)
 * @param {number} [options.attempts] of a read, default 3; a write has one
 * @param {number} [options.coilRead] coils in one read, default 2000
 * @param {number} [options.coilUnit] coils are asked for in whole multiples of this, default 1
 * @param {'0F'|'05'|'auto'} [options.coilFunction] that writes coils; auto: 05 for one, 0F for several
 * @param {number} [options.coilWrite] coils in one write by 0F, default 1968
 * @param {number} [options.discreteRead] discrete inputs in one read, default 2000
 * @param {number} [options.discreteUnit] as `coilUnit`
 * @param {number} [options.inputRead] input registers in one read, default 125 (the panel's "read boundary")
 * @param {number} [options.holdingRead] holding registers in one read, default 125
 * @param {'10'|'06'|'auto'} [options.holdingFunction] that writes holding registers; auto: 06 for one, 10 for several
 * @param {number} [options.holdingWrite] holding registers in one write by 10, default 123
 * @param {boolean} [options.broadcast] station 0 may be written to
 * @param {number} [options.turnaround] ms of silence after a broadcast, default 100
 * @param {any[]} [options.tags] see `readTags`
 * @param {'low'|'high'} [options.wordOrder] of 32-bit values, default low word first (the panel's L/H)
 * @param {'low'|'high'} [options.byteOrder] of strings, default high byte first: registers travel so
 * @param {'read'|'write'} [options.access] default read
 * @param {string|string[]} [options.writableRanges] `400001..400010, 001001`: what a message may write to beside writable tags
 * @param {number} [options.writeInterval] ms between two writes of the same words or bits at least, default none
 * @param {number} [options.demoteAfter] silences in a row after which the station is only probed, default 3; 0: never
 * @param {number} [options.probeFirst] ms until the first probe, default 5000; each further one after twice as long
 * @param {number} [options.probeMost] ms between two probes at most, default 60000
 * @param {boolean} [options.probe08] after a timeout ask by function 08 whether anything late may come; only where answers come in order
 * @param {number} [options.deadline] ms that a request may wait for its turn, default no limit
 * @param {any} [options.clock]
 * @param {() => number} [options.random] 0 to 1
 * @returns {ChinoRegulator}
 * @throws {import('../error').PlcError} BAD_STATION, BROADCAST_REFUSED, BAD_SETTING, BAD_TAG, BAD_ADDRESS and its like
 */
const createChinoRegulator = options => new ChinoRegulator(options)

module.exports = { ChinoRegulator, createChinoRegulator }
