// The program itself: killed and started again, it has the same address for the pages that are still
// open, and their work. Ended with Ctrl-C, it forgets its token. Usage: node restart.mjs HYDRODIP
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

const program = process.argv[2];
const folder = mkdtempSync(join(tmpdir(), 'hydrodip-studio-'));
const env = { ...process.env, XDG_DATA_HOME: folder };

// Its address, once it serves.
const start = (...options) => begin(env, '--no-browser', ...options);

function begin(env, ...options) {
  const child = spawn(program, ['studio', ...options], { env });
  child.ended = new Promise((resolve) => child.on('exit', (code, signal) => resolve({ code, signal })));
  child.address = new Promise((resolve, reject) => {
    let text = '';
    child.stdout.on('data', (data) => {
      text += data;
      const found = /http:\S+/.exec(text);
      if (found) resolve(new URL(found[0]));
    });
    child.ended.then(() => reject(new Error(`it ended: ${text}`)));
  });
  return child;
}

async function cookie(address) {
  const reply = await fetch(address, { redirect: 'manual' });
  assert.equal(reply.status, 303);
  return reply.headers.get('set-cookie').split(';')[0];
}

function page(address, given) {
  return async (method, path, body) => {
    const reply = await fetch(new URL(path, address.origin), {
      method,
      headers: { Cookie: given, 'X-Hydrodip': '1' },
      body: body && JSON.stringify(body),
    });
    return { status: reply.status, json: await reply.json() };
  };
}

try {
  const first = start();
  const address = await first.address;
  const ask = page(address, await cookie(address));
  const { job } = (await ask('POST', '/api/jobs', { sample: 'pyramid' })).json;
  const { document } = (await ask('GET', `/api/jobs/${job}`)).json;
  document.object.size_mm = 61;
  const put = await ask('PUT', `/api/jobs/${job}/document`, { client: 'c1', document, live: false });
  assert.equal(put.status, 200);
  const { run } = (await ask('GET', '/api/hello')).json;

  first.kill('SIGKILL');
  assert.equal((await first.ended).signal, 'SIGKILL');

  const second = start();
  assert.equal((await second.address).href, address.href, 'the page knows where to look');
  const found = await ask('GET', `/api/jobs/${job}`);
  assert.equal(found.status, 200, 'and is still let in');
  assert.deepEqual(found.json.document, document);
  assert.equal(found.json.revision, put.json.revision);
  assert.notEqual((await ask('GET', '/api/hello')).json.run, run);

  // A second studio at the same time is another one.
  const beside = start();
  assert.notEqual((await beside.address).port, address.port);
  assert.notEqual((await beside.address).search, address.search);
  beside.kill('SIGTERM');
  assert.equal((await beside.ended).code, 0);

  second.kill('SIGINT');
  assert.deepEqual(await second.ended, { code: 0, signal: null });
  const third = start();
  assert.notEqual((await third.address).search, address.search, 'a token lasts one run');
  const ends = page(await third.address, await cookie(await third.address));
  assert.equal((await ends('POST', '/api/quit', {})).status, 200);
  assert.deepEqual(await third.ended, { code: 0, signal: null });

  // Without a desktop the opener is the browser itself: it stays until a person closes it.
  const bin = join(folder, 'bin');
  mkdirSync(bin);
  const file = (name) => join(folder, name);
  const opener = `#!/bin/sh
echo "$1" > ${file('opening')} && mv ${file('opening')} ${file('opened')}
for tenth in $(seq 300); do
  [ ! -e ${file('closed')} ] || exit
  sleep 0.1
done
touch ${file('gave-up')}
`;
  writeFileSync(join(bin, 'xdg-open'), opener, { mode: 0o755 });
  const seen = begin({ ...env, DISPLAY: ':7', PATH: `${bin}:${env.PATH}` });
  const shown = await seen.address;
  while (!existsSync(file('opened'))) await new Promise((done) => setTimeout(done, 20));
  assert.equal(readFileSync(file('opened'), 'utf8').trim(), shown.href);
  const quits = page(shown, await cookie(shown));
  assert.equal((await quits('POST', '/api/quit', {})).status, 200);
  assert.deepEqual(await seen.ended, { code: 0, signal: null });
  assert.ok(!existsSync(file('gave-up')), 'it ends while the browser is open');
  writeFileSync(file('closed'), '');

  const open = start('--listen', '0.0.0.0');
  await assert.rejects(open.address);
  assert.equal((await open.ended).code, 2, 'other machines need a password');
} finally {
  rmSync(folder, { recursive: true });
}
