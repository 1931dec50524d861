"""What the vehicle says on the ground, unasked and asked: heartbeat, rates, messages, modes, parameters, origin."""

import time

import flying
from flying import ACCEPTED, DENIED, FAILED, HOLD, NAN, ORIGIN, UNSUPPORTED, expect, expect_accepted, near
from station import mavlink

# Name, and how many a second at least (four fifths of what docs/mavlink.md says).
UNASKED = {
    "SYS_STATUS": 0.8, "ATTITUDE": 8, "LOCAL_POSITION_NED": 8, "GLOBAL_POSITION_INT": 4, "VFR_HUD": 3.2,
    "EXTENDED_SYS_STATE": 0.8, "HOME_POSITION": 0.16, "BATTERY_STATUS": 0.4, "MISSION_CURRENT": 0.8,
    "CURRENT_MODE": 0.4, "ESTIMATOR_STATUS": 0.8, "DISTANCE_SENSOR": 4,
}  # fmt: skip
ON_REQUEST = (1, 24, 30, 31, 32, 33, 42, 49, 74, 85, 132, 141, 147, 148, 230, 242, 245, 436)
NOT_THERE = (26, 128, 141_000, 395, 397, 65_000)


def test_the_heartbeat_is_that_of_a_generic_quadrotor_at_rest(station):
    beat = station.wait("HEARTBEAT", 2)
    assert (beat.type, beat.autopilot, beat.mavlink_version) == (2, 0, 3), beat
    assert beat.base_mode & 1 and not beat.base_mode & flying.ARMED_BIT, beat
    assert (beat.custom_mode, beat.system_status) == (HOLD, 3), beat
    assert beat.get_msgbuf()[0] == 0xFD, "it is sent as MAVLink 2"


def test_the_heartbeat_comes_every_second(station):
    from_s = time.monotonic()
    station.hear(6)
    times = [beat.heard_s for beat in station.since(from_s, "HEARTBEAT")]
    gaps = [later - earlier for earlier, later in zip(times, times[1:])]
    assert 5 <= len(times) <= 8 and max(gaps) < 1.3, f"{len(times)} in 6 s, largest gap {max(gaps):.2f} s"


def test_telemetry_comes_unasked(station):
    from_s = time.monotonic()
    station.hear(7)
    slow = {}
    for kind, rate_hz in UNASKED.items():
        heard_hz = len(station.since(from_s, kind)) / 7
        if heard_hz < rate_hz and not (rate_hz < 0.2 and heard_hz > 0):
            slow[kind] = f"{heard_hz:.1f} Hz"
    assert not slow, f"too slow: {slow}"


def test_a_message_that_exists_comes_on_request(station):
    missing = {}
    for number in ON_REQUEST:
        # GPS_RAW_INT is there only with the option, ALTITUDE need not be.
        optional = number in (24, 141)
        try:
            result, message = station.request(number)
        except AssertionError as silence:
            missing[number] = str(silence)
            continue
        if message is None and not optional:
            missing[number] = flying.RESULT_NAMES.get(result, result)
    assert not missing, missing


def test_a_message_that_does_not_exist_is_refused_at_once(station):
    for number in NOT_THERE:
        result, _ = station.request(number)
        expect(result, UNSUPPORTED, DENIED, FAILED, what=f"request of message {number}")


def test_messages_by_older_commands(station):
    for command, kind in ((520, "AUTOPILOT_VERSION"), (410, "HOME_POSITION")):
        asked_s = time.monotonic()
        expect_accepted(station.command(command, 1), f"command {command}")
        station.wait(kind, 0.4, since_s=asked_s)
    station.command(519, 1)


def rate_of(station, kind, seconds=3):
    station.hear(0.3)
    from_s = time.monotonic()
    station.hear(seconds)
    return len(station.since(from_s, kind)) / seconds


def interval(station, number, interval_us):
    return station.command(mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, number, interval_us)


