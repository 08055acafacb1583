// The page: what happens after a change, and what each pane shows.

import { ColourBook } from "../colours.ts";
import { type Drawn, draw } from "../draw.ts";
import { words } from "../format.ts";
import { html } from "../svg.ts";
import { theme } from "../theme.ts";
import { componentOf, componentsOf } from "./components.ts";
import { ConvergencePane } from "./convergence.ts";
import { askName } from "./dialogs.ts";
import { Disk } from "./disk.ts";
import { Drafts } from "./drafts.ts";
import { DrawingPane } from "./drawing.ts";
import { Editor } from "./editor.ts";
import { Files, kindOf, shortName } from "./files.ts";
import { FindingsList, refusal } from "./findings.ts";
import { newGearbox } from "./form.ts";
import { prose } from "./prose.ts";
import { startPage } from "./start.ts";
import { drawLosses, nameOf } from "./losses.ts";
import { MapPane } from "./map.ts";
import { fileName, freeName, nameFault } from "./names.ts";
import { Notices } from "./notices.ts";
import { Numbers } from "./numbers.ts";
import { Pace, Quiet } from "./pace.ts";
import { divide, narrowTabs } from "./panes.ts";
import { Pin } from "./pins.ts";
import { PointPane } from "./point.ts";
import type { Answers, FileRange, Finding, MapOf, PointAnswer, PointOf } from "./protocol.ts";
import { store, stored } from "./storage.ts";
import { drawTable } from "./sections.ts";
import { StudyPane } from "./study.ts";
import { Tabs } from "./tabs.ts";
import { Gone, Locked, Newest, Patient, Refused, type Transport } from "./transport.ts";
import { Watch } from "./watch.ts";
import { visible } from "../visible.ts";

/** Files that this tab has open, for a reload. */
const OPEN = "gearloss-workbench-open";

/** Time after which the page says that it waits for the program. [ms] */
const PATIENCE = 3000;

const at = (id: string) => document.getElementById(id)!;

export class Workbench {
  private readonly files = new Files();
  private readonly books = { components: new ColourBook(), series: new ColourBook() };
  private readonly notices = new Notices(at("notices"));
  private readonly newest = new Map<string, Newest>();
  private readonly editor: Editor;
  private readonly disk: Disk;
  private readonly findingsList: FindingsList;
  private readonly point: PointPane;
  private readonly numbers = new Numbers(at("numbers"));
  private readonly convergence: ConvergencePane;
  private readonly drawing: DrawingPane;
  private readonly map: MapPane;
  private readonly study: StudyPane;
  private readonly losses: Tabs;
  private readonly results: Tabs;
  private readonly showPane: (name: string) => void;
  private readonly watch: Watch;
  private drafts: Drafts | null = null;
  private folder!: Answers["folder"];
  private findings = new Map<string, Finding[]>();
  private gearbox: string | null = null;
  private openStudy: string | null = null;
  private answer: { of: PointOf; answer: PointAnswer } | null = null;
  private pin: Pin | null = null;
  private mapOf: { key: string; of: MapOf; section: Answers["map"] } | null = null;
  private waterfall: Drawn | null = null;
  private part: string | null = null;
  /** Of several components of the part the one that is explained. */
  private component: string | null = null;
  /** Time of the last change by the user. */
  private event = performance.now();
  private generation = 0;

  private readonly solve = new Pace(20, 200, () => this.solvePoint());
  private readonly check = new Pace(20, 600, () => this.findFindings());
  private readonly control = new Pace(20, 200, () => this.readControls());
  private readonly redraw = new Quiet(120, () => void this.readDrawing());
  private readonly remap = new Quiet(400, () => void this.readMap());
  private readonly list = new Quiet(250, () => void this.readAnalyses());
  private readonly reexplain = new Quiet(120, () => void this.explain());
  private readonly keep = new Quiet(250, () => this.keepDrafts());
  private readonly rewatch = new Quiet(50, () => this.watch.restart());

  private readonly transport: Transport;

