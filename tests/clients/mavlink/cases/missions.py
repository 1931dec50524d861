"""The mission protocol with everything that can go wrong on the way, and missions flown."""

import math
import time

import flying
import plans
from flying import ARM, HOLD, MISSION, NAN, expect_accepted, near
from plans import Item, check_kept, check_uploads, download, local, point, square, upload

START, PAUSE_OR_GO_ON, SET_CURRENT = 300, 193, 224
OLD = [plans.takeoff(), point(0.5, 0.0, 1.0), plans.land()]


def keep_old(station):
    check_uploads(station, OLD)


def test_a_mission_reads_back_as_it_was_sent(station):
    items = [
        plans.takeoff(1.0), point(0.3, 0.4, 1.1, 2.0), Item(178, 2, 0, 0, 0.0, (1.0, 0.5, -1.0, 0.0)),
        Item(plans.LOITER_TIME, 6, *flying.to_1e7(0.5, 0.5), 1.2, (2.0, 0.0, 0.0, NAN)),
        Item(93, 2, 0, 0, 0.0, (1.0, -1.0, -1.0, -1.0)), Item(plans.WAYPOINT, 0, *flying.to_1e7(1.0, -1.0), 489.0),
        Item(plans.WAYPOINT, 5, *flying.to_1e7(0.0, 0.0), 489.0), Item(plans.RETURN, 2, parameters=(0.0,) * 4),
    ]  # fmt: skip
    check_uploads(station, items)
    check_kept(station, items)


def test_local_frames_read_back_as_they_were_sent(station):
    items = [plans.takeoff(), local(1, 1, 0.5, -1), local(4, 0.5, 1, 1), local(20, 1, -1, -1.2), local(21, 1, 1, 1.2), plans.land()]
    check_uploads(station, items)
    check_kept(station, items)


def test_the_old_request_is_answered_too(station):
    keep_old(station)
    assert len(download(station, request="MISSION_REQUEST")) == len(OLD)


def test_a_mission_is_cleared(station):
    keep_old(station)
    asked_s = time.monotonic()
    station.send("MISSION_CLEAR_ALL", 1, 1, 0)
    assert station.wait("MISSION_ACK", 1, since_s=asked_s).type == 0
    assert download(station) == []
    assert station.wait("MISSION_CURRENT", 2).mission_state in (0, 1)


def test_a_lost_item_is_asked_for_again(station):
    items, seen = square(), []

    def answer(sequence):
        seen.append(sequence)
        if seen.count(sequence) > 1 or sequence % 2:
            items[sequence].send(station, sequence)

    assert upload(station, items, answer) == 0
    assert len(seen) == len(items) + 3, seen
    check_kept(station, items)


def test_doubled_items_count_once(station):
    items = square()

    def answer(sequence):
        for _ in range(3):
            items[sequence].send(station, sequence)

    assert upload(station, items, answer) == 0
    station.hear(0.5)
    check_kept(station, items)


def test_items_out_of_order_do_not_mix_the_mission(station):
    keep_old(station)
    items = square()

    def answer(sequence):
        for other in (sequence + 1, sequence - 1, sequence):
            if 0 <= other < len(items):
                items[other].send(station, other)

    result = upload(station, items, answer)
    check_kept(station, items if result == 0 else OLD)


def test_a_wrong_sequence_does_not_become_an_item(station):
    keep_old(station)
    items = square()
    result = upload(station, items, lambda sequence: items[sequence].send(station, sequence + 100))
    assert result != 0
    check_kept(station, OLD)


def test_an_item_of_another_type_does_not_become_one(station):
    keep_old(station)
    items = square()
    assert upload(station, items, lambda sequence: items[sequence].send(station, sequence, kind=1)) != 0
    check_kept(station, OLD)


def test_a_count_that_cannot_be_is_refused(station):
    keep_old(station)
    asked_s = time.monotonic()
    plans.count(station, 65_535)
    assert station.wait("MISSION_ACK", 1, since_s=asked_s).type != 0
    check_kept(station, OLD)


def test_a_count_of_none_clears(station):
    keep_old(station)
    asked_s = time.monotonic()
    plans.count(station, 0)
    assert station.wait("MISSION_ACK", 1, since_s=asked_s).type == 0
    assert download(station) == []


