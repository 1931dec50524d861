use std::time::Duration;

use nalgebra::{Vector2, Vector3};

use crate::{Estimator, EstimatorConfig, Sample, Sight, SurveyedTag, TagConfig};

mod frames;
mod surveyed_in_flight;
mod trials;
mod turned;

const PERIOD: Duration = Duration::from_micros(66_667);
const HEIGHT_M: f64 = 1.5;
const DELAY: Duration = Duration::from_millis(60);

/// A hovering drone whose flow has a bias.
struct Bench {
    estimator: Estimator,
    packet: u32,
    flow_m_s: Vector2<f64>,
    yaw_deg: f64,
    sees: bool,
    /// The tag: position relative to the drone, and its direction.
    tag_m: Vector2<f64>,
    direction_deg: f64,
}

impl Bench {
    fn new(tags: Option<&TagConfig>) -> Self {
        let config =
            EstimatorConfig { tags: tags.copied(), identify: false, ..EstimatorConfig::default() };
        Self {
            estimator: Estimator::new(config),
            packet: 0,
            flow_m_s: Vector2::new(0.01, -0.006),
            yaw_deg: 0.0,
            sees: true,
            tag_m: Vector2::new(0.2, 0.1),
            direction_deg: 30.0,
        }
    }

    fn now(&self) -> Duration {
        PERIOD * self.packet
    }

    /// Flies a number of packets; `wrong` adds sightings of something else.
    fn fly(&mut self, packets: u32, mut wrong: impl FnMut(u32) -> Option<Sight>) {
        for _ in 0..packets {
            self.packet += 1;
            let rattle_m_s = if self.packet.is_multiple_of(2) { 0.01 } else { -0.01 };
            self.estimator.update(&Sample {
                arrival: self.now(),
                yaw_deg: self.yaw_deg,
                velocity_right_m_s: self.flow_m_s.x + rattle_m_s,
                velocity_forward_m_s: self.flow_m_s.y - rattle_m_s,
                altitude_m: HEIGHT_M + 0.001 * f64::from(self.packet % 3),
                airborne: true,
                ..Sample::default()
            });
            let sight = self.sees.then(|| self.sight());
            let sights: Vec<Sight> = sight.into_iter().chain(wrong(self.packet)).collect();
            self.estimator.see(&sights);
        }
    }

    fn sight(&self) -> Sight {
        let body = kinematics::body_from_world(self.tag_m, self.yaw_deg);
        let noise = f64::from(self.packet * 7 % 5) - 2.0;
        sight_at(body, 270.0 + self.yaw_deg - self.direction_deg + noise, noise)
    }

    fn place_m(&self) -> Vector2<f64> {
        self.estimator.predicted(self.now()).position_m.xy()
    }

    fn uncertainty_m(&self) -> f64 {
        self.estimator.uncertainty_m(self.now())
    }
}

/// A sighting of a tag at this offset from a level drone.
fn sight_at(body_m: Vector2<f64>, orientation_deg: f64, noise: f64) -> Sight {
    let width = 1072.0 * 0.19 / HEIGHT_M;
    Sight {
        x: 500.0 + 1072.0 * body_m.x / HEIGHT_M + noise,
        y: 450.0 - 1452.0 * body_m.y / HEIGHT_M - noise,
        width,
        height: width * 1452.0 / 1072.0,
        distance_m: HEIGHT_M * 0.222 / 0.19,
        orientation_deg,
    }
}

fn none(_: u32) -> Option<Sight> {
    None
}

#[test]
fn a_tag_below_ends_the_drift() {
    let mut with = Bench::new(Some(&TagConfig::default()));
    let mut without = Bench::new(None);
    with.fly(3000, none);
    without.fly(3000, none);
    assert!(without.place_m().norm() > 2.0, "{}", without.place_m());
    assert!(with.place_m().norm() < 0.05, "{}", with.place_m());
    assert!(with.uncertainty_m() < 0.1 && without.uncertainty_m() > 1.0);
    let tag = with.estimator.tag_status(with.now()).unwrap();
    let tag = tag.known.iter().next().unwrap();
    assert!((tag.place_m - with.tag_m).norm() < 0.05, "{tag:?}");
    assert!(!tag.surveyed && tag.uncertainty_m < 0.15, "{tag:?}");
}

