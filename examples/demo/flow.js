'use strict'

/**
 * The demo's flow with what is known only at run time filled in: where the line is and which port the broker took.
 * @param {{ line: object, mqttPort: number }} options line: properties of `plc-line`
 * @returns {object[]}
 */
const demoFlow = ({ line, mqttPort }) =>
  structuredClone(require('./flow.json')).map(node => {
    if (node.type === 'plc-line') return { ...node, ...line }
    if (node.type === 'mqtt-broker') return { ...node, port: String(mqttPort) }
    return node
  })

module.exports = { demoFlow }
