// The files of the model: their texts, what is unsaved, tabs, and what to do when a file changed on the disk meanwhile.

import { download, h } from "./dom.js";
import { diffLines, isModule } from "./places.js";
import { Topic } from "./topic.js";

/** @typedef {{ version: string, saved: string }} OpenFile  the version and text on the disk */

export class Files {
  /**
   * @param {HTMLElement} tabs
   * @param {import("./engine.js").Engine} engine
   * @param {import("./editor.js").Editor} editor
   * @param {(error: Error) => void} report
   * @param {boolean} [kept]  unsaved texts are kept when the page is left
   */
  constructor(tabs, engine, editor, report, kept = false) {
    this.tabs = tabs;
    this.engine = engine;
    this.editor = editor;
    this.report = report;
    /** @type {Map<string, OpenFile>} */
    this.open = new Map();
    /** Other files that the run read. @type {string[]} */
    this.others = [];
    /** A file was saved, or taken from the disk. @type {Topic<void>} */
    this.settled = new Topic();
    this.fileless = ""; // a script that has no file yet
    this.asking = false;
    this.key = ""; // what the tabs show
    editor.changed.on(() => this.showTabs());
    editor.saveWanted.on(() => this.save());
    // Leaving the page asks if something is unsaved.
    addEventListener("beforeunload", (e) => {
      if (!kept && [...this.open.keys()].some((p) => this.isDirty(p))) e.preventDefault();
    });
  }

  /** @param {string} path */
  isDirty(path) {
    const file = this.open.get(path);
    return file !== undefined && this.editor.text(path) !== file.saved;
  }

  /** The texts that the engine does not have in a file, or null. @returns {Record<string, string> | null} */
  get unsaved() {
    const dirty = [...this.open.keys()].filter((p) => p === this.fileless || this.isDirty(p));
    return dirty.length ? Object.fromEntries(dirty.map((p) => [p, this.editor.text(p) ?? ""])) : null;
  }

  /** Opens a file and shows it. @param {string} path */
  async show(path) {
    if (!this.open.has(path)) await this.load(path);
    this.editor.show(path);
    this.showTabs();
  }

  /** @param {string} path */
  async load(path) {
    const { text, version } = await this.engine.read(path);
    this.open.set(path, { version, saved: text });
    this.editor.open(path, text);
  }

  /** An empty script, which has no file yet. @param {string} path */
  begin(path) {
    this.fileless = path;
    this.open.set(path, { version: "", saved: "" });
    this.editor.open(path, "");
    this.editor.show(path);
    this.showTabs();
  }

  /** @param {string[]} files  of the scene */
  list(files) {
    this.others = files;
    this.showTabs();
  }

  showTabs() {
    const paths = [...new Set([...this.open.keys(), ...this.others])];
    const key = JSON.stringify([this.editor.path, paths.map((p) => [p, this.isDirty(p)])]);
    if (key === this.key) return;
    this.key = key;
    const focused = this.tabs.contains(document.activeElement);
    this.tabs.replaceChildren(...paths.map((path) => {
      const shown = path === this.editor.path;
      const name = path.split("/").pop() ?? path;
      return h("button", { type: "button", role: "tab", "aria-selected": String(shown), tabindex: shown ? 0 : -1, title: path,
        onclick: () => this.show(path).catch(this.report), onkeydown: (/** @type {KeyboardEvent} */ e) => this.arrow(e) },
        name, this.isDirty(path) ? h("span", { class: "dirty", title: "unsaved" }, " ●") : null);
    }));
    if (focused) /** @type {HTMLElement | null} */ (this.tabs.querySelector("[aria-selected=true]"))?.focus();
  }

  /** @param {KeyboardEvent} e */
  arrow(e) {
    const step = { ArrowLeft: -1, ArrowRight: 1 }[e.key];
    if (!step || !(e.currentTarget instanceof HTMLElement)) return;
    const tabs = [...this.tabs.children], next = tabs[tabs.indexOf(e.currentTarget) + step];
    if (next instanceof HTMLElement) next.click();
  }

