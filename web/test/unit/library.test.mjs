// Tests of the functions without a browser. They are bundled first, because node reads no TypeScript.

import assert from "node:assert/strict";
import { mkdtemp, readFile, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import { build } from "esbuild";

const folder = await mkdtemp(join(tmpdir(), "gearloss-web-"));
after(() => rm(folder, { recursive: true }));
const source = (name) => new URL(`../../src/${name}.ts`, import.meta.url).pathname;

async function load(name) {
  const outfile = join(folder, `${name}.mjs`);
  await build({ entryPoints: [source(name)], outfile, bundle: true, format: "esm", logLevel: "error" });
  return import(outfile);
}

const { ticks, levels, evenLevels, nice } = await load("levels");
const { fixed, significant, axisNumbers, short, words, unitOf, nameOf } = await load("format");
const { ColourBook, ColourScale, MECHANISMS, PALETTE, lineLooks, mechanismOf, diverging, luminance, sequential } = await load("colours");
const { isolines, region, refine, labels, monotone, valueAt } = await load("contours");
const { csv, tabbed, order, isNumeric, numberOf } = await load("table");
const { numbersOf, resolved } = await load("map");
const { gridOf, bestCell } = await load("field");
const { steps } = await load("rows");
const { between } = await load("lines");

const range = (n, f) => Array.from({ length: n }, (_, k) => f(k));

test("pictures in files have the colours of the mechanisms, too", async () => {
  const plot = await readFile(new URL("../../../framework/report/src/plot.rs", import.meta.url), "utf8");
  for (const [mechanism, colour] of Object.entries(MECHANISMS)) {
    const parts = [1, 3, 5].map((k) => `0x${colour.slice(k, k + 2)}`).join(", ");
    assert.ok(plot.includes(`("${mechanism}", RGBColor(${parts}))`), mechanism);
  }
});

test("numbers are written as engineers write them", () => {
  assert.equal(fixed(20000, 0), "20\u202f000");
  assert.equal(fixed(2000, 0), "2000");
  assert.equal(fixed(-1234567.5, 1), "\u22121\u202f234\u202f567.5");
  assert.equal(fixed(-0.0001, 2), "0.00");
  assert.equal(significant(98.2345), "98.23");
  assert.equal(significant(null), "–");
  assert.equal(significant(1.5e12, 3), "1.50·10¹²");
  assert.equal(significant(1.5e-7, 2), "1.5·10⁻⁷");
  assert.equal(short(97.5), "97.5");
  assert.equal(short(0.30000000000000004), "0.3");
  assert.deepEqual(axisNumbers([0, 10000, 20000]), ["0", "10\u202f000", "20\u202f000"]);
  assert.deepEqual(axisNumbers([0, 0.25, 0.5]), ["0.00", "0.25", "0.50"]);
});

test("words have the typography of the field", () => {
  assert.equal(words("oil at 40 degC, 5 mm2/s, -3 K"), "oil at 40\u00a0°C, 5 mm²/s, \u22123\u00a0K");
  assert.equal(words("m2 and B-2"), "m2 and B-2");
  assert.equal(words("loss 12 W, 4 Wh"), "loss 12\u00a0W, 4\u00a0Wh");
  assert.equal(unitOf("loss in W"), "W");
  assert.equal(unitOf("speed rpm"), "rpm");
  assert.equal(unitOf("place between the bounds"), "");
  assert.equal(nameOf("loss in W"), "loss");
  assert.equal(nameOf("torque Nm"), "torque");
});

test("ticks are round and inside", () => {
  assert.deepEqual(ticks(0.13, 0.98, 5), [0.2, 0.4, 0.6, 0.8]);
  assert.deepEqual(ticks(-20, 20, 5), [-20, -10, 0, 10, 20]);
  assert.deepEqual(ticks(5, 5, 5), [5]);
  assert.deepEqual(nice(3.6, 19, 5), [0, 20]);
});

test("levels of an efficiency are denser towards the best", () => {
  const values = range(16, (t) => range(14, (n) => 100 - 1.3 - 35 / (10 * (t + 1)) - (0.07 * (n + 1) ** 2) / (t + 1))).flat();
  const found = levels(values, "highest");
  assert.ok(found.length >= 8 && found.length <= 14, String(found));
  const gaps = found.slice(1).map((v, i) => v - found[i]);
  assert.ok(gaps[0] > 4 * gaps[gaps.length - 1], String(found));
  for (const v of found) assert.equal(Number(v.toPrecision(4)), v);
  const loss = levels(values.map((v) => 100 - v), "lowest");
  assert.ok(loss.length >= 8 && loss.length <= 14 && loss[1] - loss[0] < loss[loss.length - 1] - loss[loss.length - 2], String(loss));
});

test("levels of anything are few, ascending and inside", () => {
  for (let seed = 1; seed < 200; seed++) {
    let s = seed * 7919;
    const random = () => (s = (s * 16807) % 2147483647) / 2147483647;
    const size = 10 ** (8 * random() - 4);
    const power = 0.2 + 6 * random();
    const values = range(40 + Math.floor(200 * random()), () => size * (random() ** power - 0.3 * (seed % 2)));
    const [low, high] = [Math.min(...values), Math.max(...values)];
    for (const best of ["highest", "lowest", null]) {
      const found = levels(values, best);
      assert.ok(found.length >= 3 && found.length <= 20, `${seed} ${best}: ${found}`);
      found.forEach((v, k) => assert.ok(v > low - 1e-9 && v < high + 1e-9 && (k === 0 || v > found[k - 1]), `${seed} ${best}: ${found}`));
    }
  }
  assert.deepEqual(evenLevels([1, 1, 1]), []);
  assert.deepEqual(levels([], "highest"), []);
  assert.ok(evenLevels([-0.5, 2.4]).includes(0));
});

test("a name keeps its colour, and measured lines have that of the calculated", () => {
  const book = new ColourBook();
  const mesh = book.colour("mesh");
  for (let k = 0; k < 30; k++) book.colour(`part ${k}`);
  assert.equal(book.colour("mesh"), mesh);
  assert.equal(book.colour("mesh, measured"), mesh);
  assert.ok(book.repeated("part 25") && !book.repeated("part 3"));
  assert.equal(new Set(PALETTE).size, 20);
  const series = new ColourBook();
  series.place("iso");
  series.place("joint");
  const colours = (names) => lineLooks(names, new ColourBook(), series).map((look) => look.colour);
  const one = colours(["joint", "x", "joint, measured"]);
  const two = colours(["y", "iso", "joint"]);
  assert.equal(one[0], two[2]);
  assert.equal(one[0], one[2]);
  assert.equal(new Set([...two]).size, 3);
});

test("lines of one picture differ in colour or dash", () => {
  const book = new ColourBook();
  const bearings = range(14, (k) => `bearings.B${k}`);
  for (const name of bearings) book.look(name);
  // Temperatures are named by the id of their component.
  const names = ["gear_mesh", "seal", "casing", "sump", ...range(14, (k) => `B${k}`), ...range(20, (k) => `line ${k}`)];
  const looks = lineLooks(names, book, new ColourBook());
  assert.equal(new Set(looks.map((look) => `${look.colour} ${look.round}`)).size, names.length);
  assert.deepEqual(looks[4], book.look("bearings.B0"));
});

test("a mechanism has one colour, its components have shades of it, and all eyes tell mechanisms apart", () => {
  assert.deepEqual(mechanismOf("bearings.B2"), ["bearing", true]);
  assert.deepEqual(mechanismOf("meshes.M2.drag.churning"), ["gear_drag", true]);
  assert.deepEqual(mechanismOf("gears, load-dependent"), ["gear_mesh", false]);
  for (const other of ["gears.*.surface.rq", "constructor", "joint", "bearings"]) assert.equal(mechanismOf(other), null);
  const [one, two] = [new ColourBook(), new ColourBook()];
  for (const name of ["joint", "x", "bearings.B7"]) one.look(name);
  for (const name of Object.keys(MECHANISMS)) assert.equal(one.colour(name), two.colour(name));
  const light = (c) => [0, 1, 2].map((k) => parseInt(c.slice(1 + 2 * k, 3 + 2 * k), 16) / 255).map((x) => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4));
  // Machado et al. (2009): normal, red-blind, green-blind.
  const eyes = [
    [1, 0, 0, 0, 1, 0, 0, 0, 1],
    [0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116, 1.051998],
    [0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.01182, 0.04294, 0.968881],
  ];
  const seen = (c, eye) => {
    const rgb = light(c);
    const [r, g, b] = [0, 1, 2].map((row) => Math.max(0, rgb.reduce((sum, x, k) => sum + eye[3 * row + k] * x, 0)));
    const lms = [[0.4122, 0.5363, 0.0514], [0.2119, 0.6807, 0.1074], [0.0883, 0.2817, 0.63]].map(([p, q, s]) => Math.cbrt(p * r + q * g + s * b));
    return [[0.2105, 0.7936, -0.0041], [1.978, -2.4286, 0.4506], [0.0259, 0.7828, -0.8087]].map((row) => row.reduce((sum, x, k) => sum + x * lms[k], 0));
  };
  const all = Object.entries(MECHANISMS);
  for (const eye of eyes)
    for (const [k, [a, one]] of all.entries())
      for (const [b, two] of all.slice(k + 1)) {
        const [p, q] = [seen(one, eye), seen(two, eye)];
        assert.ok(Math.hypot(...p.map((x, i) => x - q[i])) > 0.06, `${a} and ${b}`);
      }
  // Visible on white and on the dark ground.
  for (const colour of range(5, (k) => one.colour(`bearings.${k}`)))
    for (const ground of ["#ffffff", "#171b21"]) {
      const [a, b] = [luminance(colour), luminance(ground)].sort((x, y) => y - x);
      assert.ok((a + 0.05) / (b + 0.05) > 1.5, `${colour} on ${ground}`);
    }
});

