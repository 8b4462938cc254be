// node validate_gltf.mjs FILE: Khronos's validator; prints what it found, fails on any error.
import fs from "node:fs";
import validator from "gltf-validator";

const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(process.argv[2])));
const { numErrors, numWarnings, messages } = report.issues;
for (const m of messages) console.log(m.severity, m.code, m.message, m.pointer);
console.log(`errors ${numErrors} warnings ${numWarnings}`);
process.exit(numErrors > 0 ? 1 : 0);
