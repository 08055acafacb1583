// Starts `gearloss lsp` and connects it with the editor. Everything else is in the program.
import { commands, type ExtensionContext, window, workspace } from "vscode";
import { LanguageClient } from "vscode-languageclient/node";

let client: LanguageClient | undefined;

async function start(): Promise<void> {
  const command = workspace.getConfiguration("gearloss").get<string>("path") ?? "gearloss";
  client = new LanguageClient(
    "gearloss",
    { command, args: ["lsp"] },
    {
      // The server is silent about YAML files without the key `gearloss`.
      documentSelector: [
        { scheme: "file", language: "yaml" },
        { scheme: "untitled", language: "yaml" },
      ],
      synchronize: { fileEvents: workspace.createFileSystemWatcher("**/*.{yaml,yml,csv}") },
    },
  );
  try {
    await client.start();
  } catch (error) {
    client = undefined;
    const reason = error instanceof Error ? error.message : String(error);
    void window.showErrorMessage(`Cannot start \`${command} lsp\`: ${reason}. Install gearloss, or set gearloss.path.`);
  }
}

async function stop(): Promise<void> {
  const running = client;
  client = undefined;
  await running?.stop();
}

export async function activate(context: ExtensionContext): Promise<void> {
  context.subscriptions.push(
    commands.registerCommand("gearloss.restart", async () => {
      await stop();
      await start();
    }),
  );
  await start();
}

export async function deactivate(): Promise<void> {
  await stop();
}
