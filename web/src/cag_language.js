// The words of cag, for colors in the editor. The lexer is lang/lexer.c.

import { HighlightStyle, LanguageSupport, StreamLanguage, syntaxHighlighting } from "@codemirror/language";
import { tags } from "@lezer/highlight";

const KEYWORDS = new Set(["and", "as", "assert", "by", "else", "false", "for", "if", "import", "in", "none", "not", "or", "param", "print", "show", "then", "true"]);
const ATOMS = new Set(["true", "false", "none"]);
const CONSTANTS = new Set(["X", "Y", "Z", "frame", "frames", "identity", "inf", "origin", "pi", "tau", "time"]);

const NAME = /^[\p{L}_][\p{L}\p{M}\p{N}_]*/u;
const NUMBER = /^\d[\d_]*(\.\d[\d_]*)?([eE][-+]?\d[\d_]*)?(deg|rad|turn|mm|cm|um|m|in|ft)?(?![\p{L}_])/u;

/**
 * @typedef {object} State
 * @property {number} comment  depth of nested comments
 * @property {("text" | "raw" | "braces" | "expression")[]} inside  from outer to inner
 * @property {boolean} dot  a `.` precedes
 * @property {boolean} start  of a line
 * @property {string} before  the keyword before
 */

/** @param {import("@codemirror/language").StringStream} stream @param {State} state */
function readComment(stream, state) {
  while (!stream.eol()) {
    if (stream.match("/*")) state.comment++;
    else if (stream.match("*/")) {
      if (--state.comment === 0) break;
    } else stream.next();
  }
  return "comment";
}

/** @param {import("@codemirror/language").StringStream} stream @param {State} state */
function readText(stream, state) {
  if (stream.match("{")) {
    state.inside.push("expression");
    return "brace";
  }
  if (stream.match(/^\\(u\{[0-9a-fA-F]{1,6}\}|.)/)) return "escape";
  if (stream.match('"')) {
    state.inside.pop();
    return "string";
  }
  stream.match(/^[^"\\{]+/);
  // A text ends on its line, whatever it says.
  if (stream.eol()) state.inside.pop();
  return "string";
}

/** @param {import("@codemirror/language").StringStream} stream @param {State} state */
function readWord(stream, state) {
  const word = stream.current(), { dot, start, before } = state;
  if (dot) return "propertyName";
  if (stream.match(/^\s*:(?!=)/, false) && !start && !KEYWORDS.has(word)) return "propertyName";
  if (KEYWORDS.has(word)) {
    state.before = word;
    return ATOMS.has(word) ? "atom" : "keyword";
  }
  if (before === "param" || (start && stream.match(/^\s*(\([^()]*(\([^()]*\)[^()]*)*\))?\s*=(?![=>])/, false))) return "definition";
  if (before === "import" || before === "as") {
    if (before === "as") state.before = "";
    return "namespace";
  }
  if (stream.match("(", false)) return "function";
  return CONSTANTS.has(word) ? "constant" : "variableName";
}

/** @param {import("@codemirror/language").StringStream} stream @param {State} state @returns {string | null} */
function readToken(stream, state) {
  if (stream.sol()) {
    state.start = true;
    state.before = "";
  }
  if (state.comment > 0) return readComment(stream, state);
  const inside = state.inside[state.inside.length - 1];
  if (inside === "text") return readText(stream, state);
  if (inside === "raw") {
    if (stream.match(/^[^`]*`/)) state.inside.pop();
    else stream.skipToEnd();
    return "string";
  }
  if (stream.eatSpace()) return null;
  if (stream.match("///")) return stream.skipToEnd(), "documentation";
  if (stream.match("//")) return stream.skipToEnd(), "comment";
  if (stream.match("/*")) {
    state.comment = 1;
    return readComment(stream, state);
  }
  const { start } = state;
  if (stream.match(NAME)) {
    const kind = readWord(stream, state);
    state.dot = state.start = false;
    if (kind !== "keyword" && kind !== "namespace") state.before = "";
    return kind;
  }
  const dotted = stream.match(/^\.(?!\.)/);
  state.dot = dotted !== null && dotted !== false;
  state.start = false;
  if (state.dot) return "punctuation";
  if (stream.match(NUMBER)) return "number";
  if (stream.match('"')) {
    state.inside.push("text");
    return "string";
  }
  if (stream.match("`")) {
    state.inside.push("raw");
    return "string";
  }
  if (stream.match("{")) {
    state.inside.push("braces");
    state.start = true;
    return "punctuation";
  }
  if (stream.match("}")) {
    const closed = state.inside.pop();
    return closed === "expression" ? "brace" : "punctuation";
  }
  if (stream.match(/^(\|>|=>|[=!<>]=|\.\.\.|\.\.<|\.\.|[-+*/%^<>|&!?=])/)) return "operator";
  state.start = start && stream.peek() === ";";
  stream.next();
  return "punctuation";
}

const cagParser = StreamLanguage.define({
  name: "cag",
  startState: () => /** @type {State} */ ({ comment: 0, inside: [], dot: false, start: true, before: "" }),
  copyState: (state) => ({ ...state, inside: [...state.inside] }),
  token: readToken,
  blankLine: (state) => {
    if (state.inside[state.inside.length - 1] === "text") state.inside.pop();
  },
  languageData: { commentTokens: { line: "//", block: { open: "/*", close: "*/" } }, closeBrackets: { brackets: ["(", "[", "{", '"'] } },
  tokenTable: {
    definition: tags.definition(tags.variableName), documentation: tags.docComment, escape: tags.escape, brace: tags.brace,
    function: tags.function(tags.variableName), constant: tags.constant(tags.variableName), namespace: tags.namespace,
  },
});

const style = HighlightStyle.define([
  { tag: tags.comment, color: "var(--code-comment)" },
  { tag: tags.docComment, color: "var(--code-comment)", fontStyle: "italic" },
  { tag: tags.keyword, color: "var(--code-keyword)" },
  { tag: [tags.atom, tags.number, tags.constant(tags.variableName)], color: "var(--code-number)" },
  { tag: tags.string, color: "var(--code-text)" },
  { tag: [tags.escape, tags.brace], color: "var(--code-keyword)" },
  { tag: tags.definition(tags.variableName), color: "var(--code-definition)" },
  { tag: tags.function(tags.variableName), color: "var(--code-function)" },
  { tag: tags.namespace, color: "var(--code-definition)" },
  { tag: tags.propertyName, color: "var(--code-member)" },
]);

export const cagLanguage = cagParser;
export const cag = () => new LanguageSupport(cagParser, [syntaxHighlighting(style)]);
