// One open job: its document with undo, and the traffic with the program. What is shown follows from the
// signals here; the document is only ever replaced, never changed.
import { batch, computed, signal } from '@preact/signals';
import { api, ApiError, Unreachable } from './api.ts';
import type { AdoptAnswer, DipFrames, Finish, JobFile, JobState, MeshData, Problem, Quality, Result, Task, TaskKind } from './api.ts';
import { dipCount, equal, layersOf, withLayer, type JobDocument, type Patch, type Vec3 } from './document.ts';
import { t } from './strings.ts';

const MOST_STEPS = 50_000; // documents share what did not change
const RETRY_MS = 1500;

interface Step {
  document: JobDocument;
  label: string;
}

export interface Working {
  revision: number;
  quality: Quality | 'finish' | null;
  activity?: string;
  fraction?: number;
}

export interface Notice {
  text: string;
  kind: 'info' | 'error';
  action?: { text: string; run: () => void };
}

// All dips together: of which revision, and what came of it.
export interface WholeFinish extends Finish {
  revision: number;
  colors: MeshData;
  byDip: MeshData;
}

export type Link = 'connecting' | 'open' | 'lost' | 'ended' | 'shut'; // shut: it runs, and does not know this page

const kept = (job: string): string => `hydrodip-studio:${job}`;

export class Job {
  readonly document = signal<JobDocument>({});
  readonly where = signal('');
  readonly files = signal<readonly JobFile[]>([]);
  readonly result = signal<Result | null>(null); // last whole one of the dip that is shown
  readonly results = signal<ReadonlyMap<number, Result>>(new Map());
  readonly frames = signal<{ result: Result; frames: DipFrames } | null>(null);
  readonly mesh = signal<MeshData | null>(null);
  readonly wanted = signal<MeshData | null>(null);
  readonly finish = signal<WholeFinish | null>(null);
  readonly finishProblem = signal('');
  readonly problem = signal<Problem | null>(null);
  readonly working = signal<Working | null>(null);
  readonly tasks = signal<ReadonlyMap<TaskKind, Task>>(new Map());
  readonly link = signal<Link>('connecting');
  readonly pen = signal(true);
  readonly dip = signal(0);
  readonly notice = signal<Notice | null>(null);
  readonly loaded = signal(false);
  private readonly past = signal<readonly Step[]>([]);
  private readonly future = signal<readonly Step[]>([]);
  private readonly savedDocument = signal<JobDocument | null>(null);
  private readonly revision = signal(0); // newest that the program has told of
  private readonly unsent = signal(false);

  readonly undoLabel = computed(() => this.past.value.at(-1)?.label ?? null);
  readonly redoLabel = computed(() => this.future.value.at(-1)?.label ?? null);
  readonly saved = computed(() => this.savedDocument.value !== null && equal(this.savedDocument.value, this.document.value));
  readonly pending = computed(() => this.unsent.value);
  // Whether what is shown is not yet the last word on the document.
  readonly draft = computed(() => {
    const shown = this.result.value;
    return !shown || this.unsent.value || shown.revision < this.revision.value || shown.quality !== 'normal';
  });
  // Whether the dips were put together as the document has them now.
  readonly wholeFinish = computed(() => {
    const finish = this.finish.value;
    const several = (this.document.value.dips?.length ?? 0) > 1;
    return several && finish && finish.revision >= this.revision.value && !this.unsent.value ? finish : null;
  });
  // Layers of artwork to which no dip brings film, as far as that is known of the document as it is now.
  readonly dryLayers = computed<readonly number[]>(() => {
    const several = (this.document.value.dips?.length ?? 0) > 1;
    if (several) return this.wholeFinish.value?.dry_layers ?? [];
    const shown = this.result.value;
    return shown && shown.artwork.length === layersOf(this.document.value).length ? shown.dry_layers : [];
  });
  readonly mayChange = computed(() => this.pen.value && this.loaded.value);

