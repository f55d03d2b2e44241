// Starts `bigactors lsp`, and shows traces as pages beside the text.
"use strict";

const fs = require("node:fs/promises");
const vscode = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");

let client;

async function activate(context) {
  context.subscriptions.push(vscode.commands.registerCommand("bigactors.restart", restart));
  await start();
}

async function start() {
  const command = vscode.workspace.getConfiguration("bigactors").get("command");
  client = new LanguageClient(
    "bigactors",
    "bigactors",
    { command, args: ["lsp"] },
    {
      documentSelector: [{ language: "mission" }],
      middleware: { window: { showDocument } },
    },
  );
  try {
    await client.start();
  } catch (error) {
    const hint = "Install it with: pip install 'bigactors[lsp]', or say where it is: bigactors.command";
    vscode.window.showErrorMessage(`'${command} lsp' does not start: ${error.message}. ${hint}`);
  }
}

async function restart() {
  await client?.stop().catch(() => {});
  await start();
}

// Show the page of a trace beside the mission. The page is one file, and its policy forbids to load anything else.
async function showDocument(params, next) {
  const uri = vscode.Uri.parse(params.uri);
  if (uri.scheme !== "file" || !uri.path.endsWith(".html")) {
    return next(params);
  }
  const title = `trace: ${uri.path.split("/").pop().replace(/\.html$/, "")}`;
  const panel = vscode.window.createWebviewPanel("bigactors.trace", title, vscode.ViewColumn.Beside, {
    enableScripts: true,
    retainContextWhenHidden: true,
    localResourceRoots: [],
  });
  panel.webview.html = await fs.readFile(uri.fsPath, "utf8");
  return { success: true };
}

function deactivate() {
  return client?.stop();
}

module.exports = { activate, deactivate };
