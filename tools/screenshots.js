// Takes the pictures of the page that the documentation shows, with headless Chromium.
//
//     node tools/screenshots.js PROGRAM FOLDER
"use strict";
const { spawn } = require("child_process");
const path = require("path");
const { Browser, pause } = require("../tests/web/browser.js");

const [program, folder] = process.argv.slice(2);
const CHROMIUM = process.env.CHROMIUM ?? "chromium";

// name, script, dark colors, what is clicked
const PICTURES = [
  ["view.png", "examples/vase.cag", false, [722, 300]],
];

function serve(script) {
  return new Promise((done, fail) => {
    const server = spawn(program, ["view", script, "--no-open"], { stdio: ["ignore", "pipe", "inherit"] });
    server.stdout.once("data", (line) => done({ server, address: String(line).trim() }));
    server.once("exit", (code) => fail(new Error(`cag view ended with status ${code}`)));
  });
}

async function takePicture(browser, [name, script, dark, [x, y]]) {
  const { server, address } = await serve(script);
  const page = await browser.open(address, { dark });
  await page.until('document.querySelectorAll("#parts li, #parts [role=row], #parts button").length > 2');
  await pause(8000); // the last meshes, and the light
  await page.click(x, y);
  await pause(3000);
  await page.screenshot(path.join(folder, name));
  await page.close();
  server.removeAllListeners("exit");
  server.kill("SIGINT");
}

(async () => {
  const browser = new Browser(CHROMIUM);
  for (const picture of PICTURES) await takePicture(browser, picture);
  await browser.close();
})().catch((error) => {
  console.error(error.message);
  process.exit(1);
});
