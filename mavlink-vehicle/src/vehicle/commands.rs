//! `COMMAND_LONG`, `COMMAND_INT` and changes of mode.

use std::time::Duration;

use autopilot::vehicle::OperatorOrder;

use super::arming::Then;
use super::following::Source;
use super::modes::{self, Mode};
use super::numbers::{MavCmdNumber, is_known};
use super::orders::After;
use super::stations::Station;
use super::{MavlinkVehicle, To};
use crate::dialect::{COMMAND_INT_DATA, COMMAND_LONG_DATA, MavMessage, MavResult};
use crate::place::ABSENT;

/// The number with which a disarming cuts the motors in flight.
const MAGIC_CUT: f32 = 21196.0;

/// A command of either kind.
#[derive(Debug, Clone, Copy)]
pub(super) struct Asked {
    pub(super) command: u16,
    /// The first four parameters; NaN means "as usual".
    p: [f32; 4],
    /// Fifth and sixth as integers of the frame.
    pub(super) x: i32,
    pub(super) y: i32,
    pub(super) z: f32,
    /// The frame; nothing in a `COMMAND_LONG`.
    pub(super) frame: Option<u8>,
}

impl Asked {
    pub(super) fn long(data: &COMMAND_LONG_DATA) -> Self {
        // Degrees as floats, of which nobody should expect much.
        #[allow(clippy::cast_possible_truncation, reason = "a cast saturates")]
        let degrees = |value: f32| {
            if value.is_finite() { (f64::from(value) * 1e7).round() as i32 } else { ABSENT }
        };
        Self {
            command: data.command,
            p: [data.param1, data.param2, data.param3, data.param4],
            x: degrees(data.param5),
            y: degrees(data.param6),
            z: data.param7,
            frame: None,
        }
    }

    pub(super) fn int(data: &COMMAND_INT_DATA) -> Self {
        Self {
            command: data.command,
            p: [data.param1, data.param2, data.param3, data.param4],
            x: data.x,
            y: data.y,
            z: data.z,
            frame: Some(data.frame),
        }
    }

    /// A parameter, from 1; nothing if it is not a number.
    pub(super) fn parameter(&self, number: usize) -> Option<f32> {
        self.p.get(number - 1).copied().filter(|value| value.is_finite())
    }

    /// A parameter that stands for a small number, exactly.
    fn number<T: TryFrom<i64>>(&self, number: usize) -> Option<T> {
        let value = self.parameter(number)?;
        #[allow(clippy::cast_possible_truncation, reason = "a cast saturates, and is compared")]
        let integer = value as i64;
        #[allow(clippy::float_cmp, reason = "exactly: half a mode is none")]
        let exact = integer as f32 == value;
        if exact { T::try_from(integer).ok() } else { None }
    }
}

/// How a command ends.
pub(super) enum End {
    /// At once.
    Now(MavResult),
    /// Once the vehicle has answered, or it was acknowledged already.
    Later,
}

const ACCEPTED: End = End::Now(MavResult::MAV_RESULT_ACCEPTED);
const DENIED: End = End::Now(MavResult::MAV_RESULT_DENIED);
const NOT_NOW: End = End::Now(MavResult::MAV_RESULT_TEMPORARILY_REJECTED);
const UNSUPPORTED: End = End::Now(MavResult::MAV_RESULT_UNSUPPORTED);

impl MavlinkVehicle {
    /// An order is refused for good. Why reaches the person as an error: of anything less QGroundControl shows a red icon only.
    pub(super) fn denied(&mut self, why: std::fmt::Arguments<'_>) -> End {
        self.error(why);
        DENIED
    }

    /// An order is refused as things are now.
    pub(super) fn not_now(&mut self, why: std::fmt::Arguments<'_>) -> End {
        self.error(why);
        NOT_NOW
    }

    /// Whether somebody else has the controls, which is told whoever has just ordered something.
    pub(super) fn leaves_to_others(&mut self, station: Station) -> bool {
        let others = self.is_others(station);
        if others && let Some(holder) = self.holder() {
            self.error(format_args!("refused: {holder} has the controls"));
        }
        others
    }

    pub(super) fn command(&mut self, now: Duration, station: Station, asked: &Asked) {
        let end = match self.question(station, asked) {
            Some(end) => end,
            None if self.config.view_only && is_known(asked.command) => {
                self.denied(format_args!("view only: no orders are taken by MAVLink"))
            }
            None => self.commanded(now, station, asked),
        };
        if let End::Now(result) = end {
            self.acknowledge(station, asked.command, result);
        }
    }

