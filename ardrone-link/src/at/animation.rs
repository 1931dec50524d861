//! Flight animations and LED animations, by name.

use std::time::Duration;

macro_rules! animations {
    ($(#[$doc:meta])* $name:ident { $($(#[$variant_doc:meta])* $variant:ident = $number:literal, $text:literal;)* }) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        pub enum $name {
            $($(#[$variant_doc])* $variant,)*
        }

        impl $name {
            /// All of them, in the order of their numbers.
            pub const ALL: &[Self] = &[$(Self::$variant),*];

            /// The number in the AT command.
            pub fn number(self) -> u32 {
                match self {
                    $(Self::$variant => $number,)*
                }
            }

            /// The name that Parrot and other clients use.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $text,)*
                }
            }

            /// The animation with this number.
            pub fn from_number(number: u32) -> Option<Self> {
                Self::ALL.iter().copied().find(|animation| animation.number() == number)
            }

            /// The animation with this name.
            pub fn from_name(name: &str) -> Option<Self> {
                Self::ALL.iter().copied().find(|animation| animation.name() == name)
            }
        }
    };
}

animations! {
    /// A motion that the drone carries out by itself. All of them need height and battery charge.
    FlightAnimation {
        /// Rolls left by 30°.
        PhiMinus30 = 0, "phiM30Deg";
        /// Rolls right by 30°.
        Phi30 = 1, "phi30Deg";
        /// Pitches forward by 30°.
        ThetaMinus30 = 2, "thetaM30Deg";
        /// Pitches backward by 30°.
        Theta30 = 3, "theta30Deg";
        /// Pitches by 20° and turns right by 200°.
        Theta20YawRight200 = 4, "theta20degYaw200deg";
        /// Pitches by 20° and turns left by 200°.
        Theta20YawLeft200 = 5, "theta20degYawM200deg";
        /// Turns around.
        TurnAround = 6, "turnaround";
        /// Turns around and goes down.
        TurnAroundGoDown = 7, "turnaroundGodown";
        /// Shakes its heading.
        YawShake = 8, "yawShake";
        /// Dances with its heading.
        YawDance = 9, "yawDance";
        /// Dances with its roll.
        PhiDance = 10, "phiDance";
        /// Dances with its pitch.
        ThetaDance = 11, "thetaDance";
        /// Dances up and down.
        VzDance = 12, "vzDance";
        /// A wave.
        Wave = 13, "wave";
        /// Roll and pitch mixed.
        PhiThetaMixed = 14, "phiThetaMixed";
        /// Roll and pitch mixed, twice.
        DoublePhiThetaMixed = 15, "doublePhiThetaMixed";
        /// A flip forward; this and the next three need the drone's second generation.
        FlipAhead = 16, "flipAhead";
        /// A flip backward.
        FlipBehind = 17, "flipBehind";
        /// A flip to the left.
        FlipLeft = 18, "flipLeft";
        /// A flip to the right.
        FlipRight = 19, "flipRight";
    }
}

impl FlightAnimation {
    /// The duration recommended by Parrot.
    pub fn usual_duration(self) -> Duration {
        Duration::from_millis(match self.number() {
            0..=5 => 1000,
            8 => 2000,
            6 | 7 | 9..=15 => 5000,
            _ => 15,
        })
    }
}

animations! {
    /// A pattern of the four LEDs.
    LedAnimation {
        /// Blinks green and red.
        BlinkGreenRed = 0, "blinkGreenRed";
        /// Blinks green.
        BlinkGreen = 1, "blinkGreen";
        /// Blinks red.
        BlinkRed = 2, "blinkRed";
        /// Blinks orange.
        BlinkOrange = 3, "blinkOrange";
        /// A snake of green and red.
        SnakeGreenRed = 4, "snakeGreenRed";
        /// Fire.
        Fire = 5, "fire";
        /// The drone's own display.
        Standard = 6, "standard";
        /// Red.
        Red = 7, "red";
        /// Green.
        Green = 8, "green";
        /// A red snake.
        RedSnake = 9, "redSnake";
        /// Off.
        Blank = 10, "blank";
        /// A missile on the right.
        RightMissile = 11, "rightMissile";
        /// A missile on the left.
        LeftMissile = 12, "leftMissile";
        /// A missile on both sides.
        DoubleMissile = 13, "doubleMissile";
        /// Front left green, the others red.
        FrontLeftGreenOthersRed = 14, "frontLeftGreenOthersRed";
        /// Front right green, the others red.
        FrontRightGreenOthersRed = 15, "frontRightGreenOthersRed";
        /// Rear right green, the others red.
        RearRightGreenOthersRed = 16, "rearRightGreenOthersRed";
        /// Rear left green, the others red.
        RearLeftGreenOthersRed = 17, "rearLeftGreenOthersRed";
        /// Left green, right red.
        LeftGreenRightRed = 18, "leftGreenRightRed";
        /// Left red, right green.
        LeftRedRightGreen = 19, "leftRedRightGreen";
        /// Blinks the drone's own display.
        BlinkStandard = 20, "blinkStandard";
    }
}

/// A frequency from 0 to 60 Hz.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hertz(f32);

// A frequency is never NaN.
impl Eq for Hertz {}

impl Hertz {
    /// The value if it is in range.
    pub fn new(value: f32) -> Option<Self> {
        (0.0..=60.0).contains(&value).then_some(Self(value + 0.0))
    }

    /// The value.
    pub fn get(self) -> f32 {
        self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_numbers_lead_back() {
        assert_eq!((FlightAnimation::ALL.len(), LedAnimation::ALL.len()), (20, 21));
        for animation in FlightAnimation::ALL {
            assert_eq!(FlightAnimation::from_number(animation.number()), Some(*animation));
            assert_eq!(FlightAnimation::from_name(animation.name()), Some(*animation));
        }
        for animation in LedAnimation::ALL {
            assert_eq!(LedAnimation::from_number(animation.number()), Some(*animation));
            assert_eq!(LedAnimation::from_name(animation.name()), Some(*animation));
        }
        assert_eq!(LedAnimation::from_number(21), None);
        assert_eq!(FlightAnimation::from_name("barrelRoll"), None);
    }
}
