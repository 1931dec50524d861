//! Flights in simulated time: the same vehicle with a simulated drone, without sockets or clocks.
//!
//! The same configuration gives the same flight, bit for bit, thousands of times faster than real time.

use std::time::Duration;

use ardrone_pilot::recording::Record;
use autopilot::outcome::Outcome;
use autopilot::plan::Plan;
use autopilot::vehicle::{
    CannotFly, FlightEvent, FlightReport, Input, Operator, OperatorOrder, Status, TICK, Telemetry,
    Vehicle, VehicleConfig,
};
use mock_drone::{Truth, World, WorldConfig};

use ardrone_pilot::drive::{Driver, Passed, Simulated};

/// A world to fly in.
#[derive(Debug, Clone, Default)]
pub struct Simulation {
    /// The drone, the air around it, and the faults of both.
    pub world: WorldConfig,
    /// The vehicle.
    pub pilot: VehicleConfig,
    /// Operator orders with their times, in the order of time.
    pub orders: Vec<(Duration, OperatorOrder)>,
    /// Orders of other operators, likewise.
    pub others: Vec<(Duration, Operator, OperatorOrder)>,
    /// Times and durations in which the program does not run: it neither receives nor sends, and afterwards
    /// finds all queued input. In the order of time.
    pub stalls: Vec<(Duration, Duration)>,
    /// Time for which the drone is simulated after the flight without receiving anything.
    pub aftermath: Duration,
}

/// A simulated flight.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulatedFlight {
    /// Its outcome.
    pub outcome: Outcome,
    /// The vehicle's report.
    pub report: FlightReport,
    /// Events with their times.
    pub events: Vec<(Duration, FlightEvent)>,
    /// The true state at the end of each waypoint's stay.
    pub truth_at_waypoints: Vec<Truth>,
    /// The true state at the end of the aftermath.
    pub final_truth: Truth,
    /// Simulated time from the start to the end of the flight.
    pub duration: Duration,
}

impl SimulatedFlight {
    /// When a step of its plan began.
    pub fn start_of_step(&self, step: usize) -> Option<Duration> {
        let begins = |event: &FlightEvent| *event == FlightEvent::StepStarted { step };
        self.events.iter().find_map(|(at, event)| begins(event).then_some(*at))
    }
}

/// A tick of a simulated flight.
#[derive(Debug, Clone, PartialEq)]
pub struct Moment {
    /// Time since the start.
    pub now: Duration,
    /// The true state.
    pub truth: Truth,
    /// The vehicle's status.
    pub status: Status,
    /// Whether the flight has ended.
    pub is_over: bool,
}

/// Why a flight could not be simulated.
#[derive(Debug, thiserror::Error)]
pub enum SimulationError {
    /// The plan cannot be flown with this configuration.
    #[error(transparent)]
    Config(#[from] CannotFly),
    /// The flight did not end within an hour.
    #[error("the flight did not end within {} s", .limit.as_secs())]
    Endless {
        /// Simulated time.
        limit: Duration,
    },
}

/// Longest simulated time; no battery lasts that long.
const LIMIT: Duration = Duration::from_hours(1);

impl Simulation {
    /// Flies `plan` to its end.
    ///
    /// # Errors
    /// [`SimulationError`]; a flight that fails is not an error but an [`Outcome`].
    pub fn fly(&self, plan: Plan) -> Result<SimulatedFlight, SimulationError> {
        self.fly_watched(plan, |_| {})
    }

    /// As [`Simulation::fly`]; `watch` is called for every tick.
    ///
    /// # Errors
    /// As [`Simulation::fly`].
    pub fn fly_watched(
        &self,
        plan: Plan,
        watch: impl FnMut(&Moment),
    ) -> Result<SimulatedFlight, SimulationError> {
        let mut watch = watch;
        self.run(plan, |moment, _| watch(moment), |_, _| {})
    }

