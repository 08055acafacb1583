// Writes docs/gallery.md with a picture of every kind of analysis: node gallery.mjs, after the examples have been run.

import { mkdir, readFile, writeFile } from "node:fs/promises";
import { pathToFileURL } from "node:url";
import puppeteer from "puppeteer-core";

const root = new URL("../", import.meta.url);
// Kind of analysis, example, name of the analysis in its study, and which of its pictures (-1: the last).
const shown = [
  ["map", "two-speed-ev", "maps", 0],
  ["compare", "two-speed-ev", "gap", 0],
  ["compare", "electric-drive-unit", "savings", 0],
  ["cycle", "electric-drive-unit", "figure_9", 0],
  ["fluid_sweep", "electric-drive-unit", "figure_11", 1],
  ["optimise", "best-design", "best", 0],
  ["identify", "two-speed-ev", "identify", 0],
  ["tournament", "two-speed-ev", "which", 0],
  ["uncertainty", "two-speed-ev", "band", 0],
  ["sensitivity", "two-speed-ev", "what_matters", 0],
  ["rms_surface", "two-speed-ev", "surface", 0],
  ["breakdown", "two-speed-ev", "stack", 1],
  ["temperature_sweep", "two-products", "warming", 0],
  ["sweep", "two-speed-ev", "designs", -1],
  ["spin_loss", "two-speed-ev", "spin", 0],
  ["contact_path", "two-speed-ev", "contact", 1],
  ["component_compare", "two-speed-ev", "bearing_models", 1],
  ["operating_points", "planetary-reducer", "tests", 0],
  ["thermal_limit", "planetary-reducer", "limit", 0],
  ["balance", "planetary-reducer", "convergence", 0],
];

/** The lines of an analysis in a study. */
function written(study, name) {
  const lines = study.split("\n");
  const first = lines.findIndex((line) => line.startsWith(`  ${name}:`));
  let end = first + 1;
  while (end < lines.length && /^ {3,}\S/.test(lines[end])) end++;
  return lines.slice(first, end).map((line) => line.slice(2)).join("\n");
}

const browser = await puppeteer.launch({ executablePath: process.env.BROWSER ?? "/usr/bin/chromium", args: ["--no-sandbox"], headless: true });
const page = await browser.newPage();
await page.setViewport({ width: 1100, height: 900 });
await mkdir(new URL("docs/gallery/", root), { recursive: true });
let text = `# Gallery

See what each kind of analysis shows: a picture and the lines of the study that make it. The report shows more of each, with tooltips and tables.
Made from the examples by \`web/gallery.mjs\`.
`;
let open = "";
for (const [kind, example, name, picture] of shown) {
  const report = new URL(`examples/${example}/results/report.html`, root);
  if (open !== report.href) await page.goto(pathToFileURL(report.pathname).href, { waitUntil: "load" });
  open = report.href;
  await page.evaluate((id) => document.getElementById(id).scrollIntoView(), `analysis-${name}`);
  // In the order of the analysis: the section shows the picture of the first screen last.
  const ids = await page.$$eval(`section[id="analysis-${name}"] .picture`, (list) => list.map((e) => e.dataset.picture).sort((a, b) => a.localeCompare(b, "en", { numeric: true })));
  const figure = await page.$(`section[id="analysis-${name}"] figure:has([data-picture="${ids.at(picture)}"])`);
  await figure.evaluate((e) => {
    for (let up = e.closest("details"); up; up = up.parentElement.closest("details")) up.open = true;
    e.classList.add("wide");
    e.scrollIntoView({ block: "center" });
  });
  await page.waitForFunction((e) => e.querySelector(".picture[data-drawn] svg"), {}, figure);
  await new Promise((done) => setTimeout(done, 300));
  const file = `${kind}-${name}.png`.replaceAll("_", "-");
  await figure.screenshot({ path: new URL(`docs/gallery/${file}`, root).pathname });
  const study = await readFile(new URL(`examples/${example}/study.yaml`, root), "utf8");
  const result = await page.$eval(`section[id="analysis-${name}"]`, (e) => e.querySelector(".headline")?.textContent ?? "");
  text += `\n## ${kind}: ${example}, \`${name}\`\n\`\`\`yaml\n${written(study, name)}\n\`\`\`\n${result ? `${result.trim()}\n\n` : ""}![${kind}](gallery/${file})\n`;
}
await browser.close();
await writeFile(new URL("docs/gallery.md", root), text);
