//! What the items of a mission mean, and whether they can be flown.
//!
//! Yaws are degrees clockwise from north, except in the frames 20 and 21, where they count from the heading at
//! the start, and in the local take-off and landing, where the dialect has radians.

use autopilot::plan::{Command, Figures, FlightLimits};
use kinematics::{Pose, wrap_deg};

use super::program::{Step, TAKE_OFF, Translated};
use super::{Item, command, result};
use crate::dialect::MavMissionResult;
use crate::place::{Frame, GRID_M, Global, Origin, Place, PlaceError};

/// Largest mission.
pub(crate) const MAX_ITEMS: usize = 200;

/// A target is reached within this distance.
const REACH_M: f64 = 0.2;
/// Stay at a way-point without hold time.
pub(crate) const SHORT_STAY_S: f64 = 0.3;
/// Longest stay of the plan language.
const LONGEST_STAY_S: f64 = 600.0;
/// Expected height after a take-off.
const HOVER_M: f64 = 0.85;
/// Slowest limit of the plan language, and its fastest.
const SPEEDS_M_S: (f64, f64) = (0.1, 2.2);
/// Plans have four digits behind the point.
const DIGITS: f64 = 1e4;
/// Longer turns are flown in parts, since a drone takes the shortest way.
const LONGEST_TURN_DEG: f64 = 120.0;
/// Component of MAVProxy.
const MAVPROXY: u8 = 230;
/// A home item is this near to the origin.
const NEAR_HOME_M: f64 = 2.0;

/// What a mission is judged by.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Rules {
    /// What places on the globe mean.
    pub(crate) origin: Origin,
    /// Where targets may be.
    pub(crate) fence: FlightLimits,
    /// Limit of the horizontal speed, and what it is without an item that sets it.
    pub(crate) max_speed_m_s: f64,
}

/// The first item that cannot be flown.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{reason}")]
pub(crate) struct Problem {
    /// Its index.
    pub(crate) item: u16,
    /// What its sender is answered.
    pub(crate) result: MavMissionResult,
    /// For a person; at most 200 bytes.
    pub(crate) reason: String,
}

/// Checks all items, which `sender_component` sent, and translates them. The home position that MAVProxy sends
/// as item 0 is skipped.
///
/// # Errors
/// [`Problem`] names the first item that is wrong.
pub(crate) fn translate(
    items: &[Item],
    sender_component: u8,
    rules: &Rules,
) -> Result<Translated, Problem> {
    let (slowest_m_s, fastest_m_s) = SPEEDS_M_S;
    let max_speed_m_s = rules.max_speed_m_s.min(fastest_m_s).max(slowest_m_s);
    let mut translator = Translator {
        rules: Rules { max_speed_m_s, ..*rules },
        steps: Vec::with_capacity(items.len().min(MAX_ITEMS)),
        limited: Vec::new(),
        pose: None,
        yaw_deg: 0.0,
        end: None,
    };
    for (index, item) in (0_u16..).zip(items) {
        let at = At { index, item };
        if usize::from(index) >= MAX_ITEMS {
            return Err(at.problem(result::NO_SPACE, format!("at most {MAX_ITEMS} items")));
        }
        if item.seq != index {
            return Err(at.problem(result::INVALID_SEQUENCE, format!("it has number {}", item.seq)));
        }
        if !(index == 0 && sender_component == MAVPROXY && is_home(item, &rules.origin)) {
            translator.item(at)?;
        }
    }
    let Translator { steps, limited, .. } = translator;
    Ok(Translated { steps, speed_m_s: short(max_speed_m_s), limited })
}

/// Whether it says where home is, instead of a place to fly to.
fn is_home(item: &Item, origin: &Origin) -> bool {
    let Item { frame, command, x, y, .. } = *item;
    let (x_m, y_m) = origin.ground_m(Global { latitude_e7: x, longitude_e7: y });
    command == command::NAV_WAYPOINT
        && Frame::from_number(frame) == Ok(Frame::Global)
        && x_m.hypot(y_m) <= NEAR_HOME_M
}

