// What exact surfaces are like, drawn on the parts: colors for values, zebra stripes, normals, lines of parameters, and control nets.

import {
  BufferAttribute, BufferGeometry, DoubleSide, Float32BufferAttribute, Group, LineBasicMaterial, LineSegments, Mesh, Points, PointsMaterial,
  ShaderMaterial, Vector3,
} from "three";
import { colorOf, scaleOf } from "./colors.js";
import { floatsOf } from "./engine.js";

/**
 * @typedef {import("./parts.js").PartView} PartView
 * @typedef {"gaussian" | "mean" | "max" | "min" | "deviation"} ValueKind
 * @typedef {ValueKind | "zebra" | "normals" | "isolines" | "net"} SurfaceKind
 *
 * @typedef {object} Outcome
 * @property {import("./colors.js").Scale | null} scale  of values
 * @property {number | null} farthest  of distances
 * @property {string[]} problems  why parts have no such thing
 */

/** @type {Record<ValueKind, string>} */
export const UNITS = { gaussian: "1/mm²", mean: "1/mm", max: "1/mm", min: "1/mm", deviation: "mm" };

const MOST_NORMALS = 4000;
const NORMAL_LENGTH = 0.04; // of the diagonal of the part
const MOST_PARTS = 60; // that are asked about at once

/** The values of a kind at the corners of the triangles, as they are drawn. @param {ValueKind} kind @param {import("./engine.js").SurfaceAnswer} answer @param {Uint32Array | null} order @returns {Float32Array} */
export function valuesOf(kind, answer, order) {
  if (kind === "deviation") {
    const sent = floatsOf(answer.distance ?? "");
    return Float32Array.from({ length: 3 * sent.length }, (_, i) => sent[order ? order[Math.floor(i / 3)] : Math.floor(i / 3)]);
  }
  const mean = floatsOf(answer.mean ?? ""), gaussian = floatsOf(answer.gaussian ?? "");
  return mean.map((_, i) => {
    const k = order ? 3 * order[Math.floor(i / 3)] + (i % 3) : i;
    if (kind === "mean") return mean[k];
    if (kind === "gaussian") return gaussian[k];
    // The principal curvatures are the roots of x² - 2 mean x + gaussian.
    const apart = Math.sqrt(Math.max(0, mean[k] ** 2 - gaussian[k]));
    return kind === "max" ? mean[k] + apart : mean[k] - apart;
  });
}

// A light at the eye shows the form, and leaves colors as the scale has them.
const LIT_VERTEX = `#include <clipping_planes_pars_vertex>
  attribute vec3 tint;
  varying vec3 shade, toEye, side;
  void main() {
    shade = tint;
    vec4 mvPosition = modelViewMatrix * vec4( position, 1.0 );
    toEye = projectionMatrix[3][3] == 1.0 ? vec3( 0.0, 0.0, 1.0 ) : -mvPosition.xyz;
    side = normalMatrix * normal;
    gl_Position = projectionMatrix * mvPosition;
    #include <clipping_planes_vertex>
  }`;
const LIT_FRAGMENT = `#include <clipping_planes_pars_fragment>
  uniform float stripes; // 0: colors
  varying vec3 shade, toEye, side;
  void main() {
    #include <clipping_planes_fragment>
    vec3 eye = normalize( toEye ), n = normalize( side );
    float facing = dot( n, eye );
    vec3 color = shade * ( 0.72 + 0.28 * abs( facing ) );
    if ( stripes > 0.0 ) {
      // What a mirror shows of long lamps side by side, from below to above.
      float at = ( ( 2.0 * facing * n - eye ).y + 1.0 ) / 2.0 * stripes, width = fwidth( at );
      float wave = abs( fract( at ) - 0.5 ) * 2.0;
      color = mix( vec3( 0.008, 0.009, 0.012 ), vec3( 0.9 ), smoothstep( 0.5 - width, 0.5 + width, wave ) ) * ( 0.8 + 0.2 * abs( facing ) );
    }
    gl_FragColor = vec4( color, 1.0 );
    #include <colorspace_fragment>
  }`;
const ZEBRA_STRIPES = 16;

