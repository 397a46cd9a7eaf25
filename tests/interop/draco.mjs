// Compresses the geometry of a .glb without images with Draco.
//
//     node draco.mjs IN.glb OUT.glb
import { copyFileSync, readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";

const require = createRequire(import.meta.url);
const script = new URL("./draco_encoder.cjs", import.meta.url).pathname; // three is a package of ES modules
copyFileSync(new URL("./node_modules/three/examples/jsm/libs/draco/draco_encoder.js", import.meta.url).pathname, script);
// The module has a method `then`, so a promise must not resolve to it.
const { draco } = await new Promise((resolve) => { require(script)({}).then((module) => resolve({ draco: module })); });

const [inPath, outPath] = process.argv.slice(2);
const file = readFileSync(inPath), length = file.readUInt32LE(12);
const json = JSON.parse(file.subarray(20, 20 + length)), binary = file.subarray(28 + length);
const kinds = { POSITION: draco.POSITION, NORMAL: draco.NORMAL, TEXCOORD_0: draco.TEX_COORD, COLOR_0: draco.COLOR };
const bits = { POSITION: 14, NORMAL: 10, TEXCOORD_0: 12, COLOR_0: 10 };
const components = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4 };

function valuesOf(index) {
  const accessor = json.accessors[index], view = json.bufferViews[accessor.bufferView];
  const Type = { 5123: Uint16Array, 5125: Uint32Array, 5126: Float32Array }[accessor.componentType];
  const count = accessor.count * components[accessor.type];
  const from = binary.byteOffset + (view.byteOffset ?? 0) + (accessor.byteOffset ?? 0);
  return new Type(binary.buffer.slice(from, from + count * Type.BYTES_PER_ELEMENT));
}

const chunks = [], views = [];
let size = 0;
for (const mesh of json.meshes)
  for (const primitive of mesh.primitives) {
    const encoder = new draco.Encoder(), builder = new draco.MeshBuilder(), made = new draco.Mesh(), ids = {};
    const indices = Uint32Array.from(valuesOf(primitive.indices));
    builder.AddFacesToMesh(made, indices.length / 3, indices);
    for (const [name, index] of Object.entries(primitive.attributes)) {
      const values = valuesOf(index), width = components[json.accessors[index].type];
      ids[name] = builder.AddFloatAttributeToMesh(made, kinds[name], values.length / width, width, values);
      encoder.SetAttributeQuantization(kinds[name], bits[name]);
    }
    encoder.SetTrackEncodedProperties(true);
    const encoded = new draco.DracoInt8Array(), bytes = encoder.EncodeMeshToDracoBuffer(made, encoded);
    const data = Buffer.alloc(Math.ceil(bytes / 4) * 4);
    for (let i = 0; i < bytes; ++i) data[i] = encoded.GetValue(i);
    views.push({ buffer: 0, byteOffset: size, byteLength: bytes });
    chunks.push(data);
    size += data.length;
    const own = (index, count) => {
      const { bufferView, byteOffset, ...kept } = json.accessors[index];
      return json.accessors.push({ ...kept, count }) - 1;
    };
    for (const [name, index] of Object.entries(primitive.attributes))
      primitive.attributes[name] = own(index, encoder.GetNumberOfEncodedPoints());
    primitive.indices = own(primitive.indices, 3 * encoder.GetNumberOfEncodedFaces());
    primitive.extensions = { KHR_draco_mesh_compression: { bufferView: views.length - 1, attributes: ids } };
  }
for (const accessor of json.accessors) delete accessor.bufferView; // those that no primitive has any more
json.bufferViews = views;
json.buffers = [{ byteLength: size }];
json.extensionsUsed = json.extensionsRequired = ["KHR_draco_mesh_compression"];
const text = Buffer.from(JSON.stringify(json)), padded = Buffer.alloc(Math.ceil(text.length / 4) * 4, " ");
text.copy(padded);
const number = (...values) => Buffer.from(Uint32Array.from(values).buffer);
writeFileSync(outPath, Buffer.concat([
  number(0x46546c67, 2, 28 + padded.length + size, padded.length, 0x4e4f534a), padded, number(size, 0x004e4942), ...chunks,
]));
