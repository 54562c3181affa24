// The language server as the editor sees it: requests, and the problems that it finds.
//
// Before each request, texts that changed are sent along. Messages go one batch at a time, so they stay in order. Looking for problems takes
// longer; it is asked for on its own, and given up when another message comes.

import { isModule } from "./places.js";
import { Topic } from "./topic.js";

const NOT_INITIALIZED = -32002;
const CAPABILITIES = {
  general: { positionEncodings: ["utf-16"] },
  workspace: { workspaceEdit: { documentChanges: false } },
  textDocument: {
    completion: { completionItem: { snippetSupport: true, documentationFormat: ["markdown"] } },
    hover: { contentFormat: ["markdown"] },
    signatureHelp: { signatureInformation: { documentationFormat: ["markdown"] } },
  },
};

/**
 * @typedef {{ line: number, character: number }} Position  from 0, in UTF-16 units
 * @typedef {{ start: Position, end: Position }} Range
 * @typedef {{ range: Range, newText: string }} TextEdit
 * @typedef {{ changes?: Record<string, TextEdit[]> }} WorkspaceEdit
 * @typedef {{ message: string, location: { uri: string, range: Range } }} Related
 * @typedef {{ range: Range, severity: number, code: string, message: string, relatedInformation?: Related[] }} Problem
 * @typedef {{ title: string, kind: string, isPreferred?: boolean, diagnostics?: Problem[], edit?: WorkspaceEdit }} Action
 * @typedef {{ kind: string, value: string }} Markup
 * @typedef {object} Completion
 * @property {string} label
 * @property {number} kind
 * @property {string} [detail]
 * @property {Markup} [documentation]
 * @property {string} sortText
 * @property {TextEdit} textEdit
 * @property {number} [insertTextFormat]  2: a snippet
 * @property {TextEdit[]} [additionalTextEdits]
 * @property {number[]} [tags]
 * @typedef {{ label: string, documentation?: Markup, parameters: { label: [number, number], documentation?: Markup }[] }} Signature
 * @typedef {{ signatures: Signature[], activeSignature: number, activeParameter: number }} Signatures
 * @typedef {{ id?: number, method?: string, params?: any, result?: any, error?: { code: number, message: string } }} Message
 */

/** What the language server refuses. */
export class LanguageError extends Error {
  /** @param {string} message @param {number} code */
  constructor(message, code) {
    super(message);
    this.code = code;
  }
}

export class Language {
  /**
   * @param {(messages: object[], check: boolean) => Promise<Message[]>} send
   * @param {string} folder  of the scripts
   * @param {() => Iterable<[string, string]>} texts  the open files, by path below the folder
   */
  constructor(send, folder, texts) {
    this.send = send;
    this.root = `file://${encodePath(folder)}/`;
    this.folder = folder;
    this.texts = texts;
    /** Problems of a file, by its path. @type {Topic<{ path: string, problems: Problem[] }>} */
    this.published = new Topic();
    /** What the server has. @type {Map<string, { text: string, version: number }>} */
    this.known = new Map();
    this.last = 0; // id of the last request
    this.begun = false;
    /** @type {Promise<unknown>} */
    this.sending = Promise.resolve();
  }

  /** @param {string} path */
  uri(path) {
    return isModule(path) ? `cag:${path}` : this.root + encodePath(path);
  }