test("the scale of values gets evenly lighter, that of differences is symmetric in lightness", () => {
  const lights = range(11, (k) => luminance(sequential(k / 10)));
  lights.forEach((l, k) => assert.ok(k === 0 || l > lights[k - 1]));
  for (const x of [0.25, 0.5, 0.75]) assert.ok(luminance(diverging(x)) < luminance(diverging(x - 0.25)) && luminance(diverging(-x)) < luminance(diverging(0.25 - x)));
  const scale = new ColourScale(90, 99, [94, 97, 98], false, true);
  assert.equal(scale.at(93), scale.band(0));
  assert.equal(scale.at(97), scale.band(2));
  assert.equal(scale.at(98.9), scale.band(3));
});

const plane = (nx, ny, f) => {
  const [xs, ys] = [range(nx, (i) => i * i), range(ny, (j) => j)];
  return { xs, ys, values: ys.flatMap((y) => xs.map((x) => f(x, y))) };
};

const area = (rings) => rings.reduce((sum, ring) => sum + 0.5 * ring.reduce((s, p, k) => s + p[0] * ring[(k + 1) % ring.length][1] - ring[(k + 1) % ring.length][0] * p[1], 0), 0);

test("a contour of a plane is straight on an uneven grid", () => {
  const lines = isolines(plane(4, 5, (x, y) => x + 2 * y), 6.1);
  assert.equal(lines.length, 1);
  for (const [x, y] of lines[0]) assert.ok(Math.abs(x + 2 * y - 6.1) < 1e-12);
});

