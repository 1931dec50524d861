//! What is believed of what other programs tell of their vehicles.

use std::time::Duration;

use autopilot::separation::Neighbour;
use autopilot::vehicle::VehicleName;

use super::clock::Bound;
use super::refused::{Count, Refused};
use super::roster::Roster;
use super::state::{Echo, MOST_ECHOES, Session, State};

/// What may be older is not believed: as old as what makes a vehicle silent (`autopilot::separation`).
pub const TOO_OLD: Duration = Duration::from_secs(2);
/// Most programs whose clocks are remembered, of which there are more than vehicles: anybody can make up numbers. Each is
/// answered in one of eleven states.
const MOST_SESSIONS: usize = 64;

/// What the programs of a fleet tell each other, as one of them hears it. Times are of its own clock, from its beginning.
#[derive(Debug, Clone)]
pub struct Peers {
    roster: Roster,
    own: Session,
    /// Our newest stamp: nobody can answer a later one.
    stamped: Duration,
    sessions: Vec<Known>,
    /// Who tells of each vehicle of the fleet.
    last: Vec<Option<Last>>,
    /// Whether each is heard, as it was told.
    is_heard: Vec<bool>,
    counts: Vec<Count>,
    /// The next session to be answered.
    turn: usize,
}

/// Another program's run.
#[derive(Debug, Clone, Copy)]
struct Known {
    session: Session,
    /// Its newest stamp, and when that arrived.
    sent: Duration,
    received: Duration,
    bound: Bound,
}

/// The last state of a vehicle that was believed.
#[derive(Debug, Clone, Copy)]
struct Last {
    session: Session,
    sent: Duration,
    received: Duration,
    /// It stays where it is, whether its program runs or not.
    is_parked: bool,
}

impl Last {
    fn is_heard(&self, now: Duration) -> bool {
        self.is_parked || now.saturating_sub(self.received) < TOO_OLD
    }
}

/// A state that is believed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Heard {
    /// The vehicle's place in the fleet.
    pub place: usize,
    /// How long ago the vehicle was there at most.
    pub age: Duration,
    /// What it tells, as uncertain as not knowing its time better makes it. `at` is by another clock: `age` counts.
    pub neighbour: Neighbour,
    /// Its flight has ended, and it stays where it is.
    pub is_parked: bool,
}

/// A vehicle that is flown elsewhere comes, or goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Change {
    /// Which one.
    pub vehicle: VehicleName,
    /// Whether it is heard now.
    pub is_heard: bool,
}

impl Peers {
    /// Nobody has been heard yet. `own` is a random number.
    pub fn new(roster: Roster, own: Session) -> Self {
        let count = roster.vehicles.len();
        Self {
            roster,
            own,
            stamped: Duration::ZERO,
            sessions: Vec::new(),
            last: vec![None; count],
            is_heard: vec![false; count],
            counts: Vec::new(),
            turn: 0,
        }
    }

    /// Who is in the fleet.
    pub fn roster(&self) -> &Roster {
        &self.roster
    }

    /// The text that tells of a vehicle that is flown here; `neighbour.at` is by the same clock as `now`. `None` if its
    /// numbers make no sense, or it is flown elsewhere.
    pub fn tell(
        &mut self,
        now: Duration,
        place: usize,
        neighbour: Neighbour,
        is_parked: bool,
    ) -> Option<String> {
        let entry = self.roster.vehicles.get(place).filter(|entry| entry.is_here)?;
        let vehicle = entry.name;
        let state = State {
            fleet: self.roster.digest,
            session: self.own,
            vehicle,
            sent: now,
            neighbour: Neighbour { at: neighbour.at.min(now), ..neighbour },
            is_parked,
            heard: self.answers(now),
        };
        self.stamped = self.stamped.max(now);
        state.encode()
    }

    /// Some of those who are to be answered, in turn.
    fn answers(&mut self, now: Duration) -> Vec<Echo> {
        let count = self.sessions.len();
        let answered = (0..count.min(MOST_ECHOES)).map(|step| {
            let Known { session, sent, received, .. } = self.sessions[(self.turn + step) % count];
            Echo { session, sent, held: now.saturating_sub(received) }
        });
        let answered = answered.collect();
        if count > 0 {
            self.turn = (self.turn + MOST_ECHOES.min(count)) % count;
        }
        answered
    }

