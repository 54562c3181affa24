// Starts the worker before the rest of the playground is loaded, so that the program is compiled meanwhile. What the worker says is kept for
// engine_worker.js.

const worker = new Worker(new URL("worker.js", import.meta.url), { type: "module" });
/** @type {MessageEvent[]} */
const heard = [];
const hear = (/** @type {MessageEvent} */ event) => heard.push(event);
worker.addEventListener("message", hear);
worker.postMessage({ start: null });
Object.assign(globalThis, { cagEarly: { worker, heard, stop: () => worker.removeEventListener("message", hear) } });
