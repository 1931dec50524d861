//! A vehicle with a drone that only says what a test wants it to say: it has no physics.

use ardrone_link::at::{Command, ControlMode, Ref, decode};
use ardrone_link::navdata::{Gps, NavdataOption, PacketWriter, RawMeasures, VisionDetect};
use bytes::BytesMut;

use super::super::*;

pub(super) const SECOND: Duration = Duration::from_secs(1);
pub(super) const START: OperatorOrder = OperatorOrder::Start { when_ready: false };

/// A drone on the ground, and a vehicle that does not read its configuration back.
#[allow(clippy::struct_excessive_bools, reason = "each is something that the drone does or not")]
pub(super) struct Bench {
    pub(super) vehicle: Vehicle,
    pub(super) now: Duration,
    pub(super) state: DroneState,
    pub(super) control_state: ControlState,
    /// Its packets contain flight data.
    pub(super) has_demo: bool,
    pub(super) battery_percent: u32,
    /// The drone is heard.
    pub(super) is_heard: bool,
    /// The drone acknowledges its settings.
    pub(super) obeys: bool,
    pub(super) sequence: u32,
    /// It drifts to the right.
    pub(super) drifts_m_s: f64,
    /// It leans by this: roll, pitch.
    pub(super) leans_deg: [f64; 2],
    /// Its bottom camera sees a tag below it.
    pub(super) sees_tag: bool,
    /// The flight recorder's option of its next packets.
    pub(super) gps: Option<Gps>,
    /// The voltage in its next packets.
    pub(super) battery_v: Option<f64>,
    /// The drone climbs and sinks slowly, because a jump is not plausible.
    height_m: f64,
    /// Commands of the last datagram.
    pub(super) commands: Vec<Command>,
    pub(super) events: Vec<FlightEvent>,
    pub(super) outcomes: Vec<Outcome>,
    /// Reasons not to take off, each time that they were output.
    pub(super) readiness: Vec<Vec<NotReady>>,
    pub(super) missions: Vec<usize>,
    pub(super) waypoints: Vec<Waypoint>,
}

impl Bench {
    pub(super) fn new() -> Self {
        Self::with(&VehicleConfig { read_back: false, ..VehicleConfig::default() })
    }

    pub(super) fn with(config: &VehicleConfig) -> Self {
        Self {
            vehicle: Vehicle::new(config).unwrap(),
            now: SECOND,
            state: DroneState::empty(),
            control_state: ControlState::Landed,
            has_demo: true,
            battery_percent: 80,
            is_heard: true,
            obeys: true,
            sequence: 0,
            drifts_m_s: 0.0,
            leans_deg: [0.0; 2],
            sees_tag: false,
            gps: None,
            battery_v: None,
            height_m: 0.0,
            commands: Vec::new(),
            events: Vec::new(),
            outcomes: Vec::new(),
            readiness: Vec::new(),
            missions: Vec::new(),
            waypoints: Vec::new(),
        }
    }

    /// A vehicle that is ready, with this mission.
    pub(super) fn standing_by(plan: &str) -> Self {
        Self::new().stands_by(plan)
    }

    pub(super) fn stands_by(mut self, plan: &str) -> Self {
        let bench = &mut self;
        bench.run(3 * SECOND);
        assert_eq!(bench.phase(), Phase::Standby);
        bench.accepted(OperatorOrder::Load(Plan::parse("plan", plan).unwrap()));
        bench.step();
        bench.events.clear();
        self
    }

    /// A vehicle whose take-off has just ended.
    pub(super) fn in_the_air(plan: &str) -> Self {
        Self::standing_by(plan).takes_off()
    }

    /// Likewise, with this configuration.
    pub(super) fn in_the_air_with(config: &VehicleConfig, plan: &str) -> Self {
        Self::with(config).stands_by(plan).takes_off()
    }

    pub(super) fn takes_off(mut self) -> Self {
        let bench = &mut self;
        bench.accepted(START);
        bench.until(SECOND, |bench| bench.reference() == Some(Ref::TakeOff));
        bench.rises();
        bench.control_state = ControlState::TakingOff;
        bench.run(2 * SECOND);
        bench.control_state = ControlState::Hovering;
        bench.until(SECOND, |bench| bench.vehicle.report().steps_done == 1);
        self
    }

    pub(super) fn rises(&mut self) {
        self.state |= DroneState::FLYING;
        self.control_state = ControlState::Hovering;
    }

    pub(super) fn comes_down(&mut self) {
        self.state = self.state.difference(DroneState::FLYING);
        self.control_state = ControlState::Landed;
    }

    pub(super) fn order(&mut self, order: OperatorOrder) -> Result<(), Refused> {
        self.vehicle.handle(self.now, Input::Order(Operator::TERMINAL, order))
    }

    pub(super) fn accepted(&mut self, order: OperatorOrder) {
        let name = order.name();
        assert_eq!(self.order(order), Ok(()), "{name}");
    }

