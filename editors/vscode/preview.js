// The page of `cag view` in a panel beside the text.
//
// The panel is of another origin than the server, which therefore refuses it. The page asks by messages, and the extension asks the server:
// it has the cookie, and a process of its own for each panel. The text editor is the editor of the page.

const crypto = require("crypto");
const fs = require("fs");
const path = require("path");
const vscode = require("vscode");
const { ViewServer } = require("./view_server");

const LISTEN_AGAIN = 500; // milliseconds
const HEADERS = ["content-type", "content-disposition", "etag"]; // of answers, which the page reads
const OURS = "cag";

// --- Locations ---

// The position of a line and column of the engine, which count from 1, columns in code points.
function positionOf(document, line, column) {
  const row = Math.min(Math.max(line, 1), document.lineCount) - 1, text = document.lineAt(row).text;
  return new vscode.Position(row, [...text].slice(0, column - 1).join("").length);
}

const rangeOf = (document, place) => new vscode.Range(positionOf(document, place.line, place.column), positionOf(document, place.endLine, place.endColumn));

const isModule = (name) => /^std\.\w+$/.test(name);

// The path without symbolic links, as the server has it.
function realPath(file) {
  try {
    return fs.realpathSync(file);
  } catch {
    return file;
  }
}

// --- The files of the page ---

// Deletes the pages of other versions. Panels that are open have loaded theirs.
async function forgetOthers(storage, folder) {
  for (const [name] of await vscode.workspace.fs.readDirectory(storage)) {
    const other = vscode.Uri.joinPath(storage, name);
    if (name.startsWith("page-") && other.path !== folder.path) await vscode.workspace.fs.delete(other, { recursive: true });
  }
}

// Fetches the page, and writes its files to a folder that is named by their contents. Returns that folder and the text of index.html.
async function fetchPage(server, storage) {
  const get = async (name) => {
    const { status, body } = await server.request(`/${name}`);
    if (status !== 200) throw new Error(`the server has no file /${name} (status ${status})`);
    return body;
  };
  const index = (await get("")).toString();
  const names = [...index.matchAll(/(?:href|src)="([\w.-]+)"/g)].map((m) => m[1]);
  const files = await Promise.all(names.map(async (name) => ({ name, bytes: await get(name) })));
  const hash = crypto.createHash("sha256");
  for (const { name, bytes } of files) hash.update(`${name} ${bytes.length}\n`).update(bytes);
  const folder = vscode.Uri.joinPath(storage, `page-${hash.digest("hex").slice(0, 16)}`);
  await vscode.workspace.fs.createDirectory(folder);
  const there = new Map(await vscode.workspace.fs.readDirectory(folder));
  if (there.size === 0) await forgetOthers(storage, folder);
  for (const { name, bytes } of files) if (!there.has(name)) await vscode.workspace.fs.writeFile(vscode.Uri.joinPath(folder, name), bytes);
  return { folder, index };
}

