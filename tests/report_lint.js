#!/usr/bin/env node
'use strict';
// Checks the scripts and styles of report.html.
//
//   report_lint.js FOLDER
//
// Scripts by ESLint, all as one, as they share the page's scope; styles by the
// grammar of css-tree, and that every variable that is read is set. Ends with
// 77, the status of a skipped test, where these are missing.

const fs = require('fs');
const path = require('path');

const kSkipped = 77;
let Linter;
let csstree;
try {
  ({Linter} = require('eslint'));
  csstree = require('css-tree');
} catch (error) {
  console.log('skipped: eslint or node-css-tree is not installed ' +
              '(./setup.sh tests)');
  process.exit(kSkipped);
}

const kConfig = {
  parserOptions: {ecmaVersion: 2019},
  env: {browser: true, es6: true},
  globals: {Dygraph: 'readonly', DecompressionStream: 'readonly'},
  rules: {
    'array-callback-return': 'error', 'block-scoped-var': 'error',
    'consistent-return': 'error', 'constructor-super': 'error',
    'eqeqeq': 'error', 'for-direction': 'error', 'getter-return': 'error',
    'guard-for-in': 'error', 'max-len': ['error', {code: 80, ignoreUrls: true}],
    'no-caller': 'error', 'no-class-assign': 'error', 'no-cond-assign': 'error',
    'no-const-assign': 'error', 'no-constant-condition': 'error',
    'no-dupe-args': 'error', 'no-dupe-class-members': 'error',
    'no-dupe-keys': 'error',
    'no-duplicate-case': 'error', 'no-empty': 'error', 'no-eval': 'error',
    'no-ex-assign': 'error', 'no-extra-bind': 'error', 'no-extra-semi': 'error',
    'no-fallthrough': 'error', 'no-func-assign': 'error',
    'no-implied-eval': 'error', 'no-inner-declarations': 'error',
    'no-irregular-whitespace': 'error',
    'no-multi-spaces': 'error', 'no-new-wrappers': 'error',
    'no-redeclare': 'error', 'no-self-assign': 'error',
    'no-self-compare': 'error', 'no-shadow-restricted-names': 'error',
    'no-sparse-arrays': 'error', 'no-tabs': 'error',
    'no-this-before-super': 'error', 'no-throw-literal': 'error',
    'no-trailing-spaces': 'error', 'no-undef': 'error',
    'no-unexpected-multiline': 'error', 'no-unreachable': 'error',
    'no-unsafe-finally': 'error', 'no-unsafe-negation': 'error',
    'no-unused-expressions': 'error',
    'no-unused-vars': ['error', {args: 'none'}],
    'no-useless-concat': 'error', 'no-useless-return': 'error',
    'no-var': 'error', 'prefer-const': 'error', 'semi': 'error',
    'quotes': ['error', 'single', {avoidEscape: true}],
    'use-isnan': 'error', 'valid-typeof': 'error', 'wrap-iife': 'error',
  },
};

const folder = process.argv[2];
let problems = 0;

function complain(file, line, text) {
  problems++;
  console.log(`${path.join(folder, file)}:${line}: ${text}`);
}

function filesOf(extension) {
  return fs.readdirSync(folder).filter((name) => name.endsWith(extension))
      .sort();
}

function lintScripts() {
  const origin = [];
  const lines = [];
  for (const file of filesOf('.js')) {
    fs.readFileSync(path.join(folder, file), 'utf8').split('\n')
        .forEach((line, i) => {
          origin.push([file, i + 1]);
          // One directive serves all.
          lines.push(lines.length > 0 && line === "'use strict';" ? '' : line);
        });
  }
  const messages = new Linter().verify(lines.join('\n'), kConfig);
  for (const message of messages) {
    const [file, line] = origin[message.line - 1] || ['', 0];
    complain(file, line, `${message.message} (${message.ruleId})`);
  }
  return origin.length;
}

function lintStyles() {
  const set = new Set();
  const used = [];
  for (const file of filesOf('.css')) {
    const tree = csstree.parse(fs.readFileSync(path.join(folder, file), 'utf8'),
        {
          positions: true,
          onParseError: (error) => complain(file, error.line, error.message),
        });
    csstree.walk(tree, (node) => {
      if (node.type === 'Function' && node.name === 'var') {
        used.push([file, node.loc.start.line, node.children.first.name]);
      }
      if (node.type !== 'Declaration') return;
      if (node.property.startsWith('--')) {
        set.add(node.property);
        return;
      }
      const match = csstree.lexer.matchProperty(node.property, node.value);
      // The grammar knows no variables and none of these functions.
      const beyond = /(var|min|max|clamp)\(/;
      if (match.error && !beyond.test(csstree.generate(node.value))) {
        complain(file, node.loc.start.line,
                 node.property + ': ' + match.error.message.split('\n')[0]);
      }
    });
  }
  set.add('--own');  // by the scripts, for each element
  for (const [file, line, name] of used) {
    if (!set.has(name)) complain(file, line, name + ' is nowhere set');
  }
}

const count = lintScripts();
lintStyles();
console.log(`${count} lines of scripts, ${problems} problems`);
process.exit(problems === 0 ? 0 : 1);
