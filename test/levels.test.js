'use strict'

/** docs/architecture.md: a folder is a level, arrows point one way. */

const assert = require('node:assert/strict')
const path = require('node:path')
const { filesBelow, imports, globalsUsed, read } = require('./support/source.js')

const CLOCKS = ['Date', 'setTimeout', 'setInterval', 'setImmediate', 'performance', 'queueMicrotask', 'process']
const TIMERS = ['setTimeout', 'setInterval', 'setImmediate']
const RANDOM = ['Math.random', 'crypto']

/** level -> what it may import beside itself; `node` = any module of Node.js, `outside` = packages by name */
const LEVELS = {
  error: { pure: true, levels: [] },
  codec: { pure: true, levels: ['error'] },
  tag: { pure: true, levels: ['error', 'codec'] },
  plan: { pure: true, levels: ['error'] },
  output: { pure: true, levels: ['error', 'tag'] },
  line: { node: true, levels: ['error'], outside: ['serialport'] },
  device: { levels: ['error', 'codec', 'tag', 'plan', 'line'], outside: ['modbus-serial'] },
  sim: { node: true, levels: ['error', 'codec'], outside: ['@lydell/node-pty/requireBinary'] },
  index: { levels: ['error', 'codec', 'tag', 'plan', 'output', 'line', 'device'] },
  nodes: { node: true, levels: ['index', 'sim/index'] }
}

/** `lib/codec/nx/frame.js` -> `codec`; `lib/sim/index.js` seen from outside sim -> `sim/index`; `nodes/nx-read.js` -> `nodes` */
function levelOf(file, from) {
  const [top, second] = file.split('/')
  if (top === 'nodes') return 'nodes'
  if (top !== 'lib') return top
  if (['lib/sim', 'lib/sim/index.js'].includes(file) && from !== 'sim') return 'sim/index'
  // `require('../lib')` is the door
  return (second ?? 'index').replace(/\.js$/, '')
}

/** Why `level` may not import `name`, or null. */
function refusal(file, name) {
  const level = levelOf(file, levelOf(file, 'sim'))
  const rule = LEVELS[level]
  if (!rule) return `${level} is no level`
  if (name === null) return 'the name of the module is computed'
  if (name.startsWith('.')) {
    const target = levelOf(path.posix.join(path.posix.dirname(file), name), level)
    return target === level || rule.levels.includes(target) ? null : `${level} must not import ${target}`
  }
  if (name === 'node:buffer') return null
  if (name.startsWith('node:')) return rule.node ? null : `${level} must not import ${name}`
  return rule.outside?.includes(name) ? null : `${level} must not import the package ${name}`
}

const sources = () => [...filesBelow('lib', isSource), ...filesBelow('nodes', isSource)]
const isSource = name => name.endsWith('.js')
const levelIs = (file, wanted) => wanted.includes(levelOf(file, levelOf(file, 'sim')))

describe('levels', () => {
  it('arrows point one way', () => {
    const wrong = sources().flatMap(file =>
      imports(file)
        .map(name => refusal(file, name))
        .filter(Boolean)
        .map(reason => `${file}: ${reason}`)
    )
    assert.deepEqual(wrong, [])
  })

  it('pure levels know no clock, no chance and no process', () => {
    const pure = Object.keys(LEVELS).filter(level => LEVELS[level].pure)
    const files = sources().filter(file => levelIs(file, pure))
    assert.ok(files.length > 10)
    const wrong = files.flatMap(file => globalsUsed(file, [...CLOCKS, ...RANDOM]).map(name => `${file}: ${name}`))
    assert.deepEqual(wrong, [])
  })

  it('line and device take time from the clock they are given', () => {
    // the system clock itself is the one file that may look at the real time
    const files = sources().filter(file => levelIs(file, ['line', 'device']) && !file.endsWith('/clock.js'))
    const real = [...TIMERS.slice(0, 2), 'Date', 'performance']
    const wrong = files.flatMap(file => globalsUsed(file, real).map(name => `${file}: ${name}`))
    assert.deepEqual(wrong, [])
  })

  it('nodes own no timers', () => {
    const files = sources().filter(file => levelIs(file, ['nodes']))
    const wrong = files.flatMap(file => globalsUsed(file, TIMERS).map(name => `${file}: ${name}`))
    assert.deepEqual(wrong, [])
  })

  it('the doors hold no logic', () => {
    for (const door of ['lib/index.js']) assert.deepEqual(globalsUsed(door, [...CLOCKS, ...RANDOM, 'Buffer']), [], door)
  })

  it('the table of docs/architecture.md names the same levels', () => {
    const section = read('docs/architecture.md').split('\n## Levels\n')[1].split('\n## ')[0]
    const rows = [...section.matchAll(/^\| `(?:lib\/)?([\w/.]+)` \|/gm)].map(([, name]) => name.replace(/\.js$/, ''))
    assert.deepEqual(rows.sort(), Object.keys(LEVELS).sort())
  })
})

describe('the check of the levels itself', () => {
  const cases = [
    ['lib/codec/nx/frame.js', '../../line/queue.js', 'codec must not import line'],
    ['lib/codec/nx/frame.js', 'node:fs', 'codec must not import node:fs'],
    ['lib/codec/nx/frame.js', 'node:buffer', null],
    ['lib/codec/nx/frame.js', '../../error.js', null],
    ['lib/line/pool.js', '../codec/crc16.js', 'line must not import codec'],
    ['lib/line/pool.js', 'node:events', null],
    ['lib/device/nx-plc.js', '../sim/index.js', 'device must not import sim/index'],
    ['lib/sim/nx-plc.js', './index.js', null],
    ['lib/index.js', './sim/index.js', 'index must not import sim/index'],
    ['nodes/nx-read.js', '../lib/index.js', null],
    ['nodes/nx-read.js', '../lib/device/nx-plc.js', 'nodes must not import device'],
    ['nodes/plc-line.js', '../lib/sim/index.js', null],
    ['nodes/plc-line.js', '../lib/sim/nx-plc.js', 'nodes must not import sim'],
    ['lib/line/serial.js', 'lodash', 'line must not import the package lodash'],
    ['lib/tag/item.js', null, 'the name of the module is computed']
  ]
  for (const [file, name, expected] of cases) {
    it(`${file} -> ${name}: ${expected ?? 'allowed'}`, () => assert.equal(refusal(file, name), expected))
  }

  it('finds requires and globals wherever they stand', () => {
    const text =
      "const a = require('a')\nfunction f() { return import('b') }\nrequire(a + 'c')\nconst now = () => Date.now()"
    assert.deepEqual(imports('x.js', text), ['a', 'b', null])
    assert.deepEqual(globalsUsed('x.js', ['Date', 'Math.random'], text), ['Date'])
    assert.deepEqual(globalsUsed('x.js', ['Math.random', 'Date'], 'const o = { Date: 1 }; o.Date; Math.random()'), [
      'Math.random'
    ])
  })
})
