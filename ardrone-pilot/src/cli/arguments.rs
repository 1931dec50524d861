//! Command-line arguments.

use std::net::{Ipv4Addr, SocketAddr, ToSocketAddrs as _};
use std::path::{Path, PathBuf};

use ardrone_link::{AT_PORT, CONTROL_PORT, DRONE_HOST, FTP_PORT, NAVDATA_PORT, VIDEO_PORT};
use autopilot::plan;
use autopilot::vehicle::VehicleName;
use clap::error::{ContextKind, ContextValue};
use clap::{Args, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;

use super::mavlink::MavlinkArguments;
use crate::settings::GivenTag;

const EXIT_STATUS: &str = "\
Exit status:
    0  the plan was flown to its end and the drone has landed
    1  anything else that went wrong
    2  usage
   10  no drone answered, or the link was lost
   20  the plan or the settings are invalid or cannot be read
   30  the pre-flight check refused to take off
   40  a failsafe landed the drone
   50  emergency: the drone cut its motors
   60  all steps were flown, but a tag or the GPS contradicts the position: the targets may not have been reached
   70  selftest: the drone is not as it is assumed to be
  130  the operator landed it (Ctrl-C)

Without --plan it is 0 if an operator quit with the drone down, whatever the outcomes of its flights.

Ctrl-C lands the drone and waits for the ground; a second one exits at once, with the
landing ordered. SIGTERM and a closed terminal do the same.

Keys, in a terminal:
    space     hold the position; the mission is paused
    r         resume the mission
    l         land
    q         land and quit, as Ctrl-C
    w a s d   fly forward, left, back, right, as long as pressed
    arrows    climb, sink, turn
    e Enter   cut the motors: the drone falls
    :         type an order, with history and completion; :help lists them";

/// Fly an AR.Drone 2.0: along a plan, or by orders.
///
/// With --plan it flies that plan and exits. Without, it connects, reports whether the drone could take off,
/// and takes orders:
/// typed in a terminal behind `:`, as lines or (with --json) JSON objects on standard input, or from a
/// browser, or over MAVLink from ground stations and programs of others.
///
/// Without a drone, add --mock: a simulated one is started and flown over the same protocol.
#[derive(Debug, Parser)]
#[command(
    name = "ardrone-pilot",
    version,
    after_help = EXIT_STATUS,
    args_conflicts_with_subcommands = true
)]
pub(super) struct Arguments {
    #[command(subcommand)]
    pub(super) command: Option<Command>,
    #[command(flatten)]
    pub(super) fly: Fly,
}

/// Subcommands other than flying.
#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Check a plan: each step with its target, time and charge, and everything that is wrong or unwise; or a fleet (.toml)
    Check(CheckPlan),
    /// Fly several drones in one room, each along its plan: they keep apart
    Fleet(Box<FlyFleet>),
    /// Ask a drone on the ground what is assumed of its firmware, and say what differs; its motors stay off
    Selftest(ExamineDrone),
    /// Make a page about a recorded flight: plots, and why the agent did what it did
    Report {
        /// A flight log
        #[arg(value_name = "LOG")]
        log: PathBuf,
        /// The page [default: the log's name with .html]
        #[arg(short, value_name = "FILE")]
        output: Option<PathBuf>,
    },
    /// Write the video of a recorded flight to a file, as it was encoded by the drone
    Video {
        /// A flight log, recorded with --record-video
        #[arg(value_name = "LOG")]
        log: PathBuf,
        /// The film, .mp4 or .h264 [default: the log's name with .mp4]
        #[arg(short, value_name = "FILE")]
        output: Option<PathBuf>,
    },
    /// Fly a recorded flight again, and show where today's code decides otherwise: exit status 1 if it does
    Replay {
        /// A flight log
        #[arg(value_name = "LOG")]
        log: PathBuf,
    },
    /// Print what a shell needs to complete the command line
    Completions {
        /// The shell
        #[arg(value_name = "SHELL")]
        shell: Shell,
    },
    /// Print the manual page of the program, or of one of its commands
    Man {
        /// The command
        #[arg(value_name = "COMMAND")]
        command: Option<String>,
    },
    /// Print the settings in effect: the documented defaults, or those of a file
    Config {
        /// A `pilot.toml`
        #[arg(long, value_name = "FILE")]
        config: Option<PathBuf>,
    },
}

/// Arguments of `check`.
#[derive(Debug, Args)]
pub(super) struct CheckPlan {
    /// The flight plan, or a fleet: a file .toml
    #[arg(value_name = "PLAN")]
    pub(super) plan: PathBuf,
    /// Settings other than the defaults, for the fence
    #[arg(long, value_name = "FILE")]
    pub(super) config: Option<PathBuf>,
    /// Where z = 0 of the plan is
    #[arg(long, value_enum, value_name = "WHERE", default_value_t = ZOrigin::Hover)]
    pub(super) z_origin: ZOrigin,
    /// The flight will use tags
    #[arg(long)]
    pub(super) tags: bool,
    /// A tag whose place is known, as when flying
    #[arg(long, value_name = "X,Y[,HEADING]", allow_hyphen_values = true)]
    pub(super) tag: Vec<GivenTag>,
    /// Draw the way from above and its height to this file
    #[arg(long, value_name = "FILE")]
    pub(super) svg: Option<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    pub(super) json: bool,
}

