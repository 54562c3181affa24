// The robots of the scene: a slider for each joint, their frames, and the handle of the tool.
//
// What is dragged does not run the script: the engine computes where the parts are, and they are moved. One question is under way at a
// time, and the latest one waits. A pose that was made here stays over further runs until the script itself changes the joint values.

import { h, iconButton } from "./dom.js";
import { formatNumber } from "./format.js";
import { Frames } from "./frames.js";
import { clampJoint, jointsExpression, rewriteJoint, roundJoint, sameJoints } from "./joints.js";
import { stepOf } from "./params.js";
import { rangeOf } from "./places.js";
import { copyText } from "./selection_panel.js";
import { ToolHandle } from "./tool_handle.js";
import { Topic } from "./topic.js";

/**
 * @typedef {import("./engine.js").Robot} Robot
 * @typedef {import("./engine.js").RobotPose} RobotPose
 * @typedef {import("./engine.js").Reached} Reached
 *
 * @typedef {object} Posed  a robot and what was made of it here
 * @property {Robot} robot
 * @property {number[]} q
 * @property {RobotPose | null} pose  null: that of the script
 *
 * @typedef {object} JointRow
 * @property {HTMLElement} row
 * @property {HTMLInputElement} slider
 * @property {HTMLInputElement} field
 * @property {HTMLButtonElement} reset
 *
 * @typedef {{ path: string, from: number, to: number, text: string }} Edit
 */

/** @param {boolean} checked @param {() => void} onchange */
const makeSwitch = (checked, onchange) => h("input", { type: "checkbox", role: "switch", class: "switch", checked, onchange });

const FIELD_DIGITS = 3; // after the point
const CONTROLS_EVERY = 150; // milliseconds between changes of all controls, which take longer than moving the parts

export class RobotsPanel {
  /**
   * @param {HTMLElement} host
   * @param {HTMLElement} over
   * @param {import("./view.js").View} view
   * @param {import("./engine.js").Engine} engine
   * @param {{ readOnly: boolean, textOf: (path: string) => string | null, openFile: (path: string) => Promise<void>, entered: () => void }} options
   *   entered: the pointer is on the handle
   */
  constructor(host, over, view, engine, { readOnly, textOf, openFile, entered }) {
    this.view = view;
    this.engine = engine;
    this.textOf = textOf;
    this.openFile = openFile;
    this.box = host.closest("details");
    /** @type {Map<string, Posed>} by name */
    this.robots = new Map();
    /** @type {Posed | null} */
    this.chosen = null;
    /** @type {JointRow[]} */
    this.rows = [];
    this.asking = false;
    this.dropped = false; // the drag ends with the last answer
    /** @type {(() => Promise<() => void>) | null} */
    this.waiting = null;
    /** The picture with the last answer. @type {Promise<unknown>} */
    this.drawn = Promise.resolve();
    this.refreshing = 0; // a timer
    this.applied = 0; // answers, for those who measure
    /** Joint values when a drag of the tool began. @type {number[] | null} */
    this.before = null;
    /** The target of the drag. @type {number[] | null} */
    this.aimed = null;
    /** @type {Topic<Edit>} */
    this.writeWanted = new Topic();
    this.frames = new Frames();
    view.scene.add(this.frames.lines);
    this.handle = new ToolHandle(over, view, {
      tool: () => this.toolFrame(),
      aimed: () => this.aimed,
      aim: (target, turning) => this.aim(target, turning),
      drop: () => this.drop(),
      cancel: () => this.giveUp(),
      entered,
    });
    const shown = () => this.showFrames();
    this.choice = h("select", { "aria-label": "Robot", onchange: () => this.choose(this.choice.value) });
    this.list = h("div", { class: "params" });
    this.dragging = makeSwitch(true, shown);
    this.keep = makeSwitch(true, shown);
    this.framed = makeSwitch(false, shown);
    this.state = h("p", { role: "status", class: "faint state" });
    this.copy = h("button", { type: "button", title: "Copies the joint values as a list for posed and fk", onclick: () => this.copyJoints() }, "Copy q");
    this.write = h("button", { type: "button", onclick: () => this.writeJoints() }, "Write q into script");
    this.homing = h("button", { type: "button", onclick: () => this.give(this.joints().map((j) => j.home)) }, "Home");
    this.resetAll = h("button", { type: "button", onclick: () => this.reset() }, "Reset");
    host.append(h("div", { class: "stack" }, this.choice, this.state, this.list,
      h("label", { class: "row", title: "Shows a handle at the tool" }, this.dragging, "Drag the tool"),
      h("label", { class: "row", title: "Off: only the position of the tool is followed" }, this.keep, "Keep its orientation"),
      h("label", { class: "row", title: "The base, the frame after each link, and the tool" }, this.framed, "Frames"),
      h("div", { class: "row" }, this.copy, this.homing, this.resetAll), readOnly ? "" : this.write));
    this.box?.addEventListener("toggle", shown);
  }

