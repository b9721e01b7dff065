'use strict'

const { PlcError } = require('../../error')

/**
 * A wire in memory, made by the simulator: `settings.wire.connect({ data(bytes), closed() })` → `{ write(bytes), close() }`.
 * @param {any} settings normalised
 * @param {import('../clock').Clock} clock
 */
function simulated(settings, clock) {
  let end = null
  let timer = null

  const open = handlers => {
    // never inside the call: other transports do not either
    timer = clock.setTimer(() => {
      try {
        end = settings.wire.connect({
          data: handlers.data,
          closed: () => {
            end = null
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
    end.write(bytes)
    done()
  }
  const close = done => {
    clock.clearTimer(timer)
    const last = end
    end = null
    last?.close()
    done()
  }
  return { open, write, close, hint: () => {}, id: () => settings.wire }
}

module.exports = { simulated }
