'use strict'

/**
 * The two structures between NC and PLC of an INCON-M84/M86/M86R, section 2.14.3, as a model without time: the NC's side of both, and the
 * manual's example programs. Who calls them decides when the NC looks and when the PLC has a scan.
 *
 * @typedef {{ length: number, buffer: Buffer, finish: number }} Handshake struct SerialLinkHandShake
 */

const LENGTH = 256 // SERIALLINK_BUFFER_LENGTH
const LF = 0x0a

/** @returns {Handshake} */
const createHandshake = () => ({ length: 0, buffer: Buffer.alloc(LENGTH), finish: 0 })

/**
 * The NC's side of SerialLinkSend: a length that becomes other than zero starts the transmission; at its end the NC sets `finish`. It never clears
 * it.
 * @param {Handshake} link
 */
const createNcSender = link => {
  let sending = false
  let armed = true
  return {
    /** The NC looks. @returns {Buffer|null} what it begins to send */
    look() {
      if (link.length === 0) armed = true
      if (sending || !armed || link.length === 0) return null
      armed = false
      sending = true
      return Buffer.from(link.buffer.subarray(0, Math.min(link.length, LENGTH)))
    },
    /** The last byte has left. */
    sent() {
      sending = false
      link.finish = 1
    },
    get sending() {
      return sending
    }
  }
}

/**
 * The NC's side of SerialLinkRecv: appends what comes, as long as there is room, and starts over when the PLC sets `finish`.
 * @param {Handshake} link
 * @param {{ restart?: 'always'|'once' }} [options] what `finish` does while it stays 1, about which the manual says nothing: `always`: nothing is
 *   kept; `once`: only its change from 0 to 1 counts
 */
const createNcReceiver = (link, { restart = 'always' } = {}) => {
  let seen = 0
  let lost = 0
  const look = () => {
    if (link.finish && (restart === 'always' || !seen)) link.length = 0
    seen = link.finish
  }
  return {
    look,
    /** @param {Uint8Array} bytes heard on the line */
    put(bytes) {
      for (const byte of bytes) {
        look()
        const room = link.length < LENGTH && !(link.finish && restart === 'always')
        if (room) link.buffer[link.length++] = byte
        else lost++
      }
    },
    /** Bytes for which there was no room, or which came before the PLC had cleared `finish`. */
    get lost() {
      return lost
    }
  }
}

// --- the PLC's programs

/**
 * The manual's `strCopy`, with what is wrong in it: the NUL behind the copy comes one byte too far.
 * @param {Buffer} dest longer than the manual's by what it writes past the end
 * @param {Buffer} source
 * @param {number} most
 */
const strCopy = (dest, source, most) => {
  for (let i = 0; i < most; i++) {
    dest[i] = source[i]
    if (dest[i] === 0) return
  }
  dest[most + 1] = 0
}

/** What a C program sees in an array of characters. @param {Buffer} text with a NUL in it */
const cString = text => text.toString('latin1', 0, text.indexOf(0))

/**
 * The manual's receiving example: a full buffer, or a line feed as its last byte at the moment of the scan, is a message.
 * @param {Handshake} link
 * @param {{ clears?: boolean }} [options] clears: it clears `finish` at length 0, as in the manual; without it `finish` stays 1
 * @returns {{ scan: () => { bytes: Buffer, shown: string, full: boolean }|null, overwritten: number }} scan: the message that it took;
 *   `shown` is what `plc.errorMessage` points at; overwritten: how often strCopy wrote past its array
 */
const createReceiveExample = (link, { clears = true } = {}) => {
  const serialLinkMsg = Buffer.alloc(LENGTH + 2)
  const example = {
    overwritten: 0,
    scan() {
      if (link.length === 0) {
        if (clears) link.finish = 0
        return null
      }
      const full = link.length === LENGTH
      if (!full && link.buffer[link.length - 1] !== LF) return null
      const bytes = Buffer.from(link.buffer.subarray(0, link.length))
      strCopy(serialLinkMsg, link.buffer, link.length)
      if (full && !bytes.includes(0)) example.overwritten++
      link.finish = 1
      return { bytes, shown: cString(serialLinkMsg), full }
    }
  }
  return example
}

/**
 * A sending program in the manner of the M68 example, one text after the other.
 * @param {Handshake} link
 * @param {{ clears?: 'finish'|'length' }} [options] finish: it clears `finish` when it has seen it, as the text says; length: only the length, as
 *   the example does: a stale `finish` then tells of the next text at once that it was sent
 * @returns {{ scan: (text: Uint8Array|null) => boolean }} scan: with the text that is to be sent; true: it takes it for sent
 */
const createSendProgram = (link, { clears = 'finish' } = {}) => ({
  scan(text) {
    if (!text) return false
    if (link.length && link.finish) {
      link.length = 0
      if (clears === 'finish') link.finish = 0
      return true
    }
    if (link.length === 0) {
      link.buffer.set(text.subarray(0, LENGTH))
      link.length = Math.min(text.length, LENGTH)
    }
    return false
  }
})

const TEST = Buffer.from('Test\r\n')

/**
 * The manual's example program: M68 sends `Test` CR LF.
 * @param {Handshake} link
 * @param {{ clears?: 'finish'|'length' }} [options] of {@link createSendProgram}; here `length`, as in the manual
 * @returns {{ scan: (mCode: { flag: boolean, data: number, finish: number }) => void }} sets `mCode.finish` when it is done
 */
const createM68Example = (link, { clears = 'length' } = {}) => {
  const program = createSendProgram(link, { clears })
  return {
    scan(mCode) {
      if (mCode.flag && mCode.data === 68 && program.scan(TEST)) mCode.finish = 1
    }
  }
}

module.exports = {
  LENGTH,
  TEST,
  createHandshake,
  createM68Example,
  createNcReceiver,
  createNcSender,
  createReceiveExample,
  createSendProgram
}