test("regions cover what is above the level, and gaps are left out", () => {
  const grid = plane(4, 5, (x, y) => x + 2 * y);
  assert.ok(Math.abs(area(region(grid, -Infinity)) - 36) < 1e-9);
  // Above x + 2 y = 9 in a box of 9 by 4: 36 less the part below, which is a trapezium.
  assert.ok(Math.abs(area(region(grid, 9)) - (36 - (9 + 1) * 0.5 * 4)) < 1e-9);
  grid.values[0] = null;
  assert.ok(Math.abs(area(region(grid, -Infinity)) - 35) < 1e-9);
  assert.equal(valueAt(grid, 0.5, 0.5), null);
  assert.equal(valueAt(grid, 2, 1.5), 5);
  assert.equal(valueAt(grid, 9, 4), 17);
});

test("a ring has no open ends and a saddle two lines", () => {
  const hill = isolines(plane(7, 7, (x, y) => -((x - 12) ** 2) - 20 * (y - 3) ** 2), -60);
  assert.equal(hill.length, 1);
  assert.deepEqual(hill[0][0], hill[0][hill[0].length - 1]);
  assert.equal(isolines({ xs: [0, 1], ys: [0, 1], values: [1, 0, 0, 1] }, 0.4).length, 2);
});

test("refinement keeps the values and adds no extremes", () => {
  const grid = plane(5, 4, (x, y) => Math.sin(x) + y * y);
  grid.values[7] = null;
  const fine = refine(grid, 4);
  grid.values.forEach((v, k) => {
    const [i, j] = [k % 5, Math.floor(k / 5)];
    const own = fine.values[4 * j * fine.xs.length + 4 * i];
    assert.ok(v === null ? own === null : Math.abs(own - v) < 1e-9);
  });
  const smooth = monotone([0, 1, 2, 10], [0, 0, 1, 1], range(101, (k) => k / 10));
  smooth.forEach((v, k) => assert.ok(v >= -1e-12 && v <= 1 + 1e-12 && (k === 0 || v >= smooth[k - 1] - 1e-12)));
});

