// Uses the page of `cag view` in headless Chromium as a person would: looks, clicks, drags, types, saves.
//   node page.js CHROMIUM COMMAND ...      COMMAND starts the server for the script whose path is added, and prints its address
// PLAYGROUND=1 uses a playground, whose files are kept in the browser (COMMAND is playground_server.js).
// Pictures are kept in the folder PICTURES, if it is set. The last line is `N passed, N failed, 0 skipped`.
"use strict";
const { spawn } = require("child_process");
const fs = require("fs");
const net = require("net");
const os = require("os");
const path = require("path");
const { Browser, pause } = require("./browser.js");
const { language } = require("./page_language.js");
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
show label([60, 30], "P_1", mark: "circle", size: 6), label([30, 0], "side", place: "below", size: 6)
`;

const ARM = `arm = robot([
  revolute(alpha: -90deg), revolute(d: 149.5, a: 432), revolute(alpha: 90deg),
  revolute(d: 432, alpha: -90deg), revolute(alpha: 90deg), revolute(d: 56.5)
], name: "arm")
show arm |> posed([
  35deg, -60deg, 100deg,  // shoulder and elbow
  0.5rad, -40deg, 110deg
])
`;
const TEN = `show robot([for i in 0..9: revolute(a: 100, alpha: if i % 2 == 0 then 90deg else -90deg, shape: box([90, 20, 20]))], name: "ten")
  |> posed([for i in 0..9: if i % 4 < 2 then 25deg else -25deg])
`;
const POINTS = `// Points that can be dragged.
param height = 30 in 10..60  "height of the mast, mm"

