// SPDX-License-Identifier: Apache-2.0
// Drawings in SVG.
import { make } from "./make.js";

/** An SVG element with attributes and children. */
export function svg(name, attributes = {}, ...children) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  element.append(...children);
  return element;
}

/** Path of a line through points [x, y], y upwards. */
export function line(points, closed = false) {
  return points.length > 0 ? `M${points.map(([x, y]) => `${x} ${0 - y}`).join("L")}${closed ? "Z" : ""}` : "";
}

/** A figure of curves. x and y: [from, to, what], with what: the axes are labelled; series: {name, style, colour, paths},
 *  style being a class; points where it begins with "dots". square: as high as wide. */
export function plot({ title, x: [x0, x1, xWhat], y: [y0, y1, yWhat], series, square }) {
  const width = square ? 200 : 320;
  const height = 200;
  const at = ([x, y]) => [Number(((width * (x - x0)) / (x1 - x0)).toFixed(2)), Number(((height * (y - y1)) / (y1 - y0)).toFixed(2))];
  const drawn = series.map(({ style, colour, paths }) => {
    const of = (path) => style.startsWith("dots") ? path.map((p) => `M${at(p)[0]} ${-at(p)[1]}h0`).join("")
      : line(path.map(at), style === "glass");
    return svg("path", { class: style, d: paths.map(of).join(""), ...(colour && { stroke: colour }) });
  });
  const short = (number) => Number(number.toPrecision(3));
  const [zeroX, zeroY] = [at([0, 0])[0], -at([0, 0])[1]];
  const left = square && xWhat !== undefined ? 60 : 0; // so that all labelled plots have one scale
  const label = (text, x, y, anchor) => svg("text", { x: x + left, y, "text-anchor": anchor }, text);
  const labels = xWhat === undefined ? [] : [
    label(short(x0), 2, height + 12, "start"), label(xWhat, width / 2, height + 12, "middle"),
    label(short(x1), width - 2, height + 12, "end"), label(`${short(y1)} ${yWhat}`, 4, 11, "start"),
    label(short(y0), 4, height - 5, "start")];
  const keys = series.filter(({ name }) => name).map(({ name, style }) => make("span", { className: "key" },
    svg("svg", { viewBox: "0 0 24 10", "aria-hidden": "true" },
      svg("path", { class: style, d: style.startsWith("dots") ? "M4 5h0M12 5h0M20 5h0" : "M0 5H24" })), name));
  return make("figure", {},
    svg("svg", { viewBox: `0 0 ${width + 2 * left} ${height + (labels.length > 0 ? 16 : 0)}`, role: "img", "aria-label": title },
      svg("svg", { x: left, width, height }, svg("path", { class: "axis", d: `M0 ${zeroY}H${width}M${zeroX} 0V${height}` }), ...drawn),
      ...labels),
    make("figcaption", {}, title, ...keys));
}
