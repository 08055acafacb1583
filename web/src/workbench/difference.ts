// The difference of two maps as a map.

import type { Panels, Picture } from "../types.ts";

const sameGrid = (a: Panels, b: Panels) => JSON.stringify([a.x, a.y, a.rows.length, a.columns.length, a.slider?.[1].length]) === JSON.stringify([b.x, b.y, b.rows.length, b.columns.length, b.slider?.[1].length]);

/** The first map less the second one, quantity by quantity; null if their points differ. */
export function differenceOf(a: Picture, b: Picture): Picture | null {
  if (a.kind === "map" && b.kind === "map") {
    if (JSON.stringify([a.x, a.y]) !== JSON.stringify([b.x, b.y])) return null;
    return { ...a, values: a.values.map((v, k) => less(v, b.values[k])), diverging: true, best: null, ends: null, marks: [] };
  }
  if (a.kind !== "panels" || b.kind !== "panels" || !sameGrid(a, b)) return null;
  const quantities = a.quantities.flatMap((quantity) => {
    const other = b.quantities.find((q) => q.name === quantity.name && q.unit === quantity.unit);
    if (!other) return [];
    const panels = quantity.panels.map((panel, k) => {
      const own = other.panels[k];
      return panel && own ? panel.map((v, n) => less(v, own[n])) : null;
    });
    const unit = { "%": "points", degC: "K" }[quantity.unit] ?? quantity.unit;
    return [{ ...quantity, unit, diverging: true, best: null, panels }];
  });
  return quantities.length ? { ...a, quantities, breakdown: null } : null;
}

function less(a: number | null | undefined, b: number | null | undefined): number | null {
  return a === null || a === undefined || b === null || b === undefined ? null : a - b;
}
