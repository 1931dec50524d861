"""MAV_CMD_DO_FLIGHTTERMINATION cuts too; anything but a clear yes does not."""

import math

import flying
from flying import NAN, expect_accepted

TERMINATE = 185


def test_termination_cuts_the_motors(station):
    flying.take_off(station)
    for parameter in (0, NAN, -1, 0.5):
        station.command(TERMINATE, parameter)
    station.hear(1)
    assert flying.armed(station) and flying.place(station)[2] > 0.5, "it was cut by no clear yes"
    expect_accepted(station.command(TERMINATE, 1), "termination")
    station.wait_until(lambda: flying.place(station)[2] < 0.25, 3, "the drone falls")
    assert math.isfinite(flying.place(station)[0])
