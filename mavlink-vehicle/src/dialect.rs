#![doc = "MAVLink pilot dialect."]
#![doc = ""]
#![doc = "This file was automatically generated, do not edit."]
#![allow(deprecated)]
#![allow(clippy::match_single_binding)]
#![allow(rustdoc::broken_intra_doc_links)]
#[allow(unused_imports)]
use bitflags::{Flags, bitflags};
#[allow(unused_imports)]
use mavlink_core::{
    MavlinkVersion, Message, MessageData, bytes::Bytes, bytes_mut::BytesMut, types::CharArray,
};
#[allow(unused_imports)]
use num_derive::{FromPrimitive, ToPrimitive};
#[allow(unused_imports)]
use num_traits::{FromPrimitive, ToPrimitive};
pub const MINOR_MAVLINK_VERSION: u8 = 3u8;
bitflags! {     # [derive (Debug , Copy , Clone , PartialEq)] # [doc = "Bitmap to indicate which dimensions should be ignored by the vehicle: a value of 0b00000000 indicates that none of the setpoint dimensions should be ignored."] pub struct AttitudeTargetTypemask : u8 { # [doc = "Ignore body roll rate"] const ATTITUDE_TARGET_TYPEMASK_BODY_ROLL_RATE_IGNORE = 1 ; # [doc = "Ignore body pitch rate"] const ATTITUDE_TARGET_TYPEMASK_BODY_PITCH_RATE_IGNORE = 2 ; # [doc = "Ignore body yaw rate"] const ATTITUDE_TARGET_TYPEMASK_BODY_YAW_RATE_IGNORE = 4 ; # [doc = "Use 3D body thrust setpoint instead of throttle"] const ATTITUDE_TARGET_TYPEMASK_THRUST_BODY_SET = 32 ; # [doc = "Ignore throttle"] const ATTITUDE_TARGET_TYPEMASK_THROTTLE_IGNORE = 64 ; # [doc = "Ignore attitude"] const ATTITUDE_TARGET_TYPEMASK_ATTITUDE_IGNORE = 128 ; } }
impl AttitudeTargetTypemask {
    pub const DEFAULT: Self = Self::empty();
}
impl Default for AttitudeTargetTypemask {
    fn default() -> Self {
        Self::DEFAULT
    }
}
bitflags! {     # [derive (Debug , Copy , Clone , PartialEq)] # [doc = "Camera capability flags (Bitmap)"] pub struct CameraCapFlags : u32 { # [doc = "Camera is able to record video"] const CAMERA_CAP_FLAGS_CAPTURE_VIDEO = 1 ; # [doc = "Camera is able to capture images"] const CAMERA_CAP_FLAGS_CAPTURE_IMAGE = 2 ; # [doc = "Camera has separate Video and Image/Photo modes (MAV_CMD_SET_CAMERA_MODE)"] const CAMERA_CAP_FLAGS_HAS_MODES = 4 ; # [doc = "Camera can capture images while in video mode"] const CAMERA_CAP_FLAGS_CAN_CAPTURE_IMAGE_IN_VIDEO_MODE = 8 ; # [doc = "Camera can capture videos while in Photo/Image mode"] const CAMERA_CAP_FLAGS_CAN_CAPTURE_VIDEO_IN_IMAGE_MODE = 16 ; # [doc = "Camera has image survey mode (MAV_CMD_SET_CAMERA_MODE)"] const CAMERA_CAP_FLAGS_HAS_IMAGE_SURVEY_MODE = 32 ; # [doc = "Camera has basic zoom control (MAV_CMD_SET_CAMERA_ZOOM)"] const CAMERA_CAP_FLAGS_HAS_BASIC_ZOOM = 64 ; # [doc = "Camera has basic focus control (MAV_CMD_SET_CAMERA_FOCUS)"] const CAMERA_CAP_FLAGS_HAS_BASIC_FOCUS = 128 ; # [doc = "Camera has video streaming capabilities (request VIDEO_STREAM_INFORMATION with MAV_CMD_REQUEST_MESSAGE for video streaming info)"] const CAMERA_CAP_FLAGS_HAS_VIDEO_STREAM = 256 ; # [doc = "Camera supports tracking of a point on the camera view."] const CAMERA_CAP_FLAGS_HAS_TRACKING_POINT = 512 ; # [doc = "Camera supports tracking of a selection rectangle on the camera view."] const CAMERA_CAP_FLAGS_HAS_TRACKING_RECTANGLE = 1024 ; # [doc = "Camera supports tracking geo status (CAMERA_TRACKING_GEO_STATUS)."] const CAMERA_CAP_FLAGS_HAS_TRACKING_GEO_STATUS = 2048 ; # [doc = "Camera supports absolute thermal range (request CAMERA_THERMAL_RANGE with MAV_CMD_REQUEST_MESSAGE)."] const CAMERA_CAP_FLAGS_HAS_THERMAL_RANGE = 4096 ; # [doc = "Camera supports Moving Target Indicators (MTI) on the camera view (using MAV_CMD_CAMERA_START_MTI)."] const CAMERA_CAP_FLAGS_HAS_MTI = 8192 ; } }
impl CameraCapFlags {
    pub const DEFAULT: Self = Self::empty();
}
impl Default for CameraCapFlags {
    fn default() -> Self {
        Self::DEFAULT
    }
}
bitflags! {     # [derive (Debug , Copy , Clone , PartialEq)] # [doc = "Flags in ESTIMATOR_STATUS message"] pub struct EstimatorStatusFlags : u16 { # [doc = "True if the attitude estimate is good"] const ESTIMATOR_ATTITUDE = 1 ; # [doc = "True if the horizontal velocity estimate is good"] const ESTIMATOR_VELOCITY_HORIZ = 2 ; # [doc = "True if the  vertical velocity estimate is good"] const ESTIMATOR_VELOCITY_VERT = 4 ; # [doc = "True if the horizontal position (relative) estimate is good"] const ESTIMATOR_POS_HORIZ_REL = 8 ; # [doc = "True if the horizontal position (absolute) estimate is good"] const ESTIMATOR_POS_HORIZ_ABS = 16 ; # [doc = "True if the vertical position (absolute) estimate is good"] const ESTIMATOR_POS_VERT_ABS = 32 ; # [doc = "True if the vertical position (above ground) estimate is good"] const ESTIMATOR_POS_VERT_AGL = 64 ; # [doc = "True if the EKF is in a constant position mode and is not using external measurements (eg GPS or optical flow)"] const ESTIMATOR_CONST_POS_MODE = 128 ; # [doc = "True if the EKF has sufficient data to enter a mode that will provide a (relative) position estimate"] const ESTIMATOR_PRED_POS_HORIZ_REL = 256 ; # [doc = "True if the EKF has sufficient data to enter a mode that will provide a (absolute) position estimate"] const ESTIMATOR_PRED_POS_HORIZ_ABS = 512 ; # [doc = "True if the EKF has detected a GPS glitch"] const ESTIMATOR_GPS_GLITCH = 1024 ; # [doc = "True if the EKF has detected bad accelerometer data"] const ESTIMATOR_ACCEL_ERROR = 2048 ; } }
impl EstimatorStatusFlags {
    pub const DEFAULT: Self = Self::empty();
}
impl Default for EstimatorStatusFlags {
    fn default() -> Self {
        Self::DEFAULT
    }
}
#[derive(Debug, Copy, Clone, PartialEq, FromPrimitive, ToPrimitive)]
#[repr(u32)]
#[doc = "Type of GPS fix"]
pub enum GpsFixType {
    #[doc = "No GPS connected"]
    GPS_FIX_TYPE_NO_GPS = 0,
    #[doc = "No position information, GPS is connected"]
    GPS_FIX_TYPE_NO_FIX = 1,
    #[doc = "2D position"]
    GPS_FIX_TYPE_2D_FIX = 2,
    #[doc = "3D position"]
    GPS_FIX_TYPE_3D_FIX = 3,
    #[doc = "DGPS/SBAS aided 3D position"]
    GPS_FIX_TYPE_DGPS = 4,
    #[doc = "RTK float, 3D position"]
    GPS_FIX_TYPE_RTK_FLOAT = 5,
    #[doc = "RTK Fixed, 3D position"]
    GPS_FIX_TYPE_RTK_FIXED = 6,
    #[doc = "Static fixed, typically used for base stations"]
    GPS_FIX_TYPE_STATIC = 7,
    #[doc = "PPP, 3D position."]
    GPS_FIX_TYPE_PPP = 8,
}
impl GpsFixType {
    pub const DEFAULT: Self = Self::GPS_FIX_TYPE_NO_GPS;
}
impl Default for GpsFixType {
    fn default() -> Self {
        Self::DEFAULT
    }
}
#[derive(Debug, Copy, Clone, PartialEq, FromPrimitive, ToPrimitive)]
#[repr(u32)]
#[doc = "Micro air vehicle / autopilot classes. This identifies the individual model."]
pub enum MavAutopilot {
    #[doc = "Generic autopilot, full support for everything"]
    MAV_AUTOPILOT_GENERIC = 0,
    #[doc = "Reserved for future use."]
    MAV_AUTOPILOT_RESERVED = 1,
    #[doc = "SLUGS autopilot, <http://slugsuav.soe.ucsc.edu>"]
    MAV_AUTOPILOT_SLUGS = 2,
    #[doc = "ArduPilot - Plane/Copter/Rover/Sub/Tracker, <https://ardupilot.org>"]
    MAV_AUTOPILOT_ARDUPILOTMEGA = 3,
    #[doc = "OpenPilot, <http://openpilot.org>"]
    MAV_AUTOPILOT_OPENPILOT = 4,
    #[doc = "Generic autopilot only supporting simple waypoints"]
    MAV_AUTOPILOT_GENERIC_WAYPOINTS_ONLY = 5,
    #[doc = "Generic autopilot supporting waypoints and other simple navigation commands"]
    MAV_AUTOPILOT_GENERIC_WAYPOINTS_AND_SIMPLE_NAVIGATION_ONLY = 6,
    #[doc = "Generic autopilot supporting the full mission command set"]
    MAV_AUTOPILOT_GENERIC_MISSION_FULL = 7,
    #[doc = "No valid autopilot, e.g. a GCS or other MAVLink component"]
    MAV_AUTOPILOT_INVALID = 8,
    #[doc = "PPZ UAV - <http://nongnu.org/paparazzi>"]
    MAV_AUTOPILOT_PPZ = 9,
    #[doc = "UAV Dev Board"]
    MAV_AUTOPILOT_UDB = 10,
    #[doc = "FlexiPilot"]
    MAV_AUTOPILOT_FP = 11,
    #[doc = "PX4 Autopilot - <http://px4.io/>"]
    MAV_AUTOPILOT_PX4 = 12,
    #[doc = "SMACCMPilot - <http://smaccmpilot.org>"]
    MAV_AUTOPILOT_SMACCMPILOT = 13,
    #[doc = "AutoQuad -- <http://autoquad.org>"]
    MAV_AUTOPILOT_AUTOQUAD = 14,
    #[doc = "Armazila -- <http://armazila.com>"]
    MAV_AUTOPILOT_ARMAZILA = 15,
    #[doc = "Aerob -- <http://aerob.ru>"]
    MAV_AUTOPILOT_AEROB = 16,
    #[doc = "ASLUAV autopilot -- <http://www.asl.ethz.ch>"]
    MAV_AUTOPILOT_ASLUAV = 17,
    #[doc = "SmartAP Autopilot - <http://sky-drones.com>"]
    MAV_AUTOPILOT_SMARTAP = 18,
    #[doc = "AirRails - <http://uaventure.com>"]
    MAV_AUTOPILOT_AIRRAILS = 19,
    #[doc = "Fusion Reflex - <https://fusion.engineering>"]
    MAV_AUTOPILOT_REFLEX = 20,
}
impl MavAutopilot {
    pub const DEFAULT: Self = Self::MAV_AUTOPILOT_GENERIC;
}
impl Default for MavAutopilot {
    fn default() -> Self {
        Self::DEFAULT
    }
}
#[derive(Debug, Copy, Clone, PartialEq, FromPrimitive, ToPrimitive)]
#[repr(u32)]
#[doc = "Enumeration for battery charge states."]
pub enum MavBatteryChargeState {
    #[doc = "Low battery state is not provided"]
    MAV_BATTERY_CHARGE_STATE_UNDEFINED = 0,
    #[doc = "Battery is not in low state. Normal operation."]
    MAV_BATTERY_CHARGE_STATE_OK = 1,
    #[doc = "Battery state is low, warn and monitor close."]
    MAV_BATTERY_CHARGE_STATE_LOW = 2,
    #[doc = "Battery state is critical, return or abort immediately."]
    MAV_BATTERY_CHARGE_STATE_CRITICAL = 3,
    #[doc = "Battery state is too low for ordinary abort sequence. Perform fastest possible emergency stop to prevent damage."]
    MAV_BATTERY_CHARGE_STATE_EMERGENCY = 4,
    #[doc = "Battery failed, damage unavoidable. Possible causes (faults) are listed in MAV_BATTERY_FAULT."]
    MAV_BATTERY_CHARGE_STATE_FAILED = 5,
    #[doc = "Battery is diagnosed to be defective or an error occurred, usage is discouraged / prohibited. Possible causes (faults) are listed in MAV_BATTERY_FAULT."]
    MAV_BATTERY_CHARGE_STATE_UNHEALTHY = 6,
    #[doc = "Battery is charging."]
    MAV_BATTERY_CHARGE_STATE_CHARGING = 7,
}
impl MavBatteryChargeState {
    pub const DEFAULT: Self = Self::MAV_BATTERY_CHARGE_STATE_UNDEFINED;
}
impl Default for MavBatteryChargeState {
    fn default() -> Self {
        Self::DEFAULT
    }
}
bitflags! {     # [derive (Debug , Copy , Clone , PartialEq)] # [doc = "Smart battery supply status/fault flags (bitmask) for health indication. The battery must also report either MAV_BATTERY_CHARGE_STATE_FAILED or MAV_BATTERY_CHARGE_STATE_UNHEALTHY if any of these are set."] pub struct MavBatteryFault : u32 { # [doc = "Battery has deep discharged."] const MAV_BATTERY_FAULT_DEEP_DISCHARGE = 1 ; # [doc = "Voltage spikes."] const MAV_BATTERY_FAULT_SPIKES = 2 ; # [doc = "One or more cells have failed. Battery should also report MAV_BATTERY_CHARGE_STATE_FAILE (and should not be used)."] const MAV_BATTERY_FAULT_CELL_FAIL = 4 ; # [doc = "Over-current fault."] const MAV_BATTERY_FAULT_OVER_CURRENT = 8 ; # [doc = "Over-temperature fault."] const MAV_BATTERY_FAULT_OVER_TEMPERATURE = 16 ; # [doc = "Under-temperature fault."] const MAV_BATTERY_FAULT_UNDER_TEMPERATURE = 32 ; # [doc = "Vehicle voltage is not compatible with this battery (batteries on same power rail should have similar voltage)."] const MAV_BATTERY_FAULT_INCOMPATIBLE_VOLTAGE = 64 ; # [doc = "Battery firmware is not compatible with current autopilot firmware."] const MAV_BATTERY_FAULT_INCOMPATIBLE_FIRMWARE = 128 ; # [doc = "Battery is not compatible due to cell configuration (e.g. 5s1p when vehicle requires 6s)."] const BATTERY_FAULT_INCOMPATIBLE_CELLS_CONFIGURATION = 256 ; } }
impl MavBatteryFault {
    pub const DEFAULT: Self = Self::empty();
}
impl Default for MavBatteryFault {
    fn default() -> Self {
        Self::DEFAULT
    }
}
#[derive(Debug, Copy, Clone, PartialEq, FromPrimitive, ToPrimitive)]
#[repr(u32)]
#[doc = "Enumeration of battery functions"]
pub enum MavBatteryFunction {
    #[doc = "Battery function is unknown"]
    MAV_BATTERY_FUNCTION_UNKNOWN = 0,
    #[doc = "Battery supports all flight systems"]
    MAV_BATTERY_FUNCTION_ALL = 1,
    #[doc = "Battery for the propulsion system"]
    MAV_BATTERY_FUNCTION_PROPULSION = 2,
    #[doc = "Avionics battery"]
    MAV_BATTERY_FUNCTION_AVIONICS = 3,
    #[doc = "Payload battery"]
    MAV_BATTERY_FUNCTION_PAYLOAD = 4,
}
impl MavBatteryFunction {
    pub const DEFAULT: Self = Self::MAV_BATTERY_FUNCTION_UNKNOWN;
}
impl Default for MavBatteryFunction {
    fn default() -> Self {
        Self::DEFAULT
    }
}
#[derive(Debug, Copy, Clone, PartialEq, FromPrimitive, ToPrimitive)]
#[repr(u32)]
#[doc = "Battery mode. Note, the normal operation mode (i.e. when flying) should be reported as MAV_BATTERY_MODE_UNKNOWN to allow message trimming in normal flight."]
pub enum MavBatteryMode {
    #[doc = "Battery mode not supported/unknown battery mode/normal operation."]
    MAV_BATTERY_MODE_UNKNOWN = 0,
    #[doc = "Battery is auto discharging (towards storage level)."]
    MAV_BATTERY_MODE_AUTO_DISCHARGING = 1,
    #[doc = "Battery in hot-swap mode (current limited to prevent spikes that might damage sensitive electrical circuits)."]
    MAV_BATTERY_MODE_HOT_SWAP = 2,
}
impl MavBatteryMode {
    pub const DEFAULT: Self = Self::MAV_BATTERY_MODE_UNKNOWN;
}
impl Default for MavBatteryMode {
    fn default() -> Self {
        Self::DEFAULT
    }
}
#[derive(Debug, Copy, Clone, PartialEq, FromPrimitive, ToPrimitive)]
#[repr(u32)]
#[doc = "Enumeration of battery types"]
pub enum MavBatteryType {
    #[doc = "Not specified."]
    MAV_BATTERY_TYPE_UNKNOWN = 0,
    #[doc = "Lithium polymer battery"]
    MAV_BATTERY_TYPE_LIPO = 1,
    #[doc = "Lithium-iron-phosphate battery"]
    MAV_BATTERY_TYPE_LIFE = 2,
    #[doc = "Lithium-ION battery"]
    MAV_BATTERY_TYPE_LION = 3,
    #[doc = "Nickel metal hydride battery"]
    MAV_BATTERY_TYPE_NIMH = 4,
}
impl MavBatteryType {
    pub const DEFAULT: Self = Self::MAV_BATTERY_TYPE_UNKNOWN;
}
impl Default for MavBatteryType {
    fn default() -> Self {
        Self::DEFAULT
    }
}
#[derive(Debug, Copy, Clone, PartialEq, FromPrimitive, ToPrimitive)]
#[repr(u32)]
#[doc = "Commands to be executed by the MAV. They can be executed on user request, or as part of a mission script. If the action is used in a mission, the parameter mapping to the waypoint/mission message is as follows: Param 1, Param 2, Param 3, Param 4, X: Param 5, Y:Param 6, Z:Param 7. This command list is similar what ARINC 424 is for commercial aircraft: A data format how to interpret waypoint/mission data. NaN and INT32_MAX may be used in float/integer params (respectively) to indicate optional/default values (e.g. to use the component's current yaw or latitude rather than a specific value). See <https://mavlink.io/en/guide/xml_schema.html#MAV_CMD> for information about the structure of the MAV_CMD entries"]
pub enum MavCmd {
    #[doc = "Navigate to waypoint. This is intended for use in missions (for guided commands outside of missions use MAV_CMD_DO_REPOSITION)."]
    #[doc = ""]
    #[doc = "# Parameters"]
    #[doc = ""]
    #[doc = "| Parameter | Description | Values | Units |"]
    #[doc = "| --------- | ----------- | ------ | ----- |"]
    #[doc = "| 1 (Hold)  | Hold time. (ignored by fixed wing, time to stay at waypoint for rotary wing)| &ge; 0 | s |"]
    #[doc = "| 2 (Accept Radius)| Acceptance radius (if the sphere with this radius is hit, the waypoint counts as reached)| &ge; 0 | m |"]
    #[doc = "| 3 (Pass Radius)| 0 to pass through the WP, if>0 radius to pass by WP. Positive value for clockwise orbit, negative value for counter-clockwise orbit. Allows trajectory control.|  | m |"]
    #[doc = "| 4 (Yaw)   | Desired yaw angle at waypoint (rotary wing). NaN to use the current system yaw heading mode (e.g. yaw towards next waypoint, yaw to home, etc.).|  | deg |"]
    #[doc = "| 5 (Latitude)| Latitude    |  |  |"]
    #[doc = "| 6 (Longitude)| Longitude   |  |  |"]
    #[doc = "| 7 (Altitude)| Altitude    |  | m |"]
    MAV_CMD_NAV_WAYPOINT = 16,
    #[doc = "Loiter around this waypoint an unlimited amount of time"]
    #[doc = ""]
    #[doc = "# Parameters"]
    #[doc = ""]
    #[doc = "| Parameter | Description | Units |"]
    #[doc = "| --------- | ----------- | ----- |"]
    #[doc = "| 1         | Empty       |  |"]
    #[doc = "| 2         | Empty       |  |"]
    #[doc = "| 3 (Radius)| Loiter radius around waypoint for forward-only moving vehicles (not multicopters). If positive loiter clockwise, else counter-clockwise| m |"]
    #[doc = "| 4 (Yaw)   | Desired yaw angle. NaN to use the current system yaw heading mode (e.g. yaw towards next waypoint, yaw to home, etc.).| deg |"]
    #[doc = "| 5 (Latitude)| Latitude    |  |"]
    #[doc = "| 6 (Longitude)| Longitude   |  |"]
    #[doc = "| 7 (Altitude)| Altitude    | m |"]
    MAV_CMD_NAV_LOITER_UNLIM = 17,
    #[doc = "Loiter at the specified latitude, longitude and altitude for a certain amount of time. Multicopter vehicles stop at the point (within a vehicle-specific acceptance radius). Forward-only moving vehicles (e.g. fixed-wing) circle the point with the specified radius/direction. If the Heading Required parameter (2) is non-zero forward moving aircraft will only leave the loiter circle once heading towards the next waypoint."]
    #[doc = ""]
    #[doc = "# Parameters"]
    #[doc = ""]
    #[doc = "| Parameter | Description | Values | Units |"]
    #[doc = "| --------- | ----------- | ------ | ----- |"]
    #[doc = "| 1 (Time)  | Loiter time (only starts once Lat, Lon and Alt is reached).| &ge; 0 | s |"]
    #[doc = "| 2 (Heading Required)| Leave loiter circle only when track heading towards the next waypoint (MAV_BOOL_FALSE: Leave on time expiry). Values not equal to 0 or 1 are invalid.| [`MavBool`] |  |"]
    #[doc = "| 3 (Radius)| Loiter radius around waypoint for forward-only moving vehicles (not multicopters). If positive loiter clockwise, else counter-clockwise.|  | m |"]
    #[doc = "| 4 (Xtrack Location)| Loiter circle exit location and/or path to next waypoint (\"xtrack\") for forward-only moving vehicles (not multicopters). 0 for the vehicle to converge towards the center xtrack when it leaves the loiter (the line between the centers of the current and next waypoint), 1 to converge to the direct line between the location that the vehicle exits the loiter radius and the next waypoint. NaN to use the current system default xtrack behaviour.|  |  |"]
    #[doc = "| 5 (Latitude)| Latitude    |  |  |"]
    #[doc = "| 6 (Longitude)| Longitude   |  |  |"]
    #[doc = "| 7 (Altitude)| Altitude    |  | m |"]
    MAV_CMD_NAV_LOITER_TIME = 19,
    #[doc = "Return to launch location"]
    #[doc = ""]
    #[doc = "# Parameters"]
    #[doc = ""]
    #[doc = "| Parameter | Description |"]
    #[doc = "| --------- | ----------- |"]
    #[doc = "| 1         | Empty       |"]
    #[doc = "| 2         | Empty       |"]
    #[doc = "| 3         | Empty       |"]
    #[doc = "| 4         | Empty       |"]
    #[doc = "| 5         | Empty       |"]
    #[doc = "| 6         | Empty       |"]
    #[doc = "| 7         | Empty       |"]
    MAV_CMD_NAV_RETURN_TO_LAUNCH = 20,
    #[doc = "Land at location."]
    #[doc = ""]
    #[doc = "# Parameters"]
    #[doc = ""]
    #[doc = "| Parameter | Description | Values | Units |"]
    #[doc = "| --------- | ----------- | ------ | ----- |"]
    #[doc = "| 1 (Abort Alt)| Minimum target altitude if landing is aborted (0 = undefined/use system default).|  | m |"]
    #[doc = "| 2 (Land Mode)| Precision land mode.| [`PrecisionLandMode`] |  |"]
    #[doc = "| 3         | Empty.      |  |  |"]
    #[doc = "| 4 (Yaw Angle)| Desired yaw angle. NaN to use the current system yaw heading mode (e.g. yaw towards next waypoint, yaw to home, etc.).|  | deg |"]
    #[doc = "| 5 (Latitude)| Latitude.   |  |  |"]
    #[doc = "| 6 (Longitude)| Longitude.  |  |  |"]
    #[doc = "| 7 (Altitude)| Landing altitude (ground level in current frame).|  | m |"]
    MAV_CMD_NAV_LAND = 21,
    #[doc = "Takeoff from ground / hand. Vehicles that support multiple takeoff modes (e.g. VTOL quadplane) should take off using the currently configured mode."]
    #[doc = ""]
    #[doc = "# Parameters"]
    #[doc = ""]
    #[doc = "| Parameter | Description | Values | Units |"]
    #[doc = "| --------- | ----------- | ------ | ----- |"]
    #[doc = "| 1 (Pitch) | Minimum pitch (if airspeed sensor present), desired pitch without sensor|  | deg |"]
    #[doc = "| 2         | Empty       |  |  |"]
    #[doc = "| 3 (Flags) | Bitmask of options flags.| [`NavTakeoffFlags`] |  |"]
    #[doc = "| 4 (Yaw)   | Yaw angle (if magnetometer present), ignored without magnetometer. NaN to use the current system yaw heading mode (e.g. yaw towards next waypoint, yaw to home, etc.).|  | deg |"]
    #[doc = "| 5 (Latitude)| Latitude    |  |  |"]
    #[doc = "| 6 (Longitude)| Longitude   |  |  |"]
    #[doc = "| 7 (Altitude)| Altitude    |  | m |"]
    MAV_CMD_NAV_TAKEOFF = 22,
    #[doc = "Begin loiter at the specified Latitude and Longitude.  If Lat=Lon=0, then loiter at the current position.  Don't consider the navigation command complete (don't leave loiter) until the altitude has been reached. Additionally, if the Heading Required parameter is non-zero the aircraft will not leave the loiter until heading toward the next waypoint."]
    #[doc = ""]
    #[doc = "# Parameters"]
    #[doc = ""]
    #[doc = "| Parameter | Description | Values | Units |"]
    #[doc = "| --------- | ----------- | ------ | ----- |"]
    #[doc = "| 1 (Heading Required)| Leave loiter circle only when track heading towards the next waypoint (MAV_BOOL_FALSE: Leave when altitude reached). Values not equal to 0 or 1 are invalid.| [`MavBool`] |  |"]
    #[doc = "| 2 (Radius)| Loiter radius around waypoint for forward-only moving vehicles (not multicopters). If positive loiter clockwise, negative counter-clockwise, 0 means no change to standard loiter.|  | m |"]
    #[doc = "| 3         | Empty       |  |  |"]
    #[doc = "| 4 (Xtrack Location)| Loiter circle exit location and/or path to next waypoint (\"xtrack\") for forward-only moving vehicles (not multicopters). 0 for the vehicle to converge towards the center xtrack when it leaves the loiter (the line between the centers of the current and next waypoint), 1 to converge to the direct line between the location that the vehicle exits the loiter radius and the next waypoint. NaN to use the current system default xtrack behaviour.| 0, 1 |  |"]
    #[doc = "| 5 (Latitude)| Latitude    |  |  |"]
    #[doc = "| 6 (Longitude)| Longitude   |  |  |"]
    #[doc = "| 7 (Altitude)| Altitude    |  | m |"]
    MAV_CMD_NAV_LOITER_TO_ALT = 31,
    #[doc = "Start orbiting on the circumference of a circle defined by the parameters. Setting values to NaN/INT32_MAX (as appropriate) results in using defaults."]
    #[doc = ""]
    #[doc = "# Parameters"]
    #[doc = ""]
    #[doc = "| Parameter | Description | Values | Units |"]
    #[doc = "| --------- | ----------- | ------ | ----- |"]
    #[doc = "| 1 (Radius)| Radius of the circle. Positive: orbit clockwise. Negative: orbit counter-clockwise. NaN: Use vehicle default radius, or current radius if already orbiting.|  | m |"]
    #[doc = "| 2 (Velocity)| Tangential Velocity. NaN: Use vehicle default velocity, or current velocity if already orbiting.|  | m/s |"]
    #[doc = "| 3 (Yaw Behavior)| Yaw behavior of the vehicle.| [`OrbitYawBehaviour`] |  |"]
    #[doc = "| 4 (Orbits)| Orbit around the centre point for this many radians (i.e. for a three-quarter orbit set 270*Pi/180). 0: Orbit forever. NaN: Use vehicle default, or current value if already orbiting.| &ge; 0 | rad |"]
    #[doc = "| 5 (Latitude/X)| Center point latitude (if no MAV_FRAME specified) / X coordinate according to MAV_FRAME. INT32_MAX (or NaN if sent in COMMAND_LONG): Use current vehicle position, or current center if already orbiting.|  |  |"]
    #[doc = "| 6 (Longitude/Y)| Center point longitude (if no MAV_FRAME specified) / Y coordinate according to MAV_FRAME. INT32_MAX (or NaN if sent in COMMAND_LONG): Use current vehicle position, or current center if already orbiting.|  |  |"]
    #[doc = "| 7 (Altitude/Z)| Center point altitude (MSL) (if no MAV_FRAME specified) / Z coordinate according to MAV_FRAME. NaN: Use current vehicle altitude.|  |  |"]
    MAV_CMD_DO_ORBIT = 34,
    #[doc = "Delay the next navigation command a number of seconds or until a specified time"]
    #[doc = ""]
    #[doc = "# Parameters"]
    #[doc = ""]
    #[doc = "| Parameter | Description | Values | Units |"]
    #[doc = "| --------- | ----------- | ------ | ----- |"]
    #[doc = "| 1 (Delay) | Delay (-1 to enable time-of-day fields)| -1, 0, .. | s |"]
    #[doc = "| 2 (Hour)  | hour (24h format, UTC, -1 to ignore)| -1, 0, .. , 23 |  |"]
    #[doc = "| 3 (Minute)| minute (24h format, UTC, -1 to ignore)| -1, 0, .. , 59 |  |"]
    #[doc = "| 4 (Second)| second (24h format, UTC, -1 to ignore)| -1, 0, .. , 59 |  |"]
    #[doc = "| 5         | Empty       |  |  |"]
    #[doc = "| 6         | Empty       |  |  |"]
    #[doc = "| 7         | Empty       |  |  |"]
    MAV_CMD_NAV_DELAY = 93,
    #[doc = "Delay mission state machine."]
    #[doc = ""]
    #[doc = "# Parameters"]
    #[doc = ""]
    #[doc = "| Parameter | Description | Values | Units |"]
    #[doc = "| --------- | ----------- | ------ | ----- |"]
    #[doc = "| 1 (Delay) | Delay       | &ge; 0 | s |"]
    #[doc = "| 2         | Empty       |  |  |"]
    #[doc = "| 3         | Empty       |  |  |"]
    #[doc = "| 4         | Empty       |  |  |"]
    #[doc = "| 5         | Empty       |  |  |"]
    #[doc = "| 6         | Empty       |  |  |"]
    #[doc = "| 7         | Empty       |  |  |"]
    MAV_CMD_CONDITION_DELAY = 112,
    #[doc = "Reach a certain target angle."]
    #[doc = ""]
    #[doc = "# Parameters"]
    #[doc = ""]
    #[doc = "| Parameter | Description | Values | Units |"]
    #[doc = "| --------- | ----------- | ------ | ----- |"]
    #[doc = "| 1 (Angle) | target angle [0-360]. Absolute angles: 0 is north. Relative angle: 0 is initial yaw. Direction set by param3.| 0 .. 360 | deg |"]
    #[doc = "| 2 (Angular Speed)| angular speed| &ge; 0 | deg/s |"]
    #[doc = "| 3 (Direction)| direction: -1: counter clockwise, 0: shortest direction, 1: clockwise| -1, 0, 1 |  |"]
    #[doc = "| 4 (Relative)| Relative offset (MAV_BOOL_FALSE: absolute angle). Values not equal to 0 or 1 are invalid.| [`MavBool`] |  |"]
    #[doc = "| 5         | Empty       |  |  |"]
    #[doc = "| 6         | Empty       |  |  |"]
    #[doc = "| 7         | Empty       |  |  |"]
    MAV_CMD_CONDITION_YAW = 115,
    #[doc = "Set system mode."]
    #[doc = ""]
    #[doc = "# Parameters"]
    #[doc = ""]
    #[doc = "| Parameter | Description | Values |"]
    #[doc = "| --------- | ----------- | ------ |"]
    #[doc = "| 1 (Mode)  | Mode flags. MAV_MODE values can be used to set some mode flag combinations.| [`MavModeFlag`] |"]
    #[doc = "| 2 (Custom Mode)| Custom system-specific mode (see target autopilot specifications for mode information). If MAV_MODE_FLAG_CUSTOM_MODE_ENABLED is set in param1 (mode) this mode is used: otherwise the field is ignored.|  |"]
    #[doc = "| 3 (Custom Submode)| Custom sub mode - this is system specific, please refer to the individual autopilot specifications for details.|  |"]
    #[doc = "| 4         | Empty       |  |"]
    #[doc = "| 5         | Empty       |  |"]
    #[doc = "| 6         | Empty       |  |"]
    #[doc = "| 7         | Empty       |  |"]
    MAV_CMD_DO_SET_MODE = 176,
    #[doc = "Jump to the desired command in the mission list.  Repeat this action only the specified number of times"]
    #[doc = ""]
    #[doc = "# Parameters"]
    #[doc = ""]
    #[doc = "| Parameter | Description | Values |"]
    #[doc = "| --------- | ----------- | ------ |"]
    #[doc = "| 1 (Number)| Sequence number| 0, 1, .. |"]
    #[doc = "| 2 (Repeat)| Repeat count| 0, 1, .. |"]
    #[doc = "| 3         | Empty       |  |"]
    #[doc = "| 4         | Empty       |  |"]
    #[doc = "| 5         | Empty       |  |"]
    #[doc = "| 6         | Empty       |  |"]
    #[doc = "| 7         | Empty       |  |"]
    MAV_CMD_DO_JUMP = 177,
    #[doc = "Change speed and/or throttle set points. The value persists until it is overridden or there is a mode change"]
    #[doc = ""]
    #[doc = "# Parameters"]
    #[doc = ""]
    #[doc = "| Parameter | Description | Values | Units |"]
    #[doc = "| --------- | ----------- | ------ | ----- |"]
    #[doc = "| 1 (Speed Type)| Speed type of value set in param2 (such as airspeed, ground speed, and so on)| [`SpeedType`] |  |"]
    #[doc = "| 2 (Speed) | Speed (-1 indicates no change, -2 indicates return to default vehicle speed)| &ge; -2 | m/s |"]
    #[doc = "| 3 (Throttle)| Throttle (-1 indicates no change, -2 indicates return to default vehicle throttle value)| &ge; -2 | % |"]
    #[doc = "| 4         |             | Reserved (use 0) |  |"]
    #[doc = "| 5         |             | Reserved (use 0) |  |"]
    #[doc = "| 6         |             | Reserved (use 0) |  |"]
    #[doc = "| 7         |             | Reserved (use 0) |  |"]
    MAV_CMD_DO_CHANGE_SPEED = 178,
    #[doc = "Sets the home position to either to the current position or a specified position.           The home position is the default position that the system will return to and land on.           The position is set automatically by the system during the takeoff (and may also be set using this command).           Note: the current home position may be emitted in a HOME_POSITION message on request (using MAV_CMD_REQUEST_MESSAGE with param1=242)."]
    #[doc = ""]
    #[doc = "# Parameters"]
    #[doc = ""]
    #[doc = "| Parameter | Description | Values | Units |"]
    #[doc = "| --------- | ----------- | ------ | ----- |"]
    #[doc = "| 1 (Use Current)| Use current location (MAV_BOOL_FALSE: use specified location). Values not equal to 0 or 1 are invalid.| [`MavBool`] |  |"]
    #[doc = "| 2 (Roll)  | Roll angle (of surface). Range: -180..180 degrees. NAN or 0 means value not set. 0.01 indicates zero roll.| -180 .. 180 | deg |"]
    #[doc = "| 3 (Pitch) | Pitch angle (of surface). Range: -90..90 degrees. NAN or 0 means value not set. 0.01 means zero pitch.| -90 .. 90 | deg |"]
    #[doc = "| 4 (Yaw)   | Yaw angle. NaN to use default heading. Range: -180..180 degrees.| -180 .. 180 | deg |"]
    #[doc = "| 5 (Latitude)| Latitude    |  |  |"]
    #[doc = "| 6 (Longitude)| Longitude   |  |  |"]
    #[doc = "| 7 (Altitude)| Altitude    |  | m |"]
    MAV_CMD_DO_SET_HOME = 179,
    #[doc = "Terminate flight immediately.           Flight termination immediately and irreversibly terminates the current flight, returning the vehicle to ground.           The vehicle will ignore RC or other input until it has been power-cycled.           Termination may trigger safety measures, including: disabling motors and deployment of parachute on multicopters, and setting flight surfaces to initiate a landing pattern on fixed-wing).           On multicopters without a parachute it may trigger a crash landing.           Support for this command can be tested using the protocol bit: MAV_PROTOCOL_CAPABILITY_FLIGHT_TERMINATION.           Support for this command can also be tested by sending the command with param1=0 (<0.5); the ACK should be either MAV_RESULT_FAILED or MAV_RESULT_UNSUPPORTED."]
    #[doc = ""]
    #[doc = "# Parameters"]
    #[doc = ""]
    #[doc = "| Parameter | Description | Values |"]
    #[doc = "| --------- | ----------- | ------ |"]
    #[doc = "| 1 (Terminate)| Flight termination activated if>0.5. Otherwise not activated and ACK with MAV_RESULT_FAILED.| 0, 1 |"]
    #[doc = "| 2         | Empty       |  |"]
    #[doc = "| 3         | Empty       |  |"]
    #[doc = "| 4         | Empty       |  |"]
    #[doc = "| 5         | Empty       |  |"]
    #[doc = "| 6         | Empty       |  |"]
    #[doc = "| 7         | Empty       |  |"]
    MAV_CMD_DO_FLIGHTTERMINATION = 185,
    #[doc = "Reposition the vehicle to a specific WGS84 global position. This command is intended for guided commands (for missions use MAV_CMD_NAV_WAYPOINT instead)."]
    #[doc = ""]
    #[doc = "# Parameters"]
    #[doc = ""]
    #[doc = "| Parameter | Description | Values | Units |"]
    #[doc = "| --------- | ----------- | ------ | ----- |"]
    #[doc = "| 1 (Speed) | Ground speed, less than 0 (-1) for default| &ge; -1 | m/s |"]
    #[doc = "| 2 (Bitmask)| Bitmask of option flags.| [`MavDoRepositionFlags`] |  |"]
    #[doc = "| 3 (Radius)| Loiter radius for planes. Positive values only, direction is controlled by Yaw value. A value of zero or NaN is ignored.|  | m |"]
    #[doc = "| 4 (Yaw)   | Yaw heading (heading reference defined in Bitmask field). NaN to use the current system yaw heading mode (e.g. yaw towards next waypoint, yaw to home, etc.). For planes indicates loiter direction (0: clockwise, 1: counter clockwise)|  | rad |"]
    #[doc = "| 5 (Latitude)| Latitude    |  |  |"]
    #[doc = "| 6 (Longitude)| Longitude   |  |  |"]
    #[doc = "| 7 (Altitude)| Altitude    |  | m |"]
    MAV_CMD_DO_REPOSITION = 192,
    #[doc = "If in a GPS controlled position mode, hold the current position or continue."]
    #[doc = ""]
    #[doc = "# Parameters"]
    #[doc = ""]
    #[doc = "| Parameter | Description | Values |"]
    #[doc = "| --------- | ----------- | ------ |"]
    #[doc = "| 1 (Continue)| Continue mission (MAV_BOOL_TRUE), Pause current mission or reposition command, hold current position (MAV_BOOL_FALSE). Values not equal to 0 or 1 are invalid. A VTOL capable vehicle should enter hover mode (multicopter and VTOL planes). A plane should loiter with the default loiter radius.| [`MavBool`] |"]
    #[doc = "| 2         | Reserved    |  |"]
    #[doc = "| 3         | Reserved    |  |"]
    #[doc = "| 4         | Reserved    |  |"]
    #[doc = "| 5         | Reserved    |  |"]
    #[doc = "| 6         | Reserved    |  |"]
    #[doc = "| 7         | Reserved    |  |"]
    MAV_CMD_DO_PAUSE_CONTINUE = 193,
    #[doc = "Sets the region of interest (ROI) to a location. This can then be used by the vehicle's control system to control the vehicle attitude and the attitude of various sensors such as cameras. This command can be sent to a gimbal manager but not to a gimbal device. A gimbal is not to react to this message."]
    #[doc = ""]
    #[doc = "# Parameters"]
    #[doc = ""]
    #[doc = "| Parameter | Description | Units |"]
    #[doc = "| --------- | ----------- | ----- |"]
    #[doc = "| 1 (Gimbal device ID)| Component ID of gimbal device to address (or 1-6 for non-MAVLink gimbal), 0 for all gimbal device components. Send command multiple times for more than one gimbal (but not all gimbals).|  |"]
    #[doc = "| 2         | Empty       |  |"]
    #[doc = "| 3         | Empty       |  |"]
    #[doc = "| 4         | Empty       |  |"]
    #[doc = "| 5 (Latitude)| Latitude of ROI location|  |"]
    #[doc = "| 6 (Longitude)| Longitude of ROI location|  |"]
    #[doc = "| 7 (Altitude)| Altitude of ROI location| m |"]
    MAV_CMD_DO_SET_ROI_LOCATION = 195,
    #[doc = "Set the mission item with sequence number seq as the current item and emit MISSION_CURRENT (whether or not the mission number changed).           If a mission is currently being executed, the system will continue to this new mission item on the shortest path, skipping any intermediate mission items. \t  Note that mission jump repeat counters are not reset unless param2 is set (see MAV_CMD_DO_JUMP param2).            This command may trigger a mission state-machine change on some systems: for example from MISSION_STATE_NOT_STARTED or MISSION_STATE_PAUSED to MISSION_STATE_ACTIVE.           If the system is in mission mode, on those systems this command might therefore start, restart or resume the mission.           If the system is not in mission mode this command must not trigger a switch to mission mode.            The mission may be \"reset\" using param2.           Resetting sets jump counters to initial values (to reset counters without changing the current mission item set the param1 to `-1`).           Resetting also explicitly changes a mission state of MISSION_STATE_COMPLETE to MISSION_STATE_PAUSED or MISSION_STATE_ACTIVE, potentially allowing it to resume when it is (next) in a mission mode.  \t  The command will ACK with MAV_RESULT_FAILED if the sequence number is out of range (including if there is no mission item)."]
    #[doc = ""]
    #[doc = "# Parameters"]
    #[doc = ""]
    #[doc = "| Parameter | Description | Values |"]
    #[doc = "| --------- | ----------- | ------ |"]
    #[doc = "| 1 (Number)| Mission sequence value to set. -1 for the current mission item (use to reset mission without changing current mission item).| -1, 0, .. |"]
    #[doc = "| 2 (Reset Mission)| Reset mission (MAV_BOOL_TRUE). Values not equal to 0 or 1 are invalid. Resets jump counters to initial values and changes mission state \"completed\" to be \"active\" or \"paused\".| [`MavBool`] |"]
    #[doc = "| 3         | Empty       |  |"]
    #[doc = "| 4         | Empty       |  |"]
    #[doc = "| 5         | Empty       |  |"]
    #[doc = "| 6         | Empty       |  |"]
    #[doc = "| 7         | Empty       |  |"]
    MAV_CMD_DO_SET_MISSION_CURRENT = 224,
    #[doc = "Request storage of different parameter values and logs. This command will be only accepted if in pre-flight mode."]
    #[doc = ""]
    #[doc = "# Parameters"]
    #[doc = ""]
    #[doc = "| Parameter | Description | Values | Units |"]
    #[doc = "| --------- | ----------- | ------ | ----- |"]
    #[doc = "| 1 (Parameter Storage)| Action to perform on the persistent parameter storage| [`PreflightStorageParameterAction`] |  |"]
    #[doc = "| 2         | Reserved    |  |  |"]
    #[doc = "| 3 (Logging Rate)| Onboard logging: 0: Ignore, 1: Start default rate logging, -1: Stop logging,>1: logging rate (e.g. set to 1000 for 1000 Hz logging)| -1, 0, .. | Hz |"]
    #[doc = "| 4         | Reserved    |  |  |"]
    #[doc = "| 5         | Empty       |  |  |"]
    #[doc = "| 6         | Empty       |  |  |"]
    #[doc = "| 7         | Empty       |  |  |"]
    MAV_CMD_PREFLIGHT_STORAGE = 245,
    #[doc = "Request the reboot or shutdown of system components."]
    #[doc = ""]
    #[doc = "# Parameters"]
    #[doc = ""]
    #[doc = "| Parameter | Description | Values |"]
    #[doc = "| --------- | ----------- | ------ |"]
    #[doc = "| 1 (Autopilot)| Action to take for autopilot.| [`RebootShutdownAction`] |"]
    #[doc = "| 2 (Companion)| Action to take for onboard computer.| [`RebootShutdownAction`] |"]
    #[doc = "| 3 (Component Action)| Action to take for component specified in param4.| [`RebootShutdownAction`] |"]
    #[doc = "| 4 (Component ID)| MAVLink Component ID targeted in param3 (0 for all components).| 0, 1, .. , 255 |"]
    #[doc = "| 5         | Reserved (set to 0)|  |"]
    #[doc = "| 6 (Conditions)| Conditions under which reboot/shutdown is allowed.| [`RebootShutdownConditions`] |"]
    #[doc = "| 7         | WIP: ID (e.g. camera ID -1 for all IDs)|  |"]
    MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN = 246,
    #[doc = "Enable the specified standard MAVLink mode.           If the specified mode is not supported, the vehicle should ACK with MAV_RESULT_FAILED.           See <https://mavlink.io/en/services/standard_modes.html>"]
    #[doc = ""]
    #[doc = "# Parameters"]
    #[doc = ""]
    #[doc = "| Parameter | Description | Values |"]
    #[doc = "| --------- | ----------- | ------ |"]
    #[doc = "| 1 (Standard Mode)| The mode to set.| [`MavStandardMode`] |"]
    #[doc = "| 2         |             | Reserved (use 0) |"]
    #[doc = "| 3         |             | Reserved (use 0) |"]
    #[doc = "| 4         |             | Reserved (use 0) |"]
    #[doc = "| 5         |             | Reserved (use 0) |"]
    #[doc = "| 6         |             | Reserved (use 0) |"]
    #[doc = "| 7         |             | Reserved (use NaN) |"]
    MAV_CMD_DO_SET_STANDARD_MODE = 262,
    #[doc = "start running a mission"]
    #[doc = ""]
    #[doc = "# Parameters"]
    #[doc = ""]
    #[doc = "| Parameter | Description | Values |"]
    #[doc = "| --------- | ----------- | ------ |"]
    #[doc = "| 1 (First Item)| first_item: the first mission item to run| 0, 1, .. |"]
    #[doc = "| 2 (Last Item)| last_item:  the last mission item to run (after this item is run, the mission ends)| 0, 1, .. |"]
    MAV_CMD_MISSION_START = 300,
    #[doc = "Arms / Disarms a component"]
    #[doc = ""]
    #[doc = "# Parameters"]
    #[doc = ""]
    #[doc = "| Parameter | Description | Values |"]
    #[doc = "| --------- | ----------- | ------ |"]
    #[doc = "| 1 (Arm)   | Arm (MAV_BOOL_FALSE: disarm). Values not equal to 0 or 1 are invalid.| [`MavBool`] |"]
    #[doc = "| 2 (Force) | 0: arm-disarm unless prevented by safety checks (i.e. when landed), 21196: force arming/disarming (e.g. allow arming to override preflight checks and disarming in flight)| 0, 21196 |"]
    MAV_CMD_COMPONENT_ARM_DISARM = 400,
    #[doc = "Instructs a target system to run pre-arm checks.           This allows preflight checks to be run on demand, which may be useful on systems that normally run them at low rate, or which do not trigger checks when the armable state might have changed.           This command should return MAV_RESULT_ACCEPTED if it will run the checks.           The results of the checks are usually then reported in SYS_STATUS messages (this is system-specific).           The command should return MAV_RESULT_TEMPORARILY_REJECTED if the system is already armed."]
    MAV_CMD_RUN_PREARM_CHECKS = 401,
    #[deprecated = " See `MAV_CMD_REQUEST_MESSAGE` (Superseded since 2022-04)"]
    #[doc = "Request the home position from the vehicle.           The vehicle will ACK the command and emit the HOME_POSITION message."]
    #[doc = ""]
    #[doc = "# Parameters"]
    #[doc = ""]
    #[doc = "| Parameter | Description |"]
    #[doc = "| --------- | ----------- |"]
    #[doc = "| 1         | Reserved    |"]
    #[doc = "| 2         | Reserved    |"]
    #[doc = "| 3         | Reserved    |"]
    #[doc = "| 4         | Reserved    |"]
    #[doc = "| 5         | Reserved    |"]
    #[doc = "| 6         | Reserved    |"]
    #[doc = "| 7         | Reserved    |"]
    MAV_CMD_GET_HOME_POSITION = 410,
    #[deprecated = " See `MAV_CMD_REQUEST_MESSAGE` (Superseded since 2022-04)"]
    #[doc = "Request the interval between messages for a particular MAVLink message ID.           The receiver should ACK the command and then emit its response in a MESSAGE_INTERVAL message."]
    #[doc = ""]
    #[doc = "# Parameters"]
    #[doc = ""]
    #[doc = "| Parameter | Description | Values |"]
    #[doc = "| --------- | ----------- | ------ |"]
    #[doc = "| 1 (Message ID)| The MAVLink message ID| 0, 1, .. , 16777215 |"]
    MAV_CMD_GET_MESSAGE_INTERVAL = 510,
    #[doc = "Set the interval between messages for a particular MAVLink message ID. This interface replaces REQUEST_DATA_STREAM."]
    #[doc = ""]
    #[doc = "# Parameters"]
    #[doc = ""]
    #[doc = "| Parameter | Description | Values | Units |"]
    #[doc = "| --------- | ----------- | ------ | ----- |"]
    #[doc = "| 1 (Message ID)| The MAVLink message ID| 0, 1, .. , 16777215 |  |"]
    #[doc = "| 2 (Interval)| The interval between two messages. -1: disable. 0: request default rate (which may be zero).| -1, 0, .. | us |"]
    #[doc = "| 3 (Req Param 3)| Use for index ID, if required. Otherwise, the use of this parameter (if any) must be defined in the requested message. By default assumed not used (0).  When used as an index ID, 0 means \"all instances\", \"1\" means the first instance in the sequence (the emitted message will have an id of 0 if message ids are 0-indexed, or 1 if index numbers start from one).|  |  |"]
    #[doc = "| 4 (Req Param 4)| The use of this parameter (if any), must be defined in the requested message. By default assumed not used (0).|  |  |"]
    #[doc = "| 5 (Req Param 5)| The use of this parameter (if any), must be defined in the requested message. By default assumed not used (0/NaN).|  |  |"]
    #[doc = "| 6 (Req Param 6)| The use of this parameter (if any), must be defined in the requested message. By default assumed not used (0/NaN).|  |  |"]
    #[doc = "| 7 (Response Target)| Target address of message stream (if message has target address fields). 0: Flight-stack default (recommended), 1: address of requester, 2: broadcast.| 0, 1, 2 |  |"]
    MAV_CMD_SET_MESSAGE_INTERVAL = 511,
    #[doc = "Request the target system(s) emit a single instance of a specified message (i.e. a \"one-shot\" version of MAV_CMD_SET_MESSAGE_INTERVAL)."]
    #[doc = ""]
    #[doc = "# Parameters"]
    #[doc = ""]
    #[doc = "| Parameter | Description | Values |"]
    #[doc = "| --------- | ----------- | ------ |"]
    #[doc = "| 1 (Message ID)| The MAVLink message ID of the requested message.| 0, 1, .. , 16777215 |"]
    #[doc = "| 2 (Req Param 1)| Use for index ID, if required. Otherwise, the use of this parameter (if any) must be defined in the requested message. By default assumed not used (0).|  |"]
    #[doc = "| 3 (Req Param 2)| The use of this parameter (if any), must be defined in the requested message. By default assumed not used (0).|  |"]
    #[doc = "| 4 (Req Param 3)| The use of this parameter (if any), must be defined in the requested message. By default assumed not used (0).|  |"]
    #[doc = "| 5 (Req Param 4)| The use of this parameter (if any), must be defined in the requested message. By default assumed not used (0).|  |"]
    #[doc = "| 6 (Req Param 5)| The use of this parameter (if any), must be defined in the requested message. By default assumed not used (0).|  |"]
    #[doc = "| 7 (Response Target)| Target address for requested message (if message has target address fields). 0: Flight-stack default, 1: address of requester, 2: broadcast.| 0, 1, 2 |"]
    MAV_CMD_REQUEST_MESSAGE = 512,
    #[deprecated = " See `MAV_CMD_REQUEST_MESSAGE` (Deprecated since 2025-11)"]
    #[doc = "Request MAVLink protocol version compatibility. All receivers should ACK the command and then emit their capabilities in an PROTOCOL_VERSION message"]
    #[doc = ""]
    #[doc = "# Parameters"]
    #[doc = ""]
    #[doc = "| Parameter | Description | Values |"]
    #[doc = "| --------- | ----------- | ------ |"]
    #[doc = "| 1 (Protocol)| Request supported protocol versions by all nodes on the network (MAV_BOOL_TRUE). Values not equal to 0 or 1 are invalid.| [`MavBool`] |"]
    #[doc = "| 2         | Reserved (all remaining params)|  |"]
    MAV_CMD_REQUEST_PROTOCOL_VERSION = 519,
    #[deprecated = " See `MAV_CMD_REQUEST_MESSAGE` (Superseded since 2019-08)"]
    #[doc = "Request autopilot capabilities. The receiver should ACK the command and then emit its capabilities in an AUTOPILOT_VERSION message"]
    #[doc = ""]
    #[doc = "# Parameters"]
    #[doc = ""]
    #[doc = "| Parameter | Description | Values |"]
    #[doc = "| --------- | ----------- | ------ |"]
    #[doc = "| 1 (Version)| Request autopilot version (MAV_BOOL_TRUE). Values not equal to 0 or 1 are invalid.| [`MavBool`] |"]
    #[doc = "| 2         | Reserved (all remaining params)|  |"]
    MAV_CMD_REQUEST_AUTOPILOT_CAPABILITIES = 520,
    #[deprecated = " See `MAV_CMD_REQUEST_MESSAGE` (Superseded since 2019-08)"]
    #[doc = "Request camera information (CAMERA_INFORMATION)."]
    #[doc = ""]
    #[doc = "# Parameters"]
    #[doc = ""]
    #[doc = "| Parameter | Description | Values |"]
    #[doc = "| --------- | ----------- | ------ |"]
    #[doc = "| 1 (Capabilities)| Request camera capabilities (MAV_BOOL_TRUE). Values not equal to 0 or 1 are invalid.| [`MavBool`] |"]
    #[doc = "| 2         | Reserved (all remaining params)|  |"]
    MAV_CMD_REQUEST_CAMERA_INFORMATION = 521,
    #[deprecated = " See `MAV_CMD_REQUEST_MESSAGE` (Superseded since 2019-08)"]
    #[doc = "Request video stream information (VIDEO_STREAM_INFORMATION)"]
    #[doc = ""]
    #[doc = "# Parameters"]
    #[doc = ""]
    #[doc = "| Parameter | Description | Values |"]
    #[doc = "| --------- | ----------- | ------ |"]
    #[doc = "| 1 (Stream ID)| Video Stream ID (0 for all streams, 1 for first, 2 for second, etc.)| 0, 1, .. |"]
    MAV_CMD_REQUEST_VIDEO_STREAM_INFORMATION = 2504,
}
impl MavCmd {
    pub const DEFAULT: Self = Self::MAV_CMD_NAV_WAYPOINT;
}
impl Default for MavCmd {
    fn default() -> Self {
        Self::DEFAULT
    }
}
#[derive(Debug, Copy, Clone, PartialEq, FromPrimitive, ToPrimitive)]
#[repr(u32)]
#[deprecated = " See `MESSAGE_INTERVAL` (Superseded since 2015-06)"]
#[doc = "A data stream is not a fixed set of messages, but rather a      recommendation to the autopilot software. Individual autopilots may or may not obey      the recommended messages."]
pub enum MavDataStream {
    #[doc = "Enable all data streams"]
    MAV_DATA_STREAM_ALL = 0,
    #[doc = "Enable IMU_RAW, GPS_RAW, GPS_STATUS packets."]
    MAV_DATA_STREAM_RAW_SENSORS = 1,
    #[doc = "Enable GPS_STATUS, CONTROL_STATUS, AUX_STATUS"]
    MAV_DATA_STREAM_EXTENDED_STATUS = 2,
    #[doc = "Enable RC_CHANNELS_SCALED, RC_CHANNELS_RAW, SERVO_OUTPUT_RAW"]
    MAV_DATA_STREAM_RC_CHANNELS = 3,
    #[doc = "Enable ATTITUDE_CONTROLLER_OUTPUT, POSITION_CONTROLLER_OUTPUT, NAV_CONTROLLER_OUTPUT."]
    MAV_DATA_STREAM_RAW_CONTROLLER = 4,
    #[doc = "Enable LOCAL_POSITION, GLOBAL_POSITION_INT messages."]
    MAV_DATA_STREAM_POSITION = 6,
    #[doc = "Dependent on the autopilot"]
    MAV_DATA_STREAM_EXTRA1 = 10,
    #[doc = "Dependent on the autopilot"]
    MAV_DATA_STREAM_EXTRA2 = 11,
    #[doc = "Dependent on the autopilot"]
    MAV_DATA_STREAM_EXTRA3 = 12,
}
impl MavDataStream {
    pub const DEFAULT: Self = Self::MAV_DATA_STREAM_ALL;
}
impl Default for MavDataStream {
    fn default() -> Self {
        Self::DEFAULT
    }
}
#[derive(Debug, Copy, Clone, PartialEq, FromPrimitive, ToPrimitive)]
#[repr(u32)]
#[doc = "Enumeration of distance sensor types"]
pub enum MavDistanceSensor {
    #[doc = "Laser rangefinder, e.g. LightWare SF02/F or PulsedLight units"]
    MAV_DISTANCE_SENSOR_LASER = 0,
    #[doc = "Ultrasound rangefinder, e.g. MaxBotix units"]
    MAV_DISTANCE_SENSOR_ULTRASOUND = 1,
    #[doc = "Infrared rangefinder, e.g. Sharp units"]
    MAV_DISTANCE_SENSOR_INFRARED = 2,
    #[doc = "Radar type, e.g. uLanding units"]
    MAV_DISTANCE_SENSOR_RADAR = 3,
    #[doc = "Broken or unknown type, e.g. analog units"]
    MAV_DISTANCE_SENSOR_UNKNOWN = 4,
}
impl MavDistanceSensor {
    pub const DEFAULT: Self = Self::MAV_DISTANCE_SENSOR_LASER;
}
impl Default for MavDistanceSensor {
    fn default() -> Self {
        Self::DEFAULT
    }
}
#[derive(Debug, Copy, Clone, PartialEq, FromPrimitive, ToPrimitive)]
#[repr(u32)]
#[doc = "Enumeration of estimator types"]
pub enum MavEstimatorType {
    #[doc = "Unknown type of the estimator."]
    MAV_ESTIMATOR_TYPE_UNKNOWN = 0,
    #[doc = "This is a naive estimator without any real covariance feedback."]
    MAV_ESTIMATOR_TYPE_NAIVE = 1,
    #[doc = "Computer vision based estimate. Might be up to scale."]
    MAV_ESTIMATOR_TYPE_VISION = 2,
    #[doc = "Visual-inertial estimate."]
    MAV_ESTIMATOR_TYPE_VIO = 3,
    #[doc = "Plain GPS estimate."]
    MAV_ESTIMATOR_TYPE_GPS = 4,
    #[doc = "Estimator integrating GPS and inertial sensing."]
    MAV_ESTIMATOR_TYPE_GPS_INS = 5,
    #[doc = "Estimate from external motion capturing system."]
    MAV_ESTIMATOR_TYPE_MOCAP = 6,
    #[doc = "Estimator based on lidar sensor input."]
    MAV_ESTIMATOR_TYPE_LIDAR = 7,
    #[doc = "Estimator on autopilot."]
    MAV_ESTIMATOR_TYPE_AUTOPILOT = 8,
}
impl MavEstimatorType {
    pub const DEFAULT: Self = Self::MAV_ESTIMATOR_TYPE_UNKNOWN;
}
impl Default for MavEstimatorType {
    fn default() -> Self {
        Self::DEFAULT
    }
}
bitflags! {     # [derive (Debug , Copy , Clone , PartialEq)] # [doc = "Flags for CURRENT_EVENT_SEQUENCE."] pub struct MavEventCurrentSequenceFlags : u8 { # [doc = "A sequence reset has happened (e.g. vehicle reboot)."] const MAV_EVENT_CURRENT_SEQUENCE_FLAGS_RESET = 1 ; } }
impl MavEventCurrentSequenceFlags {
    pub const DEFAULT: Self = Self::empty();
}
impl Default for MavEventCurrentSequenceFlags {
    fn default() -> Self {
        Self::DEFAULT
    }
}
#[derive(Debug, Copy, Clone, PartialEq, FromPrimitive, ToPrimitive)]
#[repr(u32)]
#[doc = "Coordinate frames used by MAVLink. Not all frames are supported by all commands, messages, or vehicles.        Global frames use the following naming conventions:       - \"GLOBAL\": Global coordinate frame with WGS84 latitude/longitude and altitude positive over mean sea level (MSL) by default.         The following modifiers may be used with \"GLOBAL\":         - \"RELATIVE_ALT\": Altitude is relative to the vehicle home position rather than MSL.         - \"TERRAIN_ALT\": Altitude is relative to ground level rather than MSL.         - \"INT\": Latitude/longitude (in degrees) are scaled by multiplying by 1E7.        Local frames use the following naming conventions:       - \"LOCAL\": Origin of local frame is fixed relative to earth. Unless otherwise specified this origin is the origin of the vehicle position-estimator (\"EKF\").       - \"BODY\": Origin of local frame travels with the vehicle. NOTE, \"BODY\" does NOT indicate alignment of frame axis with vehicle attitude.       - \"OFFSET\": Deprecated synonym for \"BODY\" (origin travels with the vehicle). Not to be used for new frames.        Some deprecated frames do not follow these conventions (e.g. MAV_FRAME_BODY_NED and MAV_FRAME_BODY_OFFSET_NED)."]
pub enum MavFrame {
    #[doc = "Global (WGS84) coordinate frame + altitude relative to mean sea level (MSL)."]
    MAV_FRAME_GLOBAL = 0,
    #[doc = "NED local tangent frame (x: North, y: East, z: Down) with origin fixed relative to earth."]
    MAV_FRAME_LOCAL_NED = 1,
    #[doc = "NOT a coordinate frame, indicates a mission command."]
    MAV_FRAME_MISSION = 2,
    #[doc = "Global (WGS84) coordinate frame + altitude relative to the home position."]
    MAV_FRAME_GLOBAL_RELATIVE_ALT = 3,
    #[doc = "ENU local tangent frame (x: East, y: North, z: Up) with origin fixed relative to earth."]
    MAV_FRAME_LOCAL_ENU = 4,
    #[deprecated = "Use MAV_FRAME_GLOBAL in COMMAND_INT (and elsewhere) as a synonymous replacement. See `MAV_FRAME_GLOBAL` (Superseded since 2024-03)"]
    #[doc = "Global (WGS84) coordinate frame (scaled) + altitude relative to mean sea level (MSL)."]
    MAV_FRAME_GLOBAL_INT = 5,
    #[deprecated = "Use MAV_FRAME_GLOBAL_RELATIVE_ALT in COMMAND_INT (and elsewhere) as a synonymous replacement. See `MAV_FRAME_GLOBAL_RELATIVE_ALT` (Superseded since 2024-03)"]
    #[doc = "Global (WGS84) coordinate frame (scaled) + altitude relative to the home position."]
    MAV_FRAME_GLOBAL_RELATIVE_ALT_INT = 6,
    #[doc = "NED local tangent frame (x: North, y: East, z: Down) with origin that travels with the vehicle."]
    MAV_FRAME_LOCAL_OFFSET_NED = 7,
    #[deprecated = " See `MAV_FRAME_BODY_FRD` (Superseded since 2019-08)"]
    #[doc = "Same as MAV_FRAME_LOCAL_NED when used to represent position values. Same as MAV_FRAME_BODY_FRD when used with velocity/acceleration values."]
    MAV_FRAME_BODY_NED = 8,
    #[deprecated = " See `MAV_FRAME_BODY_FRD` (Superseded since 2019-08)"]
    #[doc = "This is the same as MAV_FRAME_BODY_FRD."]
    MAV_FRAME_BODY_OFFSET_NED = 9,
    #[doc = "Global (WGS84) coordinate frame with AGL altitude (altitude at ground level)."]
    MAV_FRAME_GLOBAL_TERRAIN_ALT = 10,
    #[deprecated = "Use MAV_FRAME_GLOBAL_TERRAIN_ALT in COMMAND_INT (and elsewhere) as a synonymous replacement. See `MAV_FRAME_GLOBAL_TERRAIN_ALT` (Superseded since 2024-03)"]
    #[doc = "Global (WGS84) coordinate frame (scaled) with AGL altitude (altitude at ground level)."]
    MAV_FRAME_GLOBAL_TERRAIN_ALT_INT = 11,
    #[doc = "FRD local frame aligned to the vehicle's attitude (x: Forward, y: Right, z: Down) with an origin that travels with vehicle."]
    MAV_FRAME_BODY_FRD = 12,
    #[deprecated = "  (Deprecated since 2019-04)"]
    #[doc = "MAV_FRAME_BODY_FLU - Body fixed frame of reference, Z-up (x: Forward, y: Left, z: Up)."]
    MAV_FRAME_RESERVED_13 = 13,
    #[deprecated = " See `MAV_FRAME_LOCAL_FRD` (Deprecated since 2019-04)"]
    #[doc = "MAV_FRAME_MOCAP_NED - Odometry local coordinate frame of data given by a motion capture system, Z-down (x: North, y: East, z: Down)."]
    MAV_FRAME_RESERVED_14 = 14,
    #[deprecated = " See `MAV_FRAME_LOCAL_FLU` (Deprecated since 2019-04)"]
    #[doc = "MAV_FRAME_MOCAP_ENU - Odometry local coordinate frame of data given by a motion capture system, Z-up (x: East, y: North, z: Up)."]
    MAV_FRAME_RESERVED_15 = 15,
    #[deprecated = " See `MAV_FRAME_LOCAL_FRD` (Deprecated since 2019-04)"]
    #[doc = "MAV_FRAME_VISION_NED - Odometry local coordinate frame of data given by a vision estimation system, Z-down (x: North, y: East, z: Down)."]
    MAV_FRAME_RESERVED_16 = 16,
    #[deprecated = " See `MAV_FRAME_LOCAL_FLU` (Deprecated since 2019-04)"]
    #[doc = "MAV_FRAME_VISION_ENU - Odometry local coordinate frame of data given by a vision estimation system, Z-up (x: East, y: North, z: Up)."]
    MAV_FRAME_RESERVED_17 = 17,
    #[deprecated = " See `MAV_FRAME_LOCAL_FRD` (Deprecated since 2019-04)"]
    #[doc = "MAV_FRAME_ESTIM_NED - Odometry local coordinate frame of data given by an estimator running onboard the vehicle, Z-down (x: North, y: East, z: Down)."]
    MAV_FRAME_RESERVED_18 = 18,
    #[deprecated = " See `MAV_FRAME_LOCAL_FLU` (Deprecated since 2019-04)"]
    #[doc = "MAV_FRAME_ESTIM_ENU - Odometry local coordinate frame of data given by an estimator running onboard the vehicle, Z-up (x: East, y: North, z: Up)."]
    MAV_FRAME_RESERVED_19 = 19,
    #[doc = "FRD local tangent frame (x: Forward, y: Right, z: Down) with origin fixed relative to earth. The forward axis is aligned to the front of the vehicle in the horizontal plane."]
    MAV_FRAME_LOCAL_FRD = 20,
    #[doc = "FLU local tangent frame (x: Forward, y: Left, z: Up) with origin fixed relative to earth. The forward axis is aligned to the front of the vehicle in the horizontal plane."]
    MAV_FRAME_LOCAL_FLU = 21,
}
impl MavFrame {
    pub const DEFAULT: Self = Self::MAV_FRAME_GLOBAL;
}
impl Default for MavFrame {
    fn default() -> Self {
        Self::DEFAULT
    }
}
#[derive(Debug, Copy, Clone, PartialEq, FromPrimitive, ToPrimitive)]
#[repr(u32)]
#[doc = "Enumeration of landed detector states"]
pub enum MavLandedState {
    #[doc = "MAV landed state is unknown"]
    MAV_LANDED_STATE_UNDEFINED = 0,
    #[doc = "MAV is landed (on ground)"]
    MAV_LANDED_STATE_ON_GROUND = 1,
    #[doc = "MAV is in air"]
    MAV_LANDED_STATE_IN_AIR = 2,
    #[doc = "MAV currently taking off"]
    MAV_LANDED_STATE_TAKEOFF = 3,
    #[doc = "MAV currently landing"]
    MAV_LANDED_STATE_LANDING = 4,
}
impl MavLandedState {
    pub const DEFAULT: Self = Self::MAV_LANDED_STATE_UNDEFINED;
}
impl Default for MavLandedState {
    fn default() -> Self {
        Self::DEFAULT
    }
}
#[derive(Debug, Copy, Clone, PartialEq, FromPrimitive, ToPrimitive)]
#[repr(u32)]
#[doc = "Result of mission operation (in a MISSION_ACK message)."]
pub enum MavMissionResult {
    #[doc = "mission accepted OK"]
    MAV_MISSION_ACCEPTED = 0,
    #[doc = "Generic error / not accepting mission commands at all right now."]
    MAV_MISSION_ERROR = 1,
    #[doc = "Coordinate frame is not supported."]
    MAV_MISSION_UNSUPPORTED_FRAME = 2,
    #[doc = "Command is not supported."]
    MAV_MISSION_UNSUPPORTED = 3,
    #[doc = "Mission items exceed storage space."]
    MAV_MISSION_NO_SPACE = 4,
    #[doc = "One of the parameters has an invalid value."]
    MAV_MISSION_INVALID = 5,
    #[doc = "param1 has an invalid value."]
    MAV_MISSION_INVALID_PARAM1 = 6,
    #[doc = "param2 has an invalid value."]
    MAV_MISSION_INVALID_PARAM2 = 7,
    #[doc = "param3 has an invalid value."]
    MAV_MISSION_INVALID_PARAM3 = 8,
    #[doc = "param4 has an invalid value."]
    MAV_MISSION_INVALID_PARAM4 = 9,
    #[doc = "x / param5 has an invalid value."]
    MAV_MISSION_INVALID_PARAM5_X = 10,
    #[doc = "y / param6 has an invalid value."]
    MAV_MISSION_INVALID_PARAM6_Y = 11,
    #[doc = "z / param7 has an invalid value."]
    MAV_MISSION_INVALID_PARAM7 = 12,
    #[doc = "Mission item received out of sequence"]
    MAV_MISSION_INVALID_SEQUENCE = 13,
    #[doc = "Not accepting any mission commands from this communication partner."]
    MAV_MISSION_DENIED = 14,
    #[doc = "Current mission operation cancelled (e.g. mission upload, mission download)."]
    MAV_MISSION_OPERATION_CANCELLED = 15,
}
impl MavMissionResult {
    pub const DEFAULT: Self = Self::MAV_MISSION_ACCEPTED;
}
impl Default for MavMissionResult {
    fn default() -> Self {
        Self::DEFAULT
    }
}
#[derive(Debug, Copy, Clone, PartialEq, FromPrimitive, ToPrimitive)]
#[repr(u32)]
#[doc = "Type of mission items being requested/sent in mission protocol."]
pub enum MavMissionType {
    #[doc = "Items are mission commands for main mission."]
    MAV_MISSION_TYPE_MISSION = 0,
    #[doc = "Specifies GeoFence area(s). Items are MAV_CMD_NAV_FENCE_ GeoFence items."]
    MAV_MISSION_TYPE_FENCE = 1,
    #[doc = "Specifies the rally points for the vehicle. Rally points are alternative RTL points. Items are MAV_CMD_NAV_RALLY_POINT rally point items."]
    MAV_MISSION_TYPE_RALLY = 2,
    #[doc = "Only used in MISSION_CLEAR_ALL to clear all mission types."]
    MAV_MISSION_TYPE_ALL = 255,
}
impl MavMissionType {
    pub const DEFAULT: Self = Self::MAV_MISSION_TYPE_MISSION;
}
impl Default for MavMissionType {
    fn default() -> Self {
        Self::DEFAULT
    }
}
bitflags! {     # [derive (Debug , Copy , Clone , PartialEq)] # [doc = "These flags encode the MAV mode, see MAV_MODE enum for useful combinations."] pub struct MavModeFlag : u8 { # [doc = "0b10000000 MAV safety set to armed. Motors are enabled / running / can start. Ready to fly. Additional note: this flag is to be ignore when sent in the command MAV_CMD_DO_SET_MODE and MAV_CMD_COMPONENT_ARM_DISARM shall be used instead. The flag can still be used to report the armed state."] const MAV_MODE_FLAG_SAFETY_ARMED = 128 ; # [doc = "0b01000000 remote control input is enabled."] const MAV_MODE_FLAG_MANUAL_INPUT_ENABLED = 64 ; # [doc = "0b00100000 hardware in the loop simulation. All motors / actuators are blocked, but internal software is full operational."] const MAV_MODE_FLAG_HIL_ENABLED = 32 ; # [doc = "0b00010000 system stabilizes electronically its attitude (and optionally position). It needs however further control inputs to move around."] const MAV_MODE_FLAG_STABILIZE_ENABLED = 16 ; # [doc = "0b00001000 guided mode enabled, system flies waypoints / mission items."] const MAV_MODE_FLAG_GUIDED_ENABLED = 8 ; # [doc = "0b00000100 autonomous mode enabled, system finds its own goal positions. Guided flag can be set or not, depends on the actual implementation."] const MAV_MODE_FLAG_AUTO_ENABLED = 4 ; # [doc = "0b00000010 system has a test mode enabled. This flag is intended for temporary system tests and should not be used for stable implementations."] const MAV_MODE_FLAG_TEST_ENABLED = 2 ; # [doc = "0b00000001 system-specific custom mode is enabled. When using this flag to enable a custom mode all other flags should be ignored."] const MAV_MODE_FLAG_CUSTOM_MODE_ENABLED = 1 ; } }
impl MavModeFlag {
    pub const DEFAULT: Self = Self::empty();
}
impl Default for MavModeFlag {
    fn default() -> Self {
        Self::DEFAULT
    }
}
bitflags! {     # [derive (Debug , Copy , Clone , PartialEq)] # [doc = "Mode properties."] pub struct MavModeProperty : u32 { # [doc = "If set, this mode is an advanced mode.           For example a rate-controlled manual mode might be advanced, whereas a position-controlled manual mode is not.           A GCS can optionally use this flag to configure the UI for its intended users."] const MAV_MODE_PROPERTY_ADVANCED = 1 ; # [doc = "If set, this mode should not be added to the list of selectable modes.           The mode might still be selected by the FC directly (for example as part of a failsafe)."] const MAV_MODE_PROPERTY_NOT_USER_SELECTABLE = 2 ; # [doc = "If set, this mode is automatically controlled (it may use but does not require a manual controller).           If unset the mode is a assumed to require user input (be a manual mode)."] const MAV_MODE_PROPERTY_AUTO_MODE = 4 ; } }
impl MavModeProperty {
    pub const DEFAULT: Self = Self::empty();
}
impl Default for MavModeProperty {
    fn default() -> Self {
        Self::DEFAULT
    }
}
#[derive(Debug, Copy, Clone, PartialEq, FromPrimitive, ToPrimitive)]
#[repr(u32)]
#[doc = "Parameter protocol error types (see PARAM_ERROR)."]
pub enum MavParamError {
    #[doc = "No error occurred (not expected in PARAM_ERROR but may be used in future implementations."]
    MAV_PARAM_ERROR_NO_ERROR = 0,
    #[doc = "Parameter does not exist"]
    MAV_PARAM_ERROR_DOES_NOT_EXIST = 1,
    #[doc = "Parameter value does not fit within accepted range"]
    MAV_PARAM_ERROR_VALUE_OUT_OF_RANGE = 2,
    #[doc = "Caller is not permitted to set the value of this parameter"]
    MAV_PARAM_ERROR_PERMISSION_DENIED = 3,
    #[doc = "Unknown component specified"]
    MAV_PARAM_ERROR_COMPONENT_NOT_FOUND = 4,
    #[doc = "Parameter is read-only"]
    MAV_PARAM_ERROR_READ_ONLY = 5,
    #[doc = "Parameter data type (MAV_PARAM_TYPE) is not supported by flight stack (at all)"]
    MAV_PARAM_ERROR_TYPE_UNSUPPORTED = 6,
    #[doc = "Parameter type does not match expected type"]
    MAV_PARAM_ERROR_TYPE_MISMATCH = 7,
    #[doc = "Parameter exists but reading failed"]
    MAV_PARAM_ERROR_READ_FAIL = 8,
}
impl MavParamError {
    pub const DEFAULT: Self = Self::MAV_PARAM_ERROR_NO_ERROR;
}
impl Default for MavParamError {
    fn default() -> Self {
        Self::DEFAULT
    }
}
#[derive(Debug, Copy, Clone, PartialEq, FromPrimitive, ToPrimitive)]
#[repr(u32)]
#[doc = "Specifies the datatype of a MAVLink parameter."]
pub enum MavParamType {
    #[doc = "8-bit unsigned integer"]
    MAV_PARAM_TYPE_UINT8 = 1,
    #[doc = "8-bit signed integer"]
    MAV_PARAM_TYPE_INT8 = 2,
    #[doc = "16-bit unsigned integer"]
    MAV_PARAM_TYPE_UINT16 = 3,
    #[doc = "16-bit signed integer"]
    MAV_PARAM_TYPE_INT16 = 4,
    #[doc = "32-bit unsigned integer"]
    MAV_PARAM_TYPE_UINT32 = 5,
    #[doc = "32-bit signed integer"]
    MAV_PARAM_TYPE_INT32 = 6,
    #[doc = "64-bit unsigned integer"]
    MAV_PARAM_TYPE_UINT64 = 7,
    #[doc = "64-bit signed integer"]
    MAV_PARAM_TYPE_INT64 = 8,
    #[doc = "32-bit floating-point"]
    MAV_PARAM_TYPE_REAL32 = 9,
    #[doc = "64-bit floating-point"]
    MAV_PARAM_TYPE_REAL64 = 10,
}
impl MavParamType {
    pub const DEFAULT: Self = Self::MAV_PARAM_TYPE_UINT8;
}
impl Default for MavParamType {
    fn default() -> Self {
        Self::DEFAULT
    }
}
bitflags! {     # [derive (Debug , Copy , Clone , PartialEq)] # [doc = "Bitmask of (optional) autopilot capabilities (64 bit). If a bit is set, the autopilot supports this capability."] pub struct MavProtocolCapability : u64 { # [doc = "Autopilot supports the MISSION_ITEM float message type.           Note that MISSION_ITEM is deprecated, and autopilots should use MISSION_ITEM_INT instead."] const MAV_PROTOCOL_CAPABILITY_MISSION_FLOAT = 1 ; # [deprecated = " See `MAV_PROTOCOL_CAPABILITY_PARAM_ENCODE_C_CAST` (Deprecated since 2022-03)"] # [doc = "Autopilot supports the new param float message type."] const MAV_PROTOCOL_CAPABILITY_PARAM_FLOAT = 2 ; # [doc = "Autopilot supports MISSION_ITEM_INT scaled integer message type.           Note that this flag must always be set if missions are supported, because missions must always use MISSION_ITEM_INT (rather than MISSION_ITEM, which is deprecated)."] const MAV_PROTOCOL_CAPABILITY_MISSION_INT = 4 ; # [doc = "Autopilot supports COMMAND_INT scaled integer message type."] const MAV_PROTOCOL_CAPABILITY_COMMAND_INT = 8 ; # [doc = "Parameter protocol uses byte-wise encoding of parameter values into param_value (float) fields: <https://mavlink.io/en/services/parameter.html#parameter-encoding>.           Note that either this flag or MAV_PROTOCOL_CAPABILITY_PARAM_ENCODE_C_CAST should be set if the parameter protocol is supported."] const MAV_PROTOCOL_CAPABILITY_PARAM_ENCODE_BYTEWISE = 16 ; # [doc = "Autopilot supports the File Transfer Protocol v1: <https://mavlink.io/en/services/ftp.html>."] const MAV_PROTOCOL_CAPABILITY_FTP = 32 ; # [doc = "Autopilot supports the SET_ATTITUDE_TARGET message (for commanding attitude from an offboard controller)."] const MAV_PROTOCOL_CAPABILITY_SET_ATTITUDE_TARGET = 64 ; # [doc = "Autopilot supports the SET_POSITION_TARGET_LOCAL_NED message (for commanding position and velocity targets in local NED frame)."] const MAV_PROTOCOL_CAPABILITY_SET_POSITION_TARGET_LOCAL_NED = 128 ; # [doc = "Autopilot supports the SET_POSITION_TARGET_GLOBAL_INT message (for commanding position and velocity targets in global scaled integers)."] const MAV_PROTOCOL_CAPABILITY_SET_POSITION_TARGET_GLOBAL_INT = 256 ; # [doc = "Autopilot supports terrain protocol / data handling."] const MAV_PROTOCOL_CAPABILITY_TERRAIN = 512 ; # [doc = "Reserved for future use."] const MAV_PROTOCOL_CAPABILITY_RESERVED3 = 1024 ; # [doc = "Autopilot supports the MAV_CMD_DO_FLIGHTTERMINATION command (flight termination)."] const MAV_PROTOCOL_CAPABILITY_FLIGHT_TERMINATION = 2048 ; # [doc = "Autopilot supports onboard compass calibration."] const MAV_PROTOCOL_CAPABILITY_COMPASS_CALIBRATION = 4096 ; # [doc = "Autopilot supports MAVLink version 2."] const MAV_PROTOCOL_CAPABILITY_MAVLINK2 = 8192 ; # [doc = "Autopilot supports mission fence protocol."] const MAV_PROTOCOL_CAPABILITY_MISSION_FENCE = 16384 ; # [doc = "Autopilot supports mission rally point protocol."] const MAV_PROTOCOL_CAPABILITY_MISSION_RALLY = 32768 ; # [doc = "Reserved for future use."] const MAV_PROTOCOL_CAPABILITY_RESERVED2 = 65536 ; # [doc = "Parameter protocol uses C-cast of parameter values to set the param_value (float) fields: <https://mavlink.io/en/services/parameter.html#parameter-encoding>.           Note that either this flag or MAV_PROTOCOL_CAPABILITY_PARAM_ENCODE_BYTEWISE should be set if the parameter protocol is supported."] const MAV_PROTOCOL_CAPABILITY_PARAM_ENCODE_C_CAST = 131072 ; # [doc = "This component implements/is a gimbal manager. This means the GIMBAL_MANAGER_INFORMATION, and other messages can be requested."] const MAV_PROTOCOL_CAPABILITY_COMPONENT_IMPLEMENTS_GIMBAL_MANAGER = 262144 ; # [doc = "Component supports locking control to a particular GCS independent of its system (via MAV_CMD_REQUEST_OPERATOR_CONTROL)."] const MAV_PROTOCOL_CAPABILITY_COMPONENT_ACCEPTS_GCS_CONTROL = 524288 ; # [doc = "Autopilot has a connected gripper. MAVLink Grippers would set MAV_TYPE_GRIPPER instead."] const MAV_PROTOCOL_CAPABILITY_GRIPPER = 1048576 ; } }
impl MavProtocolCapability {
    pub const DEFAULT: Self = Self::empty();
}
impl Default for MavProtocolCapability {
    fn default() -> Self {
        Self::DEFAULT
    }
}
#[derive(Debug, Copy, Clone, PartialEq, FromPrimitive, ToPrimitive)]
#[repr(u32)]
#[doc = "Result from a MAVLink command (MAV_CMD)"]
pub enum MavResult {
    #[doc = "Command is valid (is supported and has valid parameters), and was executed."]
    MAV_RESULT_ACCEPTED = 0,
    #[doc = "Command is valid, but cannot be executed at this time. This is used to indicate a problem that should be fixed just by waiting (e.g. a state machine is busy, can't arm because have not got GPS lock, etc.). Retrying later should work."]
    MAV_RESULT_TEMPORARILY_REJECTED = 1,
    #[doc = "Command is invalid; it is supported but one or more parameter values are invalid (i.e. parameter reserved, value allowed by spec but not supported by flight stack, and so on). Retrying the same command and parameters will not work."]
    MAV_RESULT_DENIED = 2,
    #[doc = "Command is not supported (unknown)."]
    MAV_RESULT_UNSUPPORTED = 3,
    #[doc = "Command is valid, but execution has failed. This is used to indicate any non-temporary or unexpected problem, i.e. any problem that must be fixed before the command can succeed/be retried. For example, attempting to write a file when out of memory, attempting to arm when sensors are not calibrated, etc."]
    MAV_RESULT_FAILED = 4,
    #[doc = "Command is valid and is being executed. This will be followed by further progress updates, i.e. the component may send further COMMAND_ACK messages with result MAV_RESULT_IN_PROGRESS (at a rate decided by the implementation), and must terminate by sending a COMMAND_ACK message with final result of the operation. The COMMAND_ACK.progress field can be used to indicate the progress of the operation."]
    MAV_RESULT_IN_PROGRESS = 5,
    #[doc = "Command has been cancelled (as a result of receiving a COMMAND_CANCEL message)."]
    MAV_RESULT_CANCELLED = 6,
    #[doc = "Command is only accepted when sent as a COMMAND_LONG."]
    MAV_RESULT_COMMAND_LONG_ONLY = 7,
    #[doc = "Command is only accepted when sent as a COMMAND_INT."]
    MAV_RESULT_COMMAND_INT_ONLY = 8,
    #[doc = "Command is invalid because a frame is required and the specified frame is not supported."]
    MAV_RESULT_COMMAND_UNSUPPORTED_MAV_FRAME = 9,
    #[doc = "Command has been rejected because source system is not in control of the target system/component."]
    MAV_RESULT_NOT_IN_CONTROL = 10,
}
impl MavResult {
    pub const DEFAULT: Self = Self::MAV_RESULT_ACCEPTED;
}
impl Default for MavResult {
    fn default() -> Self {
        Self::DEFAULT
    }
}
#[derive(Debug, Copy, Clone, PartialEq, FromPrimitive, ToPrimitive)]
#[repr(u32)]
#[doc = "Enumeration of sensor orientation, according to its rotations"]
pub enum MavSensorOrientation {
    #[doc = "Roll: 0, Pitch: 0, Yaw: 0"]
    MAV_SENSOR_ROTATION_NONE = 0,
    #[doc = "Roll: 0, Pitch: 0, Yaw: 45"]
    MAV_SENSOR_ROTATION_YAW_45 = 1,
    #[doc = "Roll: 0, Pitch: 0, Yaw: 90"]
    MAV_SENSOR_ROTATION_YAW_90 = 2,
    #[doc = "Roll: 0, Pitch: 0, Yaw: 135"]
    MAV_SENSOR_ROTATION_YAW_135 = 3,
    #[doc = "Roll: 0, Pitch: 0, Yaw: 180"]
    MAV_SENSOR_ROTATION_YAW_180 = 4,
    #[doc = "Roll: 0, Pitch: 0, Yaw: 225"]
    MAV_SENSOR_ROTATION_YAW_225 = 5,
    #[doc = "Roll: 0, Pitch: 0, Yaw: 270"]
    MAV_SENSOR_ROTATION_YAW_270 = 6,
    #[doc = "Roll: 0, Pitch: 0, Yaw: 315"]
    MAV_SENSOR_ROTATION_YAW_315 = 7,
    #[doc = "Roll: 180, Pitch: 0, Yaw: 0"]
    MAV_SENSOR_ROTATION_ROLL_180 = 8,
    #[doc = "Roll: 180, Pitch: 0, Yaw: 45"]
    MAV_SENSOR_ROTATION_ROLL_180_YAW_45 = 9,
    #[doc = "Roll: 180, Pitch: 0, Yaw: 90"]
    MAV_SENSOR_ROTATION_ROLL_180_YAW_90 = 10,
    #[doc = "Roll: 180, Pitch: 0, Yaw: 135"]
    MAV_SENSOR_ROTATION_ROLL_180_YAW_135 = 11,
    #[doc = "Roll: 0, Pitch: 180, Yaw: 0"]
    MAV_SENSOR_ROTATION_PITCH_180 = 12,
    #[doc = "Roll: 180, Pitch: 0, Yaw: 225"]
    MAV_SENSOR_ROTATION_ROLL_180_YAW_225 = 13,
    #[doc = "Roll: 180, Pitch: 0, Yaw: 270"]
    MAV_SENSOR_ROTATION_ROLL_180_YAW_270 = 14,
    #[doc = "Roll: 180, Pitch: 0, Yaw: 315"]
    MAV_SENSOR_ROTATION_ROLL_180_YAW_315 = 15,
    #[doc = "Roll: 90, Pitch: 0, Yaw: 0"]
    MAV_SENSOR_ROTATION_ROLL_90 = 16,
    #[doc = "Roll: 90, Pitch: 0, Yaw: 45"]
    MAV_SENSOR_ROTATION_ROLL_90_YAW_45 = 17,
    #[doc = "Roll: 90, Pitch: 0, Yaw: 90"]
    MAV_SENSOR_ROTATION_ROLL_90_YAW_90 = 18,
    #[doc = "Roll: 90, Pitch: 0, Yaw: 135"]
    MAV_SENSOR_ROTATION_ROLL_90_YAW_135 = 19,
    #[doc = "Roll: 270, Pitch: 0, Yaw: 0"]
    MAV_SENSOR_ROTATION_ROLL_270 = 20,
    #[doc = "Roll: 270, Pitch: 0, Yaw: 45"]
    MAV_SENSOR_ROTATION_ROLL_270_YAW_45 = 21,
    #[doc = "Roll: 270, Pitch: 0, Yaw: 90"]
    MAV_SENSOR_ROTATION_ROLL_270_YAW_90 = 22,
    #[doc = "Roll: 270, Pitch: 0, Yaw: 135"]
    MAV_SENSOR_ROTATION_ROLL_270_YAW_135 = 23,
    #[doc = "Roll: 0, Pitch: 90, Yaw: 0"]
    MAV_SENSOR_ROTATION_PITCH_90 = 24,
    #[doc = "Roll: 0, Pitch: 270, Yaw: 0"]
    MAV_SENSOR_ROTATION_PITCH_270 = 25,
    #[doc = "Roll: 0, Pitch: 180, Yaw: 90"]
    MAV_SENSOR_ROTATION_PITCH_180_YAW_90 = 26,
    #[doc = "Roll: 0, Pitch: 180, Yaw: 270"]
    MAV_SENSOR_ROTATION_PITCH_180_YAW_270 = 27,
    #[doc = "Roll: 90, Pitch: 90, Yaw: 0"]
    MAV_SENSOR_ROTATION_ROLL_90_PITCH_90 = 28,
    #[doc = "Roll: 180, Pitch: 90, Yaw: 0"]
    MAV_SENSOR_ROTATION_ROLL_180_PITCH_90 = 29,
    #[doc = "Roll: 270, Pitch: 90, Yaw: 0"]
    MAV_SENSOR_ROTATION_ROLL_270_PITCH_90 = 30,
    #[doc = "Roll: 90, Pitch: 180, Yaw: 0"]
    MAV_SENSOR_ROTATION_ROLL_90_PITCH_180 = 31,
    #[doc = "Roll: 270, Pitch: 180, Yaw: 0"]
    MAV_SENSOR_ROTATION_ROLL_270_PITCH_180 = 32,
    #[doc = "Roll: 90, Pitch: 270, Yaw: 0"]
    MAV_SENSOR_ROTATION_ROLL_90_PITCH_270 = 33,
    #[doc = "Roll: 180, Pitch: 270, Yaw: 0"]
    MAV_SENSOR_ROTATION_ROLL_180_PITCH_270 = 34,
    #[doc = "Roll: 270, Pitch: 270, Yaw: 0"]
    MAV_SENSOR_ROTATION_ROLL_270_PITCH_270 = 35,
    #[doc = "Roll: 90, Pitch: 180, Yaw: 90"]
    MAV_SENSOR_ROTATION_ROLL_90_PITCH_180_YAW_90 = 36,
    #[doc = "Roll: 90, Pitch: 0, Yaw: 270"]
    MAV_SENSOR_ROTATION_ROLL_90_YAW_270 = 37,
    #[doc = "Roll: 90, Pitch: 68, Yaw: 293"]
    MAV_SENSOR_ROTATION_ROLL_90_PITCH_68_YAW_293 = 38,
    #[doc = "Pitch: 315"]
    MAV_SENSOR_ROTATION_PITCH_315 = 39,
    #[doc = "Roll: 90, Pitch: 315"]
    MAV_SENSOR_ROTATION_ROLL_90_PITCH_315 = 40,
    #[doc = "Custom orientation"]
    MAV_SENSOR_ROTATION_CUSTOM = 100,
}
impl MavSensorOrientation {
    pub const DEFAULT: Self = Self::MAV_SENSOR_ROTATION_NONE;
}
impl Default for MavSensorOrientation {
    fn default() -> Self {
        Self::DEFAULT
    }
}
#[derive(Debug, Copy, Clone, PartialEq, FromPrimitive, ToPrimitive)]
#[repr(u32)]
#[doc = "Indicates the severity level, generally used for status messages to indicate their relative urgency. Based on RFC-5424 using expanded definitions at: <http://www.kiwisyslog.com/kb/info:-syslog-message-levels/>."]
pub enum MavSeverity {
    #[doc = "System is unusable. This is a \"panic\" condition."]
    MAV_SEVERITY_EMERGENCY = 0,
    #[doc = "Action should be taken immediately. Indicates error in non-critical systems."]
    MAV_SEVERITY_ALERT = 1,
    #[doc = "Action must be taken immediately. Indicates failure in a primary system."]
    MAV_SEVERITY_CRITICAL = 2,
    #[doc = "Indicates an error in secondary/redundant systems."]
    MAV_SEVERITY_ERROR = 3,
    #[doc = "Indicates about a possible future error if this is not resolved within a given timeframe. Example would be a low battery warning."]
    MAV_SEVERITY_WARNING = 4,
    #[doc = "An unusual event has occurred, though not an error condition. This should be investigated for the root cause."]
    MAV_SEVERITY_NOTICE = 5,
    #[doc = "Normal operational messages. Useful for logging. No action is required for these messages."]
    MAV_SEVERITY_INFO = 6,
    #[doc = "Useful non-operational messages that can assist in debugging. These should not occur during normal operation."]
    MAV_SEVERITY_DEBUG = 7,
}
impl MavSeverity {
    pub const DEFAULT: Self = Self::MAV_SEVERITY_EMERGENCY;
}
impl Default for MavSeverity {
    fn default() -> Self {
        Self::DEFAULT
    }
}
#[derive(Debug, Copy, Clone, PartialEq, FromPrimitive, ToPrimitive)]
#[repr(u32)]
#[doc = "Standard modes with a well understood meaning across flight stacks and vehicle types.         For example, most flight stack have the concept of a \"return\" or \"RTL\" mode that takes a vehicle to safety, even though the precise mechanics of this mode may differ.         The modes supported by a flight stack can be queried using AVAILABLE_MODES and set using MAV_CMD_DO_SET_STANDARD_MODE.         The current mode is streamed in CURRENT_MODE.         See <https://mavlink.io/en/services/standard_modes.html>"]
pub enum MavStandardMode {
    #[doc = "Non standard mode.           This may be used when reporting the mode if the current flight mode is not a standard mode."]
    MAV_STANDARD_MODE_NON_STANDARD = 0,
    #[doc = "Position mode (manual).           Position-controlled and stabilized manual mode.           When sticks are released vehicles return to their level-flight orientation and hold both position and altitude against wind and external forces.           This mode can only be set by vehicles that can hold a fixed position.           Multicopter (MC) vehicles actively brake and hold both position and altitude against wind and external forces.           Hybrid MC/FW (\"VTOL\") vehicles first transition to multicopter mode (if needed) but otherwise behave in the same way as MC vehicles.           Fixed-wing (FW) vehicles must not support this mode.           Other vehicle types must not support this mode (this may be revisited through the PR process)."]
    MAV_STANDARD_MODE_POSITION_HOLD = 1,
    #[doc = "Orbit (manual).           Position-controlled and stabilized manual mode.           The vehicle circles around a fixed setpoint in the horizontal plane at a particular radius, altitude, and direction.           Flight stacks may further allow manual control over the setpoint position, radius, direction, speed, and/or altitude of the circle, but this is not mandated.           Flight stacks may support the [MAV_CMD_DO_ORBIT](<https://mavlink.io/en/messages/common.html#MAV_CMD_DO_ORBIT>) for changing the orbit parameters.           MC and FW vehicles may support this mode.           Hybrid MC/FW (\"VTOL\") vehicles may support this mode in MC/FW or both modes; if the mode is not supported by the current configuration the vehicle should transition to the supported configuration.           Other vehicle types must not support this mode (this may be revisited through the PR process)."]
    MAV_STANDARD_MODE_ORBIT = 2,
    #[doc = "Cruise mode (manual).           Position-controlled and stabilized manual mode.           When sticks are released vehicles return to their level-flight orientation and hold their original track against wind and external forces.           Fixed-wing (FW) vehicles level orientation and maintain current track and altitude against wind and external forces.           Hybrid MC/FW (\"VTOL\") vehicles first transition to FW mode (if needed) but otherwise behave in the same way as MC vehicles.           Multicopter (MC) vehicles must not support this mode.           Other vehicle types must not support this mode (this may be revisited through the PR process)."]
    MAV_STANDARD_MODE_CRUISE = 3,
    #[doc = "Altitude hold (manual).           Altitude-controlled and stabilized manual mode.           When sticks are released vehicles return to their level-flight orientation and hold their altitude.           MC vehicles continue with existing momentum and may move with wind (or other external forces).           FW vehicles continue with current heading, but may be moved off-track by wind.           Hybrid MC/FW (\"VTOL\") vehicles behave according to their current configuration/mode (FW or MC).           Other vehicle types must not support this mode (this may be revisited through the PR process)."]
    MAV_STANDARD_MODE_ALTITUDE_HOLD = 4,
    #[doc = "Safe recovery mode (auto).           Automatic mode that takes vehicle to a predefined safe location via a safe flight path, and may also automatically land the vehicle.           This mode is more commonly referred to as RTL and/or or Smart RTL.           The precise return location, flight path, and landing behaviour depend on vehicle configuration and type.           For example, the vehicle might return to the home/launch location, a rally point, or the start of a mission landing, it might follow a direct path, mission path, or breadcrumb path, and land using a mission landing pattern or some other kind of descent."]
    MAV_STANDARD_MODE_SAFE_RECOVERY = 5,
    #[doc = "Mission mode (automatic).           Automatic mode that executes MAVLink missions.           Missions are executed from the current waypoint as soon as the mode is enabled."]
    MAV_STANDARD_MODE_MISSION = 6,
    #[doc = "Land mode (auto).           Automatic mode that lands the vehicle at the current location.           The precise landing behaviour depends on vehicle configuration and type."]
    MAV_STANDARD_MODE_LAND = 7,
    #[doc = "Takeoff mode (auto).           Automatic takeoff mode.           The precise takeoff behaviour depends on vehicle configuration and type."]
    MAV_STANDARD_MODE_TAKEOFF = 8,
}
impl MavStandardMode {
    pub const DEFAULT: Self = Self::MAV_STANDARD_MODE_NON_STANDARD;
}
impl Default for MavStandardMode {
    fn default() -> Self {
        Self::DEFAULT
    }
}
#[derive(Debug, Copy, Clone, PartialEq, FromPrimitive, ToPrimitive)]
#[repr(u32)]
pub enum MavState {
    #[doc = "Uninitialized system, state is unknown."]
    MAV_STATE_UNINIT = 0,
    #[doc = "System is booting up."]
    MAV_STATE_BOOT = 1,
    #[doc = "System is calibrating and not flight-ready."]
    MAV_STATE_CALIBRATING = 2,
    #[doc = "System is grounded and on standby. It can be launched any time."]
    MAV_STATE_STANDBY = 3,
    #[doc = "System is active and might be already airborne. Motors are engaged."]
    MAV_STATE_ACTIVE = 4,
    #[doc = "System is in a non-normal flight mode (failsafe). It can however still navigate."]
    MAV_STATE_CRITICAL = 5,
    #[doc = "System is in a non-normal flight mode (failsafe). It lost control over parts or over the whole airframe. It is in mayday and going down."]
    MAV_STATE_EMERGENCY = 6,
    #[doc = "System just initialized its power-down sequence, will shut down now."]
    MAV_STATE_POWEROFF = 7,
    #[doc = "System is terminating itself (failsafe or commanded)."]
    MAV_STATE_FLIGHT_TERMINATION = 8,
}
impl MavState {
    pub const DEFAULT: Self = Self::MAV_STATE_UNINIT;
}
impl Default for MavState {
    fn default() -> Self {
        Self::DEFAULT
    }
}
bitflags! {     # [derive (Debug , Copy , Clone , PartialEq)] # [doc = "These encode the sensors whose status is sent as part of the SYS_STATUS message."] pub struct MavSysStatusSensor : u32 { # [doc = "0x01 3D gyro"] const MAV_SYS_STATUS_SENSOR_3D_GYRO = 1 ; # [doc = "0x02 3D accelerometer"] const MAV_SYS_STATUS_SENSOR_3D_ACCEL = 2 ; # [doc = "0x04 3D magnetometer"] const MAV_SYS_STATUS_SENSOR_3D_MAG = 4 ; # [doc = "0x08 absolute pressure"] const MAV_SYS_STATUS_SENSOR_ABSOLUTE_PRESSURE = 8 ; # [doc = "0x10 differential pressure"] const MAV_SYS_STATUS_SENSOR_DIFFERENTIAL_PRESSURE = 16 ; # [doc = "0x20 GPS"] const MAV_SYS_STATUS_SENSOR_GPS = 32 ; # [doc = "0x40 optical flow"] const MAV_SYS_STATUS_SENSOR_OPTICAL_FLOW = 64 ; # [doc = "0x80 computer vision position"] const MAV_SYS_STATUS_SENSOR_VISION_POSITION = 128 ; # [doc = "0x100 laser based position"] const MAV_SYS_STATUS_SENSOR_LASER_POSITION = 256 ; # [doc = "0x200 external ground truth (Vicon or Leica)"] const MAV_SYS_STATUS_SENSOR_EXTERNAL_GROUND_TRUTH = 512 ; # [doc = "0x400 3D angular rate control"] const MAV_SYS_STATUS_SENSOR_ANGULAR_RATE_CONTROL = 1024 ; # [doc = "0x800 attitude stabilization"] const MAV_SYS_STATUS_SENSOR_ATTITUDE_STABILIZATION = 2048 ; # [doc = "0x1000 yaw position"] const MAV_SYS_STATUS_SENSOR_YAW_POSITION = 4096 ; # [doc = "0x2000 z/altitude control"] const MAV_SYS_STATUS_SENSOR_Z_ALTITUDE_CONTROL = 8192 ; # [doc = "0x4000 x/y position control"] const MAV_SYS_STATUS_SENSOR_XY_POSITION_CONTROL = 16384 ; # [doc = "0x8000 motor outputs / control"] const MAV_SYS_STATUS_SENSOR_MOTOR_OUTPUTS = 32768 ; # [doc = "0x10000 RC receiver"] const MAV_SYS_STATUS_SENSOR_RC_RECEIVER = 65536 ; # [doc = "0x20000 2nd 3D gyro"] const MAV_SYS_STATUS_SENSOR_3D_GYRO2 = 131072 ; # [doc = "0x40000 2nd 3D accelerometer"] const MAV_SYS_STATUS_SENSOR_3D_ACCEL2 = 262144 ; # [doc = "0x80000 2nd 3D magnetometer"] const MAV_SYS_STATUS_SENSOR_3D_MAG2 = 524288 ; # [doc = "0x100000 geofence"] const MAV_SYS_STATUS_GEOFENCE = 1048576 ; # [doc = "0x200000 AHRS subsystem health"] const MAV_SYS_STATUS_AHRS = 2097152 ; # [doc = "0x400000 Terrain subsystem health"] const MAV_SYS_STATUS_TERRAIN = 4194304 ; # [doc = "0x800000 Motors are reversed"] const MAV_SYS_STATUS_REVERSE_MOTOR = 8388608 ; # [doc = "0x1000000 Logging"] const MAV_SYS_STATUS_LOGGING = 16777216 ; # [doc = "0x2000000 Battery"] const MAV_SYS_STATUS_SENSOR_BATTERY = 33554432 ; # [doc = "0x4000000 Proximity"] const MAV_SYS_STATUS_SENSOR_PROXIMITY = 67108864 ; # [doc = "0x8000000 Satellite Communication"] const MAV_SYS_STATUS_SENSOR_SATCOM = 134217728 ; # [doc = "0x10000000 pre-arm check status. Always healthy when armed"] const MAV_SYS_STATUS_PREARM_CHECK = 268435456 ; # [doc = "0x20000000 Avoidance/collision prevention"] const MAV_SYS_STATUS_OBSTACLE_AVOIDANCE = 536870912 ; # [doc = "0x40000000 propulsion (actuator, esc, motor or propellor)"] const MAV_SYS_STATUS_SENSOR_PROPULSION = 1073741824 ; # [doc = "0x80000000 Extended bit-field are used for further sensor status bits (needs to be set in onboard_control_sensors_present only)"] const MAV_SYS_STATUS_EXTENSION_USED = 2147483648 ; } }
impl MavSysStatusSensor {
    pub const DEFAULT: Self = Self::empty();
}
impl Default for MavSysStatusSensor {
    fn default() -> Self {
        Self::DEFAULT
    }
}
bitflags! {     # [derive (Debug , Copy , Clone , PartialEq)] # [doc = "These encode the sensors whose status is sent as part of the SYS_STATUS message in the extended fields."] pub struct MavSysStatusSensorExtended : u32 { # [doc = "0x01 Recovery system (parachute, balloon, retracts etc)"] const MAV_SYS_STATUS_RECOVERY_SYSTEM = 1 ; # [doc = "0x02 Leak detection"] const MAV_SYS_STATUS_SENSOR_LEAK = 2 ; # [doc = "0x04 3rd 3D gyro"] const MAV_SYS_STATUS_SENSOR_3D_GYRO3 = 4 ; # [doc = "0x08 3rd 3D accelerometer"] const MAV_SYS_STATUS_SENSOR_3D_ACCEL3 = 8 ; # [doc = "0x10 4th 3D gyro"] const MAV_SYS_STATUS_SENSOR_3D_GYRO4 = 16 ; # [doc = "0x20 4th 3D accelerometer"] const MAV_SYS_STATUS_SENSOR_3D_ACCEL4 = 32 ; } }
impl MavSysStatusSensorExtended {
    pub const DEFAULT: Self = Self::empty();
}
impl Default for MavSysStatusSensorExtended {
    fn default() -> Self {
        Self::DEFAULT
    }
}
#[derive(Debug, Copy, Clone, PartialEq, FromPrimitive, ToPrimitive)]
#[repr(u32)]
#[doc = "MAVLINK component type reported in HEARTBEAT message. Flight controllers must report the type of the vehicle on which they are mounted (e.g. MAV_TYPE_OCTOROTOR). All other components must report a value appropriate for their type (e.g. a camera must use MAV_TYPE_CAMERA)."]
pub enum MavType {
    #[doc = "Generic micro air vehicle"]
    MAV_TYPE_GENERIC = 0,
    #[doc = "Fixed wing aircraft."]
    MAV_TYPE_FIXED_WING = 1,
    #[doc = "Quadrotor"]
    MAV_TYPE_QUADROTOR = 2,
    #[doc = "Coaxial helicopter"]
    MAV_TYPE_COAXIAL = 3,
    #[doc = "Normal helicopter with tail rotor."]
    MAV_TYPE_HELICOPTER = 4,
    #[doc = "Ground installation"]
    MAV_TYPE_ANTENNA_TRACKER = 5,
    #[doc = "Operator control unit / ground control station"]
    MAV_TYPE_GCS = 6,
    #[doc = "Airship, controlled"]
    MAV_TYPE_AIRSHIP = 7,
    #[doc = "Free balloon, uncontrolled"]
    MAV_TYPE_FREE_BALLOON = 8,
    #[doc = "Rocket"]
    MAV_TYPE_ROCKET = 9,
    #[doc = "Ground rover"]
    MAV_TYPE_GROUND_ROVER = 10,
    #[doc = "Surface vessel, boat, ship"]
    MAV_TYPE_SURFACE_BOAT = 11,
    #[doc = "Submarine"]
    MAV_TYPE_SUBMARINE = 12,
    #[doc = "Hexarotor"]
    MAV_TYPE_HEXAROTOR = 13,
    #[doc = "Octorotor"]
    MAV_TYPE_OCTOROTOR = 14,
    #[doc = "Tricopter"]
    MAV_TYPE_TRICOPTER = 15,
    #[doc = "Flapping wing"]
    MAV_TYPE_FLAPPING_WING = 16,
    #[doc = "Kite"]
    MAV_TYPE_KITE = 17,
    #[doc = "Onboard companion controller"]
    MAV_TYPE_ONBOARD_CONTROLLER = 18,
    #[doc = "Two-rotor Tailsitter VTOL that additionally uses control surfaces in vertical operation. Note, value previously named MAV_TYPE_VTOL_DUOROTOR."]
    MAV_TYPE_VTOL_TAILSITTER_DUOROTOR = 19,
    #[doc = "Quad-rotor Tailsitter VTOL using a V-shaped quad config in vertical operation. Note: value previously named MAV_TYPE_VTOL_QUADROTOR."]
    MAV_TYPE_VTOL_TAILSITTER_QUADROTOR = 20,
    #[doc = "Tiltrotor VTOL. Fuselage and wings stay (nominally) horizontal in all flight phases. It able to tilt (some) rotors to provide thrust in cruise flight."]
    MAV_TYPE_VTOL_TILTROTOR = 21,
    #[doc = "VTOL with separate fixed rotors for hover and cruise flight. Fuselage and wings stay (nominally) horizontal in all flight phases."]
    MAV_TYPE_VTOL_FIXEDROTOR = 22,
    #[doc = "Tailsitter VTOL. Fuselage and wings orientation changes depending on flight phase: vertical for hover, horizontal for cruise. Use more specific VTOL MAV_TYPE_VTOL_TAILSITTER_DUOROTOR or MAV_TYPE_VTOL_TAILSITTER_QUADROTOR if appropriate."]
    MAV_TYPE_VTOL_TAILSITTER = 23,
    #[doc = "Tiltwing VTOL. Fuselage stays horizontal in all flight phases. The whole wing, along with any attached engine, can tilt between vertical and horizontal mode."]
    MAV_TYPE_VTOL_TILTWING = 24,
    #[doc = "VTOL reserved 5"]
    MAV_TYPE_VTOL_RESERVED5 = 25,
    #[doc = "Gimbal"]
    MAV_TYPE_GIMBAL = 26,
    #[doc = "ADSB system"]
    MAV_TYPE_ADSB = 27,
    #[doc = "Steerable, nonrigid airfoil"]
    MAV_TYPE_PARAFOIL = 28,
    #[doc = "Dodecarotor"]
    MAV_TYPE_DODECAROTOR = 29,
    #[doc = "Camera"]
    MAV_TYPE_CAMERA = 30,
    #[doc = "Charging station"]
    MAV_TYPE_CHARGING_STATION = 31,
    #[doc = "FLARM collision avoidance system"]
    MAV_TYPE_FLARM = 32,
    #[doc = "Servo"]
    MAV_TYPE_SERVO = 33,
    #[doc = "Open Drone ID. See <https://mavlink.io/en/services/opendroneid.html>."]
    MAV_TYPE_ODID = 34,
    #[doc = "Decarotor"]
    MAV_TYPE_DECAROTOR = 35,
    #[doc = "Battery"]
    MAV_TYPE_BATTERY = 36,
    #[doc = "Parachute"]
    MAV_TYPE_PARACHUTE = 37,
    #[doc = "Log"]
    MAV_TYPE_LOG = 38,
    #[doc = "OSD"]
    MAV_TYPE_OSD = 39,
    #[doc = "IMU"]
    MAV_TYPE_IMU = 40,
    #[doc = "GPS"]
    MAV_TYPE_GPS = 41,
    #[doc = "Winch"]
    MAV_TYPE_WINCH = 42,
    #[doc = "Generic multirotor that does not fit into a specific type or whose type is unknown"]
    MAV_TYPE_GENERIC_MULTIROTOR = 43,
    #[doc = "Illuminator. An illuminator is a light source that is used for lighting up dark areas external to the system: e.g. a torch or searchlight (as opposed to a light source for illuminating the system itself, e.g. an indicator light)."]
    MAV_TYPE_ILLUMINATOR = 44,
    #[doc = "Orbiter spacecraft. Includes satellites orbiting terrestrial and extra-terrestrial bodies. Follows NASA Spacecraft Classification."]
    MAV_TYPE_SPACECRAFT_ORBITER = 45,
    #[doc = "A generic four-legged ground vehicle (e.g., a robot dog)."]
    MAV_TYPE_GROUND_QUADRUPED = 46,
    #[doc = "VTOL hybrid of helicopter and autogyro. It has a main rotor for lift and separate propellers for forward flight. The rotor must be powered for hover but can autorotate in cruise flight. See: <https://en.wikipedia.org/wiki/Gyrodyne>"]
    MAV_TYPE_VTOL_GYRODYNE = 47,
    #[doc = "Gripper"]
    MAV_TYPE_GRIPPER = 48,
    #[doc = "Radio"]
    MAV_TYPE_RADIO = 49,
}
impl MavType {
    pub const DEFAULT: Self = Self::MAV_TYPE_GENERIC;
}
impl Default for MavType {
    fn default() -> Self {
        Self::DEFAULT
    }
}
#[derive(Debug, Copy, Clone, PartialEq, FromPrimitive, ToPrimitive)]
#[repr(u32)]
#[doc = "Enumeration of VTOL states"]
pub enum MavVtolState {
    #[doc = "MAV is not configured as VTOL"]
    MAV_VTOL_STATE_UNDEFINED = 0,
    #[doc = "VTOL is in transition from multicopter to fixed-wing"]
    MAV_VTOL_STATE_TRANSITION_TO_FW = 1,
    #[doc = "VTOL is in transition from fixed-wing to multicopter"]
    MAV_VTOL_STATE_TRANSITION_TO_MC = 2,
    #[doc = "VTOL is in multicopter state"]
    MAV_VTOL_STATE_MC = 3,
    #[doc = "VTOL is in fixed-wing state"]
    MAV_VTOL_STATE_FW = 4,
}
impl MavVtolState {
    pub const DEFAULT: Self = Self::MAV_VTOL_STATE_UNDEFINED;
}
impl Default for MavVtolState {
    fn default() -> Self {
        Self::DEFAULT
    }
}
#[derive(Debug, Copy, Clone, PartialEq, FromPrimitive, ToPrimitive)]
#[repr(u32)]
#[doc = "States of the mission state machine.         Note that these states are independent of whether the mission is in a mode that can execute mission items or not (is suspended).         They may not all be relevant on all vehicles."]
pub enum MissionState {
    #[doc = "The mission status reporting is not supported."]
    MISSION_STATE_UNKNOWN = 0,
    #[doc = "No mission on the vehicle."]
    MISSION_STATE_NO_MISSION = 1,
    #[doc = "Mission has not started. This is the case after a mission has uploaded but not yet started executing."]
    MISSION_STATE_NOT_STARTED = 2,
    #[doc = "Mission is active, and will execute mission items when in auto mode."]
    MISSION_STATE_ACTIVE = 3,
    #[doc = "Mission is paused when in auto mode."]
    MISSION_STATE_PAUSED = 4,
    #[doc = "Mission has executed all mission items."]
    MISSION_STATE_COMPLETE = 5,
}
impl MissionState {
    pub const DEFAULT: Self = Self::MISSION_STATE_UNKNOWN;
}
impl Default for MissionState {
    fn default() -> Self {
        Self::DEFAULT
    }
}
bitflags! {     # [derive (Debug , Copy , Clone , PartialEq)] # [doc = "Bitmap to indicate which dimensions should be ignored by the vehicle: a value of 0b0000000000000000 or 0b0000001000000000 indicates that none of the setpoint dimensions should be ignored. If bit 9 is set the floats afx afy afz should be interpreted as force instead of acceleration."] pub struct PositionTargetTypemask : u16 { # [doc = "Ignore position x"] const POSITION_TARGET_TYPEMASK_X_IGNORE = 1 ; # [doc = "Ignore position y"] const POSITION_TARGET_TYPEMASK_Y_IGNORE = 2 ; # [doc = "Ignore position z"] const POSITION_TARGET_TYPEMASK_Z_IGNORE = 4 ; # [doc = "Ignore velocity x"] const POSITION_TARGET_TYPEMASK_VX_IGNORE = 8 ; # [doc = "Ignore velocity y"] const POSITION_TARGET_TYPEMASK_VY_IGNORE = 16 ; # [doc = "Ignore velocity z"] const POSITION_TARGET_TYPEMASK_VZ_IGNORE = 32 ; # [doc = "Ignore acceleration x"] const POSITION_TARGET_TYPEMASK_AX_IGNORE = 64 ; # [doc = "Ignore acceleration y"] const POSITION_TARGET_TYPEMASK_AY_IGNORE = 128 ; # [doc = "Ignore acceleration z"] const POSITION_TARGET_TYPEMASK_AZ_IGNORE = 256 ; # [doc = "Use force instead of acceleration"] const POSITION_TARGET_TYPEMASK_FORCE_SET = 512 ; # [doc = "Ignore yaw"] const POSITION_TARGET_TYPEMASK_YAW_IGNORE = 1024 ; # [doc = "Ignore yaw rate"] const POSITION_TARGET_TYPEMASK_YAW_RATE_IGNORE = 2048 ; } }
impl PositionTargetTypemask {
    pub const DEFAULT: Self = Self::empty();
}
impl Default for PositionTargetTypemask {
    fn default() -> Self {
        Self::DEFAULT
    }
}
#[derive(Debug, Copy, Clone, PartialEq, FromPrimitive, ToPrimitive)]
#[repr(u32)]
#[doc = "Video stream encodings"]
pub enum VideoStreamEncoding {
    #[doc = "Stream encoding is unknown"]
    VIDEO_STREAM_ENCODING_UNKNOWN = 0,
    #[doc = "Stream encoding is H.264"]
    VIDEO_STREAM_ENCODING_H264 = 1,
    #[doc = "Stream encoding is H.265"]
    VIDEO_STREAM_ENCODING_H265 = 2,
}
impl VideoStreamEncoding {
    pub const DEFAULT: Self = Self::VIDEO_STREAM_ENCODING_UNKNOWN;
}
impl Default for VideoStreamEncoding {
    fn default() -> Self {
        Self::DEFAULT
    }
}
bitflags! {     # [derive (Debug , Copy , Clone , PartialEq)] # [doc = "Stream status flags (Bitmap)"] pub struct VideoStreamStatusFlags : u16 { # [doc = "Stream is active (running)"] const VIDEO_STREAM_STATUS_FLAGS_RUNNING = 1 ; # [doc = "Stream is thermal imaging"] const VIDEO_STREAM_STATUS_FLAGS_THERMAL = 2 ; # [doc = "Stream can report absolute thermal range (see CAMERA_THERMAL_RANGE)."] const VIDEO_STREAM_STATUS_FLAGS_THERMAL_RANGE_ENABLED = 4 ; } }
impl VideoStreamStatusFlags {
    pub const DEFAULT: Self = Self::empty();
}
impl Default for VideoStreamStatusFlags {
    fn default() -> Self {
        Self::DEFAULT
    }
}
#[derive(Debug, Copy, Clone, PartialEq, FromPrimitive, ToPrimitive)]
#[repr(u32)]
#[doc = "Video stream types"]
pub enum VideoStreamType {
    #[doc = "Stream is RTSP"]
    VIDEO_STREAM_TYPE_RTSP = 0,
    #[doc = "Stream is RTP UDP (URI gives the port number)"]
    VIDEO_STREAM_TYPE_RTPUDP = 1,
    #[doc = "Stream is MPEG on TCP"]
    VIDEO_STREAM_TYPE_TCP_MPEG = 2,
    #[doc = "Stream is MPEG TS (URI gives the port number)"]
    VIDEO_STREAM_TYPE_MPEG_TS = 3,
    #[doc = "Stream is WHEP (WebRTC-HTTP Egress Protocol)"]
    VIDEO_STREAM_TYPE_WHEP = 4,
}
impl VideoStreamType {
    pub const DEFAULT: Self = Self::VIDEO_STREAM_TYPE_RTSP;
}
impl Default for VideoStreamType {
    fn default() -> Self {
        Self::DEFAULT
    }
}
#[doc = "The current system altitude."]
#[doc = ""]
#[doc = "ID: 141"]
#[derive(Debug, Clone, PartialEq)]
pub struct ALTITUDE_DATA {
    #[doc = "Timestamp (UNIX Epoch time or time since system boot). The receiving end can infer timestamp format (since 1.1.1970 or since system boot) by checking for the magnitude of the number."]
    pub time_usec: u64,
    #[doc = "This altitude measure is initialized on system boot and monotonic (it is never reset, but represents the local altitude change). The only guarantee on this field is that it will never be reset and is consistent within a flight. The recommended value for this field is the uncorrected barometric altitude at boot time. This altitude will also drift and vary between flights."]
    pub altitude_monotonic: f32,
    #[doc = "This altitude measure is strictly above mean sea level and might be non-monotonic (it might reset on events like GPS lock or when a new QNH value is set). It should be the altitude to which global altitude waypoints are compared to. Note that it is *not* the GPS altitude, however, most GPS modules already output MSL by default and not the WGS84 altitude."]
    pub altitude_amsl: f32,
    #[doc = "This is the local altitude in the local coordinate frame. It is not the altitude above home, but in reference to the coordinate origin (0, 0, 0). It is up-positive."]
    pub altitude_local: f32,
    #[doc = "This is the altitude above the home position. It resets on each change of the current home position."]
    pub altitude_relative: f32,
    #[doc = "This is the altitude above terrain. It might be fed by a terrain database or an altimeter. Values smaller than -1000 should be interpreted as unknown."]
    pub altitude_terrain: f32,
    #[doc = "This is not the altitude, but the clear space below the system according to the fused clearance estimate. It generally should max out at the maximum range of e.g. the laser altimeter. It is generally a moving target. A negative value indicates no measurement available."]
    pub bottom_clearance: f32,
}
impl ALTITUDE_DATA {
    pub const ENCODED_LEN: usize = 32usize;
    pub const DEFAULT: Self = Self {
        time_usec: 0_u64,
        altitude_monotonic: 0.0_f32,
        altitude_amsl: 0.0_f32,
        altitude_local: 0.0_f32,
        altitude_relative: 0.0_f32,
        altitude_terrain: 0.0_f32,
        bottom_clearance: 0.0_f32,
    };
}
impl Default for ALTITUDE_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for ALTITUDE_DATA {
    type Message = MavMessage;
    const ID: u32 = 141u32;
    const NAME: &'static str = "ALTITUDE";
    const EXTRA_CRC: u8 = 47u8;
    const ENCODED_LEN: usize = 32usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.time_usec = buf.get_u64_le()?;
        __struct.altitude_monotonic = buf.get_f32_le()?;
        __struct.altitude_amsl = buf.get_f32_le()?;
        __struct.altitude_local = buf.get_f32_le()?;
        __struct.altitude_relative = buf.get_f32_le()?;
        __struct.altitude_terrain = buf.get_f32_le()?;
        __struct.bottom_clearance = buf.get_f32_le()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u64_le(self.time_usec);
        __tmp.put_f32_le(self.altitude_monotonic);
        __tmp.put_f32_le(self.altitude_amsl);
        __tmp.put_f32_le(self.altitude_local);
        __tmp.put_f32_le(self.altitude_relative);
        __tmp.put_f32_le(self.altitude_terrain);
        __tmp.put_f32_le(self.bottom_clearance);
        if matches!(version, MavlinkVersion::V2) {
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "The attitude in the aeronautical frame (right-handed, Z-down, Y-right, X-front, ZYX, intrinsic)."]
#[doc = ""]
#[doc = "ID: 30"]
#[derive(Debug, Clone, PartialEq)]
pub struct ATTITUDE_DATA {
    #[doc = "Timestamp (time since system boot)."]
    pub time_boot_ms: u32,
    #[doc = "Roll angle (-pi..+pi)"]
    pub roll: f32,
    #[doc = "Pitch angle (-pi..+pi)"]
    pub pitch: f32,
    #[doc = "Yaw angle (-pi..+pi)"]
    pub yaw: f32,
    #[doc = "Roll angular speed"]
    pub rollspeed: f32,
    #[doc = "Pitch angular speed"]
    pub pitchspeed: f32,
    #[doc = "Yaw angular speed"]
    pub yawspeed: f32,
}
impl ATTITUDE_DATA {
    pub const ENCODED_LEN: usize = 28usize;
    pub const DEFAULT: Self = Self {
        time_boot_ms: 0_u32,
        roll: 0.0_f32,
        pitch: 0.0_f32,
        yaw: 0.0_f32,
        rollspeed: 0.0_f32,
        pitchspeed: 0.0_f32,
        yawspeed: 0.0_f32,
    };
}
impl Default for ATTITUDE_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for ATTITUDE_DATA {
    type Message = MavMessage;
    const ID: u32 = 30u32;
    const NAME: &'static str = "ATTITUDE";
    const EXTRA_CRC: u8 = 39u8;
    const ENCODED_LEN: usize = 28usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.time_boot_ms = buf.get_u32_le()?;
        __struct.roll = buf.get_f32_le()?;
        __struct.pitch = buf.get_f32_le()?;
        __struct.yaw = buf.get_f32_le()?;
        __struct.rollspeed = buf.get_f32_le()?;
        __struct.pitchspeed = buf.get_f32_le()?;
        __struct.yawspeed = buf.get_f32_le()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u32_le(self.time_boot_ms);
        __tmp.put_f32_le(self.roll);
        __tmp.put_f32_le(self.pitch);
        __tmp.put_f32_le(self.yaw);
        __tmp.put_f32_le(self.rollspeed);
        __tmp.put_f32_le(self.pitchspeed);
        __tmp.put_f32_le(self.yawspeed);
        if matches!(version, MavlinkVersion::V2) {
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "The attitude in the aeronautical frame (right-handed, Z-down, X-front, Y-right), expressed as quaternion. Quaternion order is w, x, y, z and a zero rotation would be expressed as (1 0 0 0)."]
#[doc = ""]
#[doc = "ID: 31"]
#[derive(Debug, Clone, PartialEq)]
pub struct ATTITUDE_QUATERNION_DATA {
    #[doc = "Timestamp (time since system boot)."]
    pub time_boot_ms: u32,
    #[doc = "Quaternion component 1, w (1 in null-rotation)"]
    pub q1: f32,
    #[doc = "Quaternion component 2, x (0 in null-rotation)"]
    pub q2: f32,
    #[doc = "Quaternion component 3, y (0 in null-rotation)"]
    pub q3: f32,
    #[doc = "Quaternion component 4, z (0 in null-rotation)"]
    pub q4: f32,
    #[doc = "Roll angular speed"]
    pub rollspeed: f32,
    #[doc = "Pitch angular speed"]
    pub pitchspeed: f32,
    #[doc = "Yaw angular speed"]
    pub yawspeed: f32,
    #[doc = "Rotation offset by which the attitude quaternion and angular speed vector should be rotated for user display (quaternion with [w, x, y, z] order, zero-rotation is [1, 0, 0, 0], send [0, 0, 0, 0] if field not supported). This field is intended for systems in which the reference attitude may change during flight. For example, tailsitters VTOLs rotate their reference attitude by 90 degrees between hover mode and fixed wing mode, thus repr_offset_q is equal to [1, 0, 0, 0] in hover mode and equal to [0.7071, 0, 0.7071, 0] in fixed wing mode."]
    pub repr_offset_q: [f32; 4],
}
impl ATTITUDE_QUATERNION_DATA {
    pub const ENCODED_LEN: usize = 48usize;
    pub const DEFAULT: Self = Self {
        time_boot_ms: 0_u32,
        q1: 0.0_f32,
        q2: 0.0_f32,
        q3: 0.0_f32,
        q4: 0.0_f32,
        rollspeed: 0.0_f32,
        pitchspeed: 0.0_f32,
        yawspeed: 0.0_f32,
        repr_offset_q: [0.0_f32; 4usize],
    };
}
impl Default for ATTITUDE_QUATERNION_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for ATTITUDE_QUATERNION_DATA {
    type Message = MavMessage;
    const ID: u32 = 31u32;
    const NAME: &'static str = "ATTITUDE_QUATERNION";
    const EXTRA_CRC: u8 = 246u8;
    const ENCODED_LEN: usize = 48usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.time_boot_ms = buf.get_u32_le()?;
        __struct.q1 = buf.get_f32_le()?;
        __struct.q2 = buf.get_f32_le()?;
        __struct.q3 = buf.get_f32_le()?;
        __struct.q4 = buf.get_f32_le()?;
        __struct.rollspeed = buf.get_f32_le()?;
        __struct.pitchspeed = buf.get_f32_le()?;
        __struct.yawspeed = buf.get_f32_le()?;
        for v in &mut __struct.repr_offset_q {
            let val = buf.get_f32_le()?;
            *v = val;
        }
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u32_le(self.time_boot_ms);
        __tmp.put_f32_le(self.q1);
        __tmp.put_f32_le(self.q2);
        __tmp.put_f32_le(self.q3);
        __tmp.put_f32_le(self.q4);
        __tmp.put_f32_le(self.rollspeed);
        __tmp.put_f32_le(self.pitchspeed);
        __tmp.put_f32_le(self.yawspeed);
        if matches!(version, MavlinkVersion::V2) {
            for val in &self.repr_offset_q {
                __tmp.put_f32_le(*val);
            }
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Reports the current commanded attitude of the vehicle as specified by the autopilot. This should match the commands sent in a SET_ATTITUDE_TARGET message if the vehicle is being controlled this way."]
#[doc = ""]
#[doc = "ID: 83"]
#[derive(Debug, Clone, PartialEq)]
pub struct ATTITUDE_TARGET_DATA {
    #[doc = "Timestamp (time since system boot)."]
    pub time_boot_ms: u32,
    #[doc = "Attitude quaternion (w, x, y, z order, zero-rotation is 1, 0, 0, 0)"]
    pub q: [f32; 4],
    #[doc = "Body roll rate"]
    pub body_roll_rate: f32,
    #[doc = "Body pitch rate"]
    pub body_pitch_rate: f32,
    #[doc = "Body yaw rate"]
    pub body_yaw_rate: f32,
    #[doc = "Collective thrust, normalized to 0 .. 1 (-1 .. 1 for vehicles capable of reverse thrust)"]
    pub thrust: f32,
    #[doc = "Bitmap to indicate which dimensions should be ignored by the vehicle."]
    pub type_mask: AttitudeTargetTypemask,
}
impl ATTITUDE_TARGET_DATA {
    pub const ENCODED_LEN: usize = 37usize;
    pub const DEFAULT: Self = Self {
        time_boot_ms: 0_u32,
        q: [0.0_f32; 4usize],
        body_roll_rate: 0.0_f32,
        body_pitch_rate: 0.0_f32,
        body_yaw_rate: 0.0_f32,
        thrust: 0.0_f32,
        type_mask: AttitudeTargetTypemask::DEFAULT,
    };
}
impl Default for ATTITUDE_TARGET_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for ATTITUDE_TARGET_DATA {
    type Message = MavMessage;
    const ID: u32 = 83u32;
    const NAME: &'static str = "ATTITUDE_TARGET";
    const EXTRA_CRC: u8 = 22u8;
    const ENCODED_LEN: usize = 37usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.time_boot_ms = buf.get_u32_le()?;
        for v in &mut __struct.q {
            let val = buf.get_f32_le()?;
            *v = val;
        }
        __struct.body_roll_rate = buf.get_f32_le()?;
        __struct.body_pitch_rate = buf.get_f32_le()?;
        __struct.body_yaw_rate = buf.get_f32_le()?;
        __struct.thrust = buf.get_f32_le()?;
        let tmp = buf.get_u8()?;
        __struct.type_mask = AttitudeTargetTypemask::from_bits_retain(
            tmp as <AttitudeTargetTypemask as Flags>::Bits,
        );
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u32_le(self.time_boot_ms);
        for val in &self.q {
            __tmp.put_f32_le(*val);
        }
        __tmp.put_f32_le(self.body_roll_rate);
        __tmp.put_f32_le(self.body_pitch_rate);
        __tmp.put_f32_le(self.body_yaw_rate);
        __tmp.put_f32_le(self.thrust);
        __tmp.put_u8(self.type_mask.bits() as u8);
        if matches!(version, MavlinkVersion::V2) {
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Version and capability of autopilot software. This should be emitted in response to a request with MAV_CMD_REQUEST_MESSAGE."]
#[doc = ""]
#[doc = "ID: 148"]
#[derive(Debug, Clone, PartialEq)]
pub struct AUTOPILOT_VERSION_DATA {
    #[doc = "Bitmap of capabilities"]
    pub capabilities: MavProtocolCapability,
    #[doc = "UID if provided by hardware (see uid2)"]
    pub uid: u64,
    #[doc = "Firmware version number.         The field must be encoded as 4 bytes, where each byte (shown from MSB to LSB) is part of a semantic version: (major) (minor) (patch) (FIRMWARE_VERSION_TYPE)."]
    pub flight_sw_version: u32,
    #[doc = "Middleware version number"]
    pub middleware_sw_version: u32,
    #[doc = "Operating system version number"]
    pub os_sw_version: u32,
    #[doc = "HW / board version (last 8 bits should be silicon ID, if any). The first 16 bits of this field specify a board type from an enumeration stored at <https://github.com/PX4/PX4-Bootloader/blob/master/board_types.txt> and with extensive additions at <https://github.com/ArduPilot/ardupilot/blob/master/Tools/AP_Bootloader/board_types.txt>"]
    pub board_version: u32,
    #[doc = "ID of the board vendor"]
    pub vendor_id: u16,
    #[doc = "ID of the product"]
    pub product_id: u16,
    #[doc = "Custom version field, commonly the first 8 bytes of the git hash. This is not an unique identifier, but should allow to identify the commit using the main version number even for very large code bases."]
    pub flight_custom_version: [u8; 8],
    #[doc = "Custom version field, commonly the first 8 bytes of the git hash. This is not an unique identifier, but should allow to identify the commit using the main version number even for very large code bases."]
    pub middleware_custom_version: [u8; 8],
    #[doc = "Custom version field, commonly the first 8 bytes of the git hash. This is not an unique identifier, but should allow to identify the commit using the main version number even for very large code bases."]
    pub os_custom_version: [u8; 8],
    #[doc = "UID if provided by hardware (supersedes the uid field. If this is non-zero, use this field, otherwise use uid)"]
    pub uid2: [u8; 18],
}
impl AUTOPILOT_VERSION_DATA {
    pub const ENCODED_LEN: usize = 78usize;
    pub const DEFAULT: Self = Self {
        capabilities: MavProtocolCapability::DEFAULT,
        uid: 0_u64,
        flight_sw_version: 0_u32,
        middleware_sw_version: 0_u32,
        os_sw_version: 0_u32,
        board_version: 0_u32,
        vendor_id: 0_u16,
        product_id: 0_u16,
        flight_custom_version: [0_u8; 8usize],
        middleware_custom_version: [0_u8; 8usize],
        os_custom_version: [0_u8; 8usize],
        uid2: [0_u8; 18usize],
    };
}
impl Default for AUTOPILOT_VERSION_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for AUTOPILOT_VERSION_DATA {
    type Message = MavMessage;
    const ID: u32 = 148u32;
    const NAME: &'static str = "AUTOPILOT_VERSION";
    const EXTRA_CRC: u8 = 178u8;
    const ENCODED_LEN: usize = 78usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        let tmp = buf.get_u64_le()?;
        __struct.capabilities =
            MavProtocolCapability::from_bits_retain(tmp as <MavProtocolCapability as Flags>::Bits);
        __struct.uid = buf.get_u64_le()?;
        __struct.flight_sw_version = buf.get_u32_le()?;
        __struct.middleware_sw_version = buf.get_u32_le()?;
        __struct.os_sw_version = buf.get_u32_le()?;
        __struct.board_version = buf.get_u32_le()?;
        __struct.vendor_id = buf.get_u16_le()?;
        __struct.product_id = buf.get_u16_le()?;
        for v in &mut __struct.flight_custom_version {
            let val = buf.get_u8()?;
            *v = val;
        }
        for v in &mut __struct.middleware_custom_version {
            let val = buf.get_u8()?;
            *v = val;
        }
        for v in &mut __struct.os_custom_version {
            let val = buf.get_u8()?;
            *v = val;
        }
        for v in &mut __struct.uid2 {
            let val = buf.get_u8()?;
            *v = val;
        }
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u64_le(self.capabilities.bits() as u64);
        __tmp.put_u64_le(self.uid);
        __tmp.put_u32_le(self.flight_sw_version);
        __tmp.put_u32_le(self.middleware_sw_version);
        __tmp.put_u32_le(self.os_sw_version);
        __tmp.put_u32_le(self.board_version);
        __tmp.put_u16_le(self.vendor_id);
        __tmp.put_u16_le(self.product_id);
        for val in &self.flight_custom_version {
            __tmp.put_u8(*val);
        }
        for val in &self.middleware_custom_version {
            __tmp.put_u8(*val);
        }
        for val in &self.os_custom_version {
            __tmp.put_u8(*val);
        }
        if matches!(version, MavlinkVersion::V2) {
            for val in &self.uid2 {
                __tmp.put_u8(*val);
            }
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Information about a flight mode.          The message can be enumerated to get information for all modes, or requested for a particular mode, using MAV_CMD_REQUEST_MESSAGE.         Specify 0 in param2 to request that the message is emitted for all available modes or the specific index for just one mode.         The modes must be available/settable for the current vehicle/frame type.         Each mode should only be emitted once (even if it is both standard and custom).         Note that the current mode should be emitted in CURRENT_MODE, and that if the mode list can change then AVAILABLE_MODES_MONITOR must be emitted on first change and subsequently streamed.         See <https://mavlink.io/en/services/standard_modes.html>."]
#[doc = ""]
#[doc = "ID: 435"]
#[derive(Debug, Clone, PartialEq)]
pub struct AVAILABLE_MODES_DATA {
    #[doc = "A bitfield for use for autopilot-specific flags"]
    pub custom_mode: u32,
    #[doc = "Mode properties."]
    pub properties: MavModeProperty,
    #[doc = "The total number of available modes for the current vehicle type."]
    pub number_modes: u8,
    #[doc = "The current mode index within number_modes, indexed from 1. The index is not guaranteed to be persistent, and may change between reboots or if the set of modes change."]
    pub mode_index: u8,
    #[doc = "Standard mode."]
    pub standard_mode: MavStandardMode,
    #[doc = "Name of custom mode, with null termination character. Should be omitted for standard modes."]
    pub mode_name: CharArray<35>,
}
impl AVAILABLE_MODES_DATA {
    pub const ENCODED_LEN: usize = 46usize;
    pub const DEFAULT: Self = Self {
        custom_mode: 0_u32,
        properties: MavModeProperty::DEFAULT,
        number_modes: 0_u8,
        mode_index: 0_u8,
        standard_mode: MavStandardMode::DEFAULT,
        mode_name: CharArray::new([0_u8; 35usize]),
    };
}
impl Default for AVAILABLE_MODES_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for AVAILABLE_MODES_DATA {
    type Message = MavMessage;
    const ID: u32 = 435u32;
    const NAME: &'static str = "AVAILABLE_MODES";
    const EXTRA_CRC: u8 = 134u8;
    const ENCODED_LEN: usize = 46usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.custom_mode = buf.get_u32_le()?;
        let tmp = buf.get_u32_le()?;
        __struct.properties =
            MavModeProperty::from_bits_retain(tmp as <MavModeProperty as Flags>::Bits);
        __struct.number_modes = buf.get_u8()?;
        __struct.mode_index = buf.get_u8()?;
        let tmp = buf.get_u8()?;
        __struct.standard_mode =
            FromPrimitive::from_u8(tmp).ok_or(::mavlink_core::error::ParserError::InvalidEnum {
                enum_type: "MavStandardMode",
                value: tmp as u64,
            })?;
        let mut tmp = [0_u8; 35usize];
        for v in &mut tmp {
            *v = buf.get_u8()?;
        }
        __struct.mode_name = CharArray::new(tmp);
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u32_le(self.custom_mode);
        __tmp.put_u32_le(self.properties.bits() as u32);
        __tmp.put_u8(self.number_modes);
        __tmp.put_u8(self.mode_index);
        __tmp.put_u8(self.standard_mode as u8);
        for val in &self.mode_name {
            __tmp.put_u8(*val);
        }
        if matches!(version, MavlinkVersion::V2) {
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "A change to the sequence number indicates that the set of AVAILABLE_MODES has changed, and that the receiver should re-request all available modes.          The message is optional, and is only needed when the set of modes can change dynamically after boot.         It should be emitted whenever the set of modes change.         It should be streamed at low rate (nominally 0.3 Hz).         See <https://mavlink.io/en/services/standard_modes.html>."]
#[doc = ""]
#[doc = "ID: 437"]
#[derive(Debug, Clone, PartialEq)]
pub struct AVAILABLE_MODES_MONITOR_DATA {
    #[doc = "Sequence number. The value iterates sequentially whenever AVAILABLE_MODES changes (e.g. support for a new mode is added/removed dynamically)."]
    pub seq: u8,
}
impl AVAILABLE_MODES_MONITOR_DATA {
    pub const ENCODED_LEN: usize = 1usize;
    pub const DEFAULT: Self = Self { seq: 0_u8 };
}
impl Default for AVAILABLE_MODES_MONITOR_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for AVAILABLE_MODES_MONITOR_DATA {
    type Message = MavMessage;
    const ID: u32 = 437u32;
    const NAME: &'static str = "AVAILABLE_MODES_MONITOR";
    const EXTRA_CRC: u8 = 30u8;
    const ENCODED_LEN: usize = 1usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.seq = buf.get_u8()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u8(self.seq);
        if matches!(version, MavlinkVersion::V2) {
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Battery information. Updates GCS with flight controller battery status. Smart batteries also use this message, but may additionally send BATTERY_INFO."]
#[doc = ""]
#[doc = "ID: 147"]
#[derive(Debug, Clone, PartialEq)]
pub struct BATTERY_STATUS_DATA {
    #[doc = "Consumed charge, -1: autopilot does not provide consumption estimate"]
    pub current_consumed: i32,
    #[doc = "Consumed energy, -1: autopilot does not provide energy consumption estimate"]
    pub energy_consumed: i32,
    #[doc = "Temperature of the battery. INT16_MAX for unknown temperature."]
    pub temperature: i16,
    #[doc = "Battery voltage of cells 1 to 10 (see voltages_ext for cells 11-14). Cells in this field above the valid cell count for this battery should have the UINT16_MAX value. If individual cell voltages are unknown or not measured for this battery, then the overall battery voltage should be filled in cell 0, with all others set to UINT16_MAX. If the voltage of the battery is greater than (UINT16_MAX - 1), then cell 0 should be set to (UINT16_MAX - 1), and cell 1 to the remaining voltage. This can be extended to multiple cells if the total voltage is greater than 2 * (UINT16_MAX - 1)."]
    pub voltages: [u16; 10],
    #[doc = "Battery current, -1: autopilot does not measure the current. Value may overflow/rollover for very high currents (>327.67A)"]
    pub current_battery: i16,
    #[doc = "Battery ID"]
    pub id: u8,
    #[doc = "Function of the battery"]
    pub battery_function: MavBatteryFunction,
    #[doc = "Type (chemistry) of the battery"]
    pub mavtype: MavBatteryType,
    #[doc = "Remaining battery energy. Values: [0-100], -1: autopilot does not estimate the remaining battery."]
    pub battery_remaining: i8,
    #[doc = "Remaining battery time, 0: autopilot does not provide remaining battery time estimate"]
    pub time_remaining: i32,
    #[doc = "State for extent of discharge, provided by autopilot for warning or external reactions"]
    pub charge_state: MavBatteryChargeState,
    #[doc = "Battery voltages for cells 11 to 14. Cells above the valid cell count for this battery should have a value of 0, where zero indicates not supported (note, this is different than for the voltages field and allows empty byte truncation). If the measured value is 0 then 1 should be sent instead."]
    pub voltages_ext: [u16; 4],
    #[doc = "Battery mode. Default (0) is that battery mode reporting is not supported or battery is in normal-use mode."]
    pub mode: MavBatteryMode,
    #[doc = "Fault/health indications. These should be set when charge_state is MAV_BATTERY_CHARGE_STATE_FAILED or MAV_BATTERY_CHARGE_STATE_UNHEALTHY (if not, fault reporting is not supported)."]
    pub fault_bitmask: MavBatteryFault,
}
impl BATTERY_STATUS_DATA {
    pub const ENCODED_LEN: usize = 54usize;
    pub const DEFAULT: Self = Self {
        current_consumed: 0_i32,
        energy_consumed: 0_i32,
        temperature: 0_i16,
        voltages: [0_u16; 10usize],
        current_battery: 0_i16,
        id: 0_u8,
        battery_function: MavBatteryFunction::DEFAULT,
        mavtype: MavBatteryType::DEFAULT,
        battery_remaining: 0_i8,
        time_remaining: 0_i32,
        charge_state: MavBatteryChargeState::DEFAULT,
        voltages_ext: [0_u16; 4usize],
        mode: MavBatteryMode::DEFAULT,
        fault_bitmask: MavBatteryFault::DEFAULT,
    };
}
impl Default for BATTERY_STATUS_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for BATTERY_STATUS_DATA {
    type Message = MavMessage;
    const ID: u32 = 147u32;
    const NAME: &'static str = "BATTERY_STATUS";
    const EXTRA_CRC: u8 = 154u8;
    const ENCODED_LEN: usize = 54usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.current_consumed = buf.get_i32_le()?;
        __struct.energy_consumed = buf.get_i32_le()?;
        __struct.temperature = buf.get_i16_le()?;
        for v in &mut __struct.voltages {
            let val = buf.get_u16_le()?;
            *v = val;
        }
        __struct.current_battery = buf.get_i16_le()?;
        __struct.id = buf.get_u8()?;
        let tmp = buf.get_u8()?;
        __struct.battery_function =
            FromPrimitive::from_u8(tmp).ok_or(::mavlink_core::error::ParserError::InvalidEnum {
                enum_type: "MavBatteryFunction",
                value: tmp as u64,
            })?;
        let tmp = buf.get_u8()?;
        __struct.mavtype =
            FromPrimitive::from_u8(tmp).ok_or(::mavlink_core::error::ParserError::InvalidEnum {
                enum_type: "MavBatteryType",
                value: tmp as u64,
            })?;
        __struct.battery_remaining = buf.get_i8()?;
        __struct.time_remaining = buf.get_i32_le()?;
        let tmp = buf.get_u8()?;
        __struct.charge_state =
            FromPrimitive::from_u8(tmp).ok_or(::mavlink_core::error::ParserError::InvalidEnum {
                enum_type: "MavBatteryChargeState",
                value: tmp as u64,
            })?;
        for v in &mut __struct.voltages_ext {
            let val = buf.get_u16_le()?;
            *v = val;
        }
        let tmp = buf.get_u8()?;
        __struct.mode =
            FromPrimitive::from_u8(tmp).ok_or(::mavlink_core::error::ParserError::InvalidEnum {
                enum_type: "MavBatteryMode",
                value: tmp as u64,
            })?;
        let tmp = buf.get_u32_le()?;
        __struct.fault_bitmask =
            MavBatteryFault::from_bits_retain(tmp as <MavBatteryFault as Flags>::Bits);
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_i32_le(self.current_consumed);
        __tmp.put_i32_le(self.energy_consumed);
        __tmp.put_i16_le(self.temperature);
        for val in &self.voltages {
            __tmp.put_u16_le(*val);
        }
        __tmp.put_i16_le(self.current_battery);
        __tmp.put_u8(self.id);
        __tmp.put_u8(self.battery_function as u8);
        __tmp.put_u8(self.mavtype as u8);
        __tmp.put_i8(self.battery_remaining);
        if matches!(version, MavlinkVersion::V2) {
            __tmp.put_i32_le(self.time_remaining);
            __tmp.put_u8(self.charge_state as u8);
            for val in &self.voltages_ext {
                __tmp.put_u16_le(*val);
            }
            __tmp.put_u8(self.mode as u8);
            __tmp.put_u32_le(self.fault_bitmask.bits() as u32);
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Information about a camera. Can be requested with a MAV_CMD_REQUEST_MESSAGE command."]
#[doc = ""]
#[doc = "ID: 259"]
#[derive(Debug, Clone, PartialEq)]
pub struct CAMERA_INFORMATION_DATA {
    #[doc = "Timestamp (time since system boot)."]
    pub time_boot_ms: u32,
    #[doc = "Version of the camera firmware, encoded as: `(Dev&0xff)<<24 + (Patch&0xff)<<16 + (Minor&0xff)<<8 + (Major&0xff)`. Use 0 if not known."]
    pub firmware_version: u32,
    #[doc = "Focal length. Use NaN if not known."]
    pub focal_length: f32,
    #[doc = "Image sensor size horizontal. Use NaN if not known."]
    pub sensor_size_h: f32,
    #[doc = "Image sensor size vertical. Use NaN if not known."]
    pub sensor_size_v: f32,
    #[doc = "Bitmap of camera capability flags."]
    pub flags: CameraCapFlags,
    #[doc = "Horizontal image resolution. Use 0 if not known."]
    pub resolution_h: u16,
    #[doc = "Vertical image resolution. Use 0 if not known."]
    pub resolution_v: u16,
    #[doc = "Camera definition version (iteration).  Use 0 if not known."]
    pub cam_definition_version: u16,
    #[doc = "Name of the camera vendor"]
    pub vendor_name: [u8; 32],
    #[doc = "Name of the camera model"]
    pub model_name: [u8; 32],
    #[doc = "Reserved for a lens ID.  Use 0 if not known."]
    pub lens_id: u8,
    #[doc = "Camera definition URI (if any, otherwise only basic functions will be available). HTTP- (http://) and MAVLink FTP- (mavlinkftp://) formatted URIs are allowed (and both must be supported by any GCS that implements the Camera Protocol). The definition file may be xz compressed, which will be indicated by the file extension .xml.xz (a GCS that implements the protocol must support decompressing the file). The string needs to be zero terminated.  Use a zero-length string if not known."]
    pub cam_definition_uri: CharArray<140>,
    #[doc = "Gimbal id of a gimbal associated with this camera. This is the component id of the gimbal device, or 1-6 for non mavlink gimbals. Use 0 if no gimbal is associated with the camera."]
    pub gimbal_device_id: u8,
    #[doc = "Camera id of a non-MAVLink camera attached to an autopilot (1-6).  0 if the component is a MAVLink camera (with its own component id)."]
    pub camera_device_id: u8,
}
impl CAMERA_INFORMATION_DATA {
    pub const ENCODED_LEN: usize = 237usize;
    pub const DEFAULT: Self = Self {
        time_boot_ms: 0_u32,
        firmware_version: 0_u32,
        focal_length: 0.0_f32,
        sensor_size_h: 0.0_f32,
        sensor_size_v: 0.0_f32,
        flags: CameraCapFlags::DEFAULT,
        resolution_h: 0_u16,
        resolution_v: 0_u16,
        cam_definition_version: 0_u16,
        vendor_name: [0_u8; 32usize],
        model_name: [0_u8; 32usize],
        lens_id: 0_u8,
        cam_definition_uri: CharArray::new([0_u8; 140usize]),
        gimbal_device_id: 0_u8,
        camera_device_id: 0_u8,
    };
}
impl Default for CAMERA_INFORMATION_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for CAMERA_INFORMATION_DATA {
    type Message = MavMessage;
    const ID: u32 = 259u32;
    const NAME: &'static str = "CAMERA_INFORMATION";
    const EXTRA_CRC: u8 = 92u8;
    const ENCODED_LEN: usize = 237usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.time_boot_ms = buf.get_u32_le()?;
        __struct.firmware_version = buf.get_u32_le()?;
        __struct.focal_length = buf.get_f32_le()?;
        __struct.sensor_size_h = buf.get_f32_le()?;
        __struct.sensor_size_v = buf.get_f32_le()?;
        let tmp = buf.get_u32_le()?;
        __struct.flags = CameraCapFlags::from_bits_retain(tmp as <CameraCapFlags as Flags>::Bits);
        __struct.resolution_h = buf.get_u16_le()?;
        __struct.resolution_v = buf.get_u16_le()?;
        __struct.cam_definition_version = buf.get_u16_le()?;
        for v in &mut __struct.vendor_name {
            let val = buf.get_u8()?;
            *v = val;
        }
        for v in &mut __struct.model_name {
            let val = buf.get_u8()?;
            *v = val;
        }
        __struct.lens_id = buf.get_u8()?;
        let mut tmp = [0_u8; 140usize];
        for v in &mut tmp {
            *v = buf.get_u8()?;
        }
        __struct.cam_definition_uri = CharArray::new(tmp);
        __struct.gimbal_device_id = buf.get_u8()?;
        __struct.camera_device_id = buf.get_u8()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u32_le(self.time_boot_ms);
        __tmp.put_u32_le(self.firmware_version);
        __tmp.put_f32_le(self.focal_length);
        __tmp.put_f32_le(self.sensor_size_h);
        __tmp.put_f32_le(self.sensor_size_v);
        __tmp.put_u32_le(self.flags.bits() as u32);
        __tmp.put_u16_le(self.resolution_h);
        __tmp.put_u16_le(self.resolution_v);
        __tmp.put_u16_le(self.cam_definition_version);
        for val in &self.vendor_name {
            __tmp.put_u8(*val);
        }
        for val in &self.model_name {
            __tmp.put_u8(*val);
        }
        __tmp.put_u8(self.lens_id);
        for val in &self.cam_definition_uri {
            __tmp.put_u8(*val);
        }
        if matches!(version, MavlinkVersion::V2) {
            __tmp.put_u8(self.gimbal_device_id);
            __tmp.put_u8(self.camera_device_id);
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Report status of a command. Includes feedback whether the command was executed. The command microservice is documented at <https://mavlink.io/en/services/command.html>."]
#[doc = ""]
#[doc = "ID: 77"]
#[derive(Debug, Clone, PartialEq)]
pub struct COMMAND_ACK_DATA {
    #[doc = "Command ID (of acknowledged command)."]
    pub command: u16,
    #[doc = "Result of command."]
    pub result: MavResult,
    #[doc = "The progress percentage when result is MAV_RESULT_IN_PROGRESS. Values: [0-100], or UINT8_MAX if the progress is unknown."]
    pub progress: u8,
    #[doc = "Additional result information. Can be set with a command-specific enum containing command-specific error reasons for why the command might be denied. If used, the associated enum must be documented in the corresponding MAV_CMD (this enum should have a 0 value to indicate \"unused\" or \"unknown\")."]
    pub result_param2: i32,
    #[doc = "System ID of the target recipient. This is the ID of the system that sent the command for which this COMMAND_ACK is an acknowledgement."]
    pub target_system: u8,
    #[doc = "Component ID of the target recipient. This is the ID of the system that sent the command for which this COMMAND_ACK is an acknowledgement."]
    pub target_component: u8,
}
impl COMMAND_ACK_DATA {
    pub const ENCODED_LEN: usize = 10usize;
    pub const DEFAULT: Self = Self {
        command: 0_u16,
        result: MavResult::DEFAULT,
        progress: 0_u8,
        result_param2: 0_i32,
        target_system: 0_u8,
        target_component: 0_u8,
    };
}
impl Default for COMMAND_ACK_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for COMMAND_ACK_DATA {
    type Message = MavMessage;
    const ID: u32 = 77u32;
    const NAME: &'static str = "COMMAND_ACK";
    const EXTRA_CRC: u8 = 143u8;
    const ENCODED_LEN: usize = 10usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.command = buf.get_u16_le()?;
        let tmp = buf.get_u8()?;
        __struct.result =
            FromPrimitive::from_u8(tmp).ok_or(::mavlink_core::error::ParserError::InvalidEnum {
                enum_type: "MavResult",
                value: tmp as u64,
            })?;
        __struct.progress = buf.get_u8()?;
        __struct.result_param2 = buf.get_i32_le()?;
        __struct.target_system = buf.get_u8()?;
        __struct.target_component = buf.get_u8()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u16_le(self.command);
        __tmp.put_u8(self.result as u8);
        if matches!(version, MavlinkVersion::V2) {
            __tmp.put_u8(self.progress);
            __tmp.put_i32_le(self.result_param2);
            __tmp.put_u8(self.target_system);
            __tmp.put_u8(self.target_component);
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Cancel a long running command. The target system should respond with a COMMAND_ACK to the original command with result=MAV_RESULT_CANCELLED if the long running process was cancelled. If it has already completed, the cancel action can be ignored. The cancel action can be retried until some sort of acknowledgement to the original command has been received. The command microservice is documented at <https://mavlink.io/en/services/command.html>."]
#[doc = ""]
#[doc = "ID: 80"]
#[derive(Debug, Clone, PartialEq)]
pub struct COMMAND_CANCEL_DATA {
    #[doc = "Command ID (of command to cancel)."]
    pub command: u16,
    #[doc = "System executing long running command. Should not be broadcast (0)."]
    pub target_system: u8,
    #[doc = "Component executing long running command."]
    pub target_component: u8,
}
impl COMMAND_CANCEL_DATA {
    pub const ENCODED_LEN: usize = 4usize;
    pub const DEFAULT: Self = Self { command: 0_u16, target_system: 0_u8, target_component: 0_u8 };
}
impl Default for COMMAND_CANCEL_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for COMMAND_CANCEL_DATA {
    type Message = MavMessage;
    const ID: u32 = 80u32;
    const NAME: &'static str = "COMMAND_CANCEL";
    const EXTRA_CRC: u8 = 14u8;
    const ENCODED_LEN: usize = 4usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.command = buf.get_u16_le()?;
        __struct.target_system = buf.get_u8()?;
        __struct.target_component = buf.get_u8()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u16_le(self.command);
        __tmp.put_u8(self.target_system);
        __tmp.put_u8(self.target_component);
        if matches!(version, MavlinkVersion::V2) {
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Send a command with up to seven parameters to the MAV, where params 5 and 6 are integers and the other values are floats. This is preferred over COMMAND_LONG as it allows the MAV_FRAME to be specified for interpreting positional information, such as altitude. COMMAND_INT is also preferred when sending latitude and longitude data in params 5 and 6, as it allows for greater precision. Param 5 and 6 encode positional data as scaled integers, where the scaling depends on the actual command value. NaN or INT32_MAX may be used in float/integer params (respectively) to indicate optional/default values (e.g. to use the component's current latitude, yaw rather than a specific value). The command microservice is documented at <https://mavlink.io/en/services/command.html>."]
#[doc = ""]
#[doc = "ID: 75"]
#[derive(Debug, Clone, PartialEq)]
pub struct COMMAND_INT_DATA {
    #[doc = "PARAM1, see MAV_CMD enum"]
    pub param1: f32,
    #[doc = "PARAM2, see MAV_CMD enum"]
    pub param2: f32,
    #[doc = "PARAM3, see MAV_CMD enum"]
    pub param3: f32,
    #[doc = "PARAM4, see MAV_CMD enum"]
    pub param4: f32,
    #[doc = "PARAM5 / local: x position in meters * 1e4, global: latitude in degrees * 10^7"]
    pub x: i32,
    #[doc = "PARAM6 / local: y position in meters * 1e4, global: longitude in degrees * 10^7"]
    pub y: i32,
    #[doc = "PARAM7 / z position: global: altitude in meters (relative or absolute, depending on frame)."]
    pub z: f32,
    #[doc = "The scheduled action for the mission item."]
    pub command: u16,
    #[doc = "System ID"]
    pub target_system: u8,
    #[doc = "Component ID"]
    pub target_component: u8,
    #[doc = "The coordinate system of the COMMAND."]
    pub frame: u8,
    #[doc = "Not used."]
    pub current: u8,
    #[doc = "Not used (set 0)."]
    pub autocontinue: u8,
}
impl COMMAND_INT_DATA {
    pub const ENCODED_LEN: usize = 35usize;
    pub const DEFAULT: Self = Self {
        param1: 0.0_f32,
        param2: 0.0_f32,
        param3: 0.0_f32,
        param4: 0.0_f32,
        x: 0_i32,
        y: 0_i32,
        z: 0.0_f32,
        command: 0_u16,
        target_system: 0_u8,
        target_component: 0_u8,
        frame: 0_u8,
        current: 0_u8,
        autocontinue: 0_u8,
    };
}
impl Default for COMMAND_INT_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for COMMAND_INT_DATA {
    type Message = MavMessage;
    const ID: u32 = 75u32;
    const NAME: &'static str = "COMMAND_INT";
    const EXTRA_CRC: u8 = 158u8;
    const ENCODED_LEN: usize = 35usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.param1 = buf.get_f32_le()?;
        __struct.param2 = buf.get_f32_le()?;
        __struct.param3 = buf.get_f32_le()?;
        __struct.param4 = buf.get_f32_le()?;
        __struct.x = buf.get_i32_le()?;
        __struct.y = buf.get_i32_le()?;
        __struct.z = buf.get_f32_le()?;
        __struct.command = buf.get_u16_le()?;
        __struct.target_system = buf.get_u8()?;
        __struct.target_component = buf.get_u8()?;
        __struct.frame = buf.get_u8()?;
        __struct.current = buf.get_u8()?;
        __struct.autocontinue = buf.get_u8()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_f32_le(self.param1);
        __tmp.put_f32_le(self.param2);
        __tmp.put_f32_le(self.param3);
        __tmp.put_f32_le(self.param4);
        __tmp.put_i32_le(self.x);
        __tmp.put_i32_le(self.y);
        __tmp.put_f32_le(self.z);
        __tmp.put_u16_le(self.command);
        __tmp.put_u8(self.target_system);
        __tmp.put_u8(self.target_component);
        __tmp.put_u8(self.frame);
        __tmp.put_u8(self.current);
        __tmp.put_u8(self.autocontinue);
        if matches!(version, MavlinkVersion::V2) {
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Send a command with up to seven parameters to the MAV. COMMAND_INT is generally preferred when sending MAV_CMD commands that include positional information; it offers higher precision and allows the MAV_FRAME to be specified (which may otherwise be ambiguous, particularly for altitude). The command microservice is documented at <https://mavlink.io/en/services/command.html>."]
#[doc = ""]
#[doc = "ID: 76"]
#[derive(Debug, Clone, PartialEq)]
pub struct COMMAND_LONG_DATA {
    #[doc = "Parameter 1 (for the specific command)."]
    pub param1: f32,
    #[doc = "Parameter 2 (for the specific command)."]
    pub param2: f32,
    #[doc = "Parameter 3 (for the specific command)."]
    pub param3: f32,
    #[doc = "Parameter 4 (for the specific command)."]
    pub param4: f32,
    #[doc = "Parameter 5 (for the specific command)."]
    pub param5: f32,
    #[doc = "Parameter 6 (for the specific command)."]
    pub param6: f32,
    #[doc = "Parameter 7 (for the specific command)."]
    pub param7: f32,
    #[doc = "Command ID (of command to send)."]
    pub command: u16,
    #[doc = "System which should execute the command"]
    pub target_system: u8,
    #[doc = "Component which should execute the command, 0 for all components"]
    pub target_component: u8,
    #[doc = "0: First transmission of this command. 1-255: Confirmation transmissions (e.g. for kill command)"]
    pub confirmation: u8,
}
impl COMMAND_LONG_DATA {
    pub const ENCODED_LEN: usize = 33usize;
    pub const DEFAULT: Self = Self {
        param1: 0.0_f32,
        param2: 0.0_f32,
        param3: 0.0_f32,
        param4: 0.0_f32,
        param5: 0.0_f32,
        param6: 0.0_f32,
        param7: 0.0_f32,
        command: 0_u16,
        target_system: 0_u8,
        target_component: 0_u8,
        confirmation: 0_u8,
    };
}
impl Default for COMMAND_LONG_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for COMMAND_LONG_DATA {
    type Message = MavMessage;
    const ID: u32 = 76u32;
    const NAME: &'static str = "COMMAND_LONG";
    const EXTRA_CRC: u8 = 152u8;
    const ENCODED_LEN: usize = 33usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.param1 = buf.get_f32_le()?;
        __struct.param2 = buf.get_f32_le()?;
        __struct.param3 = buf.get_f32_le()?;
        __struct.param4 = buf.get_f32_le()?;
        __struct.param5 = buf.get_f32_le()?;
        __struct.param6 = buf.get_f32_le()?;
        __struct.param7 = buf.get_f32_le()?;
        __struct.command = buf.get_u16_le()?;
        __struct.target_system = buf.get_u8()?;
        __struct.target_component = buf.get_u8()?;
        __struct.confirmation = buf.get_u8()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_f32_le(self.param1);
        __tmp.put_f32_le(self.param2);
        __tmp.put_f32_le(self.param3);
        __tmp.put_f32_le(self.param4);
        __tmp.put_f32_le(self.param5);
        __tmp.put_f32_le(self.param6);
        __tmp.put_f32_le(self.param7);
        __tmp.put_u16_le(self.command);
        __tmp.put_u8(self.target_system);
        __tmp.put_u8(self.target_component);
        __tmp.put_u8(self.confirmation);
        if matches!(version, MavlinkVersion::V2) {
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Component metadata message, which may be requested using MAV_CMD_REQUEST_MESSAGE.          This contains the MAVLink FTP URI and CRC for the component's general metadata file.         The file must be hosted on the component, and may be xz compressed.         The file CRC can be used for file caching.          The general metadata file can be read to get the locations of other metadata files (COMP_METADATA_TYPE) and translations, which may be hosted either on the vehicle or the internet.         For more information see: <https://mavlink.io/en/services/component_information.html>.          Note: Camera components should use CAMERA_INFORMATION instead, and autopilots may use both this message and AUTOPILOT_VERSION."]
#[doc = ""]
#[doc = "ID: 397"]
#[derive(Debug, Clone, PartialEq)]
pub struct COMPONENT_METADATA_DATA {
    #[doc = "Timestamp (time since system boot)."]
    pub time_boot_ms: u32,
    #[doc = "CRC32 of the general metadata file."]
    pub file_crc: u32,
    #[doc = "MAVLink FTP URI for the general metadata file (COMP_METADATA_TYPE_GENERAL), which may be compressed with xz. The file contains general component metadata, and may contain URI links for additional metadata (see COMP_METADATA_TYPE). The information is static from boot, and may be generated at compile time. The string needs to be zero terminated."]
    pub uri: CharArray<100>,
}
impl COMPONENT_METADATA_DATA {
    pub const ENCODED_LEN: usize = 108usize;
    pub const DEFAULT: Self =
        Self { time_boot_ms: 0_u32, file_crc: 0_u32, uri: CharArray::new([0_u8; 100usize]) };
}
impl Default for COMPONENT_METADATA_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for COMPONENT_METADATA_DATA {
    type Message = MavMessage;
    const ID: u32 = 397u32;
    const NAME: &'static str = "COMPONENT_METADATA";
    const EXTRA_CRC: u8 = 182u8;
    const ENCODED_LEN: usize = 108usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.time_boot_ms = buf.get_u32_le()?;
        __struct.file_crc = buf.get_u32_le()?;
        let mut tmp = [0_u8; 100usize];
        for v in &mut tmp {
            *v = buf.get_u8()?;
        }
        __struct.uri = CharArray::new(tmp);
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u32_le(self.time_boot_ms);
        __tmp.put_u32_le(self.file_crc);
        for val in &self.uri {
            __tmp.put_u8(*val);
        }
        if matches!(version, MavlinkVersion::V2) {
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Regular broadcast for the current latest event sequence number for a component. This is used to check for dropped events."]
#[doc = ""]
#[doc = "ID: 411"]
#[derive(Debug, Clone, PartialEq)]
pub struct CURRENT_EVENT_SEQUENCE_DATA {
    #[doc = "Sequence number."]
    pub sequence: u16,
    #[doc = "Flag bitset."]
    pub flags: MavEventCurrentSequenceFlags,
}
impl CURRENT_EVENT_SEQUENCE_DATA {
    pub const ENCODED_LEN: usize = 3usize;
    pub const DEFAULT: Self =
        Self { sequence: 0_u16, flags: MavEventCurrentSequenceFlags::DEFAULT };
}
impl Default for CURRENT_EVENT_SEQUENCE_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for CURRENT_EVENT_SEQUENCE_DATA {
    type Message = MavMessage;
    const ID: u32 = 411u32;
    const NAME: &'static str = "CURRENT_EVENT_SEQUENCE";
    const EXTRA_CRC: u8 = 106u8;
    const ENCODED_LEN: usize = 3usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.sequence = buf.get_u16_le()?;
        let tmp = buf.get_u8()?;
        __struct.flags = MavEventCurrentSequenceFlags::from_bits_retain(
            tmp as <MavEventCurrentSequenceFlags as Flags>::Bits,
        );
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u16_le(self.sequence);
        __tmp.put_u8(self.flags.bits() as u8);
        if matches!(version, MavlinkVersion::V2) {
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Get the current mode.         This should be emitted on any mode change, and broadcast at low rate (nominally 0.5 Hz).         It may be requested using MAV_CMD_REQUEST_MESSAGE.         See <https://mavlink.io/en/services/standard_modes.html>."]
#[doc = ""]
#[doc = "ID: 436"]
#[derive(Debug, Clone, PartialEq)]
pub struct CURRENT_MODE_DATA {
    #[doc = "A bitfield for use for autopilot-specific flags"]
    pub custom_mode: u32,
    #[doc = "The custom_mode of the mode that was last commanded by the user (for example, with MAV_CMD_DO_SET_STANDARD_MODE, MAV_CMD_DO_SET_MODE or via RC). This should usually be the same as custom_mode. It will be different if the vehicle is unable to enter the intended mode, or has left that mode due to a failsafe condition. 0 indicates the intended custom mode is unknown/not supplied"]
    pub intended_custom_mode: u32,
    #[doc = "Standard mode."]
    pub standard_mode: MavStandardMode,
}
impl CURRENT_MODE_DATA {
    pub const ENCODED_LEN: usize = 9usize;
    pub const DEFAULT: Self = Self {
        custom_mode: 0_u32,
        intended_custom_mode: 0_u32,
        standard_mode: MavStandardMode::DEFAULT,
    };
}
impl Default for CURRENT_MODE_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for CURRENT_MODE_DATA {
    type Message = MavMessage;
    const ID: u32 = 436u32;
    const NAME: &'static str = "CURRENT_MODE";
    const EXTRA_CRC: u8 = 193u8;
    const ENCODED_LEN: usize = 9usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.custom_mode = buf.get_u32_le()?;
        __struct.intended_custom_mode = buf.get_u32_le()?;
        let tmp = buf.get_u8()?;
        __struct.standard_mode =
            FromPrimitive::from_u8(tmp).ok_or(::mavlink_core::error::ParserError::InvalidEnum {
                enum_type: "MavStandardMode",
                value: tmp as u64,
            })?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u32_le(self.custom_mode);
        __tmp.put_u32_le(self.intended_custom_mode);
        __tmp.put_u8(self.standard_mode as u8);
        if matches!(version, MavlinkVersion::V2) {
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[deprecated = " See `MESSAGE_INTERVAL` (Superseded since 2015-08)"]
#[doc = "Data stream status information."]
#[doc = ""]
#[doc = "ID: 67"]
#[derive(Debug, Clone, PartialEq)]
pub struct DATA_STREAM_DATA {
    #[doc = "The message rate"]
    pub message_rate: u16,
    #[doc = "The ID of the requested data stream."]
    pub stream_id: u8,
    #[doc = "1 stream is enabled, 0 stream is stopped."]
    pub on_off: u8,
}
impl DATA_STREAM_DATA {
    pub const ENCODED_LEN: usize = 4usize;
    pub const DEFAULT: Self = Self { message_rate: 0_u16, stream_id: 0_u8, on_off: 0_u8 };
}
impl Default for DATA_STREAM_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for DATA_STREAM_DATA {
    type Message = MavMessage;
    const ID: u32 = 67u32;
    const NAME: &'static str = "DATA_STREAM";
    const EXTRA_CRC: u8 = 21u8;
    const ENCODED_LEN: usize = 4usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.message_rate = buf.get_u16_le()?;
        __struct.stream_id = buf.get_u8()?;
        __struct.on_off = buf.get_u8()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u16_le(self.message_rate);
        __tmp.put_u8(self.stream_id);
        __tmp.put_u8(self.on_off);
        if matches!(version, MavlinkVersion::V2) {
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Distance sensor information for an onboard rangefinder."]
#[doc = ""]
#[doc = "ID: 132"]
#[derive(Debug, Clone, PartialEq)]
pub struct DISTANCE_SENSOR_DATA {
    #[doc = "Timestamp (time since system boot)."]
    pub time_boot_ms: u32,
    #[doc = "Minimum distance the sensor can measure"]
    pub min_distance: u16,
    #[doc = "Maximum distance the sensor can measure"]
    pub max_distance: u16,
    #[doc = "Current distance reading"]
    pub current_distance: u16,
    #[doc = "Type of distance sensor."]
    pub mavtype: MavDistanceSensor,
    #[doc = "Onboard ID of the sensor"]
    pub id: u8,
    #[doc = "Direction the sensor faces. downward-facing: ROTATION_PITCH_270, upward-facing: ROTATION_PITCH_90, backward-facing: ROTATION_PITCH_180, forward-facing: ROTATION_NONE, left-facing: ROTATION_YAW_90, right-facing: ROTATION_YAW_270"]
    pub orientation: MavSensorOrientation,
    #[doc = "Measurement variance. Max standard deviation is 6cm. UINT8_MAX if unknown."]
    pub covariance: u8,
    #[doc = "Horizontal Field of View (angle) where the distance measurement is valid and the field of view is known. Otherwise this is set to 0."]
    pub horizontal_fov: f32,
    #[doc = "Vertical Field of View (angle) where the distance measurement is valid and the field of view is known. Otherwise this is set to 0."]
    pub vertical_fov: f32,
    #[doc = "Quaternion of the sensor orientation in vehicle body frame (w, x, y, z order, zero-rotation is 1, 0, 0, 0). Zero-rotation is along the vehicle body x-axis. This field is required if the orientation is set to MAV_SENSOR_ROTATION_CUSTOM. Set it to 0 if invalid.\""]
    pub quaternion: [f32; 4],
    #[doc = "Signal quality of the sensor. Specific to each sensor type, representing the relation of the signal strength with the target reflectivity, distance, size or aspect, but normalised as a percentage. 0 = unknown/unset signal quality, 1 = invalid signal, 100 = perfect signal."]
    pub signal_quality: u8,
}
impl DISTANCE_SENSOR_DATA {
    pub const ENCODED_LEN: usize = 39usize;
    pub const DEFAULT: Self = Self {
        time_boot_ms: 0_u32,
        min_distance: 0_u16,
        max_distance: 0_u16,
        current_distance: 0_u16,
        mavtype: MavDistanceSensor::DEFAULT,
        id: 0_u8,
        orientation: MavSensorOrientation::DEFAULT,
        covariance: 0_u8,
        horizontal_fov: 0.0_f32,
        vertical_fov: 0.0_f32,
        quaternion: [0.0_f32; 4usize],
        signal_quality: 0_u8,
    };
}
impl Default for DISTANCE_SENSOR_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for DISTANCE_SENSOR_DATA {
    type Message = MavMessage;
    const ID: u32 = 132u32;
    const NAME: &'static str = "DISTANCE_SENSOR";
    const EXTRA_CRC: u8 = 85u8;
    const ENCODED_LEN: usize = 39usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.time_boot_ms = buf.get_u32_le()?;
        __struct.min_distance = buf.get_u16_le()?;
        __struct.max_distance = buf.get_u16_le()?;
        __struct.current_distance = buf.get_u16_le()?;
        let tmp = buf.get_u8()?;
        __struct.mavtype =
            FromPrimitive::from_u8(tmp).ok_or(::mavlink_core::error::ParserError::InvalidEnum {
                enum_type: "MavDistanceSensor",
                value: tmp as u64,
            })?;
        __struct.id = buf.get_u8()?;
        let tmp = buf.get_u8()?;
        __struct.orientation =
            FromPrimitive::from_u8(tmp).ok_or(::mavlink_core::error::ParserError::InvalidEnum {
                enum_type: "MavSensorOrientation",
                value: tmp as u64,
            })?;
        __struct.covariance = buf.get_u8()?;
        __struct.horizontal_fov = buf.get_f32_le()?;
        __struct.vertical_fov = buf.get_f32_le()?;
        for v in &mut __struct.quaternion {
            let val = buf.get_f32_le()?;
            *v = val;
        }
        __struct.signal_quality = buf.get_u8()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u32_le(self.time_boot_ms);
        __tmp.put_u16_le(self.min_distance);
        __tmp.put_u16_le(self.max_distance);
        __tmp.put_u16_le(self.current_distance);
        __tmp.put_u8(self.mavtype as u8);
        __tmp.put_u8(self.id);
        __tmp.put_u8(self.orientation as u8);
        __tmp.put_u8(self.covariance);
        if matches!(version, MavlinkVersion::V2) {
            __tmp.put_f32_le(self.horizontal_fov);
            __tmp.put_f32_le(self.vertical_fov);
            for val in &self.quaternion {
                __tmp.put_f32_le(*val);
            }
            __tmp.put_u8(self.signal_quality);
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Estimator status message including flags, innovation test ratios and estimated accuracies. The flags message is an integer bitmask containing information on which EKF outputs are valid. See the ESTIMATOR_STATUS_FLAGS enum definition for further information. The innovation test ratios show the magnitude of the sensor innovation divided by the innovation check threshold. Under normal operation the innovation test ratios should be below 0.5 with occasional values up to 1.0. Values greater than 1.0 should be rare under normal operation and indicate that a measurement has been rejected by the filter. The user should be notified if an innovation test ratio greater than 1.0 is recorded. Notifications for values in the range between 0.5 and 1.0 should be optional and controllable by the user."]
#[doc = ""]
#[doc = "ID: 230"]
#[derive(Debug, Clone, PartialEq)]
pub struct ESTIMATOR_STATUS_DATA {
    #[doc = "Timestamp (UNIX Epoch time or time since system boot). The receiving end can infer timestamp format (since 1.1.1970 or since system boot) by checking for the magnitude of the number."]
    pub time_usec: u64,
    #[doc = "Velocity innovation test ratio"]
    pub vel_ratio: f32,
    #[doc = "Horizontal position innovation test ratio"]
    pub pos_horiz_ratio: f32,
    #[doc = "Vertical position innovation test ratio"]
    pub pos_vert_ratio: f32,
    #[doc = "Magnetometer innovation test ratio"]
    pub mag_ratio: f32,
    #[doc = "Height above terrain innovation test ratio"]
    pub hagl_ratio: f32,
    #[doc = "True airspeed innovation test ratio"]
    pub tas_ratio: f32,
    #[doc = "Horizontal position 1-STD accuracy relative to the EKF local origin"]
    pub pos_horiz_accuracy: f32,
    #[doc = "Vertical position 1-STD accuracy relative to the EKF local origin"]
    pub pos_vert_accuracy: f32,
    #[doc = "Bitmap indicating which EKF outputs are valid."]
    pub flags: EstimatorStatusFlags,
}
impl ESTIMATOR_STATUS_DATA {
    pub const ENCODED_LEN: usize = 42usize;
    pub const DEFAULT: Self = Self {
        time_usec: 0_u64,
        vel_ratio: 0.0_f32,
        pos_horiz_ratio: 0.0_f32,
        pos_vert_ratio: 0.0_f32,
        mag_ratio: 0.0_f32,
        hagl_ratio: 0.0_f32,
        tas_ratio: 0.0_f32,
        pos_horiz_accuracy: 0.0_f32,
        pos_vert_accuracy: 0.0_f32,
        flags: EstimatorStatusFlags::DEFAULT,
    };
}
impl Default for ESTIMATOR_STATUS_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for ESTIMATOR_STATUS_DATA {
    type Message = MavMessage;
    const ID: u32 = 230u32;
    const NAME: &'static str = "ESTIMATOR_STATUS";
    const EXTRA_CRC: u8 = 163u8;
    const ENCODED_LEN: usize = 42usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.time_usec = buf.get_u64_le()?;
        __struct.vel_ratio = buf.get_f32_le()?;
        __struct.pos_horiz_ratio = buf.get_f32_le()?;
        __struct.pos_vert_ratio = buf.get_f32_le()?;
        __struct.mag_ratio = buf.get_f32_le()?;
        __struct.hagl_ratio = buf.get_f32_le()?;
        __struct.tas_ratio = buf.get_f32_le()?;
        __struct.pos_horiz_accuracy = buf.get_f32_le()?;
        __struct.pos_vert_accuracy = buf.get_f32_le()?;
        let tmp = buf.get_u16_le()?;
        __struct.flags =
            EstimatorStatusFlags::from_bits_retain(tmp as <EstimatorStatusFlags as Flags>::Bits);
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u64_le(self.time_usec);
        __tmp.put_f32_le(self.vel_ratio);
        __tmp.put_f32_le(self.pos_horiz_ratio);
        __tmp.put_f32_le(self.pos_vert_ratio);
        __tmp.put_f32_le(self.mag_ratio);
        __tmp.put_f32_le(self.hagl_ratio);
        __tmp.put_f32_le(self.tas_ratio);
        __tmp.put_f32_le(self.pos_horiz_accuracy);
        __tmp.put_f32_le(self.pos_vert_accuracy);
        __tmp.put_u16_le(self.flags.bits() as u16);
        if matches!(version, MavlinkVersion::V2) {
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Event message. Each new event from a particular component gets a new sequence number. The same message might be sent multiple times if (re-)requested. Most events are broadcast, some can be specific to a target component (as receivers keep track of the sequence for missed events, all events need to be broadcast. Thus we use destination_component instead of target_component)."]
#[doc = ""]
#[doc = "ID: 410"]
#[derive(Debug, Clone, PartialEq)]
pub struct EVENT_DATA {
    #[doc = "Event ID (as defined in the component metadata)"]
    pub id: u32,
    #[doc = "Timestamp (time since system boot when the event happened)."]
    pub event_time_boot_ms: u32,
    #[doc = "Sequence number."]
    pub sequence: u16,
    #[doc = "Component ID"]
    pub destination_component: u8,
    #[doc = "System ID"]
    pub destination_system: u8,
    #[doc = "Log levels: 4 bits MSB: internal (for logging purposes), 4 bits LSB: external. Levels: Emergency = 0, Alert = 1, Critical = 2, Error = 3, Warning = 4, Notice = 5, Info = 6, Debug = 7, Protocol = 8, Disabled = 9"]
    pub log_levels: u8,
    #[doc = "Arguments (depend on event ID)."]
    pub arguments: [u8; 40],
}
impl EVENT_DATA {
    pub const ENCODED_LEN: usize = 53usize;
    pub const DEFAULT: Self = Self {
        id: 0_u32,
        event_time_boot_ms: 0_u32,
        sequence: 0_u16,
        destination_component: 0_u8,
        destination_system: 0_u8,
        log_levels: 0_u8,
        arguments: [0_u8; 40usize],
    };
}
impl Default for EVENT_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for EVENT_DATA {
    type Message = MavMessage;
    const ID: u32 = 410u32;
    const NAME: &'static str = "EVENT";
    const EXTRA_CRC: u8 = 160u8;
    const ENCODED_LEN: usize = 53usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.id = buf.get_u32_le()?;
        __struct.event_time_boot_ms = buf.get_u32_le()?;
        __struct.sequence = buf.get_u16_le()?;
        __struct.destination_component = buf.get_u8()?;
        __struct.destination_system = buf.get_u8()?;
        __struct.log_levels = buf.get_u8()?;
        for v in &mut __struct.arguments {
            let val = buf.get_u8()?;
            *v = val;
        }
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u32_le(self.id);
        __tmp.put_u32_le(self.event_time_boot_ms);
        __tmp.put_u16_le(self.sequence);
        __tmp.put_u8(self.destination_component);
        __tmp.put_u8(self.destination_system);
        __tmp.put_u8(self.log_levels);
        for val in &self.arguments {
            __tmp.put_u8(*val);
        }
        if matches!(version, MavlinkVersion::V2) {
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Provides state for additional features."]
#[doc = ""]
#[doc = "ID: 245"]
#[derive(Debug, Clone, PartialEq)]
pub struct EXTENDED_SYS_STATE_DATA {
    #[doc = "The VTOL state if applicable. Is set to MAV_VTOL_STATE_UNDEFINED if UAV is not in VTOL configuration."]
    pub vtol_state: MavVtolState,
    #[doc = "The landed state. Is set to MAV_LANDED_STATE_UNDEFINED if landed state is unknown."]
    pub landed_state: MavLandedState,
}
impl EXTENDED_SYS_STATE_DATA {
    pub const ENCODED_LEN: usize = 2usize;
    pub const DEFAULT: Self =
        Self { vtol_state: MavVtolState::DEFAULT, landed_state: MavLandedState::DEFAULT };
}
impl Default for EXTENDED_SYS_STATE_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for EXTENDED_SYS_STATE_DATA {
    type Message = MavMessage;
    const ID: u32 = 245u32;
    const NAME: &'static str = "EXTENDED_SYS_STATE";
    const EXTRA_CRC: u8 = 130u8;
    const ENCODED_LEN: usize = 2usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        let tmp = buf.get_u8()?;
        __struct.vtol_state =
            FromPrimitive::from_u8(tmp).ok_or(::mavlink_core::error::ParserError::InvalidEnum {
                enum_type: "MavVtolState",
                value: tmp as u64,
            })?;
        let tmp = buf.get_u8()?;
        __struct.landed_state =
            FromPrimitive::from_u8(tmp).ok_or(::mavlink_core::error::ParserError::InvalidEnum {
                enum_type: "MavLandedState",
                value: tmp as u64,
            })?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u8(self.vtol_state as u8);
        __tmp.put_u8(self.landed_state as u8);
        if matches!(version, MavlinkVersion::V2) {
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "File transfer protocol message: <https://mavlink.io/en/services/ftp.html>."]
#[doc = ""]
#[doc = "ID: 110"]
#[derive(Debug, Clone, PartialEq)]
pub struct FILE_TRANSFER_PROTOCOL_DATA {
    #[doc = "Network ID (0 for broadcast)"]
    pub target_network: u8,
    #[doc = "System ID (0 for broadcast)"]
    pub target_system: u8,
    #[doc = "Component ID (0 for broadcast)"]
    pub target_component: u8,
    #[doc = "Variable length payload. The content/format of this block is defined in <https://mavlink.io/en/services/ftp.html>. The length is defined by the remaining message length when subtracting the header and other fields. See also MAV_FTP_OPCODE and MAV_FTP_ERR."]
    pub payload: [u8; 251],
}
impl FILE_TRANSFER_PROTOCOL_DATA {
    pub const ENCODED_LEN: usize = 254usize;
    pub const DEFAULT: Self = Self {
        target_network: 0_u8,
        target_system: 0_u8,
        target_component: 0_u8,
        payload: [0_u8; 251usize],
    };
}
impl Default for FILE_TRANSFER_PROTOCOL_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for FILE_TRANSFER_PROTOCOL_DATA {
    type Message = MavMessage;
    const ID: u32 = 110u32;
    const NAME: &'static str = "FILE_TRANSFER_PROTOCOL";
    const EXTRA_CRC: u8 = 84u8;
    const ENCODED_LEN: usize = 254usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.target_network = buf.get_u8()?;
        __struct.target_system = buf.get_u8()?;
        __struct.target_component = buf.get_u8()?;
        for v in &mut __struct.payload {
            let val = buf.get_u8()?;
            *v = val;
        }
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u8(self.target_network);
        __tmp.put_u8(self.target_system);
        __tmp.put_u8(self.target_component);
        for val in &self.payload {
            __tmp.put_u8(*val);
        }
        if matches!(version, MavlinkVersion::V2) {
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "The filtered global position (e.g. fused GPS and accelerometers). The position is in GPS-frame (right-handed, Z-up). It is designed as scaled integer message since the resolution of float is not sufficient."]
#[doc = ""]
#[doc = "ID: 33"]
#[derive(Debug, Clone, PartialEq)]
pub struct GLOBAL_POSITION_INT_DATA {
    #[doc = "Timestamp (time since system boot)."]
    pub time_boot_ms: u32,
    #[doc = "Latitude, expressed"]
    pub lat: i32,
    #[doc = "Longitude, expressed"]
    pub lon: i32,
    #[doc = "Altitude (MSL). Note that virtually all GPS modules provide both WGS84 and MSL."]
    pub alt: i32,
    #[doc = "Altitude above home"]
    pub relative_alt: i32,
    #[doc = "Ground X Speed (Latitude, positive north)"]
    pub vx: i16,
    #[doc = "Ground Y Speed (Longitude, positive east)"]
    pub vy: i16,
    #[doc = "Ground Z Speed (Altitude, positive down)"]
    pub vz: i16,
    #[doc = "Vehicle heading (yaw angle), 0.0..359.99 degrees. If unknown, set to: UINT16_MAX"]
    pub hdg: u16,
}
impl GLOBAL_POSITION_INT_DATA {
    pub const ENCODED_LEN: usize = 28usize;
    pub const DEFAULT: Self = Self {
        time_boot_ms: 0_u32,
        lat: 0_i32,
        lon: 0_i32,
        alt: 0_i32,
        relative_alt: 0_i32,
        vx: 0_i16,
        vy: 0_i16,
        vz: 0_i16,
        hdg: 0_u16,
    };
}
impl Default for GLOBAL_POSITION_INT_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for GLOBAL_POSITION_INT_DATA {
    type Message = MavMessage;
    const ID: u32 = 33u32;
    const NAME: &'static str = "GLOBAL_POSITION_INT";
    const EXTRA_CRC: u8 = 104u8;
    const ENCODED_LEN: usize = 28usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.time_boot_ms = buf.get_u32_le()?;
        __struct.lat = buf.get_i32_le()?;
        __struct.lon = buf.get_i32_le()?;
        __struct.alt = buf.get_i32_le()?;
        __struct.relative_alt = buf.get_i32_le()?;
        __struct.vx = buf.get_i16_le()?;
        __struct.vy = buf.get_i16_le()?;
        __struct.vz = buf.get_i16_le()?;
        __struct.hdg = buf.get_u16_le()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u32_le(self.time_boot_ms);
        __tmp.put_i32_le(self.lat);
        __tmp.put_i32_le(self.lon);
        __tmp.put_i32_le(self.alt);
        __tmp.put_i32_le(self.relative_alt);
        __tmp.put_i16_le(self.vx);
        __tmp.put_i16_le(self.vy);
        __tmp.put_i16_le(self.vz);
        __tmp.put_u16_le(self.hdg);
        if matches!(version, MavlinkVersion::V2) {
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Publishes the GPS coordinates of the vehicle local origin (0,0,0) position. Emitted whenever a new GPS-Local position mapping is requested or set - e.g. following SET_GPS_GLOBAL_ORIGIN message."]
#[doc = ""]
#[doc = "ID: 49"]
#[derive(Debug, Clone, PartialEq)]
pub struct GPS_GLOBAL_ORIGIN_DATA {
    #[doc = "Latitude (WGS84)"]
    pub latitude: i32,
    #[doc = "Longitude (WGS84)"]
    pub longitude: i32,
    #[doc = "Altitude (MSL). Positive for up."]
    pub altitude: i32,
    #[doc = "Timestamp (UNIX Epoch time or time since system boot). The receiving end can infer timestamp format (since 1.1.1970 or since system boot) by checking for the magnitude of the number."]
    pub time_usec: u64,
}
impl GPS_GLOBAL_ORIGIN_DATA {
    pub const ENCODED_LEN: usize = 20usize;
    pub const DEFAULT: Self =
        Self { latitude: 0_i32, longitude: 0_i32, altitude: 0_i32, time_usec: 0_u64 };
}
impl Default for GPS_GLOBAL_ORIGIN_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for GPS_GLOBAL_ORIGIN_DATA {
    type Message = MavMessage;
    const ID: u32 = 49u32;
    const NAME: &'static str = "GPS_GLOBAL_ORIGIN";
    const EXTRA_CRC: u8 = 39u8;
    const ENCODED_LEN: usize = 20usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.latitude = buf.get_i32_le()?;
        __struct.longitude = buf.get_i32_le()?;
        __struct.altitude = buf.get_i32_le()?;
        __struct.time_usec = buf.get_u64_le()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_i32_le(self.latitude);
        __tmp.put_i32_le(self.longitude);
        __tmp.put_i32_le(self.altitude);
        if matches!(version, MavlinkVersion::V2) {
            __tmp.put_u64_le(self.time_usec);
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "The global position, as returned by the Global Positioning System (GPS). This is                 NOT the global position estimate of the system, but rather a RAW sensor value. See message GLOBAL_POSITION_INT for the global position estimate."]
#[doc = ""]
#[doc = "ID: 24"]
#[derive(Debug, Clone, PartialEq)]
pub struct GPS_RAW_INT_DATA {
    #[doc = "Timestamp (UNIX Epoch time or time since system boot). The receiving end can infer timestamp format (since 1.1.1970 or since system boot) by checking for the magnitude of the number."]
    pub time_usec: u64,
    #[doc = "Latitude (WGS84, EGM96 ellipsoid)"]
    pub lat: i32,
    #[doc = "Longitude (WGS84, EGM96 ellipsoid)"]
    pub lon: i32,
    #[doc = "Altitude (MSL). Positive for up. Note that virtually all GPS modules provide the MSL altitude in addition to the WGS84 altitude."]
    pub alt: i32,
    #[doc = "GPS HDOP horizontal dilution of position (unitless * 100). If unknown, set to: UINT16_MAX"]
    pub eph: u16,
    #[doc = "GPS VDOP vertical dilution of position (unitless * 100). If unknown, set to: UINT16_MAX"]
    pub epv: u16,
    #[doc = "GPS ground speed. If unknown, set to: UINT16_MAX"]
    pub vel: u16,
    #[doc = "Course over ground (NOT heading, but direction of movement) in degrees * 100, 0.0..359.99 degrees. If unknown, set to: UINT16_MAX"]
    pub cog: u16,
    #[doc = "GPS fix type."]
    pub fix_type: GpsFixType,
    #[doc = "Number of satellites visible. If unknown, set to UINT8_MAX"]
    pub satellites_visible: u8,
    #[doc = "Altitude (above WGS84, EGM96 ellipsoid). Positive for up."]
    pub alt_ellipsoid: i32,
    #[doc = "Position uncertainty."]
    pub h_acc: u32,
    #[doc = "Altitude uncertainty."]
    pub v_acc: u32,
    #[doc = "Speed uncertainty."]
    pub vel_acc: u32,
    #[doc = "Heading / track uncertainty"]
    pub hdg_acc: u32,
    #[doc = "Yaw in earth frame from north. Use 0 if this GPS does not provide yaw. Use UINT16_MAX if this GPS is configured to provide yaw and is currently unable to provide it. Use 36000 for north."]
    pub yaw: u16,
}
impl GPS_RAW_INT_DATA {
    pub const ENCODED_LEN: usize = 52usize;
    pub const DEFAULT: Self = Self {
        time_usec: 0_u64,
        lat: 0_i32,
        lon: 0_i32,
        alt: 0_i32,
        eph: 0_u16,
        epv: 0_u16,
        vel: 0_u16,
        cog: 0_u16,
        fix_type: GpsFixType::DEFAULT,
        satellites_visible: 0_u8,
        alt_ellipsoid: 0_i32,
        h_acc: 0_u32,
        v_acc: 0_u32,
        vel_acc: 0_u32,
        hdg_acc: 0_u32,
        yaw: 0_u16,
    };
}
impl Default for GPS_RAW_INT_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for GPS_RAW_INT_DATA {
    type Message = MavMessage;
    const ID: u32 = 24u32;
    const NAME: &'static str = "GPS_RAW_INT";
    const EXTRA_CRC: u8 = 24u8;
    const ENCODED_LEN: usize = 52usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.time_usec = buf.get_u64_le()?;
        __struct.lat = buf.get_i32_le()?;
        __struct.lon = buf.get_i32_le()?;
        __struct.alt = buf.get_i32_le()?;
        __struct.eph = buf.get_u16_le()?;
        __struct.epv = buf.get_u16_le()?;
        __struct.vel = buf.get_u16_le()?;
        __struct.cog = buf.get_u16_le()?;
        let tmp = buf.get_u8()?;
        __struct.fix_type =
            FromPrimitive::from_u8(tmp).ok_or(::mavlink_core::error::ParserError::InvalidEnum {
                enum_type: "GpsFixType",
                value: tmp as u64,
            })?;
        __struct.satellites_visible = buf.get_u8()?;
        __struct.alt_ellipsoid = buf.get_i32_le()?;
        __struct.h_acc = buf.get_u32_le()?;
        __struct.v_acc = buf.get_u32_le()?;
        __struct.vel_acc = buf.get_u32_le()?;
        __struct.hdg_acc = buf.get_u32_le()?;
        __struct.yaw = buf.get_u16_le()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u64_le(self.time_usec);
        __tmp.put_i32_le(self.lat);
        __tmp.put_i32_le(self.lon);
        __tmp.put_i32_le(self.alt);
        __tmp.put_u16_le(self.eph);
        __tmp.put_u16_le(self.epv);
        __tmp.put_u16_le(self.vel);
        __tmp.put_u16_le(self.cog);
        __tmp.put_u8(self.fix_type as u8);
        __tmp.put_u8(self.satellites_visible);
        if matches!(version, MavlinkVersion::V2) {
            __tmp.put_i32_le(self.alt_ellipsoid);
            __tmp.put_u32_le(self.h_acc);
            __tmp.put_u32_le(self.v_acc);
            __tmp.put_u32_le(self.vel_acc);
            __tmp.put_u32_le(self.hdg_acc);
            __tmp.put_u16_le(self.yaw);
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "The heartbeat message shows that a system or component is present and responding. The type and autopilot fields (along with the message component id), allow the receiving system to treat further messages from this system appropriately (e.g. by laying out the user interface based on the autopilot). This microservice is documented at <https://mavlink.io/en/services/heartbeat.html>."]
#[doc = ""]
#[doc = "ID: 0"]
#[derive(Debug, Clone, PartialEq)]
pub struct HEARTBEAT_DATA {
    #[doc = "A bitfield for use for autopilot-specific flags"]
    pub custom_mode: u32,
    #[doc = "Vehicle or component type. For a flight controller component the vehicle type (quadrotor, helicopter, etc.). For other components the component type (e.g. camera, gimbal, etc.). This should be used in preference to component id for identifying the component type."]
    pub mavtype: u8,
    #[doc = "Autopilot type / class. Use MAV_AUTOPILOT_INVALID for components that are not flight controllers."]
    pub autopilot: u8,
    #[doc = "System mode bitmap."]
    pub base_mode: MavModeFlag,
    #[doc = "System status flag."]
    pub system_status: u8,
    #[doc = "MAVLink version, not writable by user, gets added by protocol because of magic data type: uint8_t_mavlink_version"]
    pub mavlink_version: u8,
}
impl HEARTBEAT_DATA {
    pub const ENCODED_LEN: usize = 9usize;
    pub const DEFAULT: Self = Self {
        custom_mode: 0_u32,
        mavtype: 0_u8,
        autopilot: 0_u8,
        base_mode: MavModeFlag::DEFAULT,
        system_status: 0_u8,
        mavlink_version: MINOR_MAVLINK_VERSION,
    };
}
impl Default for HEARTBEAT_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for HEARTBEAT_DATA {
    type Message = MavMessage;
    const ID: u32 = 0u32;
    const NAME: &'static str = "HEARTBEAT";
    const EXTRA_CRC: u8 = 50u8;
    const ENCODED_LEN: usize = 9usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.custom_mode = buf.get_u32_le()?;
        __struct.mavtype = buf.get_u8()?;
        __struct.autopilot = buf.get_u8()?;
        let tmp = buf.get_u8()?;
        __struct.base_mode = MavModeFlag::from_bits_retain(tmp as <MavModeFlag as Flags>::Bits);
        __struct.system_status = buf.get_u8()?;
        __struct.mavlink_version = buf.get_u8()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u32_le(self.custom_mode);
        __tmp.put_u8(self.mavtype);
        __tmp.put_u8(self.autopilot);
        __tmp.put_u8(self.base_mode.bits() as u8);
        __tmp.put_u8(self.system_status);
        __tmp.put_u8(self.mavlink_version);
        if matches!(version, MavlinkVersion::V2) {
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Contains the home position.         The home position is the default position that the system will return to and land on.         The position must be set automatically by the system during the takeoff, and may also be explicitly set using MAV_CMD_DO_SET_HOME.         The global and local positions encode the position in the respective coordinate frames, while the q parameter encodes the orientation of the surface.         Under normal conditions it describes the heading and terrain slope, which can be used by the aircraft to adjust the approach.         The approach 3D vector describes the point to which the system should fly in normal flight mode and then perform a landing sequence along the vector.         Note: this message can be requested by sending the MAV_CMD_REQUEST_MESSAGE with param1=242."]
#[doc = ""]
#[doc = "ID: 242"]
#[derive(Debug, Clone, PartialEq)]
pub struct HOME_POSITION_DATA {
    #[doc = "Latitude (WGS84)"]
    pub latitude: i32,
    #[doc = "Longitude (WGS84)"]
    pub longitude: i32,
    #[doc = "Altitude (MSL). Positive for up."]
    pub altitude: i32,
    #[doc = "Local X position of this position in the local coordinate frame (NED)"]
    pub x: f32,
    #[doc = "Local Y position of this position in the local coordinate frame (NED)"]
    pub y: f32,
    #[doc = "Local Z position of this position in the local coordinate frame (NED: positive \"down\")"]
    pub z: f32,
    #[doc = "Quaternion indicating world-to-surface-normal and heading transformation of the takeoff position.         Used to indicate the heading and slope of the ground.         All fields should be set to NaN if an accurate quaternion for both heading and surface slope cannot be supplied."]
    pub q: [f32; 4],
    #[doc = "Local X position of the end of the approach vector. Multicopters should set this position based on their takeoff path. Grass-landing fixed wing aircraft should set it the same way as multicopters. Runway-landing fixed wing aircraft should set it to the opposite direction of the takeoff, assuming the takeoff happened from the threshold / touchdown zone."]
    pub approach_x: f32,
    #[doc = "Local Y position of the end of the approach vector. Multicopters should set this position based on their takeoff path. Grass-landing fixed wing aircraft should set it the same way as multicopters. Runway-landing fixed wing aircraft should set it to the opposite direction of the takeoff, assuming the takeoff happened from the threshold / touchdown zone."]
    pub approach_y: f32,
    #[doc = "Local Z position of the end of the approach vector. Multicopters should set this position based on their takeoff path. Grass-landing fixed wing aircraft should set it the same way as multicopters. Runway-landing fixed wing aircraft should set it to the opposite direction of the takeoff, assuming the takeoff happened from the threshold / touchdown zone."]
    pub approach_z: f32,
    #[doc = "Timestamp (UNIX Epoch time or time since system boot). The receiving end can infer timestamp format (since 1.1.1970 or since system boot) by checking for the magnitude of the number."]
    pub time_usec: u64,
}
impl HOME_POSITION_DATA {
    pub const ENCODED_LEN: usize = 60usize;
    pub const DEFAULT: Self = Self {
        latitude: 0_i32,
        longitude: 0_i32,
        altitude: 0_i32,
        x: 0.0_f32,
        y: 0.0_f32,
        z: 0.0_f32,
        q: [0.0_f32; 4usize],
        approach_x: 0.0_f32,
        approach_y: 0.0_f32,
        approach_z: 0.0_f32,
        time_usec: 0_u64,
    };
}
impl Default for HOME_POSITION_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for HOME_POSITION_DATA {
    type Message = MavMessage;
    const ID: u32 = 242u32;
    const NAME: &'static str = "HOME_POSITION";
    const EXTRA_CRC: u8 = 104u8;
    const ENCODED_LEN: usize = 60usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.latitude = buf.get_i32_le()?;
        __struct.longitude = buf.get_i32_le()?;
        __struct.altitude = buf.get_i32_le()?;
        __struct.x = buf.get_f32_le()?;
        __struct.y = buf.get_f32_le()?;
        __struct.z = buf.get_f32_le()?;
        for v in &mut __struct.q {
            let val = buf.get_f32_le()?;
            *v = val;
        }
        __struct.approach_x = buf.get_f32_le()?;
        __struct.approach_y = buf.get_f32_le()?;
        __struct.approach_z = buf.get_f32_le()?;
        __struct.time_usec = buf.get_u64_le()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_i32_le(self.latitude);
        __tmp.put_i32_le(self.longitude);
        __tmp.put_i32_le(self.altitude);
        __tmp.put_f32_le(self.x);
        __tmp.put_f32_le(self.y);
        __tmp.put_f32_le(self.z);
        for val in &self.q {
            __tmp.put_f32_le(*val);
        }
        __tmp.put_f32_le(self.approach_x);
        __tmp.put_f32_le(self.approach_y);
        __tmp.put_f32_le(self.approach_z);
        if matches!(version, MavlinkVersion::V2) {
            __tmp.put_u64_le(self.time_usec);
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "The filtered local position (e.g. fused computer vision and accelerometers). Coordinate frame is right-handed, Z-axis down (aeronautical frame, NED / north-east-down convention)."]
#[doc = ""]
#[doc = "ID: 32"]
#[derive(Debug, Clone, PartialEq)]
pub struct LOCAL_POSITION_NED_DATA {
    #[doc = "Timestamp (time since system boot)."]
    pub time_boot_ms: u32,
    #[doc = "X Position"]
    pub x: f32,
    #[doc = "Y Position"]
    pub y: f32,
    #[doc = "Z Position"]
    pub z: f32,
    #[doc = "X Speed"]
    pub vx: f32,
    #[doc = "Y Speed"]
    pub vy: f32,
    #[doc = "Z Speed"]
    pub vz: f32,
}
impl LOCAL_POSITION_NED_DATA {
    pub const ENCODED_LEN: usize = 28usize;
    pub const DEFAULT: Self = Self {
        time_boot_ms: 0_u32,
        x: 0.0_f32,
        y: 0.0_f32,
        z: 0.0_f32,
        vx: 0.0_f32,
        vy: 0.0_f32,
        vz: 0.0_f32,
    };
}
impl Default for LOCAL_POSITION_NED_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for LOCAL_POSITION_NED_DATA {
    type Message = MavMessage;
    const ID: u32 = 32u32;
    const NAME: &'static str = "LOCAL_POSITION_NED";
    const EXTRA_CRC: u8 = 185u8;
    const ENCODED_LEN: usize = 28usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.time_boot_ms = buf.get_u32_le()?;
        __struct.x = buf.get_f32_le()?;
        __struct.y = buf.get_f32_le()?;
        __struct.z = buf.get_f32_le()?;
        __struct.vx = buf.get_f32_le()?;
        __struct.vy = buf.get_f32_le()?;
        __struct.vz = buf.get_f32_le()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u32_le(self.time_boot_ms);
        __tmp.put_f32_le(self.x);
        __tmp.put_f32_le(self.y);
        __tmp.put_f32_le(self.z);
        __tmp.put_f32_le(self.vx);
        __tmp.put_f32_le(self.vy);
        __tmp.put_f32_le(self.vz);
        if matches!(version, MavlinkVersion::V2) {
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Manual (joystick) control message.         This message represents movement axes and button using standard joystick axes nomenclature. Unused axes can be disabled and buttons states are transmitted as individual on/off bits of a bitmask. For more information see <https://mavlink.io/en/services/manual_control.html>."]
#[doc = ""]
#[doc = "ID: 69"]
#[derive(Debug, Clone, PartialEq)]
pub struct MANUAL_CONTROL_DATA {
    #[doc = "X-axis, normalized to the range [-1000,1000]. A value of INT16_MAX indicates that this axis is invalid. Generally corresponds to forward(1000)-backward(-1000) movement on a joystick and the pitch of a vehicle."]
    pub x: i16,
    #[doc = "Y-axis, normalized to the range [-1000,1000]. A value of INT16_MAX indicates that this axis is invalid. Generally corresponds to left(-1000)-right(1000) movement on a joystick and the roll of a vehicle."]
    pub y: i16,
    #[doc = "Z-axis, normalized to the range [-1000,1000]. A value of INT16_MAX indicates that this axis is invalid. Generally corresponds to a separate slider movement with maximum being 1000 and minimum being -1000 on a joystick and the thrust of a vehicle. Positive values are positive thrust, negative values are negative thrust."]
    pub z: i16,
    #[doc = "R-axis, normalized to the range [-1000,1000]. A value of INT16_MAX indicates that this axis is invalid. Generally corresponds to a twisting of the joystick, with clockwise being 1000 and counter-clockwise being -1000, and the yaw of a vehicle."]
    pub r: i16,
    #[doc = "A bitfield corresponding to the joystick buttons' 0-15 current state, 1 for pressed, 0 for released. The lowest bit corresponds to Button 1."]
    pub buttons: u16,
    #[doc = "The system to be controlled."]
    pub target: u8,
    #[doc = "A bitfield corresponding to the joystick buttons' 16-31 current state, 1 for pressed, 0 for released. The lowest bit corresponds to Button 16."]
    pub buttons2: u16,
    #[doc = "Set bits to 1 to indicate which of the following extension fields contain valid data: bit 0: pitch, bit 1: roll, bit 2: aux1, bit 3: aux2, bit 4: aux3, bit 5: aux4, bit 6: aux5, bit 7: aux6"]
    pub enabled_extensions: u8,
    #[doc = "Pitch-only-axis, normalized to the range [-1000,1000]. Generally corresponds to pitch on vehicles with additional degrees of freedom. Valid if bit 0 of enabled_extensions field is set. Set to 0 if invalid."]
    pub s: i16,
    #[doc = "Roll-only-axis, normalized to the range [-1000,1000]. Generally corresponds to roll on vehicles with additional degrees of freedom. Valid if bit 1 of enabled_extensions field is set. Set to 0 if invalid."]
    pub t: i16,
    #[doc = "Aux continuous input field 1. Normalized in the range [-1000,1000]. Purpose defined by recipient. Valid data if bit 2 of enabled_extensions field is set. 0 if bit 2 is unset."]
    pub aux1: i16,
    #[doc = "Aux continuous input field 2. Normalized in the range [-1000,1000]. Purpose defined by recipient. Valid data if bit 3 of enabled_extensions field is set. 0 if bit 3 is unset."]
    pub aux2: i16,
    #[doc = "Aux continuous input field 3. Normalized in the range [-1000,1000]. Purpose defined by recipient. Valid data if bit 4 of enabled_extensions field is set. 0 if bit 4 is unset."]
    pub aux3: i16,
    #[doc = "Aux continuous input field 4. Normalized in the range [-1000,1000]. Purpose defined by recipient. Valid data if bit 5 of enabled_extensions field is set. 0 if bit 5 is unset."]
    pub aux4: i16,
    #[doc = "Aux continuous input field 5. Normalized in the range [-1000,1000]. Purpose defined by recipient. Valid data if bit 6 of enabled_extensions field is set. 0 if bit 6 is unset."]
    pub aux5: i16,
    #[doc = "Aux continuous input field 6. Normalized in the range [-1000,1000]. Purpose defined by recipient. Valid data if bit 7 of enabled_extensions field is set. 0 if bit 7 is unset."]
    pub aux6: i16,
}
impl MANUAL_CONTROL_DATA {
    pub const ENCODED_LEN: usize = 30usize;
    pub const DEFAULT: Self = Self {
        x: 0_i16,
        y: 0_i16,
        z: 0_i16,
        r: 0_i16,
        buttons: 0_u16,
        target: 0_u8,
        buttons2: 0_u16,
        enabled_extensions: 0_u8,
        s: 0_i16,
        t: 0_i16,
        aux1: 0_i16,
        aux2: 0_i16,
        aux3: 0_i16,
        aux4: 0_i16,
        aux5: 0_i16,
        aux6: 0_i16,
    };
}
impl Default for MANUAL_CONTROL_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for MANUAL_CONTROL_DATA {
    type Message = MavMessage;
    const ID: u32 = 69u32;
    const NAME: &'static str = "MANUAL_CONTROL";
    const EXTRA_CRC: u8 = 243u8;
    const ENCODED_LEN: usize = 30usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.x = buf.get_i16_le()?;
        __struct.y = buf.get_i16_le()?;
        __struct.z = buf.get_i16_le()?;
        __struct.r = buf.get_i16_le()?;
        __struct.buttons = buf.get_u16_le()?;
        __struct.target = buf.get_u8()?;
        __struct.buttons2 = buf.get_u16_le()?;
        __struct.enabled_extensions = buf.get_u8()?;
        __struct.s = buf.get_i16_le()?;
        __struct.t = buf.get_i16_le()?;
        __struct.aux1 = buf.get_i16_le()?;
        __struct.aux2 = buf.get_i16_le()?;
        __struct.aux3 = buf.get_i16_le()?;
        __struct.aux4 = buf.get_i16_le()?;
        __struct.aux5 = buf.get_i16_le()?;
        __struct.aux6 = buf.get_i16_le()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_i16_le(self.x);
        __tmp.put_i16_le(self.y);
        __tmp.put_i16_le(self.z);
        __tmp.put_i16_le(self.r);
        __tmp.put_u16_le(self.buttons);
        __tmp.put_u8(self.target);
        if matches!(version, MavlinkVersion::V2) {
            __tmp.put_u16_le(self.buttons2);
            __tmp.put_u8(self.enabled_extensions);
            __tmp.put_i16_le(self.s);
            __tmp.put_i16_le(self.t);
            __tmp.put_i16_le(self.aux1);
            __tmp.put_i16_le(self.aux2);
            __tmp.put_i16_le(self.aux3);
            __tmp.put_i16_le(self.aux4);
            __tmp.put_i16_le(self.aux5);
            __tmp.put_i16_le(self.aux6);
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "The interval between messages for a particular MAVLink message ID.         This message is sent in response to the MAV_CMD_REQUEST_MESSAGE command with param1=244 (this message) and param2=message_id (the id of the message for which the interval is required).         This interface replaces DATA_STREAM."]
#[doc = ""]
#[doc = "ID: 244"]
#[derive(Debug, Clone, PartialEq)]
pub struct MESSAGE_INTERVAL_DATA {
    #[doc = "The interval between two messages. A value of -1 indicates this stream is disabled, 0 indicates it is not available,>0 indicates the interval at which it is sent."]
    pub interval_us: i32,
    #[doc = "The ID of the requested MAVLink message. v1.0 is limited to 254 messages."]
    pub message_id: u16,
}
impl MESSAGE_INTERVAL_DATA {
    pub const ENCODED_LEN: usize = 6usize;
    pub const DEFAULT: Self = Self { interval_us: 0_i32, message_id: 0_u16 };
}
impl Default for MESSAGE_INTERVAL_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for MESSAGE_INTERVAL_DATA {
    type Message = MavMessage;
    const ID: u32 = 244u32;
    const NAME: &'static str = "MESSAGE_INTERVAL";
    const EXTRA_CRC: u8 = 95u8;
    const ENCODED_LEN: usize = 6usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.interval_us = buf.get_i32_le()?;
        __struct.message_id = buf.get_u16_le()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_i32_le(self.interval_us);
        __tmp.put_u16_le(self.message_id);
        if matches!(version, MavlinkVersion::V2) {
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Acknowledgment message during waypoint handling. The type field states if this message is a positive ack (type=0) or if an error happened (type=non-zero)."]
#[doc = ""]
#[doc = "ID: 47"]
#[derive(Debug, Clone, PartialEq)]
pub struct MISSION_ACK_DATA {
    #[doc = "System ID"]
    pub target_system: u8,
    #[doc = "Component ID"]
    pub target_component: u8,
    #[doc = "Mission result."]
    pub mavtype: u8,
    #[doc = "Mission type."]
    pub mission_type: u8,
    #[doc = "Id of new on-vehicle mission, fence, or rally point plan (on upload to vehicle).         The id is calculated and returned by a vehicle when a new plan is uploaded by a GCS.         The only requirement on the id is that it must change when there is any change to the on-vehicle plan type (there is no requirement that the id be globally unique).         0 on download from the vehicle to the GCS (on download the ID is set in MISSION_COUNT).         0 if plan ids are not supported.         The current on-vehicle plan ids are streamed in `MISSION_CURRENT`, allowing a GCS to determine if any part of the plan has changed and needs to be re-uploaded."]
    pub opaque_id: u32,
}
impl MISSION_ACK_DATA {
    pub const ENCODED_LEN: usize = 8usize;
    pub const DEFAULT: Self = Self {
        target_system: 0_u8,
        target_component: 0_u8,
        mavtype: 0_u8,
        mission_type: 0_u8,
        opaque_id: 0_u32,
    };
}
impl Default for MISSION_ACK_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for MISSION_ACK_DATA {
    type Message = MavMessage;
    const ID: u32 = 47u32;
    const NAME: &'static str = "MISSION_ACK";
    const EXTRA_CRC: u8 = 153u8;
    const ENCODED_LEN: usize = 8usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.target_system = buf.get_u8()?;
        __struct.target_component = buf.get_u8()?;
        __struct.mavtype = buf.get_u8()?;
        __struct.mission_type = buf.get_u8()?;
        __struct.opaque_id = buf.get_u32_le()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u8(self.target_system);
        __tmp.put_u8(self.target_component);
        __tmp.put_u8(self.mavtype);
        if matches!(version, MavlinkVersion::V2) {
            __tmp.put_u8(self.mission_type);
            __tmp.put_u32_le(self.opaque_id);
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Delete all mission items at once."]
#[doc = ""]
#[doc = "ID: 45"]
#[derive(Debug, Clone, PartialEq)]
pub struct MISSION_CLEAR_ALL_DATA {
    #[doc = "System ID"]
    pub target_system: u8,
    #[doc = "Component ID"]
    pub target_component: u8,
    #[doc = "Mission type."]
    pub mission_type: u8,
}
impl MISSION_CLEAR_ALL_DATA {
    pub const ENCODED_LEN: usize = 3usize;
    pub const DEFAULT: Self =
        Self { target_system: 0_u8, target_component: 0_u8, mission_type: 0_u8 };
}
impl Default for MISSION_CLEAR_ALL_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for MISSION_CLEAR_ALL_DATA {
    type Message = MavMessage;
    const ID: u32 = 45u32;
    const NAME: &'static str = "MISSION_CLEAR_ALL";
    const EXTRA_CRC: u8 = 232u8;
    const ENCODED_LEN: usize = 3usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.target_system = buf.get_u8()?;
        __struct.target_component = buf.get_u8()?;
        __struct.mission_type = buf.get_u8()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u8(self.target_system);
        __tmp.put_u8(self.target_component);
        if matches!(version, MavlinkVersion::V2) {
            __tmp.put_u8(self.mission_type);
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "This message is emitted as response to MISSION_REQUEST_LIST by the MAV and to initiate a write transaction. The GCS can then request the individual mission item based on the knowledge of the total number of waypoints."]
#[doc = ""]
#[doc = "ID: 44"]
#[derive(Debug, Clone, PartialEq)]
pub struct MISSION_COUNT_DATA {
    #[doc = "Number of mission items in the sequence"]
    pub count: u16,
    #[doc = "System ID"]
    pub target_system: u8,
    #[doc = "Component ID"]
    pub target_component: u8,
    #[doc = "Mission type."]
    pub mission_type: u8,
    #[doc = "Id of current on-vehicle mission, fence, or rally point plan (on download from vehicle).         This field is used when downloading a plan from a vehicle to a GCS.         0 on upload to the vehicle from GCS.         0 if plan ids are not supported.         The current on-vehicle plan ids are streamed in `MISSION_CURRENT`, allowing a GCS to determine if any part of the plan has changed and needs to be re-uploaded.         The ids are recalculated by the vehicle when any part of the on-vehicle plan changes (when a new plan is uploaded, the vehicle returns the new id to the GCS in MISSION_ACK)."]
    pub opaque_id: u32,
}
impl MISSION_COUNT_DATA {
    pub const ENCODED_LEN: usize = 9usize;
    pub const DEFAULT: Self = Self {
        count: 0_u16,
        target_system: 0_u8,
        target_component: 0_u8,
        mission_type: 0_u8,
        opaque_id: 0_u32,
    };
}
impl Default for MISSION_COUNT_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for MISSION_COUNT_DATA {
    type Message = MavMessage;
    const ID: u32 = 44u32;
    const NAME: &'static str = "MISSION_COUNT";
    const EXTRA_CRC: u8 = 221u8;
    const ENCODED_LEN: usize = 9usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.count = buf.get_u16_le()?;
        __struct.target_system = buf.get_u8()?;
        __struct.target_component = buf.get_u8()?;
        __struct.mission_type = buf.get_u8()?;
        __struct.opaque_id = buf.get_u32_le()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u16_le(self.count);
        __tmp.put_u8(self.target_system);
        __tmp.put_u8(self.target_component);
        if matches!(version, MavlinkVersion::V2) {
            __tmp.put_u8(self.mission_type);
            __tmp.put_u32_le(self.opaque_id);
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Message that announces the sequence number of the current target mission item (that the system will fly towards/execute when the mission is running).         This message should be streamed all the time (nominally at 1Hz).         This message should be emitted following a call to MAV_CMD_DO_SET_MISSION_CURRENT or MISSION_SET_CURRENT."]
#[doc = ""]
#[doc = "ID: 42"]
#[derive(Debug, Clone, PartialEq)]
pub struct MISSION_CURRENT_DATA {
    #[doc = "Sequence"]
    pub seq: u16,
    #[doc = "Total number of mission items on vehicle (on last item, sequence == total). If the autopilot stores its home location as part of the mission this will be excluded from the total. 0: Not supported, UINT16_MAX if no mission is present on the vehicle."]
    pub total: u16,
    #[doc = "Mission state machine state. MISSION_STATE_UNKNOWN if state reporting not supported."]
    pub mission_state: MissionState,
    #[doc = "Vehicle is in a mode that can execute mission items or suspended. 0: Unknown, 1: In mission mode, 2: Suspended (not in mission mode)."]
    pub mission_mode: u8,
    #[doc = "Id of current on-vehicle mission plan, or 0 if IDs are not supported or there is no mission loaded. GCS can use this to track changes to the mission plan type. The same value is returned on mission upload (in the MISSION_ACK)."]
    pub mission_id: u32,
    #[doc = "Id of current on-vehicle fence plan, or 0 if IDs are not supported or there is no fence loaded. GCS can use this to track changes to the fence plan type. The same value is returned on fence upload (in the MISSION_ACK)."]
    pub fence_id: u32,
    #[doc = "Id of current on-vehicle rally point plan, or 0 if IDs are not supported or there are no rally points loaded. GCS can use this to track changes to the rally point plan type. The same value is returned on rally point upload (in the MISSION_ACK)."]
    pub rally_points_id: u32,
}
impl MISSION_CURRENT_DATA {
    pub const ENCODED_LEN: usize = 18usize;
    pub const DEFAULT: Self = Self {
        seq: 0_u16,
        total: 0_u16,
        mission_state: MissionState::DEFAULT,
        mission_mode: 0_u8,
        mission_id: 0_u32,
        fence_id: 0_u32,
        rally_points_id: 0_u32,
    };
}
impl Default for MISSION_CURRENT_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for MISSION_CURRENT_DATA {
    type Message = MavMessage;
    const ID: u32 = 42u32;
    const NAME: &'static str = "MISSION_CURRENT";
    const EXTRA_CRC: u8 = 28u8;
    const ENCODED_LEN: usize = 18usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.seq = buf.get_u16_le()?;
        __struct.total = buf.get_u16_le()?;
        let tmp = buf.get_u8()?;
        __struct.mission_state =
            FromPrimitive::from_u8(tmp).ok_or(::mavlink_core::error::ParserError::InvalidEnum {
                enum_type: "MissionState",
                value: tmp as u64,
            })?;
        __struct.mission_mode = buf.get_u8()?;
        __struct.mission_id = buf.get_u32_le()?;
        __struct.fence_id = buf.get_u32_le()?;
        __struct.rally_points_id = buf.get_u32_le()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u16_le(self.seq);
        if matches!(version, MavlinkVersion::V2) {
            __tmp.put_u16_le(self.total);
            __tmp.put_u8(self.mission_state as u8);
            __tmp.put_u8(self.mission_mode);
            __tmp.put_u32_le(self.mission_id);
            __tmp.put_u32_le(self.fence_id);
            __tmp.put_u32_le(self.rally_points_id);
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[deprecated = " See `MISSION_ITEM_INT` (Deprecated since 2020-06)"]
#[doc = "Message encoding a mission item.         This message is emitted to announce the presence of a mission item and to set a mission item on the system.         The mission item can be either in x, y, z meters (type: LOCAL) or x:lat, y:lon, z:altitude. Local frame is Z-down, right handed (NED), global frame is Z-up, right handed (ENU). NaN may be used to indicate an optional/default value (e.g. to use the system's current latitude or yaw rather than a specific value). See also <https://mavlink.io/en/services/mission.html>."]
#[doc = ""]
#[doc = "ID: 39"]
#[derive(Debug, Clone, PartialEq)]
pub struct MISSION_ITEM_DATA {
    #[doc = "PARAM1, see MAV_CMD enum"]
    pub param1: f32,
    #[doc = "PARAM2, see MAV_CMD enum"]
    pub param2: f32,
    #[doc = "PARAM3, see MAV_CMD enum"]
    pub param3: f32,
    #[doc = "PARAM4, see MAV_CMD enum"]
    pub param4: f32,
    #[doc = "PARAM5 / local: X coordinate, global: latitude"]
    pub x: f32,
    #[doc = "PARAM6 / local: Y coordinate, global: longitude"]
    pub y: f32,
    #[doc = "PARAM7 / local: Z coordinate, global: altitude (relative or absolute, depending on frame)."]
    pub z: f32,
    #[doc = "Sequence"]
    pub seq: u16,
    #[doc = "The scheduled action for the waypoint."]
    pub command: u16,
    #[doc = "System ID"]
    pub target_system: u8,
    #[doc = "Component ID"]
    pub target_component: u8,
    #[doc = "The coordinate system of the waypoint."]
    pub frame: u8,
    #[doc = "false:0, true:1"]
    pub current: u8,
    #[doc = "Autocontinue to next waypoint. 0: false, 1: true. Set false to pause mission after the item completes."]
    pub autocontinue: u8,
    #[doc = "Mission type."]
    pub mission_type: u8,
}
impl MISSION_ITEM_DATA {
    pub const ENCODED_LEN: usize = 38usize;
    pub const DEFAULT: Self = Self {
        param1: 0.0_f32,
        param2: 0.0_f32,
        param3: 0.0_f32,
        param4: 0.0_f32,
        x: 0.0_f32,
        y: 0.0_f32,
        z: 0.0_f32,
        seq: 0_u16,
        command: 0_u16,
        target_system: 0_u8,
        target_component: 0_u8,
        frame: 0_u8,
        current: 0_u8,
        autocontinue: 0_u8,
        mission_type: 0_u8,
    };
}
impl Default for MISSION_ITEM_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for MISSION_ITEM_DATA {
    type Message = MavMessage;
    const ID: u32 = 39u32;
    const NAME: &'static str = "MISSION_ITEM";
    const EXTRA_CRC: u8 = 254u8;
    const ENCODED_LEN: usize = 38usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.param1 = buf.get_f32_le()?;
        __struct.param2 = buf.get_f32_le()?;
        __struct.param3 = buf.get_f32_le()?;
        __struct.param4 = buf.get_f32_le()?;
        __struct.x = buf.get_f32_le()?;
        __struct.y = buf.get_f32_le()?;
        __struct.z = buf.get_f32_le()?;
        __struct.seq = buf.get_u16_le()?;
        __struct.command = buf.get_u16_le()?;
        __struct.target_system = buf.get_u8()?;
        __struct.target_component = buf.get_u8()?;
        __struct.frame = buf.get_u8()?;
        __struct.current = buf.get_u8()?;
        __struct.autocontinue = buf.get_u8()?;
        __struct.mission_type = buf.get_u8()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_f32_le(self.param1);
        __tmp.put_f32_le(self.param2);
        __tmp.put_f32_le(self.param3);
        __tmp.put_f32_le(self.param4);
        __tmp.put_f32_le(self.x);
        __tmp.put_f32_le(self.y);
        __tmp.put_f32_le(self.z);
        __tmp.put_u16_le(self.seq);
        __tmp.put_u16_le(self.command);
        __tmp.put_u8(self.target_system);
        __tmp.put_u8(self.target_component);
        __tmp.put_u8(self.frame);
        __tmp.put_u8(self.current);
        __tmp.put_u8(self.autocontinue);
        if matches!(version, MavlinkVersion::V2) {
            __tmp.put_u8(self.mission_type);
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Message encoding a mission item. This message is emitted to announce                 the presence of a mission item and to set a mission item on the system. The mission item can be either in x, y, z meters (type: LOCAL) or x:lat, y:lon, z:altitude. Local frame is Z-down, right handed (NED), global frame is Z-up, right handed (ENU). NaN or INT32_MAX may be used in float/integer params (respectively) to indicate optional/default values (e.g. to use the component's current latitude, yaw rather than a specific value). See also <https://mavlink.io/en/services/mission.html>."]
#[doc = ""]
#[doc = "ID: 73"]
#[derive(Debug, Clone, PartialEq)]
pub struct MISSION_ITEM_INT_DATA {
    #[doc = "PARAM1, see MAV_CMD enum"]
    pub param1: f32,
    #[doc = "PARAM2, see MAV_CMD enum"]
    pub param2: f32,
    #[doc = "PARAM3, see MAV_CMD enum"]
    pub param3: f32,
    #[doc = "PARAM4, see MAV_CMD enum"]
    pub param4: f32,
    #[doc = "PARAM5 / local: x position in meters * 1e4, global: latitude in degrees * 10^7"]
    pub x: i32,
    #[doc = "PARAM6 / y position: local: x position in meters * 1e4, global: longitude in degrees *10^7"]
    pub y: i32,
    #[doc = "PARAM7 / z position: global: altitude in meters (relative or absolute, depending on frame."]
    pub z: f32,
    #[doc = "Waypoint ID (sequence number). Starts at zero. Increases monotonically for each waypoint, no gaps in the sequence (0,1,2,3,4)."]
    pub seq: u16,
    #[doc = "The scheduled action for the waypoint."]
    pub command: u16,
    #[doc = "System ID"]
    pub target_system: u8,
    #[doc = "Component ID"]
    pub target_component: u8,
    #[doc = "The coordinate system of the waypoint."]
    pub frame: u8,
    #[doc = "false:0, true:1"]
    pub current: u8,
    #[doc = "Autocontinue to next waypoint. 0: false, 1: true. Set false to pause mission after the item completes."]
    pub autocontinue: u8,
    #[doc = "Mission type."]
    pub mission_type: u8,
}
impl MISSION_ITEM_INT_DATA {
    pub const ENCODED_LEN: usize = 38usize;
    pub const DEFAULT: Self = Self {
        param1: 0.0_f32,
        param2: 0.0_f32,
        param3: 0.0_f32,
        param4: 0.0_f32,
        x: 0_i32,
        y: 0_i32,
        z: 0.0_f32,
        seq: 0_u16,
        command: 0_u16,
        target_system: 0_u8,
        target_component: 0_u8,
        frame: 0_u8,
        current: 0_u8,
        autocontinue: 0_u8,
        mission_type: 0_u8,
    };
}
impl Default for MISSION_ITEM_INT_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for MISSION_ITEM_INT_DATA {
    type Message = MavMessage;
    const ID: u32 = 73u32;
    const NAME: &'static str = "MISSION_ITEM_INT";
    const EXTRA_CRC: u8 = 38u8;
    const ENCODED_LEN: usize = 38usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.param1 = buf.get_f32_le()?;
        __struct.param2 = buf.get_f32_le()?;
        __struct.param3 = buf.get_f32_le()?;
        __struct.param4 = buf.get_f32_le()?;
        __struct.x = buf.get_i32_le()?;
        __struct.y = buf.get_i32_le()?;
        __struct.z = buf.get_f32_le()?;
        __struct.seq = buf.get_u16_le()?;
        __struct.command = buf.get_u16_le()?;
        __struct.target_system = buf.get_u8()?;
        __struct.target_component = buf.get_u8()?;
        __struct.frame = buf.get_u8()?;
        __struct.current = buf.get_u8()?;
        __struct.autocontinue = buf.get_u8()?;
        __struct.mission_type = buf.get_u8()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_f32_le(self.param1);
        __tmp.put_f32_le(self.param2);
        __tmp.put_f32_le(self.param3);
        __tmp.put_f32_le(self.param4);
        __tmp.put_i32_le(self.x);
        __tmp.put_i32_le(self.y);
        __tmp.put_f32_le(self.z);
        __tmp.put_u16_le(self.seq);
        __tmp.put_u16_le(self.command);
        __tmp.put_u8(self.target_system);
        __tmp.put_u8(self.target_component);
        __tmp.put_u8(self.frame);
        __tmp.put_u8(self.current);
        __tmp.put_u8(self.autocontinue);
        if matches!(version, MavlinkVersion::V2) {
            __tmp.put_u8(self.mission_type);
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "A certain mission item has been reached. The system will either hold this position (or circle on the orbit) or (if the autocontinue on the WP was set) continue to the next waypoint."]
#[doc = ""]
#[doc = "ID: 46"]
#[derive(Debug, Clone, PartialEq)]
pub struct MISSION_ITEM_REACHED_DATA {
    #[doc = "Sequence"]
    pub seq: u16,
}
impl MISSION_ITEM_REACHED_DATA {
    pub const ENCODED_LEN: usize = 2usize;
    pub const DEFAULT: Self = Self { seq: 0_u16 };
}
impl Default for MISSION_ITEM_REACHED_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for MISSION_ITEM_REACHED_DATA {
    type Message = MavMessage;
    const ID: u32 = 46u32;
    const NAME: &'static str = "MISSION_ITEM_REACHED";
    const EXTRA_CRC: u8 = 11u8;
    const ENCODED_LEN: usize = 2usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.seq = buf.get_u16_le()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u16_le(self.seq);
        if matches!(version, MavlinkVersion::V2) {
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[deprecated = "A system that gets this request should respond with MISSION_ITEM_INT (as though MISSION_REQUEST_INT was received). See `MISSION_REQUEST_INT` (Deprecated since 2020-06)"]
#[doc = "Request the information of the mission item with the sequence number seq. The response of the system to this message should be a MISSION_ITEM message. <https://mavlink.io/en/services/mission.html>."]
#[doc = ""]
#[doc = "ID: 40"]
#[derive(Debug, Clone, PartialEq)]
pub struct MISSION_REQUEST_DATA {
    #[doc = "Sequence"]
    pub seq: u16,
    #[doc = "System ID"]
    pub target_system: u8,
    #[doc = "Component ID"]
    pub target_component: u8,
    #[doc = "Mission type."]
    pub mission_type: u8,
}
impl MISSION_REQUEST_DATA {
    pub const ENCODED_LEN: usize = 5usize;
    pub const DEFAULT: Self =
        Self { seq: 0_u16, target_system: 0_u8, target_component: 0_u8, mission_type: 0_u8 };
}
impl Default for MISSION_REQUEST_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for MISSION_REQUEST_DATA {
    type Message = MavMessage;
    const ID: u32 = 40u32;
    const NAME: &'static str = "MISSION_REQUEST";
    const EXTRA_CRC: u8 = 230u8;
    const ENCODED_LEN: usize = 5usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.seq = buf.get_u16_le()?;
        __struct.target_system = buf.get_u8()?;
        __struct.target_component = buf.get_u8()?;
        __struct.mission_type = buf.get_u8()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u16_le(self.seq);
        __tmp.put_u8(self.target_system);
        __tmp.put_u8(self.target_component);
        if matches!(version, MavlinkVersion::V2) {
            __tmp.put_u8(self.mission_type);
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Request the information of the mission item with the sequence number seq. The response of the system to this message should be a MISSION_ITEM_INT message. <https://mavlink.io/en/services/mission.html>."]
#[doc = ""]
#[doc = "ID: 51"]
#[derive(Debug, Clone, PartialEq)]
pub struct MISSION_REQUEST_INT_DATA {
    #[doc = "Sequence"]
    pub seq: u16,
    #[doc = "System ID"]
    pub target_system: u8,
    #[doc = "Component ID"]
    pub target_component: u8,
    #[doc = "Mission type."]
    pub mission_type: u8,
}
impl MISSION_REQUEST_INT_DATA {
    pub const ENCODED_LEN: usize = 5usize;
    pub const DEFAULT: Self =
        Self { seq: 0_u16, target_system: 0_u8, target_component: 0_u8, mission_type: 0_u8 };
}
impl Default for MISSION_REQUEST_INT_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for MISSION_REQUEST_INT_DATA {
    type Message = MavMessage;
    const ID: u32 = 51u32;
    const NAME: &'static str = "MISSION_REQUEST_INT";
    const EXTRA_CRC: u8 = 196u8;
    const ENCODED_LEN: usize = 5usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.seq = buf.get_u16_le()?;
        __struct.target_system = buf.get_u8()?;
        __struct.target_component = buf.get_u8()?;
        __struct.mission_type = buf.get_u8()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u16_le(self.seq);
        __tmp.put_u8(self.target_system);
        __tmp.put_u8(self.target_component);
        if matches!(version, MavlinkVersion::V2) {
            __tmp.put_u8(self.mission_type);
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Request the overall list of mission items from the system/component."]
#[doc = ""]
#[doc = "ID: 43"]
#[derive(Debug, Clone, PartialEq)]
pub struct MISSION_REQUEST_LIST_DATA {
    #[doc = "System ID"]
    pub target_system: u8,
    #[doc = "Component ID"]
    pub target_component: u8,
    #[doc = "Mission type."]
    pub mission_type: u8,
}
impl MISSION_REQUEST_LIST_DATA {
    pub const ENCODED_LEN: usize = 3usize;
    pub const DEFAULT: Self =
        Self { target_system: 0_u8, target_component: 0_u8, mission_type: 0_u8 };
}
impl Default for MISSION_REQUEST_LIST_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for MISSION_REQUEST_LIST_DATA {
    type Message = MavMessage;
    const ID: u32 = 43u32;
    const NAME: &'static str = "MISSION_REQUEST_LIST";
    const EXTRA_CRC: u8 = 132u8;
    const ENCODED_LEN: usize = 3usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.target_system = buf.get_u8()?;
        __struct.target_component = buf.get_u8()?;
        __struct.mission_type = buf.get_u8()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u8(self.target_system);
        __tmp.put_u8(self.target_component);
        if matches!(version, MavlinkVersion::V2) {
            __tmp.put_u8(self.mission_type);
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Request a partial list of mission items from the system/component. <https://mavlink.io/en/services/mission.html>. If start and end index are the same, just send one waypoint."]
#[doc = ""]
#[doc = "ID: 37"]
#[derive(Debug, Clone, PartialEq)]
pub struct MISSION_REQUEST_PARTIAL_LIST_DATA {
    #[doc = "Start index"]
    pub start_index: i16,
    #[doc = "End index, -1 by default (-1: send list to end). Else a valid index of the list"]
    pub end_index: i16,
    #[doc = "System ID"]
    pub target_system: u8,
    #[doc = "Component ID"]
    pub target_component: u8,
    #[doc = "Mission type."]
    pub mission_type: u8,
}
impl MISSION_REQUEST_PARTIAL_LIST_DATA {
    pub const ENCODED_LEN: usize = 7usize;
    pub const DEFAULT: Self = Self {
        start_index: 0_i16,
        end_index: 0_i16,
        target_system: 0_u8,
        target_component: 0_u8,
        mission_type: 0_u8,
    };
}
impl Default for MISSION_REQUEST_PARTIAL_LIST_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for MISSION_REQUEST_PARTIAL_LIST_DATA {
    type Message = MavMessage;
    const ID: u32 = 37u32;
    const NAME: &'static str = "MISSION_REQUEST_PARTIAL_LIST";
    const EXTRA_CRC: u8 = 212u8;
    const ENCODED_LEN: usize = 7usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.start_index = buf.get_i16_le()?;
        __struct.end_index = buf.get_i16_le()?;
        __struct.target_system = buf.get_u8()?;
        __struct.target_component = buf.get_u8()?;
        __struct.mission_type = buf.get_u8()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_i16_le(self.start_index);
        __tmp.put_i16_le(self.end_index);
        __tmp.put_u8(self.target_system);
        __tmp.put_u8(self.target_component);
        if matches!(version, MavlinkVersion::V2) {
            __tmp.put_u8(self.mission_type);
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[deprecated = " See `MAV_CMD_DO_SET_MISSION_CURRENT` (Superseded since 2022-08)"]
#[doc = "Set the mission item with sequence number seq as the current item and emit MISSION_CURRENT (whether or not the mission number changed).         If a mission is currently being executed, the system will continue to this new mission item on the shortest path, skipping any intermediate mission items.         Note that mission jump repeat counters are not reset (see MAV_CMD_DO_JUMP param2).          This message may trigger a mission state-machine change on some systems: for example from MISSION_STATE_NOT_STARTED or MISSION_STATE_PAUSED to MISSION_STATE_ACTIVE.         If the system is in mission mode, on those systems this command might therefore start, restart or resume the mission.         If the system is not in mission mode this message must not trigger a switch to mission mode."]
#[doc = ""]
#[doc = "ID: 41"]
#[derive(Debug, Clone, PartialEq)]
pub struct MISSION_SET_CURRENT_DATA {
    #[doc = "Sequence"]
    pub seq: u16,
    #[doc = "System ID"]
    pub target_system: u8,
    #[doc = "Component ID"]
    pub target_component: u8,
}
impl MISSION_SET_CURRENT_DATA {
    pub const ENCODED_LEN: usize = 4usize;
    pub const DEFAULT: Self = Self { seq: 0_u16, target_system: 0_u8, target_component: 0_u8 };
}
impl Default for MISSION_SET_CURRENT_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for MISSION_SET_CURRENT_DATA {
    type Message = MavMessage;
    const ID: u32 = 41u32;
    const NAME: &'static str = "MISSION_SET_CURRENT";
    const EXTRA_CRC: u8 = 28u8;
    const ENCODED_LEN: usize = 4usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.seq = buf.get_u16_le()?;
        __struct.target_system = buf.get_u8()?;
        __struct.target_component = buf.get_u8()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u16_le(self.seq);
        __tmp.put_u8(self.target_system);
        __tmp.put_u8(self.target_component);
        if matches!(version, MavlinkVersion::V2) {
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "This message is sent to the MAV to write a partial list. If start index == end index, only one item will be transmitted / updated. If the start index is NOT 0 and above the current list size, this request should be REJECTED!."]
#[doc = ""]
#[doc = "ID: 38"]
#[derive(Debug, Clone, PartialEq)]
pub struct MISSION_WRITE_PARTIAL_LIST_DATA {
    #[doc = "Start index. Must be smaller / equal to the largest index of the current onboard list."]
    pub start_index: i16,
    #[doc = "End index, equal or greater than start index."]
    pub end_index: i16,
    #[doc = "System ID"]
    pub target_system: u8,
    #[doc = "Component ID"]
    pub target_component: u8,
    #[doc = "Mission type."]
    pub mission_type: u8,
}
impl MISSION_WRITE_PARTIAL_LIST_DATA {
    pub const ENCODED_LEN: usize = 7usize;
    pub const DEFAULT: Self = Self {
        start_index: 0_i16,
        end_index: 0_i16,
        target_system: 0_u8,
        target_component: 0_u8,
        mission_type: 0_u8,
    };
}
impl Default for MISSION_WRITE_PARTIAL_LIST_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for MISSION_WRITE_PARTIAL_LIST_DATA {
    type Message = MavMessage;
    const ID: u32 = 38u32;
    const NAME: &'static str = "MISSION_WRITE_PARTIAL_LIST";
    const EXTRA_CRC: u8 = 9u8;
    const ENCODED_LEN: usize = 7usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.start_index = buf.get_i16_le()?;
        __struct.end_index = buf.get_i16_le()?;
        __struct.target_system = buf.get_u8()?;
        __struct.target_component = buf.get_u8()?;
        __struct.mission_type = buf.get_u8()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_i16_le(self.start_index);
        __tmp.put_i16_le(self.end_index);
        __tmp.put_u8(self.target_system);
        __tmp.put_u8(self.target_component);
        if matches!(version, MavlinkVersion::V2) {
            __tmp.put_u8(self.mission_type);
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "The state of the navigation and position controller."]
#[doc = ""]
#[doc = "ID: 62"]
#[derive(Debug, Clone, PartialEq)]
pub struct NAV_CONTROLLER_OUTPUT_DATA {
    #[doc = "Current desired roll"]
    pub nav_roll: f32,
    #[doc = "Current desired pitch"]
    pub nav_pitch: f32,
    #[doc = "Current altitude error"]
    pub alt_error: f32,
    #[doc = "Current airspeed error"]
    pub aspd_error: f32,
    #[doc = "Current crosstrack error on x-y plane"]
    pub xtrack_error: f32,
    #[doc = "Current desired heading"]
    pub nav_bearing: i16,
    #[doc = "Bearing to current waypoint/target"]
    pub target_bearing: i16,
    #[doc = "Distance to active waypoint"]
    pub wp_dist: u16,
}
impl NAV_CONTROLLER_OUTPUT_DATA {
    pub const ENCODED_LEN: usize = 26usize;
    pub const DEFAULT: Self = Self {
        nav_roll: 0.0_f32,
        nav_pitch: 0.0_f32,
        alt_error: 0.0_f32,
        aspd_error: 0.0_f32,
        xtrack_error: 0.0_f32,
        nav_bearing: 0_i16,
        target_bearing: 0_i16,
        wp_dist: 0_u16,
    };
}
impl Default for NAV_CONTROLLER_OUTPUT_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for NAV_CONTROLLER_OUTPUT_DATA {
    type Message = MavMessage;
    const ID: u32 = 62u32;
    const NAME: &'static str = "NAV_CONTROLLER_OUTPUT";
    const EXTRA_CRC: u8 = 183u8;
    const ENCODED_LEN: usize = 26usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.nav_roll = buf.get_f32_le()?;
        __struct.nav_pitch = buf.get_f32_le()?;
        __struct.alt_error = buf.get_f32_le()?;
        __struct.aspd_error = buf.get_f32_le()?;
        __struct.xtrack_error = buf.get_f32_le()?;
        __struct.nav_bearing = buf.get_i16_le()?;
        __struct.target_bearing = buf.get_i16_le()?;
        __struct.wp_dist = buf.get_u16_le()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_f32_le(self.nav_roll);
        __tmp.put_f32_le(self.nav_pitch);
        __tmp.put_f32_le(self.alt_error);
        __tmp.put_f32_le(self.aspd_error);
        __tmp.put_f32_le(self.xtrack_error);
        __tmp.put_i16_le(self.nav_bearing);
        __tmp.put_i16_le(self.target_bearing);
        __tmp.put_u16_le(self.wp_dist);
        if matches!(version, MavlinkVersion::V2) {
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Odometry message to communicate odometry information with an external interface. Fits ROS REP 147 standard for aerial vehicles (<http://www.ros.org/reps/rep-0147.html>)."]
#[doc = ""]
#[doc = "ID: 331"]
#[derive(Debug, Clone, PartialEq)]
pub struct ODOMETRY_DATA {
    #[doc = "Timestamp (UNIX Epoch time or time since system boot). The receiving end can infer timestamp format (since 1.1.1970 or since system boot) by checking for the magnitude of the number."]
    pub time_usec: u64,
    #[doc = "X Position"]
    pub x: f32,
    #[doc = "Y Position"]
    pub y: f32,
    #[doc = "Z Position"]
    pub z: f32,
    #[doc = "Quaternion components, w, x, y, z (1 0 0 0 is the null-rotation)"]
    pub q: [f32; 4],
    #[doc = "X linear speed"]
    pub vx: f32,
    #[doc = "Y linear speed"]
    pub vy: f32,
    #[doc = "Z linear speed"]
    pub vz: f32,
    #[doc = "Roll angular speed"]
    pub rollspeed: f32,
    #[doc = "Pitch angular speed"]
    pub pitchspeed: f32,
    #[doc = "Yaw angular speed"]
    pub yawspeed: f32,
    #[doc = "Row-major representation of a 6x6 pose cross-covariance matrix upper right triangle (states: x, y, z, roll, pitch, yaw; first six entries are the first ROW, next five entries are the second ROW, etc.). If unknown, assign NaN value to first element in the array."]
    pub pose_covariance: [f32; 21],
    #[doc = "Row-major representation of a 6x6 velocity cross-covariance matrix upper right triangle (states: vx, vy, vz, rollspeed, pitchspeed, yawspeed; first six entries are the first ROW, next five entries are the second ROW, etc.). If unknown, assign NaN value to first element in the array."]
    pub velocity_covariance: [f32; 21],
    #[doc = "Coordinate frame of reference for the pose data."]
    pub frame_id: u8,
    #[doc = "Coordinate frame of reference for the velocity in free space (twist) data."]
    pub child_frame_id: u8,
    #[doc = "Estimate reset counter. This should be incremented when the estimate resets in any of the dimensions (position, velocity, attitude, angular speed). This is designed to be used when e.g an external SLAM system detects a loop-closure and the estimate jumps."]
    pub reset_counter: u8,
    #[doc = "Type of estimator that is providing the odometry."]
    pub estimator_type: MavEstimatorType,
    #[doc = "Optional odometry quality metric as a percentage. -1 = odometry has failed, 0 = unknown/unset quality, 1 = worst quality, 100 = best quality"]
    pub quality: i8,
}
impl ODOMETRY_DATA {
    pub const ENCODED_LEN: usize = 233usize;
    pub const DEFAULT: Self = Self {
        time_usec: 0_u64,
        x: 0.0_f32,
        y: 0.0_f32,
        z: 0.0_f32,
        q: [0.0_f32; 4usize],
        vx: 0.0_f32,
        vy: 0.0_f32,
        vz: 0.0_f32,
        rollspeed: 0.0_f32,
        pitchspeed: 0.0_f32,
        yawspeed: 0.0_f32,
        pose_covariance: [0.0_f32; 21usize],
        velocity_covariance: [0.0_f32; 21usize],
        frame_id: 0_u8,
        child_frame_id: 0_u8,
        reset_counter: 0_u8,
        estimator_type: MavEstimatorType::DEFAULT,
        quality: 0_i8,
    };
}
impl Default for ODOMETRY_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for ODOMETRY_DATA {
    type Message = MavMessage;
    const ID: u32 = 331u32;
    const NAME: &'static str = "ODOMETRY";
    const EXTRA_CRC: u8 = 91u8;
    const ENCODED_LEN: usize = 233usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.time_usec = buf.get_u64_le()?;
        __struct.x = buf.get_f32_le()?;
        __struct.y = buf.get_f32_le()?;
        __struct.z = buf.get_f32_le()?;
        for v in &mut __struct.q {
            let val = buf.get_f32_le()?;
            *v = val;
        }
        __struct.vx = buf.get_f32_le()?;
        __struct.vy = buf.get_f32_le()?;
        __struct.vz = buf.get_f32_le()?;
        __struct.rollspeed = buf.get_f32_le()?;
        __struct.pitchspeed = buf.get_f32_le()?;
        __struct.yawspeed = buf.get_f32_le()?;
        for v in &mut __struct.pose_covariance {
            let val = buf.get_f32_le()?;
            *v = val;
        }
        for v in &mut __struct.velocity_covariance {
            let val = buf.get_f32_le()?;
            *v = val;
        }
        __struct.frame_id = buf.get_u8()?;
        __struct.child_frame_id = buf.get_u8()?;
        __struct.reset_counter = buf.get_u8()?;
        let tmp = buf.get_u8()?;
        __struct.estimator_type =
            FromPrimitive::from_u8(tmp).ok_or(::mavlink_core::error::ParserError::InvalidEnum {
                enum_type: "MavEstimatorType",
                value: tmp as u64,
            })?;
        __struct.quality = buf.get_i8()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u64_le(self.time_usec);
        __tmp.put_f32_le(self.x);
        __tmp.put_f32_le(self.y);
        __tmp.put_f32_le(self.z);
        for val in &self.q {
            __tmp.put_f32_le(*val);
        }
        __tmp.put_f32_le(self.vx);
        __tmp.put_f32_le(self.vy);
        __tmp.put_f32_le(self.vz);
        __tmp.put_f32_le(self.rollspeed);
        __tmp.put_f32_le(self.pitchspeed);
        __tmp.put_f32_le(self.yawspeed);
        for val in &self.pose_covariance {
            __tmp.put_f32_le(*val);
        }
        for val in &self.velocity_covariance {
            __tmp.put_f32_le(*val);
        }
        __tmp.put_u8(self.frame_id);
        __tmp.put_u8(self.child_frame_id);
        if matches!(version, MavlinkVersion::V2) {
            __tmp.put_u8(self.reset_counter);
            __tmp.put_u8(self.estimator_type as u8);
            __tmp.put_i8(self.quality);
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Optical flow from an angular rate flow sensor (e.g. PX4FLOW or mouse sensor)."]
#[doc = ""]
#[doc = "ID: 106"]
#[derive(Debug, Clone, PartialEq)]
pub struct OPTICAL_FLOW_RAD_DATA {
    #[doc = "Timestamp (UNIX Epoch time or time since system boot). The receiving end can infer timestamp format (since 1.1.1970 or since system boot) by checking for the magnitude of the number."]
    pub time_usec: u64,
    #[doc = "Integration time. Divide integrated_x and integrated_y by the integration time to obtain average flow. The integration time also indicates the."]
    pub integration_time_us: u32,
    #[doc = "Flow around X axis (Sensor RH rotation about the X axis induces a positive flow. Sensor linear motion along the positive Y axis induces a negative flow.)"]
    pub integrated_x: f32,
    #[doc = "Flow around Y axis (Sensor RH rotation about the Y axis induces a positive flow. Sensor linear motion along the positive X axis induces a positive flow.)"]
    pub integrated_y: f32,
    #[doc = "RH rotation around X axis"]
    pub integrated_xgyro: f32,
    #[doc = "RH rotation around Y axis"]
    pub integrated_ygyro: f32,
    #[doc = "RH rotation around Z axis"]
    pub integrated_zgyro: f32,
    #[doc = "Time since the distance was sampled."]
    pub time_delta_distance_us: u32,
    #[doc = "Distance to the center of the flow field. Positive value (including zero): distance known. Negative value: Unknown distance."]
    pub distance: f32,
    #[doc = "Temperature"]
    pub temperature: i16,
    #[doc = "Sensor ID"]
    pub sensor_id: u8,
    #[doc = "Optical flow quality / confidence. 0: no valid flow, 255: maximum quality"]
    pub quality: u8,
}
impl OPTICAL_FLOW_RAD_DATA {
    pub const ENCODED_LEN: usize = 44usize;
    pub const DEFAULT: Self = Self {
        time_usec: 0_u64,
        integration_time_us: 0_u32,
        integrated_x: 0.0_f32,
        integrated_y: 0.0_f32,
        integrated_xgyro: 0.0_f32,
        integrated_ygyro: 0.0_f32,
        integrated_zgyro: 0.0_f32,
        time_delta_distance_us: 0_u32,
        distance: 0.0_f32,
        temperature: 0_i16,
        sensor_id: 0_u8,
        quality: 0_u8,
    };
}
impl Default for OPTICAL_FLOW_RAD_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for OPTICAL_FLOW_RAD_DATA {
    type Message = MavMessage;
    const ID: u32 = 106u32;
    const NAME: &'static str = "OPTICAL_FLOW_RAD";
    const EXTRA_CRC: u8 = 138u8;
    const ENCODED_LEN: usize = 44usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.time_usec = buf.get_u64_le()?;
        __struct.integration_time_us = buf.get_u32_le()?;
        __struct.integrated_x = buf.get_f32_le()?;
        __struct.integrated_y = buf.get_f32_le()?;
        __struct.integrated_xgyro = buf.get_f32_le()?;
        __struct.integrated_ygyro = buf.get_f32_le()?;
        __struct.integrated_zgyro = buf.get_f32_le()?;
        __struct.time_delta_distance_us = buf.get_u32_le()?;
        __struct.distance = buf.get_f32_le()?;
        __struct.temperature = buf.get_i16_le()?;
        __struct.sensor_id = buf.get_u8()?;
        __struct.quality = buf.get_u8()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u64_le(self.time_usec);
        __tmp.put_u32_le(self.integration_time_us);
        __tmp.put_f32_le(self.integrated_x);
        __tmp.put_f32_le(self.integrated_y);
        __tmp.put_f32_le(self.integrated_xgyro);
        __tmp.put_f32_le(self.integrated_ygyro);
        __tmp.put_f32_le(self.integrated_zgyro);
        __tmp.put_u32_le(self.time_delta_distance_us);
        __tmp.put_f32_le(self.distance);
        __tmp.put_i16_le(self.temperature);
        __tmp.put_u8(self.sensor_id);
        __tmp.put_u8(self.quality);
        if matches!(version, MavlinkVersion::V2) {
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Parameter set/get error. Returned from a MAVLink node in response to an error in the parameter protocol, for example failing to set a parameter because it does not exist."]
#[doc = ""]
#[doc = "ID: 345"]
#[derive(Debug, Clone, PartialEq)]
pub struct PARAM_ERROR_DATA {
    #[doc = "Parameter index. Will be -1 if the param ID field should be used as an identifier (else the param id will be ignored)"]
    pub param_index: i16,
    #[doc = "System ID"]
    pub target_system: u8,
    #[doc = "Component ID"]
    pub target_component: u8,
    #[doc = "Parameter id. Terminated by NULL if the length is less than 16 human-readable chars and WITHOUT null termination (NULL) byte if the length is exactly 16 chars - applications have to provide 16+1 bytes storage if the ID is stored as string"]
    pub param_id: CharArray<16>,
    #[doc = "Error being returned to client."]
    pub error: MavParamError,
}
impl PARAM_ERROR_DATA {
    pub const ENCODED_LEN: usize = 21usize;
    pub const DEFAULT: Self = Self {
        param_index: 0_i16,
        target_system: 0_u8,
        target_component: 0_u8,
        param_id: CharArray::new([0_u8; 16usize]),
        error: MavParamError::DEFAULT,
    };
}
impl Default for PARAM_ERROR_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for PARAM_ERROR_DATA {
    type Message = MavMessage;
    const ID: u32 = 345u32;
    const NAME: &'static str = "PARAM_ERROR";
    const EXTRA_CRC: u8 = 209u8;
    const ENCODED_LEN: usize = 21usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.param_index = buf.get_i16_le()?;
        __struct.target_system = buf.get_u8()?;
        __struct.target_component = buf.get_u8()?;
        let mut tmp = [0_u8; 16usize];
        for v in &mut tmp {
            *v = buf.get_u8()?;
        }
        __struct.param_id = CharArray::new(tmp);
        let tmp = buf.get_u8()?;
        __struct.error =
            FromPrimitive::from_u8(tmp).ok_or(::mavlink_core::error::ParserError::InvalidEnum {
                enum_type: "MavParamError",
                value: tmp as u64,
            })?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_i16_le(self.param_index);
        __tmp.put_u8(self.target_system);
        __tmp.put_u8(self.target_component);
        for val in &self.param_id {
            __tmp.put_u8(*val);
        }
        __tmp.put_u8(self.error as u8);
        if matches!(version, MavlinkVersion::V2) {
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Request all parameters of this component. After this request, all parameters are emitted. The parameter microservice is documented at <https://mavlink.io/en/services/parameter.html>."]
#[doc = ""]
#[doc = "ID: 21"]
#[derive(Debug, Clone, PartialEq)]
pub struct PARAM_REQUEST_LIST_DATA {
    #[doc = "System ID"]
    pub target_system: u8,
    #[doc = "Component ID"]
    pub target_component: u8,
}
impl PARAM_REQUEST_LIST_DATA {
    pub const ENCODED_LEN: usize = 2usize;
    pub const DEFAULT: Self = Self { target_system: 0_u8, target_component: 0_u8 };
}
impl Default for PARAM_REQUEST_LIST_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for PARAM_REQUEST_LIST_DATA {
    type Message = MavMessage;
    const ID: u32 = 21u32;
    const NAME: &'static str = "PARAM_REQUEST_LIST";
    const EXTRA_CRC: u8 = 159u8;
    const ENCODED_LEN: usize = 2usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.target_system = buf.get_u8()?;
        __struct.target_component = buf.get_u8()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u8(self.target_system);
        __tmp.put_u8(self.target_component);
        if matches!(version, MavlinkVersion::V2) {
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Request to read the onboard parameter with the param_id string id. Onboard parameters are stored as key[const char*] ->value[float]. This allows to send a parameter to any other component (such as the GCS) without the need of previous knowledge of possible parameter names. Thus the same GCS can store different parameters for different autopilots. See also <https://mavlink.io/en/services/parameter.html> for a full documentation of QGroundControl and IMU code."]
#[doc = ""]
#[doc = "ID: 20"]
#[derive(Debug, Clone, PartialEq)]
pub struct PARAM_REQUEST_READ_DATA {
    #[doc = "Parameter index. Send -1 to use the param ID field as identifier (else the param id will be ignored)"]
    pub param_index: i16,
    #[doc = "System ID"]
    pub target_system: u8,
    #[doc = "Component ID"]
    pub target_component: u8,
    #[doc = "Onboard parameter id, terminated by NULL if the length is less than 16 human-readable chars and WITHOUT null termination (NULL) byte if the length is exactly 16 chars - applications have to provide 16+1 bytes storage if the ID is stored as string"]
    pub param_id: CharArray<16>,
}
impl PARAM_REQUEST_READ_DATA {
    pub const ENCODED_LEN: usize = 20usize;
    pub const DEFAULT: Self = Self {
        param_index: 0_i16,
        target_system: 0_u8,
        target_component: 0_u8,
        param_id: CharArray::new([0_u8; 16usize]),
    };
}
impl Default for PARAM_REQUEST_READ_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for PARAM_REQUEST_READ_DATA {
    type Message = MavMessage;
    const ID: u32 = 20u32;
    const NAME: &'static str = "PARAM_REQUEST_READ";
    const EXTRA_CRC: u8 = 214u8;
    const ENCODED_LEN: usize = 20usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.param_index = buf.get_i16_le()?;
        __struct.target_system = buf.get_u8()?;
        __struct.target_component = buf.get_u8()?;
        let mut tmp = [0_u8; 16usize];
        for v in &mut tmp {
            *v = buf.get_u8()?;
        }
        __struct.param_id = CharArray::new(tmp);
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_i16_le(self.param_index);
        __tmp.put_u8(self.target_system);
        __tmp.put_u8(self.target_component);
        for val in &self.param_id {
            __tmp.put_u8(*val);
        }
        if matches!(version, MavlinkVersion::V2) {
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Set a parameter value (write new value to permanent storage).         The receiving component should acknowledge the new parameter value by broadcasting a PARAM_VALUE message (broadcasting ensures that multiple GCS all have an up-to-date list of all parameters). If the sending GCS did not receive a PARAM_VALUE within its timeout time, it should re-send the PARAM_SET message. The parameter microservice is documented at <https://mavlink.io/en/services/parameter.html>."]
#[doc = ""]
#[doc = "ID: 23"]
#[derive(Debug, Clone, PartialEq)]
pub struct PARAM_SET_DATA {
    #[doc = "Onboard parameter value"]
    pub param_value: f32,
    #[doc = "System ID"]
    pub target_system: u8,
    #[doc = "Component ID"]
    pub target_component: u8,
    #[doc = "Onboard parameter id, terminated by NULL if the length is less than 16 human-readable chars and WITHOUT null termination (NULL) byte if the length is exactly 16 chars - applications have to provide 16+1 bytes storage if the ID is stored as string"]
    pub param_id: CharArray<16>,
    #[doc = "Onboard parameter type."]
    pub param_type: u8,
}
impl PARAM_SET_DATA {
    pub const ENCODED_LEN: usize = 23usize;
    pub const DEFAULT: Self = Self {
        param_value: 0.0_f32,
        target_system: 0_u8,
        target_component: 0_u8,
        param_id: CharArray::new([0_u8; 16usize]),
        param_type: 0_u8,
    };
}
impl Default for PARAM_SET_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for PARAM_SET_DATA {
    type Message = MavMessage;
    const ID: u32 = 23u32;
    const NAME: &'static str = "PARAM_SET";
    const EXTRA_CRC: u8 = 168u8;
    const ENCODED_LEN: usize = 23usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.param_value = buf.get_f32_le()?;
        __struct.target_system = buf.get_u8()?;
        __struct.target_component = buf.get_u8()?;
        let mut tmp = [0_u8; 16usize];
        for v in &mut tmp {
            *v = buf.get_u8()?;
        }
        __struct.param_id = CharArray::new(tmp);
        __struct.param_type = buf.get_u8()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_f32_le(self.param_value);
        __tmp.put_u8(self.target_system);
        __tmp.put_u8(self.target_component);
        for val in &self.param_id {
            __tmp.put_u8(*val);
        }
        __tmp.put_u8(self.param_type);
        if matches!(version, MavlinkVersion::V2) {
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Emit the value of a onboard parameter. The inclusion of param_count and param_index in the message allows the recipient to keep track of received parameters and allows him to re-request missing parameters after a loss or timeout. The parameter microservice is documented at <https://mavlink.io/en/services/parameter.html>."]
#[doc = ""]
#[doc = "ID: 22"]
#[derive(Debug, Clone, PartialEq)]
pub struct PARAM_VALUE_DATA {
    #[doc = "Onboard parameter value"]
    pub param_value: f32,
    #[doc = "Total number of onboard parameters"]
    pub param_count: u16,
    #[doc = "Index of this onboard parameter"]
    pub param_index: u16,
    #[doc = "Onboard parameter id, terminated by NULL if the length is less than 16 human-readable chars and WITHOUT null termination (NULL) byte if the length is exactly 16 chars - applications have to provide 16+1 bytes storage if the ID is stored as string"]
    pub param_id: CharArray<16>,
    #[doc = "Onboard parameter type."]
    pub param_type: u8,
}
impl PARAM_VALUE_DATA {
    pub const ENCODED_LEN: usize = 25usize;
    pub const DEFAULT: Self = Self {
        param_value: 0.0_f32,
        param_count: 0_u16,
        param_index: 0_u16,
        param_id: CharArray::new([0_u8; 16usize]),
        param_type: 0_u8,
    };
}
impl Default for PARAM_VALUE_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for PARAM_VALUE_DATA {
    type Message = MavMessage;
    const ID: u32 = 22u32;
    const NAME: &'static str = "PARAM_VALUE";
    const EXTRA_CRC: u8 = 220u8;
    const ENCODED_LEN: usize = 25usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.param_value = buf.get_f32_le()?;
        __struct.param_count = buf.get_u16_le()?;
        __struct.param_index = buf.get_u16_le()?;
        let mut tmp = [0_u8; 16usize];
        for v in &mut tmp {
            *v = buf.get_u8()?;
        }
        __struct.param_id = CharArray::new(tmp);
        __struct.param_type = buf.get_u8()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_f32_le(self.param_value);
        __tmp.put_u16_le(self.param_count);
        __tmp.put_u16_le(self.param_index);
        for val in &self.param_id {
            __tmp.put_u8(*val);
        }
        __tmp.put_u8(self.param_type);
        if matches!(version, MavlinkVersion::V2) {
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[deprecated = "To be removed / merged with TIMESYNC. See `TIMESYNC` (Superseded since 2011-08)"]
#[doc = "A ping message either requesting or responding to a ping. This allows to measure the system latencies, including serial port, radio modem and UDP connections. The ping microservice is documented at <https://mavlink.io/en/services/ping.html>."]
#[doc = ""]
#[doc = "ID: 4"]
#[derive(Debug, Clone, PartialEq)]
pub struct PING_DATA {
    #[doc = "Timestamp (UNIX Epoch time or time since system boot). The receiving end can infer timestamp format (since 1.1.1970 or since system boot) by checking for the magnitude of the number."]
    pub time_usec: u64,
    #[doc = "PING sequence"]
    pub seq: u32,
    #[doc = "0: request ping from all receiving systems. If greater than 0: message is a ping response and number is the system id of the requesting system"]
    pub target_system: u8,
    #[doc = "0: request ping from all receiving components. If greater than 0: message is a ping response and number is the component id of the requesting component."]
    pub target_component: u8,
}
impl PING_DATA {
    pub const ENCODED_LEN: usize = 14usize;
    pub const DEFAULT: Self =
        Self { time_usec: 0_u64, seq: 0_u32, target_system: 0_u8, target_component: 0_u8 };
}
impl Default for PING_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for PING_DATA {
    type Message = MavMessage;
    const ID: u32 = 4u32;
    const NAME: &'static str = "PING";
    const EXTRA_CRC: u8 = 237u8;
    const ENCODED_LEN: usize = 14usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.time_usec = buf.get_u64_le()?;
        __struct.seq = buf.get_u32_le()?;
        __struct.target_system = buf.get_u8()?;
        __struct.target_component = buf.get_u8()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u64_le(self.time_usec);
        __tmp.put_u32_le(self.seq);
        __tmp.put_u8(self.target_system);
        __tmp.put_u8(self.target_component);
        if matches!(version, MavlinkVersion::V2) {
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Reports the current commanded vehicle position, velocity, and acceleration as specified by the autopilot. This should match the commands sent in SET_POSITION_TARGET_GLOBAL_INT if the vehicle is being controlled this way."]
#[doc = ""]
#[doc = "ID: 87"]
#[derive(Debug, Clone, PartialEq)]
pub struct POSITION_TARGET_GLOBAL_INT_DATA {
    #[doc = "Timestamp (time since system boot). The rationale for the timestamp in the setpoint is to allow the system to compensate for the transport delay of the setpoint. This allows the system to compensate processing latency."]
    pub time_boot_ms: u32,
    #[doc = "Latitude in WGS84 frame"]
    pub lat_int: i32,
    #[doc = "Longitude in WGS84 frame"]
    pub lon_int: i32,
    #[doc = "Altitude (MSL, AGL or relative to home altitude, depending on frame)"]
    pub alt: f32,
    #[doc = "X velocity in NED frame"]
    pub vx: f32,
    #[doc = "Y velocity in NED frame"]
    pub vy: f32,
    #[doc = "Z velocity in NED frame"]
    pub vz: f32,
    #[doc = "X acceleration or force (if bit 10 of type_mask is set) in NED frame in meter / s^2 or N"]
    pub afx: f32,
    #[doc = "Y acceleration or force (if bit 10 of type_mask is set) in NED frame in meter / s^2 or N"]
    pub afy: f32,
    #[doc = "Z acceleration or force (if bit 10 of type_mask is set) in NED frame in meter / s^2 or N"]
    pub afz: f32,
    #[doc = "yaw setpoint"]
    pub yaw: f32,
    #[doc = "yaw rate setpoint"]
    pub yaw_rate: f32,
    #[doc = "Bitmap to indicate which dimensions should be ignored by the vehicle."]
    pub type_mask: PositionTargetTypemask,
    #[doc = "Valid options are: MAV_FRAME_GLOBAL = 0, MAV_FRAME_GLOBAL_RELATIVE_ALT = 3, MAV_FRAME_GLOBAL_TERRAIN_ALT = 10 (MAV_FRAME_GLOBAL_INT, MAV_FRAME_GLOBAL_RELATIVE_ALT_INT, MAV_FRAME_GLOBAL_TERRAIN_ALT_INT are allowed synonyms, but have been deprecated)"]
    pub coordinate_frame: u8,
}
impl POSITION_TARGET_GLOBAL_INT_DATA {
    pub const ENCODED_LEN: usize = 51usize;
    pub const DEFAULT: Self = Self {
        time_boot_ms: 0_u32,
        lat_int: 0_i32,
        lon_int: 0_i32,
        alt: 0.0_f32,
        vx: 0.0_f32,
        vy: 0.0_f32,
        vz: 0.0_f32,
        afx: 0.0_f32,
        afy: 0.0_f32,
        afz: 0.0_f32,
        yaw: 0.0_f32,
        yaw_rate: 0.0_f32,
        type_mask: PositionTargetTypemask::DEFAULT,
        coordinate_frame: 0_u8,
    };
}
impl Default for POSITION_TARGET_GLOBAL_INT_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for POSITION_TARGET_GLOBAL_INT_DATA {
    type Message = MavMessage;
    const ID: u32 = 87u32;
    const NAME: &'static str = "POSITION_TARGET_GLOBAL_INT";
    const EXTRA_CRC: u8 = 150u8;
    const ENCODED_LEN: usize = 51usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.time_boot_ms = buf.get_u32_le()?;
        __struct.lat_int = buf.get_i32_le()?;
        __struct.lon_int = buf.get_i32_le()?;
        __struct.alt = buf.get_f32_le()?;
        __struct.vx = buf.get_f32_le()?;
        __struct.vy = buf.get_f32_le()?;
        __struct.vz = buf.get_f32_le()?;
        __struct.afx = buf.get_f32_le()?;
        __struct.afy = buf.get_f32_le()?;
        __struct.afz = buf.get_f32_le()?;
        __struct.yaw = buf.get_f32_le()?;
        __struct.yaw_rate = buf.get_f32_le()?;
        let tmp = buf.get_u16_le()?;
        __struct.type_mask = PositionTargetTypemask::from_bits_retain(
            tmp as <PositionTargetTypemask as Flags>::Bits,
        );
        __struct.coordinate_frame = buf.get_u8()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u32_le(self.time_boot_ms);
        __tmp.put_i32_le(self.lat_int);
        __tmp.put_i32_le(self.lon_int);
        __tmp.put_f32_le(self.alt);
        __tmp.put_f32_le(self.vx);
        __tmp.put_f32_le(self.vy);
        __tmp.put_f32_le(self.vz);
        __tmp.put_f32_le(self.afx);
        __tmp.put_f32_le(self.afy);
        __tmp.put_f32_le(self.afz);
        __tmp.put_f32_le(self.yaw);
        __tmp.put_f32_le(self.yaw_rate);
        __tmp.put_u16_le(self.type_mask.bits() as u16);
        __tmp.put_u8(self.coordinate_frame);
        if matches!(version, MavlinkVersion::V2) {
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Reports the current commanded vehicle position, velocity, and acceleration as specified by the autopilot. This should match the commands sent in SET_POSITION_TARGET_LOCAL_NED if the vehicle is being controlled this way."]
#[doc = ""]
#[doc = "ID: 85"]
#[derive(Debug, Clone, PartialEq)]
pub struct POSITION_TARGET_LOCAL_NED_DATA {
    #[doc = "Timestamp (time since system boot)."]
    pub time_boot_ms: u32,
    #[doc = "X Position in NED frame"]
    pub x: f32,
    #[doc = "Y Position in NED frame"]
    pub y: f32,
    #[doc = "Z Position in NED frame (note, altitude is negative in NED)"]
    pub z: f32,
    #[doc = "X velocity in NED frame"]
    pub vx: f32,
    #[doc = "Y velocity in NED frame"]
    pub vy: f32,
    #[doc = "Z velocity in NED frame"]
    pub vz: f32,
    #[doc = "X acceleration or force (if bit 10 of type_mask is set) in NED frame in meter / s^2 or N"]
    pub afx: f32,
    #[doc = "Y acceleration or force (if bit 10 of type_mask is set) in NED frame in meter / s^2 or N"]
    pub afy: f32,
    #[doc = "Z acceleration or force (if bit 10 of type_mask is set) in NED frame in meter / s^2 or N"]
    pub afz: f32,
    #[doc = "yaw setpoint"]
    pub yaw: f32,
    #[doc = "yaw rate setpoint"]
    pub yaw_rate: f32,
    #[doc = "Bitmap to indicate which dimensions should be ignored by the vehicle."]
    pub type_mask: PositionTargetTypemask,
    #[doc = "Valid options are: MAV_FRAME_LOCAL_NED = 1, MAV_FRAME_LOCAL_OFFSET_NED = 7, MAV_FRAME_BODY_NED = 8, MAV_FRAME_BODY_OFFSET_NED = 9"]
    pub coordinate_frame: u8,
}
impl POSITION_TARGET_LOCAL_NED_DATA {
    pub const ENCODED_LEN: usize = 51usize;
    pub const DEFAULT: Self = Self {
        time_boot_ms: 0_u32,
        x: 0.0_f32,
        y: 0.0_f32,
        z: 0.0_f32,
        vx: 0.0_f32,
        vy: 0.0_f32,
        vz: 0.0_f32,
        afx: 0.0_f32,
        afy: 0.0_f32,
        afz: 0.0_f32,
        yaw: 0.0_f32,
        yaw_rate: 0.0_f32,
        type_mask: PositionTargetTypemask::DEFAULT,
        coordinate_frame: 0_u8,
    };
}
impl Default for POSITION_TARGET_LOCAL_NED_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for POSITION_TARGET_LOCAL_NED_DATA {
    type Message = MavMessage;
    const ID: u32 = 85u32;
    const NAME: &'static str = "POSITION_TARGET_LOCAL_NED";
    const EXTRA_CRC: u8 = 140u8;
    const ENCODED_LEN: usize = 51usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.time_boot_ms = buf.get_u32_le()?;
        __struct.x = buf.get_f32_le()?;
        __struct.y = buf.get_f32_le()?;
        __struct.z = buf.get_f32_le()?;
        __struct.vx = buf.get_f32_le()?;
        __struct.vy = buf.get_f32_le()?;
        __struct.vz = buf.get_f32_le()?;
        __struct.afx = buf.get_f32_le()?;
        __struct.afy = buf.get_f32_le()?;
        __struct.afz = buf.get_f32_le()?;
        __struct.yaw = buf.get_f32_le()?;
        __struct.yaw_rate = buf.get_f32_le()?;
        let tmp = buf.get_u16_le()?;
        __struct.type_mask = PositionTargetTypemask::from_bits_retain(
            tmp as <PositionTargetTypemask as Flags>::Bits,
        );
        __struct.coordinate_frame = buf.get_u8()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u32_le(self.time_boot_ms);
        __tmp.put_f32_le(self.x);
        __tmp.put_f32_le(self.y);
        __tmp.put_f32_le(self.z);
        __tmp.put_f32_le(self.vx);
        __tmp.put_f32_le(self.vy);
        __tmp.put_f32_le(self.vz);
        __tmp.put_f32_le(self.afx);
        __tmp.put_f32_le(self.afy);
        __tmp.put_f32_le(self.afz);
        __tmp.put_f32_le(self.yaw);
        __tmp.put_f32_le(self.yaw_rate);
        __tmp.put_u16_le(self.type_mask.bits() as u16);
        __tmp.put_u8(self.coordinate_frame);
        if matches!(version, MavlinkVersion::V2) {
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[deprecated = "No longer needed. Support is being removed from flight stacks. See `Nothing` (Deprecated since 2025-11)"]
#[doc = "Version and capability of protocol version. This message can be requested with MAV_CMD_REQUEST_MESSAGE and is used as part of the handshaking to establish which MAVLink version should be used on the network. Every node should respond to a request for PROTOCOL_VERSION to enable the handshaking. Library implementers should consider adding this into the default decoding state machine to allow the protocol core to respond directly."]
#[doc = ""]
#[doc = "ID: 300"]
#[derive(Debug, Clone, PartialEq)]
pub struct PROTOCOL_VERSION_DATA {
    #[doc = "Currently active MAVLink version number * 100: v1.0 is 100, v2.0 is 200, etc."]
    pub version: u16,
    #[doc = "Minimum MAVLink version supported"]
    pub min_version: u16,
    #[doc = "Maximum MAVLink version supported (set to the same value as version by default)"]
    pub max_version: u16,
    #[doc = "The first 8 bytes (not characters printed in hex!) of the git hash."]
    pub spec_version_hash: [u8; 8],
    #[doc = "The first 8 bytes (not characters printed in hex!) of the git hash."]
    pub library_version_hash: [u8; 8],
}
impl PROTOCOL_VERSION_DATA {
    pub const ENCODED_LEN: usize = 22usize;
    pub const DEFAULT: Self = Self {
        version: 0_u16,
        min_version: 0_u16,
        max_version: 0_u16,
        spec_version_hash: [0_u8; 8usize],
        library_version_hash: [0_u8; 8usize],
    };
}
impl Default for PROTOCOL_VERSION_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for PROTOCOL_VERSION_DATA {
    type Message = MavMessage;
    const ID: u32 = 300u32;
    const NAME: &'static str = "PROTOCOL_VERSION";
    const EXTRA_CRC: u8 = 217u8;
    const ENCODED_LEN: usize = 22usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.version = buf.get_u16_le()?;
        __struct.min_version = buf.get_u16_le()?;
        __struct.max_version = buf.get_u16_le()?;
        for v in &mut __struct.spec_version_hash {
            let val = buf.get_u8()?;
            *v = val;
        }
        for v in &mut __struct.library_version_hash {
            let val = buf.get_u8()?;
            *v = val;
        }
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u16_le(self.version);
        __tmp.put_u16_le(self.min_version);
        __tmp.put_u16_le(self.max_version);
        for val in &self.spec_version_hash {
            __tmp.put_u8(*val);
        }
        for val in &self.library_version_hash {
            __tmp.put_u8(*val);
        }
        if matches!(version, MavlinkVersion::V2) {
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "The RAW values of the RC channels sent to the MAV to override info received from the RC radio. The standard PPM modulation is as follows: 1000 microseconds: 0%, 2000 microseconds: 100%. Individual receivers/transmitters might violate this specification.  Note carefully the semantic differences between the first 8 channels and the subsequent channels."]
#[doc = ""]
#[doc = "ID: 70"]
#[derive(Debug, Clone, PartialEq)]
pub struct RC_CHANNELS_OVERRIDE_DATA {
    #[doc = "RC channel 1 value. A value of UINT16_MAX means to ignore this field. A value of 0 means to release this channel back to the RC radio."]
    pub chan1_raw: u16,
    #[doc = "RC channel 2 value. A value of UINT16_MAX means to ignore this field. A value of 0 means to release this channel back to the RC radio."]
    pub chan2_raw: u16,
    #[doc = "RC channel 3 value. A value of UINT16_MAX means to ignore this field. A value of 0 means to release this channel back to the RC radio."]
    pub chan3_raw: u16,
    #[doc = "RC channel 4 value. A value of UINT16_MAX means to ignore this field. A value of 0 means to release this channel back to the RC radio."]
    pub chan4_raw: u16,
    #[doc = "RC channel 5 value. A value of UINT16_MAX means to ignore this field. A value of 0 means to release this channel back to the RC radio."]
    pub chan5_raw: u16,
    #[doc = "RC channel 6 value. A value of UINT16_MAX means to ignore this field. A value of 0 means to release this channel back to the RC radio."]
    pub chan6_raw: u16,
    #[doc = "RC channel 7 value. A value of UINT16_MAX means to ignore this field. A value of 0 means to release this channel back to the RC radio."]
    pub chan7_raw: u16,
    #[doc = "RC channel 8 value. A value of UINT16_MAX means to ignore this field. A value of 0 means to release this channel back to the RC radio."]
    pub chan8_raw: u16,
    #[doc = "System ID"]
    pub target_system: u8,
    #[doc = "Component ID"]
    pub target_component: u8,
    #[doc = "RC channel 9 value. A value of 0 or UINT16_MAX means to ignore this field. A value of UINT16_MAX-1 means to release this channel back to the RC radio."]
    pub chan9_raw: u16,
    #[doc = "RC channel 10 value. A value of 0 or UINT16_MAX means to ignore this field. A value of UINT16_MAX-1 means to release this channel back to the RC radio."]
    pub chan10_raw: u16,
    #[doc = "RC channel 11 value. A value of 0 or UINT16_MAX means to ignore this field. A value of UINT16_MAX-1 means to release this channel back to the RC radio."]
    pub chan11_raw: u16,
    #[doc = "RC channel 12 value. A value of 0 or UINT16_MAX means to ignore this field. A value of UINT16_MAX-1 means to release this channel back to the RC radio."]
    pub chan12_raw: u16,
    #[doc = "RC channel 13 value. A value of 0 or UINT16_MAX means to ignore this field. A value of UINT16_MAX-1 means to release this channel back to the RC radio."]
    pub chan13_raw: u16,
    #[doc = "RC channel 14 value. A value of 0 or UINT16_MAX means to ignore this field. A value of UINT16_MAX-1 means to release this channel back to the RC radio."]
    pub chan14_raw: u16,
    #[doc = "RC channel 15 value. A value of 0 or UINT16_MAX means to ignore this field. A value of UINT16_MAX-1 means to release this channel back to the RC radio."]
    pub chan15_raw: u16,
    #[doc = "RC channel 16 value. A value of 0 or UINT16_MAX means to ignore this field. A value of UINT16_MAX-1 means to release this channel back to the RC radio."]
    pub chan16_raw: u16,
    #[doc = "RC channel 17 value. A value of 0 or UINT16_MAX means to ignore this field. A value of UINT16_MAX-1 means to release this channel back to the RC radio."]
    pub chan17_raw: u16,
    #[doc = "RC channel 18 value. A value of 0 or UINT16_MAX means to ignore this field. A value of UINT16_MAX-1 means to release this channel back to the RC radio."]
    pub chan18_raw: u16,
}
impl RC_CHANNELS_OVERRIDE_DATA {
    pub const ENCODED_LEN: usize = 38usize;
    pub const DEFAULT: Self = Self {
        chan1_raw: 0_u16,
        chan2_raw: 0_u16,
        chan3_raw: 0_u16,
        chan4_raw: 0_u16,
        chan5_raw: 0_u16,
        chan6_raw: 0_u16,
        chan7_raw: 0_u16,
        chan8_raw: 0_u16,
        target_system: 0_u8,
        target_component: 0_u8,
        chan9_raw: 0_u16,
        chan10_raw: 0_u16,
        chan11_raw: 0_u16,
        chan12_raw: 0_u16,
        chan13_raw: 0_u16,
        chan14_raw: 0_u16,
        chan15_raw: 0_u16,
        chan16_raw: 0_u16,
        chan17_raw: 0_u16,
        chan18_raw: 0_u16,
    };
}
impl Default for RC_CHANNELS_OVERRIDE_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for RC_CHANNELS_OVERRIDE_DATA {
    type Message = MavMessage;
    const ID: u32 = 70u32;
    const NAME: &'static str = "RC_CHANNELS_OVERRIDE";
    const EXTRA_CRC: u8 = 124u8;
    const ENCODED_LEN: usize = 38usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.chan1_raw = buf.get_u16_le()?;
        __struct.chan2_raw = buf.get_u16_le()?;
        __struct.chan3_raw = buf.get_u16_le()?;
        __struct.chan4_raw = buf.get_u16_le()?;
        __struct.chan5_raw = buf.get_u16_le()?;
        __struct.chan6_raw = buf.get_u16_le()?;
        __struct.chan7_raw = buf.get_u16_le()?;
        __struct.chan8_raw = buf.get_u16_le()?;
        __struct.target_system = buf.get_u8()?;
        __struct.target_component = buf.get_u8()?;
        __struct.chan9_raw = buf.get_u16_le()?;
        __struct.chan10_raw = buf.get_u16_le()?;
        __struct.chan11_raw = buf.get_u16_le()?;
        __struct.chan12_raw = buf.get_u16_le()?;
        __struct.chan13_raw = buf.get_u16_le()?;
        __struct.chan14_raw = buf.get_u16_le()?;
        __struct.chan15_raw = buf.get_u16_le()?;
        __struct.chan16_raw = buf.get_u16_le()?;
        __struct.chan17_raw = buf.get_u16_le()?;
        __struct.chan18_raw = buf.get_u16_le()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u16_le(self.chan1_raw);
        __tmp.put_u16_le(self.chan2_raw);
        __tmp.put_u16_le(self.chan3_raw);
        __tmp.put_u16_le(self.chan4_raw);
        __tmp.put_u16_le(self.chan5_raw);
        __tmp.put_u16_le(self.chan6_raw);
        __tmp.put_u16_le(self.chan7_raw);
        __tmp.put_u16_le(self.chan8_raw);
        __tmp.put_u8(self.target_system);
        __tmp.put_u8(self.target_component);
        if matches!(version, MavlinkVersion::V2) {
            __tmp.put_u16_le(self.chan9_raw);
            __tmp.put_u16_le(self.chan10_raw);
            __tmp.put_u16_le(self.chan11_raw);
            __tmp.put_u16_le(self.chan12_raw);
            __tmp.put_u16_le(self.chan13_raw);
            __tmp.put_u16_le(self.chan14_raw);
            __tmp.put_u16_le(self.chan15_raw);
            __tmp.put_u16_le(self.chan16_raw);
            __tmp.put_u16_le(self.chan17_raw);
            __tmp.put_u16_le(self.chan18_raw);
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[deprecated = " See `MAV_CMD_SET_MESSAGE_INTERVAL ` (Superseded since 2015-08)"]
#[doc = "Request a data stream."]
#[doc = ""]
#[doc = "ID: 66"]
#[derive(Debug, Clone, PartialEq)]
pub struct REQUEST_DATA_STREAM_DATA {
    #[doc = "The requested message rate"]
    pub req_message_rate: u16,
    #[doc = "The target requested to send the message stream."]
    pub target_system: u8,
    #[doc = "The target requested to send the message stream."]
    pub target_component: u8,
    #[doc = "The ID of the requested data stream."]
    pub req_stream_id: u8,
    #[doc = "1 to start sending, 0 to stop sending."]
    pub start_stop: u8,
}
impl REQUEST_DATA_STREAM_DATA {
    pub const ENCODED_LEN: usize = 6usize;
    pub const DEFAULT: Self = Self {
        req_message_rate: 0_u16,
        target_system: 0_u8,
        target_component: 0_u8,
        req_stream_id: 0_u8,
        start_stop: 0_u8,
    };
}
impl Default for REQUEST_DATA_STREAM_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for REQUEST_DATA_STREAM_DATA {
    type Message = MavMessage;
    const ID: u32 = 66u32;
    const NAME: &'static str = "REQUEST_DATA_STREAM";
    const EXTRA_CRC: u8 = 148u8;
    const ENCODED_LEN: usize = 6usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.req_message_rate = buf.get_u16_le()?;
        __struct.target_system = buf.get_u8()?;
        __struct.target_component = buf.get_u8()?;
        __struct.req_stream_id = buf.get_u8()?;
        __struct.start_stop = buf.get_u8()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u16_le(self.req_message_rate);
        __tmp.put_u8(self.target_system);
        __tmp.put_u8(self.target_component);
        __tmp.put_u8(self.req_stream_id);
        __tmp.put_u8(self.start_stop);
        if matches!(version, MavlinkVersion::V2) {
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Setup a MAVLink2 signing key. If called with secret_key of all zero and zero initial_timestamp will disable signing."]
#[doc = ""]
#[doc = "ID: 256"]
#[derive(Debug, Clone, PartialEq)]
pub struct SETUP_SIGNING_DATA {
    #[doc = "initial timestamp"]
    pub initial_timestamp: u64,
    #[doc = "system id of the target"]
    pub target_system: u8,
    #[doc = "component ID of the target"]
    pub target_component: u8,
    #[doc = "signing key"]
    pub secret_key: [u8; 32],
}
impl SETUP_SIGNING_DATA {
    pub const ENCODED_LEN: usize = 42usize;
    pub const DEFAULT: Self = Self {
        initial_timestamp: 0_u64,
        target_system: 0_u8,
        target_component: 0_u8,
        secret_key: [0_u8; 32usize],
    };
}
impl Default for SETUP_SIGNING_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for SETUP_SIGNING_DATA {
    type Message = MavMessage;
    const ID: u32 = 256u32;
    const NAME: &'static str = "SETUP_SIGNING";
    const EXTRA_CRC: u8 = 71u8;
    const ENCODED_LEN: usize = 42usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.initial_timestamp = buf.get_u64_le()?;
        __struct.target_system = buf.get_u8()?;
        __struct.target_component = buf.get_u8()?;
        for v in &mut __struct.secret_key {
            let val = buf.get_u8()?;
            *v = val;
        }
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u64_le(self.initial_timestamp);
        __tmp.put_u8(self.target_system);
        __tmp.put_u8(self.target_component);
        for val in &self.secret_key {
            __tmp.put_u8(*val);
        }
        if matches!(version, MavlinkVersion::V2) {
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Sets a desired vehicle attitude. Used by an external controller to command the vehicle (manual controller or other system)."]
#[doc = ""]
#[doc = "ID: 82"]
#[derive(Debug, Clone, PartialEq)]
pub struct SET_ATTITUDE_TARGET_DATA {
    #[doc = "Timestamp (time since system boot)."]
    pub time_boot_ms: u32,
    #[doc = "Attitude quaternion (w, x, y, z order, zero-rotation is 1, 0, 0, 0) from MAV_FRAME_LOCAL_NED to MAV_FRAME_BODY_FRD"]
    pub q: [f32; 4],
    #[doc = "Body roll rate"]
    pub body_roll_rate: f32,
    #[doc = "Body pitch rate"]
    pub body_pitch_rate: f32,
    #[doc = "Body yaw rate"]
    pub body_yaw_rate: f32,
    #[doc = "Collective thrust, normalized to 0 .. 1 (-1 .. 1 for vehicles capable of reverse thrust)"]
    pub thrust: f32,
    #[doc = "System ID"]
    pub target_system: u8,
    #[doc = "Component ID"]
    pub target_component: u8,
    #[doc = "Bitmap to indicate which dimensions should be ignored by the vehicle."]
    pub type_mask: AttitudeTargetTypemask,
    #[doc = "3D thrust setpoint in the body NED frame, normalized to -1 .. 1"]
    pub thrust_body: [f32; 3],
}
impl SET_ATTITUDE_TARGET_DATA {
    pub const ENCODED_LEN: usize = 51usize;
    pub const DEFAULT: Self = Self {
        time_boot_ms: 0_u32,
        q: [0.0_f32; 4usize],
        body_roll_rate: 0.0_f32,
        body_pitch_rate: 0.0_f32,
        body_yaw_rate: 0.0_f32,
        thrust: 0.0_f32,
        target_system: 0_u8,
        target_component: 0_u8,
        type_mask: AttitudeTargetTypemask::DEFAULT,
        thrust_body: [0.0_f32; 3usize],
    };
}
impl Default for SET_ATTITUDE_TARGET_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for SET_ATTITUDE_TARGET_DATA {
    type Message = MavMessage;
    const ID: u32 = 82u32;
    const NAME: &'static str = "SET_ATTITUDE_TARGET";
    const EXTRA_CRC: u8 = 49u8;
    const ENCODED_LEN: usize = 51usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.time_boot_ms = buf.get_u32_le()?;
        for v in &mut __struct.q {
            let val = buf.get_f32_le()?;
            *v = val;
        }
        __struct.body_roll_rate = buf.get_f32_le()?;
        __struct.body_pitch_rate = buf.get_f32_le()?;
        __struct.body_yaw_rate = buf.get_f32_le()?;
        __struct.thrust = buf.get_f32_le()?;
        __struct.target_system = buf.get_u8()?;
        __struct.target_component = buf.get_u8()?;
        let tmp = buf.get_u8()?;
        __struct.type_mask = AttitudeTargetTypemask::from_bits_retain(
            tmp as <AttitudeTargetTypemask as Flags>::Bits,
        );
        for v in &mut __struct.thrust_body {
            let val = buf.get_f32_le()?;
            *v = val;
        }
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u32_le(self.time_boot_ms);
        for val in &self.q {
            __tmp.put_f32_le(*val);
        }
        __tmp.put_f32_le(self.body_roll_rate);
        __tmp.put_f32_le(self.body_pitch_rate);
        __tmp.put_f32_le(self.body_yaw_rate);
        __tmp.put_f32_le(self.thrust);
        __tmp.put_u8(self.target_system);
        __tmp.put_u8(self.target_component);
        __tmp.put_u8(self.type_mask.bits() as u8);
        if matches!(version, MavlinkVersion::V2) {
            for val in &self.thrust_body {
                __tmp.put_f32_le(*val);
            }
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[deprecated = " See `MAV_CMD_DO_SET_GLOBAL_ORIGIN` (Superseded since 2025-04)"]
#[doc = "Sets the GPS coordinates of the vehicle local origin (0,0,0) position. Vehicle should emit GPS_GLOBAL_ORIGIN irrespective of whether the origin is changed. This enables transform between the local coordinate frame and the global (GPS) coordinate frame, which may be necessary when (for example) indoor and outdoor settings are connected and the MAV should move from in- to outdoor."]
#[doc = ""]
#[doc = "ID: 48"]
#[derive(Debug, Clone, PartialEq)]
pub struct SET_GPS_GLOBAL_ORIGIN_DATA {
    #[doc = "Latitude (WGS84)"]
    pub latitude: i32,
    #[doc = "Longitude (WGS84)"]
    pub longitude: i32,
    #[doc = "Altitude (MSL). Positive for up."]
    pub altitude: i32,
    #[doc = "System ID"]
    pub target_system: u8,
    #[doc = "Timestamp (UNIX Epoch time or time since system boot). The receiving end can infer timestamp format (since 1.1.1970 or since system boot) by checking for the magnitude of the number."]
    pub time_usec: u64,
}
impl SET_GPS_GLOBAL_ORIGIN_DATA {
    pub const ENCODED_LEN: usize = 21usize;
    pub const DEFAULT: Self = Self {
        latitude: 0_i32,
        longitude: 0_i32,
        altitude: 0_i32,
        target_system: 0_u8,
        time_usec: 0_u64,
    };
}
impl Default for SET_GPS_GLOBAL_ORIGIN_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for SET_GPS_GLOBAL_ORIGIN_DATA {
    type Message = MavMessage;
    const ID: u32 = 48u32;
    const NAME: &'static str = "SET_GPS_GLOBAL_ORIGIN";
    const EXTRA_CRC: u8 = 41u8;
    const ENCODED_LEN: usize = 21usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.latitude = buf.get_i32_le()?;
        __struct.longitude = buf.get_i32_le()?;
        __struct.altitude = buf.get_i32_le()?;
        __struct.target_system = buf.get_u8()?;
        __struct.time_usec = buf.get_u64_le()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_i32_le(self.latitude);
        __tmp.put_i32_le(self.longitude);
        __tmp.put_i32_le(self.altitude);
        __tmp.put_u8(self.target_system);
        if matches!(version, MavlinkVersion::V2) {
            __tmp.put_u64_le(self.time_usec);
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[deprecated = "The command protocol version (MAV_CMD_DO_SET_HOME) allows a GCS to detect when setting the home position has failed. See `MAV_CMD_DO_SET_HOME` (Superseded since 2022-02)"]
#[doc = "Sets the home position.         The home position is the default position that the system will return to and land on.         The position is set automatically by the system during the takeoff (and may also be set using this message).         The global and local positions encode the position in the respective coordinate frames, while the q parameter encodes the orientation of the surface.         Under normal conditions it describes the heading and terrain slope, which can be used by the aircraft to adjust the approach.         The approach 3D vector describes the point to which the system should fly in normal flight mode and then perform a landing sequence along the vector.         Note: the current home position may be emitted in a HOME_POSITION message on request (using MAV_CMD_REQUEST_MESSAGE with param1=242)."]
#[doc = ""]
#[doc = "ID: 243"]
#[derive(Debug, Clone, PartialEq)]
pub struct SET_HOME_POSITION_DATA {
    #[doc = "Latitude (WGS84)"]
    pub latitude: i32,
    #[doc = "Longitude (WGS84)"]
    pub longitude: i32,
    #[doc = "Altitude (MSL). Positive for up."]
    pub altitude: i32,
    #[doc = "Local X position of this position in the local coordinate frame (NED)"]
    pub x: f32,
    #[doc = "Local Y position of this position in the local coordinate frame (NED)"]
    pub y: f32,
    #[doc = "Local Z position of this position in the local coordinate frame (NED: positive \"down\")"]
    pub z: f32,
    #[doc = "World to surface normal and heading transformation of the takeoff position. Used to indicate the heading and slope of the ground"]
    pub q: [f32; 4],
    #[doc = "Local X position of the end of the approach vector. Multicopters should set this position based on their takeoff path. Grass-landing fixed wing aircraft should set it the same way as multicopters. Runway-landing fixed wing aircraft should set it to the opposite direction of the takeoff, assuming the takeoff happened from the threshold / touchdown zone."]
    pub approach_x: f32,
    #[doc = "Local Y position of the end of the approach vector. Multicopters should set this position based on their takeoff path. Grass-landing fixed wing aircraft should set it the same way as multicopters. Runway-landing fixed wing aircraft should set it to the opposite direction of the takeoff, assuming the takeoff happened from the threshold / touchdown zone."]
    pub approach_y: f32,
    #[doc = "Local Z position of the end of the approach vector. Multicopters should set this position based on their takeoff path. Grass-landing fixed wing aircraft should set it the same way as multicopters. Runway-landing fixed wing aircraft should set it to the opposite direction of the takeoff, assuming the takeoff happened from the threshold / touchdown zone."]
    pub approach_z: f32,
    #[doc = "System ID."]
    pub target_system: u8,
    #[doc = "Timestamp (UNIX Epoch time or time since system boot). The receiving end can infer timestamp format (since 1.1.1970 or since system boot) by checking for the magnitude of the number."]
    pub time_usec: u64,
}
impl SET_HOME_POSITION_DATA {
    pub const ENCODED_LEN: usize = 61usize;
    pub const DEFAULT: Self = Self {
        latitude: 0_i32,
        longitude: 0_i32,
        altitude: 0_i32,
        x: 0.0_f32,
        y: 0.0_f32,
        z: 0.0_f32,
        q: [0.0_f32; 4usize],
        approach_x: 0.0_f32,
        approach_y: 0.0_f32,
        approach_z: 0.0_f32,
        target_system: 0_u8,
        time_usec: 0_u64,
    };
}
impl Default for SET_HOME_POSITION_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for SET_HOME_POSITION_DATA {
    type Message = MavMessage;
    const ID: u32 = 243u32;
    const NAME: &'static str = "SET_HOME_POSITION";
    const EXTRA_CRC: u8 = 85u8;
    const ENCODED_LEN: usize = 61usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.latitude = buf.get_i32_le()?;
        __struct.longitude = buf.get_i32_le()?;
        __struct.altitude = buf.get_i32_le()?;
        __struct.x = buf.get_f32_le()?;
        __struct.y = buf.get_f32_le()?;
        __struct.z = buf.get_f32_le()?;
        for v in &mut __struct.q {
            let val = buf.get_f32_le()?;
            *v = val;
        }
        __struct.approach_x = buf.get_f32_le()?;
        __struct.approach_y = buf.get_f32_le()?;
        __struct.approach_z = buf.get_f32_le()?;
        __struct.target_system = buf.get_u8()?;
        __struct.time_usec = buf.get_u64_le()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_i32_le(self.latitude);
        __tmp.put_i32_le(self.longitude);
        __tmp.put_i32_le(self.altitude);
        __tmp.put_f32_le(self.x);
        __tmp.put_f32_le(self.y);
        __tmp.put_f32_le(self.z);
        for val in &self.q {
            __tmp.put_f32_le(*val);
        }
        __tmp.put_f32_le(self.approach_x);
        __tmp.put_f32_le(self.approach_y);
        __tmp.put_f32_le(self.approach_z);
        __tmp.put_u8(self.target_system);
        if matches!(version, MavlinkVersion::V2) {
            __tmp.put_u64_le(self.time_usec);
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[deprecated = "Use COMMAND_LONG with MAV_CMD_DO_SET_MODE instead. See `MAV_CMD_DO_SET_MODE` (Superseded since 2015-12)"]
#[doc = "Set the system mode, as defined by enum MAV_MODE_FLAG. There is no target component id as the mode is by definition for the overall aircraft, not only for one component."]
#[doc = ""]
#[doc = "ID: 11"]
#[derive(Debug, Clone, PartialEq)]
pub struct SET_MODE_DATA {
    #[doc = "The new autopilot-specific mode. This field can be ignored by an autopilot."]
    pub custom_mode: u32,
    #[doc = "The system setting the mode"]
    pub target_system: u8,
    #[doc = "The new base mode."]
    pub base_mode: MavModeFlag,
}
impl SET_MODE_DATA {
    pub const ENCODED_LEN: usize = 6usize;
    pub const DEFAULT: Self =
        Self { custom_mode: 0_u32, target_system: 0_u8, base_mode: MavModeFlag::DEFAULT };
}
impl Default for SET_MODE_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for SET_MODE_DATA {
    type Message = MavMessage;
    const ID: u32 = 11u32;
    const NAME: &'static str = "SET_MODE";
    const EXTRA_CRC: u8 = 89u8;
    const ENCODED_LEN: usize = 6usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.custom_mode = buf.get_u32_le()?;
        __struct.target_system = buf.get_u8()?;
        let tmp = buf.get_u8()?;
        __struct.base_mode = MavModeFlag::from_bits_retain(tmp as <MavModeFlag as Flags>::Bits);
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u32_le(self.custom_mode);
        __tmp.put_u8(self.target_system);
        __tmp.put_u8(self.base_mode.bits() as u8);
        if matches!(version, MavlinkVersion::V2) {
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Sets a desired vehicle position, velocity, and/or acceleration in a global coordinate system (WGS84). Used by an external controller to command the vehicle (manual controller or other system)."]
#[doc = ""]
#[doc = "ID: 86"]
#[derive(Debug, Clone, PartialEq)]
pub struct SET_POSITION_TARGET_GLOBAL_INT_DATA {
    #[doc = "Timestamp (time since system boot). The rationale for the timestamp in the setpoint is to allow the system to compensate for the transport delay of the setpoint. This allows the system to compensate processing latency."]
    pub time_boot_ms: u32,
    #[doc = "Latitude in WGS84 frame"]
    pub lat_int: i32,
    #[doc = "Longitude in WGS84 frame"]
    pub lon_int: i32,
    #[doc = "Altitude (MSL, Relative to home, or AGL - depending on frame)"]
    pub alt: f32,
    #[doc = "X velocity in NED frame"]
    pub vx: f32,
    #[doc = "Y velocity in NED frame"]
    pub vy: f32,
    #[doc = "Z velocity in NED frame"]
    pub vz: f32,
    #[doc = "X acceleration or force (if bit 10 of type_mask is set) in NED frame in meter / s^2 or N"]
    pub afx: f32,
    #[doc = "Y acceleration or force (if bit 10 of type_mask is set) in NED frame in meter / s^2 or N"]
    pub afy: f32,
    #[doc = "Z acceleration or force (if bit 10 of type_mask is set) in NED frame in meter / s^2 or N"]
    pub afz: f32,
    #[doc = "yaw setpoint"]
    pub yaw: f32,
    #[doc = "yaw rate setpoint"]
    pub yaw_rate: f32,
    #[doc = "Bitmap to indicate which dimensions should be ignored by the vehicle."]
    pub type_mask: PositionTargetTypemask,
    #[doc = "System ID"]
    pub target_system: u8,
    #[doc = "Component ID"]
    pub target_component: u8,
    #[doc = "Valid options are: MAV_FRAME_GLOBAL = 0, MAV_FRAME_GLOBAL_RELATIVE_ALT = 3, MAV_FRAME_GLOBAL_TERRAIN_ALT = 10 (MAV_FRAME_GLOBAL_INT, MAV_FRAME_GLOBAL_RELATIVE_ALT_INT, MAV_FRAME_GLOBAL_TERRAIN_ALT_INT are allowed synonyms, but have been deprecated)"]
    pub coordinate_frame: u8,
}
impl SET_POSITION_TARGET_GLOBAL_INT_DATA {
    pub const ENCODED_LEN: usize = 53usize;
    pub const DEFAULT: Self = Self {
        time_boot_ms: 0_u32,
        lat_int: 0_i32,
        lon_int: 0_i32,
        alt: 0.0_f32,
        vx: 0.0_f32,
        vy: 0.0_f32,
        vz: 0.0_f32,
        afx: 0.0_f32,
        afy: 0.0_f32,
        afz: 0.0_f32,
        yaw: 0.0_f32,
        yaw_rate: 0.0_f32,
        type_mask: PositionTargetTypemask::DEFAULT,
        target_system: 0_u8,
        target_component: 0_u8,
        coordinate_frame: 0_u8,
    };
}
impl Default for SET_POSITION_TARGET_GLOBAL_INT_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for SET_POSITION_TARGET_GLOBAL_INT_DATA {
    type Message = MavMessage;
    const ID: u32 = 86u32;
    const NAME: &'static str = "SET_POSITION_TARGET_GLOBAL_INT";
    const EXTRA_CRC: u8 = 5u8;
    const ENCODED_LEN: usize = 53usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.time_boot_ms = buf.get_u32_le()?;
        __struct.lat_int = buf.get_i32_le()?;
        __struct.lon_int = buf.get_i32_le()?;
        __struct.alt = buf.get_f32_le()?;
        __struct.vx = buf.get_f32_le()?;
        __struct.vy = buf.get_f32_le()?;
        __struct.vz = buf.get_f32_le()?;
        __struct.afx = buf.get_f32_le()?;
        __struct.afy = buf.get_f32_le()?;
        __struct.afz = buf.get_f32_le()?;
        __struct.yaw = buf.get_f32_le()?;
        __struct.yaw_rate = buf.get_f32_le()?;
        let tmp = buf.get_u16_le()?;
        __struct.type_mask = PositionTargetTypemask::from_bits_retain(
            tmp as <PositionTargetTypemask as Flags>::Bits,
        );
        __struct.target_system = buf.get_u8()?;
        __struct.target_component = buf.get_u8()?;
        __struct.coordinate_frame = buf.get_u8()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u32_le(self.time_boot_ms);
        __tmp.put_i32_le(self.lat_int);
        __tmp.put_i32_le(self.lon_int);
        __tmp.put_f32_le(self.alt);
        __tmp.put_f32_le(self.vx);
        __tmp.put_f32_le(self.vy);
        __tmp.put_f32_le(self.vz);
        __tmp.put_f32_le(self.afx);
        __tmp.put_f32_le(self.afy);
        __tmp.put_f32_le(self.afz);
        __tmp.put_f32_le(self.yaw);
        __tmp.put_f32_le(self.yaw_rate);
        __tmp.put_u16_le(self.type_mask.bits() as u16);
        __tmp.put_u8(self.target_system);
        __tmp.put_u8(self.target_component);
        __tmp.put_u8(self.coordinate_frame);
        if matches!(version, MavlinkVersion::V2) {
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Sets a desired vehicle position in a local north-east-down coordinate frame. Used by an external controller to command the vehicle (manual controller or other system)."]
#[doc = ""]
#[doc = "ID: 84"]
#[derive(Debug, Clone, PartialEq)]
pub struct SET_POSITION_TARGET_LOCAL_NED_DATA {
    #[doc = "Timestamp (time since system boot)."]
    pub time_boot_ms: u32,
    #[doc = "X Position in NED frame"]
    pub x: f32,
    #[doc = "Y Position in NED frame"]
    pub y: f32,
    #[doc = "Z Position in NED frame (note, altitude is negative in NED)"]
    pub z: f32,
    #[doc = "X velocity in NED frame"]
    pub vx: f32,
    #[doc = "Y velocity in NED frame"]
    pub vy: f32,
    #[doc = "Z velocity in NED frame"]
    pub vz: f32,
    #[doc = "X acceleration or force (if bit 10 of type_mask is set) in NED frame in meter / s^2 or N"]
    pub afx: f32,
    #[doc = "Y acceleration or force (if bit 10 of type_mask is set) in NED frame in meter / s^2 or N"]
    pub afy: f32,
    #[doc = "Z acceleration or force (if bit 10 of type_mask is set) in NED frame in meter / s^2 or N"]
    pub afz: f32,
    #[doc = "yaw setpoint"]
    pub yaw: f32,
    #[doc = "yaw rate setpoint"]
    pub yaw_rate: f32,
    #[doc = "Bitmap to indicate which dimensions should be ignored by the vehicle."]
    pub type_mask: PositionTargetTypemask,
    #[doc = "System ID"]
    pub target_system: u8,
    #[doc = "Component ID"]
    pub target_component: u8,
    #[doc = "Valid options are: MAV_FRAME_LOCAL_NED = 1, MAV_FRAME_LOCAL_OFFSET_NED = 7, MAV_FRAME_BODY_NED = 8, MAV_FRAME_BODY_OFFSET_NED = 9"]
    pub coordinate_frame: u8,
}
impl SET_POSITION_TARGET_LOCAL_NED_DATA {
    pub const ENCODED_LEN: usize = 53usize;
    pub const DEFAULT: Self = Self {
        time_boot_ms: 0_u32,
        x: 0.0_f32,
        y: 0.0_f32,
        z: 0.0_f32,
        vx: 0.0_f32,
        vy: 0.0_f32,
        vz: 0.0_f32,
        afx: 0.0_f32,
        afy: 0.0_f32,
        afz: 0.0_f32,
        yaw: 0.0_f32,
        yaw_rate: 0.0_f32,
        type_mask: PositionTargetTypemask::DEFAULT,
        target_system: 0_u8,
        target_component: 0_u8,
        coordinate_frame: 0_u8,
    };
}
impl Default for SET_POSITION_TARGET_LOCAL_NED_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for SET_POSITION_TARGET_LOCAL_NED_DATA {
    type Message = MavMessage;
    const ID: u32 = 84u32;
    const NAME: &'static str = "SET_POSITION_TARGET_LOCAL_NED";
    const EXTRA_CRC: u8 = 143u8;
    const ENCODED_LEN: usize = 53usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.time_boot_ms = buf.get_u32_le()?;
        __struct.x = buf.get_f32_le()?;
        __struct.y = buf.get_f32_le()?;
        __struct.z = buf.get_f32_le()?;
        __struct.vx = buf.get_f32_le()?;
        __struct.vy = buf.get_f32_le()?;
        __struct.vz = buf.get_f32_le()?;
        __struct.afx = buf.get_f32_le()?;
        __struct.afy = buf.get_f32_le()?;
        __struct.afz = buf.get_f32_le()?;
        __struct.yaw = buf.get_f32_le()?;
        __struct.yaw_rate = buf.get_f32_le()?;
        let tmp = buf.get_u16_le()?;
        __struct.type_mask = PositionTargetTypemask::from_bits_retain(
            tmp as <PositionTargetTypemask as Flags>::Bits,
        );
        __struct.target_system = buf.get_u8()?;
        __struct.target_component = buf.get_u8()?;
        __struct.coordinate_frame = buf.get_u8()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u32_le(self.time_boot_ms);
        __tmp.put_f32_le(self.x);
        __tmp.put_f32_le(self.y);
        __tmp.put_f32_le(self.z);
        __tmp.put_f32_le(self.vx);
        __tmp.put_f32_le(self.vy);
        __tmp.put_f32_le(self.vz);
        __tmp.put_f32_le(self.afx);
        __tmp.put_f32_le(self.afy);
        __tmp.put_f32_le(self.afz);
        __tmp.put_f32_le(self.yaw);
        __tmp.put_f32_le(self.yaw_rate);
        __tmp.put_u16_le(self.type_mask.bits() as u16);
        __tmp.put_u8(self.target_system);
        __tmp.put_u8(self.target_component);
        __tmp.put_u8(self.coordinate_frame);
        if matches!(version, MavlinkVersion::V2) {
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Status text message. These messages are printed in yellow in the COMM console of QGroundControl. WARNING: They consume quite some bandwidth, so use only for important status and error messages. If implemented wisely, these messages are buffered on the MCU and sent only at a limited rate (e.g. 10 Hz)."]
#[doc = ""]
#[doc = "ID: 253"]
#[derive(Debug, Clone, PartialEq)]
pub struct STATUSTEXT_DATA {
    #[doc = "Severity of status. Relies on the definitions within RFC-5424."]
    pub severity: MavSeverity,
    #[doc = "Status text message, without null termination character. UTF-8 encoded."]
    pub text: CharArray<50>,
    #[doc = "Unique (opaque) identifier for this statustext message.  May be used to reassemble a logical long-statustext message from a sequence of chunks.  A value of zero indicates this is the only chunk in the sequence and the message can be emitted immediately."]
    pub id: u16,
    #[doc = "This chunk's sequence number; indexing is from zero.  Any null character in the text field is taken to mean this was the last chunk."]
    pub chunk_seq: u8,
}
impl STATUSTEXT_DATA {
    pub const ENCODED_LEN: usize = 54usize;
    pub const DEFAULT: Self = Self {
        severity: MavSeverity::DEFAULT,
        text: CharArray::new([0_u8; 50usize]),
        id: 0_u16,
        chunk_seq: 0_u8,
    };
}
impl Default for STATUSTEXT_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for STATUSTEXT_DATA {
    type Message = MavMessage;
    const ID: u32 = 253u32;
    const NAME: &'static str = "STATUSTEXT";
    const EXTRA_CRC: u8 = 83u8;
    const ENCODED_LEN: usize = 54usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        let tmp = buf.get_u8()?;
        __struct.severity =
            FromPrimitive::from_u8(tmp).ok_or(::mavlink_core::error::ParserError::InvalidEnum {
                enum_type: "MavSeverity",
                value: tmp as u64,
            })?;
        let mut tmp = [0_u8; 50usize];
        for v in &mut tmp {
            *v = buf.get_u8()?;
        }
        __struct.text = CharArray::new(tmp);
        __struct.id = buf.get_u16_le()?;
        __struct.chunk_seq = buf.get_u8()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u8(self.severity as u8);
        for val in &self.text {
            __tmp.put_u8(*val);
        }
        if matches!(version, MavlinkVersion::V2) {
            __tmp.put_u16_le(self.id);
            __tmp.put_u8(self.chunk_seq);
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "The system time is the time of the sender's master clock.         This can be emitted by flight controllers, onboard computers, or other components in the MAVLink network.         Components that are using a less reliable time source, such as a battery-backed real time clock, can choose to match their system clock to that of a system that indicates a more recent time.         This allows more broadly accurate date stamping of logs, and so on.         If precise time synchronization is needed then use TIMESYNC instead."]
#[doc = ""]
#[doc = "ID: 2"]
#[derive(Debug, Clone, PartialEq)]
pub struct SYSTEM_TIME_DATA {
    #[doc = "Timestamp (UNIX epoch time)."]
    pub time_unix_usec: u64,
    #[doc = "Timestamp (time since system boot)."]
    pub time_boot_ms: u32,
}
impl SYSTEM_TIME_DATA {
    pub const ENCODED_LEN: usize = 12usize;
    pub const DEFAULT: Self = Self { time_unix_usec: 0_u64, time_boot_ms: 0_u32 };
}
impl Default for SYSTEM_TIME_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for SYSTEM_TIME_DATA {
    type Message = MavMessage;
    const ID: u32 = 2u32;
    const NAME: &'static str = "SYSTEM_TIME";
    const EXTRA_CRC: u8 = 137u8;
    const ENCODED_LEN: usize = 12usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.time_unix_usec = buf.get_u64_le()?;
        __struct.time_boot_ms = buf.get_u32_le()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u64_le(self.time_unix_usec);
        __tmp.put_u32_le(self.time_boot_ms);
        if matches!(version, MavlinkVersion::V2) {
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Sensor and subsystem status information. Provides a compact representation of sensor/subsystem status and a few other basic statistics."]
#[doc = ""]
#[doc = "ID: 1"]
#[derive(Debug, Clone, PartialEq)]
pub struct SYS_STATUS_DATA {
    #[doc = "Bitmap showing which onboard controllers and sensors are present. Value of 0: not present. Value of 1: present."]
    pub onboard_control_sensors_present: MavSysStatusSensor,
    #[doc = "Bitmap showing which onboard controllers and sensors are enabled:  Value of 0: not enabled. Value of 1: enabled."]
    pub onboard_control_sensors_enabled: MavSysStatusSensor,
    #[doc = "Bitmap showing which onboard controllers and sensors have an error (or are operational). Value of 0: error. Value of 1: healthy."]
    pub onboard_control_sensors_health: MavSysStatusSensor,
    #[doc = "Maximum usage in percent of the mainloop time. Values: [0-1000] - should always be below 1000"]
    pub load: u16,
    #[doc = "Battery voltage, UINT16_MAX: Voltage not sent by autopilot. Value is ambiguous on multi-battery systems. BATTERY_STATUS is a recommended alternative."]
    pub voltage_battery: u16,
    #[doc = "Battery current, -1: Current not sent by autopilot. Value may overflow/rollover for very high currents (>327.67A). Value is ambiguous on multi-battery systems. BATTERY_STATUS is a recommended alternative."]
    pub current_battery: i16,
    #[doc = "Communication drop rate, (UART, I2C, SPI, CAN), dropped packets on all links (packets that were corrupted on reception on the MAV)"]
    pub drop_rate_comm: u16,
    #[doc = "Communication errors (UART, I2C, SPI, CAN), dropped packets on all links (packets that were corrupted on reception on the MAV)"]
    pub errors_comm: u16,
    #[doc = "Autopilot-specific errors"]
    pub errors_count1: u16,
    #[doc = "Autopilot-specific errors"]
    pub errors_count2: u16,
    #[doc = "Autopilot-specific errors"]
    pub errors_count3: u16,
    #[doc = "Autopilot-specific errors"]
    pub errors_count4: u16,
    #[doc = "Battery energy remaining, -1: Battery remaining energy not sent by autopilot. Value is ambiguous on multi-battery systems. BATTERY_STATUS is a recommended alternative."]
    pub battery_remaining: i8,
    #[doc = "Bitmap showing which onboard controllers and sensors are present. Value of 0: not present. Value of 1: present."]
    pub onboard_control_sensors_present_extended: MavSysStatusSensorExtended,
    #[doc = "Bitmap showing which onboard controllers and sensors are enabled:  Value of 0: not enabled. Value of 1: enabled."]
    pub onboard_control_sensors_enabled_extended: MavSysStatusSensorExtended,
    #[doc = "Bitmap showing which onboard controllers and sensors have an error (or are operational). Value of 0: error. Value of 1: healthy."]
    pub onboard_control_sensors_health_extended: MavSysStatusSensorExtended,
}
impl SYS_STATUS_DATA {
    pub const ENCODED_LEN: usize = 43usize;
    pub const DEFAULT: Self = Self {
        onboard_control_sensors_present: MavSysStatusSensor::DEFAULT,
        onboard_control_sensors_enabled: MavSysStatusSensor::DEFAULT,
        onboard_control_sensors_health: MavSysStatusSensor::DEFAULT,
        load: 0_u16,
        voltage_battery: 0_u16,
        current_battery: 0_i16,
        drop_rate_comm: 0_u16,
        errors_comm: 0_u16,
        errors_count1: 0_u16,
        errors_count2: 0_u16,
        errors_count3: 0_u16,
        errors_count4: 0_u16,
        battery_remaining: 0_i8,
        onboard_control_sensors_present_extended: MavSysStatusSensorExtended::DEFAULT,
        onboard_control_sensors_enabled_extended: MavSysStatusSensorExtended::DEFAULT,
        onboard_control_sensors_health_extended: MavSysStatusSensorExtended::DEFAULT,
    };
}
impl Default for SYS_STATUS_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for SYS_STATUS_DATA {
    type Message = MavMessage;
    const ID: u32 = 1u32;
    const NAME: &'static str = "SYS_STATUS";
    const EXTRA_CRC: u8 = 124u8;
    const ENCODED_LEN: usize = 43usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        let tmp = buf.get_u32_le()?;
        __struct.onboard_control_sensors_present =
            MavSysStatusSensor::from_bits_retain(tmp as <MavSysStatusSensor as Flags>::Bits);
        let tmp = buf.get_u32_le()?;
        __struct.onboard_control_sensors_enabled =
            MavSysStatusSensor::from_bits_retain(tmp as <MavSysStatusSensor as Flags>::Bits);
        let tmp = buf.get_u32_le()?;
        __struct.onboard_control_sensors_health =
            MavSysStatusSensor::from_bits_retain(tmp as <MavSysStatusSensor as Flags>::Bits);
        __struct.load = buf.get_u16_le()?;
        __struct.voltage_battery = buf.get_u16_le()?;
        __struct.current_battery = buf.get_i16_le()?;
        __struct.drop_rate_comm = buf.get_u16_le()?;
        __struct.errors_comm = buf.get_u16_le()?;
        __struct.errors_count1 = buf.get_u16_le()?;
        __struct.errors_count2 = buf.get_u16_le()?;
        __struct.errors_count3 = buf.get_u16_le()?;
        __struct.errors_count4 = buf.get_u16_le()?;
        __struct.battery_remaining = buf.get_i8()?;
        let tmp = buf.get_u32_le()?;
        __struct.onboard_control_sensors_present_extended =
            MavSysStatusSensorExtended::from_bits_retain(
                tmp as <MavSysStatusSensorExtended as Flags>::Bits,
            );
        let tmp = buf.get_u32_le()?;
        __struct.onboard_control_sensors_enabled_extended =
            MavSysStatusSensorExtended::from_bits_retain(
                tmp as <MavSysStatusSensorExtended as Flags>::Bits,
            );
        let tmp = buf.get_u32_le()?;
        __struct.onboard_control_sensors_health_extended =
            MavSysStatusSensorExtended::from_bits_retain(
                tmp as <MavSysStatusSensorExtended as Flags>::Bits,
            );
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_u32_le(self.onboard_control_sensors_present.bits() as u32);
        __tmp.put_u32_le(self.onboard_control_sensors_enabled.bits() as u32);
        __tmp.put_u32_le(self.onboard_control_sensors_health.bits() as u32);
        __tmp.put_u16_le(self.load);
        __tmp.put_u16_le(self.voltage_battery);
        __tmp.put_i16_le(self.current_battery);
        __tmp.put_u16_le(self.drop_rate_comm);
        __tmp.put_u16_le(self.errors_comm);
        __tmp.put_u16_le(self.errors_count1);
        __tmp.put_u16_le(self.errors_count2);
        __tmp.put_u16_le(self.errors_count3);
        __tmp.put_u16_le(self.errors_count4);
        __tmp.put_i8(self.battery_remaining);
        if matches!(version, MavlinkVersion::V2) {
            __tmp.put_u32_le(self.onboard_control_sensors_present_extended.bits() as u32);
            __tmp.put_u32_le(self.onboard_control_sensors_enabled_extended.bits() as u32);
            __tmp.put_u32_le(self.onboard_control_sensors_health_extended.bits() as u32);
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Time synchronization message.         The message is used for both timesync requests and responses.         The request is sent with `ts1=syncing component timestamp` and `tc1=0`, and may be broadcast or targeted to a specific system/component.         The response is sent with `ts1=syncing component timestamp` (mirror back unchanged), and `tc1=responding component timestamp`, with the `target_system` and `target_component` set to ids of the original request.         Systems can determine if they are receiving a request or response based on the value of `tc`.         If the response has `target_system==target_component==0` the remote system has not been updated to use the component IDs and cannot reliably timesync; the requester may report an error.         Timestamps are UNIX Epoch time or time since system boot in nanoseconds (the timestamp format can be inferred by checking for the magnitude of the number; generally it doesn't matter as only the offset is used).         The message sequence is repeated numerous times with results being filtered/averaged to estimate the offset.         See also: <https://mavlink.io/en/services/timesync.html>."]
#[doc = ""]
#[doc = "ID: 111"]
#[derive(Debug, Clone, PartialEq)]
pub struct TIMESYNC_DATA {
    #[doc = "Time sync timestamp 1. Syncing: 0. Responding: Timestamp of responding component."]
    pub tc1: i64,
    #[doc = "Time sync timestamp 2. Timestamp of syncing component (mirrored in response)."]
    pub ts1: i64,
    #[doc = "Target system id. Request: 0 (broadcast) or id of specific system. Response must contain system id of the requesting component."]
    pub target_system: u8,
    #[doc = "Target component id. Request: 0 (broadcast) or id of specific component. Response must contain component id of the requesting component."]
    pub target_component: u8,
}
impl TIMESYNC_DATA {
    pub const ENCODED_LEN: usize = 18usize;
    pub const DEFAULT: Self =
        Self { tc1: 0_i64, ts1: 0_i64, target_system: 0_u8, target_component: 0_u8 };
}
impl Default for TIMESYNC_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for TIMESYNC_DATA {
    type Message = MavMessage;
    const ID: u32 = 111u32;
    const NAME: &'static str = "TIMESYNC";
    const EXTRA_CRC: u8 = 34u8;
    const ENCODED_LEN: usize = 18usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.tc1 = buf.get_i64_le()?;
        __struct.ts1 = buf.get_i64_le()?;
        __struct.target_system = buf.get_u8()?;
        __struct.target_component = buf.get_u8()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_i64_le(self.tc1);
        __tmp.put_i64_le(self.ts1);
        if matches!(version, MavlinkVersion::V2) {
            __tmp.put_u8(self.target_system);
            __tmp.put_u8(self.target_component);
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Metrics typically displayed on a HUD for fixed wing aircraft."]
#[doc = ""]
#[doc = "ID: 74"]
#[derive(Debug, Clone, PartialEq)]
pub struct VFR_HUD_DATA {
    #[doc = "Vehicle speed in form appropriate for vehicle type. For standard aircraft this is typically calibrated airspeed (CAS) or indicated airspeed (IAS) - either of which can be used by a pilot to estimate stall speed."]
    pub airspeed: f32,
    #[doc = "Current ground speed."]
    pub groundspeed: f32,
    #[doc = "Current altitude (MSL)."]
    pub alt: f32,
    #[doc = "Current climb rate."]
    pub climb: f32,
    #[doc = "Current heading in compass units (0-360, 0=north)."]
    pub heading: i16,
    #[doc = "Current throttle setting (0 to 100)."]
    pub throttle: u16,
}
impl VFR_HUD_DATA {
    pub const ENCODED_LEN: usize = 20usize;
    pub const DEFAULT: Self = Self {
        airspeed: 0.0_f32,
        groundspeed: 0.0_f32,
        alt: 0.0_f32,
        climb: 0.0_f32,
        heading: 0_i16,
        throttle: 0_u16,
    };
}
impl Default for VFR_HUD_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for VFR_HUD_DATA {
    type Message = MavMessage;
    const ID: u32 = 74u32;
    const NAME: &'static str = "VFR_HUD";
    const EXTRA_CRC: u8 = 20u8;
    const ENCODED_LEN: usize = 20usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.airspeed = buf.get_f32_le()?;
        __struct.groundspeed = buf.get_f32_le()?;
        __struct.alt = buf.get_f32_le()?;
        __struct.climb = buf.get_f32_le()?;
        __struct.heading = buf.get_i16_le()?;
        __struct.throttle = buf.get_u16_le()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_f32_le(self.airspeed);
        __tmp.put_f32_le(self.groundspeed);
        __tmp.put_f32_le(self.alt);
        __tmp.put_f32_le(self.climb);
        __tmp.put_i16_le(self.heading);
        __tmp.put_u16_le(self.throttle);
        if matches!(version, MavlinkVersion::V2) {
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Information about video stream. It may be requested using MAV_CMD_REQUEST_MESSAGE, where param2 indicates the video stream id: 0 for all streams, 1 for first, 2 for second, etc."]
#[doc = ""]
#[doc = "ID: 269"]
#[derive(Debug, Clone, PartialEq)]
pub struct VIDEO_STREAM_INFORMATION_DATA {
    #[doc = "Frame rate."]
    pub framerate: f32,
    #[doc = "Bit rate."]
    pub bitrate: u32,
    #[doc = "Bitmap of stream status flags."]
    pub flags: VideoStreamStatusFlags,
    #[doc = "Horizontal resolution."]
    pub resolution_h: u16,
    #[doc = "Vertical resolution."]
    pub resolution_v: u16,
    #[doc = "Video image rotation clockwise."]
    pub rotation: u16,
    #[doc = "Horizontal Field of view."]
    pub hfov: u16,
    #[doc = "Video Stream ID (1 for first, 2 for second, etc.)"]
    pub stream_id: u8,
    #[doc = "Number of streams available."]
    pub count: u8,
    #[doc = "Type of stream."]
    pub mavtype: VideoStreamType,
    #[doc = "Stream name."]
    pub name: CharArray<32>,
    #[doc = "Video stream URI (TCP or RTSP URI ground station should connect to) or port number (UDP port ground station should listen to)."]
    pub uri: CharArray<160>,
    #[doc = "Encoding of stream."]
    pub encoding: VideoStreamEncoding,
    #[doc = "Camera id of a non-MAVLink camera attached to an autopilot (1-6).  0 if the component is a MAVLink camera (with its own component id)."]
    pub camera_device_id: u8,
}
impl VIDEO_STREAM_INFORMATION_DATA {
    pub const ENCODED_LEN: usize = 215usize;
    pub const DEFAULT: Self = Self {
        framerate: 0.0_f32,
        bitrate: 0_u32,
        flags: VideoStreamStatusFlags::DEFAULT,
        resolution_h: 0_u16,
        resolution_v: 0_u16,
        rotation: 0_u16,
        hfov: 0_u16,
        stream_id: 0_u8,
        count: 0_u8,
        mavtype: VideoStreamType::DEFAULT,
        name: CharArray::new([0_u8; 32usize]),
        uri: CharArray::new([0_u8; 160usize]),
        encoding: VideoStreamEncoding::DEFAULT,
        camera_device_id: 0_u8,
    };
}
impl Default for VIDEO_STREAM_INFORMATION_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for VIDEO_STREAM_INFORMATION_DATA {
    type Message = MavMessage;
    const ID: u32 = 269u32;
    const NAME: &'static str = "VIDEO_STREAM_INFORMATION";
    const EXTRA_CRC: u8 = 109u8;
    const ENCODED_LEN: usize = 215usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.framerate = buf.get_f32_le()?;
        __struct.bitrate = buf.get_u32_le()?;
        let tmp = buf.get_u16_le()?;
        __struct.flags = VideoStreamStatusFlags::from_bits_retain(
            tmp as <VideoStreamStatusFlags as Flags>::Bits,
        );
        __struct.resolution_h = buf.get_u16_le()?;
        __struct.resolution_v = buf.get_u16_le()?;
        __struct.rotation = buf.get_u16_le()?;
        __struct.hfov = buf.get_u16_le()?;
        __struct.stream_id = buf.get_u8()?;
        __struct.count = buf.get_u8()?;
        let tmp = buf.get_u8()?;
        __struct.mavtype =
            FromPrimitive::from_u8(tmp).ok_or(::mavlink_core::error::ParserError::InvalidEnum {
                enum_type: "VideoStreamType",
                value: tmp as u64,
            })?;
        let mut tmp = [0_u8; 32usize];
        for v in &mut tmp {
            *v = buf.get_u8()?;
        }
        __struct.name = CharArray::new(tmp);
        let mut tmp = [0_u8; 160usize];
        for v in &mut tmp {
            *v = buf.get_u8()?;
        }
        __struct.uri = CharArray::new(tmp);
        let tmp = buf.get_u8()?;
        __struct.encoding =
            FromPrimitive::from_u8(tmp).ok_or(::mavlink_core::error::ParserError::InvalidEnum {
                enum_type: "VideoStreamEncoding",
                value: tmp as u64,
            })?;
        __struct.camera_device_id = buf.get_u8()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_f32_le(self.framerate);
        __tmp.put_u32_le(self.bitrate);
        __tmp.put_u16_le(self.flags.bits() as u16);
        __tmp.put_u16_le(self.resolution_h);
        __tmp.put_u16_le(self.resolution_v);
        __tmp.put_u16_le(self.rotation);
        __tmp.put_u16_le(self.hfov);
        __tmp.put_u8(self.stream_id);
        __tmp.put_u8(self.count);
        __tmp.put_u8(self.mavtype as u8);
        for val in &self.name {
            __tmp.put_u8(*val);
        }
        for val in &self.uri {
            __tmp.put_u8(*val);
        }
        if matches!(version, MavlinkVersion::V2) {
            __tmp.put_u8(self.encoding as u8);
            __tmp.put_u8(self.camera_device_id);
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[doc = "Information about the status of a video stream. It may be requested using MAV_CMD_REQUEST_MESSAGE."]
#[doc = ""]
#[doc = "ID: 270"]
#[derive(Debug, Clone, PartialEq)]
pub struct VIDEO_STREAM_STATUS_DATA {
    #[doc = "Frame rate"]
    pub framerate: f32,
    #[doc = "Bit rate"]
    pub bitrate: u32,
    #[doc = "Bitmap of stream status flags"]
    pub flags: VideoStreamStatusFlags,
    #[doc = "Horizontal resolution"]
    pub resolution_h: u16,
    #[doc = "Vertical resolution"]
    pub resolution_v: u16,
    #[doc = "Video image rotation clockwise"]
    pub rotation: u16,
    #[doc = "Horizontal Field of view"]
    pub hfov: u16,
    #[doc = "Video Stream ID (1 for first, 2 for second, etc.)"]
    pub stream_id: u8,
    #[doc = "Camera id of a non-MAVLink camera attached to an autopilot (1-6).  0 if the component is a MAVLink camera (with its own component id)."]
    pub camera_device_id: u8,
}
impl VIDEO_STREAM_STATUS_DATA {
    pub const ENCODED_LEN: usize = 20usize;
    pub const DEFAULT: Self = Self {
        framerate: 0.0_f32,
        bitrate: 0_u32,
        flags: VideoStreamStatusFlags::DEFAULT,
        resolution_h: 0_u16,
        resolution_v: 0_u16,
        rotation: 0_u16,
        hfov: 0_u16,
        stream_id: 0_u8,
        camera_device_id: 0_u8,
    };
}
impl Default for VIDEO_STREAM_STATUS_DATA {
    fn default() -> Self {
        Self::DEFAULT.clone()
    }
}
impl MessageData for VIDEO_STREAM_STATUS_DATA {
    type Message = MavMessage;
    const ID: u32 = 270u32;
    const NAME: &'static str = "VIDEO_STREAM_STATUS";
    const EXTRA_CRC: u8 = 59u8;
    const ENCODED_LEN: usize = 20usize;
    fn deser(
        _version: MavlinkVersion,
        __input: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        let avail_len = __input.len();
        let mut payload_buf;
        let mut buf = if avail_len < Self::ENCODED_LEN {
            payload_buf = [0; Self::ENCODED_LEN];
            payload_buf[0..avail_len].copy_from_slice(__input);
            Bytes::new(&payload_buf)
        } else {
            Bytes::new(__input)
        };
        let mut __struct = Self::default();
        __struct.framerate = buf.get_f32_le()?;
        __struct.bitrate = buf.get_u32_le()?;
        let tmp = buf.get_u16_le()?;
        __struct.flags = VideoStreamStatusFlags::from_bits_retain(
            tmp as <VideoStreamStatusFlags as Flags>::Bits,
        );
        __struct.resolution_h = buf.get_u16_le()?;
        __struct.resolution_v = buf.get_u16_le()?;
        __struct.rotation = buf.get_u16_le()?;
        __struct.hfov = buf.get_u16_le()?;
        __struct.stream_id = buf.get_u8()?;
        __struct.camera_device_id = buf.get_u8()?;
        Ok(__struct)
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        let mut __tmp = BytesMut::new(bytes);
        if __tmp.remaining() < Self::ENCODED_LEN {
            panic!(
                "buffer is too small (need {} bytes, but got {})",
                Self::ENCODED_LEN,
                __tmp.remaining(),
            )
        }
        __tmp.put_f32_le(self.framerate);
        __tmp.put_u32_le(self.bitrate);
        __tmp.put_u16_le(self.flags.bits() as u16);
        __tmp.put_u16_le(self.resolution_h);
        __tmp.put_u16_le(self.resolution_v);
        __tmp.put_u16_le(self.rotation);
        __tmp.put_u16_le(self.hfov);
        __tmp.put_u8(self.stream_id);
        if matches!(version, MavlinkVersion::V2) {
            __tmp.put_u8(self.camera_device_id);
            let len = __tmp.len();
            ::mavlink_core::utils::remove_trailing_zeroes(&bytes[..len])
        } else {
            __tmp.len()
        }
    }
}
#[derive(Clone, PartialEq, Debug)]
#[repr(u32)]
pub enum MavMessage {
    #[doc = "The current system altitude."]
    #[doc = ""]
    #[doc = "ID: 141"]
    ALTITUDE(ALTITUDE_DATA),
    #[doc = "The attitude in the aeronautical frame (right-handed, Z-down, Y-right, X-front, ZYX, intrinsic)."]
    #[doc = ""]
    #[doc = "ID: 30"]
    ATTITUDE(ATTITUDE_DATA),
    #[doc = "The attitude in the aeronautical frame (right-handed, Z-down, X-front, Y-right), expressed as quaternion. Quaternion order is w, x, y, z and a zero rotation would be expressed as (1 0 0 0)."]
    #[doc = ""]
    #[doc = "ID: 31"]
    ATTITUDE_QUATERNION(ATTITUDE_QUATERNION_DATA),
    #[doc = "Reports the current commanded attitude of the vehicle as specified by the autopilot. This should match the commands sent in a SET_ATTITUDE_TARGET message if the vehicle is being controlled this way."]
    #[doc = ""]
    #[doc = "ID: 83"]
    ATTITUDE_TARGET(ATTITUDE_TARGET_DATA),
    #[doc = "Version and capability of autopilot software. This should be emitted in response to a request with MAV_CMD_REQUEST_MESSAGE."]
    #[doc = ""]
    #[doc = "ID: 148"]
    AUTOPILOT_VERSION(AUTOPILOT_VERSION_DATA),
    #[doc = "Information about a flight mode.          The message can be enumerated to get information for all modes, or requested for a particular mode, using MAV_CMD_REQUEST_MESSAGE.         Specify 0 in param2 to request that the message is emitted for all available modes or the specific index for just one mode.         The modes must be available/settable for the current vehicle/frame type.         Each mode should only be emitted once (even if it is both standard and custom).         Note that the current mode should be emitted in CURRENT_MODE, and that if the mode list can change then AVAILABLE_MODES_MONITOR must be emitted on first change and subsequently streamed.         See <https://mavlink.io/en/services/standard_modes.html>."]
    #[doc = ""]
    #[doc = "ID: 435"]
    AVAILABLE_MODES(AVAILABLE_MODES_DATA),
    #[doc = "A change to the sequence number indicates that the set of AVAILABLE_MODES has changed, and that the receiver should re-request all available modes.          The message is optional, and is only needed when the set of modes can change dynamically after boot.         It should be emitted whenever the set of modes change.         It should be streamed at low rate (nominally 0.3 Hz).         See <https://mavlink.io/en/services/standard_modes.html>."]
    #[doc = ""]
    #[doc = "ID: 437"]
    AVAILABLE_MODES_MONITOR(AVAILABLE_MODES_MONITOR_DATA),
    #[doc = "Battery information. Updates GCS with flight controller battery status. Smart batteries also use this message, but may additionally send BATTERY_INFO."]
    #[doc = ""]
    #[doc = "ID: 147"]
    BATTERY_STATUS(BATTERY_STATUS_DATA),
    #[doc = "Information about a camera. Can be requested with a MAV_CMD_REQUEST_MESSAGE command."]
    #[doc = ""]
    #[doc = "ID: 259"]
    CAMERA_INFORMATION(CAMERA_INFORMATION_DATA),
    #[doc = "Report status of a command. Includes feedback whether the command was executed. The command microservice is documented at <https://mavlink.io/en/services/command.html>."]
    #[doc = ""]
    #[doc = "ID: 77"]
    COMMAND_ACK(COMMAND_ACK_DATA),
    #[doc = "Cancel a long running command. The target system should respond with a COMMAND_ACK to the original command with result=MAV_RESULT_CANCELLED if the long running process was cancelled. If it has already completed, the cancel action can be ignored. The cancel action can be retried until some sort of acknowledgement to the original command has been received. The command microservice is documented at <https://mavlink.io/en/services/command.html>."]
    #[doc = ""]
    #[doc = "ID: 80"]
    COMMAND_CANCEL(COMMAND_CANCEL_DATA),
    #[doc = "Send a command with up to seven parameters to the MAV, where params 5 and 6 are integers and the other values are floats. This is preferred over COMMAND_LONG as it allows the MAV_FRAME to be specified for interpreting positional information, such as altitude. COMMAND_INT is also preferred when sending latitude and longitude data in params 5 and 6, as it allows for greater precision. Param 5 and 6 encode positional data as scaled integers, where the scaling depends on the actual command value. NaN or INT32_MAX may be used in float/integer params (respectively) to indicate optional/default values (e.g. to use the component's current latitude, yaw rather than a specific value). The command microservice is documented at <https://mavlink.io/en/services/command.html>."]
    #[doc = ""]
    #[doc = "ID: 75"]
    COMMAND_INT(COMMAND_INT_DATA),
    #[doc = "Send a command with up to seven parameters to the MAV. COMMAND_INT is generally preferred when sending MAV_CMD commands that include positional information; it offers higher precision and allows the MAV_FRAME to be specified (which may otherwise be ambiguous, particularly for altitude). The command microservice is documented at <https://mavlink.io/en/services/command.html>."]
    #[doc = ""]
    #[doc = "ID: 76"]
    COMMAND_LONG(COMMAND_LONG_DATA),
    #[doc = "Component metadata message, which may be requested using MAV_CMD_REQUEST_MESSAGE.          This contains the MAVLink FTP URI and CRC for the component's general metadata file.         The file must be hosted on the component, and may be xz compressed.         The file CRC can be used for file caching.          The general metadata file can be read to get the locations of other metadata files (COMP_METADATA_TYPE) and translations, which may be hosted either on the vehicle or the internet.         For more information see: <https://mavlink.io/en/services/component_information.html>.          Note: Camera components should use CAMERA_INFORMATION instead, and autopilots may use both this message and AUTOPILOT_VERSION."]
    #[doc = ""]
    #[doc = "ID: 397"]
    COMPONENT_METADATA(COMPONENT_METADATA_DATA),
    #[doc = "Regular broadcast for the current latest event sequence number for a component. This is used to check for dropped events."]
    #[doc = ""]
    #[doc = "ID: 411"]
    CURRENT_EVENT_SEQUENCE(CURRENT_EVENT_SEQUENCE_DATA),
    #[doc = "Get the current mode.         This should be emitted on any mode change, and broadcast at low rate (nominally 0.5 Hz).         It may be requested using MAV_CMD_REQUEST_MESSAGE.         See <https://mavlink.io/en/services/standard_modes.html>."]
    #[doc = ""]
    #[doc = "ID: 436"]
    CURRENT_MODE(CURRENT_MODE_DATA),
    #[doc = "Data stream status information."]
    #[doc = ""]
    #[doc = "ID: 67"]
    #[deprecated = " See `MESSAGE_INTERVAL` (Superseded since 2015-08)"]
    DATA_STREAM(DATA_STREAM_DATA),
    #[doc = "Distance sensor information for an onboard rangefinder."]
    #[doc = ""]
    #[doc = "ID: 132"]
    DISTANCE_SENSOR(DISTANCE_SENSOR_DATA),
    #[doc = "Estimator status message including flags, innovation test ratios and estimated accuracies. The flags message is an integer bitmask containing information on which EKF outputs are valid. See the ESTIMATOR_STATUS_FLAGS enum definition for further information. The innovation test ratios show the magnitude of the sensor innovation divided by the innovation check threshold. Under normal operation the innovation test ratios should be below 0.5 with occasional values up to 1.0. Values greater than 1.0 should be rare under normal operation and indicate that a measurement has been rejected by the filter. The user should be notified if an innovation test ratio greater than 1.0 is recorded. Notifications for values in the range between 0.5 and 1.0 should be optional and controllable by the user."]
    #[doc = ""]
    #[doc = "ID: 230"]
    ESTIMATOR_STATUS(ESTIMATOR_STATUS_DATA),
    #[doc = "Event message. Each new event from a particular component gets a new sequence number. The same message might be sent multiple times if (re-)requested. Most events are broadcast, some can be specific to a target component (as receivers keep track of the sequence for missed events, all events need to be broadcast. Thus we use destination_component instead of target_component)."]
    #[doc = ""]
    #[doc = "ID: 410"]
    EVENT(EVENT_DATA),
    #[doc = "Provides state for additional features."]
    #[doc = ""]
    #[doc = "ID: 245"]
    EXTENDED_SYS_STATE(EXTENDED_SYS_STATE_DATA),
    #[doc = "File transfer protocol message: <https://mavlink.io/en/services/ftp.html>."]
    #[doc = ""]
    #[doc = "ID: 110"]
    FILE_TRANSFER_PROTOCOL(FILE_TRANSFER_PROTOCOL_DATA),
    #[doc = "The filtered global position (e.g. fused GPS and accelerometers). The position is in GPS-frame (right-handed, Z-up). It is designed as scaled integer message since the resolution of float is not sufficient."]
    #[doc = ""]
    #[doc = "ID: 33"]
    GLOBAL_POSITION_INT(GLOBAL_POSITION_INT_DATA),
    #[doc = "Publishes the GPS coordinates of the vehicle local origin (0,0,0) position. Emitted whenever a new GPS-Local position mapping is requested or set - e.g. following SET_GPS_GLOBAL_ORIGIN message."]
    #[doc = ""]
    #[doc = "ID: 49"]
    GPS_GLOBAL_ORIGIN(GPS_GLOBAL_ORIGIN_DATA),
    #[doc = "The global position, as returned by the Global Positioning System (GPS). This is                 NOT the global position estimate of the system, but rather a RAW sensor value. See message GLOBAL_POSITION_INT for the global position estimate."]
    #[doc = ""]
    #[doc = "ID: 24"]
    GPS_RAW_INT(GPS_RAW_INT_DATA),
    #[doc = "The heartbeat message shows that a system or component is present and responding. The type and autopilot fields (along with the message component id), allow the receiving system to treat further messages from this system appropriately (e.g. by laying out the user interface based on the autopilot). This microservice is documented at <https://mavlink.io/en/services/heartbeat.html>."]
    #[doc = ""]
    #[doc = "ID: 0"]
    HEARTBEAT(HEARTBEAT_DATA),
    #[doc = "Contains the home position.         The home position is the default position that the system will return to and land on.         The position must be set automatically by the system during the takeoff, and may also be explicitly set using MAV_CMD_DO_SET_HOME.         The global and local positions encode the position in the respective coordinate frames, while the q parameter encodes the orientation of the surface.         Under normal conditions it describes the heading and terrain slope, which can be used by the aircraft to adjust the approach.         The approach 3D vector describes the point to which the system should fly in normal flight mode and then perform a landing sequence along the vector.         Note: this message can be requested by sending the MAV_CMD_REQUEST_MESSAGE with param1=242."]
    #[doc = ""]
    #[doc = "ID: 242"]
    HOME_POSITION(HOME_POSITION_DATA),
    #[doc = "The filtered local position (e.g. fused computer vision and accelerometers). Coordinate frame is right-handed, Z-axis down (aeronautical frame, NED / north-east-down convention)."]
    #[doc = ""]
    #[doc = "ID: 32"]
    LOCAL_POSITION_NED(LOCAL_POSITION_NED_DATA),
    #[doc = "Manual (joystick) control message.         This message represents movement axes and button using standard joystick axes nomenclature. Unused axes can be disabled and buttons states are transmitted as individual on/off bits of a bitmask. For more information see <https://mavlink.io/en/services/manual_control.html>."]
    #[doc = ""]
    #[doc = "ID: 69"]
    MANUAL_CONTROL(MANUAL_CONTROL_DATA),
    #[doc = "The interval between messages for a particular MAVLink message ID.         This message is sent in response to the MAV_CMD_REQUEST_MESSAGE command with param1=244 (this message) and param2=message_id (the id of the message for which the interval is required).         This interface replaces DATA_STREAM."]
    #[doc = ""]
    #[doc = "ID: 244"]
    MESSAGE_INTERVAL(MESSAGE_INTERVAL_DATA),
    #[doc = "Acknowledgment message during waypoint handling. The type field states if this message is a positive ack (type=0) or if an error happened (type=non-zero)."]
    #[doc = ""]
    #[doc = "ID: 47"]
    MISSION_ACK(MISSION_ACK_DATA),
    #[doc = "Delete all mission items at once."]
    #[doc = ""]
    #[doc = "ID: 45"]
    MISSION_CLEAR_ALL(MISSION_CLEAR_ALL_DATA),
    #[doc = "This message is emitted as response to MISSION_REQUEST_LIST by the MAV and to initiate a write transaction. The GCS can then request the individual mission item based on the knowledge of the total number of waypoints."]
    #[doc = ""]
    #[doc = "ID: 44"]
    MISSION_COUNT(MISSION_COUNT_DATA),
    #[doc = "Message that announces the sequence number of the current target mission item (that the system will fly towards/execute when the mission is running).         This message should be streamed all the time (nominally at 1Hz).         This message should be emitted following a call to MAV_CMD_DO_SET_MISSION_CURRENT or MISSION_SET_CURRENT."]
    #[doc = ""]
    #[doc = "ID: 42"]
    MISSION_CURRENT(MISSION_CURRENT_DATA),
    #[doc = "Message encoding a mission item.         This message is emitted to announce the presence of a mission item and to set a mission item on the system.         The mission item can be either in x, y, z meters (type: LOCAL) or x:lat, y:lon, z:altitude. Local frame is Z-down, right handed (NED), global frame is Z-up, right handed (ENU). NaN may be used to indicate an optional/default value (e.g. to use the system's current latitude or yaw rather than a specific value). See also <https://mavlink.io/en/services/mission.html>."]
    #[doc = ""]
    #[doc = "ID: 39"]
    #[deprecated = " See `MISSION_ITEM_INT` (Deprecated since 2020-06)"]
    MISSION_ITEM(MISSION_ITEM_DATA),
    #[doc = "Message encoding a mission item. This message is emitted to announce                 the presence of a mission item and to set a mission item on the system. The mission item can be either in x, y, z meters (type: LOCAL) or x:lat, y:lon, z:altitude. Local frame is Z-down, right handed (NED), global frame is Z-up, right handed (ENU). NaN or INT32_MAX may be used in float/integer params (respectively) to indicate optional/default values (e.g. to use the component's current latitude, yaw rather than a specific value). See also <https://mavlink.io/en/services/mission.html>."]
    #[doc = ""]
    #[doc = "ID: 73"]
    MISSION_ITEM_INT(MISSION_ITEM_INT_DATA),
    #[doc = "A certain mission item has been reached. The system will either hold this position (or circle on the orbit) or (if the autocontinue on the WP was set) continue to the next waypoint."]
    #[doc = ""]
    #[doc = "ID: 46"]
    MISSION_ITEM_REACHED(MISSION_ITEM_REACHED_DATA),
    #[doc = "Request the information of the mission item with the sequence number seq. The response of the system to this message should be a MISSION_ITEM message. <https://mavlink.io/en/services/mission.html>."]
    #[doc = ""]
    #[doc = "ID: 40"]
    #[deprecated = "A system that gets this request should respond with MISSION_ITEM_INT (as though MISSION_REQUEST_INT was received). See `MISSION_REQUEST_INT` (Deprecated since 2020-06)"]
    MISSION_REQUEST(MISSION_REQUEST_DATA),
    #[doc = "Request the information of the mission item with the sequence number seq. The response of the system to this message should be a MISSION_ITEM_INT message. <https://mavlink.io/en/services/mission.html>."]
    #[doc = ""]
    #[doc = "ID: 51"]
    MISSION_REQUEST_INT(MISSION_REQUEST_INT_DATA),
    #[doc = "Request the overall list of mission items from the system/component."]
    #[doc = ""]
    #[doc = "ID: 43"]
    MISSION_REQUEST_LIST(MISSION_REQUEST_LIST_DATA),
    #[doc = "Request a partial list of mission items from the system/component. <https://mavlink.io/en/services/mission.html>. If start and end index are the same, just send one waypoint."]
    #[doc = ""]
    #[doc = "ID: 37"]
    MISSION_REQUEST_PARTIAL_LIST(MISSION_REQUEST_PARTIAL_LIST_DATA),
    #[doc = "Set the mission item with sequence number seq as the current item and emit MISSION_CURRENT (whether or not the mission number changed).         If a mission is currently being executed, the system will continue to this new mission item on the shortest path, skipping any intermediate mission items.         Note that mission jump repeat counters are not reset (see MAV_CMD_DO_JUMP param2).          This message may trigger a mission state-machine change on some systems: for example from MISSION_STATE_NOT_STARTED or MISSION_STATE_PAUSED to MISSION_STATE_ACTIVE.         If the system is in mission mode, on those systems this command might therefore start, restart or resume the mission.         If the system is not in mission mode this message must not trigger a switch to mission mode."]
    #[doc = ""]
    #[doc = "ID: 41"]
    #[deprecated = " See `MAV_CMD_DO_SET_MISSION_CURRENT` (Superseded since 2022-08)"]
    MISSION_SET_CURRENT(MISSION_SET_CURRENT_DATA),
    #[doc = "This message is sent to the MAV to write a partial list. If start index == end index, only one item will be transmitted / updated. If the start index is NOT 0 and above the current list size, this request should be REJECTED!."]
    #[doc = ""]
    #[doc = "ID: 38"]
    MISSION_WRITE_PARTIAL_LIST(MISSION_WRITE_PARTIAL_LIST_DATA),
    #[doc = "The state of the navigation and position controller."]
    #[doc = ""]
    #[doc = "ID: 62"]
    NAV_CONTROLLER_OUTPUT(NAV_CONTROLLER_OUTPUT_DATA),
    #[doc = "Odometry message to communicate odometry information with an external interface. Fits ROS REP 147 standard for aerial vehicles (<http://www.ros.org/reps/rep-0147.html>)."]
    #[doc = ""]
    #[doc = "ID: 331"]
    ODOMETRY(ODOMETRY_DATA),
    #[doc = "Optical flow from an angular rate flow sensor (e.g. PX4FLOW or mouse sensor)."]
    #[doc = ""]
    #[doc = "ID: 106"]
    OPTICAL_FLOW_RAD(OPTICAL_FLOW_RAD_DATA),
    #[doc = "Parameter set/get error. Returned from a MAVLink node in response to an error in the parameter protocol, for example failing to set a parameter because it does not exist."]
    #[doc = ""]
    #[doc = "ID: 345"]
    PARAM_ERROR(PARAM_ERROR_DATA),
    #[doc = "Request all parameters of this component. After this request, all parameters are emitted. The parameter microservice is documented at <https://mavlink.io/en/services/parameter.html>."]
    #[doc = ""]
    #[doc = "ID: 21"]
    PARAM_REQUEST_LIST(PARAM_REQUEST_LIST_DATA),
    #[doc = "Request to read the onboard parameter with the param_id string id. Onboard parameters are stored as key[const char*] ->value[float]. This allows to send a parameter to any other component (such as the GCS) without the need of previous knowledge of possible parameter names. Thus the same GCS can store different parameters for different autopilots. See also <https://mavlink.io/en/services/parameter.html> for a full documentation of QGroundControl and IMU code."]
    #[doc = ""]
    #[doc = "ID: 20"]
    PARAM_REQUEST_READ(PARAM_REQUEST_READ_DATA),
    #[doc = "Set a parameter value (write new value to permanent storage).         The receiving component should acknowledge the new parameter value by broadcasting a PARAM_VALUE message (broadcasting ensures that multiple GCS all have an up-to-date list of all parameters). If the sending GCS did not receive a PARAM_VALUE within its timeout time, it should re-send the PARAM_SET message. The parameter microservice is documented at <https://mavlink.io/en/services/parameter.html>."]
    #[doc = ""]
    #[doc = "ID: 23"]
    PARAM_SET(PARAM_SET_DATA),
    #[doc = "Emit the value of a onboard parameter. The inclusion of param_count and param_index in the message allows the recipient to keep track of received parameters and allows him to re-request missing parameters after a loss or timeout. The parameter microservice is documented at <https://mavlink.io/en/services/parameter.html>."]
    #[doc = ""]
    #[doc = "ID: 22"]
    PARAM_VALUE(PARAM_VALUE_DATA),
    #[doc = "A ping message either requesting or responding to a ping. This allows to measure the system latencies, including serial port, radio modem and UDP connections. The ping microservice is documented at <https://mavlink.io/en/services/ping.html>."]
    #[doc = ""]
    #[doc = "ID: 4"]
    #[deprecated = "To be removed / merged with TIMESYNC. See `TIMESYNC` (Superseded since 2011-08)"]
    PING(PING_DATA),
    #[doc = "Reports the current commanded vehicle position, velocity, and acceleration as specified by the autopilot. This should match the commands sent in SET_POSITION_TARGET_GLOBAL_INT if the vehicle is being controlled this way."]
    #[doc = ""]
    #[doc = "ID: 87"]
    POSITION_TARGET_GLOBAL_INT(POSITION_TARGET_GLOBAL_INT_DATA),
    #[doc = "Reports the current commanded vehicle position, velocity, and acceleration as specified by the autopilot. This should match the commands sent in SET_POSITION_TARGET_LOCAL_NED if the vehicle is being controlled this way."]
    #[doc = ""]
    #[doc = "ID: 85"]
    POSITION_TARGET_LOCAL_NED(POSITION_TARGET_LOCAL_NED_DATA),
    #[doc = "Version and capability of protocol version. This message can be requested with MAV_CMD_REQUEST_MESSAGE and is used as part of the handshaking to establish which MAVLink version should be used on the network. Every node should respond to a request for PROTOCOL_VERSION to enable the handshaking. Library implementers should consider adding this into the default decoding state machine to allow the protocol core to respond directly."]
    #[doc = ""]
    #[doc = "ID: 300"]
    #[deprecated = "No longer needed. Support is being removed from flight stacks. See `Nothing` (Deprecated since 2025-11)"]
    PROTOCOL_VERSION(PROTOCOL_VERSION_DATA),
    #[doc = "The RAW values of the RC channels sent to the MAV to override info received from the RC radio. The standard PPM modulation is as follows: 1000 microseconds: 0%, 2000 microseconds: 100%. Individual receivers/transmitters might violate this specification.  Note carefully the semantic differences between the first 8 channels and the subsequent channels."]
    #[doc = ""]
    #[doc = "ID: 70"]
    RC_CHANNELS_OVERRIDE(RC_CHANNELS_OVERRIDE_DATA),
    #[doc = "Request a data stream."]
    #[doc = ""]
    #[doc = "ID: 66"]
    #[deprecated = " See `MAV_CMD_SET_MESSAGE_INTERVAL ` (Superseded since 2015-08)"]
    REQUEST_DATA_STREAM(REQUEST_DATA_STREAM_DATA),
    #[doc = "Setup a MAVLink2 signing key. If called with secret_key of all zero and zero initial_timestamp will disable signing."]
    #[doc = ""]
    #[doc = "ID: 256"]
    SETUP_SIGNING(SETUP_SIGNING_DATA),
    #[doc = "Sets a desired vehicle attitude. Used by an external controller to command the vehicle (manual controller or other system)."]
    #[doc = ""]
    #[doc = "ID: 82"]
    SET_ATTITUDE_TARGET(SET_ATTITUDE_TARGET_DATA),
    #[doc = "Sets the GPS coordinates of the vehicle local origin (0,0,0) position. Vehicle should emit GPS_GLOBAL_ORIGIN irrespective of whether the origin is changed. This enables transform between the local coordinate frame and the global (GPS) coordinate frame, which may be necessary when (for example) indoor and outdoor settings are connected and the MAV should move from in- to outdoor."]
    #[doc = ""]
    #[doc = "ID: 48"]
    #[deprecated = " See `MAV_CMD_DO_SET_GLOBAL_ORIGIN` (Superseded since 2025-04)"]
    SET_GPS_GLOBAL_ORIGIN(SET_GPS_GLOBAL_ORIGIN_DATA),
    #[doc = "Sets the home position.         The home position is the default position that the system will return to and land on.         The position is set automatically by the system during the takeoff (and may also be set using this message).         The global and local positions encode the position in the respective coordinate frames, while the q parameter encodes the orientation of the surface.         Under normal conditions it describes the heading and terrain slope, which can be used by the aircraft to adjust the approach.         The approach 3D vector describes the point to which the system should fly in normal flight mode and then perform a landing sequence along the vector.         Note: the current home position may be emitted in a HOME_POSITION message on request (using MAV_CMD_REQUEST_MESSAGE with param1=242)."]
    #[doc = ""]
    #[doc = "ID: 243"]
    #[deprecated = "The command protocol version (MAV_CMD_DO_SET_HOME) allows a GCS to detect when setting the home position has failed. See `MAV_CMD_DO_SET_HOME` (Superseded since 2022-02)"]
    SET_HOME_POSITION(SET_HOME_POSITION_DATA),
    #[doc = "Set the system mode, as defined by enum MAV_MODE_FLAG. There is no target component id as the mode is by definition for the overall aircraft, not only for one component."]
    #[doc = ""]
    #[doc = "ID: 11"]
    #[deprecated = "Use COMMAND_LONG with MAV_CMD_DO_SET_MODE instead. See `MAV_CMD_DO_SET_MODE` (Superseded since 2015-12)"]
    SET_MODE(SET_MODE_DATA),
    #[doc = "Sets a desired vehicle position, velocity, and/or acceleration in a global coordinate system (WGS84). Used by an external controller to command the vehicle (manual controller or other system)."]
    #[doc = ""]
    #[doc = "ID: 86"]
    SET_POSITION_TARGET_GLOBAL_INT(SET_POSITION_TARGET_GLOBAL_INT_DATA),
    #[doc = "Sets a desired vehicle position in a local north-east-down coordinate frame. Used by an external controller to command the vehicle (manual controller or other system)."]
    #[doc = ""]
    #[doc = "ID: 84"]
    SET_POSITION_TARGET_LOCAL_NED(SET_POSITION_TARGET_LOCAL_NED_DATA),
    #[doc = "Status text message. These messages are printed in yellow in the COMM console of QGroundControl. WARNING: They consume quite some bandwidth, so use only for important status and error messages. If implemented wisely, these messages are buffered on the MCU and sent only at a limited rate (e.g. 10 Hz)."]
    #[doc = ""]
    #[doc = "ID: 253"]
    STATUSTEXT(STATUSTEXT_DATA),
    #[doc = "The system time is the time of the sender's master clock.         This can be emitted by flight controllers, onboard computers, or other components in the MAVLink network.         Components that are using a less reliable time source, such as a battery-backed real time clock, can choose to match their system clock to that of a system that indicates a more recent time.         This allows more broadly accurate date stamping of logs, and so on.         If precise time synchronization is needed then use TIMESYNC instead."]
    #[doc = ""]
    #[doc = "ID: 2"]
    SYSTEM_TIME(SYSTEM_TIME_DATA),
    #[doc = "Sensor and subsystem status information. Provides a compact representation of sensor/subsystem status and a few other basic statistics."]
    #[doc = ""]
    #[doc = "ID: 1"]
    SYS_STATUS(SYS_STATUS_DATA),
    #[doc = "Time synchronization message.         The message is used for both timesync requests and responses.         The request is sent with `ts1=syncing component timestamp` and `tc1=0`, and may be broadcast or targeted to a specific system/component.         The response is sent with `ts1=syncing component timestamp` (mirror back unchanged), and `tc1=responding component timestamp`, with the `target_system` and `target_component` set to ids of the original request.         Systems can determine if they are receiving a request or response based on the value of `tc`.         If the response has `target_system==target_component==0` the remote system has not been updated to use the component IDs and cannot reliably timesync; the requester may report an error.         Timestamps are UNIX Epoch time or time since system boot in nanoseconds (the timestamp format can be inferred by checking for the magnitude of the number; generally it doesn't matter as only the offset is used).         The message sequence is repeated numerous times with results being filtered/averaged to estimate the offset.         See also: <https://mavlink.io/en/services/timesync.html>."]
    #[doc = ""]
    #[doc = "ID: 111"]
    TIMESYNC(TIMESYNC_DATA),
    #[doc = "Metrics typically displayed on a HUD for fixed wing aircraft."]
    #[doc = ""]
    #[doc = "ID: 74"]
    VFR_HUD(VFR_HUD_DATA),
    #[doc = "Information about video stream. It may be requested using MAV_CMD_REQUEST_MESSAGE, where param2 indicates the video stream id: 0 for all streams, 1 for first, 2 for second, etc."]
    #[doc = ""]
    #[doc = "ID: 269"]
    VIDEO_STREAM_INFORMATION(VIDEO_STREAM_INFORMATION_DATA),
    #[doc = "Information about the status of a video stream. It may be requested using MAV_CMD_REQUEST_MESSAGE."]
    #[doc = ""]
    #[doc = "ID: 270"]
    VIDEO_STREAM_STATUS(VIDEO_STREAM_STATUS_DATA),
}
impl MavMessage {
    pub const fn all_ids() -> &'static [u32] {
        &[
            0u32, 1u32, 2u32, 4u32, 11u32, 20u32, 21u32, 22u32, 23u32, 24u32, 30u32, 31u32, 32u32,
            33u32, 37u32, 38u32, 39u32, 40u32, 41u32, 42u32, 43u32, 44u32, 45u32, 46u32, 47u32,
            48u32, 49u32, 51u32, 62u32, 66u32, 67u32, 69u32, 70u32, 73u32, 74u32, 75u32, 76u32,
            77u32, 80u32, 82u32, 83u32, 84u32, 85u32, 86u32, 87u32, 106u32, 110u32, 111u32, 132u32,
            141u32, 147u32, 148u32, 230u32, 242u32, 243u32, 244u32, 245u32, 253u32, 256u32, 259u32,
            269u32, 270u32, 300u32, 331u32, 345u32, 397u32, 410u32, 411u32, 435u32, 436u32, 437u32,
        ]
    }
    pub const fn all_messages() -> &'static [(&'static str, u32)] {
        &[
            (HEARTBEAT_DATA::NAME, HEARTBEAT_DATA::ID),
            (SYS_STATUS_DATA::NAME, SYS_STATUS_DATA::ID),
            (SYSTEM_TIME_DATA::NAME, SYSTEM_TIME_DATA::ID),
            (PING_DATA::NAME, PING_DATA::ID),
            (SET_MODE_DATA::NAME, SET_MODE_DATA::ID),
            (PARAM_REQUEST_READ_DATA::NAME, PARAM_REQUEST_READ_DATA::ID),
            (PARAM_REQUEST_LIST_DATA::NAME, PARAM_REQUEST_LIST_DATA::ID),
            (PARAM_VALUE_DATA::NAME, PARAM_VALUE_DATA::ID),
            (PARAM_SET_DATA::NAME, PARAM_SET_DATA::ID),
            (GPS_RAW_INT_DATA::NAME, GPS_RAW_INT_DATA::ID),
            (ATTITUDE_DATA::NAME, ATTITUDE_DATA::ID),
            (ATTITUDE_QUATERNION_DATA::NAME, ATTITUDE_QUATERNION_DATA::ID),
            (LOCAL_POSITION_NED_DATA::NAME, LOCAL_POSITION_NED_DATA::ID),
            (GLOBAL_POSITION_INT_DATA::NAME, GLOBAL_POSITION_INT_DATA::ID),
            (MISSION_REQUEST_PARTIAL_LIST_DATA::NAME, MISSION_REQUEST_PARTIAL_LIST_DATA::ID),
            (MISSION_WRITE_PARTIAL_LIST_DATA::NAME, MISSION_WRITE_PARTIAL_LIST_DATA::ID),
            (MISSION_ITEM_DATA::NAME, MISSION_ITEM_DATA::ID),
            (MISSION_REQUEST_DATA::NAME, MISSION_REQUEST_DATA::ID),
            (MISSION_SET_CURRENT_DATA::NAME, MISSION_SET_CURRENT_DATA::ID),
            (MISSION_CURRENT_DATA::NAME, MISSION_CURRENT_DATA::ID),
            (MISSION_REQUEST_LIST_DATA::NAME, MISSION_REQUEST_LIST_DATA::ID),
            (MISSION_COUNT_DATA::NAME, MISSION_COUNT_DATA::ID),
            (MISSION_CLEAR_ALL_DATA::NAME, MISSION_CLEAR_ALL_DATA::ID),
            (MISSION_ITEM_REACHED_DATA::NAME, MISSION_ITEM_REACHED_DATA::ID),
            (MISSION_ACK_DATA::NAME, MISSION_ACK_DATA::ID),
            (SET_GPS_GLOBAL_ORIGIN_DATA::NAME, SET_GPS_GLOBAL_ORIGIN_DATA::ID),
            (GPS_GLOBAL_ORIGIN_DATA::NAME, GPS_GLOBAL_ORIGIN_DATA::ID),
            (MISSION_REQUEST_INT_DATA::NAME, MISSION_REQUEST_INT_DATA::ID),
            (NAV_CONTROLLER_OUTPUT_DATA::NAME, NAV_CONTROLLER_OUTPUT_DATA::ID),
            (REQUEST_DATA_STREAM_DATA::NAME, REQUEST_DATA_STREAM_DATA::ID),
            (DATA_STREAM_DATA::NAME, DATA_STREAM_DATA::ID),
            (MANUAL_CONTROL_DATA::NAME, MANUAL_CONTROL_DATA::ID),
            (RC_CHANNELS_OVERRIDE_DATA::NAME, RC_CHANNELS_OVERRIDE_DATA::ID),
            (MISSION_ITEM_INT_DATA::NAME, MISSION_ITEM_INT_DATA::ID),
            (VFR_HUD_DATA::NAME, VFR_HUD_DATA::ID),
            (COMMAND_INT_DATA::NAME, COMMAND_INT_DATA::ID),
            (COMMAND_LONG_DATA::NAME, COMMAND_LONG_DATA::ID),
            (COMMAND_ACK_DATA::NAME, COMMAND_ACK_DATA::ID),
            (COMMAND_CANCEL_DATA::NAME, COMMAND_CANCEL_DATA::ID),
            (SET_ATTITUDE_TARGET_DATA::NAME, SET_ATTITUDE_TARGET_DATA::ID),
            (ATTITUDE_TARGET_DATA::NAME, ATTITUDE_TARGET_DATA::ID),
            (SET_POSITION_TARGET_LOCAL_NED_DATA::NAME, SET_POSITION_TARGET_LOCAL_NED_DATA::ID),
            (POSITION_TARGET_LOCAL_NED_DATA::NAME, POSITION_TARGET_LOCAL_NED_DATA::ID),
            (SET_POSITION_TARGET_GLOBAL_INT_DATA::NAME, SET_POSITION_TARGET_GLOBAL_INT_DATA::ID),
            (POSITION_TARGET_GLOBAL_INT_DATA::NAME, POSITION_TARGET_GLOBAL_INT_DATA::ID),
            (OPTICAL_FLOW_RAD_DATA::NAME, OPTICAL_FLOW_RAD_DATA::ID),
            (FILE_TRANSFER_PROTOCOL_DATA::NAME, FILE_TRANSFER_PROTOCOL_DATA::ID),
            (TIMESYNC_DATA::NAME, TIMESYNC_DATA::ID),
            (DISTANCE_SENSOR_DATA::NAME, DISTANCE_SENSOR_DATA::ID),
            (ALTITUDE_DATA::NAME, ALTITUDE_DATA::ID),
            (BATTERY_STATUS_DATA::NAME, BATTERY_STATUS_DATA::ID),
            (AUTOPILOT_VERSION_DATA::NAME, AUTOPILOT_VERSION_DATA::ID),
            (ESTIMATOR_STATUS_DATA::NAME, ESTIMATOR_STATUS_DATA::ID),
            (HOME_POSITION_DATA::NAME, HOME_POSITION_DATA::ID),
            (SET_HOME_POSITION_DATA::NAME, SET_HOME_POSITION_DATA::ID),
            (MESSAGE_INTERVAL_DATA::NAME, MESSAGE_INTERVAL_DATA::ID),
            (EXTENDED_SYS_STATE_DATA::NAME, EXTENDED_SYS_STATE_DATA::ID),
            (STATUSTEXT_DATA::NAME, STATUSTEXT_DATA::ID),
            (SETUP_SIGNING_DATA::NAME, SETUP_SIGNING_DATA::ID),
            (CAMERA_INFORMATION_DATA::NAME, CAMERA_INFORMATION_DATA::ID),
            (VIDEO_STREAM_INFORMATION_DATA::NAME, VIDEO_STREAM_INFORMATION_DATA::ID),
            (VIDEO_STREAM_STATUS_DATA::NAME, VIDEO_STREAM_STATUS_DATA::ID),
            (PROTOCOL_VERSION_DATA::NAME, PROTOCOL_VERSION_DATA::ID),
            (ODOMETRY_DATA::NAME, ODOMETRY_DATA::ID),
            (PARAM_ERROR_DATA::NAME, PARAM_ERROR_DATA::ID),
            (COMPONENT_METADATA_DATA::NAME, COMPONENT_METADATA_DATA::ID),
            (EVENT_DATA::NAME, EVENT_DATA::ID),
            (CURRENT_EVENT_SEQUENCE_DATA::NAME, CURRENT_EVENT_SEQUENCE_DATA::ID),
            (AVAILABLE_MODES_DATA::NAME, AVAILABLE_MODES_DATA::ID),
            (CURRENT_MODE_DATA::NAME, CURRENT_MODE_DATA::ID),
            (AVAILABLE_MODES_MONITOR_DATA::NAME, AVAILABLE_MODES_MONITOR_DATA::ID),
        ]
    }
}
impl Message for MavMessage {
    fn parse(
        version: MavlinkVersion,
        id: u32,
        payload: &[u8],
    ) -> Result<Self, ::mavlink_core::error::ParserError> {
        match id {
            ALTITUDE_DATA::ID => ALTITUDE_DATA::deser(version, payload).map(Self::ALTITUDE),
            ATTITUDE_DATA::ID => ATTITUDE_DATA::deser(version, payload).map(Self::ATTITUDE),
            ATTITUDE_QUATERNION_DATA::ID => {
                ATTITUDE_QUATERNION_DATA::deser(version, payload).map(Self::ATTITUDE_QUATERNION)
            }
            ATTITUDE_TARGET_DATA::ID => {
                ATTITUDE_TARGET_DATA::deser(version, payload).map(Self::ATTITUDE_TARGET)
            }
            AUTOPILOT_VERSION_DATA::ID => {
                AUTOPILOT_VERSION_DATA::deser(version, payload).map(Self::AUTOPILOT_VERSION)
            }
            AVAILABLE_MODES_DATA::ID => {
                AVAILABLE_MODES_DATA::deser(version, payload).map(Self::AVAILABLE_MODES)
            }
            AVAILABLE_MODES_MONITOR_DATA::ID => {
                AVAILABLE_MODES_MONITOR_DATA::deser(version, payload)
                    .map(Self::AVAILABLE_MODES_MONITOR)
            }
            BATTERY_STATUS_DATA::ID => {
                BATTERY_STATUS_DATA::deser(version, payload).map(Self::BATTERY_STATUS)
            }
            CAMERA_INFORMATION_DATA::ID => {
                CAMERA_INFORMATION_DATA::deser(version, payload).map(Self::CAMERA_INFORMATION)
            }
            COMMAND_ACK_DATA::ID => {
                COMMAND_ACK_DATA::deser(version, payload).map(Self::COMMAND_ACK)
            }
            COMMAND_CANCEL_DATA::ID => {
                COMMAND_CANCEL_DATA::deser(version, payload).map(Self::COMMAND_CANCEL)
            }
            COMMAND_INT_DATA::ID => {
                COMMAND_INT_DATA::deser(version, payload).map(Self::COMMAND_INT)
            }
            COMMAND_LONG_DATA::ID => {
                COMMAND_LONG_DATA::deser(version, payload).map(Self::COMMAND_LONG)
            }
            COMPONENT_METADATA_DATA::ID => {
                COMPONENT_METADATA_DATA::deser(version, payload).map(Self::COMPONENT_METADATA)
            }
            CURRENT_EVENT_SEQUENCE_DATA::ID => CURRENT_EVENT_SEQUENCE_DATA::deser(version, payload)
                .map(Self::CURRENT_EVENT_SEQUENCE),
            CURRENT_MODE_DATA::ID => {
                CURRENT_MODE_DATA::deser(version, payload).map(Self::CURRENT_MODE)
            }
            DATA_STREAM_DATA::ID => {
                DATA_STREAM_DATA::deser(version, payload).map(Self::DATA_STREAM)
            }
            DISTANCE_SENSOR_DATA::ID => {
                DISTANCE_SENSOR_DATA::deser(version, payload).map(Self::DISTANCE_SENSOR)
            }
            ESTIMATOR_STATUS_DATA::ID => {
                ESTIMATOR_STATUS_DATA::deser(version, payload).map(Self::ESTIMATOR_STATUS)
            }
            EVENT_DATA::ID => EVENT_DATA::deser(version, payload).map(Self::EVENT),
            EXTENDED_SYS_STATE_DATA::ID => {
                EXTENDED_SYS_STATE_DATA::deser(version, payload).map(Self::EXTENDED_SYS_STATE)
            }
            FILE_TRANSFER_PROTOCOL_DATA::ID => FILE_TRANSFER_PROTOCOL_DATA::deser(version, payload)
                .map(Self::FILE_TRANSFER_PROTOCOL),
            GLOBAL_POSITION_INT_DATA::ID => {
                GLOBAL_POSITION_INT_DATA::deser(version, payload).map(Self::GLOBAL_POSITION_INT)
            }
            GPS_GLOBAL_ORIGIN_DATA::ID => {
                GPS_GLOBAL_ORIGIN_DATA::deser(version, payload).map(Self::GPS_GLOBAL_ORIGIN)
            }
            GPS_RAW_INT_DATA::ID => {
                GPS_RAW_INT_DATA::deser(version, payload).map(Self::GPS_RAW_INT)
            }
            HEARTBEAT_DATA::ID => HEARTBEAT_DATA::deser(version, payload).map(Self::HEARTBEAT),
            HOME_POSITION_DATA::ID => {
                HOME_POSITION_DATA::deser(version, payload).map(Self::HOME_POSITION)
            }
            LOCAL_POSITION_NED_DATA::ID => {
                LOCAL_POSITION_NED_DATA::deser(version, payload).map(Self::LOCAL_POSITION_NED)
            }
            MANUAL_CONTROL_DATA::ID => {
                MANUAL_CONTROL_DATA::deser(version, payload).map(Self::MANUAL_CONTROL)
            }
            MESSAGE_INTERVAL_DATA::ID => {
                MESSAGE_INTERVAL_DATA::deser(version, payload).map(Self::MESSAGE_INTERVAL)
            }
            MISSION_ACK_DATA::ID => {
                MISSION_ACK_DATA::deser(version, payload).map(Self::MISSION_ACK)
            }
            MISSION_CLEAR_ALL_DATA::ID => {
                MISSION_CLEAR_ALL_DATA::deser(version, payload).map(Self::MISSION_CLEAR_ALL)
            }
            MISSION_COUNT_DATA::ID => {
                MISSION_COUNT_DATA::deser(version, payload).map(Self::MISSION_COUNT)
            }
            MISSION_CURRENT_DATA::ID => {
                MISSION_CURRENT_DATA::deser(version, payload).map(Self::MISSION_CURRENT)
            }
            MISSION_ITEM_DATA::ID => {
                MISSION_ITEM_DATA::deser(version, payload).map(Self::MISSION_ITEM)
            }
            MISSION_ITEM_INT_DATA::ID => {
                MISSION_ITEM_INT_DATA::deser(version, payload).map(Self::MISSION_ITEM_INT)
            }
            MISSION_ITEM_REACHED_DATA::ID => {
                MISSION_ITEM_REACHED_DATA::deser(version, payload).map(Self::MISSION_ITEM_REACHED)
            }
            MISSION_REQUEST_DATA::ID => {
                MISSION_REQUEST_DATA::deser(version, payload).map(Self::MISSION_REQUEST)
            }
            MISSION_REQUEST_INT_DATA::ID => {
                MISSION_REQUEST_INT_DATA::deser(version, payload).map(Self::MISSION_REQUEST_INT)
            }
            MISSION_REQUEST_LIST_DATA::ID => {
                MISSION_REQUEST_LIST_DATA::deser(version, payload).map(Self::MISSION_REQUEST_LIST)
            }
            MISSION_REQUEST_PARTIAL_LIST_DATA::ID => {
                MISSION_REQUEST_PARTIAL_LIST_DATA::deser(version, payload)
                    .map(Self::MISSION_REQUEST_PARTIAL_LIST)
            }
            MISSION_SET_CURRENT_DATA::ID => {
                MISSION_SET_CURRENT_DATA::deser(version, payload).map(Self::MISSION_SET_CURRENT)
            }
            MISSION_WRITE_PARTIAL_LIST_DATA::ID => {
                MISSION_WRITE_PARTIAL_LIST_DATA::deser(version, payload)
                    .map(Self::MISSION_WRITE_PARTIAL_LIST)
            }
            NAV_CONTROLLER_OUTPUT_DATA::ID => {
                NAV_CONTROLLER_OUTPUT_DATA::deser(version, payload).map(Self::NAV_CONTROLLER_OUTPUT)
            }
            ODOMETRY_DATA::ID => ODOMETRY_DATA::deser(version, payload).map(Self::ODOMETRY),
            OPTICAL_FLOW_RAD_DATA::ID => {
                OPTICAL_FLOW_RAD_DATA::deser(version, payload).map(Self::OPTICAL_FLOW_RAD)
            }
            PARAM_ERROR_DATA::ID => {
                PARAM_ERROR_DATA::deser(version, payload).map(Self::PARAM_ERROR)
            }
            PARAM_REQUEST_LIST_DATA::ID => {
                PARAM_REQUEST_LIST_DATA::deser(version, payload).map(Self::PARAM_REQUEST_LIST)
            }
            PARAM_REQUEST_READ_DATA::ID => {
                PARAM_REQUEST_READ_DATA::deser(version, payload).map(Self::PARAM_REQUEST_READ)
            }
            PARAM_SET_DATA::ID => PARAM_SET_DATA::deser(version, payload).map(Self::PARAM_SET),
            PARAM_VALUE_DATA::ID => {
                PARAM_VALUE_DATA::deser(version, payload).map(Self::PARAM_VALUE)
            }
            PING_DATA::ID => PING_DATA::deser(version, payload).map(Self::PING),
            POSITION_TARGET_GLOBAL_INT_DATA::ID => {
                POSITION_TARGET_GLOBAL_INT_DATA::deser(version, payload)
                    .map(Self::POSITION_TARGET_GLOBAL_INT)
            }
            POSITION_TARGET_LOCAL_NED_DATA::ID => {
                POSITION_TARGET_LOCAL_NED_DATA::deser(version, payload)
                    .map(Self::POSITION_TARGET_LOCAL_NED)
            }
            PROTOCOL_VERSION_DATA::ID => {
                PROTOCOL_VERSION_DATA::deser(version, payload).map(Self::PROTOCOL_VERSION)
            }
            RC_CHANNELS_OVERRIDE_DATA::ID => {
                RC_CHANNELS_OVERRIDE_DATA::deser(version, payload).map(Self::RC_CHANNELS_OVERRIDE)
            }
            REQUEST_DATA_STREAM_DATA::ID => {
                REQUEST_DATA_STREAM_DATA::deser(version, payload).map(Self::REQUEST_DATA_STREAM)
            }
            SETUP_SIGNING_DATA::ID => {
                SETUP_SIGNING_DATA::deser(version, payload).map(Self::SETUP_SIGNING)
            }
            SET_ATTITUDE_TARGET_DATA::ID => {
                SET_ATTITUDE_TARGET_DATA::deser(version, payload).map(Self::SET_ATTITUDE_TARGET)
            }
            SET_GPS_GLOBAL_ORIGIN_DATA::ID => {
                SET_GPS_GLOBAL_ORIGIN_DATA::deser(version, payload).map(Self::SET_GPS_GLOBAL_ORIGIN)
            }
            SET_HOME_POSITION_DATA::ID => {
                SET_HOME_POSITION_DATA::deser(version, payload).map(Self::SET_HOME_POSITION)
            }
            SET_MODE_DATA::ID => SET_MODE_DATA::deser(version, payload).map(Self::SET_MODE),
            SET_POSITION_TARGET_GLOBAL_INT_DATA::ID => {
                SET_POSITION_TARGET_GLOBAL_INT_DATA::deser(version, payload)
                    .map(Self::SET_POSITION_TARGET_GLOBAL_INT)
            }
            SET_POSITION_TARGET_LOCAL_NED_DATA::ID => {
                SET_POSITION_TARGET_LOCAL_NED_DATA::deser(version, payload)
                    .map(Self::SET_POSITION_TARGET_LOCAL_NED)
            }
            STATUSTEXT_DATA::ID => STATUSTEXT_DATA::deser(version, payload).map(Self::STATUSTEXT),
            SYSTEM_TIME_DATA::ID => {
                SYSTEM_TIME_DATA::deser(version, payload).map(Self::SYSTEM_TIME)
            }
            SYS_STATUS_DATA::ID => SYS_STATUS_DATA::deser(version, payload).map(Self::SYS_STATUS),
            TIMESYNC_DATA::ID => TIMESYNC_DATA::deser(version, payload).map(Self::TIMESYNC),
            VFR_HUD_DATA::ID => VFR_HUD_DATA::deser(version, payload).map(Self::VFR_HUD),
            VIDEO_STREAM_INFORMATION_DATA::ID => {
                VIDEO_STREAM_INFORMATION_DATA::deser(version, payload)
                    .map(Self::VIDEO_STREAM_INFORMATION)
            }
            VIDEO_STREAM_STATUS_DATA::ID => {
                VIDEO_STREAM_STATUS_DATA::deser(version, payload).map(Self::VIDEO_STREAM_STATUS)
            }
            _ => Err(::mavlink_core::error::ParserError::UnknownMessage { id }),
        }
    }
    fn message_name(&self) -> &'static str {
        match self {
            Self::ALTITUDE(..) => ALTITUDE_DATA::NAME,
            Self::ATTITUDE(..) => ATTITUDE_DATA::NAME,
            Self::ATTITUDE_QUATERNION(..) => ATTITUDE_QUATERNION_DATA::NAME,
            Self::ATTITUDE_TARGET(..) => ATTITUDE_TARGET_DATA::NAME,
            Self::AUTOPILOT_VERSION(..) => AUTOPILOT_VERSION_DATA::NAME,
            Self::AVAILABLE_MODES(..) => AVAILABLE_MODES_DATA::NAME,
            Self::AVAILABLE_MODES_MONITOR(..) => AVAILABLE_MODES_MONITOR_DATA::NAME,
            Self::BATTERY_STATUS(..) => BATTERY_STATUS_DATA::NAME,
            Self::CAMERA_INFORMATION(..) => CAMERA_INFORMATION_DATA::NAME,
            Self::COMMAND_ACK(..) => COMMAND_ACK_DATA::NAME,
            Self::COMMAND_CANCEL(..) => COMMAND_CANCEL_DATA::NAME,
            Self::COMMAND_INT(..) => COMMAND_INT_DATA::NAME,
            Self::COMMAND_LONG(..) => COMMAND_LONG_DATA::NAME,
            Self::COMPONENT_METADATA(..) => COMPONENT_METADATA_DATA::NAME,
            Self::CURRENT_EVENT_SEQUENCE(..) => CURRENT_EVENT_SEQUENCE_DATA::NAME,
            Self::CURRENT_MODE(..) => CURRENT_MODE_DATA::NAME,
            Self::DATA_STREAM(..) => DATA_STREAM_DATA::NAME,
            Self::DISTANCE_SENSOR(..) => DISTANCE_SENSOR_DATA::NAME,
            Self::ESTIMATOR_STATUS(..) => ESTIMATOR_STATUS_DATA::NAME,
            Self::EVENT(..) => EVENT_DATA::NAME,
            Self::EXTENDED_SYS_STATE(..) => EXTENDED_SYS_STATE_DATA::NAME,
            Self::FILE_TRANSFER_PROTOCOL(..) => FILE_TRANSFER_PROTOCOL_DATA::NAME,
            Self::GLOBAL_POSITION_INT(..) => GLOBAL_POSITION_INT_DATA::NAME,
            Self::GPS_GLOBAL_ORIGIN(..) => GPS_GLOBAL_ORIGIN_DATA::NAME,
            Self::GPS_RAW_INT(..) => GPS_RAW_INT_DATA::NAME,
            Self::HEARTBEAT(..) => HEARTBEAT_DATA::NAME,
            Self::HOME_POSITION(..) => HOME_POSITION_DATA::NAME,
            Self::LOCAL_POSITION_NED(..) => LOCAL_POSITION_NED_DATA::NAME,
            Self::MANUAL_CONTROL(..) => MANUAL_CONTROL_DATA::NAME,
            Self::MESSAGE_INTERVAL(..) => MESSAGE_INTERVAL_DATA::NAME,
            Self::MISSION_ACK(..) => MISSION_ACK_DATA::NAME,
            Self::MISSION_CLEAR_ALL(..) => MISSION_CLEAR_ALL_DATA::NAME,
            Self::MISSION_COUNT(..) => MISSION_COUNT_DATA::NAME,
            Self::MISSION_CURRENT(..) => MISSION_CURRENT_DATA::NAME,
            Self::MISSION_ITEM(..) => MISSION_ITEM_DATA::NAME,
            Self::MISSION_ITEM_INT(..) => MISSION_ITEM_INT_DATA::NAME,
            Self::MISSION_ITEM_REACHED(..) => MISSION_ITEM_REACHED_DATA::NAME,
            Self::MISSION_REQUEST(..) => MISSION_REQUEST_DATA::NAME,
            Self::MISSION_REQUEST_INT(..) => MISSION_REQUEST_INT_DATA::NAME,
            Self::MISSION_REQUEST_LIST(..) => MISSION_REQUEST_LIST_DATA::NAME,
            Self::MISSION_REQUEST_PARTIAL_LIST(..) => MISSION_REQUEST_PARTIAL_LIST_DATA::NAME,
            Self::MISSION_SET_CURRENT(..) => MISSION_SET_CURRENT_DATA::NAME,
            Self::MISSION_WRITE_PARTIAL_LIST(..) => MISSION_WRITE_PARTIAL_LIST_DATA::NAME,
            Self::NAV_CONTROLLER_OUTPUT(..) => NAV_CONTROLLER_OUTPUT_DATA::NAME,
            Self::ODOMETRY(..) => ODOMETRY_DATA::NAME,
            Self::OPTICAL_FLOW_RAD(..) => OPTICAL_FLOW_RAD_DATA::NAME,
            Self::PARAM_ERROR(..) => PARAM_ERROR_DATA::NAME,
            Self::PARAM_REQUEST_LIST(..) => PARAM_REQUEST_LIST_DATA::NAME,
            Self::PARAM_REQUEST_READ(..) => PARAM_REQUEST_READ_DATA::NAME,
            Self::PARAM_SET(..) => PARAM_SET_DATA::NAME,
            Self::PARAM_VALUE(..) => PARAM_VALUE_DATA::NAME,
            Self::PING(..) => PING_DATA::NAME,
            Self::POSITION_TARGET_GLOBAL_INT(..) => POSITION_TARGET_GLOBAL_INT_DATA::NAME,
            Self::POSITION_TARGET_LOCAL_NED(..) => POSITION_TARGET_LOCAL_NED_DATA::NAME,
            Self::PROTOCOL_VERSION(..) => PROTOCOL_VERSION_DATA::NAME,
            Self::RC_CHANNELS_OVERRIDE(..) => RC_CHANNELS_OVERRIDE_DATA::NAME,
            Self::REQUEST_DATA_STREAM(..) => REQUEST_DATA_STREAM_DATA::NAME,
            Self::SETUP_SIGNING(..) => SETUP_SIGNING_DATA::NAME,
            Self::SET_ATTITUDE_TARGET(..) => SET_ATTITUDE_TARGET_DATA::NAME,
            Self::SET_GPS_GLOBAL_ORIGIN(..) => SET_GPS_GLOBAL_ORIGIN_DATA::NAME,
            Self::SET_HOME_POSITION(..) => SET_HOME_POSITION_DATA::NAME,
            Self::SET_MODE(..) => SET_MODE_DATA::NAME,
            Self::SET_POSITION_TARGET_GLOBAL_INT(..) => SET_POSITION_TARGET_GLOBAL_INT_DATA::NAME,
            Self::SET_POSITION_TARGET_LOCAL_NED(..) => SET_POSITION_TARGET_LOCAL_NED_DATA::NAME,
            Self::STATUSTEXT(..) => STATUSTEXT_DATA::NAME,
            Self::SYSTEM_TIME(..) => SYSTEM_TIME_DATA::NAME,
            Self::SYS_STATUS(..) => SYS_STATUS_DATA::NAME,
            Self::TIMESYNC(..) => TIMESYNC_DATA::NAME,
            Self::VFR_HUD(..) => VFR_HUD_DATA::NAME,
            Self::VIDEO_STREAM_INFORMATION(..) => VIDEO_STREAM_INFORMATION_DATA::NAME,
            Self::VIDEO_STREAM_STATUS(..) => VIDEO_STREAM_STATUS_DATA::NAME,
        }
    }
    fn message_id(&self) -> u32 {
        match self {
            Self::ALTITUDE(..) => ALTITUDE_DATA::ID,
            Self::ATTITUDE(..) => ATTITUDE_DATA::ID,
            Self::ATTITUDE_QUATERNION(..) => ATTITUDE_QUATERNION_DATA::ID,
            Self::ATTITUDE_TARGET(..) => ATTITUDE_TARGET_DATA::ID,
            Self::AUTOPILOT_VERSION(..) => AUTOPILOT_VERSION_DATA::ID,
            Self::AVAILABLE_MODES(..) => AVAILABLE_MODES_DATA::ID,
            Self::AVAILABLE_MODES_MONITOR(..) => AVAILABLE_MODES_MONITOR_DATA::ID,
            Self::BATTERY_STATUS(..) => BATTERY_STATUS_DATA::ID,
            Self::CAMERA_INFORMATION(..) => CAMERA_INFORMATION_DATA::ID,
            Self::COMMAND_ACK(..) => COMMAND_ACK_DATA::ID,
            Self::COMMAND_CANCEL(..) => COMMAND_CANCEL_DATA::ID,
            Self::COMMAND_INT(..) => COMMAND_INT_DATA::ID,
            Self::COMMAND_LONG(..) => COMMAND_LONG_DATA::ID,
            Self::COMPONENT_METADATA(..) => COMPONENT_METADATA_DATA::ID,
            Self::CURRENT_EVENT_SEQUENCE(..) => CURRENT_EVENT_SEQUENCE_DATA::ID,
            Self::CURRENT_MODE(..) => CURRENT_MODE_DATA::ID,
            Self::DATA_STREAM(..) => DATA_STREAM_DATA::ID,
            Self::DISTANCE_SENSOR(..) => DISTANCE_SENSOR_DATA::ID,
            Self::ESTIMATOR_STATUS(..) => ESTIMATOR_STATUS_DATA::ID,
            Self::EVENT(..) => EVENT_DATA::ID,
            Self::EXTENDED_SYS_STATE(..) => EXTENDED_SYS_STATE_DATA::ID,
            Self::FILE_TRANSFER_PROTOCOL(..) => FILE_TRANSFER_PROTOCOL_DATA::ID,
            Self::GLOBAL_POSITION_INT(..) => GLOBAL_POSITION_INT_DATA::ID,
            Self::GPS_GLOBAL_ORIGIN(..) => GPS_GLOBAL_ORIGIN_DATA::ID,
            Self::GPS_RAW_INT(..) => GPS_RAW_INT_DATA::ID,
            Self::HEARTBEAT(..) => HEARTBEAT_DATA::ID,
            Self::HOME_POSITION(..) => HOME_POSITION_DATA::ID,
            Self::LOCAL_POSITION_NED(..) => LOCAL_POSITION_NED_DATA::ID,
            Self::MANUAL_CONTROL(..) => MANUAL_CONTROL_DATA::ID,
            Self::MESSAGE_INTERVAL(..) => MESSAGE_INTERVAL_DATA::ID,
            Self::MISSION_ACK(..) => MISSION_ACK_DATA::ID,
            Self::MISSION_CLEAR_ALL(..) => MISSION_CLEAR_ALL_DATA::ID,
            Self::MISSION_COUNT(..) => MISSION_COUNT_DATA::ID,
            Self::MISSION_CURRENT(..) => MISSION_CURRENT_DATA::ID,
            Self::MISSION_ITEM(..) => MISSION_ITEM_DATA::ID,
            Self::MISSION_ITEM_INT(..) => MISSION_ITEM_INT_DATA::ID,
            Self::MISSION_ITEM_REACHED(..) => MISSION_ITEM_REACHED_DATA::ID,
            Self::MISSION_REQUEST(..) => MISSION_REQUEST_DATA::ID,
            Self::MISSION_REQUEST_INT(..) => MISSION_REQUEST_INT_DATA::ID,
            Self::MISSION_REQUEST_LIST(..) => MISSION_REQUEST_LIST_DATA::ID,
            Self::MISSION_REQUEST_PARTIAL_LIST(..) => MISSION_REQUEST_PARTIAL_LIST_DATA::ID,
            Self::MISSION_SET_CURRENT(..) => MISSION_SET_CURRENT_DATA::ID,
            Self::MISSION_WRITE_PARTIAL_LIST(..) => MISSION_WRITE_PARTIAL_LIST_DATA::ID,
            Self::NAV_CONTROLLER_OUTPUT(..) => NAV_CONTROLLER_OUTPUT_DATA::ID,
            Self::ODOMETRY(..) => ODOMETRY_DATA::ID,
            Self::OPTICAL_FLOW_RAD(..) => OPTICAL_FLOW_RAD_DATA::ID,
            Self::PARAM_ERROR(..) => PARAM_ERROR_DATA::ID,
            Self::PARAM_REQUEST_LIST(..) => PARAM_REQUEST_LIST_DATA::ID,
            Self::PARAM_REQUEST_READ(..) => PARAM_REQUEST_READ_DATA::ID,
            Self::PARAM_SET(..) => PARAM_SET_DATA::ID,
            Self::PARAM_VALUE(..) => PARAM_VALUE_DATA::ID,
            Self::PING(..) => PING_DATA::ID,
            Self::POSITION_TARGET_GLOBAL_INT(..) => POSITION_TARGET_GLOBAL_INT_DATA::ID,
            Self::POSITION_TARGET_LOCAL_NED(..) => POSITION_TARGET_LOCAL_NED_DATA::ID,
            Self::PROTOCOL_VERSION(..) => PROTOCOL_VERSION_DATA::ID,
            Self::RC_CHANNELS_OVERRIDE(..) => RC_CHANNELS_OVERRIDE_DATA::ID,
            Self::REQUEST_DATA_STREAM(..) => REQUEST_DATA_STREAM_DATA::ID,
            Self::SETUP_SIGNING(..) => SETUP_SIGNING_DATA::ID,
            Self::SET_ATTITUDE_TARGET(..) => SET_ATTITUDE_TARGET_DATA::ID,
            Self::SET_GPS_GLOBAL_ORIGIN(..) => SET_GPS_GLOBAL_ORIGIN_DATA::ID,
            Self::SET_HOME_POSITION(..) => SET_HOME_POSITION_DATA::ID,
            Self::SET_MODE(..) => SET_MODE_DATA::ID,
            Self::SET_POSITION_TARGET_GLOBAL_INT(..) => SET_POSITION_TARGET_GLOBAL_INT_DATA::ID,
            Self::SET_POSITION_TARGET_LOCAL_NED(..) => SET_POSITION_TARGET_LOCAL_NED_DATA::ID,
            Self::STATUSTEXT(..) => STATUSTEXT_DATA::ID,
            Self::SYSTEM_TIME(..) => SYSTEM_TIME_DATA::ID,
            Self::SYS_STATUS(..) => SYS_STATUS_DATA::ID,
            Self::TIMESYNC(..) => TIMESYNC_DATA::ID,
            Self::VFR_HUD(..) => VFR_HUD_DATA::ID,
            Self::VIDEO_STREAM_INFORMATION(..) => VIDEO_STREAM_INFORMATION_DATA::ID,
            Self::VIDEO_STREAM_STATUS(..) => VIDEO_STREAM_STATUS_DATA::ID,
        }
    }
    fn message_id_from_name(name: &str) -> Option<u32> {
        match name {
            ALTITUDE_DATA::NAME => Some(ALTITUDE_DATA::ID),
            ATTITUDE_DATA::NAME => Some(ATTITUDE_DATA::ID),
            ATTITUDE_QUATERNION_DATA::NAME => Some(ATTITUDE_QUATERNION_DATA::ID),
            ATTITUDE_TARGET_DATA::NAME => Some(ATTITUDE_TARGET_DATA::ID),
            AUTOPILOT_VERSION_DATA::NAME => Some(AUTOPILOT_VERSION_DATA::ID),
            AVAILABLE_MODES_DATA::NAME => Some(AVAILABLE_MODES_DATA::ID),
            AVAILABLE_MODES_MONITOR_DATA::NAME => Some(AVAILABLE_MODES_MONITOR_DATA::ID),
            BATTERY_STATUS_DATA::NAME => Some(BATTERY_STATUS_DATA::ID),
            CAMERA_INFORMATION_DATA::NAME => Some(CAMERA_INFORMATION_DATA::ID),
            COMMAND_ACK_DATA::NAME => Some(COMMAND_ACK_DATA::ID),
            COMMAND_CANCEL_DATA::NAME => Some(COMMAND_CANCEL_DATA::ID),
            COMMAND_INT_DATA::NAME => Some(COMMAND_INT_DATA::ID),
            COMMAND_LONG_DATA::NAME => Some(COMMAND_LONG_DATA::ID),
            COMPONENT_METADATA_DATA::NAME => Some(COMPONENT_METADATA_DATA::ID),
            CURRENT_EVENT_SEQUENCE_DATA::NAME => Some(CURRENT_EVENT_SEQUENCE_DATA::ID),
            CURRENT_MODE_DATA::NAME => Some(CURRENT_MODE_DATA::ID),
            DATA_STREAM_DATA::NAME => Some(DATA_STREAM_DATA::ID),
            DISTANCE_SENSOR_DATA::NAME => Some(DISTANCE_SENSOR_DATA::ID),
            ESTIMATOR_STATUS_DATA::NAME => Some(ESTIMATOR_STATUS_DATA::ID),
            EVENT_DATA::NAME => Some(EVENT_DATA::ID),
            EXTENDED_SYS_STATE_DATA::NAME => Some(EXTENDED_SYS_STATE_DATA::ID),
            FILE_TRANSFER_PROTOCOL_DATA::NAME => Some(FILE_TRANSFER_PROTOCOL_DATA::ID),
            GLOBAL_POSITION_INT_DATA::NAME => Some(GLOBAL_POSITION_INT_DATA::ID),
            GPS_GLOBAL_ORIGIN_DATA::NAME => Some(GPS_GLOBAL_ORIGIN_DATA::ID),
            GPS_RAW_INT_DATA::NAME => Some(GPS_RAW_INT_DATA::ID),
            HEARTBEAT_DATA::NAME => Some(HEARTBEAT_DATA::ID),
            HOME_POSITION_DATA::NAME => Some(HOME_POSITION_DATA::ID),
            LOCAL_POSITION_NED_DATA::NAME => Some(LOCAL_POSITION_NED_DATA::ID),
            MANUAL_CONTROL_DATA::NAME => Some(MANUAL_CONTROL_DATA::ID),
            MESSAGE_INTERVAL_DATA::NAME => Some(MESSAGE_INTERVAL_DATA::ID),
            MISSION_ACK_DATA::NAME => Some(MISSION_ACK_DATA::ID),
            MISSION_CLEAR_ALL_DATA::NAME => Some(MISSION_CLEAR_ALL_DATA::ID),
            MISSION_COUNT_DATA::NAME => Some(MISSION_COUNT_DATA::ID),
            MISSION_CURRENT_DATA::NAME => Some(MISSION_CURRENT_DATA::ID),
            MISSION_ITEM_DATA::NAME => Some(MISSION_ITEM_DATA::ID),
            MISSION_ITEM_INT_DATA::NAME => Some(MISSION_ITEM_INT_DATA::ID),
            MISSION_ITEM_REACHED_DATA::NAME => Some(MISSION_ITEM_REACHED_DATA::ID),
            MISSION_REQUEST_DATA::NAME => Some(MISSION_REQUEST_DATA::ID),
            MISSION_REQUEST_INT_DATA::NAME => Some(MISSION_REQUEST_INT_DATA::ID),
            MISSION_REQUEST_LIST_DATA::NAME => Some(MISSION_REQUEST_LIST_DATA::ID),
            MISSION_REQUEST_PARTIAL_LIST_DATA::NAME => Some(MISSION_REQUEST_PARTIAL_LIST_DATA::ID),
            MISSION_SET_CURRENT_DATA::NAME => Some(MISSION_SET_CURRENT_DATA::ID),
            MISSION_WRITE_PARTIAL_LIST_DATA::NAME => Some(MISSION_WRITE_PARTIAL_LIST_DATA::ID),
            NAV_CONTROLLER_OUTPUT_DATA::NAME => Some(NAV_CONTROLLER_OUTPUT_DATA::ID),
            ODOMETRY_DATA::NAME => Some(ODOMETRY_DATA::ID),
            OPTICAL_FLOW_RAD_DATA::NAME => Some(OPTICAL_FLOW_RAD_DATA::ID),
            PARAM_ERROR_DATA::NAME => Some(PARAM_ERROR_DATA::ID),
            PARAM_REQUEST_LIST_DATA::NAME => Some(PARAM_REQUEST_LIST_DATA::ID),
            PARAM_REQUEST_READ_DATA::NAME => Some(PARAM_REQUEST_READ_DATA::ID),
            PARAM_SET_DATA::NAME => Some(PARAM_SET_DATA::ID),
            PARAM_VALUE_DATA::NAME => Some(PARAM_VALUE_DATA::ID),
            PING_DATA::NAME => Some(PING_DATA::ID),
            POSITION_TARGET_GLOBAL_INT_DATA::NAME => Some(POSITION_TARGET_GLOBAL_INT_DATA::ID),
            POSITION_TARGET_LOCAL_NED_DATA::NAME => Some(POSITION_TARGET_LOCAL_NED_DATA::ID),
            PROTOCOL_VERSION_DATA::NAME => Some(PROTOCOL_VERSION_DATA::ID),
            RC_CHANNELS_OVERRIDE_DATA::NAME => Some(RC_CHANNELS_OVERRIDE_DATA::ID),
            REQUEST_DATA_STREAM_DATA::NAME => Some(REQUEST_DATA_STREAM_DATA::ID),
            SETUP_SIGNING_DATA::NAME => Some(SETUP_SIGNING_DATA::ID),
            SET_ATTITUDE_TARGET_DATA::NAME => Some(SET_ATTITUDE_TARGET_DATA::ID),
            SET_GPS_GLOBAL_ORIGIN_DATA::NAME => Some(SET_GPS_GLOBAL_ORIGIN_DATA::ID),
            SET_HOME_POSITION_DATA::NAME => Some(SET_HOME_POSITION_DATA::ID),
            SET_MODE_DATA::NAME => Some(SET_MODE_DATA::ID),
            SET_POSITION_TARGET_GLOBAL_INT_DATA::NAME => {
                Some(SET_POSITION_TARGET_GLOBAL_INT_DATA::ID)
            }
            SET_POSITION_TARGET_LOCAL_NED_DATA::NAME => {
                Some(SET_POSITION_TARGET_LOCAL_NED_DATA::ID)
            }
            STATUSTEXT_DATA::NAME => Some(STATUSTEXT_DATA::ID),
            SYSTEM_TIME_DATA::NAME => Some(SYSTEM_TIME_DATA::ID),
            SYS_STATUS_DATA::NAME => Some(SYS_STATUS_DATA::ID),
            TIMESYNC_DATA::NAME => Some(TIMESYNC_DATA::ID),
            VFR_HUD_DATA::NAME => Some(VFR_HUD_DATA::ID),
            VIDEO_STREAM_INFORMATION_DATA::NAME => Some(VIDEO_STREAM_INFORMATION_DATA::ID),
            VIDEO_STREAM_STATUS_DATA::NAME => Some(VIDEO_STREAM_STATUS_DATA::ID),
            _ => None,
        }
    }
    fn default_message_from_id(id: u32) -> Option<Self> {
        match id {
            ALTITUDE_DATA::ID => Some(Self::ALTITUDE(ALTITUDE_DATA::default())),
            ATTITUDE_DATA::ID => Some(Self::ATTITUDE(ATTITUDE_DATA::default())),
            ATTITUDE_QUATERNION_DATA::ID => {
                Some(Self::ATTITUDE_QUATERNION(ATTITUDE_QUATERNION_DATA::default()))
            }
            ATTITUDE_TARGET_DATA::ID => {
                Some(Self::ATTITUDE_TARGET(ATTITUDE_TARGET_DATA::default()))
            }
            AUTOPILOT_VERSION_DATA::ID => {
                Some(Self::AUTOPILOT_VERSION(AUTOPILOT_VERSION_DATA::default()))
            }
            AVAILABLE_MODES_DATA::ID => {
                Some(Self::AVAILABLE_MODES(AVAILABLE_MODES_DATA::default()))
            }
            AVAILABLE_MODES_MONITOR_DATA::ID => {
                Some(Self::AVAILABLE_MODES_MONITOR(AVAILABLE_MODES_MONITOR_DATA::default()))
            }
            BATTERY_STATUS_DATA::ID => Some(Self::BATTERY_STATUS(BATTERY_STATUS_DATA::default())),
            CAMERA_INFORMATION_DATA::ID => {
                Some(Self::CAMERA_INFORMATION(CAMERA_INFORMATION_DATA::default()))
            }
            COMMAND_ACK_DATA::ID => Some(Self::COMMAND_ACK(COMMAND_ACK_DATA::default())),
            COMMAND_CANCEL_DATA::ID => Some(Self::COMMAND_CANCEL(COMMAND_CANCEL_DATA::default())),
            COMMAND_INT_DATA::ID => Some(Self::COMMAND_INT(COMMAND_INT_DATA::default())),
            COMMAND_LONG_DATA::ID => Some(Self::COMMAND_LONG(COMMAND_LONG_DATA::default())),
            COMPONENT_METADATA_DATA::ID => {
                Some(Self::COMPONENT_METADATA(COMPONENT_METADATA_DATA::default()))
            }
            CURRENT_EVENT_SEQUENCE_DATA::ID => {
                Some(Self::CURRENT_EVENT_SEQUENCE(CURRENT_EVENT_SEQUENCE_DATA::default()))
            }
            CURRENT_MODE_DATA::ID => Some(Self::CURRENT_MODE(CURRENT_MODE_DATA::default())),
            DATA_STREAM_DATA::ID => Some(Self::DATA_STREAM(DATA_STREAM_DATA::default())),
            DISTANCE_SENSOR_DATA::ID => {
                Some(Self::DISTANCE_SENSOR(DISTANCE_SENSOR_DATA::default()))
            }
            ESTIMATOR_STATUS_DATA::ID => {
                Some(Self::ESTIMATOR_STATUS(ESTIMATOR_STATUS_DATA::default()))
            }
            EVENT_DATA::ID => Some(Self::EVENT(EVENT_DATA::default())),
            EXTENDED_SYS_STATE_DATA::ID => {
                Some(Self::EXTENDED_SYS_STATE(EXTENDED_SYS_STATE_DATA::default()))
            }
            FILE_TRANSFER_PROTOCOL_DATA::ID => {
                Some(Self::FILE_TRANSFER_PROTOCOL(FILE_TRANSFER_PROTOCOL_DATA::default()))
            }
            GLOBAL_POSITION_INT_DATA::ID => {
                Some(Self::GLOBAL_POSITION_INT(GLOBAL_POSITION_INT_DATA::default()))
            }
            GPS_GLOBAL_ORIGIN_DATA::ID => {
                Some(Self::GPS_GLOBAL_ORIGIN(GPS_GLOBAL_ORIGIN_DATA::default()))
            }
            GPS_RAW_INT_DATA::ID => Some(Self::GPS_RAW_INT(GPS_RAW_INT_DATA::default())),
            HEARTBEAT_DATA::ID => Some(Self::HEARTBEAT(HEARTBEAT_DATA::default())),
            HOME_POSITION_DATA::ID => Some(Self::HOME_POSITION(HOME_POSITION_DATA::default())),
            LOCAL_POSITION_NED_DATA::ID => {
                Some(Self::LOCAL_POSITION_NED(LOCAL_POSITION_NED_DATA::default()))
            }
            MANUAL_CONTROL_DATA::ID => Some(Self::MANUAL_CONTROL(MANUAL_CONTROL_DATA::default())),
            MESSAGE_INTERVAL_DATA::ID => {
                Some(Self::MESSAGE_INTERVAL(MESSAGE_INTERVAL_DATA::default()))
            }
            MISSION_ACK_DATA::ID => Some(Self::MISSION_ACK(MISSION_ACK_DATA::default())),
            MISSION_CLEAR_ALL_DATA::ID => {
                Some(Self::MISSION_CLEAR_ALL(MISSION_CLEAR_ALL_DATA::default()))
            }
            MISSION_COUNT_DATA::ID => Some(Self::MISSION_COUNT(MISSION_COUNT_DATA::default())),
            MISSION_CURRENT_DATA::ID => {
                Some(Self::MISSION_CURRENT(MISSION_CURRENT_DATA::default()))
            }
            MISSION_ITEM_DATA::ID => Some(Self::MISSION_ITEM(MISSION_ITEM_DATA::default())),
            MISSION_ITEM_INT_DATA::ID => {
                Some(Self::MISSION_ITEM_INT(MISSION_ITEM_INT_DATA::default()))
            }
            MISSION_ITEM_REACHED_DATA::ID => {
                Some(Self::MISSION_ITEM_REACHED(MISSION_ITEM_REACHED_DATA::default()))
            }
            MISSION_REQUEST_DATA::ID => {
                Some(Self::MISSION_REQUEST(MISSION_REQUEST_DATA::default()))
            }
            MISSION_REQUEST_INT_DATA::ID => {
                Some(Self::MISSION_REQUEST_INT(MISSION_REQUEST_INT_DATA::default()))
            }
            MISSION_REQUEST_LIST_DATA::ID => {
                Some(Self::MISSION_REQUEST_LIST(MISSION_REQUEST_LIST_DATA::default()))
            }
            MISSION_REQUEST_PARTIAL_LIST_DATA::ID => Some(Self::MISSION_REQUEST_PARTIAL_LIST(
                MISSION_REQUEST_PARTIAL_LIST_DATA::default(),
            )),
            MISSION_SET_CURRENT_DATA::ID => {
                Some(Self::MISSION_SET_CURRENT(MISSION_SET_CURRENT_DATA::default()))
            }
            MISSION_WRITE_PARTIAL_LIST_DATA::ID => {
                Some(Self::MISSION_WRITE_PARTIAL_LIST(MISSION_WRITE_PARTIAL_LIST_DATA::default()))
            }
            NAV_CONTROLLER_OUTPUT_DATA::ID => {
                Some(Self::NAV_CONTROLLER_OUTPUT(NAV_CONTROLLER_OUTPUT_DATA::default()))
            }
            ODOMETRY_DATA::ID => Some(Self::ODOMETRY(ODOMETRY_DATA::default())),
            OPTICAL_FLOW_RAD_DATA::ID => {
                Some(Self::OPTICAL_FLOW_RAD(OPTICAL_FLOW_RAD_DATA::default()))
            }
            PARAM_ERROR_DATA::ID => Some(Self::PARAM_ERROR(PARAM_ERROR_DATA::default())),
            PARAM_REQUEST_LIST_DATA::ID => {
                Some(Self::PARAM_REQUEST_LIST(PARAM_REQUEST_LIST_DATA::default()))
            }
            PARAM_REQUEST_READ_DATA::ID => {
                Some(Self::PARAM_REQUEST_READ(PARAM_REQUEST_READ_DATA::default()))
            }
            PARAM_SET_DATA::ID => Some(Self::PARAM_SET(PARAM_SET_DATA::default())),
            PARAM_VALUE_DATA::ID => Some(Self::PARAM_VALUE(PARAM_VALUE_DATA::default())),
            PING_DATA::ID => Some(Self::PING(PING_DATA::default())),
            POSITION_TARGET_GLOBAL_INT_DATA::ID => {
                Some(Self::POSITION_TARGET_GLOBAL_INT(POSITION_TARGET_GLOBAL_INT_DATA::default()))
            }
            POSITION_TARGET_LOCAL_NED_DATA::ID => {
                Some(Self::POSITION_TARGET_LOCAL_NED(POSITION_TARGET_LOCAL_NED_DATA::default()))
            }
            PROTOCOL_VERSION_DATA::ID => {
                Some(Self::PROTOCOL_VERSION(PROTOCOL_VERSION_DATA::default()))
            }
            RC_CHANNELS_OVERRIDE_DATA::ID => {
                Some(Self::RC_CHANNELS_OVERRIDE(RC_CHANNELS_OVERRIDE_DATA::default()))
            }
            REQUEST_DATA_STREAM_DATA::ID => {
                Some(Self::REQUEST_DATA_STREAM(REQUEST_DATA_STREAM_DATA::default()))
            }
            SETUP_SIGNING_DATA::ID => Some(Self::SETUP_SIGNING(SETUP_SIGNING_DATA::default())),
            SET_ATTITUDE_TARGET_DATA::ID => {
                Some(Self::SET_ATTITUDE_TARGET(SET_ATTITUDE_TARGET_DATA::default()))
            }
            SET_GPS_GLOBAL_ORIGIN_DATA::ID => {
                Some(Self::SET_GPS_GLOBAL_ORIGIN(SET_GPS_GLOBAL_ORIGIN_DATA::default()))
            }
            SET_HOME_POSITION_DATA::ID => {
                Some(Self::SET_HOME_POSITION(SET_HOME_POSITION_DATA::default()))
            }
            SET_MODE_DATA::ID => Some(Self::SET_MODE(SET_MODE_DATA::default())),
            SET_POSITION_TARGET_GLOBAL_INT_DATA::ID => Some(Self::SET_POSITION_TARGET_GLOBAL_INT(
                SET_POSITION_TARGET_GLOBAL_INT_DATA::default(),
            )),
            SET_POSITION_TARGET_LOCAL_NED_DATA::ID => Some(Self::SET_POSITION_TARGET_LOCAL_NED(
                SET_POSITION_TARGET_LOCAL_NED_DATA::default(),
            )),
            STATUSTEXT_DATA::ID => Some(Self::STATUSTEXT(STATUSTEXT_DATA::default())),
            SYSTEM_TIME_DATA::ID => Some(Self::SYSTEM_TIME(SYSTEM_TIME_DATA::default())),
            SYS_STATUS_DATA::ID => Some(Self::SYS_STATUS(SYS_STATUS_DATA::default())),
            TIMESYNC_DATA::ID => Some(Self::TIMESYNC(TIMESYNC_DATA::default())),
            VFR_HUD_DATA::ID => Some(Self::VFR_HUD(VFR_HUD_DATA::default())),
            VIDEO_STREAM_INFORMATION_DATA::ID => {
                Some(Self::VIDEO_STREAM_INFORMATION(VIDEO_STREAM_INFORMATION_DATA::default()))
            }
            VIDEO_STREAM_STATUS_DATA::ID => {
                Some(Self::VIDEO_STREAM_STATUS(VIDEO_STREAM_STATUS_DATA::default()))
            }
            _ => None,
        }
    }
    fn ser(&self, version: MavlinkVersion, bytes: &mut [u8]) -> usize {
        match self {
            Self::ALTITUDE(body) => body.ser(version, bytes),
            Self::ATTITUDE(body) => body.ser(version, bytes),
            Self::ATTITUDE_QUATERNION(body) => body.ser(version, bytes),
            Self::ATTITUDE_TARGET(body) => body.ser(version, bytes),
            Self::AUTOPILOT_VERSION(body) => body.ser(version, bytes),
            Self::AVAILABLE_MODES(body) => body.ser(version, bytes),
            Self::AVAILABLE_MODES_MONITOR(body) => body.ser(version, bytes),
            Self::BATTERY_STATUS(body) => body.ser(version, bytes),
            Self::CAMERA_INFORMATION(body) => body.ser(version, bytes),
            Self::COMMAND_ACK(body) => body.ser(version, bytes),
            Self::COMMAND_CANCEL(body) => body.ser(version, bytes),
            Self::COMMAND_INT(body) => body.ser(version, bytes),
            Self::COMMAND_LONG(body) => body.ser(version, bytes),
            Self::COMPONENT_METADATA(body) => body.ser(version, bytes),
            Self::CURRENT_EVENT_SEQUENCE(body) => body.ser(version, bytes),
            Self::CURRENT_MODE(body) => body.ser(version, bytes),
            Self::DATA_STREAM(body) => body.ser(version, bytes),
            Self::DISTANCE_SENSOR(body) => body.ser(version, bytes),
            Self::ESTIMATOR_STATUS(body) => body.ser(version, bytes),
            Self::EVENT(body) => body.ser(version, bytes),
            Self::EXTENDED_SYS_STATE(body) => body.ser(version, bytes),
            Self::FILE_TRANSFER_PROTOCOL(body) => body.ser(version, bytes),
            Self::GLOBAL_POSITION_INT(body) => body.ser(version, bytes),
            Self::GPS_GLOBAL_ORIGIN(body) => body.ser(version, bytes),
            Self::GPS_RAW_INT(body) => body.ser(version, bytes),
            Self::HEARTBEAT(body) => body.ser(version, bytes),
            Self::HOME_POSITION(body) => body.ser(version, bytes),
            Self::LOCAL_POSITION_NED(body) => body.ser(version, bytes),
            Self::MANUAL_CONTROL(body) => body.ser(version, bytes),
            Self::MESSAGE_INTERVAL(body) => body.ser(version, bytes),
            Self::MISSION_ACK(body) => body.ser(version, bytes),
            Self::MISSION_CLEAR_ALL(body) => body.ser(version, bytes),
            Self::MISSION_COUNT(body) => body.ser(version, bytes),
            Self::MISSION_CURRENT(body) => body.ser(version, bytes),
            Self::MISSION_ITEM(body) => body.ser(version, bytes),
            Self::MISSION_ITEM_INT(body) => body.ser(version, bytes),
            Self::MISSION_ITEM_REACHED(body) => body.ser(version, bytes),
            Self::MISSION_REQUEST(body) => body.ser(version, bytes),
            Self::MISSION_REQUEST_INT(body) => body.ser(version, bytes),
            Self::MISSION_REQUEST_LIST(body) => body.ser(version, bytes),
            Self::MISSION_REQUEST_PARTIAL_LIST(body) => body.ser(version, bytes),
            Self::MISSION_SET_CURRENT(body) => body.ser(version, bytes),
            Self::MISSION_WRITE_PARTIAL_LIST(body) => body.ser(version, bytes),
            Self::NAV_CONTROLLER_OUTPUT(body) => body.ser(version, bytes),
            Self::ODOMETRY(body) => body.ser(version, bytes),
            Self::OPTICAL_FLOW_RAD(body) => body.ser(version, bytes),
            Self::PARAM_ERROR(body) => body.ser(version, bytes),
            Self::PARAM_REQUEST_LIST(body) => body.ser(version, bytes),
            Self::PARAM_REQUEST_READ(body) => body.ser(version, bytes),
            Self::PARAM_SET(body) => body.ser(version, bytes),
            Self::PARAM_VALUE(body) => body.ser(version, bytes),
            Self::PING(body) => body.ser(version, bytes),
            Self::POSITION_TARGET_GLOBAL_INT(body) => body.ser(version, bytes),
            Self::POSITION_TARGET_LOCAL_NED(body) => body.ser(version, bytes),
            Self::PROTOCOL_VERSION(body) => body.ser(version, bytes),
            Self::RC_CHANNELS_OVERRIDE(body) => body.ser(version, bytes),
            Self::REQUEST_DATA_STREAM(body) => body.ser(version, bytes),
            Self::SETUP_SIGNING(body) => body.ser(version, bytes),
            Self::SET_ATTITUDE_TARGET(body) => body.ser(version, bytes),
            Self::SET_GPS_GLOBAL_ORIGIN(body) => body.ser(version, bytes),
            Self::SET_HOME_POSITION(body) => body.ser(version, bytes),
            Self::SET_MODE(body) => body.ser(version, bytes),
            Self::SET_POSITION_TARGET_GLOBAL_INT(body) => body.ser(version, bytes),
            Self::SET_POSITION_TARGET_LOCAL_NED(body) => body.ser(version, bytes),
            Self::STATUSTEXT(body) => body.ser(version, bytes),
            Self::SYSTEM_TIME(body) => body.ser(version, bytes),
            Self::SYS_STATUS(body) => body.ser(version, bytes),
            Self::TIMESYNC(body) => body.ser(version, bytes),
            Self::VFR_HUD(body) => body.ser(version, bytes),
            Self::VIDEO_STREAM_INFORMATION(body) => body.ser(version, bytes),
            Self::VIDEO_STREAM_STATUS(body) => body.ser(version, bytes),
        }
    }
    fn extra_crc(id: u32) -> u8 {
        match id {
            ALTITUDE_DATA::ID => ALTITUDE_DATA::EXTRA_CRC,
            ATTITUDE_DATA::ID => ATTITUDE_DATA::EXTRA_CRC,
            ATTITUDE_QUATERNION_DATA::ID => ATTITUDE_QUATERNION_DATA::EXTRA_CRC,
            ATTITUDE_TARGET_DATA::ID => ATTITUDE_TARGET_DATA::EXTRA_CRC,
            AUTOPILOT_VERSION_DATA::ID => AUTOPILOT_VERSION_DATA::EXTRA_CRC,
            AVAILABLE_MODES_DATA::ID => AVAILABLE_MODES_DATA::EXTRA_CRC,
            AVAILABLE_MODES_MONITOR_DATA::ID => AVAILABLE_MODES_MONITOR_DATA::EXTRA_CRC,
            BATTERY_STATUS_DATA::ID => BATTERY_STATUS_DATA::EXTRA_CRC,
            CAMERA_INFORMATION_DATA::ID => CAMERA_INFORMATION_DATA::EXTRA_CRC,
            COMMAND_ACK_DATA::ID => COMMAND_ACK_DATA::EXTRA_CRC,
            COMMAND_CANCEL_DATA::ID => COMMAND_CANCEL_DATA::EXTRA_CRC,
            COMMAND_INT_DATA::ID => COMMAND_INT_DATA::EXTRA_CRC,
            COMMAND_LONG_DATA::ID => COMMAND_LONG_DATA::EXTRA_CRC,
            COMPONENT_METADATA_DATA::ID => COMPONENT_METADATA_DATA::EXTRA_CRC,
            CURRENT_EVENT_SEQUENCE_DATA::ID => CURRENT_EVENT_SEQUENCE_DATA::EXTRA_CRC,
            CURRENT_MODE_DATA::ID => CURRENT_MODE_DATA::EXTRA_CRC,
            DATA_STREAM_DATA::ID => DATA_STREAM_DATA::EXTRA_CRC,
            DISTANCE_SENSOR_DATA::ID => DISTANCE_SENSOR_DATA::EXTRA_CRC,
            ESTIMATOR_STATUS_DATA::ID => ESTIMATOR_STATUS_DATA::EXTRA_CRC,
            EVENT_DATA::ID => EVENT_DATA::EXTRA_CRC,
            EXTENDED_SYS_STATE_DATA::ID => EXTENDED_SYS_STATE_DATA::EXTRA_CRC,
            FILE_TRANSFER_PROTOCOL_DATA::ID => FILE_TRANSFER_PROTOCOL_DATA::EXTRA_CRC,
            GLOBAL_POSITION_INT_DATA::ID => GLOBAL_POSITION_INT_DATA::EXTRA_CRC,
            GPS_GLOBAL_ORIGIN_DATA::ID => GPS_GLOBAL_ORIGIN_DATA::EXTRA_CRC,
            GPS_RAW_INT_DATA::ID => GPS_RAW_INT_DATA::EXTRA_CRC,
            HEARTBEAT_DATA::ID => HEARTBEAT_DATA::EXTRA_CRC,
            HOME_POSITION_DATA::ID => HOME_POSITION_DATA::EXTRA_CRC,
            LOCAL_POSITION_NED_DATA::ID => LOCAL_POSITION_NED_DATA::EXTRA_CRC,
            MANUAL_CONTROL_DATA::ID => MANUAL_CONTROL_DATA::EXTRA_CRC,
            MESSAGE_INTERVAL_DATA::ID => MESSAGE_INTERVAL_DATA::EXTRA_CRC,
            MISSION_ACK_DATA::ID => MISSION_ACK_DATA::EXTRA_CRC,
            MISSION_CLEAR_ALL_DATA::ID => MISSION_CLEAR_ALL_DATA::EXTRA_CRC,
            MISSION_COUNT_DATA::ID => MISSION_COUNT_DATA::EXTRA_CRC,
            MISSION_CURRENT_DATA::ID => MISSION_CURRENT_DATA::EXTRA_CRC,
            MISSION_ITEM_DATA::ID => MISSION_ITEM_DATA::EXTRA_CRC,
            MISSION_ITEM_INT_DATA::ID => MISSION_ITEM_INT_DATA::EXTRA_CRC,
            MISSION_ITEM_REACHED_DATA::ID => MISSION_ITEM_REACHED_DATA::EXTRA_CRC,
            MISSION_REQUEST_DATA::ID => MISSION_REQUEST_DATA::EXTRA_CRC,
            MISSION_REQUEST_INT_DATA::ID => MISSION_REQUEST_INT_DATA::EXTRA_CRC,
            MISSION_REQUEST_LIST_DATA::ID => MISSION_REQUEST_LIST_DATA::EXTRA_CRC,
            MISSION_REQUEST_PARTIAL_LIST_DATA::ID => MISSION_REQUEST_PARTIAL_LIST_DATA::EXTRA_CRC,
            MISSION_SET_CURRENT_DATA::ID => MISSION_SET_CURRENT_DATA::EXTRA_CRC,
            MISSION_WRITE_PARTIAL_LIST_DATA::ID => MISSION_WRITE_PARTIAL_LIST_DATA::EXTRA_CRC,
            NAV_CONTROLLER_OUTPUT_DATA::ID => NAV_CONTROLLER_OUTPUT_DATA::EXTRA_CRC,
            ODOMETRY_DATA::ID => ODOMETRY_DATA::EXTRA_CRC,
            OPTICAL_FLOW_RAD_DATA::ID => OPTICAL_FLOW_RAD_DATA::EXTRA_CRC,
            PARAM_ERROR_DATA::ID => PARAM_ERROR_DATA::EXTRA_CRC,
            PARAM_REQUEST_LIST_DATA::ID => PARAM_REQUEST_LIST_DATA::EXTRA_CRC,
            PARAM_REQUEST_READ_DATA::ID => PARAM_REQUEST_READ_DATA::EXTRA_CRC,
            PARAM_SET_DATA::ID => PARAM_SET_DATA::EXTRA_CRC,
            PARAM_VALUE_DATA::ID => PARAM_VALUE_DATA::EXTRA_CRC,
            PING_DATA::ID => PING_DATA::EXTRA_CRC,
            POSITION_TARGET_GLOBAL_INT_DATA::ID => POSITION_TARGET_GLOBAL_INT_DATA::EXTRA_CRC,
            POSITION_TARGET_LOCAL_NED_DATA::ID => POSITION_TARGET_LOCAL_NED_DATA::EXTRA_CRC,
            PROTOCOL_VERSION_DATA::ID => PROTOCOL_VERSION_DATA::EXTRA_CRC,
            RC_CHANNELS_OVERRIDE_DATA::ID => RC_CHANNELS_OVERRIDE_DATA::EXTRA_CRC,
            REQUEST_DATA_STREAM_DATA::ID => REQUEST_DATA_STREAM_DATA::EXTRA_CRC,
            SETUP_SIGNING_DATA::ID => SETUP_SIGNING_DATA::EXTRA_CRC,
            SET_ATTITUDE_TARGET_DATA::ID => SET_ATTITUDE_TARGET_DATA::EXTRA_CRC,
            SET_GPS_GLOBAL_ORIGIN_DATA::ID => SET_GPS_GLOBAL_ORIGIN_DATA::EXTRA_CRC,
            SET_HOME_POSITION_DATA::ID => SET_HOME_POSITION_DATA::EXTRA_CRC,
            SET_MODE_DATA::ID => SET_MODE_DATA::EXTRA_CRC,
            SET_POSITION_TARGET_GLOBAL_INT_DATA::ID => {
                SET_POSITION_TARGET_GLOBAL_INT_DATA::EXTRA_CRC
            }
            SET_POSITION_TARGET_LOCAL_NED_DATA::ID => SET_POSITION_TARGET_LOCAL_NED_DATA::EXTRA_CRC,
            STATUSTEXT_DATA::ID => STATUSTEXT_DATA::EXTRA_CRC,
            SYSTEM_TIME_DATA::ID => SYSTEM_TIME_DATA::EXTRA_CRC,
            SYS_STATUS_DATA::ID => SYS_STATUS_DATA::EXTRA_CRC,
            TIMESYNC_DATA::ID => TIMESYNC_DATA::EXTRA_CRC,
            VFR_HUD_DATA::ID => VFR_HUD_DATA::EXTRA_CRC,
            VIDEO_STREAM_INFORMATION_DATA::ID => VIDEO_STREAM_INFORMATION_DATA::EXTRA_CRC,
            VIDEO_STREAM_STATUS_DATA::ID => VIDEO_STREAM_STATUS_DATA::EXTRA_CRC,
            _ => 0,
        }
    }
    fn target_system_id(&self) -> Option<u8> {
        match self {
            Self::COMMAND_ACK(inner) => Some(inner.target_system),
            Self::COMMAND_CANCEL(inner) => Some(inner.target_system),
            Self::COMMAND_INT(inner) => Some(inner.target_system),
            Self::COMMAND_LONG(inner) => Some(inner.target_system),
            Self::FILE_TRANSFER_PROTOCOL(inner) => Some(inner.target_system),
            Self::MANUAL_CONTROL(inner) => Some(inner.target),
            Self::MISSION_ACK(inner) => Some(inner.target_system),
            Self::MISSION_CLEAR_ALL(inner) => Some(inner.target_system),
            Self::MISSION_COUNT(inner) => Some(inner.target_system),
            Self::MISSION_ITEM(inner) => Some(inner.target_system),
            Self::MISSION_ITEM_INT(inner) => Some(inner.target_system),
            Self::MISSION_REQUEST(inner) => Some(inner.target_system),
            Self::MISSION_REQUEST_INT(inner) => Some(inner.target_system),
            Self::MISSION_REQUEST_LIST(inner) => Some(inner.target_system),
            Self::MISSION_REQUEST_PARTIAL_LIST(inner) => Some(inner.target_system),
            Self::MISSION_SET_CURRENT(inner) => Some(inner.target_system),
            Self::MISSION_WRITE_PARTIAL_LIST(inner) => Some(inner.target_system),
            Self::PARAM_ERROR(inner) => Some(inner.target_system),
            Self::PARAM_REQUEST_LIST(inner) => Some(inner.target_system),
            Self::PARAM_REQUEST_READ(inner) => Some(inner.target_system),
            Self::PARAM_SET(inner) => Some(inner.target_system),
            Self::PING(inner) => Some(inner.target_system),
            Self::RC_CHANNELS_OVERRIDE(inner) => Some(inner.target_system),
            Self::REQUEST_DATA_STREAM(inner) => Some(inner.target_system),
            Self::SETUP_SIGNING(inner) => Some(inner.target_system),
            Self::SET_ATTITUDE_TARGET(inner) => Some(inner.target_system),
            Self::SET_GPS_GLOBAL_ORIGIN(inner) => Some(inner.target_system),
            Self::SET_HOME_POSITION(inner) => Some(inner.target_system),
            Self::SET_MODE(inner) => Some(inner.target_system),
            Self::SET_POSITION_TARGET_GLOBAL_INT(inner) => Some(inner.target_system),
            Self::SET_POSITION_TARGET_LOCAL_NED(inner) => Some(inner.target_system),
            Self::TIMESYNC(inner) => Some(inner.target_system),
            _ => None,
        }
    }
    fn target_system_id_mut(&mut self) -> Option<&mut u8> {
        match self {
            Self::COMMAND_ACK(inner) => Some(&mut inner.target_system),
            Self::COMMAND_CANCEL(inner) => Some(&mut inner.target_system),
            Self::COMMAND_INT(inner) => Some(&mut inner.target_system),
            Self::COMMAND_LONG(inner) => Some(&mut inner.target_system),
            Self::FILE_TRANSFER_PROTOCOL(inner) => Some(&mut inner.target_system),
            Self::MANUAL_CONTROL(inner) => Some(&mut inner.target),
            Self::MISSION_ACK(inner) => Some(&mut inner.target_system),
            Self::MISSION_CLEAR_ALL(inner) => Some(&mut inner.target_system),
            Self::MISSION_COUNT(inner) => Some(&mut inner.target_system),
            Self::MISSION_ITEM(inner) => Some(&mut inner.target_system),
            Self::MISSION_ITEM_INT(inner) => Some(&mut inner.target_system),
            Self::MISSION_REQUEST(inner) => Some(&mut inner.target_system),
            Self::MISSION_REQUEST_INT(inner) => Some(&mut inner.target_system),
            Self::MISSION_REQUEST_LIST(inner) => Some(&mut inner.target_system),
            Self::MISSION_REQUEST_PARTIAL_LIST(inner) => Some(&mut inner.target_system),
            Self::MISSION_SET_CURRENT(inner) => Some(&mut inner.target_system),
            Self::MISSION_WRITE_PARTIAL_LIST(inner) => Some(&mut inner.target_system),
            Self::PARAM_ERROR(inner) => Some(&mut inner.target_system),
            Self::PARAM_REQUEST_LIST(inner) => Some(&mut inner.target_system),
            Self::PARAM_REQUEST_READ(inner) => Some(&mut inner.target_system),
            Self::PARAM_SET(inner) => Some(&mut inner.target_system),
            Self::PING(inner) => Some(&mut inner.target_system),
            Self::RC_CHANNELS_OVERRIDE(inner) => Some(&mut inner.target_system),
            Self::REQUEST_DATA_STREAM(inner) => Some(&mut inner.target_system),
            Self::SETUP_SIGNING(inner) => Some(&mut inner.target_system),
            Self::SET_ATTITUDE_TARGET(inner) => Some(&mut inner.target_system),
            Self::SET_GPS_GLOBAL_ORIGIN(inner) => Some(&mut inner.target_system),
            Self::SET_HOME_POSITION(inner) => Some(&mut inner.target_system),
            Self::SET_MODE(inner) => Some(&mut inner.target_system),
            Self::SET_POSITION_TARGET_GLOBAL_INT(inner) => Some(&mut inner.target_system),
            Self::SET_POSITION_TARGET_LOCAL_NED(inner) => Some(&mut inner.target_system),
            Self::TIMESYNC(inner) => Some(&mut inner.target_system),
            _ => None,
        }
    }
    fn target_component_id(&self) -> Option<u8> {
        match self {
            Self::COMMAND_ACK(inner) => Some(inner.target_component),
            Self::COMMAND_CANCEL(inner) => Some(inner.target_component),
            Self::COMMAND_INT(inner) => Some(inner.target_component),
            Self::COMMAND_LONG(inner) => Some(inner.target_component),
            Self::FILE_TRANSFER_PROTOCOL(inner) => Some(inner.target_component),
            Self::MISSION_ACK(inner) => Some(inner.target_component),
            Self::MISSION_CLEAR_ALL(inner) => Some(inner.target_component),
            Self::MISSION_COUNT(inner) => Some(inner.target_component),
            Self::MISSION_ITEM(inner) => Some(inner.target_component),
            Self::MISSION_ITEM_INT(inner) => Some(inner.target_component),
            Self::MISSION_REQUEST(inner) => Some(inner.target_component),
            Self::MISSION_REQUEST_INT(inner) => Some(inner.target_component),
            Self::MISSION_REQUEST_LIST(inner) => Some(inner.target_component),
            Self::MISSION_REQUEST_PARTIAL_LIST(inner) => Some(inner.target_component),
            Self::MISSION_SET_CURRENT(inner) => Some(inner.target_component),
            Self::MISSION_WRITE_PARTIAL_LIST(inner) => Some(inner.target_component),
            Self::PARAM_ERROR(inner) => Some(inner.target_component),
            Self::PARAM_REQUEST_LIST(inner) => Some(inner.target_component),
            Self::PARAM_REQUEST_READ(inner) => Some(inner.target_component),
            Self::PARAM_SET(inner) => Some(inner.target_component),
            Self::PING(inner) => Some(inner.target_component),
            Self::RC_CHANNELS_OVERRIDE(inner) => Some(inner.target_component),
            Self::REQUEST_DATA_STREAM(inner) => Some(inner.target_component),
            Self::SETUP_SIGNING(inner) => Some(inner.target_component),
            Self::SET_ATTITUDE_TARGET(inner) => Some(inner.target_component),
            Self::SET_POSITION_TARGET_GLOBAL_INT(inner) => Some(inner.target_component),
            Self::SET_POSITION_TARGET_LOCAL_NED(inner) => Some(inner.target_component),
            Self::TIMESYNC(inner) => Some(inner.target_component),
            _ => None,
        }
    }
    fn target_component_id_mut(&mut self) -> Option<&mut u8> {
        match self {
            Self::COMMAND_ACK(inner) => Some(&mut inner.target_component),
            Self::COMMAND_CANCEL(inner) => Some(&mut inner.target_component),
            Self::COMMAND_INT(inner) => Some(&mut inner.target_component),
            Self::COMMAND_LONG(inner) => Some(&mut inner.target_component),
            Self::FILE_TRANSFER_PROTOCOL(inner) => Some(&mut inner.target_component),
            Self::MISSION_ACK(inner) => Some(&mut inner.target_component),
            Self::MISSION_CLEAR_ALL(inner) => Some(&mut inner.target_component),
            Self::MISSION_COUNT(inner) => Some(&mut inner.target_component),
            Self::MISSION_ITEM(inner) => Some(&mut inner.target_component),
            Self::MISSION_ITEM_INT(inner) => Some(&mut inner.target_component),
            Self::MISSION_REQUEST(inner) => Some(&mut inner.target_component),
            Self::MISSION_REQUEST_INT(inner) => Some(&mut inner.target_component),
            Self::MISSION_REQUEST_LIST(inner) => Some(&mut inner.target_component),
            Self::MISSION_REQUEST_PARTIAL_LIST(inner) => Some(&mut inner.target_component),
            Self::MISSION_SET_CURRENT(inner) => Some(&mut inner.target_component),
            Self::MISSION_WRITE_PARTIAL_LIST(inner) => Some(&mut inner.target_component),
            Self::PARAM_ERROR(inner) => Some(&mut inner.target_component),
            Self::PARAM_REQUEST_LIST(inner) => Some(&mut inner.target_component),
            Self::PARAM_REQUEST_READ(inner) => Some(&mut inner.target_component),
            Self::PARAM_SET(inner) => Some(&mut inner.target_component),
            Self::PING(inner) => Some(&mut inner.target_component),
            Self::RC_CHANNELS_OVERRIDE(inner) => Some(&mut inner.target_component),
            Self::REQUEST_DATA_STREAM(inner) => Some(&mut inner.target_component),
            Self::SETUP_SIGNING(inner) => Some(&mut inner.target_component),
            Self::SET_ATTITUDE_TARGET(inner) => Some(&mut inner.target_component),
            Self::SET_POSITION_TARGET_GLOBAL_INT(inner) => Some(&mut inner.target_component),
            Self::SET_POSITION_TARGET_LOCAL_NED(inner) => Some(&mut inner.target_component),
            Self::TIMESYNC(inner) => Some(&mut inner.target_component),
            _ => None,
        }
    }
}
