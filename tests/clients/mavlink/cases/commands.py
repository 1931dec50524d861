"""Commands: answered always and soon, whatever is in them; arming, take-off, going somewhere, returning, landing."""

import math
import time

import flying
from flying import (
    ARM, CUT_MAGIC, DENIED, HOLD, LAND, NAN, NAV_LAND, NAV_TAKEOFF, ORIGIN, RETURN, TEMPORARILY_REJECTED,
    UNSUPPORTED, expect, expect_accepted, near, place, set_mode,
)  # fmt: skip
from station import Silence, mavlink

REPOSITION, RETURN_TO_LAUNCH = 192, 20
LARGEST = 2**31 - 1
# Not those that take off (22, 24) or cut (185): infinity may be as good as yes.
KNOWN = (16, 20, 21, 23, 176, 179, 189, 192, 193, 224, 246, 262, 300, 400, 401, 410, 510, 511, 512, 519, 520)


def test_an_unknown_command_is_unsupported(station):
    expect(station.command(65_000), UNSUPPORTED)
    expect(station.command_int(65_000, 0), UNSUPPORTED)
    expect(station.command(31_000), UNSUPPORTED)


def test_every_command_is_answered_whatever_is_in_it(station):
    for nonsense in (NAN, math.inf, -math.inf, 1e38, -1.0):
        for number in KNOWN:
            station.command(number, *[nonsense] * 7)
            station.command_int(number, 0, *[nonsense] * 4, LARGEST, LARGEST, nonsense)
            station.command_int(number, 77, *[nonsense] * 4, -(2**31), -(2**31), nonsense)
    assert flying.on_the_ground(station) and not flying.armed(station)


def test_not_a_number_does_not_arm(station):
    assert station.command(ARM, NAN) not in (0, 5)
    assert station.command(ARM, 0.5) not in (0, 5)
    assert station.command(ARM, 7) not in (0, 5)
    assert not flying.armed(station)


def not_answered(station, number, **how):
    try:
        station.command(number, 148, within_s=0.8, **how)
    except Silence:
        return True
    return False


def test_commands_for_others_are_ignored(station):
    assert not_answered(station, 512, target=(2, 1)), "a command for system 2 was answered"
    assert not_answered(station, 512, target=(254, 0)), "a command for system 254 was answered"
    assert not_answered(station, 512, target=(1, 154)), "a command for the gimbal was answered"
    for target in ((1, 0), (0, 0), (0, 1)):
        expect_accepted(station.command(512, 148, target=target), f"for {target}")


def command_frame(station, number):
    return station.pack("COMMAND_LONG", 1, 1, number, 0, 0, 0, 0, 0, 0, 0, 0)


def answered(station, since_s, number, within_s=0.5):
    try:
        station.wait("COMMAND_ACK", within_s, lambda ack: ack.command == number, since_s)
    except Silence:
        return False
    return True


def test_a_frame_with_a_wrong_checksum_is_ignored(station):
    sent_s = time.monotonic()
    frame = bytearray(command_frame(station, 64_001))
    frame[-1] ^= 0x55
    station.send_bytes(bytes(frame))
    assert not answered(station, sent_s, 64_001)
    # The next one in the same datagram is read all the same.
    station.send_bytes(bytes(frame) + command_frame(station, 64_002))
    assert answered(station, sent_s, 64_002)


def test_a_cut_frame_is_ignored(station):
    whole = command_frame(station, 64_003)
    sent_s = time.monotonic()
    for length in range(len(whole)):
        station.send_bytes(whole[:length])
    station.send_bytes(b"")
    assert not answered(station, sent_s, 64_003)
    # Halves in two datagrams are no frame either: a datagram has whole frames.
    station.send_bytes(command_frame(station, 64_004))
    assert answered(station, sent_s, 64_004)


def test_several_frames_in_a_datagram_are_all_read(station):
    sent_s = time.monotonic()
    numbers = range(64_010, 64_020)
    station.send_bytes(b"".join(command_frame(station, number) for number in numbers))
    heard = [number for number in numbers if answered(station, sent_s, number)]
    assert len(heard) == 10, heard


def test_a_frame_behind_garbage_is_read(station):
    sent_s = time.monotonic()
    for number, before in ((64_030, b"garbage"), (64_031, b"\xfd"), (64_032, b"\xfe\xff\xfd\x00"), (64_033, b"\xfd" * 9)):
        station.send_bytes(before + command_frame(station, number))
        assert answered(station, sent_s, number), f"not behind {before}"


