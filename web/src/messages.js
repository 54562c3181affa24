// What a run says: prints, errors and warnings with their lines, and what it cost.

import { h } from "./dom.js";
import { formatMemory, formatSeconds } from "./format.js";
import { Topic } from "./topic.js";

const MOST_PRINTS = 1000; // lines in the page

export class MessagesPanel {
  /**
   * @param {HTMLElement} host
   * @param {HTMLElement} status  a short text about the last run
   * @param {(file: string, line: number) => string} lineOf  the text of a line, "" if its file is not open
   * @param {(d: import("./engine.js").Diagnostic) => { name: string, apply: () => void }[]} fixesOf
   */
  constructor(host, status, lineOf, fixesOf) {
    this.host = host;
    this.status = status;
    this.lineOf = lineOf;
    this.fixesOf = fixesOf;
    /** @type {import("./engine.js").RunMessages | null} */
    this.shown = null;
    /** @type {Topic<import("./engine.js").Place>} */
    this.placeWanted = new Topic();
  }

  /** @param {import("./engine.js").RunMessages} m */
  show(m) {
    this.shown = m;
    const errors = m.diagnostics.filter((d) => d.severity === "error").length, warnings = m.diagnostics.length - errors;
    const counts = [errors ? count(errors, "error") : "", warnings ? count(warnings, "warning") : ""].filter(Boolean);
    this.status.textContent = [...counts, formatSeconds(m.seconds), m.memory ? formatMemory(m.memory) : ""].filter(Boolean).join(" · ");
    this.status.classList.toggle("bad", !m.ok);
    const prints = m.prints.slice(-MOST_PRINTS);
    this.host.replaceChildren(
      ...m.diagnostics.map((d) => this.diagnostic(d)),
      ...(prints.length < m.prints.length ? [h("p", { class: "faint" }, `${m.prints.length - prints.length} lines before`)] : []),
      ...(prints.length ? [h("pre", { class: "prints" }, prints.join("\n"))] : []),
      ...(m.diagnostics.length + prints.length === 0 ? [h("p", { class: "faint" }, "No messages.")] : []));
  }

  /** @param {import("./engine.js").Diagnostic} d */
  diagnostic(d) {
    const excerpt = this.lineOf(d.file, d.line);
    const underline = excerpt ? marks(excerpt, d) : "";
    return h("div", { class: `diagnostic ${d.severity}` },
      h("button", { type: "button", class: "quiet place", onclick: () => this.placeWanted.emit(d) },
        h("span", { class: "what" }, d.severity), h("span", { class: "text" }, d.message), h("span", { class: "faint" }, `${d.code} ${d.file}:${d.line}`)),
      excerpt ? h("pre", {}, `${excerpt}\n${underline}`) : null,
      d.help ? h("p", {}, h("span", { class: "what" }, "help"), ` ${d.help}`) : null,
      ...this.fixesOf(d).map(({ name, apply }) => h("button", { type: "button", class: "fix", onclick: apply }, name)),
      ...d.related.map((r) => h("button", { type: "button", class: "quiet place", onclick: () => this.placeWanted.emit(r) },
        h("span", { class: "text" }, r.message), h("span", { class: "faint" }, `${r.file}:${r.line}`))));
  }

  /** Shows what was shown with the fixes that are known now. */
  refresh() {
    if (this.shown?.diagnostics.length) this.show(this.shown);
  }

  /** @param {string} text */
  problem(text) {
    if (this.host.firstElementChild?.textContent === text) return;
    this.host.prepend(h("div", { class: "diagnostic error" }, h("p", {}, text)));
  }
}

/** @param {number} n @param {string} word */
const count = (n, word) => `${n} ${word}${n === 1 ? "" : "s"}`;

/** The line of `^` under a place. @param {string} line @param {import("./engine.js").Place} d */
export function marks(line, d) {
  const length = d.endLine === d.line ? d.endColumn - d.column : [...line].length - d.column + 1;
  return " ".repeat(Math.max(0, d.column - 1)) + "^".repeat(Math.max(1, length));
}
