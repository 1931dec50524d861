//! Fleets that meet on purpose: through one point, in a corridor, and as they take off beside each other, where all must arrive;
//! and at one that lies.

use std::time::Duration;

use autopilot::plan::Border;
use autopilot::vehicle::{Start, VehicleConfig};
use kinematics::world_from_body;
use mock_drone::WorldConfig;
use nalgebra::Vector2;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::{Air, Falsehood, Fleet, Injected, Lie, Member};

/// A corridor is so long from its middle, and its vehicles fly so far from there.
const LENGTH_M: f64 = 5.5;
const ENDS_M: f64 = 4.0;
/// Who takes off beside another one knows its place with this standard deviation: what is kept between them is more than they have.
const UNSURE_M: f64 = 0.2;

/// Vehicles on a circle, each of which flies to the opposite place: through one point.
pub fn crossing(count: usize, radius_m: f64, seed: u64) -> Fleet {
    let members = (0..count).map(|number| {
        #[expect(clippy::cast_precision_loss, reason = "a fleet is small")]
        let angle_deg = 360.0 * number as f64 / count as f64;
        let place_m = world_from_body(Vector2::new(0.0, -radius_m), angle_deg);
        let mut world = WorldConfig::default();
        world.drone.seed = seed * 100 + number as u64;
        let [x_m, y_m] = (-place_m).into();
        Member {
            start: Start { place_m, heading_deg: angle_deg, ..Start::default() },
            plan: format!("takeoff\ngoto {x_m} {y_m} 0.5 0\nland\n"),
            world,
            pilot: VehicleConfig::default(),
            orders: Vec::new(),
            stands: None,
            is_foreign: false,
            injected: Injected::default(),
        }
    });
    Fleet { members: members.collect(), air: Air { seed, ..Air::default() } }
}

/// Two that swap places in a corridor, so that one of them has to make way, and in half of the corridors one more that hovers in
/// its middle.
pub fn corridor(seed: u64) -> Fleet {
    let mut random = ChaCha8Rng::seed_from_u64(seed ^ 0x636f_7272);
    let hovers = seed.is_multiple_of(2);
    // In narrower ones not all arrive.
    let half_m: f64 = random.random_range(if hovers { 2.0..2.5 } else { 1.7..2.2 });
    let mut aside_m = || random.random_range(-0.3..0.3);
    let [one_m, other_m, middle_m] = [aside_m(), aside_m(), aside_m()];
    let border = Border::polygon(&[
        [-LENGTH_M, -half_m],
        [LENGTH_M, -half_m],
        [LENGTH_M, half_m],
        [-LENGTH_M, half_m],
    ]);
    let mut flights =
        vec![([-ENDS_M, one_m], [ENDS_M, one_m], 1), ([ENDS_M, other_m], [-ENDS_M, other_m], 1)];
    if hovers {
        flights.remove(1);
        flights.push(([0.5, middle_m], [0.5, middle_m], 30));
    }
    let mut fleet = crossing(flights.len(), 1.0, seed);
    for (member, (from_m, [x_m, y_m], stay_s)) in fleet.members.iter_mut().zip(flights) {
        member.start = Start { place_m: from_m.into(), ..Start::default() };
        member.plan = format!("takeoff\nsetStayTime {stay_s}\ngoto {x_m} {y_m} 0.5 0\nland\n");
        // A rectangle is a polygon.
        if let Ok(border) = border {
            member.pilot.limits.border = border;
        }
    }
    fleet
}

/// Two that want to take off at once, so near to each other that one of them has to wait: they fly away from each other.
pub fn take_off(seed: u64) -> Fleet {
    let mut random = ChaCha8Rng::seed_from_u64(seed ^ 0x6c69_6674);
    let apart_m: f64 = random.random_range(1.6..1.9);
    let mut fleet = crossing(2, apart_m / 2.0, seed);
    for member in &mut fleet.members {
        member.start.uncertainty_m = UNSURE_M;
        let [x_m, y_m] = (member.start.place_m * 3.0).into();
        member.plan = format!("takeoff\ngoto {x_m} {y_m} 0.5 0\nland\n");
    }
    fleet
}

/// One whose way leads through a place at which another one hovers, which keeps away from nobody, and tells from a moment on that it
/// is where it cannot have got to: the first one may not believe that its way is free, and lands at the latest.
pub fn liar(seed: u64) -> Fleet {
    let mut random = ChaCha8Rng::seed_from_u64(seed ^ 0x6c69_6172);
    let mut fleet = crossing(1, 4.0, seed);
    let mut middle = crossing(1, 0.0, seed * 100 + 99).members;
    for member in &mut middle {
        member.is_foreign = true;
        "takeoff\nsetStayTime 40\ngoto 0 0 0.5 0\nland\n".clone_into(&mut member.plan);
    }
    let who = fleet.members.len();
    fleet.members.append(&mut middle);
    let since = Duration::from_secs_f64(random.random_range(3.5..6.5));
    let off_m = Vector2::new(random.random_range(4.0..8.0), 0.0);
    let what = if seed.is_multiple_of(2) {
        Falsehood::Place(off_m)
    } else {
        Falsehood::Jumps(off_m.norm())
    };
    fleet.air.lie = Some(Lie { who, since, what });
    fleet
}