/** The area of the triangle of each corner. @param {{ positions: Float32Array, triangles: Uint32Array }} mesh */
export function areasOf({ positions, triangles }) {
  const areas = new Float32Array(triangles.length), [a, b, c] = [new Vector3(), new Vector3(), new Vector3()];
  for (let i = 0; i < triangles.length; i += 3) {
    a.fromArray(positions, 3 * triangles[i]);
    b.fromArray(positions, 3 * triangles[i + 1]).sub(a);
    c.fromArray(positions, 3 * triangles[i + 2]).sub(a);
    areas.fill(b.cross(c).length() / 2, i, i + 3);
  }
  return areas;
}

export class Surfaces {
  /** @param {import("./view.js").View} view @param {import("./engine.js").Engine} engine */
  constructor(view, engine) {
    this.view = view;
    this.engine = engine;
    this.group = new Group();
    view.scene.add(this.group);
    this.turn = 0;
    this.material = this.makeMaterial(0);
    this.zebra = this.makeMaterial(ZEBRA_STRIPES);
    this.lines = new LineBasicMaterial({ toneMapped: false });
    this.points = new PointsMaterial({ size: 6, sizeAttenuation: false, toneMapped: false });
    for (const material of [this.lines, this.points]) material.clippingPlanes = view.parts.clipping;
  }

  /** @param {number} stripes */
  makeMaterial(stripes) {
    const material = new ShaderMaterial({
      uniforms: { stripes: { value: stripes } }, vertexShader: LIT_VERTEX, fragmentShader: LIT_FRAGMENT, side: DoubleSide, clipping: true, toneMapped: false,
      // In front of the part's own faces, and behind its edges.
      polygonOffset: true, polygonOffsetFactor: 0.5, polygonOffsetUnits: 0.5,
    });
    material.clippingPlanes = this.view.parts.clipping;
    return material;
  }

  clear() {
    this.turn++;
    this.drop();
    this.view.invalidate();
  }

  drop() {
    for (const object of this.group.children) /** @type {Mesh} */ (object).geometry.dispose();
    this.group.clear();
  }

  /**
   * Shows something of some parts. Resolves with null if something else was asked for meanwhile.
   *
   * @param {SurfaceKind} kind
   * @param {PartView[]} views
   * @param {number} percent  of the values that the scale shows
   * @returns {Promise<Outcome | null>}
   */
  async show(kind, views, percent) {
    const turn = ++this.turn;
    /** @type {Outcome} */
    const out = { scale: null, farthest: null, problems: [] };
    const chosen = views.slice(0, MOST_PARTS);
    if (views.length > chosen.length) out.problems.push(`Only ${MOST_PARTS} parts are shown. Select the parts that you want to see.`);
    const isLocal = kind === "zebra" || kind === "normals";
    const question = kind === "isolines" || kind === "net" || kind === "deviation" ? kind : "curvature";
    const answers = await Promise.all(chosen.map((v) => (isLocal ? null : this.engine.surface(v.part.name, question).catch((/** @type {Error} */ error) => error))));
    if (turn !== this.turn) return null;
    this.drop();
    const tint = this.view.color("--accent");
    this.lines.color.copy(tint);
    this.points.color.copy(tint);
    for (const answer of answers) {
      if (answer instanceof Error) out.problems.push(answer.message);
      else if (answer?.reason) out.problems.push(answer.reason);
    }
    if (kind === "zebra") for (const v of chosen) this.addZebra(v, out);
    else if (kind === "normals") for (const v of chosen) this.addNormals(v, out);
    else {
      /** @type {{ view: PartView, answer: import("./engine.js").SurfaceAnswer }[]} */
      const good = [];
      chosen.forEach((view, i) => {
        const answer = answers[i];
        if (answer && !(answer instanceof Error) && !answer.reason && (answer.mesh === "" || answer.mesh === view.part.mesh)) good.push({ view, answer });
      });
      if (kind === "isolines" || kind === "net") for (const { answer } of good) this.addLines(answer, kind === "net");
      else this.addValues(kind, good, percent, out);
    }
    this.view.invalidate();
    return out;
  }

