// The plant from above, as SVG: what a browser without WebGL shows, from the same scene.

const SVG = "http://www.w3.org/2000/svg";
const FRAME_MS = 200;
const NEARER = 0.85;
const LETTER = 13; // px
const MM = 1000;
const RIM = 0.15; // m
const ROUND_CORNERS = 24;

// Where a shape is seen from above: its outline as [[x, y], ...] in m. `columns` is its place, column by column.
export function footprint({ kind, size }, columns) {
  return hull(CORNERS[kind](size).map(([x, y, z]) => [0, 1].map((axis) => columns[axis] * x + columns[4 + axis] * y + columns[8 + axis] * z + columns[12 + axis])));
}

const CORNERS = {
  box: ([x, y, z]) => [-1, 1].flatMap((a) => [-1, 1].flatMap((b) => [-1, 1].map((c) => [(a * x) / 2, (b * y) / 2, (c * z) / 2]))),
  cylinder: ([radius, length]) => circle(radius).flatMap(([x, y]) => [[x, y, -length / 2], [x, y, length / 2]]),
  outline: (corners) => corners.map(([x, y]) => [x, y, 0]),
  sphere: ([radius]) => circle(radius).flatMap(([x, y]) => [[x, y, 0], [x, 0, y], [0, x, y]]),
};

const circle = (radius) =>
  Array.from({ length: ROUND_CORNERS }, (_, n) => (2 * Math.PI * n) / ROUND_CORNERS).map((angle) => [radius * Math.cos(angle), radius * Math.sin(angle)]);

// The convex outline of points of a plane, counterclockwise.
export function hull(points) {
  const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const half = (way) => {
    const kept = [];
    for (const point of way) {
      while (kept.length > 1 && bends(kept.at(-2), kept.at(-1), point) <= 1e-12) kept.pop();
      kept.push(point);
    }
    return kept.slice(0, -1);
  };
  return [...half(sorted), ...half(sorted.reverse())];
}

const bends = (a, b, c) => (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);

export class FlatView {
  name = "flat";

  constructor(THREE, box, plant) {
    Object.assign(this, { THREE, box, plant });
    this.svg = element("svg", { class: "twin-flat", role: "img", tabindex: 0, "aria-label": window.arboledaPage.words.twin_view });
    this.layers = ["still", "zones", "moving", "labels"].map((name) => element("g", { class: name }));
    this.svg.append(...this.layers);
    this.svg.addEventListener("keydown", (event) => this.tool(KEYS[event.key]));
    box.prepend(this.svg);
    this.whole();
  }

  // Has the whole plant, or one cell, seen.
  whole(cell) {
    const points = this.sights(cell);
    const [[x0, x1], [y0, y1]] = ["x", "y"].map((axis) => points.map((point) => point[axis])).map((all) => [Math.min(...all) - RIM, Math.max(...all) + RIM]);
    this.box4 = [x0, -y1, x1 - x0, y1 - y0].map((value) => value * MM);
    this.frame();
  }

  sights(cell) {
    return this.plant.points(cell);
  }

  visit(cell) {
    this.whole(cell);
  }

  frame() {
    this.svg.setAttribute("viewBox", this.box4.join(" "));
    this.show();
  }

  zoom(factor) {
    const [x, y, wide, high] = this.box4;
    this.box4 = [x + (wide * (1 - factor)) / 2, y + (high * (1 - factor)) / 2, wide * factor, high * factor];
    this.frame();
  }

  tool(name) {
    if (name === "in") this.zoom(NEARER);
    if (name === "out") this.zoom(1 / NEARER);
    if (name === "reset" || name === "top") this.whole();
  }

  show() {
    this.waiting ??= setTimeout(() => {
      this.waiting = undefined;
      this.draw();
    }, FRAME_MS);
  }

  draw() {
    const { furniture, moving, zones } = this.plant;
    this.plant.root.updateMatrixWorld(true);
    this.layers[0].replaceChildren(...this.shapes(furniture.root), ...this.texts(furniture.root));
    this.layers[1].replaceChildren(...[...zones.values()].map((zone) => this.zone(zone)));
    this.layers[2].replaceChildren(...this.shapes(moving));
    this.layers[3].replaceChildren(...this.plant.labels().map((label) => this.label(label)));
  }

  // The visible shapes below an object, the lowest first.
  shapes(object) {
    const found = [];
    object.traverseVisible((each) => each.userData.shape && found.push(each));
    found.sort((a, b) => a.matrixWorld.elements[14] - b.matrixWorld.elements[14]);
    return found.map((mesh) => polygon(footprint(mesh.userData.shape, mesh.matrixWorld.elements), mesh.material));
  }

  texts(object) {
    const found = [];
    object.traverseVisible((each) => each.userData.text && found.push(each));
    return found.map(({ userData: { text }, matrixWorld }) => written(text.text, matrixWorld.elements[12], matrixWorld.elements[13], text.size * MM));
  }

  zone({ told, fill, state }) {
    const made = polygon(told.outline, fill);
    made.setAttribute("class", `zone ${state}`);
    return made;
  }

  label({ text, state, color, at }) {
    const made = written(text, at.x, at.y - 0.06, this.letter());
    made.dataset.s = state;
    if (color) made.style.fill = color;
    return made;
  }

  // How large letters of LETTER pixels are in the drawing.
  letter() {
    const { clientWidth, clientHeight } = this.box;
    return LETTER * Math.max(this.box4[2] / (clientWidth || 1), this.box4[3] / (clientHeight || 1));
  }

  close() {
    clearTimeout(this.waiting);
    this.svg.remove();
  }
}

const KEYS = { "+": "in", "=": "in", "-": "out", Home: "reset", 0: "reset" };

function element(name, attributes) {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  return made;
}

function polygon(points, { color, opacity }) {
  const text = points.map(([x, y]) => `${(x * MM).toFixed(1)},${(-y * MM).toFixed(1)}`).join(" ");
  return element("polygon", { points: text, fill: `#${color.getHexString()}`, "fill-opacity": opacity });
}

function written(text, x, y, size) {
  const made = element("text", { x: (x * MM).toFixed(1), y: (-y * MM).toFixed(1), "font-size": size });
  made.textContent = text;
  return made;
}
