// The examples, and the scripts that were saved in the browser, as a dialog of links.

import { h } from "./dom.js";

/** @param {import("./playground.js").Example[]} examples @param {string[]} saved  names */
export function openGallery(examples, saved) {
  const close = () => dialog.close();
  const groups = [...new Set(examples.map((e) => e.group))];
  const dialog = h("dialog", { class: "gallery", "aria-label": "Examples" }, h("div", { class: "stack" },
    h("div", { class: "row" }, h("h2", {}, "Examples"), h("span", { class: "space" }), h("a", { href: "#name=script.cag&text=", onclick: close }, "Empty script"),
      h("button", { type: "button", onclick: close }, "Close")),
    ...(saved.length ? [h("h3", {}, "Saved in this browser"),
      h("p", { class: "row" }, ...saved.map((name) => h("a", { href: `#saved=${encodeURIComponent(name)}`, onclick: close }, name)))] : []),
    ...groups.flatMap((group) => [h("h3", {}, group),
      h("div", { class: "cards" }, ...examples.filter((e) => e.group === group).map((e) => h("a", { class: "card", href: `#example=${e.id}`, title: e.about, onclick: close },
        e.picture ? h("img", { src: e.picture, alt: "", loading: "lazy", width: 240, height: 135 }) : h("span", { class: "blank" }), h("span", {}, e.title))))])));
  dialog.addEventListener("close", () => dialog.remove());
  dialog.addEventListener("click", (e) => e.target === dialog && close());
  document.body.append(dialog);
  dialog.showModal();
}
