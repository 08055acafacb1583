// A new gearbox from a form: a layout, its fields, and the text that they give.

import { html, unique } from "../svg.ts";
import { words } from "../format.ts";
import { searches } from "./catalogue.ts";
import { askWhether } from "./dialogs.ts";
import { describeFinding } from "./findings.ts";
import { fileName, freeName, nameFault } from "./names.ts";
import { Quiet } from "./pace.ts";
import { prose } from "./prose.ts";
import type { CatalogueOf, Fault, Field, Finding, Layout } from "./protocol.ts";
import { Newest, Refused, type Transport } from "./transport.ts";
import { visible } from "../visible.ts";

/** The catalogue that a kind of field searches. */
const CATALOGUES: Partial<Record<Field["kind"], CatalogueOf>> = { bearing: "bearings", oil: "oils", material: "materials" };

/** The field that a finding belongs to: its path is that of the field, or inside of it, or around it. */
export function fieldOf(path: string, fields: string[]): string | null {
  if (fields.includes(path)) return path;
  const inside = fields.filter((f) => path.startsWith(`${f}.`) || path.startsWith(`${f}[`));
  if (inside.length) return inside.sort((a, b) => b.length - a.length)[0];
  const around = fields.filter((f) => f.startsWith(`${path}.`) || f.startsWith(`${path}[`));
  return path && around.length === 1 ? around[0] : null;
}