/// An item and where it stands.
#[derive(Clone, Copy)]
struct At<'a> {
    index: u16,
    item: &'a Item,
}

impl At<'_> {
    /// The item for a person: its number is one less than that of the marker on QGroundControl's map, so what it does is named.
    fn named(self) -> String {
        match name_of(self.item.command) {
            Some(name) => format!("item {} ({name})", self.index),
            None => format!("item {}", self.index),
        }
    }

    fn problem(self, result: MavMissionResult, reason: impl AsRef<str>) -> Problem {
        let reason = format!("{}: {}", self.named(), reason.as_ref());
        Problem { item: self.index, result, reason }
    }

    /// One of the first four parameters; a NaN is not given.
    fn param(self, number: u8) -> Option<f64> {
        let Item { param1, param2, param3, param4, .. } = *self.item;
        let value = match number {
            1 => param1,
            2 => param2,
            3 => param3,
            _ => param4,
        };
        (!value.is_nan()).then_some(f64::from(value))
    }

    /// The parameter, or `default`, if it is one of these choices.
    fn choice(self, number: u8, default: f64, choices: &[f64]) -> Result<f64, Problem> {
        let value = self.param(number).unwrap_or(default);
        let known = choices.contains(&value);
        let wrong = || format!("parameter {number} is {}, not one of {choices:?}", Figures(value));
        if known { Ok(value) } else { Err(self.problem(result_of(number), wrong())) }
    }

    fn stay_s(self) -> Result<f64, Problem> {
        match self.param(1) {
            None | Some(0.0) => Ok(SHORT_STAY_S),
            Some(stay_s) if (0.0..=LONGEST_STAY_S).contains(&stay_s) => Ok(stay_s),
            Some(stay_s) => Err(self.problem(
                result::INVALID_PARAM1,
                format!("a stay of {} s is not between 0 and {LONGEST_STAY_S}", Figures(stay_s)),
            )),
        }
    }

    fn reach_m(self) -> Result<f64, Problem> {
        match self.param(2) {
            None | Some(0.0) => Ok(REACH_M),
            Some(reach_m) if reach_m > 0.0 => Ok(reach_m.clamp(0.1, 1.0)),
            Some(reach_m) => Err(self.problem(
                result::INVALID_PARAM2,
                format!("an acceptance radius of {} m is negative", Figures(reach_m)),
            )),
        }
    }

    fn place_problem(self, error: PlaceError) -> Problem {
        let result = match error {
            PlaceError::Terrain(_) | PlaceError::Frame(_) => result::UNSUPPORTED_FRAME,
            PlaceError::X => result::INVALID_PARAM5_X,
            PlaceError::Y => result::INVALID_PARAM6_Y,
            PlaceError::Z => result::INVALID_PARAM7,
        };
        self.problem(result, error.to_string())
    }

    fn frame(self) -> Result<Frame, Problem> {
        Frame::from_number(self.item.frame).map_err(|error| self.place_problem(error))
    }

    fn has_finite_parameters(self) -> Result<(), Problem> {
        let Item { param1, param2, param3, param4, z, .. } = *self.item;
        let numbers = [(1, param1), (2, param2), (3, param3), (4, param4), (7, z)];
        match numbers.into_iter().find(|(_, value)| value.is_infinite()) {
            Some((number, _)) => {
                Err(self.problem(result_of(number), format!("parameter {number} is infinite")))
            }
            None => Ok(()),
        }
    }
}

