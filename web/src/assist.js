// What the language server does in the editor: completion, descriptions, signatures, and changes of the text.

import { snippet, startCompletion } from "@codemirror/autocomplete";
import { StateEffect, StateField } from "@codemirror/state";
import { EditorView, hoverTooltip, keymap, showTooltip } from "@codemirror/view";
import { h } from "./dom.js";
import { renderMarkdown } from "./markdown.js";

/** @typedef {import("./language.js").Language} Language */
/** @typedef {import("./language.js").Completion} Completion */
/** @typedef {import("./language.js").Signatures} Signatures */
/** @typedef {import("@codemirror/state").Text} Text */

const SIGNATURE_PAUSE = 60; // milliseconds from the last change
const KINDS = ["", "text", "function", "function", "function", "property", "variable", "class", "class", "namespace", "property", "keyword", "constant", "enum", "keyword", "text", "constant", "text", "text", "text", "text", "constant"];

/** @param {Text} doc @param {number} offset @returns {import("./language.js").Position} */
export function positionOf(doc, offset) {
  const line = doc.lineAt(offset);
  return { line: line.number - 1, character: offset - line.from };
}

/** @param {Text} doc @param {import("./language.js").Position} position */
export function offsetIn(doc, position) {
  const line = doc.line(Math.min(position.line + 1, doc.lines));
  return Math.min(line.from + position.character, line.to);
}

/** @param {Text} doc @param {import("./language.js").TextEdit[]} edits */
export const changesOf = (doc, edits) => edits.map((e) => ({ from: offsetIn(doc, e.range.start), to: offsetIn(doc, e.range.end), insert: e.newText }));

/** The gaps of the protocol, `${1:name}` and `$0`, as those of CodeMirror. @param {string} text */
const gaps = (text) => text.replace(/\$(\d+)/g, "${$1}").replace(/\$\{0\}/g, "${}").replace(/\$\{(\d+):([^}]*)\}/g, "${$1:$2}");

/** @param {Completion} item @returns {import("@codemirror/autocomplete").Completion} */
function completionOf(item) {
  const text = item.textEdit.newText, extra = item.additionalTextEdits ?? [];
  return {
    label: item.label, detail: item.detail === item.label ? undefined : item.detail, type: KINDS[item.kind] || "text",
    info: item.documentation ? () => renderMarkdown(item.documentation?.value ?? "") : undefined,
    apply: (view, completion, from, to) => {
      const doc = view.state.doc, start = Math.min(offsetIn(doc, item.textEdit.range.start), from);
      if (item.insertTextFormat === 2) snippet(gaps(text))(view, completion, start, to);
      else view.dispatch({ changes: { from: start, to, insert: text }, selection: { anchor: start + text.length }, userEvent: "input.complete" });
      if (extra.length) view.dispatch({ changes: changesOf(doc, extra) });
    },
  };
}

/** Names that begin with what is written come first, then those that contain it, each in the order of the server. @param {Completion[]} items @param {string} written */
export function sortCompletions(items, written) {
  const key = (/** @type {Completion} */ { label, sortText }) => {
    const at = label.toLowerCase().indexOf(written);
    return `${at === 0 ? 0 : at > 0 ? 1 : 2}${sortText}`;
  };
  return items.map((item) => ({ item, key: key(item) })).sort((a, b) => (a.key < b.key ? -1 : a.key > b.key ? 1 : 0)).map(({ item }) => item);
}