  private events: EventSource | null = null;
  private run = '';
  private beforeDrag: JobDocument | null = null;
  private sending = false;
  private next: { live: boolean } | null = null;
  private busy: Promise<unknown> = Promise.resolve();
  private closed = false;
  private retry = 0;
  private newest = { revision: -1, normal: false };
  private meshes = new Map<string, MeshData>();
  private meshTurn = 0;
  private finishTurn = 0;
  private resultTurn = 0;
  private madeOf = new Map<string, JobDocument>(); // by task
  private shownTurns = new Map<number, number>(); // by dip: of the result that is shown

  constructor(
    readonly id: string,
    readonly client: string,
  ) {}

  async open(): Promise<void> {
    await this.load();
    this.listen();
  }

  listen(): void {
    if (!this.closed) this.connect();
  }

  async load(): Promise<JobState> {
    const state: JobState = await api.job(this.id);
    this.where.value = state.where;
    this.files.value = state.files;
    this.revision.value = state.revision;
    if (state.revision <= state.saved_revision) this.savedDocument.value = state.document;
    this.document.value = state.document;
    this.takeTasks(state);
    // The program refines what was shown last.
    if (!this.loaded.value) this.dip.value = Math.min(state.dip, dipCount(state.document) - 1);
    this.loaded.value = true;
    const held = localStorage.getItem(kept(this.id));
    if (!held) return state;
    // A change that the program had not taken when the tab was closed or the program ended.
    const document = JSON.parse(held) as JobDocument;
    localStorage.removeItem(kept(this.id));
    if (equal(document, state.document)) return state;
    this.commit(document, t.undo.recovered);
    this.notice.value = { kind: 'info', text: t.notice.recovered };
    return state;
  }

  close(): void {
    this.closed = true;
    clearTimeout(this.retry);
    this.events?.close();
  }

  // --- Changing ---

  // In the middle of a drag: sketches follow, nothing is kept yet.
  drag(document: JobDocument): void {
    if (!this.mayChange.value) return;
    this.beforeDrag ??= this.document.value;
    this.document.value = document;
    this.send(true);
  }

  commit(document: JobDocument, label: string): void {
    if (!this.mayChange.value) return;
    const before = this.beforeDrag ?? this.document.value;
    const dragged = this.beforeDrag !== null;
    this.beforeDrag = null;
    if (equal(before, document)) {
      this.document.value = before;
      if (dragged) this.send(false);
      return;
    }
    this.past.value = [...this.past.value.slice(-MOST_STEPS + 1), { document: before, label }];
    this.future.value = [];
    this.take(document);
  }

  undo(): void {
    this.step(this.past, this.future);
  }

  redo(): void {
    this.step(this.future, this.past);
  }

  private step(from: typeof this.past, to: typeof this.past): void {
    const step = from.value.at(-1);
    if (!step || !this.mayChange.value) return;
    from.value = from.value.slice(0, -1);
    to.value = [...to.value, { document: this.document.value, label: step.label }];
    this.beforeDrag = null;
    this.take(step.document);
  }

  private take(document: JobDocument): void {
    this.document.value = document;
    if (this.dip.value >= dipCount(document)) this.show(dipCount(document) - 1);
    this.send(false);
  }

  show(dip: number): void {
    if (dip === this.dip.value) return;
    this.lookAt(dip);
    this.send(false);
  }

  private lookAt(dip: number): void {
    if (dip === this.dip.value) return;
    this.dip.value = dip;
    this.result.value = this.results.value.get(dip) ?? null;
    this.frames.value = null;
    this.newest = { revision: -1, normal: false };
  }

  // The program refines the dip that it was told of last: by another tab, or by nobody.
  private agreeOnDip(refined: number): void {
    if (refined !== this.dip.value && this.mayChange.value) this.send(false);
  }

  // --- To the program ---

