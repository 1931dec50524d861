//! Motion of the drone: tilt, thrust, drag and turn, by one of the published models.
//!
//! World frame: x right, y forward, z up, metres; yaw in radians, clockwise from above.
//! Angles: pitch nose up, roll right side down.

mod near;
mod profile;

use std::time::Duration;

use nalgebra::{Vector2, Vector3};

pub use profile::{AttitudeLoop, Profile, Scaling, ThrustLaw};

/// Gravity.
pub const GRAVITY_M_S2: f64 = 9.81;
/// Mass with the hull for rooms (Parrot: 380 g with the outer hull, 420 g with this one).
pub const MASS_KG: f64 = 0.42;
/// Drag of the drone in air that comes from above: its drag coefficient times the area that is solid, about a quarter of the
/// hull's 0.52 m by 0.52 m. In 4.6 m/s, 1 m below another drone, it is a quarter of the weight; for drones of 34 g Shi et al.
/// (2020, *Neural-Swarm*) measured an eighth to a third.
const DRAG_AREA_FROM_ABOVE_M2: f64 = 1.18 * 0.07;
/// Density of the air at sea level.
pub(crate) const AIR_KG_M3: f64 = 1.225;
/// Integration step; the attitude loop has 12 rad/s, so this is fine enough for Euler.
pub const STEP_S: f64 = 0.0025;

/// The firmware's command to the motors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Thrust {
    /// Motors off: the drone stands or falls.
    Off,
    /// Motors on.
    On(Attitude),
}

/// A demand for attitude, climb and turn.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Attitude {
    /// Nose up.
    pub pitch_rad: f64,
    /// Right side down.
    pub roll_rad: f64,
    /// Up.
    pub climb_m_s: f64,
    /// Clockwise.
    pub turn_rad_s: f64,
}

/// The drone as a rigid body.
#[derive(Debug, Clone)]
pub struct Airframe {
    profile: Profile,
    position_m: Vector3<f64>,
    velocity_m_s: Vector3<f64>,
    pitch: Tilt,
    roll: Tilt,
    yaw_rad: f64,
    turn_rad_s: f64,
    trim_rad: Vector2<f64>,
    motor: Motor,
    /// Speed of the air that comes from above.
    downwash_m_s: f64,
    floor_contacts: u32,
    touch_down_m_s: Option<f64>,
}

/// A motor that may weaken: the drone tilts to its side, sinks, and responds less.
#[derive(Debug, Clone, Copy)]
struct Motor {
    /// Remaining fraction of its thrust, from 0 to 1.
    share: f64,
    goal: f64,
    change_1_s: f64,
}

impl Motor {
    const HEALTHY: Self = Self { share: 1.0, goal: 1.0, change_1_s: 0.0 };
    /// Tilt and sink rate if a motor had no thrust at all. A crude model, sufficient as a disturbance.
    const LEAN_RAD: f64 = 0.3;
    const SINK_M_S: f64 = 1.5;

    fn step(&mut self) {
        let left = self.goal - self.share;
        self.share += left.signum() * (self.change_1_s * STEP_S).min(left.abs());
    }

    /// The demand as the weakened drone carries it out.
    fn carry_out(&self, demand: &Attitude) -> Attitude {
        let lost = 1.0 - self.share;
        Attitude {
            pitch_rad: demand.pitch_rad * self.share,
            roll_rad: demand.roll_rad * self.share + lost * Self::LEAN_RAD,
            climb_m_s: demand.climb_m_s * self.share - lost * Self::SINK_M_S,
            turn_rad_s: demand.turn_rad_s * self.share,
        }
    }
}

#[derive(Debug, Clone, Copy, Default)]
struct Tilt {
    angle_rad: f64,
    rate_rad_s: f64,
}

impl Tilt {
    fn step(&mut self, attitude: AttitudeLoop, demand_rad: f64) {
        (self.angle_rad, self.rate_rad_s) =
            attitude.step(self.angle_rad, self.rate_rad_s, demand_rad);
    }
}

impl Airframe {
    const MAX_CLIMB_ACCELERATION_M_S2: f64 = 4.0;

