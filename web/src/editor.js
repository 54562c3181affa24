// The editor: one view, and a state for each file that is open.
//
// The editor is in a shadow root. There, CodeMirror adds its styles as constructed style sheets, which need no exception in the
// Content-Security-Policy.

import { acceptCompletion } from "@codemirror/autocomplete";
import { indentWithTab, isolateHistory, redo, undo } from "@codemirror/commands";
import { setDiagnostics } from "@codemirror/lint";
import { EditorState, StateEffect, StateField, Transaction } from "@codemirror/state";
import { Decoration, EditorView, keymap } from "@codemirror/view";
import { basicSetup } from "codemirror";
import { assistance, changesOf, completeBy, offsetIn } from "./assist.js";
import { cag, cagLanguage } from "./cag_language.js";
import { Language } from "./language.js";
import { lineValues, showLineValues } from "./line_values.js";
import { isModule, rangeOf } from "./places.js";
import { Topic } from "./topic.js";

/** @typedef {import("./engine.js").Diagnostic} Diagnostic */

const theme = EditorView.theme({
  "&": { height: "100%", color: "var(--text)", backgroundColor: "var(--editor)", fontSize: "13px" },
  ".cm-scroller": { fontFamily: "var(--mono)", lineHeight: "1.5" },
  ".cm-content": { caretColor: "var(--text)", padding: "6px 0" },
  ".cm-cursor": { borderLeftColor: "var(--text)" },
  "&.cm-focused": { outline: "none" },
  ".cm-gutters": { backgroundColor: "var(--editor)", color: "var(--faint)", border: "none" },
  ".cm-activeLine": { backgroundColor: "var(--line)" },
  ".cm-activeLineGutter": { backgroundColor: "var(--line)", color: "var(--text)" },
  "&.cm-focused > .cm-scroller > .cm-selectionLayer .cm-selectionBackground, .cm-selectionBackground": { backgroundColor: "var(--selection)" },
  ".cm-matchingBracket, &.cm-focused .cm-matchingBracket": { backgroundColor: "var(--selection)", outline: "none" },
  ".cm-selectionMatch": { backgroundColor: "var(--line)" },
  ".cm-shown": { backgroundColor: "var(--selection)", borderRadius: "2px" },
  ".cm-tooltip": { backgroundColor: "var(--raised)", border: "1px solid var(--border)", color: "var(--text)", fontSize: "13px" },
  ".cm-tooltip-autocomplete ul li[aria-selected]": { backgroundColor: "var(--accent)", color: "var(--on-accent)" },
  ".cm-panels": { backgroundColor: "var(--raised)", color: "var(--text)", borderColor: "var(--border)" },
  ".cm-panels input, .cm-panels button": { color: "var(--text)", backgroundColor: "var(--field)", backgroundImage: "none", border: "1px solid var(--border)" },
  ".cm-value": { color: "var(--faint)", paddingLeft: "2em", fontStyle: "italic", pointerEvents: "none" },
  ".cm-signature, .cm-described, .cm-completionInfo": { padding: "4px 8px", maxWidth: "36em", maxHeight: "20em", overflow: "auto" },
  ".cm-signature strong": { color: "var(--accent)" },
  ".markdown p, .markdown pre, .markdown ul": { margin: "4px 0" },
  ".markdown pre, .markdown code, .cm-signature code": { fontFamily: "var(--mono)", fontSize: "12px", whiteSpace: "pre-wrap" },
  ".markdown hr": { border: "none", borderTop: "1px solid var(--border)" },
  ".cm-diagnosticAction": { backgroundColor: "var(--accent)", color: "var(--on-accent)", borderRadius: "3px", padding: "1px 8px", cursor: "pointer" },
  ".cm-diagnostic-error": { borderLeftColor: "var(--error)" },
  ".cm-diagnostic-warning": { borderLeftColor: "var(--warning)" },
  // The images of CodeMirror are data, which the Content-Security-Policy forbids.
  ".cm-lintRange-error": { backgroundImage: "none", textDecoration: "underline wavy var(--error)", textUnderlineOffset: "3px" },
  ".cm-lintRange-warning": { backgroundImage: "none", textDecoration: "underline wavy var(--warning)", textUnderlineOffset: "3px" },
});

