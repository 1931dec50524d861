// What is packaged is enough to start: the extension with its own libraries only, a stand-in for the editor, and a
// server that is missing.

"use strict";

const assert = require("node:assert/strict");
const fs = require("node:fs");
const Module = require("node:module");
const os = require("node:os");
const path = require("node:path");
const test = require("node:test");
const { listFiles } = require("@vscode/vsce");

const FOLDER = path.join(__dirname, "..");

/** A folder with the files of the package alone. */
async function unpacked() {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), "agentspeak-"));
  for (const file of await listFiles({ cwd: FOLDER })) {
    fs.cpSync(path.join(FOLDER, file), path.join(folder, file));
  }
  return folder;
}

/** An object that also has every method and class that is not known; methods return such an object. */
function having(known) {
  const unknown = (name) => (/^[a-z]/.test(name) ? () => having({}) : class {});
  const isPlain = (name) => typeof name === "symbol" || name === "then";
  return new Proxy(known, {
    get: (object, name) => (name in object || isPlain(name) ? object[name] : unknown(name)),
  });
}

test("the packaged extension starts, and says that the server is missing", async (t) => {
  const folder = await unpacked();
  t.after(() => fs.rmSync(folder, { recursive: true }));
  const said = [];
  const editor = having({
    version: "1.91.0",
    EventEmitter: class {
      event = () => ({ dispose() {} });
      fire() {}
      dispose() {}
    },
    languages: having({ setTextDocumentLanguage: async () => {} }),
    window: having({ showErrorMessage: (message) => said.push(message) }),
    workspace: having({
      textDocuments: [],
      getConfiguration: () => ({ get: () => path.join(folder, "missing") }),
    }),
  });
  const load = Module._load;
  t.after(() => (Module._load = load));
  Module._load = (name, ...rest) => (name === "vscode" ? editor : load(name, ...rest));
  const extension = require(path.join(folder, "extension.js"));
  await extension.activate({ subscriptions: [] });
  // The library says so in its own words, too.
  assert.ok(said.some((message) => /missing lsp` does not start/.test(message)), said.join("\n"));
  await extension.deactivate();
});
