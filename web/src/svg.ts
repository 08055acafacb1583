// Elements, text widths and the frame of a picture.

import { ColourBook } from "./colours.ts";
import { axisNumbers, words } from "./format.ts";
import { ticks } from "./levels.ts";
import { visible } from "./visible.ts";

type Attributes = Record<string, string | number | undefined>;

const SVG = "http://www.w3.org/2000/svg";

/** An attribute; those that a reader gets to see have no hidden characters. */
const read = (key: string, value: string) => (key === "title" || key === "aria-label" || key === "placeholder" ? visible(value) : value);

/** Adds an SVG element. */
export function svg<K extends keyof SVGElementTagNameMap>(parent: Element, name: K, attributes: Attributes = {}, text?: string): SVGElementTagNameMap[K] {
  const element = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes))
    if (value !== undefined) element.setAttribute(key, typeof value === "number" ? String(Math.round(value * 100) / 100) : read(key, value));
  if (text !== undefined) element.textContent = visible(text);
  parent.append(element);
  return element;
}

/** Adds an HTML element. */
export function html<K extends keyof HTMLElementTagNameMap>(parent: Element | null, name: K, attributes: Attributes = {}, text?: string): HTMLElementTagNameMap[K] {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) if (value !== undefined) element.setAttribute(key, read(key, String(value)));
  if (text !== undefined) element.textContent = visible(text);
  parent?.append(element);
  return element;
}

export const TEXT = 12;

let context: CanvasRenderingContext2D | null | undefined;
let family = "";

/** Width of a text in pixels. */
export function textWidth(text: string, size = TEXT, weight = 400): number {
  if (context === undefined) {
    context = typeof document === "undefined" ? null : document.createElement("canvas").getContext("2d");
    family = typeof document === "undefined" ? "" : getComputedStyle(document.body).fontFamily || "sans-serif";
  }
  if (!context) return 0.56 * size * text.length;
  context.font = `${weight} ${size}px ${family}`;
  return context.measureText(text).width;
}

/** The text, shortened to a width with an ellipsis. */
export function fitted(text: string, width: number, size = TEXT): string {
  if (textWidth(text, size) <= width) return text;
  let [low, high] = [0, text.length];
  while (low < high) {
    const m = (low + high + 1) >> 1;
    if (textWidth(text.slice(0, m) + "…", size) <= width) low = m;
    else high = m - 1;
  }
  return low > 0 ? text.slice(0, low).trimEnd() + "…" : "";
}

let numbers = 0;

/** A name that no other element of the document has. */
export function unique(prefix: string): string {
  return `${prefix}-${++numbers}`;
}

/** What a caller may set. */
export interface Options {
  /** Colours of components, common to all pictures of a document. */
  components?: ColourBook;
  /** Colours of other lines, common to all pictures of a document. */
  series?: ColourBook;
  /** Height of the plot in pixels; by default it follows from the width. */
  height?: number;
  /** Width in pixels, for a medium whose size the element does not have yet, such as paper. */
  width?: number;
  /** Draws the title above the picture. */
  title?: boolean;
  /** The tab that is shown first, for a picture that takes the place of another one. */
  tab?: number;
  /** A click on a map gives its coordinates instead of the losses there. */
  pick?: (x: number, y: number) => void;
}

/** Where a picture is drawn. */
export interface Stage {
  /** Emptied before each drawing. */
  root: HTMLElement;
  width: number;
  height?: number;
  components: ColourBook;
  series: ColourBook;
  /** What must survive a change of the size: the tab, the zoom. */
  state: Record<string, unknown>;
  /** Draws again. */
  again: () => void;
  /** Called for a click on a map. */
  pick?: (x: number, y: number) => void;
  /** Each map of the picture adds what moves the mark to a place of it. */
  movers: ((x: number, y: number) => void)[];
}

/** The box of a plot in an SVG element. */
export interface Frame {
  svg: SVGSVGElement;
  left: number;
  top: number;
  right: number;
  bottom: number;
}

/** A linear scale. */
export interface Scale {
  (value: number): number;
  invert(pixel: number): number;
  low: number;
  high: number;
}

export function scale(low: number, high: number, from: number, to: number): Scale {
  const span = high - low || 1;
  const f = (value: number) => from + ((value - low) / span) * (to - from);
  return Object.assign(f, { invert: (pixel: number) => low + ((pixel - from) / (to - from || 1)) * span, low, high });
}

