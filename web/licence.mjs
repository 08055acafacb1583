// The licence of what a bundle contains.
import { readFile } from "node:fs/promises";

/** The licence of the packages in a bundle as a comment: all of them have the same one, with several owners. `inputs` are those of esbuild's metafile. */
export async function licence(inputs) {
  const folders = new Set(Object.keys(inputs).flatMap((file) => /^(?:.*\/)?node_modules\/((?:@[^/]+\/)?[^/]+)/.exec(file)?.[1] ?? []));
  const owners = new Set();
  const names = [];
  let terms = "";
  for (const folder of [...folders].sort()) {
    const { version, license } = JSON.parse(await readFile(new URL(`node_modules/${folder}/package.json`, import.meta.url), "utf8"));
    const text = await readFile(new URL(`node_modules/${folder}/LICENSE`, import.meta.url), "utf8");
    if (license !== "MIT") throw new Error(`${folder} has the licence ${license}`);
    names.push(`${folder} ${version}`);
    owners.add(/^Copyright.*$/m.exec(text)[0]);
    terms = text.slice(text.indexOf("Permission")).trim();
  }
  if (names.length === 0) return "";
  return `/*! Contains ${names.join(", ")}\n\nMIT License\n\n${[...owners].sort().join("\n")}\n\n${terms} */\n`;
}
