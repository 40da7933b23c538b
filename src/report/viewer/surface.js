// How surfaces look: one shader with a few modes, lit like the still pictures.
import * as THREE from 'three';
import { RAMPS } from './ramps.js';

export const MODE = { picture: 0, bare: 1, flat: 2, amount: 3, layer: 4, angle: 5, hatch: 6, reach: 7 };

const VERTEX = `
attribute float amount;
#ifdef TINTED
attribute vec4 tint;
#endif
uniform float lift;
varying vec2 vUv;
varying vec4 vTint;
varying vec3 vModelNormal, vNormal, vPlace;
varying float vAmount, vHeight;
void main() {
  vUv = uv;
  vAmount = amount;
  vModelNormal = normal;
  vNormal = normalMatrix * normal;
  vHeight = position.z;
#ifdef TINTED
  vTint = tint;
#else
  vTint = vec4(1.0);
#endif
  vec4 place = modelViewMatrix * vec4(position, 1.0);
  vPlace = place.xyz;
  place.xyz -= lift * normalize(place.xyz);  // nearer to the eye, at the same place on the screen
  gl_Position = projectionMatrix * place;
}`;

const FRAGMENT = `
uniform int mode;
uniform vec3 base, color;
uniform vec4 material;
uniform bool textured, decalU, decalV, film, grid;
uniform sampler2D map, ramp, gentle, steep, layer;
uniform vec2 sheet;
uniform vec4 extent;
uniform float low, high, largest, depth, flatness;
varying vec2 vUv;
varying vec4 vTint;
varying vec3 vModelNormal, vNormal, vPlace;
varying float vAmount, vHeight;

const vec3 kNeutral = vec3(0.36);

vec3 picture() {
  vec4 c = vec4(1.0);
  bool outside = (decalU && (vUv.x < 0.0 || vUv.x > 1.0)) || (decalV && (vUv.y < 0.0 || vUv.y > 1.0));
  if (textured && !outside) c = texture2D(map, vUv);
  c *= material * vTint;
  return mix(base, c.rgb, c.a);
}

vec3 scaled(float value) {
  float t = clamp((value - low) / (high - low), 0.0, 1.0);
  return texture2D(ramp, vec2((t * 255.0 + 0.5) / 256.0, 0.5)).rgb;
}

vec3 layered() {
  vec2 u = (vUv - 0.5) * sheet;
  vec2 place = (u - extent.xy) / (extent.zw - extent.xy);  // row 0 is the +y edge
  float cell = texture2D(layer, vec2(place.x, 1.0 - place.y)).r * 255.0;
  return cell > 254.5 ? kNeutral : scaled(cell / 254.0 * largest);
}

float angle() { return degrees(acos(clamp(-normalize(vModelNormal).z, -1.0, 1.0))); }

bool reachable() { return angle() < 89.9 && vHeight < depth + 1e-3; }

vec3 angled() {
  float a = angle();
  vec3 below = texture2D(gentle, vec2((a / 45.0 * 255.0 + 0.5) / 256.0, 0.5)).rgb;
  vec3 beyond = texture2D(steep, vec2(((a - 45.0) / 45.0 * 255.0 + 0.5) / 256.0, 0.5)).rgb;
  vec3 c = a <= 45.1 ? below : beyond;
  float line = abs(a - 45.0) / max(fwidth(a), 1e-3);
  c = mix(vec3(0.0), c, smoothstep(0.8, 1.6, line));
  return reachable() ? c : kNeutral;
}

vec3 hatched() {
  float stripe = fract((gl_FragCoord.x + gl_FragCoord.y) / 12.0);
  return stripe < 0.5 ? vec3(0.50, 0.0, 0.025) : vec3(1.0);
}

vec3 shown() {
  if (mode == 0) return picture();
  if (mode == 1) return base;
  if (mode == 3) return scaled(vAmount);
  if (mode == 4) return layered();
  if (mode == 5) return angled();
  if (mode == 6) return hatched();
  if (mode == 7) return reachable() ? color : kNeutral;
  return color;
}

// A line every 5 mm of the flat film.
vec3 ruled(vec3 c) {
  vec2 u = (vUv - 0.5) * sheet / 5.0;
  vec2 apart = abs(u - round(u)) / max(fwidth(u), vec2(1e-6));
  float line = 1.0 - smoothstep(0.5, 1.2, min(apart.x, apart.y));
  return mix(c, vec3(0.01, 0.04, 0.07), 0.6 * line);
}

float light() {
  vec3 n = normalize(vNormal);
  if (dot(n, normalize(vPlace)) > 0.15) n = -n;  // seen from inside
  float lamp = max(0.0, dot(n, normalize(vec3(-0.5, 0.8, 0.75))));
  float front = max(0.0, n.z);
  return 0.40 + 0.14 * (0.5 + 0.5 * n.y) + 0.34 * lamp + 0.18 * front;
}

void main() {
  vec3 c = shown();
  if (film && grid && mode != 6) c = ruled(c);
  c = clamp(c * mix(light(), 1.0, flatness), 0.0, 1.0);
  vec3 encoded = mix(1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, 12.92 * c, vec3(lessThanEqual(c, vec3(0.0031308))));
  gl_FragColor = vec4(encoded, 1.0);
}`;

