// Contours over a grid of any spacing, with missing values.

export interface Grid {
  xs: number[];
  ys: number[];
  /** Values; the first coordinate varies fastest. */
  values: (number | null)[];
  /** True where a cell, counted by its lower left node, has no surface although its corners have values. */
  cut?: (i: number, j: number) => boolean;
}

export type Point = [number, number];

/** Monotone cubic interpolation (Fritsch and Carlson) between values over ascending places; it adds no extremes. */
export function monotone(xs: number[], vs: number[], at: number[]): number[] {
  const n = xs.length;
  if (n < 2) return at.map(() => vs[0]);
  const h = xs.slice(1).map((x, i) => x - xs[i]);
  const d = h.map((w, i) => (vs[i + 1] - vs[i]) / w);
  const m = vs.map((_, i) => {
    if (i === 0) return d[0];
    if (i === n - 1) return d[n - 2];
    if (d[i - 1] * d[i] <= 0) return 0;
    const [a, b] = [2 * h[i] + h[i - 1], h[i] + 2 * h[i - 1]];
    return (a + b) / (a / d[i - 1] + b / d[i]);
  });
  let k = 0;
  return at.map((x) => {
    while (k < n - 2 && x > xs[k + 1]) k++;
    const t = (x - xs[k]) / h[k];
    const [t2, t3] = [t * t, t * t * t];
    return (2 * t3 - 3 * t2 + 1) * vs[k] + (t3 - 2 * t2 + t) * h[k] * m[k] + (3 * t2 - 2 * t3) * vs[k + 1] + (t3 - t2) * h[k] * m[k + 1];
  });
}

/** The grid with `factor` times as many cells in each direction; every given value is kept. */
export function refine(grid: Grid, factor: number): Grid {
  const { xs, ys } = grid;
  const [nx, ny] = [xs.length, ys.length];
  if (factor <= 1) return grid;
  const fine = (list: number[]) => {
    const out: number[] = [];
    for (let i = 0; i + 1 < list.length; i++)
      for (let k = 0; k < factor; k++) out.push(list[i] + (k / factor) * (list[i + 1] - list[i]));
    out.push(list[list.length - 1]);
    return out;
  };
  const [fx, fy] = [fine(xs), fine(ys)];
  const along = (places: number[], finer: number[], line: (number | null)[], broken: (i: number) => boolean): (number | null)[] => {
    const out: (number | null)[] = new Array(finer.length).fill(null);
    let start = 0;
    while (start < line.length) {
      if (line[start] === null) {
        start++;
        continue;
      }
      let end = start;
      while (end + 1 < line.length && line[end + 1] !== null && !broken(end)) end++;
      const inside = finer.slice(start * factor, end * factor + 1);
      const found = monotone(places.slice(start, end + 1), line.slice(start, end + 1) as number[], inside);
      found.forEach((v, k) => (out[start * factor + k] = v));
      start = end + 1;
    }
    return out;
  };
  const cutX = (i: number) => Array.from({ length: ny - 1 }, (_, j) => j).every((j) => grid.cut?.(i, j));
  const cutY = (j: number) => Array.from({ length: nx - 1 }, (_, i) => i).every((i) => grid.cut?.(i, j));
  const rows = ys.map((_, j) => along(xs, fx, grid.values.slice(j * nx, (j + 1) * nx), (i) => !!grid.cut && ny > 1 && cutX(i)));
  const values: (number | null)[] = new Array(fx.length * fy.length).fill(null);
  for (let i = 0; i < fx.length; i++) {
    const column = rows.map((row) => row[i]);
    along(ys, fy, column, (j) => !!grid.cut && nx > 1 && cutY(j)).forEach((v, j) => (values[j * fx.length + i] = v));
  }
  const cut = grid.cut;
  return { xs: fx, ys: fy, values, cut: cut && ((i, j) => cut(Math.floor(i / factor), Math.floor(j / factor))) };
}

/** True if the cell with this lower left node has a surface. */
export function isCell({ xs, ys, values, cut }: Grid, i: number, j: number): boolean {
  const n = xs.length;
  if (i < 0 || j < 0 || i + 1 >= n || j + 1 >= ys.length) return false;
  const at = j * n + i;
  return values[at] !== null && values[at + 1] !== null && values[at + n] !== null && values[at + n + 1] !== null && !cut?.(i, j);
}

