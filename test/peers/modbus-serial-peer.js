'use strict'

/**
 * modbus-serial alone, as its readme shows it, in virtual time: its own serial ports (connectRTUBuffered, connectAsciiSerial) on a binding whose
 * other end is a wire of the tests.
 */

const ModbusRTU = require('modbus-serial')
const { BAUD } = require('./station.js')

/** A binding of serialport that reads from and writes to a wire. An error thrown while bytes are taken would end a real program: it is counted. */
function bindingTo(wire, crashes) {
  return {
    list: async () => [],
    open: async openOptions => {
      let held = Buffer.alloc(0)
      let reader = null
      const give = () => {
        if (!reader || held.length === 0 || crashes.length > 0) return
        const { buffer, offset, length, taken } = reader
        const bytesRead = held.copy(buffer, offset, 0, length)
        held = held.subarray(bytesRead)
        reader = null
        try {
          taken({ bytesRead, buffer })
        } catch (error) {
          crashes.push(error)
        }
      }
      const end = wire.connect({
        data: bytes => {
          held = Buffer.concat([held, bytes])
          give()
        }
      })
      return {
        isOpen: true,
        openOptions,
        // no promise: what the stream does with the bytes is to be seen here
        read: (buffer, offset, length) => ({
          then: taken => {
            reader = { buffer, offset, length, taken }
            give()
          }
        }),
        write: async bytes => end.write(bytes),
        close: async () => end.close(),
        drain: async () => {},
        flush: async () => {},
        set: async () => {},
        update: async () => {}
      }
    }
  }
}

/** What runs inside takes its time from the clock: modbus-serial sets its timeouts with the global function. */
async function inVirtualTime(clock, run) {
  const { setTimeout: set, clearTimeout: clear } = globalThis
  globalThis.setTimeout = (fn, ms) => clock.setTimer(fn, ms)
  globalThis.clearTimeout = timer => clock.clearTimer(timer)
  try {
    return await clock.run(run())
  } finally {
    Object.assign(globalThis, { setTimeout: set, clearTimeout: clear })
  }
}

/**
 * @returns {Promise<{ outcomes: { value?: any, error?: Error }[], crashes: Error[] }>} one outcome per task, in order
 */
function runPeer(clock, wire, { tasks, protocol, timeout, unit, together }) {
  const crashes = []
  const dead = () => new Error('the program has ended')
  return inVirtualTime(clock, async () => {
    const client = new ModbusRTU()
    const connect = protocol === 'rtu' ? 'connectRTUBuffered' : 'connectAsciiSerial'
    await client[connect]('virtual', { baudRate: BAUD, binding: bindingTo(wire, crashes) })
    client.setID(unit)
    client.setTimeout(timeout)
    const call = ({ read, write, base, count, value, values }) => {
      if (read === 'hr') return client.readHoldingRegisters(base, count).then(({ data }) => data)
      if (read === 'co') return client.readCoils(base, count).then(({ data }) => data.slice(0, count))
      if (write === 'co') return client.writeCoil(base, value)
      return values ? client.writeRegisters(base, values) : client.writeRegister(base, value)
    }
    const outcome = async task => {
      try {
        if (crashes.length > 0) throw dead()
        return { value: await call(task) }
      } catch (error) {
        return { error }
      }
    }
    const outcomes = []
    if (together) outcomes.push(...(await Promise.all(tasks.map(outcome))))
    else for (const task of tasks) outcomes.push(await outcome(task))
    await new Promise(resolve => client.close(resolve))
    return { outcomes, crashes }
  })
}

module.exports = { bindingTo, inVirtualTime, runPeer }
