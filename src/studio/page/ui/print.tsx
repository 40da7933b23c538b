// Printing: the whole job in the background, then its files.
import { useEffect } from 'preact/hooks';
import type { PrintResult } from '../api.ts';
import { job, printToShow } from '../studio.ts';
import { t } from '../strings.ts';
import { Button } from './fields.tsx';
import { Icon } from './icons.tsx';
import { Progress, taskOf } from './progress.tsx';
import { CONCERN_ICON } from './side.tsx';
import { Panel, PanelHead } from './top.tsx';

// What people need at the printer and the bath comes first.
const FIRST = /(^|\/)(print\.pdf|run-?sheet\.(pdf|html)|report\.html)$/;

export function PrintPanel() {
  const open = job.value!;
  const task = taskOf('print');
  const result = task?.kind === 'print' && task.state === 'done' ? task.result : null;
  useEffect(() => {
    printToShow.value = task?.state === 'running' ? task.task : '';
  }, [task?.task, task?.state]);
  const again = <Button name="print-again" label={t.print.again} changes onClick={() => void open.start('print')} />;
  return (
    <Panel button='[data-name="print"]' kind="right print" label={t.print.title}>
      <PanelHead title={t.print.title} />
      {/* Said when it changes, and not at every step. */}
      <p class="hidden" role="status">{task && t.print.state[task.state]}</p>
      {task?.state === 'running' && <Progress task={task} title={t.print.running} />}
      {task?.state === 'cancelled' && <p>{t.print.cancelled}</p>}
      {task?.state === 'failed' && <p class="bad"><b>{t.print.failed}.</b> {task.error?.text}</p>}
      {task && (task.state === 'cancelled' || task.state === 'failed') && <div class="row">{again}</div>}
      {result && <Printed result={result} />}
      {result && <div class="row wrap">{!open.isOfNow(task!) && <p class="soft">{t.print.changed}</p>}{again}</div>}
    </Panel>
  );
}

function Printed({ result }: { result: PrintResult }) {
  const first = result.files.filter(({ file }) => FIRST.test(file));
  const rest = result.files.filter(({ file }) => !FIRST.test(file));
  return (
    <>
      <p class={`said ${result.verdict.concern}`}><Icon name={CONCERN_ICON[result.verdict.concern]} /> {result.verdict.text || result.verdict.headline}</p>
      <ul class="files-list">{first.map((file) => <FileRow key={file.file} {...file} />)}</ul>
      <p class="soft">{t.print.next}</p>
      {rest.length > 0 && (
        <details>
          <summary>{t.print.more(rest.length)}</summary>
          <ul class="files-list">{rest.map((file) => <FileRow key={file.file} {...file} />)}</ul>
        </details>
      )}
      <div class="row wrap">
        <a class="button plain" href={result.zip} download data-name="print-zip"><Icon name="download" /><span>{t.print.zip}</span></a>
      </div>
      <p class="soft where">{t.print.done(result.where)}</p>
      {result.warnings.length > 0 && <ul class="notes">{result.warnings.map((warning) => <li key={warning}>{warning}</li>)}</ul>}
    </>
  );
}

function FileRow({ file, text, bytes, url }: { file: string; text: string; bytes: number; url: string }) {
  return (
    <li>
      <a href={url} target="_blank" rel="noopener" data-file={file} aria-label={t.print.open(file)}>
        <b>{file}</b>
        <small>{text} · {t.kilobytes(bytes)}</small>
      </a>
    </li>
  );
}
