// The table of overlays: what film, torn film and bare object show, and the legend. One entry each.
import { MODE } from './surface.js';
import { RAMPS, cssGradient } from './ramps.js';

export const NEUTRAL = '#a2a2a2';
export const COVERED = '#2f6db3';
export const MISSED = '#e69f00';
export const PALE = '#d5dbe3';

const flat = (color) => ({ mode: MODE.flat, color });
const hatch = { mode: MODE.hatch };
const TORN = { hatch: true, label: 'torn' };
const BARE = { color: NEUTRAL, label: 'no film' };

export const stretchEnd = (scene) => {
  if (scene.tear_stretch > 1) return Math.max(scene.tear_stretch, 1.01);
  let most = 1.1;
  scene.film.stretch.forEach((s, v) => {
    if (scene.film.state[v] === 1) most = Math.max(most, s);
  });
  return Math.ceil(10 * most - 1e-6) / 10;
};

function ticks(low, high) {
  const step = [0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50].find((s) => (high - low) / s <= 5.5) ?? 100;
  const list = [];
  for (let value = low; value <= high + 1e-9; value += step) {
    list.push({ at: (value - low) / (high - low), label: String(+value.toFixed(2)) });
  }
  return list;
}

// Of one dip; several dips' finish is painted on the object and has looks instead.
const hasFilm = (scene) => scene.film.index.length > 0;

function lookOverlay(key, label, title, patches) {
  return {
    key,
    label,
    available: (scene) => scene.looks.some((look) => look.key === key),
    film: null,
    torn: null,
    object: () => ({ mode: MODE.picture }),
    legend: (scene) => ({ title, patches: patches(scene) }),
  };
}

const DIP_COLORS = ['#0072b2', '#e69f00', '#009e73', '#cc79a7', '#56b4e9', '#d55e00', '#f0e442'];
const dipPatches = (scene) =>
  Array.from({ length: Math.min(scene.dips ?? 0, DIP_COLORS.length) }, (_, k) => ({ color: DIP_COLORS[k], label: `dip ${k + 1}` }));

function layerOverlay(key, label, title, least) {
  const end = (scene) => Math.max(least, Math.ceil(scene.layers[key].largest));
  return {
    key,
    label,
    available: (scene) => Boolean(scene.layers[key]),
    film: (scene) => ({ mode: MODE.layer, layer: key, ramp: 'error', low: 0, high: end(scene) }),
    torn: () => hatch,
    object: () => flat(NEUTRAL),
    legend: (scene) => ({
      title,
      gradient: cssGradient(RAMPS.error),
      ticks: ticks(0, end(scene)),
      patches: [TORN, BARE],
    }),
  };
}

export const OVERLAYS = [
  {
    key: 'none',
    label: 'colours',
    available: () => true,
    film: () => ({ mode: MODE.picture }),
    torn: null,
    object: () => ({ mode: MODE.bare }),
    legend: () => null,
  },
  {
    key: 'stretch',
    label: 'stretch',
    available: hasFilm,
    film: (scene) => ({ mode: MODE.amount, ramp: 'stretch', low: 1, high: stretchEnd(scene) }),
    torn: () => hatch,
    object: () => flat(NEUTRAL),
    legend: (scene) => ({
      title: 'Largest stretch of the film: length now over length printed (times)',
      gradient: cssGradient(RAMPS.stretch),
      ticks: ticks(1, stretchEnd(scene)),
      patches: [TORN, BARE],
    }),
  },
  {
    key: 'angle',
    label: 'dip angle',
    // Seen from here it is against the vertical; along other paths only maps.png knows it.
    available: (scene) => !scene.film.poses,
    film: null,
    torn: null,
    object: () => ({ mode: MODE.angle }),
    legend: () => ({
      title: 'Angle between surface and water (degrees); black line: the 45\u00b0 limit',
      gradient: `${cssGradient(RAMPS.gentle, 0, 50)},${cssGradient(RAMPS.steep, 50, 100)}`,
      mark: 0.5,
      ticks: [0, 15, 30, 45, 60, 75, 90].map((a) => ({ at: a / 90, label: `${a}\u00b0` })),
      patches: [{ color: NEUTRAL, label: 'upright, facing up, or dry' }],
    }),
  },
  {
    key: 'tears',
    label: 'tears',
    available: hasFilm,
    film: () => flat(PALE),
    torn: () => hatch,
    object: () => flat(NEUTRAL),
    legend: () => ({
      title: 'Where the film tears: nothing is printed there',
      patches: [TORN, { color: PALE, label: 'film holds' }, BARE],
    }),
  },
  {
    key: 'coverage',
    label: 'coverage',
    available: hasFilm,
    film: () => flat(COVERED),
    torn: () => hatch,
    object: () => ({ mode: MODE.reach, color: MISSED }),
    legend: () => ({
      title: 'What gets film',
      patches: [
        { color: COVERED, label: 'covered' },
        TORN,
        { color: MISSED, label: 'faces down, but stays bare' },
        { color: NEUTRAL, label: 'upright, facing up, or dry' },
      ],
    }),
  },
  layerOverlay('color_error', 'colour error', 'Predicted against wanted colour (CIEDE2000; 1 is just visible)', 10),
  layerOverlay('pressed', 'wrinkles', 'How far the film is pressed together (percent); wrinkles show from about 5 on', 10),
  layerOverlay('out_of_gamut', 'out of gamut', 'How far the wanted colour is from what can be printed (CIEDE2000)', 5),
  lookOverlay('parts', 'which dip', 'Which dip does what; where two meet they fade into each other', (scene) => [
    ...dipPatches(scene),
    { color: '#a0a0a0', label: 'no film' },
  ]),
  lookOverlay('finish_error', 'colour error', 'Predicted against wanted colour (CIEDE2000; 1 is just visible)', () => [
    { color: '#cbcbcb', label: '0' },
    { color: '#d0714b', label: '5' },
    { color: '#da0000', label: '10 and more' },
  ]),
];
