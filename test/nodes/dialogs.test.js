'use strict'
const assert = require('node:assert/strict')
const fs = require('node:fs')
const path = require('node:path')
const { PROPERTIES } = require('../../nodes/properties')
const { build, TARGET } = require('../../scripts/build-editor')
const { TYPES, NODES, html, loadDialogs } = require('./dialogs')

const WRITERS = ['nx-write', 'chino-regulator', 'melsec-c24', 'incon-link']
/** How many outputs a new node has, of those types whose number changes. */
const OUTPUTS = { ...Object.fromEntries(WRITERS.map(type => [type, 1])), 'plc-monitor': 2 }

describe('node dialogs', () => {
  it('resources/editor.js is what scripts/build-editor.js makes', () => {
    assert.equal(fs.readFileSync(TARGET, 'utf8'), build(), 'run: node scripts/build-editor.js')
  })

  for (const type of TYPES) {
    it(`${type}: the defaults of the dialog are those of the run time`, () => {
      const { outputs, ...defaults } = loadDialogs().types[type].defaults
      assert.deepEqual(Object.keys(defaults).sort(), Object.keys(PROPERTIES[type]).sort())
      for (const [name, row] of Object.entries(PROPERTIES[type])) {
        assert.equal(JSON.stringify(defaults[name].value), JSON.stringify(row.fallback), name)
      }
      assert.equal(outputs?.value, OUTPUTS[type])
    })

    it(`${type}: a field for each property, a label for each field, no foreign colours or styles`, () => {
      const text = html(type)
      for (const [name, row] of Object.entries(PROPERTIES[type])) {
        if (row.kind !== 'list') assert.match(text, new RegExp(`id="node-(config-)?input-${name}"`), name)
      }
      assert.doesNotMatch(text, /<style|(color|background)[^;"]*:\s*(#|rgb|white|black|grey|red)/i)
      assert.match(text, /<script src="resources\/@nxline\/node-red-serial-plc\/editor\.js"><\/script>/)
      assert.doesNotMatch(text, /data-i18n="(?!\[)[^"]*"[^>]*>[^<]*[^\s<]/, 'a text outside the catalogue')
    })
  }

  it('the select boxes offer what the run time knows', () => {
    for (const type of TYPES) {
      for (const [name, row] of Object.entries(PROPERTIES[type])) {
        if (row.kind !== 'choice') continue
        const select = new RegExp(`<select\\s+id="node-(?:config-)?input-${name}"[^>]*>([\\s\\S]*?)</select\\s*>`).exec(
          html(type)
        )
        const offered = [...select[1].matchAll(/<option value="([^"]*)"/g)].map(([, value]) => value)
        assert.deepEqual(offered.sort(), [...row.known].sort(), `${type}.${name}`)
      }
    }
  })

  it('a node without a saved number of outputs keeps its wires', () => {
    // the editor cuts wires beyond the definition's number where the flow does not give one
    const { types } = loadDialogs()
    for (const [type, most] of [
      ['nx-write', 2],
      ['chino-regulator', 3],
      ['melsec-c24', 3],
      ['incon-link', 3],
      ['plc-monitor', 3]
    ]) {
      assert.equal(types[type].outputs, most)
      assert.equal(types[type].defaults.outputs.value, OUTPUTS[type])
    }
  })

  it('the examples hold every property: a dialog that is closed with Done changes nothing', () => {
    const folder = path.join(NODES, '..', 'examples')
    for (const file of fs.readdirSync(folder).filter(name => name.endsWith('.json'))) {
      for (const node of JSON.parse(fs.readFileSync(path.join(folder, file), 'utf8'))) {
        const wanted = Object.keys(PROPERTIES[node.type] ?? {}).concat(OUTPUTS[node.type] ? 'outputs' : [])
        assert.deepEqual(
          wanted.filter(name => !Object.hasOwn(node, name)),
          [],
          `${file} ${node.type}`
        )
      }
    }
  })

  it('palette: category, labels, icons that are there', () => {
    const { types } = loadDialogs()
    assert.equal(types['nx-read'].category, 'serial PLC')
    assert.equal(types['nx-write'].category, 'serial PLC')
    assert.equal(types['nx-read'].paletteLabel, 'NX PLC read')
    assert.equal(types['nx-write'].paletteLabel, 'NX PLC write')
    assert.equal(types['chino-regulator'].category, 'serial PLC')
    assert.equal(types['chino-regulator'].paletteLabel, 'CHINO regulator (Modbus)')
    assert.notEqual(types['chino-regulator'].color, types['nx-read'].color)
    assert.equal(types['melsec-c24'].paletteLabel, 'MELSEC C24')
    assert.equal(types['incon-link'].paletteLabel, 'INCON link')
    assert.equal(types['plc-monitor'].paletteLabel, 'PLC monitor')
    const colours = ['nx-read', 'chino-regulator', 'melsec-c24', 'incon-link', 'plc-monitor'].map(
      type => types[type].color
    )
    assert.equal(new Set(colours).size, colours.length)
    for (const type of ['nx-read', 'nx-write', 'chino-regulator', 'melsec-c24', 'incon-link', 'plc-monitor']) {
      assert.equal(types[type].category, 'serial PLC')
      assert.ok(fs.existsSync(path.join(NODES, 'icons', types[type].icon)))
    }
  })
})

describe('validators', () => {
  const line = { id: 'line', type: 'plc-line', transport: 'serial', path: '/dev/ttyS9' }
  const plc = {
    id: 'plc',
    type: 'nx-config',
    line: 'line',
    name: 'Oven',
    station: '1',
    access: 'read',
    tags: [{ name: 'level', address: 'W10', type: 'float32' }]
  }
  const regulator = {
    id: 'regulator',
    type: 'chino-config',
    line: 'line',
    name: 'Zone',
    station: '11',
    access: 'write',
    tags: [{ name: 'current', address: '301003' }]
  }
  const readOnly = { ...regulator, id: 'readOnly', line: 'other', name: '', station: '12', access: 'read', tags: [] }
  const all = { ...regulator, id: 'all', line: 'other', name: 'All', station: '0', broadcast: true, tags: [] }
  const seven = { id: 'seven', type: 'plc-line', transport: 'serial', path: '/dev/ttyS8', dataBits: '7' }
  const unnamed = { id: 'unnamed', type: 'nx-config', line: 'line', name: '', station: '7' }
  const machine = { id: 'machine', type: 'incon-link', line: 'spoken', name: 'Machine', most: '256' }
  const { types } = loadDialogs({ nodes: [line, plc, unnamed, regulator, readOnly, all, seven, machine] })
  const judge = (type, name, value, node = {}) =>
    types[type].defaults[name].validate.call({ id: 'own', ...node }, value, {})

  const cases = [
    ['plc-line', 'baudRate', '9600', true],
    ['plc-line', 'baudRate', 'fast', /number is needed: 50 to 4000000/],
    ['plc-line', 'baudRate', '${SPEED}', true],
    ['plc-line', 'path', '', /needed/],
    ['plc-line', 'path', '', true, { transport: 'tcp' }],
    ['plc-line', 'host', '', /needed/, { transport: 'tcp' }],
    ['plc-line', 'host', '', true, { transport: 'serial' }],
    ['plc-line', 'port', '70000', /1 to 65535/, { transport: 'tcp' }],
    ['plc-line', 'gap', '2.5', true],
    ['plc-line', 'queueLimit', '2.5', /whole number/],
    ['nx-config', 'station', '', /needed/],
    ['nx-config', 'station', 0, true],
    ['nx-config', 'station', '191', true],
    ['nx-config', 'station', '192', /0 to 191, or 255/],
    ['nx-config', 'station', '254', /0 to 191, or 255/],
    ['nx-config', 'station', '255', true],
    ['nx-config', 'station', '${STATION}', true],
    ['nx-config', 'station', '1', /Oven on this line has this station number/, { line: 'line' }],
    ['nx-config', 'station', '1', true, { line: 'another' }],
    ['nx-config', 'masterIds', 'E2..E9', true],
    ['nx-config', 'masterIds', 'E2', true],
    ['nx-config', 'masterIds', 'FF', /255|FF/],
    ['nx-config', 'writableRanges', 'M0..M15, K100.3', true],
    ['nx-config', 'writableRanges', 'M0..M15, K900', /outside its area/],
    ['nx-config', 'areas', [], true],
    ['nx-config', 'areas', [{ area: 'W', confirmed: true }], true],
    ['nx-config', 'areas', [{ area: 'M', base: '0x1C8' }], /overlaps/],
    ['nx-config', 'tags', plc.tags, true],
    ['nx-config', 'tags', [{ name: '1st', address: 'M0' }], /not valid/],
    ['nx-config', 'tags', [{ name: 'one', address: 'M128' }], /outside its area/],
    ['nx-read', 'interval', '0', true],
    ['nx-read', 'interval', '-1', /0, or 10 to 86400000/],
    ['nx-read', 'interval', '5', /0, or 10 to 86400000/],
    ['nx-read', 'items', [], /at least one/],
    ['nx-read', 'items', [], true, { itemsType: 'msg' }],
    ['nx-read', 'items', ['M0', 'K127.12', 'level', '${ITEM}'], true, { plc: 'plc' }],
    ['nx-read', 'items', ['M0', 'K127.16'], /0 to 15/, { plc: 'plc' }],
    ['nx-write', 'target', '', true, { plc: 'plc' }],
    ['nx-write', 'target', 'M0', /Oven is read-only/, { plc: 'plc' }],
    ['nx-write', 'target', 'nothing', /not an address/, { plc: 'plc' }],
    ['nx-write', 'target', 'M0', /^NX PLC 7 is read-only/, { plc: 'unnamed' }],
    ['nx-config', 'station', '7', /^NX PLC 7 on this line/, { line: 'line' }],
    ['nx-config', 'station', '11', /^Zone on this line/, { line: 'line' }],
    ['nx-config', 'station', '255', /with Zone: NX station 255 answers/, { line: 'line' }],
    ['chino-config', 'station', '', /needed/],
    ['chino-config', 'station', '247', true],
    ['chino-config', 'station', '248', /0 to 247/],
    ['chino-config', 'station', '0', /allow broadcasts/],
    ['chino-config', 'station', '0', true, { broadcast: true }],
    ['chino-config', 'station', '0', /with Oven: a MODBUS broadcast/, { broadcast: true, line: 'line' }],
    ['chino-config', 'station', '1', /^Oven on this line/, { line: 'line' }],
    ['chino-config', 'station', '12', /^CHINO 12 on this line/, { line: 'other' }],
    ['chino-config', 'station', '226', /master ID 226/, { line: 'line' }],
    ['chino-config', 'protocol', 'rtu', /8 data bits/, { line: 'seven' }],
    ['chino-config', 'protocol', 'ascii', true, { line: 'seven' }],
    ['chino-config', 'protocol', 'rtu', true, { line: 'line' }],
    ['chino-config', 'timeout', '${T}', true],
    ['chino-config', 'coilUnit', '16', true, { coilRead: 2000 }],
    ['chino-config', 'coilUnit', '16', /more than the count/, { coilRead: '8' }],
    ['chino-config', 'discreteUnit', '16', /more than the count/, { discreteRead: '8' }],
    ['chino-config', 'coilFunction', '06', /Known are 0F, 05, auto/],
    ['chino-config', 'holdingWrite', '124', /1 to 123/],
    ['chino-config', 'writableRanges', '400001..400010, 001001', true],
    ['chino-config', 'writableRanges', 'M0..M15', /not an address/],
    ['chino-config', 'tags', regulator.tags, true],
    ['chino-config', 'tags', [{ name: 'gradient', address: '' }], /gradient is not valid/],
    ['chino-config', 'tags', [{ name: 'alarm', address: '1001' }], /zero in front/],
    ['chino-config', 'tags', [{ name: 'bit', address: '400000' }], /outside/, { addressMode: '1-base' }],
    ['chino-config', 'tags', [{ name: 'bit', address: '400000' }], true, { addressMode: '0-base' }],
    ['chino-regulator', 'mode', 'read', true, { regulator: 'regulator' }],
    ['chino-regulator', 'mode', 'read', /only be written/, { regulator: 'all' }],
    ['chino-regulator', 'mode', 'write', true, { regulator: 'all' }],
    ['chino-regulator', 'verify', true, /not read back/, { regulator: 'all', mode: 'write' }],
    ['chino-regulator', 'verify', true, true, { regulator: 'regulator', mode: 'write' }],
    ['chino-regulator', 'items', [], /at least one/, { mode: 'read' }],
    ['chino-regulator', 'items', [], /at least one/, { mode: 'both' }],
    ['chino-regulator', 'items', [], true, { mode: 'write' }],
    ['chino-regulator', 'items', ['400108', 'hr107.05', 'current', '${ITEM}'], true, { regulator: 'regulator' }],
    ['chino-regulator', 'items', ['400108', 'M0'], /not an address/, { regulator: 'regulator' }],
    ['chino-regulator', 'items', ['400108'], true],
    ['chino-regulator', 'target', 'M0', true, { regulator: 'regulator', mode: 'read' }],
    ['chino-regulator', 'target', 'M0', /not an address/, { regulator: 'regulator', mode: 'write' }],
    ['chino-regulator', 'target', '400001', true, { regulator: 'regulator', mode: 'both' }],
    ['chino-regulator', 'target', '300001', /^300001: can only be read/, { regulator: 'regulator', mode: 'write' }],
    ['chino-regulator', 'target', '101001', /can only be read/, { regulator: 'regulator', mode: 'both' }],
    ['chino-regulator', 'target', '001001', true, { regulator: 'regulator', mode: 'both' }],
    ['nx-config', 'station', '9', /^Machine listens on this line/, { line: 'spoken' }],
    ['chino-config', 'station', '9', /^Machine listens on this line/, { line: 'spoken' }],
    ['incon-link', 'line', 'line', /^Oven on this line is asked/, { type: 'incon-link', line: 'line' }],
    ['incon-link', 'line', 'free', true, { type: 'incon-link', line: 'free' }],
    ['incon-link', 'line', 'spoken', true, { type: 'incon-link', line: 'spoken', most: 256 }],
    [
      'incon-link',
      'line',
      'spoken',
      /Machine .*most is 100 and 256/,
      { type: 'incon-link', line: 'spoken', most: 100 }
    ],
    ['melsec-c24', 'line', 'spoken', /the one is MELSEC C24/, { type: 'melsec-c24', line: 'spoken' }],
    ['incon-link', 'most', '1', /2 to 4096/],
    ['incon-link', 'scan', '10001', /0 to 10000/],
    ['incon-link', 'acknowledge', true, /Only checked lines/],
    ['incon-link', 'acknowledge', true, true, { checked: true }],
    ['incon-link', 'attempts', '0', true],
    ['incon-link', 'attempts', '0', /1 to 100/, { checked: true, acknowledge: true }],
    ['melsec-c24', 'end', '0D 0A', true],
    ['melsec-c24', 'end', '0d0a', true],
    ['melsec-c24', 'end', '', /end code/],
    ['melsec-c24', 'end', '', true, { last: '03' }],
    ['melsec-c24', 'end', '', true, { framing: 'count' }],
    ['melsec-c24', 'end', '', true, { bidirectional: true }],
    ['melsec-c24', 'end', 'CR', /Bytes in hex/],
    ['melsec-c24', 'end', '0D 0', /Bytes in hex/],
    ['melsec-c24', 'end', '0D 0A 0D', /0 to 2 bytes/],
    ['melsec-c24', 'end', '${END}', true],
    ['melsec-c24', 'count', 0, true],
    ['melsec-c24', 'count', 0, /number of bytes/, { framing: 'count' }],
    ['melsec-c24', 'gap', 0, true, { framing: 'end' }],
    ['melsec-c24', 'gap', 0, /pause/, { framing: 'gap' }],
    ['melsec-c24', 'gap', 0, true, { framing: 'gap', bidirectional: true }],
    ['melsec-c24', 'flow', 'dc', true],
    ['melsec-c24', 'flow', 'dc', /bidirectional/, { bidirectional: true }],
    ['melsec-c24', 'transparent', '10', true],
    ['chino-regulator', 'target', '400001', /^CHINO 12 is read-only/, { regulator: 'readOnly', mode: 'both' }]
  ]
  for (const [type, name, value, expected, node] of cases) {
    it(`${type}.${name} ${JSON.stringify(value)}${node ? ` with ${JSON.stringify(node)}` : ''}`, () => {
      const verdict = judge(type, name, value, node)
      if (expected === true) assert.equal(verdict, true)
      else assert.match(String(verdict), expected)
    })
  }

  it('declare two parameters, else the editor does not show the reason', () => {
    for (const { defaults } of Object.values(types)) {
      for (const { validate } of Object.values(defaults)) if (validate) assert.equal(validate.length, 2)
    }
  })

  it('the reasons come in Korean, too', () => {
    const korean = loadDialogs({ language: 'ko' }).types
    assert.match(korean['nx-config'].defaults.station.validate.call({}, '', {}), /필수/)
    assert.match(
      korean['nx-config'].defaults.writableRanges.validate.call({}, 'Q1', {}),
      /영역 Q이\(가\) 이 국에 없습니다/
    )
  })
})
