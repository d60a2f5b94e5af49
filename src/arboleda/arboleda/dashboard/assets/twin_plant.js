// The plant as a scene graph, with WebGL or without: what stands, and what the frames say of it.

import { Furniture } from "./twin_furniture.js";
import { Paints } from "./twin_paints.js";
import { Robot } from "./twin_robot.js";
import { Zone } from "./twin_zone.js";
import { geometry } from "./twin_bodies.js";

const ROUND = (number) => (number < 60 ? `${number} s` : `${Math.floor(number / 60)}:${String(number % 60).padStart(2, "0")} min`);

export class Plant {
  constructor(THREE, scene) {
    Object.assign(this, { THREE, scene, drawn: new Map() });
    this.paints = new Paints(THREE);
    this.root = new THREE.Group();
    this.furniture = new Furniture(THREE, scene, this.paints);
    this.numbers = new Map([...new Set(scene.robots.map((robot) => robot.cell))].map((cell, number) => [cell, number]));
    this.robots = new Map(scene.robots.map((robot) => [robot.name, new Robot(THREE, robot, this.paints)]));
    this.zones = new Map(scene.zones.map((zone) => [zone.zone, new Zone(THREE, zone, this.paints)]));
    this.parts = new Map(scene.cells.map((cell) => [cell.name, this.newPart()]));
    this.atPlaces = new Map();
    this.carried = new Map();
    this.moving = new THREE.Group();
    this.moving.add(...[...this.robots.values()].map((robot) => robot.root));
    this.root.add(this.furniture.root, this.moving, ...[...this.zones.values()].map((zone) => zone.root));
  }

  apply(patch) {
    for (const [key, told] of Object.entries(patch)) {
      this.drawn.set(key, told);
      const at = key.indexOf("/");
      this[key.slice(0, at)]?.(key.slice(at + 1), told);
    }
    for (const cell of this.scene.cells) this.place(cell, this.drawn.get(`part/${cell.name}`));
    for (const name of this.robots.keys()) this.carry(name);
    this.root.updateMatrixWorld(true);
  }

  robot(name, told) {
    this.robots.get(name)?.show(told);
  }

  zone(name, told) {
    const robot = told.robot && this.robots.get(told.robot);
    this.zones.get(name)?.show(told, robot && this.paints.cell(this.numbers.get(robot.told.cell)));
  }

  // The parts at the places of a cell, one for each place that has some, made when it is first needed.
  books(name, { places }) {
    for (const { cell, place, frame } of this.scene.places.filter((each) => each.cell === name)) {
      const key = `${cell}/${place}`;
      if (places[place] && !this.atPlaces.get(key)) this.atPlaces.set(key, this.lay(this.newPart(), frame));
      if (this.atPlaces.get(key)) this.atPlaces.get(key).visible = places[place] > 0;
    }
  }

  // Puts a part into the hand of a robot that carries one by the books of a cell: for sure or not.
  carry(name) {
    this.carried.get(name)?.removeFromParent();
    const told = [...this.numbers.keys()].map((cell) => this.drawn.get(`books/${cell}`)?.carriers[name]);
    const sure = told.find((each) => each !== undefined);
    if (sure === undefined) return;
    if (!this.carried.has(name)) this.carried.set(name, this.newPart());
    this.carried.get(name).material = sure ? this.paints.part() : this.paints.maybe();
    this.hang(this.carried.get(name), this.robots.get(name));
  }

  newPart() {
    const size = this.scene.part;
    const part = new this.THREE.Mesh(geometry(this.THREE, "cylinder", size), this.paints.part());
    part.userData = { shape: { kind: "cylinder", size }, isPart: true };
    part.castShadow = true;
    return part;
  }

  // Puts a cell's part where it is: into the effector, on the mobile, or where it was put down.
  place(cell, told) {
    const part = this.parts.get(cell.name);
    part.removeFromParent();
    if (!told) return;
    part.material = told.sure ? this.paints.part() : this.paints.maybe();
    if (told.at === "place") this.lay(part, told.frame);
    else this.hang(part, this.robots.get(told.at === "arm" ? cell.arm : cell.mobile));
  }

