//! Commands, settings, numbers and watchdogs.

use std::time::Duration;

use super::contact::{ANSWER, Contact, Examiner, Meanwhile};
use super::report::{Assumption, Findings, Outcome};
use crate::at::{Command, Config, ControlMode};
use crate::configuration::Configuration;
use crate::navdata::DroneState;

/// How long the configuration may take.
const DUMP: Duration = Duration::from_secs(3);
const DEMO_KEY: &str = "general:navdata_demo";
/// Eight times as long as one is.
const LONGEST_DUMP: usize = 32 << 10;
const VERSION_KEY: &str = "general:num_version_soft";
/// Whose packets, documents and captures we know.
const KNOWN_VERSION: &str = "2.4.";
/// What no flight sets, and every flight relies on.
const UNSET: [(&str, &str); 4] = [
    ("control:flying_mode", "0"),
    ("control:control_level", "0"),
    ("control:manual_trim", "FALSE"),
    ("general:com_watchdog", "2"),
];
/// A setting that may be made at any time on the ground; it is set back at the end.
const HARMLESS_KEY: &str = "control:altitude_max";
const HARMLESS_MM: [&str; 2] = ["2000", "2100"];
/// How often a command is repeated that must be ignored: one may be lost.
const REPEATED: u32 = 5;

fn milliseconds(time: Duration) -> String {
    format!("after {} ms", time.as_millis())
}

pub(super) fn acknowledgement(drone: &mut Examiner<'_, impl Contact>, report: &mut Findings<'_>) {
    let is_acknowledged = |state: DroneState| state.contains(DroneState::COMMAND_ACKNOWLEDGE);
    drone.clear();
    let Ok(demo) = Config::new(DEMO_KEY, "TRUE") else { return };
    let acknowledged = drone.ask(ANSWER, &Command::Config(demo), is_acknowledged);
    report.judge(
        Assumption::Acknowledged,
        acknowledged.is_some(),
        acknowledged
            .map_or("bit 6 stays 0 after CONFIG general:navdata_demo".to_owned(), milliseconds),
    );
    let cleared = drone.clear();
    if acknowledged.is_some() {
        let seen = cleared.map_or("bit 6 stays 1 after CTRL 5".to_owned(), milliseconds);
        report.judge(Assumption::Cleared, cleared.is_some(), seen);
    } else {
        report.add(Assumption::Cleared, Outcome::NotAsked("nothing was acknowledged".to_owned()));
    }
}

/// The configuration, as the drone tells it.
fn read(drone: &mut Examiner<'_, impl Contact>) -> Result<Configuration, String> {
    /// A request that was lost is repeated after this.
    const AGAIN: Duration = Duration::from_secs(1);
    const LOOK: Duration = Duration::from_millis(100);
    drone.clear();
    // What is left of an earlier answer.
    drone.listen(LOOK, Meanwhile::Present);
    let mut text = Vec::new();
    let end = drone.contact.now() + DUMP;
    let mut due = drone.contact.now();
    while drone.contact.now() < end && text.last() != Some(&0) && !drone.flies() {
        if text.is_empty() && drone.contact.now() >= due {
            drone.command(&Command::Control(ControlMode::SendConfiguration));
            due += AGAIN;
        }
        let came = drone.listen(LOOK, Meanwhile::Present).control;
        text.extend_from_slice(&came);
        if text.len() > LONGEST_DUMP {
            return Err(format!("more than {LONGEST_DUMP} bytes came, without a NUL byte"));
        }
    }
    drone.clear();
    match text.last() {
        Some(0) => Ok(Configuration::parse(&String::from_utf8_lossy(&text))),
        Some(_) => Err(format!("{} bytes came, without a NUL byte at their end", text.len())),
        None => Err("nothing came over the control port after CTRL 4".to_owned()),
    }
}

