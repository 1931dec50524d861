# Sourced by the scripts beside it, with `set -euo pipefail`: how a program of Debian 13 is made to run on an older system. It is
# unpacked with its own C library, and comes from where the system's own packages come from.

# cannot PROGRAM WHY: says why the program can't be had, and ends the script with status 3.
cannot() {
    echo "$1 cannot be had: $2" >&2
    exit 3
}

# from_debian NAME FOLDER PROGRAM PRELOADED PACKAGE...: makes FOLDER/PROGRAM, with the library PRELOADED before all others
# unless that is empty. Messages call it NAME.
from_debian() {
    local name=$1 folder=$2 program=$3 preloaded=$4 suite=trixie tool package source file root preload=
    shift 4
    if command -v "$program" >/dev/null; then
        mkdir -p "$folder"
        ln -sf "$(command -v "$program")" "$folder/$program"
        return
    fi
    if [ -x "$folder/$program" ]; then
        return
    fi
    for tool in curl xz dpkg-deb; do
        command -v "$tool" >/dev/null || cannot "$name" "there is no $tool"
    done
    [ "$(dpkg --print-architecture)" = amd64 ] || cannot "$name" "only amd64 is known"
    source=$({ cat /etc/apt/sources.list /etc/apt/sources.list.d/* 2>/dev/null || true; } |
        awk '/^URIs:/ { print $2; exit } /^deb / { for (i = 2; i <= NF; i++) if ($i ~ /^http/) { print $i; exit } }')
    [ -n "$source" ] || cannot "$name" "apt names no source"
    mkdir -p "$folder/root"
    curl -fsS --retry 3 "$source/dists/$suite/main/binary-amd64/Packages.xz" | xz -dc >"$folder/packages" ||
        cannot "$name" "its package list is not there"
    for package in "$@"; do
        file=$(awk -v package="$package" '$0 == "Package: " package { found = 1 }
            found && /^Filename:/ { print $2; exit }' "$folder/packages")
        [ -n "$file" ] || cannot "$name" "there is no package $package"
        curl -fsS --retry 3 "$source/$file" -o "$folder/package.deb" || cannot "$name" "$package is not there"
        dpkg-deb -x "$folder/package.deb" "$folder/root"
    done
    root=$(realpath "$folder/root")
    if [ -n "$preloaded" ]; then
        preload="--preload \"$root/$preloaded\""
    fi
    cat >"$folder/$program.new" <<END
#!/bin/sh
exec "$root/usr/lib64/ld-linux-x86-64.so.2" $preload \\
    --library-path "$root/usr/lib/x86_64-linux-gnu:$root/usr/lib" "$root/usr/bin/$program" "\$@"
END
    chmod +x "$folder/$program.new"
    "$folder/$program.new" --version >/dev/null || cannot "$name" "it does not run here"
    mv "$folder/$program.new" "$folder/$program"
    rm -f "$folder/package.deb" "$folder/packages"
}
