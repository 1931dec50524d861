"""With --mavlink-key: only who knows the pass-phrase is heard; a copy of an old frame is not."""

import hashlib
import time

import flying
from flying import ARM, UNSUPPORTED, expect
from station import Silence

PASS_PHRASE = "a drone for the tests"
KEY = hashlib.sha256(PASS_PHRASE.encode()).digest()


def answered(station, number, datagram=None):
    """Whether this command, or this datagram with it, is answered."""
    sent_s = time.monotonic()
    station.send_bytes(datagram or station.pack("COMMAND_LONG", 1, 1, number, 0, 0, 0, 0, 0, 0, 0, 0))
    try:
        station.wait("COMMAND_ACK", 0.7, lambda ack: ack.command == number, sent_s)
    except Silence:
        return False
    return True


def test_signed_is_heard_and_telemetry_is_signed(station):
    expect(station.command(65_000), UNSUPPORTED)
    beat = station.wait("HEARTBEAT", 2)
    assert beat.get_signed(), "the vehicle's own messages are not signed with this key"
    flying.wait_ready(station)
    flying.arm(station)
    station.command(ARM, 0)


def test_unsigned_is_not_heard(station):
    station.codec.signing.sign_outgoing = False
    try:
        assert not answered(station, 64_101)
        station.send("COMMAND_LONG", 1, 1, ARM, 0, 1, 0, 0, 0, 0, 0, 0)
        station.hear(1.5)
        assert not flying.armed(station)
    finally:
        station.codec.signing.sign_outgoing = True
    assert answered(station, 64_102)


def test_another_key_is_not_heard(station):
    station.codec.signing.secret_key = hashlib.sha256(b"another").digest()
    try:
        frame = station.pack("COMMAND_LONG", 1, 1, 64_103, 0, 0, 0, 0, 0, 0, 0, 0)
    finally:
        station.codec.signing.secret_key = KEY
    assert not answered(station, 64_103, frame)


def test_a_repeated_frame_is_not_heard_again(station):
    frame = station.pack("COMMAND_LONG", 1, 1, 64_104, 0, 0, 0, 0, 0, 0, 0, 0)
    assert answered(station, 64_104, frame)
    assert not answered(station, 64_104, frame), "a copy was answered"


def test_an_old_time_is_not_heard(station):
    signing = station.codec.signing
    now = signing.timestamp
    signing.timestamp -= 10 * 60 * 100_000
    signing.link_id = 9
    try:
        assert not answered(station, 64_105), "a frame ten minutes old, on a new link, was answered"
    finally:
        signing.timestamp, signing.link_id = now, 7
    assert answered(station, 64_106)
