// What never moves: the floor, each cell's grid with its node numbers, and the rack with its station numbers.

import { geometry } from "./twin_bodies.js";

const PLATE = [0.027, 0.027, 0.003]; // m: what a part of a station stands on
const POST = 0.004; // m, radius
const BOARD = 0.008; // m, how thick the boards of a rack are
const FLOOR = 0.45; // m of floor around all

export class Furniture {
  constructor(THREE, scene, paints) {
    Object.assign(this, { THREE, paints, root: new THREE.Group(), numbers: new Map(), corners: new Map() });
    this.tile = paints.page("box", { roughness: 1 }, "MeshStandardMaterial");
    this.edge = paints.page("soft", {}, "LineBasicMaterial");
    this.rack = paints.page("off", { roughness: 0.8 }, "MeshStandardMaterial");
    this.part = scene.part[1]; // between the tool and the plate
    this.floor(scene.bounds);
    scene.cells.forEach((cell, number) => this.cell(cell, paints.cell(number)));
    scene.robots.filter((robot) => robot.kind === "arm").forEach((arm) => this.foot(arm));
  }

  floor([[x0, y0], [x1, y1]]) {
    const { THREE } = this;
    const [wide, deep] = [x1 - x0 + 2 * FLOOR, y1 - y0 + 2 * FLOOR];
    const plane = new THREE.Mesh(new THREE.PlaneGeometry(wide, deep), this.paints.page("paper", { roughness: 1 }, "MeshStandardMaterial"));
    plane.position.set((x0 + x1) / 2, (y0 + y1) / 2, -0.002);
    plane.receiveShadow = true;
    const lines = new THREE.GridHelper(Math.max(wide, deep), Math.round(Math.max(wide, deep) / 0.1));
    lines.material.dispose();
    lines.material = this.paints.page("line", { transparent: true, opacity: 0.55 }, "LineBasicMaterial");
    lines.rotation.x = Math.PI / 2;
    lines.position.copy(plane.position).setZ(-0.001);
    const cut = [[1, 0, -x0 + FLOOR], [-1, 0, x1 + FLOOR], [0, 1, -y0 + FLOOR], [0, -1, y1 + FLOOR]];
    lines.material.clippingPlanes = cut.map(([x, y, d]) => new THREE.Plane(new THREE.Vector3(x, y, 0), d));
    this.root.add(plane, lines);
  }

  cell(cell, color) {
    const grid = new this.THREE.Group();
    const [x, y, yaw] = cell.grid.at;
    grid.position.set(x, y, 0);
    grid.rotation.z = yaw;
    cell.grid.nodes.forEach(([along, up], node) => grid.add(this.node(along, up, node, cell.grid.pitch, yaw)));
    const frame = this.frame(cell.grid, color);
    grid.add(frame);
    grid.updateMatrixWorld();
    this.corners.set(cell.name, frame.userData.corners.map((corner) => grid.localToWorld(corner)));
    this.root.add(grid);
    cell.stations.forEach((frame, number) => this.station(frame, number, color));
    cell.shelves.forEach((shelf) => this.shelf(shelf));
  }

  // A board under the plates of all stations at one height.
  shelf({ outline, top }) {
    const { THREE } = this;
    const shape = new THREE.Shape(outline.map(([x, y]) => new THREE.Vector2(x, y)));
    const board = new THREE.Mesh(new THREE.ExtrudeGeometry(shape, { depth: BOARD, bevelEnabled: false }), this.rack);
    board.position.z = Math.max(0, top - PLATE[2] - BOARD);
    board.userData.shape = { kind: "outline", size: outline };
    board.castShadow = board.receiveShadow = true;
    this.root.add(board);
  }

  node(x, y, number, pitch, yaw) {
    const { THREE } = this;
    const side = pitch * 0.96;
    const tile = new THREE.Mesh(geometry(THREE, "box", [side, side, 0.002]), this.tile);
    tile.position.set(x, y, 0);
    tile.receiveShadow = true;
    tile.userData.shape = { kind: "box", size: [side, side, 0.002] };
    const written = this.number(number, pitch * 0.5, "soft");
    written.position.z = 0.002;
    written.rotation.z = -yaw; // upright for who looks along the world's y
    tile.add(written);
    return tile;
  }

