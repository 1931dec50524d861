//! The mission that the vehicle was given by `MAVLink`, and how far it is.

use autopilot::plan::Step;

use super::modes::Purpose;

/// A mission that was handed to the vehicle.
#[derive(Debug, Clone)]
pub(super) struct Handed {
    pub(super) purpose: Purpose,
    /// Its commands, by which it is recognised.
    pub(super) lines: Vec<String>,
    /// The item of each command.
    pub(super) items: Vec<u16>,
    /// The stored mission from which it was made.
    pub(super) id: u32,
}

impl Handed {
    /// The item of a step that is the last of its item.
    fn item_done(&self, step: usize) -> Option<u16> {
        let item = *self.items.get(step)?;
        let mut later = self.items.iter().zip(&self.lines).skip(step + 1);
        // Settings are no steps that will be reported.
        let goes_on = later.any(|(other, line)| *other == item && !is_setting(line));
        (!goes_on).then_some(item)
    }

    fn is_last(&self, step: usize) -> bool {
        self.lines.iter().skip(step + 1).all(|line| is_setting(line))
    }
}

/// Whether a line of a plan only changes how later ones are flown.
fn is_setting(line: &str) -> bool {
    line.starts_with("set")
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
    progress: Progress,
    /// The item with which the stored mission begins next time.
    first_item: u16,
    /// The item that the vehicle flew last, as long as it has the mission.
    item: Option<u16>,
    /// The item that was reported as reached last.
    reached: Option<u16>,
}

impl Flown {
    /// This mission is handed to the vehicle.
    pub(super) fn hand(&mut self, handed: Handed) {
        self.item = None;
        self.handed = Some(handed);
        self.progress = Progress::Other;
    }

    /// The vehicle has a mission of these steps.
    pub(super) fn recognise(&mut self, steps: &[Step]) {
        let steps = steps.iter().map(|step| step.text.as_str());
        let ours = self.handed.as_ref().is_some_and(|handed| {
            !handed.lines.is_empty() && steps.eq(handed.lines.iter().map(String::as_str))
        });
        self.progress = if ours { Progress::Ours } else { Progress::Other };
    }

    /// Forgets that the vehicle has the mission: it will be handed over again.
    pub(super) fn forget(&mut self) {
        self.progress = Progress::Other;
    }

    /// The vehicle flies a step of its mission.
    pub(super) fn at_step(&mut self, step: usize) {
        if let Some(item) = self.ours().and_then(|handed| handed.items.get(step)) {
            self.item = Some(*item);
        }
    }

    /// The vehicle has carried out a step of its mission. Returns the item that is reached by it.
    pub(super) fn step_done(&mut self, step: usize) -> Option<u16> {
        let handed = self.ours()?;
        let done = handed.item_done(step).filter(|_| handed.purpose == Purpose::Mission);
        let is_last = handed.is_last(step);
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
        let is_it = |handed: &Handed| handed.purpose == Purpose::Mission && handed.id == id;
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
    pub(super) fn lines(&self) -> &[String] {
        self.handed.as_ref().map_or(&[], |handed| &handed.lines)
    }
}

#[cfg(test)]
mod tests {
    use autopilot::plan::Plan;

    use super::*;

    const TEXT: &str = "takeoff\nsetStayTime 1\ngoto 0 0 1 0\ngoto 1 0 1 0\nsetStayTime 0.3\n";

    fn handed(purpose: Purpose) -> Handed {
        let lines = TEXT.lines().map(str::to_owned).collect();
        Handed { purpose, lines, items: vec![0, 1, 1, 1, 1], id: 7 }
    }

    fn flown(purpose: Purpose) -> Flown {
        let mut flown = Flown::default();
        flown.hand(handed(purpose));
        // A plan lands at its end, a mission need not.
        let plan = Plan::parse("test", TEXT).unwrap();
        flown.recognise(&plan.steps()[..5]);
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
        flown.recognise(&[]);
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
