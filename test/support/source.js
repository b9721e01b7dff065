'use strict'

/** What tests of the repository itself need: its files, what a file imports, which globals it uses. */

const fs = require('node:fs')
const path = require('node:path')
const ts = require('typescript')

const root = path.join(__dirname, '..', '..')
const SKIP = new Set(['node_modules', '.git', '.cache', 'coverage', 'types'])

/** @returns {string[]} files below a folder, relative to the root, with forward slashes, sorted */
function filesBelow(folder, keep = _name => true) {
  const from = path.join(root, folder)
  if (!fs.existsSync(from)) return []
  const found = []
  for (const entry of fs.readdirSync(from, { withFileTypes: true })) {
    const name = path.posix.join(folder, entry.name)
    if (entry.isDirectory() && !SKIP.has(entry.name)) found.push(...filesBelow(name, keep))
    if (entry.isFile() && keep(name)) found.push(name)
  }
  return found.sort()
}

const read = name => fs.readFileSync(path.join(root, name), 'utf8')

const parse = (name, text = read(name)) =>
  ts.createSourceFile(name, text, ts.ScriptTarget.ES2022, true, ts.ScriptKind.JS)

function visit(node, look) {
  look(node)
  ts.forEachChild(node, child => visit(child, look))
}

/** The string in `require('x')`, `require.resolve('x')`, `import('x')`; null for a name that is computed. */
function importedBy(node) {
  if (!ts.isCallExpression(node)) return undefined
  const called = node.expression.getText()
  if (called !== 'require' && called !== 'require.resolve' && node.expression.kind !== ts.SyntaxKind.ImportKeyword)
    return undefined
  const [name] = node.arguments
  return name && ts.isStringLiteralLike(name) ? name.text : null
}

/** @returns {(string|null)[]} */
function imports(name, text) {
  const found = []
  visit(parse(name, text), node => {
    const imported = importedBy(node)
    if (imported !== undefined) found.push(imported)
  })
  return found
}

/** Is this identifier a use of a global, and not the name of a property, a parameter, a key? */
function isUse(node) {
  const { parent } = node
  if (ts.isPropertyAccessExpression(parent)) return parent.expression === node
  if (ts.isPropertyAssignment(parent)) return parent.initializer === node
  if (ts.isBindingElement(parent) || ts.isParameter(parent)) return parent.initializer === node
  return !ts.isMethodDeclaration(parent) && !ts.isPropertyDeclaration(parent)
}

/** Which of the given globals a file uses, as `name` or `name.property`. */
function globalsUsed(name, forbidden, text) {
  const found = new Set()
  visit(parse(name, text), node => {
    if (!ts.isIdentifier(node) || !isUse(node)) return
    const used = ts.isPropertyAccessExpression(node.parent) ? [node.text, node.parent.getText()] : [node.text]
    for (const it of used) if (forbidden.includes(it)) found.add(it)
  })
  return [...found]
}

/** All string literals of a file. */
function strings(name, text) {
  const found = []
  visit(parse(name, text), node => {
    if (ts.isStringLiteralLike(node)) found.push(node.text)
  })
  return found
}

module.exports = { root, filesBelow, read, imports, globalsUsed, strings }
