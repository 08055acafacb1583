// What the page asks and what the program answers: the JSON of `framework/workbench/src/request.rs` and `answer.rs`.
//
// Every request is one JSON object. Files are paths relative to the opened folder with `/`. A request carries the texts that the page
// holds and that may differ from the disk, so the program keeps no state for a page and two tabs do not see each other's text.
// Offsets in texts count bytes of UTF-8.

import type { Picture } from "../types.ts";

/** Unsaved texts by file. */
export type Texts = Record<string, string>;

export interface Place {
  line: number; // from zero
  utf8: number;
  utf16: number;
}

export interface TextRange {
  from: number; // byte
  to: number;
  start: Place;
  end: Place;
}

export interface FileRange {
  file: string;
  range: TextRange;
}

export interface Finding {
  severity: "error" | "warning";
  code: string;
  path: string;
  message: string;
  help: string | null;
  notes: string[];
  place: FileRange | null;
  related: (FileRange & { message: string })[];
}

export interface Completion {
  label: string;
  kind: string;
  detail: string;
  documentation: string;
  insert: string;
  range: TextRange;
  required: boolean;
}

/** Requests of the editor. */
export type EditRequest =
  | { request: "findings" | "symbols"; file: string }
  | { request: "completion" | "hover" | "definition" | "references"; file: string; offset: number }
  | { request: "rename"; file: string; offset: number; name: string };

export type EditAnswer =
  | { answer: "findings"; value: Finding[] }
  | { answer: "completion"; value: Completion[] }
  | { answer: "hover"; value: { text: string; range: TextRange } | null } // Markdown
  | { answer: "places"; value: FileRange[] }
  | { answer: "edits"; value: { file: string; edits: { range: TextRange; insert: string }[] }[] }
  | { answer: "no_rename"; value: { message: string; help: string } }
  | { answer: "symbols"; value: EditSymbol[] }
  | { answer: "interrupted" };

export interface EditSymbol {
  name: string;
  detail: string;
  is_id: boolean;
  range: TextRange;
  key: TextRange;
  children: EditSymbol[];
}

/** A speed or torque that a gear needs, with the range of its slider. */
export interface Input {
  quantity: "torque" | "speed";
  port: string;
  unit: string; // "Nm", "rpm"
  from: number;
  to: number;
  value: number;
}

/** What a point of a gearbox is made of. */
export interface Controls {
  title: string;
  gears: { name: string; inputs: Input[] }[];
  /** Names of model sets; `""` is the models of the gearbox itself and is always the first. */
  model_sets: string[];
  /** How the oil temperature is found if none is given, and the one in the file for `fixed`. */
  oil: { mode: "fixed" | "balance" | "network"; value: number | null };
  /** Volume of the oil in the file or of its level, with the range of its slider in l; null if the oil space is not known. */
  fill: { from: number; to: number; value: number } | null;
}

/** A point of a gearbox. */
export interface PointOf {
  gearbox: string; // file
  gear: string;
  inputs: { quantity: "torque" | "speed"; port: string; value: number }[]; // Nm, rpm
  /** degC; null: as the file says (fixed temperature, balance or network). */
  oil_temperature: number | null;
  /** l; null: as the file says. The level follows from it. */
  oil_volume: number | null;
  model_set: string;
}

export interface ConvergenceStep {
  temperature: number; // degC
  residual: number; // in `unit` of the convergence
}

/** How the temperature was found. */
export interface Convergence {
  /** `fixed`: no search, no steps. */
  of: "fixed" | "balance" | "network";
  /** The end of the search, in one or several lines. */
  outcome: string;
  /** Of the residual: W, or for a network K, the largest difference of a node from the temperature that its heat brings about. */
  unit: "W" | "K";
  /** Number of steps at the start that only scan the range for all solutions. */
  scanned: number;
  steps: ConvergenceStep[];
  /** Loss and dissipated heat over temperature, for `balance`; else null. */
  picture: Picture | null;
}

export interface PointAnswer {
  /** The record of `gearloss solve --format json`. */
  point: Record<string, any>;
  /** Text and tables of `gearloss solve`. */
  blocks: Block[];
  status: string;
  loss: number | null; // W
  efficiency: number | null; // 0..1
  oil: number | null; // degC
  /** Loss of each component, the largest first. */
  losses: { path: string; mechanism: string; model: string; loss: number | null; load_dependent: number | null }[];
  /** Loss of each part of the drawing, for colouring. [W] */
  drawing: [path: string, loss: number][];
  /** From the input to the output power. */
  waterfall: Picture | null;
  /** Cross-section of the housing with the levels of its oil, an `<svg>` element; null if the oil space is not known. */
  oil_section: string | null;
  convergence: Convergence;
  /** Notes, the worst first: outside stated ranges, missing models, evidence. */
  remarks: string[];
}

export interface MapOf {
  gearbox: string;
  gear: string;
  model_set: string;
  oil_temperature: number | null;
  oil_volume: number | null;
  torque: { from: number; to: number }; // Nm
  speed: { from: number; to: number }; // rpm
  /** Torques and speeds, each; at most 60. */
  count: number;
}

