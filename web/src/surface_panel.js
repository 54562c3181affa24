// The choice of what is shown of surfaces, with the scale of the values.

import { gradient } from "./colors.js";
import { h } from "./dom.js";
import { formatNumber } from "./format.js";
import { UNITS } from "./surfaces.js";

/** @typedef {import("./surfaces.js").SurfaceKind} SurfaceKind */

/** @type {[SurfaceKind | "", string][]} */
const CHOICES = [
  ["", "nothing"], ["gaussian", "Gaussian curvature"], ["mean", "mean curvature"], ["max", "largest principal curvature"],
  ["min", "smallest principal curvature"], ["deviation", "distance of the mesh"], ["zebra", "zebra stripes"], ["normals", "normals"],
  ["isolines", "isolines"], ["net", "control nets"],
];
const PERCENTS = [100, 98, 90, 75];

export class SurfacePanel {
  /**
   * @param {HTMLElement} host
   * @param {import("./view.js").View} view
   * @param {import("./surfaces.js").Surfaces} surfaces
   */
  constructor(host, view, surfaces) {
    this.view = view;
    this.surfaces = surfaces;
    this.choice = h("select", { "aria-label": "Shown of surfaces", onchange: () => this.update() }, ...CHOICES.map(([value, name]) => h("option", { value }, name)));
    this.percent = h("select", { "aria-label": "Range of the scale", onchange: () => this.update() },
      ...PERCENTS.map((p) => h("option", { value: p, selected: p === 98 }, p === 100 ? "all values" : `${p} % of the values`)));
    this.low = h("span");
    this.high = h("span");
    this.bar = h("div", { class: "scale-bar" });
    this.note = h("p", { class: "faint" });
    this.legend = h("div", { class: "legend", role: "img", hidden: true }, this.bar, h("div", { class: "ends" }, this.low, this.high));
    this.problems = h("ul", { class: "problems faint", hidden: true });
    host.append(h("div", { class: "stack" }, this.choice, this.percent, this.legend, this.note, this.problems));
    this.percent.hidden = true;
    this.key = "";
  }

  /** @returns {SurfaceKind | ""} */
  get kind() {
    return /** @type {SurfaceKind | ""} */ (this.choice.value);
  }

  /** The parts that are selected, or all that are visible. */
  get views() {
    const selected = this.view.selected.flatMap((name) => this.view.parts.views.get(name) ?? []);
    return selected.length ? selected : [...this.view.parts.visible()];
  }

  /** After a change of the scene, or of what is selected or visible. */
  refresh() {
    if (!this.kind) return;
    const key = JSON.stringify([this.kind, this.views.map((v) => [v.part.name, v.part.mesh, v.part.placement])]);
    if (key !== this.key) this.update();
  }

  async update() {
    const { kind, views } = this;
    this.key = JSON.stringify([kind, views.map((v) => [v.part.name, v.part.mesh, v.part.placement])]);
    const valued = kind in UNITS;
    this.percent.hidden = !valued;
    if (!kind) {
      this.surfaces.clear();
      return this.tell(null, "", []);
    }
    const out = await this.surfaces.show(kind, views, Number(this.percent.value));
    if (!out) return;
    const unit = valued ? UNITS[/** @type {import("./surfaces.js").ValueKind} */ (kind)] : "";
    const text = kind === "deviation" && out.farthest !== null ? `The mesh is at most ${formatNumber(out.farthest, 3)} mm from the surface.` : "";
    this.tell(out.scale && { ...out.scale, unit }, text, out.problems);
  }

  /** @param {(import("./colors.js").Scale & { unit: string }) | null} scale @param {string} text @param {string[]} problems */
  tell(scale, text, problems) {
    this.legend.hidden = !scale;
    if (scale) {
      this.bar.style.background = gradient(scale.diverging);
      this.low.textContent = formatNumber(scale.low, 3);
      this.high.textContent = `${formatNumber(scale.high, 3)} ${scale.unit}`;
      this.legend.setAttribute("aria-label", `Colors from ${formatNumber(scale.low, 3)} to ${formatNumber(scale.high, 3)} ${scale.unit}`);
    }
    this.note.textContent = text;
    this.note.hidden = text === "";
    this.problems.hidden = problems.length === 0;
    this.problems.replaceChildren(...problems.slice(0, 8).map((p) => h("li", {}, p)));
  }
}
