'use strict'

const REST = 3600000 // ms that a PLC is asked by queries alone
const FAILURES = { unproven: 3, proven: 10 }

/**
 * Whether a PLC repeats a read by an RR alone. Where it does not, each attempt costs a timeout, or a refusal, before the query goes out after all: so
 * after some in a row it is left alone for an hour. Those that failed with their query do not count: they were the line's fault.
 */
class RepeatWatch {
  #clock
  #memory
  #found

  /** @param {{ clock: any, memory: Record<string, any>, found: () => void }} options memory: of the station; found: it does not repeat, told once */
  constructor({ clock, memory, found }) {
    this.#clock = clock
    this.#memory = memory
    this.#found = found
    memory.repeat ??= { failed: 0, proven: false, rests: -Infinity, told: false }
  }

  get allowed() {
    return this.#clock.now() >= this.#memory.repeat.rests
  }

  /** An RR went out, and what was asked for has come. @param {boolean} repeated by the RR alone */
  note(repeated) {
    const { repeat } = this.#memory
    if (repeated) return void Object.assign(repeat, { failed: 0, proven: true })
    if (++repeat.failed < (repeat.proven ? FAILURES.proven : FAILURES.unproven)) return
    Object.assign(repeat, { failed: 0, rests: this.#clock.now() + REST })
    if (repeat.told) return
    repeat.told = true
    this.#found()
  }
}

module.exports = { RepeatWatch }