    /// A drone on the ground at the origin. `trim_rad` is the unknown error of its level reference (roll,
    /// pitch).
    pub fn new(profile: Profile, trim_rad: Vector2<f64>) -> Self {
        Self {
            profile,
            position_m: Vector3::zeros(),
            velocity_m_s: Vector3::zeros(),
            pitch: Tilt::default(),
            roll: Tilt::default(),
            yaw_rad: 0.0,
            turn_rad_s: 0.0,
            trim_rad,
            motor: Motor::HEALTHY,
            downwash_m_s: 0.0,
            floor_contacts: 0,
            touch_down_m_s: None,
        }
    }

    /// The same drone, at rest at this height above the origin.
    #[must_use]
    pub fn at_height(mut self, height_m: f64) -> Self {
        self.position_m.z = height_m.max(0.0);
        self
    }

    /// Weakens a motor on the right to this fraction of its thrust, from 0 to 1, over a time.
    pub fn weaken_motor(&mut self, share: f64, within: Duration) {
        let motor = &mut self.motor;
        motor.goal = share.clamp(0.0, 1.0);
        let change = (motor.goal - motor.share).abs();
        motor.change_1_s = change / within.as_secs_f64().max(STEP_S);
    }

    /// Sets the speed of the air that comes from above, from another drone: it pushes the drone down while it is in the air.
    pub fn set_downwash(&mut self, down_m_s: f64) {
        self.downwash_m_s = down_m_s;
    }

    /// Advances by one step of [`STEP_S`] seconds, in a wind that blows towards (right, forward).
    pub fn step(&mut self, thrust: Thrust, wind_m_s: Vector2<f64>) {
        let was_up = self.position_m.z > 0.0;
        self.motor.step();
        match thrust {
            Thrust::On(demand) => self.fly(&self.motor.carry_out(&demand), wind_m_s),
            Thrust::Off => self.fall(wind_m_s),
        }
        if self.position_m.z <= 0.0 {
            if was_up {
                self.floor_contacts += 1;
                self.touch_down_m_s = Some(-self.velocity_m_s.z);
            }
            self.position_m.z = 0.0;
            self.velocity_m_s.z = self.velocity_m_s.z.max(0.0);
            if thrust == Thrust::Off {
                self.come_to_rest();
            } else {
                // On the ground with running motors: no sliding.
                self.velocity_m_s.x = 0.0;
                self.velocity_m_s.y = 0.0;
            }
        }
    }

    fn fly(&mut self, demand: &Attitude, wind_m_s: Vector2<f64>) {
        let profile = self.profile;
        self.roll.step(profile.roll, demand.roll_rad + self.trim_rad.x);
        self.pitch.step(profile.pitch, demand.pitch_rad + self.trim_rad.y);
        self.turn_rad_s +=
            (demand.turn_rad_s - self.turn_rad_s) / profile.turn_time_constant_s * STEP_S;
        self.yaw_rad += self.turn_rad_s * STEP_S;

        let thrust = profile.thrust.acceleration_m_s2(self.roll.angle_rad, self.pitch.angle_rad);
        let body = thrust - self.drag_m_s2(wind_m_s);
        let climb = ((demand.climb_m_s - self.velocity_m_s.z) / profile.climb_time_constant_s)
            .clamp(-Self::MAX_CLIMB_ACCELERATION_M_S2, Self::MAX_CLIMB_ACCELERATION_M_S2);
        let vertical = climb - self.push_down_m_s2();
        self.accelerate(world_from_body(body.x, body.y, self.yaw_rad).push(vertical));
    }

    /// (right, forward) in the levelled body frame.
    fn drag_m_s2(&self, wind_m_s: Vector2<f64>) -> Vector2<f64> {
        let air = self.velocity_m_s.xy() - wind_m_s;
        let air = body_from_world(air.x, air.y, self.yaw_rad);
        let quadratic = self.profile.quadratic_drag_1_m * air.norm();
        air.component_mul(&self.profile.linear_drag_1_s.add_scalar(quadratic))
    }

    fn fall(&mut self, wind_m_s: Vector2<f64>) {
        let flying = self.position_m.z > 0.0;
        let drag = if flying { self.drag_m_s2(wind_m_s) } else { Vector2::zeros() };
        self.turn_rad_s = 0.0;
        let drag = world_from_body(drag.x, drag.y, self.yaw_rad);
        self.accelerate((-drag).push(-GRAVITY_M_S2 - self.push_down_m_s2()));
    }

