// Maps side by side with one colour scale, tabs for the quantities and a slider for a further coordinate.

import { Grid, valueAt } from "./contours.ts";
import { significant, withUnit, words } from "./format.ts";
import { colourBar, drawField, fieldScale, gridOf } from "./field.ts";
import { note, place, resolved } from "./map.ts";
import { Entry, Frame, Scale, Stage, TEXT, Tooltip, axes, canvas, fitted, html, leftMargin, legend, movable, onScreen, pointer, svg, textWidth, unique } from "./svg.ts";
import type { PanelQuantity, Panels } from "./types.ts";

/** Title of a quantity with its unit. */
const quantityName = (q: PanelQuantity) => (q.unit && q.unit !== "-" ? `${q.name} in ${q.unit}` : q.name);

interface Shown {
  index: number;
  name: string;
  svg: SVGSVGElement;
  frame: Frame;
  sx: Scale;
  sy: Scale;
  readout: SVGTextElement;
  cross: SVGPathElement;
}

export function drawPanels(stage: Stage, panels: Panels): void {
  const { root, state } = stage;
  const count = panels.rows.length * panels.columns.length;
  const tab = Math.min(Number(state.tab ?? 0), Math.max(0, panels.quantities.length - 1));
  const slide = Number(state.slide ?? 0);
  const quantity = panels.quantities[tab];
  if (!quantity || panels.quantities.every((q) => q.panels.every((p) => !p || p.every((v) => v === null)))) return note(stage, "No values.");
  const head = html(root, "div", { class: "gl-head" });
  const body = tabs(stage, panels, tab, head);
  if (panels.slider) slider(stage, panels, slide, head);

  // One scale for all panels and all values of the slider.
  const all = quantity.panels.flatMap((p) => p ?? []);
  const best = quantity.diverging ? null : quantity.best;
  const colours = fieldScale(all, quantity.diverging, best);
  const unit = words(quantity.unit);
  colourBar(body, colours, unit, Math.min(stage.width, 560));

  const [xs, ys] = [panels.x[1], panels.y[1]];
  const numberRoom = leftMargin(ys[0], ys[ys.length - 1], 300);
  const gap = 14;
  // As many columns as are wide enough; the columns of the data stay together.
  const least = stage.width < 420 ? 150 : 190;
  const fit = Math.max(1, Math.floor((stage.width - numberRoom + gap) / (least + gap)));
  const byRows = panels.columns.length > 1 && panels.columns.length <= fit;
  const across = byRows ? panels.columns.length : Math.max(1, Math.min(count, fit));
  const width = Math.floor((stage.width - numberRoom - gap * (across - 1) - 24) / across);
  const rowsOfPanels = Math.ceil(count / across);
  const height = stage.height && rowsOfPanels > 0 ? Math.max(100, stage.height / rowsOfPanels - 60) : Math.round(Math.max(150, Math.min(0.72 * width, across === 1 ? 440 : 330)));

  const grid = html(body, "div", { class: "gl-panels", role: "group", "aria-label": `${panels.title}, ${quantityName(quantity)}` });
  const shown: Shown[] = [];
  const explained = { hatched: false, allOutside: 0, powers: false };
  for (let k = 0; k < count; k++) {
    const index = slide * count + k;
    const [row, column] = [panels.rows[Math.floor(k / panels.columns.length)], panels.columns[k % panels.columns.length]];
    const name = [panels.rows.length > 1 || panels.columns.length <= 1 ? row : "", panels.columns.length > 1 ? column : ""].filter(Boolean).join(" · ");
    const firstInRow = k % across === 0;
    const lastRow = k + across >= count;
    const left = firstInRow ? numberRoom : 0;
    const full = left + width + ((k + 1) % across === 0 ? 22 : gap);
    const top = k === 0 ? 44 : 26;
    const total = height + top + (lastRow ? 42 : 12);
    const element = canvas({ root: grid, width: full }, total, `${name}: ${quantityName(quantity)}`);
    // Panels of the first row begin at the same height.
    if (k > 0 && k < across) element.classList.add("gl-lower");
    const frame: Frame = { svg: element, left, top, right: left + width, bottom: top + height };
    const { sx, sy } = axes(
      frame,
      { low: xs[0], high: xs[xs.length - 1], name: lastRow ? panels.x[0] : "", numbers: lastRow },
      { low: ys[0], high: ys[ys.length - 1], name: "", numbers: firstInRow },
      // Numbers at the edges of neighbours do not touch.
      { grid: false, inside: across > 1 },
    );
    if (k === 0) svg(element, "text", { x: 2, y: 12, class: "gl-name" }, words(panels.y[0]));
    const readout = svg(element, "text", { x: frame.right, y: top - 11, "text-anchor": "end", class: "gl-readout" });
    svg(element, "text", { x: left, y: top - 11, class: "gl-panel-name" }, fitted(words(name), width - 60));
    const values = quantity.panels[index];
    if (!values || values.every((v) => v === null)) {
      svg(element, "text", { x: left + width / 2, y: top + height / 2, "text-anchor": "middle", class: "gl-name" }, "no map");
    } else {
      const look = drawField(frame, gridOf(xs, ys, values, quantity.jumps), { sx, sy, colours, best, outside: panels.outside[index], marks: panels.marks, powers: panels.powers, envelope: panels.envelope });
      explained.hatched ||= look.hatched;
      explained.powers ||= look.powers;
      if (look.allOutside) explained.allOutside++;
    }
    stage.movers.push(movable(frame, sx, sy));
    const cross = svg(element, "path", { class: "gl-cross", d: "" });
    shown.push({ index, name, svg: element, frame, sx, sy, readout, cross });
  }

  const entries: Entry[] = [];
  if (best) entries.push({ name: "best point", mark: "star", colour: "#fff" });
  if (panels.marks.length) entries.push({ name: panels.marked || "marked", mark: "ring" });
  if (explained.powers) entries.push({ name: "constant power", mark: "power" });
  if (panels.envelope.length) entries.push({ name: "largest torque", mark: "line" });
  if (explained.hatched) entries.push({ name: "outside a model's stated range", mark: "hatch" });
  const foot = html(body, "div", { class: "gl-key" });
  legend(foot, entries);
  if (explained.allOutside) {
    const which = explained.allOutside === shown.length ? (shown.length > 1 ? "all panels" : "the map") : `${explained.allOutside} panels`;
    html(foot, "p", { class: "gl-note" }, `At every point of ${which} a model is outside one of its stated ranges (†).`);
  }
  const detail = panels.breakdown && !stage.pick ? html(body, "div", { class: "gl-detail", "aria-live": "polite" }) : null;
  if (detail) html(foot, "p", { class: "gl-note gl-hint" }, "Click, or press Enter at the cursor: losses at that point.");
  follow(stage, panels, quantity, shown, detail);
}

