// Tabs as the ARIA authoring practices describe them: one tab stop, arrow keys, Home and End.

import { html, unique } from "../svg.ts";

export interface Tab {
  id: string;
  title: string;
}

export class Tabs {
  readonly panels = new Map<string, HTMLElement>();
  private readonly buttons = new Map<string, HTMLButtonElement>();
  chosen: string;

  /** Adds the tabs to `head` and a panel for each to `body`. */
  constructor(
    head: HTMLElement,
    body: HTMLElement,
    label: string,
    tabs: Tab[],
    private readonly shown: (id: string) => void = () => undefined,
  ) {
    const list = html(head, "div", { class: "tabs", role: "tablist", "aria-label": label });
    this.chosen = tabs[0].id;
    for (const { id, title } of tabs) {
      const name = unique("tab");
      const button = html(list, "button", { type: "button", role: "tab", id: name, "aria-controls": `${name}-panel`, "data-tab": id }, title);
      const panel = html(body, "div", { class: `panel panel-${id}`, role: "tabpanel", id: `${name}-panel`, "aria-labelledby": name, tabindex: 0 });
      this.buttons.set(id, button);
      this.panels.set(id, panel);
      button.addEventListener("click", () => this.choose(id));
      button.addEventListener("keydown", (event) => {
        const ids = tabs.map((t) => t.id);
        const at = ids.indexOf(id);
        const to = { ArrowRight: at + 1, ArrowLeft: at - 1, Home: 0, End: ids.length - 1 }[event.key];
        if (to === undefined) return;
        event.preventDefault();
        const next = ids[(to + ids.length) % ids.length];
        this.choose(next);
        this.buttons.get(next)!.focus();
      });
    }
    this.mark();
  }

  choose(id: string): void {
    if (!this.buttons.has(id)) return;
    this.chosen = id;
    this.mark();
    this.shown(id);
  }

  title(id: string, text: string): void {
    const button = this.buttons.get(id)!;
    if (button.textContent !== text) button.textContent = text;
  }

  private mark(): void {
    for (const [id, button] of this.buttons) {
      const is = id === this.chosen;
      button.setAttribute("aria-selected", String(is));
      button.tabIndex = is ? 0 : -1;
      this.panels.get(id)!.hidden = !is;
    }
  }
}