#[test]
fn what_is_seen_changes_nothing_unless_tags_are_used() {
    let mut seeing = Bench::new(None);
    let mut blind = Bench { sees: false, ..Bench::new(None) };
    seeing.fly(200, none);
    blind.fly(200, none);
    let now = seeing.now();
    let (seeing, blind) = (&seeing.estimator, &blind.estimator);
    assert_eq!(seeing.predicted(now), blind.predicted(now));
    assert_eq!(seeing.smooth(&seeing.predicted(now)), blind.predicted(now));
    assert_eq!(seeing.tag_status(now), None);
}

#[test]
fn a_tag_that_comes_into_view_again_takes_the_drift_back_without_a_step() {
    let mut bench = Bench::new(Some(&TagConfig::default()));
    bench.fly(40, none);
    bench.sees = false;
    bench.flow_m_s = Vector2::new(0.03, 0.02);
    bench.fly(300, none);
    let drifted_m = bench.place_m();
    assert!(drifted_m.norm() > 0.4, "{drifted_m}");
    bench.sees = true;
    bench.flow_m_s = Vector2::zeros();
    let (mut largest_step_m, mut largest_jump_m): (f64, f64) = (0.0, 0.0);
    let mut last: Option<(Vector3<f64>, Vector3<f64>)> = None;
    for _ in 0..150 {
        bench.fly(1, none);
        bench.estimator.advance_smooth(PERIOD.as_secs_f64());
        let prediction = bench.estimator.predicted(bench.now());
        let smooth = bench.estimator.smooth(&prediction);
        if let Some((place_m, smooth_m)) = last {
            largest_jump_m = largest_jump_m.max((prediction.position_m - place_m).norm());
            largest_step_m = largest_step_m.max((smooth.position_m - smooth_m).norm());
        }
        last = Some((prediction.position_m, smooth.position_m));
    }
    assert!(bench.place_m().norm() < 0.1, "{}", bench.place_m());
    assert!(largest_jump_m > 0.2, "the estimate knows at once: {largest_jump_m}");
    assert!(largest_step_m < 0.03, "the controller sees a motion: {largest_step_m}");
}

#[test]
fn single_sights_of_something_else_lead_nobody_astray() {
    let mut bench = Bench { sees: false, ..Bench::new(Some(&TagConfig::default())) };
    let mut honest = Bench { sees: false, ..Bench::new(Some(&TagConfig::default())) };
    let wrong = |packet: u32| {
        let place_m =
            Vector2::new(f64::from(packet * 31 % 11) - 5.0, f64::from(packet * 17 % 7) - 3.0);
        packet.is_multiple_of(25).then(|| sight_at(place_m * 0.08, 10.0, 0.0))
    };
    bench.fly(3000, wrong);
    honest.fly(3000, none);
    let led_m = (bench.place_m() - honest.place_m()).norm();
    assert!(led_m < 0.2, "some agree by chance: {led_m}");
    assert_eq!(bench.estimator.tag_status(bench.now()).unwrap().known.count(), 0);
    assert!(bench.uncertainty_m() > 0.7 * honest.uncertainty_m());
}

#[test]
fn a_tag_that_is_carried_away_does_not_take_the_drone_with_it() {
    let mut bench = Bench::new(Some(&TagConfig::default()));
    bench.fly(300, none);
    for _ in 0..300 {
        bench.tag_m.x += 0.02;
        bench.fly(1, none);
        if bench.tag_m.x > 0.6 {
            bench.sees = false;
        }
    }
    assert!(bench.place_m().norm() < 0.4, "{}", bench.place_m());
    let before_m = bench.uncertainty_m();
    bench.fly(300, none);
    assert!(bench.uncertainty_m() > before_m + 0.05, "it is no longer sure");
}

