//! Script of a flight of the soak test; everything follows from the seed.

use std::fmt;
use std::fmt::Write as _;
use std::time::Duration;

use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;

/// How the pilot is made to end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum End {
    /// By its plan.
    Plan,
    /// By one signal.
    Once(Sign),
    /// By two signals with this time between them.
    Twice(Sign, Duration),
    /// SIGKILL.
    Kill,
}

/// A signal that requests the end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Sign {
    Interrupt,
    Terminate,
    HangUp,
    Quit,
}

impl fmt::Display for End {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = |sign: &Sign| match sign {
            Sign::Interrupt => "SIGINT",
            Sign::Terminate => "SIGTERM",
            Sign::HangUp => "SIGHUP",
            Sign::Quit => "SIGQUIT",
        };
        match self {
            Self::Plan => f.write_str("nothing"),
            Self::Once(sign) => write!(f, "{} once", name(sign)),
            Self::Twice(sign, _) => write!(f, "{} twice", name(sign)),
            Self::Kill => f.write_str("SIGKILL"),
        }
    }
}

/// What happens to the pilot's output.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Output {
    /// It is discarded.
    Ignored,
    /// It is closed from the start.
    Closed,
    /// It is not read, and closed after this time.
    StuckUntil(Duration),
}

/// Script of a flight.
#[derive(Debug, Clone)]
pub(crate) struct Script {
    pub(crate) seed: u64,
    pub(crate) plan: String,
    /// The mock drone's arguments.
    pub(crate) drone: Vec<String>,
    pub(crate) scenario: String,
    /// Times without any datagram: begin and end since the drone's start.
    pub(crate) outages: Vec<(Duration, Duration)>,
    pub(crate) end: End,
    /// Time of the end, since the pilot's start.
    pub(crate) end_at: Duration,
    /// Time of SIGSTOP, and duration until SIGCONT.
    pub(crate) stop: Option<(Duration, Duration)>,
    /// Start of the garbage to both ends, and number of datagrams.
    pub(crate) flood: Option<(Duration, u32)>,
    pub(crate) output: Output,
    pub(crate) records: bool,
}

fn seconds(random: &mut ChaCha8Rng, from: f64, to: f64) -> Duration {
    Duration::from_secs_f64(random.random_range(from..to))
}

impl Script {
    /// The script of this seed.
    pub(crate) fn new(seed: u64) -> Self {
        let random = &mut ChaCha8Rng::seed_from_u64(seed);
        let mut outages = Vec::new();
        let scenario = scenario(random, &mut outages);
        let sign =
            [Sign::Interrupt, Sign::Terminate, Sign::HangUp, Sign::Quit][random.random_range(0..4)];
        let end = match random.random_range(0..10) {
            0 | 1 => End::Plan,
            2..5 => End::Once(sign),
            5..9 => End::Twice(sign, seconds(random, 0.01, 4.0)),
            _ => End::Kill,
        };
        let happens = |random: &mut ChaCha8Rng, share: f64| random.random_bool(share);
        let stop =
            happens(random, 0.15).then(|| (seconds(random, 1.0, 25.0), seconds(random, 0.1, 6.0)));
        let flood = happens(random, 0.3)
            .then(|| (seconds(random, 0.5, 20.0), random.random_range(1_000..200_000)));
        let output = match random.random_range(0..5) {
            0 => Output::Closed,
            1 => Output::StuckUntil(seconds(random, 2.0, 40.0)),
            _ => Output::Ignored,
        };
        Self {
            seed,
            plan: plan(random),
            drone: drone(random, seed),
            scenario,
            outages,
            end,
            // Mostly in the air, which is reached after about 5 s.
            end_at: seconds(random, 0.2, 25.0),
            stop,
            flood,
            output,
            records: happens(random, 0.5),
        }
    }

