// Analyses of a study: run all or one, progress, cancel, results as in the report.

import type { Drawn } from "../draw.ts";
import { words } from "../format.ts";
import { html } from "../svg.ts";
import type { ColourBook } from "../colours.ts";
import type { Files } from "./files.ts";
import { describeFinding } from "./findings.ts";
import { namedBy } from "./names.ts";
import type { Answers, Fault, FileRange, RunEvent, Texts } from "./protocol.ts";
import { drawSection } from "./sections.ts";
import { type Transport, Refused, isAbort } from "./transport.ts";
import { visible } from "../visible.ts";

export class StudyPane {
  private readonly list: HTMLElement;
  private readonly bar: HTMLElement;
  private readonly all: HTMLButtonElement;
  private readonly cancel: HTMLButtonElement;
  private readonly fresh: HTMLButtonElement;
  private readonly progress: HTMLProgressElement;
  private readonly status: HTMLElement;
  private readonly report: HTMLElement;
  private readonly results: HTMLElement;
  /** The study of the results, and what has changed since. */
  private readonly head: HTMLElement;
  private readonly elsewhere: HTMLElement;
  private readonly body: HTMLElement;
  private study: string | null = null;
  /** The study that was run last, with the texts of that time. */
  private ran: { study: string; texts: Texts } | null = null;
  private running: AbortController | null = null;
  private drawn: Drawn[] = [];
  private shape = "";

  constructor(
    host: HTMLElement,
    private readonly transport: Transport,
    private readonly files: Pick<Files, "texts" | "everything" | "isUnsaved">,
    private readonly books: { components: ColourBook; series: ColourBook },
    private readonly goTo: (place: FileRange) => void,
    private readonly failed: (fault: unknown) => void,
    create: () => void,
  ) {
    const side = html(host, "div", { class: "study-side" });
    this.bar = html(side, "div", { class: "bar-line" });
    this.all = html(this.bar, "button", { type: "button", class: "primary" }, "Run all");
    this.all.addEventListener("click", () => void this.run([]));
    this.cancel = html(this.bar, "button", { type: "button", hidden: "" }, "Cancel");
    this.cancel.addEventListener("click", () => this.running?.abort());
    this.fresh = html(this.bar, "button", { type: "button", title: "A study of the gearbox of the operating point" }, "New study");
    this.fresh.addEventListener("click", create);
    this.report = html(this.bar, "span", { class: "report-link" });
    this.progress = html(side, "progress", { max: 1, value: 0, "aria-label": "progress of the analysis", hidden: "" });
    this.status = html(side, "p", { class: "quiet", role: "status" });
    this.list = html(side, "ul", { class: "analyses" });
    this.results = html(host, "div", { class: "study-results", tabindex: 0, role: "region", "aria-label": "results of the study" });
    this.head = html(this.results, "p", { class: "results-of quiet", role: "status" });
    this.elsewhere = html(this.results, "p", { class: "quiet", hidden: "" });
    this.body = html(this.results, "div", {});
    this.none();
  }

  /** Without a study. */
  none(): void {
    this.study = null;
    this.shape = "";
    this.all.disabled = true;
    this.list.replaceChildren();
    if (!this.running) this.status.textContent = "Open a study to see its analyses, or begin a new one for the gearbox.";
    this.arrange();
  }

  /** A study was closed: its run ends, its results go. */
  closed(study: string): void {
    if (this.ran?.study === study) {
      this.running?.abort();
      this.ran = null;
      this.clear();
      this.report.replaceChildren();
    }
    if (this.study === study) this.none();
    else this.arrange();
  }

  /** The file of a study has another name. */
  rename(study: string, name: string): void {
    if (this.ran?.study === study) this.ran.study = name;
    if (this.ran && study in this.ran.texts) {
      this.ran.texts[name] = this.ran.texts[study];
      delete this.ran.texts[study];
    }
    if (this.study === study) this.study = name;
    this.shape = "";
    this.arrange();
  }

  /** Shows results below their own study only, and says what they are results of. */
  private arrange(): void {
    const { ran, study } = this;
    const isOwn = ran !== null && ran.study === study;
    this.body.hidden = this.report.hidden = this.head.hidden = !isOwn;
    this.elsewhere.hidden = isOwn || !this.running || !ran;
    if (ran) this.elsewhere.textContent = visible(`${ran.study} is running. Its results are shown when it is the shown study.`);
    if (isOwn) this.compare();
  }

  /** Says whether the results are those of the present text. */
  compare(): void {
    const { ran } = this;
    if (!ran) return;
    const now = this.files.everything();
    const isChanged = namedBy(ran.study, now).some((file) => (file in ran.texts ? ran.texts[file] !== now[file] : this.files.isUnsaved(file)));
    const text = isChanged ? `Results of ${ran.study}. The text has changed since this run.` : `Results of ${ran.study}`;
    if (this.head.textContent !== text) this.head.textContent = visible(text);
    this.head.classList.toggle("stale", isChanged);
  }

