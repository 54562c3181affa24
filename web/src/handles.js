// Handles: buttons over the picture, at points in space, that are dragged along a line.
//
// A handle knows where it is and how a move along its line changes what it stands for. The section plane has one; anything else that is a point
// in space can have some.

import { Vector3 } from "three";
import { h } from "./dom.js";

/**
 * @typedef {object} HandleOptions
 * @property {string} label
 * @property {() => { at: Vector3, along: Vector3 } | null} place  where the handle is, and the unit vector of its line; null: hidden
 * @property {(mm: number, dragging: boolean) => void} move  by a length along the line, since the last call
 * @property {() => void} drop  the drag has ended
 */

const KEY_PIXELS = 4; // that an arrow key moves

export class Handles {
  /** @param {HTMLElement} host @param {import("./view.js").View} view */
  constructor(host, view) {
    this.host = host;
    this.view = view;
    /** @type {Map<HTMLButtonElement, HandleOptions>} */
    this.handles = new Map();
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
      const step = { ArrowUp: 1, ArrowRight: 1, ArrowDown: -1, ArrowLeft: -1 }[e.key];
      if (!step) return;
      e.preventDefault();
      options.move(step * KEY_PIXELS * this.view.pixel, false);
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

  update() {
    for (const [button, options] of this.handles) {
      const line = this.lineInPicture(options);
      button.hidden = line === null;
      if (line) button.style.transform = `translate(${line.at.x.toFixed(1)}px, ${line.at.y.toFixed(1)}px) translate(-50%, -50%) rotate(${Math.atan2(line.y, line.x).toFixed(3)}rad)`;
    }
  }
}
