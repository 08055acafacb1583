// Tests of the parts of the workbench that need no browser. They are bundled first, because node reads no TypeScript.

import assert from "node:assert/strict";
import { mkdtemp, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import { build } from "esbuild";

const folder = await mkdtemp(join(tmpdir(), "gearloss-workbench-"));
after(() => rm(folder, { recursive: true }));

async function load(name) {
  const outfile = join(folder, `${name}.mjs`);
  await build({ entryPoints: [new URL(`../../src/workbench/${name}.ts`, import.meta.url).pathname], outfile, bundle: true, format: "esm", logLevel: "error" });
  return import(outfile);
}

const { differenceOf } = await load("difference");
const { changes, merged, replacement, rows } = await load("diff");
const { plainLines, withEnds } = await load("ends");
const { entryOf } = await load("entry");
const { Files, kindOf, shortName } = await load("files");
const { refusal } = await load("findings");
const { fieldOf } = await load("form");
const { rowsOf } = await load("losses");
const { blocks, pieces } = await load("markdown");
const { fileName, freeName, nameFault, namedBy } = await load("names");
const { outputOf, signed } = await load("numbers");
const { byteOf, unitOf, unitsOf } = await load("offsets");
const { Pace, Quiet } = await load("pace");
const { stepOf } = await load("sliders");
const { fit, fitting } = await load("suggestions");
const { Patient } = await load("transport");

test("bytes and UTF-16 units agree with the encoder, with umlauts, signs of three bytes and emoji", () => {
  const text = "oil: Öl\n# ≤ 3 °C 🙂 ﬀ\nshafts: { ä: 1 }\n";
  for (let unit = 0; unit <= text.length; unit++) {
    const code = text.charCodeAt(unit);
    if (code >= 0xdc00 && code < 0xe000) continue;
    const byte = Buffer.byteLength(text.slice(0, unit));
    assert.equal(byteOf(text, unit), byte, `unit ${unit}`);
    assert.equal(unitOf(text, byte), unit, `byte ${byte}`);
  }
  const inside = Buffer.byteLength(text.slice(0, text.indexOf("🙂"))) + 2;
  assert.equal(unitOf(text, inside), text.indexOf("🙂"));
  assert.equal(unitOf(text, 10_000), text.length);
  const bytes = [20, 3, 0, 11, 10_000, 7];
  assert.deepEqual(unitsOf(text, bytes), bytes.map((b) => unitOf(text, b)));
});

test("changes lead from one text to the other", () => {
  const apply = (a, b) => {
    const out = [];
    let at = 0;
    for (const c of changes(a, b)) {
      out.push(...a.slice(at, c.a[0]), ...b.slice(...c.b));
      at = c.a[1];
    }
    return [...out, ...a.slice(at)];
  };
  let seed = 7;
  const random = (n) => (seed = (seed * 1103515245 + 12345) % 2147483648) % n;
  for (let round = 0; round < 3000; round++) {
    const list = () => Array.from({ length: random(12) }, () => "abcd"[random(4)]);
    const [a, b] = [list(), list()];
    assert.deepEqual(apply(a, b), b, `${a} to ${b}`);
  }
  assert.deepEqual(changes(["a", "b", "c"], ["a", "x", "c"]), [{ a: [1, 2], b: [1, 2] }]);
  assert.deepEqual(changes(["a"], ["a"]), []);
});

test("changes of both sides are merged if they do not touch", () => {
  const base = "a\nb\nc\nd\ne\n";
  assert.equal(merged(base, "A\nb\nc\nd\ne\n", "a\nb\nc\nd\nE\nf\n"), "A\nb\nc\nd\nE\nf\n");
  assert.equal(merged(base, "a\nc\nd\ne\n", "a\nb\nc\nd\nx\ne\n"), "a\nc\nd\nx\ne\n");
  assert.equal(merged(base, base, "x\n"), "x\n");
  assert.equal(merged(base, "x\n", base), "x\n");
  assert.equal(merged(base, "a\nB\nc\nd\ne\n", "a\nB\nc\nd\ne\n"), "a\nB\nc\nd\ne\n", "the same change");
  assert.equal(merged(base, "a\nB\nc\nd\ne\n", "a\n2\nc\nd\ne\n"), null, "the same line");
  assert.equal(merged(base, "a\nB\nc\nd\ne\n", "a\nb\nC\nd\ne\n"), null, "adjacent lines");
});

test("the smallest replacement leads to the other text", () => {
  for (const [a, b] of [["", "x"], ["abc", "abc"], ["aaa", "aa"], ["abcd", "abXcd"], ["x", ""], ["abab", "ab"]]) {
    const { from, to, insert } = replacement(a, b);
    assert.equal(a.slice(0, from) + insert + a.slice(to), b);
  }
  assert.deepEqual(rows("a\nb", "a\nc").map((r) => r.kind), ["same", "removed", "added"]);
});

test("explanations are Markdown without HTML", () => {
  const found = blocks("**oil** temperature `theta`\n\n- one\n- two `x`\n\n```yaml\na: <b>1</b>\n```\n# Head\n| a | b |\n|---|---|\n| 1 | 2 |");
  assert.deepEqual(found.map((b) => b.kind), ["paragraph", "list", "code", "heading", "table"]);
  assert.equal(found[2].text, "a: <b>1</b>");
  assert.equal(found[1].items.length, 2);
  assert.equal(found[4].rows.length, 2);
  assert.deepEqual(pieces("a `b*c*` **d** *e* 2*3*4 [f](http://g) <i>h</i>"), [
    { text: "a " }, { text: "b*c*", style: "code" }, { text: " " }, { text: "d", style: "bold" }, { text: " " }, { text: "e", style: "emphasis" }, { text: " 2*3*4 " }, { text: "f" }, { text: " <i>h</i>" },
  ]);
  assert.deepEqual(blocks("a\n\n---\n\na\n\n---\n\nb\n\n***\n").map((b) => b.kind), ["paragraph", "rule", "paragraph"], "rules, and what is said twice");
  assert.deepEqual(blocks("- --- x").map((b) => b.kind), ["list"]);
  assert.deepEqual(pieces("mean_mu_mz \\*"), [{ text: "mean_mu_mz " }, { text: "*" }]);
});

/** A clock whose time is set by hand. */
function clock() {
  let time = 0;
  let timers = [];
  return {
    now: () => time,
    later: (act, ms) => {
      const own = { act, at: time + ms };
      timers.push(own);
      return own;
    },
    cancel: (own) => (timers = timers.filter((t) => t !== own)),
    async go(ms) {
      const end = time + ms;
      for (;;) {
        const next = timers.filter((t) => t.at <= end).sort((a, b) => a.at - b.at)[0];
        if (!next) break;
        time = next.at;
        timers = timers.filter((t) => t !== next);
        next.act();
        for (let k = 0; k < 5; k++) await null;
      }
      time = end;
      for (let k = 0; k < 5; k++) await null;
    },
  };
}

test("a quiet act comes once after the last call", async () => {
  const time = clock();
  let count = 0;
  const quiet = new Quiet(400, () => count++, time);
  for (let k = 0; k < 5; k++) {
    quiet.call();
    await time.go(300);
  }
  assert.equal(count, 0);
  await time.go(100);
  assert.equal(count, 1);
  quiet.call();
  quiet.flush();
  assert.equal(count, 2);
  await time.go(1000);
  assert.equal(count, 2);
});

test("an act also comes while changes go on, and not before the one before ends or patience does", async () => {
  const time = clock();
  const begun = [];
  const ends = [];
  const pace = new Pace(20, 200, () => {
    begun.push(time.now());
    return new Promise((done) => ends.push(done));
  }, time);
  for (let k = 0; k < 10; k++) {
    pace.call();
    await time.go(10);
  }
  assert.deepEqual(begun, [20], "the second one waits for the first");
  ends[0]();
  await time.go(0);
  assert.deepEqual(begun, [20, 100]);
  pace.call();
  await time.go(500);
  assert.deepEqual(begun, [20, 100, 300], "after its patience it does not wait any more");
  ends[1]();
  ends[2]();
  await time.go(500);
  pace.call();
  await time.go(20);
  assert.equal(begun.length, 4);
});

test("suggestions fit what is typed", () => {
  assert.equal(fit("6208", '"62'), 0);
  assert.equal(fit("NU 208", "208"), 1);
  assert.equal(fit("iso14179_2", "i142"), 2);
  assert.equal(fit("skf", "x"), null);
  const range = (from, to) => ({ from, to });
  const of = (label, r) => ({ label, kind: "word", detail: "", documentation: "", insert: label, range: r, required: false });
  const text = "ä: bea";
  const found = fitting(text, 6, [of("abear", range(4, 7)), of("bearing", range(4, 7)), of("oil", range(4, 7))]);
  assert.deepEqual(found.map((f) => [f.completion.label, f.from, f.to]), [["bearing", 3, 6], ["abear", 3, 6]]);
});

test("files know what is not saved", () => {
  const files = new Files();
  files.add("a.yaml", "gearloss: gearbox/1\n", "1");
  files.add("b.yaml", "new", null);
  assert.deepEqual(files.unsaved().map((f) => f.file), ["b.yaml"]);
  files.setText("a.yaml", "x");
  assert.deepEqual(files.texts(), { "a.yaml": "x", "b.yaml": "new" });
  files.setSaved("a.yaml", "x", "2");
  files.setSaved("b.yaml", "new", "3");
  assert.deepEqual(files.texts(), {});
  assert.equal(kindOf('# a\ngearloss: "study/1"\n'), "study");
  assert.equal(kindOf("a: 1"), "other");
  assert.equal(kindOf("\uFEFFgearloss: gearbox/1"), "gearbox", "a byte order mark");
  assert.equal(kindOf('"gearloss" : study/1'), "study", "a quoted key");
  assert.equal(kindOf("gearloss': study/1"), "other");
  assert.equal(shortName("a/g.yaml", ["a/g.yaml", "s.yaml"]), "g.yaml");
  assert.equal(shortName("a/g.yaml", ["a/g.yaml", "b/g.yaml"]), "a/g.yaml");
  assert.equal(shortName("g.yaml", ["g.yaml", "b/g.yaml"]), "g.yaml");
});

test("line ends of the disk are written again, and do not shift offsets", () => {
  const files = new Files();
  files.add("w.yaml", "a: 1\r\nb: 2\r\n", "1");
  assert.equal(files.get("w.yaml").text, "a: 1\nb: 2\n");
  assert.equal(files.isUnsaved("w.yaml"), false);
  assert.deepEqual(files.texts(), { "w.yaml": "a: 1\nb: 2\n" });
  files.setText("w.yaml", "a: 3\nb: 2\n");
  assert.equal(files.onDisk("w.yaml"), "a: 3\r\nb: 2\r\n");
  files.setSaved("w.yaml", files.onDisk("w.yaml"), "2");
  assert.equal(files.isUnsaved("w.yaml"), false);
  files.setSaved("w.yaml", "a: 3\nb: 2\n", "3");
  assert.deepEqual(files.texts(), {});
});

test("with mixed line ends each unchanged line keeps its own", () => {
  const disk = "a\r\nb\nc\r\nd\re\r\n";
  const text = plainLines(disk);
  assert.equal(text, "a\nb\nc\nd\ne\n");
  assert.equal(withEnds(disk, text), disk);
  assert.equal(withEnds(disk, "new\na\nb\nc\nD\ne\n"), "new\r\na\r\nb\nc\r\nD\r\ne\r\n");
  assert.equal(withEnds(disk, "a\nb\nd\ne"), "a\r\nb\nd\re");
  assert.equal(withEnds("", "a\nb"), "a\nb");
  assert.equal(withEnds("x", "a\nb"), "a\nb");
  const files = new Files();
  files.add("m.yaml", disk, "1");
  files.setText("m.yaml", text.replace("c", "C"));
  assert.equal(files.onDisk("m.yaml"), disk.replace("c", "C"));
  assert.deepEqual(Object.keys(files.texts()), ["m.yaml"]);
});

test("a removed file keeps what it was, for a merge when it comes back", () => {
  const files = new Files();
  files.add("a.yaml", "a\nb\nc\n", "1");
  files.setRemoved("a.yaml", true);
  assert.equal(files.isUnsaved("a.yaml"), true);
  assert.equal(files.isEdited("a.yaml"), false);
  const { saved, hash } = files.get("a.yaml");
  assert.deepEqual([saved, hash], ["a\nb\nc\n", "1"]);
  files.setSaved("a.yaml", "a\nb\nc\nd\n", "2");
  assert.equal(files.get("a.yaml").removed, false);
  files.rename("a.yaml", "b.yaml");
  assert.equal(files.get("a.yaml"), undefined);
  assert.equal(files.get("b.yaml").hash, null);
  assert.equal(files.isUnsaved("b.yaml"), true);
});

test("a decimal comma is no number", () => {
  for (const [typed, value] of [["12.5", 12.5], [" -3 ", -3], ["1e3", 1000], ["1E-2", 0.01], [".5", 0.5], ["5.", 5], ["+2", 2], ["\u22124", -4]]) assert.deepEqual(entryOf(typed), { value });
  for (const [typed, fault] of [["12,5", "write 12.5"], ["-0,25", "write -0.25"], ["1,000.5", "write 1000.5"], ["1,000", "write 1000 or 1.000"], ["0,125", "write 0.125"], ["1,000,000", "write 1000000"]]) assert.deepEqual(entryOf(typed), { fault });
  for (const typed of ["", "-", "1e", "Infinity", "0x10", "1 2", "12.5 Nm", "NaN"]) assert.deepEqual(entryOf(typed), { fault: "write a number, such as 12.5 or 1e3" });
  assert.deepEqual(entryOf("1e999"), { fault: "write a smaller number" });
});

test("names of new files are those that can be saved and are free", () => {
  assert.equal(fileName(" gearbox "), "gearbox.yaml");
  assert.equal(fileName("a.yml"), "a.yml");
  assert.equal(fileName("a.YAML"), "a.yaml");
  assert.equal(fileName("a.csv"), "a.csv.yaml");
  assert.equal(fileName("a", "csv"), "a.csv");
  const known = ["gearbox.yaml", "sub/Study.yaml", "a/b/c.csv"];
  for (const name of ["new.yaml", "sub/new one-2_b.yaml", "a/b/x.yml", "a/x.yaml", "Öl.yaml"]) assert.equal(nameFault(name, known), null, name);
  for (const typed of ["gearbox", "Gearbox.yaml", "gearbox.YAML", "SUB/study"]) assert.notEqual(nameFault(fileName(typed), known), null, typed);
  for (const typed of ["gearbox", "Gearbox.yaml", "sub/study"]) assert.match(nameFault(fileName(typed), known), /exists already/, typed);
  for (const typed of ["", "../out.yaml", "A:B", ".hidden.yaml", "sub/none/new.yaml", "/root.yaml", "sub/", "sub//x", "a\\b", "sub/.x", "none/x", "./x"]) assert.equal(typeof nameFault(fileName(typed), known), "string", typed);
});

test("a file names others by their paths from its folder", () => {
  const texts = { "a/study.yaml": "gearbox: gearbox.yaml", "a/gearbox.yaml": "map: ../maps/loss.csv", "b/gearbox.yaml": "", "maps/loss.csv": "1,2" };
  assert.deepEqual(namedBy("a/study.yaml", texts), ["a/study.yaml", "a/gearbox.yaml", "maps/loss.csv"]);
});

test("errors are those of the text only if the text shows them", () => {
  const finding = (file, severity = "error") => ({ severity, code: "", path: "", message: "no", help: null, notes: [], place: file && { file, range: {} }, related: [] });
  const fault = (...findings) => ({ message: "the torque is too large", help: "give less", findings });
  assert.match(refusal(fault(finding("a.yaml")), ["a.yaml"], true), /numbers are those before/);
  assert.equal(refusal(fault(finding("a.yaml")), ["a.yaml"], false), "The gearbox has errors.");
  for (const own of [fault(), fault(finding(null)), fault(finding("b.yaml")), fault(finding("a.yaml", "warning"))]) assert.equal(refusal(own, ["a.yaml"], true), "the torque is too large; help: give less");
});

test("the output of a gearbox with two ports is at the port whose speed is not given", () => {
  const port = (port, speed_rpm, torque_nm) => ({ port, speed_rpm, torque_nm });
  const answer = (...ports) => ({ point: { ports } });
  const two = answer(port("in", 1000, 10), port("out", 250, -39));
  assert.deepEqual(outputOf(two, "in"), { port: "out", torque: 39, ratio: 4 });
  assert.deepEqual(outputOf(two, null), { port: "out", torque: 39, ratio: 4 });
  assert.deepEqual(outputOf(two, "out"), { port: "in", torque: -10, ratio: 0.25 });
  assert.equal(outputOf(answer(port("in", 1000, 10), port("out", 0, null)), "in").ratio, null);
  assert.equal(outputOf(answer(port("a", 1, 1), port("b", 1, 1), port("c", 1, 1)), "a"), null);
});

test("a request that stays without an answer is noticed, and its answer too", async () => {
  const said = [];
  let answer;
  const patient = new Patient({ ask: () => new Promise((done) => (answer = done)) }, 20, (is) => said.push(is));
  const asked = patient.ask({ request: "folder" });
  await new Promise((done) => setTimeout(done, 40));
  assert.deepEqual(said, [true]);
  answer({});
  await asked;
  assert.deepEqual(said, [true, false]);
  const quick = patient.ask({ request: "folder" });
  answer({});
  await quick;
  await new Promise((done) => setTimeout(done, 40));
  assert.deepEqual(said, [true, false]);
});

test("faults of a form belong to their fields", () => {
  const fields = ["gears.a.z", "gears.b.z", "bearings.B1.designation", "oil"];
  assert.equal(fieldOf("gears.a.z", fields), "gears.a.z");
  assert.equal(fieldOf("oil.viscosity", fields), "oil");
  assert.equal(fieldOf("bearings.B1", fields), "bearings.B1.designation");
  assert.equal(fieldOf("gears", fields), null);
  assert.equal(fieldOf("", fields), null);
  assert.equal(freeName("g.yaml", ["g.yaml", "g-2.yaml"]), "g-3.yaml");
});

test("differences have signs, losses their pinned ones", () => {
  assert.equal(signed(-1.25, (v) => v.toFixed(1)), "\u22121.3");
  assert.equal(signed(0.001, (v) => v.toFixed(1)), "±0.0");
  const loss = (path, w) => ({ path, mechanism: "bearing", model: "skf", loss: w, load_dependent: null });
  assert.deepEqual(rowsOf([loss("a", 1), loss("b", 3)], [loss("a", 2), loss("c", 4)]).map((r) => [r.path, r.loss, r.pinned]), [["b", 3, null], ["a", 1, 2], ["c", null, 4]]);
  assert.equal(stepOf(0, 100), 0.5);
  assert.equal(stepOf(0, 20000), 100);
  assert.equal(stepOf(5, 5), 1);
});

test("the difference of two maps needs the same points", () => {
  const panels = (values, x = [1, 2]) => ({ kind: "panels", title: "", rows: ["a"], columns: ["b"], x: ["speed in rpm", x], y: ["torque in Nm", [1, 2]], slider: null, quantities: [{ name: "efficiency", unit: "%", diverging: false, best: "highest", jumps: true, panels: [values] }], outside: [[]], marks: [], marked: "", powers: [], envelope: [], breakdown: null });
  const found = differenceOf(panels([1, 2, 3, null]), panels([1, 1, 1, 1]));
  assert.deepEqual(found.quantities[0].panels, [[0, 1, 2, null]]);
  assert.equal(found.quantities[0].unit, "points");
  assert.equal(found.quantities[0].diverging, true);
  assert.equal(differenceOf(panels([1, 2, 3, 4]), panels([1, 2, 3, 4], [1, 3])), null);
});

test("hidden characters are shown as escapes, letters of all languages as they are", async () => {
  const { visible } = await load("../visible");
  assert.equal(visible("\u202egpj\u001b[2J\u009b\u200b\u{e0041}"), "\\u{202e}gpj\\u{1b}[2J\\u{9b}\\u{200b}\\u{e0041}");
  for (const text of ["Größe µ ≥ 2 °C", "減速機 גלגל", "two\nlines\r\nand\ta tab"]) assert.equal(visible(text), text);
});

test("a page sends texts to the program that made it alone", async () => {
  const { Gone, Http, Locked } = await load("transport");
  const save = { request: "save", file: "a.yaml", text: "secret", hash: null };
  const sent = [];
  let proof = "of the program";
  let down = false;
  const before = globalThis.fetch;
  globalThis.fetch = async (_, { body }) => {
    if (down) throw new TypeError("refused");
    sent.push(JSON.parse(body).request);
    return new Response('{ "value": null }', { headers: proof ? { "Gearloss-Proof": proof } : {} });
  };
  try {
    const page = new Http("0");
    await page.ask(save);
    await page.ask(save);
    assert.deepEqual(sent, ["hello", "save", "save"]);
    // The program ends, and another one takes its port.
    for (const other of ["of another", ""]) {
      down = true;
      await assert.rejects(page.ask(save), Gone);
      [down, proof] = [false, other];
      sent.length = 0;
      await assert.rejects(page.ask(save), Locked);
      assert.deepEqual(sent, ["hello"], "it gets a text");
    }
    // It was only slow.
    [proof, sent.length] = ["of the program", 0];
    await page.ask(save);
    assert.deepEqual(sent, ["hello", "save"]);
  } finally {
    globalThis.fetch = before;
  }
});

test("a busy program is asked again when it says so", async () => {
  const { Http } = await load("transport");
  const before = globalThis.fetch;
  let answers = 0;
  globalThis.fetch = async () => {
    const headers = { "Gearloss-Proof": "1", "Retry-After": "0.01" };
    return ++answers < 4 ? new Response("busy", { status: answers === 1 ? 200 : 503, headers }) : new Response('{ "value": 7 }', { headers });
  };
  try {
    assert.equal(await new Http("0").ask({ request: "read", file: "a.yaml" }), 7);
    assert.equal(answers, 4);
  } finally {
    globalThis.fetch = before;
  }
});

test("drafts are kept in the program, the newest text of a file, and nothing in the storage of the browser", async () => {
  const { Drafts } = await load("drafts");
  const items = new Map();
  globalThis.sessionStorage = { getItem: (key) => items.get(key) ?? null, setItem: (key, value) => items.set(key, value) };
  Object.defineProperty(globalThis, "navigator", { value: {}, configurable: true });
  const asked = [];
  const other = { id: "p/t-1", tab: "t", draft: { file: "b.yaml", text: "of a closed tab", hash: null, base: "", time: 1 } };
  const transport = {
    ask: async (request) => {
      asked.push(request);
      if (request.request === "drafts") return [other];
      return request.request === "keep" ? { id: `p/${request.draft.file}` } : null;
    },
  };
  const drafts = await Drafts.open(transport);
  assert.deepEqual(drafts.kept(), [other]);
  const keep = (text) => drafts.keep({ file: "a.yaml", text, hash: "1", base: "" });
  await Promise.all([keep("one"), keep("two"), keep("two")]);
  drafts.drop("a.yaml");
  drafts.dropKept(other);
  await keep("three");
  assert.deepEqual(asked.slice(1).map((own) => own.draft?.text ?? own.id), ["two", "p/a.yaml", "p/t-1", "three"]);
  assert.ok(![...items.values()].some((value) => value.includes("two") || value.includes("three")));
});
