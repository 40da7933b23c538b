// The studio's page as a person uses it: every action with real clicks and keys, against the real program.
// Usage: node page.mjs HYDRODIP NODE_MODULES [PART [FAILED]]; PART: object or artwork, which know nothing of each other, or
// all. Exit code 77 (skipped) where there is no Chromium. Where a test fails, pictures of the pages are left in the folder FAILED.
// HYDRODIP_PICTURES=FOLDER keeps a picture of all that is worth looking at; HYDRODIP_ONLY=WORDS runs the tests whose names match
// (and those that open what they need).
import assert from 'node:assert/strict';
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { deflateSync, crc32 } from 'node:zlib';
import { differencesByHand, drag, documentOf, hasChromium, jobOf, kept, middleOf, newResult, openQuick, openSample, Program, resultOf, Session, stateOf, type, until } from './studio.mjs';

const hydrodip = resolve(process.argv[2]);
const modules = resolve(process.argv[3]);
const wanted = process.argv[4] === 'all' ? undefined : process.argv[4];
const chromium = '/usr/bin/chromium';
if (!hasChromium(chromium)) {
  console.log(`skipped: there is no ${chromium}`);
  process.exit(77);
}

const work = mkdtempSync(join(tmpdir(), 'hydrodip-page-'));
process.on('exit', () => rmSync(work, { recursive: true, force: true }));
const pictures = process.env.HYDRODIP_PICTURES;
const failed = pictures ?? process.argv[5];
for (const folder of [pictures, failed]) if (folder) mkdirSync(folder, { recursive: true });
const picture = async (page, name) => {
  if (!pictures) return;
  await page.waitForTimeout(400);
  await page.screenshot({ path: join(pictures, `${name}.png`) });
};
// What is large, in the window that most people have.
const WIDE = { width: 1400, height: 900 };
const USUAL = { width: 1000, height: 680 };
const widePicture = async (page, name) => {
  if (!pictures) return;
  await page.setViewportSize(WIDE);
  await page.waitForTimeout(400);
  await picture(page, name);
  await page.setViewportSize(USUAL);
};

const tests = [];
let part = 'object';
const test = (name, body) => tests.push({ name, body, part });

// ---- What people bring ----

function pngChunk(name, data) {
  const body = Buffer.concat([Buffer.from(name), data]);
  const length = Buffer.alloc(4);
  length.writeUInt32BE(data.length);
  const check = Buffer.alloc(4);
  check.writeUInt32BE(crc32 ? crc32(body) : crcOf(body));
  return Buffer.concat([length, body, check]);
}

function crcOf(bytes) {
  let crc = ~0;
  for (const byte of bytes) {
    crc ^= byte;
    for (let k = 0; k < 8; ++k) crc = (crc >>> 1) ^ (crc & 1 ? 0xedb88320 : 0);
  }
  return ~crc >>> 0;
}

// A picture of coloured quarters.
function png(file, width = 64, height = 48) {
  const rows = Buffer.alloc(height * (1 + 3 * width));
  for (let y = 0; y < height; ++y)
    for (let x = 0; x < width; ++x)
      rows.set([x < width / 2 ? 220 : 30, y < height / 2 ? 60 : 160, (x < width / 2) === (y < height / 2) ? 40 : 200], y * (1 + 3 * width) + 1 + 3 * x);
  const head = Buffer.alloc(13);
  head.writeUInt32BE(width, 0);
  head.writeUInt32BE(height, 4);
  head.set([8, 2, 0, 0, 0], 8);
  const signature = Buffer.from([137, 80, 78, 71, 13, 10, 26, 10]);
  writeFileSync(file, Buffer.concat([signature, pngChunk('IHDR', head), pngChunk('IDAT', deflateSync(rows)), pngChunk('IEND', Buffer.alloc(0))]));
}

