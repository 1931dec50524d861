//! A drone and its radio link: faults of the link, and a scenario that changes them over time.
//!
//! Pure, like the drone itself: server and simulation drive it alike.

use std::time::Duration;

use bytes::Bytes;

use crate::air::{Presence, Standing};
use crate::camera::FloorTag;
use crate::drone::{Drone, DroneConfig, Truth};
use crate::faults::{Quantity, SensorFault};
use crate::firmware::Phase;
use crate::link::{Link, LinkFaults};
use crate::scenario::{Action, Direction, Scenario, VideoFault};
use crate::second_pilot::SecondPilot;

/// Configuration of a [`World`].
#[derive(Debug, Clone, Default, PartialEq)]
pub struct WorldConfig {
    /// The drone.
    pub drone: DroneConfig,
    /// Initial faults of the link in both directions.
    pub link: LinkFaults,
    /// Faults over time.
    pub scenario: Scenario,
    /// Tags on the floor.
    pub tags: Vec<FloorTag>,
    /// Where the drone stands in the air that it may share with others. Its own frame begins there.
    pub start: Standing,
}

/// A message from the drone.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Message {
    /// A datagram of the navdata port, for the client that sent the last wake-up.
    Navdata(Bytes),
    /// Text for the control port.
    Control(String),
}

/// Destination of a datagram.
#[derive(Debug, Clone, Copy)]
enum Port {
    At,
    Navdata,
}

/// A world with one drone in it.
#[derive(Debug, Clone)]
pub struct World {
    drone: Drone,
    start: Standing,
    up: Link<Port>,
    down: Link<()>,
    scenario: Scenario,
    take_off: Option<Duration>,
    /// End of the current outage, up and down.
    outage_ends: [Option<Duration>; 2],
    second_pilot: Option<SecondPilot>,
    /// Faults of the video, with the end of each; the last one counts.
    video_faults: Vec<(VideoFault, Duration)>,
    control: Option<String>,
}

impl World {
    /// A world at its start.
    pub fn new(config: &WorldConfig) -> Self {
        let seed = config.drone.seed;
        let mut drone = Drone::new(&config.drone);
        for tag in &config.tags {
            drone.lay_tag(*tag);
        }
        Self {
            drone,
            start: config.start,
            up: Link::new(config.link, seed).dropping_spoiled(),
            down: Link::new(config.link, seed.wrapping_add(1)),
            scenario: config.scenario.clone(),
            take_off: None,
            outage_ends: [None; 2],
            second_pilot: None,
            video_faults: Vec::new(),
            control: None,
        }
    }

    /// Sends a datagram to the drone's AT port.
    pub fn send_at(&mut self, now: Duration, datagram: &[u8]) {
        self.advance(now);
        self.up.send(now, Port::At, Bytes::copy_from_slice(datagram));
    }

    /// Sends a datagram to the drone's navdata port.
    pub fn send_wake_up(&mut self, now: Duration, datagram: &[u8]) {
        self.advance(now);
        self.up.send(now, Port::Navdata, Bytes::copy_from_slice(datagram));
    }

    /// Advances the simulation to `now`.
    pub fn advance(&mut self, now: Duration) {
        loop {
            let next = [
                self.up.next_due(),
                self.scenario.next_due(self.take_off),
                self.outage_ends[0],
                self.outage_ends[1],
                self.second_pilot.as_ref().and_then(SecondPilot::next_due),
            ];
            let next = next.into_iter().flatten().min().filter(|next| *next <= now);
            let Some(time) = next.map(|next| next.max(self.drone.time())) else { break };
            self.live(time);
            self.change(time);
            if let Some(datagram) =
                self.second_pilot.as_mut().and_then(|other| other.datagram(time))
            {
                self.hear(time, datagram.as_bytes());
            }
            while let Some((_, port, datagram)) = self.up.receive(time) {
                match port {
                    Port::At => self.hear(time, &datagram),
                    Port::Navdata => self.drone.handle_wake_up(time),
                }
            }
        }
        self.live(now);
    }

    /// The next message that has arrived by now.
    pub fn receive(&mut self, now: Duration) -> Option<Message> {
        let navdata = self.down.receive(now).map(|(_, (), datagram)| Message::Navdata(datagram));
        navdata.or_else(|| self.control.take().map(Message::Control))
    }

    /// How others in the air notice the drone.
    pub fn presence(&self) -> Presence {
        let own = self.drone.presence();
        Presence { position_m: self.start.in_common(own.position_m), ..own }
    }

