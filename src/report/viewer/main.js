// The report page's 3D view. It takes the place of the still picture if everything it needs works.
import { make } from './dom.js';
import { drawsOnProcessor } from './edges.js';
import { legend } from './legend.js';
import { OVERLAYS } from './overlays.js';
import { between, fateOf, locate } from './pick.js';
import { readScene } from './scene.js';
import { Sheet } from './sheet.js';
import { Stage } from './stage.js';
import { BARE, NOTHING, OFF_FILM, describeFilm } from './describe.js';

const VIEWS = [
  ['both', 'Side by side'],
  ['wanted', 'Wanted'],
  ['predicted', 'Predicted'],
  ['dip', 'The dip'],
];
const SIDES = {
  result: [['front', 'Front'], ['left', 'Left'], ['right', 'Right'], ['back', 'Back'], ['above', 'Above'], ['below', 'Below']],
  dip: [['side', 'Side'], ['above', 'Above'], ['below', 'Below']],
};
const PLAY_SECONDS = 8;
// Who ordered the piece has no use for the sheet and the workshop's overlays.
const FOR_CUSTOMER = document.documentElement.dataset.for === 'customer';

class Viewer {
  constructor(root, scene, canvas, context, slow) {
    this.root = root;
    this.scene = scene;
    this.canvas = canvas;
    this.overlay = 'none';
    this.sheet = new Sheet(scene, (u) => this.pointAtSheet(u));
    this.build();
    root.hidden = false;
    this.stage = new Stage(canvas, context, slow, scene, () => this.invalidate());
    this.listen();
    this.layout();
    this.setView('both');
    this.setDepth(scene.travel_mm);
  }

  // --- The page's part ---

  build() {
    const button = (label, action, pressed) =>
      make('button', { type: 'button', onclick: action, 'aria-pressed': pressed }, label);
    const hasFilm = this.scene.film.index.length > 0; // a finish of several dips is painted on the object
    this.viewButtons = VIEWS.filter(([view]) => hasFilm || view !== 'dip').map(([view, label]) => {
      const element = button(label, () => this.setView(view), 'false');
      element.dataset.view = view;
      return element;
    });
    this.overlaySelect = make(
      'select',
      { id: 'overlay', onchange: (event) => this.setOverlay(event.target.value) },
      ...OVERLAYS.map(({ key, label, available }) =>
        make('option', { value: key, disabled: !available(this.scene) }, available(this.scene) ? label : `${label} (n/a)`),
      ),
    );
    this.gridBox = make('input', { type: 'checkbox', id: 'grid', onchange: (event) => this.stage.setGrid(event.target.checked) });
    this.sideButtons = make('div', { class: 'group', role: 'group', 'aria-label': 'Look from' });
    this.labels = make('div', { class: 'pane-labels', 'aria-hidden': 'true' });
    this.makeDipRow(button);
    this.legend = make('div', { id: 'legend' });
    this.readout = make('p', { id: 'readout', 'aria-live': 'polite' }, NOTHING);
    this.stageBox = make('div', { class: 'stage' }, this.canvas, this.labels);
    this.root.append(
      make(
        'div',
        { class: 'tools' },
        make('div', { class: 'group', role: 'group', 'aria-label': 'View' }, ...this.viewButtons),
        make('label', { hidden: FOR_CUSTOMER }, 'Show ', this.overlaySelect),
        make('label', { hidden: FOR_CUSTOMER || !hasFilm }, this.gridBox, ' 5 mm film grid'),
        this.sideButtons,
      ),
      make(
        'div',
        { class: 'panes' },
        make('div', { class: 'main-pane' }, this.stageBox, this.dipRow, this.legend),
        make('figure', { class: 'sheet-pane', hidden: FOR_CUSTOMER || !hasFilm }, this.sheet.box,
          make('figcaption', {}, 'The film image, from above. Blue line: lands on the object.', this.scene.film.torn.length ? ' Red line: tears.' : '')),
      ),
      ...(FOR_CUSTOMER ? [] : [this.readout]),
    );
    if (this.scene.object.simplified) {
      this.root.append(make('p', { class: 'hint' }, 'The object has very many triangles; here it is shown with fewer.'));
    }
  }

  makeDipRow(button) {
    const depth = this.scene.travel_mm;
    this.slider = make('input', {
      type: 'range', id: 'depth', min: '0', max: String(depth), step: 'any', value: String(depth),
      'aria-label': 'Immersion depth in mm',
      oninput: (event) => {
        this.stopPlaying();
        this.setDepth(Number(event.target.value));
      },
    });
    this.playButton = button('Play', () => (this.playing ? this.stopPlaying() : this.play()), 'false');
    this.playButton.id = 'play';
    this.depthText = make('output', { id: 'depth-text', for: 'depth' });
    this.dipRow = make('div', { id: 'dip-row', hidden: true }, this.playButton, this.slider, this.depthText);
  }

  listen() {
    const where = (event) => {
      const box = this.canvas.getBoundingClientRect();
      return [event.clientX - box.left, event.clientY - box.top];
    };
    this.canvas.addEventListener('pointermove', (event) => {
      if (event.buttons === 0) this.pointAtStage(...where(event));
    });
    this.canvas.addEventListener('pointerup', (event) => this.pointAtStage(...where(event)));
    this.canvas.addEventListener('pointerleave', (event) => {
      if (event.pointerType === 'mouse') this.show(null);
    });
    new ResizeObserver(() => this.layout()).observe(this.root);
  }

