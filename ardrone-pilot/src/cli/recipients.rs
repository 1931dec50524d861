//! The vehicles to which a terminal gives orders: one, or a fleet.

use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use autopilot::vehicle::{Operator, OperatorOrder, Refused, VehicleName};

use crate::flight::{Controls, answer_of_all};
use crate::typed;

/// The vehicles, and which of them gets the orders; without a choice all do.
#[derive(Debug, Clone)]
pub(super) struct Recipients {
    all: Arc<[Controls]>,
    chosen: Option<usize>,
    /// The one that was chosen last, for displays.
    watched: Arc<AtomicUsize>,
}

/// An order is for one vehicle, and there are several.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("this is for one vehicle: name it before the order, or choose it")]
pub(super) struct NoneChosen;

impl Recipients {
    /// At least one vehicle.
    pub(super) fn new(all: Vec<Controls>) -> Self {
        Self { all: all.into(), chosen: None, watched: Arc::default() }
    }

    /// Who gets the next orders.
    pub(super) fn addressed(&self) -> &[Controls] {
        match self.chosen {
            Some(chosen) => self.all.get(chosen..=chosen).unwrap_or_default(),
            None => &self.all,
        }
    }

    /// The only one that gets them.
    pub(super) fn only(&self) -> Result<&Controls, NoneChosen> {
        match self.addressed() {
            [only] => Ok(only),
            _ => Err(NoneChosen),
        }
    }

    /// Gives the next orders to the vehicle with this place in the fleet, from 1; 0 gives them to all. Returns whether there
    /// is a choice, and such a vehicle.
    pub(super) fn choose(&mut self, place: usize) -> bool {
        let is_there = self.all.len() > 1 && place <= self.all.len();
        if is_there {
            self.chosen = place.checked_sub(1);
            if let Some(chosen) = self.chosen {
                self.watched.store(chosen, Ordering::Relaxed);
            }
        }
        is_there
    }

    /// Which one was chosen last, by all clones of this; the first at first.
    pub(super) fn watched(&self) -> usize {
        self.watched.load(Ordering::Relaxed)
    }

    /// The names of all.
    pub(super) fn names(&self) -> impl Iterator<Item = VehicleName> + '_ {
        self.all.iter().map(Controls::vehicle)
    }

    /// The same vehicles, of which the one with this name gets the orders; nothing if there is none.
    pub(super) fn named(&self, name: &str) -> Option<Self> {
        let is_it = |controls: &Controls| controls.vehicle().as_str() == name;
        let place = self.all.iter().position(is_it)?;
        Some(Self { chosen: Some(place), ..self.clone() })
    }

    /// Whom a typed line is for, and the rest of it: before an order may stand the name of a vehicle of several. What is an order
    /// is none: `land` lands all, also if a vehicle is called so.
    pub(super) fn named_first<'a>(&self, line: &'a str) -> (Self, &'a str) {
        let (first, rest) = line.split_once(' ').unwrap_or((line, ""));
        match self.named(first).filter(|_| !typed::is_order(first)) {
            Some(named) if self.all.len() > 1 => (named, rest.trim_start()),
            _ => (self.clone(), line),
        }
    }

    /// Whether an order for several is one that they can carry out each in its place.
    pub(super) fn takes_as_one(&self, order: &OperatorOrder) -> bool {
        use OperatorOrder::{Cut, Hold, Land, Resume};
        self.only().is_err() && matches!(order, Land | Cut | Hold | Resume)
    }

    /// Its name, if it is only one.
    pub(super) fn vehicle(&self) -> Option<VehicleName> {
        self.only().ok().map(Controls::vehicle)
    }

    /// Gives an order to all that are addressed, without waiting for answers.
    ///
    /// # Errors
    /// That of the first one, if none could be reached.
    pub(super) fn order(&self, by: Operator, order: &OperatorOrder) -> Result<(), Refused> {
        self.each(|controls| controls.order(by, order.clone()))
    }

    /// As [`Recipients::order`], and waits for the answers.
    ///
    /// # Errors
    /// That of the first one, if all refuse.
    pub(super) fn ask(&self, by: Operator, order: &OperatorOrder) -> Result<(), Refused> {
        self.each(|controls| controls.ask(by, order.clone()))
    }

    /// Lands those that are addressed, and ends their flights; returns whether one was under way.
    pub(super) fn quit(&self) -> bool {
        // Each must hear it.
        self.addressed().iter().map(Controls::quit).fold(false, |heard, hears| heard | hears)
    }

    /// The same vehicles, all of which get the orders.
    pub(super) fn everyone(&self) -> Self {
        Self { chosen: None, ..self.clone() }
    }

    fn each(&self, order: impl Fn(&Controls) -> Result<(), Refused>) -> Result<(), Refused> {
        answer_of_all(self.addressed().iter().map(order))
    }
}

/// Who is addressed, for people.
impl fmt::Display for Recipients {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.only() {
            Ok(controls) => controls.vehicle().fmt(f),
            Err(NoneChosen) => f.write_str("all vehicles"),
        }
    }
}
