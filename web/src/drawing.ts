// Colours the parts of a gearbox drawing by their losses at one point.

import { short, significant, withUnit, words } from "./format.ts";
import { ticks } from "./levels.ts";
import { canvas, svg } from "./svg.ts";

/** Path of a part and its loss in W. */
type PartLoss = [path: string, watts: number];

/** A colour for a share of the largest loss; the root makes small losses visible. The style sheet states the ends of the scale. */
export function heat(share: number): string {
  const place = 100 * Math.sqrt(Math.min(1, Math.max(0, share)));
  return `color-mix(in srgb, var(--heat-most) ${place.toFixed(1)}%, var(--heat-none))`;
}

/** A bar of colours with losses in W, from none at the bottom to the largest. */
export function heatScale(parent: Element, most: number): void {
  const [top, length, thick] = [20, 90, 10];
  const element = canvas({ root: parent, width: 72 }, top + length + 8, `colours of losses from 0 to ${significant(most, 3)} W`);
  const height = (watts: number) => top + length - (length * watts) / most;
  const steps = 40;
  const step = most / steps;
  for (let k = 0; k < steps; k++) svg(element, "rect", { x: 1, y: height((k + 1) * step), width: thick, height: length / steps + 0.5, fill: heat((k + 0.5) / steps) });
  svg(element, "rect", { x: 1, y: top, width: thick, height: length, class: "gl-frame" });
  for (const watts of ticks(0, most, 5)) {
    const y = height(watts);
    svg(element, "line", { x1: 1, x2: thick + 5, y1: y, y2: y, class: "gl-tick" });
    svg(element, "text", { x: thick + 8, y: y + 4 }, short(watts));
  }
  svg(element, "text", { x: 0, y: 11 }, "loss in W");
}

/** The part with the largest loss in words; which loss gears show, if there are any. */
export function largest(losses: PartLoss[], [path, watts]: PartLoss): string {
  const shared = losses.some(([part]) => part.startsWith("gears.")) ? " Gears share the loss of their mesh equally." : "";
  return `Largest: ${words(path)}, ${withUnit(significant(watts, 3), "W")}.${shared}`;
}

/** Fills the shapes of each part by its loss and adds the loss to its tooltip. Returns the part with the largest loss. */
export function colourByLoss(drawing: Element, losses: PartLoss[]): PartLoss | null {
  const most = losses.reduce<PartLoss | null>((most, own) => (most && most[1] >= own[1] ? most : own), null);
  if (!most || most[1] <= 0) return null;
  for (const [path, watts] of losses) {
    for (const part of drawing.querySelectorAll(`[data-part="${CSS.escape(path)}"]`)) {
      for (const shape of part.querySelectorAll<SVGElement>("rect, polygon, circle, path")) {
        const fill = shape.getAttribute("fill");
        // Bores and lines keep their look.
        if (fill && fill !== "none" && shape.getAttribute("stroke") !== "none") shape.style.fill = heat(watts / most[1]);
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