// Part of a bowl about the z axis, 60 mm wide at z = `rim_mm`, round towards z = `pole_mm`.
function bowl(rim_mm, pole_mm, radius_mm = 30) {
  const corner = (i, j) => {
    const a = (2 * Math.PI * j) / 24;
    const t = (Math.PI / 2) * (i / 8);
    return [radius_mm * Math.sin(t) * Math.cos(a), radius_mm * Math.sin(t) * Math.sin(a), rim_mm + (pole_mm - rim_mm) * Math.cos(t)];
  };
  const triangles = [];
  for (let i = 0; i < 8; ++i)
    for (let j = 0; j < 24; ++j) {
      const [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
      if (i > 0) triangles.push([a, d, b]);
      triangles.push([b, d, c]);
    }
  return { triangles, rim: (j) => corner(8, j) };
}

function writeStl(file, triangles) {
  const text = triangles.map((t) => ` facet normal 0 0 0\n  outer loop\n${t.map((p) => `   vertex ${p.map((c) => c.toFixed(5)).join(' ')}\n`).join('')}  endloop\n endfacet\n`);
  writeFileSync(file, `solid toy\n${text.join('')}endsolid toy\n`);
}

const SECTORS = [...Array(24).keys()];

// A dome, 60 mm wide and 20 mm deep, as people bring it: an STL without colours. It dips towards -z.
function domeStl(file) {
  const { triangles, rim } = bowl(20, 0);
  writeStl(file, [...triangles, ...SECTORS.map((j) => [[0, 0, 20], rim(j), rim(j + 1)])]);
}

// A bowl upside down, which keeps air until it leans over.
function bellStl(file) {
  const [outside, inside] = [bowl(0, 14), bowl(0, 10, 26)];
  const turned = (t) => [...t].reverse();
  const lip = SECTORS.flatMap((j) => [[outside.rim(j), inside.rim(j), inside.rim(j + 1)], [outside.rim(j), inside.rim(j + 1), outside.rim(j + 1)]]);
  writeStl(file, [...outside.triangles.map(turned), ...inside.triangles, ...lip]);
}

png(join(work, 'logo.png'));
png(join(work, 'tile.png'), 32, 32);
domeStl(join(work, 'dome.stl'));
bellStl(join(work, 'bell.stl'));
writeFileSync(join(work, 'broken.png'), 'This is no picture.');
writeFileSync(join(work, 'notes.mtl'), 'newmtl none');
for (const name of ['notes.stl', 'notes.docx']) writeFileSync(join(work, name), 'Notes.');

const program = new Program(hydrodip);
await program.start();
const session = await Session.start(modules, chromium, program);

const undo = (page) => page.keyboard.press('Control+z');
const redo = (page) => page.keyboard.press('Control+Shift+Z');
// As quick as that by hand, through the list of all settings.
const coarse = async (page) => {
  await blur(page);
  await page.keyboard.press('4');
  for (const [name, value] of [['film-width', 150], ['film-height', 150], ['print-dpi', 72]]) await type(page, name, value);
  await page.click('.everything summary');
  for (const [name, value] of [['film.elements', 2000], ['dip.step_mm', 1], ['ink.rounds_max', 1]]) {
    await page.fill('#search-setting', name);
    const field = page.getByLabel(name, { exact: true });
    await field.fill(String(value));
    await field.press('Enter');
  }
  await page.fill('#search-setting', '');
  await page.click('.everything summary');
  await until('coarse film', async () => (await documentOf(page)).ink?.rounds_max === 1);
  await blur(page);
  await page.keyboard.press('1');
};
const blur = (page) => page.evaluate(() => document.activeElement?.blur());
const sameAs = async (page, document) => until('the document', async () => JSON.stringify(await documentOf(page)) === JSON.stringify(document));

// ---- Begin ----

// One page as long as it goes: a new one costs seconds.
let toy;

test('the empty page: what this is, samples, a place to drop things', async () => {
  toy = await session.page();
  await toy.waitForSelector('.dropzone');
  assert.equal(await toy.locator('.sample').count(), 3);
  assert.match(toy.url(), /^http:\/\/127\.0\.0\.1:\d+\/$/); // the token has left the address
  await widePicture(toy, 'start');
});

const dropOn = async (page, selector, file) => {
  const data = readFileSync(join(work, file)).toString('base64');
  await page.evaluate(async ([on, name, text]) => {
    const transfer = new DataTransfer();
    transfer.items.add(new File([Uint8Array.from(atob(text), (c) => c.charCodeAt(0))], name));
    for (const kind of ['dragenter', 'dragover', 'drop']) document.querySelector(on).dispatchEvent(new DragEvent(kind, { bubbles: true, cancelable: true, dataTransfer: transfer }));
  }, [selector, file, data]);
};

test('what is no model or picture begins no job', async () => {
  for (const [file, why] of [['notes.stl', /^notes\.stl: .*STL/], ['broken.png', /^broken\.png: /], ['notes.mtl', /does not know/], ['notes.docx', /knows/]]) {
    await dropOn(toy, '.dropzone', file);
    await until(`why not ${file}`, async () => why.test((await toy.locator('.start .bad').allTextContents()).join()));
    assert.equal(jobOf(toy), null);
  }
  await session.forgive(422, 3);
  await toy.reload();
  await toy.waitForSelector('.dropzone');
  assert.equal(await toy.locator('.recent li').count(), 0);
});

test('a sample opens with one click: object over its film, the sheet, a verdict', async () => {
  await openSample(toy, 'mask');
  const verdict = await toy.textContent('.verdict .sentence');
  assert.ok(verdict.length > 10);
  assert.doesNotMatch(verdict, /--|_mm|\bdip\./); // in the user's words
  await toy.waitForFunction(() => document.querySelector('.canvas-box canvas').dataset.drawn > 0);
  await widePicture(toy, 'bath');
});

test('an address with a job in it opens that', async () => {
  await openQuick(toy, 'pyramid');
  assert.equal(await toy.inputValue('[name="job-name"]'), 'pyramid');
});

test('a draft says so, and becomes final by itself when the hand rests', async () => {
  const before = await resultOf(toy);
  await type(toy, 'turn-z', 10);
  const figure = () => toy.textContent('[data-finding="coverage"] .figure');
  await toy.waitForFunction(() => document.querySelector('.verdict[data-draft="true"] .badge') && /^about \d/.test(document.querySelector('[data-finding="coverage"] .figure').textContent));
  await newResult(toy, before, true);
  assert.equal(await toy.locator('.verdict .badge, .side .badge').count(), 0);
  assert.match(await figure(), /^\d/);
  await undo(toy);
  await kept(toy);
});

// ---- Pose ----

test('numbers do not jump while they are typed, and count on Enter', async () => {
  const first = await documentOf(toy);
  const field = toy.locator('input[name="turn-z"]');
  await field.click();
  await field.fill('');
  await field.pressSequentially('12.5');
  assert.equal(await field.inputValue(), '12.5');
  assert.deepEqual(await documentOf(toy), first);
  await field.press('Enter');
  await until('the turn', async () => (await documentOf(toy)).object.rotate_deg?.[2] === 12.5);
  await field.fill('nonsense');
  assert.equal(await field.getAttribute('aria-invalid'), 'true');
  await field.press('Escape');
  assert.equal(await field.inputValue(), '12.5');
  await field.fill(' 12.5 °');
  assert.equal(await field.getAttribute('aria-invalid'), 'false');
  await field.press('Enter');
  assert.equal(await field.inputValue(), '12.5');
  await blur(toy);
  await undo(toy);
  await sameAs(toy, first);
  await redo(toy);
  await until('the turn again', async () => (await documentOf(toy)).object.rotate_deg?.[2] === 12.5);
  await undo(toy);
  await sameAs(toy, first);
});

test('a number that cannot count is told why, and stays until it is mended or left', async () => {
  const first = await documentOf(toy);
  const tall = (await toy.textContent('.fact b')).match(/(\d+) mm/)[1];
  for (const [name, text, why] of [
    ['size', 'abc', 'Write a number of mm, like 12.5.'], ['size', '1.234,5', 'Write a number of mm, like 12.5.'], ['size', '-5', 'At least 0.1 mm.'],
    ['size', '99999', 'At most 5000 mm.'], ['depth', '-4', 'At least 0 mm.'], ['depth', '999', `The object is ${tall} mm tall; empty: all of it.`],
    ['depth', '3 pt', 'Write a number of mm, like 12.5.'], ['turn-x', '1e9', 'At most 3600 °.'],
  ]) {
    const field = toy.locator(`input[name="${name}"]`);
    const held = await field.inputValue();
    await field.fill(text);
    await field.press('Enter');
    assert.equal(await toy.textContent('.why'), why);
    assert.equal(await field.getAttribute('aria-invalid'), 'true');
    assert.equal(await field.inputValue(), text);
    await picture(toy, `number-${name}`);
    await field.blur();
    assert.equal(await field.inputValue(), held);
    assert.equal(await toy.locator('.why').count(), 0);
  }
  assert.deepEqual(await documentOf(toy), first);
  await type(toy, 'size', '2in');
  await until('two inches', async () => (await documentOf(toy)).object.size_mm === 50.8);
  await blur(toy);
  await undo(toy);
  await sameAs(toy, first);
});

test('the arrow keys step a number, and a burst of them is one step to undo', async () => {
  const first = await documentOf(toy);
  const field = toy.locator('input[name="turn-x"]');
  await field.focus();
  await toy.keyboard.down('ArrowUp');
  await toy.keyboard.down('ArrowUp');
  await toy.keyboard.down('ArrowUp');
  await toy.keyboard.up('ArrowUp');
  await until('three steps', async () => (await documentOf(toy)).object.rotate_deg?.[0] === 15);
  await blur(toy);
  await undo(toy);
  await sameAs(toy, first);
});

// The share of a part of the 3D view (from 0 to 1 across it) that is not like its upper left corner.
async function filledShare(page, [x, y, width, height] = [0.1, 0.2, 0.6, 0.6]) {
  const box = await page.locator('.canvas-box canvas').boundingBox();
  const clip = { x: box.x + x * box.width, y: box.y + y * box.height, width: width * box.width, height: height * box.height };
  const shot = (await page.screenshot({ clip })).toString('base64');
  return page.evaluate(async (data) => {
    const image = await createImageBitmap(new Blob([Uint8Array.from(atob(data), (c) => c.charCodeAt(0))]));
    const context = new OffscreenCanvas(image.width, image.height).getContext('2d');
    context.drawImage(image, 0, 0);
    const rgba = context.getImageData(0, 0, image.width, image.height).data;
    let unlike = 0;
    for (let i = 0; i < rgba.length; i += 4) if ([0, 1, 2].some((k) => Math.abs(rgba[i + k] - rgba[k]) > 24)) ++unlike;
    return unlike / (rgba.length / 4);
  }, shot);
}

test('an object of another size is seen whole in both views, the hidden one too', async () => {
  const first = await documentOf(toy);
  const finished = async () => {
    await toy.click('[data-value="object"]');
    await toy.click('[data-value="wanted"]');
    await toy.waitForTimeout(300);
    const share = await filledShare(toy);
    await toy.click('[data-value="both"]');
    return share;
  };
  const before = await finished();
  assert.ok(before > 0.1 && before < 0.9, `${before} of the view is the object`);
  await toy.click('[data-value="bath"]');
  await type(toy, 'size', 5);
  await kept(toy);
  const small = await finished();
  assert.ok(Math.abs(small - before) < 0.1, `smaller, ${small} instead of ${before} of the view`);
  // Enlarged while the bath is hidden: there its water line ends within the view.
  await type(toy, 'size', 1500);
  await kept(toy);
  await toy.click('[data-value="bath"]');
  await toy.waitForTimeout(300);
  const [view, grip] = [await toy.locator('.canvas-box canvas').boundingBox(), await middleOf(toy, '[data-name="depth-handle"]')];
  assert.ok(grip.x > view.x && grip.x < view.x + view.width && grip.y > view.y && grip.y < view.y + view.height);
  await blur(toy);
  await undo(toy);
  await undo(toy);
  await sameAs(toy, first);
});

test('R shows the gizmo; its ring turns the object, and one undo takes it back', async () => {
  const first = await documentOf(toy);
  await toy.keyboard.press('r');
  await toy.waitForSelector('[data-name="tool-turn"][aria-pressed="true"]');
  await picture(toy, 'gizmo');
  // The outer ring turns about the eye: somewhere on it, found as its size goes with the view's.
  const box = await toy.locator('.canvas-box canvas').boundingBox();
  const turned = async () => JSON.stringify((await documentOf(toy)).object.rotate_deg ?? [0, 0, 0]) !== JSON.stringify(first.object.rotate_deg ?? [0, 0, 0]);
  for (let reach = 40; reach < 200 && !(await turned()); reach += 6) {
    await drag(toy, { x: box.x + box.width / 2 + reach, y: box.y + box.height / 2 - 8 }, { x: -18, y: -50 }, { steps: 3 });
    await kept(toy);
  }
  assert.ok(await turned(), 'no place of the gizmo turned the object');
  await undo(toy);
  await sameAs(toy, first);
  await toy.keyboard.press('Escape');
});

test('F, and a click on a face: it goes down', async () => {
  const first = await documentOf(toy);
  await toy.keyboard.press('2');
  await toy.keyboard.press('f');
  await toy.waitForSelector('[data-name="tool-face"][aria-pressed="true"]');
  const at = await middleOf(toy, '.canvas-box canvas');
  await toy.mouse.click(at.x + 50, at.y + 30);
  await until('another turn', async () => JSON.stringify((await documentOf(toy)).object.rotate_deg ?? 0) !== JSON.stringify(first.object.rotate_deg ?? 0));
  await toy.waitForSelector('[data-name="tool-face"][aria-pressed="false"]'); // it is done
  await undo(toy);
  await sameAs(toy, first);
  await toy.keyboard.press('Escape');
  await toy.keyboard.press('1');
});

test('M moves the object over the film; the fields say how far', async () => {
  const first = await documentOf(toy);
  const before = await resultOf(toy);
  await type(toy, 'shift-x', 12);
  await until('the shift', async () => (await documentOf(toy)).path?.[1][1] === 12);
  await newResult(toy, before);
  await blur(toy);
  await undo(toy);
  await sameAs(toy, first);
});

test('the water line is a handle for the depth; while it moves, drafts follow', async () => {
  const first = await documentOf(toy);
  const grip = await middleOf(toy, '[data-name="depth-handle"]');
  const seen = new Set();
  await toy.mouse.move(grip.x, grip.y);
  await toy.mouse.down();
  let moved = 0;
  await until('drafts while the handle moves', async () => {
    await toy.mouse.move(grip.x, grip.y + 4 + (++moved % 20));
    seen.add(await resultOf(toy));
    return seen.size > 2;
  });
  assert.deepEqual((await documentOf(toy)).object, first.object);
  await toy.mouse.up();
  await until('a depth', async () => (await documentOf(toy)).dip?.depth_mm > 0);
  await blur(toy);
  await undo(toy);
  await sameAs(toy, first);
  const slider = toy.locator('[data-name="depth-handle"]');
  await slider.focus();
  await slider.press('PageDown');
  await until('a depth by keys', async () => (await documentOf(toy)).dip?.depth_mm > 0);
  await blur(toy);
  await undo(toy);
  await sameAs(toy, first);
});

test('the depth is one figure: in its field, at the water line and in the step\'s line', async () => {
  const first = await documentOf(toy);
  const said = async () => [
    await toy.inputValue('input[name="depth"]'), await toy.textContent('[data-name="depth-handle"] span'), await toy.textContent('[data-step="dips"] .summary'),
  ];
  await type(toy, 'depth', 7.3);
  await until('one figure', async () => JSON.stringify(await said()) === JSON.stringify(['7.3', '7.3 mm', 'one, 7.3 mm deep']));
  await type(toy, 'size', 5); // less tall than that
  await until('it is the whole object', async () => JSON.stringify(await said()) === JSON.stringify(['', 'whole', 'one, whole object']));
  await blur(toy);
  await undo(toy);
  await undo(toy);
  await sameAs(toy, first);
});

test('ways to hold it are suggested; one click takes one', async () => {
  const first = await documentOf(toy);
  await toy.click('[data-name="orient"]');
  await toy.waitForSelector('.way', { timeout: 180000 });
  const ways = await toy.locator('.way').count(); // those that are worth it
  assert.ok(ways >= 1 && ways <= 3);
  await toy.locator('.way').first().scrollIntoViewIfNeeded();
  await picture(toy, 'orient');
  const before = await resultOf(toy);
  await toy.locator('.way').last().click();
  await until('another pose', async () => JSON.stringify(await documentOf(toy)) !== JSON.stringify(first));
  await newResult(toy, before);
  await undo(toy);
  await sameAs(toy, first);
});

test('the sheet is chosen from presets, and can be turned', async () => {
  const first = await documentOf(toy);
  await toy.keyboard.press('4');
  await toy.selectOption('[name="sheet"]', 'a3');
  await until('A3', async () => (await documentOf(toy)).film?.height_mm === 420);
  await toy.click('[data-name="turn-sheet"]');
  await until('A3 across', async () => (await documentOf(toy)).film?.width_mm === 420);
  await undo(toy);
  await undo(toy);
  await sameAs(toy, first);
});

test('what is set for film and printer is kept as a profile, and taken again', async () => {
  const first = await documentOf(toy);
  await type(toy, 'film-margin_mm', 14);
  assert.deepEqual(await toy.locator('[name="profile"] option').allTextContents(), ['none yet']);
  await toy.click('[data-name="keep-profile"]');
  await toy.fill('[name="profile-name"]', 'our film');
  await toy.locator('[name="profile-name"]').press('Enter');
  await toy.locator('[name="profile"] option', { hasText: /^our-film$/ }).waitFor({ state: 'attached' });
  await type(toy, 'film-margin_mm', 9);
  await kept(toy);
  await toy.selectOption('[name="profile"]', 'our-film');
  await until('the profile', async () => (await documentOf(toy)).film?.margin_mm === 14);
  for (let k = 0; k < 3; ++k) await undo(toy);
  await sameAs(toy, first);
});

test('every setting can be found by a word', async () => {
  await toy.click('.everything summary');
  await toy.fill('#search-setting', 'wrinkles');
  await toy.waitForFunction(() => document.querySelectorAll('.any').length === 1);
  await toy.fill('#search-setting', '');
  await picture(toy, 'settings');
  await toy.click('.everything summary');
});

// ---- Watch ----

test('overlays colour the object and say what the colours mean', async () => {
  for (const key of ['coverage', 'stretch', 'tears', 'angle', 'air']) {
    await toy.selectOption('[name="overlay"]', key);
    await toy.waitForSelector('.legend');
    assert.ok((await toy.textContent('.legend')).length > 10);
    if (key === 'stretch') await picture(toy, 'stretch');
  }
  await toy.selectOption('[name="overlay"]', 'none');
  assert.equal(await toy.locator('.legend').count(), 0);
});

test('wanted and predicted lie side by side, with a line to drag', async () => {
  await toy.click('[data-value="object"]');
  const line = await middleOf(toy, '.divider');
  await drag(toy, { x: line.x, y: line.y + 60 }, { x: 120, y: 0 });
  assert.ok(Number(await toy.getAttribute('.divider', 'aria-valuenow')) > 55);
  await toy.focus('.divider');
  await toy.keyboard.press('ArrowLeft');
  await widePicture(toy, 'compare');
});

test('pointing at the object shows the place on the sheet, and the other way round', async () => {
  const at = await middleOf(toy, '.canvas-box canvas');
  await until('a spot on the sheet', async () => {
    await toy.mouse.move(at.x + 40 + Math.random() * 20, at.y + 20);
    return (await toy.locator('.side .dot').count()) === 1;
  });
  assert.match(await toy.textContent('.readout'), /on the sheet/);
  const sheet = await middleOf(toy, '.side .paper > canvas');
  await toy.mouse.move(sheet.x, sheet.y);
  await toy.waitForSelector('.side .lens');
  await toy.mouse.move(5, 5);
});

test('the dip plays with Space, and its slider shows any moment', async () => {
  await blur(toy);
  await toy.click('[data-value="bath"]');
  await blur(toy);
  await toy.keyboard.press('Space');
  await until('it goes down', async () => /mm deep, \d+ cm/.test(await toy.textContent('.dipbar output')));
  await picture(toy, 'dipping');
  await blur(toy);
  await toy.keyboard.press('Space');
  await toy.locator('[name="level"]').fill('0');
});

test('a finding shows its place, and a mend is one click and one undo', async () => {
  const first = await documentOf(toy);
  const mends = toy.locator('.side [data-name="mend"]');
  await toy.locator('.side [data-name="show"]').first().click();
  await toy.waitForSelector('.legend');
  if ((await mends.count()) === 0) return; // nothing to mend here; the toy has
  await mends.first().click();
  await until('the mend', async () => JSON.stringify(await documentOf(toy)) !== JSON.stringify(first));
  await undo(toy);
  await sameAs(toy, first);
});

test('the verdict opens what it rests on', async () => {
  await toy.click('.verdict');
  assert.ok((await toy.locator('.verdict-panel .finding').count()) > 1);
  await picture(toy, 'verdict');
  await toy.keyboard.press('Escape');
  assert.equal(await toy.locator('.panel').count(), 0);
});

const focused = (page) => page.evaluate(() => {
  const at = document.activeElement;
  return at.getAttribute('name') ?? at.dataset.name ?? at.className;
});
// What has the focus, by its name, or its class if it has none.
const focusAt = (page, name) => until(`the focus at ${name}`, async () => (await focused(page)) === name, 10).catch(async () => assert.equal(await focused(page), name));

test('a panel takes the focus and gives it back; what is left hands it on', async () => {
  await toy.locator('.verdict').press('Enter');
  await focusAt(toy, 'panel verdict-panel');
  await toy.keyboard.press('Tab');
  await focusAt(toy, 'close-panel');
  await toy.keyboard.press('Escape');
  await until('the verdict', async () => /^verdict/.test(await focused(toy)));
  await toy.locator('[data-name="save"]').press('Enter');
  await focusAt(toy, 'save-name');
  await toy.keyboard.type('r'); // is typed, and no tool; over the old name, as that is selected
  assert.equal(await toy.inputValue('[name="save-name"]'), 'r');
  await toy.keyboard.press('Escape');
  await focusAt(toy, 'save');
  await toy.locator('[data-name="keys"]').press('Enter');
  await focusAt(toy, 'panel right keys');
  await toy.keyboard.press('Escape');
  await focusAt(toy, 'keys');
  await toy.keyboard.press('1');
  await toy.locator('[data-name="orient"]').focus();
  await toy.keyboard.press('2');
  await until('the step', () => toy.evaluate(() => document.activeElement.dataset.step === 'artwork'));
});

test('a new text is typed at once, over the words that stand there', async () => {
  const first = await documentOf(toy);
  await blur(toy);
  await toy.keyboard.press('2');
  await toy.locator('[data-name="add-text"]').press('Enter');
  await focusAt(toy, 'words');
  const before = await resultOf(toy);
  await toy.keyboard.type('Form 12');
  assert.equal(await toy.inputValue('[name="words"]'), 'Form 12');
  assert.equal(await toy.getAttribute('.work', 'data-step'), 'artwork');
  await toy.waitForSelector('[aria-label="Remove: Form 12"]'); // shown before the field is left
  await until('a draft of it', async () => (await toy.getAttribute('.verdict', 'data-draft')) === 'true' && (await resultOf(toy)) !== before);
  await blur(toy);
  await until('the text', async () => (await documentOf(toy)).artwork?.[0]?.text === 'Form 12');
  await toy.locator('[aria-label="Remove: Form 12"]').press('Enter');
  await focusAt(toy, 'add-text');
  for (let k = 0; k < 3; ++k) await undo(toy);
  await sameAs(toy, first);
});

test('Tab shows the sheet large while the view has the focus', async () => {
  const at = await middleOf(toy, '.canvas-box canvas');
  await toy.mouse.click(at.x - 200, at.y);
  await toy.keyboard.press('Tab');
  await toy.waitForSelector('.sheet.big .paper');
  await picture(toy, 'sheet');
  await toy.click('[data-value="object"]');
});

// ---- Several dips ----

test('a second dip: two sheets, each dip\'s part, the seam, and the finish as a whole', async () => {
  const first = await documentOf(toy);
  const before = await resultOf(toy);
  await blur(toy);
  await toy.keyboard.press('3');
  await toy.click('[data-name="add-dip"]');
  await until('two dips', async () => (await documentOf(toy)).dips?.length === 2);
  await newResult(toy, before);
  // Not turned over, but a little aside, so that both reach some of it.
  await toy.selectOption('[name="down"]', '-z');
  await type(toy, 'turn-x', 30);
  await until('its pose', async () => (await documentOf(toy)).dips[1].rotate_deg[0] === 30);
  await blur(toy);
  await toy.waitForSelector('[data-name="finish"]');
  assert.ok(Number(await toy.getAttribute('[data-name="finish"]', 'data-seams')) > 0);
  assert.equal(await toy.locator('.dip canvas.thumb').count(), 2);
  assert.match(await toy.textContent('.dips'), /prints \d.*prints \d/);
  assert.match(await toy.textContent('.verdict .sentence'), /of the object covered/);
  await toy.click('[data-name="show-parts"]');
  await until('the legend', async () => /Dip 1.*Dip 2/.test(await toy.textContent('.legend')));
  await widePicture(toy, 'parts');
  await toy.click('[name="all-dips"]');
  await widePicture(toy, 'dips');
  await toy.click('.dip:first-child .button[aria-pressed]');
  await until('it is kept', async () => (await documentOf(toy)).dips[0].locked === true);
  await toy.click('[data-dip="0"]');
  await toy.click('.dip:last-child .button:last-child');
  await until('one dip again', async () => !(await documentOf(toy)).dips);
  for (let k = 0; k < 5; ++k) await undo(toy);
  await sameAs(toy, first);
});

// What the program makes of what the page has just sent: a result, or why there is none.
async function outcome(page, before) {
  const said = page.locator('[data-finding="problem"]');
  await until('a result or a problem', async () => (await said.count()) > 0 || ![before, null].includes(await resultOf(page)));
  return (await said.count()) ? said.textContent() : 'a result';
}

test('a tilt, a shift and a second dip go together, whichever comes first', async () => {
  const first = await documentOf(toy);
  await blur(toy);
  await toy.keyboard.press('3');
  await type(toy, 'dip-tilt_deg', 15);
  await kept(toy);
  let before = await resultOf(toy);
  await type(toy, 'shift-x', 10);
  await until('the shift', async () => (await documentOf(toy)).path);
  assert.equal(await outcome(toy, before), 'a result');
  const { dip, object } = await documentOf(toy);
  assert.equal(dip.tilt_deg, undefined);
  assert.deepEqual(object.rotate_deg, [0, 15, 0]);
  before = await resultOf(toy);
  await toy.click('[data-name="add-dip"]');
  await until('two dips', async () => (await documentOf(toy)).dips?.length === 2);
  assert.equal(await outcome(toy, before), 'a result');
  before = await resultOf(toy);
  await toy.click('[data-dip="0"]');
  assert.equal(await outcome(toy, before), 'a result');
  assert.equal(await toy.inputValue('input[name="shift-x"]'), '10');
  await blur(toy);
  for (let k = 0; k < 3; ++k) await undo(toy);
  await sameAs(toy, first);
});

let lone;
test('artwork that gets no film says so in its list, its step and among what to mind, before it is printed', async () => {
  lone = await session.page();
  const text = { text: 'A', size_mm: 12 };
  await openQuick(lone, 'box', { dip: { step_mm: 1, air_cells: 20000, depth_mm: 4 }, artwork: [{ ...text, toward: [0, 0, 1] }, { ...text, toward: [0, 0, -1], up: [0, 1, 0] }] });
  await until('the step says it', async () => (await lone.textContent('[data-step="artwork"] .summary')) === '2 layers, 1 without film');
  await lone.keyboard.press('2');
  await lone.waitForSelector('[data-name="dry-1"]');
  assert.equal(await lone.locator('[data-name="dry-0"]').count(), 0);
  await lone.waitForSelector('.side .finding >> text=this artwork gets no film that holds');
  await lone.click('[data-layer="1"]');
  await lone.waitForSelector('.said.care');
  await picture(lone, 'dry');
  // Turned over it is the other one that gets none.
  await lone.keyboard.press('1');
  await lone.selectOption('[name="down"]', '+z');
  await lone.keyboard.press('2');
  await lone.waitForSelector('[data-name="dry-0"]');
  assert.equal(await lone.locator('[data-name="dry-1"]').count(), 0);
  await lone.close();
});

test('a job that is left before anything is computed has its picture in the list; one that a tab has is not recovered', async () => {
  lone = await session.page();
  await lone.route('**/results/**', (route) => route.fulfill({ status: 204 }));
  const pictured = lone.waitForRequest((request) => request.method() === 'PUT' && /thumbnail/.test(request.url()));
  await lone.click('[data-sample="sphere"]');
  await pictured;
  await lone.click('.home');
  await lone.waitForSelector('.recent li');
  const entry = () => lone.locator('.recent li').first();
  await until('its picture', () => entry().locator('img').evaluate((img) => img.complete && img.naturalWidth === 320));
  assert.equal(await lone.locator('.recent b').first().textContent(), 'sphere');
  assert.doesNotMatch(await entry().textContent(), /recovered|elsewhere/); // its own tab has left it this moment
  const other = await session.page({ context: lone.context(), address: program.origin });
  await other.locator('[data-recent]').first().click();
  await other.waitForSelector('.work');
  await lone.reload();
  await until('it is open elsewhere', async () => /open elsewhere/.test(await entry().textContent()) || !(await lone.reload()));
  assert.doesNotMatch(await entry().textContent(), /recovered/);
  await picture(lone, 'open-elsewhere');
  await other.close();
  await lone.close();
});

test('a way of its own says depth and shift; straight down they are the person\'s again', async () => {
  lone = await session.page();
  await openQuick(lone, 'pyramid', { path: [[0, 0, 0, 0, 0, 0], [10, 5, 0, 0, 10, 0]] });
  for (const name of ['depth', 'shift-x', 'shift-y']) assert.ok(await lone.locator(`input[name="${name}"]`).isDisabled(), name);
  assert.equal(await lone.locator('[data-name="depth-handle"]').count(), 0);
  await lone.keyboard.press('3');
  assert.equal(await lone.locator('input[name="dip-tilt_deg"]').count(), 0);
  await lone.click('[data-name="straight"]');
  await until('no path', async () => !(await documentOf(lone)).path);
  const before = await resultOf(lone);
  await type(lone, 'depth', 8);
  await until('the depth', async () => (await documentOf(lone)).dip.depth_mm === 8);
  assert.equal(await outcome(lone, before), 'a result');
});

test('a mend of one dip among several mends that one', async () => {
  const dip = (angle) => ({ down: '-z', rotate_deg: [0, 0, angle], depth_mm: 50 });
  await openQuick(lone, 'sphere', { dips: [dip(0), dip(30)] });
  await lone.keyboard.press('3');
  await lone.click('[data-dip="1"]');
  const mend = lone.locator('.side [data-name="mend"]', { hasText: /^Dip .* mm only$/ });
  await mend.waitFor();
  // In one go: a result that comes meanwhile may say another depth.
  const said = await mend.evaluate((button) => {
    const text = button.textContent;
    button.click();
    return text;
  });
  const depth = Number(said.match(/[\d.]+/)[0]);
  await until('less depth', async () => (await documentOf(lone)).dips[1].depth_mm === depth);
  const { dips, dip: all } = await documentOf(lone);
  assert.deepEqual(dips, [dip(0), { ...dip(30), depth_mm: depth }]);
  assert.equal(all.depth_mm, undefined);
});

test('air is let out of one dip among several by turning that one', async () => {
  const dip = { down: '-z', rotate_deg: [0, 0, 0], depth_mm: 0 };
  await openQuick(lone, 'box', { dip: { step_mm: 1 }, dips: [dip, dip] }); // with all the cells that advice on air needs
  await lone.keyboard.press('1');
  await lone.setInputFiles('[name="open-model"]', join(work, 'bell.stl'));
  await lone.keyboard.press('3');
  await lone.click('[data-dip="1"]');
  const mend = lone.locator('.side [data-name="mend"]', { hasText: /^Tilt it by/ });
  await mend.waitFor();
  await mend.click();
  await until('a turn', async () => (await documentOf(lone)).dips[1].rotate_deg.some((angle) => angle !== 0));
  const { dips, dip: all } = await documentOf(lone);
  assert.deepEqual(dips[0], dip);
  assert.equal(all.tilt_deg, undefined);
});

test('what is changed while files are taken in waits for them, and is not refused', async () => {
  const dip = { down: '-z', rotate_deg: [0, 0, 0], depth_mm: 12 };
  await openQuick(lone, 'pyramid', { dips: [dip, dip] });
  let answer;
  const taken = new Promise((done) => {
    lone.route('**/adopt', async (route) => {
      const response = await route.fetch();
      answer = () => route.fulfill({ response });
      done();
    }, { times: 1 });
  });
  const refused = session.refusals.length;
  await lone.keyboard.press('1');
  await lone.setInputFiles('[name="open-model"]', join(work, 'bell.stl'));
  await taken;
  await lone.keyboard.press('3');
  await lone.click('[data-dip="1"]');
  await answer();
  await until('the model', async () => (await documentOf(lone)).object.file === 'bell.stl');
  await kept(lone);
  assert.deepEqual(session.refusals.slice(refused), []);
});

test('the dip that is shown becomes final: after a reload, with new artwork, and without another tab', async () => {
  const dip = (angle) => ({ down: '-z', rotate_deg: [0, 0, angle], depth_mm: 12 });
  await openQuick(lone, 'pyramid', { dips: [dip(0), dip(45)] });
  const isFinal = async (page) => {
    await page.waitForFunction(() => document.querySelector('.verdict')?.dataset.draft === 'false');
    await page.keyboard.press('3');
    assert.equal(await page.getAttribute('[data-dip="1"]', 'aria-pressed'), 'true');
  };
  await lone.keyboard.press('3');
  await lone.click('[data-dip="1"]');
  await isFinal(lone);
  await lone.reload();
  await lone.waitForSelector('.work');
  await isFinal(lone);
  const before = await resultOf(lone);
  await lone.keyboard.press('2');
  await lone.setInputFiles('[name="add-picture"]', join(work, 'logo.png'));
  await newResult(lone, before, true);
  await isFinal(lone);
  const other = await session.page({ context: lone.context(), address: lone.url() });
  await other.waitForSelector('[data-name="take-pen"]');
  await blur(lone);
  await lone.keyboard.press('3');
  await lone.click('[data-dip="0"]');
  await kept(lone);
  await lone.close();
  lone = other;
  await lone.waitForFunction(() => !document.querySelector('.banner'));
  await isFinal(lone);
});

// ---- What is in the way of what ----

const boxOf = (page, selector) => page.locator(selector).first().boundingBox();
const apart = (a, b) => a.x + a.width <= b.x || b.x + b.width <= a.x || a.y + a.height <= b.y || b.y + b.height <= a.y;

test('an open panel leaves the object beside it, in every window', async () => {
  const page = await session.page();
  await openQuick(page, 'pyramid');
  for (const [width, height] of [[1440, 900], [1024, 768], [820, 1180]]) {
    await page.setViewportSize({ width, height });
    await page.click('[data-value="object"]');
    for (const panel of ['.verdict', '[data-name="keys"]', '[data-name="save"]']) {
      await page.click(panel);
      await page.waitForSelector('.panel');
      await until(`the view beside the panel of ${panel}`, async () => apart(await boxOf(page, '.panel'), await boxOf(page, '.canvas-box')), 20);
      const view = await boxOf(page, '.canvas-box');
      assert.ok(Math.min(view.width, view.height) >= 240, `${view.width} x ${view.height} px are left`);
      await page.waitForTimeout(200);
      const share = await filledShare(page, [0.05, 0.1, 0.9, 0.8]);
      assert.ok(share > 0.04, `the object takes ${share} of what is left`);
      await picture(page, `beside-${panel.replace(/\W/g, '')}-${width}`);
      await page.keyboard.press('Escape');
    }
  }
  await page.context().close();
});

test('two fingers and one bring nobody under the film, nor away from it', async () => {
  const context = await session.browser.newContext({ viewport: { width: 1024, height: 768 }, hasTouch: true, reducedMotion: 'reduce' });
  const tablet = await session.page({ context });
  await openQuick(tablet, 'pyramid');
  const touch = await context.newCDPSession(tablet);
  const middle = await middleOf(tablet, '.canvas-box canvas');
  const fingers = async (from, to) => {
    const at = (share) => from.map(([x, y], k) => ({ id: k, x: middle.x + x + (to[k][0] - x) * share, y: middle.y + y + (to[k][1] - y) * share }));
    await touch.send('Input.dispatchTouchEvent', { type: 'touchStart', touchPoints: at(0) });
    for (let k = 1; k <= 8; ++k) await touch.send('Input.dispatchTouchEvent', { type: 'touchMove', touchPoints: at(k / 8) });
    await touch.send('Input.dispatchTouchEvent', { type: 'touchEnd', touchPoints: [] });
  };
  const eye = async () => Number(await tablet.getAttribute('.canvas-box canvas', 'data-eye'));
  const first = await eye();
  assert.ok(first > 50);
  for (let k = 0; k < 6; ++k) {
    await fingers([[-40, 120], [40, 120]], [[-70, -180], [70, -180]]); // nearer, and the film up
    await fingers([[0, 100]], [[0, -220]]); // round it
  }
  await tablet.waitForTimeout(300);
  assert.notEqual(await eye(), first); // they were felt
  assert.ok((await eye()) > 0, `${await eye()} mm over the water`);
  assert.equal(await tablet.locator('[name="look"] option[value="below"]').count(), 0);
  await picture(tablet, 'low');
  await tablet.keyboard.press('z');
  await until('as it was', async () => Math.abs((await eye()) - first) < 1, 20);
  await context.close();
});

test('without a graphics card edges are rough while the view moves, and smooth when it rests', async () => {
  const page = await session.page({ rough: false });
  await page.waitForSelector('.recent button');
  await page.locator('.recent li > button').first().click();
  await newResult(page, '');
  const canvas = page.locator('.canvas-box canvas');
  const fineness = () => canvas.evaluate((c) => Math.round(c.width / c.clientWidth));
  await until('smooth edges at rest', async () => (await fineness()) === 2);
  const { x, y } = await middleOf(page, '.canvas-box canvas');
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 40, y, { steps: 2 });
  await until('rough edges in a turn', async () => {
    await page.mouse.move(x + 40 + Math.random() * 9, y);
    return (await fineness()) === 1;
  });
  await page.mouse.up();
  await until('smooth edges again', async () => (await fineness()) === 2);
  await page.context().close();
});

