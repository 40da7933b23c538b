// The report page in a headless Chromium: the verdict without scripts, the 3D view's slider,
// overlays and link between sheet and object, and no complaint on the console. Usage:
// node report.mjs HYDRODIP [CHROMIUM]; exit code 77 (skipped) where there is no Chromium.
import assert from 'node:assert/strict';
import { execFileSync, spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';
import { Browser } from './browser.mjs';

const hydrodip = resolve(process.argv[2]);
const chromium = process.argv[3] || 'chromium';
if (spawnSync(chromium, ['--version']).status !== 0) {
  console.log(`skipped: there is no ${chromium}`);
  process.exit(77);
}

const QUICK = ['film.elements=3000', 'dip.step_mm=2', 'preview.width_px=300', 'print.samples=1', 'print.dpi=72'];
const work = mkdtempSync(join(tmpdir(), 'hydrodip-viewer-'));
process.on('exit', () => rmSync(work, { recursive: true, force: true }));
const tests = [];
const test = (name, body) => tests.push({ name, body });

function job(name, model, ...options) {
  const sets = QUICK.flatMap((setting) => ['--set', setting]);
  execFileSync(hydrodip, ['print', model, '--film', 'a4', '-o', name, '--quiet', ...sets, ...options], { cwd: work });
  const page = join(work, name, 'report.html');
  return { url: pathToFileURL(page).href, page, json: JSON.parse(readFileSync(join(work, name, 'report.json'))) };
}

// The sample's sphere and colours with few triangles: what draws here is a processor.
function coarseSphere(file) {
  const [radius, rings, around] = [30, 40, 64];
  const lines = ['mtllib sphere.mtl', 'usemtl sphere'];
  for (let i = 0; i <= rings; ++i) {
    const [out, up] = [Math.sin((Math.PI * i) / rings), -Math.cos((Math.PI * i) / rings)];
    for (let k = 0; k < around; ++k) {
      const [x, y] = [out * Math.cos((2 * Math.PI * k) / around), out * Math.sin((2 * Math.PI * k) / around)];
      lines.push(`v ${radius * x} ${radius * y} ${radius * (1 + up)}`, `vt ${0.5 - x / 2} ${0.5 + y / 2}`);
    }
  }
  const at = (i, k) => `${i * around + (k % around) + 1}/${i * around + (k % around) + 1}`;
  for (let i = 0; i < rings; ++i) {
    for (let k = 0; k < around; ++k) {
      if (i > 0) lines.push(`f ${at(i, k)} ${at(i, k + 1)} ${at(i + 1, k)}`);
      if (i < rings - 1) lines.push(`f ${at(i, k + 1)} ${at(i + 1, k + 1)} ${at(i + 1, k)}`);
    }
  }
  writeFileSync(join(work, file), `${lines.join('\n')}\n`);
}

for (const name of ['mask', 'sphere']) execFileSync(hydrodip, ['sample', name], { cwd: work });
coarseSphere('coarse.obj');
const mask = job('mask', 'mask.obj');
const partial = job('partial', 'coarse.obj', '--depth', '12');
const failed = job('failed', 'coarse.obj'); // past its equator: torn all around

const browser = await Browser.start(chromium);

// --- Helpers in the page ---

// A small window.
const openView = async ({ url }, options = {}) => {
  await browser.open(url, { width: 760, height: 560, ...options });
  await browser.until('document.documentElement.classList.contains("live")', 'the 3D view');
  await settle();
};
// Until nothing has been drawn for a while: pictures load after the first drawing.
const settle = async () => {
  for (let quiet = 0, last = ''; quiet < 3; ) {
    await new Promise((done) => setTimeout(done, 40));
    const drawn = await browser.value('document.querySelector("#viewer").dataset.drawn ?? ""');
    quiet = drawn === last && drawn !== '' ? quiet + 1 : 0;
    last = drawn;
  }
};
const choose = async (selector, value, event) => {
  await browser.value(`(() => { const e = document.querySelector('${selector}'); e.value = '${value}';
    e.dispatchEvent(new Event('${event}', { bubbles: true })); })()`);
  await settle();
};
const view = async (name) => {
  await browser.click(`[data-view=${name}]`);
  await settle();
};
const stage = () => browser.picture({ selector: '.stage' });
const text = (selector) => browser.value(`document.querySelector('${selector}').innerText`);
const shown = (selector) => browser.value(`document.querySelector('${selector}').getClientRects().length > 0`);
const hoverSheet = async (right, up) => {
  const box = await browser.box('#sheet');
  await browser.hover(box.x + (0.5 + right / 210) * box.width, box.y + (0.5 - up / 297) * box.height);
  return text('#readout');
};
const dotOnSheet = () => browser.value(`(() => { const d = document.querySelector('#sheet .dot');
  return d.hidden ? null : [(parseFloat(d.style.left) / 100 - 0.5) * 210, (0.5 - parseFloat(d.style.top) / 100) * 297]; })()`);
const film = async () => Number(/([\d.]+) cm/.exec(await text('#depth-text'))[1]);

// --- What must hold ---

test('opens without a complaint, asks for nothing, and fits the window', async () => {
  const wide = { width: 1000, height: 560 };
  const phone = { width: 390, height: 560 };
  for (const [{ url }, size] of [[mask, wide], [partial, phone], [failed, phone]]) {
    await openView({ url }, size);
    assert.deepEqual(browser.complaints, []);
    assert.ok(!(await shown('#still')), 'the view takes the still picture\'s place');
    assert.ok((await browser.value('document.documentElement.scrollWidth')) <= size.width, `wider than ${size.width}`);
  }
});

test('its buttons are within the page, and in one line where there is room', async () => {
  for (const [width, lines] of [[1200, 1], [820, 2], [390, 3]]) {
    await openView(mask, { width, height: 560 });
    const parts = await browser.value(`[...document.querySelectorAll('.tools > *')].map((e) => e.getBoundingClientRect()).map((r) => [r.left, r.right, r.top + r.height / 2])`);
    for (const [left, right] of parts) assert.ok(left >= 0 && right <= width, `${left} to ${right} of ${width}`);
    const middles = parts.map(([, , middle]) => middle).sort((a, b) => a - b);
    assert.equal(middles.filter((middle, k) => k === 0 || middle - middles[k - 1] > 12).length, lines, `lines at ${width}`);
  }
});

test('is a small page', async () => {
  for (const { page } of [mask, partial, failed]) assert.ok(readFileSync(page).length < 15e6);
});

test('says first what to expect, without scripts, without WebGL and on paper too', async () => {
  await browser.open(failed.url, { scripts: false, width: 390, height: 844 });
  await browser.send('Emulation.setScriptExecutionDisabled', { value: false });
  assert.equal(await text('#verdict h2'), 'Do not dip it like this');
  assert.ok((await browser.box('#verdict h2')).y < 844);
  assert.match(await text('.findings .stop'), /Tears.*%[^]*(--rotate)/);
  assert.ok(await shown('#still img'));

  const { identifier } = await browser.send('Page.addScriptToEvaluateOnNewDocument', {
    source: 'HTMLCanvasElement.prototype.getContext = () => null',
  });
  await browser.open(mask.url);
  assert.ok((await shown('#still img')) && !(await shown('#viewer')));
  assert.deepEqual(browser.complaints, []);
  await browser.send('Page.removeScriptToEvaluateOnNewDocument', { identifier });

  await openView(mask);
  await browser.send('Emulation.setEmulatedMedia', { media: 'print' });
  assert.ok((await shown('#still img')) && !(await shown('#viewer')) && (await shown('#verdict')));
});

test('the slider moves object, film and contact line', async () => {
  await openView(partial);
  await view('dip');
  const depth = partial.json.figures.depth_mm;
  let last = -1;
  const pictures = [];
  for (const share of [0, 0.4, 1]) {
    await choose('#depth', share * depth, 'input');
    assert.match(await text('#depth-text'), new RegExp(`^${(share * depth).toFixed(1)} mm deep`));
    const area = await film();
    assert.ok(area > last || share === 0, 'more and more film is attached');
    last = area;
    pictures.push((await stage()).toString('base64'));
  }
  assert.equal(new Set(pictures).size, pictures.length, 'every depth looks different');
  const { film_on_object_mm2: lying, torn_mm2: torn } = partial.json.coverage;
  assert.ok(Math.abs(100 * last - lying - torn) < 0.03 * lying, `${100 * last} mm2 at the end, ${lying + torn} in report.json`);
  await choose('#depth', 0, 'input');
  assert.equal(await film(), 0);

  await browser.click('#play');
  await browser.until('Number(document.querySelector("#depth").value) > 0', 'the animation');
  await browser.click('#play');
  assert.deepEqual(browser.complaints, []);
});

test('every overlay changes the picture and explains itself', async () => {
  await openView(failed);
  await view('predicted');
  const plain = await stage();
  const pictures = [plain.toString('base64')];
  for (const overlay of ['stretch', 'angle', 'tears', 'coverage', 'color_error']) {
    await choose('#overlay', overlay, 'change');
    pictures.push((await stage()).toString('base64'));
    assert.ok((await text('#legend')).length > 20, `${overlay} has a legend`);
  }
  assert.equal(new Set(pictures).size, pictures.length, 'all look different');
  const offered = await browser.value('[...document.querySelectorAll("#overlay option")].map((o) => o.textContent)');
  const named = [...(await text('.findings')).matchAll(/The overlay "([^"]+)" shows where/g)].map((match) => match[1]);
  assert.ok(named.includes('tears'), 'the cards say where film tears');
  for (const overlay of named) assert.ok(offered.includes(overlay), `${overlay} is among ${offered}`);
  await choose('#overlay', 'angle', 'change');
  assert.match(await text('#legend'), /45\u00b0/);
  await choose('#overlay', 'none', 'change');
  assert.ok(plain.equals(await stage()), 'and back');
  await browser.click('#grid');
  await settle();
  assert.ok(!plain.equals(await stage()), 'the grid shows');
  assert.deepEqual(browser.complaints, []);
});

test('side by side, both views turn together', async () => {
  await openView(partial);
  await browser.click('[data-side=front]');
  await settle();
  await browser.hover(2, 2);
  await settle();
  const before = await stage();
  const { x, y, width, height } = await browser.box('.stage');
  const at = { x: x + 0.25 * width, y: y + 0.5 * height, button: 'left', buttons: 1, clickCount: 1 };
  await browser.send('Input.dispatchMouseEvent', { type: 'mousePressed', ...at });
  await browser.send('Input.dispatchMouseEvent', { type: 'mouseMoved', ...at, x: at.x + 60 });
  await browser.send('Input.dispatchMouseEvent', { type: 'mouseReleased', ...at, x: at.x + 60, buttons: 0 });
  await settle();
  assert.ok(!before.equals(await stage()));
  await browser.click('[data-side=front]');
  await settle();
  await browser.hover(2, 2);
  await settle();
  assert.ok(before.equals(await stage()), 'and back to the front');
});

test('without a graphics card edges are rough while the view moves, and smooth when it rests', async () => {
  const fineness = '(() => { const c = document.querySelector("#stage"); return Math.round(c.width / c.clientWidth); })()';
  const turn = (type, right, buttons) =>
    browser.send('Input.dispatchMouseEvent', { type, x: 200 + right, y: 300, button: 'left', buttons, clickCount: 1 });
  await browser.roughen(false);
  await openView(partial);
  await browser.until(`${fineness} === 2`, 'smooth edges at rest');
  await turn('mousePressed', 0, 1);
  for (let moves = 1; (await browser.value(fineness)) !== 1; ++moves) {
    assert.ok(moves < 2000, 'edges stay smooth while the view turns');
    await turn('mouseMoved', moves % 90, 1);
  }
  await turn('mouseReleased', 0, 0);
  await browser.until(`${fineness} === 2`, 'smooth edges again');
  assert.deepEqual(browser.complaints, []);
  await browser.roughen(true);
});

test('the sheet and the object point at each other', async () => {
  await openView(partial);
  await view('predicted');
  // A sphere comes down on the middle of the sheet with its lowest point.
  assert.match(await hoverSheet(0, 0), /^Sheet: 0\.\d mm .* Object: 0\.[01] mm above its lowest point/);
  assert.match(await hoverSheet(80, 120), /does not touch/);
  assert.match(await hoverSheet(104, 0), /margin/);
  assert.equal(await dotOnSheet(), null);

  const plain = await stage();
  for (const [right, up] of [[4, 3], [-6, -5]]) {
    await hoverSheet(right, up);
    await settle();
    assert.ok(!plain.equals(await stage()), 'the marker shows on the object');
    const [x, y] = (await browser.value('document.querySelector("#viewer").dataset.marker')).split(' ').map(Number);
    const box = await browser.box('#stage');
    await browser.hover(box.x + x, box.y + y);
    const dot = await dotOnSheet();
    assert.ok(dot && Math.hypot(dot[0] - right, dot[1] - up) < 1, `${[right, up]} came back as ${dot}`);
  }
  const box = await browser.box('#stage');
  await browser.hover(box.x + 3, box.y + 3);
  assert.equal(await dotOnSheet(), null);
  assert.deepEqual(browser.complaints, []);
});

test('is dark where the reader wants it dark', async () => {
  const lightness = async () => (await browser.value('getComputedStyle(document.body).backgroundColor')).match(/\d+/g).reduce((a, b) => a + Number(b), 0);
  await browser.open(mask.url, { scripts: false });
  assert.ok((await lightness()) > 600);
  await browser.open(mask.url, { scripts: false, dark: true });
  assert.ok((await lightness()) < 150);
  await browser.send('Emulation.setScriptExecutionDisabled', { value: false });
});

let failures = 0;
try {
  for (const { name, body } of tests) {
    const started = Date.now();
    try {
      await body();
      console.log(`passed  ${name} (${Date.now() - started} ms)`);
    } catch (error) {
      failures += 1;
      console.log(`FAILED  ${name}: ${error.stack}`);
    }
  }
} finally {
  await browser.close();
}
process.exit(failures ? 1 : 0);
