// Line ends of a file: in the page lines end with `\n`, as in the editor, which counts a break as one character.

import { changes } from "./diff.ts";

/** A text with the line ends of the page. */
export const plainLines = (text: string) => text.replace(/\r\n?/g, "\n");

/** Line ends in their order. */
const endsOf = (text: string) => text.match(/\r\n|\r|\n/g) ?? [];

/** A text of the page with the line ends that the file has on the disk. New and changed lines get those of most lines. */
export function withEnds(disk: string, text: string): string {
  const ends = endsOf(disk);
  const counts = new Map<string, number>();
  for (const end of ends) counts.set(end, (counts.get(end) ?? 0) + 1);
  const usual = [...counts].sort((a, b) => b[1] - a[1])[0]?.[0] ?? "\n";
  if (counts.size <= 1) return usual === "\n" ? text : text.replace(/\n/g, usual);
  const [before, now] = [plainLines(disk).split("\n"), text.split("\n")];
  const own: string[] = now.map(() => usual);
  let [a, b] = [0, 0];
  const same = (until: number) => {
    for (; a < until; a++, b++) own[b] = ends[a] ?? usual;
  };
  for (const change of changes(before, now)) {
    same(change.a[0]);
    [a, b] = [change.a[1], change.b[1]];
  }
  same(before.length);
  return now.map((line, k) => (k < now.length - 1 ? line + own[k] : line)).join("");
}
