// The text editor: one state for each file, findings, completion, explanations, definitions, renaming.

import { type Completion as Option, type CompletionContext, type CompletionResult, acceptCompletion, autocompletion, closeBrackets, closeBracketsKeymap, completionKeymap, startCompletion } from "@codemirror/autocomplete";
import { defaultKeymap, history, historyKeymap, indentWithTab, isolateHistory } from "@codemirror/commands";
import { yaml } from "@codemirror/lang-yaml";
import { bracketMatching, foldGutter, foldKeymap, indentOnInput, indentUnit } from "@codemirror/language";
import { type Diagnostic, lintGutter, lintKeymap, setDiagnostics } from "@codemirror/lint";
import { highlightSelectionMatches, openSearchPanel, search, searchKeymap } from "@codemirror/search";
import { EditorState, Prec, Transaction } from "@codemirror/state";
import { EditorView, drawSelection, highlightActiveLine, highlightActiveLineGutter, highlightSpecialChars, hoverTooltip, keymap, lineNumbers } from "@codemirror/view";
import { colouring } from "./colouring.ts";
import { replacement } from "./diff.ts";
import { describeFinding, once } from "./findings.ts";
import type { Files } from "./files.ts";
import { render } from "./markdown.ts";
import { byteOf, unitsOf } from "./offsets.ts";
import { fitting } from "./suggestions.ts";
import type { EditAnswer, EditRequest, FileRange, Finding } from "./protocol.ts";
import { html } from "../svg.ts";
import { escaped, hidden } from "../visible.ts";

export interface EditorHooks {
  files: Files;
  /** Asks the language services; null if the answer is not needed any more. */
  ask(request: EditRequest): Promise<EditAnswer | null>;
  /** Shows a place, in this or another file. */
  goTo(place: FileRange): void;
  /** A name for what is under the cursor; null if the user does not want it. */
  newName(old: string, at: { left: number; top: number }): Promise<string | null>;
  say(message: string): void;
}

const KINDS: Record<string, string> = { key: "property", word: "constant", unit: "constant", id: "variable", model: "class", designation: "enum", file: "text" };

export class Editor {
  readonly view: EditorView;
  current: string | null = null;
  private readonly states = new Map<string, EditorState>();

  constructor(
    host: HTMLElement,
    private readonly hooks: EditorHooks,
  ) {
    this.view = new EditorView({ parent: host, state: this.fresh("") });
  }

  private fresh(text: string, file = ""): EditorState {
    return EditorState.create({
      doc: text,
      extensions: [
        lineNumbers(),
        EditorView.lineWrapping,
        lintGutter(),
        foldGutter(),
        highlightActiveLine(),
        highlightActiveLineGutter(),
        history(),
        drawSelection(),
        highlightSpecialChars({ specialChars: hidden(), render: (code) => html(null, "span", { class: "cm-specialChar", title: "a character that cannot be seen" }, escaped(String.fromCodePoint(code))) }),
        indentOnInput(),
        indentUnit.of("  "),
        bracketMatching(),
        closeBrackets(),
        highlightSelectionMatches(),
        search({ top: true }),
        /\.ya?ml$/i.test(file) ? yaml() : [],
        colouring,
        autocompletion({ override: [(context) => this.complete(context)], activateOnTypingDelay: 40, icons: false, maxRenderedOptions: 200, defaultKeymap: true }),
        hoverTooltip((_, position) => this.hover(position), { hoverTime: 350 }),
        EditorState.allowMultipleSelections.of(true),
        EditorView.contentAttributes.of({ "aria-label": "text of the file", spellcheck: "false", tabindex: "0" }),
        Prec.high(
          keymap.of([
            { key: "F12", run: () => this.definition(this.view.state.selection.main.head) },
            { key: "F2", run: () => this.rename() },
            { key: "Tab", run: acceptCompletion },
            { key: "Ctrl-Space", run: startCompletion },
          ]),
        ),
        keymap.of([...closeBracketsKeymap, ...completionKeymap, ...searchKeymap, ...historyKeymap, ...foldKeymap, ...lintKeymap, ...defaultKeymap, indentWithTab]),
        EditorView.domEventHandlers({
          mousedown: (event, view) => {
            if (event.button !== 0 || !(event.ctrlKey || event.metaKey)) return false;
            const position = view.posAtCoords({ x: event.clientX, y: event.clientY });
            if (position === null) return false;
            event.preventDefault();
            return this.definition(position);
          },
        }),
        EditorView.updateListener.of((update) => {
          if (update.docChanged && this.current) this.hooks.files.setText(this.current, update.state.doc.toString());
        }),
      ],
    });
  }

