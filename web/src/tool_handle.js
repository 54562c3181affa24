// The handle of a robot's tool: a button that moves it parallel to the screen, with a ring that turns it about the line of sight. With Shift,
// the button turns it about the directions in the picture.

import { Matrix4, Plane, Vector3 } from "three";
import { h, svg } from "./dom.js";
import { rayThrough } from "./picking.js";

const KEY_PIXELS = 4; // that an arrow key moves
const TURN = 0.5 * (Math.PI / 180); // of a pixel, with Shift
const KEY_TURN = 2 * (Math.PI / 180); // of an arrow key with Shift
const RING = 27; // pixels, its radius

/**
 * A frame is 3 rows of 4.
 *
 * @typedef {object} ToolHandleOptions
 * @property {() => number[] | null} tool  its frame; null: hidden
 * @property {() => number[] | null} aimed  the frame that it is on its way to; null: it is there
 * @property {(target: number[], turning: boolean) => void} aim  brings the tool to a frame
 * @property {() => void} drop  the drag has ended
 * @property {() => void} cancel  the drag was given up
 * @property {() => void} entered  the pointer is on the handle
 *
 * @typedef {object} Drag
 * @property {"move" | "turn" | "ring"} kind
 * @property {number[]} from  the frame of the tool when the drag began
 * @property {number} x  where the pointer was then, in pixels of the scene
 * @property {number} y
 * @property {Vector3} grabbed  the point under it, at the depth of the tool
 */

/** @param {number[]} frame */
const originOf = (frame) => new Vector3(frame[3], frame[7], frame[11]);

/** @param {number[]} frame @param {Vector3} by */
export function movedFrame(frame, by) {
  const out = [...frame];
  out[3] += by.x;
  out[7] += by.y;
  out[11] += by.z;
  return out;
}

/** Turns a frame about its origin. @param {number[]} frame @param {Matrix4} turn */
export function turnedFrame(frame, turn) {
  const out = [...frame], e = turn.elements;
  for (let k = 0; k < 3; k++)
    for (let i = 0; i < 3; i++) out[4 * i + k] = e[i] * frame[k] + e[4 + i] * frame[4 + k] + e[8 + i] * frame[8 + k];
  return out;
}

export class ToolHandle {
  /** @param {HTMLElement} host @param {import("./view.js").View} view @param {ToolHandleOptions} options */
  constructor(host, view, options) {
    this.host = host;
    this.view = view;
    this.options = options;
    /** @type {Drag | null} */
    this.drag = null;
    /** Where the tool should be, while it is elsewhere. @type {number[] | null} */
    this.missed = null;
    const label = "Move the tool; with Shift, or by the ring, turn it";
    this.ring = svg("svg", { class: "tool-ring", viewBox: "-32 -32 64 64", "aria-hidden": "true" }, svg("circle", { r: RING, class: "line" }), svg("circle", { r: RING, class: "grip" }));
    this.button = h("button", { type: "button", class: "tool-handle", "aria-label": label, title: label });
    this.line = svg("line", {});
    this.gap = svg("svg", { class: "tool-gap", "aria-hidden": "true" }, this.line);
    host.append(this.gap, this.ring, this.button);
    const kind = (/** @type {PointerEvent} */ e) => (e.shiftKey ? "turn" : "move");
    this.listen(this.button, kind);
    this.listen(/** @type {SVGElement} */ (this.ring.lastElementChild), () => "ring");
    this.button.addEventListener("keydown", (e) => this.key(e));
    view.drawn.on(() => this.update());
  }

  /** @param {HTMLElement | SVGElement} element @param {(e: PointerEvent) => Drag["kind"]} kindOf */
  listen(element, kindOf) {
    element.addEventListener("pointerdown", (event) => {
      const e = /** @type {PointerEvent} */ (event), from = this.options.tool(), p = this.place(e);
      if (!from || e.button !== 0) return;
      const grabbed = this.onScreenPlane(originOf(from), p.x, p.y);
      if (!grabbed) return;
      e.stopPropagation();
      this.drag = { kind: kindOf(e), from, ...p, grabbed };
      element.setPointerCapture(e.pointerId);
    });
    element.addEventListener("pointerenter", () => this.options.entered());
    element.addEventListener("pointermove", (event) => {
      event.stopPropagation(); // what is behind is not pointed at
      if (!this.drag) return;
      const target = this.target(this.drag, this.place(/** @type {PointerEvent} */ (event)));
      if (target) this.options.aim(target, this.drag.kind !== "move");
    });
    for (const end of ["pointerup", "pointercancel"])
      element.addEventListener(end, () => {
        if (!this.drag) return;
        this.drag = null;
        if (end === "pointerup") this.options.drop();
        else this.options.cancel();
      });
  }

