// Tokenizes scripts by the TextMate grammar, as Visual Studio Code does.
//
//   node tokens.js GRAMMAR all FILE ...      writes each token without a scope of its own, FILE:LINE: TEXT
//   node tokens.js GRAMMAR scopes < SCRIPT   writes each token of a script: its text, a tab, its innermost scopes
const fs = require('fs');
const path = require('path');
const oniguruma = require('vscode-oniguruma');
const textmate = require('vscode-textmate');

async function loadGrammar(file) {
  const wasm = path.join(path.dirname(require.resolve('vscode-oniguruma/package.json')), 'release/onig.wasm');
  await oniguruma.loadWASM(fs.readFileSync(wasm).buffer);
  const registry = new textmate.Registry({
    onigLib: Promise.resolve({
      createOnigScanner: (patterns) => new oniguruma.OnigScanner(patterns),
      createOnigString: (text) => new oniguruma.OnigString(text),
    }),
    loadGrammar: async () => textmate.parseRawGrammar(fs.readFileSync(file, 'utf8'), file),
  });
  return registry.loadGrammar('source.cag');
}

function tokenize(grammar, text, take) {
  let stack = textmate.INITIAL;
  text.split('\n').forEach((line, i) => {
    const result = grammar.tokenizeLine(line, stack);
    stack = result.ruleStack;
    for (const t of result.tokens) take(line.slice(t.startIndex, t.endIndex), t.scopes, i + 1);
  });
  return stack;
}

// The scopes of brackets and interpolations do not describe their contents.
const own = (scopes) => scopes.filter((s) => s !== 'source.cag' && !s.startsWith('meta.'));

async function main() {
  const [grammarFile, mode, ...files] = process.argv.slice(2);
  const grammar = await loadGrammar(grammarFile);
  if (mode === 'scopes') {
    tokenize(grammar, fs.readFileSync(0, 'utf8'), (text, scopes) => {
      if (text.trim()) console.log(text.trim() + '\t' + own(scopes).join(' '));
    });
    return;
  }
  let tokens = 0;
  for (const file of files) {
    const end = tokenize(grammar, fs.readFileSync(file, 'utf8'), (text, scopes, line) => {
      if (!text.trim()) return;
      tokens++;
      const bad = scopes.find((s) => s.startsWith('invalid.'));
      if (bad || own(scopes).length === 0) console.log(`${file}:${line}: ${text} (${scopes.join(' ')})`);
    });
    if (end.depth > 1) console.log(`${file}: something is still open at the end`);
  }
  console.error(`${tokens} tokens`);
}

main();
