// Measuring: one pick tells its length, radius, or area; two tell what is between them.

import { Vector3 } from "three";
import { h, iconButton, svg } from "./dom.js";
import { formatNumber, formatPoint } from "./format.js";
import { anchorOf, cross, findingsOfOne, findingsOfTwo, norm, unit } from "./recognize.js";
import { copyText } from "./selection_panel.js";
import { Topic } from "./topic.js";

/** @typedef {import("./recognize.js").Pick} Pick */

const CIRCLE_STEPS = 48;
const NAMES = { point: "point", edge: "straight edge", circle: "circle", face: "plane face" };

export class MeasurePanel {
  /** @param {HTMLElement} host @param {HTMLElement} layer  over the picture @param {import("./view.js").View} view */
  constructor(host, layer, view) {
    this.view = view;
    this.active = false;
    /** @type {Pick[]} */
    this.picks = [];
    /** @type {Pick | null} */
    this.candidate = null;
    /** @type {Topic<boolean>} */
    this.toggled = new Topic();
    this.on = h("input", { type: "checkbox", class: "switch", role: "switch", "aria-label": "Measure", onchange: () => this.toggle(this.on.checked) });
    this.body = h("div", { class: "stack" });
    host.append(h("label", { class: "row" }, this.on, "Measure with clicks (M)"), this.body);
    this.layer = svg("svg", { class: "marks", "aria-hidden": "true" });
    layer.append(this.layer);
    view.drawn.on(() => this.draw());
    this.show();
  }

  /** @param {boolean} on */
  toggle(on) {
    this.active = this.on.checked = on;
    this.picks = [];
    this.candidate = null;
    this.toggled.emit(on);
    this.show();
  }

  /** @param {number} x @param {number} y */
  click(x, y) {
    const found = this.view.pickFeature(x, y);
    if (!found) return;
    if (this.picks.length === 2) this.picks = [];
    this.picks.push(found.pick);
    this.show();
  }

  /** @param {{ x: number, y: number } | null} at */
  hover(at) {
    this.candidate = (at && this.view.pickFeature(at.x, at.y)?.pick) ?? null;
    this.draw();
  }

  show() {
    const [a, b] = this.picks;
    this.body.hidden = !this.active;
    this.body.replaceChildren();
    if (!a) this.body.append(h("p", { class: "faint" }, "Click a corner, an edge, or a face. Click a second one to measure between them."));
    for (const p of this.picks) {
      const table = h("dl", { class: "facts" });
      this.add(table, NAMES[p.kind], formatPoint(anchorOf(p)), formatPoint(anchorOf(p)));
      for (const f of findingsOfOne(p)) this.add(table, f.name, `${formatNumber(f.value)} ${f.unit}`, formatNumber(f.value, 8));
      this.body.append(table);
    }
    if (a && b) {
      const table = h("dl", { class: "facts found" });
      for (const f of findingsOfTwo(a, b)) {
        const distance = `norm(${formatPoint(anchorOf(b))} - ${formatPoint(anchorOf(a))})`;
        this.add(table, f.name, `${formatNumber(f.value)} ${f.unit}`, f.name.startsWith("distance") ? distance : formatNumber(f.value, 8));
      }
      this.body.append(table);
    }
    if (a) this.body.append(h("button", { type: "button", onclick: () => this.clear() }, "Clear"));
    this.draw();
  }

  clear() {
    this.picks = [];
    this.show();
  }

  /** @param {HTMLElement} table @param {string} name @param {string} value @param {string} expression */
  add(table, name, value, expression) {
    table.append(h("dt", {}, name), h("dd", {}, h("span", {}, value), iconButton("copy", `Copy ${expression}`, () => copyText(expression))));
  }

  draw() {
    this.layer.replaceChildren();
    if (!this.active) return;
    if (this.candidate) this.drawPick(this.candidate, "candidate");
    for (const p of this.picks) this.drawPick(p, "picked");
    const [a, b] = this.picks;
    if (a && b) this.drawDistance(a, b);
  }

  /** @param {Pick} p @param {string} kind */
  drawPick(p, kind) {
    if (p.kind === "edge") this.drawLine([p.from, p.to], kind);
    if (p.kind === "circle") this.drawLine(circlePoints(p), kind);
    const at = this.view.project(new Vector3(...anchorOf(p)));
    if (at) this.layer.append(svg("circle", { cx: at.x, cy: at.y, r: 4, class: kind }));
  }

  /** @param {number[][]} points @param {string} kind */
  drawLine(points, kind) {
    const pixels = points.map((p) => this.view.project(new Vector3(p[0], p[1], p[2])));
    const text = pixels.flatMap((p) => (p ? [`${p.x.toFixed(1)},${p.y.toFixed(1)}`] : [])).join(" ");
    this.layer.append(svg("polyline", { points: text, class: kind }));
  }

  /** @param {Pick} a @param {Pick} b */
  drawDistance(a, b) {
    const p = anchorOf(a), q = anchorOf(b);
    this.drawLine([p, q], "between");
    const middle = this.view.project(new Vector3(...p).lerp(new Vector3(...q), 0.5));
    const length = norm([q[0] - p[0], q[1] - p[1], q[2] - p[2]]);
    if (middle) this.layer.append(svg("text", { x: middle.x, y: middle.y - 6, "text-anchor": "middle" }, `${formatNumber(length)} mm`));
  }
}

/** @param {import("./recognize.js").CirclePick} c */
function circlePoints({ center, axis, radius }) {
  const u = unit(cross(axis, Math.abs(axis[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0])), v = cross(axis, u);
  return Array.from({ length: CIRCLE_STEPS + 1 }, (_, i) => {
    const angle = (2 * Math.PI * i) / CIRCLE_STEPS, x = radius * Math.cos(angle), y = radius * Math.sin(angle);
    return center.map((c, k) => c + x * u[k] + y * v[k]);
  });
}
