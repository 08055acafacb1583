// Bars above the panes: something to know or to decide.

import { html } from "../svg.ts";

export interface Notice {
  text: string;
  kind?: "bad" | "warn";
  actions?: { label: string; act: () => void; primary?: boolean; stays?: boolean }[];
}

export class Notices {
  constructor(private readonly host: HTMLElement) {}

  /** Shows a bar; one of the same name takes the place of the one before. */
  show(name: string, notice: Notice): void {
    const bar = html(null, "div", { class: `notice ${notice.kind ?? ""}`, role: notice.kind === "bad" ? "alert" : "status", "data-notice": name });
    html(bar, "span", {}, notice.text);
    for (const { label, act, primary, stays } of notice.actions ?? []) {
      const button = html(bar, "button", { type: "button", class: primary ? "primary" : undefined }, label);
      button.addEventListener("click", () => {
        if (!stays) this.hide(name);
        act();
      });
    }
    const before = this.find(name);
    if (before) before.replaceWith(bar);
    else this.host.append(bar);
  }

  hide(name: string): void {
    this.find(name)?.remove();
  }

  has(name: string): boolean {
    return this.find(name) !== null;
  }

  private find(name: string): Element | null {
    return this.host.querySelector(`[data-notice="${CSS.escape(name)}"]`);
  }

  private timer = 0;

  /** A sentence that goes by itself. */
  say(text: string): void {
    this.show("said", { text, actions: [{ label: "Close", act: () => undefined }] });
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => this.hide("said"), 6000);
  }
}
