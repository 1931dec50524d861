use std::collections::VecDeque;

use autopilot::plan::{Border, FlightLimits};
use proptest::prelude::*;

use super::*;
use crate::mission::command;
use crate::mission::tests::item;
use crate::place::Origin;

const RULES: Rules = Rules {
    origin: Origin {
        latitude_deg: 47.397_742,
        longitude_deg: 8.545_594,
        altitude_m: 488.0,
        heading_deg: 0.0,
    },
    fence: FlightLimits::new(Border::circle(10.0), 0.3, 3.0),
    max_speed_m_s: 2.2,
};
const QGC: Partner = Partner { system: 255, component: 190 };
const OTHER: Partner = Partner { system: 245, component: 190 };

/// A mission that can be told from others by each of its items.
fn mission(mark: u8, count: u16) -> Vec<Item> {
    let way_point = |seq| Item {
        x: i32::from(mark) * 1000,
        y: i32::from(seq) * 10,
        z: 1.5,
        param4: f32::from_bits(0x7fc0_1234),
        ..item(seq, 20, command::NAV_WAYPOINT)
    };
    (0..count).map(|seq| Item { z: -1.5, ..way_point(seq) }).collect()
}

fn count(count: u16) -> Received {
    Received::Count { count, mission_type: MISSION }
}

fn ack(result: MavMissionResult) -> Message {
    Message::Ack { result, mission_type: MISSION }
}

/// A vehicle and its clock.
#[derive(Default)]
struct Bench {
    transfer: Transfer,
    now: Duration,
}

impl Bench {
    fn from(&mut self, from: Partner, received: Received) -> (Vec<Message>, Option<Event>) {
        let handled = self.transfer.handle(self.now, from, &received, &RULES);
        (handled.message.into_iter().collect(), handled.event)
    }

    #[track_caller]
    fn assert(&mut self, from: Partner, received: Received, expected: &[Message]) {
        assert_eq!(self.from(from, received).0, expected);
    }

    fn after(&mut self, ms: u64) -> (Vec<Message>, Option<Event>) {
        self.now += Duration::from_millis(ms);
        let handled = self.transfer.tick(self.now);
        (handled.message.into_iter().collect(), handled.event)
    }

    fn upload(&mut self, items: &[Item]) -> (Vec<Message>, Option<Event>) {
        let number = u16::try_from(items.len()).unwrap();
        let mut last = self.from(QGC, count(number));
        for item in items {
            assert_eq!(last.0, [Message::Request { seq: item.seq, mission_type: MISSION }]);
            last = self.from(QGC, Received::Item(*item));
        }
        last
    }
}

#[test]
fn a_mission_reads_back_as_it_was_sent() {
    let mut bench = Bench::default();
    let sent = mission(1, 3);
    assert_eq!(bench.transfer.id(), 0);
    assert_eq!(bench.upload(&sent), (vec![ack(result::ACCEPTED)], Some(Event::Accepted)));
    assert_eq!((bench.transfer.items(), bench.transfer.id()), (&sent[..], 1));
    assert!(bench.transfer.translated().steps_from(0, false).len() > 3);
    let list = Received::RequestList { mission_type: MISSION };
    bench.assert(QGC, list, &[Message::Count { count: 3, mission_type: MISSION }]);
    for item in sent {
        let request = Received::Request { seq: item.seq, mission_type: MISSION };
        bench.assert(QGC, request, &[Message::Item(item)]);
    }
    let behind = Received::Request { seq: 3, mission_type: MISSION };
    bench.assert(QGC, behind, &[ack(result::INVALID_SEQUENCE)]);
    bench.assert(QGC, Received::Ack { result: 0, mission_type: MISSION }, &[]);
}

