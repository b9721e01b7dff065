'use strict'

/**
 * A function of an object that nobody changes and that comes again and again, as the requests of a plan do: its result is made once for each.
 * @template {WeakKey} K
 * @template V
 * @param {(key: K) => V} make
 * @returns {(key: K) => V}
 */
const remembered = make => {
  /** @type {WeakMap<K, { value: V }>} */
  const known = new WeakMap()
  return key => {
    let found = known.get(key)
    if (!found) known.set(key, (found = { value: make(key) }))
    return found.value
  }
}

module.exports = { remembered }
