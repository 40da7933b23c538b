// The job as one immutable value, and every way to change it. Nothing here knows of the screen or the program.
import { leant } from './stage/pose.ts';

export type Json = null | boolean | number | string | Json[] | { [key: string]: Json };
export type Patch = { [key: string]: Json };
export type Vec3 = [number, number, number];
export type Side = '-z' | '+z' | '-y' | '+y' | '-x' | '+x';
export type Projection = 'planar' | 'cylinder' | 'sphere' | 'box' | 'uv' | 'wrap' | 'film';

export interface Layer {
  image?: string;
  text?: string;
  font?: string;
  text_color?: string;
  projection?: Projection;
  at_mm?: Vec3;
  toward?: Vec3;
  up?: Vec3;
  size_mm?: number | [number, number];
  turn_deg?: number;
  repeat?: 'once' | 'tile' | 'mirror';
  through?: boolean;
  fade_deg?: number;
  opacity?: number;
  blend?: 'normal' | 'multiply';
}

// Around an axis or a centre.
export const isRound = (projection: Projection | undefined): boolean => projection === 'cylinder' || projection === 'sphere';

// A layer laid on in another way: it stays where it is, but `toward` and `up` mean another thing where it goes round (the
// axis, not the way it is pushed), and all of them another on the film.
export function laidAnew(layer: Layer, projection: Projection): Partial<Layer> {
  if (projection === layer.projection) return {};
  if (projection === 'film' || layer.projection === 'film') return { projection, at_mm: undefined, toward: undefined, up: undefined };
  return isRound(projection) === isRound(layer.projection) ? { projection } : { projection, toward: undefined, up: undefined };
}

export type Way = number[][]; // keyframes: lower, shift x, y, turn x, y, z

export interface Dip {
  down?: Side;
  rotate_deg?: Vec3;
  depth_mm?: number;
  path?: Way | null;
  locked?: boolean;
  correction?: string;
}

type Group = { [name: string]: Json | undefined };

export interface JobDocument {
  name?: string;
  page?: Group;
  object?: Group & { file?: string; size_mm?: number; down?: Side; rotate_deg?: Vec3 };
  film?: Group;
  dip?: Group;
  path?: Way | null;
  artwork?: Layer[];
  dips?: Dip[];
  [group: string]: Group | string | Way | Layer[] | Dip[] | null | undefined;
}

// --- Values by their parameters' names ---

export type Defaults = ReadonlyMap<string, Json>;

export function valueOf<T extends Json>(document: JobDocument, defaults: Defaults, name: string): T {
  const [group = '', key = ''] = name.split('.');
  const held = document[group] as Group | undefined;
  return (held?.[key] ?? defaults.get(name) ?? null) as T;
}

const same = (a: unknown, b: unknown): boolean => JSON.stringify(a) === JSON.stringify(b);

// A value that is the default leaves the document, so that going back gives the same document.
export function withValue(document: JobDocument, defaults: Defaults, name: string, value: Json): JobDocument {
  const [group = '', key = ''] = name.split('.');
  const { [key]: _, ...rest } = (document[group] as Group | undefined) ?? {};
  if (!same(value, defaults.get(name) ?? null)) rest[key] = value;
  const { [group]: __, ...others } = document;
  return (Object.keys(rest).length ? { ...document, [group]: rest } : others) as JobDocument;
}

// RFC 7386.
export function merged(target: Json | undefined, patch: Json): Json {
  if (patch === null || typeof patch !== 'object' || Array.isArray(patch)) return patch;
  const result: { [key: string]: Json } =
    target && typeof target === 'object' && !Array.isArray(target) ? { ...target } : {};
  for (const [key, value] of Object.entries(patch)) {
    if (value === null) delete result[key];
    else result[key] = merged(result[key], value);
  }
  return result;
}

export const patched = (document: JobDocument, patch: Patch): JobDocument =>
  merged(document as Json, patch) as unknown as JobDocument;

export const equal = (a: JobDocument, b: JobDocument): boolean => canonical(a as Json) === canonical(b as Json);

