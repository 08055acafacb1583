// One map, and values at scattered points.

import { extent } from "./levels.ts";
import { ColourScale } from "./colours.ts";
import { valueAt } from "./contours.ts";
import { decimalsOf, fixed, nameOf, significant, unitOf, withUnit, words } from "./format.ts";
import { colourBar, drawField, fieldScale, gridOf, halo, pointScale } from "./field.ts";
import { Entry, Frame, Stage, Tooltip, axes, canvas, fitted, hatching, html, leftMargin, legend, movable, onScreen, pointer, svg, textWidth } from "./svg.ts";
import type { Cloud, FieldMap } from "./types.ts";
import { visible } from "./visible.ts";

/** Coordinates as ascending numbers, with the order of their values; absent if they are texts. */
export function numbersOf(labels: string[]): number[] | null {
  const list = labels.map((label) => {
    const first = label.split(" ")[0];
    return /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i.test(first) ? Number(first) : NaN;
  });
  if (list.length < 2 || list.some(Number.isNaN)) return null;
  const ascending = list.every((v, i) => i === 0 || v > list[i - 1]);
  const descending = list.every((v, i) => i === 0 || v < list[i - 1]);
  return ascending || descending ? list : null;
}

/** Name of an axis of numbers: a unit behind the values moves there. */
function axisName(name: string, labels: string[]): string {
  const unit = labels[0]?.split(" ").slice(1).join(" ");
  return unit ? `${name} in ${unit}` : name;
}

function flipped<T>(list: T[], columns: number, x: boolean, y: boolean): T[] {
  const rows: T[][] = [];
  for (let k = 0; k < list.length; k += columns) rows.push(list.slice(k, k + columns));
  if (x) rows.forEach((row) => row.reverse());
  if (y) rows.reverse();
  return rows.flat();
}

export function drawMap(stage: Stage, map: FieldMap): void {
  if (map.values.every((v) => v === null)) return note(stage, "No values.");
  const [x, y] = [numbersOf(map.x[1]), numbersOf(map.y[1])];
  if (x && y) contourMap(stage, map, x, y);
  else cells(stage, map);
}

function contourMap(stage: Stage, map: FieldMap, x: number[], y: number[]): void {
  const [turnX, turnY] = [x[0] > x[1], y[0] > y[1]];
  const xs = turnX ? [...x].reverse() : x;
  const ys = turnY ? [...y].reverse() : y;
  const values = flipped(map.values, x.length, turnX, turnY);
  const outside = flipped(map.hatched, x.length, turnX, turnY);
  const at = map.crossed ? [map.crossed[0] % x.length, Math.floor(map.crossed[0] / x.length)] : null;
  const crossed = at ? (turnY ? y.length - 1 - at[1] : at[1]) * x.length + (turnX ? x.length - 1 - at[0] : at[0]) : undefined;
  const colours = fieldScale(values, map.diverging, map.best, map.ends);
  const height = stage.height ?? Math.round(Math.min(0.6 * stage.width, Math.max(420, 0.4 * stage.width)));
  const element = canvas(stage, height, map.title);
  const frame: Frame = { svg: element, left: leftMargin(ys[0], ys[ys.length - 1], height - 70), top: 26, right: stage.width - 22, bottom: height - 42 };
  const { sx, sy } = axes(frame, { low: xs[0], high: xs[xs.length - 1], name: axisName(map.x[0], map.x[1]) }, { low: ys[0], high: ys[ys.length - 1], name: axisName(map.y[0], map.y[1]) }, { grid: false });
  const grid = gridOf(xs, ys, values, map.jumps);
  const dashed = map.unseen && map.unseen > 0 ? [-map.unseen, map.unseen] : [];
  const shown = drawField(frame, grid, { sx, sy, colours, best: map.best, outside, marks: map.marks, dashed, crossed });
  stage.movers.push(movable(frame, sx, sy));
  const key = html(stage.root, "div", { class: "gl-key" });
  colourBar(key, colours, words(map.unit), Math.min(stage.width, 480));
  const entries: Entry[] = [];
  if (map.best) entries.push({ name: "best point", mark: "star", colour: "#fff" });
  if (map.marks.length) entries.push({ name: map.marked || "measured", mark: "ring" });
  if (map.crossed) entries.push({ name: map.crossed[1], mark: "cross" });
  if (dashed.length) entries.push({ name: `accuracy of the instrument, ${significant(map.unseen, 2)}`, mark: "dashed" });
  if (shown.hatched) entries.push({ name: map.hatching === "limit" ? "beyond the limit" : "outside a validity range", mark: "hatch" });
  legend(key, entries);
  if (shown.allOutside) note(stage, "All points are outside a model's validity range.");
  const tip = new Tooltip(stage.root);
  const [nameX, nameY] = [map.x, map.y].map(([name, labels]) => axisName(name, labels));
  element.addEventListener("pointermove", (event) => {
    const [px, py] = pointer(element, event);
    if (px < frame.left || px > frame.right || py < frame.top || py > frame.bottom) return tip.hide();
    const [vx, vy] = [sx.invert(px), sy.invert(py)];
    const rows = [place(nameX, vx), place(nameY, vy), { name: "value", value: withUnit(resolved(valueAt(grid, vx, vy), map.values), map.unit), strong: true }];
    tip.show({ head: "", rows }, event.clientX, event.clientY);
  });
  element.addEventListener("pointerleave", () => tip.hide());
  element.addEventListener("click", (event) => {
    const [px, py] = pointer(element, event);
    if (px >= frame.left && px <= frame.right && py >= frame.top && py <= frame.bottom) stage.pick?.(sx.invert(px), sy.invert(py));
  });
}

