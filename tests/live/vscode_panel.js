// A panel of the stand-in for Visual Studio Code, as a page in Chromium: its HTML from one origin, the files of the extension from another.
"use strict";
const fs = require("fs");
const http = require("http");
const { Uri } = require("./vscode_module.js");

const TYPES = { js: "text/javascript", css: "text/css", svg: "image/svg+xml" };
// What the editor gives a page: some of its colors, its defaults for the body, and the function by which the page talks.
const COLORS = {
  dark: { foreground: "#cccccc", "editor-foreground": "#d4d4d4", "editor-background": "#1e1e1e", "sideBar-background": "#252526", descriptionForeground: "#9d9d9d", "input-background": "#3c3c3c",
    "widget-border": "#454545", "list-hoverBackground": "#2a2d2e", "textLink-foreground": "#3794ff", "charts-orange": "#d18616", "editor-selectionBackground": "#264f78",
    errorForeground: "#f48771", "editorWarning-foreground": "#cca700", "editor-font-family": "monospace", "font-family": "sans-serif" },
  light: { foreground: "#3b3b3b", "editor-foreground": "#000000", "editor-background": "#ffffff", "sideBar-background": "#f3f3f3", descriptionForeground: "#717171", "input-background": "#ffffff",
    "widget-border": "#d4d4d4", "list-hoverBackground": "#e8e8e8", "textLink-foreground": "#006ab1", "charts-orange": "#d18616", "editor-selectionBackground": "#add6ff",
    errorForeground: "#a1260d", "editorWarning-foreground": "#bf8803", "editor-font-family": "monospace", "font-family": "sans-serif" },
};
const script = (theme) => `
  const toText = (value) => JSON.stringify(value, (_, v) => v instanceof ArrayBuffer ? { $bytes: btoa(Array.from(new Uint8Array(v), (c) => String.fromCharCode(c)).join("")) } : v);
  const toValue = (text) => JSON.parse(text, (_, v) => typeof v?.$bytes === "string" ? Uint8Array.from(atob(v.$bytes), (c) => c.charCodeAt(0)).buffer : v);
  let acquired = false;
  globalThis.acquireVsCodeApi = () => {
    if (acquired) throw new Error("An instance of the VS Code API has already been acquired");
    acquired = true;
    return { postMessage: (message) => globalThis.toExtension(toText(message)) };
  };
  globalThis.fromExtension = (text) => dispatchEvent(new MessageEvent("message", { data: toValue(text) }));
  globalThis.setTheme = (colors, name) => {
    for (const [key, value] of Object.entries(colors)) document.documentElement.style.setProperty("--vscode-" + key, value);
    document.body.classList.remove("vscode-dark", "vscode-light");
    document.body.classList.add("vscode-" + name);
  };
  addEventListener("DOMContentLoaded", () => setTheme(${JSON.stringify(COLORS[theme])}, ${JSON.stringify(theme)}));
`;
const DEFAULTS = "<style>body { background-color: transparent; margin: 0; padding: 0 20px; }</style>";

const listening = (handler) => new Promise((done) => {
  const server = http.createServer(handler).listen(0, "127.0.0.1", () => done(server));
});

class PanelHost {
  // root: the folder whose files a panel can load.
  static async start(browser, root) {
    const host = new PanelHost();
    host.browser = browser;
    host.pages = await listening((request, answer) => answer.setHeader("Content-Type", "text/html").end(host.html));
    host.files = await listening((request, answer) => {
      const file = decodeURIComponent(request.url);
      const there = file.startsWith(root) && !file.includes("..") && fs.existsSync(file);
      if (!there) return answer.writeHead(404).end();
      answer.writeHead(200, { "Content-Type": TYPES[file.split(".").pop()] ?? "application/octet-stream", "Access-Control-Allow-Origin": "*" }).end(fs.readFileSync(file));
    });
    return host;
  }

  // Before the extension sets the HTML of a panel, its addresses are those of this host.
  prepare(panel) {
    const origin = `http://127.0.0.1:${this.files.address().port}`;
    panel.webview.cspSource = origin;
    panel.webview.asWebviewUri = (uri) => new Uri(origin + uri.path);
  }

  async show(panel, size, theme = "dark") {
    const { browser } = this, toText = (value) => JSON.stringify(value, (_, v) => (v instanceof ArrayBuffer ? { $bytes: Buffer.from(v).toString("base64") } : v));
    const toValue = (text) => JSON.parse(text, (_, v) => (typeof v?.$bytes === "string" ? new Uint8Array(Buffer.from(v.$bytes, "base64")).buffer : v));
    this.html = panel.webview.html.replace("<head>", `<head>${DEFAULTS}`);
    const page = await browser.open("about:blank", size);
    await page.say("Runtime.addBinding", { name: "toExtension" });
    await page.say("Page.addScriptToEvaluateOnNewDocument", { source: script(theme) });
    browser.listeners.push((m) => {
      if (m.sessionId === page.session && m.method === "Runtime.bindingCalled") panel.say(toValue(m.params.payload));
    });
    panel.receive = (message) => void page.say("Runtime.evaluate", { expression: `fromExtension(${JSON.stringify(toText(message))})` }).catch(() => {});
    page.setTheme = (name) => page.value(`setTheme(${JSON.stringify(COLORS[name])}, ${JSON.stringify(name)})`);
    await page.say("Page.navigate", { url: `http://127.0.0.1:${this.pages.address().port}/` });
    return page;
  }

  close() {
    this.pages.close();
    this.files.close();
  }
}

module.exports = { PanelHost };
