//! Pictures of a floor whose texture is fixed to the world, with the tags that lie on it.

use nalgebra::{Rotation3, Vector2, Vector3};

use crate::camera::{FOCAL_UNITS, FloorTag};

/// Size of a picture as it is shown.
pub(super) const WIDTH: usize = 640;
pub(super) const HEIGHT: usize = 360;
/// Focal length of the bottom camera: its picture is as wide as ours.
fn bottom_focal_px() -> f64 {
    FOCAL_UNITS.x * WIDTH as f64 / 1000.0
}
/// Focal length of the front camera: 92 degrees along the diagonal.
const FRONT_FOCAL_PX: f64 = 354.0;
/// The bottom camera of a drone on the ground would be in the floor.
const LEAST_HEIGHT_M: f64 = 0.05;
/// Beyond this the floor is as bright as its mean, because its texture is finer than a pixel.
const FAR_M: f64 = 12.0;
/// Width of the floor's squares, and of its grain.
const SQUARE_M: f64 = 0.5;
const GRAIN_M: f64 = 0.04;
/// Brightness (16 to 235) of the floor, of its lines, and of the sky.
const FLOOR: f64 = 120.0;
const LINE: f64 = 60.0;
const SKY: u8 = 190;
/// Half the width of the lines between squares.
const HALF_LINE_M: f64 = 0.008;
/// Radii in a roundel, as shares of its diameter: the dot, the ring around it, and the mark that points.
const DOT: f64 = 0.17;
const RING: [f64; 2] = [0.33, 0.5];
const MARK_HALF_WIDTH: f64 = 0.06;
const BLACK: u8 = 20;
const WHITE: u8 = 225;

/// From where a picture is taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// Right, forward, up from the start.
    pub position_m: Vector3<f64>,
    /// Clockwise from above.
    pub yaw_rad: f64,
    /// Nose up.
    pub pitch_rad: f64,
    /// Right side down.
    pub roll_rad: f64,
    /// The camera below, not that in front.
    pub is_bottom: bool,
}

/// What there is to see.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Scene {
    /// Tags on the floor.
    pub tags: Vec<FloorTag>,
}

/// A picture: brightness, and two colours of half the size.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Pixels {
    pub(super) luma: Vec<u8>,
    pub(super) blue: Vec<u8>,
    pub(super) red: Vec<u8>,
}

impl Default for Pixels {
    fn default() -> Self {
        let half = vec![128; WIDTH / 2 * (HEIGHT / 2)];
        Self { luma: vec![0; WIDTH * HEIGHT], blue: half.clone(), red: half }
    }
}

impl Scene {
    /// Renders a picture.
    pub(super) fn render(&self, view: &View, pixels: &mut Pixels) {
        let rays = Rays::new(view);
        for row in 0..HEIGHT {
            for column in 0..WIDTH {
                let floor = rays.floor(column, row);
                pixels.luma[row * WIDTH + column] =
                    floor.map_or(SKY, |(place_m, distance_m)| self.brightness(place_m, distance_m));
                // Of four pixels the first gives the colours.
                if row % 2 == 0 && column % 2 == 0 {
                    let index = row / 2 * (WIDTH / 2) + column / 2;
                    let (blue, red) = floor.map_or((150, 118), |(place_m, _)| tint(place_m));
                    pixels.blue[index] = blue;
                    pixels.red[index] = red;
                }
            }
        }
    }

    fn brightness(&self, place_m: Vector2<f64>, distance_m: f64) -> u8 {
        if let Some(pattern) = self.tags.iter().find_map(|tag| pattern(tag, place_m)) {
            return pattern;
        }
        let [(x, beside_x), (y, beside_y)] =
            [place_m.x, place_m.y].map(|part| cell(part, SQUARE_M));
        let is_line = beside_x.min(beside_y) < HALF_LINE_M / SQUARE_M;
        let square = 50.0 * (noise(x, y, 1) - 0.5);
        let [(fine_x, _), (fine_y, _)] = [place_m.x, place_m.y].map(|part| cell(part, GRAIN_M));
        let grain = noise(fine_x, fine_y, 2) - 0.5;
        let near = (1.0 - distance_m / FAR_M).max(0.0);
        let texture = if is_line { LINE - FLOOR } else { square + 24.0 * grain };
        level(FLOOR + near * texture)
    }
}

/// Directions of the pixels. By coordinates: there are 230 000 in each picture.
struct Rays {
    eye_m: [f64; 3],
    /// The middle of the picture, one pixel to the right and one down, in the world.
    middle: [f64; 3],
    right: [f64; 3],
    down: [f64; 3],
}

impl Rays {
    fn new(view: &View) -> Self {
        let up = Vector3::z_axis();
        let attitude = Rotation3::from_axis_angle(&up, -view.yaw_rad)
            * Rotation3::from_axis_angle(&Vector3::x_axis(), view.pitch_rad)
            * Rotation3::from_axis_angle(&Vector3::y_axis(), view.roll_rad);
        let (middle, down, focal_px) = if view.is_bottom {
            (-Vector3::z(), -Vector3::y(), bottom_focal_px())
        } else {
            (Vector3::y(), -Vector3::z(), FRONT_FOCAL_PX)
        };
        let at = view.position_m;
        Self {
            eye_m: [at.x, at.y, at.z.max(LEAST_HEIGHT_M)],
            middle: (attitude * middle).into(),
            right: (attitude * Vector3::x() / focal_px).into(),
            down: (attitude * down / focal_px).into(),
        }
    }