  constructor(program: Transport) {
    this.transport = new Patient(program, PATIENCE, (is) => (is && !this.isDown ? this.notices.show("waiting", { text: "Waiting for the program.", kind: "warn" }) : this.notices.hide("waiting")));
    theme(at("theme") as HTMLButtonElement);
    this.showPane = narrowTabs(at("narrow"), [
      ["text", "Text"],
      ["point", "Point"],
      ["losses", "Losses"],
      ["convergence", "Convergence"],
      ["results", "Results"],
    ]);
    const box = (selector: string) => document.querySelector<HTMLElement>(selector)!;
    divide(box(".workbench"), { name: "split-text", label: "width of the text", vertical: true, ends: [18, 70], start: 33 });
    divide(box(".pane-text"), { name: "split-findings", label: "height of the text above the findings", vertical: false, ends: [30, 90], start: 85 });
    divide(box(".right"), { name: "split-top", label: "height of the operating point", vertical: false, ends: [20, 80], start: 43 });
    divide(box(".top-row"), { name: "split-point", label: "width of the operating point", vertical: true, ends: [18, 55], start: 41 });
    divide(box(".top-row"), { name: "split-losses", label: "width of the losses", vertical: true, ends: [56, 85], start: 70 });

    this.editor = new Editor(at("editor"), {
      files: this.files,
      ask: (edit) => this.newestOf(`edit ${edit.request}`).ask({ request: "edit", texts: this.files.texts(), edit }).catch((fault) => this.lost(fault)),
      goTo: (place) => void this.goTo(place),
      newName: (old, place) => askName("Rename", "New name", old, place),
      say: (text) => this.notices.say(text),
    });
    this.editor.open = (file) => this.open(file);
    this.findingsList = new FindingsList(at("findings"), (place) => void this.goTo(place));
    this.point = new PointPane(at("controls"), () => {
      this.event = performance.now();
      this.solve.call();
      this.remap.call();
      this.markMap();
    });
    this.losses = new Tabs(at("losses-tabs"), at("losses-body"), "losses of the operating point", [
      { id: "bars", title: "Losses" },
      { id: "waterfall", title: "Waterfall" },
      { id: "text", title: "Tables" },
    ], () => this.showLosses());
    this.convergence = new ConvergencePane(at("convergence"), this.books);
    this.results = new Tabs(at("results-tabs"), at("results-body"), "results", [
      { id: "drawing", title: "Drawing" },
      { id: "map", title: "Map" },
      { id: "study", title: "Study" },
    ], (id) => {
      if (id === "map") void this.readMap();
    });
    this.drawing = new DrawingPane(at("drawing"), (part, place) => this.choosePart(part, place));
    const drawingPanel = this.results.panels.get("drawing")!;
    drawingPanel.append(at("drawing"), at("explain"));
    this.map = new MapPane(this.results.panels.get("map")!, this.books, (place) => this.point.moveTo(place), () => void this.readMap());
    this.study = new StudyPane(this.results.panels.get("study")!, this.transport, this.files, this.books, (place) => void this.goTo(place), (fault) => void this.lost(fault), () => void this.newStudy());
    this.disk = new Disk(this.files, this.editor, this.notices, () => this.rewatch.call());
    this.watch = new Watch(this.transport, {
      files: () => Object.fromEntries([...this.files.open.values()].flatMap((f) => (f.hash === null ? [] : [[f.file, f.removed ? "" : f.hash]]))),
      changed: (file, text, hash) => this.disk.changed(file, text, hash),
      removed: (file) => this.disk.removed(file),
      unreadable: (file, reason) => this.disk.unreadable(file, reason),
      up: () => this.up(),
      down: () => this.down(),
      locked: () => this.locked(),
    });
    this.files.onChange((own) => this.changed(own.file));
    at("save").addEventListener("click", () => void this.save());
    at("save-as").addEventListener("click", () => void this.saveAs());
    at("new").addEventListener("click", () => this.newGearbox());
    at("pin").addEventListener("click", () => this.setPin());
    at("unpin").addEventListener("click", () => this.setPin(null));
    const name = at("pin-name") as HTMLInputElement;
    name.addEventListener("input", () => {
      if (this.pin) this.pin.name = name.value;
    });
    const others = at("open-other") as HTMLSelectElement;
    others.addEventListener("change", () => {
      const file = others.value;
      others.value = "";
      if (file) void this.open(file, true);
    });
    others.addEventListener("pointerdown", () => void this.refreshFolder());
    addEventListener("keydown", (event) => {
      if (!(event.ctrlKey || event.metaKey) || event.key.toLowerCase() !== "s" || event.altKey) return;
      event.preventDefault();
      void this.save();
    });
    addEventListener("beforeunload", (event) => {
      this.keep.flush();
      if (this.files.unsaved().length) event.preventDefault();
    });
    addEventListener("pagehide", () => this.keep.flush());
    at("explain-close").addEventListener("click", () => this.choosePart(null, null));
  }

