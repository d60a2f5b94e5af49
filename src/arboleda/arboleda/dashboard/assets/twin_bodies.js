// A robot's links as nested groups, one per joint: to move a robot is to set its joints.

const geometries = new Map();

export class Body {
  constructor(THREE, robot, paint) {
    this.THREE = THREE;
    this.links = new Map(); // name -> group whose frame is the link's
    this.joints = [];
    this.meshes = [];
    this.root = new THREE.Group();
    const [x, y, yaw] = robot.at;
    this.root.position.set(x, y, 0);
    this.root.rotation.z = yaw;
    this.root.add(this.link(robot.body, paint, []));
    this.tip = this.links.get(robot.tip);
  }

  // `movers`: the joints that move what is made here.
  link(told, paint, movers) {
    const { THREE } = this;
    const origin = placed(new THREE.Group(), told);
    const frame = new THREE.Group();
    origin.add(frame);
    this.links.set(told.link, frame);
    if (told.moves) this.joints[told.moves.index] = { ...told.moves, frame, along: new THREE.Vector3(...told.moves.axis) };
    const below = told.moves ? [...movers, told.moves.index] : movers;
    for (const shape of told.shapes) frame.add(this.shape(shape, paint, below));
    for (const child of told.children) frame.add(this.link(child, paint, below));
    return origin;
  }

  shape(told, paint, movers) {
    const mesh = new this.THREE.Mesh(geometry(this.THREE, told.kind, told.size), paint(told.color));
    mesh.userData.shape = { kind: told.kind, size: told.size };
    Object.assign(mesh.userData, { color: told.color, movers });
    this.meshes.push(mesh);
    return placed(mesh, told);
  }

  set(q) {
    for (const { index, type, frame, along } of this.joints) {
      if (type === "turn") frame.quaternion.setFromAxisAngle(along, q[index]);
      else frame.position.copy(along).multiplyScalar(q[index]);
    }
  }

  // Shows only what stands elsewhere than it would at `q`.
  showBeside(q, own, near) {
    const moved = own.map((value, index) => !q || Math.abs(value - q[index]) > near);
    for (const mesh of this.meshes) mesh.visible = !q || mesh.userData.movers.some((index) => moved[index]);
  }

  repaint(paint) {
    for (const mesh of this.meshes) mesh.material = paint(mesh.userData.color);
  }
}

function placed(object, { xyz, rpy }) {
  object.position.set(...xyz);
  object.rotation.set(...rpy, "ZYX"); // about x, then y, then z of the parent
  return object;
}

export function geometry(THREE, kind, size) {
  const key = `${kind} ${size}`;
  if (!geometries.has(key)) geometries.set(key, GEOMETRIES[kind](THREE, size));
  return geometries.get(key);
}

const GEOMETRIES = {
  box: (THREE, size) => new THREE.BoxGeometry(...size),
  cylinder: (THREE, [radius, length]) => new THREE.CylinderGeometry(radius, radius, length, 40).rotateX(Math.PI / 2),
  sphere: (THREE, [radius]) => new THREE.SphereGeometry(radius, 32, 20),
};
