// Types into the search field of a site in headless Chromium, and follows the result.
//   node site_search.js CHROMIUM FOLDER WORD PAGE
// Passes if Enter leads to PAGE, a path below the folder.
"use strict";
const { spawn } = require("child_process");
const fs = require("fs");
const os = require("os");
const path = require("path");

const [chromium, folder, word, page] = process.argv.slice(2);
const profile = fs.mkdtempSync(path.join(os.tmpdir(), "cag-chromium-"));
const browser = spawn(chromium, ["--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--remote-debugging-pipe",
  `--user-data-dir=${profile}`], { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"] });

// Communicates with the browser through two pipes, in JSON with a zero byte after each message.
let number = 0, rest = "";
const waiting = new Map();
browser.stdio[4].on("data", (data) => {
  const parts = (rest + data).split("\0");
  rest = parts.pop();
  for (const part of parts) {
    const message = JSON.parse(part);
    const done = waiting.get(message.id);
    waiting.delete(message.id);
    if (done) done(message);
  }
});
function say(method, params = {}, sessionId) {
  const id = ++number;
  browser.stdio[3].write(JSON.stringify({ id, method, params, sessionId }) + "\0");
  return new Promise((done, fail) => waiting.set(id, (m) => (m.error ? fail(new Error(m.error.message)) : done(m.result))));
}
const pause = (ms) => new Promise((done) => setTimeout(done, ms));

async function until(session, expression) {
  for (let i = 0; i < 100; i++) {
    const { result } = await say("Runtime.evaluate", { expression }, session);
    if (result.value) return result.value;
    await pause(100);
  }
  throw new Error(`never came true: ${expression}`);
}

async function main() {
  const url = "file://" + path.resolve(folder, "index.html");
  const { targetId } = await say("Target.createTarget", { url });
  const { sessionId } = await say("Target.attachToTarget", { targetId, flatten: true });
  await until(sessionId, 'document.readyState === "complete" && typeof cagIndex !== "undefined"');
  await say("Runtime.evaluate", { expression: 'document.getElementById("search").focus()' }, sessionId);
  await say("Input.insertText", { text: word }, sessionId);
  const first = await until(sessionId, 'document.querySelector("#found a")?.textContent');
  console.log(`the search finds: ${first}`);
  for (const type of ["keyDown", "keyUp"])
    await say("Input.dispatchKeyEvent", { type, key: "Enter", code: "Enter", windowsVirtualKeyCode: 13 }, sessionId);
  await until(sessionId, `location.pathname.endsWith(${JSON.stringify("/" + page)}) && document.readyState === "complete"`);
  const title = await until(sessionId, 'document.querySelector("h1")?.textContent');
  console.log(`Enter leads to ${page}: ${title}`);
}

const late = setTimeout(() => finish(new Error("it takes too long")), 60000);
function finish(error) {
  clearTimeout(late);
  if (error) console.log(`FAILED: ${error.message}`);
  browser.on("exit", () => {
    try {
      fs.rmSync(profile, { recursive: true, force: true, maxRetries: 20, retryDelay: 100 });
    } catch {
      // A browser process may still write to the folder, which is temporary.
    }
    process.exit(error ? 1 : 0);
  });
  browser.kill();
}
main().then(() => finish(), finish);
