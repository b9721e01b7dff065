// A program in TypeScript, strict, that uses the package: test/consumer/types.test.js compiles it.
import {
  CODES,
  PRIORITY,
  PlcError,
  createNxPlc,
  createPool,
  listPorts,
  messagesOf,
  openNxPlc
} from '@nxline/node-red-serial-plc'
import { createNxLine, createVirtualClock, serveOnTcp } from '@nxline/node-red-serial-plc/sim'

export async function connection(): Promise<'confirmed' | 'unknown' | 'refused' | 'failed'> {
  const { wire, plcs } = createNxLine({ stations: [1, 2], baudRate: 38400 })
  const server = await serveOnTcp({ wire })
  const plc = openNxPlc({ host: '127.0.0.1', port: server.port, station: 1, access: 'write' })
  const outcome = await plc.write({ K0: 215, 'K127.12': true }, { verify: true })
  const results = await plc.read(['K0', 'M0..M3'], { priority: PRIORITY.POLL })
  for (const { name, value, quality, timestamp, code } of results) {
    const row: [string, unknown, 'good' | 'uncertain' | 'bad', number, string | undefined] = [
      name,
      value,
      quality,
      timestamp,
      code
    ]
    messagesOf(results, { format: 'envelope', device: row[0] })
  }
  const polling = plc.subscribe({ items: ['M0'], interval: 100 }, (values, { ms, failure }) => {
    const late: boolean = ms > 100 || values[0].quality === 'bad' || failure !== null
    if (late) polling.stop()
  })
  plcs[0].set('K0', 1500)
  await plc.close()
  await server.close()
  return outcome.outcome
}

export async function shared(): Promise<string> {
  const pool = createPool()
  const lease = pool.open({ transport: 'serial', path: (await listPorts())[0].path }, { id: 'a', name: 'a' })
  const plc = createNxPlc({ lease, station: 1, clock: createVirtualClock() })
  try {
    const { goesOut } = plc.describe('M0')
    return goesOut
  } catch (error) {
    if (error instanceof PlcError) return `${error.code} ${error.remedy} ${CODES.TIMEOUT[0]}`
    throw error
  } finally {
    plc.close()
    await lease.release()
  }
}

// @ts-expect-error a station is needed
openNxPlc({ path: '/dev/ttyUSB0' })
// @ts-expect-error there is no such format
messagesOf([], { format: 'csv' })
