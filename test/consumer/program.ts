// A program in TypeScript, strict, that uses the package: test/consumer/types.test.js compiles it.
import {
  CODES,
  PRIORITY,
  PlcError,
  createChinoRegulator,
  createNxPlc,
  createPool,
  diagnose,
  listPorts,
  messagesOf,
  mixedConflict,
  openC24Port,
  openChinoRegulator,
  openInconLink,
  openNxPlc,
  toBufferMemory
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

export async function regulator(): Promise<string> {
  const heater = openChinoRegulator({
    path: '/dev/ttyUSB0',
    station: 11,
    protocol: 'rtu',
    holdingFunction: 'auto',
    access: 'write'
  })
  const { outcome } = await heater.write({ 400001: 500, '000001': true }, { verify: true })
  const [output] = await heater.read('300001')
  const { goesOut } = heater.regulator.describe('400001', { write: true })
  await heater.close()
  return outcome === 'confirmed' && output.quality === 'good' ? `${output.value} ${goesOut}` : (output.code ?? '')
}

export async function mixed(): Promise<string> {
  const lease = createPool().open({ transport: 'serial', path: '/dev/ttyUSB0' }, { id: 'a', name: 'a' })
  const members = [
    createNxPlc({ lease, station: 1 }),
    createChinoRegulator({ lease, station: '2', addressMode: '0-base', coilFunction: '05', broadcast: false })
  ]
  const reason: string = mixedConflict(members[0].member, members[1].member)
  for (const device of members) device.close()
  await lease.release()
  return reason
}

export async function why(): Promise<string> {
  const { ok, cause, seen, rows } = await diagnose({
    path: '/dev/ttyUSB0',
    protocol: 'rtu',
    station: 11,
    parity: 'even'
  })
  const wrong: string[] = rows.filter(({ result }) => result === 'ng').map(({ item, text }) => `${item}: ${text}`)
  return ok || !cause ? String(seen.value) : [cause.code, cause.text, cause.remedy, ...wrong].join('. ')
}

export async function listening(): Promise<string> {
  const c24 = openC24Port({ path: '/dev/ttyUSB0', format: 'words', bidirectional: true })
  const stop: () => void = c24.listen(({ value, text, bytes, count, complete, reason, timestamp }) => {
    const when: number = complete ? timestamp : count
    console.log(value, text, bytes.length, when, reason?.length)
  })
  const { outcome, code, attempts, ms } = await c24.send([100, 250])
  stop()
  await c24.close()
  const link = openInconLink({ host: 'server', port: 4001, checked: true })
  link.listen(({ value, number, lost = 0, reason }) => {
    const line: string | null = value
    if (reason === 'check') console.log(line?.length, number, lost)
  })
  const sent: 'sent' | 'confirmed' | 'unknown' | 'refused' | 'failed' = (await link.send('O1234')).outcome
  await link.close()
  const image: number[] = toBufferMemory(Buffer.from('ABCDEFG123'), { unit: 'byte' })
  return outcome === 'confirmed' ? sent : `${code} ${attempts} ${ms} ${image[0]}`
}

// @ts-expect-error there is no such unit
toBufferMemory(Buffer.alloc(2), { unit: 'dword' })
// @ts-expect-error there is no such protocol
diagnose({ path: '/dev/ttyUSB0', station: 11, protocol: 'modbus' })
// @ts-expect-error there is no such protocol
createChinoRegulator({ lease: null, station: 1, protocol: 'tcp' })
// @ts-expect-error a station is needed
openChinoRegulator({ path: '/dev/ttyUSB0' })
// @ts-expect-error a station is needed
openNxPlc({ path: '/dev/ttyUSB0' })
// @ts-expect-error there is no such format
messagesOf([], { format: 'csv' })
