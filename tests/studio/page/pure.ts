// What the page computes by itself: edits of the document, merge patches, and the pose. No browser.
import assert from 'node:assert/strict';
import { Matrix4, Quaternion, Vector3 } from 'three';
import {
  dipCount, equal, laidAnew, merged, patched, poseOf, withAnotherDip, withLayer, withLayerMoved, withNewLayer, withoutDip, withoutLayer, withoutWayOf,
  withPose, withTiltTurned, withValue, type JobDocument, type Json, type Pose, type Side, type Vec3,
} from '../../../src/studio/page/document.ts';
import { freePart } from '../../../src/studio/page/free.ts';
import { anglesOf, placeOf, turnedDown, turnOf } from '../../../src/studio/page/stage/pose.ts';

let seed = 7;
const random = (): number => {
  seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0;
  return seed / 4294967296;
};
const angle = (): number => Math.round(3600 * (random() - 0.5)) / 10;
const SIDES: Side[] = ['-z', '+z', '-y', '+y', '-x', '+x'];
const AXES: Record<string, Vec3> = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] };
const outward = (side: Side): Vector3 => new Vector3(...AXES[side[1]!]!).multiplyScalar(side[0] === '-' ? -1 : 1);
const close = (a: Vector3, b: Vector3, what: string, within = 1e-6): void =>
  assert.ok(a.distanceTo(b) < within, `${what}: ${a.toArray()} is not ${b.toArray()}`);

// As the program asks of each dip: a path, or else a depth and perhaps a tilt.
const saysOneWay = ({ dip = {}, path, dips = [] }: JobDocument): boolean => {
  const says = ['depth_mm', 'tilt_deg', 'roll_deg'].some((key) => dip[key]);
  return !(path && (says || dips.some((own) => own.depth_mm !== undefined))) && !dips.some((own) => own.path && (says || own.depth_mm !== undefined));
};

