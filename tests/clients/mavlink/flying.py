"""What the tests do with the vehicle again and again: arm, take off, go there, land; and its modes and results by name."""

import math
import time

from station import Silence, mavlink

HOLD, TAKE_OFF, MISSION = 0x0304_0000, 0x0204_0000, 0x0404_0000
RETURN, LAND, OFFBOARD, BY_HAND = 0x0504_0000, 0x0604_0000, 0x0006_0000, 0x0003_0000
MODE_NAMES = {
    HOLD: "hold", TAKE_OFF: "take-off", MISSION: "mission", RETURN: "return",
    LAND: "land", OFFBOARD: "off-board", BY_HAND: "by hand",
}  # fmt: skip

ACCEPTED, TEMPORARILY_REJECTED, DENIED = 0, 1, 2
UNSUPPORTED, FAILED, IN_PROGRESS = 3, 4, 5
RESULT_NAMES = {
    ACCEPTED: "accepted", TEMPORARILY_REJECTED: "temporarily rejected", DENIED: "denied",
    UNSUPPORTED: "unsupported", FAILED: "failed", IN_PROGRESS: "in progress",
}  # fmt: skip

ARM, NAV_TAKEOFF, NAV_LAND, SET_MODE = 400, 22, 21, 176
GROUND, IN_AIR = 1, 2
ARMED_BIT = 128
READY_BIT = 0x1000_0000
CUT_MAGIC = 21196
ORIGIN = (47.397742, 8.545594, 488.0)
# Of the sphere that the vehicle computes with: 6 371 000 m.
METRES_PER_DEGREE = math.pi * 6_371_000 / 180
NAN = math.nan


def expect(result, *wanted, what="the command"):
    names = " or ".join(RESULT_NAMES.get(one, str(one)) for one in wanted)
    assert result in wanted, f"{what}: {RESULT_NAMES.get(result, result)}, not {names}"


def expect_accepted(result, what="the command"):
    expect(result, ACCEPTED, IN_PROGRESS, what=what)


def near(is_value, should_be, tolerance, what):
    assert abs(is_value - should_be) <= tolerance, f"{what} is {is_value:.3f}, not {should_be:.3f} (within {tolerance})"


def armed(station):
    return bool(station.latest["HEARTBEAT"].base_mode & ARMED_BIT)


def mode(station):
    return station.latest["HEARTBEAT"].custom_mode


def on_the_ground(station):
    state = station.latest.get("EXTENDED_SYS_STATE")
    return state is not None and state.landed_state == GROUND


def ready(station):
    """Whether the vehicle says that it can take off."""
    status = station.latest.get("SYS_STATUS")
    return status is not None and bool(status.onboard_control_sensors_health & READY_BIT)


def wait_ready(station, within_s=45):
    station.wait("HEARTBEAT", 20)
    station.wait("SYS_STATUS", within_s, lambda status: status.onboard_control_sensors_health & READY_BIT)


def wait_mode(station, wanted, within_s, since_s=None):
    """The heartbeat that tells this mode first; without a time since when, the last one will do."""
    if since_s is None and mode(station) == wanted:
        return station.latest["HEARTBEAT"]
    try:
        return station.wait("HEARTBEAT", within_s, lambda beat: beat.custom_mode == wanted, since_s)
    except Silence:
        now = mode(station)
        told = MODE_NAMES.get(now, hex(now))
        raise Silence(
            f"mode {MODE_NAMES[wanted]} not within {within_s:.1f} s, it is {told}; {station.texts()[-4:]}"
        ) from None


def wait_armed(station, wanted=True, within_s=1.0, since_s=None):
    def tells(beat):
        return bool(beat.base_mode & ARMED_BIT) == wanted

    return station.wait("HEARTBEAT", within_s, tells, since_s)


def set_mode(station, wanted):
    """MAV_CMD_DO_SET_MODE with PX4's main and sub mode; its result."""
    return station.command(SET_MODE, 1, (wanted >> 16) & 0xFF, wanted >> 24)


def arm(station):
    asked_s = time.monotonic()
    expect_accepted(station.command(ARM, 1), "arm")
    wait_armed(station, since_s=asked_s)


