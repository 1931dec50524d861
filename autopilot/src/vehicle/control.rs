//! Turns the agent's command into a flight order and stick positions.

use std::time::Duration;

use ardrone_link::at::{Fraction, Motion};
use ardrone_link::session::{FlightOrder, Order};
use estimator::Prediction;
use kinematics::{Pose, Sticks, Velocity};
use pid::Inputs;

use super::{Vehicle, pose};
use crate::agent::AgentCommand;

impl Vehicle {
    /// Converts the agent's command to the session's order. `soon` is the predicted motion when the order takes effect.
    pub(super) fn carry_out(
        &mut self,
        now: Duration,
        command: AgentCommand,
        soon: &Prediction,
        step_s: f64,
    ) -> Order {
        let last_target = self.flight.target.take();
        self.flight.estimator.advance_smooth(step_s);
        if !matches!(command, AgentCommand::GoTo(_)) {
            self.flight.saturation.rest(step_s);
            self.flight.wind.is_usual();
        }
        let mut sent: Option<Sticks> = None;
        let order = match command {
            AgentCommand::Standby | AgentCommand::Land => {
                self.flight.controller.reset();
                Order { flight: FlightOrder::Land, motion: Motion::Hover }
            }
            AgentCommand::TakeOff => Order { flight: FlightOrder::TakeOff, motion: Motion::Hover },
            AgentCommand::Hover => {
                self.flight.controller.rest();
                Order { flight: FlightOrder::StayAirborne, motion: Motion::Hover }
            }
            AgentCommand::GoTo(target) => {
                self.flight.target = Some(target);
                // Who is told to stay elsewhere than it was going stops here: the reference of the way there may be far
                // ahead, above all after targets that changed in every tick.
                let stays = self.flight.activity.stays() && self.flight.veto.is_none();
                if stays && last_target != Some(target) {
                    self.flight.controller.rest();
                }
                let limit = self.mission.max_control();
                let turned = self.turned_to_learn(now, &target, step_s);
                let demand = self.demand(soon, &turned, step_s);
                let demand = self.flight.safety.limit(
                    &demand,
                    limit,
                    soon.position_m.z,
                    self.full_sink_m_s(),
                );
                // Whether it gets there is measured: by what it was sent it should.
                let estimate = self.flight.estimator.estimate();
                let measured = Prediction {
                    position_m: estimate.position_m,
                    velocity_m_s: estimate.velocity_m_s,
                    yaw_deg: estimate.yaw_deg,
                    ..Prediction::default()
                };
                let storm = self.flight.wind.has_risen(self.full_tilt_m_s2());
                // Who lets others pass is not on its way to the target.
                let led_to = self.flight.safety.course().map_or(target, |course| Pose {
                    x_m: course.position_m.x,
                    y_m: course.position_m.y,
                    ..target
                });
                self.flight.saturation.watch(&demand, limit, &measured, &led_to, storm, step_s);
                sent = Some(demand);
                Order { flight: FlightOrder::StayAirborne, motion: motion(&demand) }
            }
            AgentCommand::Sticks => {
                self.flight.controller.rest();
                let demand = self.life.manual().sticks(now).unwrap_or_default();
                let demand = self.flight.safety.limit(
                    &demand,
                    self.mission.max_control(),
                    soon.position_m.z,
                    self.full_sink_m_s(),
                );
                sent = Some(demand);
                Order { flight: FlightOrder::StayAirborne, motion: motion(&demand) }
            }
        };
        if sent.is_none() {
            self.flight.safety.let_go();
        }
        let sent = sent.map_or(estimator::Order::ByItself, estimator::Order::Sticks);
        self.flight.estimator.order_sent(now, sent);
        order
    }

    /// Descent at full stick; not less than was configured before more is known.
    fn full_sink_m_s(&self) -> f64 {
        self.config.estimator.limits.climb_m_s * self.flight.estimator.airframe().drop_gain.max(1.0)
    }

    /// Stick demand that steers towards `target`, computed for the state when it takes effect.
    fn demand(&mut self, soon: &Prediction, target: &Pose, step_s: f64) -> Sticks {
        // A tag that is seen again moves the estimate by a step, which comes as a motion.
        let state = self.flight.estimator.smooth(soon);
        let apart = self.flight.safety.course();
        let course = apart.or_else(|| self.life.manual().course(target));
        self.flight.controller.step(&Inputs {
            pose: &pose(&state),
            velocity: &Velocity {
                x_m_s: state.velocity_m_s.x,
                y_m_s: state.velocity_m_s.y,
                z_m_s: state.velocity_m_s.z,
                yaw_deg_s: state.turn_deg_s,
            },
            disturbance_m_s2: state.disturbance_m_s2,
            airframe: *self.flight.estimator.airframe(),
            target,
            step_s,
            limit: self.mission.max_control(),
            speed_m_s: self.mission.speed_m_s().unwrap_or(self.config.cascade.speed_max_m_s),
            course,
        })
    }
}

fn motion(demand: &Sticks) -> Motion {
    Motion::Progressive {
        roll: Fraction::saturating(demand.roll),
        pitch: Fraction::saturating(demand.pitch),
        gaz: Fraction::saturating(demand.gaz),
        yaw: Fraction::saturating(demand.yaw),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vehicle::VehicleConfig;

    #[test]
    fn a_drone_sinks_at_full_stick_as_it_was_identified_but_no_slower_than_it_climbs() {
        for (drop_gain, expected_m_s) in [(1.5, 0.6), (1.0, 0.4), (0.5, 0.4)] {
            let mut config = VehicleConfig::default();
            config.estimator.identify = false;
            config.estimator.limits.climb_m_s = 0.4;
            config.estimator.airframe.drop_gain = drop_gain;
            let sink_m_s = Vehicle::new(&config).unwrap().full_sink_m_s();
            assert!((sink_m_s - expected_m_s).abs() < 1e-9, "{drop_gain}: {sink_m_s}");
        }
    }

    /// How long a drone counts as saturated after six seconds in its place, disturbed by this.
    fn saturated_ms(disturbance_m_s2: f64) -> i64 {
        let mut vehicle = Vehicle::new(&VehicleConfig::default()).unwrap();
        let state = Prediction {
            disturbance_m_s2: nalgebra::Vector2::new(disturbance_m_s2, 0.0),
            ..Prediction::default()
        };
        let stay = AgentCommand::GoTo(Pose::default());
        for tick in 0..200 {
            let full_tilt_m_s2 = vehicle.full_tilt_m_s2();
            vehicle.flight.wind.feel(state.disturbance_m_s2, full_tilt_m_s2, 0.03);
            vehicle.carry_out(Duration::from_millis(30) * tick, stay, &state, 0.03);
        }
        vehicle.flight.saturation.for_ms()
    }

    #[test]
    fn a_storm_is_noticed_by_the_disturbance_though_the_measured_place_is_right() {
        assert_eq!(saturated_ms(0.0), 0);
        assert!(saturated_ms(4.0) > 3000, "{}", saturated_ms(4.0));
    }
}
