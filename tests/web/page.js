// Uses the page of `cag view` in headless Chromium as a person would: looks, clicks, drags, types, saves.
//   node page.js CHROMIUM COMMAND ...      COMMAND starts the server for the script whose path is added, and prints its address
// PLAYGROUND=1 uses a playground, whose files are kept in the browser (COMMAND is playground_server.js).
// Pictures are kept in the folder PICTURES, if it is set. The last line is `N passed, N failed, 0 skipped`.
"use strict";
const { spawn } = require("child_process");
const fs = require("fs");
const os = require("os");
const path = require("path");
const { Browser, pause } = require("./browser.js");
const { readPng, colorCount, difference } = require("./png.js");

const [chromium, ...command] = process.argv.slice(2);
const folder = fs.mkdtempSync(path.join(os.tmpdir(), "cag-page-"));

// Chromium draws without a graphics processor, and the machine may be busy.
const SIZE = { width: 1000, height: 640 };

const BLOCK = `// A block with a hole, and a ball.
param width = 40 in 10..100  "width of the block, mm"
param turned = 0deg in 0deg..90deg
param finish = "red"

block = box([width, 30, 20], centered: true) - cylinder(40, 5, centered: true)
print "volume {volume(block)}"

show block |> rotate(Z, turned) |> material({color: finish})
`;
const FILM = `show sphere(10) |> translate([100 * time, 0, 0])
show box([10, 10, 10])
`;
const DRAWING = `show polyline([[0, 0], [60, 0], [60, 30], [0, 30]], closed: true)
`;

// Starts a server for a script, and returns its address.
const servers = [];
function serve(name, text) {
  const file = path.join(folder, name);
  fs.writeFileSync(file, text);
  const server = spawn(command[0], [...command.slice(1), file], { stdio: ["ignore", "pipe", "inherit"] });
  servers.push(server);
  return new Promise((done, fail) => {
    let output = "";
    server.stdout.on("data", (data) => {
      output += data;
      const found = /http:\/\/\S+/.exec(output);
      if (found) done({ url: found[0], file });
    });
    server.on("exit", (status) => fail(new Error(`the server ended with status ${status}: ${output}`)));
  });
}

let passed = 0, failed = 0;
const only = process.env.ONLY ? new RegExp(process.env.ONLY) : null;
async function test(name, body) {
  if (only && !only.test(name)) return;
  const begin = Date.now();
  try {
    await body();
    passed++;
    console.log(`passed: ${name} (${((Date.now() - begin) / 1000).toFixed(1)} s)`);
  } catch (error) {
    failed++;
    console.log(`FAILED: ${name}\n  ${error.stack}`);
  }
}
function equal(found, expected) {
  if (JSON.stringify(found) !== JSON.stringify(expected)) throw new Error(`expected ${JSON.stringify(expected)}, found ${JSON.stringify(found)}`);
}
function check(truth, what) {
  if (!truth) throw new Error(what);
}

// A file as the server, or the playground, has it.
const inPlayground = Boolean(process.env.PLAYGROUND);
async function storedText(page, file) {
  if (!inPlayground) return fs.readFileSync(file, "utf8");
  const sets = /^(.*)\.params\.json$/.exec(path.basename(file));
  return (await page.value(`localStorage.getItem(${JSON.stringify(sets ? `cag:sets:${sets[1]}` : `cag:file:${path.basename(file)}`)})`)) ?? "";
}

const READY = 'document.documentElement.dataset.ready === "true" && document.documentElement.dataset.run';
const EDITOR = 'document.querySelector("#editor").shadowRoot.querySelector(".cm-content")';
const text = `[...${EDITOR}.querySelectorAll(".cm-line")].map((l) => l.textContent).join("\\n")`;
const fact = (name) => `[...document.querySelectorAll("#selection dt, #measure dt")].find((d) => d.textContent === ${JSON.stringify(name)})?.nextSibling.textContent`;
const button = (label) => `[...document.querySelectorAll("button")].find((b) => b.textContent === ${JSON.stringify(label)} && b.offsetParent)`;

