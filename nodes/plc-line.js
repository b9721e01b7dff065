'use strict'
const { PlcError, listPorts, masterIdsOf, mixedConflict } = require('../lib/index.js')
const { kindOf } = require('./device-settings')
const { poolSettings } = require('./line-settings')
const { listenerHolder } = require('./listeners')
const { keepEvidence, sharedPool } = require('./pool')
const { readSettings } = require('./settings')
const { simulatedLine } = require('./simulated')

const nameOf = node => node.name || node.id

/** What is wrong with the master IDs is said by the PLC itself. */
const idsOf = ({ masterIds }) => {
  try {
    return [...masterIdsOf(masterIds)]
  } catch {
    return []
  }
}

const memberOf = ({ settings, station, label }) => ({
  protocol: kindOf(settings).protocol,
  station,
  masterIds: idsOf(settings),
  name: label
})

/** @throws {PlcError} LINE_USE: a line that is listened to is not polled */
const checkUse = (line, deviceNode) => {
  const [other] = line.listeners.names()
  if (!other) return line.listeners.dropOrphans()
  const reason = 'the one asks stations, the other listens to messages'
  throw new PlcError('LINE_USE', { owner: nameOf(deviceNode), other, line: nameOf(line), reason })
}

/**
 * Who is on the line: one configuration per station, and numbers that cannot be mistaken for each other.
 * @param {any} line the config node
 */
const stationList = line => {
  const members = new Map()
  const names = (one, other) => ({ owner: nameOf(one), other: nameOf(other), line: nameOf(line) })
  const checkNumber = deviceNode => {
    const other = members.get(deviceNode.station)
    if (!other || other.id === deviceNode.id) return
    throw new PlcError('DUPLICATE_STATION', { ...names(deviceNode, other), station: deviceNode.station })
  }
  const checkMixed = deviceNode => {
    const one = memberOf(deviceNode)
    for (const other of members.values()) {
      const reason = mixedConflict(one, memberOf(other))
      if (reason) throw new PlcError('MIXED_LINE', { ...names(deviceNode, other), reason })
    }
  }

  return {
    /** @throws {PlcError} LINE_USE, DUPLICATE_STATION, MIXED_LINE, naming both */
    join(deviceNode) {
      checkUse(line, deviceNode)
      checkNumber(deviceNode)
      checkMixed(deviceNode)
      members.set(deviceNode.station, deviceNode)
      line.wire?.add(deviceNode.settings)
    },
    leave(deviceNode) {
      if (members.get(deviceNode.station) !== deviceNode) return
      members.delete(deviceNode.station)
      line.wire?.remove(deviceNode.station)
    },
    /** A station that is only tested: on a simulated line it has power for that long. One that is deployed stays as it is. */
    visit(settings) {
      const absent = () => !members.has(settings.station)
      if (absent()) line.wire.add(settings)
      return () => {
        if (absent()) line.wire.remove(settings.station)
      }
    },
    stations: () => [...members.keys()],
    members: () => [...members.values()]
  }
}

const listHandler = (_request, response) =>
  listPorts().then(
    ports => response.json({ ports }),
    error => response.status(500).json({ error: { code: error.code, message: error.message } })
  )

module.exports = function (RED) {
  keepEvidence(RED.settings.userDir)
  /** @this {any} */
  function PlcLine(config) {
    RED.nodes.createNode(this, config)
    // only nodes on a tab stand in here: the devices enter their readers and writers
    this.users = {}
    this.fault = null
    try {
      const settings = /** @type {any} */ (readSettings('plc-line', config))
      this.simulated = settings.transport === 'simulated'
      this.wire = this.simulated ? simulatedLine(settings) : undefined
      const wire = this.simulated ? { wire: this.wire.wire, path: this.id } : {}
      this.settings = poolSettings({ ...settings, name: settings.name || '', ...wire })
    } catch (error) {
      this.fault = error
      this.error(error)
    }
    this.plcs = stationList(this)
    this.listeners = listenerHolder(this, RED.events)
    this.on('close', (_removed, done) => {
      this.listeners.close().then(
        () => done(),
        () => done()
      )
    })
    this.lease = owner => {
      if (this.fault) throw this.fault
      return sharedPool().open(this.settings, owner)
    }
  }

  RED.nodes.registerType('plc-line', PlcLine)
  RED.httpAdmin.get('/plc-line/ports', RED.auth.needsPermission('plc-line.read'), listHandler)
}
