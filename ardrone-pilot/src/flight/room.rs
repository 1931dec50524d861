//! The vehicles of one program in one room: each leaves where it was last, and takes what the others have left.
//!
//! Ticks never wait for each other: a place that another one is just writing or reading is passed over until the next tick.
//! Vehicles of other programs have places like all others; who hears them writes those ([`Places`]).

use std::sync::{Arc, Mutex, PoisonError, TryLockError};
use std::time::{Duration, Instant};

use autopilot::separation::{Neighbour, Presence};
use autopilot::vehicle::VehicleName;
use crossbeam_channel::{Receiver, Sender, TrySendError, bounded};
use mission_agent::{Line, Said};

use crate::drive::NoRoom;

/// Lines to an agent that may wait for its next tick.
const LINES: usize = 64;

/// How agents of vehicles are reached that other programs fly. It never waits.
pub trait RemoteAgents: std::fmt::Debug + Send {
    /// The vehicle's agent says something to one of them. It may be lost on the way.
    ///
    /// # Errors
    /// [`NoRoom`] if it is lost here.
    fn say(&mut self, said: &Said) -> Result<(), NoRoom>;

    /// The next line that one of them has said to the vehicle's agent.
    fn next_line(&mut self) -> Option<Line>;
}

/// What one vehicle has told.
#[derive(Debug, Clone, Copy)]
struct Told {
    /// When it was there.
    at: Instant,
    neighbour: Neighbour,
    /// Its program has ended with the drone on the ground: it stands there.
    is_parked: bool,
}

/// The places of a room, for what passes them on to other programs, and writes those of vehicles that are flown there.
#[derive(Debug, Clone)]
pub struct Places(Arc<[Mutex<Option<Told>>]>);

/// What is at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placed {
    /// When it was there.
    pub at: Instant,
    /// What it tells; its own `at` is by another clock.
    pub neighbour: Neighbour,
    /// Its flight has ended, and it stays there.
    pub is_parked: bool,
}

impl Places {
    /// What the vehicle with this number has told last. It waits for its place, which nobody holds for long.
    pub fn read(&self, number: usize) -> Option<Placed> {
        let told = *self.0.get(number)?.lock().unwrap_or_else(PoisonError::into_inner);
        told.map(|Told { at, neighbour, is_parked }| Placed { at, neighbour, is_parked })
    }

    /// A vehicle that is flown by another program is heard.
    pub fn write(&self, number: usize, Placed { at, neighbour, is_parked }: Placed) {
        if let Some(place) = self.0.get(number) {
            let told = Told { at, neighbour, is_parked };
            *place.lock().unwrap_or_else(PoisonError::into_inner) = Some(told);
        }
    }
}

/// A vehicle's place in a room.
#[derive(Debug)]
pub struct Seat {
    room: Arc<[Mutex<Option<Told>>]>,
    own: usize,
    /// When each was where it was last heard to be.
    heard: Vec<Option<Instant>>,
    /// What is said to its agent.
    mail: Receiver<Line>,
    /// Where the agents of all are reached.
    boxes: Arc<[(VehicleName, Sender<Line>)]>,
}

impl Seat {
    /// One for each vehicle of a room.
    pub fn in_one_room(names: impl IntoIterator<Item = VehicleName>) -> impl Iterator<Item = Self> {
        let reached = names.into_iter().map(|name| {
            let (sender, mail) = bounded(LINES);
            ((name, sender), mail)
        });
        let (boxes, mails): (Vec<_>, Vec<_>) = reached.unzip();
        let count = boxes.len();
        let room: Arc<[_]> = (0..count).map(|_| Mutex::default()).collect();
        let boxes: Arc<[_]> = boxes.into();
        mails.into_iter().enumerate().map(move |(own, mail)| {
            let (room, boxes) = (Arc::clone(&room), Arc::clone(&boxes));
            Self { room, own, heard: vec![None; count], mail, boxes }
        })
    }

