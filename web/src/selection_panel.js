// What is selected: its measures, and the places in the script that it comes from.

import { h, iconButton } from "./dom.js";
import { formatNumber, formatPoint, formatSize } from "./format.js";
import { Topic } from "./topic.js";

/** How the chain of places names its links. @type {Record<string, string>} */
const LINKS = { show: "shown", changed: "changed", combined: "combined", made: "made" };

/** @param {string} text */
export const copyText = (text) => navigator.clipboard.writeText(text);

export class SelectionPanel {
  /**
   * @param {HTMLElement} host
   * @param {import("./engine.js").Engine} engine
   * @param {(place: import("./engine.js").Place) => string} excerpt  the text of a place, "" if its file is not open
   */
  constructor(host, engine, excerpt) {
    this.engine = engine;
    this.excerpt = excerpt;
    this.body = h("div", { class: "stack" });
    host.append(this.body);
    /** @type {Topic<import("./engine.js").Place>} */
    this.placeWanted = new Topic();
    this.asked = 0;
    this.show(null, "");
  }

  /**
   * @param {import("./engine.js").Part | null} part
   * @param {string} expression  of the part in the script
   * @param {boolean} [measured]  false: something is being dragged, and measures would be late
   * @param {{ name: string, origin: import("./engine.js").Origin[] } | null} [face]  what the face that was clicked comes from
   */
  async show(part, expression, measured = true, face = null) {
    const asked = ++this.asked;
    if (!part) {
      this.body.replaceChildren(h("p", { class: "faint" }, "Click a part to see where it comes from and how large it is."));
      return;
    }
    const table = h("dl", { class: "facts" });
    this.add(table, "size", formatSize(part.bounds), "");
    this.body.replaceChildren(
      h("div", { class: "row" }, h("strong", {}, part.name), h("span", { class: "faint" }, part.type)),
      h("p", { class: "faint" }, part.story),
      ...(face ? [h("h3", { class: "face" }, face.name ? `This face comes from ${face.name}` : "This face comes from"), this.chain(face.origin, "Places of the face"), h("h3", {}, "The part")] : []),
      this.chain(part.origin, "Places in the script"), table);
    if (!measured) return;
    try {
      const m = await this.engine.measure(part.name);
      if (asked !== this.asked) return;
      this.measures(table, m, expression);
    } catch {
      if (asked === this.asked) this.add(table, "measures", "not available", "");
    }
  }

  /** @param {import("./engine.js").Origin[]} origin @param {string} label */
  chain(origin, label) {
    return h("ol", { class: "chain", "aria-label": label }, ...origin.map((place) => {
      const text = this.excerpt(place).replace(/\s+/g, " ").trim();
      return h("li", {}, h("button", { type: "button", class: "quiet place", onclick: () => this.placeWanted.emit(place) },
        h("span", { class: "what" }, LINKS[place.what] ?? place.what), h("span", { class: "faint" }, `${place.file}:${place.line}`),
        text ? h("code", {}, text) : null));
    }));
  }

  /** @param {HTMLElement} table @param {import("./engine.js").Measures} m @param {string} expression */
  measures(table, m, expression) {
    const of = (/** @type {string} */ call) => (expression ? call.replace("*", expression) : "");
    const number = (/** @type {string} */ name, /** @type {number | null | undefined} */ x, /** @type {string} */ unit) => {
      if (x !== null && x !== undefined) this.add(table, name, `${formatNumber(x, 6)} ${unit}`, of(`${name}(*)`));
    };
    number("length", m.length, "mm");
    number("area", m.area, "mm²");
    number("volume", m.volume, "mm³");
    if (m.centroid) this.add(table, "centroid", formatPoint(m.centroid), of("centroid(*)"));
    if (m.bounds) {
      this.add(table, "least", formatPoint(m.bounds[0]), of("bounds(*).min"));
      this.add(table, "greatest", formatPoint(m.bounds[1]), of("bounds(*).max"));
    }
    if (m.watertight !== null && m.watertight !== undefined) this.add(table, "watertight", m.watertight ? "yes" : "no", "");
  }

  /** @param {HTMLElement} table @param {string} name @param {string} value @param {string} expression */
  add(table, name, value, expression) {
    const copy = expression ? iconButton("copy", `Copy ${expression}`, () => copyText(expression)) : null;
    table.append(h("dt", {}, name), h("dd", {}, h("span", {}, value), copy));
  }
}
