// The middle of the window: the 3D view with what lies over it.
import { batch, effect, useSignal } from '@preact/signals';
import { useEffect, useRef } from 'preact/hooks';
import * as THREE from 'three';
import type { MeshData, Overlay } from '../api.ts';
import type { Vec3 } from '../document.ts';
import { between, fateOf } from '../../../report/viewer/pick.js';
import {
  allDips, bigSheet, changePose, chooseOverlay, chooseTool, compare, covering, divider, drawn, job, layer, level, overlay, ownWay,
  narrow, playing, pointed, pose, readOnly, scale, showView, stage, tool, value, view,
} from '../studio.ts';
import { freePart } from '../free.ts';
import { Stage, type Compare, type Hit, type LookFrom, type View } from '../stage/stage.ts';
import { overlayOf, sceneOf, STUDIO_OVERLAYS } from '../stage/overlays.ts';
import { t } from '../strings.ts';
import { Button, Segments, SelectField } from './fields.tsx';
import { ArtworkHandles, DepthHandle } from './handles.tsx';
import { Icon } from './icons.tsx';
import { Sheet } from './sheet.tsx';

const PLAY_SECONDS = 7;

function loadTextures(mesh: MeshData): Promise<THREE.Texture[]> {
  const loader = new THREE.TextureLoader();
  return Promise.all(
    mesh.textures.map(async (url) => {
      const texture = await loader.loadAsync(url);
      texture.colorSpace = THREE.SRGBColorSpace;
      texture.anisotropy = 8;
      return texture;
    }),
  );
}

const textures = new Map<string, Promise<THREE.Texture[]>>();
function texturesOf(mesh: MeshData): Promise<THREE.Texture[]> {
  const known = textures.get(mesh.mesh);
  if (known) return known;
  const loading = loadTextures(mesh);
  textures.set(mesh.mesh, loading);
  if (textures.size > 6) textures.delete(textures.keys().next().value!);
  return loading;
}

// Keeps the stage at what the signals say.
function follow(shown: Stage): () => void {
  let painted = '';
  const ends = [
    effect(() => shown.setModel(job.value?.mesh.value ?? null)),
    effect(() => {
      const wanted = job.value?.wanted.value ?? job.value?.mesh.value ?? null;
      painted = wanted?.mesh ?? '';
      if (!wanted) return shown.paint(null, []);
      // The old picture stays until the new one's textures are here.
      void texturesOf(wanted).then(
        (list) => painted === wanted.mesh && shown.paint(wanted, list),
        () => painted === wanted.mesh && shown.paint(wanted, []),
      );
    }),
    effect(() => shown.setPose(pose.value, scale.value)),
    effect(() => shown.setBase(value<string>('object.base_color') ?? '#ffffff')),
    effect(() =>
      shown.setSheet(
        {
          width_mm: value<number>('film.width_mm'),
          height_mm: value<number>('film.height_mm'),
          margin_mm: value<number>('film.margin_mm'),
          disc: value<string>('film.shape') === 'disc',
        },
        { width_mm: value<number>('bath.width_mm'), height_mm: value<number>('bath.height_mm'), depth_mm: value<number>('bath.depth_mm') },
      ),
    ),
    effect(() => shown.setResult(job.value?.result.value ?? null)),
    effect(() => {
      const held = job.value?.frames.value;
      if (held) shown.setFrames(held.result, held.frames);
    }),
    effect(() => {
      const finish = job.value?.finish.value ?? null;
      const several = (job.value?.document.value.dips?.length ?? 0) > 1;
      if (!several && overlay.peek() === 'parts') overlay.value = 'none';
      if (!finish || !several) return shown.setFinish(null, { colors: [], parts: [] });
      const { colors, byDip: parts } = finish;
      void Promise.all([texturesOf(colors), texturesOf(parts)]).then(([ofColors, ofParts]) => {
        if (job.value?.finish.value === finish) shown.setFinish({ colors, parts }, { colors: ofColors, parts: ofParts });
      }, () => undefined);
    }),
    effect(() => {
      shown.allDips = allDips.value;
      shown.invalidate();
    }),
    effect(() => {
      shown.overlay = overlay.value;
      shown.compare = compare.value;
      shown.divider = divider.value;
      shown.invalidate();
    }),
    effect(() => shown.setView(view.value)),
    effect(() => {
      shown.readOnly = readOnly.value;
      shown.setTool(tool.value);
    }),
    effect(() => shown.setLevel(level.value < 0 ? -shown.hover_mm : level.value)),
  ];
  return () => ends.forEach((end) => end());
}

