//! The mission that the vehicle was given by `MAVLink`, and how far it is.

use autopilot::plan::MissionId;

use super::modes::Purpose;
use crate::mission::Step;

/// A mission that was handed to the vehicle.
#[derive(Debug, Clone)]
pub(super) struct Handed {
    /// Its number, by which it is recognised.
    id: MissionId,
    purpose: Purpose,
    steps: Vec<Step>,
    /// The stored mission from which it was made.
    stored: u32,
}

impl Handed {
    /// The steps behind this one whose ends will be reported, which those of settings are not.
    fn behind(&self, step: usize) -> impl Iterator<Item = &Step> {
        self.steps.iter().skip(step + 1).filter(|later| !later.command.is_setting())
    }
}

/// How far the mission of [`Handed`] is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Progress {
    /// The vehicle has another mission.
    #[default]
    Other,
    /// It has this one.
    Ours,
    /// .. and has flown it to its end.
    Complete,
}

/// The mission that was handed to the vehicle last, and the items that it has flown.
#[derive(Debug, Default)]
pub(super) struct Flown {
    handed: Option<Handed>,
    next_id: u32,
    progress: Progress,
    /// The item with which the stored mission begins next time.
    first_item: u16,
    /// The item that the vehicle flew last, as long as it has the mission.
    item: Option<u16>,
    /// The item that was reported as reached last.
    reached: Option<u16>,
}

impl Flown {
    /// The number of the next mission that is handed over.
    pub(super) fn next_id(&self) -> MissionId {
        MissionId(self.next_id)
    }

    /// This mission is handed to the vehicle, made of the `stored` one.
    pub(super) fn hand(&mut self, purpose: Purpose, steps: Vec<Step>, stored: u32) {
        self.handed = Some(Handed { id: self.next_id(), purpose, steps, stored });
        self.next_id = self.next_id.wrapping_add(1);
        self.item = None;
        self.progress = Progress::Other;
    }

    /// The vehicle has another mission, with this number if it was made by a program.
    pub(super) fn recognise(&mut self, mission: Option<MissionId>) {
        let ours = self.handed.as_ref().is_some_and(|handed| mission == Some(handed.id));
        self.progress = if ours { Progress::Ours } else { Progress::Other };
    }

    /// Forgets that the vehicle has the mission: it will be handed over again.
    pub(super) fn forget(&mut self) {
        self.progress = Progress::Other;
    }

    /// The vehicle flies a step of its mission.
    pub(super) fn at_step(&mut self, step: usize) {
        if let Some(item) = self.ours().and_then(|handed| handed.steps.get(step)) {
            self.item = Some(item.item);
        }
    }

    /// The vehicle has carried out a step of its mission. Returns the item that is reached by it.
    pub(super) fn step_done(&mut self, step: usize) -> Option<u16> {
        let handed = self.ours()?;
        let item = handed.steps.get(step)?.item;
        let goes_on = handed.behind(step).any(|later| later.item == item);
        let is_last = handed.behind(step).next().is_none();
        let done = (!goes_on && handed.purpose == Purpose::Mission).then_some(item);
        let reached = done.filter(|item| self.reached != Some(*item));
        if reached.is_some() {
            self.reached = reached;
        }
        if is_last {
            self.progress = Progress::Complete;
        }
        reached
    }

    /// The stored mission begins with this item next time.
    pub(super) fn begin_at(&mut self, item: u16) {
        self.first_item = item;
        self.reached = None;
    }

    /// The item with which the stored mission begins next time.
    pub(super) fn first_item(&self) -> u16 {
        self.first_item
    }

    /// The item that the vehicle flew last.
    pub(super) fn item(&self) -> Option<u16> {
        self.item
    }

    /// Whether the vehicle has the mission, and not to its end.
    pub(super) fn goes_on(&self) -> bool {
        self.progress == Progress::Ours
    }

    /// Whether the vehicle has flown it to its end.
    pub(super) fn is_complete(&self) -> bool {
        self.progress == Progress::Complete
    }

    /// Whether the vehicle has the stored mission of this number.
    pub(super) fn is_stored(&self, id: u32) -> bool {
        let is_it = |handed: &Handed| handed.purpose == Purpose::Mission && handed.stored == id;
        self.progress != Progress::Other && self.handed.as_ref().is_some_and(is_it)
    }

    /// What the vehicle's mission was made for.
    pub(super) fn purpose(&self) -> Purpose {
        match (&self.handed, self.progress) {
            (Some(handed), Progress::Ours | Progress::Complete) => handed.purpose,
            _ => Purpose::Mission,
        }
    }

    fn ours(&self) -> Option<&Handed> {
        self.handed.as_ref().filter(|_| self.progress == Progress::Ours)
    }

    #[cfg(test)]
    pub(super) fn steps(&self) -> &[Step] {
        self.handed.as_ref().map_or(&[], |handed| &handed.steps)
    }
}

#[cfg(test)]
mod tests {
    use autopilot::plan::Command;
    use kinematics::Pose;

    use super::*;
    use crate::mission::TAKE_OFF;

    fn flown(purpose: Purpose) -> Flown {
        let to = Command::GoTo(Pose { z_m: 1.0, ..Pose::default() });
        let [stay, later] = [1.0, 0.3].map(|time_s| Command::SetStayTime { time_s });
        let steps = [(0, TAKE_OFF), (1, stay), (1, to), (1, to), (1, later)];
        let steps = steps.map(|(item, command)| Step { item, command }).to_vec();
        let mut flown = Flown::default();
        let id = flown.next_id();
        flown.hand(purpose, steps, 7);
        assert!(!flown.goes_on(), "the vehicle does not have it yet");
        flown.recognise(Some(id));
        flown
    }

    #[test]
    fn an_item_is_reached_with_its_last_step() {
        let mut flown = flown(Purpose::Mission);
        assert!(flown.goes_on() && flown.is_stored(7) && !flown.is_stored(8));
        flown.at_step(2);
        assert_eq!(flown.item(), Some(1));
        assert_eq!([0, 1, 2].map(|step| flown.step_done(step)), [Some(0), None, None]);
        assert!(!flown.is_complete());
        // Behind it are settings only.
        assert_eq!(flown.step_done(3), Some(1));
        assert!(flown.is_complete() && flown.is_stored(7));
        assert_eq!(flown.step_done(3), None, "it is at its end");
    }

    #[test]
    fn items_of_other_missions_are_not_reached() {
        let mut flown = flown(Purpose::TakeOff);
        assert_eq!(flown.step_done(0), None);
        assert_eq!((flown.purpose(), flown.is_stored(7)), (Purpose::TakeOff, false));
        flown.recognise(Some(flown.next_id()));
        flown.at_step(0);
        assert_eq!((flown.step_done(0), flown.item()), (None, None));
        assert_eq!(flown.purpose(), Purpose::Mission);
    }

    #[test]
    fn an_item_is_reached_again_once_the_mission_begins_again() {
        let mut flown = flown(Purpose::Mission);
        assert_eq!([0, 0].map(|step| flown.step_done(step)), [Some(0), None]);
        flown.begin_at(1);
        assert_eq!((flown.first_item(), flown.step_done(0)), (1, Some(0)));
    }
}
