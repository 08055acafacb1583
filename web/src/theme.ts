// Light and dark colours: those of the system until the button chooses.

import { remember, remembered } from "./remembered.ts";

const KEY = "gearloss-theme";

export function theme(button: HTMLElement): void {
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const apply = (name: string | null) => {
    if (name) document.documentElement.dataset.theme = name;
    else delete document.documentElement.dataset.theme;
    const isDark = name ? name === "dark" : dark.matches;
    document.documentElement.dataset.look = isDark ? "dark" : "light";
    button.dataset.next = isDark ? "light" : "dark";
    button.textContent = isDark ? "Light" : "Dark";
    button.setAttribute("aria-label", `${button.textContent} colours`);
  };
  apply(remembered(KEY));
  dark.addEventListener("change", () => apply(remembered(KEY)));
  button.addEventListener("click", () => {
    const next = button.dataset.next ?? "dark";
    remember(KEY, next);
    apply(next);
  });
}
