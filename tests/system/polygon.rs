//! Flights in a fence that is a polygon with a corner that points in: an L.

use std::thread;
use std::time::Duration;

use autopilot::plan::{Border, FlightLimits, Plan};
use autopilot::safety::Veto;
use autopilot::vehicle::{
    FlightEvent, Heading, Horizontal, LandingReason, Operator, OperatorOrder, Place, Setpoint,
    VehicleConfig, Vertical,
};
use kinematics::Sticks;
use mock_drone::airframe::Profile;
use mock_drone::firmware::Phase;
use mock_drone::scenario::Scenario;
use mock_drone::{DroneConfig, WorldConfig};
use nalgebra::Vector2;
use system_tests::place_in_navdata_frame;
use system_tests::sim::{SimulatedFlight, Simulation};
use system_tests::streams::L_M;

const SECOND: Duration = Duration::from_secs(1);
const PROFILES: [fn() -> Profile; 4] = [Profile::rec, Profile::tum, Profile::tf, Profile::leo];
/// Where manual control begins: in the middle, and in both legs.
const FROM_M: [[f64; 2]; 3] = [[0.0, 2.5], [0.0, -2.0], [3.0, 2.5]];
/// Distance outside that is allowed with a working link, as in the campaign.
const OUTSIDE_M: f64 = 0.5;

fn fence() -> FlightLimits {
    FlightLimits::new(Border::polygon(&L_M).unwrap(), 0.3, 3.0)
}

/// A flight to a place, where what others order begins after 14 s; and how far outside it led before it was ordered to land,
/// since the drone's own landing drifts.
fn fly(
    profile: fn() -> Profile,
    wind: &str,
    plan: &str,
    others: Vec<(Duration, Operator, OperatorOrder)>,
) -> (SimulatedFlight, f64) {
    let drone = DroneConfig { profile: profile(), ..DroneConfig::default() };
    let scenario = Scenario::parse("scenario", wind).unwrap();
    let world = WorldConfig { drone, scenario, ..WorldConfig::default() };
    let pilot = VehicleConfig { limits: fence(), ..VehicleConfig::default() };
    let simulation = Simulation { world, pilot, others, ..Simulation::default() };
    let plan = Plan::parse_within("plan", plan, &fence()).unwrap();
    let lands = simulation.others.iter().find(|(.., order)| *order == OperatorOrder::Land);
    let lands_at = lands.map_or(Duration::MAX, |(at, ..)| *at);
    let mut outside_m = f64::NEG_INFINITY;
    let flight = simulation.fly_watched(plan, |moment| {
        let is_up = matches!(moment.truth.phase, Phase::Flying | Phase::Landing);
        if is_up && moment.now < lands_at {
            let place_m = place_in_navdata_frame(&moment.truth).xy();
            outside_m = outside_m.max(fence().border.outside_m(place_m));
        }
    });
    (flight.unwrap(), outside_m)
}

fn from([x_m, y_m]: [f64; 2]) -> String {
    format!(
        "takeoff\nsetReference $START$\ngoto 0 2.5 1 0\ngoto {x_m} {y_m} 1 0\nsetStayTime 90\ngoto {x_m} {y_m} 1 0\nland\n"
    )
}

/// The same order ten times a second for 12 s, then the landing.
fn held(order: &OperatorOrder) -> Vec<(Duration, Operator, OperatorOrder)> {
    let at = |tenth: u32| 14 * SECOND + SECOND / 10 * tenth;
    let again = (0..120).map(|tenth| (at(tenth), Operator::TERMINAL, order.clone()));
    again.chain([(at(130), Operator::TERMINAL, OperatorOrder::Land)]).collect()
}

/// What is wrong with held orders in sixteen directions, from each of the places, on each airframe, in calm and in wind.
fn led_outside(order: impl Fn(f64) -> OperatorOrder + Sync) -> Vec<String> {
    let order = &order;
    thread::scope(|scope| {
        let threads = PROFILES.map(|profile| {
            scope.spawn(move || {
                let mut found = Vec::new();
                for from_m in FROM_M {
                    for direction in 0..16_u32 {
                        let angle = f64::from(direction) * std::f64::consts::TAU / 16.0;
                        for wind in ["", "0 wind 0.5 -0.3 gusts 0.2"] {
                            let (flight, outside_m) = fly(profile, wind, &from(from_m), held(&order(angle)));
                            let name = flight.final_truth.phase;
                            if outside_m > OUTSIDE_M || name != Phase::Landed {
                                found.push(format!(
                                    "{direction}/16 from {from_m:?} in {wind:?}: {outside_m:.2} m outside, {name:?}"
                                ));
                            }
                        }
                    }
                }
                found
            })
        });
        threads.into_iter().flat_map(|thread| thread.join().unwrap()).collect()
    })
}

