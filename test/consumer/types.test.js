'use strict'

/** The types that the package publishes are those that the compiler finds in the JSDoc: a strict program must get along with them. */

const assert = require('node:assert/strict')
const path = require('node:path')
const ts = require('typescript')
const { root } = require('../support/source.js')

const lib = path.join(root, 'lib')

describe('types', () => {
  it('a strict TypeScript program compiles, and what is wrong in it is found', function () {
    this.timeout(60000)
    const file = path.join(__dirname, 'program.ts')
    const program = ts.createProgram([file], {
      strict: true,
      noEmit: true,
      allowJs: true,
      skipLibCheck: true,
      target: ts.ScriptTarget.ES2022,
      module: ts.ModuleKind.Node16,
      moduleResolution: ts.ModuleResolutionKind.Node16,
      maxNodeModuleJsDepth: 0,
      types: ['node'],
      paths: {
        '@nxline/node-red-serial-plc': [path.join(lib, 'index.js')],
        '@nxline/node-red-serial-plc/sim': [path.join(lib, 'sim', 'index.js')]
      }
    })
    // of the program alone: `npm run typecheck` looks at the sources
    const texts = ts
      .getPreEmitDiagnostics(program, program.getSourceFile(file))
      .map(({ messageText }) => ts.flattenDiagnosticMessageText(messageText, ' '))
    assert.deepEqual(texts, [])
  })
})