    /// Something arrives at the key of a vehicle's state.
    ///
    /// # Errors
    /// [`Refused`] if it is not believed; whose key it is, if that is a vehicle of the fleet.
    pub fn hear(
        &mut self,
        now: Duration,
        key: &str,
        text: &[u8],
    ) -> Result<Heard, (Option<VehicleName>, Refused)> {
        let named = self.roster.of_state_key(key);
        let Some(vehicle) = named else { return Err((None, Refused::Key)) };
        let Some(place) = self.roster.place(vehicle) else { return Err((None, Refused::Unknown)) };
        self.hear_of(now, place, text).map_err(|why| (Some(vehicle), why))
    }

    fn hear_of(&mut self, now: Duration, place: usize, text: &[u8]) -> Result<Heard, Refused> {
        let entry = self.roster.vehicles[place];
        // Whatever it says.
        if entry.is_here {
            return Err(Refused::FlownHere);
        }
        let state = State::decode(text)?;
        if state.vehicle != entry.name {
            return Err(Refused::Key);
        }
        if state.fleet != self.roster.digest || state.neighbour.system != entry.system {
            return Err(Refused::OtherFleet);
        }
        if state.session == self.own {
            return Err(Refused::FlownHere);
        }
        let bound = self.compare_clocks(now, &state)?;
        let last = self.last[place];
        if let Some(Last { session, sent, received, is_parked }) = last {
            if session != state.session && !is_parked && now.saturating_sub(received) < TOO_OLD {
                return Err(Refused::TwoPrograms);
            }
            if session == state.session && state.sent <= sent {
                return Err(Refused::OutOfOrder);
            }
        }
        let age = bound.age(now, state.neighbour.at).ok_or(Refused::Unanswered)?;
        let told_ago = bound.age(now, state.sent).ok_or(Refused::Unanswered)?;
        // A drone that is not heard any more stays where it was left: it matters when that was said.
        if (if state.is_parked { told_ago } else { age }) > TOO_OLD {
            return Err(Refused::TooOld);
        }
        let State { session, sent, is_parked, .. } = state;
        self.last[place] = Some(Last { session, sent, received: now, is_parked });
        // It may have been there later than we believe, by the width of the bound, and flown on so long less.
        let width_s = bound.width(now).unwrap_or(TOO_OLD).as_secs_f64();
        let mut neighbour = state.neighbour;
        neighbour.uncertainty_m += neighbour.velocity_m_s.norm() * width_s / 2.0;
        Ok(Heard { place, age, neighbour, is_parked })
    }

    /// Takes in the stamps of a state; returns what is known of its clock.
    fn compare_clocks(&mut self, now: Duration, state: &State) -> Result<Bound, Refused> {
        let (own, stamped) = (self.own, self.stamped);
        let known = self.known(now, state);
        if state.sent > known.sent {
            (known.sent, known.received) = (state.sent, now);
        }
        known.bound.arrived(now, state.sent);
        for echo in state.heard.iter().filter(|echo| echo.session == own) {
            // Nobody can have held what we have not told yet, nor for longer than that is ago.
            if echo.sent > stamped || echo.sent + echo.held > now + RATE_ERROR {
                known.bound = Bound::default();
                return Err(Refused::Clock);
            }
            known.bound.answered(now, state.sent, echo.sent, echo.held);
        }
        if known.bound.is_contradictory(now) {
            known.bound = Bound::default();
            return Err(Refused::Clock);
        }
        Ok(known.bound)
    }

