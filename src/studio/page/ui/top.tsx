// The bar above: what is worked on, whether it is kept, and the verdict.
import { useSignal } from '@preact/signals';
import type { ComponentChildren } from 'preact';
import { useEffect } from 'preact/hooks';
import { api, type Concern } from '../api.ts';
import { change, covering, goToStart, job, narrow, panel, printToShow, readOnly, type Panel as PanelName } from '../studio.ts';
import { t } from '../strings.ts';
import { Button, TextField } from './fields.tsx';
import { usePanelFocus } from './focus.ts';
import { Icon } from './icons.tsx';
import { PrintPanel } from './print.tsx';
import { taskOf } from './progress.tsx';
import { CONCERN_ICON, DraftBadge, FindingCard, sorted } from './side.tsx';

const toggle = (name: PanelName): void => {
  panel.value = panel.value === name ? 'none' : name;
};

export function askPrint(): void {
  const open = job.value;
  if (!open) return;
  const task = taskOf('print');
  if (readOnly.value && !task) return;
  panel.value = 'print';
  // One that goes on, has ended unseen, or would only be made again is shown.
  const stands = task && (task.state === 'running' || task.task === printToShow.value || isPrinted());
  // Its end is seen now.
  if (stands && task.state !== 'running') printToShow.value = '';
  if (!stands && !readOnly.value) void open.start('print');
}

// Whether the job's files lie ready as it is now.
function isPrinted(): boolean {
  const task = taskOf('print');
  return task?.state === 'done' && job.value!.isOfNow(task);
}

export function askSave(): void {
  const open = job.value;
  if (!open) return;
  if (open.where.value) void open.save();
  else toggle('save');
}

export function Mark() {
  return (
    <svg class="mark-drop" width="22" height="22" viewBox="0 0 22 22" aria-hidden="true">
      <path d="M11 2.5c3.4 4.1 5.6 6.9 5.6 10a5.6 5.6 0 0 1-11.2 0c0-3.1 2.2-5.9 5.6-10z" />
      <path class="wave" d="M1.5 14.5c1.6 0 1.6 1.2 3.2 1.2s1.6-1.2 3.1-1.2 1.6 1.2 3.2 1.2 1.6-1.2 3.1-1.2 1.6 1.2 3.2 1.2 1.6-1.2 3.2-1.2" />
    </svg>
  );
}

export function TopBar() {
  const open = job.value!;
  return (
    <header class="top">
      <button type="button" class="home" aria-label={t.top.home} title={t.top.home} onClick={() => void goToStart()}><Mark /></button>
      <Name />
      <div class="row tight">
        <Button name="undo" label={t.top.undo(open.undoLabel.value)} icon="undo" iconOnly kind="quiet" changes disabled={!open.undoLabel.value} onClick={() => open.undo()} />
        <Button name="redo" label={t.top.redo(open.redoLabel.value)} icon="redo" iconOnly kind="quiet" changes disabled={!open.redoLabel.value} onClick={() => open.redo()} />
      </div>
      <VerdictLine />
      <div class="row tight actions">
        <Button name="keys" label={t.top.keys} icon="help" iconOnly kind="quiet" expanded={panel.value === 'keys'} onClick={() => toggle('keys')} />
        {!narrow.value && (
          <>
            <Button name="save" label={t.top.save} changes expanded={panel.value === 'save'} onClick={askSave} />
            <PrintButton />
          </>
        )}
      </div>
      {panel.value === 'verdict' && <VerdictPanel />}
      {panel.value === 'print' && <PrintPanel />}
      {panel.value === 'save' && <SavePanel />}
      {panel.value === 'keys' && <KeysPanel />}
    </header>
  );
}

// Says how far a print is and that it has ended, also while its panel is closed.
function PrintButton() {
  const open = job.value!;
  const task = taskOf('print');
  const state = task?.state;
  useEffect(() => {
    if (task && state === 'running') printToShow.value = task.task;
  }, [task?.task, state]);
  const shut = panel.value !== 'print';
  const ended = task !== null && task.task === printToShow.value && shut;
  let label: string = t.top.print;
  if (task && state === 'running') label = t.top.printing(task.fraction);
  else if (ended && state === 'done') label = t.top.printed;
  else if (ended && state === 'failed') label = t.top.notPrinted;
  else if (shut && isPrinted()) label = t.top.filesReady;
  return (
    <Button name="print" label={label} kind="main" disabled={!open.document.value.object?.file || (readOnly.value && !task)} expanded={panel.value === 'print'} onClick={() => (panel.value === 'print' ? toggle('print') : askPrint())} />
  );
}

