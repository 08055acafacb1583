// The server with the library that editors use for the protocol, and the bundle with a stand-in for the editor.
// GEARLOSS is the program.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { existsSync } from "node:fs";
import { readFile } from "node:fs/promises";
import { createRequire } from "node:module";
import Module from "node:module";
import { test } from "node:test";
import { fileURLToPath, pathToFileURL } from "node:url";

const require = createRequire(import.meta.url);
const { createProtocolConnection, StreamMessageReader, StreamMessageWriter } = require("vscode-languageserver-protocol/node");
const program = process.env.GEARLOSS;
const example = fileURLToPath(new URL("../../../examples/two-speed-ev/gearbox.yaml", import.meta.url));

test("a session over the protocol library", { skip: !program && "GEARLOSS is not set" }, async () => {
  const server = spawn(program, ["lsp"], { stdio: ["pipe", "pipe", "inherit"] });
  const connection = createProtocolConnection(new StreamMessageReader(server.stdout), new StreamMessageWriter(server.stdin));
  const published = [];
  let wake = () => {};
  connection.onNotification("textDocument/publishDiagnostics", (params) => {
    published.push(params);
    wake();
  });
  connection.listen();
  const { capabilities } = await connection.sendRequest("initialize", { processId: process.pid, rootUri: null, capabilities: {} });
  assert.equal(capabilities.positionEncoding, "utf-16");
  await connection.sendNotification("initialized", {});
  const uri = pathToFileURL(example).href;
  const text = (await readFile(example, "utf8")) + "seals: { S9: { shaft: ";
  await connection.sendNotification("textDocument/didOpen", { textDocument: { uri, languageId: "yaml", version: 1, text } });
  while (published.length === 0) await new Promise((resolve) => (wake = resolve));
  assert.equal(published[0].uri, uri);
  assert.equal(published[0].diagnostics[0].source, "gearloss");
  const lines = text.split("\n");
  const position = { line: lines.length - 1, character: lines.at(-1).length };
  const { items } = await connection.sendRequest("textDocument/completion", { textDocument: { uri }, position });
  assert.ok(items.some((item) => item.label === "input"), JSON.stringify(items.map((item) => item.label)));
  const symbols = await connection.sendRequest("textDocument/documentSymbol", { textDocument: { uri } });
  assert.ok(symbols.some((symbol) => symbol.name === "shafts"));
  await connection.sendRequest("shutdown");
  const ended = new Promise((resolve) => server.on("exit", resolve));
  await connection.sendNotification("exit");
  assert.equal(await ended, 0);
  connection.dispose();
});

test("the bundle exports what the editor calls", { skip: !existsSync(new URL("../out/extension.js", import.meta.url)) && "not built" }, () => {
  // Any property of the stand-in is a class, a function and a namespace at once.
  const anything = new Proxy(class {}, { get: (target, key) => (key in target ? target[key] : anything) });
  const resolve = Module._load;
  Module._load = (name, ...rest) => (name === "vscode" ? anything : resolve(name, ...rest));
  try {
    const extension = require("../out/extension.js");
    assert.equal(typeof extension.activate, "function");
    assert.equal(typeof extension.deactivate, "function");
  } finally {
    Module._load = resolve;
  }
});