    /// Tells of all others in the air, which are taken to stay where they are until the next call: their wash is felt below them,
    /// and their ultrasound disturbs heights within 3 m if it has the same frequency.
    pub fn meet(&mut self, others: impl IntoIterator<Item = Presence>) {
        let start = self.start;
        self.drone.meet(others.into_iter().map(|other| Presence {
            position_m: start.seen_from_start(other.position_m),
            ..other
        }));
    }

    /// The true state.
    pub fn truth(&self) -> Truth {
        self.drone.truth()
    }

    /// Fraction of the drone's datagrams that are lost, and whether all are.
    #[cfg(feature = "video")]
    pub(crate) fn link_state(&self) -> (f64, bool) {
        (self.down.faults.loss, self.down.out)
    }

    /// What is wrong with the video now.
    pub fn video_fault(&self) -> Option<VideoFault> {
        let now = self.drone.time();
        self.video_faults.iter().rfind(|(_, ends)| now < *ends).map(|(fault, _)| *fault)
    }

    /// The drone.
    pub fn drone(&self) -> &Drone {
        &self.drone
    }

    fn hear(&mut self, now: Duration, datagram: &[u8]) {
        for error in self.drone.handle_at(now, datagram) {
            tracing::debug!("{error}");
        }
    }

    fn live(&mut self, now: Duration) {
        self.drone.advance(now);
        // A drone that starts airborne has taken off at the start.
        if matches!(self.drone.truth().phase, Phase::TakingOff { .. } | Phase::Flying) {
            self.take_off.get_or_insert(now);
        }
        while let Some(packet) = self.drone.poll_navdata() {
            self.down.send(now, (), packet);
        }
        // TCP retransmits lost segments, and needs both directions.
        if !self.down.out
            && !self.up.out
            && let Some(dump) = self.drone.poll_control()
        {
            self.control = Some(dump);
        }
    }

    /// Ends faults that are over and starts those that are due.
    fn change(&mut self, now: Duration) {
        let over = |end: &mut Duration| *end <= now;
        let [up, down] = &mut self.outage_ends;
        if up.take_if(over).is_some() {
            self.up.out = false;
        }
        if down.take_if(over).is_some() {
            self.down.out = false;
        }
        for action in self.scenario.due(now, self.take_off) {
            tracing::info!("{action:?}");
            self.act(now, action);
        }
    }

    fn act(&mut self, now: Duration, action: Action) {
        match action {
            Action::Loss(direction, share) => {
                self.faults(direction, |faults| faults.loss = share);
            }
            Action::Delay(delay, jitter) => {
                self.faults(Direction::Both, |faults| {
                    (faults.delay, faults.jitter) = (delay, jitter);
                });
            }
            Action::Duplication(share) => {
                self.faults(Direction::Both, |faults| faults.duplication = share);
            }
            Action::Reordering(share) => {
                self.faults(Direction::Both, |faults| faults.reordering = share);
            }
            Action::Corruption(share) => {
                self.faults(Direction::Both, |faults| faults.corruption = share);
            }
            Action::Outage(direction, time) => self.cut_off(direction, now + time),
            Action::Hold(direction, time) => {
                if direction.is_up() {
                    self.up.hold_until(now + time);
                }
                if direction.is_down() {
                    self.down.hold_until(now + time);
                }
            }
            Action::Burst(packets) => self.down.repeat(now, packets),
            Action::Restart => self.drone.restart(now),
            Action::Propeller => self.drone.block_propeller(),
            Action::Freeze(time) => {
                for quantity in Quantity::SENSED {
                    self.drone.break_sensor(quantity, SensorFault::Stuck, time);
                }
            }
            Action::Sensor(quantity, fault, time) => {
                self.drone.break_sensor(quantity, fault, time);
            }
            Action::State(bits, time) => self.drone.claim_state(bits, time),
            Action::Minor(minor, time) => self.drone.claim_minor_state(minor, time),
            Action::Motor(share, within) => self.drone.weaken_motor(share, within),
            Action::Wind(steady_m_s, gusts_m_s) => self.drone.set_wind(steady_m_s, gusts_m_s),
            Action::LayTag(tag) => self.drone.lay_tag(tag),
            Action::MoveTag(number, to) => self.drone.move_tag(number, to),
            Action::Battery(percent) => self.drone.set_battery_percent(percent),
            Action::BatterySag(percent) => self.drone.set_battery_sag_percent(percent),
            Action::SecondPilot(time, sequence) => {
                self.second_pilot = Some(SecondPilot::new(now, time, sequence));
            }
            Action::Video(fault, time) => {
                self.video_faults.retain(|(_, ends)| now < *ends);
                self.video_faults.push((fault, now + time));
            }
        }
    }

