// Small dialogs: a name, the difference of two texts.

import { html } from "../svg.ts";
import { rows } from "./diff.ts";
import { visible } from "../visible.ts";

/** Asks for a name; null if the dialog is left. A name for which `fault` has a sentence is not taken. */
export function askName(title: string, label: string, value: string, at?: { left: number; top: number }, fault: (name: string) => string | null = () => null): Promise<string | null> {
  const dialog = html(document.body, "dialog", { class: "small-dialog", "aria-label": title });
  if (at) {
    dialog.style.margin = "0";
    dialog.style.left = `${Math.min(at.left, innerWidth - 340)}px`;
    dialog.style.top = `${Math.min(at.top, innerHeight - 120)}px`;
  }
  const form = html(dialog, "form", { method: "dialog" });
  const field = html(form, "label");
  html(field, "span", {}, label);
  const input = html(field, "input", { type: "text", value, spellcheck: "false", autocomplete: "off" });
  const wrong = html(form, "p", { class: "dialog-fault", role: "alert" });
  input.addEventListener("input", () => {
    wrong.textContent = "";
    input.removeAttribute("aria-invalid");
  });
  form.addEventListener("submit", (event) => {
    const found = fault(input.value.trim());
    if (found === null) return;
    event.preventDefault();
    wrong.textContent = visible(found);
    input.setAttribute("aria-invalid", "true");
    input.focus();
  });
  const line = html(form, "div", { class: "dialog-actions" });
  html(line, "button", { type: "submit", value: "ok", class: "primary" }, title);
  const cancel = html(line, "button", { type: "button" }, "Cancel");
  cancel.addEventListener("click", () => dialog.close(""));
  return new Promise((done) => {
    dialog.addEventListener("close", () => {
      const name = input.value.trim();
      dialog.remove();
      done(dialog.returnValue === "ok" && name ? name : null);
    });
    dialog.showModal();
    input.select();
  });
}

/** Asks whether to do something that cannot be undone. */
export function askWhether(question: string, yes: string, no: string): Promise<boolean> {
  const dialog = html(document.body, "dialog", { class: "small-dialog", role: "alertdialog", "aria-label": question });
  html(dialog, "p", {}, question);
  const line = html(dialog, "div", { class: "dialog-actions" });
  const stay = html(line, "button", { type: "button", class: "primary" }, no);
  stay.addEventListener("click", () => dialog.close(""));
  html(line, "button", { type: "button" }, yes).addEventListener("click", () => dialog.close("yes"));
  return new Promise((done) => {
    dialog.addEventListener("close", () => {
      dialog.remove();
      done(dialog.returnValue === "yes");
    });
    dialog.showModal();
    stay.focus();
  });
}

/** Shows the difference of two texts with buttons; the returned index is the chosen one, null for none. */
export function showDifference(title: string, mine: string, theirs: string, actions: string[]): Promise<number | null> {
  const dialog = html(document.body, "dialog", { class: "wide-dialog", "aria-label": title });
  html(dialog, "h2", {}, title);
  html(dialog, "p", { class: "quiet" }, "− is only on the disk, + is only in the page.");
  const box = html(dialog, "div", { class: "difference", tabindex: 0, role: "region", "aria-label": "difference" });
  for (const row of rows(theirs, mine)) {
    const line = html(box, "div", { class: row.kind });
    html(line, "span", { class: "sign" }, { same: " ", removed: "−", added: "+", gap: "⋯" }[row.kind]);
    line.append(visible(row.text || " "));
  }
  const line = html(dialog, "div", { class: "dialog-actions" });
  return new Promise((done) => {
    let chosen: number | null = null;
    actions.forEach((label, k) => {
      const button = html(line, "button", { type: "button", class: k === 0 ? "primary" : undefined }, label);
      button.addEventListener("click", () => {
        chosen = k;
        dialog.close();
      });
    });
    const close = html(line, "button", { type: "button" }, "Decide later");
    close.addEventListener("click", () => dialog.close());
    dialog.addEventListener("close", () => {
      dialog.remove();
      done(chosen);
    });
    dialog.showModal();
  });
}
