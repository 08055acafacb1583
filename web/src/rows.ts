// Pictures with one row for each thing: intervals and effects; and the losses between input and output.

import { PALETTE } from "./colours.ts";
import { axisNumbers, nameOf, significant, unitOf, withUnit, words } from "./format.ts";
import { ticks } from "./levels.ts";
import { Entry, Stage, Tooltip, canvas, fitted, legend, leftMargin, rowAxis, scale, svg, textWidth } from "./svg.ts";
import type { Intervals, Tornado, Waterfall } from "./types.ts";

/** Room for the names of rows. */
function room(stage: Stage, names: string[]): number {
  return Math.min(Math.max(40, ...names.map((n) => textWidth(words(n)))) + 12, 0.38 * stage.width);
}

/** Height of a row; the rows fill a given height. */
function rowHeight(stage: Stage, count: number, usual: number): number {
  return stage.height ? Math.max(20, Math.min(120, (stage.height - 64) / Math.max(1, count))) : usual;
}

export function drawIntervals(stage: Stage, given: Intervals): void {
  const data = { ...given, list: given.list.filter((i) => i.at !== null) };
  const places = [...data.list.flatMap((i) => [i.at, ...(i.ends ?? []), ...(i.before === null ? [] : [i.before])]), ...data.marks].filter(Number.isFinite);
  const [low, high] = places.length ? [Math.min(...places), Math.max(...places)] : [0, 1];
  const margin = 0.04 * (high - low || 1);
  const left = room(stage, data.list.map((i) => i.name));
  const line = rowHeight(stage, data.list.length, 28);
  const [right, top] = [stage.width - 16, 8];
  const bottom = top + line * Math.max(1, data.list.length);
  const element = canvas(stage, bottom + 40, data.title);
  const sx = rowAxis(element, low - margin, high + margin, left, right, top, bottom, data.x);
  for (const mark of data.marks) svg(element, "line", { x1: sx(mark), x2: sx(mark), y1: top, y2: bottom, class: "gl-bound" });
  const tip = new Tooltip(stage.root);
  const colour = PALETTE[0];
  data.list.forEach((interval, k) => {
    const y = top + (k + 0.5) * line;
    const group = svg(element, "g");
    svg(group, "rect", { x: 0, y: y - line / 2, width: stage.width, height: line, fill: "transparent" });
    const name = svg(group, "text", { x: left - 8, y: y + 4, "text-anchor": "end" }, fitted(words(interval.name), left - 12));
    svg(name, "title", {}, interval.name);
    if (interval.ends) {
      const [a, b] = interval.ends.map(sx);
      svg(group, "path", { d: `M${a.toFixed(1)},${y}H${b.toFixed(1)}M${a.toFixed(1)},${y - 5}v10M${b.toFixed(1)},${y - 5}v10`, stroke: colour, "stroke-width": 2.6, fill: "none" });
    }
    if (interval.before !== null) svg(group, "circle", { cx: sx(interval.before), cy: y, r: 5, fill: "none", stroke: PALETTE[5], "stroke-width": 2 });
    svg(group, "circle", { cx: sx(interval.at), cy: y, r: 5, fill: colour });
    group.addEventListener("pointermove", (event) => {
      const rows = [{ name: data.key[0], value: significant(interval.at, 4), strong: true }];
      if (interval.ends) rows.push({ name: "95 %", value: `${significant(interval.ends[0], 4)} to ${significant(interval.ends[1], 4)}`, strong: false });
      if (interval.before !== null) rows.push({ name: data.key[1], value: significant(interval.before, 4), strong: false });
      tip.show({ head: interval.name, rows }, event.clientX, event.clientY);
    });
    group.addEventListener("pointerleave", () => tip.hide());
  });
  const entries: Entry[] = [{ name: data.list.some((i) => i.ends) ? `${data.key[0]}, 95 %` : data.key[0], colour, mark: "bar" }];
  if (data.list.some((i) => i.before !== null)) entries.push({ name: data.key[1], colour: PALETTE[5], mark: "ring" });
  if (data.marks.length) entries.push({ name: data.key[2], mark: "dashed" });
  legend(stage.root, entries);
}

