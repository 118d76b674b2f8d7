// SPDX-License-Identifier: Apache-2.0
// The page of `petzval live`: settings, view finder and server brought together.
import { Connection, readFacts } from "./api.js";
import { Bench } from "./bench.js";
import { Controls } from "./controls.js";
import { Finder } from "./finder.js";
import { Looking } from "./looking.js";
import { offer, oneAtATime, textOfStage } from "./make.js";
import { addressOf, fieldsOfAddress, Settings, textOfFloat } from "./state.js";

const kUsualSize = "640x360";
const kAddress_ms = 300;

const element = (id) => document.getElementById(id);
const show = (node, text) => {
  node.textContent = text;
  node.hidden = text === "";
};

const facts = await readFacts();
const start = { size: [kUsualSize], ...facts.start };
const asked = fieldsOfAddress(location.hash);
const settings = new Settings(Object.keys(asked).length > 0 ? asked : start);
const connection = new Connection();
const finder = new Finder(element("picture"), element("mark"), element("drag"), settings);
const looking = new Looking(element("looking"), element("picture"), connection, () => element("command").value);
const bench = new Bench(element("bench"), element("picture"), connection, settings);
const controls = new Controls(element("controls"), settings, facts);
let version = 0;
let focusing = 0; // version that is to find a focus
let drawn = 0;
let last = null; // status

function ask() {
  ++version;
  focusing = /^\d+,\d+$/.test(settings.text("focus")) ? version : 0;
  const size = (settings.text("size") || "1280x720").split("x").map(Number);
  if (size.every((length) => length > 0)) finder.shape(...size);
  show(element("error"), "");
  connection.ask(version, settings.fields);
  for (const id of ["save-exr", "save-png"]) element(id).disabled = true;
}

const draw = oneAtATime(async () => {
  if (!last || last.picture === drawn) return;
  const number = last.picture;
  try {
    const image = await connection.picture(number);
    if (image) finder.draw(await looking.seen(image));
    drawn = number;
  } catch {
    // The stream tells that the server is gone.
  }
});

connection.addEventListener("open", () => {
  drawn = 0;
  last = null;
  ask();
});
connection.addEventListener("lost", ({ detail: why }) => {
  element("stage").textContent = why;
  for (const id of ["save-exr", "save-png"]) element(id).disabled = true;
});
connection.addEventListener("scene", ({ detail }) => detail && controls.meet(detail));
connection.addEventListener("answer", ({ detail }) => {
  if (detail.version !== version) return;
  if (detail.error) {
    show(element("error"), detail.error);
    element("stage").textContent = "Not rendered";
    element("command").value = "";
  }
  controls.refuse((detail.field ?? "").replace(/[⟨⟩]/g, ""));
  if (detail.command) element("command").value = detail.command;
});
connection.addEventListener("status", ({ detail: status }) => {
  last = status;
  looking.meet(status);
  draw();
  if (status.version !== version) return;
  element("stage").textContent = textOfStage(status);
  element("stage").dataset.stage = status.stage;
  element("stage").dataset.version = status.version;
  element("progress").value = status.stage === "done" ? 1 : status.of > 0 ? status.samples / status.of : 0;
  if (status.error) show(element("error"), status.error);
  element("notices").replaceChildren(
    ...status.notices.map((text) => Object.assign(document.createElement("li"), { textContent: text })));
  const done = status.stage === "done";
  for (const id of ["save-exr", "save-png"]) element(id).disabled = !done;
  const focused = focusing === version;
  if (focused && status.stage === "failed") settings.settle("focus", "infinity"); // nothing is there
  if (status.camera && (status.stage === "growing" || done)) {
    finder.meet(status.camera);
    bench.meet(status.camera);
    const { focus_m } = status.camera;
    if (focused) settings.settle("focus", focus_m === null ? "infinity" : textOfFloat(focus_m));
  } else if (status.camera && status.stage === "rough") {
    finder.meet(status.camera);
  }
});

looking.addEventListener("show", () => {
  drawn = 0;
  draw();
});
finder.addEventListener("pinhole", () =>
  show(element("error"), "A pinhole is sharp everywhere. Choose a lens, or an f-number, to focus."));
// Browsers refuse an address that changes with every move of the pointer.
let telling = 0;
function tellAddress() {
  clearTimeout(telling);
  telling = setTimeout(() => history.replaceState(null, "", addressOf(settings.fields)), kAddress_ms);
}
settings.addEventListener("change", () => {
  element("undo").disabled = !settings.canUndo;
  element("redo").disabled = !settings.canRedo;
  ask();
  tellAddress();
});
addEventListener("hashchange", () => {
  const fields = fieldsOfAddress(location.hash);
  if (addressOf(fields) !== addressOf(settings.fields)) settings.replace(fields);
});
element("undo").addEventListener("click", () => settings.undo());
element("redo").addEventListener("click", () => settings.redo());
element("reset").addEventListener("click", () => settings.replace(start));
element("undo").disabled = element("redo").disabled = true;
addEventListener("keydown", (event) => {
  if (!(event.ctrlKey || event.metaKey) || event.key.toLowerCase() !== "z") return;
  if (event.target.matches?.("input, textarea")) return; // they undo what is typed
  event.preventDefault();
  event.shiftKey ? settings.redo() : settings.undo();
});
element("copy").addEventListener("click", async () => {
  if (navigator.clipboard) await navigator.clipboard.writeText(element("command").value);
  else {
    // Plain HTTP from another machine has no clipboard of the new kind.
    element("command").select();
    document.execCommand("copy");
  }
  element("copy").textContent = "Copied";
  setTimeout(() => (element("copy").textContent = "Copy"), 1500);
});
for (const kind of ["exr", "png"])
  element(`save-${kind}`).addEventListener("click", async () => {
    const before = element("stage").textContent;
    const saving = "Saving; a change waits until the file is there";
    element("stage").textContent = saving;
    try {
      offer(await connection.file(version, `picture.${kind}`), `picture.${kind}`);
    } catch (fault) {
      show(element("error"), `Not saved: ${fault.message}`);
    }
    if (element("stage").textContent === saving) element("stage").textContent = before;
  });
element("scene").textContent = facts.scene;
document.title = `${facts.scene} - Petzval`;
connection.stay();
