'use strict'

const { createMelsecC24, createVirtualClock, createWire } = require('../../lib/sim')
const { bytes, shown } = require('./support')

const CRLF = '\r\n'
const text = value => Buffer.from(value, 'latin1')
/** Words as in the manual. */
const hex = words => words.map(word => word.toString(16).toUpperCase().padStart(4, '0')).join(' ')

/** A channel that hears at once what it is given, and what it says, with the time. */
function channel(settings) {
  const clock = createVirtualClock()
  const c24 = createMelsecC24({ clock, turnaround: 0, ...settings })
  const said = []
  const cts = []
  const send = piece => {
    said.push(Buffer.from(piece))
    return clock.now() + piece.length * c24.settings.byteMs
  }
  c24.speak(send, { faulty: whole => [{ bytes: whole }], cts: on => cts.push(on) })
  const hear = value => c24.receive(Buffer.isBuffer(value) ? value : text(value))
  return { clock, c24, hear, cts, said: () => shown(Buffer.concat(said)) }
}

/** One peer on a wire of RS-232. */
function onWire(settings = {}, wireSettings = {}) {
  const clock = createVirtualClock()
  const wire = createWire({ clock, baudRate: 9600, duplex: 'full', ...wireSettings })
  const c24 = createMelsecC24({ clock, baudRate: 9600, ...settings })
  wire.add(c24)
  const heard = []
  const cts = []
  const end = wire.connect({
    data: data => heard.push([clock.now(), Buffer.from(data)]),
    closed: () => {},
    cts: on => cts.push([clock.now(), on])
  })
  const all = () => Buffer.concat(heard.map(([, data]) => data))
  return { clock, wire, c24, end, heard, cts, all }
}
const byteMs = 10000 / 9600

module.exports = { byteMs, bytes, channel, CRLF, hex, onWire, shown, text }
