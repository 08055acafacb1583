// The files that the page holds: their text, what is on the disk, which are unsaved.

import { plainLines, withEnds } from "./ends.ts";
import type { Texts } from "./protocol.ts";

export type Kind = "gearbox" | "study" | "other";

export interface OpenFile {
  file: string;
  /** Text on the disk as the page knows it, with the line ends of the page; empty for a new file. */
  saved: string;
  /** That text with its line ends. */
  disk: string;
  /** Hash of that text; null for a file that was never on the disk. */
  hash: string | null;
  /** True if the file was removed from the disk; what it was stays known, for a merge if it comes back. */
  removed: boolean;
  text: string;
}

/** What a text is, by its first key. */
export function kindOf(text: string): Kind {
  const found = /^\uFEFF?(?:gearloss|"gearloss"|'gearloss')\s*:\s*["']?(gearbox|study)\//m.exec(text);
  return found ? (found[1] as Kind) : "other";
}

/** The last part of a path, with its folder if another file ends in the same way. */
export function shortName(file: string, all: string[]): string {
  const end = (path: string, parts: number) => path.split("/").slice(-parts).join("/");
  for (let parts = 1; ; parts++) {
    const name = end(file, parts);
    if (name === file || all.every((other) => other === file || end(other, parts) !== name)) return name;
  }
}

export class Files {
  readonly open = new Map<string, OpenFile>();
  private readonly listeners: ((file: OpenFile) => void)[] = [];

  /** Calls `act` after a change of the text of a file or of what is saved. */
  onChange(act: (file: OpenFile) => void): void {
    this.listeners.push(act);
  }

  add(file: string, text: string, hash: string | null): OpenFile {
    const plain = plainLines(text);
    const own: OpenFile = { file, saved: hash === null ? "" : plain, disk: hash === null ? "" : text, hash, removed: false, text: plain };
    this.open.set(file, own);
    this.changed(own);
    return own;
  }

  get(file: string): OpenFile | undefined {
    return this.open.get(file);
  }

  close(file: string): void {
    this.open.delete(file);
  }

  /** Gives a text another name, under which no file is on the disk; its place among the open files stays. */
  rename(file: string, name: string): void {
    const all = [...this.open.values()];
    this.open.clear();
    for (const own of all) {
      if (own.file === file) Object.assign(own, { file: name, saved: "", hash: null, removed: false });
      this.open.set(own.file, own);
    }
  }

  setText(file: string, text: string): void {
    const own = this.open.get(file);
    if (!own || own.text === text) return;
    own.text = text;
    this.changed(own);
  }

  /** Notes what is on the disk. */
  setSaved(file: string, text: string, hash: string): void {
    const own = this.open.get(file);
    if (!own) return;
    Object.assign(own, { saved: plainLines(text), disk: text, hash, removed: false });
    this.changed(own);
  }

  /** Notes that a file is no longer, or again, on the disk. */
  setRemoved(file: string, removed: boolean): void {
    const own = this.open.get(file);
    if (!own || own.removed === removed) return;
    own.removed = removed;
    this.changed(own);
  }

  isUnsaved(file: string): boolean {
    const own = this.open.get(file);
    return own !== undefined && (own.hash === null || own.removed || own.text !== own.saved);
  }

  /** True if the text is not the one that was read or saved last, whether the file is still there or not. */
  isEdited(file: string): boolean {
    const own = this.open.get(file);
    return own !== undefined && (own.hash === null || own.text !== own.saved);
  }

  unsaved(): OpenFile[] {
    return [...this.open.values()].filter((f) => this.isUnsaved(f.file));
  }

  /** Texts that differ from the disk; also those that differ in their line ends alone, so that offsets are those of the page. */
  texts(): Texts {
    const differ = [...this.open.values()].filter((f) => f.disk !== f.saved || this.isUnsaved(f.file));
    return Object.fromEntries(differ.map((f) => [f.file, f.text]));
  }

  /** The text as it is written to the disk. */
  onDisk(file: string): string {
    const own = this.open.get(file);
    return own ? withEnds(own.disk, own.text) : "";
  }

  /** All texts, to keep a state that does not depend on the disk. */
  everything(): Texts {
    return Object.fromEntries([...this.open.values()].map((f) => [f.file, f.text]));
  }

  private changed(own: OpenFile): void {
    for (const act of this.listeners) act(own);
  }
}