#[test]
fn a_silent_partner_is_asked_again_and_then_given_up() {
    let mut bench = Bench::default();
    bench.upload(&mission(1, 2));
    bench.from(QGC, count(3));
    bench.from(QGC, Received::Item(mission(2, 3)[0]));
    assert_eq!(bench.after(249), (vec![], None));
    assert_eq!(bench.after(1), (vec![Message::Request { seq: 1, mission_type: MISSION }], None));
    for _ in 1..5 {
        assert_eq!(
            bench.after(250),
            (vec![Message::Request { seq: 1, mission_type: MISSION }], None)
        );
    }
    let cancelled = (vec![ack(result::OPERATION_CANCELLED)], Some(Event::Cancelled));
    assert_eq!(bench.after(250), cancelled);
    assert_eq!(bench.after(10_000), (vec![], None));
    assert_eq!(bench.transfer.items(), mission(1, 2));
    assert_eq!(bench.transfer.uploading(), None);
    // What comes then is no part of anything.
    let late = Received::Item(mission(2, 3)[1]);
    bench.assert(QGC, late, &[ack(result::INVALID_SEQUENCE)]);
}

#[test]
fn each_item_has_its_own_repeats() {
    let mut bench = Bench::default();
    bench.from(QGC, count(2));
    for _ in 0..5 {
        bench.after(250);
    }
    bench.from(QGC, Received::Item(mission(1, 2)[0]));
    for _ in 0..5 {
        assert_eq!(
            bench.after(250),
            (vec![Message::Request { seq: 1, mission_type: MISSION }], None)
        );
    }
}

#[test]
fn only_the_partner_takes_part() {
    let mut bench = Bench::default();
    bench.upload(&mission(1, 2));
    bench.from(QGC, count(2));
    let denied = [ack(result::DENIED)];
    for intruder in [OTHER, Partner { component: 1, ..QGC }] {
        bench.assert(intruder, count(1), &denied);
        bench.assert(intruder, count(0), &denied);
        bench.assert(intruder, Received::Item(mission(3, 2)[0]), &denied);
        bench.assert(intruder, Received::ClearAll { mission_type: MISSION }, &denied);
        bench.assert(intruder, Received::PartialList { mission_type: MISSION }, &denied);
        bench.assert(intruder, Received::Ack { result: 15, mission_type: MISSION }, &[]);
    }
    // Reading the stored mission harms nobody.
    let list = Received::RequestList { mission_type: MISSION };
    bench.assert(OTHER, list, &[Message::Count { count: 2, mission_type: MISSION }]);
    let request = Received::Request { seq: 1, mission_type: MISSION };
    bench.assert(OTHER, request, &[Message::Item(mission(1, 2)[1])]);
    for item in mission(2, 2) {
        bench.from(QGC, Received::Item(item));
    }
    assert_eq!(bench.transfer.items(), mission(2, 2));
    // The rest of another mission is not sent.
    bench.assert(OTHER, request, &[ack(result::OPERATION_CANCELLED)]);
    bench.assert(OTHER, list, &[Message::Count { count: 2, mission_type: MISSION }]);
    bench.assert(OTHER, request, &[Message::Item(mission(2, 2)[1])]);
}

#[test]
fn a_new_count_begins_anew() {
    let mut bench = Bench::default();
    bench.from(QGC, count(3));
    bench.from(QGC, Received::Item(mission(1, 3)[0]));
    bench.assert(QGC, count(2), &[Message::Request { seq: 0, mission_type: MISSION }]);
    // The answer to the request before is still under way, which is no reason to fail.
    let late = Received::Item(mission(1, 3)[1]);
    bench.assert(QGC, late, &[]);
    for item in mission(2, 2) {
        bench.from(QGC, Received::Item(item));
    }
    assert_eq!(bench.transfer.items(), mission(2, 2));
}

