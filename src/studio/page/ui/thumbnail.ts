// A picture of the job for the list of recent ones, when its result is final.
import { effect } from '@preact/signals';
import { api } from '../api.ts';
import { job, readOnly, stage } from '../studio.ts';

const LARGEST_BYTES = 256_000;

export function keepThumbnail(): () => void {
  let done = '';
  let timer = 0;
  const end = effect(() => {
    const open = job.value;
    const result = open?.result.value;
    clearTimeout(timer);
    if (!open || !result || result.quality !== 'normal' || readOnly.value || done === result.result) return;
    timer = window.setTimeout(() => {
      done = result.result;
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
