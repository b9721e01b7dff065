'use strict'

const before = (a, b) => a.at < b.at || (a.at === b.at && a.order < b.order)

/** A binary heap of timers: earliest first, then in the order in which they were set. */
function createHeap() {
  const items = []
  const push = item => {
    let at = items.push(item) - 1
    while (at > 0) {
      const parent = (at - 1) >> 1
      if (!before(item, items[parent])) break
      items[at] = items[parent]
      at = parent
    }
    items[at] = item
  }
  const pop = () => {
    const top = items[0]
    const last = items.pop()
    if (items.length === 0) return top
    let at = 0
    for (;;) {
      let child = 2 * at + 1
      if (child >= items.length) break
      if (child + 1 < items.length && before(items[child + 1], items[child])) child++
      if (!before(items[child], last)) break
      items[at] = items[child]
      at = child
    }
    items[at] = last
    return top
  }
  return { push, pop, first: () => items[0] }
}

module.exports = { createHeap }
