'use strict'

/**
 * Reads of holding registers on a line that keeps the pace of 9600 bit/s, by our device and by other libraries, in turn on the same port in the
 * same run: processor and cycle time of one request.
 */
const { startFarEnd } = require('./far-end')
const { clients } = require('./peers')

const BAUD = 9600
const STATION = 11
const TURNAROUND = 5
const WARM_UP = 3
/** Before anything is measured, on a line that is as fast as it gets: who reads day and night has code that the engine has translated. */
const RUN_IN = { baudRate: 115200, turnaround: 1 }

const CHARACTER = 10000 / BAUD
/** Silence before a request, which RTU asks for (MODBUS over serial line, 2.5.1.1) and the peers do not keep. */
const SILENCE = 3.5 * CHARACTER

const stations = [{ device: 'chino', station: STATION }]

/** Every client as often. */
const runIn = async (all, { chunk, count, requests }) => {
  const far = await startFarEnd({ stations, ...RUN_IN, quiet: true, chunk })
  try {
    for (const client of Object.values(all)) {
      const { run, close } = await client({ link: far.link, baudRate: RUN_IN.baudRate, station: STATION, count })
      await run(requests).finally(close)
    }
  } finally {
    await far.close()
  }
}

/** @returns {Promise<{ cpu: number, cycle: number }>} */
const measure = async (client, link, { count, requests }) => {
  const { run, close } = await client({ link, baudRate: BAUD, station: STATION, count })
  try {
    await run(WARM_UP)
    return await run(requests)
  } finally {
    await close()
  }
}

/**
 * All clients in turn, some rounds; the best of each: what else the machine does only adds.
 * @param {{ chunk: number, count: number, before: number, requests: number, rounds: number }} options chunk: bytes that arrive at once; before:
 *   requests before anything is measured; requests: of a round
 * @returns {Promise<Record<string, { cpu: number, cycle: number }>>} ms of one request, by client
 */
const compare = async ({ chunk, rounds, before, ...each }) => {
  const all = clients()
  await runIn(all, { chunk, count: each.count, requests: before })
  const far = await startFarEnd({ stations, baudRate: BAUD, turnaround: TURNAROUND, quiet: true, chunk })
  const seen = Object.fromEntries(Object.keys(all).map(name => [name, /** @type {any[]} */ ([])]))
  try {
    for (let round = 0; round < rounds; round++)
      for (const name of Object.keys(all)) seen[name].push(await measure(all[name], far.link, each))
  } finally {
    await far.close()
  }
  const best = (name, what) => Math.min(...seen[name].map(row => row[what]))
  return Object.fromEntries(
    Object.keys(all).map(name => [name, { cpu: best(name, 'cpu'), cycle: best(name, 'cycle') }])
  )
}

/**
 * Rows of one case.
 * @param {{ chunk: number, count: number, before: number, requests: number, rounds: number, most: Record<string, number> }} each most: that our processor time may be
 *   of the peer's, by peer
 */
async function* comparison({ most, ...each }) {
  const { ours, ...peers } = await compare(each)
  const arrival = each.chunk === 1 ? 'byte by byte' : `${each.chunk} bytes at once`
  const name = `${each.count} registers at ${BAUD} bit/s, ${arrival}`
  for (const [against, peer] of Object.entries(peers)) {
    const cycle = ours.cycle - SILENCE
    const own = { unit: 'ms', against }
    yield {
      ...own,
      name: `${name}, processor`,
      value: ours.cpu,
      ratio: ours.cpu / peer.cpu,
      goal: ['<=', most[against]]
    }
    yield {
      ...own,
      name: `${name}, cycle less the silence of RTU`,
      value: cycle,
      ratio: cycle / peer.cycle,
      goal: ['<=', 1]
    }
  }
}

module.exports = { comparison }