  /** Reads the folder and opens what the command line names. */
  async start(): Promise<void> {
    try {
      this.folder = await this.transport.ask({ request: "folder" });
    } catch (fault) {
      void this.lost(fault);
      return;
    }
    document.title = `${visible(this.folder.name)} – gearloss`;
    at("folder").textContent = visible(this.folder.name);
    at("version").textContent = `gearloss ${this.folder.version}`;
    (at("new") as HTMLButtonElement).disabled = this.folder.layouts.length === 0;
    this.showOthers();
    try {
      this.drafts = await Drafts.open(this.transport);
    } catch (fault) {
      void this.lost(fault);
    }
    this.offerDrafts();
    const { files, open } = this.folder;
    const before = stored<{ folder: string; files: string[]; current: string | null } | null>(OPEN, null, sessionStorage);
    const again = before?.folder === this.folder.name ? before.files.filter((f) => files.some((own) => own.file === f)) : [];
    const first = again.find((f) => f === before?.current) ?? again[0] ?? open ?? files.find((f) => f.kind === "gearbox")?.file ?? files.find((f) => f.kind === "study")?.file ?? null;
    for (const file of again) await this.open(file);
    if (first) await this.open(first, true);
    // A study brings its gearbox, and a gearbox its study, if they are beside each other.
    const folderOf = (file: string) => file.slice(0, file.lastIndexOf("/") + 1);
    const beside = (kind: string) => files.find((f) => f.kind === kind && folderOf(f.file) === folderOf(first ?? ""))?.file;
    for (const kind of again.length ? [] : ["gearbox", "study"]) {
      const other = beside(kind);
      if (other && ![...this.files.open.values()].some((f) => kindOf(f.text) === kind)) await this.open(other);
    }
    document.documentElement.dataset.ready = "";
    this.showTabs();
    if (!first) {
      document.documentElement.dataset.empty = "";
      startPage(at("start"), this.folder.layouts, (layout) => this.newGearbox(layout));
    }
  }

  private newestOf(kind: string): Newest {
    let own = this.newest.get(kind);
    if (!own) this.newest.set(kind, (own = new Newest(this.transport)));
    return own;
  }

  // Files.

  private names(): string[] {
    return [...new Set([...this.folder.files.map((f) => f.file), ...this.files.open.keys()])];
  }

  private async refreshFolder(): Promise<void> {
    try {
      this.folder = await this.transport.ask({ request: "folder" });
      this.showOthers();
    } catch {
      // The list stays.
    }
  }

  private showOthers(): void {
    const select = at("open-other") as HTMLSelectElement;
    const closed = this.folder.files.filter((f) => !this.files.get(f.file));
    const wanted = JSON.stringify(closed);
    if (select.dataset.shown === wanted) return;
    select.dataset.shown = wanted;
    select.replaceChildren();
    html(select, "option", { value: "" }, "Open");
    for (const kind of ["gearbox", "study", "other"] as const) {
      const own = closed.filter((f) => f.kind === kind);
      if (own.length === 0) continue;
      const group = html(select, "optgroup", { label: { gearbox: "Gearboxes", study: "Studies", other: "Other files" }[kind] });
      for (const { file } of own) html(group, "option", { value: file }, file);
    }
    select.disabled = closed.length === 0;
  }

  /** Opens a file if it is not open. */
  private async open(file: string, show = false): Promise<boolean> {
    if (!this.files.get(file)) {
      try {
        const { text, hash } = await this.transport.ask({ request: "read", file });
        if (!this.files.get(file)) this.files.add(file, text, hash);
      } catch (fault) {
        if (fault instanceof Refused) this.notices.say(`${file}: ${fault.message}`);
        else void this.lost(fault);
        return false;
      }
      this.rewatch.call();
    }
    if (show) this.show(file);
    else this.showTabs();
    return true;
  }

  private newGearbox(layout?: string): void {
    void this.refreshFolder();
    newGearbox(this.folder.layouts, this.transport, () => this.names(), (file, text) => void this.create(file, text), layout);
  }

  /** Opens a new gearbox and writes its file. */
  private async create(file: string, text: string): Promise<void> {
    delete document.documentElement.dataset.empty;
    // The editor may still have the text of a file that had this name.
    this.editor.close(file);
    this.files.add(file, text, null);
    this.show(file);
    this.results.choose("map");
    this.showPane("text");
    this.editor.view.focus();
    await this.save(file);
  }

  /** A study of the gearbox of the operating point, as a new file beside it. */
  private async newStudy(): Promise<void> {
    const gearbox = this.gearbox;
    if (!gearbox) return this.notices.say("Open a gearbox first: a study needs one.");
    try {
      const { text } = await this.transport.ask({ request: "new_study", texts: this.files.texts(), gearbox });
      const file = freeName(`${gearbox.slice(0, gearbox.lastIndexOf("/") + 1)}study.yaml`, this.names());
      this.editor.close(file);
      this.files.add(file, text, null);
      this.show(file);
    } catch (fault) {
      if (fault instanceof Refused) this.notices.say(fault.message);
      else void this.lost(fault);
    }
  }

  /** Shows an open file. */
  private show(file: string): void {
    this.editor.show(file);
    this.showTabs();
    this.findingsList.show(file, this.findings.get(file) ?? []);
    this.editor.mark(file, this.findings.get(file) ?? []);
    this.changed(file);
  }

