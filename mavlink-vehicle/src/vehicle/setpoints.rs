//! Setpoints (`SET_POSITION_TARGET_*`) in our frame, and those that sticks ask for (`MANUAL_CONTROL`).

use autopilot::vehicle::{Heading, Horizontal, Setpoint, Vertical};
use kinematics::{Pose, world_from_body};
use nalgebra::Vector2;

use crate::dialect::{
    MANUAL_CONTROL_DATA, PositionTargetTypemask as Mask, SET_POSITION_TARGET_GLOBAL_INT_DATA,
    SET_POSITION_TARGET_LOCAL_NED_DATA,
};
use crate::place::Origin;

/// Why a setpoint is not followed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub(crate) enum NoSetpoint {
    #[error("setpoints in frame {0} are not supported")]
    Frame(u8),
    #[error("accelerations and forces are not supported: set their bits in type_mask")]
    Acceleration,
    #[error("it says nothing: position and velocity are both ignored")]
    Nothing,
    #[error("one of its numbers is not finite")]
    NotFinite,
    #[error("the drone's position is not known")]
    NoPlace,
}

const ACCELERATION: Mask = Mask::POSITION_TARGET_TYPEMASK_AX_IGNORE
    .union(Mask::POSITION_TARGET_TYPEMASK_AY_IGNORE)
    .union(Mask::POSITION_TARGET_TYPEMASK_AZ_IGNORE);
const PLACE: Mask =
    Mask::POSITION_TARGET_TYPEMASK_X_IGNORE.union(Mask::POSITION_TARGET_TYPEMASK_Y_IGNORE);
const VELOCITY: Mask =
    Mask::POSITION_TARGET_TYPEMASK_VX_IGNORE.union(Mask::POSITION_TARGET_TYPEMASK_VY_IGNORE);

/// What the two kinds of setpoints have in common.
struct Fields {
    mask: Mask,
    velocity: [f32; 3],
    yaw: f32,
    yaw_rate: f32,
}

macro_rules! fields {
    ($data:expr) => {
        Fields {
            mask: $data.type_mask,
            velocity: [$data.vx, $data.vy, $data.vz],
            yaw: $data.yaw,
            yaw_rate: $data.yaw_rate,
        }
    };
}

impl Fields {
    fn wants(&self, mask: Mask) -> bool {
        !self.mask.intersects(mask)
    }

    /// Only numbers that are not ignored must be finite.
    fn number(value: f32) -> Result<f64, NoSetpoint> {
        if value.is_finite() { Ok(value.into()) } else { Err(NoSetpoint::NotFinite) }
    }

    fn velocity(&self) -> Result<[f64; 3], NoSetpoint> {
        let [x, y, z] = self.velocity;
        let or_zero = |value, wanted: bool| if wanted { Self::number(value) } else { Ok(0.0) };
        let level = self.wants(VELOCITY);
        let climb = self.wants(Mask::POSITION_TARGET_TYPEMASK_VZ_IGNORE);
        Ok([or_zero(x, level)?, or_zero(y, level)?, or_zero(z, climb)?])
    }

    fn checked(self) -> Result<Self, NoSetpoint> {
        if !self.mask.contains(ACCELERATION)
            || self.mask.contains(Mask::POSITION_TARGET_TYPEMASK_FORCE_SET)
        {
            return Err(NoSetpoint::Acceleration);
        }
        let height = Mask::POSITION_TARGET_TYPEMASK_Z_IGNORE;
        let climb = Mask::POSITION_TARGET_TYPEMASK_VZ_IGNORE;
        let turn = Mask::POSITION_TARGET_TYPEMASK_YAW_IGNORE;
        let rate = Mask::POSITION_TARGET_TYPEMASK_YAW_RATE_IGNORE;
        let all = [PLACE, VELOCITY, height, climb, turn, rate];
        if all.into_iter().any(|part| self.wants(part)) {
            Ok(self)
        } else {
            Err(NoSetpoint::Nothing)
        }
    }

    fn heading(&self, yaw_deg: impl Fn(f64) -> f64) -> Result<Heading, NoSetpoint> {
        if self.wants(Mask::POSITION_TARGET_TYPEMASK_YAW_IGNORE) {
            // MAVSDK and others send NaN for "as it is".
            return Ok(if self.yaw.is_nan() {
                Heading::Keep
            } else {
                Heading::Yaw(yaw_deg(Self::number(self.yaw)?))
            });
        }
        if self.wants(Mask::POSITION_TARGET_TYPEMASK_YAW_RATE_IGNORE) {
            return Ok(Heading::Turn(Self::number(self.yaw_rate)?.to_degrees()));
        }
        Ok(Heading::Keep)
    }
}

