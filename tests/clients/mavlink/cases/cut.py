"""The motors are cut by the magic number only. No test can follow: the vehicle does not fly until a person recovers it."""

import time

import flying
from flying import ARM, CUT_MAGIC, NAV_TAKEOFF, READY_BIT, expect_accepted


def test_the_magic_number_cuts_the_motors_in_flight(station):
    flying.take_off(station)
    asked_s = time.monotonic()
    expect_accepted(station.command(ARM, 0, CUT_MAGIC), "the cut")
    station.wait_until(lambda: station.wait("LOCAL_POSITION_NED", 1).z > -0.25, 3, "the drone falls")
    fell_s = time.monotonic() - asked_s
    assert fell_s < 2.5, f"it took {fell_s:.1f} s to fall"
    flying.wait_armed(station, False, 5, asked_s)
    beat = station.wait("HEARTBEAT", 2)
    assert beat.system_status in (5, 6), f"system_status {beat.system_status} after the cut"
    # QGroundControl shows "Ready To Fly" by this bit, and the reason by a text that begins so.
    ready = [told for told in station.since(asked_s + 0.3, "SYS_STATUS") if told.onboard_control_sensors_health & READY_BIT]
    assert not ready, "ready to fly while it falls"
    station.wait("STATUSTEXT", 8, lambda told: told.text.startswith("PreArm: "), asked_s)


def test_after_a_cut_nothing_starts(station):
    assert not flying.ready(station)
    assert station.command(ARM, 1) not in (0, 5), "it was armed after a cut"
    station.command(NAV_TAKEOFF)
    station.hear(2)
    assert flying.on_the_ground(station) and not flying.armed(station)
