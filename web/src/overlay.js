// What is drawn over the picture in HTML and SVG: labels of the scene (as cag draws them), the scale, the directions of the axes, and the name of what is
// pointed at.

import { Color, Vector3 } from "three";
import { h, svg } from "./dom.js";
import { formatNumber } from "./format.js";
import { scaleLength } from "./scale.js";

const TEXT_PART = 0.024; // the height of labels without a size, as a part of the picture's diagonal, as in cag's pictures
const TEXT_SIZE = 20; // pixels, at most, of labels without a size
const AXES = /** @type {const} */ ([["X", 1, 0, 0], ["Y", 0, 1, 0], ["Z", 0, 0, 1]]);
const ARM = 21; // pixels

/** A part of a label. @param {string} path @param {string} name */
function shape(path, name) {
  return svg("path", { d: path, class: name, "fill-rule": "evenodd" });
}

export class Overlay {
  /** @param {HTMLElement} host @param {import("./view.js").View} view */
  constructor(host, view) {
    this.view = view;
    this.labels = svg("svg", { class: "labels" });
    this.scaleBar = h("span", { class: "bar" });
    this.scaleText = h("span");
    this.scale = h("div", { class: "scale", role: "img" }, this.scaleBar, this.scaleText);
    this.axes = svg("svg", { viewBox: "-34 -34 68 68", class: "axes", role: "img", "aria-label": "Directions of the axes" });
    this.tip = h("div", { class: "tip", hidden: true, "aria-hidden": "true" });
    host.append(this.labels, this.scale, this.axes, this.tip);
    /** @type {{ element: SVGElement, mark: SVGElement, text: SVGElement, label: import("./engine.js").SceneLabel }[]} */
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
      const mark = svg("g", {}, shape(label.paper_path, "paper"), shape(label.mark_path, "mark")), text = svg("g", {}, shape(label.text_path, "text"));
      const element = svg("g", { class: "label", role: "img", "aria-label": label.text }, mark, text);
      const color = scene.materials[label.material]?.color;
      if (color) element.style.color = new Color().setRGB(...color).getStyle();
      this.labels.append(element);
      return { element, mark, text, label };
    });
  }

  update() {
    this.updateScale();
    this.updateAxes();
    for (const shown of this.shown) this.placeLabel(shown);
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

  /** @param {Overlay["shown"][number]} shown */
  placeLabel({ element, mark, text, label }) {
    const { view } = this, at = new Vector3(...label.at), p = view.project(at);
    element.style.display = p ? "" : "none";
    if (!p) return;
    const size = label.size > 0 ? label.size / view.pixelAt(at) : Math.min(TEXT_SIZE, TEXT_PART * Math.hypot(view.width, view.height));
    let angle = 0;
    if (label.along?.some((x) => x !== 0)) {
      const q = view.project(at.clone().addScaledVector(new Vector3(...label.along), 10 * view.pixelAt(at)));
      if (q) angle = Math.atan2(q.y - p.y, q.x - p.x);
    }
    // An arrow is turned, and any other mark's text, but it would be upside down if it ran to the left.
    const isArrow = label.mark === "arrow", upright = Math.cos(angle) < -1e-6 ? angle + Math.PI : angle;
    const place = (/** @type {number} */ turn) => `translate(${p.x.toFixed(1)} ${p.y.toFixed(1)}) rotate(${((turn * 180) / Math.PI).toFixed(2)}) scale(${size.toFixed(3)})`;
    mark.setAttribute("transform", place(isArrow ? angle : 0));
    text.setAttribute("transform", place(isArrow ? 0 : upright));
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
