// The section plane: what is in front of it is cut away, and the cut of solids is shown closed.
//
// The cap of a solid is found with the stencil buffer: of the solid's part behind the plane, more back faces than front faces cover a pixel
// exactly if the line of sight enters through the cut. There, the plane itself is drawn.

import {
  AlwaysStencilFunc, BackSide, Color, DecrementWrapStencilOp, DoubleSide, FrontSide, Group, IncrementWrapStencilOp, Mesh, MeshBasicMaterial,
  NotEqualStencilFunc, Plane, PlaneGeometry, ReplaceStencilOp, ShaderMaterial, Vector3,
} from "three";

/** @typedef {"x" | "y" | "z"} Axis */

/** @type {Record<Axis, Vector3>} */
const NORMALS = { x: new Vector3(1, 0, 0), y: new Vector3(0, 1, 0), z: new Vector3(0, 0, 1) };

/** @param {3 | 4} side  of faces to count (BackSide or FrontSide below) @param {Plane[]} planes */
function counter(side, planes) {
  const back = side === 3;
  return new MeshBasicMaterial({
    side: back ? BackSide : FrontSide, clippingPlanes: planes, colorWrite: false, depthWrite: false, depthTest: false, stencilWrite: true,
    stencilFunc: AlwaysStencilFunc, stencilZPass: back ? IncrementWrapStencilOp : DecrementWrapStencilOp,
    stencilFail: back ? IncrementWrapStencilOp : DecrementWrapStencilOp, stencilZFail: back ? IncrementWrapStencilOp : DecrementWrapStencilOp,
  });
}

export class Section {
  constructor() {
    this.plane = new Plane(new Vector3(0, 0, -1), 0);
    this.on = false;
    /** @type {Axis} */
    this.axis = "z";
    this.offset = 0; // mm along the axis
    this.flipped = false; // keeps what is above instead of what is below
    /** The planes that clip; the array is shared by all materials. @type {Plane[]} */
    this.planes = [];
    this.group = new Group();
    this.backs = counter(3, [this.plane]);
    this.fronts = counter(4, [this.plane]);
    this.square = new PlaneGeometry(1, 1);
    /** @type {Map<string, ShaderMaterial>} */
    this.caps = new Map();
    /** @type {Set<string>} */
    this.used = new Set();
  }

  /** @param {Plane[]} planes  the array that materials share */
  share(planes) {
    this.planes = planes;
  }

  get normal() {
    return NORMALS[this.axis].clone().multiplyScalar(this.flipped ? 1 : -1);
  }

  /** Whether a point is cut away. @param {Vector3} p */
  cuts(p) {
    return this.on && this.plane.distanceToPoint(p) < 0;
  }

  /** Brings everything up to date. @param {import("./parts.js").Parts} parts */
  update(parts) {
    this.plane.setFromNormalAndCoplanarPoint(this.normal, NORMALS[this.axis].clone().multiplyScalar(this.offset));
    this.planes.length = 0;
    this.group.clear();
    this.used.clear();
    if (this.on) this.build(parts);
    for (const [key, material] of this.caps)
      if (!this.used.has(key)) {
        material.dispose();
        this.caps.delete(key);
      }
  }

  /** @param {import("./parts.js").Parts} parts */
  build(parts) {
    this.planes.push(this.plane);
    let order = 1;
    for (const view of parts.visible()) {
      if (view.isCurve || parts.glass.has(view.part.name)) continue;
      const box = view.box();
      if (!this.plane.intersectsBox(box) || !view.shape.closed) continue;
      for (const material of [this.backs, this.fronts]) this.addCounter(view, material, order);
      this.addCap(box, parts.palette[view.part.material].color, order + 0.5);
      order++;
    }
  }

  /** @param {import("./parts.js").PartView} view @param {MeshBasicMaterial} material @param {number} order */
  addCounter(view, material, order) {
    const { surface } = view.shape;
    const mesh = new Mesh(surface, surface.groups.length ? surface.groups.map(() => material) : material);
    mesh.matrixAutoUpdate = false;
    mesh.matrix.copy(view.group.matrix);
    mesh.renderOrder = order;
    this.group.add(mesh);
  }

  /** @param {import("three").Box3} box @param {import("./engine.js").Triple} color @param {number} order */
  addCap(box, color, order) {
    const cap = new Mesh(this.square, this.capMaterial(color));
    const center = box.getCenter(new Vector3());
    this.plane.projectPoint(center, cap.position);
    cap.lookAt(cap.position.clone().add(this.plane.normal));
    cap.scale.setScalar(2.01 * box.getSize(new Vector3()).length());
    cap.renderOrder = order;
    this.group.add(cap);
  }

  /** Hatched in the color of the material. @param {import("./engine.js").Triple} color */
  capMaterial(color) {
    const key = color.join();
    this.used.add(key);
    let material = this.caps.get(key);
    if (!material) {
      material = new ShaderMaterial({
        uniforms: { color: { value: new Color().setRGB(...color) } },
        vertexShader: "void main() { gl_Position = projectionMatrix * modelViewMatrix * vec4( position, 1.0 ); }",
        fragmentShader: `uniform vec3 color;
          void main() {
            float light = dot( color, vec3( 0.2126, 0.7152, 0.0722 ) );
            vec3 ink = mix( color, vec3( light > 0.2 ? 0.0 : 0.6 ), 0.45 ), paper = mix( color, vec3( 0.8 ), 0.25 );
            float line = abs( fract( ( gl_FragCoord.x + gl_FragCoord.y ) / 10.0 ) - 0.5 ) * 10.0;
            gl_FragColor = vec4( mix( ink, paper, smoothstep( 0.3, 1.3, line ) ), 1.0 );
            #include <colorspace_fragment>
          }`,
        side: DoubleSide, stencilWrite: true, stencilRef: 0, stencilFunc: NotEqualStencilFunc, stencilFail: ReplaceStencilOp,
        stencilZFail: ReplaceStencilOp, stencilZPass: ReplaceStencilOp, toneMapped: false,
      });
      this.caps.set(key, material);
    }
    return material;
  }
}
