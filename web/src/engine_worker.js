// The engine in the page: workers that run cag as WebAssembly.
//
// A run cannot be interrupted from outside, so the worker of a run that takes too long is ended when a newer one is asked for, and a spare
// worker takes its place. Pictures are rendered by a worker of their own.

import { EngineError } from "./engine.js";
import { isModule } from "./places.js";
import { questions } from "./questions.js";

const PATIENCE = 400; // milliseconds that a run may go on when there is a newer one
const MESHES_MOST = 256 << 20; // bytes of meshes that are kept

/** @typedef {import("./worker.js").RunCall} RunCall */
/** @typedef {{ bytes: Uint8Array<ArrayBuffer>, type: string, name: string }} Answer */
/** @typedef {{ code: string, message: string, help: string }} Crash */
/** @typedef {{ call: any, done: (answer: any) => void, failed: (error: Error) => void }} Waiting */

/**
 * Where the files of the model come from, and where they go.
 *
 * @typedef {object} Model
 * @property {string} file  the path of the script
 * @property {Record<string, string>} files  texts by path
 * @property {(files: Record<string, string>) => void} changed  the texts of a run
 * @property {(path: string, text: string) => void} saved
 * @property {() => import("./engine.js").ParamSets} sets
 * @property {(sets: import("./engine.js").ParamSets) => void} writeSets
 */

/** The worker that boot.js has started, once. @returns {{ worker: Worker, heard: MessageEvent[], stop: () => void } | undefined} */
function takeEarly() {
  const page = /** @type {any} */ (globalThis), early = page.cagEarly;
  delete page.cagEarly;
  early?.stop();
  return early;
}

/** A worker, and the calls that it has not answered. */
class Client {
  /**
   * @param {WebAssembly.Module | null} module
   * @param {(message: any) => void} hear  gets what is no answer
   * @param {(crash: Crash, client: Client) => void} crashed
   */
  constructor(module, hear, crashed) {
    const early = takeEarly();
    this.worker = early?.worker ?? new Worker(new URL("worker.js", import.meta.url), { type: "module" });
    /** @type {Map<number, Waiting>} */
    this.waiting = new Map();
    this.calls = 0;
    this.fresh = true; // it has not run anything
    this.good = 0; // the run whose session it has; 0: none
    this.begun = 0; // when the run under way was sent; 0: none is
    this.worker.addEventListener("message", ({ data }) => {
      if (data.crash) return crashed(data.crash, this);
      const waiting = this.waiting.get(data.id);
      if (!waiting) return hear(data);
      this.waiting.delete(data.id);
      if (data.error === undefined) waiting.done(data.result);
      else waiting.failed(new EngineError(data.error));
    });
    this.worker.addEventListener("error", (event) => hear({ failed: event.message || "worker.js cannot be loaded" }));
    if (!early) this.worker.postMessage({ start: module });
    for (const event of early?.heard ?? []) setTimeout(() => this.worker.dispatchEvent(new MessageEvent("message", { data: event.data })));
  }

  /** @param {any} call @returns {Promise<any>} */
  send(call) {
    return new Promise((done, failed) => this.resend({ call, done, failed }));
  }

  /** @param {Waiting} waiting */
  resend(waiting) {
    const id = ++this.calls;
    this.waiting.set(id, waiting);
    this.worker.postMessage({ ...waiting.call, id });
  }

  end() {
    this.worker.terminate();
  }
}

class WorkerEngine {
  /** @param {Model} model */
  constructor(model) {
    this.model = model;
    /** @type {import("./engine.js").EngineListener | null} */
    this.listener = null;
    /** The last events, for those who listen later. @type {Map<string, any>} */
    this.last = new Map();
    /** @type {WebAssembly.Module | null} */
    this.module = null;
    /** In the order of their use. @type {Map<string, ArrayBuffer>} */
    this.meshes = new Map();
    this.meshBytes = 0;
    this.runs = 0; // the number of the last one
    /** @type {RunCall | null} */
    this.pending = null;
    /** @type {RunCall | null} */
    this.underWay = null;
    /** The last good one. @type {RunCall | null} */
    this.good = null;
    this.jobs = 0;
    /** @type {Map<number, { client: Client, picture: Blob | null }>} */
    this.rendering = new Map();
    this.active = this.client();
    /** @type {Client | null} */
    this.spare = null;
    this.patience = 0;
    /** Runs the language server. @type {Client | null} */
    this.language = null;
  }

  client() {
    return new Client(this.module, (message) => this.hear(message), (crash, client) => this.crashed(crash, client));
  }

  // --- What workers tell ---

