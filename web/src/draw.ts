// Draws any picture into an element, and again when the element changes its width.

import { drawBars } from "./bars.ts";
import { ColourBook, stem } from "./colours.ts";
import { words } from "./format.ts";
import { drawAreas, drawLines, drawPanes } from "./lines.ts";
import { drawCloud, drawMap } from "./map.ts";
import { drawPanels } from "./panels.ts";
import { drawIntervals, drawTornado, drawWaterfall } from "./rows.ts";
import { Options, Stage, html } from "./svg.ts";
import type { Picture } from "./types.ts";

export type { Options, Picture };
export { ColourBook };

/** A drawn picture. */
export interface Drawn {
  /** Draws again, with changed options if there are any. */
  redraw(options?: Options): void;
  /** Moves the mark on each map of the picture to a place, in the units of its axes; null removes it. */
  mark(place: [x: number, y: number] | null): void;
  /** The tab that is shown. */
  tab(): number;
  /** Removes the picture. */
  remove(): void;
}

/** Names of the components of a picture, so that all pictures of a document can agree on their colours. */
function componentsOf(picture: Picture): string[] {
  switch (picture.kind) {
    case "bars":
      return picture.names.length > 1 ? picture.names : [];
    case "areas":
      return picture.names;
    case "panels":
      return picture.breakdown?.names ?? [];
    case "waterfall":
      return [...new Set(picture.losses.flatMap((l) => [l[1], l[0]]))];
    default:
      return [];
  }
}

/** Colours for all pictures of a document: names in many pictures first, so that the most distinct colours are theirs. */
export function colourBooks(pictures: Picture[]): { components: ColourBook; series: ColourBook } {
  const books = { components: new ColourBook(), series: new ColourBook() };
  const count = (lists: string[][]) => {
    const found = new Map<string, number>();
    for (const list of lists) for (const name of new Set(list)) found.set(name, (found.get(name) ?? 0) + 1);
    return [...found].sort((a, b) => b[1] - a[1]);
  };
  for (const [name] of count(pictures.map(componentsOf))) books.components.look(name);
  const lines = pictures.map((p) => (p.kind === "lines" ? p.lines : p.kind === "panes" ? p.panes.flatMap((q) => q.lines) : []).map((l) => stem(l.name)));
  for (const [name, times] of count(lines)) if (times > 1 && !books.components.has(name)) books.series.place(name);
  return books;
}

/** True if there is nothing to draw. */
function isEmpty(picture: Picture): boolean {
  const empty = (lines: { points: unknown[] }[]) => lines.every((l) => l.points.length === 0);
  switch (picture.kind) {
    case "bars":
    case "tornado":
      return picture.bars.length === 0;
    case "lines":
      return empty(picture.lines);
    case "panes":
      return picture.panes.every((p) => empty(p.lines));
    case "areas":
      return picture.places.length === 0 || picture.names.length === 0;
    case "intervals":
      return picture.list.length === 0;
    default:
      return false;
  }
}

function paint(stage: Stage, picture: Picture): void {
  if (isEmpty(picture)) {
    html(stage.root, "p", { class: "gl-note" }, "No values.");
    return;
  }
  switch (picture.kind) {
    case "bars":
      return drawBars(stage, picture);
    case "map":
      return drawMap(stage, picture);
    case "cloud":
      return drawCloud(stage, picture);
    case "lines":
      return drawLines(stage, picture);
    case "areas":
      return drawAreas(stage, picture);
    case "intervals":
      return drawIntervals(stage, picture);
    case "panels":
      return drawPanels(stage, picture);
    case "panes":
      return drawPanes(stage, picture);
    case "waterfall":
      return drawWaterfall(stage, picture);
    case "tornado":
      return drawTornado(stage, picture);
  }
}

/** Draws a picture into an element. */
export function draw(element: HTMLElement, picture: Picture, options: Options = {}): Drawn {
  const root = html(element, "div", { class: "gl" });
  let current = options;
  const books = { components: options.components ?? new ColourBook(), series: options.series ?? new ColourBook() };
  const state: Record<string, unknown> = { tab: options.tab };
  let drawnWidth = 0;
  let movers: ((x: number, y: number) => void)[] = [];
  let marked: [number, number] | null = null;
  const mark = () => {
    for (const move of movers) move(...(marked ?? ([NaN, NaN] as [number, number])));
  };
  const again = () => {
    const width = Math.max(260, Math.floor(current.width ?? element.clientWidth ?? 0));
    drawnWidth = width;
    root.replaceChildren();
    if (current.title) html(root, "p", { class: "gl-title" }, words(picture.title));
    movers = [];
    paint({ root, width, height: current.height, ...books, state, again, pick: current.pick, movers }, picture);
    mark();
  };
  again();
  const observer =
    typeof ResizeObserver === "undefined"
      ? null
      : new ResizeObserver(() => {
          const width = Math.max(260, Math.floor(element.clientWidth));
          if (current.width === undefined && element.clientWidth > 0 && Math.abs(width - drawnWidth) > 1) again();
        });
  observer?.observe(element);
  return {
    redraw(changed) {
      if (changed) current = { ...current, ...changed };
      again();
    },
    mark(place) {
      marked = place;
      mark();
    },
    tab() {
      return Number(state.tab ?? 0);
    },
    remove() {
      observer?.disconnect();
      root.remove();
    },
  };
}
