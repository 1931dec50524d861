// Which files are configurations of agents: `.conf` alone says nothing, because many programs use it.

"use strict";

/** Whether a text looks like the configuration of an agent: a section `settings` that names an AgentSpeak file. */
function isConfiguration(text) {
  const plain = text.replace(/\/\*[^]*?\*\/|\/\/.*/g, " ");
  return /(^|[\s;}])settings\s*\{[^}]*\binput\s*=\s*"?[^;"\n}]*\.asl\b/.test(plain);
}

module.exports = { isConfiguration };
