// The page: makes its parts and connects them.

import { Controls, viewOfKey } from "./controls.js";
import { byId, downloads, h } from "./dom.js";
import { listenEarly } from "./engine.js";
import { FaceSources, FaceTint } from "./faces.js";
import { Files } from "./files.js";
import { formatSize } from "./format.js";
import { Ghosts, motionText } from "./ghosts.js";
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
import { RemoteEditor, RemoteFiles } from "./remote_editor.js";
import { RobotsPanel } from "./robots.js";
import { Runs } from "./runs.js";
import { SectionCurves } from "./section_curves.js";
import { SectionPanel } from "./section_panel.js";
import { SelectionPanel } from "./selection_panel.js";
import { SurfacePanel } from "./surface_panel.js";
import { Surfaces } from "./surfaces.js";
import { TimeBar } from "./time_bar.js";
import { View } from "./view.js";

const TYPING_PAUSE = 200; // milliseconds from the last key to the run
const CURSOR_PAUSE = 120; // milliseconds from the last move of the cursor to the ghost
const MOST_EXCERPT = 40; // characters of a script that are shown beside the pointer
const EDITOR_AFTER = 400; // milliseconds to wait for the first picture, at most
const TOLD_FOR = 4000; // milliseconds that a remark stays
const NEW_SCRIPT = "untitled.cag";

/** @typedef {import("./engine.js").SceneMessage} SceneMessage */
/** @typedef {import("./engine.js").Place} Place */

/**
 * @param {import("./engine.js").Engine} engine
 * @param {import("./webview.js").Webview | null} [webview]  the panel of a text editor, which is then the editor of the page
 */
