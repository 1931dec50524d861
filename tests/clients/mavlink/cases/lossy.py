"""Missions over a network that loses, doubles and reorders a tenth of their messages, in both directions."""

import contextlib
import random
import time

import plans
from plans import check_kept, download, point, same
from station import Silence

SHARE = 0.1
LATE_S = 0.3
TRANSFERS = 15


class Network:
    """What is under way between the station and the vehicle; of MISSION_.. a share is lost, doubled or late."""

    def __init__(self, station, seed):
        self.station, self.chance = station, random.Random(seed)
        self.under_way = []
        self.counts = {"lost": 0, "doubled": 0, "late": 0}
        self.send_bytes, self.note, self.send_what_is_due = station.send_bytes, station.note, station.send_what_is_due

    def copies(self):
        """How late each copy of a message comes."""
        if self.chance.random() < SHARE:
            self.counts["lost"] += 1
            return []
        copies = 2 if self.chance.random() < SHARE else 1
        self.counts["doubled"] += copies - 1
        late = [self.chance.uniform(0.02, LATE_S) if self.chance.random() < SHARE else 0.0 for _ in range(copies)]
        self.counts["late"] += sum(one > 0 for one in late)
        return late

    def pass_on(self, deliver):
        for late_s in self.copies():
            if late_s > 0:
                self.under_way.append((time.monotonic() + late_s, deliver))
            else:
                deliver()

    def deliver_what_is_due(self):
        now_s = time.monotonic()
        due = [one for one in self.under_way if one[0] <= now_s]
        self.under_way = [one for one in self.under_way if one[0] > now_s]
        for _, deliver in sorted(due, key=lambda one: one[0]):
            deliver()
        self.send_what_is_due()

    def note_of_mission(self, message, sender):
        if message.get_type() in ("MISSION_CURRENT", "MISSION_ITEM_REACHED") or not message.get_type().startswith("MISSION_"):
            self.note(message, sender)
        else:
            self.pass_on(lambda: self.note(message, sender))

    def send_of_mission(self, kind, *fields, **named):
        packed = self.station.pack(kind, *fields, **named)
        if kind.startswith("MISSION_"):
            self.pass_on(lambda: self.send_bytes(packed))
        else:
            self.send_bytes(packed)


@contextlib.contextmanager
def bad_network(station, seed):
    network = Network(station, seed)
    station.send, station.note = network.send_of_mission, network.note_of_mission
    station.send_what_is_due = network.deliver_what_is_due
    try:
        yield network
    finally:
        del station.send, station.note, station.send_what_is_due
        station.hear(2 * LATE_S)


def upload_with_repeats(station, items):
    """As QGroundControl: answers what is asked for, and repeats its last message when it hears nothing."""
    last = lambda: plans.count(station, len(items))  # noqa: E731
    heard_s = time.monotonic()
    last()
    silent = 0
    while silent < 6:
        try:
            message = plans.asked_for(station, 0.7, heard_s)
        except Silence:
            silent += 1
            last()
            continue
        silent = 0
        heard_s = message.heard_s + 1e-9
        if message.get_type() == "MISSION_ACK":
            return message.type
        last = lambda seq=message.seq: items[seq].send(station, seq)  # noqa: E731
        last()
    return None


def ask(station, send, kind, where):
    """Sends until the answer comes."""
    since_s = time.monotonic()
    for _ in range(6):
        send()
        with contextlib.suppress(Silence):
            return station.wait(kind, 0.7, where, since_s)
    raise Silence(f"no {kind} after six times")


def download_with_repeats(station):
    ask_count = lambda: station.send("MISSION_REQUEST_LIST", 1, 1, 0)  # noqa: E731
    number = ask(station, ask_count, "MISSION_COUNT", lambda told: told.mission_type == 0).count
    items = []
    for seq in range(number):
        ask_item = lambda seq=seq: station.send("MISSION_REQUEST_INT", 1, 1, seq, 0)  # noqa: E731
        items.append(ask(station, ask_item, "MISSION_ITEM_INT", lambda item, seq=seq: item.seq == seq))
    station.send("MISSION_ACK", 1, 1, 0, 0)
    return items


def mission(mark):
    """One that differs from those with other marks in each item."""
    way = [point(0.1 * (seq + 1), 0.01 * mark, 1.0 + 0.01 * mark) for seq in range(8)]
    return [plans.takeoff(0.9 + 0.01 * mark), *way, plans.land()]


def test_missions_get_through_a_bad_network_both_ways(station):
    counts, results = {}, []
    for seed in range(TRANSFERS):
        items = mission(seed)
        with bad_network(station, seed) as network:
            results.append(upload_with_repeats(station, items))
            read = download_with_repeats(station)
        for name, number in network.counts.items():
            counts[name] = counts.get(name, 0) + number
        if results[-1] == 0:
            check_kept(station, items)
            assert len(read) == len(items) and all(same(*pair) for pair in zip(items, read)), f"seed {seed}: read {read}"
    # What was asked for and not understood is the vehicle's fault, and what a client gives up is the network's.
    assert set(results) <= {0, None, plans.CANCELLED}, results
    assert results.count(0) >= TRANSFERS - 1, results
    assert min(counts.values()) >= TRANSFERS, counts
    print(f"    {results.count(0)} of {TRANSFERS} at once; {counts}")


def test_what_comes_twice_or_late_is_no_error(station):
    items = plans.square()
    asked_s = time.monotonic()

    def answer(sequence):
        if sequence == 2:
            # An item that overtook the one before, and one that was delayed.
            items[3].send(station, 3)
            items[0].send(station, 0)
        items[sequence].send(station, sequence)
        items[sequence].send(station, sequence)

    assert plans.upload(station, items, answer) == 0
    items[1].send(station, 1)
    station.hear(2.5)
    items[2].send(station, 2)
    items[len(items) - 1].send(station, len(items) - 1)
    station.hear(0.5)
    wrong = [ack.type for ack in station.since(asked_s, "MISSION_ACK") if ack.type != 0]
    assert not wrong, f"answered with {wrong}"
    assert len(download(station)) == len(items)
