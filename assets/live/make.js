// SPDX-License-Identifier: Apache-2.0

/** Text of a number in four digits; "none" of null. */
export function short(number) {
  return number === null ? "none" : Number(number.toPrecision(4)).toString();
}

/** Offers a blob to be kept as a file of that name. */
export function offer(blob, name) {
  const url = URL.createObjectURL(blob);
  make("a", { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 60_000);
}

/** An element with attributes or properties, and children. */
export function make(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes))
    if (name in element) element[name] = value;
    else element.setAttribute(name, value);
  element.append(...children);
  return element;
}

/** An async function that runs once at a time; of the calls that come meanwhile the last one follows. */
export function oneAtATime(f) {
  let busy = false;
  let again = false;
  return async function run() {
    again = busy;
    if (busy) return;
    busy = true;
    try {
      do {
        again = false;
        await f();
      } while (again);
    } finally {
      busy = false;
    }
  };
}

/** What the status of a picture says to people. */
export function textOfStage(status) {
  const seconds = `${status.elapsed_s.toFixed(1)} s`;
  const noise = status.noise > 0 ? `, noise ${(100 * status.noise).toPrecision(2)} %` : "";
  switch (status.stage) {
    case "preparing":
      return status.phase === "loading" ? "Loading the scene" : `Preparing: ${status.phase}`;
    case "rough":
      return "Rough picture; the true one is being prepared";
    case "growing":
      return status.of > 0
        ? `${status.samples} of ${status.of} samples${noise}, ${seconds}`
        : `${status.samples} samples${noise}, ${seconds}`;
    case "done":
      return `Done: ${status.samples} samples${noise}, ${seconds}`;
    case "failed":
      return "Not rendered";
    default:
      return "";
  }
}
