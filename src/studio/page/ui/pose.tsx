// How the object hangs, in figures: for the only dip, or for the one that is shown.
import type { Side, Vec3 } from '../document.ts';
import { changePose, chooseTool, goStraightDown, ownWay, pose, tool, wholeDepth } from '../studio.ts';
import { t } from '../strings.ts';
import { Button, Group, NumberField, SelectField } from './fields.tsx';

export const AXES = ['x', 'y', 'z'] as const;

export function PoseFields() {
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
