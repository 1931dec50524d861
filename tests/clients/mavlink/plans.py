"""Both sides of the mission protocol, as a ground station has them: items, upload, download."""

import math
import time
from dataclasses import dataclass, field

from flying import NAN, to_1e7

MISSION = 0
ACCEPTED, UNSUPPORTED_FRAME, UNSUPPORTED, NO_SPACE, DENIED, CANCELLED = 0, 2, 3, 4, 14, 15
WAYPOINT, TAKEOFF, LAND, RETURN, LOITER_TIME, SPEED = 16, 22, 21, 20, 19, 178


@dataclass
class Item:
    command: int
    frame: int
    x: int = 0
    y: int = 0
    z: float = 0.0
    parameters: tuple = (0.0, 0.0, 0.0, NAN)
    current: int = 0
    kind: int = field(default=MISSION)

    def send(self, station, sequence, kind=None):
        station.send(
            "MISSION_ITEM_INT", 1, 1, sequence, self.frame, self.command, self.current, 1,
            *self.parameters, self.x, self.y, self.z, self.kind if kind is None else kind,
        )  # fmt: skip


def takeoff(height=0.85):
    return Item(TAKEOFF, 3, 0, 0, height)


def point(north, east, height, stay_s=0.0):
    """A way-point by latitude and longitude, its height above the floor."""
    x, y = to_1e7(north, east)
    return Item(WAYPOINT, 3, x, y, height, (stay_s, 0.2, 0.0, NAN))


def local(frame, x, y, z):
    return Item(WAYPOINT, frame, round(x * 1e4), round(y * 1e4), z, (0.0, 0.2, 0.0, NAN))


def land():
    return Item(LAND, 3, 0, 0, 0.0)


def square(side=1.0, height=1.0):
    corners = ((side, 0), (side, side), (0, side), (0, 0))
    return [takeoff(), *(point(north, east, height) for north, east in corners), land()]


def asked_for(station, within_s=1.5, since_s=None):
    """The next request or the final acknowledgement of an upload."""
    since_s = time.monotonic() if since_s is None else since_s
    found = []

    def something():
        found[:] = station.since(since_s, "MISSION_REQUEST_INT", "MISSION_REQUEST", "MISSION_ACK")
        return bool(found)

    station.wait_until(something, within_s, "the vehicle asks for an item or acknowledges")
    return found[0]


def count(station, number, kind=MISSION):
    station.send("MISSION_COUNT", 1, 1, number, kind)


def upload(station, items, answer=None, kind=MISSION):
    """Uploads; `answer(sequence)` may send something else than the item. The type of the acknowledgement."""
    answer = answer or (lambda sequence: items[sequence].send(station, sequence))
    asked_s = time.monotonic()
    count(station, len(items), kind)
    until_s = asked_s + 12
    while time.monotonic() < until_s:
        message = asked_for(station, 3, asked_s)
        if message.get_type() == "MISSION_ACK":
            # Of an item of another type, the acknowledgement is of that type.
            assert message.type != 0 or message.mission_type == kind, message
            return message.type
        asked_s = message.heard_s + 1e-9
        answer(message.seq)
    raise AssertionError("the upload took more than 12 s")


def download(station, kind=MISSION, request="MISSION_REQUEST_INT"):
    """What the vehicle has: the items as messages."""
    asked_s = time.monotonic()
    station.send("MISSION_REQUEST_LIST", 1, 1, kind)
    number = station.wait("MISSION_COUNT", 1, lambda told: told.mission_type == kind, asked_s).count
    items = []
    for sequence in range(number):
        asked_s = time.monotonic()
        station.send(request, 1, 1, sequence, kind)
        items.append(station.wait("MISSION_ITEM_INT", 1, lambda item: item.seq == sequence, asked_s))
    station.send("MISSION_ACK", 1, 1, 0, kind)
    return items


def same(sent, read):
    def equal(one, other):
        return one == other or (math.isnan(one) and math.isnan(other)) or abs(one - other) < 1e-6 * max(1, abs(one))

    read_parameters = (read.param1, read.param2, read.param3, read.param4)
    return (
        (sent.command, sent.frame, sent.x, sent.y) == (read.command, read.frame, read.x, read.y)
        and equal(sent.z, read.z)
        and all(equal(*pair) for pair in zip(sent.parameters, read_parameters))
    )


def check_kept(station, items):
    """The vehicle has exactly these items."""
    read = download(station)
    assert len(read) == len(items), f"{len(read)} items are there, not {len(items)}"
    for sequence, (sent, got) in enumerate(zip(items, read)):
        assert same(sent, got), f"item {sequence} reads back as {got}, sent was {sent}"


def check_uploads(station, items):
    result = upload(station, items)
    assert result == ACCEPTED, f"the upload ended with {result}; {station.texts()[-3:]}"
