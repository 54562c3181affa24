// Lines and columns of the engine, and edits of scripts that the page makes.

/**
 * The offset of a line and column in a text. The engine counts columns in code points, and JavaScript in UTF-16 units.
 *
 * @param {string} text
 * @param {number} line  from 1
 * @param {number} column  from 1
 */
export function offsetOf(text, line, column) {
  let start = 0;
  for (let i = 1; i < line; i++) {
    const end = text.indexOf("\n", start);
    if (end < 0) return text.length;
    start = end + 1;
  }
  let at = start;
  for (let i = 1; i < column && at < text.length && text[at] !== "\n"; i++) at += (text.codePointAt(at) ?? 0) > 0xffff ? 2 : 1;
  return at;
}

/** @param {string} text @param {import("./engine.js").Place} place @returns {[number, number]} */
export function rangeOf(text, place) {
  const from = offsetOf(text, place.line, place.column);
  return [from, Math.max(from, offsetOf(text, place.endLine, place.endColumn))];
}

/** Whether this is the name of a module of the library, which can be read only. @param {string} path */
export const isModule = (path) => /^std\.\w+$/.test(path);

const CLOSING = { "(": ")", "[": "]", "{": "}" };

/** The end of a text in quotes that begins at `i`; expressions in braces can contain quotes. @param {string} text @param {number} i */
function endOfText(text, i) {
  let depth = 0;
  for (i++; i < text.length && text[i] !== "\n"; i++) {
    if (text[i] === "\\") i++;
    else if (text[i] === "{") depth++;
    else if (text[i] === "}") depth--;
    else if (text[i] === '"' && depth <= 0) return i + 1;
    else if (text[i] === '"') i = endOfText(text, i) - 1;
  }
  return i;
}

/**
 * Where the value of a param stands in a script: what follows `param NAME =`, up to ` in `, the description, a comment, or the end of the line.
 *
 * @param {string} text
 * @param {string} name
 * @returns {[number, number] | null}
 */
export function paramValueRange(text, name) {
  const begin = new RegExp(`^[ \\t]*param[ \\t]+${name}[ \\t]*=[ \\t]*`, "mu").exec(text);
  if (!begin) return null;
  const from = begin.index + begin[0].length;
  /** @type {string[]} */
  const open = [];
  let i = from, end = from;
  while (i < text.length) {
    const c = text[i], rest = text.slice(i, i + 4);
    if (open.length === 0 && i > from && (c === "\n" || c === ";" || c === '"' || /^in[\s[]/.test(rest) && /\s/.test(text[i - 1]))) break;
    if (rest.startsWith("//") || rest.startsWith("/*")) break;
    if (c === '"') i = endOfText(text, i);
    else {
      if (c in CLOSING) open.push(CLOSING[/** @type {keyof typeof CLOSING} */ (c)]);
      else if (c === open[open.length - 1]) open.pop();
      i++;
    }
    if (!/\s/.test(c)) end = i;
  }
  return end > from ? [from, end] : null;
}

/**
 * The text of the expression that a `show` shows.
 *
 * @param {string} text  of the statement
 */
export const shownExpression = (text) => text.replace(/^show\s+/, "").trim();

/** @typedef {{ kind: " " | "-" | "+", text: string }} DiffLine */

const MOST_CELLS = 4e6; // of the table below

/**
 * The lines of two texts side by side, as a longest common subsequence.
 *
 * @param {string} before
 * @param {string} after
 * @returns {DiffLine[]}
 */
export function diffLines(before, after) {
  const a = before.split("\n"), b = after.split("\n");
  let head = 0, tail = 0;
  while (head < a.length && head < b.length && a[head] === b[head]) head++;
  while (tail < a.length - head && tail < b.length - head && a[a.length - 1 - tail] === b[b.length - 1 - tail]) tail++;
  const x = a.slice(head, a.length - tail), y = b.slice(head, b.length - tail);
  const same = (/** @type {string[]} */ lines) => lines.map((text) => /** @type {DiffLine} */ ({ kind: " ", text }));
  return [...same(a.slice(0, head)), ...diffMiddle(x, y), ...same(a.slice(a.length - tail))];
}

/** @param {string[]} x @param {string[]} y @returns {DiffLine[]} */
function diffMiddle(x, y) {
  const removed = (/** @type {string} */ text) => /** @type {DiffLine} */ ({ kind: "-", text });
  const added = (/** @type {string} */ text) => /** @type {DiffLine} */ ({ kind: "+", text });
  if (x.length * y.length > MOST_CELLS) return [...x.map(removed), ...y.map(added)];
  const width = y.length + 1, common = new Uint32Array((x.length + 1) * width);
  for (let i = x.length - 1; i >= 0; i--)
    for (let j = y.length - 1; j >= 0; j--)
      common[i * width + j] = x[i] === y[j] ? common[(i + 1) * width + j + 1] + 1 : Math.max(common[(i + 1) * width + j], common[i * width + j + 1]);
  /** @type {DiffLine[]} */
  const lines = [];
  let i = 0, j = 0;
  while (i < x.length || j < y.length) {
    if (i < x.length && j < y.length && x[i] === y[j]) lines.push({ kind: " ", text: x[i++] }), j++;
    else if (j >= y.length || (i < x.length && common[(i + 1) * width + j] >= common[i * width + j + 1])) lines.push(removed(x[i++]));
    else lines.push(added(y[j++]));
  }
  return lines;
}
