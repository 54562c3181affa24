// Numbers as texts.

/**
 * Writes a number with a number of significant digits, without trailing zeros or an exponent where it is readable.
 *
 * @param {number} x
 * @param {number} [digits]
 */
export function formatNumber(x, digits = 5) {
  if (!Number.isFinite(x)) return String(x);
  if (x === 0) return "0";
  const rounded = Number(x.toPrecision(digits));
  const size = Math.abs(rounded);
  return size >= 1e-4 && size < 1e12 ? String(rounded) : rounded.toExponential();
}

/** @param {ArrayLike<number>} p */
export const formatPoint = (p) => `[${Array.from(p, (x) => formatNumber(cleanZero(x))).join(", ")}]`;

/** Values that rounding of single precision leaves of a zero count as zero. @param {number} x */
const cleanZero = (x) => (Math.abs(x) < 1e-6 ? 0 : x);

/** @param {number} bytes */
export function formatMemory(bytes) {
  if (bytes < 1e6) return `${Math.max(1, Math.round(bytes / 1e3))} KB`;
  return bytes < 1e9 ? `${formatNumber(bytes / 1e6, 3)} MB` : `${formatNumber(bytes / 1e9, 3)} GB`;
}

/** @param {number} seconds */
export function formatSeconds(seconds) {
  return seconds < 1 ? `${formatNumber(seconds * 1000, 2)} ms` : `${formatNumber(seconds, 3)} s`;
}

/**
 * The size of a box: 30 × 20 × 10 mm.
 *
 * @param {readonly [number[], number[]]} bounds
 */
export function formatSize([low, high]) {
  return low.map((x, i) => formatNumber(cleanZero(high[i] - x), 4)).join(" × ") + " mm";
}
