'use strict'
const js = require('@eslint/js')
const globals = require('globals')

const browser = { ...globals.browser, RED: 'readonly', $: 'readonly', nxlineSerialPlc: 'readonly' }

module.exports = [
  {
    ignores: [
      'node_modules/',
      'coverage/',
      'types/',
      'resources/editor.js',
      '.cache/',
      'test/system/node_modules/',
      'test/mutation/node_modules/'
    ]
  },
  js.configs.recommended,
  {
    files: ['**/*.js'],
    languageOptions: { ecmaVersion: 2023, sourceType: 'commonjs', globals: { ...globals.node } },
    linterOptions: { reportUnusedDisableDirectives: 'error' },
    rules: {
      'no-unused-vars': ['error', { args: 'after-used', argsIgnorePattern: '^_', caughtErrorsIgnorePattern: '^_' }],
      'prefer-const': 'error',
      'no-var': 'error',
      eqeqeq: ['error', 'always', { null: 'ignore' }],
      'max-params': ['error', 4],
      'no-shadow': 'error',
      'no-throw-literal': 'error',
      'no-return-await': 'error'
    }
  },
  {
    files: ['lib/**/*.js', 'nodes/**/*.js'],
    rules: {
      'max-lines': ['error', { max: 250, skipBlankLines: true, skipComments: true }],
      'max-lines-per-function': ['error', { max: 40, skipBlankLines: true, skipComments: true }],
      complexity: ['error', 14]
    }
  },
  {
    // tables may be long; factories hold several small functions each
    files: ['lib/error.js', 'lib/codec/**/areas.js', 'lib/codec/**/functions.js', 'lib/tag/types.js'],
    rules: { 'max-lines': 'off' }
  },
  {
    files: ['test/**/*.js', 'bench/**/*.js'],
    languageOptions: { globals: { ...globals.node, ...globals.mocha, ...browser } }
  },
  { files: ['resources/*.js', 'scripts/editor/**/*.js'], languageOptions: { globals: browser } }
]
