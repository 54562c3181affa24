// Ghosts: the shape of the expression at the cursor, if it is not shown itself, and what the script does to it next.

import {
  ArrowHelper, Box3, BufferGeometry, Group, LineBasicMaterial, LineDashedMaterial, LineSegments, Line, Matrix4, Mesh, MeshBasicMaterial, DoubleSide, Vector3,
} from "three";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { formatNumber, formatPoint } from "./format.js";

/** @typedef {import("./engine.js").Ghost} Ghost */

const FILL = 0.2, HIDDEN_FILL = 0.1; // opacity in front of things, and behind them
const AXIS_COLORS = [0xd14b3d, 0x3c9a48, 0x3f7fd6];

/** What the script does next, in words. @param {Ghost} ghost */
export function motionText({ motion }) {
  if (!motion) return "";
  switch (motion.kind) {
    case "translate": return `moved by ${formatPoint(motion.direction)} mm`;
    case "rotate": return `turned by ${formatNumber(motion.angle)}°`;
    case "revolve": return "revolved about its axis";
    default: return "transformed";
  }
}

export class Ghosts {
  /** @param {import("./view.js").View} view @param {import("./engine.js").Engine} engine */
  constructor(view, engine) {
    this.view = view;
    this.engine = engine;
    this.group = new Group();
    view.scene.add(this.group);
    /** @type {Ghost[]} */
    this.shown = [];
    this.turn = 0;
    this.key = "";
  }

  /** Shows what is at a location of the script. @param {string} file @param {number} line @param {number} column */
  async look(file, line, column) {
    const turn = ++this.turn;
    const ghosts = await this.engine.ghosts(file, line, column).catch(() => []);
    const shapes = await Promise.all(ghosts.map((g) => this.view.parts.cache.get(g.mesh))).catch(() => null);
    if (turn !== this.turn) return;
    this.show(shapes ? ghosts : [], shapes ?? []);
  }

  clear() {
    this.turn++;
    this.show([], []);
  }

  /** @param {Ghost[]} ghosts @param {import("./parts.js").Shape[]} shapes */
  show(ghosts, shapes) {
    const key = JSON.stringify(ghosts);
    if (key === this.key) return;
    this.key = key;
    this.shown = ghosts;
    this.drop();
    /** @type {import("./faces.js").Piece[]} */
    const pieces = [];
    const tint = this.view.color("--hint"), drawn = new Set();
    ghosts.forEach((ghost, i) => {
      const box = shapes[i].box.clone().applyMatrix4(matrixOf(ghost.placement));
      if (ghost.motion) this.group.add(this.motion(ghost.motion, box, tint));
      // A shape that is used several times is drawn once.
      const same = JSON.stringify([ghost.mesh, ghost.placement]);
      if (drawn.has(same)) return;
      drawn.add(same);
      const matrix = matrixOf(ghost.placement), group = new Group();
      group.matrixAutoUpdate = false;
      group.matrix.copy(matrix);
      group.matrixWorldNeedsUpdate = true;
      this.group.add(group);
      if (ghost.line) group.add(curveOf(shapes[i], tint));
      else {
        group.add(...surfaceOf(shapes[i], tint));
        pieces.push({ surface: true, shape: shapes[i], group });
      }
    });
    this.view.ghosts = pieces;
    this.view.invalidate();
  }

  /** Shapes belong to the cache. What is made for the ghosts is released here. */
  drop() {
    this.group.traverse((object) => {
      const { geometry, material } = /** @type {Mesh} */ (object);
      if (material instanceof LineMaterial || material instanceof MeshBasicMaterial || material instanceof LineBasicMaterial) material.dispose();
      if (object.userData.own) geometry.dispose();
    });
    this.group.clear();
  }

  /** @param {import("./engine.js").Motion} motion @param {Box3} box  of the ghost @param {import("three").Color} tint */
  motion(motion, box, tint) {
    const group = new Group(), center = box.getCenter(new Vector3()), size = box.getSize(new Vector3()).length() || 1;
    const direction = new Vector3(...motion.direction), color = tint.getHex();
    if (motion.kind === "translate") {
      const length = direction.length();
      if (length > 0) group.add(arrow(direction.clone().normalize(), center, length, color, Math.min(0.3 * length, 0.12 * size)));
    } else if (motion.kind === "transform" && motion.frame) {
      const frame = matrixOf(motion.frame), origin = new Vector3().setFromMatrixPosition(frame);
      [0, 1, 2].forEach((k) => {
        const axis = new Vector3().setFromMatrixColumn(frame, k);
        if (axis.length() > 0) group.add(arrow(axis.normalize(), origin, 0.4 * size, AXIS_COLORS[k], 0.07 * size));
      });
    } else if (direction.length() > 0) {
      // The axis runs along the ghost.
      direction.normalize();
      const point = new Vector3(...motion.point), middle = point.clone().addScaledVector(direction, center.clone().sub(point).dot(direction));
      const ends = [-0.75, 0.75].map((k) => middle.clone().addScaledVector(direction, k * size));
      const line = new Line(new BufferGeometry().setFromPoints(ends), new LineDashedMaterial({ color, dashSize: size / 30, gapSize: size / 60, depthTest: false, toneMapped: false }));
      line.computeLineDistances();
      line.renderOrder = 3;
      line.userData.own = true;
      group.add(line);
    }
    return group;
  }
}

/** @param {number[]} p  3 rows of 4 */
function matrixOf(p) {
  return new Matrix4().set(p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7], p[8], p[9], p[10], p[11], 0, 0, 0, 1);
}

/** @param {Vector3} direction @param {Vector3} from @param {number} length @param {number} color @param {number} head */
function arrow(direction, from, length, color, head) {
  const made = new ArrowHelper(direction, from, length, color, head, 0.6 * head);
  for (const part of [made.line, made.cone]) {
    const material = /** @type {LineBasicMaterial} */ (part.material);
    material.depthTest = false;
    material.toneMapped = false;
    part.renderOrder = 3;
  }
  return made;
}

/** @param {import("./parts.js").Shape} shape @param {import("three").Color} tint */
function surfaceOf(shape, tint) {
  const fill = (/** @type {boolean} */ depthTest, /** @type {number} */ opacity) => {
    const material = new MeshBasicMaterial({ color: tint, opacity, depthTest, transparent: true, depthWrite: false, side: DoubleSide, toneMapped: false });
    const mesh = new Mesh(shape.surface, shape.surface.groups.length ? shape.surface.groups.map(() => material) : material);
    mesh.matrixAutoUpdate = false;
    mesh.renderOrder = 1;
    return mesh;
  };
  const edges = new LineSegments(shape.edges, new LineBasicMaterial({ color: tint, depthTest: false, transparent: true, opacity: 0.8, toneMapped: false }));
  edges.matrixAutoUpdate = false;
  edges.renderOrder = 2;
  return [fill(false, HIDDEN_FILL), fill(true, FILL), edges];
}

/** @param {import("./parts.js").Shape} shape @param {import("three").Color} tint */
function curveOf(shape, tint) {
  const material = new LineMaterial({ linewidth: 3, depthTest: false, transparent: true });
  material.color.copy(tint);
  const curve = new LineSegments2(shape.thickLines(), material);
  curve.matrixAutoUpdate = false;
  curve.renderOrder = 2;
  return curve;
}
