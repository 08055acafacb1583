// Starts `gearloss open` on a copy of the examples and uses the page as an engineer would: node test/workbench.mjs. Prints one line of JSON with figures.
// PROGRAM is the path of gearloss; BROWSER names the browser; CAPTURE a folder for images.

import { execFileSync, spawn } from "node:child_process";
import { cp, mkdir, mkdtemp, readFile, rename, rm, writeFile } from "node:fs/promises";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { join } from "node:path";
import puppeteer from "puppeteer-core";

const program = process.env.PROGRAM;
if (!program) throw new Error("PROGRAM names the program gearloss");
const capture = process.env.CAPTURE;
if (capture) await mkdir(capture, { recursive: true });
const axe = await readFile(new URL("../node_modules/axe-core/axe.min.js", import.meta.url), "utf8");
const examples = new URL("../../examples/", import.meta.url).pathname;
const root = await mkdtemp(join(tmpdir(), "gearloss-workbench-"));
const folder = join(root, "gearboxes");
for (const name of ["planetary-reducer", "two-speed-ev"]) await cp(join(examples, name), join(folder, name), { recursive: true, filter: (file) => !file.includes("/results") });

/** Writes a file at once, as editors do: the page must not read half of it. */
async function replaceFile(file, text) {
  const written = join(root, "written");
  await writeFile(written, text);
  await rename(written, file);
}

const faults = [];
const figures = {};
const check = (is, text) => {
  if (!is) faults.push(text);
  return is;
};
const pause = (ms) => new Promise((done) => setTimeout(done, ms));

/** Starts the program in a folder; returns it with its address. */
async function start(place = folder) {
  const child = spawn(program, ["open", place, "--no-browser", "--keep"], { stdio: ["ignore", "pipe", "pipe"], env: { ...process.env, XDG_STATE_HOME: join(root, "state") } });
  let text = "";
  const address = await new Promise((done, fail) => {
    const read = (data) => {
      text += data;
      const found = /http:\/\/\S+#t=[0-9a-f]+/.exec(text);
      if (found) done(found[0]);
    };
    child.stdout.on("data", read);
    child.stderr.on("data", read);
    child.on("exit", () => fail(new Error(`the program ended: ${text}`)));
  });
  return { child, address };
}

/** A part of the test; one that cannot go on does not end the others. */
async function step(name, act) {
  try {
    await act();
  } catch (fault) {
    faults.push(`${name}: ${fault.stack}`);
  }
}

const { child, address } = await start();
process.on("exit", () => child.kill());
const browser = await puppeteer.launch({ executablePath: process.env.BROWSER ?? "/usr/bin/chromium", args: ["--no-sandbox"], headless: true });
/** After the end of the program the browser reports failed requests. */
let ended = false;

async function open(width = 1440, height = 900, scheme = "light", url = address) {
  const page = await browser.newPage();
  page.on("console", (message) => {
    if (!ended && !message.text().includes("ERR_ABORTED")) faults.push(`console: ${message.text()}`);
  });
  page.on("pageerror", (fault) => faults.push(`error: ${fault.stack}`));
  page.on("request", (request) => {
    const at = new URL(request.url());
    if (!/^(data|blob):$/.test(at.protocol) && at.hostname !== "127.0.0.1") faults.push(`request: ${at}`);
  });
  page.on("dialog", (dialog) => void dialog.accept());
  await page.setViewport({ width, height });
  await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: scheme }]);
  await page.goto(url, { waitUntil: "load" });
  return page;
}

const until = async (page, what, test, ...args) => {
  try {
    await page.waitForFunction(test, { timeout: 15000, polling: 20 }, ...args);
    return true;
  } catch {
    faults.push(`${what}: not within 15 s`);
    return false;
  }
};
const ready = (page) => until(page, "the page is ready", () => document.documentElement.dataset.ready === "" && document.querySelector("[data-number=loss]")?.dataset.value);
const image = async (page, name) => {
  if (capture) await page.screenshot({ path: join(capture, `${name}.png`) });
};
const serious = async (page, what) => {
  await page.evaluate(axe);
  const found = await page.evaluate(async () => {
    const result = await window.axe.run(document, { resultTypes: ["violations"] });
    return result.violations.map((v) => `${v.id} (${v.impact}): ${v.nodes.slice(0, 3).map((n) => n.target.join(" ")).join("; ")} (${v.nodes.length})`);
  });
  for (const line of found) faults.push(`axe, ${what}: ${line}`);
};
/** Texts of the page that are smaller than 12 pixels. */
const small = (page) =>
  page.evaluate(() => {
    const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    const found = new Set();
    for (let node = walker.nextNode(); node; node = walker.nextNode()) {
      const parent = node.parentElement;
      // The drawing has its own scale.
      if (!node.nodeValue.trim() || !parent.checkVisibility() || parent.closest(".drawing-box, script, style")) continue;
      if (parseFloat(getComputedStyle(parent).fontSize) < 12) found.add(`${parent.tagName}.${parent.className}`);
    }
    return [...found];
  });

const textOf = (page) => page.evaluate(() => document.querySelector(".cm-content").cmTile?.view?.state.doc.toString() ?? document.querySelector(".cm-content").cmView?.view?.state.doc.toString());
/** The cursor at a line and column of the shown file. Lines are wrapped, so arrow keys do not count them. */
async function cursor(page, line, column) {
  await page.focus(".cm-content");
  await page.evaluate((line, column) => {
    const content = document.querySelector(".cm-content");
    const view = content.cmTile?.view ?? content.cmView?.view;
    view.dispatch({ selection: { anchor: view.state.doc.line(line + 1).from + column }, scrollIntoView: true });
  }, line, column);
}
const press = async (page, key, ...held) => {
  for (const own of held) await page.keyboard.down(own);
  await page.keyboard.press(key);
  for (const own of held.reverse()) await page.keyboard.up(own);
};
const openFile = async (page, file) => {
  await page.select("#open-other", file);
  await until(page, `${file} is open`, (name) => document.querySelector(".file.current")?.dataset.file === name, file);
};
const value = (page, name) => page.evaluate((own) => JSON.parse(document.querySelector(`[data-number=${own}]`).dataset.value), name);
const solved = (page) => page.evaluate(() => Number(document.getElementById("point-pane").dataset.solved));
const quiet = async (page) => {
  // Nothing was solved for a while.
  for (let last = -1, now = await solved(page), k = 0; last !== now && k < 40; k++) {
    last = now;
    await pause(350);
    now = await solved(page);
  }
};
/** What the command line answers for the point of the page. */
async function solve(page) {
  const point = await page.evaluate(() => ({
    gear: document.querySelector("[data-name=gear]").value,
    models: document.querySelector("[data-name=models]").value,
    inputs: [...document.querySelectorAll("#controls .slider")].map((s) => [s.dataset.quantity, s.dataset.port, s.querySelector(".slider-number").value]),
  }));
  const file = await page.evaluate(() => document.getElementById("gearbox-title").title);
  const args = point.inputs.filter(([q]) => q !== "oil").flatMap(([quantity, port, v]) => [`--${quantity}`, `${port}=${v} ${quantity === "torque" ? "Nm" : "rpm"}`]);
  return JSON.parse(execFileSync(process.env.SOLVER ?? program, ["solve", join(folder, file), "--gear", point.gear, ...(point.models ? ["--models", point.models] : []), ...args, "--format", "json"], { encoding: "utf8", stdio: ["ignore", "pipe", "ignore"], maxBuffer: 1 << 26 }));
}
async function same(page, what) {
  await quiet(page);
  const line = await solve(page);
  const [loss, efficiency] = [await value(page, "loss"), await value(page, "efficiency")];
  check(loss === line.loss_w, `${what}: loss ${loss} W in the page, ${line.loss_w} W by solve`);
  check(efficiency === line.efficiency, `${what}: efficiency ${efficiency} in the page, ${line.efficiency} by solve`);
  return line;
}
const median = (list) => [...list].sort((a, b) => a - b)[Math.floor(list.length / 2)];

