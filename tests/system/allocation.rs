//! A tick in the air must not allocate, because the allocator may block.

use std::time::Duration;

use allocation_counter::measure;
use ardrone_link::WAKE_UP;
use ardrone_pilot::drive::{Driver, POLL, Surroundings, Take, input};
use ardrone_pilot::recording::{Header, Recorder};
use autopilot::Vehicle;
use autopilot::separation::{Claim, Neighbour, Presence, Rank};
use autopilot::vehicle::{
    Input, NavdataRate, Operator, OperatorOrder, Phase, Place, TagConfig, Transmit, VehicleConfig,
};
use kinematics::{Sticks, world_from_body};
use mock_drone::{FloorTag, Message, World, WorldConfig};
use nalgebra::Vector2;
use system_tests::{SQUARE, plan};

/// A world that works only while nothing is measured.
struct Quiet {
    world: World,
    now: Duration,
    received: Vec<Message>,
    sent: Vec<u8>,
    wakes_up: bool,
}

impl Quiet {
    fn new(config: &WorldConfig) -> Self {
        let (received, sent) = (Vec::new(), Vec::with_capacity(4096));
        Self { world: World::new(config), now: Duration::ZERO, received, sent, wakes_up: false }
    }

    /// Lets the world go on.
    fn advance(&mut self) {
        self.received.clear();
        self.world.advance(self.now);
        while let Some(message) = self.world.receive(self.now) {
            self.received.push(message);
        }
    }

    /// Delivers what was sent.
    fn deliver(&mut self) {
        if !self.sent.is_empty() {
            self.world.send_at(self.now, &self.sent);
            self.sent.clear();
        }
        if std::mem::take(&mut self.wakes_up) {
            self.world.send_wake_up(self.now, &WAKE_UP);
        }
    }
}

impl Surroundings for Quiet {
    fn now(&self) -> Duration {
        self.now
    }

    fn wait(&mut self, _until: Duration) {
        self.now += POLL;
    }

    fn receive(&mut self, now: Duration, _until: Option<Duration>, mut take: impl Take) {
        for message in &self.received {
            _ = take(now, input(message));
        }
    }

    fn send(&mut self, _now: Duration, transmit: Transmit<'_>) {
        match transmit {
            Transmit::Command { datagram, .. } => self.sent.extend_from_slice(datagram),
            Transmit::WakeUp => self.wakes_up = true,
        }
    }
}

/// Counts allocations in flight. On the ground the configuration is read and compared, which allocates.
fn allocations(
    navdata: NavdataRate,
    orders: &[(Duration, OperatorOrder)],
    tags: Option<&TagConfig>,
    others: u8,
) -> u64 {
    let mut config = VehicleConfig { navdata, ..VehicleConfig::default() };
    config.estimator.tags = tags.copied();
    let vehicle = Vehicle::flying(plan(SQUARE), &config).unwrap();
    let world = WorldConfig {
        tags: vec![FloorTag::new(0.0, 0.0, 0.0), FloorTag::new(1.0, 1.0, 0.0)],
        ..WorldConfig::default()
    };
    let mut driver = Driver::over(vehicle, Quiet::new(&world));
    let mut orders = orders.iter().peekable();
    let mut allocations = 0;
    let folder = tempfile::tempdir().unwrap();
    let (mut recorder, recording) =
        Recorder::start(&folder.path().join("flight.mcap"), &Header::default()).unwrap();
    while driver.vehicle.outcome().is_none() {
        let now = driver.now();
        let flies = driver.vehicle.status(now).phase == Phase::Flying;
        driver.surroundings.advance();
        let asked = measure(|| {
            while let Some((_, order)) = orders.next_if(|(at, _)| now >= *at) {
                let order = Input::Order(Operator::TERMINAL, order.clone());
                let handled = driver.handle(order, |at, passed| recorder.pass(at, &passed));
                assert_eq!(handled, Ok(()));
            }
            for system in 0..others {
                let heard = Input::Neighbour(hovering(system, now));
                let handled = driver.handle(heard, |at, passed| recorder.pass(at, &passed));
                assert_eq!(handled, Ok(()));
            }
            driver.step(|at, passed| recorder.pass(at, &passed));
        });
        allocations += if flies { asked.count_total } else { 0 };
        driver.surroundings.deliver();
        driver.pass();
    }
    drop(recorder);
    assert!(recording.finish().unwrap().bytes > 100_000);
    let outcome = driver.vehicle.outcome();
    assert!(driver.now() > Duration::from_secs(15), "it flew: {outcome:?}");
    allocations
}

/// Another vehicle, which hovers around the square.
fn hovering(number: u8, at: Duration) -> Neighbour {
    let place_m = world_from_body(Vector2::new(0.0, 4.0), 18.0 * f64::from(number));
    let velocity_m_s = Vector2::zeros();
    let rank = Rank { system: 2 + number, behind: 0 };
    let claim = Some(Claim { to_m: -place_m, rank });
    Neighbour {
        system: 2 + number,
        at,
        place_m,
        velocity_m_s,
        uncertainty_m: 0.1,
        separation_m: 1.5,
        presence: Presence::Flies,
        claim,
    }
}

#[test]
fn nothing_is_allocated_in_flight() {
    let second = Duration::from_secs(1);
    let orders = [
        (7 * second, OperatorOrder::Hold),
        (8 * second, OperatorOrder::Steer(Sticks { roll: 0.5, ..Sticks::default() })),
        (10 * second, OperatorOrder::GoTo(Place::at(0.5, 0.5))),
        (13 * second, OperatorOrder::Resume),
        (18 * second, OperatorOrder::Land),
    ];
    for navdata in [NavdataRate::Demo, NavdataRate::Full] {
        assert_eq!(allocations(navdata, &[], None, 0), 0, "{navdata:?}");
        assert_eq!(allocations(navdata, &orders, None, 0), 0, "{navdata:?}, by hand");
        let tags = TagConfig::default();
        assert_eq!(allocations(navdata, &[], Some(&tags), 0), 0, "{navdata:?}, with tags");
        assert_eq!(allocations(navdata, &orders, None, 19), 0, "{navdata:?}, among others");
    }
}
