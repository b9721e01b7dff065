'use strict'

/**
 * A framing of our own for testing listening lines: nothing of a real codec. Messages end with `;`. One that begins with `+` is an ACK, with `-`
 * a NAK, with `?` damaged. What is held longer than `silence` is given away as incomplete.
 */
const KINDS = { '+': 'ack', '-': 'nak', '?': 'damaged' }

const messageOf = (text, complete, reason) => ({
  kind: KINDS[text[0]] ?? 'data',
  bytes: Buffer.from(text, 'latin1'),
  complete,
  ...(reason ? { reason } : {})
})

const toyFraming = ({ key = 'toy', silence = 0 } = {}) => ({
  key,
  create() {
    let text = ''
    const giveAway = reason => {
      const held = text
      text = ''
      return held === '' ? [] : [messageOf(held, false, reason)]
    }
    return {
      silence,
      get held() {
        return text.length
      },
      push(bytes) {
        text += bytes.toString('latin1')
        const parts = text.split(';')
        text = parts.pop() ?? ''
        return parts.map(part => messageOf(part, true))
      },
      flush: () => giveAway('silent'),
      reset: () => giveAway('reopened')
    }
  }
})

/** Listens with the toy framing; keeps the texts, `…` behind those that are not complete. */
const collect = (lease, { framing = toyFraming(), reply = () => undefined, ...options } = {}) => {
  const texts = []
  const listener = lease.listen(
    framing,
    (message, facts) => {
      texts.push(message.bytes.toString('latin1') + (message.complete ? '' : '…'))
      return reply(message, facts)
    },
    options
  )
  return { texts, ...listener }
}

const textOf = hexes => Buffer.from(hexes.join(''), 'hex').toString('latin1')

module.exports = { collect, messageOf, textOf, toyFraming }
