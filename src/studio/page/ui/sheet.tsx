// The film image, live, with the outline of what lands on the object. Pointing links sheet and object.
import { useEffect, useRef } from 'preact/hooks';
import { useSignal } from '@preact/signals';
import type { Result, SheetPicture } from '../api.ts';
import { layersOf, withLayer, type Vec3 } from '../document.ts';
import { between, fateOf, locate } from '../../../report/viewer/pick.js';
import { outlineEdges } from '../../../report/viewer/film_shape.js';
import { change, job, layer, pointed, readOnly, stage, value } from '../studio.ts';
import { t } from '../strings.ts';

interface Picture {
  result: Result;
  printed: SheetPicture;
  canvas: HTMLCanvasElement;
  lands: Path2D;
  torn: Path2D;
}

let last: Picture | null = null;

// Of several dips each prints its own part.
function printedOf(result: Result): SheetPicture {
  const part = job.value?.wholeFinish.value?.sheets[result.dip];
  return part ?? { ...result.sheet, rgba: result.printed };
}

function pictureOf(result: Result): Picture {
  const printed = printedOf(result);
  if (last?.result === result && last.printed.rgba === printed.rgba) return last;
  const { width_px: w, height_px: h } = printed;
  const canvas = document.createElement('canvas');
  [canvas.width, canvas.height] = [w, h];
  canvas.getContext('2d')!.putImageData(new ImageData(new Uint8ClampedArray(printed.rgba), w, h), 0, 0);
  const { index, u, lying, tornList } = result.filmMesh;
  const outline = (triangles: number[]): Path2D => {
    const path = new Path2D();
    for (const { a, b } of outlineEdges(index, triangles) as { a: number; b: number }[]) {
      path.moveTo(u[2 * a]!, -u[2 * a + 1]!);
      path.lineTo(u[2 * b]!, -u[2 * b + 1]!);
    }
    return path;
  };
  last = { result, printed, canvas, lands: outline(lying), torn: outline(tornList) };
  return last;
}

function draw(canvas: HTMLCanvasElement, result: Result, scale: number): void {
  const ratio = Math.min(2, window.devicePixelRatio);
  const { width_mm: w, height_mm: h, margin_mm: m, shape } = result.film;
  canvas.width = Math.max(1, Math.round(w * scale * ratio));
  canvas.height = Math.max(1, Math.round(h * scale * ratio));
  const context = canvas.getContext('2d')!;
  const picture = pictureOf(result);
  context.fillStyle = '#ffffff';
  context.fillRect(0, 0, canvas.width, canvas.height);
  context.imageSmoothingQuality = 'high';
  context.drawImage(picture.canvas, 0, 0, canvas.width, canvas.height);
  context.setTransform(scale * ratio, 0, 0, scale * ratio, canvas.width / 2, canvas.height / 2);
  context.beginPath();
  context.rect(-w / 2, -h / 2, w, h);
  if (shape === 'disc') context.arc(0, 0, Math.max(1, Math.min(w, h) / 2 - m), 0, 2 * Math.PI, true);
  else context.rect(w / 2 - m, -h / 2 + m, -(w - 2 * m), h - 2 * m);
  context.fillStyle = '#e4d6b6';
  context.fill('evenodd');
  context.lineWidth = 1.4 / scale;
  context.strokeStyle = '#2f6db3';
  context.stroke(picture.lands);
  context.strokeStyle = '#c2002c';
  context.stroke(picture.torn);
}

const TRUE_SIZE = 96 / 25.4; // CSS pixels a millimetre
const LENS = 132;

