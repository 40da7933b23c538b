// The steps on the left, in the order of the work; one is open, the others say in a line what they are.
import { useSignal } from '@preact/signals';
import type { ComponentChildren } from 'preact';
import type { OrientResult, Parameter } from '../api.ts';
import { api } from '../api.ts';
import {
  dipCount, hasWay, hasWayOfItsOwn, isRound, laidAnew, layerName, layersOf, layerWidth, patched, saysAWay, withAnotherDip, withDip, withLayer, withLayerMoved, withNewLayer,
  withoutDip, withoutLayer, withValue, type JobDocument, type Json, type Layer, type Projection, type Side, type Vec3,
} from '../document.ts';
import {
  addFiles, allDips, applyPatch, change, changePose, chooseOverlay, chooseTool, defaults, drawn, goStraightDown, goToStep, hello, job, layer, overlay, ownWay, pose, poseOfDip, readOnly, showView, stage, step,
  STEPS, tool, value, wholeDepth, type StepName,
} from '../studio.ts';
import { t } from '../strings.ts';
import { Button, CheckField, ColorField, Files, NumberField, SegmentsField, SelectField, TextField } from './fields.tsx';
import { focusIfLost, focusOn, takeFocus, useFocusHandedTo } from './focus.ts';
import { frameOf } from './handles.tsx';
import { Icon } from './icons.tsx';
import { Progress, taskOf } from './progress.tsx';

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

function depthText(document: JobDocument, dip: number): string {
  if (hasWayOfItsOwn(document, dip)) return t.steps.ownWay;
  const { depth_mm } = poseOfDip(document, dip);
  return depth_mm ? t.steps.deep(depth_mm) : t.steps.wholeDepth;
}