/** Pictures and texts of one analysis, as in the report. */
export interface Section {
  name: string;
  title: string;
  about: string;
  note: string | null;
  failed: string | null;
  headline: string | null;
  key_figures: { label: string; value: string; unit: string; detail: string }[];
  limits: string[];
  careful: string[];
  verdicts: string[];
  outside: string[];
  blocks: Block[];
  pictures: Picture[];
}

/** A table; its first row is the head. */
export interface Table {
  title: string;
  rows: string[][];
}

/** Lines of text, or a table. */
export type Block = { text: string } | { table: Table };

/** A field of a form, at a path of the description. */
export interface Field {
  path: string;
  label: string;
  kind: "text" | "integer" | "number" | "quantity" | "bearing" | "oil" | "material" | "choice";
  /** What is in the template, such as `25 mm`; empty if nothing has to be typed. */
  value: string;
  help: string;
  /** Of a choice. */
  choices?: string[];
  /** A value of a field that may stay empty. */
  example?: string;
}

export interface Layout {
  name: string;
  about: string;
  groups: { title: string; fields: Field[]; folded?: boolean }[];
}

/** A catalogue that the program searches. */
export type CatalogueOf = "bearings" | "oils" | "materials";

export interface CatalogueRow {
  designation: string;
  data: [key: string, value: string][];
  confidence: string;
  origin: string;
}

/** A text that is not saved. */
export interface Draft {
  file: string;
  text: string;
  /** Hash of the file on the disk from which the text was made; null for a new file. */
  hash: string | null;
  /** Text of that file, for a merge. */
  base: string;
  time: number; // ms since 1970
}

/** A draft that the program keeps. */
export interface KeptDraft {
  id: string;
  /** Tab that kept it. */
  tab: string;
  draft: Draft;
}

export type Request =
  | { request: "hello" } // carries nothing: whether the program answers
  | { request: "folder" }
  | { request: "read"; file: string }
  | { request: "save"; file: string; text: string; hash: string | null } // hash of the file as read; null: a new file
  | { request: "keep"; tab: string; draft: Draft }
  | { request: "forget"; id: string }
  | { request: "drafts" }
  | { request: "edit"; texts: Texts; edit: EditRequest }
  | { request: "controls"; texts: Texts; gearbox: string }
  | ({ request: "point"; texts: Texts } & PointOf)
  | { request: "drawing"; texts: Texts; gearbox: string }
  | ({ request: "explain"; texts: Texts; part: string } & PointOf)
  | ({ request: "map"; texts: Texts } & MapOf)
  | { request: "analyses"; texts: Texts; study: string }
  | { request: "run"; texts: Texts; study: string; analyses: string[] } // none named: all, and the report
  | { request: "new"; layout: string; values: Record<string, string> } // path to what was typed
  | { request: "new_study"; texts: Texts; gearbox: string } // to be saved in the folder of the gearbox
  | { request: "catalogue"; of: CatalogueOf; text: string }
  | { request: "watch"; files: Record<string, string> }; // file to the hash that the page knows; "": the file is not there

export interface Answers {
  folder: {
    name: string;
    version: string;
    files: { file: string; kind: "gearbox" | "study" | "other" }[];
    /** The file that the command line names. */
    open: string | null;
    layouts: Layout[];
  };
  read: { text: string; hash: string };
  save: { saved: string } | { changed: { text: string | null; hash: string | null } }; // changed: what is on the disk instead
  hello: null;
  keep: { id: string };
  forget: null;
  /** Of this program, and of those that have ended. */
  drafts: KeptDraft[];
  edit: EditAnswer;
  controls: Controls;
  point: PointAnswer;
  /** Where each part of the drawing (`data-part`) is described. */
  drawing: { svg: string; places: Record<string, FileRange> };
  explain: { text: string };
  map: Section;
  analyses: { name: string; title: string; type: string; about: string }[];
  /** Text; values that follow from what was typed, by path of the field; ratios without errors. */
  new: { text: string; followed: Record<string, string>; ratios: { gear: string; to: string; ratio: number }[] };
  new_study: { text: string };
  catalogue: CatalogueRow[];
}

/** What cannot be answered: findings of `check`, or one sentence. */
export interface Fault {
  message: string;
  help: string | null;
  findings: Finding[];
}

/** An answer to every request but `run` and `watch`. */
export type Answer<R extends keyof Answers> = { value: Answers[R] } | { fault: Fault };

/** A line of the stream that answers `run`. */
export type RunEvent =
  | { event: "begin"; analysis: string; title: string }
  | { event: "progress"; analysis: string; label: string; done: number; count: number }
  | { event: "section"; section: Section }
  | { event: "report"; address: string } // of the page of the report
  | { event: "fault"; fault: Fault }
  | { event: "end"; failed: number };

/** A line of the stream that answers `watch`; it has at least one line in five seconds. */
export type WatchEvent =
  | { event: "alive" }
  | { event: "changed"; file: string; text: string; hash: string }
  | { event: "unreadable"; file: string; reason: string } // no text, or too long
  | { event: "removed"; file: string };