    /// Drag in air that comes from above faster than the drone sinks. What the rotors lose in it is not modelled apart: the
    /// firmware, which keeps the speed of the climb, makes them faster.
    fn push_down_m_s2(&self) -> f64 {
        let is_up = self.position_m.z > 0.0;
        if self.downwash_m_s <= 0.0 || !is_up {
            return 0.0;
        }
        let air_m_s = (self.downwash_m_s + self.velocity_m_s.z).max(0.0);
        0.5 * AIR_KG_M3 * DRAG_AREA_FROM_ABOVE_M2 * air_m_s.powi(2) / MASS_KG
    }

    fn accelerate(&mut self, acceleration_m_s2: Vector3<f64>) {
        self.velocity_m_s += acceleration_m_s2 * STEP_S;
        self.position_m += self.velocity_m_s * STEP_S;
    }

    fn come_to_rest(&mut self) {
        self.velocity_m_s = Vector3::zeros();
        self.pitch = Tilt::default();
        self.roll = Tilt::default();
        self.turn_rad_s = 0.0;
    }

    /// The model of its response.
    pub fn profile(&self) -> &Profile {
        &self.profile
    }

    /// Angular rates: roll, pitch, turn.
    pub fn angular_rate_rad_s(&self) -> Vector3<f64> {
        Vector3::new(self.roll.rate_rad_s, self.pitch.rate_rad_s, self.turn_rad_s)
    }

    /// Number of contacts with the floor.
    pub fn floor_contacts(&self) -> u32 {
        self.floor_contacts
    }

    /// Sink rate at the last contact with the floor, in any phase; `None` before the first.
    pub fn touch_down_m_s(&self) -> Option<f64> {
        self.touch_down_m_s
    }

    /// Right, forward, up.
    pub fn position_m(&self) -> Vector3<f64> {
        self.position_m
    }

    /// Right, forward, up.
    pub fn velocity_m_s(&self) -> Vector3<f64> {
        self.velocity_m_s
    }

    /// (right, forward) in the levelled body frame.
    pub fn body_velocity_m_s(&self) -> Vector2<f64> {
        body_from_world(self.velocity_m_s.x, self.velocity_m_s.y, self.yaw_rad)
    }

    /// Nose up.
    pub fn pitch_rad(&self) -> f64 {
        self.pitch.angle_rad
    }

    /// Right side down.
    pub fn roll_rad(&self) -> f64 {
        self.roll.angle_rad
    }

    /// Clockwise from above, not wrapped.
    pub fn yaw_rad(&self) -> f64 {
        self.yaw_rad
    }
}

/// Rotates (right, forward) from the body to the world frame, at a clockwise heading.
pub(crate) fn world_from_body(right: f64, forward: f64, yaw_rad: f64) -> Vector2<f64> {
    let (sin, cos) = yaw_rad.sin_cos();
    Vector2::new(sin * forward + cos * right, cos * forward - sin * right)
}

