// Outlines around parts that are picked or pointed at.
//
// The parts are drawn into a mask, red for what is picked and green for what is pointed at. A second pass colors the pixels near the border of
// the mask. Cost does not depend on the meshes, and hidden parts of the outline are seen, too.

import { Color, Mesh, MeshBasicMaterial, DoubleSide, OrthographicCamera, PlaneGeometry, Scene, ShaderMaterial, Vector2, WebGLRenderTarget } from "three";

const WIDTH = 2; // pixels of the page

export class Outline {
  constructor() {
    this.target = new WebGLRenderTarget(1, 1, { depthBuffer: false });
    const paint = (/** @type {number} */ color) =>
      new MeshBasicMaterial({ color, side: DoubleSide, depthTest: false, depthWrite: false, toneMapped: false, blending: 2, transparent: true });
    this.picked = paint(0xff0000);
    this.pointed = paint(0x00ff00);
    this.material = new ShaderMaterial({
      uniforms: {
        mask: { value: this.target.texture }, pixel: { value: new Vector2() }, width: { value: WIDTH },
        picked: { value: new Color() }, pointed: { value: new Color() },
      },
      vertexShader: "varying vec2 at; void main() { at = uv; gl_Position = vec4( position.xy, 0.0, 1.0 ); }",
      fragmentShader: `uniform sampler2D mask;
        uniform vec2 pixel;
        uniform float width;
        uniform vec3 picked, pointed;
        varying vec2 at;
        void main() {
          vec2 here = texture2D( mask, at ).rg, most = here, least = here;
          for ( int i = 0; i < 12; i++ ) {
            float angle = float( i ) * 0.5235988;
            vec2 there = texture2D( mask, at + pixel * width * vec2( cos( angle ), sin( angle ) ) ).rg;
            most = max( most, there );
            least = min( least, there );
          }
          vec2 border = most - least;
          // Outside, the line is full; inside, it is a glow that leaves the surface to be seen.
          float a = border.r * ( here.r > 0.5 ? 0.5 : 1.0 ), b = border.g * ( here.g > 0.5 ? 0.4 : 0.9 );
          float alpha = max( a, b );
          if ( alpha < 0.02 ) discard;
          gl_FragColor = vec4( a >= b ? picked : pointed, alpha );
          #include <colorspace_fragment>
        }`,
      depthTest: false, depthWrite: false, transparent: true, toneMapped: false,
    });
    this.quad = new Scene();
    const mesh = new Mesh(new PlaneGeometry(2, 2), this.material);
    mesh.frustumCulled = false;
    this.quad.add(mesh);
    this.flat = new OrthographicCamera(-1, 1, 1, -1, 0, 1);
    this.masked = new Scene();
    this.masked.matrixWorldAutoUpdate = false;
    this.clear = new Color(0, 0, 0);
  }

  /**
   * @param {import("three").WebGLRenderer} renderer
   * @param {import("three").Camera} camera
   * @param {(import("./parts.js").PartView | import("./faces.js").Piece)[]} picked
   * @param {(import("./parts.js").PartView | import("./faces.js").Piece)[]} pointed
   * @param {import("three").Plane[]} clipping
   */
  render(renderer, camera, picked, pointed, clipping) {
    const meshes = [...this.masks(picked, this.picked, clipping), ...this.masks(pointed, this.pointed, clipping)];
    if (meshes.length === 0) return;
    const size = renderer.getDrawingBufferSize(new Vector2());
    if (this.target.width !== size.x || this.target.height !== size.y) this.target.setSize(size.x, size.y);
    this.material.uniforms.pixel.value.set(1 / size.x, 1 / size.y);
    this.material.uniforms.width.value = WIDTH * renderer.getPixelRatio();
    this.masked.children = meshes;
    const color = renderer.getClearColor(new Color()), alpha = renderer.getClearAlpha();
    renderer.setRenderTarget(this.target);
    renderer.setClearColor(this.clear, 1);
    renderer.clear();
    renderer.render(this.masked, camera);
    renderer.setRenderTarget(null);
    renderer.setClearColor(color, alpha);
    renderer.render(this.quad, this.flat);
    this.masked.children = [];
  }

  /** @param {(import("./parts.js").PartView | import("./faces.js").Piece)[]} views @param {MeshBasicMaterial} material @param {import("three").Plane[]} clipping */
  masks(views, material, clipping) {
    material.clippingPlanes = clipping;
    return views.filter((v) => v.surface && v.group.visible).map((v) => {
      const mesh = new Mesh(v.shape.surface.groups.length ? ungrouped(v.shape.surface) : v.shape.surface, material);
      mesh.matrixAutoUpdate = false;
      mesh.matrixWorld.copy(v.group.matrix);
      mesh.frustumCulled = false;
      return mesh;
    });
  }
}

/** @type {WeakMap<import("three").BufferGeometry, import("three").BufferGeometry>} */
const whole = new WeakMap();

/** The same buffers without groups, which would need a material each. @param {import("three").BufferGeometry} geometry */
function ungrouped(geometry) {
  let one = whole.get(geometry);
  if (!one) {
    one = /** @type {import("three").BufferGeometry} */ (new (/** @type {any} */ (geometry.constructor))());
    for (const [name, attribute] of Object.entries(geometry.attributes)) one.setAttribute(name, attribute);
    one.setIndex(geometry.index);
    one.boundingBox = geometry.boundingBox;
    one.boundingSphere = geometry.boundingSphere;
    whole.set(geometry, one);
    const copy = one;
    geometry.addEventListener("dispose", () => copy.dispose());
  }
  return one;
}
