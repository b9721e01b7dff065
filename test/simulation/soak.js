'use strict'

/**
 * Long safety and liveness runs: many whole systems, each of them drawn from the seed: which stations, what line, what settings, which faults.
 * The same seed gives the same runs, exchange by exchange; one of them can be repeated alone.
 */

const { createRandom } = require('../../lib/sim')
const { FAULTS, safetyRun } = require('./run')
const { NX, regulators } = require('./workload')

const SEGMENT = 5000 // exchanges of one system
const PHASE = 500 // exchanges until the faults stop, in liveness mode

/** Rows of stations, and what of the faults is claimed: an LRC surely sees one flipped bit. */
const PROTOCOLS = {
  nx: { rows: NX, faults: FAULTS },
  rtu: { rows: regulators('rtu'), faults: FAULTS },
  ascii: { rows: regulators('ascii'), faults: FAULTS.map(f => (f.kind === 'crc' ? { ...f, argument: 1 } : f)) }
}
const MODES = ['safety', 'liveness']

/**
 * Two faults at once are not claimed where an answer bears nothing of its query (MODBUS): an old frame behind an answer, or our own before it, may be
 * all that is left whole.
 */
const WITH_ANOTHER = new Set(['merged', 'echo'])

/**
 * One system, drawn.
 * @param {number} seed of the segment
 * @param {{ protocol: string, mode: string, exchanges: number }} options
 * @returns {Parameters<typeof safetyRun>[0]}
 */
function drawRun(seed, { protocol, mode, exchanges }) {
  const random = createRandom(seed)
  const { rows, faults } = PROTOCOLS[protocol]
  const live = mode === 'liveness'
  const collisions = random.pick([/** @type {const} */ ('seen'), false])
  const share = live ? 1 : random.pick([0.1, 0.3, 0.6, 1])
  // ms behind the first: within the silence that is kept before the next query; later it is a late answer that nobody misses
  const again = random.integer(0, 1)
  const alone = collisions && protocol !== 'nx'
  const claimed = faults
    .filter(({ kind }) => !(alone && WITH_ANOTHER.has(kind)))
    .map(fault => (fault.kind === 'duplicated' ? { ...fault, argument: again } : fault))
  const stations = rows.filter(() => random.chance(0.7))
  const [least, most] = random.pick([
    [300, 2400],
    [1000, 1000],
    [100, 8000]
  ])
  const demoteAfter = random.pick([0, 1, 3, 3, 10])
  return {
    seed,
    exchanges,
    collisions,
    polls: true,
    phases: live ? Math.max(2, Math.ceil(exchanges / PHASE)) : 1,
    // who waits for a free line may be later than his fault says, and only lateness within the bound is claimed
    wire: collisions ? {} : { latenessBound: 2000 },
    echo: random.chance(0.25),
    baudRate: random.pick([9600, 19200, 38400, 115200]),
    faults: claimed.map(fault => ({ ...fault, rate: fault.rate * share })),
    stations: stations.length > 0 ? stations : rows.slice(0, 1),
    unplugs: random.pick(live ? [0.002, 0.005] : [0, 0.001, 0.003]),
    pause: random.pick([5, 20, 60]),
    device: {
      timeout: random.pick([100, 150, 300]),
      attempts: random.pick([1, 2, 3]),
      demoteAfter,
      probeFirst: least,
      probeMost: most
    }
  }
}

const emptyTotal = ({ seed, protocol, mode }) => ({
  result: {
    exchanges: 0,
    wrong: 0,
    unsettled: 0,
    doubledWrites: 0,
    lateSeen: 0,
    recoveredWithinBound: true,
    seed
  },
  detail: { protocol, mode, segments: 0, asked: 0, good: 0, bad: 0, cycles: 0, hours: 0, redeploys: 0, unplugged: 0 },
  outcomes: { confirmed: 0, unknown: 0, refused: 0, failed: 0 },
  faults: {},
  events: {},
  recovery: { phases: 0, longest: 0, bound: 0 },
  failures: /** @type {any[]} */ ([])
})

const addAll = (sums, more) => {
  for (const [name, number] of Object.entries(more)) sums[name] = (sums[name] ?? 0) + number
}

/** What is wrong with a run, as counts; all 0 where nothing is. */
const judgeRun = report => ({
  wrong: report.wrong.length + report.misreported.length,
  unsettled: report.asked - report.settled + report.open + report.timers + Object.keys(report.rejected).length,
  doubledWrites: report.doubled.length,
  late: report.overdue.length + report.relapses
})

function add(total, report, { segment, phases }) {
  const { result, detail, recovery, failures } = total
  const { late, ...counts } = judgeRun(report)
  addAll(result, { exchanges: report.exchanges, lateSeen: report.late, ...counts })
  if (late > 0) result.recoveredWithinBound = false
  const { asked, good, bad, cycles, redeploys, unplugged } = report
  addAll(detail, { segments: 1, asked, good, bad, cycles, redeploys, unplugged, hours: report.virtualMs / 3600000 })
  addAll(total.outcomes, report.outcomes)
  addAll(total.faults, report.faults)
  addAll(total.events, report.events)
  recovery.phases += phases
  if (report.recovered > recovery.longest) Object.assign(recovery, { longest: report.recovered, bound: report.bound })
  if (late + counts.wrong + counts.unsettled + counts.doubledWrites === 0) return
  const { seed, wrong, misreported, doubled, overdue, relapses, rejected, open, timers } = report
  const what = {
    wrong,
    misreported,
    doubled,
    overdue,
    relapses,
    rejected,
    open,
    timers,
    asked,
    settled: report.settled
  }
  failures.push({ segment, seed, ...what })
}

/**
 * @param {object} options
 * @param {number} options.exchanges at least so many, in segments
 * @param {number} options.seed
 * @param {'nx'|'rtu'|'ascii'} options.protocol
 * @param {'safety'|'liveness'} [options.mode]
 * @param {number} [options.size] exchanges of one segment
 * @param {number} [options.segment] only this one of them, 0 the first
 * @param {(total: any) => void} [options.tell] after each segment
 * @param {(seed: number, options: any) => any} [options.draw] what one system is made of
 * @returns {Promise<Total>}
 */
async function soak(options) {
  const { exchanges, seed, protocol, mode = 'safety', segment, tell = () => {}, draw = drawRun } = options
  const seeds = createRandom(seed)
  const total = emptyTotal({ seed, protocol, mode })
  const size = Math.min(options.size ?? SEGMENT, exchanges)
  for (let n = 0; segment === undefined ? total.result.exchanges < exchanges : n <= segment; n++) {
    const own = seeds.integer(0, 2 ** 32 - 1)
    if (segment !== undefined && n !== segment) continue
    const run = draw(own, { protocol, mode, exchanges: size })
    try {
      add(total, await safetyRun(run), { segment: n, phases: run.phases })
    } catch (/** @type {any} */ error) {
      // nothing can happen any more, and somebody waits
      total.result.unsettled++
      total.failures.push({ segment: n, seed: own, error: `${error.code ?? ''} ${error.stack}` })
      if (total.failures.length > 20) break
    }
    tell(total)
  }
  return total
}

/** Whether all that is claimed was kept. @param {Total} total */
const isKept = ({ result: { wrong, unsettled, doubledWrites, recoveredWithinBound } }) =>
  wrong + unsettled + doubledWrites === 0 && recoveredWithinBound

/** @typedef {ReturnType<typeof emptyTotal>} Total */

module.exports = { MODES, PROTOCOLS, drawRun, isKept, soak }
