//! Places and directions: our frame, MAVLink's local frames, and the globe.
//!
//! Ours ([`kinematics::Pose`]): x right, y forward, z up from the floor at the place of the take-off, in metres;
//! yaw in degrees clockwise from above. The drone knows neither where it is on the globe nor where north is: an
//! [`Origin`] says which place and which direction are meant.

use kinematics::{wrap_deg, wrap_rad};

/// Radius of the sphere, in metres: that of PX4 and MAVSDK. Scripts that mix local and global coordinates then
/// agree with us to the grid of 1e-7°.
const EARTH_RADIUS_M: f64 = 6_371_000.0;

/// Places on the globe are told to 1.1 cm, in degrees × 1e7: what is no further outside the fence than this, in metres, may have
/// been rounded. Heights get as much.
pub(crate) const GRID_M: f64 = 0.012;

/// Coordinate of a place in an integer field that is not given.
pub(crate) const ABSENT: i32 = i32::MAX;

/// Metres of one degree of latitude.
const METRES_PER_DEGREE: f64 = std::f64::consts::PI * EARTH_RADIUS_M / 180.0;
const LOCAL_SCALE: f64 = 1e4;
const GLOBAL_SCALE: f64 = 1e7;

/// Where on the globe the flight begins. Indoors it is fictitious.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Origin {
    /// Degrees, north positive.
    pub latitude_deg: f64,
    /// Degrees, east positive.
    pub longitude_deg: f64,
    /// Height of the floor above mean sea level, in metres.
    pub altitude_m: f64,
    /// Direction of our +y, in degrees clockwise from north.
    pub heading_deg: f64,
}

impl Default for Origin {
    /// The place that PX4's simulation uses.
    fn default() -> Self {
        Self {
            latitude_deg: 47.397_742,
            longitude_deg: 8.545_594,
            altitude_m: 488.0,
            heading_deg: 0.0,
        }
    }
}

/// Why a place cannot be the origin.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum OriginError {
    /// Within a degree of a pole, where east is nowhere, or beyond it.
    #[error("the origin's latitude of {0}° is not between -89 and 89")]
    Latitude(f64),
    /// Not a longitude.
    #[error("the origin's longitude of {0}° is not between -180 and 180")]
    Longitude(f64),
    /// Not on Earth.
    #[error("the origin's altitude of {0} m is not between -500 and 9000")]
    Altitude(f64),
    /// More than a turn, or not a number.
    #[error("the origin's heading of {0}° is not between -360 and 360")]
    Heading(f64),
}

/// A place on the globe as MAVLink's integers have it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Global {
    /// Degrees × 1e7, north positive.
    pub(crate) latitude_e7: i32,
    /// Degrees × 1e7, east positive.
    pub(crate) longitude_e7: i32,
}

/// The frames in which places are taken; numbers as in `MAV_FRAME`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Frame {
    /// 0 and 5: latitude, longitude, height above mean sea level.
    Global,
    /// 1: north, east, down from the start.
    LocalNed,
    /// 2: no place; the fields are parameters of a command.
    Mission,
    /// 3 and 6: latitude, longitude, height above the floor at the start.
    GlobalRelative,
    /// 4: east, north, up from the start.
    LocalEnu,
    /// 20: forward, right, down from the start, along the axes of the drone at the start.
    LocalFrd,
    /// 21: forward, left, up from the start, along the axes of the drone at the start.
    LocalFlu,
}

/// Why a place cannot be understood.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub(crate) enum PlaceError {
    /// Heights above a terrain that nobody knows.
    #[error("frame {0} counts heights from the terrain, which is not known here: use frame 3")]
    Terrain(u8),
    /// Another frame.
    #[error("frame {0} is not supported: use 3, 0, or a local one (1, 4, 20, 21)")]
    Frame(u8),
    /// The first coordinate.
    #[error("x is missing, or a latitude beyond a pole")]
    X,
    /// The second coordinate.
    #[error("y is missing, or a longitude beyond 180°")]
    Y,
    /// The third coordinate.
    #[error("the height is infinite")]
    Z,
}

/// A place in our frame; what was not given is `None`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Place {
    /// Right and forward of the start, in metres.
    pub(crate) ground_m: Option<(f64, f64)>,
    /// Height above the floor at the start, in metres.
    pub(crate) z_m: Option<f64>,
}

