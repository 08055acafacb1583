// Lines over one coordinate, several panes of them, and stacked areas.

import { Look, lineLooks } from "./colours.ts";
import { nameOf, significant, unitOf, withUnit } from "./format.ts";
import { nice } from "./levels.ts";
import { place } from "./map.ts";
import { Entry, Frame, Scale, Stage, Tooltip, axes, canvas, clip, html, leftMargin, legend, onScreen, pointer, svg } from "./svg.ts";
import type { Areas, Line, Lines, Panes } from "./types.ts";

/** Dashes of lines that have the colour of another one. */
const DASHES = ["", "7 4", "2 3", "8 3 2 3"];

function span(lines: Line[], k: 0 | 1, within?: [number, number]): [number, number] | null {
  let [low, high] = [Infinity, -Infinity];
  for (const line of lines)
    for (const p of line.points) {
      if (!p || (within && (p[0] < within[0] || p[0] > within[1]))) continue;
      low = Math.min(low, p[k]);
      high = Math.max(high, p[k]);
    }
  return low <= high ? [low, high] : null;
}

/** Ends of a vertical axis; zero belongs to it if it is near. */
function verticalEnds(ends: [number, number] | null): [number, number] {
  if (!ends) return [0, 1];
  let [low, high] = ends;
  if (low > 0 && low < 0.35 * high) low = 0;
  if (high < 0 && high > 0.35 * low) high = 0;
  return nice(low, high, 8);
}

/** True if the points of a line ascend, so that a cursor finds one value for each place. */
function ascends(line: Line): boolean {
  let last = -Infinity;
  for (const p of line.points) {
    if (!p) continue;
    if (p[0] < last) return false;
    last = p[0];
  }
  return true;
}

interface Pane {
  name: string;
  lines: Line[];
}

export function drawLines(stage: Stage, lines: Lines): void {
  panes(stage, lines.title, lines.x, [{ name: lines.y, lines: lines.lines }], false);
}

export function drawPanes(stage: Stage, data: Panes): void {
  panes(stage, data.title, data.x, data.panes.map((p) => ({ name: p.y, lines: p.lines })), true);
}

function panes(stage: Stage, title: string, xName: string, given: Pane[], several: boolean): void {
  // A value that is not finite arrives as null.
  const known = (p: Line["points"][number]) => (p && p[0] !== null && p[1] !== null ? p : null);
  const list = given.map((p) => ({ ...p, lines: p.lines.map((l) => ({ ...l, points: l.points.map(known) })) }));
  const { root, state } = stage;
  const all = list.flatMap((p) => p.lines);
  const names = [...new Set(all.map((l) => l.name))];
  // A line alone in its pane is named by the axis.
  const shownNames = several ? [...new Set(list.filter((p) => p.lines.length > 1).flatMap((p) => p.lines.map((l) => l.name)))] : names;
  const assigned = lineLooks(shownNames.length ? shownNames : names, stage.components, stage.series);
  const looks = new Map(names.map((name): [string, Look] => [name, { colour: "var(--gl-accent)", round: 0 }]));
  (shownNames.length ? shownNames : names).forEach((name, k) => looks.set(name, assigned[k]));
  const colours = new Map([...looks].map(([name, look]) => [name, look.colour]));
  const dash = (name: string) => DASHES[looks.get(name)!.round % DASHES.length];
  const whole = span(all, 0) ?? [0, 1];
  const zoom = state.zoom as [number, number] | undefined;
  const pad = whole[1] > whole[0] ? 0 : Math.abs(whole[0]) * 0.05 || 1;
  const dotted = !several && all.some((l) => l.stroke === "dots");
  const x: [number, number] = zoom ?? (pad || !dotted ? [whole[0] - pad, whole[1] + pad] : padded(whole));
  const each = several ? Math.max(stage.height ? 45 : 110, Math.min(150, (stage.height ?? 420) / Math.max(1, list.length))) : (stage.height ?? Math.round(Math.min(0.58 * stage.width, 400))) - 68;
  const gap = 26;
  const height = 26 + list.length * each + (list.length - 1) * gap + 42;
  const element = canvas(stage, height, title);
  const ends = list.map((p) => verticalEnds(span(p.lines, 1, zoom)));
  const left = Math.max(...ends.map((e) => leftMargin(...e, each)));
  const drawn: { frame: Frame; sx: Scale; sy: Scale; lines: Line[]; name: string }[] = [];
  list.forEach((pane, k) => {
    const top = 26 + k * (each + gap);
    const frame: Frame = { svg: element, left, top, right: stage.width - 22, bottom: top + each };
    const last = k === list.length - 1;
    const { sx, sy } = axes(frame, { low: x[0], high: x[1], name: last ? xName : "", numbers: last }, { low: ends[k][0], high: ends[k][1], name: pane.name });
    const g = svg(element, "g", { "clip-path": clip(frame, 4) });
    for (const line of pane.lines) strokes(g, line, colours.get(line.name)!, dash(line.name), sx, sy);
    drawn.push({ frame, sx, sy, lines: pane.lines, name: pane.name });
  });
  // A single line that is named by its axis needs no legend.
  const single = !several && names.length === 1 && list[0].name.toLowerCase().includes(names[0].toLowerCase());
  if (!single)
    legend(
      root,
      shownNames.map((name): Entry => {
        const line = all.find((l) => l.name === name)!;
        return { name, colour: colours.get(name)!, mark: line.stroke === "dots" ? "dot" : "line", dash: dash(name) };
      }),
      element,
    );
  cursor(stage, element, drawn, xName, colours, x, zoom !== undefined);
}