/// A setpoint in a local frame; the drone is at `pose`.
pub(crate) fn local(
    data: &SET_POSITION_TARGET_LOCAL_NED_DATA,
    origin: &Origin,
    pose: Option<&Pose>,
) -> Result<Setpoint, NoSetpoint> {
    let fields = fields!(data).checked()?;
    let (body, offset) = match data.coordinate_frame {
        1 => (false, false),
        7 => (false, true),
        9 | 12 => (true, true),
        // Whether its positions are offsets is not agreed upon: only velocities.
        8 if !fields.wants(PLACE) => (true, true),
        frame => return Err(NoSetpoint::Frame(frame)),
    };
    let [north, east, down] = fields.velocity()?;
    let place = if fields.wants(PLACE) {
        let (north_m, east_m) = (Fields::number(data.x)?, Fields::number(data.y)?);
        let pose = || pose.ok_or(NoSetpoint::NoPlace);
        let (x_m, y_m) = origin.right_forward(north_m, east_m);
        Some(match (offset, body) {
            (false, _) => (x_m, y_m),
            (true, false) => (pose()?.x_m + x_m, pose()?.y_m + y_m),
            // Forward and right of the drone.
            (true, true) => {
                let pose = pose()?;
                let way = world_from_body(Vector2::new(east_m, north_m), pose.yaw_deg);
                (pose.x_m + way.x, pose.y_m + way.y)
            }
        })
    } else {
        None
    };
    let horizontal = match place {
        Some((x_m, y_m)) => Horizontal::Place { x_m, y_m },
        None if body => Horizontal::BodyVelocity { right_m_s: east, forward_m_s: north },
        None => level_velocity(origin, north, east),
    };
    let vertical = if fields.wants(Mask::POSITION_TARGET_TYPEMASK_Z_IGNORE) {
        let up_m = -Fields::number(data.z)?;
        let from_m = if offset { pose.ok_or(NoSetpoint::NoPlace)?.z_m } else { 0.0 };
        Vertical::Height(from_m + up_m)
    } else {
        Vertical::Climb(-down)
    };
    let heading = fields.heading(|yaw_rad| {
        let present_deg = pose.map_or(0.0, |pose| pose.yaw_deg);
        if body { present_deg + yaw_rad.to_degrees() } else { origin.yaw_deg(yaw_rad) }
    })?;
    Ok(Setpoint { horizontal, vertical, heading })
}

/// A setpoint by latitude and longitude.
pub(crate) fn global(
    data: &SET_POSITION_TARGET_GLOBAL_INT_DATA,
    origin: &Origin,
) -> Result<Setpoint, NoSetpoint> {
    let fields = fields!(data).checked()?;
    let frame = data.coordinate_frame;
    if !matches!(frame, 0 | 3 | 5 | 6) {
        return Err(NoSetpoint::Frame(frame));
    }
    let place = origin
        .place(frame, data.lat_int, data.lon_int, data.alt)
        .map_err(|_| NoSetpoint::NotFinite)?;
    let [north, east, down] = fields.velocity()?;
    let horizontal = if fields.wants(PLACE) {
        let (x_m, y_m) = place.ground_m.ok_or(NoSetpoint::NotFinite)?;
        Horizontal::Place { x_m, y_m }
    } else {
        level_velocity(origin, north, east)
    };
    let vertical = if fields.wants(Mask::POSITION_TARGET_TYPEMASK_Z_IGNORE) {
        Vertical::Height(place.z_m.ok_or(NoSetpoint::NotFinite)?)
    } else {
        Vertical::Climb(-down)
    };
    let heading = fields.heading(|yaw_rad| origin.yaw_deg(yaw_rad))?;
    Ok(Setpoint { horizontal, vertical, heading })
}

fn level_velocity(origin: &Origin, north_m_s: f64, east_m_s: f64) -> Horizontal {
    let (x_m_s, y_m_s) = origin.right_forward(north_m_s, east_m_s);
    Horizontal::Velocity { x_m_s, y_m_s }
}

/// What full sticks mean: in m/s along the ground and up, and in degrees/s.
const FULL_SPEED_M_S: f64 = 1.5;
const FULL_CLIMB_M_S: f64 = 0.5;
const FULL_TURN_DEG_S: f64 = 60.0;
/// Thousandths of the sticks: full, and around the neutral position of the throttle.
const FULL: f64 = 1000.0;
const NEUTRAL: f64 = 500.0;
/// Share of a stick's way around neutral that means: nothing.
const DEAD_ZONE: f64 = 0.1;

