'use strict'

// PLC 1, master E2h, unless said otherwise. The bytes come from the manual's rules, closed by two CRC routines that are not ours.
// steps, query, q: the Q; values, r: the R. `name` cites the manual's section.
const M = 0x0c0
const K = 0x140
const K127_12 = 0x1bfc
const K127 = 0x1bf
const bit = address => ({ kind: 'bit', address })
const word = address => ({ kind: 'word', address })
const zeros = count => '00 '.repeat(count)

const EXCHANGES = [
  {
    name: '"Communication Program Examples": read M0..M127, 4-step; LEN 0 = 256 bytes in the answer',
    steps: 4,
    query: { ask: 'readWords', base: M, count: 128 },
    q: '01 E2 03 03 C0 00 80 59 9A',
    values: new Array(128).fill(0),
    r: `E2 01 83 00 ${zeros(256)} EC AB`
  },
  {
    name: '"Read words": M0, M1, 2-step',
    steps: 2,
    query: { ask: 'readWords', base: M, count: 2 },
    q: '01 E2 23 03 C0 00 02 58 3C',
    values: [0x1234, 0xabcd],
    r: 'E2 01 A3 04 34 12 CD AB 8D 13'
  },
  {
    name: '"Read bits": K127.12 on',
    steps: 2,
    query: { ask: 'readBits', base: K127_12, count: 1 },
    q: '01 E2 21 03 FC 1B 01 AB 01',
    values: [true],
    r: 'E2 01 A1 01 FF CD D8'
  },
  {
    name: '"Read bits": K127.12 off',
    steps: 2,
    query: { ask: 'readBits', base: K127_12, count: 1 },
    q: '01 E2 21 03 FC 1B 01 AB 01',
    values: [false],
    r: 'E2 01 A1 01 00 8D 98'
  },
  {
    name: '"Write bits": K127.12 on',
    steps: 2,
    query: { ask: 'writeBits', base: K127_12, values: [true] },
    q: '01 E2 22 03 FC 1B FF 6E 81',
    values: true,
    r: 'E2 01 A2 01 00 7D 98'
  },
  {
    name: '"Write words": K0, 2-step',
    steps: 2,
    query: { ask: 'writeWords', base: K, values: [0x1234] },
    q: '01 E2 24 04 40 01 34 12 66 20',
    values: true,
    r: 'E2 01 A4 01 00 9D 99'
  },
  {
    name: '"Write words": K0, 4-step',
    steps: 4,
    query: { ask: 'writeWords', base: K, values: [0x1234] },
    q: '01 E2 04 04 40 01 34 12 61 40',
    values: true,
    r: 'E2 01 84 01 00 9C 53'
  },
  {
    name: '"Communication Program Examples": write K0..K63',
    steps: 4,
    query: { ask: 'writeWords', base: K, values: new Array(64).fill(0) },
    q: `01 E2 04 82 40 01 ${zeros(128)} 35 FF`,
    values: true,
    r: 'E2 01 84 01 00 9C 53'
  },
  {
    name: '"Read bits and words": K127.12 and K127',
    steps: 2,
    query: { ask: 'readMixed', addresses: [bit(K127_12), word(K127)] },
    q: '01 E2 25 04 FC 1B BF 41 45 6B',
    values: [true, 0x5678],
    r: 'E2 01 A5 03 FF 78 56 06 8C'
  },
  {
    name: '"Write bits and words": K127.12 and K127',
    steps: 2,
    query: {
      ask: 'writeMixed',
      writes: [
        { ...bit(K127_12), value: true },
        { ...word(K127), value: 0x5678 }
      ]
    },
    q: '01 E2 26 07 FC 1B FF BF 41 78 56 A8 0D',
    values: true,
    r: 'E2 01 A6 01 00 3C 59'
  },
  {
    name: 'another master: station 255, master BFh, two words from 000h, 4-step',
    steps: 4,
    station: 255,
    master: 0xbf,
    query: { ask: 'readWords', base: 0, count: 2 },
    q: 'FF BF 03 03 00 00 02 CB 45'
  }
]

/** "Structure of Communication Frames" */
const QA = 'E2 01 80 01 00 DD 92'
const RR = '01 E2 00 01 00 2E 28'
/** error 2 to a 2-step read of words: as printed, $8X, and on top of the 2-step code */
const ERROR_2 = ['E2 01 83 01 02 AC 53', 'E2 01 A3 01 02 AD 99']

module.exports = { EXCHANGES, QA, RR, ERROR_2 }
