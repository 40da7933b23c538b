// What holds the water, and the film's taped rim on it.
import * as THREE from 'three';

export interface SheetShape {
  width_mm: number;
  height_mm: number;
  margin_mm: number;
  disc: boolean;
}

export interface BathShape {
  width_mm: number;
  height_mm: number;
  depth_mm: number;
}

// Fills the group anew.
export function makeBasin(basin: THREE.Group, sheet: SheetShape, bath: BathShape): void {
  basin.traverse((child) => {
    const { geometry, material } = child as THREE.Mesh;
    geometry?.dispose();
    (material as THREE.Material | undefined)?.dispose();
  });
  basin.clear();
  // Bath and sheet may lie either way round.
  const along = sheet.width_mm > sheet.height_mm === bath.width_mm > bath.height_mm;
  const width = Math.max(along ? bath.width_mm : bath.height_mm, sheet.width_mm);
  const height = Math.max(along ? bath.height_mm : bath.width_mm, sheet.height_mm);
  const water = new THREE.Mesh(
    new THREE.PlaneGeometry(width, height),
    new THREE.MeshBasicMaterial({ color: 0x7fa6b8, transparent: true, opacity: 0.22, side: THREE.DoubleSide, depthWrite: false }),
  );
  water.position.z = -1.2;
  water.renderOrder = 2;
  const box = new THREE.BoxGeometry(width, height, bath.depth_mm);
  const walls = new THREE.LineSegments(new THREE.EdgesGeometry(box), new THREE.LineBasicMaterial({ color: 0x8a9299, transparent: true, opacity: 0.5 }));
  walls.position.z = -1.2 - bath.depth_mm / 2;
  box.dispose();
  const rim = new THREE.Mesh(rimShape(sheet), new THREE.MeshBasicMaterial({ color: 0xd9c7a0, side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: -1 }));
  rim.position.z = 0.7; // over the film's edge, which is drawn a little nearer than it is
  basin.add(water, walls, rim);
}

// The taped rim, at true size.
function rimShape({ width_mm, height_mm, margin_mm, disc }: SheetShape): THREE.ShapeGeometry {
  const outer = new THREE.Shape();
  const inner = new THREE.Path();
  const [w, h] = [width_mm / 2, height_mm / 2];
  outer.moveTo(-w, -h).lineTo(w, -h).lineTo(w, h).lineTo(-w, h).closePath();
  if (disc) inner.absarc(0, 0, Math.max(1, Math.min(w, h) - margin_mm), 0, 2 * Math.PI, true);
  else {
    const [x, y] = [Math.max(1, w - margin_mm), Math.max(1, h - margin_mm)];
    inner.moveTo(-x, -y).lineTo(-x, y).lineTo(x, y).lineTo(x, -y).closePath();
  }
  outer.holes.push(inner);
  return new THREE.ShapeGeometry(outer, 48);
}
