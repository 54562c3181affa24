// Handles: buttons over the picture, at points in space, that are dragged along a line, in a plane, or parallel to the picture.
//
// A handle knows where it is and how a move changes what it stands for. The section plane has one on a line; points of the script have those that
// move freely.

import { Plane, Vector3 } from "three";
import { h } from "./dom.js";
import { rayThrough } from "./picking.js";

/**
 * @typedef {object} HandleOptions
 * @property {string} label
 * @property {() => { at: Vector3, along: Vector3 } | null} place  where the handle is, and the unit vector of its line; null: hidden
 * @property {(mm: number, dragging: boolean) => void} move  by a length along the line, since the last call
 * @property {() => void} drop  the drag has ended
 *
 * @typedef {object} FreeHandleOptions
 * @property {() => Vector3} at
 * @property {() => Vector3 | null} normal  of the plane that it moves in; null: parallel to the picture
 * @property {() => boolean} begin  a drag begins; false: it cannot
 * @property {(target: Vector3) => void} move
 * @property {(canceled: boolean) => void} drop  the drag has ended
 * @property {(on: boolean) => void} point  the pointer or the focus is on it, or has left it
 */

const KEY_PIXELS = 4; // that an arrow key moves
const CLICK = 2; // pixels from where a drag begins
// Seen from the side, a plane is not followed: the least sine of the angle between it and the line of sight.
const FLATTEST = 0.08;
/** @type {Record<string, [number, number]>} */
const ARROWS = { ArrowUp: [0, -1], ArrowRight: [1, 0], ArrowDown: [0, 1], ArrowLeft: [-1, 0] };

export class Handles {
  /** @param {HTMLElement} host @param {import("./view.js").View} view */
  constructor(host, view) {
    this.host = host;
    this.view = view;
    /** @type {Map<HTMLButtonElement, HandleOptions>} */
    this.handles = new Map();
    /** @type {Map<HTMLButtonElement, FreeHandleOptions>} */
    this.free = new Map();
    view.drawn.on(() => this.update());
  }

  /** @param {HandleOptions} options */
  add(options) {
    const button = h("button", { type: "button", class: "handle", "aria-label": options.label, title: options.label, hidden: true });
    /** @type {{ x: number, y: number } | null} */
    let last = null;
    button.addEventListener("pointerdown", (e) => {
      last = { x: e.clientX, y: e.clientY };
      button.setPointerCapture(e.pointerId);
    });
    button.addEventListener("pointermove", (e) => {
      if (!last) return;
      this.shift(options, e.clientX - last.x, e.clientY - last.y, true);
      last = { x: e.clientX, y: e.clientY };
    });
    for (const end of ["pointerup", "pointercancel"])
      button.addEventListener(end, () => {
        if (last) options.drop();
        last = null;
      });
    button.addEventListener("keydown", (e) => {
      const arrow = ARROWS[e.key];
      if (!arrow) return;
      e.preventDefault();
      e.stopPropagation(); // arrows turn the view where no handle has the focus
      options.move((arrow[0] - arrow[1]) * KEY_PIXELS * this.view.pixel, false);
      options.drop();
    });
    this.handles.set(button, options);
    this.host.append(button);
  }

  /** Moves a handle by the part of a drag that is along its line in the picture. @param {HandleOptions} options @param {number} dx @param {number} dy @param {boolean} dragging */
  shift(options, dx, dy, dragging) {
    const line = this.lineInPicture(options);
    if (!line) return;
    const square = line.x * line.x + line.y * line.y;
    // A line that points at the viewer cannot be followed.
    if (square > 1e-3 / this.view.pixel ** 2) options.move((dx * line.x + dy * line.y) / square, dragging);
  }

  /** The pixels of a millimeter along the line. @param {HandleOptions} options */
  lineInPicture(options) {
    const place = options.place();
    if (!place) return null;
    const length = 10 * this.view.pixel;
    const a = this.view.project(place.at), b = this.view.project(place.at.clone().addScaledVector(place.along, length));
    return a && b ? { x: (b.x - a.x) / length, y: (b.y - a.y) / length, at: a } : null;
  }

  /** A handle that moves in a plane or parallel to the picture. @param {FreeHandleOptions} options @returns {HTMLButtonElement} */
  addFree(options) {
    const button = h("button", { type: "button", class: "handle point", hidden: true });
    this.free.set(button, options);
    this.host.append(button);
    new FreeDrag(this.view, button, options);
    for (const on of ["pointerenter", "focus"]) button.addEventListener(on, () => options.point(true));
    for (const off of ["pointerleave", "blur"]) button.addEventListener(off, () => options.point(button.matches(":hover") || document.activeElement === button));
    return button;
  }

