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

/** Test files of a folder, without those that go on for long: a change is tried against all that reach it. */
const testsOf = (folder, except = []) =>
  fs
    .readdirSync(path.join(ROOT, folder))
    .filter(name => name.endsWith('.test.js') && !except.includes(name))
    .map(name => `${folder}/${name}`)

const EVIDENCE = ['evidence.test.js', 'evidence-docs.test.js']
const LONG = ['leaks.test.js', 'stream-leaks.test.js', 'safety.test.js']

/** What is changed, and the tests that have to notice it. Others notice much of it, too, but these are to do it alone, and soon. */
const PARTS = Object.freeze({
  'lib/codec': { mutate: 'lib/codec/*.js', tests: () => testsOf('test/codec') },
  'lib/codec/nx': { mutate: 'lib/codec/nx/*.js', tests: () => testsOf('test/codec/nx') },
  'lib/codec/modbus': { mutate: 'lib/codec/modbus/*.js', tests: () => testsOf('test/codec/modbus') },
  'lib/codec/melsec': { mutate: 'lib/codec/melsec/*.js', tests: () => testsOf('test/codec/melsec') },
  'lib/codec/incon': { mutate: 'lib/codec/incon/*.js', tests: () => testsOf('test/codec/incon') },
  'lib/line': { mutate: 'lib/line/!(evidence*|archive).js', tests: () => testsOf('test/line', [...LONG, ...EVIDENCE]) },
  'lib/line/evidence': {
    mutate: 'lib/line/@(evidence*|archive).js',
    tests: () => EVIDENCE.map(name => `test/line/${name}`)
  },
  'lib/line/transports': { mutate: 'lib/line/transports/*.js', tests: () => testsOf('test/line/transports') }
})
const LEAST = 85 // percent

/** @param {{ name: string, mutate: string, spec: string[], jobs: number, again: boolean }} what */
const options = ({ name, mutate, spec, jobs, again }) => ({
  plugins: [path.join(PACKAGES, 'mocha-runner', 'dist', 'src', 'index.js')],
  testRunner: 'mocha',
  mochaOptions: { config: '.mocharc.json', spec },
  mutate: [mutate],
  // what was noticed by a test that is still there, in code that is still the same, counts as noticed
  incremental: again,
  incrementalFile: path.join(REPORTS, `${name}-before.json`),
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
    // some tests compare the docs with the code
    '!/docs',
    '!/package.json',
    '!/.mocharc.json',
    'test/system',
    'test/mutation'
  ],
  tempDirName: path.join(REPORTS, `${name}-sandbox`),
  cleanTempDir: 'always',
  allowEmpty: false,
  allowConsoleColors: false,
  checkers: [],
  reporters: ['progress-append-only', 'clear-text', 'json'],
  clearTextReporter: { allowColor: false, logTests: false, reportTests: false, reportScoreTable: true },
  jsonReporter: { fileName: path.join(REPORTS, `${name}.json`) }
})

const run = (command, args, given) =>
  new Promise((resolve, reject) => {
    const child = spawn(command, args, given)
    child.once('error', reject)
    child.once('exit', (code, signal) => resolve(signal ?? code))
  })

/**
 * The figures of a report of Stryker. What no test reaches counts as not noticed; what cannot be loaded does not count.
 * @param {{ files: Record<string, { mutants: { status: string }[] }> }} report
 * @returns {{ killed: number, survived: number }}
 */
function figures({ files }) {
  const all = Object.values(files).flatMap(({ mutants }) => mutants.map(({ status }) => status))
  const count = (...wanted) => all.filter(status => wanted.includes(status)).length
  return { killed: count('Killed', 'Timeout'), survived: count('Survived', 'NoCoverage') }
}

/** The parts that a folder or a pattern means, with the pattern for Stryker. */
function chosen(files) {
  const folders = Object.keys(PARTS)
  const asked = files.replace(/\/+$/, '')
  const whole = folders.filter(folder => folder === asked || folder.startsWith(`${asked}/`))
  if (whole.length > 0) return whole.map(folder => [folder, PARTS[folder].mutate])
  const folder = folders.sort((a, b) => b.length - a.length).find(each => asked.startsWith(`${each}/`))
  if (!folder) throw new Error(`known folders: ${folders.join(', ')}`)
  return [[folder, asked]]
}

async function runPart(folder, mutate, { jobs, again }) {
  const name = folder.replaceAll('/', '-')
  const file = path.join(ROOT, REPORTS, `${name}-options.json`)
  fs.mkdirSync(path.dirname(file), { recursive: true })
  fs.writeFileSync(file, JSON.stringify(options({ name, mutate, spec: PARTS[folder].tests(), jobs, again }), null, 2))
  // a copy: Stryker writes it anew while it writes the report
  const report = path.join(ROOT, REPORTS, `${name}.json`)
  if (again && fs.existsSync(report)) fs.copyFileSync(report, path.join(ROOT, REPORTS, `${name}-before.json`))
  const cli = path.join(PACKAGES, 'core', 'bin', 'stryker.js')
  const end = await run('nice', ['-n', '19', process.execPath, cli, 'run', file], { cwd: ROOT, stdio: 'inherit' })
  if (end !== 0) throw new Error(`the mutation tests of ${folder} ended with ${end}`)
  return figures(JSON.parse(fs.readFileSync(report, 'utf8')))
}

/**
 * @param {{ files?: string, jobs?: number, again?: boolean, tell?: (text: string) => void }} [given] files: a folder or a pattern of files
 *   below lib/; again: only what was not noticed the last time, and what has changed since
 * @returns {Promise<{ rows: { folder: string, killed: number, survived: number, score: number }[], failures: string[] }>}
 */
async function mutation({ files = 'lib/codec', jobs = 2, again = false, tell = () => {} } = {}) {
  const parts = chosen(files)
  await setUp(__dirname)
  const rows = []
  for (const [folder, mutate] of parts) {
    const { killed, survived } = await runPart(folder, mutate, { jobs, again })
    rows.push({ folder: mutate === PARTS[folder].mutate ? folder : mutate, killed, survived })
  }
  if (rows.length > 1) {
    const sum = name => rows.reduce((all, row) => all + row[name], 0)
    rows.push({ folder: files, killed: sum('killed'), survived: sum('survived') })
  }
  for (const row of rows) {
    row.score = (100 * row.killed) / (row.killed + row.survived)
    tell(`${row.folder}: ${row.score.toFixed(1)} % noticed, ${row.killed} of ${row.killed + row.survived}`)
  }
  const failures = rows.filter(({ score }) => !(score >= LEAST)).map(({ folder }) => `${folder}: less than ${LEAST} %`)
  return { rows, failures }
}

module.exports = { PARTS, chosen, figures, mutation }
