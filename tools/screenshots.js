// Takes the pictures of the page that the documentation shows, with headless Chromium.
//
//     node tools/screenshots.js PROGRAM FOLDER [NAME ...]
"use strict";
const { spawn } = require("child_process");
const path = require("path");
const { Browser, pause } = require("../tests/web/browser.js");

const [program, folder, ...names] = process.argv.slice(2);
const CHROMIUM = process.env.CHROMIUM ?? "chromium";

const EDITOR = 'document.querySelector("#editor").shadowRoot';
// Puts the cursor behind a text of the script.
const cursorAfter = (text) => `(() => { const { view } = cagPage.editor, at = view.state.doc.toString().indexOf(${JSON.stringify(text)}) + ${text.length}; view.dispatch({ selection: { anchor: at } }); view.focus(); })()`;
const open = (id) => `(() => { const d = document.querySelector("#${id}").closest("details"); d.open = true; d.scrollIntoView({ block: "start" }); })()`;

const PICTURES = [
  { name: "view.png", script: "examples/vase.cag", act: (page) => page.click(722, 300) },
  {
    name: "view_editor.png", script: "examples/vase.cag", act: async (page) => {
      await page.value(cursorAfter("show vase"));
      await page.type(" |> trans");
      await page.until(`${EDITOR}.querySelector(".cm-completionInfo")`);
    },
  },
  {
    name: "view_points.png", script: "examples/vase.cag", act: async (page) => {
      await page.click(722, 300);
      await page.value("document.querySelector('#scene').focus()");
      await page.key("d");
      await page.until('document.querySelectorAll(".handle.point").length > 3');
    },
  },
  {
    name: "view_robot.png", script: "examples/robots/gallery.cag", dark: true, act: async (page) => {
      await page.until('document.querySelectorAll("#robots input[type=range]").length > 2');
      await page.value('(() => { const s = document.querySelector("#robots select"); s.value = "panda"; s.dispatchEvent(new Event("change", { bubbles: true })); })()');
      await page.value(open("robots"));
    },
  },
  {
    name: "view_surface.png", script: "examples/vase.cag", act: async (page) => {
      await page.click(722, 300);
      await page.value(open("surfaces"));
      await page.value('(() => { const s = document.querySelector("#surfaces select"); s.value = "zebra"; s.dispatchEvent(new Event("change", { bubbles: true })); })()');
    },
  },
];

function serve(script) {
  return new Promise((done, fail) => {
    const server = spawn(program, ["view", script, "--no-open"], { stdio: ["ignore", "pipe", "inherit"] });
    server.stdout.once("data", (line) => done({ server, address: String(line).trim() }));
    server.once("exit", (code) => fail(new Error(`cag view ended with status ${code}`)));
  });
}

async function takePicture(browser, { name, script, dark = false, act }) {
  const { server, address } = await serve(script);
  const page = await browser.open(address, { dark });
  await page.until('document.documentElement.dataset.ready === "true"');
  await page.until('document.querySelectorAll("#parts li, #parts [role=row], #parts button").length > 2');
  await pause(8000); // the last meshes, and the light
  await act(page);
  await pause(3000);
  await page.screenshot(path.join(folder, name));
  await page.close();
  server.removeAllListeners("exit");
  server.kill("SIGINT");
}

(async () => {
  const browser = new Browser(CHROMIUM);
  for (const picture of PICTURES) if (!names.length || names.includes(picture.name)) await takePicture(browser, picture);
  await browser.close();
})().catch((error) => {
  console.error(error.message);
  process.exit(1);
});
