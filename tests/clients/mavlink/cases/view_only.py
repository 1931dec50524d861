"""With --mavlink-view-only everything can be seen and nothing be ordered."""

import time

import flying
import plans
from cases.telemetry import parameters
from flying import ARM, NAN
from station import Silence

ORDERS = (
    (ARM, 1), (ARM, 0, flying.CUT_MAGIC), (22, 0), (21, 0), (20, 0), (24, 0), (176, 1, 4, 3), (192, -1), (193, 0),
    (193, 1), (300, 0), (185, 1), (224, 0), (246, 1), (189, 0), (262, 8),
)  # fmt: skip


def test_everything_can_be_seen(station):
    station.hear(2)
    for kind in ("ATTITUDE", "LOCAL_POSITION_NED", "GLOBAL_POSITION_INT", "SYS_STATUS", "EXTENDED_SYS_STATE"):
        assert kind in station.latest, kind
    assert station.request(148)[1] is not None and parameters(station)


def test_every_order_is_refused(station):
    for order in ORDERS:
        assert station.command(*order) not in (0, 5), f"{order} was accepted"
        assert station.command_int(order[0], 3, *order[1:]) not in (0, 5), f"{order} was accepted as COMMAND_INT"
    x, y = flying.to_1e7(0.5, 0)
    assert station.command_int(192, 3, -1, 1, 0, NAN, x, y, 1.0) not in (0, 5)
    station.send("SET_MODE", 1, 1, flying.TAKE_OFF)
    for send in (flying.set_point(station, position=(1, 1, -1)), lambda: station.send("MANUAL_CONTROL", 1, 500, 0, 800, 0, 0)):
        for _ in range(10):
            send()
            station.hear(0.05)
    station.hear(1)
    assert flying.on_the_ground(station) and not flying.armed(station) and flying.mode(station) == flying.HOLD


def test_no_mission_and_no_parameter_is_taken(station):
    try:
        assert plans.upload(station, plans.square()) != 0, "a mission was taken"
    except Silence as silence:
        raise AssertionError(f"the upload was not answered: {silence}") from None
    assert plans.download(station) == []
    for name, one in parameters(station).items():
        asked_s = time.monotonic()
        station.send("PARAM_SET", 1, 1, name.encode(), one.param_value + 0.1, 9)
        kept = station.wait("PARAM_VALUE", 0.5, lambda told: told.param_id == name, asked_s)
        assert kept.param_value == one.param_value, kept
