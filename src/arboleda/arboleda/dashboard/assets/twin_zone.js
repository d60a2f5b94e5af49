// A shared zone: a glass prism around what is known to lie in it, in the colour of who has it.

const TINTS = { free: 0.05, held: 0.22, quarantined: 0.3 };
const QUARANTINE = "#c4201a";

export class Zone {
  constructor(THREE, told, paints) {
    Object.assign(this, { THREE, told, root: new THREE.Group() });
    const shape = new THREE.Shape(told.outline.map(([x, y]) => new THREE.Vector2(x, y)));
    const prism = new THREE.ExtrudeGeometry(shape, { depth: told.high - told.low, bevelEnabled: false });
    this.fill = paints.see({ color: "#888", side: THREE.DoubleSide });
    this.edge = new THREE.LineBasicMaterial({ color: "#888" });
    this.mesh = new THREE.Mesh(prism, this.fill);
    this.mesh.userData.outline = told.outline;
    this.root.add(this.mesh, new THREE.LineSegments(new THREE.EdgesGeometry(prism, 40), this.edge));
    this.root.position.z = told.low;
    this.hatching = hatching(THREE);
    this.root.visible = told.outline.length > 0;
    this.show({ state: "free" }, null);
  }

  show({ state }, color) {
    this.state = state;
    const shown = state === "quarantined" ? QUARANTINE : state === "held" ? color : "#88908c";
    this.fill.color.set(shown);
    this.edge.color.set(shown);
    this.fill.opacity = TINTS[state];
    const map = state === "quarantined" ? this.hatching : null;
    if (this.fill.map !== map) this.fill.needsUpdate = true;
    this.fill.map = map;
  }

  label() {
    const [x, y] = [0, 1].map((axis) => this.told.outline.reduce((sum, point) => sum + point[axis], 0) / (this.told.outline.length || 1));
    return { state: this.state, at: new this.THREE.Vector3(x, y, this.told.high) };
  }
}

// Stripes, 50 mm apart: a quarantine reads without its colour too.
function hatching(THREE) {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 64;
  const pen = canvas.getContext("2d");
  pen.strokeStyle = "#fff";
  pen.lineWidth = 18;
  for (const shift of [-64, 0, 64]) {
    pen.moveTo(shift - 8, 72);
    pen.lineTo(shift + 72, -8);
  }
  pen.stroke();
  const texture = new THREE.CanvasTexture(canvas);
  texture.wrapS = texture.wrapT = THREE.RepeatWrapping;
  texture.repeat.set(20, 20);
  return texture;
}
