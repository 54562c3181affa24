// The extension of Visual Studio Code for scripts of the cag language. It starts `cag lsp` and passes the editor's questions on.

const vscode = require("vscode");
const { Client } = require("./client");
const { Previews } = require("./preview");

const SELECTOR = { language: "cag" };
const LANGUAGE = "cag";
let client, diagnostics, output, legend, tests, previews;
const running = []; // what ends with the server

// --- From the protocol to the editor ---

const uriOf = (text) => vscode.Uri.parse(text);
const toPosition = (p) => new vscode.Position(p.line, p.character);
const toRange = (r) => new vscode.Range(toPosition(r.start), toPosition(r.end));
const toLocation = (l) => new vscode.Location(uriOf(l.uri), toRange(l.range));
const toMarkdown = (m) => (m ? new vscode.MarkdownString(m.value) : undefined);
const toEdit = (e) => new vscode.TextEdit(toRange(e.range), e.newText);

function toWorkspaceEdit(edit) {
  const all = new vscode.WorkspaceEdit();
  for (const [uri, edits] of Object.entries(edit.changes || {})) all.set(uriOf(uri), edits.map(toEdit));
  return all;
}

function toDiagnostic(d) {
  const one = new vscode.Diagnostic(toRange(d.range), d.message, d.severity - 1);
  one.code = d.code;
  one.source = d.source;
  one.tags = d.tags;
  one.relatedInformation = (d.relatedInformation || []).map((r) => new vscode.DiagnosticRelatedInformation(toLocation(r.location), r.message));
  return one;
}

function toSymbol(s) {
  const symbol = new vscode.DocumentSymbol(s.name, s.detail || "", s.kind - 1, toRange(s.range), toRange(s.selectionRange));
  symbol.children = s.children.map(toSymbol);
  return symbol;
}

function toCompletion(i) {
  const item = new vscode.CompletionItem(i.label, i.kind - 1);
  item.detail = i.detail;
  item.documentation = toMarkdown(i.documentation);
  item.sortText = i.sortText;
  item.range = toRange(i.textEdit.range);
  item.insertText = i.insertTextFormat === 2 ? new vscode.SnippetString(i.textEdit.newText) : i.textEdit.newText;
  item.additionalTextEdits = (i.additionalTextEdits || []).map(toEdit);
  item.tags = i.tags;
  return item;
}

function toAction(a) {
  const action = new vscode.CodeAction(a.title, vscode.CodeActionKind.Empty.append(a.kind));
  action.edit = toWorkspaceEdit(a.edit);
  action.isPreferred = a.isPreferred;
  action.diagnostics = (a.diagnostics || []).map(toDiagnostic);
  return action;
}

function toSelection(s) {
  return new vscode.SelectionRange(toRange(s.range), s.parent && toSelection(s.parent));
}

// --- From the editor to the protocol ---

const of = (document) => ({ textDocument: { uri: document.uri.toString() } });
const at = (document, position) => ({ ...of(document), position });
const isOurs = (document) => document.languageId === LANGUAGE;

// Returns the answer of the server, or nothing if there is none.
async function ask(method, params, token) {
  try {
    return await client.request(method, params, token);
  } catch (error) {
    if (error.code !== -32800) output.appendLine(`${method}: ${error.message}`);
    return null;
  }
}

async function askList(method, params, token, convert) {
  return ((await ask(method, params, token)) || []).map(convert);
}