struct Translator {
    rules: Rules,
    steps: Vec<Step>,
    /// What is flown otherwise than an item says.
    limited: Vec<String>,
    /// Where the drone is after the items so far; `None` if they have no place.
    pose: Option<Pose>,
    /// Its heading then.
    yaw_deg: f64,
    /// The item behind which nothing is flown, and what it does.
    end: Option<(u16, &'static str)>,
}

impl Translator {
    fn item(&mut self, at: At<'_>) -> Result<(), Problem> {
        if at.item.mission_type != 0 {
            return Err(at.problem(result::UNSUPPORTED, "it belongs to a fence or to rally points"));
        }
        if let Some((item, what)) = self.end {
            let reason = format!("nothing is flown behind the {what} of item {item}");
            return Err(at.problem(result::UNSUPPORTED, reason));
        }
        match at.item.command {
            command::NAV_TAKEOFF | command::NAV_TAKEOFF_LOCAL => self.take_off(at),
            command::NAV_WAYPOINT => self.way_point(at),
            command::NAV_LOITER_TIME => self.loiter(at, at.stay_s()?),
            command::NAV_LOITER_UNLIM => {
                self.loiter(at, SHORT_STAY_S)?;
                self.end = Some((at.index, "endless hold"));
                Ok(())
            }
            command::NAV_DELAY | command::CONDITION_DELAY => self.delay(at),
            command::CONDITION_YAW => self.turn(at),
            command::DO_CHANGE_SPEED => self.speed(at),
            command::NAV_RETURN_TO_LAUNCH => self.return_to_launch(at),
            command::NAV_LAND | command::NAV_LAND_LOCAL => self.land(at),
            other => Err(at.problem(result::UNSUPPORTED, unsupported(other))),
        }
    }

    fn take_off(&mut self, at: At<'_>) -> Result<(), Problem> {
        at.has_finite_parameters()?;
        let place = self.place_or_here(at)?;
        let pose = self.pose.unwrap_or_default();
        let (x_m, y_m) = match place.ground_m {
            Some(ground_m) => self.inside(at, ground_m)?,
            None => (pose.x_m, pose.y_m),
        };
        self.yaw_deg = self.yaw(at)?;
        self.push(at, TAKE_OFF);
        let height_m = place.z_m.filter(|_| at.item.z != 0.0);
        let own_m = self.height_m();
        // What is outside the limits is not clamped: nobody who takes off in a room wants to be at its ceiling, and
        // QGroundControl's plans begin with a take-off to its own default height.
        let z_m = height_m.and_then(|m| self.height(at, m).ok()).unwrap_or(own_m);
        self.note_limit(at, "altitude", "m", height_m.unwrap_or(own_m), z_m);
        let pose = Pose { x_m, y_m, z_m, yaw_deg: self.yaw_deg };
        if height_m.is_some() {
            self.go_to(at, pose, REACH_M, SHORT_STAY_S);
        } else {
            // The take-off ends above the start, whatever place is named.
            self.pose = Some(self.pose.unwrap_or(Pose { z_m, ..Pose::default() }));
        }
        Ok(())
    }

    fn way_point(&mut self, at: At<'_>) -> Result<(), Problem> {
        at.has_finite_parameters()?;
        let (stay_s, reach_m) = (at.stay_s()?, at.reach_m()?);
        if at.frame()? == Frame::Mission {
            let reason =
                "a way-point needs a frame with a place: 3, 0, or a local one (1, 4, 20, 21)";
            return Err(at.problem(result::UNSUPPORTED_FRAME, reason));
        }
        let place = self.place(at)?;
        let pose = self.destination(at, &place)?;
        self.go_to(at, pose, reach_m, stay_s);
        Ok(())
    }

    fn loiter(&mut self, at: At<'_>, stay_s: f64) -> Result<(), Problem> {
        at.has_finite_parameters()?;
        let mut place = self.place_or_here(at)?;
        if place.ground_m.is_none() && at.item.z == 0.0 {
            place.z_m = None;
        }
        if place == Place::default() {
            self.stay(at, stay_s);
            return Ok(());
        }
        // Its fourth parameter is no yaw.
        let keep = Item { param4: f32::NAN, ..*at.item };
        let at = At { index: at.index, item: &keep };
        let pose = self.destination(at, &place)?;
        self.go_to(at, pose, REACH_M, stay_s);
        Ok(())
    }

    fn delay(&mut self, at: At<'_>) -> Result<(), Problem> {
        at.has_finite_parameters()?;
        if at.item.command == command::NAV_DELAY && at.param(1) == Some(-1.0) {
            let reason = "a delay until a time of day is not supported: give the seconds";
            return Err(at.problem(result::INVALID_PARAM1, reason));
        }
        let stay_s = at.stay_s()?;
        self.stay(at, stay_s);
        Ok(())
    }