  private send(live: boolean): void {
    if (!live) {
      this.unsent.value = true;
      localStorage.setItem(kept(this.id), JSON.stringify(this.document.value));
    }
    // What is sent is always the newest; an end of a drag is never lost to a later drag's middle.
    this.next = { live: live && (this.next?.live ?? true) };
    void this.flush();
  }

  private async flush(): Promise<void> {
    // Before the program has said whose the pen is, it would refuse what is another tab's to change.
    if (this.sending || !this.next || this.link.value !== 'open' || !this.pen.value) return;
    this.sending = true;
    try {
      await this.alone(() => this.put());
    } finally {
      this.sending = false;
    }
    if (this.next) void this.flush();
  }

  private async put(): Promise<void> {
    if (!this.next) return; // another tab has taken the pen meanwhile
    const live = this.next.live;
    const document = this.document.value;
    this.next = null;
    try {
      const answer = await api.put(this.id, { client: this.client, base: this.revision.value, document, live, dip: this.dip.value });
      this.revision.value = Math.max(this.revision.value, answer.revision);
      if (!this.next && this.document.value === document) {
        if (!live) this.acknowledged();
      }
    } catch (error) {
      this.refused(error, document, live);
    }
  }

  private acknowledged(): void {
    this.unsent.value = false;
    localStorage.removeItem(kept(this.id));
  }

  private refused(error: unknown, document: JobDocument, live: boolean): void {
    if (error instanceof Unreachable) {
      this.next ??= { live };
      this.lose();
      return;
    }
    if (!(error instanceof ApiError)) throw error;
    if (error.code === 'stale') {
      this.revision.value = Number(error.body['revision']);
      this.next ??= { live };
      return;
    }
    if (error.code === 'no-pen') {
      this.yieldToOther();
      return;
    }
    if (live) return;
    this.notice.value = { kind: 'error', text: error.message };
    // What cannot be is taken back, so that page and program agree.
    if (this.document.value !== document) return;
    const last = this.past.value.at(-1);
    if (!last) return;
    this.past.value = this.past.value.slice(0, -1);
    this.take(last.document);
  }

  // Requests that change the document there wait for each other, and for what is made of the answers.
  private async alone<T>(work: () => Promise<T>): Promise<T> {
    const turn = this.busy.then(work, work);
    this.busy = turn.catch(() => undefined);
    return turn;
  }

  // Uploads files and takes them into the document; a first picture goes where it was dropped.
  async add(files: readonly File[], at_mm: Vec3 | null): Promise<void> {
    if (!this.mayChange.value) return;
    try {
      const names: string[] = [];
      for (const file of files) {
        const name = file.webkitRelativePath || file.name;
        names.push((await api.upload(this.id, file, name)).file);
      }
      await this.alone(async () => {
        const before = this.document.value;
        this.adopted(before, await api.adopt(this.id, names, this.client), at_mm);
      });
    } catch (error) {
      this.complain(error);
    }
  }

  // What a profile sets.
  async profile(name: string): Promise<Patch | null> {
    try {
      return await api.profile(this.id, name);
    } catch (error) {
      this.complain(error);
      return null;
    }
  }

  // Keeps what the job has for film, printer and bath under that name; all profiles' names.
  async saveProfile(name: string): Promise<string[] | null> {
    try {
      await this.arrived();
      const names = await api.saveProfile(this.id, name);
      this.notice.value = { kind: 'info', text: t.notice.profile(name) };
      return names;
    } catch (error) {
      this.complain(error);
      return null;
    }
  }

  // Keeps a file that the document names elsewhere than among its artwork; its name there.
  async keep(file: File): Promise<string | null> {
    if (!this.mayChange.value) return null;
    try {
      return (await api.upload(this.id, file, file.name)).file;
    } catch (error) {
      this.complain(error);
      return null;
    }
  }