/// How a flight is shown, and from where it takes orders.
#[derive(Debug, Args)]
#[allow(clippy::struct_excessive_bools, reason = "each is a flag that can be given")]
pub(super) struct Interfaces {
    /// Show the flight in a browser, and take orders from it; at an address that others can reach, with
    /// a token
    #[arg(
        long,
        value_name = "ADDRESS",
        num_args = 0..=1,
        default_missing_value = "127.0.0.1:8080",
        value_parser = page_address
    )]
    pub(super) ui: Option<SocketAddr>,
    /// Folder of the plans that the page opens and saves
    #[arg(long, value_name = "FOLDER", default_value = "plans", requires = "ui")]
    pub(super) plans: PathBuf,
    #[command(flatten)]
    pub(super) mavlink: MavlinkArguments,
    /// Print how regular the ticks were and what they cost
    #[arg(long)]
    pub(super) timing: bool,
    /// Plain lines, without terminal control sequences
    #[arg(long)]
    pub(super) plain: bool,
    /// Print one JSON object per line: status, events, targets reached, and the end
    #[arg(long)]
    pub(super) json: bool,
}

/// Arguments of the flight of a fleet.
#[derive(Debug, Args)]
#[allow(clippy::struct_excessive_bools, reason = "each is a flag that can be given")]
pub(super) struct FlyFleet {
    /// The vehicles: name, start and plan of each
    #[arg(value_name = "FLEET.toml")]
    pub(super) fleet: PathBuf,
    /// Fly simulated drones, started on free loopback ports
    #[arg(long)]
    pub(super) mock: bool,
    /// Hear the vehicles that are flown on other machines, by a configuration of Zenoh; with `--features zenoh`
    #[arg(long, value_name = "ZENOH.json5")]
    pub(super) net: Option<PathBuf>,
    /// Fly this vehicle here, and leave the others to other machines; it may be given several times
    #[arg(long, value_name = "NAME", requires = "net")]
    pub(super) vehicle: Vec<VehicleName>,
    /// Where z = 0 of the plans is
    #[arg(long, value_enum, value_name = "WHERE", default_value_t = ZOrigin::Hover)]
    z_origin: ZOrigin,
    /// Record the flights to this folder, each to a file DATE-FLEET-VEHICLE.mcap
    #[arg(long, value_name = "FOLDER", default_value = "flights")]
    pub(super) log: PathBuf,
    /// Do not record the flights
    #[arg(long, conflicts_with = "log")]
    pub(super) no_log: bool,
    #[command(flatten)]
    pub(super) interfaces: Interfaces,
}

/// Arguments of a flight.
#[derive(Debug, Args)]
#[allow(clippy::struct_excessive_bools, reason = "each is a flag that can be given")]
pub(super) struct Fly {
    /// Fly this plan and exit; without it the vehicle stays on the ground and takes orders
    #[arg(long, value_name = "FILE")]
    pub(super) plan: Option<PathBuf>,
    /// Settings other than the defaults; `ardrone-pilot config` shows them
    #[arg(long, value_name = "FILE")]
    pub(super) config: Option<PathBuf>,
    #[command(flatten)]
    pub(super) drone: WhichDrone,
    /// Where z = 0 of the plan is
    #[arg(long, value_enum, value_name = "WHERE", default_value_t = ZOrigin::Hover)]
    z_origin: ZOrigin,
    /// Hold the position by tags (black and white roundels) on the floor: find them and map them
    #[arg(long)]
    pub(super) tags: bool,
    /// A tag whose place is known, right and forward of the start, and which way it points; it may be given
    /// several times
    #[arg(long, value_name = "X,Y[,HEADING]", allow_hyphen_values = true)]
    pub(super) tag: Vec<GivenTag>,
    /// Record the flight to this file [default: flights/DATE-VEHICLE.mcap]
    #[arg(long, value_name = "FILE")]
    pub(super) log: Option<PathBuf>,
    /// Do not record the flight
    #[arg(long, conflicts_with = "log")]
    pub(super) no_log: bool,
    /// Record what the camera sees, too: 8 MB a minute
    #[arg(long, conflicts_with = "no_log")]
    pub(super) record_video: bool,
    #[command(flatten)]
    pub(super) interfaces: Interfaces,
}

