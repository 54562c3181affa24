// The view: where the camera is, and how it moves. Z is up, lengths are in mm, angles in radians.
//
// The camera looks at `target` from the direction given by azimuth and elevation, at `distance`. Without perspective, the picture is as large
// as things at the target are with it: `distance` then determines the scale only.

import { Matrix4, OrthographicCamera, PerspectiveCamera, Vector3 } from "three";

export const STANDARD_VIEWS = /** @type {const} */ (["front", "back", "left", "right", "top", "bottom", "iso"]);
/** @typedef {typeof STANDARD_VIEWS[number]} StandardView */

/** Azimuth and elevation in degrees. Azimuth 0 is seen from the front, from -Y. @type {Record<StandardView, [number, number]>} */
const DIRECTIONS = { front: [0, 0], back: [180, 0], left: [-90, 0], right: [90, 0], top: [0, 90], bottom: [0, -90], iso: [45, 35.264] };

const RADIANS = Math.PI / 180;
const FOV = 30 * RADIANS; // vertical, where no camera sets it
const MARGIN = 1.08; // around what fills the picture
const NEAREST = 0.001, FARTHEST = 1000; // distances, in sizes of the scene

export class Orbit {
  constructor() {
    this.target = new Vector3();
    this.distance = 100;
    this.azimuth = 45 * RADIANS;
    this.elevation = 35 * RADIANS;
    this.roll = 0;
    this.fov = FOV; // vertical
    this.orthographic = false;
    this.perspective = new PerspectiveCamera();
    this.parallel = new OrthographicCamera();
    this.low = new Vector3(-50, -50, 0); // bounds of the scene
    this.high = new Vector3(50, 50, 50);
    this.reach = 0; // how far from the bounds something is still drawn, such as a ground
  }

  /** Half of the diagonal of the scene's bounds. */
  get radius() {
    return Math.max(this.low.distanceTo(this.high) / 2, 1e-6);
  }

  /** From the target to the camera. */
  direction() {
    const level = Math.cos(this.elevation);
    return new Vector3(level * Math.sin(this.azimuth), -level * Math.cos(this.azimuth), Math.sin(this.elevation));
  }

  /** The directions in the picture. @returns {{ right: Vector3, up: Vector3, back: Vector3 }} */
  axes() {
    const back = this.direction();
    const level = new Vector3(Math.cos(this.azimuth), Math.sin(this.azimuth), 0);
    const straight = back.clone().cross(level);
    const c = Math.cos(this.roll), s = Math.sin(this.roll);
    const right = level.clone().multiplyScalar(c).addScaledVector(straight, s);
    return { right, up: back.clone().cross(right), back };
  }

  eye() {
    return this.target.clone().addScaledVector(this.direction(), this.distance);
  }

  /** Half the height of the picture at the target, mm. */
  get halfHeight() {
    return this.distance * Math.tan(this.fov / 2);
  }

  /** The camera for a picture with this ratio of width to height. @param {number} aspect */
  camera(aspect) {
    const { right, up, back } = this.axes();
    const camera = this.orthographic ? this.parallel : this.perspective;
    const center = this.low.clone().add(this.high).multiplyScalar(0.5);
    // Without perspective the camera stands in front of everything.
    const distance = this.orthographic ? Math.max(this.distance, 4 * this.radius + this.target.distanceTo(center)) : this.distance;
    camera.position.copy(this.target).addScaledVector(back, distance);
    camera.quaternion.setFromRotationMatrix(new Matrix4().makeBasis(right, up, back));
    const middle = camera.position.clone().sub(center).dot(back);
    const radius = this.radius * 1.1;
    if (camera instanceof OrthographicCamera) {
      const half = this.halfHeight;
      Object.assign(camera, { left: -half * aspect, right: half * aspect, top: half, bottom: -half });
      // The grid reaches behind the camera.
      camera.near = -Math.max(this.reach, 20 * half);
      camera.far = middle + radius - camera.near;
    } else {
      camera.fov = this.fov / RADIANS;
      camera.aspect = aspect;
      // Grid and ground reach up to the camera. With 24 bits, depths at the target differ from 3e-6 of the distance on.
      camera.near = this.distance * 0.02;
      camera.far = Math.max(middle + radius, camera.near * 2) + Math.max(this.reach, 40 * this.distance);
    }
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld();
    return camera;
  }