  hang(part, robot) {
    part.matrixAutoUpdate = true;
    part.rotation.set(0, 0, 0);
    part.position.set(0, 0, robot.told.deck + this.scene.part[1] / 2);
    robot.shown.tip.add(part);
  }

  lay(part, frame) {
    part.matrixAutoUpdate = false;
    const down = new this.THREE.Matrix4().makeTranslation(0, 0, this.scene.part[1] / 2);
    part.matrix.set(...frame).multiply(down);
    this.moving.add(part);
    return part;
  }

  paint(colorOf) {
    this.paints.paint(colorOf);
  }

  // What has to be seen of the plant, or of one cell, as points; the plant's where nothing of the cell is drawn.
  points(name) {
    this.root.updateMatrixWorld(true);
    const found = this.pointsOf(name);
    return found.length ? found : this.pointsOf();
  }

  pointsOf(name) {
    const { Vector3 } = this.THREE;
    const cells = this.scene.cells.filter((cell) => !name || cell.name === name);
    const places = this.scene.places.filter((each) => !name || each.cell === name);
    const frames = [...cells.flatMap((cell) => [...cell.pickups]), ...places.map(({ frame }) => frame)];
    const stations = frames.map((frame) => new Vector3(frame[3], frame[7], frame[11]));
    const robots = [...this.robots.values()].filter((robot) => !name || robot.told.cell === name);
    return [...stations, ...cells.flatMap((cell) => this.furniture.corners.get(cell.name).map((corner) => corner.clone())), ...robots.flatMap((robot) => robot.points())];
  }

  links() {
    this.root.updateMatrixWorld(true);
    return Object.fromEntries([...this.robots].map(([name, robot]) => [name, robot.links()]));
  }

  // Where the middle of each part is that is drawn, m.
  middles() {
    this.root.updateMatrixWorld(true);
    const found = [];
    this.root.traverseVisible((each) => each.userData.isPart && found.push(each.getWorldPosition(new this.THREE.Vector3()).toArray()));
    return found;
  }

  // What is written into the drawing: {text, state, color, above, at}, `at` in m.
  labels() {
    const cells = this.scene.cells.map((cell, number) => ({ text: cell.name, state: "cell", color: this.paints.cell(number), at: this.furniture.nameAt(cell) }));
    const robots = [...this.robots].map(([name, robot]) => this.robotLabel(name, robot));
    const zones = [...this.zones].map(([name, zone]) => ({ ...zone.label(), text: this.zoneText(name) }));
    return [...cells, ...robots, ...zones, ...this.counts()];
  }

  // The number of parts at places that have more than the one that is drawn.
  counts() {
    const numbered = this.scene.places.map((each) => ({ ...each, parts: this.drawn.get(`books/${each.cell}`)?.places[each.place] }));
    const many = numbered.filter(({ parts }) => parts > 1);
    return many.map(({ place, parts, frame }) => ({ text: `${place}: ${parts}`, state: "place", at: new this.THREE.Vector3(frame[3], frame[7], frame[11]) }));
  }

  robotLabel(name, robot) {
    const told = this.drawn.get(`robot/${name}`) ?? { kind: "untold" };
    const text = ["measured", "untold"].includes(told.kind) ? name : `${name} · ${this.wordOf(told)}`;
    return { text, state: told.kind, above: robot.told.kind === "mobile", at: robot.labelAt() };
  }

  zoneText(name) {
    const { state, robot } = this.drawn.get(`zone/${name}`) ?? { state: "free" };
    return word(`twin_${state}`).replace("{zone}", name).replace("{robot}", robot ?? "");
  }

  wordOf(told) {
    return word(`twin_${told.kind}`).replace("{time}", told.age === null || told.age === undefined ? "?" : ROUND(told.age));
  }
}

const word = (key) => window.arboledaPage.words[key] ?? key;
