// The frames of a robot: small axes at its joints and its tool, and the line through them.

import { Color } from "three";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";

const AXIS_COLORS = [0xd14b3d, 0x3c9a48, 0x3f7fd6].map((c) => new Color(c).toArray());
const LINE_COLOR = new Color(0x8a94a0).toArray();
const WIDTH = 2.5; // pixels
const LENGTH = 0.05; // of an axis, in sizes of the robot
const TOOL_LENGTH = 1.7; // of the axes of the tool, relative to those of the joints

/** @param {number[]} frame @returns {[number, number, number]} */
const originOf = (frame) => [frame[3], frame[7], frame[11]];

/** The length of the line through all frames, mm. @param {number[][]} frames */
function sizeOf(frames) {
  let sum = 0;
  for (let i = 1; i < frames.length; i++) sum += Math.hypot(...originOf(frames[i]).map((x, k) => x - originOf(frames[i - 1])[k]));
  return sum;
}

export class Frames {
  constructor() {
    this.material = new LineMaterial({ linewidth: WIDTH, vertexColors: true, depthTest: false, depthWrite: false, transparent: true, toneMapped: false });
    this.lines = new LineSegments2(new LineSegmentsGeometry(), this.material);
    this.lines.frustumCulled = false;
    this.lines.renderOrder = 1e6; // over everything
    this.lines.visible = false;
  }

  /** @param {number[][]} frames  3 rows of 4 for each @param {number[]} tool */
  show(frames, tool) {
    const all = [...frames, tool], length = LENGTH * sizeOf(all);
    const points = /** @type {number[]} */ ([]), colors = /** @type {number[]} */ ([]);
    const add = (/** @type {number[]} */ a, /** @type {number[]} */ b, /** @type {number[]} */ color) => {
      points.push(...a, ...b);
      colors.push(...color, ...color);
    };
    for (let i = 1; i < all.length; i++) add(originOf(all[i - 1]), originOf(all[i]), LINE_COLOR);
    all.forEach((frame, i) => {
      const at = originOf(frame), long = i === all.length - 1 ? TOOL_LENGTH * length : length;
      AXIS_COLORS.forEach((color, k) => {
        const axis = [frame[k], frame[4 + k], frame[8 + k]], size = Math.hypot(...axis) || 1;
        add(at, at.map((x, n) => x + (axis[n] / size) * long), color);
      });
    });
    this.lines.geometry.dispose();
    this.lines.geometry = new LineSegmentsGeometry();
    this.lines.geometry.setPositions(points);
    this.lines.geometry.setColors(colors);
    this.lines.visible = true;
  }

  hide() {
    this.lines.visible = false;
  }
}
