// The playground: what is sent, the time to the first picture, sliders, and the speed against the native program. Figures, with targets.
//   node tests/bench/playground.js CHROMIUM CAG FOLDER       FOLDER was made by `make playground`
"use strict";
const { execFileSync } = require("child_process");
const fs = require("fs");
const os = require("os");
const path = require("path");
const { Browser, pause } = require("../web/browser.js");
const { serveFolder } = require("../web/playground_server.js");

const [chromium, cag, folder] = process.argv.slice(2);
const RUNS = 3;
const line = (what, value, aim) => console.log(`${what.padEnd(58)} ${value.padStart(14)}   ${aim}`);
const READY = 'document.documentElement.dataset.ready === "true"';

async function main() {
  const sent = new Map();
  const server = await serveFolder(folder, (name, size) => sent.set(name, size));
  const base = `http://localhost:${server.address().port}/`;

  // A browser of its own for each run: nothing is in its caches.
  const first = [];
  for (let i = 0; i < RUNS; i++) {
    const browser = new Browser(chromium);
    const page = await browser.open(base);
    first.push(await page.until('performance.getEntriesByName("cag-first-picture")[0]?.startTime'));
    if (i === RUNS - 1) await page.until(READY);
    await browser.close();
  }
  const program = [...sent.values()].reduce((a, b) => a + b, 0);
  line("playground: sent for the first picture, compressed", `${(program / 1e6).toFixed(2)} MB`, "< 2 MB, with the editor");
  line("playground: of that, the program", `${(sent.get("/cag.wasm") / 1e6).toFixed(2)} MB`, "");
  line("playground: first picture, cold cache", `${Math.min(...first).toFixed(0)} ms`, "< 2000 ms");

  const browser = new Browser(chromium);
  const page = await browser.open(base);
  await page.until(READY);
  await pause(3000);
  const updates = await page.value(`(async () => {
    const field = document.querySelector("[data-param=height] input[type=range]"), runs = new Set(), end = performance.now() + 3000;
    for (let i = 0; performance.now() < end; i++) {
      field.value = 100 + i % 60;
      field.dispatchEvent(new Event("input"));
      await new Promise((done) => requestAnimationFrame(done));
      runs.add(document.documentElement.dataset.run);
    }
    return runs.size / 3;
  })()`);
  // Without a graphics processor, drawing takes most of the time.
  line("playground: updates per second of a slider, vase.cag", updates.toFixed(1), ">= 20");
  line("playground: of each, the run", await page.value('document.querySelector("#status").textContent'), "<= 50 ms");

  const work = fs.mkdtempSync(path.join(os.tmpdir(), "cag-bench-"));
  for (const name of ["surfaces/curvature_contours", "robots/gallery", "surfaces/csg", "sensing/tactile"]) {
    await page.say("Page.navigate", { url: "about:blank" });
    await page.say("Page.navigate", { url: `${base}#example=${name}` });
    await page.until(`location.href !== "about:blank" && ${READY} && document.documentElement.dataset.ok === "true"`, 180000);
    const seconds = [];
    for (let i = 0; i < RUNS; i++) {
      const run = await page.value("document.documentElement.dataset.run");
      await page.value("cagPage.editor.saveWanted.emit()");
      await page.until(`document.documentElement.dataset.run !== "${run}"`, 180000);
      const text = await page.value('document.querySelector("#status").textContent');
      seconds.push(/([\d.]+) s/.test(text) ? Number(/([\d.]+) s/.exec(text)[1]) : Number(/([\d.]+) ms/.exec(text)[1]) / 1000);
    }
    const native = [];
    for (let i = 0; i < RUNS; i++) {
      const begun = performance.now();
      execFileSync(cag, ["export", `examples/${name}.cag`, "-o", path.join(work, "a.stl")], { stdio: "ignore" });
      native.push((performance.now() - begun) / 1000);
    }
    const own = Math.min(...seconds), theirs = Math.min(...native);
    line(`playground: ${name}, native ${theirs.toFixed(2)} s`, `${own.toFixed(2)} s`, `${(own / theirs).toFixed(2)} times native`);
  }
  fs.rmSync(work, { recursive: true });
  await browser.close();
  server.close();
}
main().then(() => process.exit(0), (error) => {
  console.error(error.message);
  process.exit(1);
});
