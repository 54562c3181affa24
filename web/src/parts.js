// The parts of the scene, as three.js draws them.

import {
  Box3, BufferAttribute, BufferGeometry, Group, LineBasicMaterial, LineSegments, Matrix4, Mesh, MeshBasicMaterial, Sphere, Vector3,
} from "three";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";
import { Batches } from "./batches.js";
import { Bvh } from "./bvh.js";
import { isClosed } from "./closed.js";
import { MeshCache, readMesh } from "./mesh.js";
import { makeMaterial } from "./shading.js";

/**
 * @typedef {import("./engine.js").Part} Part
 * @typedef {import("./engine.js").Material} Material
 * @typedef {import("three").Plane} Plane
 */

const CURVE_WIDTH = 2.5; // pixels
const KEPT_BYTES = 128e6; // of meshes that were shown before, such as the frames of a film

/** A mesh with its buffers, shared by all parts that show it. */
export class Shape {
  /** @param {import("./mesh.js").MeshData} data */
  constructor(data) {
    this.data = data;
    const position = new BufferAttribute(data.positions, 3);
    this.surface = new BufferGeometry();
    this.surface.setAttribute("position", position);
    if (data.normals) this.surface.setAttribute("normal", new BufferAttribute(data.normals, 3));
    this.surface.setIndex(new BufferAttribute(data.triangles, 1));
    this.edges = new BufferGeometry();
    this.edges.setAttribute("position", position);
    this.edges.setIndex(new BufferAttribute(data.edges, 1));
    this.box = new Box3().setFromBufferAttribute(position);
    for (const geometry of [this.surface, this.edges]) {
      geometry.boundingBox = this.box;
      geometry.boundingSphere = this.box.getBoundingSphere(new Sphere());
    }
    /** @type {Bvh | null} */
    this.hierarchy = null;
    /** @type {LineSegmentsGeometry | null} */
    this.thick = null;
    /** @type {boolean | null} */
    this.shut = null;
  }

  /** Whether it encloses a volume. */
  get closed() {
    return (this.shut ??= isClosed(this.data.positions, this.data.triangles));
  }

  bvh() {
    return (this.hierarchy ??= new Bvh(this.data.positions, this.data.triangles));
  }

  /** Segments with a width, for a curve or the edges of a part that is picked. */
  thickLines() {
    if (this.thick) return this.thick;
    const { positions, edges } = this.data, ends = new Float32Array(edges.length * 3);
    edges.forEach((v, i) => ends.set(positions.subarray(3 * v, 3 * v + 3), 3 * i));
    this.thick = new LineSegmentsGeometry();
    this.thick.setPositions(ends);
    return this.thick;
  }

  dispose() {
    this.surface.dispose();
    this.edges.dispose();
    this.thick?.dispose();
  }
}

/** A part that is drawn, and what the user chose for it. */
export class PartView {
  /** @param {Part} part @param {Shape} shape */
  constructor(part, shape) {
    this.part = part;
    this.shape = shape;
    this.group = new Group();
    this.group.matrixAutoUpdate = false;
    /** @type {Mesh | null} */
    this.surface = null;
    /** @type {LineSegments | null} */
    this.edges = null;
    /** @type {LineSegments2 | null} */
    this.curve = null;
    this.inverse = new Matrix4();
    /** From where the scene has the part to where it is. @type {Matrix4 | null} */
    this.motion = null;
    this.key = "";
  }

  get isCurve() {
    return this.shape.data.triangles.length === 0;
  }

  /** Bounds in space, exact for the mesh's box. */
  box() {
    return this.shape.box.clone().applyMatrix4(this.group.matrix);
  }

  place() {
    const p = this.part.placement;
    if (p) this.group.matrix.set(p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7], p[8], p[9], p[10], p[11], 0, 0, 0, 1);
    else this.group.matrix.identity();
    if (this.motion) this.group.matrix.premultiply(this.motion);
    this.group.matrixWorldNeedsUpdate = true;
    this.inverse.copy(this.group.matrix).invert();
  }
}

/**
 * @typedef {object} Display  what is drawn, for all parts
 * @property {boolean} edges
 * @property {boolean} wireframe
 * @property {boolean} oneSided
 */

export class Parts {
  /** @param {(id: string) => Promise<ArrayBuffer>} load  a mesh */
  constructor(load) {
    this.group = new Group();
    /** @type {Map<string, PartView>} by name */
    this.views = new Map();
    /** @type {MeshCache<Shape>} */
    this.cache = new MeshCache(async (id) => new Shape(readMesh(await load(id))), (s) => s.data.bytes, (s) => s.dispose(), KEPT_BYTES);
    /** @type {Display} */
    this.display = { edges: true, wireframe: false, oneSided: false };
    /** @type {Plane[]} */
    this.clipping = [];
    /** @type {Set<string>} names of parts that are hidden */
    this.hidden = new Set();
    /** @type {Set<string>} names of parts that are transparent */
    this.glass = new Set();
    /** @type {string | null} the part that is shown alone */
    this.alone = null;
    /** @type {Map<string, import("three").Material>} */
    this.materials = new Map();
    /** @type {Material[]} */
    this.palette = [];
    this.edgeMaterial = new LineBasicMaterial({ color: 0x101418, transparent: true, opacity: 0.55, toneMapped: false });
    this.edgeMaterial.clippingPlanes = this.clipping;
    this.batches = new Batches(this.edgeMaterial);
    this.group.add(this.batches.group);
  }

