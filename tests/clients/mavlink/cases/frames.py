"""Flown in all four directions: attitude, local and global position, heights and speeds agree in sign, unit and size; and the joystick."""

import math
import time

import flying
from flying import (
    BY_HAND, HOLD, METRES_PER_DEGREE, ORIGIN, POSITION_AND_YAW, VELOCITY_ONLY, expect_accepted, go_off_board, near,
    place, set_mode, set_point,
)  # fmt: skip

DIRECTIONS = {"north": (0.6, 0.0), "east": (0.0, 0.6), "south": (-0.6, 0.0), "west": (0.0, -0.6)}


def leg(station, velocity, seconds=2.0):
    """Flies so; everything that was heard meanwhile."""
    from_s = time.monotonic()
    station.repeat["setpoints"] = (0.05, set_point(station, mask=VELOCITY_ONLY, velocity=(*velocity, 0)))
    station.hear(seconds)
    return {kind: station.since(from_s, kind) for kind in ("ATTITUDE", "LOCAL_POSITION_NED", "GLOBAL_POSITION_INT", "VFR_HUD")}


def closest(messages, to_ms):
    return min(messages, key=lambda message: abs(message.time_boot_ms - to_ms))


def check_local_against_global(heard):
    for world in heard["GLOBAL_POSITION_INT"]:
        local = closest(heard["LOCAL_POSITION_NED"], world.time_boot_ms)
        if abs(local.time_boot_ms - world.time_boot_ms) > 20:
            continue
        north = (world.lat / 1e7 - ORIGIN[0]) * METRES_PER_DEGREE
        east = (world.lon / 1e7 - ORIGIN[1]) * METRES_PER_DEGREE * math.cos(math.radians(ORIGIN[0]))
        near(north, local.x, 0.06, "north by latitude")
        near(east, local.y, 0.06, "east by longitude")
        near(world.relative_alt / 1000, -local.z, 0.06, "relative altitude")
        near(world.alt / 1000 - ORIGIN[2], -local.z, 0.06, "altitude")
        for what, centimetres, metres in (("north", world.vx, local.vx), ("east", world.vy, local.vy), ("down", world.vz, local.vz)):
            near(centimetres / 100, metres, 0.08, f"speed {what}")


def check_heading(heard):
    for world in heard["GLOBAL_POSITION_INT"]:
        attitude = closest(heard["ATTITUDE"], world.time_boot_ms)
        off = flying.turned_by(math.degrees(attitude.yaw), world.hdg / 100)
        near(off, 0, 4, "heading against yaw")
    for hud in heard["VFR_HUD"]:
        near(flying.turned_by(math.degrees(heard["ATTITUDE"][-1].yaw), hud.heading), 0, 8, "heading of VFR_HUD")


