// The preview in a panel of Visual Studio Code, with a stand-in for the editor, a real server, and the page in Chromium if it is there:
//   node tests/live/vscode_preview.js EXTENSION PROGRAM FOLDER [CHROMIUM]
// Prints `ok NAME` or `FAILED NAME: WHY` for each test. Pictures are kept in the folder PICTURES, if it is set.
"use strict";
const assert = require("assert");
const fs = require("fs");
const path = require("path");
const { standIn, until, check, failed, Position, Range, Uri } = require("./vscode_module.js");

const [extension, program, folder, chromium] = process.argv.slice(2);
const settings = { command: program, runOnSave: false, inlayHints: false, modulePath: [] };
const editor = standIn({ settings, folder });
const { vscode, messages, commands, panels, edits, shown, Document, edit, moveCursor } = editor;

const SCRIPT = `// A block with a hole, and a ball.
param width = 40 in 10..100  "width of the block, mm"
param finish = "red"

block = box([width, 30, 20], centered: true) - cylinder(40, 5, centered: true)
ball = sphere(12) |> translate([0, 40, 0])
show block |> color(finish)
show ball
`;
const isAlive = (pid) => {
  try {
    return process.kill(pid, 0);
  } catch {
    return false;
  }
};
// The processes that the extension has started for a script.
const serversOf = (name) => fs.readdirSync("/proc").filter((pid) => /^\d+$/.test(pid)).filter((pid) => {
  try {
    const words = fs.readFileSync(`/proc/${pid}/cmdline`, "utf8").split("\0");
    return words.includes("view") && words.includes(fs.realpathSync(path.join(folder, name)));
  } catch {
    return false;
  }
}).map(Number);
const serverOf = async (name) => (await until(() => serversOf(name).length === 1 && serversOf(name), `one server of ${name}`))[0];

// A page that is only messages.
async function talk(panel, type, fields, id = Math.random()) {
  panel.say({ ...fields, type, id });
  const answer = await until(() => panel.sent.find((m) => m.type === "answer" && m.id === id), `answer to ${type}`);
  if (answer.error) throw new Error(answer.error);
  return answer.result;
}
const api = async (panel, asked, more = {}) => {
  const { status, bytes } = await talk(panel, "request", { path: asked, method: "GET", headers: {}, body: null, ...more });
  return { status, text: Buffer.from(bytes).toString() };
};
const eventsOf = (panel, name) => panel.sent.filter((m) => m.type === "event" && m.name === name).map((m) => JSON.parse(m.data));
const lastOf = (panel, type) => panel.sent.filter((m) => m.type === type).at(-1);

