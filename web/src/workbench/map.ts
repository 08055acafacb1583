// The map around the operating point: follows after the point is quiet, moves the point by a click, shows the difference to what is pinned.

import { type Drawn, draw } from "../draw.ts";
import { words } from "../format.ts";
import { html } from "../svg.ts";
import type { Picture } from "../types.ts";
import type { ColourBook } from "../colours.ts";
import { differenceOf } from "./difference.ts";
import type { Section } from "./protocol.ts";
import { visible } from "../visible.ts";

export interface Place {
  torque: number;
  speed: number;
}

export class MapPane {
  readonly count: HTMLSelectElement;
  readonly difference: HTMLInputElement;
  private readonly differenceLabel: HTMLElement;
  private readonly status: HTMLElement;
  private readonly body: HTMLElement;
  private drawn: Drawn | null = null;
  private picture: Picture | null = null;
  private place: Place | null = null;
  private tab = 0;
  section: Section | null = null;

  constructor(
    host: HTMLElement,
    private readonly books: { components: ColourBook; series: ColourBook },
    private readonly pick: (place: Place) => void,
    changed: () => void,
  ) {
    const bar = html(host, "div", { class: "bar-line" });
    const label = html(bar, "label");
    html(label, "span", {}, "Points per axis");
    this.count = html(label, "select");
    for (const n of [9, 15, 21, 31, 45, 60]) html(this.count, "option", { value: n }, String(n));
    this.count.value = "21";
    this.count.addEventListener("change", changed);
    this.differenceLabel = html(bar, "label", { class: "check" });
    this.difference = html(this.differenceLabel, "input", { type: "checkbox" });
    this.differenceLabel.append("Difference to pinned");
    this.differenceLabel.hidden = true;
    this.difference.addEventListener("change", changed);
    this.status = html(bar, "span", { class: "quiet status", role: "status" });
    this.body = html(host, "div", { class: "map-body" });
    let height = 0;
    new ResizeObserver(() => {
      if (Math.abs(this.body.clientHeight - height) < 6) return;
      height = this.body.clientHeight;
      this.fit();
    }).observe(this.body);
  }

  /** True if the difference is to be shown. */
  get differs(): boolean {
    return !this.differenceLabel.hidden && this.difference.checked;
  }

  allowDifference(is: boolean): void {
    this.differenceLabel.hidden = !is;
  }

  say(text: string): void {
    this.status.textContent = visible(text);
  }

  /** Height of the plot with which the picture fills the pane: controls and legends take a part, which is known after drawing. */
  private fit(): void {
    const room = this.body.clientHeight - 5;
    if (!this.drawn || room < 80) return;
    for (let round = 0; round < 3; round++) {
      const used = this.body.firstElementChild?.getBoundingClientRect().height ?? room;
      if (used <= room && used > room - 12) return;
      const next = Math.max(150, this.plot - (used - room) - 2);
      if (next === this.plot) return;
      this.plot = next;
      this.drawn.redraw({ height: next });
    }
  }

  private plot = 260;

  show(section: Section, pinned: Section | null): void {
    this.section = section;
    const own = section.pictures.find((p) => p.kind === "panels" || p.kind === "map") ?? section.pictures[0];
    if (section.failed || !own) return this.message(section.failed ?? section.headline ?? "There is no map.");
    const other = pinned?.pictures.find((p) => p.kind === own.kind);
    const difference = pinned ? (other ? differenceOf(own, other) : null) : null;
    if (pinned && !difference) return this.message("The pinned map has other points.");
    this.picture = difference ?? own;
    this.tab = this.drawn?.tab() ?? this.tab;
    this.drawn?.remove();
    this.body.replaceChildren();
    this.drawn = draw(this.body, this.picture, { ...this.books, height: this.plot, tab: this.tab, pick: (x, y) => this.picked(x, y) });
    this.fit();
    this.body.dataset.drawn = difference ? "difference" : "map";
    this.mark(this.place);
  }

  message(text: string): void {
    this.tab = this.drawn?.tab() ?? this.tab;
    this.drawn?.remove();
    this.drawn = null;
    this.picture = null;
    this.body.replaceChildren();
    delete this.body.dataset.drawn;
    html(this.body, "p", { class: "quiet" }, words(text));
  }

  /** Names of both axes. */
  private get names(): [string, string] | null {
    const { picture } = this;
    return picture?.kind === "panels" || picture?.kind === "map" ? [picture.x[0], picture.y[0]] : null;
  }

  /** True if speed is the horizontal axis. */
  private get speedIsX(): boolean {
    return !/torque/i.test(this.names?.[0] ?? "");
  }

  mark(place: Place | null): void {
    this.place = place;
    this.drawn?.mark(place && (this.speedIsX ? [place.speed, place.torque] : [place.torque, place.speed]));
  }

  private picked(x: number, y: number): void {
    const [speed, torque] = this.speedIsX ? [x, y] : [y, x];
    // Three digits of what the map shows.
    const round = (v: number) => Number(v.toPrecision(3));
    this.pick({ speed: round(speed), torque: round(torque) });
  }
}
