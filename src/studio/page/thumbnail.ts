// A picture of a job for the list of recent ones: of its model as soon as that is to be seen, for jobs that are left
// before anything was computed, then of the first result and of every final one.
import { api, type Result } from './api.ts';
import type { Job } from './job.ts';
import type { Stage } from './stage/stage.ts';

const LARGEST_BYTES = 256_000;

const kept = new Map<string, string>(); // of each job: what its picture is of

// What a picture would be of now; '': of nothing that it is not of already.
export function newPictureOf(open: Job, result: Result | null): string {
  const now = result?.quality === 'normal' ? result.result : result ? 'draft' : 'model';
  const then = kept.get(open.id);
  if (then === undefined || (then === 'model' && now !== 'model')) return now;
  return now !== then && result?.quality === 'normal' ? now : '';
}

// Once it is there, if there is anything to be seen and what it shows has changed.
export async function keepPicture(open: Job, shown: Stage | null): Promise<void> {
  const what = newPictureOf(open, open.result.value);
  const drawing = what && shown?.thumbnail();
  if (!drawing) return;
  kept.set(open.id, what);
  const png = await drawing;
  if (png && png.size < LARGEST_BYTES) await api.thumbnail(open.id, png).catch(() => undefined);
}