pub(super) fn configuration(
    drone: &mut Examiner<'_, impl Contact>,
    report: &mut Findings<'_>,
) -> Option<Configuration> {
    let configuration = match read(drone) {
        Ok(configuration) => configuration,
        Err(what) => {
            report.add(Assumption::Configuration, Outcome::Differs(what.clone()));
            report.add(Assumption::Version, Outcome::NotAsked(what.clone()));
            report.add(Assumption::UnsetKeys, Outcome::NotAsked(what));
            return None;
        }
    };
    let keys = configuration.len();
    report.judge(Assumption::Configuration, keys > 0, format!("{keys} keys"));
    let told = configuration.get(VERSION_KEY).unwrap_or("none").to_owned();
    let mut wrong = Vec::new();
    if !told.starts_with(KNOWN_VERSION) {
        wrong.push(format!("{VERSION_KEY} is {told}"));
    }
    match drone.contact.version() {
        Some(Ok(file)) if file.trim() == told => {}
        Some(Ok(file)) => {
            wrong.push(format!("{VERSION_KEY} is {told}, version.txt says {}", file.trim()));
        }
        Some(Err(why)) => wrong.push(format!("version.txt cannot be read: {why}")),
        None => {}
    }
    report.judge_all(Assumption::Version, wrong, told);
    let unset = UNSET.into_iter().filter(|(key, value)| !configuration.has(key, value));
    let told = |key| configuration.get(key).unwrap_or("missing");
    let unset = unset.map(|(key, _)| format!("{key} is {}", told(key)));
    report.judge_all(Assumption::UnsetKeys, unset.collect(), format!("{} keys", UNSET.len()));
    Some(configuration)
}

/// Another value than this one, as harmless. Identical values would not show whether a key is set at all.
fn other(setting: &Config) -> Option<Config> {
    let number: f64 = setting.value().parse().ok()?;
    let lower = number * 0.9;
    let is_whole = !setting.value().contains('.');
    Config::new(setting.key(), if is_whole { lower.round() } else { lower }).ok()
}

/// Sets these keys and reads them back; what went wrong.
fn set_and_read(
    drone: &mut Examiner<'_, impl Contact>,
    settings: &[Config],
    before: &Configuration,
) -> Vec<String> {
    let mut wrong = Vec::new();
    for setting in settings {
        if before.get(setting.key()).is_none() {
            wrong.push(format!("{}: the configuration has no such key", setting.key()));
        } else if drone.set(setting).is_none() {
            wrong.push(format!("{}: not acknowledged", setting.key()));
        }
    }
    match read(drone) {
        Ok(after) => wrong.extend(settings.iter().filter_map(|setting| {
            let (key, value) = (setting.key(), setting.value());
            let told = after.get(key)?;
            (!after.has(key, value)).then(|| format!("{key}: set to {value}, read back as {told}"))
        })),
        Err(what) => wrong.push(format!("not read back: {what}")),
    }
    wrong
}

/// Makes the settings of a flight, but for the rate of navdata, which is asked by itself.
pub(super) fn settings(
    drone: &mut Examiner<'_, impl Contact>,
    settings: &[Config],
    before: Option<&Configuration>,
    report: &mut Findings<'_>,
) {
    let Some(before) = before else {
        let why = "there is no configuration to read them back from".to_owned();
        return report.add(Assumption::Settings, Outcome::NotAsked(why));
    };
    let wanted: Vec<Config> =
        settings.iter().filter(|setting| setting.key() != DEMO_KEY).cloned().collect();
    let same = wanted.iter().filter(|setting| before.has(setting.key(), setting.value()));
    let others: Vec<Config> = same.filter_map(other).collect();
    let mut wrong = set_and_read(drone, &others, before);
    wrong.extend(set_and_read(drone, &wanted, before));
    report.judge_all(Assumption::Settings, wrong, format!("{} keys", wanted.len()));
}