/// The drone, real or simulated.
#[derive(Debug, Args)]
pub(super) struct WhichDrone {
    /// Take a simulated drone, started on free loopback ports
    #[arg(long, conflicts_with_all = ["drone", "at_port", "navdata_port", "control_port", "video_port"])]
    pub(super) mock: bool,
    /// The drone's address
    #[arg(long, value_name = "HOST", default_value = DRONE_HOST)]
    pub(super) drone: String,
    /// The drone's UDP port for AT commands
    #[arg(long, value_name = "PORT", default_value_t = AT_PORT)]
    pub(super) at_port: u16,
    /// The drone's UDP port for navdata
    #[arg(long, value_name = "PORT", default_value_t = NAVDATA_PORT)]
    pub(super) navdata_port: u16,
    /// The drone's TCP port for its configuration
    #[arg(long, value_name = "PORT", default_value_t = CONTROL_PORT)]
    pub(super) control_port: u16,
    /// The drone's TCP port for video
    #[arg(long, value_name = "PORT", default_value_t = VIDEO_PORT)]
    pub(super) video_port: u16,
}

/// What is asked of which drone.
#[derive(Debug, Args)]
pub(super) struct ExamineDrone {
    #[command(flatten)]
    pub(super) drone: WhichDrone,
    /// The drone's TCP port for FTP
    #[arg(long, value_name = "PORT", default_value_t = FTP_PORT, conflicts_with = "mock")]
    pub(super) ftp_port: u16,
    /// Settings other than the defaults, which a flight would make
    #[arg(long, value_name = "FILE")]
    pub(super) config: Option<PathBuf>,
    /// Print one JSON object per line: each check, and the end
    #[arg(long)]
    pub(super) json: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum ZOrigin {
    /// The hover height after take-off
    Hover,
    /// The floor
    Floor,
}

impl Arguments {
    /// The arguments of this process. Wrong ones are reported, and end it.
    pub(super) fn of_process() -> Self {
        Self::try_parse().unwrap_or_else(|error| advised(error).exit())
    }
}

/// An error with the advice that the parser cannot have: a file alone is most likely a plan.
fn advised(mut error: clap::Error) -> clap::Error {
    let word = match error.get(ContextKind::InvalidSubcommand) {
        Some(ContextValue::String(word)) => word.clone(),
        _ => return error,
    };
    let path = Path::new(&word);
    if path.is_file() || path.extension().is_some() {
        let how = if path.extension().is_some_and(|extension| extension == "mcap") {
            format!("write `report {word}` for a page about a recorded flight")
        } else {
            format!("write `--plan {word}` to fly a plan, and `check {word}` to check it")
        };
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![how.into()]));
    }
    error
}

impl FlyFleet {
    pub(super) fn z_origin(&self) -> plan::ZOrigin {
        self.z_origin.into()
    }
}

impl Fly {
    pub(super) fn z_origin(&self) -> plan::ZOrigin {
        self.z_origin.into()
    }
}

impl From<ZOrigin> for plan::ZOrigin {
    fn from(origin: ZOrigin) -> Self {
        match origin {
            ZOrigin::Hover => Self::Hover,
            ZOrigin::Floor => Self::Floor,
        }
    }
}

/// Parses `ADDRESS:PORT`, or a port on the loopback interface.
fn page_address(text: &str) -> Result<SocketAddr, String> {
    if let Ok(port) = text.parse() {
        return Ok((Ipv4Addr::LOCALHOST, port).into());
    }
    let wanted = "expected an address and a port, as 127.0.0.1:8080";
    let mut addresses = text.to_socket_addrs().map_err(|error| format!("{error}; {wanted}"))?;
    addresses.next().ok_or_else(|| wanted.to_owned())
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory as _;

    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn a_file_alone_is_taken_for_a_plan_or_a_recording() {
        let said = |word| {
            let error = Arguments::try_parse_from(["ardrone-pilot", word]).unwrap_err();
            advised(error).to_string()
        };
        let plan = said("square.txt");
        assert!(plan.contains("write `--plan square.txt` to fly a plan"), "{plan}");
        let recording = said("flights/one.mcap");
        assert!(recording.contains("write `report flights/one.mcap`"), "{recording}");
        assert!(!said("chek").contains("--plan "), "a mistyped word is no file");
        assert!(said("chek").contains("check"));
    }

    #[test]
    fn a_page_has_an_address() {
        let ui = |words: &[&str]| {
            let words = ["ardrone-pilot", "--plan", "p", "--ui"].iter().chain(words);
            Arguments::try_parse_from(words).map(|arguments| arguments.fly.interfaces.ui.unwrap())
        };
        assert_eq!(ui(&[]).unwrap(), "127.0.0.1:8080".parse().unwrap());
        assert_eq!(ui(&["9000"]).unwrap(), "127.0.0.1:9000".parse().unwrap());
        assert_eq!(ui(&["0.0.0.0:80"]).unwrap(), "0.0.0.0:80".parse().unwrap());
        assert!(ui(&["nowhere"]).unwrap_err().to_string().contains("as 127.0.0.1:8080"));
    }

    #[test]
    fn help_lists_the_exit_statuses() {
        let help = Arguments::command().render_long_help().to_string();
        for status in ["0", "1", "2", "10", "20", "30", "40", "50", "60", "130"] {
            assert!(help.lines().any(|line| line.split_whitespace().next() == Some(status)));
        }
    }
}
