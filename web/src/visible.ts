// Texts of documents as they are shown. `framework/document/src/visible.rs` has the same list for the terminal and the report.

/** Control characters but line ends and tabs, marks of direction, characters without width, tags. */
const HIDDEN = /[\u0000-\u0008\u000b\u000c\u000e-\u001f\u007f-\u009f\u00ad\u061c\u180e\u200b-\u200f\u2028-\u202e\u2060-\u206f\ufeff\ufff9-\ufffb\u{e0000}-\u{e007f}]/gu;

/** A character as an escape, such as `\\u{202e}`. */
export function escaped(character: string): string {
  return `\\u{${character.codePointAt(0)!.toString(16)}}`;
}

/** A text with its hidden characters as escapes; all letters and signs of all languages stay. */
export function visible(text: string): string {
  return text.replace(HIDDEN, escaped);
}

/** The hidden characters, for an editor that marks them. */
export const hidden = () => new RegExp(HIDDEN.source, "gu");
