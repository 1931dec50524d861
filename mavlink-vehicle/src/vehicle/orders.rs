//! Orders to the vehicle, their answers, and who has the controls.

use std::time::Duration;

use autopilot::plan::{Command, Commands};
use autopilot::vehicle::{Operator, OperatorOrder, Refused, Station as Kind};
use kinematics::Pose;

use super::following::Source;
use super::modes::Purpose;
use super::stations::Station;
use super::{MavlinkVehicle, ORDERS, Ticket, To};
use crate::dialect::{COMMAND_ACK_DATA, MavMessage, MavResult, MavSeverity};
use crate::mission::{SHORT_STAY_S, Step, TAKE_OFF, short, short_pose};

/// A command is answered after this time even if the vehicle has not answered.
const ANSWER_TIME: Duration = Duration::from_millis(300);

/// What follows an order that was accepted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum After {
    Nothing,
    /// The vehicle is armed.
    Armed,
    /// The setpoints or sticks of this operator are followed.
    Follows(Source),
}

/// Orders that were given and not yet answered.
#[derive(Debug, Clone, Copy)]
pub(super) struct Awaited {
    ticket: Ticket,
    /// Answers that are missing.
    left: u8,
    result: MavResult,
    /// The command to acknowledge.
    command: Option<u16>,
    station: Station,
    since: Duration,
    after: After,
    /// "Being flown already" is no refusal: it goes on by itself.
    may_fly: bool,
}

impl MavlinkVehicle {
    /// Acknowledges a command; nothing if there was none.
    pub(super) fn acknowledge(
        &mut self,
        station: Station,
        command: impl Into<Option<u16>>,
        result: MavResult,
    ) {
        let Some(command) = command.into() else { return };
        let acknowledgement = COMMAND_ACK_DATA {
            command,
            result,
            target_system: station.system,
            target_component: station.component,
            ..COMMAND_ACK_DATA::default()
        };
        self.send(To::Peer(station.peer), MavMessage::COMMAND_ACK(acknowledgement));
    }

    /// Gives one order without anybody waiting for the answer.
    pub(super) fn order_quietly(&mut self, by: Operator, order: OperatorOrder) {
        if self.orders.len() < ORDERS {
            let ticket = self.ticket();
            self.orders.push_back((ticket, by, order));
        }
    }

    fn ticket(&mut self) -> Ticket {
        self.next_ticket = self.next_ticket.wrapping_add(1);
        Ticket(self.next_ticket)
    }

    /// Gives orders; `command` is acknowledged once all are answered.
    pub(super) fn order(
        &mut self,
        now: Duration,
        station: Station,
        command: Option<u16>,
        after: After,
        orders: impl IntoIterator<Item = OperatorOrder>,
    ) {
        // The controls of a station that has been silent for some time go to one that gives an order.
        if let Some(holder) = self.holder().filter(|holder| *holder != station.operator())
            && self.stations.is_gone(now, holder)
        {
            self.order_quietly(holder, OperatorOrder::Release);
        }
        self.stations.orders(station);
        let ticket = self.ticket();
        let mut left = 0;
        let mut may_fly = false;
        for order in orders {
            if self.orders.len() >= ORDERS || self.awaited.is_full() {
                break;
            }
            may_fly |= left > 0 && matches!(order, OperatorOrder::Start { .. });
            self.orders.push_back((ticket, station.operator(), order));
            left += 1;
        }
        if left == 0 {
            let busy = MavResult::MAV_RESULT_TEMPORARILY_REJECTED;
            return self.acknowledge(station, command, busy);
        }
        self.awaited.push(Awaited {
            ticket,
            left,
            result: MavResult::MAV_RESULT_ACCEPTED,
            command,
            station,
            since: now,
            after,
            may_fly,
        });
    }

    /// Whether somebody else has the controls, and is there.
    pub(super) fn is_others(&self, station: Station) -> bool {
        let Some((at, _)) = &self.status else { return false };
        let other = self.holder().filter(|holder| *holder != station.operator());
        other.is_some_and(|holder| !self.stations.is_gone(*at, holder))
    }

    pub(super) fn take_answer(
        &mut self,
        now: Duration,
        ticket: Ticket,
        answer: &Result<(), Refused>,
    ) {
        let of_it = |awaited: &&mut Awaited| awaited.ticket == ticket;
        let Some(awaited) = self.awaited.iter_mut().find(of_it) else { return };
        awaited.left = awaited.left.saturating_sub(1);
        if let Err(refused) = answer
            && !(awaited.may_fly && *refused == Refused::Flying)
        {
            if awaited.result == MavResult::MAV_RESULT_ACCEPTED {
                let error = MavSeverity::MAV_SEVERITY_ERROR;
                self.texts.say(error, format_args!("refused: {refused}"));
            }
            awaited.result = result_of(refused);
        }
        let done = *awaited;
        if done.left == 0 {
            self.awaited.retain(|awaited| awaited.ticket != ticket);
            self.answered(now, &done);
        }
    }

    fn answered(&mut self, now: Duration, awaited: &Awaited) {
        self.acknowledge(awaited.station, awaited.command, awaited.result);
        if awaited.result != MavResult::MAV_RESULT_ACCEPTED {
            self.arming.not_begun();
            return;
        }
        let by = awaited.station.operator();
        match awaited.after {
            After::Nothing => self.following.follow(None),
            After::Follows(source) => self.following.follow(Some((source, by))),
            After::Armed => self.armed_by(now, by),
        }
    }