export function sheetName(): string {
  const [w, h] = [value<number>('film.width_mm'), value<number>('film.height_mm')];
  const film = hello.value?.films.find((f) => (f.width_mm === w && f.height_mm === h) || (f.width_mm === h && f.height_mm === w));
  return film ? (t.film.names[film.name] ?? film.name) : `${w} × ${h} mm`;
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

function Group({ title, children }: { title?: string; children: ComponentChildren }) {
  return (
    <section class="group">
      {title && <h3>{title}</h3>}
      {children}
    </section>
  );
}

const setValue = (name: string, next: Json, label: string, live = false): void =>
  change((document) => withValue(document, defaults.value, name, next), label, live);

// --- 1 Model ---

const extensions = (types: readonly string[]): string => types.map((type) => `.${type}`).join(',');

function ModelStep() {
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

function Extent() {
  drawn.value;
  const size = stage.current?.extent();
  if (!size || size[0] === 0) return null;
  return <p class="fact"><span>{t.model.extent}</span><b>{t.size(...size)}</b></p>;
}

const AXES = ['x', 'y', 'z'] as const;

function PoseFields() {
  const now = pose.value;
  const height = wholeDepth(now);
  return (
    <Group title={t.model.pose}>
      <SelectField
        name="down"
        label={t.model.down}
        value={now.down}
        options={Object.entries(t.model.sides)}
        onChange={(down) => changePose({ down: down as Side })}
      />
      <fieldset class="triple">
        <legend>{t.model.turn}</legend>
        {AXES.map((axis, k) => (
          <NumberField
            key={axis}
            inline
            name={`turn-${axis}`}
            label={axis}
            unit="°"
            min={-3600}
            max={3600}
            step={5}
            value={now.rotate_deg[k]!}
            onChange={(next, live) => changePose({ rotate_deg: now.rotate_deg.map((a, i) => (i === k ? (next ?? 0) : a)) as Vec3 }, live)}
          />
        ))}
      </fieldset>
      <NumberField
        name="depth"
        label={t.model.depth}
        unit="mm"
        min={0}
        max={height || 5000}
        tooMuch={height ? t.model.depthMost(height) : undefined}
        empty={ownWay.value ? t.model.ownWay : t.model.depthWhole}
        hint={t.model.depthHelp}
        disabled={ownWay.value}
        value={now.depth_mm || null}
        onChange={(next, live) => changePose({ depth_mm: next ?? 0 }, live)}
      />
      <fieldset class="triple two">
        <legend>{t.model.shift}</legend>
        {(['x', 'y'] as const).map((axis, k) => (
          <NumberField
            key={axis}
            inline
            name={`shift-${axis}`}
            label={axis}
            unit="mm"
            min={-2000}
            max={2000}
            disabled={ownWay.value}
            value={now.shift_mm[k]!}
            onChange={(next, live) => changePose({ shift_mm: now.shift_mm.map((s, i) => (i === k ? (next ?? 0) : s)) as [number, number] }, live)}
          />
        ))}
      </fieldset>
      {ownWay.value && (
        <>
          <p class="soft">{t.model.ownWayHelp}</p>
          <Button name="straight" label={t.model.straight} changes onClick={goStraightDown} />
        </>
      )}
      <div class="row">
        <Button name="face" label={t.model.face} icon="face" changes pressed={tool.value === 'face'} onClick={() => chooseTool('face')} />
      </div>
      {tool.value === 'face' && <p class="soft">{t.model.faceHint}</p>}
    </Group>
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

// --- 2 Artwork ---

function ArtworkStep() {
  const open = job.value!;
  const layers = layersOf(open.document.value);
  const pictures = extensions(hello.value!.picture_types);
  const most = hello.value!.limits.layers;
  const full = layers.length >= most ? { disabled: true, title: t.artwork.most(most) } : {};
  const add = (next: Layer): void => {
    change((document) => withNewLayer(document, next), t.undo.layerAdd);
    layer.value = layers.length;
  };
  const addPattern = async (files: File[]): Promise<void> => {
    const at = await addFiles(files);
    if (at !== null) change((document) => withLayer(document, at, { projection: 'film', repeat: 'tile', size_mm: 80, at_mm: [0, 0, 0], toward: undefined, up: undefined }), t.undo.layerAdd);
  };
  return (
    <>
      <Group>
        <div class="row wrap">
          <Files name="add-picture" label={t.artwork.picture} icon="picture" accept={pictures} many {...full} onFiles={(files) => void addFiles(files)} />
          <Button name="add-text" label={t.artwork.text} icon="text" changes {...full} onClick={() => {
            add(textThatFits());
            focusOn('[name="words"]');
          }} />
          <Files name="add-pattern" label={t.artwork.pattern} icon="pattern" accept={pictures} {...full} onFiles={(files) => void addPattern(files)} />
        </div>
        {layers.length === 0 && <p class="soft">{t.artwork.none}</p>}
      </Group>
      {layers.length > 0 && (
        <ul class="layers" aria-label={t.artwork.list}>
          {layers.map((entry, k) => <LayerRow key={k} entry={entry} at={k} last={layers.length - 1} />).reverse()}
        </ul>
      )}
      <LayerForm />
    </>
  );
}

// About half as wide as the object shows there: further out a curved face turns away, and would cut the words.
function textThatFits(): Layer {
  const text = { text: t.artwork.newText, font: 'sans bold' };
  const width = frameOf(text)?.width;
  return width ? { ...text, size_mm: Math.max(1, Math.round(5 * width) / 10) } : text;
}

function LayerRow({ entry, at, last }: { entry: Layer; at: number; last: number }) {
  const chosen = layer.value === at;
  const name = layerName(entry);
  const dry = job.value!.dryLayers.value.includes(at);
  const move = (to: number): void => {
    change((document) => withLayerMoved(document, at, to), t.undo.layerOrder);
    layer.value = to;
    focusOn(`[data-name="${to > at ? 'up' : 'down'}-${to}"]`, `[data-layer="${to}"]`);
  };
  return (
    <li class={chosen ? 'layer chosen' : 'layer'}>
      <button type="button" class="pick" aria-pressed={chosen} data-layer={at} title={name} onClick={() => (layer.value = chosen ? null : at)}>
        {entry.image ? <img src={api.fileUrl(job.value!.id, entry.image)} alt="" loading="lazy" /> : <span class="letter" aria-hidden="true"><Icon name="text" /></span>}
        <span>{name}{dry && <small data-name={`dry-${at}`}>{t.artwork.dry}</small>}</span>
      </button>
      <Button name={`up-${at}`} label={`${t.artwork.up}: ${name}`} icon="up" iconOnly kind="quiet" changes disabled={at === last} onClick={() => move(at + 1)} />
      <Button name={`down-${at}`} label={`${t.artwork.down}: ${name}`} icon="down" iconOnly kind="quiet" changes disabled={at === 0} onClick={() => move(at - 1)} />
      <Button label={`${t.artwork.remove}: ${name}`} icon="trash" iconOnly kind="quiet" changes onClick={() => removeLayer(at)} />
    </li>
  );
}

export function removeLayer(at: number): void {
  change((document) => withoutLayer(document, at), t.undo.layerRemove);
  layer.value = null;
  focusIfLost('[data-layer]', '[data-name="add-text"]');
}

function LayerForm() {
  const open = job.value!;
  const at = layer.value;
  const entry = at === null ? null : layersOf(open.document.value)[at];
  if (at === null || !entry) return null;
  const set = (part: Partial<Layer>, live = false, label = t.undo.layer): void => change((document) => withLayer(document, at, part), label, live);
  const laid = open.result.value?.artwork[at];
  const projection = entry.projection ?? 'planar';
  const onFilm = projection === 'film';
  const mesh = open.mesh.value;
  const center = entry.at_mm ?? null;
  return (
    <section class="group" aria-label={layerName(entry)}>
      {entry.text !== undefined && (
        <>
          <TextField name="words" label={t.artwork.words} value={entry.text} rows={2} live onChange={(text, live) => set({ text }, live)} />
          <TextField name="font" label={t.artwork.font} value={entry.font ?? ''} onChange={(font) => set({ font: font || undefined })} />
          <ColorField name="text-color" label={t.artwork.color} value={entry.text_color ?? '#000000'} onChange={(text_color, live) => set({ text_color }, live)} />
        </>
      )}
      <SelectField
        name="projection"
        label={t.artwork.projection}
        value={projection}
        options={Object.entries(t.artwork.projections)}
        barred={mesh && !mesh.uv && projection !== 'uv' ? { uv: t.artwork.noUvs } : {}}
        onChange={(next) => set(laidAnew(entry, next as Projection))}
      />
      <NumberField
        name="layer-width"
        label={t.artwork.width}
        unit="mm"
        min={0.5}
        max={3000}
        empty={laid ? laid.size_mm[0].toFixed(0) : t.artwork.fits}
        value={layerWidth(entry)}
        onChange={(next, live) => set({ size_mm: resized(entry, next) }, live, t.undo.layerSize)}
      />
      <NumberField name="layer-turn" label={t.artwork.turn} unit="°" step={5} min={-3600} max={3600} value={entry.turn_deg ?? 0} onChange={(next, live) => set({ turn_deg: next || undefined }, live, t.undo.layerTurn)} />
      <SelectField name="repeat" label={t.artwork.repeat} value={entry.repeat ?? 'once'} options={Object.entries(t.artwork.repeats)} onChange={(repeat) => set({ repeat: repeat === 'once' ? undefined : (repeat as Layer['repeat']) })} />
      <NumberField name="opacity" label={t.artwork.opacity} unit="%" step={5} min={0} max={100} value={100 * (entry.opacity ?? 1)} onChange={(next, live) => set({ opacity: next === null || next === 100 ? undefined : next / 100 }, live)} />
      {open.dryLayers.value.includes(at) && <p class="said care"><Icon name="care" /> {t.artwork.dryHelp}</p>}
      {laid && <p class="soft" data-name="laid">{t.artwork.laid(...laid.size_mm, onFilm)}{laid.stretch[0] !== laid.stretch[1] ? `, ${t.artwork.stretched(...laid.stretch)}` : ''}</p>}
      {onFilm && <p class="soft">{t.artwork.patternHint}</p>}
      {isRound(projection) && !center && <p class="soft">{t.artwork.roundHint}</p>}
      <details>
        <summary>{t.artwork.more}</summary>
        <fieldset class={onFilm ? 'triple two' : 'triple'}>
          <legend>{onFilm ? t.artwork.onFilm : t.artwork.at}, mm</legend>
          {AXES.slice(0, onFilm ? 2 : 3).map((axis, k) => (
            <NumberField
              key={axis}
              inline
              name={`at-${axis}`}
              label={axis}
              unit="mm"
              unitElsewhere
              empty="–"
              value={center ? center[k]! : null}
              onChange={(next, live) => {
                const from = center ?? [0, 0, 0];
                set({ at_mm: next === null ? undefined : (from.map((c, i) => (i === k ? next : c)) as Vec3) }, live, t.undo.layerMove);
              }}
            />
          ))}
        </fieldset>
        <NumberField name="fade" label={t.artwork.fade} unit="°" min={0} max={90} step={5} value={entry.fade_deg ?? 90} onChange={(next, live) => set({ fade_deg: next === null || next === 90 ? undefined : next }, live)} />
        <SelectField name="blend" label={t.artwork.blend} value={entry.blend ?? 'normal'} options={Object.entries(t.artwork.blends)} onChange={(blend) => set({ blend: blend === 'normal' ? undefined : 'multiply' })} />
        <CheckField name="through" label={t.artwork.through} checked={entry.through ?? false} onChange={(through) => set({ through: through || undefined })} />
      </details>
    </section>
  );
}

// A layer's other measure follows where both are given.
export function resized(entry: Layer, width: number | null): Layer['size_mm'] {
  if (width === null) return undefined;
  const round = (length: number): number => Math.round(length * 10) / 10;
  if (!Array.isArray(entry.size_mm)) return round(width);
  return [round(width), round((width * entry.size_mm[1]) / entry.size_mm[0])];
}

// --- 3 Dips ---

function DipsStep() {
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
            <p>{t.dips.found(found.covered_share.map(t.percent).join(', '))}</p>
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

// --- 4 Film & printer ---

function FilmStep() {
  const films = hello.value!.films;
  const [w, h] = [value<number>('film.width_mm'), value<number>('film.height_mm')];
  const known = films.find((f) => (f.width_mm === w && f.height_mm === h) || (f.width_mm === h && f.height_mm === w));
  const setSheet = (width: number, height: number, live = false): void =>
    change((document) => withValue(withValue(document, defaults.value, 'film.width_mm', width), defaults.value, 'film.height_mm', height), t.undo.sheet, live);
  const number = (name: string, label: string, more: { step?: number } = {}) => {
    const parameter = parameterOf(name);
    return (
      <NumberField key={name} name={name.replace('.', '-')} label={label} unit={unitOf(parameter)} min={parameter?.min} max={parameter?.max} hint={parameter?.help} {...more}
        value={value<number>(name)} onChange={(next, live) => next !== null && setValue(name, next, label, live)} />
    );
  };
  const choice = (name: string, label: string, texts: Record<string, string>) => (
    <SegmentsField key={name} label={label} value={value<string>(name)} options={Object.entries(texts)} onChange={(next) => setValue(name, next, label)} />
  );
  return (
    <>
      <Profiles />
      <Group>
        <div class="row">
          <SelectField
            name="sheet"
            label={t.film.sheet}
            value={known?.name ?? ''}
            options={[...films.map((f) => [f.name, `${t.film.names[f.name] ?? f.name} (${+f.width_mm.toFixed(1)} × ${+f.height_mm.toFixed(1)})`] as const), ['', t.film.custom] as const]}
            onChange={(name) => {
              const film = films.find((f) => f.name === name);
              if (film) setSheet(film.width_mm, film.height_mm);
            }}
          />
          <Button name="turn-sheet" label={t.film.turnSheet} icon="swap" iconOnly changes onClick={() => setSheet(h, w)} />
        </div>
        <NumberField name="film-width" label={t.film.width} unit="mm" min={10} max={3000} value={w} onChange={(next, live) => next && setSheet(next, h, live)} />
        <NumberField name="film-height" label={t.film.height} unit="mm" min={10} max={3000} value={h} onChange={(next, live) => next && setSheet(w, next, live)} />
        {number('film.margin_mm', t.film.margin)}
        {choice('film.shape', t.film.shape, t.film.shapes)}
        {number('material.tear_stretch', t.film.tear, { step: 0.05 })}
      </Group>
      <Group>
        {number('print.dpi', t.film.dpi, { step: 50 })}
        {number('print.bleed_mm', t.film.bleed, { step: 0.5 })}
        {choice('print.ink_side', t.film.ink, t.film.inkSides)}
        {choice('print.color', t.film.color, { rgb: 'RGB', cmyk: 'CMYK' })}
      </Group>
      <ReportPage />
      <Everything />
    </>
  );
}

// The person's own profiles of film, printer and bath.
function Profiles() {
  const open = job.value!;
  const name = useSignal<string | null>(null);
  const { profiles } = hello.value!;
  const choose = async (chosen: string): Promise<void> => {
    const patch = chosen && (await open.profile(chosen));
    if (patch) change((document) => patched(document, patch), t.film.profile);
  };
  const keep = async (): Promise<void> => {
    const given = name.value?.trim().replace(/\s+/g, '-') ?? '';
    name.value = null;
    const names = given && (await open.saveProfile(given));
    if (names) hello.value = { ...hello.value!, profiles: names };
  };
  return (
    <Group>
      <div class="row">
        <SelectField name="profile" label={t.film.profile} value="" options={[['', profiles.length ? t.film.chooseProfile : t.film.noProfile], ...profiles.map((p) => [p, p] as const)]} onChange={(chosen) => void choose(chosen)} />
        <Button name="keep-profile" label={t.film.keepProfile} icon="plus" iconOnly changes expanded={name.value !== null} onClick={() => (name.value = name.value === null ? '' : null)} />
      </div>
      {name.value !== null && (
        <form class="row" onSubmit={(event) => {
          event.preventDefault();
          void keep();
        }}>
          <input class="wide" name="profile-name" aria-label={t.film.profileName} placeholder={t.film.profileName} value={name.value} ref={takeFocus} onInput={(event) => (name.value = event.currentTarget.value)} />
          <button type="submit" class="button main" disabled={!name.value.trim()}>{t.film.keep}</button>
        </form>
      )}
    </Group>
  );
}

// For whom the report is that comes with the sheet, and the logo above it.
function ReportPage() {
  const open = job.value!;
  const logo = value<string>('report.logo');
  const setLogo = (file: string): void => setValue('report.logo', file, t.film.logo);
  const choose = async ([file]: File[]): Promise<void> => {
    const name = file && (await open.keep(file));
    if (name) setLogo(name);
  };
  return (
    <Group title={t.film.report}>
      <SegmentsField label={t.film.reportFor} value={value<string>('report.for')} options={Object.entries(t.film.readers)} onChange={(next) => setValue('report.for', next, t.film.report)} />
      <div class="row">
        {logo ? (
          <>
            <img class="logo" src={api.fileUrl(open.id, logo)} alt={t.film.logo} />
            <Button name="no-logo" label={t.film.noLogo} icon="trash" iconOnly kind="quiet" changes onClick={() => setLogo('')} />
          </>
        ) : (
          <Files name="add-logo" label={t.film.logo} icon="picture" accept={extensions(hello.value!.picture_types)} onFiles={(files) => void choose(files)} />
        )}
      </div>
    </Group>
  );
}

const parameterOf = (name: string): Parameter | undefined => hello.value?.parameters.find((p) => p.name === name);
const unitOf = (parameter: Parameter | undefined): string | undefined =>
  parameter?.unit ? ({ deg: '°', C: '°C' }[parameter.unit] ?? parameter.unit) : undefined;

// Shown elsewhere, or of no use in a job of the studio.
const ELSEWHERE = ['object.file', 'object.down', 'object.rotate_deg', 'path', 'stage.', 'run.', 'preview.', 'plan.dips'];

function Everything() {
  const search = useSignal('');
  const needle = search.value.trim().toLowerCase();
  const onPaths = hasWay(job.value!.document.value);
  const isElsewhere = (p: Parameter): boolean => ELSEWHERE.some((name) => p.name === name || (name.endsWith('.') && p.name.startsWith(name)));
  const list = hello.value!.parameters.filter(
    (p) => !isElsewhere(p) && !(onPaths && saysAWay(p.name)) && `${p.name} ${p.help}`.toLowerCase().includes(needle),
  );
  return (
    <details class="everything">
      <summary>{t.film.more}</summary>
      <div class="field search">
        <label class="hidden" for="search-setting">{t.film.search}</label>
        <input id="search-setting" type="search" placeholder={t.film.search} value={search.value} onInput={(event) => (search.value = event.currentTarget.value)} />
      </div>
      {list.length === 0 && <p class="soft">{t.film.none}</p>}
      {list.map((p) => <AnyField key={p.name} parameter={p} />)}
    </details>
  );
}

function AnyField({ parameter }: { parameter: Parameter }) {
  const { name, help, choices = [] } = parameter;
  const held = value<Json>(name);
  const set = (next: Json, live = false): void => setValue(name, next, name, live);
  const input = () => {
    if (choices.length) return <SelectField label={name} value={String(held ?? '')} options={choices.map((c) => [c, c || '–'] as const)} onChange={set} />;
    if (typeof parameter.default === 'boolean') return <CheckField label={name} checked={held === true} onChange={set} />;
    if (typeof parameter.default === 'number' && (held === null || typeof held === 'number')) {
      const { min, max, zero } = parameter;
      return (
        <NumberField label={name} unit={unitOf(parameter)} min={zero ? Math.min(0, min ?? 0) : min} max={max} value={held} onChange={(next, live) => next !== null && set(next, live)} />
      );
    }
    return <TextField label={name} value={Array.isArray(held) ? held.join(', ') : String(held ?? '')} onChange={(text) => set(Array.isArray(held) ? text.split(',').map(Number) : text)} />;
  };
  return (
    <div class="any">
      {input()}
      <p class="soft">{help}</p>
    </div>
  );
}
