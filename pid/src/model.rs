//! What the drone will have done by now: its own motion is known late, the commands that were sent
//! are known at once.
//!
//! A model of the drone flies along with the same commands. What it did since the moment that the
//! estimate is of is added to the estimate: errors of the model count for that short time only
//! (O. J. Smith's predictor). The model knows no dead time: it is where the drone will be when the
//! newest command acts.

use std::collections::VecDeque;

use nalgebra::Vector3;

/// How the drone answers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModelConstants {
    /// Time constant of the tilt.
    pub tilt_time_constant_s: f64,
    /// Time constant of the climb.
    pub climb_time_constant_s: f64,
    /// Slows by its speed.
    pub drag_1_s: f64,
}

/// A command in the world: acceleration right and forward, climb up.
pub(crate) type Command = Vector3<f64>;

/// The model that flies along.
#[derive(Debug, Clone)]
pub(crate) struct PlantModel {
    constants: ModelConstants,
    time_s: f64,
    tilt_m_s2: Vector3<f64>,
    velocity_m_s: Vector3<f64>,
    position_m: Vector3<f64>,
    /// Time, position and velocity of the last half second.
    past: VecDeque<(f64, Vector3<f64>, Vector3<f64>)>,
}

/// Nothing older is asked for.
const MEMORY_S: f64 = 0.5;
const SUBSTEPS: u32 = 3;

impl PlantModel {
    pub(crate) fn new(constants: ModelConstants) -> Self {
        Self {
            constants,
            time_s: 0.0,
            tilt_m_s2: Vector3::zeros(),
            velocity_m_s: Vector3::zeros(),
            position_m: Vector3::zeros(),
            past: VecDeque::new(),
        }
    }

    /// A command holds for `step_s`.
    pub(crate) fn send(&mut self, command: Command, step_s: f64) {
        for _ in 0..SUBSTEPS {
            self.step(command, step_s / f64::from(SUBSTEPS));
        }
        self.past.push_back((self.time_s, self.position_m, self.velocity_m_s));
        while self.past.front().is_some_and(|(time, ..)| *time < self.time_s - MEMORY_S) {
            self.past.pop_front();
        }
    }

    fn step(&mut self, command: Command, step_s: f64) {
        let ModelConstants { tilt_time_constant_s, climb_time_constant_s, drag_1_s, .. } =
            self.constants;
        let lag = (step_s / tilt_time_constant_s).min(1.0);
        self.tilt_m_s2 += (command.xy().push(0.0) - self.tilt_m_s2) * lag;
        let climb_m_s2 = (command.z - self.velocity_m_s.z) / climb_time_constant_s;
        let drag = self.velocity_m_s.xy().push(0.0) * drag_1_s;
        let acceleration = self.tilt_m_s2 - drag + Vector3::new(0.0, 0.0, climb_m_s2);
        self.velocity_m_s += acceleration * step_s;
        self.position_m += self.velocity_m_s * step_s;
        self.time_s += step_s;
    }

    /// How place and velocity have changed in the last `age_s`.
    pub(crate) fn change_since(&self, age_s: f64) -> (Vector3<f64>, Vector3<f64>) {
        let then = self.time_s - age_s.clamp(0.0, MEMORY_S);
        let after = self.past.partition_point(|(time, ..)| *time <= then);
        let Some((time, position, velocity)) = after.checked_sub(1).and_then(|i| self.past.get(i))
        else {
            let oldest = self.past.front();
            return oldest.map_or((Vector3::zeros(), Vector3::zeros()), |(_, p, v)| {
                (self.position_m - p, self.velocity_m_s - v)
            });
        };
        let (mut position, mut velocity) = (*position, *velocity);
        if let Some((next, next_position, next_velocity)) = self.past.get(after)
            && next > time
        {
            let part = (then - time) / (next - time);
            position += (next_position - position) * part;
            velocity += (next_velocity - velocity) * part;
        }
        (self.position_m - position, self.velocity_m_s - velocity)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CONSTANTS: ModelConstants =
        ModelConstants { tilt_time_constant_s: 0.13, climb_time_constant_s: 0.5, drag_1_s: 0.5 };

    #[test]
    fn a_steady_command_ends_at_the_speed_where_drag_holds_it() {
        let mut model = PlantModel::new(CONSTANTS);
        for _ in 0..1000 {
            model.send(Vector3::new(1.0, 0.0, 0.4), 0.03);
        }
        assert!((model.velocity_m_s - Vector3::new(2.0, 0.0, 0.4)).norm() < 1e-3);
        let (way, change) = model.change_since(0.1);
        assert!((way - Vector3::new(0.2, 0.0, 0.04)).norm() < 1e-3, "{way}");
        assert!(change.norm() < 1e-4);
    }

    #[test]
    fn nothing_has_changed_before_the_beginning() {
        let mut model = PlantModel::new(CONSTANTS);
        assert_eq!(model.change_since(0.2), (Vector3::zeros(), Vector3::zeros()));
        for _ in 0..3 {
            model.send(Vector3::new(5.0, 0.0, 0.0), 0.03);
        }
        let (_, short) = model.change_since(0.03);
        let (_, long) = model.change_since(9.0);
        assert!(short.x > 0.0 && long.x > short.x);
    }
}
