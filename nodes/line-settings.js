'use strict'

/** What the pool gets of the settings of a line: numbers as numbers. */
const poolSettings = settings => ({
  ...settings,
  dataBits: Number(settings.dataBits),
  stopBits: Number(settings.stopBits)
})

module.exports = { poolSettings }