  show(study: string, analyses: Answers["analyses"]): void {
    const shape = JSON.stringify([study, analyses]);
    if (shape === this.shape) return;
    this.shape = shape;
    this.study = study;
    this.arrange();
    this.all.disabled = this.running !== null || analyses.length === 0;
    if (!this.running) this.status.textContent = visible(`${study}: ${analyses.length} analyses`);
    this.list.replaceChildren();
    for (const { name, title, type, about } of analyses) {
      const item = html(this.list, "li", { title: about });
      const text = html(item, "div");
      html(text, "b", {}, words(title || name));
      html(text, "span", { class: "quiet" }, ` ${name} · ${type}`);
      const button = html(item, "button", { type: "button", "aria-label": `Run ${name}` }, "Run");
      button.disabled = this.running !== null;
      button.addEventListener("click", () => void this.run([name]));
    }
  }

  fault(fault: Fault): void {
    if (!this.running) this.status.textContent = visible(fault.message);
  }

  private clear(): void {
    for (const own of this.drawn) own.remove();
    this.drawn = [];
    this.body.replaceChildren();
  }

  private begin(study: string): AbortController {
    const own = new AbortController();
    this.running = own;
    this.ran = { study, texts: this.files.everything() };
    this.clear();
    this.report.replaceChildren();
    this.arrange();
    this.cancel.hidden = false;
    this.fresh.hidden = true;
    this.progress.hidden = false;
    this.progress.removeAttribute("value");
    for (const button of [this.all, ...this.list.querySelectorAll("button")]) button.disabled = true;
    this.status.textContent = visible(`${study}: starting`);
    return own;
  }

  private end(text: string): void {
    this.running = null;
    this.cancel.hidden = true;
    this.fresh.hidden = false;
    this.progress.hidden = true;
    const buttons = [...this.list.querySelectorAll("button")];
    for (const button of buttons) button.disabled = false;
    this.all.disabled = buttons.length === 0;
    this.status.textContent = visible(text);
    this.arrange();
  }

  private async run(analyses: string[]): Promise<void> {
    const { study } = this;
    if (!study || this.running) return;
    const own = this.begin(study);
    const begun = performance.now();
    // After the run its study may be closed, or have another name.
    const name = () => `${this.ran?.study ?? study}: `;
    let end = "";
    try {
      for await (const event of this.transport.stream<RunEvent>({ request: "run", texts: this.files.texts(), study, analyses }, own.signal)) {
        if (own.signal.aborted) break;
        end = this.take(event) ?? end;
      }
      // A run that was cancelled may have sent its last lines.
      if (own.signal.aborted) return this.end(`${name()}Cancelled.`);
      this.end(`${name()}${end ? `${end}, ${((performance.now() - begun) / 1000).toFixed(1)} s` : "The program ended the run without a result."}`);
    } catch (fault) {
      if (isAbort(fault)) return this.end(`${name()}Cancelled.`);
      this.end(`${name()}${fault instanceof Error ? fault.message : String(fault)}`);
      if (fault instanceof Refused) this.wrong(fault.fault);
      else this.failed(fault);
    }
  }

  /** Shows an event; returns what is said at the end. */
  private take(event: RunEvent): string | null {
    switch (event.event) {
      case "begin":
        this.status.textContent = visible(`${this.ran?.study}: ${words(event.title || event.analysis)}`);
        this.progress.removeAttribute("value");
        return null;
      case "progress":
        this.status.textContent = visible(`${this.ran?.study}: ${event.analysis}, ${event.label} ${event.done} of ${event.count}`);
        if (event.count > 0) this.progress.value = event.done / event.count;
        return null;
      case "section":
        this.drawn.push(...drawSection(this.body, event.section, this.books));
        return null;
      case "report": {
        const link = html(this.report, "a", { href: event.address, target: "_blank", rel: "noopener" }, "Open the report");
        link.dataset.report = "";
        return null;
      }
      case "fault":
        this.wrong(event.fault);
        return null;
      case "end":
        return event.failed ? `${event.failed} failed` : "Finished";
    }
  }

  private wrong(fault: Fault): void {
    const box = html(this.body, "div", { class: "failed", role: "alert" });
    html(box, "p", {}, fault.message);
    if (fault.help) html(box, "p", {}, `help: ${fault.help}`);
    for (const finding of fault.findings) {
      const item = html(box, "div", { class: "finding-tip" });
      describeFinding(item, finding);
      const { place } = finding;
      if (!place) continue;
      const button = html(item, "button", { type: "button" }, `${place.file}, line ${place.range.start.line + 1}`);
      button.addEventListener("click", () => this.goTo(place));
    }
  }
}
