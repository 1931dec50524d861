//! The bit rate of the video, from the settings to the stream.

use std::time::Duration;

use ardrone_link::settings::BitRateControl;
use ardrone_link::{Client, Identity, Setting, Steering, VideoNews, VideoStream};
use ardrone_pilot::settings::Settings;
use autopilot::outcome::Outcome;
use autopilot::plan::ZOrigin;
use autopilot::vehicle::FlightEvent;
use mock_drone::WorldConfig;
use mock_drone::server::{MockDrone, Ports};
use system_tests::plan;
use system_tests::sim::Simulation;

use crate::udp::address;

/// Longer than any machine should need.
const PATIENCE: Duration = Duration::from_mins(1);

/// The pilot asks for the rate of its settings, the drone confirms it, and is flown.
#[test]
fn the_drone_is_asked_for_the_rate_of_the_settings() {
    for (text, expected) in [("", 1000), ("[video]\nbitrate_kbit_s = 600\n", 600)] {
        let pilot = Settings::parse("pilot.toml", text).unwrap().pilot_config(ZOrigin::Hover);
        let simulation = Simulation { pilot, ..Simulation::default() };
        let mut found = 0;
        let flown = simulation
            .fly_in_world(plan("takeoff\nland\n"), |_, world| found = world.drone().video_kbit_s())
            .unwrap();
        assert_eq!((flown.outcome, found), (Outcome::Completed, expected));
        assert!(!flown.events.iter().any(|(_, event)| *event == FlightEvent::NoVideoRate));
    }
}

/// Kilobits per second that 60 pictures would have at their usual 30 a second, which a busy machine does not reach.
async fn rate(stream: &mut VideoStream) -> u32 {
    let (mut pictures, mut bytes) = (0, 0);
    while pictures < 60 {
        if let VideoNews::Picture(picture) = stream.next().await {
            pictures += 1;
            bytes += picture.header.payload_bytes;
        }
    }
    bytes * 8 / 2 / 1000
}

#[tokio::test]
async fn the_stream_has_the_rate_that_is_asked_for() {
    let ports = Ports { video: Some(0), ..Ports::LOOPBACK };
    let mock = MockDrone::start(&WorldConfig::default(), ports).unwrap();
    let ports = mock.ports();
    let mut stream = VideoStream::new(ports.host.to_string(), ports.video.unwrap());
    let builder = Client::builder().address(address(&mock));
    let builder = builder.ready_limit(PATIENCE).take_off_limit(PATIENCE);
    let drone = builder.identity(Identity { session: 1, user: 2, application: 3 }).start();
    let drone = drone.await.unwrap();
    drone.ready().await.unwrap();
    // A picture that does not change needs less than the drone may send.
    drone.take_off().await.unwrap();
    drone.steer(Steering::clockwise(1.0), PATIENCE).unwrap();
    rate(&mut stream).await;
    let before = rate(&mut stream).await;
    let manual = Setting::VideoBitRateControl(BitRateControl::Manual);
    drone.configure(&manual).await.unwrap();
    drone.configure(&Setting::VideoBitRateKbitS(250)).await.unwrap();
    // What waited in the meantime has the old rate, and so have the pictures up to the next key picture.
    rate(&mut stream).await;
    let after = rate(&mut stream).await;
    assert!((700..1300).contains(&before), "{before} kbit/s");
    assert!((180..350).contains(&after), "{after} kbit/s");
}
