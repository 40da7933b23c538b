// Random actions with a fixed seed, as a person in a hurry might do them. Afterwards: no complaint, undo to
// the start gives the first state, and the program's memory is bounded. In a longer run the job, as the monkey leaves it, is printed
// now and then, and the command line makes the same bytes of it.
// Usage: node monkey.mjs HYDRODIP NODE_MODULES [CHROMIUM]; HYDRODIP_MONKEY_MINUTES (0.1), HYDRODIP_MONKEY_SEED (1).
import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { differencesByHand, documentOf, hasChromium, kept, newResult, openQuick, Program, Session, stateOf, until } from './studio.mjs';

const chromium = process.argv[4] || '/usr/bin/chromium';
if (!hasChromium(chromium)) {
  console.log(`skipped: there is no ${chromium}`);
  process.exit(77);
}
const minutes = Number(process.env.HYDRODIP_MONKEY_MINUTES ?? 0.1);
let seed = Number(process.env.HYDRODIP_MONKEY_SEED ?? 1);
const random = () => {
  seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0;
  return seed / 4294967296;
};
const below = (n) => Math.floor(n * random());
const pick = (list) => list[below(list.length)];

const program = new Program(resolve(process.argv[2]));
await program.start();
const session = await Session.start(resolve(process.argv[3]), chromium, program);
const page = await session.page({ width: 1024, height: 720 });
await openQuick(page, process.env.HYDRODIP_MONKEY_SAMPLE ?? 'pyramid');
const first = await documentOf(page);

const memory_mb = () => Number(readFileSync(`/proc/${program.process.pid}/status`, 'utf8').match(/VmRSS:\s+(\d+)/)[1]) / 1024;
const blur = () => page.evaluate(() => document.activeElement?.blur());
const exists = async (selector) => (await page.locator(selector).count()) > 0;
const field = async (name, value) => {
  const box = page.locator(`input[name="${name}"]`);
  if (!(await box.count()) || (await box.isDisabled())) return;
  await box.fill(String(value));
  await box.press('Enter');
};
const press = async (key) => {
  await blur();
  await page.keyboard.press(key);
};
const drag = async (selector) => {
  const box = await page.locator(selector).first().boundingBox();
  if (!box) return;
  await page.mouse.move(box.x + box.width * (0.3 + 0.4 * random()), box.y + box.height * (0.3 + 0.4 * random()));
  await page.mouse.down();
  for (let k = 0; k < 4; ++k) await page.mouse.move(box.x + below(200) - 50, box.y + below(200) - 50);
  await page.mouse.up();
};
const ACTIONS = {
  step: () => press(pick(['1', '2', '3', '4'])),
  tool: () => press(pick(['r', 'm', 'f', 'z', 'Escape'])),
  turn: () => field(`turn-${pick(['x', 'y', 'z'])}`, below(360) - 180),
  depth: () => field('depth', pick(['', 5 + below(30)])),
  shift: () => field(`shift-${pick(['x', 'y'])}`, below(30) - 15),
  size: () => field('size', pick(['', 40 + below(120)])),
  margin: () => field('film-margin_mm', 5 + below(20)),
  nonsense: () => field(pick(['size', 'depth', 'turn-x', 'film-width']), pick(['x', '-', '1e9', '-4', '', '0'])),
  sheet: async () => (await exists('[name="sheet"]')) && page.selectOption('[name="sheet"]', pick(['a4', 'a3', 'letter'])),
  down: async () => (await exists('[name="down"]')) && page.selectOption('[name="down"]', pick(['-z', '+z', '-x', '+y'])),
  overlay: async () => (await exists('[name="overlay"]')) && page.selectOption('[name="overlay"]', pick(['none', 'stretch', 'tears', 'coverage', 'angle', 'air'])),
  text: async () => (await exists('[data-name="add-text"]')) && page.click('[data-name="add-text"]'),
  layer: async () => (await exists('[data-layer]')) && page.locator('[data-layer]').first().click(),
  layerWidth: () => field('layer-width', 5 + below(40)),
  projection: async () => (await exists('[name="projection"]')) && page.selectOption('[name="projection"]', pick(['planar', 'box', 'wrap', 'cylinder', 'sphere', 'film'])),
  handle: async () => (await exists('[data-grip]')) && drag(`[data-grip="${pick(['move', 'scale', 'turn'])}"]`),
  remove: () => press('Delete'),
  dip: async () => (await exists('[data-name="add-dip"]')) && (await page.locator('.dip').count()) < 4 && page.click('[data-name="add-dip"]'),
  otherDip: async () => (await exists('[data-dip]')) && page.locator('[data-dip]').nth(below(await page.locator('[data-dip]').count())).click(),
  lessDips: async () => (await exists('.dip')) && page.locator('.dip').last().locator('.button').last().click(),
  mend: async () => (await exists('.side [data-name="mend"]')) && page.locator('.side [data-name="mend"]').first().click(),
  canvas: async () => (await page.locator('.canvas-box').isVisible()) && drag('.canvas-box canvas'),
  depthHandle: async () => (await exists('[data-name="depth-handle"]')) && drag('[data-name="depth-handle"]'),
  view: async () => page.click(`[data-value="${pick(['bath', 'object', 'sheet'])}"]`),
  together: async () => (await exists('[name="all-dips"]')) && page.click('[name="all-dips"]'),
  parts: async () => (await exists('[data-name="show-parts"]')) && page.click('[data-name="show-parts"]'),
  reader: async () => (await exists('[data-value="customer"]')) && page.click(`[data-value="${pick(['customer', 'workshop'])}"]`),
  play: () => press('Space'),
  undo: () => press('Control+z'),
  redo: () => press('Control+Shift+Z'),
  panel: () => press(pick(['?', 'Escape'])),
};

