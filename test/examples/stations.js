'use strict'

const { createNxLine, serveOnTcp } = require('../../lib/sim')

/**
 * Simulated stations behind TCP, for flows whose line is pointed there.
 * @param {number[]} stations
 */
async function startTcp(stations) {
  const line = createNxLine({ stations, baudRate: 38400, quiet: true })
  const server = await serveOnTcp({ wire: line.wire })
  return {
    port: server.port,
    plcs: line.plcs,
    silence: off => stations.forEach(station => line.wire.setOff(station, off)),
    close: server.close
  }
}

module.exports = { startTcp }
