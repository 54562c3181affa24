// The grid and axes in the plane z = 0.

import { Color, DoubleSide, Mesh, PlaneGeometry, ShaderMaterial } from "three";
import { roundUp } from "./scale.js";

const LEAST_PIXELS = 12; // between the lines of the grid

export class Grid {
  constructor() {
    this.material = new ShaderMaterial({
      uniforms: { step: { value: 1 }, extent: { value: 1 }, ink: { value: new Color() }, strength: { value: 1 } },
      vertexShader: `uniform float extent;
        varying vec2 at;
        varying vec2 around;
        void main() {
          around = position.xy;
          vec4 p = modelMatrix * vec4( position.xy * extent, 0.0, 1.0 );
          at = p.xy;
          gl_Position = projectionMatrix * viewMatrix * p;
        }`,
      // A line is one pixel wide, whatever the distance. Where lines come closer than two pixels, they fade.
      fragmentShader: `uniform float step;
        uniform vec3 ink;
        uniform float strength;
        varying vec2 at;
        varying vec2 around;
        float lines( float spacing ) {
          vec2 width = fwidth( at / spacing );
          vec2 away = abs( fract( at / spacing - 0.5 ) - 0.5 ) / width;
          vec2 seen = ( 1.0 - min( away, 1.0 ) ) * clamp( 1.0 - 2.0 * width, 0.0, 1.0 );
          return max( seen.x, seen.y );
        }
        void main() {
          float fade = 1.0 - smoothstep( 0.35, 1.0, length( around ) );
          float alpha = max( 0.12 * lines( step ), 0.26 * lines( 10.0 * step ) ) * strength;
          vec2 width = fwidth( at );
          vec2 axis = 1.0 - min( abs( at ) / width / 1.2, 1.0 );
          vec3 color = ink;
          if ( axis.y > 0.0 ) { color = mix( color, vec3( 0.82, 0.22, 0.2 ), axis.y ); alpha = max( alpha, axis.y * 0.85 ); }
          if ( axis.x > 0.0 ) { color = mix( color, vec3( 0.2, 0.62, 0.25 ), axis.x ); alpha = max( alpha, axis.x * 0.85 ); }
          gl_FragColor = vec4( color, alpha * fade );
        }`,
      transparent: true, depthWrite: false, side: DoubleSide,
    });
    this.mesh = new Mesh(new PlaneGeometry(2, 2), this.material);
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = -10;
  }

  /**
   * @param {import("./orbit.js").Orbit} orbit
   * @param {number} pixel  its size at the target, mm
   * @param {Color} ink
   */
  update(orbit, pixel, ink) {
    const extent = 8 * Math.max(orbit.halfHeight, orbit.radius);
    const uniforms = this.material.uniforms;
    uniforms.step.value = roundUp(LEAST_PIXELS * pixel);
    uniforms.extent.value = extent;
    uniforms.ink.value.copy(ink);
    // The grid follows the view.
    this.mesh.position.set(orbit.target.x, orbit.target.y, 0);
  }
}