  private showTabs(): void {
    const bar = at("file-tabs");
    bar.replaceChildren();
    for (const { file } of this.files.open.values()) {
      const unsaved = this.files.isUnsaved(file);
      const item = html(bar, "span", { class: `file${file === this.editor.current ? " current" : ""}`, "data-file": file });
      const button = html(item, "button", { type: "button", "aria-current": file === this.editor.current ? "true" : undefined, title: unsaved ? `${file}, not saved` : file }, shortName(file, [...this.files.open.keys()]));
      if (unsaved) html(button, "span", { class: "unsaved", "aria-label": "not saved" }, "●");
      button.addEventListener("click", () => {
        this.show(file);
        this.editor.view.focus();
      });
      const close = html(item, "button", { type: "button", class: "close", "aria-label": `Close ${file}` }, "×");
      close.addEventListener("click", () => this.close(file));
    }
    bar.querySelector(".current")?.scrollIntoView({ inline: "nearest", block: "nearest" });
    const current = this.editor.current;
    if (document.documentElement.dataset.ready === "") store(OPEN, { folder: this.folder.name, files: [...this.files.open.keys()], current }, sessionStorage);
    at("no-file").hidden = current !== null;
    at("editor").hidden = current === null;
    (at("save") as HTMLButtonElement).disabled = !current || !this.files.isUnsaved(current);
    (at("save-as") as HTMLButtonElement).disabled = !current;
    this.showOthers();
  }

  private close(file: string, anyway = false): void {
    if (!anyway && this.files.isUnsaved(file)) {
      this.notices.show(`close ${file}`, {
        text: `${file} has text that is not saved.`,
        kind: "warn",
        actions: [
          { label: "Save and close", act: () => void this.save(file).then((is) => is && this.close(file, true)), primary: true },
          { label: "Discard the text", act: () => this.close(file, true) },
          { label: "Keep it open", act: () => undefined },
        ],
      });
      return;
    }
    const was = this.editor.current === file;
    this.files.close(file);
    this.editor.close(file);
    this.findings.delete(file);
    this.drafts?.drop(file);
    for (const kind of ["disk", "unreadable", "save", "close"]) this.notices.hide(`${kind} ${file}`);
    if (this.gearbox === file) this.gearbox = null;
    this.study.closed(file);
    if (this.openStudy === file) this.openStudy = this.first("study");
    const next = [...this.files.open.keys()][0];
    if (was && next) this.show(next);
    else {
      this.showTabs();
      if (was) this.findingsList.none();
      if (this.editor.current) this.changed(this.editor.current);
    }
    if (!this.gearbox) this.withoutGearbox();
    this.rewatch.call();
  }

  /** The first open file of a kind. */
  private first(kind: "gearbox" | "study"): string | null {
    return [...this.files.open.values()].find((f) => kindOf(f.text) === kind)?.file ?? null;
  }

  /** Shows that there is no gearbox: nothing of one that was closed stays. */
  private withoutGearbox(): void {
    for (const kind of ["controls", "point", "drawing", "map", "explain"]) this.newestOf(kind).abort();
    this.answer = null;
    this.choosePart(null, null);
    this.point.begin(null);
    this.clearNumbers();
    this.drawing.message("No gearbox is open.");
    this.drawnOf = null;
    this.map.message("No gearbox is open.");
    this.map.say("");
    this.mapOf = null;
    this.mapShown = "";
    at("gearbox-title").textContent = at("gearbox-title").title = "";
    at("point-message").hidden = true;
    delete document.documentElement.dataset.stale;
  }

  /** Shows no numbers, losses and steps. */
  private clearNumbers(): void {
    this.numbers.clear();
    this.convergence.clear();
    this.waterfall?.remove();
    this.waterfall = null;
    for (const panel of this.losses.panels.values()) panel.replaceChildren();
    for (const id of ["status", "timing"]) at(id).textContent = "";
    at("notes").hidden = true;
    (at("pin") as HTMLButtonElement).disabled = true;
  }

  private async save(file = this.editor.current): Promise<boolean> {
    const own = file ? this.files.get(file) : undefined;
    if (!file || !own || !this.files.isUnsaved(file)) return true;
    const text = this.files.onDisk(file);
    try {
      const answer = await this.transport.ask({ request: "save", file, text, hash: own.removed ? null : own.hash });
      if ("changed" in answer) {
        const { text: disk, hash } = answer.changed;
        if (disk === null || hash === null) {
          // A file whose text cannot be read is not overwritten.
          if (this.notices.has(`unreadable ${file}`)) this.notSaved(file, "the file on the disk cannot be read");
          else this.disk.removed(file);
          return false;
        }
        if (own.removed && hash === own.hash) {
          // It came back as it was.
          this.files.setRemoved(file, false);
          return this.save(file);
        }
        this.disk.changed(file, disk, hash);
        return false;
      }
      this.files.setSaved(file, text, answer.saved);
      for (const kind of ["disk", "unreadable", "save"]) this.notices.hide(`${kind} ${file}`);
      this.rewatch.call();
      void this.refreshFolder();
      return true;
    } catch (fault) {
      if (fault instanceof Refused) this.notSaved(file, `${fault.message}${fault.fault.help ? ` help: ${fault.fault.help}` : ""}`);
      else void this.lost(fault);
      return false;
    }
  }