    /// The place on the floor that a pixel shows, and its distance; `None` above the horizon.
    fn floor(&self, column: usize, row: usize) -> Option<(Vector2<f64>, f64)> {
        let right = column as f64 + 0.5 - WIDTH as f64 / 2.0;
        let down = row as f64 + 0.5 - HEIGHT as f64 / 2.0;
        let Self { eye_m: [x, y, z], middle: m, right: r, down: d } = self;
        let up = m[2] + r[2] * right + d[2] * down;
        (up < -1e-3).then(|| {
            let distance_m = -z / up;
            let across = (m[0] + r[0] * right + d[0] * down) * distance_m;
            let along = (m[1] + r[1] * right + d[1] * down) * distance_m;
            (Vector2::new(x + across, y + along), distance_m)
        })
    }
}

/// The brightness of a roundel at a place on the floor; `None` beside it.
fn pattern(tag: &FloorTag, place_m: Vector2<f64>) -> Option<u8> {
    let way = (place_m - tag.place_m) / tag.size_m;
    let radius = way.norm();
    (radius <= RING[1]).then(|| {
        let (sin, cos) = tag.heading_deg.to_radians().sin_cos();
        let (ahead, aside) = (way.x * sin + way.y * cos, way.x * cos - way.y * sin);
        let is_mark = ahead > 0.0 && aside.abs() < MARK_HALF_WIDTH;
        if is_mark || !(DOT..=RING[0]).contains(&radius) { BLACK } else { WHITE }
    })
}

/// The colours of a square.
fn tint(place_m: Vector2<f64>) -> (u8, u8) {
    let [(x, _), (y, _)] = [place_m.x, place_m.y].map(|part| cell(part, SQUARE_M));
    let colour = |salt| level(128.0 + 24.0 * (noise(x, y, salt) - 0.5));
    (colour(3), colour(4))
}

/// The cell of a grid in which a coordinate lies, and the distance to its nearer edge, in widths of a cell.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped before")]
fn cell(place_m: f64, width_m: f64) -> (u32, f64) {
    // Positive, so that cutting off is rounding down, which is much faster.
    const MIDDLE: f64 = 1e6;
    let place = (place_m / width_m + MIDDLE).clamp(0.0, 2.0 * MIDDLE);
    let cell = place as u32;
    let inside = place - f64::from(cell);
    (cell, inside.min(1.0 - inside))
}

/// A number from 0 to 1 that belongs to a cell of the floor.
fn noise(x: u32, y: u32, salt: u32) -> f64 {
    let mut hash =
        x.wrapping_mul(0x9e37_79b1) ^ y.wrapping_mul(0x85eb_ca6b) ^ salt.wrapping_mul(0xc2b2_ae35);
    hash ^= hash >> 15;
    hash = hash.wrapping_mul(0x2c1b_3c6d);
    hash ^= hash >> 12;
    f64::from(hash & 0xffff) / 65535.0
}

/// Rounded, in the range of video.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped before")]
fn level(brightness: f64) -> u8 {
    brightness.clamp(16.0, 235.0) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    fn above(x: f64, y: f64, height: f64) -> View {
        View {
            position_m: Vector3::new(x, y, height),
            yaw_rad: 0.0,
            pitch_rad: 0.0,
            roll_rad: 0.0,
            is_bottom: true,
        }
    }

    fn rendered(scene: &Scene, view: &View) -> Pixels {
        let mut pixels = Pixels::default();
        scene.render(view, &mut pixels);
        pixels
    }

    /// Brightness of a pixel.
    fn at(pixels: &Pixels, column: usize, row: usize) -> u8 {
        pixels.luma[row * WIDTH + column]
    }

    #[test]
    fn a_tag_is_where_the_projection_says() {
        let scene = Scene { tags: vec![FloorTag::new(0.3, -0.1, 90.0)] };
        let pixels = rendered(&scene, &above(0.0, 0.0, 1.0));
        // 0.3 m right and 0.1 m behind, 1 m below.
        let [column, row] = [320 + 206, 180 + 69];
        assert_eq!(at(&pixels, column, row), BLACK);
        // White between dot and ring, 0.048 m from the middle; the mark points to the right.
        let off = 33;
        assert_eq!(at(&pixels, column - off, row), WHITE);
        assert_eq!(at(&pixels, column, row - off), WHITE);
        assert_eq!(at(&pixels, column + off, row), BLACK);
    }

    #[test]
    fn the_picture_moves_with_the_drone() {
        let scene = Scene { tags: vec![FloorTag::new(0.0, 0.0, 0.0)] };
        let middle = |view: &View| at(&rendered(&scene, view), 320, 180);
        assert_eq!(middle(&above(0.0, 0.0, 1.5)), BLACK);
        assert_ne!(middle(&above(0.5, 0.0, 1.5)), BLACK);
        // Tilted forward by 20 degrees at 1 m, it looks 0.36 m behind.
        let pitch_rad = (-20.0_f64).to_radians();
        let tilted = View { pitch_rad, ..above(0.0, 0.364, 1.0) };
        assert_eq!(middle(&tilted), BLACK);
        let turned = View { yaw_rad: std::f64::consts::FRAC_PI_2, ..tilted };
        assert_ne!(middle(&turned), BLACK);
    }

    #[test]
    fn the_front_camera_sees_a_horizon() {
        let view = View { is_bottom: false, ..above(0.0, 0.0, 1.0) };
        let level = rendered(&Scene::default(), &view);
        assert_eq!(at(&level, 320, 170), SKY);
        assert_ne!(at(&level, 320, 190), SKY);
        // A drone that tilts to the right sees the horizon lower on its left.
        let rolled = rendered(&Scene::default(), &View { roll_rad: 0.3, ..view });
        assert_eq!((at(&rolled, 20, 190), at(&rolled, 620, 190) == SKY), (SKY, false));
        assert_ne!(at(&rolled, 620, 170), SKY);
    }
}