// The range that a click on a location shows.
const markRange = /** @type {import("@codemirror/state").StateEffectType<[number, number] | null>} */ (StateEffect.define());
const marked = StateField.define({
  create: () => Decoration.none,
  update(value, transaction) {
    for (const effect of transaction.effects)
      if (effect.is(markRange)) {
        const range = effect.value;
        return range && range[1] > range[0] ? Decoration.set([Decoration.mark({ class: "cm-shown" }).range(...range)]) : Decoration.none;
      }
    return transaction.docChanged ? value.map(transaction.changes) : value;
  },
  provide: (field) => EditorView.decorations.from(field),
});

const CHECK_PAUSE = 30; // milliseconds from the last change

/** @typedef {import("./language.js").Problem} Problem */
/** @typedef {{ name: string, problem: Problem, apply: () => void }} Fix */

export class Editor {
  /**
   * @param {HTMLElement} host
   * @param {object} options
   * @param {boolean} options.readOnly
   * @param {string} options.folder  of the scripts
   * @param {import("./engine.js").Engine["lsp"]} options.lsp
   * @param {(path: string) => Promise<void>} options.load  opens a file without showing it
   * @param {(place: import("./engine.js").Place) => void} options.go
   * @param {(text: string) => void} options.say
   */
  constructor(host, { readOnly, folder, lsp, load, go, say }) {
    this.host = host;
    this.readOnly = readOnly;
    this.load = load;
    this.language = new Language(lsp, folder, () => this.texts());
    /** What the language server found, by path. @type {Map<string, Problem[]>} */
    this.found = new Map();
    /** @type {Map<string, Fix[]>} */
    this.fixes = new Map();
    /** Other fixes are known. @type {Topic<void>} */
    this.fixesChanged = new Topic();
    this.stale = false; // a text has changed since the last run
    this.checkTimer = 0;
    /** @type {import("./engine.js").RunMessages["values"]} */
    this.values = [];
    this.showsValues = true;
    this.language.published.on(({ path, problems }) => this.takeProblems(path, problems));
    this.assistance = assistance({
      language: this.language, path: () => this.path, apply: (edit) => this.apply(edit), say,
      go: (path, range) => go({ file: path, line: range.start.line + 1, column: range.start.character + 1, endLine: range.end.line + 1, endColumn: range.end.character + 1 }),
      problems: () => this.found.get(this.path) ?? [],
    });
    /** The path of the file whose text changed. @type {Topic<string>} */
    this.changed = new Topic();
    /** @type {Topic<void>} */
    this.cursorMoved = new Topic();
    /** @type {Topic<void>} */
    this.saveWanted = new Topic();
    /** @type {Map<string, EditorState>} */
    this.states = new Map();
    this.path = "";
    this.quiet = false; // a change under way is not typed
    /** @type {Diagnostic[]} */
    this.problems = [];
    const root = host.attachShadow({ mode: "open" });
    this.view = new EditorView({ root, parent: root });
  }

  /** The texts of the open files. @returns {[string, string][]} */
  texts() {
    return [...this.states.keys()].map((path) => [path, this.text(path) ?? ""]);
  }

  /** @param {string} path @param {string} text */
  state(path, text) {
    const readOnly = this.readOnly || isModule(path);
    return EditorState.create({
      doc: text,
      extensions: [
        keymap.of([
          { key: "Mod-s", run: () => (this.saveWanted.emit(undefined), true), preventDefault: true },
          { key: "Tab", run: acceptCompletion },
          // Tab leaves the editor after Escape, so that the page can be used without a pointer.
          indentWithTab,
        ]),
        this.assistance, basicSetup, cag(), theme, marked, lineValues,
        cagLanguage.data.of({ autocomplete: completeBy(this.language, () => this.path) }),
        EditorState.readOnly.of(readOnly), EditorView.editable.of(!readOnly),
        EditorView.contentAttributes.of({ "aria-label": "Script", spellcheck: "false", ...(readOnly ? { tabindex: "0" } : {}) }),
        EditorView.updateListener.of((update) => {
          if (update.docChanged) this.noteChange(this.path);
          if (update.selectionSet || update.docChanged) this.cursorMoved.emit(undefined);
        }),
      ],
    });
  }

