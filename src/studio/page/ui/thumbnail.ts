// Keeps the picture of the open job, when the hand rests.
import { effect } from '@preact/signals';
import { drawn, job, readOnly, stage } from '../studio.ts';
import { keepPicture, newPictureOf } from '../thumbnail.ts';

const REST_MS = 600;

export function keepThumbnail(): () => void {
  let waits = '';
  let timer = 0;
  const end = effect(() => {
    drawn.value;
    const open = job.value;
    const what = open && !readOnly.value ? newPictureOf(open, open.result.value) : '';
    if (what === waits) return;
    clearTimeout(timer);
    waits = what;
    if (!open || !what) return;
    timer = window.setTimeout(() => {
      waits = '';
      if (job.value === open) void keepPicture(open, stage.current);
    }, what === 'model' ? 0 : REST_MS);
  });
  return () => {
    clearTimeout(timer);
    end();
  };
}
