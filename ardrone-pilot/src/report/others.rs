//! Where other vehicles were, as this one heard it.

use std::collections::BTreeMap;
use std::time::Duration;

use serde::Serialize;

use super::series::short;
use crate::recording::Log;

/// Shortest time between two places of one vehicle, in seconds.
const INTERVAL_S: f64 = 0.2;
/// Maximum number of places and of vehicles. They bound the size of the page for a forged log.
const MOST_PLACES: usize = 5000;
const MOST_VEHICLES: usize = 32;

/// Another vehicle.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct Other {
    system: u8,
    /// Seconds, right and forward.
    places: Vec<[f64; 3]>,
}

/// All that were heard in a part of a recording.
pub(super) fn others(log: &Log, (from, until): (Duration, Duration)) -> Vec<Other> {
    let mut others = BTreeMap::<u8, Vec<[f64; 3]>>::new();
    for (at, heard) in log.neighbours().filter(|(at, _)| (from..=until).contains(at)) {
        let at_s = at.as_secs_f64();
        let numbers = [Some(at_s), short(heard.place_m.x), short(heard.place_m.y)];
        let [Some(at_s), Some(x_m), Some(y_m)] = numbers else { continue };
        if others.len() == MOST_VEHICLES && !others.contains_key(&heard.system) {
            continue;
        }
        let places = others.entry(heard.system).or_default();
        let is_due = places.last().is_none_or(|[last_s, ..]| at_s >= last_s + INTERVAL_S);
        if is_due && places.len() < MOST_PLACES {
            places.push([at_s, x_m, y_m]);
        }
    }
    others.into_iter().map(|(system, places)| Other { system, places }).collect()
}