export async function start(engine, webview = null) {
  const helloLater = engine.hello(), listen = listenEarly(engine);
  const root = document.documentElement;
  const scene = byId("scene", HTMLDivElement), notice = byId("notice", HTMLParagraphElement), status = byId("status", HTMLSpanElement);
  const canvas = byId("canvas", HTMLCanvasElement), over = byId("over", HTMLDivElement);
  const view = new View(canvas, (id) => engine.mesh(id));
  const hello = await helloLater;
  const overlay = new Overlay(over, view), handles = new Handles(over, view), controls = new Controls(scene, view);
  const layout = new Layout(() => view.invalidate());
  /** @type {Files | RemoteFiles | null} */
  let files = null;
  /** @type {import("./editor.js").Editor | RemoteEditor | null} */
  let editor = null;
  /** The newest that arrived. @type {{ scene: SceneMessage | null, messages: import("./engine.js").RunMessages | null }} */
  const newest = { scene: null, messages: null };

  const report = (/** @type {Error} */ error) => messages.problem(error.message);
  const say = (/** @type {string} */ text) => {
    notice.textContent = text;
    notice.hidden = text === "";
  };
  const tell = (/** @type {string} */ text) => {
    say(text);
    setTimeout(() => notice.textContent === text && say(""), TOLD_FOR);
  };
  const textOf = (/** @type {string} */ path) => editor?.text(path) ?? "";
  const excerpt = (/** @type {Place} */ place) => textOf(place.file).slice(...rangeOf(textOf(place.file), place));
  const lineOf = (/** @type {string} */ path, /** @type {number} */ line) => {
    const text = textOf(path), from = offsetOf(text, line, 1), end = text.indexOf("\n", from);
    return text.slice(from, end < 0 ? undefined : end);
  };

  const messages = new MessagesPanel(byId("messages", HTMLDivElement), status, lineOf, (d) => editor?.fixesOf(d) ?? []);

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

  const file = hello.file || NEW_SCRIPT;
  document.title = `${file} - cag`;
  byId("title", HTMLSpanElement).textContent = file;
  const hasEditor = !hello.readOnly && !webview;
  if (!hasEditor) layout.withoutEditor();
  if (webview) {
    downloads.save = (name, blob) => webview.download(name, blob);
    webview.themeChanged(() => view.invalidate());
  }

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
    engine, view, handles, params, readOnly: hello.readOnly, note: byId("selection", HTMLDivElement), report,
    load: (path) => files?.load(path), showFile: (path) => files?.show(path), pending: () => runs.pending,
    run: (dragging) => {
      timeBar.forget();
      if (dragging) runs.drag();
      else runs.drop();
    },
  });
  runs.busy.on((busy) => !busy && points.held && points.update());
  const measure = new MeasurePanel(byId("measure", HTMLDivElement), over, view);
  const robots = new RobotsPanel(byId("robots", HTMLDivElement), over, view, engine, {
    readOnly: hello.readOnly, textOf: (path) => editor?.text(path) ?? null, entered: () => controls.hoverAt(null),
    openFile: async (path) => files?.show(path),
  });
  robots.writeWanted.on(({ path, from, to, text }) => {
    editor?.replace(path, from, to, text);
    runs.now();
  });
  const output = new OutputPanel(byId("output", HTMLDivElement), engine, hello, view, report);
  const sources = new FaceSources(engine), faceTint = new FaceTint(view), ghosts = new Ghosts(view, engine);
  const surfacePanel = new SurfacePanel(byId("surfaces", HTMLDivElement), view, new Surfaces(view, engine));
  const sectionCurves = new SectionCurves(byId("section", HTMLDivElement), view, engine, (name) => {
    const part = view.parts.views.get(name)?.part;
    return part ? expressionOf(part) : "";
  });
  view.drawn.on(() => sectionCurves.update());
  panels.push(
    (m) => params.show(m.params, !runs.pending), (m) => timeBar.show(m.timed), (m) => robots.show(m), () => partsPanel.show(), () => sectionPanel.show(), (m) => output.show(m),
    (m) => files?.list(m.files ?? []), (m) => fillViews(m), () => markTools(), (m) => timeBar.arrived(m), () => noteTexts(), () => keepSelection(), () => showMade(), () => surfacePanel.refresh(), () => points.on && points.update());

  /** The expression of a part, "" if there is none to write. @param {import("./engine.js").Part} part */
  function expressionOf(part) {
    if (/^[\p{L}_][\p{L}\p{N}_]*$/u.test(part.name) && new RegExp(`^\\s*${part.name}\\s*=`, "mu").test(textOf(newest.scene?.script ?? file))) return part.name;
    const show = part.origin.find((o) => o.what === "show");
    return show ? shownExpression(excerpt(show)) : "";
  }

  let selected = ""; // the parts whose points are shown
  /** @param {string[]} names @param {Source | null} [face] */
  function select(names, face = null) {
    view.selected = names;
    if (!face) chosenFace = [];
    const part = view.parts.views.get(names[names.length - 1])?.part ?? null;
    selection.show(part, part ? expressionOf(part) : "", !runs.coarse, face);
    partsPanel.refresh();
    if (points.on && names.join() !== selected) points.update();
    selected = names.join();
    surfacePanel.refresh();
    showFaces();
    return part;
  }
  /** @typedef {{ name: string, origin: import("./engine.js").Origin[] }} Source */
  /** Faces that are outlined: of the operand that was clicked, that is pointed at, and those that the line of the cursor made. */
  let chosenFace = /** @type {import("./faces.js").Piece[]} */ ([]), pointedFace = chosenFace, madeFaces = chosenFace;
  function showFaces() {
    view.faces = [...chosenFace, ...pointedFace, ...(pointedFace.length ? [] : madeFaces)];
    faceTint.show(view.faces);
    view.invalidate();
  }
  /** What the face under a click comes from is told when it is known. @param {import("./picking.js").Hit} hit */
  async function selectFace({ view: partView, triangle }) {
    const names = view.selected, faces = await sources.get(partView);
    if (!faces || view.selected !== names || view.parts.views.get(partView.part.name) !== partView) return;
    const operand = faces.operands[triangle];
    chosenFace = [sources.piece(partView, faces, (o) => o === operand)];
    select(names, sources.sourceOf(partView, faces, triangle));
  }
  /** @param {Source} source */
  function sourceText(source) {
    if (source.name) return source.name;
    const place = [...source.origin].reverse().find((o) => !o.library);
    if (!place) return "";
    const text = excerpt(place).replace(/\s+/g, " ").trim();
    return text && text.length <= MOST_EXCERPT ? text : `line ${place.line}`;
  }
  let facePointed = ""; // which operand
  /** The face that is pointed at, and what it comes from. @param {import("./picking.js").Hit | null} hit @returns {string} */
  function pointFace(hit) {
    const faces = hit && hit.triangle >= 0 && sources.has(hit.view) ? sources.now(hit.view) : null;
    if (hit && hit.triangle >= 0 && !faces && sources.has(hit.view) && !runs.coarse) sources.get(hit.view);
    const key = hit && faces ? `${hit.view.part.name} ${faces.operands[hit.triangle]} ${view.message?.run}` : "";
    if (key !== facePointed) {
      facePointed = key;
      pointedFace = hit && faces ? [sources.piece(hit.view, faces, (o) => o === faces.operands[hit.triangle])] : [];
      showFaces();
    }
    const source = hit && faces ? sources.sourceOf(hit.view, faces, hit.triangle) : null;
    return source ? sourceText(source) : "";
  }
  /** After a run, what was selected is measured again. */
  function keepSelection() {
    const names = view.selected.filter((n) => view.parts.views.has(n));
    if (names.length || view.selected.length) select(names);
  }
  /** @param {string} name @param {boolean} more */
  function selectOne(name, more) {
    robots.chooseByPart(name);
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
    if (hit) {
      selectOne(hit.view.part.name, event.shiftKey);
      if (hit.triangle >= 0 && sources.has(hit.view) && view.selected.includes(hit.view.part.name)) selectFace(hit);
    } else if (!event.shiftKey) select([]);
  });
  controls.doubleClicked.on(({ x, y }) => {
    const origin = view.pick(x, y)?.view.part.origin ?? [];
    const made = origin.filter((o) => !o.library);
    if (made.length) goTo(made[made.length - 1]);
  });
  controls.hovered.on((at) => {
    if (measure.active) return measure.hover(at);
    const hit = at ? view.pick(at.x, at.y) : null, part = hit?.view.part, face = pointFace(hit);
    point(part ? [part.name] : made);
    const texts = part ? [part.name, part.type, formatSize(part.bounds), face && `from ${face}`] : [];
    overlay.point(texts.filter(Boolean).join(" · "), at?.x ?? 0, at?.y ?? 0);
  });

  // --- Places ---

  /** @param {Place} place */
  async function goTo(place) {
    if (!files || !editor) return;
    if (document.body.classList.contains("no-editor") && hasEditor) layout.toggle("editor");
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
  /** @param {import("./engine.js").Origin[]} origin */
  const isOnLine = (origin) => {
    const path = editor?.path, line = editor?.line() ?? 0;
    return origin.some((o) => o.file === path && o.line <= line && line <= o.endLine);
  };
  function showMade() {
    if (!editor) return;
    const parts = newest.scene?.parts ?? [];
    made = parts.filter((p) => isOnLine(p.origin)).map((p) => p.name);
    // A line that made everything tells nothing.
    if (made.length === parts.length && parts.length > 1) made = [];
    point(made);
    showMadeFaces();
    clearTimeout(looking);
    looking = window.setTimeout(showGhosts, CURSOR_PAUSE);
  }
  /** The faces that come from the line of the cursor, of parts that do not. */
  async function showMadeFaces() {
    const turn = ++madeTurn;
    const views = [...view.parts.visible()].filter((v) => sources.has(v) && !made.includes(v.part.name) && v.part.sources?.some((s) => isOnLine(s.origin)));
    const all = runs.coarse ? [] : await Promise.all(views.map((v) => sources.get(v)));
    if (turn !== madeTurn) return;
    madeFaces = all.flatMap((faces, i) => {
      const of = views[i].part.sources ?? [];
      return faces ? [sources.piece(views[i], faces, (o) => isOnLine(of[faces.sources[o]]?.origin ?? []))] : [];
    });
    showFaces();
  }
  let madeTurn = 0, looking = 0;
  const ghostNote = h("div", { class: "ghost-note", role: "status", hidden: true });
  over.append(ghostNote);
  /** Ghosts are shown while one works in the editor, of the text that was run. */
  async function showGhosts() {
    const text = editor && textOf(editor.path);
    if (editor && editor.hasFocus() && text === ranTexts.get(editor.path) && !runs.coarse) await ghosts.look(editor.path, editor.line(), editor.column());
    else if (!editor || editor.hasFocus()) ghosts.clear();
    const first = ghosts.shown[0], count = ghosts.shown.length;
    ghostNote.hidden = !first;
    if (!first) return;
    const named = excerpt(first.place).replace(/\s+/g, " ").trim();
    ghostNote.textContent = [named || first.type, count > 1 ? `${count} times` : "", motionText(first)].filter(Boolean).join(" · ");
  }
  /** The texts of the last scene, by path. @type {Map<string, string>} */
  const ranTexts = new Map();
  function noteTexts() {
    ranTexts.clear();
    for (const path of [newest.scene?.script ?? file, ...(newest.scene?.files ?? [])]) {
      const text = editor?.text(path);
      if (typeof text === "string") ranTexts.set(path, text);
    }
  }

  // --- View ---

  const views = byId("views", HTMLSelectElement);
  /** @param {SceneMessage | null} m */
  function fillViews(m) {
    const options = STANDARD_VIEWS.map((v, i) => h("option", { value: v }, `${v} (${i + 1})`));
    const cameras = (m?.cameras ?? []).filter((c) => !c.automatic).map((c) => h("option", { value: `camera ${c.name}` }, c.name));
    views.replaceChildren(h("option", { value: "" }, "View"), h("optgroup", { label: "Standard views" }, ...options));
    if (cameras.length) views.append(h("optgroup", { label: "Cameras of the script" }, ...cameras));
  }
  /** @param {import("./orbit.js").StandardView} name */
  const look = (name) => {
    view.look(name);
    view.fit();
  };
  fillViews(null); // a script that fails has no scene
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
    values: {
      is: () => editor?.showsValues ?? true,
      set: (on) => {
        if (!editor) return;
        editor.showsValues = on;
        editor.markValues();
      },
    },
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
    pointFace(null);
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
    f: () => flip("fit"), v: () => flip("values"), o: () => flip("orthographic"), l: () => flip("edges"), w: () => flip("wireframe"), b: () => flip("oneSided"),
    g: () => flip("grid"), k: () => flip("backdrop"), s: () => flip("shadows"), m: () => flip("measure"), x: () => flip("section"), d: () => flip("points"),
    e: () => hasEditor && layout.toggle("editor"), p: () => layout.toggle("side"), u: () => partsPanel.showAll(),
    h: () => chooseSelected((n) => parts.hidden.add(n)), t: () => chooseSelected((n) => parts.glass.delete(n) || parts.glass.add(n)),
    a: () => chooseSelected((n) => (parts.alone = parts.alone === n ? null : n)),
    " ": () => byId("time", HTMLDivElement).hidden || timeBar.toggle(), "?": () => keyDialog.showModal(),
    Escape: () => robots.handle.cancel() || (measure.active ? measure.toggle(false) : (ghosts.clear(), (ghostNote.hidden = true), select([]))),
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

  /** @type {boolean | null} null: not yet */
  let connected = null;
  listen({
    state: (state) => runs.state(state),
    scene: (message) => showScene(message),
    messages: (m) => {
      messages.show(m);
      editor?.setProblems(m.diagnostics);
      editor?.setValues(m.values);
      canvas.classList.toggle("stale", !m.ok);
      root.dataset.ok = String(m.ok);
      if (!m.ok) timeBar.stop();
      // A value that makes the script fail can be changed back, also if there was no scene yet.
      if (m.params?.length) params.show(m.params, !runs.pending);
      newest.messages = m;
    },
    file: (change) => files?.changedOnDisk(change),
    progress: (p) => output?.progress(p),
    connection: (on, problem, restart) => {
      const again = on && connected === false;
      if (on && !connected) runs.restart();
      connected = on;
      say(problem);
      if (restart) notice.append(" ", h("button", { type: "button", onclick: restart }, "Start it again"));
      // A server that was started again has run the script as it is on the disk.
      if (again && files) files.compareWithDisk().then(() => runs.now());
    },
  });
  // --- Editor ---

  const opened = webview ? new RemoteEditor(webview, file, report) : await ownEditor();
  editor = opened;
  const documents = (files = opened instanceof RemoteEditor ? new RemoteFiles(engine, opened, report) : new Files(byId("tabs", HTMLDivElement), engine, opened, report, hello.keepsEdits));
  async function ownEditor() {
    await Promise.race([firstPicture(view), new Promise((done) => setTimeout(done, EDITOR_AFTER))]);
    const { Editor } = /** @type {typeof import("./editor.js")} */ (await import(/** @type {any} */ ("./editor.bundle.js")));
    return new Editor(byId("editor", HTMLDivElement), {
      readOnly: hello.readOnly, folder: hello.folder, lsp: engine.lsp, load: async (path) => files?.load(path), go: goTo, say: tell,
    });
  }
  opened.fixesChanged.on(() => messages.refresh());
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
  byId("save", HTMLButtonElement).hidden = hello.readOnly;
  if (hello.untitled) byId("save", HTMLButtonElement).title = "Download the script, which has no file yet";
  if (newest.messages) {
    messages.show(newest.messages);
    opened.setProblems(newest.messages.diagnostics);
    opened.setValues(newest.messages.values);
  }
  noteTexts();
  // What another editor had not saved when the page was opened.
  if (documents.unsaved) runs.now();
  keepSelection();
  root.dataset.ready = "true";
  // For tests, and for those who look into the page.
  Object.assign(globalThis, { cagPage: { view, editor: opened, robots } });
}

/** @param {View} view */
function firstPicture(view) {
  return view.message ? Promise.resolve() : new Promise((done) => view.drawn.on(() => view.message && done(undefined)));
}

/** Shows why the page cannot start. @param {Error} error */
export function showFailure(error) {
  const notice = byId("notice", HTMLParagraphElement);
  notice.textContent = error.message;
  notice.hidden = false;
}
