'use strict'

/**
 * The least line time of a few reads, by trying everything: every way to share requests, every form of each. Written from the rules of the
 * protocol, not from the planner.
 */

const LAST = 0x3fff

/** Every way to put n things into heaps. */
function* partitions(n) {
  const heaps = []
  function* place(at) {
    if (at === n) {
      yield heaps
      return
    }
    for (let heap = 0; heap <= heaps.length; heap++) {
      if (heap === heaps.length) heaps.push([])
      heaps[heap].push(at)
      yield* place(at + 1)
      heaps[heap].pop()
      if (heaps[heap].length === 0) heaps.pop()
    }
  }
  yield* place(0)
}

const range = (from, to) => Array.from({ length: to - from }, (_, at) => from + at)

/** INFO bytes of one block over these spans, both ways, or null. */
const block = (kind, spans, limits) => {
  const size = kind === 'bit' ? 16 : 1
  const start = Math.min(...spans.map(span => span[0]))
  const end = Math.max(...spans.map(span => span[1]))
  const count = end - start
  const most = kind === 'bit' ? Math.min(limits.readBits, limits.info) : Math.min(limits.readWords, limits.info / 2)
  if (count > most) return null
  const asked = new Set(spans.flatMap(([from, to]) => range(from, to)))
  const bridged = range(start, end).filter(address => !asked.has(address))
  if (limits.bridge === false && bridged.length > 0) return null
  for (const hole of limits.holes ?? []) {
    if (hole.kind === kind && bridged.some(address => hole.start <= address && address < hole.end)) return null
  }
  // a border may be crossed only by a value that stands on it itself
  for (const bound of limits.bounds ?? []) {
    const at = bound * size
    if (start < at && at < end && !spans.some(([from, to]) => from < at && at < to)) return null
  }
  const { unit = 1, bitBytes = 1, scale = 1 } = limits
  const bytes = kind === 'word' ? 2 * count : Math.ceil(Math.ceil(count / unit) * unit * bitBytes)
  return { query: 3, answer: scale * bytes }
}

const isJoint = (word, { joint = [] }) => joint.some(([from, to]) => from <= word && word < to)
const wordSpan = ({ kind, address, count }) =>
  kind === 'word' ? [address, address + count] : [address >> 4, ((address + count - 1) >> 4) + 1]

/** INFO bytes of the mixed request with the fewest bytes: each value whole by its bits or whole by words that are read. */
const mixed = (points, limits) => {
  const most = Math.min(limits.readMixed, Math.floor(limits.info / 2))
  const words = new Set(points.filter(({ kind }) => kind === 'word').flatMap(point => range(...wordSpan(point))))
  const onBits = points.filter(({ kind }) => kind === 'bit')
  const free = [...new Set(onBits.flatMap(point => range(...wordSpan(point))))].filter(word => isJoint(word, limits))
  let best = null
  for (let choice = 0; choice < 1 << free.length; choice++) {
    const chosen = new Set([...words, ...free.filter((_, at) => choice & (1 << at))])
    const held = point => range(...wordSpan(point)).every(word => chosen.has(word) && isJoint(word, limits))
    const alone = onBits.filter(point => !held(point))
    const single = new Set(alone.flatMap(({ address, count }) => range(address, address + count)))
    const count = chosen.size + single.size
    if (count < 2 || count > most || [...chosen, ...single].some(address => address > LAST)) continue
    const bytes = { query: 2 * count, answer: 2 * chosen.size + single.size }
    if (!best || bytes.query + bytes.answer < best.query + best.answer) best = bytes
  }
  return best
}

/** All forms of one request for these points, with what they cost. */
const forms = (points, limits) => {
  const all = []
  if (points.every(({ kind }) => kind === 'bit')) {
    const spans = points.map(({ address, count }) => [address, address + count])
    all.push(block('bit', spans, limits))
  }
  if (points.every(point => point.kind === 'word' || range(...wordSpan(point)).every(word => isJoint(word, limits)))) {
    all.push(block('word', points.map(wordSpan), limits))
  }
  all.push(mixed(points, limits))
  return all.filter(Boolean).map(({ query, answer }) => {
    const cost = limits.frameCost + query + answer
    return { cost, saved: limits.again === undefined ? 0 : Math.max(0, cost - limits.again - answer) }
  })
}

/** The cheapest cycle with one form for each heap: one request is repeated each time, of several the two at the ends every other time. */
const cycle = heaps => {
  if (heaps.length === 1) return Math.min(...heaps[0].map(({ cost, saved }) => cost - saved))
  let least = Infinity
  const pick = (at, cost, saved) => {
    if (at === heaps.length) {
      const [one, two] = [...saved].sort((a, b) => b - a)
      least = Math.min(least, cost - (one + two) / 2)
      return
    }
    for (const form of heaps[at]) pick(at + 1, cost + form.cost, [...saved, form.saved])
  }
  pick(0, 0, [])
  return least
}

/**
 * @param {{ kind: 'bit'|'word', address: number, count: number }[]} points distinct
 * @param {any} limits
 * @returns {number} byte times of a cycle; Infinity: it cannot be read
 */
const leastCost = (points, limits) => {
  const known = new Map()
  const formsOf = heap => {
    const key = heap.join()
    if (!known.has(key)) {
      known.set(
        key,
        forms(
          heap.map(at => points[at]),
          limits
        )
      )
    }
    return known.get(key)
  }
  let least = Infinity
  for (const heaps of partitions(points.length)) {
    const all = heaps.map(formsOf)
    if (all.every(each => each.length > 0)) least = Math.min(least, cycle(all))
  }
  return least
}

module.exports = { leastCost }
