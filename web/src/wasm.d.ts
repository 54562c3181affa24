// The program as WebAssembly, as emscripten makes it (wasm/build.mk).

declare module "cag-wasm" {
  /** Addresses and sizes are numbers; texts end with a zero. */
  export interface Cag {
    HEAPU8: Uint8Array;
    FS: {
      mkdirTree(path: string): void;
      writeFile(path: string, data: string | Uint8Array): void;
      unlink(path: string): void;
    };
    UTF8ToString(address: number): string;
    _malloc(size: number): number;
    _free(address: number): void;
    _playground_bytes(): number;
    _playground_size(): number;
    _playground_type(): number;
    _playground_name(): number;
    _playground_error(): number;
    _playground_help(): number;
    _playground_hello(script: number): number;
    _playground_run(script: number, run: number, request: number): number;
    _playground_export(script: number, format: number): number;
    _playground_image(name: number): number;
    _playground_measure(script: number, part: number): number;
    _playground_picture(request: number): number;
    _playground_format(script: number, text: number): number;
    _playground_document(name: number): number;
    _playground_lsp(messages: number, check: number): number;
    _playground_library(module: number): number;
    _playground_question(question: number, request: number): number;
  }
  export interface Host {
    event(name: string, json: string): void;
    hasMesh(id: string): boolean;
    keepMesh(id: string, bytes: ArrayBuffer): void;
    progress(percent: number, phase: string): void;
    /** A file of fonts/; null: it cannot be read. */
    font(name: string): Uint8Array | null;
  }
  export default function make(options: {
    host: Host;
    instantiateWasm(imports: WebAssembly.Imports, done: (instance: WebAssembly.Instance) => void): object;
  }): Promise<Cag>;
}
