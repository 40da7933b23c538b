// What is taken hold of in the 3D view: the water line, and the chosen layer's place, width and turn. One kind at a time,
// for what is being worked on, so that none lies on another.
import { useRef } from 'preact/hooks';
import { api } from '../api.ts';
import { isRound, layerName, layerWidth, resized, withLayer, type Layer, type Vec3 } from '../document.ts';
import { changePose, change, chosenLayer, drawn, job, layer, ownWay, pose, readOnly, stage, step, tool, view } from '../studio.ts';
import { t } from '../strings.ts';
import { Icon } from './icons.tsx';

const DEPTH_WIDE = 100; // px: the depth handle with its figure
const UNDER_BAR = 76; // px: over the view's upper edge lie its controls

const turnsOrMoves = (): boolean => tool.value === 'turn' || tool.value === 'move';
const laysArtwork = (): boolean => chosenLayer.value !== null && step.value === 'artwork' && !turnsOrMoves();

const tenth = (length: number): number => Math.round(length * 10) / 10 + 0;

export function DepthHandle() {
  drawn.value;
  const drag = useRef<{ y: number; depth: number; pixel: number } | null>(null);
  const shown = stage.current;
  if (!shown || readOnly.value || ownWay.value || !shown.extent()[2] || laysArtwork() || turnsOrMoves()) return null;
  const end = shown.waterLineEnd();
  if (end.behind) return null;
  const { x, y } = shown.within(end, 14, DEPTH_WIDE);
  const at = { x, y: Math.max(UNDER_BAR, y) };
  const height = shown.extent()[2];
  const depth = shown.depth();
  const set = (next: number, live: boolean): void => {
    const limited = Math.min(height, Math.max(0.5, next));
    changePose({ depth_mm: limited > height - 0.05 ? 0 : tenth(limited) }, live);
  };
  return (
    <div
      class="depth-handle"
      role="slider"
      tabIndex={0}
      data-name="depth-handle"
      aria-label={t.stage.depth}
      aria-orientation="vertical"
      aria-valuemin={0}
      aria-valuemax={Math.round(height)}
      aria-valuenow={tenth(depth)}
      aria-valuetext={pose.value.depth_mm ? t.steps.deep(depth) : t.steps.wholeDepth}
      style={{ transform: `translate(${Math.round(at.x)}px, ${Math.round(at.y)}px)` }}
      onPointerDown={(event) => {
        event.currentTarget.setPointerCapture(event.pointerId);
        drag.current = { y: event.clientY, depth, pixel: shown.pixel_mm([0, 0, depth]) };
      }}
      onPointerMove={(event) => {
        const begun = drag.current;
        if (begun) set(begun.depth - (event.clientY - begun.y) * begun.pixel, true);
      }}
      onLostPointerCapture={(event) => {
        const begun = drag.current;
        drag.current = null;
        if (begun) set(begun.depth - (event.clientY - begun.y) * begun.pixel, false);
      }}
      onKeyDown={(event) => {
        const by = { ArrowUp: 1, ArrowDown: -1, PageUp: 10, PageDown: -10 }[event.key];
        if (!by) return;
        event.preventDefault();
        set(depth + by, false);
      }}
    >
      <i />
      <span>{pose.value.depth_mm ? t.mm(depth) : t.model.depthWhole}</span>
    </div>
  );
}

interface Frame {
  center: Vec3; // posed frame
  right: Vec3;
  up: Vec3;
  upright: Vec3; // before it is turned
  width: number;
  height: number;
  bent: boolean; // it goes round the object: only its centre is known
}

const cross = (a: Vec3, b: Vec3): Vec3 => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const dot = (a: Vec3, b: Vec3): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const plus = (a: Vec3, b: Vec3, times = 1): Vec3 => [a[0] + times * b[0], a[1] + times * b[1], a[2] + times * b[2]];
const unit = (a: Vec3): Vec3 => {
  const length = Math.hypot(...a) || 1;
  return [a[0] / length, a[1] / length, a[2] / length];
};

