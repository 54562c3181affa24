// What the language server does in the page's editor.
"use strict";
const fs = require("fs");
const path = require("path");
const { pause } = require("./browser.js");

const SCRIPT = `import "./tools.cag" as tools

/// The size of everything.
size = 2 + 3
body = box([size, size, tools.height])
show body
show cilinder(4, 1)
`;
const TOOLS = `height = 12 * 2
`;

const EDITS = Number(process.env.EDITS ?? 10000);

// Runs in the page: makes random edits, and replays them on a text. In the end, asks the page's language server and a new one about the text.
const randomEdits = async (edits, path) => {
  const { editor } = globalThis.cagPage, { view, language } = editor;
  const PIECES = ["(", ")", "[", "]", "{", "}", "\n", "  ", "\"", "a", "size", " = ", "box(", "é", "😀", "//", "1.5mm", ", ", "\n\n", "if ", "for i in 0..3: ", "show ", "`"];
  let seed = 20261127, replay = view.state.doc.toString();
  const random = (n) => {
    seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0;
    return Math.floor((seed / 2 ** 32) * n);
  };
  // Never cuts a pair of UTF-16 units, which is one character.
  const whole = (at) => (/[\uDC00-\uDFFF]/.test(replay[at] ?? "") ? at - 1 : at);
  for (let i = 0; i < edits; i++) {
    const from = whole(random(replay.length + 1)), to = whole(Math.min(replay.length, from + (replay.length > 400 ? random(12) : random(3)))), insert = PIECES[random(PIECES.length)];
    view.dispatch({ changes: { from, to: Math.max(from, to), insert } });
    replay = replay.slice(0, from) + insert + replay.slice(Math.max(from, to));
    if (i % 40 === 0) await new Promise((done) => setTimeout(done, 1));
  }
  const ask = { textDocument: { uri: language.uri(path) } };
  const symbols = await language.ask("textDocument/documentSymbol", ask);
  const body = (messages) => ({ method: "POST", body: JSON.stringify({ page: "fresh", messages }), headers: { "Content-Type": "application/json" } });
  const message = (method, params, id) => ({ jsonrpc: "2.0", method, params, ...(id ? { id } : {}) });
  const answers = await (await fetch("/api/lsp", body([
    message("initialize", { capabilities: { textDocument: { documentSymbol: {} } } }, 1),
    message("textDocument/didOpen", { textDocument: { uri: ask.textDocument.uri, languageId: "cag", version: 1, text: replay } }),
    message("textDocument/documentSymbol", ask, 2)]))).json();
  return { editor: editor.text(path), replay, known: language.known.get(path).text, symbols: JSON.stringify(symbols), fresh: JSON.stringify(answers.find((a) => a.id === 2).result) };
};

