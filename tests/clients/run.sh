#!/usr/bin/env bash
# Clients that others wrote fly the mock drone and read its video, unmodified: node-ar-drone and ardrone-autonomy from
# npm, pyardrone from PyPI, and ffmpeg decodes. Where they can't be had, that is said and nothing is tested; in CI that is a failure.
set -uo pipefail
# With the example `beside` of the system tests, node-ar-drone flies a drone in one air with two of ours, too: last, so that it may
# still be built meanwhile.
mock=$(realpath "${1:?usage: run.sh PATH-OF-MOCK-DRONE [PATH-OF-BESIDE]}")
beside=${2:+$(realpath --no-symlinks "$2")}
[ -x "$mock" ] || { echo "there is no $mock"; exit 1; }
cd "$(dirname "$0")"
work=$(mktemp -d)
trap 'kill "${drone:-}" 2>/dev/null; rm -rf "$work"' EXIT
passed=0 failed=0 skipped=0

ends_well() {
    local name=$1
    shift
    if timeout 70 "$@" >"$work/client.log" 2>&1; then
        echo "client $name ... ok: $(tail -n 1 "$work/client.log")"
        passed=$((passed + 1))
    else
        echo "client $name ... FAILED"
        tail -n 20 "$work/client.log" "$work/mock.log"
        failed=$((failed + 1))
    fi
}

# Clients use the drone's own ports, so one flies after the other.
flies() {
    local name=$1 options=$2
    shift 2
    # shellcheck disable=SC2086
    "$mock" $options 2>"$work/mock.log" &
    drone=$!
    sleep 0.5
    ends_well "$name" "$@"
    kill "$drone"
    wait "$drone" 2>/dev/null
}

cp fly_node.js fly_beside.js fly_mission.js fly_hover.js read_video.js read_png.js "$work"
if command -v npm >/dev/null && (cd "$work" && npm install --no-audit --no-fund ar-drone@0.3.3 ardrone-autonomy@0.1.2) >"$work/npm.log" 2>&1; then
    flies "node-ar-drone, demo navdata" "" node "$work/fly_node.js" demo
    flies "node-ar-drone, full navdata" "" node "$work/fly_node.js" full
    flies "node-ar-drone, full navdata with GPS" "--option-27 gps" node "$work/fly_node.js" full
    flies "ardrone-autonomy, a mission" "" node "$work/fly_mission.js"
    flies "ardrone-autonomy, a hover above a tag" "--tag 0,0,0" node "$work/fly_hover.js"
    flies "node-ar-drone, video" "" node "$work/read_video.js" "$work/film.h264"
    if command -v ffmpeg >/dev/null && command -v ffprobe >/dev/null; then
        flies "node-ar-drone and ffmpeg, video" "" ./decode_video.sh "$work"
        flies "node-ar-drone and ffmpeg, video as PNG" "" node "$work/read_png.js"
    else
        echo "skipped: ffmpeg is not there"
        skipped=$((skipped + 2))
    fi
else
    echo "skipped: npm or its registry is not there"
    skipped=$((skipped + 8))
fi
if command -v python3 >/dev/null && python3 -m venv "$work/python" >"$work/pip.log" 2>&1 &&
    "$work/python/bin/pip" install pyardrone==0.6.1 >>"$work/pip.log" 2>&1; then
    flies "pyardrone, demo navdata" "" "$work/python/bin/python" fly_pyardrone.py demo
    flies "pyardrone, full navdata" "" "$work/python/bin/python" fly_pyardrone.py full
    flies "pyardrone, full navdata with option 27" "--option-27 zimmu" "$work/python/bin/python" fly_pyardrone.py full
else
    echo "skipped: python3 or its registry is not there"
    skipped=$((skipped + 3))
fi
if [ -n "$beside" ] && [ -d "$work/node_modules/ar-drone" ]; then
    for ((waited = 0; waited < 1200; waited++)); do
        [ -x "$beside" ] && break
        sleep 1
    done
    : >"$work/mock.log"
    ends_well "node-ar-drone, beside two of ours" "$beside" told node "$work/fly_beside.js"
fi
echo "clients: $passed passed, $failed failed, $skipped skipped"
[ "$failed" -eq 0 ] && { [ "$skipped" -eq 0 ] || [ -z "${CI:-}" ]; }