function padded([low, high]: [number, number]): [number, number] {
  const margin = 0.03 * (high - low);
  return [low >= 0 && low < 0.2 * high ? 0 : low - margin, high + margin];
}

function strokes(g: Element, line: Line, colour: string, dash: string, sx: Scale, sy: Scale): void {
  let d = "";
  let dots = "";
  let open = false;
  line.points.forEach((p, k) => {
    if (!p) {
      open = false;
      return;
    }
    const at = `${sx(p[0]).toFixed(1)},${sy(p[1]).toFixed(1)}`;
    const alone = !open && !line.points[k + 1];
    d += (open ? "L" : "M") + at;
    if (line.stroke !== "line" || alone) dots += `M${at}h0`;
    open = true;
  });
  const name = { "data-line": line.name };
  if (line.stroke !== "dots") svg(g, "path", { d, fill: "none", stroke: colour, "stroke-width": 2, "stroke-linejoin": "round", "stroke-dasharray": dash || undefined, ...name });
  if (dots) svg(g, "path", { d: dots, fill: "none", stroke: colour, "stroke-width": line.stroke === "dots" ? 6 : 6.5, "stroke-opacity": line.points.length > 300 ? 0.6 : 0.95, "stroke-linecap": "round", ...name });
}

/** Cursor, tooltip and zoom of panes with a common coordinate. */
function cursor(
  stage: Stage,
  element: SVGSVGElement,
  drawn: { frame: Frame; sx: Scale; sy: Scale; lines: Line[]; name: string }[],
  xName: string,
  colours: Map<string, string>,
  x: [number, number],
  zoomed: boolean,
): void {
  if (drawn.length === 0) return;
  const { root, state } = stage;
  const tip = new Tooltip(root);
  const [first, last] = [drawn[0].frame, drawn[drawn.length - 1].frame];
  const { sx } = drawn[0];
  const most = (dots: boolean) => Math.max(0, ...drawn.flatMap((p) => p.lines.filter((l) => (l.stroke === "dots") === dots).map((l) => l.points.length)));
  // A line through many points, as in a parity diagram, is only a guide: there the nearest point counts.
  const shared = most(false) >= most(true) / 4 && drawn.every((p) => p.lines.every((l) => l.stroke === "dots" || ascends(l))) && drawn.some((p) => p.lines.some((l) => l.stroke !== "dots"));
  const rule = svg(element, "line", { y1: first.top, y2: last.bottom, class: "gl-cursor", visibility: "hidden" });
  const ring = svg(element, "circle", { r: 6, class: "gl-ring", visibility: "hidden" });
  const box = svg(element, "rect", { y: first.top, height: last.bottom - first.top, class: "gl-zoom", visibility: "hidden" });
  const hide = () => {
    tip.hide();
    rule.setAttribute("visibility", "hidden");
    ring.setAttribute("visibility", "hidden");
  };
  const showAt = (place_: number, clientX: number, clientY: number) => {
    // The nearest place at which a line has a point.
    let near: number | null = null;
    for (const { lines } of drawn)
      for (const line of lines) {
        if (line.stroke === "dots") continue;
        const p = nearest(line, place_);
        if (p && (near === null || Math.abs(p[0] - place_) < Math.abs(near - place_))) near = p[0];
      }
    if (near === null) return hide();
    const px = sx(near).toFixed(1);
    rule.setAttribute("x1", px);
    rule.setAttribute("x2", px);
    rule.setAttribute("visibility", "visible");
    const reach = 0.5 * ((x[1] - x[0]) / Math.max(8, (first.right - first.left) / 12));
    const rows = drawn.flatMap(({ lines, name }) =>
      lines.flatMap((line) => {
        const value = line.stroke === "dots" ? withinReach(line, near!, reach) : between(line, near!);
        if (value === null) return [];
        const label = drawn.length > 1 && lines.length === 1 ? nameOf(name) : line.name || nameOf(name);
        return [{ name: label, value: withUnit(significant(value, 4), unitOf(name)), colour: colours.get(line.name) }];
      }),
    );
    const at = place(xName, near);
    tip.show({ head: `${at.name} ${at.value}`, rows: rows.slice(0, 24) }, clientX, clientY);
  };
  const showNearest = (px: number, py: number) => {
    let found: { line: Line; p: [number, number]; pane: (typeof drawn)[number] } | null = null;
    let least = 28;
    for (const pane of drawn)
      for (const line of pane.lines)
        for (const p of line.points) {
          if (!p) continue;
          const d = Math.hypot(pane.sx(p[0]) - px, pane.sy(p[1]) - py);
          if (d < least) [found, least] = [{ line, p, pane }, d];
        }
    if (!found) return hide();
    const { line, p, pane } = found;
    const [cx, cy] = [pane.sx(p[0]), pane.sy(p[1])];
    ring.setAttribute("cx", cx.toFixed(1));
    ring.setAttribute("cy", cy.toFixed(1));
    ring.setAttribute("visibility", "visible");
    const value = { name: nameOf(pane.name), value: withUnit(significant(p[1], 4), unitOf(pane.name)) };
    tip.show({ head: line.name, rows: [place(xName, p[0]), value] }, ...onScreen(element, cx, cy));
  };
  let from: number | null = null;
  element.addEventListener("pointerdown", (event) => {
    const [px, py] = pointer(element, event);
    if (event.button === 0 && event.pointerType !== "touch" && px >= first.left && px <= first.right && py >= first.top && py <= last.bottom) from = px;
  });
  element.addEventListener("pointermove", (event) => {
    const [px, py] = pointer(element, event);
    if (from !== null) {
      const to = Math.max(first.left, Math.min(first.right, px));
      box.setAttribute("x", Math.min(from, to).toFixed(1));
      box.setAttribute("width", Math.abs(to - from).toFixed(1));
      box.setAttribute("visibility", Math.abs(to - from) > 4 ? "visible" : "hidden");
    }
    if (px < first.left - 6 || px > first.right + 6 || py < first.top || py > last.bottom) return hide();
    if (shared) showAt(sx.invert(px), event.clientX, event.clientY);
    else showNearest(px, py);
  });
  element.addEventListener("pointerup", (event) => {
    const [px] = pointer(element, event);
    const start = from;
    from = null;
    box.setAttribute("visibility", "hidden");
    const to = Math.max(first.left, Math.min(first.right, px));
    if (start === null || Math.abs(to - start) < 8) return;
    state.zoom = [Math.min(start, to), Math.max(start, to)].map((p) => sx.invert(p));
    stage.again();
  });
  const reset = () => {
    if (state.zoom === undefined) return;
    delete state.zoom;
    stage.again();
  };
  element.addEventListener("dblclick", reset);
  element.addEventListener("pointerleave", () => {
    from = null;
    box.setAttribute("visibility", "hidden");
    hide();
  });
  if (zoomed) {
    const button = html(root, "button", { type: "button", class: "gl-reset" }, "Show all");
    button.addEventListener("click", reset);
  }
  if (!shared) return;
  element.setAttribute("tabindex", "0");
  element.addEventListener("blur", hide);
  const places = [...new Set(drawn.flatMap((p) => p.lines.flatMap((l) => l.points.flatMap((q) => (q && q[0] >= x[0] && q[0] <= x[1] ? [q[0]] : [])))))].sort((a, b) => a - b);
  let k = Math.floor(places.length / 2);
  element.addEventListener("keydown", (event) => {
    const step = Math.max(1, Math.round(places.length / 60));
    if (event.key === "ArrowRight") k = Math.min(places.length - 1, k + step);
    else if (event.key === "ArrowLeft") k = Math.max(0, k - step);
    else if (event.key === "Escape") return hide();
    else return;
    event.preventDefault();
    showAt(places[k], ...onScreen(element, sx(places[k]), 0.5 * (first.top + first.bottom)));
  });
}

