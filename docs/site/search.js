// The search of the documentation: all in the page, from index.js, without a network.
"use strict";
(() => {
  const input = document.getElementById("search");
  const list = document.getElementById("found");
  const root = document.body.dataset.root;
  const most = 12;
  let chosen = -1;

  // The less the better; none when the words do not all occur.
  function rank(entry, query, words) {
    const name = entry[0].toLowerCase();
    const text = name + " " + entry[3].toLowerCase();
    if (!words.every((w) => text.includes(w))) return -1;
    if (name === query) return 0;
    if (name.startsWith(query)) return 10 + name.length / 100;
    if (name.endsWith("." + query)) return 15;
    if (name.includes(query)) return 20 + name.length / 100;
    return words.every((w) => name.includes(w)) ? 30 : 40;
  }

  function find(query) {
    const words = query.split(/\s+/).filter((w) => w);
    if (!words.length) return [];
    return cagIndex.map((entry, i) => [rank(entry, query, words), i, entry])
      .filter((r) => r[0] >= 0)
      .sort((a, b) => a[0] - b[0] || a[1] - b[1])
      .slice(0, most)
      .map((r) => r[2]);
  }

  function show() {
    const found = find(input.value.trim().toLowerCase());
    chosen = found.length ? 0 : -1;
    list.replaceChildren(...found.map(([name, kind, url, summary], i) => {
      const item = document.createElement("li");
      const link = document.createElement("a");
      const what = document.createElement("small");
      const about = document.createElement("span");
      link.href = root + url;
      link.append(name, " ");
      what.textContent = kind;
      about.textContent = summary;
      link.append(what, about);
      item.append(link);
      item.className = i === chosen ? "chosen" : "";
      return item;
    }));
  }

  function move(by) {
    const items = [...list.children];
    if (!items.length) return;
    chosen = (chosen + by + items.length) % items.length;
    items.forEach((item, i) => { item.className = i === chosen ? "chosen" : ""; });
  }

  input.addEventListener("input", show);
  input.addEventListener("keydown", (event) => {
    if (event.key === "ArrowDown") move(1);
    else if (event.key === "ArrowUp") move(-1);
    else if (event.key === "Enter" && chosen >= 0) list.children[chosen].firstChild.click();
    else if (event.key === "Escape") { input.value = ""; show(); input.blur(); }
    else return;
    event.preventDefault();
  });
  document.addEventListener("keydown", (event) => {
    if (event.key !== "/" || document.activeElement === input) return;
    input.focus();
    event.preventDefault();
  });
  document.addEventListener("click", (event) => {
    if (!event.target.closest(".search")) list.replaceChildren();
  });
})();
