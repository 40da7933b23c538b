// Pictures of the studio to be looked at: what people see most, in the windows that they have, light and dark.
// Usage: node pictures.mjs HYDRODIP NODE_MODULES FOLDER [CHROMIUM]
import { mkdirSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { jobOf, newResult, openSample, Program, resultOf, Session, until } from './studio.mjs';

const folder = resolve(process.argv[4]);
mkdirSync(folder, { recursive: true });
const program = new Program(resolve(process.argv[2]));
await program.start();
const session = await Session.start(resolve(process.argv[3]), process.argv[5] || '/usr/bin/chromium', program);

const WINDOWS = { wide: { width: 1400, height: 900 }, small: { width: 1024, height: 768 }, phone: { width: 390, height: 844 } };
const keep = async (page, name) => {
  await page.waitForTimeout(600);
  await page.screenshot({ path: join(folder, `${name}.png`) });
  console.log(name);
};
const press = async (page, key) => {
  await page.evaluate(() => document.activeElement?.blur());
  await page.keyboard.press(key);
};

// `final`: in normal quality, for which a slow machine takes its time.
async function tour(page, name, final) {
  await keep(page, `${name}-start`);
  await openSample(page, 'mask');
  await newResult(page, '', final);
  await keep(page, `${name}-bath`);
  await page.click('[data-value="object"]');
  await keep(page, `${name}-object`);
  await page.selectOption('[name="overlay"]', 'stretch');
  await keep(page, `${name}-stretch`);
  await page.selectOption('[name="overlay"]', 'none');
  await page.click('[data-value="sheet"]');
  await keep(page, `${name}-sheet`);
  await press(page, '2');
  const before = await resultOf(page);
  await page.click('[data-name="add-text"]');
  await newResult(page, before);
  await keep(page, `${name}-artwork`);
  await press(page, '4');
  await keep(page, `${name}-film`);
  await page.click('.verdict');
  await keep(page, `${name}-verdict`);
  await press(page, 'Escape');
  await press(page, '?');
  await keep(page, `${name}-keys`);
  await press(page, 'Escape');
}

async function dips(page, name) {
  await press(page, '3');
  await page.click('[data-name="add-dip"]');
  await page.waitForSelector('[data-name="finish"]');
  await page.click('[data-name="show-parts"]');
  await keep(page, `${name}-parts`);
  await page.click('[name="all-dips"]');
  await keep(page, `${name}-dips`);
  await press(page, 'Control+z');
}

async function print(page, name) {
  await press(page, 'Control+p');
  await until('it prints', () => page.locator('.panel.print .progress').count());
  await keep(page, `${name}-printing`);
  await page.waitForSelector('[data-file="print.pdf"]');
  await keep(page, `${name}-printed`);
}

let job;
for (const [size, dark] of [['wide', false], ['small', true], ['wide', true], ['small', false]]) {
  const page = await session.page({ ...WINDOWS[size], dark });
  const name = `${size}-${dark ? 'dark' : 'light'}`;
  await tour(page, name, size === 'wide' && !dark);
  if (size === 'wide' && !dark) {
    await dips(page, name);
    await press(page, '1');
    await print(page, name);
  }
  job = jobOf(page);
  await page.context().close();
}
for (const dark of [false, true]) {
  const name = `phone-${dark ? 'dark' : 'light'}`;
  const phone = await session.page({ ...WINDOWS.phone, dark });
  await keep(phone, `${name}-start`);
  await phone.evaluate((id) => { location.hash = `job=${id}`; }, job);
  await newResult(phone, '');
  await keep(phone, `${name}-bath`);
  await phone.click('[data-value="object"]');
  await keep(phone, `${name}-object`);
  await phone.evaluate(() => scrollTo(0, document.documentElement.scrollHeight));
  await keep(phone, `${name}-below`);
  await phone.context().close();
}
console.log(session.complaints.join('\n'));
await session.close();
await program.end();
process.exit(session.complaints.length ? 1 : 0);
