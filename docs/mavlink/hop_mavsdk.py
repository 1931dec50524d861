"""Takes off, flies a metre forward and back, and lands. ardrone-pilot --mock --mavlink; pip install mavsdk==4.1.0"""

import sys
import time

from mavsdk import ComponentType, Configuration, Mavsdk
from mavsdk.plugins.action import Action
from mavsdk.plugins.offboard import Offboard, PositionNedYaw
from mavsdk.plugins.telemetry import FlightMode, Telemetry

mavsdk = Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION))
mavsdk.add_any_connection(sys.argv[1] if len(sys.argv) > 1 else "udpin://127.0.0.1:14540")
system = mavsdk.first_autopilot(30)
if system is None:
    sys.exit("no vehicle: is ardrone-pilot --mavlink running?")
action, offboard, telemetry = Action(system), Offboard(system), Telemetry(system)

# Not health_all_ok(), which wants GPS.
while not telemetry.health().is_armable:
    time.sleep(0.2)
action.arm()
action.takeoff()
while not (telemetry.in_air() and telemetry.flight_mode() == FlightMode.HOLD):
    time.sleep(0.2)

# North, east, down, yaw: north is where the drone looks at its take-off, one metre above the floor is down = -1.
offboard.set_position_ned(PositionNedYaw(1, 0, -1, 0))
offboard.start()
time.sleep(5)
offboard.set_position_ned(PositionNedYaw(0, 0, -1, 0))
time.sleep(5)
offboard.stop()

action.land()
while telemetry.armed():
    time.sleep(0.2)
place = telemetry.position_velocity_ned().position
print(f"landed {place.north_m:+.2f} m north, {place.east_m:+.2f} m east of the start")