outline = [
  [0, 0], [40mm, 0], // the front
  [4cm, -2.5e1], [0, 20],
]
plate = polyline(outline, closed: true)
rail = bspline([[0, 0, 40], [20, 0, 60], [40, 0, 40], [60, 10, 50]])
patch = bezier_surface([[[0, 40, 0], [30, 40, 5]], [[0, 70, 0], [30, 70, 12.5]]])
ball = sphere(4) |> translate([70, 0, 10])
mast = polyline([[50, 50, 0], [50, 50, height], [50 + cos(60deg), 60, 0]])
show plate, rail, patch, ball, mast
`;

// Starts a server for a script, or without one if the name is "", and returns its address and its process.
const servers = [];
function serve(name, text, ...options) {
  const file = name && path.join(folder, name);
  if (file) fs.writeFileSync(file, text);
  const env = { ...process.env, XDG_STATE_HOME: path.join(folder, "state") };
  const server = spawn(command[0], [...command.slice(1), ...(file ? [file] : []), ...options], { stdio: ["ignore", "pipe", "inherit"], env });
  servers.push(server);
  return new Promise((done, fail) => {
    let output = "";
    server.stdout.on("data", (data) => {
      output += data;
      const found = /http:\/\/\S+/.exec(output);
      if (found) done({ url: found[0], file, server });
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
const text = "cagPage.editor.text(cagPage.editor.path)";
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
    const tip = () => page.value('document.querySelector(".tip:not([hidden])")?.textContent ?? ""');
    // What the face comes from is asked for when it is pointed at.
    for (let i = 0; i < 100 && !(await tip()).includes("from"); i++) {
      await page.mouse("mouseMoved", x + 30 + (i % 2), y + 4, { button: "none" });
      await pause(50);
    }
    equal(await tip(), "block · solid · 40 × 30 × 20 mm · from box([width, 30, 20], centered: true)");
  });
  await test("a click selects the part, with its measures and its places in the script", async () => {
    const [x, y] = await middle(page);
    await page.click(x + 30, y + 4);
    await page.until('document.querySelector("#selection strong")?.textContent === "block"');
    equal(await page.value(fact("size")), "40 × 30 × 20 mm");
    await page.until('document.querySelectorAll(".chain li").length >= 2');
    const chain = await page.value('[...document.querySelectorAll(".chain[aria-label=\'Places in the script\'] .place")].map((p) => p.textContent)');
    check(chain[0].includes("shown") && chain[0].includes("block.cag:9"), `unexpected: ${chain[0]}`);
    await page.until(fact("volume"));
    const volume = await page.value(fact("volume"));
    check(Math.abs(parseFloat(volume) / ((40 * 30 - Math.PI * 25) * 20) - 1) < 1e-3, `the volume is ${volume}`);
    const image = await picture(page, "selected");
    check(colorCount(image, await sceneOf(page)) > 40, "the scene is blank");
  });
  await test("a click on a face tells which operand it comes from", async () => {
    const face = '[...document.querySelectorAll(".chain[aria-label=\'Places of the face\'] .place")].map((p) => p.textContent)';
    await page.until(`(${face}).length === 1`);
    equal(await page.value(face), ["madeblock.cag:6box([width, 30, 20], centered: true)"]);
    // The hole is seen from above.
    await page.key("5");
    await page.key("f");
    await drawn(page);
    const at = await page.value(`(() => {
      const { view } = cagPage, found = [];
      for (let y = 0; y < view.height; y += 3)
        for (let x = 0; x < view.width; x += 3) {
          const hit = view.pick(x, y);
          if (hit && Math.hypot(hit.point.x, hit.point.y) < 5.01 && Math.abs(hit.point.z) < 9) found.push([x, y]);
        }
      return found[Math.floor(found.length / 2)] ?? null;
    })()`);
    check(at, "the hole is not seen");
    const r = await page.box("#scene");
    await page.click(r.x + at[0], r.y + at[1]);
    await page.until(`(${face})[0]?.includes("cylinder(40, 5, centered: true)")`);
    check(colorCount(await picture(page, "face"), await sceneOf(page)) > 40, "the scene is blank");
    await page.key("7");
  });
  await test("the shape of an expression that is not shown appears as a ghost", async () => {
    const before = await picture(page, "ghost-before"), note = 'document.querySelector(".ghost-note:not([hidden])")?.textContent ?? ""';
    const place = (line, column) => page.value(`cagPage.editor.select(${JSON.stringify({ file: "block.cag", line, column, endLine: line, endColumn: column })})`);
    await place(6, 50);
    await page.until(`(${note}) === "cylinder(40, 5, centered: true)"`);
    check(difference(before, await picture(page, "ghost"), await sceneOf(page)) > 0.003, "the ghost is not seen");
    await place(9, 8);
    await page.until(`(${note}) === ""`); // a turn by 0deg leaves it as it is shown
    await page.value("document.querySelector('#scene').focus()");
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
    // The exact curves: a rectangle with a hole.
    const width = await page.value(`Number(document.querySelector("[data-param=width] input[type=number]").value)`);
    const cut = (name) => `[...document.querySelectorAll("#section dt")].find((d) => d.textContent === ${JSON.stringify(name)})?.nextSibling.textContent`;
    await page.until(cut("length"));
    equal(await page.value(cut("curves")), "2");
    const length = 2 * (width + 30) + 10 * Math.PI, area = width * 30 - 25 * Math.PI;
    check(Math.abs(parseFloat(await page.value(cut("length"))) / length - 1) < 1e-6, "the length is wrong");
    check(Math.abs(parseFloat(await page.value(cut("area"))) / area - 1) < 1e-6, "the area is wrong");
    check(await page.value(`document.querySelector("#section .section-curves button").title`).then((t) => /^Copy section\(block, plane\(\[0, 0, -?[\d.]+\], Z\)\)$/.test(t)), "no expression");
    await picture(page, "section-curves");
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
  await test("curvature, distance, and lines of surfaces are shown with their numbers", async () => {
    await page.value("document.querySelector('#scene').focus()");
    await page.key("Escape");
    await page.key("7");
    const choose = (kind) => page.value(`(() => { const s = document.querySelector("#surfaces select"); s.closest("details").open = true; s.value = ${JSON.stringify(kind)}; s.dispatchEvent(new Event("change")); })()`);
    const legend = 'document.querySelector("#surfaces .legend:not([hidden])")?.getAttribute("aria-label") ?? ""', seen = "document.querySelector('#surfaces').textContent";
    const before = await picture(page, "surfaces-before");
    await choose("mean"); // -1/10 in the hole, 0 elsewhere
    await page.until(`(${legend}) === "Colors from -0.1 to 0 1/mm"`);
    check(difference(before, await picture(page, "mean"), await sceneOf(page)) > 0.02, "no colors");
    await choose("deviation");
    await page.until(`/The mesh is at most 0\\.0\\d+ mm from the surface/.test(${seen})`);
    await choose("zebra");
    check(difference(before, await picture(page, "zebra"), await sceneOf(page)) > 0.02, "no stripes");
    await choose("net");
    await page.until(`(${seen}).includes("block is a set operation")`);
    await choose("");
    check(difference(before, await picture(page, "surfaces-after"), await sceneOf(page)) < 0.001, "something stays");
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

async function points(browser) {
  const { url, file } = await serve("points.cag", POINTS);
  const page = await browser.open(url, { width: 1200, height: 760 });
  const handles = '[...document.querySelectorAll(".handle.point:not([hidden])")]';
  const settled = "!document.querySelector('#status').classList.contains('busy')";
  const place = (i) => page.value(`(() => { const r = ${handles}[${i}].getBoundingClientRect(); return [r.x + r.width / 2, r.y + r.height / 2]; })()`);
  const chosen = async (part, count) => {
    await page.value(`[...document.querySelectorAll("#parts .part")].find((b) => b.textContent.startsWith("${part}")).click()`);
    await page.value("document.querySelector('#scene').focus()");
    await page.until(`${handles}.length === ${count}`);
    await drawn(page);
  };
  // Drags a point, and waits for the scene that shows the result. Returns by how many pixels the handle misses the pointer then.
  const drag = async (i, dx, dy) => {
    const run = await page.value("Number(document.documentElement.dataset.run)"), from = await place(i), to = [from[0] + dx, from[1] + dy];
    await page.drag(from, to, 6);
    await page.until(`Number(document.documentElement.dataset.run) > ${run} && ${settled}`);
    await page.until(`!document.querySelector(".handle.dragged")`);
    await drawn(page);
    const at = await place(i);
    return Math.hypot(at[0] - to[0], at[1] - to[1]);
  };
  const undo = async (expected) => {
    await page.key("z", { modifiers: 2 });
    await page.until(`(${text}) === ${JSON.stringify(expected)}`);
    await page.value("document.querySelector('#scene').focus()");
    await page.until(settled);
    await pause(400);
    await page.until(settled);
  };
  const written = async (pattern) => {
    const now = await page.value(text), found = pattern.exec(now);
    check(found, `expected ${pattern}, found\n${now}`);
    return found.slice(1);
  };
  const whole = POINTS.replace(/\n$/, "\n");

  await test("the points of a selected part are handles", async () => {
    await page.until(READY);
    await page.key("d");
    await page.until('document.querySelector("[data-do=points]").getAttribute("aria-pressed") === "true"');
    await chosen("plate", 4);
    check((await page.value('document.querySelector("#selection").textContent')).includes("4 points shown."), "the panel does not tell the number of points");
    await picture(page, "points");
  });
  await test("dragging a vertex changes its numbers, which keep their units, and is one step to undo", async () => {
    await page.key("5"); // from above
    await page.key("f");
    await drawn(page);
    const off = await drag(2, 30, 25);
    check(off < 1.5, `the handle is ${off} pixels from the pointer`);
    const [x, y] = await written(/^ {2}\[([-\d.]+)cm, (-?[\d.]+)\], \[0, 20\],$/m);
    check(Number(x) > 4 && Number(y) < -25, `x = ${x}, y = ${y}`);
    check(/^\d+\.\d{1,3}$/.test(x) && /^-\d+(\.\d{1,2})?$/.test(y), `${x} and ${y} are not round`);
    equal(await page.value(text), whole.replace("[4cm, -2.5e1]", `[${x}cm, ${y}]`));
    await picture(page, "points-dragged");
    await undo(whole);
  });
  await test("two drags are two steps to undo", async () => {
    await drag(1, -20, 0);
    const one = await page.value(text);
    await drag(0, 0, 20);
    check((await page.value(text)) !== one, "the second drag changed nothing");
    await undo(one);
    await undo(whole);
    // In the editor, too.
    await page.key("z", { modifiers: 2 + 8 });
    await page.until(`(${text}) === ${JSON.stringify(one)}`);
    await page.value(`${EDITOR}.focus()`);
    await undo(whole);
  });
  await test("Escape takes a drag back", async () => {
    const [x, y] = await place(2);
    await page.mouse("mouseMoved", x, y, { button: "none" });
    await page.mouse("mousePressed", x, y);
    for (let i = 1; i < 5; i++) await page.mouse("mouseMoved", x + 10 * i, y, { buttons: 1 });
    await page.until(`(${text}) !== ${JSON.stringify(whole)}`);
    await page.key("Escape");
    await page.until(`(${text}) === ${JSON.stringify(whole)}`);
    await page.mouse("mouseReleased", x + 50, y);
    equal(await page.value("document.querySelector('#parts li.selected')?.textContent.startsWith('plate')"), true);
    equal(await page.value(text), whole);
    await page.until(settled);
  });
  await test("arrow keys move the handle that has the focus", async () => {
    const before = await place(1), run = await page.value("Number(document.documentElement.dataset.run)");
    await page.value(`${handles}[1].focus()`);
    await page.key("ArrowRight");
    await page.until(`Number(document.documentElement.dataset.run) > ${run} && ${settled}`);
    await drawn(page);
    const after = await place(1);
    check(Math.abs(after[0] - before[0] - 4) < 1 && Math.abs(after[1] - before[1]) < 1, `moved by ${after[0] - before[0]}, ${after[1] - before[1]}`);
    equal(await page.value(`document.activeElement === ${handles}[1]`), true);
    await written(/\[[\d.]+mm, 0\]/);
    await undo(whole);
  });
  await test("a point in space moves parallel to the screen", async () => {
    await page.key("7");
    await chosen("rail", 4);
    await page.key("f");
    await drawn(page);
    const off = await drag(1, 40, -30);
    check(off < 1.5, `the handle is ${off} pixels from the pointer`);
    const [x, y, z] = (await written(/\[0, 0, 40\], \[([-\d.]+), ([-\d.]+), ([-\d.]+)\], \[40, 0, 40\]/)).map(Number);
    const moved = [x - 20, y, z - 60], view = [1 / Math.sqrt(3), -1 / Math.sqrt(3), 1 / Math.sqrt(3)];
    const size = Math.hypot(...moved), depth = moved.reduce((sum, m, i) => sum + m * view[i], 0);
    check(size > 3 && Math.abs(depth) < 0.03 * size, `moved by ${moved}`);
    await picture(page, "points-rail");
    await undo(whole);
  });
  await test("a point of a net", async () => {
    await chosen("patch", 4);
    const off = await drag(3, 5, -35);
    check(off < 1.5, `the handle is ${off} pixels from the pointer`);
    const [z] = await written(/\[\[0, 70, 0\], \[[-\d.]+, [-\d.]+, ([-\d.]+)\]\]\]\)/);
    check(Number(z) > 13, `z = ${z}`);
    await undo(whole);
  });
  await test("the vector of a translation", async () => {
    await chosen("ball", 1);
    await page.key("f");
    await drawn(page);
    const off = await drag(0, -30, 10);
    check(off < 1.5, `the handle is ${off} pixels from the pointer`);
    const [x] = await written(/translate\(\[([-\d.]+), [-\d.]+, [-\d.]+\]\)/);
    check(Number(x) < 70, `x = ${x}`);
    await undo(whole);
  });
  await test("a computed point moves the param that it depends on, which is marked before", async () => {
    await page.key("1"); // from the front
    await chosen("mast", 3);
    await page.key("f");
    await drawn(page);
    equal(await page.value(`${handles}.map((b) => b.classList.contains("locked"))`), [false, false, false]);
    const from = await place(1);
    await page.mouse("mouseMoved", from[0], from[1], { button: "none" });
    await page.until('document.querySelector("[data-param=height]").classList.contains("marked")');
    await picture(page, "points-computed");
    const off = await drag(1, 0, -40);
    check(off < 2, `the handle is ${off} pixels from the pointer`);
    const value = Number(await page.value('document.querySelector("[data-param=height] input[type=number]").value'));
    check(value > 32 && value <= 60, `height = ${value}`);
    await page.until(`Math.abs(Number((${fact("size")})?.split(" × ")[2]?.replace(" mm", "")) - ${value}) < 0.01`);
    await page.value('document.querySelector("[data-param=height] [aria-label^=Reset]").click()');
    await page.until(settled);
  });
  await test("what cannot be moved is locked, with the reason", async () => {
    await page.value(`${EDITOR}.focus()`);
    await page.key("End", { modifiers: 2 });
    await page.type("show line([cos(0deg), 0], [9 + 9, 9 * 2]) |> named(\"fixed\")");
    await page.until('[...document.querySelectorAll("#parts .part")].some((b) => b.textContent.startsWith("fixed"))');
    await chosen("fixed", 2);
    const [first, second] = await page.value(`${handles}.map((b) => [b.classList.contains("locked"), b.title])`);
    equal(first[0], false); // its y is a number
    equal(second[0], true);
    check(second[1].includes("`[9 + 9, 9 * 2]`"), second[1]);
    const before = await page.value(text), from = await place(1);
    await page.drag(from, [from[0] + 20, from[1]]);
    equal(await page.value(text), before);
  });
  await test("turning the switch off removes the handles and leaves the file unchanged", async () => {
    await page.value("document.querySelector('#scene').focus()");
    await page.key("d");
    await page.until(`${handles}.length === 0`);
    equal(fs.readFileSync(file, "utf8"), POINTS);
    equal(page.problems, []);
  });
  await page.close();
}

async function importedPoints(browser) {
  const name = "imported_points.cag", before = "plate = polyline([[0, 0], [40mm, 0], [40, 20]], closed: true)\n";
  fs.writeFileSync(path.join(folder, name), before);
  const { url } = await serve("importing.cag", 'import "./imported_points.cag" as parts\nshow parts.plate\n');
  const page = await browser.open(url, SIZE);
  await test("the numbers of a point are changed in the script that has them, which is shown", async () => {
    await page.until(READY);
    await page.value('document.querySelector("#parts .part").click()');
    await page.value("document.querySelector('#scene').focus()");
    await page.key("d");
    await page.until('document.querySelectorAll(".handle.point:not(.locked)").length === 3 && document.querySelector("#selection").textContent.includes("length")');
    await drawn(page);
    await page.value('[...document.querySelectorAll(".handle.point")].find((b) => b.ariaLabel.includes("x 40, y 0")).focus()');
    await page.key("ArrowRight");
    await page.until(`cagPage.editor.path === ${JSON.stringify(name)}`);
    const after = await page.until(`cagPage.editor.text(${JSON.stringify(name)}) !== ${JSON.stringify(before)} && cagPage.editor.text(${JSON.stringify(name)})`);
    check(/^plate = polyline\(\[\[0, 0\], \[4\d(\.\d+)?mm, 0\], \[40, 20\]\], closed: true\)\n$/.test(after), after);
    await page.until('!document.querySelector("#status").textContent.includes("error") && [...document.querySelectorAll(".handle.point")].some((b) => !/x (0|40), /.test(b.ariaLabel))');
    await page.value("document.querySelector('#scene').focus()");
    await page.key("z", { modifiers: 2 });
    await page.until(`cagPage.editor.text(${JSON.stringify(name)}) === ${JSON.stringify(before)}`);
    equal(page.problems, []);
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
    // A capital P is 1409/2048 of 6 mm high, and the mark is in the corner of the drawing, which is 60 mm wide.
    const box = (label, part) => page.value(`(() => { const r = document.querySelector('.label[aria-label="${label}"] .${part}').getBoundingClientRect(); return [r.x, r.y, r.width, r.height]; })()`);
    const pixel = await page.value("cagPage.view.pixel"), mark = await box("P_1", "mark"), word = await box("side", "text");
    check(Math.abs(mark[2] - (2 * 0.24 + 0.1) * 6 / pixel) < 1, `the mark is ${mark[2]} wide`);
    check(Math.abs(mark[0] + mark[2] / 2 - (word[0] + word[2] / 2) - 30 / pixel) < 2, "the mark is not at its corner");
    check(word[1] > mark[1] + 30 / pixel, "the word is not below its side");
    await page.clickOn('[data-tab="code"]');
    await page.until(`${EDITOR}.offsetParent !== null`);
    equal(page.problems, []);
  });
  await page.close();
}

const centerOf = async (page, selector) => {
  await drawn(page);
  const r = await page.box(selector);
  return [r.x + r.width / 2, r.y + r.height / 2];
};
const chosen = "cagPage.robots.chosen";
const idle = "!cagPage.robots.asking && cagPage.robots.before === null";
const toolFrame = `JSON.stringify(cagPage.robots.toolFrame())`;
const axesOf = (f) => [0, 1, 2, 4, 5, 6, 8, 9, 10].map((i) => f[i]);
const apart = (a, b) => Math.max(...a.map((x, i) => Math.abs(x - b[i])));

async function robots(browser) {
  const { url } = await serve("arm.cag", ARM);
  await browser.say("Browser.grantPermissions", { permissions: ["clipboardReadWrite", "clipboardSanitizedWrite"] });
  const page = await browser.open(url, SIZE);
  const tool = async () => JSON.parse(await page.value(toolFrame));
  const values = () => page.value(`${chosen}.q`);
  await test("a slider moves a joint of a robot, and nothing runs", async () => {
    await page.until(READY);
    await page.until('!document.querySelector("#robots").closest("details").hidden');
    equal(await page.value('document.querySelectorAll("#robots [data-joint]").length'), 6);
    const place = "cagPage.view.parts.views.get('arm.3')", before = await page.value(`${place}.group.matrix.toArray()`);
    const picture1 = await picture(page, "robot"), run = await page.value("document.documentElement.dataset.run");
    await page.value('document.querySelector("[data-joint=\\"1\\"] input[type=range]").focus()');
    await page.key("End");
    await page.until(`${chosen}.q[0] === 180 && ${chosen}.pose`);
    // The arm turns about Z, from 35 to 180 degrees.
    const after = await page.value(`${place}.group.matrix.toArray()`), c = Math.cos((145 / 180) * Math.PI), s = Math.sin((145 / 180) * Math.PI);
    const turned = [0, 4, 8, 12].flatMap((i) => [c * before[i] - s * before[i + 1], s * before[i] + c * before[i + 1], before[i + 2]]);
    check(apart(turned, [0, 4, 8, 12].flatMap((i) => after.slice(i, i + 3))) < 1e-3, "the part is elsewhere");
    check(difference(picture1, await picture(page, "robot-turned"), await sceneOf(page)) > 0.01, "nothing has moved");
    equal(await page.value("document.documentElement.dataset.run"), run);
    await page.value('document.querySelector("[data-joint=\\"1\\"] [aria-label^=Reset]").click()');
    await page.until(`${chosen}.q[0] === 35 && !${chosen}.pose`);
    check(apart(await page.value(`${place}.group.matrix.toArray()`), before) === 0, "the part has not returned");
  });
  await test("a value beyond the limits becomes the limit", async () => {
    const field = 'document.querySelector("[data-joint=\\"2\\"] input[type=number]")';
    await page.value(`(() => { ${field}.value = "500"; ${field}.dispatchEvent(new Event("change")); })()`);
    await page.until(`${chosen}.q[1] === 180`);
    await press(page, "Home");
    await page.until(`${chosen}.q.every((x) => x === 0) && ${idle}`);
    await press(page, "Reset");
    await page.until(`${chosen}.q[1] === -60 && ${field}.value === "-60"`);
  });
  await test("the arm follows its tool, which keeps its orientation", async () => {
    const at = await centerOf(page, ".tool-handle"), before = await tool(), to = [at[0] - 50, at[1] + 30];
    await page.drag(at, to, 12);
    await page.until(`${idle} && ${chosen}.pose`);
    await drawn(page);
    const now = await centerOf(page, ".tool-handle"), after = await tool();
    check(apart(now, to) < 1.5, `the tool is at ${now}, not at ${to}`);
    check(apart(axesOf(before), axesOf(after)) < 1e-6, "the tool has turned");
    await picture(page, "robot-dragged");
  });
  await test("the joint values are copied as q", async () => {
    await press(page, "Copy q");
    await page.until('document.querySelector("#robots [role=status]").textContent.startsWith("Copied [")');
    const copied = await page.value("navigator.clipboard.readText()"), q = await values();
    check(/^\[(-?[\d.]+deg, ){5}-?[\d.]+deg\]$/.test(copied), `copied ${copied}`);
    check(apart(copied.slice(1, -1).split(", ").map(parseFloat), q) < 1e-4, `copied ${copied} of ${q}`);
  });
  await test("the ring turns the tool about the line of sight, and Shift about the others", async () => {
    const at = await centerOf(page, ".tool-handle"), before = await tool(), radius = 27;
    await page.drag([at[0] + radius, at[1]], [at[0], at[1] - radius], 8);
    await page.until(idle);
    const turned = await tool(), trace = (a, b) => axesOf(a).reduce((sum, x, i) => sum + x * axesOf(b)[i], 0);
    const angle = (a, b) => (Math.acos((trace(a, b) - 1) / 2) * 180) / Math.PI;
    check(Math.abs(angle(before, turned) - 90) < 1, `the tool has turned by ${angle(before, turned)} degrees`);
    check(apart([3, 7, 11].map((i) => before[i]), [3, 7, 11].map((i) => turned[i])) < 1e-4, "the tool has moved");
    const now = await centerOf(page, ".tool-handle");
    await page.drag(now, [now[0] + 40, now[1]], 6, { modifiers: 8 });
    await page.until(idle);
    const again = await tool();
    check(Math.abs(angle(turned, again) - 20) < 1, `the tool has turned by ${angle(turned, again)} degrees`);
  });
  await test("keys move the tool", async () => {
    const before = await centerOf(page, ".tool-handle");
    await page.value('document.querySelector(".tool-handle").focus()');
    for (let i = 0; i < 3; i++) await page.key("ArrowRight");
    await page.until(idle);
    await drawn(page);
    const after = await centerOf(page, ".tool-handle");
    check(after[0] - before[0] > 5 && Math.abs(after[1] - before[1]) < 2, `the tool went from ${before} to ${after}`);
  });
  await test("a target out of reach is shown, and Escape gives it up", async () => {
    const at = await centerOf(page, ".tool-handle"), before = await values();
    await page.mouse("mouseMoved", ...at, { button: "none" });
    await page.mouse("mousePressed", ...at);
    for (let i = 1; i <= 8; i++) await page.mouse("mouseMoved", at[0] + 25 * i, at[1] - 10 * i, { buttons: 1 });
    await page.until('document.querySelector(".tool-handle").classList.contains("missed")');
    await page.until('document.querySelector("#robots [role=status]").textContent.startsWith("Out of reach")');
    await picture(page, "robot-missed");
    await page.key("Escape");
    await page.until(`${idle} && !document.querySelector(".tool-handle").classList.contains("missed")`);
    await page.mouse("mouseReleased", at[0] + 200, at[1] - 80);
    check(apart(await values(), before) < 1e-9, "the arm has not returned");
  });
  await test("a pose stays over a run that does not change q", async () => {
    const before = await values();
    await page.value(`${EDITOR}.focus()`);
    await page.key("End", { modifiers: 2 });
    await page.type("show box([50, 50, 50])");
    await page.until('cagPage.view.parts.views.has("box")');
    equal(await values(), before);
    check(await page.value("cagPage.view.parts.views.get('arm.3').motion !== null"), "the pose is gone");
  });
  await test("the pose is written into the script as one step", async () => {
    const before = await page.value(text), q = await values();
    await press(page, "Write q into script");
    const wanted = (await page.value(text)).match(/posed\(\[\n  (.*)deg, (.*)deg, (.*)deg,  \/\/ shoulder and elbow\n  (.*)rad, (.*)deg, (.*)deg\n\]\)/);
    check(wanted, "the layout has changed");
    const written = wanted.slice(1).map(Number);
    written[3] *= 180 / Math.PI;
    check(apart(written, q) < 1e-4, `${written} was written for ${q}`);
    await page.until(`!${chosen}.pose && Math.abs(${chosen}.robot.joints[0].value - ${q[0]}) < 1e-3`);
    check(apart(await values(), q) < 1e-4, "the arm is elsewhere");
    await page.value(`${EDITOR}.focus()`);
    await page.key("z", { modifiers: 2 });
    equal(await page.value(text), before);
    await page.until(`${chosen}.robot.joints[0].value === 35 && ${chosen}.q[0] === 35`);
  });
  await test("the page of a robot has no errors", async () => equal(page.problems, []));
  await page.close();
}

async function tenLinks(browser) {
  const { url } = await serve("ten.cag", TEN);
  const page = await browser.open(url, SIZE);
  await test("a robot of ten links follows its tool more than 30 times per second, if the machine draws that many pictures", async () => {
    await page.until(READY);
    await page.until("cagPage.robots.toolFrame()");
    equal(await page.value('document.querySelector("#robots .params").nextSibling && [...document.querySelectorAll("#robots button")].find((b) => b.textContent === "Write q into script").title'), "Not possible: the script computes q. Copy q instead.");
    const at = await centerOf(page, ".tool-handle");
    const rates = await page.value(`(async () => {
      const { robots, view } = cagPage, { engine } = robots, seconds = 2;
      const during = async (step) => {
        const begin = performance.now();
        let n = 0, t = 0;
        for (; t < seconds; n++, t = (performance.now() - begin) / 1000) await step(t);
        return n / t;
      };
      const next = () => new Promise(requestAnimationFrame);
      const { robot, q } = robots.chosen;
      const moved = (t) => robot.tool.map((x, i) => (i === 3 ? x - 30 * Math.sin(3 * t) : i === 11 ? x + 30 * Math.cos(2 * t) - 30 : x));
      const answers = await during((t) => engine.reach({ robot: robot.name, target: moved(t), q, orientation: "keep" }));
      // The most pictures that this machine draws.
      const turns = await during((t) => (view.orbit.turn(t < 1 ? 0.01 : -0.01, 0), view.invalidate(), next()));
      const handle = document.querySelector(".tool-handle"), first = robots.applied;
      handle.setPointerCapture = () => {};
      const send = (kind, dx, dy) => handle.dispatchEvent(new PointerEvent(kind, { bubbles: true, button: 0, buttons: 1, pointerId: 1, clientX: ${at[0]} + dx, clientY: ${at[1]} + dy }));
      send("pointerdown", 0, 0);
      await during((t) => (send("pointermove", 40 * Math.sin(3 * t) - 40, 30 * Math.cos(2 * t) - 30), next()));
      send("pointerup", 0, 0);
      return { answers, turns, updates: (robots.applied - first) / seconds };
    })()`);
    const { answers, turns, updates } = rates;
    console.log(`  ${answers.toFixed(0)} answers per second; ${updates.toFixed(0)} updates of the picture, where turning the view makes ${turns.toFixed(0)}`);
    check(answers > 30, `${answers} answers per second`);
    check(updates > Math.min(30, turns / 3), `${updates} updates per second`);
    equal(page.problems, []);
  });
  await page.close();
}

async function failing(browser) {
  const { url, file } = await serve("tall.cag", "param height = 40 in 10..90\nassert height < 30, \"too tall\"\nshow sphere(height) |> named(\"ball\")\n");
  const page = await browser.open(url, SIZE);
  await test("a script that fails at first has its params, and no tools for what is not there", async () => {
    await page.until('document.documentElement.dataset.ready === "true" && document.documentElement.dataset.ok === "false"');
    equal(await page.value('document.querySelectorAll("#views option").length'), 8);
    check(!(await page.value(button("Show all"))), "Show all is offered");
    check(await page.value(`${button("Write into script")}.disabled`), "values can be written");
    await page.value(`(() => { const s = document.querySelector('[data-param=height] input[type=range]'); s.value = 20; s.dispatchEvent(new Event("input")); s.dispatchEvent(new Event("change")); })()`);
    await page.until('document.documentElement.dataset.ok === "true" && document.querySelector("#parts [data-part=ball]")');
    equal(page.problems, []);
  });
  if (!inPlayground) await test("a script whose file was deleted is saved again", async () => {
    await page.value('cagPage.editor.replace("tall.cag", 0, 0, "// kept\\n")');
    fs.unlinkSync(file);
    await page.clickOn("#save");
    await page.until('!document.querySelector("#tabs .dirty")');
    check((await storedText(page, file)).startsWith("// kept"), "the file was not written");
  });
  await page.close();
}

async function untitled(browser) {
  const { url } = await serve("", "");
  const page = await browser.open(url, SIZE), downloads = path.join(folder, "scripts"), saved = path.join(downloads, "untitled.cag");
  fs.mkdirSync(downloads);
  await browser.say("Browser.setDownloadBehavior", { behavior: "allow", downloadPath: downloads });
  await test("a script without a file is downloaded, and runs on", async () => {
    await page.until(READY);
    await page.value('cagPage.editor.replace("untitled.cag", 0, 0, "show sphere(3)\\n")');
    await page.until('document.querySelector("#tabs .dirty")');
    await page.clickOn("#save");
    await page.until('!document.querySelector("#tabs .dirty")');
    for (let i = 0; i < 600 && !fs.existsSync(saved); i++) await pause(50);
    equal(fs.readFileSync(saved, "utf8"), "show sphere(3)\n");
    await page.value('cagPage.editor.replace("untitled.cag", 0, 0, "show box([1, 2, 3])\\n")');
    await page.until('document.querySelectorAll("#parts [data-part]").length === 2');
    equal(page.problems, []);
  });
  await page.close();
}

// A port that no program listens on.
const freePort = () => new Promise((done) => {
  const listener = net.createServer().listen(0, "127.0.0.1", () => {
    const { port } = listener.address();
    listener.close(() => done(port));
  });
});

async function restarted(browser) {
  const sphere = (radius) => `show sphere(${radius})\n`;
  const port = String(await freePort());
  await test("a page connects to the server that was started again after its server died", async () => {
    const first = await serve("again.cag", sphere(5), "--port", port);
    const page = await browser.open(first.url);
    await page.until(READY);
    const ended = new Promise((done) => first.server.on("exit", done));
    first.server.kill("SIGKILL");
    await ended;
    await page.until('document.querySelector("#notice").textContent.includes("does not answer")');
    const second = await serve("again.cag", sphere(7), "--port", port);
    equal(second.url, first.url);
    await page.until('document.querySelector("#notice").hidden');
    await page.until(`${text}.includes("sphere(7)")`);
    await page.close();
  });
}

async function main() {
  const browser = new Browser(chromium);
  try {
    await block(browser);
    await language({ browser, serve, folder, test, equal, check, picture, EDITOR, text, SIZE, alone: inPlayground });
    await points(browser);
    if (!inPlayground) await importedPoints(browser);
    await film(browser);
    await robots(browser);
    await tenLinks(browser);
    await small(browser);
    await failing(browser);
    if (!inPlayground) await untitled(browser);
    if (!inPlayground) await restarted(browser);
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
