'use strict'

const { createHash } = require('node:crypto')
const { Evidence } = require('./evidence')
const { EvidenceFile } = require('./evidence-file')

/** A wire's name as that of a file; the digest keeps those apart that differ in what no file name may have. */
const fileName = key => {
  const readable = key.replace(/[^\w-]+/g, '_').slice(-60)
  return `${readable}-${createHash('sha256').update(key).digest('hex').slice(0, 8)}`
}

const NOTHING = { file: null, previous: null, written: 0, skipped: 0, lost: 0, error: null }

/** The evidence of all wires of a pool; by wire, since a line lives only until the next deploy. */
class Archive {
  #clock
  #folder
  #wires = new Map()

  /** @param {any} clock @param {string | (() => string)} folder '': nothing is kept */
  constructor(clock, folder) {
    this.#clock = clock
    this.#folder = typeof folder === 'function' ? folder : () => folder
  }

  /** @param {string} key of a wire @returns {{ evidence: Evidence, file: EvidenceFile } | null} null: nothing is kept */
  of(key) {
    const folder = this.#folder()
    if (!folder) return null
    const own = `${folder}\0${key}`
    const known = this.#wires.get(own)
    if (known) return known
    const file = new EvidenceFile({ clock: this.#clock, folder, name: fileName(key) })
    const made = { file, evidence: new Evidence({ clock: this.#clock, give: entry => file.add(entry) }) }
    this.#wires.set(own, made)
    return made
  }

  /** What became of it, see evidence-file.js. @param {string} key */
  facts(key) {
    return this.of(key)?.file.facts ?? NOTHING
  }

  /** The same with the last rows. @param {string} key @param {number} most */
  async read(key, most) {
    const file = this.of(key)?.file
    const rows = file ? await file.tail(most) : []
    return { ...this.facts(key), rows }
  }
}

module.exports = { Archive }
