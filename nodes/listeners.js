'use strict'
const { PlcError } = require('../lib/index.js')
const { portConflict } = require('./listening-rules')
const { createPort, isSamePort } = require('./listening-settings')
const { onStarted } = require('./started')

/** Who listens on a line: a seat for each node, with its port. */

// messages that came while a deploy makes their node anew
const MOST_WAITING = 1000

/** @typedef {{ id: string, label: string, type: string, settings: Record<string, any> }} Own */

/** @param {any} line the config node @param {Own} own */
const openSeat = (line, { id, label, type, settings }) => {
  const lease = line.lease({ id, name: label })
  /** @type {any} */
  const seat = { id, label, type, settings, lease, node: null, tell: null, heard: null, waiting: [] }
  try {
    seat.port = createPort(type, settings, { lease, name: label })
    seat.port.listen(message => {
      if (seat.heard) return seat.heard(message)
      seat.waiting.push(message)
      if (seat.waiting.length > MOST_WAITING) seat.waiting.shift()
    })
  } catch (error) {
    seat.port?.close()
    lease.release()
    throw error
  }
  lease.on('state', (state, reason) => seat.tell?.({ state, reason }))
  return seat
}

/** What a node gets of its seat: what came meanwhile comes first. */
const portOf = seat => ({
  send: (value, options) => seat.port.send(value, options),
  refused: (value, error, options) => seat.port.refused(value, error, options),
  listen(heard) {
    seat.heard = heard
    seat.waiting.splice(0).forEach(heard)
    return () => {
      if (seat.heard === heard) seat.heard = null
    }
  }
})

/** The seats of a line and how they are given back. */
const createSeats = line => {
  /** @type {Map<string, any>} */
  const seats = new Map()
  const closing = new Set()
  const all = () => [...seats.values()]
  const drop = seat => {
    seats.delete(seat.id)
    seat.port.close()
    const closed = seat.lease.release()
    closing.add(closed)
    closed.then(() => closing.delete(closed))
    if (seats.size === 0) line.wire?.deaf()
  }
  return {
    all,
    drop,
    get: id => seats.get(id),
    put: seat => seats.set(seat.id, seat).get(seat.id),
    /** Nodes that a deploy has taken away, or not made again yet. */
    dropOrphans: (which = _seat => true) =>
      all()
        .filter(seat => !seat.node && which(seat))
        .forEach(drop),
    closed: () => Promise.all([...closing])
  }
}

/** @param {any} line @param {any} seats @param {Own} own @throws {PlcError} LINE_USE, naming both */
const checkUse = (line, seats, own) => {
  const refuse = (other, reason) => {
    throw new PlcError('LINE_USE', { owner: own.label, other, line: line.name || line.id, reason })
  }
  const [polled] = line.plcs.members()
  if (polled) refuse(polled.label, 'the one listens to messages, the other asks stations')
  for (const seat of seats.all()) {
    const reason = seat.node && seat.id !== own.id ? portConflict(own, seat) : ''
    if (reason) refuse(seat.label, reason)
  }
}

/** @param {any} line @param {any} seats @param {Own} own @throws {PlcError} LINE_USE, BAD_SETTING */
const seatFor = (line, seats, own) => {
  checkUse(line, seats, own)
  const before = seats.get(own.id)
  if (before && isSamePort(before, own)) return before
  if (before) seats.drop(before)
  seats.dropOrphans(seat => portConflict(own, seat) !== '')
  const first = seats.all().length === 0
  if (first) line.wire?.listen(own)
  try {
    return seats.put(openSeat(line, own))
  } catch (error) {
    if (first) line.wire?.deaf()
    throw error
  }
}

/**
 * The listeners of a line. Of a node that a deploy makes anew with the same settings the port stays: nothing that comes meanwhile is lost or torn.
 * @param {any} line the config node
 * @param {{ on: Function, off: Function }} events of the runtime
 */
const listenerHolder = (line, events) => {
  const seats = createSeats(line)
  const stop = onStarted(events, () => seats.dropOrphans())
  return {
    /** The names of those who listen now. */
    names: () => seats.all().flatMap(({ node, label }) => (node ? [label] : [])),
    dropOrphans: () => seats.dropOrphans(),
    /**
     * @param {any} node on a tab
     * @param {Own} own
     * @returns {{ label: string, simulated: boolean, attach: Function, detach: Function }} as the config node of a device
     */
    member: (node, own) => ({
      label: own.label,
      simulated: Boolean(line.simulated),
      attach(_node, tell) {
        line.users[node.id] = node
        if (line.fault) throw line.fault
        const seat = seatFor(line, seats, own)
        Object.assign(seat, { node, tell })
        const { state, reason } = seat.lease.line
        tell({ state, reason })
        return portOf(seat)
      },
      detach() {
        if (line.users[node.id] === node) delete line.users[node.id]
        const seat = seats.get(node.id)
        if (seat?.node === node) Object.assign(seat, { node: null, tell: null, heard: null })
      }
    }),
    close() {
      stop()
      seats.all().forEach(seats.drop)
      return seats.closed()
    }
  }
}

module.exports = { listenerHolder }
