//! The airframes that fly here: the published ones, or others near them.

use mock_drone::airframe::{GRAVITY_M_S2, Profile, ThrustLaw};
use nalgebra::Vector2;

/// A published model of the airframe.
#[derive(Debug, Clone, Copy)]
pub struct Model {
    /// Name for reports.
    pub name: &'static str,
    /// The model.
    pub profile: fn() -> Profile,
}

/// All airframes.
pub const AIRFRAMES: [Model; 4] = [
    Model { name: "rec", profile: Profile::rec },
    Model { name: "tum", profile: Profile::tum },
    Model { name: "tf", profile: Profile::tf },
    Model { name: "leo", profile: Profile::leo },
];

/// How far each parameter of an airframe that is none of these differs from one of them, at most.
const NEAR: f64 = 0.4;

/// Which airframes fly.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Airframes {
    /// The published ones.
    #[default]
    Published,
    /// Others, drawn at random: each parameter within 40 % of that of a published one.
    Any,
}

impl Airframes {
    /// The airframe of a flight: the one with this index in [`AIRFRAMES`], or one near it, drawn by the flight's seed.
    pub fn profile(self, airframe: usize, seed: u64) -> Profile {
        let published = (AIRFRAMES[airframe].profile)();
        match self {
            Self::Published => published,
            // Not the same numbers for all four.
            Self::Any => {
                let each = AIRFRAMES.len() as u64;
                published.near(seed.wrapping_mul(each).wrapping_add(airframe as u64), NEAR)
            }
        }
    }

    /// Its name for reports.
    pub fn name(self, airframe: usize) -> &'static str {
        match self {
            Self::Published => AIRFRAMES[airframe].name,
            Self::Any => ["near rec", "near tum", "near tf", "near leo"][airframe],
        }
    }
}

/// The strongest wind that the airframe resists at full stick, with a limit of 12° of tilt. No pilot could hold it against
/// more.
pub(crate) fn strongest_wind_m_s(profile: &Profile) -> f64 {
    let tilt_rad = (12_f64.to_radians() * profile.scaling.tilt).min(profile.scaling.tilt_limit_rad);
    let acceleration = match profile.thrust {
        ThrustLaw::CarriesWeight => Vector2::repeat(GRAVITY_M_S2 * tilt_rad.tan()),
        ThrustLaw::Sine { acceleration_m_s2 } => {
            Vector2::repeat(acceleration_m_s2 * tilt_rad.sin())
        }
        ThrustLaw::Linear { acceleration_m_s2 } => acceleration_m_s2 * tilt_rad,
    };
    // Quadratic drag reduces it slightly.
    0.8 * acceleration.component_div(&profile.linear_drag_1_s).min()
}
