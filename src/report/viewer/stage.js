// The 3D side: meshes, cameras and panes.
import * as THREE from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';
import { LineSegments2 } from 'three/examples/jsm/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/examples/jsm/lines/LineSegmentsGeometry.js';
import { Edges } from './edges.js';
import { FilmShape } from './film_shape.js';
import { OVERLAYS } from './overlays.js';
import { MODE, dress, pictureTexture, sharedTextures, surfaceMaterial } from './surface.js';
import { castRay } from './pick.js';

const FIELD_OF_VIEW = 26;
const WRAPS = {
  repeat: THREE.RepeatWrapping,
  mirror: THREE.MirroredRepeatWrapping,
  clamp: THREE.ClampToEdgeWrapping,
  decal: THREE.ClampToEdgeWrapping,
};

function attribute(values, size) {
  return new THREE.BufferAttribute(values, size);
}

// Unit normals of a mesh's vertices; `sign` -1 turns them over.
function vertexNormals(position, index, triangles, sign) {
  const normal = new Float32Array(position.length);
  for (const t of triangles) {
    const [a, b, c] = [0, 1, 2].map((k) => 3 * index[3 * t + k]);
    const u = [0, 1, 2].map((k) => position[b + k] - position[a + k]);
    const v = [0, 1, 2].map((k) => position[c + k] - position[a + k]);
    const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    for (const corner of [a, b, c]) for (let k = 0; k < 3; ++k) normal[corner + k] += sign * n[k];
  }
  for (let i = 0; i < normal.length; i += 3) {
    const length = Math.hypot(normal[i], normal[i + 1], normal[i + 2]) || 1;
    for (let k = 0; k < 3; ++k) normal[i + k] /= length;
  }
  return normal;
}

function turned(index, triangles) {
  const list = new Uint32Array(3 * triangles.length);
  triangles.forEach((t, i) => list.set([index[3 * t], index[3 * t + 2], index[3 * t + 1]], 3 * i));
  return attribute(list, 1);
}

export class Stage {
  // `slow`: the context draws on the processor, without smoothed edges.
  constructor(canvas, context, slow, scene, invalidate) {
    this.scene = scene;
    this.invalidate = invalidate;
    this.renderer = new THREE.WebGLRenderer({ canvas, context });
    this.edges = new Edges(this.renderer, slow, () => this.draw());
    this.renderer.autoClear = false;
    this.shared = sharedTextures(scene);
    this.makeObject();
    this.makeFilm();
    this.makeDip();
    this.makeMarker();
    this.makeCamera(canvas);
  }

  // --- What there is to see ---

  makeObject() {
    [this.object, this.objectMaterials] = this.makeMesh(this.scene.object);
    const { geometry } = this.object;
    geometry.computeBoundingBox();
    geometry.computeBoundingSphere();
    this.bounds = geometry.boundingBox;
    this.looks = this.scene.looks.map(({ key, object }) => {
      const [mesh, materials] = this.makeMesh(object);
      return { key, mesh, materials };
    });
  }

