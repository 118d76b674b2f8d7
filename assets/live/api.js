// SPDX-License-Identifier: Apache-2.0
// What the server is asked. Addresses are relative, so that a token in the page's own stays in them.

const kAgain_ms = 1000;

/** Facts of the program: scene, start, fields, lenses, views. */
export async function readFacts() {
  return (await fetch("api/facts")).json();
}

/** Address of the drawing of a lens that ships. */
export function drawingOf(lens) {
  return `api/lens.svg?name=${encodeURIComponent(lens)}`;
}

/** A connection to the server: a stream of events, and requests that belong to it. */
export class Connection extends EventTarget {
  #page = "";
  #last = ""; // that it had; the server may still have its picture
  #waiting = null;
  #busy = false;
  #stream = null;

  /** Opens the stream; events "open", "lost", "scene" and "status" follow. */
  open() {
    this.close();
    const stream = new EventSource(`api/events?page=${this.#last}`);
    this.#stream = stream;
    stream.addEventListener("page", (event) => {
      this.#page = this.#last = JSON.parse(event.data).page;
      this.dispatchEvent(new Event("open"));
    });
    for (const name of ["scene", "status"])
      stream.addEventListener(name, (event) =>
        this.dispatchEvent(new CustomEvent(name, { detail: JSON.parse(event.data) })));
    stream.addEventListener("error", async () => {
      if (this.#stream !== stream) return;
      const was = this.connected;
      this.close();
      const there = !was && (await fetch("api/facts").then((answer) => answer.ok, () => false));
      this.dispatchEvent(new CustomEvent("lost", { detail: there ? "Other pages take all places; close or hide one"
        : "The server does not answer; trying again" }));
    });
  }

  /** Opens the stream, and again where it is lost; a page that nobody sees has none, and does no work. */
  stay() {
    document.addEventListener("visibilitychange", () => (document.hidden ? this.close() : this.open()));
    this.addEventListener("lost", () =>
      setTimeout(() => !document.hidden && !this.connected && this.open(), kAgain_ms));
    if (!document.hidden) this.open();
  }

  /** Closes the stream, which ends the work for this page. */
  close() {
    this.#stream?.close();
    this.#stream = null;
    this.#page = "";
  }

  get connected() {
    return this.#page !== "";
  }

  /** Asks for a picture. Of requests that wait for the one before only the last is sent. */
  ask(version, fields) {
    this.#waiting = { version, fields };
    this.#send();
  }

  async #send() {
    if (this.#busy || !this.#waiting || !this.#page) return;
    const { version, fields } = this.#waiting;
    this.#waiting = null;
    this.#busy = true;
    const answer = await this.#post("api/request", { page: this.#page, version, fields });
    if (answer) this.dispatchEvent(new CustomEvent("answer", { detail: { version, ...answer } }));
    this.#busy = false;
    this.#send();
  }

  /** The newest picture, as ImageData. */
  async picture(number) {
    const answer = await fetch(`api/picture?page=${this.#page}&number=${number}`);
    if (!answer.ok) return null;
    const [width, height] = answer.headers.get("X-Size").split("x").map(Number);
    return new ImageData(new Uint8ClampedArray(await answer.arrayBuffer()), width, height);
  }

  /** Values of a channel of a picture, row by row; null where it is another picture by now. */
  async values(version, channel) {
    const name = encodeURIComponent(channel);
    const answer = await fetch(`api/values?page=${this.#page}&version=${version}&channel=${name}`);
    return answer.ok ? new Float32Array(await answer.arrayBuffer()) : null;
  }

  /** Channels of a pixel by their names; null likewise. */
  async pixel(version, x, y) {
    const answer = await fetch(`api/pixel?page=${this.#page}&version=${version}&x=${x}&y=${y}`);
    return answer.ok ? answer.json() : null;
  }

  /** Text of the file of a lens that ships; null where there is none. */
  async lens(name) {
    const answer = await fetch(`api/lens?name=${encodeURIComponent(name)}`);
    return answer.ok ? answer.text() : null;
  }

  /** What the bench finds of a lens; its "error" where that cannot be; null where nobody answers. */
  bench(asked) {
    return this.#post("api/bench", asked);
  }

  /** Plots and figures of a lesson for the settings of a picture; likewise. */
  lesson(name, fields) {
    return this.#post("api/lesson", { lesson: name, fields });
  }

  /** Name of the file that the server keeps of a lens as long as the page is there; likewise. */
  keepLens(text) {
    return this.#post("api/lens", { page: this.#page, lens: text });
  }

  async #post(address, body) {
    try {
      const headers = { "Content-Type": "application/json" };
      return await (await fetch(address, { method: "POST", headers, body: JSON.stringify(body) })).json();
    } catch {
      return null; // the stream tells that the server is gone
    }
  }

  /** The picture of a request as a file. Throws an Error that says why there is none. */
  async file(version, name) {
    const answer = await fetch(`api/file?page=${this.#page}&version=${version}&name=${name}`);
    if (!answer.ok) throw new Error((await answer.json()).error);
    return answer.blob();
  }
}