impl Frame {
    /// The frame of this `MAV_FRAME`.
    ///
    /// # Errors
    /// [`PlaceError::Terrain`], [`PlaceError::Frame`].
    pub(crate) fn from_number(number: u8) -> Result<Self, PlaceError> {
        match number {
            0 | 5 => Ok(Self::Global),
            1 => Ok(Self::LocalNed),
            2 => Ok(Self::Mission),
            3 | 6 => Ok(Self::GlobalRelative),
            4 => Ok(Self::LocalEnu),
            20 => Ok(Self::LocalFrd),
            21 => Ok(Self::LocalFlu),
            10 | 11 => Err(PlaceError::Terrain(number)),
            _ => Err(PlaceError::Frame(number)),
        }
    }

    /// Whether x and y are latitude and longitude.
    pub(crate) fn is_global(self) -> bool {
        matches!(self, Self::Global | Self::GlobalRelative)
    }

    /// Number by which the integers x and y of this frame are divided.
    pub(crate) fn scale(self) -> f64 {
        match self {
            Self::Global | Self::GlobalRelative => GLOBAL_SCALE,
            Self::LocalNed | Self::LocalEnu | Self::LocalFrd | Self::LocalFlu => LOCAL_SCALE,
            Self::Mission => 1.0,
        }
    }
}

impl Origin {
    /// This origin, if places near it can be told.
    ///
    /// # Errors
    /// [`OriginError`] names the value that is impossible.
    pub fn checked(self) -> Result<Self, OriginError> {
        if !(-89.0..=89.0).contains(&self.latitude_deg) {
            return Err(OriginError::Latitude(self.latitude_deg));
        }
        if !(-180.0..=180.0).contains(&self.longitude_deg) {
            return Err(OriginError::Longitude(self.longitude_deg));
        }
        if !(-500.0..=9000.0).contains(&self.altitude_m) {
            return Err(OriginError::Altitude(self.altitude_m));
        }
        if !(-360.0..=360.0).contains(&self.heading_deg) {
            return Err(OriginError::Heading(self.heading_deg));
        }
        Ok(self)
    }

    /// A place or velocity of ours, right, forward and up, as north, east and down.
    pub(crate) fn ned(self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let (north, east) = self.north_east(x, y);
        [north, east, -z]
    }

    /// Our yaw as radians clockwise from north, in [-π, π).
    pub(crate) fn yaw_ned_rad(&self, yaw_deg: f64) -> f64 {
        wrap_rad((yaw_deg + self.heading_deg).to_radians())
    }

    /// Radians clockwise from north as our yaw, in [-180, 180) degrees.
    pub(crate) fn yaw_deg(&self, yaw_ned_rad: f64) -> f64 {
        wrap_deg(yaw_ned_rad.to_degrees() - self.heading_deg)
    }

    /// The place on the globe, right and forward of the start.
    pub(crate) fn global(&self, x_m: f64, y_m: f64) -> Global {
        let (north_m, east_m) = self.north_east(x_m, y_m);
        let longitude_deg = self.longitude_deg + east_m / self.metres_per_degree_east();
        Global {
            latitude_e7: scaled(self.latitude_deg + north_m / METRES_PER_DEGREE, GLOBAL_SCALE),
            longitude_e7: scaled(wrap_deg(longitude_deg), GLOBAL_SCALE),
        }
    }

    /// Right and forward of the start, in metres.
    pub(crate) fn ground_m(&self, place: Global) -> (f64, f64) {
        let latitude_deg = f64::from(place.latitude_e7) / GLOBAL_SCALE;
        let longitude_deg = f64::from(place.longitude_e7) / GLOBAL_SCALE;
        self.right_forward(
            (latitude_deg - self.latitude_deg) * METRES_PER_DEGREE,
            wrap_deg(longitude_deg - self.longitude_deg) * self.metres_per_degree_east(),
        )
    }

    /// Height above mean sea level, in metres, of a height above the floor.
    pub(crate) fn amsl_m(&self, z_m: f64) -> f64 {
        self.altitude_m + z_m
    }

    /// Height above the floor, in metres, of one above mean sea level.
    pub(crate) fn z_m(&self, amsl_m: f64) -> f64 {
        amsl_m - self.altitude_m
    }

