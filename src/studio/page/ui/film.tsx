// Step 4: film, printer and report, and every other setting.
import { useSignal } from '@preact/signals';
import { api, type Parameter } from '../api.ts';
import { hasWay, patched, saysAWay, withValue, type Json } from '../document.ts';
import { change, defaults, hello, job, setValue, value } from '../studio.ts';
import { t } from '../strings.ts';
import { Button, CheckField, Files, Group, NumberField, SegmentsField, SelectField, TextField } from './fields.tsx';
import { takeFocus } from './focus.ts';
import { extensions } from './model.tsx';

export function sheetName(): string {
  const [w, h] = [value<number>('film.width_mm'), value<number>('film.height_mm')];
  const film = hello.value?.films.find((f) => (f.width_mm === w && f.height_mm === h) || (f.width_mm === h && f.height_mm === w));
  return film ? (t.film.names[film.name] ?? film.name) : `${w} × ${h} mm`;
}

export function FilmStep() {
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
