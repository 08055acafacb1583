// The operating point: gear, model set, inputs of the gear, temperature and volume of the oil.

import { html } from "../svg.ts";
import { words } from "../format.ts";
import type { Controls, Input, PointOf } from "./protocol.ts";
import { plain, Slider, type SliderValue } from "./sliders.ts";
import { store, stored } from "./storage.ts";

/** What was chosen for a gearbox; kept for a reload. */
interface Chosen {
  gear: string;
  model_set: string;
  oil: number | null;
  oil_range: [number, number];
  fill: number | null;
  fill_range: [number, number] | null;
  /** By gear, quantity and port. */
  inputs: Record<string, SliderValue>;
}

const KEY = "gearloss-workbench-points";

/** Range of a given oil temperature. [degC] */
const OIL: [number, number] = [0, 120];

export class PointPane {
  private controls: Controls | null = null;
  private chosen: Chosen | null = null;
  private gearbox: string | null = null;
  private shape = "";
  private sliders: { input: Input; slider: Slider }[] = [];
  private oil: Slider | null = null;
  private fill: Slider | null = null;

  constructor(
    private readonly host: HTMLElement,
    private readonly changed: (what: "value" | "range") => void,
  ) {}

  /** Forgets the controls of another gearbox. */
  begin(gearbox: string | null): void {
    if (this.gearbox === gearbox) return;
    this.gearbox = gearbox;
    this.controls = null;
    this.chosen = null;
    this.shape = "";
    this.sliders = [];
    this.oil = null;
    this.fill = null;
    this.host.replaceChildren();
  }

  /** Shows the controls; what was chosen stays as far as it exists. True if the point is another one. */
  show(controls: Controls): boolean {
    const state = () => JSON.stringify([this.point(), this.wrong]);
    const before = state();
    const kept = this.chosen ?? stored<Record<string, Chosen>>(KEY, {}, sessionStorage)[this.gearbox ?? ""] ?? null;
    const gear = controls.gears.find((g) => g.name === kept?.gear) ?? controls.gears[0];
    this.controls = controls;
    const chosen: Chosen = {
      gear: gear?.name ?? "",
      model_set: kept && controls.model_sets.includes(kept.model_set) ? kept.model_set : (controls.model_sets[0] ?? ""),
      oil: kept?.oil ?? null,
      oil_range: kept?.oil_range ?? OIL,
      fill: controls.fill ? (kept?.fill ?? null) : null,
      fill_range: kept?.fill_range ?? null,
      inputs: kept?.inputs ?? {},
    };
    // The fields that are shown write into this object.
    this.chosen = Object.assign(this.chosen ?? chosen, chosen);
    const shape = JSON.stringify(controls);
    if (shape !== this.shape) {
      this.shape = shape;
      this.build();
    }
    return before !== state();
  }

  /** Keeps the point for a gearbox whose file has another name now. */
  rename(gearbox: string, name: string): void {
    if (this.gearbox !== gearbox) return;
    this.gearbox = name;
    this.keep();
  }

  private key(gear: string, input: Input): string {
    return `${gear} ${input.quantity} ${input.port}`;
  }