function tabs(stage: Stage, panels: Panels, tab: number, head: HTMLElement): HTMLElement {
  const { root, state } = stage;
  if (panels.quantities.length < 2) return root;
  const id = unique("gl-tab");
  const list = html(head, "div", { class: "gl-tabs", role: "tablist", "aria-label": "quantity" });
  const body = html(root, "div", { role: "tabpanel", id: `${id}-panel`, "aria-labelledby": `${id}-${tab}` });
  const choose = (k: number, focus: boolean) => {
    state.tab = (k + panels.quantities.length) % panels.quantities.length;
    stage.again();
    if (focus) root.querySelector<HTMLElement>('[role="tab"][aria-selected="true"]')?.focus();
  };
  panels.quantities.forEach((q, k) => {
    const button = html(list, "button", { type: "button", role: "tab", id: `${id}-${k}`, "aria-selected": String(k === tab), "aria-controls": `${id}-panel`, tabindex: k === tab ? 0 : -1 }, words(quantityName(q)));
    button.addEventListener("click", () => choose(k, true));
    button.addEventListener("keydown", (event) => {
      const to = { ArrowRight: tab + 1, ArrowLeft: tab - 1, Home: 0, End: panels.quantities.length - 1 }[event.key];
      if (to === undefined) return;
      event.preventDefault();
      choose(to, true);
    });
  });
  return body;
}