    /// What is known of a state's program. A new one has the place of another one, if there is no room: never of one that is
    /// believed now; of one that has answered only if all others have; and then of the one that was heard least lately.
    ///
    /// So nobody can keep out a program that is started again by making up numbers of others: what it sends is compared when it
    /// arrives, and it is answered if it is still known when the next states are told, or the ones after that.
    fn known(&mut self, now: Duration, state: &State) -> &mut Known {
        let session = state.session;
        let new = Known { session, sent: state.sent, received: now, bound: Bound::default() };
        let known = self.sessions.iter().position(|known| known.session == session);
        let place = known.unwrap_or_else(|| {
            let least = if self.sessions.len() < MOST_SESSIONS { None } else { self.least(now) };
            if let Some(place) = least {
                self.sessions[place] = new;
                return place;
            }
            // No more than are believed, which are as many as vehicles.
            self.sessions.push(new);
            self.sessions.len() - 1
        });
        &mut self.sessions[place]
    }

    /// The place of the program that matters least among those that are not believed now.
    fn least(&self, now: Duration) -> Option<usize> {
        let is_believed = |session| {
            let tells = |last: &Last| last.session == session && last.is_heard(now);
            self.last.iter().flatten().any(tells)
        };
        let others = self.sessions.iter().enumerate().filter(|(_, it)| !is_believed(it.session));
        let least = others.min_by_key(|(_, known)| (known.bound.has_answer(), known.received));
        least.map(|(place, _)| place)
    }

    /// Counts what was refused; returns whether an operator is to be told: of each kind once for each vehicle.
    pub fn count(&mut self, vehicle: Option<VehicleName>, why: Refused) -> bool {
        let is_same = |count: &&mut Count| {
            // Whatever the version, it is one kind: anybody can send any number.
            let same_kind = std::mem::discriminant(&count.why) == std::mem::discriminant(&why);
            count.vehicle == vehicle && same_kind
        };
        if let Some(count) = self.counts.iter_mut().find(is_same) {
            count.count += 1;
            return false;
        }
        self.counts.push(Count { vehicle, why, count: 1 });
        !why.is_usual()
    }

    /// How often what was refused.
    pub fn counts(&self) -> &[Count] {
        &self.counts
    }

    /// Which of those that are flown elsewhere have come or gone since the last time.
    pub fn changes(&mut self, now: Duration) -> Vec<Change> {
        let mut changes = Vec::new();
        for place in self.roster.places(false) {
            let is_heard = self.last[place].is_some_and(|last| last.is_heard(now));
            if std::mem::replace(&mut self.is_heard[place], is_heard) != is_heard {
                changes.push(Change { vehicle: self.roster.vehicles[place].name, is_heard });
            }
        }
        changes
    }
}

/// By how much the time for which a stamp was held, by another clock, may be too long for ours: ten seconds of drift.
const RATE_ERROR: Duration = Duration::from_millis(20);

#[cfg(test)]
mod tests {
    use autopilot::separation::Presence;
    use nalgebra::Vector2;
    use proptest::prelude::*;
    use serde_json::{Value, json};

    use super::super::roster::tests::two;
    use super::*;

    const MS: Duration = Duration::from_millis(1);

    fn neighbour(system: u8, at: Duration, velocity_m_s: f64) -> Neighbour {
        Neighbour {
            system,
            at,
            place_m: Vector2::new(1.0, 2.0),
            velocity_m_s: Vector2::new(velocity_m_s, 0.0),
            uncertainty_m: 0.1,
            separation_m: 1.5,
            presence: Presence::Flies,
            claim: None,
        }
    }

    /// Two programs, whose clocks are apart, and a network between them.
    struct Pair {
        left: Peers,
        right: Peers,
        /// What the right one's clock shows more.
        ahead: Duration,
    }

    const RIGHT: &str = "ardrone/two/right/state";
    const LEFT: &str = "ardrone/two/left/state";

    impl Pair {
        fn new() -> Self {
            let left = Peers::new(two(&["left"]), Session(1));
            let right = Peers::new(two(&["right"]), Session(2));
            Self { left, right, ahead: 700_000 * MS }
        }

        /// The left one tells at this time, and is heard so much later.
        fn left_tells(&mut self, at: Duration, way: Duration) -> Result<Heard, Refused> {
            let text = self.left.tell(at, 0, neighbour(1, at, 0.0), false).unwrap();
            let heard = self.right.hear(at + way + self.ahead, LEFT, text.as_bytes());
            heard.map_err(|(_, why)| why)
        }