    /// Commands that only ask for something.
    fn question(&mut self, station: Station, asked: &Asked) -> Option<End> {
        let to = To::Peer(station.peer);
        Some(match MavCmdNumber(asked.command) {
            MavCmdNumber::REQUEST_MESSAGE => {
                let Some(id) = asked.number::<u32>(1) else { return Some(DENIED) };
                let parameter = asked.number::<u8>(2).unwrap_or(0);
                // The acknowledgement comes first.
                let sent = self.messages.len();
                let found = self.answer_request(to, id, parameter);
                let result = if found {
                    MavResult::MAV_RESULT_ACCEPTED
                } else {
                    MavResult::MAV_RESULT_UNSUPPORTED
                };
                self.acknowledge(station, asked.command, result);
                if let Some(acknowledgement) = self.messages.pop_back() {
                    let place = sent.min(self.messages.len());
                    self.messages.insert(place, acknowledgement);
                }
                End::Later
            }
            MavCmdNumber::SET_MESSAGE_INTERVAL => {
                let Some(id) = asked.number::<u32>(1) else { return Some(DENIED) };
                let Some(interval_us) = asked.number::<i32>(2) else { return Some(DENIED) };
                if self.schedule.set(id, interval_us) { ACCEPTED } else { UNSUPPORTED }
            }
            MavCmdNumber::GET_MESSAGE_INTERVAL => {
                let Some(id) = asked.number::<u16>(1) else { return Some(DENIED) };
                self.send(to, self.schedule.interval(id));
                ACCEPTED
            }
            MavCmdNumber::REQUEST_AUTOPILOT_CAPABILITIES => {
                self.answer_request(to, 148, 0);
                ACCEPTED
            }
            MavCmdNumber::REQUEST_PROTOCOL_VERSION => {
                self.answer_request(to, 300, 0);
                ACCEPTED
            }
            MavCmdNumber::GET_HOME_POSITION => {
                self.answer_request(to, 242, 0);
                ACCEPTED
            }
            MavCmdNumber::RUN_PREARM_CHECKS => {
                self.answer_request(to, 1, 0);
                if self.is_flying() { NOT_NOW } else { ACCEPTED }
            }
            _ => return None,
        })
    }

    fn commanded(&mut self, now: Duration, station: Station, asked: &Asked) -> End {
        let by_order = |this: &mut Self, order| {
            this.order(now, station, Some(asked.command), After::Nothing, [order]);
            End::Later
        };
        match MavCmdNumber(asked.command) {
            MavCmdNumber::COMPONENT_ARM_DISARM => self.arm_or_disarm(now, station, asked),
            MavCmdNumber::NAV_TAKEOFF | MavCmdNumber::NAV_TAKEOFF_LOCAL => {
                self.asked_to_take_off(now, station, asked)
            }
            MavCmdNumber::NAV_LAND | MavCmdNumber::NAV_LAND_LOCAL | MavCmdNumber::DO_LAND_START => {
                self.change_mode(now, station, asked.command, Mode::Land)
            }
            MavCmdNumber::NAV_RETURN_TO_LAUNCH => {
                self.change_mode(now, station, asked.command, Mode::Return)
            }
            MavCmdNumber::DO_SET_MODE => {
                let custom = match asked.number::<u32>(2) {
                    // MAVProxy and pymavlink send the whole number.
                    Some(custom @ 256..) => Some(custom),
                    Some(main) => {
                        let sub = asked.number::<u8>(3).unwrap_or(0);
                        u8::try_from(main).ok().map(|main| modes::of_parts(main, sub))
                    }
                    None => None,
                };
                self.change_custom_mode(now, station, asked.command, custom)
            }
            MavCmdNumber::DO_SET_STANDARD_MODE => {
                match asked.number::<u8>(1).and_then(Mode::from_standard) {
                    Some(mode) => self.change_mode(now, station, asked.command, mode),
                    None => self.no_such_mode(None),
                }
            }
            MavCmdNumber::DO_REPOSITION => self.reposition(now, station, asked),
            MavCmdNumber::DO_PAUSE_CONTINUE => match asked.number::<u8>(1) {
                Some(0) => self.change_mode(now, station, asked.command, Mode::Hold),
                // Asked again: the answer may have been lost.
                Some(1) if self.goes_on() && !self.is_others(station) => ACCEPTED,
                Some(1) if self.is_flying() => by_order(self, OperatorOrder::Resume),
                Some(1) => self.not_now(format_args!("nothing to go on with: it is on the ground")),
                _ => DENIED,
            },
            MavCmdNumber::MISSION_START => {
                // 0 is what everybody sends; where it begins was chosen by then.
                let first = asked.number::<u16>(1).filter(|seq| *seq > 0);
                self.start_mission(now, station, asked.command, first)
            }
            MavCmdNumber::DO_SET_MISSION_CURRENT => {
                let Some(seq) = asked.number::<i32>(1) else { return DENIED };
                let reset = asked.number::<u8>(2) == Some(1);
                let seq = if reset && seq < 0 { 0 } else { seq };
                match u16::try_from(seq) {
                    Ok(seq) => self.set_current(now, station, Some(asked.command), seq),
                    Err(_) => DENIED,
                }
            }
            MavCmdNumber::DO_FLIGHTTERMINATION => {
                if asked.parameter(1).is_some_and(|value| value > 0.5) {
                    self.arming.give_up();
                    by_order(self, OperatorOrder::Cut)
                } else {
                    DENIED
                }
            }
            MavCmdNumber::DO_SET_HOME => {
                self.denied(format_args!("home is the place of the take-off, and is not set"))
            }
            MavCmdNumber::PREFLIGHT_REBOOT_SHUTDOWN => {
                self.denied(format_args!("the drone is not restarted by MAVLink"))
            }
            _ => UNSUPPORTED,
        }
    }

