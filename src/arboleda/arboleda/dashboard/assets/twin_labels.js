// Names beside things, as text of the page: readable at every zoom, in light and dark.

export class Labels {
  constructor(box) {
    this.layer = document.createElement("div");
    this.layer.className = "twin-labels";
    this.layer.setAttribute("aria-hidden", "true"); // the list of robots says the same
    box.append(this.layer);
  }

  draw(labels, camera, { clientWidth, clientHeight }) {
    while (this.layer.children.length < labels.length) this.layer.append(document.createElement("span"));
    labels.forEach(({ text, state, color, above, at }, number) => {
      const label = this.layer.children[number];
      if (label.textContent !== text) label.textContent = text;
      label.dataset.s = state;
      label.style.color = color ?? "";
      const { x, y, z } = at.clone().project(camera);
      label.hidden = z > 1;
      label.style.transform = `translate(${((x + 1) / 2) * clientWidth}px, ${((1 - y) / 2) * clientHeight}px) translate(-50%, ${above ? -100 : 0}%)`;
    });
  }

  close() {
    this.layer.remove();
  }
}
