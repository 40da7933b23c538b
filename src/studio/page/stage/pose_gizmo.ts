// The rings and arrows by which the object is turned and moved over the bath.
import * as THREE from 'three';
import { TransformControls } from 'three/examples/jsm/controls/TransformControls.js';
import type { Pose } from '../document.ts';
import { anglesOf } from './pose.ts';

export interface Held {
  turn: THREE.Quaternion;
  pose: Pose;
}

// What is taken hold of, and who has to know.
export interface Holder {
  held(): Held | null; // as it is now
  center(): THREE.Vector3;
  height_mm(): number;
  moved(change: Partial<Pose>, live: boolean): void;
  holds(on: boolean): void; // the hand has it, or has let go
  changed(): void;
}

export class PoseGizmo {
  private readonly controls: TransformControls;
  private readonly proxy = new THREE.Object3D();
  private from = new THREE.Vector3();
  private start: Held | null = null;
  private tool: 'turn' | 'move' = 'turn';

  // Goes with what is in `lowered`; is drawn in `bath`.
  constructor(
    camera: THREE.Camera,
    canvas: HTMLCanvasElement,
    lowered: THREE.Group,
    bath: THREE.Group,
    private readonly holder: Holder,
  ) {
    const controls = new TransformControls(camera, canvas);
    this.controls = controls;
    controls.setSpace('world');
    controls.setSize(matchMedia('(pointer: coarse)').matches ? 1.15 : 0.85);
    controls.setColors('#cc5a52', '#4f9d5d', '#4a7fc0', '#1f9aa6');
    controls.attach(this.proxy);
    lowered.add(this.proxy);
    const helper = controls.getHelper();
    helper.visible = false;
    bath.add(helper);
    controls.addEventListener('change', () => holder.changed());
    controls.addEventListener('dragging-changed', ({ value }) => {
      holder.holds(Boolean(value));
      if (value) this.start = holder.held();
      else this.end();
    });
    controls.addEventListener('objectChange', () => this.follow(true));
  }

  // Null: it is not there.
  show(tool: 'turn' | 'move' | null): void {
    this.controls.enabled = tool !== null;
    this.controls.getHelper().visible = tool !== null;
    if (!tool) return;
    this.tool = tool;
    this.controls.setMode(tool === 'turn' ? 'rotate' : 'translate');
  }

  // Whether the pointer is on it.
  get pointed(): boolean {
    return this.controls.axis !== null;
  }

  snap(on: boolean): void {
    this.controls.setRotationSnap(on ? Math.PI / 12 : null);
    this.controls.setTranslationSnap(on ? 5 : null);
  }

  // Where the object is now, unless the hand has it.
  place(): void {
    if (this.start) return;
    this.proxy.position.copy(this.holder.center());
    this.proxy.quaternion.identity();
    this.from = this.proxy.position.clone();
  }

  private follow(live: boolean): void {
    if (!this.start) return;
    const { turn, pose } = this.start;
    if (this.tool === 'turn') {
      const turned = this.proxy.quaternion.clone().multiply(turn);
      this.holder.moved({ rotate_deg: anglesOf(turned, pose.down) }, live);
    } else {
      const moved = this.proxy.position.clone().sub(this.from);
      const tenth = (value: number): number => Math.round(value * 10) / 10 + 0;
      const change: Partial<Pose> = {};
      if (moved.x || moved.y) change.shift_mm = [tenth(pose.shift_mm[0] + moved.x), tenth(pose.shift_mm[1] + moved.y)];
      if (Math.abs(moved.z) > 0.04) {
        const height = this.holder.height_mm();
        const depth = Math.min(height, Math.max(0.5, (pose.depth_mm || height) - moved.z));
        change.depth_mm = depth > height - 0.05 ? 0 : tenth(depth);
      }
      this.holder.moved(change, live);
    }
  }

  private end(): void {
    if (!this.start) return;
    this.follow(false);
    this.start = null;
    this.place();
    this.holder.changed();
  }
}
