// The exact curves in which the section plane cuts the parts: drawn on the plane, and listed with their lengths and areas.

import { Group } from "three";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";
import { h, iconButton } from "./dom.js";
import { floatsOf } from "./engine.js";
import { formatNumber } from "./format.js";
import { copyText } from "./selection_panel.js";

/** @typedef {import("./engine.js").SectionCurve} SectionCurve */

const PAUSE = 150; // milliseconds after the plane was moved

/**
 * Sums by part.
 *
 * @param {SectionCurve[]} curves
 * @returns {{ part: string, count: number, length: number, area: number | null, exact: boolean }[]}
 */
export function sumByPart(curves) {
  /** @type {Map<string, { part: string, count: number, length: number, area: number | null, exact: boolean }>} */
  const sums = new Map();
  for (const c of curves) {
    const sum = sums.get(c.part) ?? { part: c.part, count: 0, length: 0, area: 0, exact: true };
    sum.count++;
    sum.length += c.length;
    sum.area = sum.area === null || c.area === null ? null : sum.area + c.area;
    sum.exact &&= c.exact;
    sums.set(c.part, sum);
  }
  return [...sums.values()];
}

export class SectionCurves {
  /**
   * @param {HTMLElement} host
   * @param {import("./view.js").View} view
   * @param {import("./engine.js").Engine} engine
   * @param {(part: string) => string} expressionOf  "" if there is none
   */
  constructor(host, view, engine, expressionOf) {
    this.view = view;
    this.engine = engine;
    this.expressionOf = expressionOf;
    this.list = h("div", { class: "stack section-curves", "aria-live": "polite" });
    host.append(this.list);
    this.group = new Group();
    view.scene.add(this.group);
    this.material = new LineMaterial({ linewidth: 3, depthTest: false, transparent: true });
    this.turn = this.timer = 0;
    this.key = "";
  }

  /** After the plane or the scene has changed. */
  update() {
    const { section, message } = this.view, key = section.on ? JSON.stringify([section.axis, section.offset, message?.run]) : "";
    if (key === this.key) return;
    this.key = key;
    this.turn++;
    clearTimeout(this.timer);
    this.draw([]);
    if (!section.on) return this.list.replaceChildren();
    this.timer = window.setTimeout(() => this.ask(), PAUSE);
  }

  async ask() {
    const turn = this.turn, { section } = this.view;
    /** @type {import("./engine.js").Triple} */
    const normal = [section.axis === "x" ? 1 : 0, section.axis === "y" ? 1 : 0, section.axis === "z" ? 1 : 0];
    try {
      const curves = await this.engine.section(normal, section.offset);
      if (turn !== this.turn) return;
      const seen = curves.filter((c) => this.view.parts.isVisible(c.part));
      this.draw(seen);
      this.show(seen);
    } catch (error) {
      if (turn === this.turn) this.list.replaceChildren(h("p", { class: "faint" }, /** @type {Error} */ (error).message));
    }
  }

  /** @param {SectionCurve[]} curves */
  draw(curves) {
    for (const line of this.group.children) /** @type {LineSegments2} */ (line).geometry.dispose();
    this.group.clear();
    this.material.color.copy(this.view.color("--accent"));
    for (const curve of curves) {
      const points = floatsOf(curve.points), ends = [];
      for (let i = 0; i + 6 <= points.length; i += 3) ends.push(...points.subarray(i, i + 6));
      if (ends.length === 0) continue;
      const geometry = new LineSegmentsGeometry();
      geometry.setPositions(ends);
      const line = new LineSegments2(geometry, this.material);
      line.renderOrder = 900;
      this.group.add(line);
    }
    this.view.invalidate();
  }

  /** @param {SectionCurve[]} curves */
  show(curves) {
    if (curves.length === 0) return this.list.replaceChildren(h("p", { class: "faint" }, "The plane cuts nothing."));
    this.list.replaceChildren(...sumByPart(curves).map((sum) => {
      const of = this.expressionOf(sum.part), expression = of ? `section(${of}, ${this.plane})` : "";
      const facts = h("dl", { class: "facts" });
      const add = (/** @type {string} */ name, /** @type {string} */ value) => facts.append(h("dt", {}, name), h("dd", {}, h("span", {}, value)));
      add("curves", String(sum.count));
      add("length", `${formatNumber(sum.length, 7)} mm`);
      if (sum.area !== null) add("area", `${formatNumber(sum.area, 7)} mm²`);
      if (!sum.exact) add("accuracy", "that of the mesh");
      return h("div", {}, h("div", { class: "row" }, h("strong", {}, sum.part), expression ? iconButton("copy", `Copy ${expression}`, () => copyText(expression)) : null), facts);
    }));
  }

  /** The plane as an expression. */
  get plane() {
    const { axis, offset } = this.view.section, at = [0, 0, 0];
    at["xyz".indexOf(axis)] = offset;
    return `plane([${at.map((x) => formatNumber(x)).join(", ")}], ${axis.toUpperCase()})`;
  }
}