// First screen with the planetary example.
const page = await open();
const begun = Date.now();
await ready(page);
figures.first_numbers_ms = Date.now() - begun;
check(!(await page.evaluate(() => location.href)).includes("#"), "the token stays in the address");
await quiet(page);
check(await page.evaluate(() => document.scrollingElement.scrollHeight <= innerHeight && document.scrollingElement.scrollWidth <= innerWidth), "the page scrolls at 1440 x 900");
await step("First screen with the planetary example", async () => {
  const monitor = await page.evaluate(() => {
    const host = document.getElementById("convergence");
    const shown = (selector) => [...host.querySelectorAll(`${selector} [data-line]`)].map((e) => e.dataset.line);
    return { of: host.dataset.of, steps: Number(host.dataset.steps), lines: shown(".steps"), balance: shown(".balance"), outcome: host.querySelector(".outcome")?.textContent };
  });
  check(monitor.of === "balance" && monitor.steps > 3, `convergence monitor: ${JSON.stringify(monitor)}`);
  check(monitor.lines.includes("scan") && monitor.lines.includes("search"), `the scan is not distinguished: ${monitor.lines}`);
  check(monitor.balance.length >= 2, "the balance is not drawn");
  check(/converged/.test(monitor.outcome ?? ""), `outcome: ${monitor.outcome}`);
  figures.steps = monitor.steps;
  await same(page, "planetary reducer");
});
await image(page, "planetary");

// The losses have the colours of their mechanisms; the tables of the point are tables that can be sorted and copied.
await step("Losses and tables of the point", async () => {
  const colours = await page.$$eval(".losses tr[data-path]", (rows) => rows.map((row) => [row.dataset.path.split(".")[0], row.querySelector(".bar-own i") && getComputedStyle(row.querySelector(".bar-own")).getPropertyValue("--own")]).filter(([, colour]) => colour));
  const of = (section) => [...new Set(colours.filter(([own]) => own === section).map(([, colour]) => colour))];
  check(of("bearings").join() === "#e69f00" && of("seals").join() === "#b83280", `colours of the losses: ${JSON.stringify(colours)}`);
  await page.click("#losses-tabs [role=tab]:nth-child(3)");
  await until(page, "tables of the point", () => document.querySelectorAll(".panel-text table").length >= 3);
  const heads = await page.$$eval(".panel-text table", (tables) => tables.map((t) => t.tHead.rows[0].cells[0].textContent));
  check(["port", "bearing", "component"].every((head) => heads.includes(head)), `tables of the point: ${heads}`);
  const sorted = await page.evaluate(() => {
    const table = [...document.querySelectorAll(".panel-text table")].find((t) => t.tHead.rows[0].cells[0].textContent === "component");
    const head = [...table.tHead.rows[0].cells].findIndex((cell) => cell.textContent === "loss W");
    table.tHead.rows[0].cells[head].querySelector("button").click();
    const losses = [...table.tBodies[0].rows].map((row) => parseFloat(row.cells[head].textContent)).filter((v) => !Number.isNaN(v));
    return losses.length > 3 && losses.every((v, k) => k === 0 || losses[k - 1] >= v);
  });
  check(sorted, "the tables of the point cannot be sorted");
  await image(page, "tables");
  await page.click("#losses-tabs [role=tab]:nth-child(1)");
});

// A click on a bearing selects its line and explains it; so do the keys.
await step("A click on a bearing selects its line and explains it; so do the keys", async () => {
  const hit = await page.evaluate(() => {
    const box = document.querySelector('[data-part="bearings.I2"] rect').getBoundingClientRect();
    return [box.x + box.width / 2, box.y + box.height / 4];
  });
  await page.mouse.click(...hit);
  await until(page, "the line of the bearing", () => /^\s*I2:/.test(document.querySelector(".cm-activeLine")?.textContent ?? ""));
  await until(page, "explanation of the bearing", () => document.getElementById("explain-text").textContent.includes("bearings.I2"));
  await serious(page, "explanation");
  await image(page, "explain");
  await page.evaluate(() => document.querySelector('[data-part="bearings.I2"]').focus());
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("Enter");
  await until(page, "a part chosen by keys", () => document.querySelector("[data-part].chosen")?.dataset.part !== "bearings.I2");
  check(await page.evaluate(() => document.activeElement?.closest(".drawing-box") !== null), "the focus leaves the drawing");
  await page.click("#explain-close");
});

// A study: one analysis, then its report.
await step("A study", async () => {
  await page.click("[data-tab=study]");
  await until(page, "analyses", () => document.querySelectorAll(".analyses li").length > 2);
  await page.click(".analyses li:last-child button");
  await until(page, "section of one analysis", () => document.querySelector(".study-results .section svg") && document.querySelector(".study-side .primary:not(:disabled)"));
  await page.evaluate(() => {
    const bar = document.querySelector(".study-side progress");
    window.progressed = false;
    new MutationObserver(() => (window.progressed ||= !bar.hidden)).observe(bar, { attributes: true });
  });
  await page.click(".study-side .primary");
  await until(page, "report", () => document.querySelector("[data-report]"));
  await until(page, "end of the run", () => /Finished/.test(document.querySelector(".study-side [role=status]").textContent));
  check(await page.evaluate(() => window.progressed), "no progress is shown");
  figures.sections = await page.evaluate(() => document.querySelectorAll(".study-results .section").length);
  await serious(page, "study");
  await image(page, "study");
  const target = browser.waitForTarget((t) => t.opener() === page.target(), { timeout: 10000 });
  await page.click("[data-report]");
  const report = await (await target).page();
  await until(report, "the report opens", () => document.querySelector("h1, h2") !== null && document.querySelector("svg") !== null);
  await report.close();
  // After a change of the text the results are those of before.
  const results = () => page.$eval(".results-of", (e) => e.textContent);
  check(!/changed/.test(await results()), `results without a change: ${await results()}`);
  await page.focus(".cm-content");
  await page.keyboard.sendCharacter("# other\n");
  await until(page, "results of another text", () => /changed since this run/.test(document.querySelector(".results-of").textContent));
  await press(page, "z", "Control");
  await until(page, "results of this text", () => !/changed/.test(document.querySelector(".results-of").textContent));
});

// A long run: shown under another study, cancelled, and ended with its study.
const LONG = "planetary-reducer/very-long.yaml";
const status = () => page.$eval(".study-side [role=status]", (e) => e.textContent);
await step("A long run", async () => {
  // Some minutes of work, so only a cancelled run ends soon.
  await replaceFile(join(folder, LONG), [
    "gearloss: study/1",
    "title: Long",
    "gearboxes: { planetary: gearbox.yaml }",
    "grids:",
    "  field: { gear: reducing, torque: { from: 1 Nm, to: 20 Nm, step: 0.02 Nm }, speed: { from: 100 rpm, to: 3000 rpm, step: 5 rpm } }",
    "analyses:",
    "  losses: { type: map, gearbox: planetary, grid: field }",
    "",
  ].join("\n"));
  await page.evaluate(() => document.getElementById("open-other").dispatchEvent(new PointerEvent("pointerdown")));
  await until(page, "the long study is listed", (file) => [...document.querySelectorAll("#open-other option")].some((o) => o.value === file), LONG);
  await openFile(page, LONG);
  await until(page, "analyses of the long study", (file) => document.querySelector(".study-side [role=status]").textContent.startsWith(`${file}: 1 `), LONG);
  check(await page.$eval(".results-of", (e) => !e.checkVisibility()), "results of one study are shown under another one");
  const run = async () => {
    await page.click(".study-side .primary");
    await until(page, "the long run is under way", () => document.querySelector(".study-side progress").checkVisibility());
    await pause(700);
  };
  await run();
  // Another study is shown meanwhile.
  await page.click('.file[data-file="planetary-reducer/study.yaml"] button');
  await until(page, "the other study", () => document.querySelectorAll(".analyses li").length > 2);
  check((await status()).startsWith(LONG), `the run has another name: ${await status()}`);
  check(await page.$eval(".study-results", (e) => /very-long.yaml is running/.test(e.innerText)), "the page does not say what runs");
  await page.click(`.file[data-file="${LONG}"] button`);
  await page.evaluate(() => [...document.querySelectorAll(".study-side button")].find((b) => b.textContent === "Cancel").click());
  await until(page, "cancelled", () => /Cancelled/.test(document.querySelector(".study-side [role=status]").textContent));
  // Closing the study ends its run.
  await run();
  await page.click(`.file[data-file="${LONG}"] .close`);
  await until(page, "the run ends with its study", () => !document.querySelector(".study-side progress").checkVisibility());
  await rm(join(folder, LONG));
  await page.click('.file[data-file="planetary-reducer/gearbox.yaml"] button');
  await page.click("[data-tab=drawing]");
});