    /// The place in integer fields: degrees × 1e7 or metres × 1e4, [`ABSENT`] and NaN for what is not given. In
    /// [`Frame::Mission`] there is none.
    ///
    /// # Errors
    /// [`PlaceError`] if the frame is not supported, or a coordinate impossible; one of x and y alone is no place.
    pub(crate) fn place(&self, frame: u8, x: i32, y: i32, z: f32) -> Result<Place, PlaceError> {
        let frame = Frame::from_number(frame)?;
        if z.is_infinite() {
            return Err(PlaceError::Z);
        }
        if frame == Frame::Mission {
            return Ok(Place::default());
        }
        let z = f64::from(z);
        let z_m = match frame {
            Frame::Global => self.z_m(z),
            Frame::LocalNed | Frame::LocalFrd => -z,
            _ => z,
        };
        Ok(Place { ground_m: self.ground_in(frame, x, y)?, z_m: (!z_m.is_nan()).then_some(z_m) })
    }

    fn ground_in(&self, frame: Frame, x: i32, y: i32) -> Result<Option<(f64, f64)>, PlaceError> {
        match (x == ABSENT, y == ABSENT) {
            (true, true) => return Ok(None),
            (true, false) => return Err(PlaceError::X),
            (false, true) => return Err(PlaceError::Y),
            (false, false) => {}
        }
        let (first, second) = (f64::from(x) / frame.scale(), f64::from(y) / frame.scale());
        Ok(Some(match frame {
            Frame::Global | Frame::GlobalRelative => {
                if first.abs() > 90.0 {
                    return Err(PlaceError::X);
                }
                if second.abs() > 180.0 {
                    return Err(PlaceError::Y);
                }
                self.ground_m(Global { latitude_e7: x, longitude_e7: y })
            }
            Frame::LocalNed | Frame::Mission => self.right_forward(first, second),
            Frame::LocalEnu => self.right_forward(second, first),
            Frame::LocalFrd => (second, first),
            Frame::LocalFlu => (-second, first),
        }))
    }

    fn north_east(self, x: f64, y: f64) -> (f64, f64) {
        let (sin, cos) = self.heading_deg.to_radians().sin_cos();
        (y * cos - x * sin, y * sin + x * cos)
    }

    /// What is so far north and east, right and forward.
    pub(crate) fn right_forward(self, north: f64, east: f64) -> (f64, f64) {
        let (sin, cos) = self.heading_deg.to_radians().sin_cos();
        (east * cos - north * sin, north * cos + east * sin)
    }

    fn metres_per_degree_east(&self) -> f64 {
        METRES_PER_DEGREE * self.latitude_deg.to_radians().cos()
    }
}

