"""With --mavlink-as px4: what QGroundControl 4.4.2 does, step by step, as its source has it. Each case is one thing that went wrong
when it was tried with it."""

import json
import math
import pathlib
import time

import flying
import plans
from cases.telemetry import parameters
from flying import ARM, HOLD, LAND, MISSION, NAN, NAV_TAKEOFF, ORIGIN, RETURN, TAKE_OFF, expect, expect_accepted, near
from plans import point

REPOSITION = 192
ERROR, INFO = 3, 6
CEILING_M = 3.0
DOCS = pathlib.Path(__file__).resolve().parents[4] / "docs"


def set_mode_as_qgroundcontrol(station, wanted):
    """Sets the mode up to three times, and waits each time 1.3 s for a heartbeat with it: FirmwarePlugin.cc:965."""
    for _ in range(3):
        asked_s = time.monotonic()
        station.send("SET_MODE", 1, 1 | (station.latest["HEARTBEAT"].base_mode & ~1), wanted)
        try:
            station.wait("HEARTBEAT", 1.3, lambda beat: beat.custom_mode == wanted, asked_s)
            return True
        except AssertionError:
            continue
    return False


def arm_as_qgroundcontrol(station):
    asked_s = time.monotonic()
    expect_accepted(station.command(ARM, 1), "arm")
    flying.wait_armed(station, within_s=1.5, since_s=asked_s)


def go_to_as_qgroundcontrol(station, north, east):
    """To a place at the momentary altitude: that of the last ALTITUDE. FirmwarePlugin.cc:458."""
    altitude = station.latest["ALTITUDE"].altitude_amsl
    return station.command_int(REPOSITION, 0, -1, 1, 0, NAN, *flying.to_1e7(north, east), altitude)


def take_off_as_qgroundcontrol(station, height):
    expect_accepted(station.command(NAV_TAKEOFF, -1, 0, 0, NAN, NAN, NAN, ORIGIN[2] + height), f"take-off to {height} m")
    arm_as_qgroundcontrol(station)


def said(station, since_s, text, severity=None, within_s=2.0):
    """Waits for a text, whose chunks are put together; its severity is at most this number."""
    def whole():
        found = {}
        for chunk in station.since(since_s, "STATUSTEXT"):
            key = (chunk.id, chunk.heard_s if chunk.id == 0 else 0)
            known = found.setdefault(key, [chunk.severity, ""])
            known[1] += chunk.text
        return list(found.values())

    station.wait_until(
        lambda: any(text in one and (severity is None or number <= severity) for number, one in whole()),
        within_s, f"a text with '{text}', of severity {severity} at most: {whole()[-6:]}",
    )  # fmt: skip


def test_a_mission_is_started_from_the_ground(station):
    flying.wait_ready(station)
    plans.check_uploads(station, [plans.takeoff(1.0), point(0.6, 0.0, 1.0), plans.land()])
    began_s = time.monotonic()
    assert set_mode_as_qgroundcontrol(station, MISSION), "it does not report Mission before it is armed"
    arm_as_qgroundcontrol(station)
    station.wait("MISSION_ITEM_REACHED", 25, lambda reached: reached.seq == 1, began_s)
    modes = {beat.custom_mode for beat in station.since(began_s + 1.5, "HEARTBEAT")}
    assert modes == {MISSION}, [flying.MODE_NAMES.get(one, hex(one)) for one in modes]
    flying.wait_landed(station, 30)


def test_what_waits_for_arming_is_reported_until_it_is_given_up(station):
    flying.wait_ready(station)
    assert set_mode_as_qgroundcontrol(station, MISSION)
    flying.wait_mode(station, HOLD, 7, time.monotonic())
    assert flying.on_the_ground(station) and not flying.armed(station)


def test_a_take_off_to_10_m_does_not_lead_to_the_ceiling(station):
    for height in (10.0, 3.048):
        flying.wait_ready(station)
        asked_s = time.monotonic()
        take_off_as_qgroundcontrol(station, height)
        flying.wait_hover(station)
        station.hear(4)
        highest = max(-one.z for one in station.since(asked_s, "LOCAL_POSITION_NED"))
        assert highest < 1.5, f"it rose to {highest:.2f} m"
        said(station, asked_s, f"not {height:.2f} m")
        flying.land(station)


def test_a_take_off_inside_the_limits_leads_there(station):
    flying.wait_ready(station)
    asked_s = time.monotonic()
    take_off_as_qgroundcontrol(station, 1.5)
    said(station, asked_s, "take-off to 1.50 m")
    flying.wait_hover(station)
    flying.wait_arrival(station, 0.0, 0.0, 1.5)
    flying.land(station)


