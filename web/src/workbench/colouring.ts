// Look of the editor: colours of YAML by the variables of the style sheet.

import { HighlightStyle, syntaxHighlighting } from "@codemirror/language";
import { EditorView } from "@codemirror/view";
import { tags } from "@lezer/highlight";

const style = HighlightStyle.define([
  { tag: [tags.definition(tags.propertyName), tags.propertyName], color: "var(--y-key)" },
  { tag: [tags.string, tags.special(tags.string), tags.attributeValue], color: "var(--y-text)" },
  { tag: [tags.content], color: "var(--gl-ink)" },
  { tag: [tags.comment, tags.lineComment], color: "var(--y-comment)" },
  { tag: [tags.keyword, tags.typeName, tags.labelName, tags.meta], color: "var(--y-mark)" },
  { tag: [tags.punctuation, tags.separator, tags.squareBracket, tags.brace], color: "var(--gl-soft)" },
]);

const look = EditorView.theme({
  "&": { height: "100%", color: "var(--gl-ink)", backgroundColor: "var(--gl-ground)", fontSize: "12.5px" },
  "&.cm-focused": { outline: "none" },
  ".cm-scroller": { fontFamily: "var(--mono)", lineHeight: "1.5" },
  ".cm-content": { caretColor: "var(--gl-ink)", padding: "4px 0" },
  ".cm-cursor, .cm-dropCursor": { borderLeftColor: "var(--gl-ink)" },
  ".cm-gutters": { backgroundColor: "var(--gl-ground)", color: "var(--gl-soft)", border: "none", borderRight: "1px solid var(--gl-grid)" },
  ".cm-lineNumbers .cm-gutterElement": { padding: "0 6px 0 8px", minWidth: "30px" },
  ".cm-gutter-lint": { width: "14px" },
  ".cm-gutter-lint .cm-gutterElement": { padding: "0 2px" },
  ".cm-lint-marker": { width: "9px", height: "9px", marginTop: "5px", content: "none !important", borderRadius: "50%" },
  ".cm-lint-marker-error": { content: "none", background: "var(--bad)" },
  ".cm-lint-marker-warning": { content: "none", background: "var(--warn)" },
  ".cm-activeLine, .cm-activeLineGutter": { backgroundColor: "var(--active)" },
  ".cm-selectionBackground, &.cm-focused > .cm-scroller > .cm-selectionLayer .cm-selectionBackground": { backgroundColor: "var(--select)" },
  ".cm-selectionMatch": { backgroundColor: "var(--match)" },
  ".cm-searchMatch": { backgroundColor: "var(--match)", outline: "1px solid var(--gl-line)" },
  ".cm-lintRange-error": { backgroundImage: "none", textDecoration: "underline wavy var(--bad) 1px", textUnderlineOffset: "3px", textDecorationSkipInk: "none" },
  ".cm-lintRange-warning": { backgroundImage: "none", textDecoration: "underline wavy var(--warn) 1px", textUnderlineOffset: "3px", textDecorationSkipInk: "none" },
  ".cm-lintPoint::after": { borderBottomColor: "var(--bad)" },
  ".cm-tooltip": { backgroundColor: "var(--gl-raised)", color: "var(--gl-ink)", border: "1px solid var(--gl-line)", borderRadius: "5px", boxShadow: "0 3px 12px rgb(0 0 0 / 18%)", maxWidth: "560px", zIndex: "40" },
  ".cm-diagnostic": { padding: "5px 10px", borderLeft: "3px solid var(--bad)" },
  ".cm-diagnostic-warning": { borderLeftColor: "var(--warn)" },
  ".cm-tooltip.cm-tooltip-autocomplete > ul": { fontFamily: "var(--mono)", fontSize: "12.5px", maxHeight: "14em" },
  ".cm-tooltip.cm-tooltip-autocomplete > ul > li": { padding: "1px 8px", display: "flex", gap: "12px" },
  ".cm-tooltip-autocomplete ul li[aria-selected]": { background: "var(--gl-accent)", color: "var(--gl-ground)" },
  ".cm-completionLabel": { flex: "none" },
  ".cm-completionMatchedText": { textDecoration: "none", fontWeight: "700" },
  ".cm-completionDetail": { fontStyle: "normal", color: "var(--gl-soft)", marginLeft: "auto", overflow: "hidden", textOverflow: "ellipsis", maxWidth: "300px" },
  "li[aria-selected] .cm-completionDetail": { color: "inherit" },
  ".cm-tooltip.cm-completionInfo": { padding: "6px 10px", maxWidth: "360px", fontSize: "12.5px" },
  ".cm-panels": { backgroundColor: "var(--gl-raised)", color: "var(--gl-ink)", borderColor: "var(--gl-line)" },
  ".cm-panel.cm-search": { padding: "4px 26px 4px 8px", fontSize: "12px" },
  ".cm-panel.cm-search label": { fontSize: "12px" },
  ".cm-panel.cm-search [name=close]": { color: "inherit", fontSize: "16px", right: "8px" },
  ".cm-textfield": { fontSize: "12px", backgroundColor: "var(--gl-ground)", color: "var(--gl-ink)", border: "1px solid var(--gl-line)", borderRadius: "3px" },
  ".cm-button": { fontSize: "12px", backgroundImage: "none", backgroundColor: "var(--gl-ground)", color: "var(--gl-ink)", border: "1px solid var(--gl-line)", borderRadius: "3px" },
});

export const colouring = [look, syntaxHighlighting(style)];
