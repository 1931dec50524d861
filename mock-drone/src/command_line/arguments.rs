//! Command-line arguments.

use crate::{FloorTag, Lies};
use std::net::{IpAddr, Ipv4Addr};
use std::path::PathBuf;

use ardrone_link::{AT_PORT, CONTROL_PORT, FTP_PORT, NAVDATA_PORT, VIDEO_PORT};
use clap::{Args, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;

/// A simulated AR.Drone 2.0 for any client of the real drone.
///
/// It boots, waits to be configured, takes off, flies, lands and drains its battery like the real one, and
/// lands when its pilot is silent. It runs until it is stopped.
#[derive(Debug, Parser)]
#[command(version, after_help = AFTER_HELP, args_conflicts_with_subcommands = true)]
pub(super) struct Arguments {
    #[command(subcommand)]
    pub(super) command: Option<Command>,
    #[command(flatten)]
    pub(super) ports: PortArguments,
    #[command(flatten)]
    pub(super) drone: DroneArguments,
    #[command(flatten)]
    pub(super) faults: FaultArguments,
    /// Draw the time since 1970 into each picture of the video, to measure how late it is shown: the lowest 32 bits of the
    /// milliseconds, as black and white blocks along its lower edge
    #[arg(long)]
    pub(super) video_clock: bool,
    /// Write the true state to this CSV file
    #[arg(long, value_name = "FILE")]
    pub(super) truth: Option<PathBuf>,
}

/// Subcommands: what a package installs beside the program.
#[derive(Debug, Subcommand)]
pub(super) enum Command {
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
}

const AFTER_HELP: &str = "\
Scenario files have one fault per line: a time, then the fault. A time is in seconds since the
start, or with a plus since the first take-off; # starts a comment.

  0     delay 20 jitter 15       milliseconds
  +2    loss 30                  percent; likewise duplicate, reorder, corrupt
  +5    outage 1.2               seconds without any datagram
  +6    hold 0.8                 seconds in which datagrams are held back; then they arrive at once
  +7    burst 50                 number of the last navdata packets that arrive once more
  +8    freeze 2                 seconds of constant sensor readings
  +12   lie altitude 0.5 for 3   offset that is added to a quantity, and seconds
  +16   wind 1.5 -0.5 gusts 0.4  m/s towards right and forward
  +20   battery 15               percent; likewise sag, the reduction under full load
  +22   motor 70 over 2          remaining percent of its thrust, reached after these seconds
  +23   second-pilot 5           seconds in which another client commands a hover; its sequence
                                 numbers start at 1, or with `from 5000` at the end there
  +24   tag 1.5 -0.5 90          place a tag: metres right and forward, degrees; likewise
                                 tag-moved 1 0 0 90 (number and new place) and tag-gone 1
  +25   video cut for 3          seconds in which the video's connections are closed; likewise
                                 silent (they stay open without data), garbage (random bytes)
                                 and lie (headers with wrong sizes)
  +30   restart                  power cycle; or propeller, a blocked one, which cuts the motors

loss, outage and hold affect both directions, or with up or down behind the word only the datagrams
to or from the drone. A quantity is velocity-right, velocity-forward, altitude, yaw (or heading),
roll, pitch or clock, in metres, degrees and seconds. `for` gives the duration in seconds:

  +8    stuck yaw for 3              constant at the last value; with `at 20` at that value
  +8    dead altitude at 1.5 for 3   constant at that value or zero, with its usual noise
  +8    lie velocity-right 0.5 for 3 offset; `lie velocity RIGHT FORWARD` is two in one
  +8    ramp heading 5 for 3         offset that grows by this each second
  +8    noise pitch 4 for 3          added noise with this standard deviation
  +8    gain velocity-right 2 for 3  factor of what is measured
  +8    nan pitch for 3              NaN; not possible for altitude and clock
  +8    late altitude 0.5 for 3      additional delay in seconds
  +8    state ultrasound-deaf for 3  set a bit of the state word
  +8    minor 6 for 3                detail of the control state

Only navdata are falsified. The drone's own hover and landing use the true motion.

Exit status: 0 stopped by Ctrl-C; 1 a port is taken, a file is wrong or a socket failed; 2 usage.";

#[derive(Debug, Args)]
#[command(next_help_heading = "Ports")]
pub(super) struct PortArguments {
    /// Address to listen on
    #[arg(long, value_name = "ADDRESS", default_value_t = IpAddr::V4(Ipv4Addr::LOCALHOST))]
    pub(super) bind: IpAddr,
    /// UDP port for AT commands
    #[arg(long, value_name = "PORT", default_value_t = AT_PORT)]
    pub(super) at_port: u16,
    /// UDP port for navdata
    #[arg(long, value_name = "PORT", default_value_t = NAVDATA_PORT)]
    pub(super) navdata_port: u16,
    /// TCP port for the configuration
    #[arg(long, value_name = "PORT", default_value_t = CONTROL_PORT)]
    pub(super) control_port: u16,
    /// TCP port for FTP, which serves the firmware's version
    #[arg(long, value_name = "PORT", default_value_t = FTP_PORT)]
    pub(super) ftp_port: u16,
    /// TCP port for video
    #[arg(long, value_name = "PORT", default_value_t = VIDEO_PORT)]
    pub(super) video_port: u16,
    /// TCP port that some clients probe to detect the drone; the real one has 21
    #[arg(long, value_name = "PORT")]
    pub(super) presence_port: Option<u16>,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Drone")]
pub(super) struct DroneArguments {
    /// Seed of all random numbers
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(super) seed: u64,
    /// Initial charge, in percent
    #[arg(long, value_name = "PERCENT", default_value_t = 90, value_parser = clap::value_parser!(u8).range(0..=100))]
    pub(super) battery: u8,
    /// Reduction of the measured charge under full load, in percent
    #[arg(long, value_name = "PERCENT", default_value_t = 0.0, value_parser = percentage)]
    pub(super) battery_sag: f64,
    /// Start in flight at this height in metres, as left by another pilot
    #[arg(long, value_name = "METRES", value_parser = not_negative)]
    pub(super) flies_at: Option<f64>,
    /// Published model of the airframe
    #[arg(long, value_enum, default_value_t = Airframe::Rec)]
    pub(super) airframe: Airframe,
    /// Quality of the drone's sensors
    #[arg(long, value_enum, default_value_t = Sensors::Nominal)]
    pub(super) sensors: Sensors,
    /// Content of navdata option 27, in which firmware versions differ
    #[arg(long, value_enum, default_value_t = Option27::Absent)]
    pub(super) option_27: Option27,
    /// Wind towards right and forward, in metres a second
    #[arg(long, num_args = 2, value_names = ["RIGHT", "FORWARD"], allow_negative_numbers = true)]
    pub(super) wind: Option<Vec<f64>>,
    /// Standard deviation of the gusts, in metres a second
    #[arg(long, value_name = "M/S", default_value_t = 0.0, value_parser = not_negative)]
    pub(super) gusts: f64,
    /// A tag on the floor: metres to the right and forward of the start, and its heading clockwise in
    /// degrees; may be repeated
    #[arg(long, value_name = "X,Y[,HEADING]", value_parser = floor_tag, allow_hyphen_values = true)]
    pub(super) tag: Vec<FloorTag>,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Faults")]
pub(super) struct FaultArguments {
    /// Share of datagrams that are lost, in percent; likewise the next three
    #[arg(long, value_name = "PERCENT", default_value_t = 0.0, value_parser = percentage)]
    pub(super) loss: f64,
    /// Datagrams that arrive twice
    #[arg(long, value_name = "PERCENT", default_value_t = 0.0, value_parser = percentage)]
    pub(super) duplicate: f64,
    /// Datagrams that arrive after the next one
    #[arg(long, value_name = "PERCENT", default_value_t = 0.0, value_parser = percentage)]
    pub(super) reorder: f64,
    /// Datagrams that are corrupted: navdata with a changed byte, AT commands lost
    #[arg(long, value_name = "PERCENT", default_value_t = 0.0, value_parser = percentage)]
    pub(super) corrupt: f64,
    /// Latency of each datagram, in milliseconds
    #[arg(long, value_name = "MS", default_value_t = 0)]
    pub(super) delay: u16,
    /// Maximum random additional latency, in milliseconds
    #[arg(long, value_name = "MS", default_value_t = 0)]
    pub(super) jitter: u16,
    /// A way in which the firmware is not as it is assumed to be; may be repeated
    #[arg(long, value_name = "NAME", value_parser = lie)]
    pub(super) lie: Vec<Lies>,
    /// Faults over time, see below
    #[arg(long, value_name = "FILE")]
    pub(super) scenario: Option<PathBuf>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Airframe {
    /// Inside the range of the others
    Rec,
    /// That of the filter in TUM's packages: strong tilt, slow climb, fast descent
    Tum,
    /// Fitted transfer functions: weak tilt, fast climb, long dead time
    Tf,
    /// Identified for a thesis: strong drag, slow climb and turn
    Leo,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Sensors {
    /// No noise, no delay, no drift
    Perfect,
    /// A good room: some noise, delay and drift
    Nominal,
    /// A bad room: twice the noise, wrong echoes
    Hard,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Option27 {
    /// Nothing, which every client understands
    Absent,
    /// 12 bytes, as older firmware; node-ar-drone loses every full packet then
    Zimmu,
    /// 216 bytes of GPS, as firmware 2.4; pyardrone loses every full packet then
    Gps,
}

/// `RIGHT,FORWARD` or `RIGHT,FORWARD,HEADING`
fn floor_tag(text: &str) -> Result<FloorTag, String> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|word| word.trim().parse().ok()).collect();
    let (x, y, heading) = match numbers.as_deref() {
        Some([x, y]) => (*x, *y, 0.0),
        Some([x, y, heading]) => (*x, *y, *heading),
        _ => (f64::NAN, f64::NAN, f64::NAN),
    };
    if x.abs() <= 100.0 && y.abs() <= 100.0 && heading.abs() <= 360.0 {
        return Ok(FloorTag::new(x, y, heading));
    }
    Err("expected metres right and forward, and degrees: 1.5,-0.5 or 1.5,-0.5,90".to_owned())
}

/// One of the names of the lies.
fn lie(name: &str) -> Result<Lies, String> {
    Lies::named(name).ok_or_else(|| format!("one of {}", Lies::names().join(", ")))
}

fn percentage(text: &str) -> Result<f64, String> {
    let number = not_negative(text)?;
    if number <= 100.0 { Ok(number) } else { Err("greater than 100 percent".to_owned()) }
}

fn not_negative(text: &str) -> Result<f64, String> {
    let number: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    if number.is_finite() && number >= 0.0 {
        Ok(number)
    } else {
        Err("must not be negative".to_owned())
    }
}
