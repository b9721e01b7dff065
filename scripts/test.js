'use strict'

/**
 * Runs the tests: all of test/ but test/system, three files at a time; or what is named in the arguments.
 *   npm test                              everything
 *   npm test -- test/levels.test.js       these files or folders
 *   npm test -- -g "late answer"          all other arguments go to mocha
 * The last line is `N passed, N failed`; the exit code is not 0 if a test failed or none ran.
 */

const { spawn } = require('node:child_process')
const fs = require('node:fs')
const os = require('node:os')
const path = require('node:path')

const root = path.join(__dirname, '..')
// more than there may be cores: many wait for ports
const JOBS = 3
/** Long ones go first: the last one would leave a processor idle. */
const LONG = ['test/simulation/safety.test.js', 'test/consumer/types.test.js', 'test/demo.test.js'].map(path.normalize)

/** @returns {string[]} the test files, long ones first, then sorted; without those of test/system and of what is installed for long runs */
function testFiles() {
  const isOurs = file => !file.startsWith(path.join('test', 'system') + path.sep) && !file.includes('node_modules')
  const files = fs
    .readdirSync(path.join(root, 'test'), { recursive: true, encoding: 'utf8' })
    .map(name => path.join('test', name))
    .filter(file => file.endsWith('.test.js') && isOurs(file))
    .sort()
  return [...LONG.filter(file => files.includes(file)), ...files.filter(file => !LONG.includes(file))]
}

function mochaArguments(given) {
  const named = given.some(arg => /^(\.\/)?test\b/.test(arg) && fs.existsSync(path.join(root, arg)))
  const parallel = given.some(arg => /^--(no-)?parallel$/.test(arg)) || os.availableParallelism() < 2 || named
  return [
    path.join(root, 'node_modules', 'mocha', 'bin', 'mocha.js'),
    ...['--reporter', path.join(root, 'test', 'support', 'reporter.js')],
    ...(parallel ? [] : ['--parallel', '--jobs', String(JOBS)]),
    ...(process.env.CI ? ['--forbid-only'] : []),
    ...['--fail-zero', ...given],
    ...(named ? [] : testFiles())
  ]
}

function main() {
  const child = spawn(process.execPath, mochaArguments(process.argv.slice(2)), { cwd: root, stdio: 'inherit' })
  for (const signal of /** @type {const} */ (['SIGINT', 'SIGTERM'])) process.on(signal, () => child.kill(signal))
  child.once('error', error => {
    console.error(error.message)
    process.exitCode = 1
  })
  child.once('exit', code => {
    process.exitCode = code ?? 1
  })
}

main()
