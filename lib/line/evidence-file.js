'use strict'

const fs = require('node:fs/promises')
const path = require('node:path')
const { lineOf, rowsOf } = require('./evidence-text')

/** The file and the one before it, bytes each. */
const MOST_BYTES = 512 * 1024
/** What is given within so many ms is written at once. */
const BATCH = 2000
const MOST_WAITING = 2000
/** Flash disks wear out: bytes a minute on average, and what may be written at once after a quiet time. */
const RATE = 64 * 1024
const MOST_AT_ONCE = 256 * 1024
/** Frames leave so much of it to events. */
const RESERVE = 16 * 1024
/** A disk that failed is left alone for so long, ms. */
const REST = 60000
/** Closing a line waits for the disk this long at most, ms. */
const LAST = 250

/** How much may be written now. */
class Budget {
  #clock
  #left = MOST_AT_ONCE
  #at

  /** @param {any} clock */
  constructor(clock) {
    this.#clock = clock
    this.#at = clock.now()
  }

  /** @param {number} bytes @param {boolean} isFrame @returns {boolean} whether they may be written; then they are taken off */
  take(bytes, isFrame) {
    const now = this.#clock.now()
    this.#left = Math.min(MOST_AT_ONCE, this.#left + ((now - this.#at) * RATE) / 60000)
    this.#at = now
    if (bytes + (isFrame ? RESERVE : 0) > this.#left) return false
    this.#left -= bytes
    return true
  }
}

/**
 * The evidence of one wire on disk: lines of JSON, in the file and the one before it. Nobody waits for it; what the disk does not take is counted.
 */
class EvidenceFile {
  #clock
  #budget
  #waiting = []
  #timer = null
  /** @type {Promise<void> | null} */
  #writing = null
  /** bytes in the file; -1: not known */
  #size = -1
  #restUntil = -Infinity
  #told = false
  #skippedNow = 0
  #counts = { written: 0, skipped: 0, lost: 0 }
  /** @type {{ code: string, text: string } | null} */
  #error = null

  /** @param {{ clock: any, folder: string, name: string }} options name: of the file, without its end */
  constructor({ clock, folder, name }) {
    this.#clock = clock
    this.#budget = new Budget(clock)
    this.folder = folder
    this.file = path.join(folder, `${name}.jsonl`)
    this.previous = path.join(folder, `${name}.1.jsonl`)
  }

  /**
   * `written` lines; `skipped` because too many came in too short a time; `lost` because the disk did not take them; `error` of the disk now, or
   * null.
   */
  get facts() {
    return { file: this.file, previous: this.previous, ...this.#counts, error: this.#error }
  }

  /** @param {any} entry of evidence.js */
  add(entry) {
    if (this.#waiting.length >= MOST_WAITING) return void this.#counts.lost++
    this.#waiting.push(entry)
    if (this.#timer === null && !this.#writing) this.#timer = this.#clock.setTimer(() => this.#write(), BATCH)
  }

  #write() {
    this.#clock.clearTimer(this.#timer)
    this.#timer = null
    if (this.#writing || this.#waiting.length === 0) return
    const lines = this.#affordable(this.#waiting.splice(0))
    this.#writing = this.#put(lines).then(() => {
      this.#writing = null
      if (this.#waiting.length > 0) this.#timer ??= this.#clock.setTimer(() => this.#write(), BATCH)
    })
  }

  #affordable(entries) {
    const lines = []
    for (const entry of entries) {
      const line = lineOf(entry)
      if (line === '') this.#counts.lost++
      else if (this.#budget.take(Buffer.byteLength(line), entry.is === 'frame')) {
        if (this.#skippedNow > 0) lines.push(lineOf({ is: 'skipped', t: this.#clock.wall(), rows: this.#skippedNow }))
        this.#skippedNow = 0
        lines.push(line)
      } else {
        this.#skippedNow++
        this.#counts.skipped++
      }
    }
    return lines
  }

  async #put(lines) {
    if (this.#clock.now() < this.#restUntil) return void (this.#counts.lost += lines.length)
    let from = 0
    try {
      while (from < lines.length) from = await this.#append(lines, from)
      if (lines.length > 0) this.#error = null
    } catch (error) {
      this.#counts.lost += lines.length - from
      this.#failed(error)
    }
  }

  /** Writes what fits into the file. @returns {Promise<number>} where it goes on */
  async #append(lines, from) {
    if (this.#size < 0) this.#size = await this.#prepare()
    let size = this.#size
    let to = from
    while (to < lines.length && size + Buffer.byteLength(lines[to]) <= MOST_BYTES)
      size += Buffer.byteLength(lines[to++])
    if (to === from) {
      await fs.rename(this.file, this.previous)
      this.#size = 0
      return from
    }
    await fs.appendFile(this.file, lines.slice(from, to).join(''))
    this.#size = size
    this.#counts.written += to - from
    return to
  }

  async #prepare() {
    await fs.mkdir(this.folder, { recursive: true })
    const file = await fs.open(this.file, 'a+')
    try {
      const { size } = await file.stat()
      if (size === 0) return 0
      const { buffer } = await file.read({ buffer: Buffer.alloc(1), position: size - 1 })
      if (buffer.toString() === '\n') return size
      // a line was torn: the next one begins anew
      await file.appendFile('\n')
      return size + 1
    } finally {
      await file.close()
    }
  }

  #failed(error) {
    this.#size = -1
    this.#restUntil = this.#clock.now() + REST
    this.#error = { code: String(error?.code ?? 'unknown'), text: String(error?.message ?? error) }
    if (this.#told) return
    this.#told = true
    process.emitWarning(`the frames around faults cannot be kept in ${this.file}: ${this.#error.text}`)
  }

  /** Writes what waits, at once. @returns {Promise<void>} never rejects */
  async flush() {
    while (this.#writing || this.#waiting.length > 0) {
      if (!this.#writing) this.#write()
      await this.#writing
    }
  }

  /** A line was closed: what waits is written. @param {() => void} done called once, soon */
  settle(done) {
    if (!this.#writing && this.#waiting.length === 0) return done()
    let timer = null
    const end = () => {
      if (timer === null) return
      this.#clock.clearTimer(timer)
      timer = null
      done()
    }
    timer = this.#clock.setTimer(end, LAST)
    this.flush().then(end)
  }

  /** The last rows, oldest first. @param {number} most @returns {Promise<any[]>} never rejects */
  async tail(most) {
    await this.flush()
    const rows = rowsOf(await readEnd(this.file))
    const before = rows.length < most ? rowsOf(await readEnd(this.previous)) : []
    return [...before, ...rows].slice(-most)
  }
}

/** @param {string} name @returns {Promise<string>} '' if there is no such file */
const readEnd = async name => {
  try {
    const file = await fs.open(name)
    try {
      const { size } = await file.stat()
      const length = Math.min(size, MOST_BYTES)
      const { buffer, bytesRead } = await file.read({ buffer: Buffer.alloc(length), position: size - length })
      return buffer.toString('utf8', 0, bytesRead)
    } finally {
      await file.close()
    }
  } catch {
    return ''
  }
}

module.exports = { EvidenceFile }
