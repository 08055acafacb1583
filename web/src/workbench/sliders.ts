// A slider with a number field and ends that can be edited.

import { html, unique } from "../svg.ts";
import { entryOf } from "./entry.ts";

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
  private readonly message: HTMLElement;
  private own: SliderValue;
  /** What is wrong in each field. */
  private readonly faults = new Map<HTMLInputElement, string>();

  constructor(
    parent: HTMLElement,
    private readonly label: string,
    unit: string,
    start: SliderValue,
    private readonly changed: (what: "value" | "range") => void,
  ) {
    // What is solved is what the field shows.
    this.own = { from: Math.min(start.from, start.to), to: Math.max(start.from, start.to), value: Number(plain(start.value)) };
    const id = unique("slider");
    this.element = html(parent, "div", { class: "slider" });
    html(this.element, "label", { for: `${id}-number`, class: "slider-name" }, label);
    const field = { type: "text", inputmode: "decimal", autocomplete: "off", spellcheck: "false", "aria-describedby": `${id}-fault` };
    this.number = html(this.element, "input", { ...field, id: `${id}-number`, class: "slider-number" });
    html(this.element, "span", { class: "unit" }, unit);
    const row = html(this.element, "div", { class: "slider-row" });
    this.low = html(row, "input", { ...field, class: "slider-end", "aria-label": `${label}: start of the range in ${unit}`, title: "Start of the range" });
    this.range = html(row, "input", { type: "range", "aria-label": `${label} in ${unit}` });
    this.high = html(row, "input", { ...field, class: "slider-end", "aria-label": `${label}: end of the range in ${unit}`, title: "End of the range" });
    this.message = html(this.element, "p", { class: "slider-fault", id: `${id}-fault`, role: "alert" });
    this.range.addEventListener("input", () => {
      this.own.value = Number(this.range.value);
      this.fault(this.number, null);
      this.number.value = plain(this.own.value);
      this.changed("value");
    });
    this.number.addEventListener("input", () => {
      const entry = entryOf(this.number.value);
      this.fault(this.number, "fault" in entry ? entry.fault : null);
      if ("value" in entry) {
        this.own.value = entry.value;
        this.range.value = String(entry.value);
      }
      this.changed("value");
    });
    // A value beyond the range widens it as long as it holds.
    for (const input of [this.number, this.range]) input.addEventListener("change", () => this.show());
    for (const [input, key] of [
      [this.low, "from"],
      [this.high, "to"],
    ] as const) {
      input.addEventListener("input", () => {
        const entry = entryOf(input.value);
        // An order of both ends is judged when the number is complete.
        this.fault(input, "fault" in entry ? entry.fault : null);
        this.changed("range");
      });
      input.addEventListener("change", () => {
        const entry = entryOf(input.value);
        const fault = "fault" in entry ? entry.fault : this.misplaced(key, entry.value);
        this.fault(input, fault);
        if (fault === null && "value" in entry) {
          this.own[key] = entry.value;
          this.show();
        }
        this.changed("range");
      });
    }
    for (const input of [this.number, this.low, this.high])
      input.addEventListener("keydown", (event) => {
        if (event.key !== "Escape" || !this.faults.has(input)) return;
        this.fault(input, null);
        this.show();
        this.changed("value");
      });
    this.show();
  }

  get state(): SliderValue {
    return { ...this.own };
  }

  /** The range with the value in it. */
  get shown(): { from: number; to: number } {
    const { from, to, value } = this.own;
    return { from: Math.min(from, value), to: Math.max(to, value) };
  }

  set value(value: number) {
    this.own.value = value;
    this.fault(this.number, null);
    this.show();
  }

  /** What is wrong in a field, in words; null if nothing is. */
  get wrong(): string | null {
    const [first] = this.faults.values();
    return first === undefined ? null : `${this.label}: ${first}`;
  }

  /** Why a number cannot be an end of the range. */
  private misplaced(key: "from" | "to", end: number): string | null {
    const { from, to, value } = this.own;
    if (key === "from" && end >= to) return `the start of the range must be below its end, ${plain(to)}`;
    if (key === "to" && end <= from) return `the end of the range must be above its start, ${plain(from)}`;
    if (key === "from" ? end > value : end < value) return `the value ${plain(value)} would be outside of the range; change the value first`;
    return null;
  }

  private fault(input: HTMLInputElement, fault: string | null): void {
    if (fault === null) this.faults.delete(input);
    else this.faults.set(input, fault);
    if (fault === null) input.removeAttribute("aria-invalid");
    else input.setAttribute("aria-invalid", "true");
    const text = [...this.faults.values()].join("; ");
    if (this.message.textContent !== text) this.message.textContent = text;
  }

  private show(): void {
    const { own } = this;
    const { from, to } = this.shown;
    this.range.min = String(from);
    this.range.max = String(to);
    this.range.step = String(stepOf(from, to));
    this.range.value = String(own.value);
    // The field shows the value that is solved, which the step of the slider does not change. What is wrong stays to be corrected.
    const set = (input: HTMLInputElement, value: number) => {
      const entry = entryOf(input.value);
      const isShown = input === document.activeElement && "value" in entry && entry.value === value;
      if (!this.faults.has(input) && !isShown) input.value = plain(value);
    };
    set(this.number, own.value);
    set(this.low, from);
    set(this.high, to);
  }
}
