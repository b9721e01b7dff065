'use strict'

const { PlcError } = require('../error')

const WORDS = { requests: 'asks stations', messages: 'listens to messages' }

/** A line serves requests or messages, never both: an answer could be taken for a message, and a message for an answer. */
class Use {
  #line
  /** @type {'requests'|'messages'|null} */
  kind = null
  #leases = new Set()

  /** @param {string} line its name, for the texts */
  constructor(line) {
    this.#line = line
  }

  /**
   * @param {'requests'|'messages'} kind @param {any} lease
   * @returns {PlcError|null} LINE_USE, if the line serves the other kind
   */
  claim(kind, lease) {
    if (this.kind !== null && this.kind !== kind) {
      return this.conflict(lease, `the one ${WORDS[kind]}, the other ${WORDS[this.kind]}`)
    }
    this.kind = kind
    this.#leases.add(lease)
    return null
  }

  /** @param {any} lease who wants it @param {string} reason @returns {PlcError} naming both */
  conflict(lease, reason) {
    const [other] = [...this.#leases].filter(one => one !== lease)
    const names = { owner: lease.owner.name, other: (other ?? lease).owner.name, line: this.#line }
    return new PlcError('LINE_USE', { ...names, reason, sent: false })
  }

  /** It does not use the line any more; the last one leaves it free for either kind. @param {any} lease */
  leave(lease) {
    this.#leases.delete(lease)
    if (this.#leases.size === 0) this.kind = null
  }
}

module.exports = { Use }
