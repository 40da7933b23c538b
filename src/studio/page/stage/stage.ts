// The 3D view. Two views of one posed object: in the bath over its film, and as it comes out, from the
// side that met the film. It draws when something has changed, never waits for the program, and knows
// nothing of jobs: it is told what to show and tells what was done to it.
import * as THREE from 'three';
import { drawsOnProcessor, Edges } from '../../../report/viewer/edges.js';
import { dress, MODE, sharedTextures, surfaceMaterial } from '../../../report/viewer/surface.js';
import { castRay } from '../../../report/viewer/pick.js';
import type { DipFrames, MeshData, Overlay, Result } from '../api.ts';
import type { Pose, Vec3 } from '../document.ts';
import { makeBasin, type BathShape, type SheetShape } from './basin.ts';
import { Eyes, HALF, type LookFrom, type View } from './eyes.ts';
import { FilmPicture, surfaceOf } from './film.ts';
import { AIR, overlayOf, sceneOf, type Scene } from './overlays.ts';
import { discard, makePainted, type Painted } from './painted.ts';
import { anglesOf, placeOf, turnedDown, turnOf } from './pose.ts';
import { PoseGizmo } from './pose_gizmo.ts';

export type { LookFrom, View } from './eyes.ts';
export type Tool = 'none' | 'turn' | 'move' | 'face';
export type Compare = 'both' | 'wanted' | 'predicted';

export interface FilmSpot {
  triangle: number;
  weights: [number, number, number];
}

export interface Hit {
  film: FilmSpot | null;
  place: Vec3; // posed frame
  normal: Vec3;
}

export interface StageEvents {
  pose(change: Partial<Pose>, live: boolean): void;
  click(hit: Hit | null): void;
  point(hit: Hit | null): void;
  drawn(): void;
}

const WHITE = [1, 1, 1];
const FILM_BASE = [0.80, 0.80, 0.78]; // wet film, linear

const linear = (hex: string): number[] => new THREE.Color(hex).toArray();

export class Stage {
  private readonly renderer: THREE.WebGLRenderer;
  private readonly edges: Edges;
  private readonly root = new THREE.Scene();
  private readonly bath = new THREE.Group();
  private readonly lowered = new THREE.Group();
  private readonly finished = new THREE.Group();
  private readonly filmGroup = new THREE.Group(); // glued to the object
  private readonly basin = new THREE.Group();
  private readonly waterLine: THREE.LineLoop;
  private readonly marker = new THREE.Group();
  private readonly facet: THREE.Mesh;
  private readonly gizmo: PoseGizmo;
  private readonly eyes: Eyes;
  private readonly shared;
  private readonly meshes: Record<View, THREE.Mesh>;
  private scene: Scene = sceneOf(null, WHITE);
  private painted: Painted | null = null;
  private film: FilmPicture | null = null;
  private whole: { colors: Painted; parts: Painted } | null = null; // all dips together
  private airMeshes: THREE.Mesh[] = [];
  private model: MeshData | null = null;
  private matrix = new THREE.Matrix4();
  private turn = new THREE.Quaternion();
  private pose: Pose | null = null;
  private scale = 1;
  private bounds = new THREE.Box3();
  private posed = { position: new Float32Array(0), normal: new Float32Array(0) };
  private base = WHITE;
  private size = { width: 1, height: 1 };
  private waiting = false;
  private sheetShape: SheetShape = { width_mm: 210, height_mm: 297, margin_mm: 10, disc: false };
  private lost = false;