        fn right_text(&mut self, at: Duration) -> String {
            let at = at + self.ahead;
            self.right.tell(at, 1, neighbour(2, at, 1.0), false).unwrap()
        }

        fn left_hears(&mut self, at: Duration, text: &str) -> Result<Heard, Refused> {
            self.left.hear(at, RIGHT, text.as_bytes()).map_err(|(_, why)| why)
        }

        /// Both have answered each other.
        fn acquainted() -> Self {
            let mut pair = Self::new();
            assert_eq!(pair.left_tells(1000 * MS, 10 * MS), Err(Refused::Unanswered));
            let text = pair.right_text(1020 * MS);
            assert!(pair.left_hears(1030 * MS, &text).is_ok());
            pair
        }
    }

    fn changed(text: &str, key: &str, value: Value) -> String {
        let mut object: Value = serde_json::from_str(text).unwrap();
        object[key] = value;
        object.to_string()
    }

    #[test]
    fn nobody_is_believed_before_its_program_has_answered() {
        let mut pair = Pair::new();
        let unanswered = pair.right_text(900 * MS);
        assert_eq!(pair.left_hears(910 * MS, &unanswered), Err(Refused::Unanswered));
        _ = pair.left_tells(1000 * MS, 10 * MS);
        let answered = pair.right_text(1020 * MS);
        let heard = pair.left_hears(1030 * MS, &answered).unwrap();
        assert!((20 * MS..21 * MS).contains(&heard.age), "{heard:?}");
        assert_eq!((heard.place, heard.neighbour.system), (1, 2));
        // It flew at 1 m/s for at most those 20 ms more or less.
        assert!((heard.neighbour.uncertainty_m - 0.11).abs() < 0.001, "{heard:?}");
    }

    /// Arrival is not the time of a state.
    #[test]
    fn what_was_held_back_is_as_old_as_it_is() {
        let mut pair = Pair::acquainted();
        let held_back = pair.right_text(1100 * MS);
        let heard = pair.left_hears(2600 * MS, &held_back).unwrap();
        assert!((1500 * MS..1530 * MS).contains(&heard.age), "{heard:?}");
        let too_old = pair.right_text(2700 * MS);
        assert_eq!(pair.left_hears(4750 * MS, &too_old), Err(Refused::TooOld));
        // Nor does an answer in it make it younger.
        _ = pair.left_tells(5000 * MS, 5 * MS);
        let with_answer = pair.right_text(5010 * MS);
        assert_eq!(pair.left_hears(8000 * MS, &with_answer), Err(Refused::TooOld));
    }

    #[test]
    fn each_is_heard_once_and_in_order() {
        let mut pair = Pair::acquainted();
        let [first, second] = [1100, 1150].map(|ms| pair.right_text(ms * MS));
        assert!(pair.left_hears(1200 * MS, &second).is_ok());
        for text in [&first, &second] {
            assert_eq!(pair.left_hears(1210 * MS, text), Err(Refused::OutOfOrder));
        }
    }

    #[test]
    fn what_does_not_belong_to_the_fleet_is_refused() {
        let mut pair = Pair::acquainted();
        let text = pair.right_text(1100 * MS);
        let mut hear = |key: &str, text: &str| pair.left.hear(1110 * MS, key, text.as_bytes());
        let right = "right".parse().ok();
        for (key, text, expected) in [
            ("ardrone/two/middle/state", text.clone(), (None, Refused::Unknown)),
            ("ardrone/three/right/state", text.clone(), (None, Refused::Key)),
            (LEFT, text.clone(), ("left".parse().ok(), Refused::FlownHere)),
            (LEFT, String::new(), ("left".parse().ok(), Refused::FlownHere)),
            (RIGHT, changed(&text, "vehicle", json!("left")), (right, Refused::Key)),
            (RIGHT, changed(&text, "system", json!(1)), (right, Refused::OtherFleet)),
            (
                RIGHT,
                changed(&text, "fleet", json!("0000000000000000")),
                (right, Refused::OtherFleet),
            ),
            (
                RIGHT,
                changed(&text, "session", json!("0000000000000001")),
                (right, Refused::FlownHere),
            ),
            (RIGHT, changed(&text, "version", json!(2)), (right, Refused::Version(2))),
            (RIGHT, changed(&text, "place_m", json!([1e6, 0])), (right, Refused::Absurd)),
            (RIGHT, text.clone() + &" ".repeat(1024), (right, Refused::TooLong)),
            (RIGHT, text[1..].to_owned(), (right, Refused::Malformed)),
        ] {
            assert_eq!(hear(key, &text), Err(expected), "{key} {text}");
        }
        assert!(hear(RIGHT, &text).is_ok(), "none of them did harm");
    }

