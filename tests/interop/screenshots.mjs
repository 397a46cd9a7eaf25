// Opens glTF files with three.js' GLTFLoader in headless Chromium, checks that it finds the values, and saves pictures.
//
//     node screenshots.mjs FOLDER FILE.glb=colors|texture...
import { createServer } from "node:http";
import { readFileSync } from "node:fs";
import { extname, join, basename } from "node:path";
import { chromium } from "playwright-core";

const [folder, ...requests] = process.argv.slice(2);
const types = { ".html": "text/html", ".js": "text/javascript", ".mjs": "text/javascript" };
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
const browser = await chromium.launch({
  executablePath: "/usr/bin/chromium",
  args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
});
const page = await browser.newPage({ viewport: { width: 400, height: 400 } });
let failed = 0;
for (const request of requests) {
  const [file, expected] = request.split("=");
  await page.goto(`http://127.0.0.1:${server.address().port}/view.html?${file}`);
  await page.waitForFunction(() => document.title !== "loading", undefined, { timeout: 60000 });
  const report = JSON.parse(await page.title());
  const found = expected === "texture" ? report.withTexture : Math.min(report.withAo, report.withColors);
  await page.screenshot({ path: join(folder, `${basename(file)}.png`) });
  if (report.error || !(found > 0 && found === report.meshes)) {
    failed += 1;
    console.log(`${file}: three.js found ${JSON.stringify(report)}`);
  }
}
await browser.close();
server.close();
process.exit(failed === 0 ? 0 : 1);