  /** The path below the folder, or the name of a module of the library. @param {string} uri */
  path(uri) {
    if (uri.startsWith("cag:")) return uri.slice(4);
    const path = decodeURIComponent(uri.replace(/^file:\/\//, ""));
    return path.startsWith(`${this.folder}/`) ? path.slice(this.folder.length + 1) : path;
  }

  /** The messages that tell the server what has changed. */
  changes() {
    /** @type {object[]} */
    const messages = [];
    const notify = (/** @type {string} */ method, /** @type {object} */ params) => messages.push({ jsonrpc: "2.0", method, params });
    if (!this.begun) {
      const folders = [{ uri: this.root.slice(0, -1), name: "scripts" }];
      const params = { capabilities: CAPABILITIES, workspaceFolders: folders, initializationOptions: { runOnSave: false } };
      messages.push({ jsonrpc: "2.0", id: ++this.last, method: "initialize", params });
      notify("initialized", {});
      this.begun = true;
    }
    for (const [path, text] of this.texts()) {
      const known = this.known.get(path), uri = this.uri(path);
      if (known?.text === text) continue;
      const version = (known?.version ?? 0) + 1;
      if (known) notify("textDocument/didChange", { textDocument: { uri, version }, contentChanges: [{ text }] });
      else notify("textDocument/didOpen", { textDocument: { uri, languageId: "cag", version, text } });
      this.known.set(path, { text, version });
    }
    return messages;
  }

  /** @param {Message[]} messages */
  take(messages) {
    for (const { method, params } of messages)
      if (method === "textDocument/publishDiagnostics") this.published.emit({ path: this.path(params.uri), problems: params.diagnostics });
  }

  /** Forgets what the server knew: it is another one. */
  begin() {
    this.begun = false;
    this.known.clear();
  }

  /**
   * Sends what changed, and a request if there is one. Resolves with its answer.
   *
   * @param {string} [method]
   * @param {object} [params]
   * @param {boolean} [again]
   * @returns {Promise<any>}
   */
  ask(method, params, again = false) {
    const turn = this.sending.then(async () => {
      const messages = this.changes(), id = ++this.last;
      if (method) messages.push({ jsonrpc: "2.0", id, method, params });
      if (messages.length === 0) return null;
      const answers = await this.send(messages, false).catch((error) => {
        this.begin();
        throw error;
      });
      this.take(answers);
      const answer = answers.find((a) => a.id === id), lost = answers.some((a) => a.error?.code === NOT_INITIALIZED);
      if (lost) this.begin();
      if (answer?.error) throw new LanguageError(answer.error.message, answer.error.code);
      return lost ? Promise.reject(new LanguageError("the server has begun anew", NOT_INITIALIZED)) : answer?.result ?? null;
    });
    this.sending = turn.catch(() => {});
    return turn.catch((error) => {
      if (!again && error instanceof LanguageError && error.code === NOT_INITIALIZED) return this.ask(method, params, true);
      throw error;
    });
  }

  /** Sends what changed, and asks for the problems, which are published. */
  async check() {
    await this.ask();
    this.take(await this.send([], true));
  }

  /** @param {string} path @param {Position} position */
  at(path, position) {
    return { textDocument: { uri: this.uri(path) }, position };
  }

  /** @param {string} path @param {Position} position @returns {Promise<{ items: Completion[] } | null>} */
  complete(path, position) {
    return this.ask("textDocument/completion", this.at(path, position));
  }

  /** @param {string} path @param {Position} position @returns {Promise<{ contents: Markup, range?: Range } | null>} */
  hover(path, position) {
    return this.ask("textDocument/hover", this.at(path, position));
  }

  /** @param {string} path @param {Position} position @returns {Promise<Signatures | null>} */
  signatures(path, position) {
    return this.ask("textDocument/signatureHelp", this.at(path, position));
  }

  /** @param {string} path @param {Position} position @returns {Promise<{ uri: string, range: Range }[]>} */
  async definition(path, position) {
    return (await this.ask("textDocument/definition", this.at(path, position))) ?? [];
  }

  /** @param {string} path @param {Position} position @returns {Promise<{ uri: string, range: Range }[]>} */
  async references(path, position) {
    return (await this.ask("textDocument/references", { ...this.at(path, position), context: { includeDeclaration: true } })) ?? [];
  }

  /** The place of a name that can be changed. @param {string} path @param {Position} position @returns {Promise<Range | null>} */
  canRename(path, position) {
    return this.ask("textDocument/prepareRename", this.at(path, position));
  }

  /** @param {string} path @param {Position} position @param {string} newName @returns {Promise<WorkspaceEdit | null>} */
  rename(path, position, newName) {
    return this.ask("textDocument/rename", { ...this.at(path, position), newName });
  }

  /** @param {string} path @returns {Promise<TextEdit[]>} */
  async format(path) {
    return (await this.ask("textDocument/formatting", { textDocument: { uri: this.uri(path) }, options: { tabSize: 2, insertSpaces: true } })) ?? [];
  }

  /** @param {string} path @param {Range} range @param {Problem[]} diagnostics @param {string[]} [only] @returns {Promise<Action[]>} */
  async actions(path, range, diagnostics, only) {
    return (await this.ask("textDocument/codeAction", { textDocument: { uri: this.uri(path) }, range, context: { diagnostics, ...(only ? { only } : {}) } })) ?? [];
  }
}

/** As the server writes paths in addresses. @param {string} path */
const encodePath = (path) => path.split("/").map((name) => encodeURIComponent(name).replace(/[!'()*]/g, (c) => `%${c.charCodeAt(0).toString(16).toUpperCase()}`)).join("/");
