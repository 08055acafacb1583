// The data of pictures, as the report crate writes them.

/** Name and values of a coordinate. */
export type Coordinate<T> = [name: string, values: T[]];

export type Best = "highest" | "lowest";

export interface Bar {
  label: string;
  shares: number[];
  above: string;
  measured: [value: number, accuracy: number] | null;
  above_measured: string;
}

export interface Bars {
  kind: "bars";
  title: string;
  over: string;
  height: string;
  names: string[];
  bars: Bar[];
}

export interface FieldMap {
  kind: "map";
  title: string;
  x: Coordinate<string>;
  y: Coordinate<string>;
  values: (number | null)[];
  unit: string;
  best: Best | null;
  jumps: boolean;
  diverging: boolean;
  ends: [number, number] | null;
  hatched: boolean[];
  hatching: "validity" | "limit";
  marks: [number, number][];
  marked: string;
  crossed: [cell: number, text: string] | null;
  unseen: number | null;
}

export interface Cloud {
  kind: "cloud";
  title: string;
  axes: [string, string];
  points: [x: number, y: number, value: number][];
  sizes: number[];
  sized: string;
  unit: string;
  diverging: boolean;
}

export interface Line {
  name: string;
  points: ([number, number] | null)[];
  stroke: "line" | "marked" | "dots";
}

export interface Lines {
  kind: "lines";
  title: string;
  x: string;
  y: string;
  lines: Line[];
}

export interface Areas {
  kind: "areas";
  title: string;
  x: string;
  y: string;
  names: string[];
  places: number[];
  stacks: number[][];
}

export interface Interval {
  name: string;
  at: number;
  ends: [number, number] | null;
  before: number | null;
}

export interface Intervals {
  kind: "intervals";
  title: string;
  x: string;
  marks: number[];
  key: [string, string, string];
  list: Interval[];
}

export interface PanelQuantity {
  name: string;
  unit: string;
  diverging: boolean;
  best: Best | null;
  jumps: boolean;
  panels: ((number | null)[] | null)[];
}

export interface Panels {
  kind: "panels";
  title: string;
  rows: string[];
  columns: string[];
  x: Coordinate<number>;
  y: Coordinate<number>;
  slider: Coordinate<string> | null;
  quantities: PanelQuantity[];
  outside: boolean[][];
  marks: [x: number, y: number][];
  marked: string;
  powers: number[];
  envelope: [x: number, most: number][];
  breakdown: { names: string[]; panels: (number[] | null)[] } | null;
}

export interface Panes {
  kind: "panes";
  title: string;
  x: string;
  panes: { y: string; lines: Line[] }[];
}

export interface Waterfall {
  kind: "waterfall";
  title: string;
  unit: string;
  ends: [[string, number], [string, number]];
  losses: [name: string, group: string, value: number][];
}

export interface Tornado {
  kind: "tornado";
  title: string;
  x: string;
  base: number;
  bars: { name: string; results: [number, number]; ends: [string, string] }[];
}

export type Picture = Bars | FieldMap | Cloud | Lines | Areas | Intervals | Panels | Panes | Waterfall | Tornado;
