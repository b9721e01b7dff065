'use strict'
const { PlcError } = require('../error')
const { parseType } = require('./types')

/**
 * Items: what a user reads or writes, by a tag's name or by an address expression. Pure; the editor bundles this file.
 *
 * @typedef {import('./types').Type} Type
 * @typedef {object} Address what the codec's parser answers (docs/architecture.md)
 * @property {'bit'|'word'} kind
 * @property {number} address absolute, of the first one
 * @property {number} count
 * @property {string} text canonical: `K127.12`
 * @property {boolean} writable whether the area may be written
 * @property {object} [throughWord] the station offers this bit only as part of its word
 * @property {'panel'|'explicit'} [style] how it was written, where there are several ways
 *
 * @typedef {object} Notation how addresses are written for this station
 * @property {(text: string) => Address} parse throws BAD_ADDRESS, UNKNOWN_AREA, OUT_OF_AREA, BAD_BIT
 * @property {(at: { kind: 'bit'|'word', address: number, style?: 'panel'|'explicit' }) => string} format absolute -> canonical text
 * @property {(address: Address) => number} last absolute address of the last word (or bit) of its area
 * @property {(address: Address) => boolean} [packs] whether numbers may stand on bits: sixteen or thirty-two from there, the lowest one is bit 0
 * @property {(row: Record<string, any>) => string[]} [doubts] what a spreadsheet may have done to an address
 * @property {string} [example] of an address, for texts
 * @property {Map<string, import('./tags').Tag>} [tags]
 * @property {'low'|'high'} [wordOrder]
 * @property {'low'|'high'} [byteOrder]
 *
 * @typedef {object} Item
 * @property {string} text as the user wrote it
 * @property {string} name key in messages: the tag's name, or `K127_12`, `M0_M3`, `W10`
 * @property {'bit'|'word'} kind
 * @property {string} addressText canonical
 * @property {boolean} areaWritable whether its area may be written at all
 * @property {number} address absolute, of the first bit or word
 * @property {number} count number of values (1, or those of a range)
 * @property {boolean} range its value is an array
 * @property {Type} type
 * @property {boolean} throughWord a bit that is read through its word
 * @property {boolean} packed a number on bits: a value takes 16 × `type.words` of them
 * @property {'panel'|'explicit'} [style] how its address was written
 * @property {'low'|'high'} wordOrder
 * @property {'low'|'high'} byteOrder
 * @property {import('./tags').Tag|null} tag
 * @property {string} label
 * @property {string} unit
 * @property {{ name: string, text: string }[]} elements one per value
 */

// a raw bit address (`@bit:0x1BFC`) has a colon too, but no type starts with a digit
const TYPED = /^(.*?):\s*([a-z]\w*\s*(?:\[[^\]]*\])?)$/i
const LONGEST = 200 // characters of one item: texts come in messages, and what reads them must stay fast

const splitType = text => {
  const typed = TYPED.exec(text)
  return typed ? [typed[1].trimEnd(), typed[2]] : [text, '']
}

/** An identifier out of an address: Change and Switch nodes and charts split keys at dots. */
const keyOf = text => {
  const key = text.replace(/\.\./g, '_').replace(/\W+/g, '_')
  return /^[A-Za-z_]/.test(key) ? key : `_${key}`
}

const plainType = kind => (kind === 'bit' ? 'bool' : 'uint16')

const typeFor = (text, { address, typeText, notation }) => {
  const type = parseType(typeText || plainType(address.kind))
  if (type.kind === address.kind) return type
  const packs = address.kind === 'bit' && Boolean(notation.packs?.(address))
  if (packs && type.numeric) return type
  const known = packs ? 'bool and all numbers' : address.kind === 'bit' ? 'bool' : 'all but bool'
  const reason = address.kind === 'bit' ? `${text} is a bit, which is bool` : `${text} is a word, bool needs a bit`
  throw new PlcError('BAD_TYPE', { type: type.name, reason: packs ? `${text} is a bit` : reason, known })
}

const isPacked = ({ kind }, type) => kind === 'bit' && type.kind === 'word'

/** Addresses that one value takes. */
const widthOf = (address, type) => (isPacked(address, type) ? 16 * type.words : type.words)

/** How many values of a type stand at the address; a single one may be longer than the word that is written. */
const countOf = (text, { address, type, notation }) => {
  const range = address.count > 1
  const width = widthOf(address, type)
  const unit = address.kind === 'bit' ? 'bits' : 'words'
  if (range && address.count % width !== 0) {
    throw new PlcError('BAD_TYPE', {
      type: type.name,
      reason: `${text} has ${address.count} ${unit}, which is no multiple of ${width}`,
      known: `ranges of a multiple of ${width} ${unit}`
    })
  }
  const end = address.address + (range ? address.count : width) - 1
  if (end > notation.last(address)) {
    throw new PlcError('OUT_OF_AREA', {
      address: text,
      area: address.text,
      range: `${notation.last(address) - address.address + 1} ${unit} from there, ${type.name} takes ${width}`
    })
  }
  return { range, count: range ? address.count / width : 1 }
}