    fn turn(&mut self, at: At<'_>) -> Result<(), Problem> {
        at.has_finite_parameters()?;
        let angle_deg = match at.param(1) {
            Some(angle_deg) if angle_deg.abs() <= 360.0 => angle_deg,
            _ => {
                let reason = "an angle from 0 to 360 degrees is needed";
                return Err(at.problem(result::INVALID_PARAM1, reason));
            }
        };
        let direction = at.choice(3, 0.0, &[-1.0, 0.0, 1.0])?;
        let is_relative = at.choice(4, 0.0, &[0.0, 1.0])? > 0.5;
        let Some(pose) = self.pose else {
            let reason = "a turn needs an item with a place, or a take-off, before it";
            return Err(at.problem(result::DENIED, reason));
        };
        let by_deg = if is_relative {
            if direction < 0.0 { -angle_deg } else { angle_deg }
        } else {
            let by_deg = wrap_deg(angle_deg - self.rules.origin.heading_deg - self.yaw_deg);
            match direction {
                ..0.0 => -(-by_deg).rem_euclid(360.0),
                0.0 => by_deg,
                _ => by_deg.rem_euclid(360.0),
            }
        };
        let from_deg = self.yaw_deg;
        let parts = (by_deg.abs() / LONGEST_TURN_DEG).ceil().max(1.0);
        for part in (1_u8..).map(f64::from).take_while(|part| *part <= parts) {
            self.yaw_deg = wrap_deg(from_deg + by_deg * part / parts);
            self.go_to(at, Pose { yaw_deg: self.yaw_deg, ..pose }, REACH_M, SHORT_STAY_S);
        }
        Ok(())
    }

    fn speed(&mut self, at: At<'_>) -> Result<(), Problem> {
        at.has_finite_parameters()?;
        at.choice(1, 1.0, &[0.0, 1.0])?;
        let (slowest_m_s, _) = SPEEDS_M_S;
        let fastest_m_s = self.rules.max_speed_m_s;
        let limit_m_s = match at.param(2) {
            None | Some(-1.0) => return Ok(()),
            Some(-2.0) => fastest_m_s,
            Some(speed_m_s) if speed_m_s >= 0.0 => {
                let limit_m_s = speed_m_s.max(slowest_m_s).min(fastest_m_s);
                self.note_limit(at, "speed", "m/s", speed_m_s, limit_m_s);
                limit_m_s
            }
            Some(speed_m_s) => {
                let reason = format!("a speed of {} m/s is negative", Figures(speed_m_s));
                return Err(at.problem(result::INVALID_PARAM2, reason));
            }
        };
        self.push(at, Command::SetSpeed { speed_m_s: short(limit_m_s) });
        Ok(())
    }

    fn return_to_launch(&mut self, at: At<'_>) -> Result<(), Problem> {
        at.has_finite_parameters()?;
        let pose = Pose { z_m: self.height_m(), yaw_deg: self.yaw_deg, ..Pose::default() };
        self.go_to(at, pose, REACH_M, SHORT_STAY_S);
        self.push(at, Command::Land);
        self.end = Some((at.index, "landing"));
        Ok(())
    }

    fn land(&mut self, at: At<'_>) -> Result<(), Problem> {
        at.has_finite_parameters()?;
        if let Some(ground_m) = self.place_or_here(at)?.ground_m {
            let (x_m, y_m) = self.inside(at, ground_m)?;
            let pose = Pose { x_m, y_m, z_m: self.height_m(), yaw_deg: self.yaw(at)? };
            self.go_to(at, pose, REACH_M, SHORT_STAY_S);
        }
        self.push(at, Command::Land);
        self.end = Some((at.index, "landing"));
        Ok(())
    }

    /// Notes that a quantity was moved into its limits, if it was.
    fn note_limit(&mut self, at: At<'_>, what: &str, unit: &str, wanted: f64, flown: f64) {
        if (wanted - flown).abs() > 0.01 {
            let (flown, wanted) = (Figures(flown), Figures(wanted));
            let note = format!("{}: {what} {flown:.2} {unit}, not {wanted:.2}", at.named());
            self.limited.push(note);
        }
    }

