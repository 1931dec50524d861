//! Drives a vehicle: passes on what arrives, ticks, sends, and shows all that passes to a tee.
//!
//! It is the same over UDP in real time ([`flight`](crate::flight)) and with a simulated drone: only the
//! [`Surroundings`] differ.

use std::collections::VecDeque;
use std::time::Duration;

use ardrone_link::WAKE_UP;
use autopilot::Vehicle;
use autopilot::vehicle::{
    Input, Operator, OperatorOrder, Output, Refused, Stage, TICK, Telemetry, Transmit,
};
use mission_agent::{Line, MissionAgent, Misunderstood, Said};
use mock_drone::{Message, Presence, World, WorldConfig};

/// Lines of other agents that are taken in a tick; further ones wait.
const LINES_PER_TICK: usize = 32;

/// What a vehicle is connected to, with its clock.
pub trait Surroundings {
    /// Time since the beginning.
    fn now(&self) -> Duration;

    /// Lets time pass: at most until then, and no longer than until something has arrived.
    fn wait(&mut self, until: Duration);

    /// A tick begins that was due at `deadline`, after others that were missed.
    fn begin_tick(&mut self, now: Duration, deadline: Duration, missed: u64) {
        _ = (now, deadline, missed);
    }

    /// Passes on what has arrived: before a tick, or else until `until`.
    fn receive(&mut self, now: Duration, until: Option<Duration>, take: impl Take);

    /// A stage of the tick has ended.
    fn done(&mut self, stage: Stage) {
        _ = stage;
    }

    /// Sends something to the drone.
    fn send(&mut self, now: Duration, transmit: Transmit<'_>);

    /// Something that the agent of another vehicle has said.
    fn hear(&mut self) -> Option<Heard> {
        None
    }

    /// The agent says something to that of another vehicle.
    ///
    /// # Errors
    /// [`NoRoom`] if it is lost here.
    fn say(&mut self, said: Said) -> Result<(), NoRoom> {
        _ = said;
        Ok(())
    }
}

/// A line that is said to a vehicle's agent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Heard {
    /// It.
    pub line: Line,
    /// Whether a program elsewhere flies the vehicle whose agent says it: nobody here has shown it.
    pub is_far: bool,
}

/// Where there is no room for what an agent says, so that it is lost.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum NoRoom {
    /// It says more in one step than is taken.
    #[error("it says more in one step than is taken")]
    Step,
    /// Too many wait for the agent to which it is said.
    #[error("too many wait for the agent of the other vehicle already")]
    Mailbox,
    /// Too many wait for the network.
    #[error("too many wait for the network already")]
    Network,
}

impl NoRoom {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Step, Self::Mailbox, Self::Network];
}

