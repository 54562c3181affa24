// Materials, lights, and sky, as close to cag's renderers as the page's renderer comes.
//
// Pictures are tone mapped as cag's PNG files are (interp/render/png.h): values up to 0.8 stay, and larger ones approach 1.

import {
  Color, DataTexture, DirectionalLight, DoubleSide, EquirectangularReflectionMapping, FloatType, FrontSide, Group, LinearFilter, Mesh,
  MeshPhysicalMaterial, MeshStandardMaterial, PlaneGeometry, PointLight, RGBAFormat, ShaderChunk, ShaderMaterial, SpotLight, Vector3,
} from "three";

/** @typedef {import("./engine.js").SceneMessage} SceneMessage */

const SHOULDER = 0.8;
// Surfaces receive less light from the sky than an open sky gives, because things stand in the way. As in cag's drafts.
const SKY_FRACTION = 0.5;
// The environment of a scene without a sky: cag's drafts have a dim light of 0.12 from everywhere.
const DIM = 0.12 / SKY_FRACTION;
// A spot has full light in this part of its cone.
const SPOT_CORE = 0.8;
const SKY_HEIGHT = 64; // pixels of the environment

ShaderChunk.tonemapping_pars_fragment = ShaderChunk.tonemapping_pars_fragment.replace(
  "vec3 CustomToneMapping( vec3 color ) { return color; }",
  `vec3 CustomToneMapping( vec3 color ) {
    vec3 x = max( color * toneMappingExposure, vec3( 0.0 ) ), s = vec3( ${SHOULDER.toFixed(3)} ), room = 1.0 - s;
    return mix( x, s + room * ( 1.0 - exp( - ( x - s ) / room ) ), step( s, x ) );
  }`);

// Reflections see the sky with its full light.
ShaderChunk.envmap_physical_pars_fragment = ShaderChunk.envmap_physical_pars_fragment.replace(
  "return PI * envMapColor.rgb * envMapIntensity;", `return ${SKY_FRACTION.toFixed(3)} * PI * envMapColor.rgb * envMapIntensity;`);

/** The color of a pattern from afar. @param {import("./engine.js").Material} m */
function meanColor(m) {
  const c = new Color().setRGB(...m.color);
  return m.texture ? c.lerp(new Color().setRGB(...m.color2), 0.35) : c;
}

/**
 * @param {import("./engine.js").Material} m
 * @param {{ glass: boolean, flat: boolean, thickness: number, oneSided: boolean }} options
 *   glass: shown transparent; flat: the mesh has no normals; thickness: of the part, mm
 */
export function makeMaterial(m, { glass, flat, thickness, oneSided }) {
  const passes = m.transmission > 0 && !glass, physical = passes || m.coat > 0;
  const material = physical ? new MeshPhysicalMaterial() : new MeshStandardMaterial();
  material.color.copy(meanColor(m));
  material.metalness = m.metallic;
  material.roughness = Math.max(m.roughness, 0.04);
  material.emissive.setRGB(...m.emission);
  material.side = oneSided ? FrontSide : DoubleSide;
  material.flatShading = flat;
  material.polygonOffset = true; // edges are drawn in front of their faces
  material.polygonOffsetFactor = material.polygonOffsetUnits = 1;
  if (material instanceof MeshPhysicalMaterial) {
    material.ior = Math.min(2.333, Math.max(1, m.ior));
    material.clearcoat = m.coat;
    material.clearcoatRoughness = 0.04;
    if (passes) {
      material.transmission = m.transmission;
      material.thickness = thickness / 2;
    }
  }
  if (glass) {
    material.transparent = true;
    material.opacity = 0.22;
    material.depthWrite = false;
  }
  return material;
}

const SHADOW_SIZE = 1024; // pixels of a shadow map
const ALMOST_HALF = Math.PI / 2 - 0.01; // the cone of a light that shines on everything in front of it

/**
 * The lights of a scene. Those outside of it cast shadows.
 *
 * @param {SceneMessage} scene
 * @param {import("three").Sphere} sphere  around what is shown
 */
