// Numbers as they are typed.

/** A number, or how to write it. */
export type Entry = { value: number } | { fault: string };

const NUMBER = /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i;

/** Reads `12.5`, `-3`, `1e3`. A decimal comma is a fault: a value ten times too large would be the alternative. */
export function entryOf(typed: string): Entry {
  const text = typed.trim().replace(/\u2212/g, "-");
  if (NUMBER.test(text)) {
    const value = Number(text);
    return Number.isFinite(value) ? { value } : { fault: "write a smaller number" };
  }
  const withPoint = text.includes(".") ? text.replaceAll(",", "") : text.replace(",", ".");
  if (text.includes(",") && NUMBER.test(withPoint)) {
    // 1,000 may be one or a thousand.
    const groups = /^[+-]?[1-9]\d{0,2},\d{3}$/.test(text);
    return { fault: groups ? `write ${text.replace(",", "")} or ${withPoint}` : `write ${withPoint}` };
  }
  const groups = text.replaceAll(",", "");
  if (text.includes(",") && NUMBER.test(groups)) return { fault: `write ${groups}` };
  return { fault: "write a number, such as 12.5 or 1e3" };
}
