// Long work in the background: how far it is, how long it will take, and a way to end it.
import type { Task, TaskKind } from '../api.ts';
import { job } from '../studio.ts';
import { t } from '../strings.ts';
import { Button } from './fields.tsx';

export const taskOf = (kind: TaskKind): Task | null => job.value?.tasks.value.get(kind) ?? null;

export function Progress({ task, title }: { task: Task; title: string }) {
  const done = Math.round(100 * task.fraction);
  return (
    <div class="progress" data-task={task.kind}>
      <p>
        <b>{title}</b>
        <Button label={t.print.cancel} name={`cancel-${task.kind}`} kind="quiet" changes onClick={() => void job.value?.cancel(task)} />
      </p>
      <div class="bar" role="progressbar" aria-label={title} aria-valuenow={done} aria-valuemin={0} aria-valuemax={100}>
        <i style={{ width: `${done}%` }} />
      </div>
      <p class="soft">
        <span>{task.activity}</span>
        {task.left_s !== null && task.left_s !== undefined && <span>{t.print.left(task.left_s)}</span>}
      </p>
    </div>
  );
}
