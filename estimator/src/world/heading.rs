//! The heading by the directions of the tags.

use kinematics::wrap_deg;

use super::World;
use super::camera::Look;
use super::history::Moment;

/// Five standard deviations of the compass's drift.
const MOST_RATE_DEG_S: f64 = 0.15;

impl World {
    /// Corrects the heading by a tag's orientation, once its sign is known.
    pub(super) fn orient(&mut self, tag: usize, look: &Look, moment: &Moment) {
        let heading_deg = moment.yaw_deg + self.filter.correction().heading_rad.to_degrees();
        let turned = self.orientation.saw(tag, heading_deg, look.orientation_deg);
        if turned.sign_changed {
            self.map.forget_found_headings();
        }
        let Some(direction_deg) = turned.direction_deg else { return };
        if self.map.was_turned(tag) {
            return;
        }
        if self.map.has_heading(tag) {
            let measured_deg = turned.newest_deg.unwrap_or(direction_deg);
            let off_deg = wrap_deg(measured_deg - self.filter.tag_heading_deg(tag));
            let uncertainty_deg = self.filter.heading_uncertainty_deg();
            let turns = self.map.watch_direction(tag, off_deg, uncertainty_deg);
            if turns || self.filter.heading_rate_deg_s().abs() > MOST_RATE_DEG_S {
                self.distrust_direction(tag);
            } else {
                self.filter.correct_heading(tag, measured_deg.to_radians());
            }
        } else {
            self.filter.begin_heading(tag, direction_deg.to_radians());
            self.map.learnt_heading(tag);
        }
    }

    /// Distrusts the direction of a tag that turns, which would turn the world: its residuals do not average out,
    /// or imply an impossible drift of the compass. Its position is still used.
    fn distrust_direction(&mut self, tag: usize) {
        /// Heading error that a turning tag may have caused before its detection.
        const LED_ASTRAY_DEG: f64 = 8.0;
        self.map.distrust_direction(tag);
        self.filter.forget_rate();
        self.filter.doubt_heading(LED_ASTRAY_DEG.to_radians());
    }
}