#[test]
fn an_item_of_a_mission_given_up_does_not_stay() {
    let mut bench = Bench::default();
    bench.from(QGC, count(3));
    bench.assert(QGC, count(2), &[Message::Request { seq: 0, mission_type: MISSION }]);
    let late = Received::Item(mission(1, 3)[0]);
    bench.assert(QGC, late, &[Message::Request { seq: 1, mission_type: MISSION }]);
    let [first, second] = [0, 1].map(|seq| Received::Item(mission(2, 2)[seq]));
    bench.assert(QGC, first, &[Message::Request { seq: 0, mission_type: MISSION }]);
    bench.assert(QGC, first, &[Message::Request { seq: 1, mission_type: MISSION }]);
    bench.assert(QGC, second, &[ack(result::ACCEPTED)]);
    assert_eq!(bench.transfer.items(), mission(2, 2));
}

#[test]
fn items_that_come_twice_late_or_too_early_are_no_error() {
    let mut bench = Bench::default();
    let [first, second, third] = [0, 1, 2].map(|seq| Received::Item(mission(1, 3)[seq]));
    bench.from(QGC, count(3));
    bench.assert(QGC, second, &[]);
    // What is missing is asked for again, as if nothing had come.
    assert_eq!(bench.after(250), (vec![Message::Request { seq: 0, mission_type: MISSION }], None));
    bench.assert(QGC, first, &[Message::Request { seq: 1, mission_type: MISSION }]);
    bench.assert(QGC, first, &[]);
    bench.assert(QGC, third, &[]);
    assert_eq!(bench.after(250), (vec![Message::Request { seq: 1, mission_type: MISSION }], None));
    bench.assert(QGC, second, &[Message::Request { seq: 2, mission_type: MISSION }]);
    bench.assert(QGC, first, &[]);
    bench.assert(QGC, second, &[]);
    bench.assert(QGC, third, &[ack(result::ACCEPTED)]);
    assert_eq!(bench.transfer.items(), mission(1, 3));
    // Copies of it, however late; one that belongs to nothing is an error.
    bench.after(60_000);
    for item in [first, second, third] {
        bench.assert(QGC, item, &[]);
    }
    bench.assert(QGC, Received::Item(mission(2, 3)[1]), &[ack(result::INVALID_SEQUENCE)]);
}

#[test]
fn late_items_of_a_mission_that_was_removed_are_no_error() {
    let mut bench = Bench::default();
    bench.upload(&mission(1, 2));
    bench.from(QGC, Received::ClearAll { mission_type: MISSION });
    for item in mission(1, 2) {
        bench.assert(QGC, Received::Item(item), &[]);
    }
}

#[test]
fn the_beginning_of_an_upload_that_comes_twice_is_given_up_without_a_word() {
    let mut bench = Bench::default();
    bench.upload(&mission(1, 2));
    bench.assert(QGC, count(2), &[Message::Request { seq: 0, mission_type: MISSION }]);
    for _ in 0..5 {
        assert_eq!(bench.after(250).0, [Message::Request { seq: 0, mission_type: MISSION }]);
    }
    assert_eq!(bench.after(250), (vec![], None));
    assert_eq!((bench.transfer.uploading(), bench.transfer.items()), (None, &mission(1, 2)[..]));
    // One that was meant is as any other.
    bench.upload(&mission(1, 2));
    assert_eq!(bench.upload(&mission(2, 2)).1, Some(Event::Accepted));
}

#[test]
fn a_partner_that_counts_otherwise_is_given_up_as_a_silent_one_is() {
    let mut bench = Bench::default();
    bench.from(QGC, count(3));
    for _ in 0..5 {
        bench.assert(QGC, Received::Item(mission(1, 3)[2]), &[]);
        assert_eq!(bench.after(250).0, [Message::Request { seq: 0, mission_type: MISSION }]);
    }
    assert_eq!(bench.after(250).1, Some(Event::Cancelled));
    // Its item, late, has the same answer.
    bench.assert(QGC, Received::Item(mission(1, 3)[0]), &[ack(result::OPERATION_CANCELLED)]);
}

