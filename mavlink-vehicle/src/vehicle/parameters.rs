//! Parameters: numbers that exist. Limits of safety can be read, not written.

use autopilot::agent::{LANDING_BATTERY_PERCENT, WARNING_BATTERY_PERCENT};
use mavlink_core::types::CharArray;

use super::{Autopilot, Config};
use crate::dialect::{MavMessage, PARAM_VALUE_DATA};

/// `MAV_PARAM_TYPE_REAL32`: clients disagree on how integers travel in a float, and on floats they agree.
const REAL32: u8 = 9;

/// A number with a name.
#[derive(Debug, Clone, Copy)]
struct Parameter {
    name: &'static str,
    value: f32,
    /// Lowest and highest value that may be set; nothing may if absent.
    range: Option<(f32, f32)>,
}

/// All parameters.
#[derive(Debug)]
pub(crate) struct Parameters(Vec<Parameter>);

/// Why a parameter was not set.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum NotSet {
    Unknown,
    ReadOnly,
    OutOfRange,
}

/// Height of a take-off without one, in metres above the floor; 0 for that of the drone's own take-off.
pub(crate) const TAKE_OFF_HEIGHT: &str = "MIS_TAKEOFF_ALT";
/// Horizontal speed in missions that set none, in m/s.
pub(crate) const CRUISE_SPEED: &str = "MPC_XY_CRUISE";

/// Silence of setpoints or sticks after which the drone holds, in seconds.
const SILENT_S: f32 = 0.5;
/// What PX4's pages of QGroundControl's Vehicle Setup name.
const MAGNETOMETERS: [&str; 3] = ["CAL_MAG0_ID", "CAL_MAG1_ID", "CAL_MAG2_ID"];
const ROTATIONS: [&str; 3] = ["CAL_MAG0_ROT", "CAL_MAG1_ROT", "CAL_MAG2_ROT"];
const CHANNELS: [&str; 7] = [
    "RC_MAP_ROLL",
    "RC_MAP_PITCH",
    "RC_MAP_YAW",
    "RC_MAP_THROTTLE",
    "RC_MAP_FLAPS",
    "RC_MAP_AUX1",
    "RC_MAP_AUX2",
];
const MODE_SWITCHES: [&str; 6] = [
    "COM_FLTMODE1",
    "COM_FLTMODE2",
    "COM_FLTMODE3",
    "COM_FLTMODE4",
    "COM_FLTMODE5",
    "COM_FLTMODE6",
];

