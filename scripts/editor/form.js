'use strict'
const { open } = require('./check')
const { attempt, notationWithTags, parseItem } = require('./model')
const { fillDefaults } = require('./widgets')

/** The open dialog of a node of the flow: its fields, its device, and what that knows. */

const PREFIX = 'node-input-'
const field = name => $(`#${PREFIX}${name}`)
const value = name => field(name).val()

/** Which field names the device, and of which type that is. One dialog of this kind is open at a time. */
const DEVICES = {
  'nx-read': { property: 'plc', of: 'nx-config' },
  'nx-write': { property: 'plc', of: 'nx-config' },
  'chino-regulator': { property: 'regulator', of: 'chino-config' }
}
let form = DEVICES['nx-read']

/** A dialog of this type opens. */
const openForm = (type, node) => {
  form = DEVICES[type]
  open(node, PREFIX)
  fillDefaults(node, PREFIX)
}

/** The name of the field that names the device. */
const deviceProperty = () => form.property

const deviceOf = () => RED.nodes.node(value(form.property))
/** The device, or one without any settings: its addresses are known all the same. */
const device = () => deviceOf() || { type: form.of }
const notation = () => notationWithTags(device())
const isModbus = () => form.of === 'chino-config'

const tagOffers = () =>
  [...notation().tags.values()].map(tag => ({
    value: tag.name,
    hint: [tag.address, tag.label, tag.unit].filter(Boolean).join(' · ')
  }))

const isItem = text => attempt(() => Boolean(parseItem(text, notation())), false)

/** What a dialog shows: all of it, but for chino-regulator what its mode needs. */
const reads = () => form.of !== 'chino-config' || value('mode') !== 'write'
const writes = () => form.of !== 'chino-config' || value('mode') !== 'read'
const showsList = () => reads() && value('itemsType') === 'list'

module.exports = {
  PREFIX,
  device,
  deviceOf,
  deviceProperty,
  field,
  isItem,
  isModbus,
  notation,
  openForm,
  reads,
  showsList,
  tagOffers,
  value,
  writes
}
