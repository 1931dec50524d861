//! Messages that arrive.

use std::time::Duration;

use autopilot::vehicle::{OperatorOrder, Setpoint};
use mavlink_core::types::CharArray;

use super::commands::{Asked, End};
use super::parameters::NotSet;
use super::setpoints::{NoSetpoint, global, local};
use super::stations::Station;
use super::{COMPONENT, MavlinkVehicle, To};
use crate::dialect::{
    MISSION_ACK_DATA, MISSION_COUNT_DATA, MISSION_REQUEST_INT_DATA, MavCmd, MavMessage,
    MavModeFlag, MavParamError, MavResult, MavSeverity, PARAM_ERROR_DATA, PING_DATA, SET_MODE_DATA,
    TIMESYNC_DATA,
};
use crate::frame::Frame;
use crate::mission::{Event, FENCE, Handled, Item, Message, Partner, Received, result};
use crate::place::Origin;

/// Most items of a mission of which it is told one by one what is flown otherwise.
const NOTES: usize = 4;
/// The target of all systems, and of all components.
const ALL: u8 = 0;

impl MavlinkVehicle {
    /// A frame with a valid checksum has arrived.
    pub(super) fn receive(&mut self, now: Duration, peer: u8, local: bool, frame: &Frame<'_>) {
        if let Some(signing) = &mut self.signing {
            let Some(signature) = &frame.signature else { return };
            if signing.verify(signature, now).is_err() {
                return;
            }
        }
        // Our own, come back, or of nobody.
        if frame.system == ALL || (frame.system, frame.component) == (self.config.system, COMPONENT)
        {
            return;
        }
        let station = Station { system: frame.system, component: frame.component, peer, local };
        self.stations.heard(now, station);
        if target(&frame.message).is_some_and(|target| !self.is_meant(target)) {
            return;
        }
        self.received(now, station, &frame.message);
    }

    /// Whether a message for this system and component is for this vehicle.
    fn is_meant(&self, (system, component): (u8, u8)) -> bool {
        [ALL, self.config.system].contains(&system) && [ALL, COMPONENT].contains(&component)
    }

    fn received(&mut self, now: Duration, station: Station, message: &MavMessage) {
        let to = To::Peer(station.peer);
        match message {
            MavMessage::COMMAND_LONG(data) => self.command(now, station, &Asked::long(data)),
            MavMessage::COMMAND_INT(data) => self.command(now, station, &Asked::int(data)),
            MavMessage::SET_MODE(data) => self.set_mode(now, station, data),
            MavMessage::PING(data) if data.target_system == ALL => {
                let (target_system, target_component) = (station.system, station.component);
                self.send(
                    to,
                    MavMessage::PING(PING_DATA { target_system, target_component, ..*data }),
                );
            }
            MavMessage::TIMESYNC(data) if data.tc1 == 0 => {
                let answer = TIMESYNC_DATA {
                    tc1: i64::try_from(now.as_nanos()).unwrap_or(i64::MAX),
                    ts1: data.ts1,
                    target_system: station.system,
                    target_component: station.component,
                };
                self.send(to, MavMessage::TIMESYNC(answer));
            }
            MavMessage::PARAM_REQUEST_LIST(_) => {
                for index in 0..self.parameters.count() {
                    self.tell_parameter(to, index);
                }
            }
            MavMessage::PARAM_REQUEST_READ(data) => {
                match self.parameters.index(data.param_index, &data.param_id) {
                    Some(index) => self.tell_parameter(to, index),
                    None => self.parameter_error(
                        station,
                        data.param_index,
                        data.param_id,
                        MavParamError::MAV_PARAM_ERROR_DOES_NOT_EXIST,
                    ),
                }
            }
            MavMessage::PARAM_SET(data) => {
                self.set_parameter(station, data.param_id, data.param_value);
            }
            MavMessage::SET_GPS_GLOBAL_ORIGIN(data) => {
                let degrees = |e7: i32| f64::from(e7) / 1e7;
                let origin = Origin {
                    latitude_deg: degrees(data.latitude),
                    longitude_deg: degrees(data.longitude),
                    altitude_m: f64::from(data.altitude) / 1e3,
                    ..self.origin
                };
                self.set_origin(station, origin);
            }
            MavMessage::SET_POSITION_TARGET_LOCAL_NED(data) => {
                let pose = self.present().and_then(|status| status.pose);
                let setpoint = local(data, &self.origin, pose.as_ref());
                self.take_setpoint(now, station, setpoint);
            }
            MavMessage::SET_POSITION_TARGET_GLOBAL_INT(data) => {
                let setpoint = global(data, &self.origin);
                self.take_setpoint(now, station, setpoint);
            }
            MavMessage::MANUAL_CONTROL(data) => {
                if self.config.view_only || self.is_others(station) {
                    return;
                }
                let by = station.operator();
                if let Some(setpoint) = self.following.take_sticks(now, by, data) {
                    self.pass_on(station, setpoint);
                }
            }
            _ => self.received_of_mission(now, station, message),
        }
    }

