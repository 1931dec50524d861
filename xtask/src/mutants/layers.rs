//! Mutants of a layer behind others that work. Random flights do not detect them, but `system_tests::rules` has flights
//! for each.

use super::list::{AGENT, ESTIMATOR, Expected, FENCE, Mutant, SAFETY, mutant};
use crate::edit::{edit, layered};

const BELIEF: &str = "estimator/src/belief.rs";
const VELOCITY_GATE: &str = "estimator/src/velocity_gate.rs";
const HEADING: &str = "estimator/src/heading.rs";
const RESPONSE: &str = "estimator/src/response.rs";
const UNCERTAINTY: &str = "estimator/src/uncertainty.rs";
const TAG_FILTER: &str = "estimator/src/world/filter.rs";
const SATURATION: &str = "autopilot/src/vehicle/saturation.rs";
const TAKE_OFF: &str = "ardrone-link/src/session/take_off.rs";
const SILENCE: &str = "ardrone-link/src/session/silence.rs";

/// A mistake that another layer makes up for.
const fn covered(
    name: &'static str,
    file: &'static str,
    from: &'static str,
    to: &'static str,
) -> Mutant {
    Mutant { expected: Expected::Nothing, ..mutant(name, file, from, to) }
}

/// All of them.
pub(super) const MUTANTS: &[Mutant] = &[
    // Estimation.
    mutant(
        "an altitude of the floor is believed",
        ESTIMATOR,
        "by_sticks && sample.altitude_m < ON_FLOOR_M;",
        "by_sticks && sample.altitude_m + ON_FLOOR_M < f64::MIN;",
    ),
    mutant(
        "a disproved quantity is believed at once",
        BELIEF,
        "self.disproved = Some((cause, since_s, at_s + HOLDS_S));",
        "self.disproved = Some((cause, since_s, at_s + 0.0 * HOLDS_S));",
    ),
    mutant(
        "the first velocity of a flight is any",
        ESTIMATOR,
        "            self.velocity_gate.rest();\n",
        "",
    ),
    mutant(
        "a gap lets any velocity in",
        VELOCITY_GATE,
        "let allowed_m_s = GATE * ",
        "let allowed_m_s = 10.0 * (step_s - USUAL_STEP_S).max(0.0) + GATE * ",
    ),
    mutant(
        "a compass that hangs in a turn is believed",
        HEADING,
        "if repeated && angle_deg.abs() > STUCK_DEG {",
        "if repeated && angle_deg.abs() > STUCK_DEG.max(1e9) {",
    ),
    layered(
        mutant(
            "a drone that receives nothing turns as ordered",
            HEADING,
            "let rate_deg_s = self.measured_deg_s();",
            "let rate_deg_s = self.turn_deg_s;",
        ),
        &[edit(
            HEADING,
            "model.turned(self.measured_deg_s(), last_s, at_s).1;",
            "model.turned(self.turn_deg_s, last_s, at_s).1;",
        )],
    ),
    mutant(
        "a step of the compass in a turn is a part of it",
        HEADING,
        "stepped = surprise_deg > MAX_SURPRISE_DEG",
        "stepped = surprise_deg > 3.0 * angle_deg.abs() + MAX_SURPRISE_DEG",
    ),
    mutant(
        "a drone that leans and turns has a dead velocity",
        RESPONSE,
        "Axis::turn(right, forward, turned_deg);",
        "Axis::turn(right, forward, 0.0 * turned_deg);",
    ),
    mutant(
        "rejected velocities leave no uncertainty",
        UNCERTAINTY,
        "self.disputed_m += surprise_m_s",
        "self.disputed_m += 0.0 * surprise_m_s",
    ),
    mutant(
        "every sighting near a tag is one of it",
        TAG_FILTER,
        "squared_deviations(off, spread) < GATE * GATE",
        "squared_deviations(off, spread) < GATE * f64::INFINITY",
    ),
    // The safety monitor and the flight.
    mutant(
        "no ceiling",
        FENCE,
        "&& place.z_m <= self.ceiling_m + margin_m",
        "&& place.z_m <= self.ceiling_m + margin_m.max(1e9)",
    ),
    mutant(
        "it is forgotten that the drone must stay down",
        SAFETY,
        "matches!(self.state, State::Landing { .. } | State::StaysDown)",
        "matches!(self.state, State::Landing { .. })",
    ),
    mutant(
        "a drone that makes no progress flies on",
        SATURATION,
        "across || up || storm || blocked {",
        "across || up || storm || blocked && step_s < 0.0 {",
    ),
    mutant(
        "a target is approached for ever",
        AGENT,
        "approachTime(60000).",
        "approachTime(2000000000).",
    ),
    // Two layers against streams of orders: a hold that is not begun anew needs no brake.
    covered(
        "nothing brakes at the fence",
        SAFETY,
        "let left = self.brake.leave(demand);",
        "let left = Brake::default().leave(demand);",
    ),
    // Two layers against blindness: the agent lands first.
    covered(
        "guard never lands blind",
        SAFETY,
        "if now.blind_for > BLIND {",
        "if now.blind_for > BLIND.max(Duration::MAX) {",
    ),
    layered(
        mutant(
            "guard never lands blind, agent without @blind",
            SAFETY,
            "if now.blind_for > BLIND {",
            "if now.blind_for > BLIND.max(Duration::MAX) {",
        ),
        &[edit(
            AGENT,
            "@blind[req(\"SAF-5\")]\n+!watch : ",
            "@blind[req(\"SAF-5\")]\n+!watch : battery(Charge) & Charge < 0 & ",
        )],
    ),
    // Two layers against an old order to fly: what is not heard gets no order at all.
    covered(
        "the take-off latch is ignored",
        TAKE_OFF,
        "*self = Self::Withheld { landing_ordered: false };",
        "*self = Self::Follow { airborne: true };",
    ),
    layered(
        mutant(
            "a drone that is not heard is ordered to fly",
            SILENCE,
            "self.returned_at.is_none() && now.saturating_sub(self.at) < UNHEARD",
            "now.saturating_sub(self.at) < Duration::MAX",
        ),
        &[edit(
            TAKE_OFF,
            "*self = Self::Withheld { landing_ordered: false };",
            "*self = Self::Follow { airborne: true };",
        )],
    ),
];
