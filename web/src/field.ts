// A value over two coordinates of numbers: filled contours with labelled lines, in a frame of an SVG element.

import { ColourScale, luminance } from "./colours.ts";
import { Grid, Label, Point, isolines, isCell, labels, refine, region } from "./contours.ts";
import { short, significant } from "./format.ts";
import { evenLevels, levels, extent } from "./levels.ts";
import { Frame, Scale, TEXT, canvas, clip, hatching, star, svg, textWidth, unique } from "./svg.ts";
import type { Best } from "./types.ts";

/** The scale of a quantity over all its maps. */
export function fieldScale(values: (number | null)[], diverging: boolean, best: Best | null, ends: [number, number] | null = null): ColourScale {
  const known = values.filter((v): v is number => v !== null && Number.isFinite(v));
  let [low, high] = ends ?? extent(known);
  if (!(low <= high)) [low, high] = [0, 1];
  const found = diverging || best === null ? evenLevels([low, high, ...known]) : levels(ends ? [...known, ...ends] : known, best);
  return new ColourScale(low, high, found, diverging, true);
}

/** Colours of single cells and points: continuous, with round numbers in the legend. */
export function pointScale(values: (number | null)[], diverging: boolean, ends: [number, number] | null = null): ColourScale {
  const { low, high } = fieldScale(values, diverging, null, ends);
  return new ColourScale(low, high, evenLevels([low, high], 6), diverging, false);
}

interface FieldLook {
  sx: Scale;
  sy: Scale;
  colours: ColourScale;
  best: Best | null;
  outside?: boolean[];
  marks?: [x: number, y: number][];
  powers?: number[];
  /** Maximum of y over x, also for their negatives. */
  envelope?: [x: number, most: number][];
  /** Levels of additional dashed lines. */
  dashed?: number[];
  crossed?: number;
}

/** The grid of a quantity. If it jumps, there is a gap where a coordinate changes its sign. */
export function gridOf(xs: number[], ys: number[], values: (number | null)[], jumps: boolean): Grid {
  const crossing = (list: number[], i: number) => list[i] < 0 && list[i + 1] > 0;
  if (!jumps) return { xs, ys, values };
  return { xs, ys, values, cut: (i, j) => crossing(xs, i) || crossing(ys, j) };
}

/** The cell with the best value. */
export function bestCell(values: (number | null)[], best: Best | null): number {
  if (best === null) return -1;
  const sign = best === "highest" ? 1 : -1;
  let found = -1;
  values.forEach((v, k) => {
    if (v !== null && (found < 0 || sign * v > sign * (values[found] as number))) found = k;
  });
  return found;
}

function path(lines: Point[][], sx: Scale, sy: Scale, closed: boolean): string {
  let d = "";
  for (const line of lines) {
    let last = "";
    line.forEach(([x, y], k) => {
      const place = `${sx(x).toFixed(1)},${sy(y).toFixed(1)}`;
      if (place === last) return;
      d += (k === 0 ? "M" : "L") + place;
      last = place;
    });
    if (closed) d += "Z";
  }
  return d;
}