def test_a_plans_take_off_to_10_m_does_not_lead_to_the_ceiling(station):
    flying.wait_ready(station)
    asked_s = time.monotonic()
    plans.check_uploads(station, [plans.takeoff(10.0), point(0.5, 0.0, 1.0), plans.land()])
    said(station, asked_s, "item 0 (Takeoff): altitude 0.85 m, not 10.00")
    assert set_mode_as_qgroundcontrol(station, MISSION)
    arm_as_qgroundcontrol(station)
    station.wait("MISSION_ITEM_REACHED", 25, lambda reached: reached.seq == 1, asked_s)
    highest = max(-one.z for one in station.since(asked_s, "LOCAL_POSITION_NED"))
    assert highest < 1.5, f"it rose to {highest:.2f} m"
    flying.wait_landed(station, 30)


def test_a_go_to_at_the_ceiling_is_not_refused_for_a_little(station):
    flying.wait_ready(station)
    asked_s = time.monotonic()
    take_off_as_qgroundcontrol(station, CEILING_M)
    above, until_s = 0, time.monotonic() + 30
    while above < 3 and time.monotonic() < until_s:
        told = station.wait("ALTITUDE", 2)
        if told.altitude_relative > CEILING_M + 0.001:
            above += 1
            expect_accepted(go_to_as_qgroundcontrol(station, 0.3 * (above % 2), 0.0), f"go-to at {told.altitude_relative:.4f} m")
    assert above > 0, "the drone was never above its ceiling: nothing was tried"
    high = station.command_int(REPOSITION, 0, -1, 1, 0, NAN, *flying.to_1e7(0, 0), ORIGIN[2] + CEILING_M + 1)
    expect(high, flying.DENIED, what="a metre above the ceiling")
    said(station, asked_s, "go-to refused: 4.00 m above the start", ERROR)
    expect_accepted(station.command(20), "return")
    flying.wait_landed(station, 30)
    outside = [text for text in station.texts(asked_s) if "outside the fence" in text]
    assert not outside, outside


def test_a_plan_is_refused_at_the_item_that_is_wrong(station):
    """QGroundControl names the item that was asked for last: PlanManager.cc:692."""
    items = [plans.takeoff(), point(0.5, 0.0, 1.0), point(0.5, 0.5, 9.0), point(0.0, 0.5, 1.0), plans.land()]
    asked, asked_s = [], time.monotonic()

    def answer(sequence):
        asked.append(sequence)
        items[sequence].send(station, sequence)

    result = plans.upload(station, items, answer)
    assert result == 12, f"{result} is not the one for a wrong height"
    assert asked == [0, 1, 2], f"it asked for {asked}, and QGroundControl blames the last"
    said(station, asked_s, "item 2 (Waypoint): 9.00 m", ERROR)


def test_the_reason_of_a_refusal_is_an_error(station):
    """Of a warning only a red icon is seen: UASMessageHandler.cc:206."""
    for send, text in (
        (lambda: station.command_int(REPOSITION, 0, -1, 1, 0, NAN, *flying.to_1e7(40, 0), ORIGIN[2] + 1), "outside the fence"),
        (lambda: station.command_int(REPOSITION, 0, -1, 1, 0, NAN, *flying.to_1e7(1, 0), ORIGIN[2] + 1), "take off first"),
        (lambda: station.command(20), "take off first"),
        (lambda: station.command(ARM, 1, 2989), "forced arming"),
    ):  # fmt: skip
        asked_s = time.monotonic()
        assert send() not in (0, 5), text
        said(station, asked_s, text, ERROR)


def test_a_mode_that_is_not_flown_is_refused_in_words(station):
    for custom, name in ((0x0002_0000, "Altitude"), (0x0001_0000, "Manual"), (0x0804_0000, "Follow Me"), (0x0103_0000, "Orbit")):
        asked_s = time.monotonic()
        station.send("SET_MODE", 1, 1, custom)
        said(station, asked_s, f"mode {name} is not flown here", ERROR)
        assert flying.mode(station) == HOLD


def test_the_actions_file_is_one_of_4_4_with_land_and_hold_first(station):
    old = json.loads((DOCS / "qgroundcontrol-actions.json").read_text())
    new = json.loads((DOCS / "qgroundcontrol-5-actions.json").read_text())
    assert (old["version"], old["fileType"]) == (1, "CustomActions"), old["fileType"]
    assert (new["version"], new["fileType"]) == (1, "MavlinkActions"), new["fileType"]
    assert old["actions"] == new["actions"]
    commands = {action["label"]: action["mavCmd"] for action in old["actions"]}
    assert list(commands)[:2] == ["Land", "Hold"], list(commands)
    for label, number in commands.items():
        result = station.command(number, *(old["actions"][list(commands).index(label)].get(f"param{n}", 0) for n in range(1, 8)))
        assert result != flying.UNSUPPORTED, label
        station.hear(0.1)
    station.command(ARM, 0)
    station.hear(0.5)


