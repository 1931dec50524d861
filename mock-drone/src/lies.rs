//! What a firmware may do otherwise than is assumed of it: each lie is one assumption that does not hold.

use bitflags::bitflags;
use bytes::{Bytes, BytesMut};

bitflags! {
    /// Ways in which the drone is not as it is assumed to be, from its start on.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    pub struct Lies: u32 {
        /// A CONFIG takes effect, but is not acknowledged.
        const NO_ACKNOWLEDGEMENT = 1 << 0;
        /// CTRL 5 does not clear the acknowledgement.
        const STUCK_ACKNOWLEDGEMENT = 1 << 1;
        /// `control:altitude_max` is acknowledged, and stays as it was.
        const FIXED_CEILING = 1 << 2;
        /// `control:euler_angle_max` is kept in degrees.
        const TILT_IN_DEGREES = 1 << 3;
        /// Commands with old numbers are obeyed.
        const OBEYS_OLD_NUMBERS = 1 << 4;
        /// Number 1 does not restart the count.
        const IGNORES_NUMBER_ONE = 1 << 5;
        /// The watchdog bit never rises.
        const NO_WATCHDOG = 1 << 6;
        /// COMWDG does not clear the watchdog bit.
        const STUCK_WATCHDOG = 1 << 7;
        /// A link counts as lost after ten seconds.
        const PATIENT_LINK = 1 << 8;
        /// After a lost link no wake-up is answered, until a command arrives.
        const DEAF_AFTER_LOSS = 1 << 9;
        /// The configuration is not sent.
        const NO_CONFIGURATION = 1 << 10;
        /// The configuration ends without a NUL byte.
        const ENDLESS_CONFIGURATION = 1 << 11;
        /// The configuration lacks `control:control_vz_max`.
        const MISSING_KEY = 1 << 12;
        /// The firmware's version is another one.
        const OTHER_VERSION = 1 << 13;
        /// 5 packets a second in demo mode.
        const SLOW_DEMO = 1 << 14;
        /// 15 packets a second with all options.
        const SLOW_FULL = 1 << 15;
        /// The mask of options is ignored in demo mode.
        const FIXED_OPTIONS = 1 << 16;
        /// The options of the raw measures are four bytes shorter.
        const SHORT_OPTION = 1 << 17;
        /// Each tenth packet has a wrong checksum.
        const WRONG_CHECKSUM = 1 << 18;
        /// A packet of each tenth physics step, in demo mode about each tenth packet, has the number of the one before.
        const REPEATED_NUMBER = 1 << 19;
        /// The state says that the drone flies.
        const CLAIMS_TO_FLY = 1 << 20;
        /// The drone's clock is a tenth too fast.
        const FAST_CLOCK = 1 << 21;
        /// The charge is in millivolts.
        const CHARGE_IN_MILLIVOLTS = 1 << 22;
        /// The accelerometers' vertical axis points the other way.
        const GRAVITY_UP = 1 << 23;
        /// Pitch has the other sign, and is 10° too great.
        const TILTED = 1 << 24;
        /// The velocity is 0.5 m/s too great towards the right, also at rest.
        const MOVES_AT_REST = 1 << 25;
        /// The headers of the video name another codec.
        const OTHER_CODEC = 1 << 26;
        /// The headers of the video name another size.
        const OTHER_SIZE = 1 << 27;
        /// On the ground the control state is hovering.
        const CLAIMS_TO_HOVER = 1 << 28;
        /// It was left with the flying mode that hovers on tags.
        const FOLLOWS_TAGS = 1 << 29;
    }
}

impl Lies {
    /// The lie with this name, as `fixed-ceiling`; `None` if there is none.
    pub fn named(name: &str) -> Option<Self> {
        Self::from_name(&name.to_uppercase().replace('-', "_"))
    }

    /// The names of all, as they are given to [`Self::named`].
    pub fn names() -> Vec<String> {
        Self::all().iter_names().map(|(name, _)| name.to_lowercase().replace('_', "-")).collect()
    }

    /// A finished navdata packet as it is sent.
    pub(crate) fn spoil(self, sequence: u32, packet: BytesMut) -> Bytes {
        let mut packet = packet;
        if self.contains(Self::WRONG_CHECKSUM)
            && sequence.is_multiple_of(10)
            && let Some(last) = packet.last_mut()
        {
            *last ^= 0x55;
        }
        packet.freeze()
    }

    /// A picture of the video as it is sent, header first.
    #[cfg(feature = "video")]
    pub(crate) fn spoil_picture(self, picture: &Bytes) -> Bytes {
        /// Places in the header of the codec, and of the width that is shown.
        const CODEC: usize = 5;
        const SHOWN_WIDTH: usize = 16;
        if !self.intersects(Self::OTHER_CODEC | Self::OTHER_SIZE) {
            return picture.clone();
        }
        let mut picture = BytesMut::from(&picture[..]);
        if self.contains(Self::OTHER_CODEC)
            && let Some(codec) = picture.get_mut(CODEC)
        {
            *codec = 3;
        }
        if self.contains(Self::OTHER_SIZE)
            && let Some(width) = picture.get_mut(SHOWN_WIDTH..SHOWN_WIDTH + 2)
        {
            width.copy_from_slice(&320_u16.to_le_bytes());
        }
        picture.freeze()
    }

    /// The configuration as it is sent.
    pub(crate) fn spoil_configuration(self, text: String) -> Option<String> {
        if self.contains(Self::NO_CONFIGURATION) {
            return None;
        }
        let mut text = text;
        if self.contains(Self::ENDLESS_CONFIGURATION) {
            text.pop();
        }
        if self.contains(Self::MISSING_KEY) {
            text = text.replace("control:control_vz_max", "control:control_vz_limit");
        }
        if self.contains(Self::FOLLOWS_TAGS) {
            text = text.replace("control:flying_mode = 0", "control:flying_mode = 1");
        }
        if self.contains(Self::OTHER_VERSION) {
            text = text.replace("num_version_soft = 2.4.8", "num_version_soft = 1.11.5");
        }
        Some(text)
    }
}
