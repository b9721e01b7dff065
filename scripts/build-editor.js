'use strict'
const fs = require('node:fs')
const path = require('node:path')
const esbuild = require('esbuild')

const ROOT = path.join(__dirname, '..')
const TARGET = path.join(ROOT, 'resources', 'editor.js')

/**
 * The script of the edit dialogs: scripts/editor with the pure parts of lib, as one file with the global `nxlineSerialPlc`.
 * @returns {string}
 */
const build = () => {
  const result = esbuild.buildSync({
    entryPoints: [path.join(ROOT, 'scripts', 'editor', 'index.js')],
    absWorkingDir: ROOT,
    bundle: true,
    write: false,
    format: 'iife',
    globalName: 'nxlineSerialPlc',
    platform: 'browser',
    target: 'es2020',
    charset: 'utf8',
    legalComments: 'none',
    banner: { js: '// Built by scripts/build-editor.js from scripts/editor and lib. Do not edit.' }
  })
  return result.outputFiles[0].text
}

if (require.main === module) {
  fs.mkdirSync(path.dirname(TARGET), { recursive: true })
  fs.writeFileSync(TARGET, build())
}

module.exports = { build, TARGET }
