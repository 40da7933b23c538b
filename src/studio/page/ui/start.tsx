// The empty page: a large place to drop things, samples, and what was worked on before.
import { api, type Recent } from '../api.ts';
import { addFiles, arriving, CLIENT, createJob, failure, hello, openJob, recent } from '../studio.ts';
import { t } from '../strings.ts';
import { Button, Files } from './fields.tsx';
import { Icon } from './icons.tsx';
import { SampleDrawing } from './samples.tsx';
import { Mark } from './top.tsx';

const SHOWN = ['mask', 'sphere', 'ellipsoid'];

export function Start() {
  const { samples, model_types, picture_types } = hello.value!;
  const shown = [...SHOWN.map((name) => samples.find((s) => s.name === name)), ...samples].filter((s, k, all) => s && all.indexOf(s) === k).slice(0, 3);
  return (
    <main class="start">
      <header>
        <h1><Mark /> {t.product}</h1>
        <p>{t.start.line}</p>
      </header>
      {failure.value && <p class="bad" role="alert">{failure.value}</p>}
      <section class="dropzone" data-name="dropzone">
        <p class="large" role="status">{arriving.value ? t.start.arriving : t.start.drop}</p>
        <p class="soft">{t.start.dropMore(model_types.join(', '), picture_types.join(', '))}</p>
        <Files name="choose" label={t.start.choose} icon="file" kind="main" many onFiles={(files) => void addFiles(files)} />
      </section>
      <section>
        <h2>{t.start.samples}</h2>
        <div class="samples">
          {shown.map((sample) => (
            <button key={sample!.name} type="button" class="sample" data-sample={sample!.name} onClick={() => void createJob({ sample: sample!.name })}>
              <SampleDrawing name={sample!.name} />
              <b>{sample!.name}</b>
              <small>{t.start.sampleText[sample!.name] ?? sample!.text}</small>
            </button>
          ))}
        </div>
      </section>
      <section>
        <h2>{t.start.recent}</h2>
        {recent.value.length === 0 && <p class="soft">{t.start.nothing}</p>}
        <ul class="recent">
          {recent.value.map((entry) => (
            <li key={entry.job}>
              <button type="button" data-recent={entry.job} onClick={() => void openJob(entry.job)}>
                {entry.thumbnail ? <img src={entry.thumbnail} alt="" loading="lazy" /> : <span class="blank" aria-hidden="true"><Icon name="file" /></span>}
                <b title={entry.name}>{entry.name || t.top.untitled}</b>
                <small>
                  {new Date(entry.changed).toLocaleString(undefined, { dateStyle: 'medium', timeStyle: 'short' })}
                  {stateOf(entry)}
                </small>
              </button>
              <Button label={t.start.forget(entry.name)} icon="close" iconOnly kind="quiet" onClick={() => void forget(entry.job)} />
            </li>
          ))}
        </ul>
      </section>
    </main>
  );
}

function stateOf({ open, recovered, unsaved }: Recent): string {
  const word = open ? t.start.open : recovered ? t.start.recovered : unsaved ? t.start.unsaved : '';
  return word && ` · ${word}`;
}

async function forget(id: string): Promise<void> {
  try {
    await api.forget(id);
    recent.value = await api.recent(CLIENT);
    failure.value = '';
  } catch (error) {
    failure.value = error instanceof Error ? error.message : String(error);
  }
}