/// The sticks of one who flies by hand. The throttle counts only after it was seen in the middle with all others at rest: a
/// joystick whose throttle rests at the bottom must not begin with a descent.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Joystick {
    centred: bool,
}

impl Joystick {
    /// The velocity that the sticks ask for; axes that are absent (`INT16_MAX`) are at rest.
    pub(crate) fn setpoint(&mut self, data: &MANUAL_CONTROL_DATA) -> Setpoint {
        let axis = |value: i16| {
            let value = if value == i16::MAX { 0.0 } else { f64::from(value) };
            (value / FULL).clamp(-1.0, 1.0)
        };
        let (forward, right, turn) = (axis(data.x), axis(data.y), axis(data.r));
        let throttle = if data.z == i16::MAX { NEUTRAL } else { f64::from(data.z) };
        let up = ((throttle - NEUTRAL) / NEUTRAL).clamp(-1.0, 1.0);
        let rests = [forward, right, turn].into_iter().all(|stick| stick.abs() <= DEAD_ZONE);
        // 400 to 600.
        self.centred |= rests && up.abs() <= 2.0 * DEAD_ZONE;
        let up = if self.centred { up } else { 0.0 };
        let [forward, right, turn, up] = [forward, right, turn, up].map(beyond_dead_zone);
        Setpoint {
            horizontal: Horizontal::BodyVelocity {
                right_m_s: right * FULL_SPEED_M_S,
                forward_m_s: forward * FULL_SPEED_M_S,
            },
            vertical: Vertical::Climb(up * FULL_CLIMB_M_S),
            heading: Heading::Turn(turn * FULL_TURN_DEG_S),
        }
    }
}