    fn set_mode(&mut self, now: Duration, station: Station, data: &SET_MODE_DATA) {
        // It is acknowledged like the command that has taken its place.
        let command = MavCmd::MAV_CMD_DO_SET_MODE as u16;
        let custom = data.base_mode.contains(MavModeFlag::MAV_MODE_FLAG_CUSTOM_MODE_ENABLED);
        let mode = custom.then_some(data.custom_mode);
        let end = if self.config.view_only {
            End::Now(MavResult::MAV_RESULT_DENIED)
        } else {
            self.change_custom_mode(now, station, command, mode)
        };
        if let End::Now(result) = end {
            self.acknowledge(station, command, result);
        }
    }

    fn tell_parameter(&mut self, to: To, index: usize) {
        if let Some(message) = self.parameters.at(index) {
            self.send(to, message);
        }
    }

    fn set_parameter(&mut self, station: Station, name: CharArray<16>, value: f32) {
        let Some(index) = self.parameters.index(-1, &name) else {
            let error = MavParamError::MAV_PARAM_ERROR_DOES_NOT_EXIST;
            return self.parameter_error(station, -1, name, error);
        };
        let set = if self.config.view_only || self.is_others(station) {
            Err(NotSet::ReadOnly)
        } else {
            self.parameters.set(index, value)
        };
        // All are told the value that is kept.
        self.tell_parameter(To::All, index);
        let named = name.to_str().unwrap_or_default();
        // QGroundControl does not hear PARAM_ERROR: its field snaps back without a word.
        match set {
            Ok(()) => {}
            Err(NotSet::Unknown) => self.error(format_args!("there is no parameter {named}")),
            Err(NotSet::OutOfRange) => {
                self.error(format_args!("{named} not changed: {value} is outside its range"));
            }
            Err(NotSet::ReadOnly) if self.config.view_only => {
                self.error(format_args!("{named} not changed: view only"));
            }
            Err(NotSet::ReadOnly) if self.is_others(station) => {
                self.error(format_args!("{named} not changed: somebody else has the controls"));
            }
            Err(NotSet::ReadOnly) => self
                .error(format_args!("{named} not changed: it is read-only here, see pilot.toml")),
        }
        let error = match set {
            Ok(()) => return,
            Err(NotSet::Unknown) => MavParamError::MAV_PARAM_ERROR_DOES_NOT_EXIST,
            Err(NotSet::ReadOnly) => MavParamError::MAV_PARAM_ERROR_READ_ONLY,
            Err(NotSet::OutOfRange) => MavParamError::MAV_PARAM_ERROR_VALUE_OUT_OF_RANGE,
        };
        self.parameter_error(station, i16::try_from(index).unwrap_or(-1), name, error);
    }

    fn parameter_error(
        &mut self,
        station: Station,
        param_index: i16,
        param_id: CharArray<16>,
        error: MavParamError,
    ) {
        let message = PARAM_ERROR_DATA {
            param_index,
            target_system: station.system,
            target_component: station.component,
            param_id,
            error,
        };
        self.send(To::Peer(station.peer), MavMessage::PARAM_ERROR(message));
    }