// index.html with the addresses that a panel can load. Only files of the extension's folder are allowed.
function panelHtml(index, webview, folder) {
  const policy = ["default-src 'none'", ...["script-src", "style-src", "img-src"].map((what) => `${what} ${webview.cspSource}`)].join("; ");
  const address = (name) => webview.asWebviewUri(vscode.Uri.joinPath(folder, name)).toString();
  return index
    .replace("<html ", '<html data-host="vscode" ')
    .replace(/<meta charset="utf-8">/, `$&\n<meta http-equiv="Content-Security-Policy" content="${policy}">`)
    .replace(/(<(?:link|script)\b[^>]*?\b(?:href|src)=")([\w.-]+)"/g, (_, before, name) => `${before}${address(name)}"`);
}

// --- Panels ---

class Preview {
  // tools: { storage, libraryUri(module), closed() }.
  constructor(uri, tools) {
    this.uri = uri;
    this.tools = tools;
    this.file = realPath(uri.fsPath);
    this.folder = path.dirname(this.file);
    this.names = new Map(); // paths below the folder, by URI
    this.disposables = [];
    this.listening = null; // ends the stream of events
    this.panel = null;
    this.marks = vscode.window.createTextEditorDecorationType({ backgroundColor: new vscode.ThemeColor("editor.wordHighlightBackground") });
    this.values = vscode.window.createTextEditorDecorationType({ after: { color: new vscode.ThemeColor("editorCodeLens.foreground"), margin: "0 0 0 2em", fontStyle: "italic" } });
    this.shownValues = [];
    this.disposables.push(this.marks, this.values);
  }

  async open() {
    const page = await this.startServer();
    this.panel = vscode.window.createWebviewPanel("cag.preview", `Preview ${path.basename(this.file)}`, { viewColumn: vscode.ViewColumn.Beside, preserveFocus: true },
      { enableScripts: true, retainContextWhenHidden: true, localResourceRoots: [this.tools.storage] });
    const { webview } = this.panel, w = vscode.workspace;
    this.disposables.push(
      webview.onDidReceiveMessage((message) => this.take(message)), this.panel.onDidDispose(() => this.dispose()),
      w.onDidOpenTextDocument((d) => this.sendDocument(d)), w.onDidChangeTextDocument(({ document }) => this.sendDocument(document)),
      w.onDidSaveTextDocument((d) => this.sendDocument(d)), w.onDidCloseTextDocument((d) => this.isOfModel(d) && this.post("closed", { path: this.nameOf(d) })),
      vscode.window.onDidChangeTextEditorSelection(({ textEditor }) => this.sendCursor(textEditor)),
      vscode.window.onDidChangeActiveTextEditor((e) => this.sendCursor(e)), vscode.window.onDidChangeVisibleTextEditors(() => this.showValues()));
    this.show(page);
  }

  // Starts the program, and returns the page that it has.
  async startServer() {
    const settings = vscode.workspace.getConfiguration("cag");
    const folders = (settings.get("modulePath") || []).flatMap((folder) => ["-I", folder]);
    const server = new ViewServer(settings.get("command"), [this.file, ...folders], (why) => server === this.server && this.lose(why));
    this.server = server;
    try {
      await server.start();
      return await fetchPage(server, this.tools.storage);
    } catch (error) {
      server.stop();
      throw error;
    }
  }

  show({ folder, index }) {
    this.pageFolder = folder;
    const html = panelHtml(index, this.panel.webview, folder);
    if (html === this.panel.webview.html) return false;
    this.panel.webview.html = html;
    return true;
  }

  reveal() {
    this.panel.reveal(undefined, true);
  }

  dispose() {
    if (this.disposed) return;
    this.disposed = true;
    this.stopListening();
    this.server.stop();
    this.disposables.forEach((d) => d.dispose());
    this.tools.closed();
  }

  // --- Messages ---

  post(type, fields) {
    if (!this.disposed) this.panel.webview.postMessage({ ...fields, type });
  }

  async take(message) {
    const handler = HANDLERS[message.type];
    if (!handler) return;
    try {
      const result = await handler.call(this, message);
      if (message.id !== undefined) this.post("answer", { id: message.id, result });
    } catch (error) {
      if (message.id !== undefined) this.post("answer", { id: message.id, error: error.message });
      else vscode.window.showErrorMessage(error.message);
    }
  }

  // --- The server ---

  async request({ path: asked, method, headers, body }) {
    if (!asked.startsWith("/api/")) throw new Error(`the page cannot ask for ${asked}`);
    const answer = await this.server.request(asked, { method, headers, body });
    const { buffer, byteOffset, length } = answer.body;
    return {
      status: answer.status, bytes: buffer.slice(byteOffset, byteOffset + length),
      headers: Object.fromEntries(HEADERS.filter((name) => answer.headers[name]).map((name) => [name, answer.headers[name]])),
    };
  }

  listen() {
    this.stopListening();
    if (!this.server.running) return this.lose("The server of the preview does not run");
    const server = this.server;
    this.listening = server.listen({
      opened: () => this.post("connection", { on: true, problem: "" }),
      event: (name, data) => this.post("event", { name, data }),
      closed: () => setTimeout(() => server === this.server && server.running && !this.disposed && this.listen(), LISTEN_AGAIN),
    });
  }

  stopListening() {
    if (this.listening) this.listening();
    this.listening = null;
  }

  lose(why) {
    this.stopListening();
    this.post("connection", { on: false, problem: `${why}.`, ended: true });
  }

  async restart() {
    if (this.server.running || this.starting) return;
    this.starting = true;
    try {
      const page = await this.startServer();
      if (this.disposed) return this.server.stop();
      // Another version of the program has another page, which listens by itself.
      if (!this.show(page)) this.listen();
    } catch (error) {
      this.lose(error.message.replace(/\.$/, ""));
    } finally {
      this.starting = false;
    }
  }

  // --- Texts ---

  // The path of a document below the folder, or its absolute path.
  nameOf(document) {
    const key = document.uri.toString();
    if (!this.names.has(key)) {
      const real = realPath(document.uri.fsPath), below = path.relative(this.folder, real);
      this.names.set(key, below.startsWith("..") || path.isAbsolute(below) ? real : below.split(path.sep).join("/"));
    }
    return this.names.get(key);
  }

  isOfModel(document) {
    return document.languageId === OURS && document.uri.scheme === "file" && !path.isAbsolute(this.nameOf(document));
  }

  describe(document) {
    return { path: this.nameOf(document), text: document.getText(), dirty: document.isDirty, version: document.version };
  }

  sendDocument(document) {
    if (this.isOfModel(document)) this.post("document", { document: this.describe(document) });
  }

  // What the panel needs to know when the page is loaded.
  ready() {
    vscode.workspace.textDocuments.forEach((d) => this.sendDocument(d));
    const { activeTextEditor, visibleTextEditors } = vscode.window;
    this.sendCursor(activeTextEditor || visibleTextEditors.find((e) => e.document.uri.toString() === this.uri.toString()));
  }

  sendCursor(editor) {
    if (!editor || !this.isOfModel(editor.document)) return;
    const { line, character } = editor.selection.active;
    const column = [...editor.document.lineAt(line).text.slice(0, character)].length + 1;
    this.post("cursor", { path: this.nameOf(editor.document), line: line + 1, column });
  }

  // The document of a path of the page, which may be open by a path with symbolic links.
  async documentOf(name) {
    const open = vscode.workspace.textDocuments.find((d) => d.uri.scheme === "file" && this.nameOf(d) === name);
    if (open) return open;
    const uri = isModule(name) ? await this.tools.libraryUri(name) : vscode.Uri.file(path.resolve(this.folder, name));
    if (!uri) throw new Error(`cannot show the module ${name}: the language server does not run`);
    return vscode.workspace.openTextDocument(uri);
  }

  async revealPlace({ place, focus }) {
    const document = await this.documentOf(place.file), range = rangeOf(document, place);
    const visible = vscode.window.visibleTextEditors, own = visible.find((e) => e.document === document) || visible[0];
    const editor = await vscode.window.showTextDocument(document, { viewColumn: own && own.viewColumn || vscode.ViewColumn.One, selection: range, preserveFocus: !focus });
    editor.revealRange(range, vscode.TextEditorRevealType.InCenterIfOutsideViewport);
  }

  // Changes texts as one step to undo. Nothing is changed if one of the texts is not what the page believes.
  async edit({ files }) {
    const edit = new vscode.WorkspaceEdit(), documents = [];
    let problem = "";
    for (const { path: name, version, changes } of files) {
      const document = await this.documentOf(name);
      documents.push(document);
      if (isModule(name)) problem = `the module ${name} cannot be changed`;
      for (const { from, to, old, insert } of changes) {
        const range = new vscode.Range(document.positionAt(from), document.positionAt(to));
        if ((version !== null && document.version !== version) || document.getText(range) !== old) problem = `${name} was changed in the editor meanwhile; try again`;
        edit.replace(document.uri, range, insert);
      }
    }
    if (!problem && !(await vscode.workspace.applyEdit(edit))) problem = "the editor has refused the change";
    return { problem, documents: documents.map((d) => this.describe(d)) };
  }

  // --- What is drawn into the text ---

  editorsOf(name) {
    return vscode.window.visibleTextEditors.filter((e) => e.document.uri.scheme === "file" && this.nameOf(e.document) === name);
  }

  mark({ path: name, range, scroll }) {
    for (const editor of vscode.window.visibleTextEditors) {
      const own = range && this.editorsOf(name).includes(editor);
      const ranges = own ? [new vscode.Range(editor.document.positionAt(range[0]), editor.document.positionAt(range[1]))] : [];
      editor.setDecorations(this.marks, ranges);
      if (own && scroll) editor.revealRange(ranges[0]);
    }
  }

  // The values of definitions, at the ends of their lines.
  showValues(values = this.shownValues) {
    this.shownValues = values;
    for (const editor of vscode.window.visibleTextEditors) {
      if (!this.isOfModel(editor.document)) continue;
      const name = this.nameOf(editor.document), own = values.filter((v) => v.file === name && v.endLine <= editor.document.lineCount);
      editor.setDecorations(this.values, own.map(({ endLine, text }) => {
        const end = editor.document.lineAt(endLine - 1).range.end;
        return { range: new vscode.Range(end, end), renderOptions: { after: { contentText: text } } };
      }));
    }
  }

  async download({ name, bytes }) {
    const target = await vscode.window.showSaveDialog({ defaultUri: vscode.Uri.file(path.join(this.folder, path.basename(name))) });
    if (target) await vscode.workspace.fs.writeFile(target, new Uint8Array(bytes));
  }
}

// What the page asks for, by the type of its messages.
const HANDLERS = {
  ready() { this.ready(); },
  listen() { this.listen(); },
  restart() { return this.restart(); },
  request(message) { return this.request(message); },
  edit(message) { return this.edit(message); },
  reveal(message) { return this.revealPlace(message); },
  mark(message) { this.mark(message); },
  values({ values }) { this.showValues(values); },
  download(message) { return this.download(message); },
  async undo({ path: name, again }) {
    await vscode.window.showTextDocument(await this.documentOf(name));
    await vscode.commands.executeCommand(again ? "redo" : "undo");
  },
  async save({ path: name }) { await (await this.documentOf(name)).save(); },
  async licenses() { await vscode.window.showTextDocument(vscode.Uri.joinPath(this.pageFolder, "licenses.txt"), { preview: true }); },
};

// --- All panels ---

class Previews {
  // libraryUri(module): the file that the language server shows for a module of the library.
  constructor(storage, libraryUri) {
    this.storage = storage;
    this.libraryUri = libraryUri;
    this.open = new Map(); // by URI: a promise for the panel
  }

  // Opens the panel of a script, or shows it again.
  async show(uri) {
    const key = uri.toString();
    if (uri.scheme !== "file") {
      vscode.window.showErrorMessage("The preview needs a file. Save the script first.");
      return;
    }
    const opened = this.open.get(key);
    if (opened) return void (await opened.catch(() => null))?.reveal();
    const preview = new Preview(uri, { storage: this.storage, libraryUri: this.libraryUri, closed: () => this.open.delete(key) });
    const opening = preview.open().then(() => preview);
    this.open.set(key, opening);
    try {
      await opening;
    } catch (error) {
      this.open.delete(key);
      preview.disposables.forEach((d) => d.dispose());
      vscode.window.showErrorMessage(error.message);
    }
  }

  async dispose() {
    for (const opened of [...this.open.values()]) {
      const preview = await opened.catch(() => null);
      if (preview) preview.panel.dispose();
    }
  }
}

module.exports = { Previews };
