// The parts of the page: which are shown, and how wide they are. Choices are kept in the browser.

import { byId } from "./dom.js";

const KEY_STEP = 2; // percent of the page's width
const NARROWEST = 15, WIDEST = 75;

/** @param {string} name @returns {string | null} */
function recall(name) {
  try {
    return localStorage.getItem(`cag.${name}`);
  } catch {
    return null; // the browser keeps nothing
  }
}

/** @param {string} name @param {string} value */
function remember(name, value) {
  try {
    localStorage.setItem(`cag.${name}`, value);
  } catch {
    // The choice lasts as long as the page.
  }
}

export class Layout {
  /** @param {() => void} changed */
  constructor(changed) {
    this.changed = changed;
    this.buttons = { editor: byId("toggle-editor", HTMLButtonElement), side: byId("toggle-side", HTMLButtonElement) };
    for (const name of /** @type {const} */ (["editor", "side"])) {
      this.buttons[name].addEventListener("click", () => this.toggle(name));
      if (recall(name) === "off") this.toggle(name);
    }
    document.body.dataset.tab = "middle";
    const tabs = /** @type {HTMLElement[]} */ ([...byId("nav", HTMLElement).children]);
    for (const tab of tabs)
      tab.addEventListener("click", () => {
        document.body.dataset.tab = tab.dataset.tab;
        for (const t of tabs) t.setAttribute("aria-pressed", String(t === tab));
      });
    this.split = byId("split", HTMLDivElement);
    this.width = 0; // of the editor, percent of the page
    this.setWidth(Number(recall("width") ?? 34));
    this.split.addEventListener("pointerdown", (e) => this.split.setPointerCapture(e.pointerId));
    this.split.addEventListener("pointermove", (e) => {
      if (this.split.hasPointerCapture(e.pointerId)) this.setWidth((100 * e.clientX) / innerWidth);
    });
    this.split.addEventListener("keydown", (e) => {
      const step = { ArrowLeft: -KEY_STEP, ArrowRight: KEY_STEP }[e.key];
      if (step) this.setWidth(this.width + step);
    });
  }

  /** @param {"editor" | "side"} name */
  toggle(name) {
    const off = document.body.classList.toggle(`no-${name}`);
    this.buttons[name].setAttribute("aria-pressed", String(!off));
    remember(name, off ? "off" : "on");
    this.changed();
  }

  /** @param {number} percent */
  setWidth(percent) {
    this.width = Math.min(WIDEST, Math.max(NARROWEST, percent || 34));
    document.documentElement.style.setProperty("--left", `${this.width}%`);
    this.split.setAttribute("aria-valuenow", String(Math.round(this.width)));
    remember("width", String(this.width));
  }

  /** The page has no editor of its own. */
  withoutEditor() {
    document.body.classList.add("no-editor", "without-editor");
    this.buttons.editor.hidden = true;
  }
}
