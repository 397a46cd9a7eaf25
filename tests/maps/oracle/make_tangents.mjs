// Writes tangents.txt: meshes with mirrored UVs, and their tangents by the npm package mikktspace.
//
//     npm install mikktspace@1.1.1 && node make_tangents.mjs
//
// One line per corner: position, normal, UV, tangent, sign. An empty line after each mesh.
import { writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';

const { generateTangents } = createRequire(import.meta.url)('mikktspace');

let state = 1;
const random = () => ((state = (state * 1103515245 + 12345) % 2147483648) / 2147483648);

const unit = (v) => v.map((x) => x / Math.hypot(...v));

/** A grid of w × h quads on the unit square, with a point, normal and UV for each vertex. */
function grid(w, h, at) {
  const corners = [];
  for (let j = 0; j < h; ++j)
    for (let i = 0; i < w; ++i) {
      const [a, b, c, d] = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]].map(([x, y]) => at(x / w, y / h));
      corners.push(a, b, c, a, c, d);
    }
  return corners;
}

const noise = Array.from({ length: 400 }, random);
const meshes = {
  // A bumpy sheet whose right half mirrors the UVs of the left.
  sheet: grid(6, 4, (x, y) => {
    const k = Math.round(x * 6) * 20 + Math.round(y * 4), bump = 0.1 * noise[k];
    return { p: [x, y, bump], n: unit([noise[k + 1] - 0.5, noise[k + 2] - 0.5, 2]), uv: [x < 0.5 ? x : 1 - x, y] };
  }),
  // A ball, mirrored at x = 0.
  ball: grid(8, 5, (x, y) => {
    const phi = 2 * Math.PI * (x % 1), theta = Math.PI * (0.1 + 0.8 * y);
    const p = [Math.cos(phi) * Math.sin(theta), Math.cos(theta), Math.sin(phi) * Math.sin(theta)];
    return { p, n: p, uv: [Math.abs(((x + 0.5) % 1) - 0.5) * 2, y] };
  }),
  // A strip with hard edges, turned UVs, and triangles without an area in UV space.
  strip: grid(6, 1, (x, y) => {
    const fold = Math.round(x * 6) % 2 ? 0.1 : 0;
    return { p: [x, y, fold], n: [0, 0, 1], uv: Math.round(x * 6) === 3 ? [0.2, 0.2] : [y * 0.7 + x * 0.3, -x + 0.1 * y] };
  }),
};

let text = '';
for (const corners of Object.values(meshes)) {
  const array = (pick) => new Float32Array(corners.flatMap(pick));
  const p = array((c) => c.p), n = array((c) => c.n), uv = array((c) => c.uv);
  const tangents = generateTangents(p, n, uv);
  for (let i = 0; i < corners.length; ++i)
    text += [...p.slice(3 * i, 3 * i + 3), ...n.slice(3 * i, 3 * i + 3), ...uv.slice(2 * i, 2 * i + 2),
      ...tangents.slice(4 * i, 4 * i + 4)].map((x) => +x.toPrecision(9)).join(' ') + '\n';
  text += '\n';
}
writeFileSync('tangents.txt', text);
