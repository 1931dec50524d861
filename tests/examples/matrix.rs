use autopilot::Plan;
use autopilot::sim::Simulation;
use mock_drone::WorldConfig;
use mock_drone::airframe::Profile;
use mock_drone::firmware::Phase;
use mock_drone::scenario::*;
use mock_drone::sensors::SensorModel;
use mock_drone::*;
use std::time::Duration;
fn main() {
    let seeds: u64 = std::env::args().nth(1).map_or(2, |s| s.parse().unwrap());
    let only = std::env::args().nth(2);
    let s = Duration::from_secs_f64;
    let sits = [
        ("hold", "takeoff|setStayTime 40|goto 0 0 0 0|land", (0.0, 0.0), 8.0, 0.5),
        ("way", "takeoff|goto 0 0 0 0|goto 3 0 0 0|land", (3.0, 0.0), 6.2, 0.0),
        ("climb", "takeoff|goto 0 0 0 0|goto 0 0 1.5 0|land", (0.0, 0.0), 6.2, 0.0),
        ("descend", "takeoff|goto 0 0 1 0|goto 0 0 0 0|land", (0.0, 0.0), 9.0, 0.0),
        ("turn", "takeoff|goto 0 0 0 0|goto 0 0 0 179|goto 2 0 0 179|land", (2.0, 0.0), 6.2, 0.0),
    ];
    use Quantity as Q;
    use SensorFault as F;
    let mut faults: Vec<(String, Vec<Action>)> = vec![];
    let forever = s(60.0);
    for q in Q::ALL {
        for f in [F::Stuck, F::StuckAt(0.0), F::DeadAt(0.0), F::NotANumber, F::Late(s(0.5))] {
            faults.push((format!("{q:?} {f:?}"), vec![Action::Sensor(q, f, forever)]));
        }
        let (j, r): (&[f64], &[f64]) = match q {
            Q::VelocityRight | Q::VelocityForward => (&[0.3, 0.6, 1.0, -2.0], &[0.05, 0.2, 1.0]),
            Q::Altitude => (&[0.5, -0.5, 2.0], &[0.1, -0.2, 1.0]),
            Q::Yaw => (&[8.0, 60.0, 160.0], &[2.0, -10.0, 60.0]),
            Q::Roll | Q::Pitch => (&[5.0, 20.0], &[1.0]),
            Q::Clock => (&[-1.0, 3.0], &[-0.5, 0.5]),
        };
        for &x in j {
            faults.push((
                format!("{q:?} Offset {x}"),
                vec![Action::Sensor(q, F::Offset(x), forever)],
            ));
        }
        for &x in r {
            faults.push((format!("{q:?} Ramp {x}"), vec![Action::Sensor(q, F::Ramp(x), forever)]));
        }
    }
    faults.push(("all".into(), vec![Action::Freeze(forever)]));
    faults.push((
        "all+clock".into(),
        vec![Action::Freeze(forever), Action::Sensor(Q::Clock, F::Stuck, forever)],
    ));
    println!("{:<32}{}", "", sits.iter().map(|x| format!("{:>24}", x.0)).collect::<String>());
    for (name, actions) in faults {
        if only.as_ref().is_some_and(|o| !name.contains(o.as_str())) {
            continue;
        }
        let mut row = format!("{name:<32}");
        for (_, text, (tx, _), at, wind) in &sits {
            let mut worst = (0.0_f64, 0, "");
            let (mut low, mut high) = (9.0_f64, 0.0_f64);
            let mut done = 0;
            let mut contact = 0;
            for (pn, p) in [
                ("rec", Profile::rec()),
                ("tum", Profile::tum()),
                ("tf", Profile::tf()),
                ("leo", Profile::leo()),
            ] {
                for seed in 1..=seeds {
                    let mut scenario = Scenario::default();
                    for a in &actions {
                        scenario =
                            scenario.and(When::SinceTakeOff(s(*at) + s(0.07 * seed as f64)), *a);
                    }
                    let mut world = WorldConfig { scenario, ..WorldConfig::default() };
                    world.drone.seed = seed;
                    world.drone.profile = p;
                    world.drone.wind_m_s.x = *wind;
                    if seed % 2 == 0 {
                        world.drone.sensors = SensorModel::hard();
                    }
                    let mut flew = false;
                    let f = Simulation { world, ..Simulation::default() }
                        .fly_watched(Plan::parse("p", &text.replace("|", "\n")).unwrap(), |m| {
                            let t = &m.truth.position_m;
                            if m.truth.phase == Phase::Flying {
                                flew = true;
                            }
                            if flew {
                                let seg = t.x - t.x.clamp(0.0, *tx);
                                let d = seg.hypot(t.y);
                                if d > worst.0 {
                                    worst = (d, seed, pn);
                                }
                                if m.truth.phase == Phase::Flying {
                                    low = low.min(t.z);
                                    high = high.max(t.z);
                                    if t.z <= 0.001 {
                                        contact += 1;
                                    }
                                }
                            }
                        })
                        .unwrap();
                    if f.outcome == autopilot::outcome::Outcome::Completed {
                        done += 1;
                    }
                }
            }
            row += &format!(
                "{:>7.2}{:>4}{:>2} {:>4.1}-{:<3.1}{:<2}",
                worst.0,
                worst.2,
                done,
                low,
                high,
                if contact > 0 { "F" } else { "" }
            );
        }
        println!("{row}");
    }
}
