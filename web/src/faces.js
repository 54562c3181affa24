// Which operand of a set operation the faces of a part come from. It is asked for when it is first needed.

import { BufferAttribute, BufferGeometry, DoubleSide, Group, Mesh, MeshBasicMaterial } from "three";

/**
 * @typedef {import("./parts.js").PartView} PartView
 * @typedef {import("./engine.js").Origin} Origin
 *
 * @typedef {object} Faces
 * @property {Uint32Array} operands  of the triangles, in the order in which they are drawn
 * @property {number[]} sources  of the operands
 *
 * @typedef {object} Piece  a part of a surface, for the outline
 * @property {true} surface
 * @property {{ surface: BufferGeometry }} shape
 * @property {import("three").Group} group
 */

/** The operand of each triangle. @param {import("./engine.js").FacesAnswer} answer @param {number} count @param {Uint32Array | null} order @returns {Uint32Array} */
export function operandsOf({ faces }, count, order) {
  const sent = new Uint32Array(count);
  let at = 0;
  for (let i = 0; i < faces.length; i += 2) {
    sent.fill(faces[i + 1], at, at + faces[i]);
    at += faces[i];
  }
  return order ? sent.map((_, i) => sent[order[i]]) : sent;
}

/** Tints the faces that are outlined, so that they are told from the rest of their part. */
export class FaceTint {
  /** @param {import("./view.js").View} view */
  constructor(view) {
    this.view = view;
    this.group = new Group();
    view.scene.add(this.group);
    this.material = new MeshBasicMaterial({
      transparent: true, opacity: 0.3, depthWrite: false, side: DoubleSide, toneMapped: false, polygonOffset: true, polygonOffsetFactor: 0.5, polygonOffsetUnits: 0.5,
    });
    this.material.clippingPlanes = view.parts.clipping;
    /** @type {Piece[]} */
    this.pieces = [];
  }

  /** Shows these pieces, and releases those that were shown before. @param {Piece[]} pieces */
  show(pieces) {
    for (const piece of this.pieces) if (!pieces.includes(piece)) release(piece);
    this.pieces = pieces;
    this.material.color.copy(this.view.color("--hint"));
    this.group.children = pieces.map(({ shape, group }) => {
      const mesh = new Mesh(shape.surface, this.material);
      mesh.matrixAutoUpdate = false;
      mesh.matrix.copy(group.matrix);
      mesh.matrixWorldNeedsUpdate = true;
      return mesh;
    });
  }
}

/** The positions are those of the part, which keeps them. @param {Piece} piece */
function release({ shape: { surface } }) {
  surface.deleteAttribute("position");
  surface.dispose();
}

export class FaceSources {
  /** @param {import("./engine.js").Engine} engine */
  constructor(engine) {
    this.engine = engine;
    /** By part; null: asked for. @type {WeakMap<import("./engine.js").Part, Faces | null>} */
    this.known = new WeakMap();
    /** @type {WeakMap<import("./engine.js").Part, Promise<Faces | null>>} */
    this.asked = new WeakMap();
  }

  /** Whether the faces of a part have several sources. @param {PartView} view */
  has(view) {
    return (view.part.sources?.length ?? 0) > 0 && !view.isCurve;
  }

  /** The faces of a part if they are known already. @param {PartView} view */
  now(view) {
    return this.known.get(view.part) ?? null;
  }

  /** Resolves with null if they are those of another mesh, because the scene has changed. @param {PartView} view @returns {Promise<Faces | null>} */
  get(view) {
    const { part, shape } = view;
    let asked = this.asked.get(part);
    if (!asked) {
      asked = this.engine.faces(part.name).then((answer) => {
        if (answer.mesh !== part.mesh) return null;
        const faces = { operands: operandsOf(answer, shape.data.triangles.length / 3, shape.data.order), sources: answer.operands };
        this.known.set(part, faces);
        return faces;
      }, () => null);
      this.asked.set(part, asked);
    }
    return asked;
  }

  /** The source of a triangle. @param {PartView} view @param {Faces} faces @param {number} triangle */
  sourceOf(view, faces, triangle) {
    return view.part.sources?.[faces.sources[faces.operands[triangle]]] ?? null;
  }

  /** The triangles that are chosen by their operand. @param {PartView} view @param {Faces} faces @param {(operand: number) => boolean} choose @returns {Piece} */
  piece(view, faces, choose) {
    const { triangles } = view.shape.data, position = view.shape.surface.getAttribute("position"), chosen = [];
    for (let t = 0; t < faces.operands.length; t++)
      if (choose(faces.operands[t])) chosen.push(triangles[3 * t], triangles[3 * t + 1], triangles[3 * t + 2]);
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", position);
    geometry.setIndex(new BufferAttribute(new Uint32Array(chosen), 1));
    return { surface: true, shape: { surface: geometry }, group: view.group };
  }
}