/** Draws a field; returns what the legend has to explain. */
export function drawField(frame: Frame, grid: Grid, look: FieldLook): { hatched: boolean; allOutside: boolean; powers: boolean } {
  const { sx, sy, colours } = look;
  const { xs, ys, values } = grid;
  const clipped = clip(frame);
  const g = svg(frame.svg, "g", { "clip-path": clipped, class: "gl-field" });
  const size = Math.max(xs.length, ys.length);
  const fine = refine(grid, Math.max(1, Math.min(8, Math.round(90 / size))));
  const known = values.filter((v): v is number => v !== null);
  const [low, high] = extent(known);
  // Bands from the bottom up, each covers the ones below it.
  const surface = region(fine, -Infinity);
  let first = 0;
  while (first < colours.levels.length && colours.levels[first] <= low) first++;
  svg(g, "path", { d: path(surface, sx, sy, true), fill: colours.band(first), "fill-rule": "evenodd", stroke: colours.band(first), "stroke-width": 0.6 });
  for (let k = first; k < colours.levels.length && colours.levels[k] < high; k++)
    svg(g, "path", { d: path(region(fine, colours.levels[k]), sx, sy, true), fill: colours.band(k + 1), "fill-rule": "evenodd" });

  // A point without complete neighbours has no surface: it is drawn alone.
  values.forEach((v, k) => {
    const [i, j] = [k % xs.length, Math.floor(k / xs.length)];
    if (v === null || [[i, j], [i - 1, j], [i, j - 1], [i - 1, j - 1]].some(([a, b]) => isCell(grid, a, b))) return;
    svg(frame.svg, "circle", { cx: sx(xs[i]), cy: sy(ys[j]), r: 5, fill: colours.at(v), class: "gl-point" });
  });

  const hatch = hatched(frame, g, grid, look, path(surface, sx, sy, true));

  const drawn: { level: number; line: Point[] }[] = [];
  for (let k = first; k < colours.levels.length && colours.levels[k] < high; k++) {
    const level = colours.levels[k];
    const lines = isolines(fine, level);
    const zero = colours.isDiverging && level === 0;
    const dark = luminance(colours.band(k)) + luminance(colours.band(k + 1)) > 0.5;
    svg(g, "path", { d: path(lines, sx, sy, false), class: "gl-contour", stroke: dark ? "#000" : "#fff", "stroke-opacity": zero ? 0.9 : dark ? 0.5 : 0.6, "stroke-width": zero ? 1.6 : 1 });
    for (const line of lines) drawn.push({ level, line: line.map(([x, y]) => [sx(x), sy(y)]) });
  }
  for (const level of look.dashed ?? [])
    svg(g, "path", { d: path(isolines(fine, level), sx, sy, false), fill: "none", stroke: "#000", "stroke-width": 1.8, "stroke-dasharray": "6 4" });

  const taken: { x: number; y: number; radius: number }[] = [];
  const at = bestCell(values, look.best);
  if (at >= 0) {
    const [x, y] = [sx(xs[at % xs.length]), sy(ys[Math.floor(at / xs.length)])];
    const text = significant(values[at], look.best === "highest" ? 4 : 3);
    const w = textWidth(text, TEXT, 600);
    const right = x + 10 + w < frame.right;
    const ty = Math.min(Math.max(y + 4, frame.top + 13), frame.bottom - 5);
    svg(frame.svg, "path", { d: star(Math.min(Math.max(x, frame.left + 1), frame.right - 1), y, 7), fill: "#fff", stroke: "#000", "stroke-width": 1.2, class: "gl-best" });
    halo(frame.svg, right ? x + 10 : x - 10, ty, text, colours.at(values[at] as number), { "text-anchor": right ? "start" : "end", "font-weight": 600 });
    taken.push({ x: right ? x + 5 + w / 2 : x - 5 - w / 2, y: ty - 4, radius: w / 2 + 14 });
  }
  outline(g, look);
  const powers = (look.powers ?? []).length > 0 && constantPower(frame, g, look, taken);
  marks(g, look, taken);
  if (look.crossed !== undefined && look.crossed < values.length) {
    const [x, y] = [sx(xs[look.crossed % xs.length]), sy(ys[Math.floor(look.crossed / xs.length)])];
    const d = `M${x - 6},${y - 6}L${x + 6},${y + 6}M${x + 6},${y - 6}L${x - 6},${y + 6}`;
    svg(frame.svg, "path", { d, stroke: "#000", "stroke-width": 5 });
    svg(frame.svg, "path", { d, stroke: "#fff", "stroke-width": 2.4 });
    taken.push({ x, y, radius: 12 });
  }
  const name = (level: number) => short(level);
  const places: Label[] = labels(drawn, (level) => textWidth(name(level), TEXT), frame, taken);
  for (const label of places)
    halo(g, label.x, label.y + 4, name(label.level), colours.at(label.level), {
      "text-anchor": "middle",
      class: "gl-level",
      transform: Math.abs(label.angle) < 0.5 ? undefined : `rotate(${label.angle.toFixed(1)} ${label.x.toFixed(1)} ${label.y.toFixed(1)})`,
    });
  return { ...hatch, powers };
}

/** A text that is legible on a ground of any colour. */
export function halo(parent: Element, x: number, y: number, text: string, ground: string, attributes: Record<string, string | number | undefined>): void {
  const light = luminance(ground) > 0.22;
  svg(parent, "text", { x, y, style: `fill: ${light ? "#111" : "#fff"}; stroke: ${ground}; stroke-width: 3.5px; paint-order: stroke`, ...attributes }, text);
}