/** @param {Language} language @param {() => string} path @returns {import("@codemirror/autocomplete").CompletionSource} */
export const completeBy = (language, path) => async (context) => {
  const before = context.matchBefore(/[\p{L}_][\p{L}\p{M}\p{N}_]*$/u), last = context.state.sliceDoc(context.pos - 1, context.pos);
  if (!context.explicit && !before && !/[."/]/.test(last)) return null;
  const list = await language.complete(path(), positionOf(context.state.doc, context.pos));
  if (!list || list.items.length === 0 || context.aborted) return null;
  const from = offsetIn(context.state.doc, list.items[0].textEdit.range.start), written = context.state.sliceDoc(from, context.pos).toLowerCase();
  const items = sortCompletions(list.items, written);
  return { from, options: items.map(completionOf), filter: false };
};

// --- Signatures ---

const setSignature = /** @type {import("@codemirror/state").StateEffectType<{ pos: number, found: Signatures } | null>} */ (StateEffect.define());
const signature = StateField.define({
  /** @returns {import("@codemirror/view").Tooltip | null} */
  create: () => null,
  update(value, transaction) {
    for (const effect of transaction.effects)
      if (effect.is(setSignature)) return effect.value && { pos: effect.value.pos, above: true, create: () => ({ dom: signatureDom(/** @type {{ found: Signatures }} */ (effect.value).found) }) };
    return value && transaction.docChanged ? { ...value, pos: transaction.changes.mapPos(value.pos) } : value;
  },
  provide: (field) => showTooltip.from(field),
});

/** @param {Signatures} found */
function signatureDom(found) {
  const chosen = found.signatures[found.activeSignature] ?? found.signatures[0], at = chosen.parameters[found.activeParameter];
  const label = at ? [chosen.label.slice(0, at.label[0]), h("strong", {}, chosen.label.slice(...at.label)), chosen.label.slice(at.label[1])] : [chosen.label];
  const more = found.signatures.length - 1;
  return h("div", { class: "cm-signature" }, h("code", {}, ...label), more ? h("span", { class: "faint" }, ` and ${more} more`) : null,
    at?.documentation ? renderMarkdown(at.documentation.value) : null);
}

/** Shows the signature of the call around the cursor, once a parenthesis or a comma was typed. @param {Language} language @param {() => string} path */
function signatureHelp(language, path) {
  let timer = 0, turn = 0;
  const look = async (/** @type {EditorView} */ view) => {
    const mine = ++turn, pos = view.state.selection.main.head;
    const found = await language.signatures(path(), positionOf(view.state.doc, pos)).catch(() => null);
    if (mine === turn) view.dispatch({ effects: setSignature.of(found?.signatures.length ? { pos, found } : null) });
  };
  return EditorView.updateListener.of((update) => {
    if (!update.docChanged && !update.selectionSet) return;
    const { state, view } = update, head = state.selection.main.head, shown = state.field(signature) !== null;
    const typed = update.docChanged && /[(,]\s?$/.test(state.sliceDoc(Math.max(0, head - 2), head));
    clearTimeout(timer);
    if (typed || shown) timer = window.setTimeout(() => look(view), SIGNATURE_PAUSE);
  });
}

// --- Menus ---

/**
 * Asks for one of some things. Resolves with its index, or -1.
 *
 * @param {string} title
 * @param {string[]} choices
 * @returns {Promise<number>}
 */
export function choose(title, choices) {
  const dialog = h("dialog", { class: "menu", "aria-label": title }, h("form", { method: "dialog", class: "stack" },
    h("p", {}, title), ...choices.map((text, i) => h("button", { value: String(i), class: "quiet" }, text))));
  return answerOf(dialog, () => (dialog.returnValue === "" ? -1 : Number(dialog.returnValue)));
}

/** Asks for a text. Resolves with null if it is not given. @param {string} title @param {string} value @returns {Promise<string | null>} */
export function askText(title, value) {
  const field = h("input", { type: "text", value, "aria-label": title, spellcheck: "false" });
  const dialog = h("dialog", { class: "menu", "aria-label": title }, h("form", { method: "dialog", class: "row" }, h("label", {}, `${title} `, field), h("button", { value: "ok" }, "OK")));
  queueMicrotask(() => field.select());
  return answerOf(dialog, () => (dialog.returnValue === "ok" ? field.value : null));
}

/** @template T @param {HTMLDialogElement} dialog @param {() => T} read @returns {Promise<T>} */
function answerOf(dialog, read) {
  document.body.append(dialog);
  dialog.showModal();
  return new Promise((done) => dialog.addEventListener("close", () => {
    dialog.remove();
    done(read());
  }));
}

/**
 * @typedef {object} AssistHost  what the editor does for the language server
 * @property {Language} language
 * @property {() => string} path  of the file that is shown
 * @property {(edit: import("./language.js").WorkspaceEdit) => Promise<void>} apply
 * @property {(path: string, range: import("./language.js").Range) => void} go
 * @property {(view: EditorView) => import("./language.js").Problem[]} problems  those of the file that is shown
 * @property {(text: string) => void} say
 */

/** @param {AssistHost} host */
export function assistance(host) {
  const { language, path } = host;
  /** @param {(view: EditorView) => Promise<void>} act */
  const command = (act) => (/** @type {EditorView} */ view) => {
    act(view).catch((error) => host.say(error.message)).finally(() => view.focus());
    return true;
  };
  const cursor = (/** @type {EditorView} */ view) => positionOf(view.state.doc, view.state.selection.main.head);

  const goTo = command(async (view) => {
    const found = await language.definition(path(), cursor(view));
    if (found.length) host.go(language.path(found[0].uri), found[0].range);
    else host.say("This has no definition in a script.");
  });
  const listReferences = command(async (view) => {
    const found = await language.references(path(), cursor(view));
    if (found.length === 0) return host.say("There is no name here.");
    const i = await choose(`${found.length} places`, found.map((f) => `${language.path(f.uri)}:${f.range.start.line + 1}`));
    if (i >= 0) host.go(language.path(found[i].uri), found[i].range);
  });
  const rename = command(async (view) => {
    const range = await language.canRename(path(), cursor(view));
    if (!range) return host.say("There is no name here that can be changed.");
    const doc = view.state.doc, old = doc.sliceString(offsetIn(doc, range.start), offsetIn(doc, range.end));
    const name = await askText("New name", old);
    const edit = name && name !== old ? await language.rename(path(), range.start, name) : null;
    if (edit) await host.apply(edit);
  });
  const format = command(async (view) => {
    const edits = await language.format(path());
    if (edits.length) view.dispatch({ changes: changesOf(view.state.doc, edits), userEvent: "input.format" });
  });
  const act = command(async (view) => {
    const { from, to } = view.state.selection.main, doc = view.state.doc;
    const found = await language.actions(path(), { start: positionOf(doc, from), end: positionOf(doc, to) }, host.problems(view));
    if (found.length === 0) return host.say("There is nothing to change here.");
    const i = await choose("Change", found.map((a) => a.title)), { edit } = found[i] ?? {};
    if (edit) await host.apply(edit);
  });

  return [
    signature, signatureHelp(language, path),
    hoverTooltip(async (view, pos) => {
      const found = await language.hover(path(), positionOf(view.state.doc, pos)).catch(() => null);
      if (!found) return null;
      const at = found.range ? offsetIn(view.state.doc, found.range.start) : pos, end = found.range ? offsetIn(view.state.doc, found.range.end) : pos;
      return { pos: at, end, above: true, create: () => ({ dom: h("div", { class: "cm-described" }, renderMarkdown(found.contents.value)) }) };
    }),
    keymap.of([
      { key: "F12", run: goTo }, { key: "Shift-F12", run: listReferences }, { key: "F2", run: rename }, { key: "Shift-Alt-f", run: format }, { key: "Mod-.", run: act },
      { key: "Escape", run: (view) => view.state.field(signature) !== null && (view.dispatch({ effects: setSignature.of(null) }), true) },
    ]),
    EditorView.domEventHandlers({
      mousedown: (event, view) => {
        const at = event.ctrlKey || event.metaKey ? view.posAtCoords({ x: event.clientX, y: event.clientY }) : null;
        if (at === null || event.button !== 0) return false;
        view.dispatch({ selection: { anchor: at } });
        return goTo(view);
      },
    }),
    // A dot, a quote, or a slash begins a name that the server knows.
    EditorView.updateListener.of((update) => {
      const typed = update.transactions.some((t) => t.isUserEvent("input.type")), head = update.state.selection.main.head;
      if (typed && /[."/]/.test(update.state.sliceDoc(head - 1, head))) startCompletion(update.view);
    }),
  ];
}