  private adopted(before: JobDocument, answer: AdoptAnswer, at_mm: Vec3 | null): void {
    this.revision.value = Math.max(this.revision.value, answer.revision);
    if (!equal(before, answer.document)) {
      this.past.value = [...this.past.value, { document: before, label: t.undo.files }];
      this.future.value = [];
      const layers = layersOf(before).length;
      const placed = at_mm && layersOf(answer.document).length > layers && before.object?.file === answer.document.object?.file;
      if (placed) this.take(withLayer(answer.document, layers, { at_mm }));
      else this.takeAdopted(answer.document);
    }
    const unused = answer.adopted.filter((file) => file.as === 'unused');
    if (unused.length) {
      this.notice.value = { kind: 'error', text: unused.map((file) => file.text || t.notice.unused(file.file)).join(' ') };
    }
  }

  private takeAdopted(document: JobDocument): void {
    this.document.value = document;
    this.lookAt(Math.min(this.dip.value, dipCount(document) - 1));
    this.agreeOnDip(0); // it begins anew with the first
  }

  // Until what was changed has arrived there.
  private async arrived(): Promise<void> {
    while ((this.sending || this.next) && ['connecting', 'open'].includes(this.link.value)) await new Promise((done) => setTimeout(done, 20));
  }

  async save(): Promise<void> {
    try {
      await this.arrived();
      const document = this.document.value;
      const { where } = await api.save(this.id);
      this.where.value = where;
      this.savedDocument.value = document;
      this.notice.value = { kind: 'info', text: t.notice.saved(where) };
    } catch (error) {
      this.complain(error);
    }
  }

  async start(kind: TaskKind, more: { best?: number; dips?: number } = {}): Promise<void> {
    try {
      await this.arrived();
      await api.start(this.id, { kind, ...more });
    } catch (error) {
      this.complain(error);
    }
  }

  async reload(): Promise<void> {
    await api.reload(this.id).catch((error: unknown) => this.complain(error));
  }

  async cancel(task: Task): Promise<void> {
    await api.cancel(this.id, task.task).catch((error: unknown) => this.complain(error));
  }

  forgetTask(kind: TaskKind): void {
    const tasks = new Map(this.tasks.value);
    tasks.delete(kind);
    this.tasks.value = tasks;
  }

  // Another tab changes the job now: what had not arrived yet is not sent over what is done there.
  private losePen(): void {
    this.pen.value = false;
    this.next = null;
    this.beforeDrag = null;
    this.acknowledged();
  }

  // What was changed here is taken back: that it is another tab's to change was not known.
  private yieldToOther(): void {
    this.losePen();
    void this.load().catch((failed: unknown) => this.complain(failed));
  }

  // The other tab was closed.
  private async getPen(): Promise<void> {
    this.pen.value = true;
    try {
      this.agreeOnDip((await api.job(this.id)).dip);
    } catch (error) {
      this.complain(error);
    }
  }

  async takePen(): Promise<void> {
    try {
      await api.pen(this.id, this.client);
      const { dip } = await this.load();
      this.pen.value = true;
      this.agreeOnDip(dip);
    } catch (error) {
      this.complain(error);
    }
  }

  private complain(error: unknown): void {
    if (error instanceof Unreachable) this.lose();
    else if (error instanceof ApiError) this.notice.value = { kind: 'error', text: error.message };
    else throw error;
  }

  async loadFrames(): Promise<void> {
    const result = this.result.value;
    if (!result || this.frames.value?.result === result) return;
    try {
      const frames = await api.dip(this.id, result.result);
      if (this.result.value === result) this.frames.value = { result, frames };
    } catch (error) {
      // An older result may have gone meanwhile; its successor comes by itself.
      if (error instanceof Unreachable) this.lose();
      else if (!(error instanceof ApiError)) throw error;
    }
  }

  // --- From the program ---