test('handles keep clear of each other, and of what lies behind', async () => {
  const touch = await session.browser.newContext({ viewport: { width: 1024, height: 768 }, hasTouch: true, reducedMotion: 'reduce' });
  for (const [context, least] of [[null, 34], [touch, 48]]) {
    const page = await session.page({ context });
    await openQuick(page, 'pyramid', { artwork: [{ text: 'A', size_mm: 2, toward: [0, 0, 1], up: [0, 1, 0] }] });
    await page.keyboard.press('2');
    await page.click('[data-layer="0"]');
    const places = await page.locator('[data-grip]').evaluateAll((grips) => grips.map((g) => g.getBoundingClientRect()).map((b) => [b.x + b.width / 2, b.y + b.height / 2]));
    assert.equal(places.length, 3);
    for (const [k, a] of places.entries())
      for (const b of places.slice(0, k)) assert.ok(Math.hypot(a[0] - b[0], a[1] - b[1]) > least - 1.5, `${a} and ${b}`);
    await picture(page, `grips-${least}`);
    // From above it is behind the object: said, and one click away.
    await page.click('[data-value="bath"]');
    await page.selectOption('[name="look"]', 'above');
    await page.waitForSelector('[data-name="behind"]');
    assert.equal(await page.locator('[data-grip], [data-name="depth-handle"]').count(), 0);
    await picture(page, `behind-${least}`);
    await page.click('[data-value="object"]');
    await page.selectOption('[name="look"]', 'back');
    await page.click('[data-name="behind"]');
    await page.waitForSelector('[data-grip="move"]');
    // One kind at a time.
    await blur(page);
    await page.keyboard.press('r');
    await page.waitForSelector('[data-name="tool-turn"][aria-pressed="true"]');
    assert.equal(await page.locator('[data-grip], [data-name="depth-handle"], [data-name="behind"]').count(), 0);
    await page.keyboard.press('Escape');
    await page.keyboard.press('1');
    await page.waitForSelector('[data-name="depth-handle"]');
    assert.equal(await page.locator('[data-grip], [data-name="behind"]').count(), 0);
    await page.close();
  }
  await touch.close();
});