export function Sheet({ big = false }: { big?: boolean }) {
  const box = useRef<HTMLDivElement>(null);
  const canvas = useRef<HTMLCanvasElement>(null);
  const lens = useRef<HTMLCanvasElement>(null);
  const room = useSignal({ width: 0, height: 0 });
  const at = useSignal<{ u: [number, number]; x: number; y: number } | null>(null);
  const drag = useRef<{ u: [number, number]; from: Vec3 } | null>(null);
  const result = job.value?.result.value ?? null;
  const finish = job.value?.wholeFinish.value ?? null;

  useEffect(() => {
    const observer = new ResizeObserver(([entry]) => {
      const { width, height } = entry!.contentRect;
      room.value = { width, height };
    });
    observer.observe(box.current!);
    return () => observer.disconnect();
  }, []);

  const width = result?.film.width_mm ?? value<number>('film.width_mm');
  const height = result?.film.height_mm ?? value<number>('film.height_mm');
  const scale = Math.min(room.value.width / width, (big ? room.value.height : Math.min(room.value.height, 420)) / height) || 0;

  useEffect(() => {
    if (canvas.current && result && scale > 0) draw(canvas.current, result, scale);
  }, [result, finish, scale]);

  useEffect(() => {
    const glass = lens.current;
    const spot = at.value;
    if (!glass || !spot || !result) return;
    const source = pictureOf(result).canvas;
    const pixel_mm = result.film.width_mm / source.width;
    const context = glass.getContext('2d')!;
    const half_mm = LENS / TRUE_SIZE / 2;
    const half = half_mm / pixel_mm;
    const x = (spot.u[0] + width / 2) / pixel_mm;
    const y = (height / 2 - spot.u[1]) / pixel_mm;
    context.fillStyle = '#ffffff';
    context.fillRect(0, 0, glass.width, glass.height);
    context.drawImage(source, x - half, y - half, 2 * half, 2 * half, 0, 0, glass.width, glass.height);
  }, [at.value, result]);

  const where = (event: PointerEvent): { u: [number, number]; x: number; y: number } => {
    const area = canvas.current!.getBoundingClientRect();
    const x = event.clientX - area.left;
    const y = event.clientY - area.top;
    return { u: [x / scale - width / 2, height / 2 - y / scale], x, y };
  };
  const pattern = (): number | null => {
    const chosen = layer.value;
    const entry = chosen === null ? null : layersOf(job.value!.document.value)[chosen];
    return entry?.projection === 'film' && !readOnly.value ? chosen : null;
  };
  const slide = (event: PointerEvent, live: boolean): void => {
    const chosen = pattern();
    if (chosen === null || !drag.current) return;
    const { u } = where(event);
    const { from, u: begin } = drag.current;
    const tenth = (length: number): number => Math.round(length * 10) / 10 + 0;
    const at_mm: Vec3 = [tenth(from[0] + u[0] - begin[0]), tenth(from[1] + u[1] - begin[1]), 0];
    change((document) => withLayer(document, chosen, { at_mm }), t.undo.layerMove, live);
  };
  const point = (event: PointerEvent): void => {
    if (!result) return;
    const spot = where(event);
    at.value = spot;
    const film = locate(result.filmMesh, ...spot.u) as { triangle: number; weights: [number, number, number] } | null;
    const lies = film && fateOf(result.filmMesh, film.triangle) !== 'floats';
    const place = lies ? (between(result.filmMesh, result.filmMesh.position, 3, film) as Vec3) : null;
    stage.current?.mark(place);
    pointed.value = { hit: film && place ? { film, place, normal: [0, 0, 1] } : null, u: spot.u };
  };
  const leave = (): void => {
    at.value = null;
    stage.current?.mark(null);
    pointed.value = { hit: null, u: null };
  };
  const mark = pointed.value.u;
  return (
    <div class={big ? 'sheet big' : 'sheet'} ref={box} data-result={result?.result ?? ''}>
      {result ? (
        <div class="paper" style={{ width: `${width * scale}px`, height: `${height * scale}px` }}>
          <canvas
            ref={canvas}
            role="img"
            aria-label={t.sheet.label(+width.toFixed(0), +height.toFixed(0))}
            class={pattern() === null ? '' : 'slides'}
            onPointerDown={(event) => {
              const chosen = pattern();
              if (chosen === null) return;
              event.currentTarget.setPointerCapture(event.pointerId);
              drag.current = { u: where(event).u, from: layersOf(job.value!.document.value)[chosen]!.at_mm ?? [0, 0, 0] };
            }}
            onPointerMove={(event) => (drag.current ? slide(event, true) : point(event))}
            onLostPointerCapture={(event) => {
              slide(event, false);
              drag.current = null;
            }}
            onPointerLeave={leave}
          />
          {mark && <i class="dot" style={{ left: `${(mark[0] + width / 2) * scale}px`, top: `${(height / 2 - mark[1]) * scale}px` }} />}
          {at.value && !drag.current && (
            <canvas
              ref={lens}
              class="lens"
              width={LENS}
              height={LENS}
              aria-hidden="true"
              style={{
                left: `${Math.min(Math.max(0, at.value.x - LENS / 2), Math.max(0, width * scale - LENS))}px`,
                top: `${at.value.y > LENS + 20 ? at.value.y - LENS - 14 : at.value.y + 18}px`,
              }}
            />
          )}
        </div>
      ) : (
        <div class="paper blank" style={{ width: `${width * scale}px`, height: `${height * scale}px` }}>
          <p class="soft">{t.sheet.none}</p>
        </div>
      )}
    </div>
  );
}
