// What the program answers, and how to ask it. The page asks nothing else of the outside world.
import type { JobDocument, Json, Patch } from './document.ts';
import { t } from './strings.ts';

export type Concern = 'none' | 'care' | 'stop';
export type Overlay = 'none' | 'stretch' | 'tears' | 'wrinkles' | 'coverage' | 'angle' | 'air' | 'parts';
export type Numbers = readonly number[];

export interface Parameter {
  name: string;
  unit: string;
  type: string;
  min?: number;
  max?: number;
  default: Json;
  zero?: string;
  choices?: string[]; // of those that have some
  help: string;
}

export interface Recent {
  job: string;
  name: string;
  where: string;
  changed: string;
  unsaved: boolean;
  open: boolean; // in another tab, or in another studio
  recovered: boolean;
  thumbnail: string;
}

export interface Hello {
  version: string;
  run: string;
  opened: string | null;
  samples: { name: string; text: string }[];
  films: { name: string; width_mm: number; height_mm: number }[];
  parameters: Parameter[];
  profiles: string[];
  recent: Recent[];
  limits: { file_bytes: number; job_bytes: number; document_bytes: number; layers: number; dips: number };
  model_types: string[];
  picture_types: string[];
}

export interface JobFile {
  file: string;
  kind: 'model' | 'picture' | 'job' | 'archive' | 'part' | 'unknown';
  bytes: number;
}

export interface Mend {
  text: string;
  patch: Patch;
  task?: { kind: TaskKind }; // what helps is a search, and no change by itself
}

export interface Verdict {
  concern: Concern;
  headline: string;
  short?: string; // some words of it
  text: string;
}

export interface Finding {
  key: string;
  concern: Concern;
  title: string;
  figure: string;
  text: string;
  advice: string;
  overlay: Overlay | '';
  at_mm: [number, number, number] | null;
  mends: Mend[];
}

export interface Way {
  text: string;
  covered_share: number;
  torn_share: number;
  doubtful_share: number;
  score: number;
  picture: string;
  patch: Patch;
}

export interface PrintResult {
  where: string;
  verdict: Verdict;
  files: { file: string; text: string; bytes: number; url: string }[];
  zip: string;
  warnings: string[];
}

export interface OrientResult {
  ways: Way[];
}

export interface PlanResult {
  covered_share: number[];
  covered_wanted_share: number[]; // of what shall be printed; none: everywhere
  dips: { text: string; gained_share: number; covered_share: number; torn_share: number; picture: string }[];
  patch: Patch;
  warnings: string[];
}

interface TaskCommon {
  task: string;
  state: 'running' | 'done' | 'failed' | 'cancelled';
  revision: number;
  activity: string;
  fraction: number;
  elapsed_s: number;
  left_s: number | null;
  error: { code: string; text: string } | null;
}

export type Task = TaskCommon &
  (
    | { kind: 'print'; result: PrintResult | null }
    | { kind: 'orient'; result: OrientResult | null }
    | { kind: 'plan'; result: PlanResult | null }
  );
export type TaskKind = Task['kind'];

export interface JobState {
  job: string;
  name: string;
  where: string;
  revision: number;
  saved_revision: number;
  document: JobDocument;
  dip: number;
  files: JobFile[];
  mesh: string | null;
  tasks: Task[];
  result: string | null;
}

export interface Adopted {
  file: string;
  as: 'model' | 'layer' | 'job' | 'part' | 'unused';
  text: string;
}

export interface AdoptAnswer {
  revision: number;
  document: JobDocument;
  adopted: Adopted[];
}

export interface Problem {
  revision: number;
  code: 'no-model' | 'input' | 'dip' | 'memory';
  text: string;
  mends: Mend[];
}

// --- Bundles ---

export interface MeshData {
  mesh: string;
  triangles: number;
  simplified: boolean;
  low_mm: Numbers;
  high_mm: Numbers;
  largest_mm: number;
  units: string;
  closed: boolean;
  has_colors: boolean;
  health: string[];
  groups: { material: number; start: number; count: number }[];
  materials: { color: number[]; texture: number; wrap: [string, string] }[];
  textures: string[];
  position: Float32Array;
  normal: Float32Array;
  uv: Float32Array | null;
  color: Float32Array | null;
  index: Uint32Array;
}

