//! A tick in the air must not allocate, because the allocator may block.

use std::time::Duration;

use allocation_counter::measure;
use ardrone_pilot::recording::{Header, Recorder, Timing};
use autopilot::Vehicle;
use autopilot::vehicle::{
    Input, NavdataRate, Operator, OperatorOrder, Output, Phase, Place, TICK, TagConfig, Transmit,
    VehicleConfig,
};
use kinematics::Sticks;
use mock_drone::{FloorTag, Message, World, WorldConfig};
use system_tests::{SQUARE, plan};

const POLL: Duration = Duration::from_millis(5);

/// Counts allocations in flight. On the ground the configuration is read and compared, which allocates.
fn allocations(
    navdata: NavdataRate,
    orders: &[(Duration, OperatorOrder)],
    tags: Option<&TagConfig>,
) -> u64 {
    let mut config = VehicleConfig { navdata, ..VehicleConfig::default() };
    config.estimator.tags = tags.copied();
    let mut pilot = Vehicle::flying(plan(SQUARE), &config).unwrap();
    let mut world = World::new(&WorldConfig {
        tags: vec![FloorTag::new(0.0, 0.0, 0.0), FloorTag::new(1.0, 1.0, 0.0)],
        ..WorldConfig::default()
    });
    let mut orders = orders.iter().peekable();
    let mut allocations = 0;
    let mut wakes_up = false;
    let folder = tempfile::tempdir().unwrap();
    let (mut recorder, recording) =
        Recorder::start(&folder.path().join("flight.mcap"), &Header::default()).unwrap();
    let mut now = Duration::ZERO;
    while pilot.outcome().is_none() {
        let flies = pilot.status(now).phase == Phase::Flying;
        let mut count = |work: &mut dyn FnMut()| {
            let asked = measure(work).count_total;
            allocations += if flies { asked } else { 0 };
        };
        world.advance(now);
        while let Some(message) = world.receive(now) {
            match message {
                Message::Navdata(packet) => count(&mut || {
                    pilot.handle(now, Input::Navdata(&packet));
                    recorder.navdata(now, &packet);
                }),
                Message::Control(dump) => pilot.handle(now, Input::Control(dump.as_bytes())),
            }
        }
        if now.as_millis().is_multiple_of(TICK.as_millis()) {
            while let Some((_, order)) = orders.next_if(|(at, _)| now >= *at) {
                count(&mut || pilot.handle(now, Input::Order(Operator::TERMINAL, order.clone())));
            }
            count(&mut || pilot.tick(now));
            count(&mut || {
                while let Some(output) = pilot.poll() {
                    match output {
                        Output::Transmit(Transmit::Command { datagram, decision }) => {
                            if let Some(decision) = decision {
                                recorder.tick(*decision, Timing::default(), datagram);
                            }
                        }
                        Output::Transmit(Transmit::WakeUp) => wakes_up = true,
                        Output::Event(event) => recorder.event(now, event),
                        Output::Waypoint(_)
                        | Output::Ended(_)
                        | Output::Mission { .. }
                        | Output::Readiness(_) => {}
                    }
                }
            });
            world.send_at(now, pilot.datagram());
            if std::mem::take(&mut wakes_up) {
                world.send_wake_up(now, &ardrone_link::WAKE_UP);
            }
        }
        now += POLL;
    }
    drop(recorder);
    assert!(recording.finish().unwrap().bytes > 100_000);
    assert!(now > Duration::from_secs(15), "it flew: {:?}", pilot.outcome());
    allocations
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
        assert_eq!(allocations(navdata, &[], None), 0, "{navdata:?}");
        assert_eq!(allocations(navdata, &orders, None), 0, "{navdata:?}, by hand");
        let tags = TagConfig::default();
        assert_eq!(allocations(navdata, &[], Some(&tags)), 0, "{navdata:?}, with tags");
    }
}
