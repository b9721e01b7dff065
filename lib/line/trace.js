'use strict'

const MOST_BYTES = 600
/** Noise of one burst is one row: else a flood of single bytes would push the frames out. */
const BURST = 100

const copyOf = bytes => Buffer.from(bytes.length > MOST_BYTES ? bytes.subarray(0, MOST_BYTES) : bytes)

/** The last frames of a line, oldest first. Bounded; bytes become text only when somebody looks. */
class Trace {
  #rows = []
  #at = 0
  #limit
  #tell

  /** @param {{ limit?: number, tell?: (row: any, grows: boolean) => void }} [options] tell: each new row; grows: its bytes may become more */
  constructor({ limit = 200, tell = () => {} } = {}) {
    this.#limit = limit
    this.#tell = tell
  }

  /** @param {{ t: number, dir: 'out'|'in', station: any, bytes: Buffer, note: string }} row t: epoch ms */
  add({ t, dir, station, bytes, note }) {
    this.#put({ t, dir, station, bytes: copyOf(bytes), note }, false)
  }

  /** Keeps the row as it is. @param {{ t: number, dir: 'out'|'in', station: any, bytes: Buffer, note: string }} row whose bytes nobody changes any more */
  keep(row) {
    if (row.bytes.length > MOST_BYTES) row.bytes = copyOf(row.bytes)
    this.#put(row, false)
  }

  #put(row, grows) {
    if (this.#rows.length < this.#limit) this.#rows.push(row)
    else this.#rows[this.#at] = row
    this.#at = (this.#at + 1) % this.#limit
    this.#tell(row, grows)
  }

  /** Bytes that belong to nothing: joined to the row before if that is the same burst. */
  addStray({ t, bytes, note }) {
    const last = this.#rows[(this.#at + this.#limit - 1) % this.#limit]
    if (!last || last.note !== note || t - last.t > BURST) {
      return this.#put({ t, dir: 'in', station: null, bytes: copyOf(bytes), note }, true)
    }
    last.t = t
    if (last.bytes.length < MOST_BYTES) last.bytes = Buffer.concat([last.bytes, bytes]).subarray(0, MOST_BYTES)
  }

  /** @returns {{ t: number, dir: string, station: any, bytes: string, note: string }[]} bytes in hex */
  rows() {
    const rows = [...this.#rows.slice(this.#at), ...this.#rows.slice(0, this.#at)]
    return rows.map(row => ({ ...row, bytes: row.bytes.toString('hex') }))
  }
}

module.exports = { Trace }
