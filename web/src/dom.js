// Elements of the page.

/**
 * Makes an element. Properties that begin with `on` are listeners, true and false set and omit an attribute, and all others are attributes.
 * The Content-Security-Policy forbids `style` attributes, so styles are set with classes or `element.style`.
 *
 * @template {keyof HTMLElementTagNameMap} K
 * @param {K} tag
 * @param {Record<string, any>} [properties]
 * @param {...(Node | string | null | undefined)} children
 * @returns {HTMLElementTagNameMap[K]}
 */
export function h(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (value === true) element.setAttribute(name, "");
    else if (value !== false && value !== null && value !== undefined) element.setAttribute(name, String(value));
  }
  for (const child of children) if (child !== null && child !== undefined) element.append(child);
  return element;
}

/**
 * Returns the element with an id, which must be in index.html.
 *
 * @template {HTMLElement} T
 * @param {string} id
 * @param {new () => T} type
 * @returns {T}
 */
export function byId(id, type) {
  const element = document.getElementById(id);
  if (!(element instanceof type)) throw new Error(`the page has no ${type.name} with the id ${id}`);
  return element;
}

const SVG = "http://www.w3.org/2000/svg";

/**
 * @param {string} tag
 * @param {Record<string, string | number>} properties
 * @param {...(Node | string)} children
 * @returns {SVGElement}
 */
export function svg(tag, properties = {}, ...children) {
  const element = /** @type {SVGElement} */ (document.createElementNS(SVG, tag));
  for (const [name, value] of Object.entries(properties)) element.setAttribute(name, String(value));
  element.append(...children);
  return element;
}

// Icons are strokes in a box of 16 by 16.
/** @type {Record<string, string>} */
const ICONS = {
  play: "M5 3l8 5-8 5z",
  pause: "M5 3v10M11 3v10",
  eye: "M1 8s2.5-4.5 7-4.5S15 8 15 8s-2.5 4.5-7 4.5S1 8 1 8zM8 10a2 2 0 100-4 2 2 0 000 4",
  hidden: "M2 2l12 12M6.5 3.7A7 7 0 018 3.5C12.500 3.500 15 8 15 8a13 13 0 01-2.200 2.700M4 5C2 6.200 1 8 1 8s2.500 4.500 7 4.500a7 7 0 002.600-.500",
  alone: "M8 5a3 3 0 100 6 3 3 0 000-6M8 1v2M8 13v2M1 8h2M13 8h2",
  glass: "M8 2a6 6 0 100 12 6 6 0 000-12M8 2v12M8 5h5M8 8h6M8 11h5",
  copy: "M5 5V2h9v9h-3M2 5h9v9H2z",
  reset: "M3 8a5 5 0 105-5 5 5 0 00-4 2M3 2v3.500h3.500",
  close: "M3 3l10 10M13 3L3 13",
};

/** @param {string} name */
export function icon(name) {
  return svg("svg", { viewBox: "0 0 16 16", class: "icon", "aria-hidden": "true" }, svg("path", { d: ICONS[name] }));
}

/**
 * A button with an icon.
 *
 * @param {string} name
 * @param {string} label
 * @param {(event: MouseEvent) => void} onclick
 */
export function iconButton(name, label, onclick) {
  return h("button", { type: "button", class: "quiet", "aria-label": label, title: label, onclick }, icon(name));
}

/** Saves downloads where the browser cannot. @type {{ save: ((name: string, blob: Blob) => Promise<void>) | null }} */
export const downloads = { save: null };

/** @param {string} name @param {Blob} blob */
export function download(name, blob) {
  if (downloads.save) return void downloads.save(name, blob);
  const url = URL.createObjectURL(blob);
  const link = h("a", { href: url, download: name });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(url), 60000);
}

/** @param {Blob} blob @param {HTMLCanvasElement} canvas */
export async function drawPicture(blob, canvas) {
  const picture = await createImageBitmap(blob);
  canvas.width = picture.width;
  canvas.height = picture.height;
  canvas.getContext("2d")?.drawImage(picture, 0, 0);
  picture.close();
}
