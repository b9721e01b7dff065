'use strict'

/** Preloaded into a Node-RED under test: tells its parent what is open in the process. */

const fs = require('node:fs')

const descriptors = () => {
  try {
    return fs.readdirSync('/proc/self/fd').map(fd => {
      try {
        return fs.readlinkSync(`/proc/self/fd/${fd}`)
      } catch {
        return ''
      }
    })
  } catch {
    return []
  }
}

function count() {
  global.gc?.()
  const resources = {}
  for (const type of process.getActiveResourcesInfo()) resources[type] = (resources[type] || 0) + 1
  const listeners = process.eventNames().reduce((sum, name) => sum + process.listenerCount(name), 0)
  const { heapUsed: heap, external, rss } = process.memoryUsage()
  return { resources, descriptors: descriptors().filter(Boolean), listeners, heap, external, rss }
}

process.on('message', message => {
  if (message === 'count') process.send?.(count())
})
