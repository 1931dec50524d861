//! Faults of the video, as words of a scenario, and the client that gets over them.

use std::time::Duration;

use ardrone_link::VideoNews;
use ardrone_link::video::{Picture, VideoEvent};
use ardrone_link::{Client, VideoStream};
use mock_drone::WorldConfig;
use mock_drone::firmware::Phase;
use mock_drone::scenario::Scenario;
use mock_drone::server::{MockDrone, Ports};
use tokio::time::timeout;

use crate::udp::address;

const FAULTS: [&str; 4] = ["cut", "silent", "garbage", "lie"];
/// Long enough for a silence to be noticed.
const LASTS: Duration = Duration::from_millis(2500);
/// From one fault to the next.
const PERIOD: Duration = Duration::from_millis(6500);
/// What is on its way when a fault begins is still shown.
const ON_ITS_WAY: Duration = Duration::from_millis(300);
/// From the end of a fault to the next picture: a pause before connecting, and half a second to the next key picture. The
/// rest is for a busy machine.
const RECOVERY: Duration = Duration::from_millis(2500);
/// Longer than any machine should need.
const PATIENCE: Duration = Duration::from_mins(1);

/// When a fault begins, since the drone's start.
fn begins(fault: usize) -> Duration {
    PERIOD * u32::try_from(fault + 1).unwrap()
}

/// All news until a time of the drone, each with its time.
async fn watch(mock: &MockDrone, until: Duration) -> Vec<(Duration, VideoNews)> {
    let ports = mock.ports();
    let mut stream = VideoStream::new(ports.host.to_string(), ports.video.unwrap());
    let mut news = Vec::new();
    while mock.truth().time < until {
        if let Ok(next) = timeout(Duration::from_millis(100), stream.next()).await {
            news.push((mock.truth().time, next));
        }
    }
    news
}

async fn hover(mock: &MockDrone) -> Client {
    let builder = Client::builder().address(address(mock));
    let drone = builder.ready_limit(PATIENCE).take_off_limit(PATIENCE).start().await.unwrap();
    drone.ready().await.unwrap();
    drone.take_off().await.unwrap();
    drone
}

#[tokio::test]
async fn the_video_comes_back_after_each_fault() {
    let lines = FAULTS.iter().enumerate().map(|(number, fault)| {
        format!("{} video {fault} for {}\n", begins(number).as_secs_f64(), LASTS.as_secs_f64())
    });
    let scenario = Scenario::parse("s.txt", &lines.collect::<String>()).unwrap();
    let world = WorldConfig { scenario, ..WorldConfig::default() };
    let mock = MockDrone::start(&world, Ports { video: Some(0), ..Ports::LOOPBACK }).unwrap();
    let end = begins(FAULTS.len());
    let (news, drone) = tokio::join!(watch(&mock, end), hover(&mock));
    assert_eq!(mock.truth().phase, Phase::Flying, "the flight has nothing to do with it");
    drone.close().await.unwrap();

    let pictures = |from: Duration, to: Duration| -> Vec<(Duration, &Picture)> {
        let within = news.iter().filter(|(at, _)| (from..to).contains(at));
        within
            .filter_map(|(at, news)| match news {
                VideoNews::Picture(picture) => Some((*at, picture)),
                _ => None,
            })
            .collect()
    };
    assert!(pictures(Duration::ZERO, begins(0)).len() > 60, "there was no video before");
    for (number, fault) in FAULTS.into_iter().enumerate() {
        let ends = begins(number) + LASTS;
        let meanwhile = pictures(begins(number) + ON_ITS_WAY, ends).len();
        // Key pictures that announce less than follows are shown: that they are cut is known too late.
        let most = if fault == "lie" { 4 } else { 0 };
        assert!(meanwhile <= most, "{fault}: {meanwhile} pictures");
        let is_lost = news.iter().any(|(at, news)| {
            (begins(number)..ends).contains(at) && *news == VideoNews::Event(VideoEvent::Lost)
        });
        assert_eq!(is_lost, ["cut", "silent"].contains(&fault), "{fault}");

        let after = pictures(ends, begins(number + 1));
        let (first_at, first) = after.first().unwrap_or_else(|| panic!("{fault}: no video after"));
        let late = first_at.saturating_sub(ends);
        assert!(late < RECOVERY, "{fault}: {late:?} late");
        assert!(first.is_entry(), "{fault}");
        let follows =
            |pair: &[(Duration, &Picture)]| pair[1].1.header.number == pair[0].1.header.number + 1;
        assert!(after.windows(2).all(follows), "{fault}: pictures are missing");
        assert!(after.len() > 30, "{fault}: {} pictures", after.len());
    }
}
