//! Declaration of settings: each value stands once, with everything that is known of it.

use std::ops::RangeInclusive;
use std::time::Duration;

use autopilot::vehicle::{NavdataRate, Ultrasound};
use diagnostic::{Figures, beyond};
use nalgebra::Vector2;
use serde::{Deserialize, Serialize};

/// Declares the values of a section:
///
/// ```text
/// section! {
///     struct Drone("drone") of VehicleConfig {
///         /// Full stick commands this. m/s.
///         climb_max_m_s: f64 = [estimator.limits.climb_m_s] in 0.2..=2.0,
///     }
/// }
/// ```
///
/// `[estimator.limits.climb_m_s]` is the value's place in the [`VehicleConfig`](autopilot::vehicle::VehicleConfig), whose
/// default is the setting's default, too; a value without a place there has `[default …]`. The documentation
/// is the comment in the default `pilot.toml`. A value without one is documented with the one before it.
macro_rules! section {
    (
        $(#[$meta:meta])*
        struct $section:ident($name:literal) of $config:ty {
            $(
                $(#[doc = $comment:literal])*
                $value:ident: $kind:ty = [$($place:tt)+] $(in $range:expr)?,
            )+
        }
    ) => {
        $(#[$meta])*
        #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
        #[serde(default, deny_unknown_fields)]
        pub(super) struct $section {
            $(pub(super) $value: $kind,)+
        }

        impl Default for $section {
            fn default() -> Self {
                let config = <$config>::default();
                Self { $($value: section!(@get config, $($place)+),)+ }
            }
        }

        impl $section {
            /// Name, and what is known of each value.
            pub(super) const DECLARED: $crate::settings::section::Declared = ($name, &[
                $($crate::settings::section::Value {
                    name: stringify!($value),
                    comments: &[$($comment),*],
                    range: section!(@range $($range)?),
                }),+
            ]);
        }

        impl $crate::settings::section::Section<$config> for $section {
            fn apply(&self, config: &mut $config) {
                $(section!(@set config, self.$value, $($place)+);)+
            }

            fn out_of_range(&self) -> Vec<String> {
                let mut reasons = Vec::new();
                $($(
                    for number in $crate::settings::section::Numbers::numbers(&self.$value) {
                        let name = concat!($name, ".", stringify!($value));
                        reasons.extend($crate::settings::section::outside(name, number, &$range));
                    }
                )?)+
                reasons
            }
        }
    };
    (@range) => { None };
    (@range $range:expr) => { Some([*$range.start(), *$range.end()]) };
    (@get $config:ident, default $value:expr) => { $value };
    (@get $config:ident, $($place:ident).+) => {
        $crate::settings::section::Setting::of(&$config.$($place).+)
    };
    (@set $config:ident, $setting:expr, default $value:expr) => {};
    (@set $config:ident, $setting:expr, $($place:ident).+) => {
        $config.$($place).+ = $crate::settings::section::Setting::value(&$setting)
    };
}

pub(super) use section;

/// A section's values, and where they go in the configuration.
pub(super) trait Section<C> {
    /// Puts the values into their places.
    fn apply(&self, config: &mut C);
    /// Reasons why values are out of range, one for each such number.
    fn out_of_range(&self) -> Vec<String>;
}

/// What is known of a value.
#[derive(Debug, Clone, Copy)]
pub(super) struct Value {
    /// Its name in the section.
    pub(super) name: &'static str,
    /// Lines of its documentation; none if it is documented with the value before it.
    pub(super) comments: &'static [&'static str],
    /// Least and largest number, if it has a range.
    pub(super) range: Option<[f64; 2]>,
}

/// A section's name, and what is known of its values, in the order of the file.
pub(super) type Declared = (&'static str, &'static [Value]);

/// A value as it is written in the file; `T` is its type in the configuration.
pub(super) trait Setting<T> {
    /// The setting for a configured value.
    fn of(value: &T) -> Self;
    /// The configured value.
    fn value(&self) -> T;
}

impl<T: Copy> Setting<T> for T {
    fn of(value: &T) -> Self {
        *value
    }

    fn value(&self) -> T {
        *self
    }
}

/// Two numbers, and no more: an array would be read without what is behind its second value.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Vec<f64>", into = "[f64; 2]")]
pub(super) struct Pair([f64; 2]);

impl TryFrom<Vec<f64>> for Pair {
    type Error = String;

    fn try_from(written: Vec<f64>) -> Result<Self, String> {
        let count = written.len();
        written.try_into().map(Self).map_err(|_| format!("{count} numbers where two are expected"))
    }
}

impl From<Pair> for [f64; 2] {
    fn from(pair: Pair) -> Self {
        pair.0
    }
}

impl Setting<Vector2<f64>> for Pair {
    fn of(value: &Vector2<f64>) -> Self {
        Self((*value).into())
    }

    fn value(&self) -> Vector2<f64> {
        self.0.into()
    }
}

impl Setting<[f64; 2]> for Pair {
    fn of(value: &[f64; 2]) -> Self {
        Self(*value)
    }

    fn value(&self) -> [f64; 2] {
        self.0
    }
}

/// A duration, written as milliseconds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub(super) struct Milliseconds(u32);

impl Setting<Duration> for Milliseconds {
    fn of(value: &Duration) -> Self {
        Self(u32::try_from(value.as_millis()).unwrap_or(u32::MAX))
    }

    fn value(&self) -> Duration {
        Duration::from_millis(self.0.into())
    }
}

/// A bit rate in kbit/s; zero asks for none.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub(super) struct BitRate(u32);

impl Setting<Option<u32>> for BitRate {
    fn of(value: &Option<u32>) -> Self {
        Self(value.unwrap_or_default())
    }

    fn value(&self) -> Option<u32> {
        (self.0 > 0).then_some(self.0)
    }
}

/// An angle in radians, written in degrees.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub(super) struct Degrees(f64);

impl Setting<f64> for Degrees {
    fn of(value: &f64) -> Self {
        // Rounded, because converting to radians and back does not give exactly the same number.
        Self((value.to_degrees() * 1e9).round() / 1e9)
    }

    fn value(&self) -> f64 {
        self.0.to_radians()
    }
}

/// The rate of navdata, by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Navdata {
    /// 15 packets a second.
    Demo,
    /// 200 packets a second, with all options.
    Full,
}

impl Setting<NavdataRate> for Navdata {
    fn of(value: &NavdataRate) -> Self {
        match value {
            NavdataRate::Demo => Self::Demo,
            NavdataRate::Full => Self::Full,
        }
    }

    fn value(&self) -> NavdataRate {
        match self {
            Self::Demo => NavdataRate::Demo,
            Self::Full => NavdataRate::Full,
        }
    }
}

/// The ultrasound's frequency, by the drone's number for it: 7 is 22.22 Hz, 8 is 25 Hz; zero asks for none.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "u8", into = "u8")]
pub(crate) struct UltrasoundFrequency(Option<Ultrasound>);

impl TryFrom<u8> for UltrasoundFrequency {
    type Error = String;

    fn try_from(number: u8) -> Result<Self, String> {
        match number {
            0 => Ok(Self(None)),
            7 => Ok(Self(Some(Ultrasound::Slow))),
            8 => Ok(Self(Some(Ultrasound::Fast))),
            _ => Err(format!("{number} is no frequency of the ultrasound: it has 7 and 8")),
        }
    }
}

impl From<UltrasoundFrequency> for u8 {
    fn from(frequency: UltrasoundFrequency) -> Self {
        match frequency.0 {
            None => 0,
            Some(Ultrasound::Slow) => 7,
            Some(Ultrasound::Fast) => 8,
        }
    }
}

impl Setting<Option<Ultrasound>> for UltrasoundFrequency {
    fn of(value: &Option<Ultrasound>) -> Self {
        Self(*value)
    }

    fn value(&self) -> Option<Ultrasound> {
        self.0
    }
}

/// The numbers of a setting that has a range, which holds for each of them.
pub(super) trait Numbers {
    /// The numbers in the unit of the file.
    fn numbers(&self) -> impl Iterator<Item = f64>;
}

impl Numbers for f64 {
    fn numbers(&self) -> impl Iterator<Item = Self> {
        std::iter::once(*self)
    }
}

impl Numbers for u8 {
    fn numbers(&self) -> impl Iterator<Item = f64> {
        std::iter::once(f64::from(*self))
    }
}

impl Numbers for Pair {
    fn numbers(&self) -> impl Iterator<Item = f64> {
        self.0.into_iter()
    }
}

impl Numbers for Milliseconds {
    fn numbers(&self) -> impl Iterator<Item = f64> {
        std::iter::once(self.0.into())
    }
}

impl Numbers for BitRate {
    fn numbers(&self) -> impl Iterator<Item = f64> {
        let rate: Option<u32> = self.value();
        rate.into_iter().map(f64::from)
    }
}

impl Numbers for Degrees {
    fn numbers(&self) -> impl Iterator<Item = f64> {
        std::iter::once(self.0)
    }
}

/// The reason why a number is refused; `None` if it lies in the range. NaN does not.
pub(super) fn outside(name: &str, value: f64, range: &RangeInclusive<f64>) -> Option<String> {
    let (from, to) = (Figures(*range.start()), Figures(*range.end()));
    // NaN is out of range too.
    (!range.contains(&value)).then(|| {
        let value = beyond(value, range);
        format!("{name} is {value}: it must lie in {from} to {to}")
    })
}
