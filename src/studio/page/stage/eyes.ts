// From where the two views are looked at: a camera and a hand on it for each.
import * as THREE from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import type { Vec3 } from '../document.ts';

export type View = 'bath' | 'object';
export type LookFrom = 'home' | 'front' | 'left' | 'right' | 'back' | 'above' | 'below';

// What there is to look at.
export interface World {
  home(view: View): { target: THREE.Vector3; radius: number };
  size_mm(): number; // of the object, however it is turned; 0: there is none
  changed(): void;
}

const FIELD_OF_VIEW = 28;
export const HALF = Math.tan((FIELD_OF_VIEW * Math.PI) / 360);
const HALF_SINE = Math.sin((FIELD_OF_VIEW * Math.PI) / 360);
const STEEPEST = (86 / 180) * Math.PI; // from straight above: over the bath one stays over the film
const DIRECTIONS: Record<View, Partial<Record<LookFrom, Vec3>> & { home: Vec3 }> = {
  bath: {
    home: [0.5, -1, 0.52],
    front: [0, -1, 0.28],
    left: [-1, -0.1, 0.28],
    right: [1, -0.1, 0.28],
    back: [0, 1, 0.28],
    above: [0.001, -0.02, 1],
  },
  object: {
    home: [-0.35, 0.2, -1],
    front: [0, 0.02, -1],
    left: [1, 0.15, -0.25],
    right: [-1, 0.15, -0.25],
    back: [0.3, 0.2, 1],
    above: [0, 1, -0.05],
    below: [0, -1, -0.05],
  },
};
const RESIZED = 1.5; // by so much larger or smaller, an object is looked at anew

export class Eyes {
  readonly cameras: Record<View, THREE.PerspectiveCamera>;
  readonly orbits: Record<View, OrbitControls>;
  private flight = 0;
  // How large the object was (mm) when a camera was placed for it; 0: never.
  private framed: Record<View, number> = { bath: 0, object: 0 };

  constructor(
    canvas: HTMLCanvasElement,
    private readonly world: World,
  ) {
    const camera = (up: Vec3): THREE.PerspectiveCamera => {
      const result = new THREE.PerspectiveCamera(FIELD_OF_VIEW, 1, 1, 10000);
      result.up.set(...up);
      return result;
    };
    this.cameras = { bath: camera([0, 0, 1]), object: camera([0, 1, 0]) };
    this.orbits = { bath: new OrbitControls(this.cameras.bath, canvas), object: new OrbitControls(this.cameras.object, canvas) };
    this.orbits.bath.maxPolarAngle = STEEPEST;
    for (const view of ['bath', 'object'] as const) {
      const orbit = this.orbits[view];
      orbit.addEventListener('change', () => {
        this.keepInSight(view);
        world.changed();
      });
      orbit.addEventListener('start', () => this.stopFlight());
    }
  }

  // What comes is looked at anew, whatever its size.
  forget(): void {
    this.framed = { bath: 0, object: 0 };
  }

  // Places the cameras that were never placed, or for an object of quite another size; from where they look now.
  frame(): void {
    for (const view of ['bath', 'object'] as const) {
      const then = this.framed[view];
      const now = this.world.size_mm();
      if (!now) return; // there is nothing to be seen
      if (then && now < RESIZED * then && then < RESIZED * now) continue;
      const direction = then ? this.cameras[view].position.clone().sub(this.orbits[view].target) : new THREE.Vector3(...DIRECTIONS[view].home);
      this.lookAlong(view, direction, false);
    }
  }

  look(view: View, from: LookFrom, animated: boolean): void {
    const direction = DIRECTIONS[view][from];
    if (direction) this.lookAlong(view, new THREE.Vector3(...direction), animated);
  }

  private lookAlong(view: View, direction: THREE.Vector3, animated: boolean): void {
    const { target, radius } = this.world.home(view);
    const distance = (1.02 * radius) / HALF_SINE;
    const place = direction.normalize().multiplyScalar(distance).add(target);
    const camera = this.cameras[view];
    camera.near = distance / 60;
    camera.far = distance * 20;
    this.orbits[view].minDistance = 0.1 * distance;
    this.orbits[view].maxDistance = 5 * distance;
    this.framed[view] = this.world.size_mm();
    this.fly(view, place, target, animated);
  }

  // Flies to where that is seen from outside, nearer than from home.
  approach(view: View, outward: THREE.Vector3, target: THREE.Vector3): void {
    const distance = (0.75 * this.world.home(view).radius) / HALF_SINE;
    this.fly(view, outward.multiplyScalar(distance).add(target), target, true);
  }

  private fly(view: View, place: THREE.Vector3, target: THREE.Vector3, animated: boolean): void {
    this.stopFlight();
    const camera = this.cameras[view];
    const orbit = this.orbits[view];
    const end = (): void => {
      camera.position.copy(place);
      orbit.target.copy(target);
      orbit.update();
      this.world.changed();
    };
    if (!animated || matchMedia('(prefers-reduced-motion: reduce)').matches) return end();
    const from = { offset: camera.position.clone().sub(orbit.target), target: orbit.target.clone() };
    const to = place.clone().sub(target);
    const began = performance.now();
    const turnTo = new THREE.Quaternion().setFromUnitVectors(from.offset.clone().normalize(), to.clone().normalize());
    const step = (now: number): void => {
      const t = Math.min(1, Math.max(0, (now - began) / 350));
      const eased = t * t * (3 - 2 * t);
      if (t >= 1) return end();
      const turned = from.offset.clone().applyQuaternion(new THREE.Quaternion().slerp(turnTo, eased));
      turned.setLength(THREE.MathUtils.lerp(from.offset.length(), to.length(), eased));
      orbit.target.lerpVectors(from.target, target, eased);
      camera.position.copy(orbit.target).add(turned);
      camera.lookAt(orbit.target);
      this.world.changed();
      this.flight = requestAnimationFrame(step);
    };
    this.flight = requestAnimationFrame(step);
  }

  private stopFlight(): void {
    cancelAnimationFrame(this.flight);
  }

  // Whoever shifts the view with two fingers comes neither under the film nor away from all there is.
  private keepInSight(view: View): void {
    const { target } = this.orbits[view];
    const { target: middle, radius } = this.world.home(view);
    const kept = target.clone().sub(middle).clampLength(0, radius).add(middle);
    if (view === 'bath') kept.z = Math.max(0, kept.z);
    this.cameras[view].position.add(kept).sub(target);
    target.copy(kept);
  }

  // As much is seen across as along, whichever of the two there is less room for.
  fit(camera: THREE.PerspectiveCamera, { width, height }: { width: number; height: number }): THREE.PerspectiveCamera {
    camera.aspect = width / Math.max(1, height);
    camera.zoom = Math.min(1, camera.aspect);
    camera.updateProjectionMatrix();
    return camera;
  }

  // A camera of its own that sees a ball about the object's middle whole.
  portrait(radius: number): THREE.PerspectiveCamera {
    const camera = this.cameras.object.clone();
    const away = new THREE.Vector3(...DIRECTIONS.object.home).setLength((1.02 * radius) / HALF_SINE);
    camera.position.copy(away);
    camera.near = away.length() / 60;
    camera.far = away.length() * 20;
    camera.lookAt(0, 0, 0);
    return camera;
  }
}