  layout() {
    this.stage.resize(this.stageBox.clientWidth, this.stageBox.clientHeight);
    this.sheet.resize();
  }

  // --- What is chosen ---

  setView(view) {
    this.view = view;
    this.stage.setView(view);
    for (const button of this.viewButtons) button.setAttribute('aria-pressed', String(button.dataset.view === view));
    this.dipRow.hidden = view !== 'dip';
    this.labels.replaceChildren(...this.stage.panes().map(({ what }) =>
      make('span', {}, { wanted: 'wanted', predicted: 'predicted', dip: '' }[what])));
    const sides = SIDES[view === 'dip' ? 'dip' : 'result'];
    this.sideButtons.replaceChildren(...sides.map(([side, label]) =>
      make('button', { type: 'button', 'data-side': side, onclick: () => this.stage.look(side) }, label)));
    this.showLegend();
    if (view !== 'dip') this.stopPlaying();
    this.show(null);
    this.layout();
    this.invalidate();
  }

  setOverlay(key) {
    this.overlay = key;
    this.overlaySelect.value = key;
    if (key !== 'none' && (this.view === 'wanted' || this.view === 'dip')) this.setView('predicted');
    this.showLegend();
    this.invalidate();
  }

  showLegend() {
    const entry = OVERLAYS.find(({ key }) => key === this.overlay);
    const shown = this.view === 'both' || this.view === 'predicted';
    this.legend.replaceChildren(...legend(shown ? entry.legend(this.scene) : null));
    this.labels.dataset.overlay = shown ? this.overlay : 'none';
  }

  setDepth(depth) {
    this.slider.value = String(depth);
    this.depth = depth;
    this.stage.setDepth(depth);
    const area = this.stage.shape.attachedArea();
    this.depthText.textContent = `${depth.toFixed(1)} mm ${this.scene.film.poses ? 'on its way' : 'deep'}, ${(area / 100).toFixed(1)} cm\u00b2 of film attached`;
    if (this.spot) this.show(this.spot);
  }

  play() {
    this.playing = true;
    this.playButton.textContent = 'Stop';
    if (this.depth >= this.scene.travel_mm) this.setDepth(0);
    let last = null;
    const step = (now) => {
      if (!this.playing) return;
      const passed = last === null ? 0 : (now - last) / 1000;
      last = now;
      this.setDepth(Math.min(this.scene.travel_mm, this.depth + (passed / PLAY_SECONDS) * this.scene.travel_mm));
      if (this.depth >= this.scene.travel_mm) this.stopPlaying();
      else requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  }

  stopPlaying() {
    this.playing = false;
    this.playButton.textContent = 'Play';
  }

  // --- The link between sheet and object ---

  pointAtStage(x, y) {
    const hit = this.stage.pick(x, y);
    if (hit?.film) this.show({ film: hit.film });
    else this.show(hit && !this.scene.looks.length ? { text: BARE } : null);
  }

  pointAtSheet(u) {
    if (!u) return this.show(null);
    const film = locate(this.scene.film, ...u);
    return this.show(film ? { film } : { text: OFF_FILM });
  }

  // A spot of the film, or a sentence, or nothing.
  show(spot) {
    this.spot = spot;
    const { film } = this.scene;
    this.readout.textContent = spot?.film ? describeFilm(this.scene, spot.film) : (spot?.text ?? NOTHING);
    this.sheet.mark(spot?.film ? between(film, film.u, 2, spot.film) : null);
    const place = spot?.film && this.placeOf(spot.film);
    this.stage.mark(place || null);
    if (place) this.root.dataset.marker = this.stage.project(place).map((x) => x.toFixed(1)).join(' ');
    else delete this.root.dataset.marker;
  }

  // Where a film spot is now; nothing for film that is not in the picture.
  placeOf(spot) {
    const { film } = this.scene;
    if (this.view === 'dip') return between(film, this.stage.shape.position, 3, spot);
    return fateOf(film, spot.triangle) === 'floats' ? null : between(film, film.position, 3, spot);
  }

  invalidate() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.stage.render(this.overlay);
      this.root.dataset.drawn = String(Number(this.root.dataset.drawn ?? 0) + 1);
    });
  }
}

async function start() {
  const source = document.getElementById('scene');
  const root = document.getElementById('viewer');
  if (!source || !root || typeof DecompressionStream === 'undefined') return;
  const canvas = make('canvas', { id: 'stage', 'aria-label': 'The object in 3D: drag to turn, wheel or pinch to zoom' });
  const slow = drawsOnProcessor();
  const context = canvas.getContext('webgl2', { antialias: !slow, alpha: true });
  if (!context) return; // the still picture remains
  const scene = await readScene(source.textContent);
  source.remove();
  new Viewer(root, scene, canvas, context, slow);
  document.documentElement.classList.add('live');
}

start().catch((error) => console.error('hydrodip: the 3D view could not be shown:', error));