/// The nearest integer, never [`ABSENT`].
fn scaled(value: f64, scale: f64) -> i32 {
    // The cast saturates.
    #[allow(clippy::cast_possible_truncation)]
    let scaled = (value * scale).round() as i32;
    scaled.min(ABSENT - 1)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    impl Origin {
        /// The integer fields for a place, the inverse of [`Self::place`].
        pub(crate) fn fields(&self, frame: Frame, place: &Place) -> (i32, i32, f32) {
            let (x, y) = match (place.ground_m, frame) {
                (None, _) | (_, Frame::Mission) => (ABSENT, ABSENT),
                (Some((x_m, y_m)), Frame::Global | Frame::GlobalRelative) => {
                    let Global { latitude_e7, longitude_e7 } = self.global(x_m, y_m);
                    (latitude_e7, longitude_e7)
                }
                (Some((x_m, y_m)), _) => {
                    let (north_m, east_m) = self.north_east(x_m, y_m);
                    let (x, y) = match frame {
                        Frame::LocalEnu => (east_m, north_m),
                        Frame::LocalFrd => (y_m, x_m),
                        Frame::LocalFlu => (y_m, -x_m),
                        _ => (north_m, east_m),
                    };
                    (scaled(x, LOCAL_SCALE), scaled(y, LOCAL_SCALE))
                }
            };
            let z = match (place.z_m, frame) {
                (None, _) | (_, Frame::Mission) => f64::NAN,
                (Some(z_m), Frame::Global) => self.amsl_m(z_m),
                (Some(z_m), Frame::LocalNed | Frame::LocalFrd) => -z_m,
                (Some(z_m), _) => z_m,
            };
            // A height has less than 24 significant bits of meaning.
            #[allow(clippy::cast_possible_truncation)]
            (x, y, z as f32)
        }
    }

    /// Our +y points east.
    const EASTWARD: Origin = Origin {
        latitude_deg: 47.397_742,
        longitude_deg: 8.545_594,
        altitude_m: 488.0,
        heading_deg: 90.0,
    };
    const FRAMES: [u8; 8] = [0, 1, 3, 4, 5, 6, 20, 21];

    #[track_caller]
    fn assert_near(left: &[f64], right: &[f64], within: f64) {
        for (left, right) in left.iter().zip(right) {
            assert!((left - right).abs() <= within, "{left} is not {right}");
        }
    }

    #[test]
    fn signs_are_right_in_all_four_directions() {
        // Right, forward, and where that is: north, east.
        for (heading_deg, x_m, y_m, north_m, east_m) in [
            (0.0, 0.0, 1.0, 1.0, 0.0),
            (0.0, 1.0, 0.0, 0.0, 1.0),
            (0.0, 0.0, -1.0, -1.0, 0.0),
            (0.0, -1.0, 0.0, 0.0, -1.0),
            (90.0, 0.0, 1.0, 0.0, 1.0),
            (90.0, 1.0, 0.0, -1.0, 0.0),
            (90.0, 0.0, -1.0, 0.0, -1.0),
            (90.0, -1.0, 0.0, 1.0, 0.0),
            (180.0, 0.0, 1.0, -1.0, 0.0),
            (180.0, 1.0, 0.0, 0.0, -1.0),
            (-90.0, 0.0, 1.0, 0.0, -1.0),
            (-90.0, 1.0, 0.0, 1.0, 0.0),
        ] {
            let origin = Origin { heading_deg, ..Origin::default() };
            assert_near(&origin.ned([x_m, y_m, 1.5]), &[north_m, east_m, -1.5], 1e-9);
            let yaw_deg = origin.yaw_ned_rad(0.0).to_degrees();
            assert_near(&[wrap_deg(yaw_deg - heading_deg)], &[0.0], 1e-9);
        }
    }

    #[test]
    fn the_globe_is_a_sphere_of_the_agreed_radius() {
        let origin = Origin::default();
        let start = Global { latitude_e7: 473_977_420, longitude_e7: 85_455_940 };
        assert_eq!(origin.global(0.0, 0.0), start);
        // 10 m north are 10 / 111194.93 degrees; east they are more of them.
        let north = Global { latitude_e7: 473_978_319, ..start };
        assert_eq!(origin.global(0.0, 10.0), north);
        assert_eq!(origin.global(10.0, 0.0), Global { longitude_e7: 85_457_269, ..start });
        assert_eq!(EASTWARD.global(-10.0, 0.0), north);
        assert_near(&[origin.amsl_m(1.5), origin.z_m(490.0)], &[489.5, 2.0], 1e-9);
    }

    #[test]
    fn the_date_line_is_no_border() {
        let origin = Origin { latitude_deg: 0.0, longitude_deg: 180.0, ..Origin::default() };
        let east = origin.global(10.0, 0.0);
        assert_eq!(east.longitude_e7, -1_799_999_101);
        let (x_m, y_m) = origin.ground_m(east);
        assert_near(&[x_m, y_m], &[10.0, 0.0], 0.012);
    }

    #[test]
    fn the_same_place_in_each_frame() {
        // 2 m right, 3 m forward, 1.5 m up: with +y to the east that is 2 m south, 3 m east.
        let place = Place { ground_m: Some((2.0, 3.0)), z_m: Some(1.5) };
        for (frame, x, y, z) in [
            (1, -20_000, 30_000, -1.5),
            (4, 30_000, -20_000, 1.5),
            (20, 30_000, 20_000, -1.5),
            (21, 30_000, -20_000, 1.5),
        ] {
            let there = EASTWARD.place(frame, x, y, z).unwrap();
            let (x_m, y_m) = there.ground_m.unwrap();
            assert_near(&[x_m, y_m, there.z_m.unwrap()], &[2.0, 3.0, 1.5], 1e-9);
            let frame = Frame::from_number(frame).unwrap();
            assert_eq!(EASTWARD.fields(frame, &place), (x, y, z));
        }
        let Global { latitude_e7, longitude_e7 } = EASTWARD.global(2.0, 3.0);
        assert!(latitude_e7 < 473_977_420 && longitude_e7 > 85_455_940);
        for (frame, z) in [(0, 489.5), (5, 489.5), (3, 1.5), (6, 1.5)] {
            let there = EASTWARD.place(frame, latitude_e7, longitude_e7, z).unwrap();
            let (x_m, y_m) = there.ground_m.unwrap();
            assert_near(&[x_m, y_m, there.z_m.unwrap()], &[2.0, 3.0, 1.5], 0.012);
        }
    }

    #[test]
    fn what_is_not_given_is_absent() {
        let origin = Origin::default();
        for frame in FRAMES {
            assert_eq!(origin.place(frame, ABSENT, ABSENT, f32::NAN), Ok(Place::default()));
            assert_eq!(origin.place(frame, ABSENT, 0, 1.0), Err(PlaceError::X));
            assert_eq!(origin.place(frame, 0, ABSENT, 1.0), Err(PlaceError::Y));
            assert_eq!(origin.place(frame, 0, 0, f32::INFINITY), Err(PlaceError::Z));
        }
        assert_eq!(origin.place(2, 5, 6, 7.0), Ok(Place::default()));
        assert_eq!(origin.fields(Frame::LocalNed, &Place::default()).0, ABSENT);
        assert_eq!(origin.place(3, 900_000_001, 0, 1.0), Err(PlaceError::X));
        assert_eq!(origin.place(3, 0, 1_800_000_001, 1.0), Err(PlaceError::Y));
    }

    #[test]
    fn other_frames_are_refused() {
        for frame in (0..=u8::MAX).filter(|frame| *frame != 2 && !FRAMES.contains(frame)) {
            let expected = match frame {
                10 | 11 => PlaceError::Terrain(frame),
                _ => PlaceError::Frame(frame),
            };
            assert_eq!(Origin::default().place(frame, 0, 0, 1.0), Err(expected));
        }
    }

    #[test]
    fn an_origin_without_an_east_is_refused() {
        assert!(Origin::default().checked().is_ok());
        let at = |latitude_deg| Origin { latitude_deg, ..Origin::default() }.checked();
        assert_eq!(at(90.0), Err(OriginError::Latitude(90.0)));
        assert!(at(f64::NAN).is_err());
        let wrong = Origin { longitude_deg: 181.0, ..Origin::default() }.checked();
        assert_eq!(wrong, Err(OriginError::Longitude(181.0)));
        let wrong = Origin { altitude_m: f64::INFINITY, ..Origin::default() }.checked();
        assert_eq!(wrong, Err(OriginError::Altitude(f64::INFINITY)));
        assert!(Origin { heading_deg: 400.0, ..Origin::default() }.checked().is_err());
    }

    fn origins() -> impl Strategy<Value = Origin> {
        (-80.0_f64..80.0, -180.0_f64..180.0, -400.0_f64..5000.0, -360.0_f64..360.0).prop_map(
            |(latitude_deg, longitude_deg, altitude_m, heading_deg)| Origin {
                latitude_deg,
                longitude_deg,
                altitude_m,
                heading_deg,
            },
        )
    }

    proptest! {
        #[test]
        fn ned_and_back(
            origin in origins(),
            (x_m, y_m, z_m, yaw_deg) in (-50.0..50.0, -50.0..50.0, -3.0..3.0, -179.0..179.0),
        ) {
            let [north_m, east_m, down_m] = origin.ned([x_m, y_m, z_m]);
            let (back_x_m, back_y_m) = origin.right_forward(north_m, east_m);
            assert_near(&[back_x_m, back_y_m, -down_m], &[x_m, y_m, z_m], 1e-6);
            assert_near(&[origin.yaw_deg(origin.yaw_ned_rad(yaw_deg))], &[yaw_deg], 1e-6);
        }

        #[test]
        fn each_frame_and_back(
            origin in origins(),
            frame in prop::sample::select(&FRAMES[..]),
            (x_m, y_m, z_m) in (-50.0..50.0, -50.0..50.0, 0.0..3.0),
        ) {
            let place = Place { ground_m: Some((x_m, y_m)), z_m: Some(z_m) };
            let (x, y, z) = origin.fields(Frame::from_number(frame).unwrap(), &place);
            let back = origin.place(frame, x, y, z).unwrap();
            let (back_x_m, back_y_m) = back.ground_m.unwrap();
            assert_near(&[back_x_m, back_y_m], &[x_m, y_m], 0.012);
            assert_near(&[back.z_m.unwrap()], &[z_m], 0.001);
        }

        #[test]
        fn any_fields_are_a_place_or_refused(
            origin in origins(), frame: u8, x: i32, y: i32, z: f32,
        ) {
            if let Ok(Place { ground_m: Some((x_m, y_m)), z_m }) = origin.place(frame, x, y, z) {
                prop_assert!(x_m.is_finite() && y_m.is_finite());
                prop_assert!(z_m.is_none_or(f64::is_finite));
            }
        }
    }
}
