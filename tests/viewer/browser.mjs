// Drives a headless Chromium through its debugging pipe; needs nothing but Node.js.
import { spawn } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { roughEdges } from './rough_edges.mjs';

const FLAGS = [
  '--headless=new', '--remote-debugging-pipe', '--no-sandbox', '--disable-dev-shm-usage', '--no-first-run',
  '--disable-extensions', '--disable-background-networking', '--hide-scrollbars', '--mute-audio',
  '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--allow-file-access-from-files',
];

export class Browser {
  static async start(program = 'chromium') {
    const browser = new Browser();
    browser.profile = mkdtempSync(join(tmpdir(), 'hydrodip-browser-'));
    browser.process = spawn(program, [...FLAGS, `--user-data-dir=${browser.profile}`], {
      stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe'],
    });
    browser.waiting = new Map();
    browser.listeners = [];
    browser.next = 1;
    browser.gone = new Promise((resolve) => browser.process.on('exit', resolve));
    browser.process.on('error', (error) => browser.fail(error));
    browser.gone.then(() => browser.fail(new Error(`${program} ended`)));
    browser.read(browser.process.stdio[4]);
    const { targetId } = await browser.send('Target.createTarget', { url: 'about:blank' });
    const { sessionId } = await browser.send('Target.attachToTarget', { targetId, flatten: true });
    browser.session = sessionId;
    for (const domain of ['Page', 'Runtime', 'Log', 'Network']) await browser.send(`${domain}.enable`);
    await browser.roughen(true);
    return browser;
  }

  // Whether pages that are opened draw 3D views without smoothed edges.
  async roughen(on) {
    if (on) this.rough = (await this.send('Page.addScriptToEvaluateOnNewDocument', { source: `(${roughEdges})()` })).identifier;
    else await this.send('Page.removeScriptToEvaluateOnNewDocument', { identifier: this.rough });
  }

  read(stream) {
    let rest = Buffer.alloc(0);
    stream.on('data', (chunk) => {
      rest = Buffer.concat([rest, chunk]);
      for (let end = rest.indexOf(0); end >= 0; end = rest.indexOf(0)) {
        this.receive(JSON.parse(rest.subarray(0, end).toString()));
        rest = rest.subarray(end + 1);
      }
    });
  }

  receive(message) {
    if (message.id === undefined) {
      for (const listener of this.listeners) listener(message);
      return;
    }
    const { resolve, reject } = this.waiting.get(message.id);
    this.waiting.delete(message.id);
    if (message.error) reject(new Error(message.error.message));
    else resolve(message.result);
  }

  fail(error) {
    for (const { reject } of this.waiting.values()) reject(error);
    this.waiting.clear();
  }

  send(method, params = {}) {
    const id = this.next++;
    return new Promise((resolve, reject) => {
      this.waiting.set(id, { resolve, reject });
      this.process.stdio[3].write(`${JSON.stringify({ id, method, params, sessionId: this.session })}\0`);
    });
  }

  // Opens a page; from now on `complaints` holds every console error, exception and request for
  // anything but the file itself.
  async open(url, { width = 1200, height = 900, dark = false, scripts = true } = {}) {
    this.complaints = [];
    this.listeners = [(message) => this.note(message, url)];
    await this.send('Emulation.setDeviceMetricsOverride', { width, height, deviceScaleFactor: 1, mobile: width < 500 });
    await this.send('Emulation.setEmulatedMedia', {
      media: '', features: [{ name: 'prefers-color-scheme', value: dark ? 'dark' : 'light' }],
    });
    await this.send('Emulation.setScriptExecutionDisabled', { value: !scripts });
    const loaded = new Promise((resolve) => {
      this.listeners.push((message) => message.method === 'Page.loadEventFired' && resolve());
    });
    await this.send('Page.navigate', { url });
    await loaded;
  }

  note({ method, params }, url) {
    if (method === 'Runtime.exceptionThrown') this.complaints.push(params.exceptionDetails.exception?.description ?? 'exception');
    if (method === 'Runtime.consoleAPICalled' && ['error', 'warning', 'assert'].includes(params.type)) {
      this.complaints.push(params.args.map((arg) => arg.value ?? arg.description).join(' '));
    }
    if (method === 'Log.entryAdded' && params.entry.level === 'error') this.complaints.push(params.entry.text);
    if (method === 'Network.requestWillBeSent') {
      const target = params.request.url;
      if (target !== url && !/^(data|blob):/.test(target)) this.complaints.push(`asks for ${target}`);
    }
  }

  // The value of an expression in the page; promises are awaited.
  async value(expression) {
    const result = await this.send('Runtime.evaluate', { expression, awaitPromise: true, returnByValue: true });
    if (result.exceptionDetails) throw new Error(result.exceptionDetails.exception?.description ?? expression);
    return result.result.value;
  }

  async until(expression, what = expression) {
    for (let i = 0; i < 600; ++i) {
      if (await this.value(expression)) return;
      await new Promise((resolve) => setTimeout(resolve, 50));
    }
    throw new Error(`waited in vain for: ${what}`);
  }

  async box(selector) {
    return this.value(`(() => { const e = document.querySelector('${selector}'); e.scrollIntoView({ block: 'center' });
      const b = e.getBoundingClientRect(); return { x: b.x, y: b.y, width: b.width, height: b.height }; })()`);
  }

  async hover(x, y) {
    await this.send('Input.dispatchMouseEvent', { type: 'mouseMoved', x, y });
  }

  async click(selector) {
    const { x, y, width, height } = await this.box(selector);
    const at = { x: x + width / 2, y: y + height / 2, button: 'left', clickCount: 1 };
    await this.send('Input.dispatchMouseEvent', { type: 'mousePressed', ...at });
    await this.send('Input.dispatchMouseEvent', { type: 'mouseReleased', ...at });
  }

  // PNG bytes of an element, of the window, or of the whole page.
  async picture({ selector, full = false } = {}) {
    const params = { format: 'png', captureBeyondViewport: full };
    if (selector) {
      const box = await this.box(selector);
      const [left, top] = await this.value('[scrollX, scrollY]');
      params.clip = { ...box, x: box.x + left, y: box.y + top, scale: 1 };
    }
    const { data } = await this.send('Page.captureScreenshot', params);
    return Buffer.from(data, 'base64');
  }

  async close() {
    const patience = setTimeout(() => this.process.kill('SIGKILL'), 5000);
    await this.send('Browser.close').catch(() => {});
    await this.gone;
    clearTimeout(patience);
    rmSync(this.profile, { recursive: true, force: true, maxRetries: 5 });
  }
}