  /** @param {"state" | "scene" | "messages" | "progress"} name @param {any} data */
  tell(name, data) {
    if (name !== "progress") this.last.set(name, data);
    this.listener?.[name](data);
  }

  /** @param {any} message */
  hear(message) {
    if (message.module) this.module = message.module;
    else if (message.failed) this.fail(message.failed);
    else if (message.mesh) this.keepMesh(message.mesh, message.bytes);
    else if (message.event) {
      if (message.event === "scene" && this.underWay) {
        this.good = this.underWay;
        this.active.good = this.good.number;
      }
      this.tell(message.event, JSON.parse(message.json));
    }
  }

  /** The program cannot be started. @param {string} why */
  fail(why) {
    const message = `cag cannot be loaded: ${why}`;
    for (const waiting of this.active.waiting.values()) waiting.failed(new EngineError(message));
    this.active.waiting.clear();
    this.listener?.connection(false, message);
  }

  /** @param {string} id @param {ArrayBuffer} bytes */
  keepMesh(id, bytes) {
    if (this.meshes.has(id)) return;
    this.meshes.set(id, bytes);
    this.meshBytes += bytes.byteLength;
  }

  /** Forgets meshes that were not used for long. Those of the last scenes are needed. */
  trimMeshes() {
    const needed = new Set((this.last.get("scene")?.parts ?? []).map((/** @type {import("./engine.js").Part} */ p) => p.mesh));
    let forgot = false;
    for (const [id, bytes] of this.meshes) {
      if (this.meshBytes <= MESHES_MOST) break;
      if (needed.has(id)) continue;
      this.meshes.delete(id);
      this.meshBytes -= bytes.byteLength;
      forgot = true;
    }
    return forgot;
  }

  /** @param {Crash} crash @param {Client} client */
  crashed(crash, client) {
    if (client === this.spare) {
      client.end();
      this.spare = null;
      return;
    }
    if (client === this.language) this.language = null;
    if (client !== this.active) { // of a picture, or the language server
      for (const waiting of client.waiting.values()) waiting.failed(new EngineError(crash.message, crash.help));
      client.end();
      return;
    }
    const run = this.underWay;
    this.replace(false);
    if (!run) return this.tellProblem(this.runs, crash);
    this.tellProblem(run.number, crash);
    this.tell("state", { run: run.number, running: false });
    this.startPending();
  }

  /** @param {number} run @param {Crash} crash */
  tellProblem(run, { code, message, help }) {
    const diagnostic = { severity: "error", code, message, help: help || null, file: this.model.file, line: 1, column: 1, endLine: 1, endColumn: 1, related: [] };
    this.tell("messages", { run, ok: false, seconds: 0, prints: [], diagnostics: [diagnostic], values: [] });
  }

  // --- Runs ---

  /** Ends the active worker. What it has not answered is asked again, or fails. @param {boolean} again */
  replace(again) {
    const old = this.active;
    old.end();
    clearTimeout(this.patience);
    this.underWay = null;
    this.active = this.spare ?? this.client();
    this.spare = null;
    const questions = [...old.waiting.values()].filter((w) => "ask" in w.call);
    if (!again) for (const w of questions) w.failed(new EngineError("the program ended"));
    else if (questions.length) {
      this.restore(this.active);
      for (const w of questions) this.active.resend(w);
    }
  }

  /** Makes a worker have the session of the last good run. @param {Client} client */
  restore(client) {
    if (!this.good || client.good === this.good.number) return;
    client.good = this.good.number;
    client.send({ run: { ...this.good, quiet: true, known: [...this.meshes.keys()] } }).catch(() => {});
  }

  /** @param {import("./engine.js").RunRequest} request @returns {number} */
  run(request) {
    const files = { ...this.model.files, ...request.files }, number = ++this.runs;
    this.model.changed(files);
    this.pending = { script: this.model.file, number, files, request: JSON.stringify({ ...request, files: null }), quiet: false, known: null };
    if (!this.underWay) this.startPending();
    else if (!this.patience) {
      const left = Math.max(0, this.active.begun + PATIENCE - performance.now());
      this.patience = window.setTimeout(() => {
        this.replace(true);
        this.startPending();
      }, left);
    }
    return number;
  }

  startPending() {
    clearTimeout(this.patience);
    this.patience = 0;
    const run = this.pending, client = this.active;
    if (!run || this.underWay) return;
    this.pending = null;
    this.underWay = run;
    client.begun = performance.now();
    const forgot = this.trimMeshes();
    if (client.fresh || forgot) run.known = [...this.meshes.keys()];
    client.fresh = false;
    client.send({ run }).then(() => {
      if (this.underWay !== run) return;
      this.underWay = null;
      this.startPending();
      this.spare ??= this.module ? this.client() : null;
    }, () => {});
  }