/// The inverse of [`world_from_body`].
pub(crate) fn body_from_world(x: f64, y: f64, yaw_rad: f64) -> Vector2<f64> {
    let (sin, cos) = yaw_rad.sin_cos();
    Vector2::new(cos * x - sin * y, sin * x + cos * y)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fly(demand: Attitude, seconds: f64) -> Airframe {
        fly_as(Profile::rec(), demand, seconds)
    }

    fn fly_as(profile: Profile, demand: Attitude, seconds: f64) -> Airframe {
        let mut airframe = Airframe::new(profile, Vector2::zeros());
        airframe.position_m.z = 1.0;
        let mut time_s = 0.0;
        while time_s < seconds {
            airframe.step(Thrust::On(demand), Vector2::zeros());
            time_s += STEP_S;
        }
        airframe
    }

    #[test]
    fn full_tilt_ends_at_three_metres_a_second() {
        let pitch_rad = -12_f64.to_radians();
        let airframe = fly(Attitude { pitch_rad, ..Attitude::default() }, 30.0);
        let speed = airframe.velocity_m_s().y;
        assert!((speed - 3.0).abs() < 0.1, "{speed}");
    }

    #[test]
    fn the_attitude_lags_by_an_eighth_of_a_second() {
        let demand = Attitude { roll_rad: 0.2, ..Attitude::default() };
        let early = fly(demand, 0.07).roll_rad() / 0.2;
        let late = fly(demand, 0.20).roll_rad() / 0.2;
        assert!(early < 0.35 && late > 0.75, "{early} {late}");
    }

    #[test]
    fn motors_off_means_falling_and_then_rest() {
        let mut airframe = fly(Attitude { pitch_rad: -0.2, ..Attitude::default() }, 1.0);
        for _ in 0..400 {
            airframe.step(Thrust::Off, Vector2::zeros());
        }
        assert!(airframe.position_m().z.abs() < 1e-9);
        assert!(airframe.velocity_m_s().norm() < 1e-9);
    }

    /// The top speeds that the models' authors give for full stick, 12 degrees.
    #[test]
    fn each_profile_ends_at_its_own_top_speed() {
        let pitch_rad = -12_f64.to_radians();
        let roll_rad = 12_f64.to_radians();
        for (profile, forward, right) in [
            (Profile::rec(), 3.0, 3.0),
            (Profile::tum(), 3.64, 3.64),
            (Profile::tf(), 1.94, 2.18),
            (Profile::leo(), 1.49, 1.01),
        ] {
            let ahead = fly_as(profile, Attitude { pitch_rad, ..Attitude::default() }, 30.0);
            assert!((ahead.velocity_m_s().y - forward).abs() < 0.1, "{profile:?}");
            let aside = fly_as(profile, Attitude { roll_rad, ..Attitude::default() }, 30.0);
            assert!((aside.velocity_m_s().x - right).abs() < 0.1, "{profile:?}");
        }
    }

    #[test]
    fn a_weak_motor_makes_the_drone_lean_and_sink() {
        let mut airframe = fly(Attitude::default(), 0.1);
        airframe.weaken_motor(0.8, Duration::from_secs(1));
        for _ in 0..800 {
            airframe.step(Thrust::On(Attitude::default()), Vector2::zeros());
        }
        assert!((airframe.roll_rad() - 0.06).abs() < 0.005, "{}", airframe.roll_rad());
        assert!((airframe.velocity_m_s().z + 0.3).abs() < 0.1, "{}", airframe.velocity_m_s());
    }

    #[test]
    fn each_meeting_with_the_floor_is_counted_with_its_speed() {
        let mut airframe = fly(Attitude::default(), 0.1);
        for _ in 0..2 {
            let climb = |climb_m_s| Thrust::On(Attitude { climb_m_s, ..Attitude::default() });
            for thrust in [climb(0.5), climb(-0.5), climb(-0.5)] {
                for _ in 0..1200 {
                    airframe.step(thrust, Vector2::zeros());
                }
            }
        }
        assert_eq!(airframe.floor_contacts(), 2);
        let speed_m_s = airframe.touch_down_m_s().unwrap();
        assert!((speed_m_s - 0.5).abs() < 0.05, "{speed_m_s}");
    }

    #[test]
    fn wind_carries_the_drone_away_at_its_own_speed() {
        let mut airframe = fly(Attitude::default(), 0.1);
        for _ in 0..20_000 {
            airframe.step(Thrust::On(Attitude::default()), Vector2::new(2.0, 0.0));
        }
        let velocity = airframe.velocity_m_s();
        assert!((velocity.x - 2.0).abs() < 0.05 && velocity.y.abs() < 1e-9, "{velocity}");
    }

    #[test]
    fn air_from_above_pushes_a_drone_down_that_is_in_the_air() {
        let mut airframe = fly(Attitude::default(), 0.1);
        airframe.set_downwash(4.6);
        airframe.step(Thrust::On(Attitude::default()), Vector2::zeros());
        let push_m_s2 = -airframe.velocity_m_s().z / STEP_S;
        assert!((push_m_s2 / GRAVITY_M_S2 - 0.26).abs() < 0.01, "{push_m_s2}");
        let mut standing = Airframe::new(Profile::rec(), Vector2::zeros());
        standing.set_downwash(4.6);
        standing.step(Thrust::Off, Vector2::zeros());
        assert_eq!(standing.position_m(), Vector3::zeros());
        assert_eq!(standing.floor_contacts(), 0);
    }

    #[test]
    fn frames_turn_into_each_other() {
        let world = world_from_body(0.3, 0.7, 1.1);
        let body = body_from_world(world.x, world.y, 1.1);
        assert!((body - Vector2::new(0.3, 0.7)).norm() < 1e-12);
    }
}
