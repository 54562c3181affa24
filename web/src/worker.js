// The worker of the playground: runs cag as WebAssembly. engine_worker.js sends it calls, which it does one after the other.

import make from "cag-wasm";
import { crashOf, Program } from "./wasm_program.js";

/**
 * @typedef {{ script: string, number: number, files: Record<string, string>, request: string, quiet: boolean, known: string[] | null }} RunCall
 *   quiet: nothing is published; known: the meshes that the page has, null: as before
 * @typedef {{ start: WebAssembly.Module | null } | { id: number, run: RunCall } | { id: number, ask: string, values: string[], files?: Record<string, string> }} Call
 */

/** @type {Promise<Program> | null} */
let starting = null;
/** The meshes that the page has. @type {Set<string>} */
let known = new Set();
let quiet = false;

const post = (/** @type {any} */ message, /** @type {Transferable[]} */ transfer = []) => self.postMessage(message, { transfer });

/** A run cannot wait for anything else. @param {string} name */
function loadFont(name) {
  const request = new XMLHttpRequest();
  request.open("GET", new URL(`fonts/${name}`, import.meta.url), false);
  request.responseType = "arraybuffer";
  try {
    request.send();
  } catch {
    return null; // the server cannot be reached
  }
  return request.status === 200 ? new Uint8Array(request.response) : null;
}

/** @type {import("cag-wasm").Host} */
const host = {
  event: (event, json) => quiet || post({ event, json }),
  hasMesh: (id) => quiet || known.has(id),
  keepMesh: (id, bytes) => {
    known.add(id);
    post({ mesh: id, bytes }, [bytes]);
  },
  progress: (percent, phase) => post({ progress: percent, phase }),
  font: loadFont,
};

/** @param {WebAssembly.Module | null} given  compiled by another worker */
async function start(given) {
  const module = given ?? (await WebAssembly.compileStreaming(fetch(new URL("cag.wasm", import.meta.url))));
  const program = await Program.start(make, module, host);
  post({ module });
  return program;
}

/** @param {Program} program @param {RunCall} call */
function run(program, call) {
  if (call.known) known = new Set(call.known);
  quiet = call.quiet;
  program.setFiles(call.files);
  program.call(program.cag._playground_run, call.script, call.number, call.request);
  quiet = false;
}

/** @param {Program} program @param {string} name @param {string[]} values */
function ask(program, name, values) {
  const { cag } = program;
  /** @type {Record<string, (...addresses: number[]) => number>} */
  const functions = { hello: cag._playground_hello, export: cag._playground_export, image: cag._playground_image, measure: cag._playground_measure,
    picture: cag._playground_picture, format: cag._playground_format, document: cag._playground_document,
    lsp: cag._playground_lsp, library: cag._playground_library, question: cag._playground_question };
  return program.ask(functions[name], ...values);
}

self.addEventListener("message", async ({ data }) => {
  /** @type {Call} */
  const call = data;
  try {
    if ("start" in call) {
      starting = start(call.start);
      await starting.catch((error) => post({ failed: error.message }));
      return;
    }
    const program = await /** @type {Promise<Program>} */ (starting);
    if ("run" in call) {
      run(program, call.run);
      post({ id: call.id, result: null });
    } else {
      if (call.files) program.setFiles(call.files);
      const answer = ask(program, call.ask, call.values);
      post({ id: call.id, result: answer }, [answer.bytes.buffer]);
    }
  } catch (error) {
    const crash = crashOf(error);
    post({ id: "id" in call ? call.id : 0, error: error instanceof Error ? error.message : String(error), crash });
  }
});
