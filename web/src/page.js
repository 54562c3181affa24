// The page of cag view: makes its parts and connects them.

import { Controls, viewOfKey } from "./controls.js";
import { byId, h } from "./dom.js";
import { listenEarly } from "./engine.js";
import { serverEngine } from "./engine_server.js";
import { Files } from "./files.js";
import { formatSize } from "./format.js";
import { Handles } from "./handles.js";
import { Layout } from "./layout.js";
import { MeasurePanel } from "./measure_panel.js";
import { MessagesPanel } from "./messages.js";
import { STANDARD_VIEWS } from "./orbit.js";
import { OutputPanel } from "./output_panel.js";
import { Overlay } from "./overlay.js";
import { ParamsPanel } from "./params.js";
import { PartsPanel } from "./parts_panel.js";
import { offsetOf, paramValueRange, rangeOf, shownExpression } from "./places.js";
import { PointTool } from "./point_tool.js";
import { Runs } from "./runs.js";
import { SectionPanel } from "./section_panel.js";
import { SelectionPanel } from "./selection_panel.js";
import { TimeBar } from "./time_bar.js";
import { View } from "./view.js";

const TYPING_PAUSE = 200; // milliseconds from the last key to the run
const EDITOR_AFTER = 400; // milliseconds to wait for the first picture, at most
const NEW_SCRIPT = "untitled.cag";

/** @typedef {import("./engine.js").SceneMessage} SceneMessage */
/** @typedef {import("./engine.js").Place} Place */

