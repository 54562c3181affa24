// Copies of one mesh in one material, drawn together: a scene of 10,000 balls takes one call instead of 10,000.

import { BufferAttribute, BufferGeometry, Group, InstancedMesh, LineSegments, Vector3 } from "three";

/** @typedef {import("./parts.js").PartView} PartView */

const LEAST_COPIES = 16;
const MOST_EDGE_NUMBERS = 6e6; // edges of more copies are left out

export class Batches {
  /** @param {import("three").Material} edgeMaterial */
  constructor(edgeMaterial) {
    this.group = new Group();
    this.edgeMaterial = edgeMaterial;
  }

  /** Draws the copies among visible parts, which then need not draw themselves. @param {Iterable<PartView>} views */
  build(views) {
    for (const object of this.group.children)
      if (object instanceof InstancedMesh) object.dispose();
      else if (object instanceof LineSegments) object.geometry.dispose();
    this.group.clear();
    /** @type {Map<string, PartView[]>} */
    const copies = new Map();
    for (const view of views) {
      if (!view.surface) continue;
      view.surface.visible = true;
      const { material } = view.surface, key = `${view.part.mesh} ${Array.isArray(material) ? material.map((m) => m.id) : material.id}`;
      const list = copies.get(key);
      if (list) list.push(view);
      else copies.set(key, [view]);
    }
    for (const list of copies.values()) if (list.length >= LEAST_COPIES) this.add(list);
  }

  /** @param {PartView[]} views */
  add(views) {
    const [{ shape, surface, edges }] = views;
    if (!surface) return;
    const mesh = new InstancedMesh(shape.surface, /** @type {import("three").Material} */ (surface.material), views.length);
    views.forEach((view, i) => mesh.setMatrixAt(i, view.group.matrix));
    mesh.castShadow = surface.castShadow;
    mesh.receiveShadow = true;
    mesh.frustumCulled = false;
    this.group.add(mesh);
    if (edges?.visible) this.addEdges(views);
    for (const view of views) {
      if (view.surface) view.surface.visible = false;
      if (view.edges) view.edges.visible = false;
    }
  }

  /** @param {PartView[]} views */
  addEdges(views) {
    const { positions, edges } = views[0].shape.data, size = 3 * edges.length;
    if (size === 0 || size * views.length > MOST_EDGE_NUMBERS) return;
    const all = new Float32Array(size * views.length), p = new Vector3();
    views.forEach((view, i) => edges.forEach((v, k) =>
      p.fromArray(positions, 3 * v).applyMatrix4(view.group.matrix).toArray(all, size * i + 3 * k)));
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(all, 3));
    const lines = new LineSegments(geometry, this.edgeMaterial);
    lines.frustumCulled = false;
    this.group.add(lines);
  }
}