    pub(super) fn phase(&self) -> Phase {
        self.vehicle.status(self.now).phase
    }

    /// The REF command of the last tick; none if nothing was sent.
    pub(super) fn reference(&self) -> Option<Ref> {
        match self.commands.first() {
            Some(Command::Ref(reference)) => Some(*reference),
            _ => None,
        }
    }

    /// One packet from the drone and one tick.
    pub(super) fn step(&mut self) {
        self.now += TICK;
        if self.is_heard {
            self.hear();
        }
        self.tick();
    }

    pub(super) fn tick(&mut self) {
        assert_eq!(self.vehicle.handle(self.now, Input::Tick), Ok(()));
        self.commands.clear();
        while let Some(output) = self.vehicle.poll() {
            match output {
                Output::Transmit(Transmit::Command { datagram, .. }) => {
                    self.commands = decode(datagram).map(|command| command.unwrap().1).collect();
                }
                Output::Transmit(Transmit::WakeUp) => {}
                Output::Telemetry(telemetry) => match telemetry {
                    Telemetry::Event(event) => self.events.push(event),
                    Telemetry::Ended(outcome, _) => self.outcomes.push(outcome),
                    Telemetry::Readiness(reasons) => self.readiness.push(reasons.to_vec()),
                    Telemetry::Mission { steps, .. } => self.missions.push(steps.len()),
                    Telemetry::Waypoint(waypoint) => self.waypoints.push(waypoint),
                    Telemetry::Status(_) => {}
                },
            }
        }
        let acknowledge = DroneState::COMMAND_ACKNOWLEDGE;
        for command in &self.commands {
            match command {
                Command::Config(_) if self.obeys => self.state |= acknowledge,
                Command::Control(ControlMode::ClearAcknowledge) => {
                    self.state = self.state.difference(acknowledge);
                }
                _ => {}
            }
        }
    }

    pub(super) fn hear(&mut self) {
        self.sequence += 1;
        let flies = self.state.contains(DroneState::FLYING);
        let change_m = if flies { 0.02 } else { -0.02 };
        self.height_m = (self.height_m + change_m).clamp(0.0, 0.8);
        let mut bytes = BytesMut::new();
        let mut packet = PacketWriter::new(&mut bytes, self.state, self.sequence, 0);
        if self.has_demo {
            packet.option(&NavdataOption::Demo(self.demo())).unwrap();
        }
        if let Some(battery_v) = self.battery_v {
            let raw = RawMeasures { battery_v, ..RawMeasures::default() };
            packet.option(&NavdataOption::RawMeasures(raw)).unwrap();
        }
        if self.sees_tag {
            packet.option(&NavdataOption::VisionDetect(self.sight())).unwrap();
        }
        if let Some(gps) = self.gps {
            packet.option(&NavdataOption::Gps(gps)).unwrap();
        }
        packet.finish();
        assert_eq!(self.vehicle.handle(self.now, Input::Navdata(&bytes)), Ok(()));
    }

    /// A tag of 19 cm in the middle of the picture.
    fn sight(&self) -> VisionDetect {
        let height_m = self.height_m.max(0.1);
        // In whole millimetres, because the picture has whole units.
        let height_mm = (1..10_000_u32).find(|mm| f64::from(*mm) >= height_m * 1000.0).unwrap();
        let size = |focal: u32| focal * 190 / height_mm;
        let mut sight = VisionDetect { count: 1, ..VisionDetect::default() };
        sight.kinds[0] = 1 << 16 | 8;
        // Identical values would be the same picture.
        (sight.x[0], sight.y[0]) = (500 + self.sequence % 3, 450);
        (sight.widths[0], sight.heights[0]) = (size(1072), size(1452));
        sight.distances_m[0] = height_m;
        sight
    }

    fn demo(&self) -> Demo {
        // Sensors make noise; without it they count as frozen.
        let noise = f64::from(self.sequence * 7 % 5) / 1000.0;
        let flies = self.state.contains(DroneState::FLYING);
        Demo {
            control_state: self.control_state,
            battery_percent: self.battery_percent,
            altitude_m: self.height_m + noise,
            velocity_forward_m_s: if flies { noise } else { 0.0 },
            velocity_right_m_s: if flies { self.drifts_m_s - noise } else { 0.0 },
            roll_deg: self.leans_deg[0] + 10.0 * noise,
            pitch_deg: self.leans_deg[1] + 20.0 * noise,
            yaw_deg: 30.0 * noise,
            ..Demo::default()
        }
    }

    pub(super) fn run(&mut self, time: Duration) {
        let end = self.now + time;
        while self.now + TICK <= end {
            self.step();
        }
    }

    pub(super) fn until(&mut self, time: Duration, mut is_so: impl FnMut(&Self) -> bool) {
        let end = self.now + time;
        while !is_so(self) {
            assert!(self.now < end, "not within {time:?}: {:?} {:?}", self.phase(), self.events);
            self.step();
        }
    }
}