def take_off(station):
    """From the ground to the hover."""
    wait_ready(station)
    arm(station)
    expect_accepted(station.command(NAV_TAKEOFF, NAN, NAN, NAN, NAN, NAN, NAN, NAN), "take-off")
    wait_hover(station)


def wait_hover(station, within_s=15):
    def hovers():
        place = station.latest.get("LOCAL_POSITION_NED")
        flies = station.latest["EXTENDED_SYS_STATE"].landed_state == IN_AIR
        return flies and place is not None and place.z < -0.6 and mode(station) == HOLD

    station.wait_until(hovers, within_s, "the drone hovers")
    station.hear(0.5)


def land(station):
    expect_accepted(station.command(NAV_LAND, NAN, NAN, NAN, NAN, NAN, NAN, NAN), "land")
    wait_landed(station)


def wait_landed(station, within_s=20):
    station.wait_until(lambda: on_the_ground(station), within_s, "the drone is on the ground")
    station.wait_until(lambda: not armed(station), 5, "it is disarmed")


def rest(station):
    """Whatever a test left behind: back on the ground, disarmed, heard."""
    station.repeat.clear()
    station.beats = True
    station.hear(0.3)
    if not on_the_ground(station):
        station.command(NAV_LAND, within_s=1)
        wait_landed(station, 30)
    if armed(station):
        station.command(ARM, 0, within_s=1)
        wait_armed(station, False, 12)
    station.hear(0.3)


def place(station):
    """North, east and height above the floor, fresh."""
    local = station.wait("LOCAL_POSITION_NED", 1)
    return local.x, local.y, -local.z


def yaw_deg(station):
    return math.degrees(station.wait("ATTITUDE", 1).yaw)


def turned_by(from_deg, to_deg):
    return (to_deg - from_deg + 180) % 360 - 180


def wait_arrival(station, north, east, height, within_s=15, radius_m=0.3):
    """The drone is there, and stays for half a second."""
    there_since_s = None
    until_s = time.monotonic() + within_s
    while True:
        distance_m = math.dist(place(station), (north, east, height))
        if distance_m > radius_m:
            there_since_s = None
        elif there_since_s is None:
            there_since_s = time.monotonic()
        elif time.monotonic() - there_since_s > 0.5:
            return
        assert time.monotonic() < until_s, (
            f"{distance_m:.2f} m away from {north:.2f} {east:.2f} {height:.2f} after {within_s} s; {station.texts()[-4:]}"
        )


def to_degrees(north, east):
    """Latitude and longitude of a place, in degrees."""
    latitude = ORIGIN[0] + north / METRES_PER_DEGREE
    longitude = ORIGIN[1] + east / (METRES_PER_DEGREE * math.cos(math.radians(ORIGIN[0])))
    return latitude, longitude


def to_1e7(north, east):
    return tuple(round(angle * 1e7) for angle in to_degrees(north, east))


# Setpoints: 1 in the mask ignores the value.
POSITION_ONLY = 0b1101_1111_1000
POSITION_AND_YAW = 0b1001_1111_1000
VELOCITY_ONLY = 0b1101_1100_0111
VELOCITY_AND_TURN = 0b0101_1100_0111
ACCELERATION_ONLY = 0b1100_0011_1111


def set_point(station, frame=1, mask=POSITION_ONLY, position=(NAN, NAN, NAN), velocity=(NAN, NAN, NAN), yaw=NAN, turn=NAN):
    """What sends one local setpoint; what its mask ignores is not a number."""
    acceleration = (NAN, NAN, NAN) if mask != ACCELERATION_ONLY else (1, 0, 0)

    def send():
        station.send(
            "SET_POSITION_TARGET_LOCAL_NED", 0, 1, 1, frame, mask, *position, *velocity, *acceleration, yaw, turn
        )

    return send


def go_off_board(station, send):
    """Starts the stream and enters the mode; the stream goes on until it is replaced."""
    station.repeat["setpoints"] = (0.05, send)
    station.hear(0.3)
    expect_accepted(set_mode(station, OFFBOARD), "off-board")
    wait_mode(station, OFFBOARD, 1)