def test_mavlink_1_is_understood_and_answered_in_2(station):
    expect(station.command(65_001, version1=True), UNSUPPORTED)
    assert station.latest["COMMAND_ACK"].get_msgbuf()[0] == 0xFD
    expect_accepted(station.command(512, 148, version1=True))


def test_arming_is_in_the_heartbeat_within_a_second(station):
    flying.wait_ready(station)
    flying.arm(station)
    assert station.latest["HEARTBEAT"].custom_mode == HOLD and flying.on_the_ground(station)
    expect_accepted(station.command(ARM, 1, NAN), "arming what is armed")
    asked_s = time.monotonic()
    expect_accepted(station.command(ARM, 0), "disarm")
    flying.wait_armed(station, False, since_s=asked_s)
    expect_accepted(station.command(ARM, 0), "disarming what is disarmed")


def test_armed_without_a_take_off_it_disarms_after_10_s(station):
    flying.wait_ready(station)
    flying.arm(station)
    armed_s = time.monotonic()
    beat = flying.wait_armed(station, False, 12, armed_s)
    near(beat.heard_s - armed_s, 10, 1.2, "the time armed")


def test_forced_arming_is_refused(station):
    for magic in (2989, 21196):
        expect(station.command(ARM, 1, magic), DENIED, what=f"arming with {magic}")
        assert not flying.armed(station)


def test_the_magic_number_on_the_ground_only_disarms(station):
    flying.wait_ready(station)
    flying.arm(station)
    expect_accepted(station.command(ARM, 0, CUT_MAGIC), "forced disarm on the ground")
    flying.wait_armed(station, False, 1)
    flying.wait_ready(station, 10)


def test_a_pending_take_off_expires_after_5_s(station):
    flying.wait_ready(station)
    expect_accepted(station.command(NAV_TAKEOFF), "take-off, disarmed")
    station.hear(6)
    flying.arm(station)
    station.hear(3)
    assert flying.on_the_ground(station), "it took off 6 s after the order"
    station.command(ARM, 0)


def test_a_disarm_drops_a_pending_take_off(station):
    flying.wait_ready(station)
    expect_accepted(station.command(NAV_TAKEOFF), "take-off, disarmed")
    station.command(ARM, 0)
    flying.arm(station)
    station.hear(2)
    assert flying.on_the_ground(station), "it took off"
    station.command(ARM, 0)


def test_modes_that_do_not_exist_are_refused(station):
    flying.wait_ready(station)
    # PX4 AUTO without a sub-mode, ACRO, ArduCopter's LAND, off-board without a stream, and no number at all.
    for main, sub in ((4, 0), (5, 0), (9, 0), (6, 0), (4, 99), (0, 0), (NAN, 3), (4, NAN), (-4, 3), (1e20, 0)):
        result = station.command(flying.SET_MODE, 1, main, sub)
        assert result not in (0, 5), f"mode {main}/{sub} was accepted"
    station.send("SET_MODE", 1, 1, 9)
    station.hear(0.5)
    assert flying.mode(station) == HOLD


def test_take_off_goto_return_and_again(station):
    """Take-off before arming; DO_REPOSITION in each frame; modes three ways; RTL; and a second flight."""
    flying.wait_ready(station)
    expect_accepted(station.command(NAV_TAKEOFF, -1, 0, 0, NAN, NAN, NAN, NAN), "take-off, disarmed")
    flying.arm(station)
    flying.wait_mode(station, flying.TAKE_OFF, 3)
    flying.wait_hover(station)
    goes_there_in_each_frame(station)
    asks_impossible_things(station)
    changes_modes_three_ways(station)
    expect_accepted(station.command(RETURN_TO_LAUNCH), "return")
    flying.wait_mode(station, RETURN, 1)
    flying.wait_landed(station, 30)
    north, east, _ = place(station)
    assert math.hypot(north, east) < 0.4, f"it landed at {north:.2f} {east:.2f}"
    flying.take_off(station)
    asked_s = time.monotonic()
    expect_accepted(station.command(189), "DO_LAND_START, MAVProxy's way to land")
    flying.wait_mode(station, LAND, 1, asked_s)
    flying.wait_landed(station)


