// The convergence monitor: temperature and residual of each step, and the balance of loss and transferred heat.

import { type Drawn, draw } from "../draw.ts";
import { words } from "../format.ts";
import { html } from "../svg.ts";
import type { Line, Picture } from "../types.ts";
import type { ColourBook } from "../colours.ts";
import type { Convergence } from "./protocol.ts";

/** Both values over the number of the step; the scan at the start is a line of its own. */
export function stepsPicture({ steps, scanned, unit }: Convergence): Picture {
  const lines = (value: (k: number) => number): Line[] => {
    const points = steps.map((_, k): [number, number] => [k + 1, value(k)]);
    const [scan, search] = [points.slice(0, scanned), points.slice(scanned)];
    return [
      { name: "scan", points: scan, stroke: "dots" as const },
      { name: "search", points: search, stroke: "marked" as const },
    ].filter((l) => l.points.length > 0);
  };
  return {
    kind: "panes",
    title: "Temperature and residual of each step",
    x: "step",
    panes: [
      { y: "temperature in degC", lines: lines((k) => steps[k].temperature) },
      { y: `residual in ${unit}`, lines: lines((k) => steps[k].residual) },
    ],
  };
}

export class ConvergencePane {
  private drawn: Drawn[] = [];
  private last: Convergence | null = null;

  constructor(
    private readonly host: HTMLElement,
    private readonly books: { components: ColourBook; series: ColourBook },
  ) {
    let height = 0;
    new ResizeObserver(() => {
      if (Math.abs(host.clientHeight - height) < 4) return;
      height = host.clientHeight;
      if (this.last) this.show(this.last);
    }).observe(host);
  }

  show(convergence: Convergence): void {
    this.last = convergence;
    for (const own of this.drawn) own.remove();
    this.drawn = [];
    const { host } = this;
    host.replaceChildren();
    host.dataset.of = convergence.of;
    host.dataset.steps = String(convergence.steps.length);
    const outcome = html(host, "p", { class: "outcome" }, words(convergence.outcome));
    if (convergence.of === "fixed" && convergence.steps.length === 0) {
      html(host, "p", { class: "quiet" }, "The oil temperature is given, so no temperature is searched.");
      return;
    }
    const room = host.clientHeight - outcome.offsetHeight - 24;
    const { picture, steps, scanned } = convergence;
    if (steps.length) {
      const box = html(host, "div", { class: "steps" });
      box.title = `${steps.length} steps${scanned ? `, of which the first ${scanned} scan the range for all solutions` : ""}`;
      // Both charts together take a bit more than half of the pane, without their axes.
      const plots = picture ? 0.53 * room - 120 : room - 124;
      this.drawn.push(draw(box, stepsPicture(convergence), { ...this.books, height: Math.max(90, Math.min(320, plots)) }));
    }
    if (picture) {
      const box = html(host, "div", { class: "balance" });
      const used = [...host.children].reduce((sum, e) => sum + (e as HTMLElement).offsetHeight, 0);
      this.drawn.push(draw(box, picture, { ...this.books, height: Math.max(115, Math.min(280, host.clientHeight - used - 50)) }));
    }
  }

  clear(): void {
    this.last = null;
    for (const own of this.drawn) own.remove();
    this.drawn = [];
    this.host.replaceChildren();
  }
}