const PARALLEL = 0.9; // of directions; as in src/artwork/projector.cpp

// Width over height of a picture or a text; 1 until it is known.
const aspects = new Map<string, number>();
function aspectOf(entry: Layer): number {
  if (entry.text !== undefined) {
    const context = document.createElement('canvas').getContext('2d')!;
    context.font = `${entry.font?.includes('bold') ? 'bold ' : ''}100px sans-serif`;
    const lines = entry.text.split('\n');
    return Math.max(0.1, ...lines.map((line) => context.measureText(line).width)) / (110 * lines.length);
  }
  const url = api.fileUrl(job.value!.id, entry.image ?? '');
  const known = aspects.get(url);
  if (known) return known;
  aspects.set(url, 1);
  const image = new Image();
  image.onload = () => {
    if (image.naturalHeight) aspects.set(url, image.naturalWidth / image.naturalHeight);
    stage.current?.invalidate();
  };
  image.src = url;
  return 1;
}

// Where the chosen layer is. What the document leaves open is chosen as the program does
// (src/artwork/projector.cpp), so that the handles lie on the picture.
export function frameOf(entry: Layer): Frame | null {
  const shown = stage.current;
  if (!shown || entry.projection === 'film' || entry.projection === 'uv') return null;
  const bent = isRound(entry.projection);
  if (bent && !entry.at_mm) return null; // where it lies goes by the whole surface, which only the program looks at
  const flat = entry.projection === undefined || entry.projection === 'planar' || entry.projection === 'wrap';
  const far = 2 * Math.hypot(...shown.extent());
  if (far === 0) return null; // no model yet
  const given = entry.at_mm ? shown.toPosed(entry.at_mm) : null;
  const boxed = entry.projection === 'box' && !given; // the front side's picture
  let toward: Vec3 | null = entry.toward && (flat || boxed) ? shown.directionToPosed(entry.toward) : null;
  if (given && !toward) {
    // Square onto the surface there.
    const out = unit(plus(given, shown.center_mm, -1));
    const met = shown.meet(plus(given, out, far), [-out[0], -out[1], -out[2]]);
    toward = (met ? met.normal : out).map((c) => -c) as Vec3;
  }
  const front: Vec3 = entry.up && Math.abs(unit(entry.up)[1]) >= PARALLEL ? [0, 0, -1] : [0, 1, 0];
  toward = unit(toward ?? (boxed ? shown.directionToPosed(front) : [0, 0, 1]));
  const chosen = shown.directionToScaled(toward);
  const upright: Vec3 = entry.up ?? (Math.abs(chosen[2]) < PARALLEL ? [0, 0, 1] : [0, 1, 0]);
  let up = shown.directionToPosed(upright);
  up = unit(plus(up, toward, -dot(up, toward)));
  const right = unit(cross(toward, up));
  const [across, along] = [shown.reach(right), shown.reach(up)];
  const middle = plus(right.map((c) => (c * (across[0] + across[1])) / 2) as Vec3, up, (along[0] + along[1]) / 2);
  const center = given ?? shown.meet(plus(middle, toward, -far), toward)?.place ?? middle;
  const turn = ((entry.turn_deg ?? 0) * Math.PI) / 180;
  const [sine, cosine] = [Math.sin(turn), Math.cos(turn)];
  const room = (direction: Vec3, [least, most]: [number, number]): number =>
    Math.max(1, Math.min(dot(center, direction) - least, most - dot(center, direction)));
  const tall = Array.isArray(entry.size_mm) ? entry.size_mm[1] / entry.size_mm[0] : 1 / aspectOf(entry);
  const fits = 2 * Math.min(
    room(right, across) / (Math.abs(cosine) + tall * Math.abs(sine)),
    room(up, along) / (Math.abs(sine) + tall * Math.abs(cosine)),
  );
  const width = layerWidth(entry) ?? fits;
  return {
    center: plus(center, toward, -0.5),
    right: plus(right.map((c) => c * cosine) as Vec3, up, sine),
    up: plus(up.map((c) => c * cosine) as Vec3, right, -sine),
    upright: up,
    width,
    height: width * tall,
    bent,
  };
}

