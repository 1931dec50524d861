"""MAVSDK-Python flies: off-board places and velocities, and a mission that is paused. usage: mavsdk_flight.py [udpin://127.0.0.1:14540]"""

import math
import sys
import time

from mavsdk import ComponentType, Configuration, Mavsdk
from mavsdk.plugins.action import Action
from mavsdk.plugins.mission import Mission, MissionItem, MissionPlan
from mavsdk.plugins.offboard import Offboard, OffboardError, PositionNedYaw, VelocityBodyYawspeed
from mavsdk.plugins.telemetry import FlightMode, LandedState, Telemetry

METRES_PER_DEGREE = math.pi * 6_371_000 / 180


class Drone:
    def __init__(self, system):
        self.action, self.telemetry = Action(system), Telemetry(system)
        self.offboard, self.mission = Offboard(system), Mission(system)

    def place(self):
        """North, east and height above the floor, in metres."""
        position = self.telemetry.position_velocity_ned().position
        return position.north_m, position.east_m, -position.down_m

    def velocity(self):
        velocity = self.telemetry.position_velocity_ned().velocity
        return velocity.north_m_s, velocity.east_m_s, -velocity.down_m_s


def wait(condition, within_s, what):
    until_s = time.monotonic() + within_s
    while not condition():
        assert time.monotonic() < until_s, f"not within {within_s} s: {what}"
        time.sleep(0.05)


def connect(address):
    configuration = Configuration.create_with_component_type(ComponentType.GROUND_STATION)
    mavsdk = Mavsdk(configuration)
    mavsdk.add_any_connection(address)
    system = mavsdk.first_autopilot(30)
    assert system is not None, f"no vehicle at {address}"
    return mavsdk, Drone(system)


def take_off(drone):
    wait(drone.telemetry.health_all_ok, 60, "everything is healthy (--mavlink-pretend-gps?)")
    drone.action.arm()
    wait(drone.telemetry.armed, 2, "armed")
    drone.action.takeoff()
    wait(lambda: drone.telemetry.landed_state() == LandedState.IN_AIR, 15, "in the air")
    wait(lambda: drone.telemetry.flight_mode() == FlightMode.HOLD, 10, "the take-off ends in hold")


def fly_places(drone):
    """A square around by off-board positions; the largest distance from a corner."""
    north, east, height = drone.place()
    drone.offboard.set_position_ned(PositionNedYaw(north, east, -height, 0))
    drone.offboard.start()
    worst_m = 0.0
    for corner in ((1, 0, 1), (1, 1, 1.2), (0, 1, 1), (0, 0, 1)):
        north, east, height = corner
        drone.offboard.set_position_ned(PositionNedYaw(north, east, -height, 0))
        wait(lambda: math.dist(drone.place(), corner) < 0.25, 15, f"at {corner}")
        time.sleep(1)
        worst_m = max(worst_m, math.dist(drone.place(), corner))
    assert worst_m < 0.3, f"{worst_m:.2f} m away from a corner"
    return worst_m


def fly_velocities(drone):
    """Forward, right, up and a turn; the nose looks north."""
    for order, axis, wanted in (
        (VelocityBodyYawspeed(0.4, 0, 0, 0), 0, 0.4), (VelocityBodyYawspeed(-0.4, 0, 0, 0), 0, -0.4),
        (VelocityBodyYawspeed(0, 0.4, 0, 0), 1, 0.4), (VelocityBodyYawspeed(0, -0.4, 0, 0), 1, -0.4),
        (VelocityBodyYawspeed(0, 0, -0.2, 0), 2, 0.2), (VelocityBodyYawspeed(0, 0, 0.2, 0), 2, -0.2),
    ):  # fmt: skip
        drone.offboard.set_velocity_body(order)
        time.sleep(1.5)
        measured = drone.velocity()
        assert abs(measured[axis] - wanted) < 0.17, f"{order}: {[round(one, 2) for one in measured]} m/s"
        drone.offboard.set_velocity_body(VelocityBodyYawspeed(0, 0, 0, 0))
        time.sleep(0.8)
    before = drone.telemetry.attitude_euler().yaw_deg
    drone.offboard.set_velocity_body(VelocityBodyYawspeed(0, 0, 0, 30))
    time.sleep(2)
    turned = (drone.telemetry.attitude_euler().yaw_deg - before + 180) % 360 - 180
    assert 30 < turned < 80, f"it turned by {turned:.0f} deg in 2 s at 30 deg/s"
    drone.offboard.stop()
    wait(lambda: drone.telemetry.flight_mode() == FlightMode.HOLD, 2, "off-board stops in hold")


def square(home):
    """Four corners above the floor, as a mission."""

    def item(north, east, height):
        latitude = home.latitude_deg + north / METRES_PER_DEGREE
        longitude = home.longitude_deg + east / (METRES_PER_DEGREE * math.cos(math.radians(home.latitude_deg)))
        return MissionItem(latitude, longitude, height, 0.5, True, acceptance_radius_m=0.2)

    return MissionPlan([item(*corner) for corner in ((1, 0, 1), (1, 1, 1.2), (0, 1, 1), (0, 0, 1))])


def check_same(sent, read):
    assert len(sent.mission_items) == len(read.mission_items), f"{len(read.mission_items)} items came back"
    for number, (one, other) in enumerate(zip(sent.mission_items, read.mission_items)):
        for name in ("latitude_deg", "longitude_deg", "relative_altitude_m", "speed_m_s"):
            assert abs(getattr(one, name) - getattr(other, name)) < 1e-6, f"{name} of item {number}: {other}"


def fly_mission(drone):
    """A square as mission, paused and started again between its corners."""
    plan = square(drone.telemetry.home())
    drone.mission.upload_mission(plan)
    check_same(plan, drone.mission.download_mission())
    drone.mission.start_mission()
    wait(lambda: drone.mission.mission_progress().current >= 1, 20, "the first corner")
    drone.mission.pause_mission()
    wait(lambda: drone.telemetry.flight_mode() == FlightMode.HOLD, 2, "the mission is paused")
    time.sleep(1)
    before = drone.place()
    time.sleep(1.5)
    assert math.dist(before, drone.place()) < 0.3, "it flies on while it is paused"
    drone.mission.start_mission()
    wait(drone.mission.is_mission_finished, 40, "the mission ends")
    assert math.dist(drone.place(), (0, 0, 1)) < 0.5, f"it ended at {drone.place()}"


def land(drone):
    drone.action.land()
    wait(lambda: drone.telemetry.landed_state() == LandedState.ON_GROUND, 20, "on the ground")
    wait(lambda: not drone.telemetry.armed(), 5, "disarmed")


def off_board_without_a_set_point_is_refused(drone):
    try:
        drone.offboard.start()
    except OffboardError:
        return
    raise AssertionError("off-board started without a setpoint")


def main():
    address = sys.argv[1] if len(sys.argv) > 1 else "udpin://127.0.0.1:14540"
    mavsdk, drone = connect(address)
    try:
        take_off(drone)
        off_board_without_a_set_point_is_refused(drone)
        worst_m = fly_places(drone)
        fly_velocities(drone)
        fly_mission(drone)
        land(drone)
    except Exception as error:
        print(f"MAVSDK: {type(error).__name__}: {error}")
        return 1
    finally:
        mavsdk.destroy()
    print(f"MAVSDK: places within {worst_m:.2f} m, velocities, a mission with a pause, landed and disarmed")
    return 0


if __name__ == "__main__":
    sys.exit(main())
