// Colours: of components by name, of values, of differences.

/**
 * Twenty colours, chosen one after the other for the largest distance in OKLab from all others, as seen with normal, red-blind and
 * green-blind eyes. Their lightness suits light and dark grounds.
 */
export const PALETTE = [
  "#1f77b4", "#e69f00", "#009e73", "#c44e8a", "#56b4e9", "#d76821", "#4b46ae", "#c1dd59", "#90266d", "#39d9ac",
  "#6f521c", "#f179b2", "#6b82ec", "#b2b77b", "#e66573", "#9ed5fd", "#915559", "#56a59b", "#a55c1e", "#7ac9d5",
];

/** The name behind which the same thing is meant: a measured line has the colour of the calculated one. */
export function stem(name: string): string {
  return name.replace(/[,:]?\s*\(?(measured|calculated)\)?$/i, "") || name;
}

/** Assigns a colour to every name; a name keeps its colour. */
export class ColourBook {
  private readonly known = new Map<string, number>();

  /** Index of a name, given on its first use. */
  index(name: string): number {
    const key = stem(name);
    let index = this.known.get(key);
    if (index === undefined) {
      index = this.known.size;
      this.known.set(key, index);
    }
    return index;
  }

  has(name: string): boolean {
    return this.known.has(stem(name));
  }

  colour(name: string): string {
    return PALETTE[this.index(name) % PALETTE.length];
  }

  /** True if the colour is used for the second time: then a pattern tells the names apart. */
  repeated(name: string): boolean {
    return this.index(name) >= PALETTE.length;
  }
}

/** Colours of lines: those that are legible as thin strokes. */
const STROKES = PALETTE.filter((_, k) => ![7, 9, 13, 15].includes(k));

/**
 * Colours of the lines of one picture: components keep theirs, names of the series have the same in all pictures, all others take what is
 * left.
 */
export function lineColours(names: string[], components: ColourBook, series: ColourBook): string[] {
  const used = new Map<string, string>();
  const taken = () => new Set(used.values());
  const known = (name: string) => (components.has(name) ? components.colour(name) : STROKES[series.index(name) % STROKES.length]);
  for (const name of names.filter((n) => components.has(n) || series.has(n))) if (!taken().has(known(name))) used.set(stem(name), used.get(stem(name)) ?? known(name));
  return names.map((name) => {
    const key = stem(name);
    const before = used.get(key);
    if (before !== undefined) return before;
    const others = taken();
    const colour = STROKES.find((c) => !others.has(c)) ?? PALETTE[others.size % PALETTE.length];
    used.set(key, colour);
    return colour;
  });
}

type Rgb = [number, number, number];

/** Anchors of viridis, whose lightness increases evenly. */
const VIRIDIS: Rgb[] = [
  [68, 1, 84], [72, 40, 120], [62, 74, 137], [49, 104, 142], [38, 130, 142], [31, 158, 137], [53, 183, 121], [109, 205, 89], [180, 222, 44], [253, 231, 37],
];

/** A colour of the scale of values, from zero to one. */
export function sequential(share: number): string {
  const place = Math.min(1, Math.max(0, share)) * (VIRIDIS.length - 1);
  const i = Math.min(VIRIDIS.length - 2, Math.floor(place));
  return css(VIRIDIS[i].map((a, k) => a + (place - i) * (VIRIDIS[i + 1][k] - a)) as Rgb);
}

/** Ends and middle of the scale of differences in OKLab. Between them all coordinates are linear, so that equal steps look equal. */
const BLUE: Rgb = [0.42, -0.03, -0.13];
const MIDDLE: Rgb = [0.97, 0, 0];
const ORANGE: Rgb = [0.5, 0.1, 0.1];

/** A colour of the scale of differences, from minus one to one: blue over white to orange. */
export function diverging(share: number): string {
  const end = share < 0 ? BLUE : ORANGE;
  const weight = Math.min(1, Math.abs(share));
  return css(fromOklab(MIDDLE.map((m, k) => m + weight * (end[k] - m)) as Rgb));
}

function fromOklab([l, a, b]: Rgb): Rgb {
  const p = (l + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const q = (l - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const r = (l - 0.0894841775 * a - 1.291485548 * b) ** 3;
  const linear: Rgb = [
    4.0767416621 * p - 3.3077115913 * q + 0.2309699292 * r,
    -1.2684380046 * p + 2.6097574011 * q - 0.3413193965 * r,
    -0.0041960863 * p - 0.7034186147 * q + 1.707614701 * r,
  ];
  return linear.map((c) => {
    const x = Math.min(1, Math.max(0, c));
    return 255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);
  }) as Rgb;
}

function css(c: Rgb): string {
  return "#" + c.map((x) => Math.round(x).toString(16).padStart(2, "0")).join("");
}

/** Relative luminance of a colour, from zero to one. */
export function luminance(colour: string): number {
  const part = (k: number) => {
    const x = parseInt(colour.slice(1 + 2 * k, 3 + 2 * k), 16) / 255;
    return x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4;
  };
  return 0.2126 * part(0) + 0.7152 * part(1) + 0.0722 * part(2);
}

/** Colours of the bands between levels, or of all values between two ends. */
export class ColourScale {
  constructor(
    readonly low: number,
    readonly high: number,
    /** Bands end at these values; without them the colours are continuous. */
    readonly levels: number[],
    readonly isDiverging: boolean,
    readonly banded: boolean,
  ) {}

  at(value: number): string {
    if (!this.banded) return this.continuous(value);
    let band = 0;
    while (band < this.levels.length && value >= this.levels[band]) band++;
    return this.band(band);
  }

  /** Colour of the band below level `k`; the last band is above all levels. */
  band(k: number): string {
    const { levels } = this;
    if (!this.isDiverging) return sequential(levels.length === 0 ? 0.5 : k / levels.length);
    const low = levels[k - 1] ?? (levels.length > 1 ? 2 * levels[0] - levels[1] : this.low);
    const high = levels[k] ?? (levels.length > 1 ? 2 * levels[levels.length - 1] - levels[levels.length - 2] : this.high);
    return this.continuous(0.5 * (low + high));
  }

  private continuous(value: number): string {
    const { low, high } = this;
    if (this.isDiverging) return diverging(value / (Math.max(Math.abs(low), Math.abs(high)) || 1));
    return sequential(high > low ? (value - low) / (high - low) : 0.5);
  }
}
