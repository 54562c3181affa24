// Checks a site in a folder: the files and anchors of all links and search results exist, nothing is fetched
// from elsewhere, and all elements are properly closed.
//   node site_links.js FOLDER
"use strict";
const fs = require("fs");
const path = require("path");

const folder = path.resolve(process.argv[2]);
const files = fs.readdirSync(folder, { recursive: true }).filter((f) => f.endsWith(".html"));
const text = new Map(files.map((f) => [f, fs.readFileSync(path.join(folder, f), "utf8")]));
const ids = new Map([...text].map(([f, t]) => [f, new Set([...t.matchAll(/ id="([^"]*)"/g)].map((m) => m[1]))]));
let bad = 0, links = 0;

function wrong(file, what) {
  if (bad++ < 20) console.log(`${file}: ${what}`);
}

function follow(file, url) {
  links++;
  const [place, anchor] = url.split("#");
  const target = place ? path.normalize(path.join(path.dirname(file), decodeURI(place))) : file;
  if (!fs.existsSync(path.join(folder, target))) wrong(file, `${url} leads nowhere`);
  else if (anchor && !(ids.get(target) || new Set()).has(decodeURI(anchor))) wrong(file, `${url}: no such anchor`);
}

// Elements without an end tag.
const open_ended = new Set(["meta", "link", "input", "img", "br", "hr"]);

function check_nesting(file, html) {
  const stack = [];
  for (const m of html.matchAll(/<(\/?)([a-zA-Z][a-zA-Z0-9]*)((?:"[^"]*"|[^>"])*)>/g)) {
    const name = m[2].toLowerCase();
    if (open_ended.has(name)) continue;
    if (!m[1]) stack.push(name);
    else if (stack.pop() !== name) return wrong(file, `</${name}> closes another element`);
  }
  if (stack.length) wrong(file, `<${stack.pop()}> is not closed`);
}

for (const [file, html] of text) {
  for (const m of html.matchAll(/ (href|src)="([^"]*)"/g)) {
    const outside = /^[a-z]+:/.test(m[2]);
    if (!outside) follow(file, m[2]);
    else if (m[1] === "src" || /<link/.test(html.slice(m.index - 40, m.index))) wrong(file, `${m[2]} is fetched from elsewhere`);
  }
  const seen = new Set();
  for (const m of html.matchAll(/ id="([^"]*)"/g)) {
    if (seen.has(m[1])) wrong(file, `the anchor ${m[1]} is there twice`);
    seen.add(m[1]);
  }
  check_nesting(file, html);
}
const index = new Function(fs.readFileSync(path.join(folder, "index.js"), "utf8") + "return cagIndex;")();
for (const entry of index) follow("index.html", entry[2]);

console.log(`${files.length} pages, ${links} links, ${index.length} entries of the search, ${bad} wrong`);
process.exit(bad ? 1 : 0);