    pub(super) fn take_off(
        &mut self,
        now: Duration,
        station: Station,
        command: Option<u16>,
        height_m: Option<f64>,
    ) {
        let climb = height_m.map(|z_m| to(Pose { z_m, ..Pose::default() }));
        let commands = [Command::SetReferenceStart, TAKE_OFF].into_iter();
        let commands = commands.chain(climb.into_iter().flatten());
        self.hand_over(now, station, command, Purpose::TakeOff, of_no_item(commands));
    }

    /// Flies to the start and lands.
    pub(super) fn fly_home(&mut self, now: Duration, station: Station, command: u16) {
        let limits = &self.config.limits;
        let pose = self.present().and_then(|status| status.pose).unwrap_or_default();
        let z_m = pose.z_m.clamp(limits.floor_m, limits.ceiling_m);
        let speed_m_s = short(self.parameters.value(super::parameters::CRUISE_SPEED));
        let commands = [Command::SetReferenceStart, Command::SetSpeed { speed_m_s }].into_iter();
        let home = to(Pose { z_m, yaw_deg: pose.yaw_deg, ..Pose::default() });
        let commands = commands.chain(home).chain([Command::Land]);
        self.hand_over(now, station, Some(command), Purpose::Return, of_no_item(commands));
    }

    /// Flies the stored mission, from where it is to begin.
    pub(super) fn fly_mission(&mut self, now: Duration, station: Station, command: Option<u16>) {
        let first = self.flown.first_item();
        let steps = self.transfer.translated().steps_from(first, self.is_airborne());
        if steps.is_empty() {
            self.arming.not_begun();
            self.error(format_args!("there is no mission, or nothing is left of it"));
            return self.acknowledge(station, command, MavResult::MAV_RESULT_DENIED);
        }
        // The next time it begins with its first item again.
        self.flown.begin_at(0);
        self.hand_over(now, station, command, Purpose::Mission, steps);
    }

    /// Hands a mission to the vehicle, which flies it at once.
    fn hand_over(
        &mut self,
        now: Duration,
        station: Station,
        command: Option<u16>,
        purpose: Purpose,
        steps: Vec<Step>,
    ) {
        if self.is_others(station) {
            // What is known of the mission that flies must not change by an order that will be refused.
            let refused = MavResult::MAV_RESULT_TEMPORARILY_REJECTED;
            return self.acknowledge(station, command, refused);
        }
        let airborne = self.is_airborne();
        // On the ground it replaces another mission as a whole; in the air that is cleared first, so that its step ends.
        let commands = steps.iter().map(|step| step.command);
        let commands = match Commands::new("MAVLink", self.flown.next_id(), !airborne, commands) {
            Ok(commands) => commands,
            Err(error) => {
                self.arming.not_begun();
                self.error(format_args!("{error}"));
                return self.acknowledge(station, command, MavResult::MAV_RESULT_DENIED);
            }
        };
        self.flown.hand(purpose, steps, self.transfer.id());
        let clear = airborne.then_some(OperatorOrder::Clear);
        let rest = [OperatorOrder::Append(commands), OperatorOrder::Start { when_ready: false }];
        self.order(now, station, command, After::Nothing, clear.into_iter().chain(rest));
    }

    pub(super) fn watch_orders(&mut self, now: Duration) {
        let old = |awaited: &Awaited| now.saturating_sub(awaited.since) >= ANSWER_TIME;
        while let Some(index) = self.awaited.iter().position(old) {
            let late = self.awaited.swap_remove(index);
            let busy = MavResult::MAV_RESULT_TEMPORARILY_REJECTED;
            self.acknowledge(late.station, late.command, busy);
        }
    }

    /// Tells the vehicle of the station that has the controls, or else of the one that ordered last, while that is heard, and
    /// lets go of the controls on the ground if it is not.
    pub(super) fn watch_stations(&mut self, now: Duration) {
        let holder = self.holder().filter(|holder| holder.station == Kind::Mavlink);
        let ordered = self.stations.ordered().filter(|_| self.is_flying());
        let Some(watched) = holder.or(ordered) else { return };
        if self.stations.tells_presence(now, watched) {
            self.order_quietly(watched, OperatorOrder::Present);
        }
        if holder.is_some_and(|holder| self.stations.is_gone(now, holder)) && !self.is_armed() {
            self.release();
        }
    }
}

/// The way to a place relative to the start.
fn to(pose: Pose) -> [Command; 2] {
    [Command::SetStayTime { time_s: SHORT_STAY_S }, Command::GoTo(short_pose(&pose))]
}

/// Steps that belong to no item of the stored mission.
fn of_no_item(commands: impl Iterator<Item = Command>) -> Vec<Step> {
    commands.map(|command| Step { item: 0, command }).collect()
}

/// What a refusal by the vehicle is in `MAVLink`.
fn result_of(refused: &Refused) -> MavResult {
    match refused {
        Refused::Command(_) | Refused::NoPlace | Refused::NoMission | Refused::NeverTakesOff => {
            MavResult::MAV_RESULT_DENIED
        }
        _ => MavResult::MAV_RESULT_TEMPORARILY_REJECTED,
    }
}
