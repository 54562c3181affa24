// What was picked: the flat face about a triangle, the circle or line about an edge, and what lies between two of them.

/**
 * @typedef {[number, number, number]} Triple
 * @typedef {{ kind: "point", at: Triple }} PointPick
 * @typedef {{ kind: "edge", at: Triple, from: Triple, to: Triple, length: number }} EdgePick  a straight edge
 * @typedef {{ kind: "circle", at: Triple, center: Triple, axis: Triple, radius: number, length: number }} CirclePick  a circle or an arc
 * @typedef {{ kind: "face", at: Triple, normal: Triple, area: number }} FacePick  a plane face
 * @typedef {PointPick | EdgePick | CirclePick | FacePick} Pick
 *
 * @typedef {{ name: string, value: number, unit: string }} Finding
 */

// Meshes have single precision: directions of faces and edges in line differ by less than this.
const ALIGNED = 1e-4;
// A circle fits if points are this close, in radii.
const ROUND = 2e-4;
// Vertices of a mesh are on the true circle, but those that a set operation adds are on its chords. They are inside by at most this, in radii.
const CHORD = 0.03;
const LEAST_POINTS = 5; // three fit any circle
const MOST_TRIALS = 64;

/** @param {Triple} a @param {Triple} b @returns {Triple} */
export const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
/** @param {Triple} a @param {number} k @param {Triple} b @returns {Triple} */
const madd = (a, k, b) => [a[0] + k * b[0], a[1] + k * b[1], a[2] + k * b[2]];
/** @param {Triple} a @param {Triple} b */
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
/** @param {Triple} a @param {Triple} b @returns {Triple} */
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
/** @param {Triple} a */
export const norm = (a) => Math.hypot(...a);
/** @param {Triple} a @returns {Triple} */
export const unit = (a) => {
  const n = norm(a);
  return n > 0 ? [a[0] / n, a[1] / n, a[2] / n] : [0, 0, 0];
};

/** @param {Float32Array} positions @param {number} v @returns {Triple} */
export const vertex = (positions, v) => [positions[3 * v], positions[3 * v + 1], positions[3 * v + 2]];

/** Vertices at one place, which differ in their normals, count as one. @param {Float32Array} p @param {number} v */
const placeKey = (p, v) => `${p[3 * v]},${p[3 * v + 1]},${p[3 * v + 2]}`;

/**
 * The plane face about a triangle: all triangles that are connected with it by edges and lie in its plane.
 *
 * @param {import("./mesh.js").MeshData} mesh
 * @param {number} seed
 * @returns {{ normal: Triple, area: number, triangles: number[] }}
 */
export function flatFace(mesh, seed) {
  const { positions: p, triangles: index } = mesh;
  /** @type {Map<string, number[]>} triangles by edge */
  const byEdge = new Map();
  const normal = unit(areaVector(p, index, seed)), at = vertex(p, index[3 * seed]);
  const size = norm(sub(vertex(p, index[3 * seed + 1]), at)) + norm(sub(vertex(p, index[3 * seed + 2]), at));
  const inPlane = [];
  for (let t = 0; t < index.length / 3; t++) {
    const v = areaVector(p, index, t), away = Math.abs(dot(sub(vertex(p, index[3 * t]), at), normal));
    if (dot(v, normal) < (1 - ALIGNED * ALIGNED * 50) * norm(v) || away > ALIGNED * (size + norm(sub(vertex(p, index[3 * t]), at)))) continue;
    inPlane.push(t);
  }
  const keyOf = (/** @type {number} */ t, /** @type {number} */ k) => {
    const a = placeKey(p, index[3 * t + k]), b = placeKey(p, index[3 * t + ((k + 1) % 3)]);
    return a < b ? `${a};${b}` : `${b};${a}`;
  };
  for (const t of inPlane)
    for (let k = 0; k < 3; k++) {
      const key = keyOf(t, k), list = byEdge.get(key);
      if (list) list.push(t);
      else byEdge.set(key, [t]);
    }
  const found = new Set([seed]), queue = [seed];
  let area = 0;
  for (let t = queue.pop(); t !== undefined; t = queue.pop()) {
    area += norm(areaVector(p, index, t)) / 2;
    for (let k = 0; k < 3; k++)
      for (const other of byEdge.get(keyOf(t, k)) ?? [])
        if (!found.has(other)) {
          found.add(other);
          queue.push(other);
        }
  }
  return { normal, area, triangles: [...found] };
}