// The two-speed transmission: errors while typing.
const gearbox = "two-speed-ev/gearbox.yaml";
const source = (await readFile(join(folder, gearbox), "utf8")).split("\n");
await openFile(page, gearbox);
await until(page, "numbers of the other gearbox", () => document.getElementById("gearbox-title").title.includes("two-speed") && document.querySelectorAll("#controls .slider").length === 2);
await quiet(page);
await until(page, "drawing of the other gearbox", () => document.querySelector('[data-part="bearings.B5"]'));
await step("The two-speed transmission", async () => {
  const [times, asked] = [[], []];
  for (const typed of ["frobs: 1\n", "# Öl ≤ 90 °C 🙂\nfrobs: 1\n", "wibble: { a: 1 }\n"]) {
    await cursor(page, 2, 0);
    await page.evaluate(() => {
      window.marked = null;
      let from = 0;
      document.querySelector(".cm-content").addEventListener("beforeinput", () => (from = performance.now()), { once: true, capture: true });
      const seen = () => {
        if (window.marked === null && document.querySelector(".cm-lintRange-error") && /help:/.test(document.querySelector(".findings")?.textContent ?? "")) window.marked = performance.now() - from;
      };
      window.watcher = new MutationObserver(seen);
      window.watcher.observe(document.querySelector(".pane-text"), { childList: true, subtree: true, attributes: true });
    });
    const names = [];
    const note = (request) => request.method() === "POST" && names.push(JSON.parse(request.postData()).request);
    page.on("request", note);
    await page.keyboard.sendCharacter(typed);
    await until(page, "an error is underlined", () => window.marked !== null);
    page.off("request", note);
    asked.push(names);
    times.push(await page.evaluate(() => (window.watcher.disconnect(), window.marked)));
    const marked = await page.evaluate(() => document.querySelector(".cm-lintRange-error").textContent);
    check(/^(frobs|wibble)/.test(marked), `the mark is at "${marked}"`);
    if (times.length === 1) {
      const box = await (await page.$(".cm-lintRange-error")).boundingBox();
      await page.mouse.move(box.x + 4, box.y + box.height / 2);
      await until(page, "tooltip with help", () => /help:/.test(document.querySelector(".cm-tooltip .finding-tip")?.textContent ?? ""));
      await image(page, "error");
      await page.mouse.move(700, 5);
      // The list leads to the place.
      await press(page, "End", "Control");
      await page.click(".findings button");
      await until(page, "the list leads to the error", () => /^frobs/.test(document.querySelector(".cm-activeLine")?.textContent ?? ""));
    }
    await page.focus(".cm-content");
    await press(page, "z", "Control");
    await until(page, "the error is gone", () => !document.querySelector(".cm-lintRange-error"));
    // The marks go with the text, before the page asks for the errors that are left.
    await quiet(page);
  }
  figures.error_ms = Math.round(Math.max(...times));
  // Work is counted, because times depend on what else the computer does: one question for errors, and a point at most, never a map.
  const light = (names) => names.filter((name) => name === "edit").length === 1 && new Set(names).size === names.length && !names.includes("map");
  for (const names of asked) check(light(names), `before an error is underlined, the page asks ${names.join(", ")}`);
});

