// Scales of colors for values on surfaces, as cag's pictures have them (interp/scene/color_scale.c).

/** @typedef {[number, number, number]} Rgb  linear light */

/** @typedef {object} Scale
 * @property {number} low
 * @property {number} high
 * @property {boolean} diverging  blue, white, red; else dark to bright
 */

// sRGB, evenly spaced: viridis (Smith and van der Walt, 2015), and Moreland's cool-to-warm (2009).
const SEQUENCE = rows(["440154", "482475", "414487", "355f8d", "2a788e", "21918c", "22a884", "44bf70", "7ad151", "bddf26", "fde725"]);
const DIVERGING = rows(["3b4cc0", "5977e3", "7b9ff9", "9ebeff", "c0d4f5", "dddcdc", "f2cbb7", "f7ac8e", "ee8468", "d65244", "b40426"]);
/** Of a value that is unknown. @type {Rgb} */
const UNKNOWN = [0.5, 0.5, 0.5];

/** @param {string[]} texts @returns {Rgb[]} */
function rows(texts) {
  return texts.map((t) => /** @type {Rgb} */ ([0, 2, 4].map((k) => parseInt(t.slice(k, k + 2), 16) / 255)));
}

/** @param {number} x  0..1 */
const linear = (x) => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);

/** The color of a fraction of the scale, sRGB. @param {number} fraction @param {boolean} diverging @returns {Rgb} */
function colorAt(fraction, diverging) {
  const stops = diverging ? DIVERGING : SEQUENCE, at = Math.min(1, Math.max(0, fraction)) * (stops.length - 1);
  const k = Math.min(stops.length - 2, Math.floor(at)), rest = at - k;
  return /** @type {Rgb} */ (stops[k].map((x, i) => x + (stops[k + 1][i] - x) * rest));
}

/** @param {Scale} scale @param {number} value @returns {Rgb} */
export function colorOf({ low, high, diverging }, value) {
  if (Number.isNaN(value)) return /** @type {Rgb} */ (UNKNOWN.map(linear));
  return /** @type {Rgb} */ (colorAt(high > low ? (value - low) / (high - low) : 0.5, diverging).map(linear));
}

/** The scale as a CSS gradient from low to high. @param {boolean} diverging */
export function gradient(diverging) {
  const stops = Array.from({ length: 9 }, (_, i) => `rgb(${colorAt(i / 8, diverging).map((x) => Math.round(255 * x)).join(" ")})`);
  return `linear-gradient(to right, ${stops.join(", ")})`;
}

const RARE = 0.02; // fraction of the values beyond each end of the scale
const MOST_SAMPLES = 20000;

/**
 * The scale of some values without rare extremes. If both signs occur, it is symmetric about 0.
 *
 * @param {Float32Array[]} lists
 * @param {number} [percent]  of the weight that is within
 * @param {Float32Array[]} [weights]  of the values, such as the areas that have them; else all count alike
 * @returns {Scale}
 */
export function scaleOf(lists, percent = 100 * (1 - 2 * RARE), weights) {
  const total = lists.reduce((n, l) => n + l.length, 0), step = Math.max(1, Math.floor(total / MOST_SAMPLES));
  /** @type {{ value: number, weight: number }[]} */
  const sample = [];
  lists.forEach((list, k) => {
    for (let i = 0; i < list.length; i += step) if (Number.isFinite(list[i])) sample.push({ value: list[i], weight: weights ? weights[k][i] : 1 });
  });
  if (sample.length === 0) return { low: 0, high: 1, diverging: false };
  sample.sort((a, b) => a.value - b.value);
  const out = (1 - percent / 100) / 2, low = quantile(sample, out), high = quantile(sample, 1 - out), size = Math.max(Math.abs(low), Math.abs(high));
  // What rounding leaves of a zero has no sign.
  const tiny = 1e-6 * size;
  if (low < -tiny && high > tiny) return { low: -size, high: size, diverging: true };
  return { low, high, diverging: false };
}

/** The value below which a part of the weight is. @param {{ value: number, weight: number }[]} sample  sorted @param {number} part */
function quantile(sample, part) {
  const wanted = part * sample.reduce((sum, { weight }) => sum + weight, 0);
  let sum = 0;
  for (const { value, weight } of sample) {
    sum += weight;
    if (sum > wanted) return value;
  }
  return sample[sample.length - 1].value;
}
