// SPDX-License-Identifier: Apache-2.0
// The picture, and how it is taken hold of: by mouse, touch and keys.
import { dollied, numbersOf, orbited, panned, textOf } from "./pose.js";

const kClick_px = 5;
const kRadians_per_width = Math.PI;
const kWheel_per_px = 0.0015;
const kKey_rad = 0.05;
const kKey_share = 0.05;

/** View finder on a canvas. It sets the fields "pose" and "focus" of the settings. Event "pinhole": a camera that has
 *  no focus was to be focused. */
export class Finder extends EventTarget {
  #canvas;
  #mark;
  #settings;
  #drag;
  #camera = null;
  #ahead_m = 1; // of what the camera turns about
  #pointers = new Map();
  #moved = 0;
  #step = 0;

  constructor(canvas, mark, drag, settings) {
    super();
    this.#canvas = canvas;
    this.#mark = mark;
    this.#drag = drag;
    this.#settings = settings;
    canvas.addEventListener("pointerdown", (event) => this.#down(event));
    canvas.addEventListener("pointermove", (event) => this.#move(event));
    for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, (event) => this.#up(event));
    canvas.addEventListener("wheel", (event) => this.#wheel(event), { passive: false });
    canvas.addEventListener("keydown", (event) => this.#key(event));
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  }

  /** Takes the camera that the server has set up for the settings as they are. */
  meet(camera) {
    this.#camera = camera;
    if (this.#pointers.size === 0) this.#ahead_m = camera.middle_m || camera.focus_m || this.#ahead_m;
  }

  /** Draws a picture, whatever its size, over the whole canvas. */
  draw(image) {
    if (this.#canvas.width !== image.width) this.#canvas.width = image.width;
    if (this.#canvas.height !== image.height) this.#canvas.height = image.height;
    this.#canvas.getContext("2d").putImageData(image, 0, 0);
  }

  /** Gives the canvas the shape of a picture of that size. */
  shape(width, height) {
    this.#canvas.style.aspectRatio = `${width} / ${height}`;
    this.#canvas.parentElement.style.setProperty("--aspect", String(width / height));
  }

  get #pose() {
    const set = numbersOf(this.#settings.text("pose"));
    if (set.length === 12 && set.every(Number.isFinite)) return set;
    return this.#camera ? numbersOf(this.#camera.pose) : null;
  }

  #setPose(pose, step) {
    // The other ways to say where the camera stands are none beside a pose; the camera's lens and angle stay.
    const camera = this.#settings.text("camera") || (this.#camera?.camera ?? "");
    this.#settings.set({ pose: textOf(pose), camera, "look-at": null, orbit: null, "orbit-about": null }, step);
  }

  #turn(yaw, pitch, mode, step) {
    const pose = this.#pose;
    if (!pose) return;
    if (mode === "pan") {
      const scale = this.#ahead_m / kRadians_per_width;
      this.#setPose(panned(pose, yaw * scale, -pitch * scale), step);
    } else {
      this.#setPose(orbited(pose, yaw, pitch, mode === "look" ? 0 : this.#ahead_m), step);
    }
  }

  #come(share, step) {
    const pose = this.#pose;
    if (!pose) return;
    const way_m = this.#ahead_m * share;
    this.#ahead_m -= way_m;
    this.#setPose(dollied(pose, way_m), step);
  }

  #focusAt(u, v) {
    if (this.#camera?.focus_m === 0) {
      this.dispatchEvent(new Event("pinhole"));
      return;
    }
    const [width, height] = (this.#settings.text("size") || "1280x720").split("x").map(Number);
    const pixel = (share, count) => Math.max(0, Math.min(count - 1, Math.floor(share * count)));
    this.#settings.try({ focus: `${pixel(u, width)},${pixel(v, height)}` });
    this.#mark.style.left = `${100 * u}%`;
    this.#mark.style.top = `${100 * v}%`;
    this.#mark.hidden = false;
    setTimeout(() => (this.#mark.hidden = true), 1500);
  }

  #down(event) {
    this.#canvas.setPointerCapture(event.pointerId);
    this.#pointers.set(event.pointerId, [event.clientX, event.clientY]);
    if (this.#pointers.size === 1) {
      this.#moved = 0;
      ++this.#step;
    }
    this.#canvas.classList.add("dragged");
  }

  #move(event) {
    const before = this.#pointers.get(event.pointerId);
    if (!before) return;
    const now = [event.clientX, event.clientY];
    const width = this.#canvas.clientWidth;
    const d = [now[0] - before[0], now[1] - before[1]];
    this.#moved += Math.hypot(...d);
    if (this.#pointers.size === 2) {
      const other = [...this.#pointers.entries()].find(([id]) => id !== event.pointerId)[1];
      const apart = (p) => Math.hypot(p[0] - other[0], p[1] - other[1]);
      this.#pointers.set(event.pointerId, now);
      if (apart(now) > 1) this.#come(1 - apart(before) / apart(now), `drag ${this.#step}`);
      return;
    }
    if (this.#moved <= kClick_px) return;
    this.#pointers.set(event.pointerId, now);
    const mode = event.shiftKey || event.buttons & 6 ? "pan" : this.#drag.value;
    // What is taken hold of follows the hand.
    const sign = mode === "look" ? 1 : -1;
    const scale = (sign * kRadians_per_width) / width;
    this.#turn(d[0] * scale, d[1] * scale, mode, `drag ${this.#step}`);
  }

  #up(event) {
    if (!this.#pointers.delete(event.pointerId)) return;
    if (this.#pointers.size > 0) {
      this.#moved = Infinity; // the other finger does not click
      return;
    }
    this.#canvas.classList.remove("dragged");
    if (event.type === "pointerup" && event.button === 0 && this.#moved <= kClick_px) {
      const box = this.#canvas.getBoundingClientRect();
      this.#focusAt((event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height);
    }
  }

  #wheel(event) {
    event.preventDefault();
    const px = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 16 * event.deltaY : event.deltaY;
    this.#come(1 - Math.exp(kWheel_per_px * px), "wheel");
  }

  #key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const mode = event.shiftKey ? "pan" : "orbit";
    const ways = {
      ArrowLeft: [-1, 0],
      ArrowRight: [1, 0],
      ArrowUp: [0, 1],
      ArrowDown: [0, -1],
    };
    const way = ways[event.key];
    if (way) this.#turn(way[0] * kKey_rad, -way[1] * kKey_rad, mode, `keys ${mode}`);
    else if (event.key === "+" || event.key === "=") this.#come(kKey_share, "keys");
    else if (event.key === "-") this.#come(-kKey_share, "keys");
    else if (event.key === "Enter") this.#focusAt(0.5, 0.5);
    else return;
    event.preventDefault();
  }
}
