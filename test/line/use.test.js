'use strict'

const assert = require('node:assert/strict')
const { Use } = require('../../lib/line/use')

const lease = name => ({ owner: { name } })

describe('line: requests or messages', () => {
  it('what the one does, and the other; free again when the last has left', () => {
    const use = new Use('mill')
    const [asks, listens] = [lease('A'), lease('B')]
    assert.equal(use.claim('requests', asks), null)
    assert.deepEqual(use.claim('messages', listens)?.details, {
      owner: 'B',
      other: 'A',
      line: 'mill',
      reason: 'the one listens to messages, the other asks stations',
      sent: false
    })
    assert.equal(use.claim('messages', asks)?.details.other, 'A', 'itself')
    assert.equal(use.claim('requests', listens), null)
    assert.equal(use.conflict(asks, 'x').details.other, 'B')
    use.leave(asks)
    assert.equal(use.kind, 'requests')
    use.leave(listens)
    assert.equal(use.claim('messages', asks), null)
    assert.equal(use.claim('requests', listens)?.details.reason, 'the one asks stations, the other listens to messages')
  })
})