  private connect(): void {
    this.events?.close();
    const events = new EventSource(api.eventsUrl(this.id, this.client));
    this.events = events;
    const on = <T>(name: string, action: (data: T) => void): void =>
      events.addEventListener(name, (event) => action(JSON.parse((event as MessageEvent<string>).data) as T));
    on<{ run: string; pen: boolean; revision: number }>('hello', (hello) => this.greet(hello));
    on<{ mine: boolean }>('pen', ({ mine }) => {
      if (mine) void this.getPen();
      else this.losePen();
    });
    on<{ revision: number; document: JobDocument; client: string }>('document', (event) => this.changedElsewhere(event));
    on<{ saved_revision: number; where: string }>('saved', ({ saved_revision, where }) => {
      if (saved_revision === this.revision.value && !this.unsent.value) this.savedDocument.value = this.document.value;
      this.where.value = where;
    });
    on<{ mesh?: string | null; wanted?: string | null }>('mesh', (event) => void this.takeMesh(event));
    on<Working>('working', (event) => (this.working.value = event.quality ? event : null));
    on<{ revision: number; quality: Quality; dip: number; result: string }>('result', (event) => void this.takeResult(event));
    on<{ revision: number; finish?: string; problem?: string }>('finish', (event) => void this.takeFinish(event));
    on<Problem>('problem', (problem) => this.takeProblem(problem));
    on<Task>('task', (task) => this.takeTask(task));
    on<{ files: JobFile[] }>('files', ({ files }) => (this.files.value = files));
    on('bye', () => {
      this.link.value = 'ended';
      this.later();
    });
    events.onerror = () => this.lose();
  }

  private greet({ run, pen, revision }: { run: string; pen: boolean; revision: number }): void {
    const another = this.run !== '' && this.run !== run;
    this.run = run;
    this.pen.value = pen;
    this.link.value = 'open';
    this.revision.value = another ? revision : Math.max(this.revision.value, revision);
    if (another) {
      this.newest = { revision: -1, normal: false };
      if (this.result.value) this.result.value = { ...this.result.value, revision: -1 };
      this.results.value = new Map([...this.results.value].map(([dip, result]) => [dip, { ...result, revision: -1 }]));
      if (this.finish.value) this.finish.value = { ...this.finish.value, finish: '', revision: -1 };
      void this.agreeAgain();
    } else if (this.unsent.value) {
      this.next ??= { live: false };
    }
    if (!pen && this.next) this.yieldToOther();
    void this.flush();
  }

  // The program was started anew: what it lacks is sent again.
  private async agreeAgain(): Promise<void> {
    try {
      const state = await api.job(this.id);
      this.revision.value = state.revision;
      this.takeTasks(state); // what an earlier run has made is gone
      if (!equal(state.document, this.document.value) && this.pen.value) this.send(false);
      else this.acknowledged();
      this.agreeOnDip(state.dip);
    } catch (error) {
      this.complain(error);
    }
  }

  private lose(): void {
    if (this.closed) return;
    if (this.link.value !== 'ended' && this.link.value !== 'shut') this.link.value = 'lost';
    this.working.value = null;
    this.later();
  }

  private later(): void {
    clearTimeout(this.retry);
    this.events?.close();
    this.retry = window.setTimeout(() => void this.again(), RETRY_MS);
  }

  // A stream of events does not tell why there is none.
  private async again(): Promise<void> {
    try {
      await api.recent(this.client);
    } catch (error) {
      if (this.closed) return;
      if (error instanceof ApiError && error.code === 'no-token') this.link.value = 'shut';
      return this.later();
    }
    if (!this.closed) this.connect();
  }

  private changedElsewhere({ revision, document, client }: { revision: number; document: JobDocument; client: string }): void {
    if (client === this.client) return; // the answer to the request has told it
    if (revision <= this.revision.value) return;
    this.revision.value = revision;
    if (equal(document, this.document.value)) return;
    this.past.value = [...this.past.value, { document: this.document.value, label: t.undo.elsewhere }];
    this.future.value = [];
    this.document.value = document;
    this.lookAt(Math.min(this.dip.value, dipCount(document) - 1));
  }

