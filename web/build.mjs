// Bundles scripts and styles of the report page and of the workbench into the crates that include them, or into a folder given as argument.
import { build } from "esbuild";
import { copyFile, mkdir, readFile, stat, writeFile } from "node:fs/promises";
import { licence } from "./licence.mjs";

const given = process.argv[2];
const path = (name) => new URL(name, import.meta.url).pathname;
const common = { bundle: true, minify: true, charset: "utf8", legalComments: "none", logLevel: "warning" };

async function bundle(source, name, target) {
  await mkdir(target, { recursive: true });
  const entry = path(`src/${source}`);
  const script = await build({ ...common, entryPoints: [`${entry}.ts`], outfile: `${target}${name}.js`, format: "iife", target: "es2022", metafile: true, write: false });
  await writeFile(`${target}${name}.js`, (await licence(script.metafile.inputs)) + script.outputFiles[0].text);
  await build({ ...common, entryPoints: [`${entry.replace(/main$/, name)}.css`], outfile: `${target}${name}.css`, target: ["chrome111", "firefox113", "safari16.4"] });
}

const report = given ?? path("../framework/report/src/html/");
await bundle("report", "report", report);
for (const name of ["report.js", "report.css"]) {
  const text = await readFile(report + name, "utf8");
  // The text stands inside an element of the page, which it must not end.
  if (/<\/(script|style)|<!--/i.test(text)) throw new Error(`${name} contains the end of its element`);
  console.log(`${name} ${(await stat(report + name)).size} bytes`);
}

const workbench = given ?? path("../framework/workbench/src/page/");
await bundle("workbench/main", "workbench", workbench);
await copyFile(path("src/workbench/workbench.html"), `${workbench}workbench.html`);
for (const name of ["workbench.js", "workbench.css", "workbench.html"]) console.log(`${name} ${(await stat(workbench + name)).size} bytes`);