/** Hatches the surroundings of all nodes outside. */
function hatched(frame: Frame, g: Element, { xs, ys, values }: Grid, look: FieldLook, surface: string): { hatched: boolean; allOutside: boolean } {
  const outside = look.outside ?? [];
  const is = (k: number) => outside[k] === true && values[k] !== null;
  const count = values.filter((_, k) => is(k)).length;
  const all = count > 0 && count === values.filter((v) => v !== null).length;
  if (count === 0 || all) return { hatched: false, allOutside: all };
  const edges = (list: number[]) => {
    const middle = list.slice(1).map((v, i) => 0.5 * (v + list[i]));
    return [list[0], ...middle, list[list.length - 1]];
  };
  const [ex, ey] = [edges(xs), edges(ys)];
  let d = "";
  for (let j = 0; j < ys.length; j++) {
    for (let i = 0; i < xs.length; ) {
      if (!is(j * xs.length + i)) {
        i++;
        continue;
      }
      let end = i;
      while (end + 1 < xs.length && is(j * xs.length + end + 1)) end++;
      const [l, r, t, b] = [look.sx(ex[i]), look.sx(ex[end + 1]), look.sy(ey[j + 1]), look.sy(ey[j])];
      d += `M${l.toFixed(1)},${t.toFixed(1)}H${r.toFixed(1)}V${b.toFixed(1)}H${l.toFixed(1)}Z`;
      i = end + 1;
    }
  }
  // Only where there is a surface.
  const id = unique("gl-surface");
  svg(svg(svg(frame.svg, "defs"), "clipPath", { id }), "path", { d: surface, "clip-rule": "evenodd" });
  const own = svg(g, "g", { "clip-path": `url(#${id})` });
  svg(own, "path", { d, fill: hatching(frame.svg, "rgba(255,255,255,0.45)", 8, 0.9) });
  svg(own, "path", { d, fill: hatching(frame.svg, "rgba(0,0,0,0.55)", 8, 0.5), class: "gl-outside" });
  return { hatched: true, allOutside: false };
}

function marks(g: Element, look: FieldLook, taken: { x: number; y: number; radius: number }[]): void {
  const list = look.marks ?? [];
  const r = 3.2;
  for (const [x, y] of list) {
    const [cx, cy] = [look.sx(x), look.sy(y)];
    svg(g, "circle", { cx, cy, r, fill: "none", stroke: "#fff", "stroke-width": 2.8 });
    svg(g, "circle", { cx, cy, r, fill: "none", stroke: "#000", "stroke-width": 1.3, class: "gl-mark" });
    if (list.length <= 40) taken.push({ x: cx, y: cy, radius: r + 2 });
  }
}

/** The envelope of the points, as far as the axes reach. */
function outline(g: Element, look: FieldLook): void {
  const { sx, sy, envelope = [] } = look;
  for (const along of [1, -1]) {
    for (const side of [1, -1]) {
      const points = envelope.map(([x, most]): Point => [along * x, side * most]);
      const seen = points.some(([x, y]) => x >= sx.low && x <= sx.high && y >= sy.low && y <= sy.high);
      if (!seen) continue;
      const d = "M" + points.map(([x, y]) => `${sx(x).toFixed(1)},${sy(y).toFixed(1)}`).join("L");
      svg(g, "path", { d, fill: "none", stroke: "#fff", "stroke-opacity": 0.7, "stroke-width": 4 });
      svg(g, "path", { d, fill: "none", stroke: "#000", "stroke-width": 1.8, class: "gl-envelope" });
    }
  }
}

