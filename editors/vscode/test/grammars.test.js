// The grammars give every character of real texts a scope, the right one for names, and mark what is no AgentSpeak.

"use strict";

const assert = require("node:assert/strict");
const fs = require("node:fs");
const path = require("node:path");
const test = require("node:test");
const oniguruma = require("vscode-oniguruma");
const { INITIAL, Registry, parseRawGrammar } = require("vscode-textmate");
const { isConfiguration } = require("../detection");

const ROOT = path.join(__dirname, "../../..");
const AGENT = "source.agentspeak";
const CONFIGURATION = "source.agentspeak-configuration";
const SYSTEM = "source.agentspeak-system";

async function grammars() {
  const wasm = fs.readFileSync(require.resolve("vscode-oniguruma/release/onig.wasm"));
  await oniguruma.loadWASM(wasm.buffer.slice(wasm.byteOffset, wasm.byteOffset + wasm.byteLength));
  const registry = new Registry({
    onigLib: Promise.resolve({
      createOnigScanner: (patterns) => new oniguruma.OnigScanner(patterns),
      createOnigString: (text) => new oniguruma.OnigString(text),
    }),
    loadGrammar: async (scope) => {
      const file = path.join(__dirname, "../syntaxes", `${scope.replace("source.", "")}.tmLanguage.json`);
      return parseRawGrammar(fs.readFileSync(file, "utf8"), file);
    },
  });
  const load = async (scope) => [scope, await registry.loadGrammar(scope)];
  return Object.fromEntries(await Promise.all([AGENT, CONFIGURATION, SYSTEM].map(load)));
}

const loaded = grammars();

/** The tokens of a text: what is written, its innermost scope and its line. */
async function tokens(scope, text) {
  const grammar = (await loaded)[scope];
  let state = INITIAL;
  const found = [];
  text.split("\n").forEach((line, index) => {
    const result = grammar.tokenizeLine(line, state);
    state = result.ruleStack;
    for (const { startIndex, endIndex, scopes } of result.tokens) {
      found.push({ text: line.slice(startIndex, endIndex), scope: scopes.at(-1), scopes, line: index + 1 });
    }
  });
  return found;
}

/** Everything but blanks has a scope of its own, and none is invalid. */
async function check(scope, name, text) {
  for (const token of await tokens(scope, text)) {
    const place = `${name}:${token.line}: ${JSON.stringify(token.text)}`;
    assert.ok(token.text.trim() === "" || token.scope !== scope, `${place} has no scope`);
    assert.ok(!token.scopes.some((one) => one.startsWith("invalid")), `${place} is ${token.scope}`);
  }
}

function files(folder, ending) {
  const names = fs.readdirSync(path.join(ROOT, folder)).filter((name) => name.endsWith(ending));
  assert.ok(names.length > 0, `${folder} has no ${ending}`);
  return names.map((name) => [name, fs.readFileSync(path.join(ROOT, folder, name), "utf8")]);
}

/** The examples of a guide in a language. */
function examples(language, of = "agentspeak") {
  const guide = fs.readFileSync(path.join(ROOT, `docs/${of}.md`), "utf8");
  const blocks = [...guide.matchAll(/^```(\w+)\n([^]*?)^```/gm)].filter((block) => block[1] === language);
  assert.ok(blocks.length > 0, language);
  return blocks.map((block, index) => [`${language} ${index + 1} of the guide`, block[2]]);
}

test("every agent is coloured", async () => {
  const agents = [...files("translator/agents", ".asl"), ...files("autopilot/agent", ".asl"), ...examples("agentspeak")];
  for (const [name, text] of agents) {
    await check(AGENT, name, text);
  }
});

test("every configuration is coloured, and recognised", async () => {
  const own = [...files("translator/agents", ".conf"), ...files("autopilot/agent", ".conf")];
  const all = [...own, ...examples("configuration"), ...examples("properties")];
  for (const [name, text] of all) {
    await check(CONFIGURATION, name, text);
  }
  for (const [name, text] of own) {
    assert.ok(isConfiguration(text), name);
  }
  for (const other of ["", "[settings]\ninput = a.asl\n", "server { listen 80; }", "// settings { input = a.asl; }"]) {
    assert.ok(!isConfiguration(other), other);
  }
});

test("every system is coloured", async () => {
  const all = [...files("translator/agents/systems", ".system"), ...examples("system"), ...examples("system", "airlock")];
  for (const [name, text] of all) {
    await check(SYSTEM, name, text);
  }
});