/** @param {Float32Array} p @param {Uint32Array} index @param {number} t @returns {Triple} */
function areaVector(p, index, t) {
  const a = vertex(p, index[3 * t]);
  return cross(sub(vertex(p, index[3 * t + 1]), a), sub(vertex(p, index[3 * t + 2]), a));
}

/**
 * The feature edge about a segment: the chain through vertices where two segments meet without a corner.
 *
 * @param {import("./mesh.js").MeshData} mesh
 * @param {number} seed  number of a segment
 * @returns {{ points: Triple[], closed: boolean }}
 */
export function edgeChain(mesh, seed) {
  const { positions: p, edges } = mesh;
  /** @type {Map<string, number[]>} */
  const ends = new Map(), seen = new Set();
  for (let e = 0; e < edges.length / 2; e++) {
    const a = placeKey(p, edges[2 * e]), b = placeKey(p, edges[2 * e + 1]), key = a < b ? `${a};${b}` : `${b};${a}`;
    // Both sides of a crease can have the edge.
    if (seen.has(key) && e !== seed) continue;
    seen.add(key);
    for (const k of [a, b]) {
      const list = ends.get(k);
      if (list) list.push(e);
      else ends.set(k, [e]);
    }
  }
  const used = new Set([seed]);
  /** @param {number} from @param {number} at  vertices */
  const walk = (from, at) => {
    const points = [];
    for (;;) {
      const next = (ends.get(placeKey(p, at)) ?? []).filter((e) => !sameEnds(p, edges, e, from, at));
      if (next.length !== 1 || used.has(next[0])) return points;
      const e = next[0], far = placeKey(p, edges[2 * e]) === placeKey(p, at) ? edges[2 * e + 1] : edges[2 * e];
      const before = unit(sub(vertex(p, at), vertex(p, from))), after = unit(sub(vertex(p, far), vertex(p, at)));
      if (dot(before, after) < 0.5) return points; // a corner of more than 60 degrees
      used.add(e);
      points.push(vertex(p, far));
      [from, at] = [at, far];
    }
  };
  const a = edges[2 * seed], b = edges[2 * seed + 1];
  const forward = walk(a, b), points = [vertex(p, a), vertex(p, b), ...forward];
  const closed = points.length > 3 && norm(sub(points[points.length - 1], points[0])) === 0;
  return { points: closed ? points : [...walk(b, a).reverse(), ...points], closed };
}

/** @param {Float32Array} p @param {Uint32Array} edges @param {number} e @param {number} a @param {number} b */
function sameEnds(p, edges, e, a, b) {
  const x = placeKey(p, edges[2 * e]), y = placeKey(p, edges[2 * e + 1]), u = placeKey(p, a), v = placeKey(p, b);
  return (x === u && y === v) || (x === v && y === u);
}

/** @typedef {{ center: Triple, axis: Triple, radius: number }} Circle */

/**
 * The circle through the points of an edge, if they are on one.
 *
 * @param {Triple[]} points
 * @returns {Circle | null}
 */
export function circleOf(points) {
  if (points.length < LEAST_POINTS) return null;
  // The last point of a closed edge is its first.
  const n = norm(sub(points[points.length - 1], points[0])) === 0 ? points.length - 1 : points.length;
  /** @type {Circle | null} */
  let best = null;
  let most = Math.max(LEAST_POINTS, n / 4) - 1;
  for (let trial = 0; trial < Math.min(n, MOST_TRIALS); trial++) {
    const [a, b, c] = [0, Math.floor(n / 3), Math.floor((2 * n) / 3)].map((k) => points[(trial + k) % n]);
    const circle = circleThrough(a, b, c), count = circle ? pointsOn(circle, points) : 0;
    if (count > most) [best, most] = [circle, count];
  }
  return best;
}

/** @param {Triple} a @param {Triple} b @param {Triple} c @returns {Circle | null} */
function circleThrough(a, b, c) {
  const ab = sub(b, a), ac = sub(c, a), across = cross(ab, ac), square = dot(across, across);
  if (square <= (ALIGNED * norm(ab) * norm(ac)) ** 2) return null;
  const center = madd(a, 1 / (2 * square), madd(scaled(cross(across, ab), dot(ac, ac)), dot(ab, ab), cross(ac, across)));
  return { center, axis: unit(across), radius: norm(sub(a, center)) };
}