    fn push(&mut self, at: At<'_>, command: Command) {
        self.steps.push(Step { item: at.index, command });
    }

    fn target(&mut self, at: At<'_>, reach_m: f64, stay_s: f64, target: Command) {
        // A drone that has just reached its target must not be too far from it to stay.
        let stay_within_m = (reach_m + 0.3).max(0.5);
        self.push(at, Command::SetReachDistance { distance_m: short(reach_m) });
        self.push(at, Command::SetStayDistance { distance_m: short(stay_within_m) });
        self.push(at, Command::SetStayTime { time_s: short(stay_s) });
        self.push(at, target);
    }

    fn go_to(&mut self, at: At<'_>, pose: Pose, reach_m: f64, stay_s: f64) {
        self.pose = Some(pose);
        self.yaw_deg = pose.yaw_deg;
        self.target(at, reach_m, stay_s, Command::GoTo(short_pose(&pose)));
    }

    fn stay(&mut self, at: At<'_>, stay_s: f64) {
        match self.pose {
            Some(pose) => {
                let pose = Pose { yaw_deg: self.yaw_deg, ..pose };
                self.go_to(at, pose, REACH_M, stay_s);
            }
            // Where the drone is.
            None => {
                self.target(at, REACH_M, stay_s, Command::MoveByRelative(Pose::default()));
            }
        }
    }

    fn place(&self, at: At<'_>) -> Result<Place, Problem> {
        let Item { frame, x, y, z, .. } = *at.item;
        self.rules.origin.place(frame, x, y, z).map_err(|error| at.place_problem(error))
    }

    /// As [`Self::place`], for commands in which zeros on the globe stand for no place.
    fn place_or_here(&self, at: At<'_>) -> Result<Place, Problem> {
        let mut place = self.place(at)?;
        if at.item.x == 0 && at.item.y == 0 && at.frame()?.is_global() {
            place.ground_m = None;
        }
        Ok(place)
    }

    /// Where an item leads that may leave out coordinates.
    fn destination(&self, at: At<'_>, place: &Place) -> Result<Pose, Problem> {
        let missing = |result, what| {
            at.problem(result, format!("it has no {what}, and no item before it has one"))
        };
        let (x_m, y_m) = match (place.ground_m, self.pose) {
            (Some(ground_m), _) => self.inside(at, ground_m)?,
            (None, Some(pose)) => (pose.x_m, pose.y_m),
            (None, None) => return Err(missing(result::INVALID_PARAM5_X, "place")),
        };
        let z_m = match (place.z_m, self.pose) {
            (Some(z_m), _) => self.height(at, z_m)?,
            (None, Some(pose)) => pose.z_m,
            (None, None) => return Err(missing(result::INVALID_PARAM7, "height")),
        };
        Ok(Pose { x_m, y_m, z_m, yaw_deg: self.yaw(at)? })
    }

    /// The item's fourth parameter, or the heading so far.
    fn yaw(&self, at: At<'_>) -> Result<f64, Problem> {
        let Some(yaw) = at.param(4) else { return Ok(self.yaw_deg) };
        let is_in_radians =
            matches!(at.item.command, command::NAV_TAKEOFF_LOCAL | command::NAV_LAND_LOCAL);
        let yaw_deg = if is_in_radians { yaw.to_degrees() } else { yaw };
        let north_deg = match at.frame()? {
            Frame::LocalFrd | Frame::LocalFlu => 0.0,
            _ => self.rules.origin.heading_deg,
        };
        Ok(wrap_deg(yaw_deg - north_deg))
    }