    /// The agent says something to that of another vehicle; `None` if that one is not flown here. What does not fit is lost, as
    /// on any network.
    pub(super) fn say(&self, Said { to, line }: Said) -> Option<Result<(), NoRoom>> {
        let (_, sender) = self.boxes.iter().find(|(name, _)| name.as_str() == to)?;
        match sender.try_send(line) {
            Ok(()) => Some(Ok(())),
            Err(TrySendError::Full(_)) => Some(Err(NoRoom::Mailbox)),
            Err(TrySendError::Disconnected(_)) => None,
        }
    }

    /// Something that was said to the agent.
    pub(super) fn next_line(&self) -> Option<Line> {
        self.mail.try_recv().ok()
    }

    /// All places of its room.
    pub fn places(&self) -> Places {
        Places(Arc::clone(&self.room))
    }

    /// Tells the others; times count from `start`.
    pub(super) fn tell(&self, start: Instant, neighbour: Neighbour) {
        let told = Told { at: start + neighbour.at, neighbour, is_parked: false };
        if let Some(mut own) = self.room.get(self.own).and_then(unlocked) {
            *own = Some(told);
        }
    }

    /// The vehicle leaves the room with its drone on the ground. It waits for its place: there is no tick any more that would
    /// be late, and none that would say it again.
    pub(super) fn park(&self) {
        let Some(own) = self.room.get(self.own) else { return };
        if let Some(told) = own.lock().unwrap_or_else(PoisonError::into_inner).as_mut() {
            (told.is_parked, told.neighbour.presence) = (true, Presence::Stands);
            told.neighbour.claim = None;
        }
    }

    /// What the others have told since the last time; times count from `start`. `now` is the time of those that stand where they
    /// were left.
    pub(super) fn hear(
        &mut self,
        start: Instant,
        now: Duration,
    ) -> impl Iterator<Item = Neighbour> + '_ {
        let own = self.own;
        let others = self.room.iter().zip(&mut self.heard).enumerate();
        others.filter(move |(number, _)| *number != own).filter_map(move |(_, (place, heard))| {
            let Told { at, neighbour, is_parked } = (*unlocked(place)?)?;
            if is_parked {
                return Some(Neighbour { at: now, ..neighbour });
            }
            let is_new = heard.replace(at) != Some(at);
            is_new.then(|| Neighbour { at: at.saturating_duration_since(start), ..neighbour })
        })
    }
}

