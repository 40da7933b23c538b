// Step 3: one dip or several, and what they make of the object together.
import { dipCount, hasWay, hasWayOfItsOwn, patched, withAnotherDip, withDip, withoutDip, type JobDocument } from '../document.ts';
import { allDips, change, chooseOverlay, hello, job, overlay, poseOfDip, setValue, showView, value } from '../studio.ts';
import { t } from '../strings.ts';
import { Button, CheckField, Group, NumberField } from './fields.tsx';
import { focusIfLost } from './focus.ts';
import { PoseFields } from './pose.tsx';
import { Progress, taskOf } from './progress.tsx';

export function depthText(document: JobDocument, dip: number): string {
  if (hasWayOfItsOwn(document, dip)) return t.steps.ownWay;
  const { depth_mm } = poseOfDip(document, dip);
  return depth_mm ? t.steps.deep(depth_mm) : t.steps.wholeDepth;
}

export function DipsStep() {
  const open = job.value!;
  const document = open.document.value;
  const dips = document.dips ?? [];
  const plan = taskOf('plan');
  const found = plan?.kind === 'plan' && plan.state === 'done' ? plan.result : null;
  const most = hello.value!.limits.dips;
  const full = dips.length >= most ? { disabled: true, title: t.dips.most(most) } : {};
  return (
    <>
      <Group>
        <p class="soft">{dips.length ? t.dips.several : t.dips.one}</p>
        {dips.length > 0 && (
          <ol class="dips">
            {dips.map((_, k) => <DipRow key={k} at={k} />)}
          </ol>
        )}
        <div class="row wrap">
          <Button name="add-dip" label={t.dips.add} icon="plus" changes {...full} onClick={() => {
            change(withAnotherDip, t.undo.dipAdd);
            open.show(dipCount(open.document.value) - 1);
          }} />
          {dips.length > 1 && plan?.state !== 'running' && (
            <Button name="plan" label={t.dips.search} icon="wrench" changes onClick={() => void open.start('plan', { dips: dips.length })} />
          )}
        </div>
        {plan?.state === 'running' && <Progress task={plan} title={t.dips.searching} />}
        {plan?.state === 'failed' && <p class="bad">{plan.error?.text}</p>}
        {found && (
          <div class="found">
            <p>{found.covered_wanted_share.length > 0
              ? t.dips.foundOfPicture(found.covered_wanted_share.map(t.percent).join(', '))
              : t.dips.found(found.covered_share.map(t.percent).join(', '))}</p>
            {found.warnings.length > 0 && <ul class="notes">{found.warnings.map((warning) => <li key={warning}>{warning}</li>)}</ul>}
            <Button name="apply-plan" label={t.dips.apply} kind="main" changes onClick={() => {
              change((now) => patched(now, found.patch), t.undo.dipPlan);
              open.forgetTask('plan');
            }} />
          </div>
        )}
      </Group>
      {dips.length > 1 && <Together />}
      <PoseFields />
      <Tilt />
    </>
  );
}

// What all dips make of the object.
function Together() {
  const open = job.value!;
  const finish = open.wholeFinish.value;
  const problem = open.finishProblem.value;
  return (
    <Group title={t.dips.together}>
      <CheckField name="all-dips" label={t.dips.whole} checked={allDips.value} always onChange={(on) => {
        allDips.value = on;
        overlay.value = 'none';
        showView('object');
      }} />
      {finish ? (
        <>
          <ul class="facts" data-name="finish" data-seams={finish.seams.length_mm.toFixed(0)}>
            <li>{t.dips.coveredBy(finish.covered_share)}</li>
            {finish.seams.length_mm > 0 && <li>{t.dips.seams(finish.seams.length_mm, finish.seams.overlap_mm)}</li>}
            {finish.seams.length_mm > 0 && <li class="soft">{t.dips.seamError(finish.seams.error_mean, finish.seams.off_mm, finish.seams.error_mean_off)}</li>}
          </ul>
          <Button name="show-parts" label={t.dips.showParts} icon="eye" pressed={overlay.value === 'parts'} onClick={() => chooseOverlay(overlay.value === 'parts' ? 'none' : 'parts')} />
        </>
      ) : (
        <p class={problem ? 'bad' : 'soft'} role="status">{problem || t.dips.joining}</p>
      )}
    </Group>
  );
}

function DipRow({ at }: { at: number }) {
  const open = job.value!;
  const document = open.document.value;
  const dip = document.dips![at]!;
  const shown = open.dip.value === at;
  const result = open.results.value.get(at);
  const part = open.wholeFinish.value?.dips[at];
  return (
    <li class={shown ? 'dip chosen' : 'dip'}>
      <button type="button" class="pick" aria-pressed={shown} data-dip={at} onClick={() => open.show(at)}>
        <DipThumbnail at={at} />
        <span>
          <b>{t.dips.dip(at + 1)}</b>
          <small>{t.model.shortSides[dip.down ?? '-z']}, {depthText(document, at)}</small>
          {part ? (
            <small><i class="chip" style={{ background: part.color }} />{t.dips.prints(part.part_share)}</small>
          ) : (
            result && <small class={`mark ${result.verdict.concern}`}>{t.model.covered(result.figures['covered_share'] ?? 0)}</small>
          )}
        </span>
      </button>
      <Button label={`${t.dips.lock}: ${t.dips.dip(at + 1)}`} icon={dip.locked ? 'lock' : 'unlock'} iconOnly kind="quiet" pressed={dip.locked ?? false} changes
        onClick={() => change((document) => withDip(document, at, { locked: !dip.locked }), t.undo.dipLock)} />
      <Button label={t.dips.remove(at + 1)} icon="trash" iconOnly kind="quiet" changes onClick={() => {
        change((document) => withoutDip(document, at), t.undo.dipRemove);
        focusIfLost('[data-dip]', '[data-name="add-dip"]');
      }} />
    </li>
  );
}

function DipThumbnail({ at }: { at: number }) {
  const result = job.value!.results.value.get(at);
  const sheet = job.value!.wholeFinish.value?.sheets[at] ?? (result && { ...result.sheet, rgba: result.printed });
  if (!sheet) return <span class="letter" aria-hidden="true">{at + 1}</span>;
  const draw = (canvas: HTMLCanvasElement | null): void => {
    if (!canvas) return;
    const { width_px: w, height_px: h, rgba } = sheet;
    const scale = Math.min(44 / w, 44 / h);
    canvas.width = Math.round(w * scale);
    canvas.height = Math.round(h * scale);
    const whole = document.createElement('canvas');
    [whole.width, whole.height] = [w, h];
    whole.getContext('2d')!.putImageData(new ImageData(new Uint8ClampedArray(rgba), w, h), 0, 0);
    canvas.getContext('2d')!.drawImage(whole, 0, 0, canvas.width, canvas.height);
  };
  return <canvas class="thumb" key={`${result?.result} ${sheet.rgba.byteOffset}`} ref={draw} aria-hidden="true" />;
}

function Tilt() {
  const document = job.value!.document.value;
  if (document.dips?.length || hasWay(document)) return null;
  const field = (name: string, label: string, min: number, max: number) => (
    <NumberField key={name} name={name.replace('.', '-')} label={label} unit="°" step={5} min={min} max={max} value={value<number>(name)} onChange={(next, live) => setValue(name, next ?? 0, label, live)} />
  );
  return (
    <Group>
      {field('dip.tilt_deg', t.dips.tilt, -85, 85)}
      {field('dip.tilt_toward_deg', t.dips.toward, -360, 360)}
      {field('dip.roll_deg', t.dips.roll, -170, 170)}
    </Group>
  );
}
