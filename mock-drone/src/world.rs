//! A drone and the air around it: links with faults, and a scenario that changes them over time.
//!
//! Pure like the drone itself: whoever drives it, a server or a simulation, gets the same.

use std::time::Duration;

use bytes::Bytes;

use crate::drone::{Drone, DroneConfig, Lie, Truth};
use crate::firmware::Phase;
use crate::link::{Link, LinkFaults};
use crate::scenario::{Action, Scenario};

/// A world to fly in.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct WorldConfig {
    /// The drone.
    pub drone: DroneConfig,
    /// What the air does in both directions from the start.
    pub link: LinkFaults,
    /// What happens over time.
    pub scenario: Scenario,
}

/// What comes back from the drone.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Message {
    /// A datagram of the navdata port, for whoever woke it last.
    Navdata(Bytes),
    /// Text for the control port.
    Control(String),
}

/// Where a datagram goes.
#[derive(Debug, Clone, Copy)]
enum Port {
    At,
    Navdata,
}

/// A world with one drone in it.
#[derive(Debug, Clone)]
pub struct World {
    drone: Drone,
    up: Link<Port>,
    down: Link<()>,
    scenario: Scenario,
    take_off: Option<Duration>,
    outage_ends: Option<Duration>,
    freeze_ends: Option<Duration>,
    lie_ends: Option<Duration>,
    control: Option<String>,
}

impl World {
    /// A world in which nothing has happened yet.
    pub fn new(config: &WorldConfig) -> Self {
        let seed = config.drone.seed;
        Self {
            drone: Drone::new(&config.drone),
            up: Link::new(config.link, seed).dropping_spoiled(),
            down: Link::new(config.link, seed.wrapping_add(1)),
            scenario: config.scenario.clone(),
            take_off: None,
            outage_ends: None,
            freeze_ends: None,
            lie_ends: None,
            control: None,
        }
    }

    /// A datagram sets out for the drone's AT port.
    pub fn send_at(&mut self, now: Duration, datagram: &[u8]) {
        self.advance(now);
        self.up.send(now, Port::At, Bytes::copy_from_slice(datagram));
    }

    /// A datagram sets out for the drone's navdata port.
    pub fn send_wake_up(&mut self, now: Duration, datagram: &[u8]) {
        self.advance(now);
        self.up.send(now, Port::Navdata, Bytes::copy_from_slice(datagram));
    }

    /// Lives on until `now`.
    pub fn advance(&mut self, now: Duration) {
        loop {
            let next = [
                self.up.next_due(),
                self.scenario.next_due(self.take_off),
                self.outage_ends,
                self.freeze_ends,
                self.lie_ends,
            ];
            let next = next.into_iter().flatten().min().filter(|next| *next <= now);
            let Some(time) = next.map(|next| next.max(self.drone.time())) else { break };
            self.live(time);
            self.change(time);
            while let Some((_, port, datagram)) = self.up.receive(time) {
                match port {
                    Port::At => {
                        for error in self.drone.handle_at(time, &datagram) {
                            tracing::debug!("{error}");
                        }
                    }
                    Port::Navdata => self.drone.handle_wake_up(time),
                }
            }
        }
        self.live(now);
    }

    /// What has arrived at the pilot by now.
    pub fn receive(&mut self, now: Duration) -> Option<Message> {
        let navdata = self.down.receive(now).map(|(_, (), datagram)| Message::Navdata(datagram));
        navdata.or_else(|| self.control.take().map(Message::Control))
    }

    /// What really happens.
    pub fn truth(&self) -> Truth {
        self.drone.truth()
    }

    /// The drone.
    pub fn drone(&self) -> &Drone {
        &self.drone
    }

    fn live(&mut self, now: Duration) {
        self.drone.advance(now);
        if matches!(self.drone.truth().phase, Phase::TakingOff { .. }) {
            self.take_off.get_or_insert(now);
        }
        while let Some(packet) = self.drone.poll_navdata() {
            self.down.send(now, (), packet);
        }
        // TCP repeats what is lost.
        if !self.down.out
            && let Some(dump) = self.drone.poll_control()
        {
            self.control = Some(dump);
        }
    }

    /// Ends what is over, begins what is due.
    fn change(&mut self, now: Duration) {
        let over = |end: &mut Duration| *end <= now;
        if self.outage_ends.take_if(over).is_some() {
            self.set_out(false);
        }
        if self.freeze_ends.take_if(over).is_some() {
            self.drone.set_frozen(false);
        }
        if self.lie_ends.take_if(over).is_some() {
            self.drone.set_lie(Lie::default());
        }
        for action in self.scenario.due(now, self.take_off) {
            tracing::info!("{action:?}");
            self.act(now, action);
        }
    }

    fn act(&mut self, now: Duration, action: Action) {
        match action {
            Action::Loss(share) => self.faults(|faults| faults.loss = share),
            Action::Delay(delay, jitter) => {
                self.faults(|faults| (faults.delay, faults.jitter) = (delay, jitter));
            }
            Action::Duplication(share) => self.faults(|faults| faults.duplication = share),
            Action::Reordering(share) => self.faults(|faults| faults.reordering = share),
            Action::Corruption(share) => self.faults(|faults| faults.corruption = share),
            Action::Outage(time) => {
                self.set_out(true);
                self.outage_ends = Some(now + time);
            }
            Action::Restart => self.drone.restart(now),
            Action::Propeller => self.drone.block_propeller(),
            Action::Freeze(time) => {
                self.drone.set_frozen(true);
                self.freeze_ends = Some(now + time);
            }
            Action::Lie(lie, time) => {
                self.drone.set_lie(lie);
                self.lie_ends = Some(now + time);
            }
            Action::Wind(steady_m_s, gusts_m_s) => self.drone.set_wind(steady_m_s, gusts_m_s),
            Action::Battery(percent) => self.drone.set_battery_percent(percent),
        }
    }

    fn faults(&mut self, change: impl Fn(&mut LinkFaults)) {
        change(&mut self.up.faults);
        change(&mut self.down.faults);
    }

    fn set_out(&mut self, out: bool) {
        self.up.out = out;
        self.down.out = out;
    }
}
