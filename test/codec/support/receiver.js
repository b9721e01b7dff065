'use strict'
const { PlcError } = require('../../../lib/error')

const EMPTY = Buffer.alloc(0)

/**
 * A line in miniature: feeds chunks to a match and does what its verdicts say. No time.
 * @returns {{ take?: Buffer, bad?: string, need?: number, ours?: boolean, skipped: number, left: Buffer, calls: number }}
 */
function receive(match, chunks) {
  let bytes = EMPTY
  let skipped = 0
  let need = match(EMPTY).need
  let ours = false
  let calls = 1
  for (const chunk of chunks) {
    bytes = Buffer.concat([bytes, chunk])
    while (bytes.length > 0 && bytes.length >= need) {
      const verdict = match(bytes)
      calls++
      if (verdict.take)
        return { take: bytes.subarray(0, verdict.take), left: bytes.subarray(verdict.take), skipped, calls }
      if (verdict.bad) return { bad: verdict.bad, left: bytes.subarray(verdict.length), skipped, calls }
      if (verdict.need) {
        if (verdict.need <= bytes.length) throw new Error(`asks for ${verdict.need} bytes, has ${bytes.length}`)
        need = verdict.need
        ours = verdict.ours ?? false
        break
      }
      if (!(verdict.skip > 0 && verdict.skip <= bytes.length)) throw new Error(`no verdict: ${JSON.stringify(verdict)}`)
      skipped += verdict.skip
      bytes = bytes.subarray(verdict.skip)
      need = 1
    }
  }
  return { need, ours, skipped, left: bytes, calls }
}

/**
 * Plays the line for a conversation: each turn of the script answers one step with bytes, or fails it with a code.
 * @param {Generator} dialog
 * @param {Array<Buffer | [string, object?]>} script
 * @returns {{ steps: any[], result?: any, error?: any }}
 */
function play(dialog, script) {
  const steps = []
  const rest = [...script]
  try {
    let turn = dialog.next()
    while (!turn.done) {
      steps.push(turn.value)
      if (rest.length === 0) throw new Error('the conversation asks for more than the script has')
      turn = answer(dialog, turn.value, rest.shift())
    }
    if (rest.length > 0) throw new Error(`${rest.length} turns of the script were not asked for`)
    return { steps, result: turn.value }
  } catch (error) {
    if (!(error instanceof PlcError)) throw error
    if (rest.length > 0) throw new Error('ended early', { cause: error })
    return { steps, error }
  }
}

function answer(dialog, step, turn) {
  if (Array.isArray(turn)) return dialog.throw(new PlcError(turn[0], { station: 1, timeout: step.timeout, ...turn[1] }))
  const got = receive(step.match, [turn])
  if (got.take) return dialog.next(got.take)
  if (got.bad) return dialog.throw(new PlcError('CRC_ERROR', { station: 1, got: turn.toString('hex'), sent: true }))
  return dialog.throw(
    new PlcError(got.ours ? 'INCOMPLETE' : 'TIMEOUT', { station: 1, timeout: step.timeout, sent: true })
  )
}

module.exports = { receive, play }
