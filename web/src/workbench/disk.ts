// What the page does about files that change on the disk.

import { showDifference } from "./dialogs.ts";
import { merged } from "./diff.ts";
import type { Editor } from "./editor.ts";
import { plainLines } from "./ends.ts";
import type { Files } from "./files.ts";
import type { Notices } from "./notices.ts";

/** Takes the text of the disk where nothing is lost, and asks otherwise. */
export class Disk {
  constructor(
    private readonly files: Files,
    private readonly editor: Editor,
    private readonly notices: Notices,
    /** Watches the files as they are known now. */
    private readonly rewatch: () => void,
  ) {}

  changed(file: string, written: string, hash: string): void {
    const own = this.files.get(file);
    this.notices.hide(`unreadable ${file}`);
    if (!own) return;
    if (own.hash === hash) return this.files.setRemoved(file, false);
    const disk = plainLines(written);
    if (own.text === disk || !this.files.isEdited(file)) {
      this.files.setSaved(file, written, hash);
      this.editor.replace(file, disk);
      this.notices.hide(`disk ${file}`);
      this.rewatch();
      return;
    }
    const base = own.saved;
    // Until it is decided the file on the disk is not overwritten: the hash stays.
    const decide = (text: string | null) => {
      this.notices.hide(`disk ${file}`);
      this.files.setSaved(file, written, hash);
      if (text !== null) this.editor.replace(file, text);
      this.rewatch();
    };
    const both = own.hash === null ? null : merged(base, own.text, disk);
    const compare = async () => {
      const mine = this.files.get(file)?.text ?? "";
      const merge = own.hash === null ? null : merged(base, mine, disk);
      const labels = [...(merge === null ? [] : ["Merge both"]), "Keep mine", "Take the disk's"];
      const chosen = await showDifference(`${file} in the page and on the disk`, mine, disk, labels);
      const label = chosen === null ? null : labels[chosen];
      if (label === "Merge both") decide(merge);
      if (label === "Keep mine") decide(null);
      if (label === "Take the disk's") decide(disk);
    };
    this.notices.show(`disk ${file}`, {
      text: own.hash === null ? `${file} exists on the disk.` : `${file} was changed on the disk, and has text here that is not saved.`,
      kind: "warn",
      actions: [
        ...(both === null ? [] : [{ label: "Merge both", act: () => decide(merged(base, this.files.get(file)?.text ?? "", disk)), primary: true }]),
        { label: "Keep mine", act: () => decide(null) },
        { label: "Take the disk's", act: () => decide(disk) },
        { label: "Show both", act: () => void compare(), stays: true },
      ],
    });
  }

  removed(file: string): void {
    const own = this.files.get(file);
    if (!own || own.hash === null || own.removed) return;
    this.notices.hide(`unreadable ${file}`);
    this.files.setRemoved(file, true);
    this.notices.say(`${file} was removed from the disk. Its text is kept here; saving writes it again.`);
  }

  unreadable(file: string, reason: string): void {
    if (!this.files.get(file)) return;
    this.notices.show(`unreadable ${file}`, { text: `${file} was changed on the disk and cannot be read: ${reason}. The text here is the one before.`, kind: "bad", actions: [{ label: "Close", act: () => undefined }] });
  }
}
