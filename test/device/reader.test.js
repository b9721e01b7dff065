'use strict'

const assert = require('node:assert/strict')
const { PlcError } = require('../../lib/error')
const { Reader } = require('../../lib/device/reader')
const { readSettings } = require('../../lib/device/settings')
const { createVirtualClock } = require('../../lib/sim')

const point = (address, count = 1) => ({
  kind: /** @type {const} */ ('word'),
  address,
  count,
  text: `${address}`
})

describe('what a reader learns', () => {
  const open = () => {
    const clock = createVirtualClock()
    const asked = []
    const missing = new Set()
    const talk = {
      repeating: false,
      async read({ base, count }) {
        asked.push([base, count])
        if (missing.has(base)) throw new PlcError('PLC_OUT_OF_RANGE', { station: 1 })
        return Array(count).fill(base)
      }
    }
    const settings = { station: 1, plan: readSettings({ station: 1 }, 0.26).plan }
    const reader = new Reader({ talk, settings, clock, turnaround: { ms: 5 } })
    return { clock, asked, missing, reader }
  }

  it('an address that the station has after all is planned with the others again', async () => {
    const { asked, missing, reader } = open()
    const points = [point(0xc0), point(0xc1)]
    missing.add(0xc1).add(0xc0)
    await reader.read(points, { priority: 2, fresh: false })
    missing.clear()
    asked.length = 0
    const apart = await reader.read(points, { priority: 1, fresh: true })
    assert.ok(asked.length > 1, 'asked for apart')
    assert.ok(apart.every(({ raw }) => raw))
    asked.length = 0
    await reader.read(points, { priority: 2, fresh: false })
    assert.deepEqual(asked, [[0xc0, 2]])
  })

  it('of what does not fit into a request no cost is known', () => {
    const { reader } = open()
    assert.deepEqual(reader.requestsOf([point(0xc0, 1000)]), [])
    assert.equal(reader.requestsOf([point(0xc0, 2)]).length, 1)
  })
})
