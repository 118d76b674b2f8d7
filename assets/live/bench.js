// SPDX-License-Identifier: Apache-2.0
// The lens beside the picture: its section with rays, its figures at the field point under the pointer, and its
// numbers, which may be changed.
import { make, offer, oneAtATime, short } from "./make.js";
import { line, plot, svg } from "./plots.js";

const kColumns = [["radius", "radius, mm"], ["thickness", "thickness, mm"], ["semi_diameter", "half height, mm"], ["glass", "glass"]];
/** Bench of the lens that the settings name. It sets the field "lens" when the lens is changed. */
export class Bench {
  #parent;
  #connection;
  #settings;
  #lens = null; // the file's JSON, as it is changed
  #name = "";
  #file = ""; // that the server keeps of the changed one
  #camera = null;
  #height_mm = 0;
  #section = svg("svg", { id: "section", role: "img", "aria-label": "Section of the lens with rays of three wavelengths" });
  #plots = make("div", { className: "plots" });
  #figures = make("dl", { id: "figures" });
  #fault = make("p", { id: "bench-fault", role: "alert" });
  #table = make("table", { id: "surfaces" });
  #field = make("input", { type: "range", id: "field", min: 0, max: 1, step: "any", value: 0 });

  constructor(parent, canvas, connection, settings) {
    this.#parent = parent;
    this.#connection = connection;
    this.#settings = settings;
    const save = make("button", { type: "button", id: "save-lens" }, "Save lens");
    save.addEventListener("click", () => this.#save());
    const back = make("button", { type: "button", id: "restore-lens" }, "As it ships");
    back.addEventListener("click", () => this.#settings.set({ lens: this.#name }));
    this.#field.addEventListener("input", () => this.#point(Number(this.#field.value)));
    parent.append(make("summary", {}, "The lens on the bench"), this.#fault, this.#section,
      make("label", {}, "Field point: ", this.#field), this.#figures, this.#plots, this.#table,
      make("div", { className: "tools" }, save, back));
    parent.addEventListener("toggle", () => this.#follow());
    settings.addEventListener("change", () => this.#follow());
    canvas.addEventListener("pointermove", (event) => {
      if (event.buttons !== 0 || !this.#camera || !this.#lens) return;
      const box = canvas.getBoundingClientRect();
      const [width, height] = this.#camera.sensor_mm;
      this.#point(Math.hypot(((event.clientX - box.left) / box.width - 0.5) * width,
        ((event.clientY - box.top) / box.height - 0.5) * height));
    });
    this.#section.addEventListener("pointerdown", (event) => this.#take(event));
  }

  /** Takes the camera that was set up. */
  meet(camera) {
    this.#camera = camera;
    this.#field.max = Math.hypot(...camera.sensor_mm) / 2 || 1;
    this.#measure();
  }

  async #follow() {
    const lens = this.#settings.text("lens");
    if (!this.#parent.open || lens === this.#file) return this.#measure();
    const text = lens && (await this.#connection.lens(lens));
    this.#lens = text ? JSON.parse(text) : null;
    this.#name = lens;
    this.#file = lens;
    this.#fault.textContent = this.#lens ? "" : "Choose one of the lenses that ship to see it here.";
    for (const part of [this.#section, this.#figures, this.#plots, this.#table]) part.replaceChildren();
    if (this.#lens) this.#list();
    this.#measure();
  }

  #point(height_mm) {
    this.#height_mm = height_mm;
    this.#field.value = height_mm;
    this.#measure();
  }

  #measure = oneAtATime(async () => {
    if (!this.#parent.open || !this.#lens) return;
    const focus_m = this.#camera?.focus_m ?? 0;
    const fstop = Number.parseFloat(this.#settings.text("fstop").replace(/^f\//, "")) || 0;
    const found = await this.#connection.bench({
      lens: JSON.stringify(this.#lens), height_mm: this.#height_mm, focus_m, fstop });
    this.#fault.textContent = found?.error ?? "";
    if (found && !found.error) this.#draw(found);
  });

  #draw(found) {
    const heights = found.faces.flat().map(([, h]) => Math.abs(h));
    const top = 1.1 * Math.max(...heights, found.film.radius);
    const left = -0.12 * found.film.z;
    const width = 1.05 * found.film.z - left;
    this.#section.setAttribute("viewBox", `${left} ${-top} ${width} ${2 * top}`);
    const { z, radius } = found.stop;
    this.#section.replaceChildren(
      svg("path", { class: "axis", d: `M${left} 0H${left + width}` }),
      ...found.elements.map((points) => svg("path", { class: "glass", d: line(points, true) })),
      ...found.rays.map((ray) => svg("path", { class: "ray", d: line(ray.path), stroke: ray.colour })),
      ...found.faces.map((points, i) => svg("path", { class: "face", d: line(points), "data-face": i })),
      svg("path", { class: "stop", d: `M${z} ${-radius}V${-top}M${z} ${radius}V${top}`, "data-face": found.stop.surface }),
      svg("path", { class: "stop", d: `M${found.film.z} ${-found.film.radius}V${found.film.radius}` }));
    this.#figures.replaceChildren(
      ...found.figures.flatMap(([name, text]) => [make("dt", {}, name), make("dd", {}, text)]));
    const middle = found.middle_mm;
    const spots = found.spots.map(({ colour, film_mm }) => ({ style: "dots", colour,
      paths: [film_mm.map((point) => [1000 * (point[0] - middle[0]), 1000 * (point[1] - middle[1])])] }));
    const most = (series) => Math.max(...series.flatMap(({ paths }) => paths[0].flat().map(Math.abs)), 1e-3);
    const reach = most(spots);
    const fans = ["tangential", "sagittal"].map((name) =>
      found.fans[name].map(({ colour, um }) => ({ style: "", colour, paths: [um] })));
    const um = Math.max(...fans.flat().flatMap(({ paths }) => paths[0].map((point) => Math.abs(point[1]))), 1e-3);
    const square = (title, x, y, series) => plot({ title, x, y, series, square: true });
    this.#plots.replaceChildren(
      square(`Spot, ${short(reach)} µm to each side`, [-reach, reach], [-reach, reach], spots),
      square(`Fan along the field, ±${short(um)} µm`, [-1.05, 1.05], [-um, um], fans[0]),
      square(`Fan across it, ±${short(um)} µm`, [-1.05, 1.05], [-um, um], fans[1]),
      square("Contrast to 80 cycles/mm, geometric; bold: along the field", [0, 80], [0, 1],
        [["bold", found.mtf.tangential], ["", found.mtf.sagittal]].map(([style, path]) =>
          ({ style, colour: "currentColor", paths: [path] }))));
  }

  #list() {
    const head = make("tr", {}, make("th", {}, ""), ...kColumns.map(([, title]) => make("th", {}, title)));
    const rows = this.#lens.surfaces.map((surface, i) => {
      const cells = kColumns.map(([name, title]) => {
        const input = make("input", { value: this.#value(surface, name), "aria-label": `${title}, surface ${i + 1}` });
        input.addEventListener("change", () => this.#change(i, name, input.value.trim()));
        return make("td", {}, input);
      });
      return make("tr", {}, make("th", {}, surface.stop ? `${i + 1} stop` : `${i + 1}`), ...cells);
    });
    this.#table.replaceChildren(head, ...rows);
  }

  #value(surface, name) {
    if (name === "glass") return surface.medium?.glass ?? (surface.medium ? "model" : "");
    return surface[name] ?? "";
  }

  #change(i, name, text) {
    const surface = this.#lens.surfaces[i];
    if (name === "glass") {
      if (text === "model") return;
      surface.medium = text === "" ? null : { glass: text };
    } else {
      surface[name] = text === "" ? null : Number(text);
    }
    this.#keep();
  }

  // The changed lens becomes that of the picture, once the server has it as a file.
  async #keep() {
    await this.#measure();
    const answer = await this.#connection.keepLens(JSON.stringify(this.#lens, null, 1));
    if (answer?.error) {
      this.#fault.textContent = answer.error;
      return;
    }
    if (!answer) return;
    this.#file = answer.lens;
    this.#settings.set({ lens: answer.lens }, "lens");
  }

  // A face that is taken hold of moves along the axis: its lens becomes thicker, the air before it thinner. With Shift
  // its middle moves against its edge: the curvature.
  #take(event) {
    const face = event.target.dataset?.face;
    if (face === undefined || !this.#lens) return;
    event.preventDefault();
    const i = Number(face);
    const surfaces = this.#lens.surfaces;
    const start = event.clientX;
    const mm_per_px = this.#section.viewBox.baseVal.width / this.#section.clientWidth;
    const before = { ...surfaces[i] };
    const thickness = i > 0 ? surfaces[i - 1].thickness : 0;
    const height = before.semi_diameter;
    const curvature = before.radius ? 1 / before.radius : 0;
    const round = (number) => Number(number.toPrecision(6));
    this.#section.setPointerCapture(event.pointerId);
    const move = (to) => {
      const mm = (to.clientX - start) * mm_per_px;
      if (to.shiftKey && !before.stop) {
        const bent = curvature - (2 * mm) / (height * height);
        surfaces[i].radius = Math.abs(bent) < 1e-9 ? null : round(1 / bent);
      } else if (i > 0) {
        surfaces[i - 1].thickness = round(thickness + mm);
        surfaces[i].thickness = round(before.thickness - mm);
      }
      this.#measure();
    };
    const end = () => {
      this.#section.removeEventListener("pointermove", move);
      this.#list();
      this.#keep();
    };
    this.#section.addEventListener("pointermove", move);
    this.#section.addEventListener("pointerup", end, { once: true });
  }

  #save() {
    if (!this.#lens) return;
    const blob = new Blob([JSON.stringify(this.#lens, null, 1)], { type: "application/json" });
    offer(blob, `${this.#lens.name ?? "lens"}-changed.json`);
  }
}
