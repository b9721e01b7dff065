'use strict'

/**
 * The demo's flow with what is known only at run time filled in: where the lines are and which port the broker took.
 * @param {{ stations: Offered, press: Offered, machine: Offered, mqttPort: number }} options
 * @returns {object[]}
 */
const demoFlow = ({ stations, press, machine, mqttPort }) => {
  const lines = { Line: stations, 'Line of the press': press, 'Line of the machine': machine }
  return structuredClone(require('./flow.json')).map(node => {
    if (node.type === 'plc-line') return { ...node, ...lines[node.name].settings }
    if (node.type === 'mqtt-broker') return { ...node, port: String(mqttPort) }
    return node
  })
}

/** @typedef {{ settings: object }} Offered settings: properties of `plc-line` */

module.exports = { demoFlow }
