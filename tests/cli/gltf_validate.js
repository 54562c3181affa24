// Runs the Khronos validator on files. Prints a line for each with the numbers of errors, warnings, and triangles.
const fs = require('fs');
const path = require('path');
const validator = require('gltf-validator');

async function validate(file) {
  const beside = uri => Promise.resolve(
      new Uint8Array(fs.readFileSync(path.join(path.dirname(file), decodeURIComponent(uri)))));
  const report = await validator.validateBytes(
      new Uint8Array(fs.readFileSync(file)), {uri: file, externalResourceFunction: beside});
  const {numErrors, numWarnings, messages} = report.issues;
  console.log(`${file}: ${numErrors} errors, ${numWarnings} warnings, ${report.info.totalTriangleCount} triangles`);
  for (const m of messages.filter(m => m.severity < 2)) console.error(`${file}: ${m.code} ${m.message} ${m.pointer || ''}`);
}

(async () => { for (const file of process.argv.slice(2)) await validate(file); })();
