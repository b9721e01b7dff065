'use strict'

/** scripts/setup.js on small packages without dependencies: npm needs no network for them. */

const assert = require('node:assert/strict')
const { spawn } = require('node:child_process')
const fs = require('node:fs')
const os = require('node:os')
const path = require('node:path')
const { root } = require('./support/source.js')

const script = path.join(root, 'scripts', 'setup.js')

/** A package with one dependency inside its own folder. */
function makePackage() {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'set-up-test-'))
  fs.mkdirSync(path.join(folder, 'inner'))
  const dependencies = { inner: 'file:inner' }
  const inner = { name: 'inner', version: '1.0.0' }
  const lock = {
    name: 'outer',
    version: '1.0.0',
    lockfileVersion: 3,
    packages: {
      '': { name: 'outer', version: '1.0.0', dependencies },
      inner: { version: '1.0.0' },
      'node_modules/inner': { resolved: 'inner', link: true }
    }
  }
  const put = (name, value) => fs.writeFileSync(path.join(folder, name), JSON.stringify(value))
  put('package.json', { name: 'outer', version: '1.0.0', dependencies })
  put('inner/package.json', inner)
  put('package-lock.json', lock)
  return { folder, put, lock }
}

const run = (folder, env = {}) =>
  new Promise(resolve => {
    const child = spawn(process.execPath, [script, folder], { env: { ...process.env, ...env } })
    let said = ''
    child.stderr.on('data', bytes => (said += bytes))
    child.stdout.on('data', bytes => (said += `STDOUT ${bytes}`))
    child.on('exit', code => resolve({ code, said, installed: /installing/.test(said) }))
  })

describe('set-up', function () {
  this.timeout(30000)
  const folders = []
  const make = () => {
    const made = makePackage()
    folders.push(made.folder)
    return made
  }
  after(() => folders.forEach(folder => fs.rmSync(folder, { recursive: true, force: true })))

  it('installs once; then it says nothing and needs no npm', async () => {
    const { folder } = make()
    const first = await run(folder)
    assert.deepEqual([first.code, first.installed], [0, true], first.said)
    assert.ok(fs.existsSync(path.join(folder, 'node_modules', 'inner', 'package.json')))
    assert.deepEqual(await run(folder, { PATH: '', npm_execpath: '' }), { code: 0, said: '', installed: false })
  })

  it('three at once install once', async () => {
    const { folder } = make()
    const ends = await Promise.all([run(folder), run(folder), run(folder)])
    assert.deepEqual(
      ends.map(end => end.code),
      [0, 0, 0]
    )
    assert.equal(ends.filter(end => end.installed).length, 1)
    assert.deepEqual(fs.readdirSync(path.join(folder, '.cache')), [])
  })

  it('takes over the lock of a process that died', async () => {
    const { folder } = make()
    fs.mkdirSync(path.join(folder, '.cache'))
    const dead = spawn(process.execPath, ['-e', '0'])
    await new Promise(resolve => dead.on('exit', resolve))
    fs.writeFileSync(path.join(folder, '.cache', 'set-up.lock'), `${dead.pid} x`)
    const end = await run(folder)
    assert.equal(end.code, 0, end.said)
  })

  it('installs anew when the lockfile or the major of Node.js changes', async () => {
    const { folder, put, lock } = make()
    await run(folder)
    put('package-lock.json', { ...lock, version: '1.0.1', packages: { ...lock.packages } })
    assert.equal((await run(folder)).installed, true)
    const stamp = path.join(folder, 'node_modules', '.set-up')
    fs.writeFileSync(stamp, fs.readFileSync(stamp, 'utf8').replace(/node-\d+/, 'node-1'))
    assert.equal((await run(folder)).installed, true)
  })

  it('takes an installation that somebody made by hand', async () => {
    const { folder } = make()
    await run(folder)
    fs.rmSync(path.join(folder, 'node_modules', '.set-up'))
    assert.equal((await run(folder)).installed, false)
    assert.ok(fs.existsSync(path.join(folder, 'node_modules', '.set-up')))
  })

  it('works where the home folder cannot be written', async () => {
    const { folder } = make()
    const nowhere = path.join(folder, 'package.json', 'home')
    const end = await run(folder, { HOME: nowhere, npm_config_cache: '', XDG_CACHE_HOME: nowhere })
    assert.equal(end.code, 0, end.said)
  })

  it('says what is wrong when npm cannot install', async () => {
    const { folder, put } = make()
    put('package.json', { name: 'outer', version: '1.0.0', dependencies: { other: 'file:other' } })
    const end = await run(folder)
    assert.equal(end.code, 1)
    assert.match(end.said, /npm ci ended with 1\. It needs the package registry once/)
  })
})