/** Value at a place by interpolation within its cell, otherwise absent. */
export function valueAt(grid: Grid, x: number, y: number): number | null {
  const place = (list: number[], v: number) => {
    let i = list.findIndex((p) => p > v) - 1;
    if (i === -2) i = v === list[list.length - 1] ? list.length - 2 : -1;
    return i;
  };
  const [i, j] = [place(grid.xs, x), place(grid.ys, y)];
  if (!isCell(grid, i, j)) return null;
  const n = grid.xs.length;
  const v = (di: number, dj: number) => grid.values[(j + dj) * n + i + di] as number;
  const s = (x - grid.xs[i]) / (grid.xs[i + 1] - grid.xs[i]);
  const t = (y - grid.ys[j]) / (grid.ys[j + 1] - grid.ys[j]);
  return (1 - t) * ((1 - s) * v(0, 0) + s * v(1, 0)) + t * ((1 - s) * v(0, 1) + s * v(1, 1));
}

interface Pieces {
  start: number[];
  end: number[];
  places: Map<number, Point>;
}

/** Directed pieces of a contour, higher values at their left; with `edges` those of the border of the surface, too. */
function pieces(grid: Grid, level: number, edges: boolean): Pieces {
  const { xs, ys, values } = grid;
  const nx = xs.length;
  const nodes = nx * ys.length;
  const all = 2 * nodes;
  const found: Pieces = { start: [], end: [], places: new Map() };
  const place = (node: number): Point => {
    if (node < nodes) return [xs[node % nx], ys[Math.floor(node / nx)]];
    const cell = node - nodes;
    const [i, j] = [cell % nx, Math.floor(cell / nx)];
    return [0.5 * (xs[i] + xs[i + 1]), 0.5 * (ys[j] + ys[j + 1])];
  };
  const value = (node: number): number => {
    if (node < nodes) return values[node] as number;
    const c = node - nodes;
    return 0.25 * ((values[c] as number) + (values[c + 1] as number) + (values[c + nx] as number) + (values[c + nx + 1] as number));
  };
  const crossing = (a: number, b: number): number => {
    const [p, q] = a < b ? [a, b] : [b, a];
    const key = p * all + q;
    if (!found.places.has(key)) {
      const [u, v] = [value(p), value(q)];
      const t = (level - u) / (v - u);
      const [s, e] = [place(p), place(q)];
      found.places.set(key, [s[0] + t * (e[0] - s[0]), s[1] + t * (e[1] - s[1])]);
    }
    return key;
  };
  const corner = (node: number): number => {
    const key = node * all + node;
    found.places.set(key, place(node));
    return key;
  };
  const inside = (node: number) => value(node) >= level;
  const add = (a: number, b: number) => {
    found.start.push(a);
    found.end.push(b);
  };
  for (let j = 0; j + 1 < ys.length; j++) {
    for (let i = 0; i + 1 < nx; i++) {
      if (!isCell(grid, i, j)) continue;
      const a = j * nx + i;
      const ring = [a, a + 1, a + nx + 1, a + nx];
      const centre = nodes + a;
      const count = ring.filter(inside).length;
      if (count > 0 && count < 4)
        for (let k = 0; k < 4; k++) {
          const triangle = [ring[k], ring[(k + 1) % 4], centre];
          const ins = triangle.map(inside);
          let [from, to] = [-1, -1];
          for (let e = 0; e < 3; e++) {
            const next = (e + 1) % 3;
            if (ins[e] && !ins[next]) from = crossing(triangle[e], triangle[next]);
            if (!ins[e] && ins[next]) to = crossing(triangle[e], triangle[next]);
          }
          if (from >= 0 && to >= 0) add(from, to);
        }
      if (!edges || count === 0) continue;
      const beyond: [number, number][] = [[i, j - 1], [i + 1, j], [i, j + 1], [i - 1, j]];
      for (let k = 0; k < 4; k++) {
        if (isCell(grid, ...beyond[k])) continue;
        const [s, e] = [ring[k], ring[(k + 1) % 4]];
        if (inside(s) && inside(e)) add(corner(s), corner(e));
        else if (inside(s)) add(corner(s), crossing(s, e));
        else if (inside(e)) add(crossing(s, e), corner(e));
      }
    }
  }
  return found;
}

function joined({ start, end, places }: Pieces): Point[][] {
  const leaving = new Map<number, number[]>();
  const arrives = new Set<number>(end);
  start.forEach((key, k) => {
    const list = leaving.get(key);
    if (list) list.push(k);
    else leaving.set(key, [k]);
  });
  const used = new Uint8Array(start.length);
  const lines: Point[][] = [];
  const follow = (first: number) => {
    const line: Point[] = [places.get(start[first])!];
    for (let k: number | undefined = first; k !== undefined; ) {
      used[k] = 1;
      line.push(places.get(end[k])!);
      k = leaving.get(end[k])?.find((next) => !used[next]);
    }
    lines.push(line);
  };
  // Open lines first, from their beginning.
  start.forEach((key, k) => {
    if (!used[k] && !arrives.has(key)) follow(k);
  });
  start.forEach((_, k) => {
    if (!used[k]) follow(k);
  });
  return lines;
}

