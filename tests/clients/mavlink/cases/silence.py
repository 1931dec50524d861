"""The ground station disappears while the drone flies a mission: told at 3 s, hold at 10 s, land at 20 s; and it comes back in between."""

import time

import flying
import plans
from cases.missions import start_mission, wait_reached
from flying import HOLD, LAND, near

STAYS = 60.0


def in_a_mission(station):
    flying.wait_ready(station)
    plans.check_uploads(station, [plans.takeoff(), plans.point(0.5, 0, 1.0), plans.point(1.0, 0.5, 1.0, STAYS), plans.land()])
    flying.arm(station)
    began_s = time.monotonic()
    start_mission(station)
    wait_reached(station, 1, began_s)


def test_a_lost_station_in_a_mission_is_told_held_and_landed(station):
    in_a_mission(station)
    station.beat()
    station.beats = False
    silent_s = time.monotonic()
    told = station.wait("STATUSTEXT", 5, since_s=silent_s)
    near(told.heard_s - silent_s, 3, 0.8, "the time until it is told")
    held = flying.wait_mode(station, HOLD, 12, silent_s)
    near(held.heard_s - silent_s, 10, 1.2, "the time until it holds")
    landing = flying.wait_mode(station, LAND, 15, silent_s)
    near(landing.heard_s - silent_s, 20, 1.2, "the time until it lands")
    flying.wait_landed(station, 25)


def test_a_station_that_comes_back_does_not_resume_by_itself(station):
    in_a_mission(station)
    station.beat()
    station.beats = False
    flying.wait_mode(station, HOLD, 13)
    station.beats = True
    station.hear(13)
    assert flying.mode(station) == HOLD and not flying.on_the_ground(station), "it did not stay in hold"
    flying.land(station)
