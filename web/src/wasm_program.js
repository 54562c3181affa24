// The program as WebAssembly: calls with texts, and the files of the model.

import { EngineError } from "./engine.js";

const FOLDER = "/model/";

/**
 * @typedef {object} Answer
 * @property {Uint8Array<ArrayBuffer>} bytes
 * @property {string} type
 * @property {string} name  of the file to save, or ""
 */

export class Program {
  /** @param {import("cag-wasm").Cag} cag */
  constructor(cag) {
    this.cag = cag;
    /** @type {Map<string, string>} */
    this.files = new Map();
  }

  /**
   * @param {typeof import("cag-wasm").default} make
   * @param {WebAssembly.Module} module
   * @param {import("cag-wasm").Host} host
   */
  static async start(make, module, host) {
    const cag = await make({
      host,
      instantiateWasm: (imports, done) => {
        WebAssembly.instantiate(module, imports).then(done);
        return {};
      },
    });
    cag.FS.mkdirTree(FOLDER);
    return new Program(cag);
  }

  /** Calls a function with texts. @param {(...addresses: number[]) => number} f @param {(string | number)[]} values */
  call(f, ...values) {
    /** @type {number[]} */
    const taken = [];
    const given = values.map((value) => {
      if (typeof value === "number") return value;
      const bytes = new TextEncoder().encode(value), at = this.cag._malloc(bytes.length + 1);
      if (!at) throw new EngineError("out of memory");
      this.cag.HEAPU8.set(bytes, at);
      this.cag.HEAPU8[at + bytes.length] = 0;
      taken.push(at);
      return at;
    });
    const result = f(...given);
    for (const at of taken) this.cag._free(at);
    return result;
  }

  /** What a function answers. @param {(...addresses: number[]) => number} f @param {string[]} values @returns {Answer} */
  ask(f, ...values) {
    const { cag } = this, status = this.call(f, ...values), text = (/** @type {number} */ at) => (at ? cag.UTF8ToString(at) : "");
    if (status !== 200) throw new EngineError(text(cag._playground_error()), text(cag._playground_help()));
    const at = cag._playground_bytes();
    return { bytes: cag.HEAPU8.slice(at, at + cag._playground_size()), type: text(cag._playground_type()), name: text(cag._playground_name()) };
  }

  /** Makes these the files of the model. @param {Record<string, string>} files  texts by path */
  setFiles(files) {
    const { FS } = this.cag;
    for (const path of this.files.keys())
      if (!(path in files)) {
        FS.unlink(FOLDER + path);
        this.files.delete(path);
      }
    for (const [path, text] of Object.entries(files)) {
      if (this.files.get(path) === text) continue;
      FS.mkdirTree((FOLDER + path).replace(/\/[^/]*$/, ""));
      FS.writeFile(FOLDER + path, text);
      this.files.set(path, text);
    }
  }
}

/** What ended the program: it cannot be used any more. @param {unknown} error @returns {{ code: string, message: string, help: string } | null} */
export function crashOf(error) {
  if (error instanceof EngineError) return null;
  if (error instanceof RangeError || /stack/i.test(String(error)))
    return { code: "E0601", message: "calls are nested too deeply for this browser", help: "use fewer nested calls, or run the script with cag on your computer" };
  if (/OOM|memory/i.test(String(error))) return { code: "E0602", message: "the browser has no more memory for the script", help: "" };
  return { code: "E0001", message: `the program failed: ${error instanceof Error ? error.message : error}`, help: "please report the script" };
}
