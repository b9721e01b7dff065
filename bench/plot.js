'use strict'

/**
 * Curves over two logarithmic axes, as SVG. Pure.
 *
 * @typedef {{ name: string, color: string, points: [number, number][] }} Curve points: above 0, in order of x
 */

const WIDTH = 760
const HEIGHT = 440
const LEFT = 80
const RIGHT = 190
const TOP = 56
const BOTTOM = 60
const LABEL = 17 // least distance of two names at the right

const escaped = text => text.replace(/&/g, '&amp;').replace(/</g, '&lt;')
const shown = number => String(Math.round(number * 10) / 10)

/** Powers of ten around the values. */
const decades = values => {
  const low = Math.floor(Math.log10(Math.min(...values)) + 1e-9)
  const high = Math.max(low + 1, Math.ceil(Math.log10(Math.max(...values)) - 1e-9))
  return { low, high, ticks: Array.from({ length: high - low + 1 }, (_, n) => 10 ** (low + n)) }
}

const scaleOf =
  ({ low, high }, from, to) =>
  value =>
    from + ((Math.log10(value) - low) / (high - low)) * (to - from)

const text = (x, y, what, more = '') => `<text x="${shown(x)}" y="${shown(y)}"${more}>${escaped(what)}</text>`
const line = (x1, y1, x2, y2) => `<path class="grid" d="M${shown(x1)} ${shown(y1)}L${shown(x2)} ${shown(y2)}"/>`

/** Names at the right end of their curves, moved apart where they would touch. */
const labels = (curves, yOf) => {
  const rows = curves.map(({ name, color, points }) => ({ name, color, y: yOf(points[points.length - 1][1]) }))
  rows.sort((a, b) => a.y - b.y)
  rows.forEach((row, at) => at > 0 && (row.y = Math.max(row.y, rows[at - 1].y + LABEL)))
  return rows.map(({ name, color, y }) => text(WIDTH - RIGHT + 12, y + 4, name, ` fill="${color}" font-weight="600"`))
}

const curveOf = ({ color, points }, xOf, yOf) => {
  const places = points.map(([x, y]) => `${shown(xOf(x))} ${shown(yOf(y))}`)
  const dots = points.map(([x, y]) => `<circle cx="${shown(xOf(x))}" cy="${shown(yOf(y))}" r="3" fill="${color}"/>`)
  return [`<path class="curve" stroke="${color}" d="M${places.join('L')}"/>`, ...dots]
}

const STYLE = [
  'text{font:13px sans-serif}',
  '.grid{stroke:#ddd;fill:none}',
  '.curve{fill:none;stroke-width:2}',
  '.title{font-size:15px;font-weight:600}'
].join('')

/**
 * @param {{ title: string, x: string, y: string, curves: Curve[] }} plot x, y: what the axes are
 * @returns {string}
 */
const drawn = ({ title, x, y, curves }) => {
  const all = curves.flatMap(({ points }) => points)
  const across = decades(all.map(([value]) => value))
  const up = decades(all.map(([, value]) => value))
  const xOf = scaleOf(across, LEFT, WIDTH - RIGHT)
  const yOf = scaleOf(up, HEIGHT - BOTTOM, TOP)
  const middle = (LEFT + WIDTH - RIGHT) / 2
  const upright = `transform="rotate(-90 22 ${(TOP + HEIGHT - BOTTOM) / 2})"`
  const parts = [
    `<rect width="${WIDTH}" height="${HEIGHT}" fill="#fff"/>`,
    text(LEFT, 30, title, ' class="title"'),
    ...across.ticks.map(tick => line(xOf(tick), TOP, xOf(tick), HEIGHT - BOTTOM)),
    ...up.ticks.map(tick => line(LEFT, yOf(tick), WIDTH - RIGHT, yOf(tick))),
    ...across.ticks.map(tick => text(xOf(tick), HEIGHT - BOTTOM + 20, String(tick), ' text-anchor="middle"')),
    ...up.ticks.map(tick => text(LEFT - 8, yOf(tick) + 4, String(tick), ' text-anchor="end"')),
    text(middle, HEIGHT - 14, x, ' text-anchor="middle"'),
    text(22, (TOP + HEIGHT - BOTTOM) / 2, y, ` text-anchor="middle" ${upright}`),
    ...curves.flatMap(curve => curveOf(curve, xOf, yOf)),
    ...labels(curves, yOf)
  ]
  const head = `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${WIDTH} ${HEIGHT}" role="img">`
  return [head, `<title>${escaped(title)}</title>`, `<style>${STYLE}</style>`, ...parts, '</svg>', ''].join('\n')
}

module.exports = { drawn }
