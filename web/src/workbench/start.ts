// What a folder without files shows: the layouts of gearboxes to begin with.

import { html } from "../svg.ts";
import type { Layout } from "./protocol.ts";

export function startPage(host: HTMLElement, layouts: Layout[], choose: (layout: string) => void): void {
  host.replaceChildren();
  html(host, "h2", {}, "A new gearbox");
  html(host, "p", {}, "The folder has no gearbox. Choose the layout that is nearest to yours: a form asks for teeth, bearings and oil, and every value has a default that can be solved.");
  const list = html(host, "div", { class: "layouts" });
  for (const { name, about } of layouts) {
    const button = html(list, "button", { type: "button", "data-layout": name });
    html(button, "b", {}, name);
    html(button, "span", {}, about);
    button.addEventListener("click", () => choose(name));
  }
}