test("an efficiency has no surface between coast and drive", () => {
  const ys = [-5, -2, 3, 6];
  const grid = gridOf([1000, 2000], ys, new Array(8).fill(95), true);
  assert.ok(Math.abs(area(region(grid, -Infinity)) - 6000) < 1e-6);
  assert.equal(valueAt(grid, 1500, 0), null);
  const loss = gridOf([1000, 2000], ys, new Array(8).fill(95), false);
  assert.equal(valueAt(loss, 1500, 0), 95);
  const fine = refine(grid, 3);
  assert.ok(Math.abs(area(region(fine, -Infinity)) - 6000) < 1e-6);
  assert.equal(bestCell([1, null, 3], "highest"), 2);
  assert.equal(bestCell([1, null, 3], "lowest"), 0);
});

test("labels are upright, inside and apart", () => {
  const lines = range(6, (k) => ({ level: k, line: range(60, (i) => [10 + 6 * i, 30 + 30 * k + 10 * Math.sin(i / 12)]) }));
  const frame = { left: 0, top: 0, right: 380, bottom: 230 };
  const found = labels(lines, () => 26, frame, [{ x: 190, y: 100, radius: 20 }]);
  assert.ok(found.length >= 5, String(found.length));
  for (const a of found) {
    assert.ok(a.angle >= -90 && a.angle <= 90 && a.x > 13 && a.x < 367 && a.y > 5 && a.y < 225);
    assert.ok(Math.hypot(a.x - 190, a.y - 100) > 20);
    for (const b of found) assert.ok(a === b || Math.hypot(a.x - b.x, a.y - b.y) > 26);
  }
  assert.deepEqual(labels([{ level: 1, line: [[0, 0], [5, 5]] }], () => 26, frame), []);
});

test("values of a map have common decimals", () => {
  assert.equal(resolved(0.0714, [0.7, -0.2, null]), "0.0714");
  assert.equal(resolved(7.123456, [980, 7]), "7.1");
  assert.equal(resolved(98.1234, [98.3]), "98.12");
  assert.equal(resolved(null, [1]), "–");
});

test("coordinates are numbers only if all are and they are in order", () => {
  assert.deepEqual(numbersOf(["60 ml", "75 ml"]), [60, 75]);
  assert.deepEqual(numbersOf(["0", "-16"]), [0, -16]);
  assert.equal(numbersOf(["low", "high"]), null);
  assert.equal(numbersOf(["1", "3", "2"]), null);
  assert.equal(numbersOf(["5"]), null);
});

test("a waterfall begins with the largest loss and joins what does not fit", () => {
  const losses = range(10, (k) => [`part ${k}`, "g", k]);
  const all = steps(losses, 20);
  assert.equal(all.length, 9);
  assert.equal(all[0].value, 9);
  const few = steps(losses, 4);
  assert.deepEqual(few.map((s) => s.value), [9, 8, 7, 21]);
  assert.equal(few[3].name, "6 others");
});

test("a line has a value between its points, but not in a gap", () => {
  const line = { name: "", stroke: "line", points: [[0, 0], [2, 4], null, [4, 8], [6, 8]] };
  assert.equal(between(line, 1), 2);
  assert.equal(between(line, 3), null);
  assert.equal(between(line, 6), 8);
});

test("tables sort numbers as numbers and leave empty cells at the end", () => {
  assert.deepEqual(order(["10", "9.5", "-", "\u22123"], false), [3, 1, 0, 2]);
  assert.deepEqual(order(["10", "9.5", "-", "\u22123"], true), [0, 1, 3, 2]);
  assert.deepEqual(order(["B10", "B9", "b1"], false), [2, 1, 0]);
  assert.ok(isNumeric(["1.2", "-", "3e-4"]) && !isNumeric(["1.2", "x"]) && !isNumeric(["-", ""]));
  assert.equal(numberOf("20\u202f000"), 20000);
  assert.equal(numberOf("12 %"), 12);
  assert.ok(Number.isNaN(numberOf("500 to 2000")) && Number.isNaN(numberOf("B1")));
});

test("CSV follows RFC 4180 and copies have tabs", () => {
  assert.equal(csv([["a", 'b "c"', "d,e"], ["1", "", "x\ny"]]), 'a,"b ""c""","d,e"\r\n1,,"x\ny"\r\n');
  assert.equal(tabbed([["a\tb", "c"], ["1", "2"]]), "a b\tc\n1\t2\n");
});
