// The drawing of the gearbox: colours of the losses, parts that can be chosen.

import { colourByLoss, heatScale, largest, legible } from "../drawing.ts";
import { html } from "../svg.ts";
import type { FileRange, PointAnswer } from "./protocol.ts";

/** The element of a drawing, without what could run; null if it is none. */
function elementOf(svg: string): SVGSVGElement | null {
  const parsed = new DOMParser().parseFromString(svg, "image/svg+xml").documentElement;
  if (parsed.nodeName !== "svg") return null;
  for (const element of parsed.querySelectorAll("script, foreignObject")) element.remove();
  return document.importNode(parsed, true) as unknown as SVGSVGElement;
}

export class DrawingPane {
  private original: SVGSVGElement | null = null;
  private source = "";
  private shown: SVGSVGElement | null = null;
  private places: Record<string, FileRange> = {};
  private losses: PointAnswer["drawing"] = [];
  private readonly box: HTMLElement;
  private readonly scale: HTMLElement;
  private readonly oil: HTMLElement;
  private oilSource: string | null = null;
  chosen: string | null = null;

  constructor(
    host: HTMLElement,
    private readonly choose: (part: string, place: FileRange | null) => void,
  ) {
    this.box = html(host, "div", { class: "drawing drawing-box" });
    this.scale = html(host, "div", { class: "drawing-scale" });
    this.oil = html(host, "div", { class: "drawing-oil", hidden: "" });
    new ResizeObserver(() => this.shown && legible(this.shown)).observe(this.box);
  }

  show(svg: string, places: Record<string, FileRange>): void {
    this.places = places;
    if (svg === this.source) return;
    this.source = svg;
    const parsed = elementOf(svg);
    if (!parsed) {
      this.message("The drawing cannot be shown.");
      return;
    }
    this.original = parsed;
    this.draw();
  }

  colour(losses: PointAnswer["drawing"]): void {
    this.losses = losses;
    this.draw();
  }

  /** The cross-section with the oil at the operating point. */
  showOil(svg: string | null): void {
    if (svg === this.oilSource) return;
    this.oilSource = svg;
    this.oil.replaceChildren();
    this.oil.hidden = svg === null;
    const parsed = svg === null ? null : elementOf(svg);
    if (parsed) this.oil.append(parsed);
  }

  message(text: string): void {
    this.showOil(null);
    this.source = "";
    this.original = null;
    this.shown = null;
    this.losses = [];
    this.scale.replaceChildren();
    this.box.replaceChildren();
    html(this.box, "p", { class: "quiet" }, text);
  }

  /** Marks a part. */
  mark(part: string | null): void {
    this.chosen = part;
    for (const group of this.shown?.querySelectorAll<SVGElement>("[data-part]") ?? []) {
      const is = group.dataset.part === part;
      group.classList.toggle("chosen", is);
      group.setAttribute("aria-pressed", String(is));
    }
  }

  private draw(): void {
    if (!this.original) return;
    const focused = this.box.contains(document.activeElement) ? (document.activeElement as SVGElement).dataset.part : undefined;
    const svg = this.original.cloneNode(true) as SVGSVGElement;
    // The groups inside are buttons, so the drawing is no single image.
    svg.setAttribute("role", "group");
    svg.setAttribute("aria-label", svg.querySelector(":scope > title")?.textContent ?? "drawing of the gearbox");
    svg.querySelector(":scope > title")?.remove();
    const most = colourByLoss(svg, this.losses);
    const parts = [...svg.querySelectorAll<SVGElement>("[data-part]")];
    // Of all parts one is the tab stop: the one with the focus, the chosen one, or the first.
    const wanted = focused ?? this.chosen;
    const stop = parts.find((p) => p.dataset.part === wanted) ?? parts[0];
    for (const part of parts) {
      const path = part.dataset.part!;
      part.setAttribute("role", "button");
      part.setAttribute("aria-label", part.querySelector("title")?.textContent ?? path);
      part.setAttribute("tabindex", part === stop ? "0" : "-1");
      part.addEventListener("click", () => this.pick(path));
      part.addEventListener("keydown", (event) => {
        if (event.key === "Enter" || event.key === " ") {
          event.preventDefault();
          return this.pick(path);
        }
        const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
        if (step === undefined) return;
        event.preventDefault();
        const next = parts[(parts.indexOf(part) + step + parts.length) % parts.length];
        part.setAttribute("tabindex", "-1");
        next.setAttribute("tabindex", "0");
        next.focus();
      });
    }
    this.shown = svg;
    this.box.replaceChildren(svg);
    legible(svg);
    this.mark(this.chosen);
    if (focused) svg.querySelector<SVGElement>(`[data-part="${CSS.escape(focused)}"]`)?.focus({ preventScroll: true });
    this.scale.replaceChildren();
    if (most) {
      heatScale(this.scale, most[1]);
      html(this.scale, "p", {}, largest(this.losses, most));
    }
  }

  private pick(part: string): void {
    this.mark(part);
    this.choose(part, this.places[part] ?? null);
  }

  /** Where a part is described. */
  placeOf(part: string): FileRange | null {
    return this.places[part] ?? null;
  }
}