    /// As [`Simulation::fly_watched`]; `watch` also gets the world, from which it may simulate other courses.
    ///
    /// # Errors
    /// As [`Simulation::fly`].
    pub fn fly_in_world(
        &self,
        plan: Plan,
        watch: impl FnMut(&Moment, &World),
    ) -> Result<SimulatedFlight, SimulationError> {
        self.run(plan, watch, |_, _| {})
    }

    /// As [`Simulation::fly`]; `record` gets every entry of a flight log.
    ///
    /// # Errors
    /// As [`Simulation::fly`].
    pub fn fly_recorded(
        &self,
        plan: Plan,
        mut record: impl FnMut(Record),
    ) -> Result<SimulatedFlight, SimulationError> {
        let tee = |at, passed: &Passed<'_>| {
            Record::of(at, passed, |bytes| Some(bytes.to_vec())).into_iter().for_each(&mut record);
        };
        self.run(plan, |_, _| {}, tee)
    }

    fn run(
        &self,
        plan: Plan,
        mut watch: impl FnMut(&Moment, &World),
        mut tee: impl FnMut(Duration, &Passed<'_>),
    ) -> Result<SimulatedFlight, SimulationError> {
        let vehicle = Vehicle::flying(plan, &self.pilot)?;
        let mut driver = Driver::new(vehicle, &self.world);
        let mut events = Vec::new();
        let mut truth_at_waypoints = Vec::new();
        let mut orders = self.orders.iter().peekable();
        let mut others = self.others.iter().peekable();
        while driver.now() < LIMIT {
            let now = driver.now();
            if self.is_stalled(now) {
                if driver.stall() {
                    watch(&moment(&driver, false), driver.world());
                }
                driver.pass();
                continue;
            }
            let due = std::iter::from_fn(|| orders.next_if(|(at, _)| now >= *at));
            let due = due.map(|(_, order)| (Operator::TERMINAL, order));
            let due_too = std::iter::from_fn(|| others.next_if(|(at, ..)| now >= *at));
            for (by, order) in due.chain(due_too.map(|(_, by, order)| (*by, order))) {
                // A refused order changes nothing.
                _ = driver.handle(Input::Order(by, order.clone()), |at, passed| tee(at, &passed));
            }
            let mut ended = None;
            let mut reached = false;
            let ticked = driver.step(|at, passed| {
                tee(at, &passed);
                match passed {
                    Passed::Told(Telemetry::Event(event)) => events.push((at, event)),
                    Passed::Told(Telemetry::Waypoint(_)) => reached = true,
                    Passed::Told(Telemetry::Ended(outcome, _)) => ended = Some(outcome),
                    _ => {}
                }
            });
            if ticked {
                watch(&moment(&driver, ended.is_some()), driver.world());
                if reached {
                    truth_at_waypoints.push(driver.world().truth());
                }
            }
            let Some(outcome) = ended else {
                driver.pass();
                continue;
            };
            let Driver { vehicle, surroundings: Simulated { mut world, .. }, .. } = driver;
            let end = now + self.aftermath;
            let mut later = now;
            while later < end {
                later += TICK;
                world.advance(later);
                let (truth, status) = (world.truth(), vehicle.status(now));
                watch(&Moment { now: later, truth, status, is_over: true }, &world);
            }
            return Ok(SimulatedFlight {
                outcome,
                report: vehicle.report().clone(),
                events,
                truth_at_waypoints,
                final_truth: world.truth(),
                duration: now,
            });
        }
        Err(SimulationError::Endless { limit: LIMIT })
    }

    fn is_stalled(&self, now: Duration) -> bool {
        self.stalls.iter().any(|(at, time)| (*at..*at + *time).contains(&now))
    }
}

fn moment(driver: &Driver<Simulated>, is_over: bool) -> Moment {
    let now = driver.now();
    Moment { now, truth: driver.world().truth(), status: driver.vehicle.status(now), is_over }
}