  private notSaved(file: string, why: string): void {
    this.notices.show(`save ${file}`, {
      text: `${file} is not saved: ${why}`,
      kind: "bad",
      actions: [
        { label: "Save as", act: () => void this.saveAs(file) },
        { label: "Close", act: () => undefined },
      ],
    });
  }

  /** Saves a text under another name, which is then its own; a file that it has on the disk stays as it is there. */
  private async saveAs(file = this.editor.current): Promise<void> {
    if (!file || !this.files.get(file)) return;
    await this.refreshFolder();
    const extension = /\.csv$/i.test(file) ? "csv" : "yaml";
    const known = () => this.names();
    const suggested = this.files.get(file)!.hash === null ? file : freeName(file, known());
    // A new file is on no disk: its own name is free.
    const taken = () => known().filter((name) => name !== file || this.files.get(file)?.hash !== null);
    const typed = await askName("Save as", "File", suggested, undefined, (name) => nameFault(fileName(name, extension), taken()));
    if (typed === null || !this.files.get(file)) return;
    const name = fileName(typed, extension);
    if (name !== file) this.rename(file, name);
    if (await this.save(name)) this.notices.say(`${name} is saved.`);
  }

  private rename(file: string, name: string): void {
    this.drafts?.drop(file);
    this.drafted.delete(file);
    this.findings.delete(file);
    for (const kind of ["disk", "unreadable", "save", "close"]) this.notices.hide(`${kind} ${file}`);
    this.editor.close(name);
    this.files.rename(file, name);
    this.editor.renameFile(file, name);
    this.point.rename(file, name);
    this.study.rename(file, name);
    if (this.gearbox === file) this.gearbox = name;
    if (this.drawnOf === file) this.drawnOf = name;
    if (this.openStudy === file) this.openStudy = name;
    this.changed(name);
    this.rewatch.call();
  }

  private async goTo(place: FileRange): Promise<void> {
    await this.selectPlace(place, true);
    this.showPane("text");
  }

  /** Selects a place in the text, and leaves the focus where it is or not. */
  private async selectPlace(place: FileRange, focus: boolean): Promise<void> {
    if (!(await this.open(place.file))) return;
    if (this.editor.current !== place.file) this.show(place.file);
    this.editor.select(place.range.from, place.range.to, focus);
  }

  // Drafts.

  private readonly drafted = new Set<string>();

  private keepDrafts(): void {
    for (const { file, text, hash, saved } of this.files.open.values()) {
      if (this.files.isUnsaved(file)) {
        this.drafted.add(file);
        void this.drafts?.keep({ file, text, hash, base: saved }).then((fault) => {
          if (fault !== null) this.notices.show("storage", { text: `Unsaved texts are not kept: ${fault}. Save often.`, kind: "warn", actions: [{ label: "Close", act: () => undefined }] });
        });
      } else if (this.drafted.delete(file)) this.drafts?.drop(file);
    }
    document.documentElement.dataset.kept = String(this.generation);
  }

  private offerDrafts(): void {
    const seen = new Set<string>();
    for (const kept of this.drafts?.kept() ?? []) {
      const { draft } = kept;
      if (seen.has(draft.file)) continue;
      seen.add(draft.file);
      const time = new Date(draft.time).toLocaleString(undefined, { dateStyle: "medium", timeStyle: "short" });
      this.notices.show(`draft ${draft.file}`, {
        text: `Text of ${draft.file} that was not saved is kept (${time}).`,
        actions: [
          {
            label: "Restore",
            primary: true,
            act: async () => {
              if (draft.hash === null && !this.files.get(draft.file)) this.files.add(draft.file, draft.text, null);
              else if (!(await this.open(draft.file))) this.files.add(draft.file, draft.text, null);
              const own = this.files.get(draft.file)!;
              const [disk, hash] = [own.disk, own.hash];
              if (hash !== null && draft.hash !== null && hash !== draft.hash) {
                // The disk has changed since: as if it had changed while the text was open.
                this.files.setSaved(draft.file, draft.base, draft.hash);
                this.editor.replace(draft.file, draft.text);
                this.disk.changed(draft.file, disk, hash);
              } else this.editor.replace(draft.file, draft.text);
              this.drafts?.dropKept(kept);
              this.keepDrafts();
              this.show(draft.file);
            },
          },
          { label: "Discard", act: () => this.drafts?.dropKept(kept) },
        ],
      });
    }
  }

  // What follows from a change.