export function drawTornado(stage: Stage, data: Tornado): void {
  const unit = unitOf(data.x);
  const results = data.bars.flatMap((b) => b.results);
  const [low, high] = [Math.min(data.base, ...results), Math.max(data.base, ...results)];
  const left = room(stage, data.bars.map((b) => b.name));
  const line = rowHeight(stage, data.bars.length, 27);
  const top = 24;
  const bottom = top + line * Math.max(1, data.bars.length);
  const element = canvas(stage, bottom + 40, data.title);
  // Room for the texts at the outer ends of the bars.
  const right = stage.width - 10;
  const reach = (side: number) => Math.max(0, ...data.bars.map((b) => b.results.map((r, k) => ((side < 0 ? r < data.base : r > data.base) ? textWidth(words(b.ends[k])) : 0))).flat()) + 8;
  const [roomLow, roomHigh] = [Math.min(reach(-1), 0.2 * (right - left)), Math.min(reach(1), 0.2 * (right - left))];
  const perPixel = (high - low || 1) / Math.max(40, right - left - roomLow - roomHigh);
  const sx = rowAxis(element, low - roomLow * perPixel, high + roomHigh * perPixel, left, right, top, bottom, data.x);
  const colours = [PALETTE[0], PALETTE[1]];
  const tip = new Tooltip(stage.root);
  data.bars.forEach((bar, k) => {
    const y = top + k * line;
    const group = svg(element, "g");
    svg(group, "rect", { x: 0, y, width: stage.width, height: line, fill: "transparent" });
    const name = svg(group, "text", { x: left - 8, y: y + line / 2 + 4, "text-anchor": "end" }, fitted(words(bar.name), left - 12));
    svg(name, "title", {}, bar.name);
    // The longer bar first, so that both are seen if they point to the same side.
    const order = [0, 1].sort((a, b) => Math.abs(bar.results[b] - data.base) - Math.abs(bar.results[a] - data.base));
    const sameSide = (bar.results[0] - data.base) * (bar.results[1] - data.base) > 0;
    order.forEach((end, n) => {
      const [a, b] = [sx(data.base), sx(bar.results[end])];
      const thin = sameSide && n === 1 ? 4 : 0;
      svg(group, "rect", { x: Math.min(a, b), y: y + 0.18 * line + thin, width: Math.max(1, Math.abs(b - a)), height: 0.64 * line - 2 * thin, fill: colours[end] });
      if (sameSide && n === 1) return;
      const before = b < a;
      svg(group, "text", { x: b + (before ? -5 : 5), y: y + line / 2 + 4, "text-anchor": before ? "end" : "start" }, fitted(words(bar.ends[end]), before ? b - left : stage.width - b - 6));
    });
    group.addEventListener("pointermove", (event) => {
      const rows = [0, 1].map((end) => ({ name: bar.ends[end], value: `${withUnit(significant(bar.results[end], 4), unit)} (${bar.results[end] >= data.base ? "+" : ""}${significant(bar.results[end] - data.base, 3)})`, colour: colours[end] }));
      tip.show({ head: bar.name, rows }, event.clientX, event.clientY);
    });
    group.addEventListener("pointerleave", () => tip.hide());
  });
  svg(element, "line", { x1: sx(data.base), x2: sx(data.base), y1: top - 4, y2: bottom, class: "gl-base" });
  const text = `${significant(data.base, 4)}${unit ? ` ${words(unit)}` : ""}`;
  svg(element, "text", { x: sx(data.base), y: top - 9, "text-anchor": "middle", class: "gl-strong" }, text);
  legend(stage.root, [
    { name: "at the lower end", colour: colours[0], mark: "box" },
    { name: "at the upper end", colour: colours[1], mark: "box" },
  ]);
}

/** Losses in the order of a waterfall: the largest first, what does not fit together as one step. */
export function steps(losses: Waterfall["losses"], most: number): { name: string; group: string; value: number; parts: number }[] {
  const sorted = losses.filter((l) => l[2] !== 0).map(([name, group, value]) => ({ name, group, value, parts: 1 })).sort((a, b) => b.value - a.value);
  if (sorted.length <= most) return sorted;
  const rest = sorted.splice(most - 1);
  sorted.push({ name: `${rest.length} others`, group: "", value: rest.reduce((sum, r) => sum + r.value, 0), parts: rest.length });
  return sorted;
}