// The script prints the volume of the block without the cylinder, which its mesh approximates.
const volume = (width) => `Math.abs(Number(/volume ([\\d.]+)/.exec(document.querySelector("#messages").textContent)?.[1]) / ${(width * 30 - Math.PI * 25) * 20} - 1) < 1e-3`;

// Two frames later, what was asked for is drawn.
const drawn = (page) => page.value("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(() => done(true)))))");
async function picture(page, name) {
  await drawn(page);
  return readPng(await page.screenshot(process.env.PICTURES ? path.join(process.env.PICTURES, `${name}.png`) : null));
}
async function middle(page) {
  const r = await page.box("#scene");
  return [r.x + r.width / 2, r.y + r.height / 2];
}
// The rest of the page is not the scene's.
async function sceneOf(page) {
  const r = await page.box("#scene");
  return { x: r.x + 8, y: r.y + 44, width: r.width - 16, height: r.height - 52 };
}
const press = (page, label) => page.value(`${button(label)}.click()`);

async function block(browser) {
  const { url, file } = await serve("block.cag", BLOCK);
  const page = await browser.open(url, SIZE);

  await test("the page shows the scene", async () => {
    await page.until(READY);
    const image = await picture(page, "first");
    check(colorCount(image, await sceneOf(page)) > 40, "the scene is blank");
    equal(await page.value("document.title"), "block.cag - cag");
    await page.until(volume(40));
  });
  await test("pointing at a part tells its name and size", async () => {
    await page.key("7");
    await drawn(page);
    const [x, y] = await middle(page);
    for (let i = 0; i < 40 && !(await page.value('document.querySelector(".tip:not([hidden])")?.textContent')); i++) {
      await page.mouse("mouseMoved", x + 30 + (i % 2), y + 4, { button: "none" });
      await pause(50);
    }
    equal(await page.value('document.querySelector(".tip").textContent'), "block · solid · 40 × 30 × 20 mm");
  });
  await test("a click selects the part, with its measures and its places in the script", async () => {
    const [x, y] = await middle(page);
    await page.click(x + 30, y + 4);
    await page.until('document.querySelector("#selection strong")?.textContent === "block"');
    equal(await page.value(fact("size")), "40 × 30 × 20 mm");
    await page.until('document.querySelectorAll(".chain li").length >= 2');
    const chain = await page.value('[...document.querySelectorAll(".chain .place")].map((p) => p.textContent)');
    check(chain[0].includes("shown") && chain[0].includes("block.cag:9"), `unexpected: ${chain[0]}`);
    await page.until(fact("volume"));
    const volume = await page.value(fact("volume"));
    check(Math.abs(parseFloat(volume) / ((40 * 30 - Math.PI * 25) * 20) - 1) < 1e-3, `the volume is ${volume}`);
    const image = await picture(page, "selected");
    check(colorCount(image, await sceneOf(page)) > 40, "the scene is blank");
  });
  await test("a place of the chain selects its text in the editor", async () => {
    await page.value('[...document.querySelectorAll(".chain .place")].at(-1).click()');
    await page.until(`${EDITOR}.querySelector(".cm-shown")?.textContent.includes("block") || ${EDITOR}.querySelector(".cm-shown")?.textContent.includes("box")`);
    equal(await page.value('document.activeElement === document.querySelector("#editor")'), true);
    await page.value("document.querySelector('#scene').focus()");
  });
  await test("a slider changes the scene", async () => {
    const run = await page.value("Number(document.documentElement.dataset.run)");
    await page.value('document.querySelector("[data-param=width] input[type=range]").focus()');
    await page.key("End");
    await page.until(`Number(document.documentElement.dataset.run) > ${run} && (${fact("size")}) === "100 × 30 × 20 mm"`);
    await page.until(volume(100));
  });
  await test("dragging a slider ends with its last value", async () => {
    const r = await page.box("[data-param=width] input[type=range]");
    await page.drag([r.x + r.width - 9, r.y + r.height / 2], [r.x + 60, r.y + r.height / 2], 4);
    const value = await page.value('document.querySelector("[data-param=width] input[type=range]").value');
    check(Number(value) < 60, `the slider is at ${value}`);
    await page.until(`(${fact("size")}) === "${value} × 30 × 20 mm"`);
  });
  await test("an angle has a slider in degrees", async () => {
    await page.value('document.querySelector("[data-param=turned] input[type=range]").focus()');
    const [x, y] = await page.value(`(${fact("size")}).split(" × ").map(Number)`);
    await page.key("End");
    await page.until(`(${fact("size")}).startsWith("${y} × ${x} × ")`);
    await page.value('document.querySelector("[data-param=turned] [aria-label^=Reset]").click()');
    await page.until(`(${fact("size")}).startsWith("${x} × ${y} × ")`);
  });
  await test("values are written into the script, and saved with Ctrl+S", async () => {
    const value = await page.value('document.querySelector("[data-param=width] input[type=range]").value');
    await press(page, "Write into script");
    await page.until(`(${text}).includes("param width = ${value} in 10..100")`);
    await page.key("s", { modifiers: 2 });
    for (let i = 0; i < 200 && !(await storedText(page, file)).includes(`param width = ${value} in`); i++) await pause(50);
    equal(await storedText(page, file), BLOCK.replace("width = 40", `width = ${value}`));
    await page.until('!document.querySelector("#tabs .dirty")');
  });
  await test("an error is shown at its place, and the last scene stays", async () => {
    await page.value(`${EDITOR}.focus()`);
    await page.key("End", { modifiers: 2 });
    await page.type("show sphere(raduis)");
    await page.until('document.documentElement.dataset.ok === "false"');
    await page.until('document.querySelector("#messages .diagnostic.error")?.textContent.includes("raduis")');
    await page.until(`${EDITOR}.querySelector(".cm-lintRange-error")?.textContent === "raduis"`);
    equal(await page.value('document.querySelector("#canvas").classList.contains("stale")'), true);
    check(colorCount(await picture(page, "error"), await sceneOf(page)) > 40, "the scene is blank");
    for (let i = 0; i < "raduis)".length; i++) await page.key("Backspace");
    await page.type("8)");
    await page.until('document.documentElement.dataset.ok === "true" && !document.querySelector("#canvas").classList.contains("stale")');
    await page.until('document.querySelectorAll("#parts li").length === 2');
  });
  await test("a line of the script highlights what it made", async () => {
    const before = await picture(page, "line-before");
    await page.key("ArrowUp");
    const after = await picture(page, "line");
    check(difference(before, after, await sceneOf(page)) > 0, "nothing is highlighted");
  });
  if (inPlayground) await test("the address follows the script, and another script in it takes its place", async () => {
    await page.until('location.hash.includes("code=")');
    await page.value(`location.hash = ${JSON.stringify(`name=block.cag&text=${encodeURIComponent(BLOCK.replace("A block", "The block"))}`)}`);
    await page.until(`${READY} && (${text}).startsWith("// The block") && !(${text}).includes("sphere")`);
    await page.until('document.querySelectorAll("#parts li").length === 1');
  });
  else await test("a file that changes on disk while the editor has unsaved text is asked about", async () => {
    const disk = fs.readFileSync(file, "utf8").replace("A block", "The block");
    fs.writeFileSync(file, disk);
    await page.key("s", { modifiers: 2 });
    await page.until('document.querySelector("dialog[open]")?.textContent.includes("changed on disk")');
    await press(page, "Compare");
    await page.until('document.querySelector(".compare .removed")?.textContent.includes("The block")');
    await press(page, "Take theirs");
    await page.until(`(${text}).startsWith("// The block") && !(${text}).includes("sphere")`);
    equal(fs.readFileSync(file, "utf8"), disk);
    await page.until('document.querySelectorAll("#parts li").length === 1');
  });
  await test("a section plane cuts the scene", async () => {
    await page.value("document.querySelector('#scene').focus()");
    await page.key("Escape");
    const before = await picture(page, "section-before");
    await page.key("x");
    await page.until('document.querySelector("[data-do=section]").getAttribute("aria-pressed") === "true"');
    const after = await picture(page, "section");
    check(difference(before, after, await sceneOf(page)) > 0.01, "nothing is cut");
    const r = await page.box(".handle"), offset = "Number(document.querySelector('#section input[type=number]').value)";
    equal(await page.value(offset), 0);
    await page.drag([r.x + r.width / 2, r.y + r.height / 2], [r.x + r.width / 2, r.y + r.height / 2 + 20]);
    check((await page.value(offset)) < 0, "the plane did not follow the handle");
    await page.value("document.querySelector('#scene').focus()");
    await page.key("x");
  });
  await test("a face, an edge, and a circle are measured", async () => {
    const width = await page.value(`Number(document.querySelector("[data-param=width] input[type=number]").value)`);
    await page.key("5"); // from above
    await page.key("o");
    await page.key("f");
    await page.key("m");
    await drawn(page);
    // Millimeters to pixels, by the scale.
    const pixel = await page.value('parseFloat(document.querySelector(".scale").textContent) / document.querySelector(".scale .bar").getBoundingClientRect().width');
    const [x, y] = await middle(page), at = (u, v) => [x + u / pixel, y - v / pixel];
    await page.click(...at(width / 2 - 3, 9));
    await page.until(`Math.abs(parseFloat(${fact("area")}) - ${width * 30 - Math.PI * 25}) < 1`);
    await press(page, "Clear");
    await page.click(...at(5, 0));
    await page.until(`Math.abs(parseFloat(${fact("radius")}) - 5) < 0.01`);
    await press(page, "Clear");
    await page.click(...at(width / 2, 15));
    await page.click(...at(-width / 2, 15));
    await page.until(`Math.abs(parseFloat(${fact("distance")}) - ${width}) < 0.01`);
    await picture(page, "measure");
    await page.key("Escape");
  });
  await test("parts are hidden, and shown again", async () => {
    await page.key("7");
    const before = await picture(page, "shown");
    await page.value('document.querySelector("#parts [aria-label^=Hide]").click()');
    check(difference(before, await picture(page, "hidden"), await sceneOf(page)) > 0.02, "the part is still there");
    await page.value("document.querySelector('#scene').focus()");
    await page.key("u");
    check(difference(before, await picture(page, "again"), await sceneOf(page)) < 0.001, "the part is not there");
  });
  await test("dragging turns the view, and the wheel zooms", async () => {
    const before = await picture(page, "view"), [x, y] = await middle(page);
    await page.drag([x, y], [x + 120, y + 40]);
    const turned = await picture(page, "turned");
    check(difference(before, turned, await sceneOf(page)) > 0.01, "the view did not turn");
    await page.say("Input.dispatchMouseEvent", { type: "mouseWheel", x, y, deltaX: 0, deltaY: -300 });
    await pause(100);
    check(difference(turned, await picture(page, "zoomed"), await sceneOf(page)) > 0.01, "the view did not zoom");
  });
  await test("a picture is rendered", async () => {
    await page.value('document.querySelector("#output").closest("details").open = true');
    await page.value('(() => { const [size, quality] = [...document.querySelectorAll("#output select")].filter((s) => /Size|Quality/.test(s.ariaLabel)); size.value = "640x360"; quality.value = "draft"; })()');
    await press(page, "Render");
    await page.until('(() => { const c = document.querySelector("#output canvas.picture"); return !c.hidden && c.width === 640 && c.height === 360; })()');
  });
  await test("a set of values is saved under a name, and chosen", async () => {
    const field = "document.querySelector('[data-param=width] input[type=number]')";
    const width = await page.value(`${field}.value`);
    await page.value(`(() => { ${field}.value = "64"; ${field}.dispatchEvent(new Event("change")); })()`);
    await page.value('document.querySelector("#params form input").focus()');
    await page.type("wide");
    await page.key("Enter");
    await page.until('document.querySelector("#params select[aria-label^=Named]").value === "wide"');
    const sets = JSON.parse(await storedText(page, `${file}.params.json`));
    equal([sets.wide.width, sets.wide.finish], [64, "red"]);
    await page.value('document.querySelector("[data-param=width] [aria-label^=Reset]").click()');
    await page.until(`${field}.value === "${width}"`);
    await page.value('(() => { const s = document.querySelector("#params select[aria-label^=Named]"); s.value = "wide"; s.dispatchEvent(new Event("change")); })()');
    await page.until(volume(64));
  });
  await test("the scene is exported, and the picture is saved", async () => {
    const downloads = path.join(folder, "downloads");
    fs.mkdirSync(downloads);
    await browser.say("Browser.setDownloadBehavior", { behavior: "allow", downloadPath: downloads });
    const saved = async (name) => {
      for (let i = 0; i < 600 && !fs.existsSync(path.join(downloads, name)); i++) await pause(50);
      return fs.readFileSync(path.join(downloads, name));
    };
    await page.value('document.querySelector("#output select[aria-label=Format]").value = "stl"');
    await press(page, "Export");
    const stl = await saved("block.stl");
    equal(stl.length, 84 + 50 * stl.readUInt32LE(80)); // a header, the number of triangles, and each triangle
    await press(page, "Save PNG");
    const png = readPng(await saved("block.png"));
    equal([png.width, png.height], await page.value('[document.querySelector("#scene").clientWidth, document.querySelector("#scene").clientHeight]'));
    check(colorCount(png, { x: 0, y: 0, width: png.width, height: png.height }) > 20, "the picture is blank");
  });
  if (!inPlayground) await test("another page sees the same", async () => {
    const other = await browser.open(new URL("/", url).href, { width: 500, height: 400 });
    await other.until(READY);
    equal(await other.value("document.querySelector('[data-param=width] input[type=number]').value"), "64");
    await page.value('document.querySelector("[data-param=width] [aria-label^=Reset]").click()');
    await other.until("document.querySelector('[data-param=width] input[type=number]').value !== '64'");
    await other.close();
  });
  await test("the page has no errors, and breaks no rule of its Content-Security-Policy", async () => {
    // The conflict of the file was made on purpose.
    equal(page.problems.filter((p) => !p.includes("412")), []);
  });
  await page.close();
}

