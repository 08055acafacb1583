// Which suggestions of the program fit what is typed, and where they go in the text.

import { unitsOf } from "./offsets.ts";
import type { Completion } from "./protocol.ts";

export interface Suggestion {
  completion: Completion;
  /** Replaced range in UTF-16 units. */
  from: number;
  to: number;
}

const plain = (text: string) => text.trim().replace(/^["']/, "").toLowerCase();

/** 0: the label begins with it; 1: contains it; 2: contains its letters in order; null: does not fit. */
export function fit(label: string, typed: string): 0 | 1 | 2 | null {
  const [own, part] = [plain(label), plain(typed)];
  if (own.startsWith(part)) return 0;
  if (own.includes(part)) return 1;
  let at = 0;
  for (const letter of part) {
    at = own.indexOf(letter, at) + 1;
    if (at === 0) return null;
  }
  return 2;
}

/** The fitting suggestions, the best first, otherwise in the given order. */
export function fitting(text: string, position: number, list: Completion[]): Suggestion[] {
  const ends = unitsOf(text, list.flatMap((c) => [c.range.from, c.range.to]));
  const ranked = list.flatMap((completion, k) => {
    const [from, to] = [ends[2 * k], ends[2 * k + 1]];
    const rank = fit(completion.label, text.slice(Math.min(from, position), position));
    return rank === null ? [] : [{ rank, own: { completion, from: Math.min(from, position), to: Math.max(to, position) } }];
  });
  return ranked.sort((a, b) => a.rank - b.rank).map((r) => r.own);
}
