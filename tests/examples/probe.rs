use autopilot::Plan;
use autopilot::pilot::PilotConfig;
use autopilot::plan::FlightLimits;
use autopilot::sim::Simulation;
use mock_drone::WorldConfig;
use mock_drone::scenario::Scenario;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let scenario = Scenario::parse("s", &a[1].replace("|", "\n")).unwrap();
    let text = a[2].replace("|", "\n");
    let seed: u64 = a[3].parse().unwrap();
    let radius: f64 = a.get(4).map_or(10.0, |s| s.parse().unwrap());
    let limits = FlightLimits { radius_m: radius, ..FlightLimits::default() };
    let mut world = WorldConfig { scenario, ..WorldConfig::default() };
    world.drone.seed = seed;
    if let Some(p) = a.get(5) {
        use mock_drone::airframe::Profile;
        world.drone.profile = match p.as_str() {
            "tum" => Profile::tum(),
            "tf" => Profile::tf(),
            "leo" => Profile::leo(),
            _ => Profile::rec(),
        };
    }
    let pilot = PilotConfig { limits, ..PilotConfig::default() };
    let mut n = 0;
    let f=Simulation{world,pilot,..Simulation::default()}.fly_watched(Plan::parse_within("p",&text,&limits).unwrap(),|m|{ n+=1; if n%7==0 { let t=&m.truth; let p=&m.status.pose; println!("{:6.2} {:?} truth {:6.2} {:6.2} {:5.2} odo {:6.2} {:6.2} v {:5.2} {:5.2} {:5.2} yaw {:6.1} | est {:6.2} {:6.2} {:5.2} yaw {:6.1} sd {:.2} {} {:?} {:?}", m.now.as_secs_f64(), t.phase, t.position_m.x,t.position_m.y,t.position_m.z,t.odometry_m.x,t.odometry_m.y,t.velocity_m_s.x,t.velocity_m_s.y,t.velocity_m_s.z,t.yaw_deg,p.x_m,p.y_m,p.z_m,p.yaw_deg,m.status.horizontal_deviation_m,m.status.trust,m.status.command,m.status.target.map(|t|(t.x_m,t.y_m,t.z_m))); } }).unwrap();
    for (t, e) in &f.events {
        println!("{:7.2} {e}", t.as_secs_f64());
    }
    println!("{}", f.outcome);
}