test("names and symbols have the scopes of their meaning", async () => {
  const text = `b(1, "x\\n"). // note
!go.
@l[req("R-1")] +!go(X, _)[source(self)] : .my_name(M) & b(X, Y)[age(A)] & not (X mod 2 \\== 1.5e3) | true
  <- act(X); +b(-Y, f(3)); -b(_, _); !!go(1, 2); ?b(X, Z); Y = X - dim(1); .wait(500); .broadcast(tell, c); !go(X, Z)[deadline(9)].`;
  const scopes = new Map();
  for (const token of await tokens(AGENT, text)) {
    scopes.set(token.text, [...(scopes.get(token.text) ?? []), token.scope.replace(".agentspeak", "")]);
  }
  const expected = {
    "// note": ["comment.line.double-slash"],
    "\\n": ["constant.character.escape"],
    l: ["entity.name.label"],
    req: ["keyword.other.annotation"],
    deadline: ["keyword.other.annotation"],
    source: ["keyword.other.annotation"],
    age: ["keyword.other.annotation"],
    ".wait": ["keyword.control.internal"],
    ".my_name": ["keyword.control.internal"],
    ".broadcast": ["keyword.control.internal"],
    "<-": ["keyword.operator.arrow"],
    not: ["keyword.operator.word"],
    mod: ["keyword.operator.word"],
    true: ["constant.language.boolean"],
    "1.5e3": ["constant.numeric"],
    _: Array(3).fill("variable.language.unnamed"),
    go: Array(4).fill("entity.name.function.goal"),
    act: ["entity.name.function.call"],
    dim: ["entity.name.function.call"],
    Z: Array(2).fill("variable.parameter"),
  };
  for (const [name, list] of Object.entries(expected)) {
    assert.deepEqual(scopes.get(name), list, name);
  }
  assert.equal(scopes.get("b").filter((scope) => scope === "variable.other.belief").length, 3);
});

test("a configuration's names have their scopes", async () => {
  const [, text] = files("translator/agents", "rover.conf")[0];
  const found = await tokens(CONFIGURATION, text);
  const scope = (name) => found.find((token) => token.text === name)?.scope.replace(".agentspeak-configuration", "");
  assert.equal(scope("settings"), "keyword.other.section");
  assert.equal(scope("input"), "support.type.property-name");
  assert.equal(scope("rover.asl"), "string.unquoted");
  assert.equal(scope("#include"), "keyword.control.include");
  assert.equal(scope("int32_t"), "storage.type");
  assert.equal(scope("halt"), "entity.name.function");
  assert.equal(scope("+!"), "keyword.operator.trigger");
  assert.equal(scope("exactly_one"), "keyword.control.formula");
});

test("peers and messages have their scopes", async () => {
  const text = "peers { leader, scout }; messages { tell at(double) from any; achieve go(peer) from leader, 4; };";
  const found = await tokens(CONFIGURATION, text);
  const scope = (name) => found.find((token) => token.text === name)?.scope.replace(".agentspeak-configuration", "");
  assert.equal(scope("peers"), "keyword.other.section");
  assert.equal(scope("messages"), "keyword.other.section");
  for (const word of ["tell", "achieve", "from"]) {
    assert.equal(scope(word), "keyword.control.formula", word);
  }
  assert.equal(scope("at"), "entity.name.function");
  assert.equal(scope("4"), "constant.numeric");
  const property = await tokens(CONFIGURATION, "properties { p: within(2, +!go[source(scout)], act); };");
  const annotation = property.find((token) => token.text === "source");
  assert.equal(annotation.scope, "keyword.other.annotation.agentspeak-configuration");
});

test("the names of a system have their scopes", async () => {
  const text = `agents { first: ../two words.conf; /* note */ second: a.conf; };
channels { capacity = 2; losses = any; };
properties { p [R-1]: within(3, first.+!go, second.hover); };`;
  const found = await tokens(SYSTEM, text);
  const scopes = (name) =>
    found.filter((token) => token.text === name).map((token) => token.scope.replace(".agentspeak-system", ""));
  const expected = {
    agents: ["keyword.other.section"],
    first: Array(2).fill("variable.other.agent"),
    "../two words.conf": ["string.unquoted"],
    capacity: ["support.type.property-name"],
    2: ["constant.numeric"],
    any: ["constant.language.any"],
    p: ["entity.name.type.property"],
    "[R-1]": ["string.unquoted.requirement"],
    within: ["keyword.control.formula"],
    "+!": ["keyword.operator.trigger"],
    go: ["entity.name.function"],
    hover: ["entity.name.function"],
  };
  for (const [name, list] of Object.entries(expected)) {
    assert.deepEqual(scopes(name), list, name);
  }
});

test("what is no AgentSpeak is marked", async () => {
  for (const [scope, text] of [
    [AGENT, "+!go <- ~on."],
    [AGENT, '+!go <- say("\\q").'],
    [AGENT, "{"],
    [CONFIGURATION, "settings { colour = red; };"],
    [CONFIGURATION, "sections { };"],
    [CONFIGURATION, "triggerables { ?go; };"],
    [SYSTEM, "settings { };"],
    [SYSTEM, "channels { size = 2; };"],
    [SYSTEM, "properties { p: within(1, a.?go, b.x); };"],
  ]) {
    const found = await tokens(scope, text);
    assert.ok(found.some((token) => token.scope.startsWith("invalid")), text);
  }
});
