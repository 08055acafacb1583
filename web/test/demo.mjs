// Opens the page without a server, from its file, and uses it: node test/demo.mjs PAGE.html. Prints one line of JSON with figures.
// PROGRAM is the path of gearloss, with whose numbers those of the page are compared; BROWSER names the browser.

import { execFileSync } from "node:child_process";
import { readFile, stat } from "node:fs/promises";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import puppeteer from "puppeteer-core";

const [file] = process.argv.slice(2);
const program = process.env.PROGRAM;
if (!file || !program) throw new Error("usage: PROGRAM=gearloss node test/demo.mjs PAGE.html");
const address = pathToFileURL(resolve(file)).href;
const examples = new URL("../../examples/", import.meta.url).pathname;

const faults = [];
const check = (is, text) => void (is || faults.push(text));
const browser = await puppeteer.launch({ executablePath: process.env.BROWSER ?? "/usr/bin/chromium", args: ["--no-sandbox"], headless: true });
const page = await browser.newPage();
page.on("console", (message) => faults.push(`console: ${message.text()}`));
page.on("pageerror", (fault) => faults.push(`error: ${fault.message}`));
page.on("request", (request) => {
  if (request.url() !== address && !/^(data|blob):/.test(request.url())) faults.push(`request: ${request.url()}`);
});
await page.setViewport({ width: 1440, height: 900 });
const start = performance.now();
await page.goto(address, { waitUntil: "load" });

const until = async (what, test, ...args) => {
  await page.waitForFunction(test, { timeout: 30000, polling: 20 }, ...args).catch(() => faults.push(`never: ${what}`));
};
const lossOf = () => Number(document.querySelector("#numbers [data-number=loss]")?.dataset.value ?? NaN);

/** Compares the point of the page with the one that the program solves. */
async function compare(gearbox) {
  const point = await page.evaluate(() => ({
    gear: document.querySelector("#controls select[data-name=gear]").value,
    inputs: [...document.querySelectorAll("#controls .slider[data-port]")].map((slider) => [slider.dataset.quantity, slider.dataset.port, slider.querySelector(".slider-number").value]),
  }));
  const args = ["solve", join(examples, gearbox), "--gear", point.gear, "--format", "json"];
  for (const [quantity, port, value] of point.inputs) args.push(`--${quantity}`, `${port}=${value} ${quantity === "torque" ? "Nm" : "rpm"}`);
  const solved = JSON.parse(execFileSync(program, args, { encoding: "utf8" })).loss_w;
  const shown = await page.evaluate(lossOf);
  // Another processor rounds otherwise.
  check(Math.abs(shown / solved - 1) < 1e-9, `${gearbox}: loss ${shown} W, the program has ${solved} W`);
}

await until("a loss", () => Number(document.querySelector("#numbers [data-number=loss]")?.dataset.value) > 0);
const figures = { bytes: (await stat(file)).size, ready_ms: Math.round(performance.now() - start) };
await compare("two-speed-ev/gearbox.yaml");

// A text that is pasted: first one with a fault.
const planetary = await readFile(join(examples, "planetary-reducer/gearbox.yaml"), "utf8");
async function paste(text) {
  await page.focus(".cm-content");
  await page.keyboard.down("Control");
  await page.keyboard.press("a");
  await page.keyboard.up("Control");
  await page.evaluate((text) => {
    const clipboardData = new DataTransfer();
    clipboardData.setData("text/plain", text);
    const event = new ClipboardEvent("paste", { clipboardData, bubbles: true, cancelable: true });
    document.querySelector(".cm-content").dispatchEvent(event);
  }, text);
}
await paste(planetary.replace("bearings:", "bearigs:"));
await until("a finding", () => document.getElementById("findings").textContent.includes("write bearings"));
const pasted = performance.now();
await paste(planetary);
await until("the pasted gearbox", () => {
  const loss = Number(document.querySelector("#numbers [data-number=loss]")?.dataset.value);
  const gear = document.querySelector("#controls select[data-name=gear]")?.value;
  return loss > 0 && gear === "reducing" && document.querySelector("#convergence svg") !== null;
});
figures.pasted_ms = Math.round(performance.now() - pasted);
await compare("planetary-reducer/gearbox.yaml");

// A map of it.
const tab = (name) => page.evaluate((name) => [...document.querySelectorAll("#results-tabs [role=tab], #results-tabs button")].find((tab) => tab.textContent.trim() === name).click(), name);
await tab("Map");
await until("a map", () => document.querySelector("#results-body svg .gl-field") !== null);

// The study and its report, a page of its own. The policy of the page holds for it, too.
await page.click('.file[data-file="study.yaml"] button');
await paste(await readFile(new URL("../demo/src/study.yaml", import.meta.url), "utf8"));
await page.evaluate(() => document.querySelector('.file[data-file="two-speed-ev.yaml"] button').click());
await paste(await readFile(join(examples, "two-speed-ev/gearbox.yaml"), "utf8"));
await tab("Study");
await until("analyses", () => document.querySelectorAll(".analyses li").length > 0);
await page.evaluate(() => document.querySelector(".study-side .primary").click());
await until("a report", () => document.querySelector("[data-report]") !== null);
const opened = browser.waitForTarget((t) => t.opener() === page.target(), { timeout: 10000 }).catch(() => null);
if (await page.$("[data-report]")) await page.click("[data-report]");
const report = await (await opened)?.page();
if (report) {
  report.on("console", (message) => faults.push(`report: ${message.text()}`));
  await report.waitForFunction(() => document.querySelector("svg") !== null, { timeout: 15000 }).catch(() => faults.push("never: pictures in the report"));
} else faults.push("never: the report");

await browser.close();
console.log(JSON.stringify({ ...figures, faults }));
process.exit(faults.length ? 1 : 0);
