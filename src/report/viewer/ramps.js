// Colour scales as in maps.png (color_ramp.cpp, maps.cpp): even steps for the eye in OKLab
// (Ottosson 2020), lightness alone tells values apart.

const ENTRIES = 256;

function toOklab([lightness, chroma, hue]) {
  const h = (hue * Math.PI) / 180;
  return [lightness, chroma * Math.cos(h), chroma * Math.sin(h)];
}

function toLinear([L, a, b]) {
  const l = (L + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (L - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (L - 0.0894841775 * a - 1.291485548 * b) ** 3;
  return [
    4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
    -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
    -0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s,
  ];
}

function toByte(linear) {
  const x = Math.min(1, Math.max(0, linear));
  return Math.round(255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055));
}

// The parabola through three tones, walked at even speed.
function ramp(begin, middle, end) {
  const at = (t) => {
    const w = [(1 - t) * (1 - 2 * t), 4 * t * (1 - t), t * (2 * t - 1)];
    return toOklab([0, 1, 2].map((k) => w[0] * begin[k] + w[1] * middle[k] + w[2] * end[k]));
  };
  const steps = 2048;
  const path = [0];
  for (let i = 1; i <= steps; ++i) {
    const [a, b] = [at((i - 1) / steps), at(i / steps)];
    path.push(path[i - 1] + Math.hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]));
  }
  const bytes = new Uint8Array(4 * ENTRIES);
  let step = 0;
  for (let i = 0; i < ENTRIES; ++i) {
    const wanted = (path[steps] * i) / (ENTRIES - 1);
    while (step < steps && path[step] < wanted) ++step;
    bytes.set([...toLinear(at(step / steps)).map(toByte), 255], 4 * i);
  }
  return bytes;
}

export const RAMPS = {
  gentle: ramp([0.34, 0.13, 268], [0.64, 0.12, 235], [0.93, 0.05, 195]),
  steep: ramp([0.74, 0.16, 60], [0.54, 0.17, 36], [0.32, 0.11, 22]),
  stretch: ramp([0.3, 0.13, 288], [0.61, 0.1, 195], [0.93, 0.17, 104]),
  error: ramp([0.95, 0.02, 110], [0.7, 0.14, 50], [0.33, 0.12, -10]),
};

export function cssColor(bytes, t) {
  const i = 4 * Math.round(Math.min(1, Math.max(0, t)) * (ENTRIES - 1));
  return `rgb(${bytes[i]},${bytes[i + 1]},${bytes[i + 2]})`;
}

export function cssGradient(bytes, from = 0, to = 100) {
  const stops = [];
  for (let i = 0; i <= 16; ++i) {
    stops.push(`${cssColor(bytes, i / 16)} ${from + ((to - from) * i) / 16}%`);
  }
  return stops.join(',');
}
