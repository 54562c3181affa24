// Whether a mesh is closed: each edge has as many triangles in one direction as in the other.

const buffer = new ArrayBuffer(4), asFloat = new Float32Array(buffer), asInt = new Int32Array(buffer);

/** @param {Float32Array} p @param {number} v */
function hashOf(p, v) {
  let h = 0x9e3779b9 | 0;
  for (let k = 0; k < 3; k++) {
    asFloat[0] = p[3 * v + k] + 0; // -0 becomes 0
    h = mix(h ^ asInt[0]);
  }
  return h;
}

/** The finalizer of MurmurHash3 (Appleby 2011). @param {number} h */
function mix(h) {
  h = Math.imul(h ^ (h >>> 16), 0x85ebca6b);
  h = Math.imul(h ^ (h >>> 13), 0xc2b2ae35);
  return h ^ (h >>> 16);
}

/**
 * Compares the directed edges with their opposites by sums of hashes, so that no table is needed. Vertices at one place count as one.
 *
 * @param {Float32Array} positions
 * @param {Uint32Array} triangles
 */
export function isClosed(positions, triangles) {
  const hashes = Int32Array.from({ length: positions.length / 3 }, (_, v) => hashOf(positions, v));
  let sum = 0;
  for (let t = 0; t < triangles.length; t += 3)
    for (let k = 0; k < 3; k++) {
      const a = hashes[triangles[t + k]], b = hashes[triangles[t + ((k + 1) % 3)]];
      if (a !== b) sum = (sum + mix(Math.imul(a, 31) ^ mix(b)) - mix(Math.imul(b, 31) ^ mix(a))) | 0;
    }
  return triangles.length > 0 && sum === 0;
}