  private async takeMesh({ mesh, wanted }: { mesh?: string | null; wanted?: string | null }): Promise<void> {
    const turn = ++this.meshTurn;
    try {
      const own = mesh ? await this.meshOf(mesh) : null;
      const painted = wanted ? await this.meshOf(wanted) : own;
      if (turn !== this.meshTurn) return; // a newer one is on its way
      batch(() => {
        if (own) this.mesh.value = own;
        if (painted) this.wanted.value = painted;
      });
    } catch (error) {
      if (error instanceof Unreachable) this.lose();
      else if (!(error instanceof ApiError)) throw error;
    }
  }

  private async meshOf(id: string): Promise<MeshData> {
    const known = this.meshes.get(id);
    if (known) return known;
    const mesh = await api.mesh(this.id, id);
    this.meshes.set(id, mesh);
    if (this.meshes.size > 8) this.meshes.delete(this.meshes.keys().next().value!);
    return mesh;
  }

  private isNewer(revision: number, normal: boolean): boolean {
    if (revision !== this.newest.revision) return revision > this.newest.revision;
    return normal || !this.newest.normal;
  }

  private async takeResult(event: { revision: number; quality: Quality; dip: number; result: string }): Promise<void> {
    const normal = event.quality === 'normal';
    const shown = event.dip === this.dip.value;
    if (shown && !this.isNewer(event.revision, normal)) return;
    const turn = ++this.resultTurn;
    try {
      const result = await api.result(this.id, event.result);
      if ((this.shownTurns.get(event.dip) ?? 0) > turn) return; // a later one has come sooner
      const old = this.results.value.get(event.dip);
      if (old && (old.revision > result.revision || (old.revision === result.revision && old.quality === 'normal'))) return;
      this.shownTurns.set(event.dip, turn);
      this.results.value = new Map(this.results.value).set(event.dip, result);
      if (event.dip !== this.dip.value) return;
      this.newest = { revision: event.revision, normal };
      this.result.value = result;
      this.problem.value = null;
    } catch (error) {
      if (error instanceof Unreachable) this.lose();
      else if (!(error instanceof ApiError)) throw error;
    }
  }

  private async takeFinish({ revision, finish: id, problem }: { revision: number; finish?: string; problem?: string }): Promise<void> {
    this.finishProblem.value = problem ?? '';
    if (!id) {
      this.finish.value = null;
      return;
    }
    const turn = ++this.finishTurn;
    try {
      const held = this.finish.value;
      const finish = held?.finish === id ? held : await api.finish(this.id, id);
      const [colors, byDip] = [await this.meshOf(finish.mesh), await this.meshOf(finish.parts)];
      if (turn === this.finishTurn) this.finish.value = { ...finish, revision, colors, byDip };
    } catch (error) {
      if (error instanceof Unreachable) this.lose();
      else if (!(error instanceof ApiError)) throw error;
    }
  }

  private takeProblem(problem: Problem): void {
    if (problem.revision < this.newest.revision) return;
    this.newest = { revision: problem.revision, normal: false };
    this.problem.value = problem;
  }

  private takeTasks(state: JobState): void {
    this.tasks.value = new Map(state.tasks.map((task) => [task.kind, task]));
    for (const task of state.tasks) this.noteWhatItIsOf(task);
  }

  private noteWhatItIsOf(task: Task): void {
    if (task.revision === this.revision.value && !this.unsent.value && !this.madeOf.has(task.task)) this.madeOf.set(task.task, this.document.value);
  }

  // Whether nothing has changed since it was begun, as far as that is known here.
  isOfNow(task: Task): boolean {
    const document = this.madeOf.get(task.task);
    return document !== undefined && equal(document, this.document.value);
  }

  private takeTask(task: Task): void {
    this.noteWhatItIsOf(task);
    const known = this.tasks.value.get(task.kind);
    if (known && known.task === task.task && known.state !== 'running' && task.state === 'running') return;
    this.tasks.value = new Map(this.tasks.value).set(task.kind, task);
  }
}
