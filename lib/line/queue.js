'use strict'

/** Classes in the order in which they go; within a class the stations take turns, within a station the oldest goes. */
const PRIORITY = Object.freeze({ WRITE: 0, ASK: 1, POLL: 2 })
const CLASSES = Object.values(PRIORITY)
const LAST = Object.freeze({ first: false })

/**
 * What waits for the line. Knows no time: whether a station may be asked now is the caller's answer.
 * A waiting entry needs `{ priority, station, share }`; `share` is the key under which another may join it, or null.
 */
class Queue {
  #limit
  #most
  #size = 0
  /** per class: station -> entries, in the order of turns */
  #classes = CLASSES.map(() => new Map())
  /** per class: how often a higher class went while this one waited */
  #passed = CLASSES.map(() => 0)
  #shared = new Map()

  /** @param {{ limit: number, most: number }} options most: runs of higher classes in a row while a lower one waits */
  constructor({ limit, most }) {
    this.#limit = limit
    this.#most = most
  }

  get size() {
    return this.#size
  }

  get full() {
    return this.#size >= this.#limit
  }

  /** The entry that waits under this key. */
  waiting(share) {
    return this.#shared.get(share)
  }

  /** @param {any} entry @param {{ first?: boolean }} [options] first: before the others of its station */
  add(entry, { first } = LAST) {
    const stations = this.#classes[entry.priority]
    const list = stations.get(entry.station)
    if (!list) stations.set(entry.station, [entry])
    else if (first) list.unshift(entry)
    else list.push(entry)
    if (entry.share !== null) this.#shared.set(entry.share, entry)
    this.#size++
  }

  /** @returns {boolean} whether it was waiting */
  remove(entry) {
    const stations = this.#classes[entry.priority]
    const list = stations.get(entry.station)
    const at = list ? list.indexOf(entry) : -1
    if (at < 0) return false
    this.#take(stations, list, at)
    return true
  }

  #take(stations, list, at) {
    const entry = list[at]
    if (at === 0) list.shift()
    else list.splice(at, 1)
    if (list.length === 0) stations.delete(entry.station)
    if (entry.share !== null && this.#shared.get(entry.share) === entry) this.#shared.delete(entry.share)
    this.#size--
    return entry
  }

  /**
   * Takes out the next entry whose station may be asked.
   * @param {(entry: any) => boolean} ready asked for the first entry of each station
   * @returns {any} undefined: nobody is ready
   */
  next(ready) {
    for (const priority of this.#order()) {
      const stations = this.#classes[priority]
      if (stations.size === 0) continue
      for (const list of stations.values()) {
        if (!ready(list[0])) continue
        const entry = this.#take(stations, list, 0)
        // to the end of the turn
        if (list.length > 0) {
          stations.delete(entry.station)
          stations.set(entry.station, list)
        }
        this.#count(priority)
        return entry
      }
    }
    return undefined
  }

  /** Highest class first, but a class that was passed over often enough goes before. */
  #order() {
    if (!this.#isAnyStarved) return CLASSES
    const starved = CLASSES.filter(c => this.#isStarved(c))
    starved.sort((a, b) => this.#passed[b] - this.#passed[a])
    return [...starved, ...CLASSES.filter(c => !starved.includes(c))]
  }

  #isStarved(c) {
    return this.#passed[c] >= this.#most && this.#classes[c].size > 0
  }

  get #isAnyStarved() {
    for (const c of CLASSES) if (this.#isStarved(c)) return true
    return false
  }

  #count(priority) {
    this.#passed[priority] = 0
    for (const c of CLASSES) {
      if (c > priority) this.#passed[c] = this.#classes[c].size > 0 ? this.#passed[c] + 1 : 0
    }
  }

  /** The first waiting entry of each station of each class. */
  *heads() {
    for (const stations of this.#classes) for (const list of stations.values()) yield list[0]
  }

  /** All that waits, highest class first. */
  all() {
    return this.#classes.flatMap(stations => [...stations.values()].flat())
  }
}

module.exports = { PRIORITY, Queue }
