// How the object hangs, in figures: for the only dip, or for the one that is shown.
import type { Side } from '../document.ts';
import { changePose, chooseTool, goStraightDown, ownWay, pose, tool, wholeDepth } from '../studio.ts';
import { t } from '../strings.ts';
import { AxisFields, Button, Group, NumberField, SelectField } from './fields.tsx';

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
      <AxisFields
        legend={t.model.turn}
        name="turn"
        unit="°"
        min={-3600}
        max={3600}
        step={5}
        values={now.rotate_deg}
        onChange={(rotate_deg, live) => changePose({ rotate_deg }, live)}
      />
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
      <AxisFields
        legend={t.model.shift}
        name="shift"
        unit="mm"
        min={-2000}
        max={2000}
        disabled={ownWay.value}
        values={now.shift_mm}
        onChange={(shift_mm, live) => changePose({ shift_mm }, live)}
      />
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