function startStage(canvas: HTMLCanvasElement): Stage {
  return new Stage(canvas, {
    pose: (part, live) => {
      changePose(part, live);
      if (tool.value === 'face') tool.value = 'none'; // one click is what it is for
    },
    click: (hit) => {
      if (!hit && layer.value !== null) layer.value = null;
    },
    point: (hit) => pointAt(hit),
    drawn: () => {
      drawn.value = drawn.peek() + 1;
      canvas.dataset['drawn'] = String(drawn.peek());
      canvas.dataset['eye'] = stage.current?.eye_mm.toFixed(1) ?? '';
    },
  });
}

function pointAt(hit: Hit | null): void {
  const result = job.value?.result.value;
  if (!hit && pointed.value.hit === null) return;
  const u = hit?.film && result ? (between(result.filmMesh, result.filmMesh.u, 2, hit.film) as [number, number]) : null;
  pointed.value = { hit, u };
}

export function Center() {
  const canvas = useRef<HTMLCanvasElement>(null);
  const box = useRef<HTMLDivElement>(null);
  const center = useRef<HTMLElement>(null);
  const broken = useSignal(false);
  const free = useSignal('');

  // What a panel is about is seen beside it.
  useEffect(() => effect(() => {
    const { top, right, bottom, left } = freePart(center.current!.getBoundingClientRect(), narrow.value ? null : covering.value);
    free.value = `${top}px ${right}px ${bottom}px ${left}px`;
  }), []);
  useEffect(() => {
    let shown: Stage;
    try {
      shown = startStage(canvas.current!);
    } catch {
      broken.value = true;
      return;
    }
    stage.current = shown;
    const end = follow(shown);
    const observer = new ResizeObserver(([entry]) => {
      const { width, height } = entry!.contentRect;
      const w = Math.min(220, Math.round(width * 0.27));
      shown.inset = width > 520 ? { x: width - w - 13, y: 63, width: w, height: Math.round(w * 0.75) } : null;
      shown.resize(width, height);
    });
    observer.observe(box.current!);
    return () => {
      observer.disconnect();
      end();
      stage.current = null;
    };
  }, []);

  const empty = !job.value?.document.value.object?.file;
  return (
    <section ref={center} class={`center ${view.value}`} aria-label={t.stage.views}>
      <div class="canvas-box" ref={box} hidden={bigSheet.value} style={{ inset: free.value }}>
        <canvas
          ref={canvas}
          tabIndex={0}
          role="img"
          aria-label={t.stage.label}
          onPointerDown={(event) => {
            event.currentTarget.dataset['byPointer'] = 'yes';
            event.currentTarget.focus({ preventScroll: true });
          }}
          onBlur={(event) => delete event.currentTarget.dataset['byPointer']}
        />
        {broken.value && <p class="over-note">{t.stage.noGl}</p>}
        {empty && !broken.value && <p class="over-note"><b>{t.stage.empty}</b><br />{t.stage.emptyHint}</p>}
        {!empty && <Divider />}
        {!empty && view.value === 'bath' && <DepthHandle />}
        {!empty && <ArtworkHandles />}
        {!empty && <Inset />}
        <Legend />
        <Readout />
      </div>
      {bigSheet.value && <Sheet big />}
      <ViewBar />
      {!bigSheet.value && !empty && <Tools />}
      {!bigSheet.value && !empty && view.value === 'bath' && <DipBar />}
      {!bigSheet.value && !empty && view.value === 'object' && <CompareBar />}
    </section>
  );
}

