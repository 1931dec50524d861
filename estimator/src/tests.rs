use super::*;
use kinematics::Sticks;

mod motion;
mod plausible;

fn fly(samples: impl IntoIterator<Item = Sample>) -> Estimate {
    let mut estimator = Estimator::default();
    for sample in samples.into_iter().enumerate().map(alive) {
        estimator.update(&sample);
    }
    *estimator.estimate()
}

/// A working sensor never measures the very same velocity twice.
fn alive((i, sample): (usize, Sample)) -> Sample {
    let rattle_m_s = if i.is_multiple_of(2) { 1e-9 } else { 0.0 };
    Sample { velocity_forward_m_s: sample.velocity_forward_m_s + rattle_m_s, ..sample }
}

fn sample(arrival_ms: u64, yaw_deg: f64, forward: f64, right: f64) -> Sample {
    Sample {
        arrival: Duration::from_millis(arrival_ms),
        yaw_deg,
        velocity_forward_m_s: forward,
        velocity_right_m_s: right,
        altitude_m: 1.0,
        airborne: true,
        ..Sample::default()
    }
}

#[test]
fn clockwise_heading_turns_forward_to_the_right() {
    for (turn_deg, x, y) in [(0.0, 0.0, 1.0), (90.0, 1.0, 0.0), (180.0, 0.0, -1.0)] {
        // The first sample sets the baseline, at a heading close to the wrap; then the drone turns slowly.
        let turn = (0..=100).map(|i| {
            let turned_deg = turn_deg * f64::from(u32::try_from(i).unwrap()) / 100.0;
            sample(66 * i, wrap_deg(171.0 + turned_deg), 0.0, 0.0)
        });
        let ahead = |m_s| sample(6666, wrap_deg(171.0 + turn_deg), m_s, 0.0);
        let flight = (0..=100)
            .map(|i| Sample { arrival: Duration::from_millis(6666 + 10 * i), ..ahead(1.0) });
        // A sudden speed is accepted only from a drone whose first sample it is.
        let mut estimator = Estimator::default();
        turn.enumerate().map(alive).for_each(|sample| estimator.update(&sample));
        estimator.velocity_gate = VelocityGate::default();
        flight.enumerate().map(alive).for_each(|sample| estimator.update(&sample));
        let estimate = estimator.estimate();
        let position = estimate.position_m;
        assert!((position.x - x).abs() < 0.05, "{turn_deg}: {position}");
        assert!((position.y - y).abs() < 0.05, "{turn_deg}: {position}");
    }
}

#[test]
fn a_turn_that_nobody_ordered_has_a_rate_too() {
    let mut estimator = Estimator::default();
    let turn = (0..=60_u32).map(|i| sample(66 * u64::from(i), 0.6 * f64::from(i), 0.0, 0.0));
    turn.enumerate().map(alive).for_each(|sample| estimator.update(&sample));
    let now = Duration::from_millis(66 * 60);
    // 0.6° in 66 ms, some of which has ended meanwhile by the model, in which it is not ordered.
    let rate_deg_s = estimator.turn_rate_deg_s(now);
    assert!((5.0..=9.5).contains(&rate_deg_s), "{rate_deg_s}");
    assert!(estimator.predicted(now).turn_deg_s.abs() < 0.1);
    assert!(Estimator::default().turn_rate_deg_s(now).abs() < 1e-9, "nothing heard yet");
}

#[test]
fn lost_packets_do_not_change_the_distance() {
    let all = (0..=60).map(|i| sample(i * 66, 0.0, 1.0, 0.5));
    let some = all.clone().enumerate().filter(|(i, _)| i % 4 != 1).map(|(_, sample)| sample);
    let (all, some) = (fly(all), fly(some));
    assert!((all.position_m - some.position_m).norm() < 1e-6);
}

#[test]
fn the_drones_clock_counts_not_the_arrival() {
    // Packets delayed and delivered in bunches of ten, while the drone's clock wraps.
    let samples = (0..41_u64).map(|i| Sample {
        drone_time: Some(Duration::from_millis((2_047_000 + i * 66) % 2_048_000)),
        ..sample(i.div_ceil(10) * 660, 0.0, 1.0, 0.0)
    });
    let estimate = fly(samples);
    assert!((estimate.position_m.y - 40.0 * 0.066).abs() < 0.005, "{}", estimate.position_m);
}

#[test]
fn on_the_ground_nothing_moves() {
    let grounded = (0..10).map(|i| Sample { airborne: false, ..sample(i * 66, 0.0, 3.0, 3.0) });
    assert_eq!(fly(grounded).position_m.xy(), Vector2::zeros());
}