  /** Gives up a drag. Returns whether there was one. */
  cancel() {
    if (!this.drag) return false;
    this.drag = null;
    this.options.cancel();
    return true;
  }

  /** The pixel of an event in the scene. @param {PointerEvent} e */
  place(e) {
    const box = this.host.getBoundingClientRect();
    return { x: e.clientX - box.left, y: e.clientY - box.top };
  }

  /** The point under a pixel, at the depth of another point. @param {Vector3} depth @param {number} x @param {number} y */
  onScreenPlane(depth, x, y) {
    const plane = new Plane().setFromNormalAndCoplanarPoint(this.view.orbit.direction(), depth);
    return rayThrough(this.view.sight, x, y).intersectPlane(plane, new Vector3());
  }

  /** @param {Drag} drag @param {{ x: number, y: number }} p @returns {number[] | null} */
  target(drag, p) {
    const { right, up, back } = this.view.orbit.axes(), center = this.view.project(originOf(drag.from));
    if (drag.kind === "move") {
      const point = this.onScreenPlane(drag.grabbed, p.x, p.y);
      return point && movedFrame(drag.from, point.sub(drag.grabbed));
    }
    if (drag.kind === "ring") {
      if (!center) return null;
      // Angles in the picture run clockwise, because its y axis points down.
      const angle = Math.atan2(drag.y - center.y, drag.x - center.x) - Math.atan2(p.y - center.y, p.x - center.x);
      return turnedFrame(drag.from, new Matrix4().makeRotationAxis(back, angle));
    }
    const turn = new Matrix4().makeRotationAxis(up, (p.x - drag.x) * TURN);
    return turnedFrame(drag.from, turn.multiply(new Matrix4().makeRotationAxis(right, (p.y - drag.y) * TURN)));
  }

  /** @param {KeyboardEvent} e */
  key(e) {
    const [x, y] = { ArrowUp: [0, 1], ArrowRight: [1, 0], ArrowDown: [0, -1], ArrowLeft: [-1, 0] }[e.key] ?? [0, 0];
    const from = this.options.aimed() ?? this.options.tool();
    if ((!x && !y) || !from || e.ctrlKey || e.altKey || e.metaKey) return;
    e.preventDefault();
    e.stopPropagation();
    const { right, up } = this.view.orbit.axes(), step = KEY_PIXELS * this.view.pixel;
    const axis = up.clone().multiplyScalar(x).addScaledVector(right, -y);
    if (e.shiftKey) this.options.aim(turnedFrame(from, new Matrix4().makeRotationAxis(axis, KEY_TURN)), true);
    else this.options.aim(movedFrame(from, right.multiplyScalar(x * step).addScaledVector(up, y * step)), false);
    this.options.drop();
  }

  /** Shows the handle where the tool should be, and a line to where it is. */
  update() {
    const tool = this.options.tool(), aim = this.missed ?? tool;
    const at = aim && this.view.project(originOf(aim)), end = tool && this.view.project(originOf(tool));
    const shown = at !== null && end !== null;
    for (const element of [this.button, this.ring]) {
      element.toggleAttribute("hidden", !shown);
      element.classList.toggle("missed", this.missed !== null);
      if (at) element.style.transform = `translate(${at.x.toFixed(1)}px, ${at.y.toFixed(1)}px) translate(-50%, -50%)`;
    }
    this.gap.toggleAttribute("hidden", !shown || this.missed === null);
    if (!at || !end) return;
    for (const [name, value] of Object.entries({ x1: at.x, y1: at.y, x2: end.x, y2: end.y })) this.line.setAttribute(name, value.toFixed(1));
  }
}