export interface Film {
  u: Float32Array;
  position: Float32Array;
  state: Uint8Array;
  stretch: Float32Array;
  areaRatio: Float32Array;
  index: Uint32Array;
  torn: Uint8Array;
  wrinkled: Uint8Array;
  lying: number[]; // triangles on the object
  tornList: number[];
  wrinkledList: number[]; // of those that lie
}

// A sketch follows the hand, a draft comes when it stops, and then the normal result.
export type Quality = 'sketch' | 'draft' | 'normal';

export interface Result {
  result: string;
  revision: number;
  quality: Quality;
  dip: number;
  dips: number;
  matrix: number[];
  scale: number;
  depth_mm: number;
  hold: string;
  film: { width_mm: number; height_mm: number; margin_mm: number; shape: string; cell_mm: number; tear_stretch: number };
  bath: { width_mm: number; height_mm: number; depth_mm: number };
  sheet: { width_px: number; height_px: number };
  verdict: Verdict;
  findings: Finding[];
  figures: Record<string, number>;
  artwork: { size_mm: [number, number]; stretch: [number, number] }[];
  dry_layers: number[]; // that get no film, or hardly any, from this dip
  warnings: string[];
  filmMesh: Film;
  printed: Uint8Array;
  predicted: Uint8Array;
  air: { position: Float32Array; index: Uint32Array } | null;
  lids: { position: Float32Array; index: Uint32Array } | null;
}

// All dips together.
export interface Finish {
  finish: string;
  mesh: string; // the model as it looks in the end
  parts: string; // and in a colour for each dip
  covered_share: number;
  verdict: Verdict;
  findings: Finding[];
  dry_layers: number[]; // to which none of the dips brings film
  dips: { part_share: number; gained_share: number; covered_share: number; torn_share: number; color: string; width_px: number; height_px: number }[];
  seams: { length_mm: number; overlap_mm: number; error_mean: number; off_mm: number; error_mean_off: number };
  sheets: SheetPicture[];
}

export interface SheetPicture {
  width_px: number;
  height_px: number;
  rgba: Uint8Array;
}

export interface DipFrames {
  levels: number[];
  poses: number[][] | null;
  frames: Float32Array;
  attachedFrom: Uint8Array;
}

interface ArrayPlace {
  type: 'f32' | 'u32' | 'u16' | 'u8' | 'i8';
  width: number;
  count: number;
  offset: number;
}

type TypedArray = Float32Array | Uint32Array | Uint16Array | Uint8Array | Int8Array;
const VIEWS = { f32: Float32Array, u32: Uint32Array, u16: Uint16Array, u8: Uint8Array, i8: Int8Array };

interface Bundle {
  json: Record<string, unknown>;
  array<T extends TypedArray>(name: string): T | null;
}

export function readBundle(buffer: ArrayBuffer): Bundle {
  const magic = new TextDecoder().decode(new Uint8Array(buffer, 0, 4));
  if (magic !== 'HDB1') throw new Error('This is no answer that the page can read.');
  const length = new DataView(buffer).getUint32(4, true);
  const json = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 8, length))) as Record<string, unknown>;
  const places = (json['arrays'] ?? {}) as Record<string, ArrayPlace>;
  return {
    json,
    array<T extends TypedArray>(name: string): T | null {
      const place = places[name];
      if (!place) return null;
      return new VIEWS[place.type](buffer, 8 + length + place.offset, place.width * place.count) as T;
    },
  };
}

const demand = <T>(value: T | null, what: string): T => {
  if (value === null) throw new Error(`The answer lacks ${what}.`);
  return value;
};