  /** The line of the cursor, from 1. */
  line() {
    const { state } = this.view;
    return state.doc.lineAt(state.selection.main.head).number;
  }

  /** The column of the cursor, from 1, in code points. */
  column() {
    const { state } = this.view, at = state.selection.main.head, line = state.doc.lineAt(at);
    return [...line.text.slice(0, at - line.from)].length + 1;
  }

  /** Opens a file, or gives an open file another text. @param {string} path @param {string} text */
  open(path, text) {
    const current = this.text(path);
    if (current === text) return;
    if (current === null) {
      this.states.set(path, this.state(path, text));
      this.checkSoon();
    } else {
      // Only what differs is replaced, so that the cursor stays where it is.
      const most = Math.min(current.length, text.length);
      let head = 0, tail = 0;
      while (head < most && current[head] === text[head]) head++;
      while (tail < most - head && current[current.length - 1 - tail] === text[text.length - 1 - tail]) tail++;
      this.replace(path, head, current.length - tail, text.slice(head, text.length - tail));
    }
  }

  /** @param {string} path */
  close(path) {
    this.states.delete(path);
  }

  /** Changes a part of a file, as one step to undo. @param {string} path @param {number} from @param {number} to @param {string} insert */
  replace(path, from, to, insert) {
    this.change(path, [{ from, to, insert }]);
  }

  /**
   * Changes parts of a file.
   *
   * @param {string} path
   * @param {{ from: number, to: number, insert: string }[]} changes
   * @param {"step" | "hidden" | undefined} [history]  a step to undo by itself, or none; undefined: as typing is
   */
  change(path, changes, history) {
    const annotations = history === "step" ? isolateHistory.of("full") : history === "hidden" ? Transaction.addToHistory.of(false) : undefined;
    if (path === this.path) this.view.dispatch({ changes, annotations });
    else {
      const state = this.states.get(path);
      if (state) this.states.set(path, state.update({ changes, annotations }).state);
      this.noteChange(path);
    }
  }

  /** @param {string} path */
  noteChange(path) {
    this.stale = true;
    this.checkSoon();
    this.changed.emit(path);
  }

  /** Applies a change of several files. @param {import("./language.js").WorkspaceEdit} edit */
  async apply(edit) {
    const all = Object.entries(edit.changes ?? {}).map(([uri, edits]) => ({ path: this.language.path(uri), edits }));
    for (const { path } of all) if (this.text(path) === null) await this.load(path);
    for (const { path, edits } of all) {
      const state = path === this.path ? this.view.state : this.states.get(path);
      if (!state) continue;
      const changes = changesOf(state.doc, edits);
      if (path === this.path) this.view.dispatch({ changes });
      else {
        this.states.set(path, state.update({ changes }).state);
        this.noteChange(path);
      }
    }
  }

