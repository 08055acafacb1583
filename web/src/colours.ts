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

/** Colours of the mechanisms, which their losses have everywhere; also red-blind and green-blind eyes tell them apart. */
export const MECHANISMS: Record<string, string> = {
  gear_mesh: PALETTE[0],
  bearing: PALETTE[1],
  gear_drag: "#12b488",
  seal: "#b83280",
  planetary_drag: PALETTE[4],
  clutch: PALETTE[5],
  synchronizer: "#5d55c8",
  auxiliary: PALETTE[7],
  chain: PALETTE[10],
  differential: "#702070",
  others: "#a9b0b8",
};

/** The mechanism of the components of a section of the gearbox. */
const SECTIONS: Record<string, string> = {
  meshes: "gear_mesh",
  bevel_meshes: "gear_mesh",
  worm_meshes: "gear_mesh",
  crossed_helical_meshes: "gear_mesh",
  gears: "gear_drag",
  bearings: "bearing",
  seals: "seal",
  planetary_sets: "planetary_drag",
  clutches: "clutch",
  couplings: "synchronizer",
  auxiliaries: "auxiliary",
  chains: "chain",
  differentials: "differential",
};

/** Shares of a loss that are the loss of a mechanism, or a part of it. */
const SHARES: Record<string, [mechanism: string, part: boolean]> = {
  "gears, load-dependent": ["gear_mesh", false],
  "gears, load-independent": ["gear_drag", false],
  "bearings, load-dependent": ["bearing", false],
  "bearings, load-independent": ["bearing", true],
  seals: ["seal", false],
  bevel_mesh: ["gear_mesh", true],
  worm_mesh: ["gear_mesh", true],
  crossed_helical_mesh: ["gear_mesh", true],
};

/** The mechanism of a name, and whether it is one of several parts with this mechanism: `bearings.B2` is one of the bearings. */
export function mechanismOf(name: string): [mechanism: string, part: boolean] | null {
  if (Object.hasOwn(SHARES, name)) return SHARES[name];
  if (Object.hasOwn(MECHANISMS, name)) return [name, false];
  const [, section, drag] = /^([a-z_]+)\.[\w-]+(\.drag\b.*)?$/.exec(name) ?? [];
  if (!section || !Object.hasOwn(SECTIONS, section)) return null;
  return [section === "meshes" && drag ? "gear_drag" : SECTIONS[section], true];
}

/** Lightness of the shades of a mechanism in OKLab, neighbours far from each other; all are visible on light and dark grounds. */
const SHADES = [0.62, 0.78, 0.46, 0.7, 0.54];

/** A shade of a colour: its hue with another lightness. */
function shade(colour: string, k: number): string {
  const [, a, b] = toOklab(colour);
  return css(fromOklab([SHADES[k % SHADES.length], a, b]));
}

/** A colour, and how often it was given to another name before: then a dash or a pattern tells them apart. */
export interface Look {
  colour: string;
  round: number;
}

/** Colours of names without a mechanism: first those that no mechanism has. */
const FREE = [...PALETTE.slice(8), ...PALETTE.slice(0, 8)];

/** Assigns a colour to every name; a name keeps its colour. Mechanisms have theirs, and components the shades of their mechanism's. */
export class ColourBook {
  /** Names by mechanism, and those without one. */
  private readonly known = new Map<string, string[]>();
  /** Components by the id at their end: lines of temperatures are named by it. */
  private readonly ids = new Map<string, string>();

  private index(group: string, name: string): number {
    const names = this.known.get(group) ?? [];
    this.known.set(group, names);
    return names.includes(name) ? names.indexOf(name) : names.push(name) - 1;
  }

  /** The colour of a name, which is given on its first use. */
  look(name: string): Look {
    const own = this.ids.get(stem(name)) ?? stem(name);
    const mechanism = mechanismOf(own);
    if (!mechanism) {
      const k = this.index("", own);
      return { colour: FREE[k % FREE.length], round: Math.floor(k / FREE.length) };
    }
    const base = MECHANISMS[mechanism[0]];
    if (!mechanism[1]) return { colour: base, round: 0 };
    const k = this.index(mechanism[0], own);
    const [, id, rest] = own.split(".");
    if (id && rest === undefined && !this.ids.has(id)) this.ids.set(id, own);
    return { colour: shade(base, k), round: Math.floor(k / SHADES.length) };
  }