    #[test]
    fn an_answer_to_what_was_never_told_is_refused() {
        let mut pair = Pair::acquainted();
        let text = pair.right_text(1100 * MS);
        let echo = |sent_us: u64, held_us: u64| {
            let echo =
                json!([{ "session": "0000000000000001", "sent_us": sent_us, "held_us": held_us }]);
            changed(&text, "heard", echo)
        };
        for text in [echo(1_200_000, 0), echo(1_000_000, 500_000), echo(0, (1 << 53) - 1)] {
            assert_eq!(pair.left_hears(1110 * MS, &text), Err(Refused::Clock), "{text}");
        }
        let begun_anew = changed(&text, "heard", json!([]));
        assert_eq!(pair.left_hears(1110 * MS, &begun_anew), Err(Refused::Unanswered));
        assert!(pair.left_hears(1110 * MS, &text).is_ok());
    }

    /// Another session has no bound, whatever is known of the first one.
    #[test]
    fn a_program_that_is_started_again_is_another_one() {
        let mut pair = Pair::acquainted();
        let text = pair.right_text(1100 * MS);
        assert!(pair.left_hears(1110 * MS, &text).is_ok());
        pair.right = Peers::new(two(&["right"]), Session(3));
        _ = pair.left_tells(1200 * MS, 5 * MS);
        let text = pair.right_text(1210 * MS);
        assert_eq!(pair.left_hears(1220 * MS, &text), Err(Refused::TwoPrograms));
        let unanswered = changed(&pair.right_text(4000 * MS), "heard", json!([]));
        let unanswered = changed(&unanswered, "session", json!("0000000000000009"));
        assert_eq!(pair.left_hears(4010 * MS, &unanswered), Err(Refused::Unanswered));
        let text = pair.right_text(4020 * MS);
        assert!(pair.left_hears(4030 * MS, &text).is_ok());
    }

    #[test]
    fn who_has_left_its_drone_on_the_ground_is_heard_until_another_program_flies_it() {
        let mut pair = Pair::acquainted();
        let at = 1100 * MS + pair.ahead;
        let stands =
            Neighbour { presence: Presence::Stands, ..neighbour(2, 900 * MS + pair.ahead, 0.0) };
        let text = pair.right.tell(at, 1, stands, true).unwrap();
        assert!(pair.left_hears(1110 * MS, &text).unwrap().is_parked);
        assert_eq!(pair.left.changes(1120 * MS).len(), 1);
        assert_eq!(pair.left.changes(60_000 * MS), [], "its program has ended");
        pair.right = Peers::new(two(&["right"]), Session(3));
        _ = pair.left_tells(61_000 * MS, 5 * MS);
        let text = pair.right_text(61_010 * MS);
        assert!(!pair.left_hears(61_020 * MS, &text).unwrap().is_parked);
        let late = pair.right.tell(62_000 * MS + pair.ahead, 1, stands, true).unwrap();
        assert_eq!(pair.left_hears(65_000 * MS, &late), Err(Refused::TooOld));
    }

