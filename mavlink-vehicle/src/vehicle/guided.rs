//! A take-off and a place that an operator asks for: to what height, and whether it may be flown there.

use std::time::Duration;

use autopilot::plan::Figures;
use autopilot::vehicle::{OperatorOrder, Place};

use super::arming::Then;
use super::commands::{Asked, End};
use super::modes::Mode;
use super::orders::After;
use super::parameters::TAKE_OFF_HEIGHT;
use super::stations::Station;
use super::{Autopilot, MavlinkVehicle};
use crate::dialect::{MavResult, MavSeverity};
use crate::place::{ABSENT, GRID_M};

/// `MAV_FRAME_GLOBAL` and `MAV_FRAME_GLOBAL_RELATIVE_ALT`.
const GLOBAL: u8 = 0;
const GLOBAL_RELATIVE: u8 = 3;
/// QGroundControl's go-to sends the height that it was told last, which the drone has left since by at most this, in metres.
const MOVED_M: f64 = 0.2;

impl MavlinkVehicle {
    pub(super) fn asked_to_take_off(
        &mut self,
        now: Duration,
        station: Station,
        asked: &Asked,
    ) -> End {
        if self.is_flying() {
            if self.mode() == Mode::TakeOff {
                return End::Now(MavResult::MAV_RESULT_ACCEPTED);
            }
            return self.not_now(format_args!("no take-off: it flies already"));
        }
        if self.leaves_to_others(station) {
            return End::Now(MavResult::MAV_RESULT_TEMPORARILY_REJECTED);
        }
        // QGroundControl asks PX4 by height above the sea; the others above the start.
        let frame = asked.frame.unwrap_or(match self.config.autopilot {
            Autopilot::Px4 => GLOBAL,
            Autopilot::Generic => GLOBAL_RELATIVE,
        });
        let wanted_m = match self.origin.place(frame, ABSENT, ABSENT, asked.z) {
            Ok(place) if asked.z != 0.0 => place.z_m,
            Ok(_) => None,
            Err(error) => {
                self.error(format_args!("{error}"));
                return End::Now(MavResult::MAV_RESULT_COMMAND_UNSUPPORTED_MAV_FRAME);
            }
        };
        let height_m = self.take_off_height_m(wanted_m);
        self.when_armed(now, station, asked.command, Then::TakeOff { height_m });
        End::Later
    }

    /// To what height a take-off leads; `None` is the hover of the drone's own take-off. What is asked for outside the limits
    /// is not clamped: QGroundControl's slider begins at 10 m, and nobody who takes off in a room wants to be at its ceiling.
    pub(super) fn take_off_height_m(&mut self, wanted_m: Option<f64>) -> Option<f64> {
        let own_m = Some(self.parameters.value(TAKE_OFF_HEIGHT)).filter(|own_m| *own_m > 0.0);
        let Some(wanted_m) = wanted_m else { return own_m };
        let limits = self.config.limits;
        let (low_m, high_m) = (limits.floor_m, limits.ceiling_m);
        if (low_m - GRID_M..=high_m + GRID_M).contains(&wanted_m) {
            let height_m = wanted_m.clamp(low_m, high_m);
            let info = MavSeverity::MAV_SEVERITY_INFO;
            self.say(info, format_args!("take-off to {height_m:.2} m"));
            return Some(height_m);
        }
        let [wanted, low, high] = [wanted_m, low_m, high_m].map(Figures);
        let outside = format_args!("{wanted:.2} m, which is not between {low} and {high} m");
        match own_m {
            Some(own_m) => self.warn(format_args!("take-off to {own_m:.2} m, not {outside}")),
            None => self.warn(format_args!("take-off to the hover, not {outside}")),
        }
        own_m
    }

    /// Whether the drone is above its ceiling by no more than one that is sent there.
    pub(super) fn is_a_little_high(&self) -> bool {
        let high_m = self.config.limits.ceiling_m;
        let height_m = self.present().and_then(|status| status.pose).map(|pose| pose.z_m);
        height_m.is_some_and(|height_m| (high_m..=high_m + MOVED_M).contains(&height_m))
    }

    pub(super) fn reposition(&mut self, now: Duration, station: Station, asked: &Asked) -> End {
        let frame = asked.frame.unwrap_or(GLOBAL);
        let place = match self.origin.place(frame, asked.x, asked.y, asked.z) {
            Ok(place) => place,
            Err(error) => {
                self.error(format_args!("{error}"));
                return End::Now(MavResult::MAV_RESULT_COMMAND_UNSUPPORTED_MAV_FRAME);
            }
        };
        let limits = self.config.limits;
        let (low_m, high_m) = (limits.floor_m, limits.ceiling_m);
        // A drone at its ceiling is now and then a little above it, and is sent there again.
        let height_m = self.present().and_then(|status| status.pose).map(|pose| pose.z_m);
        let lowest_m = height_m.map_or(low_m, |m| low_m.min(m - MOVED_M)) - GRID_M;
        let highest_m = height_m.map_or(high_m, |m| high_m.max(m + MOVED_M)) + GRID_M;
        let beyond_m = place.ground_m.map(|(x_m, y_m)| limits.border.outside_m([x_m, y_m].into()));
        if beyond_m.is_some_and(|beyond_m| beyond_m > GRID_M) {
            let fence = limits.border;
            return self.denied(format_args!("go-to refused: outside the fence, {fence}"));
        }
        if let Some(z_m) = place.z_m.filter(|z_m| !(lowest_m..=highest_m).contains(z_m)) {
            let [z, low, high] = [z_m, low_m, high_m].map(Figures);
            return self.denied(format_args!(
                "go-to refused: {z:.2} m above the start, not between {low} and {high} m"
            ));
        }
        if !self.is_airborne() {
            return self.not_now(format_args!("go-to refused: take off first"));
        }
        let yaw_deg = asked.parameter(4).map(|yaw_rad| self.origin.yaw_deg(yaw_rad.into()));
        let to = Place {
            x_m: place.ground_m.map(|(x_m, _)| x_m),
            y_m: place.ground_m.map(|(_, y_m)| y_m),
            height_m: place.z_m.map(|z_m| z_m.clamp(low_m, high_m)),
            yaw_deg,
        };
        // QGroundControl's pause is a way to nowhere.
        let order =
            if to == Place::default() { OperatorOrder::Hold } else { OperatorOrder::GoTo(to) };
        self.order(now, station, Some(asked.command), After::Nothing, [order]);
        End::Later
    }
}
