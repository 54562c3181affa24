// A hierarchy of boxes over the triangles of a mesh, to find where a ray meets it.
//
// Triangles are ordered along a Morton curve through their centers (Morton 1966; Lauterbach et al. 2009) and cut into leaves of equal size. The
// leaves are those of a complete binary tree, so that nodes need no pointers: the children of node i are 2i + 1 and 2i + 2. A mesh of a million
// triangles is ready in a fraction of a second.

const LEAF = 8; // triangles
const BITS = 10; // of a Morton code, for each axis

/** Spreads the lowest 10 bits to every third. @param {number} x */
function spread(x) {
  x = (x | (x << 16)) & 0x030000ff;
  x = (x | (x << 8)) & 0x0300f00f;
  x = (x | (x << 4)) & 0x030c30c3;
  return (x | (x << 2)) & 0x09249249;
}

export class Bvh {
  /** @param {Float32Array} positions @param {Uint32Array} triangles */
  constructor(positions, triangles) {
    this.positions = positions;
    this.triangles = triangles;
    const count = triangles.length / 3;
    this.order = mortonOrder(positions, triangles);
    let leaves = 1;
    while (leaves * LEAF < count) leaves *= 2;
    this.first = leaves - 1; // node of the first leaf
    this.boxes = new Float32Array((2 * leaves - 1) * 6);
    for (let leaf = 0; leaf < leaves; leaf++) this.fillLeaf(leaf);
    for (let node = this.first - 1; node >= 0; node--) this.join(node);
  }

  /** @param {number} leaf */
  fillLeaf(leaf) {
    const { positions, triangles, order, boxes } = this;
    const at = (this.first + leaf) * 6;
    for (let k = 0; k < 3; k++) {
      boxes[at + k] = Infinity;
      boxes[at + 3 + k] = -Infinity;
    }
    const end = Math.min(order.length, (leaf + 1) * LEAF);
    for (let i = leaf * LEAF; i < end; i++)
      for (let corner = 0; corner < 3; corner++) {
        const p = triangles[order[i] * 3 + corner] * 3;
        for (let k = 0; k < 3; k++) {
          const x = positions[p + k];
          if (x < boxes[at + k]) boxes[at + k] = x;
          if (x > boxes[at + 3 + k]) boxes[at + 3 + k] = x;
        }
      }
  }

  /** @param {number} node */
  join(node) {
    const { boxes } = this, a = (2 * node + 1) * 6, b = a + 6, at = node * 6;
    for (let k = 0; k < 3; k++) {
      boxes[at + k] = Math.min(boxes[a + k], boxes[b + k]);
      boxes[at + 3 + k] = Math.max(boxes[a + 3 + k], boxes[b + 3 + k]);
    }
  }

  /**
   * Finds the first triangle that a ray meets, from either side.
   *
   * @param {ArrayLike<number>} origin
   * @param {ArrayLike<number>} direction
   * @param {(t: number) => boolean} [accept]  whether a hit counts; a clipped one does not
   * @returns {{ t: number, triangle: number } | null}  t in units of the direction
   */
  cast(origin, direction, accept) {
    const inverse = [1 / direction[0], 1 / direction[1], 1 / direction[2]];
    const stack = [0];
    let best = Infinity, triangle = -1;
    while (stack.length) {
      const node = /** @type {number} */ (stack.pop());
      if (this.enters(node, origin, inverse) >= best) continue;
      if (node < this.first) {
        const a = this.enters(2 * node + 1, origin, inverse), b = this.enters(2 * node + 2, origin, inverse);
        // The nearer child is searched first.
        const near = a <= b ? 2 * node + 1 : 2 * node + 2;
        if (Math.max(a, b) < best) stack.push(4 * node + 3 - near);
        if (Math.min(a, b) < best) stack.push(near);
        continue;
      }
      const leaf = node - this.first, end = Math.min(this.order.length, (leaf + 1) * LEAF);
      for (let i = leaf * LEAF; i < end; i++) {
        const t = this.meets(this.order[i], origin, direction);
        if (t < best && (!accept || accept(t))) {
          best = t;
          triangle = this.order[i];
        }
      }
    }
    return triangle < 0 ? null : { t: best, triangle };
  }

