// Round numbers: ticks of axes and levels of contours.

import type { Best } from "./types.ts";

/** Minimum and maximum of any number of values; spreading them into arguments fails for many. */
export function extent(values: number[]): [number, number] {
  let [low, high] = [Infinity, -Infinity];
  for (const x of values) {
    if (x < low) low = x;
    if (x > high) high = x;
  }
  return [low, high];
}

/** The smallest of 1, 2, 5 times a power of ten that is not below `raw`. */
function roundStep(raw: number): number {
  if (!(raw > 0) || !Number.isFinite(raw)) return 1;
  const decade = 10 ** Math.floor(Math.log10(raw) + 1e-9);
  for (const s of [1, 2, 5, 10]) if (s * decade >= raw * (1 - 1e-9)) return s * decade;
  return 10 * decade;
}

function multiples(low: number, high: number, step: number): number[] {
  const first = Math.ceil(low / step - 1e-9);
  const last = Math.floor(high / step + 1e-9);
  const list: number[] = [];
  for (let k = first; k <= last && list.length < 500; k++) list.push(Number((k * step).toPrecision(12)) + 0);
  return list;
}

/** Ticks of an axis, at most about `most`. */
export function ticks(low: number, high: number, most: number): number[] {
  if (!(high > low)) return Number.isFinite(low) ? [low] : [];
  return multiples(low, high, roundStep((high - low) / Math.max(1, most)));
}

/** Ends of an axis at round numbers if they are near. */
export function nice(low: number, high: number, most: number): [number, number] {
  if (!(high > low)) {
    const half = Math.abs(low) * 0.05 || 1;
    return [low - half, high + half];
  }
  const step = roundStep((high - low) / Math.max(1, most));
  return [Math.floor(low / step + 1e-9) * step, Math.ceil(high / step - 1e-9) * step];
}

function finite(values: Iterable<number | null>): number[] {
  const list: number[] = [];
  for (const v of values) if (v !== null && Number.isFinite(v)) list.push(v);
  return list;
}

/** Even levels between the ends of the values, zero among them if it lies between. */
export function evenLevels(values: Iterable<number | null>, about = 10): number[] {
  const list = finite(values);
  const [low, high] = extent(list);
  if (!(high > low)) return [];
  // Of the steps 1, 2 and 5 the one that gives the wanted number best; 2.5 only if none is near.
  const raw = (high - low) / (about + 1);
  const decade = 10 ** Math.floor(Math.log10(raw));
  const far = (s: number) => Math.abs(Math.log((s * decade) / raw)) + (s === 2.5 ? 0.3 : 0);
  const step = [1, 2, 2.5, 5, 10].sort((a, b) => far(a) - far(b))[0] * decade;
  return multiples(low, high, step).filter((v) => v > low && v < high);
}

/**
 * Levels of contours, all round: about ten even ones, or if one end is good 9 to 13 as far as possible. Their steps become smaller towards
 * that end, and all bands cover similar areas.
 */
export function levels(values: Iterable<number | null>, best: Best | null): number[] {
  const list = finite(values);
  if (best === null || list.length < 4) return evenLevels(list);
  const sign = best === "highest" ? -1 : 1;
  // Distances grow from the best value; quantiles are read from the sorted list.
  const sorted = list.map((v) => sign * v).sort((a, b) => a - b);
  const ends: [number, number] = [sorted[0], sorted[sorted.length - 1]];
  if (!(ends[1] > ends[0])) return [];
  let found: number[] = [];
  for (const count of [12, 11, 10, 13, 9, 14, 8, 16, 7, 20, 6]) {
    const tried = denser(sorted, count).map((v) => sign * v + 0);
    if (found.length === 0 || distance(tried.length) < distance(found.length)) found = tried;
    if (distance(found.length) === 0) break;
  }
  if (distance(found.length) > 0) {
    const even = evenLevels(list);
    if (distance(even.length) < distance(found.length)) found = even;
  }
  return found.sort((a, b) => a - b);
}

/** How far a number of levels is from 9 to 13. */
function distance(count: number): number {
  return Math.max(0, 9 - count, count - 13);
}

function denser(sorted: number[], count: number): number[] {
  const growth = 1.12;
  const weights = Array.from({ length: count }, (_, k) => growth ** k);
  const whole = weights.reduce((a, b) => a + b, 0);
  const quantile = (f: number) => sorted[Math.min(sorted.length - 1, Math.floor(f * sorted.length))];
  const last = sorted[sorted.length - 1];
  const levels: number[] = [];
  let at = sorted[0];
  let step = 0;
  let passed = 0;
  for (let k = 0; levels.length < 30; k++) {
    const part = weights[Math.min(k, count - 1)] / whole;
    // The share of the values behind the present level, not only the planned one, so that a jump is made up for.
    const behind = lowerBound(sorted, at) / sorted.length;
    passed = Math.max(passed + part, behind + 0.5 * part);
    const wanted = Math.max(quantile(Math.min(1, passed)) - at, 1e-9 * Math.abs(at), (last - sorted[0]) / 200);
    let next = seriesBelow(1.3 * wanted);
    if (step > 0) next = Math.min(Math.max(next, step), roundStep(1.01 * step));
    step = next;
    const before = at;
    at = Math.floor(at / step + 1e-6) * step + step;
    // The first multiple of a larger step may be too near.
    if (k > 0 && at - before < 0.39 * step) at += step;
    at = Number(at.toPrecision(12));
    if (at >= last) break;
    levels.push(at);
  }
  return levels;
}

/** The largest of 1, 2, 5 times a power of ten that is not above `raw`. */
function seriesBelow(raw: number): number {
  const up = roundStep(raw);
  return up > raw * (1 + 1e-9) ? roundStep(0.39 * up) : up;
}

function lowerBound(sorted: number[], v: number): number {
  let [a, b] = [0, sorted.length];
  while (a < b) {
    const m = (a + b) >> 1;
    if (sorted[m] < v) a = m + 1;
    else b = m;
  }
  return a;
}