    /// The origin can be set on the ground; a stored mission that no longer fits is removed.
    fn set_origin(&mut self, station: Station, origin: Origin) {
        if self.config.view_only || self.is_armed() || self.is_others(station) {
            return self.error(format_args!("the origin is not set: disarm first"));
        }
        let origin = match origin.checked() {
            Ok(origin) => origin,
            Err(error) => return self.error(format_args!("{error}")),
        };
        self.origin = origin;
        let rules = self.rules();
        if let Err(problem) = self.transfer.translate_again(&rules) {
            self.transfer.clear();
            self.flown.begin_at(0);
            self.error(format_args!("mission removed: {}", problem.reason));
        }
        for id in [49, 242] {
            self.answer_request(To::All, id, 0);
        }
    }

    fn take_setpoint(
        &mut self,
        now: Duration,
        station: Station,
        setpoint: Result<Setpoint, NoSetpoint>,
    ) {
        // Only whoever has the controls is followed, or might be.
        if self.config.view_only || self.is_others(station) {
            return;
        }
        let setpoint = match setpoint {
            Ok(setpoint) => setpoint,
            Err(error) => {
                if self.following.tells_refusal(now) {
                    self.warn(format_args!("{error}"));
                }
                return;
            }
        };
        if self.following.take_setpoint(now, station.operator(), setpoint) {
            self.pass_on(station, setpoint);
        }
    }

    /// Passes a setpoint on that is followed.
    fn pass_on(&mut self, station: Station, setpoint: Setpoint) {
        self.stations.orders(station);
        self.order_quietly(station.operator(), OperatorOrder::Setpoint(setpoint));
    }

    fn received_of_mission(&mut self, now: Duration, station: Station, message: &MavMessage) {
        let received = match message {
            MavMessage::MISSION_COUNT(data) => {
                Received::Count { count: data.count, mission_type: data.mission_type }
            }
            MavMessage::MISSION_ITEM_INT(data) => Received::Item(Item::of_integers(data)),
            MavMessage::MISSION_ITEM(data) => Received::Item(Item::of_floats(data)),
            MavMessage::MISSION_REQUEST_LIST(data) => {
                Received::RequestList { mission_type: data.mission_type }
            }
            MavMessage::MISSION_REQUEST_INT(data) => {
                Received::Request { seq: data.seq, mission_type: data.mission_type }
            }
            MavMessage::MISSION_REQUEST(data) => {
                Received::Request { seq: data.seq, mission_type: data.mission_type }
            }
            MavMessage::MISSION_ACK(data) => {
                Received::Ack { result: data.mavtype, mission_type: data.mission_type }
            }
            MavMessage::MISSION_CLEAR_ALL(data) => {
                Received::ClearAll { mission_type: data.mission_type }
            }
            MavMessage::MISSION_REQUEST_PARTIAL_LIST(data) => {
                Received::PartialList { mission_type: data.mission_type }
            }
            MavMessage::MISSION_WRITE_PARTIAL_LIST(data) => {
                Received::PartialList { mission_type: data.mission_type }
            }
            MavMessage::MISSION_SET_CURRENT(data) => {
                if !self.config.view_only {
                    // Answered by MISSION_CURRENT alone.
                    _ = self.set_current(now, station, None, data.seq);
                }
                self.answer_request(To::All, 42, 0);
                return;
            }
            _ => return,
        };
        let partner = Partner { system: station.system, component: station.component };
        let changes = matches!(received, Received::Count { .. } | Received::ClearAll { .. })
            && received.mission_type() != FENCE;
        if changes && let Some(why) = self.may_not_change(station) {
            self.error(format_args!("mission not changed: {why}"));
            let mission_type = received.mission_type();
            let message = Message::Ack { result: result::DENIED, mission_type };
            return self.send_of_mission(partner, message);
        }
        let rules = self.rules();
        let handled = self.transfer.handle(now, partner, &received, &rules);
        self.transferred(partner, &handled);
    }