function canonical(value: Json | undefined): string {
  if (Array.isArray(value)) return `[${value.map(canonical).join(',')}]`;
  if (value && typeof value === 'object') {
    const keys = Object.keys(value).filter((key) => value[key] !== undefined).sort();
    return `{${keys.map((key) => `${JSON.stringify(key)}:${canonical(value[key])}`).join(',')}}`;
  }
  return JSON.stringify(value ?? null);
}

// --- The pose of one dip ---

export interface Pose {
  down: Side;
  rotate_deg: Vec3;
  depth_mm: number; // 0: the whole object
  shift_mm: [number, number];
}

export const dipCount = (document: JobDocument): number => Math.max(1, document.dips?.length ?? 0);

const numbers = (value: Json | undefined, fallback: Vec3): Vec3 =>
  Array.isArray(value) && value.length === 3 ? (value as Vec3) : fallback;
const plain = (value: Json | undefined): number => (typeof value === 'number' ? value : 0);

// A way that only shifts is what the shift fields make; any other stays as it is.
function shiftOf(way: Way | null | undefined): [number, number] {
  const [first, last] = [way?.[0], way?.at(-1)];
  if (!way || way.length !== 2 || !first || !last) return [0, 0];
  const straight = [1, 2, 3, 4, 5].every((k) => first[k] === last[k]) && [3, 4, 5].every((k) => !first[k]);
  return straight ? [first[1] ?? 0, first[2] ?? 0] : [0, 0];
}

const wayOf = (document: JobDocument, dip: number): Way | null | undefined => document.dips?.[dip]?.path ?? document.path;

// Whether the way in is more than a shift: it says then how deep it goes and where, and nobody else does.
export const hasWayOfItsOwn = (document: JobDocument, dip: number): boolean => {
  const way = wayOf(document, dip);
  return !!way?.length && shiftOf(way).every((s) => s === 0);
};

export const hasWay = (document: JobDocument): boolean => !!document.path?.length || (document.dips ?? []).some((dip) => dip.path?.length);

export function poseOf(document: JobDocument, dip: number): Pose {
  const object = document.object ?? {};
  const own = document.dips?.[dip];
  const way = wayOf(document, dip);
  const shift_mm = shiftOf(way);
  const shifted = shift_mm[0] !== 0 || shift_mm[1] !== 0;
  return {
    down: own?.down ?? object.down ?? '-z',
    rotate_deg: numbers(own?.rotate_deg ?? object.rotate_deg, [0, 0, 0]),
    depth_mm: shifted ? (way?.at(-1)?.[0] ?? 0) : plain(own?.depth_mm ?? document.dip?.['depth_mm']),
    shift_mm,
  };
}

function without<T extends object>(value: T, ...keys: (keyof T)[]): T {
  const copy = { ...value };
  for (const key of keys) delete copy[key];
  return copy;
}

function withGroup(document: JobDocument, name: 'dip' | 'film', group: Group): JobDocument {
  const rest = without(document, name);
  return Object.keys(group).length ? { ...rest, [name]: group } : rest;
}

// What `dip` says of a way in, and beside a path must not.
const OF_A_WAY = ['depth_mm', 'tilt_deg', 'tilt_toward_deg', 'roll_deg'];
export const saysAWay = (name: string): boolean => OF_A_WAY.some((key) => name === `dip.${key}`);
const withoutWay = (document: JobDocument): JobDocument => withGroup(without(document, 'path'), 'dip', without(document.dip ?? {}, ...OF_A_WAY));

// A tilt is a turn in other words, which a path and each of several dips understand.
export function withTiltTurned(document: JobDocument): JobDocument {
  const { tilt_deg, ...settings } = document.dip ?? {};
  const tilt = plain(tilt_deg);
  if (!tilt) return document;
  const toward = plain(settings['tilt_toward_deg']);
  if (!settings['roll_deg']) delete settings['tilt_toward_deg'];
  const rest = withGroup(document, 'dip', settings);
  const turned = (dip: number): Vec3 => leant(poseOf(document, dip), tilt, toward);
  if (!document.dips?.length) return { ...rest, object: { ...rest.object, rotate_deg: turned(0) } };
  // One of which no pose is said is looked for.
  return { ...rest, dips: document.dips.map((own, k) => (own.down ?? own.rotate_deg ? { ...own, rotate_deg: turned(k) } : own)) };
}