// `alone`: there is one file only.
exports.language = async ({ browser, serve, folder, test, equal, check, picture, EDITOR, text, SIZE, alone }) => {
  fs.writeFileSync(path.join(folder, "tools.cag"), TOOLS);
  const { url, file } = await serve("language.cag", alone ? SCRIPT.replace(/^import.*/, "tools = { height: 12 * 2 }") : SCRIPT);
  const page = await browser.open(url, SIZE);
  const ROOT = EDITOR.replace(/\.querySelector\("\.cm-content"\)$/, "");
  // Puts the cursor into a text, by the editor's own selection.
  const cursor = (before, after = "") => page.value(`(() => {
    const { view } = cagPage.editor, at = view.state.doc.toString().indexOf(${JSON.stringify(before + after)}) + ${before.length};
    view.dispatch({ selection: { anchor: at }, scrollIntoView: true });
    view.focus();
    return at;
  })()`);
  const values = `[...${EDITOR}.querySelectorAll(".cm-value")].map((v) => v.textContent)`;
  const at = (what) => page.value(`(() => { const { view } = cagPage.editor, c = view.coordsAtPos(view.state.doc.toString().indexOf(${JSON.stringify(what)}) + 1); return [c.left, (c.top + c.bottom) / 2]; })()`);

  await test("an unknown name is underlined, and a click on the fix changes it", async () => {
    await page.until('document.documentElement.dataset.ready === "true"');
    await page.until(`${EDITOR}.querySelector(".cm-lintRange-error")?.textContent === "cilinder"`);
    await page.until('document.querySelector("#messages .fix")?.textContent === "Change to `cylinder`"');
    await picture(page, "language-error");
    await page.value('document.querySelector("#messages .fix").click()');
    await page.until(`(${text}).includes("show cylinder(4, 1)") && document.documentElement.dataset.ok === "true"`);
    await page.until(`!${EDITOR}.querySelector(".cm-lintRange-error")`);
  });
  await test("values of definitions stand at the ends of their lines", async () => {
    await page.until(`(${values}).includes("5") && (${values}).includes("box, 5 x 5 x 24")`);
    const count = await page.value(`(${values}).length`);
    await picture(page, "language-values");
    await page.value("document.querySelector('#scene').focus()");
    await page.key("v");
    await page.until(`(${values}).length === 0`);
    await page.key("v");
    await page.until(`(${values}).length === ${count}`);
  });
  await test("names are completed, with their descriptions", async () => {
    await cursor("show body", "\n");
    await page.type(" |> transl");
    await page.until(`${ROOT}.querySelector(".cm-tooltip-autocomplete li[aria-selected=true]")?.textContent.startsWith("translate")`);
    await page.until(`${ROOT}.querySelector(".cm-completionInfo")?.textContent.length > 20`);
    await picture(page, "language-completion");
    await page.key("Enter");
    await page.until(`/show body \\|> translate\\b/.test(${text})`);
    for (let i = 0; i < 40 && !/show body\n/.test(await page.value(text)); i++) await page.key("z", { modifiers: 2 });
    equal(await page.value(`/show body\\n/.test(${text})`), true);
  });
  await test("members of a module are completed after a dot", async () => {
    await cursor("tools.height", "])");
    for (let i = 0; i < "height".length; i++) await page.key("Backspace");
    await page.until(`${ROOT}.querySelector(".cm-tooltip-autocomplete li")?.textContent.startsWith("height") || (${text}).includes("tools.]")`);
    await page.type("h");
    await page.until(`${ROOT}.querySelector(".cm-tooltip-autocomplete li[aria-selected=true]")?.textContent.startsWith("height")`);
    await pause(150); // at first, keys still belong to what was typed
    await page.key("Enter");
    await page.until(`(${text}).includes("tools.height])") && document.documentElement.dataset.ok === "true"`);
  });
  await test("pointing at a name describes it", async () => {
    const [x, y] = await at("size, size");
    await page.mouse("mouseMoved", x + 2, y, { button: "none" });
    await page.until(`${ROOT}.querySelector(".cm-described")?.textContent.includes("The size of everything.")`);
    await picture(page, "language-hover");
    await page.mouse("mouseMoved", x + 400, y + 200, { button: "none" });
  });
  await test("the signature of a call is shown while its arguments are written", async () => {
    await cursor("show cylinder(4, 1)");
    await page.key("Enter");
    await page.type("show cone(");
    await page.until(`${ROOT}.querySelector(".cm-signature")?.textContent.startsWith("cone(height")`);
    equal(await page.value(`${ROOT}.querySelector(".cm-signature strong").textContent.startsWith("height")`), true);
    await picture(page, "language-signature");
    await page.type("6, ");
    await page.until(`${ROOT}.querySelector(".cm-signature strong")?.textContent.startsWith("radius")`);
    await pause(150);
    await page.key("Escape");
    await page.until(`!${ROOT}.querySelector(".cm-signature")`);
    await page.type("2)");
    await page.until('document.documentElement.dataset.ok === "true"');
  });
  if (!alone) await test("a name is changed everywhere, also in other files, which are saved on their own", async () => {
    await cursor("tools.hei", "ght");
    await page.key("F2");
    await page.until('document.querySelector("dialog[open] input")?.value === "height"');
    await page.type("length");
    await page.key("Enter");
    await page.until(`(${text}).includes("tools.length])")`);
    await page.until(`[...document.querySelectorAll("#tabs [role=tab]")].map((t) => t.textContent).join() === "language.cag ●,tools.cag ●"`);
    // The run takes the unsaved texts of both files.
    await page.until(`document.documentElement.dataset.ok === "true" && (${values}).includes("box, 5 x 5 x 24")`);
    equal(fs.readFileSync(path.join(folder, "tools.cag"), "utf8"), TOOLS);
    equal(fs.readFileSync(file, "utf8"), SCRIPT);
  });
  if (!alone) await test("definitions are found in other files and in the library", async () => {
    await cursor("tools.len", "gth");
    await page.key("F12");
    await page.until('document.querySelector("#tabs [aria-selected=true]")?.textContent.startsWith("tools.cag")');
    equal(await page.value(text), TOOLS.replace("height", "length"));
    await page.value('[...document.querySelectorAll("#tabs [role=tab]")].find((t) => t.textContent.startsWith("language.cag")).click()');
    await cursor("import", ' "./tools');
    await page.key("Home");
    await page.type("import std.materials as mat\n");
    await cursor("std.mat", "erials");
    await page.key("F12");
    await page.until('document.querySelector("#tabs [aria-selected=true]")?.textContent.startsWith("std.materials")');
    check((await page.value(text)).length > 200, "the module is empty");
    equal(await page.value(`${EDITOR}.getAttribute("contenteditable")`), "false");
    await page.value('[...document.querySelectorAll("#tabs [role=tab]")].find((t) => t.textContent.startsWith("language.cag")).click()');
  });
  await test("the script is formatted, and expressions are extracted", async () => {
    await cursor("size = ", "2 + 3");
    await page.type("  ");
    await page.key("F", { modifiers: 9 });
    await page.until(`(${text}).includes("size = 2 + 3")`);
    await page.value(`(() => { const { view } = cagPage.editor, from = view.state.doc.toString().indexOf("2 + 3"); view.dispatch({ selection: { anchor: from, head: from + 5 } }); view.focus(); })()`);
    await page.key(".", { modifiers: 2 });
    const extract = '[...document.querySelectorAll("dialog[open] button")].find((b) => b.textContent === "Extract to a definition")';
    await page.until(extract);
    await picture(page, "language-actions");
    await page.value(`${extract}.click()`);
    await page.until(`(${text}).includes("value = 2 + 3") && (${text}).includes("size = value")`);
  });
  if (!alone) await test(`${EDITS} random edits leave the editor and the language server with the same text`, async () => {
    const heap = async () => {
      await page.say("HeapProfiler.collectGarbage");
      return (await page.say("Runtime.getHeapUsage")).usedSize;
    };
    const before = await heap(), original = await page.value("cagPage.editor.text(cagPage.editor.path)");
    const found = await page.value(`(${randomEdits})(${EDITS}, ${JSON.stringify(path.basename(file))})`);
    equal(found.editor, found.replay);
    equal(found.known, found.replay);
    equal(found.symbols, found.fresh);
    // What was broken is as before.
    await page.value(`cagPage.editor.open(cagPage.editor.path, ${JSON.stringify(original)})`);
    await page.until(`document.documentElement.dataset.ok === "true" && !${EDITOR}.querySelector(".cm-lintRange-error")`);
    const grown = (await heap()) - before;
    check(grown < 24 * 2 ** 20, `the page has ${(grown / 2 ** 20).toFixed(1)} MiB more`);
  });
  await test("the editor has no errors", async () => equal(page.problems, []));
  await page.close();
};
