// The tour: the chapter "Getting started" of the documentation site, one section at a time, with scripts that can be opened.

import { h } from "./dom.js";
import { writeFragment } from "./fragment.js";

const CHAPTER = "docs/guide/getting-started.html";

/** @typedef {{ title: string, content: Element[] }} Step */

/** @param {Document} page @param {string} base  its address @returns {Step[]} */
function readSteps(page, base) {
  /** @type {Step[]} */
  const steps = [];
  const main = page.querySelector("main article") ?? page.body;
  for (const element of [...main.children]) {
    if (/^H[12]$/.test(element.tagName)) steps.push({ title: element.textContent ?? "", content: [] });
    else steps[steps.length - 1]?.content.push(element);
  }
  for (const link of main.querySelectorAll("a[href]")) {
    link.setAttribute("href", new URL(link.getAttribute("href") ?? "", base).href);
    link.setAttribute("target", "_blank");
  }
  return steps.filter((s) => s.content.length > 0);
}

export class Tour {
  /** @param {HTMLElement} host @param {string} name  of the script */
  constructor(host, name) {
    this.host = host;
    this.name = name;
    /** @type {Promise<Step[]> | null} */
    this.steps = null;
    this.at = 0;
    this.box = h("section", { id: "tour", "aria-label": "Tour", hidden: true });
    host.querySelector(".bar")?.after(this.box);
  }

  async load() {
    const base = new URL(CHAPTER, document.baseURI).href, answer = await fetch(base);
    if (!answer.ok) throw new Error("the documentation is not beside this page");
    return readSteps(new DOMParser().parseFromString(await answer.text(), "text/html"), base);
  }

  get isOpen() {
    return !this.box.hidden;
  }

  toggle() {
    if (this.box.hidden) this.show(this.at);
    else this.box.hidden = true;
  }

  /** @param {number} at */
  async show(at) {
    this.box.hidden = false;
    try {
      const steps = await (this.steps ??= this.load());
      this.at = Math.min(Math.max(at, 0), steps.length - 1);
      this.fill(steps[this.at], steps.length);
    } catch (error) {
      this.steps = null;
      this.box.replaceChildren(h("p", {}, `The tour cannot be shown: ${/** @type {Error} */ (error).message}.`));
    }
  }

  /** @param {Step} step @param {number} count */
  fill(step, count) {
    const content = step.content.map((e) => /** @type {HTMLElement} */ (document.importNode(e, true)));
    const body = h("div", { class: "tour-text" }, ...content);
    for (const example of body.querySelectorAll(".example")) {
      example.querySelector("a.edit")?.remove();
      const text = example.querySelector(".code code")?.textContent ?? "";
      example.prepend(h("button", { type: "button", class: "try", onclick: () => this.open(text) }, "Open in the editor"));
    }
    const go = (/** @type {number} */ by, /** @type {string} */ label) => h("button", { type: "button", disabled: this.at + by < 0 || this.at + by >= count, onclick: () => this.show(this.at + by) }, label);
    this.box.replaceChildren(
      h("div", { class: "row" }, h("h2", {}, step.title), h("span", { class: "space" }), h("span", { class: "faint" }, `${this.at + 1} of ${count}`),
        go(-1, "Back"), go(1, "Next"), h("button", { type: "button", class: "quiet", onclick: () => this.toggle() }, "Close")), body);
    body.scrollTop = 0;
  }

  /** @param {string} text */
  async open(text) {
    location.hash = await writeFragment({ name: /^\/\/ (\w+\.cag)$/m.exec(text)?.[1] ?? this.name, text, tour: String(this.at) });
  }
}
