// Starts `hydrodip studio` with a home of its own, and pages in Debian's Chromium that note every complaint.
import { execFileSync, spawn, spawnSync } from 'node:child_process';
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { roughEdges } from '../../viewer/rough_edges.mjs';

const FLAGS = ['--no-sandbox', '--disable-dev-shm-usage', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'];
// Said by the software renderer about itself, and by Chromium about requests to a program that was killed.
const HARMLESS = /GPU stall|ReadPixels|software WebGL/;
const WHILE_DOWN = /ERR_CONNECTION|ERR_EMPTY_RESPONSE|ERR_INCOMPLETE_CHUNKED|net::ERR/;

// Never the measure of anything: machines are busy.
const PATIENCE_MS = 1000 * Number(process.env.HYDRODIP_PATIENCE_S ?? 240);

export function hasChromium(chromium) {
  return spawnSync(chromium, ['--version']).status === 0;
}

export class Program {
  constructor(hydrodip) {
    this.hydrodip = hydrodip;
    this.home = mkdtempSync(join(tmpdir(), 'hydrodip-studio-'));
    process.on('exit', () => {
      this.process?.kill('SIGKILL');
      rmSync(this.home, { recursive: true, force: true });
    });
  }

  environment() {
    const folder = (name) => {
      const path = join(this.home, name);
      mkdirSync(path, { recursive: true });
      return path;
    };
    return {
      ...process.env, HOME: this.home, XDG_DATA_HOME: folder('data'), XDG_STATE_HOME: folder('state'), XDG_CACHE_HOME: folder('cache'),
      XDG_CONFIG_HOME: folder('config'), XDG_RUNTIME_DIR: folder('run'),
    };
  }

  async start(...more) {
    this.process = spawn(this.hydrodip, ['studio', '--no-browser', ...more], { cwd: this.home, env: this.environment() });
    this.said = '';
    this.errors = '';
    this.process.stderr.on('data', (text) => (this.errors += text));
    this.ended = new Promise((done) => this.process.on('exit', done));
    this.address = await new Promise((done, fail) => {
      this.process.stdout.on('data', (text) => {
        this.said += text;
        const found = this.said.match(/http:\S+/);
        if (found) done(found[0]);
      });
      this.process.on('exit', (code) => fail(new Error(`hydrodip studio ended (${code}): ${this.errors}`)));
    });
    this.origin = new URL(this.address).origin;
    return this.address;
  }

  async end(signal = 'SIGTERM') {
    this.process.kill(signal);
    await this.ended;
  }
}

export class Session {
  static async start(modules, chromium, program) {
    const { chromium: driver } = createRequire(join(modules, 'x.js'))('playwright-core');
    const session = new Session();
    session.program = program;
    session.browser = await driver.launch({ executablePath: chromium, args: FLAGS });
    session.complaints = [];
    session.refusals = [];
    session.mayFail = false;
    return session;
  }

  // A page of its own, with its own cookies.
  async page({ width = 1000, height = 680, dark = false, rough = !process.env.HYDRODIP_PICTURES, address = this.program.address, context = null } = {}) {
    const own = context ?? (await this.browser.newContext({
      viewport: { width, height }, colorScheme: dark ? 'dark' : 'light', reducedMotion: 'reduce', acceptDownloads: true,
    }));
    if (rough) await own.addInitScript(roughEdges);
    const page = await own.newPage();
    page.setDefaultTimeout(PATIENCE_MS);
    const complain = (text) => {
      if (HARMLESS.test(text) || (this.mayFail && WHILE_DOWN.test(text))) return;
      this.complaints.push(text);
    };
    page.on('console', (message) => ['error', 'warning'].includes(message.type()) && complain(message.text()));
    page.on('pageerror', (error) => complain(String(error.stack)));
    // The console says of a refusal only that there was one.
    page.on('response', async (response) => {
      if (response.status() < 400 || this.mayFail) return;
      const request = response.request();
      this.refusals.push(`${request.method()} ${response.url()}: ${await response.text().catch(() => '')}`);
    });
    page.on('request', (request) => {
      const url = request.url();
      if (!url.startsWith(this.program.origin) && !/^(data|blob):/.test(url)) complain(`asks for ${url}`);
    });
    await page.goto(address);
    return page;
  }

  // What the console says of refusals that a test has asked for is no complaint. Waits until it has.
  async forgive(status, count) {
    const asked = new RegExp(`the server responded with a status of ${status} `);
    await until(`${count} refusals on the console`, async () => this.complaints.filter((text) => asked.test(text)).length >= count);
    this.complaints = this.complaints.filter((text) => !asked.test(text));
  }

  async close() {
    await this.browser.close();
  }
}

// ---- What the tests ask of a page ----

export const jobOf = (page) => new URLSearchParams(new URL(page.url()).hash.slice(1)).get('job');

// The job as the program has it.
export const stateOf = (page) => page.evaluate(async (job) => (await fetch(`/api/jobs/${job}`)).json(), jobOf(page));
export const documentOf = async (page) => (await stateOf(page)).document;

export async function until(what, check, seconds = PATIENCE_MS / 1000) {
  const end = Date.now() + 1000 * seconds;
  for (;;) {
    const found = await check();
    if (found) return found;
    if (Date.now() > end) throw new Error(`waited in vain: ${what}`);
    await new Promise((done) => setTimeout(done, 40));
  }
}

// Everything that was changed has reached the program.
export const kept = (page) => page.waitForFunction(() => !/keeping/.test(document.querySelector('.jobname small')?.textContent ?? 'keeping'));

export const resultOf = (page) => page.getAttribute('.side .sheet', 'data-result');

// A result for what the document now says; `final`: in normal quality.
export async function newResult(page, before, final = false) {
  await page.waitForFunction(([old, last]) => {
    const now = document.querySelector('.side .sheet')?.dataset.result;
    return now && now !== old && (!last || document.querySelector('.verdict')?.dataset.draft === 'false');
  }, [before, final]);
}

export async function openSample(page, name) {
  await page.click(`[data-sample="${name}"]`);
  await page.waitForSelector('.work');
  await newResult(page, '');
}

// A job that is computed quickly: what is tested here is the page.
const QUICK = { film: { width_mm: 150, height_mm: 150, elements: 2000 }, dip: { step_mm: 1, air_cells: 20000 }, print: { dpi: 72 }, ink: { rounds_max: 1 } };
export async function openQuick(page, sample, more = {}) {
  const job = await page.evaluate(async ([name, quick]) => {
    const ask = async (method, path, body) => (await fetch(path, { method, headers: { 'X-Hydrodip': '1', 'Content-Type': 'application/json' }, body: body && JSON.stringify(body) })).json();
    const { job: id } = await ask('POST', '/api/jobs', { sample: name });
    const { document } = await ask('GET', `/api/jobs/${id}`);
    await ask('PUT', `/api/jobs/${id}/document`, { client: 'test', document: { ...document, ...quick }, live: false });
    location.hash = `job=${id}`;
    return id;
  }, [sample, { ...QUICK, ...more }]);
  await page.waitForSelector(`.work[data-job="${job}"]`);
  await newResult(page, '');
  return job;
}

export async function type(page, name, value) {
  const field = page.locator(`input[name="${name}"]`);
  await field.fill(String(value));
  await field.press('Enter');
}

export async function drag(page, from, by, { steps = 6, hold = 0 } = {}) {
  await page.mouse.move(from.x, from.y);
  await page.mouse.down();
  for (let k = 1; k <= steps; ++k) {
    await page.mouse.move(from.x + (by.x * k) / steps, from.y + (by.y * k) / steps);
    if (hold) await page.waitForTimeout(hold);
  }
  await page.mouse.up();
}

export async function middleOf(page, selector) {
  const box = await page.locator(selector).boundingBox();
  return { x: box.x + box.width / 2, y: box.y + box.height / 2 };
}

// A file that the program serves, as bytes.
export const bytesOf = async (page, url) => Buffer.from(await page.evaluate(async (path) => {
  const data = new Uint8Array(await (await fetch(path)).arrayBuffer());
  let text = '';
  for (let i = 0; i < data.length; i += 32768) text += String.fromCharCode(...data.subarray(i, i + 32768));
  return btoa(text);
}, url), 'base64');

// Of what was printed and is listed, the files that the command line makes otherwise of the job that can be downloaded;
// and how many were compared.
export async function differencesByHand(page, hydrodip, work) {
  const files = await page.$$eval('[data-file]', (links) => links.map((link) => [link.dataset.file, link.getAttribute('href')]));
  const printed = new Map();
  for (const [file, url] of files) if (/print\.(png|tif|pdf)$|film\.ply$/.test(file)) printed.set(file, await bytesOf(page, url));
  const folder = mkdtempSync(join(work, 'by-hand-'));
  writeFileSync(join(folder, 'job.zip'), await bytesOf(page, `/api/jobs/${jobOf(page)}/job.zip`));
  execFileSync('python3', ['-m', 'zipfile', '-e', 'job.zip', 'job'], { cwd: folder });
  const toml = execFileSync('sh', ['-c', 'ls job/*.toml'], { cwd: folder }).toString().trim();
  execFileSync(hydrodip, ['print', toml, '-o', 'out', '--quiet'], { cwd: folder });
  const different = [...printed].filter(([file, data]) => !data.equals(readFileSync(join(folder, 'out', file)))).map(([file]) => file);
  return { different, compared: printed.size };
}
