// A picture of the job for the list of recent ones: of its first draft, for jobs that are closed soon, and of every final
// result.
import { effect } from '@preact/signals';
import { api } from '../api.ts';
import { job, readOnly, stage } from '../studio.ts';

const LARGEST_BYTES = 256_000;

export function keepThumbnail(): () => void {
  let done = '';
  let hasOne = '';
  let timer = 0;
  const end = effect(() => {
    const open = job.value;
    const result = open?.result.value;
    clearTimeout(timer);
    if (!open || !result || readOnly.value || done === result.result) return;
    if (result.quality !== 'normal' && hasOne === open.id) return;
    timer = window.setTimeout(() => {
      done = result.result;
      hasOne = open.id;
      void stage.current?.thumbnail().then((png) => {
        if (png && png.size < LARGEST_BYTES && job.value === open) api.thumbnail(open.id, png).catch(() => undefined);
      });
    }, 600);
  });
  return () => {
    clearTimeout(timer);
    end();
  };
}
