//! Items of a mission, as they travel.

use crate::place::{ABSENT, Frame};

/// An item as `MISSION_ITEM_INT` carries it, kept bit for bit: a mission reads back as it was sent.
#[derive(Debug, Clone, Copy)]
pub struct Item {
    /// Its index, from 0.
    pub seq: u16,
    /// `MAV_FRAME`.
    pub frame: u8,
    /// `MAV_CMD`; see [`command`].
    pub command: u16,
    /// Whether it is the current one.
    pub current: u8,
    /// Whether the next follows by itself.
    pub autocontinue: u8,
    /// First parameter of the command.
    pub param1: f32,
    /// Second parameter.
    pub param2: f32,
    /// Third parameter.
    pub param3: f32,
    /// Fourth parameter.
    pub param4: f32,
    /// Fifth parameter: latitude in degrees × 1e7, or a local coordinate in metres × 1e4.
    pub x: i32,
    /// Sixth parameter: longitude in degrees × 1e7, or a local coordinate in metres × 1e4.
    pub y: i32,
    /// Seventh parameter: height in metres, in its frame.
    pub z: f32,
    /// `MAV_MISSION_TYPE`: 0 for a mission.
    pub mission_type: u8,
}

/// The `MAV_CMD` that have a meaning in a mission.
pub mod command {
    /// Fly to a place.
    pub const NAV_WAYPOINT: u16 = 16;
    /// Hold a place until an order.
    pub const NAV_LOITER_UNLIM: u16 = 17;
    /// Hold a place for some time.
    pub const NAV_LOITER_TIME: u16 = 19;
    /// Fly to the start, and land.
    pub const NAV_RETURN_TO_LAUNCH: u16 = 20;
    /// Land.
    pub const NAV_LAND: u16 = 21;
    /// Take off.
    pub const NAV_TAKEOFF: u16 = 22;
    /// Land at a place in a local frame.
    pub const NAV_LAND_LOCAL: u16 = 23;
    /// Take off at a place in a local frame.
    pub const NAV_TAKEOFF_LOCAL: u16 = 24;
    /// Wait.
    pub const NAV_DELAY: u16 = 93;
    /// Wait.
    pub const CONDITION_DELAY: u16 = 112;
    /// Turn.
    pub const CONDITION_YAW: u16 = 115;
    /// Limit the speed.
    pub const DO_CHANGE_SPEED: u16 = 178;
}

impl Item {
    /// The item that a `MISSION_ITEM` carries, whose x and y are degrees, metres or parameters in `f32`. NaN, and
    /// what no integer holds, is [`ABSENT`].
    #[must_use]
    pub fn with_floats(self, x: f32, y: f32) -> Self {
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

    fn bits(&self) -> ([u16; 6], [u32; 5], [i32; 2]) {
        let Self { seq, frame, command, current, autocontinue, x, y, mission_type, .. } = *self;
        let [frame, current, autocontinue, mission_type] =
            [frame, current, autocontinue, mission_type].map(u16::from);
        let floats = [self.param1, self.param2, self.param3, self.param4, self.z];
        (
            [seq, frame, command, current, autocontinue, mission_type],
            floats.map(f32::to_bits),
            [x, y],
        )
    }
}

/// Equal bit for bit: a NaN equals itself.
impl PartialEq for Item {
    fn eq(&self, other: &Self) -> bool {
        self.bits() == other.bits()
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
