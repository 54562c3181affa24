// Joint values of robots as numbers and as texts of the language.

import { parseNumber } from "./params.js";

/** @typedef {import("./engine.js").Joint} Joint */

const DIGITS = 4; // after the point, of degrees and mm

/** Rounds a value so that it stays within the limits, if it was. @param {Joint} joint @param {number} value @param {number} [digits] */
export function roundJoint(joint, value, digits = DIGITS) {
  const scale = 10 ** digits, rounded = Math.round(value * scale) / scale;
  if (value < joint.low || value > joint.high) return rounded;
  if (rounded < joint.low) return Math.ceil(joint.low * scale) / scale;
  if (rounded > joint.high) return Math.floor(joint.high * scale) / scale;
  return rounded + 0; // never -0
}

/** @param {Joint} joint @param {number} value */
export const clampJoint = (joint, value) => Math.min(joint.high, Math.max(joint.low, value));

/** The list q as an expression: [30deg, -45deg, 120]. @param {Joint[]} joints @param {number[]} q */
export function jointsExpression(joints, q) {
  return `[${joints.map((joint, i) => `${roundJoint(joint, q[i])}${joint.unit === "deg" ? "deg" : ""}`).join(", ")}]`;
}

/** Whether two robots have the same joints with the same values in the script. @param {Joint[]} a @param {Joint[]} b */
export function sameJoints(a, b) {
  return a.length === b.length && a.every((joint, i) => joint.kind === b[i].kind && joint.value === b[i].value && joint.low === b[i].low && joint.high === b[i].high);
}

/**
 * The text of a number in the script for another value, in its unit; null: the text is not the number that the joint has.
 *
 * @param {string} text  such as -0.5rad
 * @param {Joint} joint
 * @param {number} value
 */
export function rewriteJoint(text, joint, value) {
  // A sign can stand apart from its number.
  const found = /^(-?)\s*(\S.*)$/s.exec(text.trim()), number = found && parseNumber(found[1] + found[2]);
  if (!found || number === null || Math.abs(number - joint.value) > 1e-6 * Math.max(1, Math.abs(joint.value))) return null;
  const unit = /[a-z]*$/.exec(found[2])?.[0] ?? "", size = parseNumber(`1${unit}`) ?? 1;
  return `${Number((roundJoint(joint, value) / size).toPrecision(10))}${unit}`;
}
