#!/usr/bin/env bash
# Builds the Debian package of the three programs. Prints its path.
# Needs Rust, a C compiler, dpkg-dev, python3 and cargo-deb (`cargo install cargo-deb --locked`).
# It runs on the Debian it is built on, and later ones.
set -euo pipefail
cd "$(dirname "$0")/.."

CARGO_TARGET_DIR=$(realpath --no-symlinks "${CARGO_TARGET_DIR:-target}")
export CARGO_TARGET_DIR
programs=(ardrone-pilot mock-drone asl2c)
release=$CARGO_TARGET_DIR/release
made=$release/packaging

cargo build --release --locked --package ardrone-pilot --package asl2c --package mock-drone --features mock-drone/cli

rm -rf "$made"
mkdir -p "$made"/{man,bash,zsh,fish}
for program in "${programs[@]}"; do
    "$release/$program" man >"$made/man/$program.1"
    "$release/$program" completions bash >"$made/bash/$program"
    "$release/$program" completions zsh >"$made/zsh/_$program"
    "$release/$program" completions fish >"$made/fish/$program.fish"
done
for program in "${programs[@]}"; do
    # The pages of its commands, as its own page names them: `PROGRAM-COMMAND(1)`, with hyphens escaped.
    for command in $(tr -d '\\' <"$made/man/$program.1" | sed -n "s/^$program-\(.*\)(1)$/\1/p"); do
        "$release/$program" man "$command" >"$made/man/$program-$command.1"
    done
done

gzip -9n "$made"/man/*
packaging/licences.py "${programs[@]}" | gzip -9n >"$made/licences-of-libraries.gz"

# Debian's form of a changelog; the product's own has more.
version=$(sed -n '/^\[workspace.package\]/,/^$/ s/^version = "\(.*\)"$/\1/p' Cargo.toml)
maintainer=$(sed -n 's/^maintainer = "\(.*\)"$/\1/p' ardrone-pilot/Cargo.toml)
if [ -n "${DEBFULLNAME:-}" ] && [ -n "${DEBEMAIL:-}" ]; then
    maintainer="$DEBFULLNAME <$DEBEMAIL>"
fi
# The same sources make the same package.
SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct)}
export SOURCE_DATE_EPOCH
cat >"$made/changelog" <<END
ardrone-pilot ($version-1) unstable; urgency=medium

  * Version $version.

 -- $maintainer  $(LC_ALL=C date -u -R -d "@$SOURCE_DATE_EPOCH")
END

# It has been built above, with features that cargo-deb would not choose.
cargo deb --package ardrone-pilot --no-build --strip --locked --offline --maintainer "$maintainer"
