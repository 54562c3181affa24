// The playground: the page with an engine in workers, the script in the fragment of the address, examples, and a tour.

import { byId, download, h } from "./dom.js";
import { workerEngine } from "./engine_worker.js";
import { readFragment, writeFragment } from "./fragment.js";
import { openGallery } from "./gallery.js";
import { showFailure, start } from "./page.js";
import { Tour } from "./tour.js";

const FIRST = "vase"; // the example of an address without a script
const FRAGMENT_PAUSE = 300; // milliseconds from the last run until the fragment follows
const SAVED = "cag:file:", SETS = "cag:sets:";

/**
 * @typedef {object} Example
 * @property {string} id  its path below examples/, without .cag
 * @property {string} title
 * @property {string} about
 * @property {string} group
 * @property {string} picture  "": none
 * @property {string[]} imports  paths of the files that it needs, below examples/
 */

/** What the browser keeps. Some browsers forbid it. @param {string} key */
function recall(key) {
  try {
    return localStorage.getItem(key);
  } catch {
    return null;
  }
}
/** @param {string} key @param {string} value */
function remember(key, value) {
  try {
    localStorage.setItem(key, value);
    return true;
  } catch {
    return false;
  }
}
function savedNames() {
  try {
    return Object.keys(localStorage).filter((k) => k.startsWith(SAVED)).map((k) => k.slice(SAVED.length)).sort();
  } catch {
    return [];
  }
}

/** @param {string} name  as given in an address */
function safeName(name) {
  const plain = name.split(/[\\/]/).pop()?.replace(/[^\p{L}\p{N}_. -]/gu, "") ?? "";
  return plain.endsWith(".cag") && !plain.startsWith(".") ? plain : "script.cag";
}

/** The texts of files below examples/. @param {string[]} paths */
const loadTexts = (paths) => Promise.all(paths.map(async (path) => {
  const answer = await fetch(new URL(`examples/${path}`, document.baseURI));
  if (!answer.ok) throw new Error(`${path} cannot be loaded`);
  return answer.text();
}));

/**
 * The files of the model by the fragment.
 *
 * @param {import("./fragment.js").Fragment} fragment
 * @param {Example[]} examples
 */
async function openModel(fragment, examples) {
  const saved = fragment.saved !== undefined ? recall(SAVED + fragment.saved) : null;
  const empty = fragment.text === undefined && saved === null;
  const example = examples.find((e) => e.id === (fragment.example ?? (empty ? FIRST : "")));
  /** @type {Record<string, string>} */
  const files = {};
  let file = safeName(fragment.name ?? fragment.saved ?? "script.cag");
  if (example) {
    const folder = example.id.replace(/[^/]*$/, "");
    file = `${example.id.slice(folder.length)}.cag`;
    const paths = [`${example.id}.cag`, ...example.imports], loaded = await loadTexts(paths);
    paths.forEach((path, i) => (files[path.slice(folder.length)] = loaded[i]));
  }
  const original = { ...files };
  Object.assign(files, fragment.files);
  files[file] = fragment.text ?? saved ?? files[file] ?? "";
  return { file, files, original, example: example?.id };
}

/** A short message at the bottom. @param {...(Node | string)} content */
function toast(...content) {
  const box = h("div", { class: "toast", role: "status" }, ...content);
  document.querySelector(".toast")?.remove();
  document.body.append(box);
  setTimeout(() => box.remove(), 8000);
}

const LACKS = [
  ["POV-Ray", "pictures are rendered by the built-in renderer"],
  ["OpenEXR", ".exr images are neither read nor written"],
  ["fonts of the system", "lettering has the compiled-in font, \"sans\""],
  ["files of your computer", "scripts read only the files of their example"],
  ["threads", "heavy scripts take about as long as with one processor, and memory ends at 800 MB"],
];

function aboutDialog() {
  const dialog = h("dialog", { "aria-label": "About the playground" }, h("form", { method: "dialog", class: "stack" },
    h("h2", {}, "The playground"),
    h("p", {}, "This page runs cag in your browser. Nothing is sent anywhere: the script is in the address, which you can copy or bookmark."),
    h("h3", {}, "What is missing"),
    h("ul", {}, ...LACKS.map(([what, instead]) => h("li", {}, h("strong", {}, what), `: ${instead}`))),
    h("div", { class: "row" }, h("button", {}, "Close"))));
  dialog.addEventListener("close", () => dialog.remove());
  document.body.append(dialog);
  dialog.showModal();
}

async function open() {
  const loading = fetch(new URL("examples.json", document.baseURI)).then((r) => r.json());
  /** @type {import("./fragment.js").Fragment} */
  let fragment = {}, problem = "";
  try {
    fragment = await readFragment(location.hash);
  } catch {
    problem = "The script in the address is damaged.";
  }
  /** @type {Example[]} */
  const examples = await loading.catch(() => []);
  const opened = await openModel(fragment, examples).catch((error) => {
    problem = `The example cannot be opened: ${error.message}.`;
    return openModel(fragment, []);
  });
  let texts = opened.files, writing = 0, writes = 0;

  const follow = async () => {
    const write = ++writes, changed = Object.entries(texts).filter(([path, text]) => path !== opened.file && text !== opened.original[path]);
    const own = texts[opened.file] !== opened.original[opened.file];
    if (!own && changed.length === 0 && !opened.example) return;
    const hash = await writeFragment({ example: opened.example, tour: tour.isOpen ? String(tour.at) : undefined, name: opened.example ? undefined : opened.file,
      text: own ? texts[opened.file] : undefined, files: Object.fromEntries(changed) });
    if (write === writes) history.replaceState(null, "", hash);
  };
  const engine = workerEngine({
    file: opened.file,
    files: { ...opened.files },
    changed: (files) => {
      const first = texts === opened.files && Object.keys(files).every((path) => files[path] === texts[path]);
      texts = files;
      clearTimeout(writing);
      if (!first) writing = window.setTimeout(follow, FRAGMENT_PAUSE);
    },
    saved: (path, text) => {
      const kept = remember(SAVED + path, text);
      toast(kept ? `${path} is saved in this browser. ` : `This browser does not save ${path}. `,
        h("button", { type: "button", onclick: () => download(path, new Blob([text], { type: "text/plain" })) }, "Download"));
    },
    sets: () => JSON.parse(recall(SETS + opened.file) ?? "{}"),
    writeSets: (sets) => void remember(SETS + opened.file, JSON.stringify(sets)),
  });

  const button = (/** @type {string} */ label, /** @type {string} */ title, /** @type {() => void} */ onclick) => h("button", { type: "button", class: "quiet", title, onclick }, label);
  const tour = new Tour(byId("code", HTMLElement), opened.file);
  const copy = async () => {
    await follow();
    await navigator.clipboard.writeText(location.href).then(() => toast("The address with the script is copied."), () => toast("The script is in the address of this page."));
  };
  byId("toggle-editor", HTMLButtonElement).before(
    button("Examples", "Open an example", () => openGallery(examples, savedNames())),
    button("Tour", "Getting started, step by step", () => tour.toggle()),
    button("Link", "Copy the address with the script", copy),
    button("Download", "Download the script", () => download(opened.file, new Blob([texts[opened.file]], { type: "text/plain" }))),
    button("About", "What the playground lacks", aboutDialog));
  addEventListener("hashchange", () => location.reload());
  byId("notice", HTMLParagraphElement).hidden = true;
  if (problem) toast(problem);
  if (fragment.tour !== undefined) tour.show(Number(fragment.tour) || 0);
  await start(engine);
}

open().catch(showFailure);
