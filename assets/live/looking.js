// SPDX-License-Identifier: Apache-2.0
// Looking closely at a picture: pixels, values, false colours, histogram, and another picture beside it.
import { make, short } from "./make.js";

const kShown = ["R", "G", "B", "A"];
// Viridis at five places (S. van der Walt, N. Smith 2015, matplotlib), dark to bright.
const kViridis = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]];
const kBins = 64;
const kRest_ms = 60;

/** Chromaticity x, y of linear R, G, B with the primaries of Rec. 709 (IEC 61966-2-1:1999, D65). */
export function chromaticity([r, g, b]) {
  const x = 0.4124 * r + 0.3576 * g + 0.1805 * b;
  const y = 0.2126 * r + 0.7152 * g + 0.0722 * b;
  const sum = x + y + 0.0193 * r + 0.1192 * g + 0.9505 * b;
  return sum > 0 ? [x / sum, y / sum] : null;
}

/** Colour of a share in [0, 1]. */
function viridis(share) {
  const at = Math.max(0, Math.min(1, share)) * (kViridis.length - 1);
  const i = Math.min(kViridis.length - 2, Math.floor(at));
  return kViridis[i].map((from, c) => from + (at - i) * (kViridis[i + 1][c] - from));
}

/** Values in false colours, and those that are darkest and brightest: all but a hundredth at each end lie between. */
export function falseColours(values, width, height) {
  const sorted = Float32Array.from(values).filter(Number.isFinite).sort();
  const at = (share) => sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))] ?? 0;
  const [least, most] = [at(0.01), at(0.99)];
  const image = new ImageData(width, height);
  values.forEach((value, i) => {
    const colour = Number.isFinite(value) ? viridis((value - least) / (most - least || 1)) : [0, 0, 0];
    image.data.set([...colour, 255], 4 * i);
  });
  return { image, least, most };
}

/** A plot of points as an SVG path of 200 x 60. */
function path(points, most, colour) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", "path");
  const text = points.map((y, i) => `${(200 * i) / (points.length - 1 || 1)} ${60 - (60 * y) / (most || 1)}`);
  element.setAttribute("d", `M${text.join("L")}`);
  element.setAttribute("stroke", colour);
  return element;
}

/** The tools below the picture. Event "show": another way to show it was chosen. */
export class Looking extends EventTarget {
  #canvas;
  #connection;
  #status = null;
  #image = null; // as the server sent it
  #asked = null; // pixel that is to be read
  #reading = false;
  #rest = 0;
  #show = make("select", { id: "show" });
  #clipped = make("input", { type: "checkbox", id: "clipped" });
  #pixel = make("output", { id: "pixel" }, "Point at the picture to read a pixel.");
  #scale = make("p", { className: "help", id: "scale" });
  #spectrum = make("p", { id: "spectrum" });
  #histogram = make("div", { id: "histogram" });
  #kept = make("canvas", { id: "kept", hidden: true });
  #slider = make("input", { type: "range", id: "compare", min: 0, max: 100, value: 50, disabled: true });
  #keptAbout = make("p", { className: "help" });

