'use strict'

/**
 * Requests in a row that nobody answered. What a station that has answered on this connection leaves unanswered says more of the connection than
 * what others do, which may not be there at all.
 */
class Missing {
  #all = 0
  #known = 0
  #stations = new Set()

  /** A new connection: nobody has answered on it. The row goes on. */
  opened() {
    this.#known = 0
    this.#stations.clear()
  }

  /** @param {any} station */
  answered(station) {
    this.#all = 0
    this.#known = 0
    this.#stations.add(station)
  }

  /** @param {any} station @returns {{ all: number, known: number }} so many now; known: of stations that have answered on this connection */
  missed(station) {
    this.#all++
    if (this.#stations.has(station)) this.#known++
    return { all: this.#all, known: this.#known }
  }
}

module.exports = { Missing }
