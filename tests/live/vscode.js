// The extension of Visual Studio Code, packed as build/cag.vsix and unpacked, with a stand-in for the editor:
//   node tests/live/vscode.js EXTENSION PROGRAM FOLDER
// Prints `ok NAME` or `FAILED NAME: WHY` for each test.

const assert = require("assert");
const fs = require("fs");
const path = require("path");
const { standIn, until, check, failed, Position, Range, Uri } = require("./vscode_module.js");

const [extension, program, folder] = process.argv.slice(2);

const settings = { command: program, runOnSave: true, inlayHints: true, modulePath: [] };
const { vscode, given, events, messages, published, commands, items, Document } = standIn({ settings, folder });

async function main() {
  const { activate, deactivate } = require(path.join(extension, require(path.join(extension, "package.json")).main));
  await activate({ subscriptions: [], globalStorageUri: Uri.file(path.join(folder, "storage")) });
  const d = new Document("a.cag", "import std.materials as mat\nf(a, b) = a + b\nshow sphere(f(1, 2)) |> color(\"teal\")\nprint spher, mat.brass.color // expect: 3\n");
  const list = () => published.get(d.uri.toString());
  events.OpenTextDocument(d);
  await check("diagnostics", async () => {
    const found = await until(() => list() && list().length && list(), "diagnostics");
    assert.deepStrictEqual([found[0].code, found[0].severity, found[0].range.start.line, found[0].range.start.character], ["E0201", 0, 3, 6]);
  });
  await check("code actions", async () => {
    const range = list()[0].range;
    const actions = await given.CodeActions.provideCodeActions(d, range, { diagnostics: list() });
    const fix = actions.find((a) => a.title === "Change to `sphere`");
    assert.strictEqual(fix.edit.all.get(d.uri.toString())[0].newText, "sphere");
    assert.strictEqual(fix.diagnostics.length, 1);
  });
  await check("changes", async () => {
    d.replace("spher,", "f(1, 2),");
    await until(() => list().length === 0, "list without errors");
  });
  await check("completion", async () => {
    const all = await given.CompletionItem.provideCompletionItems(d, d.at("mat.brass", 4));
    assert(all.items.some((i) => i.label === "glazed"));
  });
  await check("hover", async () => assert((await given.Hover.provideHover(d, d.at("sphere("))).contents.value.includes("Returns a ball")));
  await check("signature help", async () => assert.strictEqual((await given.SignatureHelp.provideSignatureHelp(d, d.at("2)) |>"))).activeParameter, 1));
  await check("definition", async () => assert((await given.Definition.provideDefinition(d, d.at("brass")))[0].uri.fsPath.endsWith("std/materials.cag")));
  await check("references", async () => assert.strictEqual((await given.Reference.provideReferences(d, d.at("f(a"), { includeDeclaration: true })).length, 3));
  await check("highlights", async () => assert.strictEqual((await given.DocumentHighlight.provideDocumentHighlights(d, d.at("f(a"))).length, 3));
  await check("rename", async () => {
    await given.Rename.prepareRename(d, d.at("f(a"));
    const edit = await given.Rename.provideRenameEdits(d, d.at("f(a"), "g");
    assert.strictEqual(edit.all.get(d.uri.toString()).length, 3);
    await assert.rejects(given.Rename.provideRenameEdits(d, d.at("f(a"), "a b"), /is not a name/);
    await assert.rejects(given.Rename.prepareRename(d, d.at("sphere(")), /cannot be changed/);
  });
  await check("symbols", async () => {
    assert.deepStrictEqual((await given.DocumentSymbol.provideDocumentSymbols(d)).map((s) => s.name), ["f"]);
    assert.deepStrictEqual((await given.WorkspaceSymbol.provideWorkspaceSymbols("f")).map((s) => s.name), ["f"]);
  });
  await check("folding and selection", async () => {
    assert(Array.isArray(await given.FoldingRange.provideFoldingRanges(d)));
    assert.strictEqual((await given.SelectionRange.provideSelectionRanges(d, [d.at("f(a")])).length, 1);
  });
  await check("links and colors", async () => {
    assert.strictEqual((await given.DocumentLink.provideDocumentLinks(d)).length, 1);
    const [color] = await given.Color.provideDocumentColors(d);
    assert.strictEqual(Math.round(255 * color.color.green), 128);
    const [text] = await given.Color.provideColorPresentations({ red: 1, green: 0, blue: 0, alpha: 1 }, { document: d, range: color.range });
    assert.strictEqual(text.textEdit.newText, "\"#f00\"");
  });
  await check("hints", async () => {
    const hints = await given.InlayHints.provideInlayHints(d, new Range(new Position(0, 0), new Position(9, 0)));
    assert.deepStrictEqual(hints.map((h) => h.label), ["a:", "b:", "a:", "b:"]);
  });
  await check("formatting", async () => {
    assert.strictEqual((await given.DocumentFormattingEdit.provideDocumentFormattingEdits(d, {})).length, 1);
    assert.strictEqual((await given.DocumentRangeFormattingEdit.provideDocumentRangeFormattingEdits(d, new Range(new Position(1, 0), new Position(1, 1)), {})).length, 0);
    assert.strictEqual((await given.OnTypeFormattingEdit.provideOnTypeFormattingEdits(d, new Position(2, 0), "\n", {})).length, 0);
  });
  await check("words", async () => {
    const first = await given.DocumentSemanticTokens.provideDocumentSemanticTokens(d);
    assert(first.data.length > 50);
    d.replace("a + b", "a - b");
    const change = await given.DocumentSemanticTokens.provideDocumentSemanticTokensEdits(d, first.resultId);
    assert.deepStrictEqual(change.edits, []); // an operator has become another
  });
  await check("lenses, and a test in the gutter", async () => {
    assert.deepStrictEqual((await given.CodeLens.provideCodeLenses(d)).map((k) => k.command.title), ["Preview", "Render", "Run test"]);
    const test = new Document("t.cag", "print 1 + 1 // expect: 2\n");
    events.OpenTextDocument(test);
    const item = await until(() => items.get(test.uri.toString()), "test");
    await given.runTests({ include: [item] });
    assert.strictEqual(item.state, "passed");
  });
  await check("a run after a save", async () => {
    d.text = "assert 1 > 2\nshow sphere(1)\n";
    fs.writeFileSync(d.uri.fsPath, d.text);
    events.ChangeTextDocument({ document: Object.assign(d, { version: 50 }), contentChanges: [{ text: d.text }] });
    await until(() => list().length === 0, "list without errors");
    events.SaveTextDocument(d);
    await until(() => list().length === 1 && list()[0].source === "cag run", "error of the run");
  });
  await check("a restart", async () => {
    vscode.workspace.textDocuments = [d];
    published.clear();
    await commands["cag.restart"]();
    await until(() => list(), "diagnostics");
  });
  await check("the end", deactivate);
  assert.deepStrictEqual(messages, []);
}

main().then(() => process.exit(failed() ? 1 : 0), (error) => { console.log(`FAILED the test: ${error.stack}`); process.exit(1); });
