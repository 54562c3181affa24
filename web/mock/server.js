// A stand-in for `cag view`, to work on the page without the server: it answers the requests of the protocol with what the program `cag`
// exports. It watches nothing, and measures little.
//   node web/mock/server.js SCRIPT.cag [PORT]
import { execFile } from "node:child_process";
import { createHash } from "node:crypto";
import fs from "node:fs";
import http from "node:http";
import os from "node:os";
import path from "node:path";
import { gunzipSync } from "node:zlib";

const here = path.dirname(new URL(import.meta.url).pathname);
const cag = process.env.CAG ?? path.join(here, "../../build/cag");
const script = path.resolve(process.argv[2]);
const folder = path.dirname(script), file = path.basename(script);
const port = Number(process.argv[3] ?? 8137);
const token = process.env.TOKEN ?? "mock";
const scratch = fs.mkdtempSync(path.join(os.tmpdir(), "cag-mock-"));
const meshes = new Map(), jobs = new Map(), listeners = new Set(), last = {};
let run = 0, job = 0;

const call = (args) => new Promise((done) => execFile(cag, args, { maxBuffer: 1 << 28, cwd: folder }, (error, stdout, stderr) =>
  done({ status: error ? error.code ?? 1 : 0, stdout, stderr })));
const version = (text) => createHash("sha256").update(text).digest("hex").slice(0, 16);

function send(event, data) {
  if (event !== "progress" && event !== "file") last[event] = data;
  for (const l of listeners) l.write(`event: ${event}\ndata: ${JSON.stringify(data)}\n\n`);
}

// --- Meshes from GLB ---

function readGlb(bytes) {
  const n = bytes.readUInt32LE(12), json = JSON.parse(bytes.toString("utf8", 20, 20 + n)), data = bytes.subarray(28 + n);
  const array = (i, Type, size) => {
    const a = json.accessors[i], v = json.bufferViews[a.bufferView];
    const start = data.byteOffset + (v.byteOffset ?? 0) + (a.byteOffset ?? 0);
    return new Type(data.buffer.slice(start, start + a.count * size * 4));
  };
  return json.nodes.filter((x) => x.mesh !== undefined).map((node) => {
    const p = json.meshes[node.mesh].primitives;
    let positions = [], normals = [], triangles = [], labels = [];
    p.forEach((q, k) => {
      const base = positions.length / 3, index = array(q.indices, Uint32Array, 1);
      const at = array(q.attributes.POSITION, Float32Array, 3);
      for (const x of at) positions.push(x);
      if (q.attributes.NORMAL !== undefined) for (const x of array(q.attributes.NORMAL, Float32Array, 3)) normals.push(x);
      else for (const x of at) normals.push(x * 0);
      for (const i of index) triangles.push(i + base);
      for (let i = 0; i < index.length / 3; i++) labels.push(k);
    });
    const m = node.matrix;
    return { name: node.name, positions, normals, triangles, labels, lines: p[0].mode === 1,
      placement: m ? [m[0], m[4], m[8], m[12], m[1], m[5], m[9], m[13], m[2], m[6], m[10], m[14]] : null };
  });
}

// Vertices are split at creases, so the edges with one triangle are the creases.
function creases(mesh) {
  const once = new Map(), t = mesh.triangles, n = mesh.positions.length / 3;
  for (let i = 0; i < t.length; i += 3)
    for (let k = 0; k < 3; k++) {
      const a = t[i + k], b = t[i + (k + 1) % 3], key = Math.min(a, b) * n + Math.max(a, b);
      if (once.has(key)) once.set(key, null);
      else once.set(key, [a, b]);
    }
  return [...once.values()].filter(Boolean).flat();
}

function encode(mesh) {
  const edges = creases(mesh), v = mesh.positions.length / 3, t = mesh.triangles.length / 3;
  const b = Buffer.alloc(32 + v * 24 + t * 16 + edges.length * 4);
  [0x6d676163, 1, v, t, edges.length / 2, 3, 0, 0].forEach((x, i) => b.writeUInt32LE(x, i * 4));
  let at = 32;
  for (const x of mesh.positions) at = b.writeFloatLE(x, at);
  for (const x of mesh.normals) at = b.writeFloatLE(x, at);
  for (const x of mesh.triangles) at = b.writeUInt32LE(x, at);
  for (const x of mesh.labels) at = b.writeUInt32LE(x, at);
  for (const x of edges) at = b.writeUInt32LE(x, at);
  return b;
}

// --- Runs ---

