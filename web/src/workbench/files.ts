// The files that the page holds: their text, what is on the disk, which are unsaved.

import type { Texts } from "./protocol.ts";

export type Kind = "gearbox" | "study" | "other";

export interface OpenFile {
  file: string;
  /** Text on the disk as the page knows it; empty for a new file. */
  saved: string;
  /** Hash of that text; null for a file that is not on the disk. */
  hash: string | null;
  text: string;
  /** True if lines end with `\r\n` on the disk. In the page they end with `\n`, as in the editor, which counts a break as one character. */
  crlf: boolean;
}

/** A text with the line ends of the page. */
export const plainLines = (text: string) => text.replace(/\r\n/g, "\n");

/** What a text is, by its first key. */
export function kindOf(text: string): Kind {
  const found = /^gearloss:\s*["']?(gearbox|study)\//m.exec(text);
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
    const own: OpenFile = { file, saved: hash === null ? "" : plain, hash, text: plain, crlf: hash !== null && plain !== text };
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

  setText(file: string, text: string): void {
    const own = this.open.get(file);
    if (!own || own.text === text) return;
    own.text = text;
    this.changed(own);
  }

  /** Notes what is on the disk. */
  setSaved(file: string, text: string, hash: string | null): void {
    const own = this.open.get(file);
    if (!own) return;
    own.saved = plainLines(text);
    if (hash !== null) own.crlf = own.saved !== text;
    own.hash = hash;
    this.changed(own);
  }

  isUnsaved(file: string): boolean {
    const own = this.open.get(file);
    return own !== undefined && (own.hash === null || own.text !== own.saved);
  }

  unsaved(): OpenFile[] {
    return [...this.open.values()].filter((f) => this.isUnsaved(f.file));
  }

  /** Texts that differ from the disk; also those that differ in their line ends alone, so that offsets are those of the page. */
  texts(): Texts {
    const differ = [...this.open.values()].filter((f) => f.crlf || this.isUnsaved(f.file));
    return Object.fromEntries(differ.map((f) => [f.file, f.text]));
  }

  /** The text as it is written to the disk. */
  onDisk(file: string): string {
    const own = this.open.get(file);
    return !own ? "" : own.crlf ? own.text.replace(/\n/g, "\r\n") : own.text;
  }

  /** All texts, to keep a state that does not depend on the disk. */
  everything(): Texts {
    return Object.fromEntries([...this.open.values()].map((f) => [f.file, f.text]));
  }

  private changed(own: OpenFile): void {
    for (const act of this.listeners) act(own);
  }
}
