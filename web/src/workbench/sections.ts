// One analysis as in the report: headline, key figures, pictures, tables.

import { type Drawn, draw } from "../draw.ts";
import { words } from "../format.ts";
import { html } from "../svg.ts";
import { equip } from "../table.ts";
import { visible } from "../visible.ts";
import type { ColourBook } from "../colours.ts";
import type { Section, Table } from "./protocol.ts";
import { Tabs } from "./tabs.ts";

/** Adds a section; returns its pictures, to be removed with it. */
export function drawSection(host: HTMLElement, section: Section, books: { components: ColourBook; series: ColourBook }): Drawn[] {
  const drawn: Drawn[] = [];
  const box = html(host, "section", { class: "section", "data-analysis": section.name });
  html(box, "h3", {}, words(section.title || section.name));
  if (section.about) html(box, "p", { class: "quiet" }, words(section.about));
  if (section.note) html(box, "p", { class: "quiet" }, words(section.note));
  if (section.failed) html(box, "p", { class: "failed", role: "alert" }, section.failed);
  if (section.headline) html(box, "p", { class: "headline" }, words(section.headline));
  if (section.key_figures.length) {
    const list = html(box, "dl", { class: "tiles" });
    for (const { label, value, unit, detail } of section.key_figures) {
      const tile = html(list, "div", { class: "tile" });
      html(tile, "dt", {}, words(label));
      const line = html(tile, "dd");
      html(line, "span", { class: "value" }, words(value));
      if (unit) line.append(" ", Object.assign(document.createElement("span"), { className: "unit", textContent: words(unit) }));
      if (detail) html(tile, "dd", { class: "detail" }, words(detail));
    }
  }
  for (const verdict of section.verdicts) html(box, "p", { class: "verdict" }, words(verdict));
  const careful = [...section.limits, ...section.careful];
  if (careful.length) {
    const list = html(box, "ul", { class: "careful" });
    for (const text of careful) html(list, "li", {}, words(text));
  }
  if (section.pictures.length === 1) drawn.push(draw(html(box, "div", { class: "picture" }), section.pictures[0], { ...books, title: true }));
  if (section.pictures.length > 1) {
    // A picture is drawn when it is seen first.
    const pending = new Map(section.pictures.map((picture, k) => [String(k), picture]));
    const show = (id: string) => {
      const picture = pending.get(id);
      if (!picture) return;
      pending.delete(id);
      drawn.push(draw(tabs.panels.get(id)!, picture, books));
    };
    const tabs: Tabs = new Tabs(html(box, "div", { class: "picture-tabs" }), html(box, "div", { class: "picture" }), `Pictures of ${section.title || section.name}`, section.pictures.map((p, k) => ({ id: String(k), title: words(p.title) || `Picture ${k + 1}` })), show);
    show("0");
  }
  if (section.outside.length) {
    const details = html(box, "details");
    html(details, "summary", {}, `Outside stated ranges (${section.outside.length})`);
    const list = html(details, "ul");
    for (const text of section.outside) html(list, "li", {}, words(text));
  }
  let tables = 0;
  for (const block of section.blocks) {
    if ("text" in block) {
      html(box, "p", { class: "text" }, words(block.text));
      continue;
    }
    const { title, rows } = block.table;
    const details = html(box, "details", rows.length <= 13 ? { open: "" } : {});
    html(details, "summary", {}, words(title) || `Table, ${rows.length - 1} rows`);
    drawTable(details, block.table, title || section.name, `${section.name}, table ${++tables}${title ? `: ${title}` : ""}`);
  }
  return drawn;
}

/** Rows of a table that are shown. */
const SHOWN = 2000;

/** Adds a sortable table without its title, with its tools. */
export function drawTable(host: Element, { title, rows: [head = [], ...rows] }: Table, name: string, label = title || name): void {
  const frame = html(host, "div", { class: "table" });
  const scroll = html(frame, "div", { class: "scroll", tabindex: 0, role: "region", "aria-label": label });
  const table = html(scroll, "table");
  const line = html(html(table, "thead"), "tr");
  // The first column is named by what its rows are; others may be mechanisms.
  head.forEach((cell, k) => html(line, "th", { scope: "col" }, k === 0 ? visible(cell) : words(cell)));
  const body = html(table, "tbody");
  for (const row of rows.slice(0, SHOWN)) {
    const own = html(body, "tr");
    for (const cell of row) html(own, "td", { "data-text": cell }, words(cell));
  }
  equip(table, name);
  if (rows.length > SHOWN) html(frame, "p", { class: "quiet" }, `The first ${SHOWN} of ${rows.length} rows; the files of the results have all.`);
}
