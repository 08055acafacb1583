// Differences of two texts by lines, and a text with the changes of two sides.

/** Lines of `a` from..to are replaced by lines of `b` from..to. */
export interface Change {
  a: [from: number, to: number];
  b: [from: number, to: number];
}

/** Changes that lead from `a` to `b`: the shortest list of removed and added lines (Myers 1986). */
export function changes(a: string[], b: string[]): Change[] {
  let [start, endA, endB] = [0, a.length, b.length];
  while (start < endA && start < endB && a[start] === b[start]) start++;
  while (endA > start && endB > start && a[endA - 1] === b[endB - 1]) {
    endA--;
    endB--;
  }
  const [n, m] = [endA - start, endB - start];
  if (n === 0 && m === 0) return [];
  const whole: Change[] = [{ a: [start, endA], b: [start, endB] }];
  const most = n + m;
  if (n === 0 || m === 0) return whole;
  const reach = new Map<number, number>([[1, 0]]);
  const trace: Map<number, number>[] = [];
  // Texts that share little are one change: the search grows with the square of the difference.
  for (let d = 0; d <= most; d++) {
    if (d > 2000) return whole;
    trace.push(new Map(reach));
    for (let k = -d; k <= d; k += 2) {
      const down = k === -d || (k !== d && (reach.get(k - 1) ?? -1) < (reach.get(k + 1) ?? -1));
      let x = down ? (reach.get(k + 1) ?? 0) : (reach.get(k - 1) ?? 0) + 1;
      let y = x - k;
      while (x < n && y < m && a[start + x] === b[start + y]) {
        x++;
        y++;
      }
      reach.set(k, x);
      if (x >= n && y >= m) return backwards(trace, n, m, start);
    }
  }
  return whole;
}

function backwards(trace: Map<number, number>[], n: number, m: number, start: number): Change[] {
  const found: Change[] = [];
  let [x, y] = [n, m];
  for (let d = trace.length - 1; d > 0; d--) {
    const reach = trace[d];
    const k = x - y;
    const down = k === -d || (k !== d && (reach.get(k - 1) ?? -1) < (reach.get(k + 1) ?? -1));
    const before = down ? k + 1 : k - 1;
    const [px, py] = [reach.get(before) ?? 0, (reach.get(before) ?? 0) - before];
    // One line is removed or added from (px, py) on; then equal lines follow.
    const [a, b]: [[number, number], [number, number]] = down
      ? [[start + px, start + px], [start + py, start + py + 1]]
      : [[start + px, start + px + 1], [start + py, start + py]];
    const next = found[0];
    if (next && next.a[0] === a[1] && next.b[0] === b[1]) {
      next.a[0] = a[0];
      next.b[0] = b[0];
    } else found.unshift({ a, b });
    [x, y] = [px, py];
  }
  return found;
}

const lines = (text: string) => text.split("\n");

/** A text with the changes of both sides since `base`; null if both changed the same or adjacent lines differently. */
export function merged(base: string, mine: string, theirs: string): string | null {
  const [o, m, t] = [lines(base), lines(mine), lines(theirs)];
  const [own, other] = [changes(o, m), changes(o, t)];
  const out: string[] = [];
  let at = 0;
  let [i, j] = [0, 0];
  while (i < own.length || j < other.length) {
    const [c, d] = [own[i], other[j]];
    if (c && d && touch(c.a, d.a)) {
      const same = c.a[0] === d.a[0] && c.a[1] === d.a[1] && m.slice(...c.b).join("\n") === t.slice(...d.b).join("\n");
      if (!same) return null;
      out.push(...o.slice(at, c.a[0]), ...m.slice(...c.b));
      at = c.a[1];
      i++;
      j++;
      continue;
    }
    const first = !d || (c && c.a[0] < d.a[0]);
    const [next, text] = first ? [c, m] : [d, t];
    out.push(...o.slice(at, next.a[0]), ...text.slice(...next.b));
    at = next.a[1];
    if (first) i++;
    else j++;
  }
  out.push(...o.slice(at));
  return out.join("\n");
}

/** True if two ranges of lines overlap or touch: then nobody knows in which order the changes belong. */
function touch(a: [number, number], b: [number, number]): boolean {
  return a[0] <= b[1] && b[0] <= a[1];
}

export interface Row {
  kind: "same" | "removed" | "added" | "gap";
  text: string;
}

/** The difference of two texts as rows, with some equal lines around each change. */
export function rows(a: string, b: string, around = 2): Row[] {
  const [p, q] = [lines(a), lines(b)];
  const found: Row[] = [];
  let at = 0;
  for (const change of changes(p, q)) {
    const from = Math.max(at, change.a[0] - around);
    if (from > at) {
      for (const text of p.slice(at, Math.min(at + (at > 0 ? around : 0), from))) found.push({ kind: "same", text });
      const gap = from - Math.min(at + (at > 0 ? around : 0), from);
      if (gap > 0) found.push({ kind: "gap", text: `${gap} equal lines` });
    }
    for (const text of p.slice(from, change.a[0])) found.push({ kind: "same", text });
    for (const text of p.slice(...change.a)) found.push({ kind: "removed", text });
    for (const text of q.slice(...change.b)) found.push({ kind: "added", text });
    at = change.a[1];
  }
  for (const text of p.slice(at, at + around)) if (found.length) found.push({ kind: "same", text });
  return found;
}

/** The smallest single replacement that leads from one text to another, in UTF-16 units. */
export function replacement(a: string, b: string): { from: number; to: number; insert: string } {
  let start = 0;
  const shorter = Math.min(a.length, b.length);
  while (start < shorter && a[start] === b[start]) start++;
  let end = 0;
  while (end < shorter - start && a[a.length - 1 - end] === b[b.length - 1 - end]) end++;
  return { from: start, to: a.length - end, insert: b.slice(start, b.length - end) };
}
