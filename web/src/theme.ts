// Light and dark colours: those of the system until the button chooses.

const KEY = "gearloss-theme";

function remembered(): string | null {
  try {
    return localStorage.getItem(KEY);
  } catch {
    return null;
  }
}

export function theme(button: HTMLElement): void {
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const apply = (name: string | null) => {
    if (name) document.documentElement.dataset.theme = name;
    else delete document.documentElement.dataset.theme;
    const isDark = name ? name === "dark" : dark.matches;
    button.dataset.next = isDark ? "light" : "dark";
    button.textContent = isDark ? "Light" : "Dark";
    button.setAttribute("aria-label", `${button.textContent} colours`);
  };
  apply(remembered());
  dark.addEventListener("change", () => apply(remembered()));
  button.addEventListener("click", () => {
    const next = button.dataset.next ?? "dark";
    try {
      localStorage.setItem(KEY, next);
    } catch {
      // A browser without storage forgets it.
    }
    apply(next);
  });
}
