// The points of the selected parts, as handles: dragging one changes its numbers in the script, or the params that move it.
//
// While a point is dragged, the script has its new numbers, but no step to undo. At the end, they become one step.

import { Vector3 } from "three";
import { h } from "./dom.js";
import { formatNumber } from "./format.js";
import { rangeOf } from "./places.js";
import { columnOf, moveCoordinates, numberText, readNumber } from "./point_numbers.js";

/**
 * @typedef {import("./engine.js").PointInfo} PointInfo
 * @typedef {import("./engine.js").PointNumber} PointNumber
 * @typedef {{ part: string, point: PointInfo, button: HTMLButtonElement, at: Vector3 }} Shown
 *
 * @typedef {object} Written  a number that is being changed
 * @property {number} k  the coordinate
 * @property {string} path
 * @property {number} from  in the text as it is now
 * @property {number} to
 * @property {string} before  its text before the drag
 * @property {string} now
 *
 * @typedef {object} Drag
 * @property {Shown} shown
 * @property {PointInfo} point  as it was when the drag began
 * @property {Written[]} written
 * @property {Record<string, string>} params  as they were
 * @property {boolean} moved
 * @property {Vector3 | null} wanted  the target that params are still to be found for
 * @property {boolean} asking
 * @property {null | "drop" | "cancel"} ended
 *
 * @typedef {object} PointToolOptions
 * @property {import("./engine.js").Engine} engine
 * @property {import("./view.js").View} view
 * @property {import("./handles.js").Handles} handles
 * @property {import("./params.js").ParamsPanel} params
 * @property {boolean} readOnly
 * @property {(path: string) => Promise<void> | undefined} load  opens a script without showing it
 * @property {(path: string) => Promise<void> | undefined} showFile
 * @property {HTMLElement} note  where the number of points is told
 * @property {(dragging: boolean) => void} run  runs the script with what has changed
 * @property {() => boolean} pending  a run is under way or to come
 * @property {(error: Error) => void} report
 */

const MOST_POINTS = 300; // of all selected parts
const QUICK = 50; // milliseconds in which points are found while one is dragged
const MOST_PARAMS = 8; // that are solved for at once
const AXES = ["x", "y", "z"];

export class PointTool {
  /** @param {PointToolOptions} options */
  constructor(options) {
    this.options = options;
    this.on = false;
    /** @type {import("./editor.js").Editor | import("./remote_editor.js").RemoteEditor | null} */
    this.editor = null;
    /** By part and id. @type {Map<string, Shown>} */
    this.shown = new Map();
    /** @type {Drag | null} */
    this.drag = null;
    /** The handle that was dragged last. @type {Shown | null} */
    this.held = null;
    this.asked = 0;
    this.took = 0; // milliseconds, the last answer
    this.count = h("p", { class: "faint", role: "status" });
    options.note.append(this.count);
  }

  get dragging() {
    return this.drag !== null;
  }

  /** @param {boolean} on */
  toggle(on) {
    this.on = on;
    this.update();
  }

  /** Asks for the points of what is selected. */
  async update() {
    if (this.dragging && this.took > QUICK) return; // it would slow the drag down
    const { engine, view } = this.options, asked = ++this.asked, begin = performance.now();
    const parts = this.on && this.editor ? view.selected.filter((n) => view.parts.views.has(n)) : [];
    try {
      const answers = await Promise.all(parts.map((part) => engine.points(part).then((a) => ({ part, ...a }))));
      this.took = performance.now() - begin;
      await this.openFiles(answers.flatMap(({ points }) => points.flatMap(({ numbers }) => this.filesOf(numbers))));
      if (asked === this.asked) this.show(answers);
    } catch {
      // Of a part that is gone meanwhile, the next scene tells.
      if (asked === this.asked) this.show([]);
    }
  }

  /** Opens the scripts that have the numbers, without showing them. One that cannot be opened stays closed. @param {string[]} paths */
  async openFiles(paths) {
    const closed = [...new Set(paths)].filter((path) => this.editor?.text(path) === null);
    await Promise.allSettled(closed.map((path) => this.options.load(path)));
  }

  /** @param {{ part: string, points: PointInfo[], omitted: number }[]} answers */
  show(answers) {
    const found = answers.flatMap(({ part, points }) => points.map((point) => ({ key: `${part}\n${point.id}`, part, point })));
    const kept = found.slice(0, MOST_POINTS), keys = new Set(kept.map((f) => f.key));
    for (const [key, one] of this.shown)
      if (!keys.has(key) && one !== this.drag?.shown) {
        this.options.handles.remove(one.button);
        this.shown.delete(key);
      }
    for (const { key, part, point } of kept) this.showPoint(key, part, point);
    const all = found.length + answers.reduce((sum, a) => sum + a.omitted, 0);
    const locked = kept.filter((f) => this.lockOf(f.point)).length;
    this.count.hidden = !this.on;
    this.count.textContent = !answers.length ? "Select a part to see its points."
      : !all ? "This part has no points."
      : `${all > kept.length ? `${kept.length} of ${all}` : all} point${all === 1 ? "" : "s"} shown${locked ? `, ${locked} locked` : ""}.`;
    this.options.view.invalidate();
  }

