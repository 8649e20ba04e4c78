import {
  AmbientLight, BoxGeometry, BufferGeometry, Color, CylinderGeometry, DirectionalLight, EdgesGeometry,
  Float32BufferAttribute, Group, InstancedMesh, LineBasicMaterial, LineSegments, Matrix4, Mesh,
  MeshLambertMaterial, PerspectiveCamera, Quaternion, Scene, SphereGeometry, TubeGeometry, Curve, Vector3,
  WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { floats, numberText } from './data.js';

const up = new Vector3(0, 0, 1);

export function hasWebGL() {
  try {
    return Boolean(document.createElement('canvas').getContext('webgl2'));
  } catch {
    return false;
  }
}

// -- Shapes

function withEdges(mesh, colour) {
  const edges = new EdgesGeometry(mesh.geometry, 30);
  mesh.add(new LineSegments(edges, new LineBasicMaterial({ color: new Color(colour).multiplyScalar(0.45) })));
  return mesh;
}

function material(colour, opacity = 1) {
  return new MeshLambertMaterial({ color: colour, transparent: opacity < 1, opacity, depthWrite: opacity >= 1 });
}

function itemMesh(item) {
  const [a, b, c] = item.size;
  const skin = material(item.colour, item.opacity);
  if (item.shape === 'box') return withEdges(new Mesh(new BoxGeometry(a, b, c), skin), item.colour);
  if (item.shape === 'mesh') {
    const geometry = new BufferGeometry().setAttribute('position', new Float32BufferAttribute(floats(item.triangles), 3));
    geometry.computeVertexNormals();
    return withEdges(new Mesh(geometry, skin), item.colour);
  }
  if (item.shape === 'sphere') return new Mesh(new SphereGeometry(a, 32, 20), skin);
  const round = withEdges(new Mesh(new CylinderGeometry(a, a, b, 48), skin), item.colour);
  if (item.shape === 'wheel') {  // spokes, so that it is seen to turn
    const ends = [];
    for (const y of [-0.502 * b, 0.502 * b])
      for (let k = 0; k < 3; k++) {
        const angle = (k * Math.PI) / 3;
        ends.push(-0.85 * a * Math.cos(angle), y, -0.85 * a * Math.sin(angle));
        ends.push(0.85 * a * Math.cos(angle), y, 0.85 * a * Math.sin(angle));
      }
    const geometry = new BufferGeometry().setAttribute('position', new Float32BufferAttribute(ends, 3));
    round.add(new LineSegments(geometry, new LineBasicMaterial({ color: 0xffffff })));
  }
  return round;
}

// Largest distance of a point of the item from the origin of its axes, about.
function itemReach(item) {
  if (item.shape === 'box') return 0.5 * Math.hypot(...item.size);
  if (item.shape !== 'mesh') return Math.max(...item.size.slice(0, item.shape === 'sphere' ? 1 : 2));
  const p = floats(item.triangles);
  let r = 0;
  for (let i = 0; i < p.length; i += 3) r = Math.max(r, Math.hypot(p[i], p[i + 1], p[i + 2]));
  return r;
}

// A helix of unit length along z with straight ends.
class Helix extends Curve {
  constructor(radius, turns) { super(); this.radius = radius; this.turns = turns; }
  getPoint(t, target = new Vector3()) {
    const s = Math.min(1, Math.max(0, (t - 0.1) / 0.8));
    const r = this.radius * Math.min(1, s * 12, (1 - s) * 12);
    const angle = 2 * Math.PI * this.turns * s;
    return target.set(r * Math.cos(angle), r * Math.sin(angle), t);
  }
}

function linkMesh(link) {
  const skin = material(link.colour);
  if (link.shape === 'spring') return new Mesh(new TubeGeometry(new Helix(link.radius, 6), 180, link.radius / 7, 6), skin);
  const geometry = new CylinderGeometry(link.radius, link.radius, 1, 12);
  geometry.rotateX(Math.PI / 2).translate(0, 0, 0.5);
  return new Mesh(geometry, skin);
}

// -- Motion

// Poses of one frame, interpolated; the deviation from `rest` is magnified in y, z and rotation.
class MovingFrame {
  constructor(data) {
    this.group = new Group();
    this.poses = floats(data.poses);
    if (data.rest) {
      this.rest = new Vector3(...data.rest.slice(0, 3));
      this.restTurn = new Quaternion(...data.rest.slice(3));
    }
  }

  update(i, s, magnification) {
    const { position, quaternion } = this.group;
    const a = 7 * i, b = s > 0 ? a + 7 : a, p = this.poses;
    position.set(p[a] + s * (p[b] - p[a]), p[a + 1] + s * (p[b + 1] - p[a + 1]), p[a + 2] + s * (p[b + 2] - p[a + 2]));
    quaternion.fromArray(p, a + 3).slerp(new Quaternion().fromArray(p, b + 3), s);
    if (this.rest && magnification !== 1) {
      position.y = this.rest.y + magnification * (position.y - this.rest.y);
      position.z = this.rest.z + magnification * (position.z - this.rest.z);
      const turn = quaternion.multiply(this.restTurn.clone().invert());
      if (turn.w < 0) turn.set(-turn.x, -turn.y, -turn.z, -turn.w);
      const sine = Math.hypot(turn.x, turn.y, turn.z);
      const angle = magnification * 2 * Math.atan2(sine, turn.w);
      if (sine > 0) turn.setFromAxisAngle(new Vector3(turn.x, turn.y, turn.z).divideScalar(sine), angle);
      turn.multiply(this.restTurn);
    }
    this.group.updateMatrixWorld(true);
  }
}

// A row of points that move vertically: segments between them, or a block at each.
class DeformingLine {
  constructor(data) {
    this.data = data;
    this.x = floats(data.x);
    this.deflection = floats(data.deflection);
    const n = this.x.length;
    const [lx, ly, lz] = data.block || [1, data.width, data.width];
    this.count = data.block ? n : Math.max(1, n - 1);
    this.mesh = new InstancedMesh(new BoxGeometry(lx, ly, lz), material(data.colour), this.count);
    this.mesh.frustumCulled = false;
    this.z = new Float32Array(n);
  }

  update(i, s, magnification) {
    const n = this.x.length, d = this.deflection, next = s > 0 ? (i + 1) * n : i * n;
    for (let k = 0; k < n; k++)
      this.z[k] = this.data.height + magnification * (d[i * n + k] + s * (d[next + k] - d[i * n + k]));
    const matrix = new Matrix4(), place = new Vector3(), turn = new Quaternion(), scale = new Vector3(1, 1, 1);
    const across = new Vector3(0, 1, 0);
    for (let k = 0; k < this.count; k++) {
      if (this.data.block || n === 1) {
        place.set(this.x[k], this.data.y, this.z[k]);
      } else {
        const dx = this.x[k + 1] - this.x[k], dz = this.z[k + 1] - this.z[k];
        place.set(this.x[k] + dx / 2, this.data.y, this.z[k] + dz / 2);
        turn.setFromAxisAngle(across, -Math.atan2(dz, dx));
        scale.x = Math.hypot(dx, dz);
      }
      this.mesh.setMatrixAt(k, matrix.compose(place, turn, scale));
    }
    this.mesh.instanceMatrix.needsUpdate = true;
  }
}

class Link {
  constructor(data, frames) {
    this.mesh = linkMesh(data);
    this.ends = [data.a, data.b].map(({ frame, point }) => [frames.get(frame), new Vector3(...point)]);
  }

  update() {
    const [a, b] = this.ends.map(([frame, point]) => (frame ? frame.group.localToWorld(point.clone()) : point.clone()));
    const along = b.clone().sub(a), length = Math.max(along.length(), 1e-6);
    this.mesh.position.copy(a);
    this.mesh.quaternion.setFromUnitVectors(up, along.divideScalar(length));
    this.mesh.scale.set(1, 1, length);
  }
}

// -- The picture

class Picture {
  constructor(data) {
    this.time = floats(data.time);
    this.scene = new Scene();
    this.scene.background = new Color(0xffffff);
    this.scene.add(new AmbientLight(0xffffff, 1.7));
    const sun = new DirectionalLight(0xffffff, 2.0);
    sun.position.set(-3, -6, 8);
    this.scene.add(sun);

    this.frames = new Map(data.frames.map((f) => [f.name, new MovingFrame(f)]));
    for (const frame of this.frames.values()) this.scene.add(frame.group);
    for (const item of data.items) {
      const holder = new Group();  // the item's axes in its frame; a cylinder of three.js has its axis along y, too
      holder.position.set(...item.offset.slice(0, 3));
      holder.quaternion.set(...item.offset.slice(3));
      holder.add(itemMesh(item));
      (item.frame ? this.frames.get(item.frame).group : this.scene).add(holder);
    }
    this.lines = data.lines.map((line) => new DeformingLine(line));
    this.links = data.links.map((link) => new Link(link, this.frames));
    for (const { mesh } of [...this.lines, ...this.links]) this.scene.add(mesh);
    this.measure(data);
    if (data.ground !== undefined) this.addGround(data.ground);
  }

  update(t, magnification) {
    const n = this.time.length;
    let i = 0;
    for (let high = n; high - i > 1;) {
      const middle = (i + high) >> 1;
      if (this.time[middle] <= t) i = middle; else high = middle;
    }
    const s = i + 1 < n ? Math.min(1, Math.max(0, (t - this.time[i]) / (this.time[i + 1] - this.time[i]))) : 0;
    for (const part of [...this.frames.values(), ...this.lines]) part.update(i, s, magnification);
    for (const link of this.links) link.update();
  }

  // The space that everything takes over all times.
  measure(data) {
    const low = new Vector3(Infinity, Infinity, Infinity), high = low.clone().negate();
    const include = (x, y, z, r = 0) => {
      low.min(new Vector3(x - r, y - r, z - r));
      high.max(new Vector3(x + r, y + r, z + r));
    };
    const reach = new Map();  // of the items around the origin of their frame
    for (const item of data.items) {
      const r = itemReach(item);
      const [x, y, z] = item.offset;
      if (!item.frame) include(x, y, z, r);
      reach.set(item.frame, Math.max(reach.get(item.frame) || 0, Math.hypot(x, y, z) + r));
    }
    for (const [name, { poses }] of this.frames)
      for (let i = 0; i < poses.length; i += 7) include(poses[i], poses[i + 1], poses[i + 2], reach.get(name) || 0);
    for (const { x, data: line } of this.lines) {
      include(x[0], line.y, line.height, 0.2);
      include(x[x.length - 1], line.y, line.height, 0.2);
    }
    for (const link of data.links)
      for (const end of [link.a, link.b]) if (!end.frame) include(...end.point, link.radius);
    if (low.x > high.x) include(0, 0, 0, 1);
    this.low = low;
    this.high = high;
  }

  addGround(height) {
    const size = Math.max(this.high.x - this.low.x, this.high.y - this.low.y, 1);
    // about a dozen cells of 1, 2 or 5 times a power of ten
    const decade = 10 ** Math.floor(Math.log10(size / 12));
    const step = [1, 2, 5, 10].map((f) => f * decade).find((s) => s >= size / 12);
    const margin = Math.min(0.25 * size, 30) + step;
    const ends = [];
    const [x0, x1] = [Math.floor((this.low.x - margin) / step), Math.ceil((this.high.x + margin) / step)];
    const half = Math.ceil((Math.max(-this.low.y, this.high.y) + Math.min(margin, 12)) / step);
    for (let i = x0; i <= x1; i++) ends.push(i * step, -half * step, height, i * step, half * step, height);
    for (let j = -half; j <= half; j++) ends.push(x0 * step, j * step, height, x1 * step, j * step, height);
    const geometry = new BufferGeometry().setAttribute('position', new Float32BufferAttribute(ends, 3));
    this.scene.add(new LineSegments(geometry, new LineBasicMaterial({ color: 0xd5d5d5 })));
    this.gridStep = step;
  }
}

// -- Playing it

const speeds = [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5];

export function drawAnimation(figure, data) {
  const place = figure.querySelector('.stage'), find = (name) => figure.querySelector(`[data-control=${name}]`);
  const picture = new Picture(data);
  const renderer = new WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
  renderer.setPixelRatio(window.devicePixelRatio);
  place.appendChild(renderer.domElement);
  const camera = new PerspectiveCamera(24, 2, 0.05, 5000);
  camera.up.copy(up);
  const controls = new OrbitControls(camera, renderer.domElement);
  controls.enableDamping = false;

  const first = picture.time[0], end = picture.time[picture.time.length - 1];
  const scrub = find('scrub'), play = find('play'), speed = find('speed'), exaggeration = find('exaggeration');
  const follow = find('follow');
  const followed = data.camera.follow ? picture.frames.get(data.camera.follow) : null;
  const state = { t: first + 0.5 * (end - first), playing: false, magnification: data.exaggeration, x: 0 };

  // controls that this scene does not need are not shown
  const small = data.lines.length > 0 || data.frames.some((f) => f.rest);
  find('exaggeration-label').hidden = !small;
  find('follow-label').hidden = !followed;
  const magnifications = [...new Set([1, 10, 20, 50, 100, 200, 500, 1000, data.exaggeration])].sort((a, b) => a - b);
  for (const m of magnifications) exaggeration.add(new Option(`× ${numberText(m)}`, m));
  exaggeration.value = data.exaggeration;
  const natural = (end - first) / 12;  // seconds shown per second for a film of 12 s
  for (const v of speeds) speed.add(new Option(v === 1 ? 'real time' : v < 1 ? `1/${numberText(1 / v)}` : `× ${v}`, v));
  speed.value = speeds.reduce((best, v) => (v <= Math.min(1, natural * 1.5) ? v : best), speeds[0]);

  function draw() {
    picture.update(state.t, state.magnification);
    if (followed && follow.checked) {  // travel with it
      const { x } = followed.group.position;
      camera.position.x += x - state.x;
      controls.target.x += x - state.x;
      state.x = x;
    }
    camera.lookAt(controls.target);
    renderer.render(picture.scene, camera);
    scrub.value = Math.round((1000 * (state.t - first)) / Math.max(end - first, 1e-12));
    find('time').textContent = `t = ${state.t.toFixed(3)} s of ${end.toFixed(3)} s`;
    const note = find('note');
    note.textContent = small ? (state.magnification === 1 ? 'deflections to scale'
                                                          : `deflections × ${numberText(state.magnification)}`) : '';
    note.hidden = !small;
  }

  function view(azimuth, elevation) {
    picture.update(state.t, state.magnification);
    const { low, high } = picture;
    let target = low.clone().add(high).multiplyScalar(0.5);
    let width = data.camera.width;
    if (width > 0) {
      target.set(...data.camera.target);
      if (followed) { state.x = followed.group.position.x; target.x += state.x; }
    } else {
      if (followed) { state.x = followed.group.position.x; target.x = state.x; }
      const size = high.clone().sub(low);
      width = 1.1 * Math.max(Math.hypot(size.x, size.y), size.z * camera.aspect, 0.1);
    }
    const distance = width / 2 / (Math.tan((camera.fov * Math.PI) / 360) * camera.aspect);
    const a = (azimuth * Math.PI) / 180, e = (elevation * Math.PI) / 180;
    camera.position.set(Math.cos(a) * Math.cos(e), Math.sin(a) * Math.cos(e), Math.sin(e)).multiplyScalar(distance).add(target);
    camera.near = distance / 200;
    camera.far = distance * 60 + target.distanceTo(high) * 2;
    camera.updateProjectionMatrix();
    controls.target.copy(target);
    controls.update();
    draw();
  }

  const reset = () => view(data.camera.azimuth, data.camera.elevation);
  function refit(w) {
    const width = Math.max(260, Math.floor(w || place.getBoundingClientRect().width));
    const height = Math.round(Math.min(width * 0.44, 520));
    renderer.setSize(width, height);
    camera.aspect = width / height;
    camera.updateProjectionMatrix();
    draw();
  }

  let before = null;
  function step(now) {
    if (!state.playing) return;
    state.t += before === null ? 0 : ((now - before) / 1000) * Number(speed.value);
    before = now;
    if (state.t > end) state.t = first + ((state.t - end) % Math.max(end - first, 1e-9));
    draw();
    requestAnimationFrame(step);
  }
  function setPlaying(playing) {
    state.playing = playing;
    before = null;
    play.textContent = playing ? 'Pause' : 'Play';
    if (playing) requestAnimationFrame(step);
  }

  play.addEventListener('click', () => setPlaying(!state.playing));
  scrub.addEventListener('input', () => { state.t = first + (scrub.value / 1000) * (end - first); draw(); });
  exaggeration.addEventListener('change', () => { state.magnification = Number(exaggeration.value); draw(); });
  find('reset').addEventListener('click', reset);
  find('side').addEventListener('click', () => view(-90, 3));
  follow.addEventListener('change', () => { if (followed) state.x = followed.group.position.x; draw(); });
  controls.addEventListener('change', () => { if (!state.playing) draw(); });

  follow.checked = Boolean(followed);
  refit();
  reset();
  return { refit, draw, canvas: renderer.domElement };
}

// Whether something stands in the picture: pixels that are not white.
export function isShown(animation) {
  const canvas = document.createElement('canvas');
  canvas.width = 320;
  canvas.height = 160;
  const context = canvas.getContext('2d', { willReadFrequently: true });
  context.drawImage(animation.canvas, 0, 0, 320, 160);
  const pixels = context.getImageData(0, 0, 320, 160).data;
  let inked = 0;
  for (let i = 0; i < pixels.length; i += 4)
    if (pixels[i + 3] > 128 && Math.min(pixels[i], pixels[i + 1], pixels[i + 2]) < 200) inked++;
  return inked > 50;
}
