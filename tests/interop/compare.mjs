// Checks a glTF file against the one that it was made from: the Khronos validator finds no error that the input did not
// have, and every value of the JSON and every accessor of the input is unchanged.
//
//     node compare.mjs IN OUT [--converted|--packed]
//
// With --converted, OUT is another scene, and only validated. With --packed, images may differ.
import { readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import validator from "gltf-validator";

function parse(path) {
  const file = readFileSync(path);
  if (file.toString("latin1", 0, 4) !== "glTF") return { json: JSON.parse(file), binary: null };
  const length = file.readUInt32LE(12);
  const json = JSON.parse(file.subarray(20, 20 + length));
  const at = 20 + length;
  return { json, binary: at < file.length ? file.subarray(at + 8, at + 8 + file.readUInt32LE(at)) : null };
}

function bufferOf(path, { json, binary }, index) {
  const { uri } = json.buffers[index];
  if (uri === undefined) return binary;
  if (uri.startsWith("data:")) return Buffer.from(uri.slice(uri.indexOf(",") + 1), "base64");
  return readFileSync(join(dirname(path), decodeURIComponent(uri)));
}

/// The bytes that a buffer view has.
function viewOf(path, file, index) {
  const view = file.json.bufferViews[index];
  const packed = view.extensions?.EXT_meshopt_compression ?? view;
  const buffer = bufferOf(path, file, packed.buffer);
  const from = packed.byteOffset ?? 0;
  return buffer.subarray(from, from + packed.byteLength);
}

const problems = [];
const [inPath, outPath, option] = process.argv.slice(2);
const before = option === "--converted" ? undefined : parse(inPath), after = parse(outPath);
const packed = new Set(option === "--packed" ? before.json.images.map((image) => image.bufferView) : []);

/// Checks that everything of `a` is in `b`. An output may differ in the place and length of buffers, in the mesh of a
/// node, and in values that an earlier bake has added.
function compare(a, b, path) {
  if (/^\/buffers\/\d+\/(uri|byteLength)$/.test(path) || /^\/nodes\/\d+\/mesh$/.test(path)) return;
  if (packed.has(Number(path.match(/^\/bufferViews\/(\d+)\/byteLength$/)?.[1]))) return;
  if (path.startsWith("/asset/extras/comments")) return;
  if (/^\/bufferViews\/\d+\/(buffer|byteOffset)$/.test(path)) return; // compared by their bytes
  if (typeof a !== typeof b || Array.isArray(a) !== Array.isArray(b)) problems.push(`${path} changed`);
  else if (a && typeof a === "object") {
    for (const [key, value] of Object.entries(a))
      if (!(key in b)) problems.push(`${path}/${key} is missing`);
      else compare(value, b[key], `${path}/${key}`);
  } else if (a !== b) problems.push(`${path}: ${a} became ${b}`);
}

async function errorsOf(path) {
  const report = await validator.validateBytes(new Uint8Array(readFileSync(path)), {
    uri: path,
    maxIssues: 0,
    externalResourceFunction: (uri) => Promise.resolve(new Uint8Array(readFileSync(join(dirname(path), decodeURIComponent(uri))))),
  });
  return report.issues.messages.filter((issue) => issue.severity === 0).map((issue) => `${issue.code} at ${issue.pointer}: ${issue.message}`);
}

if (option !== "--converted") {
  compare(before.json, after.json, "");
  for (let i = 0; i < (before.json.bufferViews ?? []).length; ++i)
    if (!packed.has(i) && !viewOf(inPath, before, i).equals(viewOf(outPath, after, i))) problems.push(`the bytes of bufferViews/${i} changed`);
}
const known = new Set(option === "--converted" ? [] : (await errorsOf(inPath)).map((error) => error.split(" ")[0]));
for (const error of await errorsOf(outPath)) if (!known.has(error.split(" ")[0])) problems.push(error);
for (const problem of problems.slice(0, 10)) console.log(`${outPath}: ${problem}`);
process.exit(problems.length === 0 ? 0 : 1);
