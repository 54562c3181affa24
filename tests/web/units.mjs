// Tests of the page's modules that need no browser. Expected values are from formulas, written by hand.
//   node tests/web/units.mjs
import { Bvh } from "../../web/src/bvh.js";
import { isClosed } from "../../web/src/closed.js";
import { colorOf, scaleOf } from "../../web/src/colors.js";
import { floatsOf } from "../../web/src/engine.js";
import { operandsOf } from "../../web/src/faces.js";
import { formatNumber, formatPoint } from "../../web/src/format.js";
import { clampJoint, jointsExpression, rewriteJoint, roundJoint, sameJoints } from "../../web/src/joints.js";
import { MeshCache, readMesh } from "../../web/src/mesh.js";
import { marks } from "../../web/src/messages.js";
import { expressionOf, parseNumber, quote, settingOf, stepOf, unquote } from "../../web/src/params.js";
import { diffLines, offsetOf, paramValueRange, rangeOf } from "../../web/src/places.js";
import { columnOf, moveCoordinates, numberText, readNumber } from "../../web/src/point_numbers.js";
import { chainLength, circleOf, edgeChain, findingsOfTwo, flatFace, isStraight } from "../../web/src/recognize.js";
import { compose, RemoteEditor, RemoteFiles } from "../../web/src/remote_editor.js";
import { Runs } from "../../web/src/runs.js";
import { roundUp, scaleLength } from "../../web/src/scale.js";
import { sumByPart } from "../../web/src/section_curves.js";
import { valuesOf } from "../../web/src/surfaces.js";

let passed = 0, failed = 0;
async function test(name, body) {
  try {
    await body();
    passed++;
  } catch (error) {
    failed++;
    console.log(`FAILED: ${name}\n  ${error.stack}`);
  }
}
function equal(found, expected) {
  const a = JSON.stringify(found), b = JSON.stringify(expected);
  if (a !== b) throw new Error(`expected ${b}, found ${a}`);
}
function check(truth, what) {
  if (!truth) throw new Error(what);
}
function near(found, expected, tolerance = 1e-9) {
  if (!(Math.abs(found - expected) <= tolerance)) throw new Error(`expected ${expected}, found ${found}`);
}

// The bytes of a mesh, as the protocol describes them.
function encode({ positions, normals = null, triangles, labels = null, edges = [] }) {
  const words = [0x6d676163, 1, positions.length / 3, triangles.length / 3, edges.length / 2, (normals ? 1 : 0) | (labels ? 2 : 0), 0, 0];
  const floats = [...positions, ...(normals ?? [])], rest = [...triangles, ...(labels ?? []), ...edges];
  const buffer = new ArrayBuffer(4 * (words.length + floats.length + rest.length)), view = new DataView(buffer);
  words.forEach((w, i) => view.setUint32(4 * i, w, true));
  floats.forEach((f, i) => view.setFloat32(32 + 4 * i, f, true));
  rest.forEach((w, i) => view.setUint32(32 + 4 * (floats.length + i), w, true));
  return buffer;
}