def check_velocity_against_positions(heard):
    """In the second half, when it flies steadily: speed times time is the way."""
    steady = heard["LOCAL_POSITION_NED"][len(heard["LOCAL_POSITION_NED"]) // 2 :]
    first, last = steady[0], steady[-1]
    seconds = (last.time_boot_ms - first.time_boot_ms) / 1000
    for what, way, speeds in (
        ("north", last.x - first.x, [one.vx for one in steady]),
        ("east", last.y - first.y, [one.vy for one in steady]),
    ):
        near(way / seconds, sum(speeds) / len(speeds), 0.12, f"speed {what} by positions")


def check_speed(heard, wanted):
    last = heard["LOCAL_POSITION_NED"][-1]
    near(last.vx, wanted[0], 0.2, "speed north")
    near(last.vy, wanted[1], 0.2, "speed east")
    near(heard["VFR_HUD"][-1].groundspeed, math.hypot(*wanted), 0.25, "ground speed")


def check_tilt(heard, wanted, yaw_deg):
    """While it gains speed it leans there: forward is nose down, to the right is right side down."""
    yaw = math.radians(yaw_deg)
    forward = wanted[0] * math.cos(yaw) + wanted[1] * math.sin(yaw)
    right = -wanted[0] * math.sin(yaw) + wanted[1] * math.cos(yaw)
    start = heard["ATTITUDE"][: max(3, len(heard["ATTITUDE"]) // 2)]
    pitch = max((one.pitch for one in start), key=abs)
    roll = max((one.roll for one in start), key=abs)
    if abs(forward) > 0.3:
        assert pitch * forward < 0 and abs(pitch) > 0.01, f"pitch {math.degrees(pitch):.1f} deg when flying {forward:+.1f} forward"
    if abs(right) > 0.3:
        assert roll * right > 0 and abs(roll) > 0.01, f"roll {math.degrees(roll):.1f} deg when flying {right:+.1f} right"


def test_everything_agrees_in_all_four_directions(station):
    flying.take_off(station)
    for yaw_deg in (0, 90):
        start = set_point(station, mask=POSITION_AND_YAW, position=(0, 0, -1.2), yaw=math.radians(yaw_deg))
        if yaw_deg == 0:
            go_off_board(station, start)
        station.repeat["setpoints"] = (0.05, start)
        station.wait_until(
            lambda: abs(flying.turned_by(math.degrees(station.latest["ATTITUDE"].yaw), yaw_deg)) < 6, 10, f"yaw {yaw_deg}"
        )
        flying.wait_arrival(station, 0, 0, 1.2)
        for name, velocity in DIRECTIONS.items():
            heard = leg(station, velocity)
            try:
                check_local_against_global(heard)
                check_heading(heard)
                check_velocity_against_positions(heard)
                check_speed(heard, velocity)
                check_tilt(heard, velocity, yaw_deg)
            except AssertionError as error:
                raise AssertionError(f"to the {name} with yaw {yaw_deg}: {error}") from None
            leg(station, (0, 0), 1.2)
    flying.land(station)


def stick(station, x=0, y=0, z=500, r=0):
    return lambda: station.send("MANUAL_CONTROL", 1, x, y, z, r, 0)


def steered(station, seconds=1.5, **axes):
    """The drone's way forward, right, up (m) and its turn (deg) under these sticks."""
    station.repeat["stick"] = (0.04, stick(station))
    station.hear(1.2)
    before, yaw = place(station), flying.yaw_deg(station)
    station.repeat["stick"] = (0.04, stick(station, **axes))
    station.hear(seconds)
    north, east, up = (late - early for early, late in zip(before, place(station)))
    cosine, sine = math.cos(math.radians(yaw)), math.sin(math.radians(yaw))
    way = [north * cosine + east * sine, east * cosine - north * sine, up]
    return way, flying.turned_by(yaw, flying.yaw_deg(station))


def by_hand(station):
    station.repeat["stick"] = (0.04, stick(station))
    station.hear(0.3)
    expect_accepted(set_mode(station, BY_HAND), "by hand")
    flying.wait_mode(station, BY_HAND, 1)


def test_the_joystick_steers_in_all_directions(station):
    flying.take_off(station)
    by_hand(station)
    for axes, axis, sign in (
        ({"x": 400}, 0, 1), ({"x": -400}, 0, -1), ({"y": 400}, 1, 1), ({"y": -400}, 1, -1), ({"z": 800}, 2, 1), ({"z": 250}, 2, -1),
    ):  # fmt: skip
        way, _ = steered(station, **axes)
        assert way[axis] * sign > 0.12, f"{axes} moved it by {[round(one, 2) for one in way]}"
        others = [abs(one) for at, one in enumerate(way) if at != axis]
        assert max(others) < abs(way[axis]), f"{axes} moved it by {[round(one, 2) for one in way]}"
    for r, sign in ((500, 1), (-500, -1)):
        _, turned = steered(station, r=r)
        assert turned * sign > 10, f"r={r} turned it by {turned:.0f} deg"
    flying.land(station)


def test_a_silent_joystick_holds(station):
    flying.take_off(station)
    by_hand(station)
    steered(station, 1.0, x=400)
    station.repeat.pop("stick")
    silent_s = time.monotonic()
    held = flying.wait_mode(station, HOLD, 2.5, silent_s)
    near(held.heard_s - silent_s, 0.6, 0.4, "the time until it holds")
    flying.land(station)


def test_a_throttle_that_rests_at_the_bottom_does_not_land_the_drone(station):
    """The height is steered only after the stick was once in the middle."""
    flying.take_off(station)
    height = place(station)[2]
    station.repeat["stick"] = (0.04, stick(station, z=0))
    station.hear(0.3)
    expect_accepted(set_mode(station, BY_HAND), "by hand")
    station.hear(2.5)
    near(place(station)[2], height, 0.3, "the height with the throttle at the bottom")
    station.repeat["stick"] = (0.04, stick(station))
    station.hear(0.5)
    way, _ = steered(station, z=800)
    assert way[2] > 0.12, "after the middle it climbs"
    flying.land(station)


def test_impossible_sticks_do_nothing(station):
    flying.take_off(station)
    by_hand(station)
    station.hear(1)
    before = place(station)
    absent = 32_767
    for axes in ({"x": absent, "y": absent, "z": absent, "r": absent}, {"x": 30_000}, {"y": -32_768}):
        station.repeat["stick"] = (0.04, stick(station, **axes))
        station.hear(0.4)
    station.repeat["stick"] = (0.04, stick(station))
    station.hear(1)
    assert math.dist(before, place(station)) < 1.0 and flying.armed(station)
    flying.land(station)