function ViewBar() {
  const shown = bigSheet.value ? 'sheet' : view.value;
  return (
    <div class="viewbar">
      <Segments<View | 'sheet'>
        label={t.stage.views}
        always
        value={shown}
        options={[['bath', t.stage.bath], ['object', t.stage.object], ['sheet', t.stage.sheet]]}
        onChange={(next) => (next === 'sheet' ? (bigSheet.value = true) : showView(next))}
      />
      {!bigSheet.value && (
        <>
          <SelectField
            name="overlay"
            label={t.stage.overlay}
            always
            hideLabel
            value={overlay.value}
            options={STUDIO_OVERLAYS.filter(({ key }) => key !== 'parts' || overlay.value === 'parts' || job.value?.wholeFinish.value).map(({ key }) => [key, t.stage.overlays[key] ?? key] as const)}
            onChange={(key) => chooseOverlay(key as Overlay)}
          />
          <SelectField
            name="look"
            label={t.stage.from}
            always
            hideLabel
            value=""
            options={[['', t.stage.from], ...Object.entries(t.stage.sides).filter(([side]) => view.value === 'object' || side !== 'below')]}
            onChange={(side) => side && stage.current?.look(side as LookFrom)}
          />
        </>
      )}
    </div>
  );
}

function Tools() {
  return (
    <div class="tools" role="group" aria-label={t.stage.tools}>
      <Button name="tool-turn" label={t.stage.turn} icon="turn" iconOnly changes pressed={tool.value === 'turn'} onClick={() => chooseTool('turn')} />
      <Button name="tool-move" label={t.stage.move} icon="move" iconOnly changes disabled={ownWay.value} pressed={tool.value === 'move'} onClick={() => chooseTool('move')} />
      <Button name="tool-face" label={t.stage.face} icon="face" iconOnly changes pressed={tool.value === 'face'} onClick={() => chooseTool('face')} />
      <Button name="fit" label={t.stage.fit} icon="fit" iconOnly onClick={() => stage.current?.fit()} />
    </div>
  );
}

function Divider() {
  const result = job.value?.result.value;
  if (view.value !== 'object' || compare.value !== 'both' || !result) return null;
  const move = (event: PointerEvent): void => {
    const box = (event.currentTarget as HTMLElement).parentElement!.getBoundingClientRect();
    divider.value = Math.min(0.98, Math.max(0.02, (event.clientX - box.left) / box.width));
  };
  const key = (event: KeyboardEvent): void => {
    const by = { ArrowLeft: -0.02, ArrowRight: 0.02 }[event.key];
    if (!by) return;
    event.preventDefault();
    divider.value = Math.min(0.98, Math.max(0.02, divider.value + by));
  };
  const left = `${100 * divider.value}%`;
  return (
    <>
      <span class="pane-label left" style={{ right: `calc(${100 - 100 * divider.value}% + 14px)` }}>{t.stage.wanted}</span>
      <span class="pane-label right" style={{ left: `calc(${left} + 14px)` }}>{t.stage.predicted}</span>
      <div
        class="divider"
        role="slider"
        tabIndex={0}
        aria-label={t.stage.divider}
        aria-valuemin={0}
        aria-valuemax={100}
        aria-valuenow={Math.round(100 * divider.value)}
        style={{ left }}
        onPointerDown={(event) => event.currentTarget.setPointerCapture(event.pointerId)}
        onPointerMove={(event) => event.buttons && move(event)}
        onKeyDown={key}
      >
        <i />
      </div>
    </>
  );
}

function Inset() {
  drawn.value;
  const at = stage.current?.inset;
  if (!at) return null;
  return (
    <button
      type="button"
      class="inset"
      title={t.stage.inset}
      aria-label={t.stage.inset}
      style={{ right: '12px', bottom: '62px', width: `${at.width + 2}px`, height: `${at.height + 2}px` }}
      onClick={() => showView(view.value === 'bath' ? 'object' : 'bath')}
    >
      <span>{view.value === 'bath' ? t.stage.object : t.stage.bath}</span>
      <Icon name="swap" />
    </button>
  );
}

function CompareBar() {
  return (
    <div class="bottombar">
      <Segments<Compare> always label={t.stage.compare} value={compare.value} options={Object.entries(t.stage.compares) as [Compare, string][]} onChange={(next) => (compare.value = next)} />
    </div>
  );
}

export function playDip(): void {
  if (playing.value) {
    playing.value = false;
    return;
  }
  showView('bath');
  tool.value = 'none';
  playing.value = true;
  void job.value?.loadFrames();
  const travel = (): number => stage.current?.travel() ?? 0;
  if (level.value >= travel() - 0.01) level.value = -1;
  let before: number | null = null;
  const stepOn = (now: number): void => {
    if (!playing.value || !stage.current) return;
    const passed = before === null ? 0 : Math.min(0.1, (now - before) / 1000);
    before = now;
    const whole = travel();
    level.value = level.value < 0 ? 0 : Math.min(whole, level.value + (passed / PLAY_SECONDS) * whole);
    if (level.value >= whole) playing.value = false;
    else requestAnimationFrame(stepOn);
  };
  requestAnimationFrame(stepOn);
}

