// The params of the script: a control for each, sets with names, and writing values into the script.

import { h, iconButton } from "./dom.js";
import { roundUp } from "./scale.js";
import { Topic } from "./topic.js";

/**
 * @typedef {import("./engine.js").Param} Param
 * @typedef {{ element: HTMLElement, set: (value: string) => void, busy: () => boolean }} Control
 * @typedef {(value: string, dragging: boolean) => void} Give
 */

const STEPS = 250; // of a slider

// Sizes of the units, in millimeters and degrees. An angle without a unit does not exist.
/** @type {Record<string, number>} */
const UNITS = { "": 1, mm: 1, cm: 10, m: 1000, um: 0.001, in: 25.4, ft: 304.8, deg: 1, rad: 180 / Math.PI, turn: 360 };

/** The millimeters or degrees of a number with or without unit; null: it is another expression. @param {string} value @returns {number | null} */
export function parseNumber(value) {
  const found = /^\s*([-+]?\d[\d_]*(?:\.\d+)?(?:[eE][-+]?\d+)?)([a-z]*)\s*$/.exec(value);
  if (!found || !(found[2] in UNITS)) return null;
  const number = Number(found[1].replaceAll("_", ""));
  return UNITS[found[2]] === 1 ? number : Number((number * UNITS[found[2]]).toPrecision(12));
}

/** The step of a slider: a whole number where the bounds are whole and far apart. @param {number} low @param {number} high */
export function stepOf(low, high) {
  const step = roundUp((high - low) / STEPS);
  return Number.isInteger(low) && Number.isInteger(high) && high - low >= 20 ? Math.max(1, step > 1 ? step : 1) : step;
}