/** Lines on which the value is `level`. */
export function isolines(grid: Grid, level: number): Point[][] {
  return joined(pieces(grid, level, false));
}

/** Closed borders of the part of the surface whose value is not below `level`; of the whole surface if the level is minus infinity. */
export function region(grid: Grid, level: number): Point[][] {
  return joined(pieces(grid, level, true));
}

export interface Label {
  x: number;
  y: number;
  /** Angle in degrees; the text is never upside down. */
  angle: number;
  level: number;
}

interface Box {
  x: number;
  y: number;
  radius: number;
}

/**
 * Places of the labels of contours: on straight stretches, inside the frame, away from each other and from what is already there.
 * The lines are in pixels, the width is that of the label's text.
 */
export function labels(
  lines: { level: number; line: Point[] }[],
  width: (level: number) => number,
  frame: { left: number; top: number; right: number; bottom: number },
  taken: Box[] = [],
): Label[] {
  const boxes = [...taken];
  const found: Label[] = [];
  const length = (line: Point[]) => line.reduce((sum, p, i) => (i ? sum + Math.hypot(p[0] - line[i - 1][0], p[1] - line[i - 1][1]) : 0), 0);
  const ordered = lines.map((l) => ({ ...l, length: length(l.line) })).sort((a, b) => b.length - a.length);
  const perLevel = new Map<number, number>();
  for (const { level, line, length: whole } of ordered) {
    const w = width(level) + 6;
    const had = perLevel.get(level) ?? 0;
    if (whole < 1.7 * w || had >= 3) continue;
    const walk = walker(line);
    const wanted = whole > 620 ? 2 : 1;
    let own = 0;
    const candidates: (Label & { score: number })[] = [];
    for (let s = 0.5 * w + 2; s <= whole - 0.5 * w - 2; s += 5) {
      const [p, q, m] = [walk(s - 0.5 * w), walk(s + 0.5 * w), walk(s)];
      const chord = Math.hypot(q[0] - p[0], q[1] - p[1]);
      const [x, y] = [(p[0] + q[0] + 2 * m[0]) / 4, (p[1] + q[1] + 2 * m[1]) / 4];
      const edge = 0.5 * w + 2;
      const [dx, dy] = [Math.abs(q[0] - p[0]) / (chord || 1), Math.abs(q[1] - p[1]) / (chord || 1)];
      const [rx, ry] = [dx * edge + dy * 7, dy * edge + dx * 7];
      if (x - rx < frame.left || x + rx > frame.right || y - ry < frame.top || y + ry > frame.bottom) continue;
      let angle = (Math.atan2(q[1] - p[1], q[0] - p[0]) * 180) / Math.PI;
      if (angle > 90) angle -= 180;
      if (angle < -90) angle += 180;
      // Straight, near the middle of the line, not steep.
      const score = 3 * (1 - chord / w) + 0.25 * Math.abs(s / whole - 0.5) + 0.12 * (Math.abs(angle) / 90);
      candidates.push({ x, y, angle, level, score });
    }
    candidates.sort((a, b) => a.score - b.score);
    for (const c of candidates) {
      if (own >= wanted) break;
      if (c.score > 1) break;
      if (found.some((f) => f.level === level && Math.hypot(f.x - c.x, f.y - c.y) < 240)) continue;
      if (boxes.some((b) => Math.hypot(b.x - c.x, b.y - c.y) < b.radius + 0.5 * w)) continue;
      boxes.push({ x: c.x, y: c.y, radius: 0.5 * w });
      found.push({ x: c.x, y: c.y, angle: c.angle, level });
      own++;
    }
    perLevel.set(level, had + own);
  }
  return found;
}

function walker(line: Point[]): (s: number) => Point {
  const sums = [0];
  for (let i = 1; i < line.length; i++) sums.push(sums[i - 1] + Math.hypot(line[i][0] - line[i - 1][0], line[i][1] - line[i - 1][1]));
  return (s) => {
    let k = sums.findIndex((sum) => sum >= s);
    if (k < 0) k = sums.length - 1;
    if (k === 0) return line[0];
    const t = (s - sums[k - 1]) / (sums[k] - sums[k - 1] || 1);
    return [line[k - 1][0] + t * (line[k][0] - line[k - 1][0]), line[k - 1][1] + t * (line[k][1] - line[k - 1][1])];
  };
}
