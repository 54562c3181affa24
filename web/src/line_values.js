// The values of definitions, at the ends of their lines.

import { StateEffect, StateField } from "@codemirror/state";
import { Decoration, EditorView, WidgetType } from "@codemirror/view";
import { h } from "./dom.js";

/** @typedef {{ line: number, text: string }} LineValue  the line counts from 1 */

class ValueWidget extends WidgetType {
  /** @param {string} text */
  constructor(text) {
    super();
    this.text = text;
  }
  /** @param {ValueWidget} other */
  eq(other) {
    return other.text === this.text;
  }
  toDOM() {
    return h("span", { class: "cm-value", "aria-hidden": "true" }, this.text);
  }
  ignoreEvent() {
    return true;
  }
}

const setValues = /** @type {import("@codemirror/state").StateEffectType<LineValue[]>} */ (StateEffect.define());

/** @param {import("@codemirror/state").Text} doc @param {LineValue[]} values */
function decorationsOf(doc, values) {
  /** @type {Map<number, string[]>} */
  const lines = new Map();
  for (const { line, text } of values) if (line <= doc.lines) lines.set(line, [...(lines.get(line) ?? []), text]);
  const widgets = [...lines].sort((a, b) => a[0] - b[0]).map(([line, texts]) =>
    Decoration.widget({ widget: new ValueWidget(texts.join("   ")), side: 1 }).range(doc.line(line).to));
  return Decoration.set(widgets);
}

export const lineValues = StateField.define({
  create: () => Decoration.none,
  update(value, transaction) {
    for (const effect of transaction.effects) if (effect.is(setValues)) return decorationsOf(transaction.newDoc, effect.value);
    return transaction.docChanged ? value.map(transaction.changes) : value;
  },
  provide: (field) => EditorView.decorations.from(field),
});

/** @param {EditorView} view @param {LineValue[]} values */
export function showLineValues(view, values) {
  view.dispatch({ effects: setValues.of(values) });
}
