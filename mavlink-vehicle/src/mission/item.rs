//! Items of a mission, as they travel.

use crate::dialect::{MISSION_ITEM_DATA, MISSION_ITEM_INT_DATA};
use crate::place::{ABSENT, Frame};

/// Makes the item of the fields that are the same in `MISSION_ITEM_INT` and `MISSION_ITEM`.
macro_rules! item {
    ($($(#[$doc:meta])* $field:ident: $kind:ty),* $(,)?) => {
        /// An item as `MISSION_ITEM_INT` carries it, kept bit for bit: a mission reads back as it was sent.
        #[derive(Debug, Clone, Copy)]
        pub(crate) struct Item {
            $($(#[$doc])* pub(crate) $field: $kind,)*
            /// Fifth parameter: latitude in degrees × 1e7, or a local coordinate in metres × 1e4.
            pub(crate) x: i32,
            /// Sixth parameter: longitude in degrees × 1e7, or a local coordinate in metres × 1e4.
            pub(crate) y: i32,
        }

        impl Item {
            pub(crate) fn of_integers(data: &MISSION_ITEM_INT_DATA) -> Self {
                Self { x: data.x, y: data.y, $($field: data.$field),* }
            }

            pub(crate) fn of_floats(data: &MISSION_ITEM_DATA) -> Self {
                Self { x: 0, y: 0, $($field: data.$field),* }.with_floats(data.x, data.y)
            }

            pub(crate) fn to(self, target_system: u8, target_component: u8) -> MISSION_ITEM_INT_DATA {
                MISSION_ITEM_INT_DATA {
                    target_system,
                    target_component,
                    x: self.x,
                    y: self.y,
                    $($field: self.$field),*
                }
            }
        }

        /// Equal bit for bit: a NaN equals itself.
        impl PartialEq for Item {
            fn eq(&self, other: &Self) -> bool {
                (self.x, self.y) == (other.x, other.y)
                    $(&& self.$field.to_ne_bytes() == other.$field.to_ne_bytes())*
            }
        }
    };
}

item! {
    /// Its index, from 0.
    seq: u16,
    /// `MAV_FRAME`.
    frame: u8,
    /// `MAV_CMD`; see [`command`].
    command: u16,
    /// Whether it is the current one.
    current: u8,
    /// Whether the next follows by itself.
    autocontinue: u8,
    param1: f32,
    param2: f32,
    param3: f32,
    param4: f32,
    /// Seventh parameter: height in metres, in its frame.
    z: f32,
    /// `MAV_MISSION_TYPE`: 0 for a mission.
    mission_type: u8,
}

/// The `MAV_CMD` that have a meaning in a mission.
pub(crate) mod command {
    pub(crate) const NAV_WAYPOINT: u16 = 16;
    pub(crate) const NAV_LOITER_UNLIM: u16 = 17;
    pub(crate) const NAV_LOITER_TIME: u16 = 19;
    pub(crate) const NAV_RETURN_TO_LAUNCH: u16 = 20;
    pub(crate) const NAV_LAND: u16 = 21;
    pub(crate) const NAV_TAKEOFF: u16 = 22;
    pub(crate) const NAV_LAND_LOCAL: u16 = 23;
    pub(crate) const NAV_TAKEOFF_LOCAL: u16 = 24;
    pub(crate) const NAV_DELAY: u16 = 93;
    pub(crate) const CONDITION_DELAY: u16 = 112;
    pub(crate) const CONDITION_YAW: u16 = 115;
    pub(crate) const DO_CHANGE_SPEED: u16 = 178;
}

impl Item {
    /// The item that a `MISSION_ITEM` carries, whose x and y are degrees, metres or parameters in `f32`. NaN, and
    /// what no integer holds, is [`ABSENT`].
    fn with_floats(self, x: f32, y: f32) -> Self {
        let scale = Frame::from_number(self.frame).map_or(1.0, Frame::scale);
        let integer = |value: f32| {
            let scaled = (f64::from(value) * scale).round();
            let fits = (f64::from(i32::MIN)..f64::from(i32::MAX)).contains(&scaled);
            // In range by the condition.
            #[allow(clippy::cast_possible_truncation)]
            if fits { scaled as i32 } else { ABSENT }
        };
        Self { x: integer(x), y: integer(y), ..self }
    }
}

impl Eq for Item {}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mission::tests::item;

    #[test]
    fn items_are_equal_bit_for_bit() {
        let item = Item { param4: f32::NAN, ..item(0, 3, 16) };
        assert_eq!(item, item);
        assert_ne!(item, Item { param4: 0.0, ..item });
        assert_ne!(item, Item { z: -0.0, ..item });
        assert_ne!(item, Item { mission_type: 1, ..item });
    }

    #[test]
    fn floats_become_the_integers_of_their_frame() {
        let place = |frame, x, y| {
            let item = item(0, frame, 16).with_floats(x, y);
            (item.x, item.y)
        };
        assert_eq!(place(3, 47.5, -8.25), (475_000_000, -82_500_000));
        assert_eq!(place(1, 1.5, -2.25), (15_000, -22_500));
        assert_eq!(place(2, 1.0, -1.0), (1, -1));
        assert_eq!(place(99, f32::NAN, f32::INFINITY), (ABSENT, ABSENT));
        assert_eq!(place(3, 300.0, -300.0), (ABSENT, ABSENT));
    }
}