interface Point {
  x: number;
  y: number;
}

type Grip = 'move' | 'scale' | 'turn';

export function ArtworkHandles() {
  drawn.value;
  const drag = useRef<{ grip: Grip; x: number; y: number; entry: Layer; frame: Frame; middle: { x: number; y: number } } | null>(null);
  const entry = chosenLayer.value;
  const at = layer.value;
  const shown = stage.current;
  if (!entry || at === null || !shown || readOnly.value || !laysArtwork()) return null;
  const frame = frameOf(entry);
  if (!frame) return null;
  const corner = (x: number, y: number): Vec3 => plus(plus(frame.center, frame.right, (x * frame.width) / 2), frame.up, (y * frame.height) / 2);
  const points = [corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)].map((p) => shown.project(p));
  const middle = shown.project(frame.center);
  if (middle.behind || (!frame.bent && points.some((p) => p.behind))) return null;
  const name = layerName(entry);
  // A finger's width apart, however small the picture is, and within the view, however large.
  const apart = matchMedia('(pointer: coarse)').matches ? 48 : 34;
  const grip = shown.within(beyond(middle, shown.project(corner(1, -1)), apart), apart / 2);
  const top = shown.within(beyond(middle, shown.project(corner(0, 1.25)), apart), apart / 2);
  const edge = shown.project(corner(0, 1));
  // Handles of what lies behind would pass for those of what is in front.
  if (!drag.current && shown.hides(frame.center)) return <Behind name={name} at={shown.within(middle, 80)} onShow={() => shown.showPlace(frame.center, false)} />;
  const set = (part: Partial<Layer>, label: string, live: boolean): void => change((document) => withLayer(document, at, part), label, live);
  const follow = (event: PointerEvent, live: boolean): void => {
    const begun = drag.current;
    if (!begun) return;
    const box = (event.currentTarget as HTMLElement).parentElement!.getBoundingClientRect();
    const [x, y] = [event.clientX - box.left, event.clientY - box.top];
    if (begun.grip === 'move') {
      const hit = shown.pick(x - begun.x, y - begun.y);
      if (!hit) {
        if (!live) set({}, t.undo.layerMove, false);
        return;
      }
      const flat = entry.projection === undefined || entry.projection === 'planar';
      const inward = shown.directionToScaled(hit.normal.map((c) => -c) as Vec3).map((c) => Math.round(c * 1000) / 1000 + 0) as Vec3;
      // It stays upright as it was: else it would turn about where its own choice of up changes.
      const upright = shown.directionToScaled(begun.frame.upright).map((c) => Math.round(c * 1000) / 1000 + 0) as Vec3;
      const aims = Math.abs(dot(unit(upright), unit(inward))) < PARALLEL ? { toward: inward, up: upright } : { toward: inward };
      set({ at_mm: shown.toScaled(hit.place).map(tenth) as Vec3, ...(flat ? aims : {}) }, t.undo.layerMove, live);
    } else if (begun.grip === 'scale') {
      const before = Math.hypot(begun.x, begun.y) || 1;
      const now = Math.hypot(x - begun.middle.x, y - begun.middle.y);
      const width = Math.max(0.5, (begun.frame.width * now) / before);
      set({ size_mm: resized(begun.entry, width) }, t.undo.layerSize, live);
    } else {
      const before = Math.atan2(begun.y, begun.x);
      const now = Math.atan2(y - begun.middle.y, x - begun.middle.x);
      const step = event.shiftKey ? 15 : 1;
      const turned = (begun.entry.turn_deg ?? 0) - ((now - before) * 180) / Math.PI;
      const rounded = Math.round((((turned + 540) % 360) - 180) / step) * step;
      set({ turn_deg: rounded || undefined }, t.undo.layerTurn, live);
    }
  };
  const handle = (what: Grip, place: { x: number; y: number }, label: string) => (
    <div
      class={`grip ${what}`}
      role="button"
      tabIndex={0}
      aria-label={label}
      title={label}
      data-grip={what}
      style={{ transform: `translate(${place.x}px, ${place.y}px)` }}
      onPointerDown={(event) => {
        event.currentTarget.setPointerCapture(event.pointerId);
        const box = event.currentTarget.parentElement!.getBoundingClientRect();
        const [x, y] = [event.clientX - box.left, event.clientY - box.top];
        const offset = what === 'move' ? { x: x - middle.x, y: y - middle.y } : { x: x - middle.x, y: y - middle.y };
        drag.current = { grip: what, ...offset, entry, frame, middle };
      }}
      onPointerMove={(event) => follow(event, true)}
      onLostPointerCapture={(event) => {
        follow(event, false);
        drag.current = null;
      }}
      onKeyDown={(event) => {
        const by = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1 }[event.key];
        if (!by) return;
        event.preventDefault();
        if (what === 'scale') set({ size_mm: resized(entry, Math.max(0.5, frame.width + by)) }, t.undo.layerSize, false);
        if (what === 'turn') set({ turn_deg: ((entry.turn_deg ?? 0) + 5 * by) || undefined }, t.undo.layerTurn, false);
        if (what === 'move') nudge(event.key, frame, entry, set);
      }}
    >
      <i />
    </div>
  );
  return (
    <div class="artwork-handles" data-view={view.value}>
      {!frame.bent && (
        <svg aria-hidden="true">
          <polygon points={points.map((p) => `${p.x},${p.y}`).join(' ')} />
          <line x1={edge.x} y1={edge.y} x2={top.x} y2={top.y} />
        </svg>
      )}
      {handle('move', middle, t.artwork.move(name))}
      {!frame.bent && handle('scale', grip, t.artwork.scale(name))}
      {!frame.bent && handle('turn', top, t.artwork.rotate(name))}
    </div>
  );
}