const tests: Record<string, () => void> = {
  'a shifted way never says more than a job may'() {
    const pose: Pose = { down: '-z', rotate_deg: [0, 0, 0], depth_mm: 0, shift_mm: [7000, -9000] };
    assert.deepEqual(withPose({}, 0, pose, 8600).path, [[0, 5000, -5000, 0, 0, 0], [5000, 5000, -5000, 0, 0, 0]]);
    assert.deepEqual(withPose({}, 0, { ...pose, shift_mm: [7, 0] }, 86).path, [[0, 7, 0, 0, 0, 0], [86, 7, 0, 0, 0, 0]]);
  },
  'artwork laid on in another way keeps its place, and never takes a push for an axis'() {
    const aimed = { image: 'a.png', at_mm: [1, 2, 3] as Vec3, toward: [1, 0, 0] as Vec3, up: [0, 0, 1] as Vec3 };
    for (const round of ['cylinder', 'sphere'] as const) {
      const laid = { ...aimed, ...laidAnew(aimed, round) };
      assert.deepEqual([laid.projection, laid.at_mm, laid.toward, laid.up], [round, aimed.at_mm, undefined, undefined]);
      assert.equal({ ...laid, ...laidAnew({ ...laid, toward: [0, 0, 1] }, 'planar') }.toward, undefined);
    }
    const wrapped = { ...aimed, ...laidAnew(aimed, 'wrap') };
    assert.deepEqual([wrapped.at_mm, wrapped.toward, wrapped.up], [aimed.at_mm, aimed.toward, aimed.up]);
    assert.equal({ ...aimed, ...laidAnew(aimed, 'film') }.at_mm, undefined);
  },
  'merge patches do as RFC 7386 says, appendix A'() {
    const cases: [Json, Json, Json][] = [
      [{ a: 'b' }, { a: 'c' }, { a: 'c' }],
      [{ a: 'b' }, { b: 'c' }, { a: 'b', b: 'c' }],
      [{ a: 'b' }, { a: null }, {}],
      [{ a: 'b', b: 'c' }, { a: null }, { b: 'c' }],
      [{ a: ['b'] }, { a: 'c' }, { a: 'c' }],
      [{ a: 'c' }, { a: ['b'] }, { a: ['b'] }],
      [{ a: { b: 'c' } }, { a: { b: 'd', c: null } }, { a: { b: 'd' } }],
      [{ a: [{ b: 'c' }] }, { a: [1] }, { a: [1] }],
      [['a', 'b'], ['c', 'd'], ['c', 'd']],
      [{ a: 'b' }, ['c'], ['c']],
      [{ a: 'foo' }, null, null],
      [{ a: 'foo' }, 'bar', 'bar'],
      [{ e: null }, { a: 1 }, { e: null, a: 1 }],
      [[1, 2], { a: 'b', c: null }, { a: 'b' }],
      [{}, { a: { bb: { ccc: null } } }, { a: { bb: {} } }],
    ];
    for (const [target, patch, result] of cases) assert.deepEqual(merged(target, patch), result);
  },

  'a value set to its default leaves no trace'() {
    const defaults = new Map<string, Json>([['film.width_mm', 210], ['dip.pivot_mm', [0, 0, 0]]]);
    const first: JobDocument = { object: { file: 'a.stl' } };
    const wide = withValue(first, defaults, 'film.width_mm', 297);
    assert.deepEqual(wide.film, { width_mm: 297 });
    assert.ok(equal(withValue(wide, defaults, 'film.width_mm', 210), first));
    assert.ok(equal(withValue(first, defaults, 'dip.pivot_mm', [0, 0, 0]), first));
  },

  'no edit changes the document that it was made from'() {
    const freeze = <T>(value: T): T => {
      if (value && typeof value === 'object') Object.values(Object.freeze(value)).forEach(freeze);
      return value;
    };
    const from = freeze<JobDocument>({ object: { file: 'a.stl' }, artwork: [{ image: 'a.png' }, { text: 'b' }], dips: [{}, { down: '+z' }] });
    withPose(from, 1, { down: '+x', rotate_deg: [1, 2, 3], depth_mm: 4, shift_mm: [5, 6] }, 40);
    withLayer(from, 0, { turn_deg: 3 });
    withLayerMoved(from, 0, 1);
    withNewLayer(from, { text: 'c' });
    withoutLayer(from, 1);
    withoutDip(from, 0);
    patched(from, { film: { width_mm: 1 }, artwork: null });
  },

  'a pose written is the pose read, in one dip and in several'() {
    const pose: Pose = { down: '-x', rotate_deg: [10, -20, 30.5], depth_mm: 16, shift_mm: [0, 0] };
    for (const document of [{ object: { file: 'a.stl' } }, { dips: [{ down: '+z' as Side }, {}] }]) {
      for (const shift_mm of [[0, 0], [12, -7.5]] as [number, number][]) {
        assert.deepEqual(poseOf(withPose(document, 0, { ...pose, shift_mm }, 50), 0), { ...pose, shift_mm });
      }
    }
    const plain: Pose = { down: '-z', rotate_deg: [0, 0, 0], depth_mm: 0, shift_mm: [0, 0] };
    const start: JobDocument = { object: { file: 'a.stl' } };
    assert.ok(equal(withPose(withPose(start, 0, pose, 50), 0, plain, 50), start));
  },

  'a way of more than a shift is left as it is'() {
    const path = [[0, 0, 0, 0, 0, 0], [20, 6, 0, 0, 10, 0]];
    const turned = withPose({ path }, 0, { down: '-z', rotate_deg: [0, 0, 9], depth_mm: 0, shift_mm: [0, 0] }, 50);
    assert.deepEqual(turned.path, path);
  },

  'beside a path nothing else is said of the way in, whatever is done in whatever order'() {
    for (let i = 0; i < 200; ++i) {
      let document: JobDocument = { object: { file: 'a.stl' }, dip: { tilt_deg: angle() % 85, tilt_toward_deg: angle(), roll_deg: i % 3 } };
      if (i % 4 === 1) document = { object: { file: 'a.stl' }, path: [[0, 0, 0, 0, 0, 0], [20, 6, 0, 0, 10, 0]] };
      if (i % 4 === 2) document = { dip: { depth_mm: 9 }, dips: [{ down: '-z' }] };
      for (let step = 0; step < 8; ++step) {
        const dip = Math.floor(random() * dipCount(document));
        const [deep, aside] = [Math.floor(random() * 3), Math.floor(random() * 3)];
        document = [
          () => withAnotherDip(document),
          () => withoutDip(document, dip),
          () => withoutWayOf(document, dip),
          () => withPose(document, dip, { ...poseOf(document, dip), depth_mm: 10 * deep }, 30),
          () => withPose(document, dip, { ...poseOf(document, dip), shift_mm: [5 * aside, 0] }, 30),
        ][Math.floor(random() * 5)]!();
        assert.ok(saysOneWay(document), JSON.stringify(document));
      }
    }
  },

  'a tilt turned is the pose that it leant to, of one dip and of several'() {
    for (let i = 0; i < 50; ++i) {
      const [tilt_deg, tilt_toward_deg] = [60 * random(), 360 * random()];
      const pose = { down: SIDES[i % 6]!, rotate_deg: [angle(), angle(), angle()] as Vec3 };
      const toward = (tilt_toward_deg * Math.PI) / 180;
      const leaning = new Quaternion().setFromAxisAngle(new Vector3(-Math.sin(toward), Math.cos(toward), 0), (tilt_deg * Math.PI) / 180).multiply(turnOf(pose));
      const dip = { tilt_deg, tilt_toward_deg };
      for (const document of [{ object: { file: 'a.stl', ...pose }, dip }, { dips: [pose, pose], dip }]) {
        const turned = withTiltTurned(document);
        assert.equal(turned.dip, undefined);
        assert.ok(turnOf(poseOf(turned, 0)).angleTo(leaning) < 0.006, String(i));
        assert.equal(poseOf(turned, 0).down, pose.down);
      }
    }
  },

  'the only dip takes its shift, depth and correction along into several, and out again'() {
    const shifted = withPose({ object: { file: 'a.stl' }, film: { correction: 'c.json', width_mm: 99 } }, 0, { down: '-y', rotate_deg: [0, 0, 5], depth_mm: 12, shift_mm: [7, 0] }, 40);
    const own: JobDocument = { path: [[0, 0, 0, 0, 0, 0], [20, 6, 0, 0, 10, 0]], object: { down: '+x' } };
    for (const first of [shifted, own]) {
      const two = withAnotherDip(first);
      assert.deepEqual(two.dips![0]!.path, first.path);
      assert.equal(two.path, undefined);
      assert.deepEqual([two.dips![0]!.correction, two.dips![1]!.correction, two.film?.['correction']], [first.film?.['correction'], undefined, undefined]);
      assert.equal(two.dips![1]!.path, undefined);
      assert.ok(equal(withoutDip(two, 1), first), JSON.stringify(withoutDip(two, 1)));
    }
  },

  'a second dip added and removed gives the first pose again'() {
    const first = withPose({ object: { file: 'a.stl' } }, 0, { down: '-y', rotate_deg: [5, 0, 0], depth_mm: 12, shift_mm: [0, 0] }, 40);
    const two = withAnotherDip(first);
    assert.equal(dipCount(two), 2);
    assert.deepEqual(poseOf(two, 0), poseOf(first, 0));
    assert.equal(poseOf(two, 1).down, '+y');
    assert.ok(equal(withoutDip(two, 1), first));
  },

  'the side that goes in first points down, and angles turn about fixed axes in order'() {
    for (const down of SIDES) {
      const turn = turnOf({ down, rotate_deg: [0, 0, 0] });
      close(outward(down).applyQuaternion(turn), new Vector3(0, 0, -1), down);
      // About z afterwards: what points down stays so.
      const spun = turnOf({ down, rotate_deg: [0, 0, 77] });
      close(outward(down).applyQuaternion(spun), new Vector3(0, 0, -1), `${down} spun`);
    }
    const rotate_deg: Vec3 = [30, -50, 110];
    const about = (axis: Vec3, degrees: number): Matrix4 => new Matrix4().makeRotationAxis(new Vector3(...axis), (degrees * Math.PI) / 180);
    const steps = about([0, 0, 1], 110).multiply(about([0, 1, 0], -50)).multiply(about([1, 0, 0], 30));
    const p = new Vector3(1, 2, 3);
    close(p.clone().applyQuaternion(turnOf({ down: '-z', rotate_deg })), p.clone().applyMatrix4(steps), 'x, then y, then z');
  },

  'angles read from a turn give that turn'() {
    for (let i = 0; i < 200; ++i) {
      const down = SIDES[i % 6]!;
      const turn = turnOf({ down, rotate_deg: [angle(), angle(), angle()] });
      const again = turnOf({ down, rotate_deg: anglesOf(turn, down) });
      assert.ok(turn.angleTo(again) < 0.006, `${down} ${i}: off by ${turn.angleTo(again)}`); // angles are kept to a tenth of a degree
    }
  },

  'a face put down points down'() {
    for (let i = 0; i < 100; ++i) {
      const turn = turnOf({ down: '-z', rotate_deg: [angle(), angle(), angle()] });
      const normal = new Vector3(random() - 0.5, random() - 0.5, random() - 0.5).normalize();
      const inModel = normal.clone().applyQuaternion(turn.clone().invert());
      const more: Quaternion = turnedDown(turn, normal);
      close(inModel.applyQuaternion(more), new Vector3(0, 0, -1), String(i));
    }
  },

  'what a panel leaves free is the side of it with most room, if there is enough'() {
    const middle = { left: 300, top: 50, right: 1100, bottom: 850 };
    const free = (left: number, top: number, right: number, bottom: number): number[] => {
      const { left: l, top: t, right: r, bottom: b } = freePart(middle, { left, top, right, bottom });
      return [l, t, r, b];
    };
    assert.deepEqual(free(1100, 50, 1400, 850), [0, 0, 0, 0]); // beside it
    assert.deepEqual(free(900, 60, 1400, 840), [0, 0, 208, 0]);
    assert.deepEqual(free(200, 60, 500, 840), [208, 0, 0, 0]);
    assert.deepEqual(free(320, 40, 1080, 300), [0, 258, 0, 0]);
    assert.deepEqual(free(320, 600, 1080, 900), [0, 0, 0, 258]);
    assert.deepEqual(free(400, 150, 1000, 750), [0, 0, 0, 0]); // all of it matters: nothing is left
    assert.deepEqual(Object.values(freePart(middle, null)), [0, 0, 0, 0]);
  },

  'a placed object stands on the water in the middle of the film, at its size'() {
    const position = Float32Array.from({ length: 300 }, () => 100 * random());
    for (let i = 0; i < 20; ++i) {
      const matrix = placeOf(position, turnOf({ down: SIDES[i % 6]!, rotate_deg: [angle(), angle(), angle()] }), 0.5);
      const low = new Vector3(Infinity, Infinity, Infinity);
      const high = low.clone().negate();
      for (let k = 0; k < position.length; k += 3) {
        const p = new Vector3().fromArray(position, k).applyMatrix4(matrix);
        low.min(p);
        high.max(p);
      }
      close(new Vector3(low.x + high.x, low.y + high.y, low.z), new Vector3(), String(i), 1e-3);
      assert.ok(Math.abs(matrix.determinant() - 0.125) < 1e-9);
    }
  },
};

for (const [name, body] of Object.entries(tests)) {
  body();
  console.log(`ok: ${name}`);
}