/// QGroundControl blames the item that was asked for last.
#[test]
fn an_upload_is_refused_at_the_item_that_is_wrong() {
    let mut bench = Bench::default();
    bench.upload(&mission(1, 2));
    let items: Vec<_> = mission(2, 5)
        .into_iter()
        .map(|item| if item.seq == 2 { Item { z: -9.0, ..item } } else { item })
        .collect();
    bench.from(QGC, count(5));
    bench.assert(
        QGC,
        Received::Item(items[0]),
        &[Message::Request { seq: 1, mission_type: MISSION }],
    );
    bench.assert(
        QGC,
        Received::Item(items[1]),
        &[Message::Request { seq: 2, mission_type: MISSION }],
    );
    let (messages, event) = bench.from(QGC, Received::Item(items[2]));
    assert_eq!(messages, [ack(result::INVALID_PARAM7)]);
    let Some(Event::Refused(problem)) = event else { panic!("not refused") };
    assert_eq!(problem.item, 2);
    assert!(problem.reason.starts_with("item 2 (Waypoint): 9.00 m"), "{problem}");
    assert_eq!((bench.transfer.uploading(), bench.transfer.items()), (None, &mission(1, 2)[..]));
    // Copies that are under way change nothing, and the answer is repeated if it was lost.
    bench.assert(QGC, Received::Item(items[1]), &[]);
    bench.assert(QGC, Received::Item(items[2]), &[ack(result::INVALID_PARAM7)]);
    assert_eq!(bench.after(1000), (vec![], None));
}

#[test]
fn a_last_item_is_acknowledged_again() {
    let mut bench = Bench::default();
    bench.upload(&mission(1, 2));
    let [first, last] = [0, 1].map(|seq| Received::Item(mission(1, 2)[seq]));
    bench.after(2000);
    bench.assert(QGC, last, &[ack(result::ACCEPTED)]);
    bench.assert(QGC, first, &[]);
    bench.assert(OTHER, last, &[ack(result::INVALID_SEQUENCE)]);
    bench.after(1);
    bench.assert(QGC, last, &[]);
    // The same result, if it was a refusal.
    let high = Item { z: -3.5, ..mission(2, 1)[0] };
    let (messages, event) = bench.upload(&[high]);
    assert_eq!(messages, [ack(result::INVALID_PARAM7)]);
    let Some(Event::Refused(problem)) = event else { panic!("not refused") };
    assert_eq!((problem.item, problem.result), (0, result::INVALID_PARAM7));
    bench.assert(QGC, Received::Item(high), &[ack(result::INVALID_PARAM7)]);
    assert_eq!(bench.transfer.items(), mission(1, 2));
}

#[test]
fn the_partner_can_give_up() {
    let mut bench = Bench::default();
    bench.upload(&mission(1, 2));
    bench.from(QGC, count(2));
    bench.from(QGC, Received::Item(mission(2, 2)[0]));
    // The end of a download before is none.
    assert_eq!(bench.from(QGC, Received::Ack { result: 0, mission_type: MISSION }), (vec![], None));
    let cancel = Received::Ack { result: result::OPERATION_CANCELLED as u8, mission_type: MISSION };
    assert_eq!(bench.from(QGC, cancel), (vec![], Some(Event::Cancelled)));
    assert_eq!(bench.from(QGC, cancel), (vec![], None));
    assert_eq!(bench.after(1000), (vec![], None));
    assert_eq!(bench.transfer.items(), mission(1, 2));
    assert_eq!(bench.upload(&mission(3, 1)).1, Some(Event::Accepted));
}

#[test]
fn a_mission_is_cleared() {
    for clear in [
        Received::ClearAll { mission_type: MISSION },
        Received::ClearAll { mission_type: ALL },
        count(0),
    ] {
        let mut bench = Bench::default();
        bench.upload(&mission(1, 2));
        bench.from(QGC, count(5));
        let (messages, event) = bench.from(QGC, clear);
        let (Received::ClearAll { mission_type } | Received::Count { mission_type, .. }) = clear
        else {
            panic!("clears nothing")
        };
        assert_eq!(messages, [Message::Ack { result: result::ACCEPTED, mission_type }]);
        assert_eq!(event, Some(Event::Cleared));
        assert!(bench.transfer.items().is_empty() && bench.transfer.uploading().is_none());
        assert_eq!(bench.transfer.id(), 2);
        assert!(bench.transfer.translated().steps_from(0, false).is_empty());
        assert_eq!(bench.after(1000), (vec![], None));
    }
}

