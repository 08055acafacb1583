// Bundles the script and the style of the report page into the crate that includes them, or into a folder given as argument.
import { build } from "esbuild";
import { readFile, stat } from "node:fs/promises";

const target = process.argv[2] ?? new URL("../framework/report/src/html/", import.meta.url).pathname;
const common = { bundle: true, minify: true, charset: "utf8", legalComments: "none", logLevel: "warning" };

await build({
  ...common,
  entryPoints: [new URL("src/report.ts", import.meta.url).pathname],
  outfile: `${target}report.js`,
  format: "iife",
  target: "es2022",
});
await build({
  ...common,
  entryPoints: [new URL("src/report.css", import.meta.url).pathname],
  outfile: `${target}report.css`,
  target: ["chrome111", "firefox113", "safari16.4"],
});

for (const name of ["report.js", "report.css"]) {
  const text = await readFile(target + name, "utf8");
  // The text stands inside an element of the page, which it must not end.
  if (/<\/(script|style)|<!--/i.test(text)) throw new Error(`${name} contains the end of its element`);
  console.log(`${name} ${(await stat(target + name)).size} bytes`);
}
