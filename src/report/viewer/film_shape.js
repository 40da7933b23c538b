// The film at any moment of the dip.

export class FilmShape {
  constructor(film) {
    this.film = film;
    this.position = new Float32Array(film.position.length);
    this.frame = 0;
  }

  // The recorded states are close together: straight lines between them will do.
  moveTo(depth) {
    const { frames, levels, position } = this.film;
    const size = this.position.length;
    if (levels.length < 2) {
      this.position.set(position);
      return;
    }
    let k = 0;
    while (k + 2 < levels.length && levels[k + 1] <= depth) ++k;
    const part = Math.min(1, Math.max(0, (depth - levels[k]) / (levels[k + 1] - levels[k] || 1)));
    const from = k * size;
    const to = from + size;
    for (let i = 0; i < size; ++i) {
      this.position[i] = frames[from + i] + part * (frames[to + i] - frames[from + i]);
    }
    this.frame = part === 1 ? k + 1 : k;
    this.between = { k, part };
  }

  // Of the object in the bath, as a matrix of 4 x 4 column by column; null: as deep as it has gone.
  pose() {
    const { poses } = this.film;
    if (!poses || !this.between) return null;
    const { k, part } = this.between;
    return poses[k].map((value, i) => value + part * (poses[k + 1][i] - value));
  }

  attached(vertex) {
    return this.film.attachedFrom[vertex] <= this.frame;
  }

  // Flat area (mm2) of the film whose corners are all attached.
  attachedArea() {
    const { index, u } = this.film;
    let area = 0;
    for (let t = 0; t < index.length; t += 3) {
      const [a, b, c] = [2 * index[t], 2 * index[t + 1], 2 * index[t + 2]];
      if (![0, 1, 2].every((k) => this.attached(index[t + k]))) continue;
      area += 0.5 * ((u[b] - u[a]) * (u[c + 1] - u[a + 1]) - (u[b + 1] - u[a + 1]) * (u[c] - u[a]));
    }
    return area;
  }

  // Line segments between film that is attached and film that floats: across the edges that bridge
  // the two, near their attached ends.
  contactLine() {
    const { index } = this.film;
    const points = [];
    for (let t = 0; t < index.length; t += 3) {
      const on = [0, 1, 2].map((k) => this.attached(index[t + k]));
      if (on[0] === on[1] && on[1] === on[2]) continue;
      for (let k = 0; k < 3; ++k) {
        const next = (k + 1) % 3;
        if (on[k] === on[next]) continue;
        const near = 3 * index[t + (on[k] ? k : next)];
        const far = 3 * index[t + (on[k] ? next : k)];
        for (let c = 0; c < 3; ++c) {
          points.push(0.75 * this.position[near + c] + 0.25 * this.position[far + c]);
        }
      }
    }
    return points;
  }
}

// Edges that belong to one of the triangles only: the outline of what they cover.
export function outlineEdges(index, triangles) {
  const uses = new Map();
  for (const t of triangles) {
    for (let k = 0; k < 3; ++k) {
      const a = index[3 * t + k];
      const b = index[3 * t + ((k + 1) % 3)];
      const key = Math.min(a, b) * 4294967296 + Math.max(a, b);
      const known = uses.get(key);
      if (known) known.count += 1;
      else uses.set(key, { a, b, count: 1 });
    }
  }
  return [...uses.values()].filter((edge) => edge.count === 1);
}
