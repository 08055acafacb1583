// Stacked bars, upright if their labels fit, otherwise one below the other.

import { PALETTE } from "./colours.ts";
import { axisNumbers, grouped, significant, unitOf, withUnit, words } from "./format.ts";
import { ticks } from "./levels.ts";
import { Entry, Stage, Tooltip, canvas, fitted, hatching, leftMargin, legend, rowAxis, scale, svg, textWidth } from "./svg.ts";
import type { Bars } from "./types.ts";

export function drawBars(stage: Stage, data: Bars): void {
  const { names } = data;
  // A value that is not finite arrives as null.
  const bars = data.bars.map((b) => ({ ...b, shares: b.shares.map((s) => s ?? 0) }));
  const measured = bars.some((b) => b.measured);
  const used = names.filter((_, k) => bars.some((b) => (b.shares[k] ?? 0) !== 0));
  const highest = Math.max(1e-12, ...bars.map((b) => Math.max(sum(b.shares.filter((s) => s > 0)), b.measured ? b.measured[0] + b.measured[1] : 0)));
  const lowest = Math.min(0, ...bars.map((b) => sum(b.shares.filter((s) => s < 0))));
  const lines = bars.map((b) => words(b.label).split("\n").map(grouped));
  const widest = Math.max(0, ...lines.flat().map((t) => textWidth(t)), ...bars.map((b) => textWidth(words(b.above))));
  const slot = (stage.width - 70) / Math.max(1, bars.length);
  const upright = slot >= Math.max(22, widest + 8);
  // A single share that is no component needs no colour of its own.
  const component = (name: string) => (names.length === 1 && !stage.components.has(name) ? PALETTE[0] : stage.components.colour(name));
  const unit = unitOf(data.height);
  const tip = new Tooltip(stage.root);
  const describe = (k: number, event: PointerEvent) => {
    const bar = bars[k];
    const total = sum(bar.shares);
    const rows: { name: string; value: string; colour?: string; strong?: boolean }[] = names
      .map((name, n) => ({ name, share: bar.shares[n] ?? 0 }))
      .filter((r) => r.share !== 0)
      .reverse()
      .map((r) => ({ name: r.name, value: `${withUnit(significant(r.share, 3), unit)}${total > 0 && names.length > 1 ? `, ${significant((100 * r.share) / total, 2)} %` : ""}`, colour: component(r.name) }));
    if (names.length > 1) rows.push({ name: "total", value: withUnit(significant(total, 4), unit), strong: true });
    if (bar.measured) rows.push({ name: "measured", value: withUnit(`${significant(bar.measured[0], 4)} ± ${significant(bar.measured[1], 2)}`, unit), strong: true });
    if (bar.above) rows.push({ name: "", value: bar.above });
    tip.show({ head: bar.label.replace(/\n/g, ", "), rows }, event.clientX, event.clientY);
  };
  if (upright) {
    const below = 8 + 15 * Math.max(1, ...lines.map((l) => l.length)) + (data.over ? 20 : 0);
    const height = stage.height ?? Math.round(Math.min(0.55 * stage.width, 380));
    const [low, high] = [lowest < 0 ? 1.05 * lowest : 0, 1.1 * highest];
    const [left, top, right, bottom] = [leftMargin(low, high, height - below - 26), 26, stage.width - 10, height - below];
    const element = canvas(stage, height, data.title);
    const sy = scale(low, high, bottom, top);
    const marks = ticks(low, high, Math.max(2, (bottom - top) / 44));
    axisNumbers(marks).forEach((text, k) => {
      const y = sy(marks[k]);
      svg(element, "line", { x1: left, x2: right, y1: y, y2: y, class: marks[k] === 0 ? "gl-zero" : "gl-grid" });
      svg(element, "text", { x: left - 7, y: y + 4, "text-anchor": "end" }, text);
    });
    svg(element, "text", { x: 2, y: top - 10, class: "gl-name" }, words(data.height));
    if (data.over) svg(element, "text", { x: 0.5 * (left + right), y: height - 4, "text-anchor": "middle", class: "gl-name" }, words(data.over));
    const w = (right - left) / Math.max(1, bars.length);
    const thick = Math.min(90, 0.76 * w);
    bars.forEach((bar, k) => {
      const middle = left + (k + 0.5) * w;
      const group = svg(element, "g", { class: "gl-bar-group" });
      svg(group, "rect", { x: left + k * w, y: top, width: w, height: bottom - top, fill: "transparent" });
      const [x, own] = measured ? [middle - thick / 2, 0.56 * thick] : [middle - thick / 2, thick];
      stack(group, names, bar.shares, component, (a, b) => ({ x, width: own, y: Math.min(sy(a), sy(b)), height: Math.abs(sy(a) - sy(b)) }), stage, element);
      const topOf = sum(bar.shares.filter((s) => s > 0));
      const text = fitted(words(bar.above), w - 2);
      // Beside a reference bar the text ends where its own bar ends, unless there is no room to the left.
      const beside = bar.measured !== null && textWidth(text) > own && textWidth(text) < x + own - left;
      if (text) svg(group, "text", { x: beside ? x + own : x + own / 2, y: sy(topOf) - 5, "text-anchor": beside ? "end" : "middle" }, text);
      if (bar.measured) {
        const [value, error] = bar.measured;
        const [mx, mw] = [x + own + 2, thick - own - 2];
        svg(group, "rect", { x: mx, y: sy(value), width: mw, height: sy(0) - sy(value), class: "gl-measured" });
        const c = mx + mw / 2;
        svg(group, "path", { d: `M${c},${sy(value - error).toFixed(1)}V${sy(value + error).toFixed(1)}M${c - 4},${sy(value - error).toFixed(1)}h8M${c - 4},${sy(value + error).toFixed(1)}h8`, class: "gl-error" });
        const above = fitted(words(bar.above_measured), w / 2 + 4);
        if (above) svg(group, "text", { x: c, y: sy(value + error) - 5, "text-anchor": "middle" }, above);
      }
      lines[k].forEach((text, n) => svg(group, "text", { x: middle, y: bottom + 17 + 15 * n, "text-anchor": "middle" }, text));
      group.addEventListener("pointermove", (event) => describe(k, event));
      group.addEventListener("pointerleave", () => tip.hide());
    });
  } else {
    const flat = lines.map((l) => l.join(", "));
    const room = Math.min(Math.max(0, ...flat.map((t) => textWidth(t))) + 12, 0.42 * stage.width);
    const usual = bars.length > 24 ? 18 : 26;
    // A given height is filled, within limits.
    const line = stage.height ? Math.max(15, Math.min(46, (stage.height - 64) / Math.max(1, bars.length))) : usual;
    const aboveRoom = Math.max(0, ...bars.map((b) => Math.max(textWidth(words(b.above)), textWidth(words(b.above_measured))))) + 10;
    const [left, right, top] = [room, Math.max(room + 80, stage.width - 12 - aboveRoom), data.over ? 20 : 8];
    const bottom = top + line * bars.length;
    const height = bottom + 40;
    const element = canvas(stage, height, data.title);
    const sx = rowAxis(element, lowest, 1.03 * highest, left, right, top, bottom, data.height);
    if (data.over) svg(element, "text", { x: 2, y: 12, class: "gl-name" }, words(data.over));
    bars.forEach((bar, k) => {
      const y = top + k * line;
      const group = svg(element, "g", { class: "gl-bar-group" });
      svg(group, "rect", { x: 0, y, width: stage.width, height: line, fill: "transparent" });
      svg(group, "text", { x: left - 7, y: y + line / 2 + 4, "text-anchor": "end" }, fitted(flat[k], room - 10));
      const [y0, h] = measured ? [y + 3, 0.55 * (line - 6)] : [y + 3, line - 6];
      stack(group, names, bar.shares, component, (a, b) => ({ x: Math.min(sx(a), sx(b)), width: Math.abs(sx(b) - sx(a)), y: y0, height: h }), stage, element);
      let end = sum(bar.shares.filter((s) => s > 0));
      if (bar.measured) {
        const [value, error] = bar.measured;
        const [my, mh] = [y0 + h + 1, line - 7 - h];
        svg(group, "rect", { x: sx(0), y: my, width: sx(value) - sx(0), height: mh, class: "gl-measured" });
        const c = my + mh / 2;
        svg(group, "path", { d: `M${sx(value - error).toFixed(1)},${c}H${sx(value + error).toFixed(1)}`, class: "gl-error" });
        end = Math.max(end, value + error);
      }
      const above = [bar.above, bar.above_measured].filter(Boolean).join(" / ");
      if (above) svg(group, "text", { x: sx(end) + 6, y: y + line / 2 + 4 }, fitted(words(above), stage.width - sx(end) - 6));
      group.addEventListener("pointermove", (event) => describe(k, event));
      group.addEventListener("pointerleave", () => tip.hide());
    });
  }
  const entries = used.map((name): Entry => ({ name, colour: component(name), mark: "box", pattern: names.length > 1 && stage.components.repeated(name) }));
  if (entries.length === 1 && words(data.height).toLowerCase().includes(entries[0].name.toLowerCase())) entries.pop();
  if (measured) entries.push({ name: "measured or reference, with accuracy", mark: "outline" });
  legend(stage.root, entries, stage.root);
}

const sum = (list: number[]) => list.reduce((a, b) => a + b, 0);

function stack(
  group: Element,
  names: string[],
  shares: number[],
  colour: (name: string) => string,
  box: (from: number, to: number) => { x: number; y: number; width: number; height: number },
  stage: Stage,
  element: SVGSVGElement,
): void {
  let [up, down] = [0, 0];
  shares.forEach((share, n) => {
    if (!share) return;
    const from = share > 0 ? up : down;
    const to = from + share;
    if (share > 0) up = to;
    else down = to;
    const place = box(from, to);
    const name = names[n] ?? "";
    svg(group, "rect", { ...place, fill: colour(name), class: "gl-share", "data-line": name });
    if (names.length > 1 && stage.components.repeated(name)) svg(group, "rect", { ...place, fill: hatching(element, "rgba(255,255,255,0.7)", 7, 0.8), "data-line": name });
  });
}