  /** Takes back the last step in the file that is shown, or does it again. @param {boolean} again */
  undo(again) {
    (again ? redo : undo)(this.view);
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

  /** @param {string} path @returns {string | null} */
  text(path) {
    if (path === this.path) return this.view.state.doc.toString();
    return this.states.get(path)?.doc.toString() ?? null;
  }

  /** @param {string} path */
  show(path) {
    const state = this.states.get(path);
    if (!state || path === this.path) return;
    if (this.path) this.states.set(this.path, this.view.state);
    this.path = path;
    this.view.setState(state);
    this.markProblems();
    this.markValues();
  }

  /** Selects a place in the file that is shown. @param {import("./engine.js").Place} place @param {boolean} [focus] */
  select(place, focus = true) {
    const [from, to] = rangeOf(this.view.state.doc.toString(), place);
    this.view.dispatch({
      selection: { anchor: from, head: to },
      effects: [EditorView.scrollIntoView(from, { y: "center" }), markRange.of([from, to])],
    });
    if (focus) this.view.focus();
  }

  /**
   * Marks a range of a file, or nothing. The cursor stays.
   *
   * @param {string} path
   * @param {[number, number] | null} range
   * @param {boolean} [scroll]  so that it is seen
   */
  mark(path, range, scroll = false) {
    if (path !== this.path) return;
    const seen = range && scroll ? [EditorView.scrollIntoView(range[0], { y: "nearest", x: "nearest", yMargin: 40, xMargin: 40 })] : [];
    this.view.dispatch({ effects: [...seen, markRange.of(range)] });
  }

  /** @param {Diagnostic[]} problems */
  setProblems(problems) {
    this.problems = problems;
    this.stale = false;
    this.markProblems();
  }

  /** Looks for problems when nothing has changed for a moment. */
  checkSoon() {
    clearTimeout(this.checkTimer);
    // Without a connection, the page says so elsewhere.
    this.checkTimer = window.setTimeout(() => this.language.check().catch(() => {}), CHECK_PAUSE);
  }

  /** Takes what the language server found in a file, and asks for the fixes. @param {string} path @param {Problem[]} problems */
  async takeProblems(path, problems) {
    this.found.set(path, problems);
    this.fixes.delete(path);
    this.markProblems();
    const text = this.text(path);
    if (problems.length === 0 || text === null || isModule(path)) return this.fixesChanged.emit(undefined);
    const whole = { start: { line: 0, character: 0 }, end: { line: text.split("\n").length, character: 0 } };
    const actions = await this.language.actions(path, whole, problems, ["quickfix"]).catch(() => []);
    if (this.found.get(path) !== problems) return;
    this.fixes.set(path, actions.flatMap((a) => (a.diagnostics ?? []).map((problem) => ({ name: a.title, problem, apply: () => a.edit && this.apply(a.edit) }))));
    this.markProblems();
    this.fixesChanged.emit(undefined);
  }

  /** The fixes of a problem that a run reported. @param {Diagnostic} d */
  fixesOf(d) {
    return (this.fixes.get(d.file) ?? []).filter(({ problem }) => problem.code === d.code && problem.range.start.line + 1 === d.line);
  }

  markProblems() {
    const { state } = this.view, found = this.found.get(this.path) ?? [], fixes = this.fixes.get(this.path) ?? [];
    const isKnown = (/** @type {Diagnostic} */ d) => found.some((p) => p.code === d.code && p.range.start.line + 1 === d.line);
    const marks = found.map((p) => {
      const actions = fixes.filter((f) => f.problem.code === p.code && JSON.stringify(f.problem.range) === JSON.stringify(p.range));
      const severity = /** @type {"error" | "warning"} */ (p.severity === 1 ? "error" : "warning");
      return { ...span(state.doc, offsetIn(state.doc, p.range.start), offsetIn(state.doc, p.range.end)), severity, source: p.code, message: p.message, actions };
    });
    // A run finds more, but what it found before the last change may not be true any more.
    for (const p of this.stale ? [] : this.problems) {
      if (p.file !== this.path || isKnown(p)) continue;
      const [from, end] = rangeOf(state.doc.toString(), p);
      marks.push({ ...span(state.doc, from, end), severity: p.severity, source: p.code, message: p.help ? `${p.message}\nhelp: ${p.help}` : p.message, actions: [] });
    }
    this.view.dispatch(setDiagnostics(state, marks));
  }

  /** @param {import("./engine.js").RunMessages["values"]} values */
  setValues(values) {
    this.values = values;
    this.markValues();
  }

  markValues() {
    const own = this.showsValues ? this.values.filter((v) => v.file === this.path) : [];
    showLineValues(this.view, own.map((v) => ({ line: v.endLine, text: v.text })));
  }

  hasFocus() {
    return document.activeElement === this.host;
  }
}

/** A range of no length is seen as one character. @param {import("@codemirror/state").Text} doc @param {number} from @param {number} end */
function span(doc, from, end) {
  const to = Math.min(doc.length, Math.max(end, from + 1));
  return { from: Math.min(from, to), to };
}
