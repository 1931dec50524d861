//! Cases to fly: plans, airframes, conditions.

use std::time::Duration;

use autopilot::vehicle::{NavdataRate, VehicleConfig};
use mock_drone::airframe::Profile;
use mock_drone::sensors::SensorModel;
use mock_drone::{DroneConfig, LinkFaults, WorldConfig};
use nalgebra::Vector2;
use system_tests::sim::Simulation;

/// A plan and its stay time at each target.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PlanText {
    pub(crate) name: &'static str,
    pub(crate) text: &'static str,
    pub(crate) stay: Duration,
}

const STAY: Duration = Duration::from_secs(2);

/// The plans of the published figures used for comparison.
const FIGURES: [PlanText; 3] = [
    PlanText { name: "square1x1", text: include_str!("../../plans/square1x1.txt"), stay: STAY },
    PlanText { name: "xyz", text: include_str!("../../plans/xyz.txt"), stay: STAY },
    PlanText {
        name: "NikolausVertical",
        text: include_str!("../../plans/NikolausVertical.txt"),
        stay: STAY,
    },
];

const HOVER: [PlanText; 1] = [PlanText {
    name: "hover",
    text: "takeoff\nsetStayTime 30\ngoto 0 0 0 0\nland\n",
    stay: Duration::from_secs(30),
}];

/// Conditions of air and link.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Day {
    /// No wind, nothing lost.
    Calm,
    /// Wind, a worse level reference, 3 % of all datagrams lost.
    Bad,
    /// 10 % of all datagrams lost, and 100 ms of additional delay round the loop.
    Late,
}

/// One case: an airframe under given conditions.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Case {
    pub(crate) airframe: &'static str,
    profile: fn() -> Profile,
    pub(crate) conditions: &'static str,
    model: fn() -> SensorModel,
    day: Day,
    navdata: NavdataRate,
    pub(crate) plans: &'static [PlanText],
    /// Lower bound of the time for the three plans together: for each leg the time-optimal motion from rest
    /// to rest into the ball of 0.2 m.
    pub(crate) bound_s: Option<f64>,
}

const REC: Case = Case {
    airframe: "rec",
    profile: Profile::rec,
    conditions: "nominal",
    model: SensorModel::nominal,
    day: Day::Calm,
    navdata: NavdataRate::Demo,
    plans: &FIGURES,
    bound_s: Some(52.6),
};

const HARD: Case = Case { conditions: "hard", model: SensorModel::hard, day: Day::Bad, ..REC };

pub(crate) const CASES: [Case; 12] = [
    REC,
    Case { airframe: "tum", profile: Profile::tum, bound_s: Some(59.0), ..REC },
    Case { airframe: "tf", profile: Profile::tf, bound_s: Some(56.5), ..REC },
    Case { airframe: "leo", profile: Profile::leo, bound_s: Some(61.4), ..REC },
    Case { conditions: "full", navdata: NavdataRate::Full, ..REC },
    HARD,
    Case { airframe: "tum", profile: Profile::tum, bound_s: Some(59.0), ..HARD },
    Case { airframe: "tf", profile: Profile::tf, bound_s: Some(56.5), ..HARD },
    Case { airframe: "leo", profile: Profile::leo, bound_s: Some(61.4), ..HARD },
    Case { conditions: "late", day: Day::Late, ..REC },
    Case { conditions: "nominal", plans: &HOVER, bound_s: None, ..REC },
    Case { plans: &HOVER, bound_s: None, ..HARD },
];

impl Case {
    /// Simulated world and vehicle of one flight.
    pub(crate) fn simulation(&self, seed: u64) -> Simulation {
        let mut drone = DroneConfig {
            seed,
            profile: (self.profile)(),
            sensors: (self.model)(),
            ..DroneConfig::default()
        };
        let mut link = LinkFaults::default();
        match self.day {
            Day::Calm => {}
            Day::Bad => {
                drone.wind_m_s = Vector2::new(0.5, -0.4);
                drone.gusts_m_s = 0.2;
                drone.trim_error_deg = 0.6;
                link.loss = 0.03;
            }
            Day::Late => {
                link.loss = 0.1;
                // In each direction.
                link.delay = Duration::from_millis(50);
            }
        }
        Simulation {
            world: WorldConfig { drone, link, ..WorldConfig::default() },
            pilot: VehicleConfig { navdata: self.navdata, ..VehicleConfig::default() },
            ..Simulation::default()
        }
    }
}