export function newGearbox(layouts: Layout[], transport: Transport, taken: () => string[], create: (file: string, text: string) => void, layout?: string): void {
  const dialog = html(document.body, "dialog", { class: "form-dialog", "aria-labelledby": "form-title" });
  const head = html(dialog, "header");
  html(head, "h2", { id: "form-title" }, "New gearbox");
  const choice = html(head, "label", { class: "layout-choice" });
  html(choice, "span", {}, "Layout");
  const select = html(choice, "select", { id: "layout" });
  for (const { name } of layouts) html(select, "option", { value: name }, name);
  const about = html(head, "p", { class: "quiet" });
  const ratios = html(head, "p", { class: "ratios", role: "status" });
  const body = html(dialog, "div", { class: "form-body" });
  const fields = html(body, "form", { class: "fields", autocomplete: "off", novalidate: "" });
  const side = html(body, "div", { class: "form-side" });
  const state = html(side, "p", { class: "form-state", role: "status" });
  const preview = html(side, "pre", { class: "preview", tabindex: 0, role: "region", "aria-label": "text of the gearbox" });
  const foot = html(dialog, "footer", { class: "dialog-actions" });
  const named = html(foot, "label");
  html(named, "span", {}, "File");
  const name = html(named, "input", { type: "text", spellcheck: "false", id: "form-file" });
  const nameError = html(foot, "span", { class: "dialog-fault", id: "form-file-error", role: "alert" });
  name.setAttribute("aria-describedby", nameError.id);
  const ok = html(foot, "button", { type: "button", class: "primary", id: "form-create" }, "Create");
  const cancel = html(foot, "button", { type: "button" }, "Cancel");

  const newest = new Newest(transport);
  const catalogue = new Newest(transport);
  const inputs = new Map<string, { field: Field; input: HTMLInputElement | HTMLSelectElement; error: HTMLElement }>();
  /** What was typed, by the path of its field; another layout takes what it has fields for. */
  const typed = new Map<string, string>();
  let text: string | null = null;

  const faults = (fault: Fault | null) => {
    for (const { input, error } of inputs.values()) {
      error.replaceChildren();
      input.removeAttribute("aria-invalid");
    }
    state.replaceChildren();
    if (!fault) return;
    const elsewhere: Finding[] = [];
    for (const finding of fault.findings) {
      const path = fieldOf(finding.path, [...inputs.keys()]);
      const at = path === null ? undefined : inputs.get(path);
      if (!at) {
        elsewhere.push(finding);
        continue;
      }
      at.input.setAttribute("aria-invalid", "true");
      prose(html(at.error, "span"), finding.message);
      if (finding.help) prose(html(at.error, "span"), `help: ${finding.help}`);
    }
    state.dataset.state = "bad";
    prose(html(state, "span"), fault.findings.length ? "The gearbox has errors." : fault.message);
    if (fault.help) prose(html(state, "span"), ` help: ${fault.help}`);
    for (const finding of elsewhere) describeFinding(html(state, "div", { class: "finding-tip" }), finding);
  };
  const ask = async () => {
    const values: Record<string, string> = {};
    for (const [path, value] of typed) if (inputs.has(path)) values[path] = value;
    try {
      const answer = await newest.ask({ request: "new", layout: select.value, values });
      if (!answer) return;
      preview.textContent = visible(answer.text);
      for (const [path, { field, input }] of inputs) {
        if (typed.has(path)) continue;
        input.value = answer.followed[path] ?? field.value;
        input.classList.toggle("followed", path in answer.followed);
      }
      const ratioOf = ({ gear, to, ratio }: (typeof answer.ratios)[number]) => {
        const of = [gear, to].filter((name) => name !== "only" && name !== "output").join(" ");
        return `${String(Number(ratio.toPrecision(5))).replace("-", "\u2212")}${of ? ` (${of})` : ""}`;
      };
      ratios.textContent = answer.ratios.length ? `Ratio ${answer.ratios.map(ratioOf).join(", ")}` : "";
      delete preview.dataset.stale;
      // A value that cannot be a value of its field, or does not fit the others, is a finding of the text.
      const file = "new-gearbox.yaml";
      const checked = await newest.ask({ request: "edit", texts: { [file]: answer.text }, edit: { request: "findings", file } });
      if (!checked) return;
      const findings = checked.answer === "findings" ? checked.value : [];
      const errors = findings.filter((f) => f.severity === "error");
      if (errors.length) {
        text = null;
        faults({ message: "", help: null, findings: errors });
        ok.disabled = true;
        return;
      }
      text = answer.text;
      faults(null);
      state.dataset.state = findings.length ? "warn" : "good";
      state.textContent = findings.length ? `The text of this gearbox has no errors, but ${findings.length === 1 ? "a warning" : `${findings.length} warnings`}.` : "The text of this gearbox has no errors.";
      for (const finding of findings) describeFinding(html(state, "div", { class: "finding-tip warning" }), finding);
    } catch (fault) {
      text = null;
      preview.dataset.stale = "";
      faults(fault instanceof Refused ? fault.fault : { message: fault instanceof Error ? fault.message : String(fault), help: null, findings: [] });
    }
    ok.disabled = text === null;
  };
  const soon = new Quiet(120, () => void ask());
  const changed = () => {
    ok.disabled = true;
    soon.call();
  };
  const build = () => {
    const layout = layouts.find((l) => l.name === select.value)!;
    about.textContent = layout.about;
    fields.replaceChildren();
    inputs.clear();
    for (const group of layout.groups) {
      const outer = html(fields, "fieldset");
      const set = group.folded ? html(outer, "details") : outer;
      if (set instanceof HTMLDetailsElement) set.open = group.fields.some((f) => typed.has(f.path));
      html(set, group.folded ? "summary" : "legend", {}, group.title);
      for (const field of group.fields) {
        const id = unique("field");
        const line = html(set, "div", { class: "field", "data-path": field.path });
        html(line, "label", { for: id }, words(field.label));
        const input = field.choices ? html(line, "select", { id, "aria-describedby": `${id}-help ${id}-error` }) : html(line, "input", { id, type: "text", value: typed.get(field.path) ?? field.value, spellcheck: "false", placeholder: field.example, "aria-describedby": `${id}-help ${id}-error`, inputmode: field.kind === "integer" ? "numeric" : undefined });
        for (const value of field.choices ?? []) html(input, "option", { value }, value || "not stated");
        if (field.choices) input.value = typed.get(field.path) ?? field.value;
        html(line, "span", { class: "field-help", id: `${id}-help` }, words(field.help));
        const error = html(line, "span", { class: "field-error", id: `${id}-error`, "aria-live": "polite" });
        inputs.set(field.path, { field, input, error });
        const noted = () => {
          // A value of the template that is typed in place of one that follows is typed.
          if (input.value === field.value && !input.classList.contains("followed")) typed.delete(field.path);
          else typed.set(field.path, input.value);
          changed();
        };
        input.addEventListener("input", noted);
        const of = CATALOGUES[field.kind];
        if (of && input instanceof HTMLInputElement) searches(input, of, (of, part) => catalogue.ask({ request: "catalogue", of, text: part }), noted);
      }
    }
    text = null;
    changed();
  };
  const finish = () => {
    if (text === null) return;
    const file = fileName(name.value);
    const fault = nameFault(file, taken());
    if (fault !== null) {
      nameError.textContent = visible(fault);
      name.setAttribute("aria-invalid", "true");
      name.focus();
      return;
    }
    dialog.close();
    create(file, text);
  };
  const leave = async () => {
    if (typed.size === 0 || (await askWhether(`Discard the form with ${typed.size === 1 ? "the value" : `the ${typed.size} values`} that you typed?`, "Discard", "Go on with the form"))) dialog.close();
  };
  name.value = freeName("gearbox.yaml", taken());
  name.addEventListener("input", () => {
    nameError.textContent = "";
    name.removeAttribute("aria-invalid");
  });
  // Before the browser closes the dialog, which it does not let a page prevent twice.
  dialog.addEventListener("keydown", (event) => {
    if (event.key !== "Escape" || event.defaultPrevented) return;
    event.preventDefault();
    void leave();
  });
  dialog.addEventListener("cancel", (event) => {
    event.preventDefault();
    void leave();
  });
  select.addEventListener("change", build);
  fields.addEventListener("submit", (event) => event.preventDefault());
  ok.addEventListener("click", finish);
  cancel.addEventListener("click", () => void leave());
  dialog.addEventListener("close", () => {
    soon.cancel();
    newest.abort();
    catalogue.abort();
    dialog.remove();
  });
  if (layout !== undefined) select.value = layout;
  build();
  dialog.showModal();
  select.focus();
}
