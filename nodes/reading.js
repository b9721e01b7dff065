'use strict'
const { PlcError, createReport, itemsOf, messagesOf } = require('../lib/index.js')
const { withCode } = require('./faults')
const { onStarted } = require('./started')

/** What every node that reads has in common: its list of items, polling, questions by message, and what it sends. */

const VARIABLE = /^\$\{([^}]+)\}$/

/** @returns {any} why an item cannot be read, or null */
const problemOf = (device, text) => {
  const variable = VARIABLE.exec(text)
  if (variable) return new PlcError('ENV_MISSING', { variable: variable[1], setting: 'items' })
  try {
    device.item(text)
    return null
  } catch (error) {
    return error
  }
}

const badResult = ({ text, problem }, timestamp) => ({
  name: text.replace(/\W+/g, '_'),
  item: text,
  value: null,
  quality: 'bad',
  code: problem.code,
  text: problem.message,
  timestamp
})

/**
 * A list of items of which some may not exist: they name themselves and do not stop the others.
 * @param {any} device
 * @param {string[]} texts
 * @returns {{ valid: string[], complete: (results: any[]) => any[], problems: any[] }} `complete`: one result for each text
 * @throws {PlcError} the first problem, if no item is left
 */
const sorted = (device, texts) => {
  const rows = texts.map(text => ({ text, problem: problemOf(device, text) }))
  const valid = rows.filter(({ problem }) => !problem).map(({ text }) => text)
  const problems = rows.flatMap(({ problem }) => problem ?? [])
  if (valid.length === 0) throw problems[0]
  if (problems.length === 0) return { valid, complete: results => results, problems }
  const complete = results => {
    const rest = results[Symbol.iterator]()
    const timestamp = results[0]?.timestamp ?? Date.now()
    return rows.map(row => (row.problem ? badResult(row, timestamp) : rest.next().value))
  }
  return { valid, complete, problems }
}

const isBad = result => result.quality === 'bad'

/** What is wrong with results, as one error; null if nothing is. */
const faultOf = results => {
  const bad = results.filter(isBad)
  if (bad.length === 0) return null
  const more = bad.length < results.length ? ` (${bad.length} of ${results.length} items are bad)` : ''
  return withCode(bad[0].code, bad[0].text + more)
}

/** @param {any[]} results @param {number | null} advice a timeout that would do */
const summary = (results, advice) => {
  let bad = 0
  let code
  for (const result of results) {
    if (!isBad(result)) continue
    if (bad === 0) code = result.code
    bad++
  }
  return { phase: /** @type {'read'} */ ('read'), count: results.length, bad, code, advice }
}

/** Nobody asked, so nothing has to go on. Of messages sent together Node-RED copies all but the first, of single ones none. */
const sendOneByOne = (RED, messages, send) => {
  const _msgid = RED.util.generateId()
  for (const message of messages) {
    message._msgid = _msgid
    send(message)
  }
}

/** Sends results: the first message is the one that asked, if one did, so that its other properties go on. */
const createDelivery = (RED, { settings, deviceNode, device }) => {
  const { format, badValues, ranges, booleans } = settings
  const { label, simulated } = deviceNode
  const report = createReport(settings)
  const deliver = (results, msg, send) => {
    const id = RED.util.generateId()
    const shape = { format, badValues, ranges, booleans, device: label, simulated, id }
    const parts = messagesOf(report(results, device.time), shape)
    if (parts.length === 0) return
    if (!msg) return sendOneByOne(RED, parts, send)
    delete msg.bad
    const carriers = parts.map((_, index) => (index === 0 ? msg : RED.util.cloneMessage(msg)))
    send([parts.map((fields, index) => Object.assign(carriers[index], fields))])
  }
  return Object.assign(deliver, { reset: report.reset })
}

/** Calls `again` when a line that was lost is open again. @returns {(line: { state: string }) => void} who is to be told of the line */
const reconnected = again => {
  let isLost = false
  return ({ state }) => {
    if (state === 'waiting') isLost = true
    if (state !== 'open' || !isLost) return
    isLost = false
    again()
  }
}

/** After each deploy: what the polls of a line cost is known when all nodes are made. */
const adviseOf = (RED, { node, cost }) => {
  if (!cost) return () => {}
  return onStarted(RED.events, () => {
    const { advice } = cost()
    if (advice) node.warn(advice)
  })
}

const takeItems = msg => {
  const items = Object.hasOwn(msg, 'items') ? msg.items : undefined
  delete msg.items
  return items
}

/**
 * Which items a message asks for. With a list in the node that list, whatever the message says; a node in which `msg.items` may name others
 * takes `true` for its own list.
 */
const choice =
  ({ device, fixed, named }) =>
  msg => {
    if (fixed && !named) return fixed
    const items = takeItems(msg)
    return fixed && items === true ? fixed : sorted(device, itemsOf(items))
  }

/**
 * Starts the polling of a node, if it has a list and an interval.
 * @param {any} RED
 * @param {any} session of {@link import('./session').openSession}; settings as those of nx-read
 * @param {{ named?: boolean }} [options] named: `msg.items` may name other items than the node's list
 * @returns {{ ask: (msg: any, send: (messages: any) => void) => Promise<void>, stop: () => void }} `ask` rejects with what goes to `done`
 * @throws {PlcError} what is wrong with the list
 */
const startReading = (RED, session, { named = false } = {}) => {
  const { node, settings, device, display } = session
  const deliver = createDelivery(RED, session)
  session.lineChanged = reconnected(deliver.reset)
  /** @type {any} */
  const fixed = settings.itemsType === 'list' ? sorted(device, itemsOf(settings.items)) : null
  fixed?.problems.forEach(session.warn)
  const chosen = choice({ device, fixed, named })

  const show = results => {
    if (!session.closed) display.update(summary(results, device.advice))
  }
  const ask = async (msg, send) => {
    const { valid, complete } = chosen(msg)
    const results = complete(await device.read(valid))
    show(results)
    deliver(results, msg, send)
    if (results.every(({ quality }) => quality === 'bad')) throw faultOf(results)
  }
  const polled = (answers, { failure, changed }) => {
    // nothing could even be asked: no item fits
    if (answers.length === 0) {
      show([{ quality: 'bad', code: failure.code }])
      if (changed) node.error(withCode(failure.code, failure.text ?? failure.message), {})
      return
    }
    const results = fixed.complete(answers)
    show(results)
    deliver(results, null, messages => node.send(messages))
    const fault = changed ? faultOf(answers) : null
    if (fault) node.error(fault, { device: session.deviceNode.label })
  }
  const polling = fixed && settings.interval > 0
  const group = { items: fixed?.valid, interval: settings.interval, name: node.name || node.id }
  const subscription = polling ? device.subscribe(group, polled) : null
  const stopAdvice = adviseOf(RED, { node, cost: subscription && (() => subscription.cost) })
  const stop = () => {
    stopAdvice()
    subscription?.stop()
  }
  return { ask, stop }
}

module.exports = { reconnected, startReading }
