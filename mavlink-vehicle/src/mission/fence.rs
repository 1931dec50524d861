//! The fence as items: whoever asks reads it. It is set where the vehicle is started, and by no message.

use autopilot::plan::Shape;

use super::{Item, Rules};
use crate::place::Global;

/// `MAV_MISSION_TYPE`.
pub(crate) const FENCE: u8 = 1;
/// `MAV_CMD_NAV_FENCE_POLYGON_VERTEX_INCLUSION`: its first parameter is the number of corners.
const POLYGON_CORNER: u16 = 5001;
/// `MAV_CMD_NAV_FENCE_CIRCLE_INCLUSION`: its first parameter is the radius, in metres.
const CIRCLE: u16 = 5003;
/// `MAV_FRAME_GLOBAL`
const GLOBAL: u8 = 0;

/// What is no further from the vehicle's own, in metres, is the same.
const SAME_M: f32 = 0.05;

/// How many items the fence has.
pub(crate) fn count(rules: &Rules) -> u16 {
    match rules.fence.border.shape() {
        Shape::Circle { .. } => 1,
        // At most a few dozen.
        Shape::Polygon(corners_m) => u16::try_from(corners_m.len()).unwrap_or(u16::MAX),
    }
}

/// An item of it.
pub(crate) fn item(seq: u16, rules: &Rules) -> Option<Item> {
    let (command, param1, [x_m, y_m]) = match rules.fence.border.shape() {
        Shape::Circle { radius_m } => (seq == 0).then_some((CIRCLE, radius_m, [0.0, 0.0]))?,
        Shape::Polygon(corners_m) => {
            (POLYGON_CORNER, f64::from(count(rules)), *corners_m.get(usize::from(seq))?)
        }
    };
    let place = rules.origin.global(x_m, y_m);
    #[allow(clippy::cast_possible_truncation, reason = "parameters are f32")]
    let param1 = param1 as f32;
    Some(Item {
        seq,
        frame: GLOBAL,
        command,
        current: 0,
        autocontinue: 0,
        param1,
        param2: 0.0,
        param3: 0.0,
        param4: 0.0,
        x: place.latitude_e7,
        y: place.longitude_e7,
        z: 0.0,
        mission_type: FENCE,
    })
}

/// Whether an item is that of the vehicle's fence, as far as one that has travelled can be told from it.
pub(crate) fn is_same(sent: &Item, rules: &Rules) -> bool {
    let Some(own) = item(sent.seq, rules) else { return false };
    let metres =
        |item: &Item| rules.origin.ground_m(Global { latitude_e7: item.x, longitude_e7: item.y });
    let ((x_m, y_m), (own_x_m, own_y_m)) = (metres(sent), metres(&own));
    (sent.command, sent.frame) == (own.command, own.frame)
        && (sent.param1 - own.param1).abs() <= SAME_M
        && (x_m - own_x_m).hypot(y_m - own_y_m) <= f64::from(SAME_M)
}

#[cfg(test)]
mod tests {
    use autopilot::plan::{Border, FlightLimits};

    use super::*;
    use crate::place::Origin;

    fn rules(border: &Border) -> Rules {
        let fence = FlightLimits::new(*border, 0.3, 3.0);
        let origin = Origin { heading_deg: 90.0, ..Origin::default() };
        Rules { origin, fence, max_speed_m_s: 2.0 }
    }

    #[test]
    fn a_circle_is_one_item_at_the_origin() {
        let rules = rules(&Border::circle(4.0));
        assert_eq!((count(&rules), item(1, &rules)), (1, None));
        let item = item(0, &rules).unwrap();
        assert_eq!((item.command, item.mission_type, item.frame), (5003, 1, 0));
        assert!((item.param1 - 4.0).abs() < 1e-6);
        assert_eq!((item.x, item.y), (473_977_420, 85_455_940));
    }

    #[test]
    fn a_polygon_is_its_corners_in_their_order() {
        let corners_m = [[-1.0, -1.0], [3.0, -1.0], [0.0, 2.0]];
        let rules = rules(&Border::polygon(&corners_m).unwrap());
        assert_eq!((count(&rules), item(3, &rules)), (3, None));
        for (seq, [x_m, y_m]) in (0..).zip(corners_m) {
            let item = item(seq, &rules).unwrap();
            assert_eq!((item.seq, item.command), (seq, 5001));
            assert!((item.param1 - 3.0).abs() < 1e-6);
            let place = Global { latitude_e7: item.x, longitude_e7: item.y };
            let (found_x_m, found_y_m) = rules.origin.ground_m(place);
            assert!((found_x_m - x_m).hypot(found_y_m - y_m) < 0.02, "{found_x_m} {found_y_m}");
        }
    }
}