function providers() {
  const l = vscode.languages;
  const fromDiagnostic = (d) => ({ range: d.range, message: d.message, code: d.code, source: d.source, severity: d.severity + 1 });
  return [
    l.registerCompletionItemProvider(SELECTOR, {
      async provideCompletionItems(d, p, token) {
        const list = await ask("textDocument/completion", at(d, p), token);
        return list && new vscode.CompletionList(list.items.map(toCompletion), list.isIncomplete);
      },
    }, ".", "\"", "/", "(", ",", ":"),
    l.registerHoverProvider(SELECTOR, {
      async provideHover(d, p, token) {
        const hover = await ask("textDocument/hover", at(d, p), token);
        return hover && new vscode.Hover(toMarkdown(hover.contents), toRange(hover.range));
      },
    }),
    l.registerSignatureHelpProvider(SELECTOR, {
      async provideSignatureHelp(d, p, token) {
        const answer = await ask("textDocument/signatureHelp", at(d, p), token);
        if (!answer) return null;
        const help = new vscode.SignatureHelp();
        help.activeSignature = answer.activeSignature;
        help.activeParameter = answer.activeParameter;
        help.signatures = answer.signatures.map((s) => {
          const one = new vscode.SignatureInformation(s.label, toMarkdown(s.documentation));
          one.parameters = s.parameters.map((q) => new vscode.ParameterInformation(q.label, toMarkdown(q.documentation)));
          one.activeParameter = s.activeParameter;
          return one;
        });
        return help;
      },
    }, "(", ","),
    l.registerDefinitionProvider(SELECTOR, { provideDefinition: (d, p, token) => askList("textDocument/definition", at(d, p), token, toLocation) }),
    l.registerReferenceProvider(SELECTOR, {
      provideReferences: (d, p, context, token) => askList("textDocument/references", { ...at(d, p), context }, token, toLocation),
    }),
    l.registerDocumentHighlightProvider(SELECTOR, {
      provideDocumentHighlights: (d, p, token) => askList("textDocument/documentHighlight", at(d, p), token, (h) => new vscode.DocumentHighlight(toRange(h.range))),
    }),
    l.registerRenameProvider(SELECTOR, {
      async prepareRename(d, p, token) {
        const range = await ask("textDocument/prepareRename", at(d, p), token);
        if (!range) throw new Error("this name cannot be changed");
        return toRange(range);
      },
      // The reason of a refusal is shown by the editor.
      provideRenameEdits: async (d, p, newName, token) => toWorkspaceEdit(await client.request("textDocument/rename", { ...at(d, p), newName }, token)),
    }),
    l.registerDocumentSymbolProvider(SELECTOR, { provideDocumentSymbols: (d, token) => askList("textDocument/documentSymbol", of(d), token, toSymbol) }),
    l.registerWorkspaceSymbolProvider({
      provideWorkspaceSymbols: (query, token) =>
        askList("workspace/symbol", { query }, token, (s) => new vscode.SymbolInformation(s.name, s.kind - 1, "", toLocation(s.location))),
    }),
    l.registerFoldingRangeProvider(SELECTOR, {
      provideFoldingRanges: (d, _, token) =>
        askList("textDocument/foldingRange", of(d), token, (f) => new vscode.FoldingRange(f.startLine, f.endLine, { comment: 1, imports: 2 }[f.kind])),
    }),
    l.registerSelectionRangeProvider(SELECTOR, {
      provideSelectionRanges: (d, positions, token) => askList("textDocument/selectionRange", { ...of(d), positions }, token, toSelection),
    }),
    l.registerDocumentLinkProvider(SELECTOR, {
      provideDocumentLinks: (d, token) => askList("textDocument/documentLink", of(d), token, (k) => new vscode.DocumentLink(toRange(k.range), uriOf(k.target))),
    }),
    l.registerColorProvider(SELECTOR, {
      provideDocumentColors: (d, token) =>
        askList("textDocument/documentColor", of(d), token, (c) => {
          const { red, green, blue, alpha } = c.color;
          return new vscode.ColorInformation(toRange(c.range), new vscode.Color(red, green, blue, alpha));
        }),
      provideColorPresentations: (color, { document, range }, token) =>
        askList("textDocument/colorPresentation", { ...of(document), color, range }, token, (p) => {
          const one = new vscode.ColorPresentation(p.label);
          one.textEdit = toEdit(p.textEdit);
          return one;
        }),
    }),
    l.registerInlayHintsProvider(SELECTOR, {
      provideInlayHints: (d, range, token) =>
        askList("textDocument/inlayHint", { ...of(d), range }, token, (h) => {
          const hint = new vscode.InlayHint(toPosition(h.position), h.label, h.kind);
          hint.paddingRight = h.paddingRight;
          return hint;
        }),
    }),
    l.registerDocumentFormattingEditProvider(SELECTOR, {
      provideDocumentFormattingEdits: (d, options, token) => askList("textDocument/formatting", { ...of(d), options }, token, toEdit),
    }),
    l.registerDocumentRangeFormattingEditProvider(SELECTOR, {
      provideDocumentRangeFormattingEdits: (d, range, options, token) => askList("textDocument/rangeFormatting", { ...of(d), range, options }, token, toEdit),
    }),
    l.registerOnTypeFormattingEditProvider(SELECTOR, {
      provideOnTypeFormattingEdits: (d, p, ch, options, token) => askList("textDocument/onTypeFormatting", { ...at(d, p), ch, options }, token, toEdit),
    }, "}", "\n"),
    l.registerCodeActionsProvider(SELECTOR, {
      provideCodeActions: (d, range, context, token) =>
        askList("textDocument/codeAction", { ...of(d), range, context: { diagnostics: context.diagnostics.map(fromDiagnostic), only: context.only && [context.only.value] } }, token, toAction),
    }),
    l.registerCodeLensProvider(SELECTOR, {
      provideCodeLenses: (d, token) => askList("textDocument/codeLens", of(d), token, (k) => new vscode.CodeLens(toRange(k.range), k.command)),
    }),
    l.registerDocumentSemanticTokensProvider(SELECTOR, {
      async provideDocumentSemanticTokens(d, token) {
        const answer = await ask("textDocument/semanticTokens/full", of(d), token);
        return answer && new vscode.SemanticTokens(new Uint32Array(answer.data), answer.resultId);
      },
      async provideDocumentSemanticTokensEdits(d, previousResultId, token) {
        const answer = await ask("textDocument/semanticTokens/full/delta", { ...of(d), previousResultId }, token);
        if (!answer) return null;
        if (answer.data) return new vscode.SemanticTokens(new Uint32Array(answer.data), answer.resultId);
        const edits = answer.edits.map((e) => new vscode.SemanticTokensEdit(e.start, e.deleteCount, new Uint32Array(e.data)));
        return new vscode.SemanticTokensEdits(edits, answer.resultId);
      },
    }, legend),
  ];
}

