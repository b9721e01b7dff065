'use strict'

/** The listening part of the redeploys: a C24 on a (virtual) serial port and an INCON controller behind TCP, which speak all the time and are sent to. */

const assert = require('node:assert/strict')
const path = require('node:path')
const {
  createInconController,
  createMelsecC24,
  createRealClock,
  createWire,
  serveOnPty,
  serveOnTcp
} = require('../../lib/sim')

const BAUD = 115200
const SPEAKS = 50 // ms
/** A module that waits for 50 ms: in bytes of 12 bits. */
const TIMER_0 = Math.ceil(1 + (50 * BAUD) / 12000)

const TYPES = { c24: 'melsec-c24', incon: 'incon-link' }
const OWN = { c24: { timer0: 50 }, incon: {} }
const LISTENERS = Object.keys(TYPES)

/** What was sent is the time in ms: no two are alike. One that was cut off may be shorter, never longer. */
const WHOLE = { c24: /^\d{1,13}$/, incon: /^\d{0,13}\r?\??$/ }

/** Per device: its line, a node with a debug node, and an inject node that has something sent. */
const listeningFlow = (settings, { turn = 0, without = '' } = {}) =>
  LISTENERS.flatMap(device => [
    { id: `line-${device}`, type: 'plc-line', name: device, ...settings[device], queueLimit: 500 + (turn & 2) },
    {
      id: `node-${device}`,
      type: TYPES[device],
      z: 'tab',
      line: `line-${device}`,
      access: 'write',
      acceptRetained: (turn & 1) === 1,
      ...OWN[device],
      wires: [[`debug-${device}`], [], []]
    },
    {
      id: `inject-${device}`,
      type: 'inject',
      z: 'tab',
      repeat: '0.01',
      props: [{ p: 'payload', v: '', vt: 'date' }],
      wires: [[`node-${device}`]]
    },
    {
      id: `debug-${device}`,
      type: 'debug',
      z: 'tab',
      active: true,
      tosidebar: true,
      complete: 'payload',
      targetType: 'msg',
      wires: []
    }
  ]).map(node => (node.id === without ? { ...node, d: true } : node))

const countOf = heard => Object.fromEntries(LISTENERS.map(device => [device, heard[device].length]))

/** @param {string} folder for the port */
async function startListening(folder) {
  const clock = createRealClock()
  const heard = { c24: [], incon: [] }
  const keep = device => message => void heard[device].push(message.bytes.toString('latin1').replace(/\r?\n$/, ''))
  const module = createMelsecC24({
    ...{ clock, baudRate: BAUD, timer0: TIMER_0, history: 10, onMessage: keep('c24') },
    speaks: { every: SPEAKS, value: n => `STATE ${n}` }
  })
  const controller = createInconController({
    ...{ clock, scan: 10, keep: 10, onMessage: keep('incon') },
    ...{ events: ['PART DONE', 'TOOL 4'], every: SPEAKS }
  })
  const wires = [module, controller].map(device => {
    // not half duplex: nobody gives turns there, and lines that meet are damaged (docs/incon.md)
    const wire = createWire({ clock, baudRate: BAUD, duplex: 'full' })
    wire.add(device)
    return wire
  })
  const pty = serveOnPty({ wire: wires[0], link: path.join(folder, 'c24') })
  const tcp = await serveOnTcp({ wire: wires[1] })
  return {
    pty,
    tcp,
    settings: {
      c24: { baudRate: BAUD, transport: 'serial', path: pty.path() },
      incon: { baudRate: BAUD, transport: 'tcp', host: '127.0.0.1', port: tcp.port }
    },
    /** Messages that each of them has got so far. */
    heard: () => countOf(heard),
    /** @returns {Record<string, number>} messages that each of them got: whole, none twice, none glued to another */
    check() {
      for (const device of LISTENERS) {
        const odd = heard[device].filter(text => !WHOLE[device].test(text))
        assert.deepEqual(odd, [], `${device} got what nobody sent`)
        const whole = heard[device].filter(text => text.length === 13)
        assert.equal(new Set(whole).size, whole.length, `${device} got something twice`)
      }
      return countOf(heard)
    },
    async close() {
      module.close()
      controller.close()
      pty.close()
      await tcp.close()
    }
  }
}

module.exports = { LISTENERS, listeningFlow, startListening }