// Straight down into the middle of the film.
export function withoutWayOf(document: JobDocument, dip: number): JobDocument {
  if (!document.dips?.[dip]) return without(document, 'path');
  const own = withOwnWays(document);
  return withDips(own, (entry, k) => (k === dip ? { ...without(entry, 'path'), depth_mm: entry.depth_mm ?? 0 } : entry));
}

// Each of several dips says its own way in; what was said of all of them goes to those that said nothing.
function withOwnWays(document: JobDocument): JobDocument {
  const depth = document.dip?.['depth_mm'];
  return withDips(withoutWay(document), (own) => {
    if (own.path?.length || own.depth_mm !== undefined) return own;
    if (document.path?.length) return { ...own, path: document.path };
    return depth === undefined ? own : { ...own, depth_mm: plain(depth) };
  });
}

const withDips = (document: JobDocument, change: (dip: Dip, k: number) => Dip): JobDocument => ({ ...document, dips: (document.dips ?? []).map(change) });

// A way into the water says no more than that: a larger object fits no bath.
const LONGEST_MM = 5000;
const within = (mm: number): number => Math.min(Math.max(mm, -LONGEST_MM), LONGEST_MM);

// `height_mm`: of the posed object, needed where a shifted way has to say how deep "the whole object" is. A way of its own
// stays as it is until there is a shift. What else was said of a way is not said beside a path.
export function withPose(document: JobDocument, dip: number, pose: Pose, height_mm: number): JobDocument {
  const [x, y] = [within(pose.shift_mm[0]), within(pose.shift_mm[1])];
  const deep = within(pose.depth_mm || height_mm);
  const kept = hasWayOfItsOwn(document, dip) ? wayOf(document, dip)! : null;
  const way: Way | null = x || y ? [[0, x, y, 0, 0, 0], [deep, x, y, 0, 0, 0]] : kept;
  const own = document.dips?.[dip];
  if (own) {
    // Of a dip among several, what is absent would be searched.
    const next: Dip = { ...without(own, 'depth_mm', 'path'), down: pose.down, rotate_deg: pose.rotate_deg };
    if (way) next.path = way;
    else next.depth_mm = pose.depth_mm;
    return withDips(way ? withOwnWays(document) : document, (d, k) => (k === dip ? next : d));
  }
  const object: NonNullable<JobDocument['object']> = without(document.object ?? {}, 'down', 'rotate_deg');
  if (pose.down !== '-z') object.down = pose.down;
  if (pose.rotate_deg.some((angle) => angle !== 0)) object.rotate_deg = pose.rotate_deg;
  if (way) return { ...withoutWay(document), object, path: way };
  const settings = without(document.dip ?? {}, 'depth_mm');
  if (pose.depth_mm) settings['depth_mm'] = pose.depth_mm;
  return { ...withGroup(without(document, 'path'), 'dip', settings), object };
}

// What a patch says of how the only dip hangs and goes in, for one among several; and what else it says.
export interface PoseInPatch {
  pose: Partial<Pose>;
  tilt: { tilt_deg: number; toward_deg: number } | null; // of the pose as it was, instead of any other
  straight: boolean; // no path any more
  rest: Patch;
}

export function poseInPatch({ object, dip, path, ...others }: Patch): PoseInPatch {
  const { down, rotate_deg, ...ofObject } = (object ?? {}) as Patch;
  const { depth_mm, tilt_deg, tilt_toward_deg, roll_deg: _, ...ofDip } = (dip ?? {}) as Patch;
  const pose: Partial<Pose> = {};
  if (down) pose.down = down as Side;
  if (rotate_deg) pose.rotate_deg = rotate_deg as Vec3;
  if (depth_mm !== undefined) pose.depth_mm = plain(depth_mm ?? 0);
  const rest: Patch = { ...others };
  if (Object.keys(ofObject).length) rest['object'] = ofObject;
  if (Object.keys(ofDip).length) rest['dip'] = ofDip;
  const tilt = tilt_deg === undefined ? null : { tilt_deg: plain(tilt_deg), toward_deg: plain(tilt_toward_deg) };
  return { pose, tilt, straight: path === null, rest };
}

