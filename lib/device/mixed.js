'use strict'

/**
 * Stations of two protocols on one line. NX and MODBUS have the same check code, so a frame of the one may be a good frame to the other:
 * their numbers must not meet. Pure; protocol page, "NX and MODBUS on one line".
 *
 * @typedef {{ protocol: string, station: number, masterIds?: number[], name: string }} Member
 */

const ONLY_PLC = 255

/** @param {Member} nx @param {Member} modbus @returns {string} */
const conflict = (nx, modbus) => {
  const { station } = modbus
  if (nx.station === ONLY_PLC) return `NX station ${ONLY_PLC} answers to every number`
  if (nx.station === 0) return 'NX station 0 is the broadcast of MODBUS'
  if (station === 0) return 'a MODBUS broadcast reaches the NX PLCs too'
  if (nx.station === station) return `both are station ${station}`
  if ((nx.masterIds ?? []).includes(station)) {
    return `the NX configuration sends as master ID ${station}, which is the number of the regulator`
  }
  return ''
}

/**
 * Why two stations cannot share a line.
 * @param {Member} one protocol `nx` or `modbus`
 * @param {Member} other
 * @returns {string} '' if they can; of one protocol they always can, here
 */
const mixedConflict = (one, other) => {
  if (one.protocol === other.protocol) return ''
  return one.protocol === 'nx' ? conflict(one, other) : conflict(other, one)
}

module.exports = { mixedConflict }