  /** @param {HTMLButtonElement} button */
  remove(button) {
    this.free.delete(button);
    button.remove();
  }

  update() {
    for (const [button, options] of this.handles) {
      const line = this.lineInPicture(options);
      button.hidden = line === null;
      if (line) button.style.transform = `translate(${line.at.x.toFixed(1)}px, ${line.at.y.toFixed(1)}px) translate(-50%, -50%) rotate(${Math.atan2(line.y, line.x).toFixed(3)}rad)`;
    }
    for (const [button, options] of this.free) {
      const at = this.view.project(options.at());
      button.hidden = at === null;
      if (at) button.style.transform = `translate(${at.x.toFixed(1)}px, ${at.y.toFixed(1)}px) translate(-50%, -50%)`;
    }
  }
}

// One drag after the other of one handle, by the pointer or by arrow keys. Escape takes it back.
class FreeDrag {
  /** @param {import("./view.js").View} view @param {HTMLButtonElement} button @param {FreeHandleOptions} options */
  constructor(view, button, options) {
    this.view = view;
    this.options = options;
    /** Where the pointer is, where the drag began, and the pixel of the handle then. @type {{ from: Vector3, x: number, y: number, moved: boolean, keys: boolean } | null} */
    this.drag = null;
    this.last = { x: 0, y: 0 };
    button.addEventListener("pointerdown", (e) => {
      if (e.button !== 0) return;
      this.end(false);
      if (e.isTrusted) button.setPointerCapture(e.pointerId);
      this.last = { x: e.clientX, y: e.clientY };
      this.begin(false);
    });
    button.addEventListener("pointermove", (e) => this.follow(e));
    button.addEventListener("pointerup", (e) => {
      this.follow(e);
      this.end(false);
    });
    button.addEventListener("pointercancel", () => this.end(true));
    button.addEventListener("blur", () => this.drag?.keys && this.end(false));
    button.addEventListener("keydown", (e) => this.key(e));
    button.addEventListener("keyup", (e) => e.key in ARROWS && this.drag?.keys && this.end(false));
  }

  /** @param {PointerEvent} e */
  follow(e) {
    if (!this.drag || this.drag.keys) return;
    const dx = e.clientX - this.last.x, dy = e.clientY - this.last.y;
    if (this.drag.moved ? dx === 0 && dy === 0 : Math.hypot(dx, dy) < CLICK) return;
    this.last = { x: e.clientX, y: e.clientY };
    this.step(dx, dy);
  }

  /** @param {KeyboardEvent} e */
  key(e) {
    const arrow = ARROWS[e.key];
    if (e.ctrlKey || e.metaKey || e.altKey || !(arrow || (e.key === "Escape" && this.drag))) return;
    e.preventDefault();
    e.stopPropagation(); // arrows turn the view where no handle has the focus
    if (!arrow) return this.end(true);
    if (!this.drag) this.begin(true);
    this.step(arrow[0] * KEY_PIXELS, arrow[1] * KEY_PIXELS);
  }

  /** @param {boolean} keys */
  begin(keys) {
    const from = this.options.at(), pixel = this.view.project(from);
    if (pixel && this.options.begin()) this.drag = { from: from.clone(), x: pixel.x, y: pixel.y, moved: false, keys };
  }

  /** @param {number} dx @param {number} dy */
  step(dx, dy) {
    if (!this.drag) return;
    this.drag.moved = true;
    this.drag.x += dx;
    this.drag.y += dy;
    const target = this.target();
    if (target) this.options.move(target);
  }

  /** The point of the plane under the handle's pixel. @returns {Vector3 | null} */
  target() {
    const { view, drag } = this;
    if (!drag) return null;
    const ray = rayThrough(view.sight, drag.x, drag.y), normal = this.options.normal();
    const followed = normal && Math.abs(normal.dot(ray.direction)) > FLATTEST ? normal : view.orbit.direction();
    return ray.intersectPlane(new Plane().setFromNormalAndCoplanarPoint(followed, drag.from), new Vector3());
  }

  /** @param {boolean} canceled */
  end(canceled) {
    if (!this.drag) return;
    this.drag = null;
    this.options.drop(canceled);
  }
}