#[test]
fn too_large_a_mission_is_refused() {
    let mut bench = Bench::default();
    bench.upload(&mission(1, 2));
    for number in [201, u16::MAX] {
        let (messages, event) = bench.from(QGC, count(number));
        assert_eq!(messages, [ack(result::NO_SPACE)]);
        assert!(matches!(event, Some(Event::Refused(problem)) if problem.item == 200));
    }
    assert_eq!(bench.transfer.items(), mission(1, 2));
    assert_eq!(bench.upload(&mission(0, 200)).1, Some(Event::Accepted));
}

#[test]
fn the_fence_is_read_and_sent_back_and_not_changed() {
    let mut bench = Bench::default();
    bench.upload(&mission(1, 2));
    let count = Message::Count { count: 1, mission_type: FENCE };
    bench.assert(QGC, Received::RequestList { mission_type: FENCE }, &[count]);
    let item = fence::item(0, &RULES).unwrap();
    let asked = |seq| Received::Request { seq, mission_type: FENCE };
    bench.assert(QGC, asked(0), &[Message::Item(item)]);
    let ack = |result| [Message::Ack { result, mission_type: FENCE }];
    bench.assert(QGC, asked(1), &ack(result::INVALID_SEQUENCE));
    // A plan without one changes nothing, and the vehicle's own may be sent back.
    bench.assert(QGC, Received::Count { count: 0, mission_type: FENCE }, &ack(result::ACCEPTED));
    let asked = Message::Request { seq: 0, mission_type: FENCE };
    bench.assert(QGC, Received::Count { count: 1, mission_type: FENCE }, &[asked]);
    bench.now += REPEAT_AFTER;
    assert_eq!(bench.transfer.tick_fence(bench.now).message, Some(asked));
    let moved = Item { x: item.x + 1, param1: item.param1 + 0.01, ..item };
    let (messages, event) = bench.from(QGC, Received::Item(moved));
    assert_eq!((&messages[..], event), (&ack(result::ACCEPTED)[..], Some(Event::FenceSame)));
    // The acknowledgement was lost.
    bench.assert(QGC, Received::Item(item), &ack(result::ACCEPTED));
    let denied = ack(result::DENIED);
    for other in [
        Item { param1: item.param1 + 1.0, ..item },
        Item { x: item.x + 100, ..item },
        Item { command: 5004, ..item },
        Item { param1: f32::NAN, ..item },
    ] {
        bench.assert(QGC, Received::Count { count: 1, mission_type: FENCE }, &[asked]);
        let (messages, event) = bench.from(QGC, Received::Item(other));
        assert_eq!((&messages[..], event), (&denied[..], Some(Event::FenceStays)), "{other:?}");
    }
    bench.assert(QGC, Received::Item(Item { param1: 3.0, ..item }), &[]);
    bench.assert(QGC, Received::Count { count: 3, mission_type: FENCE }, &denied);
    bench.assert(QGC, Received::ClearAll { mission_type: FENCE }, &denied);
    // Whoever falls silent is given up.
    bench.from(QGC, Received::Count { count: 1, mission_type: FENCE });
    for _ in 0..6 {
        bench.now += REPEAT_AFTER;
        bench.transfer.tick_fence(bench.now);
    }
    assert_eq!(bench.transfer.sending_fence(), None);
    assert_eq!(fence::item(0, &RULES), Some(item));
    assert_eq!(bench.transfer.items(), mission(1, 2));
}

