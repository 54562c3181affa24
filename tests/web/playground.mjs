// Compares the program as WebAssembly with the native one: all examples, limits, and wrong input. Runs in node, without a browser.
//   node tests/web/playground.mjs CAG CAG.MJS [--times]     --times also prints how long the examples take, in each, and includes slow ones
// The last line is `N passed, N failed, 0 skipped`.
import { execFileSync } from "node:child_process";
import { mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, resolve } from "node:path";
import { Program, crashOf } from "../../web/src/wasm_program.js";

const [cag, programPath, option] = process.argv.slice(2);
globalThis.self = { location: { href: "" } }; // emscripten looks for the worker that it is in
const { default: make } = await import(resolve(programPath));
const module = new WebAssembly.Module(readFileSync(`${dirname(programPath)}/cag.wasm`));

let passed = 0, failed = 0;
async function test(name, body) {
  try {
    await body();
    passed++;
  } catch (error) {
    failed++;
    console.log(`FAILED: ${name}\n  ${error.message}`);
  }
}
function equal(found, expected, what) {
  if (JSON.stringify(found) !== JSON.stringify(expected)) throw new Error(`${what}: expected ${JSON.stringify(expected)}, found ${JSON.stringify(found)}`);
}
const check = (truth, what) => {
  if (!truth) throw new Error(what);
};

/** Whether the server of the fonts can be reached. */
let fonts = true;

async function start() {
  const seen = { events: [], meshes: new Map() };
  const program = await Program.start(make, module, {
    event: (name, json) => seen.events.push([name, JSON.parse(json)]),
    hasMesh: () => false,
    keepMesh: (id, bytes) => seen.meshes.set(id, bytes),
    progress: () => {},
    font: (name) => (fonts ? readFileSync(`fonts/${name}`) : null),
  });
  const last = (name) => seen.events.filter(([n]) => n === name).pop()?.[1];
  let number = 0;
  const run = (files, script, request = {}) => {
    seen.events = [];
    seen.meshes.clear();
    program.setFiles(files);
    check(program.call(program.cag._playground_run, script, ++number, JSON.stringify(request)) === 1, "the request was refused");
    return { scene: last("scene"), messages: last("messages"), meshes: seen.meshes };
  };
  const runText = (text, request) => run({ "a.cag": text }, "a.cag", request);
  const ask = (name, ...values) => program.ask(program.cag[`_playground_${name}`], ...values);
  return { program, run, runText, ask };
}

const codeOf = ({ messages }) => messages.diagnostics.filter((d) => d.severity === "error").map((d) => d.code)[0] ?? "";

// --- The examples ---

const FOLDER = "examples/";
// These take from 5 to 50 seconds, most of them for meshes.
const SLOW = ["sensing/depth.cag", "robots/workspace.cag", "sensing/templates.cag", "surfaces/curvature_contours.cag",
  "from-openscad/projections.cag", "from-openscad/screw.cag"];
const scripts = ["", "curves", "surfaces", "robots", "sensing", "from-openscad"].flatMap((folder) =>
  readdirSync(FOLDER + folder).filter((n) => n.endsWith(".cag") && n !== "stage.cag").map((n) => (folder ? `${folder}/${n}` : n)))
  .filter((path) => option === "--times" || !SLOW.includes(path));

// Numbers that are computed in another order, by other libraries.
const close = (a, b, scale, tolerance) => Math.abs(a - b) <= tolerance * Math.max(scale, Math.abs(a));

/** The number of triangles, bounds, and enclosed volume of a binary .stl file. */
function readStl(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength), count = view.getUint32(80, true);
  const min = [Infinity, Infinity, Infinity], max = [-Infinity, -Infinity, -Infinity];
  let volume = 0;
  for (let i = 0; i < count; i++) {
    const p = [0, 1, 2].map((corner) => [0, 1, 2].map((axis) => view.getFloat32(84 + 50 * i + 12 + 12 * corner + 4 * axis, true)));
    for (const point of p) for (let axis = 0; axis < 3; axis++) {
      min[axis] = Math.min(min[axis], point[axis]);
      max[axis] = Math.max(max[axis], point[axis]);
    }
    const [a, b, c] = p;
    volume += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])) / 6;
  }
  return { count, min, max, volume };
}

