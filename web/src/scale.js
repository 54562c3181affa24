// Round lengths, for the grid, the scale, and the steps of sliders.

const STEPS = [1, 2, 5];
const SCALE_PIXELS = 130; // the longest that the scale can be

/** The least number of the form 1, 2, or 5 times a power of ten that is not below x. @param {number} x */
export function roundUp(x) {
  const power = 10 ** Math.floor(Math.log10(x));
  for (const step of STEPS) if (step * power >= x * (1 - 1e-9)) return step * power;
  return 10 * power;
}

/** The length that the scale shows, mm. @param {number} pixel  its size, mm */
export function scaleLength(pixel) {
  const most = SCALE_PIXELS * pixel * (1 + 1e-9), power = 10 ** Math.floor(Math.log10(most));
  return (most >= 5 * power ? 5 : most >= 2 * power ? 2 : 1) * power;
}
