// Sentences of the program: names and texts of documents, which it writes between backticks, are shown as code.

import { html } from "../svg.ts";
import { visible } from "../visible.ts";

/** Appends a sentence. */
export function prose(parent: Element, text: string): void {
  text.split("`").forEach((part, k, all) => {
    // What follows a single backtick is no name.
    const isName = k % 2 === 1 && k < all.length - 1;
    if (isName) html(parent, "code", {}, part);
    else parent.append(visible(k % 2 === 1 ? `\`${part}` : part));
  });
}
