// What the page shows beside the job: which step, view and tool, and what the keys do.
import { computed, signal } from '@preact/signals';
import { api, type Hello, type Overlay, type Recent } from './api.ts';
import {
  hasWay, hasWayOfItsOwn, layersOf, patched, poseInPatch, poseOf, valueOf, withoutWayOf, withPose, withTiltTurned, withValue, type Json, type JobDocument, type Patch, type Pose, type Vec3,
} from './document.ts';
import type { Box } from './free.ts';
import { Job } from './job.ts';
import { heightOf, leant, turnOf } from './stage/pose.ts';
import type { Compare, Hit, Stage, Tool, View } from './stage/stage.ts';
import { t } from './strings.ts';
import { keepPicture } from './thumbnail.ts';

export type StepName = 'model' | 'artwork' | 'dips' | 'film';
export const STEPS: readonly StepName[] = ['model', 'artwork', 'dips', 'film'];
export type Panel = 'none' | 'verdict' | 'print' | 'keys' | 'save';

export const hello = signal<Hello | null>(null);
export const recent = signal<readonly Recent[]>([]);
export const job = signal<Job | null>(null);
export const failure = signal('');
export const step = signal<StepName>('model');
export const view = signal<View>('bath');
export const compare = signal<Compare>('both');
export const overlay = signal<Overlay>('none');
export const tool = signal<Tool>('none');
export const panel = signal<Panel>('none');
export const covering = signal<Box | null>(null); // the open panel, in the window
export const bigSheet = signal(false);
export const divider = signal(0.5);
export const level = signal(-1); // mm; negative: over the water
export const playing = signal(false);
export const layer = signal<number | null>(null);
export const allDips = signal(false);
export const pointed = signal<{ hit: Hit | null; u: [number, number] | null }>({ hit: null, u: null });
export const drawn = signal(0); // counts pictures of the 3D view, for what has to follow them
export const printToShow = signal(''); // task: a print whose end nobody has seen yet
export const dropping = signal(false);
export const arriving = signal(false); // files, of which a job is begun
export const narrow = signal(false);
export const stage: { current: Stage | null } = { current: null };

export const defaults = computed(() => new Map<string, Json>((hello.value?.parameters ?? []).map((p) => [p.name, p.default])));
export const readOnly = computed(() => narrow.value || (job.value !== null && !job.value.mayChange.value));
export const scale = computed(() => {
  const size = value<number>('object.size_mm');
  const largest = job.value?.mesh.value?.largest_mm ?? 0;
  return size > 0 && largest > 0 ? size / largest : 1;
});

export const pose = computed<Pose>(() => {
  const open = job.value;
  if (!open) return { down: '-z', rotate_deg: [0, 0, 0], depth_mm: 0, shift_mm: [0, 0] };
  return poseOfDip(open.document.value, open.dip.value);
});

// A dip's pose as it is shown everywhere: no deeper than the object is tall, 0 for all of it.
export function poseOfDip(document: JobDocument, dip: number): Pose {
  const now = poseOf(document, dip);
  if (now.depth_mm <= 0) return now;
  const whole = wholeDepth(now);
  return whole > 0 && now.depth_mm >= whole ? { ...now, depth_mm: 0 } : now;
}

export function value<T extends Json>(name: string): T {
  return valueOf<T>(job.value?.document.value ?? {}, defaults.value, name);
}

// Every change of the job goes through here.
export function change(edit: (document: JobDocument) => JobDocument, label: string, live = false): void {
  const open = job.value;
  if (!open || readOnly.value) return;
  const next = edit(open.document.value);
  if (live) open.drag(next);
  else open.commit(next, label);
}

export const setValue = (name: string, next: Json, label: string, live = false): void =>
  change((document) => withValue(document, defaults.value, name, next), label, live);

// A shifted way has to say how deep the whole object is, to a tenth of a millimetre. 0: not known yet.
export function wholeDepth(of: Pose): number {
  const mesh = job.value?.mesh.value;
  return mesh ? Math.floor(10 * heightOf(mesh.position, turnOf(of), scale.value)) / 10 : 0;
}