/** A value with as many decimals as four digits of the largest value have. */
export function resolved(value: number | null, all: (number | null)[]): string {
  if (value === null || !Number.isFinite(value)) return "–";
  const largest = all.reduce<number>((most, v) => Math.max(most, Math.abs(v ?? 0)), 0);
  return largest > 0 && largest < 1e9 ? fixed(value, Math.min(9, Math.max(0, 3 - Math.floor(Math.log10(largest))))) : significant(value, 4);
}

export function place(name: string, value: number): { name: string; value: string } {
  return { name: nameOf(name), value: withUnit(significant(value, 3), unitOf(name)) };
}

export function note(stage: Stage, text: string): void {
  const element = document.createElement("p");
  element.className = "gl-note";
  element.textContent = visible(text);
  stage.root.append(element);
}

/** A map whose coordinates are texts: one cell for each pair. */
function cells(stage: Stage, map: FieldMap): void {
  const [[nameX, labelsX], [nameY, labelsY]] = [map.x, map.y];
  const [nx, ny] = [labelsX.length, labelsY.length];
  const colours = pointScale(map.values, map.diverging, map.ends);
  const widest = Math.max(0, ...labelsY.map((l) => textWidth(words(l))));
  const left = Math.min(widest + 12, 0.36 * stage.width);
  const right = stage.width - 10;
  const w = (right - left) / Math.max(1, nx);
  const turned = labelsX.some((l) => textWidth(words(l)) > w - 6);
  const below = turned ? Math.min(150, Math.max(...labelsX.map((l) => textWidth(words(l)))) * 0.72 + 18) : 22;
  const h = Math.max(22, Math.min(44, (stage.height ?? 0.6 * stage.width) / Math.max(1, ny)));
  const top = nameY ? 24 : 8;
  const height = top + ny * h + below + (nameX ? 22 : 4);
  const element = canvas(stage, height, map.title);
  // All cells with the same decimals, three digits for the largest value.
  const largest = Math.max(1e-9, ...map.values.map((v) => Math.abs(v ?? 0)));
  const decimals = Math.max(0, Math.min(6, decimalsOf(10 ** (Math.floor(Math.log10(largest)) - 2))));
  const hatch = map.hatched.some(Boolean) ? hatching(element, "rgba(0,0,0,0.5)", 8, 0.6) : "";
  if (nameY) svg(element, "text", { x: 2, y: 14, class: "gl-name" }, words(nameY));
  if (nameX) svg(element, "text", { x: 0.5 * (left + right), y: height - 5, "text-anchor": "middle", class: "gl-name" }, words(nameX));
  labelsY.forEach((label, j) => svg(element, "text", { x: left - 7, y: top + (ny - 1 - j + 0.5) * h + 4, "text-anchor": "end" }, fitted(words(label), left - 10)));
  labelsX.forEach((label, i) => {
    const [px, py] = [left + (i + 0.5) * w, top + ny * h + 15];
    if (turned) svg(element, "text", { x: px + 4, y: py, "text-anchor": "end", transform: `rotate(-45 ${px.toFixed(1)} ${py})` }, fitted(words(label), 190));
    else svg(element, "text", { x: px, y: py, "text-anchor": "middle" }, words(label));
  });
  map.values.forEach((value, k) => {
    const [px, py] = [left + (k % nx) * w, top + (ny - 1 - Math.floor(k / nx)) * h];
    if (value === null) {
      svg(element, "rect", { x: px, y: py, width: w, height: h, class: "gl-absent" });
      return;
    }
    svg(element, "rect", { x: px, y: py, width: w, height: h, fill: colours.at(value), stroke: "var(--gl-ground)", "stroke-width": 1 });
    if (hatch && map.hatched[k]) svg(element, "rect", { x: px, y: py, width: w, height: h, fill: hatch });
    const text = fixed(value, decimals);
    if (textWidth(text) < w - 4) halo(element, px + w / 2, py + h / 2 + 4, text, colours.at(value), { "text-anchor": "middle" });
  });
  if (map.crossed) {
    const [i, j] = [map.crossed[0] % nx, Math.floor(map.crossed[0] / nx)];
    svg(element, "rect", { x: left + i * w + 1.5, y: top + (ny - 1 - j) * h + 1.5, width: w - 3, height: h - 3, fill: "none", stroke: "var(--gl-ink)", "stroke-width": 3 });
  }
  const key = html(stage.root, "div", { class: "gl-key" });
  colourBar(key, colours, words(map.unit), Math.min(stage.width, 480));
  const entries: Entry[] = [];
  if (map.crossed) entries.push({ name: map.crossed[1], mark: "outline" });
  if (hatch) entries.push({ name: map.hatching === "limit" ? "beyond the limit" : "outside a validity range", mark: "hatch" });
  legend(key, entries);
  const tip = new Tooltip(stage.root);
  element.addEventListener("pointermove", (event) => {
    const [px, py] = pointer(element, event);
    const [i, j] = [Math.floor((px - left) / w), ny - 1 - Math.floor((py - top) / h)];
    if (i < 0 || i >= nx || j < 0 || j >= ny) return tip.hide();
    const value = map.values[j * nx + i];
    tip.show({ head: "", rows: [{ name: nameX, value: labelsX[i] }, { name: nameY, value: labelsY[j] }, { name: "value", value: significant(value, 4), strong: true }] }, event.clientX, event.clientY);
  });
  element.addEventListener("pointerleave", () => tip.hide());
}

