'use strict'
const { PlcError, listPorts } = require('../lib/index.js')
const { poolSettings } = require('./line-settings')
const { sharedPool } = require('./pool')
const { readSettings } = require('./settings')
const { simulatedWire } = require('./simulated')

const nameOf = node => node.name || node.id

/**
 * Who is on the line: one configuration per station.
 * @param {any} line the config node
 */
const stationList = line => {
  const plcs = new Map()
  return {
    /** @throws {PlcError} DUPLICATE_STATION naming both */
    join(plc) {
      const other = plcs.get(plc.station)
      if (other && other.id !== plc.id) {
        const names = { owner: nameOf(plc), other: nameOf(other), line: nameOf(line) }
        throw new PlcError('DUPLICATE_STATION', { ...names, station: plc.station })
      }
      plcs.set(plc.station, plc)
      line.wire?.add(plc.settings)
    },
    leave(plc) {
      if (plcs.get(plc.station) !== plc) return
      plcs.delete(plc.station)
      line.wire?.remove(plc.station)
    },
    /** A station that is only tested: on a simulated line it has power for that long. */
    visit(settings) {
      line.wire.add(settings)
      return () => {
        if (!plcs.has(settings.station)) line.wire.remove(settings.station)
      }
    },
    stations: () => [...plcs.keys()]
  }
}

const listHandler = (_request, response) =>
  listPorts().then(
    ports => response.json({ ports }),
    error => response.status(500).json({ error: { code: error.code, message: error.message } })
  )

module.exports = function (RED) {
  /** @this {any} */
  function PlcLine(config) {
    RED.nodes.createNode(this, config)
    // only nodes on a tab stand in here: nx-config enters its readers and writers
    this.users = {}
    this.fault = null
    try {
      const settings = readSettings('plc-line', config)
      this.simulated = settings.transport === 'simulated'
      this.wire = this.simulated ? simulatedWire({ baudRate: settings.baudRate }) : undefined
      const wire = this.simulated ? { wire: this.wire.wire, path: this.id } : {}
      this.settings = poolSettings({ ...settings, name: settings.name || '', ...wire })
    } catch (error) {
      this.fault = error
      this.error(error)
    }
    this.plcs = stationList(this)
    this.lease = owner => {
      if (this.fault) throw this.fault
      return sharedPool().open(this.settings, owner)
    }
  }

  RED.nodes.registerType('plc-line', PlcLine)
  RED.httpAdmin.get('/plc-line/ports', RED.auth.needsPermission('plc-line.read'), listHandler)
}