function dataTexture(bytes, width, height, format) {
  const texture = new THREE.DataTexture(bytes, width, height, format);
  texture.unpackAlignment = 1;
  texture.needsUpdate = true;
  return texture;
}

function rampTexture(bytes) {
  const texture = dataTexture(bytes, 256, 1, THREE.RGBAFormat);
  texture.colorSpace = THREE.SRGBColorSpace;
  texture.minFilter = texture.magFilter = THREE.LinearFilter;
  return texture;
}

// Textures that all surfaces share.
export function sharedTextures(scene) {
  const ramps = {};
  for (const [name, bytes] of Object.entries(RAMPS)) ramps[name] = rampTexture(bytes);
  const layers = {};
  for (const [key, layer] of Object.entries(scene.layers)) {
    layers[key] = dataTexture(layer.cells, layer.width, layer.height, THREE.RedFormat);
  }
  return { ramps, layers, grid: { value: false } };
}

export function pictureTexture(url, whenLoaded) {
  const texture = new THREE.TextureLoader().load(url, whenLoaded);
  texture.colorSpace = THREE.SRGBColorSpace;
  texture.anisotropy = 8;
  return texture;
}

export function surfaceMaterial(scene, shared, options = {}) {
  const uniform = (value) => ({ value });
  return new THREE.ShaderMaterial({
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    side: options.side ?? THREE.DoubleSide,
    defines: options.tinted ? { TINTED: 1 } : {},
    uniforms: {
      mode: uniform(MODE.flat),
      lift: uniform(options.lift ?? 0),
      base: uniform(new THREE.Vector3(...scene.base)),
      color: uniform(new THREE.Color(1, 1, 1)),
      material: uniform(new THREE.Vector4(...(options.color ?? [1, 1, 1, 1]))),
      textured: uniform(Boolean(options.map)),
      map: uniform(options.map ?? shared.ramps.gentle),
      decalU: uniform(options.wrap?.[0] === 'decal'),
      decalV: uniform(options.wrap?.[1] === 'decal'),
      ramp: uniform(shared.ramps.stretch),
      gentle: uniform(shared.ramps.gentle),
      steep: uniform(shared.ramps.steep),
      layer: uniform(shared.ramps.gentle),
      sheet: uniform(new THREE.Vector2(scene.sheet.width_mm, scene.sheet.height_mm)),
      extent: uniform(new THREE.Vector4(0, 0, 1, 1)),
      low: uniform(0),
      high: uniform(1),
      largest: uniform(1),
      depth: uniform(scene.depth_mm),
      flatness: uniform(0),
      film: uniform(Boolean(options.film)),
      grid: shared.grid,
    },
  });
}

// Sets what a surface shows: an entry of the table of overlays.
export function dress(material, look, scene, shared) {
  const u = material.uniforms;
  u.mode.value = look.mode;
  u.flatness.value = look.mode === MODE.picture || look.mode === MODE.bare ? 0 : 0.55;
  if (look.color) u.color.value.set(look.color);
  if (look.ramp) u.ramp.value = shared.ramps[look.ramp];
  if (look.high !== undefined) [u.low.value, u.high.value] = [look.low, look.high];
  if (look.layer) {
    u.layer.value = shared.layers[look.layer];
    u.extent.value.set(...scene.layers[look.layer].extent);
    u.largest.value = scene.layers[look.layer].largest;
  }
}
