// The right side: the sheet and what to mind.
import type { Finding, Mend } from '../api.ts';
import { applyPatch, chooseOverlay, goToStep, job, showView, stage, view } from '../studio.ts';
import { t } from '../strings.ts';
import { Button } from './fields.tsx';
import { Icon } from './icons.tsx';
import { Sheet } from './sheet.tsx';

export const CONCERN_ICON = { none: 'check', care: 'care', stop: 'stop' } as const;

export function Side() {
  return (
    <aside class="side" aria-label={t.findings.title}>
      <section class="sheet-section">
        <h2>{severalDips() ? t.sheet.of(job.value!.dip.value + 1) : t.sheet.title}</h2>
        <Sheet />
        <p class="soft legend-line"><i class="lands" />{t.sheet.legend.lands} <i class="torn" />{t.sheet.legend.torn}</p>
      </section>
      <Findings />
    </aside>
  );
}

const severalDips = (): boolean => (job.value?.document.value.dips?.length ?? 0) > 1;

export function applyMend(mend: Mend): void {
  if (mend.task) {
    goToStep('model'); // its progress and what it finds are shown there
    void job.value?.start(mend.task.kind, { best: 3 });
    return;
  }
  applyPatch(mend.patch, t.undo.mend(mend.text));
}

function Mends({ mends }: { mends: Mend[] }) {
  return (
    <>
      {mends.map((mend) => (
        <Button key={mend.text} name={mend.task ? 'search' : 'mend'} label={mend.text} icon="wrench" kind="mend" changes onClick={() => applyMend(mend)} />
      ))}
    </>
  );
}

export function showFinding(finding: Finding): void {
  chooseOverlay(finding.overlay || 'none');
  if (view.value !== 'object') showView('object');
  if (finding.at_mm) stage.current?.showPlace(finding.at_mm);
}

// Beside what is a draft's, which is to be had in figures that are not final.
export function DraftBadge({ more = '' }: { more?: string }) {
  return <span class="badge" title={`${t.verdict.draftHelp} ${more}`.trim()}>{t.verdict.draft}</span>;
}

export function FindingCard({ finding, draft }: { finding: Finding; draft: boolean }) {
  return (
    <li class={`finding ${finding.concern}`} data-finding={finding.key}>
      <p class="head">
        <Icon name={CONCERN_ICON[finding.concern]} />
        <b>{finding.title}</b>
        <span class="figure">{draft ? t.verdict.about(finding.figure) : finding.figure}</span>
      </p>
      <p>{finding.text}</p>
      {finding.advice && <p class="soft">{finding.advice}</p>}
      {(finding.overlay || finding.at_mm || finding.mends.length > 0) && (
        <div class="row wrap">
          {(finding.overlay || finding.at_mm) && (
            <Button name="show" label={t.verdict.show} spoken={t.verdict.showLong(finding.title)} title={t.verdict.showLong(finding.title)} icon="eye" onClick={() => showFinding(finding)} />
          )}
          <Mends mends={finding.mends} />
        </div>
      )}
    </li>
  );
}

const RANK = { stop: 0, care: 1, none: 2 };
export const sorted = (findings: readonly Finding[]): Finding[] => [...findings].sort((a, b) => RANK[a.concern] - RANK[b.concern]);

function Findings() {
  const open = job.value!;
  const problem = open.problem.value;
  const result = open.result.value;
  const finish = open.wholeFinish.value;
  const draft = open.draft.value;
  return (
    <section class="findings-section">
      <h2 class="row">{t.findings.title} {!problem && !finish && result && draft && <DraftBadge more={t.verdict.refining} />}</h2>
      {problem && problem.code !== 'no-model' && (
        <ul class="findings">
          <li class="finding stop" data-finding="problem">
            <p class="head"><Icon name="stop" /><b>{t.findings.problem}</b></p>
            <p>{problem.text}</p>
            <div class="row wrap"><Mends mends={problem.mends} /></div>
          </li>
        </ul>
      )}
      {!problem && finish && (
        <>
          <h3 class="row">{t.dips.together} <DraftBadge /></h3>
          <FindingList findings={finish.findings} draft />
          <h3 class="row">{t.findings.ofDip(open.dip.value + 1)} {draft && <DraftBadge more={t.verdict.refining} />}</h3>
        </>
      )}
      {!problem && result && <FindingList findings={result.findings} draft={draft} />}
    </section>
  );
}

function FindingList({ findings, draft }: { findings: readonly Finding[]; draft: boolean }) {
  const list = sorted(findings);
  const mind = list.filter(({ concern }) => concern !== 'none');
  const fine = list.filter(({ concern }) => concern === 'none');
  return (
    <>
      {mind.length === 0 && <p class="soft">{t.findings.none}</p>}
      <ul class="findings">{mind.map((finding) => <FindingCard key={finding.key + finding.text} finding={finding} draft={draft} />)}</ul>
      {fine.length > 0 && (
        <details class="fine">
          <summary><Icon name="check" /> {t.verdict.fine(fine.length)}</summary>
          <ul class="findings">{fine.map((finding) => <FindingCard key={finding.key + finding.text} finding={finding} draft={draft} />)}</ul>
        </details>
      )}
    </>
  );
}
