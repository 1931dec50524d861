"""Takes off, goes a metre forward, and lands. ardrone-pilot --mock --mavlink; pip install pymavlink==2.4.50"""

import math
import os
import sys
import time

os.environ["MAVLINK20"] = "1"
from pymavlink import mavutil

link = mavutil.mavlink_connection(sys.argv[1] if len(sys.argv) > 1 else "udpin:127.0.0.1:14550")
last_beat_s = 0.0


def until(kind, condition, within_s=30):
    """The first such message. Sends heartbeats: the drone holds and then lands when its station is silent."""
    global last_beat_s
    until_s = time.monotonic() + within_s
    while time.monotonic() < until_s:
        if time.monotonic() - last_beat_s > 1 and link.target_system:
            link.mav.heartbeat_send(mavutil.mavlink.MAV_TYPE_GCS, mavutil.mavlink.MAV_AUTOPILOT_INVALID, 0, 0, 0)
            last_beat_s = time.monotonic()
        message = link.recv_match(type=kind, blocking=True, timeout=0.2)
        if message and condition(message):
            return message
    sys.exit(f"no such {kind} within {within_s} s")


def command(number, *parameters):
    link.mav.command_long_send(1, 1, number, 0, *parameters, *[0] * (7 - len(parameters)))
    acknowledged = until("COMMAND_ACK", lambda ack: ack.command == number, 2)
    if acknowledged.result not in (0, 5):
        sys.exit(f"command {number} was refused with {acknowledged.result}")


if not link.wait_heartbeat(timeout=30):
    sys.exit("no vehicle: is ardrone-pilot --mavlink running?")
until("SYS_STATUS", lambda status: status.onboard_control_sensors_health & mavutil.mavlink.MAV_SYS_STATUS_PREARM_CHECK)
command(mavutil.mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1)
command(mavutil.mavlink.MAV_CMD_NAV_TAKEOFF)
until("LOCAL_POSITION_NED", lambda place: place.z < -0.7)
until("HEARTBEAT", lambda beat: beat.custom_mode == 0x03040000)

# One metre north of home, 1.2 m above the floor; no yaw (nan) keeps the heading. 111194.93 m are a degree.
home = link.messages.get("HOME_POSITION") or until("HOME_POSITION", lambda _home: True)
link.mav.command_int_send(
    1, 1, mavutil.mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT, mavutil.mavlink.MAV_CMD_DO_REPOSITION, 0, 0,
    -1, 1, 0, math.nan, home.latitude + round(1e7 / 111_194.93), home.longitude, 1.2,
)  # fmt: skip
until("LOCAL_POSITION_NED", lambda place: abs(place.x - 1) < 0.2 and abs(place.z + 1.2) < 0.2)

command(mavutil.mavlink.MAV_CMD_NAV_LAND)
until("HEARTBEAT", lambda beat: not beat.base_mode & mavutil.mavlink.MAV_MODE_FLAG_SAFETY_ARMED)
place = link.messages["LOCAL_POSITION_NED"]
print(f"landed {place.x:+.2f} m north, {place.y:+.2f} m east of the start")
