// Findings in words, and the list of them below the text.

import { html } from "../svg.ts";
import type { Fault, FileRange, Finding } from "./protocol.ts";
import { visible } from "../visible.ts";
import { prose } from "./prose.ts";

/** The code, message, notes and help of a finding. */
export function describeFinding(parent: Element, finding: Finding): void {
  prose(html(parent, "p"), finding.message);
  for (const note of finding.notes) prose(html(parent, "p", { class: "note" }), note);
  if (finding.help) {
    const help = html(parent, "p", { class: "help" });
    html(help, "b", {}, "help: ");
    prose(help, finding.help);
  }
  html(parent, "p", { class: "code" }, [finding.severity, finding.code, finding.path].filter(Boolean).join(" · "));
}

/** Findings without repetitions: several analyses of a study may report the same one. */
export function once(findings: Finding[]): Finding[] {
  const seen = new Set<string>();
  return findings.filter((f) => {
    const key = JSON.stringify([f.severity, f.message, f.help, f.place?.file, f.place?.range.from]);
    return !seen.has(key) && seen.add(key);
  });
}

/** Why a point has no result: for errors that the texts of the page show it is enough to say so. */
export function refusal(fault: Fault, files: string[], hasNumbers: boolean): string {
  const isShown = fault.findings.some((f) => f.severity === "error" && f.place !== null && files.includes(f.place.file));
  if (isShown) return hasNumbers ? "The gearbox has errors; the numbers are those before them." : "The gearbox has errors.";
  return fault.help ? `${fault.message}; help: ${fault.help}` : fault.message;
}

export class FindingsList {
  private readonly list: HTMLElement;
  private readonly head: HTMLElement;

  constructor(
    host: HTMLElement,
    private readonly goTo: (place: FileRange) => void,
  ) {
    this.head = html(host, "h2", { class: "strip", id: "findings-head", "aria-live": "polite" }, "Findings");
    this.list = html(host, "ul", { class: "findings", "aria-labelledby": "findings-head" });
  }

  /** Without a file. */
  none(): void {
    this.head.textContent = "Findings";
    delete this.head.dataset.state;
    this.list.replaceChildren();
  }

  show(file: string, all: Finding[]): void {
    const findings = once(all);
    const count = (severity: string) => findings.filter((f) => f.severity === severity).length;
    const [errors, warnings] = [count("error"), count("warning")];
    const several = (n: number, word: string) => (n === 0 ? "" : `${n} ${word}${n === 1 ? "" : "s"}`);
    const text = [several(errors, "error"), several(warnings, "warning")].filter(Boolean).join(", ") || "no findings";
    this.head.textContent = visible(`${file}: ${text}`);
    this.head.dataset.state = errors ? "bad" : warnings ? "warn" : "good";
    this.list.replaceChildren();
    const order = [...findings].sort((a, b) => Number(a.severity === "warning") - Number(b.severity === "warning"));
    for (const finding of order) {
      const item = html(this.list, "li", { class: finding.severity });
      const button = html(item, "button", { type: "button" });
      const { place } = finding;
      const where = place ? `${place.file === file ? "" : `${place.file} `}line ${place.range.start.line + 1}` : finding.path;
      html(button, "span", { class: "where" }, where);
      const text = html(button, "span", { class: "what" });
      prose(text, finding.message);
      if (finding.help) {
        html(text, "br");
        html(text, "b", {}, "help: ");
        prose(text, finding.help);
      }
      if (place) button.addEventListener("click", () => this.goTo(place));
      else button.disabled = true;
      for (const related of finding.related) {
        const more = html(item, "button", { type: "button", class: "related" });
        html(more, "span", { class: "where" }, `${related.file}, line ${related.range.start.line + 1}`);
        prose(html(more, "span", { class: "what" }), related.message);
        more.addEventListener("click", () => this.goTo(related));
      }
    }
  }
}
