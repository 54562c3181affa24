// The text editor around the page, in place of the page's own: it has the same methods as Editor, as far as the page uses them.
//
// The editor sends the text of each open script, and where its cursor is. What the page changes is seen by the page at once, and sent to the
// editor as one step to undo. Changes that are made at the same time are one step.

import { Topic } from "./topic.js";

/** @typedef {{ path: string, text: string, dirty: boolean, version: number }} RemoteDocument  the version of the editor */
/** @typedef {{ from: number, to: number, insert: string }} Change */

/**
 * A text as the page sees it, and how it differs from that of the editor.
 *
 * @typedef {object} RemoteText
 * @property {string} text
 * @property {boolean} open  in the editor
 * @property {boolean} dirty
 * @property {number | null} version  of `base`; null: not open
 * @property {string} base  the text of the editor
 * @property {Change[]} changes  of `base`, in order, that were not sent yet
 * @property {boolean} due  the changes are to be sent; otherwise, more will come
 * @property {boolean} awaiting  changes were sent and not answered
 * @property {RemoteDocument | null} held  arrived meanwhile
 */

/**
 * Adds a change to changes of a base, which stay ordered and apart.
 *
 * @param {Change[]} changes
 * @param {Change} change  of the text that the changes make
 * @returns {Change[]}
 */
export function compose(changes, { from, to, insert }) {
  /** @type {Change[]} */
  const before = [], after = [];
  let shift = 0; // from the base to the text
  let start = -1, end = -1, head = "", tail = "";
  for (const c of changes) {
    const cFrom = c.from + shift, cTo = cFrom + c.insert.length;
    if (cTo < from) before.push(c);
    else if (cFrom > to) after.push(c);
    else {
      if (start < 0) start = Math.min(from - shift, c.from);
      if (cFrom < from) head = c.insert.slice(0, from - cFrom);
      tail = cTo > to ? c.insert.slice(to - cFrom) : "";
    }
    if (cFrom <= to) {
      shift += c.insert.length - (c.to - c.from);
      if (cTo >= from) end = cTo > to ? c.to : to - shift;
    }
  }
  if (start < 0) [start, end] = [from - shift, to - shift];
  return [...before, { from: start, to: end, insert: head + insert + tail }, ...after];
}

export class RemoteEditor {
  /** @param {import("./webview.js").Webview} webview @param {string} path  of the script @param {(error: Error) => void} report */
  constructor(webview, path, report) {
    this.webview = webview;
    this.path = path;
    this.report = report;
    this.cursor = { line: 0, column: 0 };
    /** @type {Map<string, RemoteText>} */
    this.texts = new Map();
    this.quiet = false; // a change under way is not typed
    this.sending = false;
    this.readOnly = false;
    this.values = /** @type {import("./engine.js").RunMessages["values"]} */ ([]);
    this.showsValues = true;
    /** @type {Topic<string>} */
    this.changed = new Topic();
    /** @type {Topic<void>} */
    this.cursorMoved = new Topic();
    /** The fixes are offered by the editor. @type {Topic<void>} */
    this.fixesChanged = new Topic();
    /** A file was saved, or its changes were given up. @type {Topic<void>} */
    this.settled = new Topic();
    /** The path of a file that the editor has closed. @type {Topic<string>} */
    this.closed = new Topic();
    webview.on("document", ({ document }) => this.take(document));
    webview.on("closed", ({ path: closed }) => this.close(closed));
    webview.on("cursor", ({ path: at, line, column }) => {
      this.path = at;
      this.cursor = { line, column };
      this.cursorMoved.emit(undefined);
    });
    webview.post("ready");
  }

  /** @param {string} path @returns {string | null} */
  text(path) {
    return this.texts.get(path)?.text ?? null;
  }

  line() {
    return this.cursor.line;
  }

  /** From 1, in code points. */
  column() {
    return this.cursor.column;
  }

  /** Whether the user works in the editor. */
  hasFocus() {
    return !document.hasFocus();
  }

  /** @param {string} path */
  isOpen(path) {
    return this.texts.get(path)?.open ?? false;
  }

  /** The texts that differ from the files, or null. @returns {Record<string, string> | null} */
  get unsaved() {
    const dirty = [...this.texts].filter(([, t]) => t.dirty).map(([path, t]) => [path, t.text]);
    return dirty.length ? Object.fromEntries(dirty) : null;
  }

  /** Takes the text of a file that is not open in the editor. @param {string} path @param {string} text */
  open(path, text) {
    if (!this.isOpen(path)) this.texts.set(path, { text, open: false, dirty: false, version: null, base: text, changes: [], due: false, awaiting: false, held: null });
  }

  /** Takes what the editor has. @param {RemoteDocument} document */
  take(document) {
    const { path, text, dirty, version } = document, known = this.texts.get(path);
    if (known && (known.awaiting || known.changes.length)) {
      known.held = document;
      return;
    }
    this.texts.set(path, { text, open: true, dirty, version, base: text, changes: [], due: false, awaiting: false, held: null });
    this.settle(path, known ?? null);
  }

  /** Tells what is new. @param {string} path @param {RemoteText | null} before */
  settle(path, before) {
    const now = this.texts.get(path), dirty = now?.dirty ?? false;
    if (before?.dirty && !dirty) this.settled.emit(undefined);
    else if (dirty && (now?.text !== before?.text || !before?.dirty)) this.changed.emit(path);
  }

