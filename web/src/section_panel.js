// The controls of the section plane.

import { Vector3 } from "three";
import { h } from "./dom.js";
import { formatNumber } from "./format.js";
import { copyText } from "./selection_panel.js";

/** @typedef {import("./section.js").Axis} Axis */
const AXES = /** @type {const} */ (["x", "y", "z"]);

export class SectionPanel {
  /** @param {HTMLElement} host @param {import("./view.js").View} view @param {import("./handles.js").Handles} handles */
  constructor(host, view, handles) {
    this.view = view;
    const { section } = view;
    this.on = h("input", { type: "checkbox", class: "switch", role: "switch", "aria-label": "Section plane", onchange: () => this.toggle(this.on.checked) });
    this.axis = h("select", { "aria-label": "Direction", onchange: () => this.turn(/** @type {Axis} */ (this.axis.value)) },
      ...AXES.map((a) => h("option", { value: a, selected: a === section.axis }, `perpendicular to ${a.toUpperCase()}`)));
    this.slider = h("input", { type: "range", step: "any", "aria-label": "Position" });
    this.field = h("input", { type: "number", step: "any", class: "number", "aria-label": "Position, mm" });
    this.slider.addEventListener("input", () => this.move(Number(this.slider.value)));
    this.field.addEventListener("change", () => this.move(Number(this.field.value)));
    this.flip = h("button", { type: "button", onclick: () => this.turnOver() }, "Flip");
    this.copy = h("button", { type: "button", onclick: () => copyText(this.option) }, "Copy option");
    this.copy.title = "Copies the option for cag render and cag export";
    this.rest = h("div", { class: "stack" }, this.axis, h("div", { class: "row" }, this.slider, this.field, h("span", { class: "unit" }, "mm")),
      h("div", { class: "row" }, this.flip, this.copy));
    host.append(h("label", { class: "row" }, this.on, "Cut the scene with a plane (X)"), this.rest);
    handles.add({
      label: "Move the section plane",
      place: () => (section.on ? { at: this.center(), along: section.normal.negate() } : null),
      move: (mm) => this.move(section.offset + mm * (section.flipped ? -1 : 1)),
      drop: () => {},
    });
    this.show();
  }

  get option() {
    const { axis, offset } = this.view.section;
    return `--section ${axis}=${formatNumber(offset)}`;
  }

  /** The middle of the scene, in the plane. */
  center() {
    const { orbit, section } = this.view;
    const center = orbit.low.clone().add(orbit.high).multiplyScalar(0.5);
    return section.plane.projectPoint(center, new Vector3());
  }

  /** The bounds of the scene along the axis. @returns {[number, number]} */
  get range() {
    const { orbit, section } = this.view;
    return [orbit.low[section.axis], orbit.high[section.axis]];
  }

  /** @param {boolean} on */
  toggle(on) {
    const { section } = this.view, [low, high] = this.range;
    if (on && !(section.offset > low && section.offset < high)) section.offset = (low + high) / 2;
    section.on = on;
    this.update();
  }

  /** @param {Axis} axis */
  turn(axis) {
    this.view.section.axis = axis;
    const [low, high] = this.range;
    this.move((low + high) / 2);
  }

  turnOver() {
    this.view.section.flipped = !this.view.section.flipped;
    this.update();
  }

  /** @param {number} offset */
  move(offset) {
    const [low, high] = this.range;
    this.view.section.offset = Math.min(high, Math.max(low, offset));
    this.update();
  }

  update() {
    this.view.changed();
    this.show();
  }

  /** Brings the controls up to date. */
  show() {
    const { section } = this.view, [low, high] = this.range;
    this.on.checked = section.on;
    this.rest.hidden = !section.on;
    this.axis.value = section.axis;
    this.slider.min = String(low);
    this.slider.max = String(high);
    this.slider.value = String(section.offset);
    if (document.activeElement !== this.field) this.field.value = formatNumber(section.offset);
  }
}