def test_rates_can_be_set(station):
    usual_hz = rate_of(station, "LOCAL_POSITION_NED")
    expect_accepted(interval(station, 32, 500_000), "2 Hz")
    near(rate_of(station, "LOCAL_POSITION_NED"), 2, 0.7, "the rate, 2 Hz asked for")
    asked_s = time.monotonic()
    expect_accepted(station.command(mavlink.MAV_CMD_GET_MESSAGE_INTERVAL, 32), "its interval")
    near(station.wait("MESSAGE_INTERVAL", 0.4, since_s=asked_s).interval_us, 500_000, 20_000, "the interval")
    expect_accepted(interval(station, 32, -1), "off")
    near(rate_of(station, "LOCAL_POSITION_NED", 2), 0, 0, "the rate of a message that is off")
    expect_accepted(interval(station, 32, 0), "as usual")
    near(rate_of(station, "LOCAL_POSITION_NED"), usual_hz, 2, "the usual rate")


def test_rates_are_limited(station):
    expect_accepted(interval(station, 30, 1), "a microsecond")
    fast_hz = rate_of(station, "ATTITUDE")
    interval(station, 30, 0)
    assert 9 <= fast_hz <= 12, f"{fast_hz:.0f} Hz"


def test_nonsense_as_a_rate_is_answered(station):
    for number, interval_us in ((NAN, 1000), (30, NAN), (65_000, 1000), (30, -7), (-1, 0), (1e30, 1e30)):
        interval(station, number, interval_us)
    interval(station, 30, 0)
    assert rate_of(station, "ATTITUDE", 2) >= 8


def test_a_data_stream_request_does_not_slow_telemetry(station):
    station.send("REQUEST_DATA_STREAM", 1, 1, 0, 1, 1)
    assert rate_of(station, "LOCAL_POSITION_NED") >= 8


def test_modes_are_listed_one_at_a_time(station):
    first = station.request(435, parameter=1)[1]
    assert first is not None and first.number_modes >= 6, first
    found = {}
    for index in range(1, first.number_modes + 1):
        asked_s = time.monotonic()
        result = station.command(mavlink.MAV_CMD_REQUEST_MESSAGE, 435, index)
        expect(result, ACCEPTED, what=f"mode {index}")
        listed = station.wait("AVAILABLE_MODES", 0.4, lambda one: one.mode_index == index, asked_s)
        found[listed.custom_mode] = listed.mode_name
    wanted = {flying.HOLD, flying.TAKE_OFF, flying.MISSION, flying.LAND, flying.OFFBOARD, flying.BY_HAND}
    assert wanted <= set(found) and all(found.values()), found
    result = station.command(mavlink.MAV_CMD_REQUEST_MESSAGE, 435, first.number_modes + 1)
    expect(result, UNSUPPORTED, DENIED, FAILED, what="a mode after the last one")


def test_all_modes_are_listed_at_once(station):
    asked_s = time.monotonic()
    expect_accepted(station.command(mavlink.MAV_CMD_REQUEST_MESSAGE, 435, 0))
    station.hear(1)
    listed = station.since(asked_s, "AVAILABLE_MODES")
    assert listed and sorted(one.mode_index for one in listed) == list(range(1, listed[0].number_modes + 1)), listed


def test_capabilities_are_those_that_exist(station):
    version = station.request(148)[1]
    for name, bit in (("MISSION_INT", 4), ("COMMAND_INT", 8), ("LOCAL_NED", 128), ("TERMINATION", 2048), ("MAVLINK2", 8192), ("MISSION_FENCE", 0x4000)):
        assert version.capabilities & bit, f"{name} is missing in {version.capabilities:#x}"
    for name, bit in (("rally", 0x8000), ("FTP", 32), ("compass calibration", 4096)):
        assert not version.capabilities & bit, f"{name} is claimed"


def test_home_is_the_origin_and_the_drone_is_there(station):
    home = station.request(242)[1]
    for what, is_value, should_be in zip(("latitude", "longitude"), (home.latitude, home.longitude), ORIGIN):
        near(is_value / 1e7, should_be, 1e-6, what)
    near(home.altitude / 1000, ORIGIN[2], 0.01, "altitude of home")
    position = station.wait("GLOBAL_POSITION_INT", 1)
    near(position.lat / 1e7, ORIGIN[0], 1e-5, "latitude")
    near(position.lon / 1e7, ORIGIN[1], 1e-5, "longitude")
    near(position.relative_alt / 1000, 0, 0.15, "height")


