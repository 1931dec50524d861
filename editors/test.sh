#!/usr/bin/env bash
# Builds the extension of VS Code, and tests it and its grammars. Where Vim is, its file types and colours are tested.
set -euo pipefail
cd "$(dirname "$0")"

# Opens a file of each kind: its file type, and the group of the first word that is matched.
see() {
    vim -es -N -u NONE --cmd "set runtimepath^=$PWD/vim" -c 'filetype plugin on' -c 'syntax on' -c "edit $1" \
        -c "call search('$3')" \
        -c "if &filetype != '$2' || synIDattr(synID(line('.'), col('.'), 1), 'name') != '$4' | cquit | endif" \
        -c 'qall!' || { echo "Vim: $1 is no $2, or \`$3\` is no $4" >&2; exit 1; }
}
if command -v vim >/dev/null && vim --version | grep -q +syntax; then
    agents=../translator/agents
    see "$agents/rover.asl" agentspeak '!wait' agentspeakOperator
    see "$agents/rover.conf" agentspeakconf 'settings' agentspeakconfSection
    system="$agents/systems/relief.system"
    see "$system" agentspeaksystem 'agents {' agentspeaksystemSection
    see "$system" agentspeaksystem 'first:' agentspeaksystemName
    see "$system" agentspeaksystem 'relief.conf' agentspeaksystemFile
    see "$system" agentspeaksystem 'capacity' agentspeaksystemSetting
    see "$system" agentspeaksystem 'one_flies' agentspeaksystemName
    see "$system" agentspeaksystem 'never_together' agentspeaksystemFormula
    see "$system" agentspeaksystem 'flyToPlace' agentspeaksystemAction
    see "$agents/systems/corridor.system" agentspeaksystem 'any;' agentspeaksystemAny
fi

cd vscode

for tool in node npm; do
    if ! command -v "$tool" >/dev/null; then
        echo "there is no $tool here: install Node.js 20 or later (apt-get install nodejs npm)" >&2
        exit 3
    fi
done
npm ci --no-audit --no-fund
npm test
npm run package