// Prints the job as it is; whether it could be.
const PRINT_EVERY_MS = 10 * 60000;
const hydrodip = resolve(process.argv[2]);
const work = mkdtempSync(join(tmpdir(), 'hydrodip-monkey-'));
process.on('exit', () => rmSync(work, { recursive: true, force: true }));
const lastPrint = async () => (await stateOf(page)).tasks.filter(({ kind }) => kind === 'print').at(-1);
async function printAndCompare() {
  await press('Escape');
  await press('Escape');
  await kept(page);
  const before = (await lastPrint())?.task;
  await press('Control+p');
  await until('a print', async () => (await lastPrint())?.task !== before);
  await until('its end', async () => (await lastPrint()).state !== 'running', 900);
  const { task, state, error } = await lastPrint();
  const printed = state === 'done';
  if (!printed) console.log(`a print ended as ${state}: ${JSON.stringify(error ?? null)}`);
  if (printed) await page.waitForSelector(`.panel.print [data-file][href*="/tasks/${task}/"]`, { timeout: 30000 });
  if (printed) assert.deepEqual((await differencesByHand(page, hydrodip, work)).different, []);
  await press('Escape');
  return printed;
}

page.setDefaultTimeout(3000); // what is in the way of a click is so for good
const counts = {};
const memory = []; // a figure for every minute
let most = memory_mb();
let prints = 0;
const began = Date.now();
let printed = began;
while (Date.now() - began < minutes * 60000) {
  if (Date.now() - printed > PRINT_EVERY_MS) {
    prints += await printAndCompare();
    printed = Date.now();
  }
  if (Date.now() - began > memory.length * 60000) memory.push(Math.round(memory_mb()));
  const name = pick(Object.keys(ACTIONS));
  counts[name] = (counts[name] ?? 0) + 1;
  try {
    await ACTIONS[name]();
  } catch (error) {
    // Something else came over it meanwhile, as it does to people; what counts is said on the console.
    if (!/Timeout|intercepts|not visible|detached|outside of the viewport/.test(String(error))) throw error;
  }
  most = Math.max(most, memory_mb());
  if (session.complaints.length) break;
}
page.setDefaultTimeout(120000);
assert.deepEqual(session.complaints, [], `${session.refusals.join('\n')} after ${JSON.stringify(counts)}`);

await press('Escape');
for (let k = 0; k < 50000 && !(await page.locator('[data-name="undo"]').isDisabled()); ++k) await press('Control+z');
await kept(page);
await until('the first state', async () => JSON.stringify(await documentOf(page)) === JSON.stringify(first));
await newResult(page, '', true);
assert.deepEqual(session.complaints, []);
assert.equal(program.errors, '');
assert.ok(most < 3000, `${most} MB`);
console.log(`ok: ${Object.values(counts).reduce((a, b) => a + b, 0)} actions in ${minutes} min, ${prints} prints compared, at most ${most.toFixed(0)} MB; by the minute ${memory.join(' ')}`);
await session.close();
await program.end();
process.exit(0);