  private changed(file: string): void {
    this.generation++;
    this.event = performance.now();
    this.keep.call();
    this.showTabs();
    const current = this.editor.current;
    const kind = kindOf(this.files.get(file)?.text ?? "");
    // The gearbox that was shown last stays while another file is edited.
    if (file === current && kind === "gearbox" && this.gearbox !== file) {
      this.choose(file);
    }
    if (kind === "study" && (file === current || !this.openStudy)) this.openStudy = file;
    if (!this.gearbox) {
      const first = this.first("gearbox");
      if (first) this.choose(first);
    }
    this.check.call();
    if (this.gearbox) {
      this.control.call();
      this.solve.call();
      this.redraw.call();
      this.remap.call();
    }
    if (this.openStudy) this.list.call();
    this.study.compare();
  }

  /** Takes another gearbox for the operating point. */
  private choose(gearbox: string): void {
    this.gearbox = gearbox;
    this.answer = null;
    this.point.begin(gearbox);
    this.choosePart(null, null);
  }

  private async findFindings(): Promise<void> {
    const file = this.editor.current;
    // Tables have no findings of their own: the file that reads them has.
    if (!file || !/\.ya?ml$/i.test(file)) return;
    const begun = this.event;
    const text = this.files.get(file)?.text;
    try {
      const answer = await this.newestOf("findings").ask({ request: "edit", texts: this.files.texts(), edit: { request: "findings", file } });
      if (answer?.answer !== "findings" || file !== this.editor.current) return;
      // Places in a text that has changed since would be wrong; the marks of before move with the text until the next answer.
      if (this.files.get(file)?.text !== text) return;
      this.findings.set(file, answer.value);
      this.editor.mark(file, answer.value);
      this.findingsList.show(file, answer.value);
      at("findings").dataset.latency = (performance.now() - begun).toFixed(1);
    } catch (fault) {
      void this.lost(fault);
    }
  }

  private async readControls(): Promise<void> {
    const gearbox = this.gearbox;
    if (!gearbox) return;
    try {
      const controls = await this.newestOf("controls").ask({ request: "controls", texts: this.files.texts(), gearbox });
      if (!controls || gearbox !== this.gearbox) return;
      at("gearbox-title").textContent = visible(controls.title || gearbox);
      at("gearbox-title").title = visible(gearbox);
      if (this.point.show(controls)) {
        this.solve.call();
        this.remap.call();
      }
    } catch (fault) {
      if (fault instanceof Refused && !this.point.point()) {
        at("gearbox-title").textContent = visible(gearbox);
        this.stale(refusal(fault.fault, this.names(), false));
      } else void this.lost(fault);
    }
  }

  private async solvePoint(): Promise<void> {
    const of = this.point.point();
    if (!of || of.gearbox !== this.gearbox) return;
    const wrong = this.point.wrong;
    if (wrong !== null) {
      this.newestOf("point").abort();
      return this.stale(`${wrong}. Nothing is solved until then.`);
    }
    const begun = this.event;
    try {
      const answer = await this.newestOf("point").ask({ request: "point", texts: this.files.texts(), ...of });
      if (!answer || of.gearbox !== this.gearbox) return;
      this.answer = { of, answer };
      this.showAnswer();
      const pane = at("point-pane");
      pane.dataset.latency = (performance.now() - begun).toFixed(1);
      pane.dataset.solved = String(Number(pane.dataset.solved ?? 0) + 1);
      at("timing").textContent = `${Math.round(performance.now() - begun)} ms`;
    } catch (fault) {
      if (fault instanceof Refused) this.stale(refusal(fault.fault, this.names(), this.answer !== null));
      else void this.lost(fault);
    }
  }

  private stale(message: string): void {
    // What is shown is of another gearbox.
    if (!this.answer) this.clearNumbers();
    document.documentElement.dataset.stale = "";
    const place = at("point-message");
    place.replaceChildren();
    prose(place, words(message));
    place.hidden = false;
  }

  private showAnswer(): void {
    if (!this.answer) return;
    const { answer } = this.answer;
    delete document.documentElement.dataset.stale;
    const message = at("point-message");
    message.hidden = answer.loss !== null;
    message.textContent = answer.loss === null ? `There is no result at this point (${words(answer.status)}). ${words(answer.convergence.outcome)}` : "";
    const speed = this.answer.of.inputs.find((input) => input.quantity === "speed");
    this.numbers.show(answer, this.pin?.answer ?? null, speed?.port ?? null);
    at("status").textContent = words(answer.status);
    at("notes").hidden = answer.remarks.length === 0;
    at("remarks").replaceChildren(...answer.remarks.map((remark) => {
      const item = html(null, "li");
      prose(item, words(remark.replace(/^note: /, "")));
      return item;
    }));
    this.point.suggestedOil = answer.oil === null ? null : Math.round(answer.oil);
    this.showLosses();
    document.documentElement.dataset.temperature = answer.convergence.of;
    this.convergence.show(answer.convergence);
    this.drawing.colour(answer.drawing);
    this.drawing.showOil(answer.oil_section);
    this.markMap();
    const pin = at("pin") as HTMLButtonElement;
    pin.disabled = false;
    if (this.part) this.reexplain.call();
  }

