'use strict'
const { current, open } = require('./check')
const { fillDefaults, suggest, tabs } = require('./widgets')
const { t } = require('./texts')

/** The dialog of plc-line. */

const PREFIX = 'node-config-input-'
const SPEEDS = ['1200', '2400', '4800', '9600', '19200', '38400', '57600', '115200']

/** How a line is called that has no name. */
const lineLabel = line => {
  if (line.transport === 'tcp') return line.host ? `${line.host}:${line.port}` : t('editor.newLine')
  if (line.transport === 'simulated') return t('editor.simulatedLine')
  return line.path || t('editor.newLine')
}

const loadPorts = () =>
  $.getJSON('plc-line/ports').then(
    answer => answer.ports,
    () => []
  )

const showMenu = (button, ports) => {
  const field = $(`#${PREFIX}path`)
  const options = ports.map(port => ({
    label: port.label,
    onselect: () => field.val(port.path).trigger('change')
  }))
  if (options.length === 0) options.push({ label: t('editor.noPorts'), disabled: true, onselect: () => {} })
  const menu = RED.popover.menu({ options })
  menu.show({ target: button, align: 'left', offset: [button.outerWidth() - 2, -1], dispose: true })
}

const show = transport => {
  $('.nxline-serial').toggle(transport === 'serial')
  $('.nxline-tcp').toggle(transport === 'tcp')
  $('.nxline-simulated').toggle(transport === 'simulated')
  $('.nxline-real').toggle(transport !== 'simulated')
}

/** oneditprepare of plc-line. */
const editLine = node => {
  open(node, PREFIX)
  fillDefaults(node, PREFIX)
  tabs('nxline-line-tabs', [
    ['nxline-line-connection', t('tab.connection')],
    ['nxline-line-details', t('tab.details')]
  ])
  let ports = []
  const refresh = () =>
    loadPorts().then(found => {
      ports = found
      return found
    })
  suggest(
    $(`#${PREFIX}path`),
    () => ports.map(port => ({ value: port.path, first: port.label })),
    () => true
  )
  suggest(
    $(`#${PREFIX}baudRate`),
    () => SPEEDS.map(value => ({ value })),
    () => true
  )
  const button = $('#nxline-line-ports').attr('title', t('editor.listPorts'))
  button.on('click', () => refresh().then(found => showMenu(button, found)))
  refresh()
  $(`#${PREFIX}transport`)
    .on('change', function () {
      show($(this).val())
      // what counts depends on the transport: let the other fields be judged again
      $(`#${PREFIX}path, #${PREFIX}host, #${PREFIX}port`).trigger('change')
    })
    .trigger('change')
  show(current(node, 'transport'))
}

module.exports = { editLine, lineLabel }