/// Takes an input; refuses as [`Vehicle::handle`].
pub trait Take: FnMut(Duration, Input<'_>) -> Result<(), Refused> {}

impl<F: FnMut(Duration, Input<'_>) -> Result<(), Refused>> Take for F {}

/// What passes a vehicle, as a recording contains it.
#[derive(Debug)]
#[allow(clippy::large_enum_variant, reason = "a box would be asked for in flight")]
pub enum Passed<'a> {
    /// An input, and whether it was accepted.
    Input(Input<'a>, bool),
    /// A datagram was sent to the drone.
    Sent {
        /// It.
        transmit: Transmit<'a>,
        /// Delay of its tick after the deadline.
        late: Duration,
        /// Time from the begin of the tick until it was sent.
        work: Duration,
    },
    /// The vehicle tells something.
    Told(Telemetry),
    /// Its agent says something to that of another vehicle.
    Said(Said),
    /// Something that was said to its agent, whether it understands it or not.
    Heard(Heard),
    /// So many lines that its agent says are lost.
    Unsaid(NoRoom, u64),
    /// Something that was said to its agent is not understood.
    Misunderstood(Misunderstood),
}

/// A vehicle and what it is connected to.
#[derive(Debug)]
pub struct Driver<S> {
    /// The vehicle.
    pub vehicle: Vehicle,
    /// What it is connected to.
    pub surroundings: S,
    /// What gives its orders in place of a plan.
    pub agent: Option<MissionAgent>,
    /// When the next tick is due.
    deadline: Duration,
}

impl<S: Surroundings> Driver<S> {
    /// A driver at time zero.
    pub fn over(vehicle: Vehicle, surroundings: S) -> Self {
        Self { vehicle, surroundings, agent: None, deadline: Duration::ZERO }
    }

    /// Time since the beginning.
    pub fn now(&self) -> Duration {
        self.surroundings.now()
    }

    /// Handles what has arrived by now, and ticks if a tick is due; returns whether it was. A missed deadline is skipped,
    /// never caught up, because the drone needs only the newest command.
    pub fn step(&mut self, mut tee: impl FnMut(Duration, Passed<'_>)) -> bool {
        let now = self.surroundings.now();
        if now < self.deadline {
            self.receive(now, Some(self.deadline), &mut tee);
            return false;
        }
        let missed = self.skip_missed(now);
        let late = now.saturating_sub(self.deadline);
        self.surroundings.begin_tick(now, self.deadline, missed);
        self.deadline += TICK;
        self.receive(now, None, &mut tee);
        self.tick(now, late, &mut tee);
        self.deliberate(&mut tee);
        true
    }

    /// One step of the agent. What it orders takes effect in the next tick, as any order that arrives after this one.
    fn deliberate(&mut self, tee: &mut impl FnMut(Duration, Passed<'_>)) {
        let Self { vehicle, surroundings, agent: Some(agent), .. } = self else { return };
        let now = surroundings.now();
        let unsaid = agent.unsaid();
        for _ in 0..LINES_PER_TICK {
            let Some(heard) = surroundings.hear() else { break };
            tee(now, Passed::Heard(heard));
            if let Err(problem) = agent.hear(now, &heard.line) {
                tee(now, Passed::Misunderstood(problem));
            }
        }
        for order in agent.step(now, vehicle) {
            let order = Input::Order(Operator::AGENT, order);
            if let Err(refused) = handle(vehicle, now, order, &mut *tee) {
                agent.refused(now, &refused);
                break;
            }
        }
        for said in agent.take_said() {
            tee(now, Passed::Said(said));
            if let Err(no_room) = surroundings.say(said) {
                tee(now, Passed::Unsaid(no_room, 1));
            }
        }
        let lost = agent.unsaid().saturating_sub(unsaid);
        if lost > 0 {
            tee(now, Passed::Unsaid(NoRoom::Step, lost));
        }
    }

    fn receive(
        &mut self,
        now: Duration,
        until: Option<Duration>,
        tee: &mut impl FnMut(Duration, Passed<'_>),
    ) {
        let vehicle = &mut self.vehicle;
        self.surroundings.receive(now, until, |now, input| handle(vehicle, now, input, &mut *tee));
    }

    fn tick(&mut self, begun: Duration, late: Duration, mut tee: impl FnMut(Duration, Passed<'_>)) {
        let now = self.surroundings.now();
        let surroundings = &mut self.surroundings;
        // A tick is never refused.
        _ = self.vehicle.handle_timed(now, Input::Tick, |stage| surroundings.done(stage));
        while let Some(output) = self.vehicle.poll() {
            tee(
                now,
                match output {
                    Output::Transmit(transmit) => {
                        surroundings.send(now, transmit);
                        let work = surroundings.now().saturating_sub(begun);
                        Passed::Sent { transmit, late, work }
                    }
                    Output::Telemetry(telemetry) => Passed::Told(telemetry),
                },
            );
        }
    }

    /// Lets time pass until the next tick is due, or something has arrived.
    pub fn pass(&mut self) {
        self.surroundings.wait(self.deadline);
    }

    /// Gives an operator's order.
    ///
    /// # Errors
    /// [`Refused`] if the vehicle refuses it.
    pub fn order(&mut self, by: Operator, order: OperatorOrder) -> Result<(), Refused> {
        self.handle(Input::Order(by, order), |_, _| {})
    }

    /// Passes on an input that does not come from the surroundings.
    ///
    /// # Errors
    /// As [`Vehicle::handle`].
    pub fn handle(
        &mut self,
        input: Input<'_>,
        tee: impl FnMut(Duration, Passed<'_>),
    ) -> Result<(), Refused> {
        let now = self.now();
        handle(&mut self.vehicle, now, input, tee)
    }

    /// When the next tick is due, which is taken to be done then.
    pub(crate) fn next_tick(&mut self) -> Duration {
        self.skip_missed(self.now());
        let deadline = self.deadline;
        self.deadline += TICK;
        deadline
    }

    /// Moves the deadline to the last one that has passed; returns the number missed before it.
    fn skip_missed(&mut self, now: Duration) -> u64 {
        let mut missed = 0;
        while self.deadline + TICK <= now {
            self.deadline += TICK;
            missed += 1;
        }
        missed
    }
}

/// Passes an input to a vehicle, and to the tee with whether it was accepted.
pub(crate) fn handle(
    vehicle: &mut Vehicle,
    now: Duration,
    input: Input<'_>,
    mut tee: impl FnMut(Duration, Passed<'_>),
) -> Result<(), Refused> {
    let handled = vehicle.handle(now, input.clone());
    tee(now, Passed::Input(input, handled.is_ok()));
    handled
}

/// Brings simulated drones into one air, at one time: each is told where all others are.
pub fn share_air<'a>(drivers: impl IntoIterator<Item = &'a mut Driver<Simulated>>) {
    let mut drivers: Vec<_> = drivers.into_iter().collect();
    let present: Vec<Presence> = drivers.iter().map(|driver| driver.world().presence()).collect();
    for (number, driver) in drivers.iter_mut().enumerate() {
        let others = present.iter().enumerate().filter(|(other, _)| *other != number);
        driver.meet(others.map(|(_, other)| *other));
    }
}

/// Takes what the agents of simulated vehicles have said to those whose vehicles are called so; what is said to nobody is lost.
pub fn deliver<'a>(drivers: impl IntoIterator<Item = &'a mut Driver<Simulated>>) {
    let mut drivers: Vec<_> = drivers.into_iter().collect();
    let said = drivers.iter_mut().flat_map(|driver| std::mem::take(&mut driver.surroundings.said));
    for Said { to, line } in said.collect::<Vec<_>>() {
        if let Some(driver) = drivers.iter_mut().find(|driver| driver.vehicle.name().as_str() == to)
        {
            driver.surroundings.heard.push_back(line);
        }
    }
}

/// Interval of handling navdata in simulated time; the drone's own steps are finer.
pub const POLL: Duration = Duration::from_millis(5);

/// A simulated drone and the air around it, in simulated time.
#[derive(Debug)]
pub struct Simulated {
    /// The drone and the air around it.
    pub world: World,
    /// What its agent has said, until it is taken to the others.
    pub said: Vec<Said>,
    /// What others have said to its agent.
    pub heard: VecDeque<Line>,
    now: Duration,
}

/// What arrives from a simulated drone, for the vehicle.
pub fn input(message: &Message) -> Input<'_> {
    match message {
        Message::Navdata(packet) => Input::Navdata(packet),
        Message::Control(dump) => Input::Control(dump.as_bytes()),
    }
}

impl Surroundings for Simulated {
    fn now(&self) -> Duration {
        self.now
    }

    fn wait(&mut self, _until: Duration) {
        self.now += POLL;
    }

    fn receive(&mut self, now: Duration, _until: Option<Duration>, mut take: impl Take) {
        self.world.advance(now);
        while let Some(message) = self.world.receive(now) {
            // What is damaged is only counted.
            _ = take(now, input(&message));
        }
    }

    fn send(&mut self, now: Duration, transmit: Transmit<'_>) {
        match transmit {
            Transmit::Command { datagram, .. } => self.world.send_at(now, datagram),
            Transmit::WakeUp => self.world.send_wake_up(now, &WAKE_UP),
        }
    }

    fn hear(&mut self) -> Option<Heard> {
        self.heard.pop_front().map(|line| Heard { line, is_far: false })
    }

    fn say(&mut self, said: Said) -> Result<(), NoRoom> {
        self.said.push(said);
        Ok(())
    }
}

impl Simulated {
    /// A simulated drone at time zero.
    pub fn new(world: World) -> Self {
        Self { world, said: Vec::new(), heard: VecDeque::new(), now: Duration::ZERO }
    }
}

impl Driver<Simulated> {
    /// A vehicle with a simulated drone.
    pub fn new(vehicle: Vehicle, world: &WorldConfig) -> Self {
        Self::over(vehicle, Simulated::new(World::new(world)))
    }

    /// The drone and the air around it.
    pub fn world(&self) -> &World {
        &self.surroundings.world
    }

    /// Tells the drone of all others in its air.
    pub fn meet(&mut self, others: impl IntoIterator<Item = Presence>) {
        self.surroundings.world.meet(others);
    }

    /// Simulates a program that does not run: the world advances, and input is queued. Returns whether a tick
    /// was missed.
    pub fn stall(&mut self) -> bool {
        let now = self.now();
        self.surroundings.world.advance(now);
        let is_due = now >= self.deadline;
        if is_due {
            self.deadline += TICK;
        }
        is_due
    }
}

#[cfg(test)]
mod tests {
    use autopilot::vehicle::VehicleConfig;

    use super::*;

    #[test]
    fn missed_deadlines_are_counted_and_skipped() {
        let ms = Duration::from_millis;
        let vehicle = Vehicle::new(&VehicleConfig::default()).unwrap();
        let mut driver = Driver::new(vehicle, &WorldConfig::default());
        driver.deadline = ms(30);
        assert_eq!(driver.skip_missed(ms(59)), 0);
        assert_eq!(driver.deadline, ms(30));
        assert_eq!(driver.skip_missed(ms(125)), 3);
        assert_eq!(driver.deadline, ms(120));
    }
}