def test_the_pages_of_vehicle_setup_miss_no_parameter(station):
    named = (
        *(f"CAL_MAG{n}_ID" for n in range(3)), *(f"CAL_MAG{n}_ROT" for n in range(3)),
        *(f"RC_MAP_{what}" for what in ("ROLL", "PITCH", "YAW", "THROTTLE", "FLAPS", "AUX1", "AUX2")),
        *(f"COM_FLTMODE{n}" for n in range(1, 7)), "SYS_AUTOCONFIG", "MAV_SYS_ID", "BAT1_N_CELLS", "BAT1_V_EMPTY",
        "BAT1_V_CHARGED", "RTL_DESCEND_ALT", "RTL_RETURN_ALT", "COM_RC_LOSS_T", "NAV_RCL_ACT", "SENS_DPRES_OFF",
        "SENS_BOARD_ROT", "SDLOG_MODE", "CP_DIST", "COM_OBS_AVOID",
    )  # fmt: skip
    there = parameters(station)
    missing = [name for name in named if name not in there]
    assert not missing, missing


def test_a_parameter_that_cannot_be_set_says_so(station):
    asked_s = time.monotonic()
    station.send("PARAM_SET", 1, 1, b"GF_MAX_HOR_DIST", 5.0, 9)
    said(station, asked_s, "GF_MAX_HOR_DIST not changed: it is read-only", ERROR)


def test_heights_come_five_times_a_second(station):
    began_s = time.monotonic()
    station.hear(4)
    heard = len(station.since(began_s, "ALTITUDE"))
    assert heard >= 19, f"{heard} in 4 s"


def test_a_mission_that_is_not_there_is_not_begun_in_silence(station):
    """After a restart of the vehicle QGroundControl offers the one that it sent before."""
    station.send("MISSION_CLEAR_ALL", 1, 1, 0)
    station.hear(0.5)
    asked_s = time.monotonic()
    station.send("SET_MODE", 1, 1, MISSION)
    said(station, asked_s, "there is no mission: upload it", ERROR)
    assert flying.mode(station) == HOLD


def test_a_fence_in_a_plan_is_refused_in_words(station):
    """It sends one only to who says that it takes missions of that kind."""
    assert station.request(148)[1].capabilities & 1 << 14, "no capability MISSION_FENCE"
    asked_s = time.monotonic()
    corners = [plans.Item(5001, 0, *flying.to_1e7(*at), 0.0, (3.0, 0.0, 0.0, 0.0), kind=1) for at in ((-2, -2), (2, 0), (0, 2))]
    assert plans.upload(station, corners, kind=1) == plans.DENIED
    said(station, asked_s, "fence not changed: it is 10 m around the start", ERROR)
    # Of a plan without one, and of one that was read from the vehicle, nothing is wrong.
    assert plans.upload(station, [], kind=1) == 0
    own, = plans.download(station, 1)
    assert plans.upload(station, [plans.Item(own.command, own.frame, own.x, own.y, 0.0, (own.param1, 0.0, 0.0, 0.0), kind=1)], kind=1) == 0


def test_the_battery_has_volts_and_a_turn_its_rate(station):
    flying.take_off(station)
    told = station.wait("SYS_STATUS", 2)
    assert 9000 < told.voltage_battery < 13_000, told.voltage_battery
    cells = station.wait("BATTERY_STATUS", 2).voltages
    assert abs(cells[0] - told.voltage_battery) < 200 and set(cells[1:]) == {65_535}, cells
    station.command(511, 31, 100_000)
    began_s = time.monotonic()
    turn = flying.set_point(station, 1, flying.VELOCITY_AND_TURN, velocity=(0.0, 0.0, 0.0), turn=0.8)
    flying.go_off_board(station, turn)
    station.hear(3)
    for kind in ("ATTITUDE", "ATTITUDE_QUATERNION"):
        rates = sorted(one.yawspeed for one in station.since(began_s + 1.5, kind))
        near(rates[len(rates) // 2], 0.8, 0.2, f"the rate in {kind}")
    told = [one for one in station.since(began_s + 1.5, "ATTITUDE")]
    turned = sum(flying.turned_by(math.degrees(a.yaw), math.degrees(b.yaw)) for a, b in zip(told, told[1:]))
    took_s = told[-1].time_boot_ms / 1e3 - told[0].time_boot_ms / 1e3
    mean = math.radians(turned) / took_s
    near(sum(one.yawspeed for one in told) / len(told), mean, 0.15, "the mean of the rates, and that of the heading")
    station.command(511, 31, -1)
    flying.land(station)


def test_ones_own_landing_is_no_alarm_and_a_return_stays_one(station):
    flying.take_off(station)
    began_s = time.monotonic()
    flying.land(station)
    alarming = [one.text for one in station.since(began_s, "STATUSTEXT") if one.severity < INFO]
    assert not alarming, alarming
    flying.take_off(station)
    began_s = time.monotonic()
    expect_accepted(station.command(20), "return")
    flying.wait_mode(station, RETURN, 2)
    flying.wait_landed(station, 30)
    modes = {beat.custom_mode for beat in station.since(began_s, "HEARTBEAT")}
    assert LAND not in modes, "the landing of a return is shown as one that somebody ordered"
