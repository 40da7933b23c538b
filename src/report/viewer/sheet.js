// The sheet beside the object: the film image, what of it lands on the object, and the point that
// is being looked at.
import { make } from './dom.js';
import { outlineEdges } from './film_shape.js';

export class Sheet {
  constructor(scene, onPoint) {
    this.scene = scene;
    const { sheet } = scene;
    this.canvas = make('canvas', { 'aria-hidden': 'true' });
    this.dot = make('i', { class: 'dot', hidden: true });
    this.box = make(
      'div',
      {
        id: 'sheet',
        style: `aspect-ratio:${sheet.width_mm}/${sheet.height_mm}`,
        onpointermove: (event) => onPoint(this.toFilm(event)),
        onpointerdown: (event) => onPoint(this.toFilm(event)),
        onpointerleave: () => onPoint(null),
      },
      sheet.picture ? make('img', { src: sheet.picture, alt: 'The film image, seen from above', draggable: 'false' }) : '',
      this.canvas,
      this.dot,
    );
    this.outline = outlineEdges(scene.film.index, scene.film.lying);
    this.tears = outlineEdges(scene.film.index, scene.film.torn);
  }

  // mm from the sheet's centre, x right, y up.
  toFilm(event) {
    const box = this.box.getBoundingClientRect();
    const { width_mm: width, height_mm: height } = this.scene.sheet;
    return [
      ((event.clientX - box.left) / box.width - 0.5) * width,
      (0.5 - (event.clientY - box.top) / box.height) * height,
    ];
  }

  mark(u) {
    this.dot.hidden = !u;
    if (!u) return;
    const { width_mm: width, height_mm: height } = this.scene.sheet;
    this.dot.style.left = `${100 * (u[0] / width + 0.5)}%`;
    this.dot.style.top = `${100 * (0.5 - u[1] / height)}%`;
  }

  resize() {
    const ratio = Math.min(2, window.devicePixelRatio);
    this.canvas.width = Math.round(this.box.clientWidth * ratio);
    this.canvas.height = Math.round(this.box.clientHeight * ratio);
    const pen = this.canvas.getContext('2d');
    this.stroke(pen, this.outline, 'rgba(20,60,90,0.75)', ratio);
    this.stroke(pen, this.tears, 'rgba(190,0,30,0.9)', ratio);
  }

  stroke(pen, edges, color, width) {
    const { u } = this.scene.film;
    const { width_mm, height_mm } = this.scene.sheet;
    const x = (v) => (u[2 * v] / width_mm + 0.5) * this.canvas.width;
    const y = (v) => (0.5 - u[2 * v + 1] / height_mm) * this.canvas.height;
    pen.strokeStyle = color;
    pen.lineWidth = width;
    pen.beginPath();
    for (const { a, b } of edges) {
      pen.moveTo(x(a), y(a));
      pen.lineTo(x(b), y(b));
    }
    pen.stroke();
  }
}
