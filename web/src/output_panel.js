// What leaves the page: a picture as shown, renderings, exports, and the images that the script shows.

import { download, drawPicture, h } from "./dom.js";

const SIZES = ["640x360", "960x540", "1280x720", "1920x1080", "3840x2160"];
const QUALITIES = ["draft", "normal", "final"];

export class OutputPanel {
  /**
   * @param {HTMLElement} host
   * @param {import("./engine.js").Engine} engine
   * @param {import("./engine.js").Hello} hello
   * @param {import("./view.js").View} view
   * @param {(error: Error) => void} report
   */
  constructor(host, engine, hello, view, report) {
    this.engine = engine;
    this.view = view;
    this.report = report;
    this.name = (hello.file.split("/").pop() || "scene").replace(/\.cag$/, "");
    this.job = 0;
    const options = (/** @type {string[]} */ list, /** @type {string} */ chosen) => list.map((v) => h("option", { value: v, selected: v === chosen }, v.replace("x", " × ")));
    this.camera = h("select", { "aria-label": "Camera" });
    this.renderer = h("select", { "aria-label": "Renderer" }, h("option", { value: "preview" }, "built-in renderer"), hello.povray ? h("option", { value: "povray" }, "POV-Ray") : null);
    this.size = h("select", { "aria-label": "Size in pixels" }, ...options(SIZES, "960x540"));
    this.quality = h("select", { "aria-label": "Quality" }, ...options(QUALITIES, "normal"));
    this.start = h("button", { type: "button", onclick: () => this.render() }, "Render");
    this.stop = h("button", { type: "button", hidden: true, onclick: () => this.cancel() }, "Cancel");
    this.bar = h("progress", { max: 100, hidden: true, "aria-label": "Progress of the rendering" });
    this.phase = h("span", { class: "faint", role: "status" });
    this.result = h("canvas", { class: "picture", hidden: true, role: "img", "aria-label": "Rendered picture" });
    this.save = h("button", { type: "button", hidden: true, onclick: () => this.picture && download(`${this.name}.png`, this.picture) }, "Save picture");
    this.format = h("select", { "aria-label": "Format" }, ...hello.formats.map(([name, story]) => h("option", { value: name }, `.${name}: ${story}`)));
    /** @type {Blob | null} */
    this.picture = null;
    this.images = h("div", { class: "stack" });
    /** @type {import("./engine.js").SceneMessage | null} */
    this.scene = null;
    this.imagesOf = 0; // the run whose images are shown
    this.box = host.closest("details");
    this.box?.addEventListener("toggle", () => this.showImages());
    host.append(
      h("h3", {}, "Picture as shown"),
      h("div", { class: "row" }, h("button", { type: "button", onclick: () => this.snapshot(1) }, "Save PNG"), h("button", { type: "button", onclick: () => this.snapshot(2) }, "Save PNG, twice as large")),
      h("h3", {}, "Rendering"),
      h("div", { class: "grid2" }, this.camera, this.renderer, this.size, this.quality),
      h("div", { class: "row" }, this.start, this.stop, this.bar, this.phase), this.result, this.save,
      h("h3", {}, "Export"), h("div", { class: "row" }, this.format, h("button", { type: "button", onclick: () => this.export() }, "Export")),
      this.images);
  }

  /** @param {import("./engine.js").SceneMessage} scene */
  show(scene) {
    const chosen = this.camera.value;
    this.camera.replaceChildren(h("option", { value: "" }, "as shown"), ...scene.cameras.map((c) => h("option", { value: c.name }, c.name)));
    this.camera.value = scene.cameras.some((c) => c.name === chosen) ? chosen : "";
    this.scene = scene;
    this.showImages();
  }

  /** Images are asked for while they can be seen. */
  showImages() {
    if (!this.scene || !this.box?.open || this.imagesOf === this.scene.run) return;
    this.imagesOf = this.scene.run;
    const { images } = this.scene;
    if (images.length === 0) return this.images.replaceChildren();
    this.images.replaceChildren(h("h3", {}, "Images of the script"));
    for (const image of images) {
      const canvas = h("canvas", { class: "picture", role: "img", "aria-label": `Image ${image.name}` });
      this.images.append(h("figure", {}, canvas, h("figcaption", { class: "faint" }, image.width ? `${image.name}, ${image.width} × ${image.height}` : image.name)));
      this.engine.image(image.name).then((blob) => drawPicture(blob, canvas), this.report);
    }
  }

  /** @param {number} scale */
  async snapshot(scale) {
    await this.view.picture(scale).then((blob) => download(`${this.name}.png`, blob), this.report);
  }

  async render() {
    const [width, height] = this.size.value.split("x").map(Number);
    const camera = this.camera.value || this.view.orbit.description(width / height);
    this.start.disabled = true;
    try {
      const engine = /** @type {"preview" | "povray"} */ (this.renderer.value);
      this.job = await this.engine.render({ engine, quality: this.quality.value, width, height, camera });
      this.phase.textContent = "";
      this.stop.hidden = this.bar.hidden = false;
      this.bar.removeAttribute("value");
    } catch (error) {
      this.start.disabled = false;
      this.report(/** @type {Error} */ (error));
    }
  }

  /** @param {import("./engine.js").Progress} p */
  async progress(p) {
    if (p.job !== this.job) return;
    this.bar.value = p.percent;
    this.phase.textContent = p.done ? "" : p.phase;
    if (!p.done) return;
    this.finish();
    if (p.error) return this.report(new Error(p.error));
    try {
      this.picture = await this.engine.picture(p.job);
      await drawPicture(this.picture, this.result);
      this.result.hidden = this.save.hidden = false;
    } catch (error) {
      this.report(/** @type {Error} */ (error));
    }
  }

  finish() {
    this.start.disabled = false;
    this.stop.hidden = this.bar.hidden = true;
    this.phase.textContent = "";
  }

  async cancel() {
    const job = this.job;
    this.job = 0;
    this.finish();
    await this.engine.cancel(job).catch(this.report);
  }

  async export() {
    try {
      const { name, blob } = await this.engine.export(this.format.value);
      download(name, blob);
    } catch (error) {
      this.report(/** @type {Error} */ (error));
    }
  }
}