  /** The t at which a ray enters a node's box; Infinity: it misses. @param {number} node @param {ArrayLike<number>} origin @param {number[]} inverse */
  enters(node, origin, inverse) {
    const { boxes } = this, at = node * 6;
    let from = 0, to = Infinity;
    for (let k = 0; k < 3; k++) {
      const a = (boxes[at + k] - origin[k]) * inverse[k], b = (boxes[at + 3 + k] - origin[k]) * inverse[k];
      // A comparison with NaN, of a ray within the plane of a side, is false and leaves the range as it is.
      const near = a < b ? a : b, far = a < b ? b : a;
      if (near > from) from = near;
      if (far < to) to = far;
    }
    return from <= to ? from : Infinity;
  }

  /** Möller and Trumbore (1997). @param {number} triangle @param {ArrayLike<number>} o @param {ArrayLike<number>} d */
  meets(triangle, o, d) {
    const { positions: p, triangles: index } = this;
    const a = index[triangle * 3] * 3, b = index[triangle * 3 + 1] * 3, c = index[triangle * 3 + 2] * 3;
    const e1x = p[b] - p[a], e1y = p[b + 1] - p[a + 1], e1z = p[b + 2] - p[a + 2];
    const e2x = p[c] - p[a], e2y = p[c + 1] - p[a + 1], e2z = p[c + 2] - p[a + 2];
    const hx = d[1] * e2z - d[2] * e2y, hy = d[2] * e2x - d[0] * e2z, hz = d[0] * e2y - d[1] * e2x;
    const det = e1x * hx + e1y * hy + e1z * hz;
    if (det === 0) return Infinity;
    const sx = o[0] - p[a], sy = o[1] - p[a + 1], sz = o[2] - p[a + 2];
    const u = (sx * hx + sy * hy + sz * hz) / det;
    if (u < 0 || u > 1) return Infinity;
    const qx = sy * e1z - sz * e1y, qy = sz * e1x - sx * e1z, qz = sx * e1y - sy * e1x;
    const v = (d[0] * qx + d[1] * qy + d[2] * qz) / det;
    if (v < 0 || u + v > 1) return Infinity;
    const t = (e2x * qx + e2y * qy + e2z * qz) / det;
    return t > 0 ? t : Infinity;
  }
}

/** @param {Float32Array} positions @param {Uint32Array} triangles @returns {Uint32Array} */
function mortonOrder(positions, triangles) {
  const count = triangles.length / 3, low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < positions.length; i++) {
    const x = positions[i];
    if (x < low[i % 3]) low[i % 3] = x;
    if (x > high[i % 3]) high[i % 3] = x;
  }
  const scale = low.map((x, k) => (high[k] > x ? (2 ** BITS - 1) / (high[k] - x) / 3 : 0));
  // A code and the number of its triangle fit into the 53 bits of a number.
  const keys = new Float64Array(count), most = 2 ** 23;
  for (let i = 0; i < count; i++) {
    let code = 0;
    for (let k = 0; k < 3; k++) {
      const sum = positions[triangles[3 * i] * 3 + k] + positions[triangles[3 * i + 1] * 3 + k] + positions[triangles[3 * i + 2] * 3 + k];
      code |= spread((sum - 3 * low[k]) * scale[k]) << k;
    }
    keys[i] = code * most + (i % most);
  }
  // Beyond 2^23 triangles, the number does not fit: triangles keep their order, which is local as well.
  if (count > most) return Uint32Array.from({ length: count }, (_, i) => i);
  keys.sort();
  return Uint32Array.from(keys, (key) => key % most);
}
