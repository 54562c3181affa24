// A stand-in for the module `vscode`: only what the extension uses, without an editor that is seen.
"use strict";
const fs = require("fs");
const Module = require("module");
const path = require("path");

const disposable = { dispose() {} };
const plain = (...names) => class { constructor(...values) { names.forEach((name, i) => { this[name] = values[i]; }); } };

class Position { constructor(line, character) { Object.assign(this, { line, character }); } }
class Range { constructor(start, end) { Object.assign(this, { start, end }); } }
class Uri {
  constructor(text) { this.text = text; this.scheme = text.split(":")[0]; this.path = this.fsPath = decodeURIComponent(text.slice(7)); }
  static parse(text) { return new Uri(text); }
  static file(name) { return new Uri("file://" + name.split("/").map(encodeURIComponent).join("/")); }
  static joinPath(uri, ...names) { return Uri.file(path.join(uri.fsPath, ...names)); }
  toString() { return this.text; }
}

// What the editor tells its extensions: events.NAME(what) calls all handlers of onDidNAME, and on(NAME) adds one.
class Events {
  constructor() { this.handlers = {}; }
  on(name) {
    const list = this.handlers[name] ??= new Set();
    this[name] = (what) => [...list].forEach((handler) => handler(what));
    return (handler) => {
      list.add(handler);
      return { dispose: () => list.delete(handler) };
    };
  }
}

class WorkspaceEdit {
  constructor() { this.all = new Map(); }
  set(uri, edits) { this.all.set(uri.toString(), edits); }
  replace(uri, range, newText) { this.all.set(uri.toString(), [...(this.all.get(uri.toString()) ?? []), { range, newText }]); }
}

