// What the object and its film can be coloured by: the report page's table, and air.
import type { Overlay, Result } from '../api.ts';
import { OVERLAYS } from '../../../report/viewer/overlays.js';
import { MODE } from '../../../report/viewer/surface.js';

export interface Look {
  mode: number;
  color?: string;
  ramp?: string;
  low?: number;
  high?: number;
}

export interface LegendText {
  title: string;
  gradient?: string;
  mark?: number;
  ticks?: { at: number; label: string }[];
  patches: { color?: string; hatch?: boolean; label: string }[];
}

// What the report page's table asks of a scene.
export interface Scene {
  base: number[];
  sheet: { width_mm: number; height_mm: number };
  depth_mm: number;
  tear_stretch: number;
  film: { stretch: ArrayLike<number>; state: ArrayLike<number>; index: ArrayLike<number>; poses: null };
  layers: Record<string, never>;
  looks: never[];
}

export interface OverlayEntry {
  key: Overlay;
  film: ((scene: Scene) => Look) | null;
  torn: ((scene: Scene) => Look) | null;
  wrinkled?: (scene: Scene) => Look;
  object: (scene: Scene) => Look;
  legend: (scene: Scene) => LegendText | null;
}

export const AIR = '#3d7fd6';
const PALE = '#dfe3e8';
const BARE = '#b4b4b4';

const air: OverlayEntry = {
  key: 'air',
  film: () => ({ mode: MODE.flat, color: PALE }),
  torn: () => ({ mode: MODE.flat, color: PALE }),
  object: () => ({ mode: MODE.flat, color: BARE }),
  legend: () => ({
    title: 'Air that the object keeps on its way down: no film gets there',
    patches: [{ color: AIR, label: 'stays dry' }, { color: PALE, label: 'film' }, { color: BARE, label: 'no film' }],
  }),
};

const WRINKLED = '#8a3f9e';

const wrinkles: OverlayEntry = {
  key: 'wrinkles',
  film: () => ({ mode: MODE.flat, color: PALE }),
  torn: () => ({ mode: MODE.hatch }),
  wrinkled: () => ({ mode: MODE.flat, color: WRINKLED }),
  object: () => ({ mode: MODE.flat, color: BARE }),
  legend: () => ({
    title: 'Where the film is pressed together, and wrinkles',
    patches: [{ color: WRINKLED, label: 'wrinkles' }, { color: PALE, label: 'lies smooth' }, { hatch: true, label: 'torn' }, { color: BARE, label: 'no film' }],
  }),
};

const parts: OverlayEntry = {
  key: 'parts', // the finish's own mesh has the colours
  film: null,
  torn: null,
  object: () => ({ mode: MODE.picture }),
  legend: () => null,
};

const SHARED: Overlay[] = ['none', 'coverage', 'stretch', 'tears', 'angle'];
const shared = (OVERLAYS as unknown as OverlayEntry[]).filter(({ key }) => SHARED.includes(key));
export const STUDIO_OVERLAYS: readonly OverlayEntry[] = [
  ...SHARED.map((key) => shared.find((entry) => entry.key === key)!),
  wrinkles,
  air,
  parts,
];

export const overlayOf = (key: Overlay): OverlayEntry =>
  STUDIO_OVERLAYS.find((entry) => entry.key === key) ?? STUDIO_OVERLAYS[0]!;

export const sceneOf = (result: Result | null, base: number[]): Scene => ({
  base,
  sheet: result?.film ?? { width_mm: 210, height_mm: 297 },
  depth_mm: result?.depth_mm ?? 0,
  tear_stretch: result?.film.tear_stretch ?? 0,
  film: result
    ? { stretch: result.filmMesh.stretch, state: result.filmMesh.state, index: result.filmMesh.index, poses: null }
    : { stretch: [], state: [], index: [], poses: null },
  layers: {},
  looks: [],
});