const elementsOf = (item, notation) => {
  if (!item.range) return [{ name: item.name, text: item.tag ? item.name : item.addressText }]
  return Array.from({ length: item.count }, (_, index) => {
    const { kind, style } = item
    const text = notation.format({ kind, style, address: item.address + index * widthOf(item, item.type) })
    return { name: item.tag ? `${item.name}_${index}` : keyOf(text), text }
  })
}

const tagged = (tag, notation) => ({
  wordOrder: tag?.wordOrder || notation.wordOrder || 'low',
  byteOrder: tag?.byteOrder || notation.byteOrder || 'low',
  tag: tag ?? null,
  label: tag ? tag.label : '',
  unit: tag ? tag.unit : ''
})

/**
 * An address expression with an optional type: `M0`, `K127.12`, `W10:float32`, `W20:string[8]`, `M0..M127`,
 * `W0..W9:float32` (5 values).
 * @param {string} expression
 * @param {Notation} notation
 * @param {{ tag?: import('./tags').Tag, text?: string }} [given] the tag that the expression is the address of; what the user wrote
 * @returns {Item}
 * @throws {PlcError} BAD_ADDRESS, UNKNOWN_AREA, OUT_OF_AREA, BAD_BIT, BAD_TYPE
 */
const parseExpression = (expression, notation, { tag, text = expression } = {}) => {
  const [addressText, written] = splitType(expression.trim())
  const address = notation.parse(addressText.trim())
  const type = typeFor(expression, { address, typeText: written || tag?.type, notation })
  const item = {
    text,
    name: tag ? tag.name : keyOf(address.text),
    kind: address.kind,
    address: address.address,
    addressText: address.text,
    ...countOf(expression, { address, type, notation }),
    type,
    throughWord: Boolean(address.throughWord),
    packed: isPacked(address, type),
    ...(address.style && { style: address.style }),
    areaWritable: address.writable,
    ...tagged(tag, notation)
  }
  return withElements(item, notation)
}

/**
 * A range has thousands of elements: they are made when they are asked for, which is after the whole has been counted.
 * @returns {Item}
 */
const withElements = (item, notation) => {
  let elements
  const get = () => (elements ??= elementsOf(item, notation))
  return Object.defineProperty(item, 'elements', { get, enumerable: true })
}

/**
 * An item: a tag's name, or an address expression.
 * @param {unknown} text
 * @param {Notation} notation
 * @returns {Item}
 * @throws {PlcError} BAD_ITEMS if it is no text, else as {@link parseExpression}
 */
const parseItem = (text, notation) => {
  if (typeof text !== 'string' || text.trim() === '') {
    const hint = typeof text === 'number' ? `, not the number ${text}: write the address in quotes` : ''
    throw new PlcError('BAD_ITEMS', {
      reason: `an item is a text such as ${notation.example ?? 'M0'} or a tag name${hint}`
    })
  }
  if (text.length > LONGEST) {
    throw new PlcError('BAD_ADDRESS', {
      address: `${text.slice(0, 20)}…`,
      reason: `it has more than ${LONGEST} characters`
    })
  }
  const name = text.trim()
  const tag = notation.tags?.get(name)
  return tag ? parseExpression(tag.address, notation, { tag, text: name }) : parseExpression(name, notation)
}

const meaning = item => `${item.tag ? 'tag ' : ''}${item.kind} ${item.address} ${item.count} ${item.type.name}`

const clashes = items => {
  const meanings = new Map()
  for (const item of items) {
    const known = meanings.get(item.name) ?? new Set()
    meanings.set(item.name, known.add(meaning(item)))
  }
  return new Set([...meanings].filter(([, known]) => known.size > 1).map(([name]) => name))
}

/**
 * Items whose names differ: where two addresses would share a key (`W10` and `W10:float32`), the typed ones are called
 * `W10_float32`. The same item twice keeps its name.
 * @param {Item[]} items
 * @returns {Item[]}
 * @throws {PlcError} BAD_ITEMS if a name still means two things (a tag is called like another item's key)
 */
const distinctNames = items => {
  const shared = clashes(items)
  if (shared.size === 0) return items
  const plain = item => item.tag || item.type.name === plainType(item.kind) || !shared.has(item.name)
  const suffix = item => `_${keyOf(item.type.name).replace(/_$/, '')}`
  const renamed = items.map(item =>
    plain(item)
      ? item
      : {
          ...item,
          name: item.name + suffix(item),
          elements: item.elements.map(element => ({ ...element, name: element.name + suffix(item) }))
        }
  )
  const [still] = clashes(renamed)
  if (still === undefined) return renamed
  const both = renamed.filter(item => item.name === still).map(item => item.text)
  throw new PlcError('BAD_ITEMS', { reason: `${both.join(' and ')} would both be called ${still}` })
}

module.exports = { distinctNames, keyOf, parseExpression, parseItem, splitType }
