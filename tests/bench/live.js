// How soon the page of `cag view` shows what changed, and what it costs: node live.js PROGRAM CHROMIUM
//
// Times end when the draw calls of a frame have been submitted. Chromium may draw without a graphics processor, which takes its time for each
// pixel; changes are therefore measured in a small window.
"use strict";
const { spawn } = require("child_process");
const fs = require("fs");
const http = require("http");
const os = require("os");
const path = require("path");
const { Browser, pause } = require("../web/browser.js");

const [program, chromium] = process.argv.slice(2);
const SIZE = { width: 1280, height: 800 }, SMALL_SIZE = { width: 480, height: 320 };
const RELOADS = Number(process.env.RELOADS ?? 10000);
const folder = fs.mkdtempSync(path.join(os.tmpdir(), "cag-bench-"));

// Two shapes, of which the param changes one: about 100,000 triangles in all.
const DENSE = `param radius = 20 in 10..40
param bump = 1 in 0..2
show sphere(radius) |> named("ball")
show torus(60, 12 + bump) |> named("ring")
`;
const SMALL = "param size = 10 in 1..20\nshow box([size, 10, 10])\n";

const report = (name, value, unit, aim) => console.log(`${name.padEnd(52)} ${value.toFixed(value < 100 ? 1 : 0).padStart(8)} ${unit.padEnd(44)}   aim ${aim}`);
const median = (list) => [...list].sort((a, b) => a - b)[list.length >> 1];

function serve(file, ...options) {
  return new Promise((done, fail) => {
    const begin = Date.now();
    const server = spawn(program, ["view", file, "--no-open", ...options], { stdio: ["ignore", "pipe", "ignore"] });
    server.stdout.once("data", (line) => done({ server, begin, url: /http:\S+/.exec(String(line))[0] }));
    server.once("error", fail);
  });
}
const stop = (server) => new Promise((done) => server.once("exit", done) && server.kill("SIGINT"));

const SHOWN = 'performance.getEntriesByName("cag-first-picture").length > 0 && document.documentElement.dataset.ready';
const NOW = "performance.timeOrigin + performance.now()";

async function firstPicture(browser) {
  const times = [];
  for (let i = 0; i < 6; i++) {
    const page = await browser.open("about:blank", SIZE);
    const { server, begin, url } = await serve("examples/vase.cag");
    await page.say("Page.navigate", { url });
    await page.until(SHOWN);
    times.push(await page.value('performance.timeOrigin + performance.getEntriesByName("cag-first-picture")[0].startTime') - begin);
    await page.close();
    await stop(server);
  }
  report("cag view examples/vase.cag to the first picture", median(times.slice(1)), "ms, the program's start included", "< 300 ms");
}

// Notes when frames of new scenes have been submitted.
const WATCH = `(() => {
  globalThis.frames = [];
  let last = null;
  const { view } = cagPage;
  view.drawn.on(() => {
    if (view.message === last) return;
    last = view.message;
    frames.push([last.run, ${NOW}]);
  });
})()`;

async function changes(browser) {
  const file = path.join(folder, "dense.cag");
  fs.writeFileSync(file, DENSE);
  const { server, url } = await serve(file, "--tolerance", "0.0095");
  const page = await browser.open(url, SMALL_SIZE);
  await page.until(SHOWN);
  await page.value(WATCH);
  const triangles = await page.value("[...cagPage.view.parts.views.values()].reduce((n, v) => n + v.shape.data.triangles.length / 3, 0)");
  const times = [];
  for (let i = 0; i < 12; i++) {
    await page.value("frames.length = 0");
    const saved = Date.now();
    fs.writeFileSync(file, DENSE.replace("radius = 20", `radius = ${21 + i}`));
    const [, drawn] = await page.until("frames[0]");
    times.push(drawn - saved);
    await pause(100);
  }
  report(`save to draw calls, ${triangles} triangles`, median(times), "ms", "< 100 ms");
  const SECONDS = 4;
  const count = await page.value(`new Promise((done) => {
    const slider = document.querySelector("[data-param=radius] input[type=range]"), end = performance.now() + ${SECONDS * 1000};
    frames.length = 0;
    let i = 0;
    const step = () => {
      slider.value = String(10 + (i++ % 300) / 10);
      slider.dispatchEvent(new Event("input", { bubbles: true }));
      if (performance.now() < end) requestAnimationFrame(step);
      else slider.dispatchEvent(new Event("change", { bubbles: true })), done(frames.length);
    };
    step();
  })`);
  report("a slider there", count / SECONDS, "scenes a second", ">= 20 a second");
  await page.close();
  await stop(server);
}

// Resident memory in MiB.
const memoryOf = (pid) => Number(/VmRSS:\s*(\d+)/.exec(fs.readFileSync(`/proc/${pid}/status`, "utf8"))[1]) / 1024;

async function reloads(browser) {
  const file = path.join(folder, "small.cag");
  fs.writeFileSync(file, SMALL);
  const { server, url } = await serve(file);
  const { port, searchParams } = new URL(url), agent = new http.Agent({ keepAlive: true, maxSockets: 1 });
  const page = await browser.open(url, { width: 400, height: 300 });
  await page.until(SHOWN);
  const ask = (body) => new Promise((done, fail) => {
    const headers = { Cookie: `cag-view-${port}=${searchParams.get("t")}`, "Content-Type": "application/json" };
    const request = http.request({ host: "127.0.0.1", port, agent, method: "POST", path: "/api/run", headers }, (answer) => {
      let text = "";
      answer.on("data", (data) => (text += data)).on("end", () => done(JSON.parse(text).run));
    });
    request.on("error", fail);
    request.end(JSON.stringify(body));
  });
  const pageMemory = async () => {
    await page.say("HeapProfiler.collectGarbage");
    return (await page.say("Runtime.getHeapUsage")).usedSize / 2 ** 20;
  };
  const begin = Date.now(), warm = Math.min(1000, RELOADS / 10);
  let before = null;
  for (let i = 0; i < RELOADS; i++) {
    const run = await ask({ params: { size: String(1 + (i % 190) / 10) } });
    // Each run is shown before the next begins; otherwise it would be given up.
    while (i % 10 === 9 && Number(await page.value("document.documentElement.dataset.run")) < run) await pause(1);
    if (i === warm) before = [memoryOf(server.pid), await pageMemory()];
  }
  const after = [memoryOf(server.pid), await pageMemory()], seconds = (Date.now() - begin) / 1000;
  report(`the server's memory, ${RELOADS} reloads later`, after[0] - before[0], `MiB more than ${before[0].toFixed(0)} MiB (${seconds.toFixed(0)} s)`, "flat");
  report("the page's memory", after[1] - before[1], `MiB more than ${before[1].toFixed(1)} MiB`, "flat");
  await page.close();
  await stop(server);
}

async function main() {
  const size = fs.readdirSync("web/dist").reduce((n, name) => n + fs.statSync(path.join("web/dist", name)).size, 0);
  report("the page's own files, compressed", size / 1000, "kB", "<= 400 kB");
  const browser = new Browser(chromium);
  try {
    await firstPicture(browser);
    await changes(browser);
    await reloads(browser);
  } finally {
    await browser.close();
    fs.rmSync(folder, { recursive: true, force: true });
  }
}
main().catch((error) => {
  console.error(error.message);
  process.exitCode = 1;
});