    fn arm_or_disarm(&mut self, now: Duration, station: Station, asked: &Asked) -> End {
        let magic = asked.parameter(2).unwrap_or(0.0);
        #[allow(clippy::float_cmp, reason = "a code, not a quantity")]
        let cuts = magic == MAGIC_CUT;
        match asked.number::<u8>(1) {
            Some(1) if self.is_flying() => ACCEPTED,
            // A forced arming skips the checks before a flight, which are not to be skipped.
            Some(1) if magic != 0.0 => {
                self.denied(format_args!("forced arming is refused: arm without force"))
            }
            Some(1) => {
                // Sooner than its reasons not to take off say so.
                if self.present().is_some_and(|status| status.emergency) {
                    return self
                        .not_now(format_args!("PreArm: the drone is in its emergency state"));
                }
                let Some(why) = self.not_ready else {
                    return self.not_now(format_args!("PreArm: the drone has not answered yet"));
                };
                if !why.is_empty() {
                    return self.not_now(format_args!("PreArm: {why}"));
                }
                let take = [OperatorOrder::Take];
                self.order(now, station, Some(asked.command), After::Armed, take);
                End::Later
            }
            Some(0) if cuts && self.is_flying() => {
                let cut = [OperatorOrder::Cut];
                self.order(now, station, Some(asked.command), After::Nothing, cut);
                End::Later
            }
            Some(0) if self.is_flying() => {
                self.denied(format_args!("in flight: land, or cut the motors by their code"))
            }
            Some(0) if self.leaves_to_others(station) => NOT_NOW,
            Some(0) => {
                self.disarm();
                ACCEPTED
            }
            _ => DENIED,
        }
    }

    /// Changes to the mode of this number in PX4's `custom_mode`, if there is one.
    pub(super) fn change_custom_mode(
        &mut self,
        now: Duration,
        station: Station,
        command: u16,
        custom: Option<u32>,
    ) -> End {
        match custom.and_then(Mode::from_custom) {
            Some(mode) => self.change_mode(now, station, command, mode),
            None => self.no_such_mode(custom),
        }
    }

    /// QGroundControl lists twelve of PX4's modes, whatever `AVAILABLE_MODES` says.
    fn no_such_mode(&mut self, custom: Option<u32>) -> End {
        match custom.and_then(modes::name_of_px4) {
            Some(name) => self.denied(format_args!(
                "mode {name} is not flown here: use {}",
                modes::names().join(", ")
            )),
            None => self.denied(format_args!("no such mode: use {}", modes::names().join(", "))),
        }
    }

