// Names of new files: what the program accepts (`check_new_name` in `framework/workbench/src/store.rs`).

/** A name as it is saved: without spaces around it, with the extension of YAML. */
export function fileName(typed: string, extension = "yaml"): string {
  const name = typed.trim();
  if (!name || name.endsWith("/")) return name;
  const found = /\.(ya?ml|csv)$/i.exec(name);
  if (found && (extension === "csv") === (found[1].toLowerCase() === "csv")) return name.slice(0, found.index) + found[0].toLowerCase();
  return `${name}.${extension}`;
}

/** Names of devices on Windows, with any extension. */
const DEVICE = /^(con|prn|aux|nul|(com|lpt)\d) *(\.|$)/i;

const folderOf = (file: string) => file.slice(0, file.lastIndexOf("/") + 1);

/** Whether a name is in a list; disks of Windows and macOS do not tell large letters from small ones. */
export function isTaken(name: string, taken: string[]): boolean {
  const own = name.toLowerCase();
  return taken.some((other) => other.toLowerCase() === own);
}

/** Why a name of `fileName` cannot be that of a new file beside the `known` ones; null if it can. */
export function nameFault(name: string, known: string[]): string | null {
  if (!name) return "The file needs a name.";
  const folder = folderOf(name);
  const last = name.slice(folder.length);
  if (!last) return `${name} is a folder. Write the name of the file after it.`;
  const folders = new Set(known.flatMap((file) => [...file.matchAll(/\//g)].map((slash) => file.slice(0, slash.index + 1))));
  if (folder && !folders.has(folder)) {
    const list = [...folders].sort().slice(0, 4).join(", ");
    return `The opened folder has no files in ${folder}. ${list ? `Use one of its folders, such as ${list}, or none.` : "Write the name without a folder."}`;
  }
  if (last.startsWith(".")) return `${last} begins with a dot. Begin with a letter or a digit.`;
  if (!/^[\p{L}\p{N}_-][\p{L}\p{N} _.-]*$/u.test(last)) return `${last} has signs that names of files may not have. Write letters, digits, spaces, _, - and dots.`;
  if (DEVICE.test(last)) return `${last} is the name of a device on Windows. Choose another name.`;
  if (isTaken(name, known)) return `${name} exists already. Choose another name.`;
  return null;
}

/** A name that no file of the folder has. */
export function freeName(wanted: string, taken: string[]): string {
  if (!isTaken(wanted, taken)) return wanted;
  const [, stem, end] = /^(.*?)(\.[^./]*)?$/.exec(wanted)!;
  for (let k = 2; ; k++) {
    const name = `${stem}-${k}${end ?? ""}`;
    if (!isTaken(name, taken)) return name;
  }
}

/** The path of a file as a file of `folder` names it. */
function relative(file: string, folder: string): string {
  const [parts, from] = [file.split("/"), folder.split("/").slice(0, -1)];
  let same = 0;
  while (same < from.length && same < parts.length - 1 && parts[same] === from[same]) same++;
  return "../".repeat(from.length - same) + parts.slice(same).join("/");
}

/** A file and those that it names, and that they name, of some texts. */
export function namedBy(file: string, texts: Record<string, string>): string[] {
  const found = [file];
  for (const own of found) {
    const [text, folder] = [texts[own] ?? "", folderOf(own)];
    for (const other of Object.keys(texts)) if (!found.includes(other) && text.includes(relative(other, folder))) found.push(other);
  }
  return found;
}
