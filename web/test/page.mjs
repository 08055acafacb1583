// Opens a report in a browser and checks it: node test/page.mjs [report.html]. Prints one line of JSON with figures.
// Without an argument it builds the page of made-up results. BROWSER names the program; CAPTURE a folder for images.
// A second argument names an analysis that sweeps over names, with these, such as `oils: thin, thick`.

import { mkdir, readFile, stat, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import puppeteer from "puppeteer-core";
import { degenerate } from "./degenerate.mjs";
import { context, page as fixture } from "./fixture.mjs";

const given = process.argv[2];
const file = given ? resolve(given) : join(tmpdir(), `gearloss-report-${process.pid}.html`);
if (!given) await writeFile(file, await fixture());
const capture = process.env.CAPTURE;
if (capture) await mkdir(capture, { recursive: true });
const axe = await readFile(new URL("../node_modules/axe-core/axe.min.js", import.meta.url), "utf8");

const faults = [];
const check = (is, text) => {
  if (!is) faults.push(text);
};
const pause = (ms) => new Promise((done) => setTimeout(done, ms));

const browser = await puppeteer.launch({ executablePath: process.env.BROWSER ?? "/usr/bin/chromium", args: ["--no-sandbox"], headless: true });
const figures = { file: given ?? "fixture", bytes: (await stat(file)).size };

async function open(width, height, scheme = "light") {
  const page = await browser.newPage();
  page.on("console", (message) => faults.push(`console: ${message.text()}`));
  page.on("pageerror", (fault) => faults.push(`error: ${fault.message}`));
  page.on("request", (request) => {
    const url = request.url().split("#")[0];
    if (!/^(data|blob):/.test(url) && url !== pathToFileURL(file).href) faults.push(`request: ${url}`);
  });
  await page.setViewport({ width, height });
  await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: scheme }]);
  await page.goto(pathToFileURL(file).href, { waitUntil: "load" });
  return page;
}

async function scrolled(page) {
  // The page grows while its pictures are drawn.
  const height = () => page.evaluate(() => document.documentElement.scrollHeight);
  for (let y = 0; y < (await height()); y += 600) {
    await page.evaluate((to) => scrollTo(0, to), y);
    await pause(30);
  }
  await pause(150);
}

async function image(page, name) {
  if (!capture) return;
  await page.evaluate(() => scrollTo(0, 0));
  await page.screenshot({ path: join(capture, `${name}.png`) });
}

const serious = async (page, what) => {
  await page.evaluate(axe);
  const found = await page.evaluate(async () => {
    const result = await window.axe.run(document, { resultTypes: ["violations"] });
    return result.violations.filter((v) => v.impact === "serious" || v.impact === "critical").map((v) => `${v.id}: ${v.nodes.slice(0, 3).map((n) => n.target.join(" ")).join("; ")} (${v.nodes.length})`);
  });
  for (const line of found) faults.push(`axe, ${what}: ${line}`);
};

/** The first screen ends on the screen: its first picture with legend and notes, the note of the drawing, the bar of sections. Less
 * than the descent of a letter is not a cut. */
const whole = async (page, size) => {
  const cut = await page.evaluate(() => {
    if (!document.querySelector(".first.fills")) return [];
    const long = [...document.querySelectorAll(".first [data-picture], .first .loss-note")].filter((e) => e.scrollHeight > e.clientHeight + 4);
    const low = [...document.querySelectorAll(".lead, nav")].filter((e) => e.getBoundingClientRect().bottom > innerHeight + 1);
    return [...long, ...low].map((e) => `${e.className || e.tagName.toLowerCase()} (${e.scrollHeight} in ${e.clientHeight} px)`);
  });
  check(cut.length === 0, `at ${size} the first screen cuts ${cut.join(", ")}`);
};