    /// Changes the mode.
    fn change_mode(&mut self, now: Duration, station: Station, command: u16, mode: Mode) -> End {
        let flies = self.is_flying();
        if matches!(mode, Mode::Hold | Mode::Land) {
            // Whoever orders so does not expect that a take-off follows.
            self.arming.give_up();
        }
        let (after, order) = match mode {
            Mode::Hold if !flies => return ACCEPTED,
            Mode::Hold => (After::Nothing, OperatorOrder::Hold),
            Mode::Land if !flies && !self.arming.is_armed() => return ACCEPTED,
            Mode::Land => (After::Nothing, OperatorOrder::Land),
            Mode::TakeOff if flies => {
                if self.mode() == Mode::TakeOff {
                    return ACCEPTED;
                }
                return self.not_now(format_args!("no take-off: it flies already"));
            }
            Mode::TakeOff if self.leaves_to_others(station) => return NOT_NOW,
            Mode::TakeOff => {
                let height_m = self.take_off_height_m(None);
                self.when_armed(now, station, command, Then::TakeOff { height_m });
                return End::Later;
            }
            Mode::Mission => return self.start_mission(now, station, command, None),
            Mode::Return | Mode::Position if !self.is_airborne() => {
                return self.not_now(format_args!("mode {}: take off first", mode.name()));
            }
            Mode::Return if self.mode() == Mode::Return => return ACCEPTED,
            Mode::Return if self.mode() == Mode::Land => {
                return self.not_now(format_args!("no return: it lands"));
            }
            Mode::Return => {
                self.fly_home(now, station, command);
                return End::Later;
            }
            Mode::Position | Mode::Offboard if self.leaves_to_others(station) => return NOT_NOW,
            Mode::Position | Mode::Offboard => {
                let by = station.operator();
                let source =
                    if mode == Mode::Position { Source::Sticks } else { Source::Setpoints };
                let Some(setpoint) = self.following.fresh(now, source, by) else {
                    let why = format_args!("no fresh setpoints or sticks to follow");
                    return self.denied(why);
                };
                if self.mode() == mode && self.following.followed() == Some((source, by)) {
                    return ACCEPTED;
                }
                (After::Follows(source), OperatorOrder::Follow(setpoint))
            }
        };
        self.order(now, station, Some(command), after, [order]);
        End::Later
    }

    /// Starts the stored mission, or goes on with it; `first` is the item with which it is to begin.
    fn start_mission(
        &mut self,
        now: Duration,
        station: Station,
        command: u16,
        first: Option<u16>,
    ) -> End {
        let count = self.transfer.items().len();
        if count == 0 {
            // QGroundControl offers one that it sent before the vehicle was restarted.
            return self.denied(format_args!("there is no mission: upload it (again)"));
        }
        if let Some(first) = first.filter(|first| usize::from(*first) >= count) {
            let last = count - 1;
            return self.denied(format_args!("there is no item {first}: the last is {last}"));
        }
        if self.leaves_to_others(station) {
            return NOT_NOW;
        }
        if !self.is_flying() {
            if let Some(first) = first {
                self.flown.begin_at(first);
            }
            self.when_armed(now, station, command, Then::Mission);
            return End::Later;
        }
        if !self.is_airborne() || self.mode() == Mode::Land {
            return self.not_now(format_args!("no mission now: it takes off or lands"));
        }
        if self.flies_stored_mission() {
            let paused = self.present().is_some_and(|status| status.mission_waits);
            if !paused {
                return ACCEPTED;
            }
            self.order(now, station, Some(command), After::Nothing, [OperatorOrder::Resume]);
        } else {
            if let Some(first) = first {
                self.flown.begin_at(first);
            }
            self.fly_mission(now, station, Some(command));
        }
        End::Later
    }

    /// Whether the vehicle flies a mission that is not paused.
    fn goes_on(&self) -> bool {
        let status = self.present();
        self.is_airborne()
            && status.is_some_and(|status| !status.mission_waits && status.step.is_some())
    }

    /// Whether the vehicle flies the stored mission, and not to its end yet.
    pub(super) fn flies_stored_mission(&self) -> bool {
        self.is_flying() && self.flown.goes_on() && self.flown.is_stored(self.transfer.id())
    }

    /// Goes on with another item.
    pub(super) fn set_current(
        &mut self,
        now: Duration,
        station: Station,
        command: Option<u16>,
        seq: u16,
    ) -> End {
        if usize::from(seq) >= self.transfer.items().len() {
            return self.denied(format_args!("there is no item {seq}"));
        }
        if self.leaves_to_others(station) {
            return NOT_NOW;
        }
        let flies = self.flies_stored_mission();
        let paused = self.present().is_some_and(|status| status.mission_waits);
        self.flown.begin_at(seq);
        if flies && !paused {
            self.fly_mission(now, station, command);
            return if command.is_some() { End::Later } else { ACCEPTED };
        }
        if flies {
            // What is paused goes on there when it is started again.
            self.flown.forget();
        }
        ACCEPTED
    }
}

/// Sends what was asked for; used by commands and by old requests.
impl MavlinkVehicle {
    /// Returns whether there is such a message.
    pub(super) fn answer_request(&mut self, to: To, id: u32, parameter: u8) -> bool {
        let mut found = false;
        let mut send = |this: &mut Self, message: Option<MavMessage>| {
            found |= message.is_some();
            if let Some(message) = message {
                this.send(to, message);
            }
        };
        match (id, parameter) {
            // All modes.
            (435, 0) => {
                for index in 1..=Mode::ALL.len() {
                    let message = Self::available_mode(index);
                    send(self, message);
                }
            }
            (435, index) => send(self, Self::available_mode(index.into())),
            (id, _) => {
                let message = self.telemetry(id);
                send(self, message);
            }
        }
        found
    }
}
