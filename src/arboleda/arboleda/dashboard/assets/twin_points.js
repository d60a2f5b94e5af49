// The plant from above with points that can be chosen: each a button, for pointers and keys alike.

import { FlatView } from "./twin_flat.js";

const MM = 1000;
const APART = 24; // px between two points: of several above each other each can be pressed

export class PointsView extends FlatView {
  name = "points";

  // `points` are {name, at} in m; `chosen` the name of one; `choose` is called with the name of the one pressed.
  constructor(THREE, box, plant, { points, chosen, choose }) {
    super(THREE, box, plant);
    this.points = points;
    this.buttons = points.map(({ name }) => {
      const made = Object.assign(document.createElement("button"), { type: "button", className: "twin-point", textContent: name });
      made.dataset.point = name;
      made.setAttribute("aria-pressed", name === chosen);
      made.addEventListener("click", () => choose(name));
      return made;
    });
    box.append(...this.buttons);
    this.resizing = new ResizeObserver(() => this.show());
    this.resizing.observe(box);
  }

  sights(cell) {
    return [...super.sights(cell), ...(this.points ?? []).map(({ at: [x, y] }) => ({ x, y }))];
  }

  draw() {
    super.draw();
    const [to, { left, top }] = [this.svg.getScreenCTM(), this.box.getBoundingClientRect()];
    if (!to) return;
    const taken = [];
    this.points.forEach(({ at: [x, y] }, number) => {
      const point = new DOMPoint(x * MM, -y * MM).matrixTransform(to);
      const [across, down] = [point.x - left, point.y - top];
      let row = down;
      while (taken.some(([a, b]) => Math.abs(a - across) < APART && Math.abs(b - row) < APART)) row += APART;
      taken.push([across, row]);
      const isRight = across > this.box.clientWidth / 2; // there its name stands on the other side
      this.buttons[number].classList.toggle("right", isRight);
      this.buttons[number].style.transform = `translate(${across}px, ${row}px) translate(${isRight ? "calc(0.6rem - 100%)" : "-0.6rem"}, -50%)`;
    });
  }

  close() {
    super.close();
    this.resizing.disconnect();
    this.buttons.forEach((button) => button.remove());
  }
}
