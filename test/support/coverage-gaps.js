'use strict'

/**
 * Branches that no unit test takes, by file and by what stands in the line, and why.
 * @type {[file: string, line: string, why: string][]}
 */
const GAPS = [
  // --- never wrong to have: what stands before it already sees to it
  [
    'lib/line/courier.js',
    'if (!letter || letter.left) return',
    'the alarm is stopped with its letter; kept for a clock that fires a timer it has cleared'
  ],
  [
    'lib/line/driver.js',
    'facts?.sent ?? false',
    'who is on the wire has facts; kept for a listener that gives the line up between two of its events'
  ],
  ['lib/line/exchange.js', 'if (!job) return null', 'the same'],
  [
    'lib/line/exchange.js',
    'return this.#job === job ? this.#fail(error) : undefined',
    'a recogniser that throws after it has given up its own run'
  ],
  ['lib/line/exchange.js', 'verdict.need ?? 1', 'a run that ended is left before; its verdict has no need'],
  [
    'lib/line/outbox.js',
    'if (this.#letter !== letter) return',
    'a port that fails inside the call, while what ends a torn message is written: needs two faults at one instant'
  ],
  ['lib/line/quarantine.js', 'if (!match) return', 'a step that awaits nothing is not told to the quarantine'],
  ['lib/line/stream.js', 'this.#splitter?.flush() ?? []', 'the silence is stopped with its splitter'],
  ['lib/line/pool.js', 'entry.owner.name', 'an entry without leases is taken out of the pool when its last lease goes'],
  ['lib/line/pool.js', 'holder.owner.name', 'only while a line closes that nobody has any more'],
  ['lib/line/watch.js', 'this.#lines.get(line) ?? {}', 'a line that was left is not followed'],
  [
    'lib/line/transports/memory.js',
    'if (!end) return done',
    'nothing is written to a transport that has said that it was closed'
  ],
  [
    'lib/line/transports/serial.js',
    "if (was === 'opening') this.#handlers.failed(gone)",
    'serialport 13 tells of a loss only while it reads; before that a write or the first read does'
  ],
  [
    'lib/device/c24-talk.js',
    'OUR_NAK[reason] ?? OUR_NAK.other',
    'each reason of a frame that has begun has its code; a new one would get this'
  ],
  ['lib/device/diagnosis/station.js', 'item ?? FIRST[given.protocol][0]', 'the raw address is always one'],
  ['lib/device/diagnosis/causes.js', "CODES[code]?.[1] ?? 'Look at the cause.'", 'each code of ours has its remedy'],
  ['lib/device/health.js', 'if (!this.#isDemoted) return', 'the timer is stopped when a station comes back'],
  [
    'lib/device/diagnose.js',
    'if (heard.event) return resolve(undefined)',
    'an answer that comes late, but in the same turn as the end of the read'
  ],
  ['lib/device/diagnosis/causes.js', "hex.match(/../g)?.join(' ') ?? ''", 'only bytes that came are shown'],
  ['lib/device/diagnosis/station.js', '} catch {', 'a device that could be made knows its own tags'],
  ['lib/device/diagnosis/station.js', 'return isUsable ? row : undefined', 'the same'],
  ['lib/device/health.js', '    throw error', 'a conversation that goes on after it was told to end; ours do not'],
  [
    'lib/device/health.js',
    'if (this.#health.probeAt - this.#clock.now() > 1) this.#arm()',
    'another device of the station has probed: only where both timers are due at one moment'
  ],
  ['lib/device/health.js', 'if (at >= this.#health.probeAt) return', 'its own probe is due sooner, by chance'],
  ['lib/device/incon-talk.js', '} catch {', 'an acknowledgement that the line does not take: the other side repeats'],
  ['lib/device/incon-talk.js', 'if (over) return', 'its deadline and its end at one moment'],
  ['lib/device/incon-talk.js', 'settle(now >= due ? tooLate()', 'a deadline that ends while the start goes out'],
  ['lib/device/incon-talk.js', 'if (port.closed) leave()', 'a link that is closed between two turns of the loop'],
  ['lib/device/incon-talk.js', 'if (flight.end) return null', 'acknowledged while a repetition waits for its turn'],
  ['lib/device/incon-talk.js', 'if (sent > 0) flight.went(sent)', 'a line that is cut off: test/line/stream-torn'],
  [
    'lib/device/modbus-clearing.js',
    'if (!step.match) return yield step',
    'a broadcast goes out without it; kept for a conversation that has one among its steps'
  ],
  [
    'lib/device/modbus-exchange.js',
    'if (!end) throw',
    'modbus-serial 8 says something of each frame; kept for another version of it'
  ],
  ['lib/device/plans.js', "if (error.code !== 'FRAME_TOO_LONG') throw error", 'addresses were checked before'],
  ['lib/device/talk.js', 'result.seenStation ??', 'each answer of a PLC tells its number'],
  // --- real time, real descriptors
  [
    'lib/line/transports/paced-binding.js',
    'if (!port.isOpen) throw canceled()',
    'a descriptor that becomes readable while the port is closed: test/system'
  ],
  [
    'lib/line/exchange.js',
    'this.#link.waiting() ? this.#clock.now()',
    'bytes that lie in a real port: test/line/transports, test/system'
  ],
  [
    'lib/line/evidence-file.js',
    'if (this.#writing || this.#waiting.length === 0) return',
    'a timer that fires while a write of the disk goes on'
  ],
  ['lib/line/evidence-file.js', "error?.code ?? 'unknown'", 'errors of the disk have codes'],
  // --- lines of tests and of programs of others
  ['lib/device/nx-plc.js', 'lease.line.times?.character ?? 0.52', 'each line of the pool has its times'],
  ['lib/device/load.js', 'this.#line.times?.character ?? 1', 'the same'],
  ['lib/device/load.js', 'this.#line.loads ?? new Set([this.all])', 'the same of its loads'],
  [
    'lib/device/health.js',
    'if (this.#closed) return',
    'a device that is closed by another one that hears of the same event before it'
  ],
  ['lib/device/modbus-talk.js', 'this.#lease.line.times?.character ?? 0', 'the same'],
  [
    'lib/device/diagnosis/trials.js',
    'test.given.trialPool ?? createPool',
    'tests give the pool, so that no real port is opened'
  ],
  // --- bounds that only years reach
  ['lib/device/modbus-talk.js', 'exact.size >= MOST_EXACT', 'a bound of memory'],
  ['lib/device/modbus-clearing.js', 'numbers.length > MOST_NUMBERS', 'a bound of memory'],
  ['lib/device/device.js', 'this.#weight > MOST_KNOWN', 'a bound of memory'],
  ['lib/device/reader.js', 'job.splits >= MOST_SPLITS', 'a bound of the requests of one read']
]

module.exports = { GAPS }
