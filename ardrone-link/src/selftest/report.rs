//! What was found.

use std::fmt;

/// Declares the assumptions, each with its name for programs and its text for people.
macro_rules! assumptions {
    ($($(#[$doc:meta])* $variant:ident = $name:literal, $text:literal;)*) => {
        /// Something that is assumed of the drone's firmware.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        pub enum Assumption {
            $($(#[$doc])* $variant,)*
        }

        impl Assumption {
            /// All of them, in the order in which they are examined.
            pub const ALL: &[Self] = &[$(Self::$variant),*];

            /// Its name for programs.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name,)*
                }
            }
        }

        impl fmt::Display for Assumption {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(match self {
                    $(Self::$variant => $text,)*
                })
            }
        }
    };
}

assumptions! {
    /// State bit 6 rises after a CONFIG.
    Acknowledged = "acknowledged", "a setting is acknowledged by bit 6 of the state, within 0.5 s";
    /// CTRL with mode 5 clears it.
    Cleared = "acknowledgement-cleared", "CTRL 5 clears the acknowledgement, within 0.5 s";
    /// Decoding and checksum.
    Intact = "intact", "navdata packets have the known form and a right checksum";
    /// Numbers of the packets.
    Counted = "counted", "each navdata packet has a greater number than the one before";
    /// Rate in demo mode.
    DemoRate = "demo-rate", "in demo mode 15 packets a second, 12 to 18";
    /// Option 0.
    DemoOption = "demo-option", "in demo mode each packet has attitude, altitude, velocity and charge";
    /// The text on TCP 5559.
    Configuration = "configuration", "the configuration comes over the control port within 3 s, and ends with a NUL byte";
    /// `general:num_version_soft`.
    Version = "version", "the firmware is version 2.4.x, and its configuration and its FTP server say the same";
    /// Keys that are only read.
    UnsetKeys = "unset-keys", "what no flight sets is as it left the factory: flying_mode 0, control_level 0, manual_trim FALSE, com_watchdog 2";
    /// Each setting of a flight.
    Settings = "settings", "each setting of a flight is acknowledged, and its value is read back";
    /// `general:navdata_options`.
    RequestedOptions = "requested-options", "in demo mode the options that were asked for are sent, each in its known size";
    /// Rate in full mode.
    FullRate = "full-rate", "with all options 200 packets a second, 120 to 240";
    /// Options 0 to 26.
    AllOptions = "all-options", "with all options tags 0 to 26 are there, each in its known size";
    /// Option 1.
    Clock = "clock", "the drone's clock runs as fast as ours, within 2 %";
    /// Percent, not millivolts.
    Charge = "charge", "the charge is in percent, and fits the battery's voltage";
    /// Option 3 on the ground.
    Gravity = "gravity", "at rest the accelerometers read 9.8 m/s² within 1, upwards";
    /// Attitude by gyroscopes and by accelerometers.
    Attitude = "attitude", "at rest pitch and roll agree with the accelerometers within 5°";
    /// Demo option on the ground.
    AtRest = "at-rest", "at rest the control state is landed, the velocity is below 0.2 m/s and the altitude below 0.5 m";
    /// Repeated and older numbers of commands.
    OldNumbers = "old-numbers", "a command whose number is not greater than the last one is ignored";
    /// The number that restarts the count.
    NumberOne = "number-one", "a command with number 1 is obeyed, and the count restarts";
    /// State bit 30.
    Watchdog = "watchdog", "without a command bit 30 of the state rises, within 0.4 s";
    /// COMWDG.
    WatchdogCleared = "watchdog-cleared", "COMWDG clears bit 30, within 0.5 s";
    /// TCP 5555.
    Video = "video", "the video is H.264 of 640 x 360, 10 to 35 pictures a second, with PaVE headers whose sizes are right";
    /// The configuration afterwards.
    SetBack = "set-back", "what was set for this examination is set back to what it was";
    /// Silence of two seconds.
    LostLink = "lost-link", "1.5 to 3 s after the last command the link counts as lost: bit 13 rises, or navdata end";
    /// After the loss.
    FoundAgain = "found-again", "after a lost link the drone answers again within 2 s, and obeys a command with number 1";
}

/// What came of an assumption.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Outcome {
    /// It holds; what was measured.
    Holds(String),
    /// It does not hold; what was seen instead.
    Differs(String),
    /// It could not be asked; why.
    NotAsked(String),
}

/// An assumption and what came of it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Check {
    /// The assumption.
    pub assumption: Assumption,
    /// What came of it.
    pub outcome: Outcome,
}

/// All checks, in the order in which they were made. An assumption of several parts may differ several times.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Report {
    /// The checks.
    pub checks: Vec<Check>,
}

impl Report {
    /// Whether all was asked, and nothing differs.
    pub fn is_as_assumed(&self) -> bool {
        self.checks.iter().all(|check| matches!(check.outcome, Outcome::Holds(_)))
    }
}

/// Collects checks, and tells of each at once.
pub(super) struct Findings<'a> {
    pub(super) report: Report,
    tell: &'a mut dyn FnMut(&Check),
}

impl<'a> Findings<'a> {
    pub(super) fn new(tell: &'a mut dyn FnMut(&Check)) -> Self {
        Self { report: Report::default(), tell }
    }

    pub(super) fn add(&mut self, assumption: Assumption, outcome: Outcome) {
        let check = Check { assumption, outcome };
        (self.tell)(&check);
        self.report.checks.push(check);
    }

    /// Adds a check that holds or differs, with what was measured either way.
    pub(super) fn judge(&mut self, assumption: Assumption, holds: bool, measured: String) {
        let outcome = if holds { Outcome::Holds(measured) } else { Outcome::Differs(measured) };
        self.add(assumption, outcome);
    }

    /// Adds a check of several parts: it holds if nothing is wrong.
    pub(super) fn judge_all(
        &mut self,
        assumption: Assumption,
        wrong: Vec<String>,
        measured: String,
    ) {
        if wrong.is_empty() {
            self.add(assumption, Outcome::Holds(measured));
        }
        for what in wrong {
            self.add(assumption, Outcome::Differs(what));
        }
    }
}

/// Why a drone was not examined.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Refusal {
    /// No navdata came.
    #[error(
        "no drone answers: nothing came from its navdata port within 3 s; join its Wi-Fi, or give --drone"
    )]
    Silent,
    /// State bit 0 is set.
    #[error(
        "the drone says that it flies: only a drone on the ground is examined, and no command is sent to it any more"
    )]
    Flies,
    /// Its watchdog hears commands that are not ours.
    #[error(
        "another program commands the drone, or its watchdog does not work: its bit is off without a command of ours; \
         stop that program first"
    )]
    Commanded,
    /// [`Contact::is_stopped`](super::Contact::is_stopped).
    #[error("called off; what was set is set back, unless a line above says otherwise")]
    Stopped,
    /// No navdata come any more.
    #[error("the drone has gone: no navdata for 1.5 s; its settings may not be what they were")]
    Gone,
}