def test_the_fence_is_read_and_sent_back_and_not_changed_and_rally_points_are_not_there(station):
    keep_old(station)
    fence, = download(station, 1)
    # A circle of inclusion around the start.
    assert (fence.command, fence.mission_type, fence.x, fence.y) == (5003, 1, *flying.to_1e7(0.0, 0.0)), fence
    near(fence.param1, 10.0, 1e-6, "the radius")
    assert download(station, 2) == []
    # Sent back, it is the same; a plan without one changes nothing.
    own = Item(fence.command, fence.frame, fence.x, fence.y, fence.z, (fence.param1, 0.0, 0.0, 0.0), kind=1)
    assert upload(station, [own], kind=1) == 0
    assert upload(station, [], kind=1) == 0
    asked_s = time.monotonic()
    smaller = Item(fence.command, fence.frame, fence.x, fence.y, fence.z, (4.0, 0.0, 0.0, 0.0), kind=1)
    assert upload(station, [smaller], kind=1) == plans.DENIED
    station.hear(0.3)
    assert any("fence not changed" in text for text in station.texts(asked_s)), station.texts(asked_s)
    for kind, answer in ((1, plans.DENIED), (2, plans.UNSUPPORTED)):
        asked_s = time.monotonic()
        plans.count(station, 3, kind)
        refused = station.wait("MISSION_ACK", 1, since_s=asked_s)
        assert (refused.type, refused.mission_type) == (answer, kind), refused
    check_kept(station, OLD)


def test_partial_lists_are_refused(station):
    asked_s = time.monotonic()
    station.send("MISSION_WRITE_PARTIAL_LIST", 1, 1, 0, 1, 0)
    assert station.wait("MISSION_ACK", 1, since_s=asked_s).type == plans.UNSUPPORTED


def test_an_upload_cancelled_half_way_keeps_the_old_mission(station):
    keep_old(station)
    items = square()
    asked_s = time.monotonic()
    plans.count(station, len(items))
    for sequence in range(2):
        station.wait("MISSION_REQUEST_INT", 1, lambda ask: ask.seq == sequence, asked_s)
        items[sequence].send(station, sequence)
    station.wait("MISSION_REQUEST_INT", 1, lambda ask: ask.seq == 2, asked_s)
    station.send("MISSION_ACK", 1, 1, plans.CANCELLED, 0)
    cancelled_s = time.monotonic() + 0.1
    station.hear(1)
    assert not station.since(cancelled_s, "MISSION_REQUEST_INT"), "it asks on after the end"
    check_kept(station, OLD)


def test_an_upload_that_falls_silent_keeps_the_old_mission(station):
    keep_old(station)
    items = square()
    started_s = time.monotonic()
    result = upload(station, items, lambda sequence: sequence < 2 and items[sequence].send(station, sequence))
    assert result == plans.CANCELLED, result
    assert time.monotonic() - started_s < 4
    check_kept(station, OLD)


def test_a_second_upload_replaces_the_first_one(station):
    items = square()
    asked_s = time.monotonic()
    plans.count(station, 20)
    station.wait("MISSION_REQUEST_INT", 1, since_s=asked_s)
    check_uploads(station, items)
    check_kept(station, items)


def refused_item(station, item, wanted=None):
    """Item 2 of a mission is this one: refused, named, and the old mission is still there."""
    asked_s = time.monotonic()
    items = [plans.takeoff(), point(0.5, 0.0, 1.0), item, plans.land()]
    result = upload(station, items)
    station.hear(0.3)
    texts = station.texts(asked_s)
    assert result != 0, f"{item} was accepted"
    assert wanted is None or result in wanted, f"{item} was refused with {result}"
    assert any("2" in text for text in texts), f"no text names item 2: {texts}"


def test_a_bad_item_is_refused_by_its_number(station):
    keep_old(station)
    invalid = (10, 11, 12, 1, 14, 5)
    near_by = flying.to_1e7(0.5, 0.5)
    largest = 2**31 - 1
    for item, wanted in (
        (point(30, 0, 1.0), invalid), (point(0, -30, 1.0), invalid), (point(0.5, 0.5, 9.0), invalid),
        (point(0.5, 0.5, 0.05), invalid), (point(0.5, 0.5, -2), invalid), (point(0.5, 0.5, math.inf), invalid),
        # Both would mean: where it is.
        (Item(plans.WAYPOINT, 3, largest, 0, 1.0), invalid), (Item(plans.WAYPOINT, 3, -largest, largest, 1.0), invalid),
        (Item(plans.WAYPOINT, 10, *near_by, 1.0), (plans.UNSUPPORTED_FRAME,)),
        (Item(plans.WAYPOINT, 99, *near_by, 1.0), (plans.UNSUPPORTED_FRAME,)),
        (Item(201, 3, *near_by, 1.0), (plans.UNSUPPORTED,)), (Item(60_000, 3, *near_by, 1.0), (plans.UNSUPPORTED,)),
        (Item(177, 2, parameters=(0.0, 5.0, 0.0, 0.0)), (plans.UNSUPPORTED,)),
        (Item(plans.LOITER_TIME, 3, *near_by, 1.0, (math.inf, 0.0, 0.0, NAN)), None),
        (Item(plans.WAYPOINT, 3, *near_by, 1.0, (-math.inf, 0.0, 0.0, NAN)), None),
        (local(1, 30, 0, -1), invalid), (local(1, 0, 0, 1), invalid), (local(21, 0, 0, 9), invalid),
    ):  # fmt: skip
        refused_item(station, item, wanted)
    check_kept(station, OLD)


