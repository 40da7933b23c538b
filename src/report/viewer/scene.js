// Reads what scene.cpp and packer.cpp wrote into the page.

async function inflate(base64) {
  const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Undoes Packer::add: byte planes, then differences.
function numbers(data, place) {
  const { offset, count, bytes, delta } = place;
  const Type = { 1: Uint8Array, 2: Uint16Array, 4: Uint32Array }[bytes];
  const values = new Type(count);
  for (let i = 0; i < count; ++i) {
    let value = 0;
    for (let plane = 0; plane < bytes; ++plane) {
      value |= data[offset + plane * count + i] << (8 * plane);
    }
    values[i] = i < delta ? value : value + values[i - delta];
  }
  return values;
}

function lengths(data, place) {
  const steps = numbers(data, place);
  const components = place.low.length;
  const values = new Float32Array(steps.length);
  for (let i = 0; i < steps.length; ++i) {
    const k = i % components;
    values[i] = place.low[k] + place.step[k] * steps[i];
  }
  return values;
}

function readObject(data, object) {
  return {
    ...object,
    position: lengths(data, object.position),
    normal: lengths(data, object.normal),
    uv: object.uv && lengths(data, object.uv),
    color: object.color && lengths(data, object.color),
    index: numbers(data, object.index),
  };
}

// Which triangles lie on the object, which of those that met it are torn.
function sortTriangles(film) {
  const lying = [];
  const torn = [];
  for (let t = 0; t < film.index.length / 3; ++t) {
    const met = [0, 1, 2].every((k) => film.state[film.index[3 * t + k]] === 1);
    if (met) (film.torn[t] ? torn : lying).push(t);
  }
  return { lying, torn };
}

function readFilm(data, film) {
  const result = {
    u: lengths(data, film.u),
    index: numbers(data, film.index),
    position: lengths(data, film.position),
    frames: lengths(data, film.frames),
    levels: film.frames.levels, // travelled; straight down the depth, mm
    poses: film.frames.poses, // of the object in the bath; straight down: none
    attachedFrom: numbers(data, film.attached_from),
    state: numbers(data, film.state),
    torn: numbers(data, film.torn),
    stretch: lengths(data, film.stretch),
    areaRatio: lengths(data, film.area_ratio),
  };
  return Object.assign(result, sortTriangles(result));
}

export async function readScene(text) {
  const scene = JSON.parse(text);
  const data = await inflate(scene.data);
  const layers = {};
  const film = readFilm(data, scene.film);
  for (const layer of scene.layers) layers[layer.key] = { ...layer, cells: numbers(data, layer) };
  return {
    ...scene,
    data: null,
    object: readObject(data, scene.object),
    film,
    looks: scene.looks.map(({ key, object }) => ({ key, object: readObject(data, object) })),
    travel_mm: film.poses ? film.levels.at(-1) : scene.depth_mm,
    layers,
  };
}
