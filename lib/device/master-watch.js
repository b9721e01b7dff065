'use strict'

/**
 * Notices a PLC that answers to one master ID only: silent to changing IDs, and after each silence an answer to the ID of its last answer.
 * It only reports: the changing ID is one of the defences against late answers, and a lossy line may look the same.
 * Pure: what it knows lies in `memory`, which survives redeploys.
 */

const PROOFS = 3
/** The latter: it was demoted in the middle of the read. */
const SILENT = new Set(['TIMEOUT', 'STATION_DEMOTED'])

/**
 * @param {{ memory: { good?: number|null, missed?: boolean, proofs?: number }, found: (id: number) => void }} options
 *   found: called once per series of proofs
 */
const createMasterWatch = ({ memory, found }) => {
  const silent = trial => {
    memory.missed = !trial
    // an answer to this ID may still come: it is not tried again
    if (trial) forget()
  }
  const forget = () => Object.assign(memory, { good: null, proofs: 0 })
  const answered = (id, trial) => {
    memory.missed = false
    if (!trial && id !== memory.good) Object.assign(memory, { good: id, proofs: 0 })
    if (!trial) return
    memory.proofs = (memory.proofs ?? 0) + 1
    if (memory.proofs === PROOFS) found(id)
  }
  return {
    /** The ID that the next read is sent from; undefined: the next of the row. */
    trial: () => (memory.missed ? (memory.good ?? undefined) : undefined),
    /**
     * How a read ended.
     * @param {{ id?: number, trial: boolean, code?: string }} end id: of its last query; trial: it was sent from {@link trial}'s ID;
     *   code: of its error
     */
    note: ({ id, trial, code }) => {
      if (id === undefined) return
      if (code === undefined) answered(id, trial)
      else if (SILENT.has(code)) silent(trial)
      else if (trial) forget()
    }
  }
}

module.exports = { createMasterWatch }