// ---- Artwork ----

part = 'artwork';

let dome;
test('an STL and a PNG dropped together: the picture is on the object at once', async () => {
  dome = await session.page();
  await dome.waitForSelector('.dropzone');
  const [model, image] = ['dome.stl', 'logo.png'].map((name) => readFileSync(join(work, name)).toString('base64'));
  await dome.evaluate(async ([a, b]) => {
    const bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
    const transfer = new DataTransfer();
    transfer.items.add(new File([bytes(a)], 'dome.stl'));
    transfer.items.add(new File([bytes(b)], 'logo.png', { type: 'image/png' }));
    for (const name of ['dragenter', 'dragover', 'drop']) {
      document.querySelector('.dropzone').dispatchEvent(new DragEvent(name, { bubbles: true, cancelable: true, dataTransfer: transfer }));
    }
  }, [model, image]);
  const { object, artwork } = await until('both are taken', async () => {
    const document = jobOf(dome) && (await documentOf(dome));
    return document?.artwork && document;
  });
  await newResult(dome, '');
  assert.equal(object.file, 'dome.stl');
  assert.equal(artwork[0].image, 'logo.png');
  await dome.waitForSelector('[data-grip="move"]');
  await widePicture(dome, 'artwork');
  await coarse(dome);
  await dome.keyboard.press('2');
});

