// The editor: one view, and a state for each file that is open.
//
// The editor is in a shadow root. There, CodeMirror adds its styles as constructed style sheets, which need no exception in the
// Content-Security-Policy.

import { acceptCompletion, completeAnyWord } from "@codemirror/autocomplete";
import { indentWithTab, isolateHistory, redo, undo } from "@codemirror/commands";
import { setDiagnostics } from "@codemirror/lint";
import { EditorState, StateEffect, StateField, Transaction } from "@codemirror/state";
import { Decoration, EditorView, keymap } from "@codemirror/view";
import { basicSetup } from "codemirror";
import { cag, cagLanguage } from "./cag_language.js";
import { rangeOf } from "./places.js";
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

export class Editor {
  /** @param {HTMLElement} host @param {boolean} readOnly */
  constructor(host, readOnly) {
    this.host = host;
    this.readOnly = readOnly;
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

  /** @param {string} text */
  state(text) {
    return EditorState.create({
      doc: text,
      extensions: [
        keymap.of([
          { key: "Mod-s", run: () => (this.saveWanted.emit(undefined), true), preventDefault: true },
          { key: "Tab", run: acceptCompletion },
          // Tab leaves the editor after Escape, so that the page can be used without a pointer.
          indentWithTab,
        ]),
        basicSetup, cag(), theme, marked,
        cagLanguage.data.of({ autocomplete: completeAnyWord }),
        EditorState.readOnly.of(this.readOnly), EditorView.editable.of(!this.readOnly),
        EditorView.contentAttributes.of({ "aria-label": "Script", spellcheck: "false", ...(this.readOnly ? { tabindex: "0" } : {}) }),
        EditorView.updateListener.of((update) => {
          if (update.docChanged) this.changed.emit(this.path);
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

  /** Opens a file, or gives an open file another text. @param {string} path @param {string} text */
  open(path, text) {
    const current = this.text(path);
    if (current === text) return;
    if (current === null) this.states.set(path, this.state(text));
    else {
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
      this.changed.emit(path);
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
    this.markProblems();
  }

  markProblems() {
    const { state } = this.view, text = state.doc.toString();
    const marks = this.problems.filter((p) => p.file === this.path).map((p) => {
      const [from, end] = rangeOf(text, p);
      // A range of no length is seen as one character.
      const to = Math.min(text.length, Math.max(end, from + 1));
      return { from: Math.min(from, to), to, severity: p.severity, source: p.code, message: p.help ? `${p.message}\nhelp: ${p.help}` : p.message };
    });
    this.view.dispatch(setDiagnostics(state, marks));
  }

  hasFocus() {
    return document.activeElement === this.host;
  }
}