    /// Names of the other interferences.
    pub(crate) fn extras(&self) -> impl Iterator<Item = &'static str> {
        let output = match self.output {
            Output::Ignored => None,
            Output::Closed => Some("its output closed"),
            Output::StuckUntil(_) => Some("its output stuck"),
        };
        let stopped = self.stop.map(|_| "SIGSTOP and SIGCONT");
        let flooded = self.flood.map(|_| "a flood of garbage");
        let outage = (!self.outages.is_empty()).then_some("an outage");
        [output, stopped, flooded, outage].into_iter().flatten()
    }

    /// Whether all datagrams are lost at some time in this interval.
    pub(crate) fn is_out(&self, from: Duration, to: Duration) -> bool {
        self.outages.iter().any(|(begin, end)| *begin < to && from < *end)
    }
}

impl fmt::Display for Script {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { end, end_at, stop, flood, output, .. } = self;
        writeln!(f, "  {end} after {end_at:?}, stop {stop:?}, flood {flood:?}, output {output:?}")?;
        if let End::Twice(_, apart) = end {
            writeln!(f, "  the second after {apart:?}")?;
        }
        writeln!(f, "  mock-drone {}", self.drone.join(" "))?;
        for line in self.scenario.lines().chain(self.plan.lines()) {
            writeln!(f, "    {line}")?;
        }
        Ok(())
    }
}

fn plan(random: &mut ChaCha8Rng) -> String {
    let mut plan = String::from("takeoff\n");
    for _ in 0..random.random_range(1..4) {
        let stay: f64 = if random.random_bool(0.5) {
            random.random_range(0.5..3.0)
        } else {
            random.random_range(15.0..50.0)
        };
        let mut place = || random.random_range(-1.5..1.5);
        let (x, y): (f64, f64) = (place(), place());
        let z: f64 = random.random_range(-0.4..0.8);
        let yaw: f64 = random.random_range(-90.0..90.0);
        // Writing to a string cannot fail.
        _ = writeln!(plan, "setStayTime {stay:.1}\ngoto {x:.2} {y:.2} {z:.2} {yaw:.0}");
    }
    plan + "land\n"
}

fn drone(random: &mut ChaCha8Rng, seed: u64) -> Vec<String> {
    let airframe = ["rec", "tum", "tf", "leo"][random.random_range(0..4)];
    let mut wind = || random.random_range(-0.5..0.5);
    let (right, forward): (f64, f64) = (wind(), wind());
    let gusts: f64 = random.random_range(0.0..0.2);
    let words = format!(
        "--seed {seed} --airframe {airframe} --wind {right:.2} {forward:.2} --gusts {gusts:.2}"
    );
    words.split(' ').map(str::to_owned).collect()
}

/// Random faults of the air, and outages, whose times are stored.
fn scenario(random: &mut ChaCha8Rng, outages: &mut Vec<(Duration, Duration)>) -> String {
    let mut text = String::new();
    for _ in 0..random.random_range(0..5) {
        let at = seconds(random, 0.0, 40.0);
        let fault = match random.random_range(0..12) {
            0 | 1 => format!("loss {}", random.random_range(1..40)),
            2 => format!(
                "delay {} jitter {}",
                random.random_range(0..60),
                random.random_range(0..60)
            ),
            3 => format!("duplicate {}", random.random_range(1..50)),
            4 => format!("reorder {}", random.random_range(1..50)),
            5 => format!("corrupt {}", random.random_range(1..30)),
            6 | 7 => {
                let time = seconds(random, 0.1, 6.0);
                outages.push((at, at + time));
                format!("outage {:.2}", time.as_secs_f64())
            }
            8 => format!("freeze {:.1}", random.random_range(0.1..4.0)),
            9 => "restart".to_owned(),
            10 => format!("battery {}", random.random_range(5..40)),
            _ => "propeller".to_owned(),
        };
        _ = writeln!(text, "{:.2} {fault}", at.as_secs_f64());
    }
    text
}
