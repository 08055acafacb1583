// A slider with a number field and ends that can be edited.

import { html, unique } from "../svg.ts";

export interface SliderValue {
  from: number;
  to: number;
  value: number;
}

/** A round step that divides a range into 200 to 500 parts. */
export function stepOf(from: number, to: number): number {
  const raw = Math.abs(to - from) / 200 || 1;
  const power = 10 ** Math.floor(Math.log10(raw));
  const lead = raw / power;
  return Number(((lead >= 5 ? 5 : lead >= 2 ? 2 : 1) * power).toPrecision(6));
}

/** A number without more digits than it needs. */
export const plain = (value: number) => String(Number(value.toPrecision(10)));

export class Slider {
  readonly element: HTMLElement;
  private readonly range: HTMLInputElement;
  private readonly number: HTMLInputElement;
  private readonly low: HTMLInputElement;
  private readonly high: HTMLInputElement;
  private own: SliderValue;

  constructor(
    parent: HTMLElement,
    label: string,
    unit: string,
    start: SliderValue,
    private readonly changed: (what: "value" | "range") => void,
  ) {
    // What is solved is what the field shows.
    this.own = { ...start, value: Number(plain(start.value)) };
    const id = unique("slider");
    this.element = html(parent, "div", { class: "slider" });
    html(this.element, "label", { for: `${id}-number`, class: "slider-name" }, label);
    this.number = html(this.element, "input", { type: "number", step: "any", id: `${id}-number`, class: "slider-number" });
    html(this.element, "span", { class: "unit" }, unit);
    const row = html(this.element, "div", { class: "slider-row" });
    this.low = html(row, "input", { type: "number", step: "any", class: "slider-end", "aria-label": `${label}: start of the range in ${unit}`, title: "Start of the range" });
    this.range = html(row, "input", { type: "range", "aria-label": `${label} in ${unit}` });
    this.high = html(row, "input", { type: "number", step: "any", class: "slider-end", "aria-label": `${label}: end of the range in ${unit}`, title: "End of the range" });
    this.range.addEventListener("input", () => {
      this.own.value = Number(this.range.value);
      this.number.value = plain(this.own.value);
      this.changed("value");
    });
    this.number.addEventListener("input", () => {
      const value = this.number.valueAsNumber;
      if (!Number.isFinite(value)) return;
      this.own.value = value;
      this.range.value = String(value);
      this.changed("value");
    });
    // A value beyond the range widens it.
    this.number.addEventListener("change", () => this.show());
    for (const [input, key] of [
      [this.low, "from"],
      [this.high, "to"],
    ] as const)
      input.addEventListener("change", () => {
        const value = input.valueAsNumber;
        if (Number.isFinite(value) && value !== this.own[key === "from" ? "to" : "from"]) {
          this.own[key] = value;
          this.own.value = Math.min(Math.max(this.own.value, Math.min(this.own.from, this.own.to)), Math.max(this.own.from, this.own.to));
          this.changed("range");
        }
        this.show();
      });
    this.show();
  }

  get state(): SliderValue {
    return { ...this.own };
  }

  set value(value: number) {
    this.own.value = value;
    this.show();
  }

  private show(): void {
    const { own } = this;
    const [low, high] = [Math.min(own.from, own.to, own.value), Math.max(own.from, own.to, own.value)];
    if (own.from <= own.to) [own.from, own.to] = [low, high];
    else [own.from, own.to] = [high, low];
    this.range.min = String(low);
    this.range.max = String(high);
    this.range.step = String(stepOf(low, high));
    this.range.value = String(own.value);
    // The field shows the value that is solved, which the step of the slider does not change.
    if (document.activeElement !== this.number || this.number.valueAsNumber !== own.value) this.number.value = plain(own.value);
    this.low.value = plain(low);
    this.high.value = plain(high);
  }
}
