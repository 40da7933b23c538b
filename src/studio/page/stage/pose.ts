// How the model hangs over the water: the same turn that the program makes of `down` and `rotate_deg`.
import { Euler, MathUtils, Matrix4, Quaternion, Vector3 } from 'three';
import type { Pose, Side, Vec3 } from '../document.ts';

const RIGHT = Math.PI / 2;
const DOWNWARDS: Record<Side, [axis: Vec3, angle: number]> = {
  '-z': [[1, 0, 0], 0],
  '+z': [[1, 0, 0], Math.PI],
  '-x': [[0, 1, 0], -RIGHT],
  '+x': [[0, 1, 0], RIGHT],
  '-y': [[1, 0, 0], RIGHT],
  '+y': [[1, 0, 0], -RIGHT],
};

const downwards = (down: Side): Quaternion => {
  const [axis, angle] = DOWNWARDS[down];
  return new Quaternion().setFromAxisAngle(new Vector3(...axis), angle);
};

export function turnOf({ down, rotate_deg }: Pick<Pose, 'down' | 'rotate_deg'>): Quaternion {
  const [x, y, z] = rotate_deg.map(MathUtils.degToRad) as Vec3;
  return new Quaternion().setFromEuler(new Euler(x, y, z, 'ZYX')).multiply(downwards(down));
}

const tidy = (degrees: number): number => {
  const rounded = Math.round(degrees * 10) / 10;
  return rounded === -180 ? 180 : rounded + 0;
};

// The angles that give this turn, to a tenth of a degree.
export function anglesOf(turn: Quaternion, down: Side): Vec3 {
  const rest = turn.clone().multiply(downwards(down).invert());
  const euler = new Euler().setFromQuaternion(rest, 'ZYX');
  return [euler.x, euler.y, euler.z].map((angle) => tidy(MathUtils.radToDeg(angle))) as Vec3;
}

// The angles of what leans over besides, its top towards a direction from +x to +y.
export function leant(pose: Pick<Pose, 'down' | 'rotate_deg'>, tilt_deg: number, toward_deg: number): Vec3 {
  const toward = MathUtils.degToRad(toward_deg);
  const axis = new Vector3(-Math.sin(toward), Math.cos(toward), 0);
  const lean = new Quaternion().setFromAxisAngle(axis, MathUtils.degToRad(tilt_deg));
  return anglesOf(lean.multiply(turnOf(pose)), pose.down);
}

// The smallest turn more that brings a direction of the posed frame down.
export function turnedDown(turn: Quaternion, direction: Vector3): Quaternion {
  const more = new Quaternion().setFromUnitVectors(direction.clone().normalize(), new Vector3(0, 0, -1));
  return more.multiply(turn);
}

export function heightOf(position: Float32Array, turn: Quaternion, scale: number): number {
  const up = new Vector3(0, 0, scale).applyQuaternion(turn.clone().invert());
  let [low, high] = [Infinity, -Infinity];
  for (let i = 0; i < position.length; i += 3) {
    const z = up.x * position[i]! + up.y * position[i + 1]! + up.z * position[i + 2]!;
    if (z < low) low = z;
    if (z > high) high = z;
  }
  return position.length ? high - low : 0;
}

// Model frame to posed frame: scaled, turned, its box centred over the film and standing on z = 0.
export function placeOf(position: Float32Array, turn: Quaternion, scale: number): Matrix4 {
  const linear = new Matrix4().compose(new Vector3(), turn, new Vector3(scale, scale, scale));
  const e = linear.elements;
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < position.length; i += 3) {
    const x = position[i]!, y = position[i + 1]!, z = position[i + 2]!;
    for (let k = 0; k < 3; ++k) {
      const value = e[k]! * x + e[4 + k]! * y + e[8 + k]! * z;
      if (value < low[k]!) low[k] = value;
      if (value > high[k]!) high[k] = value;
    }
  }
  if (!position.length) return linear;
  return linear.setPosition(-(low[0]! + high[0]!) / 2, -(low[1]! + high[1]!) / 2, -low[2]!);
}