  constructor(parent, canvas, connection, command) {
    super();
    this.#canvas = canvas;
    this.#connection = connection;
    canvas.after(this.#kept);
    const keep = make("button", { type: "button", id: "keep" }, "Keep this picture to compare");
    keep.addEventListener("click", () => this.#keep(command()));
    this.#slider.addEventListener("input", () => this.#divide());
    for (const input of [this.#show, this.#clipped])
      input.addEventListener("change", () => this.dispatchEvent(new Event("show")));
    const zoom = make("select", { id: "zoom" }, ...[1, 2, 4, 8, 16].map((n) => make("option", { value: n }, `${n}x`)));
    zoom.addEventListener("change", () => this.#zoom(Number(zoom.value)));
    canvas.addEventListener("pointermove", (event) => event.buttons === 0 && this.#point(event));
    parent.append(
      make("summary", {}, "Look closely"),
      make("div", { className: "tools" }, make("label", {}, "Show ", this.#show), make("label", {}, "Zoom ", zoom),
        make("label", {}, this.#clipped, " mark what is clipped"), keep,
        make("label", {}, "kept | new ", this.#slider)),
      this.#keptAbout, this.#scale, this.#pixel, this.#spectrum, this.#histogram);
    this.#offer([]);
  }

  /** Takes the status of the picture that is shown. */
  meet(status) {
    this.#status = status;
    this.#offer(status.channels);
  }

  /** The picture as it is to be drawn. */
  async seen(image) {
    this.#image = image;
    this.#count(image);
    const channel = this.#show.value;
    this.#scale.textContent = "";
    const stage = this.#status?.stage;
    if (channel && (stage === "growing" || stage === "done")) {
      const values = await this.#connection.values(this.#status.version, channel);
      if (values?.length === image.width * image.height) {
        const { image: coloured, least, most } = falseColours(values, image.width, image.height);
        this.#scale.textContent = `${channel}: from ${short(least)} (dark) to ${short(most)} (bright)`;
        return coloured;
      }
    }
    if (!this.#clipped.checked) return image;
    const marked = new ImageData(Uint8ClampedArray.from(image.data), image.width, image.height);
    for (let i = 0; i < marked.data.length; i += 4)
      if (Math.max(...marked.data.subarray(i, i + 3)) === 255) marked.data.set([255, 0, 255], i);
    return marked;
  }

  #offer(channels) {
    const names = channels.filter((name) => !kShown.includes(name) && !/^S0[.]/.test(name));
    const key = names.join(" ");
    if (this.#show.dataset.names === key) return;
    const value = this.#show.value;
    this.#show.dataset.names = key;
    this.#show.replaceChildren(
      make("option", { value: "" }, "picture"), ...names.map((name) => make("option", { value: name }, name)),
      make("option", { disabled: true }, "depth: layer (aov) depth; errors: Until noise, or Denoise"));
    this.#show.value = names.includes(value) ? value : "";
  }

  #zoom(times) {
    const [u, v] = this.#asked ?? [0.5, 0.5];
    for (const canvas of [this.#canvas, this.#kept]) {
      canvas.style.transformOrigin = `${100 * u}% ${100 * v}%`;
      canvas.style.transform = times === 1 ? "" : `scale(${times})`;
      canvas.classList.toggle("zoomed", times > 1);
    }
    this.#divide();
  }

  #count(image) {
    const counts = [0, 1, 2].map(() => new Array(kBins).fill(0));
    let bright = 0;
    let black = 0;
    for (let i = 0; i < image.data.length; i += 4) {
      const colour = image.data.subarray(i, i + 3);
      for (let c = 0; c < 3; ++c) ++counts[c][colour[c] >> 2];
      bright += Math.max(...colour) === 255;
      black += Math.max(...colour) === 0;
    }
    const most = Math.max(...counts.flatMap((bins) => bins.slice(1, -1)));
    const share = (n) => `${short((100 * n) / (image.data.length / 4))} %`;
    const text = `Histogram of what is shown: ${share(bright)} of the pixels are clipped, ${share(black)} are black.`;
    this.#histogram.replaceChildren(
      this.#plot(text, counts.map((bins, c) => path(bins.map((n) => Math.min(n, most)), most, ["#d33", "#393", "#36d"][c]))),
      text);
  }

  #plot(label, paths) {
    const plot = document.createElementNS("http://www.w3.org/2000/svg", "svg");
    plot.setAttribute("viewBox", "0 0 200 60");
    plot.setAttribute("role", "img");
    plot.setAttribute("aria-label", label);
    plot.append(...paths);
    return plot;
  }

  #point(event) {
    const box = this.#canvas.getBoundingClientRect();
    this.#asked = [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
    clearTimeout(this.#rest);
    this.#rest = setTimeout(() => this.#read(), kRest_ms);
  }

  async #read() {
    const stage = this.#status?.stage;
    if (this.#reading || !this.#image || (stage !== "growing" && stage !== "done")) return;
    this.#reading = true;
    const x = Math.floor(this.#asked[0] * this.#image.width);
    const y = Math.floor(this.#asked[1] * this.#image.height);
    const pixel = await this.#connection.pixel(this.#status.version, x, y);
    this.#reading = false;
    if (!pixel) return;
    const rgb = [pixel.R, pixel.G, pixel.B];
    const xy = chromaticity(rgb);
    const layers = Object.keys(pixel).filter((name) => !kShown.includes(name) && !/^S0[.]/.test(name));
    this.#pixel.textContent =
      `${x},${y}: ${rgb.map(short).join(", ")} nits` + (xy ? `; xy ${xy.map(short).join(", ")}` : "") +
      layers.map((name) => `; ${name} ${short(pixel[name])}`).join("");
    const bins = Object.entries(pixel)
      .map(([name, value]) => [Number(name.match(/^S0[.]([\d,]+)nm$/)?.[1].replace(",", ".")), value])
      .filter(([nm]) => nm > 0)
      .sort((a, b) => a[0] - b[0]);
    const most = Math.max(...bins.map(([, value]) => value));
    const text = bins.length > 0
      ? `Spectrum of ${x},${y} from ${bins[0][0]} to ${bins.at(-1)[0]} nm, at most ${short(most)} W/(m² sr nm)` : "";
    this.#spectrum.replaceChildren(
      ...(bins.length > 0 ? [this.#plot(text, [path(bins.map(([, value]) => value), most, "currentColor")]), text] : []));
  }

  #keep(command) {
    if (!this.#image) return;
    this.#kept.width = this.#canvas.width;
    this.#kept.height = this.#canvas.height;
    this.#kept.getContext("2d").drawImage(this.#canvas, 0, 0);
    this.#kept.hidden = this.#slider.disabled = false;
    this.#keptAbout.textContent = `Kept, on the left: ${command}`;
    this.#divide();
  }

  #divide() {
    this.#kept.style.clipPath = `inset(0 ${100 - this.#slider.value}% 0 0)`;
  }
}