export function drawCloud(stage: Stage, cloud: Cloud): void {
  const sized = cloud.sizes.length === cloud.points.length;
  const radius = (k: number, usual: number) => (sized ? Math.max(1.5, 13 * Math.sqrt(cloud.sizes[k])) : usual);
  // Large points first, so that they do not cover the others.
  const order = cloud.points.map((_, k) => k).filter((k) => cloud.points[k].every((v) => v !== null));
  if (sized) order.sort((a, b) => cloud.sizes[b] - cloud.sizes[a]);
  const points = order.map((k) => cloud.points[k]);
  if (points.length === 0) return note(stage, "No values.");
  const colours: ColourScale = pointScale(points.map((p) => p[2]), cloud.diverging);
  const ends = (k: 0 | 1): [number, number] => {
    const list = points.map((p) => p[k]);
    const [low, high] = extent(list);
    const margin = 0.03 * (high - low) || 1;
    return list.length ? [low - margin, high + margin] : [0, 1];
  };
  const [x, y] = [ends(0), ends(1)];
  const height = stage.height ?? Math.round(Math.min(0.6 * stage.width, 420));
  const element = canvas(stage, height, cloud.title);
  const frame: Frame = { svg: element, left: leftMargin(...y, height - 70), top: 26, right: stage.width - 22, bottom: height - 42 };
  const { sx, sy } = axes(frame, { low: x[0], high: x[1], name: cloud.axes[0] }, { low: y[0], high: y[1], name: cloud.axes[1] });
  const r = points.length > 400 ? 3.5 : 5;
  points.forEach(([a, b, v], k) => svg(element, "circle", { cx: sx(a), cy: sy(b), r: radius(order[k], r), fill: colours.at(v), class: "gl-point" }));
  if (cloud.sized) note(stage, words(cloud.sized));
  colourBar(stage.root, colours, words(cloud.unit), Math.min(stage.width, 480));
  const tip = new Tooltip(stage.root);
  const ring = svg(element, "circle", { r: r + 3, class: "gl-ring", visibility: "hidden" });
  element.addEventListener("pointermove", (event) => {
    const [px, py] = pointer(element, event);
    let near = -1;
    let least = 30;
    points.forEach(([a, b], k) => {
      const d = Math.hypot(sx(a) - px, sy(b) - py);
      if (d < least) [near, least] = [k, d];
    });
    if (near < 0) {
      ring.setAttribute("visibility", "hidden");
      return tip.hide();
    }
    const [a, b, v] = points[near];
    ring.setAttribute("cx", String(sx(a)));
    ring.setAttribute("cy", String(sy(b)));
    ring.setAttribute("visibility", "visible");
    tip.show({ head: "", rows: [place(cloud.axes[0], a), place(cloud.axes[1], b), { name: "value", value: withUnit(significant(v, 4), cloud.unit), strong: true }] }, ...onScreen(element, sx(a), sy(b)));
  });
  element.addEventListener("pointerleave", () => {
    tip.hide();
    ring.setAttribute("visibility", "hidden");
  });
}