function slider(stage: Stage, panels: Panels, slide: number, head: HTMLElement): void {
  const [name, values] = panels.slider!;
  const label = html(head, "label", { class: "gl-slider" });
  html(label, "span", {}, words(name));
  const input = html(label, "input", { type: "range", min: 0, max: values.length - 1, step: 1, value: slide, "aria-valuetext": words(values[slide] ?? "") });
  html(label, "output", {}, words(values[slide] ?? ""));
  input.addEventListener("input", () => {
    stage.state.slide = Number(input.value);
    stage.again();
    stage.root.querySelector<HTMLElement>(".gl-slider input")?.focus();
  });
}

/** The cursor of all panels, the tooltip, and the losses of a cell. */
function follow(stage: Stage, panels: Panels, quantity: PanelQuantity, shown: Shown[], detail: HTMLElement | null): void {
  const { root, state } = stage;
  const [xs, ys] = [panels.x[1], panels.y[1]];
  const tip = new Tooltip(root);
  const grids = new Map<string, Grid>();
  const value = (q: PanelQuantity, index: number, x: number, y: number) => {
    const key = `${q.name} ${index}`;
    let grid = grids.get(key);
    const values = q.panels[index];
    if (!grid && values) grids.set(key, (grid = gridOf(xs, ys, values, q.jumps)));
    return grid ? valueAt(grid, x, y) : null;
  };
  const ranges = new Map(panels.quantities.map((q): [PanelQuantity, number[]] => [q, [q.panels.reduce<number>((most, p) => (p ?? []).reduce<number>((m, v) => Math.max(m, Math.abs(v ?? 0)), most), 0)]]));
  const text = (q: PanelQuantity, v: number | null) => resolved(v, ranges.get(q)!);
  const clear = () => {
    tip.hide();
    for (const panel of shown) {
      panel.cross.setAttribute("d", "");
      panel.readout.textContent = "";
    }
  };
  const show = (own: Shown, x: number, y: number, at: [number, number]) => {
    for (const panel of shown) {
      const { left, right, top, bottom } = panel.frame;
      const [px, py] = [panel.sx(x).toFixed(1), panel.sy(y).toFixed(1)];
      panel.cross.setAttribute("d", `M${left},${py}H${right}M${px},${top}V${bottom}`);
      panel.readout.textContent = text(quantity, value(quantity, panel.index, x, y));
    }
    const rows: { name: string; value: string; strong?: boolean }[] = [place(panels.x[0], x), place(panels.y[0], y)];
    for (const q of panels.quantities)
      rows.push({ name: q.name, value: withUnit(text(q, value(q, own.index, x, y)), q.unit), strong: q === quantity });
    tip.show({ head: own.name, rows }, ...at);
  };
  const nearest = (list: number[], v: number) => list.reduce((found, p, k) => (Math.abs(p - v) < Math.abs(list[found] - v) ? k : found), 0);
  const breakdown = (own: Shown, i: number, j: number) => {
    if (!detail || !panels.breakdown) return;
    state.cell = [shown.indexOf(own), i, j];
    losses(stage, panels, own, i, j, detail);
  };
  for (const own of shown) {
    const { svg: element, frame, sx, sy } = own;
    element.setAttribute("tabindex", "0");
    const inside = (event: PointerEvent | MouseEvent): [number, number] | null => {
      const [px, py] = pointer(element, event);
      return px >= frame.left && px <= frame.right && py >= frame.top && py <= frame.bottom ? [sx.invert(px), sy.invert(py)] : null;
    };
    element.addEventListener("pointermove", (event) => {
      const at = inside(event);
      if (at) show(own, ...at, [event.clientX, event.clientY]);
      else clear();
    });
    element.addEventListener("pointerleave", clear);
    element.addEventListener("blur", clear);
    element.addEventListener("click", (event) => {
      const at = inside(event);
      if (!at) return;
      if (stage.pick) stage.pick(...at);
      else breakdown(own, nearest(xs, at[0]), nearest(ys, at[1]));
    });
    let [i, j] = [Math.floor(xs.length / 2), Math.floor(ys.length / 2)];
    element.addEventListener("keydown", (event) => {
      const step = ({ ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] } as Record<string, [number, number]>)[event.key];
      if (event.key === "Enter") return stage.pick ? stage.pick(xs[i], ys[j]) : breakdown(own, i, j);
      if (event.key === "Escape") return clear();
      if (!step) return;
      event.preventDefault();
      i = Math.max(0, Math.min(xs.length - 1, i + step[0]));
      j = Math.max(0, Math.min(ys.length - 1, j + step[1]));
      show(own, xs[i], ys[j], onScreen(element, sx(xs[i]), sy(ys[j])));
    });
  }
  const kept = state.cell as [number, number, number] | undefined;
  if (kept && shown[kept[0]]) breakdown(shown[kept[0]], kept[1], kept[2]);
}

