// The picture: what is drawn, and when. Nothing is drawn unless something changed.

import {
  Box3, Color, CustomToneMapping, DirectionalLight, Euler, Group, Mesh, PCFShadowMap, PlaneGeometry, Scene, Sphere, SpotLight, Vector2, Vector3, WebGLRenderer,
} from "three";
import { Grid } from "./grid.js";
import { Orbit } from "./orbit.js";
import { Outline } from "./outline.js";
import { Parts } from "./parts.js";
import { pick, pickFeature, rayThrough } from "./picking.js";
import { Section } from "./section.js";
import { Backdrop, makeEnvironment, makeLights, makeMaterial } from "./shading.js";
import { Topic } from "./topic.js";

/** @typedef {import("./engine.js").SceneMessage} SceneMessage */

const MOST_PIXEL_RATIO = 2;
const TOOLBAR_GAP = 8; // pixels around the toolbar
const GROUND_SIZES = 60; // side of an unbounded ground, in radii of the scene

// The names of renderers that have no graphics processor.
const SOFTWARE = /swiftshader|llvmpipe|softpipe|software|basic render/i;

/** Where there is no graphics processor, pictures have no shadows and no smooth edges. @param {HTMLCanvasElement} canvas */
function makeContext(canvas) {
  const probe = new OffscreenCanvas(1, 1).getContext("webgl2");
  const fast = probe !== null && !SOFTWARE.test(rendererName(probe));
  probe?.getExtension("WEBGL_lose_context")?.loseContext();
  const context = canvas.getContext("webgl2", { alpha: false, depth: true, stencil: true, antialias: fast });
  if (!context) throw new Error("This browser has no WebGL 2, which the scene needs.");
  return { context, fast };
}

/** @param {WebGL2RenderingContext} context @returns {string} */
function rendererName(context) {
  const info = context.getExtension("WEBGL_debug_renderer_info");
  return String(context.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : context.RENDERER));
}

/** The color of a CSS variable. @param {string} name */
function themeColor(name) {
  return new Color(getComputedStyle(document.documentElement).getPropertyValue(name).trim());
}

/** A color that is seen on another. @param {Color} paper */
function inkOn(paper) {
  const light = 0.2126 * paper.r + 0.7152 * paper.g + 0.0722 * paper.b;
  return new Color().setScalar(light > 0.2 ? 0.08 : 0.6);
}

