"""pyardrone, unmodified: takes off, moves, reads navdata, lands."""

import sys
import time

from pyardrone import ARDrone, at

drone = ARDrone(host="127.0.0.1")
drone.navdata_ready.wait(10)
drone.send(at.CONFIG("general:navdata_demo", sys.argv[1] != "full"))


def wait_until(condition, what, order=None):
    end = time.monotonic() + 15
    while not condition():
        if time.monotonic() > end:
            sys.exit(f"never {what}: {drone.state}")
        if order:
            order()
        time.sleep(0.03)


wait_until(lambda: hasattr(drone.navdata, "demo"), "heard demo navdata")
wait_until(lambda: drone.state.fly_mask and drone.navdata.demo.altitude > 700, "took off", drone.takeoff)
print("has taken off", drone.navdata.demo.altitude, "mm")
end = time.monotonic() + 2
fastest = 0.0
while time.monotonic() < end:
    drone.move(forward=0.3, up=0.4)
    fastest = max(fastest, drone.navdata.demo.vx)
    time.sleep(0.03)
highest = drone.navdata.demo.altitude
wait_until(lambda: not drone.state.fly_mask, "landed", drone.land)
print("has landed; fastest", fastest, "mm/s, highest", highest, "mm")
drone.close()
sys.exit(0 if fastest > 300 and highest > 1000 else "it has not flown as ordered")