function DipBar() {
  const whole = stage.current?.travel() ?? 0;
  drawn.value;
  const now = level.value;
  const travel = Math.max(1, whole);
  const step = travel < 20 ? 0.01 : 0.1; // so that its value is a figure that can be read out
  const [first, last] = [-Math.ceil((0.08 * travel) / step), Math.ceil(travel / step)].map((n) => +(n * step).toFixed(2)) as [number, number];
  const say = now < 0 ? t.stage.over : t.stage.at(Math.min(now, travel), stage.current?.attachedArea() ?? null);
  return (
    <div class="bottombar dipbar">
      <Button name="play" label={playing.value ? t.stage.pause : t.stage.play} icon={playing.value ? 'pause' : 'play'} iconOnly onClick={playDip} />
      <input
        type="range"
        name="level"
        aria-label={t.stage.level}
        aria-valuetext={say}
        min={first}
        max={last}
        step={step}
        value={now < 0 ? first : +now.toFixed(2)}
        onInput={(event) => {
          const to = Math.min(travel, Number(event.currentTarget.value));
          batch(() => {
            playing.value = false;
            tool.value = 'none';
            level.value = to < 0 ? -1 : to;
          });
          void job.value?.loadFrames();
        }}
      />
      <output>{say}</output>
    </div>
  );
}

function PartsLegend() {
  const finish = job.value?.finish.value;
  if (!finish) return null;
  return (
    <div class="legend">
      <p>{t.stage.partsTitle}</p>
      <div class="patches">
        {finish.dips.map(({ color, part_share }, k) => <span key={color}><i style={{ background: color }} />{t.dips.dip(k + 1)}, {t.dips.prints(part_share)}</span>)}
        <span><i style={{ background: '#a0a0a0' }} />{t.dips.none}</span>
      </div>
    </div>
  );
}

function Legend() {
  const result = job.value?.result.value ?? null;
  if (view.value !== 'object' || overlay.value === 'none' || !result) return null;
  if (overlay.value === 'parts') return <PartsLegend />;
  const text = overlayOf(overlay.value).legend(sceneOf(result, [1, 1, 1]));
  if (!text) return null;
  return (
    <div class="legend">
      <p>{text.title}</p>
      {text.gradient && (
        <div class="scale">
          <div class="ramp" style={{ background: `linear-gradient(to right,${text.gradient})` }}>
            {text.mark !== undefined && <i style={{ left: `${100 * text.mark}%` }} />}
          </div>
          <div class="ticks">{text.ticks?.map(({ at, label }) => <span key={label} style={{ left: `${100 * at}%` }}>{label}</span>)}</div>
        </div>
      )}
      <div class="patches">
        {text.patches.map(({ color, hatch, label }) => (
          <span key={label}><i class={hatch ? 'hatch' : ''} style={color ? { background: color } : {}} />{label}</span>
        ))}
      </div>
    </div>
  );
}

// What lies under the pointer, in words.
function Readout() {
  const { hit, u } = pointed.value;
  const result = job.value?.result.value;
  if (!hit || !result) return null;
  const film = result.filmMesh;
  const words: string[] = [];
  if (hit.film) {
    const fate = fateOf(film, hit.film.triangle) as string;
    if (fate === 'torn') words.push(t.stage.torn);
    else words.push(t.stage.spot((between(film, film.stretch, 1, hit.film) as number[])[0]!));
  } else if (view.value === 'object') {
    words.push(t.stage.bare);
  }
  if (u) words.push(t.stage.onSheet(...u));
  if (!words.length) return null;
  return <p class="readout" role="status">{words.join(' · ')}</p>;
}

// Dropping a picture on the object: where it was let go is where it goes.
export function droppedAt(event: DragEvent): Vec3 | null {
  const shown = stage.current;
  const box = document.querySelector('.canvas-box canvas')?.getBoundingClientRect();
  if (!shown || !box || bigSheet.value) return null;
  const hit = shown.pick(event.clientX - box.left, event.clientY - box.top);
  return hit ? (shown.toScaled(hit.place).map((c) => Math.round(c * 10) / 10) as Vec3) : null;
}
