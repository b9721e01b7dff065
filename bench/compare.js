'use strict'

/**
 * Reads of holding registers on lines that keep the pace of 9600 bit/s, by our device and by other libraries, in turn in the same run: processor and
 * cycle time of one request. Each client has a line of its own, which stays open from the beginning to the end, as on a gateway.
 */
const { startFarEnd } = require('./far-end')
const { median } = require('./measure')
const { clients } = require('./peers')

const BAUD = 9600
const STATION = 11
const TURNAROUND = 5
/** Of each round, after a pause in which others had their turn. */
const WARM_UP = 3

const CHARACTER = 10000 / BAUD
/** Silence before a request, which RTU asks for (MODBUS over serial line, 2.5.1.1) and the peers do not keep. */
const SILENCE = 3.5 * CHARACTER

const settings = { stations: [{ device: 'chino', station: STATION }], baudRate: BAUD, turnaround: TURNAROUND }

/** All clients, each on a line of its own. */
const openAll = async (names, all, { links, count }) => {
  const open = {}
  for (const [at, name] of names.entries()) {
    open[name] = await all[name]({ link: links[at], baudRate: BAUD, station: STATION, count })
  }
  return open
}

/**
 * All clients in turn, some rounds. Before that all of them at the same time, as often as they need until the engine has translated what they do: who
 * reads day and night has that behind him.
 * @param {{ chunk: number, count: number, precise: boolean, before: number, requests: number, rounds: number }} options chunk: bytes that arrive at
 *   once; precise: see far-end.js; before: requests before anything is measured; requests: of a round
 * @returns {Promise<Record<string, { cpu: number, cycle: number }[]>>} ms of one request in each round, by client
 */
const compare = async ({ chunk, count, precise, before, requests, rounds }) => {
  const all = clients()
  const names = Object.keys(all)
  const far = await startFarEnd({ ...settings, quiet: true, precise, chunk, lines: names.length })
  const seen = Object.fromEntries(names.map(name => [name, /** @type {any[]} */ ([])]))
  try {
    const open = await openAll(names, all, { links: far.links, count })
    await Promise.all(names.map(name => open[name].run(before)))
    for (let round = 0; round < rounds; round++) {
      for (const name of names) {
        await open[name].run(WARM_UP)
        seen[name].push(await open[name].run(requests))
      }
    }
    await Promise.all(names.map(name => open[name].close()))
  } finally {
    await far.close()
  }
  return seen
}

/**
 * What the machine does besides changes by the minute: so each round of ours is compared with that of the peer beside it, and the middle one of these
 * ratios counts.
 * @param {Record<string, any[]>} seen rounds by client
 * @param {{ name: string, own: (round: any) => number, theirs: (round: any) => number, most: (peer: string) => number }} what
 */
function* beside({ ours, ...peers }, { name, own, theirs, most }) {
  const value = median(ours.map(own))
  for (const [against, peer] of Object.entries(peers)) {
    const ratio = median(ours.map((round, at) => own(round) / theirs(peer[at])))
    yield { name, value, unit: 'ms', against, ratio, goal: ['<=', most(against)] }
  }
}

/**
 * Rows of one case. The processor time is measured beside stations that take little of it themselves, the cycle beside stations that are never late: a
 * simulator hears a query the later the longer the pause before it was, a wire does not.
 * @param {{ chunk: number, count: number, before: number, requests: number, rounds: number, most: Record<string, number> }} each most: that our
 *   processor time may be of the peer's, by peer
 */
async function* comparison({ most, ...each }) {
  const arrival = each.chunk === 1 ? 'byte by byte' : `${each.chunk} bytes at once`
  const name = `${each.count} registers at ${BAUD} bit/s, ${arrival}`
  const cpu = round => round.cpu
  const work = await compare({ ...each, precise: false })
  yield* beside(work, { name: `${name}, processor`, own: cpu, theirs: cpu, most: peer => most[peer] })
  // what they do is translated by now
  const pace = await compare({ ...each, precise: true, before: WARM_UP })
  yield* beside(pace, {
    name: `${name}, cycle less the silence of RTU`,
    own: round => round.cycle - SILENCE,
    theirs: round => round.cycle,
    most: () => 1
  })
}

module.exports = { comparison }