  // --- Scenes ---

  /** @param {import("./engine.js").SceneMessage} scene */
  show(scene) {
    const old = this.robots;
    this.robots = new Map();
    for (const robot of scene.robots ?? []) {
      const before = old.get(robot.name), kept = before?.pose && sameJoints(before.robot.joints, robot.joints) ? before : null;
      this.robots.set(robot.name, { robot, q: kept ? kept.q : robot.joints.map((j) => j.value), pose: kept ? kept.pose : null });
    }
    if (this.box) this.box.hidden = this.robots.size === 0;
    const names = [...this.robots.keys()], name = this.chosen?.robot.name;
    this.choice.replaceChildren(...names.map((n) => h("option", { value: n }, n)));
    this.choice.hidden = names.length < 2;
    this.restore();
    this.choose(name !== undefined && this.robots.has(name) ? name : names[0]);
  }

  /** Brings the robots that were moved back to their poses, which the engine computes anew. */
  restore() {
    for (const posed of this.robots.values()) {
      if (!posed.pose) continue;
      // The old motions are right unless the robot itself has changed.
      if (posed.pose.motions.length === posed.robot.parts.length) this.view.parts.move(posed.robot.parts, posed.pose.motions);
      this.engine.pose(posed.robot.name, posed.q).then((pose) => this.apply(posed, pose), (error) => this.fail(posed, error));
    }
    this.view.setBounds();
    this.view.changed();
  }

  /** @param {string | undefined} name */
  choose(name) {
    const posed = name === undefined ? null : (this.robots.get(name) ?? null), before = this.chosen;
    this.chosen = posed;
    if (posed) this.choice.value = posed.robot.name;
    if (!posed || !before || !sameShapes(before.robot, posed.robot)) this.makeRows();
    this.handle.missed = null;
    this.state.textContent = "";
    this.refresh();
    this.showFrames();
  }

  /** Chooses the robot that has a part. @param {string} part */
  chooseByPart(part) {
    for (const { robot } of this.robots.values()) if (robot.parts.includes(part) && robot !== this.chosen?.robot) return this.choose(robot.name);
  }

  joints() {
    return this.chosen?.robot.joints ?? [];
  }

  // --- Controls ---

  makeRows() {
    this.rows = this.joints().map((joint, i) => {
      const step = joint.high > joint.low ? stepOf(joint.low, joint.high) : 1;
      const slider = h("input", { type: "range", min: joint.low, max: joint.high, step, "aria-label": joint.name, disabled: joint.high <= joint.low });
      const field = h("input", { type: "number", step: "any", min: joint.low, max: joint.high, class: "number", "aria-label": `${joint.name}, ${joint.unit}` });
      slider.addEventListener("input", () => this.giveJoint(i, Number(slider.value)));
      field.addEventListener("change", () => field.value !== "" && this.giveJoint(i, Number(field.value)));
      const reset = iconButton("reset", `Reset ${joint.name}`, () => this.giveJoint(i, this.joints()[i].value));
      const limits = `${formatNumber(joint.low)}..${formatNumber(joint.high)} ${joint.unit}`;
      const row = h("div", { class: "param", "data-joint": i + 1 },
        h("div", { class: "row" }, h("span", { class: "name" }, joint.name), h("span", { class: "faint" }, `${joint.kind}, ${limits}`), reset),
        h("div", { class: "row" }, slider, field, h("span", { class: "unit" }, joint.unit)));
      return { row, slider, field, reset };
    });
    this.list.replaceChildren(...this.rows.map((r) => r.row));
  }

