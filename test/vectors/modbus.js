'use strict'

// Panel manual, appendix A: its worked examples, station 17 (11h). The bodies are printed there; the check codes are those of our protocol page, made
// by two routines that are not ours. 0F has no example there: "MODBUS application protocol", 6.11. `crc` as sent, `lrc`: request, answer.
const bits = text => [...text.replace(/ /g, '')].map(digit => digit === '1')

const EXCHANGES = [
  {
    name: 'A.1 read coils 20 to 56',
    query: { fn: 1, base: 19, count: 37 },
    q: '11 01 00 13 00 25',
    r: '11 01 05 CD 6B B2 0E 1B',
    // as the manual's table shows them, from coil 20 on
    values: bits('10110011 11010110 01001101 01110000 11011'),
    crc: ['0E 84', '45 E6'],
    lrc: ['B6', 'D6']
  },
  {
    name: 'A.2 read inputs 10197 to 10218',
    query: { fn: 2, base: 196, count: 22 },
    q: '11 02 00 C4 00 16',
    r: '11 02 03 AC DB 35',
    values: bits('00110101 11011011 101011'),
    crc: ['BA A9', '20 18'],
    lrc: ['13', '2E']
  },
  {
    name: 'A.3 read input register 30009',
    query: { fn: 4, base: 8, count: 1 },
    q: '11 04 00 08 00 01',
    r: '11 04 02 00 0A',
    values: [10],
    crc: ['B2 98', 'F8 F4'],
    lrc: ['E2', 'DF']
  },
  {
    name: 'A.4 read holding registers 40108 to 40110',
    query: { fn: 3, base: 107, count: 3 },
    q: '11 03 00 6B 00 03',
    r: '11 03 06 02 2B 00 00 00 64',
    values: [0x022b, 0, 0x64],
    crc: ['76 87', 'C8 BA'],
    lrc: ['7E', '55']
  },
  {
    name: 'A.1 force single coil 173',
    query: { fn: 5, base: 172, value: true },
    q: '11 05 00 AC FF 00',
    r: '11 05 00 AC FF 00',
    values: true,
    crc: ['4E 8B', '4E 8B'],
    lrc: ['3F', '3F']
  },
  {
    name: 'A.4 preset single register 40002',
    query: { fn: 6, base: 1, value: 3 },
    q: '11 06 00 01 00 03',
    r: '11 06 00 01 00 03',
    values: true,
    crc: ['9A 9B', '9A 9B'],
    lrc: ['E5', 'E5']
  },
  {
    name: 'application protocol 6.11: write coils 20 to 29',
    query: { fn: 15, base: 19, values: bits('10110011 10') },
    q: '11 0F 00 13 00 0A 02 CD 01',
    r: '11 0F 00 13 00 0A',
    values: true,
    crc: ['BF 0B', '26 99'],
    lrc: ['F3', 'C3']
  },
  {
    name: 'A.4 preset registers 40002 and 40003',
    query: { fn: 16, base: 1, values: [0x000a, 0x0102] },
    q: '11 10 00 01 00 02 04 00 0A 01 02',
    r: '11 10 00 01 00 02',
    values: true,
    crc: ['C6 F0', '12 98'],
    lrc: ['CB', 'DC']
  }
]

module.exports = { EXCHANGES, STATION: 17 }
