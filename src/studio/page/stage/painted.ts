// A model in colours, as it is drawn: its triangles with a material for each of its own.
import * as THREE from 'three';
import { sharedTextures, surfaceMaterial } from '../../../report/viewer/surface.js';
import type { MeshData } from '../api.ts';
import type { Scene } from './overlays.ts';

export type Shared = ReturnType<typeof sharedTextures>;

const WRAPS: Record<string, THREE.Wrapping> = {
  repeat: THREE.RepeatWrapping,
  mirror: THREE.MirroredRepeatWrapping,
  clamp: THREE.ClampToEdgeWrapping,
  decal: THREE.ClampToEdgeWrapping,
};

export interface Painted {
  mesh: THREE.Mesh; // shown beside others where the model itself is not
  geometry: THREE.BufferGeometry;
  materials: THREE.ShaderMaterial[];
  data: MeshData;
}

export function makePainted(data: MeshData, textures: readonly THREE.Texture[], scene: Scene, shared: Shared): Painted {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(data.position.length), 3));
  geometry.setAttribute('normal', new THREE.BufferAttribute(new Float32Array(data.position.length), 3));
  if (data.uv) geometry.setAttribute('uv', new THREE.BufferAttribute(data.uv, 2));
  if (data.color) geometry.setAttribute('tint', new THREE.BufferAttribute(data.color, 4));
  geometry.setIndex(new THREE.BufferAttribute(data.index, 1));
  for (const group of data.groups) geometry.addGroup(group.start, group.count, group.material);
  const maps = new Map<string, THREE.Texture>();
  const materials = data.materials.map((m) => {
    const key = `${m.texture} ${m.wrap}`;
    const picture = textures[m.texture];
    if (picture && !maps.has(key)) {
      const texture = picture.clone();
      texture.wrapS = WRAPS[m.wrap[0]] ?? THREE.RepeatWrapping;
      texture.wrapT = WRAPS[m.wrap[1]] ?? THREE.RepeatWrapping;
      texture.needsUpdate = true;
      maps.set(key, texture);
    }
    return surfaceMaterial(scene, shared, { ...m, map: maps.get(key), tinted: Boolean(data.color) });
  });
  if (!data.groups.length) geometry.addGroup(0, data.index.length, 0);
  if (!materials.length) materials.push(surfaceMaterial(scene, shared, { tinted: Boolean(data.color) }));
  const mesh = new THREE.Mesh(geometry, materials);
  mesh.frustumCulled = false;
  return { mesh, geometry, materials, data };
}

export function discard({ geometry, materials }: Painted): void {
  geometry.dispose();
  for (const material of materials) {
    const map = material.uniforms['map']?.value as THREE.Texture | null;
    if (material.uniforms['textured']?.value) map?.dispose();
    material.dispose();
  }
}