// settings: of the section `cag`; folder: of the workspace.
function standIn({ settings, folder }) {
  const given = {}, events = new Events(), messages = [], published = new Map(), opened = [], commands = {}, items = new Map(), edits = [], panels = [], shown = [];

  // A document, and its file unless its text is only of the editor.
  class Document {
    constructor(name, text) {
      this.uri = Uri.file(path.resolve(folder, name));
      this.languageId = "cag";
      this.version = 1;
      this.isDirty = false;
      if (text !== undefined) fs.writeFileSync(this.uri.fsPath, text);
      this.text = text ?? fs.readFileSync(this.uri.fsPath, "utf8");
    }
    get lineCount() { return this.text.split("\n").length; }
    getText(range) { return range ? this.text.slice(this.offsetAt(range.start), this.offsetAt(range.end)) : this.text; }
    lineAt(line) {
      const text = this.text.split("\n")[line];
      return { text, range: new Range(new Position(line, 0), new Position(line, text.length)) };
    }
    offsetAt({ line, character }) { return this.text.split("\n").slice(0, line).join("\n").length + (line > 0) + character; }
    positionAt(offset) {
      const before = this.text.slice(0, offset), line = before.split("\n").length - 1;
      return new Position(line, before.length - before.lastIndexOf("\n") - 1);
    }
    at(mark, inside = 0) { return this.positionAt(this.text.indexOf(mark) + inside); }
    // Changes a part as by typing.
    replace(old, text) {
      const range = new Range(this.at(old), this.at(old, old.length));
      this.type(this.text.replace(old, () => text), [{ range, text }]);
    }
    type(text, contentChanges = [{ text }]) {
      this.text = text;
      this.version++;
      this.isDirty = true;
      events.ChangeTextDocument({ document: this, contentChanges });
    }
    async save() {
      fs.writeFileSync(this.uri.fsPath, this.text);
      this.isDirty = false;
      events.SaveTextDocument(this);
      return true;
    }
  }
  // Shows a document as the user does.
  function edit(document) {
    const editor = { document, viewColumn: 1, selection: { active: new Position(0, 0) }, decorations: new Map(), revealed: null,
      revealRange(range) { this.revealed = range; }, setDecorations(type, list) { this.decorations.set(type, list); } };
    if (!vscode.workspace.textDocuments.includes(document)) vscode.workspace.textDocuments.push(document);
    vscode.window.visibleTextEditors = [editor];
    vscode.window.activeTextEditor = editor;
    events.OpenTextDocument(document);
    events.ChangeActiveTextEditor?.(editor);
    return editor;
  }
  function moveCursor(editor, active) {
    editor.selection = { active };
    events.ChangeTextEditorSelection({ textEditor: editor });
  }

  const register = (kind) => (selector, provider) => { given[kind] = provider === undefined ? selector : provider; return disposable; };
  const all = (names, prefix, make) => Object.fromEntries(names.map((name) => [prefix.replace("*", name), make(name)]));
  class WebviewPanel {
    constructor(kind, title, column) {
      Object.assign(this, { kind, title, column, sent: [], reveals: 0 });
      const own = new Events(), panel = this;
      this.onDidDispose = own.on("Dispose");
      this.webview = { html: "", cspSource: "https://resources.test", asWebviewUri: (uri) => new Uri(`https://resources.test${uri.path}`),
        onDidReceiveMessage: own.on("ReceiveMessage"), postMessage: (message) => panel.receive(message) };
      this.receive = (message) => this.sent.push(message);
      this.say = (message) => own.ReceiveMessage(message);
      this.dispose = () => { this.disposed = true; own.Dispose(); };
    }
    reveal() { this.reveals++; }
  }

  const vscode = {
    Position, Range, Uri, WorkspaceEdit,
    Location: plain("uri", "range"), MarkdownString: plain("value"), TextEdit: plain("range", "newText"), Diagnostic: plain("range", "message", "severity"),
    DiagnosticRelatedInformation: plain("location", "message"), DocumentSymbol: plain("name", "detail", "kind", "range", "selectionRange"),
    CompletionItem: plain("label", "kind"), SnippetString: plain("value"), CompletionList: plain("items", "isIncomplete"), CodeAction: plain("title", "kind"),
    CodeActionKind: { Empty: { append: (value) => ({ value }) } }, SelectionRange: plain("range", "parent"), Hover: plain("contents", "range"),
    SignatureHelp: class {}, SignatureInformation: plain("label", "documentation"), ParameterInformation: plain("label", "documentation"),
    DocumentHighlight: plain("range"), SymbolInformation: plain("name", "kind", "container", "location"), FoldingRange: plain("start", "end", "kind"),
    DocumentLink: plain("range", "target"), Color: plain("red", "green", "blue", "alpha"), ColorInformation: plain("range", "color"), ColorPresentation: plain("label"),
    InlayHint: plain("position", "label", "kind"), CodeLens: plain("range", "command"), SemanticTokens: plain("data", "resultId"),
    SemanticTokensEdit: plain("start", "deleteCount", "data"), SemanticTokensEdits: plain("edits", "resultId"), SemanticTokensLegend: plain("types", "modifiers"),
    TestRunProfileKind: { Run: 1 }, TestMessage: plain("message"), ThemeColor: plain("id"), ViewColumn: { One: 1, Beside: -2 }, TextEditorRevealType: { InCenterIfOutsideViewport: 2 },
    languages: {
      createDiagnosticCollection: () => ({ set: (uri, list) => published.set(uri.toString(), list), clear: () => published.clear(), ...disposable }),
      ...all(["CompletionItem", "Hover", "SignatureHelp", "Definition", "Reference", "DocumentHighlight", "Rename", "DocumentSymbol", "WorkspaceSymbol", "FoldingRange",
        "SelectionRange", "DocumentLink", "Color", "InlayHints", "DocumentFormattingEdit", "DocumentRangeFormattingEdit", "OnTypeFormattingEdit", "CodeActions", "CodeLens",
        "DocumentSemanticTokens"], "register*Provider", register),
    },
    window: {
      createOutputChannel: () => ({ append() {}, appendLine() {}, ...disposable }), activeTextEditor: undefined, visibleTextEditors: [],
      showErrorMessage: (text) => messages.push(text), showInformationMessage: (text) => messages.push(text),
      createTextEditorDecorationType: (options) => ({ options, ...disposable }),
      createWebviewPanel: (kind, title, column, options) => {
        const panel = new WebviewPanel(kind, title, column, options);
        panels.push(panel);
        return panel;
      },
      showTextDocument: async (target, options) => {
        const document = target instanceof Document ? target : await vscode.workspace.openTextDocument(target);
        shown.push({ path: document.uri.fsPath, ...options });
        const editor = vscode.window.visibleTextEditors.find((e) => e.document === document) ?? edit(document);
        if (options.selection) moveCursor(editor, options.selection.end);
        return editor;
      },
      showSaveDialog: async ({ defaultUri }) => defaultUri,
      ...all(["ChangeTextEditorSelection", "ChangeActiveTextEditor", "ChangeVisibleTextEditors"], "onDid*", (name) => events.on(name)),
    },
    workspace: {
      workspaceFolders: [{ uri: Uri.file(folder), name: "work" }], textDocuments: [],
      getConfiguration: () => ({ get: (name) => settings[name] }), asRelativePath: (uri) => uri.fsPath,
      createFileSystemWatcher: () => ({ onDidCreate: events.on("created"), onDidChange: events.on("changed"), onDidDelete: events.on("deleted"), ...disposable }),
      openTextDocument: async (uri) => {
        const known = vscode.workspace.textDocuments.find((d) => d.uri.toString() === uri.toString()), document = known ?? new Document(uri.fsPath);
        if (!known) vscode.workspace.textDocuments.push(document);
        return document;
      },
      // One step to undo, whatever it changes.
      applyEdit: async (edit) => {
        edits.push(edit);
        for (const [uri, list] of edit.all) {
          const document = vscode.workspace.textDocuments.find((d) => d.uri.toString() === uri);
          const ordered = list.map(({ range, newText }) => [document.offsetAt(range.start), document.offsetAt(range.end), newText]).sort((a, b) => b[0] - a[0]);
          document.type(ordered.reduce((text, [from, to, newText]) => text.slice(0, from) + newText + text.slice(to), document.text));
        }
        return true;
      },
      fs: {
        createDirectory: async (uri) => { fs.mkdirSync(uri.fsPath, { recursive: true }); },
        readDirectory: async (uri) => fs.readdirSync(uri.fsPath, { withFileTypes: true }).map((e) => [e.name, e.isDirectory() ? 2 : 1]),
        writeFile: async (uri, bytes) => fs.writeFileSync(uri.fsPath, bytes),
        delete: async (uri, { recursive }) => fs.rmSync(uri.fsPath, { recursive }),
      },
      ...all(["OpenTextDocument", "ChangeTextDocument", "SaveTextDocument", "CloseTextDocument", "ChangeConfiguration", "ChangeWorkspaceFolders"], "onDid*", (name) => events.on(name)),
    },
    commands: {
      registerCommand: (name, run) => { commands[name] = run; return disposable; },
      executeCommand: async (name, uri) => { opened.push(uri.toString()); },
    },
    tests: {
      createTestController: () => ({
        items: { delete: (id) => items.delete(id), add: (item) => items.set(item.id, item), forEach: (each) => items.forEach(each) },
        createTestItem: (id, label, uri) => ({ id, label, uri }), createRunProfile: (name, kind, run) => { given.runTests = run; },
        createTestRun: () => ({ started() {}, appendOutput() {}, passed: (item) => { item.state = "passed"; }, failed: (item) => { item.state = "failed"; }, end() {} }), ...disposable,
      }),
    },
  };
  const load = Module._load;
  Module._load = (name, ...rest) => (name === "vscode" ? vscode : load(name, ...rest));
  return { vscode, given, events, messages, published, opened, commands, items, edits, panels, shown, Document, edit, moveCursor };
}

async function until(condition, what) {
  for (let i = 0; i < 1000; i++) {
    const value = await condition();
    if (value) return value;
    await new Promise((resolve) => setTimeout(resolve, 20));
  }
  throw new Error(`no ${what} in 20 s`);
}

let failures = 0;
// Prints `ok NAME` or `FAILED NAME: WHY`.
async function check(name, test) {
  try {
    await test();
    console.log(`ok ${name}`);
  } catch (error) {
    failures++;
    console.log(`FAILED ${name}: ${error.stack}`);
  }
}

module.exports = { standIn, until, check, failed: () => failures > 0, Position, Range, Uri };