// Wide screen.
{
  const page = await open(1440, 900);
  figures.load_ms = Math.round(await page.evaluate(() => performance.getEntriesByType("navigation")[0].loadEventEnd));
  await pause(300);
  await image(page, "wide");
  await whole(page, "1440x900");
  const first = await page.evaluate(() => {
    const seen = (selector) => {
      const e = document.querySelector(selector);
      return !e || e.getBoundingClientRect().bottom <= innerHeight + 1;
    };
    return { answer: seen(".answer"), facts: seen(".facts"), lead: seen(".lead") };
  });
  // A card is an answer: no quantity has two of one set, such as its largest and its least value.
  const cards = await page.$$eval(".facts .tiles dt", (list) => list.map((e) => e.textContent.replace(/\s+/g, " ").trim()));
  const quantity = (card) => card.replace(/\b(largest|least|highest|lowest|greatest|smallest|most)\b/gi, "").replace(/\s+/g, " ").trim();
  figures.cards = cards.length;
  check(new Set(cards.map(quantity)).size === cards.length, `two cards of one quantity: ${cards.join("; ")}`);
  for (const [part, is] of Object.entries(first)) check(is, `first screen: ${part} ends below it`);
  // Folded pictures are drawn when they are unfolded.
  await page.evaluate(() => document.querySelectorAll("details.more").forEach((d) => (d.open = true)));
  await scrolled(page);
  const drawn = await page.evaluate(() => [...document.querySelectorAll("[data-picture]")].map((e) => ({ id: e.dataset.picture, ok: e.dataset.drawn === "" && e.querySelector("svg, .gl-note") !== null })));
  figures.pictures = drawn.length;
  for (const { id, ok } of drawn) check(ok, `${id} is not drawn`);
  const nan = await page.evaluate(() => [...document.querySelectorAll("svg *")].filter((e) => [...e.attributes].some((a) => /NaN|Infinity|undefined/.test(a.value))).length);
  check(nan === 0, `${nan} elements with a value that is no number`);
  const small = await page.evaluate(() => [...document.querySelectorAll(".gl text")].filter((e) => parseFloat(getComputedStyle(e).fontSize) < 12).length);
  check(small === 0, `${small} texts below 12 px`);
  figures.texts = await page.evaluate(() => document.querySelectorAll(".gl text").length);
  figures.elements = await page.evaluate(() => document.querySelectorAll("*").length);

  // Tabs by mouse and keyboard, slider, tooltip, click.
  const tabs = await page.$(".pictures [role=tablist]");
  if (tabs) {
    const chosen = () => page.evaluate(() => document.querySelector(".pictures [role=tab][aria-selected=true]")?.textContent);
    const before = await chosen();
    await page.focus(".pictures [role=tab][aria-selected=true]");
    await page.keyboard.press("ArrowRight");
    check((await chosen()) !== before, "the arrow key does not change the tab");
    await page.keyboard.press("ArrowLeft");
    check((await chosen()) === before, "the arrow key does not change the tab back");
  }
  const slider = await page.$(".pictures .gl-slider input");
  if (slider) {
    const shown = () => page.evaluate(() => [document.querySelector(".pictures .gl-slider output").textContent, document.querySelector(".pictures .gl-panels").innerHTML.length].join());
    const before = await shown();
    await slider.focus();
    await page.keyboard.press("ArrowRight");
    await pause(50);
    check((await shown()) !== before, "the slider does nothing");
  }
  const hover = async (selector, what, click) => {
    const element = await page.$(selector);
    if (!element) return;
    await element.evaluate((e) => e.scrollIntoView({ block: "center" }));
    const box = await element.boundingBox();
    let tip = "";
    for (const [fx, fy] of [[0.4, 0.4], [0.3, 0.6], [0.6, 0.3], [0.25, 0.25], [0.2, 0.75]]) {
      await page.mouse.move(box.x + fx * box.width, box.y + fy * box.height);
      tip = await element.evaluate((e) => e.closest(".gl").querySelector(".gl-tip:not([hidden])")?.textContent ?? "");
      if (tip) break;
    }
    check(/\d/.test(tip), `no tooltip at ${what}`);
    if (!click) return;
    const at = [box.x + 0.3 * box.width, box.y + 0.45 * box.height];
    await page.mouse.click(...at);
    check(await element.evaluate((e) => e.closest(".gl").querySelector(".gl-detail svg, .gl-detail .gl-note") !== null), "a click shows no losses");
  };
  await hover(".pictures .gl-panels svg", "panels", (await page.$(".pictures .gl-detail")) !== null);
  await hover(".pictures .gl-svg[tabindex]:not(.gl-panels svg)", "lines", false);
  if (capture) await page.screenshot({ path: join(capture, "hover.png") });
  await page.mouse.move(2, 2);

  // Sorting.
  await page.evaluate(() => document.querySelectorAll("details").forEach((d) => (d.open = true)));
  const table = await page.evaluateHandle(() => [...document.querySelectorAll(".table table")].find((t) => t.tBodies[0].rows.length > 2 && t.querySelector("th.number button")));
  if (await table.evaluate((t) => t !== undefined)) {
    const sorted = await table.evaluate((t) => {
      const head = t.querySelector("th.number");
      const column = () => [...t.tBodies[0].rows].map((r) => parseFloat(r.cells[head.cellIndex].textContent.replace("−", "-"))).filter((v) => !Number.isNaN(v));
      const button = head.querySelector("button");
      button.click();
      const down = column().every((v, k, all) => k === 0 || all[k - 1] >= v);
      button.click();
      return down && column().every((v, k, all) => k === 0 || all[k - 1] <= v);
    });
    check(sorted, "a click on the head does not sort");
  }
  const altered = await page.evaluate(() => [...document.querySelectorAll(".table td")].filter((c) => /[−°\u00a0]/.test(c.textContent) && c.dataset.text === undefined).length);
  check(altered === 0, `${altered} cells do not keep their text`);
  figures.tables = await page.evaluate(() => document.querySelectorAll(".table table").length);
  await serious(page, "light");

  // Dark colours by the button are remembered.
  const ground = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  const light = await ground();
  await page.evaluate(() => scrollTo(0, 0));
  await page.click("#theme");
  check((await ground()) !== light, "the button does not change the colours");
  await page.reload({ waitUntil: "load" });
  check((await ground()) !== light, "the colours are not remembered");
  await page.click("#theme");
  await page.evaluate(() => localStorage.clear());
  await page.close();
}

