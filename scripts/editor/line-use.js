'use strict'
const { LISTENERS, portConflict } = require('../../nodes/listening-rules')
const { PROPERTIES } = require('../../nodes/properties')
const { TYPES, deviceName } = require('./model')
const { t } = require('./texts')

/** A line is polled or listened to, never both; and it cuts messages in one way only. */

const nameOf = node => node.name || LISTENERS[node.type].title

/** The nodes that listen on a line. */
const listenersOn = line => {
  const found = []
  RED.nodes.eachNode(node => {
    if (LISTENERS[node.type] && node.line === line && !node.d) found.push(node)
    return true
  })
  return found
}

/** Who listens on a line: a name, or ''. */
const listenerOf = line => {
  const [first] = line ? listenersOn(line) : []
  return first ? nameOf(first) : ''
}

const settingsOf = (type, read) => Object.fromEntries(Object.keys(PROPERTIES[type]).map(name => [name, read(name)]))

/**
 * Whether a node can listen on its line.
 * @param {any} node @param {(name: string) => any} read its properties as they stand in the dialog
 * @returns {true | string}
 */
const lineOfListener = (node, read) => {
  const line = read('line')
  let polled = ''
  RED.nodes.eachConfig(other => {
    if (TYPES.includes(other.type) && other.line === line && !other.d) polled = polled || deviceName(other)
    return true
  })
  if (polled) return t('problem.polled', { other: polled })
  const own = { type: node.type, settings: settingsOf(node.type, read) }
  for (const other of listenersOn(line)) {
    if (other.id === node.id) continue
    const reason = portConflict(own, { type: other.type, settings: other })
    if (reason) return t('problem.otherCut', { other: nameOf(other), reason })
  }
  return true
}

module.exports = { lineOfListener, listenerOf }