/** An SVG element of a width; the label describes it to those who cannot see it. */
export function canvas({ root, width }: { root: Element; width: number }, height: number, label: string): SVGSVGElement {
  return svg(root, "svg", { viewBox: `0 0 ${width} ${height}`, width, height, style: `--w: ${width}px`, class: "gl-svg", role: "img", "aria-label": label });
}

/** Draws both axes and returns the scales. */
export function axes(
  frame: Frame,
  x: { low: number; high: number; name: string; numbers?: boolean },
  y: { low: number; high: number; name: string; numbers?: boolean },
  look: { grid?: boolean; inside?: boolean } = { grid: true },
): { sx: Scale; sy: Scale } {
  const { left, top, right, bottom } = frame;
  const sx = scale(x.low, x.high, left, right);
  const sy = scale(y.low, y.high, bottom, top);
  const g = svg(frame.svg, "g", { class: "gl-axes" });
  const yTicks = ticks(y.low, y.high, Math.max(2, (bottom - top) / 36));
  const yNumbers = axisNumbers(yTicks);
  yTicks.forEach((t, k) => {
    const p = sy(t);
    svg(g, "line", { x1: left, x2: right, y1: p, y2: p, class: t === 0 ? "gl-zero" : look.grid ? "gl-grid" : "gl-none" });
    if (y.numbers !== false) {
      svg(g, "line", { x1: left - 4, x2: left, y1: p, y2: p, class: "gl-tick" });
      svg(g, "text", { x: left - 7, y: p + 4, "text-anchor": "end" }, yNumbers[k]);
    }
  });
  const xTicks = fittingTicks(x.low, x.high, right - left);
  const xNumbers = axisNumbers(xTicks);
  xTicks.forEach((t, k) => {
    const p = sx(t);
    svg(g, "line", { x1: p, x2: p, y1: top, y2: bottom, class: t === 0 ? "gl-zero" : look.grid ? "gl-grid" : "gl-none" });
    if (x.numbers !== false) {
      svg(g, "line", { x1: p, x2: p, y1: bottom, y2: bottom + 4, class: "gl-tick" });
      const half = look.inside ? textWidth(xNumbers[k]) / 2 : 0;
      svg(g, "text", { x: Math.max(left + half, Math.min(right - half, p)), y: bottom + 17, "text-anchor": "middle" }, xNumbers[k]);
    }
  });
  svg(g, "rect", { x: left, y: top, width: right - left, height: bottom - top, class: "gl-frame" });
  if (x.name) svg(g, "text", { x: 0.5 * (left + right), y: bottom + 34, "text-anchor": "middle", class: "gl-name" }, fitted(words(x.name), right - left + 40));
  if (y.name) svg(g, "text", { x: Math.max(2, left - 7 - yLabelWidth(y.low, y.high, bottom - top)), y: top - 8, class: "gl-name" }, fitted(words(y.name), right));
  return { sx, sy };
}

/** Draws the horizontal axis of rows and bars, and returns its scale. */
export function rowAxis(element: SVGSVGElement, low: number, high: number, left: number, right: number, top: number, bottom: number, name: string): Scale {
  const sx = scale(low, high, left, right);
  const marks = fittingTicks(low, high, right - left);
  axisNumbers(marks).forEach((text, k) => {
    const x = sx(marks[k]);
    svg(element, "line", { x1: x, x2: x, y1: top, y2: bottom, class: marks[k] === 0 ? "gl-zero" : "gl-grid" });
    svg(element, "text", { x, y: bottom + 16, "text-anchor": "middle" }, text);
  });
  svg(element, "text", { x: 0.5 * (left + right), y: bottom + 34, "text-anchor": "middle", class: "gl-name" }, words(name));
  return sx;
}

/** Ticks whose numbers do not touch. */
function fittingTicks(low: number, high: number, width: number): number[] {
  for (let most = Math.max(2, width / 60); most >= 1; most *= 0.75) {
    const found = ticks(low, high, most);
    const widest = Math.max(...axisNumbers(found).map((n) => textWidth(n)), 0);
    if (found.length < 2 || (found.length - 1) * (widest + 10) <= (width * (found[found.length - 1] - found[0])) / (high - low)) return found;
  }
  return [low, high];
}

