// SPDX-License-Identifier: Apache-2.0
// The settings of the picture, by the names of the command line's options, with undo, and in the
// address of the page.

const kMostSteps = 200;

/** Shortest text of a number of which the server, which has floats, reads the same one. */
export function textOfFloat(number) {
  for (let digits = 1; digits < 9; ++digits) {
    const text = Number(number.toPrecision(digits));
    if (Math.fround(text) === Math.fround(number)) return String(text);
  }
  return String(Number(number.toPrecision(9)));
}

/** Fields of the part of an address behind "#". */
export function fieldsOfAddress(hash) {
  const fields = Object.create(null); // an address may name anything
  for (const [name, text] of new URLSearchParams(hash.replace(/^#/, ""))) (fields[name] ??= []).push(text);
  return fields;
}

/** The part of an address behind "#" of fields. */
export function addressOf(fields) {
  const all = new URLSearchParams();
  for (const name of Object.keys(fields).sort()) for (const text of fields[name]) all.append(name, text);
  return `#${all}`;
}

/** Settings with what they were before. Event "change" follows each change. */
export class Settings extends EventTarget {
  #fields;
  #past = [];
  #future = [];
  #step = "";
  #before = null; // fields before what is tried

  constructor(fields) {
    super();
    this.#fields = fields;
  }

  get fields() {
    return this.#fields;
  }

  /** Text of a field; "" where it is not set. */
  text(name) {
    return this.#fields[name]?.[0] ?? "";
  }

  /** Sets fields; null or "" takes one away. Changes of one step, such as a drag, are undone at once. */
  set(changes, step = "") {
    const next = { ...this.#fields };
    // What was tried and is not settled by now is dropped: it was meant for the picture as it was.
    if (this.#before) {
      delete next.focus;
      if (this.#before.focus) next.focus = this.#before.focus;
      this.#before = null;
    }
    for (const [name, text] of Object.entries(changes))
      if (text === null || text.length === 0) delete next[name];
      else next[name] = Array.isArray(text) ? text : [String(text)];
    if (addressOf(next) === addressOf(this.#fields)) return;
    if (!step || step !== this.#step) this.#past.push(this.#fields);
    if (this.#past.length > kMostSteps) this.#past.shift();
    this.#step = step;
    this.#future = [];
    this.#show(next);
  }

  /** Sets fields for which settle() is to follow. */
  try(changes) {
    const before = this.#fields;
    this.set(changes);
    if (this.#fields !== before) this.#before = before;
  }

  /** Sets a field to what the server found it to be, which is no step of the user's. */
  settle(name, text) {
    this.#before = null;
    this.#show({ ...this.#fields, [name]: [text] });
  }

  get canUndo() {
    return this.#past.length > 0;
  }
  get canRedo() {
    return this.#future.length > 0;
  }
  undo() {
    if (!this.canUndo) return;
    this.#before = null;
    this.#future.push(this.#fields);
    this.#step = "";
    this.#show(this.#past.pop());
  }
  redo() {
    if (!this.canRedo) return;
    this.#past.push(this.#fields);
    this.#step = "";
    this.#show(this.#future.pop());
  }
  /** All fields anew, as one step. */
  replace(fields) {
    this.#past.push(this.#fields);
    this.#future = [];
    this.#before = null;
    this.#step = "";
    this.#show(fields);
  }

  #show(fields) {
    this.#fields = fields;
    this.dispatchEvent(new Event("change"));
  }
}
