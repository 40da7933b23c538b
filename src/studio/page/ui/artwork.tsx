// Step 2: layers of pictures, drawings and text.
import { api } from '../api.ts';
import {
  isRound, laidAnew, layerName, layersOf, layerWidth, resized, withLayer, withLayerMoved, withNewLayer, withoutLayer, type Layer, type Projection,
  type Vec3,
} from '../document.ts';
import { addFiles, change, hello, job, layer } from '../studio.ts';
import { t } from '../strings.ts';
import { AxisFields, Button, CheckField, ColorField, Files, Group, NumberField, SelectField, TextField } from './fields.tsx';
import { focusIfLost, focusOn } from './focus.ts';
import { frameOf } from './handles.tsx';
import { Icon } from './icons.tsx';
import { extensions } from './model.tsx';

export function ArtworkStep() {
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
  const center: Vec3 = entry.at_mm ?? [0, 0, 0];
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
      {isRound(projection) && !entry.at_mm && <p class="soft">{t.artwork.roundHint}</p>}
      <details>
        <summary>{t.artwork.more}</summary>
        <AxisFields
          legend={`${onFilm ? t.artwork.onFilm : t.artwork.at}, mm`}
          name="at"
          unit="mm"
          unitElsewhere
          count={onFilm ? 2 : 3}
          values={center}
          unset={!entry.at_mm}
          onChange={(at_mm, live) => set({ at_mm }, live, t.undo.layerMove)}
          onEmptied={() => set({ at_mm: undefined }, false, t.undo.layerMove)}
        />
        <NumberField name="fade" label={t.artwork.fade} unit="°" min={0} max={90} step={5} value={entry.fade_deg ?? 90} onChange={(next, live) => set({ fade_deg: next === null || next === 90 ? undefined : next }, live)} />
        <SelectField name="blend" label={t.artwork.blend} value={entry.blend ?? 'normal'} options={Object.entries(t.artwork.blends)} onChange={(blend) => set({ blend: blend === 'normal' ? undefined : 'multiply' })} />
        <CheckField name="through" label={t.artwork.through} checked={entry.through ?? false} onChange={(through) => set({ through: through || undefined })} />
      </details>
    </section>
  );
}
