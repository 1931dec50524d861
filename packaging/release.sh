#!/usr/bin/env bash
# The check list of a release. It stops at the first thing that is not so, and changes nothing: at its end it prints the
# command that tags the release.
# Usage, as root: packaging/release.sh
# Needs what .ci/run and debian.sh need, lintian, mmdebstrap, and cargo-semver-checks
# (`cargo install cargo-deb cargo-semver-checks --locked`).
set -euo pipefail
cd "$(dirname "$0")/.."

step() { echo "== $1 ($SECONDS s)"; }
fail() {
    echo "not a release: $1" >&2
    exit 1
}

step "nothing is uncommitted"
[ -z "$(git status --porcelain)" ] || fail "git status shows changes"

step "one version"
version=$(sed -n '/^\[workspace.package\]/,/^$/ s/^version = "\(.*\)"$/\1/p' Cargo.toml)
# The crates are made to fit each other, whatever their numbers promise.
others=$(sed -n 's/^[a-z0-9-]* = { path = ".*", version = "=\{0,1\}\([^"]*\)".*/\1/p' Cargo.toml | grep -vxF "$version" || true)
[ -z "$others" ] || fail "crates of the workspace depend on $others, not on $version"
grep -qx "version = \"$version\"" fuzz/Cargo.toml || fail "fuzz/Cargo.toml has another version than $version"
grep -qxE "## ${version//./\\.} \([0-9]{4}-[0-9]{2}-[0-9]{2}\)" CHANGELOG.md ||
    fail "CHANGELOG.md has no line \`## $version (DATE)\`"
if git rev-parse --quiet --verify "refs/tags/v$version" >/dev/null; then
    fail "v$version is tagged already"
fi

step "each crate builds from its package alone"
# The tests and xtask are of use in the workspace only.
ours=(--workspace --exclude system-tests --exclude xtask)
cargo package "${ours[@]}" --locked

step "no library breaks what it promised"
if last=$(git describe --tags --abbrev=0 --match 'v*' 2>/dev/null); then
    cargo semver-checks "${ours[@]}" --baseline-rev "$last"
else
    echo "no earlier release to compare with"
fi

step "everything that must hold"
.ci/run

step "Debian package"
package=$(packaging/debian.sh | tail -1)
# The one tag is about uploads to Debian itself.
lintian --allow-root --fail-on error,warning --suppress-tags initial-upload-closes-no-bugs "$package"
root=$(mktemp -d --dry-run)
packaging/try.sh "$root" "$package"
rm -rf --one-file-system "$root"
ls -l "$package"

step "all is well; to release it:"
echo "git tag --annotate v$version --message 'ardrone-pilot $version'"
