// Markdown of the language server as elements: paragraphs, code, lists, and emphasis. Anything else is shown as it is written.

import { h } from "./dom.js";

/** @param {string} text @returns {(Node | string)[]} */
function inline(text) {
  return text.split(/(`[^`]+`|\*\*[^*]+\*\*|\*[^*\s][^*]*\*|\[[^\]]+\]\([^)]*\))/).filter(Boolean).map((part) => {
    if (/^`.+`$/.test(part)) return h("code", {}, part.slice(1, -1));
    if (/^\*\*.+\*\*$/.test(part)) return h("strong", {}, part.slice(2, -2));
    if (/^\*.+\*$/.test(part)) return h("em", {}, part.slice(1, -1));
    return /^\[([^\]]+)\]\(/.exec(part)?.[1] ?? part;
  });
}

/** @param {string} markdown */
export function renderMarkdown(markdown) {
  const root = h("div", { class: "markdown" });
  const blocks = markdown.split(/^(```[^\n]*\n[\s\S]*?^```[ \t]*$)/m);
  for (const block of blocks) {
    const code = /^```[^\n]*\n([\s\S]*?)\n?```[ \t]*$/.exec(block);
    if (code) root.append(h("pre", {}, code[1]));
    else for (const paragraph of block.split(/\n\s*\n/)) addParagraph(root, paragraph.trim());
  }
  return root;
}

/** @param {HTMLElement} root @param {string} text */
function addParagraph(root, text) {
  if (!text) return;
  if (/^-{3,}$/.test(text)) return root.append(h("hr"));
  const items = text.split(/^[-*] /m);
  if (items[0] === "" && items.length > 1) root.append(h("ul", {}, ...items.slice(1).map((item) => h("li", {}, ...inline(item.trim())))));
  else root.append(h("p", {}, ...inline(text.replace(/^#+ /, ""))));
}
