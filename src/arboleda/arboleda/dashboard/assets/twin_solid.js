// The plant in three dimensions: light, camera, and what people write beside things.

import { Labels } from "./twin_labels.js";

const FROM = [0.3, -1, 0.62]; // where one looks from at first
const ROOM = 0.9; // how much of the picture the plant may fill
const TURN = Math.PI / 24;
const NEARER = 0.85;
const POLL_MS = 8;
const SLOW_MS = 30; // for one picture: there is no graphics card
const REST = 3; // times as long nothing is drawn then, so that buttons are answered
const pause = (ms) => new Promise((go) => setTimeout(go, ms));

export class SolidView {
  name = "solid";

  // An Error where this browser has no WebGL; `lost` is called where it loses it later.
  constructor(THREE, OrbitControls, box, plant, lost) {
    Object.assign(this, { THREE, box, plant });
    this.renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.localClippingEnabled = true;
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = THREE.PCFSoftShadowMap;
    this.canvas = this.renderer.domElement;
    this.canvas.addEventListener("webglcontextlost", lost, { once: true });
    this.scene = new THREE.Scene();
    this.scene.add(plant.root, ...this.lights(plant.scene.bounds));
    this.camera = new THREE.PerspectiveCamera(32, 1, 0.02, 200);
    this.camera.up.set(0, 0, 1);
    this.labels = new Labels(box);
    this.labels.layer.hidden = true; // there is nothing yet that a name could stand beside
    this.seen = new Promise((first) => (this.first = first));
    this.reachable();
    box.prepend(this.canvas);
    this.controls = new OrbitControls(this.camera, this.canvas);
    Object.assign(this.controls, { maxPolarAngle: Math.PI / 2 - 0.03, minDistance: 0.15, zoomToCursor: true });
    this.controls.addEventListener("change", () => this.show());
    this.resizing = new ResizeObserver(() => this.resize());
    this.resizing.observe(box);
    this.resize(); // before a cell is visited, which is as near as it fits
  }

  lights([[x0, y0], [x1, y1, z1]]) {
    const { THREE } = this;
    const sky = new THREE.HemisphereLight("#ffffff", "#c5ccc7", 2.0);
    const sun = new THREE.DirectionalLight("#ffffff", 2.1);
    const [x, y, wide] = [(x0 + x1) / 2, (y0 + y1) / 2, Math.hypot(x1 - x0, y1 - y0, z1) / 2 + 0.4];
    sun.position.set(x - wide * 0.6, y - wide * 0.9, wide * 2.2);
    sun.target.position.set(x, y, 0);
    sun.castShadow = true;
    sun.shadow.mapSize.set(2048, 2048);
    sun.shadow.normalBias = 0.004;
    Object.assign(sun.shadow.camera, { left: -wide, right: wide, top: wide, bottom: -wide, near: 0.1, far: wide * 5 });
    return [sky, sun, sun.target];
  }

  reachable() {
    this.canvas.tabIndex = 0;
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-label", window.arboledaPage.words.twin_view);
    this.canvas.addEventListener("keydown", (event) => {
      const act = KEYS[event.key];
      if (!act || event.ctrlKey || event.metaKey || event.altKey) return;
      event.preventDefault();
      act(this);
    });
  }

  tool(name) {
    TOOLS[name]?.(this);
  }

  visit(cell) {
    this.whole(FROM, cell);
    this.show();
  }

  // A canvas of another size is empty until it is drawn, which may be a while where pictures are slow: so it is drawn at once.
  resize() {
    const { clientWidth, clientHeight } = this.box;
    if (!clientWidth || !clientHeight || (clientWidth === this.width && clientHeight === this.height)) return;
    [this.width, this.height] = [clientWidth, clientHeight];
    this.renderer.setSize(clientWidth, clientHeight);
    this.camera.aspect = clientWidth / clientHeight;
    this.camera.updateProjectionMatrix();
    if (!this.looked) this.whole(FROM);
    if (this.plant.drawn.size) this.render();
  }

