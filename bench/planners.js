'use strict'

/**
 * Other ways to plan reads, to compare with: what the well-known packages do. Written from the rules of the protocol, not from lib/plan.
 *
 * @typedef {{ kind: 'bit'|'word', address: number, count: number }} Point
 * @typedef {{ ask: 'readBits'|'readWords', base: number, count: number, points: { point: number, at: number, count: number }[], cost: number, again: number }} Request
 * @typedef {{ readBits: number, readWords: number, frameCost: number, bounds: number[] }} Limits bounds: absolute word addresses at which areas begin
 *   or end; frameCost: byte times of a request beside its INFO
 */

const QUERY = 3
const BYTES = { bit: 1, word: 2 }
const WORD = { bit: 16, word: 1 }

/** @returns {Request} one block over these members, in order of address */
const block = (members, { frameCost }) => {
  const [{ kind, address: base }] = members
  const count = Math.max(...members.map(member => member.address + member.count)) - base
  const cost = frameCost + QUERY + BYTES[kind] * count
  const points = members.map(({ point, address, count: own }) => ({ point, at: address - base, count: own }))
  return { ask: kind === 'bit' ? 'readBits' : 'readWords', base, count, points, cost, again: cost }
}

/** A request for each item. @param {Point[]} points @param {Limits} limits @returns {Request[]} */
const onePerItem = (points, limits) => points.map((each, point) => block([{ ...each, point }], limits))

const areaOf = ({ kind, address }, { bounds }) => bounds.filter(bound => bound * WORD[kind] <= address).length

/** What is joined: the same kind and area, inside the limit, over a gap that costs no more than another request. */
const joins = (members, next, limits) => {
  const [first] = members
  if (first.kind !== next.kind || areaOf(first, limits) !== areaOf(next, limits)) return false
  const end = Math.max(...members.map(member => member.address + member.count))
  const most = first.kind === 'bit' ? limits.readBits : limits.readWords
  if (Math.max(end, next.address + next.count) - first.address > most) return false
  return (next.address - end) * BYTES[first.kind] <= limits.frameCost + QUERY
}

/**
 * In order of address, each item joins the block before it where reading the gap costs no more than another request.
 * @param {Point[]} points @param {Limits} limits @returns {Request[]}
 */
const greedy = (points, limits) => {
  const sorted = points.map((each, point) => ({ ...each, point }))
  sorted.sort((a, b) => a.kind.localeCompare(b.kind) || a.address - b.address || a.count - b.count)
  const blocks = []
  for (const next of sorted) {
    const last = blocks.at(-1)
    if (last && joins(last, next, limits)) last.push(next)
    else blocks.push([next])
  }
  return blocks.map(members => block(members, limits))
}

module.exports = { greedy, onePerItem }
