#!/usr/bin/env bash
# Makes FOLDER/cbmc, a CBMC that runs here. Debian 12 has no package of it; Debian 13's runs when it is
# unpacked with its own C library. It comes from where the system's own packages come from.
# Exits with 3, and says why, where that can't be.
set -euo pipefail
folder=${1:?usage: cbmc.sh FOLDER}
. "$(dirname "$0")/debian.sh"
# CBMC allocates all the time: with another allocator it takes a third less.
from_debian CBMC "$folder" cbmc usr/lib/x86_64-linux-gnu/libjemalloc.so.2 \
    cbmc minisat libc6 libgcc-s1 libstdc++6 zlib1g libjemalloc2
