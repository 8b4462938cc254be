// The viewer of a dataset: what the pile is, where its voids are, and how the camera went. Runs in the
// page that `rubble view` writes, after three.js.
'use strict';
(() => {
const data = JSON.parse(document.getElementById('data').textContent);
const status = document.getElementById('status');
const bytes = text => Uint8Array.from(atob(text), c => c.charCodeAt(0)).buffer;
const floats = text => new Float32Array(bytes(text)), counts = text => new Uint32Array(bytes(text));

let renderer;
try {
  renderer = new THREE.WebGLRenderer({ antialias: true, canvas: document.getElementById('view') });
} catch (error) {
  status.textContent = 'This browser draws no WebGL: ' + error.message;
  document.body.dataset.state = 'no WebGL';
  return;
}
renderer.localClippingEnabled = true;
const scene = new THREE.Scene();
scene.background = new THREE.Color(0xe9ecef);
scene.add(new THREE.HemisphereLight(0xffffff, 0x8d8573, 0.75));
const sun = new THREE.DirectionalLight(0xffffff, 0.55);
sun.position.set(-3, -5, 8);
scene.add(sun);
const camera = new THREE.PerspectiveCamera(50, 1, 0.02, 500);
camera.up.set(0, 0, 1);

// What is cut away lies beyond this plane.
const cut = new THREE.Plane(new THREE.Vector3(0, 1, 0), 1e6);

function geometryOf(mesh) {
  const geometry = new THREE.BufferGeometry();
  const add = geometry.setAttribute ? 'setAttribute' : 'addAttribute';
  geometry[add]('position', new THREE.BufferAttribute(floats(mesh.positions), 3));
  geometry.setIndex(new THREE.BufferAttribute(counts(mesh.indices), 1));
  geometry.computeVertexNormals();
  return geometry;
}

let triangles = 0;
const pieces = new THREE.Group(), voids = new THREE.Group(), track = new THREE.Group();
const pieceMaterials = [];
for (const type of data.types) {
  const poses = floats(type.instances), count = poses.length / 16, matrix = new THREE.Matrix4();
  for (const group of type.groups) {
    const material = new THREE.MeshLambertMaterial({ color: new THREE.Color(...group.colour),
      side: THREE.DoubleSide, flatShading: true, clippingPlanes: [cut], transparent: true });
    pieceMaterials.push(material);
    const mesh = new THREE.InstancedMesh(geometryOf(group), material, count);
    for (let i = 0; i < count; ++i) mesh.setMatrixAt(i, matrix.fromArray(poses, 16 * i));
    mesh.frustumCulled = false;
    pieces.add(mesh);
    triangles += count * counts(group.indices).length / 3;
  }
}
data.voids.forEach((mesh, i) => {
  const material = new THREE.MeshLambertMaterial({ color: new THREE.Color().setHSL((0.55 + 0.13 * i) % 1, 0.75, 0.5),
    side: THREE.DoubleSide, transparent: true, opacity: 0.45, depthWrite: false, clippingPlanes: [cut] });
  voids.add(new THREE.Mesh(geometryOf(mesh), material));
});
const robots = new THREE.Group();
function lineOf(positions, colour) {
  const geometry = new THREE.BufferGeometry();
  geometry[geometry.setAttribute ? 'setAttribute' : 'addAttribute']('position', new THREE.BufferAttribute(positions, 3));
  return new THREE.Line(geometry, new THREE.LineBasicMaterial({ color: colour }));
}
// A camera's way, and its view in the optical frame: Z forward, X right, Y down.
const ways = data.tracks.map(way => {
  const path = floats(way.positions), marker = new THREE.Group();
  if (path.length === 0) return null;
  track.add(lineOf(path, 0xc0392b));
  const [w, h] = way.view, corners = [[-w, -h, 1], [w, -h, 1], [w, h, 1], [-w, h, 1]].map(
    c => new THREE.Vector3(...c).multiplyScalar(way.length));
  const lines = new THREE.Geometry();
  corners.forEach((c, i) => lines.vertices.push(new THREE.Vector3(), c, c, corners[(i + 1) % 4]));
  marker.add(new THREE.LineSegments(lines, new THREE.LineBasicMaterial({ color: 0xe67e22 })));
  track.add(marker);
  return { name: way.name, path, turns: floats(way.rotations), stamps: way.stamps, frames: way.frames, marker };
}).filter(way => way);
const movers = [];
for (const robot of data.robots) {
  track.add(lineOf(floats(robot.positions), 0x2471a3));
  for (const link of robot.links) {
    const mesh = new THREE.Mesh(geometryOf(link), new THREE.MeshLambertMaterial({ color: 0x5d7fa3, side: THREE.DoubleSide, flatShading: true }));
    robots.add(mesh);
    movers.push({ mesh, poses: floats(link.poses), stamps: robot.stamps });
    triangles += counts(link.indices).length / 3;
  }
}
scene.add(pieces, voids, track, robots);

const centre = new THREE.Vector3(...data.centre), radius = data.radius;
const grid = new THREE.GridHelper(Math.max(4, 2 * Math.ceil(1.5 * radius)), Math.max(4, 2 * Math.ceil(1.5 * radius)), 0x999999, 0xcccccc);
grid.rotation.x = Math.PI / 2;
scene.add(grid);

// Turning, shifting and coming nearer about a target.
const eye = { yaw: -2.2, pitch: 0.5, away: 2.4 * radius, target: centre.clone() };
function draw() {
  eye.pitch = Math.min(1.55, Math.max(-1.55, eye.pitch));
  const c = Math.cos(eye.pitch);
  camera.position.set(Math.cos(eye.yaw) * c, Math.sin(eye.yaw) * c, Math.sin(eye.pitch))
    .multiplyScalar(eye.away).add(eye.target);
  camera.lookAt(eye.target);
  const canvas = renderer.domElement, width = canvas.clientWidth, height = canvas.clientHeight;
  if (canvas.width !== width || canvas.height !== height) renderer.setSize(width, height, false);
  camera.aspect = width / height;
  camera.updateProjectionMatrix();
  renderer.render(scene, camera);
}
const canvas = renderer.domElement;
canvas.addEventListener('contextmenu', event => event.preventDefault());
canvas.addEventListener('pointerdown', event => canvas.setPointerCapture(event.pointerId));
canvas.addEventListener('pointermove', event => {
  if (!event.buttons) return;
  const step = 2.2 / canvas.clientHeight;
  if (event.buttons === 1 && !event.shiftKey) {
    eye.yaw -= event.movementX * step;
    eye.pitch += event.movementY * step;
  } else {
    const right = new THREE.Vector3().setFromMatrixColumn(camera.matrix, 0);
    const up = new THREE.Vector3().setFromMatrixColumn(camera.matrix, 1);
    eye.target.addScaledVector(right, -event.movementX * step * eye.away / 2)
      .addScaledVector(up, event.movementY * step * eye.away / 2);
  }
  draw();
});
canvas.addEventListener('wheel', event => {
  event.preventDefault();
  eye.away = Math.min(400, Math.max(0.05, eye.away * Math.exp(0.001 * event.deltaY)));
  draw();
}, { passive: false });
window.addEventListener('resize', draw);

const control = id => document.getElementById(id);
for (const [id, group] of [['pieces', pieces], ['voids', voids], ['track', track], ['robots', robots]])
  if (control(id)) control(id).addEventListener('change', () => { group.visible = control(id).checked; draw(); });
control('opacity').addEventListener('input', () => {
  const opacity = Number(control('opacity').value);
  pieceMaterials.forEach(material => { material.opacity = opacity; material.depthWrite = opacity > 0.99; });
  draw();
});
control('cut').addEventListener('input', () => {
  const share = Number(control('cut').value);
  cut.constant = share >= 1 ? 1e6 : -(centre.y - radius + 2 * radius * (1 - share));
  draw();
});
function nearest(stamps, stamp) {
  let at = 0;
  stamps.forEach((s, i) => { if (Math.abs(s - stamp) < Math.abs(stamps[at] - stamp)) at = i; });
  return at;
}
// Robots and all cameras where they were at that time.
function place(stamp) {
  for (const way of ways) {
    const i = nearest(way.stamps, stamp);
    way.marker.position.fromArray(way.path, 3 * i);
    way.marker.quaternion.fromArray(way.turns, 4 * i);
  }
  for (const mover of movers) {
    const i = nearest(mover.stamps, stamp);
    mover.mesh.position.fromArray(mover.poses, 7 * i);
    mover.mesh.quaternion.fromArray(mover.poses, 7 * i + 3);
  }
}
let shown = ways[0];
function show(frame) {
  if (!shown) {
    if (movers.length > 0) place(movers[0].stamps[frame]);
    draw();
    return;
  }
  place(shown.stamps[frame]);
  const near = shown.frames.reduce((best, f) => !best || Math.abs(f.frame - frame) < Math.abs(best.frame - frame) ? f : best, null);
  control('picture').src = near ? 'data:image/jpeg;base64,' + near.jpeg : '';
  control('frame').textContent = 'frame ' + frame + ', ' + shown.stamps[frame].toFixed(3) + ' s' +
    (near && near.frame !== frame ? '; picture of frame ' + near.frame : '');
  draw();
}
const moments = () => shown ? shown.stamps.length : movers.length > 0 ? movers[0].stamps.length : 0;
if (moments() > 0) {
  control('time').hidden = false;
  control('time').max = moments() - 1;
  control('time').addEventListener('input', () => show(Number(control('time').value)));
}
if (ways.length > 1) {
  control('which').hidden = false;
  ways.forEach((way, i) => control('camera').add(new Option(way.name, i)));
  control('camera').addEventListener('change', () => {
    const stamp = shown.stamps[Number(control('time').value)];
    shown = ways[Number(control('camera').value)];
    control('time').max = moments() - 1;
    control('time').value = nearest(shown.stamps, stamp);
    show(Number(control('time').value));
  });
}
if (location.hash === '#follow' && shown) {
  eye.target.fromArray(shown.path, 0);
  eye.away = 1;
}
show(0);
draw();
status.textContent = data.pieces + ' pieces, ' + triangles + ' triangles, ' + data.voids.length + ' voids, ' +
  ways.reduce((sum, way) => sum + way.stamps.length, 0) + ' frames' + (data.robots.length > 0 ? ', ' + data.robots.length + (data.robots.length > 1 ? ' robots' : ' robot') : '');
document.body.dataset.state = 'drawn';
})();