fn beyond_dead_zone(stick: f64) -> f64 {
    let beyond = (stick.abs() - DEAD_ZONE).max(0.0) / (1.0 - DEAD_ZONE);
    if stick < 0.0 { -beyond } else { beyond }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NORTH: Origin =
        Origin { latitude_deg: 47.0, longitude_deg: 8.0, altitude_m: 500.0, heading_deg: 0.0 };

    fn data(frame: u8, mask: u16) -> SET_POSITION_TARGET_LOCAL_NED_DATA {
        SET_POSITION_TARGET_LOCAL_NED_DATA {
            coordinate_frame: frame,
            type_mask: Mask::from_bits_truncate(mask),
            x: 1.0,
            y: 2.0,
            z: -1.5,
            vx: 0.5,
            vy: 0.25,
            vz: -0.125,
            yaw: std::f32::consts::FRAC_PI_2,
            yaw_rate: 1.0,
            ..SET_POSITION_TARGET_LOCAL_NED_DATA::default()
        }
    }

    const HERE: Pose = Pose { x_m: 10.0, y_m: 20.0, z_m: 1.0, yaw_deg: 90.0 };

    #[track_caller]
    fn assert_place(setpoint: &Setpoint, x_m: f64, y_m: f64) {
        let Horizontal::Place { x_m: x, y_m: y } = setpoint.horizontal else {
            panic!("{setpoint:?}")
        };
        assert!((x - x_m).abs() + (y - y_m).abs() < 1e-9, "{setpoint:?}");
    }

    /// The masks are those that MAVSDK sends.
    #[test]
    fn positions_are_north_east_down() {
        let found = local(&data(1, 2552), &NORTH, None).unwrap();
        assert_place(&found, 2.0, 1.0);
        assert_eq!(found.vertical, Vertical::Height(1.5));
        assert!(matches!(found.heading, Heading::Yaw(yaw) if (yaw - 90.0).abs() < 1e-4));
        // The start looked to the east: what is north of it is to its left.
        let east = Origin { heading_deg: 90.0, ..NORTH };
        assert_place(&local(&data(1, 2552), &east, None).unwrap(), -1.0, 2.0);
        // Offsets count from the drone, along the axes or along its heading.
        assert_place(&local(&data(7, 2552), &NORTH, Some(&HERE)).unwrap(), 12.0, 21.0);
        assert_place(&local(&data(9, 2552), &NORTH, Some(&HERE)).unwrap(), 11.0, 18.0);
        assert_eq!(local(&data(7, 2552), &NORTH, None), Err(NoSetpoint::NoPlace));
    }

    #[test]
    fn velocities_are_north_east_down_or_seen_from_the_drone() {
        let found = local(&data(1, 0b0101_1100_0111), &NORTH, None).unwrap();
        assert_eq!(found.horizontal, Horizontal::Velocity { x_m_s: 0.25, y_m_s: 0.5 });
        assert_eq!(found.vertical, Vertical::Climb(0.125));
        assert!(matches!(found.heading, Heading::Turn(turn) if (turn - 57.2958).abs() < 1e-3));
        let found = local(&data(8, 0b0101_1100_0111), &NORTH, None).unwrap();
        let seen = Horizontal::BodyVelocity { right_m_s: 0.25, forward_m_s: 0.5 };
        assert_eq!(found.horizontal, seen);
        assert_eq!(local(&data(8, 2552), &NORTH, None), Err(NoSetpoint::Frame(8)));
    }

    #[test]
    fn what_makes_no_sense_is_refused() {
        assert_eq!(local(&data(1, 0), &NORTH, None), Err(NoSetpoint::Acceleration));
        assert_eq!(local(&data(1, 0x0fff), &NORTH, None), Err(NoSetpoint::Acceleration));
        assert_eq!(local(&data(1, 0x0dff), &NORTH, None), Err(NoSetpoint::Nothing));
        let nowhere = SET_POSITION_TARGET_LOCAL_NED_DATA { x: f32::NAN, ..data(1, 2552) };
        assert_eq!(local(&nowhere, &NORTH, None), Err(NoSetpoint::NotFinite));
        // What is ignored may be anything.
        let odd = SET_POSITION_TARGET_LOCAL_NED_DATA { vx: f32::NAN, ..data(1, 2552) };
        assert!(local(&odd, &NORTH, None).is_ok());
    }

    #[test]
    fn places_on_the_globe_count_from_the_origin() {
        let place = SET_POSITION_TARGET_GLOBAL_INT_DATA {
            coordinate_frame: 6,
            type_mask: Mask::from_bits_truncate(2552),
            lat_int: 470_000_000 + 899,
            lon_int: 80_000_000,
            alt: 1.2,
            ..SET_POSITION_TARGET_GLOBAL_INT_DATA::default()
        };
        let found = global(&place, &NORTH).unwrap();
        let Horizontal::Place { x_m, y_m } = found.horizontal else { panic!("{found:?}") };
        assert!(x_m.abs() < 0.01 && (y_m - 10.0).abs() < 0.01, "{found:?}");
        assert!(matches!(found.vertical, Vertical::Height(z_m) if (z_m - 1.2).abs() < 1e-6));
        let terrain = SET_POSITION_TARGET_GLOBAL_INT_DATA { coordinate_frame: 11, ..place };
        assert_eq!(global(&terrain, &NORTH), Err(NoSetpoint::Frame(11)));
    }

    #[test]
    fn sticks_are_velocities() {
        let mut joystick = Joystick::default();
        let stick = |x, y, z, r| MANUAL_CONTROL_DATA { x, y, z, r, ..Default::default() };
        let found = joystick.setpoint(&stick(1000, -550, 500, 1000));
        let Horizontal::BodyVelocity { right_m_s, forward_m_s } = found.horizontal else {
            panic!("{found:?}")
        };
        assert!((forward_m_s - 1.5).abs() < 1e-9 && (right_m_s + 0.75).abs() < 1e-9, "{found:?}");
        assert_eq!(found.heading, Heading::Turn(60.0));
        let absent = joystick.setpoint(&stick(i16::MAX, i16::MAX, i16::MAX, i16::MAX));
        let still = Horizontal::BodyVelocity { right_m_s: 0.0, forward_m_s: 0.0 };
        assert_eq!((absent.horizontal, absent.vertical), (still, Vertical::Climb(0.0)));
        let beyond = joystick.setpoint(&stick(i16::MIN, 0, i16::MIN, 0));
        let back = Horizontal::BodyVelocity { right_m_s: 0.0, forward_m_s: -1.5 };
        assert_eq!(beyond.horizontal, back);
    }

    #[test]
    fn a_throttle_counts_once_it_was_in_the_middle() {
        let mut joystick = Joystick::default();
        let mut climb = |x, z| {
            let data = MANUAL_CONTROL_DATA { x, z, ..Default::default() };
            joystick.setpoint(&data).vertical
        };
        assert_eq!(climb(500, 0), Vertical::Climb(0.0));
        assert_eq!(climb(500, 500), Vertical::Climb(0.0));
        assert_eq!(climb(0, 1000), Vertical::Climb(0.0));
        assert_eq!(climb(0, 500), Vertical::Climb(0.0));
        assert_eq!(climb(0, 0), Vertical::Climb(-0.5));
        assert_eq!(climb(0, 1000), Vertical::Climb(0.5));
        assert_eq!(climb(0, 540), Vertical::Climb(0.0));
    }
}
