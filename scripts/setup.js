'use strict'

/**
 * Brings node_modules to what package-lock.json says: once per lockfile and Node major, then it only compares a stamp.
 * Every npm script runs it first (not as `prestart`: `ignore-scripts` skips those), so `npm start` works on a bare clone.
 * Only `node:` modules here: nothing else exists yet.
 */

const { createHash, randomUUID } = require('node:crypto')
const { spawn } = require('node:child_process')
const fs = require('node:fs')
const os = require('node:os')
const path = require('node:path')

const LEAST_NODE = 20
const LOCK_PATIENCE = 10 * 60 * 1000

const say = text => process.stderr.write(`set-up: ${text}\n`)

const readJson = file => {
  try {
    return JSON.parse(fs.readFileSync(file, 'utf8'))
  } catch {
    return null
  }
}

/** What an installation depends on: the lockfile, Node's major (native modules) and the platform. */
function fingerprint(root) {
  const lock = fs.readFileSync(path.join(root, 'package-lock.json'))
  const digest = createHash('sha256').update(lock).digest('hex').slice(0, 24)
  return `${digest} node-${process.versions.node.split('.')[0]} ${process.platform}-${process.arch}`
}

const stampFile = root => path.join(root, 'node_modules', '.set-up')

function stampIsGood(root) {
  try {
    return fs.readFileSync(stampFile(root), 'utf8') === fingerprint(root)
  } catch {
    return false
  }
}

const writeStamp = root => fs.writeFileSync(stampFile(root), fingerprint(root))

/**
 * Did somebody already install exactly this by hand? npm keeps what it installed in node_modules/.package-lock.json.
 * Another Node major shows in the stamp only, so a stamp that exists and differs means: install anew.
 */
function installedByHand(root) {
  if (fs.existsSync(stampFile(root))) return false
  const wanted = readJson(path.join(root, 'package-lock.json'))?.packages
  const present = readJson(path.join(root, 'node_modules', '.package-lock.json'))?.packages
  if (!wanted || !present) return false
  return Object.entries(wanted).every(([where, { version, optional }]) => {
    if (where === '' || !version) return true
    return present[where] ? present[where].version === version : optional === true
  })
}

const codeOf = error => /** @type {NodeJS.ErrnoException} */ (error).code

const alive = pid => {
  try {
    process.kill(pid, 0)
    return true
  } catch (error) {
    return codeOf(error) === 'EPERM'
  }
}

const sleep = ms => new Promise(resolve => setTimeout(resolve, ms))

/** Takes the lock, or returns null while another living process has it. A dead owner's lock is taken over. */
function tryLock(file) {
  const own = `${process.pid} ${randomUUID()}`
  try {
    fs.writeFileSync(file, own, { flag: 'wx' })
    return () => fs.rmSync(file, { force: true })
  } catch (error) {
    if (codeOf(error) !== 'EEXIST') throw error
  }
  let owner
  try {
    owner = fs.readFileSync(file, 'utf8')
  } catch {
    return null // released between the two calls: the next round gets it
  }
  const pid = Number.parseInt(owner, 10)
  const age = Date.now() - (fs.statSync(file, { throwIfNoEntry: false })?.mtimeMs ?? Date.now())
  if (Number.isInteger(pid) ? !alive(pid) : age > 5000) {
    // rename, not unlink: of several that see the dead lock only one gets it out of the way
    const grave = `${file}.${randomUUID()}`
    try {
      fs.renameSync(file, grave)
      // somebody may have replaced the dead lock between the look and the rename: give it back
      if (fs.readFileSync(grave, 'utf8') !== owner) fs.linkSync(grave, file)
      fs.rmSync(grave, { force: true })
    } catch {
      // another one was quicker
    }
  }
  return null
}

async function withLock(root, work) {
  const folder = path.join(root, '.cache')
  fs.mkdirSync(folder, { recursive: true })
  const file = path.join(folder, 'set-up.lock')
  const until = Date.now() + LOCK_PATIENCE
  let release = tryLock(file)
  if (!release && fs.existsSync(file)) say('another set-up is running in this folder, waiting for it')
  while (!release) {
    if (Date.now() > until)
      throw new Error(`another set-up did not end within 10 minutes; if none runs, delete ${file}`)
    await sleep(100)
    release = tryLock(file)
  }
  try {
    return await work()
  } finally {
    release()
  }
}

const writable = folder => {
  try {
    fs.mkdirSync(folder, { recursive: true })
    const probe = path.join(folder, `.probe-${randomUUID()}`)
    fs.writeFileSync(probe, '')
    fs.rmSync(probe)
    return true
  } catch {
    return false
  }
}

/** npm's environment; with a home that cannot be written (containers, service users) its cache goes to the temp folder. */
function npmEnvironment() {
  /** @type {NodeJS.ProcessEnv} */
  const env = { ...process.env, npm_config_update_notifier: 'false', NODE_ENV: 'development' }
  const cache = env.npm_config_cache || path.join(os.homedir() || os.tmpdir(), '.npm')
  if (writable(cache)) return { env, done() {} }
  const own = fs.mkdtempSync(path.join(os.tmpdir(), 'npm-cache-'))
  env.npm_config_cache = own
  return { env, done: () => fs.rmSync(own, { recursive: true, force: true }) }
}

/** @returns {[string, string[], boolean]} command, first arguments, and whether a shell is needed (npm.cmd) */
function npmCommand() {
  const cli = process.env.npm_execpath
  if (cli && /npm-cli\.c?js$/.test(cli)) return [process.execPath, [cli], false]
  return ['npm', [], process.platform === 'win32']
}

const run = (command, args, options) =>
  new Promise((resolve, reject) => {
    const child = spawn(command, args, options)
    child.once('error', reject)
    child.once('exit', (code, signal) => resolve(signal || code))
  })

async function install(root) {
  const { env, done } = npmEnvironment()
  const [command, first, shell] = npmCommand()
  // no install scripts: the one native module ships its binaries, so nothing needs a compiler or a download
  const args = [...first, 'ci', '--include=dev', '--ignore-scripts', '--no-audit', '--no-fund', '--loglevel=error']
  try {
    // npm's own output goes to stderr: stdout belongs to the command that comes after the set-up
    const end = await run(command, args, { cwd: root, env, shell, stdio: ['ignore', 2, 2] })
    if (end !== 0) {
      throw new Error(
        `npm ci ended with ${end}. It needs the package registry once: check network, proxy and disk, then repeat.`
      )
    }
  } finally {
    done()
  }
}

/**
 * @param {string} root folder with package.json and package-lock.json
 * @returns {Promise<'ready'|'found'|'installed'>} what was done
 */
async function setUp(root) {
  if (stampIsGood(root)) return 'ready'
  return withLock(root, async () => {
    if (stampIsGood(root)) return 'ready'
    if (installedByHand(root)) {
      writeStamp(root)
      return 'found'
    }
    say('installing what package-lock.json lists, once (about half a minute) ...')
    const start = Date.now()
    await install(root)
    writeStamp(root)
    say(`done in ${Math.round((Date.now() - start) / 1000)} s`)
    return 'installed'
  })
}

async function main() {
  const major = Number.parseInt(process.versions.node, 10)
  if (major < LEAST_NODE) throw new Error(`Node.js ${LEAST_NODE} or newer is needed, this is ${process.versions.node}`)
  await setUp(path.resolve(process.argv[2] || path.join(__dirname, '..')))
}

if (require.main === module) {
  main().catch(error => {
    say(error.message)
    process.exitCode = 1
  })
}

module.exports = { setUp, fingerprint }