// A box with 4 vertices for each side, as meshes with creases have them.
function box([w, d, h]) {
  const positions = [], triangles = [], edges = [], size = [w, d, h];
  for (let axis = 0; axis < 3; axis++)
    for (const side of [0, 1]) {
      const base = positions.length / 3, [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
      for (const [a, b] of [[0, 0], [1, 0], [1, 1], [0, 1]]) {
        const p = [0, 0, 0];
        p[axis] = side * size[axis];
        p[u] = a * size[u];
        p[v] = b * size[v];
        positions.push(...p);
      }
      const quad = side ? [0, 1, 2, 0, 2, 3] : [0, 2, 1, 0, 3, 2];
      triangles.push(...quad.map((i) => base + i));
      for (let i = 0; i < 4; i++) edges.push(base + i, base + ((i + 1) % 4));
    }
  return readMesh(encode({ positions, triangles, edges }));
}

const circle = (n, center, radius, part = 1) =>
  Array.from({ length: n + 1 }, (_, i) => {
    const angle = (2 * Math.PI * part * i) / n;
    return [center[0] + radius * Math.cos(angle), center[1] + radius * Math.sin(angle), center[2]];
  });

await test("a mesh is read as it was written", () => {
  const mesh = readMesh(encode({ positions: [0, 0, 0, 1, 0, 0, 0, 1, 0], normals: [0, 0, 1, 0, 0, 1, 0, 0, 1], triangles: [0, 1, 2], edges: [0, 1] }));
  equal([...mesh.positions], [0, 0, 0, 1, 0, 0, 0, 1, 0]);
  equal([...mesh.triangles], [0, 1, 2]);
  equal([...mesh.edges], [0, 1]);
});
await test("triangles of a label become adjacent", () => {
  const mesh = readMesh(encode({ positions: Array(18).fill(0), triangles: [0, 1, 2, 3, 4, 5, 1, 2, 3], labels: [7, 2, 7] }));
  equal(mesh.groups, [{ label: 2, start: 0, count: 1 }, { label: 7, start: 1, count: 2 }]);
  equal([...mesh.triangles], [3, 4, 5, 0, 1, 2, 1, 2, 3]);
});
await test("a truncated mesh is refused", () => {
  const whole = encode({ positions: [0, 0, 0, 1, 0, 0, 0, 1, 0], triangles: [0, 1, 2] });
  for (const size of [0, 31, whole.byteLength - 4]) {
    let refused = false;
    try {
      readMesh(whole.slice(0, size));
    } catch {
      refused = true;
    }
    equal(refused, true);
  }
});
await test("the cache releases the oldest meshes that are not shown", async () => {
  const released = [], cache = new MeshCache(async (id) => ({ id, bytes: 10 }), (m) => m.bytes, (m) => released.push(m.id), 20);
  for (const id of ["a", "b", "c", "d", "a"]) await cache.get(id);
  cache.trim(new Set(["d"]));
  equal(released, ["b"]); // a was used again
});
await test("a ray meets the near side of a box", () => {
  const mesh = box([4, 6, 8]), bvh = new Bvh(mesh.positions, mesh.triangles);
  near(bvh.cast([2, 3, 20], [0, 0, -1]).t, 12);
  near(bvh.cast([-10, 1, 1], [2, 0, 0]).t, 5); // in units of the direction
  equal(bvh.cast([5, 3, 20], [0, 0, -1]), null);
  near(bvh.cast([2, 3, 20], [0, 0, -1], (t) => t > 12.5).t, 20); // beyond a section plane
});
await test("rays meet a sphere of many triangles where the formula says", () => {
  const positions = [], triangles = [], n = 96;
  for (let i = 0; i <= n; i++)
    for (let j = 0; j <= n; j++) {
      const a = (Math.PI * i) / n, b = (2 * Math.PI * j) / n;
      positions.push(Math.sin(a) * Math.cos(b), Math.sin(a) * Math.sin(b), Math.cos(a));
      if (i < n && j < n) {
        const k = i * (n + 1) + j;
        triangles.push(k, k + n + 1, k + 1, k + 1, k + n + 1, k + n + 2);
      }
    }
  const bvh = new Bvh(Float32Array.from(positions), Uint32Array.from(triangles));
  for (let i = 0; i < 200; i++) {
    const x = 0.9 * Math.sin(12.9898 * i), y = 0.4 * Math.cos(78.233 * i);
    // The mesh is inside the sphere by at most the sagitta of a step, divided by the cosine of the slope.
    const height = Math.sqrt(1 - x * x - y * y), hit = bvh.cast([x, y, 5], [0, 0, -1]);
    near(hit.t, 5 - height, 2 * (1 - Math.cos(Math.PI / n)) / height);
  }
});
await test("a flat face has the area of all its triangles", () => {
  const mesh = box([4, 6, 8]), top = mesh.triangles.length / 3 - 1; // axis z, far side
  near(flatFace(mesh, top).area, 24, 1e-5);
  equal(flatFace(mesh, top).normal, [0, 0, 1]);
  near(flatFace(mesh, 0).area, 48, 1e-5);
});
await test("an edge of a box ends at its corners", () => {
  const { points, closed } = edgeChain(box([4, 6, 8]), 0);
  equal(closed, false);
  equal(points.length, 2);
});
await test("a box is closed, a box without a triangle or with one turned around is not", () => {
  const { positions, triangles } = box([4, 6, 8]), turned = triangles.slice();
  equal(isClosed(positions, triangles), true);
  equal(isClosed(positions, triangles.subarray(3)), false);
  [turned[0], turned[1]] = [turned[1], turned[0]];
  equal(isClosed(positions, turned), false);
  equal(isClosed(positions, new Uint32Array(0)), false);
});
await test("a circle is recognized, and its radius and center are right", () => {
  const found = circleOf(circle(24, [3, -2, 7], 12.5));
  near(found.radius, 12.5);
  near(Math.hypot(found.center[0] - 3, found.center[1] + 2, found.center[2] - 7), 0);
  near(Math.abs(found.axis[2]), 1);
});
await test("a quarter of a circle is an arc, an ellipse is none", () => {
  near(circleOf(circle(8, [0, 0, 0], 5, 0.25)).radius, 5);
  equal(circleOf(circle(24, [0, 0, 0], 5).map(([x, y, z]) => [x, 1.05 * y, z])), null);
  equal(circleOf([[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0], [4, 0, 0]]), null);
});
await test("points that a set operation adds on chords do not change the circle", () => {
  const rim = circle(24, [0, 0, 0], 5), points = rim.flatMap((p, i) => (i ? [p.map((x, k) => (x + rim[i - 1][k]) / 2), p] : [p]));
  near(circleOf(points).radius, 5);
});
await test("the rim of a disk is one closed chain", () => {
  const rim = circle(16, [0, 0, 0], 2).slice(0, 16).flat();
  const mesh = readMesh(encode({ positions: rim, triangles: [], edges: Array.from({ length: 16 }, (_, i) => [i, (i + 1) % 16]).flat() }));
  const { points, closed } = edgeChain(mesh, 3);
  equal([closed, points.length], [true, 17]);
  near(chainLength(points), 32 * 2 * Math.sin(Math.PI / 16), 1e-5); // of the inscribed polygon
  equal(isStraight(points), false);
});
await test("parallel faces have a perpendicular distance, and no angle", () => {
  const a = { kind: "face", at: [0, 0, 0], normal: [0, 0, 1], area: 1 }, b = { kind: "face", at: [3, 4, 12], normal: [0, 0, -1], area: 1 };
  const f = Object.fromEntries(findingsOfTwo(a, b).map((x) => [x.name, x.value]));
  near(f.distance, 13);
  near(f["perpendicular distance"], 12);
  near(f.angle, 0);
});
await test("an edge and a face meet at the angle to the plane", () => {
  const face = { kind: "face", at: [0, 0, 0], normal: [0, 0, 1], area: 1 }, edge = { kind: "edge", at: [0, 0, 0], from: [0, 0, 0], to: [1, 0, 1], length: Math.SQRT2 };
  near(findingsOfTwo(face, edge).find((f) => f.name === "angle").value, 45);
});
await test("columns count code points", () => {
  const text = "a = 1\n𝛼𝛽 = 2\n";
  equal(offsetOf(text, 2, 1), 6);
  equal(offsetOf(text, 2, 3), 10); // each letter has two UTF-16 units
  equal(rangeOf(text, { line: 2, column: 6, endLine: 2, endColumn: 7 }), [13, 14]);
  equal(offsetOf(text, 9, 1), text.length);
});
await test("the value of a param is found up to its range, description, or comment", () => {
  const value = (line, name) => {
    const text = `x = 1\n${line}\nparam other = 3`, r = paramValueRange(text, name);
    return r && text.slice(...r);
  };
  equal(value('param height = 140 in 80..220  "height, mm"', "height"), "140");
  equal(value('param glaze = "#0b7d85"        "color"', "glaze"), '"#0b7d85"');
  equal(value("param n = 2 * (3 + 1) // turns", "n"), "2 * (3 + 1)");
  equal(value('param t = "a {b("c")} // d"', "t"), '"a {b("c")} // d"');
  equal(value('param p = [1, 2] in [[1, 2], [3, 4]] "x"', "p"), "[1, 2]");
  equal(value("param inner = 5", "inner"), "5");
  equal(value("param x1 = 5", "x"), null);
});
await test("numbers with units are millimeters and degrees", () => {
  equal(parseNumber("2cm"), 20);
  equal(parseNumber("1in"), 25.4);
  equal(parseNumber("0.5turn"), 180);
  equal(parseNumber("-1_000.5e-1"), -100.05);
  equal(parseNumber("h / 2"), null);
});
await test("quotes are put around a text, and taken away", () => {
  const text = 'a "b" {c} \\ d';
  equal(quote(text), '"a \\"b\\" \\{c\\} \\\\ d"');
  equal(unquote(quote(text)), text);
});
await test("sets keep numbers and texts as JSON, and give expressions back", () => {
  const height = { kind: "number" }, title = { kind: "text" }, on = { kind: "bool" }, at = { kind: "other" };
  equal([settingOf(height, "2cm"), settingOf(title, '"abc"'), settingOf(on, "true"), settingOf(at, "[1, 2]")], [20, "abc", true, "[1, 2]"]);
  equal([expressionOf(height, 20), expressionOf(title, "abc"), expressionOf(on, true), expressionOf(at, "[1, 2]")], ["20", '"abc"', "true", "[1, 2]"]);
});
await test("sliders have round steps", () => {
  equal([stepOf(80, 220), stepOf(1.5, 8), stepOf(0, 1), stepOf(0, 100000)], [1, 0.05, 0.005, 500]);
});
await test("lengths are rounded to 1, 2, or 5", () => {
  equal([roundUp(0.11), roundUp(3), roundUp(5), roundUp(60)].map((x) => Number(x.toPrecision(3))), [0.2, 5, 5, 100]);
  equal([scaleLength(1), scaleLength(0.5), scaleLength(10)], [100, 50, 1000]); // at most 130 pixels
});
await test("numbers are written short", () => {
  equal([formatNumber(12.500001), formatNumber(1 / 3), formatNumber(1.2e-7), formatNumber(122000)], ["12.5", "0.33333", "1.2e-7", "122000"]);
  equal(formatPoint([1, -1e-9, 2.5]), "[1, 0, 2.5]");
});
await test("the mark under a line is as wide as its place", () => {
  equal(marks("show sphere(raduis)", { line: 2, column: 13, endLine: 2, endColumn: 19 }), "            ^^^^^^");
});
await test("the difference of two texts is the shortest", () => {
  const lines = diffLines("a\nb\nc\nd", "a\nx\nc\nd\ne");
  equal(lines.map((l) => l.kind + l.text), [" a", "-b", "+x", " c", " d", "+e"]);
  // Taking one side gives each text back.
  equal(lines.filter((l) => l.kind !== "+").map((l) => l.text).join("\n"), "a\nb\nc\nd");
  equal(lines.filter((l) => l.kind !== "-").map((l) => l.text).join("\n"), "a\nx\nc\nd\ne");
});

// An engine that runs one script at a time, when the test says so.
function runner() {
  const started = [];
  let number = 0;
  const runs = new Runs(async (coarse) => {
    started.push(coarse ? "coarse" : "fine");
    return ++number;
  }, (error) => {
    throw error;
  });
  const settle = () => new Promise((done) => setTimeout(done));
  return { runs, started, settle, end: async () => (runs.state({ run: number, running: false }), settle()) };
}
await test("a drag has one run under way, the latest state wins, and the end is fine", async () => {
  const { runs, started, settle, end } = runner();
  runs.drag();
  await settle();
  for (let i = 0; i < 10; i++) runs.drag();
  equal(started, ["coarse"]);
  await end();
  equal(started, ["coarse", "coarse"]);
  runs.drag();
  runs.drop();
  await end();
  equal(started, ["coarse", "coarse", "fine"]);
  await end();
  equal(started.length, 3);
});
await test("typing runs at once, and what was waiting is forgotten", async () => {
  const { runs, started, settle, end } = runner();
  runs.drag();
  await settle();
  runs.drag();
  runs.now();
  await settle();
  equal(started, ["coarse", "fine"]);
  await end();
  equal(started.length, 2);
});

// --- Joint values of robots ---

const turning = { name: "joint 1", kind: "revolute", unit: "deg", low: -114.59155902616465, high: 90, home: 0, value: 30, place: null };
const sliding = { name: "joint 2", kind: "prismatic", unit: "mm", low: 0, high: 150, home: 0, value: 12.5, place: null };
await test("joint values are rounded within their limits", () => {
  equal(roundJoint(turning, 12.34567), 12.3457);
  equal(roundJoint(turning, -114.59155902616465), -114.5915);
  equal(roundJoint(turning, 89.99999), 90);
  equal(roundJoint(turning, -200.00001), -200);
  equal(Object.is(roundJoint(turning, -0.00001), 0), true);
  equal([clampJoint(sliding, -3), clampJoint(sliding, 999), clampJoint(sliding, 7)], [0, 150, 7]);
});
await test("joint values are an expression of the language", () => {
  equal(jointsExpression([turning, sliding], [-45.00004, 1e-9]), "[-45deg, 0]");
  equal(jointsExpression([turning, sliding], [1 / 3, 149.99999]), "[0.3333deg, 150]");
  equal(jointsExpression([], []), "[]");
});
await test("numbers of the script keep their units", () => {
  equal(rewriteJoint("30deg", turning, -12.5), "-12.5deg");
  equal(rewriteJoint("- 30deg", { ...turning, value: -30 }, 45), "45deg");
  equal(rewriteJoint("0.25turn", { ...turning, value: 90 }, 45), "0.125turn");
  near(parseFloat(rewriteJoint("0.5235987756rad", turning, 60)), Math.PI / 3, 1e-6);
  equal(rewriteJoint("12.5", sliding, 20.1), "20.1");
  equal(rewriteJoint("1.25cm", sliding, 20), "2cm");
  equal(rewriteJoint("31deg", turning, 45), null);
  equal(rewriteJoint("angle", turning, 45), null);
  equal(rewriteJoint("", turning, 45), null);
});
await test("a robot is the same if its joints and their values in the script are", () => {
  equal(sameJoints([turning, sliding], [{ ...turning }, { ...sliding }]), true);
  equal(sameJoints([turning], [turning, sliding]), false);
  equal(sameJoints([turning], [{ ...turning, value: 31 }]), false);
  equal(sameJoints([turning], [{ ...turning, high: 80 }]), false);
});

// --- Surfaces ---

const base64 = (numbers) => Buffer.from(new Float32Array(numbers).buffer).toString("base64");

await test("floats are read from base64", () => {
  equal([...floatsOf(base64([1, -0.5, 3]))], [1, -0.5, 3]);
  equal([...floatsOf("")], []);
});

await test("operands of triangles follow the order in which they are drawn", () => {
  const answer = { mesh: "", operands: [0, 0, 1], faces: [2, 0, 1, 2] };
  equal([...operandsOf(answer, 3, null)], [0, 0, 2]);
  equal([...operandsOf(answer, 3, Uint32Array.of(2, 0, 1))], [2, 0, 0]);
});

await test("triangles sorted by label remember their order", () => {
  const data = readMesh(encode({ positions: [0, 0, 0, 1, 0, 0, 0, 1, 0], triangles: [0, 1, 2, 1, 2, 0, 2, 0, 1], labels: [7, 0, 7] }));
  equal([...data.order], [1, 0, 2]);
});

await test("principal curvatures follow from the mean and Gaussian ones", () => {
  // A torus of radii 5 and 2, outside: 1/2 and 1/7.
  const answer = { mesh: "", mean: base64([0.5 * (1 / 2 + 1 / 7), 0, 0]), gaussian: base64([1 / 14, 0, 0]) };
  near(valuesOf("max", answer, null)[0], 1 / 2, 1e-6);
  near(valuesOf("min", answer, null)[0], 1 / 7, 1e-6);
  equal([...valuesOf("deviation", { mesh: "", distance: base64([1, 2]) }, Uint32Array.of(1, 0))], [2, 2, 2, 1, 1, 1]);
});

await test("scales leave out rare extremes, and are symmetric if both signs occur", () => {
  const values = Float32Array.from({ length: 1001 }, (_, i) => i / 1000);
  values[1000] = 1e6;
  const scale = scaleOf([values], 98);
  near(scale.low, 0.01, 2e-3);
  near(scale.high, 0.99, 2e-3);
  equal(scaleOf([values], 100).high, 1e6);
  // What covers little counts little, however many values it has.
  equal(scaleOf([Float32Array.of(1, 2, 3, 90, 91, 92, 93)], 98, [Float32Array.of(5, 5, 5, 0.01, 0.01, 0.01, 0.01)]), { low: 1, high: 3, diverging: false });
  equal(scaleOf([Float32Array.of(-1, NaN, 4)], 100), { low: -4, high: 4, diverging: true });
  equal(scaleOf([Float32Array.of(NaN)], 100).diverging, false);
});

await test("the ends of a scale have its first and last color", () => {
  const scale = { low: -1, high: 1, diverging: true }, low = colorOf(scale, -1), beyond = colorOf(scale, -9), middle = colorOf(scale, 0);
  equal(beyond, low);
  check(low[2] > low[0] && Math.abs(middle[0] - middle[2]) < 0.02, "the colors are wrong");
  equal(colorOf({ low: 3, high: 3, diverging: false }, 3).every(Number.isFinite), true);
});

await test("section curves are summed by part", () => {
  const curve = (part, length, area) => ({ part, closed: area !== null, exact: true, length, area, points: "" });
  equal(sumByPart([curve("a", 3, 9), curve("a", 2, -4), curve("b", 1, null)]), [
    { part: "a", count: 2, length: 5, area: 5, exact: true }, { part: "b", count: 1, length: 1, area: null, exact: true }]);
});

// --- Numbers of points ---

const PLAIN = { unit: "", scale: 1 }, CM = { unit: "cm", scale: 10 };
const FRONT = { right: [1, 0, 0], up: [0, 0, 1], back: [0, -1, 0] };
// A point whose coordinates are those of the scene, scaled; null: computed.
const point = (numbers, scale = 1, moved = [false, false, false]) => ({ numbers, moved, map: [scale, 0, 0, 0, 0, scale, 0, 0, 0, 0, scale, 0] });

await test("numbers are rounded to a power of ten below a pixel", () => {
  const rows = [
    [12.3456, PLAIN, 0.05, "12.35"], [12.3456, PLAIN, 0.1, "12.35"], [12.3456, PLAIN, 0.11, "12.3"], [12.3, PLAIN, 3, "12"],
    [1234, PLAIN, 40, "1230"], [-0.001, PLAIN, 0.1, "0"], [-3.04, PLAIN, 0.5, "-3"], [-3.04, PLAIN, 0.02, "-3.04"], [100, PLAIN, 0.01, "100"],
    [25.4321, CM, 0.5, "2.54cm"], [25, CM, 0.5, "2.5cm"], [0.1 + 0.2, PLAIN, 0.001, "0.3"], [1e-7, PLAIN, 1e-8, "0.0000001"]];
  for (const [mm, number, pixel, expected] of rows) equal(numberText(mm, number, pixel), expected);
});
await test("numbers are read with their sign and unit", () => {
  const rows = [
    ["12.5", PLAIN, 12.5], ["-3", PLAIN, -3], ["- 3", PLAIN, -3], ["2.5cm", CM, 25], ["-1_000", PLAIN, -1000], ["1e2", PLAIN, 100], ["1.5e-1cm", CM, 1.5],
    ["2.5", CM, null], ["2.5cm", PLAIN, null], ["w", PLAIN, null], ["", PLAIN, null], ["3 + 4", PLAIN, null]];
  for (const [text, number, expected] of rows) equal(readNumber(text, number), expected);
});
await test("coordinates follow the picture, and depth stays where the picture leaves a choice", () => {
  const all = point([PLAIN, PLAIN, PLAIN], 2);
  moveCoordinates(all, [4, 0, 6], FRONT).forEach((x, k) => near(x, [2, 0, 3][k], 1e-6));
  // Only z is a number: the point moves along a line, to the height of the target.
  moveCoordinates(point([null, null, PLAIN]), [4, 5, 6], FRONT).forEach((x, k) => near(x, [0, 0, 6][k], 1e-4));
  // Of a line that is seen from above at an angle, what counts is where it is in the picture.
  const c = Math.SQRT1_2, above = { right: [1, 0, 0], up: [0, c, c], back: [0, -c, c] };
  moveCoordinates(point([null, null, PLAIN]), [0, 10 * c, 10 * c], above).forEach((x, k) => near(x, [0, 0, 10 / c][k], 1e-4));
  equal(moveCoordinates(point([null, null, null]), [1, 2, 3], FRONT), [0, 0, 0]);
  // Params move the rest.
  moveCoordinates(point([PLAIN, PLAIN, null], 1, [false, false, true]), [4, 0, 6], FRONT).forEach((x, k) => near(x, [4, 0, 6][k], 1e-6));
  equal(moveCoordinates(point([PLAIN, PLAIN, PLAIN], 0), [1, 2, 3], FRONT), [0, 0, 0]);
  equal(columnOf({ map: [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12] }, 1), [2, 6, 10]);
});

// --- Texts of another editor ---

const applied = (text, changes) => [...changes].sort((a, b) => b.from - a.from).reduce((t, c) => t.slice(0, c.from) + c.insert + t.slice(c.to), text);
await test("changes one after the other are the same as their composition", () => {
  let seed = 7;
  const random = (n) => (seed = (seed * 48271) % 2147483647) % n;
  for (let round = 0; round < 2000; round++) {
    const base = "abcdefghijklmnop".slice(0, random(17));
    let text = base, changes = [];
    for (let i = random(6) + 1; i > 0; i--) {
      const from = random(text.length + 1), change = { from, to: from + random(text.length - from + 1), insert: "XYZW".slice(0, random(5)) };
      changes = compose(changes, change);
      text = applied(text, [change]);
      equal(applied(base, changes), text);
      changes.slice(1).forEach((c, k) => equal(c.from > changes[k].to, true));
    }
  }
});

// An editor around the page that answers when it is told to.
function remote() {
  const posted = [], listeners = {}, asked = [], heard = [];
  const webview = {
    on: (type, listener) => (listeners[type] = listener), post: (type, fields) => posted.push({ type, ...fields }),
    ask: (type, fields) => new Promise((done) => asked.push({ type, ...fields, answer: done })),
  };
  const editor = new RemoteEditor(webview, "a.cag", (error) => heard.push(error.message));
  for (const topic of ["changed", "settled", "cursorMoved"]) editor[topic].on(() => heard.push(topic));
  const document = (text, dirty, version) => listeners.document({ document: { path: "a.cag", text, dirty, version } });
  return { editor, posted, listeners, asked, heard, document, soon: () => new Promise((done) => setTimeout(done)) };
}
await test("what is typed in another editor runs, and what is saved settles", () => {
  const { editor, heard, document } = remote();
  document("x = 1", false, 1);
  equal([heard, editor.unsaved], [[], null]);
  document("x = 2", true, 2);
  document("x = 2", true, 2);
  equal([heard, editor.unsaved], [["changed"], { "a.cag": "x = 2" }]);
  document("x = 2", false, 2);
  equal([heard, editor.unsaved], [["changed", "settled"], null]);
});
await test("changes of the page at one time are one step of the other editor", async () => {
  const { editor, asked, heard, document, soon } = remote();
  document("a = 1\nb = 2\n", false, 4);
  editor.replace("a.cag", 4, 5, "100");
  editor.replace("a.cag", 12, 13, "7");
  equal(editor.text("a.cag"), "a = 100\nb = 7\n");
  await soon();
  equal(asked.map(({ type, files }) => ({ type, files })), [{ type: "edit", files: [{ path: "a.cag", version: 4, changes: [
    { from: 4, to: 5, insert: "100", old: "1" }, { from: 10, to: 11, insert: "7", old: "2" }] }] }]);
  document("a = 100\nb = 7\n", true, 5);
  asked[0].answer({ problem: "", documents: [{ path: "a.cag", text: "a = 100\nb = 7\n", dirty: true, version: 5 }] });
  await soon();
  equal(heard, ["changed", "changed"]);
  editor.replace("a.cag", 4, 7, "1");
  await soon();
  equal(asked[1].files[0].version, 5);
});
await test("a drag is one step of the other editor, and a refused change is given up", async () => {
  const { editor, asked, heard, document, soon } = remote();
  document("a = 1\n", false, 1);
  for (const insert of ["2", "3", "1"]) editor.change("a.cag", [{ from: 4, to: 5, insert }], "hidden");
  await soon();
  equal(asked.length, 0);
  editor.change("a.cag", [{ from: 4, to: 5, insert: "9" }], "step");
  await soon();
  equal(asked[0].files[0].changes, [{ from: 4, to: 5, insert: "9", old: "1" }]);
  document("a = 1 // typed\n", true, 2);
  equal(editor.text("a.cag"), "a = 9\n");
  asked[0].answer({ problem: "changed meanwhile", documents: [{ path: "a.cag", text: "a = 1 // typed\n", dirty: true, version: 2 }] });
  await soon();
  equal(editor.text("a.cag"), "a = 1 // typed\n");
  equal(heard.includes("changed meanwhile"), true);
});
await test("files that the other editor has not open are read from the engine", async () => {
  const { editor, listeners, document, soon } = remote();
  let disk = "one";
  const files = new RemoteFiles({ read: async () => ({ text: disk, version: "" }) }, editor, () => {});
  await files.show("a.cag");
  equal(editor.text("a.cag"), "one");
  disk = "two";
  await files.changedOnDisk({ path: "a.cag" });
  equal(editor.text("a.cag"), "two");
  document("three", true, 1);
  await files.changedOnDisk({ path: "a.cag" });
  equal(editor.text("a.cag"), "three");
  listeners.closed({ path: "a.cag" });
  await soon();
  equal([editor.text("a.cag"), files.unsaved], ["two", null]);
});

console.log(`${passed} passed, ${failed} failed, 0 skipped`);
process.exit(failed ? 1 : 0);
