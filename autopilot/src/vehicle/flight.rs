//! State that lives for one flight.

use std::sync::Arc;
use std::time::Duration;

use ardrone_link::navdata::{ControlState, Demo, DroneState, Navdata};
use estimator::{Estimator, Quantity, Sample};
use kinematics::Pose;
use pid::PositionController;

use super::place::CrossChecks;
use super::saturation::Saturation;
use super::since::{Since, StaysUp};
use super::{FlightReport, SignSearch, VehicleConfig};
use crate::agent::{Activity, Agent};
use crate::outcome::Outcome;
use crate::safety::{SafetyMonitor, Veto};
use crate::wind::Wind;

/// State of one flight. It is created anew for each flight from rest, so that a vehicle's tenth flight starts
/// exactly like its first: the world frame, the fence and the position uncertainty start at the place where
/// the drone stands.
#[derive(Debug)]
pub(super) struct Flight {
    pub(super) estimator: Estimator,
    pub(super) controller: PositionController,
    pub(super) agent: Agent,
    pub(super) activity: Activity,
    pub(super) safety: SafetyMonitor,
    pub(super) veto: Option<Veto>,
    /// Since when the drone does not tilt as it is told.
    pub(super) disobeys: Since,
    /// Since when it does not sink although it is landed by our orders, and whether that was for too long.
    pub(super) stays_up: StaysUp,
    pub(super) ignores_descent: bool,
    /// Start of the fault that the drone currently reports, and of its emergency state: its motors are cut.
    pub(super) fault: Since,
    pub(super) emergency: Since,
    /// Since when it is on the ground again without an order to land.
    pub(super) down: Since,
    pub(super) wind: Wind,
    pub(super) saturation: Saturation,
    pub(super) sign_search: SignSearch,
    pub(super) cross_checks: CrossChecks,
    pub(super) target: Option<Pose>,
    /// When the drone was first asked for full navdata, or else when the flight began.
    pub(super) asked_at: Duration,
    /// The mission was changed when nothing of it could be flown in this flight any more.
    pub(super) mission_is_for_next: bool,
    /// Shared with whoever was told of the end, which must not ask for memory.
    report: Arc<FlightReport>,
    pub(super) outcome: Option<Outcome>,
}

impl Flight {
    pub(super) fn new(config: &VehicleConfig, begins: Duration) -> Self {
        Self {
            estimator: Estimator::new(config.estimator),
            controller: PositionController::new(config.cascade, config.estimator.limits),
            agent: Agent::new(),
            activity: Activity::default(),
            safety: SafetyMonitor::new(config.limits),
            veto: None,
            disobeys: Since::default(),
            stays_up: StaysUp::default(),
            ignores_descent: false,
            fault: Since::default(),
            emergency: Since::default(),
            down: Since::default(),
            wind: Wind::calm(1.0),
            saturation: Saturation::default(),
            sign_search: SignSearch::default(),
            cross_checks: CrossChecks::default(),
            target: None,
            asked_at: begins,
            mission_is_for_next: false,
            report: Arc::default(),
            outcome: None,
        }
    }

    pub(super) fn report(&self) -> &Arc<FlightReport> {
        &self.report
    }

    pub(super) fn report_mut(&mut self) -> &mut FlightReport {
        Arc::make_mut(&mut self.report)
    }
}

/// The estimator's measurement from one navdata packet.
pub(super) fn sample(now: Duration, navdata: &Navdata, demo: &Demo) -> Sample {
    Sample {
        arrival: now,
        drone_time: navdata.time,
        yaw_deg: demo.yaw_deg,
        roll_deg: demo.roll_deg,
        pitch_deg: demo.pitch_deg,
        velocity_forward_m_s: demo.velocity_forward_m_s,
        velocity_right_m_s: demo.velocity_right_m_s,
        altitude_m: demo.altitude_m,
        airborne: is_airborne(navdata.state, demo.control_state),
        autonomous: matches!(
            demo.control_state,
            ControlState::TakingOff | ControlState::Landing | ControlState::Looping
        ),
        reported_lost: reported_lost(navdata.state, demo),
    }
}

/// Whether the drone says that it is in the air: by the bit for it, or by what it does. Either can be wrong alone, and a drone
/// that is taken for one on the ground is not flown as it should be.
pub(super) fn is_airborne(state: DroneState, control: ControlState) -> bool {
    let flies = matches!(
        control,
        ControlState::Flying
            | ControlState::Hovering
            | ControlState::GoingToFixPoint
            | ControlState::Looping
    );
    state.contains(DroneState::FLYING) || (flies && !state.contains(DroneState::EMERGENCY))
}

/// The quantity that the drone itself reports as unavailable.
fn reported_lost(state: DroneState, demo: &Demo) -> Option<Quantity> {
    if demo.has_lost_vision() {
        Some(Quantity::Velocity)
    } else if demo.has_lost_altitude() || state.contains(DroneState::ULTRASOUND_DEAF) {
        Some(Quantity::Altitude)
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sample_is_the_packet_with_the_time_of_its_arrival() {
        let demo = Demo {
            yaw_deg: 1.0,
            roll_deg: 2.0,
            pitch_deg: 3.0,
            velocity_forward_m_s: 4.0,
            velocity_right_m_s: 5.0,
            altitude_m: 6.0,
            control_state: ControlState::Flying,
            ..Demo::default()
        };
        let (arrival, drone_time) = (Duration::from_secs(7), Some(Duration::from_secs(8)));
        let state = DroneState::FLYING;
        let navdata = Navdata { time: drone_time, state, ..navdata() };
        let expected = Sample {
            arrival,
            drone_time,
            yaw_deg: 1.0,
            roll_deg: 2.0,
            pitch_deg: 3.0,
            velocity_forward_m_s: 4.0,
            velocity_right_m_s: 5.0,
            altitude_m: 6.0,
            airborne: true,
            autonomous: false,
            reported_lost: None,
        };
        assert_eq!(sample(arrival, &navdata, &demo), expected);
    }

    fn navdata() -> Navdata {
        let mut bytes = bytes::BytesMut::new();
        ardrone_link::navdata::PacketWriter::new(&mut bytes, DroneState::empty(), 1, 0).finish();
        Navdata::decode(&bytes).unwrap()
    }

    #[test]
    fn a_quantity_is_lost_if_either_the_state_or_the_minor_state_says_so() {
        let flying = |control_state_minor| Demo {
            control_state: ControlState::Flying,
            control_state_minor,
            ..Demo::default()
        };
        let (fine, deaf) = (DroneState::FLYING, DroneState::ULTRASOUND_DEAF);
        assert_eq!(reported_lost(fine, &flying(0)), None);
        assert_eq!(reported_lost(fine, &flying(6)), Some(Quantity::Velocity));
        assert_eq!(reported_lost(fine, &flying(1)), Some(Quantity::Altitude));
        assert_eq!(reported_lost(deaf, &flying(0)), Some(Quantity::Altitude));
    }
}