  makeMesh(object) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', attribute(object.position, 3));
    geometry.setAttribute('normal', attribute(object.normal, 3));
    if (object.uv) geometry.setAttribute('uv', attribute(object.uv, 2));
    if (object.color) geometry.setAttribute('tint', attribute(object.color, 4));
    geometry.setIndex(attribute(object.index, 1));
    for (const g of object.groups) geometry.addGroup(g.start, g.count, g.material);
    const maps = new Map(); // one for each picture and way of wrapping
    const materials = object.materials.map((m) => {
      const key = `${m.texture} ${m.wrap}`;
      if (m.texture >= 0 && !maps.has(key)) {
        const texture = pictureTexture(object.textures[m.texture], this.invalidate);
        [texture.wrapS, texture.wrapT] = m.wrap.map((name) => WRAPS[name]);
        maps.set(key, texture);
      }
      const map = maps.get(key);
      return surfaceMaterial(this.scene, this.shared, { ...m, map, tinted: Boolean(object.color) });
    });
    return [new THREE.Mesh(geometry, materials), materials];
  }

  makeFilm() {
    const { film, sheet, cell_mm: cell } = this.scene;
    this.picture = sheet.picture ? pictureTexture(sheet.picture, this.invalidate) : null;
    const uv = new Float32Array(film.u.length);
    for (let i = 0; i < uv.length; i += 2) {
      uv[i] = film.u[i] / sheet.width_mm + 0.5;
      uv[i + 1] = film.u[i + 1] / sheet.height_mm + 0.5;
    }
    this.filmUv = attribute(uv, 2);
    const part = (triangles, lift) => {
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute('position', attribute(film.position, 3));
      geometry.setAttribute('normal', attribute(vertexNormals(film.position, film.index, triangles, -1), 3));
      geometry.setAttribute('uv', this.filmUv);
      geometry.setAttribute('amount', attribute(film.stretch, 1));
      geometry.setIndex(turned(film.index, triangles));
      const material = surfaceMaterial(this.scene, this.shared, {
        map: this.picture,
        film: true,
        side: THREE.FrontSide, // film on the far side must not show through
        lift,
      });
      const mesh = new THREE.Mesh(geometry, material);
      mesh.frustumCulled = false;
      return mesh;
    };
    // Between its vertices the film lies a little inside the object.
    this.lying = part(film.lying, cell);
    this.torn = part(film.torn, cell);
    this.result = new THREE.Group();
    this.result.add(this.lying, this.torn, ...this.looks.map(({ mesh }) => mesh));
    this.standUp();
  }

  // As people see the object: its front towards +z, +y up.
  standUp() {
    const up = new THREE.Vector3(...this.scene.standing.up);
    const front = new THREE.Vector3(...this.scene.standing.front);
    const across = new THREE.Matrix4().makeBasis(up.clone().cross(front), up, front);
    this.result.quaternion.setFromRotationMatrix(across.transpose());
    this.result.position.copy(this.center().applyQuaternion(this.result.quaternion).negate());
  }

  // Towards the eye that sees most of what is to be told; not quite along the axis that one turns about.
  firstLook() {
    const direction = new THREE.Vector3(...this.scene.first_look).applyQuaternion(this.result.quaternion);
    return Math.hypot(direction.x, direction.z) < 0.1 ? direction.add(new THREE.Vector3(0, 0, 0.1)) : direction;
  }

  center() {
    return this.bounds.getCenter(new THREE.Vector3());
  }

  makeDip() {
    const { film, bath } = this.scene;
    this.shape = new FilmShape(film);
    this.shape.moveTo(0);
    const all = Array.from({ length: film.index.length / 3 }, (_, t) => t);
    this.allTriangles = all;
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', attribute(this.shape.position, 3));
    geometry.setAttribute('normal', attribute(new Float32Array(film.position.length), 3));
    geometry.setAttribute('uv', this.filmUv);
    geometry.setAttribute('amount', attribute(film.stretch, 1));
    geometry.setIndex(attribute(new Uint32Array(film.index), 1));
    const material = surfaceMaterial(this.scene, this.shared, { map: this.picture, film: true, lift: 0.5 });
    this.sheetFilm = new THREE.Mesh(geometry, material);
    this.sheetFilm.frustumCulled = false;
    this.contact = new LineSegments2(
      new LineSegmentsGeometry(),
      new LineMaterial({ color: 0xd4330a, linewidth: 3, depthTest: false, transparent: true, opacity: 0.9 }),
    );
    this.contact.frustumCulled = false;
    this.contact.renderOrder = 3;
    this.water = this.makeWater(bath);
    this.lowered = new THREE.Group(); // object and film, as deep as they are
    this.lowered.add(this.sheetFilm, this.contact);
    this.dip = new THREE.Group();
    this.dip.add(this.lowered, this.water);
    this.dip.rotation.x = -Math.PI / 2;
  }

  makeWater(bath) {
    const width = Math.max(bath.width_mm, this.scene.sheet.width_mm);
    const height = Math.max(bath.height_mm, this.scene.sheet.height_mm);
    // Bath and sheet may lie either way round.
    const along = this.scene.sheet.width_mm > this.scene.sheet.height_mm === bath.width_mm > bath.height_mm;
    const plane = new THREE.PlaneGeometry(along ? width : height, along ? height : width);
    const water = new THREE.Group();
    const surface = new THREE.Mesh(
      plane,
      new THREE.MeshBasicMaterial({ color: 0x3f8fc0, transparent: true, opacity: 0.3, side: THREE.DoubleSide, depthWrite: false }),
    );
    surface.position.z = -1.2; // film is drawn half a millimetre nearer than it is
    surface.renderOrder = 2;
    const rim = new THREE.LineSegments(new THREE.EdgesGeometry(plane), new THREE.LineBasicMaterial({ color: 0x3f8fc0 }));
    water.add(surface, rim);
    return water;
  }

  makeMarker() {
    const size = this.bounds.getSize(new THREE.Vector3()).length() / 110;
    const ball = (options) =>
      new THREE.Mesh(new THREE.SphereGeometry(size, 20, 14), new THREE.MeshBasicMaterial(options));
    this.marker = new THREE.Group();
    const through = ball({ color: 0xe3007b, transparent: true, opacity: 0.35, depthTest: false });
    through.renderOrder = 5;
    this.marker.add(ball({ color: 0xe3007b }), through);
    this.marker.visible = false;
  }

  makeCamera(canvas) {
    this.camera = new THREE.PerspectiveCamera(FIELD_OF_VIEW, 1, 1, 10000);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener('change', this.invalidate);
    this.root = new THREE.Scene();
    this.root.add(this.result, this.dip, this.marker);
    this.places = {};
  }

  // --- What is shown ---

  // view: 'both', 'wanted', 'predicted' or 'dip'.
  setView(view) {
    const kind = view === 'dip' ? 'dip' : 'result';
    if (this.kind) this.places[this.kind] = [this.camera.position.clone(), this.controls.target.clone()];
    this.view = view;
    if (this.kind === kind) return;
    this.kind = kind;
    (kind === 'dip' ? this.lowered : this.result).add(this.object);
    this.result.visible = kind === 'result';
    this.dip.visible = kind === 'dip';
    if (this.places[kind]) {
      this.camera.position.copy(this.places[kind][0]);
      this.controls.target.copy(this.places[kind][1]);
      this.controls.update();
    } else {
      this.look(kind === 'dip' ? 'side' : 'first');
    }
  }

  // From one of the named sides, so that everything is in the picture.
  look(side) {
    const directions = {
      front: [0.35, 0.22, 1],
      left: [-1, 0.15, 0.25],
      right: [1, 0.15, 0.25],
      back: [-0.3, 0.2, -1],
      side: [0.45, 0.42, 1],
      above: [0, 1, 0.02],
      below: [0.3, -0.75, 0.8],
    };
    const direction = (side === 'first' ? this.firstLook() : new THREE.Vector3(...directions[side])).normalize();
    this.controls.target.set(0, 0, 0);
    const distance = this.kind === 'dip' ? this.dipDistance() : this.objectDistance(direction);
    this.camera.position.copy(direction.multiplyScalar(distance));
    this.camera.near = distance / 50;
    this.camera.far = distance * 20;
    this.controls.minDistance = 0.15 * distance;
    this.controls.maxDistance = 4 * distance;
    this.controls.update();
    this.invalidate();
  }

  // Free film and object as large as the pane allows.
  dipDistance() {
    const { width_mm: width, height_mm: height } = this.scene.sheet;
    const object = this.bounds.getSize(new THREE.Vector3()).length();
    const radius = Math.max(0.6 * object, 0.36 * Math.hypot(width, height));
    return radius / Math.sin((FIELD_OF_VIEW * Math.PI) / 360) / Math.min(1, this.paneAspect());
  }

  objectDistance(direction) {
    const half = 0.9 * Math.tan((FIELD_OF_VIEW * Math.PI) / 360);
    const right = new THREE.Vector3(0, 1, 0).cross(direction).normalize();
    const up = direction.clone().cross(right);
    this.result.updateMatrixWorld();
    const { position } = this.scene.object;
    const p = new THREE.Vector3();
    let distance = 1;
    for (let i = 0; i < position.length; i += 3) {
      p.fromArray(position, i).applyMatrix4(this.result.matrixWorld);
      const depth = p.dot(direction);
      distance = Math.max(distance, Math.abs(p.dot(right)) / (half * this.paneAspect()) + depth, Math.abs(p.dot(up)) / half + depth);
    }
    return distance;
  }

  setDepth(depth) {
    const { film } = this.scene;
    this.depth = depth;
    this.shape.moveTo(depth);
    const { position, normal } = this.sheetFilm.geometry.attributes;
    normal.array.set(vertexNormals(this.shape.position, film.index, this.allTriangles, 1));
    position.needsUpdate = normal.needsUpdate = true;
    const pose = this.shape.pose();
    if (pose) {
      this.lowered.matrixAutoUpdate = false;
      this.lowered.matrix.fromArray(pose);
      this.lowered.matrixWorldNeedsUpdate = true;
    } else {
      this.lowered.position.z = -depth;
    }
    const points = this.shape.contactLine();
    this.contact.visible = points.length > 0;
    if (points.length) {
      this.contact.geometry.dispose();
      this.contact.geometry = new LineSegmentsGeometry().setPositions(points);
    }
    this.invalidate();
  }

  setGrid(on) {
    this.shared.grid.value = on;
    this.invalidate();
  }

  // Puts the marker to a point of the posed-object frame; null takes it away.
  mark(point) {
    this.marker.visible = Boolean(point);
    if (point) {
      const group = this.kind === 'dip' ? this.lowered : this.result;
      group.add(this.marker);
      this.marker.position.set(...point);
    }
    this.invalidate();
  }

  // --- Panes ---

  panes() {
    if (this.view !== 'both') return [{ what: this.view, from: 0, to: 1 }];
    return [
      { what: 'wanted', from: 0, to: 0.5 },
      { what: 'predicted', from: 0.5, to: 1 },
    ];
  }

  paneAspect() {
    const { width, height } = this.size;
    return width / (this.view === 'both' ? 2 : 1) / Math.max(1, height);
  }

  resize(width, height) {
    this.size = { width, height };
    this.renderer.setSize(width, height, false);
    this.contact.material.resolution.set(width, height);
    this.invalidate();
  }

  dressFor(what, overlayKey) {
    const overlay = OVERLAYS.find((entry) => entry.key === overlayKey);
    const look = what === 'predicted' && this.looks.find(({ key }) => key === overlayKey);
    for (const { mesh } of this.looks) mesh.visible = false;
    this.object.visible = !look;
    if (look) {
      look.mesh.visible = true;
      for (const material of look.materials) dress(material, { mode: MODE.picture }, this.scene, this.shared);
    }
    const dressObject = (look) => {
      for (const material of this.objectMaterials) dress(material, look, this.scene, this.shared);
    };
    const dressFilm = (mesh, look) => {
      mesh.visible = Boolean(look);
      if (look) dress(mesh.material, look, this.scene, this.shared);
    };
    if (what === 'dip') {
      dressObject({ mode: MODE.bare });
      dressFilm(this.sheetFilm, { mode: MODE.picture });
    } else if (what === 'wanted') {
      dressObject({ mode: MODE.picture });
      dressFilm(this.lying, null);
      dressFilm(this.torn, null);
    } else {
      dressObject(overlay.object(this.scene));
      const printed = overlay.key === 'none' && !this.picture ? null : overlay.film;
      dressFilm(this.lying, printed && printed(this.scene));
      dressFilm(this.torn, overlay.torn && overlay.torn(this.scene));
    }
  }

  render(overlay) {
    this.overlay = overlay;
    this.edges.show();
  }

  draw() {
    const { width, height } = this.size;
    const { renderer } = this;
    renderer.setScissorTest(false);
    renderer.clear();
    renderer.setScissorTest(true);
    for (const { what, from, to } of this.panes()) {
      const x = Math.round(from * width);
      const w = Math.round(to * width) - x;
      renderer.setViewport(x, 0, w, height);
      renderer.setScissor(x, 0, w, height);
      this.camera.aspect = w / height;
      this.camera.updateProjectionMatrix();
      this.dressFor(what, this.overlay);
      renderer.render(this.root, this.camera);
    }
  }

  // The point under the pointer (pixels from the canvas's corner) on the film or, where there is
  // none, on the object.
  pick(x, y) {
    const { width, height } = this.size;
    const pane = this.panes().find((p) => x >= p.from * width && x < p.to * width);
    if (!pane) return null;
    this.camera.aspect = (pane.to - pane.from) * width / height;
    this.camera.updateProjectionMatrix();
    const screen = new THREE.Vector2(
      (2 * (x - pane.from * width)) / ((pane.to - pane.from) * width) - 1,
      1 - (2 * y) / height,
    );
    const caster = new THREE.Raycaster();
    caster.setFromCamera(screen, this.camera);
    const group = this.kind === 'dip' ? this.lowered : this.result;
    const toLocal = group.matrixWorld.clone().invert();
    const origin = caster.ray.origin.clone().applyMatrix4(toLocal);
    const direction = caster.ray.direction.clone().transformDirection(toLocal);
    const ray = [origin.toArray(), direction.toArray()];
    const { film, object } = this.scene;
    const place = this.kind === 'dip' ? this.shape.position : film.position;
    const triangles = this.kind === 'dip' ? null : [...film.lying, ...film.torn];
    const onObject = castRay(object.position, object.index, null, ...ray);
    const onFilm = castRay(place, film.index, triangles, ...ray);
    const slack = 2 * this.scene.cell_mm;
    if (onFilm && (!onObject || onFilm.t < onObject.t + slack)) return { film: onFilm };
    return onObject ? { object: onObject } : null;
  }

  // Where a point of the posed-object frame is on the canvas, in the last pane.
  project(point) {
    const pane = this.panes().at(-1);
    const { width, height } = this.size;
    this.camera.aspect = (pane.to - pane.from) * width / height;
    this.camera.updateProjectionMatrix();
    this.root.updateMatrixWorld();
    const group = this.kind === 'dip' ? this.lowered : this.result;
    const p = new THREE.Vector3(...point).applyMatrix4(group.matrixWorld).project(this.camera);
    return [(pane.from + (0.5 + 0.5 * p.x) * (pane.to - pane.from)) * width, (0.5 - 0.5 * p.y) * height];
  }
}
