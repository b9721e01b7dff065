'use strict'
const fs = require('node:fs')
const path = require('node:path')
const vm = require('node:vm')

/** The dialogs without a browser: the .html files' scripts and resources/editor.js run against a small stand-in of the editor. */

const ROOT = path.join(__dirname, '..', '..')
const NODES = path.join(ROOT, 'nodes')
const TYPES = [
  'plc-line',
  'nx-config',
  'nx-read',
  'nx-write',
  'chino-config',
  'chino-regulator',
  'melsec-c24',
  'incon-link',
  'plc-monitor'
]
const LANGUAGES = ['en-US', 'ko']

const html = type => fs.readFileSync(path.join(NODES, `${type}.html`), 'utf8')
const catalogue = (language, type) =>
  JSON.parse(fs.readFileSync(path.join(NODES, 'locales', language, `${type}.json`), 'utf8'))
const scriptOf = type => /<script type="text\/javascript">([\s\S]*?)<\/script>/.exec(html(type))[1]

const lookUp = (tree, key) => key.split('.').reduce((node, part) => node?.[part], tree)

/** RED._ with the real catalogue and the editor's own marks. */
const translator = language => (key, values) => {
  const [, type, rest] = /^@nxline\/node-red-serial-plc\/([\w-]+):(.*)$/.exec(key)
  const text = lookUp(catalogue(language, type), rest)
  if (text === undefined) return values?.defaultValue ?? rest
  return text.replace(/__(\w+)__/g, (_, name) => String(values?.[name] ?? ''))
}

/**
 * @param {{ language?: string, nodes?: any[] }} [options] nodes: what RED.nodes.node finds
 * @returns {{ types: Record<string, any>, ui: any }} the definitions of all types
 */
const loadDialogs = ({ language = 'en-US', nodes = [] } = {}) => {
  const types = {}
  const RED = {
    _: translator(language),
    nodes: {
      registerType: (type, definition) => (types[type] = definition),
      node: id => nodes.find(node => node.id === id) ?? null,
      eachConfig: visit => nodes.forEach(visit),
      eachNode: visit => nodes.forEach(visit)
    }
  }
  const context = vm.createContext({ RED, $: () => ({ length: 0 }), console })
  vm.runInContext(fs.readFileSync(path.join(ROOT, 'resources', 'editor.js'), 'utf8'), context)
  for (const type of TYPES) vm.runInContext(scriptOf(type), context)
  return { types, ui: context.nxlineSerialPlc }
}

module.exports = { LANGUAGES, NODES, ROOT, TYPES, catalogue, html, loadDialogs, lookUp, translator }