  /** Brings the controls up to date soon. */
  refreshLater() {
    if (this.refreshing) return;
    this.refreshing = window.setTimeout(() => this.refresh(), CONTROLS_EVERY);
  }

  /** Brings the controls up to date. */
  refresh() {
    clearTimeout(this.refreshing);
    this.refreshing = 0;
    const { chosen } = this;
    if (!chosen) return;
    const { robot, q } = chosen;
    this.rows.forEach(({ slider, field, reset }, i) => {
      const joint = robot.joints[i];
      slider.value = String(q[i]);
      slider.setAttribute("aria-valuetext", `${roundJoint(joint, q[i])} ${joint.unit}`);
      if (document.activeElement !== field) field.value = String(roundJoint(joint, q[i], FIELD_DIGITS));
      reset.hidden = q[i] === joint.value;
    });
    const moved = chosen.pose !== null, movable = robot.tool !== null;
    for (const { slider, field } of this.rows) slider.disabled = field.disabled = !movable;
    this.homing.disabled = !movable;
    this.resetAll.disabled = !moved;
    this.write.disabled = !moved || robot.fixed !== null;
    this.write.title = robot.fixed ? `Not possible: ${robot.fixed}. Copy q instead.` : "Changes the numbers in the script";
    if (!movable) this.state.textContent = "The robot is flattened by a transform, and cannot be moved.";
  }

  /** Draws the frames of the chosen robot, and the handle of its tool. */
  showFrames() {
    const { chosen } = this, frames = chosen?.pose?.frames ?? chosen?.robot.frames ?? [], tool = chosen?.pose?.tool ?? chosen?.robot.tool;
    if (this.framed.checked && this.box?.open && tool) this.frames.show(frames, tool);
    else this.frames.hide();
    this.view.invalidate();
  }

  // --- Joint values ---

  /** @param {number} joint @param {number} value */
  giveJoint(joint, value) {
    const { chosen } = this;
    if (!chosen || !Number.isFinite(value)) return;
    // The value of the script may be outside of the limits.
    const { joints } = chosen.robot, q = [...chosen.q];
    q[joint] = value === joints[joint].value ? value : clampJoint(joints[joint], value);
    this.rows[joint].field.value = String(roundJoint(joints[joint], q[joint], FIELD_DIGITS));
    this.give(q);
  }

  /** @param {number[]} q */
  give(q) {
    const { chosen } = this;
    if (!chosen) return;
    chosen.q = q;
    this.missed(null, null);
    this.refreshLater();
    this.ask(chosen, async () => {
      const pose = await this.engine.pose(chosen.robot.name, chosen.q);
      return () => this.apply(chosen, pose);
    });
  }

  reset() {
    if (!this.chosen) return;
    const { robot } = this.chosen;
    this.waiting = null;
    // Answers about the one before are not applied any more.
    this.chosen = { robot, q: robot.joints.map((j) => j.value), pose: null };
    this.robots.set(robot.name, this.chosen);
    this.view.parts.move(robot.parts, null);
    this.missed(null, null);
    this.refresh();
    this.moved();
  }

  /** @param {Posed} posed @param {RobotPose} pose */
  apply(posed, pose) {
    // Another run, or a reset, may have overtaken the answer.
    if (this.robots.get(posed.robot.name) !== posed || pose.motions.length !== posed.robot.parts.length) return;
    this.applied++;
    posed.pose = pose.q.every((x, i) => x === posed.robot.joints[i].value) ? null : pose;
    this.view.parts.move(posed.robot.parts, posed.pose && pose.motions);
    this.moved();
  }

  moved() {
    this.view.setBounds();
    this.view.changed();
    this.refreshLater();
    this.showFrames();
  }

  /** @param {Posed} posed @param {Error} error */
  fail(posed, error) {
    if (this.chosen === posed) this.state.textContent = error.message;
  }

  /**
   * Asks the engine, unless a later question comes first. Of the answers, at most one is shown per picture, and the next question is asked
   * while that is drawn.
   *
   * @param {Posed} posed
   * @param {() => Promise<() => void>} question  resolves with what shows the answer
   */
  async ask(posed, question) {
    this.waiting = () => question().catch((error) => () => this.fail(posed, error));
    if (this.asking) return;
    this.asking = true;
    while (this.waiting) {
      const next = this.waiting;
      this.waiting = null;
      const show = await next();
      await this.drawn;
      show();
      this.drawn = new Promise(requestAnimationFrame);
    }
    this.asking = false;
    if (this.dropped) this.settle();
  }

