// What is drawn over the picture in HTML and SVG: labels of the scene, the scale, the directions of the axes, and the name of what is
// pointed at.

import { Color, Vector3 } from "three";
import { h, svg } from "./dom.js";
import { formatNumber } from "./format.js";
import { scaleLength } from "./scale.js";

/** The texts' steps to the right and down, in halves of their size, by place. @type {Record<string, [number, number]>} */
const PLACES = {
  right: [1, 0], left: [-1, 0], above: [0, -1], below: [0, 1], center: [0, 0],
  above_right: [1, -1], above_left: [-1, -1], below_right: [1, 1], below_left: [-1, 1],
};
const TEXT_SIZE = 13; // pixels, of labels without a size
const GAP = 8; // pixels between a location and its text
const AXES = /** @type {const} */ ([["X", 1, 0, 0], ["Y", 0, 1, 0], ["Z", 0, 0, 1]]);
const ARM = 21; // pixels

/** In a name, such as P_1, what follows `_` is lower, as in cag's pictures (interp/formats/svg_label.c). @param {string} text */
function subscripts(text) {
  const isName = /^\p{L}(?!\p{L})/u.test(text);
  return isName ? text.split(/_([\p{L}\p{N}\u0080-\u{10ffff}]+)/u).map((part, i) => (i % 2 ? h("sub", {}, part) : part)) : [text];
}

/** @param {string} kind */
function makeMark(kind) {
  if (kind === "none") return null;
  if (kind !== "arrow") return h("span", { class: `mark mark-${kind}` });
  // It points to the right, and is turned when it is placed.
  return svg("svg", { class: "arrow", viewBox: "-9 -5 10 10" }, svg("path", { d: "M0 0L-9 2.75V-2.75Z", fill: "currentColor" }));
}

export class Overlay {
  /** @param {HTMLElement} host @param {import("./view.js").View} view */
  constructor(host, view) {
    this.view = view;
    this.labels = h("div", { class: "labels" });
    this.scaleBar = h("span", { class: "bar" });
    this.scaleText = h("span");
    this.scale = h("div", { class: "scale", role: "img" }, this.scaleBar, this.scaleText);
    this.axes = svg("svg", { viewBox: "-34 -34 68 68", class: "axes", role: "img", "aria-label": "Directions of the axes" });
    this.tip = h("div", { class: "tip", hidden: true, "aria-hidden": "true" });
    host.append(this.labels, this.scale, this.axes, this.tip);
    /** @type {{ element: HTMLElement, label: import("./engine.js").SceneLabel }[]} */
    this.shown = [];
    this.arms = AXES.map(([name]) => {
      const line = svg("line", { x1: 0, y1: 0 }), text = svg("text", { "text-anchor": "middle", "dominant-baseline": "central" }, name);
      const arm = svg("g", { class: `axis-${name.toLowerCase()}` }, line, text);
      this.axes.append(arm);
      return { arm, line, text };
    });
    view.drawn.on(() => this.update());
  }

  /** @param {import("./engine.js").SceneMessage} scene */
  show(scene) {
    this.labels.replaceChildren();
    this.shown = scene.labels.map((label) => {
      const element = h("div", { class: "label" }, makeMark(label.mark), h("span", { class: "text" }, ...subscripts(label.text)));
      const color = scene.materials[label.material]?.color;
      if (color) element.style.color = new Color().setRGB(...color).getStyle();
      this.labels.append(element);
      return { element, label };
    });
  }

  update() {
    this.updateScale();
    this.updateAxes();
    for (const { element, label } of this.shown) this.placeLabel(element, label);
  }

  updateScale() {
    const { view } = this, length = scaleLength(view.pixel);
    this.scaleBar.style.width = `${length / view.pixel}px`;
    this.scaleText.textContent = `${formatNumber(length)} mm`;
    this.scale.setAttribute("aria-label", `The scale shows ${formatNumber(length)} millimeters`);
  }

  updateAxes() {
    const { right, up, back } = this.view.orbit.axes();
    this.arms.forEach(({ arm, line, text }, i) => {
      const [, x, y, z] = AXES[i], d = new Vector3(x, y, z);
      const sx = d.dot(right) * ARM, sy = -d.dot(up) * ARM;
      line.setAttribute("x2", sx.toFixed(1));
      line.setAttribute("y2", sy.toFixed(1));
      text.setAttribute("x", (sx * 1.28).toFixed(1));
      text.setAttribute("y", (sy * 1.28).toFixed(1));
      arm.setAttribute("opacity", d.dot(back) < -0.5 ? "0.5" : "1");
    });
  }

  /** @param {HTMLElement} element @param {import("./engine.js").SceneLabel} label */
  placeLabel(element, label) {
    const { view } = this, at = new Vector3(...label.at), p = view.project(at);
    element.hidden = p === null;
    if (!p) return;
    const text = /** @type {HTMLElement} */ (element.lastElementChild);
    const size = label.size > 0 ? label.size / view.pixelAt(at) : TEXT_SIZE;
    let angle = 0;
    if (label.along?.some((x) => x !== 0)) {
      const q = view.project(at.clone().addScaledVector(new Vector3(...label.along), 10 * view.pixelAt(at)));
      if (q) angle = Math.atan2(q.y - p.y, q.x - p.x);
    }
    const arrow = label.mark === "arrow" ? /** @type {SVGElement} */ (element.firstElementChild) : null;
    if (arrow) {
      arrow.style.transform = `rotate(${angle.toFixed(4)}rad)`;
      angle = 0;
    }
    // A text that runs down or to the left would be upside down.
    if (Math.cos(angle) < -1e-6) angle += Math.PI;
    element.style.transform = `translate(${p.x.toFixed(1)}px, ${p.y.toFixed(1)}px)`;
    text.style.fontSize = `${size.toFixed(1)}px`;
    const [x, y] = PLACES[label.place] ?? PLACES.right, gap = label.mark === "none" && label.place === "center" ? 0 : GAP;
    text.style.transform = `rotate(${angle.toFixed(4)}rad) translate(calc(-50% + ${x * 50}% + ${x * gap}px), calc(-50% + ${y * 50}% + ${y * gap}px))`;
  }

  /** Shows a text next to the pointer. @param {string} text @param {number} x @param {number} y */
  point(text, x, y) {
    this.tip.hidden = text === "";
    if (!text) return;
    this.tip.textContent = text;
    const room = this.view.width - x < this.tip.offsetWidth + 24;
    this.tip.style.transform = `translate(${room ? x - this.tip.offsetWidth - 8 : x + 14}px, ${Math.min(y + 14, this.view.height - 30)}px)`;
  }
}