  view: View = 'bath';
  overlay: Overlay = 'none';
  compare: Compare = 'both';
  divider = 0.5;
  tool: Tool = 'none';
  level = -1; // how deep the object is in the bath view; negative: above the water
  allDips = false;
  inset: { x: number; y: number; width: number; height: number } | null = null; // CSS pixels, from the bottom left
  readOnly = false;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly events: StageEvents,
  ) {
    const slow = drawsOnProcessor();
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: !slow, alpha: true });
    this.edges = new Edges(this.renderer, slow, () => this.lost || this.render());
    this.renderer.autoClear = false;
    this.shared = sharedTextures(this.scene);
    const empty = new THREE.BufferGeometry();
    this.meshes = { bath: new THREE.Mesh(empty), object: new THREE.Mesh(empty) };
    for (const mesh of Object.values(this.meshes)) mesh.frustumCulled = false;
    this.eyes = new Eyes(canvas, { home: (view) => this.home(view), size_mm: () => (this.model?.largest_mm ?? 0) * this.scale, changed: () => this.invalidate() });
    this.waterLine = new THREE.LineLoop(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color: 0x1f6f78 }));
    this.lowered.add(this.meshes.bath, this.waterLine);
    this.bath.add(this.lowered, this.basin);
    this.finished.add(this.meshes.object, this.filmGroup);
    this.facet = this.makeFacet();
    this.makeMarker();
    this.gizmo = new PoseGizmo(this.eyes.cameras.bath, canvas, this.lowered, this.bath, {
      held: () => this.pose && { turn: this.turn.clone(), pose: this.pose },
      center: () => this.center(),
      height_mm: () => this.bounds.max.z,
      moved: (change, live) => events.pose(change, live),
      holds: (on) => (this.eyes.orbits.bath.enabled = !on && this.view === 'bath'),
      changed: () => this.invalidate(),
    });
    this.root.add(this.bath, this.finished);
    this.listen();
    this.setView('bath');
  }

  // --- What there is to see ---

  setModel(model: MeshData | null): void {
    const another = model?.mesh !== this.model?.mesh;
    this.model = model;
    if (!model) this.paint(null, []);
    if (another) this.eyes.forget();
    this.place();
  }

  // The model in the colours that are wanted of it, with its textures loaded.
  paint(data: MeshData | null, textures: readonly THREE.Texture[]): void {
    const old = this.painted;
    this.painted = data && makePainted(data, textures, this.scene, this.shared);
    for (const mesh of Object.values(this.meshes)) {
      mesh.visible = Boolean(this.painted);
      if (!this.painted) continue;
      mesh.geometry = this.painted.geometry;
      mesh.material = this.painted.materials;
    }
    if (data) this.place();
    if (old) discard(old);
    this.updateUniforms();
    this.invalidate();
  }

  // All dips together: the model as it looks in the end, and in a colour for each dip.
  setFinish(finish: { colors: MeshData; parts: MeshData } | null, textures: { colors: readonly THREE.Texture[]; parts: readonly THREE.Texture[] }): void {
    for (const part of this.whole ? [this.whole.colors, this.whole.parts] : []) {
      this.finished.remove(part.mesh);
      discard(part);
    }
    const painted = (data: MeshData, list: readonly THREE.Texture[]): Painted => makePainted(data, list, this.scene, this.shared);
    this.whole = finish && { colors: painted(finish.colors, textures.colors), parts: painted(finish.parts, textures.parts) };
    for (const part of this.whole ? [this.whole.colors, this.whole.parts] : []) {
      part.mesh.visible = false;
      this.finished.add(part.mesh);
    }
    if (this.whole) this.place();
    this.updateUniforms();
    this.invalidate();
  }

  setPose(pose: Pose, scale: number): void {
    this.pose = pose;
    this.scale = scale;
    this.turn = turnOf(pose);
    this.place();
  }

  setBase(color: string): void {
    this.base = linear(color);
    this.updateUniforms();
    this.invalidate();
  }

  setSheet(shape: SheetShape, bath: BathShape): void {
    this.sheetShape = shape;
    makeBasin(this.basin, shape, bath);
    this.invalidate();
  }

  // The last whole result of the dip that is shown, or nothing.
  setResult(result: Result | null): void {
    if (this.film?.result === result) return;
    this.film?.dispose();
    this.film = result && new FilmPicture(result, (options) =>
      surfaceMaterial(this.scene, this.shared, { ...options, film: true }) as THREE.ShaderMaterial);
    this.scene = sceneOf(result, this.base);
    this.filmGroup.clear();
    for (const mesh of this.airMeshes) {
      mesh.geometry.dispose();
      (mesh.material as THREE.Material).dispose();
    }
    this.airMeshes = [];
    for (const child of [...this.bath.children]) if (child.name === 'afloat') this.bath.remove(child);
    if (result && this.film) {
      this.film.afloat.name = 'afloat';
      this.bath.add(this.film.afloat);
      this.filmGroup.add(this.film.lying, this.film.torn, this.film.wrinkled);
      this.addAir(result);
    }
    this.updateUniforms();
    this.glue();
    this.setLevel(this.level);
  }

  setFrames(result: Result, frames: DipFrames): void {
    if (this.film?.result !== result) return;
    this.film.setFrames(frames);
    this.setLevel(this.level);
  }

  private addAir({ air, lids }: Result): void {
    const add = (surface: Result['air'], options: THREE.MeshBasicMaterialParameters): void => {
      if (!surface) return;
      const mesh = surfaceOf(surface, new THREE.MeshBasicMaterial({ side: THREE.DoubleSide, ...options }));
      this.airMeshes.push(mesh);
      this.filmGroup.add(mesh);
    };
    add(air, { color: AIR, polygonOffset: true, polygonOffsetFactor: -2, polygonOffsetUnits: -8 });
    add(lids, { color: AIR, transparent: true, opacity: 0.25, depthWrite: false });
  }

  private makeFacet(): THREE.Mesh {
    const facet = new THREE.Mesh(
      new THREE.RingGeometry(0.72, 1, 40),
      new THREE.MeshBasicMaterial({ color: 0x1f6f78, side: THREE.DoubleSide, depthTest: false, transparent: true, opacity: 0.9 }),
    );
    facet.visible = false;
    facet.renderOrder = 6;
    this.lowered.add(facet);
    return facet;
  }

  private makeMarker(): void {
    const ball = (options: THREE.MeshBasicMaterialParameters): THREE.Mesh =>
      new THREE.Mesh(new THREE.SphereGeometry(1, 20, 14), new THREE.MeshBasicMaterial(options));
    const through = ball({ color: 0xe3007b, transparent: true, opacity: 0.35, depthTest: false });
    through.renderOrder = 5;
    this.marker.add(ball({ color: 0xe3007b }), through);
    this.marker.visible = false;
  }

  // --- Where things are ---

  private place(): void {
    const { model, painted } = this;
    if (!model || !this.pose) return;
    this.matrix = placeOf(model.position, this.turn, this.scale);
    this.bounds.makeEmpty();
    this.posed = this.posedOf(painted?.data ?? model, this.bounds);
    for (const part of [painted, this.whole?.colors, this.whole?.parts]) {
      if (!part) continue;
      const at = part === painted ? this.posed : this.posedOf(part.data, null);
      (part.geometry.getAttribute('position') as THREE.BufferAttribute).copyArray(at.position).needsUpdate = true;
      (part.geometry.getAttribute('normal') as THREE.BufferAttribute).copyArray(at.normal).needsUpdate = true;
    }
    this.finished.position.copy(this.center()).negate();
    this.marker.children.forEach((child) => child.scale.setScalar(this.radius() / 55));
    this.gizmo.place();
    this.glue();
    this.placeWaterLine();
    this.eyes.frame();
    this.setLevel(this.level);
  }

  // A mesh's vertices as the object hangs, and the box that holds them.
  private posedOf(data: MeshData, bounds: THREE.Box3 | null): { position: Float32Array<ArrayBuffer>; normal: Float32Array<ArrayBuffer> } {
    const position = new Float32Array(data.position.length);
    const normal = new Float32Array(data.position.length);
    const e = this.matrix.elements;
    const s = this.scale || 1;
    const p = new THREE.Vector3();
    for (let i = 0; i < position.length; i += 3) {
      const x = data.position[i]!, y = data.position[i + 1]!, z = data.position[i + 2]!;
      const nx = data.normal[i]!, ny = data.normal[i + 1]!, nz = data.normal[i + 2]!;
      for (let k = 0; k < 3; ++k) {
        position[i + k] = e[k]! * x + e[4 + k]! * y + e[8 + k]! * z + e[12 + k]!;
        normal[i + k] = (e[k]! * nx + e[4 + k]! * ny + e[8 + k]! * nz) / s;
      }
      bounds?.expandByPoint(p.fromArray(position, i));
    }
    return { position, normal };
  }

  // Film stays on the object where the last result left it until a newer one is whole.
  private glue(): void {
    const move = (matrix: readonly number[]): THREE.Matrix4 =>
      this.matrix.clone().multiply(new THREE.Matrix4().fromArray([...matrix]).invert());
    if (this.film) {
      this.filmGroup.matrixAutoUpdate = false;
      this.filmGroup.matrix.copy(this.model ? move(this.film.result.matrix) : new THREE.Matrix4());
      this.filmGroup.matrixWorldNeedsUpdate = true;
    }
  }

  // Whether the object still is where the result has it.
  private get fresh(): boolean {
    if (!this.film || !this.model) return false;
    const then = this.film.result.matrix;
    return this.matrix.elements.every((value, i) => Math.abs(value - then[i]!) < 1e-2);
  }

  private placeWaterLine(): void {
    const depth = this.depth();
    const { min, max } = this.bounds;
    const gap = Math.max(3, 0.06 * this.radius());
    this.waterLine.geometry.setFromPoints([
      new THREE.Vector3(min.x - gap, min.y - gap, depth),
      new THREE.Vector3(max.x + gap, min.y - gap, depth),
      new THREE.Vector3(max.x + gap, max.y + gap, depth),
      new THREE.Vector3(min.x - gap, max.y + gap, depth),
    ]);
  }

  depth(): number {
    const height = this.bounds.max.z;
    return this.pose?.depth_mm ? Math.min(this.pose.depth_mm, height) : height;
  }

  extent(): Vec3 {
    return this.bounds.isEmpty() ? [0, 0, 0] : (this.bounds.getSize(new THREE.Vector3()).toArray() as Vec3);
  }

  // From where to where the object reaches along a direction of the posed frame.
  reach([x, y, z]: Vec3): [number, number] {
    const { position } = this.posed;
    let [least, most] = [Infinity, -Infinity];
    for (let i = 0; i < position.length; i += 3) {
      const along = x * position[i]! + y * position[i + 1]! + z * position[i + 2]!;
      if (along < least) least = along;
      if (along > most) most = along;
    }
    return [least, most];
  }

  private center(): THREE.Vector3 {
    return this.bounds.isEmpty() ? new THREE.Vector3() : this.bounds.getCenter(new THREE.Vector3());
  }

  private radius(): number {
    return this.bounds.isEmpty() ? 50 : this.bounds.getSize(new THREE.Vector3()).length() / 2;
  }

  get hover_mm(): number {
    return Math.max(12, 0.35 * this.radius());
  }

  // How far the object travels in the bath, once that is known.
  travel(): number {
    return this.film && this.fresh ? this.film.travel_mm : this.depth();
  }

  setLevel(level: number): void {
    this.level = level;
    const fresh = this.fresh;
    const film = this.film;
    const moved = film?.moveTo(fresh ? level : -1);
    this.lowered.matrixAutoUpdate = false;
    const [x, y] = this.pose?.shift_mm ?? [0, 0];
    if (moved?.pose) this.lowered.matrix.fromArray(moved.pose);
    else this.lowered.matrix.makeTranslation(x, y, -level);
    this.lowered.matrixWorldNeedsUpdate = true;
    if (film) {
      film.afloat.matrixAutoUpdate = false;
      film.afloat.matrix.identity();
      if (moved?.inObjectFrame) film.afloat.matrix.copy(this.lowered.matrix);
      film.afloat.matrixWorldNeedsUpdate = true;
    }
    this.invalidate();
  }

  attachedArea(): number | null {
    return this.film?.attachedArea() ?? null;
  }

  get hasFrames(): boolean {
    return this.film?.hasFrames ?? false;
  }

  // --- Cameras ---

  setView(view: View): void {
    this.view = view;
    for (const [key, orbit] of Object.entries(this.eyes.orbits)) orbit.enabled = key === view;
    this.eyes.frame();
    this.setTool(this.tool);
    this.invalidate();
  }

  private home(view: View): { target: THREE.Vector3; radius: number } {
    if (view === 'object') return { target: new THREE.Vector3(), radius: this.radius() };
    const { width_mm, height_mm } = this.sheetShape;
    const height = this.bounds.isEmpty() ? 0 : this.bounds.max.z;
    return {
      target: new THREE.Vector3(0, 0, 0.25 * (height + this.hover_mm)),
      radius: Math.max(0.46 * Math.hypot(width_mm, height_mm), this.radius() * 1.15),
    };
  }

  // Both views, so that the one that is shown next is not where an earlier size left it.
  fit(): void {
    const other = this.view === 'bath' ? 'object' : 'bath';
    this.eyes.look(other, 'home', false);
    this.look('home');
  }

  look(from: LookFrom): void {
    this.eyes.look(this.view, from, true);
  }

  // Flies to a place of the posed object, seen from outside.
  showPlace(place: Vec3, marked = true): void {
    const outward = new THREE.Vector3(...place).sub(this.center());
    if (outward.lengthSq() < 1) outward.set(0, 0, -1);
    outward.normalize().add(new THREE.Vector3(-0.1, 0.1, -0.55)).normalize();
    if (this.view === 'bath') outward.z = Math.max(0.25, outward.z);
    const toward = this.view === 'object' ? new THREE.Vector3(...place).sub(this.center()).multiplyScalar(0.5) : this.home(this.view).target;
    this.eyes.approach(this.view, outward, toward);
    if (marked) this.mark(place);
  }

  // --- Tools ---

  setTool(tool: Tool): void {
    this.tool = tool;
    const gizmo = !this.readOnly && this.view === 'bath' && this.model !== null && (tool === 'turn' || tool === 'move');
    this.gizmo.show(gizmo ? tool : null);
    this.facet.visible = false;
    this.canvas.style.cursor = tool === 'face' ? 'crosshair' : '';
    this.invalidate();
  }

  private listen(): void {
    let down: { x: number; y: number } | null = null;
    const where = (event: PointerEvent): [number, number] => {
      const box = this.canvas.getBoundingClientRect();
      return [event.clientX - box.left, event.clientY - box.top];
    };
    this.canvas.addEventListener('pointerdown', (event) => {
      const [x, y] = where(event);
      down = { x, y };
    });
    this.canvas.addEventListener('pointerup', (event) => {
      const [x, y] = where(event);
      const still = down && Math.hypot(x - down.x, y - down.y) < 5;
      down = null;
      if (!still || this.gizmo.pointed || event.button !== 0) return;
      const hit = this.pick(x, y);
      if (this.tool === 'face') this.putDown(hit);
      else this.events.click(hit);
    });
    this.canvas.addEventListener('pointermove', (event) => {
      if (event.buttons) return;
      const hit = this.pick(...where(event));
      if (this.tool === 'face') this.showFacet(hit);
      else this.events.point(hit);
    });
    this.canvas.addEventListener('pointerleave', () => {
      this.events.point(null);
      this.facet.visible = false;
      this.invalidate();
    });
    this.canvas.addEventListener('webglcontextlost', (event) => {
      event.preventDefault();
      this.lost = true;
    });
    this.canvas.addEventListener('webglcontextrestored', () => {
      this.lost = false;
      this.invalidate();
    });
    window.addEventListener('keydown', (event) => this.gizmo.snap(event.shiftKey));
    window.addEventListener('keyup', (event) => this.gizmo.snap(event.shiftKey));
  }

  private showFacet(hit: Hit | null): void {
    this.facet.visible = Boolean(hit);
    if (hit) {
      const normal = new THREE.Vector3(...hit.normal);
      (this.view === 'bath' ? this.lowered : this.finished).add(this.facet);
      this.facet.scale.setScalar(this.radius() * 0.13);
      this.facet.position.set(...hit.place).addScaledVector(normal, 0.02 * this.radius());
      this.facet.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), normal);
    }
    this.invalidate();
  }

  private putDown(hit: Hit | null): void {
    if (!hit || !this.pose) return;
    this.facet.visible = false;
    const turned = turnedDown(this.turn, new THREE.Vector3(...hit.normal));
    this.events.pose({ rotate_deg: anglesOf(turned, this.pose.down) }, false);
  }

  // --- Pointing ---

  private group(): THREE.Group {
    return this.view === 'bath' ? this.lowered : this.finished;
  }

  // What lies under a point of the canvas (CSS pixels from its corner).
  pick(x: number, y: number): Hit | null {
    if (!this.painted) return null;
    const camera = this.eyes.fit(this.eyes.cameras[this.view], this.size);
    camera.updateMatrixWorld();
    this.root.updateMatrixWorld();
    const caster = new THREE.Raycaster();
    caster.setFromCamera(new THREE.Vector2((2 * x) / this.size.width - 1, 1 - (2 * y) / this.size.height), camera);
    const ray = (matrix: THREE.Matrix4): [number[], number[]] => {
      const inverse = matrix.clone().invert();
      return [
        caster.ray.origin.clone().applyMatrix4(inverse).toArray(),
        caster.ray.direction.clone().transformDirection(inverse).toArray(),
      ];
    };
    const { index } = this.painted.data;
    const object = castRay(this.posed.position, index, null, ...ray(this.group().matrixWorld));
    const place = object && this.pointOf(object.triangle, object.weights as [number, number, number]);
    let spot: FilmSpot | null = null;
    if (this.film && this.view === 'object' && this.compare !== 'wanted') {
      const { filmMesh, film } = this.film.result;
      const met = castRay(filmMesh.position, filmMesh.index, [...filmMesh.lying, ...filmMesh.tornList], ...ray(this.filmGroup.matrixWorld));
      if (met && (!object || met.t < object.t + 2 * film.cell_mm)) spot = met as unknown as FilmSpot;
    }
    return place ? { film: spot, ...place } : null;
  }

  private pointOf(triangle: number, weights: readonly number[]): { place: Vec3; normal: Vec3 } {
    const { position } = this.posed;
    const { index } = this.painted!.data;
    const [a, b, c] = [0, 1, 2].map((k) => new THREE.Vector3().fromArray(position, 3 * index[3 * triangle + k]!)) as [
      THREE.Vector3,
      THREE.Vector3,
      THREE.Vector3,
    ];
    const normal = b.clone().sub(a).cross(c.clone().sub(a)).normalize();
    const place = a.multiplyScalar(weights[0]!).addScaledVector(b, weights[1]!).addScaledVector(c, weights[2]!);
    return { place: place.toArray() as Vec3, normal: normal.toArray() as Vec3 };
  }

  // The surface that a ray of the posed frame meets first.
  meet(origin: Vec3, direction: Vec3): { place: Vec3; normal: Vec3 } | null {
    if (!this.painted) return null;
    const hit = castRay(this.posed.position, this.painted.data.index, null, origin, direction);
    return hit && this.pointOf(hit.triangle, hit.weights);
  }

  // A place of the posed frame on the canvas; `behind`: not in front of the camera.
  project(place: Vec3): { x: number; y: number; behind: boolean } {
    const camera = this.eyes.fit(this.eyes.cameras[this.view], this.size);
    camera.updateMatrixWorld();
    this.root.updateMatrixWorld();
    const p = new THREE.Vector3(...place).applyMatrix4(this.group().matrixWorld).project(camera);
    return { x: (0.5 + 0.5 * p.x) * this.size.width, y: (0.5 - 0.5 * p.y) * this.size.height, behind: p.z > 1 };
  }

  // The nearest point of the canvas that is so far from its edge; `right`: from that on the right.
  within({ x, y }: { x: number; y: number }, edge: number, right = edge): { x: number; y: number } {
    const { width, height } = this.size;
    return { x: Math.min(width - right, Math.max(edge, x)), y: Math.min(height - edge, Math.max(edge, y)) };
  }

  // Whether the object itself is in front of a place.
  hides(place: Vec3): boolean {
    if (!this.painted) return false;
    const eye = this.eyes.cameras[this.view].position.clone().applyMatrix4(this.group().matrixWorld.clone().invert());
    const toward = new THREE.Vector3(...place).sub(eye);
    const distance = toward.length();
    const hit = castRay(this.posed.position, this.painted.data.index, null, eye.toArray(), toward.divideScalar(distance).toArray());
    return hit !== null && hit.t < distance - 0.04 * this.radius();
  }

  // How many millimetres a pixel is at a place.
  pixel_mm(place: Vec3): number {
    const camera = this.eyes.fit(this.eyes.cameras[this.view], this.size);
    const p = new THREE.Vector3(...place).applyMatrix4(this.group().matrixWorld);
    return (2 * HALF * p.distanceTo(camera.position)) / (Math.max(1, this.size.height) * camera.zoom);
  }

  // Where on the canvas the water line can be taken hold of.
  waterLineEnd(): { x: number; y: number; behind: boolean } {
    const gap = Math.max(3, 0.06 * this.radius());
    const corners: Vec3[] = [];
    for (const x of [this.bounds.min.x - gap, this.bounds.max.x + gap])
      for (const y of [this.bounds.min.y - gap, this.bounds.max.y + gap]) corners.push([x, y, this.depth()]);
    return corners.map((corner) => this.project(corner)).reduce((a, b) => (b.x > a.x ? b : a));
  }

  toScaled(place: Vec3): Vec3 {
    const model = new THREE.Vector3(...place).applyMatrix4(this.matrix.clone().invert());
    return model.multiplyScalar(this.scale).toArray() as Vec3;
  }

  toPosed(scaled: Vec3): Vec3 {
    return new THREE.Vector3(...scaled).divideScalar(this.scale || 1).applyMatrix4(this.matrix).toArray() as Vec3;
  }

  directionToScaled(direction: Vec3): Vec3 {
    return new THREE.Vector3(...direction).applyQuaternion(this.turn.clone().invert()).toArray() as Vec3;
  }

  directionToPosed(direction: Vec3): Vec3 {
    return new THREE.Vector3(...direction).applyQuaternion(this.turn).toArray() as Vec3;
  }

  // How high the eye is, over the bath.
  get eye_mm(): number {
    return this.eyes.cameras.bath.position.z;
  }

  get center_mm(): Vec3 {
    return this.center().toArray() as Vec3;
  }

  mark(place: Vec3 | null): void {
    this.marker.visible = Boolean(place);
    if (place) {
      this.group().add(this.marker);
      this.marker.position.set(...place);
    }
    this.invalidate();
  }

  // --- Drawing ---

  resize(width: number, height: number): void {
    if (width < 1 || height < 1) return;
    const first = this.size.width === 1;
    this.size = { width, height };
    this.renderer.setSize(width, height, false);
    if (first && this.model) this.eyes.forget();
    this.eyes.frame();
    this.show(); // at once: what was drawn is gone
  }

  readonly invalidate = (): void => {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.show();
    });
  };

  private show(): void {
    if (this.lost) return;
    this.edges.show();
    this.events.drawn();
  }

  private updateUniforms(): void {
    this.scene.base = this.base;
    const set = (material: THREE.ShaderMaterial, base: number[]): void => {
      const u = material.uniforms;
      (u['base']!.value as THREE.Vector3).set(...(base as Vec3));
      (u['sheet']!.value as THREE.Vector2).set(this.scene.sheet.width_mm, this.scene.sheet.height_mm);
      u['depth']!.value = this.scene.depth_mm || Infinity;
    };
    for (const part of [this.painted, this.whole?.colors, this.whole?.parts])
      for (const material of part?.materials ?? []) set(material, this.base);
    if (!this.film) return;
    set(this.film.lying.material, this.base);
    set(this.film.torn.material, this.base);
    set(this.film.wrinkled.material, this.base);
    set(this.film.afloat.material, FILM_BASE);
  }

  private dressFor(what: 'bath' | 'wanted' | 'predicted'): void {
    const { film, scene, shared } = this;
    const inBath = what === 'bath';
    this.bath.visible = inBath;
    this.finished.visible = !inBath;
    const object = (look: object): void => {
      for (const material of this.painted?.materials ?? []) dress(material, look, scene, shared);
    };
    const part = (mesh: FilmPicture['lying'], look: object | null): void => {
      mesh.visible = Boolean(look);
      if (look) dress(mesh.material, look, scene, shared);
    };
    const picture = { mode: MODE.picture };
    if (inBath) {
      // In the water the object is bare: the film brings the colours.
      object(this.level > 0 ? { mode: MODE.bare } : picture);
      if (film) part(film.afloat, picture);
      return;
    }
    const predicted = what === 'predicted' && film !== null;
    if (this.showWhole(predicted)) return;
    const overlay = overlayOf(predicted ? this.overlay : 'none');
    if (!predicted) object(picture);
    else object(overlay.object(scene));
    if (film) {
      part(film.lying, predicted && overlay.film ? overlay.film(scene) : null);
      part(film.torn, predicted && overlay.torn ? overlay.torn(scene) : null);
      part(film.wrinkled, predicted && overlay.wrinkled ? overlay.wrinkled(scene) : null);
      for (const mesh of this.airMeshes) mesh.visible = predicted && overlay.key === 'air';
    }
  }

  // All dips together take the place of the object with this dip's film. Whether they do.
  private showWhole(predicted: boolean): boolean {
    const { whole, film } = this;
    let shown: Painted | null = null;
    if (predicted && whole && this.overlay === 'parts') shown = whole.parts;
    else if (predicted && whole && this.allDips && this.overlay === 'none') shown = whole.colors;
    for (const part of whole ? [whole.colors, whole.parts] : []) part.mesh.visible = part === shown;
    this.meshes.object.visible = Boolean(this.painted) && !shown;
    if (!shown) return false;
    for (const material of shown.materials) dress(material, { mode: MODE.picture }, this.scene, this.shared);
    for (const mesh of [film?.lying, film?.torn, film?.wrinkled, ...this.airMeshes]) if (mesh) mesh.visible = false;
    return true;
  }

  private pane(view: View, what: 'bath' | 'wanted' | 'predicted', at: { x: number; y: number; width: number; height: number }, from = 0, to = 1, camera = this.eyes.cameras[view]): void {
    const { renderer } = this;
    this.eyes.fit(camera, at);
    renderer.setViewport(at.x, at.y, at.width, at.height);
    const x = at.x + Math.round(from * at.width);
    renderer.setScissor(x, at.y, at.x + Math.round(to * at.width) - x, at.height);
    renderer.clear();
    this.dressFor(what);
    renderer.render(this.root, camera);
  }

  private render(): void {
    const { width, height } = this.size;
    this.renderer.setScissorTest(true);
    const whole = { x: 0, y: 0, width, height };
    this.panes(this.view, whole, this.divider);
    if (this.inset && this.painted) this.panes(this.view === 'bath' ? 'object' : 'bath', this.inset, 0);
  }

  private panes(view: View, at: { x: number; y: number; width: number; height: number }, divider: number): void {
    if (view === 'bath') return this.pane('bath', 'bath', at);
    if (!this.film || this.compare === 'wanted') return this.pane('object', 'wanted', at);
    const from = this.compare === 'predicted' ? 0 : divider;
    if (from > 0) this.pane('object', 'wanted', at, 0, from);
    if (from < 1) this.pane('object', 'predicted', at, from, 1);
  }

  // A small picture of the finished object, wherever the cameras are; null: there is nothing to be seen.
  thumbnail(width = 320, height = 240): Promise<Blob | null> | null {
    if (!this.painted || this.lost || this.size.width < width || this.size.height < height) return null;
    const canvas = document.createElement('canvas');
    [canvas.width, canvas.height] = [width, height];
    const ratio = this.renderer.getPixelRatio();
    const camera = this.eyes.portrait(this.radius());
    const held = this.overlay;
    this.overlay = 'none';
    this.renderer.setScissorTest(true);
    this.pane('object', this.film ? 'predicted' : 'wanted', { x: 0, y: 0, width, height }, 0, 1, camera);
    this.overlay = held;
    const context = canvas.getContext('2d')!;
    const source = this.renderer.domElement;
    context.drawImage(source, 0, source.height - height * ratio, width * ratio, height * ratio, 0, 0, width, height);
    this.invalidate();
    return new Promise((done) => canvas.toBlob(done, 'image/png'));
  }
}