// The document with another pose of that dip.
function posed(document: JobDocument, dip: number, part: Partial<Pose>): JobDocument {
  const shifts = part.shift_mm?.some((s) => s !== 0) ?? false;
  const from = shifts ? withTiltTurned(document) : document; // no path leans besides
  const now = poseOf(from, dip);
  const shifted = now.shift_mm.some((s) => s !== 0);
  if (shifted && now.depth_mm >= wholeDepth(now)) now.depth_mm = 0;
  const next = { ...now, ...part };
  return withPose(from, dip, next, next.shift_mm.some((s) => s !== 0) ? wholeDepth(next) : 0);
}

// Of a dip with a way of its own: its depth and shift are not to be had.
export const ownWay = computed(() => job.value !== null && hasWayOfItsOwn(job.value.document.value, job.value.dip.value));

export function changePose(part: Partial<Pose>, live = false): void {
  const open = job.value;
  if (!open) return;
  const label = part.depth_mm !== undefined && !part.rotate_deg ? t.undo.depth : part.shift_mm ? t.undo.shift : t.undo.turn;
  const { depth_mm: _, shift_mm: __, ...turns } = part;
  const allowed = ownWay.value ? turns : part;
  if (Object.keys(allowed).length) change((document) => posed(document, open.dip.value, allowed), label, live);
}

// A change that the program offers. It speaks of an only dip: of several, that of the one that is shown.
export function applyPatch(patch: Patch, label: string): void {
  const open = job.value;
  if (!open) return;
  const says = (document: JobDocument): boolean => !document.dips?.length && !hasWay(document);
  change((document) => (says(document) ? patched(document, patch) : patchedDip(document, open.dip.value, patch)), label);
}

function patchedDip(document: JobDocument, dip: number, patch: Patch): JobDocument {
  const { pose, tilt, straight, rest } = poseInPatch(patch);
  let next = patched(document, rest);
  if (tilt) {
    const now = { ...poseOf(next, dip), ...pose };
    pose.rotate_deg = tilt.tilt_deg ? leant(now, tilt.tilt_deg, tilt.toward_deg) : now.rotate_deg;
    next = withTiltTurned(next);
  }
  if (straight) next = withoutWayOf(next, dip);
  return Object.keys(pose).length ? posed(next, dip, pose) : next;
}

export function goStraightDown(): void {
  const open = job.value;
  if (open) change((document) => withoutWayOf(document, open.dip.value), t.undo.straight);
}

export const chosenLayer = computed(() => {
  const at = layer.value;
  return at === null ? null : (layersOf(job.value?.document.value ?? {})[at] ?? null);
});

// --- Opening ---

export const CLIENT = (() => {
  const known = sessionStorage.getItem('hydrodip-client');
  // A duplicated tab brings the first one's storage along: it must not pass for it.
  const fresh = `c${crypto.getRandomValues(new Uint32Array(2)).join('')}`;
  const navigation = performance.getEntriesByType('navigation')[0] as PerformanceNavigationTiming | undefined;
  const client = known && navigation?.type === 'reload' ? known : fresh;
  sessionStorage.setItem('hydrodip-client', client);
  return client;
})();

export async function openJob(id: string): Promise<Job | null> {
  if (job.value?.id === id) return job.value;
  void leave();
  resetView();
  const next = new Job(id, CLIENT);
  try {
    await next.open();
  } catch (error) {
    failure.value = error instanceof Error ? error.message : String(error);
    job.value = null;
    return null;
  }
  return shown(next);
}

function shown(next: Job): Job {
  failure.value = '';
  job.value = next;
  const hash = `#job=${encodeURIComponent(next.id)}`;
  if (location.hash !== hash) history.pushState(null, '', hash);
  return next;
}

const isBegun = ({ object, artwork }: JobDocument): boolean => !!object?.file || !!artwork?.length;

// A job of these files. Where nothing comes of them there is none: the page says why, and stays.
async function beginWith(files: readonly File[]): Promise<void> {
  failure.value = '';
  arriving.value = true;
  try {
    const { job: id } = await api.create({});
    const next = new Job(id, CLIENT);
    await next.load();
    await next.add(files, null);
    if (isBegun(next.document.value)) {
      resetView();
      shown(next).listen();
    } else {
      next.close();
      failure.value = next.notice.value?.text ?? t.start.nothingOfIt;
      await api.forget(id);
    }
  } catch (error) {
    failure.value ||= error instanceof Error ? error.message : String(error);
  } finally {
    arriving.value = false;
  }
}

