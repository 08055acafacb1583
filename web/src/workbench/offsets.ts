// Offsets of the protocol count bytes of UTF-8; those of the editor count UTF-16 units.

/** Bytes of UTF-8 of a unit of UTF-16 at its place; the second half of a pair has none. */
function bytesAt(text: string, unit: number): number {
  const code = text.charCodeAt(unit);
  if (code < 0x80) return 1;
  if (code < 0x800) return 2;
  const next = text.charCodeAt(unit + 1);
  const before = text.charCodeAt(unit - 1);
  if (code >= 0xd800 && code < 0xdc00 && next >= 0xdc00 && next < 0xe000) return 4;
  if (code >= 0xdc00 && code < 0xe000 && before >= 0xd800 && before < 0xdc00) return 0;
  return 3;
}

/** The byte at a UTF-16 offset. */
export function byteOf(text: string, unit: number): number {
  let bytes = 0;
  const end = Math.min(unit, text.length);
  for (let k = 0; k < end; k++) bytes += bytesAt(text, k);
  return bytes;
}

/** The UTF-16 offset of a byte; the start of its character if the byte is inside of one, the end of the text if it is behind it. */
export function unitOf(text: string, byte: number): number {
  let bytes = 0;
  for (let k = 0; k < text.length; k++) {
    const own = bytesAt(text, k);
    if (own > 0 && bytes + own > byte) return k;
    bytes += own;
  }
  return text.length;
}

/** Several ascending or unordered bytes at once. */
export function unitsOf(text: string, bytes: number[]): number[] {
  const order = bytes.map((_, k) => k).sort((a, b) => bytes[a] - bytes[b]);
  const found = new Array<number>(bytes.length);
  let [unit, passed] = [0, 0];
  for (const k of order) {
    while (unit < text.length) {
      const own = bytesAt(text, unit);
      if (own > 0 && passed + own > bytes[k]) break;
      passed += own;
      unit++;
    }
    found[k] = unit;
  }
  return found;
}
