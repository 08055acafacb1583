// Bundles the extension into one file; the editor brings `vscode` itself.
import { build } from "esbuild";

await build({
  entryPoints: [new URL("src/extension.ts", import.meta.url).pathname],
  outfile: new URL("out/extension.js", import.meta.url).pathname,
  bundle: true,
  minify: true,
  platform: "node",
  format: "cjs",
  target: "node20",
  external: ["vscode"],
  logLevel: "warning",
});
