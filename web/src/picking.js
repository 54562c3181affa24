// What is under a point of the picture: a part, and for measuring its corners, edges, and faces.

import { Matrix4, Ray, Vector3, Vector4 } from "three";
import { chainLength, circleOf, cross, dot, edgeChain, flatFace, isStraight, norm, sub, unit, vertex } from "./recognize.js";

const CURVE_REACH = 7; // pixels
const SNAP = 9; // pixels

/**
 * @typedef {object} Hit
 * @property {import("./parts.js").PartView} view
 * @property {Vector3} point
 * @property {number} t  distance from the origin of the ray
 * @property {number} triangle  -1: of a curve
 * @property {number} segment  -1: of a surface
 *
 * @typedef {object} Sight  what is needed to find things in the picture
 * @property {import("three").PerspectiveCamera | import("three").OrthographicCamera} camera
 * @property {number} width  pixels
 * @property {number} height
 * @property {import("./parts.js").Parts} parts
 * @property {import("./section.js").Section} section
 */

/** The line of sight through a pixel. @param {Sight} sight @param {number} x @param {number} y @returns {Ray} */
export function rayThrough({ camera, width, height }, x, y) {
  const u = (2 * x) / width - 1, v = 1 - (2 * y) / height;
  const near = new Vector3(u, v, -1).unproject(camera), far = new Vector3(u, v, 1).unproject(camera);
  return new Ray(near, far.sub(near).normalize());
}

/** @param {Sight} sight @param {number} x @param {number} y @returns {Hit | null} */
export function pick(sight, x, y) {
  const ray = rayThrough(sight, x, y);
  /** @type {Hit | null} */
  let best = null;
  for (const view of sight.parts.visible()) {
    const hit = view.isCurve ? hitCurve(sight, view, ray, x, y) : hitSurface(sight, view, ray);
    // A curve is seen in front of the surface that it is on.
    if (hit && (!best || hit.t < best.t || (hit.segment >= 0 && best.segment < 0 && hit.t < best.t * 1.01))) best = hit;
  }
  return best;
}

/** Maps a direction without making it a unit vector. @param {Vector3} d @param {Matrix4} m */
function mapDirection(d, m) {
  const e = m.elements;
  return new Vector3(
    e[0] * d.x + e[4] * d.y + e[8] * d.z, e[1] * d.x + e[5] * d.y + e[9] * d.z, e[2] * d.x + e[6] * d.y + e[10] * d.z);
}

/** @param {Sight} sight @param {import("./parts.js").PartView} view @param {Ray} ray @returns {Hit | null} */
function hitSurface({ section }, view, ray) {
  // An affine map keeps the parameter along the ray.
  const origin = ray.origin.clone().applyMatrix4(view.inverse);
  const direction = mapDirection(ray.direction, view.inverse);
  const accept = section.on ? (/** @type {number} */ t) => !section.cuts(ray.at(t, new Vector3())) : undefined;
  const found = view.shape.bvh().cast(origin.toArray(), direction.toArray(), accept);
  if (!found) return null;
  return { view, point: ray.at(found.t, new Vector3()), t: found.t, triangle: found.triangle, segment: -1 };
}

/** Maps points of a part to pixels and depths. @param {Sight} sight @param {import("./parts.js").PartView} view */
function projector({ camera, width, height }, view) {
  const matrix = new Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse).multiply(view.group.matrix);
  const p = new Vector4();
  return (/** @type {Float32Array} */ positions, /** @type {number} */ v) => {
    p.set(positions[3 * v], positions[3 * v + 1], positions[3 * v + 2], 1).applyMatrix4(matrix);
    return p.w > 0 ? [((p.x / p.w + 1) / 2) * width, ((1 - p.y / p.w) / 2) * height, p.z / p.w] : null;
  };
}

const TIE = 2; // pixels: of things that are about as near to the pointer, the one in front counts

