//! Wire representation of values: little-endian, packed, in the firmware's units.
//!
//! `option!` generates a struct, its decoder and its encoder from one table, so that they always agree.

use std::time::Duration;

use bytes::{Buf, BufMut};

use super::state::ControlState;

/// Tag and size in front of each option.
pub(super) const OPTION_HEADER_BYTES: usize = 4;

/// A field with a fixed offset in an option.
pub(super) trait Wire {
    /// The decoded value.
    type Value;
    /// Size in bytes.
    const BYTES: usize;

    /// Decodes it; the caller has checked that there are enough bytes.
    fn read(bytes: &mut &[u8]) -> Self::Value;
    fn write(value: Self::Value, out: &mut impl BufMut);
}

macro_rules! plain {
    ($($ctype:ty, $get:ident, $put:ident;)*) => {$(
        impl Wire for $ctype {
            type Value = Self;
            const BYTES: usize = size_of::<Self>();

            fn read(bytes: &mut &[u8]) -> Self {
                bytes.$get()
            }

            fn write(value: Self, out: &mut impl BufMut) {
                out.$put(value);
            }
        }
    )*};
}

plain! {
    u8, get_u8, put_u8;
    u16, get_u16_le, put_u16_le;
    i16, get_i16_le, put_i16_le;
    u32, get_u32_le, put_u32_le;
    i32, get_i32_le, put_i32_le;
    f32, get_f32_le, put_f32_le;
    f64, get_f64_le, put_f64_le;
}

impl<W: Wire<Value: Copy>, const N: usize> Wire for [W; N] {
    type Value = [W::Value; N];
    const BYTES: usize = W::BYTES * N;

    fn read(bytes: &mut &[u8]) -> Self::Value {
        std::array::from_fn(|_| W::read(bytes))
    }

    fn write(value: Self::Value, out: &mut impl BufMut) {
        for element in value {
            W::write(element, out);
        }
    }
}

/// A number that converts to `f64` without loss, and back to the nearest value.
pub(super) trait Number: Wire<Value = Self> + Copy {
    fn widen(self) -> f64;
    fn narrow(value: f64) -> Self;
}

macro_rules! number {
    ($($ctype:ty, $narrow:expr;)*) => {$(
        impl Number for $ctype {
            fn widen(self) -> f64 {
                f64::from(self)
            }

            #[allow(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "`as` saturates: what the wire cannot carry becomes the nearest it can"
            )]
            fn narrow(value: f64) -> Self {
                let narrow: fn(f64) -> Self = $narrow;
                narrow(value)
            }
        }
    )*};
}

number! {
    u16, |value| value.round() as u16;
    i16, |value| value.round() as i16;
    u32, |value| value.round() as u32;
    i32, |value| value.round() as i32;
    f32, |value| value as f32;
}

macro_rules! scaled {
    ($($(#[$doc:meta])* $name:ident, $units:expr;)*) => {$(
        $(#[$doc])*
        pub(super) struct $name<T>(std::marker::PhantomData<T>);

        impl<T: Number> Wire for $name<T> {
            type Value = f64;
            const BYTES: usize = T::BYTES;

            fn read(bytes: &mut &[u8]) -> f64 {
                T::read(bytes).widen() / $units
            }

            fn write(value: f64, out: &mut impl BufMut) {
                T::write(T::narrow(value * $units), out);
            }
        }
    )*};
}

scaled! {
    /// Thousandths: milli-degrees, millimetres, millivolts.
    Milli, 1000.0;
    /// Hundredths: centimetres.
    Centi, 100.0;
    /// Tenths: of a degree Celsius; milligauss as tenths of a microtesla.
    Tenth, 10.0;
    /// Thousandths of the standard gravity, as m/s².
    MilliGravity, 1000.0 / 9.806_65;
}

/// The control state's major number, the high half of its word.
pub(super) struct ControlMajor;

impl Wire for ControlMajor {
    type Value = ControlState;
    const BYTES: usize = 2;

    fn read(bytes: &mut &[u8]) -> ControlState {
        ControlState::from_number(bytes.get_u16_le())
    }

    fn write(value: ControlState, out: &mut impl BufMut) {
        out.put_u16_le(value.number());
    }
}

/// The drone's clock: the top 11 bits are seconds, the low 21 bits microseconds.
pub(super) struct ClockWord;

impl ClockWord {
    const WRAP_S: u64 = 2048;
}

impl Wire for ClockWord {
    type Value = Duration;
    const BYTES: usize = 4;

    fn read(bytes: &mut &[u8]) -> Duration {
        let word = bytes.get_u32_le();
        let micros = u64::from(word >> 21) * 1_000_000 + u64::from(word & 0x1F_FFFF);
        // More than a million microseconds are invalid, but must not lead beyond the wrap-around.
        Duration::from_micros(micros % (Self::WRAP_S * 1_000_000))
    }

    fn write(value: Duration, out: &mut impl BufMut) {
        let seconds = u32::try_from(value.as_secs() % Self::WRAP_S).unwrap_or(0);
        out.put_u32_le(seconds << 21 | value.subsec_micros());
    }
}

/// Generates the struct of an option. `field: type as wire` gives the type of the decoded value and its wire
/// representation; fields behind `newer` exist only in packets of newer firmware.
macro_rules! option {
    (
        $(#[$doc:meta])*
        $name:ident, $size:literal {
            $($(#[$field_doc:meta])* $field:ident: $ctype:ty as $wire:ty,)*
        }
        $(newer { $(#[$newer_doc:meta])* $newer:ident: $newer_type:ty as $newer_wire:ty })?
    ) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Default)]
        pub struct $name {
            $($(#[$field_doc])* pub $field: $ctype,)*
            $($(#[$newer_doc])* pub $newer: Option<$newer_type>,)?
        }

        impl $name {
            const PAYLOAD_BYTES: usize = $size - crate::navdata::wire::OPTION_HEADER_BYTES;

            /// Decodes the option; `None` if it is too short. Bytes appended by newer firmware are ignored.
            pub(in crate::navdata) fn read(payload: &[u8]) -> Option<Self> {
                const {
                    let sum = 0 $(+ <$wire as crate::navdata::wire::Wire>::BYTES)*;
                    assert!(sum == $name::PAYLOAD_BYTES, "the fields fill the option");
                }
                let mut rest = payload;
                if rest.len() < Self::PAYLOAD_BYTES {
                    return None;
                }
                Some(Self {
                    $($field: <$wire as crate::navdata::wire::Wire>::read(&mut rest),)*
                    $($newer: (rest.len() >= <$newer_wire as crate::navdata::wire::Wire>::BYTES)
                        .then(|| <$newer_wire as crate::navdata::wire::Wire>::read(&mut rest)),)?
                })
            }

            pub(in crate::navdata) fn write(&self, out: &mut impl bytes::BufMut) {
                $(<$wire as crate::navdata::wire::Wire>::write(self.$field, out);)*
                $(if let Some(newer) = self.$newer {
                    <$newer_wire as crate::navdata::wire::Wire>::write(newer, out);
                })?
            }
        }
    };
}

pub(super) use option;
