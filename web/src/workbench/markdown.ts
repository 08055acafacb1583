// The part of Markdown that explanations use, as elements: paragraphs, headings, lists, rules, code, bold, emphasis, links as text. No HTML passes.

import { visible } from "../visible.ts";

export type Piece = { text: string; style?: "code" | "bold" | "emphasis" };

export type Block =
  | { kind: "paragraph" | "heading"; pieces: Piece[] }
  | { kind: "rule" }
  | { kind: "code"; text: string }
  | { kind: "list"; items: Piece[][] }
  | { kind: "table"; rows: Piece[][][] };

/** Text with code, bold and emphasis. */
export function pieces(text: string): Piece[] {
  const found: Piece[] = [];
  const push = (own: Piece) => {
    if (own.text) found.push(own);
  };
  let last = 0;
  const pattern = /`([^`]+)`|\*\*([^*]+)\*\*|(?<![\w*])\*([^*\s][^*]*)\*(?![\w*])|\[([^\]]+)\]\([^)\s]*\)|\\([\\`*_{}[\]()#+\-.!<>|])/g;
  for (const match of text.matchAll(pattern)) {
    push({ text: text.slice(last, match.index) });
    if (match[1] !== undefined) push({ text: match[1], style: "code" });
    else if (match[2] !== undefined) push({ text: match[2], style: "bold" });
    else if (match[3] !== undefined) push({ text: match[3], style: "emphasis" });
    else push({ text: match[4] ?? match[5] ?? "" });
    last = match.index + match[0].length;
  }
  push({ text: text.slice(last) });
  return found;
}

export function blocks(markdown: string): Block[] {
  const found: Block[] = [];
  const lines = markdown.replace(/\r\n?/g, "\n").split("\n");
  let paragraph: string[] = [];
  const close = () => {
    if (paragraph.length) found.push({ kind: "paragraph", pieces: pieces(paragraph.join(" ")) });
    paragraph = [];
  };
  for (let k = 0; k < lines.length; k++) {
    const line = lines[k];
    const fence = /^\s*(```+|~~~+)/.exec(line);
    if (fence) {
      close();
      const code: string[] = [];
      while (++k < lines.length && !lines[k].trim().startsWith(fence[1])) code.push(lines[k]);
      found.push({ kind: "code", text: code.join("\n") });
      continue;
    }
    if (!line.trim()) {
      close();
      continue;
    }
    if (/^ {0,3}([-*_])(?: *\1){2,} *$/.test(line)) {
      close();
      found.push({ kind: "rule" });
      continue;
    }
    const heading = /^#{1,6}\s+(.*)$/.exec(line);
    if (heading) {
      close();
      found.push({ kind: "heading", pieces: pieces(heading[1]) });
      continue;
    }
    const item = /^\s*(?:[-*+]|\d+[.)])\s+(.*)$/.exec(line);
    if (item) {
      close();
      const last = found[found.length - 1];
      const before = lines[k - 1] ?? "";
      if (last?.kind === "list" && before.trim()) last.items.push(pieces(item[1]));
      else found.push({ kind: "list", items: [pieces(item[1])] });
      continue;
    }
    if (/^\s*\|.*\|\s*$/.test(line)) {
      close();
      const cells = line.trim().slice(1, -1).split("|").map((c) => c.trim());
      const last = found[found.length - 1];
      const goes = last?.kind === "table" && (lines[k - 1] ?? "").trim().startsWith("|");
      if (cells.every((c) => /^:?-+:?$/.test(c))) continue;
      if (goes) (last as { rows: Piece[][][] }).rows.push(cells.map(pieces));
      else found.push({ kind: "table", rows: [cells.map(pieces)] });
      continue;
    }
    paragraph.push(line.trim());
  }
  close();
  return once(found);
}

/** Without paragraphs that were there already, and without rules that then divide nothing. */
function once(list: Block[]): Block[] {
  const seen = new Set<string>();
  const kept: Block[] = [];
  for (const block of list) {
    const key = JSON.stringify(block);
    if (block.kind === "paragraph" && seen.has(key)) continue;
    if (block.kind === "rule" && (kept.length === 0 || kept[kept.length - 1].kind === "rule")) continue;
    seen.add(key);
    kept.push(block);
  }
  if (kept[kept.length - 1]?.kind === "rule") kept.pop();
  return kept;
}

function write(parent: Element, list: Piece[]): void {
  for (const { text, style } of list) {
    if (!style) {
      parent.append(visible(text));
      continue;
    }
    const element = document.createElement({ code: "code", bold: "strong", emphasis: "em" }[style]);
    element.textContent = visible(text);
    parent.append(element);
  }
}

/** Adds the elements of a text to a parent. */
export function render(parent: Element, markdown: string): void {
  const add = (name: string, to: Element = parent) => {
    const element = document.createElement(name);
    to.append(element);
    return element;
  };
  for (const block of blocks(markdown)) {
    switch (block.kind) {
      case "paragraph":
        write(add("p"), block.pieces);
        break;
      case "heading":
        write(add("strong", add("p")), block.pieces);
        break;
      case "rule":
        add("hr");
        break;
      case "code":
        add("pre").textContent = visible(block.text);
        break;
      case "list": {
        const list = add("ul");
        for (const item of block.items) write(add("li", list), item);
        break;
      }
      case "table": {
        const table = add("table");
        for (const row of block.rows) {
          const line = add("tr", table);
          for (const cell of row) write(add("td", line), cell);
        }
      }
    }
  }
}
