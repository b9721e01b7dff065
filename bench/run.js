'use strict'

/**
 * `npm run bench [-- --json] [NAME]`: each row measures ours and a peer (or the wire's own limit) in the same run and prints their ratio.
 * A row whose goal does not hold makes the exit code 1.
 */
const { readdirSync } = require('node:fs')
const path = require('node:path')
const { parseArgs } = require('node:util')

const folder = path.join(__dirname, 'rows')

/** @typedef {{ name: string, value: number, unit: string, against: string, ratio: number, goal: string, holds: boolean }} Row */

const limits = {
  '<=': (ratio, bound) => ratio <= bound,
  '>=': (ratio, bound) => ratio >= bound
}

/**
 * @param {{ name: string, value: number, unit: string, against: string, ratio: number, goal: ['<=' | '>=', number] }} measured
 * @returns {Row}
 */
function judge({ goal: [sign, bound], ...measured }) {
  return { ...measured, goal: `${sign} ${bound}`, holds: limits[sign](measured.ratio, bound) }
}

function print(row, json) {
  if (json) return console.log(JSON.stringify(row))
  const { name, value, unit, against, ratio, goal, holds } = row
  console.log(
    `${holds ? 'ok  ' : 'MISS'} ${name}: ${value.toPrecision(4)} ${unit}, ${ratio.toFixed(3)} x ${against} (goal ${goal})`
  )
}

async function main() {
  const { values, positionals } = parseArgs({ options: { json: { type: 'boolean' } }, allowPositionals: true })
  const files = readdirSync(folder).filter(
    file => positionals.length === 0 || positionals.includes(path.parse(file).name)
  )
  if (files.length === 0) throw new Error(`no such bench; there are: ${readdirSync(folder).join(' ')}`)
  let missed = 0
  for (const file of files) {
    for await (const measured of require(path.join(folder, file)).rows()) {
      const row = judge(measured)
      if (!row.holds) missed++
      print(row, values.json)
    }
  }
  process.exitCode = missed ? 1 : 0
}

main().catch(error => {
  console.error(error)
  process.exitCode = 2
})
