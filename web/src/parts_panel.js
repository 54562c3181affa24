// The list of parts: what is shown, hidden, alone, or transparent. The script does not change.

import { h, iconButton } from "./dom.js";
import { Topic } from "./topic.js";

const MOST_ROWS = 400;
const FILTER_FROM = 12; // parts

export class PartsPanel {
  /** @param {HTMLElement} host @param {import("./view.js").View} view */
  constructor(host, view) {
    this.view = view;
    /** @type {Topic<{ name: string, more: boolean }>} */
    this.picked = new Topic();
    /** @type {Topic<string | null>} */
    this.pointed = new Topic();
    this.filter = h("input", { type: "search", placeholder: "Filter", "aria-label": "Filter parts by name", oninput: () => this.fill() });
    this.list = h("ul", { class: "parts" });
    this.rest = h("p", { class: "faint" });
    this.all = h("button", { type: "button", onclick: () => this.showAll() }, "Show all");
    host.append(this.filter, this.list, this.rest, this.all);
    this.key = "";
    this.fill();
  }

  /** Brings the list up to date with the scene. */
  show() {
    const key = [...this.view.parts.views.values()].map((v) => `${v.part.name} ${v.part.type}`).join("\n");
    if (key !== this.key) {
      this.key = key;
      this.fill();
    } else this.refresh();
  }

  fill() {
    const names = [...this.view.parts.views.keys()], wanted = this.filter.value.toLowerCase();
    const found = names.filter((n) => n.toLowerCase().includes(wanted));
    this.filter.hidden = names.length < FILTER_FROM;
    this.list.replaceChildren(...found.slice(0, MOST_ROWS).map((name) => this.row(name)));
    const more = found.length - MOST_ROWS;
    this.rest.textContent = names.length === 0 ? "Nothing is shown." : more > 0 ? `${more} more; filter to see them` : "";
    this.refresh();
  }

  /** @param {string} name */
  row(name) {
    const { parts } = this.view;
    const toggle = (/** @type {Set<string>} */ set) => {
      if (!set.delete(name)) set.add(name);
      this.update();
    };
    return h("li", { "data-part": name, onpointerenter: () => this.pointed.emit(name), onpointerleave: () => this.pointed.emit(null) },
      h("button", { type: "button", class: "quiet part", onclick: (/** @type {MouseEvent} */ e) => this.picked.emit({ name, more: e.shiftKey }) },
        h("span", {}, name), h("span", { class: "faint" }, parts.views.get(name)?.part.type)),
      iconButton("alone", `Show ${name} alone`, () => {
        parts.alone = parts.alone === name ? null : name;
        this.update();
      }),
      iconButton("glass", `Make ${name} transparent`, () => toggle(parts.glass)),
      iconButton("eye", `Hide ${name}`, () => toggle(parts.hidden)));
  }

  showAll() {
    const { parts } = this.view;
    parts.hidden.clear();
    parts.glass.clear();
    parts.alone = null;
    this.update();
  }

  update() {
    this.view.parts.refresh();
    this.view.changed();
    this.refresh();
  }

  refresh() {
    const { parts, selected } = this.view;
    for (const row of this.list.children) {
      const name = /** @type {HTMLElement} */ (row).dataset.part ?? "";
      row.classList.toggle("selected", selected.includes(name));
      row.classList.toggle("off", !parts.isVisible(name));
      [parts.alone === name, parts.glass.has(name), parts.hidden.has(name)].forEach((on, i) =>
        row.children[i + 1].setAttribute("aria-pressed", String(on)));
      row.children[0].setAttribute("aria-pressed", String(selected.includes(name)));
    }
    this.all.hidden = parts.hidden.size === 0 && parts.glass.size === 0 && parts.alone === null;
  }
}
