// What things are painted with; what depends on light or dark is painted anew by `paint`.

const OWN = { sign: "#ffffff" }; // what is the same in light and dark
const CELLS = ["#2f7fd6", "#d07a18", "#8a56c9", "#1f9a8a", "#c2497f", "#7b8f1e"];

export class Paints {
  constructor(THREE) {
    this.THREE = THREE;
    this.made = new Map();
    this.themed = []; // [material, name of a colour of the page]
  }

  // A robot's own colours, where they are to be believed.
  solid = ([r, g, b]) =>
    this.once(`solid ${r} ${g} ${b}`, () => {
      const { Color, MeshStandardMaterial, SRGBColorSpace } = this.THREE;
      return new MeshStandardMaterial({ color: new Color().setRGB(r, g, b, SRGBColorSpace), roughness: 0.55, metalness: 0.08 });
    });

  stale = () => this.once("stale", () => this.lit({ color: "#8d9490", roughness: 0.95 }));
  unknown = () => this.once("unknown", () => this.see({ color: "#8d9490", opacity: 0.22 }));
  estimate = () => this.once("estimate", () => this.see({ color: "#3d8bff", opacity: 0.38 }));
  goal = () => this.once("goal", () => this.see({ color: "#22a05a", opacity: 0.13 }));
  part = () => this.once("part", () => this.lit({ color: "#e8a413", roughness: 0.5 }));
  maybe = () => this.once("maybe", () => this.see({ color: "#e8a413", opacity: 0.5 }));

  cell = (number) => CELLS[number % CELLS.length];

  lit = (options) => new this.THREE.MeshStandardMaterial(options);
  // What one sees through; where it touches something solid, that is seen.
  see = (options) =>
    new this.THREE.MeshStandardMaterial({ transparent: true, depthWrite: false, polygonOffset: true, polygonOffsetFactor: 2, polygonOffsetUnits: 4, ...options });

  // A material in one of the page's colours.
  page(name, options = {}, kind = "MeshBasicMaterial") {
    const material = new this.THREE[kind](options);
    this.themed.push([material, name]);
    return material;
  }

  paint(colorOf) {
    for (const [material, name] of this.themed) material.color.set(OWN[name] ?? colorOf(name));
  }

  once(key, make) {
    if (!this.made.has(key)) this.made.set(key, make());
    return this.made.get(key);
  }
}
