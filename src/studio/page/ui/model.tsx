// Step 1: the model, its size and how it hangs.
import type { OrientResult } from '../api.ts';
import { addFiles, applyPatch, drawn, hello, job, readOnly, setValue, stage, value } from '../studio.ts';
import { t } from '../strings.ts';
import { Button, ColorField, Files, Group, NumberField, SelectField } from './fields.tsx';
import { Icon } from './icons.tsx';
import { PoseFields } from './pose.tsx';
import { Progress, taskOf } from './progress.tsx';

export const extensions = (types: readonly string[]): string => types.map((type) => `.${type}`).join(',');

export function ModelStep() {
  const open = job.value!;
  const document = open.document.value;
  const mesh = open.mesh.value;
  const types = hello.value!;
  const accept = `${extensions([...types.model_types, ...types.picture_types])},.zip,.toml,.mtl,.bin`;
  if (!document.object?.file) {
    return (
      <Group>
        <p class="soft">{t.stage.emptyHint}</p>
        <Files name="open-model" label={t.model.open} icon="file" kind="main" accept={accept} many onFiles={(files) => void addFiles(files)} />
      </Group>
    );
  }
  return (
    <>
      <Group>
        <div class="row">
          <span class="filename" title={document.object.file}><Icon name="file" /><span>{document.object.file}</span></span>
          <Button name="reload" label={t.model.reload} icon="reload" iconOnly kind="quiet" onClick={() => void open.reload()} />
          <Files name="open-model" label={t.model.replace} accept={accept} many onFiles={(files) => void addFiles(files)} />
        </div>
        <NumberField
          name="size"
          label={t.model.size}
          unit="mm"
          min={0.1}
          max={5000}
          empty={mesh ? String(+mesh.largest_mm.toFixed(1)) : t.model.ownSize}
          value={value<number>('object.size_mm') || null}
          onChange={(next, live) => setValue('object.size_mm', next ?? 0, t.model.size, live)}
        />
        <Extent />
        <ColorField name="base" label={t.model.base} value={value<string>('object.base_color')} onChange={(next, live) => setValue('object.base_color', next, t.model.base, live)} />
        <SelectField
          name="units"
          label={t.model.units}
          value={value<string>('object.units')}
          options={[['', t.model.unitsAuto], ['mm', 'mm'], ['cm', 'cm'], ['m', 'm'], ['in', 'in']]}
          onChange={(next) => setValue('object.units', next, t.model.units)}
        />
      </Group>
      <PoseFields />
      <Orient />
      {mesh && (mesh.health.length > 0 || mesh.simplified) && (
        <Group title={t.model.health}>
          <ul class="notes">
            {mesh.health.map((sentence) => <li key={sentence}>{sentence}</li>)}
            {mesh.simplified && <li>{t.model.simplified}</li>}
          </ul>
        </Group>
      )}
    </>
  );
}

// Ways that cover less are no use; and trials are coarse, so that a little less says nothing.
const LEAST_SHARE = 0.01;
const CLEARLY_LESS = 0.8;

function Orient() {
  const open = job.value!;
  const task = taskOf('orient');
  const found = task?.state === 'done' ? (task.result as OrientResult | null)?.ways : null;
  const ways = found?.filter((way) => way.covered_share >= LEAST_SHARE);
  const best = Math.max(0, ...(ways ?? []).map((way) => way.covered_share));
  const now = open.result.value?.figures['covered_share'] ?? 0;
  return (
    <Group>
      {task?.state === 'running' ? (
        <Progress task={task} title={t.model.suggesting} />
      ) : (
        <Button name="orient" label={t.model.suggest} icon="wrench" changes onClick={() => void open.start('orient', { best: 3 })} />
      )}
      {task?.state === 'failed' && <p class="bad">{task.error?.text}</p>}
      {ways && (
        <>
          <p class="soft">{ways.length ? t.model.ways : t.model.noWays}</p>
          {ways.length > 0 && best < CLEARLY_LESS * now && <p class="soft" data-name="ways-less">{t.model.waysLess(now, best)}</p>}
          <div class="ways">
            {ways.map((way, k) => (
              <button
                key={way.picture + k}
                type="button"
                class="way"
                data-way={k}
                disabled={readOnly.value}
                aria-label={`${t.model.waysLabel(k + 1)}: ${way.text}`}
                title={way.text}
                onClick={() => applyPatch(way.patch, t.undo.hold)}
              >
                <img src={way.picture} alt="" />
                <span>
                  <b>{t.model.covered(way.covered_share)}</b>
                  <small>{t.model.torn(way.torn_share)}</small>
                </span>
              </button>
            ))}
          </div>
        </>
      )}
    </Group>
  );
}

function Extent() {
  drawn.value;
  const size = stage.current?.extent();
  if (!size || size[0] === 0) return null;
  return <p class="fact"><span>{t.model.extent}</span><b>{t.size(...size)}</b></p>;
}