/// Sets what was set back to what it was, but for the rate of navdata: each client sets that first.
pub(super) fn set_back(
    drone: &mut Examiner<'_, impl Contact>,
    settings: &[Config],
    before: &Configuration,
    report: &mut Findings<'_>,
) {
    /// Each has a value for indoors and outdoors, of which the drone changes one when the one in use is set.
    const LIMITS: [&str; 3] = ["euler_angle_max", "control_vz_max", "control_yaw"];
    let ours = settings.iter().map(|setting| setting.key().to_owned());
    let limits = ["indoor", "outdoor"]
        .into_iter()
        .flat_map(|place| LIMITS.map(|limit| format!("control:{place}_{limit}")));
    let keys = ours.chain(limits).filter(|key| *key != DEMO_KEY).chain([HARMLESS_KEY.to_owned()]);
    let known = keys.filter_map(|key| Config::new(&*key, before.get(&key)?).ok());
    let known: Vec<Config> = known.collect();
    for config in &known {
        drone.set(config);
    }
    let wrong = match read(drone) {
        Ok(after) => known
            .iter()
            .filter(|config| !after.has(config.key(), config.value()))
            .map(|config| {
                let told = after.get(config.key()).unwrap_or("missing");
                format!("{}: it was {}, and is {told}", config.key(), config.value())
            })
            .collect(),
        Err(what) => vec![format!("not known: {what}")],
    };
    report.judge_all(Assumption::SetBack, wrong, format!("{} keys", known.len()));
}

pub(super) fn sequence_numbers(
    drone: &mut Examiner<'_, impl Contact>,
    before: Option<&Configuration>,
    report: &mut Findings<'_>,
) {
    let is_acknowledged = |state: DroneState| state.contains(DroneState::COMMAND_ACKNOWLEDGE);
    let [first, second] = HARMLESS_MM.map(|value| Config::new(HARMLESS_KEY, value));
    let (Ok(first), Ok(second)) = (first, second) else { return };
    // Without a configuration it could not be set back.
    if before.is_none() || drone.set(&first).is_none() {
        for assumption in [Assumption::OldNumbers, Assumption::NumberOne] {
            let why = format!("{HARMLESS_KEY} cannot be set, or not set back");
            report.add(assumption, Outcome::NotAsked(why));
        }
        return;
    }
    let setting = Command::Config(second);
    let mut obeyed = None;
    for back in [0, 1, 2, drone.number / 2] {
        // Twice: where the last command was lost, an older number is a new one.
        let is_obeyed = (0..2).all(|_| {
            drone.command(&Command::CommunicationWatchdog);
            drone.clear();
            let number = drone.number - back;
            for _ in 0..REPEATED {
                drone.command_with(number, &setting);
            }
            drone.wait(ANSWER / 2, Meanwhile::Silent, is_acknowledged).is_some()
        });
        if is_obeyed {
            obeyed = Some(back);
            break;
        }
    }
    let seen = match obeyed {
        None => "the last number again, and numbers before it, are ignored".to_owned(),
        Some(0) => "a setting with the last number again is acknowledged".to_owned(),
        Some(back) => {
            format!("a setting with a number that is {back} before the last one is acknowledged")
        }
    };
    report.judge(Assumption::OldNumbers, obeyed.is_none(), seen);
    drone.command(&Command::CommunicationWatchdog);
    drone.clear();
    let last = drone.number;
    let restarted = (0..REPEATED).find_map(|_| {
        drone.command_with(1, &setting);
        drone.wait(ANSWER / 2, Meanwhile::Silent, is_acknowledged)
    });
    // Where the drone goes on with the count, so must we.
    drone.number = if restarted.is_some() { 1 } else { last };
    let cleared = drone.clear().is_some();
    let seen = match (restarted, cleared) {
        (None, _) => format!("a setting with number 1 is not acknowledged after number {last}"),
        (Some(_), false) => {
            "after a command with number 1 the one with number 2 is ignored".to_owned()
        }
        (Some(time), true) => milliseconds(time),
    };
    report.judge(Assumption::NumberOne, restarted.is_some() && cleared, seen);
    if !cleared {
        drone.number = last;
        drone.clear();
    }
}