  get text(): string {
    return this.view.state.doc.toString();
  }

  /** Shows a file that is open. */
  show(file: string): void {
    if (this.current === file) return;
    this.keep();
    this.current = file;
    const text = this.hooks.files.get(file)?.text ?? "";
    this.view.setState(this.states.get(file) ?? this.fresh(text, file));
  }

  close(file: string): void {
    this.states.delete(file);
    if (this.current === file) this.current = null;
  }

  /** Keeps the state of a file that has another name now. */
  renameFile(file: string, name: string): void {
    const state = this.states.get(file);
    this.states.delete(file);
    if (state) this.states.set(name, state);
    if (this.current === file) this.current = name;
  }

  private keep(): void {
    if (this.current) this.states.set(this.current, this.view.state);
  }

  /** Replaces the text of a file in one step that can be undone. */
  replace(file: string, text: string): void {
    const state = this.stateOf(file);
    const change = replacement(state.doc.toString(), text);
    if (change.from === change.to && !change.insert) return;
    this.change(file, [change]);
  }

  /** Changes a file in one step that can be undone, whether it is shown or not. */
  change(file: string, changes: { from: number; to: number; insert: string }[]): void {
    const spec = { changes, annotations: [isolateHistory.of("full"), Transaction.userEvent.of("input.program")] };
    if (file === this.current) {
      this.view.dispatch(spec);
      return;
    }
    const state = this.stateOf(file).update(spec).state;
    this.states.set(file, state);
    this.hooks.files.setText(file, state.doc.toString());
  }

  private stateOf(file: string): EditorState {
    if (file === this.current) return this.view.state;
    const own = this.states.get(file) ?? this.fresh(this.hooks.files.get(file)?.text ?? "", file);
    this.states.set(file, own);
    return own;
  }

  /** Shows findings at their places. */
  mark(file: string, findings: Finding[]): void {
    const state = this.stateOf(file);
    const text = state.doc.toString();
    const here = once(findings).filter((f) => f.place?.file === file);
    const ends = unitsOf(text, here.flatMap((f) => [f.place!.range.from, f.place!.range.to]));
    const diagnostics = here.map((finding, k): Diagnostic => {
      let [from, to] = [ends[2 * k], ends[2 * k + 1]];
      // A place without length is shown as one letter.
      if (from === to && to < text.length && text[to] !== "\n") to++;
      else if (from === to && from > 0 && text[from - 1] !== "\n") from--;
      return {
        from,
        to,
        severity: finding.severity,
        message: finding.message,
        renderMessage: () => {
          const element = document.createElement("div");
          element.className = "finding-tip";
          describeFinding(element, finding);
          return element;
        },
      };
    });
    if (file === this.current) this.view.dispatch(setDiagnostics(this.view.state, diagnostics));
    else this.states.set(file, state.update(setDiagnostics(state, diagnostics)).state);
  }

  /** Selects a range of bytes of the shown file and brings it into view. */
  select(from: number, to: number, focus = true): void {
    const [start, end] = unitsOf(this.text, [from, to]);
    this.view.dispatch({ selection: { anchor: start, head: end }, effects: EditorView.scrollIntoView(start, { y: "center" }) });
    if (focus) this.view.focus();
  }

  find(): void {
    openSearchPanel(this.view);
  }