export function readMesh(buffer: ArrayBuffer): MeshData {
  const { json, array } = readBundle(buffer);
  const packed = demand(array<Int8Array>('normal'), 'normal');
  const normal = new Float32Array((packed.length / 4) * 3);
  for (let i = 0, n = packed.length / 4; i < n; ++i) {
    for (let k = 0; k < 3; ++k) normal[3 * i + k] = packed[4 * i + k]! / 127;
  }
  const bytes = array<Uint8Array>('color');
  return {
    ...(json as unknown as MeshData),
    position: demand(array<Float32Array>('position'), 'position'),
    normal,
    uv: array<Float32Array>('uv'),
    color: bytes && Float32Array.from(bytes, (value) => value / 255),
    index: demand(array<Uint32Array>('index'), 'index'),
  };
}

export function readResult(buffer: ArrayBuffer): Result {
  const { json, array } = readBundle(buffer);
  const film = {
    u: demand(array<Float32Array>('film.u'), 'film.u'),
    position: demand(array<Float32Array>('film.position'), 'film.position'),
    state: demand(array<Uint8Array>('film.state'), 'film.state'),
    stretch: demand(array<Float32Array>('film.stretch'), 'film.stretch'),
    areaRatio: demand(array<Float32Array>('film.area_ratio'), 'film.area_ratio'),
    index: demand(array<Uint32Array>('film.index'), 'film.index'),
    torn: demand(array<Uint8Array>('film.torn'), 'film.torn'),
    wrinkled: demand(array<Uint8Array>('film.wrinkled'), 'film.wrinkled'),
  };
  const lying: number[] = [];
  const tornList: number[] = [];
  const wrinkledList: number[] = [];
  for (let t = 0; t < film.index.length / 3; ++t) {
    const met = [0, 1, 2].every((k) => film.state[film.index[3 * t + k]!] === 1);
    if (met) (film.torn[t] ? tornList : lying).push(t);
    if (met && film.wrinkled[t] && !film.torn[t]) wrinkledList.push(t);
  }
  const surface = (name: string): Result['air'] => {
    const position = array<Float32Array>(`${name}.position`);
    const index = array<Uint32Array>(`${name}.index`);
    return position && index && index.length ? { position, index } : null;
  };
  return {
    ...(json as unknown as Result),
    filmMesh: { ...film, lying, tornList, wrinkledList },
    printed: demand(array<Uint8Array>('sheet.printed'), 'sheet.printed'),
    predicted: demand(array<Uint8Array>('sheet.predicted'), 'sheet.predicted'),
    air: surface('air'),
    lids: surface('lids'),
  };
}

export function readFinish(buffer: ArrayBuffer): Finish {
  const { json, array } = readBundle(buffer);
  const finish = json as unknown as Finish;
  return {
    ...finish,
    sheets: finish.dips.map(({ width_px, height_px }, k) => ({ width_px, height_px, rgba: demand(array<Uint8Array>(`sheet.${k}`), `sheet ${k}`) })),
  };
}

export function readDip(buffer: ArrayBuffer): DipFrames {
  const { json, array } = readBundle(buffer);
  return {
    levels: json['levels_mm'] as number[],
    poses: (json['poses'] as number[][] | undefined) ?? null,
    frames: demand(array<Float32Array>('position'), 'position'),
    attachedFrom: demand(array<Uint8Array>('attached_from'), 'attached_from'),
  };
}

// --- Requests ---

export class ApiError extends Error {
  constructor(
    readonly code: string,
    text: string,
    readonly field: string | null,
    readonly body: Record<string, unknown>,
  ) {
    super(text);
  }
}

// The program cannot be reached.
export class Unreachable extends Error {
  constructor() {
    super(t.link.lost);
  }
}

async function ask(path: string, init: RequestInit = {}): Promise<Response> {
  let response: Response;
  try {
    response = await fetch(path, { ...init, headers: { 'X-Hydrodip': '1', ...(init.headers ?? {}) } });
  } catch (error) {
    if (error instanceof DOMException && error.name === 'AbortError') throw error;
    throw new Unreachable();
  }
  if (response.ok) return response;
  const body = (await response.json().catch(() => ({}))) as Record<string, unknown>;
  const error = (body['error'] ?? {}) as { code?: string; text?: string; field?: string };
  throw new ApiError(error.code ?? 'failed', error.text ?? `${response.status} ${response.statusText}`, error.field ?? null, body);
}

