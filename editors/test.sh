#!/usr/bin/env bash
# Builds the extension of VS Code, and tests it and its grammars.
set -euo pipefail
cd "$(dirname "$0")/vscode"

for tool in node npm; do
    if ! command -v "$tool" >/dev/null; then
        echo "there is no $tool here: install Node.js 20 or later (apt-get install nodejs npm)" >&2
        exit 3
    fi
done
npm ci --no-audit --no-fund
npm test
npm run package
