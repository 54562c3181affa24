// Uses the playground in headless Chromium: examples, the tour, addresses, limits.
//   node playground_page.js CHROMIUM FOLDER
// The last line is `N passed, N failed, 0 skipped`.
"use strict";
const zlib = require("zlib");
const { Browser, pause } = require("./browser.js");
const { serveFolder } = require("./playground_server.js");

const [chromium, folder] = process.argv.slice(2);
let passed = 0, failed = 0;
async function test(name, body) {
  const begin = Date.now();
  try {
    await body();
    passed++;
    console.log(`passed: ${name} (${((Date.now() - begin) / 1000).toFixed(1)} s)`);
  } catch (error) {
    failed++;
    console.log(`FAILED: ${name}\n  ${error.stack}`);
  }
}
function equal(found, expected) {
  if (JSON.stringify(found) !== JSON.stringify(expected)) throw new Error(`expected ${JSON.stringify(expected)}, found ${JSON.stringify(found)}`);
}
function check(truth, what) {
  if (!truth) throw new Error(what);
}

const READY = 'document.documentElement.dataset.ready === "true"';
const EDITOR = 'document.querySelector("#editor").shadowRoot.querySelector(".cm-content")';
const TEXT = `[...${EDITOR}.querySelectorAll(".cm-line")].map((l) => l.textContent).join("\\n")`;
const MESSAGES = 'document.querySelector("#messages").textContent';
const OK = 'document.documentElement.dataset.ok';
const press = (page, label) => page.value(`[...document.querySelectorAll("button, a")].find((b) => b.textContent === ${JSON.stringify(label)} && b.offsetParent).click()`);
const shot = (page, name) => page.screenshot(process.env.PICTURES ? `${process.env.PICTURES}/${name}.png` : null);
const base64 = (bytes) => Buffer.from(bytes).toString("base64url");

// Recursions that need the stack of the browser, whose size is not known.
const DEEP = ["f(n) = 1 + f(n + 1)\nprint f(0)", "f(n) = sum(map([n], x => f(x + 1)))\nprint f(0)", "f(n) = reduce([n], 0, (a, x) => a + f(x + 1))\nprint f(0)",
  "c(n) = curve(t => c(n + 1)(t), 0..1)\nprint c(0)(0.5)", "f(n) = sort([n, n + 1], x => f(x + 1))\nprint f(0)", "f(n) = integrate(x => f(n + 1), 0..1)\nprint f(0)",
  `print ${"(".repeat(990)}1${")".repeat(990)}\nassert false`, `print ${"[".repeat(100000)}`];