  /** Saves the file that is shown. A script without a file is downloaded. */
  async save() {
    const path = this.editor.path, file = this.open.get(path), text = this.editor.text(path);
    if (!file || text === null || this.editor.readOnly || isModule(path)) return;
    if (path === this.fileless) {
      download(path, new Blob([text], { type: "text/plain" }));
      this.open.set(path, { version: "", saved: text });
      this.showTabs();
      return;
    }
    try {
      const { saved, version } = await this.engine.write(path, text, file.version);
      if (!saved) return await this.ask(path);
      this.open.set(path, { version, saved: text });
      this.showTabs();
      this.settled.emit(undefined);
    } catch (error) {
      this.report(/** @type {Error} */ (error));
    }
  }

  /** A file changed on the disk. @param {import("./engine.js").FileVersion} change */
  async changedOnDisk({ path, version }) {
    const file = this.open.get(path);
    if (!file || file.version === version) return;
    if (this.isDirty(path)) return this.ask(path);
    try {
      const { text, version: now } = await this.engine.read(path);
      if (this.isDirty(path)) return this.ask(path);
      this.take(path, text, now);
    } catch (error) {
      this.report(/** @type {Error} */ (error));
    }
  }

  /** Takes what changed on the disk while no server watched it. */
  async compareWithDisk() {
    for (const path of this.open.keys()) {
      if (isModule(path)) continue;
      try {
        await this.changedOnDisk({ path, version: (await this.engine.read(path)).version });
      } catch (error) {
        this.report(/** @type {Error} */ (error));
      }
    }
  }

  /** Takes the text on the disk. @param {string} path @param {string} text @param {string} version */
  take(path, text, version) {
    this.open.set(path, { version, saved: text });
    this.editor.open(path, text);
    this.showTabs();
  }

  /** Asks which text to keep: that of the editor or that on the disk. @param {string} path */
  async ask(path) {
    if (this.asking) return;
    this.asking = true;
    try {
      const theirs = await this.engine.read(path), mine = this.editor.text(path) ?? "";
      const choice = theirs.text === mine ? "theirs" : await conflictDialog(path, mine, theirs.text);
      if (choice === "theirs") this.take(path, theirs.text, theirs.version);
      else if (choice === "mine") this.open.set(path, { version: theirs.version, saved: theirs.text });
      this.asking = false;
      this.showTabs();
      if (choice === "mine") await this.save();
      else if (choice === "theirs") this.settled.emit(undefined);
    } catch (error) {
      this.report(/** @type {Error} */ (error));
    } finally {
      this.asking = false;
    }
  }
}

/**
 * @param {string} path
 * @param {string} mine
 * @param {string} theirs
 * @returns {Promise<"mine" | "theirs" | "">}  "": decide later
 */
function conflictDialog(path, mine, theirs) {
  const lines = diffLines(theirs, mine);
  const compare = h("pre", { class: "compare", hidden: true, tabindex: 0, "aria-label": "Differences: - on disk, + in the editor" },
    ...lines.map((l) => h("span", { class: l.kind === "+" ? "added" : l.kind === "-" ? "removed" : "" }, `${l.kind} ${l.text}\n`)));
  const button = (/** @type {string} */ value, /** @type {string} */ text) => h("button", { value }, text);
  const dialog = h("dialog", { "aria-label": "The file changed" }, h("form", { method: "dialog", class: "stack" },
    h("p", {}, h("strong", {}, path), " changed on disk, and the editor has unsaved changes."),
    compare,
    h("div", { class: "row" }, button("mine", "Save mine"), button("theirs", "Take theirs"),
      h("button", { type: "button", onclick: () => (compare.hidden = !compare.hidden) }, "Compare"), button("", "Decide later"))));
  document.body.append(dialog);
  dialog.showModal();
  return new Promise((done) => dialog.addEventListener("close", () => {
    dialog.remove();
    done(/** @type {"mine" | "theirs" | ""} */ (dialog.returnValue));
  }));
}