  /** The file was closed in the editor. @param {string} path */
  close(path) {
    const known = this.texts.get(path) ?? null;
    this.texts.delete(path);
    this.settle(path, known);
    this.closed.emit(path);
  }

  /** @param {string} path @param {number} from @param {number} to @param {string} insert */
  replace(path, from, to, insert) {
    this.change(path, [{ from, to, insert }]);
  }

  /**
   * Changes parts of a file.
   *
   * @param {string} path
   * @param {Change[]} changes
   * @param {"step" | "hidden" | undefined} [history]  hidden: not sent before a change that is not hidden
   */
  change(path, changes, history) {
    const t = this.texts.get(path);
    if (!t) return;
    // From the end, so that positions stay.
    for (const c of [...changes].sort((a, b) => b.from - a.from)) {
      t.text = t.text.slice(0, c.from) + c.insert + t.text.slice(c.to);
      t.changes = compose(t.changes, c).filter((d) => t.base.slice(d.from, d.to) !== d.insert);
    }
    t.due = history !== "hidden" && t.changes.length > 0;
    t.dirty ||= t.changes.length > 0;
    this.changed.emit(path);
    if (t.due) queueMicrotask(() => this.send());
    else this.release(path, t);
  }

  /** Makes changes that do not run the script by themselves. @param {() => void} make */
  quietly(make) {
    this.quiet = true;
    try {
      make();
    } finally {
      this.quiet = false;
    }
  }

  /** Takes what arrived while the text had changes of the page. @param {string} path @param {RemoteText} t */
  release(path, t) {
    if (t.awaiting || t.changes.length || this.texts.get(path) !== t) return;
    const { held } = t;
    t.held = null;
    if (held) this.take(held);
  }

  /** Sends the changes, those of one moment after those of the other. */
  async send() {
    if (this.sending) return;
    this.sending = true;
    for (;;) {
      const due = [...this.texts].filter(([, t]) => t.due);
      if (due.length === 0) break;
      const files = due.map(([path, t]) => ({ path, version: t.version, changes: t.changes.map((c) => ({ ...c, old: t.base.slice(c.from, c.to) })) }));
      for (const [, t] of due) Object.assign(t, { base: t.text, changes: [], due: false, awaiting: true });
      try {
        const { problem, documents } = await this.webview.ask("edit", { files });
        if (problem) this.report(new Error(problem));
        for (const document of documents) this.agree(document);
      } catch (error) {
        this.report(/** @type {Error} */ (error));
      }
      for (const [path, t] of due) {
        t.awaiting = false;
        this.release(path, t);
      }
    }
    this.sending = false;
  }

  /** Takes a text as it is after changes were sent. @param {RemoteDocument} document */
  agree(document) {
    const t = this.texts.get(document.path);
    if (!t) return;
    t.held = null;
    if (document.text === t.base) Object.assign(t, { open: true, version: document.version, dirty: document.dirty || t.changes.length > 0 });
    else {
      // Somebody else has changed the text: what the page has changed since is given up.
      Object.assign(t, { changes: [], due: false, awaiting: false });
      this.take(document);
    }
  }

  /** The editor shows a location. @param {import("./engine.js").Place} place @param {boolean} [focus] */
  select({ file, line, column, endLine, endColumn }, focus = true) {
    this.webview.post("reveal", { place: { file, line, column, endLine, endColumn }, focus });
  }

  /** Marks a range of a file, or nothing. @param {string} path @param {[number, number] | null} range @param {boolean} [scroll] */
  mark(path, range, scroll = false) {
    this.webview.post("mark", { path, range, scroll });
  }

  save() {
    this.webview.post("save", { path: this.path });
  }

  /** Takes back the last step of the editor, or does it again. @param {boolean} again */
  undo(again) {
    this.webview.post("undo", { path: this.path, again });
  }

  /** The language server shows the problems in the editor, and has the fixes. */
  setProblems() {}

  /** @returns {{ name: string, apply: () => void }[]} */
  fixesOf() {
    return [];
  }

  /** @param {import("./engine.js").RunMessages["values"]} values */
  setValues(values) {
    this.values = values;
    this.markValues();
  }

  markValues() {
    this.webview.post("values", { values: this.showsValues ? this.values.map(({ file, endLine, text }) => ({ file, endLine, text })) : [] });
  }
}

/** In place of Files: the files are those of the editor. */
export class RemoteFiles {
  /** @param {import("./engine.js").Engine} engine @param {RemoteEditor} editor @param {(error: Error) => void} report */
  constructor(engine, editor, report) {
    this.engine = engine;
    this.editor = editor;
    this.report = report;
    this.settled = editor.settled;
    editor.closed.on((path) => this.load(path).catch(report));
  }

  get unsaved() {
    return this.editor.unsaved;
  }

  /** Knows the text of a file. The editor shows it when a location is selected. @param {string} path */
  async show(path) {
    if (this.editor.text(path) === null) await this.load(path);
  }

  /** @param {string} path */
  async load(path) {
    this.editor.open(path, (await this.engine.read(path)).text);
  }

  begin() {}

  list() {}

  async save() {
    this.editor.save();
  }

  /** The editor watches its files. */
  async compareWithDisk() {}

  /** The editor watches the files that it has open. @param {import("./engine.js").FileVersion} change */
  async changedOnDisk({ path }) {
    if (this.editor.text(path) !== null && !this.editor.isOpen(path)) await this.load(path).catch(this.report);
  }
}
