// SPDX-License-Identifier: Apache-2.0
// The form beside the picture: what photographers turn, then every other option by its name.
import { drawingOf } from "./api.js";
import { make, short } from "./make.js";

const kFstops = [1, 1.2, 1.4, 2, 2.8, 4, 5.6, 8, 11, 16, 22];
const kIrises = [
  ["", "circle"],
  ["polygon:5", "5 blades"],
  ["polygon:6", "6 blades"],
  ["polygon:7", "7 blades"],
  ["polygon:9", "9 blades"],
  ["polygon:7,0,0.5", "7 round blades"],
  ["square", "square"],
  ["triangle", "triangle"],
  ["star:5", "star"],
];
const kSizes = ["320x180", "640x360", "960x540", "1280x720", "1920x1080", "480x480", "360x640"];
const kDispersions = [
  ["", "as the picture needs"],
  ["shared", "none: one ray for all"],
  ["hero", "a ray for each wavelength"],
  ["split", "split at the lens"],
];

/** Builds the form into an element; it follows the settings, and sets them. */
export class Controls {
  #form;
  #settings;
  #facts;
  #shown = []; // functions that show the settings
  #ofScene = []; // likewise, of what the scene has
  #ids = new Set();
  #scene = "";

  constructor(form, settings, facts) {
    this.#form = form;
    this.#settings = settings;
    this.#facts = facts;
    form.addEventListener("submit", (event) => event.preventDefault());
    form.append(this.#lens(), this.#picture(), this.#sceneOf(null), this.#all());
    settings.addEventListener("change", () => this.#show());
    this.#show();
  }

  /** Takes what the scene has, once it is loaded. */
  meet(scene) {
    if (JSON.stringify(scene) === this.#scene) return; // a control may be in somebody's hand
    this.#scene = JSON.stringify(scene);
    this.#form.children[2].replaceWith(this.#sceneOf(scene));
    this.#show();
  }

  /** Marks the field that the server refused; "" for none. */
  refuse(name) {
    for (const input of this.#form.querySelectorAll("[name]")) {
      const wrong = input.name === name;
      input.classList.toggle("wrong", wrong);
      input.setAttribute("aria-invalid", String(wrong));
    }
  }

  #show() {
    for (const show of [...this.#shown, ...this.#ofScene]) show();
  }

  #row(label, input) {
    const id = `set-${input.name}`;
    input.id = this.#ids.has(id) ? `${id}-again` : id;
    this.#ids.add(id);
    return make("div", { className: "row" }, make("label", { htmlFor: input.id }, label), input);
  }

  #select(name, label, options, also = {}) {
    const input = make("select", { name }, ...options.map(([value, text]) => make("option", { value }, text)));
    input.addEventListener("change", () => this.#settings.set({ [name]: input.value, ...also }));
    this.#shown.push(() => {
      const value = this.#settings.text(name);
      if (![...input.options].some((option) => option.value === value))
        input.append(make("option", { value }, value));
      input.value = value;
    });
    return this.#row(label, input);
  }

  #input(name, label, attributes = {}) {
    const input = make("input", { name, type: "text", ...attributes });
    input.addEventListener("change", () => this.#settings.set({ [name]: input.value }));
    this.#shown.push(() => {
      if (document.activeElement !== input || input.value === "") input.value = this.#settings.text(name);
    });
    return this.#row(label, input);
  }

  #switch(name, label) {
    const input = make("input", { name, type: "checkbox" });
    input.addEventListener("change", () => this.#settings.set({ [name]: input.checked ? "on" : null }));
    this.#shown.push(() => (input.checked = this.#settings.text(name) !== ""));
    return this.#row(label, input);
  }

  // A text that is no number with that unit, such as frame:30, is shown as it is.
  #range(name, label, least, most, step, unit) {
    const input = make("input", { name, type: "range", min: least, max: most, step });
    const title = make("label", {}, label);
    input.addEventListener("input", () => this.#settings.set({ [name]: input.value + unit }, `range ${name}`));
    this.#shown.push(() => {
      const set = this.#settings.text(name);
      const number = Number(unit && set.endsWith(unit) ? set.slice(0, -unit.length) : set);
      if (set === "" || Number.isFinite(number)) input.value = number;
      title.textContent = `${label}: ${set === "" ? "as it is" : Number.isFinite(number) ? short(number) + unit : set}`;
    });
    const row = this.#row(label, input);
    title.htmlFor = input.id;
    row.firstChild.replaceWith(title);
    return row;
  }

  // A value on each line.
  #lines(name, label) {
    const input = make("textarea", { name, rows: 2 });
    input.addEventListener("change", () =>
      this.#settings.set({ [name]: input.value.split("\n").map((line) => line.trim()).filter(Boolean) }));
    this.#shown.push(() => (input.value = (this.#settings.fields[name] ?? []).join("\n")));
    return this.#row(label, input);
  }

  #lens() {
    const lenses = this.#facts.lenses;
    const drawing = make("img", { id: "drawing", alt: "", hidden: true });
    const about = make("p", { className: "help" });
    const ring = make("div", { className: "ring", role: "group", "aria-label": "f-number" });
    const select = this.#select("lens", "Lens", [
      ["", "as the scene has it"],
      ["pinhole", "pinhole"],
      ["thin", "thin lens"],
      ...[...lenses].sort((a, b) => a.year - b.year).map((lens) => [lens.name, `${lens.year} ${lens.name}`]),
    ]);
    this.#shown.push(() => {
      const name = this.#settings.text("lens");
      const lens = lenses.find((one) => one.name === name);
      drawing.hidden = !lens;
      if (lens && drawing.dataset.lens !== name) {
        drawing.dataset.lens = name;
        drawing.src = drawingOf(name);
        drawing.alt = `Section of ${lens.title}`;
      }
      about.textContent = lens
        ? `${lens.title}${lens.patent ? ` (${lens.patent})` : ""}: ${lens.focal_length_mm} mm, f/${lens.fstop}, ` +
          `${Number(lens.angle_deg.toPrecision(3))}°` + (lens.image_circle_mm
            ? `, image circle ${Number(lens.image_circle_mm.toPrecision(3))} mm: ` +
              (lens.image_circle_mm >= 43.2 ? "all of a 36 x 24 mm film" :
                `${Math.round((100 * lens.image_circle_mm) / 43.27)} % of the diagonal of a 36 x 24 mm film`)
            : "")
        : "";
      const set = Number.parseFloat(this.#settings.text("fstop").replace(/^f\//, ""));
      const stops = kFstops.filter((stop) => !lens || stop > lens.fstop);
      ring.replaceChildren(
        ...[["", lens ? `f/${lens.fstop}` : "open"], ...stops.map((stop) => [String(stop), `f/${stop}`])].map(
          ([value, text]) => {
            const pressed = value === "" ? !(set > 0) : Number(value) === set;
            const button = make("button", { type: "button", "aria-pressed": String(pressed) }, text);
            button.addEventListener("click", () => this.#settings.set({ fstop: value }));
            return button;
          }));
    });
    const hint = make("p", { className: "help" }, "Click in the picture to focus there.");
    return make("fieldset", {}, make("legend", {}, "Lens"), select, drawing, about, ring,
      this.#input("fstop", "f-number"), this.#select("aperture", "Iris", kIrises),
      this.#input("focus", "Focus", { placeholder: "auto, 1.5m, infinity" }), hint,
      this.#select("dispersion", "Dispersion", kDispersions));
  }

  #picture() {
    return make("fieldset", {}, make("legend", {}, "Picture"),
      this.#select("size", "Size", kSizes.map((size) => [size, size.replace("x", " x ")])),
      this.#input("spp", "Samples", { placeholder: "64", inputMode: "numeric" }),
      this.#input("noise", "Until noise", { placeholder: "2%" }),
      this.#switch("denoise", "Denoise"),
      this.#range("exposure", "Exposure, EV", -8, 8, 0.25, ""),
      this.#select("view", "View", [["", "as the scene asks"], ...this.#facts.views.map((view) => [view, view])]));
  }

  #sceneOf(scene) {
    const others = this.#shown;
    this.#shown = [];
    for (const name of ["camera", "variant", "at", "env", "env-rotate"]) this.#ids.delete(`set-${name}`);
    const rows = [];
    if (scene?.cameras.length > 1)
      rows.push(this.#select("camera", "Camera", [["", "first"],
        ...scene.cameras.map((name, i) => [String(i), name || `number ${i}`])],
        { pose: null, "look-at": null, orbit: null, "orbit-about": null }));
    if (scene?.variants.length > 0)
      rows.push(this.#select("variant", "Variant", [["", "first"], ...scene.variants.map((name) => [name, name])]));
    const duration_s = Math.max(0, ...(scene?.animations ?? []).map((one) => one.duration_s ?? 0));
    if (duration_s > 0)
      rows.push(this.#range("at", "Time", 0, duration_s, duration_s / 200, "s"));
    rows.push(this.#input("env", "Sky", { placeholder: "studio, or a file beside the scene" }),
      this.#range("env-rotate", "Sky turned, degrees", -180, 180, 5, ""));
    this.#ofScene = this.#shown;
    this.#shown = others;
    return make("fieldset", {}, make("legend", {}, "Scene"), ...rows);
  }

  #all() {
    const groups = new Map();
    for (const field of this.#facts.fields) {
      const title = field.group || "Picture";
      if (!groups.has(title)) groups.set(title, []);
      groups.get(title).push(field);
    }
    const all = make("details", {}, make("summary", {}, "All options"));
    for (const [title, fields] of groups) {
      const group = make("details", {}, make("summary", {}, title));
      for (const field of fields)
        group.append(
          field.kind === "switch" ? this.#switch(field.name, field.name)
            : field.kind === "list" ? this.#lines(field.name, field.name) : this.#input(field.name, field.name),
          make("p", { className: "help" }, field.help));
      all.append(group);
    }
    return all;
  }
}
