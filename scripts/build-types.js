'use strict'

/** Makes types/*.d.ts from the JSDoc of lib/, for the packed package: `npm run build` (also run by `npm pack`). */

const { execFileSync } = require('node:child_process')
const fs = require('node:fs')
const path = require('node:path')

const root = path.join(__dirname, '..')
const out = path.join(root, 'types')

fs.rmSync(out, { recursive: true, force: true })
const options = {
  allowJs: true,
  checkJs: false,
  declaration: true,
  emitDeclarationOnly: true,
  skipLibCheck: true,
  target: 'ES2022',
  module: 'node16',
  moduleResolution: 'node16',
  maxNodeModuleJsDepth: 0,
  types: 'node',
  rootDir: path.join(root, 'lib'),
  outDir: out
}
const flags = Object.entries(options).flatMap(([name, value]) => [`--${name}`, String(value)])
const doors = ['index.js', 'sim/index.js'].map(name => path.join(root, 'lib', name))
const compiler = require.resolve('typescript/bin/tsc')
try {
  execFileSync(process.execPath, [compiler, ...flags, ...doors], { cwd: root, stdio: ['ignore', 'pipe', 'inherit'] })
} catch (error) {
  process.stderr.write(String(/** @type {any} */ (error).stdout || error))
  process.exitCode = 1
}
