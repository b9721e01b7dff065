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
 * @param {{ chunk: number, count: number, before: number, requests: number, rounds: number }} options chunk: bytes that arrive at once; before:
 *   requests before anything is measured; requests: of a round
 * @returns {Promise<Record<string, { cpu: number, cycle: number }[]>>} ms of one request in each round, by client
 */
const compare = async ({ chunk, count, before, requests, rounds }) => {
  const all = clients()
  const names = Object.keys(all)
  const far = await startFarEnd({ ...settings, quiet: true, chunk, lines: names.length })
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
 * Rows of one case. What the machine does besides changes by the minute: so each round of ours is compared with that of the peer beside it, and the
 * middle one of these ratios counts.
 * @param {{ chunk: number, count: number, before: number, requests: number, rounds: number, most: Record<string, number> }} each most: that our
 *   processor time may be of the peer's, by peer
 */
async function* comparison({ most, ...each }) {
  const { ours, ...peers } = await compare(each)
  const arrival = each.chunk === 1 ? 'byte by byte' : `${each.chunk} bytes at once`
  const name = `${each.count} registers at ${BAUD} bit/s, ${arrival}`
  const cpu = row => row.cpu
  const cycle = row => row.cycle - SILENCE
  for (const [against, peer] of Object.entries(peers)) {
    const row = (what, own, theirs, goal) => ({
      name: `${name}, ${what}`,
      value: median(ours.map(own)),
      unit: 'ms',
      against,
      ratio: median(ours.map((round, at) => own(round) / theirs(peer[at]))),
      goal
    })
    yield row('processor', cpu, cpu, ['<=', most[against]])
    yield row('cycle less the silence of RTU', cycle, round => round.cycle, ['<=', 1])
  }
}

module.exports = { comparison }
