// Losses of the components as a table with bars: load-dependent and no-load parts, and those of the pinned state.

import { MECHANISMS, mechanismOf } from "../colours.ts";
import { fixed, significant, words } from "../format.ts";
import { html } from "../svg.ts";
import { signed } from "./numbers.ts";
import type { PointAnswer } from "./protocol.ts";

type Loss = PointAnswer["losses"][number];

/** Parts of one bar. */
export interface Row {
  path: string;
  mechanism: string;
  model: string;
  loss: number | null;
  load_dependent: number | null;
  pinned: number | null;
}

const key = (l: Loss) => `${l.path} ${l.mechanism}`;

/** Rows of both states, the largest present loss first. A component that occurs in one state only has no value in the other one. */
export function rowsOf(losses: Loss[], pinned: Loss[] | null): Row[] {
  const before = new Map((pinned ?? []).map((l) => [key(l), l]));
  const rows: Row[] = losses.map((l) => {
    const own = before.get(key(l));
    before.delete(key(l));
    return { path: l.path, mechanism: l.mechanism, model: l.model, loss: l.loss, load_dependent: l.load_dependent, pinned: own?.loss ?? null };
  });
  for (const l of before.values()) rows.push({ path: l.path, mechanism: l.mechanism, model: l.model, loss: null, load_dependent: null, pinned: l.loss });
  return rows.sort((a, b) => (b.loss ?? -1) - (a.loss ?? -1));
}

/** `meshes.M2.drag.churning` is "mesh M2, churning". */
export function nameOf(path: string): string {
  const found = /^([a-z_]+\.[\w-]+)\.(?:drag\.)?(.+)$/.exec(path);
  return found ? `${words(found[1])}, ${found[2].replace(/[._]/g, " ")}` : words(path);
}

export function drawLosses(host: HTMLElement, answer: PointAnswer, pinned: PointAnswer | null, chosen: string | null, choose: (path: string) => void): void {
  const scrolled = host.scrollTop;
  const focused = host.contains(document.activeElement) ? (document.activeElement as HTMLElement).dataset.path : undefined;
  host.replaceChildren();
  const rows = rowsOf(answer.losses, pinned?.losses ?? null);
  if (rows.length === 0) {
    html(host, "p", { class: "quiet" }, "No component has a loss model.");
    return;
  }
  const total = answer.loss ?? rows.reduce((sum, r) => sum + (r.loss ?? 0), 0);
  const most = Math.max(1e-12, ...rows.flatMap((r) => [r.loss ?? 0, r.pinned ?? 0]));
  const key = html(host, "p", { class: "bars-key" });
  for (const [name, text] of [["load", "load-dependent"], ["idle", "no-load"], ...(pinned ? [["before", "pinned"]] : [])]) {
    html(key, "i", { class: name, "aria-hidden": "true" });
    key.append(text);
  }
  const table = html(host, "table", { class: pinned ? "losses compared" : "losses" });
  const head = html(html(table, "thead"), "tr");
  for (const [text, type] of [["Component", ""], ["", "bar"], ["Loss W", "number"], pinned ? ["Δ W", "number"] : ["%", "number"]]) {
    if (type === "bar") html(head, "td");
    else html(head, "th", { scope: "col", class: type || undefined }, text);
  }
  const body = html(table, "tbody");
  for (const row of rows) {
    const line = html(body, "tr", { "data-path": row.path, class: row.path === chosen ? "chosen" : undefined });
    const name = html(line, "th", { scope: "row" });
    const button = html(name, "button", { type: "button", title: `${row.path}, model ${row.model}`, "data-path": row.path }, nameOf(row.path));
    button.addEventListener("click", () => choose(row.path));
    const cell = html(line, "td", { class: "bar" });
    const bar = html(cell, "div", { class: "bar-own", style: `--own:${MECHANISMS[mechanismOf(row.mechanism)?.[0] ?? "others"]}` });
    const part = (type: string, value: number, parent: HTMLElement) => {
      if (value > 0) html(parent, "i", { class: type, style: `width:${((100 * value) / most).toFixed(2)}%` });
    };
    if (row.loss !== null) {
      const load = Math.min(row.loss, Math.max(0, row.load_dependent ?? row.loss));
      part("load", load, bar);
      part("idle", row.loss - load, bar);
      bar.title = row.load_dependent === null ? `${significant(row.loss, 4)} W` : `load-dependent ${significant(load, 4)} W, no-load ${significant(row.loss - load, 4)} W`;
    }
    if (pinned) part("before", row.pinned ?? 0, html(cell, "div", { class: "bar-pinned" }));
    html(line, "td", { class: "number", "data-value": row.loss === null ? "" : JSON.stringify(row.loss) }, row.loss === null ? "–" : total >= 10 ? fixed(row.loss, 2) : significant(row.loss, 3));
    if (!pinned) html(line, "td", { class: "number soft" }, row.loss === null || !(total > 0) ? "" : fixed((100 * row.loss) / total, 1));
    if (pinned) html(line, "td", { class: "number" }, row.loss === null || row.pinned === null ? "–" : signed(row.loss - row.pinned, (v) => fixed(v, 2)));
  }
  host.scrollTop = scrolled;
  if (focused) host.querySelector<HTMLElement>(`button[data-path="${CSS.escape(focused)}"]`)?.focus({ preventScroll: true });
}
