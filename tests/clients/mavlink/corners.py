"""Runs the cases of one or more groups against a vehicle that speaks to this port; prints a line for each, and the sum.

usage: corners.py GROUP[,GROUP..] PORT [SECOND_PORT]
"""

import importlib
import sys
import time
import traceback

import flying
from station import Silence, Station


def cases_of(group):
    module = importlib.import_module(f"cases.{group}")
    found = [case for name, case in vars(module).items() if name.startswith("test_")]
    return found, getattr(module, "KEY", None)


def holds(case, station):
    """Runs one case; whether it passed."""
    started_s = time.monotonic()
    try:
        case(station)
        problem = None
    except Exception as error:
        problem = error
    print(f"  {case.__name__} ... {'ok' if problem is None else 'FAILED'} ({time.monotonic() - started_s:.1f} s)", flush=True)
    if problem is not None:
        where = traceback.extract_tb(problem.__traceback__)
        print(f"    {type(problem).__name__}: {problem}")
        print(f"    {' < '.join(f'{at.name}:{at.lineno}' for at in reversed(where))}")
        print(f"    heard: {station.texts(started_s)[-6:]}", flush=True)
    return problem is None


def main():
    groups, ports = sys.argv[1].split(","), [int(port) for port in sys.argv[2:]]
    passed = failed = 0
    for group in groups:
        cases, key = cases_of(group)
        station = Station(ports[0], key=key)
        station.second_port = ports[1] if len(ports) > 1 else None
        try:
            flying.wait_ready(station)
        except Silence as silence:
            print(f"{group}: the vehicle does not get ready: {silence}; {station.texts()[-4:]}")
            return 1
        for case in cases:
            kept = holds(case, station)
            passed, failed = passed + kept, failed + (not kept)
            try:
                flying.rest(station)
            except Exception as error:
                print(f"    and then not at rest: {error}", flush=True)
        station.close()
    print(f"{', '.join(groups)}: {passed} passed, {failed} failed")
    return 1 if failed or not passed else 0


if __name__ == "__main__":
    sys.exit(main())