  private showLosses(): void {
    if (!this.answer) return;
    const { answer } = this.answer;
    const panel = (id: string) => this.losses.panels.get(id)!;
    switch (this.losses.chosen) {
      case "bars":
        drawLosses(panel("bars"), answer, this.pin?.answer ?? null, this.part, (path) => this.chooseLoss(path));
        break;
      case "waterfall":
        this.waterfall?.remove();
        this.waterfall = null;
        panel("waterfall").replaceChildren();
        if (answer.waterfall) this.waterfall = draw(panel("waterfall"), answer.waterfall, this.books);
        else html(panel("waterfall"), "p", { class: "quiet" }, "There is no waterfall for this point.");
        break;
      case "text": {
        const host = panel("text");
        const scrolled = host.scrollTop;
        host.replaceChildren();
        for (const block of answer.blocks) {
          if ("table" in block) {
            if (block.table.title) html(host, "h4", {}, words(block.table.title));
            drawTable(host, block.table, block.table.title || `${block.table.rows[0]?.[0] ?? "point"}s`);
          } else if (block.text.trim()) html(host, "p", { class: "text" }, words(block.text.trim()));
        }
        host.scrollTop = scrolled;
        break;
      }
    }
  }

  private chooseLoss(path: string): void {
    const part = componentOf(path);
    this.drawing.mark(part);
    this.choosePart(path, this.drawing.placeOf(part));
  }

  private choosePart(part: string | null, place: FileRange | null): void {
    this.part = part;
    this.component = null;
    at("explain").hidden = part === null;
    if (part === null) {
      this.drawing.mark(null);
      this.showLosses();
      return;
    }
    at("explain-title").textContent = visible(nameOf(part));
    at("explain-text").textContent = "";
    delete at("explain-text").dataset.of;
    at("explain-choice").replaceChildren();
    if (place) void this.selectPlace(place, false);
    for (const row of document.querySelectorAll<HTMLElement>(".losses tr[data-path]")) row.classList.toggle("chosen", row.dataset.path === part);
    void this.explain();
  }

  private async explain(): Promise<void> {
    const [part, of] = [this.part, this.point.point()];
    if (!part || !of || !this.answer) return;
    const components = componentsOf(part, this.answer.answer);
    const component = components.find((c) => c === this.component) ?? components[0];
    const choice = at("explain-choice");
    choice.replaceChildren();
    if (components.length > 1)
      for (const own of components) {
        const button = html(choice, "button", { type: "button", "aria-pressed": String(own === component) }, words(own));
        button.addEventListener("click", () => {
          this.component = own;
          void this.explain();
        });
      }
    const text = at("explain-text");
    if (!component) {
      text.textContent = "This part has no loss of its own.";
      return;
    }
    try {
      const answer = await this.newestOf("explain").ask({ request: "explain", texts: this.files.texts(), part: component, ...of });
      if (!answer || part !== this.part) return;
      const isNew = text.dataset.of !== component;
      text.textContent = visible(answer.text);
      text.dataset.of = component;
      // What concerns the point comes first; the component is what was asked for. A later answer keeps the place.
      const line = answer.text.split("\n").findIndex((l) => l.startsWith(`${component}:`));
      if (isNew) text.scrollTop = Math.max(0, line) * parseFloat(getComputedStyle(text).lineHeight);
    } catch (fault) {
      if (fault instanceof Refused) text.textContent = visible(fault.message);
      else void this.lost(fault);
    }
  }

  private drawnOf: string | null = null;

  private async readDrawing(): Promise<void> {
    const gearbox = this.gearbox;
    if (!gearbox) return;
    try {
      const answer = await this.newestOf("drawing").ask({ request: "drawing", texts: this.files.texts(), gearbox });
      if (!answer || gearbox !== this.gearbox) return;
      this.drawnOf = gearbox;
      this.drawing.show(answer.svg, answer.places);
    } catch (fault) {
      // With an error in the text the drawing before it stays, if it is of this gearbox.
      if (!(fault instanceof Refused)) return void this.lost(fault);
      if (this.drawnOf !== gearbox && gearbox === this.gearbox) this.drawing.message("The gearbox cannot be drawn yet.");
    }
  }

