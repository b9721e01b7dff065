'use strict'

/** The door of the simulator: stations, faulty wires, virtual time, and ways to offer them to real programs. */
module.exports = {
  ...require('./clock'),
  ...require('./random'),
  ...require('./nx-plc'),
  ...require('./chino-regulator'),
  ...require('./melsec-c24'),
  ...require('./incon-controller'),
  ...require('./press'),
  ...require('./line'),
  ...require('./peer'),
  ...require('./wire'),
  ...require('./faults'),
  ...require('./pty'),
  ...require('./serve')
}