export function makeLights(scene, sphere) {
  const group = new Group();
  for (const l of scene.lights) {
    const color = new Color().setRGB(...l.color);
    // A strength of 1 makes a white matte face white, and three.js divides by pi.
    const intensity = l.strength * Math.PI, at = new Vector3(...l.position), along = new Vector3(...l.direction);
    if (l.kind === "sun") {
      const light = new DirectionalLight(color, intensity);
      light.position.copy(along).multiplyScalar(-2 * sphere.radius).add(sphere.center);
      light.target.position.copy(sphere.center);
      const { camera } = light.shadow, r = sphere.radius;
      Object.assign(camera, { left: -r, right: r, top: r, bottom: -r, near: 0.5 * r, far: 8 * r });
      group.add(castShadow(light, (2 * r) / SHADOW_SIZE), light.target);
      continue;
    }
    const distance = at.distanceTo(sphere.center), outside = distance > 1.2 * sphere.radius;
    if (l.kind !== "spot" && !outside) {
      const light = new PointLight(color, intensity, 0, 0);
      light.position.copy(at);
      group.add(light);
      continue;
    }
    const cone = Math.min(ALMOST_HALF, l.kind === "spot" ? (l.angle * Math.PI) / 360 : ALMOST_HALF);
    const light = new SpotLight(color, intensity, 0, cone, l.kind === "spot" ? 1 - SPOT_CORE : 0, 0);
    light.position.copy(at);
    light.target.position.copy(l.kind === "spot" ? at.clone().add(along) : sphere.center);
    const half = outside ? Math.min(cone, Math.asin(sphere.radius / distance)) : cone;
    // The shadow map covers the scene only.
    light.shadow.focus = half / cone;
    light.shadow.camera.near = outside ? distance - sphere.radius : sphere.radius / 100;
    light.shadow.camera.far = distance + 4 * sphere.radius;
    group.add(castShadow(light, (2 * distance * Math.tan(half)) / SHADOW_SIZE), light.target);
  }
  return group;
}

/** @template {DirectionalLight | SpotLight} T @param {T} light @param {number} pixel  of the shadow map, mm @returns {T} */
function castShadow(light, pixel) {
  light.castShadow = true;
  light.shadow.mapSize.set(SHADOW_SIZE, SHADOW_SIZE);
  light.shadow.normalBias = 3 * pixel;
  light.shadow.bias = -2e-4;
  light.shadow.radius = 3;
  return light;
}

/** The color of the sky at a height from 0, below, to 1, above. @param {import("./engine.js").Triple[]} colors @param {number} height */
function skyAt(colors, height) {
  if (colors.length === 0) return new Color(DIM, DIM, DIM);
  const at = height * (colors.length - 1), k = Math.max(0, Math.min(colors.length - 2, Math.floor(at)));
  const low = new Color().setRGB(...colors[k]);
  return colors.length < 2 ? low : low.lerp(new Color().setRGB(...colors[k + 1]), at - k);
}

/** What surfaces reflect: the sky as a panorama with Y up. @param {SceneMessage} scene */
export function makeEnvironment(scene) {
  const width = 2 * SKY_HEIGHT, data = new Float32Array(4 * width * SKY_HEIGHT);
  for (let y = 0; y < SKY_HEIGHT; y++) {
    const angle = ((y + 0.5) / SKY_HEIGHT - 0.5) * Math.PI, color = skyAt(scene.sky, (Math.sin(angle) + 1) / 2);
    for (let x = 0; x < width; x++) data.set([color.r, color.g, color.b, 1], 4 * (y * width + x));
  }
  const texture = new DataTexture(data, width, SKY_HEIGHT, RGBAFormat, FloatType);
  texture.mapping = EquirectangularReflectionMapping;
  texture.magFilter = texture.minFilter = LinearFilter;
  texture.needsUpdate = true;
  return texture;
}

const MOST_SKY_COLORS = 8;

/** The sky behind everything. */
export class Backdrop {
  constructor() {
    this.material = new ShaderMaterial({
      uniforms: { colors: { value: Array.from({ length: MOST_SKY_COLORS }, () => new Color()) }, count: { value: 0 } },
      vertexShader: `varying vec3 direction;
        void main() {
          gl_Position = vec4( position.xy, 1.0, 1.0 );
          vec3 seen = vec3( position.x / projectionMatrix[0][0], position.y / projectionMatrix[1][1], -1.0 );
          // The rays of a camera without perspective are parallel.
          if ( projectionMatrix[3][3] == 1.0 ) seen.xy = vec2( 0.0 );
          direction = transpose( mat3( viewMatrix ) ) * seen;
        }`,
      fragmentShader: `uniform vec3 colors[${MOST_SKY_COLORS}];
        uniform int count;
        varying vec3 direction;
        void main() {
          float at = ( normalize( direction ).z + 1.0 ) / 2.0 * float( count - 1 );
          vec3 color = colors[0];
          for ( int i = 1; i < ${MOST_SKY_COLORS}; i++ ) if ( i < count ) color = mix( color, colors[i], clamp( at - float( i - 1 ), 0.0, 1.0 ) );
          gl_FragColor = vec4( color, 1.0 );
          #include <tonemapping_fragment>
          #include <colorspace_fragment>
        }`,
      depthTest: false, depthWrite: false,
    });
    this.mesh = new Mesh(new PlaneGeometry(2, 2), this.material);
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = -1000;
  }

  /** @param {SceneMessage} scene */
  show(scene) {
    const colors = scene.sky.length ? scene.sky : scene.background ? [scene.background] : [];
    const count = Math.min(colors.length, MOST_SKY_COLORS);
    // More colors than fit are sampled evenly.
    for (let i = 0; i < count; i++)
      this.material.uniforms.colors.value[i].copy(colors.length > MOST_SKY_COLORS ? skyAt(colors, i / (count - 1)) : new Color().setRGB(...colors[i]));
    this.material.uniforms.count.value = count;
    return count > 0;
  }
}
