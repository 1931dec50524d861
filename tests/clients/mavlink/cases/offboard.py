"""Setpoints: which are followed, and what happens when they stop."""

import math
import time

import flying
from flying import (
    ACCELERATION_ONLY, HOLD, LAND, NAN, OFFBOARD, POSITION_AND_YAW, VELOCITY_AND_TURN, VELOCITY_ONLY, DENIED,
    TEMPORARILY_REJECTED, expect, go_off_board, near, place, set_mode, set_point,
)  # fmt: skip


def test_off_board_needs_a_fresh_stream(station):
    flying.take_off(station)
    expect(set_mode(station, OFFBOARD), DENIED, TEMPORARILY_REJECTED, what="off-board without a stream")
    set_point(station, position=(0, 0, -1))()
    station.hear(1.2)
    expect(set_mode(station, OFFBOARD), DENIED, TEMPORARILY_REJECTED, what="off-board 1.2 s after a setpoint")
    assert flying.mode(station) == HOLD
    flying.land(station)


def test_positions_and_velocities_are_followed_and_nonsense_is_not(station):
    flying.take_off(station)
    north, east, height = place(station)
    go_off_board(station, set_point(station, position=(north, east, -height)))
    flies_to_places(station)
    flies_velocities(station)
    ignores_nonsense(station)
    expect(set_mode(station, HOLD), 0)
    flying.wait_mode(station, HOLD, 1)
    flying.land(station)


def flies_to_places(station):
    for north, east, height in ((1.0, 0.0, 1.0), (0.0, 1.0, 1.3)):
        station.repeat["setpoints"] = (0.05, set_point(station, position=(north, east, -height)))
        flying.wait_arrival(station, north, east, height)
    turned = set_point(station, mask=POSITION_AND_YAW, position=(0.0, 1.0, -1.3), yaw=math.pi / 2)
    station.repeat["setpoints"] = (0.05, turned)
    station.wait_until(lambda: abs(math.degrees(station.latest["ATTITUDE"].yaw) - 90) < 8, 8, "the drone looks east")
    latitude, longitude = flying.to_1e7(0.0, 0.0)

    def globally():
        station.send(
            "SET_POSITION_TARGET_GLOBAL_INT", 0, 1, 1, 6, flying.POSITION_ONLY, latitude, longitude, 1.0,
            NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN,
        )  # fmt: skip

    station.repeat["setpoints"] = (0.05, globally)
    flying.wait_arrival(station, 0.0, 0.0, 1.0)


def moved_in(station, seconds, send):
    """How far north, east and up it gets in this time under this setpoint, after a second to reach its speed."""
    station.repeat["setpoints"] = (0.05, send)
    station.hear(1.2)
    before, from_s = place(station), time.monotonic()
    station.hear(seconds)
    after, took_s = place(station), time.monotonic() - from_s
    return tuple((late - early) / took_s for early, late in zip(before, after))


def flies_velocities(station):
    """The drone looks east: forward is east, right is south."""
    still = set_point(station, mask=VELOCITY_ONLY, velocity=(0, 0, 0))
    for frame, velocity, wanted in (
        (1, (0.4, 0, 0), (0.4, 0, 0)), (1, (0, -0.4, 0), (0, -0.4, 0)),
        (8, (0.4, 0, 0), (0, 0.4, 0)), (12, (0, 0.4, 0), (-0.4, 0, 0)), (8, (0, 0, -0.2), (0, 0, 0.2)),
        (8, (0, 0, 0.2), (0, 0, -0.2)),
    ):  # fmt: skip
        moved = moved_in(station, 1.5, set_point(station, frame, VELOCITY_ONLY, velocity=velocity))
        for axis, got, should_be in zip(("north", "east", "up"), moved, wanted):
            near(got, should_be, 0.15, f"speed {axis} in frame {frame} under {velocity}")
        moved_in(station, 0.3, still)
    before = flying.yaw_deg(station)
    station.repeat["setpoints"] = (0.05, set_point(station, 8, VELOCITY_AND_TURN, velocity=(0, 0, 0), turn=math.radians(30)))
    station.hear(2)
    turned = flying.turned_by(before, flying.yaw_deg(station))
    near(turned, 60, 25, "the turn to the right in 2 s")


def ignores_nonsense(station):
    """None of these moves the drone or is an error that ends the flight; the fence holds."""
    station.repeat["setpoints"] = (0.05, set_point(station, mask=VELOCITY_ONLY, velocity=(0, 0, 0)))
    station.hear(1.5)
    before, from_s = place(station), time.monotonic()
    for send in (
        set_point(station, position=(NAN, NAN, NAN)),
        set_point(station, position=(math.inf, 0, -1)),
        set_point(station, mask=VELOCITY_ONLY, velocity=(NAN, 0, 0)),
        set_point(station, mask=VELOCITY_ONLY, velocity=(math.inf, math.inf, -math.inf)),
        set_point(station, mask=ACCELERATION_ONLY),
        set_point(station, frame=77, position=(1, 1, -1)),
        set_point(station, mask=0xFFFF, position=(1, 1, -1)),
    ):
        for _ in range(4):
            send()
            station.hear(0.05)
    assert math.dist(before, place(station)) < 0.35, f"{before} became {place(station)}"
    assert station.texts(from_s), "no text says what is wrong with the setpoints"


def test_an_off_board_set_point_beyond_the_fence_is_not_followed_there(station):
    flying.take_off(station)
    go_off_board(station, set_point(station, position=(0, 0, -30)))
    station.hear(6)
    height = place(station)[2]
    assert height < 3.3, f"{height:.2f} m high"
    flying.land(station)


def test_silent_set_points_hold_and_then_land(station):
    flying.take_off(station)
    go_off_board(station, set_point(station, frame=8, mask=VELOCITY_ONLY, velocity=(0.3, 0, 0)))
    station.hear(1)
    station.repeat.pop("setpoints")
    silent_s = time.monotonic()
    held = flying.wait_mode(station, HOLD, 2.5, silent_s)
    near(held.heard_s - silent_s, 0.6, 0.4, "the time until it holds")
    station.hear(0.5)
    assert station.texts(silent_s), "no text tells it"
    landing = flying.wait_mode(station, LAND, 13, silent_s)
    near(landing.heard_s - silent_s, 10.6, 0.9, "the time until it lands")
    flying.wait_landed(station)


def test_a_stream_that_comes_back_does_not_steer_by_itself(station):
    flying.take_off(station)
    send = set_point(station, mask=VELOCITY_ONLY, velocity=(0.3, 0, 0))
    go_off_board(station, send)
    station.repeat.pop("setpoints")
    flying.wait_mode(station, HOLD, 2.5)
    station.repeat["setpoints"] = (0.05, send)
    station.hear(2.5)
    assert flying.mode(station) == HOLD
    expect(set_mode(station, OFFBOARD), 0, what="off-board again")
    flying.wait_mode(station, OFFBOARD, 1)
    flying.land(station)