#[test]
fn a_gap_is_bridged_by_the_speeds_around_it() {
    for gap_ms in [500, 1000, 1500, 2500] {
        let estimate = fly([sample(0, 0.0, 2.0, 0.0), sample(gap_ms, 0.0, 1.0, 0.0)]);
        let flown_m = 1.5 * Duration::from_millis(gap_ms).as_secs_f64();
        assert!((estimate.position_m.y - flown_m).abs() < 1e-6, "{gap_ms}: {estimate:?}");
    }
}

#[test]
fn a_very_long_gap_is_not_filled_with_motion() {
    let estimate = fly([sample(0, 0.0, 1.0, 0.0), sample(10_000, 0.0, 1.0, 0.0)]);
    assert!(estimate.position_m.y <= 3.0 + 1e-6);
}

/// A curve from one start, measured and predicted, is that from another, moved and turned.
#[test]
fn a_flight_begins_where_and_as_the_drone_stands_at_the_start() {
    let start = Start { place_m: Vector2::new(3.0, -2.0), heading_deg: 120.0, ..Start::default() };
    let config = EstimatorConfig { start: Some(start), ..EstimatorConfig::default() };
    let (mut origin, mut there) = (Estimator::default(), Estimator::new(config));
    let curve = (0..=90_u32).map(|i| {
        let forward_m_s = (0.02 * f64::from(i)).min(1.0);
        sample(66 * u64::from(i), 0.6 * f64::from(i), forward_m_s, 0.2)
    });
    for sample in curve.enumerate().map(alive) {
        origin.update(&sample);
        there.update(&sample);
        for at in [sample.arrival, sample.arrival + Duration::from_millis(200)] {
            let (origin, there) = (origin.predicted(at), there.predicted(at));
            let turned = |vector| world_from_body(vector, start.heading_deg);
            let expected_m = start.in_world(origin.position_m.xy());
            assert!((there.position_m.xy() - expected_m).norm() < 1e-6, "{there:?}");
            let expected_m_s = turned(origin.velocity_m_s.xy());
            assert!((there.velocity_m_s.xy() - expected_m_s).norm() < 1e-6, "{there:?}");
            assert!(wrap_deg(there.yaw_deg - origin.yaw_deg - start.heading_deg).abs() < 1e-6);
        }
    }
    let (origin, there) = (origin.estimate(), there.estimate());
    assert!(origin.position_m.norm() > 3.0, "{origin:?}");
    assert!((there.position_m.z - origin.position_m.z).abs() < 1e-9);
}

#[test]
fn a_start_is_known_as_well_as_it_was_surveyed() {
    let uncertainty_m = |uncertainty_m| {
        let start = Start { uncertainty_m, ..Start::default() };
        let config = EstimatorConfig { start: Some(start), ..EstimatorConfig::default() };
        Estimator::new(config).uncertainty_m(Duration::ZERO)
    };
    assert!((uncertainty_m(0.4).powi(2) - uncertainty_m(0.0).powi(2) - 0.16).abs() < 1e-9);
}

const PERIOD: Duration = Duration::from_micros(62_500);

/// An estimator, and the packets that it receives every sixteenth of a second. A packet shows the drone as it
/// was when each of its sensors measured.
struct Flight {
    estimator: Estimator,
    packet: u32,
    order: Order,
    /// What the next packets say, apart from a rattle of every sensor.
    shown: Sample,
}

impl Flight {
    fn new(config: &EstimatorConfig) -> Self {
        let shown = Sample { altitude_m: 1.0, airborne: true, ..Sample::default() };
        Self { estimator: Estimator::new(*config), packet: 0, order: Order::ByItself, shown }
    }

    fn now(&self) -> Duration {
        PERIOD * self.packet
    }

    /// Sends the order, and receives a packet.
    fn step(&mut self) {
        self.packet += 1;
        self.estimator.order_sent(self.now(), self.order);
        let rattle = 1e-4 * f64::from(self.packet % 3);
        self.estimator.update(&Sample {
            arrival: self.now(),
            yaw_deg: self.shown.yaw_deg + rattle,
            roll_deg: self.shown.roll_deg + rattle,
            pitch_deg: self.shown.pitch_deg - rattle,
            velocity_forward_m_s: self.shown.velocity_forward_m_s + rattle,
            velocity_right_m_s: self.shown.velocity_right_m_s - rattle,
            altitude_m: self.shown.altitude_m + rattle,
            ..self.shown
        });
    }

    fn fly(&mut self, packets: u32) {
        (0..packets).for_each(|_| self.step());
    }

    fn predicted(&self) -> Prediction {
        self.estimator.predicted(self.now())
    }
}

fn sticks(sticks: Sticks) -> Order {
    Order::Sticks(sticks)
}

fn assert_near(value: f64, expected: f64, tolerance: f64) {
    assert!((value - expected).abs() <= tolerance, "{value} is not {expected}");
}