  // --- The tool ---

  /** The frame at which the handle is. */
  toolFrame() {
    if (!this.dragging.checked || !this.box?.open || !this.chosen) return null;
    if (!this.chosen.robot.parts.some((name) => this.view.parts.isVisible(name))) return null;
    return this.chosen.pose?.tool ?? this.chosen.robot.tool;
  }

  /** @param {number[]} target @param {boolean} turning */
  aim(target, turning) {
    const { chosen } = this;
    if (!chosen) return;
    this.before ??= chosen.q;
    this.aimed = target;
    const orientation = turning ? "exact" : this.keep.checked ? "keep" : "free";
    this.dropped = false;
    this.ask(chosen, async () => {
      const found = await this.engine.reach({ robot: chosen.robot.name, target, q: chosen.q, orientation });
      return () => {
        if (this.robots.get(chosen.robot.name) !== chosen || this.chosen !== chosen) return;
        chosen.q = found.q;
        this.missed(target, found);
        this.apply(chosen, found);
      };
    });
  }

  /** Tells how far the tool is from where it should be. @param {number[] | null} target @param {Reached | null} found */
  missed(target, found) {
    const far = found !== null && !found.reached && this.before !== null;
    this.handle.missed = far ? target : null;
    const turned = found && found.angle > 0.05 && this.keep.checked ? `, and ${formatNumber(found.angle, 3)}° turned` : "";
    this.state.textContent = far && found ? `Out of reach: the tool is ${formatNumber(found.distance, 3)} mm away${turned}.` : "";
  }

  /** The arm stays where it is, and the handle returns to it. */
  drop() {
    this.dropped = true;
    if (!this.asking) this.settle();
  }

  /** Returns to where the drag began. */
  giveUp() {
    if (this.before) this.give(this.before);
    this.drop();
  }

  settle() {
    this.dropped = false;
    this.before = this.aimed = null;
    this.handle.missed = null;
    this.state.textContent = "";
    this.refresh();
    this.view.invalidate();
  }

  // --- The script ---

  get expression() {
    return this.chosen ? jointsExpression(this.chosen.robot.joints, this.chosen.q) : "";
  }

  copyJoints() {
    const text = this.expression;
    copyText(text).then(() => (this.state.textContent = `Copied ${text}`), (error) => (this.state.textContent = error.message));
  }

  /** Changes the numbers in the script as one step: from the first of them to the last. */
  async writeJoints() {
    const { chosen } = this, path = chosen?.robot.joints[0]?.place?.file;
    if (!chosen || path === undefined) return;
    try {
      if (this.textOf(path) === null) await this.openFile(path);
      const edit = this.editOf(chosen);
      if (edit) this.writeWanted.emit(edit);
      else this.state.textContent = "The joint values in the script have changed. Try again after its next run.";
    } catch (error) {
      this.fail(chosen, /** @type {Error} */ (error));
    }
  }

  /** @param {Posed} posed @returns {Edit | null} */
  editOf({ robot, q }) {
    const path = robot.joints[0]?.place?.file, text = path === undefined ? null : this.textOf(path);
    if (path === undefined || text === null) return null;
    let out = "", from = -1, end = -1;
    for (const [i, joint] of robot.joints.entries()) {
      const range = joint.place && rangeOf(text, joint.place);
      const changed = range && (q[i] === joint.value ? text.slice(...range) : rewriteJoint(text.slice(...range), joint, q[i]));
      if (!range || !changed || range[0] < end) return null;
      if (from < 0) from = range[0];
      else out += text.slice(end, range[0]);
      out += changed;
      end = range[1];
    }
    return { path, from, to: end, text: out };
  }
}

/** Whether the controls of one robot serve another. @param {Robot} a @param {Robot} b */
function sameShapes(a, b) {
  const shape = (/** @type {Robot} */ r) => JSON.stringify([r.name, r.joints.map((j) => [j.name, j.kind, j.low, j.high, j.unit])]);
  return shape(a) === shape(b);
}
