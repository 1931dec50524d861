#!/usr/bin/env python3
"""Prints the states of a fleet's vehicles as they come over the network (docs/fleet.md, "More than one machine").

    pip install eclipse-zenoh
    python3 fleets/watch.py two --connect tcp/192.168.2.1:7447

It only looks on: it tells nothing, so that no vehicle waits for it or keeps away from it. How old a state is it does not
know: the machines' clocks are not the same.
"""

import argparse
import json
import queue

import zenoh


def line(text):
    """A state in a line, or why it is none."""
    try:
        state = json.loads(text)
        if state["version"] != 1:
            return f"a state of version {state['version']}, which this program does not read"
        right, forward = state["place_m"]
        speed = sum(part * part for part in state["velocity_m_s"]) ** 0.5
        return (
            f"{state['vehicle']:<16} {state['presence']:<6} {right:+7.2f} {forward:+7.2f} m"
            f" ± {state['uncertainty_m']:.2f} m  {speed:4.1f} m/s  {state['sent_us'] / 1e6:9.3f} s"
        )
    except (ValueError, KeyError, TypeError) as error:
        return f"no state: {error!r}"


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("fleet", help="its name in FLEET.toml")
    arguments.add_argument("--connect", metavar="ENDPOINT", help="as tcp/192.168.2.1:7447")
    arguments.add_argument("--config", metavar="ZENOH.json5", help="a configuration of Zenoh, for TLS and passwords")
    arguments.add_argument("--count", type=int, default=0, help="end after so many states")
    arguments = arguments.parse_args()
    config = zenoh.Config.from_file(arguments.config) if arguments.config else zenoh.Config()
    if not arguments.config:
        config.insert_json5("scouting/multicast/enabled", "false")
        config.insert_json5("listen/endpoints", "[]")
    if arguments.connect:
        config.insert_json5("connect/endpoints", json.dumps([arguments.connect]))
    states = queue.Queue(maxsize=1000)

    def take(sample):
        try:
            states.put_nowait(sample.payload.to_bytes())
        except queue.Full:
            pass  # Whoever reads the output has stopped; newer ones will come.

    with zenoh.open(config) as session:
        session.declare_subscriber(f"ardrone/{arguments.fleet}/*/state", take)
        number = 0
        while not arguments.count or number < arguments.count:
            print(line(states.get()), flush=True)
            number += 1


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        pass