  /** @param {ValueKind} kind @param {{ view: PartView, answer: import("./engine.js").SurfaceAnswer }[]} good @param {number} percent @param {Outcome} out */
  addValues(kind, good, percent, out) {
    const lists = good.map(({ view, answer }) => valuesOf(kind, answer, view.shape.data.order));
    if (lists.length === 0) return;
    out.scale = scaleOf(lists, percent, good.map(({ view }) => areasOf(view.shape.data)));
    if (kind === "deviation") out.farthest = Math.max(...good.map(({ answer }) => answer.farthest ?? 0));
    const { scale } = out;
    good.forEach(({ view }, i) => {
      const values = lists[i], tints = new Float32Array(3 * values.length);
      values.forEach((x, k) => tints.set(colorOf(scale, x), 3 * k));
      this.addMesh(view, cornersOf(view, tints), this.material);
    });
  }

  /** @param {PartView} view @param {BufferGeometry} geometry @param {ShaderMaterial} material */
  addMesh(view, geometry, material) {
    const mesh = new Mesh(geometry, material);
    mesh.matrixAutoUpdate = false;
    mesh.matrix.copy(view.group.matrix);
    mesh.userData.view = view;
    this.group.add(mesh);
  }

  /** @param {PartView} view @param {Outcome} out */
  addZebra(view, out) {
    if (view.isCurve) return void out.problems.push(`${view.part.name} is a curve, which reflects nothing`);
    this.addMesh(view, cornersOf(view, new Float32Array(3 * view.shape.data.triangles.length)), this.zebra);
  }

  /** @param {PartView} view @param {Outcome} out */
  addNormals(view, out) {
    const { positions, normals, triangles } = view.shape.data;
    if (!normals || triangles.length === 0) return void out.problems.push(`${view.part.name} has no normals: its mesh has flat faces only`);
    const count = positions.length / 3, step = Math.max(1, Math.ceil(count / MOST_NORMALS)), length = NORMAL_LENGTH * view.shape.box.getSize(new Vector3()).length();
    const ends = [];
    for (let v = 0; v < count; v += step) {
      const p = 3 * v;
      ends.push(positions[p], positions[p + 1], positions[p + 2],
        positions[p] + length * normals[p], positions[p + 1] + length * normals[p + 1], positions[p + 2] + length * normals[p + 2]);
    }
    const lines = this.addSegments(ends);
    lines.matrixAutoUpdate = false;
    lines.matrix.copy(view.group.matrix);
  }

  /** @param {import("./engine.js").SurfaceAnswer} answer @param {boolean} dots */
  addLines(answer, dots) {
    const points = floatsOf(answer.points ?? ""), ends = [];
    let at = 0;
    for (const size of answer.sizes ?? []) {
      for (let i = at; i + 1 < at + size; i++) ends.push(...points.subarray(3 * i, 3 * i + 6));
      at += size;
    }
    this.addSegments(ends);
    if (!dots) return;
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(points, 3));
    this.group.add(new Points(geometry, this.points));
  }

  /** @param {number[]} ends */
  addSegments(ends) {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new Float32BufferAttribute(ends, 3));
    const lines = new LineSegments(geometry, this.lines);
    this.group.add(lines);
    return lines;
  }
}

/** The triangles of a part with vertices of their own. @param {PartView} view @param {Float32Array} tints */
function cornersOf(view, tints) {
  const { positions, normals, triangles } = view.shape.data, geometry = new BufferGeometry();
  const at = new Float32Array(3 * triangles.length), sides = normals ? new Float32Array(3 * triangles.length) : null;
  triangles.forEach((v, i) => {
    at.set(positions.subarray(3 * v, 3 * v + 3), 3 * i);
    if (normals) sides?.set(normals.subarray(3 * v, 3 * v + 3), 3 * i);
  });
  geometry.setAttribute("position", new BufferAttribute(at, 3));
  geometry.setAttribute("tint", new BufferAttribute(tints, 3));
  if (sides) geometry.setAttribute("normal", new BufferAttribute(sides, 3));
  else geometry.computeVertexNormals();
  return geometry;
}
