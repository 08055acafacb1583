// Efficiency, loss, oil temperature, output torque and ratio as large numbers, with the difference to what is pinned.

import { fixed, significant } from "../format.ts";
import { html } from "../svg.ts";
import type { PointAnswer } from "./protocol.ts";

/** A difference with its sign. */
export function signed(value: number, text: (size: number) => string): string {
  const size = text(Math.abs(value));
  return /^[0.\u202f]*$/.test(size) ? `±${size}` : `${value < 0 ? "\u2212" : "+"}${size}`;
}

/** Decimals with which a value and its difference are shown. */
export const percent = (share: number) => fixed(100 * share, 2);
export const watts = (loss: number) => (Math.abs(loss) >= 10000 ? fixed(loss, 0) : significant(loss, 4));
export const celsius = (oil: number) => fixed(oil, 1);

interface PortState {
  port: string;
  speed_rpm: number | null;
  torque_nm: number | null;
}

/** What a gearbox with two ports gives at the one whose speed is not chosen: torque that it applies there, and the ratio of the speeds. Null for others. */
export function outputOf(answer: PointAnswer, reference: string | null): { port: string; torque: number | null; ratio: number | null } | null {
  const ports: PortState[] = Array.isArray(answer.point.ports) ? answer.point.ports : [];
  if (ports.length !== 2) return null;
  const own = ports.find((p) => p.port === reference) ?? ports[0];
  const other = ports[1 - ports.indexOf(own)];
  const ratio = own.speed_rpm !== null && other.speed_rpm ? own.speed_rpm / other.speed_rpm : null;
  // The record has the torque that the port applies to the gearbox.
  return { port: other.port, torque: other.torque_nm === null ? null : 0 - other.torque_nm, ratio };
}

export class Numbers {
  constructor(private readonly host: HTMLElement) {}

  /** `reference` is the port whose speed is given. */
  show(answer: PointAnswer, pinned: PointAnswer | null, reference: string | null): void {
    this.host.replaceChildren();
    const tile = (name: string, label: string, value: number | null, text: (v: number) => string, unit: string, deltas: string[], title?: string) => {
      const element = html(this.host, "div", { class: "tile-now", "data-number": name, "data-value": value === null ? "" : JSON.stringify(value), title });
      html(element, "dt", {}, unit ? `${label} ${unit}` : label);
      html(element, "dd", { class: "value" }, value === null ? "–" : text(value));
      for (const delta of deltas) html(element, "dd", { class: "delta" }, delta);
    };
    const both = (key: "efficiency" | "loss" | "oil"): [number, number] | null => {
      const [a, b] = [answer[key], pinned?.[key] ?? null];
      return a === null || b === null ? null : [a, b];
    };
    const efficiency = both("efficiency");
    tile("efficiency", "Efficiency", answer.efficiency, percent, "%", efficiency ? [`${signed(100 * (efficiency[0] - efficiency[1]), (v) => fixed(v, 3))} points`] : []);
    const loss = both("loss");
    const share = loss && loss[1] !== 0 ? [`${signed((100 * (loss[0] - loss[1])) / loss[1], (v) => fixed(v, 1))} %`] : [];
    tile("loss", "Loss", answer.loss, watts, "W", loss ? [`${signed(loss[0] - loss[1], (v) => significant(v, 3))} W`, ...share] : []);
    const oil = both("oil");
    tile("oil", "Oil", answer.oil, celsius, "°C", oil ? [`${signed(oil[0] - oil[1], (v) => fixed(v, 1))} K`] : []);
    const output = outputOf(answer, reference);
    if (!output) return;
    const before = pinned && outputOf(pinned, reference);
    const torques = output.torque !== null && before && before.torque !== null ? [output.torque, before.torque] : null;
    tile("torque", "Output", output.torque, (v) => significant(v, 4), "Nm", torques ? [`${signed(torques[0] - torques[1], (v) => fixed(v, Math.abs(torques[0]) < 100 ? 3 : 2))} Nm`] : [], `Torque that the gearbox applies at ${output.port}`);
    tile("ratio", "Ratio", output.ratio, (v) => significant(v, 4), "", [], `Speed of the other port over that of ${output.port}`);
  }

  clear(): void {
    this.host.replaceChildren();
  }
}