  // A coloured line around a cell's grid.
  frame({ nodes, pitch }, color) {
    const { THREE } = this;
    const [x, y] = [0, 1].map((axis) => Math.max(...nodes.map((node) => node[axis])) + pitch / 2);
    const low = -pitch / 2;
    const points = [[low, low], [x, low], [x, y], [low, y]].map(([a, b]) => new THREE.Vector3(a, b, 0.003));
    const line = new THREE.LineLoop(new THREE.BufferGeometry().setFromPoints(points), new THREE.LineBasicMaterial({ color }));
    line.userData.corners = points.map((point) => point.clone());
    return line;
  }

  station(frame, number, color) {
    const { THREE } = this;
    const plate = new THREE.Mesh(geometry(THREE, "box", PLATE), this.paints.once(`plate ${color}`, () => this.paints.lit({ color, roughness: 0.7 })));
    plate.matrixAutoUpdate = false;
    plate.matrix.set(...frame).multiply(new THREE.Matrix4().makeTranslation(0, 0, this.part + PLATE[2] / 2));
    plate.userData.shape = { kind: "box", size: PLATE };
    plate.castShadow = plate.receiveShadow = true;
    const at = new THREE.Vector3().setFromMatrixPosition(plate.matrix);
    const post = new THREE.Mesh(geometry(THREE, "cylinder", [POST, 1]), this.rack);
    post.scale.z = Math.max(0.001, at.z);
    post.position.set(at.x, at.y, at.z / 2);
    plate.add(this.face(number, plate.matrix, 1), this.face(number, plate.matrix, -1));
    this.root.add(plate, post);
  }

  foot(arm) {
    const { THREE } = this;
    const ring = new THREE.Mesh(new THREE.RingGeometry(0.135, 0.14, 64), this.paints.page("soft"));
    ring.position.set(arm.at[0], arm.at[1], 0.001);
    this.root.add(ring);
  }

  // Where the name of a cell is written: outside its grid.
  nameAt(cell) {
    const { at, nodes, pitch } = cell.grid;
    const corners = nodes.map(([x, y]) => new this.THREE.Vector3(x, y, 0).applyAxisAngle(new this.THREE.Vector3(0, 0, 1), at[2]));
    const low = Math.min(...corners.map((corner) => corner.y));
    const middle = corners.reduce((sum, corner) => sum + corner.x, 0) / corners.length;
    return new this.THREE.Vector3(at[0] + middle, at[1] + low - pitch * 0.62, 0);
  }

  // A number on one side of a plate, its head where most is up, or north.
  face(number, plate, side) {
    const { THREE } = this;
    const face = this.number(number, PLATE[0] * 0.95, "sign");
    const normal = new THREE.Vector3().setFromMatrixColumn(plate, 2).multiplyScalar(side);
    const up = new THREE.Vector3(0, Math.abs(normal.z) > 0.7 ? 1 : 0, Math.abs(normal.z) > 0.7 ? 0 : 1);
    const right = up.clone().cross(normal).normalize();
    const world = new THREE.Matrix4().makeBasis(right, normal.clone().cross(right), normal);
    const turn = new THREE.Matrix4().extractRotation(plate).invert().multiply(world);
    face.quaternion.setFromRotationMatrix(turn);
    face.position.z = side * (PLATE[2] / 2 + 0.0005);
    return face;
  }

  // A number painted flat onto something.
  number(number, size, color) {
    const material = this.paints.once(`flat ${color} ${number}`, () => this.paints.page(color, { map: this.texture(number), transparent: true, depthWrite: false }));
    const mesh = new this.THREE.Mesh(this.paints.once(`plane ${size}`, () => new this.THREE.PlaneGeometry(size, size)), material);
    mesh.userData.text = { text: String(number), size };
    return mesh;
  }

  // White glyphs, so that the material's colour colours them.
  texture(number) {
    if (!this.numbers.has(number)) {
      const canvas = document.createElement("canvas");
      canvas.width = canvas.height = 64;
      const pen = canvas.getContext("2d");
      Object.assign(pen, { fillStyle: "#fff", textAlign: "center", textBaseline: "middle" });
      pen.font = `600 ${String(number).length > 1 ? 40 : 56}px system-ui, sans-serif`;
      pen.fillText(number, 32, 35);
      this.numbers.set(number, new this.THREE.CanvasTexture(canvas));
    }
    return this.numbers.get(number);
  }
}
