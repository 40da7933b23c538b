// Who lies under the pointer: rays against triangles, and points of the sheet in the film's mesh.

// Nearest hit of origin + t * direction with the triangles (all, or those listed): t and weights.
export function castRay(position, index, triangles, origin, direction) {
  const [ox, oy, oz] = origin;
  const [dx, dy, dz] = direction;
  let best = null;
  const count = triangles ? triangles.length : index.length / 3;
  for (let i = 0; i < count; ++i) {
    const t = triangles ? triangles[i] : i;
    const a = 3 * index[3 * t];
    const b = 3 * index[3 * t + 1];
    const c = 3 * index[3 * t + 2];
    const ax = position[a], ay = position[a + 1], az = position[a + 2];
    const ux = position[b] - ax, uy = position[b + 1] - ay, uz = position[b + 2] - az;
    const vx = position[c] - ax, vy = position[c + 1] - ay, vz = position[c + 2] - az;
    const px = dy * vz - dz * vy, py = dz * vx - dx * vz, pz = dx * vy - dy * vx;
    const det = ux * px + uy * py + uz * pz;
    if (det === 0) continue;
    const sx = ox - ax, sy = oy - ay, sz = oz - az;
    const u = (sx * px + sy * py + sz * pz) / det;
    if (u < 0 || u > 1) continue;
    const qx = sy * uz - sz * uy, qy = sz * ux - sx * uz, qz = sx * uy - sy * ux;
    const v = (dx * qx + dy * qy + dz * qz) / det;
    if (v < 0 || u + v > 1) continue;
    const far = (vx * qx + vy * qy + vz * qz) / det;
    if (far > 0 && (!best || far < best.t)) best = { t: far, triangle: t, weights: [1 - u - v, u, v] };
  }
  return best;
}

// The film triangle that holds the point (mm from the sheet's centre), and its weights there.
export function locate(film, x, y) {
  const { u, index } = film;
  for (let t = 0; t < index.length / 3; ++t) {
    const a = 2 * index[3 * t];
    const b = 2 * index[3 * t + 1];
    const c = 2 * index[3 * t + 2];
    const bx = u[b] - u[a], by = u[b + 1] - u[a + 1];
    const cx = u[c] - u[a], cy = u[c + 1] - u[a + 1];
    const px = x - u[a], py = y - u[a + 1];
    const area = bx * cy - by * cx;
    const w1 = (px * cy - py * cx) / area;
    const w2 = (bx * py - by * px) / area;
    if (w1 >= -1e-6 && w2 >= -1e-6 && w1 + w2 <= 1 + 2e-6) {
      return { triangle: t, weights: [1 - w1 - w2, w1, w2] };
    }
  }
  return null;
}

// A quantity of the film's vertices between the corners of a triangle.
export function between(film, values, components, { triangle, weights }) {
  const result = new Array(components).fill(0);
  for (let corner = 0; corner < 3; ++corner) {
    const at = components * film.index[3 * triangle + corner];
    for (let k = 0; k < components; ++k) result[k] += weights[corner] * values[at + k];
  }
  return result;
}

export function fateOf(film, triangle) {
  const met = [0, 1, 2].every((k) => film.state[film.index[3 * triangle + k]] === 1);
  if (!met) return 'floats';
  return film.torn[triangle] ? 'torn' : 'lies';
}
