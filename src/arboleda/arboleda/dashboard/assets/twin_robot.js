// One robot: what was measured of it, where it may be, and where it goes.

import { Body } from "./twin_bodies.js";

const FAINT = { stale: "stale", unhomed: "unknown", unknown: "unknown" };
const HIGH = 0.19; // m: where the name of a mobile is written
const SAME = 1e-3; // rad or m: a goal that is reached is not drawn

export class Robot {
  constructor(THREE, told, paints) {
    Object.assign(this, { THREE, told, paints });
    this.root = new THREE.Group();
    this.real = this.body(paints.unknown);
    this.real.set(told.reference);
    this.shown = this.real; // the body that stands for the robot
  }

  body(paint) {
    const body = new Body(this.THREE, this.told, paint);
    this.root.add(body.root);
    return body;
  }

  show({ kind, q, estimate, goal }) {
    const believed = kind === "measured";
    this.real.root.visible = q !== null || estimate === null;
    this.real.set(q ?? this.told.reference);
    this.repaint(believed ? "solid" : FAINT[kind] ?? "unknown");
    this.ghost("guess", estimate, "estimate", q);
    this.ghost("aim", goal && far(goal, q ?? estimate) ? goal : null, "goal", q ?? estimate);
    this.shown = q === null && estimate !== null ? this.guess : this.real;
  }

  repaint(paint) {
    if (this.painted === paint) return;
    this.painted = paint;
    this.real.repaint(this.paints[paint]);
    for (const mesh of this.real.meshes) mesh.castShadow = mesh.receiveShadow = paint === "solid" || paint === "stale";
  }

  // A second body of the same robot, made when it is first needed.
  ghost(name, q, paint, beside) {
    if (q) {
      this[name] ??= this.body(this.paints[paint]);
      this[name].set(q);
      this[name].showBeside(beside, q, SAME);
    }
    if (this[name]) this[name].root.visible = q !== null && q !== undefined;
  }

  links() {
    return Object.fromEntries([...this.real.links].map(([name, frame]) => [name, rows(frame.matrixWorld.elements)]));
  }

  // The corners of its shapes' boxes.
  points() {
    return this.real.meshes.flatMap((mesh) => corners(this.THREE, mesh.geometry).map((corner) => mesh.localToWorld(corner)));
  }

  labelAt() {
    const at = new this.THREE.Vector3();
    if (this.told.kind === "arm") return at.set(this.told.at[0], this.told.at[1], 0);
    return this.shown.tip.getWorldPosition(at).setZ(HIGH);
  }
}

function corners(THREE, geometry) {
  if (!geometry.boundingBox) geometry.computeBoundingBox();
  const { min, max } = geometry.boundingBox;
  return [0, 1, 2, 3, 4, 5, 6, 7].map((n) => new THREE.Vector3(n & 1 ? max.x : min.x, n & 2 ? max.y : min.y, n & 4 ? max.z : min.z));
}

const far = (goal, q) => !q || goal.some((value, index) => Math.abs(value - q[index]) > SAME);
const rows = (columns) => columns.map((_, index) => columns[(index % 4) * 4 + (index >> 2)]);