/** Width of the numbers of a vertical axis. */
function yLabelWidth(low: number, high: number, height: number): number {
  const list = axisNumbers(ticks(low, high, Math.max(2, height / 36)));
  return Math.max(0, ...list.map((n) => textWidth(n)));
}

/** Room for the numbers of a vertical axis. */
export function leftMargin(low: number, high: number, height: number): number {
  return Math.ceil(yLabelWidth(low, high, height)) + 12;
}

/** One entry of a legend. */
export interface Entry {
  name: string;
  colour?: string;
  /** Dashes of a line. */
  dash?: string;
  mark: "box" | "line" | "dot" | "ring" | "cross" | "star" | "hatch" | "dashed" | "bar" | "outline" | "power";
  pattern?: boolean;
}

/** A legend in the text flow. While the pointer is on an entry, the lines of all others fade in `picture`. */
export function legend(parent: Element, entries: Entry[], picture?: Element): void {
  if (entries.length === 0) return;
  const light = (name: string | null) => picture?.querySelectorAll<SVGElement>("[data-line]").forEach((e) => e.classList.toggle("gl-dim", name !== null && e.dataset.line !== name));
  const list = html(parent, "ul", { class: "gl-legend" });
  for (const entry of entries) {
    const item = html(list, "li");
    const icon = svg(item, "svg", { width: 18, height: 12, viewBox: "0 0 18 12", "aria-hidden": "true" });
    const colour = entry.colour ?? "currentColor";
    switch (entry.mark) {
      case "box":
        svg(icon, "rect", { x: 3, y: 0.5, width: 12, height: 11, rx: 2, fill: colour });
        if (entry.pattern) svg(icon, "path", { d: "M3 11L14 1M8 11.5L15 5", stroke: "#fff", "stroke-width": 1.5 });
        break;
      case "line":
        svg(icon, "path", { d: "M1 6H17", stroke: colour, "stroke-width": 2.5, "stroke-dasharray": entry.dash || undefined });
        break;
      case "dashed":
        svg(icon, "path", { d: "M1 6H17", stroke: colour, "stroke-width": 1.8, "stroke-dasharray": "4 2.5" });
        break;
      case "power":
        svg(icon, "path", { d: "M3 0.5Q4 10 17 11", stroke: colour, fill: "none", "stroke-width": 1.3, "stroke-dasharray": "1.5 2.5" });
        break;
      case "dot":
        svg(icon, "circle", { cx: 9, cy: 6, r: 3.5, fill: colour });
        break;
      case "ring":
        svg(icon, "circle", { cx: 9, cy: 6, r: 4, fill: "none", stroke: colour, "stroke-width": 1.6 });
        break;
      case "bar":
        svg(icon, "path", { d: "M1 6H17", stroke: colour, "stroke-width": 4 });
        svg(icon, "circle", { cx: 9, cy: 6, r: 4, fill: colour });
        break;
      case "cross":
        svg(icon, "path", { d: "M5 2L13 10M13 2L5 10", stroke: colour, "stroke-width": 2 });
        break;
      case "outline":
        svg(icon, "rect", { x: 3, y: 0.7, width: 12, height: 10.6, fill: "none", stroke: colour, "stroke-width": 1.4 });
        break;
      case "star":
        svg(icon, "path", { d: star(9, 6, 6), fill: colour, stroke: "#000", "stroke-width": 0.7 });
        break;
      case "hatch":
        svg(icon, "rect", { x: 2, y: 0.5, width: 14, height: 11, fill: "none", stroke: colour, "stroke-width": 0.8 });
        svg(icon, "path", { d: "M2 8L9 1M5 11L15 1M11 11L16 6", stroke: colour, "stroke-width": 0.9 });
        break;
    }
    html(item, "span", {}, words(entry.name));
    item.addEventListener("pointerenter", () => light(entry.name));
    item.addEventListener("pointerleave", () => light(null));
  }
}

/** Path of a star. */
export function star(x: number, y: number, r: number): string {
  const corners = Array.from({ length: 10 }, (_, k) => {
    const [size, angle] = [k % 2 ? 0.42 * r : r, (Math.PI * k) / 5 - Math.PI / 2];
    return `${(x + size * Math.cos(angle)).toFixed(1)},${(y + size * Math.sin(angle)).toFixed(1)}`;
  });
  return `M${corners.join("L")}Z`;
}

