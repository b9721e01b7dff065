'use strict'

/**
 * Mutation tests: the code is changed at one place after the other, and a test has to notice each change.
 * Stryker and its runner are installed here, on demand (package.json, package-lock.json of this folder).
 */

const { spawn } = require('node:child_process')
const fs = require('node:fs')
const path = require('node:path')
const { setUp } = require('../../scripts/setup.js')

const ROOT = path.join(__dirname, '..', '..')
const PACKAGES = path.join(__dirname, 'node_modules', '@stryker-mutator')
const REPORTS = path.join('.cache', 'mutation')

/** What is changed, and the tests that have to notice it. Others notice much of it, too, but these are to do it alone, and soon. */
const PARTS = Object.freeze({
  codec: { mutate: 'lib/codec/*.js', spec: ['test/codec/*.test.js'] },
  nx: { mutate: 'lib/codec/nx/**/*.js', spec: ['test/codec/nx/**/*.test.js'] },
  modbus: { mutate: 'lib/codec/modbus/**/*.js', spec: ['test/codec/modbus/**/*.test.js'] },
  melsec: { mutate: 'lib/codec/melsec/**/*.js', spec: ['test/codec/melsec/**/*.test.js'] },
  incon: { mutate: 'lib/codec/incon/**/*.js', spec: ['test/codec/incon/**/*.test.js'] },
  line: { mutate: 'lib/line/**/*.js', spec: ['test/line/**/*.test.js'] }
})

/** @param {{ part: string, mutate: string[], spec: string[], jobs: number }} what */
const options = ({ part, mutate, spec, jobs }) => ({
  plugins: [path.join(PACKAGES, 'mocha-runner', 'dist', 'src', 'index.js')],
  testRunner: 'mocha',
  mochaOptions: { config: '.mocharc.json', spec },
  mutate,
  coverageAnalysis: 'perTest',
  concurrency: jobs,
  // a mutant that turns a loop into an endless one is ended after 1.5 times the usual time and this
  timeoutMS: 5000,
  ignorePatterns: [
    '/*',
    '!/lib',
    '!/test',
    '!/scripts',
    '!/nodes',
    '!/package.json',
    '!/.mocharc.json',
    'test/system',
    'test/mutation'
  ],
  tempDirName: path.join(REPORTS, `sandbox-${part}`),
  cleanTempDir: 'always',
  allowEmpty: false,
  allowConsoleColors: false,
  checkers: [],
  reporters: ['clear-text', 'json'],
  clearTextReporter: { allowColor: false, logTests: false, reportTests: false, reportScoreTable: true },
  jsonReporter: { fileName: path.join(REPORTS, `${part}.json`) }
})

const run = (command, args, given) =>
  new Promise((resolve, reject) => {
    const child = spawn(command, args, given)
    child.once('error', reject)
    child.once('exit', (code, signal) => resolve(signal ?? code))
  })

/**
 * The figures of a report of Stryker. What no test reaches counts as not noticed; what cannot be compiled does not count.
 * @param {{ files: Record<string, { mutants: { status: string }[] }> }} report
 * @returns {Record<string, { killed: number, survived: number, score: number }>} by file, and `all`
 */
function figures({ files }) {
  const rows = {}
  const count = (row, status) => {
    if (status === 'Killed' || status === 'Timeout') row.killed++
    else if (status === 'Survived' || status === 'NoCoverage') row.survived++
  }
  const all = { killed: 0, survived: 0, score: 0 }
  for (const [file, { mutants }] of Object.entries(files)) {
    const row = { killed: 0, survived: 0, score: 0 }
    for (const { status } of mutants) {
      count(row, status)
      count(all, status)
    }
    rows[file] = row
  }
  rows.all = all
  for (const row of Object.values(rows)) row.score = (100 * row.killed) / Math.max(1, row.killed + row.survived)
  return rows
}

/**
 * @param {{ part: string, files?: string[], jobs?: number, tell?: (text: string) => void }} given part: a name of PARTS; files: only these of it
 * @returns {Promise<ReturnType<typeof figures>>}
 */
async function mutation({ part, files, jobs = 2, tell = () => {} }) {
  await setUp(__dirname)
  const { mutate, spec } = PARTS[part]
  const config = path.join(ROOT, REPORTS, `stryker-${part}.json`)
  fs.mkdirSync(path.dirname(config), { recursive: true })
  fs.writeFileSync(config, JSON.stringify(options({ part, mutate: files ?? [mutate], spec, jobs }), null, 2))
  const cli = path.join(PACKAGES, 'core', 'bin', 'stryker.js')
  tell(`${part}: ${files ? files.join(', ') : mutate}`)
  const end = await run('nice', ['-n', '19', process.execPath, cli, 'run', config], { cwd: ROOT, stdio: 'inherit' })
  if (end !== 0) throw new Error(`the mutation tests of ${part} ended with ${end}`)
  return figures(JSON.parse(fs.readFileSync(path.join(ROOT, REPORTS, `${part}.json`), 'utf8')))
}

module.exports = { PARTS, figures, mutation }
