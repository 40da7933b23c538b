// The keys, as slicers have them. While something is typed only those with Ctrl and Escape count.
import { batch } from '@preact/signals';
import { layersOf } from '../document.ts';
import { bigSheet, chooseTool, goToStep, job, layer, panel, readOnly, stage, STEPS, tool } from '../studio.ts';
import { focusOn } from './focus.ts';
import { removeLayer } from './artwork.tsx';
import { askPrint, askSave } from './top.tsx';
import { playDip } from './view.tsx';

const PLAIN: Record<string, () => void> = {
  r: () => chooseTool('turn'),
  m: () => chooseTool('move'),
  f: () => chooseTool('face'),
  z: () => stage.current?.fit(),
  s: () => {
    goToStep('model');
    focusOn('input[name="size"]');
  },
  a: () => {
    goToStep('artwork');
    focusOn('input[name="add-picture"]');
  },
  '?': () => {
    panel.value = panel.value === 'keys' ? 'none' : 'keys';
  },
  ' ': playDip,
  Delete: () => {
    const at = layer.value;
    if (at !== null && !readOnly.value && layersOf(job.value!.document.value)[at]) removeLayer(at);
  },
};
STEPS.forEach((name, k) => {
  PLAIN[String(k + 1)] = () => goToStep(name);
});

const WITH_CONTROL: Record<string, (shift: boolean) => void> = {
  z: (shift) => (shift ? job.value?.redo() : job.value?.undo()),
  y: () => job.value?.redo(),
  s: askSave,
  p: askPrint,
};

const isTyped = (target: EventTarget | null): boolean =>
  target instanceof HTMLElement && target.matches('input:not([type=range], [type=checkbox], [type=file], [type=color]), textarea, select');

function escape(): void {
  batch(() => {
    if (panel.value !== 'none') panel.value = 'none';
    else if (tool.value !== 'none') tool.value = 'none';
    else layer.value = null;
  });
}

function pressed(event: KeyboardEvent): void {
  if (!job.value || event.altKey || event.defaultPrevented) return;
  const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
  if (event.ctrlKey || event.metaKey) {
    const action = WITH_CONTROL[key];
    if (!action) return;
    event.preventDefault();
    // What is being typed counts first.
    if (event.target instanceof HTMLElement && isTyped(event.target)) event.target.blur();
    action(event.shiftKey);
    return;
  }
  if (key === 'Escape') return escape();
  if (isTyped(event.target)) return;
  const target = event.target as HTMLElement;
  if (key === 'Tab') {
    // Only where a pointer put the focus into the view: else it leads on, as everywhere.
    const back = bigSheet.value && target.matches('body, .work');
    if (event.shiftKey || !(back || target.dataset['byPointer'])) return;
    event.preventDefault();
    bigSheet.value = !bigSheet.value;
    return;
  }
  if (key === ' ' && target.closest('button, summary, [role=button], input, label, .panel')) return;
  const action = PLAIN[key];
  if (!action) return;
  event.preventDefault();
  action();
}

export function listenToKeys(): () => void {
  window.addEventListener('keydown', pressed);
  return () => window.removeEventListener('keydown', pressed);
}
