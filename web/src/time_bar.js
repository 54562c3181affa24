// Time: play, speed, and scrub, where the scene depends on it. Scenes of times that were seen are kept until something else changes.

import { h, icon } from "./dom.js";
import { Topic } from "./topic.js";

const FRAMES = 96; // steps of the slider
const SECONDS = 4; // for all of it at speed 1

export class TimeBar {
  /** @param {HTMLElement} host */
  constructor(host) {
    this.host = host;
    this.frame = 0;
    this.playing = false;
    this.due = 0; // when the next frame is shown, ms
    this.timer = 0;
    /** Whether the frame that was asked for is shown. */
    this.settled = true;
    /** What runs under way are of. @type {Map<number, { frame: number, coarse: boolean }>} */
    this.runs = new Map();
    /** There is another frame to show. @type {Topic<{ dragging: boolean }>} */
    this.changed = new Topic();
    /** @type {Map<number, import("./engine.js").SceneMessage>} */
    this.kept = new Map();
    this.button = h("button", { type: "button", class: "quiet", "aria-label": "Play", title: "Play (Space)", onclick: () => this.toggle() }, icon("play"));
    this.slider = h("input", { type: "range", min: 0, max: FRAMES - 1, step: 1, value: 0, "aria-label": "Time" });
    this.slider.addEventListener("input", () => this.scrub(true));
    this.slider.addEventListener("change", () => this.scrub(false));
    this.text = h("output", { class: "number" }, "0.00");
    this.speed = h("select", { "aria-label": "Speed" }, ...["0.25", "0.5", "1", "2", "4"].map((s) => h("option", { value: s, selected: s === "1" }, `${s}×`)));
    this.loop = h("input", { type: "checkbox", class: "switch", role: "switch", checked: true, "aria-label": "Repeat" });
    this.loop.addEventListener("change", () => {
      this.forget();
      this.changed.emit({ dragging: false });
    });
    host.append(this.button, this.slider, this.text, this.speed, h("label", { class: "row" }, this.loop, "repeat"));
    host.hidden = true;
  }

  /** What a run is given. @returns {{ time: number | null, frames: number | null, loop: boolean }} */
  get request() {
    if (this.host.hidden) return { time: null, frames: null, loop: false };
    const loop = this.loop.checked;
    return { time: this.frame / (loop ? FRAMES : FRAMES - 1), frames: FRAMES, loop };
  }

  /** @param {boolean} timed */
  show(timed) {
    this.host.hidden = !timed;
    if (!timed) this.stop();
  }

  /** Something else than the time changed. */
  forget() {
    this.kept.clear();
    this.runs.clear();
  }

  /** The scene of the current frame, if it was seen. */
  get known() {
    return this.kept.get(this.frame);
  }

  /** Remembers what a run is of. @param {number} run @param {number} frame @param {boolean} coarse */
  sent(run, frame, coarse) {
    this.runs.set(run, { frame, coarse });
    for (const old of this.runs.keys()) if (old < run - 10) this.runs.delete(old);
  }

  /** A scene is shown; keeps it, and goes on. @param {import("./engine.js").SceneMessage} scene */
  arrived(scene) {
    if (this.host.hidden) return;
    const run = this.runs.get(scene.run);
    if (run && !run.coarse) this.kept.set(run.frame, scene);
    this.settled = true;
    if (this.playing) this.next();
  }

  toggle() {
    if (this.playing) this.stop();
    else this.play();
  }

  play() {
    this.playing = true;
    this.due = performance.now();
    this.mark();
    this.next();
  }

  stop() {
    this.playing = false;
    clearTimeout(this.timer);
    this.mark();
  }

  mark() {
    const label = this.playing ? "Pause" : "Play";
    this.button.setAttribute("aria-label", label);
    this.button.title = `${label} (Space)`;
    this.button.replaceChildren(icon(this.playing ? "pause" : "play"));
  }

  /** Waits for the time of the next frame, or skips frames that are late. */
  next() {
    clearTimeout(this.timer);
    const step = (1000 * SECONDS) / FRAMES / Number(this.speed.value);
    const now = performance.now();
    let frames = 1;
    this.due += step;
    if (this.due < now) {
      frames += Math.floor((now - this.due) / step);
      this.due = Math.max(this.due + (frames - 1) * step, now - step);
    }
    this.timer = window.setTimeout(() => {
      if (!this.settled) return; // the scene that arrives goes on
      const next = this.frame + frames;
      if (next >= FRAMES && !this.loop.checked) {
        this.set(FRAMES - 1);
        this.stop();
      } else this.set(next % FRAMES);
      this.settled = false;
      this.changed.emit({ dragging: false });
    }, Math.max(0, this.due - now));
  }

  /** @param {boolean} dragging */
  scrub(dragging) {
    this.stop();
    this.set(Number(this.slider.value));
    this.changed.emit({ dragging });
  }

  /** @param {number} frame */
  set(frame) {
    this.frame = frame;
    this.slider.value = String(frame);
    this.text.textContent = (this.request.time ?? 0).toFixed(2);
  }
}
