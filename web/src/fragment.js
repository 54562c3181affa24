// The script in the fragment of the address.
//
//     #code=...      the text, deflated, as base64url; `base64=` and `text=` are the text itself, as base64url and percent-encoded
//     #name=a.cag    its name
//     #example=surfaces/coons    an example; `code` replaces its text
//     #saved=a.cag   a script that was saved in the browser
//     #tour=2        with step 2 of the tour
//     #files=...     other files that were changed, as JSON, deflated

/**
 * @typedef {object} Fragment
 * @property {string} [name]
 * @property {string} [text]
 * @property {string} [example]
 * @property {string} [saved]
 * @property {string} [tour]
 * @property {Record<string, string>} [files]
 */

/** @param {Uint8Array} bytes */
function toBase64(bytes) {
  let binary = "";
  for (let i = 0; i < bytes.length; i += 4096) binary += String.fromCharCode(...bytes.subarray(i, i + 4096));
  return btoa(binary).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
}

/** @param {string} text */
const fromBase64 = (text) => Uint8Array.from(atob(text.replaceAll("-", "+").replaceAll("_", "/")), (c) => c.charCodeAt(0));

/** @param {BlobPart} data @param {GenericTransformStream} stream */
const through = (data, stream) => new Response(new Blob([data]).stream().pipeThrough(/** @type {any} */ (stream)));

/** @param {string} text */
const deflate = async (text) => toBase64(new Uint8Array(await through(text, new CompressionStream("deflate-raw")).arrayBuffer()));
/** @param {string} code */
const inflate = (code) => through(fromBase64(code), new DecompressionStream("deflate-raw")).text();

/** @param {string} hash  with or without # @returns {Promise<Fragment>}  without what cannot be read */
export async function readFragment(hash) {
  const given = new URLSearchParams(hash.replace(/^#/, ""));
  /** @type {Fragment} */
  const out = {};
  for (const key of /** @type {const} */ (["name", "text", "example", "saved", "tour"])) {
    const value = given.get(key);
    if (value !== null) out[key] = value;
  }
  const code = given.get("code"), base64 = given.get("base64"), files = given.get("files");
  if (code !== null) out.text = await inflate(code);
  else if (base64 !== null) out.text = new TextDecoder().decode(fromBase64(base64));
  if (files !== null) out.files = JSON.parse(await inflate(files));
  return out;
}

/** @param {Fragment} fragment @returns {Promise<string>}  with # */
export async function writeFragment({ name, text, example, saved, tour, files }) {
  const out = new URLSearchParams();
  if (name !== undefined) out.set("name", name);
  if (example !== undefined) out.set("example", example);
  if (saved !== undefined) out.set("saved", saved);
  if (tour !== undefined) out.set("tour", tour);
  if (text !== undefined) out.set("code", await deflate(text));
  if (files && Object.keys(files).length) out.set("files", await deflate(JSON.stringify(files)));
  // Slashes are allowed in fragments, and read better.
  return `#${out.toString().replaceAll("%2F", "/")}`;
}
