// The window: what there is when nothing is open, and when a job is.
import { useEffect, useLayoutEffect, useRef } from 'preact/hooks';
import { addFiles, bigSheet, dropping, failure, hello, job, layer, narrow, panel, step } from '../studio.ts';
import { t } from '../strings.ts';
import { Button } from './fields.tsx';
import { takeFocus } from './focus.ts';
import { listenToKeys } from './keys.ts';
import { Side } from './side.tsx';
import { Start } from './start.tsx';
import { Steps } from './steps.tsx';
import { keepThumbnail } from './thumbnail.ts';
import { nameOf, TopBar } from './top.tsx';
import { Center, droppedAt } from './view.tsx';

export function App() {
  useEffect(listenToDrops, []);
  useEffect(listenToKeys, []);
  useEffect(listenToWidth, []);
  useEffect(keepThumbnail, []);
  if (!hello.value) return failure.value ? <p class="over-note bad" role="alert">{failure.value}</p> : null;
  return (
    <>
      {job.value ? <Work key={job.value.id} /> : <Start />}
      {dropping.value && <div class="drop-veil"><p class="large">{job.value ? t.start.releaseHere : t.start.release}</p></div>}
    </>
  );
}

function Work() {
  const work = useRef<HTMLDivElement>(null);
  useLayoutEffect(() => takeFocus(work.current), []); // what had it is gone with the page of jobs
  return (
    <main ref={work} tabIndex={-1} aria-label={nameOf()} class={bigSheet.value ? 'work big-sheet' : 'work'} data-job={job.value!.id} data-step={step.value} data-panel={panel.value} data-layer={layer.value}>
      <TopBar />
      <Banner />
      {!narrow.value && <Steps />}
      <Center />
      <Side />
      <Notice />
    </main>
  );
}

function Banner() {
  const open = job.value!;
  const link = open.link.value;
  if (link === 'lost' || link === 'ended' || link === 'shut') return <p class="banner stop" role="alert">{t.link[link]}</p>;
  if (!open.pen.value) {
    return (
      <p class="banner" role="status">
        <span>{t.link.other}</span>
        {!narrow.value && <Button name="take-pen" label={t.link.take} onClick={() => void open.takePen()} />}
      </p>
    );
  }
  if (narrow.value) return <p class="banner" role="status">{t.link.narrow}</p>;
  return null;
}

const NOTICE_MS = 6000;

function Notice() {
  const open = job.value!;
  const notice = open.notice.value;
  useEffect(() => {
    if (notice?.kind !== 'info') return;
    const timer = setTimeout(() => (open.notice.value = null), NOTICE_MS);
    return () => clearTimeout(timer);
  }, [notice]);
  if (!notice) return null;
  return (
    <div class={`notice ${notice.kind}`} role={notice.kind === 'error' ? 'alert' : 'status'}>
      <span>{notice.text}</span>
      <Button name="close-notice" label={t.notice.close} icon="close" iconOnly kind="quiet" onClick={() => (open.notice.value = null)} />
    </div>
  );
}

function listenToDrops(): () => void {
  let depth = 0;
  const carries = (event: DragEvent): boolean => event.dataTransfer?.types.includes('Files') ?? false;
  const enter = (event: DragEvent): void => {
    if (!carries(event)) return;
    event.preventDefault();
    ++depth;
    dropping.value = true;
  };
  const over = (event: DragEvent): void => {
    if (carries(event)) event.preventDefault();
  };
  const leave = (event: DragEvent): void => {
    if (carries(event) && --depth <= 0) dropping.value = false;
  };
  const drop = (event: DragEvent): void => {
    if (!carries(event)) return;
    event.preventDefault();
    depth = 0;
    dropping.value = false;
    const at = droppedAt(event);
    void filesOf(event.dataTransfer!).then((files) => addFiles(files, at));
  };
  const pairs = [['dragenter', enter], ['dragover', over], ['dragleave', leave], ['drop', drop]] as const;
  for (const [name, action] of pairs) window.addEventListener(name, action);
  return () => pairs.forEach(([name, action]) => window.removeEventListener(name, action));
}

// Folders come with what is in them; a file keeps its place in the folder.
async function filesOf(transfer: DataTransfer): Promise<File[]> {
  const entries = [...transfer.items].map((item) => item.webkitGetAsEntry()).filter((entry) => entry !== null);
  if (!entries.some((entry) => entry.isDirectory)) return [...transfer.files];
  const files: File[] = [];
  const walk = async (entry: FileSystemEntry, folder: string): Promise<void> => {
    if (entry.isFile) {
      const file = await new Promise<File>((done, fail) => (entry as FileSystemFileEntry).file(done, fail));
      files.push(folder ? new File([file], `${folder}${file.name}`, { type: file.type }) : file);
      return;
    }
    const reader = (entry as FileSystemDirectoryEntry).createReader();
    for (;;) {
      const batch = await new Promise<FileSystemEntry[]>((done, fail) => reader.readEntries(done, fail));
      if (!batch.length) return;
      for (const child of batch) await walk(child, `${folder}${entry.name}/`);
    }
  };
  for (const entry of entries) await walk(entry, '');
  return files;
}

const NARROW = '(max-width: 699px)';

function listenToWidth(): () => void {
  const media = matchMedia(NARROW);
  const look = (): void => {
    narrow.value = media.matches;
  };
  look();
  media.addEventListener('change', look);
  return () => media.removeEventListener('change', look);
}