  /** Turns by angles. @param {number} right @param {number} up */
  turn(right, up) {
    this.azimuth += right;
    this.elevation = Math.min(Math.PI / 2, Math.max(-Math.PI / 2, this.elevation + up));
    this.roll = 0;
  }

  /** Moves what is seen by parts of half the picture's height. @param {number} right @param {number} up */
  pan(right, up) {
    const axes = this.axes();
    this.target.addScaledVector(axes.right, -right * this.halfHeight).addScaledVector(axes.up, -up * this.halfHeight);
  }

  /** Scales the picture about a point that keeps its place. @param {number} factor @param {Vector3} about */
  zoom(factor, about) {
    const distance = Math.min(FARTHEST * this.radius, Math.max(NEAREST * this.radius, this.distance / factor));
    const kept = distance / this.distance;
    // Eye and target move alike towards the point.
    this.target.lerp(about, 1 - kept);
    this.distance = distance;
  }

  /**
   * Moves the camera, without turning it, so that a box fills the picture.
   *
   * @param {Vector3} low
   * @param {Vector3} high
   * @param {number} aspect
   * @param {number} free  the part of the height that nothing covers
   */
  fit(low, high, aspect, free) {
    const { right, up, back } = this.axes(), center = low.clone().add(high).multiplyScalar(0.5);
    const slope = Math.tan(this.fov / 2) / MARGIN;
    let distance = 0, half = 0;
    for (let i = 0; i < 8; i++) {
      const corner = new Vector3(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z).sub(center);
      const size = Math.max(Math.abs(corner.dot(up)) / free, Math.abs(corner.dot(right)) / aspect);
      half = Math.max(half, size);
      distance = Math.max(distance, size / slope + corner.dot(back));
    }
    this.target.copy(center);
    this.distance = Math.max(this.orthographic ? half / slope : distance, 1e-6);
  }

  /** @param {StandardView} view */
  look(view) {
    [this.azimuth, this.elevation] = DIRECTIONS[view].map((x) => x * RADIANS);
    this.roll = 0;
  }

  /** Looks through a camera of the script, whose picture is seen whole. @param {import("./engine.js").SceneCamera} camera @param {number} aspect */
  through(camera, aspect) {
    const target = new Vector3(...camera.target), eye = new Vector3(...camera.eye);
    const back = eye.clone().sub(target), distance = back.length();
    back.divideScalar(distance);
    this.elevation = Math.asin(Math.min(1, Math.max(-1, back.z)));
    // Straight from above, what is up in the picture tells the azimuth.
    const level = Math.hypot(back.x, back.y) > 1e-6;
    const up = new Vector3(...camera.up);
    this.azimuth = level ? Math.atan2(back.x, -back.y) : Math.atan2(-up.x * Math.sign(back.z), up.y * Math.sign(back.z));
    this.roll = 0;
    const axes = this.axes();
    if (level) this.roll = Math.atan2(-up.dot(axes.right), up.dot(axes.up));
    const shape = camera.size[0] / camera.size[1];
    // Whichever of width and height would be cut off fills the page.
    const widen = Math.max(1, shape / aspect) / shape;
    this.target.copy(target);
    this.orthographic = camera.width !== null && camera.width > 0;
    if (this.orthographic) {
      this.fov = FOV;
      this.distance = ((camera.width ?? 1) / 2) * widen / Math.tan(FOV / 2);
    } else {
      this.fov = 2 * Math.atan(Math.tan(((camera.fov ?? 30) * RADIANS) / 2) * widen);
      this.distance = distance;
    }
  }

  /** The camera as the renderer takes it. @param {number} aspect @returns {{ eye: number[], target: number[], up: number[], fov?: number, width?: number }} */
  description(aspect) {
    const eye = this.eye().toArray(), target = this.target.toArray(), up = this.axes().up.toArray();
    if (this.orthographic) return { eye, target, up, width: 2 * this.halfHeight * aspect };
    return { eye, target, up, fov: (2 * Math.atan(Math.tan(this.fov / 2) * aspect)) / RADIANS };
  }
}
