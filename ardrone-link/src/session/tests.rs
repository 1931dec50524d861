mod configuration;
mod flight;
mod sequence;
mod silence;

use bytes::BytesMut;

use super::silence::{HELD_UP, UNHEARD};
use super::*;
use crate::at::{Command, Config, ControlMode, Fraction, Identity, Motion, Ref, decode};
use crate::configuration::Configuration;
use crate::navdata::{Demo, NavdataOption, PacketWriter};
use crate::settings::{NavdataMode, Setting, SettingError};

const TICK: Duration = Duration::from_millis(30);

/// A session with its simulated time.
struct Bench {
    session: Session,
    now: Duration,
    /// Events that were polled with other outputs.
    events: Vec<Event>,
}

impl Bench {
    fn new(keys: &[(&str, &str)]) -> Self {
        let settings = keys.iter().map(|(key, value)| Config::new(*key, value).unwrap()).collect();
        Self::with(SessionConfig { settings, ..SessionConfig::default() })
    }

    fn reading_back() -> Self {
        Self::with(SessionConfig { read_back: true, ..SessionConfig::default() })
    }

    fn with(config: SessionConfig) -> Self {
        Self { session: Session::new(config), now: Duration::ZERO, events: Vec::new() }
    }

    /// What is to be sent after an input: the commands of the datagram, with their numbers, and whether a
    /// wake-up follows. Events are kept.
    fn handle(&mut self, input: Input<'_>) -> (Vec<(u32, Command)>, bool) {
        self.session.handle(self.now, input);
        let (mut commands, mut wake_up) = (Vec::new(), false);
        while let Some(output) = self.session.poll() {
            match output {
                Output::Transmit(Transmit::Command(datagram)) => {
                    assert_ne!(datagram, b"", "an empty datagram is none");
                    commands = decode(datagram).map(Result::unwrap).collect();
                }
                Output::Transmit(Transmit::WakeUp) => wake_up = true,
                Output::Event(event) => self.events.push(event),
                Output::Navdata(_) | Output::Damaged(_) => {}
            }
        }
        (commands, wake_up)
    }

    fn request(&mut self, request: Request) {
        assert_eq!(self.handle(Input::Request(request)), (Vec::new(), false));
    }

    /// The next packet; returns whether it was accepted.
    fn hear(&mut self, sequence: u32, state: DroneState) -> bool {
        let control_state = if state.contains(DroneState::FLYING) {
            ControlState::Flying
        } else {
            ControlState::Landed
        };
        self.hear_in(sequence, state, control_state)
    }

    fn hear_in(&mut self, sequence: u32, state: DroneState, control_state: ControlState) -> bool {
        let demo = Demo { control_state, ..Demo::default() };
        let mut bytes = BytesMut::new();
        let mut packet = PacketWriter::new(&mut bytes, state, sequence, 0);
        packet.option(&NavdataOption::Demo(demo)).unwrap();
        packet.finish();
        let received = self.session.statistics().received;
        self.handle(Input::Navdata(&bytes));
        self.session.statistics().received > received
    }

    /// The first packets of a restarted drone, after the time that it takes to start.
    fn hear_restart(&mut self, first: u32) {
        self.now += UNHEARD;
        for sequence in first..first + 4 {
            self.hear(sequence, DroneState::NAVDATA_BOOTSTRAP);
            self.now += Duration::from_millis(66);
        }
    }

    /// Commands of one tick.
    fn tick(&mut self, flight: FlightOrder) -> Vec<Command> {
        self.now += TICK;
        let (commands, _) = self.handle(Input::Tick(Order { flight, motion: Motion::Hover }));
        commands.into_iter().map(|(_, command)| command).collect()
    }

    fn takes_off(&mut self, flight: FlightOrder) -> bool {
        self.tick(flight)[0] == Command::Ref(Ref::TakeOff)
    }

    fn events(&mut self) -> Vec<Event> {
        std::mem::take(&mut self.events)
    }
}

/// Sequence numbers of one tick's commands.
fn numbers(bench: &mut Bench) -> Vec<u32> {
    bench.now += TICK;
    let (commands, _) = bench.handle(Input::Tick(Order::LAND));
    commands.into_iter().map(|(number, _)| number).collect()
}
