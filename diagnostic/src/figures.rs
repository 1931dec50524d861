//! Numbers in messages.

use std::fmt;
use std::ops::RangeInclusive;

/// From here on only the order of magnitude is of interest.
const HUGE: f64 = 1e6;
/// Likewise below this.
const TINY: f64 = 1e-3;
/// A number that is no longer is shown as it is.
const LONGEST: usize = 8;

/// A number in a message to a person: with four significant digits, or all if they are at most eight characters. From a
/// million on, and below a thousandth, it has an exponent, with three digits.
///
/// With a precision (`{:.2}`) it has so many decimals, but still an exponent from a million on.
///
/// ```
/// use diagnostic::Figures;
///
/// assert_eq!(format!("{:.2} m", Figures(10.404)), "10.40 m");
/// assert_eq!(format!("{:.2} m", Figures(1e308)), "1e308 m");
/// assert_eq!(Figures(0.1 + 0.2).to_string(), "0.3");
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Figures(pub f64);

impl fmt::Display for Figures {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(value) = *self;
        let size = value.abs();
        let is_tiny = f.precision().is_none() && value != 0.0 && size < TINY;
        if !value.is_finite() {
            write!(f, "{value}")
        } else if size >= HUGE || is_tiny {
            write!(f, "{:e}", rounded(value, 3))
        } else if let Some(decimals) = f.precision() {
            write!(f, "{value:.decimals$}")
        } else {
            let whole = value.to_string();
            if whole.len() <= LONGEST {
                f.write_str(&whole)
            } else {
                write!(f, "{}", rounded(value, 4))
            }
        }
    }
}

/// A number outside a range, with as many digits as it needs not to be taken for one inside.
pub fn beyond(value: f64, range: &RangeInclusive<f64>) -> String {
    let shown = Figures(value).to_string();
    let misleads = shown.parse().is_ok_and(|shown| range.contains(&shown));
    if misleads { value.to_string() } else { shown }
}

/// A number rounded to so many significant digits.
fn rounded(value: f64, digits: usize) -> f64 {
    // What was written of a number is one.
    format!("{value:.*e}", digits - 1).parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_number_takes_more_than_a_few_digits() {
        let shown = |value| (Figures(value).to_string(), format!("{:.2}", Figures(value)));
        for (value, plain, decimals) in [
            (0.0, "0", "0.00"),
            (-100.0, "-100", "-100.00"),
            (0.35, "0.35", "0.35"),
            (1.0 / 3.0, "0.3333", "0.33"),
            (123_456.789_012, "123500", "123456.79"),
            (1e308, "1e308", "1e308"),
            (-1.234_567e9, "-1.23e9", "-1.23e9"),
            (1e-300, "1e-300", "0.00"),
            (f64::from(f32::MAX), "3.4e38", "3.4e38"),
            (f64::INFINITY, "inf", "inf"),
            (f64::NAN, "NaN", "NaN"),
        ] {
            assert_eq!(shown(value), (plain.to_owned(), decimals.to_owned()));
        }
    }

    #[test]
    fn a_number_just_beyond_a_limit_does_not_look_like_the_limit() {
        let shown = |value| beyond(value, &(0.0..=100.0));
        assert_eq!(shown(1e308), "1e308");
        assert_eq!(shown(123.456_789_012), "123.5");
        assert_eq!(shown(100.000_01), "100.00001");
        assert_eq!((shown(f64::NAN), shown(-1e-300)), ("NaN".to_owned(), "-1e-300".to_owned()));
    }
}
