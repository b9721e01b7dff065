'use strict'

/**
 * A program of its own that polls and writes two stations, for tests that stop, kill and restart it: everything that it sees goes to its parent.
 * Arguments as JSON: `{ line, stations: [{ device, station, block, target }], user? }`; user: it gives up its rights and becomes this user before it
 * opens the port.
 */

const { createPool, openChinoRegulator, openNxPlc } = require('../../lib')
// loaded before the rights are given up: they may not reach the files of the package
require('serialport')

const OPEN = { nx: openNxPlc, chino: openChinoRegulator }
const { line, stations, user, timeout = 500 } = JSON.parse(process.argv[2])

/** ms of the machine's monotonic clock, the same for all programs. */
const now = () => Number(process.hrtime.bigint()) / 1e6
const tell = message => process.send?.(message)

function become(id) {
  process.setgroups?.([])
  process.setgid?.(id)
  process.setuid?.(id)
}

if (user) become(user)
const pool = createPool()
const devices = stations.map(({ device, station }) =>
  OPEN[device]({ pool, ...line, station, timeout, access: 'write' })
)
devices[0].line.on('state', (state, reason) =>
  tell({ what: 'state', state, code: reason?.code, text: reason?.message, remedy: reason?.remedy })
)

devices.forEach((device, n) => {
  const { block, target } = stations[n]
  device.subscribe({ items: [block], interval: 40 }, ([{ value, quality, code }], { ms }) => {
    if (quality === 'good') tell({ what: 'value', n, value, from: now() - ms - 1, to: now() })
    else tell({ what: 'bad', n, code })
  })
  if (target) write(device, target, n)
})

/** One write after the other: a number that grows. */
async function write(device, target, n) {
  for (let value = 1; ; value = (value % 30000) + 1) {
    const { outcome, code } = await device.write({ [target]: value })
    tell({ what: 'write', n, value, outcome, code })
    await new Promise(resolve => setTimeout(resolve, 60))
  }
}

process.on('disconnect', () => process.exit(0))