function compareMeshes(found, expected) {
  const a = readStl(found), b = readStl(expected), size = Math.max(...b.max.map((x, i) => x - b.min[i]));
  for (const side of ["min", "max"]) check(a[side].every((x, i) => close(x, b[side][i], size, 1e-4)), `bounds ${a[side]} instead of ${b[side]}`);
  check(close(a.count, b.count, 100, 0.01), `${a.count} triangles instead of ${b.count}`);
  check(close(a.volume, b.volume, size ** 3 / 100, 1e-3), `volume ${a.volume} instead of ${b.volume}`);
}

const times = [], out = mkdtempSync(`${tmpdir()}/cag-playground-`), quiet = { encoding: "utf8", stdio: ["ignore", "pipe", "ignore"] };
const { run, ask } = await start();
for (const path of scripts)
  await test(`${path} is the same`, async () => {
    const folder = path.replace(/[^/]*$/, ""), name = path.slice(folder.length);
    const files = Object.fromEntries(readdirSync(FOLDER + folder).filter((n) => n.endsWith(".cag")).map((n) => [n, readFileSync(FOLDER + folder + n, "utf8")]));
    const begun = performance.now(), { messages, scene, meshes } = run(files, name), own = performance.now() - begun;
    check(messages.ok, JSON.stringify(messages.diagnostics));
    check(scene.parts.every((p) => meshes.has(p.mesh)), "a mesh is missing");
    const isDrawing = scene.parts.every((p) => p.type === "curve" || p.type === "region"), format = isDrawing ? "svg" : "stl";
    const before = performance.now();
    const prints = execFileSync(cag, ["export", FOLDER + path, "-o", `${out}/a.${format}`], quiet);
    times.push([path, own, performance.now() - before]);
    const lines = prints.split("\n").slice(0, messages.prints.length);
    check(lines.every((line, i) => sameText(line, messages.prints[i])), `prints ${JSON.stringify(messages.prints)} instead of ${JSON.stringify(lines)}`);
    const found = ask("export", name, format).bytes, expected = readFileSync(`${out}/a.${format}`);
    if (isDrawing) check(close(found.length, expected.length, 200, 0.02), `a drawing of ${found.length} bytes instead of ${expected.length}`);
    else compareMeshes(found, expected);
  });

// Numbers in texts may differ in their last digits.
function sameText(a, b) {
  const number = /-?\d+(\.\d+)?(e-?\d+)?/g;
  if (a.replace(number, "#") !== b.replace(number, "#")) return false;
  const x = a.match(number) ?? [], y = b.match(number) ?? [];
  return x.every((t, i) => Math.abs(t - y[i]) <= 1e-4 * Math.max(Math.abs(t), 1));
}

// --- Lettering ---

// Each line gives the measures of one or more texts.
const LETTERS = {
  "all styles": `[for style in ["regular", "bold", "italic", "bold italic"]: each(lettering("Quick größe Ωλ Жя 0123 fi", style: style))]`,
  "metrics": `[for style in ["regular", "bold", "italic", "bold italic"]: lettering_metrics("Ágy שלום", size: 7, style: style)]`,
  "kerning": 'each(lettering("AVATAR To. Ty, P.")), each(lettering("AVATAR To. Ty, P.", spacing: 1.2))',
  "Hebrew with points, digits, and Latin letters": 'each(lettering("שָׁלוֹם abc (12) בְּרֵאשִׁית"))',
  "combining marks": 'each(lettering("e\\u{301} x\\u{323}\\u{308} \\u{41d}\\u{301}"))',
  "spaces and fractions": 'each(lettering("1\\u{2044}2 x\\u{2009}y\\u{a0}z\\u{2003}."))',
  "several lines": 'each(lettering("one\\ntwo lines\\n\\nand three", align: "center", valign: "middle", line_spacing: 1.3))',
  "broken lines": 'each(lettering("A longer text that is broken - twice", width: 60, align: "right"))',
  "other directions": 'each(lettering("down שלום", direction: "ttb")), each(lettering("(left)", direction: "rtl"))',
  "along a curve": 'each(lettering("on a ring", along: circle(15)))',
};
for (const [name, values] of Object.entries(LETTERS))
  await test(`lettering is the same: ${name}`, async () => {
    const text = `each(r) = [area(r), length(r), bounds(r).min, bounds(r).max]\nprint ${values}\n`, path = `${out}/a.cag`;
    writeFileSync(path, text);
    const { messages } = (await start()).runText(text);
    check(messages.ok, JSON.stringify(messages.diagnostics));
    equal(messages.prints.join("\n"), execFileSync(cag, ["run", path], quiet).trimEnd(), "prints");
  });
