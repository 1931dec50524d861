//! What the vehicle tells.

mod progress;

use std::time::Duration;

use autopilot::agent::{LANDING_BATTERY_PERCENT, WARNING_BATTERY_PERCENT};
use autopilot::vehicle::{LandingReason, Phase, Status, Trust};
use kinematics::Pose;
use mavlink_core::types::CharArray;

use super::modes::Mode;
use super::schedule::HEARTBEAT;
use super::{Autopilot, MavlinkVehicle, To};
use crate::dialect::{
    ALTITUDE_DATA, ATTITUDE_DATA, ATTITUDE_QUATERNION_DATA, AUTOPILOT_VERSION_DATA,
    AVAILABLE_MODES_DATA, BATTERY_STATUS_DATA, CURRENT_MODE_DATA, DISTANCE_SENSOR_DATA,
    ESTIMATOR_STATUS_DATA, EXTENDED_SYS_STATE_DATA, EstimatorStatusFlags, GLOBAL_POSITION_INT_DATA,
    GPS_GLOBAL_ORIGIN_DATA, GPS_RAW_INT_DATA, GpsFixType, HEARTBEAT_DATA, HOME_POSITION_DATA,
    LOCAL_POSITION_NED_DATA, MavAutopilot, MavBatteryChargeState, MavDistanceSensor, MavMessage,
    MavModeFlag, MavModeProperty, MavProtocolCapability, MavSensorOrientation, MavState,
    MavSysStatusSensor, MavType, POSITION_TARGET_LOCAL_NED_DATA, PROTOCOL_VERSION_DATA,
    PositionTargetTypemask, SYS_STATUS_DATA, SYSTEM_TIME_DATA, VFR_HUD_DATA,
};

impl MavlinkVehicle {
    /// Queues what is due.
    pub(super) fn tell(&mut self, now: Duration) {
        let told = (self.mode(), self.is_armed());
        if self.told.is_some_and(|last| last != told) {
            for id in [HEARTBEAT, 245, 436, 42] {
                self.schedule.hasten(id);
            }
        }
        self.told = Some(told);
        for index in 0..self.schedule.len() {
            if let Some(id) = self.schedule.due(index, now)
                && let Some(message) = self.telemetry(id)
            {
                self.send(To::All, message);
            }
        }
    }

    /// A message by its number; nothing if there is none, or what it tells is not known yet.
    pub(super) fn telemetry(&self, id: u32) -> Option<MavMessage> {
        let (at, status) = self.status.as_ref()?;
        let view = View { vehicle: self, status, at: *at };
        Some(match id {
            HEARTBEAT => MavMessage::HEARTBEAT(view.heartbeat()),
            1 => MavMessage::SYS_STATUS(view.sys_status()),
            2 => MavMessage::SYSTEM_TIME(SYSTEM_TIME_DATA {
                time_unix_usec: us(self.config.unix_time + *at),
                time_boot_ms: view.ms(),
            }),
            24 => MavMessage::GPS_RAW_INT(view.gps().filter(|_| self.config.pretend_gps)?),
            30 => MavMessage::ATTITUDE(view.attitude()?),
            31 => MavMessage::ATTITUDE_QUATERNION(view.quaternion()?),
            32 => MavMessage::LOCAL_POSITION_NED(view.local()?),
            33 => MavMessage::GLOBAL_POSITION_INT(view.global()?),
            42 => MavMessage::MISSION_CURRENT(view.mission()),
            49 => MavMessage::GPS_GLOBAL_ORIGIN(view.origin()),
            74 => MavMessage::VFR_HUD(view.hud()?),
            85 => MavMessage::POSITION_TARGET_LOCAL_NED(view.target()),
            132 => MavMessage::DISTANCE_SENSOR(view.distance()?),
            141 => MavMessage::ALTITUDE(view.altitude()?),
            147 => MavMessage::BATTERY_STATUS(view.battery()?),
            148 => MavMessage::AUTOPILOT_VERSION(self.version()),
            230 => MavMessage::ESTIMATOR_STATUS(view.estimator()),
            242 => MavMessage::HOME_POSITION(view.home()),
            245 => MavMessage::EXTENDED_SYS_STATE(EXTENDED_SYS_STATE_DATA {
                landed_state: view.landed(),
                ..EXTENDED_SYS_STATE_DATA::default()
            }),
            300 => MavMessage::PROTOCOL_VERSION(PROTOCOL_VERSION_DATA {
                version: 200,
                min_version: 100,
                max_version: 200,
                ..PROTOCOL_VERSION_DATA::default()
            }),
            436 => MavMessage::CURRENT_MODE(CURRENT_MODE_DATA {
                custom_mode: self.mode().custom(),
                intended_custom_mode: self.mode().custom(),
                standard_mode: self.mode().standard(),
            }),
            _ => return None,
        })
    }

