'use strict'

/**
 * An error for `done` and `node.error` out of a result: Catch nodes show its own property `code`.
 * @param {string} code
 * @param {string} text
 */
const withCode = (code, text) => Object.assign(new Error(text), { name: 'PlcError', code })

module.exports = { withCode }