/** @param {import("./engine.js").Engine} engine */
async function start(engine) {
  const helloLater = engine.hello(), listen = listenEarly(engine);
  const root = document.documentElement;
  const scene = byId("scene", HTMLDivElement), notice = byId("notice", HTMLParagraphElement), status = byId("status", HTMLSpanElement);
  const canvas = byId("canvas", HTMLCanvasElement), over = byId("over", HTMLDivElement);
  const view = new View(canvas, (id) => engine.mesh(id));
  const hello = await helloLater;
  const overlay = new Overlay(over, view), handles = new Handles(over, view), controls = new Controls(scene, view);
  const layout = new Layout(() => view.invalidate());
  /** @type {Files | null} */
  let files = null;
  /** @type {import("./editor.js").Editor | null} */
  let editor = null;
  /** The newest that arrived. @type {{ scene: SceneMessage | null, messages: import("./engine.js").RunMessages | null }} */
  const newest = { scene: null, messages: null };

  const report = (/** @type {Error} */ error) => messages.problem(error.message);
  const say = (/** @type {string} */ text) => {
    notice.textContent = text;
    notice.hidden = text === "";
  };
  const textOf = (/** @type {string} */ path) => editor?.text(path) ?? "";
  const excerpt = (/** @type {Place} */ place) => textOf(place.file).slice(...rangeOf(textOf(place.file), place));
  const lineOf = (/** @type {string} */ path, /** @type {number} */ line) => {
    const text = textOf(path), from = offsetOf(text, line, 1), end = text.indexOf("\n", from);
    return text.slice(from, end < 0 ? undefined : end);
  };

  const messages = new MessagesPanel(byId("messages", HTMLDivElement), status, lineOf);

  // --- Scenes that arrive ---

  let showing = 0; // to forget scenes that newer ones overtook while their meshes were loaded
  /** Resolves with false if a mesh is missing. @type {(scene: SceneMessage) => Promise<boolean>} */
  const showScene = async (message) => {
    const turn = ++showing;
    newest.scene = message;
    try {
      const shapes = await view.parts.load(message);
      if (turn !== showing) return true;
      const first = view.message === null;
      view.show(message, shapes);
      overlay.show(message);
      canvas.classList.remove("stale");
      say(message.parts.length === 0 && message.images.length === 0 ? "The script shows nothing." : "");
      if (first) {
        view.draw();
        performance.mark("cag-first-picture");
      }
      root.dataset.run = String(message.run);
      for (const panel of panels) panel(message);
      return true;
    } catch (error) {
      if (turn === showing) report(/** @type {Error} */ (error));
      return false;
    }
  };
  /** What else shows a scene. @type {((scene: SceneMessage) => void)[]} */
  const panels = [];

  const file = hello.file || NEW_SCRIPT, canSave = !hello.readOnly && !hello.untitled;
  document.title = `${file} - cag`;
  byId("title", HTMLSpanElement).textContent = file;
  if (hello.readOnly) layout.readOnly();

  // --- Runs ---

  const params = new ParamsPanel(byId("params", HTMLDivElement), engine, { readOnly: hello.readOnly, report });
  const timeBar = new TimeBar(byId("time", HTMLDivElement));
  const runs = new Runs(async (coarse) => {
    const frame = timeBar.frame;
    const run = await engine.run({ files: files?.unsaved ?? null, params: params.values, ...timeBar.request, coarse });
    timeBar.sent(run, frame, coarse);
    return run;
  }, report);
  runs.busy.on((busy) => status.classList.toggle("busy", busy));
  params.changed.on((dragging) => {
    timeBar.forget();
    if (dragging) runs.drag();
    else runs.drop();
  });
  timeBar.changed.on(({ dragging }) => {
    const run = () => (dragging ? runs.drag() : runs.drop());
    const known = timeBar.known;
    if (!known) return run();
    // The engine may have forgotten the meshes of long ago.
    showScene(known).then((shown) => shown || (timeBar.forget(), run()));
  });
  params.writeWanted.on(() => writeParams());
  params.loadSets();

  /** Puts the values of the params into the script, as changes that can be undone. */
  function writeParams() {
    if (!editor) return;
    for (const param of params.params) {
      const value = params.values[param.name], path = param.place?.file ?? file, text = editor.text(path);
      const range = value !== undefined && text !== null ? paramValueRange(text, param.name) : null;
      if (range) {
        editor.replace(path, range[0], range[1], value);
        delete params.values[param.name];
      }
    }
    params.refresh();
    runs.now();
  }

  // --- Panels ---

  const partsPanel = new PartsPanel(byId("parts", HTMLDivElement), view);
  const selection = new SelectionPanel(byId("selection", HTMLDivElement), engine, excerpt);
  const sectionPanel = new SectionPanel(byId("section", HTMLDivElement), view, handles);
  const points = new PointTool({
    engine, view, handles, params, readOnly: hello.readOnly, file, note: byId("selection", HTMLDivElement), report, pending: () => runs.pending,
    run: (dragging) => {
      timeBar.forget();
      if (dragging) runs.drag();
      else runs.drop();
    },
  });
  runs.busy.on((busy) => !busy && points.held && points.update());
  const measure = new MeasurePanel(byId("measure", HTMLDivElement), over, view);
  const output = new OutputPanel(byId("output", HTMLDivElement), engine, hello, view, report);
  panels.push(
    (m) => params.show(m.params, !runs.pending), (m) => timeBar.show(m.timed), () => partsPanel.show(), () => sectionPanel.show(), (m) => output.show(m),
    (m) => files?.list(m.files ?? []), (m) => fillViews(m), () => markTools(), (m) => timeBar.arrived(m), () => keepSelection(), () => showMade(), () => points.on && points.update());

  /** The expression of a part, "" if there is none to write. @param {import("./engine.js").Part} part */
  function expressionOf(part) {
    if (/^[\p{L}_][\p{L}\p{N}_]*$/u.test(part.name) && new RegExp(`^\\s*${part.name}\\s*=`, "mu").test(textOf(newest.scene?.script ?? file))) return part.name;
    const show = part.origin.find((o) => o.what === "show");
    return show ? shownExpression(excerpt(show)) : "";
  }

  let selected = ""; // the parts whose points are shown
  /** @param {string[]} names */
  function select(names) {
    view.selected = names;
    const part = view.parts.views.get(names[names.length - 1])?.part ?? null;
    selection.show(part, part ? expressionOf(part) : "", !runs.coarse);
    partsPanel.refresh();
    if (points.on && names.join() !== selected) points.update();
    selected = names.join();
    view.invalidate();
    return part;
  }
  /** After a run, what was selected is measured again. */
  function keepSelection() {
    const names = view.selected.filter((n) => view.parts.views.has(n));
    if (names.length || view.selected.length) select(names);
  }
  /** @param {string} name @param {boolean} more */
  function selectOne(name, more) {
    select(!more ? [name] : view.selected.includes(name) ? view.selected.filter((n) => n !== name) : [...view.selected, name]);
    openPanel("selection");
  }
  /** @param {string[]} names */
  const point = (names) => {
    if (names.join() === view.pointed.join()) return;
    view.pointed = names;
    view.invalidate();
  };
  partsPanel.picked.on(({ name, more }) => selectOne(name, more));
  partsPanel.pointed.on((name) => point(name ? [name] : []));
  controls.clicked.on(({ x, y, event }) => {
    if (measure.active) return measure.click(x, y);
    const hit = view.pick(x, y);
    if (hit) selectOne(hit.view.part.name, event.shiftKey);
    else if (!event.shiftKey) select([]);
  });
  controls.doubleClicked.on(({ x, y }) => {
    const origin = view.pick(x, y)?.view.part.origin ?? [];
    const made = origin.filter((o) => !o.library);
    if (made.length) goTo(made[made.length - 1]);
  });
  controls.hovered.on((at) => {
    if (measure.active) return measure.hover(at);
    const part = at ? view.pick(at.x, at.y)?.view.part : undefined;
    point(part ? [part.name] : made);
    overlay.point(part ? `${part.name} · ${part.type} · ${formatSize(part.bounds)}` : "", at?.x ?? 0, at?.y ?? 0);
  });

  // --- Places ---

  /** @param {Place} place */
  async function goTo(place) {
    if (!files || !editor) return;
    if (document.body.classList.contains("no-editor") && !hello.readOnly) layout.toggle("editor");
    try {
      await files.show(place.file);
      editor.select(place);
    } catch (error) {
      report(/** @type {Error} */ (error));
    }
  }
  for (const topic of [selection.placeWanted, messages.placeWanted]) topic.on(goTo);

  /** What the line of the cursor made. @type {string[]} */
  let made = [];
  function showMade() {
    if (!editor) return;
    const parts = newest.scene?.parts ?? [], path = editor.path, line = editor.line();
    made = parts.filter((p) => p.origin.some((o) => o.file === path && o.line <= line && line <= o.endLine)).map((p) => p.name);
    // A line that made everything tells nothing.
    if (made.length === parts.length && parts.length > 1) made = [];
    point(made);
  }

  // --- View ---

  const views = byId("views", HTMLSelectElement);
  /** @param {SceneMessage} m */
  function fillViews(m) {
    const options = STANDARD_VIEWS.map((v, i) => h("option", { value: v }, `${v} (${i + 1})`));
    const cameras = m.cameras.filter((c) => !c.automatic).map((c) => h("option", { value: `camera ${c.name}` }, c.name));
    views.replaceChildren(h("option", { value: "" }, "View"), h("optgroup", { label: "Standard views" }, ...options));
    if (cameras.length) views.append(h("optgroup", { label: "Cameras of the script" }, ...cameras));
  }
  /** @param {import("./orbit.js").StandardView} name */
  const look = (name) => {
    view.look(name);
    view.fit();
  };
  views.addEventListener("change", () => {
    const camera = /^camera (.*)$/.exec(views.value)?.[1];
    if (camera !== undefined) view.through(camera);
    else if (views.value) look(/** @type {import("./orbit.js").StandardView} */ (views.value));
    views.value = "";
    markTools();
  });

  const { parts, stage } = view;
  /** The switches of the toolbar. @type {Record<string, { is: () => boolean, set: (on: boolean) => void }>} */
  const switches = {
    orthographic: { is: () => view.orbit.orthographic, set: (on) => (view.orbit.orthographic = on) },
    edges: { is: () => parts.display.edges, set: (on) => (parts.display.edges = on) },
    wireframe: { is: () => parts.display.wireframe, set: (on) => (parts.display.wireframe = on) },
    oneSided: { is: () => parts.display.oneSided, set: (on) => (parts.display.oneSided = on) },
    grid: { is: () => stage.grid, set: (on) => (stage.grid = on) },
    backdrop: { is: () => stage.backdrop, set: (on) => (stage.backdrop = on) },
    shadows: { is: () => stage.shadows, set: (on) => (stage.shadows = on) },
    section: { is: () => view.section.on, set: (on) => (sectionPanel.toggle(on), on && openPanel("section")) },
    points: { is: () => points.on, set: (on) => (points.toggle(on), on && openPanel("selection")) },
    measure: { is: () => measure.active, set: (on) => (measure.toggle(on), on && openPanel("measure")) },
  };
  /** @param {string} name */
  function flip(name) {
    if (name === "fit") return view.fit(view.selected);
    const one = switches[name];
    one.set(!one.is());
    parts.refresh();
    view.changed();
    markTools();
  }
  // Buttons of the toolbar, and switches of a panel.
  const tools = /** @type {NodeListOf<HTMLButtonElement | HTMLInputElement>} */ (document.querySelectorAll("[data-do]"));
  function markTools() {
    for (const tool of tools) {
      const one = switches[tool.dataset.do ?? ""];
      if (tool instanceof HTMLInputElement) tool.checked = one.is();
      else if (one) tool.setAttribute("aria-pressed", String(one.is()));
    }
  }
  for (const tool of tools) tool.addEventListener(tool instanceof HTMLInputElement ? "change" : "click", () => flip(tool.dataset.do ?? ""));
  measure.toggled.on((on) => {
    point([]);
    scene.classList.toggle("measuring", on);
    overlay.point("", 0, 0);
    markTools();
  });
  byId("section", HTMLDivElement).addEventListener("change", markTools);
  /** @param {string} id */
  function openPanel(id) {
    const details = byId(id, HTMLDivElement).closest("details");
    if (!details) return;
    details.open = true;
    details.scrollIntoView({ block: "nearest" });
  }

  // --- Keys ---

  /** @type {Record<string, () => void>} */
  const keys = {
    f: () => flip("fit"), o: () => flip("orthographic"), l: () => flip("edges"), w: () => flip("wireframe"), b: () => flip("oneSided"),
    g: () => flip("grid"), k: () => flip("backdrop"), s: () => flip("shadows"), m: () => flip("measure"), x: () => flip("section"), d: () => flip("points"),
    e: () => hello.readOnly || layout.toggle("editor"), p: () => layout.toggle("side"), u: () => partsPanel.showAll(),
    h: () => chooseSelected((n) => parts.hidden.add(n)), t: () => chooseSelected((n) => parts.glass.delete(n) || parts.glass.add(n)),
    a: () => chooseSelected((n) => (parts.alone = parts.alone === n ? null : n)),
    " ": () => byId("time", HTMLDivElement).hidden || timeBar.toggle(), "?": () => keyDialog.showModal(),
    Escape: () => (measure.active ? measure.toggle(false) : select([])),
  };
  /** @param {(name: string) => void} choose */
  function chooseSelected(choose) {
    view.selected.forEach(choose);
    partsPanel.update();
  }
  const keyDialog = byId("keys", HTMLDialogElement);
  byId("help-button", HTMLButtonElement).addEventListener("click", () => keyDialog.showModal());
  addEventListener("keydown", (e) => {
    if ((e.ctrlKey || e.metaKey) && e.key === "s") {
      e.preventDefault();
      files?.save();
    }
    const target = e.target instanceof Element ? e.target : null;
    const typing = editor?.hasFocus() || target?.closest("input:not([type=range]):not([type=checkbox]), select, textarea, dialog");
    // What was dragged in the scene is undone there, too.
    const undone = e.key.toLowerCase() === "z" || e.key === "y";
    if ((e.ctrlKey || e.metaKey) && undone && !typing && !hello.readOnly && !points.dragging) {
      e.preventDefault();
      editor?.undo(e.shiftKey || e.key === "y");
    }
    // Space presses the button that has the focus.
    const pressed = e.key === " " && target?.closest("button, summary, input");
    if (e.ctrlKey || e.metaKey || e.altKey || typing || pressed || e.defaultPrevented) return;
    const standard = viewOfKey(e.key), act = standard ? () => look(standard) : keys[e.key.length === 1 ? e.key.toLowerCase() : e.key];
    if (!act) return;
    e.preventDefault();
    act();
  });
  markTools();

  // --- Events ---

  let connected = false;
  listen({
    state: (state) => runs.state(state),
    scene: (message) => showScene(message),
    messages: (m) => {
      messages.show(m);
      editor?.setProblems(m.diagnostics);
      canvas.classList.toggle("stale", !m.ok);
      root.dataset.ok = String(m.ok);
      if (!m.ok) timeBar.stop();
      newest.messages = m;
    },
    file: (change) => files?.changedOnDisk(change),
    progress: (p) => output?.progress(p),
    connection: (on, problem) => {
      if (on && !connected) runs.restart();
      connected = on;
      say(problem);
    },
  });
  // --- Editor ---

  await Promise.race([firstPicture(view), new Promise((done) => setTimeout(done, EDITOR_AFTER))]);
  const { Editor } = /** @type {typeof import("./editor.js")} */ (await import(/** @type {any} */ ("./editor.bundle.js")));
  const opened = new Editor(byId("editor", HTMLDivElement), hello.readOnly);
  editor = opened;
  const documents = (files = new Files(byId("tabs", HTMLDivElement), engine, opened, report));
  if (hello.file && !hello.untitled) await documents.show(file).catch(report);
  else documents.begin(file);
  if (newest.scene) documents.list(newest.scene.files ?? []);
  let typing = 0;
  points.editor = opened;
  if (points.on) points.update();
  opened.changed.on(() => {
    clearTimeout(typing);
    if (opened.quiet) return;
    typing = window.setTimeout(() => {
      timeBar.forget();
      runs.now();
    }, TYPING_PAUSE);
  });
  // The server runs a saved file by itself.
  documents.settled.on(() => {
    clearTimeout(typing);
    timeBar.forget();
    runs.now();
  });
  opened.cursorMoved.on(() => showMade());
  byId("save", HTMLButtonElement).addEventListener("click", () => documents.save());
  byId("save", HTMLButtonElement).hidden = !canSave;
  if (newest.messages) {
    messages.show(newest.messages);
    opened.setProblems(newest.messages.diagnostics);
  }
  keepSelection();
  root.dataset.ready = "true";
  // For tests, and for those who look into the page.
  Object.assign(globalThis, { cagPage: { view, editor: opened } });
}

/** @param {View} view */
function firstPicture(view) {
  return view.message ? Promise.resolve() : new Promise((done) => view.drawn.on(() => view.message && done(undefined)));
}

start(serverEngine()).catch((error) => {
  const notice = byId("notice", HTMLParagraphElement);
  notice.textContent = error.message;
  notice.hidden = false;
});