    #[test]
    fn a_machine_that_stood_still_learns_the_clocks_anew() {
        let mut pair = Pair::acquainted();
        let text = pair.right_text(9000 * MS);
        // Our clock has not counted seven seconds.
        assert_eq!(pair.left_hears(2010 * MS, &text), Err(Refused::Clock));
        pair.ahead += 7000 * MS;
        let text = changed(&pair.right_text(2050 * MS), "heard", json!([]));
        assert_eq!(pair.left_hears(2060 * MS, &text), Err(Refused::Unanswered));
        _ = pair.left_tells(2100 * MS, 5 * MS);
        let text = pair.right_text(2110 * MS);
        let heard = pair.left_hears(2120 * MS, &text).unwrap();
        assert!((15 * MS..16 * MS).contains(&heard.age), "{heard:?}");
    }

    /// So many states as of the right vehicle, each of a program that nobody has heard before, and that answers nobody.
    fn strangers_at(at: Duration, text: &str, heard: &Value, peers: &mut Peers, key: &str) {
        for number in 0..30 {
            let session = json!(format!("{:08x}{number:08x}", at.as_millis()));
            let text = changed(&changed(text, "session", session), "heard", heard.clone());
            assert!(peers.hear(at, key, text.as_bytes()).is_err());
        }
    }

    #[test]
    fn strangers_take_no_place_of_who_is_believed_and_keep_nobody_out() {
        for answer in [false, true] {
            let mut pair = Pair::acquainted();
            // The strangers may have heard the left program, and answer it.
            let own =
                json!([{ "session": "0000000000000001", "sent_us": 1_000_000, "held_us": 0 }]);
            let heard = if answer { own } else { json!([]) };
            let text = pair.right_text(1040 * MS);
            for tick in 0..20 {
                strangers_at((1050 + tick) * MS, &text, &heard, &mut pair.left, RIGHT);
            }
            assert_eq!(pair.left.sessions.len(), MOST_SESSIONS);
            let text = changed(&pair.right_text(1100 * MS), "heard", json!([]));
            assert!(
                pair.left_hears(1110 * MS, &text).is_ok(),
                "what is known of its clock is kept"
            );
            // It is started again, and hears and answers one state of the left one.
            pair.right = Peers::new(two(&["right"]), Session(3));
            _ = pair.left_tells(3300 * MS, 5 * MS);
            let text = pair.right_text(3310 * MS);
            assert!(pair.left_hears(3320 * MS, &text).is_ok());
            assert_eq!(pair.left.counts(), []);
        }
    }

    /// Who has answered goes last.
    #[test]
    fn who_has_answered_is_kept_longer_than_who_has_not() {
        let mut pair = Pair::acquainted();
        let text = pair.right_text(1040 * MS);
        assert!(pair.left_hears(1045 * MS, &text).is_ok());
        let unanswered = changed(&pair.right_text(9000 * MS), "heard", json!([]));
        strangers_at(9000 * MS, &text, &json!([]), &mut pair.left, RIGHT);
        strangers_at(9001 * MS, &text, &json!([]), &mut pair.left, RIGHT);
        strangers_at(9002 * MS, &text, &json!([]), &mut pair.left, RIGHT);
        assert!(pair.left_hears(9010 * MS, &unanswered).is_ok(), "after a silence");
    }

    /// Both are told so much of strangers, 600 new ones a second, that neither hears the other at first.
    #[test]
    fn a_program_that_is_started_again_among_strangers_is_believed_within_two_seconds() {
        let mut pair = Pair::acquainted();
        pair.right = Peers::new(two(&["right"]), Session(3));
        let (of_left, of_right) = (
            pair.left.tell(3000 * MS, 0, neighbour(1, 3000 * MS, 0.0), false).unwrap(),
            pair.right_text(3000 * MS),
        );
        let none = json!([]);
        // No place is free any more.
        for tick in 0..3 {
            let at = (3900 + tick) * MS;
            strangers_at(at, &of_right, &none, &mut pair.left, RIGHT);
            strangers_at(at + pair.ahead, &of_left, &none, &mut pair.right, LEFT);
        }
        let believed = (0..200).find(|tick| {
            let at = (4000 + 50 * tick) * MS;
            // Each time between what is heard and what is told.
            strangers_at(at, &of_right, &none, &mut pair.left, RIGHT);
            let is_believed = pair.left_tells(at + 10 * MS, 5 * MS).is_ok();
            let there = at + 17 * MS + pair.ahead;
            strangers_at(there, &of_left, &none, &mut pair.right, LEFT);
            let text = pair.right_text(at + 20 * MS);
            pair.left_hears(at + 30 * MS, &text).is_ok() && is_believed
        });
        assert!(believed.is_some_and(|tick| (1..40).contains(&tick)), "{believed:?}");
    }

