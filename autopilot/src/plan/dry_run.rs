//! Execution of a plan without a drone.

use kinematics::Pose;
use nalgebra::Vector2;

use super::interpreter::{AgentOrder, Interpreter};
use super::{Command, FlightLimits};

/// Executes a plan with an ideal drone, which hovers at the expected height above its start, reaches
/// each target exactly, and lands where it is.
#[derive(Debug, Clone)]
pub(crate) struct DryRun {
    interpreter: Interpreter,
    place: Pose,
    airborne: bool,
    /// Where tags lie whose place is known.
    tags_m: Vec<Vector2<f64>>,
}

impl DryRun {
    pub(crate) fn new(limits: &FlightLimits) -> Self {
        let interpreter = Interpreter::new(limits);
        Self {
            interpreter,
            place: limits.start.unwrap_or_default(),
            airborne: false,
            tags_m: Vec::new(),
        }
    }

    /// A run that continues from `place`.
    pub(crate) fn from_here(interpreter: Interpreter, place: Pose, airborne: bool) -> Self {
        Self { interpreter, place, airborne, tags_m: Vec::new() }
    }

    /// The same run with tags at these places, right and forward of the start.
    #[must_use]
    pub(super) fn with_tags(mut self, tags_m: impl IntoIterator<Item = Vector2<f64>>) -> Self {
        self.tags_m.extend(tags_m);
        self
    }

    /// The tag that is nearest to the drone, of those whose place is known.
    pub(super) fn nearest_tag_m(&self) -> Option<Vector2<f64>> {
        let here_m = Vector2::new(self.place.x_m, self.place.y_m);
        let far = |tag_m: &Vector2<f64>| (tag_m - here_m).norm();
        self.tags_m.iter().copied().min_by(|a, b| far(a).total_cmp(&far(b)))
    }

    /// Moves the drone to the end of what it is doing.
    pub(crate) fn finish(&mut self, order: Option<AgentOrder>) {
        if let Some(order) = order {
            self.carry_out(order);
        }
    }

    /// Executes a command, together with what the agent has to do for it.
    pub(crate) fn step(&mut self, command: Command) -> Option<AgentOrder> {
        let order = self.interpreter.carry_out(command, &self.place)?;
        self.carry_out(order);
        Some(order)
    }

    fn carry_out(&mut self, order: AgentOrder) {
        match order {
            AgentOrder::TakeOff => {
                // A take-off in the air leaves the drone where it is.
                if !self.airborne {
                    self.place.z_m = FlightLimits::EXPECTED_HOVER_M;
                }
                self.airborne = true;
                self.interpreter.take_off_ended(&self.place);
            }
            AgentOrder::GoTo(target) => self.place = target.pose,
            // A tag is seen where the drone is.
            AgentOrder::FindTag => self.interpreter.stopped_at(&self.place),
            AgentOrder::Land | AgentOrder::LandOnTag => {
                if order == AgentOrder::LandOnTag
                    && let Some(tag_m) = self.nearest_tag_m()
                {
                    (self.place.x_m, self.place.y_m) = (tag_m.x, tag_m.y);
                }
                self.airborne = false;
                self.place.z_m = 0.0;
            }
        }
    }

    /// Pose of the drone.
    pub(super) fn place(&self) -> Pose {
        self.place
    }

    /// Whether the drone is in the air.
    pub(super) fn is_airborne(&self) -> bool {
        self.airborne
    }

    /// The interpreter with the plan's settings.
    pub(super) fn interpreter(&self) -> &Interpreter {
        &self.interpreter
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::Plan;

    /// Place after each step, as (forward, up).
    fn places(text: &str) -> Vec<(f64, f64)> {
        let plan = Plan::parse("plan", text).unwrap();
        let mut run = DryRun::new(&FlightLimits::default());
        let places = plan.steps().iter().map(|step| {
            run.step(step.command);
            (run.place().y_m, run.place().z_m)
        });
        places.collect()
    }

    #[test]
    fn the_drone_climbs_and_lands_where_it_is() {
        let landed = places("takeoff\ngoto 0 2 1 0\nland\nautoInit\nmoveBy 0 0 0.5 0\nland\n");
        let expected = [(0.0, 0.85), (2.0, 1.85), (2.0, 0.0), (2.0, 0.85), (2.0, 1.35), (2.0, 0.0)];
        assert_eq!(landed, expected);
    }

    /// Targets are places of the room; what is relative is relative to where the drone is.
    #[test]
    fn a_surveyed_start_moves_the_drone_but_not_the_targets() {
        let start = Pose { x_m: 3.0, y_m: -1.0, z_m: 0.0, yaw_deg: 90.0 };
        let limits = FlightLimits { start: Some(start), ..FlightLimits::default() };
        let plan =
            "takeoff\nmoveBy 1 0 0 0\ngoto 0 1 0 0\nsetReference $START$\ngoto 0 0 1 0\nland\n";
        let plan = Plan::parse("plan", plan).unwrap();
        let mut run = DryRun::new(&limits);
        let places = plan.steps().iter().filter_map(|step| {
            run.step(step.command)?;
            let Pose { x_m, y_m, yaw_deg, .. } = run.place();
            Some([x_m, y_m, yaw_deg])
        });
        let here = [3.0, -1.0, 90.0];
        let expected = [here, [4.0, -1.0, 90.0], [0.0, 1.0, 0.0], here, here];
        assert_eq!(places.collect::<Vec<_>>(), expected);
    }

    #[test]
    fn a_take_off_in_the_air_changes_nothing() {
        let still = places("takeoff\ngoto 0 2 1 0\ntakeoff\nmoveBy 0 0 0 0\nland\n");
        assert_eq!(still[1..4], [(2.0, 1.85); 3]);
    }
}