function params(text, values) {
  const found = [];
  for (const m of text.matchAll(/^param (\w+) = (.+?)(?: in ([^"]+?))?\s*(?:"([^"]*)")?\s*(?:\/\/.*)?$/gm)) {
    const [, name, initial, range, description] = m, start = m.index + 6;
    const line = text.slice(0, m.index).split("\n").length;
    const number = /^(-?[\d.]+)\s*(deg|mm|cm|in)?$/.exec(initial);
    const p = { name, description: description ?? "", kind: "other", value: values[name] ?? initial, initial,
      place: { file, line, column: 7, endLine: line, endColumn: 7 + name.length, start } };
    const list = range && /^\[(.*)\]$/.exec(range.trim());
    if (list) Object.assign(p, { kind: "choice", choices: list[1].split(",").map((x) => x.trim()) });
    else if (number) {
      const r = range ? /(-?[\d.]+)\w*\.\.(-?[\d.]+)/.exec(range) : null;
      Object.assign(p, { kind: number[2] === "deg" ? "angle" : "number", unit: number[2] ?? "", low: r ? Number(r[1]) : null, high: r ? Number(r[2]) : null });
    } else if (/^(true|false)$/.test(initial)) p.kind = "bool";
    else if (/^"#/.test(initial)) p.kind = "color";
    else if (/^"/.test(initial)) p.kind = "text";
    found.push(p);
  }
  return found;
}

function origin(text, name) {
  const lines = text.split("\n"), found = [];
  const add = (what, i) => found.push({ what, file, line: i + 1, column: 1, endLine: i + 1, endColumn: lines[i].length + 1, library: false });
  const show = lines.findIndex((l) => new RegExp(`^show ${name.replace(/\..*/, "")}\\b`).test(l));
  const made = lines.findIndex((l) => new RegExp(`^${name.replace(/\..*/, "")}\\s*=`).test(l));
  if (show >= 0) add("show", show);
  if (made >= 0) add("made", made);
  return found;
}

async function perform(id, request) {
  send("state", { run: id, running: true });
  const begin = Date.now(), values = request.params ?? {};
  const text = request.files?.[file] ?? fs.readFileSync(script, "utf8");
  const source = path.join(folder, `.mock-${process.pid}.cag`);
  fs.writeFileSync(source, text);
  const options = ["--diagnostics", "json"].concat(Object.entries(values).flatMap(([k, v]) => ["-D", `${k}=${v}`]));
  const glb = path.join(scratch, "x.glb"), json = path.join(scratch, "x.json");
  const a = await call(["export", source, "-o", glb, ...options]);
  const b = a.status === 0 ? await call(["export", source, "-o", json, ...options]) : a;
  fs.rmSync(source);
  if (id !== run) return;
  const message = { run: id, ok: b.status === 0, seconds: (Date.now() - begin) / 1000, memory: 12e6,
    prints: a.stdout.split("\n").filter(Boolean), diagnostics: [] };
  for (const line of a.stderr.split("\n").filter((l) => l.startsWith("{"))) {
    const d = JSON.parse(line);
    message.diagnostics.push({ severity: d.severity ?? "error", code: d.code, message: d.message, help: d.help ?? null, file,
      line: d.line, column: d.column, endLine: d.end_line ?? d.line, endColumn: d.end_column ?? d.column + 1, related: [] });
  }
  if (message.ok) {
    const s = JSON.parse(fs.readFileSync(json, "utf8"));
    const by = new Map(s.items.map((i) => [i.name, i]));
    const parts = readGlb(fs.readFileSync(glb)).filter((m) => !m.lines).map((m) => {
      const bytes = encode(m), mesh = version(bytes), item = by.get(m.name) ?? s.items[0];
      meshes.set(mesh, bytes);
      const low = [1 / 0, 1 / 0, 1 / 0], high = [-1 / 0, -1 / 0, -1 / 0];
      m.positions.forEach((x, i) => { low[i % 3] = Math.min(low[i % 3], x); high[i % 3] = Math.max(high[i % 3], x); });
      return { name: m.name, type: item.kind ?? "solid", story: item.kind ?? "", mesh, placement: m.placement, material: item.material ?? 0, labels: [],
        line: item.kind === "curve", radius: 0, bounds: [low, high], origin: origin(text, m.name) };
    });
    send("scene", { run: id, script: file, timed: /\btime\b/.test(text), params: params(text, values), materials: s.materials.map((m) => ({ ...m, scale: m.texture_scale })),
      parts, grounds: s.items.filter((i) => i.kind === "ground").map((g) => ({ name: g.name, z: g.z ?? 0, size: g.size ?? null, material: g.material })),
      cameras: s.cameras.map((c) => ({ ...c, fov: (c.fov ?? 0.5) * 180 / Math.PI, width: c.width ?? null, automatic: s.automatic_camera })),
      lights: s.lights.map((l) => ({ ...l, angle: (l.angle ?? 0) * 180 / Math.PI })), studio: s.studio, sky: s.sky?.colors ?? [], background: s.background, labels: [], images: [], robots: [],
      bounds: [s.bounds.min, s.bounds.max], drawing: false, files: [file] });
  }
  send("messages", message);
  send("state", { run: id, running: false });
}

// --- HTTP ---

const types = { ".html": "text/html; charset=utf-8", ".js": "text/javascript; charset=utf-8", ".css": "text/css; charset=utf-8", ".svg": "image/svg+xml" };

async function body(request) {
  const parts = [];
  for await (const p of request) parts.push(p);
  return Buffer.concat(parts).toString();
}

http.createServer(async (request, response) => {
  const url = new URL(request.url, "http://localhost");
  const answer = (status, value, headers = {}) => {
    response.writeHead(status, { "Content-Type": Buffer.isBuffer(value) ? "application/octet-stream" : "application/json", ...headers });
    response.end(Buffer.isBuffer(value) || typeof value === "string" ? value : JSON.stringify(value));
  };
  if (url.searchParams.get("t") === token) return answer(303, "", { Location: "/", "Set-Cookie": `cag-view=${token}; HttpOnly; SameSite=Strict` });
  if (!(request.headers.cookie ?? "").includes(`cag-view=${token}`)) return answer(403, { error: "wrong token" });
  const p = url.pathname, which = url.searchParams.get("path") ?? file;
  if (!p.startsWith("/api/")) {
    const name = p === "/" ? "index.html" : p.slice(1), at = path.join(here, "../dist", name + ".gz");
    if (!fs.existsSync(at)) return answer(404, { error: "not found" });
    return answer(200, gunzipSync(fs.readFileSync(at)), { "Content-Type": types[path.extname(name)], "Content-Security-Policy": "default-src 'self'" });
  }
  if (p === "/api/hello") return answer(200, { version: "mock", file, folder, readOnly: !!process.env.READ_ONLY, engine: "server", formats: [["stl", "mesh, binary STL"], ["glb", "scene, glTF"]], povray: true });
  if (p === "/api/events") {
    response.writeHead(200, { "Content-Type": "text/event-stream", "Cache-Control": "no-store" });
    for (const e of ["state", "scene", "messages"]) if (last[e]) response.write(`event: ${e}\ndata: ${JSON.stringify(last[e])}\n\n`);
    listeners.add(response);
    request.on("close", () => listeners.delete(response));
    return;
  }
  if (p === "/api/run") {
    const r = JSON.parse(await body(request)), id = ++run;
    answer(202, { run: id });
    return perform(id, r);
  }
  if (p.startsWith("/api/mesh/")) return meshes.has(p.slice(10)) ? answer(200, meshes.get(p.slice(10))) : answer(404, { error: "unknown mesh" });
  if (p === "/api/files") return answer(200, [{ path: file, version: version(fs.readFileSync(script)) }]);
  if (p === "/api/file") {
    const text = fs.readFileSync(path.join(folder, which), "utf8");
    if (request.method !== "PUT") return answer(200, text, { ETag: `"${version(text)}"`, "Content-Type": "text/plain; charset=utf-8" });
    const next = await body(request);
    if (request.headers["if-match"] !== `"${version(text)}"`) return answer(412, { version: version(text) });
    fs.writeFileSync(path.join(folder, which), next);
    return answer(200, { version: version(next) });
  }
  if (p === "/api/render") {
    const r = JSON.parse(await body(request)), id = ++job, out = path.join(scratch, `${id}.png`);
    answer(202, { job: id });
    send("progress", { job: id, percent: 10, phase: "rendering", done: false, error: null });
    const a = await call(["render", script, "-o", out, "--engine", r.engine, "--size", `${r.width}x${r.height}`, "--quality", r.quality]);
    jobs.set(id, out);
    return send("progress", { job: id, percent: 100, phase: "rendering", done: true, error: a.status ? a.stderr : null });
  }
  if (p.startsWith("/api/job/")) {
    const out = jobs.get(Number(p.slice(9)));
    return out && fs.existsSync(out) ? answer(200, fs.readFileSync(out), { "Content-Type": "image/png" }) : answer(404, { error: "not done" });
  }
  if (p === "/api/export") {
    const { format } = JSON.parse(await body(request)), out = path.join(scratch, `x.${format}`);
    await call(["export", script, "-o", out]);
    return answer(200, fs.readFileSync(out), { "Content-Disposition": `attachment; filename="x.${format}"` });
  }
  if (p === "/api/params") {
    const at = script + ".params.json";
    if (request.method === "PUT") fs.writeFileSync(at, await body(request));
    return answer(200, fs.existsSync(at) ? fs.readFileSync(at, "utf8") : "{}");
  }
  if (p === "/api/measure") return answer(200, { area: 1, volume: 2, centroid: [0, 0, 0], length: null, bounds: [[0, 0, 0], [1, 1, 1]], watertight: true });
  answer(501, { error: "not in the mock" });
}).listen(port, "127.0.0.1", () => console.log(`http://127.0.0.1:${port}/?t=${token}`));
perform(++run, {});
