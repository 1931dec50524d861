//! The air that several drones on sockets share.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::Presence;

/// An air for several drones: each tells where it is, and learns where the others are, every few milliseconds. Its clones are the
/// same air.
#[derive(Debug, Clone, Default)]
pub struct Air(Arc<Mutex<Vec<Option<Presence>>>>);

impl Air {
    /// Nobody holds it for longer than it takes to copy a few places.
    fn places(&self) -> MutexGuard<'_, Vec<Option<Presence>>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(super) fn enter(&self, own: Presence) -> InAir {
        let mut places = self.places();
        let free = places.iter().position(Option::is_none);
        let number = free.unwrap_or(places.len());
        match places.get_mut(number) {
            Some(place) => *place = Some(own),
            None => places.push(Some(own)),
        }
        InAir { air: self.clone(), number, others: Vec::new() }
    }
}

/// A drone in an air, until it is dropped.
#[derive(Debug)]
pub(super) struct InAir {
    air: Air,
    number: usize,
    others: Vec<Presence>,
}

impl InAir {
    /// Tells where this drone is; returns the others.
    pub(super) fn exchange(&mut self, own: Presence) -> &[Presence] {
        let mut places = self.air.places();
        if let Some(place) = places.get_mut(self.number) {
            *place = Some(own);
        }
        let others = places.iter().enumerate().filter(|(number, _)| *number != self.number);
        self.others.clear();
        self.others.extend(others.filter_map(|(_, place)| *place));
        drop(places);
        &self.others
    }
}

impl Drop for InAir {
    fn drop(&mut self) {
        if let Some(place) = self.air.places().get_mut(self.number) {
            *place = None;
        }
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use nalgebra::{Vector2, Vector3};

    use super::*;
    use crate::server::{MockDrone, Ports};
    use crate::{DroneConfig, Standing, WorldConfig};

    #[test]
    fn each_learns_of_all_others_until_they_are_gone() {
        let at = |x_m| Presence {
            position_m: Vector3::new(x_m, 0.0, 0.0),
            rotors_turn: true,
            ultrasound: 8,
        };
        let air = Air::default();
        let mut first = air.enter(at(1.0));
        assert_eq!(first.exchange(at(1.5)), []);
        let mut second = air.clone().enter(at(2.0));
        let third = air.enter(at(3.0));
        assert_eq!(second.exchange(at(2.5)), [at(1.5), at(3.0)]);
        drop(third);
        assert_eq!(first.exchange(at(1.6)), [at(2.5)]);
        let _fourth = air.enter(at(4.0));
        assert_eq!(second.exchange(at(2.5)), [at(1.6), at(4.0)]);
    }

    /// In real time: both hover for 2 s, as they hear nobody.
    #[test]
    fn on_sockets_too_a_drone_sinks_under_another_one() {
        let hovering = |air: &Air, height_m: f64, x_m: f64| {
            let drone = DroneConfig { flies_at_m: Some(height_m), ..DroneConfig::default() };
            let start = Standing { place_m: Vector2::new(x_m, 0.0), heading_deg: 0.0 };
            let world = WorldConfig { drone, start, ..WorldConfig::default() };
            MockDrone::start_in(air, &world, Ports::LOOPBACK).unwrap()
        };
        let air = Air::default();
        let _over = hovering(&air, 2.5, 7.0);
        let under = hovering(&air, 1.0, 7.0);
        let beside = hovering(&air, 1.0, 9.0);
        std::thread::sleep(Duration::from_millis(1500));
        let [under_m, beside_m] = [under, beside].map(|drone| drone.truth().position_m.z);
        assert!(beside_m > 0.95 && under_m < 0.9, "{under_m} {beside_m}");
    }
}
