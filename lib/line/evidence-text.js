'use strict'

const { timeText } = require('./clock')

/** A line of the file is never longer, characters: somebody may write a thousand values. */
const MOST = 4096

const short = value => (typeof value === 'string' ? value.slice(0, 200) : value)

const frameText = ({ t, dir, station, bytes, note }) => ({
  is: 'frame',
  t: timeText(t),
  dir,
  station,
  bytes: bytes.toString('hex'),
  note: short(note)
})

const eventText = event => ({ is: 'event', t: timeText(event.since), ...event, since: undefined })

/** What names an event, for one that cannot be written whole. */
const cutText = ({ event, station, since, code, cause, remedy, outcome, device }) => ({
  is: 'event',
  t: timeText(since),
  event,
  ...Object.fromEntries(
    Object.entries({ station, code, cause, remedy, outcome, device }).map(([name, value]) => [name, short(value)])
  ),
  cut: true
})

const textOf = {
  frame: ({ row }) => frameText(row),
  event: ({ event }) => eventText(event),
  fault: ({ is, t, station, code }) => ({ is, t: timeText(t), station, code: short(code) }),
  skipped: ({ is, t, rows }) => ({ is, t: timeText(t), rows })
}

/** Values that a flow gave may be anything, also what JSON cannot say. */
const attempt = work => {
  try {
    return JSON.stringify(work())
  } catch {
    return ''
  }
}

/**
 * An entry as a line of the file.
 * @param {any} entry of evidence.js, or `{ is: 'skipped', t, rows }`
 * @returns {string} with its end; '' if it cannot be said at all
 */
const lineOf = entry => {
  const whole = attempt(() => textOf[entry.is](entry))
  const text =
    entry.is === 'event' && (whole === '' || whole.length > MOST) ? attempt(() => cutText(entry.event)) : whole
  return text === '' || text.length > MOST ? '' : `${text}\n`
}

/** The rows of a file. A line that was torn, when the power failed or the disk was full, is left out. @param {string} text */
const rowsOf = text =>
  text.split('\n').flatMap(line => {
    try {
      return line === '' ? [] : [JSON.parse(line)]
    } catch {
      return []
    }
  })

module.exports = { lineOf, rowsOf }
