'use strict'

/** The rules that Node-RED's public scorecard and npm's users expect of the package; and that the repository runs anywhere. */

const assert = require('node:assert/strict')
const { execFileSync } = require('node:child_process')
const fs = require('node:fs')
const path = require('node:path')
const manifest = require('../package.json')
const { root, filesBelow, read } = require('./support/source.js')

const exists = name => fs.existsSync(path.join(root, name))
const examples = () => filesBelow('examples', name => name.endsWith('.json') && !name.startsWith('examples/demo/'))
const flow = name => JSON.parse(read(name))

/** Node types of a node's HTML file, with their category. */
function typesOf(html) {
  const found = []
  const text = read(html)
  for (const [, type, rest] of text.matchAll(/registerType\(\s*'([\w-]+)'([\s\S]*?)defaults/g)) {
    found.push({ type, config: /category:\s*'config'/.test(rest) })
  }
  return found
}

/** The names of the packed files, as npm packs them. */
function packed() {
  const [command, first] = process.env.npm_execpath ? [process.execPath, [process.env.npm_execpath]] : ['npm', []]
  const output = execFileSync(command, [...first, 'pack', '--dry-run', '--json', '--ignore-scripts'], {
    cwd: root,
    encoding: 'utf8',
    stdio: ['ignore', 'pipe', 'ignore']
  })
  return JSON.parse(output)[0].files.map(file => file.path)
}

describe('package.json', () => {
  it('has a scoped name, a semver version, a licence and where to report bugs', () => {
    assert.match(manifest.name, /^@[a-z0-9-]+\/node-red-[a-z0-9-]+$/)
    assert.match(manifest.version, /^\d+\.\d+\.\d+$/)
    assert.equal(manifest.license, 'MIT')
    assert.match(read('LICENSE'), /^MIT License/)
    assert.ok(
      manifest.repository.url && manifest.bugs.url && manifest.homepage && manifest.description && manifest.author
    )
  })

  it('is found by the words that people search for', () => {
    const words =
      'node-red, oemax, oe max, nx700, nx-cpu700p, n70plus, chino, thyristor, scr, modbus, rtu, ascii, rs485, rs232, serial, plc, melsec, c24, qj71c24n, incon, cnc, 국번, 시리얼'
    for (const word of words.split(', ')) assert.ok(manifest.keywords.includes(word), word)
  })

  it('says which Node.js and which Node-RED it runs on', () => {
    assert.equal(manifest.engines.node, '>=20')
    assert.equal(manifest['node-red'].version, '>=4.1.0')
  })

  it('has at most six dependencies, each taking the newest release of its major', () => {
    const dependencies = Object.entries(manifest.dependencies)
    assert.ok(dependencies.length <= 6)
    for (const [name, range] of dependencies) assert.match(range, /^\^\d+\.\d+\.\d+$/, name)
  })

  it('start and test set themselves up: npm may skip pre-scripts', () => {
    for (const name of ['start', 'test', 'simulate', 'bench', 'endurance', 'soak']) {
      assert.match(manifest.scripts[name], /^node scripts\/setup\.js && node /, name)
      assert.ok(exists(manifest.scripts[name].split('node ')[2].split(' ')[0]), name)
      assert.equal(manifest.scripts[`pre${name}`], undefined)
    }
    for (const hook of ['preinstall', 'install', 'postinstall', 'prepare'])
      assert.equal(manifest.scripts[hook], undefined, hook)
  })

  it('its set-up needs nothing but Node.js', () => {
    const { imports } = require('./support/source.js')
    assert.deepEqual(
      imports('scripts/setup.js').filter(name => !name?.startsWith('node:')),
      []
    )
  })

  it('the doors that it names exist', () => {
    for (const door of ['.', './sim']) assert.ok(exists(manifest.exports[door].default), door)
    assert.equal(path.posix.join(manifest.main), 'lib/index.js')
  })
})

describe('what npm packs', () => {
  it('is the product and nothing else', () => {
    const allowed =
      /^(lib|nodes|resources|types|docs|icons)\/|^examples\/[^/]+\.json$|^(package\.json|README\.md|LICENSE|CHANGELOG\.md|SECURITY\.md)$/
    const files = packed()
    assert.deepEqual(
      files.filter(name => !allowed.test(name)),
      []
    )
    for (const name of [
      'README.md',
      'LICENSE',
      'lib/index.js',
      'lib/sim/index.js',
      ...Object.values(manifest['node-red'].nodes),
      ...examples()
    ]) {
      assert.ok(files.includes(name), name)
    }
  })

  it('holds every file that the packed sources require', () => {
    const { imports } = require('./support/source.js')
    const files = new Set(packed())
    const missing = []
    for (const file of files) {
      if (!file.endsWith('.js') || file.startsWith('resources/')) continue
      for (const name of imports(file)) {
        if (!name?.startsWith('.')) continue
        const target = path.posix.join(path.posix.dirname(file), name)
        if (!['', '.js', '/index.js', '.json'].some(end => files.has(target + end))) missing.push(`${file}: ${name}`)
      }
    }
    assert.deepEqual(missing, [])
  })
})

describe('nodes', () => {
  const nodes = () => Object.entries(manifest['node-red'].nodes)

  it('have a .js and an .html with the same base name, which is also their name in package.json', () => {
    for (const [name, file] of nodes()) {
      assert.equal(file, `nodes/${name}.js`)
      assert.ok(exists(file) && exists(`nodes/${name}.html`), name)
    }
  })

  it('register the type of that name, in the palette category of the package', () => {
    for (const [name] of nodes()) {
      const types = typesOf(`nodes/${name}.html`)
      assert.deepEqual(
        types.map(it => it.type),
        [name]
      )
      if (!types[0].config) assert.match(read(`nodes/${name}.html`), /category:\s*'serial PLC'/)
      assert.match(read(`nodes/${name}.js`), new RegExp(`registerType\\('${name}'`))
    }
  })

  it('have help and texts in each language, with the same keys', () => {
    const keys = (value, at = '') =>
      value && typeof value === 'object' ? Object.entries(value).flatMap(([key, it]) => keys(it, `${at}.${key}`)) : [at]
    for (const [name] of nodes()) {
      const [english, korean] = ['en-US', 'ko'].map(language => {
        assert.match(read(`nodes/locales/${language}/${name}.html`), new RegExp(`data-help-name="${name}"`), language)
        return keys(JSON.parse(read(`nodes/locales/${language}/${name}.json`)))
      })
      // the texts of errors and their causes are English in the library itself: other languages add them
      const own = korean.filter(key => !/^\.(error|why|cause)\./.test(key) || english.includes(key))
      assert.deepEqual(own.toSorted(), english.toSorted(), name)
      assert.ok(english.length > 0)
    }
  })

  it('that are no configuration stand in at least one example', () => {
    const used = new Set(examples().flatMap(name => flow(name).map(node => node.type)))
    const missing = nodes()
      .flatMap(([name]) => typesOf(`nodes/${name}.html`))
      .filter(it => !it.config && !used.has(it.type))
    assert.deepEqual(missing, [])
  })
})

describe('example flows', () => {
  for (const name of examples()) {
    it(`${path.basename(name)} is a flat array on a tab of its own, with a comment`, () => {
      const nodes = flow(name)
      assert.ok(
        Array.isArray(nodes) && nodes.every(node => typeof node.id === 'string' && typeof node.type === 'string')
      )
      const ids = nodes.map(node => node.id)
      assert.equal(new Set(ids).size, ids.length, 'ids are unique')
      for (const id of ids) assert.match(id, /^[0-9a-f]{16}$/)
      const tabs = nodes.filter(node => node.type === 'tab')
      assert.equal(tabs.length, 1)
      assert.ok(tabs[0].label && tabs[0].info)
      assert.ok(nodes.some(node => node.type === 'comment' && node.info))
    })

    it(`${path.basename(name)} wires and refers to what it holds`, () => {
      const nodes = flow(name)
      const known = new Set(nodes.map(node => node.id))
      for (const node of nodes) {
        const targets = [...(node.wires || []).flat(), ...(node.z ? [node.z] : []), ...(node.g ? [node.g] : [])]
        const keys = node.type === 'mqtt-broker' ? [] : ['broker', 'plc', 'regulator', 'line', 'influxdb', 'mydb']
        for (const key of keys) if (node[key]) targets.push(node[key])
        for (const target of targets) assert.ok(known.has(target), `${node.type} ${node.name || node.id} -> ${target}`)
      }
    })
  }

  it('are named so that the import menu shows what they do', () => {
    assert.ok(examples().length >= 8)
    for (const name of examples()) assert.match(path.basename(name), /^\d\d [A-Za-z0-9 ,-]+\.json$/)
  })
})

describe('the repository', () => {
  const text = () =>
    ['lib', 'nodes', 'scripts', 'examples', 'docs', 'bench', 'test', '.ci']
      .flatMap(folder => filesBelow(folder, name => /\.(js|json|html|md|css|sh)$/.test(name) || !path.extname(name)))
      .concat([
        'package.json',
        'package-lock.json',
        'README.md',
        'CHANGELOG.md',
        'CONTRIBUTING.md',
        'SECURITY.md',
        '.npmrc'
      ])
      .filter(name => name !== 'test/package.test.js' && exists(name))

  it('names no folder of the machine that it was written on', () => {
    const folders = /(?<![\w.@-])\/(work|root|tmp|home)\/\w/
    assert.deepEqual(
      text().filter(name => folders.test(read(name))),
      []
    )
  })

  it('names no host of a package registry; the lockfiles come from any', () => {
    const hosts = /registry\.(npmjs|yarnpkg|npmmirror)|deb\.debian\.org|pypi\.org|proxy\.golang/
    assert.deepEqual(
      text().filter(name => hosts.test(read(name))),
      []
    )
    for (const name of ['package-lock.json', 'test/system/package-lock.json']) {
      assert.doesNotMatch(read(name), /"resolved": "http/, name)
      assert.match(read(name), /"integrity": "sha512-/, name)
    }
    assert.match(read('.npmrc'), /^omit-lockfile-registry-resolved=true$/m)
  })

  it('its lockfile belongs to its package.json', () => {
    const lock = JSON.parse(read('package-lock.json')).packages['']
    assert.deepEqual(lock.dependencies, manifest.dependencies)
    assert.deepEqual(lock.devDependencies, manifest.devDependencies)
    assert.equal(lock.version, manifest.version)
  })

  it('the changelog tells about this version', () => {
    assert.ok(read('CHANGELOG.md').includes(`## ${manifest.version}`))
  })
})