async function withoutBrowser() {
  const script = new Document("müll & co.cag", SCRIPT), other = new Document("other.cag", "show sphere(1)\n");
  const view = edit(script);
  await commands["cag.preview"](script.uri.toString());
  const [panel] = panels, pid = await serverOf("müll & co.cag");
  await check("a panel shows the page of a server", async () => {
    assert.deepStrictEqual(messages, []);
    assert.strictEqual(panel.column.viewColumn, vscode.ViewColumn.Beside);
    const { html, cspSource } = panel.webview;
    assert(html.includes(`content="default-src 'none'; script-src ${cspSource}; style-src ${cspSource}; img-src ${cspSource}"`));
    const names = [...html.matchAll(/(?:src|href)="https:\/\/resources\.test([^"]*)"/g)].map((m) => decodeURIComponent(m[1]));
    assert(names.length >= 3 && names.every((name) => fs.statSync(name).size > 0), names.join());
    assert(names.every((name) => name.startsWith(path.join(folder, "storage", "page-"))));
  });
  await check("the page's requests reach the server", async () => {
    const hello = JSON.parse((await api(panel, "/api/hello")).text);
    assert.strictEqual(hello.file, "müll & co.cag");
    assert.strictEqual((await api(panel, "/api/nothing")).status, 404);
    await assert.rejects(api(panel, "/page.js"), /cannot ask/);
  });
  await check("the events of the server reach the page", async () => {
    panel.say({ type: "listen" });
    await until(() => eventsOf(panel, "scene").length, "scene");
    assert.deepStrictEqual(lastOf(panel, "connection"), { type: "connection", on: true, problem: "" });
    assert.deepStrictEqual(eventsOf(panel, "scene")[0].parts.map((p) => p.name), ["block", "ball"]);
    const mesh = await talk(panel, "request", { path: `/api/mesh/${eventsOf(panel, "scene")[0].parts[0].mesh}`, method: "GET", headers: {}, body: null });
    assert.strictEqual(new DataView(mesh.bytes).getUint32(0, true), 0x6d676163);
  });
  await check("the page knows the texts and the cursor", async () => {
    moveCursor(view, new Position(4, 3));
    panel.say({ type: "ready" });
    const sent = panel.sent.filter((m) => m.type === "document").at(-1).document;
    assert.deepStrictEqual(sent, { path: "müll & co.cag", text: SCRIPT, dirty: false, version: 1 });
    assert.deepStrictEqual(lastOf(panel, "cursor"), { type: "cursor", path: "müll & co.cag", line: 5, column: 4 });
    script.replace("sphere(12)", "sphere(13)");
    assert.deepStrictEqual([lastOf(panel, "document").document.dirty, lastOf(panel, "document").document.version], [true, 2]);
    script.replace("sphere(13)", "sphere(12)");
  });
  await check("a change of the page is one step in the text", async () => {
    const [from, second] = [script.text.indexOf("40 in"), script.text.indexOf('"red"')], count = edits.length;
    const changes = [{ from, to: from + 2, old: "40", insert: "55" }, { from: second, to: second + 5, old: '"red"', insert: '"blue"' }];
    const files = [{ path: "müll & co.cag", version: script.version, changes }];
    const answer = await talk(panel, "edit", { files });
    assert.deepStrictEqual([answer.problem, edits.length, answer.documents[0].text], ["", count + 1, script.text]);
    assert(script.text.includes("width = 55 in") && script.text.includes('finish = "blue"'));
    const refused = await talk(panel, "edit", { files });
    assert(/meanwhile/.test(refused.problem) && edits.length === count + 1);
  });
  await check("a location is revealed in the text, counted in code points", async () => {
    script.type(`// 𝛑\n𝛑 = "𝛑𝛑" ; ${script.text}`);
    panel.say({ type: "reveal", place: { file: "müll & co.cag", line: 2, column: 5, endLine: 2, endColumn: 9 }, focus: true });
    await until(() => shown.length, "text that is shown");
    assert.deepStrictEqual(shown[0].selection, new Range(new Position(1, 5), new Position(1, 11)));
    assert.deepStrictEqual([shown[0].viewColumn, shown[0].preserveFocus], [1, false]);
    assert.deepStrictEqual(lastOf(panel, "cursor").column, 9);
  });
  await check("a location in the library is revealed as the language server shows it", async () => {
    panel.say({ type: "reveal", place: { file: "std.materials", line: 1, column: 1, endLine: 1, endColumn: 2 }, focus: true });
    await until(() => shown.length === 2, "text that is shown");
    assert(shown[1].path.endsWith("std/materials.cag"), shown[1].path);
    assert.deepStrictEqual(messages, []);
    edit(script);
  });
  await check("ranges and values are drawn into the text", () => {
    const [view] = vscode.window.visibleTextEditors, name = "müll & co.cag";
    panel.say({ type: "mark", path: name, range: [3, 5], scroll: true });
    panel.say({ type: "values", values: [{ file: name, endLine: 2, text: "3.14" }, { file: name, endLine: 900, text: "gone" }, { file: "other.cag", endLine: 1, text: "x" }] });
    const lists = [...view.decorations.values()];
    assert.deepStrictEqual(lists[0], [new Range(new Position(0, 3), new Position(0, 5))]);
    assert.deepStrictEqual(lists[1].map((d) => d.renderOptions.after.contentText), ["3.14"]);
  });
  await check("saving and downloads are the editor's", async () => {
    panel.say({ type: "save", path: "müll & co.cag" });
    await until(() => !script.isDirty && !lastOf(panel, "document").document.dirty, "saved text");
    panel.say({ type: "download", name: "../block.png", bytes: new Uint8Array([1, 2, 3]).buffer });
    await until(() => fs.existsSync(path.join(folder, "block.png")), "downloaded file");
    assert.deepStrictEqual([...fs.readFileSync(path.join(folder, "block.png"))], [1, 2, 3]);
  });
  await check("a script has one panel, and another script another", async () => {
    await commands["cag.preview"](script.uri.toString());
    await commands["cag.preview"](other.uri);
    assert.deepStrictEqual([panels.length, panels[0].reveals, panels[1].title], [2, 1, "Preview other.cag"]);
    const second = await serverOf("other.cag");
    panels[1].dispose();
    await until(() => !isAlive(second), "end of the other server");
    assert(isAlive(pid));
  });
  await check("a server that was killed is started again when the page asks", async () => {
    process.kill(pid, "SIGKILL");
    await until(() => lastOf(panel, "connection").on === false, "lost connection");
    assert(/was ended by the signal SIGKILL\.$/.test(lastOf(panel, "connection").problem) && lastOf(panel, "connection").ended);
    await assert.rejects(api(panel, "/api/hello"), /does not run/);
    panel.say({ type: "restart" });
    panel.say({ type: "restart" });
    await until(() => lastOf(panel, "connection").on, "connection");
    assert.notStrictEqual(await serverOf("müll & co.cag"), pid);
    assert.strictEqual((await api(panel, "/api/hello")).status, 200);
  });
  await check("the server ends with its panel", async () => {
    const last = await serverOf("müll & co.cag");
    panel.dispose();
    await until(() => !isAlive(last), "end of the server");
    assert.deepStrictEqual(messages, []);
  });
  await check("a program that is missing, old, or fails is reported", async () => {
    const old = path.join(folder, "old-cag");
    const tell = async (command, lines, expected) => {
      if (lines) fs.writeFileSync(old, `#!/bin/sh\n${lines}\n`, { mode: 0o755 });
      settings.command = command;
      await commands["cag.preview"](other.uri);
      assert.strictEqual(messages.length, 1);
      assert(expected.test(messages.pop()), expected.toString());
    };
    await tell(path.join(folder, "no-cag"), "", /^cannot start .*ENOENT.*cag\.command is the path/);
    await tell(old, "echo 'cag: unknown command `view`; run `cag --help` for a list' >&2; exit 2", /unknown command.*newer/);
    await tell(old, "echo 'cag: libmicrohttpd is missing' >&2; exit 1", /libmicrohttpd is missing\.$/);
    await tell(old, "exit 7", /ended with status 7\.$/);
    settings.command = program;
    await commands["cag.preview"](new Uri("untitled:Untitled-1"));
    assert(/Save the script first/.test(messages.pop()));
    assert.strictEqual(panels.length, 2);
  });
  await check("events are read from any chunks", () => {
    const { EventReader } = require(path.join(extension, "view_server.js"));
    const text = 'event: state\ndata: {"run":1}\n\nevent: scene\ndata: {"a":"b"}\n\n';
    for (let size = 1; size < text.length; size++) {
      const found = [], reader = new EventReader((name, data) => found.push(name, data));
      for (let i = 0; i < text.length; i += size) reader.read(text.slice(i, i + size));
      assert.deepStrictEqual(found, ["state", '{"run":1}', "scene", '{"a":"b"}']);
    }
  });
}

