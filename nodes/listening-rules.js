'use strict'
const { PROPERTIES, readProperty } = require('./properties')

/** What nodes that listen on one line must have alike, since the line cuts its bytes into messages once, for all of them. Pure: the dialogs use it, too. */

/** @type {Record<string, { title: string, shared: string[] }>} */
const LISTENERS = {
  'melsec-c24': {
    title: 'MELSEC C24',
    shared: [
      ...[
        'bidirectional',
        'framing',
        'end',
        'count',
        'gap',
        'most',
        'first',
        'last',
        'asciiBinary',
        'unit',
        'sumCheck'
      ],
      ...['padEven', 'flow', 'transparent', 'room', 'stallLimit', 'timer0', 'tornEnd'],
      ...['priority', 'repeatAfter', 'repeatWithin']
    ]
  },
  'incon-link': { title: 'INCON', shared: ['most', 'silence', 'checked', 'acknowledge', 'encoding'] }
}

const shown = value => (value === '' ? 'none' : value)

/** Settings as they were saved, or as they were read: numbers may be texts. */
const valueOf = ({ type, settings }, name) => readProperty(PROPERTIES[type][name], settings[name]).value

/**
 * Why two nodes cannot listen on one line; '' if they can.
 * @param {{ type: string, settings: Record<string, any> }} one
 * @param {{ type: string, settings: Record<string, any> }} other
 */
const portConflict = (one, other) => {
  if (one.type !== other.type)
    return `the one is ${LISTENERS[one.type].title}, the other ${LISTENERS[other.type].title}`
  const name = LISTENERS[one.type].shared.find(each => valueOf(one, each) !== valueOf(other, each))
  return name ? `${name} is ${shown(valueOf(one, name))} and ${shown(valueOf(other, name))}` : ''
}

module.exports = { LISTENERS, portConflict }
