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