/** Rows of a tooltip. */
interface Tip {
  head: string;
  rows: { name: string; value: string; colour?: string; strong?: boolean }[];
}

/** A tooltip beside a place on the screen. */
export class Tooltip {
  private readonly element: HTMLElement;

  constructor(root: HTMLElement) {
    this.element = html(root, "div", { class: "gl-tip", role: "status", hidden: "" });
  }

  show(tip: Tip, clientX: number, clientY: number): void {
    const { element } = this;
    element.replaceChildren();
    if (tip.head) html(element, "div", { class: "gl-tip-head" }, words(tip.head));
    const table = html(element, "table");
    for (const row of tip.rows) {
      const line = html(table, "tr", { class: row.strong ? "gl-strong" : undefined });
      const name = html(line, "td");
      if (row.colour) html(name, "i", { style: `background:${row.colour}` });
      name.append(words(row.name));
      html(line, "td", {}, words(row.value));
    }
    element.hidden = false;
    const [w, h] = [element.offsetWidth, element.offsetHeight];
    const [right, bottom] = [document.documentElement.clientWidth, window.innerHeight];
    let x = clientX + 16;
    if (x + w > right - 4) x = Math.max(4, clientX - w - 16);
    const y = Math.max(4, Math.min(clientY - 0.5 * h, bottom - h - 4));
    element.style.transform = `translate(${Math.round(x)}px, ${Math.round(y)}px)`;
  }

  hide(): void {
    this.element.hidden = true;
  }
}

/** Place of a pointer in the coordinates of an SVG element. */
export function pointer(element: SVGSVGElement, event: { clientX: number; clientY: number }): [number, number] {
  const box = element.getBoundingClientRect();
  const view = element.viewBox.baseVal;
  return [((event.clientX - box.left) * view.width) / (box.width || 1), ((event.clientY - box.top) * view.height) / (box.height || 1)];
}

/** Place of a point of an SVG element on the screen. */
export function onScreen(element: SVGSVGElement, x: number, y: number): [number, number] {
  const box = element.getBoundingClientRect();
  const view = element.viewBox.baseVal;
  return [box.left + (x * box.width) / (view.width || 1), box.top + (y * box.height) / (view.height || 1)];
}

/** Adds a mark that can be moved to a place of a plot without drawing the plot again. */
export function movable({ svg: element, left, right, top, bottom }: Frame, sx: Scale, sy: Scale): (x: number, y: number) => void {
  const group = svg(element, "g", { class: "gl-here", visibility: "hidden" });
  svg(group, "circle", { r: 7, class: "gl-here-outer" });
  svg(group, "circle", { r: 7, class: "gl-here-inner" });
  svg(group, "circle", { r: 1.6, class: "gl-here-centre" });
  return (x, y) => {
    const [px, py] = [sx(x), sy(y)];
    const inside = px >= left - 0.5 && px <= right + 0.5 && py >= top - 0.5 && py <= bottom + 0.5;
    group.setAttribute("visibility", inside ? "visible" : "hidden");
    if (inside) group.setAttribute("transform", `translate(${px.toFixed(1)} ${py.toFixed(1)})`);
  };
}

/** A pattern of lines; returns its reference. */
export function hatching(element: SVGSVGElement, colour: string, size = 7, width = 1.1): string {
  const id = unique("gl-hatch");
  const defs = svg(element, "defs");
  const pattern = svg(defs, "pattern", { id, width: size, height: size, patternUnits: "userSpaceOnUse", patternTransform: "rotate(45)" });
  svg(pattern, "line", { x1: 0, y1: 0, x2: 0, y2: size, stroke: colour, "stroke-width": 2 * width });
  return `url(#${id})`;
}

/** A clip to a box; returns its reference. */
export function clip(frame: Frame, margin = 0): string {
  const id = unique("gl-clip");
  const path = svg(svg(frame.svg, "defs"), "clipPath", { id });
  svg(path, "rect", { x: frame.left - margin, y: frame.top - margin, width: frame.right - frame.left + 2 * margin, height: frame.bottom - frame.top + 2 * margin });
  return `url(#${id})`;
}