  private build(): void {
    const { host, controls, chosen } = this;
    if (!controls || !chosen) return;
    // The focus survives if what had it is still there.
    const focused = host.contains(document.activeElement) ? (document.activeElement as HTMLElement).dataset.name : undefined;
    host.replaceChildren();
    const row = html(host, "div", { class: "selects" });
    const select = (name: string, label: string, options: [value: string, text: string][], value: string, act: (value: string) => void) => {
      const own = html(row, "label");
      html(own, "span", {}, label);
      const element = html(own, "select", { "data-name": name });
      for (const [v, text] of options) html(element, "option", { value: v }, text);
      element.value = value;
      element.addEventListener("change", () => act(element.value));
    };
    select("gear", "Gear", controls.gears.map((g) => [g.name, g.name]), chosen.gear, (gear) => {
      chosen.gear = gear;
      this.build();
      this.notice("range");
    });
    select("models", "Models", controls.model_sets.map((m) => [m, m || "as in the file"]), chosen.model_set, (set) => {
      chosen.model_set = set;
      this.notice("range");
    });
    const gear = controls.gears.find((g) => g.name === chosen.gear);
    this.sliders = (gear?.inputs ?? []).map((input) => {
      const start = chosen.inputs[this.key(chosen.gear, input)] ?? input;
      const slider = new Slider(host, words(`${input.quantity === "torque" ? "Torque" : "Speed"}, ${input.port}`), input.unit, start, (what) => {
        chosen.inputs[this.key(chosen.gear, input)] = slider.state;
        this.notice(what);
      });
      slider.element.dataset.quantity = input.quantity;
      slider.element.dataset.port = input.port;
      return { input, slider };
    });
    const given = (name: string, title: string, file: string, value: () => number | null, act: (given: boolean) => void) => {
      const box = html(host, "div", { class: "oil" });
      const label = html(box, "label");
      html(label, "span", {}, title);
      const mode = html(label, "select", { "data-name": name });
      html(mode, "option", { value: "file" }, file);
      html(mode, "option", { value: "given" }, "given");
      mode.value = value() === null ? "file" : "given";
      mode.addEventListener("change", () => act(mode.value === "given"));
      return html(box, "div");
    };
    const asFile = `${controls.oil.mode === "fixed" ? (controls.oil.value === null ? "fixed" : `${controls.oil.value} °C`) : controls.oil.mode}, as in the file`;
    const place = given("oil", "Oil temperature", asFile, () => chosen.oil, (given) => {
      chosen.oil = given ? (this.suggestedOil ?? controls.oil.value ?? 60) : null;
      sliderOfOil();
      this.notice("value");
    });
    const sliderOfOil = () => {
      place.replaceChildren();
      this.oil = null;
      if (chosen.oil === null) return;
      const [from, to] = chosen.oil_range;
      const slider = new Slider(place, "Given temperature", "°C", { from, to, value: chosen.oil }, (what) => {
        const { from, to, value } = slider.state;
        chosen.oil = value;
        chosen.oil_range = [from, to];
        this.notice(what);
      });
      slider.element.dataset.quantity = "oil";
      this.oil = slider;
      this.showReset();
    };
    const { fill } = controls;
    const placeOfFill = fill
      ? given("fill", "Oil volume", `${plain(fill.value)} l, as in the file`, () => chosen.fill, (given) => {
          chosen.fill = given ? fill.value : null;
          sliderOfFill();
          this.notice("range");
        })
      : null;
    const sliderOfFill = () => {
      placeOfFill?.replaceChildren();
      this.fill = null;
      if (!fill || !placeOfFill || chosen.fill === null) return;
      const [from, to] = chosen.fill_range ?? [fill.from, fill.to];
      const slider = new Slider(placeOfFill, "Given volume", "l", { from, to, value: chosen.fill }, () => {
        const { from, to, value } = slider.state;
        chosen.fill = value;
        chosen.fill_range = [from, to];
        // A map is of one volume.
        this.notice("range");
      });
      slider.element.dataset.quantity = "fill";
      this.fill = slider;
      this.showReset();
    };
    this.reset = html(host, "button", { type: "button", class: "reset-ranges", hidden: "" }, "Reset the ranges");
    this.reset.addEventListener("click", () => {
      for (const input of gear?.inputs ?? []) {
        const kept = chosen.inputs[this.key(chosen.gear, input)];
        if (kept) Object.assign(kept, { from: input.from, to: input.to });
      }
      chosen.oil_range = OIL;
      chosen.fill_range = null;
      this.build();
      this.notice("range");
    });
    sliderOfOil();
    sliderOfFill();
    this.showReset();
    if (focused) host.querySelector<HTMLElement>(`[data-name="${focused}"]`)?.focus();
  }

  /** Temperature with which "given" begins: the one that was found last. */
  suggestedOil: number | null = null;

  private reset: HTMLElement | null = null;

  /** Offers to reset the ranges if one was changed. */
  private showReset(): void {
    if (!this.reset) return;
    const differs = ({ from, to }: { from: number; to: number }, low: number, high: number) => from !== Math.min(low, high) || to !== Math.max(low, high);
    this.reset.hidden = !this.sliders.some(({ input, slider }) => differs(slider.state, input.from, input.to)) && !(this.oil && differs(this.oil.state, ...OIL)) && !(this.fill && this.controls?.fill && differs(this.fill.state, this.controls.fill.from, this.controls.fill.to));
  }

  private keep(): void {
    if (this.gearbox) store(KEY, { ...stored<Record<string, Chosen>>(KEY, {}, sessionStorage), [this.gearbox]: this.chosen }, sessionStorage);
  }

  private notice(what: "value" | "range"): void {
    this.keep();
    this.showReset();
    this.changed(what);
  }

  /** What is wrong in a field; null if nothing is. */
  get wrong(): string | null {
    const sliders = [...this.sliders.map((s) => s.slider), ...(this.oil ? [this.oil] : []), ...(this.fill ? [this.fill] : [])];
    return sliders.map((s) => s.wrong).find((w) => w !== null) ?? null;
  }

  point(): PointOf | null {
    const { controls, chosen, gearbox } = this;
    if (!controls || !chosen || !gearbox) return null;
    const inputs = this.sliders.map(({ input, slider }) => ({ quantity: input.quantity, port: input.port, value: slider.state.value }));
    return { gearbox, gear: chosen.gear, inputs, oil_temperature: this.oil?.state.value ?? null, oil_volume: this.fill?.state.value ?? null, model_set: chosen.model_set };
  }

  /** Ranges of the sliders for a map; null without one torque and one speed. */
  ranges(): { torque: { from: number; to: number }; speed: { from: number; to: number } } | null {
    const of = (quantity: string) => this.sliders.find((s) => s.input.quantity === quantity)?.slider.shown;
    const [torque, speed] = [of("torque"), of("speed")];
    return torque && speed ? { torque, speed } : null;
  }

  /** Values of speed and torque, for the mark on the map. */
  place(): { torque: number; speed: number } | null {
    const of = (quantity: string) => this.sliders.find((s) => s.input.quantity === quantity)?.slider.state.value;
    const [torque, speed] = [of("torque"), of("speed")];
    return torque === undefined || speed === undefined ? null : { torque, speed };
  }

  /** Moves the sliders. */
  moveTo(place: { torque: number; speed: number }): void {
    for (const { input, slider } of this.sliders) {
      slider.value = place[input.quantity];
      if (this.chosen) this.chosen.inputs[this.key(this.chosen.gear, input)] = slider.state;
    }
    this.notice("value");
  }
}
