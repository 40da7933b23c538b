// The film as three.js wants it: on the object, torn, and afloat.
import * as THREE from 'three';
import type { DipFrames, Film, Result } from '../api.ts';
import { FilmShape } from '../../../report/viewer/film_shape.js';

// Unit normals of a mesh's vertices, over some of its triangles.
export function vertexNormals(position: Float32Array, index: Uint32Array, triangles: readonly number[] | null, sign: number, normal: Float32Array): void {
  normal.fill(0);
  const count = triangles ? triangles.length : index.length / 3;
  for (let i = 0; i < count; ++i) {
    const t = 3 * (triangles ? triangles[i]! : i);
    const a = 3 * index[t]!, b = 3 * index[t + 1]!, c = 3 * index[t + 2]!;
    const ux = position[b]! - position[a]!, uy = position[b + 1]! - position[a + 1]!, uz = position[b + 2]! - position[a + 2]!;
    const vx = position[c]! - position[a]!, vy = position[c + 1]! - position[a + 1]!, vz = position[c + 2]! - position[a + 2]!;
    const x = sign * (uy * vz - uz * vy), y = sign * (uz * vx - ux * vz), z = sign * (ux * vy - uy * vx);
    for (const corner of [a, b, c]) {
      normal[corner]! += x;
      normal[corner + 1]! += y;
      normal[corner + 2]! += z;
    }
  }
  for (let i = 0; i < normal.length; i += 3) {
    const length = Math.hypot(normal[i]!, normal[i + 1]!, normal[i + 2]!) || 1;
    normal[i]! /= length;
    normal[i + 1]! /= length;
    normal[i + 2]! /= length;
  }
}

// An image of the sheet, first row at +y.
export function sheetTexture(pixels: Uint8Array, width: number, height: number): THREE.DataTexture {
  const texture = new THREE.DataTexture(pixels, width, height, THREE.RGBAFormat);
  texture.colorSpace = THREE.SRGBColorSpace;
  texture.minFilter = THREE.LinearMipmapLinearFilter;
  texture.magFilter = THREE.LinearFilter;
  texture.generateMipmaps = true;
  texture.anisotropy = 4;
  texture.needsUpdate = true;
  return texture;
}

function filmUv({ filmMesh, film }: Result): THREE.BufferAttribute {
  const { u } = filmMesh;
  const uv = new Float32Array(u.length);
  for (let i = 0; i < uv.length; i += 2) {
    uv[i] = u[i]! / film.width_mm + 0.5;
    uv[i + 1] = 0.5 - u[i + 1]! / film.height_mm;
  }
  return new THREE.BufferAttribute(uv, 2);
}

function geometryOf(position: Float32Array, uv: THREE.BufferAttribute, stretch: Float32Array, index: Uint32Array): THREE.BufferGeometry {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(position, 3));
  geometry.setAttribute('normal', new THREE.BufferAttribute(new Float32Array(position.length), 3));
  geometry.setAttribute('uv', uv);
  geometry.setAttribute('amount', new THREE.BufferAttribute(stretch, 1));
  geometry.setIndex(new THREE.BufferAttribute(index, 1));
  return geometry;
}

function turnedOver(index: Uint32Array, triangles: readonly number[]): Uint32Array {
  const list = new Uint32Array(3 * triangles.length);
  triangles.forEach((t, i) => list.set([index[3 * t]!, index[3 * t + 2]!, index[3 * t + 1]!], 3 * i));
  return list;
}

function mesh(geometry: THREE.BufferGeometry, material: THREE.Material): THREE.Mesh<THREE.BufferGeometry, THREE.ShaderMaterial> {
  const result = new THREE.Mesh(geometry, material as THREE.ShaderMaterial);
  result.frustumCulled = false;
  return result;
}

export type MakeMaterial = (options: { map: THREE.Texture; lift: number; side?: THREE.Side }) => THREE.ShaderMaterial;

