// Numbers and words as engineers write them.

import { visible } from "./visible.ts";

const THIN = "\u202f";
const MINUS = "\u2212";

/** Fixed decimals, groups of three digits from 10 000 on, a true minus sign. */
export function fixed(x: number, decimals: number): string {
  const text = Math.abs(x).toFixed(Math.min(Math.max(decimals, 0), 12));
  const [whole, part] = text.split(".");
  const groups = whole.length > 4 ? whole.replace(/\B(?=(\d{3})+$)/g, THIN) : whole;
  const zero = /^[0.]*$/.test(text);
  return (x < 0 && !zero ? MINUS : "") + groups + (part ? `.${part}` : "");
}

/** A number with about `digits` significant digits. */
export function significant(x: number | null | undefined, digits = 4): string {
  if (x === null || x === undefined || !Number.isFinite(x)) return "–";
  if (x === 0) return "0";
  const size = Math.floor(Math.log10(Math.abs(x)));
  if (size >= 9 || size < -5) {
    const power = Math.floor(size);
    return `${fixed(x / 10 ** power, digits - 1)}·10${superscript(power)}`;
  }
  return fixed(x, Math.max(0, digits - 1 - size));
}

function superscript(n: number): string {
  return String(n).replace(/-/g, "⁻").replace(/\d/g, (d) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[Number(d)]);
}

/** Decimals that tell multiples of a step apart. */
export function decimalsOf(step: number): number {
  if (!(step > 0)) return 0;
  for (let d = 0; d < 12; d++) {
    const scaled = step * 10 ** d;
    if (Math.abs(scaled - Math.round(scaled)) < 1e-6 * scaled) return d;
  }
  return 12;
}

/** A number without superfluous zeros, such as the level of a contour. */
export function short(x: number): string {
  const rounded = Number(x.toPrecision(10));
  const size = Math.abs(rounded);
  if (size !== 0 && (size >= 1e9 || size < 1e-5)) return significant(x, 3);
  return fixed(rounded, decimalsOf(size));
}

/** Numbers of an axis, all with the decimals of their step. */
export function axisNumbers(ticks: number[]): string[] {
  const step = ticks.length > 1 ? Math.abs(ticks[1] - ticks[0]) : Math.abs(ticks[0] ?? 0);
  const largest = Math.max(...ticks.map(Math.abs), 0);
  if (largest >= 1e9 || (largest > 0 && largest < 1e-4)) return ticks.map((t) => significant(t, 2));
  const decimals = decimalsOf(Number(step.toPrecision(6)));
  return ticks.map((t) => fixed(t, decimals));
}

/** Sections of a gearbox: one of its components. */
const SECTIONS = new Map(Object.entries({ auxiliaries: "auxiliary", bearings: "bearing", bevel_meshes: "bevel mesh", chains: "chain", clutches: "clutch", couplings: "coupling", crossed_helical_meshes: "crossed helical mesh", differentials: "differential", gears: "gear", joints: "joint", meshes: "mesh", planetary_sets: "planetary set", seals: "seal", shafts: "shaft", worm_meshes: "worm mesh" }));

/** Mechanisms by their key. */
const MECHANISMS = new Map(Object.entries({ auxiliary: "auxiliaries", bearing: "bearings", bevel_mesh: "bevel meshes", chain: "chains and belts", clutch: "clutches", crossed_helical_mesh: "crossed helical meshes", differential: "differentials", gear_drag: "gear drag", gear_mesh: "gear meshes", planetary_drag: "planetary drag", seal: "seals", synchronizer: "synchronizers", worm_mesh: "worm meshes" }));

/** Mechanisms and components in words: `gear_mesh` is "gear meshes", `bearings.B2` is "bearing B2". */
function named(text: string): string {
  const component = /^([a-z_]+)\.([\w-]+)$/.exec(text);
  const section = component && SECTIONS.get(component[1]);
  return section ? `${section} ${component[2]}` : (MECHANISMS.get(text) ?? text);
}

/** Words of the data in the field's typography. */
export function words(text: string): string {
  return visible(named(text))
    .replace(/\bdeg ?C\b/g, "°C")
    .replace(/(\d |\bin )um\b/g, "$1µm")
    .replace(/\bmm2\b/g, "mm²")
    .replace(/\bmm3\b/g, "mm³")
    .replace(/\bm\/s2\b/g, "m/s²")
    .replace(/(^|[\s(])-(?=\d)/g, `$1${MINUS}`)
    .replace(/(\d) (?=(°C|%|Nm|rpm|W|kW|kJ|kWh|Wh|km|mm|ml|l|h|K|N|kN|MPa|GPa)(?![\w²³]))/g, "$1\u00a0");
}

/** A label that is a large whole number, in groups of three digits. */
export function grouped(text: string): string {
  return /^[-−]?\d{5,9}$/.test(text) ? fixed(Number(text.replace("−", "-")), 0) : text;
}

/** Unit at the end of the name of an axis, such as "loss in W" or "speed rpm". */
export function unitOf(name: string): string {
  const known = /(?:\bin|,)\s+([^\s,]+)$/.exec(name) ?? /[([]([^)\]]+)[)\]]$/.exec(name);
  if (known) return known[1];
  const last = name.split(" ").pop() ?? "";
  return /^(rpm|1\/min|Nm|W|kW|degC|°C|K|%|s|h|N|kN|m\/s|km\/h|GPa|MPa|um|mm|mm2\/s|ml|l|kJ|Wh|J)$/.test(last) && name.includes(" ") ? last : "";
}

/** Name of an axis without its unit. */
export function nameOf(name: string): string {
  const unit = unitOf(name);
  return unit ? name.slice(0, name.lastIndexOf(unit)).replace(/(\s+in|,|[([])?\s*$/, "") : name;
}

/** A value with its unit. */
export function withUnit(text: string, unit: string): string {
  return unit ? `${text}\u00a0${words(unit)}` : text;
}
