use autopilot::Plan;
use autopilot::sim::Simulation;
use mock_drone::airframe::Profile;
use mock_drone::sensors::SensorModel;
use mock_drone::*;
fn main() {
    let seeds: u64 = std::env::args().nth(1).map_or(6, |s| s.parse().unwrap());
    let plans = [
        ("sq", include_str!("../../plans/square1x1.txt")),
        ("xyz", include_str!("../../plans/xyz.txt")),
        ("nik", include_str!("../../plans/NikolausVertical.txt")),
        ("hover", "takeoff\nsetStayTime 30\ngoto 0 0 0 0\nland\n"),
    ];
    for (an, p) in [
        ("rec", Profile::rec()),
        ("tum", Profile::tum()),
        ("tf", Profile::tf()),
        ("leo", Profile::leo()),
    ] {
        for (pn, text) in plans {
            let mut ok = 0;
            for seed in 1..=seeds {
                let drone = DroneConfig {
                    seed,
                    profile: p,
                    sensors: SensorModel::hard(),
                    wind_m_s: nalgebra::Vector2::new(0.5, -0.4),
                    gusts_m_s: 0.2,
                    trim_error_deg: 0.6,
                    ..DroneConfig::default()
                };
                let link = LinkFaults { loss: 0.03, ..LinkFaults::default() };
                let mut last = None;
                let mut first = None;
                let f = Simulation {
                    world: WorldConfig { drone, link, ..WorldConfig::default() },
                    ..Simulation::default()
                }
                .fly_watched(Plan::parse("p", text).unwrap(), |m| {
                    let t = m.status.trust;
                    if t != autopilot::pilot::Trust::Sound && first.is_none() {
                        first = Some((m.now, t));
                    }
                    last = Some(m.status.clone());
                })
                .unwrap();
                if f.outcome == autopilot::outcome::Outcome::Completed {
                    ok += 1
                } else {
                    println!("{an} {pn} {seed}: {} {:?}", f.outcome, first);
                }
            }
            println!("{an} {pn}: {ok}/{seeds}");
        }
    }
}