  /** Place of a name without a mechanism in the order of first use. */
  place(name: string): number {
    return this.index("", stem(name));
  }

  has(name: string): boolean {
    return mechanismOf(stem(name)) !== null || this.ids.has(stem(name)) || (this.known.get("")?.includes(stem(name)) ?? false);
  }

  colour(name: string): string {
    return this.look(name).colour;
  }

  /** True if another name has the colour, too: then a pattern tells them apart. */
  repeated(name: string): boolean {
    return this.look(name).round > 0;
  }
}

/** Colours of lines: those that are legible as thin strokes. */
const STROKES = PALETTE.filter((_, k) => ![7, 9, 13, 15].includes(k));

/** Angle between the hues of two colours in degrees. */
function hueBetween(one: string, two: string): number {
  const [p, q] = [one, two].map((c) => toOklab(c)).map(([, a, b]) => (Math.atan2(b, a) * 180) / Math.PI);
  return Math.abs(((p - q + 540) % 360) - 180);
}

/**
 * Looks of the lines of one picture: components keep theirs, names of the series have the same in all pictures, all others take what is
 * left, without the hues of the mechanisms in the picture.
 */
export function lineLooks(names: string[], components: ColourBook, series: ColourBook): Look[] {
  const used = new Map<string, Look>();
  const taken = ({ colour, round }: Look) => [...used.values()].some((u) => u.colour === colour && u.round === round);
  for (const name of names.filter((n) => components.has(n))) used.set(stem(name), components.look(name));
  const hues = [...used.values()].map((look) => look.colour);
  const far = STROKES.filter((c) => hues.every((hue) => hueBetween(c, hue) > 20));
  const strokes = far.length >= 3 ? far : STROKES;
  const nth = (k: number): Look => ({ colour: strokes[k % strokes.length], round: Math.floor(k / strokes.length) });
  for (const name of names.filter((n) => series.has(n) && !used.has(stem(n)))) {
    const look = nth(series.place(name));
    if (!taken(look)) used.set(stem(name), look);
  }
  return names.map((name) => {
    const key = stem(name);
    let look = used.get(key);
    for (let k = 0; !look; k++) if (!taken(nth(k))) look = nth(k);
    used.set(key, look);
    return look;
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
  const light: Rgb = [
    4.0767416621 * p - 3.3077115913 * q + 0.2309699292 * r,
    -1.2684380046 * p + 2.6097574011 * q - 0.3413193965 * r,
    -0.0041960863 * p - 0.7034186147 * q + 1.707614701 * r,
  ];
  return light.map((c) => {
    const x = Math.min(1, Math.max(0, c));
    return 255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);
  }) as Rgb;
}

function toOklab(colour: string): Rgb {
  const [r, g, b] = [0, 1, 2].map((k) => linear(colour, k));
  const [l, m, s] = [
    Math.cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b),
    Math.cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b),
    Math.cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b),
  ];
  return [
    0.2104542553 * l + 0.793617785 * m - 0.0040720468 * s,
    1.9779984951 * l - 2.428592205 * m + 0.4505937099 * s,
    0.0259040371 * l + 0.7827717662 * m - 0.808675766 * s,
  ];
}

function css(c: Rgb): string {
  return "#" + c.map((x) => Math.round(x).toString(16).padStart(2, "0")).join("");
}

/** Red, green or blue of a colour as an amount of light, from zero to one. */
function linear(colour: string, k: number): number {
  const x = parseInt(colour.slice(1 + 2 * k, 3 + 2 * k), 16) / 255;
  return x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4;
}

/** Relative luminance of a colour, from zero to one. */
export function luminance(colour: string): number {
  return 0.2126 * linear(colour, 0) + 0.7152 * linear(colour, 1) + 0.0722 * linear(colour, 2);
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