/** Losses of one cell as bars, the largest first. */
function losses(stage: Stage, panels: Panels, own: Shown, i: number, j: number, detail: HTMLElement): void {
  const { names, panels: data } = panels.breakdown!;
  const [xs, ys] = [panels.x[1], panels.y[1]];
  detail.replaceChildren();
  for (const panel of stage.root.querySelectorAll(".gl-chosen")) panel.remove();
  svg(own.svg, "rect", { x: own.sx(xs[i]) - 5, y: own.sy(ys[j]) - 5, width: 10, height: 10, class: "gl-chosen" });
  const cell = j * xs.length + i;
  const values = data[own.index]?.slice(cell * names.length, (cell + 1) * names.length) ?? [];
  const parts = names.map((name, k) => ({ name, value: values[k] ?? 0 })).filter((p) => p.value !== 0 && Number.isFinite(p.value)).sort((a, b) => b.value - a.value);
  const total = parts.reduce((sum, p) => sum + p.value, 0);
  const where = [place(panels.x[0], xs[i]), place(panels.y[0], ys[j])].map((p) => `${p.name} ${p.value}`).join(", ");
  html(detail, "p", { class: "gl-detail-head" }, words(`${own.name ? own.name + ": " : ""}losses at ${where}: ${significant(total, 4)} W`));
  if (parts.length === 0) {
    html(detail, "p", { class: "gl-note" }, "No losses are known at this point.");
    return;
  }
  const width = Math.min(stage.width, 720);
  const room = Math.min(Math.max(...parts.map((p) => textWidth(words(p.name)))) + 10, 0.4 * width);
  const line = 21;
  const height = parts.length * line + 4;
  const element = canvas({ root: detail, width }, height, `losses at ${where}`);
  const longest = Math.max(...parts.map((p) => p.value));
  parts.forEach((part, k) => {
    const y = 2 + k * line;
    const length = Math.max(1, (part.value / longest) * (width - room - 130));
    svg(element, "text", { x: room - 7, y: y + 14, "text-anchor": "end" }, fitted(words(part.name), room - 8, TEXT));
    svg(element, "rect", { x: room, y: y + 2, width: length, height: line - 6, fill: stage.components.colour(part.name), rx: 1.5 });
    svg(element, "text", { x: room + length + 7, y: y + 14 }, `${significant(part.value, 3)} W, ${significant((100 * part.value) / (total || 1), 2)} %`);
  });
}