impl Parameters {
    #[allow(clippy::cast_possible_truncation, reason = "parameters are f32")]
    pub(crate) fn new(config: &Config) -> Self {
        let seconds = |time: std::time::Duration| time.as_secs_f32();
        let limits = &config.limits;
        let (low_m, high_m) = (limits.floor_m as f32, limits.ceiling_m as f32);
        // Of a polygon it is how far the drone may be from the start at most.
        let radius_m = limits.border.furthest_m() as f32;
        let percent = |percent: u32| f64::from(percent) as f32;
        let (low_percent, landing_percent) =
            (percent(WARNING_BATTERY_PERCENT), percent(LANDING_BATTERY_PERCENT));
        let fastest_m_s = config.max_speed_m_s as f32;
        let fixed = |name, value| Parameter { name, value, range: None };
        let free = |name, value, low, high| Parameter { name, value, range: Some((low, high)) };
        let mut all = vec![
            free(TAKE_OFF_HEIGHT, 0.0, 0.0, high_m),
            free(CRUISE_SPEED, fastest_m_s, 0.1, fastest_m_s),
            fixed("FENCE_RADIUS", radius_m),
            fixed("FENCE_FLOOR", low_m),
            fixed("FENCE_CEILING", high_m),
            fixed("BAT_WARN_PCT", low_percent),
            fixed("BAT_LAND_PCT", landing_percent),
            fixed("GCS_TELL_S", 3.0),
            fixed("GCS_HOLD_S", seconds(config.station.hold_after)),
            fixed("GCS_LAND_S", seconds(config.station.land_after)),
            fixed("SP_HOLD_S", SILENT_S),
            fixed("SP_LAND_S", 10.5),
        ];
        if config.autopilot == Autopilot::Px4 {
            // Those that QGroundControl asks for; each is true of this vehicle.
            all.extend([
                fixed("SYS_AUTOSTART", 4001.0),
                fixed("COM_RC_IN_MODE", 1.0),
                fixed("SYS_HAS_MAG", 0.0),
                fixed("CAL_GYRO0_ID", 1.0),
                fixed("CAL_ACC0_ID", 1.0),
                fixed("GF_MAX_HOR_DIST", radius_m),
                fixed("GF_MAX_VER_DIST", high_m),
                // 5: land.
                fixed("GF_ACTION", 5.0),
                fixed("BAT_LOW_THR", low_percent / 100.0),
                fixed("BAT_CRIT_THR", landing_percent / 100.0),
                fixed("BAT_EMERGEN_THR", landing_percent / 100.0),
                // 2: land.
                fixed("COM_LOW_BAT_ACT", 2.0),
                fixed("COM_DL_LOSS_T", seconds(config.station.hold_after)),
                // 1: hold.
                fixed("NAV_DLL_ACT", 1.0),
                fixed("COM_DISARM_LAND", 0.0),
                fixed("MPC_XY_VEL_ALL", -10.0),
                fixed("MPC_Z_VEL_ALL", -3.0),
                fixed("SYS_VEHICLE_RESP", -0.4),
                fixed("RTL_LAND_DELAY", 0.0),
                fixed("SYS_AUTOCONFIG", 0.0),
                fixed("MAV_SYS_ID", f32::from(config.system)),
                // It returns at the height that it has, which is never below its floor.
                fixed("RTL_RETURN_ALT", low_m),
                fixed("RTL_DESCEND_ALT", low_m),
                // Sticks that fall silent: 1 is hold.
                fixed("COM_RC_LOSS_T", SILENT_S),
                fixed("NAV_RCL_ACT", 1.0),
                // Three cells of lithium polymer.
                fixed("BAT1_N_CELLS", 3.0),
                fixed("BAT1_V_EMPTY", 3.3),
                fixed("BAT1_V_CHARGED", 4.15),
                fixed("SENS_DPRES_OFF", 0.0),
                fixed("SENS_BOARD_ROT", 0.0),
                fixed("SDLOG_MODE", -1.0),
                fixed("CP_DIST", -1.0),
                fixed("COM_OBS_AVOID", 0.0),
            ]);
            // Of none of these there is one: no compass that could be calibrated from here, no radio control, no mode switch.
            let none = |names: &'static [&'static str], value| {
                names.iter().map(move |name| Parameter { name, value, range: None })
            };
            all.extend(none(&MAGNETOMETERS, 0.0));
            all.extend(none(&ROTATIONS, -1.0));
            all.extend(none(&CHANNELS, 0.0));
            all.extend(none(&MODE_SWITCHES, -1.0));
        }
        Self(all)
    }

    fn place(&self, name: &str) -> Option<usize> {
        self.0.iter().position(|parameter| parameter.name == name)
    }

    /// The value of a parameter of this module; 0 for none.
    pub(crate) fn value(&self, name: &str) -> f64 {
        self.place(name).and_then(|place| self.0.get(place)).map_or(0.0, |p| p.value.into())
    }

    pub(crate) fn count(&self) -> usize {
        self.0.len()
    }

    /// The message about the parameter at an index.
    pub(crate) fn at(&self, index: usize) -> Option<MavMessage> {
        let parameter = self.0.get(index)?;
        Some(MavMessage::PARAM_VALUE(PARAM_VALUE_DATA {
            param_value: parameter.value,
            param_count: u16::try_from(self.0.len()).unwrap_or(u16::MAX),
            param_index: u16::try_from(index).unwrap_or(u16::MAX),
            param_id: CharArray::from(parameter.name),
            param_type: REAL32,
        }))
    }

    /// The index of the one that is meant: by its index, or by its name if that is negative.
    pub(crate) fn index(&self, index: i16, name: &CharArray<16>) -> Option<usize> {
        match usize::try_from(index) {
            Ok(index) => (index < self.0.len()).then_some(index),
            Err(_) => self.place(name.to_str().ok()?),
        }
    }

    /// Sets a parameter, if it may be.
    pub(crate) fn set(&mut self, index: usize, value: f32) -> Result<(), NotSet> {
        let parameter = self.0.get_mut(index).ok_or(NotSet::Unknown)?;
        let (low, high) = parameter.range.ok_or(NotSet::ReadOnly)?;
        // NaN is out of range, too.
        if !(low..=high).contains(&value) {
            return Err(NotSet::OutOfRange);
        }
        parameter.value = value;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_short_and_unique() {
        for autopilot in [Autopilot::Generic, Autopilot::Px4] {
            let all = Parameters::new(&Config { autopilot, ..Config::default() });
            for (index, parameter) in all.0.iter().enumerate() {
                assert!(parameter.name.len() <= 16, "{}", parameter.name);
                assert_eq!(all.place(parameter.name), Some(index));
                assert_eq!(all.index(-1, &CharArray::from(parameter.name)), Some(index));
            }
        }
    }

    #[test]
    fn only_what_loosens_nothing_can_be_set() {
        let mut all = Parameters::new(&Config::default());
        let index = |all: &Parameters, name| all.place(name).unwrap();
        let (height, fence) = (index(&all, TAKE_OFF_HEIGHT), index(&all, "FENCE_RADIUS"));
        assert_eq!(all.set(height, 1.5), Ok(()));
        assert!((all.value(TAKE_OFF_HEIGHT) - 1.5).abs() < 1e-9);
        for value in [f32::NAN, -1.0, 99.0, f32::INFINITY] {
            assert_eq!(all.set(height, value), Err(NotSet::OutOfRange));
        }
        assert_eq!(all.set(fence, 5.0), Err(NotSet::ReadOnly));
        assert_eq!(all.set(999, 5.0), Err(NotSet::Unknown));
        assert_eq!(all.index(999, &CharArray::from("")), None);
        assert_eq!(all.index(-1, &CharArray::from("NO_SUCH")), None);
    }
}
