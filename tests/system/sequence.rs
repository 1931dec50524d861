//! Sequence numbers: any single datagram may be lost, and the drone obeys the next.

use std::time::Duration;

use ardrone_link::at::{Command, Datagram, Motion, Ref};
use ardrone_link::session::{FlightOrder, Input, Order, Session, SessionConfig, Transmit};
use ardrone_link::settings::Setting;
use mock_drone::firmware::Phase;
use mock_drone::{LinkFaults, Message, World, WorldConfig};

const TICK: Duration = Duration::from_millis(30);

/// A session with a simulated drone, tick by tick.
struct Bench {
    session: Session,
    world: World,
    now: Duration,
    /// Number of ticks until the datagram that is lost.
    lost: Option<u32>,
    hears: bool,
}

impl Bench {
    /// A session and its simulated drone, without losses.
    fn new() -> Self {
        Self::in_world(&WorldConfig::default())
    }

    fn in_world(world: &WorldConfig) -> Self {
        let settings = vec![Setting::NavdataDemo(true).config().unwrap()];
        let config = SessionConfig { settings, ..SessionConfig::default() };
        let mut world = World::new(world);
        world.send_wake_up(Duration::ZERO, &ardrone_link::WAKE_UP);
        Self { session: Session::new(config), world, now: TICK, lost: None, hears: true }
    }

    /// Another pilot has just sent commands with numbers far above ours.
    fn after_another_pilot(mut self) -> Self {
        let mut datagram = Datagram::new();
        datagram.push(5000, &Command::Ref(Ref::Land)).unwrap();
        datagram.push(5001, &Command::Pcmd(Motion::Hover)).unwrap();
        self.world.send_at(self.now, datagram.as_bytes());
        self
    }

    fn tick(&mut self, flight: FlightOrder) {
        self.now += TICK;
        self.world.advance(self.now);
        while let Some(message) = self.world.receive(self.now) {
            if let (Message::Navdata(packet), true) = (message, self.hears) {
                self.session.handle(self.now, Input::Navdata(&packet));
            }
        }
        let order = Order { flight, motion: Motion::Hover };
        self.session.handle(self.now, Input::Tick(order));
        while let Some(transmit) = self.session.poll_transmit() {
            match transmit {
                Transmit::Command(datagram) => {
                    if self.lost != Some(0) {
                        self.world.send_at(self.now, datagram);
                    }
                    self.lost = self.lost.and_then(|lost| lost.checked_sub(1));
                }
                Transmit::WakeUp => self.world.send_wake_up(self.now, &ardrone_link::WAKE_UP),
            }
        }
    }

    /// Ticks until the condition is true.
    fn until(&mut self, flight: FlightOrder, so: impl Fn(&Self) -> bool) -> u32 {
        for ticks in 0..1000 {
            if so(self) {
                return ticks;
            }
            self.tick(flight);
        }
        panic!("it never came: {:?}", self.world.truth());
    }

    fn phase(&self) -> Phase {
        self.world.truth().phase
    }
}

#[test]
fn behind_another_pilot_no_single_loss_leaves_us_unheard() {
    let ready = |bench: &Bench| bench.session.is_ready();
    let usual = Bench::new().after_another_pilot().until(FlightOrder::Land, ready);
    for lost in 0..=usual {
        let mut bench = Bench { lost: Some(lost), ..Bench::new().after_another_pilot() };
        let ticks = bench.until(FlightOrder::Land, ready);
        // An unacknowledged key is sent again after 150 ms.
        assert!(
            ticks <= usual + 10,
            "datagram {lost} lost: ready after {ticks} ticks, not {usual}"
        );
    }
}