// Completion of a designation.
await step("Completion of a designation", async () => {
  const line = source.findIndex((l) => /^\s*B5:.*designation: "/.test(l));
  const column = source[line].indexOf('designation: "') + 'designation: "'.length;
  await cursor(page, line, column);
  for (let k = 0; k < /\d+/.exec(source[line].slice(column))[0].length; k++) await page.keyboard.press("Delete");
  await page.keyboard.type("620", { delay: 30 });
  await until(page, "completion of a designation", () => [...document.querySelectorAll(".cm-tooltip-autocomplete li")].some((l) => l.textContent.startsWith("6208")));
  await image(page, "completion");
  await pause(150);
  const down = await page.$$eval(".cm-tooltip-autocomplete li", (list) => list.findIndex((l) => l.textContent.startsWith("6208")));
  for (let k = 0; k < down; k++) await page.keyboard.press("ArrowDown");
  await page.keyboard.press("Enter");
  await pause(100);
  const text = await textOf(page);
  check(text.split("\n")[line].includes('designation: "6208"'), `completed line: ${text.split("\n")[line]}`);
  await quiet(page);
  check(await page.evaluate(() => document.querySelector(".file.current .unsaved") !== null), "no mark for unsaved text");
  // Hover explains.
  const place = await page.evaluate(() => {
    const found = [...document.querySelectorAll(".cm-line")].find((l) => /^\s*B5:/.test(l.textContent));
    const walker = document.createTreeWalker(found, NodeFilter.SHOW_TEXT);
    for (let node = walker.nextNode(); node; node = walker.nextNode()) {
      const k = node.nodeValue.indexOf("designation");
      if (k < 0) continue;
      const range = document.createRange();
      range.setStart(node, k + 2);
      range.setEnd(node, k + 3);
      const box = range.getBoundingClientRect();
      return [box.x + 2, box.y + box.height / 2];
    }
    return [0, 0];
  });
  await page.mouse.move(...place);
  await until(page, "hover", () => document.querySelector(".cm-tooltip .hover-text")?.textContent.length > 10);
  await page.mouse.move(700, 5);
  await page.focus(".cm-content");
  for (let k = 0; k < 12; k++) await press(page, "z", "Control");
  await until(page, "undone", () => !document.querySelector(".file.current .unsaved"));
});

// Definition and renaming.
await step("Definition and renaming", async () => {
  const line = source.findIndex((l) => /^\s*B1:.*shaft: input/.test(l));
  await cursor(page, line, source[line].indexOf("shaft: input") + 9);
  await page.keyboard.press("F12");
  await until(page, "definition", () => /^\s*input:/.test(document.querySelector(".cm-activeLine")?.textContent ?? ""));
  await page.keyboard.press("F2");
  await until(page, "dialog of renaming", () => document.querySelector("dialog[open] input"));
  await page.keyboard.type("drive_shaft");
  await page.keyboard.press("Enter");
  await until(page, "renamed", () => /renamed/.test(document.getElementById("notices").textContent));
  check((await textOf(page)).includes("shaft: drive_shaft"), "the id is not renamed everywhere");
  await quiet(page);
  await page.focus(".cm-content");
  await press(page, "z", "Control");
  await until(page, "renaming undone", () => !document.querySelector(".file.current .unsaved"));
});

// Dragged torque: numbers of the command line, and how fast.
await step("Dragged torque", async () => {
  await quiet(page);
  const slider = await page.$(".slider[data-quantity=torque] input[type=range]");
  const box = await slider.boundingBox();
  await page.evaluate(() => {
    window.latencies = [];
    window.watcher = new MutationObserver(() => window.latencies.push(Number(document.getElementById("point-pane").dataset.latency)));
    window.watcher.observe(document.getElementById("point-pane"), { attributes: true, attributeFilter: ["data-solved"] });
  });
  const y = box.y + box.height / 2;
  await page.mouse.move(box.x + box.width / 2, y);
  await page.mouse.down();
  for (let k = 0; k <= 40; k++) {
    await page.mouse.move(box.x + box.width * (0.5 + 0.35 * Math.sin(k / 6)), y);
    await pause(16);
  }
  await page.mouse.up();
  await quiet(page);
  const latencies = await page.evaluate(() => (window.watcher.disconnect(), window.latencies));
  figures.drag_solves = latencies.length;
  figures.drag_median_ms = Math.round(median(latencies));
  figures.drag_longest_ms = Math.round(Math.max(...latencies));
  check(latencies.length > 5, `only ${latencies.length} solves while the torque is dragged`);
  await same(page, "after dragging the torque");
  // A key stroke in the text.
  const line = source.findIndex((l) => /\bra:\s*\d/.test(l));
  const strokes = [];
  if (line >= 0) {
    await cursor(page, line, source[line].search(/(?<=\bra:\s*)\d/) + 3);
    for (const key of ["1", "Backspace", "2", "Backspace"]) {
      const before = await solved(page);
      await page.keyboard.press(key);
      await page.keyboard.press("Escape");
      await until(page, "solved after a key stroke", (n) => Number(document.getElementById("point-pane").dataset.solved) > n, before);
      strokes.push(await page.evaluate(() => Number(document.getElementById("point-pane").dataset.latency)));
      await pause(400);
    }
    figures.stroke_median_ms = Math.round(median(strokes));
  }
  await until(page, "as before", () => !document.querySelector(".file.current .unsaved"));
});

// Other gear, model set and given oil temperature.
await step("Other gear, model set and given oil temperature", async () => {
  await page.select("[data-name=gear]", "second");
  await same(page, "second gear");
  await page.select("[data-name=gear]", "neutral");
  await quiet(page);
  check(await page.evaluate(() => document.querySelectorAll(".slider[data-quantity=speed]").length === 2), "neutral has not two speeds");
  await page.select("[data-name=gear]", "first");
  await quiet(page);
  const before = await value(page, "loss");
  // After a change of the text the fields still write what is solved.
  await cursor(page, 0, 0);
  await page.keyboard.sendCharacter("# \n");
  await quiet(page);
  await page.select("[data-name=models]", "joint");
  await same(page, "another model set");
  check((await value(page, "loss")) !== before, "another model set changes nothing");
  await page.select("[data-name=models]", "");
  await quiet(page);
  await page.focus(".cm-content");
  await press(page, "z", "Control");
  await page.select("[data-name=oil]", "given");
  await page.focus(".slider[data-quantity=oil] .slider-number");
  await press(page, "a", "Control");
  await page.keyboard.type("40");
  await quiet(page);
  check((await value(page, "oil")) === 40 && (await value(page, "loss")) !== before, "a given oil temperature changes nothing");
  check(/searched/.test(await page.$eval("#convergence", (e) => e.textContent)), "the monitor does not say that nothing is searched");
  await page.select("[data-name=oil]", "file");
  await quiet(page);
  // Another volume of oil has another level; the cross-section shows it.
  const section = () => page.$eval(".drawing-oil", (e) => e.textContent);
  const [lossBefore, drawnBefore] = [await value(page, "loss"), await section()];
  check(/oil at rest -49\.0 mm, 0\.83 l/.test(drawnBefore), `the oil is drawn as ${drawnBefore}`);
  await page.select("[data-name=fill]", "given");
  await page.focus(".slider[data-quantity=fill] .slider-number");
  await press(page, "a", "Control");
  await page.keyboard.type("1.6");
  await quiet(page);
  check((await value(page, "loss")) !== lossBefore, "another volume of oil changes nothing");
  check(/1\.70 l/.test(await section()) && (await section()) !== drawnBefore, `the oil of 1.6 l is drawn as ${await section()}`);
  if (capture) await page.screenshot({ path: join(capture, "fill.png") });
  await page.select("[data-name=fill]", "file");
  await quiet(page);
  check((await value(page, "loss")) === lossBefore, "the volume of the file does not come back");
});

// Numbers as they are typed, and the ranges of the sliders.
await step("Typed numbers and ranges", async () => {
  const torque = ".slider[data-quantity=torque]";
  const type = async (selector, text, key) => {
    await page.focus(selector);
    await press(page, "a", "Control");
    await page.keyboard.type(text);
    if (key) await page.keyboard.press(key);
  };
  const shown = () => page.$eval(torque, (e) => ({ value: e.querySelector(".slider-number").value, ends: [...e.querySelectorAll(".slider-end")].map((i) => i.value), fault: e.querySelector(".slider-fault").textContent, invalid: e.querySelectorAll("[aria-invalid=true]").length }));
  const before = await shown();
  await type(`${torque} .slider-number`, "2.5", "Enter");
  await same(page, "a typed torque");
  const count = await solved(page);
  const loss = await value(page, "loss");
  await type(`${torque} .slider-number`, "2,");
  await pause(300);
  const partly = await solved(page);
  await page.keyboard.type("5");
  await until(page, "the comma is a fault", () => document.documentElement.dataset.stale === "" && /write 2\.5/.test(document.querySelector(".slider[data-quantity=torque] .slider-fault").textContent) && /write 2\.5/.test(document.getElementById("point-message").textContent));
  await pause(400);
  check((await solved(page)) === partly, "a number with a comma is solved");
  check((await shown()).invalid === 1, "the field is not marked");
  await image(page, "comma");
  await serious(page, "comma");
  await page.keyboard.press("Escape");
  await until(page, "the number before", () => document.documentElement.dataset.stale === undefined && document.querySelector(".slider[data-quantity=torque] .slider-number").value !== "2,5");
  await type(`${torque} .slider-number`, "0.25e1", "Enter");
  await quiet(page);
  check((await value(page, "loss")) === loss && (await solved(page)) > count, "2.5 and 0.25e1 differ");
  // A value beyond the range widens it while it holds.
  const beyond = String(2 * Number(before.ends[1]));
  await type(`${torque} .slider-number`, beyond, "Enter");
  check((await shown()).ends[1] === beyond, `the range is not widened: ${(await shown()).ends}`);
  await type(`${torque} .slider-number`, before.value, "Enter");
  check((await shown()).ends.join() === before.ends.join(), `the range stays widened: ${(await shown()).ends}`);
  // The start must be below the end.
  await type(`${torque} .slider-end:first-child`, beyond, "Enter");
  check(/must be below its end/.test((await shown()).fault), `a start above the end: ${JSON.stringify(await shown())}`);
  await page.keyboard.press("Escape");
  check((await shown()).ends.join() === before.ends.join() && (await shown()).fault === "", "the range is not the one before");
  await type(`${torque} .slider-end:last-child`, beyond, "Enter");
  await until(page, "the ranges can be reset", () => document.querySelector(".reset-ranges").checkVisibility());
  await page.click(".reset-ranges");
  check((await shown()).ends.join() === before.ends.join() && (await shown()).value === before.value, "the ranges are not reset");
  check(!(await page.$eval(".reset-ranges", (e) => e.checkVisibility())), "a reset of nothing is offered");
  await quiet(page);
});

// Pin, change, difference; the map.
await step("Pin, change, difference; the map", async () => {
  await page.click("[data-tab=map]");
  await until(page, "map", () => document.querySelector(".map-body[data-drawn=map] svg .gl-field, .map-body[data-drawn=map] svg path"));
  await until(page, "the point on the map", () => document.querySelector(".map-body .gl-here")?.getAttribute("visibility") === "visible");
  const before = await page.evaluate(() => [...document.querySelectorAll(".slider-number")].map((i) => i.value).join());
  const box = await (await page.$(".map-body .gl-panels svg")).boundingBox();
  await page.mouse.click(box.x + 0.7 * box.width, box.y + 0.4 * box.height);
  await until(page, "a click on the map moves the point", (old) => [...document.querySelectorAll(".slider-number")].map((i) => i.value).join() !== old, before);
  await page.mouse.move(700, 5);
  await same(page, "after a click on the map");
  await image(page, "map");
  // The map follows the text: it keeps its tab, and the focus stays in the text.
  await page.click(".map-body [role=tab]:nth-child(2)");
  await cursor(page, 0, 0);
  const surface = source.findIndex((l) => /\bra:\s*\d/.test(l));
  await cursor(page, surface, source[surface].search(/(?<=\bra:\s*)\d/) + 3);
  const status = await page.$eval(".panel-map .status", (e) => e.textContent);
  await page.evaluate(() => (window.drawnMap = document.querySelector(".map-body > .gl")));
  await page.keyboard.type("1");
  await page.keyboard.press("Escape");
  await until(page, "the map follows the text", () => document.querySelector(".map-body > .gl") !== window.drawnMap);
  check(await page.evaluate(() => document.activeElement?.classList.contains("cm-content")), `the map takes the focus (${status})`);
  check(await page.$eval(".map-body [role=tab]:nth-child(2)", (e) => e.getAttribute("aria-selected") === "true"), "the map forgets its tab");
  await page.keyboard.press("Backspace");
  await page.keyboard.press("Escape");
  await page.click(".map-body [role=tab]:nth-child(1)");
  await quiet(page);
  await page.click("#pin");
  const pinned = [await value(page, "loss"), await value(page, "efficiency")];
  await openFile(page, gearbox).catch(() => undefined);
  const line = source.findIndex((l) => /^\s*B3:.*designation: "6305"/.test(l));
  await cursor(page, line, source[line].indexOf('"6305"') + 1);
  for (let k = 0; k < 4; k++) await page.keyboard.press("Delete");
  await page.keyboard.type("6205");
  await page.keyboard.press("Escape");
  await quiet(page);
  const [loss, efficiency] = [await value(page, "loss"), await value(page, "efficiency")];
  check(loss !== pinned[0], "another bearing has the same loss");
  const deltas = await page.$$eval(".tile-now .delta", (list) => list.map((e) => e.textContent));
  const number = (text) => Number(text.replace("−", "-").replace(/[+±\u202f]/g, "").split(" ")[0]);
  check(Math.abs(number(deltas[0]) - 100 * (efficiency - pinned[1])) < 6e-4, `delta of the efficiency ${deltas[0]}, not ${100 * (efficiency - pinned[1])}`);
  check(Math.abs(number(deltas[1]) / (loss - pinned[0]) - 1) < 6e-3, `delta of the loss ${deltas[1]}, not ${loss - pinned[0]}`);
  check((await page.$$(".losses .bar-pinned i")).length > 3, "the bars do not show both states");
  await until(page, "the map follows", () => document.querySelector(".map-body")?.dataset.drawn);
  await page.click(".panel-map input[type=checkbox]");
  await until(page, "map of the difference", () => document.querySelector(".map-body[data-drawn=difference] svg"));
  await pause(300);
  await image(page, "pinned");
  await serious(page, "pinned");
  await page.click("#unpin");
  check((await page.$$(".tile-now .delta")).length === 0, "deltas after unpinning");
  await quiet(page);
  await page.focus(".cm-content");
  for (let k = 0; k < 10; k++) await press(page, "z", "Control");
  await until(page, "the text as before", () => !document.querySelector(".file.current .unsaved"));
  await page.click("[data-tab=drawing]");
});

// A new gearbox from the form.
await step("A new gearbox from the form", async () => {
  await page.click("#new");
  await until(page, "form", () => document.querySelector(".form-dialog[open] .field") && !document.getElementById("form-create").disabled);
  const fill = async (label, text) => {
    const path = await page.evaluate((own) => [...document.querySelectorAll(".field")].find((f) => f.querySelector("label").textContent.startsWith(own))?.dataset.path ?? null, label);
    if (!check(path !== null, `the form has no field ${label}`)) return null;
    const selector = `.field[data-path="${path}"] input`;
    await page.focus(selector);
    await press(page, "a", "Control");
    await page.keyboard.type(text, { delay: 15 });
    return selector;
  };
  const teeth = await fill("Teeth of wheel", "many");
  await until(page, "fault at the field", () => [...document.querySelectorAll(".field-error")].some((e) => e.textContent));
  check(await page.$eval(teeth, (e) => e.getAttribute("aria-invalid") === "true"), "the fault is not at its field");
  await image(page, "form-fault");
  await fill("Teeth of wheel", "77");
  await fill("Material of wheel", "PO");
  await until(page, "materials of the catalogue", () => [...document.querySelectorAll(".hits:not([hidden]) li b")].some((b) => b.textContent === "POM"));
  await fill("Material of wheel", "");
  await page.keyboard.press("Backspace");
  const bearing = await fill("Bearing P1", "630");
  await until(page, "bearings of the catalogue", () => [...document.querySelectorAll(".hits:not([hidden]) li b")].some((b) => b.textContent === "6307"));
  await image(page, "form");
  // The list covers no other field.
  const covered = await page.evaluate(() => {
    const boxes = [...document.querySelectorAll(".field input")].filter((input) => input.getBoundingClientRect().bottom < document.querySelector(".fields").getBoundingClientRect().bottom && input.getBoundingClientRect().top > document.querySelector(".fields").getBoundingClientRect().top);
    return boxes.filter((input) => {
      const box = input.getBoundingClientRect();
      return document.elementFromPoint(box.x + box.width / 2, box.y + box.height / 2) !== input;
    }).length;
  });
  check(covered === 0, `the list of bearings covers ${covered} fields`);
  const down = await page.$$eval(".hits:not([hidden]) li b", (list) => list.findIndex((b) => b.textContent === "6307"));
  for (let k = 0; k <= down; k++) await page.keyboard.press("ArrowDown");
  await page.keyboard.press("Enter");
  check((await page.$eval(bearing, (e) => e.value)) === "6307", "the hit is not taken");
  await pause(300);
  check((await page.$$(".hits:not([hidden])")).length === 0, "the list stays open after a hit");
  await page.evaluate(() => document.activeElement.blur());
  await page.focus(bearing);
  await pause(300);
  check((await page.$$(".hits:not([hidden])")).length === 0, "the list opens by the focus alone");
  // Escape asks, and another layout keeps what it has fields for.
  await page.keyboard.press("Escape");
  await until(page, "the form asks before it is left", () => document.querySelector("dialog[role=alertdialog][open]"));
  await page.keyboard.press("Escape");
  await until(page, "the form goes on", () => !document.querySelector("dialog[role=alertdialog]") && document.querySelector(".form-dialog[open]"));
  const layouts = await page.$$eval("#layout option", (list) => list.map((o) => o.value));
  const own = await page.$eval("#layout", (e) => e.value);
  await page.select("#layout", layouts.find((l) => l !== own));
  await page.select("#layout", own);
  check((await page.$eval(bearing, (e) => e.value)) === "6307" && (await page.$eval(teeth, (e) => e.value)) === "77", "another layout loses what was typed");
  const oil = await page.evaluate(() => [...document.querySelectorAll(".field label")].find((l) => /^Oil$/.test(l.textContent))?.parentElement.dataset.path ?? null);
  check(oil !== null, "the form has no oil");
  await until(page, "the form is right", () => !document.getElementById("form-create").disabled);
  await serious(page, "form");
  for (const [name, why] of [["two-speed-ev/gearbox", "exists already"], ["Two-Speed-EV/Gearbox", "no files in"], ["two-speed-ev/GEARBOX.yaml", "exists already"], ["../out.yaml", "no files in"], ["A:B", "signs"], [".hidden.yaml", "dot"], ["sub/none/new.yaml", "no files in"]]) {
    await page.$eval("#form-file", (e, own) => (e.value = own), name);
    await page.click("#form-create");
    const said = await page.$eval("#form-file-error", (e) => e.textContent);
    check(said.includes(why) && (await page.$(".form-dialog[open]")), `the name ${name}: "${said}"`);
  }
  await serious(page, "form with a wrong name");
  await page.$eval("#form-file", (e) => (e.value = "drawn-from-data-sheet"));
  await page.click("#form-create");
  await until(page, "the new gearbox is open", () => document.querySelector(".file.current")?.dataset.file === "drawn-from-data-sheet.yaml");
  await until(page, "the new gearbox is solved", () => document.getElementById("gearbox-title").title === "drawn-from-data-sheet.yaml" && document.querySelector("[data-number=loss]")?.dataset.value && document.documentElement.dataset.stale === undefined);
  check(await page.evaluate(() => document.activeElement?.classList.contains("cm-content")), "the focus is not in the new text");
  const text = await textOf(page);
  check(text.includes("z: 77") && text.includes('"6307"'), "the text lacks what was filled in");
  await until(page, "the new gearbox is drawn", () => document.querySelector('[data-part="bearings.P1"]'));
  await image(page, "new");
  await press(page, "s", "Control");
  await until(page, "saved", () => !document.querySelector(".file.current .unsaved"));
  check((await readFile(join(folder, "drawn-from-data-sheet.yaml"), "utf8")) === text, "the saved file has another text");
  await same(page, "the new gearbox");
  await page.click("[data-tab=study]");
  await page.evaluate(() => [...document.querySelectorAll(".study-side button")].find((b) => b.textContent === "New study").click());
  await until(page, "a new study", () => document.querySelector(".file.current")?.dataset.file === "study.yaml" && /^study.yaml: \d+ analyses/.test(document.querySelector(".study-side [role=status]").textContent));
  await page.click(".analyses li:first-child button");
  await until(page, "result of the new study", () => document.querySelector(".study-results .section svg") && document.querySelector(".study-side .primary:not(:disabled)"));
  await image(page, "new-study");
  check((await page.$$(".findings .error")).length === 0, "the new study has errors");
  // The new study gets another name, which is then its own.
  await page.click("#save-as");
  await until(page, "dialog of the name", () => document.querySelector(".small-dialog[open] input"));
  await press(page, "a", "Control");
  await page.keyboard.type("no/such/folder");
  await page.keyboard.press("Enter");
  await until(page, "a name that cannot be", () => /no files in/.test(document.querySelector(".small-dialog[open] .dialog-fault").textContent));
  await press(page, "a", "Control");
  await page.keyboard.type("loss study");
  await page.keyboard.press("Enter");
  await until(page, "saved under another name", () => document.querySelector(".file.current")?.dataset.file === "loss study.yaml" && !document.querySelector(".file.current .unsaved"));
  check((await readFile(join(folder, "loss study.yaml"), "utf8")) === (await textOf(page)), "the file with the other name has another text");
  check(await page.$eval(".results-of", (e) => e.textContent === "Results of loss study.yaml"), "the results have the name of before");
  await page.click('.file[data-file="drawn-from-data-sheet.yaml"] button');
  await page.click("[data-tab=map]");
  await until(page, "map of the new gearbox", () => document.querySelector(".map-body[data-drawn] svg"));
  await page.click("[data-tab=drawing]");
});

// Two tabs do not see each other's text.
await step("Two tabs do not see each other's text", async () => {
  const other = await open();
  await ready(other);
  await openFile(other, gearbox);
  await quiet(other);
  const before = await value(other, "loss");
  await page.bringToFront();
  await page.click(`.file[data-file="${gearbox}"] button`);
  await cursor(page, 0, 0);
  await page.keyboard.sendCharacter("# of the first tab\n");
  await quiet(page);
  check(!(await textOf(other)).includes("of the first tab"), "the other tab sees the text");
  check((await value(other, "loss")) === before, "the other tab has other numbers");
  check(!(await other.evaluate(() => document.querySelector(".file.current .unsaved") !== null)), "the other tab has unsaved text");

  // Saved in one tab, the file is replaced in the other one.
  await press(page, "s", "Control");
  await until(page, "saved", () => !document.querySelector(".file.current .unsaved"));
  await other.bringToFront();
  await until(other, "the saved text comes to the other tab", () => document.querySelector(".cm-content").textContent.includes("of the first tab"));
  await other.close();
  await page.bringToFront();
});

// The disk: silently, then merged.
await step("The disk", async () => {
  const file = join(folder, gearbox);
  await replaceFile(file, source.join("\n"));
  await until(page, "a change on the disk is taken", () => !document.querySelector(".cm-content").textContent.includes("of the first tab"));
  await page.focus(".cm-content");
  await press(page, "z", "Control");
  await until(page, "the change can be undone", () => document.querySelector(".cm-content").textContent.includes("of the first tab"));
  await press(page, "y", "Control");
  await until(page, "the change is done again", () => !document.querySelector(".file.current .unsaved"));
  await cursor(page, 0, 0);
  await page.keyboard.sendCharacter("# mine\n");
  await pause(100);
  await replaceFile(file, [...source, "# theirs", ""].join("\n"));
  await until(page, "the page asks", () => [...document.querySelectorAll(".notice button")].some((b) => b.textContent === "Merge both"));
  await page.evaluate(() => [...document.querySelectorAll(".notice button")].find((b) => b.textContent === "Show both").click());
  await until(page, "both texts", () => document.querySelector("dialog[open] .difference .added"));
  await serious(page, "difference");
  await image(page, "difference");
  await page.evaluate(() => [...document.querySelectorAll("dialog[open] button")].find((b) => b.textContent === "Merge both").click());
  await pause(200);
  const text = await textOf(page);
  check(text.startsWith("# mine\n") && text.includes("# theirs"), "the texts are not merged");
  await press(page, "s", "Control");
  await until(page, "saved after the merge", () => !document.querySelector(".file.current .unsaved"));
  check((await readFile(file, "utf8")).includes("# theirs"), "the change of the disk is lost");

  // Both sides change one line: the page offers no merge. Lines of the disk may end with CR LF.
  const choose = (label) => page.evaluate((own) => [...document.querySelectorAll(".notice button")].find((b) => b.textContent === own)?.click(), label);
  const asked = () => until(page, "the page asks again", () => [...document.querySelectorAll(".notice button")].some((b) => b.textContent === "Keep mine"));
  const first = (line, end = "\n") => [line, ...source.slice(1)].join(end);
  await replaceFile(file, first("# base", "\r\n"));
  await until(page, "lines with CR LF", () => document.querySelector(".cm-content").textContent.startsWith("# base") && !document.querySelector(".file.current .unsaved"));
  await cursor(page, 0, 2);
  await page.keyboard.type("my ");
  await pause(150);
  await replaceFile(file, first("# their base", "\r\n"));
  await asked();
  check(!(await page.evaluate(() => [...document.querySelectorAll(".notice button")].some((b) => b.textContent === "Merge both"))), "a merge of one line is offered");
  await choose("Keep mine");
  await press(page, "s", "Control");
  await until(page, "saved mine", () => !document.querySelector(".file.current .unsaved"));
  check((await readFile(file, "utf8")) === first("# my base", "\r\n"), "what was kept is not what is saved");
  await cursor(page, 0, 2);
  await page.keyboard.type("own ");
  await pause(150);
  await replaceFile(file, first("# of the disk"));
  await asked();
  await choose("Take the disk's");
  await until(page, "the text of the disk", () => document.querySelector(".cm-content").textContent.startsWith("# of the disk") && !document.querySelector(".file.current .unsaved"));
  // Saved before the page has noticed the change of the disk: nothing is overwritten.
  await cursor(page, 0, 2);
  await page.keyboard.type("quick ");
  await replaceFile(file, first("# slow"));
  await press(page, "s", "Control");
  await asked();
  check((await readFile(file, "utf8")) === first("# slow"), "a file that has changed is overwritten");
  await choose("Take the disk's");
  await until(page, "the text of the disk again", () => document.querySelector(".cm-content").textContent.startsWith("# slow"));

  // Removed, and back with other lines: both sides can be merged.
  await cursor(page, 0, 0);
  await page.keyboard.sendCharacter("# mine after all\n");
  await rm(file);
  await until(page, "the page says that the file was removed", () => /was removed from the disk/.test(document.getElementById("notices").textContent));
  await replaceFile(file, [...first("# slow").split("\n"), "# back", ""].join("\n"));
  await until(page, "a merge with the file that came back", () => [...document.querySelectorAll(".notice button")].some((b) => b.textContent === "Merge both"));
  await choose("Merge both");
  await pause(100);
  const back = await textOf(page);
  check(back.startsWith("# mine after all\n# slow") && back.includes("# back"), "the file that came back is not merged");
  await press(page, "s", "Control");
  await until(page, "saved after it came back", () => !document.querySelector(".file.current .unsaved"));
  await replaceFile(file, first("# slow"));
  await until(page, "as before it was removed", () => document.querySelector(".cm-content").textContent.startsWith("# slow") && !document.querySelector(".file.current .unsaved"));

  // Mixed line ends: each line keeps its own.
  const mixed = source.map((line, k) => line + (k === source.length - 1 ? "" : k % 3 ? "\n" : "\r\n")).join("");
  await replaceFile(file, mixed);
  await until(page, "mixed line ends", (line) => document.querySelector(".cm-line").textContent === line && !document.querySelector(".file.current .unsaved"), source[0]);
  await cursor(page, 2, 0);
  await press(page, "End");
  await page.keyboard.type(" #");
  await press(page, "s", "Control");
  await until(page, "saved mixed line ends", () => !document.querySelector(".file.current .unsaved"));
  const ends = (text) => text.match(/\r?\n/g).map((end) => end.length).join("");
  const written = await readFile(file, "utf8");
  const differ = [...ends(written)].filter((end, k) => end !== ends(mixed)[k]).length;
  check(written.split("\n").length === source.length && differ <= 1 && written !== mixed, `${differ} line ends differ`);
  await replaceFile(file, first("# slow"));
  await until(page, "the text of before", () => document.querySelector(".cm-content").textContent.startsWith("# slow") && !document.querySelector(".file.current .unsaved"));
});

// Unsaved text after a reload.
await step("Unsaved text after a reload", async () => {
  await cursor(page, 0, 0);
  await page.keyboard.sendCharacter("# kept over a reload\n");
  await pause(500);
  await page.reload({ waitUntil: "load" });
  await ready(page);
  check(await page.evaluate((file) => document.querySelector(".file.current")?.dataset.file === file, gearbox), "the files are not open again");
  await until(page, "the draft is offered", () => [...document.querySelectorAll(".notice")].some((n) => n.textContent.includes("not saved")));
  await image(page, "draft");
  await page.evaluate((file) => [...document.querySelector(`[data-notice="draft ${file}"]`).querySelectorAll("button")].find((b) => b.textContent === "Restore").click(), gearbox);
  check(((await textOf(page)) ?? "").includes("kept over a reload") || (await until(page, "the draft is restored", () => (document.querySelector(".cm-content").cmTile?.view ?? document.querySelector(".cm-content").cmView?.view).state.doc.toString().includes("kept over a reload"))), "the draft is not restored");
});

// Accessibility, colours, size of texts.
await step("Accessibility, colours, size of texts", async () => {
  await page.click("[data-tab=drawing]");
  await quiet(page);
  await serious(page, "light");
  for (const text of await small(page)) faults.push(`text below 12 px: ${text}`);
  const ground = () => page.evaluate(() => getComputedStyle(document.querySelector(".pane")).backgroundColor);
  const light = await ground();
  await page.click("#theme");
  check((await ground()) !== light, "the button does not change the colours");
  await pause(200);
  await serious(page, "dark by the button");
  await image(page, "dark");
  await page.click("#theme");
  const dark = await open(1440, 900, "dark");
  await dark.evaluate(() => {
    document.cookie = "gearloss-theme=; path=/; max-age=0";
    localStorage.removeItem("gearloss-theme");
  });
  await dark.reload({ waitUntil: "load" });
  await ready(dark);
  check((await dark.evaluate(() => getComputedStyle(document.querySelector(".pane")).backgroundColor)) !== light, "no dark colours by the system");
  await dark.click("[data-tab=map]");
  await until(dark, "map in dark colours", () => document.querySelector(".map-body[data-drawn] svg"));
  await serious(dark, "dark by the system");
  await dark.close();
  const narrow = await open(800, 900);
  await ready(narrow);
  for (const name of ["text", "point", "losses", "convergence", "results"]) {
    await narrow.click(`.narrow [data-pane=${name}]`);
    const shown = await narrow.$$eval(".pane", (list) => list.filter((e) => e.checkVisibility()).map((e) => e.className));
    check(shown.length === 1 && shown[0].includes(name), `narrow: ${name} shows ${shown}`);
    await image(narrow, `narrow-${name}`);
  }
  check(await narrow.evaluate(() => document.scrollingElement.scrollWidth <= innerWidth), "at 800 px the page is wider");
  await serious(narrow, "narrow");
  await narrow.close();
  const context = await browser.createBrowserContext();
  const bare = await context.newPage();
  await bare.goto(address.replace(/#.*/, ""), { waitUntil: "load" });
  check((await bare.evaluate(() => document.body.innerText)).includes("gearloss open"), "without a token the page does not say how to open it");
  await serious(bare, "without a token");
  await image(bare, "locked");
  await context.close();
});

// A program that is slow, and a file that is no text any more.
await step("A slow program", async () => {
  const other = await open();
  await ready(other);
  await quiet(other);
  let held = [];
  const proof = await other.evaluate(async (token) => {
    const headers = { "Content-Type": "application/json", Authorization: `Bearer ${token}` };
    return (await fetch("/api", { method: "POST", headers, body: '{"request":"hello"}' })).headers.get("Gearloss-Proof");
  }, /#t=([0-9a-f]+)/.exec(address)[1]);
  await other.setRequestInterception(true);
  other.on("request", (request) => {
    const body = request.postData() ?? "";
    if (/"request":"point"/.test(body) && held) held.push(request);
    else if (/"request":"watch"/.test(body)) {
      const file = Object.keys(JSON.parse(body).files)[0];
      void request.respond({ contentType: "application/x-ndjson", headers: { "Gearloss-Proof": proof }, body: `${JSON.stringify({ event: "unreadable", file, reason: "it is not UTF-8" })}\n` });
    } else void request.continue();
  });
  await other.focus(".slider-number");
  await other.keyboard.press("1");
  await until(other, "the page says that it waits", () => /Waiting for the program/.test(document.getElementById("notices").textContent));
  await serious(other, "waiting");
  const late = held;
  held = null;
  // Newer ones have taken the place of some.
  for (const request of late) await request.continue().catch(() => undefined);
  await until(other, "the page waits no longer", () => !/Waiting for the program/.test(document.getElementById("notices").textContent));
  await openFile(other, await other.$eval("#open-other option:not([value=''])", (o) => o.value));
  await until(other, "the page says that a file cannot be read", () => /cannot be read: it is not UTF-8/.test(document.getElementById("notices").textContent));
  await other.close();
  await page.bringToFront();
});

// From an empty folder to the map of a planetary and of a two-stage gearbox.
await step("An empty folder", async () => {
  for (const layout of ["planetary", "two-stage"]) {
    const empty = join(root, `new ${layout}`);
    await mkdir(empty);
    const own = await start(empty);
    const other = await browser.newPage();
    await other.setViewport({ width: 1366, height: 768 });
    other.on("pageerror", (fault) => faults.push(`error: ${fault.stack}`));
    await other.goto(own.address);
    await until(other, "layouts", () => document.querySelectorAll(".layouts button").length > 3);
    await serious(other, "an empty folder");
    await other.click(`[data-layout="${layout}"]`);
    await until(other, "form", () => document.querySelector(".form-dialog[open] .field") && !document.getElementById("form-create").disabled);
    // What follows from the teeth.
    const [path, distance] = layout === "planetary" ? ["gears.planets.z", "45 mm"] : ["gears.G2.z", "97.57 mm"];
    const mesh = layout === "planetary" ? "sun_planet" : "first";
    const ratio = await other.$eval(".ratios", (e) => e.textContent);
    await other.focus(`[data-path="${path}"] input`);
    await press(other, "a", "Control");
    await other.keyboard.type(layout === "planetary" ? "36" : "83");
    await until(other, "the centre distance follows", (mesh, own) => document.querySelector(`[data-path="meshes.${mesh}.centre_distance"] input`).value === own, mesh, distance);
    check((await other.$eval(".ratios", (e) => e.textContent)) !== ratio && /^Ratio/.test(ratio), `the ratio does not follow: ${ratio}`);
    await until(other, "the form is right", () => !document.getElementById("form-create").disabled);
    await image(other, `form-${layout}`);
    await other.click("#form-create");
    await until(other, "the map", () => document.querySelector(".map-body[data-drawn=map] svg path"));
    await until(other, "the file is written", () => !document.querySelector(".file.current .unsaved"));
    const text = await readFile(join(empty, "gearbox.yaml"), "utf8");
    check(text === (await textOf(other)), "the written file has another text");
    // The map is the largest pane, and its axes are on the screen.
    const seen = await other.evaluate(() => {
      const area = (e) => e.getBoundingClientRect().width * e.getBoundingClientRect().height;
      const panes = [...document.querySelectorAll(".pane")].map((pane) => [pane.className, area(pane)]).sort((a, b) => b[1] - a[1]);
      const sliders = [...document.querySelectorAll(".slider-row input[type=range]")].map((e) => e.getBoundingClientRect());
      return { largest: panes[0][0], bottom: document.querySelector(".map-body svg").getBoundingClientRect().bottom, sliders: sliders.every((r) => document.elementFromPoint(r.x + r.width / 2, r.y + r.height / 2)?.type === "range") };
    });
    check(seen.largest.includes("pane-results") && seen.bottom <= 768 && seen.sliders, `the first map: ${JSON.stringify(seen)}`);
    check(!(await other.evaluate(() => document.querySelector(".pane-convergence").checkVisibility())), "an empty convergence monitor is shown");
    check(!/`/.test(await other.evaluate(() => ["findings", "remarks", "point-message"].map((id) => document.getElementById(id).textContent).join())), "a backtick is shown");
    await image(other, `map-${layout}`);
    await other.close();
    own.child.kill();
  }
});

// More pages than a browser has connections, and a page without a gearbox.
await step("Many pages", async () => {
  const pages = [];
  for (let k = 0; k < 7; k++) pages.push(await open());
  const last = pages[pages.length - 1];
  await ready(last);
  const visible = await Promise.all(pages.map((own) => own.evaluate(() => !document.hidden)));
  // Of the hidden ones one watches, and the others wait for their turn.
  if (visible.filter(Boolean).length === 1) {
    const turns = await last.evaluate(async () => {
      const { held, pending } = await navigator.locks.query();
      return [held, pending].map((list) => list.filter((lock) => lock.name === "gearloss-hidden-watch").length);
    });
    check(turns.join() === "1,6", `hidden pages that watch and wait: ${turns}`);
  } else figures.visible_pages = visible.filter(Boolean).length;
  await last.bringToFront();
  for (const name of await last.$$eval(".file", (list) => list.map((e) => e.dataset.file))) await last.click(`.file[data-file="${name}"] .close`);
  await until(last, "no file is open", () => document.querySelectorAll(".file").length === 0);
  await pause(700);
  const left = await last.evaluate(() => ({ numbers: document.querySelectorAll("#numbers *").length, controls: document.querySelectorAll("#controls *").length, losses: document.querySelectorAll(".losses").length, drawing: document.querySelectorAll(".drawing-box svg").length, convergence: document.querySelectorAll("#convergence svg").length, title: document.getElementById("gearbox-title").textContent }));
  check(Object.values(left).every((v) => !v), `after the last gearbox: ${JSON.stringify(left)}`);
  await serious(last, "without files");
  for (const own of pages) await own.close();
  await page.bringToFront();
});

// The program ends: the text is kept.
await step("The program ends", async () => {
  await page.bringToFront();
  await page.click("#theme");
  await cursor(page, 0, 0);
  await page.keyboard.sendCharacter("# typed before the end\n");
  await pause(600);
  ended = true;
  const gone = new Promise((done) => child.on("exit", done));
  child.kill("SIGTERM");
  await Promise.race([gone, pause(5000)]);
  await until(page, "the page says that the program has ended", () => /has ended/.test(document.getElementById("notices").textContent));
  await page.focus(".cm-content");
  await page.keyboard.type("# and after it ");
  await pause(600);
  check((await textOf(page)).startsWith("# typed before the end\n# and after it "), "the text is lost");
  // What the browser keeps for the address is readable for whoever takes its port.
  const stored = await page.evaluate(() => JSON.stringify([{ ...localStorage }, { ...sessionStorage }, document.cookie]));
  check(!stored.includes("typed before the end") && !stored.includes("facewidth"), "the browser keeps a text");
  check(await page.evaluate(() => [...document.querySelectorAll(".notice button")].some((b) => b.textContent.startsWith("Download"))), "no offer to download the text");
  await image(page, "ended");

  // Another program takes the port, and answers everything as ours would; it knows the token, which the page shows to it.
  const heard = [];
  const thief = createServer((request, response) => {
    let body = "";
    request.on("data", (data) => (body += data));
    request.on("end", () => {
      heard.push(body);
      response.writeHead(200, { "Content-Type": "application/x-ndjson", "Gearloss-Proof": "0".repeat(64) });
      response.end('{"event":"alive"}\n');
    });
  });
  await new Promise((done) => thief.listen(new URL(address).port, "127.0.0.1", done));
  try {
    await until(page, "the page knows that another program answers", () => /another one answers/.test(document.getElementById("notices").textContent));
    await page.focus(".cm-content");
    await page.keyboard.type("# for nobody else ");
    await pause(1000);
    check(heard.length > 0 && heard.every((body) => body === '{"request":"hello"}'), `another program at the address gets ${JSON.stringify(heard).slice(0, 200)}`);
  } finally {
    await new Promise((done) => {
      thief.close(done);
      thief.closeAllConnections();
    });
  }

  // Started again, the program offers the text in the next page.
  const again = await start();
  const next = await open(1440, 900, "light", again.address);
  await ready(next);
  await until(next, "the text of the page before is offered", () => [...document.querySelectorAll(".notice")].some((n) => n.textContent.includes("gearbox.yaml") && n.textContent.includes("not saved")));
  await next.evaluate((file) => [...document.querySelector(`[data-notice="draft ${file}"]`).querySelectorAll("button")].find((b) => b.textContent === "Restore").click(), gearbox);
  await until(next, "the text of the page before is restored", () => document.querySelector(".cm-content").textContent.includes("typed before the end"));
  // How the user likes the page does not depend on the port.
  check(await next.evaluate(() => document.cookie.includes("gearloss-")), "the look of the page is forgotten");
  // Hidden characters of a title.
  const other = "planetary-reducer/gearbox.yaml";
  await replaceFile(join(folder, other), (await readFile(join(folder, other), "utf8")).replace(/^title:.*$/m, 'title: "\\u202Eesrever \\e[31m"'));
  await openFile(next, other);
  await until(next, "the title shows its hidden characters", () => document.getElementById("gearbox-title").textContent === "\\u{202e}esrever \\u{1b}[31m");
  await next.close({ runBeforeUnload: false });
  again.child.kill();
});

await browser.close();
if (child.exitCode === null) child.kill("SIGKILL");
await rm(root, { recursive: true, force: true });
console.log(JSON.stringify({ ...figures, faults: faults.length }));
for (const fault of new Set(faults)) console.error(fault);
// Programs that a broken step left behind would keep this one running.
process.exit(faults.length ? 1 : 0);

