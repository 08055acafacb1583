// Efficiency, loss and oil temperature as large numbers, with the difference to what is pinned.

import { fixed, significant } from "../format.ts";
import { html } from "../svg.ts";
import type { PointAnswer } from "./protocol.ts";

/** A difference with its sign. */
export function signed(value: number, text: (size: number) => string): string {
  const size = text(Math.abs(value));
  return /^[0.\u202f]*$/.test(size) ? `±${size}` : `${value < 0 ? "\u2212" : "+"}${size}`;
}

/** Decimals with which a value and its difference are shown. */
export const percent = (share: number) => fixed(100 * share, 2);
export const watts = (loss: number) => (Math.abs(loss) >= 10000 ? fixed(loss, 0) : significant(loss, 4));
export const celsius = (oil: number) => fixed(oil, 1);

export class Numbers {
  constructor(private readonly host: HTMLElement) {}

  show(answer: PointAnswer, pinned: PointAnswer | null): void {
    this.host.replaceChildren();
    const tile = (name: string, label: string, value: number | null, text: (v: number) => string, unit: string, deltas: string[]) => {
      const element = html(this.host, "div", { class: "tile-now", "data-number": name, "data-value": value === null ? "" : JSON.stringify(value) });
      html(element, "dt", {}, `${label} ${unit}`);
      html(element, "dd", { class: "value" }, value === null ? "–" : text(value));
      for (const delta of deltas) html(element, "dd", { class: "delta" }, delta);
    };
    const both = (key: "efficiency" | "loss" | "oil"): [number, number] | null => {
      const [a, b] = [answer[key], pinned?.[key] ?? null];
      return a === null || b === null ? null : [a, b];
    };
    const efficiency = both("efficiency");
    tile("efficiency", "Efficiency", answer.efficiency, percent, "%", efficiency ? [`${signed(100 * (efficiency[0] - efficiency[1]), (v) => fixed(v, 3))} points`] : []);
    const loss = both("loss");
    const share = loss && loss[1] !== 0 ? [`${signed((100 * (loss[0] - loss[1])) / loss[1], (v) => fixed(v, 1))} %`] : [];
    tile("loss", "Loss", answer.loss, watts, "W", loss ? [`${signed(loss[0] - loss[1], (v) => significant(v, 3))} W`, ...share] : []);
    const oil = both("oil");
    tile("oil", "Oil", answer.oil, celsius, "°C", oil ? [`${signed(oil[0] - oil[1], (v) => fixed(v, 1))} K`] : []);
  }

  clear(): void {
    this.host.replaceChildren();
  }
}
