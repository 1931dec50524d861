"""Two stations, one vehicle: who has the controls, and what the other one may do."""

import time

import flying
import plans
from flying import ARM, HOLD, LAND, NAV_LAND, NAV_TAKEOFF, TEMPORARILY_REJECTED, expect, expect_accepted
from station import Station


class Two:
    """A second station beside the first, which is heard while the second one acts."""

    def __init__(self, first):
        self.first = first
        self.second = Station(first.second_port, system=250, component=191)
        flying.wait_ready(self.second)

    def __enter__(self):
        self.second.repeat["first"] = (1.0, self.first.beat)
        self.first.repeat["second"] = (1.0, self.second.beat)
        return self.second

    def __exit__(self, *_):
        self.first.repeat.pop("second", None)
        self.second.close()


def test_the_second_station_hears_but_does_not_steer(station):
    flying.wait_ready(station)
    with Two(station) as second:
        second.hear(1)
        assert second.latest["ATTITUDE"] and second.latest["LOCAL_POSITION_NED"]
        flying.arm(station)
        expect(second.command(NAV_TAKEOFF), TEMPORARILY_REJECTED, what="take-off by the second station")
        expect(second.command(ARM, 1), TEMPORARILY_REJECTED, what="arming by the second station")
        expect_accepted(station.command(NAV_TAKEOFF), "take-off by the first")
        flying.wait_hover(station)
        x, y = flying.to_1e7(1, 1)
        second.hear(0.2)
        expect(second.command_int(192, 3, -1, 1, 0, 0, x, y, 1.0), TEMPORARILY_REJECTED, what="go-to by the second station")
        expect(flying.set_mode(second, flying.BY_HAND), TEMPORARILY_REJECTED, what="mode of the second station")
        assert plans.upload(second, plans.square()) != 0, "a mission of the second station was taken"
        second.command(512, 148)
        expect_accepted(second.command(193, 0), "hold by the second station")
        expect_accepted(second.command(NAV_LAND), "land by the second station")
        flying.wait_mode(station, LAND, 1.5)
        flying.wait_landed(station)


def test_after_the_first_disarmed_the_second_may_fly(station):
    flying.wait_ready(station)
    flying.arm(station)
    expect_accepted(station.command(ARM, 0), "disarm")
    with Two(station) as second:
        flying.arm(second)
        expect(station.command(ARM, 1), TEMPORARILY_REJECTED, what="arming by the first station")
        expect_accepted(second.command(ARM, 0), "disarm by the second")


def test_a_station_that_fell_silent_loses_the_controls(station):
    flying.take_off(station)
    with Two(station) as second:
        second.repeat.clear()
        station.beats = False
        second.hear(6.5)
        expect_accepted(flying.set_mode(second, HOLD), "hold")
        x, y = flying.to_1e7(0.5, 0)
        result = second.command_int(192, 3, -1, 1, 0, float("nan"), x, y, 1.0)
        expect_accepted(result, "go-to after the first station was silent for 6 s")
        station.beats = True
        second.hear(0.3)
        expect_accepted(second.command(NAV_LAND), "land")
        flying.wait_landed(second)


def test_set_points_of_the_second_station_are_not_followed(station):
    flying.take_off(station)
    with Two(station) as second:
        before = flying.place(station)
        second.repeat["setpoints"] = (0.05, flying.set_point(second, position=(2, 2, -2)))
        second.hear(2)
        assert flying.set_mode(second, flying.OFFBOARD) not in (0, 5)
        after = flying.place(second)
        assert max(abs(late - early) for early, late in zip(before, after)) < 0.3, (before, after)
    started_s = time.monotonic()
    flying.land(station)
    assert time.monotonic() - started_s < 20
