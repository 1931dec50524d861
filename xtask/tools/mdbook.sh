#!/usr/bin/env bash
# Makes FOLDER/mdbook, which makes a book of the documentation. Debian 12 has no package of it; Debian 13's runs when it is
# unpacked with its own C library. It comes from where the system's own packages come from.
# Exits with 3, and says why, where that can't be.
set -euo pipefail
folder=${1:?usage: mdbook.sh FOLDER}
. "$(dirname "$0")/debian.sh"
from_debian mdBook "$folder" mdbook "" mdbook libc6 libgcc-s1