  private async readMap(): Promise<void> {
    if (this.results.chosen !== "map") return;
    const [of, ranges] = [this.point.point(), this.point.ranges()];
    if (!of || this.point.wrong !== null) return;
    if (!ranges) return this.map.message("A map needs a torque and a speed; this gear has other inputs.");
    const { gearbox, gear, model_set, oil_temperature, oil_volume } = of;
    const own: MapOf = { gearbox, gear, model_set, oil_temperature, oil_volume, ...ranges, count: Number(this.map.count.value) };
    const texts = this.files.texts();
    // All texts: a text that was saved since gives the same map.
    const key = JSON.stringify([own, this.files.everything()]);
    const pin = this.map.differs ? this.pin : null;
    const wanted = JSON.stringify([key, pin && this.pins]);
    if (wanted === this.mapShown) return this.markMap();
    const begun = performance.now();
    this.map.say("computing");
    try {
      const section = this.mapOf?.key === key ? this.mapOf.section : await this.newestOf("map").ask({ request: "map", texts, ...own });
      if (!section) return;
      this.mapOf = { key, of: own, section };
      const pinned = pin ? await pin.mapOver(own) : null;
      if (pin && !pinned) return;
      this.map.show(section, pinned);
      this.mapShown = wanted;
      this.map.say(`${own.count} × ${own.count} points, ${Math.round(performance.now() - begun)} ms`);
      this.markMap();
    } catch (fault) {
      this.mapShown = "";
      if (fault instanceof Refused) {
        // With an error in the text the map before it stays.
        const isText = fault.fault.findings.length > 0;
        this.map.say(isText ? "the gearbox has errors" : "");
        if (!isText) this.map.message(`${fault.message}${fault.fault.help ? `; ${fault.fault.help}` : ""}`);
      }
      else {
        this.map.say("");
        void this.lost(fault);
      }
    }
  }

  private mapShown = "";
  private pins = 0;

  private markMap(): void {
    this.map.mark(this.point.place());
  }

  private async readAnalyses(): Promise<void> {
    const study = this.openStudy;
    if (!study) return;
    try {
      const analyses = await this.newestOf("analyses").ask({ request: "analyses", texts: this.files.texts(), study });
      if (analyses && study === this.openStudy) this.study.show(study, analyses);
    } catch (fault) {
      if (fault instanceof Refused) this.study.fault(fault.fault);
      else void this.lost(fault);
    }
  }

  private setPin(none?: null): void {
    this.pins++;
    const bar = at("pinned");
    if (none === null || !this.answer) this.pin = null;
    else {
      const { of, answer } = this.answer;
      const map = this.mapOf && this.mapOf.of.gearbox === of.gearbox ? this.mapOf : null;
      const inputs = of.inputs.map((i) => `${i.value} ${i.quantity === "torque" ? "Nm" : "rpm"}`).join(", ");
      const fresh = map && map.key === JSON.stringify([map.of, this.files.everything()]) && map.of.gear === of.gear && map.of.model_set === of.model_set && map.of.oil_temperature === of.oil_temperature && map.of.oil_volume === of.oil_volume;
      this.pin = new Pin(`${of.gear}, ${inputs}`, of, answer, this.files.everything(), this.transport, fresh ? map : null);
      (at("pin-name") as HTMLInputElement).value = this.pin.name;
    }
    bar.hidden = this.pin === null;
    at("pin").textContent = this.pin ? "Pin again" : "Pin";
    this.map.allowDifference(this.pin !== null);
    if (this.answer) this.showAnswer();
    void this.readMap();
  }

  // The program.

  private lost(fault: unknown): null {
    if (fault instanceof Locked) this.locked();
    else if (fault instanceof Gone) this.down();
    else if (!(fault instanceof Refused)) throw fault;
    return null;
  }

  private isDown = false;

  private up(): void {
    if (!this.isDown) return;
    this.isDown = false;
    this.notices.hide("down");
    this.keep.call();
    this.check.call();
    this.control.call();
    this.solve.call();
  }

  private download(): void {
    for (const { file, text } of this.files.unsaved()) {
      const link = document.createElement("a");
      link.href = URL.createObjectURL(new Blob([text], { type: "application/yaml" }));
      link.download = file.replaceAll("/", "-");
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 1000);
    }
  }

  private down(): void {
    if (!this.folder) {
      document.documentElement.dataset.locked = "";
      at("locked-text").textContent = "The program does not answer.";
      return;
    }
    if (this.isDown) return;
    this.isDown = true;
    const unsaved = this.files.unsaved().length > 0;
    this.notices.show("down", {
      text: `The program has ended. ${unsaved ? "What was typed until then is offered when gearloss open is started again; what is typed now is in this page only. " : ""}The page tries to connect again.`,
      kind: "bad",
      actions: unsaved ? [{ label: "Download unsaved texts", act: () => this.download(), stays: true, primary: true }] : [],
    });
  }

  private locked(): void {
    if (!this.folder) {
      document.documentElement.dataset.locked = "";
      return;
    }
    const unsaved = this.files.unsaved().length > 0;
    this.notices.show("down", {
      text: "The program has ended, and another one answers at its address, which gets nothing from this page. Start gearloss open again; what was typed until then is offered there, what is typed now is in this page only.",
      kind: "bad",
      actions: unsaved ? [{ label: "Download unsaved texts", act: () => this.download(), stays: true, primary: true }] : [],
    });
  }
}