  /** @param {string} key @param {string} part @param {PointInfo} point */
  showPoint(key, part, point) {
    let one = this.shown.get(key);
    if (!one) {
      const made = (one = /** @type {Shown} */ ({ part, point, at: new Vector3() }));
      one.button = this.options.handles.addFree({
        at: () => made.at,
        normal: () => (made.point.plane ? new Vector3(...made.point.plane.normal) : null),
        begin: () => this.begin(made),
        move: (target) => this.move(target),
        drop: (canceled) => this.end(canceled ? "cancel" : "drop"),
        point: (on) => this.pointAt(on ? made : null),
      });
      this.shown.set(key, one);
    }
    // The handle that is dragged is ahead of the scene, until the last run of the drag has ended.
    if (this.held === one && !this.dragging && !this.options.pending()) this.held = null;
    if (this.held !== one) one.at.set(...point.at);
    one.point = point;
    this.describe(one);
  }

  /** Marks what a point would change. @param {Shown | null} one */
  pointAt(one) {
    const { params } = this.options, moves = one && !this.lockOf(one.point) ? one : null;
    params.mark(moves ? moves.point.params : []);
    if (this.drag) return;
    const found = moves ? this.find(moves.point) ?? [] : [], path = found[0]?.path ?? this.editor?.path;
    if (path) this.editor?.mark(path, this.rangeOfNumbers(found));
  }

  /** @param {Written[]} written @returns {[number, number] | null} */
  rangeOfNumbers(written) {
    return written.length ? [Math.min(...written.map((w) => w.from)), Math.max(...written.map((w) => w.to))] : null;
  }

  /** @param {Shown} one */
  describe({ button, point }) {
    const locked = this.lockOf(point), numbers = point.numbers.filter((n) => n !== null).length;
    const place = point.at.map((x, k) => `${AXES[k]} ${formatNumber(x, 4)}`).join(", ");
    const params = point.params.length ? `moves ${point.params.join(", ")}` : "";
    const label = `${point.call} point at ${place} mm${locked ? `, locked: ${locked}` : params ? `, ${params}` : ""}`;
    button.classList.toggle("locked", locked !== null);
    button.classList.toggle("computed", !locked && point.params.length > 0 && (numbers === 0 || this.options.readOnly));
    button.classList.toggle("space", point.plane === null);
    button.classList.toggle("move", point.call === "translate"); // often where another point is
    button.setAttribute("aria-label", label);
    button.setAttribute("aria-disabled", String(locked !== null));
    button.title = locked ? `Locked: ${locked}` : `${point.call} point${params ? `, ${params}` : ""}`;
  }

  /** Why a point cannot be moved here; null: it can. @param {PointInfo} point */
  lockOf(point) {
    if (point.locked) return point.locked;
    if (point.params.length) return null;
    return this.lockOfNumbers(point);
  }

  /** @param {PointInfo} point */
  lockOfNumbers({ numbers }) {
    const files = this.filesOf(numbers), closed = files.find((path) => this.editor?.text(path) === null);
    if (this.options.readOnly) return "the page is opened with --read-only";
    if (files.length > 1) return `its numbers are in ${files.join(" and ")}`;
    return closed ? `its numbers are in ${closed}, which cannot be opened` : null;
  }

  /** @param {PointInfo["numbers"]} numbers */
  filesOf(numbers) {
    return [...new Set(numbers.flatMap((n) => (n ? [n.file] : [])))];
  }

  // --- A drag ---

  /** @param {Shown} shown */
  begin(shown) {
    const { point } = shown, { params } = this.options;
    if (this.drag || this.lockOf(point)) return false;
    const written = this.lockOfNumbers(point) ? [] : this.find(point);
    if (!written) {
      this.options.report(new Error("The script has changed since it was run. The point can be moved after the next run."));
      return false;
    }
    this.drag = { shown, point, written, params: { ...params.values }, moved: false, wanted: null, asking: false, ended: null };
    this.held = shown;
    shown.button.classList.add("dragged");
    if (written.length) this.reveal(written);
    return true;
  }

  /** Shows the numbers in the editor, where the drag is undone. @param {Written[]} written */
  async reveal(written) {
    const { path } = written[0];
    try {
      if (this.editor?.path !== path) await this.options.showFile(path);
      this.editor?.mark(path, this.rangeOfNumbers(written), true);
    } catch (error) {
      this.options.report(/** @type {Error} */ (error));
    }
  }

  /** Where the numbers of a point are in the editor; null: they are not there any more. @param {PointInfo} point @returns {Written[] | null} */
  find({ numbers }) {
    /** @type {Written[]} */
    const written = [];
    for (const [k, number] of numbers.entries()) {
      if (!number) continue;
      const text = this.editor?.text(number.file) ?? "", [from, to] = rangeOf(text, number), before = text.slice(from, to);
      const value = readNumber(before, number);
      if (value === null || Math.abs(value - number.value) > 1e-9 * Math.max(1, Math.abs(value))) return null;
      written.push({ k, path: number.file, from, to, before, now: before });
    }
    return written;
  }