export const nameOf = (): string => {
  const document = job.value?.document.value;
  return document?.name || document?.object?.file?.replace(/^.*\//, '').replace(/\.[^.]*$/, '') || t.top.untitled;
};

function rename(name: string): void {
  if (name !== nameOf()) change(({ name: _, ...rest }) => (name ? { ...rest, name } : rest), t.undo.name);
}

function Name() {
  const open = job.value!;
  const typed = useSignal<string | null>(null);
  const state = open.pending.value ? t.top.sending : open.saved.value ? t.top.saved : open.where.value ? t.top.kept : t.top.keptNoFile;
  const settle = (): void => {
    const name = typed.value?.trim();
    typed.value = null;
    if (name !== undefined) rename(name);
  };
  return (
    <div class="jobname">
      <input
        aria-label={t.top.name}
        name="job-name"
        title={nameOf()}
        value={typed.value ?? nameOf()}
        disabled={!open.mayChange.value || narrow.value}
        size={Math.max(6, Math.min(60, (typed.value ?? nameOf()).length))}
        onInput={(event) => (typed.value = event.currentTarget.value)}
        onBlur={settle}
        onKeyDown={(event) => {
          if (event.key === 'Enter') event.currentTarget.blur();
          if (event.key === 'Escape') {
            typed.value = null;
            event.currentTarget.blur();
          }
        }}
      />
      <small data-saved={open.saved.value} title={open.where.value}>{state}</small>
    </div>
  );
}

interface Said {
  concern: Concern | 'wait';
  head?: string;
  text: string;
}

function said(): Said {
  const open = job.value!;
  const problem = open.problem.value;
  if (!open.document.value.object?.file) return { concern: 'wait', text: t.verdict.empty };
  if (problem) return { concern: problem.code === 'no-model' ? 'wait' : 'stop', text: problem.text };
  const verdict = open.wholeFinish.value?.verdict ?? open.result.value?.verdict;
  if (!verdict) return { concern: 'wait', text: t.verdict.waiting };
  return verdict.short
    ? { concern: verdict.concern, head: verdict.headline, text: verdict.short }
    : { concern: verdict.concern, text: verdict.text || verdict.headline };
}

function VerdictLine() {
  const open = job.value!;
  const { concern, head, text } = said();
  const draft = concern !== 'wait' && open.draft.value && !open.problem.value;
  const rough = draft || (concern !== 'wait' && !open.problem.value && open.wholeFinish.value !== null); // dips are put together as drafts
  const told = rough ? t.verdict.about(text) : text;
  const all = head ? `${head}: ${told}` : told;
  const working = open.working.value;
  return (
    <button
      type="button"
      class={`verdict ${concern}`}
      data-draft={draft}
      aria-expanded={panel.value === 'verdict'}
      aria-label={concern === 'wait' ? text : t.verdict.label(t.verdict.level[concern], all)}
      title={all}
      onClick={() => toggle('verdict')}
    >
      {concern === 'wait' ? <span class="spinner" data-still={!working} /> : <Icon name={CONCERN_ICON[concern]} />}
      <span class="sentence" aria-live="polite">{head && <b>{head}</b>} {told}</span>
      {rough && <DraftBadge more={draft ? t.verdict.refining : ''} />}
      {working?.fraction !== undefined && <i class="thin" style={{ width: `${100 * working.fraction}%` }} />}
    </button>
  );
}

function VerdictPanel() {
  const result = job.value!.result.value;
  const finish = job.value!.wholeFinish.value;
  const verdict = finish?.verdict ?? result?.verdict;
  const draft = job.value!.draft.value;
  return (
    <Panel button=".verdict" kind="verdict-panel" label={t.verdict.restsOn}>
      <PanelHead title={verdict?.headline ?? t.verdict.waiting} />
      {verdict && <p>{verdict.text}</p>}
      {(draft || finish) && <p class="soft">{t.verdict.draftHelp} {draft && t.verdict.refining}</p>}
      {finish && <ul class="findings">{sorted(finish.findings).map((finding) => <FindingCard key={finding.key + finding.text} finding={finding} draft />)}</ul>}
      {finish && <h3>{t.findings.ofDip(job.value!.dip.value + 1)}</h3>}
      <ul class="findings">{sorted(result?.findings ?? []).map((finding) => <FindingCard key={finding.key + finding.text} finding={finding} draft={draft} />)}</ul>
    </Panel>
  );
}

export function Panel({ button, kind, label, children }: { button: string; kind: string; label: string; children: ComponentChildren }) {
  const own = usePanelFocus(button);
  useEffect(() => {
    const look = (): void => {
      covering.value = own.current?.getBoundingClientRect() ?? null;
    };
    const observer = new ResizeObserver(look);
    observer.observe(own.current!);
    look();
    window.addEventListener('resize', look);
    return () => {
      observer.disconnect();
      window.removeEventListener('resize', look);
      covering.value = null;
    };
  }, []);
  return <section ref={own} tabIndex={-1} class={`panel ${kind}`} aria-label={label}>{children}</section>;
}

export function PanelHead({ title }: { title: string }) {
  return (
    <div class="panel-head">
      <h2>{title}</h2>
      <Button name="close-panel" label={t.keys.close} icon="close" iconOnly kind="quiet" onClick={() => (panel.value = 'none')} />
    </div>
  );
}

function SavePanel() {
  const open = job.value!;
  const name = useSignal(nameOf());
  return (
    <Panel button='[data-name="save"]' kind="right" label={t.save.title}>
      <PanelHead title={t.save.title} />
      <p class="soft">{open.where.value ? t.save.where(open.where.value) : t.save.new}</p>
      <form class="group" onSubmit={(event) => {
        event.preventDefault();
        panel.value = 'none';
        rename(name.value);
        void open.save();
      }}>
        <TextField name="save-name" label={t.save.name} value={name.value} onChange={(next) => (name.value = next)} />
        <button type="submit" class="button main" data-name="save-now"><span>{t.save.button}</span></button>
      </form>
      <div class="row wrap">
        <a class="button plain" href={api.tomlUrl(open.id)} download><Icon name="download" /><span>{t.top.jobFile}</span></a>
        <a class="button plain" href={api.zipUrl(open.id)} download><Icon name="download" /><span>{t.top.jobZip}</span></a>
      </div>
    </Panel>
  );
}

function KeysPanel() {
  return (
    <Panel button='[data-name="keys"]' kind="right keys" label={t.keys.title}>
      <PanelHead title={t.keys.title} />
      <dl>
        {t.keys.list.map(([key, what]) => (
          <div key={key}><dt>{key.split(', ').map((k) => <kbd key={k}>{k}</kbd>)}</dt><dd>{what}</dd></div>
        ))}
      </dl>
    </Panel>
  );
}