// A sweep over names is bars: of loss with efficiency, of oil temperature, of each limited quantity; a bar for each name, with its value. The
// headline has all names.
if (process.argv[3]) {
  const [name, list] = process.argv[3].split(": ");
  const names = list.split(", ");
  const page = await open(1440, 900);
  await scrolled(page);
  await page.evaluate(() => document.querySelectorAll("details.more").forEach((d) => (d.open = true)));
  await scrolled(page);
  const section = await page.$(`#analysis-${name}`);
  check(section !== null, `there is no analysis ${name}`);
  const headline = (await section?.$eval(".headline", (e) => e.textContent).catch(() => "")) ?? "";
  for (const own of names) check(headline.includes(own), `the headline of ${name} lacks ${own}: ${headline}`);
  const figures = (await section?.$$eval("figure", (list) => list.map((f) => [f.querySelector("figcaption").textContent, [...f.querySelectorAll(".gl-bar-group")].map((g) => [g.textContent, [...g.querySelectorAll(".gl-share")].some((r) => r.getBoundingClientRect().width > 1 && r.getBoundingClientRect().height > 1)])]))) ?? [];
  for (const [what, value] of [[/^loss and efficiency/i, /\d.W.*\d.%/], [/^oil temperature/i, /\d.°C/], [/limit:/i, /\d/]]) {
    const [caption, bars] = figures.find(([caption]) => what.test(caption)) ?? [`${what}`, []];
    check(bars.length === names.length, `${name}: ${bars.length} bars of ${names.length} names in "${caption}"`);
    for (const own of names) {
      const bar = bars.find(([text]) => text.includes(own));
      check(bar?.[1] && value.test(bar[0].replace(own, "")), `${name}: "${caption}" has no bar with a value for ${own}: ${bar?.[0] ?? ""}`);
    }
  }
  await page.close();
}

// Each link of the bar leads to its heading, although no picture was drawn before.
{
  const page = await open(1440, 900);
  const count = await page.$$eval("nav a", (links) => links.length);
  figures.link_px = 0;
  for (let k = 0; k < count; k++) {
    await page.reload({ waitUntil: "load" });
    await page.evaluate((k) => document.querySelectorAll("nav a")[k].click(), k);
    await pause(250);
    const [name, top, bar] = await page.evaluate((k) => {
      const link = document.querySelectorAll("nav a")[k];
      const heading = document.getElementById(decodeURIComponent(link.hash.slice(1))).querySelector("h2");
      return [link.textContent, heading.getBoundingClientRect().top, document.querySelector("nav").offsetHeight];
    }, k);
    figures.link_px = Math.max(figures.link_px, Math.round(top - bar));
    check(top >= bar && top <= bar + 40, `the link "${name}" stops ${Math.round(top - bar)} px below the bar`);
  }
  await page.close();
}