def goes_there_in_each_frame(station):
    north, east, _ = place(station)
    for frame, (north, east, height), altitude in (
        (3, (1.0, 0.0, 1.2), 1.2), (6, (1.0, 1.0, 1.2), 1.2), (0, (0.0, 1.0, 1.0), 489.0), (5, (0.5, 0.5, 1.0), NAN),
    ):  # fmt: skip
        x, y = flying.to_1e7(north, east)
        expect_accepted(station.command_int(REPOSITION, frame, -1, 1, 0, NAN, x, y, altitude), f"go-to in frame {frame}")
        flying.wait_arrival(station, north, east, height)
    expect_accepted(station.command_int(REPOSITION, 3, -1, 1, 0, math.pi / 2, LARGEST, LARGEST, NAN), "turn east")
    station.wait_until(
        lambda: abs(flying.turned_by(math.degrees(station.latest["ATTITUDE"].yaw), 90)) < 8, 8, "the drone looks east"
    )


def asks_impossible_things(station):
    """Each is refused, and the drone stays where it is."""
    before = place(station)
    far = flying.to_1e7(40, 0)
    expect(station.command_int(REPOSITION, 3, -1, 1, 0, NAN, *far, 1.0), DENIED, what="a place beyond the fence")
    near_by = flying.to_1e7(0.5, 0.5)
    expect(station.command_int(REPOSITION, 3, -1, 1, 0, NAN, *near_by, 50.0), DENIED, what="50 m high")
    for altitude in (math.inf, -5.0):
        result = station.command_int(REPOSITION, 3, -1, 1, 0, NAN, *near_by, altitude)
        assert result not in (0, 5), f"height {altitude} was accepted"
    assert station.command_int(REPOSITION, 10, -1, 1, 0, NAN, *near_by, 1.0) not in (0, 5), "a terrain frame was accepted"
    expect(station.command(ARM, 0), DENIED, what="disarming in flight")
    expect(station.command(ARM, 0, 12_345), DENIED, what="disarming in flight with another number")
    expect(station.command(ARM, 0, NAN), DENIED, what="disarming in flight with not a number")
    expect(station.command(179, 1), DENIED, what="a new home in flight")
    expect(station.command(246, 1), DENIED, what="a restart in flight")
    station.send("SET_GPS_GLOBAL_ORIGIN", 1, 520_000_000, 130_000_000, 0)
    station.hear(1.5)
    assert math.dist(before, place(station)) < 0.3 and flying.armed(station)
    near(station.request(49)[1].latitude / 1e7, ORIGIN[0], 1e-6, "the origin in flight")


def changes_modes_three_ways(station):
    expect(set_mode(station, flying.OFFBOARD), DENIED, TEMPORARILY_REJECTED, what="off-board without a stream")
    expect(station.command(flying.SET_MODE, 1, 6), DENIED, TEMPORARILY_REJECTED, what="ArduCopter's RTL")
    expect(set_mode(station, flying.BY_HAND), DENIED, TEMPORARILY_REJECTED, what="by hand without sticks")
    station.repeat["stick"] = (0.04, lambda: station.send("MANUAL_CONTROL", 1, 0, 0, 500, 0, 0))
    station.hear(0.3)
    asked_s = time.monotonic()
    expect_accepted(set_mode(station, flying.BY_HAND), "by hand")
    flying.wait_mode(station, flying.BY_HAND, 1, asked_s)
    asked_s = time.monotonic()
    # The whole number, as MAVProxy's `mode 50593792` sends it.
    expect_accepted(station.command(flying.SET_MODE, 1, HOLD), "hold by the whole number")
    flying.wait_mode(station, HOLD, 1, asked_s)
    asked_s = time.monotonic()
    station.send("SET_MODE", 1, 1, flying.BY_HAND)
    flying.wait_mode(station, flying.BY_HAND, 1, asked_s)
    asked_s = time.monotonic()
    expect_accepted(station.command(193, 0), "pause")
    flying.wait_mode(station, HOLD, 1, asked_s)
    station.repeat.pop("stick")


def test_landing_is_never_taken_back(station):
    flying.take_off(station)
    expect_accepted(station.command(NAV_LAND), "land")
    flying.wait_mode(station, LAND, 1)
    for number, parameters in ((NAV_TAKEOFF, (0,)), (193, (1,)), (300, (0,)), (193, (0,))):
        station.command(number, *parameters)
    set_mode(station, HOLD)
    x, y = flying.to_1e7(1, 1)
    station.command_int(REPOSITION, 3, -1, 1, 0, NAN, x, y, 1.5)
    assert flying.mode(station) == LAND
    flying.wait_landed(station)


def test_land_by_mode_and_standard_mode(station):
    for send in (lambda: set_mode(station, LAND), lambda: station.command(262, mavlink.MAV_STANDARD_MODE_LAND)):
        flying.take_off(station)
        asked_s = time.monotonic()
        expect_accepted(send(), "mode land")
        flying.wait_mode(station, LAND, 1, asked_s)
        flying.wait_landed(station)
