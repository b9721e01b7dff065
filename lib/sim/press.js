'use strict'

const SETTINGS = { recipe: 1, target: 1800 }

/** A machine that counts its pieces and follows what a recipe sets, in tenths of a degree. */
function createMachine() {
  const machine = { ...SETTINGS, pieces: 0, temperature: 200 }
  return {
    step() {
      machine.pieces = (machine.pieces + 1) % 10000
      machine.temperature += Math.round((machine.target - machine.temperature) / 5)
      return machine
    },
    set(recipe, target) {
      if (Number.isFinite(recipe)) machine.recipe = recipe
      if (Number.isFinite(target)) machine.target = Math.round(target)
    }
  }
}

const wordsOf = ({ pieces, recipe, temperature, target }) => [pieces, recipe, temperature, target]
const bytesOf = words => Buffer.from(words.flatMap(word => [word & 255, (word >> 8) & 255]))
const textOf = ({ pieces, recipe, temperature }) =>
  Buffer.from(`PIECES=${pieces};RECIPE=${recipe};TEMP=${(temperature / 10).toFixed(1)}`)

/**
 * What the sequence program of a simulated C24 (melsec-c24.js) may run: a press that tells how it is, as text or as four words (pieces, recipe,
 * temperature, set value), and takes a recipe, as text (`RECIPE=7;TEMP=215.5`) or as words (number, set value).
 *
 * @param {{ format?: string, count?: number }} [options] format: `text`, else words; count: bytes of each message, 0: as many as it takes
 * @returns {{ says: () => Buffer, obey: (bytes: Buffer) => void }}
 */
function createPress({ format = 'text', count = 0 } = {}) {
  const machine = createMachine()
  const isText = format === 'text'
  const fitted = bytes => (count > 0 ? Buffer.concat([bytes, Buffer.alloc(count)]).subarray(0, count) : bytes)
  return {
    says() {
      const state = machine.step()
      return fitted(isText ? textOf(state) : bytesOf(wordsOf(state)))
    },
    obey(bytes) {
      if (bytes.length < 2) return
      if (!isText) return machine.set(bytes.readUInt16LE(0), bytes.length >= 4 ? bytes.readUInt16LE(2) : NaN)
      const text = bytes.toString('latin1')
      const number = name => parseFloat(new RegExp(`${name}=([\\d.]+)`).exec(text)?.[1] ?? '')
      machine.set(number('RECIPE'), number('TEMP') * 10)
    }
  }
}

module.exports = { createPress }