    /// Why a station may not change the stored mission now.
    fn may_not_change(&self, station: Station) -> Option<&'static str> {
        if self.config.view_only {
            Some("view only")
        } else if self.is_others(station) {
            Some("somebody else has the controls")
        } else if self.flies_stored_mission()
            && self.present().is_some_and(|status| !status.mission_waits)
        {
            Some("it is being flown; pause it first")
        } else {
            None
        }
    }

    /// What a transfer has led to.
    pub(super) fn transferred(&mut self, partner: Partner, handled: &Handled) {
        if let Some(message) = &handled.message {
            self.send_of_mission(partner, *message);
        }
        let Some(event) = &handled.event else { return };
        match event {
            Event::Accepted | Event::Cleared => {
                self.flown.begin_at(0);
                // What waits was ordered for another.
                self.arming.give_up();
                let info = MavSeverity::MAV_SEVERITY_INFO;
                match self.transfer.items().len() {
                    0 => self.say(info, format_args!("mission removed")),
                    1 => self.say(info, format_args!("mission of 1 item")),
                    count => self.say(info, format_args!("mission of {count} items")),
                }
                let limited = self.transfer.translated().limited();
                for note in limited.iter().take(NOTES) {
                    self.texts.say(MavSeverity::MAV_SEVERITY_WARNING, format_args!("{note}"));
                }
                if let more @ 1.. = limited.len().saturating_sub(NOTES) {
                    let text = format_args!("and {more} more items moved into the limits");
                    self.texts.say(MavSeverity::MAV_SEVERITY_WARNING, text);
                }
                self.answer_request(To::All, 42, 0);
            }
            Event::Refused(problem) => {
                self.error(format_args!("mission refused: {}", problem.reason));
            }
            Event::FenceStays => {
                let border = self.config.limits.border;
                self.error(format_args!("fence not changed: it is {border}, see pilot.toml"));
            }
            Event::FenceSame => {
                let border = self.config.limits.border;
                let info = MavSeverity::MAV_SEVERITY_INFO;
                self.say(info, format_args!("the fence is as before: {border}"));
            }
            Event::Cancelled => {
                self.error(format_args!("upload given up; the mission is unchanged"));
            }
        }
    }

    fn send_of_mission(&mut self, partner: Partner, message: Message) {
        let Partner { system: target_system, component: target_component } = partner;
        let Some(peer) = self.stations.peer(target_system, target_component) else { return };
        let opaque_id = self.transfer.id();
        let message = match message {
            Message::Count { count, mission_type } => {
                MavMessage::MISSION_COUNT(MISSION_COUNT_DATA {
                    count,
                    target_system,
                    target_component,
                    mission_type,
                    opaque_id,
                })
            }
            Message::Request { seq, mission_type } => {
                MavMessage::MISSION_REQUEST_INT(MISSION_REQUEST_INT_DATA {
                    seq,
                    target_system,
                    target_component,
                    mission_type,
                })
            }
            Message::Item(item) => {
                MavMessage::MISSION_ITEM_INT(item.to(target_system, target_component))
            }
            Message::Ack { result, mission_type } => MavMessage::MISSION_ACK(MISSION_ACK_DATA {
                target_system,
                target_component,
                mavtype: result as u8,
                mission_type,
                opaque_id,
            }),
        };
        self.send(To::Peer(peer), message);
    }
}

/// The system and component that a message is for; nothing if it is for everybody.
fn target(message: &MavMessage) -> Option<(u8, u8)> {
    macro_rules! targets {
        ($($name:ident),* $(,)?) => {
            match message {
                $(MavMessage::$name(data) => Some((data.target_system, data.target_component)),)*
                MavMessage::SET_MODE(data) => Some((data.target_system, ALL)),
                MavMessage::SET_GPS_GLOBAL_ORIGIN(data) => Some((data.target_system, ALL)),
                MavMessage::MANUAL_CONTROL(data) => Some((data.target, ALL)),
                _ => None,
            }
        };
    }
    targets!(
        COMMAND_LONG,
        COMMAND_INT,
        PARAM_REQUEST_LIST,
        PARAM_REQUEST_READ,
        PARAM_SET,
        MISSION_COUNT,
        MISSION_ITEM,
        MISSION_ITEM_INT,
        MISSION_REQUEST,
        MISSION_REQUEST_INT,
        MISSION_REQUEST_LIST,
        MISSION_REQUEST_PARTIAL_LIST,
        MISSION_WRITE_PARTIAL_LIST,
        MISSION_ACK,
        MISSION_CLEAR_ALL,
        MISSION_SET_CURRENT,
        SET_POSITION_TARGET_LOCAL_NED,
        SET_POSITION_TARGET_GLOBAL_INT,
    )
}
