'use strict'

/**
 * Who asked for a write, for the event `audit`.
 * @param {any} node @param {any} msg
 */
const byOf = (node, msg) => ({
  node: node.id,
  name: node.name,
  message: Object.hasOwn(msg, '_msgid') ? msg._msgid : undefined
})

module.exports = { byOf }
