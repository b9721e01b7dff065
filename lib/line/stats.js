'use strict'

const { Waits } = require('./waits')

const STATION = ['queries', 'answers', 'timeouts', 'incomplete', 'crcErrors', 'late', 'overruns']
const LISTENING = ['messagesOut', 'messagesIn', 'damagedMessages', 'tornWrites', 'stops']
const BYTES = ['skippedBytes', 'strayBytes', 'echoes', 'queueFull', 'bytesOut', 'bytesIn', 'reconnects']
const LINE = [...STATION, ...BYTES, ...LISTENING]

const zeros = names => Object.fromEntries(names.map(name => [name, 0]))

/** Counters of a line and of each of its stations. Plain numbers; they only grow. */
class Stats {
  /** @type {Record<string, number>} */
  #line = { ...zeros(LINE), busy: 0 }
  #stations = new Map()
  /** What is remembered of each station, over redeploys. @type {Map<any, any>} */
  #memories = new Map()

  /** @param {Map<any, any>} memories per station, kept by the pool */
  remember(memories) {
    this.#memories = memories
  }

  /** @param {string} name @param {any} [station] counted for it as well */
  count(name, station = null) {
    this.#line[name]++
    if (station !== null) this.#of(station).counts[name]++
  }

  /** @param {string} name @param {number} amount */
  add(name, amount) {
    this.#line[name] += amount
  }

  /** @param {any} station @param {number} bytes of the query */
  asked(station, bytes) {
    this.#line.queries++
    this.#line.bytesOut += bytes
    this.#of(station).counts.queries++
  }

  /** @param {any} station @param {number} ms from the computed end of sending to the end of the answer */
  answered(station, ms) {
    const latency = this.#of(station)
    this.#line.answers++
    latency.counts.answers++
    latency.min = Math.min(latency.min, ms)
    latency.max = Math.max(latency.max, ms)
    latency.sum += ms
  }

  /** @param {any} station @param {number} ms from the computed end of sending to the first byte of the answer */
  waited(station, ms) {
    const memory = this.#memories.get(station)
    if (!memory) return
    memory.waits ??= new Waits()
    memory.waits.add(ms)
  }

  /** Grows with every byte that was not an answer. */
  get strays() {
    const { strayBytes, skippedBytes, crcErrors } = /** @type {any} */ (this.#line)
    return strayBytes + skippedBytes + crcErrors
  }

  #of(station) {
    let entry = this.#stations.get(station)
    if (!entry) {
      entry = { counts: zeros(STATION), min: Infinity, max: 0, sum: 0 }
      this.#stations.set(station, entry)
    }
    return entry
  }

  /**
   * A copy: `{ queries, …, busy, stations: { [station]: { queries, …, latency: { min, mean, max, p99 } | null, health, since, advice } } }`;
   * health and since (epoch ms) are what the devices left in the station's memory; advice: a timeout that would do, ms, or null.
   */
  snapshot() {
    const stations = {}
    for (const [station, { counts, min, max, sum }] of this.#stations) {
      const { waits, health, advice } = this.#memories.get(station) ?? {}
      const p99 = waits?.p99 ?? null
      const latency = counts.answers > 0 ? { min, mean: sum / counts.answers, max, p99 } : null
      stations[String(station)] = {
        ...counts,
        latency,
        health: health?.state ?? 'online',
        since: health?.since ?? null,
        advice: advice ?? null
      }
    }
    return { ...this.#line, stations }
  }
}

module.exports = { Stats }
