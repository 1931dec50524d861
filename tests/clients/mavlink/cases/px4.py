"""With --mavlink-as px4: what QGroundControl wants of a PX4, and the orders of its buttons in its order."""

import math
import time

import flying
import plans
from cases.telemetry import parameters
from flying import ARM, HOLD, LAND, MISSION, NAN, NAV_TAKEOFF, ORIGIN, expect_accepted

SETUP_PAGES = ("SYS_AUTOSTART", "COM_RC_IN_MODE", "CAL_GYRO0_ID", "CAL_ACC0_ID", "SYS_HAS_MAG", "MIS_TAKEOFF_ALT")


def test_it_looks_like_a_recent_px4(station):
    assert station.wait("HEARTBEAT", 2).autopilot == 12
    version = station.request(148)[1]
    major, minor = version.flight_sw_version >> 24, version.flight_sw_version >> 16 & 0xFF
    assert (major, minor) >= (1, 4), f"{major}.{minor}"
    missing = [name for name in SETUP_PAGES if name not in parameters(station)]
    assert not missing, f"parameters that QGroundControl asks for are missing: {missing}"


def test_the_buttons_take_off_go_pause_and_land(station):
    flying.wait_ready(station)
    expect_accepted(station.command(NAV_TAKEOFF, -1, 0, 0, NAN, NAN, NAN, ORIGIN[2] + 3.048), "take-off to 10 feet")
    expect_accepted(station.command(ARM, 1, 0), "arm")
    flying.wait_hover(station)
    assert flying.place(station)[2] < 3.3
    x, y = flying.to_1e7(1.0, 0.5)
    expect_accepted(station.command_int(192, 0, -1, 1, 0, NAN, x, y, ORIGIN[2] + 1.5), "go-to")
    station.hear(1)
    expect_accepted(station.command(192, -1, 1, 0, NAN, NAN, NAN, NAN), "pause")
    flying.wait_mode(station, HOLD, 1)
    # It brakes, and comes back to where it was when it was told to.
    station.hear(3)
    before = flying.place(station)
    station.hear(1.5)
    assert math.dist(before, flying.place(station)) < 0.3, "it goes on after the pause"
    expect_accepted(station.command_int(192, 0, -1, 1, 0, NAN, x, y, ORIGIN[2] + 1.5), "go-to again")
    flying.wait_arrival(station, 1.0, 0.5, 1.5)
    asked_s = time.monotonic()
    station.send("SET_MODE", 1, 1 | 128, LAND)
    flying.wait_mode(station, LAND, 1, asked_s)
    flying.wait_landed(station)


def test_the_slider_starts_a_mission(station):
    """Mode first, then arming."""
    flying.wait_ready(station)
    plans.check_uploads(station, [plans.takeoff(3.048), plans.point(0.5, 0.5, 1.5), plans.land()])
    station.send("SET_MODE", 1, 1, MISSION)
    station.hear(0.3)
    expect_accepted(station.command(ARM, 1, 0), "arm")
    flying.wait_mode(station, MISSION, 12)
    flying.wait_landed(station, 40)
