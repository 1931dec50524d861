//! The course of a drone without control. How far it goes then is beyond the responsibility of the pilot.

use std::time::Duration;

use ardrone_link::at::{Command, Datagram, Motion, Ref};
use autopilot::vehicle::TICK;
use mock_drone::firmware::Phase;
use mock_drone::{Drone, Truth};

/// Time of hovering before the landing is ordered.
const HOVERS: Duration = Duration::from_secs(2);
/// Time after which every drone is down.
const ENOUGH: Duration = Duration::from_secs(25);

/// A drone that receives nothing any more: it flies on with its last sticks, then hovers and lands by itself.
pub(crate) fn unheard(drone: &Drone, see: impl FnMut(&Truth)) {
    live(drone, Duration::MAX, see);
}

/// A drone that flies on with its last sticks for `time`, is then ordered to hover, and two seconds later to
/// land.
pub(crate) fn flies_on_and_lands(drone: &Drone, time: Duration, see: impl FnMut(&Truth)) {
    live(drone, time, see);
}

fn live(drone: &Drone, silent: Duration, mut see: impl FnMut(&Truth)) {
    let mut drone = drone.clone();
    let mut lived = Duration::ZERO;
    let start = drone.time();
    let mut sequence = 0;
    while lived < ENOUGH && !is_at_rest(&drone.truth()) {
        if lived >= silent {
            let reference = if lived < silent + HOVERS { Ref::TakeOff } else { Ref::Land };
            let mut datagram = Datagram::new();
            for command in [Command::Ref(reference), Command::Pcmd(Motion::Hover)] {
                // Number 1 resets the sequence.
                sequence += 1;
                // Two commands always fit into a datagram.
                _ = datagram.push(sequence, &command);
            }
            drone.handle_at(start + lived, datagram.as_bytes());
        }
        lived += TICK;
        drone.advance(start + lived);
        see(&drone.truth());
    }
}

fn is_at_rest(truth: &Truth) -> bool {
    matches!(truth.phase, Phase::Landed | Phase::Emergency) && truth.position_m.z <= 0.0
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use ardrone_link::at::{Command, Config, Datagram, Fraction, Motion, Ref};
    use mock_drone::{Drone, DroneConfig};

    use super::*;

    /// A drone that has been flying forward at full tilt for one second.
    fn on_its_way() -> Drone {
        let mut drone = Drone::new(&DroneConfig::default());
        drone.handle_wake_up(Duration::ZERO);
        let none = Fraction::saturating(0.0);
        let pitch = Fraction::saturating(-1.0);
        let forward = Motion::Progressive { roll: none, pitch, gaz: none, yaw: none };
        let mut now = Duration::ZERO;
        let mut sequence = 0;
        while now < Duration::from_secs(7) {
            let motion = if now < Duration::from_secs(6) { Motion::Hover } else { forward };
            let demo = Config::new("general:navdata_demo", "TRUE").unwrap();
            let mut datagram = Datagram::new();
            for command in
                [Command::Config(demo), Command::Ref(Ref::TakeOff), Command::Pcmd(motion)]
            {
                sequence += 1;
                datagram.push(sequence, &command).unwrap();
            }
            assert_eq!(drone.handle_at(now, datagram.as_bytes()), []);
            now += TICK;
            drone.advance(now);
        }
        drone
    }

    #[test]
    fn a_drone_that_hears_nothing_flies_on_and_lands_by_itself() {
        let drone = on_its_way();
        let start_m = drone.truth().position_m.y;
        let reach_m = |silent| {
            let mut furthest_m = 0.0_f64;
            let mut last = drone.truth();
            live(&drone, silent, |truth| {
                furthest_m = furthest_m.max(truth.position_m.y - start_m);
                last = *truth;
            });
            assert_eq!(last.phase, Phase::Landed);
            furthest_m
        };
        let (ordered_m, unheard_m) = (reach_m(Duration::ZERO), reach_m(Duration::MAX));
        assert!((0.3..2.5).contains(&ordered_m), "{ordered_m}");
        assert!((4.0..8.0).contains(&unheard_m), "its last sticks for two seconds: {unheard_m}");
    }
}