/** Whether a thing is nearer to a pixel than another. @param {[number, number]} a  pixels away, and depth @param {[number, number]} b */
const isNearer = (a, b) => a[0] < b[0] - TIE || (a[0] < b[0] + TIE && a[1] < b[1]);

/** The segment that is nearest to a pixel. @param {Sight} sight @param {import("./parts.js").PartView} view @param {number} x @param {number} y @param {number} reach */
function nearestSegment(sight, view, x, y, reach) {
  const { positions, edges } = view.shape.data, project = projector(sight, view);
  let segment = -1, part = 0;
  /** @type {[number, number]} */
  let least = [reach, Infinity];
  for (let e = 0; e < edges.length / 2; e++) {
    const a = project(positions, edges[2 * e]), b = project(positions, edges[2 * e + 1]);
    if (!a || !b) continue;
    const dx = b[0] - a[0], dy = b[1] - a[1], square = dx * dx + dy * dy;
    const s = square > 0 ? Math.min(1, Math.max(0, ((x - a[0]) * dx + (y - a[1]) * dy) / square)) : 0;
    /** @type {[number, number]} */
    const away = [Math.hypot(a[0] + s * dx - x, a[1] + s * dy - y), a[2] + s * (b[2] - a[2])];
    if (away[0] < reach && isNearer(away, least)) [least, segment, part] = [away, e, s];
  }
  if (segment < 0) return null;
  const a = new Vector3(...vertex(positions, edges[2 * segment])), b = new Vector3(...vertex(positions, edges[2 * segment + 1]));
  return { segment, point: a.lerp(b, part).applyMatrix4(view.group.matrix) };
}

/** @param {Sight} sight @param {import("./parts.js").PartView} view @param {Ray} ray @param {number} x @param {number} y @returns {Hit | null} */
function hitCurve(sight, view, ray, x, y) {
  const found = nearestSegment(sight, view, x, y, CURVE_REACH);
  if (!found || sight.section.cuts(found.point)) return null;
  return { view, point: found.point, t: found.point.clone().sub(ray.origin).dot(ray.direction), triangle: -1, segment: found.segment };
}

/** Whether a point of an edge is seen: what is hit at its pixel is not in front of it. @param {Sight} sight @param {Vector3} point @param {number} size */
function isSeen(sight, point, size) {
  const p = point.clone().project(sight.camera);
  const x = ((p.x + 1) / 2) * sight.width, y = ((1 - p.y) / 2) * sight.height;
  const ray = rayThrough(sight, x, y), depth = point.clone().sub(ray.origin).dot(ray.direction);
  for (const view of sight.parts.visible()) {
    const hit = view.isCurve ? null : hitSurface(sight, view, ray);
    if (hit && hit.t < depth - size) return false;
  }
  return true;
}

/**
 * What can be measured under a pixel: a corner, an edge, a face, or a point, in this order.
 *
 * @param {Sight} sight
 * @param {number} x
 * @param {number} y
 * @returns {{ pick: import("./recognize.js").Pick, view: import("./parts.js").PartView } | null}
 */
export function pickFeature(sight, x, y) {
  const hit = pick(sight, x, y);
  const tolerance = sizeOf(sight) * 1e-3;
  const views = hit ? [hit.view] : [...sight.parts.visible()];
  for (const view of views) {
    const corner = cornerNear(sight, view, x, y);
    if (corner && isSeen(sight, corner, tolerance) && !sight.section.cuts(corner)) return { pick: { kind: "point", at: triple(corner) }, view };
  }
  for (const view of views) {
    const edge = nearestSegment(sight, view, x, y, SNAP);
    if (edge && isSeen(sight, edge.point, tolerance) && !sight.section.cuts(edge.point)) return { pick: edgePick(view, edge), view };
  }
  return hit ? { pick: hit.triangle >= 0 ? facePick(hit) : { kind: "point", at: triple(hit.point) }, view: hit.view } : null;
}