#[test]
fn a_surveyed_tag_says_where_the_drone_stands() {
    let mut config = TagConfig::default();
    let place_m = Vector2::new(0.35, 0.0);
    config.surveyed[0] = Some(SurveyedTag { place_m, heading_deg: None });
    let mut bench = Bench::new(Some(&config));
    bench.flow_m_s = Vector2::zeros();
    bench.fly(400, none);
    // The tag is at (0.2, 0.1) from the drone, so the drone did not start where it was assumed.
    let expected = place_m - bench.tag_m;
    assert!((bench.place_m() - expected).norm() < 0.06, "{}", bench.place_m());
}

#[test]
fn orientation_holds_the_heading_once_a_turn_has_told_its_sign() {
    let mut bench = Bench::new(Some(&TagConfig::default()));
    bench.fly(40, none);
    assert!(bench.estimator.would_learn_from_a_turn(bench.now()));
    for packet in 0..180 {
        bench.yaw_deg = 8.0 * (f64::from(packet) * 0.07).sin();
        bench.fly(1, none);
    }
    let status = bench.estimator.tag_status(bench.now()).unwrap();
    assert!(status.heading_held && status.known.count() == 1, "{status:?}");
    assert!(!bench.estimator.would_learn_from_a_turn(bench.now()));
    // The gyroscope drifts; the drone does not turn.
    let held_deg = bench.yaw_deg;
    for packet in 0..4500 {
        let drift_deg = 0.001 * f64::from(packet);
        bench.packet += 1;
        bench.estimator.update(&Sample {
            arrival: bench.now(),
            yaw_deg: held_deg + drift_deg,
            velocity_right_m_s: if packet % 2 == 0 { 0.01 } else { -0.01 },
            altitude_m: HEIGHT_M,
            airborne: true,
            ..Sample::default()
        });
        let sight = bench.sight();
        bench.estimator.see(&[sight]);
    }
    let yaw_deg = bench.estimator.predicted(bench.now()).yaw_deg;
    assert!((yaw_deg - held_deg).abs() < 1.0, "4.5° of drift became {}", yaw_deg - held_deg);
}

#[test]
fn nothing_that_can_be_told_breaks_it() {
    let mut bench = Bench::new(Some(&TagConfig::default()));
    let odd = [f64::NAN, f64::INFINITY, -1.0, 0.0, 4e9];
    bench.fly(500, |packet| {
        let value = |i: u32| odd[usize::try_from((packet * 7 + i * 3) % 5).unwrap()];
        Some(Sight {
            x: value(0),
            y: value(1),
            width: value(2),
            height: value(3),
            distance_m: value(4),
            orientation_deg: value(5),
        })
    });
    assert!(bench.place_m().norm() < 0.1, "{}", bench.place_m());
    assert_eq!(DELAY, TagConfig::default().delay);
}

/// Cost of a packet with four sightings of known tags: `cargo test --release -p estimator -- --ignored
/// --nocapture costs`.
#[test]
#[ignore = "measures time"]
#[expect(clippy::disallowed_methods, reason = "it measures")]
fn what_a_sight_costs() {
    let mut config = TagConfig::default();
    for (i, slot) in config.surveyed.iter_mut().enumerate() {
        let right_m = 0.3 + 1.6 * i as f64;
        *slot = Some(SurveyedTag { place_m: Vector2::new(right_m, 0.1), heading_deg: Some(30.0) });
    }
    let mut bench = Bench::new(Some(&config));
    bench.fly(100, none);
    let start = std::time::Instant::now();
    let packets = 20_000;
    bench.fly(packets, none);
    let seen = start.elapsed() / packets;
    bench.sees = false;
    let start = std::time::Instant::now();
    bench.fly(packets, none);
    let blind = start.elapsed() / packets;
    println!("a sight costs {:?}, a packet without {blind:?}", seen.saturating_sub(blind));
    assert!(seen.saturating_sub(blind) < Duration::from_micros(20));
}
