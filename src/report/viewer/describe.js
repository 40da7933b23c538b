// A point of the film or the object in words.
import { between, fateOf } from './pick.js';

const mm = (value) => `${value.toFixed(1)} mm`;

function side(value, positive, negative) {
  return `${mm(Math.abs(value))} ${value >= 0 ? positive : negative}`;
}

function angleOf(normal) {
  const length = Math.hypot(...normal) || 1;
  return (Math.acos(Math.max(-1, Math.min(1, -normal[2] / length))) * 180) / Math.PI;
}

function errorAt(layer, u) {
  const [left, bottom, right, top] = layer.extent;
  const x = Math.floor(((u[0] - left) / (right - left)) * layer.width);
  const y = Math.floor(((top - u[1]) / (top - bottom)) * layer.height);
  if (x < 0 || y < 0 || x >= layer.width || y >= layer.height) return null;
  const cell = layer.cells[y * layer.width + x];
  return cell === 255 ? null : (cell / 254) * layer.largest;
}

// Outward normal of a film triangle on the object.
function filmNormal(film, triangle) {
  const [a, b, c] = [0, 1, 2].map((k) => 3 * film.index[3 * triangle + k]);
  const u = [0, 1, 2].map((k) => film.position[b + k] - film.position[a + k]);
  const v = [0, 1, 2].map((k) => film.position[c + k] - film.position[a + k]);
  return [v[1] * u[2] - v[2] * u[1], v[2] * u[0] - v[0] * u[2], v[0] * u[1] - v[1] * u[0]];
}

export function describeFilm(scene, spot) {
  const { film } = scene;
  const u = between(film, film.u, 2, spot);
  const where = `Sheet: ${side(u[0], 'right', 'left')}, ${side(u[1], 'up', 'down')} of its centre.`;
  const fate = fateOf(film, spot.triangle);
  if (fate === 'floats') return `${where} This film does not touch the object.`;
  const place = between(film, film.position, 3, spot);
  const landing = `Object: ${mm(place[2])} above its lowest point`;
  if (fate === 'torn') return `${where} ${landing}. The film tears here: nothing is printed.`;
  const [stretch] = between(film, film.stretch, 1, spot);
  const [area] = between(film, film.areaRatio, 1, spot);
  let text = `${where} ${landing}; stretch ${stretch.toFixed(2)}, area ${area.toFixed(2)} times, `;
  text += `dip angle ${angleOf(filmNormal(film, spot.triangle)).toFixed(0)}\u00b0`;
  const error = scene.layers.color_error && errorAt(scene.layers.color_error, u);
  if (error !== null && error !== undefined) text += `, colour error ${error.toFixed(1)}`;
  return `${text}.`;
}

export const NOTHING = 'Point at the object or at the sheet to see where a spot of colour goes.';
export const BARE = 'No film comes here: the object stays bare.';
export const OFF_FILM = 'Taped margin: no film image here.';