// Dark by the system.
{
  const page = await open(1440, 900, "dark");
  await scrolled(page);
  figures.screens = await page.evaluate(() => Math.round(document.documentElement.scrollHeight / 90) / 10);
  await image(page, "dark");
  // The drawing is dark, too: its ground, and letters that are light on it. On paper it is light.
  const drawing = () => page.evaluate(() => ["rect.ground", "text"].map((e) => document.querySelector(`.drawing svg ${e}`)).map((e) => e && parseInt(/\d+/.exec(getComputedStyle(e).fill)[0])));
  const [ground, letters] = await drawing();
  check(ground === null || (ground < 60 && letters > 180), `in dark colours the drawing's ground is ${ground} and its letters ${letters} of 255`);
  await page.emulateMediaType("print");
  check(ground === null || (await drawing())[0] === 255, "on paper the drawing is not light");
  await page.emulateMediaType("screen");
  await serious(page, "dark");
  await page.close();
}

// A low screen, as of a notebook.
{
  const page = await open(1366, 768);
  await pause(800);
  await image(page, "low");
  await whole(page, "1366x768");
  await page.close();
}

// Narrow.
{
  const page = await open(500, 900);
  await scrolled(page);
  await image(page, "narrow");
  const width = await page.evaluate(() => document.documentElement.scrollWidth);
  check(width <= 500, `at 500 px the page is ${width} px wide`);
  await page.close();
}

// Paper: all pictures are drawn although none was in view.
{
  const page = await open(1440, 900);
  await page.evaluate(() => {
    window.missing = null;
    addEventListener("beforeprint", () => (window.missing = [...document.querySelectorAll("[data-picture]")].filter((e) => e.dataset.drawn === undefined).length));
  });
  const pdf = await page.pdf({ preferCSSPageSize: true, printBackground: true });
  if (capture) await writeFile(join(capture, "report.pdf"), pdf);
  check(pdf.length > 0 && await page.evaluate(() => [...document.styleSheets].some((s) => [...s.cssRules].some((r) => r.cssText.includes("@top-left") && r.cssText.includes(document.title.slice(0, 20))))), "no running head on paper");
  check(await page.evaluate(() => [...document.styleSheets].some((s) => [...s.cssRules].some((r) => /@bottom-right[^}]*counter\(page\)/.test(r.cssText)))), "no page numbers on paper");
  figures.pages = (Buffer.from(pdf).toString("latin1").match(/\/Type\s*\/Page[^s]/g) ?? []).length;
  figures.pdf_bytes = pdf.length;
  check((await page.evaluate(() => window.missing)) === 0, "pictures are missing on paper");
  await page.close();
}

// Without script texts and tables are there.
{
  const page = await browser.newPage();
  await page.setJavaScriptEnabled(false);
  await page.goto(pathToFileURL(file).href);
  const text = await page.$eval("main", (e) => e.textContent.length);
  check(text > 200, "without script the page is empty");
  await page.close();
}

// Pictures without or with strange values.
if (!given) {
  const content = context();
  content.data = Object.fromEntries(degenerate.map((picture, k) => [`picture-${k}`, picture]));
  content.sections = [{ ...content.sections[4], pictures: degenerate.map((p, k) => ({ id: `picture-${k}`, title: `${k} ${p.kind}` })) }];
  const text = await fixture(content);
  const page = await browser.newPage();
  page.on("console", (message) => faults.push(`degenerate: ${message.text()}`));
  await page.setViewport({ width: 1000, height: 800 });
  await page.setContent(text.replace("<script>try", "<script>addEventListener('error', (e) => console.error(e.message)); try"));
  await page.evaluate(() => document.querySelectorAll("details.more").forEach((d) => (d.open = true)));
  await scrolled(page);
  const bad = await page.evaluate(() => [...document.querySelectorAll("[data-picture]")].filter((e) => e.dataset.drawn === undefined || /NaN|Infinity|undefined/.test(e.innerHTML)).map((e) => `${e.dataset.picture}: ${/.{30}(NaN|Infinity|undefined)/.exec(e.innerHTML)?.[0] ?? "not drawn"}`));
  for (const line of bad) faults.push(`degenerate: ${line}`);
  for (const svg of await page.$$(".gl-svg")) {
    const box = await svg.boundingBox();
    if (box) await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  }
  await page.close();
}

await browser.close();
console.log(JSON.stringify({ ...figures, faults: faults.length }));
for (const fault of new Set(faults)) console.error(fault);
process.exitCode = faults.length ? 1 : 0;