    fn faults(&mut self, direction: Direction, change: impl Fn(&mut LinkFaults)) {
        if direction.is_up() {
            change(&mut self.up.faults);
        }
        if direction.is_down() {
            change(&mut self.down.faults);
        }
    }

    /// Blocks a direction until `ends`; of two outages the later end counts.
    fn cut_off(&mut self, direction: Direction, ends: Duration) {
        let [up, down] = &mut self.outage_ends;
        if direction.is_up() {
            self.up.out = true;
            *up = (*up).max(Some(ends));
        }
        if direction.is_down() {
            self.down.out = true;
            *down = (*down).max(Some(ends));
        }
    }
}

#[cfg(test)]
mod tests {
    use ardrone_link::at::{Command, Config, Datagram, Motion, Ref};
    use ardrone_link::navdata::Navdata;

    use super::*;

    const TICK: Duration = Duration::from_millis(30);

    /// A world with a client that configures the drone and keeps it flying.
    struct Bench {
        world: World,
        now: Duration,
        sequence: u32,
        /// Time of arrival and number of each navdata packet.
        heard: Vec<(Duration, u32)>,
        /// The packets.
        packets: Vec<Bytes>,
    }

    impl Bench {
        fn new(scenario: &str) -> Self {
            let scenario = Scenario::parse("s.txt", scenario).unwrap();
            let world = World::new(&WorldConfig { scenario, ..WorldConfig::default() });
            let (heard, packets) = (Vec::new(), Vec::new());
            let mut bench = Self { world, now: Duration::ZERO, sequence: 0, heard, packets };
            bench.world.send_wake_up(Duration::ZERO, &[1, 0, 0, 0]);
            bench.send(&Command::Config(Config::new("general:navdata_demo", "TRUE").unwrap()));
            bench
        }

        fn send(&mut self, command: &Command) {
            self.sequence += 1;
            let mut datagram = Datagram::new();
            datagram.push(self.sequence, command).unwrap();
            self.world.send_at(self.now, datagram.as_bytes());
        }

        fn fly(&mut self, reference: Ref, seconds: u32) {
            let end = self.now + Duration::from_secs(1) * seconds;
            while self.now < end {
                self.send(&Command::Ref(reference));
                self.send(&Command::Pcmd(Motion::Hover));
                self.now += TICK;
                self.world.advance(self.now);
                while let Some(message) = self.world.receive(self.now) {
                    if let Message::Navdata(packet) = message {
                        self.heard.push((self.now, Navdata::decode(&packet).unwrap().sequence));
                        self.packets.push(packet);
                    }
                }
            }
        }

        fn heard_between(&self, from_s: f64, to_s: f64) -> usize {
            let is_between = |at: f64| (from_s..to_s).contains(&at);
            self.heard.iter().filter(|(at, _)| is_between(at.as_secs_f64())).count()
        }
    }

    #[test]
    fn an_outage_may_concern_one_direction() {
        let mut deaf = Bench::new("8 outage up 8");
        deaf.fly(Ref::TakeOff, 15);
        assert_eq!(deaf.world.truth().phase, Phase::Landed, "the drone has received nothing");
        assert!(deaf.heard_between(8.1, 9.9) > 20, "but kept sending");
        let mut dumb = Bench::new("8 outage down 6");
        dumb.fly(Ref::TakeOff, 15);
        assert_eq!(dumb.world.truth().phase, Phase::Flying);
        assert_eq!(dumb.heard_between(8.1, 14.0), 0);
        assert!(dumb.heard_between(14.0, 15.0) > 10);
    }

    #[test]
    fn what_is_held_comes_in_a_heap_and_old_packets_come_again() {
        let mut bench = Bench::new("3 hold down 1\n6 burst 20");
        bench.fly(Ref::Land, 8);
        assert_eq!(bench.heard_between(3.05, 4.0), 0);
        assert!(bench.heard_between(4.0, 4.05) > 12);
        let again = bench.heard.windows(2).filter(|pair| pair[1].1 <= pair[0].1).count();
        assert_eq!(again, 1, "a burst of old ones");
        assert!(bench.heard_between(5.95, 6.05) >= 20);
    }