// The point, or one in its direction that is so far from there.
function beyond(from: Point, to: Point, least: number): Point {
  const [x, y] = [to.x - from.x, to.y - from.y];
  const far = Math.hypot(x, y);
  if (far >= least) return to;
  return far > 0 ? { x: from.x + (x * least) / far, y: from.y + (y * least) / far } : { x: from.x + least, y: from.y };
}

function Behind({ name, at, onShow }: { name: string; at: Point; onShow: () => void }) {
  return (
    <div class="artwork-handles">
      <button type="button" class="behind" data-name="behind" title={t.artwork.behindLong(name)} aria-label={t.artwork.behindLong(name)} style={{ transform: `translate(${at.x}px, ${at.y}px) translate(-50%, -50%)` }} onClick={onShow}>
        <Icon name="eye" /> {t.artwork.behind}
      </button>
    </div>
  );
}

// By a millimetre along the picture's own edges, and back onto the surface.
function nudge(key: string, frame: Frame, entry: Layer, set: (part: Partial<Layer>, label: string, live: boolean) => void): void {
  const shown = stage.current!;
  const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[key]!;
  const moved = plus(plus(frame.center, frame.right, way[0]), frame.up, way[1]);
  const toward = cross(frame.up, frame.right);
  const reach = 2 * Math.hypot(...shown.extent());
  const met = shown.meet(plus(moved, toward, -reach), toward);
  if (!met) return;
  set({ at_mm: shown.toScaled(met.place).map(tenth) as Vec3, toward: entry.toward }, t.undo.layerMove, false);
}