#[test]
fn there_are_only_missions() {
    let mut bench = Bench::default();
    bench.upload(&mission(1, 2));
    for mission_type in [RALLY, 7, ALL] {
        let unsupported = [Message::Ack { result: result::UNSUPPORTED, mission_type }];
        let list = match mission_type {
            RALLY => [Message::Count { count: 0, mission_type }],
            _ => unsupported,
        };
        bench.assert(QGC, Received::RequestList { mission_type }, &list);
        bench.assert(QGC, Received::Count { count: 1, mission_type }, &unsupported);
        bench.assert(QGC, Received::Request { seq: 0, mission_type }, &unsupported);
        bench.assert(QGC, Received::PartialList { mission_type }, &unsupported);
        let foreign = Received::Item(Item { mission_type, ..mission(1, 1)[0] });
        bench.assert(QGC, foreign, &unsupported);
        if mission_type != ALL {
            bench.assert(QGC, Received::ClearAll { mission_type }, &unsupported);
        }
    }
    bench.assert(QGC, Received::PartialList { mission_type: MISSION }, &[ack(result::UNSUPPORTED)]);
    assert_eq!(bench.transfer.items(), mission(1, 2));
}

#[test]
fn another_origin_changes_what_items_mean() {
    let mut bench = Bench::default();
    let global = Item { x: 473_977_420, y: 85_455_940, z: 1.0, ..item(0, 3, 16) };
    bench.upload(&[global]);
    let before = bench.transfer.translated().clone();
    let far = Origin { latitude_deg: 10.0, ..RULES.origin };
    assert!(bench.transfer.translate_again(&Rules { origin: far, ..RULES }).is_err());
    assert_eq!(bench.transfer.translated(), &before);
    let near = Origin { latitude_deg: 47.397_7, ..RULES.origin };
    assert!(bench.transfer.translate_again(&Rules { origin: near, ..RULES }).is_ok());
    assert_ne!(bench.transfer.translated(), &before);
}

#[test]
fn many_readers_make_room_for_each_other() {
    let mut bench = Bench::default();
    bench.upload(&mission(1, 1));
    for component in 0..20 {
        let reader = Partner { system: 9, component };
        let list = Received::RequestList { mission_type: MISSION };
        bench.assert(reader, list, &[Message::Count { count: 1, mission_type: MISSION }]);
    }
    assert_eq!(bench.transfer.downloads.iter().flatten().count(), DOWNLOADS);
}

/// Numbers from a seed.
struct Chance(u64);

impl Chance {
    /// Below `end`.
    fn below(&mut self, end: u64) -> u64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % end
    }

    fn percent(&mut self, percent: u64) -> bool {
        self.below(100) < percent
    }
}

/// A network that loses, doubles and delays; delayed messages change their order.
struct Network<T> {
    lost_percent: u64,
    doubled_percent: u64,
    late_percent: u64,
    /// Messages by the millisecond at which they arrive.
    under_way: VecDeque<(u64, T)>,
}

impl<T: Copy> Network<T> {
    fn new(lost_percent: u64, doubled_percent: u64, late_percent: u64) -> Self {
        Self { lost_percent, doubled_percent, late_percent, under_way: VecDeque::new() }
    }

    fn send(&mut self, now_ms: u64, message: T, chance: &mut Chance) {
        let copies = if chance.percent(self.doubled_percent) { 2 } else { 1 };
        for _ in 0..copies {
            if !chance.percent(self.lost_percent) {
                let late_ms = if chance.percent(self.late_percent) { chance.below(300) } else { 5 };
                self.under_way.push_back((now_ms + late_ms, message));
            }
        }
    }

    fn arrived(&mut self, now_ms: u64) -> Vec<T> {
        let (arrived, under_way) = self.under_way.iter().partition(|(at_ms, _)| *at_ms <= now_ms);
        self.under_way = under_way;
        let arrived: VecDeque<(u64, T)> = arrived;
        arrived.into_iter().map(|(_, message)| message).collect()
    }
}

/// Uploads as QGroundControl and pymavlink do: answers requests, and repeats its last message when it hears nothing.
struct Client {
    items: Vec<Item>,
    last: Received,
    heard_ms: u64,
    retries: u8,
    result: Option<u8>,
}