/** Lines of constant power: torque times speed. */
function constantPower(frame: Frame, g: Element, look: FieldLook, taken: { x: number; y: number; radius: number }[]): boolean {
  const { sx, sy } = look;
  let any = false;
  for (const power of look.powers ?? []) {
    for (const sign of [1, -1]) {
      const points: Point[] = [];
      for (let p = frame.left; p <= frame.right; p += 2) {
        const x = sx.invert(p);
        if (x <= 0) continue;
        const y = (sign * power * 30) / (Math.PI * x);
        if (y >= sy.low && y <= sy.high) points.push([p, sy(y)]);
      }
      if (points.length < 12) continue;
      any = true;
      const d = "M" + points.map(([x, y]) => `${x.toFixed(1)},${y.toFixed(1)}`).join("L");
      svg(g, "path", { d, fill: "none", stroke: "rgba(255,255,255,0.45)", "stroke-width": 1.8 });
      svg(g, "path", { d, fill: "none", stroke: "#000", "stroke-width": 1.1, "stroke-dasharray": "2 3.5", class: "gl-power" });
      // A narrow picture has room for one label of each power.
      if (sign < 0 && frame.right - frame.left < 320) continue;
      const text = power >= 1000 ? `${short(power / 1000)} kW` : `${short(power)} W`;
      const w = textWidth(text, TEXT);
      const from = Math.floor(0.62 * points.length);
      for (let k = 0; k < points.length; k++) {
        const [x, y] = points[(from + k * 3) % points.length];
        const free = taken.every((b) => Math.hypot(b.x - x, b.y - y) > b.radius + w / 2);
        if (!free || x - w / 2 < frame.left + 4 || x + w / 2 > frame.right - 4 || y < frame.top + 12 || y > frame.bottom - 8) continue;
        svg(g, "rect", { x: x - w / 2 - 3, y: y - 8, width: w + 6, height: 16, rx: 3, fill: "#fff", "fill-opacity": 0.88 });
        svg(g, "text", { x, y: y + 4, "text-anchor": "middle", style: "fill: #111; font-style: italic" }, text);
        taken.push({ x, y, radius: w / 2 + 3 });
        break;
      }
    }
  }
  return any;
}

/** A bar with the colours of all bands and their levels. */
export function colourBar(parent: Element, colours: ColourScale, unit: string, width: number): void {
  const size = Math.min(width, 560);
  const label = unit ? ` ${unit}` : "";
  const element = canvas({ root: parent, width: size }, 34, `colours from ${significant(colours.low)} to ${significant(colours.high)}${label}`);
  element.classList.add("gl-bar");
  const room = unit ? textWidth(unit) + 10 : 4;
  const [left, right] = [textWidth(significant(colours.low, 4)) / 2 + 2, size - room - 22];
  // One value only: it is the label.
  const levels = colours.levels.length ? colours.levels : colours.low === colours.high ? [colours.low] : [];
  const text = (x: number, t: string, anchor = "middle") => svg(element, "text", { x, y: 30, "text-anchor": anchor }, t);
  if (colours.banded) {
    const w = (right - left) / (levels.length + 1);
    if (colours.levels.length === 0) svg(element, "rect", { x: left, y: 4, width: right - left, height: 12, fill: colours.band(0) });
    else for (let k = 0; k <= levels.length; k++) svg(element, "rect", { x: left + k * w, y: 4, width: w + 0.5, height: 12, fill: colours.band(k) });
    let end = -Infinity;
    // From the good end, where the steps are small, every label that fits.
    levels.forEach((level, k) => {
      const [x, t] = [left + (k + 1) * w, short(level)];
      svg(element, "line", { x1: x, x2: x, y1: 4, y2: 19, class: "gl-tick" });
      const half = textWidth(t) / 2;
      if (x - half < end + 7) return;
      text(x, t);
      end = x + half;
    });
  } else {
    const steps = 60;
    for (let k = 0; k < steps; k++) {
      const value = colours.low + ((k + 0.5) / steps) * (colours.high - colours.low);
      svg(element, "rect", { x: left + (k * (right - left)) / steps, y: 4, width: (right - left) / steps + 0.5, height: 12, fill: colours.at(value) });
    }
    let end = -Infinity;
    for (const level of levels) {
      const share = colours.high > colours.low ? (level - colours.low) / (colours.high - colours.low) : 0.5;
      const x = left + share * (right - left);
      svg(element, "line", { x1: x, x2: x, y1: 4, y2: 19, class: "gl-tick" });
      const half = textWidth(short(level)) / 2;
      if (x - half < end + 7) continue;
      text(x, short(level));
      end = x + half;
    }
  }
  svg(element, "rect", { x: left, y: 4, width: right - left, height: 12, class: "gl-frame" });
  if (unit) svg(element, "text", { x: right + 8, y: 14 }, unit);
}

