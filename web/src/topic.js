// A value that changes, or an event that happens, and those who listen to it.

/** @template T */
export class Topic {
  constructor() {
    /** @type {Set<(value: T) => void>} */
    this.listeners = new Set();
  }

  /** @param {(value: T) => void} listener */
  on(listener) {
    this.listeners.add(listener);
  }

  /** @param {T} value */
  emit(value) {
    for (const listener of this.listeners) listener(value);
  }
}