export function drawWaterfall(stage: Stage, data: Waterfall): void {
  const [[inName, input], [outName, output]] = data.ends;
  const list = steps(data.losses, Math.max(4, Math.floor((stage.width - 150) / 26)));
  const total = list.reduce((sum, s) => sum + s.value, 0);
  const unit = words(data.unit);
  const names = list.map((s) => words(s.name));
  const columns = list.length + 2;
  const high = 1.02 * Math.max(total, 1e-12);
  // Depth below the input; the ends continue below the scale.
  const cut = 0.16;
  const left = leftMargin(-total, 0, 260);
  const right = stage.width - 8;
  const endWidth = Math.max(52, Math.min(84, (right - left) / columns));
  const w = (right - left - 2 * endWidth) / Math.max(1, list.length);
  const turned = names.some((n) => textWidth(n) > w - 4);
  const below = turned ? Math.min(120, Math.max(...names.map((n) => textWidth(n)), 30) * 0.78 + 22) : 26;
  const plot = Math.round(stage.height ? Math.max(160, stage.height - below - 60) : Math.min(0.46 * stage.width, 320));
  const [top, bottom] = [56, 56 + plot];
  const element = canvas(stage, bottom + below + 4, data.title);
  const sy = scale(0, -high * (1 + cut), top, bottom);
  const marks = ticks(-high, 0, Math.max(2, plot / 44));
  axisNumbers(marks).forEach((text, k) => {
    const y = sy(marks[k]);
    svg(element, "line", { x1: left, x2: right, y1: y, y2: y, class: "gl-grid" });
    svg(element, "text", { x: left - 7, y: y + 4, "text-anchor": "end" }, text);
  });
  svg(element, "text", { x: 2, y: 12, class: "gl-name" }, `below the input in ${unit}`);
  const groups = [...new Set(list.map((s) => s.group).filter(Boolean))];
  const colour = (step: { group: string; name: string }) => (step.group ? stage.components.colour(step.group) : "var(--gl-soft)");
  const tip = new Tooltip(stage.root);
  const share = (v: number) => `${significant((100 * v) / (input || 1), 3)} %`;
  const end = (x: number, from: number, name: string, value: number) => {
    const width = endWidth * 0.72;
    const y = sy(from);
    // A torn lower edge shows that the bar continues.
    const teeth = 6;
    let d = `M${x},${y.toFixed(1)}H${x + width}V${bottom - 6}`;
    for (let k = 0; k < teeth; k++) d += `L${(x + width - ((k + 0.5) * width) / teeth).toFixed(1)},${bottom}L${(x + width - ((k + 1) * width) / teeth).toFixed(1)},${bottom - 6}`;
    const group = svg(element, "g");
    svg(group, "path", { d: d + "Z", class: "gl-end" });
    const middle = x + width / 2;
    const first = x < 0.5 * stage.width;
    svg(group, "text", { x: first ? x : x + width, y: top - 7, "text-anchor": first ? "start" : "end", class: "gl-strong" }, fitted(`${significant(value, 5)} ${unit}`, 160));
    if (!first) {
      // The space above the output is free: its text stands there, with a line down to the bar.
      svg(group, "text", { x: x + width, y: top + 10, "text-anchor": "end" }, `loss ${significant(total, 3)} ${unit}, ${share(total)}`);
      svg(group, "line", { x1: middle, x2: middle, y1: top + 16, y2: y - 3, class: "gl-link" });
    }
    svg(group, "text", { x: middle, y: bottom + 17, "text-anchor": "middle" }, fitted(words(name), endWidth + 4));
  };
  end(left + 2, 0, inName, input);
  let depth = 0;
  list.forEach((step, k) => {
    const x = left + endWidth + k * w;
    const [a, b] = [sy(-depth), sy(-depth - step.value)];
    const group = svg(element, "g", { "data-line": step.group });
    svg(group, "rect", { x, y: top - 10, width: w, height: bottom - top + 10, fill: "transparent" });
    svg(group, "rect", { x: x + 0.1 * w, y: Math.min(a, b), width: 0.8 * w, height: Math.max(1.2, Math.abs(b - a)), fill: colour(step) });
    svg(element, "line", { x1: x - 0.1 * w, x2: x + 0.9 * w, y1: a, y2: a, class: "gl-link" });
    const text = significant(step.value, 3);
    if (textWidth(text) <= w + 10 && (k === 0 || w > 26)) svg(group, "text", { x: x + w / 2, y: Math.max(a, b) + 15, "text-anchor": "middle" }, text);
    const name = names[k];
    if (turned) {
      const [tx, ty] = [x + w / 2 + 4, bottom + 14];
      svg(group, "text", { x: tx, y: ty, "text-anchor": "end", transform: `rotate(-50 ${tx.toFixed(1)} ${ty})` }, fitted(name, 140));
    } else svg(group, "text", { x: x + w / 2, y: bottom + 17, "text-anchor": "middle" }, name);
    const from = depth;
    group.addEventListener("pointermove", (event) => {
      const rows = [
        { name: step.group || "together", value: withUnit(significant(step.value, 4), data.unit), strong: true },
        { name: "of the losses", value: `${significant((100 * step.value) / (total || 1), 3)} %` },
        { name: `of the ${nameOf(inName) || "input"}`, value: share(step.value) },
        { name: "sum so far", value: withUnit(significant(from + step.value, 4), data.unit) },
      ];
      tip.show({ head: step.name, rows }, event.clientX, event.clientY);
    });
    group.addEventListener("pointerleave", () => tip.hide());
    depth += step.value;
  });
  const last = right - endWidth * 0.76;
  svg(element, "line", { x1: left + endWidth + list.length * w - 0.1 * w, x2: last + 4, y1: sy(-depth), y2: sy(-depth), class: "gl-link" });
  end(last, -depth, outName, output);
  legend(
    stage.root,
    groups.map((g): Entry => ({ name: g, colour: stage.components.colour(g), mark: "box", pattern: stage.components.repeated(g) })),
    element,
  );
}

