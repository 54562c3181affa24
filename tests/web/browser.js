// Headless Chromium, driven over the DevTools protocol through two pipes, without other packages.
"use strict";
const { spawn } = require("child_process");
const fs = require("fs");
const os = require("os");
const path = require("path");

const MOST_ANSWER = 300000, SHORT_ANSWER = 5000; // milliseconds
const WAIT = Number(process.env.WEB_TEST_WAIT ?? 60000); // milliseconds for a condition to come true on a loaded machine
const pause = (ms) => new Promise((done) => setTimeout(done, ms));

class Browser {
  constructor(chromium) {
    this.profile = fs.mkdtempSync(path.join(os.tmpdir(), "cag-chromium-"));
    this.process = spawn(chromium, ["--headless", "--no-sandbox", "--disable-dev-shm-usage", "--remote-debugging-pipe", "--use-gl=angle",
      "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--hide-scrollbars", "--force-color-profile=srgb",
      `--user-data-dir=${this.profile}`], { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"] });
    this.number = 0;
    this.waiting = new Map();
    this.listeners = [];
    let rest = [];
    // Messages are JSON, with a zero byte after each.
    this.process.stdio[4].on("data", (data) => {
      let from = 0;
      for (let end; (end = data.indexOf(0, from)) >= 0; from = end + 1) {
        this.receive(JSON.parse(Buffer.concat([...rest, data.subarray(from, end)]).toString()));
        rest = [];
      }
      rest.push(data.subarray(from));
    });
  }

  receive(message) {
    const done = this.waiting.get(message.id);
    this.waiting.delete(message.id);
    if (done) done(message);
    else if (message.method) for (const l of this.listeners) l(message);
  }

  // What is evaluated while a page is being replaced may never be answered: `most` is the milliseconds to wait.
  say(method, params = {}, sessionId = undefined, most = MOST_ANSWER) {
    const id = ++this.number;
    this.process.stdio[3].write(JSON.stringify({ id, method, params, sessionId }) + "\0");
    return new Promise((done, fail) => {
      const timer = setTimeout(() => {
        this.waiting.delete(id);
        fail(new Error(`${method}: no answer`));
      }, most);
      this.waiting.set(id, (m) => {
        clearTimeout(timer);
        if (m.error) fail(new Error(`${method}: ${m.error.message}`));
        else done(m.result);
      });
    });
  }

  async open(url, { width = 1280, height = 800, scale = 1, dark = false, touch = false } = {}) {
    const { targetId } = await this.say("Target.createTarget", { url: "about:blank" });
    const { sessionId } = await this.say("Target.attachToTarget", { targetId, flatten: true });
    const page = new Page(this, sessionId, targetId);
    for (const domain of ["Page", "Runtime", "Log"]) await page.say(`${domain}.enable`);
    await page.say("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: scale, mobile: touch });
    await page.say("Emulation.setEmulatedMedia", { features: [{ name: "prefers-color-scheme", value: dark ? "dark" : "light" }] });
    await page.say("Page.navigate", { url });
    return page;
  }

  close() {
    return new Promise((done) => {
      this.process.on("exit", () => {
        try {
          fs.rmSync(this.profile, { recursive: true, force: true, maxRetries: 20, retryDelay: 100 });
        } catch {
          // A process of the browser may still write to the folder, which is temporary.
        }
        done();
      });
      this.process.kill();
    });
  }
}

class Page {
  constructor(browser, session, target) {
    this.browser = browser;
    this.session = session;
    this.target = target;
    this.problems = []; // exceptions, and errors in the console
    browser.listeners.push((m) => {
      if (m.sessionId !== session) return;
      if (m.method === "Runtime.exceptionThrown") this.problems.push(m.params.exceptionDetails.exception?.description ?? m.params.exceptionDetails.text);
      if (m.method === "Runtime.consoleAPICalled" && ["error", "warning"].includes(m.params.type)) this.problems.push(m.params.args.map((a) => a.value ?? a.description).join(" "));
      if (m.method === "Log.entryAdded" && m.params.entry.level === "error") this.problems.push(`${m.params.entry.text} ${m.params.entry.url ?? ""}`);
    });
  }

  say(method, params, most) {
    return this.browser.say(method, params, this.session, most);
  }

  async value(expression, most) {
    const { result, exceptionDetails } = await this.say("Runtime.evaluate", { expression, returnByValue: true, awaitPromise: true }, most);
    if (exceptionDetails) throw new Error(`${expression}: ${exceptionDetails.exception?.description ?? exceptionDetails.text}`);
    return result.value;
  }

  // Waits until an expression is true, and returns its value.
  async until(expression, wait = WAIT) {
    const end = Date.now() + wait;
    for (;;) {
      // While a page is being replaced, nothing can be evaluated.
      const value = await this.value(expression, SHORT_ANSWER).catch(() => false);
      if (value) return value;
      if (Date.now() > end) throw new Error(`never came true: ${expression}\n  ${this.problems.join("\n  ")}`);
      await pause(30);
    }
  }

  async box(selector) {
    return this.value(`(() => { const r = document.querySelector(${JSON.stringify(selector)}).getBoundingClientRect(); return { x: r.x, y: r.y, width: r.width, height: r.height }; })()`);
  }

  async mouse(type, x, y, more = {}) {
    await this.say("Input.dispatchMouseEvent", { type, x, y, button: "left", clickCount: 1, ...more });
  }

  async click(x, y, more = {}) {
    await this.mouse("mouseMoved", x, y, { button: "none" });
    await this.mouse("mousePressed", x, y, more);
    await this.mouse("mouseReleased", x, y, more);
  }

  async clickOn(selector) {
    await this.value(`document.querySelector(${JSON.stringify(selector)}).scrollIntoView({ block: "nearest" })`);
    const r = await this.box(selector);
    await this.click(r.x + r.width / 2, r.y + r.height / 2);
  }

  async drag(from, to, steps = 5, more = {}) {
    await this.mouse("mouseMoved", from[0], from[1], { button: "none" });
    await this.mouse("mousePressed", from[0], from[1], more);
    for (let i = 1; i <= steps; i++)
      await this.mouse("mouseMoved", from[0] + ((to[0] - from[0]) * i) / steps, from[1] + ((to[1] - from[1]) * i) / steps, { buttons: more.button === "right" ? 2 : 1, ...more });
    await this.mouse("mouseReleased", to[0], to[1], more);
  }

  async key(key, more = {}) {
    const text = key === "Enter" ? "\r" : key.length === 1 && !more.modifiers ? key : undefined;
    const code = /^[a-z0-9]$/i.test(key) ? key.toUpperCase().charCodeAt(0) : { Enter: 13, Escape: 27, ArrowLeft: 37, ArrowUp: 38, ArrowRight: 39, ArrowDown: 40, End: 35, Home: 36, Backspace: 8, Tab: 9, F2: 113, F12: 123, ".": 190 }[key];
    await this.say("Input.dispatchKeyEvent", { type: text ? "keyDown" : "rawKeyDown", key, text, windowsVirtualKeyCode: code, ...more });
    await this.say("Input.dispatchKeyEvent", { type: "keyUp", key, windowsVirtualKeyCode: code, ...more });
  }

  // Chromium drops a text now and then that comes while a scene is drawn: then it is inserted again.
  async type(text) {
    await this.value('void (globalThis.typedTexts ??= (document.addEventListener("beforeinput", () => globalThis.typedTexts++, true), 0))');
    const before = await this.value("typedTexts"), arrived = async () => (await this.value("typedTexts")) > before;
    for (let tries = 0; tries < 3; tries++) {
      await this.say("Input.insertText", { text });
      if (await arrived()) return;
      await pause(500);
      if (await arrived()) return;
    }
    throw new Error(`the page took no text: ${text}`);
  }

  async screenshot(file) {
    const { data } = await this.say("Page.captureScreenshot", { format: "png" });
    const bytes = Buffer.from(data, "base64");
    if (file) fs.writeFileSync(file, bytes);
    return bytes;
  }

  close() {
    return this.browser.say("Target.closeTarget", { targetId: this.target });
  }
}

module.exports = { Browser, pause };
