// Moving the view with pointer, wheel, fingers, and keys.
//
// The left button turns, the right or middle button (or Shift) moves, the wheel zooms to the pointer. One finger turns, two move and zoom. In a
// drawing, the left button and one finger move.

import { Topic } from "./topic.js";
import { STANDARD_VIEWS } from "./orbit.js";

const TURN = 0.0075; // radians per pixel
const KEY_TURN = (5 * Math.PI) / 180;
const KEY_PAN = 0.1; // of half the height
const KEY_ZOOM = 1.2;
const WHEEL = 0.0015; // logarithm of the scale, per pixel
const CLICK = 4; // pixels that a click may move

/** @typedef {{ x: number, y: number, event: PointerEvent | MouseEvent }} Click */

export class Controls {
  /** @param {HTMLElement} host  receives the events @param {import("./view.js").View} view */
  constructor(host, view) {
    this.host = host;
    this.view = view;
    /** @type {Map<number, { x: number, y: number }>} */
    this.fingers = new Map();
    this.moved = 0;
    /** @type {Topic<Click>} */
    this.clicked = new Topic();
    /** @type {Topic<Click>} */
    this.doubleClicked = new Topic();
    /** @type {Topic<{ x: number, y: number } | null>} */
    this.hovered = new Topic();
    /** @type {{ x: number, y: number } | null} */
    this.hover = null;
    this.hoverDue = false;
    host.addEventListener("pointerdown", (e) => this.down(e));
    host.addEventListener("pointermove", (e) => this.move(e));
    host.addEventListener("pointerup", (e) => this.up(e));
    host.addEventListener("pointercancel", (e) => this.fingers.delete(e.pointerId));
    host.addEventListener("pointerleave", () => this.hoverAt(null));
    host.addEventListener("wheel", (e) => this.wheel(e), { passive: false });
    host.addEventListener("contextmenu", (e) => e.preventDefault());
    host.addEventListener("dblclick", (e) => this.doubleClicked.emit({ ...this.place(e), event: e }));
    host.addEventListener("keydown", (e) => this.key(e));
  }

  /** @param {MouseEvent} e */
  place(e) {
    const box = this.host.getBoundingClientRect();
    return { x: e.clientX - box.left, y: e.clientY - box.top };
  }

  /** @param {PointerEvent} e */
  down(e) {
    if (e.target !== this.host && !(e.target instanceof HTMLCanvasElement)) return;
    this.host.focus({ preventScroll: true });
    // Events of tests have no pointer that can be captured.
    if (e.isTrusted) this.host.setPointerCapture(e.pointerId);
    this.fingers.set(e.pointerId, this.place(e));
    this.moved = this.fingers.size > 1 ? CLICK + 1 : 0;
    this.hoverAt(null);
  }

  /** @param {PointerEvent} e */
  move(e) {
    const before = this.fingers.get(e.pointerId), now = this.place(e);
    if (!before) {
      const onHandle = e.target instanceof Element && e.target.closest(".handle");
      if (e.pointerType !== "touch") this.hoverAt(onHandle ? null : now);
      return;
    }
    const dx = now.x - before.x, dy = now.y - before.y;
    this.moved += Math.abs(dx) + Math.abs(dy);
    this.fingers.set(e.pointerId, now);
    if (this.moved <= CLICK) return;
    const { orbit, height, message } = this.view;
    if (this.fingers.size > 1) this.pinch(before, now, e.pointerId);
    else if (e.buttons & 6 || e.shiftKey || message?.drawing) orbit.pan((2 * dx) / height, (-2 * dy) / height);
    else orbit.turn(-dx * TURN, dy * TURN);
    this.changed();
  }

  /** @param {{ x: number, y: number }} before @param {{ x: number, y: number }} now @param {number} id */
  pinch(before, now, id) {
    const [other] = [...this.fingers].filter(([key]) => key !== id).map(([, p]) => p);
    const { orbit, height } = this.view;
    const was = Math.hypot(before.x - other.x, before.y - other.y), is = Math.hypot(now.x - other.x, now.y - other.y);
    orbit.pan((now.x - before.x) / height, -(now.y - before.y) / height);
    if (was > 0 && is > 0) orbit.zoom(is / was, this.view.pointAt((now.x + other.x) / 2, (now.y + other.y) / 2));
  }

  /** @param {PointerEvent} e */
  up(e) {
    if (!this.fingers.delete(e.pointerId)) return;
    if (this.moved <= CLICK && e.button === 0) this.clicked.emit({ ...this.place(e), event: e });
  }

  /** @param {WheelEvent} e */
  wheel(e) {
    e.preventDefault();
    const { x, y } = this.place(e), lines = e.deltaMode === 1 ? 16 : 1;
    // Pinching on a touchpad sends small steps with Ctrl.
    const step = e.deltaY * lines * (e.ctrlKey ? 6 : 1);
    this.view.orbit.zoom(Math.exp(-WHEEL * Math.max(-200, Math.min(200, step))), this.view.pointAt(x, y));
    this.changed();
  }

  /** @param {KeyboardEvent} e */
  key(e) {
    if (e.ctrlKey || e.metaKey || e.altKey) return;
    const { orbit } = this.view;
    /** @type {Record<string, [number, number]>} */
    const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    const arrow = arrows[e.key];
    if (arrow && (e.shiftKey || this.view.message?.drawing)) orbit.pan(-arrow[0] * KEY_PAN, -arrow[1] * KEY_PAN);
    else if (arrow) orbit.turn(arrow[0] * KEY_TURN, arrow[1] * KEY_TURN);
    else if (e.key === "+" || e.key === "=") orbit.zoom(KEY_ZOOM, orbit.target);
    else if (e.key === "-") orbit.zoom(1 / KEY_ZOOM, orbit.target);
    else return;
    e.preventDefault();
    this.changed();
  }

  changed() {
    this.view.following = null;
    this.view.invalidate();
  }

  /** Tells at most once per picture what is pointed at. @param {{ x: number, y: number } | null} at */
  hoverAt(at) {
    this.hover = at;
    if (this.hoverDue) return;
    this.hoverDue = true;
    requestAnimationFrame(() => {
      this.hoverDue = false;
      this.hovered.emit(this.hover);
    });
  }
}

/** The keys 1 to 7. @param {string} key @returns {import("./orbit.js").StandardView | undefined} */
export const viewOfKey = (key) => STANDARD_VIEWS[Number(key) - 1];
