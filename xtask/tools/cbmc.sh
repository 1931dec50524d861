#!/usr/bin/env bash
# Makes FOLDER/cbmc, a CBMC that runs here. Debian 12 has no package of it; Debian 13's runs when it is
# unpacked with its own C library. It comes from where the system's own packages come from.
# Exits with 3, and says why, where that can't be.
set -euo pipefail
folder=${1:?usage: cbmc.sh FOLDER}
suite=trixie
if command -v cbmc >/dev/null; then
    mkdir -p "$folder"
    ln -sf "$(command -v cbmc)" "$folder/cbmc"
    exit 0
fi
[ -x "$folder/cbmc" ] && exit 0
cannot() {
    echo "CBMC cannot be had: $1" >&2
    exit 3
}
for tool in curl xz dpkg-deb; do
    command -v "$tool" >/dev/null || cannot "there is no $tool"
done
[ "$(dpkg --print-architecture)" = amd64 ] || cannot "only amd64 is known"
source=$({ cat /etc/apt/sources.list /etc/apt/sources.list.d/* 2>/dev/null || true; } |
    awk '/^URIs:/ { print $2; exit } /^deb / { for (i = 2; i <= NF; i++) if ($i ~ /^http/) { print $i; exit } }')
[ -n "$source" ] || cannot "apt names no source"
mkdir -p "$folder/root"
curl -fsS --retry 3 "$source/dists/$suite/main/binary-amd64/Packages.xz" | xz -dc >"$folder/packages" ||
    cannot "its package list is not there"
for package in cbmc minisat libc6 libgcc-s1 libstdc++6 zlib1g libjemalloc2; do
    file=$(awk -v package="$package" '$0 == "Package: " package { found = 1 }
        found && /^Filename:/ { print $2; exit }' "$folder/packages")
    [ -n "$file" ] || cannot "there is no package $package"
    curl -fsS --retry 3 "$source/$file" -o "$folder/package.deb" || cannot "$package is not there"
    dpkg-deb -x "$folder/package.deb" "$folder/root"
done
root=$(realpath "$folder/root")
# CBMC allocates all the time: with another allocator it takes a third less.
cat >"$folder/cbmc.new" <<END
#!/bin/sh
exec "$root/usr/lib64/ld-linux-x86-64.so.2" --preload "$root/usr/lib/x86_64-linux-gnu/libjemalloc.so.2" \\
    --library-path "$root/usr/lib/x86_64-linux-gnu:$root/usr/lib" "$root/usr/bin/cbmc" "\$@"
END
chmod +x "$folder/cbmc.new"
"$folder/cbmc.new" --version >/dev/null || cannot "it does not run here"
mv "$folder/cbmc.new" "$folder/cbmc"
rm -f "$folder/package.deb" "$folder/packages"