    /// A mode by its index, from 1.
    pub(super) fn available_mode(index: usize) -> Option<MavMessage> {
        let mode = *Mode::ALL.get(index.checked_sub(1)?)?;
        let properties = if mode.is_automatic() {
            MavModeProperty::MAV_MODE_PROPERTY_AUTO_MODE
        } else {
            MavModeProperty::empty()
        };
        Some(MavMessage::AVAILABLE_MODES(AVAILABLE_MODES_DATA {
            custom_mode: mode.custom(),
            properties,
            number_modes: u8::try_from(Mode::ALL.len()).unwrap_or(u8::MAX),
            mode_index: u8::try_from(index).unwrap_or(u8::MAX),
            standard_mode: mode.standard(),
            mode_name: CharArray::from(mode.name()),
        }))
    }

    fn version(&self) -> AUTOPILOT_VERSION_DATA {
        use MavProtocolCapability as Can;
        AUTOPILOT_VERSION_DATA {
            capabilities: Can::MAV_PROTOCOL_CAPABILITY_MISSION_INT
                | Can::MAV_PROTOCOL_CAPABILITY_MISSION_FENCE
                | Can::MAV_PROTOCOL_CAPABILITY_COMMAND_INT
                | Can::MAV_PROTOCOL_CAPABILITY_PARAM_ENCODE_BYTEWISE
                | Can::MAV_PROTOCOL_CAPABILITY_SET_POSITION_TARGET_LOCAL_NED
                | Can::MAV_PROTOCOL_CAPABILITY_SET_POSITION_TARGET_GLOBAL_INT
                | Can::MAV_PROTOCOL_CAPABILITY_FLIGHT_TERMINATION
                | Can::MAV_PROTOCOL_CAPABILITY_MAVLINK2,
            uid: 1,
            // Major, minor, patch, and 255 for a release.
            flight_sw_version: match self.config.autopilot {
                Autopilot::Px4 => 0x0110_00ff,
                Autopilot::Generic => 0x0001_00ff,
            },
            ..AUTOPILOT_VERSION_DATA::default()
        }
    }
}

/// The vehicle at one moment.
struct View<'a> {
    vehicle: &'a MavlinkVehicle,
    status: &'a Status,
    at: Duration,
}

fn us(time: Duration) -> u64 {
    u64::try_from(time.as_micros()).unwrap_or(u64::MAX)
}

/// To a smaller float; what is far outside of it becomes infinite, which nothing here is.
#[allow(clippy::cast_possible_truncation, reason = "metres and radians")]
fn f32_of(value: f64) -> f32 {
    value as f32
}

/// To the nearest integer; a cast saturates.
#[allow(clippy::cast_possible_truncation, reason = "it saturates")]
fn i32_of(value: f64) -> i32 {
    value.round() as i32
}