impl Client {
    fn new(items: Vec<Item>, now_ms: u64) -> Self {
        let last = count(u16::try_from(items.len()).unwrap());
        Self { items, last, heard_ms: now_ms, retries: 0, result: None }
    }

    fn hear(&mut self, now_ms: u64, message: Message) -> Option<Received> {
        self.heard_ms = now_ms;
        self.retries = 0;
        match message {
            Message::Request { seq, .. } => {
                self.last = Received::Item(*self.items.get(usize::from(seq))?);
                Some(self.last)
            }
            Message::Ack { result, .. } => {
                self.result = Some(result as u8);
                None
            }
            Message::Count { .. } | Message::Item(_) => None,
        }
    }

    fn wait(&mut self, now_ms: u64) -> Option<Received> {
        if now_ms < self.heard_ms + 400 {
            return None;
        }
        self.heard_ms = now_ms;
        self.retries += 1;
        if self.retries > 5 {
            self.result = Some(u8::MAX);
            return None;
        }
        Some(self.last)
    }
}

/// One upload over such a network, while others send `foreign` messages. Returns the client's result.
fn upload_over(
    transfer: &mut Transfer,
    items: &[Item],
    (up, down): (&mut Network<Received>, &mut Network<Message>),
    now_ms: &mut u64,
    chance: &mut Chance,
    mut foreign: impl FnMut(&mut Chance) -> Option<(Partner, Received)>,
) -> u8 {
    let before = transfer.items().to_vec();
    let mut client = Client::new(items.to_vec(), *now_ms);
    up.send(*now_ms, client.last, chance);
    let mut result = None;
    // The end of what is under way is part of it, too.
    let mut quiet_ms = 0;
    while quiet_ms < 2500 {
        *now_ms += 10;
        let now = Duration::from_millis(*now_ms);
        let mut handled = vec![transfer.tick(now)];
        for received in up.arrived(*now_ms) {
            handled.push(transfer.handle(now, QGC, &received, &RULES));
        }
        if let Some((from, received)) = foreign(chance) {
            let foreign = transfer.handle(now, from, &received, &RULES);
            assert_eq!(foreign.event, None);
        }
        for message in handled.iter().flat_map(|handled| &handled.message) {
            down.send(*now_ms, *message, chance);
        }
        let stored = transfer.items();
        assert!(stored == before || stored == items, "a mixture");
        for message in down.arrived(*now_ms) {
            if result.is_none() {
                let answer = client.hear(*now_ms, message);
                if let Some(answer) = answer {
                    up.send(*now_ms, answer, chance);
                }
            }
        }
        if result.is_none() {
            let again = client.wait(*now_ms);
            if let Some(again) = again {
                up.send(*now_ms, again, chance);
            }
            result = client.result;
        } else {
            quiet_ms += 10;
        }
    }
    assert_eq!(transfer.uploading(), None);
    result.unwrap_or(u8::MAX)
}

#[test]
fn a_client_succeeds_although_three_of_ten_messages_are_lost() {
    let mut succeeded_at_once = 0;
    for seed in 0..100 {
        let mut chance = Chance(seed);
        let (mut transfer, mut now_ms) = (Transfer::default(), 0);
        let items = mission(1, 5);
        // As a person presses the button again.
        let success = (0..5).position(|_| {
            let (mut up, mut down) = (Network::new(30, 0, 0), Network::new(30, 0, 0));
            let networks = (&mut up, &mut down);
            let result =
                upload_over(&mut transfer, &items, networks, &mut now_ms, &mut chance, |_| None);
            result == result::ACCEPTED as u8
        });
        assert!(success.is_some(), "seed {seed}");
        assert_eq!(transfer.items(), items);
        succeeded_at_once += u32::from(success == Some(0));
    }
    assert!(succeeded_at_once >= 90, "{succeeded_at_once} of 100");
}