// Everything of one result that is drawn.
export class FilmPicture {
  readonly lying;
  readonly torn;
  readonly wrinkled;
  readonly afloat;
  readonly printed: THREE.DataTexture;
  readonly predicted: THREE.DataTexture;
  private readonly flat: Float32Array;
  private shape: FilmShape | null = null;

  constructor(readonly result: Result, make: MakeMaterial) {
    const { filmMesh: film, sheet } = result;
    this.printed = sheetTexture(result.printed, sheet.width_px, sheet.height_px);
    this.predicted = sheetTexture(result.predicted, sheet.width_px, sheet.height_px);
    const uv = filmUv(result);
    const part = (triangles: readonly number[], lift = result.film.cell_mm) => {
      const geometry = geometryOf(film.position, uv, film.stretch, turnedOver(film.index, triangles));
      vertexNormals(film.position, film.index, triangles, -1, geometry.getAttribute('normal').array as Float32Array);
      // Between its vertices the film lies a little inside the object.
      return mesh(geometry, make({ map: this.predicted, lift, side: THREE.FrontSide }));
    };
    this.lying = part(film.lying);
    this.torn = part(film.tornList);
    this.wrinkled = part(film.wrinkledList, 1.3 * result.film.cell_mm);
    this.flat = new Float32Array(film.position.length);
    for (let i = 0; i < film.u.length / 2; ++i) this.flat.set([film.u[2 * i]!, film.u[2 * i + 1]!, 0], 3 * i);
    this.afloat = mesh(
      geometryOf(this.flat.slice(), uv, film.stretch, film.index),
      make({ map: this.printed, lift: 0.5 }),
    );
    this.moveTo(-1);
  }

  setFrames({ levels, poses, frames, attachedFrom }: DipFrames): void {
    const { position, index, u } = this.result.filmMesh;
    this.shape = new FilmShape({ levels, poses, frames, attachedFrom, position, index, u });
  }

  get hasFrames(): boolean {
    return this.shape !== null;
  }

  get travel_mm(): number {
    const levels = this.shape?.film.levels as number[] | undefined;
    return levels?.length ? levels.at(-1)! : this.result.depth_mm;
  }

  // The film with the object so deep; in the object's frame once it floats with it. Before: flat.
  moveTo(level: number): { pose: number[] | null; inObjectFrame: boolean } {
    const geometry = this.afloat.geometry;
    const position = geometry.getAttribute('position').array as Float32Array;
    let pose: number[] | null = null;
    let inObjectFrame = false;
    if (level < 0 || !this.shape) {
      position.set(this.flat);
      if (level >= this.result.depth_mm) {
        position.set(this.result.filmMesh.position);
        inObjectFrame = true;
      }
    } else {
      this.shape.moveTo(level);
      position.set(this.shape.position);
      pose = this.shape.pose();
      inObjectFrame = true;
    }
    const normal = geometry.getAttribute('normal').array as Float32Array;
    vertexNormals(position, this.result.filmMesh.index, null, 1, normal);
    geometry.getAttribute('position').needsUpdate = true;
    geometry.getAttribute('normal').needsUpdate = true;
    return { pose, inObjectFrame };
  }

  attachedArea(): number | null {
    return this.shape ? this.shape.attachedArea() : null;
  }

  dispose(): void {
    for (const { geometry, material } of [this.lying, this.torn, this.wrinkled, this.afloat]) {
      geometry.dispose();
      material.dispose();
    }
    this.printed.dispose();
    this.predicted.dispose();
  }
}

export function surfaceOf(surface: { position: Float32Array; index: Uint32Array }, material: THREE.Material): THREE.Mesh {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(surface.position, 3));
  geometry.setIndex(new THREE.BufferAttribute(surface.index, 1));
  const result = new THREE.Mesh(geometry, material);
  result.frustumCulled = false;
  return result;
}

export type { Film };
