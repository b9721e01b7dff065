'use strict'
const { PlcError } = require('../error')
const { PRIORITY } = require('../line')
const { asPlcError } = require('./failure')
const { readBackOf, readBackValues } = require('./points')

/**
 * Reads back what was confirmed or is unknown, and corrects its fate.
 * @param {{ reader: any, station: number, points: any[], fates: any[] }} written one fate per point: `{ outcome, error? }`
 * @returns {Promise<void>} never rejects
 */
const verifyWritten = async ({ reader, station, points, fates }) => {
  const last = lastWritten(points, fates)
  if (last.length === 0) return
  const readings = await readBack(
    { reader, station },
    last.map(index => readBackOf(points[index]))
  )
  last.forEach((index, at) => {
    fates[index] = judge(fates[index], { ...points[index], station }, readings[at])
  })
}

/** @returns {Promise<any[]>} one reading per point, also where they cannot be asked for: a write that went out has an outcome */
const readBack = async ({ reader, station }, points) => {
  try {
    return await reader.read(points, { priority: PRIORITY.ASK, fresh: true })
  } catch (caught) {
    const error = asPlcError(caught, station)
    return points.map(() => ({ error }))
  }
}

/** Of the points that went out, those that no later one overwrites. A word overlaps its sixteen bits. */
const lastWritten = (points, fates) => {
  const words = new Set()
  const bits = new Set()
  const touched = new Set() // words of which bits were written
  const last = []
  for (let index = points.length - 1; index >= 0; index--) {
    const { outcome } = fates[index]
    if (outcome !== 'confirmed' && outcome !== 'unknown') continue
    const { kind, address, count } = points[index]
    const places = Array.from({ length: count }, (_, at) => address + at)
    const free = place =>
      kind === 'word' ? !words.has(place) && !touched.has(place) : !words.has(place >> 4) && !bits.has(place)
    if (places.every(free)) last.unshift(index)
    for (const place of places) {
      if (kind === 'word') words.add(place)
      else {
        bits.add(place)
        touched.add(place >> 4)
      }
    }
  }
  return last
}

const shown = raw =>
  raw.map(value => (typeof value === 'boolean' ? value : `${value.toString(16).toUpperCase()}h`)).join(' ')

const judge = (fate, point, reading) => {
  const { values, text, station } = point
  if ('error' in reading) {
    const reason = `it could not be read back: ${reading.error.code}`
    const details = { station, item: text, reason, cause: reading.error }
    return { outcome: 'unknown', error: new PlcError('WRITE_UNKNOWN', details) }
  }
  const raw = readBackValues(point, reading.raw)
  if (values.every((value, index) => value === raw[index])) return { outcome: 'confirmed' }
  const error = new PlcError('VERIFY_FAILED', {
    item: text,
    got: shown(raw),
    expected: shown(values),
    cause: fate.error
  })
  // without an acknowledgement nobody knows whether the PLC's program took it and set it back: a command bit may have been carried out
  return { outcome: fate.outcome === 'unknown' ? 'unknown' : 'failed', error }
}

module.exports = { verifyWritten }