test('the picture is dragged, scaled and turned by its handles; each is one step to undo', async () => {
  const first = await documentOf(dome);
  const steps = [['move', { x: 30, y: 12 }, 'at_mm'], ['scale', { x: -25, y: -25 }, 'size_mm'], ['turn', { x: 60, y: 30 }, 'turn_deg']];
  for (const [grip, by, key] of steps) {
    const before = (await documentOf(dome)).artwork[0][key];
    await drag(dome, await middleOf(dome, `[data-grip="${grip}"]`), by, { hold: 30 });
    await until(`${grip} changes ${key}`, async () => JSON.stringify((await documentOf(dome)).artwork[0][key]) !== JSON.stringify(before));
  }
  await kept(dome);
  for (let k = 0; k < 3; ++k) await undo(dome);
  await sameAs(dome, first);
  for (let k = 0; k < 3; ++k) await redo(dome);
  await kept(dome);
});

test('layers: projection, width in figures, text on top, order, removal by key', async () => {
  const laidOn = dome.locator('[name="projection"]');
  assert.ok(await laidOn.locator('option[value="uv"]').isDisabled()); // an STL has none
  const room = await laidOn.evaluate((select) => {
    const context = document.createElement('canvas').getContext('2d');
    context.font = getComputedStyle(select).font;
    return select.clientWidth - Math.max(...[...select.options].map((o) => context.measureText(o.text).width));
  });
  assert.ok(room > 16, `beside the longest choice there are ${room} px for the arrow`);
  // Around an axis there is no flat frame of it; by its centre it is moved all the same.
  await laidOn.selectOption('cylinder');
  await until('around an axis', async () => (await documentOf(dome)).artwork[0].projection === 'cylinder');
  await until('no frame', async () => (await dome.locator('[data-grip]').count()) === 1);
  const at = (await documentOf(dome)).artwork[0].at_mm;
  await drag(dome, await middleOf(dome, '[data-grip="move"]'), { x: 20, y: 10 }, { hold: 30 });
  await until('it is moved', async () => JSON.stringify((await documentOf(dome)).artwork[0].at_mm) !== JSON.stringify(at));
  await undo(dome);
  await laidOn.selectOption('wrap');
  await type(dome, 'layer-width', 18);
  await until('the width', async () => (await documentOf(dome)).artwork[0].size_mm?.[0] === 18 || (await documentOf(dome)).artwork[0].size_mm === 18);
  await until('how it was laid', async () => /^18 × \d+ mm on the object, stretched 0\.\d+ to \d\.\d+ times$/.test(await dome.locator('[data-name="laid"]').textContent()));
  await dome.click('[data-name="add-text"]');
  await until('a text', async () => (await documentOf(dome)).artwork.length === 2);
  const { size_mm } = (await documentOf(dome)).artwork[1];
  assert.ok(size_mm > 20 && size_mm < 40, `the text is ${size_mm} mm wide on a dome of 60 mm`);
  await dome.fill('[name="words"]', 'No. 7');
  await dome.locator('[name="words"]').blur();
  await until('the words', async () => (await documentOf(dome)).artwork[1].text === 'No. 7');
  await dome.click('[aria-label="Further down: No. 7"]');
  await until('the order', async () => (await documentOf(dome)).artwork[0].text === 'No. 7');
  await blur(dome);
  await dome.keyboard.press('Delete');
  await until('it is gone', async () => (await documentOf(dome)).artwork.length === 1);
  await undo(dome);
  await until('it is back', async () => (await documentOf(dome)).artwork.length === 2);
  await picture(dome, 'layers');
});