/** The number of points on the circle; 0 if one is elsewhere than on it or on its chords. @param {Circle} circle @param {Triple[]} points */
function pointsOn({ center, axis, radius }, points) {
  let count = 0;
  for (const p of points) {
    const d = sub(p, center), beyond = (norm(d) - radius) / radius;
    if (Math.abs(dot(d, axis)) > ROUND * radius || beyond > ROUND || beyond < -CHORD) return 0;
    if (beyond > -ROUND) count++;
  }
  return count;
}

/** @param {Triple} a @param {number} k @returns {Triple} */
const scaled = (a, k) => [a[0] * k, a[1] * k, a[2] * k];

/** @param {Triple[]} points */
export const chainLength = (points) => points.slice(1).reduce((sum, p, i) => sum + norm(sub(p, points[i])), 0);

/** Whether all points are on the line from the first to the last. @param {Triple[]} points */
export function isStraight(points) {
  const a = points[0], along = sub(points[points.length - 1], a), length = norm(along);
  return length > 0 && points.every((p) => norm(cross(sub(p, a), along)) <= ALIGNED * length * length);
}

/** The direction of an edge, the axis of a circle, or the normal of a face. @param {Pick} p @returns {Triple | null} */
function directionOf(p) {
  if (p.kind === "edge") return unit(sub(p.to, p.from));
  if (p.kind === "circle") return p.axis;
  return p.kind === "face" ? p.normal : null;
}

/** The point that stands for a pick. @param {Pick} p @returns {Triple} */
export const anchorOf = (p) => (p.kind === "circle" ? p.center : p.at);

/** What one pick tells. @param {Pick} p @returns {Finding[]} */
export function findingsOfOne(p) {
  if (p.kind === "edge") return [{ name: "length", value: p.length, unit: "mm" }];
  if (p.kind === "circle")
    return [{ name: "radius", value: p.radius, unit: "mm" }, { name: "diameter", value: 2 * p.radius, unit: "mm" }, { name: "length", value: p.length, unit: "mm" }];
  return p.kind === "face" ? [{ name: "area", value: p.area, unit: "mm²" }] : [];
}

/**
 * What lies between two picks: the distance of their points or centers, along the axes too, the distance of lines and planes where they are
 * parallel or a point is one of them, and the angle of directions.
 *
 * @param {Pick} a
 * @param {Pick} b
 * @returns {Finding[]}
 */
export function findingsOfTwo(a, b) {
  const between = sub(anchorOf(b), anchorOf(a));
  const findings = [{ name: a.kind === "circle" && b.kind === "circle" ? "distance of centers" : "distance", value: norm(between), unit: "mm" }];
  "xyz".split("").forEach((axis, i) => findings.push({ name: `along ${axis.toUpperCase()}`, value: between[i], unit: "mm" }));
  const face = a.kind === "face" ? a : b.kind === "face" ? b : null, other = face === a ? b : a;
  const u = directionOf(a), v = directionOf(b);
  const parallel = u && v ? norm(cross(u, v)) < 1e-3 : false, perpendicular = u && v ? Math.abs(dot(u, v)) < 1e-3 : false;
  // A face is parallel to an edge that is perpendicular to its normal.
  const level = face !== null && (other.kind === "point" || (other.kind === "edge" ? perpendicular : parallel));
  if (face && level) findings.push({ name: "perpendicular distance", value: Math.abs(dot(between, face.normal)), unit: "mm" });
  const line = a.kind === "edge" ? a : b.kind === "edge" ? b : null, rest = line === a ? b : a;
  if (line && (rest.kind === "point" || (rest.kind === "edge" && parallel)))
    findings.push({ name: "perpendicular distance", value: norm(cross(between, unit(sub(line.to, line.from)))), unit: "mm" });
  if (u && v) {
    const cosine = Math.min(1, Math.abs(dot(u, v))), angle = (Math.acos(cosine) * 180) / Math.PI;
    // The angle between a face and an edge is that to the plane, not to its normal.
    const mixed = (a.kind === "face") !== (b.kind === "face") && (a.kind === "edge" || b.kind === "edge");
    findings.push({ name: "angle", value: mixed ? 90 - angle : angle, unit: "°" });
  }
  return findings;
}
