// A field that searches the catalogue: a list of designations with their data below it.

import { html, unique } from "../svg.ts";
import { words } from "../format.ts";
import { Quiet } from "./pace.ts";
import type { CatalogueOf, CatalogueRow } from "./protocol.ts";

/** Makes a text field search; `chosen` is called after a row was taken. */
export function searches(input: HTMLInputElement, of: CatalogueOf, ask: (of: CatalogueOf, text: string) => Promise<CatalogueRow[] | null>, chosen: () => void): void {
  const id = unique("hits");
  const list = html(null, "ul", { class: "hits", role: "listbox", id, "aria-label": `${of} of the catalogue`, hidden: "" });
  // After the field, not over it: the fields below stay in reach.
  input.parentElement!.append(list);
  for (const [key, value] of Object.entries({ role: "combobox", "aria-expanded": "false", "aria-controls": id, "aria-autocomplete": "list", autocomplete: "off" })) input.setAttribute(key, value);
  let rows: CatalogueRow[] = [];
  let at = -1;
  const close = () => {
    list.hidden = true;
    at = -1;
    input.setAttribute("aria-expanded", "false");
    input.removeAttribute("aria-activedescendant");
  };
  const take = (k: number) => {
    if (!rows[k]) return;
    input.value = rows[k].designation;
    search.cancel();
    close();
    chosen();
  };
  const mark = () => {
    [...list.children].forEach((item, k) => item.setAttribute("aria-selected", String(k === at)));
    if (at >= 0) {
      input.setAttribute("aria-activedescendant", `${id}-${at}`);
      list.children[at].scrollIntoView({ block: "nearest" });
    }
  };
  const search = new Quiet(90, async () => {
    let found: CatalogueRow[] | null;
    try {
      found = await ask(of, input.value.trim());
    } catch {
      return close();
    }
    if (!found || document.activeElement !== input) return;
    rows = found.slice(0, 60);
    at = -1;
    list.replaceChildren();
    rows.forEach((row, k) => {
      const item = html(list, "li", { role: "option", id: `${id}-${k}`, "aria-selected": "false" });
      html(item, "b", {}, row.designation);
      html(item, "span", {}, row.data.slice(0, 7).map(([key, value]) => `${key} ${words(value)}`).join(", "));
      html(item, "small", {}, [row.confidence && `confidence ${row.confidence}`, row.origin].filter(Boolean).join(", "));
      item.addEventListener("pointerdown", (event) => {
        event.preventDefault();
        take(k);
      });
    });
    const isFound = rows.length === 1 && rows[0].designation.toLowerCase() === input.value.trim().toLowerCase();
    if (rows.length === 0 || isFound) return close();
    list.hidden = false;
    input.setAttribute("aria-expanded", "true");
  });
  input.addEventListener("input", () => search.call());
  input.addEventListener("blur", () => {
    search.cancel();
    close();
  });
  input.addEventListener("keydown", (event) => {
    if (list.hidden) {
      if (event.key === "ArrowDown") search.call();
      return;
    }
    if (event.key === "ArrowDown" || event.key === "ArrowUp") {
      event.preventDefault();
      at = (at + (event.key === "ArrowDown" ? 1 : -1) + rows.length) % rows.length;
      mark();
    } else if (event.key === "Enter" && at >= 0) {
      event.preventDefault();
      take(at);
    } else if (event.key === "Escape") {
      event.preventDefault();
      event.stopPropagation();
      close();
    }
  });
}