  // --- Questions ---

  /** @param {string} name @param {string[]} values @returns {Promise<Answer>} */
  ask(name, ...values) {
    this.restoreBefore(name);
    return this.active.send({ ask: name, values });
  }

  /** @param {string} name */
  restoreBefore(name) {
    if (["export", "image", "measure", "question"].includes(name) && !this.underWay) this.restore(this.active);
  }

  /** @param {object[]} messages @param {boolean} check */
  async lsp(messages, check) {
    this.language ??= new Client(this.module, () => {}, (crash, client) => this.crashed(crash, client));
    const answer = await this.language.send({ ask: "lsp", values: [JSON.stringify(messages), String(check)], files: this.model.files });
    return JSON.parse(textOf(answer));
  }

  /** @param {import("./engine.js").RenderRequest} request @returns {number} */
  render(request) {
    const job = ++this.jobs;
    const client = new Client(this.module, (message) => {
      if (message.progress !== undefined) this.tell("progress", { job, percent: message.progress, phase: message.phase, done: false, error: null });
    }, (crash, failed) => this.crashed(crash, failed));
    const entry = { client, picture: /** @type {Blob | null} */ (null) };
    this.rendering.set(job, entry);
    const end = (/** @type {string | null} */ error) => {
      client.end();
      this.tell("progress", { job, percent: 100, phase: "rendering", done: true, error });
    };
    this.restore(client);
    client.send({ ask: "picture", values: [JSON.stringify(request)] }).then((/** @type {Answer} */ answer) => {
      entry.picture = new Blob([answer.bytes], { type: "image/png" });
      end(null);
    }, (error) => end(error.message));
    return job;
  }
}

/** The version of a text: equal texts have equal versions. @param {string} text */
const versionOf = (text) => text;

/** @param {Answer} answer */
const blobOf = (answer) => new Blob([answer.bytes], { type: answer.type });
/** @param {Answer} answer */
const textOf = (answer) => new TextDecoder().decode(answer.bytes);

/** @param {Model} model @returns {import("./engine.js").Engine} */
export function workerEngine(model) {
  const engine = new WorkerEngine(model);
  return {
    hello: async () => {
      const hello = JSON.parse(textOf(await engine.ask("hello", model.file)));
      // There is no OpenEXR.
      return { ...hello, keepsEdits: true, formats: hello.formats.filter((/** @type {[string, string]} */ [name]) => name !== "exr") };
    },
    listen: (listener) => {
      engine.listener = listener;
      listener.connection(true, "");
      for (const name of /** @type {const} */ (["state", "messages", "scene"])) if (engine.last.has(name)) listener[name](engine.last.get(name));
      if (engine.runs === 0) engine.run({ files: null, params: {}, time: null, frames: null, loop: false, coarse: false });
    },
    run: async (request) => engine.run(request),
    mesh: async (id) => {
      const bytes = engine.meshes.get(id);
      if (!bytes) throw new EngineError("there is no such mesh");
      engine.meshes.delete(id);
      engine.meshes.set(id, bytes);
      return bytes;
    },
    files: async () => Object.entries(model.files).map(([path, text]) => ({ path, version: versionOf(text) })),
    read: async (path) => {
      const text = isModule(path) ? textOf(await engine.ask("library", path)) : model.files[path];
      if (text === undefined) throw new EngineError(`there is no file ${path}`);
      return { text, version: versionOf(text) };
    },
    write: async (path, text) => {
      model.files[path] = text;
      model.saved(path, text);
      return { saved: true, version: versionOf(text) };
    },
    render: async (request) => engine.render(request),
    picture: async (job) => {
      const picture = engine.rendering.get(job)?.picture;
      if (!picture) throw new EngineError("there is no such picture");
      return picture;
    },
    cancel: async (job) => {
      engine.rendering.get(job)?.client.end();
      engine.rendering.delete(job);
    },
    export: async (format) => {
      const answer = await engine.ask("export", model.file, format);
      return { name: answer.name, blob: blobOf(answer) };
    },
    image: async (name) => blobOf(await engine.ask("image", name)),
    lsp: (messages, check) => engine.lsp(messages, check),
    ...questions(async (question, request) => {
      const answer = JSON.parse(textOf(await engine.ask("question", question, JSON.stringify(request))));
      if (answer.error) throw new EngineError(answer.error, answer.help ?? "");
      return answer;
    }),
    sets: async () => model.sets(),
    writeSets: async (sets) => model.writeSets(sets),
    measure: async (part) => {
      const m = JSON.parse(textOf(await engine.ask("measure", model.file, part)));
      return { ...m, bounds: m.bounds && [m.bounds.min, m.bounds.max] };
    },
  };
}