function complain(text: string): void {
  if (job.value) job.value.notice.value = { kind: 'error', text };
  else failure.value = text;
}

function resetView(): void {
  step.value = 'model';
  view.value = 'bath';
  overlay.value = 'none';
  tool.value = 'none';
  panel.value = 'none';
  bigSheet.value = false;
  level.value = -1;
  layer.value = null;
  playing.value = false;
  allDips.value = false;
  printToShow.value = '';
}

export async function createJob(from: { sample?: string; job?: string } = {}): Promise<Job | null> {
  try {
    const { job: id } = await api.create(from);
    return await openJob(id);
  } catch (error) {
    failure.value = error instanceof Error ? error.message : String(error);
    return null;
  }
}

// What it looks like is kept first. Until that is there.
function leave(): Promise<void> {
  const open = job.value;
  if (!open) return Promise.resolve();
  const pictured = readOnly.value ? Promise.resolve() : keepPicture(open, stage.current);
  open.close();
  return pictured;
}

export async function goToStart(): Promise<void> {
  const pictured = leave();
  job.value = null;
  resetView();
  history.pushState(null, '', location.pathname);
  await pictured;
  recent.value = await api.recent(CLIENT).catch(() => recent.value);
}

let arrival: Promise<void> = Promise.resolve(); // what is dropped meanwhile comes after it

// The number of the last layer that came of them, if one did.
export async function addFiles(given: readonly File[], at_mm: Vec3 | null = null): Promise<number | null> {
  const most = hello.value?.limits.file_bytes ?? Infinity;
  const files = given.filter((file) => file.size <= most);
  const large = given.find((file) => file.size > most);
  if (large) complain(t.notice.tooLarge(large.name, most));
  if (!files.length) return null;
  const before = layersOf(job.value?.document.value ?? {}).length;
  const take = (): Promise<void> => (job.value ? job.value.add(files, at_mm) : beginWith(files));
  arrival = arrival.then(take, take);
  await arrival;
  const open = job.value;
  if (!open) return null;
  const now = layersOf(open.document.value).length;
  if (now <= before) return null;
  layer.value = now - 1;
  if (open.document.value.object?.file) goToStep('artwork');
  return now - 1;
}

const jobOfAddress = (): string | null => new URLSearchParams(location.hash.slice(1)).get('job');

export async function begin(): Promise<void> {
  const answer = await api.hello(CLIENT);
  hello.value = answer;
  recent.value = answer.recent;
  const wanted = jobOfAddress() ?? answer.opened;
  if (wanted) await openJob(wanted);
  window.addEventListener('popstate', () => {
    const id = jobOfAddress();
    if (id) void openJob(id);
    else if (job.value) void goToStart();
  });
  window.addEventListener('beforeunload', (event) => {
    if (job.value?.pending.value) event.preventDefault();
  });
}

// --- View ---

export function goToStep(name: StepName): void {
  step.value = name;
  bigSheet.value = false;
  if (name === 'artwork') showView('object');
  if (name === 'model' || name === 'dips') showView('bath');
}

export function showView(name: View): void {
  view.value = name;
  bigSheet.value = false;
  if (name === 'object') tool.value = tool.value === 'face' ? 'face' : 'none';
  if (name === 'object') playing.value = false;
}

export function chooseTool(name: Tool): void {
  if (readOnly.value || (name === 'move' && ownWay.value)) return;
  tool.value = tool.value === name ? 'none' : name;
  if (tool.value === 'turn' || tool.value === 'move') showView('bath');
  if (tool.value !== 'none') {
    playing.value = false;
    level.value = -1;
  }
  bigSheet.value = false;
}

export function chooseOverlay(key: Overlay): void {
  overlay.value = key;
  if (key !== 'none') showView('object');
  if (key !== 'none' && compare.value === 'wanted') compare.value = 'both';
}
