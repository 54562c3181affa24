// The numbers of a point in the script: what they become when the point is dragged.

/**
 * @typedef {import("./engine.js").PointInfo} PointInfo
 * @typedef {import("./engine.js").PointNumber} PointNumber
 * @typedef {{ right: number[], up: number[], back: number[] }} Axes  unit vectors of the picture, as seen at the point
 */

// What a difference along the line of sight counts. It decides only where the picture leaves a choice.
const DEPTH = 1e-3;
// What is added to the diagonal of the normal equations, as a part of their trace.
const DAMPING = 1e-12;

/** @param {number[]} a @param {number[]} b */
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/**
 * How the point moves in the scene when a coordinate grows by 1 mm.
 *
 * @param {PointInfo} point
 * @param {number} k
 */
export const columnOf = ({ map }, k) => [map[k], map[4 + k], map[8 + k]];

/** Solves a x = b for a positive definite matrix, by elimination. @param {number[][]} a @param {number[]} b */
function solve(a, b) {
  const n = b.length, rows = a.map((row, i) => [...row, b[i]]);
  for (let i = 0; i < n; i++)
    for (let j = i + 1; j < n; j++) {
      const factor = rows[j][i] / rows[i][i];
      for (let k = i; k <= n; k++) rows[j][k] -= factor * rows[i][k];
    }
  const x = new Array(n).fill(0);
  for (let i = n - 1; i >= 0; i--) {
    x[i] = rows[i][n];
    for (let k = i + 1; k < n; k++) x[i] -= rows[i][k] * x[k];
    x[i] /= rows[i][i];
  }
  return x;
}

/**
 * By how many mm the coordinates change that stand as numbers or that params move, so that the point comes as close to a target as the picture
 * shows: least squares, in which depth counts little. Other coordinates get 0.
 *
 * @param {PointInfo} point
 * @param {number[]} shift  from the point to the target, in the scene
 * @param {Axes} axes
 * @returns {number[]}
 */
export function moveCoordinates(point, shift, { right, up, back }) {
  const free = point.numbers.flatMap((n, k) => (n || point.moved[k] ? [k] : []));
  const seen = (/** @type {number[]} */ v) => [dot(v, right), dot(v, up), DEPTH * dot(v, back)];
  const columns = free.map((k) => seen(columnOf(point, k))), wanted = seen(shift);
  const trace = columns.reduce((sum, c) => sum + dot(c, c), 0);
  const moves = point.numbers.map(() => 0);
  if (!(trace > 0)) return moves;
  const normal = columns.map((a, i) => columns.map((b, j) => dot(a, b) + (i === j ? DAMPING * trace : 0)));
  const x = solve(normal, columns.map((c) => dot(c, wanted)));
  free.forEach((k, i) => (moves[k] = x[i]));
  return moves;
}

/**
 * A length rounded to a power of ten below a pixel, in its unit, with the unit.
 *
 * @param {number} mm
 * @param {{ unit: string, scale: number }} number
 * @param {number} pixel  the size of a pixel in this coordinate, mm
 */
export function numberText(mm, { unit, scale }, pixel) {
  const power = Math.max(-12, Math.ceil(Math.log10(pixel / scale) - 1e-9) - 1);
  const value = mm / scale;
  const rounded = power >= 0 ? Math.round(value / 10 ** power) * 10 ** power : Number(value.toFixed(-power));
  // Numbers with an exponent are legal, but nobody writes them so.
  const text = Math.abs(rounded) >= 1e21 ? String(rounded) : rounded.toFixed(Math.max(0, -power));
  const short = text.includes(".") ? text.replace(/\.?0+$/, "") : text;
  return (short === "-0" ? "0" : short) + unit;
}

/**
 * The mm of a number as it stands in a script, with its sign and unit; null: it is none with this unit.
 *
 * @param {string} text
 * @param {{ unit: string, scale: number }} number
 */
export function readNumber(text, { unit, scale }) {
  const found = /^(-?) *(\d[\d_]*(?:\.[\d_]+)?(?:[eE][-+]?\d+)?)([a-z]*)$/.exec(text);
  if (!found || found[3] !== unit) return null;
  return Number(found[1] + found[2].replaceAll("_", "")) * scale;
}
