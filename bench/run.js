'use strict'

/**
 * `npm run bench [-- --json] [NAME …]`: each row measures ours and a peer (or a limit) in the same run and prints their ratio. NAME: a file of
 * rows/. What each row is: docs/speed.md. A row whose goal does not hold makes the exit code 1.
 */
const { spawn } = require('node:child_process')
const { once } = require('node:events')
const { readdirSync } = require('node:fs')
const path = require('node:path')
const { parseArgs } = require('node:util')
const { judge, lineOf } = require('./judge')

const folder = path.join(__dirname, 'rows')

const known = () => readdirSync(folder).map(file => path.parse(file).name)

/** @param {string[]} wanted @returns {string[]} names of the rows' files; all where none is wanted */
const chosen = wanted => {
  const all = known()
  const unknown = wanted.find(name => !all.includes(name))
  if (unknown !== undefined) throw new Error(`there is no bench ${unknown}; there are: ${all.join(' ')}`)
  return wanted.length === 0 ? all : all.filter(name => wanted.includes(name))
}

/**
 * @param {string[]} names
 * @param {{ json: boolean, print: (line: string) => void, load?: (name: string) => { rows: () => AsyncIterable<any> } }} options load: the rows of a name
 * @returns {Promise<number>} rows whose goal does not hold
 */
const run = async (names, { json, print, load = name => require(path.join(folder, name)) }) => {
  let missed = 0
  for (const name of names) {
    for await (const measured of load(name).rows()) {
      const row = judge(measured)
      if (!row.holds) missed++
      print(json ? JSON.stringify(row) : lineOf(row))
    }
  }
  return missed
}

/** A part in a process of its own: what the others before it have left behind, in memory or in compiled code, is none of its business. */
const runApart = async (name, json) => {
  const child = spawn(process.execPath, [__filename, ...(json ? ['--json'] : []), name], { stdio: 'inherit' })
  const [code] = await once(child, 'exit')
  return code ?? 2
}

async function main() {
  const { values, positionals } = parseArgs({ options: { json: { type: 'boolean' } }, allowPositionals: true })
  const json = Boolean(values.json)
  const names = chosen(positionals)
  if (names.length === 1) {
    const missed = await run(names, { json, print: line => console.log(line) })
    process.exitCode = missed ? 1 : 0
    return
  }
  for (const name of names) process.exitCode = Math.max(Number(process.exitCode ?? 0), await runApart(name, json))
}

if (require.main === module) {
  main().catch(error => {
    console.error(error)
    process.exitCode = 2
  })
}

module.exports = { chosen, known, run }