#[test]
fn after_a_loss_no_single_datagram_delays_the_landing() {
    // From just before the session notices the loss to just after it.
    for lost in 0..12 {
        let mut bench = Bench::new();
        bench.until(FlightOrder::Land, |bench| bench.session.is_ready());
        bench.until(FlightOrder::TakeOff, |bench| bench.phase() == Phase::Flying);
        for _ in 0..30 {
            bench.tick(FlightOrder::StayAirborne);
        }
        // The drone receives us, but we do not receive it.
        bench.hears = false;
        for _ in 0..62 {
            bench.tick(FlightOrder::StayAirborne);
        }
        assert!(bench.session.is_alive());
        bench.lost = Some(lost);
        let alive = |bench: &Bench| bench.session.is_alive();
        bench.until(FlightOrder::StayAirborne, |bench| !alive(bench));
        let ticks = bench.until(FlightOrder::Land, |bench| bench.phase() == Phase::Landing);
        assert!(ticks <= 2, "datagram {lost} lost: it lands {ticks} ticks after the order");
    }
}

#[test]
fn no_single_loss_delays_the_landing_of_a_pilot_that_leaves() {
    for lost in 0..12 {
        let mut bench = Bench::new().after_another_pilot();
        bench.until(FlightOrder::Land, |bench| bench.session.is_ready());
        bench.until(FlightOrder::TakeOff, |bench| bench.phase() == Phase::Flying);
        for parting in 0..10 {
            bench.now += TICK;
            bench.session.handle(bench.now, Input::Part);
            if parting != lost {
                bench.world.send_at(bench.now, bench.session.datagram());
            }
            let begun = parting + 1 - u32::from(lost <= parting);
            bench.world.advance(bench.now + TICK / 2);
            assert_eq!(bench.phase() == Phase::Landing, begun > 0, "{parting}");
        }
    }
}

/// Another client sends orders to fly, with numbers far above ours; the time until the drone begins to land after it was
/// ordered to.
fn lands_against(first: u32, each_second: u32, loss: f64) -> Duration {
    let link = LinkFaults { loss, ..LinkFaults::default() };
    let mut bench = Bench::in_world(&WorldConfig { link, ..WorldConfig::default() });
    bench.until(FlightOrder::Land, |bench| bench.session.is_ready());
    bench.until(FlightOrder::TakeOff, |bench| bench.phase() == Phase::Flying);
    let mut number = first;
    let ordered_at = bench.now + TICK * 10;
    let mut next = bench.now;
    loop {
        if bench.now >= next {
            let mut datagram = Datagram::new();
            datagram.push(number, &Command::Ref(Ref::TakeOff)).unwrap();
            datagram.push(number + 1, &Command::Pcmd(Motion::Hover)).unwrap();
            bench.world.send_at(bench.now, datagram.as_bytes());
            number += 2;
            let period = Duration::from_secs(1).checked_div(each_second);
            next += period.unwrap_or(Duration::from_hours(1));
        }
        let ordered = bench.now >= ordered_at;
        bench.tick(if ordered { FlightOrder::Land } else { FlightOrder::StayAirborne });
        let taken = bench.now.saturating_sub(ordered_at);
        if bench.phase() == Phase::Landing || taken > Duration::from_secs(20) {
            return taken;
        }
    }
}

#[test]
fn no_other_clients_numbers_drown_a_landing() {
    for first in [10_000_000, 2_000_000_000, u32::MAX - 100_000] {
        for each_second in [0, 1, 10, 30] {
            for loss in [0.0, 0.1] {
                let taken = lands_against(first, each_second, loss);
                assert!(
                    taken <= Duration::from_secs(2),
                    "{first}, {each_second} Hz, {loss} lost: lands after {taken:?}"
                );
            }
        }
    }
}

/// A program that leaves has no time to see whether it is obeyed.
#[test]
fn no_other_clients_numbers_drown_the_landing_of_a_pilot_that_leaves() {
    let mut bench = Bench::new();
    bench.until(FlightOrder::Land, |bench| bench.session.is_ready());
    bench.until(FlightOrder::TakeOff, |bench| bench.phase() == Phase::Flying);
    let mut datagram = Datagram::new();
    datagram.push(2_000_000_000, &Command::Pcmd(Motion::Hover)).unwrap();
    bench.world.send_at(bench.now, datagram.as_bytes());
    for _ in 0..10 {
        bench.now += TICK;
        bench.session.handle(bench.now, Input::Part);
        bench.world.send_at(bench.now, bench.session.datagram());
    }
    bench.world.advance(bench.now + TICK);
    assert_eq!(bench.phase(), Phase::Landing);
}