async function film(browser) {
  const { url } = await serve("film.cag", FILM);
  const page = await browser.open(url, SIZE);
  await test("time plays, and a time that was seen is shown without another run", async () => {
    await page.until(READY);
    await page.until('!document.querySelector("#time").hidden');
    const before = await picture(page, "film-before");
    await page.value('document.querySelector("#time button").click()');
    await page.until('Number(document.querySelector("#time input").value) > 3');
    await page.value('document.querySelector("#time button").click()');
    check(difference(before, await picture(page, "film"), await sceneOf(page)) > 0, "nothing moved");
  });
  await test("the film has no errors", async () => equal(page.problems, []));
  await page.close();
}

async function small(browser) {
  const { url } = await serve("drawing.cag", DRAWING);
  const page = await browser.open(url, { width: 390, height: 844, dark: true, touch: true });
  await test("a drawing is seen from above, on a small screen in the dark", async () => {
    await page.until(READY);
    const image = await picture(page, "small"), scene = await sceneOf(page);
    equal(scene.width, 390 - 16);
    check(colorCount(image, scene) > 3, "the scene is blank");
    await page.clickOn('[data-tab="code"]');
    await page.until(`${EDITOR}.offsetParent !== null`);
    equal(page.problems, []);
  });
  await page.close();
}

async function main() {
  const browser = new Browser(chromium);
  try {
    await block(browser);
    await film(browser);
    await small(browser);
  } finally {
    await browser.close();
    for (const s of servers) s.kill();
    fs.rmSync(folder, { recursive: true, force: true });
  }
}
main().catch((error) => {
  failed++;
  console.log(`FAILED: ${error.stack}`);
}).finally(() => {
  console.log(`${passed} passed, ${failed} failed, 0 skipped`);
  process.exitCode = failed ? 1 : 0;
});