/** @param {Sight} sight */
const sizeOf = ({ parts }) => parts.bounds().getSize(new Vector3()).length();

/** @param {Vector3} p @returns {import("./recognize.js").Triple} */
const triple = (p) => [p.x, p.y, p.z];

/** @param {Sight} sight @param {import("./parts.js").PartView} view @param {number} x @param {number} y @returns {Vector3 | null} */
function cornerNear(sight, view, x, y) {
  const { positions } = view.shape.data, project = projector(sight, view);
  let nearest = -1;
  /** @type {[number, number]} */
  let least = [SNAP, Infinity];
  for (const v of cornersOf(view.shape)) {
    const p = project(positions, v);
    if (!p) continue;
    /** @type {[number, number]} */
    const away = [Math.hypot(p[0] - x, p[1] - y), p[2]];
    if (away[0] < SNAP && isNearer(away, least)) [least, nearest] = [away, v];
  }
  return nearest < 0 ? null : new Vector3(...vertex(positions, nearest)).applyMatrix4(view.group.matrix);
}

/** @type {WeakMap<import("./parts.js").Shape, number[]>} */
const corners = new WeakMap();

/** The vertices where feature edges end, meet, or turn. @param {import("./parts.js").Shape} shape */
function cornersOf(shape) {
  let found = corners.get(shape);
  if (found) return found;
  const { positions: p, edges } = shape.data;
  /** @type {Map<string, { v: number, to: Map<string, import("./recognize.js").Triple> }>} */
  const at = new Map();
  const key = (/** @type {number} */ v) => vertex(p, v).join();
  const join = (/** @type {number} */ a, /** @type {number} */ b) => {
    const entry = at.get(key(a)) ?? { v: a, to: new Map() };
    entry.to.set(key(b), unit(sub(vertex(p, b), vertex(p, a))));
    at.set(key(a), entry);
  };
  for (let e = 0; e < edges.length; e += 2) {
    join(edges[e], edges[e + 1]);
    join(edges[e + 1], edges[e]);
  }
  found = [...at.values()].filter(({ to }) => {
    const [a, b] = [...to.values()];
    return to.size !== 2 || dot(a, b) > -0.9; // a turn of more than 26 degrees
  }).map(({ v }) => v);
  corners.set(shape, found);
  return found;
}

/** @param {import("./parts.js").PartView} view @param {{ segment: number, point: Vector3 }} edge @returns {import("./recognize.js").Pick} */
function edgePick(view, edge) {
  const local = edgeChain(view.shape.data, edge.segment).points;
  const points = local.map((p) => triple(new Vector3(...p).applyMatrix4(view.group.matrix)));
  const at = triple(edge.point), length = chainLength(points), circle = circleOf(points);
  if (circle) return { kind: "circle", at, length, ...circle };
  if (isStraight(points)) return { kind: "edge", at, from: points[0], to: points[points.length - 1], length };
  return { kind: "point", at };
}

/** @param {Hit} hit @returns {import("./recognize.js").Pick} */
function facePick({ view, point, triangle }) {
  const { data } = view.shape, { positions, normals, triangles } = data, at = triple(point);
  const [a, b, c] = [0, 1, 2].map((k) => vertex(positions, triangles[3 * triangle + k]));
  const flat = unit(cross(sub(b, a), sub(c, a)));
  // The normals of a curved face turn within the triangle.
  const curved = normals && [0, 1, 2].some((k) => norm(cross(unit(vertex(normals, triangles[3 * triangle + k])), flat)) > 1e-3);
  if (curved) return { kind: "point", at };
  const face = flatFace(data, triangle);
  const normal = new Vector3(...face.normal).transformDirection(view.group.matrix);
  // Placements are rigid but for a scale, so that the cube root of the determinant is the scale.
  const scale = Math.abs(view.group.matrix.determinant()) ** (2 / 3);
  return { kind: "face", at, normal: triple(normal), area: face.area * scale };
}