/// Nothing if it is in use just now. Nobody panics while it is locked.
fn unlocked<T>(place: &Mutex<T>) -> Option<std::sync::MutexGuard<'_, T>> {
    match place.try_lock() {
        Ok(guard) => Some(guard),
        Err(TryLockError::Poisoned(poisoned)) => Some(poisoned.into_inner()),
        Err(TryLockError::WouldBlock) => None,
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector2;

    use super::*;

    const MS: Duration = Duration::from_millis(1);

    fn in_one_room(count: usize) -> Vec<Seat> {
        let names = ["a", "b", "c"].map(|name| name.parse().unwrap());
        Seat::in_one_room(names.into_iter().take(count)).collect()
    }

    #[test]
    fn what_is_said_is_heard_by_whom_it_was_said_to_and_no_more_is_kept_than_fits() {
        let mut seats = in_one_room(3);
        let line = Line::from("0123456789abcdef a tell low").unwrap();
        for number in 0..LINES + 5 {
            let taken = if number < LINES { Ok(()) } else { Err(NoRoom::Mailbox) };
            assert_eq!(seats[0].say(Said { to: "c", line }), Some(taken));
        }
        assert_eq!(seats[0].say(Said { to: "nobody", line }), None);
        assert_eq!((seats[0].next_line(), seats[1].next_line()), (None, None));
        let heard = std::iter::from_fn(|| seats[2].next_line()).collect::<Vec<_>>();
        assert_eq!(heard, vec![line; LINES]);
        // Whose vehicle is not flown here has nobody who hears.
        seats.truncate(2);
        assert_eq!(seats[0].say(Said { to: "c", line }), None);
    }

    fn at(system: u8, ms: u32, presence: Presence) -> Neighbour {
        let (place_m, velocity_m_s) = (Vector2::new(1.0, 2.0), Vector2::new(0.5, 0.0));
        Neighbour {
            system,
            at: ms * MS,
            place_m,
            velocity_m_s,
            uncertainty_m: 0.1,
            separation_m: 1.5,
            presence,
            claim: None,
        }
    }

    #[test]
    fn each_hears_the_others_once_by_its_own_clock() {
        let mut seats: Vec<Seat> = in_one_room(3);
        let [first, later] = [Instant::now(), Instant::now() + 500 * MS];
        seats[0].tell(first, at(1, 700, Presence::Flies));
        seats[1].tell(later, at(2, 300, Presence::Flies));
        let heard = seats[2].hear(first, 900 * MS).collect::<Vec<_>>();
        assert_eq!(heard[0], at(1, 700, Presence::Flies));
        assert!((800 * MS..900 * MS).contains(&heard[1].at) && heard[1].system == 2, "{heard:?}");
        assert_eq!(seats[2].hear(first, 900 * MS).count(), 0, "nothing is new");
        // What was told before the hearer began was then.
        assert_eq!(
            seats[1].hear(later + 700 * MS, 900 * MS).next(),
            Some(at(1, 0, Presence::Flies))
        );
        seats[0].tell(first, at(1, 730, Presence::Flies));
        assert_eq!(seats[2].hear(first, 900 * MS).count(), 1);
    }

    #[test]
    fn a_place_that_is_in_use_is_waited_for_by_who_leaves_it_and_passed_over_by_ticks() {
        let mut seats: Vec<Seat> = in_one_room(2);
        let start = Instant::now();
        seats[0].tell(start, at(1, 10, Presence::Flies));
        let room = Arc::clone(&seats[0].room);
        let in_use = room[0].lock().unwrap();
        seats[0].tell(start, at(1, 20, Presence::Flies));
        assert_eq!(seats[1].hear(start, MS).count(), 0);
        std::thread::scope(|scope| {
            let leaves = scope.spawn(|| seats[0].park());
            std::thread::sleep(20 * MS);
            assert!(!leaves.is_finished());
            drop(in_use);
        });
        assert_eq!(seats[1].hear(start, 50 * MS).next(), Some(at(1, 50, Presence::Stands)));
    }

    #[test]
    fn who_is_flown_elsewhere_is_heard_like_all_others() {
        let mut seats: Vec<Seat> = in_one_room(2);
        let (start, places) = (Instant::now(), seats[0].places());
        assert_eq!(places.read(0), None);
        seats[0].tell(start, at(1, 700, Presence::Flies));
        let told = places.read(0).unwrap();
        assert_eq!((told.at, told.is_parked), (start + 700 * MS, false));
        let there =
            Placed { at: start + 650 * MS, neighbour: at(2, 5, Presence::Flies), is_parked: false };
        places.write(1, there);
        assert_eq!(seats[0].hear(start, 900 * MS).next(), Some(at(2, 650, Presence::Flies)));
        assert_eq!(seats[0].hear(start, 930 * MS).next(), None, "nothing is new");
        places.write(1, Placed { is_parked: true, ..there });
        assert_eq!(seats[0].hear(start, 960 * MS).next(), Some(at(2, 960, Presence::Flies)));
        places.write(2, there);
        assert_eq!(places.read(2), None);
    }

    #[test]
    fn who_has_left_its_drone_on_the_ground_is_still_heard() {
        let mut seats: Vec<Seat> = in_one_room(2);
        let start = Instant::now();
        seats[0].park();
        assert_eq!(seats[1].hear(start, MS).count(), 0, "it was never there");
        seats[0].tell(start, at(1, 10, Presence::Flies));
        seats[0].park();
        for ms in [500, 600] {
            assert_eq!(seats[1].hear(start, ms * MS).next(), Some(at(1, ms, Presence::Stands)));
        }
    }
}
