//! Mutants that the fault campaign must detect. Each replaced text must occur exactly once in its file. When
//! the code has changed, adapt the mutant rather than drop it.

use crate::edit::{self, edit, layered};

/// The workspace with one mistake.
pub(super) type Mutant = edit::Mutant<Expected>;

/// What the judge must find.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Expected {
    /// A fault.
    Fault,
    /// None, because another layer protects against the same danger. A mutant of both layers shows that the flights
    /// lead into the danger.
    Nothing,
}

pub(super) const AGENT: &str = "autopilot/agent/autopilot.asl";
const BINDING: &str = "autopilot/src/agent.rs";
const ACTIVITY: &str = "autopilot/src/agent/activity.rs";
pub(super) const SAFETY: &str = "autopilot/src/safety.rs";
pub(super) const FENCE: &str = "autopilot/src/fence.rs";
const DESCENT: &str = "autopilot/src/safety/descent.rs";
const FLIGHT: &str = "autopilot/src/vehicle/flight.rs";
const TICK: &str = "autopilot/src/vehicle/tick.rs";
const CONTROL: &str = "autopilot/src/vehicle/control.rs";
const WATCH: &str = "autopilot/src/vehicle/watch.rs";
const ORDERS: &str = "autopilot/src/vehicle/orders.rs";
const OPERATORS: &str = "autopilot/src/vehicle/operators.rs";
const MANUAL: &str = "autopilot/src/vehicle/manual.rs";
const MANUAL_ORDERS: &str = "autopilot/src/vehicle/manual_orders.rs";
const STOPPING: &str = "autopilot/src/safety/stopping.rs";
pub(super) const ESTIMATOR: &str = "estimator/src/lib.rs";
const FRAME: &str = "kinematics/src/frame.rs";
const TAGS: &str = "estimator/src/world/mod.rs";
const TAG_MAP: &str = "estimator/src/world/map.rs";
const HORIZONTAL: &str = "estimator/src/horizontal.rs";

pub(super) const fn mutant(
    name: &'static str,
    file: &'static str,
    from: &'static str,
    to: &'static str,
) -> Mutant {
    Mutant { name, first: edit(file, from, to), more: &[], expected: Expected::Fault }
}

