'use strict'

// MELSEC-Q serial communication module. User's manual (basic): 6.1 "receive data list", ch. 7 bidirectional protocol; user's manual
// (application): 12.2 to 12.6 transparent codes, 13.3 to 13.5 ASCII-binary conversion. The bytes were copied from there by hand.
const bytes = text => Buffer.from(text.replace(/ /g, ''), 'hex')

const TEXT = 'ABCDEFG123'

/** The data list: 5 (words) or 10 (bytes) at 600H, then the words. */
const IMAGE = { words: [0x4241, 0x4443, 0x4645, 0x3147, 0x3332], word: 5, byte: 10 }

/** `ENQ length data sum`; data of the last three are the words 0212H, BC3AH. */
const FRAMES = [
  { name: 'words', options: {}, body: Buffer.from(TEXT), wire: bytes('05 05 00 41 42 43 44 45 46 47 31 32 33 77 02') },
  { name: 'two words', options: {}, body: bytes('12 02 3A BC'), wire: bytes('05 02 00 12 02 3A BC 0C 01') },
  {
    name: 'additional code 10H, transparent code 02H (12.5)',
    options: { transparent: bytes('10 02') },
    body: bytes('12 02 3A BC'),
    wire: bytes('05 10 02 00 12 10 02 3A BC 0C 01')
  },
  {
    name: 'ASCII-binary conversion, additional code 10H, transparent code 41H (12.5)',
    options: { transparent: bytes('10 41'), asciiBinary: true },
    body: bytes('12 02 3A BC'),
    wire: bytes('05 30 32 30 30 31 32 30 32 33 10 41 42 43 80 02')
  }
]

module.exports = { FRAMES, IMAGE, TEXT, bytes }
