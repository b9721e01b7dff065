'use strict'

/**
 * Which branches of lib/ the unit tests take. c8 measures what V8 saw; here is counted and judged.
 * A folder has its limit. A branch that no test takes is shown, with the reason that `coverage-gaps.js` gives.
 */

const { spawn } = require('node:child_process')
const fs = require('node:fs')
const os = require('node:os')
const path = require('node:path')
const { GAPS } = require('./coverage-gaps.js')

const ROOT = path.join(__dirname, '..', '..')

/** Tests that run together, and what they have to take of each folder, in percent of its branches. */
const RUNS = Object.freeze([
  { tests: ['test/codec'], least: { 'lib/codec': 100 } },
  {
    tests: ['test/line', 'test/device', 'test/simulation', 'test/sim'],
    least: { 'lib/line': 95, 'lib/device': 95 }
  }
])

/** What stands between two places of a text, both `{ line, column }` as c8 has them. */
function between(lines, { start, end }) {
  const picked = lines.slice(start.line - 1, end.line)
  const from = Math.max(0, start.column)
  if (picked.length < 2) return (picked[0] ?? '').slice(from, Math.max(0, end.column))
  return [
    picked[0].slice(from),
    ...picked.slice(1, -1),
    picked[picked.length - 1].slice(0, Math.max(0, end.column))
  ].join('\n')
}

/**
 * The branches of one file. V8 also counts the place behind a `try` or a loop that is never left at its end: nothing stands there, and it is none.
 * @returns {{ branches: number, gaps: { line: number, code: string, text: string }[] }} text: all of the line
 */
function branchesOf(report, source) {
  const lines = source.split('\n')
  const gaps = []
  let branches = 0
  for (const [id, counts] of Object.entries(report.b)) {
    counts.forEach((count, i) => {
      const place = report.branchMap[id].locations[i]
      const code = between(lines, place).trim()
      if (/^[\s{}();]*$/.test(code)) return
      branches++
      if (count === 0)
        gaps.push({ line: place.start.line, code: code.split('\n')[0].trim(), text: lines[place.start.line - 1] })
    })
  }
  return { branches, gaps }
}

const run = (args, env) =>
  new Promise((resolve, reject) => {
    const child = spawn(process.execPath, args, { cwd: ROOT, env, stdio: ['ignore', 'pipe', 'pipe'] })
    let said = ''
    for (const stream of [child.stdout, child.stderr]) stream.setEncoding('utf8').on('data', text => (said += text))
    child.once('error', reject)
    child.once('close', code => resolve({ code, said }))
  })

const bin = (name, file) => path.join(ROOT, 'node_modules', name, file)

/** Runs tests under c8. @returns {Promise<Record<string, any>>} its reports by file, relative to the repository */
async function measure({ tests, least }) {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'coverage-'))
  const wanted = Object.keys(least).flatMap(each => ['--include', `${each}/**`])
  const c8 = [bin('c8', 'bin/c8.js'), '--all', '--reporter', 'json', '--temp-directory', path.join(folder, 'raw')]
  const mocha = [
    bin('mocha', 'bin/mocha.js'),
    '--exit',
    // real ports on a busy machine
    '--retries',
    '2',
    '--reporter',
    'dot',
    ...tests.map(each => `${each}/**/*.test.js`)
  ]
  try {
    const { code, said } = await run(
      [...c8, '--reports-dir', folder, ...wanted, process.execPath, ...mocha],
      process.env
    )
    if (code !== 0) throw new Error(`${tests.join(', ')}: a test failed\n${said}`)
    const reports = JSON.parse(fs.readFileSync(path.join(folder, 'coverage-final.json'), 'utf8'))
    return Object.fromEntries(Object.entries(reports).map(([file, report]) => [path.relative(ROOT, file), report]))
  } finally {
    fs.rmSync(folder, { recursive: true, force: true })
  }
}

const reasonOf = (file, text) => GAPS.find(([where, line]) => where === file && text.includes(line))?.[2]

/**
 * @param {{ only?: string, tell?: (text: string) => void }} [given] only: a folder of RUNS
 * @returns {Promise<{ folders: Record<string, number>, failures: string[] }>} percent of the branches, and what is not as it has to be
 */
async function coverage({ only, tell = () => {} } = {}) {
  const runs = RUNS.filter(({ least }) => !only || Object.keys(least).includes(only))
  if (runs.length === 0) throw new Error(`known folders: ${RUNS.flatMap(({ least }) => Object.keys(least)).join(', ')}`)
  const folders = {}
  const failures = []
  for (const each of runs) {
    const reports = await measure(each)
    for (const [folder, least] of Object.entries(each.least)) {
      let [all, open, unexplained] = [0, 0, 0]
      for (const [file, report] of Object.entries(reports).sort()) {
        if (!file.startsWith(`${folder}/`)) continue
        const { branches, gaps } = branchesOf(report, fs.readFileSync(path.join(ROOT, file), 'utf8'))
        all += branches
        open += gaps.length
        for (const { line, code, text } of gaps) {
          const why = reasonOf(file, text)
          tell(`  ${file}:${line}: ${code}: ${why ?? 'no test yet'}`)
          if (!why) unexplained++
        }
      }
      folders[folder] = (100 * (all - open)) / all
      tell(
        `${folder}: ${folders[folder].toFixed(2)} % of ${all} branches; ${open} are left, ${unexplained} of them without a reason`
      )
      if (folders[folder] < least) failures.push(`${folder}: less than ${least} %`)
    }
  }
  return { folders, failures }
}

module.exports = { RUNS, branchesOf, coverage }
