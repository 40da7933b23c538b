// The steps on the left, in the order of the work; one is open, the others say in a line what they are.
import type { ComponentChildren } from 'preact';
import { layersOf } from '../document.ts';
import { goToStep, job, step, STEPS, value, type StepName } from '../studio.ts';
import { t } from '../strings.ts';
import { ArtworkStep } from './artwork.tsx';
import { depthText, DipsStep } from './dips.tsx';
import { FilmStep, sheetName } from './film.tsx';
import { useFocusHandedTo } from './focus.ts';
import { ModelStep } from './model.tsx';

export function Steps() {
  return (
    <nav class="steps" aria-label={t.steps.title}>
      <ol>
        {STEPS.map((name, k) => <Step key={name} name={name} number={k + 1} />)}
      </ol>
    </nav>
  );
}

const BODIES: Record<StepName, () => ComponentChildren> = {
  model: () => <ModelStep />,
  artwork: () => <ArtworkStep />,
  dips: () => <DipsStep />,
  film: () => <FilmStep />,
};

function Step({ name, number }: { name: StepName; number: number }) {
  const open = step.value === name;
  return (
    <li class={open ? 'step open' : 'step'}>
      <h2>
        <button type="button" aria-expanded={open} aria-controls={`step-${name}`} data-step={name} onClick={() => goToStep(name)}>
          <span class="number" aria-hidden="true">{number}</span>
          <span class="name">{t.steps[name]}</span>
          <span class="summary" title={summaryOf(name)}>{summaryOf(name)}</span>
        </button>
      </h2>
      {open && <StepBody name={name} />}
    </li>
  );
}

function StepBody({ name }: { name: StepName }) {
  const box = useFocusHandedTo(() => `button[data-step="${step.value}"]`);
  return <div class="body" id={`step-${name}`} ref={box}>{BODIES[name]()}</div>;
}

function summaryOf(name: StepName): string {
  const open = job.value;
  if (!open) return '';
  const document = open.document.value;
  switch (name) {
    case 'model':
      return document.object?.file ?? t.steps.noModel;
    case 'artwork':
      return t.steps.layers(layersOf(document).length, open.dryLayers.value.length);
    case 'dips':
      return document.dips?.length ? t.steps.manyDips(document.dips.length, open.wholeFinish.value?.covered_share ?? null) : t.steps.oneDip(depthText(document, 0));
    case 'film':
      return t.steps.sheet(sheetName(), value<number>('print.dpi'));
  }
}