async function main() {
  /** Paths of the answers. */
  const sent = [];
  const server = await serveFolder(folder, (name) => sent.push(name)), base = `http://localhost:${server.address().port}/`;
  const browser = new Browser(chromium);
  const page = await browser.open(base, { width: 1200, height: 760 });
  // A change of the fragment loads the page again.
  const go = async (hash, ready = READY) => {
    await page.say("Page.navigate", { url: "about:blank" });
    await page.say("Page.navigate", { url: `${base}${hash}` });
    await page.until(`location.href !== "about:blank" && ${ready}`);
  };
  await test("without a script, an example is shown", async () => {
    await page.until(`${READY} && document.querySelectorAll("#parts li").length === 3`);
    equal(await page.value("document.title"), "vase.cag - cag");
    await shot(page, "playground-first");
  });
  await test("the examples are a dialog of links", async () => {
    await press(page, "Examples");
    const links = await page.value('document.querySelectorAll("dialog.gallery a.card").length');
    check(links > 40, `${links} examples`);
    await pause(500);
    await shot(page, "playground-gallery");
    await page.value('document.querySelector(`a.card[href="#example=surfaces/coons"]`).click()');
    await page.until(`${READY} && document.title === "coons.cag - cag" && document.querySelectorAll("#parts li").length > 1`);
    check(await page.value('[...document.querySelectorAll("#tabs button")].some((b) => b.textContent.includes("stage.cag"))'), "the imported file has no tab");
    equal(await page.value("location.hash"), "#example=surfaces/coons");
  });
  await test("texts in addresses: compressed, as base64url, and percent-encoded", async () => {
    const script = "print \"größe + 1 & 2\"\nshow sphere(3)\n";
    for (const part of [`code=${base64(zlib.deflateRawSync(script))}`, `base64=${base64(script)}`, `text=${encodeURIComponent(script)}`]) {
      await go(`#name=ball.cag&${part}`, `${READY} && ${MESSAGES}.includes("größe + 1 & 2")`);
      equal(await page.value(TEXT), script);
    }
    equal(await page.value("document.title"), "ball.cag - cag");
  });
  await test("the address follows what is typed, without more history, and opens the same text again", async () => {
    await go("#name=ball.cag&text=show%20sphere(3)");
    const before = await page.value("history.length");
    await page.value(`${EDITOR}.focus()`);
    await page.key("End", { modifiers: 2 });
    await page.type("\nprint 6 * 7");
    await page.until(`${MESSAGES}.includes("42")`);
    await page.until('location.hash.includes("code=")');
    equal(await page.value("history.length"), before);
    const hash = await page.value("location.hash");
    await go(hash, `${READY} && ${MESSAGES}.includes("42")`);
    check((await page.value(TEXT)).includes("print 6 * 7"), "the text is lost");
  });
  await test("long scripts fit into addresses", async () => {
    const long = Array.from({ length: 4000 }, (_, i) => `a${i} = ${i} * ${i * 7919 % 1000}`).join("\n") + "\nprint a3999\n";
    await go(`#code=${base64(zlib.deflateRawSync(long))}`, `${READY} && ${MESSAGES}.includes("${3999 * ((3999 * 7919) % 1000)}")`);
  });
  await test("a damaged address is reported", async () => {
    await go("#code=!!!", `document.querySelector(".toast")?.textContent.includes("damaged")`);
    await page.until(READY);
  });
  await test("a script is saved in the browser", async () => {
    await go("#name=kept.cag&text=print%20%22kept%22");
    await page.value(`${EDITOR}.focus()`);
    await page.key("s", { modifiers: 2 });
    await page.until('document.querySelector(".toast")?.textContent.includes("saved in this browser")');
    await go("#saved=kept.cag", `${READY} && ${MESSAGES}.includes("kept")`);
    equal(await page.value(TEXT), 'print "kept"');
  });
  await test("the tour goes step by step, and its scripts can be opened", async () => {
    await go("#tour=0", `${READY} && document.querySelector("#tour h2")`);
    for (let i = 0; i < 20 && !(await page.value('document.querySelector("#tour .try")')); i++) {
      await press(page, "Next");
      await pause(50);
    }
    await shot(page, "playground-tour");
    await press(page, "Open in the editor");
    // The page is loaded again.
    await page.until(`${READY} && (${TEXT}).includes("thicken(revolve(profile), 3)") && document.querySelector("#tour .try") && document.querySelectorAll("#parts li").length > 0`);
  });
  await test("what is missing is said", async () => {
    await press(page, "About");
    const text = await page.value('document.querySelector("dialog[open]").textContent');
    for (const word of ["POV-Ray", "OpenEXR", "fonts of the system"]) check(text.includes(word), word);
    await press(page, "Close");
    check(!(await page.value('[...document.querySelectorAll("#output option")].map((o) => o.value).join()')).match(/povray|exr/), "POV-Ray or .exr are offered");
  });
  await test("fonts are loaded when a script needs them", async () => {
    equal(sent.filter((name) => name.startsWith("/fonts/")), []);
    const script = 'show extrude(lettering("cag\\nשָׁלוֹם", style: "bold italic", align: "center"), 2)\nprint "set"\n';
    await go(`#name=letters.cag&text=${encodeURIComponent(script)}`, `${READY} && ${OK} === "true" && ${MESSAGES}.includes("set")`);
    equal([...new Set(sent.filter((name) => name.startsWith("/fonts/")))], ["/fonts/Sans-BoldItalic.ttf"]);
    await shot(page, "playground-letters");
  });
  await test("the licenses of the libraries and fonts are in the folder", async () => {
    const text = await page.value('fetch("licenses.txt").then((r) => r.text())');
    for (const words of ["GNU LESSER GENERAL PUBLIC LICENSE", "Old MIT", "SIL OPEN FONT LICENSE"]) check(text.includes(words), words);
  });
  await test("endless recursion ends as an error, and the next script runs", async () => {
    for (const text of DEEP) {
      await go(`#text=${encodeURIComponent(text)}`, `${READY} && ${OK} === "false"`);
      check(/E\d{4}/.test(await page.value(MESSAGES)), await page.value(MESSAGES));
      await page.value("cagPage.editor.replace(cagPage.editor.path, 0, cagPage.editor.text(cagPage.editor.path).length, 'print 40 + 2')");
      await page.until(`${OK} === "true" && ${MESSAGES}.includes("42")`);
      if (process.env.VERBOSE) console.log(text.slice(0, 40), page.problems.length);
    }
  });
  await test("a newer script ends one that takes long", async () => {
    await go(`#text=${encodeURIComponent("f(n) = if n == 0 then 0 else f(n - 1)\nprint sum([for i in 1..1000000: f(10000)])")}`);
    await pause(1500);
    await page.value("cagPage.editor.replace(cagPage.editor.path, 0, cagPage.editor.text(cagPage.editor.path).length, 'show sphere(4)\\nprint 40 + 2')");
    await page.until(`${OK} === "true" && ${MESSAGES}.includes("42") && document.querySelectorAll("#parts li").length === 1`);
  });
  await test("examples of the documentation open in the playground", async () => {
    await page.say("Page.navigate", { url: `${base}docs/functions/revolve.html` });
    await page.until('document.querySelector(".example a.edit")');
    const text = await page.value('document.querySelector(".example .code code").textContent');
    await page.value('document.querySelector(".example a.edit").click()');
    await page.until(`${READY} && ${OK}`);
    equal((await page.value(TEXT)).trim(), text.trim());
  });
  // The documentation has no icon.
  await test("the page reports no other errors", async () => equal(page.problems.filter((p) => !p.includes("favicon.ico")), []));
  await browser.close();
  server.close();
}
main().catch((error) => {
  failed++;
  console.log(`FAILED: ${error.stack}`);
}).finally(() => {
  console.log(`${passed} passed, ${failed} failed, 0 skipped`);
  process.exit(failed ? 1 : 0);
});
