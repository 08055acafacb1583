// Tables of the page: sorting, copying, files.

/** The number at the beginning of a cell, NaN if there is none. */
export function numberOf(text: string): number {
  const plain = text.replace(/[\u2212\u2013](?=\d)/g, "-").replace(/(\d)[\u202f\u2009\u00a0](?=\d{3})/g, "$1");
  const found = /^\s*([+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?)\s*(%|[a-zA-Z°µ/²³]{1,8})?\s*$/i.exec(plain);
  return found ? Number(found[1]) : NaN;
}

/** True if all cells with a value are numbers, and there is one. */
export function isNumeric(cells: string[]): boolean {
  const filled = cells.filter((c) => !/^\s*[-–—]?\s*$/.test(c));
  return filled.length > 0 && filled.every((c) => !Number.isNaN(numberOf(c)));
}

/** Order of rows by a column; rows without a value come last. */
export function order(cells: string[], descending: boolean): number[] {
  const numeric = isNumeric(cells);
  const sign = descending ? -1 : 1;
  const collator = new Intl.Collator("en", { numeric: true });
  const empty = (c: string) => /^\s*[-–—]?\s*$/.test(c);
  return cells
    .map((_, k) => k)
    .sort((a, b) => {
      const [p, q] = [cells[a], cells[b]];
      if (empty(p) !== empty(q)) return empty(p) ? 1 : -1;
      const by = empty(p) ? 0 : numeric ? numberOf(p) - numberOf(q) : collator.compare(p, q);
      return sign * by || a - b;
    });
}

/** A text that no spreadsheet takes for a formula: an apostrophe marks it as text. Numbers and a sign alone stay. */
function inert(text: string): string {
  const formula = /^[=+\-@\t\r]/.test(text) && text.length > 1 && Number.isNaN(Number(text));
  return formula ? `'${text}` : text;
}

/** Rows as CSV (RFC 4180). */
export function csv(rows: string[][]): string {
  const cell = (own: string) => quoted(inert(own));
  const quoted = (text: string) => (/[",\r\n]|^\s|\s$/.test(text) ? `"${text.replace(/"/g, '""')}"` : text);
  return rows.map((row) => row.map(cell).join(",") + "\r\n").join("");
}

/** Rows separated by tabs, for spreadsheets. */
export function tabbed(rows: string[][]): string {
  return rows.map((row) => row.map((c) => inert(c).replace(/[\t\r\n]+/g, " ")).join("\t") + "\n").join("");
}

function rowsOf(table: HTMLTableElement): string[][] {
  return [...table.rows].map((row) => [...row.cells].map((cell) => (cell.dataset.text ?? cell.textContent ?? "").trim()));
}

/** Makes a table sortable and adds its tools. */
export function equip(table: HTMLTableElement, name: string): void {
  const body = table.tBodies[0];
  const head = table.tHead?.rows[0];
  if (!body || !head) return;
  const rows = [...body.rows];
  const column = (k: number) => rows.map((row) => row.cells[k]?.textContent?.trim() ?? "");
  [...head.cells].forEach((cell, k) => {
    const numeric = isNumeric(column(k));
    if (numeric) for (const row of table.rows) row.cells[k]?.classList.add("number");
    if (rows.length < 2) return;
    const text = cell.textContent ?? "";
    cell.dataset.text ??= text;
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = text;
    if (!text.trim()) button.setAttribute("aria-label", "sort");
    cell.replaceChildren(button);
    button.addEventListener("click", () => {
      const before = cell.getAttribute("aria-sort");
      // The first click shows the largest number, or the first word.
      const descending = before ? before === "ascending" : numeric;
      for (const other of head.cells) other.removeAttribute("aria-sort");
      cell.setAttribute("aria-sort", descending ? "descending" : "ascending");
      body.append(...order(column(k), descending).map((n) => rows[n]));
    });
  });
  const tools = document.createElement("div");
  tools.className = "tools";
  const tool = (text: string, label: string, act: (button: HTMLButtonElement) => void) => {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = text;
    button.setAttribute("aria-label", `${label}: ${name}`);
    button.addEventListener("click", () => act(button));
    tools.append(button);
  };
  tool("Copy", "Copy the table", (button) => {
    copy(tabbed(rowsOf(table))).then(
      () => told(button, "Copied"),
      () => told(button, "Not permitted"),
    );
  });
  tool("CSV", "Download the table as CSV", () => {
    const link = document.createElement("a");
    const file = name.toLowerCase().replace(/[^a-z0-9]+/g, "-").replace(/^-|-$/g, "") || "table";
    link.href = URL.createObjectURL(new Blob(["\ufeff", csv(rowsOf(table))], { type: "text/csv" }));
    link.download = `${file.slice(0, 60)}.csv`;
    link.click();
    URL.revokeObjectURL(link.href);
  });
  table.closest(".table")?.prepend(tools);
}

function told(button: HTMLButtonElement, text: string): void {
  const before = button.textContent;
  button.textContent = text;
  setTimeout(() => (button.textContent = before), 1500);
}

async function copy(text: string): Promise<void> {
  if (navigator.clipboard && window.isSecureContext) return navigator.clipboard.writeText(text);
  // Pages from a file have no clipboard interface in every browser.
  const area = document.createElement("textarea");
  area.value = text;
  area.style.position = "fixed";
  area.style.opacity = "0";
  document.body.append(area);
  area.select();
  const done = document.execCommand("copy");
  area.remove();
  if (!done) throw new Error("copy");
}