def test_home_as_the_first_item_is_not_flown_to(station):
    """MAVProxy sends home as item 0, with its altitude above the sea."""
    usual = station.codec.srcComponent
    station.codec.srcComponent = 230
    try:
        home = Item(plans.WAYPOINT, 0, *flying.to_1e7(0, 0), 488.0, (0.0,) * 4, current=1)
        check_uploads(station, [home, *square()])
    finally:
        station.codec.srcComponent = usual


def start_mission(station):
    asked_s = time.monotonic()
    expect_accepted(station.command(START, 0, 0), "mission start")
    flying.wait_mode(station, MISSION, 12, asked_s)


def wait_reached(station, sequence, since_s, within_s=25):
    station.wait("MISSION_ITEM_REACHED", within_s, lambda reached: reached.seq == sequence, since_s)


def test_a_mission_needs_arming_or_waits_for_it(station):
    flying.wait_ready(station)
    station.send("MISSION_CLEAR_ALL", 1, 1, 0)
    station.hear(0.5)
    flying.arm(station)
    assert station.command(START) not in (0, 5), "a mission that is not there was started"
    station.hear(1)
    assert flying.on_the_ground(station)
    station.command(ARM, 0)


def test_a_square_is_flown_paused_and_resumed(station):
    flying.wait_ready(station)
    items = square()
    check_uploads(station, items)
    flying.arm(station)
    began_s = time.monotonic()
    start_mission(station)
    wait_reached(station, 1, began_s)
    near(math.dist(flying.place(station), (1, 0, 1)), 0, 0.5, "distance from the first corner")
    pauses_and_goes_on(station)
    wait_reached(station, 3, began_s)
    near(math.dist(flying.place(station), (0, 1, 1)), 0, 0.5, "distance from the third corner")
    wait_reached(station, 4, began_s)
    flying.wait_landed(station, 30)
    reached = [message.seq for message in station.since(began_s, "MISSION_ITEM_REACHED")]
    assert [one for one in reached if 1 <= one <= 4] == [1, 2, 3, 4], reached
    current = [message.seq for message in station.since(began_s, "MISSION_CURRENT")]
    assert current == sorted(current), current
    check_kept(station, items)


def pauses_and_goes_on(station):
    asked_s = time.monotonic()
    expect_accepted(station.command(PAUSE_OR_GO_ON, 0), "pause")
    flying.wait_mode(station, HOLD, 1, asked_s)
    station.wait("MISSION_CURRENT", 2, lambda told: told.mission_state == 4, asked_s)
    station.hear(1)
    before = flying.place(station)
    station.hear(2)
    assert math.dist(before, flying.place(station)) < 0.3, "it moves while it is paused"
    asked_s = time.monotonic()
    expect_accepted(station.command(PAUSE_OR_GO_ON, 1), "resume")
    flying.wait_mode(station, MISSION, 1, asked_s)
    station.wait("MISSION_CURRENT", 2, lambda told: told.mission_state == 3, asked_s)


def test_a_mission_in_local_frames_is_flown(station):
    """North-east-down, east-north-up, and forward-left-up of the start lead to the same places."""
    flying.wait_ready(station)
    places = ((1.0, 0.5, 1.0), (-0.5, 1.0, 1.2), (0.5, -0.5, 1.0))
    (n0, e0, h0), (n1, e1, h1), (n2, e2, h2) = places
    items = [plans.takeoff(), local(1, n0, e0, -h0), local(4, e1, n1, h1), local(21, n2, -e2, h2), plans.land()]
    check_uploads(station, items)
    flying.arm(station)
    began_s = time.monotonic()
    start_mission(station)
    for sequence, wanted in enumerate(places, 1):
        wait_reached(station, sequence, began_s)
        near(math.dist(flying.place(station), wanted), 0, 0.5, f"distance from item {sequence}")
    flying.wait_landed(station, 30)


def test_the_current_item_can_be_set(station):
    flying.wait_ready(station)
    check_uploads(station, [plans.takeoff(), point(1, 0, 1), point(1, 1, 1), point(0, 0, 1), plans.land()])
    flying.take_off(station)
    assert station.command(SET_CURRENT, 77) not in (0, 5), "item 77 was accepted"
    asked_s = time.monotonic()
    expect_accepted(station.command(SET_CURRENT, 3), "item 3")
    assert station.wait("MISSION_CURRENT", 1, since_s=asked_s).seq == 3
    start_mission(station)
    wait_reached(station, 3, asked_s)
    reached = [message.seq for message in station.since(asked_s, "MISSION_ITEM_REACHED")]
    assert 1 not in reached and 2 not in reached, reached
    flying.wait_landed(station, 30)
