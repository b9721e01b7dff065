'use strict'

/**
 * The sequence program: reads the receive area when it gets to it, at `rate` messages/s and `byteRate` bytes/s, keeps what it
 * has read, and may answer. With a rate of 0 only `take()` reads.
 *
 * @param {any} settings of c24-settings.js
 * @param {{ read: (message: any) => void, answer: (value: any) => void, counts: any }} out read: the receive area is free again
 */
function createC24Program(settings, out) {
  const { rate, byteRate } = settings
  const program = { settings, out, messages: /** @type {any[]} */ ([]), rates: { rate, byteRate }, ...emptyState() }
  return {
    messages: program.messages,
    take: () => take(program),
    /** A message stands in the receive area. */
    request(message) {
      program.present = message
      plan(program)
    },
    setRate(changed) {
      Object.assign(program.rates, changed)
      program.next = settings.clock.now()
      plan(program)
    },
    reset() {
      settings.clock.clearTimer(program.timer)
      Object.assign(program, emptyState())
    }
  }
}

const emptyState = () => ({
  present: /** @type {any} */ (null),
  timer: /** @type {any} */ (null),
  next: -Infinity
})

function plan(program) {
  const { settings, rates, present, next } = program
  settings.clock.clearTimer(program.timer)
  program.timer = null
  if (!present || rates.rate === 0 || rates.byteRate === 0) return
  const wait = next - settings.clock.now()
  if (wait > 0) program.timer = settings.clock.setTimer(() => take(program), wait)
  else take(program)
}

function take(program) {
  const { settings, out, present, rates, messages } = program
  if (!present) return null
  settings.clock.clearTimer(program.timer)
  const at = settings.clock.now()
  const message = { ...present, at, arrived: present.at }
  const time = 1000 / rates.rate + (message.bytes.length * 1000) / rates.byteRate
  Object.assign(program, { present: null, timer: null, next: at + time })
  out.counts.taken++
  out.counts.bytesTaken += message.bytes.length
  messages.push(message)
  if (messages.length > settings.history) messages.shift()
  settings.onMessage?.(message)
  out.read(message)
  if (settings.program === 'echo') out.answer(message.bytes)
  else if (settings.program !== 'take') out.answer(settings.program(message))
  return message
}

module.exports = { createC24Program }
