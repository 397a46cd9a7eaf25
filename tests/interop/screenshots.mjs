// Opens glTF files with three.js' GLTFLoader in headless Chromium, checks that it finds the values, saves pictures, and
// compares them with those that Alcove renders of the same files.
//
//     node screenshots.mjs FOLDER ALCOVE FILE.glb=colors|texture...
import { execFileSync } from "node:child_process";
import { createServer } from "node:http";
import { readFileSync, writeFileSync } from "node:fs";
import { basename, extname, join } from "node:path";
import { chromium } from "playwright-core";

const [folder, alcove, ...requests] = process.argv.slice(2);
const types = { ".html": "text/html", ".js": "text/javascript", ".wasm": "application/wasm", ".png": "image/png" };
const server = createServer((request, response) => {
  try {
    const path = decodeURIComponent(new URL(request.url, "http://localhost").pathname);
    const bytes = readFileSync(join(folder, path));
    response.writeHead(200, { "Content-Type": types[extname(path)] ?? "application/octet-stream" });
    response.end(bytes);
  } catch {
    response.writeHead(404).end();
  }
}).listen(0, "127.0.0.1");

/// The image that the first material of a .glb has as its occlusion texture.
function occlusionImage(file) {
  const bytes = readFileSync(file), length = bytes.readUInt32LE(12);
  const json = JSON.parse(bytes.subarray(20, 20 + length));
  const { index } = json.materials.find((material) => material.occlusionTexture).occlusionTexture;
  const { byteOffset, byteLength } = json.bufferViews[json.images[json.textures[index].source].bufferView];
  const from = 28 + length + byteOffset;
  return bytes.subarray(from, from + byteLength);
}

/// Renders the file with the same camera, and light that shows colours as they are. With small voxels, the silhouettes are
/// those of the faces.
function render(file, expected, { eye, lookAt }) {
  const name = basename(file), colors = expected === "texture" ? `texture = "${name}.map.png"` : "painted = true";
  if (expected === "texture") writeFileSync(join(folder, `${name}.map.png`), occlusionImage(join(folder, file)));
  writeFileSync(join(folder, `${name}.toml`), `[camera]
eye = [${eye}]
look_at = [${lookAt}]
[sun]
color = 0
[sky]
color = 1
bounce = 0
[occlusion]
method = "none"
light = "ambient"
[image]
width = 800
height = 800
samples = 16
[[object]]
shape = "mesh"
voxel = "0.1%"
file = "${file}"
material = { color = 1 }
${colors}
`);
  const image = `${name}.alcove.png`;
  execFileSync(alcove, ["render", join(folder, `${name}.toml`), "-o", join(folder, image), "--quiet"]);
  return image;
}

/// Runs in the page. Returns the differences, from 0 to 1, between the means of squares of 8 x 8 pixels. Leaves out
/// squares that show the background in the first picture. However edges are smoothed, the means stay the same.
async function differences([first, second]) {
  const pixels = async (url) => {
    const image = new Image();
    image.src = url;
    await image.decode();
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [image.width, image.height];
    const context = canvas.getContext("2d");
    context.drawImage(image, 0, 0);
    return context.getImageData(0, 0, image.width, image.height);
  };
  const [a, b] = [await pixels(first), await pixels(second)];
  const side = 8, found = [];
  for (let top = 0; top + side <= a.height; top += side)
    for (let left = 0; left + side <= a.width; left += side) {
      let sum = 0, isInside = true;
      for (let i = 0; i < side * side; ++i) {
        const at = 4 * ((top + Math.floor(i / side)) * a.width + left + (i % side));
        isInside &&= a.data[at + 2] - a.data[at] <= 2; // the background is blue, all else is grey
        sum += a.data[at] - b.data[at];
      }
      if (isInside) found.push(Math.abs(sum) / (255 * side * side));
    }
  return found;
}

const browser = await chromium.launch({
  executablePath: "/usr/bin/chromium",
  args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
});
const page = await browser.newPage({ viewport: { width: 800, height: 800 } });
let failed = 0;
for (const request of requests) {
  const [file, expected] = request.split("=");
  await page.goto(`http://127.0.0.1:${server.address().port}/view.html?${file}`);
  await page.waitForFunction(() => document.title !== "loading", undefined, { timeout: 60000 });
  const report = JSON.parse(await page.title());
  const found = expected === "texture" ? report.withTexture : Math.min(report.withAo, report.withColors);
  const picture = `${basename(file)}.png`;
  await page.screenshot({ path: join(folder, picture) });
  if (report.error || !(found > 0 && found === report.meshes)) {
    failed += 1;
    console.log(`${file}: three.js found ${JSON.stringify(report)}`);
    continue;
  }
  const errors = await page.evaluate(differences, [picture, render(file, expected, report)]);
  const rmse = Math.sqrt(errors.reduce((sum, error) => sum + error * error, 0) / errors.length);
  const worst = Math.max(...errors);
  const isSame = errors.length > 200 && rmse < 0.02 && worst < 0.1;
  failed += !isSame;
  if (!isSame) console.log("three.js and Alcove show different colours:");
  console.log(`${file}: ${errors.length} squares, RMSE ${rmse.toFixed(4)}, at most ${worst.toFixed(4)}`);
}
await browser.close();
server.close();
process.exit(failed === 0 ? 0 : 1);