    #[test]
    fn a_second_pilot_keeps_the_drone_in_the_air() {
        let mut bench = Bench::new("6 second-pilot 8 from 5000");
        bench.fly(Ref::TakeOff, 7);
        bench.fly(Ref::Land, 5);
        assert_eq!(bench.world.truth().phase, Phase::Flying, "its numbers are higher");
        bench.fly(Ref::Land, 14);
        assert_eq!(bench.world.truth().phase, Phase::Landed, "it has gone");
    }

    #[test]
    fn the_last_fault_of_the_video_counts_until_it_ends() {
        let mut bench = Bench::new("1 video garbage for 5\n2 video cut for 2\n2 video lie for 1");
        let mut faults = Vec::new();
        for _ in 0..7 {
            faults.push(bench.world.video_fault());
            bench.fly(Ref::Land, 1);
        }
        let [garbage, cut, lie] = [VideoFault::Garbage, VideoFault::Cut, VideoFault::Lie].map(Some);
        assert_eq!(faults, [None, garbage, lie, cut, garbage, garbage, None]);
    }

    #[test]
    fn a_frozen_drone_tells_the_same_with_a_running_clock() {
        let mut bench = Bench::new("+6 freeze 2\n+6 stuck clock for 1");
        bench.fly(Ref::TakeOff, 10);
        assert_eq!(bench.world.truth().phase, Phase::Flying);
        assert!(bench.heard_between(6.0, 8.0) > 25, "packets keep coming");
    }

    /// Another drone in the air, right, forward and up of the start.
    fn other(position_m: [f64; 3], rotors_turn: bool, ultrasound: i64) -> Presence {
        Presence { position_m: position_m.into(), rotors_turn, ultrasound }
    }

    #[test]
    fn others_that_are_not_felt_and_not_heard_change_nothing_bit_for_bit() {
        let flown = |others: &[Presence]| {
            let mut bench = Bench::new("");
            for (reference, seconds) in [(Ref::TakeOff, 8), (Ref::Land, 5)] {
                bench.world.meet(others.iter().copied());
                bench.fly(reference, seconds);
            }
            (bench.world.truth(), bench.packets)
        };
        let alone = flown(&[]);
        for others in [
            // Beside, and turning; its frequency differs.
            [other([1.2, 0.0, 1.5], true, 7)],
            // Above, at rest.
            [other([0.0, 0.0, 2.0], false, 7)],
            // Right below while it turns.
            [other([0.0, 0.0, -0.1], true, 7)],
            // Far away, with the same frequency.
            [other([0.0, 3.2, 0.0], true, 8)],
        ] {
            assert!(flown(&others) == alone, "{others:?}");
        }
        for others in [[other([0.0, 0.0, 2.0], true, 7)], [other([0.0, 2.0, 0.0], true, 8)]] {
            assert!(flown(&others) != alone, "{others:?}");
            assert!(flown(&others) == flown(&others), "the same again");
        }
    }

    #[test]
    fn a_drone_under_another_sinks_and_comes_back_when_that_has_gone() {
        let mut bench = Bench::new("");
        bench.fly(Ref::TakeOff, 7);
        let height_m = |bench: &Bench| bench.world.truth().position_m.z;
        let before_m = height_m(&bench);
        bench.world.meet([other([0.0, 0.0, 2.35], true, 7)]);
        bench.fly(Ref::TakeOff, 6);
        let lost_m = before_m - height_m(&bench);
        assert!((0.2..0.7).contains(&lost_m), "{lost_m}");
        bench.world.meet([]);
        bench.fly(Ref::TakeOff, 6);
        assert!((height_m(&bench) - before_m).abs() < 0.05, "{}", height_m(&bench));
    }

    #[test]
    fn each_world_tells_its_drone_where_the_others_are_from_its_own_start() {
        let start = Standing { place_m: nalgebra::Vector2::new(4.0, 0.0), heading_deg: 90.0 };
        let mut world = World::new(&WorldConfig { start, ..WorldConfig::default() });
        let presence = world.presence();
        assert_eq!(presence, other([4.0, 0.0, 0.0], false, 8));
        let setting = Command::Config(Config::new("pic:ultrasound_freq", "7").unwrap());
        let mut datagram = Datagram::new();
        datagram.push(1, &setting).unwrap();
        world.send_at(Duration::ZERO, datagram.as_bytes());
        world.advance(Duration::from_millis(10));
        assert_eq!(world.presence().ultrasound, 7);
    }
}