function nearest(line: Line, x: number): [number, number] | null {
  let found: [number, number] | null = null;
  for (const p of line.points) if (p && (!found || Math.abs(p[0] - x) < Math.abs(found[0] - x))) found = p;
  return found;
}

function withinReach(line: Line, x: number, reach: number): number | null {
  const p = nearest(line, x);
  return p && Math.abs(p[0] - x) <= reach ? p[1] : null;
}

/** Value of a line at a place, by interpolation between neighbours without a gap. */
export function between(line: Line, x: number): number | null {
  for (let k = 0; k < line.points.length; k++) {
    const [p, q] = [line.points[k], line.points[k + 1]];
    if (p && p[0] === x) return p[1];
    if (p && q && p[0] < x && q[0] > x) return p[1] + ((x - p[0]) / (q[0] - p[0])) * (q[1] - p[1]);
  }
  return null;
}

export function drawAreas(stage: Stage, areas: Areas): void {
  const { places, names } = areas;
  const stacks = areas.stacks.map((s) => s.map((v) => v ?? 0));
  const sums = stacks.map((s) => s.reduce((a, b) => a + b, 0));
  const x: [number, number] = places.length ? [Math.min(...places), Math.max(...places)] : [0, 1];
  const zoom = (stage.state.zoom as [number, number] | undefined) ?? x;
  const y = nice(0, Math.max(...sums, 1e-9), 8);
  const height = stage.height ?? Math.round(Math.min(0.58 * stage.width, 400));
  const element = canvas(stage, height, areas.title);
  const frame: Frame = { svg: element, left: leftMargin(...y, height - 68), top: 26, right: stage.width - 22, bottom: height - 42 };
  const { sx, sy } = axes(frame, { low: zoom[0], high: zoom[1], name: areas.x }, { low: y[0], high: y[1], name: areas.y });
  const g = svg(element, "g", { "clip-path": clip(frame) });
  const base = places.map(() => 0);
  names.forEach((name, k) => {
    const upper = base.map((b, i) => b + (stacks[i]?.[k] ?? 0));
    const there = places.map((p, i) => `${sx(p).toFixed(1)},${sy(upper[i]).toFixed(1)}`);
    const back = places.map((p, i) => `${sx(p).toFixed(1)},${sy(base[i]).toFixed(1)}`).reverse();
    svg(g, "path", { d: `M${[...there, ...back].join("L")}Z`, fill: stage.components.colour(name), stroke: places.length < 300 ? "var(--gl-ground)" : undefined, "stroke-width": 0.6, "data-line": name });
    upper.forEach((v, i) => (base[i] = v));
  });
  // The largest on top of the legend's list, as in the picture.
  const entries = [...names].reverse().map((name): Entry => ({ name, colour: stage.components.colour(name), mark: "box", pattern: stage.components.repeated(name) }));
  legend(stage.root, entries, element);
  const lines = [...names].reverse().map((name): Line => {
    const k = names.indexOf(name);
    return { name, stroke: "line", points: places.map((p, i) => [p, stacks[i]?.[k] ?? 0]) };
  });
  const total: Line = { name: "total", stroke: "line", points: places.map((p, i) => [p, sums[i]]) };
  const colours = new Map(names.map((name) => [name, stage.components.colour(name)]));
  cursor(stage, element, [{ frame, sx, sy, lines: [...lines, total], name: areas.y }], areas.x, colours, zoom, stage.state.zoom !== undefined);
}

