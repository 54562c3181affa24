// Serves the folder of a playground, as any file server would, and prints the address that opens a script in it.
//   node playground_server.js FOLDER [SCRIPT]
"use strict";
const fs = require("fs");
const http = require("http");
const path = require("path");
const zlib = require("zlib");

const TYPES = { html: "text/html", js: "text/javascript", css: "text/css", svg: "image/svg+xml", wasm: "application/wasm", json: "application/json", png: "image/png", txt: "text/plain", cag: "text/plain" };

/** Calls `note(path, size)` with the compressed size of each answer. */
function serveFolder(folder, note = () => {}) {
  const root = path.resolve(folder), compressed = new Map();
  const server = http.createServer((request, response) => {
    const name = decodeURIComponent(new URL(request.url, "http://localhost").pathname).replace(/\/$/, "/index.html");
    const file = path.join(root, name);
    if (!file.startsWith(root) || !fs.existsSync(file) || !fs.statSync(file).isFile()) {
      response.writeHead(404).end();
      return;
    }
    if (!compressed.has(file)) compressed.set(file, zlib.gzipSync(fs.readFileSync(file), { level: 9 }));
    const bytes = compressed.get(file);
    note(name, bytes.length);
    response.writeHead(200, { "Content-Type": TYPES[path.extname(file).slice(1)] ?? "application/octet-stream", "Content-Encoding": "gzip", "Content-Length": bytes.length });
    response.end(bytes);
  });
  return new Promise((done) => server.listen(0, "127.0.0.1", () => done(server)));
}

async function main([folder, script]) {
  const server = await serveFolder(folder);
  const fragment = script ? `#name=${encodeURIComponent(path.basename(script))}&text=${encodeURIComponent(fs.readFileSync(script, "utf8"))}` : "";
  console.log(`http://localhost:${server.address().port}/${fragment}`);
}

module.exports = { serveFolder };
if (require.main === module) main(process.argv.slice(2));