    #[test]
    fn coming_and_going_are_told_once() {
        let mut pair = Pair::acquainted();
        let right = |is_heard| Change { vehicle: "right".parse().unwrap(), is_heard };
        assert_eq!(pair.left.changes(1040 * MS), [right(true)]);
        assert_eq!(pair.left.changes(2900 * MS), []);
        assert_eq!(pair.left.changes(3100 * MS), [right(false)]);
        assert_eq!(pair.left.changes(9000 * MS), []);
    }

    #[test]
    fn each_reason_is_told_once_and_counted() {
        let mut peers = Peers::new(two(&["left"]), Session(1));
        let right = "right".parse().ok();
        assert!(peers.count(right, Refused::Version(2)));
        assert!(!peers.count(right, Refused::Version(3)));
        assert!(peers.count(None, Refused::Version(3)));
        assert!(!peers.count(right, Refused::OutOfOrder));
        let counts: Vec<u64> = peers.counts().iter().map(|count| count.count).collect();
        assert_eq!(counts, [2, 1, 1]);
    }

    #[test]
    fn only_what_is_flown_here_is_told() {
        let mut peers = Peers::new(two(&["left"]), Session(1));
        assert!(peers.tell(MS, 0, neighbour(1, MS, 0.0), false).is_some());
        assert_eq!(peers.tell(MS, 1, neighbour(2, MS, 0.0), false), None);
        assert_eq!(peers.tell(MS, 7, neighbour(2, MS, 0.0), false), None);
        assert_eq!(peers.tell(MS, 0, neighbour(1, MS, f64::NAN), false), None);
    }

    proptest! {
        /// Whatever network is between them: what is believed was told, is in order, and is no older than is believed.
        #[test]
        fn the_age_is_never_too_small(
            ways in proptest::collection::vec((1_u32..300, 0_u32..5000, 0_u32..5000, any::<bool>()), 1..80)
        ) {
            let mut pair = Pair::new();
            // When each arrives, and when it was told.
            let (mut to_left, mut to_right) = (Vec::new(), Vec::new());
            let mut now = Duration::ZERO;
            let mut newest = Duration::ZERO;
            for (pause, there, back, is_lost) in ways {
                now += pause * MS;
                if !is_lost {
                    let text = pair.left.tell(now, 0, neighbour(1, now, 0.0), false).unwrap();
                    to_right.push((now + there * MS, now, text));
                    to_left.push((now + back * MS, now, pair.right_text(now)));
                }
                to_left.sort_by_key(|(arrives, ..)| *arrives);
                to_right.sort_by_key(|(arrives, ..)| *arrives);
                while let Some((arrives, _, text)) = to_right.pop_if_first(now) {
                    _ = pair.right.hear(arrives + pair.ahead, LEFT, text.as_bytes());
                }
                while let Some((arrives, told, text)) = to_left.pop_if_first(now) {
                    if let Ok(heard) = pair.left_hears(arrives, &text) {
                        prop_assert!(heard.age >= arrives.saturating_sub(told), "{heard:?} {:?}", arrives.saturating_sub(told));
                        prop_assert!(heard.age <= TOO_OLD);
                        prop_assert!(told > newest);
                        newest = told;
                    }
                }
            }
        }
    }

    trait PopIfFirst<T> {
        fn pop_if_first(&mut self, now: Duration) -> Option<T>;
    }

    impl PopIfFirst<(Duration, Duration, String)> for Vec<(Duration, Duration, String)> {
        fn pop_if_first(&mut self, now: Duration) -> Option<(Duration, Duration, String)> {
            let is_here = self.first().is_some_and(|(arrives, ..)| *arrives <= now);
            is_here.then(|| self.remove(0))
        }
    }
}