await test("fonts: those of the playground, and no others", async () => {
  const { runText } = await start();
  equal(runText("print fonts() == [for s in [\"regular\", \"bold\", \"italic\", \"bold italic\"]: {name: \"sans\", style: s, file: none}]").messages.prints, ["true"], "fonts");
  const { diagnostics } = runText('print lettering("A", font: "No Such Font")').messages;
  equal([diagnostics[0].code, diagnostics[0].help], ["E0860", 'use "sans", the only font of the playground'], "another font");
  equal(codeOf(runText('print lettering("漢")')), "E0862", "a character without a glyph");
});
await test("a font that cannot be loaded is an error, and is loaded later", async () => {
  const { runText } = await start(), script = 'print lettering_metrics("H").height';
  fonts = false;
  equal(codeOf(runText(script)), "E0861", "code");
  fonts = true;
  equal(runText(script).messages.ok, true, "the next run");
});
rmSync(out, { recursive: true });

// --- Limits ---

// A crash is not allowed: the program must go on after each of these.
const one = await start();
const DEEP = {
  "a function that calls itself": "f(n) = 1 + f(n + 1)\nprint f(0)",
  "functions that call each other through map": "f(n) = sum(map([n], g))\ng(n) = 1 + f(n + 1)\nprint f(0)",
  "a comprehension in a function": "f(n) = sum([for x in [n]: f(x + 1)])\nprint f(0)",
  "a curve whose formula needs a curve": "c(n) = curve(t => c(n + 1)(t), 0..1)\nprint c(0)(0.5)",
  "folds": "f(n) = reduce([n], 0, (a, x) => a + f(x + 1))\nprint f(0)",
  "sorting": "f(n) = sort([n, n + 1], x => f(x + 1))\nprint f(0)",
  "solve": "f(n) = solve(x => f(n + 1) + x, 0..1)\nprint f(0)",
  "integrals": "f(n) = integrate(x => f(n + 1), 0, 1)\nprint f(0)",
};
for (const [name, text] of Object.entries(DEEP))
  await test(`endless recursion is an error: ${name}`, async () => {
    const code = codeOf(one.runText(text));
    check(/^E0\d{3}$/.test(code) && code !== "E0001", `code ${code}`);
    if (option === "--times") console.log(`${name}: ${code}`);
    equal(one.runText("print 1").messages.prints, ["1"], "the next run");
  });
await test("deep nesting is read", async () => {
  const deep = (n) => "(".repeat(n) + "1" + ")".repeat(n);
  equal(one.runText(`print ${deep(900)}`).messages.prints, ["1"], "900 parentheses");
  check(codeOf(one.runText(`print ${deep(100000)}`)).startsWith("E"), "100000 parentheses are no error");
  check(codeOf(one.runText(`print ${"[".repeat(100000)}`)).startsWith("E"), "100000 brackets are no error");
  one.runText(`print ${"-".repeat(100000)}1`);
  equal(one.runText("print 1").messages.prints, ["1"], "the next run");
});
await test("nested values", async () => {
  const { messages } = one.runText("nest(v, n) = if n == 0 then v else nest([v], n - 1)\nprint length(nest([1], 9000))");
  check(messages.ok || /^E/.test(messages.diagnostics[0].code), "a crash");
  one.runText("nest(v, n) = if n == 0 then v else nest([v], n - 1)\nprint nest([1], 100000)");
  equal(one.runText("print 1").messages.prints, ["1"], "the next run");
});
await test("exhausted memory is an error", async () => {
  equal(codeOf(one.runText("f(v, n) = if n == 0 then v else f([...v, ...v], n - 1)\nprint f([1, 2, 3], 40)")), "E0602", "code");
  equal(one.runText("print 1").messages.prints, ["1"], "the next run");
});

