'use strict'

/** The editor in a real Chromium: an example imported, every dialog opened, Test pressed, deployed, a value seen. */

const assert = require('node:assert/strict')
const fs = require('node:fs')
const os = require('node:os')
const path = require('node:path')
const { startNodeRed, until } = require('../support/node-red.js')
const manifest = require('../../package.json')
const { packedProduct, RUNTIMES, startBrowser } = require('./support.js')

/** Pictures for people; CI keeps none. */
const pictures = process.env.SERIAL_PLC_PICTURES || path.join(os.tmpdir(), 'serial-plc-pictures')

for (const { name, red, node } of RUNTIMES) {
  describe(`editor, ${name}`, function () {
    this.bail(true)
    this.timeout(120000)
    let runtime, browser, page
    const problems = []
    const picture = what => {
      const version = /\d/.exec(name)[0]
      return page.screenshot({ path: path.join(pictures, `${version} ${what}.png`) })
    }
    const byId = id => `[id="${id}"]`
    const nodeOf = (type, label) =>
      page.evaluate(
        ([wanted, named]) => {
          let found
          window.RED.nodes.eachNode(it => {
            if (it.type === wanted && (!named || it.name === named)) found = it.id
          })
          return found
        },
        [type, label]
      )
    const openDialog = async (type, label) => {
      await page
        .locator(`${byId(await nodeOf(type, label))} .red-ui-flow-node`)
        .first()
        .dblclick()
      await page.locator('#node-dialog-ok').waitFor()
      await page.waitForFunction(() => !document.querySelector('.red-ui-tray.red-ui-tray-open[style*="transition"]'))
    }
    const closeDialog = async () => {
      await page.locator('#node-dialog-cancel').click()
      await page.locator('#node-dialog-cancel').waitFor({ state: 'hidden' })
    }
    const deploy = async () => {
      await page.locator('#red-ui-header-button-deploy').click()
      await page.waitForFunction(() => !window.RED.nodes.dirty())
    }

    /** Through the menu; `look` is done while the example is chosen. */
    const importExample = async (number, tab, look = async () => {}) => {
      await page.locator('#red-ui-header-button-sidemenu').click()
      await page.locator('#menu-item-import').click()
      await page.locator('#red-ui-clipboard-dialog-import-tabs a:has-text("Examples")').click()
      await page.locator(`.red-ui-treeList-label:visible:has-text("${manifest.name}")`).click()
      await page.locator(`.red-ui-treeList-label:visible:has-text("${number} ${tab}")`).click()
      await look()
      await page.locator('#red-ui-clipboard-dialog-ok').click()
      await page.locator(`.red-ui-tab:has-text("${tab}") a`).first().click()
    }
    /** A page of a configuration's dialog; two clicks in a row count as a double click, which opens none. */
    const openPage = async (device, tab) => {
      const open = async () => {
        await page.locator(`#nxline-${device}-tabs a[href="#nxline-${device}-${tab}"]`).click()
        return page.locator(`#nxline-${device}-${tab}`).isVisible()
      }
      await until(open, { what: `the tab ${tab}`, every: 400 })
    }

    before(async () => {
      fs.mkdirSync(pictures, { recursive: true })
      runtime = await startNodeRed({ red, node, product: packedProduct(), flow: [] })
      browser = await startBrowser()
      page = await browser.newPage({ viewport: { width: 1400, height: 900 }, locale: 'en-US' })
      page.setDefaultTimeout(6000)
      page.on('pageerror', error => problems.push(String(error)))
      await page.goto(runtime.url)
      await page.locator('#red-ui-header-button-deploy').waitFor()
      await page.locator('.red-ui-palette-node').first().waitFor()
      // the welcome panel of a first start
      await page.evaluate(() => document.querySelectorAll('.red-ui-popover').forEach(it => it.remove()))
    })
    after(async () => {
      await browser?.close()
      await runtime?.stop()
    })

    it('shows the nodes in the palette, found by what people type', async () => {
      const search = page.locator('#red-ui-palette-search input')
      const of = type => page.locator(`#red-ui-palette [data-palette-type="${type}"]`)
      const [nx, chino] = [['nx-read', 'nx-write'], ['chino-regulator']]
      for (const [text, types] of Object.entries({ nx, plc: nx, modbus: chino, chino })) {
        await search.fill('')
        // the filter hears keys, not changes
        await search.pressSequentially(text)
        await of('inject').first().waitFor({ state: 'hidden' })
        for (const type of types) await of(type).waitFor()
      }
      await picture('palette')
      await page.locator('#red-ui-palette-search input').fill('')
    })

    it('imports an example from the menu', async () => {
      await importExample('04', 'Write with confirmation', () => picture('import'))
      assert.ok(await nodeOf('nx-write', 'setpoint, verified'))
      await picture('example')
    })

    it('opens the dialog of nx-write, through it those of the PLC and of the line', async () => {
      await openDialog('nx-write', 'setpoint, verified')
      await picture('nx-write')
      assert.equal(await page.locator('#node-input-target').inputValue(), 'setpoint')
      await page.locator('#node-input-btn-plc-edit').click()
      await page.locator('#node-config-input-station').waitFor()
      await page.locator('#node-config-input-timeout').waitFor()
      await picture('nx-config')
      await page.locator('#node-config-input-btn-line-edit').click()
      await page.locator('#node-config-input-transport').waitFor()
      await picture('plc-line')
      assert.equal(await page.locator('#node-config-input-transport').inputValue(), 'simulated')
      await page.locator('#node-config-dialog-cancel').click()
      await page.locator('#node-config-input-transport').waitFor({ state: 'detached' })
      await page.locator('#node-config-dialog-cancel').click()
      await page.locator('#node-config-input-station').waitFor({ state: 'detached' })
      await closeDialog()
    })

    it('deploys, writes with a button, and shows the outcome', async () => {
      await deploy()
      const status = page.locator(
        `${byId(await nodeOf('nx-write', 'setpoint, verified'))} .red-ui-flow-node-status-label`
      )
      const button = page.locator(`${byId(await nodeOf('inject', '215.5 °C'))} .red-ui-flow-node-button-button`)
      await button.click()
      await page.waitForFunction(
        id => /written|confirmed/i.test(document.querySelector(`[id="${id}"]`).textContent),
        await nodeOf('nx-write', 'setpoint, verified')
      )
      assert.match(await status.textContent(), /SIM/)
      const outcome = await runtime.next(await nodeOf('debug', 'confirmed'))
      assert.equal(outcome.outcome, 'confirmed')
      await picture('deployed')
    })

    it('Test in the dialog of the PLC says that it answers', async () => {
      await openDialog('nx-write', 'setpoint, verified')
      await page.locator('#node-input-btn-plc-edit').click()
      await page.locator('#nxline-nx-test').click()
      const result = page.locator('#nxline-nx-test-result')
      await result.waitFor()
      await page.waitForFunction(() => /answer/i.test(document.querySelector('#nxline-nx-test-result').textContent))
      await picture('test')
      for (const tab of ['tags', 'writing', 'details']) {
        await openPage('nx', tab)
        await picture(`nx-config ${tab}`)
      }
      await page.locator('#node-config-dialog-cancel').click()
      await page.locator('#nxline-nx-test').waitFor({ state: 'detached' })
      await closeDialog()
    })

    it('opens the dialog of nx-read', async () => {
      await importExample('03', 'Read on demand')
      await openDialog('nx-read', 'temperature, M0..M3')
      await picture('nx-read')
      await closeDialog()
    })

    it('a value that is read is seen in the debug sidebar', async () => {
      await deploy()
      await page.evaluate(() => globalThis.RED.sidebar.show('debug'))
      await page.locator(`${byId(await nodeOf('inject', 'ask now'))} .red-ui-flow-node-button-button`).click()
      const seen = page.locator('.red-ui-debug-msg', { hasText: 'temperature' }).last()
      await seen.waitFor()
      // { temperature: 21.5, M0_M3: array[4] }
      assert.match(await seen.textContent(), /temperature: -?\d/)
      await picture('value')
    })

    it('a regulator: the dialog of the node shows what its mode needs', async () => {
      await importExample('11', 'Set an output')
      await openDialog('chino-regulator', 'zone 1')
      const target = page.locator('#node-input-target')
      const items = page.locator('#nxline-read-items')
      const shown = async () => [await items.isVisible(), await target.isVisible()]
      assert.deepEqual(await shown(), [true, true])
      await picture('chino-regulator')
      await page.locator('#node-input-mode').selectOption('read')
      assert.deepEqual(await shown(), [true, false])
      await page.locator('#node-input-mode').selectOption('write')
      assert.deepEqual(await shown(), [false, true])
      await target.fill('load_current')
      await page.locator('#nxline-write-note', { hasText: 'can only be read' }).waitFor()
      await target.fill('')
      await page.locator('#node-input-mode').selectOption('both')
    })

    const testRegulator = async expected => {
      await page.locator('#nxline-chino-test').click()
      const result = page.locator('#nxline-chino-test-result')
      await until(async () => expected.test(await result.textContent()), { what: String(expected), every: 50 })
      return result.textContent()
    }

    it('its configuration: Test says that it answers, and what is wrong with a number', async () => {
      await page.locator('#node-input-btn-regulator-edit').click()
      const station = page.locator('#node-config-input-station')
      await station.waitFor()
      await testRegulator(/^Station 1 answers in \d+ ms: manual_output = /)
      await picture('chino-config')
      await station.fill('300')
      await testRegulator(/^Station: Allowed is 0 to 247$/)
      await station.fill('0')
      await testRegulator(/broadcast/)
      await station.fill('1')
    })

    it('its tags: the template waits for addresses, a wrong one is told in the notation of MODBUS', async () => {
      await openPage('chino', 'tags')
      const rows = page.locator('#nxline-chino-tag-list > li')
      const before = await rows.count()
      await page.locator('#nxline-chino-template').click()
      const added = rows.nth(before)
      await added.getByText('Fill in the address').waitFor()
      const address = added.locator('.nxline-address')
      assert.equal(await address.evaluate(input => input === document.activeElement), true)
      await address.fill('1001')
      const told = added.getByText('a zero in front may have been lost')
      assert.doesNotMatch(await told.textContent(), /M0/)
      await picture('chino-config template')
      await address.fill('001001')
      await added.getByText('function 01, wire address 1000 (03E8h)').waitFor()
      for (const tab of ['writing', 'details']) {
        await openPage('chino', tab)
        await picture(`chino-config ${tab}`)
      }
      await page.locator('#node-config-dialog-cancel').click()
      await page.locator('#nxline-chino-test').waitFor({ state: 'detached' })
      await closeDialog()
    })

    it('a regulator is polled and set, above its limit it is not', async () => {
      await deploy()
      const press = async label =>
        page.locator(`${byId(await nodeOf('inject', label))} .red-ui-flow-node-button-button`).click()
      await press('output 40 %')
      assert.equal((await runtime.next(await nodeOf('debug', 'confirmed'))).outcome, 'confirmed')
      await press('output 95 %: over the limit')
      assert.equal((await runtime.next(await nodeOf('debug', 'not confirmed'))).code, 'VALUE_OUT_OF_RANGE')
      await picture('regulator deployed')
    })

    const field = property => page.locator(`#node-input-${property}`)
    const shown = property => field(property).isVisible()

    it('a C24: its dialog shows what the protocol needs', async () => {
      await importExample('13', 'C24 words to MQTT')
      await openDialog('melsec-c24')
      await field('framing').selectOption('end')
      assert.deepEqual([await shown('end'), await shown('count')], [true, false])
      await field('framing').selectOption('count')
      assert.deepEqual([await shown('end'), await shown('count')], [false, true])
      await picture('melsec-c24')
      await field('bidirectional').check()
      assert.equal(await shown('framing'), false)
      await openPage('melsec-c24', 'sending')
      assert.equal(await shown('access'), true)
      await openPage('melsec-c24', 'details')
      await picture('melsec-c24 details')
      await closeDialog()
    })

    it('an INCON controller: what acknowledged lines need is shown with checked lines only', async () => {
      await importExample('14', 'INCON machine events')
      await openDialog('incon-link')
      const fields = async () => [await shown('acknowledge'), await shown('ackTimeout')]
      assert.deepEqual(await fields(), [false, false])
      await field('checked').check()
      assert.deepEqual(await fields(), [true, false])
      await field('acknowledge').check()
      assert.deepEqual(await fields(), [true, true])
      await picture('incon-link')
      await field('checked').uncheck()
      assert.deepEqual([await fields(), await field('acknowledge').isChecked()], [[false, false], false])
      await openPage('incon-link', 'sending')
      assert.equal(await field('scan').inputValue(), '100')
      await field('access').selectOption('read')
      assert.equal(await shown('scan'), false)
      await picture('incon-link sending')
      await closeDialog()
    })

    it('nothing failed in the page meanwhile', () => assert.deepEqual(problems, []))
  })
}
