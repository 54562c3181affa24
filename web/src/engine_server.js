// The engine behind HTTP: requests, and one stream of events.

import { EngineError } from "./engine.js";

// Milliseconds until the page looks for a server that is gone.
const RETRY_AFTER = 1000;

/**
 * @param {string} path
 * @param {RequestInit} [options]
 * @returns {Promise<Response>}
 */
async function ask(path, options) {
  const response = await fetch(path, { credentials: "same-origin", ...options });
  if (response.ok) return response;
  /** @type {{ error?: string, help?: string }} */
  const problem = await response.json().catch(() => ({}));
  throw new EngineError(problem.error ?? `the server answered with status ${response.status}`, problem.help);
}

/** @param {string} method @param {unknown} body @returns {RequestInit} */
const json = (method, body) => ({ method, body: JSON.stringify(body), headers: { "Content-Type": "application/json" } });

/** @param {string | null} tag */
const versionOf = (tag) => (tag ?? "").replace(/^W\//, "").replace(/^"|"$/g, "");

/** @param {string} path */
const fileAt = (path) => `/api/file?path=${encodeURIComponent(path)}`;

/** @param {import("./engine.js").EngineListener} listener */
function connect(listener) {
  const source = new EventSource("/api/events");
  source.addEventListener("open", () => listener.connection(true, ""));
  for (const name of /** @type {const} */ (["state", "scene", "messages", "file", "progress"]))
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

/** @returns {import("./engine.js").Engine} */
export function serverEngine() {
  return {
    hello: async () => (await ask("/api/hello")).json(),
    listen: connect,
    run: async (request) => (await (await ask("/api/run", json("POST", request))).json()).run,
    mesh: async (id) => (await ask(`/api/mesh/${encodeURIComponent(id)}`)).arrayBuffer(),
    files: async () => (await ask("/api/files")).json(),
    read: async (path) => {
      const response = await ask(fileAt(path), { cache: "no-store" });
      return { text: await response.text(), version: versionOf(response.headers.get("ETag")) };
    },
    write: async (path, text, version) => {
      const headers = { "If-Match": `"${version}"`, "Content-Type": "text/plain; charset=utf-8" };
      const response = await fetch(fileAt(path), { method: "PUT", body: text, headers, credentials: "same-origin" });
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
    points: async (part) => (await ask("/api/points", json("POST", { part }))).json(),
    solve: async (request) => (await ask("/api/solve", json("POST", request))).json(),
    measure: async (part) => {
      const m = await (await ask("/api/measure", json("POST", { part }))).json();
      return { ...m, bounds: m.bounds && [m.bounds.min, m.bounds.max] };
    },
  };
}