  private async complete(context: CompletionContext): Promise<CompletionResult | null> {
    const file = this.current;
    if (!file) return null;
    const text = context.state.doc.toString();
    const line = context.state.doc.lineAt(context.pos);
    const before = line.text.slice(0, context.pos - line.from);
    if (!context.explicit && !/[\w"'./]$|:\s$|[[{,]\s?$/.test(before)) return null;
    if (!context.explicit && /^\s*#/.test(before)) return null;
    let answer: EditAnswer | null;
    try {
      answer = await this.hooks.ask({ request: "completion", file, offset: byteOf(text, context.pos) });
    } catch {
      return null;
    }
    if (context.aborted || answer?.answer !== "completion") return null;
    const found = fitting(text, context.pos, answer.value);
    // What is written in full needs no list.
    if (!context.explicit && found.length === 1 && text.slice(found[0].from, context.pos).trim() === found[0].completion.insert.trim()) return null;
    if (found.length === 0) return null;
    const from = Math.min(...found.map((f) => f.from));
    const options = found.map(({ completion, from: own, to }): Option => {
      const tail = to - context.pos;
      return {
        label: completion.label,
        detail: completion.detail || undefined,
        type: KINDS[completion.kind] ?? "text",
        info:
          completion.documentation || completion.detail.length > 40
            ? () => {
                const element = document.createElement("div");
                if (completion.detail.length > 40) element.append(Object.assign(document.createElement("p"), { textContent: completion.detail }));
                render(element, completion.documentation);
                return element;
              }
            : undefined,
        apply: (view, _, start, end) => {
          const at = start + own - from;
          view.dispatch({
            changes: { from: at, to: Math.min(view.state.doc.length, end + tail), insert: completion.insert },
            selection: { anchor: at + completion.insert.length },
            userEvent: "input.complete",
          });
        },
      };
    });
    return { from, options, filter: false };
  }

  private async hover(position: number) {
    const file = this.current;
    if (!file) return null;
    const text = this.text;
    let answer: EditAnswer | null;
    try {
      answer = await this.hooks.ask({ request: "hover", file, offset: byteOf(text, position) });
    } catch {
      return null;
    }
    if (answer?.answer !== "hover" || !answer.value) return null;
    const { text: markdown, range } = answer.value;
    const [pos, end] = unitsOf(text, [range.from, range.to]);
    return {
      pos,
      end,
      above: false,
      create: () => {
        const dom = document.createElement("div");
        dom.className = "hover-text";
        render(dom, markdown);
        return { dom };
      },
    };
  }

  private definition(position: number): boolean {
    const file = this.current;
    if (!file) return false;
    this.hooks.ask({ request: "definition", file, offset: byteOf(this.text, position) }).then(
      (answer) => {
        if (answer?.answer !== "places") return;
        if (answer.value[0]) this.hooks.goTo(answer.value[0]);
        else this.hooks.say("Nothing is defined elsewhere at this place.");
      },
      () => undefined,
    );
    return true;
  }

  private rename(): boolean {
    const file = this.current;
    if (!file) return false;
    const position = this.view.state.selection.main.head;
    const word = this.view.state.wordAt(position);
    const at = this.view.coordsAtPos(position) ?? { left: 100, bottom: 100 };
    const old = word ? this.view.state.sliceDoc(word.from, word.to) : "";
    const offset = byteOf(this.text, position);
    void this.hooks.newName(old, { left: at.left, top: at.bottom + 4 }).then(async (name) => {
      this.view.focus();
      if (name === null || name === old) return;
      try {
        const answer = await this.hooks.ask({ request: "rename", file, offset, name });
        if (answer?.answer === "no_rename") this.hooks.say(`${answer.value.message}. ${answer.value.help}`);
        if (answer?.answer !== "edits") return;
        for (const { file: own, edits } of answer.value) {
          if (!(await this.open(own))) continue;
          const text = this.stateOf(own).doc.toString();
          const ends = unitsOf(text, edits.flatMap((e) => [e.range.from, e.range.to]));
          this.change(own, edits.map((e, k) => ({ from: ends[2 * k], to: ends[2 * k + 1], insert: e.insert })));
        }
        const count = answer.value.reduce((sum, f) => sum + f.edits.length, 0);
        this.hooks.say(`${count} places in ${answer.value.length === 1 ? "one file" : `${answer.value.length} files`} renamed.`);
      } catch (fault) {
        this.hooks.say(fault instanceof Error ? fault.message : String(fault));
      }
    });
    return true;
  }

  /** Opens a file without showing it; set by the page. */
  open: (file: string) => Promise<boolean> = async (file) => this.hooks.files.get(file) !== undefined;
}