  /** @param {Vector3} target */
  move(target) {
    const { drag } = this, { view } = this.options;
    if (!drag || drag.ended) return;
    drag.moved = true;
    const { point, shown } = drag, at = new Vector3(...point.at);
    /** Where params are to move the point. */
    let wanted = target.clone(), same = true;
    if (drag.written.length) {
      const { right, up, back } = view.orbit.axes(), axes = { right: right.toArray(), up: up.toArray(), back: back.toArray() };
      const moves = moveCoordinates(point, target.clone().sub(at).toArray(), axes);
      const texts = drag.written.map(({ k }) => this.textOf(point, k, moves[k]));
      same = drag.written.every((w, i) => w.now === texts[i]);
      if (!same) this.write(texts);
      wanted = this.placeOf(point, moves.map((x, k) => (drag.written.some((w) => w.k === k) ? 0 : x)));
      shown.at.copy(this.placeOf(point, moves));
    }
    if (point.params.length) {
      drag.wanted = wanted;
      this.solve(drag);
    } else if (!same) this.options.run(true);
    view.invalidate();
  }

  /** @param {PointInfo} point @param {number} k @param {number} move  mm */
  textOf(point, k, move) {
    const number = /** @type {PointNumber} */ (point.numbers[k]), length = Math.hypot(...columnOf(point, k));
    return numberText(number.value + move, number, this.options.view.pixelAt(new Vector3(...point.at)) / (length || 1));
  }

  /** Where the point is when its coordinates change. @param {PointInfo} point @param {number[]} moves  mm */
  placeOf(point, moves) {
    const at = new Vector3(...point.at);
    moves.forEach((x, k) => at.addScaledVector(new Vector3(...columnOf(point, k)), x));
    return at;
  }

  /** Writes the numbers of the drag into the script, without a step to undo. @param {string[]} texts @param {"hidden" | "step"} [history] */
  write(texts, history = "hidden") {
    const { editor, drag } = this;
    if (!editor || !drag || !drag.written.length || !this.isIntact(drag)) return;
    const path = drag.written[0].path, ordered = drag.written.map((w, i) => ({ w, text: texts[i] })).sort((a, b) => a.w.from - b.w.from);
    editor.quietly(() => editor.change(path, ordered.map(({ w, text }) => ({ from: w.from, to: w.to, insert: text })), history));
    let shift = 0;
    for (const { w, text } of ordered) {
      const length = w.to - w.from;
      w.from += shift;
      w.to = w.from + text.length;
      w.now = text;
      shift += text.length - length;
    }
  }

  /** Whether the numbers of the drag are where it has written them: somebody else may have changed the file. @param {Drag} drag */
  isIntact({ written }) {
    return written.every((w) => this.editor?.text(w.path)?.slice(w.from, w.to) === w.now);
  }

  /** Finds params for the newest target, one request after the other. @param {Drag} drag */
  async solve(drag) {
    const { engine, params, view, report } = this.options;
    const canceled = () => drag.ended === "cancel";
    if (drag.asking) return;
    drag.asking = true;
    try {
      while (drag.wanted && !canceled()) {
        const target = drag.wanted, { part } = drag.shown, { point } = drag, names = point.params.slice(0, MOST_PARAMS);
        drag.wanted = null;
        const sight = view.orbit.orthographic ? view.orbit.direction() : target.clone().sub(view.orbit.eye());
        // Numbers of the script take care of their directions.
        const ignored = drag.written.length ? drag.written.map(({ k }) => columnOf(point, k)).slice(0, 2) : [sight.toArray()];
        const found = await engine.solve({ part, point: point.id, target: target.toArray(), ignored, params: names, pixel: view.pixelAt(target) });
        if (canceled()) break;
        params.set(found.params);
        if (!drag.written.length) drag.shown.at.set(...found.at);
        view.invalidate();
        this.options.run(true);
      }
    } catch (error) {
      report(/** @type {Error} */ (error));
    }
    drag.asking = false;
    if (drag.ended === "drop") this.settle(drag);
  }

  /** @param {"drop" | "cancel"} how */
  end(how) {
    const { drag } = this;
    if (!drag || drag.ended) return;
    drag.ended = how;
    // The last params are still being found.
    if (how === "drop" && drag.asking) return;
    this.settle(drag);
  }

  /** Ends a drag: its numbers become one step to undo, or everything is as before. @param {Drag} drag */
  settle(drag) {
    const texts = drag.written.map((w) => w.now), before = drag.written.map((w) => w.before);
    if (drag.moved) {
      if (texts.join() !== before.join() && this.isIntact(drag)) {
        this.write(before);
        if (drag.ended === "drop") this.write(texts, "step");
      }
      if (drag.ended === "cancel") {
        this.options.params.values = drag.params;
        this.options.params.refresh();
        drag.shown.at.set(...drag.point.at);
      }
    }
    drag.shown.button.classList.remove("dragged");
    this.drag = null;
    if (drag.moved) this.options.run(false);
    this.options.view.invalidate();
  }
}
