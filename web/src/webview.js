// The page in a panel of a text editor (Visual Studio Code): all it asks goes as messages to the extension of the editor, which asks the server.
// A panel is of another origin than the server, so it has no cookie of its own, and the server refuses it.

import { EVENTS } from "./engine_server.js";

/** @typedef {{ type: string, [field: string]: any }} Message */

export class Webview {
  /** @param {{ postMessage: (message: Message) => void }} api  of the editor */
  constructor(api) {
    this.api = api;
    /** Requests that are not answered yet. @type {Map<number, { done: (result: any) => void, fail: (error: Error) => void }>} */
    this.waiting = new Map();
    this.last = 0; // id of the last request
    /** @type {Map<string, (message: Message) => void>} */
    this.listeners = new Map();
    this.on("answer", ({ id, result, error }) => {
      const request = this.waiting.get(id);
      this.waiting.delete(id);
      if (error === undefined) request?.done(result);
      else request?.fail(new Error(error));
    });
    addEventListener("message", ({ data }) => this.listeners.get(data?.type)?.(data));
    // A panel cannot follow links to its own files.
    addEventListener("click", (e) => {
      if (e.target instanceof Element && e.target.closest('a[href="licenses.txt"]')) this.post("licenses");
    });
  }

  /** @param {string} type @param {(message: Message) => void} listener  the only one of this type */
  on(type, listener) {
    this.listeners.set(type, listener);
  }

  /** @param {string} type @param {object} [fields] */
  post(type, fields) {
    this.api.postMessage({ ...fields, type });
  }

  /** Sends a request. @param {string} type @param {object} fields @returns {Promise<any>} */
  ask(type, fields) {
    const id = ++this.last;
    const answer = new Promise((done, fail) => this.waiting.set(id, { done, fail }));
    this.post(type, { ...fields, id });
    return answer;
  }

  /** @returns {import("./engine_server.js").Transport} */
  get transport() {
    return {
      fetch: async (path, { method = "GET", headers = {}, body = null } = {}) => {
        const { status, headers: answered, bytes } = await this.ask("request", { path, method, headers, body });
        return new Response(bytes.byteLength ? bytes : null, { status, headers: answered });
      },
      listen: (listener) => {
        this.on("event", ({ name, data }) => {
          const known = EVENTS.find((e) => e === name);
          if (known) listener[known](JSON.parse(data));
        });
        this.on("connection", ({ on, problem, ended }) => listener.connection(on, problem, ended ? () => this.post("restart") : undefined));
        this.post("listen");
      },
    };
  }

  /** The editor sets its colors as variables of the page's style. @param {() => void} listener */
  themeChanged(listener) {
    const observer = new MutationObserver(listener);
    observer.observe(document.documentElement, { attributes: true, attributeFilter: ["style"] });
    observer.observe(document.body, { attributes: true, attributeFilter: ["class"] });
  }

  /** Asks the editor to save a file where the user wants it. @param {string} name @param {Blob} blob */
  async download(name, blob) {
    this.post("download", { name, bytes: await blob.arrayBuffer() });
  }
}

/** The panel of the editor that shows the page, or null: a browser shows it. */
export function findWebview() {
  const acquire = /** @type {{ acquireVsCodeApi?: () => { postMessage: (message: Message) => void } }} */ (globalThis).acquireVsCodeApi;
  return acquire ? new Webview(acquire()) : null;
}
