// Colours the parts of a gearbox drawing by their losses at one point.

import { short, significant } from "./format.ts";
import { ticks } from "./levels.ts";
import { canvas, svg } from "./svg.ts";

/** Path of a part and its loss in W. */
type PartLoss = [path: string, watts: number];

/** Ends of the colour scale: nearly no loss, and the largest loss. */
const [PALE, STRONG] = [
  [253, 241, 230],
  [214, 90, 18],
];

/** A colour for a share of the largest loss; the root makes small losses visible. */
export function heat(share: number): string {
  const place = Math.sqrt(Math.min(1, Math.max(0, share)));
  const mixed = PALE.map((low, i) => Math.round(low + place * (STRONG[i] - low)));
  return `rgb(${mixed.join(", ")})`;
}

/** A bar of colours with losses in W, from none to the largest. */
export function heatScale(parent: Element, most: number): void {
  const [width, left, length] = [270, 6, 206];
  const element = canvas({ root: parent, width }, 30, `colours of losses from 0 to ${significant(most, 3)} W`);
  const steps = 40;
  for (let k = 0; k < steps; k++) svg(element, "rect", { x: left + (k * length) / steps, y: 2, width: length / steps + 0.5, height: 10, fill: heat((k + 0.5) / steps) });
  svg(element, "rect", { x: left, y: 2, width: length, height: 10, class: "gl-frame" });
  for (const watts of ticks(0, most, 5)) {
    const x = left + (length * watts) / most;
    svg(element, "line", { x1: x, x2: x, y1: 2, y2: 15, class: "gl-tick" });
    svg(element, "text", { x, y: 27, "text-anchor": "middle" }, short(watts));
  }
  svg(element, "text", { x: left + length + 10, y: 12 }, "W lost");
}

/** Fills the shapes of each part by its loss and adds the loss to its tooltip. Returns the part with the largest loss. */
export function colourByLoss(drawing: Element, losses: PartLoss[]): PartLoss | null {
  const most = losses.reduce<PartLoss | null>((most, own) => (most && most[1] >= own[1] ? most : own), null);
  if (!most || most[1] <= 0) return null;
  for (const [path, watts] of losses) {
    for (const part of drawing.querySelectorAll(`[data-part="${CSS.escape(path)}"]`)) {
      for (const shape of part.querySelectorAll("rect, polygon, circle, path")) {
        const fill = shape.getAttribute("fill");
        // Bores and lines keep their look.
        if (fill && fill !== "none" && shape.getAttribute("stroke") !== "none") shape.setAttribute("fill", heat(watts / most[1]));
      }
      const title = part.querySelector("title");
      if (title) title.textContent += `, loss ${significant(watts, 3)} W`;
    }
  }
  // The colours of the drawing's own legend are gone.
  for (const text of drawing.querySelectorAll("text")) if (text.textContent?.startsWith("Blue gears")) text.remove();
  return most;
}

/** Least height of letters on the screen in pixels, and the most that they grow for it: larger ones would cover each other. */
const [LETTERS, MOST] = [10.5, 1.6];

/** Enlarges the letters of a drawing that is shown small. */
export function legible(drawing: SVGSVGElement): void {
  const view = drawing.viewBox.baseVal;
  const box = drawing.getBoundingClientRect();
  const shown = Math.min(box.width / (view.width || 1), box.height / (view.height || 1));
  if (!(shown > 0)) return;
  for (const text of drawing.querySelectorAll("text")) {
    text.dataset.size ??= String(parseFloat(getComputedStyle(text).fontSize));
    text.style.fontSize = `${Math.min(MOST * Number(text.dataset.size), Math.max(Number(text.dataset.size), LETTERS / shown)).toFixed(1)}px`;
  }
}
