'use strict'

const { PlcError } = require('../error')
const { copyOf } = require('./run')

/** How a line is, and why nothing can be sent. */
class Condition {
  #line
  #changed
  /** @type {'closed'|'opening'|'open'|'waiting'|'jammed'} */
  state = 'closed'
  // why it is waiting or jammed: a PlcError, or null
  /** @type {any} */
  reason = null
  /** The line is being given up: nothing new may begin, whatever its state. */
  closing = false

  /** @param {{ line: string, changed: (state: string, reason: any) => void }} options line: its name, for the texts */
  constructor({ line, changed }) {
    this.#line = line
    this.#changed = changed
  }

  /** @param {Condition['state']} state @param {any} [reason] */
  become(state, reason = null) {
    if (state === this.state && reason?.code === this.reason?.code) return
    this.state = state
    this.reason = reason
    this.#changed(state, reason)
  }

  /** Why nothing can be sent now: a PlcError, or null. */
  refusal() {
    if (this.closing || this.state === 'closed') return this.closed({ sent: false })
    if (this.reason) return copyOf(this.reason, { sent: false })
    return this.state === 'opening' ? this.slow() : null
  }

  /** Why a request may not even wait: the first opening is waited for. */
  rejection() {
    return this.state === 'opening' && !this.closing ? null : this.refusal()
  }

  closed(details = {}) {
    return new PlcError('LINE_CLOSED', { line: this.#line, ...details })
  }

  slow() {
    return new PlcError('LINE_DOWN', { line: this.#line, reason: 'it is still being opened', sent: false })
  }

  /** What a transport said, as a PlcError. */
  asReason(error) {
    if (error instanceof PlcError) return error
    const reason = error?.message ?? 'the connection was closed'
    return new PlcError('LINE_DOWN', { line: this.#line, reason, cause: error })
  }
}

module.exports = { Condition }