// --- The page itself ---

const READY = 'document.documentElement.dataset.ready === "true" && document.documentElement.dataset.run';
const run = "Number(document.documentElement.dataset.run)";
const width = 'cagPage.view.message.parts.find((p) => p.name === "block").bounds';
const button = (label) => `[...document.querySelectorAll("button")].find((b) => b.textContent === ${JSON.stringify(label)} && b.offsetParent)`;

async function withBrowser() {
  const { Browser } = require("../web/browser.js");
  const { PanelHost } = require("./vscode_panel.js");
  const { readPng, colorCount } = require("../web/png.js");
  const browser = new Browser(chromium), host = await PanelHost.start(browser, path.join(folder, "storage"));
  const create = vscode.window.createWebviewPanel;
  vscode.window.createWebviewPanel = (...options) => {
    const panel = create(...options);
    host.prepare(panel);
    return panel;
  };
  const script = new Document("block.cag", SCRIPT), view = edit(script);
  await commands["cag.preview"](script.uri);
  const panel = panels.at(-1), page = await host.show(panel, { width: 1000, height: 700 });
  const picture = async (name) => {
    await page.value("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(() => done(true)))))");
    return readPng(await page.screenshot(process.env.PICTURES ? path.join(process.env.PICTURES, `${name}.png`) : null));
  };

  await check("the scene appears in the panel, without an editor", async () => {
    await page.until(READY);
    const box = await page.box("#scene");
    assert(colorCount(await picture("panel-dark"), { x: box.x + 8, y: box.y + 44, width: box.width - 16, height: box.height - 52 }) > 40, "the scene is blank");
    assert.strictEqual(await page.value('document.querySelector("#code").offsetParent === null && document.querySelector("#toggle-editor").hidden'), true);
    assert.strictEqual(await page.value("getComputedStyle(document.body).padding"), "0px");
    await page.setTheme("light");
    assert.strictEqual(await page.value("getComputedStyle(document.body).colorScheme"), "light");
    await picture("panel-light");
    await page.setTheme("dark");
    assert.strictEqual(await page.value('document.querySelector("#code").offsetParent'), null);
  });
  await check("a click on a location reveals it in the text", async () => {
    shown.length = 0;
    await page.value('[...document.querySelectorAll("#parts button")].find((b) => b.textContent.includes("block")).click()');
    await page.until('document.querySelectorAll(".chain li").length >= 2');
    await page.value('[...document.querySelectorAll(".chain .place")].at(-1).click()');
    await until(() => shown.length, "text that is shown");
    assert.strictEqual(shown[0].path, script.uri.fsPath);
    assert.strictEqual(script.getText(shown[0].selection), "box([width, 30, 20], centered: true) - cylinder(40, 5, centered: true)");
    await picture("panel-selected");
  });
  await check("what the line of the cursor made is highlighted", async () => {
    moveCursor(view, script.at("ball ="));
    await page.until('cagPage.view.pointed.join() === "ball"');
    await picture("panel-cursor");
    moveCursor(view, script.at("show block"));
    await page.until('cagPage.view.pointed.join() === "block"');
    moveCursor(view, new Position(0, 0));
    await page.until('cagPage.view.pointed.join() === ""');
  });
  await check("a text that is not saved is run", async () => {
    script.replace("width = 40 in", "width = 60 in");
    await page.until(`${width}[1][0] === 30`);
    assert.strictEqual(fs.readFileSync(script.uri.fsPath, "utf8"), SCRIPT);
    const before = await page.value(run);
    await script.save();
    await page.until(`${run} > ${before} && ${width}[1][0] === 30`);
  });
  await check("the values of params are written into the text as one step", async () => {
    const count = edits.length;
    await page.value('document.querySelector("[data-param=width] input[type=range]").focus()');
    await page.key("End");
    await page.until(`${width}[1][0] === 50`);
    await page.value(`[...document.querySelectorAll("#params button")].find((b) => /script/i.test(b.textContent + b.title + b.ariaLabel)).click()`);
    await until(() => edits.length > count, "change of the text");
    assert.strictEqual(edits.length, count + 1);
    assert(script.text.includes("param width = 100 in"), script.text);
    assert(script.isDirty);
    await page.until(`${width}[1][0] === 50`);
  });
  await check("an error of a run leads to the text, and the last scene stays", async () => {
    shown.length = 0;
    script.replace("show ball", "show bal");
    await page.until('document.querySelector(".diagnostic.error .place")');
    assert.strictEqual(await page.value('document.querySelector("#canvas").classList.contains("stale")'), true);
    await page.value('document.querySelector(".diagnostic.error .place").click()');
    await until(() => shown.length, "text that is shown");
    assert.strictEqual(script.getText(shown[0].selection), "bal");
    await picture("panel-error");
    script.replace("show bal\n", "show ball\n");
    await page.until('!document.querySelector("#canvas").classList.contains("stale")');
  });
  await check("pictures are saved by the editor", async () => {
    await page.value(`document.querySelector("#output").closest("details").open = true; ${button("Save PNG")}.click()`);
    const file = path.join(folder, "block.png");
    fs.rmSync(file, { force: true });
    await until(() => fs.existsSync(file) && fs.readFileSync(file).subarray(1, 4).toString() === "PNG", "picture");
  });
  await check("after the server was killed, a button starts it again, with what is not saved", async () => {
    const pid = await serverOf("block.cag");
    process.kill(pid, "SIGKILL");
    await page.until(button("Start it again"));
    await picture("panel-lost");
    script.replace("param width = 100 in", "param width = 80 in");
    await page.value(`${button("Start it again")}.click()`);
    await page.until(`!(${button("Start it again")}) && ${width}[1][0] === 40`);
    assert.notStrictEqual(await serverOf("block.cag"), pid);
  });
  await check("a narrow panel shows the scene too", async () => {
    await page.say("Emulation.setDeviceMetricsOverride", { width: 520, height: 760, deviceScaleFactor: 1, mobile: false });
    const box = await page.box("#scene");
    assert(colorCount(await picture("panel-narrow"), { x: box.x + 8, y: box.y + 44, width: box.width - 16, height: box.height - 52 }) > 40, "the scene is blank");
  });
  await check("the page needs no exception of its policy", () => assert.deepStrictEqual(page.problems, []));
  await check("the server ends with the panel in the browser", async () => {
    const pid = await serverOf("block.cag");
    panel.dispose();
    await until(() => !isAlive(pid), "end of the server");
    assert.deepStrictEqual(messages, []);
  });
  host.close();
  await browser.close();
}

async function main() {
  const { activate, deactivate } = require(path.join(extension, "extension.js"));
  await activate({ subscriptions: [], globalStorageUri: Uri.file(path.join(folder, "storage")) });
  await withoutBrowser();
  if (chromium) await withBrowser();
  await deactivate();
}

main().then(() => process.exit(failed() ? 1 : 0), (error) => { console.log(`FAILED the test: ${error.stack}`); process.exit(1); });