#[allow(clippy::cast_possible_truncation, reason = "it saturates")]
fn i16_of(value: f64) -> i16 {
    value.round() as i16
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it saturates")]
fn u16_of(value: f64) -> u16 {
    value.round() as u16
}

impl View<'_> {
    fn ms(&self) -> u32 {
        u32::try_from(self.at.as_millis() % (1 << 32)).unwrap_or_default()
    }

    fn is_connected(&self) -> bool {
        self.status.phase != Phase::Connecting
    }

    fn heartbeat(&self) -> HEARTBEAT_DATA {
        use MavModeFlag as Flag;
        let mode = self.vehicle.mode();
        let mut base_mode = Flag::MAV_MODE_FLAG_CUSTOM_MODE_ENABLED
            | Flag::MAV_MODE_FLAG_STABILIZE_ENABLED
            | match mode {
                Mode::Position => Flag::MAV_MODE_FLAG_MANUAL_INPUT_ENABLED,
                Mode::Offboard => Flag::MAV_MODE_FLAG_GUIDED_ENABLED,
                _ => Flag::MAV_MODE_FLAG_GUIDED_ENABLED | Flag::MAV_MODE_FLAG_AUTO_ENABLED,
            };
        base_mode.set(Flag::MAV_MODE_FLAG_SAFETY_ARMED, self.vehicle.is_armed());
        let failsafe = self.status.landing.is_some_and(|why| why != LandingReason::Operator);
        let state = match self.status.phase {
            _ if self.status.emergency => MavState::MAV_STATE_EMERGENCY,
            Phase::Connecting => MavState::MAV_STATE_UNINIT,
            Phase::Configuring | Phase::Trimming => MavState::MAV_STATE_BOOT,
            Phase::Flying | Phase::Landing if failsafe => MavState::MAV_STATE_CRITICAL,
            Phase::Flying | Phase::Landing | Phase::Observing => MavState::MAV_STATE_ACTIVE,
            Phase::Standby => MavState::MAV_STATE_STANDBY,
        };
        HEARTBEAT_DATA {
            custom_mode: mode.custom(),
            mavtype: MavType::MAV_TYPE_QUADROTOR as u8,
            autopilot: match self.vehicle.config.autopilot {
                Autopilot::Generic => MavAutopilot::MAV_AUTOPILOT_GENERIC as u8,
                Autopilot::Px4 => MavAutopilot::MAV_AUTOPILOT_PX4 as u8,
            },
            base_mode,
            system_status: state as u8,
            mavlink_version: 3,
        }
    }

    fn sys_status(&self) -> SYS_STATUS_DATA {
        use MavSysStatusSensor as Sensor;
        let mut present = Sensor::MAV_SYS_STATUS_SENSOR_3D_GYRO
            | Sensor::MAV_SYS_STATUS_SENSOR_3D_ACCEL
            | Sensor::MAV_SYS_STATUS_SENSOR_3D_MAG
            | Sensor::MAV_SYS_STATUS_SENSOR_ABSOLUTE_PRESSURE
            | Sensor::MAV_SYS_STATUS_SENSOR_OPTICAL_FLOW
            | Sensor::MAV_SYS_STATUS_SENSOR_LASER_POSITION
            | Sensor::MAV_SYS_STATUS_SENSOR_ATTITUDE_STABILIZATION
            | Sensor::MAV_SYS_STATUS_SENSOR_YAW_POSITION
            | Sensor::MAV_SYS_STATUS_SENSOR_Z_ALTITUDE_CONTROL
            | Sensor::MAV_SYS_STATUS_SENSOR_XY_POSITION_CONTROL
            | Sensor::MAV_SYS_STATUS_SENSOR_MOTOR_OUTPUTS
            | Sensor::MAV_SYS_STATUS_AHRS
            | Sensor::MAV_SYS_STATUS_SENSOR_BATTERY
            | Sensor::MAV_SYS_STATUS_PREARM_CHECK;
        present.set(Sensor::MAV_SYS_STATUS_SENSOR_GPS, self.vehicle.config.pretend_gps);
        let sound = self.is_connected() && self.status.trust == Trust::Sound;
        let mut health = if sound { present } else { Sensor::MAV_SYS_STATUS_SENSOR_BATTERY };
        // In flight the checks before it have been passed.
        let ready = self.vehicle.is_flying()
            || self.vehicle.not_ready.is_some_and(|reasons| reasons.is_empty());
        // A drone whose motors were cut in the air falls, before it says so.
        let falls = self.status.airborne && !self.vehicle.is_flying();
        let ready = ready && !self.status.emergency && !falls;
        health.set(Sensor::MAV_SYS_STATUS_PREARM_CHECK, ready);
        let percent = self.status.battery_percent.and_then(|percent| i8::try_from(percent).ok());
        SYS_STATUS_DATA {
            onboard_control_sensors_present: present,
            onboard_control_sensors_enabled: present,
            onboard_control_sensors_health: health,
            voltage_battery: self.battery_mv(),
            current_battery: -1,
            battery_remaining: percent.unwrap_or(-1),
            ..SYS_STATUS_DATA::default()
        }
    }

    fn battery(&self) -> Option<BATTERY_STATUS_DATA> {
        let percent = self.status.battery_percent?;
        // Cells are not measured one by one: the voltage of all is that of the first, as the message says it.
        let mut voltages = [u16::MAX; 10];
        voltages[0] = self.battery_mv();
        Some(BATTERY_STATUS_DATA {
            current_consumed: -1,
            energy_consumed: -1,
            temperature: i16::MAX,
            voltages,
            current_battery: -1,
            battery_remaining: i8::try_from(percent).unwrap_or(100),
            charge_state: if percent <= LANDING_BATTERY_PERCENT {
                MavBatteryChargeState::MAV_BATTERY_CHARGE_STATE_CRITICAL
            } else if percent <= WARNING_BATTERY_PERCENT {
                MavBatteryChargeState::MAV_BATTERY_CHARGE_STATE_LOW
            } else {
                MavBatteryChargeState::MAV_BATTERY_CHARGE_STATE_OK
            },
            ..BATTERY_STATUS_DATA::default()
        })
    }

    fn pose(&self) -> Option<Pose> {
        self.status.pose
    }

    /// Roll to the right, nose up, and yaw from north: radians.
    fn angles_rad(&self) -> Option<[f64; 3]> {
        let [roll_deg, pitch_deg] = self.status.attitude_deg?;
        let yaw_rad = self.vehicle.origin.yaw_ned_rad(self.pose()?.yaw_deg);
        Some([roll_deg.to_radians(), pitch_deg.to_radians(), yaw_rad])
    }

    /// Clockwise from above, in rad/s; 0 if it is not known.
    fn yaw_rate_rad_s(&self) -> f32 {
        f32_of(self.status.turn_rate_deg_s.unwrap_or_default().to_radians())
    }

    /// The battery's voltage in mV; the largest integer if it is not known.
    fn battery_mv(&self) -> u16 {
        self.status.battery_v.map_or(u16::MAX, |battery_v| u16_of(battery_v * 1e3))
    }

    fn attitude(&self) -> Option<ATTITUDE_DATA> {
        let [roll, pitch, yaw] = self.angles_rad()?.map(f32_of);
        // Of the rates only this one is estimated. The heading turns without the tilt, as a small one nearly does.
        let yawspeed = self.yaw_rate_rad_s();
        Some(ATTITUDE_DATA {
            time_boot_ms: self.ms(),
            roll,
            pitch,
            yaw,
            yawspeed,
            ..ATTITUDE_DATA::default()
        })
    }

    fn quaternion(&self) -> Option<ATTITUDE_QUATERNION_DATA> {
        let [roll, pitch, yaw] = self.angles_rad()?;
        let turned = nalgebra::UnitQuaternion::from_euler_angles(roll, pitch, yaw);
        Some(ATTITUDE_QUATERNION_DATA {
            time_boot_ms: self.ms(),
            q1: f32_of(turned.w),
            q2: f32_of(turned.i),
            q3: f32_of(turned.j),
            q4: f32_of(turned.k),
            yawspeed: self.yaw_rate_rad_s(),
            ..ATTITUDE_QUATERNION_DATA::default()
        })
    }

    /// North, east and down, in m/s.
    fn ned_velocity(&self) -> [f64; 3] {
        self.vehicle.origin.ned(self.status.velocity_m_s.unwrap_or_default())
    }

    fn ned(&self, pose: &Pose) -> [f32; 3] {
        self.vehicle.origin.ned([pose.x_m, pose.y_m, pose.z_m]).map(f32_of)
    }

    fn local(&self) -> Option<LOCAL_POSITION_NED_DATA> {
        let [x, y, z] = self.ned(&self.pose()?);
        let [vx, vy, vz] = self.ned_velocity().map(f32_of);
        Some(LOCAL_POSITION_NED_DATA { time_boot_ms: self.ms(), x, y, z, vx, vy, vz })
    }

    /// Latitude and longitude × 1e7, and heights in mm above the sea and the start.
    fn on_globe(&self, pose: &Pose) -> (i32, i32, i32, i32) {
        let origin = &self.vehicle.origin;
        let place = origin.global(pose.x_m, pose.y_m);
        let amsl_mm = i32_of(origin.amsl_m(pose.z_m) * 1e3);
        (place.latitude_e7, place.longitude_e7, amsl_mm, i32_of(pose.z_m * 1e3))
    }

    fn heading_deg(&self, pose: &Pose) -> f64 {
        self.vehicle.origin.yaw_ned_rad(pose.yaw_deg).to_degrees().rem_euclid(360.0)
    }

    fn global(&self) -> Option<GLOBAL_POSITION_INT_DATA> {
        let pose = self.pose()?;
        let (lat, lon, alt, relative_alt) = self.on_globe(&pose);
        let [vx, vy, vz] = self.ned_velocity().map(|speed_m_s| i16_of(speed_m_s * 1e2));
        let hdg = u16_of(self.heading_deg(&pose) * 1e2) % 36_000;
        let time_boot_ms = self.ms();
        Some(GLOBAL_POSITION_INT_DATA {
            time_boot_ms,
            lat,
            lon,
            alt,
            relative_alt,
            vx,
            vy,
            vz,
            hdg,
        })
    }

    fn gps(&self) -> Option<GPS_RAW_INT_DATA> {
        let pose = self.pose()?;
        let (lat, lon, alt, _) = self.on_globe(&pose);
        Some(GPS_RAW_INT_DATA {
            time_usec: us(self.at),
            lat,
            lon,
            alt,
            eph: 100,
            epv: 100,
            vel: u16::MAX,
            cog: u16::MAX,
            fix_type: GpsFixType::GPS_FIX_TYPE_3D_FIX,
            satellites_visible: 10,
            ..GPS_RAW_INT_DATA::default()
        })
    }

    fn hud(&self) -> Option<VFR_HUD_DATA> {
        let pose = self.pose()?;
        let [north, east, down] = self.ned_velocity();
        Some(VFR_HUD_DATA {
            airspeed: 0.0,
            groundspeed: f32_of(north.hypot(east)),
            alt: f32_of(self.vehicle.origin.amsl_m(pose.z_m)),
            climb: f32_of(-down),
            heading: i16_of(self.heading_deg(&pose)) % 360,
            // Not known.
            throttle: 0,
        })
    }

    fn altitude(&self) -> Option<ALTITUDE_DATA> {
        let z_m = self.pose()?.z_m;
        let amsl = f32_of(self.vehicle.origin.amsl_m(z_m));
        let above_start = f32_of(z_m);
        Some(ALTITUDE_DATA {
            time_usec: us(self.at),
            altitude_monotonic: amsl,
            altitude_amsl: amsl,
            altitude_local: above_start,
            altitude_relative: above_start,
            // Far below what exists: not known.
            altitude_terrain: -1001.0,
            bottom_clearance: self.status.altitude_m.map_or(-1.0, f32_of),
        })
    }

    fn distance(&self) -> Option<DISTANCE_SENSOR_DATA> {
        Some(DISTANCE_SENSOR_DATA {
            time_boot_ms: self.ms(),
            min_distance: 20,
            max_distance: 600,
            current_distance: u16_of(self.status.altitude_m? * 1e2),
            mavtype: MavDistanceSensor::MAV_DISTANCE_SENSOR_ULTRASOUND,
            orientation: MavSensorOrientation::MAV_SENSOR_ROTATION_PITCH_270,
            covariance: u8::MAX,
            ..DISTANCE_SENSOR_DATA::default()
        })
    }

    fn home(&self) -> HOME_POSITION_DATA {
        let (latitude, longitude, altitude, _) = self.on_globe(&Pose::default());
        HOME_POSITION_DATA {
            latitude,
            longitude,
            altitude,
            q: [1.0, 0.0, 0.0, 0.0],
            time_usec: us(self.at),
            ..HOME_POSITION_DATA::default()
        }
    }

    fn origin(&self) -> GPS_GLOBAL_ORIGIN_DATA {
        let (latitude, longitude, altitude, _) = self.on_globe(&Pose::default());
        GPS_GLOBAL_ORIGIN_DATA { latitude, longitude, altitude, time_usec: us(self.at) }
    }

    fn target(&self) -> POSITION_TARGET_LOCAL_NED_DATA {
        let (time_boot_ms, coordinate_frame) = (self.ms(), 1);
        let Some(target) = self.status.target else {
            // Without a target everything is to be ignored.
            return POSITION_TARGET_LOCAL_NED_DATA {
                time_boot_ms,
                type_mask: PositionTargetTypemask::from_bits_truncate(0b1101_1111_1111),
                coordinate_frame,
                ..POSITION_TARGET_LOCAL_NED_DATA::default()
            };
        };
        let [x, y, z] = self.ned(&target);
        POSITION_TARGET_LOCAL_NED_DATA {
            time_boot_ms,
            x,
            y,
            z,
            yaw: f32_of(self.vehicle.origin.yaw_ned_rad(target.yaw_deg)),
            // Place and yaw.
            type_mask: PositionTargetTypemask::from_bits_truncate(0b1001_1111_1000),
            coordinate_frame,
            ..POSITION_TARGET_LOCAL_NED_DATA::default()
        }
    }

    fn estimator(&self) -> ESTIMATOR_STATUS_DATA {
        use EstimatorStatusFlags as Good;
        let sound = self.is_connected() && self.status.trust == Trust::Sound;
        let flags = if sound {
            Good::ESTIMATOR_ATTITUDE
                | Good::ESTIMATOR_VELOCITY_HORIZ
                | Good::ESTIMATOR_VELOCITY_VERT
                | Good::ESTIMATOR_POS_HORIZ_REL
                | Good::ESTIMATOR_POS_VERT_AGL
        } else {
            Good::empty()
        };
        ESTIMATOR_STATUS_DATA {
            time_usec: us(self.at),
            pos_horiz_accuracy: f32_of(self.status.uncertainty_m),
            pos_vert_accuracy: f32_of(self.status.height_uncertainty_m),
            flags,
            ..ESTIMATOR_STATUS_DATA::default()
        }
    }
}