// --- Documents ---

function didOpen(document) {
  if (!isOurs(document)) return;
  client.notify("textDocument/didOpen", { textDocument: { uri: document.uri.toString(), languageId: LANGUAGE, version: document.version, text: document.getText() } });
  findTests(document);
}

function didChange({ document, contentChanges }) {
  if (!isOurs(document) || !contentChanges.length) return;
  client.notify("textDocument/didChange", {
    textDocument: { uri: document.uri.toString(), version: document.version },
    contentChanges: contentChanges.map(({ range, text }) => ({ range, text })),
  });
}

function didSave(document) {
  if (!isOurs(document)) return;
  client.notify("textDocument/didSave", of(document));
  findTests(document);
}

function didClose(document) {
  if (isOurs(document)) client.notify("textDocument/didClose", of(document));
}

// --- Tests in the gutter ---

// A script with expectations is a test.
async function findTests(document) {
  if (document.uri.scheme !== "file") return;
  const lens = ((await ask("textDocument/codeLens", of(document))) || []).find((k) => k.command.command === "cag.runTest");
  const id = document.uri.toString();
  if (!lens) {
    tests.items.delete(id);
    return;
  }
  const item = tests.createTestItem(id, vscode.workspace.asRelativePath(document.uri), document.uri);
  item.range = toRange(lens.range);
  tests.items.add(item);
}

async function runTests(request) {
  const run = tests.createTestRun(request);
  const items = request.include || [];
  if (!request.include) tests.items.forEach((item) => items.push(item));
  for (const item of items) {
    run.started(item);
    const answer = await ask("workspace/executeCommand", { command: "cag.runTest", arguments: [item.id] });
    const text = answer ? answer.output : "the test could not be run";
    run.appendOutput(text.replace(/\n/g, "\r\n"), undefined, item);
    if (answer && answer.status === 0) run.passed(item);
    else run.failed(item, new vscode.TestMessage(text));
  }
  run.end();
}

// --- The life of the extension ---

// The file that the language server shows for a module of the library: where an import of it leads. Returns nothing if the server does not run.
async function libraryUri(module) {
  const uri = `untitled:${module}`;
  client.notify("textDocument/didOpen", { textDocument: { uri, languageId: LANGUAGE, version: 1, text: `import ${module}\n` } });
  const links = ask("textDocument/documentLink", { textDocument: { uri } });
  client.notify("textDocument/didClose", { textDocument: { uri } });
  const [link] = (await links) || [];
  return link && uriOf(link.target);
}

