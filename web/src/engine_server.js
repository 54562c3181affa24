// The engine behind HTTP: requests, and one stream of events.

import { EngineError } from "./engine.js";
import { questions } from "./questions.js";

// Milliseconds until the page looks for a server that is gone.
const RETRY_AFTER = 1000;

/** The kinds of events in the stream. */
export const EVENTS = /** @type {const} */ (["state", "scene", "messages", "file", "progress"]);

/**
 * How requests reach the server.
 *
 * @typedef {object} Transport
 * @property {(path: string, options?: { method?: string, headers?: Record<string, string>, body?: string, cache?: RequestCache }) => Promise<Response>} fetch
 * @property {(listener: import("./engine.js").EngineListener) => void} listen  to the stream of events
 */

/** @param {Promise<Response>} answer */
async function accepted(answer) {
  const response = await answer;
  if (response.ok) return response;
  /** @type {{ error?: string, help?: string }} */
  const problem = await response.json().catch(() => ({}));
  throw new EngineError(problem.error ?? `the server answered with status ${response.status}`, problem.help);
}

/** @param {string} method @param {unknown} body */
const json = (method, body) => ({ method, body: JSON.stringify(body), headers: { "Content-Type": "application/json" } });

/** @param {string | null} tag */
const versionOf = (tag) => (tag ?? "").replace(/^W\//, "").replace(/^"|"$/g, "");

/** @param {string} path */
const fileAt = (path) => `/api/file?path=${encodeURIComponent(path)}`;

/** @param {import("./engine.js").EngineListener} listener */
function connect(listener) {
  const source = new EventSource("/api/events");
  source.addEventListener("open", () => listener.connection(true, ""));
  for (const name of EVENTS)
    source.addEventListener(name, (event) => listener[name](JSON.parse(event.data)));
  source.addEventListener("error", async () => {
    source.close();
    // The stream does not tell why it ended.
    const status = await fetch("/api/hello").then((r) => r.status, () => 0);
    const refused = status === 401 || status === 403;
    listener.connection(false, refused ? "The server was started anew. Open the address that it printed." : "The server does not answer.");
    if (!refused) setTimeout(() => connect(listener), status === 200 ? 0 : RETRY_AFTER);
  });
}

/** The browser asks by itself. @type {Transport} */
const browser = { fetch: (path, options) => fetch(path, { credentials: "same-origin", ...options }), listen: connect };

/** @param {Transport} [transport] @returns {import("./engine.js").Engine} */
export function serverEngine(transport = browser) {
  const ask = (/** @type {Parameters<Transport["fetch"]>} */ ...request) => accepted(transport.fetch(...request));
  const page = crypto.randomUUID?.() ?? Math.random().toString(36).slice(2);
  return {
    hello: async () => (await ask("/api/hello")).json(),
    listen: transport.listen,
    run: async (request) => (await (await ask("/api/run", json("POST", request))).json()).run,
    mesh: async (id) => (await ask(`/api/mesh/${encodeURIComponent(id)}`)).arrayBuffer(),
    files: async () => (await ask("/api/files")).json(),
    read: async (path) => {
      const response = await ask(fileAt(path), { cache: "no-store" });
      return { text: await response.text(), version: versionOf(response.headers.get("ETag")) };
    },
    write: async (path, text, version) => {
      const headers = { "If-Match": `"${version}"`, "Content-Type": "text/plain; charset=utf-8" };
      const response = await transport.fetch(fileAt(path), { method: "PUT", body: text, headers });
      if (response.status !== 412 && !response.ok) {
        const problem = await response.json().catch(() => ({}));
        throw new EngineError(problem.error ?? `cannot save ${path}`, problem.help);
      }
      return { saved: response.ok, version: (await response.json()).version };
    },
    render: async (request) => (await (await ask("/api/render", json("POST", request))).json()).job,
    picture: async (job) => (await ask(`/api/job/${job}`)).blob(),
    cancel: async (job) => {
      await ask(`/api/job/${job}`, { method: "DELETE" });
    },
    export: async (format) => {
      const response = await ask("/api/export", json("POST", { format }));
      const name = /filename="([^"]+)"/.exec(response.headers.get("Content-Disposition") ?? "")?.[1];
      return { name: name ?? `model.${format}`, blob: await response.blob() };
    },
    image: async (name) => (await ask(`/api/image/${encodeURIComponent(name)}`)).blob(),
    sets: async () => (await ask("/api/params")).json(),
    writeSets: async (sets) => {
      await ask("/api/params", json("PUT", sets));
    },
    lsp: async (messages, check) => (await ask("/api/lsp", json("POST", { page, messages, check }))).json(),
    measure: async (part) => {
      const m = await (await ask("/api/measure", json("POST", { part }))).json();
      return { ...m, bounds: m.bounds && [m.bounds.min, m.bounds.max] };
    },
    ...questions(async (question, request) => (await ask(`/api/${question}`, json("POST", request))).json()),
  };
}
