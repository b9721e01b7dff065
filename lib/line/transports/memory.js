'use strict'

const { PlcError } = require('../../error')
const { characterTime } = require('../timing')

/** Bytes that leave at once, as from a UART: so late is a stop by CTS seen. */
const FIFO = 16

/**
 * What an adapter does between the program and the wire when the other side's DTR is wired to our CTS: while it is off nothing leaves.
 * @param {any} clock @param {{ character: number, put: (bytes: Buffer) => void }} wire character: ms
 */
function createGate(clock, { character, put }) {
  let on = true
  let timer = null
  let waiting = []
  const next = () => {
    timer = null
    const [first] = waiting
    if (!on || !first) return
    const part = first.bytes.subarray(0, FIFO)
    first.bytes = first.bytes.subarray(part.length)
    const last = first.bytes.length === 0
    timer = clock.setTimer(() => left(last), part.length * character, { quiet: !last })
    put(part)
  }
  const left = last => {
    const done = last ? waiting.shift()?.done : null
    next()
    done?.()
  }
  return {
    write(bytes, done) {
      waiting.push({ bytes: Buffer.from(bytes), done })
      if (timer === null) next()
    },
    cts(state) {
      on = state
      if (timer === null) next()
    },
    close() {
      clock.clearTimer(timer)
      timer = null
      waiting = []
    }
  }
}

/**
 * A wire in memory, made by the simulator: `settings.wire.connect({ data(bytes), closed(), cts(on) })` → `{ write(bytes), close() }`.
 * `cts` is heard where the setting flowControl is rtscts.
 * @param {any} settings normalised
 * @param {import('../clock').Clock} clock
 */
function simulated(settings, clock) {
  let end = null
  let timer = null
  const put = bytes => end?.write(bytes)
  const gate = settings.flowControl === 'rtscts' ? createGate(clock, { character: characterTime(settings), put }) : null

  const open = handlers => {
    // never inside the call: other transports do not either
    timer = clock.setTimer(() => {
      try {
        end = settings.wire.connect({
          data: handlers.data,
          cts: on => gate?.cts(on),
          closed: () => {
            end = null
            gate?.close()
            handlers.closed(new PlcError('PORT_GONE', { path: settings.path || 'simulated' }))
          }
        })
      } catch (error) {
        return handlers.failed(error)
      }
      handlers.opened()
    }, 0)
  }
  const write = (bytes, done) => {
    if (!end) return done(new PlcError('PORT_GONE', { path: settings.path || 'simulated' }))
    if (gate) return gate.write(bytes, done)
    end.write(bytes)
    done()
  }
  const close = done => {
    clock.clearTimer(timer)
    const last = end
    end = null
    gate?.close()
    last?.close()
    done()
  }
  return { open, write, close, hint: () => {}, id: () => settings.wire }
}

module.exports = { simulated }
