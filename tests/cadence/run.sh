#!/usr/bin/env bash
# How regular AT datagrams are: ours with and without real-time priority, and node-ar-drone's, with an
# idle machine and with all cores busy, while the drone sends 200 packets of navdata a second.
# Ours records the flight meanwhile; `watched` is ours with its screen on a terminal of its own and its page in a
# headless Chromium on the same machine. The times are those of the kernel as it sends (tcpdump on the loopback device). Needs root.
set -euo pipefail
usage="usage: run.sh FOLDER-OF-PROGRAMS [SECONDS [CLIENTS [LOADS]]], e.g. run.sh target/release 60 'fifo plain watched node' 'idle busy'"
programs=$(realpath "${1:?$usage}")
seconds=${2:-60}
clients=${3:-fifo plain node}
loads=${4:-idle busy}
cd "$(dirname "$0")"
command -v tcpdump >/dev/null || { echo "tcpdump is needed"; exit 1; }
work=$(mktemp -d)
chmod 755 "$work"
mkdir -m 777 "$work/logs"
trap 'kill $(jobs -p) 2>/dev/null || true; rm -rf "$work"' EXIT
printf 'takeoff\nsetStayTime %s\ngoto 0 1 0 0\nland\n' "$seconds" >"$work/plan.txt"
printf '[drone]\nnavdata = "full"\n' >"$work/pilot.toml"
cp fly_node.js "$work"
if [[ $clients == *node* ]]; then
    (cd "$work" && npm install --no-audit --no-fund --silent ar-drone@0.3.3)
fi

pilot() {
    "$@" "$programs/ardrone-pilot" --log "$work/logs/$(date +%s%N).mcap" --plan "$work/plan.txt" --config "$work/pilot.toml" \
        --drone 127.0.0.1 --plain --timing >"$work/out.txt" 2>"$work/err.txt" || true
}

watched() {
    (sleep 1 && exec chromium --headless --no-sandbox --disable-gpu --no-first-run --remote-debugging-port=0 \
        --disable-background-networking --user-data-dir="$work/chromium" http://127.0.0.1:8097/) \
        >/dev/null 2>&1 &
    local page=$!
    script -qec "$programs/ardrone-pilot --log $work/logs/$(date +%s%N).mcap --plan $work/plan.txt \
        --config $work/pilot.toml --drone 127.0.0.1 --ui 8097 --timing" "$work/out.txt" >/dev/null || true
    kill "$page" && wait "$page" || true
}

fly() {
    case $1 in
    fifo) pilot ;;
    watched) watched ;;
    plain) pilot setpriv --reuid=65534 --clear-groups --inh-caps=-all --bounding-set=-all ;;
    node) (cd "$work" && node fly_node.js "$seconds") >/dev/null 2>&1 || true ;;
    esac
}

# Periods of one client's datagrams, from the tenth on.
summary() {
    tcpdump -r "$work/at.pcap" -tt -n 2>/dev/null |
        awk 'NR > 10 { printf "%.3f\n", ($1 - last) * 1000 } { last = $1 }' | sort -n |
        awk -v name="$1" -v load="$2" '
            { period[NR] = $1; over35 += $1 > 35; over50 += $1 > 50; near += $1 < 5 }
            END {
                printf "%-6s %-5s %6d %8.2f %8.2f %8.2f %8.2f %6d %6d %6d\n", name, load, NR,
                    period[1], period[int((NR + 1) / 2)], period[int(NR * 0.99 + 0.5)], period[NR],
                    over35, over50, near
            }'
}

printf '%-6s %-5s %6s %8s %8s %8s %8s %6s %6s %6s\n' \
    client load count min median p99 max '>35ms' '>50ms' '<5ms'
for load in $loads; do
    for client in $clients; do
        burners=()
        if [ "$load" = busy ]; then
            for _ in $(seq "$(nproc)"); do
                sh -c 'while :; do :; done' &
                burners+=($!)
            done
        fi
        "$programs/mock-drone" 2>"$work/mock.txt" &
        mock=$!
        tcpdump -i lo -U -w "$work/at.pcap" --time-stamp-precision=micro udp dst port 5556 \
            2>/dev/null &
        sniffer=$!
        sleep 1
        fly "$client"
        kill "$sniffer" "$mock" "${burners[@]}" 2>/dev/null || true
        wait "$sniffer" "$mock" "${burners[@]}" 2>/dev/null || true
        summary "$client" "$load"
        [ "$client" = node ] || cp "$work/out.txt" "${TMPDIR:-/tmp}/cadence-$client-$load.txt"
    done
done
