// Khronos' glTF validator on every file given: no errors, no warnings. Usage:
// NODE_PATH=.../node_modules node validate_glb.cjs FILE.glb...
const { readFileSync } = require('node:fs');
const validator = require('gltf-validator');

async function check(file) {
  const report = await validator.validateBytes(new Uint8Array(readFileSync(file)));
  const { numErrors, numWarnings, numInfos, numHints, messages } = report.issues;
  console.log(`${file}: ${numErrors} errors, ${numWarnings} warnings, ${numInfos} infos, ${numHints} hints`);
  for (const { code, message, pointer } of messages) console.log(`  ${code} ${pointer}: ${message}`);
  return numErrors + numWarnings === 0;
}

Promise.all(process.argv.slice(2).map(check)).then((good) => process.exit(good.every(Boolean) ? 0 : 1));