def test_the_origin_can_be_set_on_the_ground(station):
    for latitude, longitude, altitude in ((52.0, 13.0, 34.0), ORIGIN):
        asked_s = time.monotonic()
        wanted = (round(latitude * 1e7), round(longitude * 1e7), round(altitude * 1000))
        station.send("SET_GPS_GLOBAL_ORIGIN", 1, *wanted)
        told = station.wait("GPS_GLOBAL_ORIGIN", 1, since_s=asked_s)
        assert (told.latitude, told.longitude, told.altitude) == wanted, told
        position = station.wait("GLOBAL_POSITION_INT", 1)
        station.hear(0.3)
        position = station.wait("GLOBAL_POSITION_INT", 1)
        near(position.lat / 1e7, latitude, 1e-5, "latitude")


def test_an_impossible_origin_is_not_taken(station):
    largest = 2**31 - 1
    for wanted in ((largest, largest, largest), (900_000_001, 0, 0), (0, 1_800_000_001, 0), (-(2**31), 0, 0)):
        station.send("SET_GPS_GLOBAL_ORIGIN", 1, *wanted)
    station.hear(0.5)
    near(station.request(49)[1].latitude / 1e7, ORIGIN[0], 1e-6, "latitude of the origin")


def test_a_ping_and_a_time_are_answered(station):
    asked_s = time.monotonic()
    station.send("PING", 123_456, 77, 0, 0)
    answer = station.wait("PING", 0.4, lambda ping: ping.seq == 77, asked_s)
    assert (answer.target_system, answer.time_usec) == (station.system, 123_456), answer
    station.send("TIMESYNC", 0, 5_000_000)
    answer = station.wait("TIMESYNC", 0.4, lambda sync: sync.ts1 == 5_000_000, asked_s)
    assert answer.tc1 != 0, answer


def parameters(station):
    """All of them, by name."""
    asked_s = time.monotonic()
    station.send("PARAM_REQUEST_LIST", 1, 0)
    first = station.wait("PARAM_VALUE", 1, since_s=asked_s)

    def complete():
        heard = station.since(asked_s, "PARAM_VALUE")
        return {one.param_index for one in heard} >= set(range(first.param_count))

    station.wait_until(complete, 5, "all parameters")
    heard = station.since(asked_s, "PARAM_VALUE")
    assert len(heard) <= first.param_count + 1, f"{len(heard)} sent for {first.param_count}"
    return {one.param_id: one for one in heard}


def test_parameters_are_listed(station):
    listed = parameters(station)
    assert listed and all(one.param_type == 9 for one in listed.values()), listed
    assert all(one.param_value == one.param_value for one in listed.values()), "a value is not a number"
    assert all(1 <= len(name) <= 16 for name in listed), listed


def test_parameters_are_read_by_name_and_by_index(station):
    for name, one in parameters(station).items():
        for read_name, index in ((name, -1), ("", one.param_index)):
            asked_s = time.monotonic()
            station.send("PARAM_REQUEST_READ", 1, 1, read_name.encode(), index)
            told = station.wait("PARAM_VALUE", 0.4, lambda value: value.param_id == name, asked_s)
            assert told.param_value == one.param_value, told


def test_an_unknown_parameter_is_refused(station):
    for send in (
        lambda: station.send("PARAM_REQUEST_READ", 1, 1, b"NO_SUCH_THING", -1),
        lambda: station.send("PARAM_REQUEST_READ", 1, 1, b"", 9999),
        lambda: station.send("PARAM_SET", 1, 1, b"NO_SUCH_THING", 1.0, 9),
    ):
        asked_s = time.monotonic()
        send()
        assert station.wait("PARAM_ERROR", 0.5, since_s=asked_s).error != 0


def test_a_value_out_of_range_is_not_kept(station):
    for name, one in parameters(station).items():
        for value in (1e9, -1e9, NAN, float("inf")):
            asked_s = time.monotonic()
            station.send("PARAM_SET", 1, 1, name.encode(), value, 9)
            kept = station.wait("PARAM_VALUE", 0.5, lambda told: told.param_id == name, asked_s)
            assert kept.param_value == one.param_value, f"{name} = {value} became {kept.param_value}"
            assert station.wait("PARAM_ERROR", 0.5, since_s=asked_s).error != 0


def test_parameters_of_another_system_are_not_touched(station):
    asked_s = time.monotonic()
    station.send("PARAM_REQUEST_LIST", 2, 1)
    station.hear(1)
    assert not station.since(asked_s, "PARAM_VALUE")
