// SPDX-License-Identifier: Apache-2.0
// Poses of the camera: 12 numbers, the rows of a 3x4 matrix from the camera's space to the world,
// in metres. The camera looks along -z, y is up.

import { textOfFloat } from "./state.js";

/** Numbers of the text of a pose. */
export const numbersOf = (text) => text.split(",").map(Number);
/** Text of the numbers of a pose. */
export const textOf = (pose) => pose.map(textOfFloat).join(",");

const column = (pose, i) => [pose[i], pose[4 + i], pose[8 + i]];
const add = (a, b, s = 1) => a.map((n, i) => n + s * b[i]);
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => a.map((n) => n / Math.hypot(...a));

/** Vector turned about a unit axis by an angle in radians (Rodrigues 1840). */
function turned(v, axis, angle) {
  const c = Math.cos(angle);
  const along = dot(axis, v) * (1 - c);
  const across = cross(axis, v);
  return v.map((n, i) => n * c + across[i] * Math.sin(angle) + axis[i] * along);
}

// Rounding must not make the columns anything but a rotation.
function poseOf(right, up, back, eye) {
  const z = unit(back);
  const x = unit(cross(up, z));
  const y = cross(z, x);
  return [0, 1, 2].flatMap((i) => [x[i], y[i], z[i], eye[i]]);
}

/** Turned about the world's vertical by yaw, then about the camera's right by pitch, in radians, around
 *  a point so many metres ahead; 0: on the spot. It does not pass the zenith. */
export function orbited(pose, yaw, pitch, ahead_m) {
  const [right, up, back, eye] = [0, 1, 2, 3].map((i) => column(pose, i));
  const pivot = add(eye, back, -ahead_m);
  const vertical = [0, 1, 0];
  const steepness = Math.asin(Math.max(-1, Math.min(1, back[1])));
  const most = 1.55;
  const lift = Math.max(-most, Math.min(most, steepness - pitch)) - steepness;
  const turn = (v) => turned(turned(v, right, -lift), vertical, yaw);
  const z = turn(back);
  return poseOf(turn(right), turn(up), z, add(pivot, z, ahead_m));
}

/** Moved along the camera's right and up, in metres. */
export function panned(pose, right_m, up_m) {
  const eye = add(add(column(pose, 3), column(pose, 0), right_m), column(pose, 1), up_m);
  return poseOf(column(pose, 0), column(pose, 1), column(pose, 2), eye);
}

/** Moved ahead, in metres. */
export function dollied(pose, ahead_m) {
  return poseOf(column(pose, 0), column(pose, 1), column(pose, 2), add(column(pose, 3), column(pose, 2), -ahead_m));
}