// --- Wrong input ---

await test("wrong requests are refused", async () => {
  for (const request of ["", "[]", "{", "null", "3"]) equal(one.program.call(one.program.cag._playground_run, "a.cag", 1, request), 0, request);
  equal(codeOf(one.runText("print 1", { params: { nothing: "1" } })).startsWith("E"), true, "an unknown param");
  equal(codeOf(one.runText("param a = 1 in 0..2\nprint a", { params: { a: "5" } })).startsWith("E"), true, "a wrong value");
  equal(one.runText("param a = 1 in 0..2\nprint a", { params: { a: "1.5" } }).messages.prints, ["1.5"], "a value");
});
await test("errors have places", async () => {
  const { messages } = one.runText("print sin(30)\n");
  equal([messages.ok, messages.diagnostics[0].code, messages.diagnostics[0].line, messages.diagnostics[0].column], [false, "E0301", 1, 11], "the error");
});
await test("what is missing is said", async () => {
  one.runText("show sphere(10)");
  const refusal = (...call) => {
    try {
      one.ask(...call);
      return "";
    } catch (error) {
      check(crashOf(error) === null, `a crash: ${error}`);
      return error.message;
    }
  };
  const shows = (pattern, ...call) => check(pattern.test(refusal(...call)), `${call}: ${refusal(...call)}`);
  shows(/POV-Ray is not installed/, "picture", JSON.stringify({ engine: "povray", width: 8, height: 8 }));
  shows(/expected a format/, "export", "a.cag", "nothing");
  shows(/no such part/, "measure", "a.cag", "nothing");
  shows(/expected a JSON object/, "picture", "[");
  shows(/no documentation/, "document", "nothing");
  one.runText("show image([[0, 1], [1, 0]])");
  shows(/no OpenEXR/, "export", "a.cag", "exr");
  const { messages } = one.run({ "a.cag": 'show read_image("a.exr")', "a.exr": "\x76\x2f1\x01" }, "a.cag");
  check(!messages.ok, "an .exr file was read");
});
await test("exports, pictures, and texts", async () => {
  check(one.runText("show box([10, 20, 30])").messages.ok, "the run");
  const show = (a) => new TextDecoder().decode(a.bytes);
  for (const format of ["stl", "obj", "ply", "glb", "3mf", "step", "igs", "pov", "json"]) {
    const answer = one.ask("export", "a.cag", format);
    check(answer.bytes.length > 100 && answer.name === `a.${format}`, format);
  }
  equal(one.ask("export", "a.cag", "stl").bytes.length, 84 + 12 * 50, "bytes of .stl");
  const picture = one.ask("picture", JSON.stringify({ engine: "preview", quality: "draft", width: 32, height: 24 }));
  equal([...picture.bytes.slice(1, 4)], [80, 78, 71], "PNG");
  equal(show(one.ask("format", "a.cag", "a=1\n")), "a = 1\n", "a text in the standard layout");
  check(/revolve\(/.test(show(one.ask("document", "revolve"))), "documentation");
  check(JSON.parse(show(one.ask("hello", "a.cag"))).engine === "worker", "hello");
});

if (option === "--times") {
  times.sort((a, b) => b[1] - a[1]);
  for (const [path, own, native] of times.slice(0, 12)) console.log(`${path.padEnd(36)} ${own.toFixed(0).padStart(6)} ms, first run   ${native.toFixed(0).padStart(6)} ms natively`);
}
console.log(`${passed} passed, ${failed} failed, 0 skipped`);
process.exit(failed ? 1 : 0);