test('names as long as they come leave the fields where they are', async () => {
  const long = 'a very long name that somebody gave to a picture '.repeat(3).trim();
  writeFileSync(join(work, `${long}.png`), readFileSync(join(work, 'logo.png')));
  await dome.setInputFiles('[name="add-picture"]', join(work, `${long}.png`));
  await dome.waitForSelector(`[data-layer][title="${long}.png"]`);
  const name = (await documentOf(dome)).name;
  await type(dome, 'job-name', long);
  const beyond = () => dome.evaluate(() => [...document.querySelectorAll('.steps, .steps *, .top > *')].filter((e) => {
    if (e.closest('.hidden, option')) return false;
    const edge = e.closest('.steps')?.getBoundingClientRect().right ?? innerWidth;
    return e.getBoundingClientRect().right > edge + 1 || (e.matches('.steps') && e.scrollWidth > e.clientWidth);
  }).map((e) => e.outerHTML.slice(0, 100)));
  assert.deepEqual(await beyond(), []);
  await picture(dome, 'long-names');
  await blur(dome);
  await undo(dome);
  await undo(dome);
  await until('the old name', async () => (await documentOf(dome)).name === name);
});

test('a pattern of the film is slid on the sheet', async () => {
  await dome.setInputFiles('[name="add-pattern"]', join(work, 'tile.png'));
  await until('a pattern', async () => (await documentOf(dome)).artwork.at(-1).projection === 'film');
  await dome.waitForSelector('.paper canvas.slides');
  await drag(dome, await middleOf(dome, '.side .paper > canvas'), { x: 20, y: -10 });
  await until('it is slid', async () => (await documentOf(dome)).artwork.at(-1).at_mm?.[0] > 1);
  await picture(dome, 'pattern');
  await undo(dome);
  await undo(dome);
  await undo(dome);
  await kept(dome);
});

