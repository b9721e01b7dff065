'use strict'

/** `npm run simulate -- c24 …` and `incon …`: devices that also speak by themselves. */

const sim = require('../lib/sim')
const { oneOf, whole } = require('./simulate-options')

const EVERY = 1000

// a machine that counts its pieces while it gets warm
const machine = n => `PIECES=${n % 10000};TEMP=${(180 - 160 * Math.exp(-n / 60)).toFixed(1)}`
const EVENTS = ['PART DONE', 'TOOL 4', 'PART DONE', 'ALARM 12 DOOR OPEN', 'ALARM 12 CLEARED']

const every = values => (values.quiet ? 0 : whole(values, 'every', { standard: EVERY, least: 1, most: 86400000 }))
const rate = (values, name) => whole(values, name, { standard: Infinity, least: 0, most: 1e6 })

const READ = {
  c24(values) {
    const ms = every(values)
    return {
      protocol: oneOf(values, 'protocol', ['non-procedure', 'bidirectional']),
      unit: oneOf(values, 'unit', ['word', 'byte']),
      end: values.end,
      count: whole(values, 'count', { standard: undefined, least: 1, most: 1022 }),
      timer0: whole(values, 'timer0', { standard: 0, least: 0, most: 65535 }),
      // a virtual port and TCP have no DTR
      flow: oneOf(values, 'flow', ['none', 'dc']),
      transparent: values.transparent,
      asciiBinary: values['ascii-binary'] ?? false,
      rate: rate(values, 'rate'),
      byteRate: rate(values, 'byte-rate'),
      turnaround: whole(values, 'turnaround', { standard: 2, least: 0, most: 60000 }),
      program: oneOf(values, 'answer', ['none', 'echo']) === 'echo' ? 'echo' : 'take',
      speaks: ms > 0 ? { every: ms, value: machine } : null
    }
  },
  incon: values => ({
    scan: whole(values, 'scan', { standard: 10, least: 1, most: 1000 }),
    checked: values.checked ?? false,
    acknowledge: values.acknowledge ?? false,
    clears: oneOf(values, 'clears', ['finish', 'length']),
    answer: oneOf(values, 'answer', ['none', 'echo']),
    events: EVENTS,
    every: every(values)
  })
}

/**
 * The settings of the device, checked.
 * @param {'c24'|'incon'} command
 * @param {Record<string, any>} values
 */
const readPeer = (command, values) => ({
  settings: READ[command](values),
  rates: sim.parseFaults(values.fault ?? ''),
  show: values.show ?? false
})

/** @param {any} settings as read() gives them */
function makePeer({ command, settings, baudRate, rates, wear, seed, echo, show }) {
  const onMessage = show ? ({ bytes }) => console.log(`taken: ${JSON.stringify(bytes.toString('latin1'))}`) : null
  return sim.createPeerLine({
    device: command,
    settings: { ...settings, onMessage },
    ...{ baudRate, rates, wear, seed, echo }
  })
}

/** What the printed line says of the device. */
const describePeer = ({ command, settings }) =>
  command === 'c24' ? `(${settings.protocol}, flow ${settings.flow})` : `(scan ${settings.scan} ms)`

module.exports = { describePeer, makePeer, readPeer }
