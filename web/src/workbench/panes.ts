// Sizes of the panes: lines between them that are dragged or moved by arrow keys. On narrow screens each pane is a tab.

import { html } from "../svg.ts";
import { store, stored } from "./storage.ts";

/** A line between two panes, whose place is a variable of the style sheet in percent. */
interface Line {
  name: string;
  label: string;
  vertical: boolean;
  /** Least and largest share in percent. */
  ends: [number, number];
  start: number;
}

const KEY = "gearloss-workbench-panes";

export function divide(box: HTMLElement, line: Line): void {
  const separator = html(box, "div", {
    class: `divider ${line.vertical ? "upright" : "level"} divider-${line.name}`,
    role: "separator",
    tabindex: 0,
    "aria-label": line.label,
    "aria-orientation": line.vertical ? "vertical" : "horizontal",
    "aria-valuemin": line.ends[0],
    "aria-valuemax": line.ends[1],
  });
  const set = (share: number, keep = true) => {
    const value = Math.round(10 * Math.min(line.ends[1], Math.max(line.ends[0], share))) / 10;
    document.documentElement.style.setProperty(`--${line.name}`, `${value}%`);
    separator.setAttribute("aria-valuenow", String(value));
    if (keep) store(KEY, { ...stored<Record<string, number>>(KEY, {}), [line.name]: value });
  };
  set(stored<Record<string, number>>(KEY, {})[line.name] ?? line.start, false);
  separator.addEventListener("pointerdown", (event) => {
    event.preventDefault();
    separator.setPointerCapture(event.pointerId);
    separator.classList.add("dragged");
  });
  separator.addEventListener("pointermove", (event) => {
    if (!separator.hasPointerCapture(event.pointerId)) return;
    const area = box.getBoundingClientRect();
    set(line.vertical ? (100 * (event.clientX - area.left)) / area.width : (100 * (event.clientY - area.top)) / area.height);
  });
  separator.addEventListener("pointerup", () => separator.classList.remove("dragged"));
  separator.addEventListener("dblclick", () => set(line.start));
  separator.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: -2, ArrowUp: -2, ArrowRight: 2, ArrowDown: 2 }[event.key];
    if (step === undefined) return;
    event.preventDefault();
    set(Number(separator.getAttribute("aria-valuenow")) + step);
  });
}

/** The tabs of a narrow screen. */
export function narrowTabs(bar: HTMLElement, panes: [name: string, title: string][]): (name: string) => void {
  const buttons = new Map<string, HTMLButtonElement>();
  const choose = (name: string) => {
    document.documentElement.dataset.pane = name;
    for (const [own, button] of buttons) {
      if (own === name) button.setAttribute("aria-current", "true");
      else button.removeAttribute("aria-current");
    }
  };
  for (const [name, title] of panes) {
    const button = html(bar, "button", { type: "button", "data-pane": name }, title);
    button.addEventListener("click", () => choose(name));
    buttons.set(name, button);
  }
  choose(panes[0][0]);
  return choose;
}