/** @param {string} text  in quotes @returns {string} */
export function unquote(text) {
  const inner = /^"(.*)"$/s.exec(text.trim());
  return inner ? inner[1].replace(/\\(["\\{}nt])/g, (_, c) => ({ n: "\n", t: "\t" })[/** @type {string} */ (c)] ?? c) : text;
}

/** @param {string} text @returns {string} */
export const quote = (text) => `"${text.replace(/["\\{}]/g, "\\$&").replaceAll("\n", "\\n").replaceAll("\t", "\\t")}"`;

/** The value of a set in a file as an expression. @param {Param} param @param {any} value */
export function expressionOf(param, value) {
  if (typeof value !== "string") return String(value);
  return (param.kind === "text" || param.kind === "color") && !/^".*"$/s.test(value) ? quote(value) : value;
}

/** A value as a set in a file has it. @param {Param} param @param {string} value @returns {any} */
export function settingOf(param, value) {
  const number = parseNumber(value);
  if (param.kind === "number" && number !== null) return number;
  if (param.kind === "bool") return value === "true";
  return param.kind === "text" || param.kind === "color" ? unquote(value) : value;
}

/** @param {Param} param @param {Give} give @returns {Control} */
function numberControl(param, give) {
  if (parseNumber(param.value) === null) return textControl(param, give);
  const unit = param.kind === "angle" ? "deg" : "", { low, high } = param;
  const field = h("input", { type: "number", step: "any", "aria-label": param.name, class: "number" });
  const value = (/** @type {string} */ n) => n + unit;
  field.addEventListener("change", () => field.value !== "" && give(value(field.value), false));
  const unitText = unit ? h("span", { class: "unit" }, unit) : null;
  if (low === null || low === undefined || high === null || high === undefined) {
    const set = (/** @type {string} */ v) => (field.value = String(parseNumber(v) ?? ""));
    return { element: h("div", { class: "row" }, field, unitText), set, busy: () => document.activeElement === field };
  }
  const step = stepOf(low, high);
  const slider = h("input", { type: "range", min: low, max: high, step, "aria-label": param.name });
  let dragging = false;
  slider.addEventListener("input", () => {
    dragging = true;
    field.value = slider.value;
    give(value(slider.value), true);
  });
  slider.addEventListener("change", () => {
    dragging = false;
    give(value(slider.value), false);
  });
  field.min = String(low);
  field.max = String(high);
  const set = (/** @type {string} */ v) => {
    const number = parseNumber(v) ?? 0;
    slider.value = String(number);
    field.value = String(number);
  };
  return { element: h("div", { class: "row" }, slider, field, unitText), set, busy: () => dragging || document.activeElement === field };
}

/** @param {Param} param @param {Give} give @returns {Control} */
function choiceControl(param, give) {
  const options = (param.choices ?? []).map((c) => h("option", { value: c }, unquote(c)));
  const select = h("select", { "aria-label": param.name }, ...options);
  select.addEventListener("change", () => give(select.value, false));
  return { element: h("div", { class: "row" }, select), set: (v) => (select.value = v), busy: () => false };
}

/** @param {Param} param @param {Give} give @returns {Control} */
function boolControl(param, give) {
  const box = h("input", { type: "checkbox", role: "switch", class: "switch", "aria-label": param.name });
  box.addEventListener("change", () => give(String(box.checked), false));
  return { element: h("div", { class: "row" }, box), set: (v) => (box.checked = v === "true"), busy: () => false };
}

/** @param {Param} param @param {Give} give @returns {Control} */
function colorControl(param, give) {
  const well = h("input", { type: "color", "aria-label": `${param.name}, color` });
  const field = h("input", { type: "text", "aria-label": `${param.name}, name or code`, spellcheck: "false" });
  well.addEventListener("input", () => {
    field.value = well.value;
    give(quote(well.value), true);
  });
  well.addEventListener("change", () => give(quote(well.value), false));
  field.addEventListener("change", () => give(quote(field.value), false));
  const set = (/** @type {string} */ v) => {
    field.value = unquote(v);
    well.value = hexOf(unquote(v));
  };
  return { element: h("div", { class: "row" }, well, field), set, busy: () => document.activeElement === field };
}

/** A color as #rrggbb, which the color field needs. @param {string} color */
function hexOf(color) {
  const context = document.createElement("canvas").getContext("2d");
  if (!context) return "#000000";
  context.fillStyle = color;
  return context.fillStyle;
}

/** Of texts in the script, and of all expressions that have no control of their own. @param {Param} param @param {Give} give @returns {Control} */
function textControl(param, give) {
  const quoted = param.kind === "text";
  const field = h("input", { type: "text", "aria-label": param.name, spellcheck: "false", class: quoted ? "" : "code" });
  field.addEventListener("change", () => give(quoted ? quote(field.value) : field.value, false));
  const set = (/** @type {string} */ v) => (field.value = quoted ? unquote(v) : v);
  return { element: h("div", { class: "row" }, field), set, busy: () => document.activeElement === field };
}

/** @type {Record<Param["kind"], (param: Param, give: Give) => Control>} */
const CONTROLS = { number: numberControl, angle: numberControl, choice: choiceControl, bool: boolControl, color: colorControl, text: textControl, other: textControl };

export class ParamsPanel {
  /**
   * @param {HTMLElement} host
   * @param {import("./engine.js").Engine} engine
   * @param {{ readOnly: boolean, report: (error: Error) => void }} options
   */
  constructor(host, engine, { readOnly, report }) {
    this.engine = engine;
    this.report = report;
    /** What the user set, as expressions. @type {Record<string, string>} */
    this.values = {};
    /** @type {Topic<boolean>} true: while dragging */
    this.changed = new Topic();
    /** @type {Topic<void>} */
    this.writeWanted = new Topic();
    /** @type {Param[]} */
    this.params = [];
    /** @type {Map<string, { key: string, control: Control, row: HTMLElement, reset: HTMLButtonElement }>} */
    this.rows = new Map();
    /** @type {import("./engine.js").ParamSets} */
    this.sets = {};
    this.list = h("div", { class: "params" });
    this.empty = h("p", { class: "faint" }, "The script has no params. Add one, such as ", h("code", {}, "param height = 140 in 80..220"), ".");
    this.choice = h("select", { "aria-label": "Named set of values", onchange: () => this.apply(this.choice.value) });
    this.write = h("button", { type: "button", onclick: () => this.writeWanted.emit(undefined) }, "Write into script");
    this.resetAll = h("button", { type: "button", onclick: () => this.reset() }, "Reset all");
    this.name = h("input", { type: "text", placeholder: "name of a new set", "aria-label": "Name of the set to save", maxlength: 60 });
    this.remove = iconButton("close", "Delete the chosen set", () => this.removeSet());
    const save = h("form", { class: "row", onsubmit: (/** @type {Event} */ e) => (e.preventDefault(), this.saveSet()) }, this.name, h("button", {}, "Save set"));
    this.setRow = h("div", { class: "row" }, this.choice, readOnly ? null : this.remove);
    this.tools = h("div", { class: "stack" }, h("div", { class: "row" }, readOnly ? null : this.write, this.resetAll), this.setRow, readOnly ? null : save);
    this.empty.hidden = this.tools.hidden = true; // until it is known what the script has
    host.append(this.empty, this.list, this.tools);
  }

  /** @param {Param[]} params @param {boolean} settled  nothing that was set here is still to be run */
  show(params, settled) {
    this.params = params;
    // Another page may have set values, and so may the command line.
    if (settled) this.values = Object.fromEntries(params.filter((p) => p.value !== p.initial).map((p) => [p.name, p.value]));
    this.empty.hidden = params.length > 0;
    this.tools.hidden = params.length === 0;
    const names = new Set(params.map((p) => p.name));
    for (const name of Object.keys(this.values)) if (!names.has(name)) delete this.values[name];
    for (const [name, { row }] of this.rows)
      if (!names.has(name)) {
        row.remove();
        this.rows.delete(name);
      }
    params.forEach((param, i) => {
      const row = this.rowOf(param);
      if (this.list.children[i] !== row) this.list.insertBefore(row, this.list.children[i] ?? null);
    });
    this.refresh();
  }

  /** The row of a param, which is made again if something but the value changed. @param {Param} param */
  rowOf(param) {
    const key = JSON.stringify([param.kind, param.description, param.low, param.high, param.unit, param.choices, parseNumber(param.value) === null]);
    const before = this.rows.get(param.name);
    if (before?.key === key) return before.row;
    const control = CONTROLS[param.kind](param, (value, dragging) => this.give(param.name, value, dragging));
    const reset = iconButton("reset", `Reset ${param.name}`, () => this.reset(param.name));
    const row = h("div", { class: "param", "data-param": param.name },
      h("div", { class: "row" }, h("span", { class: "name" }, param.name), reset), control.element,
      param.description ? h("p", { class: "faint" }, param.description) : null);
    before?.row.replaceWith(row);
    this.rows.set(param.name, { key, control, row, reset });
    return row;
  }

  /** @param {string} name @param {string} value @param {boolean} dragging */
  give(name, value, dragging) {
    const param = this.params.find((p) => p.name === name);
    if (param && value === param.initial) delete this.values[name];
    else this.values[name] = value;
    this.refresh();
    this.changed.emit(dragging);
  }

  /** Sets values without telling that they have changed. @param {Record<string, string>} values  expressions */
  set(values) {
    for (const [name, value] of Object.entries(values)) {
      const param = this.params.find((p) => p.name === name);
      if (param && value === param.initial) delete this.values[name];
      else this.values[name] = value;
    }
    this.refresh();
  }

  /** Marks params that something moves. @param {string[]} names */
  mark(names) {
    for (const [name, { row }] of this.rows) row.classList.toggle("marked", names.includes(name));
    if (names.length) this.rows.get(names[0])?.row.scrollIntoView({ block: "nearest" });
  }

  refresh() {
    for (const param of this.params) {
      const row = this.rows.get(param.name);
      if (!row) continue;
      if (!row.control.busy()) row.control.set(this.values[param.name] ?? param.initial);
      row.reset.hidden = !(param.name in this.values);
    }
    const any = Object.keys(this.values).length > 0;
    this.write.disabled = this.resetAll.disabled = !any;
  }

  /** @param {string} [name]  undefined: all */
  reset(name) {
    if (name === undefined) this.values = {};
    else delete this.values[name];
    this.refresh();
    this.changed.emit(false);
  }

  async loadSets() {
    try {
      this.sets = await this.engine.sets();
    } catch {
      this.sets = {}; // the engine has no sets
    }
    this.showSets("");
  }

  /** @param {string} chosen */
  showSets(chosen) {
    const names = Object.keys(this.sets).sort();
    this.choice.replaceChildren(h("option", { value: "" }, "Named sets"), ...names.map((n) => h("option", { value: n }, n)));
    this.choice.value = chosen;
    this.setRow.hidden = names.length === 0;
    this.remove.disabled = chosen === "";
  }

  /** @param {string} name */
  apply(name) {
    this.remove.disabled = name === "";
    const set = this.sets[name];
    if (!set) return;
    this.values = {};
    for (const param of this.params) if (param.name in set) this.values[param.name] = expressionOf(param, set[param.name]);
    this.refresh();
    this.changed.emit(false);
  }

  async saveSet() {
    const name = this.name.value.trim();
    if (!name) return this.name.focus();
    const set = Object.fromEntries(this.params.map((p) => [p.name, settingOf(p, this.values[p.name] ?? p.initial)]));
    if (await this.writeSets({ ...this.sets, [name]: set }, name)) this.name.value = "";
  }

  async removeSet() {
    const { [this.choice.value]: _, ...rest } = this.sets;
    await this.writeSets(rest, "");
  }

  /** @param {import("./engine.js").ParamSets} sets @param {string} chosen */
  async writeSets(sets, chosen) {
    try {
      await this.engine.writeSets(sets);
      this.sets = sets;
      this.showSets(chosen);
      return true;
    } catch (error) {
      this.report(/** @type {Error} */ (error));
      return false;
    }
  }
}
