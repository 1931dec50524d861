"""MAVProxy flies from its prompt: arm, take-off, guided, mission, land. A second station looks on.

usage: mavproxy_flight.py PORT SECOND_PORT
"""

import math
import os
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

import flying
from flying import HOLD, MISSION
from station import Station

MODULES = "arm,mode,wp,cmdlong,misc,param,signing"
# The plan of the documentation, home first as MAVProxy saves it, and where it leads.
PLAN = Path(__file__).resolve().parents[3] / "docs/mavlink/square.waypoints"
SQUARE = ((1.0, 0.0, 1.0), (1.0, 1.0, 1.2), (0.0, 1.0, 1.0))


class MavProxy:
    """mavproxy.py with its prompt on a pipe, and what it prints."""

    def __init__(self, port, folder):
        program = Path(sys.executable).with_name("mavproxy.py")
        self.printed = []
        self.process = subprocess.Popen(
            [sys.executable, program, f"--master=udpin:127.0.0.1:{port}", f"--state-basedir={folder}", f"--default-modules={MODULES}"],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, cwd=folder,
            env={**os.environ, "HOME": folder},
        )  # fmt: skip
        threading.Thread(target=self.read, daemon=True).start()

    def read(self):
        self.printed.extend(self.process.stdout)

    def type(self, line):
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()

    def prints(self, text, since=0):
        return any(text.lower() in line.lower() for line in self.printed[since:])

    def close(self):
        self.process.kill()
        self.process.wait()


def flies_by_hand(proxy, station):
    proxy.type("arm throttle")
    flying.wait_armed(station, within_s=3)
    proxy.type("takeoff 1")
    flying.wait_hover(station)
    latitude, longitude = flying.to_degrees(1.0, 0.5)
    proxy.type(f"guided {latitude:.7f} {longitude:.7f} 1.2")
    flying.wait_arrival(station, 1.0, 0.5, 1.2)
    # No mode names: MAVProxy knows ArduCopter's for such a vehicle, so this is off-board, and refused.
    proxy.type("rtl")
    station.hear(1.5)
    assert flying.mode(station) == HOLD, "MAVProxy's rtl, the number of off-board, was taken"
    proxy.type("land")
    flying.wait_landed(station)


def flies_a_mission(proxy, station):
    flying.wait_ready(station)
    proxy.type(f"wp load {PLAN}")
    station.wait_until(lambda: proxy.prints("loaded"), 8, "MAVProxy loads the file")
    uploaded = len(proxy.printed)
    station.hear(3)
    proxy.type("wp list")
    station.wait_until(lambda: proxy.prints("saved", uploaded) or proxy.prints("sent all", uploaded), 10, "MAVProxy reads it back")
    began_s = time.monotonic()
    proxy.type("arm throttle")
    flying.wait_armed(station, within_s=3)
    proxy.type(f"mode {MISSION}")
    flying.wait_mode(station, MISSION, 12, began_s)
    worst_m = passes_all_corners(station)
    flying.wait_landed(station, 30)
    return worst_m


def passes_all_corners(station):
    """How far from a corner it is at most when it is closest."""
    closest = [math.inf] * len(SQUARE)

    def passed():
        local = station.latest["LOCAL_POSITION_NED"]
        for at, corner in enumerate(SQUARE):
            closest[at] = min(closest[at], math.dist((local.x, local.y, -local.z), corner))
        return max(closest) < 0.3

    station.wait_until(passed, 50, f"all corners passed ({[round(one, 2) for one in closest]})")
    return max(closest)


def main():
    port, second_port = (int(one) for one in sys.argv[1:3])
    station = Station(second_port, system=250)
    with tempfile.TemporaryDirectory() as folder:
        proxy = MavProxy(port, folder)
        try:
            flying.wait_ready(station)
            station.wait_until(lambda: proxy.prints("online system"), 15, "MAVProxy hears the vehicle")
            flies_by_hand(proxy, station)
            worst_m = flies_a_mission(proxy, station)
        except Exception as error:
            print("".join(proxy.printed[-25:]))
            print(f"MAVProxy: {type(error).__name__}: {error}")
            return 1
        finally:
            proxy.close()
            station.close()
    print(f"MAVProxy: armed, took off, went there, flew a mission within {worst_m:.2f} m, landed twice")
    return 0


if __name__ == "__main__":
    sys.exit(main())