export class View {
  /** @param {HTMLCanvasElement} canvas @param {(id: string) => Promise<ArrayBuffer>} loadMesh */
  constructor(canvas, loadMesh) {
    this.canvas = canvas;
    const { context, fast } = makeContext(canvas);
    this.renderer = new WebGLRenderer({ canvas, context });
    // To check shaders, the page would wait until they are compiled.
    this.renderer.debug.checkShaderErrors = false;
    this.renderer.toneMapping = CustomToneMapping;
    this.renderer.localClippingEnabled = true;
    this.renderer.autoClear = false;
    this.renderer.shadowMap.type = PCFShadowMap;
    this.renderer.shadowMap.autoUpdate = false;
    this.scene = new Scene();
    this.scene.environmentRotation = new Euler(Math.PI / 2, 0, 0);
    this.orbit = new Orbit();
    this.parts = new Parts(loadMesh);
    this.section = new Section();
    this.section.share(this.parts.clipping);
    this.grid = new Grid();
    this.outline = new Outline();
    this.backdrop = new Backdrop();
    this.lights = new Group();
    /** @type {Mesh<PlaneGeometry, import("three").Material>[]} */
    this.grounds = [];
    this.scene.add(this.grid.mesh, this.backdrop.mesh, this.parts.group, this.section.group, this.lights);
    this.stage = { grid: true, backdrop: true, shadows: fast };
    /** @type {SceneMessage | null} */
    this.message = null;
    this.hasBackdrop = false;
    this.skyKey = this.stageKey = ""; // what sky, lights, and grounds are made of
    /** @type {string[]} */
    this.selected = [];
    /** @type {string[]} */
    this.pointed = [];
    /** Parts of surfaces that are outlined like what is pointed at: faces, and ghosts. @type {import("./faces.js").Piece[]} */
    this.faces = [];
    /** @type {import("./faces.js").Piece[]} */
    this.ghosts = [];
    /** The camera of the script that is looked through. @type {string | null} */
    this.following = null;
    /** @type {Topic<View>} after each picture */
    this.drawn = new Topic();
    this.due = false;
    this.width = this.height = 1;
    this.camera = this.orbit.camera(1);
    new ResizeObserver(() => this.invalidate()).observe(/** @type {Element} */ (canvas.parentElement));
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.invalidate());
    canvas.addEventListener("webglcontextrestored", () => this.invalidate());
  }

  get aspect() {
    return this.width / this.height;
  }

  /** The size of a pixel at the target, mm. */
  get pixel() {
    return (2 * this.orbit.halfHeight) / this.height;
  }

  /** The size of a pixel at a point, mm. @param {Vector3} at */
  pixelAt(at) {
    const { orbit, height } = this;
    const distance = orbit.orthographic ? orbit.distance : orbit.eye().sub(at).dot(orbit.direction());
    return (2 * distance * Math.tan(orbit.fov / 2)) / height;
  }

  /** Draws soon. */
  invalidate() {
    if (this.due) return;
    this.due = true;
    requestAnimationFrame(() => {
      if (this.due) this.draw();
    });
  }

  draw() {
    this.due = false;
    this.resize();
    this.render();
    this.drawn.emit(this);
  }

  resize() {
    const host = /** @type {HTMLElement} */ (this.canvas.parentElement);
    const width = Math.max(1, host.clientWidth), height = Math.max(1, host.clientHeight), ratio = Math.min(devicePixelRatio, MOST_PIXEL_RATIO);
    if (width === this.width && height === this.height && ratio === this.renderer.getPixelRatio()) return;
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(width, height, false);
    const before = this.aspect;
    this.width = width;
    this.height = height;
    if (this.following !== null && before !== this.aspect) this.follow();
  }

  render() {
    const { renderer, orbit, grid } = this;
    this.camera = orbit.camera(this.aspect);
    this.backdrop.mesh.visible = this.hasBackdrop && this.stage.backdrop;
    for (const ground of this.grounds) ground.visible = this.stage.backdrop && this.message?.drawing !== true;
    grid.mesh.visible = this.stage.grid;
    // The colors of a drawing are made for its paper.
    const paper = this.message?.drawing && this.stage.backdrop ? (this.message.background ?? [1, 1, 1]) : null;
    const ground = paper ? new Color().setRGB(...paper) : themeColor("--canvas");
    if (grid.mesh.visible) grid.update(orbit, this.pixel, paper ? inkOn(ground) : themeColor("--ink"));
    renderer.setClearColor(ground, 1);
    renderer.clear();
    renderer.render(this.scene, this.camera);
    const views = (/** @type {string[]} */ names) => names.flatMap((n) => this.parts.views.get(n) ?? []);
    const selected = views(this.selected), pointed = views(this.pointed.filter((n) => !this.selected.includes(n)));
    this.outline.material.uniforms.picked.value.copy(themeColor("--accent"));
    this.outline.material.uniforms.pointed.value.copy(themeColor("--hint"));
    this.outline.render(renderer, this.camera, selected, [...pointed, ...this.faces, ...this.ghosts], this.parts.clipping);
  }

  /** @param {string} name  of a CSS variable */
  color(name) {
    return themeColor(name);
  }

  /** A picture as shown, in `scale` times as many pixels. @param {number} scale @returns {Promise<Blob>} */
  picture(scale) {
    const ratio = this.renderer.getPixelRatio();
    this.renderer.setPixelRatio(ratio * scale);
    this.renderer.setSize(this.width, this.height, false);
    this.render();
    // The pixels must be read before the browser shows them.
    const picture = new Promise((/** @type {(blob: Blob) => void} */ done, fail) =>
      this.canvas.toBlob((blob) => (blob ? done(blob) : fail(new Error("cannot make the picture"))), "image/png"));
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(this.width, this.height, false);
    this.draw();
    return picture;
  }

  /**
   * Shows a scene whose meshes are loaded.
   *
   * @param {SceneMessage} scene
   * @param {import("./parts.js").Shape[]} shapes
   */
  show(scene, shapes) {
    const first = this.message === null;
    this.message = scene;
    this.parts.show(scene, shapes);
    this.setBounds();
    this.setStage(scene);
    this.changed();
    // A scene that was set up as a picture is shown as one.
    if (first) this.stage.grid = scene.studio || scene.drawing;
    if (first) this.open(scene);
    else if (this.following !== null) this.follow();
    this.invalidate();
  }

  /** Parts were changed, moved, or hidden. */
  changed() {
    this.section.update(this.parts);
    this.renderer.shadowMap.enabled = this.stage.shadows && this.message?.drawing !== true;
    this.renderer.shadowMap.needsUpdate = true;
    this.invalidate();
  }

  setBounds() {
    const box = this.parts.bounds();
    if (box.isEmpty()) box.setFromCenterAndSize(new Vector3(), new Vector3(100, 100, 100));
    this.orbit.low.copy(box.min);
    this.orbit.high.copy(box.max);
  }

  /** Lights, sky, and grounds. They are kept if they did not change. @param {SceneMessage} scene */
  setStage(scene) {
    const { lights, sky, background, grounds, studio, materials } = scene, { low, high } = this.orbit;
    const skyKey = JSON.stringify([sky, background, studio]);
    if (skyKey !== this.skyKey) {
      this.skyKey = skyKey;
      this.scene.environment?.dispose();
      this.scene.environment = makeEnvironment(scene);
      // The sky and the floor of the studio are for pictures; the page has its own background.
      this.hasBackdrop = this.backdrop.show(scene) && !studio;
    }
    const key = JSON.stringify([lights, grounds, studio, grounds.map((g) => materials[g.material]), low, high]);
    if (key === this.stageKey) return;
    this.stageKey = key;
    this.scene.remove(this.lights, ...this.grounds);
    for (const light of this.lights.children) if (light instanceof SpotLight || light instanceof DirectionalLight) light.dispose();
    for (const ground of this.grounds) {
      ground.geometry.dispose();
      ground.material.dispose();
    }
    this.lights = makeLights(scene, new Sphere().setFromPoints([low, high]));
    this.grounds = studio ? [] : grounds.map((g) => this.makeGround(scene, g));
    this.orbit.reach = this.grounds.length ? GROUND_SIZES * this.orbit.radius : 0;
    this.scene.add(this.lights, ...this.grounds);
  }

  /** @param {SceneMessage} scene @param {import("./engine.js").Ground} ground */
  makeGround(scene, ground) {
    const size = ground.size ?? GROUND_SIZES * this.orbit.radius;
    const material = makeMaterial(scene.materials[ground.material], { glass: false, flat: false, thickness: 0, oneSided: true });
    material.polygonOffsetFactor = material.polygonOffsetUnits = 2;
    const mesh = new Mesh(new PlaneGeometry(size, size), material);
    mesh.position.z = ground.z;
    mesh.receiveShadow = true;
    return mesh;
  }

  /** The first view of a scene. @param {SceneMessage} scene */
  open(scene) {
    this.resize();
    const camera = scene.cameras[0];
    if (scene.drawing) {
      this.look("top");
      this.orbit.orthographic = true;
      this.fit();
    } else if (camera && !camera.automatic) this.through(camera.name);
    else {
      if (camera) this.orbit.through(camera, this.aspect);
      this.fit();
    }
  }

  /** Fills the picture with what is visible, or with some parts. @param {string[]} [names] */
  fit(names = []) {
    const box = new Box3();
    for (const name of names) {
      const view = this.parts.views.get(name);
      if (view) box.union(view.box());
    }
    if (box.isEmpty()) box.set(this.orbit.low.clone(), this.orbit.high.clone());
    this.following = null;
    for (const label of names.length ? [] : (this.message?.labels ?? [])) box.expandByPoint(new Vector3(...label.at));
    // What is fitted is in the middle, below the toolbar.
    const toolbar = this.canvas.parentElement?.querySelector("[role=toolbar]");
    const covered = (toolbar?.clientHeight ?? 0) + TOOLBAR_GAP;
    this.orbit.fit(box.min, box.max, this.aspect, Math.max(0.5, 1 - (2 * covered) / this.height));
    this.invalidate();
  }

  /** @param {import("./orbit.js").StandardView} view */
  look(view) {
    this.following = null;
    this.orbit.look(view);
    this.invalidate();
  }

  /** Looks through a camera of the script, and follows it until the view is moved. @param {string} name */
  through(name) {
    this.following = name;
    this.follow();
  }

  follow() {
    const camera = this.message?.cameras.find((c) => c.name === this.following);
    if (!camera) this.following = null;
    else this.orbit.through(camera, this.aspect);
    this.invalidate();
  }

  /** @returns {import("./picking.js").Sight} */
  get sight() {
    return { camera: this.camera, width: this.width, height: this.height, parts: this.parts, section: this.section };
  }

  /** @param {number} x @param {number} y  pixels */
  pick(x, y) {
    return pick(this.sight, x, y);
  }

  /** @param {number} x @param {number} y */
  pickFeature(x, y) {
    return pickFeature(this.sight, x, y);
  }

  /** The point under a pixel, or at the depth of the target if nothing is there. @param {number} x @param {number} y */
  pointAt(x, y) {
    const hit = this.pick(x, y);
    if (hit) return hit.point;
    const ray = rayThrough(this.sight, x, y), back = this.orbit.direction();
    const t = this.orbit.target.clone().sub(ray.origin).dot(back) / ray.direction.dot(back);
    return ray.at(t, new Vector3());
  }

  /** The pixel of a point, or null behind the camera. @param {Vector3} p */
  project(p) {
    const q = p.clone().project(this.camera);
    if (q.z > 1 || q.z < -1) return null;
    return new Vector2(((q.x + 1) / 2) * this.width, ((1 - q.y) / 2) * this.height);
  }
}
