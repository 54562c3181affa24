// When scripts run.
//
// While something is dragged, at most one run is under way: what changed meanwhile is one more run after it, so that the latest state wins and
// no run is canceled just before it would have been seen. A run that is not of a drag starts at once, and the engine cancels the one before.

import { Topic } from "./topic.js";

export class Runs {
  /**
   * @param {(coarse: boolean) => Promise<number>} start  sends the current state to the engine
   * @param {(error: Error) => void} failed
   */
  constructor(start, failed) {
    this.start = start;
    this.failed = failed;
    this.underWay = false;
    /** @type {null | "coarse" | "fine"} */
    this.waiting = null;
    this.latest = 0; // number of the newest run that is known
    this.ended = 0; // number of the newest run that ended
    this.sending = 0; // requests that the engine has not numbered yet
    this.coarse = false;
    /** @type {Topic<boolean>} */
    this.busy = new Topic();
  }

  /** Something that was asked for has not run yet, or only coarsely. */
  get pending() {
    return this.underWay || this.sending > 0 || this.waiting !== null || this.coarse;
  }

  /** Runs with coarse meshes, as soon as the run before is done. */
  drag() {
    if (this.underWay) this.waiting ??= "coarse";
    else this.begin(true);
  }

  /** Ends a drag: the last run of it has fine meshes. */
  drop() {
    if (this.underWay) this.waiting = "fine";
    else this.begin(false);
  }

  /** Runs at once. */
  now() {
    this.waiting = null;
    this.begin(false);
  }

  /** @param {boolean} coarse */
  async begin(coarse) {
    this.underWay = true;
    this.coarse = coarse;
    this.busy.emit(true);
    this.sending++;
    try {
      // The state of a run can arrive before its number.
      const run = await this.start(coarse);
      this.sending--;
      this.latest = Math.max(this.latest, run);
      this.settle();
    } catch (error) {
      this.sending--;
      this.underWay = false;
      this.busy.emit(false);
      this.failed(/** @type {Error} */ (error));
    }
  }

  /** @param {import("./engine.js").RunState} state */
  state(state) {
    if (state.running) {
      this.latest = Math.max(this.latest, state.run);
      this.busy.emit(true);
    } else if (state.run >= this.latest) {
      this.latest = state.run;
      this.ended = state.run;
      this.settle();
    }
  }

  settle() {
    if (this.sending > 0 || this.ended < this.latest) return;
    this.underWay = false;
    const next = this.waiting;
    this.waiting = null;
    if (next) this.begin(next === "coarse");
    else this.busy.emit(false);
  }

  /** The engine was started anew and counts from 1. */
  restart() {
    this.latest = 0;
    this.ended = 0;
    this.underWay = false;
    this.waiting = null;
  }
}
