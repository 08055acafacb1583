// Puts the workbench and the program into one page: node web/demo/build.mjs PROGRAM.wasm PAGE.html
import { build } from "esbuild";
import { readFile, writeFile } from "node:fs/promises";
import { gzipSync } from "node:zlib";
import { licence } from "../licence.mjs";

const [program, page] = process.argv.slice(2);
if (!program || !page) throw new Error("usage: node web/demo/build.mjs PROGRAM.wasm PAGE.html");
const path = (name) => new URL(`../src/workbench/${name}`, import.meta.url).pathname;
const common = { bundle: true, minify: true, charset: "utf8", legalComments: "none", logLevel: "warning", write: false };
const script = await build({ ...common, entryPoints: [path("demo.ts")], format: "iife", target: "es2022", metafile: true });
const style = await build({ ...common, entryPoints: [path("workbench.css")] });
const code = gzipSync(await readFile(program), { level: 9 }).toString("base64");

let html = await readFile(path("workbench.html"), "utf8");
const put = (what, by) => {
  if (!what.test(html)) throw new Error(`the page has no ${what}`);
  html = html.replace(what, () => by);
};
// The text of a script must not end its element.
const inside = (text) => text.replace(/<\/(script|style)/gi, "<\\/$1");
// Nothing is loaded from elsewhere; the report of a study is a page of its own in a blob.
const policy = "default-src 'none'; script-src 'unsafe-inline' 'wasm-unsafe-eval'; style-src 'unsafe-inline'; img-src data: blob:; frame-src blob:";
put(/<meta charset="utf-8">/, `<meta charset="utf-8">\n<meta http-equiv="Content-Security-Policy" content="${policy}">`);
put(/<link rel="stylesheet"[^>]*>/, `<style>${inside(style.outputFiles[0].text)}</style>`);
put(/<script[^>]*src="\/?workbench.js"[^>]*><\/script>/, "");
put(/<\/body>/, `<script type="text/plain" id="program">${code}</script>\n<script>${inside((await licence(script.metafile.inputs)) + script.outputFiles[0].text)}</script>\n</body>`);
await writeFile(page, html);
console.log(`${page}: ${html.length} bytes, of which the program ${code.length}`);
