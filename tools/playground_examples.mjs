// Writes the examples of the playground: a list, their texts in the folder `examples`, and a picture of each in the folder `pictures`.
//   node tools/playground_examples.mjs CAG OUT [--no-pictures]       CAG renders the pictures, two at a time
import { execFile } from "node:child_process";
import { copyFileSync, existsSync, mkdirSync, readdirSync, readFileSync, statSync, writeFileSync } from "node:fs";
import { dirname } from "node:path";
import { promisify } from "node:util";

const [cag, out, option] = process.argv.slice(2);
const run = promisify(execFile);
const FOLDER = "examples/";
const GROUPS = { "": "First examples", curves: "Curves", surfaces: "Surfaces and solids", robots: "Robots", sensing: "Sensing", "from-openscad": "From OpenSCAD" };
// The pictures are shown with 160 to 240 pixels.
const SIZE = "240x135";

const files = {}, examples = [];
for (const folder of Object.keys(GROUPS))
  for (const name of readdirSync(FOLDER + folder).sort().filter((n) => n.endsWith(".cag"))) {
    const path = folder ? `${folder}/${name}` : name;
    files[path] = readFileSync(FOLDER + path, "utf8");
  }
for (const [path, text] of Object.entries(files)) {
  const folder = path.replace(/[^/]*$/, ""), id = path.replace(/\.cag$/, ""), name = id.slice(folder.length);
  if (name === "stage") continue; // shows nothing
  const title = name[0].toUpperCase() + name.slice(1).replaceAll("_", " ");
  // The first sentence of the comment at the top.
  const comment = /^(\/\/.*\n)+/.exec(text)?.[0].replace(/^\/\/ ?/gm, "").replace(/\n(?!\n)/g, " ") ?? "";
  const about = /^(?:\S+\.cag: )?(.*?[.:?])(\s|$)/.exec(comment)?.[1].replace(/:$/, ".") ?? "";
  const imports = [...text.matchAll(/^import "([^"]+)"/gm)].map((m) => folder + m[1]);
  for (const i of imports) if (!files[i]) throw new Error(`${path} imports ${i}, which is not among the examples`);
  examples.push({ id, title, about, group: GROUPS[folder.replace(/\/$/, "")], picture: "", imports });
}
// The order of the README of the examples.
examples.sort((a, b) => (a.id === "vase" ? -1 : b.id === "vase" ? 1 : 0));

// A script of plane curves is drawn. Others are rendered.
async function picture(example) {
  const svg = `${FOLDER}${example.id}.svg`, target = `pictures/${example.id.replaceAll("/", "-")}`;
  if (existsSync(svg)) {
    copyFileSync(svg, `${out}/${target}.svg`);
    example.picture = `${target}.svg`;
    return;
  }
  const file = `${out}/${target}.png`, script = `${FOLDER}${example.id}.cag`;
  const time = example.id === "animation" ? ["-D", "time=0.06"] : [];
  if (!existsSync(file) || statSync(file).mtimeMs < statSync(script).mtimeMs)
    await run(cag, ["render", script, "-o", file, "--engine", "preview", "--size", SIZE, ...time]);
  example.picture = `${target}.png`;
}
mkdirSync(`${out}/pictures`, { recursive: true });
const left = option === "--no-pictures" ? [] : [...examples];
const work = async () => {
  for (let example; (example = left.shift()); )
    await picture(example).catch((error) => console.error(`no picture of ${example.id}: ${String(error.stderr ?? error).split("\n")[0]}`));
};
await Promise.all([work(), work()]);
writeFileSync(`${out}/examples.json`, JSON.stringify(examples));
for (const [path, text] of Object.entries(files)) {
  mkdirSync(dirname(`${out}/examples/${path}`), { recursive: true });
  writeFileSync(`${out}/examples/${path}`, text);
}
