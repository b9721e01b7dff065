'use strict'

/** A node that does nothing but send, one message a name and interval, with the properties of those of nx-read; and how much processor the runtime took. */
module.exports = function (RED) {
  /** @this {any} */
  function BenchSource({ interval, names }) {
    RED.nodes.createNode(this, arguments[0])
    let value = 0
    const send = () => {
      value = (value + 1) & 0xffff
      const id = RED.util.generateId()
      const timestamp = Date.now()
      const messages = names.map((topic, index) => ({
        payload: value,
        topic,
        device: 'Oven',
        quality: 'good',
        timestamp,
        parts: { id, type: 'string', count: names.length, index },
        _msgid: RED.util.generateId()
      }))
      this.send([messages])
    }
    const timer = interval > 0 ? setInterval(send, interval) : null
    this.on('close', () => clearInterval(timer))
  }
  RED.nodes.registerType('bench-source', BenchSource)
  RED.httpAdmin.get('/bench/processor', (_request, response) => response.json(process.cpuUsage()))
}