function commands() {
  // The command gets a URI, as a text from a lens, or is for the script that is edited.
  const register = (name, run) =>
    vscode.commands.registerCommand(name, async (uri) => {
      const editor = vscode.window.activeTextEditor, target = uri || (editor && isOurs(editor.document) && editor.document.uri);
      if (target) await run(uriOf(target.toString()));
    });
  const server = (command) => async (uri) => {
    const answer = await ask("workspace/executeCommand", { command, arguments: [uri.toString()] });
    if (answer && answer.output) output.append(answer.output);
  };
  return [
    register("cag.preview", (uri) => previews.show(uri)), register("cag.previewInBrowser", server("cag.preview")), register("cag.render", server("cag.render")),
    register("cag.runTest", server("cag.runTest")), vscode.commands.registerCommand("cag.restart", restart),
  ];
}

function settings() {
  const all = vscode.workspace.getConfiguration("cag");
  return { runOnSave: all.get("runOnSave"), inlayHints: all.get("inlayHints"), modulePath: all.get("modulePath") };
}

const HANDLERS = {
  log: (text) => output.append(text),
  "textDocument/publishDiagnostics": ({ uri, diagnostics: list }) => diagnostics.set(uriOf(uri), list.map(toDiagnostic)),
  "window/showMessage": ({ type, message }) => {
    if (type === 1) vscode.window.showErrorMessage(message);
    else vscode.window.showInformationMessage(message);
  },
  "window/showDocument": async ({ uri }) => {
    await vscode.commands.executeCommand("vscode.open", uriOf(uri));
    return { success: true };
  },
};

async function start() {
  const command = vscode.workspace.getConfiguration("cag").get("command");
  client = new Client(command, ["lsp"], HANDLERS, (reason) => output.appendLine(reason));
  const folders = (vscode.workspace.workspaceFolders || []).map((f) => ({ uri: f.uri.toString(), name: f.name }));
  let answer;
  try {
    answer = await client.request("initialize", {
      processId: process.pid,
      rootUri: folders.length ? folders[0].uri : null,
      workspaceFolders: folders,
      initializationOptions: settings(),
      capabilities: {
        general: { positionEncodings: ["utf-16"] },
        textDocument: {
          completion: { completionItem: { snippetSupport: true } },
          documentSymbol: { hierarchicalDocumentSymbolSupport: true },
          hover: { contentFormat: ["markdown"] },
        },
        window: { showDocument: { support: true } },
      },
    });
  } catch (error) {
    vscode.window.showErrorMessage(`cannot start \`${command} lsp\`: ${error.message}. The setting cag.command is the path of the program.`);
    return;
  }
  const { tokenTypes, tokenModifiers } = answer.capabilities.semanticTokensProvider.legend;
  legend = new vscode.SemanticTokensLegend(tokenTypes, tokenModifiers);
  client.notify("initialized", {});
  const w = vscode.workspace, watcher = w.createFileSystemWatcher("**/*.cag");
  const changed = (type) => (uri) => client.notify("workspace/didChangeWatchedFiles", { changes: [{ uri: uri.toString(), type }] });
  running.push(
    ...providers(), watcher, watcher.onDidCreate(changed(1)), watcher.onDidChange(changed(2)), watcher.onDidDelete(changed(3)),
    w.onDidOpenTextDocument(didOpen), w.onDidChangeTextDocument(didChange), w.onDidSaveTextDocument(didSave), w.onDidCloseTextDocument(didClose),
    w.onDidChangeConfiguration((e) => e.affectsConfiguration("cag") && client.notify("workspace/didChangeConfiguration", { settings: { cag: settings() } })),
    w.onDidChangeWorkspaceFolders(({ added, removed }) => {
      const list = (all) => all.map((f) => ({ uri: f.uri.toString(), name: f.name }));
      client.notify("workspace/didChangeWorkspaceFolders", { event: { added: list(added), removed: list(removed) } });
    }));
  w.textDocuments.forEach(didOpen);
}

async function stop() {
  running.splice(0).forEach((item) => item.dispose());
  diagnostics.clear();
  if (!client || !client.process) return;
  await ask("shutdown", null);
  client.notify("exit", null);
}

async function restart() {
  await stop();
  await start();
}

async function activate(context) {
  output = vscode.window.createOutputChannel("cag");
  diagnostics = vscode.languages.createDiagnosticCollection("cag");
  tests = vscode.tests.createTestController("cag", "cag");
  tests.createRunProfile("Run", vscode.TestRunProfileKind.Run, runTests, true);
  previews = new Previews(context.globalStorageUri, libraryUri);
  context.subscriptions.push(output, diagnostics, tests, previews, ...commands());
  await start();
}

module.exports = { activate, deactivate: stop };