const json = async <T>(path: string, method: string, body?: unknown): Promise<T> => {
  const init: RequestInit = { method };
  if (body !== undefined) {
    init.body = JSON.stringify(body);
    init.headers = { 'Content-Type': 'application/json' };
  }
  const response = await ask(path, init);
  return (response.status === 204 ? null : await response.json()) as T;
};

const part = encodeURIComponent;

// A bundle; ApiError 'replaced' where a newer one has taken its place.
const bytes = async (path: string): Promise<ArrayBuffer> => {
  const response = await ask(path);
  if (response.status === 204) throw new ApiError('replaced', '', null, {});
  return response.arrayBuffer();
};

export const api = {
  hello: (client: string) => json<Hello>(`/api/hello?client=${part(client)}`, 'GET'),
  recent: (client: string) => json<Recent[] | { recent: Recent[] }>(`/api/recent?client=${part(client)}`, 'GET').then((r) => (Array.isArray(r) ? r : r.recent)),
  forget: (job: string) => json<unknown>(`/api/recent/${part(job)}`, 'DELETE'),
  profile: (job: string, name: string) => json<{ patch: Patch }>(`/api/jobs/${part(job)}/profiles/${part(name)}`, 'GET').then((r) => r.patch),
  saveProfile: (job: string, name: string) => json<{ profiles: string[] }>(`/api/jobs/${part(job)}/profiles/${part(name)}`, 'PUT', {}).then((r) => r.profiles),
  create: (from: { sample?: string; job?: string }) => json<{ job: string }>('/api/jobs', 'POST', from),
  job: (job: string) => json<JobState>(`/api/jobs/${part(job)}`, 'GET'),
  reload: (job: string) => json<unknown>(`/api/jobs/${part(job)}/reload`, 'POST', {}),
  upload: async (job: string, file: File, name: string) =>
    (await (
      await ask(`/api/jobs/${part(job)}/files/${name.split('/').map(part).join('/')}`, { method: 'PUT', body: file })
    ).json()) as { file: string; kind: JobFile['kind'] },
  adopt: (job: string, files: string[], client: string) => json<AdoptAnswer>(`/api/jobs/${part(job)}/adopt`, 'POST', { files, client }),
  put: (job: string, body: { client: string; base: number; document: JobDocument; live: boolean; dip: number }) =>
    json<{ revision: number }>(`/api/jobs/${part(job)}/document`, 'PUT', body),
  save: (job: string) => json<{ where: string; saved_revision: number }>(`/api/jobs/${part(job)}/save`, 'POST', {}),
  pen: (job: string, client: string) => json<unknown>(`/api/jobs/${part(job)}/pen`, 'POST', { client }),
  thumbnail: (job: string, png: Blob) => ask(`/api/jobs/${part(job)}/thumbnail`, { method: 'PUT', body: png }),
  start: (job: string, body: { kind: TaskKind; best?: number; dips?: number }) =>
    json<{ task: string }>(`/api/jobs/${part(job)}/tasks`, 'POST', body),
  cancel: (job: string, task: string) => json<unknown>(`/api/jobs/${part(job)}/tasks/${part(task)}`, 'DELETE'),
  mesh: async (job: string, mesh: string) => readMesh(await bytes(`/api/jobs/${part(job)}/meshes/${part(mesh)}`)),
  result: async (job: string, result: string) => readResult(await bytes(`/api/jobs/${part(job)}/results/${part(result)}`)),
  finish: async (job: string, finish: string) => readFinish(await bytes(`/api/jobs/${part(job)}/finish/${part(finish)}`)),
  dip: async (job: string, result: string) => readDip(await bytes(`/api/jobs/${part(job)}/results/${part(result)}/dip`)),
  fileUrl: (job: string, file: string) => `/api/jobs/${part(job)}/files/${file.split('/').map(part).join('/')}`,
  tomlUrl: (job: string) => `/api/jobs/${part(job)}/job.toml`,
  zipUrl: (job: string) => `/api/jobs/${part(job)}/job.zip`,
  eventsUrl: (job: string, client: string) => `/api/jobs/${part(job)}/events?client=${part(client)}`,
};
