// Starts `asl2c lsp`, and recognises configurations of agents.

"use strict";

const { languages, window, workspace } = require("vscode");
const { LanguageClient, TransportKind } = require("vscode-languageclient/node");
const { isConfiguration } = require("./detection");

const AGENT = "agentspeak";
const CONFIGURATION = "agentspeak-configuration";
const SYSTEM = "agentspeak-system";

let client;

async function recognise(document) {
  const named = document.fileName.endsWith(".conf") && document.languageId !== CONFIGURATION;
  if (named && isConfiguration(document.getText())) {
    await languages.setTextDocumentLanguage(document, CONFIGURATION);
  }
}

async function start() {
  const command = workspace.getConfiguration("asl2c").get("path") || "asl2c";
  const server = { command, args: ["lsp"], transport: TransportKind.stdio };
  const documentSelector = [AGENT, CONFIGURATION, SYSTEM].map((language) => ({ language }));
  client = new LanguageClient("asl2c", "asl2c", server, { documentSelector });
  try {
    await client.start();
  } catch (error) {
    client = undefined;
    window.showErrorMessage(
      `AgentSpeak: \`${command} lsp\` does not start (${error.message ?? error}). Install asl2c ` +
        "(`cargo install --path asl2c`), or name it in the setting `asl2c.path`; an asl2c without `lsp` is too old.",
    );
  }
}

async function restart(change) {
  if (change.affectsConfiguration("asl2c.path")) {
    await deactivate();
    await start();
  }
}

async function activate(context) {
  context.subscriptions.push(
    workspace.onDidOpenTextDocument(recognise),
    workspace.onDidChangeConfiguration(restart),
  );
  await Promise.all(workspace.textDocuments.map(recognise));
  await start();
}

async function deactivate() {
  const running = client;
  client = undefined;
  await running?.stop();
}

module.exports = { activate, deactivate };