// One dip more, turned over, so that it brings what the others leave bare.
export function withAnotherDip(document: JobDocument): JobDocument {
  const several = document.dips?.length ? document : withFirstDip(document);
  const at = several.dips!.length - 1;
  const { down, rotate_deg, depth_mm } = poseOf(several, at);
  const over: Record<Side, Side> = { '-z': '+z', '+z': '-z', '-y': '+y', '+y': '-y', '-x': '+x', '+x': '-x' };
  return { ...several, dips: [...several.dips!, { down: over[down], rotate_deg, depth_mm }] };
}

// The only dip as the first of several, with all that is its own.
function withFirstDip(document: JobDocument): JobDocument {
  const { correction, ...film } = document.film ?? {};
  const leaning = withTiltTurned(document);
  const { down, rotate_deg, depth_mm } = poseOf(leaning, 0);
  const first: Dip = { down, rotate_deg };
  if (leaning.path?.length) first.path = leaning.path;
  else first.depth_mm = depth_mm;
  if (typeof correction === 'string') first.correction = correction;
  const settings = without(leaning.dip ?? {}, 'depth_mm');
  return { ...withGroup(withGroup(without(leaning, 'path'), 'dip', settings), 'film', film), dips: [first] };
}

export function withoutDip(document: JobDocument, dip: number): JobDocument {
  const dips = (document.dips ?? []).filter((_, k) => k !== dip);
  const [first] = dips;
  if (!first) return without(document, 'dips');
  return dips.length > 1 ? { ...document, dips } : withOnlyDip({ ...document, dips });
}

// The first of several as the only one, with all that is its own.
function withOnlyDip(document: JobDocument): JobDocument {
  const { path, correction } = document.dips![0]!;
  const pose = poseOf(document, 0);
  const rest = without(document, 'dips');
  if (path?.length) rest.path = path;
  const corrected = correction ? withGroup(rest, 'film', { ...rest.film, correction }) : rest;
  return withPose(corrected, 0, pose, pose.depth_mm);
}

export const withDip = (document: JobDocument, dip: number, change: Partial<Dip>): JobDocument => ({
  ...document,
  dips: (document.dips ?? []).map((d, k) => (k === dip ? { ...d, ...change } : d)),
});

// --- Layers; the list's last lies on top ---

export const layersOf = (document: JobDocument): readonly Layer[] => document.artwork ?? [];

function withLayers(document: JobDocument, layers: Layer[]): JobDocument {
  const rest = without(document, 'artwork');
  return layers.length ? { ...rest, artwork: layers } : rest;
}

export const withNewLayer = (document: JobDocument, layer: Layer): JobDocument =>
  withLayers(document, [...layersOf(document), layer]);

export function withLayer(document: JobDocument, at: number, change: Partial<Layer>): JobDocument {
  const layers = layersOf(document).map((layer, k) => {
    if (k !== at) return layer;
    const next: { [key: string]: unknown } = { ...layer, ...change };
    for (const key of Object.keys(next)) if (next[key] === undefined) delete next[key];
    return next as Layer;
  });
  return withLayers(document, layers);
}

export const withoutLayer = (document: JobDocument, at: number): JobDocument =>
  withLayers(document, layersOf(document).filter((_, k) => k !== at));

export function withLayerMoved(document: JobDocument, from: number, to: number): JobDocument {
  const layers = [...layersOf(document)];
  const [layer] = layers.splice(from, 1);
  if (layer) layers.splice(to, 0, layer);
  return withLayers(document, layers);
}

export const layerName = (layer: Layer): string => layer.text ?? layer.image ?? '';
export const layerWidth = (layer: Layer): number | null =>
  layer.size_mm === undefined ? null : Array.isArray(layer.size_mm) ? layer.size_mm[0] : layer.size_mm;

// A layer's other measure follows where both are given.
export function resized(entry: Layer, width: number | null): Layer['size_mm'] {
  if (width === null) return undefined;
  const round = (length: number): number => Math.round(length * 10) / 10;
  if (!Array.isArray(entry.size_mm)) return round(width);
  return [round(width), round((width * entry.size_mm[1]) / entry.size_mm[0])];
}