  // Has the whole plant, or one cell, seen from one side, as near as it fits.
  whole(from, cell) {
    const { THREE, camera } = this;
    camera.position.set(...from).normalize();
    camera.lookAt(0, 0, 0);
    const away = camera.quaternion.clone().invert();
    const points = this.plant.points(cell).map((point) => point.applyQuaternion(away));
    const slope = Math.tan((camera.fov * Math.PI) / 360) * ROOM;
    const rows = [["x", slope * camera.aspect], ["y", slope]].map(([axis, slope]) => fit(points, axis, slope));
    const distance = Math.max(...rows.map((row) => row.distance));
    const depth = points.reduce((sum, point) => sum + point.z, 0) / points.length;
    const [x, y] = rows.map((row) => row.middle);
    camera.position.set(x, y, distance).applyQuaternion(camera.quaternion);
    this.controls.target.set(x, y, depth).applyQuaternion(camera.quaternion);
    this.controls.update();
    this.looked = true;
  }

  turn(about, over) {
    const { THREE, camera, controls } = this;
    const way = new THREE.Spherical().setFromVector3(flip(camera.position.clone().sub(controls.target)));
    way.theta += about;
    way.phi = Math.min(Math.max(way.phi + over, 0.01), controls.maxPolarAngle);
    camera.position.copy(controls.target).add(unflip(new THREE.Vector3().setFromSpherical(way)));
    controls.update();
    this.show();
  }

  nearer(factor) {
    this.camera.position.sub(this.controls.target).multiplyScalar(factor).add(this.controls.target);
    this.controls.update();
    this.show();
  }

  // Draws before the next picture of the screen, once however often it is asked; nothing before the first frame has come.
  show() {
    if (this.plant.drawn.size === 0) return;
    this.stale = true;
    this.asked ??= requestAnimationFrame(() => this.draw());
  }

  render() {
    this.renderer.render(this.scene, this.camera);
    this.labels.draw(this.plant.labels(), this.camera, this.box);
  }

  async draw() {
    const began = performance.now();
    this.stale = false;
    this.render();
    await this.drawn();
    if (this.asked === 0) return; // closed meanwhile
    this.labels.layer.hidden = false;
    this.first();
    const took = performance.now() - began;
    if (took > SLOW_MS) await pause(REST * took);
    if (this.asked === 0) return;
    this.asked = undefined;
    if (this.stale) this.show();
  }

  // Wait until the picture is there, which the processor draws where there is no graphics card.
  async drawn() {
    const gl = this.renderer.getContext();
    const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    if (!fence) return;
    gl.flush();
    do await pause(POLL_MS);
    while (gl.clientWaitSync(fence, 0, 0) === gl.TIMEOUT_EXPIRED);
    gl.deleteSync(fence);
  }

  close() {
    cancelAnimationFrame(this.asked);
    this.asked = 0; // nothing is drawn any more
    this.resizing.disconnect();
    this.controls.dispose();
    this.renderer.dispose();
    this.canvas.remove();
    this.labels.close();
  }
}

// The least distance from which points lie within a slope to both sides, and the middle that this takes.
function fit(points, axis, slope) {
  const most = Math.max(...points.map((point) => point[axis] + slope * point.z));
  const least = Math.min(...points.map((point) => point[axis] - slope * point.z));
  return { distance: (most - least) / (2 * slope), middle: (most + least) / 2 };
}

const flip = ({ x, y, z, constructor: Vector }) => new Vector(x, z, -y); // spherical coordinates have y up
const unflip = ({ x, y, z, constructor: Vector }) => new Vector(x, -z, y);

const TOOLS = {
  reset: (view) => (view.whole(FROM), view.show()),
  top: (view) => (view.whole([0, -0.001, 1]), view.show()),
  in: (view) => view.nearer(NEARER),
  out: (view) => view.nearer(1 / NEARER),
};

const KEYS = {
  ArrowLeft: (view) => view.turn(-TURN, 0),
  ArrowRight: (view) => view.turn(TURN, 0),
  ArrowUp: (view) => view.turn(0, -TURN),
  ArrowDown: (view) => view.turn(0, TURN),
  "+": TOOLS.in,
  "=": TOOLS.in,
  "-": TOOLS.out,
  Home: TOOLS.reset,
  0: TOOLS.reset,
};
