"""A hundred thousand datagrams that are no MAVLink, or nearly, on the port of a flying drone."""

import math
import random
import time

import flying
from flying import HOLD, UNSUPPORTED, expect
from station import mavlink, message_class

RANDOM = 100_000
EACH_BURST, PAUSE_S = 50, 0.012
# Not sent with any content: a key that is set by chance ends every later test.
NEVER = {mavlink.MAVLINK_MSG_ID_SETUP_SIGNING}


def garbage(chance):
    start = chance.choice((b"", b"\xfd", b"\xfe", b"\xfd\xff", b"\xfe\x21"))
    return start + chance.randbytes(chance.randrange(1, 300))


def valid_frames(station, chance, number):
    """Frames with right checksums and random content, addressed to another system: well-formed, and nobody's business here."""
    kinds = [kind for identity, kind in mavlink.mavlink_map.items() if identity not in NEVER and identity < 512]
    frames = []
    while len(frames) < number:
        kind = chance.choice(kinds)
        fields = kind.unpacker.unpack(chance.randbytes(kind.unpacker.size))
        values = dict(zip(kind.ordered_fieldnames, regrouped(kind, fields)))
        for name in ("target_system", "target", "target_component"):
            if name in values:
                values[name] = chance.randrange(2, 255)
        try:
            frames.append(station.pack(kind.msgname, **values))
        except Exception:
            # Some random values pymavlink itself does not pack.
            continue
    return frames


def regrouped(kind, fields):
    """The flat list of a struct as one value for each field."""
    values, at = [], 0
    for length, array in zip(kind.lengths, kind.array_lengths):
        if array and not isinstance(fields[at], bytes):
            values.append(list(fields[at : at + length]))
            at += length
        else:
            values.append(fields[at])
            at += 1
    return values


def mutated(frame, chance):
    damaged = bytearray(frame)
    for _ in range(chance.randrange(1, 6)):
        damaged[chance.randrange(len(damaged))] = chance.randrange(256)
    if chance.random() < 0.3:
        del damaged[chance.randrange(len(damaged)) :]
    return bytes(damaged)


def test_a_flight_survives_100_000_datagrams(station):
    chance = random.Random(20_261_122)
    frames = valid_frames(station, chance, 2000)
    flying.take_off(station)
    before = flying.place(station)
    sent, from_s = 0, time.monotonic()
    while sent < RANDOM:
        for _ in range(EACH_BURST):
            which = sent % 3
            frame = chance.choice(frames)
            station.send_bytes(garbage(chance) if which == 0 else mutated(frame, chance) if which == 1 else frame)
            sent += 1
        station.hear(PAUSE_S)
    took_s = time.monotonic() - from_s
    station.hear(1)
    assert flying.mode(station) == HOLD and flying.armed(station), f"mode {flying.mode(station):#x} after {took_s:.0f} s"
    moved = math.dist(before, flying.place(station))
    assert moved < 0.5, f"it moved by {moved:.2f} m"
    expect(station.command(65_000), UNSUPPORTED)
    heard_hz = len(station.since(from_s, "HEARTBEAT")) / took_s
    assert heard_hz > 0.8, f"{heard_hz:.2f} heartbeats a second during it"
    flying.land(station)


def test_a_flood_as_fast_as_possible_leaves_the_drone_alone(station):
    chance = random.Random(7)
    flying.take_off(station)
    before, flood = flying.place(station), [garbage(chance) for _ in range(1000)]
    until_s = time.monotonic() + 3
    while time.monotonic() < until_s:
        for datagram in flood:
            station.socket.sendto(datagram, station.vehicle)
        station.hear(0.005)
    station.hear(1)
    assert math.dist(before, flying.place(station)) < 0.5 and flying.armed(station)
    expect(station.command(65_000), UNSUPPORTED)
    flying.land(station)


def test_heartbeats_of_a_thousand_systems_leave_room_for_the_first(station):
    for number in range(1000):
        station.codec.srcSystem = number % 254 + 1
        packed = message_class("HEARTBEAT")(6, 8, 0, 0, 0, 3).pack(station.codec)
        station.send_bytes(packed)
        if number % 50 == 0:
            station.hear(0.02)
    station.codec.srcSystem = station.system
    station.hear(1)
    expect(station.command(65_000), UNSUPPORTED)