/// Mutants that random flights, landings with gaps or single sensor faults detect.
pub(super) const MUTANTS: &[Mutant] = &[
    // Estimation.
    mutant(
        "no integration: the place never moves",
        HORIZONTAL,
        "self.position_m = position_m;",
        "self.position_m = position_m * 0.0;",
    ),
    mutant(
        "half of each velocity",
        FLIGHT,
        "velocity_forward_m_s: demo.velocity_forward_m_s,\n        velocity_right_m_s: demo.velocity_right_m_s,",
        "velocity_forward_m_s: 0.5 * demo.velocity_forward_m_s,\n        velocity_right_m_s: 0.5 * demo.velocity_right_m_s,",
    ),
    mutant(
        "right is left",
        FLIGHT,
        "velocity_right_m_s: demo.velocity_right_m_s,",
        "velocity_right_m_s: -demo.velocity_right_m_s,",
    ),
    mutant(
        "the heading turns no velocity",
        FRAME,
        "Rotation2::new(-yaw_deg.to_radians())",
        "Rotation2::new(0.0 * yaw_deg)",
    ),
    layered(
        mutant(
            "the heading turns velocities the wrong way",
            FRAME,
            "Rotation2::new(-yaw_deg.to_radians())",
            "Rotation2::new(1.0 * yaw_deg.to_radians())",
        ),
        &[edit(
            FRAME,
            "Rotation2::new(yaw_deg.to_radians())",
            "Rotation2::new(-1.0 * yaw_deg.to_radians())",
        )],
    ),
    mutant(
        "the altitude is always 0.8 m",
        FLIGHT,
        "altitude_m: demo.altitude_m,",
        "altitude_m: 0.8 + 0.0 * demo.altitude_m,",
    ),
    mutant(
        "the place is always certain",
        ESTIMATOR,
        "known_m.hypot(uncertainty::silence_m(",
        "0.0 * known_m.hypot(uncertainty::silence_m(",
    ),
    mutant("navdata are always believed", ESTIMATOR, "self.beliefs.trust()", "Trust::Sound"),
    // Safety monitor.
    mutant(
        "no fence",
        SAFETY,
        "Self {\n            fence,",
        "let fence = FlightLimits { z_origin: fence.z_origin, ..FlightLimits::NONE };\n        Self {\n            fence,",
    ),
    mutant(
        "no vetoes at all",
        SAFETY,
        "if now.emergency && flies {",
        "if flies == flies {\n            return (command, None);\n        }\n        if now.emergency && flies {",
    ),
    mutant("guard off in the air", SAFETY, "if !now.airborne {", "if now.airborne {"),
    mutant(
        "the fence holds the drone outside",
        FENCE,
        "self.outside_m(place) <= margin_m && place.z_m",
        "self.outside_m(place) >= margin_m && place.z_m",
    ),
    mutant(
        "the ceiling holds the drone above",
        FENCE,
        "&& place.z_m <= self.ceiling_m + margin_m",
        "&& place.z_m >= self.ceiling_m + margin_m",
    ),
    mutant(
        "floor and ceiling changed places",
        SAFETY,
        "Self {\n            fence,",
        "let fence = FlightLimits { ceiling_m: fence.floor_m, floor_m: fence.ceiling_m, ..fence };\n        Self {\n            fence,",
    ),
    layered(
        mutant(
            "stale navdata are flown by",
            SAFETY,
            "moves && now.blind_for > STALE",
            "moves && now.blind_for > Duration::MAX",
        ),
        &[edit(AGENT, "holdWhenBlind(300).", "holdWhenBlind(2000000000).")],
    ),
    // The agent.
    mutant(
        "agent without @blind",
        AGENT,
        "@blind[req(\"SAF-5\")]\n+!watch : ",
        "@blind[req(\"SAF-5\")]\n+!watch : battery(Charge) & Charge < 0 & ",
    ),
    mutant(
        "agent without @lost",
        AGENT,
        "@lost[req(\"SAF-5\")]\n+!watch : ",
        "@lost[req(\"SAF-5\")]\n+!watch : battery(Charge) & Charge < 0 & ",
    ),
    layered(
        mutant(
            "agent without @too_weak, guard without storms",
            AGENT,
            "@too_weak[req(\"SAF-5\")]\n+!watch : ",
            "@too_weak[req(\"SAF-5\")]\n+!watch : battery(Charge) & Charge < 0 & ",
        ),
        &[
            edit(
                SAFETY,
                "} else if is_carried_off(now, &self.fence.border) {",
                "} else if is_carried_off(now, &self.fence.border) && now.blind_for > BLIND {",
            ),
            edit(
                DESCENT,
                "let is_hopeless = outside_m > 0.0 && self.way_back.is_none(now);",
                "let is_hopeless = false;",
            ),
        ],
    ),
    mutant(
        "landWhenBlind(2000000000)",
        AGENT,
        "landWhenBlind(2000).",
        "landWhenBlind(2000000000).",
    ),
    layered(
        mutant(
            "a landing is forgotten after a gap",
            AGENT,
            "@landed[req(\"SAF-2\")]\n",
            "+!comeDown : blindFor(Time) & holdWhenBlind(Limit) & Time > Limit\n  <- sendHover;\n     !!wait.\n\n@landed[req(\"SAF-2\")]\n",
        ),
        &[edit(
            SAFETY,
            "if command == AgentCommand::Land {",
            "if command == AgentCommand::Land && flies != flies {",
        )],
    ),
    mutant(
        "goals are flown 1000 m off",
        BINDING,
        "fn send_goto(&mut self, x_m: f64, y_m: f64, z_m: f64, yaw_deg: f64) {",
        "fn send_goto(&mut self, x_m: f64, y_m: f64, z_m: f64, yaw_deg: f64) {\n        let x_m = x_m + 1000.0;",
    ),
    mutant(
        "the battery is always full",
        TICK,
        "if empty { 0 } else { demo.battery_percent }",
        "if empty { 100 } else { demo.battery_percent.max(100) }",
    ),
    mutant(
        "never blind",
        TICK,
        "fn blind_for(&self, now: Duration) -> Duration {\n",
        "fn blind_for(&self, now: Duration) -> Duration {\n        let now = now.min(Duration::ZERO);\n",
    ),
    mutant(
        "every place is reached",
        BINDING,
        "distance(&pose, &target) <= distance_m",
        "distance(&pose, &target) >= 0.0",
    ),
    layered(
        mutant(
            "flown against a storm on the way down",
            AGENT,
            "Share > Breeze & Share < Storm",
            "Share > Breeze & Storm > 0.0",
        ),
        &[
            edit(
                AGENT,
                "landWhenSaturated(Most) & Weak <= Most",
                "landWhenSaturated(Most) & Weak >= 0 & Most >= 0",
            ),
            edit(
                DESCENT,
                "sinks || !is_hopeless),\n            Cause::CarriedOff => (Some(self.upwind), sinks),",
                "sinks || is_hopeless || !is_hopeless),\n            Cause::CarriedOff => (Some(self.upwind), true),",
            ),
        ],
    ),
    // Commands sent.
    mutant(
        "the roll stick is the wrong way round",
        CONTROL,
        "roll: Fraction::saturating(demand.roll),",
        "roll: Fraction::saturating(-demand.roll),",
    ),
    mutant(
        "the pitch stick is the wrong way round",
        CONTROL,
        "pitch: Fraction::saturating(demand.pitch),",
        "pitch: Fraction::saturating(-demand.pitch),",
    ),
    mutant(
        "the climb stick is the wrong way round",
        CONTROL,
        "gaz: Fraction::saturating(demand.gaz),",
        "gaz: Fraction::saturating(-demand.gaz),",
    ),
    // The flight as a whole.
    layered(
        mutant(
            "a hold takes a landing back",
            ORDERS,
            "if self.lands() {\n            Err(Refused::Landing)\n        } else if self.is_foreign() {\n            Err(Refused::FlownByAnother)\n        } else if self.life.flying().is_none() || self.on_ground()",
            "if self.on_ground()",
        ),
        &[
            edit(
                ORDERS,
                "self.hold_here();",
                "self.hold_here();\n                _ = self.flight.agent.achieve_hold();",
            ),
            edit(AGENT, "+!hold : comingDown\n", "+!hold : comingDown & onGround\n"),
            edit(
                SAFETY,
                "if command == AgentCommand::Land {",
                "if command == AgentCommand::Land && flies != flies {",
            ),
        ],
    ),
    mutant(
        "the pilot's landing order is lost",
        ORDERS,
        "land_here();\n                self.land(now, LandingReason::Operator);",
        "land_here();",
    ),
    mutant(
        "a step that failed counts as done",
        TICK,
        "if report != Report::Done {",
        "if report != report {",
    ),
    mutant(
        "the flight ends before the drone is down",
        WATCH,
        "let landed = self.is_over(now);",
        "let landed = self.session.is_alive();",
    ),
    // Streams of orders.
    mutant(
        "each order to hold begins the hold anew",
        ACTIVITY,
        "(Some((Pursuit::Staying, _)), Some(place)) => place,",
        "(Some((Pursuit::Staying, _)), Some(place)) if pose.z_m.is_nan() => place,",
    ),
    // Whoever flies from elsewhere.
    layered(
        mutant(
            "station: anybody's presence counts for it",
            OPERATORS,
            "if self.holder == Some(by) {",
            "if self.holder.is_some_and(|holder| holder.station == by.station) {",
        ),
        &[edit(OPERATORS, "&& *operator == by", "&& operator.station == by.station")],
    ),
    mutant(
        "station: its silence is never counted",
        OPERATORS,
        "now.saturating_sub(heard)",
        "heard.saturating_sub(now)",
    ),
    mutant(
        "station: setpoints are always new",
        MANUAL,
        "let age = now.saturating_sub(at);",
        "let age = at.saturating_sub(now);",
    ),
    mutant(
        "station: a mission that waits for it goes on by itself",
        MANUAL_ORDERS,
        "*mode = Mode::Hold;\n                self.events.push_back(FlightEvent::PausedForStation);",
        "*mode = Mode::Mission;\n                self.events.push_back(FlightEvent::PausedForStation);",
    ),
    mutant(
        "station: without it the mission is flown on until it lands",
        TICK,
        "hold_after_ms: ms(self.config.station.hold_after),",
        "hold_after_ms: ms(self.config.station.land_after),",
    ),
    mutant(
        "station: without it the drone holds for ever",
        TICK,
        "land_after_ms: ms(self.config.station.land_after),",
        "land_after_ms: ms(self.config.station.land_after * 1_000_000),",
    ),
    mutant(
        "station: without setpoints the drone holds for ever",
        AGENT,
        "landWithoutSetpoints(10500).",
        "landWithoutSetpoints(2000000000).",
    ),
    mutant(
        "station: setpoints of ten seconds ago are flown",
        AGENT,
        "holdWithoutSetpoints(500).",
        "holdWithoutSetpoints(10000).",
    ),
    layered(
        mutant(
            "station: setpoints lead out of the fence",
            STOPPING,
            "(velocity_m_s.dot(&wall.outward) - most_m_s).max(0.0)",
            "(0.0 * velocity_m_s.dot(&wall.outward) - most_m_s).max(0.0)",
        ),
        &[
            edit(
                MANUAL_ORDERS,
                "*target = fence.nearest_inside(&wanted, INSIDE_M);",
                "*target = wanted;",
            ),
            edit(
                FENCE,
                "self.outside_m(place) <= margin_m && place.z_m",
                "self.outside_m(place) <= margin_m.max(1e9) && place.z_m",
            ),
            edit(
                SAFETY,
                "fence.stop_before(&now.pose, &inside, BEYOND_M, INSIDE_M)",
                "fence.stop_before(&now.pose, &inside, BEYOND_M.max(1e9), INSIDE_M)",
            ),
        ],
    ),
    // Tags.
    mutant(
        "a tag that is seen again is the nearest known one, however far",
        TAG_MAP,
        "let is_it = alone\n            && self.is_out_of_view(nearest, now_s)\n            && filter.may_be_one(trial, nearest, way_m);",
        "let is_it = self.is_out_of_view(nearest, now_s) && (alone || way_m < f64::MAX);",
    ),
    mutant(
        "tags leave no uncertainty",
        TAGS,
        "(self.filter.place_variance_m2() + squares).sqrt()",
        "(self.filter.place_variance_m2() + squares) * 0.0",
    ),
    mutant(
        "tags correct the place twice",
        TAGS,
        "odometry_m + self.filter.correction().place_m",
        "odometry_m + 2.0 * self.filter.correction().place_m",
    ),
];