test('what cannot become a pattern leaves the chosen layer as it is', async () => {
  await dome.click('[data-name="add-text"]');
  const first = await until('a text', async () => {
    const document = await documentOf(dome);
    return document.artwork.at(-1).text && document;
  });
  await dome.setInputFiles('[name="add-pattern"]', join(work, 'notes.mtl'));
  await dome.waitForSelector('.notice.error');
  await dome.click('[data-name="close-notice"]');
  await kept(dome);
  assert.deepEqual(await documentOf(dome), first);
  await undo(dome);
  await kept(dome);
});

test('no more layers and dips than a job may have', async () => {
  const full = await session.page();
  const dip = { down: '-z', rotate_deg: [0, 0, 0], depth_mm: 4 };
  await openQuick(full, 'box', { artwork: Array(64).fill({ text: 'A', size_mm: 4 }), dips: Array(24).fill(dip) });
  await full.keyboard.press('2');
  for (const button of ['[data-name="add-text"]', '[name="add-picture"]', '[name="add-pattern"]']) {
    await full.waitForSelector(button, { state: 'attached' });
    assert.ok(await full.locator(button).isDisabled(), button);
  }
  await full.locator('[data-layer]').first().click();
  await blur(full);
  await full.keyboard.press('Delete');
  await until('there is room again', () => full.locator('[data-name="add-text"]').isEnabled());
  await full.keyboard.press('3');
  await full.waitForSelector('[data-name="add-dip"]');
  assert.ok(await full.locator('[data-name="add-dip"]').isDisabled());
  await full.close();
});

test('a broken picture or model is a sentence, and the job is as before', async () => {
  const first = await documentOf(dome);
  for (const file of ['broken.png', 'notes.stl']) {
    await dropOn(dome, '.work', file);
    await dome.waitForFunction((name) => document.querySelector('.notice.error')?.textContent.startsWith(`${name}: `), file);
    assert.deepEqual(await documentOf(dome), first);
    await dome.click('[data-name="close-notice"]');
  }
  await session.forgive(422, 2);
  assert.equal(await dome.locator('[data-finding="problem"]').count(), 0);
});

// ---- Print and save ----

test('the report can be a customer\'s, with a logo', async () => {
  await blur(dome);
  await dome.keyboard.press('4');
  await dome.click('[data-value="customer"]');
  await dome.setInputFiles('[name="add-logo"]', join(work, 'logo.png'));
  await dome.waitForSelector('img.logo');
  await until('a logo', async () => (await documentOf(dome)).report?.logo);
  assert.equal((await documentOf(dome)).report.for, 'customer');
  await kept(dome);
});

test('print: progress, cancel, then the sheet and the run sheet', async () => {
  // So fine that it is not done before it is cancelled, however long a click takes here.
  await dome.keyboard.press('4');
  await type(dome, 'print-dpi', 600);
  await kept(dome);
  await blur(dome);
  await dome.keyboard.press('Control+p');
  await dome.waitForSelector('[data-name="cancel-print"]');
  // With its panel closed the button says how far it is, and leads back.
  const says = (pattern) => dome.waitForFunction((text) => new RegExp(text).test(document.querySelector('[data-name="print"]').textContent), pattern);
  await dome.keyboard.press('Escape');
  await says('^Printing \\d+ %$');
  await dome.click('[data-name="print"]');
  await dome.click('[data-name="cancel-print"]', { force: true }); // it need not stand still
  await dome.waitForSelector('[data-name="print-again"]');
  assert.equal(await dome.locator('[data-file="print.pdf"]').count(), 0);
  await type(dome, 'print-dpi', 72);
  await kept(dome);
  await dome.click('[data-name="print-again"]');
  await dome.waitForSelector('[data-name="cancel-print"]');
  await dome.keyboard.press('Escape');
  await says('^Printed');
  await dome.keyboard.press('Control+p');
  await dome.waitForSelector('[data-file="print.pdf"]', { timeout: 5000 }); // no second print
  await says('^Print$');
  await picture(dome, 'printed');
  // Its files are to be had again as long as nothing has changed; and so that something has not.
  const printed = () => dome.getAttribute('[data-file="print.pdf"]', 'href');
  const first = await printed();
  await dome.keyboard.press('Escape');
  await says('^Printed$');
  await dome.keyboard.press('1');
  await type(dome, 'turn-z', 3);
  await says('^Print$');
  await blur(dome);
  await undo(dome);
  await kept(dome);
  await says('^Printed$');
  await dome.click('[data-name="print"]');
  await dome.waitForSelector('[data-name="print-again"]');
  assert.equal(await printed(), first);
  assert.doesNotMatch(await dome.textContent('.panel.print'), /has changed/);
  const url = await dome.getAttribute('[data-file="print.pdf"]', 'href');
  const head = await dome.evaluate(async (path) => new TextDecoder().decode((await (await fetch(path)).arrayBuffer()).slice(0, 5)), url);
  assert.equal(head, '%PDF-');
  const report = await dome.context().newPage();
  await report.setViewportSize(WIDE);
  await report.goto(new URL(await dome.getAttribute('[data-file="report.html"]', 'href'), dome.url()).href);
  await report.waitForSelector('html.live');
  const words = await report.textContent('main');
  assert.doesNotMatch(words, /--|_mm|sha256|\.stl|hydrodip/);
  assert.equal(await report.locator('.logo img').count(), 1);
  await picture(report, 'report-customer');
  await report.close();
});

test('the saved job gives the same bytes by the command line', async () => {
  const { different, compared } = await differencesByHand(dome, hydrodip, work);
  assert.deepEqual(different, []);
  assert.equal(compared, 4);
});

test('Ctrl+S saves, and the name is the file\'s', async () => {
  await dome.keyboard.press('Escape');
  await dome.fill('[name="job-name"]', 'dome with a logo');
  await dome.locator('[name="job-name"]').press('Enter');
  await until('the name', async () => (await documentOf(dome)).name === 'dome with a logo');
  await dome.keyboard.press('Control+s');
  await dome.click('[data-name="save-now"]');
  await dome.waitForFunction(() => document.querySelector('.jobname small')?.dataset.saved === 'true');
  assert.match((await stateOf(dome)).where, /dome with a logo\.toml$/);
  await undo(dome);
  await dome.waitForFunction(() => document.querySelector('.jobname small')?.dataset.saved === 'false');
  await redo(dome);
});

// ---- When something goes wrong ----

