// Colours the parts of a gearbox drawing by their losses at one point.

import { significant } from "./format.ts";

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