fn any_received() -> impl Strategy<Value = (Partner, Received)> {
    let from = prop_oneof![3 => Just(QGC), 1 => Just(OTHER)];
    let mission_type = || prop_oneof![8 => Just(MISSION), 1 => Just(ALL), 1 => any::<u8>()];
    let number = || prop_oneof![8 => 0_u16..4, 1 => any::<u16>()];
    let items = (0_u8..3, 0_u16..4, mission_type()).prop_map(|(mark, seq, mission_type)| {
        Received::Item(Item { mission_type, ..mission(mark, 4)[usize::from(seq)] })
    });
    let received = prop_oneof![
        3 => (number(), mission_type())
            .prop_map(|(count, mission_type)| Received::Count { count, mission_type }),
        12 => items,
        1 => mission_type().prop_map(|mission_type| Received::RequestList { mission_type }),
        1 => (number(), mission_type())
            .prop_map(|(seq, mission_type)| Received::Request { seq, mission_type }),
        1 => (0_u8..16, mission_type())
            .prop_map(|(result, mission_type)| Received::Ack { result, mission_type }),
        1 => mission_type().prop_map(|mission_type| Received::ClearAll { mission_type }),
        1 => mission_type().prop_map(|mission_type| Received::PartialList { mission_type }),
    ];
    (from, received)
}

proptest! {
    #[test]
    fn a_bad_network_never_leaves_half_a_mission(
        seed: u64,
        old in 1_u16..5,
        new in 1_u16..8,
        (lost, doubled, late) in (0_u64..60, 0_u64..60, 0_u64..60),
        intruder: bool,
    ) {
        let mut chance = Chance(seed);
        let mut bench = Bench::default();
        bench.upload(&mission(1, old));
        let mut now_ms = 10_000;
        let (mut up, mut down) =
            (Network::new(lost, doubled, late), Network::new(lost, doubled, late));
        let items = mission(2, new);
        let foreign = |chance: &mut Chance| {
            let received = match chance.below(6) {
                0 => Received::Item(mission(3, 8)[usize::try_from(chance.below(8)).unwrap()]),
                1 => Received::Ack { result: 15, mission_type: MISSION },
                2 => Received::RequestList { mission_type: MISSION },
                3 => Received::Request { seq: 0, mission_type: MISSION },
                4 => Received::PartialList { mission_type: MISSION },
                _ => return None,
            };
            intruder.then_some((OTHER, received))
        };
        let networks = (&mut up, &mut down);
        let result =
            upload_over(&mut bench.transfer, &items, networks, &mut now_ms, &mut chance, foreign);
        if result == result::ACCEPTED as u8 {
            prop_assert_eq!(bench.transfer.items(), items);
        }
    }

    #[test]
    fn any_messages_leave_a_mission_that_someone_sent(
        messages in prop::collection::vec((any_received(), 0_u64..400), 0..80),
    ) {
        let mut bench = Bench::default();
        for ((from, received), ms) in messages {
            let before = (bench.transfer.items().to_vec(), bench.transfer.id());
            let partner = bench.transfer.uploading();
            let (_, event) = bench.from(from, received);
            let (stored, id) = (bench.transfer.items(), bench.transfer.id());
            match event {
                Some(Event::Accepted) => {
                    prop_assert_eq!(partner, Some(from));
                    prop_assert!(!stored.is_empty());
                    prop_assert!((0..).zip(stored).all(|(seq, item)| item.seq == seq));
                    let translated = translate(stored, from.component, &RULES).unwrap();
                    prop_assert_eq!(&translated, bench.transfer.translated());
                }
                Some(Event::Cleared) => prop_assert!(stored.is_empty()),
                _ => prop_assert_eq!((stored, id), (&before.0[..], before.1)),
            }
            bench.after(ms);
        }
        // Whoever began and went away does not keep others out.
        for _ in 0..6 {
            bench.after(250);
        }
        prop_assert_eq!(bench.transfer.uploading(), None);
        prop_assert!(bench.transfer.incoming.capacity() <= MAX_ITEMS);
    }
}
