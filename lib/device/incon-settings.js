'use strict'
const { BUFFER } = require('../codec/incon/message')
const { PlcError } = require('../error')
const { blank, choice, isOn, textOf, wholeNumber } = require('./options')

const ENCODINGS = ['ascii', 'latin1', 'utf8']

/** One scan of the controller's PLC until its program sees the line, one until it has cleared `finish`, and some. */
const pauseOf = (quiet, scan) => Math.max(quiet, 2 * scan + 5)

/**
 * Settings of an INCON link, checked and complete; `pause`: ms after each line of ours.
 * @param {Record<string, any>} given options of `createInconLink`
 * @throws {PlcError} BAD_SETTING
 */
const readSettings = given => {
  const quiet = wholeNumber('quiet', given.quiet, { fallback: 50, least: 0, most: 60000 })
  const scan = wholeNumber('scan', given.scan, { fallback: 100, least: 0, most: 10000 })
  const settings = {
    name: blank(given.name) ? 'INCON' : textOf('name', given.name),
    encoding: choice('encoding', given.encoding, ENCODINGS),
    checked: isOn(given.checked),
    acknowledge: isOn(given.acknowledge),
    attempts: wholeNumber('attempts', given.attempts, { fallback: 5, least: 1, most: 100 }),
    ackTimeout: wholeNumber('ackTimeout', given.ackTimeout, { fallback: 1000, least: 10, most: 600000 }),
    most: wholeNumber('most', given.most, { fallback: BUFFER, least: 2, most: 4096 }),
    silence: wholeNumber('silence', given.silence, { fallback: 200, least: 0, most: 60000 }),
    pause: pauseOf(quiet, scan),
    before: wholeNumber('before', given.before, { fallback: 5, least: 0, most: 60000 }),
    deadline: wholeNumber('deadline', given.deadline, { fallback: 0, least: 0, most: 3600000 })
  }
  if (!settings.acknowledge || settings.checked) return settings
  const reason = 'only checked lines have the number that is acknowledged'
  throw new PlcError('BAD_SETTING', { setting: 'acknowledge', value: true, reason })
}

module.exports = { readSettings }
