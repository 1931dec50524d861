#!/usr/bin/env bash
# Clients that others wrote fly the mock drone over MAVLink: MAVSDK-Python and MAVProxy from PyPI, unmodified, and pymavlink tries
# the corners. Where they can't be had, that is said and nothing is tested; in CI that is a failure. All run at the same time.
set -uo pipefail
pilot=$(realpath "${1:?usage: run.sh PATH-OF-ARDRONE-PILOT [CLIENT..]}")
[ -x "$pilot" ] || { echo "there is no $pilot"; exit 1; }
shift
only=" $* "
cd "$(dirname "$0")"
work=$(mktemp -d)
pilots=()
trap 'for one in "${pilots[@]}"; do kill "$one" 2>/dev/null; done; rm -rf "$work"' EXIT
[ -z "${KEEP:-}" ] || mkdir -p "$KEEP"
export PYTHONDONTWRITEBYTECODE=1
python=$work/python/bin/python

if ! { command -v python3 >/dev/null && python3 -m venv "$work/python" &&
    "$work/python/bin/pip" install --no-deps -r requirements.txt; } >"$work/pip.log" 2>&1; then
    echo "skipped: python3 or its registry is not there"
    tail -n 3 "$work/pip.log"
    [ -z "${CI:-}" ]
    exit
fi

# All at once, so that no two are the same, and none that the system gives to the programs meanwhile.
mapfile -t ports < <("$python" - <<'PYTHON'
import random, socket
found = 0
for port in random.sample(range(20_000, 32_000), 200):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
        try:
            one.bind(("127.0.0.1", port))
        except OSError:
            continue
    print(port)
    found += 1
    if found == 64:
        break
PYTHON
)

# flies NAME OPTIONS-OF-THE-PROGRAM CLIENT..: in the background, with a program of its own; FIRST and SECOND become its two ports.
names=() clients=()
flies() {
    local name=$1 options=$2 first=${ports[0]} second=${ports[1]}
    shift 2
    ports=("${ports[@]:2}")
    [ "$only" = "  " ] || [[ $only == *" $name "* ]] || return
    mkfifo "$work/$name.in"
    # Opened for reading and writing it never ends: the end of its input would end the program.
    # shellcheck disable=SC2086
    "$pilot" --mock --no-log --plain --mavlink "udp:127.0.0.1:$first,udp:127.0.0.1:$second" $options \
        <>"$work/$name.in" >"$work/$name.pilot" 2>&1 &
    pilots+=($!)
    local client=("${@//FIRST/$first}")
    timeout 350 "$python" "${client[@]//SECOND/$second}" >"$work/$name.log" 2>&1 &
    clients+=($!)
    names+=("$name")
}

corners() {
    flies "$1" "$2" corners.py "${3:-$1}" FIRST SECOND
}

printf 'a drone for the tests\n' >"$work/key"
chmod 600 "$work/key"
flies mavsdk "--mavlink-pretend-gps" mavsdk_flight.py udpin://127.0.0.1:FIRST
flies mavproxy "" mavproxy_flight.py FIRST SECOND
flies hop_mavsdk "" ../../../docs/mavlink/hop_mavsdk.py udpin://127.0.0.1:FIRST
flies hop_pymavlink "" ../../../docs/mavlink/hop_pymavlink.py udpin:127.0.0.1:FIRST
corners telemetry "" telemetry,cut
corners commands ""
corners missions ""
corners offboard ""
corners frames ""
corners silence ""
corners stations "" stations,terminate
corners noise ""
corners view_only "--mavlink-view-only"
corners px4 "--mavlink-as px4"
corners qgroundcontrol "--mavlink-as px4" qgroundcontrol,cut
corners lossy ""
corners signing "--mavlink-key $work/key"

passed=0 failed=0
for at in "${!names[@]}"; do
    name=${names[at]}
    wait "${clients[at]}"
    status=$?
    alive=yes
    kill -0 "${pilots[at]}" 2>/dev/null || alive=no
    kill "${pilots[at]}" 2>/dev/null
    if [ "$status" -eq 0 ] && [ "$alive" = yes ]; then
        echo "client $name ... ok: $(tail -n 1 "$work/$name.log")"
        passed=$((passed + 1))
    else
        echo "client $name ... FAILED (exit status $status, program still running: $alive)"
        grep -v ' ... ok (' "$work/$name.log" | tail -n 60
        tail -n 12 "$work/$name.pilot"
        failed=$((failed + 1))
    fi
    [ -z "${KEEP:-}" ] || cp "$work/$name.log" "$work/$name.pilot" "$KEEP"
done
# MESSAGES is what `cargo xtask mavlink --table` prints.
skipped=0
if [ "$only" != "  " ]; then
    :
elif [ -z "${MESSAGES:-}" ]; then
    echo "skipped: comparing CRC_EXTRA with pymavlink's, without MESSAGES"
    skipped=1
elif "$python" crc_extra.py "$MESSAGES" >"$work/crc_extra.log" 2>&1; then
    echo "client crc_extra ... ok: $(tail -n 1 "$work/crc_extra.log")"
    passed=$((passed + 1))
else
    echo "client crc_extra ... FAILED"
    tail -n 20 "$work/crc_extra.log"
    failed=$((failed + 1))
fi
echo "MAVLink clients: $passed passed, $failed failed, $skipped skipped"
[ "$failed" -eq 0 ] && [ "$passed" -gt 0 ] && { [ "$skipped" -eq 0 ] || [ -z "${CI:-}" ]; }