test('a second tab is told, and may take over', async () => {
  const second = await session.page({ context: dome.context(), address: dome.url() });
  await second.waitForSelector('[data-name="take-pen"]');
  await second.click('[data-name="print"]'); // to see what was printed
  await second.waitForSelector('[data-file="print.pdf"]');
  assert.ok(await second.locator('[data-name="print-again"]').isDisabled());
  await second.keyboard.press('Escape');
  await second.click('[data-name="take-pen"]');
  await second.waitForFunction(() => !document.querySelector('.banner'));
  await dome.click('[data-name="take-pen"]');
  await dome.waitForFunction(() => !document.querySelector('.banner'));
  await second.close();
});

test('the program is killed and started again: the page goes on, nothing is lost', async () => {
  const port = new URL(program.address).port;
  session.mayFail = true;
  await program.end('SIGKILL');
  await dome.waitForSelector('.banner.stop');
  await blur(dome);
  await dome.keyboard.press('1');
  await type(dome, 'turn-z', 33); // while nobody listens
  await program.start('--port', port);
  await dome.waitForFunction(() => !document.querySelector('.banner'));
  await until('the change has arrived', async () => (await documentOf(dome)).object.rotate_deg?.[2] === 33);
  session.mayFail = false;
  await newResult(dome, '');
});

test('the program is ended and started anew: the page sends people to the address that it printed', async () => {
  const port = new URL(program.address).port;
  session.mayFail = true;
  await program.end('SIGTERM');
  await dome.waitForFunction(() => /was ended/.test(document.querySelector('.banner.stop')?.textContent ?? ''));
  await program.start('--port', port);
  await dome.waitForFunction(() => /open the address that it printed/.test(document.querySelector('.banner.stop')?.textContent ?? ''));
  const hash = new URL(dome.url()).hash;
  const anew = await session.page({ context: dome.context(), address: program.address });
  await dome.waitForFunction(() => !document.querySelector('.banner.stop')); // it is known again
  session.mayFail = false;
  await session.forgive(403, 1); // before it was
  await anew.close();
  assert.equal(new URL(dome.url()).hash, hash);
  await newResult(dome, '');
});

test('a closed tab: the job is among the recent ones, as it was', async () => {
  const document = await documentOf(dome);
  const context = dome.context();
  await dome.close();
  dome = await session.page({ context, address: program.address });
  await dome.waitForSelector('.recent button');
  const seen = dome.locator('.recent li', { hasText: 'dome with a logo' }).first().locator('img');
  await until('its picture is there', () => seen.evaluate((img) => img.complete && img.naturalWidth === 320));
  await picture(dome, 'recent');
  await dome.locator('.recent b', { hasText: 'dome with a logo' }).first().click();
  await newResult(dome, '');
  assert.deepEqual(await documentOf(dome), document);
});

// ---- For everybody ----

test('every control has a name for the ear, and the order of focus is that of the eye', async () => {
  for (const step of ['1', '2', '3', '4']) {
    await blur(dome);
    await dome.keyboard.press(step);
    const nameless = await dome.evaluate(() =>
      [...document.querySelectorAll('button, input, select, textarea, a[href], [role=slider], [role=button]')].filter((e) => {
        const labels = e.labels ? [...e.labels].map((l) => l.textContent).join('') : '';
        return !(e.getAttribute('aria-label') || labels.trim() || e.textContent.trim() || e.title);
      }).map((e) => e.outerHTML.slice(0, 120)));
    assert.deepEqual(nameless, []);
  }
  await blur(dome);
  await dome.keyboard.press('1');
  const order = [];
  for (let k = 0; k < 12; ++k) {
    await dome.keyboard.press('Tab');
    order.push(await dome.evaluate(() => (document.activeElement.closest('.top') ? 'top' : document.activeElement.closest('.steps') ? 'steps' : 'other')));
  }
  assert.ok(order.indexOf('top') === 0 && order.includes('steps') && order.lastIndexOf('top') < order.indexOf('steps'), order.join(' '));
});

test('what a finger has to meet is 40 px large; no name is had twice; the verdict is told whole', async () => {
  const context = await session.browser.newContext({ viewport: { width: 820, height: 1180 }, hasTouch: true, reducedMotion: 'reduce' });
  const tablet = await session.page({ context });
  await openQuick(tablet, 'box', { artwork: [{ text: 'Form', size_mm: 12 }] });
  assert.ok(await tablet.evaluate(() => matchMedia('(pointer: coarse)').matches));
  for (const step of ['1', '2', '3', '4']) {
    await blur(tablet);
    await tablet.keyboard.press(step);
    if (step === '2') {
      await tablet.click('[data-layer="0"]');
      await tablet.click('details summary');
    }
    const small = await tablet.evaluate(() => [...document.querySelectorAll('button, .button, select, input:not([type=checkbox], .hidden), textarea, summary')]
      .filter((e) => e.checkVisibility() && !e.matches('.jobname input, .verdict') && e.getBoundingClientRect().height < 40 && !e.closest('.inset')).map((e) => e.outerHTML.slice(0, 100)));
    assert.deepEqual(small, []);
    await picture(tablet, `tablet-${step}`);
  }
  const names = await tablet.locator('[data-name="show"]').evaluateAll((buttons) => buttons.map((b) => b.getAttribute('aria-label')));
  assert.equal(new Set(names).size, names.length, names.join(', '));
  const cut = () => tablet.evaluate(() => {
    const said = document.querySelector('.verdict .sentence');
    return said.scrollHeight - said.clientHeight;
  });
  assert.ok((await cut()) <= 1);
  await tablet.setViewportSize({ width: 1024, height: 768 });
  assert.ok((await cut()) <= 1);
  assert.match(await tablet.locator('[name="level"]').or(tablet.locator('.divider')).first().evaluate((e) => e.value ?? e.ariaValueNow), /^-?\d+(\.\d{1,2})?$/);
  await picture(tablet, 'tablet-wide');
  await context.close();
});

test('? lists the keys', async () => {
  await blur(dome);
  await dome.keyboard.press('?');
  assert.ok((await dome.locator('.keys dt').count()) > 10);
  await picture(dome, 'keys');
  await dome.keyboard.press('Escape');
});

test('a phone may look: verdict, object, sheet and findings, and nothing to change', async () => {
  const phone = await session.page({ width: 390, height: 844 });
  await phone.waitForSelector('.recent button');
  await phone.locator('.recent li > button').first().click();
  await newResult(phone, '');
  assert.equal(await phone.locator('.steps, [data-name="print"]').count(), 0);
  const wide = await phone.evaluate(() => document.documentElement.scrollWidth);
  assert.ok(wide <= 390, `${wide} px wide`);
  await phone.click('[data-value="object"]');
  await picture(phone, 'phone');
  await phone.context().close();
});

test('nothing is cut off at 1024 x 768, and dark is dark', async () => {
  const small = await session.page({ width: 1024, height: 768, dark: true });
  await small.waitForSelector('.recent button');
  await small.locator('.recent li > button').first().click();
  await newResult(small, '');
  const over = await small.evaluate(() => {
    const wide = [...document.querySelectorAll('.top > *, .step > h2 > button, .viewbar')].filter((e) => e.getBoundingClientRect().right > innerWidth + 1);
    return [document.documentElement.scrollWidth, wide.length];
  });
  assert.deepEqual(over, [1024, 0]);
  const [back] = (await small.evaluate(() => getComputedStyle(document.body).backgroundColor)).match(/\d+/g).map(Number);
  assert.ok(back < 60);
  await picture(small, 'small-dark');
  await small.context().close();
});

part = wanted ?? 'object';
test('no complaint on the console, and no request to anybody else', async () => {
  assert.deepEqual(session.complaints, [], [...session.complaints, 'refused:', ...session.refusals].join('\n'));
});

// ---- Running them ----

const only = process.env.HYDRODIP_ONLY && new RegExp(`${process.env.HYDRODIP_ONLY}|the empty page|an address with a job|dropped together`);
let failures = 0;
for (const { name, body, part: of } of tests) {
  if ((wanted && of !== wanted) || (only && !only.test(name))) continue;
  const began = Date.now();
  try {
    await body();
    console.log(`ok: ${name} (${((Date.now() - began) / 1000).toFixed(1)} s)`);
  } catch (error) {
    ++failures;
    console.log(`FAILED: ${name}\n${error.stack}`);
    if (failed) for (const [k, page] of [toy, lone, dome].entries()) await page?.screenshot({ path: join(failed, `failed-${failures}-${k}.png`) }).catch(() => {});
  }
}
await session.close();
await program.end();
process.exit(failures ? 1 : 0);