  /**
   * Loads the meshes of a scene. The result is passed to `show`; nothing changes before, so that the page never shows half of a scene.
   *
   * @param {import("./engine.js").SceneMessage} scene
   */
  load(scene) {
    return Promise.all(scene.parts.map((part) => this.cache.get(part.mesh)));
  }

  /** @param {import("./engine.js").SceneMessage} scene @param {Shape[]} shapes */
  show(scene, shapes) {
    this.palette = scene.materials;
    const old = this.views;
    this.views = new Map();
    scene.parts.forEach((part, i) => {
      let view = old.get(part.name);
      old.delete(part.name);
      if (!view || view.shape !== shapes[i]) {
        if (view) this.group.remove(view.group);
        view = new PartView(part, shapes[i]);
        this.group.add(view.group);
      }
      view.part = part;
      view.motion = null;
      view.place();
      this.views.set(part.name, view);
    });
    for (const view of old.values()) this.group.remove(view.group);
    this.refresh();
    this.cache.trim(new Set(scene.parts.map((part) => part.mesh)));
  }

  /**
   * Moves parts away from where the scene has them.
   *
   * @param {string[]} names
   * @param {number[][] | null} motions  3 rows of 4 for each; null: they return
   */
  move(names, motions) {
    let batched = false;
    names.forEach((name, i) => {
      const view = this.views.get(name), m = motions?.[i];
      if (!view) return;
      view.motion = m ? new Matrix4().set(m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8], m[9], m[10], m[11], 0, 0, 0, 1) : null;
      view.place();
      batched ||= view.surface?.visible === false;
    });
    // Copies that are drawn together have their places in one buffer.
    if (batched) this.refresh();
  }

  /** Brings what is drawn up to date after a change of a choice. */
  refresh() {
    const used = new Set();
    for (const view of this.views.values()) {
      view.group.visible = this.isVisible(view.part.name);
      this.dress(view, used);
    }
    this.batches.build(this.visible());
    for (const [key, material] of this.materials)
      if (!used.has(key)) {
        material.dispose();
        this.materials.delete(key);
      }
  }

  /** @param {string} name */
  isVisible(name) {
    return this.alone !== null && this.views.has(this.alone) ? name === this.alone : !this.hidden.has(name);
  }

  *visible() {
    for (const view of this.views.values()) if (view.group.visible) yield view;
  }

  /** @param {PartView} view @param {Set<string>} used */
  dress(view, used) {
    const { part, shape } = view, glass = this.glass.has(part.name);
    if (view.isCurve) {
      view.curve ??= this.add(view, new LineSegments2(shape.thickLines()));
      view.curve.material = this.curveMaterial(this.palette[part.material], glass, used);
      return;
    }
    const byLabel = new Map(part.labels);
    const numbers = shape.data.groups.map((g) => byLabel.get(g.label) ?? part.material);
    const materials = numbers.map((n) => this.surfaceMaterial(this.palette[n], view, glass, used));
    view.surface ??= this.add(view, new Mesh(shape.surface));
    // Groups of the geometry tell which material is whose. They are the same for all parts that share the mesh.
    if (shape.data.groups.length > 1 && shape.surface.groups.length === 0)
      shape.data.groups.forEach((g, i) => shape.surface.addGroup(3 * g.start, 3 * g.count, i));
    view.surface.material = materials.length > 1 ? materials : materials[0];
    view.surface.castShadow = !glass && !this.display.wireframe;
    view.surface.receiveShadow = true;
    view.edges ??= this.add(view, new LineSegments(shape.edges, this.edgeMaterial));
    view.edges.visible = this.display.edges && !this.display.wireframe;
  }

  /** @template {import("three").Object3D} T @param {PartView} view @param {T} object @returns {T} */
  add(view, object) {
    object.userData.view = view;
    object.matrixAutoUpdate = false;
    view.group.add(object);
    return object;
  }

  /** @param {Material} m @param {PartView} view @param {boolean} glass @param {Set<string>} used */
  surfaceMaterial(m, view, glass, used) {
    const flat = view.shape.data.normals === null;
    const thickness = m.transmission > 0 ? Math.min(...view.shape.box.getSize(new Vector3()).toArray()) : 0;
    const { wireframe, oneSided } = this.display;
    return this.material(JSON.stringify([m, flat, glass, thickness, wireframe, oneSided]), used, () => {
      if (wireframe) return new MeshBasicMaterial({ color: makeMaterial(m, { glass, flat, thickness, oneSided }).color, wireframe: true, toneMapped: false });
      return makeMaterial(m, { glass, flat, thickness, oneSided });
    });
  }

  /** @param {Material} m @param {boolean} glass @param {Set<string>} used @returns {LineMaterial} */
  curveMaterial(m, glass, used) {
    return this.material(JSON.stringify(["curve", m, glass]), used, () => {
      const material = new LineMaterial({ linewidth: CURVE_WIDTH, transparent: glass, opacity: glass ? 0.3 : 1 });
      material.color.setRGB(...m.color);
      return material;
    });
  }

  /** @template {import("three").Material} T @param {string} key @param {Set<string>} used @param {() => T} make @returns {T} */
  material(key, used, make) {
    used.add(key);
    let material = /** @type {T | undefined} */ (this.materials.get(key));
    if (!material) {
      material = make();
      material.clippingPlanes = this.clipping;
      this.materials.set(key, material);
    }
    return material;
  }

  /** The bounds of what is visible; empty if nothing is. */
  bounds() {
    const box = new Box3();
    for (const view of this.visible()) box.union(view.box());
    return box;
  }
}
