#!/usr/bin/env bash
# Installs the Debian package in a clean Debian 12, uses it there without a network, removes it, and says what was seen.
# Usage, as root: try.sh ROOT PACKAGE.deb
# ROOT is a folder that does not exist yet, or one from an earlier try. It needs mmdebstrap and util-linux.
set -euo pipefail

root=${1:?where to install Debian}
package=$(realpath "${2:?the package}")
lists=$(mktemp -d)
trap 'rm -rf "$lists"' EXIT

say() { echo "== $1 ($SECONDS s)"; }
# As a machine of its own: its own processes, and a network that has the loopback interface only.
inside() {
    unshare --net --pid --fork --mount sh -c \
        'ip link set lo up && mount -t proc proc "$0/proc" && exec chroot "$0" "$@"' "$root" "$@"
}
files() {
    find "$root" -xdev -path "$root/proc" -prune -o -path "$root/var/cache" -prune -o -path "$root/var/lib/apt" -prune -o \
        -path "$root/var/log" -prune -o -path "$root/tmp" -prune -o -printf '/%P %y %m\n' | sort
}

if [ ! -e "$root" ]; then
    say "Debian 12"
    # With what a desktop has that is not in every Debian: pages, completion, menus, icons.
    mmdebstrap --quiet --include=man-db,bash-completion,libcap2-bin,desktop-file-utils,hicolor-icon-theme bookworm "$root"
fi
# A container's rule against documentation would hide that it is missing.
rm -f "$root"/etc/dpkg/dpkg.cfg.d/*docker*

files >"$lists/before"
say "install"
cp "$package" "$root/tmp/package.deb"
inside dpkg --install /tmp/package.deb
inside getcap /usr/bin/ardrone-pilot | grep -x '/usr/bin/ardrone-pilot cap_sys_nice=ep'

say "install where the permission cannot be given, or not be used"
again() { inside "$@" /var/lib/dpkg/info/ardrone-pilot.postinst configure; }
inside sh -c 'mkdir /tmp/none && ln -s /bin/false /tmp/none/setcap'
again env PATH=/tmp/none:/usr/sbin:/usr/bin:/sbin:/bin
again setpriv --bounding-set -sys_nice
test -z "$(inside getcap /usr/bin/ardrone-pilot)"
inside setpriv --bounding-set -sys_nice ardrone-pilot --version
again env

say "programs"
for program in ardrone-pilot mock-drone asl2c; do inside "$program" --version; done
examples=/usr/share/doc/ardrone-pilot/examples
inside ardrone-pilot check "$examples/plans/square.txt"
inside ardrone-pilot check "$examples/fleets/five.toml" >/dev/null
inside ardrone-pilot config --config "$examples/pilot.toml" >/dev/null
inside sh -c "cp -r $examples/agents /tmp/agents && cd /tmp/agents && asl2c -q lift.conf && ls lift.c"

say "a flight with the simulated drone, as an ordinary user"
inside useradd --create-home pilot
inside su pilot -c "cd && ardrone-pilot --plan $examples/plans/square.txt --mock --plain" >"$lists/flight" 2>&1
tail -8 "$lists/flight"
grep -q 'plan flown to its end' "$lists/flight"
grep '^real-time priority' "$lists/flight"
inside su pilot -c 'cd && ls flights && ardrone-pilot report flights/*.mcap && ardrone-pilot replay flights/*.mcap' | tail -3

say "pages"
for page in ardrone-pilot mock-drone asl2c ardrone-pilot-selftest asl2c-verify mock-drone-man; do
    inside env MANWIDTH=100 man "$page" >"$lists/page" 2>"$lists/complaints"
    test -s "$lists/page"
    test ! -s "$lists/complaints"
    sed -n '/^NAME/,+1p' "$lists/page"
done
inside man --whatis ardrone-pilot mock-drone asl2c

say "completions"
inside bash -c '
    . /usr/share/bash-completion/bash_completion
    for program in ardrone-pilot mock-drone asl2c; do
        _completion_loader "$program" || test $? = 124
        complete -p "$program"
    done'
for file in zsh/vendor-completions/_{ardrone-pilot,mock-drone,asl2c} \
    fish/vendor_completions.d/{ardrone-pilot,mock-drone,asl2c}.fish; do
    test -s "$root/usr/share/$file"
done

say "desktop"
inside sh -c 'desktop-file-validate /usr/share/applications/ardrone-pilot*.desktop'

say "remove"
inside userdel --remove pilot 2>/dev/null
rm -rf "$root/tmp/agents" "$root/tmp/none" "$root/tmp/package.deb"
inside dpkg --purge ardrone-pilot
files >"$lists/after"
# What the user's account and package management itself have changed are not the package's.
left=$(diff "$lists/before" "$lists/after" | grep '^[<>]' |
    grep -v ' /etc/\(passwd\|shadow\|group\|gshadow\|subuid\|subgid\)-\? \| /var/lib/dpkg/' || true)
if [ -n "$left" ]; then
    echo "$left"
    say "something is left, or gone"
    exit 1
fi
say "nothing is left"