    /// A place inside the fence, so that it is still there with few digits.
    fn inside(&self, at: At<'_>, (x_m, y_m): (f64, f64)) -> Result<(f64, f64), Problem> {
        let (border, place_m) = (&self.rules.fence.border, [x_m, y_m].into());
        if border.outside_m(place_m) > GRID_M {
            return Err(at.problem(result::INVALID_PARAM5_X, border.how_far(place_m)));
        }
        let from_m = self.pose.map(|pose| [pose.x_m, pose.y_m].into());
        if from_m.is_some_and(|from_m| border.leaves_at(from_m, place_m, GRID_M).is_some()) {
            let reason = "the straight way to it leaves the fence: put a way-point before it";
            return Err(at.problem(result::INVALID_PARAM5_X, reason));
        }
        let inside_m = border.nearest_inside(place_m, 2.0 / DIGITS);
        Ok((inside_m.x, inside_m.y))
    }

    fn height(&self, at: At<'_>, z_m: f64) -> Result<f64, Problem> {
        let FlightLimits { floor_m, ceiling_m, .. } = self.rules.fence;
        if (floor_m - GRID_M..=ceiling_m + GRID_M).contains(&z_m) {
            return Ok(self.clamped(z_m));
        }
        let reason = format!(
            "{:.2} m above the floor at the start, not between {} and {} m",
            Figures(z_m),
            Figures(floor_m),
            Figures(ceiling_m)
        );
        Err(at.problem(result::INVALID_PARAM7, reason))
    }

    /// The nearest height inside the fence that few digits can tell.
    fn clamped(&self, z_m: f64) -> f64 {
        let FlightLimits { floor_m, ceiling_m, .. } = self.rules.fence;
        let lowest_m = (floor_m * DIGITS - 1e-6).ceil() / DIGITS;
        let highest_m = (ceiling_m * DIGITS + 1e-6).floor() / DIGITS;
        z_m.max(lowest_m).min(highest_m)
    }

    /// The height so far, or that after a take-off.
    fn height_m(&self) -> f64 {
        self.clamped(self.pose.map_or(HOVER_M, |pose| pose.z_m))
    }
}

/// A number with few digits, and never -0: it is shown to people.
pub(crate) fn short(number: f64) -> f64 {
    (number * DIGITS).round() / DIGITS + 0.0
}

pub(crate) fn short_pose(pose: &Pose) -> Pose {
    let [x_m, y_m, z_m, yaw_deg] = [pose.x_m, pose.y_m, pose.z_m, pose.yaw_deg].map(short);
    Pose { x_m, y_m, z_m, yaw_deg }
}

/// What is answered if a parameter other than a place is wrong.
fn result_of(parameter: u8) -> MavMissionResult {
    match parameter {
        1 => result::INVALID_PARAM1,
        2 => result::INVALID_PARAM2,
        3 => result::INVALID_PARAM3,
        4 => result::INVALID_PARAM4,
        _ => result::INVALID_PARAM7,
    }
}

/// What QGroundControl calls an item with this command.
fn name_of(command: u16) -> Option<&'static str> {
    Some(match command {
        command::NAV_WAYPOINT => "Waypoint",
        command::NAV_LOITER_UNLIM => "Loiter",
        command::NAV_LOITER_TIME => "Loiter Time",
        command::NAV_RETURN_TO_LAUNCH => "Return To Launch",
        command::NAV_LAND | command::NAV_LAND_LOCAL => "Land",
        command::NAV_TAKEOFF | command::NAV_TAKEOFF_LOCAL => "Takeoff",
        command::NAV_DELAY | command::CONDITION_DELAY => "Delay",
        command::CONDITION_YAW => "Change heading",
        command::DO_CHANGE_SPEED => "Change speed",
        177 => "Jump To Item",
        195 | 201 => "Region of interest",
        _ => return None,
    })
}

/// Why this command is refused.
fn unsupported(command: u16) -> String {
    let what = match command {
        177 => "jumps (DO_JUMP)",
        530 | 203 | 206 | 214 | 2000 | 2001 | 2500 | 2501 => "camera commands",
        204 | 205 | 1000 | 1001 => "gimbal commands",
        195 | 197 | 201 => "regions of interest",
        18 | 31 => "circles",
        82 => "splines",
        _ => return format!("command {command} is not supported"),
    };
    format!("{what} are not supported (command {command})")
}

#[cfg(test)]
mod tests;