#[test]
fn held_sticks_lead_over_no_side_and_into_no_corner() {
    let found = led_outside(|angle| {
        OperatorOrder::Steer(Sticks { roll: angle.sin(), pitch: -angle.cos(), ..Sticks::default() })
    });
    assert!(found.is_empty(), "{}:\n{}", found.len(), found.join("\n"));
}

#[test]
fn set_points_lead_over_no_side_and_into_no_corner() {
    let found = led_outside(|angle| {
        OperatorOrder::Follow(Setpoint {
            horizontal: Horizontal::Velocity { x_m_s: 2.0 * angle.sin(), y_m_s: 2.0 * angle.cos() },
            vertical: Vertical::Climb(0.0),
            heading: Heading::Keep,
        })
    });
    assert!(found.is_empty(), "{}:\n{}", found.len(), found.join("\n"));
}

#[test]
fn a_place_outside_is_flown_to_as_near_as_there_is_a_straight_way() {
    for profile in PROFILES {
        for (from_m, to_m, ends_m, veto) in [
            // Beyond a side, and beyond the outer corner: half a metre inside, as by hand.
            ([0.0, 2.5], [-9.0, 2.0], [-2.5, 2.0], None),
            ([0.0, 2.5], [9.0, 9.0], [3.5, 3.5], None),
            // Outside in the notch: the nearest place is half a metre inside.
            ([0.0, -2.0], [2.5, -2.0], [1.0, -2.0], None),
            // Behind the notch: the way would lead over it, and does not from where it stops.
            ([0.0, -2.0], [3.5, 1.8], [3.5, 1.8], Some(Veto::WayOutside)),
        ] {
            let to = Place { height_m: Some(1.0), ..Place::at(to_m[0], to_m[1]) };
            let orders = vec![
                (14 * SECOND, Operator::TERMINAL, OperatorOrder::GoTo(to)),
                (30 * SECOND, Operator::TERMINAL, OperatorOrder::Land),
            ];
            let (flight, outside_m) = fly(profile, "", &from(from_m), orders);
            let last_m = place_in_navdata_frame(&flight.final_truth).xy();
            let off_m = (last_m - Vector2::from(ends_m)).norm();
            assert!(off_m < 0.4 && outside_m < 0.0, "{to_m:?}: {last_m}, {outside_m:.2} m outside");
            let mut vetoes = flight.events.iter().rev().filter_map(|(_, event)| match event {
                FlightEvent::Veto(veto) => Some(*veto),
                _ => None,
            });
            assert_eq!(vetoes.next(), veto, "{to_m:?}");
        }
    }
}

#[test]
fn a_plan_whose_straight_way_leaves_the_fence_is_refused() {
    let text = "takeoff\nsetReference $START$\ngoto 0 -2 1 0\ngoto 3 2 1 0\nland\n";
    let (plan, found) = Plan::review(text, &fence());
    assert!(plan.is_none());
    let [problem] = &found[..] else { panic!("{found:?}") };
    assert_eq!(problem.message, "the straight way to this target leaves the fence at 1.50 0.00");
    assert_eq!(&text[problem.span.clone()], "goto 3 2 1 0");
    let around = text.replace("goto 3 2", "goto 0 2 1 0\ngoto 3 2");
    assert!(Plan::parse_within("plan", &around, &fence()).is_ok());
    let outside = Plan::parse_within("plan", &around.replace("goto 3 2", "goto 3 0"), &fence());
    let error = outside.unwrap_err().to_string();
    assert!(error.contains("target 1.20 m outside the fence"), "{error}");
}

/// The drone is landed as it is in a round fence, not later.
#[test]
fn a_storm_toward_a_border_lands_the_drone_before_it_is_far_outside() {
    for (wind, from_m) in
        [("0 wind 0 2", [0.0, 2.5]), ("0 wind 2 0", [-2.0, 2.5]), ("0 wind -2 0", [0.0, 2.5])]
    {
        let (flight, outside_m) = fly(Profile::tf, wind, &from(from_m), Vec::new());
        let lands = flight.events.iter().any(|(_, event)| {
            matches!(
                event,
                FlightEvent::LandingOrdered(
                    LandingReason::Wind
                        | LandingReason::Safety(Veto::CarriedOff | Veto::OutsideFence)
                )
            )
        });
        let phase = flight.final_truth.phase;
        assert!(
            lands && phase == Phase::Landed && outside_m < 2.0,
            "{wind}: {outside_m:.2} m, {:?}",
            flight.events
        );
    }
}