pub(super) fn watchdog(drone: &mut Examiner<'_, impl Contact>, report: &mut Findings<'_>) {
    let is_raised = |state: DroneState| state.contains(DroneState::COMMUNICATION_WATCHDOG);
    let clear = Command::CommunicationWatchdog;
    drone.ask(ANSWER, &clear, |state| !is_raised(state));
    let silence = Duration::from_millis(400);
    // What is under way has to arrive first.
    drone.listen(Duration::from_millis(20), Meanwhile::Silent);
    let raised = drone.wait(silence, Meanwhile::Silent, is_raised);
    let seen =
        raised.map_or("bit 30 stays 0 after 400 ms without a command".to_owned(), milliseconds);
    report.judge(Assumption::Watchdog, raised.is_some(), seen);
    if raised.is_none() {
        let why = "bit 30 did not rise".to_owned();
        return report.add(Assumption::WatchdogCleared, Outcome::NotAsked(why));
    }
    let cleared = drone.ask(ANSWER, &clear, |state| !is_raised(state));
    let seen = cleared.map_or("bit 30 stays 1 after COMWDG".to_owned(), milliseconds);
    report.judge(Assumption::WatchdogCleared, cleared.is_some(), seen);
}

pub(super) fn lost_link(drone: &mut Examiner<'_, impl Contact>, report: &mut Findings<'_>) {
    /// Longer than between two packets of the demo mode, and than one that is lost.
    const NAVDATA_END: Duration = Duration::from_millis(400);
    drone.command(&Command::CommunicationWatchdog);
    let start = drone.contact.now();
    let is_lost = |state: DroneState| state.contains(DroneState::COMMUNICATION_LOST);
    let mut lost = None;
    while lost.is_none() && !drone.flies() && drone.contact.now() < start + Duration::from_secs(4) {
        let before = drone.contact.now();
        let window = drone.listen(NAVDATA_END, Meanwhile::Silent);
        lost = match window
            .packets
            .iter()
            .find(|came| came.packet().is_some_and(|packet| is_lost(packet.state)))
        {
            Some(came) => Some(came.at),
            None if window.packets.is_empty() => Some(before),
            None => None,
        };
    }
    let lost = lost.map(|at| at.saturating_sub(start));
    let expected = Duration::from_millis(1500)..=Duration::from_secs(3);
    let seen = lost.map_or(
        "navdata go on for 4 s without a command, and bit 13 stays 0".to_owned(),
        milliseconds,
    );
    report.judge(Assumption::LostLink, lost.is_some_and(|lost| expected.contains(&lost)), seen);
    let start = drone.contact.now();
    let mut again = None;
    while again.is_none() && !drone.flies() && drone.contact.now() < start + Duration::from_secs(2)
    {
        drone.contact.wake();
        again = drone.wait(Duration::from_millis(120), Meanwhile::Silent, |_| true);
    }
    let seen = if again.is_none() {
        Err("no navdata within 2 s of asking for them again".to_owned())
    } else {
        drone.number = 0;
        let Ok(demo) = Config::new(DEMO_KEY, "TRUE") else { return };
        drone.command(&Command::Config(demo.clone()));
        let is_acknowledged = |state: DroneState| state.contains(DroneState::COMMAND_ACKNOWLEDGE);
        drone.ask(ANSWER, &Command::Config(demo), is_acknowledged).map(milliseconds).ok_or_else(
            || "navdata come again, but a setting with number 1 is not acknowledged".to_owned(),
        )
    };
    drone.clear();
    report.judge(Assumption::FoundAgain, seen.is_ok(), seen.unwrap_or_else(|what| what));
}
