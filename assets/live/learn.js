// SPDX-License-Identifier: Apache-2.0
// The page of `petzval live --learn`. A section of learn.html is a lesson: data-fields holds the settings of its
// picture, in which {name} stands for the control of that name. Drawing and picture come from the server.
import { Connection, readFacts } from "./api.js";
import { make, oneAtATime, textOfStage } from "./make.js";
import { plot } from "./plots.js";

const facts = await readFacts();
const connection = new Connection();
const stage = document.getElementById("stage");

/** A section with its controls, drawing and picture. */
class Lesson {
  version = 0; // of its last request
  done = false;
  #section;
  #canvas = make("canvas", { width: 480, height: 320, role: "img" });
  #stage = make("figcaption");
  #command = make("code", { className: "command" });
  #fault = make("p", { className: "fault", role: "alert" });
  #plots = make("div", { className: "plots" });
  #figures = make("dl");

  constructor(section, moved) {
    this.#section = section;
    this.#canvas.setAttribute("aria-label", `Picture: ${section.querySelector("h2").textContent}`);
    for (const input of this.#inputs) {
      input.after(make("output"));
      input.addEventListener("input", () => {
        this.#tell();
        this.measure();
        moved(this);
      });
    }
    this.#tell();
    this.#plots.append(make("figure", {}, this.#canvas, this.#stage));
    section.append(this.#fault, this.#plots, this.#figures, this.#command);
  }

  get #inputs() {
    return [...this.#section.querySelectorAll("input")];
  }

  #value(input) {
    return input.dataset.values?.split(" ")[input.value] ?? input.value;
  }

  #tell() {
    for (const input of this.#inputs) {
      const text = this.#value(input) + (input.dataset.unit ?? "");
      input.nextElementSibling.textContent = text;
      input.setAttribute("aria-valuetext", text);
    }
  }

  /** Settings of the picture. */
  get fields() {
    const values = Object.fromEntries(this.#inputs.map((input) => [input.name, this.#value(input)]));
    const text = this.#section.dataset.fields.replace(/\{(\w+)\}/g, (_, name) => values[name]);
    const own = [...new URLSearchParams(text)].map(([name, value]) => [name, [value]]);
    return { size: ["480x320"], spp: ["16"], ...facts.start, ...Object.fromEntries(own) };
  }

  measure = oneAtATime(async () => {
    const found = await connection.lesson(this.#section.id, this.fields);
    if (!found) return;
    this.#fault.textContent = found.error ?? "";
    this.#plots.replaceChildren(this.#plots.firstChild, ...(found.plots ?? []).map(plot));
    this.#figures.replaceChildren(
      ...(found.figures ?? []).flatMap(([name, text]) => [make("dt", {}, name), make("dd", {}, text)]));
  });

  answer({ command, error }) {
    this.#command.textContent = command ?? "";
    if (error) this.#fault.textContent = error;
    this.#stage.textContent = error ? "Not rendered" : "";
  }

  show(status) {
    this.#stage.textContent = textOfStage(status);
    this.#section.dataset.stage = status.stage;
    if (status.error) this.#fault.textContent = status.error;
  }

  draw(image) {
    this.#canvas.width = image.width;
    this.#canvas.height = image.height;
    this.#canvas.style.aspectRatio = `${image.width} / ${image.height}`;
    this.#canvas.getContext("2d").putImageData(image, 0, 0);
  }
}

const lessons = [...document.querySelectorAll("section[data-fields]")].map((one) => new Lesson(one, wish));
let version = 0;
let current = null; // whose picture is rendered
let last = null; // status

// Pictures are rendered one after the other, the one whose control was moved first.
function render(lesson) {
  current = lesson;
  if (!lesson) return;
  lesson.version = ++version;
  connection.ask(version, lesson.fields);
}

function next() {
  render(lessons.find((lesson) => !lesson.done) ?? null);
}

function wish(lesson) {
  lesson.done = false;
  render(lesson);
}

const draw = oneAtATime(async () => {
  const { version: of, stage: reached, picture } = last;
  const image = picture > 0 && reached !== "preparing" ? await connection.picture(picture).catch(() => null) : null;
  if (of !== version || !current) return; // another request came meanwhile
  if (image) current.draw(image);
  if (reached !== "done" && reached !== "failed") return;
  current.done = true;
  next();
});

connection.addEventListener("open", () => {
  stage.textContent = "";
  lessons.forEach((lesson) => lesson.measure());
  current && !current.done ? render(current) : next();
});
connection.addEventListener("lost", ({ detail: why }) => (stage.textContent = why));
connection.addEventListener("answer", ({ detail }) => {
  if (detail.version !== version || !current) return;
  current.answer(detail);
  if (!detail.error) return;
  current.done = true;
  next();
});
connection.addEventListener("status", ({ detail: status }) => {
  if (status.version !== version || !current) return;
  last = status;
  current.show(status);
  draw();
});
connection.stay();
