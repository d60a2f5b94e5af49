// Charts of packages, as SVG that fills its box. The line of text below each says the same in words.

import { onChange } from "./live.js";

const [WIDTH, HEIGHT] = [100, 40]; // of the drawing, which is stretched to its box
const GAP = 0.2; // of the width of a bar
const SVG = "http://www.w3.org/2000/svg";

export function start() {
  onChange((patch) => {
    for (const [key, points] of Object.entries(patch)) if (key.startsWith("chart/")) show(key.slice("chart/".length), points);
  });
}

function show(name, points) {
  for (const box of document.querySelectorAll(`[data-chart="${CSS.escape(name)}"]`)) box.replaceChildren(...(points.length ? drawn(points, box.dataset.kind) : []));
}

function drawn(points, kind) {
  const numbers = points.map(([, number]) => number);
  const [least, most] = [Math.min(0, ...numbers), Math.max(0, ...numbers)];
  const y = (number) => HEIGHT * (1 - (number - least) / (most - least || 1));
  const svg = element("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, preserveAspectRatio: "none" });
  svg.append(element("line", { x1: 0, x2: WIDTH, y1: y(0), y2: y(0), class: "zero" }));
  svg.append(...(kind === "bars" ? bars(points, y) : [line(numbers, y)]));
  return [text("most", most), svg, text("first", points[0][0]), text("last", points.at(-1)[0])];
}

function line(numbers, y) {
  const step = WIDTH / Math.max(1, numbers.length - 1);
  const ends = numbers.length > 1 ? numbers : [numbers[0], numbers[0]]; // one number is a line, too
  return element("polyline", { points: ends.map((number, n) => `${n * step},${y(number)}`).join(" ") });
}

function bars(points, y) {
  const width = WIDTH / points.length;
  return points.map(([label, number], n) => {
    const bar = element("rect", { x: (n + GAP / 2) * width, y: Math.min(y(number), y(0)), width: (1 - GAP) * width, height: Math.abs(y(number) - y(0)) });
    bar.append(Object.assign(element("title", {}), { textContent: `${label}: ${number}` }));
    return bar;
  });
}

function element(name, attributes) {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  return made;
}

function text(name, value) {
  return Object.assign(document.createElement("span"), { className: name, textContent: value });
}
